/* Spheres in a membrane between plates, by the solver: what they do to each other, the book, bits.
 */
#include "solver_model.h"

#include <math.h>

typedef struct {
  model m;
  cdem_membrane_options membrane;
  cdem_confinement confinement;
  double time[2], pressure[2];
} specimen;

static cdem_series zero_to(specimen *s, double from, double to, double until) {
  s->time[1] = until;
  s->pressure[0] = from;
  s->pressure[1] = to;
  return (cdem_series){.points = 2, .time = s->time, .value = s->pressure};
}

/* Plates at z = 0 and `height`, a membrane of this radius, nodes for spheres of radius r. */
static void specimen_init(specimen *s, double radius, double height, double r, double pressure) {
  *s = (specimen){0};
  model_init(&s->m, 3, "linear");
  model_word(&s->m, CDEM_LAW_damping_ratio, 0.1);
  model_word(&s->m, CDEM_LAW_friction, 0.3);
  model_plane(&s->m, 0, 0, 0, 0, 0, 1);
  model_plane(&s->m, 0, 0, height, 0, 0, -1);
  s->membrane = (cdem_membrane_options){.radius = radius, .high = height, .poisson = 0.3};
  cdem_membrane_complete(&s->membrane, pressure, 2.0 * r, 2500.0);
  s->confinement = (cdem_confinement){.membrane = &s->membrane, .low = 0, .high = 1};
  s->m.options.confinement = &s->confinement;
}

/* A cubic lattice with gaps, as much as fits into the tube. */
static void fill(specimen *s, double radius, double height, double r) {
  double by = 2.05 * r;
  int across = (int)floor(radius / by), up = (int)floor(height / by);
  double lift = 0.5 * (height - (up - 1) * by);
  for (int k = 0; k < up; k++)
    for (int j = -across; j <= across; j++)
      for (int i = -across; i <= across; i++)
        if (hypot(i, j) * by + r < radius)
          model_add(&s->m, i * by, j * by, lift + k * by, r);
}

static void specimen_release(specimen *s) {
  model_release(&s->m);
}

/* ---- one sphere ---- */

/* Thrown at the membrane: it is stopped, and what the nodes get it loses. */
static void a_sphere_is_caught_by_the_membrane(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  specimen s;
  const double r = 0.01, speed = 0.3;
  specimen_init(&s, 0.05, 0.08, r, 1e4);
  s.confinement.pressure = zero_to(&s, 0.0, 0.0, 1.0);
  model_add(&s.m, 0.034, 0.004, 0.041, r);
  s.m.grains.velocity[0] = speed;
  check_ok(cdem_dem_init(&s.m.options, &dem, &fault));
  const cdem_membrane *m = cdem_dem_membrane(&dem);
  double nearest = 0.0, velocity[3], force[3], worst = 0.0;
  for (int i = 0; i < 60; i++) {
    check_ok(cdem_dem_steps(&dem, 40, &fault));
    cdem_dem_look(&dem, &(cdem_dem_view){.force = force, .velocity = velocity});
    double sum[3] = {0};
    for (int32_t k = 0; k < 3 * m->nodes; k++)
      sum[k % 3] += m->contact[k];
    for (int c = 0; c < 3; c++)
      check_near(force[c] + sum[c], 0.0, 0.0, 1e-12 * (cdem_norm3(force) + 1e-9));
    nearest = fmax(nearest, cdem_norm3(force));
    cdem_dem_energies e;
    cdem_dem_energies_now(&dem, &e);
    worst = fmax(worst, fabs(e.error) / e.exchange);
  }
  assert_true(nearest > 0.0);
  check_below(fabs(velocity[0]), 0.05 * speed);
  check_below(worst, 2e-3);
  cdem_dem_release(&dem);
  specimen_release(&s);
}

static void a_grain_outside_is_told_of(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  specimen s;
  specimen_init(&s, 0.05, 0.08, 0.01, 1e4);
  s.confinement.pressure = zero_to(&s, 0.0, 0.0, 1.0);
  model_add(&s.m, 0.0545, 0.0, 0.04, 0.01);
  check_fails(cdem_dem_init(&s.m.options, &dem, &fault), CDEM_NUMERIC,
              "grain 0 at (0.0545, 0, 0.04 m) is outside of the membrane");
  specimen_release(&s);
}

/* ---- a specimen ---- */

static void press(specimen *s, double servo) {
  s->confinement.presses = true;
  s->m.wall[1].servo[2] = 1.0;
  s->m.wall[1].servo_speed = servo;
}

static void make(specimen *s, int threads) {
  const double r = 0.01, p = 2e4;
  specimen_init(s, 0.1, 0.2, r, p);
  fill(s, 0.1, 0.2, r);
  s->confinement.pressure = zero_to(s, 0.1 * p, p, 0.05);
  s->confinement.quiet = 0.05;
  press(s, 0.1);
  s->m.options.threads = threads;
  s->m.options.safety = 0.3;
}

/* From a lattice with gaps on. After consolidation the plate goes down. */
static void go(cdem_dem *dem, int64_t from, int64_t to) {
  cdem_fault fault = {0};
  if (from < 600 && to >= 600) {
    check_ok(cdem_dem_steps(dem, 600 - from, &fault));
    cdem_dem_shear(dem, -0.05);
    from = 600;
  }
  check_ok(cdem_dem_steps(dem, to - from, &fault));
}

static void check_same(const cdem_dem *a, const cdem_dem *b) {
  const cdem_membrane *one = cdem_dem_membrane(a), *other = cdem_dem_membrane(b);
  double *place[2];
  cdem_fault fault = {0};
  for (int k = 0; k < 2; k++) {
    place[k] = cdem_allocate(3 * a->grains, sizeof(double), &fault);
    cdem_dem_look(k == 0 ? a : b, &(cdem_dem_view){.xyz = place[k]});
  }
  assert_memory_equal(place[0], place[1], (size_t)a->grains * 3 * sizeof(double));
  assert_memory_equal(one->x, other->x, (size_t)one->nodes * 3 * sizeof(double));
  assert_memory_equal(one->v, other->v, (size_t)one->nodes * 3 * sizeof(double));
  cdem_specimen at[2];
  assert_true(cdem_dem_specimen(a, &at[0]) && cdem_dem_specimen(b, &at[1]));
  assert_memory_equal(&at[0].height, &at[1].height, sizeof(double));
  assert_memory_equal(&at[0].axial, &at[1].axial, sizeof(double));
  for (int k = 0; k < 2; k++)
    free(place[k]);
}

static void threads_change_no_bit(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem[2];
  specimen s[2];
  for (int k = 0; k < 2; k++) {
    make(&s[k], 1 + k);
    check_ok(cdem_dem_init(&s[k].m.options, &dem[k], &fault));
    go(&dem[k], 0, 900);
  }
  check_same(&dem[0], &dem[1]);
  for (int k = 0; k < 2; k++) {
    cdem_dem_release(&dem[k]);
    specimen_release(&s[k]);
  }
}

/* Broken before and in the shear. */
static void a_restored_specimen_goes_on_to_the_same_bits(void **state) {
  (void)state;
  for (int64_t broken = 450; broken < 800; broken += 300) {
    cdem_fault fault = {0};
    cdem_dem dem[2];
    specimen s[2];
    cdem_state kept = {0};
    cdem_dem_energies e[2];
    for (int k = 0; k < 2; k++) {
      make(&s[k], 1);
      check_ok(cdem_dem_init(&s[k].m.options, &dem[k], &fault));
    }
    go(&dem[0], 0, broken);
    check_ok(cdem_dem_save(&dem[0], &kept, &fault));
    check_ok(cdem_dem_restore(&dem[1], &kept, &fault));
    cdem_state_release(&kept);
    for (int k = 0; k < 2; k++) {
      go(&dem[k], broken, 1000);
      cdem_dem_energies_now(&dem[k], &e[k]);
    }
    check_same(&dem[0], &dem[1]);
    assert_true(e[0].membrane == e[1].membrane && e[0].pressure == e[1].pressure);
    assert_true(e[0].damping == e[1].damping);
    for (int k = 0; k < 2; k++) {
      cdem_dem_release(&dem[k]);
      specimen_release(&s[k]);
    }
  }
}

static void the_book_of_a_specimen_closes(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem;
  specimen s;
  cdem_dem_energies e;
  make(&s, 1);
  s.m.options.safety = 0.1;
  check_ok(cdem_dem_init(&s.m.options, &dem, &fault));
  go(&dem, 0, 3000);
  cdem_dem_energies_now(&dem, &e);
  assert_true(e.pressure > 0.0 && e.membrane > 0.0);
  check_below(fabs(e.error), 2e-3 * e.exchange);
  cdem_dem_release(&dem);
  specimen_release(&s);
}

/* The step that a membrane allows is the solver's business, too. */
static void a_light_membrane_limits_the_step(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem;
  specimen s;
  char limiter[64];
  make(&s, 1);
  s.membrane.areal_density *= 1e-4;
  check_ok(cdem_dem_init(&s.m.options, &dem, &fault));
  double limit;
  check_ok(cdem_dem_limit(&dem, &limit, limiter, &fault));
  assert_string_equal(limiter, "the nodes of the membrane");
  cdem_dem_release(&dem);
  specimen_release(&s);
}

/* ---- a rigid cylinder ---- */

/* Its radius and the plate find the pressure. */
static void a_cylinder_carries_the_pressure(void **state) {
  (void)state;
  const double p = 2e4;
  cdem_fault fault = {0};
  cdem_dem dem;
  specimen s;
  make(&s, 1);
  s.m.wall[2] = (cdem_wall){.name = "side",
                            .shape = CDEM_WALL_CYLINDER,
                            .axis = {0, 0, 1},
                            .radius = 0.1,
                            .material = 1,
                            .servo_radius = true,
                            .servo_speed = 0.1};
  s.m.options.walls = 3;
  s.m.options.materials = 2; /* the side is smooth, else it would carry a part of the axial force */
  s.m.contact[1].value[CDEM_LAW_friction] = s.m.contact[2].value[CDEM_LAW_friction] = 0.0;
  s.confinement.membrane = NULL;
  s.confinement.side = 2;
  check_ok(cdem_dem_init(&s.m.options, &dem, &fault));
  assert_null(cdem_dem_membrane(&dem));
  cdem_specimen at;
  check_ok(cdem_dem_steps(&dem, 12000, &fault));
  assert_true(cdem_dem_specimen(&dem, &at));
  check_near(at.pressure, p, 1e-12, 0.0);
  check_near(at.lateral, p, 0.02, 0.0);
  check_near(at.axial, p, 0.02, 0.0);
  check_near(at.bottom, p, 0.02, 0.0);
  cdem_dem_energies e;
  cdem_dem_energies_now(&dem, &e);
  check_below(fabs(e.error), 2e-2 * e.exchange);
  cdem_dem_release(&dem);
  specimen_release(&s);
}

static void what_cannot_be_confined_is_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem;
  specimen s;
  make(&s, 1);
  s.confinement.high = 7;
  check_fails(cdem_dem_init(&s.m.options, &dem, &fault), CDEM_INPUT,
              "walls 0 and 7; there are 2 walls");
  s.confinement.high = 1;
  s.m.wall[1].servo[2] = 0.0;
  check_fails(cdem_dem_init(&s.m.options, &dem, &fault), CDEM_INPUT, "has no servo along z");
  s.m.wall[1].servo[2] = 1.0;
  s.membrane.spacing = 0.011;
  check_fails(cdem_dem_init(&s.m.options, &dem, &fault), CDEM_INPUT,
              "let grains of 0.02 m through");
  s.confinement.membrane = NULL;
  check_fails(cdem_dem_init(&s.m.options, &dem, &fault), CDEM_INPUT,
              "a membrane or a cylinder with a servo of its radius");
  specimen_release(&s);
}

static void a_membrane_that_is_not_finite_ends_the_run(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  specimen s;
  specimen_init(&s, 0.05, 0.08, 0.01, 1e4);
  s.confinement.pressure = zero_to(&s, 0.0, 0.0, 1.0);
  model_add(&s.m, 0.0, 0.0, 0.04, 0.01);
  check_ok(cdem_dem_init(&s.m.options, &dem, &fault));
  const cdem_membrane *m = cdem_dem_membrane(&dem);
  m->v[3 * (m->nodes / 2)] = NAN;
  check_fails(cdem_dem_steps(&dem, 3, &fault), CDEM_NUMERIC, "the membrane is no longer finite");
  cdem_dem_release(&dem);
  specimen_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_sphere_is_caught_by_the_membrane),
                                     cmocka_unit_test(a_grain_outside_is_told_of),
                                     cmocka_unit_test(a_membrane_that_is_not_finite_ends_the_run),
                                     cmocka_unit_test(threads_change_no_bit),
                                     cmocka_unit_test(a_restored_specimen_goes_on_to_the_same_bits),
                                     cmocka_unit_test(the_book_of_a_specimen_closes),
                                     cmocka_unit_test(a_light_membrane_limits_the_step),
                                     cmocka_unit_test(a_cylinder_carries_the_pressure),
                                     cmocka_unit_test(what_cannot_be_confined_is_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
