/* The columns of history.csv: those of every run here, the others by the engine. */
#include "run/history.h"

#include "base/suggest.h"

#include <stdio.h>
#include <string.h>

static cdem_status put_all(cdem_run_row *row, cdem_run_setup *setup) {
  const cdem_run_now now = cdem_run_where(setup);
  cdem_run_put(row, "s", now.time, "time");
  cdem_run_put(row, "", (double)now.steps, "step");
  cdem_run_put(row, "s", now.step, "time_step");
  setup->engine->columns(setup, row);
  return row->status;
}

/* ---- names in the case ---- */

static cdem_status check_column(const cdem_run_setup *setup, const cdem_table *table,
                                const char *key, const char *name, cdem_fault *fault) {
  enum { MOST = 256 };
  const char *candidate[MOST];
  char known[400] = "";
  if (cdem_run_history_find(table, name) >= 0)
    return CDEM_OK;
  int count = table->columns < MOST ? table->columns : MOST;
  for (int c = 0; c < count; c++) {
    candidate[c] = table->column[c].name;
    size_t used = strlen(known);
    if (used + strlen(candidate[c]) + 8 < sizeof known)
      snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "", candidate[c]);
  }
  const char *nearest = cdem_suggest(name, candidate, count);
  return cdem_case_fail(&setup->cases, key, CDEM_INPUT, fault,
                        "history.csv has no column '%s'%s%s%s this run has %s", name,
                        nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
                        nearest != NULL ? "'?" : ";", known);
}

static cdem_status check_names(const cdem_run_setup *setup, const cdem_table *table,
                               cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup);
  char key[96];
  for (int64_t p = 0; p < values->probes.count; p++)
    if (cdem_table_find(table, values->probes.item[p].name) >= 0)
      return cdem_case_fail(
          &setup->cases, cdem_run_named_key(key, "probes", values->probes.item[p].name, ""),
          CDEM_INPUT, fault, "'%s' is a column of this history; give the probe another name",
          values->probes.item[p].name);
  if (values->stop_when != NULL)
    CDEM_TRY(check_column(setup, table, "stop_when", values->stop_when, fault));
  for (int64_t i = 0; i < values->curves.count; i++) {
    const cdem_case_curve *curve = &values->curves.item[i];
    if (curve->x != NULL)
      CDEM_TRY(check_column(setup, table, cdem_run_named_key(key, "curves", curve->name, "x"),
                            curve->x, fault));
    for (int64_t y = 0; y < curve->y.count; y++)
      CDEM_TRY(check_column(setup, table, cdem_run_named_key(key, "curves", curve->name, "y"),
                            curve->y.item[y], fault));
  }
  for (int64_t i = 0; i < values->results.count; i++) {
    const cdem_case_key_result *result = &values->results.item[i];
    CDEM_TRY(check_column(setup, table, cdem_run_named_key(key, "results", result->name, "of"),
                          result->of, fault));
    if (result->along != NULL)
      CDEM_TRY(check_column(setup, table, cdem_run_named_key(key, "results", result->name, "along"),
                            result->along, fault));
    for (int64_t c = 0; c < result->against.count; c++)
      CDEM_TRY(check_column(setup, table,
                            cdem_run_named_key(key, "results", result->name, "against"),
                            result->against.item[c], fault));
  }
  return CDEM_OK;
}

cdem_status cdem_run_history_init(cdem_run_setup *setup, cdem_table *table, cdem_fault *fault) {
  cdem_run_row row = {.table = table, .declare = true, .fault = fault};
  CDEM_TRY(put_all(&row, setup));
  return check_names(setup, table, fault);
}

cdem_status cdem_run_history_row(cdem_run_setup *setup, cdem_table *table, cdem_fault *fault) {
  table->rows = 0; /* rows live in the file */
  CDEM_TRY(cdem_table_add_row(table, fault));
  cdem_run_row row = {.table = table, .fault = fault};
  return put_all(&row, setup);
}
