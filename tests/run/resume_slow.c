/* Broken and continued runs, folders in use, folders used before. */
#include "run/resume.h"

static const char box[] =
    "end: 2 ms\n"
    "mesh: {shape: quad4, count: [6, 2], size: [1 m, 0.2 m], distortion: 0.1}\n"
    "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}}\n"
    "supports: [{group: x0, displacement: {x: 0, y: 0}}]\n"
    "loads: [{group: x1, traction: {y: {ramp: 1 MPa, over: 0.1 ms}}}]\n"
    "frame_every: 0.4 ms\n"
    "stop_when: tip\n"
    "stop_below: 0.1\n"
    "probes: {tip: {group: x1, quantity: displacement, component: y}}\n";

/* All but the checkpoint, which holds the wall time. */
static const char *const written[] = {"history.csv", "body.pvd", "body/body-000000.vtu",
                                      "body/body-000003.vtu", NULL};

static void a_continued_run_gives_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_case("box.yaml", box);
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  for (int stop_at = 1; stop_at < 6; stop_at += 2) {
    check_fails(run_until("broken", false, stop_at, 2, &fault), CDEM_INTERRUPTED,
                "continue with `cdem run --resume");
    assert_false(is_there("broken/summary.json"));
    check_fails(run_until("broken", true, 2, 1, &fault), CDEM_INTERRUPTED, "interrupted at step");
    check_ok(run_until("broken", true, 1 << 30, 1, &fault));
    assert_true(is_there("broken/summary.json"));
    check_same_files("whole", "broken", written);
    check_same_state("whole", "broken");
  }
}

/* What a kill leaves: rows and frames beyond the last checkpoint. */
static void rows_beyond_the_checkpoint_are_cut_off(void **state) {
  (void)state;
  cdem_fault fault = {0};
  char command[1400];
  write_case("box.yaml", box);
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  check_fails(run_until("killed", false, 2, 1, &fault), CDEM_INTERRUPTED, "interrupted");
  snprintf(command, sizeof command,
           "cd '%s' && cp killed/checkpoint.h5 early.h5 && rm -rf killed && cp -r whole killed && "
           "rm killed/summary.json && cp early.h5 killed/checkpoint.h5",
           scratch);
  assert_int_equal(system(command), 0);
  check_ok(run_until("killed", true, 1 << 30, 1, &fault));
  check_same_files("whole", "killed", written);
  check_same_state("whole", "killed");
}

static void only_a_broken_run_can_be_continued(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_case("box.yaml", box);
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  check_fails(run_until("whole", true, 1 << 30, 1, &fault), CDEM_INPUT, "has ended");
  mkdir(in_scratch("empty"), 0777);
  check_fails(run_until("empty", true, 1 << 30, 1, &fault), CDEM_INPUT, "no run to continue");
}

static void a_changed_case_is_noticed(void **state) {
  (void)state;
  cdem_fault fault = {0};
  char command[700];
  write_case("box.yaml", box);
  check_fails(run_until("changed", false, 2, 1, &fault), CDEM_INTERRUPTED, "interrupted");
  snprintf(command, sizeof command, "sed -i 's/30 GPa/31 GPa/' '%s/changed/case.yaml'", scratch);
  assert_int_equal(system(command), 0);
  check_fails(run_until("changed", true, 1 << 30, 1, &fault), CDEM_INPUT, "was changed since");
}

static void a_folder_in_use_is_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_folder_lock *lock = NULL;
  write_case("box.yaml", box);
  check_ok(cdem_make_folder(in_scratch("taken"), &fault));
  check_ok(cdem_folder_lock_take(in_scratch("taken"), &lock, &fault));
  check_fails(run_until("taken", false, 1 << 30, 1, &fault), CDEM_INPUT, "in use by another run");
  check_fails(run_until("taken", true, 1 << 30, 1, &fault), CDEM_INPUT, "in use by another run");
  cdem_folder_lock_drop(&lock);
  check_ok(run_until("taken", false, 1 << 30, 1, &fault));
}

static void keep_message(void *context, const char *message) {
  snprintf(context, 200, "%s", message);
}

static void a_new_run_replaces_an_earlier_one_and_says_so(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  char said[200] = "";
  const cdem_warnings warnings = {.context = said, .warn = keep_message};
  write_case("box.yaml", box);
  cdem_run_options options = {.path = in_scratch("box.yaml"),
                              .folder = in_scratch("again"),
                              .version = "test",
                              .commit = "test",
                              .warnings = &warnings};
  for (int i = 0; i < 2; i++) {
    assert_string_equal(said, "");
    check_ok(cdem_run(&options, &summary, &fault));
    cdem_run_summary_release(&summary);
  }
  assert_non_null(strstr(said, "holds an earlier run, which is replaced"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_continued_run_gives_the_same_bits),
      cmocka_unit_test(rows_beyond_the_checkpoint_are_cut_off),
      cmocka_unit_test(only_a_broken_run_can_be_continued),
      cmocka_unit_test(a_changed_case_is_noticed),
      cmocka_unit_test(a_folder_in_use_is_refused),
      cmocka_unit_test(a_new_run_replaces_an_earlier_one_and_says_so),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
