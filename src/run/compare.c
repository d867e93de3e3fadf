/* Finished runs side by side: summaries read back, means and scatter from their histories. */
#include "run/compare.h"

#include "cases/case.h"
#include "run/compared.h"
#include "run/history.h"
#include "run/json.h"
#include "run/output.h"
#include "run/take.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What was read of the runs; history is empty where nothing needs it. */
typedef struct {
  const cdem_compare_options *options;
  int runs;
  cdem_summary_file *summary; /* [runs] */
  cdem_table *history;        /* [runs] */
} sources;

static void sources_release(sources *s) {
  for (int r = 0; s->summary != NULL && r < s->runs; r++)
    cdem_summary_file_release(&s->summary[r]);
  for (int r = 0; s->history != NULL && r < s->runs; r++)
    cdem_table_release(&s->history[r]);
  free(s->summary);
  free(s->history);
}

static bool is_mean(const cdem_summary_result *result) {
  return result->take != NULL && result->of != NULL && strcmp(result->take, "mean") == 0;
}

static bool needs_history(const sources *s, int run) {
  const cdem_summary_file *summary = &s->summary[run];
  for (int64_t i = 0; i < summary->results; i++)
    if (is_mean(&summary->result[i]))
      return true;
  return s->options->columns > 0;
}

static cdem_status read_all(sources *s, cdem_fault *fault) {
  char path[4096];
  CDEM_NEW(s->summary, s->runs, fault);
  CDEM_NEW(s->history, s->runs, fault);
  for (int r = 0; r < s->runs; r++) {
    const char *folder = s->options->folder[r];
    CDEM_TRY(cdem_compared_check(folder, fault));
    CDEM_TRY(cdem_read_summary(cdem_run_path(path, folder, "summary.json"), &s->summary[r], fault));
    if (needs_history(s, r))
      CDEM_TRY(cdem_compared_history(folder, &s->history[r], fault));
  }
  return CDEM_OK;
}

/* ---- rows ---- */

static cdem_compared_row *find_row(const cdem_comparison *c, cdem_compared_kind kind,
                                   const char *name) {
  for (int64_t i = 0; i < c->rows; i++)
    if (c->row[i].kind == kind && strcmp(c->row[i].name, name) == 0)
      return &c->row[i];
  return NULL;
}

static cdem_status add_row(cdem_comparison *c, cdem_compared_kind kind, const char *name,
                           const char *unit, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&c->row, &c->capacity, c->rows + 1, sizeof *c->row, fault));
  cdem_compared_row *row = &c->row[c->rows++]; /* zeroed */
  row->kind = kind;
  row->name = cdem_copy_text(name, fault);
  row->unit = cdem_copy_text(unit, fault);
  CDEM_NEW(row->run, c->runs, fault);
  for (int r = 0; r < c->runs; r++)
    row->run[r] = (cdem_compared){.value = NAN, .scatter = NAN, .difference = NAN};
  return row->name != NULL && row->unit != NULL ? CDEM_OK : CDEM_MEMORY;
}

static const char *unit_text(const char *unit) {
  return unit[0] != '\0' ? unit : "no unit";
}

/* The row of this name, made where it is new. */
static cdem_status want_row(cdem_comparison *c, cdem_compared_kind kind, const char *name,
                            const char *unit, int run, cdem_compared_row **row, cdem_fault *fault) {
  *row = find_row(c, kind, name);
  if (*row == NULL) {
    CDEM_TRY(add_row(c, kind, name, unit, fault));
    *row = &c->row[c->rows - 1];
    (*row)->first = run;
  }
  if (strcmp((*row)->unit, unit) == 0)
    return CDEM_OK;
  return cdem_fail(fault, CDEM_INPUT,
                   "'%s' cannot be compared: it has %s in '%s' and %s in '%s'; give it one unit in "
                   "both cases (a result with a factor has none)",
                   name, unit_text((*row)->unit), c->run[(*row)->first], unit_text(unit),
                   c->run[run]);
}

static cdem_status scatter_of(const sources *s, int run, const cdem_summary_result *result,
                              double *scatter, cdem_fault *fault) {
  int column = cdem_run_history_find(&s->history[run], result->of);
  CDEM_REQUIRE(column >= 0, fault, CDEM_INPUT,
               "'%s/history.csv' has no column '%s', of which '%s' is the mean; run the case again",
               s->options->folder[run], result->of, result->name);
  const cdem_run_taking taking = {.take = CDEM_TAKE_SCATTER,
                                  .from = result->from,
                                  .to = result->to,
                                  .factor = isnan(result->factor) ? 1.0 : result->factor,
                                  .columns = 1,
                                  .column = &column};
  *scatter = cdem_run_take(&s->history[run], &taking);
  return CDEM_OK;
}

static cdem_status add_results(const sources *s, cdem_comparison *c, cdem_fault *fault) {
  for (int r = 0; r < s->runs; r++)
    for (int64_t i = 0; i < s->summary[r].results; i++) {
      const cdem_summary_result *result = &s->summary[r].result[i];
      cdem_compared_row *row;
      CDEM_TRY(want_row(c, CDEM_COMPARED_RESULT, result->name,
                        result->unit != NULL ? result->unit : "", r, &row, fault));
      row->run[r].value = result->value;
      if (is_mean(result))
        CDEM_TRY(scatter_of(s, r, result, &row->run[r].scatter, fault));
    }
  return CDEM_OK;
}

/* ---- windows ---- */

static cdem_status fail_window(const sources *s, const char *name, cdem_fault *fault) {
  const cdem_compare_options *options = s->options;
  double first = INFINITY, last = -INFINITY;
  for (int r = 0; r < s->runs; r++) {
    const cdem_table *history = &s->history[r];
    int clock = cdem_table_find(history, "time");
    for (int64_t i = 0; clock >= 0 && i < history->rows; i++) {
      first = fmin(first, cdem_table_at(history, i, clock)->real);
      last = fmax(last, cdem_table_at(history, i, clock)->real);
    }
  }
  char begin[40] = "", end[40] = "";
  if (!isnan(options->from))
    snprintf(begin, sizeof begin, " from %g s", options->from);
  if (!isnan(options->to))
    snprintf(end, sizeof end, " to %g s", options->to);
  return cdem_fail(fault, CDEM_INPUT,
                   "no run has a value of '%s' in a row%s%s; the histories reach from %g s to %g s",
                   name, begin, end, first, last);
}

static cdem_status add_window(const sources *s, const char *name, cdem_comparison *c,
                              cdem_fault *fault) {
  const cdem_compare_options *options = s->options;
  bool any = false;
  CDEM_TRY(cdem_compared_column(s->history, s->runs, name, fault));
  for (int r = 0; r < s->runs; r++) {
    const cdem_table *history = &s->history[r];
    int column = cdem_run_history_find(history, name);
    if (column < 0)
      continue;
    cdem_compared_row *row;
    cdem_run_taking taking = {.take = CDEM_TAKE_MEAN,
                              .from = options->from,
                              .to = options->to,
                              .factor = 1.0,
                              .columns = 1,
                              .column = &column};
    CDEM_TRY(want_row(c, CDEM_COMPARED_WINDOW, name, history->column[column].unit, r, &row, fault));
    row->run[r].value = cdem_run_take(history, &taking);
    taking.take = CDEM_TAKE_SCATTER;
    row->run[r].scatter = cdem_run_take(history, &taking);
    any = any || !isnan(row->run[r].value);
  }
  return any ? CDEM_OK : fail_window(s, name, fault);
}

/* ---- the whole ---- */

static void set_differences(cdem_comparison *c) {
  for (int64_t i = 0; i < c->rows; i++) {
    cdem_compared *run = c->row[i].run;
    double a = run[0].value;
    for (int r = 1; r < c->runs; r++)
      if (a != 0.0)
        run[r].difference = (run[r].value - a) / fabs(a);
      else if (run[r].value == 0.0)
        run[r].difference = 0.0;
  }
}

static cdem_status fill(sources *s, cdem_comparison *c, cdem_fault *fault) {
  const cdem_compare_options *options = s->options;
  c->runs = options->runs;
  c->from = options->from;
  c->to = options->to;
  CDEM_TRY(read_all(s, fault));
  CDEM_NEW(c->run, c->runs, fault);
  CDEM_TRY(cdem_compared_names(c->runs, options->folder, c->run, fault));
  CDEM_TRY(add_results(s, c, fault));
  for (int k = 0; k < options->columns; k++)
    CDEM_TRY(add_window(s, options->column[k], c, fault));
  CDEM_TRY(add_row(c, CDEM_COMPARED_WALL_TIME, "wall_time", "s", fault));
  for (int r = 0; r < c->runs; r++)
    c->row[c->rows - 1].run[r].value = s->summary[r].wall_time;
  set_differences(c);
  return CDEM_OK;
}

cdem_status cdem_compare(const cdem_compare_options *options, cdem_comparison *comparison,
                         cdem_fault *fault) {
  sources s = {.options = options, .runs = options->runs};
  cdem_comparison made = {0};
  cdem_status status = fill(&s, &made, fault);
  sources_release(&s);
  if (status == CDEM_OK)
    *comparison = made;
  else
    cdem_comparison_release(&made);
  return status;
}

void cdem_comparison_release(cdem_comparison *comparison) {
  for (int r = 0; comparison->run != NULL && r < comparison->runs; r++)
    free(comparison->run[r]);
  for (int64_t i = 0; i < comparison->rows; i++) {
    free(comparison->row[i].name);
    free(comparison->row[i].unit);
    free(comparison->row[i].run);
  }
  free(comparison->run);
  free(comparison->row);
  *comparison = (cdem_comparison){0};
}

/* ---- as text ---- */

static void put_row(cdem_json *json, const cdem_comparison *c, const cdem_compared_row *row) {
  static const char *const kind[] = {"result", "window", "wall_time"};
  cdem_json_open(json, NULL, '{');
  cdem_json_string(json, "name", row->name);
  cdem_json_string(json, "kind", kind[row->kind]);
  cdem_json_string(json, "unit", row->unit);
  cdem_json_open(json, "values", '[');
  for (int r = 0; r < c->runs; r++) {
    cdem_json_open(json, NULL, '{');
    cdem_json_string(json, "run", c->run[r]);
    cdem_json_real(json, "value", row->run[r].value);
    cdem_json_real(json, "scatter", row->run[r].scatter);
    cdem_json_real(json, "difference", row->run[r].difference);
    cdem_json_close(json, '}');
  }
  cdem_json_close(json, ']');
  cdem_json_close(json, '}');
}

cdem_status cdem_comparison_json(const cdem_comparison *comparison, char **text,
                                 cdem_fault *fault) {
  cdem_json json = {.fault = fault};
  cdem_json_open(&json, NULL, '{');
  cdem_json_open(&json, "runs", '[');
  for (int r = 0; r < comparison->runs; r++)
    cdem_json_string(&json, NULL, comparison->run[r]);
  cdem_json_close(&json, ']');
  cdem_json_real(&json, "from", comparison->from);
  cdem_json_real(&json, "to", comparison->to);
  cdem_json_open(&json, "rows", '[');
  for (int64_t i = 0; i < comparison->rows; i++)
    put_row(&json, comparison, &comparison->row[i]);
  cdem_json_close(&json, ']');
  cdem_json_close(&json, '}');
  cdem_status status = json.status;
  if (status == CDEM_OK) {
    *text = json.text;
    json.text = NULL;
  }
  cdem_json_release(&json);
  return status;
}

/* A number with so many digits, as people write it: 1.684e6, not 1.684e+06 or 12. */
static void put_number(double value, int digits, bool zeros, char text[24]) {
  snprintf(text, 24, zeros ? "%#.*g" : "%.*g", digits, value);
  char *comma = strchr(text, ','), *power = strchr(text, 'e'); /* comma: some locales */
  if (comma != NULL)
    *comma = '.';
  char *end = power != NULL ? power : text + strlen(text);
  if (end > text && end[-1] == '.') {
    memmove(end - 1, end, strlen(end) + 1);
    power = power != NULL ? power - 1 : NULL;
  }
  if (power == NULL)
    return;
  int exponent = (int)strtol(power + 1, NULL, 10);
  snprintf(power + 1, (size_t)(text + 24 - power - 1), "%d", exponent);
}

static int exponent_of(double value) {
  return value != 0.0 ? (int)floor(log10(fabs(value))) : 0;
}

void cdem_compared_text(const cdem_compared *compared, char text[CDEM_COMPARED_TEXT]) {
  double value = compared->value, scatter = compared->scatter;
  char number[24], swing[24];
  text[0] = '\0';
  if (isnan(value))
    return;
  bool swings = !isnan(scatter), zeros = swings && scatter > 0.0;
  int digits = 6;
  if (zeros && value != 0.0) {
    digits = exponent_of(value) - exponent_of(scatter) + 2;
    digits = digits < 4 ? 4 : digits > 9 ? 9 : digits;
  }
  put_number(value, digits, zeros && value != 0.0, number);
  put_number(swings ? scatter : 0.0, 2, zeros, swing);
  snprintf(text, CDEM_COMPARED_TEXT, "%s%s%s", number, swings ? " ± " : "", swings ? swing : "");
}
