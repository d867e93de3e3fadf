/* The solver as a whole: conservation, the energy book, the step, bad input. */
#include "solver_model.h"

/* Law without dashpots and sliding: exactly conservative. */
static void elastic(model *m, int dim, const char *law) {
  model_init(m, dim, law);
  if (strcmp(law, "li-chu") != 0)
    model_word(m, CDEM_LAW_damping_ratio, 0.0);
  model_word(m, CDEM_LAW_friction, 0.0);
}

static void run(model *m, cdem_dem *dem, int64_t steps) {
  cdem_fault fault = {0};
  check_ok(cdem_dem_init(&m->options, dem, &fault));
  check_ok(cdem_dem_steps(dem, steps, &fault));
}

/* Law 1: linear and angular momentum of a heap that flies apart, friction and dashpots included. */
static void test_momentum(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    model m;
    cdem_dem dem;
    cdem_fault fault = {0};
    double before[2][3], after[2][3], scale = 0.0;
    model_init(&m, dim, "linear");
    model_word(&m, CDEM_LAW_restitution, 0.6);
    model_word(&m, CDEM_LAW_friction, 0.5);
    model_heap(&m, dim == 2 ? 8 : 4, 3.0, 0.1, 11);
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    cdem_dem_momentum(&dem, before[0], before[1]);
    check_ok(cdem_dem_steps(&dem, 400, &fault));
    cdem_dem_momentum(&dem, after[0], after[1]);
    cdem_dem_energies e;
    cdem_dem_energies_now(&dem, &e);
    scale = sqrt(e.exchange); /* of m v with the mass of all about 1 kg or less */
    for (int c = 0; c < 3; c++) {
      check_near(after[0][c], before[0][c], 0.0, 1e-12 * scale);
      check_near(after[1][c], before[1][c], 0.0, 1e-12 * scale);
    }
    cdem_dem_release(&dem);
    model_release(&m);
  }
}

/* Conservative laws: the error of the book falls with the square of the step; while a linear
 * contact lasts there is none. (Where contacts open and close within a step it is of second order
 * again.) */
static void test_energy_order(void **state) {
  (void)state;
  static const char *const laws[] = {"linear", "hertz"};
  for (int k = 0; k < 2; k++) {
    double error[2];
    for (int half = 0; half < 2; half++) {
      model m;
      cdem_dem dem;
      cdem_fault fault = {0};
      cdem_dem_energies e;
      elastic(&m, 3, laws[k]);
      model_add(&m, 0.0, 0.0, 0.0, 0.01);
      model_add(&m, 0.0199, 0.0, 0.0, 0.01); /* pressed: the contact is there from the start */
      check_ok(cdem_dem_init(&m.options, &dem, &fault));
      double step = dem.step * (half ? 0.5 : 1.0), worst = 0.0;
      check_ok(cdem_dem_set_step(&dem, step, &fault));
      for (int n = 0; n < (half ? 6 : 3); n++) {
        check_ok(cdem_dem_steps(&dem, 1, &fault));
        worst = fmax(worst, energy_error(&dem, &e));
      }
      error[half] = worst;
      cdem_dem_release(&dem);
      model_release(&m);
    }
    if (k == 0)
      check_below(error[0], 1e-12); /* linear forces: the trapezoid is exact */
    else
      assert_true(error[1] < 0.3 * error[0]);
  }
}

/* A box of grains with friction and dashpots; under gravity with local and mass damping. */
static void test_energy_book(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++)
    for (int damped = 0; damped < 2; damped++) {
      model m;
      cdem_dem dem;
      cdem_dem_energies e;
      model_init(&m, dim, "linear");
      model_word(&m, CDEM_LAW_restitution, 0.5);
      model_word(&m, CDEM_LAW_friction, 0.4);
      model_heap(&m, dim == 2 ? 7 : 4, 2.0, 0.05, 3);
      model_box(&m, dim == 2 ? 7 : 4);
      m.options.gravity[1] = -9.81;
      m.options.safety = 0.1;
      m.options.local_damping = damped ? 0.3 : 0.0;
      m.options.mass_damping = damped ? 5.0 : 0.0;
      run(&m, &dem, 600);
      check_below(energy_error(&dem, &e), 1e-3);
      assert_true(e.friction > 0.0 && e.damping > 0.0);
      cdem_dem_release(&dem);
      model_release(&m);
    }
}

/* Two grains alone: 2/sqrt(k/m*) exactly, in any direction. */
static void test_limit(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  char limiter[64];
  elastic(&m, 3, "linear");
  model_word(&m, CDEM_LAW_shear_stiffness, 0.0);
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.007, 0.011, 0.002, 0.006);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  double mass[2];
  cdem_dem_look(&dem, &(cdem_dem_view){.mass = mass});
  double limit;
  check_ok(cdem_dem_limit(&dem, &limit, limiter, &fault));
  check_near(limit, 2.0 / sqrt(1e5 * (1.0 / mass[0] + 1.0 / mass[1])), 1e-12, 0.0);
  assert_non_null(strstr(limiter, "with 1 contact"));
  check_near(dem.step, 0.1 * limit, 1e-14, 0.0);
  check_fails(cdem_dem_set_step(&dem, 1.01 * limit, &fault), CDEM_INPUT, "the limit is");
  cdem_dem_release(&dem);
  m.options.step = 1.01 * limit;
  check_fails(cdem_dem_init(&m.options, &dem, &fault), CDEM_INPUT, "with 1 contact");
  /* just below it is stable, just above it (asked for in secret) it is not: shown by the motion */
  m.options.step = 0.99 * limit;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, 50, &fault));
  cdem_dem_release(&dem);
  model_release(&m);
}

static void bad(model *m, const char *text) {
  cdem_dem dem;
  cdem_fault fault = {0};
  check_fails(cdem_dem_init(&m->options, &dem, &fault), CDEM_INPUT, text);
  assert_null(dem.store);
  cdem_dem_release(&dem);
}

static void test_bad_input(void **state) {
  (void)state;
  model m;
  elastic(&m, 3, "linear");
  bad(&m, "there are no grains");
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.021, 0.0, 0.0, 0.01);
  m.grains.radius[1] = 0.0;
  bad(&m, "radius");
  m.grains.radius[1] = 0.03;
  m.options.most_overlap = 0.1;
  bad(&m, "grains 0 and 1");
  m.grains.radius[1] = 0.01;
  m.grains.material[1] = 1;
  bad(&m, "grain 1 has material 1");
  m.grains.material[1] = 0;
  m.material[0].density = -1.0;
  bad(&m, "density");
  m.material[0].density = 2500.0;
  m.options.local_damping = 1.0;
  bad(&m, "local damping is 1");
  m.options.local_damping = 0.0;
  m.options.safety = 2.0;
  bad(&m, "safety");
  m.options.safety = 0.0;
  model_word(&m, CDEM_LAW_normal_stiffness, NAN);
  bad(&m, "contact of 'm0' and 'm0'");
  model_word(&m, CDEM_LAW_normal_stiffness, 1e5);
  model_plane(&m, 0.01, 0.0, 0.0, 1.0, 0.0, 0.0);
  bad(&m, "plane");
  m.options.walls = 0;
  cdem_bond_law law = {.normal_stiffness = 1e5};
  cdem_bond bond[2] = {{{0, 7}, 0}, {{1, 0}, 0}};
  m.options.bond_law = &law;
  m.options.bond_laws = 1;
  m.options.bond = bond;
  m.options.bonds = 1;
  bad(&m, "joins grains 0 and 7");
  bond[0].grain[1] = 1;
  m.options.bonds = 2;
  bad(&m, "have two bonds");
  model_release(&m);
}

/* Faster than its radius in a step. */
static void test_moves_too_far(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  elastic(&m, 3, "linear");
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 1.0, 0.0, 0.0, 0.01);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_want_applied(&dem, &fault));
  dem.applied[6] = 1e9;
  check_fails(cdem_dem_steps(&dem, 10, &fault), CDEM_NUMERIC, "grain 1 moves by more than");
  check_fails(cdem_dem_step(&dem, &fault), CDEM_NUMERIC, "has failed before");
  cdem_dem_release(&dem);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_want_applied(&dem, &fault));
  dem.applied[0] = NAN;
  check_fails(cdem_dem_steps(&dem, 10, &fault), CDEM_NUMERIC, "no longer finite");
  cdem_dem_release(&dem);
  model_release(&m);
}

/* Free fall with mass damping c: v = -g/c (1 - exp(-c t)), of second order in the step. */
static void test_mass_damping(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  double velocity[3];
  elastic(&m, 3, "linear");
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  m.options.gravity[2] = -9.81;
  m.options.mass_damping = 20.0;
  run(&m, &dem, 1000);
  cdem_dem_look(&dem, &(cdem_dem_view){.velocity = velocity});
  double exact = -9.81 / 20.0 * -expm1(-20.0 * dem.time), h = 20.0 * dem.step;
  check_near(velocity[2], exact, h * h, 0.0);
  cdem_dem_energies e;
  check_below(energy_error(&dem, &e), 1e-12);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* A driven grain presses a free one: its work is what the free one and the contact hold. */
static void test_driven(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_dem_energies e;
  elastic(&m, 2, "linear");
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.02, 0.0, 0.0, 0.01);
  model_add(&m, -0.015, 0.0, 0.0, 0.01); /* driven too: no contact with the other driven one */
  m.grains.motion[0] = m.grains.motion[2] = CDEM_GRAIN_DRIVEN;
  model_move(&m, 0, 0.1, 0.0, 0.0);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, 5, &fault)); /* the contact lasts for 7 */
  double xyz[9], force[9], start = 0.1 * dem.time;
  cdem_dem_look(&dem, &(cdem_dem_view){.xyz = xyz, .force = force});
  check_near(xyz[0], start, 1e-12, 0.0);
  check_near(force[6], 0.0, 0.0, 0.0);
  check_below(energy_error(&dem, &e), 1e-9);
  assert_true(e.driven > 0.0);
  cdem_dem_drive(&dem, 0, &(cdem_dem_motion){.velocity = {0.0}}, NULL);
  check_ok(cdem_dem_steps(&dem, 10, &fault));
  cdem_dem_look(&dem, &(cdem_dem_view){.xyz = xyz});
  check_near(xyz[0], start, 1e-12, 0.0);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* Rates make a motion that changes from step to step in one call: constant acceleration is
 * followed exactly, however steps are parted into calls. */
static void test_driven_rate(void **state) {
  (void)state;
  double end[2] = {0};
  for (int parted = 0; parted < 2; parted++) {
    model m;
    cdem_dem dem;
    cdem_fault fault = {0};
    elastic(&m, 2, "linear");
    model_add(&m, 0.0, 0.0, 0.0, 0.01);
    model_add(&m, 1.0, 0.0, 0.0, 0.01);
    m.grains.motion[0] = CDEM_GRAIN_DRIVEN;
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    const double a = 3.0, dt = dem.step;
    cdem_dem_drive(&dem, 0, &(cdem_dem_motion){.velocity = {0.5 * a * dt}},
                   &(cdem_dem_motion){.velocity = {a}});
    for (int k = 0; k < (parted ? 20 : 1); k++)
      check_ok(cdem_dem_steps(&dem, parted ? 1 : 20, &fault));
    double xyz[6];
    cdem_dem_look(&dem, &(cdem_dem_view){.xyz = xyz});
    check_near(xyz[0], 0.5 * a * dem.time * dem.time, 1e-13, 0.0);
    end[parted] = xyz[0];
    cdem_dem_release(&dem);
    model_release(&m);
  }
  assert_true(end[0] == end[1]);
}

/* A guided grain is held in some components and free in the others: a disc on a roller keeps its
 * height under a push at 45 degrees, slides as a free one, and the book closes. */
static void test_guided(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_dem_energies e;
  elastic(&m, 2, "linear");
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.0141, 0.0141, 0.0, 0.01);
  m.grains.motion[0] = CDEM_GRAIN_GUIDED | 1u << 1 | 1u << 5;
  m.grains.motion[1] = CDEM_GRAIN_DRIVEN;
  model_move(&m, 1, -0.05, -0.05, 0.0);
  m.options.gravity[0] = -3.0; /* does work along the roller, none across */
  m.options.gravity[1] = -9.81;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, 5, &fault));
  double xyz[6], force[6], velocity[6], spin[6], mass[2];
  cdem_dem_look(&dem,
                &(cdem_dem_view){
                    .xyz = xyz, .force = force, .velocity = velocity, .spin = spin, .mass = mass});
  assert_true(xyz[1] == 0.0 && velocity[1] == 0.0 && spin[2] == 0.0);
  assert_true(force[0] < 0.0 && xyz[0] < 0.0 && velocity[0] < 0.0);
  check_below(energy_error(&dem, &e), 1e-5); /* the normal turns: second order */
  assert_true(cdem_dem_unbalanced(&dem) > 0.0);
  int32_t both[2] = {1, 0};
  double on[12];
  cdem_dem_forces_on(&dem, 2, both, on);
  check_near(on[6], force[0], 0.0, 0.0);
  check_near(on[0] + on[6], 0.0, 0.0, 1e-12 * fabs(force[0]));
  cdem_dem_release(&dem);
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_momentum),     cmocka_unit_test(test_energy_order),
      cmocka_unit_test(test_energy_book),  cmocka_unit_test(test_limit),
      cmocka_unit_test(test_bad_input),    cmocka_unit_test(test_moves_too_far),
      cmocka_unit_test(test_mass_damping), cmocka_unit_test(test_driven),
      cmocka_unit_test(test_driven_rate),  cmocka_unit_test(test_guided),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
