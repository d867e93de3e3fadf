/* Axes and legends in units that keep their numbers short. */
#include "run/axis.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

cdem_run_axis cdem_run_axis_for(const char *unit, double largest) {
  static const char *const prefixed[] = {"s", "m", "m/s", "N", "N m", "Pa", "J"};
  static const struct {
    double size;
    const char *symbol;
  } prefix[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"}, {1.0, ""},
                {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}};
  cdem_run_axis found = {.factor = 1.0};
  snprintf(found.unit, sizeof found.unit, "%.30s", unit);
  bool known = false;
  for (size_t i = 0; i < sizeof prefixed / sizeof prefixed[0]; i++)
    known = known || strcmp(unit, prefixed[i]) == 0;
  for (size_t i = 0; known && largest > 0.0 && i < sizeof prefix / sizeof prefix[0]; i++)
    if (largest * (1.0 + 1e-6) >= prefix[i].size || i + 1 == sizeof prefix / sizeof prefix[0]) {
      found.factor = 1.0 / prefix[i].size;
      snprintf(found.unit, sizeof found.unit, "%s%.30s", prefix[i].symbol, unit);
      break;
    }
  return found;
}

double cdem_run_largest(const double *value, int64_t count) {
  double largest = 0.0;
  for (int64_t i = 0; i < count; i++)
    if (fabs(value[i]) > largest)
      largest = fabs(value[i]);
  return largest;
}

void cdem_run_rescale(double *value, int64_t count, double factor) {
  for (int64_t i = 0; i < count; i++)
    value[i] *= factor;
}

void cdem_run_label(const char *name, const char *unit, char text[CDEM_RUN_LABEL]) {
  size_t used = 0;
  for (const char *c = name; *c != '\0' && used + 24 < CDEM_RUN_LABEL; c++) {
    if (strchr("_^{}\\@&~", *c) != NULL)
      text[used++] = '\\';
    text[used++] = *c;
  }
  snprintf(text + used, CDEM_RUN_LABEL - used, "%s%.16s%s", unit[0] != '\0' ? " [" : "", unit,
           unit[0] != '\0' ? "]" : "");
}

int cdem_run_history_find(const cdem_table *table, const char *name) {
  char probe[160];
  int column = cdem_table_find(table, name);
  snprintf(probe, sizeof probe, "probe.%s", name);
  return column >= 0 ? column : cdem_table_find(table, probe);
}

const char *cdem_run_bare_name(const cdem_table *history, int column) {
  const char *name = history->column[column].name;
  return name + (strncmp(name, "probe.", 6) == 0 ? 6 : 0);
}

cdem_status cdem_run_column_values(const cdem_table *history, int column, double scale,
                                   double **values, cdem_fault *fault) {
  CDEM_NEW(*values, history->rows, fault);
  for (int64_t r = 0; r < history->rows; r++) {
    const cdem_value *value = cdem_table_at(history, r, column);
    (*values)[r] = value->absent ? NAN : scale * value->real;
  }
  return CDEM_OK;
}
