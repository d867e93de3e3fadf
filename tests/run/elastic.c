/* Elastic cases from end to end: the same bar solved statically, relaxed and in time. */
#include "run/support.h"

/* Plane strain, free to widen: u = p L (1 - nu^2)/E = 1e6 * 0.9375/30e9 = 3.125e-5 m. */
static const char bar[] = "title: A bar that is pulled\n"
                          "analysis: static\n"
                          "end: 1 ms\n"
                          "mesh: {shape: quad4, count: [8, 2], size: [1 m, 0.2 m]}\n"
                          "materials:\n"
                          "  rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}\n"
                          "supports:\n"
                          "  - {group: x0, displacement: {x: 0}}\n"
                          "  - {group: y0, displacement: {y: 0}}\n"
                          "loads:\n"
                          "  - {group: x1, traction: {x: 1 MPa}}\n"
                          "probes:\n"
                          "  tip: {group: x1, quantity: displacement, component: x}\n"
                          "  root: {group: x0, quantity: force, component: x}\n"
                          "  stress: {group: body, quantity: stress, component: xx}\n"
                          "  edge: {group: x1, quantity: stress, component: xx}\n"
                          "  speed: {group: x1, quantity: velocity, component: magnitude}\n"
                          "results:\n"
                          "  tip: {of: tip, take: last, reference: 3.125e-5, tolerance: 1e-3}\n"
                          "  root: {of: reaction.x0.x, take: last}\n"
                          "  stress: {of: stress, take: last}\n";

static void a_static_run_meets_the_closed_form(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  write_case("bar.yaml", bar);
  check_ok(run_case("bar.yaml", "static", 0, NULL, &summary, &fault));
  check_near(key_value(&summary, "tip"), 3.125e-5, 1e-10, 0.0); /* rounding of the factorisation */
  check_near(key_value(&summary, "root"), -2e5, 1e-10, 0.0);
  check_near(key_value(&summary, "stress"), 1e6, 1e-10, 0.0);
  assert_int_equal(summary.results, 1);
  assert_int_equal(summary.failed, 0);
  assert_int_equal(summary.elements, 16);
  assert_int_equal(summary.distinct, 1);
  cdem_run_summary_release(&summary);
  const char *const files[] = {"static/summary.json", "static/history.csv", "static/case.yaml",
                               "static/checkpoint.h5", "static/body.pvd"};
  for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
    assert_true(is_there(files[i]));
}

static void a_relaxation_ends_at_the_static_solution(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  const char *const override[] = {"analysis=relaxation", "tolerance=1e-8"};
  write_case("bar.yaml", bar);
  check_ok(run_case("bar.yaml", "relaxed", 2, override, &summary, &fault));
  /* The rotation of the elements is second order in a strain of 3e-5. */
  check_near(key_value(&summary, "tip"), 3.125e-5, 1e-4, 0.0);
  cdem_run_summary_release(&summary);
}

static void a_relaxation_that_does_not_balance_fails_and_keeps_its_rows(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  const char *const override[] = {"analysis=relaxation", "most_steps=5"};
  write_case("bar.yaml", bar);
  check_fails(run_case("bar.yaml", "unbalanced", 2, override, &summary, &fault), CDEM_NUMERIC,
              "not balanced after 5 steps");
  assert_true(is_there("unbalanced/history.csv"));
  assert_true(is_there("unbalanced/checkpoint.h5"));
  assert_false(is_there("unbalanced/summary.json"));
}

static void rows_of_a_dynamic_run_fall_on_their_times(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  cdem_table history = {0};
  const char *const override[] = {"analysis=dynamic", "history_every=0.25 ms"};
  write_case("bar.yaml", bar);
  check_ok(run_case("bar.yaml", "dynamic", 2, override, &summary, &fault));
  check_near(summary.time, 1e-3, 1e-12, 0.0);
  check_below(summary.energy_error, 1e-6); /* the book is exact but for the rotations */
  check_ok(cdem_read_history(in_scratch("dynamic/history.csv"), &history, &fault));
  assert_int_equal(history.rows, 5);
  for (int64_t r = 0; r < history.rows; r++)
    check_near(cdem_table_at(&history, r, 0)->real, 0.25e-3 * (double)r, 0.0, 0.51 * summary.step);
  const char *const columns[] = {"time",        "step",         "kinetic",     "elastic",
                                 "load",        "energy_error", "energy_edge", "energy_face",
                                 "energy_body", "unbalanced",   "probe.tip",   "reaction.x0.x"};
  for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++)
    if (cdem_table_find(&history, columns[i]) < 0)
      fail_msg("history.csv has no column %s", columns[i]);
  /* Classes add up to the elastic energy. */
  int first = cdem_table_find(&history, "energy_edge"),
      elastic = cdem_table_find(&history, "elastic");
  double sum = 0.0;
  for (int c = 0; c < 3; c++)
    sum += cdem_table_at(&history, 4, first + c)->real;
  check_near(sum, cdem_table_at(&history, 4, elastic)->real, 1e-9, 0.0);
  cdem_table_release(&history);
  cdem_run_summary_release(&summary);
}

static void a_key_result_that_is_off_is_counted(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  const char *const override[] = {"results.tip.reference=3e-5", "results.tip.tolerance=0.04"};
  write_case("bar.yaml", bar);
  check_ok(run_case("bar.yaml", "off", 2, override, &summary, &fault));
  assert_int_equal(summary.failed, 1);
  check_near(cdem_table_at(&summary.keys, 0, 4)->real, 3.125 / 3.0 - 1.0, 1e-9, 0.0);
  cdem_run_summary_release(&summary);
}

static void a_run_ends_when_a_column_has_fallen(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  /* The free end swings back to rest after one period, 4 L/c = 1.16 ms for c = 3443 m/s. */
  const char *const override[] = {"analysis=dynamic", "end=10 ms", "stop_when=tip",
                                  "stop_below=0.2", "history_every=10 us"};
  write_case("bar.yaml", bar);
  check_ok(run_case("bar.yaml", "stopped", 5, override, &summary, &fault));
  assert_true(summary.time > 0.8e-3 && summary.time < 1.3e-3);
  cdem_run_summary_release(&summary);
}

/* A patch in tension carries the exact tractions as nodal forces: their sum is sigma n A. */
static void kirsch_tractions_balance(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  write_case("kirsch.yaml",
             "analysis: static\nplane: stress\n"
             "mesh: {shape: quad4, count: [2, 2], size: [10 m, 10 m], origin: [50 m, 50 m]}\n"
             "materials: {sheet: {young: 1 GPa, poisson: 0}}\n"
             "supports:\n"
             "  - {group: x0, displacement: {x: 0}}\n"
             "  - {group: y0, displacement: {y: 0}}\n"
             "loads: [{group: x1, kirsch_tension: 2 MPa, kirsch_radius: 1 mm}]\n"
             "results: {root: {of: reaction.x0.x, take: last}}\n");
  check_ok(run_case("kirsch.yaml", "kirsch", 0, NULL, &summary, &fault));
  /* Far from a hole of 1 mm the stress is the tension, to (a/r)^2 ~ 1e-10. */
  check_near(key_value(&summary, "root"), -2e7, 1e-8, 0.0);
  cdem_run_summary_release(&summary);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_static_run_meets_the_closed_form),
      cmocka_unit_test(a_relaxation_ends_at_the_static_solution),
      cmocka_unit_test(a_relaxation_that_does_not_balance_fails_and_keeps_its_rows),
      cmocka_unit_test(rows_of_a_dynamic_run_fall_on_their_times),
      cmocka_unit_test(a_key_result_that_is_off_is_counted),
      cmocka_unit_test(a_run_ends_when_a_column_has_fallen),
      cmocka_unit_test(kirsch_tractions_balance),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
