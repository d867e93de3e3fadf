/* Room verify: every claim of the program as a named check that a command can run.
 *
 * A check is one number with its reference, its tolerance, the source of the reference and its kind
 * (results/check_kinds.def: a closed form, a published number, a law, ...). Checks
 * are tables: one group = one file with one table, plus one line in verify.def. The function of a
 * check only measures; whether the number is right is decided from the table, so that `cdem verify
 * --list`, the JSON and the tests all show the same references. A check passes when
 * |value - reference| <= tolerance; a bound is a check with reference 0.
 *
 * A check that cannot be carried out (a numerical failure, a missing part of the system) is left
 * out of the list and told to the caller: it is never passed. Running out of memory, or a wish to
 * stop, ends the run.
 */
#ifndef CDEM_VERIFY_VERIFY_H
#define CDEM_VERIFY_VERIFY_H

#include "base/base.h"
#include "results/results.h"

typedef struct {
  const char *name;   /* unique within its group */
  const char *source; /* where the reference comes from */
  double reference, tolerance;
  /* Measures one number; `parameter` chooses among the cases one function serves. */
  cdem_status (*measure)(int parameter, double *value, cdem_fault *fault);
  int parameter;
  bool slow; /* takes longer than a second; left out unless asked for */
  cdem_check_kind kind;
} cdem_verification;

typedef struct {
  const char *name, *summary;
  int checks;
  const cdem_verification *check; /* [checks] */
} cdem_verify_group;

/* Groups in the order of verify.def; NULL past the last. By name: NULL when there is none. */
const cdem_verify_group *cdem_verify_group_at(int index);
const cdem_verify_group *cdem_verify_group_find(const char *name);

/* What no check measures: claims that a test of CTest holds, since it runs another program or takes
 * too long; and claims that only a page shows (test NULL). Order of elsewhere.def; NULL past the
 * last. */
typedef struct {
  const char *test, *claim, *against;
} cdem_verify_elsewhere;
const cdem_verify_elsewhere *cdem_verify_elsewhere_at(int index);

typedef struct {
  bool slow; /* run the slow checks too */
  const cdem_progress *progress;
  void *context;
  /* A check that could not be carried out, and why. May be NULL. */
  void (*skipped)(void *context, const char *group, const char *name, const char *reason);
} cdem_verify_options;

/* Runs one group, known to the table or not. `done` of `total` checks are reported as progress. */
cdem_status cdem_verify_run_group(const cdem_verify_group *group,
                                  const cdem_verify_options *options, int64_t *done, int64_t total,
                                  cdem_check_list *list, cdem_fault *fault);

/* Runs the groups of these names (count 0: all) and appends what was measured to *list. CDEM_USAGE
 * names an unknown group and the nearest known one; nothing has run then. */
cdem_status cdem_verify_run(const char *const *groups, int count,
                            const cdem_verify_options *options, cdem_check_list *list,
                            cdem_fault *fault);

#endif
