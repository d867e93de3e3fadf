/* A heap in a box through the door of a run: weight on the floor, the book of energies; and that
 * neither threads, strides nor interruptions change a bit. */
#include "run/grains_box.h"

/* At rest the walls carry the weight, and nothing sideways; before, the book of energies closes. */
static void walls_carry_the_weight(void **state) {
  (void)state;
  const char *const rest[] = {"analysis=relaxation", "tolerance=1e-4", "history_every=5ms"};
  write_case("box.yaml", BOX);
  cdem_run_summary s = run_ok("box.yaml", "rest", 3, rest);
  double weight = 10.0 * key_value(&s, "mass");
  assert_true(s.grains > 100 && s.contacts > s.grains && s.walls == 3);
  assert_true(weight > 0.0);
  check_near(key_value(&s, "mass"), 2000.0 * s.solid, 1e-12, 0.0);
  /* the largest unbalanced force is 1e-4 of the mean contact force; hundreds of them at most */
  check_near(key_value(&s, "all"), -weight, 1e-3, 0.0);
  assert_true(fabs(key_value(&s, "sides")) < 1e-3 * weight);
  assert_true(fabs(key_value(&s, "floor")) < weight);
  cdem_run_summary_release(&s);
}

static void the_book_closes(void **state) {
  (void)state;
  write_case("box.yaml", BOX);
  cdem_run_summary s = run_ok("box.yaml", "fall", 0, NULL);
  assert_true(key_value(&s, "error") < 1e-3);
  assert_true(key_value(&s, "overlap") > 0.0 && key_value(&s, "overlap") < 0.1);
  assert_true(key_value(&s, "fastest") < -0.1);
  check_near(s.time, 0.1, 1e-9, 0.0);
  assert_true(is_there("fall/grains.pvd") && is_there("fall/contacts.pvd"));
  cdem_run_summary_release(&s);
}

/* ---- same bits ---- */

/* Asks to stop once so many steps have been taken. */
typedef struct {
  int64_t stop_at; /* -1: never */
} stopper;

static bool report(void *context, const char *what, int64_t done, int64_t total) {
  const stopper *s = context;
  (void)total;
  return s->stop_at < 0 || strncmp(what, "running", 7) != 0 || done < s->stop_at;
}

static cdem_status run_until(const char *folder, bool resume, int64_t stop_at, int threads,
                             cdem_fault *fault) {
  stopper stop = {.stop_at = stop_at};
  const cdem_progress progress = {.context = &stop, .report = report};
  return run_box(folder, resume, threads, &progress, fault);
}

static void threads_and_breaks_change_no_bit(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_case("box.yaml", BOX "history_every: 1 ms\n");
  check_ok(run_until("whole", false, -1, 1, &fault));
  check_ok(run_until("team", false, -1, 3, &fault));
  check_fails(run_until("broken", false, 600, 1, &fault), CDEM_INTERRUPTED, "--resume");
  check_fails(run_until("broken", true, 2000, 2, &fault), CDEM_INTERRUPTED, "--resume");
  check_ok(run_until("broken", true, -1, 1, &fault));
  const char *const written[] = {"history.csv", "grains/grains-000007.vtu",
                                 "contacts/contacts-000020.vtu", NULL};
  check_same_files("whole", "team", written);
  check_same_files("whole", "broken", written);
}

/* More things due on the way part the steps otherwise. */
static void strides_change_no_bit(void **state) {
  (void)state;
  const char *const often[] = {"frame_every=0.7ms", "checkpoint_every=0.3ms", "end=20ms"};
  write_case("box.yaml", BOX "history_every: 1 ms\n");
  cdem_run_summary a = run_ok("box.yaml", "seldom", 1, often + 2);
  cdem_run_summary b = run_ok("box.yaml", "often", 3, often);
  check_same_files("seldom", "often", (const char *const[]){"history.csv", NULL});
  assert_int_equal(a.steps, b.steps);
  cdem_run_summary_release(&a);
  cdem_run_summary_release(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(walls_carry_the_weight),
      cmocka_unit_test(the_book_closes),
      cmocka_unit_test(threads_and_breaks_change_no_bit),
      cmocka_unit_test(strides_change_no_bit),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
