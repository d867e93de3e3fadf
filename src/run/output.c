/* Rows, frames and checkpoints of a run. */
#include "run/output.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

enum { COUNTS = 7, SUMS = 3 };

const char *cdem_run_path(char text[4096], const char *folder, const char *name) {
  snprintf(text, 4096, "%s/%s", folder, name);
  return text;
}

double cdem_run_clock(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double cdem_run_output_wall(const cdem_run_output *output) {
  double now = output->ended > 0.0 ? output->ended : cdem_run_clock(); /* pictures do not count */
  return output->counters.wall + now - output->started;
}

/* ---- checkpoints ---- */

static void counters_out(const cdem_run_counters *c, int64_t counts[COUNTS]) {
  const int64_t all[COUNTS] = {c->rows,           c->frames,          c->next_row,
                               c->next_frame,     c->next_checkpoint, c->last_row_step,
                               c->last_frame_step};
  memcpy(counts, all, sizeof all);
}

static void counters_in(const int64_t counts[COUNTS], cdem_run_counters *c) {
  c->rows = counts[0];
  c->frames = counts[1];
  c->next_row = counts[2];
  c->next_frame = counts[3];
  c->next_checkpoint = counts[4];
  c->last_row_step = counts[5];
  c->last_frame_step = counts[6];
}

static cdem_status fill_state(const cdem_run_output *output, cdem_state *state, cdem_fault *fault) {
  const cdem_run_setup *setup = output->setup;
  int64_t counts[COUNTS];
  const int64_t sums[SUMS] = {(int64_t)setup->case_sum, (int64_t)setup->input_sum,
                              (int64_t)setup->kept_sum};
  const int64_t over = output->over;
  const double reals[2] = {output->counters.peak, cdem_run_output_wall(output)};
  counters_out(&output->counters, counts);
  CDEM_TRY(cdem_state_add_copy(state, "run/counts", CDEM_ARRAY_INT64, COUNTS, counts, fault));
  CDEM_TRY(cdem_state_add_copy(state, "run/sums", CDEM_ARRAY_INT64, SUMS, sums, fault));
  CDEM_TRY(cdem_state_add_copy(state, "run/reals", CDEM_ARRAY_REAL, 2, reals, fault));
  CDEM_TRY(cdem_state_add_copy(state, "run/over", CDEM_ARRAY_INT64, 1, &over, fault));
  return setup->engine->save(setup, state, fault);
}

cdem_status cdem_run_output_checkpoint(cdem_run_output *output, cdem_fault *fault) {
  cdem_state state = {0};
  char path[4096];
  cdem_status status = fill_state(output, &state, fault);
  if (status == CDEM_OK)
    status = cdem_write_state(cdem_run_path(path, output->options->folder, "checkpoint.h5"), &state,
                              fault);
  cdem_state_release(&state);
  output->saved = cdem_run_clock();
  return status;
}

static cdem_status restore(cdem_run_output *output, const cdem_state *state, cdem_fault *fault) {
  int64_t counts[COUNTS], sums[SUMS], over = 0;
  double reals[2];
  CDEM_TRY(cdem_state_get(state, "run/counts", CDEM_ARRAY_INT64, COUNTS, counts, fault));
  CDEM_TRY(cdem_state_get(state, "run/sums", CDEM_ARRAY_INT64, SUMS, sums, fault));
  CDEM_TRY(cdem_state_get(state, "run/reals", CDEM_ARRAY_REAL, 2, reals, fault));
  if (cdem_state_find(state, "run/over") != NULL) /* not in older checkpoints */
    CDEM_TRY(cdem_state_get(state, "run/over", CDEM_ARRAY_INT64, 1, &over, fault));
  output->over = over != 0;
  CDEM_REQUIRE((uint64_t)sums[2] == output->setup->kept_sum, fault, CDEM_INPUT,
               "%s/case.yaml is not the case of the checkpoint beside it: it was changed since; "
               "start a new run",
               output->options->folder);
  for (int k = 0; k < COUNTS; k++) /* rows and frames are counted up; the last two may be -1 */
    CDEM_REQUIRE(
        counts[k] >= (k < 5 ? 0 : -1) && (k > 1 || counts[k] < INT64_MAX / 2), fault, CDEM_INPUT,
        "the array 'run/counts' of the checkpoint holds %lld at place %d, which cannot be; "
        "start a new run",
        (long long)counts[k], k);
  output->setup->case_sum = (uint64_t)sums[0];
  counters_in(counts, &output->counters);
  output->counters.peak = reals[0];
  output->counters.wall = reals[1];
  return CDEM_OK;
}

/* ---- rows and frames ---- */

/* Has the size of the column that may end the run fallen below the fraction of its peak? */
static bool fallen(cdem_run_output *output) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  const cdem_table *table = &output->history;
  if (values->stop_when == NULL)
    return false;
  const cdem_value *value =
      cdem_table_at(table, 0, cdem_run_history_find(table, values->stop_when));
  double size = value->absent ? 0.0 : fabs(value->real);
  if (size > output->counters.peak)
    output->counters.peak = size;
  return output->counters.peak > 0.0 && size < values->stop_below * output->counters.peak;
}

cdem_status cdem_run_output_row(cdem_run_output *output, bool *stop, cdem_fault *fault) {
  cdem_run_counters *c = &output->counters;
  int64_t steps = cdem_run_where(output->setup).steps;
  if (c->last_row_step == steps)
    return CDEM_OK;
  CDEM_TRY(cdem_run_history_row(output->setup, &output->history, fault));
  CDEM_TRY(cdem_history_append(output->rows, &output->history, fault));
  c->rows++;
  c->last_row_step = steps;
  bool ended = fallen(output);
  if (stop != NULL)
    *stop = *stop || ended;
  return CDEM_OK;
}

cdem_status cdem_run_output_frame(cdem_run_output *output, cdem_fault *fault) {
  cdem_run_counters *c = &output->counters;
  int64_t steps = cdem_run_where(output->setup).steps;
  if (output->frames == NULL || c->last_frame_step == steps)
    return CDEM_OK;
  cdem_frame_sink sink = cdem_frame_writer_sink(output->frames);
  CDEM_TRY(output->setup->engine->frames(output->setup, c->frames, &sink, fault));
  c->frames++;
  c->last_frame_step = steps;
  return CDEM_OK;
}

/* ---- opening and closing ---- */

static cdem_status open_files(cdem_run_output *output, cdem_fault *fault) {
  const cdem_run_options *options = output->options;
  char path[4096];
  CDEM_TRY(cdem_run_history_init(output->setup, &output->history, fault));
  CDEM_TRY(cdem_history_create(cdem_run_path(path, options->folder, "history.csv"),
                               &output->history, output->counters.rows, &output->rows, fault));
  if (options->frames)
    CDEM_TRY(
        cdem_frame_writer_create(options->folder, output->counters.frames, &output->frames, fault));
  return CDEM_OK;
}

static cdem_status first_output(cdem_run_output *output, cdem_fault *fault) {
  CDEM_TRY(cdem_run_output_row(output, NULL, fault));
  CDEM_TRY(cdem_run_output_frame(output, fault));
  return cdem_run_output_checkpoint(output, fault);
}

cdem_status cdem_run_output_open(cdem_run_setup *setup, const cdem_state *checkpoint,
                                 cdem_run_output *output, cdem_fault *fault) {
  output->setup = setup;
  output->options = setup->options;
  output->stride = 1;
  output->started = output->saved = cdem_run_clock();
  output->counters = (cdem_run_counters){.next_row = 1,
                                         .next_frame = 1,
                                         .next_checkpoint = 1,
                                         .last_row_step = -1,
                                         .last_frame_step = -1};
  cdem_status status = checkpoint != NULL ? restore(output, checkpoint, fault) : CDEM_OK;
  if (status == CDEM_OK)
    status = open_files(output, fault);
  if (status == CDEM_OK && checkpoint == NULL)
    status = first_output(output, fault);
  if (status != CDEM_OK)
    cdem_run_output_close(output);
  return status;
}

void cdem_run_output_close(cdem_run_output *output) {
  cdem_history_destroy(&output->rows);
  cdem_frame_writer_destroy(&output->frames);
  cdem_table_release(&output->history);
}
