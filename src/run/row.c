/* Columns, one by one and in the groups that several engines have alike. */
#include "run/row.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void cdem_run_put(cdem_run_row *row, const char *unit, double value, const char *format, ...) {
  if (row->status != CDEM_OK)
    return;
  if (!row->declare) {
    cdem_table_set_real(row->table, row->column++, value);
    return;
  }
  char name[160], whole[200];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(name, sizeof name, format, arguments);
  va_end(arguments);
  bool plain = row->prefix != NULL && strchr(name, '.') == NULL;
  snprintf(whole, sizeof whole, "%s%s", plain ? row->prefix : "", name);
  row->status = cdem_table_add_column(row->table, whole, CDEM_COLUMN_REAL, unit, row->fault);
}

void cdem_run_put_vector(cdem_run_row *row, const char *unit, int count, const double *value,
                         const char *format, ...) {
  static const char axis[] = "xyz";
  char name[160];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(name, sizeof name, format, arguments);
  va_end(arguments);
  for (int k = 0; k < count; k++)
    cdem_run_put(row, unit, value[k], "%s%c", name, axis[k]);
}

void cdem_run_put_stress(cdem_run_row *row, int dim, const double stress[9]) {
  static const struct {
    const char *name;
    int at;
    bool solid; /* 3-D only */
  } component[] = {{"xx", 0, false}, {"yy", 4, false}, {"zz", 8, true},
                   {"yz", 5, true},  {"xz", 2, true},  {"xy", 1, false}};
  for (size_t i = 0; i < sizeof component / sizeof *component; i++)
    if (dim == 3 || !component[i].solid)
      cdem_run_put(row, "Pa", stress[component[i].at], "stress.%s", component[i].name);
}

void cdem_run_put_energy_error(cdem_run_row *row, double error, double exchange) {
  cdem_run_put(row, "", exchange > 0.0 ? fabs(error) / exchange : 0.0, "energy_error");
}
