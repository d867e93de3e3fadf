/* A small triaxial test: 78 spheres of 50 mm in a cylinder of 200 x 300 mm. Lengths, stiffness and
 * times for a scale h; what has no dimension stays. */
#ifndef CDEM_TESTS_RUN_TRIAXIAL_BOX_H
#define CDEM_TESTS_RUN_TRIAXIAL_BOX_H

#include "run/support.h"

static inline void write_triaxial(const char *name, double h, const char *triaxial) {
  char text[2048];
  snprintf(text, sizeof text,
           "safety: 0.5\n"
           "grains:\n"
           "  dimension: 3\n"
           "  law: penalty\n"
           "  packing: {kind: loose, cylinder: yes, low: [%.17g, %.17g, 0], high: [%.17g, %.17g, "
           "%.17g], radius: %.17g, count: 78, seed: 3, compact: {height: %.17g}}\n"
           "  materials: {rock: {density: 2650}, smooth: {}}\n"
           "  most_overlap: 0.4\n"
           "contacts:\n"
           "  - {between: [rock, smooth], penalty_stiffness: %.17g, friction: 0, damping_ratio: "
           "0.2}\n"
           "  - {penalty_stiffness: %.17g, friction: 0.3, damping_ratio: 0.2}\n"
           "triaxial: %s\n",
           -0.1 * h, -0.1 * h, 0.1 * h, 0.1 * h, 0.3 * h, 0.025 * h, 0.3 * h, 1e10 / h, 1e10 / h,
           triaxial);
  write_case(name, text);
}

static inline cdem_table read_rows(const char *folder) {
  cdem_fault fault = {0};
  cdem_table table = {0};
  char path[600];
  snprintf(path, sizeof path, "%s/history.csv", in_scratch(folder));
  check_ok(cdem_read_history(path, &table, &fault));
  return table;
}

/* Of a row; NaN where there is none. */
static inline double row_value(const cdem_table *table, int64_t row, const char *name) {
  int column = cdem_table_find(table, name);
  assert_true(column >= 0);
  const cdem_value *value = cdem_table_at(table, row, column);
  return value->absent ? NAN : value->real;
}

#endif
