/* Every file of every door is cut off at one size after the other, as a full disk would.
 *
 * Each failure must be told as CDEM_FILE with the name of the file and what to do, leave nothing
 * half done (an earlier file stands, a run can be continued), and the operation must afterwards
 * come to the same result as if nothing had happened.
 */
#include "robust/walk.h"

#include <signal.h>
#include <sys/resource.h>

/* Bytes; between them lies the size of everything the doors write. */
static const rlim_t limits[] = {0, 1, 100, 1000, 3000, 6000, 12000, 20000, 40000, 80000};

/* A soft limit, so that it can be taken back. */
static void limit_files(rlim_t bytes) {
  struct rlimit bound;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &bound), 0);
  bound.rlim_cur = bytes;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &bound), 0);
}

static bool is_told(const cdem_fault *fault) {
  return fault->status == CDEM_FILE && strstr(fault->message, "cannot write '") != NULL &&
         strstr(fault->message, "; free some space") != NULL;
}

/* False when the door writes no file as large as the limit. */
static bool fail_at(const door *d, rlim_t bytes, uint64_t expected) {
  cdem_fault fault = {0};
  char obstacle[64];
  snprintf(obstacle, sizeof obstacle, "a limit of %lld bytes", (long long)bytes);
  before(d);
  int open = count_entries("/proc/self/fd");
  limit_files(bytes);
  cdem_status status = d->kind->open(d, &fault);
  limit_files(RLIM_INFINITY);
  if (count_entries("/proc/self/fd") != open)
    fail_msg("%s: after %s a file stayed open", d->name, obstacle);
  if (status == CDEM_OK) {
    if (d->kind->result(d) != expected)
      fail_msg("%s: under %s the result is another one", d->name, obstacle);
    return false;
  }
  if (status != CDEM_FILE || !is_told(&fault))
    fail_msg("%s: under %s: status %d, '%s'", d->name, obstacle, status, fault.message);
  check_recovery(d, expected, obstacle);
  return true;
}

static void walk(void **state) {
  const door *d = *state;
  uint64_t expected = open_door(d);
  int failed = 0;
  for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
    bool met = fail_at(d, limits[i], expected);
    if (i == 0 && met != d->kind->writes)
      fail_msg("%s %s a file", d->name, met ? "writes" : "does not write");
    failed += met;
  }
  print_message("%d limits met\n", failed);
}

int main(int argc, char **argv) {
  signal(SIGXFSZ, SIG_IGN);
  return run_doors(walk, argc > 1 ? argv[1] : NULL);
}
