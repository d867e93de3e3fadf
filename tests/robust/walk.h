/* What the tests that walk through all doors share: the table, a door opened once, and one test a
 * door; an argument of the program names the one door that is wanted. */
#ifndef CDEM_TESTS_ROBUST_WALK_H
#define CDEM_TESTS_ROBUST_WALK_H

#include "robust/doors_runs.h"
#include "support/sanitizers.h"

static const door doors[] = {
#define D(its_name, its_kind, its_text, ...)                                                       \
  {.name = its_name, .kind = &its_kind, .text = its_text, .set = {__VA_ARGS__}},
#include "robust/doors.def"
#undef D
};
enum { DOORS = sizeof doors / sizeof *doors };

static void before(const door *d) {
  if (d->kind->before != NULL)
    d->kind->before(d);
}

/* Opens a door with nothing in the way. */
static uint64_t open_door(const door *d) {
  cdem_fault fault = {0};
  before(d);
  check_ok(d->kind->open(d, &fault));
  return d->kind->result(d);
}

/* After a failure: nothing is half done, and what was to be done can still be done. */
static inline void check_recovery(const door *d, uint64_t expected, const char *obstacle) {
  if (d->kind->failed != NULL)
    d->kind->failed(d);
  uint64_t sum = d->kind->again != NULL ? d->kind->again(d) : open_door(d);
  if (sum != expected)
    fail_msg("%s: after %s the result is another one", d->name, obstacle);
}

static int run_doors(CMUnitTestFunction walk, const char *wanted) {
  struct CMUnitTest tests[DOORS];
  size_t count = 0;
  for (int i = 0; i < DOORS; i++)
    if (wanted == NULL || strcmp(wanted, doors[i].name) == 0)
      tests[count++] =
          (struct CMUnitTest){doors[i].name, walk, NULL, NULL, (void *)(uintptr_t)&doors[i]};
  return _cmocka_run_group_tests("doors", tests, count, scratch_make, scratch_remove);
}

#endif
