/* Everything a solver refuses, and what it says when a motion goes wrong. */
#include "cdem/solver_store.h"
#include "solver_support.h"

static void bad_options_are_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_square(2, 2);
  rig_make(&o, &r);
  const cdem_solver_options good = r.options;
  r.options.safety = 1.5;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT,
              "the safety of the step is 1.5; it must be above 0 and at most 1");
  r.options = good;
  r.options.local_damping = 1.0;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT, "local damping is 1");
  r.options = good;
  r.options.mass_damping = -1.0;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT,
              "mass damping is -1 1/s");
  r.options = good;
  r.options.step = -1.0;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT, "the step is -1 s");
  r.options = good;
  r.options.thickness = 0.0;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT,
              "the thickness is 0 m; it must be positive");
  r.options = good;
  r.options.blocks = NULL;
  r.options.plates = 1;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_USAGE, "need blocks");
  assert_null(r.solver.store);
  rig_release(&r);
}

/* The message holds the limit; that limit itself is accepted and stable, a little more is not. */
static void unstable_step_names_the_limit(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_square(4, 4);
  rig_make(&o, &r);
  rig_start(&r);
  char limiter[64], text[160];
  double limit = cdem_solver_limit(&r.solver, limiter);
  check_near(r.solver.step, 0.8 * limit, 1e-15, 0.0);
  assert_memory_equal(limiter, "element ", 8);
  cdem_solver_release(&r.solver);
  r.options.step = 1.0001 * limit;
  snprintf(text, sizeof text, "the longest is %.6g s, set by %s", limit, limiter);
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT, text);
  r.options.step = limit;
  rig_start(&r);
  assert_true(r.solver.step == limit);
  rig_release(&r);
}

static void contradicting_supports_are_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_square(2, 2);
  rig_make(&o, &r);
  cdem_support support[2] = {hold(&r, "x0", 0, false, constant(0.0)),
                             hold(&r, "y0", 0, false, constant(1e-3))};
  r.options.supports = 2;
  r.options.support = support;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT,
              "supports 'x0' and 'y0' prescribe component 1 of node 1 differently");
  support[1].series.value[0] = 0.0; /* the same twice is no contradiction */
  rig_start(&r);
  cdem_solver_release(&r.solver);
  support[1].velocity = true;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT, "differently");
  support[1].component = 2;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT,
              "support 'y0' prescribes component 3; nodes of this body have 2");
  drop(&support[0]);
  drop(&support[1]);
  rig_release(&r);
}

static cdem_status run_until_failure(rig *r, cdem_fault *fault) {
  for (int k = 0; k < 2000; k++) {
    cdem_status status = cdem_solver_step(&r->solver, fault);
    if (status != CDEM_OK)
      return status;
  }
  return CDEM_OK;
}

/* A load far too large turns elements inside out; a linear body goes on to infinity. */
static void diverging_motion_stops(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int linear = 0; linear < 2; linear++) {
    rig r;
    rig_options o = rig_square(3, 3);
    o.linear = linear;
    rig_make(&o, &r);
    int32_t node = 0;
    const double vector[2] = {1e12, 1e12};
    cdem_load load = {"hammer", constant(1.0), 1, &node, vector};
    r.options.loads = 1;
    r.options.load = &load;
    rig_start(&r);
    if (linear) { /* what an unstable step does */
      r.solver.store->base_time = r.solver.time;
      r.solver.store->base_steps = r.solver.steps;
      r.solver.step *= 2.0;
    }
    check_fails(run_until_failure(&r, &fault), CDEM_NUMERIC,
                linear ? "the motion is no longer finite at t = " : "turned inside out at t = ");
    assert_true(r.solver.steps > 0 && r.solver.time > 0.0);
    cdem_series_release(&load.series);
    rig_release(&r);
  }
}

static void likely_cause_is_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_square(3, 3);
  rig_make(&o, &r);
  int32_t node = 0;
  const double vector[2] = {1e12, 1e12};
  cdem_load load = {"hammer", constant(1.0), 1, &node, vector};
  r.options.loads = 1;
  r.options.load = &load;
  rig_start(&r);
  check_fails(run_until_failure(&r, &fault), CDEM_NUMERIC, "without supports");
  cdem_solver_release(&r.solver);
  r.options.step = 1e-6;
  rig_start(&r);
  check_fails(run_until_failure(&r, &fault), CDEM_NUMERIC, "the step may be too long");
  cdem_series_release(&load.series);
  rig_release(&r);
}

/* Every allocation of a start fails once: the solver is empty after each. */
static void memory_runs_out_cleanly(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_square(2, 2);
  rig_make(&o, &r);
  cdem_plate plate = {.name = "lid", .point = {0, 2, 0}, .normal = {0, -1, 0}, .kn = 1e9};
  r.options.plates = 1;
  r.options.plate = &plate;
  r.options.fictitious_mass = true;
  int count = 0;
  for (;; count++) {
    memset(&fault, 0, sizeof fault);
    cdem_memory_fail_after(count);
    cdem_status status = cdem_solver_init(&r.options, &r.solver, &fault);
    cdem_memory_fail_after(-1);
    if (status == CDEM_OK)
      break;
    assert_int_equal(status, CDEM_MEMORY);
    assert_null(r.solver.store);
    assert_null(r.solver.u);
  }
  assert_true(count > 15);
  rig_release(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bad_options_are_named),
      cmocka_unit_test(unstable_step_names_the_limit),
      cmocka_unit_test(contradicting_supports_are_named),
      cmocka_unit_test(diverging_motion_stops),
      cmocka_unit_test(likely_cause_is_named),
      cmocka_unit_test(memory_runs_out_cleanly),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
