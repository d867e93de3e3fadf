/* The energy book among the columns of history.csv.
 *
 * Energy is stored, dissipated or brought in as work, and a book closes when
 *
 *     stored(t) - stored(0) + dissipated(t) = work(t)
 *
 * over the columns of one book. A run has one, a coupled run two: that of the medium ("coarse.")
 * and that of the grains ("fine."), whose work by the interface is the column fine.driven. What the
 * solvers know beyond the columns (the energy of half a step, changes of the step) is of the size
 * of the error. tests/report/runs_slow.c holds the sums of finished runs of every engine against
 * it.
 */
#ifndef CDEM_RUN_BOOK_H
#define CDEM_RUN_BOOK_H

#include "results/results.h"

typedef enum {
  CDEM_BOOK_NONE, /* no term: a count, a force, a part of a term */
  CDEM_BOOK_STORED,
  CDEM_BOOK_DISSIPATED,
  CDEM_BOOK_WORK
} cdem_book_side;

typedef enum { CDEM_BOOK_WHOLE, CDEM_BOOK_COARSE, CDEM_BOOK_FINE, CDEM_BOOKS } cdem_book_of;

/* Which side of its book a column is on, by its name; *of: whose book. */
cdem_book_side cdem_run_book_side(const char *column, cdem_book_of *of);

typedef struct {
  int terms;                       /* columns with a side; 0: the history has no such book */
  double stored, dissipated, work; /* J, last row; of the stored the change since the first row */
  double open;                     /* J, stored + dissipated - work */
  double scale;                    /* J, the largest size of a term in any row */
} cdem_run_book;

cdem_run_book cdem_run_book_sum(const cdem_table *history, cdem_book_of of);

#endif
