/* Key results of a run, and summary.json. */
#include "run/summary.h"

#include "io/io.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME, VALUE, UNIT, REFERENCE, DIFFERENCE }; /* columns of summary->keys */
enum { MAX, MIN, LAST, MEAN };                     /* the choices of `take` */

void cdem_run_summary_release(cdem_run_summary *summary) {
  free(summary->title);
  cdem_table_release(&summary->keys);
  *summary = (cdem_run_summary){0};
}

void cdem_run_summary_sizes(const cdem_run_setup *setup, cdem_run_summary *summary) {
  summary->nodes = setup->body.nodes;
  summary->unknowns = (int64_t)setup->body.nodes * setup->body.dofs;
  summary->elements = setup->model.cells;
  summary->distinct = setup->body.distinct;
  summary->blocks = setup->blocks.blocks;
  summary->interfaces = setup->blocks.pairs;
  bool steps = cdem_run_values(setup)->analysis != CDEM_ANALYSIS_STATIC;
  summary->step = steps ? setup->solver.step : 0.0;
  memcpy(summary->limiter, setup->limiter, sizeof summary->limiter);
}

/* ---- key results ---- */

/* max, min, last or mean over the rows that have a value; NaN when none has. */
static double taken(const cdem_table *history, int column, int take, double factor) {
  double found = NAN, sum = 0.0;
  int64_t count = 0;
  for (int64_t r = 0; r < history->rows; r++) {
    const cdem_value *value = cdem_table_at(history, r, column);
    if (value->absent)
      continue;
    double v = factor * value->real;
    bool first = count++ == 0;
    sum += v;
    if (first || take == LAST || (take == MAX && v > found) || (take == MIN && v < found))
      found = v;
  }
  return take == MEAN && count > 0 ? sum / (double)count : found;
}

static double difference(double value, double reference) {
  return reference != 0.0 ? (value - reference) / fabs(reference) : value;
}

static cdem_status add_key(const cdem_case_key_result *result, const cdem_table *history,
                           cdem_run_summary *summary, cdem_fault *fault) {
  cdem_table *keys = &summary->keys;
  int column = cdem_run_history_find(history, result->of);
  double value = taken(history, column, result->take, result->factor);
  CDEM_TRY(cdem_table_add_row(keys, fault));
  CDEM_TRY(cdem_table_set_text(keys, NAME, result->name, fault));
  /* A factor that is more than a sign may carry a unit of its own (1/area: force to stress). */
  bool plain = fabs(result->factor) == 1.0;
  CDEM_TRY(cdem_table_set_text(keys, UNIT, plain ? history->column[column].unit : "", fault));
  cdem_table_set_real(keys, VALUE, value);
  if (isnan(result->reference))
    return CDEM_OK;
  double off = difference(value, result->reference);
  cdem_table_set_real(keys, REFERENCE, result->reference);
  cdem_table_set_real(keys, DIFFERENCE, off);
  summary->results++;
  summary->failed += !isnan(result->tolerance) && !(fabs(off) <= result->tolerance);
  return CDEM_OK;
}

static cdem_status fill(cdem_run_output *output, const cdem_table *history,
                        cdem_run_summary *summary, cdem_fault *fault) {
  const cdem_run_setup *setup = output->setup;
  const cdem_case_values *values = cdem_run_values(setup);
  int error = cdem_table_find(history, "energy_error");
  cdem_run_summary_sizes(setup, summary);
  summary->steps = setup->solver.steps;
  summary->time = setup->solver.time;
  summary->wall = cdem_run_output_wall(output);
  if (history->rows > 0 && !cdem_table_at(history, history->rows - 1, error)->absent)
    summary->energy_error = cdem_table_at(history, history->rows - 1, error)->real;
  if (values->title != NULL && (summary->title = cdem_copy_text(values->title, fault)) == NULL)
    return CDEM_MEMORY;
  CDEM_TRY(cdem_table_add_column(&summary->keys, "name", CDEM_COLUMN_TEXT, "", fault));
  CDEM_TRY(cdem_table_add_column(&summary->keys, "value", CDEM_COLUMN_REAL, "", fault));
  CDEM_TRY(cdem_table_add_column(&summary->keys, "unit", CDEM_COLUMN_TEXT, "", fault));
  CDEM_TRY(cdem_table_add_column(&summary->keys, "reference", CDEM_COLUMN_REAL, "", fault));
  CDEM_TRY(cdem_table_add_column(&summary->keys, "difference", CDEM_COLUMN_REAL, "", fault));
  for (int64_t i = 0; i < values->results.count; i++)
    CDEM_TRY(add_key(&values->results.item[i], history, summary, fault));
  return CDEM_OK;
}

cdem_status cdem_run_summary_fill(cdem_run_output *output, const cdem_table *history,
                                  cdem_run_summary *summary, cdem_fault *fault) {
  cdem_status status = fill(output, history, summary, fault);
  if (status != CDEM_OK)
    cdem_run_summary_release(summary);
  return status;
}

/* ---- summary.json ---- */

static void put_sum(cdem_json *json, const char *name, uint64_t sum) {
  char text[32];
  snprintf(text, sizeof text, "fnv1a64:%016" PRIx64, sum);
  cdem_json_string(json, name, text);
}

static void put_program(cdem_json *json, const cdem_run_output *output) {
  const cdem_run_options *options = output->options;
  const cdem_run_setup *setup = output->setup;
  cdem_json_string(json, "program", "cdem");
  cdem_json_string(json, "version", options->version);
  cdem_json_string(json, "commit", options->commit);
  cdem_json_string(json, "title", cdem_run_values(setup)->title);
  cdem_json_string(json, "case", options->path);
  cdem_json_open(json, "checksums", '{');
  put_sum(json, "case", setup->case_sum);
  put_sum(json, "mesh", setup->mesh_sum);
  cdem_json_close(json, '}');
  cdem_json_integer(json, "threads", setup->threads);
}

static void put_sizes(cdem_json *json, const cdem_run_summary *summary) {
  cdem_json_real(json, "wall_time", summary->wall);
  cdem_json_integer(json, "steps", summary->steps);
  cdem_json_real(json, "time", summary->time);
  cdem_json_real(json, "time_step", summary->step);
  cdem_json_string(json, "step_limited_by", summary->limiter);
  cdem_json_integer(json, "nodes", summary->nodes);
  cdem_json_integer(json, "unknowns", summary->unknowns);
  cdem_json_integer(json, "elements", summary->elements);
  cdem_json_integer(json, "distinct_elements", summary->distinct);
  cdem_json_integer(json, "blocks", summary->blocks);
  cdem_json_integer(json, "interfaces", summary->interfaces);
}

/* The last row of the history: energies, cracks, reactions, probes. */
static void put_last(cdem_json *json, const cdem_table *history) {
  cdem_json_open(json, "last", '{');
  for (int c = 0; history->rows > 0 && c < history->columns; c++) {
    const cdem_value *value = cdem_table_at(history, history->rows - 1, c);
    cdem_json_real(json, history->column[c].name, value->absent ? NAN : value->real);
  }
  cdem_json_close(json, '}');
}

static double real_or_nan(const cdem_table *table, int64_t row, int column) {
  const cdem_value *value = cdem_table_at(table, row, column);
  return value->absent ? NAN : value->real;
}

static void put_results(cdem_json *json, const cdem_case_values *values,
                        const cdem_run_summary *summary) {
  const cdem_table *keys = &summary->keys;
  cdem_json_open(json, "results", '{');
  for (int64_t r = 0; r < keys->rows; r++) {
    double tolerance = values->results.item[r].tolerance, off = real_or_nan(keys, r, DIFFERENCE);
    cdem_json_open(json, cdem_table_at(keys, r, NAME)->text, '{');
    cdem_json_real(json, "value", real_or_nan(keys, r, VALUE));
    cdem_json_string(json, "unit", cdem_table_at(keys, r, UNIT)->text);
    cdem_json_real(json, "reference", real_or_nan(keys, r, REFERENCE));
    cdem_json_real(json, "difference", off);
    cdem_json_real(json, "tolerance", tolerance);
    if (!isnan(tolerance) && !isnan(values->results.item[r].reference))
      cdem_json_boolean(json, "pass", fabs(off) <= tolerance);
    cdem_json_close(json, '}');
  }
  cdem_json_close(json, '}');
}

static cdem_status write_text(const char *path, const cdem_json *json, cdem_fault *fault) {
  cdem_output *file = NULL;
  CDEM_TRY(cdem_output_open(path, &file, fault));
  cdem_status status = cdem_output_write(file, json->text, (size_t)json->used, fault);
  if (status == CDEM_OK)
    status = cdem_output_commit(&file, fault);
  cdem_output_discard(&file);
  return status;
}

cdem_status cdem_run_summary_write(const cdem_run_output *output, const cdem_table *history,
                                   const cdem_run_summary *summary, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  cdem_json json = {.fault = fault};
  char path[4096];
  cdem_json_open(&json, NULL, '{');
  put_program(&json, output);
  put_sizes(&json, summary);
  cdem_json_real(&json, "energy_error", summary->energy_error);
  put_results(&json, values, summary);
  put_last(&json, history);
  cdem_run_put_settings(&json, values);
  cdem_json_close(&json, '}');
  cdem_status status = json.status;
  if (status == CDEM_OK)
    status = write_text(cdem_run_path(path, output->options->folder, "summary.json"), &json, fault);
  cdem_json_release(&json);
  return status;
}
