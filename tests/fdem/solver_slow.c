/* Room fdem: grains that fly, spin, bounce, roll and touch: their balances. */
#include "fdem/solver_store.h"
#include "fdem/solver_support.h"

static cdem_fault fault;

/* A box that is thrown spinning about no axis of its own: momenta to rounding, energy to the second
 * order of the step (Dzhanibekov's motion keeps changing its spin). */
static double spin_error(double step) {
  cdem_mesh box;
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_HEX8, .count = {2, 2, 2}, .size = {3.0, 2.0, 1.0}};
  check_ok(cdem_mesh_grid(&grid, &box, &fault));
  scene s;
  scene_of("mesh", 0, 1e9, 0.2, &box, &s);
  int g = scene_add(&s, 1.0, 2.0, 3.0, 0.5, 7);
  const double spin[3] = {1.0, 20.0, 2.0}, velocity[3] = {1.0, -2.0, 0.5};
  memcpy(s.spin + 3 * g, spin, sizeof spin);
  memcpy(s.velocity + 3 * g, velocity, sizeof velocity);
  s.options.step = step;
  s.law.penalty = 1e6;
  cdem_fdem fdem;
  check_ok(cdem_fdem_init(&s.options, &fdem, &fault));
  double linear[2][3], angular[2][3], worst = 0.0;
  cdem_fdem_energies e[2];
  cdem_fdem_momentum(&fdem, linear[0], angular[0]);
  cdem_fdem_energies_now(&fdem, &e[0]);
  int steps = (int)lround(1.0 / step);
  for (int n = 0; n < 100; n++) {
    check_ok(cdem_fdem_steps(&fdem, steps / 100, &fault));
    cdem_fdem_energies_now(&fdem, &e[1]);
    worst = fmax(worst, fabs(kept(&e[1]) / kept(&e[0]) - 1.0));
  }
  cdem_fdem_momentum(&fdem, linear[1], angular[1]);
  for (int c = 0; c < 3; c++) {
    check_near(linear[1][c], linear[0][c], 1e-12, 0.0);
    check_near(angular[1][c], angular[0][c], 0.0, 1e-11 * cdem_norm3(angular[0]));
  }
  cdem_fdem_release(&fdem);
  cdem_mesh_release(&box);
  scene_release(&s);
  return worst;
}

static void test_spins(void **state) {
  (void)state;
  double coarse = spin_error(4e-5), fine = spin_error(2e-5);
  check_below(coarse, 1e-4);
  check_near(coarse / fine, 4.0, 0.2, 0.0);
}

/* A ball dropped on a floor: it comes back with the momentum that the floor has given it
 * (velocities are those of half a step before), and the book closes by the square of the step, in
 * both schemes.
 */
static void bounce(cdem_fdem_integration integration, double safety, double *error, double *back) {
  scene s;
  scene_of("cubesphere", 2, 40e9, 0.2, NULL, &s);
  scene_add(&s, 0.0, 0.0, 0.056, 0.05, 3); /* corners stand out */
  scene_floor(&s, 0.0, 0.0, 1.0);
  s.velocity[2] = -2.0;
  s.velocity[0] = 0.4;
  s.law.friction = 0.3;
  s.options.gravity[2] = -9.81;
  s.options.integration = integration;
  s.options.safety = safety;
  cdem_fdem fdem;
  cdem_fdem_energies e;
  check_ok(cdem_fdem_init(&s.options, &fdem, &fault));
  *error = 0.0;
  double given[3] = {0.0}; /* impulse of the floor, N s */
  while (fdem.time < 2e-3) {
    double force[3], center[3], speed[3];
    cdem_fdem_wall_now(&fdem, 0, force, center, speed);
    for (int c = 0; c < 3; c++)
      given[c] -= fdem.step * force[c];
    check_ok(cdem_fdem_steps(&fdem, 1, &fault));
    cdem_fdem_energies_now(&fdem, &e);
    *error = fmax(*error, fabs(e.error) / e.exchange);
  }
  assert_true(e.normal == 0.0); /* it has left */
  assert_true(e.friction > 0.0);
  double velocity[3];
  cdem_fdem_look(&fdem, &(cdem_fdem_view){.velocity = velocity});
  for (int c = 0; c < 3; c++) {
    double weight = s.options.gravity[c] * (fdem.time - 0.5 * fdem.step);
    check_near(velocity[c], s.velocity[c] + weight + given[c] / cdem_fdem_mass(&fdem, 0), 0.0,
               1e-12 * 2.0);
  }
  *back = velocity[2];
  cdem_fdem_release(&fdem);
  scene_release(&s);
}

static void test_bounces(void **state) {
  (void)state;
  double error[2], back[2];
  bounce(CDEM_FDEM_EXPLICIT, 0.4, &error[0], &back[0]);
  bounce(CDEM_FDEM_EXPLICIT, 0.1, &error[1], &back[1]);
  check_below(error[1], 1e-5);
  assert_true(error[1] < 0.2 * error[0]);
  assert_true(back[1] > 0.0);
  check_below(back[1], 2.0); /* vibration and friction keep the rest */
  bounce(CDEM_FDEM_IMPLICIT, 0.1, &error[0], &back[0]);
  check_below(error[0], 1e-4);
  check_near(back[0], back[1], 0.01, 0.0);
}

/* Steps that are halved and doubled again and again: the book closes as with even ones. Steps
 * follow the contacts, so a change is made here as cdem_fdem_follow makes it. */
static double uneven(cdem_fdem_integration integration, int every) {
  scene s;
  scene_of("cubesphere", 2, 40e9, 0.2, NULL, &s);
  scene_add(&s, 0.0, 0.0, 0.056, 0.05, 3);
  scene_floor(&s, 0.0, 0.0, 1.0);
  s.velocity[2] = -8.0;
  s.velocity[0] = 0.4;
  s.law.penalty = 1e10;
  s.options.integration = integration;
  s.options.safety = 0.2;
  cdem_fdem fdem;
  cdem_fdem_energies e;
  double worst = 0.0;
  check_ok(cdem_fdem_init(&s.options, &fdem, &fault));
  const double first = fdem.step;
  while (fdem.time < 3e-3) {
    check_ok(cdem_fdem_steps(&fdem, 1, &fault));
    if (fdem.steps % every == 0) {
      double next = fdem.steps / every % 2 == 1 ? 0.5 * first : first;
      fdem.store->base_time = fdem.time;
      fdem.store->base_steps = fdem.steps;
      fdem.store->kick = 0.5 * (fdem.step + next);
      fdem.step = next;
    }
    cdem_fdem_energies_now(&fdem, &e);
    worst = fmax(worst, fabs(e.error) / e.exchange);
  }
  cdem_fdem_release(&fdem);
  scene_release(&s);
  return worst;
}

static void test_changed_steps(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    cdem_fdem_integration scheme = k == 0 ? CDEM_FDEM_IMPLICIT : CDEM_FDEM_EXPLICIT;
    check_below(uneven(scheme, 7), 2.0 * uneven(scheme, 1 << 30));
  }
}

/* Mass damping alone: v0/c (1 - exp(-c t)), to the second order from the start on. */
static double damped_error(double step) {
  const double rate = 200.0, speed = 3.0, end = 0.01;
  scene s;
  scene_of("cubesphere", 1, 1e9, 0.2, NULL, &s);
  scene_add(&s, 0.0, 0.0, 0.0, 0.05, 0);
  s.velocity[0] = speed;
  s.spin[2] = 10.0;
  s.law.penalty = 1e6;
  s.options.mass_damping = rate;
  s.options.step = step;
  cdem_fdem fdem;
  cdem_fdem_energies e;
  double place[3], spin[3];
  check_ok(cdem_fdem_init(&s.options, &fdem, &fault));
  check_ok(cdem_fdem_steps(&fdem, lround(end / step), &fault));
  cdem_fdem_look(&fdem, &(cdem_fdem_view){.xyz = place, .spin = spin});
  cdem_fdem_energies_now(&fdem, &e);
  check_below(fabs(e.error), 1e-12 * e.exchange);
  check_near(spin[2], 10.0 * exp(-rate * (end - 0.5 * step)), 1e-4, 0.0);
  cdem_fdem_release(&fdem);
  scene_release(&s);
  return place[0] - speed / rate * (1.0 - exp(-rate * end));
}

static void test_damps(void **state) {
  (void)state;
  double coarse = damped_error(5e-5), fine = damped_error(2.5e-5);
  check_near(coarse / fine, 4.0, 0.01, 0.0);
  check_below(fabs(coarse), 1e-6);
}

/* Down a slope: g sin(theta)/(1 + I/(m r^2)) and no slip, on the mean: the mesh is a polyhedron and
 * its nodes come and go. It starts as deep in the slope as its weight sinks, p pi r d^2 = m g cos.
 */
static void test_rolls(void **state) {
  (void)state;
  const double theta = 0.2, r = 0.05, penalty = 1e7, pi = 3.14159265358979323846;
  scene s;
  scene_of("cubesphere", 4, 40e9, 0.2, NULL, &s);
  const double mass = s.density * 4.0 / 3.0 * pi * r * r * r;
  const double deep = sqrt(mass * 9.81 * cos(theta) / (penalty * pi * r)), h = r - deep;
  scene_add(&s, h * sin(theta), 0.0, h * cos(theta), r, 5);
  scene_floor(&s, 0.0, sin(theta), cos(theta));
  s.law = (cdem_fdem_contact_law){
      .penalty = penalty, .shear_ratio = 1.0, .friction = 0.6, .damping_ratio = 0.05};
  s.options.gravity[2] = -9.81;
  s.options.safety = 0.1;
  cdem_fdem fdem;
  check_ok(cdem_fdem_init(&s.options, &fdem, &fault));
  const double start = 0.1, end = 0.6;
  double speed[2], spin[3], velocity[3];
  cdem_fdem_energies e;
  for (int k = 0; k < 2; k++) {
    while (fdem.time < (k == 0 ? start : end))
      check_ok(cdem_fdem_steps(&fdem, 1, &fault));
    cdem_fdem_look(&fdem, &(cdem_fdem_view){.velocity = velocity, .spin = spin});
    speed[k] = velocity[0] * cos(theta) - velocity[2] * sin(theta);
  }
  cdem_fdem_energies_now(&fdem, &e);
  check_below(fabs(e.error), 1e-3 * e.exchange);
  double ratio = s.shape.inertia[0] / (4.0 / 3.0 * pi);
  check_near((speed[1] - speed[0]) / (end - start), 9.81 * sin(theta) / (1.0 + ratio), 0.03, 0.0);
  check_near(spin[1] * r, speed[1], 0.05, 0.0);
  cdem_fdem_release(&fdem);
  scene_release(&s);
}

/* A heap of balls that collide: momentum to rounding, book to the step, same bits of any number of
 * threads, and of a solver restored on the way. */
static void make_cloud(scene *s, int threads, bool reference, cdem_fdem *fdem) {
  scene_of("cubesphere", 2, 40e9, 0.2, NULL, s);
  cdem_random random = {11};
  for (int i = 0; i < 48; i++) {
    int g = scene_add(s, 0.045 * (i % 4), 0.045 * (i / 4 % 4), 0.045 * (i / 16),
                      cdem_random_uniform(&random, 0.018, 0.022), (uint64_t)i + 1);
    for (int c = 0; c < 3; c++) {
      s->velocity[3 * g + c] = cdem_random_uniform(&random, -5.0, 5.0);
      s->spin[3 * g + c] = cdem_random_uniform(&random, -50.0, 50.0);
    }
  }
  s->law = (cdem_fdem_contact_law){
      .penalty = 1e11, .shear_ratio = 0.8, .friction = 0.3, .damping_ratio = 0.1};
  s->options.threads = threads;
  s->options.reference = reference;
  s->options.safety = 0.2;
  check_ok(cdem_fdem_init(&s->options, fdem, &fault));
}

static void centres_of(const cdem_fdem *fdem, double *xyz) {
  cdem_fdem_look(fdem, &(cdem_fdem_view){.xyz = xyz});
}

static void test_balances(void **state) {
  (void)state;
  scene s;
  cdem_fdem fdem;
  make_cloud(&s, 1, false, &fdem);
  double linear[2][3], angular[2][3], size = 0.0, turn = 0.0;
  cdem_fdem_energies e;
  cdem_fdem_momentum(&fdem, linear[0], angular[0]);
  for (int64_t g = 0; g < fdem.grains; g++) {
    size += cdem_fdem_mass(&fdem, g) * 5.0;
    turn += cdem_fdem_mass(&fdem, g) * 5.0 * 0.1;
  }
  check_ok(cdem_fdem_steps(&fdem, 2000, &fault));
  cdem_fdem_momentum(&fdem, linear[1], angular[1]);
  for (int c = 0; c < 3; c++) {
    check_near(linear[1][c], linear[0][c], 0.0, 1e-12 * size);
    check_near(angular[1][c], angular[0][c], 0.0, 1e-11 * turn);
  }
  cdem_fdem_energies_now(&fdem, &e);
  assert_true(e.friction > 0.0 && e.damping > 0.0);
  check_below(fabs(e.error), 1e-2 * e.exchange);
  cdem_fdem_release(&fdem);
  scene_release(&s);
}

static void test_same_bits(void **state) {
  (void)state;
  static double one[3 * SCENE_GRAINS], two[3 * SCENE_GRAINS], plain[3 * SCENE_GRAINS];
  scene s[3];
  cdem_fdem fdem[3];
  for (int k = 0; k < 3; k++) {
    make_cloud(&s[k], k + 1, k == 2, &fdem[k]);
    check_ok(cdem_fdem_steps(&fdem[k], 600, &fault));
  }
  centres_of(&fdem[0], one);
  centres_of(&fdem[1], two);
  centres_of(&fdem[2], plain);
  assert_memory_equal(one, two, sizeof one);
  for (int64_t i = 0; i < 3 * fdem[0].grains; i++)
    check_near(plain[i], one[i], 0.0, 1e-10); /* m; another order of sums, and collisions */
  cdem_state saved = {0};
  check_ok(cdem_fdem_save(&fdem[0], &saved, &fault));
  check_ok(cdem_fdem_restore(&fdem[1], &saved, &fault));
  check_ok(cdem_fdem_steps(&fdem[0], 400, &fault));
  check_ok(cdem_fdem_steps(&fdem[1], 400, &fault));
  centres_of(&fdem[0], one);
  centres_of(&fdem[1], two);
  assert_memory_equal(one, two, sizeof one);
  ((double *)cdem_state_find(&saved, "fdem/numbers")->data)[1] = 0.0;
  check_fails(cdem_fdem_restore(&fdem[1], &saved, &fault), CDEM_INPUT,
              "steps of 0 s, which cannot be");
  cdem_state_release(&saved);
  for (int k = 0; k < 3; k++) {
    cdem_fdem_release(&fdem[k]);
    scene_release(&s[k]);
  }
}

static void test_errors(void **state) {
  (void)state;
  scene s;
  cdem_fdem fdem;
  scene_of("tetrasphere", 0, 1e9, 0.2, NULL, &s);
  check_fails(cdem_fdem_init(&s.options, &fdem, &fault), CDEM_INPUT, "at least one is needed");
  scene_add(&s, 0.0, 0.0, 0.0, -1.0, 0);
  check_fails(cdem_fdem_init(&s.options, &fdem, &fault), CDEM_INPUT,
              "grain 0 has the radius -1 m; it must be positive");
  s.radius[0] = 1.0;
  s.orientation[0] = 0.0;
  check_fails(cdem_fdem_init(&s.options, &fdem, &fault), CDEM_INPUT, "a quaternion of square 0");
  s.orientation[0] = 1.0;
  scene_floor(&s, -2.0, 0.0, 1.0)->material = 1;
  check_fails(cdem_fdem_init(&s.options, &fdem, &fault), CDEM_INPUT,
              "wall 'floor' is of material 1 of 1");
  s.options.walls = 0;
  s.options.step = 1.0;
  check_fails(cdem_fdem_init(&s.options, &fdem, &fault), CDEM_INPUT, "the step 1 s is unstable");
  s.options.step = 0.0;
  s.law.penalty = 0.0;
  check_fails(cdem_fdem_init(&s.options, &fdem, &fault), CDEM_INPUT, "it must be positive");
  s.law.penalty = 1e9;
  s.velocity[0] = 1e9;
  check_ok(cdem_fdem_init(&s.options, &fdem, &fault));
  check_fails(cdem_fdem_steps(&fdem, 10, &fault), CDEM_NUMERIC,
              "grain 0 moves by more than half its radius");
  cdem_fdem_release(&fdem);
  s.velocity[0] = 0.0;
  s.spin[0] = 1e300;
  check_ok(cdem_fdem_init(&s.options, &fdem, &fault));
  check_fails(cdem_fdem_steps(&fdem, 10, &fault), CDEM_NUMERIC, "is no longer finite");
  cdem_fdem_release(&fdem);
  scene_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_changed_steps), cmocka_unit_test(test_damps),
      cmocka_unit_test(test_spins),         cmocka_unit_test(test_bounces),
      cmocka_unit_test(test_rolls),         cmocka_unit_test(test_balances),
      cmocka_unit_test(test_same_bits),     cmocka_unit_test(test_errors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
