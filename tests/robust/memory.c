/* Every allocation of every door is made to fail, one after the other.
 *
 * Each failure must be told as CDEM_MEMORY, leave nothing half done, open or (under the leak
 * sanitizer) behind, and the operation must afterwards come to the same result as if nothing had
 * happened. Where a door has more allocations than the quick test can walk, it takes the first ones
 * and then even strides; with the argument `all` it takes every one.
 */
#include "base/memory.h"

#include "robust/walk.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

enum { FIRST = 24, MOST = 48 };

static bool all_of_them;

static int64_t count_allocations(const door *d) {
  cdem_fault fault = {0};
  before(d);
  cdem_memory_fail_after(INT64_MAX);
  cdem_status status = d->kind->open(d, &fault);
  int64_t count = INT64_MAX - cdem_memory_fail_after(-1);
  check_ok(status);
  d->kind->result(d);
  return count;
}

/* The next one to fail after k, of `count`. */
static int64_t next_of(int64_t k, int64_t count) {
  int64_t stride = (count - FIRST + MOST - FIRST - 1) / (MOST - FIRST);
  return all_of_them || k + 1 < FIRST || stride < 1 ? k + 1 : k + stride;
}

static void fail_at(const door *d, int64_t k, uint64_t expected) {
  cdem_fault fault = {0};
  char obstacle[64];
  snprintf(obstacle, sizeof obstacle, "the failure of allocation %lld", (long long)k);
  before(d);
  int open = count_entries("/proc/self/fd");
  cdem_memory_fail_after(k);
  cdem_status status = d->kind->open(d, &fault);
  int64_t left = cdem_memory_fail_after(-1);
  if (left >= 0)
    fail_msg("%s: allocation %lld was never asked for", d->name, (long long)k);
  if (status != CDEM_MEMORY || fault.status != CDEM_MEMORY ||
      strstr(fault.message, "out of memory") == NULL)
    fail_msg("%s: after %s: status %d, '%s'", d->name, obstacle, status, fault.message);
  if (count_entries("/proc/self/fd") != open)
    fail_msg("%s: after %s a file stayed open", d->name, obstacle);
  check_recovery(d, expected, obstacle);
}

static void walk(void **state) {
  const door *d = *state;
  uint64_t expected = open_door(d);
  if (open_door(d) != expected)
    fail_msg("%s: two results without any failure differ", d->name);
  int64_t count = count_allocations(d), walked = 0;
  for (int64_t k = 0; k < count; k = next_of(k, count), walked++)
    fail_at(d, k, expected);
  print_message("%lld of %lld allocations failed\n", (long long)walked, (long long)count);
  assert_true((count == 0) == (d->kind == &quantity)); /* which alone asks for none */
#ifdef __SANITIZE_ADDRESS__
  if (__lsan_do_recoverable_leak_check() != 0)
    fail_msg("%s: memory stayed behind", d->name);
#endif
}

int main(int argc, char **argv) {
  all_of_them = argc > 1 && strcmp(argv[1], "all") == 0;
  return run_doors(walk, argc > 2 ? argv[2] : NULL);
}
