/* Key results of a run, and summary.json. */
#include "run/summary.h"

#include "io/io.h"
#include "run/take.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME, VALUE, UNIT, REFERENCE, DIFFERENCE }; /* columns of summary->keys */

void cdem_run_summary_release(cdem_run_summary *summary) {
  free(summary->title);
  for (int64_t i = 0; i < summary->warnings; i++)
    free(summary->warning[i]);
  free(summary->warning);
  cdem_table_release(&summary->keys);
  *summary = (cdem_run_summary){0};
}

cdem_status cdem_run_summary_sizes(const cdem_run_setup *setup, cdem_run_summary *summary,
                                   cdem_fault *fault) {
  CDEM_TRY(setup->engine->sizes(setup, summary, fault));
  bool steps = cdem_run_values(setup)->analysis != CDEM_ANALYSIS_STATIC;
  summary->step = steps ? cdem_run_where(setup).step : 0.0;
  memcpy(summary->limiter, setup->limiter, sizeof summary->limiter);
  return CDEM_OK;
}

/* ---- key results ---- */

static bool is_place(const cdem_case_key_result *result) {
  return result->take == CDEM_TAKE_PLACE_OF_MAX || result->take == CDEM_TAKE_PLACE_OF_MIN;
}

static int along(const cdem_table *history, const cdem_case_key_result *result) {
  return cdem_run_history_find(history, result->along != NULL ? result->along : "time");
}

static double taken(const cdem_table *history, const cdem_case_key_result *result, int columns,
                    const int *column, double factor) {
  const cdem_run_taking taking = {.take = result->take,
                                  .from = result->from,
                                  .to = result->to,
                                  .factor = factor,
                                  .columns = columns,
                                  .column = column,
                                  .along = along(history, result)};
  return cdem_run_take(history, &taking);
}

/* The expected value; NaN: none. */
static cdem_status expected(const cdem_case_key_result *result, const cdem_table *history,
                            double *reference, cdem_fault *fault) {
  int columns = (int)result->against.count, *column = NULL;
  *reference = result->reference;
  if (columns == 0)
    return CDEM_OK;
  CDEM_NEW(column, columns, fault);
  for (int c = 0; c < columns; c++)
    column[c] = cdem_run_history_find(history, result->against.item[c]);
  *reference = taken(history, result, columns, column, result->against_factor);
  free(column);
  return CDEM_OK;
}

static double difference(double value, double reference) {
  return reference != 0.0 ? (value - reference) / fabs(reference) : value;
}

/* A factor that is more than a sign may carry a unit of its own (1/area: force to stress); a place
 * has the unit of the column in which it lies, which no factor touches. */
static void put_unit(const cdem_case_key_result *result, const cdem_table *history, int column,
                     char unit[32]) {
  unit[0] = '\0';
  if (is_place(result))
    snprintf(unit, 32, "%.24s", history->column[along(history, result)].unit);
  else if (fabs(result->factor) == 1.0)
    snprintf(unit, 32, "%.24s%s", history->column[column].unit,
             result->take == CDEM_TAKE_SLOPE ? "/s" : "");
}

static cdem_status add_key(const cdem_case_key_result *result, const cdem_table *history,
                           cdem_run_summary *summary, cdem_fault *fault) {
  cdem_table *keys = &summary->keys;
  int column = cdem_run_history_find(history, result->of);
  double value = taken(history, result, 1, &column, result->factor), reference;
  char unit[32];
  CDEM_TRY(expected(result, history, &reference, fault));
  CDEM_TRY(cdem_table_add_row(keys, fault));
  CDEM_TRY(cdem_table_set_text(keys, NAME, result->name, fault));
  put_unit(result, history, column, unit);
  CDEM_TRY(cdem_table_set_text(keys, UNIT, unit, fault));
  cdem_table_set_real(keys, VALUE, value);
  if (isnan(result->reference) && result->against.count == 0)
    return CDEM_OK;
  double off = difference(value, reference);
  cdem_table_set_real(keys, REFERENCE, reference);
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
  CDEM_TRY(cdem_run_summary_sizes(setup, summary, fault));
  const cdem_run_now now = cdem_run_where(setup);
  summary->steps = now.steps;
  summary->time = now.time;
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
  if (options->build != NULL)
    cdem_json_string(json, "build", options->build);
  cdem_json_string(json, "title", cdem_run_values(setup)->title);
  cdem_json_string(json, "case", options->path);
  cdem_json_open(json, "checksums", '{');
  put_sum(json, "case", setup->case_sum);
  put_sum(json, cdem_case_has_grains(&setup->cases) ? "grains" : "mesh", setup->input_sum);
  cdem_json_close(json, '}');
  cdem_json_integer(json, "threads", setup->threads);
}

static void put_progress(cdem_json *json, const cdem_run_summary *summary) {
  cdem_json_real(json, "wall_time", summary->wall);
  cdem_json_integer(json, "steps", summary->steps);
  cdem_json_real(json, "time", summary->time);
  cdem_json_real(json, "time_step", summary->step);
  cdem_json_string(json, "step_limited_by", summary->limiter);
}

static void put_warnings(cdem_json *json, const cdem_run_summary *summary) {
  cdem_json_open(json, "warnings", '[');
  for (int64_t i = 0; i < summary->warnings; i++)
    cdem_json_string(json, NULL, summary->warning[i]);
  cdem_json_close(json, ']');
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
    if (!isnan(tolerance))
      cdem_json_boolean(json, "pass", fabs(off) <= tolerance);
    cdem_json_close(json, '}');
  }
  cdem_json_close(json, '}');
}

cdem_status cdem_run_summary_write(const cdem_run_output *output, const cdem_table *history,
                                   const cdem_run_summary *summary, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  cdem_json json = {.fault = fault};
  char path[4096];
  cdem_json_open(&json, NULL, '{');
  put_program(&json, output);
  put_progress(&json, summary);
  output->setup->engine->put_sizes(&json, summary);
  cdem_json_real(&json, "energy_error", summary->energy_error);
  put_warnings(&json, summary);
  put_results(&json, values, summary);
  put_last(&json, history);
  cdem_run_put_settings(&json, values);
  cdem_json_close(&json, '}');
  cdem_status status = json.status;
  if (status == CDEM_OK)
    status = cdem_write_text(cdem_run_path(path, output->options->folder, "summary.json"),
                             json.text, json.used, fault);
  cdem_json_release(&json);
  return status;
}
