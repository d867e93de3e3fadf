/* Runs and scaled cases through libcdem: a bar strikes another, small enough for a unit test. */
#include "support.h"

static const char *const impact = CDEM_DATA "/cases/impact.yaml";

/* A coarse impact without pictures. */
static libcdem_run *small(const char *path) {
  libcdem_fault fault = {0};
  libcdem_run *run = NULL;
  check_ok(libcdem_run_create(path, &run, &fault));
  if (strcmp(path, impact) == 0)
    check_ok(libcdem_run_set(run, "mesh.parameters.n=6", &fault));
  check_ok(libcdem_run_choose(run, LIBCDEM_RUN_FRAMES, 0, &fault));
  check_ok(libcdem_run_choose(run, LIBCDEM_RUN_FIGURES, 0, &fault));
  check_ok(libcdem_run_choose(run, LIBCDEM_RUN_THREADS, 1, &fault));
  return run;
}

static void a_run_has_key_results(void **state) {
  (void)state;
  libcdem_fault fault = {0};
  libcdem_run *run = small(impact);
  struct stat file;
  assert_int_equal(libcdem_run_results(run), 0);
  assert_null(libcdem_run_find(run, "struck"));
  check_ok(libcdem_run_start(run, in_scratch("whole"), NULL, &fault));
  assert_int_equal(libcdem_run_results(run), 2);
  const libcdem_result *struck = libcdem_run_find(run, "struck");
  assert_ptr_equal(struck, libcdem_run_result(run, 0));
  assert_null(libcdem_run_result(run, 2));
  assert_string_equal(struck->unit, "m/s");
  assert_true(struck->reference == 0.5);
  assert_true(fabs(struck->value - 0.5) < 0.05); /* momentum over, the mesh is coarse */
  assert_true(fabs(struck->difference - (struck->value / 0.5 - 1.0)) < 1e-12);
  assert_int_equal(libcdem_run_failed(run), fabs(struck->difference) > 0.01);
  assert_true(isnan(libcdem_run_find(run, "striker")->reference));
  assert_int_equal(stat(in_scratch("whole/summary.json"), &file), 0);
  check_fails(libcdem_run_resume(run, in_scratch("whole"), NULL, &fault), LIBCDEM_INPUT,
              "has ended");
  assert_int_equal(libcdem_run_results(run), 0);
  libcdem_run_destroy(&run);
  assert_null(run);
}

/* Stops at the fourth report of the steps. */
static bool stop_soon(void *context, const char *what, int64_t done, int64_t total) {
  (void)total;
  return strstr(what, "mesh") != NULL || done == 0 || ++*(int *)context < 4;
}

static double result_of(libcdem_run *run, const char *name) {
  const libcdem_result *result = libcdem_run_find(run, name);
  assert_non_null(result);
  return result->value;
}

static void a_stopped_run_goes_on_to_the_same_bits(void **state) {
  (void)state;
  int reports = 0;
  const libcdem_listener listener = {&reports, stop_soon, NULL};
  libcdem_fault fault = {0};
  libcdem_run *run = small(impact);
  check_ok(libcdem_run_start(run, in_scratch("unbroken"), NULL, &fault));
  double struck = result_of(run, "struck"), striker = result_of(run, "striker");
  check_fails(libcdem_run_start(run, in_scratch("broken"), &listener, &fault), LIBCDEM_INTERRUPTED,
              "");
  assert_int_equal(libcdem_run_results(run), 0);
  check_ok(libcdem_run_resume(run, in_scratch("broken"), NULL, &fault));
  assert_true(result_of(run, "struck") == struck && result_of(run, "striker") == striker);
  libcdem_run_destroy(&run);
}

/* Twice as large in space and time: the same velocities, bit by bit. */
static void a_scaled_case_repeats_its_original(void **state) {
  (void)state;
  static const double twice[3] = {2.0, 2.0, 8.0};
  libcdem_fault fault = {0};
  char coarse[512], scaled[512];
  FILE *file = fopen(in_scratch("impact.yaml"), "w");
  assert_non_null(file);
  fprintf(file,
          "end: 1 ms\nmesh: {file: %s/cases/impact.geo, parameters: {n: 6}}\n"
          "materials: {rock: {young: 30 GPa, poisson: 0, density: 2700 kg/m3}}\n"
          "contact: {friction: 0}\ninitial: [{groups: striker, velocity: [1 m/s, 0]}]\n"
          "probes: {v: {group: struck, quantity: velocity, component: x}}\n"
          "results: {v: {of: v, take: last}}\n",
          CDEM_DATA);
  assert_int_equal(fclose(file), 0);
  snprintf(coarse, sizeof coarse, "%s", in_scratch("impact.yaml"));
  snprintf(scaled, sizeof scaled, "%s", in_scratch("twice.yaml"));
  check_ok(libcdem_case_scale(coarse, twice, scaled, NULL, &fault));
  libcdem_run *one = small(coarse), *two = small(scaled);
  check_ok(libcdem_run_start(one, in_scratch("one"), NULL, &fault));
  check_ok(libcdem_run_start(two, in_scratch("two"), NULL, &fault));
  assert_true(result_of(one, "v") == result_of(two, "v"));
  libcdem_run_destroy(&one);
  libcdem_run_destroy(&two);
}

static void a_coarsened_case_can_be_run(void **state) {
  (void)state;
  libcdem_fault fault = {0};
  libcdem_run *run;
  check_ok(libcdem_case_coarsen(CDEM_DATA "/cases/settling.yaml", 2.0, in_scratch("coarse.yaml"),
                                NULL, &fault));
  run = small(in_scratch("coarse.yaml"));
  check_ok(libcdem_run_check(run, NULL, &fault));
  assert_int_equal(libcdem_run_results(run), 0);
  libcdem_run_destroy(&run);
}

static void misuse_is_refused(void **state) {
  (void)state;
  static const double nothing[3] = {0.0, 1.0, 1.0};
  libcdem_fault fault = {0};
  libcdem_run *run = NULL;
  struct stat folder;
  check_fails(libcdem_run_create(impact, NULL, &fault), LIBCDEM_USAGE, "not NULL");
  check_ok(libcdem_run_create(NULL, &run, &fault));
  check_fails(libcdem_run_start(run, in_scratch("none"), NULL, &fault), LIBCDEM_USAGE, "a case");
  libcdem_run_destroy(&run);
  check_ok(libcdem_run_create(impact, &run, &fault));
  check_fails(libcdem_run_set(run, "end", &fault), LIBCDEM_USAGE, "KEY=VALUE");
  check_fails(libcdem_run_choose(run, (libcdem_run_choice)9, 0, &fault), LIBCDEM_USAGE,
              "no choice 9");
  check_fails(libcdem_run_choose(run, LIBCDEM_RUN_FRAMES, 2, &fault), LIBCDEM_USAGE, "0 to 1");
  check_fails(libcdem_run_start(run, NULL, NULL, &fault), LIBCDEM_USAGE, "folder");
  check_ok(libcdem_run_set(run, "ennd=2 ms", &fault));
  check_fails(libcdem_run_start(run, in_scratch("bad"), NULL, &fault), LIBCDEM_INPUT, "'end'");
  assert_int_not_equal(stat(in_scratch("bad"), &folder), 0); /* a bad case leaves no folder */
  libcdem_run_destroy(&run);
  check_fails(libcdem_case_scale(impact, nothing, in_scratch("x.yaml"), NULL, &fault),
              LIBCDEM_USAGE, "ratio 0");
  check_fails(libcdem_case_coarsen(impact, NAN, in_scratch("x.yaml"), NULL, &fault), LIBCDEM_USAGE,
              "ratio");
  check_fails(libcdem_case_coarsen("/no/such.yaml", 2.0, in_scratch("x.yaml"), NULL, &fault),
              LIBCDEM_FILE, "/no/such.yaml");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_run_has_key_results),
      cmocka_unit_test(a_stopped_run_goes_on_to_the_same_bits),
      cmocka_unit_test(a_scaled_case_repeats_its_original),
      cmocka_unit_test(a_coarsened_case_can_be_run),
      cmocka_unit_test(misuse_is_refused),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
