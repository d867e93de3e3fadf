/* The energy book with everything that dissipates, at the step the solver chooses. */
#include "solver_model.h"

static void lossy(model *m, int dim, const char *law, double restitution) {
  model_init(m, dim, law);
  model_word(m, CDEM_LAW_friction, 0.4);
  if (strcmp(law, "li-chu") != 0) {
    model_word(m, CDEM_LAW_restitution, restitution);
    return;
  }
  model_word(m, CDEM_LAW_normal_dashpot, 20.0);
  model_word(m, CDEM_LAW_shear_dashpot, 10.0);
  model_word(m, CDEM_LAW_rolling_force_stiffness, 1e3);
  model_word(m, CDEM_LAW_rolling_force_friction, 0.05);
  model_word(m, CDEM_LAW_rolling_stiffness, 0.1);
  model_word(m, CDEM_LAW_rolling_length, 5e-4);
}

/* The book closes by default to 1e-3 of the largest term, at every report of a heap that falls
 * together. */
static void the_book_closes_by_default(void **state) {
  (void)state;
  static const struct {
    int dim;
    const char *law;
    double restitution;
    const char *rolling;
  } cases[] = {{3, "linear", 0.3, NULL},     {3, "linear", 0.8, NULL},
               {2, "linear", 0.5, NULL},     {2, "linear", 0.5, "constant"},
               {3, "linear", 0.5, "spring"}, {3, "hertz", 0.5, NULL},
               {3, "mindlin", 0.5, NULL},    {2, "li-chu", 0.5, NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    model m;
    cdem_dem dem;
    cdem_fault fault = {0};
    cdem_dem_energies e;
    int side = cases[k].dim == 2 ? 7 : 4;
    lossy(&m, cases[k].dim, cases[k].law, cases[k].restitution);
    if (cases[k].rolling != NULL) {
      m.options.rolling = cdem_rolling_find(cases[k].rolling);
      model_word(&m, CDEM_LAW_rolling_friction, 0.1);
    }
    model_heap(&m, side, 1.3, 0.2, 7);
    model_box(&m, side);
    m.options.gravity[1] = -9.81;
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    for (int report = 0; report < 10; report++) {
      check_ok(cdem_dem_steps(&dem, 200, &fault));
      check_below(energy_error(&dem, &e), 1e-3);
    }
    assert_true(e.damping > 0.0);
    /* Li & Chu's cap with dashpots may give back a little more than it took (law_li_chu.c) */
    assert_true(e.friction > 0.0 || strcmp(cases[k].law, "li-chu") == 0);
    assert_true(cases[k].rolling == NULL || e.rolling > 0.0);
    cdem_dem_release(&dem);
    model_release(&m);
  }
}

/* A pressed pair with dashpots: the error falls with the square of the step, also while the contact
 * lasts, when half of the last step's dissipation lies ahead. */
static void dissipation_is_booked_to_second_order(void **state) {
  (void)state;
  static const char *const laws[] = {"linear", "hertz", "mindlin"};
  for (int k = 0; k < 3; k++) {
    double error[2] = {0.0, 0.0};
    for (int half = 0; half < 2; half++) {
      model m;
      cdem_dem dem;
      cdem_fault fault = {0};
      cdem_dem_energies e;
      lossy(&m, 3, laws[k], 0.4);
      model_word(&m, CDEM_LAW_friction, 10.0);
      model_add(&m, 0.0, 0.0, 0.0, 0.01);
      model_add(&m, 0.0195, 0.0, 0.0, 0.01);
      model_move(&m, 1, -0.3, 0.1, 0.05);
      check_ok(cdem_dem_init(&m.options, &dem, &fault));
      check_ok(cdem_dem_set_step(&dem, dem.step * (half ? 0.25 : 0.5), &fault));
      for (int n = 0; n < (half ? 48 : 24); n++) {
        check_ok(cdem_dem_step(&dem, &fault));
        error[half] = fmax(error[half], energy_error(&dem, &e));
      }
      assert_true(e.damping > 0.02 * e.initial);
      cdem_dem_release(&dem);
      model_release(&m);
    }
    check_below(error[0], 2e-3);
    assert_true(error[1] < 0.3 * error[0]);
  }
}

/* Another step in the middle: what was booked stays booked, to the last line. */
static void a_change_of_step_changes_no_line(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_dem_energies a, b;
  lossy(&m, 3, "linear", 0.5);
  model_heap(&m, 4, 2.0, 0.2, 7);
  model_box(&m, 4);
  m.options.gravity[1] = -9.81;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, 200, &fault));
  cdem_dem_energies_now(&dem, &a);
  check_ok(cdem_dem_set_step(&dem, 0.37 * dem.step, &fault));
  cdem_dem_energies_now(&dem, &b);
  check_near(b.damping, a.damping, 1e-12, 0.0);
  check_near(b.friction, a.friction, 1e-12, 0.0);
  check_near(b.normal, a.normal, 1e-12, 0.0);
  check_near(b.error, a.error, 0.0, 1e-12 * a.exchange);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* A plate pushes a heap along: its work is the product of its force and its way, and the book
 * closes. */
static void a_moving_wall_works(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_dem_energies e;
  double zero = 0.0, speed = 0.2, work = 0.0;
  lossy(&m, 2, "linear", 0.5);
  model_heap(&m, 7, 2.0, 0.0, 7);
  model_box(&m, 7);
  m.wall[0].velocity[0] = (cdem_series){.points = 1, .time = &zero, .value = &speed};
  m.options.gravity[1] = -9.81;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  while (dem.time < 0.1) {
    cdem_dem_wall before, after;
    cdem_dem_wall_now(&dem, 0, &before);
    double step = dem.step;
    check_ok(cdem_dem_step(&dem, &fault));
    cdem_dem_wall_now(&dem, 0, &after);
    work -= 0.5 * step * speed * (before.force[0] + after.force[0]);
  }
  check_below(energy_error(&dem, &e), 1e-3);
  assert_true(work > 0.05 * e.exchange);
  check_near(e.walls, work, 1e-10, 0.0);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* Cundall's local damping. A block on a spring: half a swing from x to the rest goes under the
 * force (1 -+ alpha) k x, so that speed v0 at the rest becomes v0 sqrt((1 - alpha)/(1 + alpha))
 * after each excursion: out against (1 + alpha) k x, back by (1 - alpha) k x. */
static void local_damping_is_cundalls(void **state) {
  (void)state;
  const double alpha = 0.4;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_dem_energies e;
  cdem_bond_law spring = {.normal_stiffness = 1e5};
  cdem_bond bond = {{0, 1}, 0};
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_damping_ratio, 0.0);
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.03, 0.0, 0.0, 0.01);
  m.grains.motion[0] = CDEM_GRAIN_DRIVEN;
  model_move(&m, 1, 0.1, 0.0, 0.0);
  m.options.bond = &bond;
  m.options.bonds = 1;
  m.options.bond_law = &spring;
  m.options.bond_laws = 1;
  m.options.local_damping = alpha;
  m.options.safety = 0.01;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  double x[6], v[6], before[2] = {0.03, 0.1}, total = 1e300;
  int crossings = 0;
  for (int n = 0; n < 1200 && crossings < 3; n++) {
    check_ok(cdem_dem_step(&dem, &fault));
    cdem_dem_look(&dem, &(cdem_dem_view){.xyz = x, .velocity = v});
    cdem_dem_energies_now(&dem, &e);
    double now = e.translation + e.bond; /* never grows but by rounding */
    assert_true(now <= total * (1.0 + 1e-12));
    total = now;
    check_below(fabs(e.error) / e.exchange, 1e-3);
    if (n > 0 && (x[3] - 0.03) * (before[0] - 0.03) < 0.0) {
      crossings++;
      double share = (0.03 - before[0]) / (x[3] - before[0]);
      double speed = fabs(before[1] + share * (v[3] - before[1]));
      check_near(speed, 0.1 * pow((1.0 - alpha) / (1.0 + alpha), 0.5 * crossings), 2e-3, 0.0);
    }
    before[0] = x[3];
    before[1] = v[3];
  }
  assert_int_equal(crossings, 3);
  cdem_dem_release(&dem);
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_book_closes_by_default),
      cmocka_unit_test(dissipation_is_booked_to_second_order),
      cmocka_unit_test(a_change_of_step_changes_no_line),
      cmocka_unit_test(a_moving_wall_works),
      cmocka_unit_test(local_damping_is_cundalls),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
