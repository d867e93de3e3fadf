/* Private to verify: whole runs of shipped coupled cases, and what their histories say.
 *
 * Several checks look at one run, and some runs take half a minute: what a run gave is kept for the
 * life of the process. CMake makes texts of the library out of the cases in data/cases.
 */
#ifndef CDEM_VERIFY_BSM_RUNS_H
#define CDEM_VERIFY_BSM_RUNS_H

#include "results/results.h"

typedef enum {
  CDEM_BSM_FOUNDATION,
  CDEM_BSM_SOLID,
  CDEM_BSM_CEMENTED,
  CDEM_BSM_CASES
} cdem_bsm_case;

enum { CDEM_BSM_OVERRIDES = 10 }; /* at most */

/* The history of the case with these overrides, ended by NULL; nobody's to release. */
cdem_status cdem_bsm_run(cdem_bsm_case wanted, const char *const *override,
                         const cdem_table **history, cdem_fault *fault);

/* A column in a row; NaN where it is not. */
double cdem_bsm_at(const cdem_table *history, int64_t row, const char *column);
/* Its mean over the last 2 ms, its largest value from `from` s on (*row: where; NULL: not wanted).
 */
double cdem_bsm_last(const cdem_table *history, const char *column);
double cdem_bsm_largest(const cdem_table *history, const char *column, double from, int64_t *row);
/* Mean of |a - b| over all rows by the mean of b; NaN where the rows do not fit. */
double cdem_bsm_apart(const cdem_table *a, const cdem_table *b, const char *column);

#endif
