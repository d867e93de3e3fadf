#include "verify/bsm_runs.h"

#include "base/memory.h"
#include "io/io.h"
#include "io/run_files.h"
#include "run/run.h"
#include "verify/bsm_cases.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { KEPT = 48, KEY = 600 };

static const char *const case_text[CDEM_BSM_CASES] = {
    [CDEM_BSM_FOUNDATION] = foundation_a_case,
    [CDEM_BSM_SOLID] = foundation_3d_case,
    [CDEM_BSM_CEMENTED] = footing_cemented_case,
};

static struct {
  char key[KEY];
  cdem_table history;
} kept[KEPT];
static int kept_count;

/* ---- one run ---- */

static cdem_status run_in(const char *scratch, cdem_bsm_case wanted, const char *const *override,
                          cdem_table *history, cdem_fault *fault) {
  char path[160], folder[128];
  int count = 0;
  cdem_run_summary summary = {0};
  while (override[count] != NULL)
    count++;
  snprintf(path, sizeof path, "%s/case.yaml", scratch);
  snprintf(folder, sizeof folder, "%s/run", scratch);
  const cdem_run_options options = {
      .path = path, .folder = folder, .overrides = count, .override = override};
  CDEM_TRY(cdem_write_text(path, case_text[wanted], (int64_t)strlen(case_text[wanted]), fault));
  cdem_status status = cdem_run(&options, &summary, fault);
  cdem_run_summary_release(&summary);
  CDEM_TRY(status);
  snprintf(path, sizeof path, "%s/history.csv", folder);
  return cdem_read_history(path, history, fault);
}

cdem_status cdem_bsm_run(cdem_bsm_case wanted, const char *const *override,
                         const cdem_table **history, cdem_fault *fault) {
  char key[KEY] = "", scratch[64];
  cdem_table table = {0};
  snprintf(key, sizeof key, "%d;", (int)wanted);
  for (int i = 0; override[i] != NULL; i++) {
    size_t used = strlen(key);
    snprintf(key + used, sizeof key - used, "%s;", override[i]);
  }
  for (int i = 0; i < kept_count; i++)
    if (strcmp(kept[i].key, key) == 0) {
      *history = &kept[i].history;
      return CDEM_OK;
    }
  CDEM_REQUIRE(kept_count < KEPT && strlen(key) < sizeof key - 1, fault, CDEM_USAGE,
               "too many runs, or overrides, of one verification");
  CDEM_TRY(cdem_make_scratch(scratch, fault));
  cdem_status status = run_in(scratch, wanted, override, &table, fault);
  cdem_remove_scratch(scratch);
  CDEM_TRY(status);
  memcpy(kept[kept_count].key, key, sizeof key);
  kept[kept_count].history = table;
  *history = &kept[kept_count++].history;
  return CDEM_OK;
}

/* ---- what a history says ---- */

double cdem_bsm_at(const cdem_table *history, int64_t row, const char *column) {
  int c = cdem_table_find(history, column);
  if (c < 0)
    return NAN;
  const cdem_value *value = cdem_table_at(history, row, c);
  return value->absent ? NAN : value->real;
}

double cdem_bsm_last(const cdem_table *history, const char *column) {
  static const double window = 2e-3;
  int64_t first = history->rows - 1;
  double end = cdem_bsm_at(history, first, "time"), sum = 0.0;
  while (first > 0 && cdem_bsm_at(history, first - 1, "time") > end - window - 1e-9)
    first--;
  for (int64_t r = first; r < history->rows; r++)
    sum += cdem_bsm_at(history, r, column);
  return sum / (double)(history->rows - first);
}

double cdem_bsm_largest(const cdem_table *history, const char *column, double from, int64_t *row) {
  double most = -INFINITY;
  for (int64_t r = 0; r < history->rows; r++) {
    double value = cdem_bsm_at(history, r, column);
    if (!(cdem_bsm_at(history, r, "time") >= from && value > most))
      continue;
    most = value;
    if (row != NULL)
      *row = r;
  }
  return most;
}

double cdem_bsm_apart(const cdem_table *a, const cdem_table *b, const char *column) {
  double off = 0.0, all = 0.0;
  if (a->rows != b->rows)
    return NAN;
  for (int64_t r = 0; r < a->rows; r++) {
    double one = cdem_bsm_at(a, r, column), other = cdem_bsm_at(b, r, column);
    off += fabs(one - other);
    all += other;
  }
  return off / all;
}
