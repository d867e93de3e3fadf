/* Private to run: one number out of the rows of a history.
 *
 * What is looked at is factor times the sum of some columns, over the rows with from <= time <= to;
 * rows in which one of the columns has no value do not count. */
#ifndef CDEM_RUN_TAKE_H
#define CDEM_RUN_TAKE_H

#include "results/results.h"

typedef struct {
  int take;        /* CDEM_TAKE_MAX .. of case.h */
  double from, to; /* s; NaN: open */
  double factor;
  int columns;
  const int *column; /* [columns] */
  int along;         /* column whose value is wanted of a place (first row of several equal ones) */
} cdem_run_taking;

/* NaN when no row counts; of a slope and a scatter below two rows. The scatter is the standard
 * deviation of the rows with n - 1 below the root, which holds for few rows too. */
double cdem_run_take(const cdem_table *history, const cdem_run_taking *taking);

#endif
