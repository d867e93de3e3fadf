/* Private to run: one row of history.csv on its way: declared and filled by one walk, so that they
 * cannot part. */
#ifndef CDEM_RUN_ROW_H
#define CDEM_RUN_ROW_H

#include "results/results.h"

#include <stdbool.h>

typedef struct {
  cdem_table *table;
  bool declare; /* else fill the last row */
  int column;
  const char *prefix; /* before names without a dot: "coarse."; NULL: none */
  cdem_status status; /* the first failure; nothing is put after it */
  cdem_fault *fault;
} cdem_run_row;

/* The next column; while declaring, `value` is not looked at. NaN: no value. */
__attribute__((format(printf, 4, 5))) void cdem_run_put(cdem_run_row *row, const char *unit,
                                                        double value, const char *format, ...);
/* The first `count` components of a vector; the name of each ends with its axis: "wall.top.f" makes
 * wall.top.fx and so on. */
__attribute__((format(printf, 5, 6))) void cdem_run_put_vector(cdem_run_row *row, const char *unit,
                                                               int count, const double *value,
                                                               const char *format, ...);
/* stress.xx and so on, Pa; in 2-D those of the plane. stress: row by row. */
void cdem_run_put_stress(cdem_run_row *row, int dim, const double stress[9]);
/* What a book of energy misses, by its largest term, both J: 0 while nothing has happened. */
void cdem_run_put_energy_error(cdem_run_row *row, double error, double exchange);

#endif
