/* What tests of broken and continued runs share: stopping on the way, comparing what is left. */
#ifndef CDEM_TESTS_RUN_RESUME_H
#define CDEM_TESTS_RUN_RESUME_H

#include "run/support.h"

/* Wants to stop at the given call. */
typedef struct {
  int calls, stop_at;
} stopper;

static inline bool report_until(void *context, const char *what, int64_t done, int64_t total) {
  stopper *s = context;
  (void)done;
  (void)total;
  if (strncmp(what, "running", 7) == 0)
    s->calls++;
  return s->calls < s->stop_at;
}

static inline cdem_status run_until(const char *folder, bool resume, int stop_at, int threads,
                                    cdem_fault *fault) {
  stopper stop = {.stop_at = stop_at};
  const cdem_progress progress = {.context = &stop, .report = report_until};
  return run_box(folder, resume, threads, &progress, fault);
}

/* The last checkpoints of two runs, but for the wall time. */
static inline void check_same_state(const char *a, const char *b) {
  cdem_fault fault = {0};
  cdem_state state[2] = {{0}};
  const char *const folder[2] = {a, b};
  for (int i = 0; i < 2; i++) {
    char path[600];
    snprintf(path, sizeof path, "%s/checkpoint.h5", in_scratch(folder[i]));
    check_ok(cdem_read_state(path, &state[i], &fault));
  }
  assert_int_equal(state[0].arrays, state[1].arrays);
  for (int64_t i = 0; i < state[0].arrays; i++) {
    const cdem_array *one = &state[0].array[i], *other = cdem_state_find(&state[1], one->name);
    assert_non_null(other);
    assert_int_equal(one->count, other->count);
    size_t bytes = (size_t)one->count * cdem_array_size(one->type);
    if (strcmp(one->name, "run/reals") != 0 && bytes > 0 &&
        memcmp(one->data, other->data, bytes) != 0)
      fail_msg("'%s' differs", one->name);
  }
  cdem_state_release(&state[0]);
  cdem_state_release(&state[1]);
}

/* A case gives the same files and states with one thread and two, unbroken and broken twice with
 * changing threads. */
static inline void check_threads_and_breaks(const char *text, const char *const *written) {
  cdem_fault fault = {0};
  write_case("box.yaml", text);
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  check_ok(run_until("team", false, 1 << 30, 2, &fault));
  check_fails(run_until("broken", false, 2, 2, &fault), CDEM_INTERRUPTED, "--resume");
  check_fails(run_until("broken", true, 2, 1, &fault), CDEM_INTERRUPTED, "interrupted at step");
  check_ok(run_until("broken", true, 1 << 30, 1, &fault));
  check_same_files("whole", "team", written);
  check_same_files("whole", "broken", written);
  check_same_state("whole", "team");
  check_same_state("whole", "broken");
}

#endif
