/* Grains on walls, by the solver: rolling, weighing, drums, servos, meshes in motion. */
#include "solver_model.h"

static cdem_series constant(double *value) {
  static double zero = 0.0;
  return (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 1, .time = &zero, .value = value};
}

/* ---- a slope ---- */

enum { SLOPE = 12 };
typedef struct {
  double corner[3 * (SLOPE + 1) * (SLOPE + 1)];
  int32_t facet[6 * SLOPE * SLOPE];
} slope_mesh;

/* A floor through the origin, inclined by `angle` about y, 1 m wide, of unequal triangles. */
static void make_slope(slope_mesh *m, double angle, cdem_wall *wall) {
  cdem_random random = {9};
  int32_t f = 0;
  for (int32_t j = 0; j <= SLOPE; j++)
    for (int32_t i = 0; i <= SLOPE; i++) {
      double *c = m->corner + 3 * (j * (SLOPE + 1) + i);
      double u = (i + cdem_random_uniform(&random, -0.3, 0.3)) / SLOPE - 0.3;
      c[0] = u * cos(angle);
      c[1] = (j + cdem_random_uniform(&random, -0.3, 0.3)) / SLOPE - 0.5;
      c[2] = -u * sin(angle);
    }
  for (int32_t j = 0; j < SLOPE; j++)
    for (int32_t i = 0; i < SLOPE; i++) {
      int32_t a = j * (SLOPE + 1) + i, d = a + SLOPE + 2, b = a + 1, c = d - 1;
      const int32_t two[6] = {a, b, d, a, d, c};
      memcpy(m->facet + f, two, sizeof two);
      f += 6;
    }
  *wall = (cdem_wall){.name = "slope",
                      .shape = CDEM_WALL_MESH,
                      .corners = (SLOPE + 1) * (SLOPE + 1),
                      .corner = m->corner,
                      .facets = 2 * SLOPE * SLOPE,
                      .facet = m->facet};
}

/* Down a plane (mesh NULL) or a mesh; place and spin after `steps`. */
static void roll(double angle, const cdem_wall *mesh, int64_t steps, double *time, double x[3],
                 double *spin) {
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  model m;
  const double r = 0.01, g = 9.81, kn = 1e5;
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_friction, 0.8);
  model_word(&m, CDEM_LAW_damping_ratio, 0.0);
  double mass = 2500.0 * 4.0 / 3.0 * M_PI * r * r * r, h = r - mass * g * cos(angle) / kn;
  model_add(&m, h * sin(angle), 0.0, h * cos(angle), r);
  model_plane(&m, 0, 0, 0, sin(angle), 0, cos(angle));
  if (mesh != NULL)
    m.wall[0] = *mesh;
  m.options.gravity[2] = -g;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, steps, &fault));
  double w[3];
  cdem_dem_look(&dem, &(cdem_dem_view){.xyz = x, .spin = w});
  *spin = w[1];
  *time = dem.time;
  x[0] -= h * sin(angle);
  x[2] -= h * cos(angle);
  cdem_dem_release(&dem);
  model_release(&m);
}

static void a_sphere_rolls_down_a_plane_and_a_mesh_alike(void **state) {
  (void)state;
  static slope_mesh mesh;
  const double angle = 0.3, g = 9.81;
  cdem_wall wall;
  double time, x[3], spin, on_mesh[3], spin_on_mesh;
  make_slope(&mesh, angle, &wall);
  roll(angle, NULL, 5000, &time, x, &spin);
  double way = x[0] * cos(angle) - x[2] * sin(angle);
  double expected = 0.5 * g * sin(angle) / (1.0 + 0.4) * time * time;
  assert_true(way > 0.1); /* several triangles */
  /* The tangential spring starts without its load and vibrates about it, which adds a way of its
   * stretch, 1e-6 m. */
  check_near(way, expected, 1e-4, 0.0);
  /* by half a step each way between place and spin */
  check_near(spin * 0.01, sqrt(2.0 * way * g * sin(angle) / 1.4), 2e-3, 0.0);
  roll(angle, &wall, 5000, &time, on_mesh, &spin_on_mesh);
  for (int c = 0; c < 3; c++)
    check_near(on_mesh[c], x[c], 1e-10, 1e-13);
  check_near(spin_on_mesh, spin, 1e-10, 0.0);
}

/* ---- forces on walls ---- */

/* What the walls do not give the grains, the weight does: at every step, to rounding. */
static void walls_feel_what_grains_lose(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  model m;
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_friction, 0.4);
  model_word(&m, CDEM_LAW_restitution, 0.3);
  model_heap(&m, 4, 2.0, 0.2, 3);
  model_box(&m, 4);
  m.options.gravity[2] = -9.81;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  double mass[64], weight = 0.0, before[3], after[3], turn[3];
  cdem_dem_look(&dem, &(cdem_dem_view){.mass = mass});
  for (int i = 0; i < 64; i++)
    weight += 9.81 * mass[i];
  double largest = 0.0;
  for (int k = 0; k < 400; k++) {
    double on_walls[3] = {0.0, 0.0, 0.0};
    for (int w = 0; w < m.options.walls; w++) {
      cdem_dem_wall now;
      cdem_dem_wall_now(&dem, w, &now);
      for (int c = 0; c < 3; c++)
        on_walls[c] += now.force[c];
    }
    cdem_dem_momentum(&dem, before, turn);
    check_ok(cdem_dem_step(&dem, &fault));
    cdem_dem_momentum(&dem, after, turn);
    for (int c = 0; c < 3; c++) {
      double force = (after[c] - before[c]) / dem.step;
      check_near(force + on_walls[c], c == 2 ? -weight : 0.0, 1e-9, 1e-9 * weight);
      largest = fmax(largest, fabs(on_walls[c]));
    }
  }
  assert_true(largest > weight);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* Grains at rest in a box: its floor carries them all, its sides push against each other. */
static void a_box_weighs_its_grains(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  model m;
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_friction, 0.4);
  model_word(&m, CDEM_LAW_restitution, 0.3);
  model_heap(&m, 2, 1.5, 0.0, 3);
  model_box(&m, 2);
  m.options.gravity[2] = -9.81;
  m.options.mass_damping = 40.0;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  double mass[8], weight = 0.0, sum[3] = {0.0, 0.0, 0.0};
  cdem_dem_look(&dem, &(cdem_dem_view){.mass = mass});
  for (int i = 0; i < 8; i++)
    weight += 9.81 * mass[i];
  while (dem.time < 0.2 || cdem_dem_unbalanced(&dem) > 1e-5) {
    check_ok(cdem_dem_steps(&dem, 500, &fault));
    assert_true(dem.time < 3.0);
  }
  for (int w = 0; w < m.options.walls; w++) {
    cdem_dem_wall now;
    cdem_dem_wall_now(&dem, w, &now);
    for (int c = 0; c < 3; c++)
      sum[c] += now.force[c];
  }
  for (int c = 0; c < 3; c++)
    check_near(sum[c], c == 2 ? -weight : 0.0, 0.0, 1e-4 * weight);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* ---- drums ---- */

static void make_drum(model *m, double radius, double spin[1]) {
  m->wall[m->options.walls++] = (cdem_wall){.name = "drum",
                                            .shape = CDEM_WALL_CYLINDER,
                                            .radius = radius,
                                            .axis = {0, 0, 1},
                                            .spin = {{0}, {0}, constant(spin)}};
}

/* A disc rolls to and fro at the bottom of a drum like a pendulum: w^2 = g/((R - r)(1 + 1/2)). */
static void a_disc_swings_in_a_drum(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  model m;
  const double r = 0.01, R = 0.05, g = 9.81, start = 0.05;
  double rest = 0.0, x[3];
  model_init(&m, 2, "linear");
  model_word(&m, CDEM_LAW_friction, 1.0);
  model_word(&m, CDEM_LAW_damping_ratio, 0.0);
  model_word(&m, CDEM_LAW_normal_stiffness, 1e7);
  double depth = 2500.0 * M_PI * r * r * g * cos(start) / 1e7, arm = R - r + depth;
  model_add(&m, arm * sin(start), -arm * cos(start), 0.0, r);
  make_drum(&m, R, &rest);
  m.options.gravity[1] = -g;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  double before = arm * sin(start), crossing[3];
  for (int found = 0; found < 3;) {
    check_ok(cdem_dem_step(&dem, &fault));
    cdem_dem_look(&dem, &(cdem_dem_view){.xyz = x});
    if (x[0] * before < 0.0)
      crossing[found++] = dem.time - dem.step * x[0] / (x[0] - before);
    before = x[0];
    assert_true(dem.time < 2.0);
  }
  /* the period of a pendulum of this amplitude is longer by a^2/16 */
  double w = sqrt(g / ((R - r) * 1.5)), period = 2.0 * M_PI / w * (1.0 + start * start / 16.0);
  check_near(crossing[2] - crossing[0], period, 1e-3, 0.0);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* A drum that turns takes a disc along until their surfaces run alike: w R = w_disc r. */
static void a_drum_takes_a_disc_along(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  model m;
  const double r = 0.01, R = 0.05, g = 9.81;
  double rate = 2.0, c = 10.0, x[3], w[3];
  model_init(&m, 2, "linear");
  model_word(&m, CDEM_LAW_friction, 0.5);
  model_word(&m, CDEM_LAW_restitution, 0.5);
  model_word(&m, CDEM_LAW_normal_stiffness, 1e6);
  model_add(&m, 0.0, r - R, 0.0, r);
  make_drum(&m, R, &rate);
  m.options.gravity[1] = -g;
  m.options.mass_damping = c; /* ends the swinging about the bottom */
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  while (dem.time < 2.5)
    check_ok(cdem_dem_steps(&dem, 1000, &fault));
  cdem_dem_look(&dem, &(cdem_dem_view){.xyz = x, .spin = w});
  /* Mass damping also holds the spin back, with a moment c I w that friction gives at the arm r -
   * d, so that the disc stands where its weight gives it that friction: m g sin(a) = c I w/(r - d).
   * The surfaces run alike all the same. */
  double depth = 2500.0 * M_PI * r * r * g / 1e6;
  check_near(w[2] * (r - depth), rate * R, 1e-5, 0.0);
  check_near(x[0] / sqrt(x[0] * x[0] + x[1] * x[1]), c * 0.5 * r * r * w[2] / (g * (r - depth)),
             1e-3, 0.0);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* ---- servo ---- */

static void a_plate_presses_a_column_with_its_force(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_dem dem = {0};
  model m;
  const double r = 0.01;
  double wanted = 20.0;
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_restitution, 0.2);
  for (int k = 0; k < 4; k++)
    model_add(&m, 0.0, 0.0, r + 2.0 * r * k, r);
  model_plane(&m, 0, 0, 0, 0, 0, 1);
  m.wall[m.options.walls++] = (cdem_wall){.name = "lid",
                                          .shape = CDEM_WALL_PLATE,
                                          .center = {0, 0, 8.2 * r},
                                          .normal = {0, 0, 1},
                                          .axis = {1, 0, 0},
                                          .half = {r, r},
                                          .servo = {0, 0, 1},
                                          .servo_speed = 0.05,
                                          .servo_force = constant(&wanted)};
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  cdem_dem_wall now;
  for (int k = 0; k < 2; k++) {
    check_ok(cdem_dem_steps(&dem, 30000, &fault));
    cdem_dem_wall_now(&dem, 1, &now);
    check_near(now.force[2], wanted, 1e-5, 0.0);
    check_below(fabs(now.velocity[2]), 1e-6);
    cdem_dem_wall_now(&dem, 0, &now);
    check_near(now.force[2], -wanted, 1e-4, 0.0);
    wanted = 5.0; /* the series is borrowed: another phase */
  }
  cdem_dem_release(&dem);
  model_release(&m);
}

/* ---- meshes in motion ---- */

/* A box of twelve triangles about the origin that tumbles with grains in it. */
static void make_tumbler(cdem_wall *wall, double half, double *rate) {
  static double corner[24];
  static const int32_t facet[36] = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                    2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5};
  for (int k = 0; k < 8; k++)
    for (int c = 0; c < 3; c++)
      corner[3 * k + c] = k >> c & 1 ? half : -half;
  *wall = (cdem_wall){.name = "tumbler",
                      .shape = CDEM_WALL_MESH,
                      .corners = 8,
                      .corner = corner,
                      .facets = 12,
                      .facet = facet};
  for (int c = 0; c < 3; c++)
    wall->spin[c] = constant(rate + c);
}

static void tumbler_model(model *m, double *rate, int threads) {
  model_init(m, 3, "linear");
  model_word(m, CDEM_LAW_friction, 0.5);
  model_word(m, CDEM_LAW_restitution, 0.4);
  model_heap(m, 6, 2.0, 0.3, 5);
  for (int64_t k = 0; k < m->grains.grains; k++)
    for (int c = 0; c < 3; c++)
      m->grains.xyz[3 * k + c] -= 2.5 * 0.019;
  make_tumbler(&m->wall[m->options.walls++], 0.08, rate);
  m->options.gravity[2] = -9.81;
  m->options.threads = threads;
}

/* Places after `steps`, with a restart after `half` steps (0: none). */
static void tumble(int threads, int64_t half, int64_t steps, double x[3 * 216], double *time) {
  cdem_fault fault = {0};
  double rate[3] = {6.0, 9.0, 3.0};
  cdem_dem dem = {0}, first = {0};
  cdem_state saved = {0};
  model m;
  tumbler_model(&m, rate, threads);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  if (half > 0) {
    check_ok(cdem_dem_init(&m.options, &first, &fault));
    check_ok(cdem_dem_steps(&first, half, &fault));
    check_ok(cdem_dem_save(&first, &saved, &fault));
    check_ok(cdem_dem_restore(&dem, &saved, &fault));
    cdem_state_release(&saved);
    cdem_dem_release(&first);
  }
  check_ok(cdem_dem_steps(&dem, steps - half, &fault));
  cdem_dem_look(&dem, &(cdem_dem_view){.xyz = x});
  *time = dem.time;
  cdem_dem_release(&dem);
  model_release(&m);
}

static void a_tumbling_box_keeps_its_grains(void **state) {
  (void)state;
  enum { STEPS = 1500 };
  static double one[3 * 216], other[3 * 216];
  const double rate = sqrt(36.0 + 81.0 + 9.0), axis[3] = {6.0 / rate, 9.0 / rate, 3.0 / rate};
  double time;
  tumble(1, 0, STEPS, one, &time);
  tumble(2, 0, STEPS, other, &time);
  assert_memory_equal(one, other, sizeof one);
  tumble(1, 700, STEPS, other, &time);
  assert_memory_equal(one, other, sizeof one);
  double angle = time * rate;
  for (int k = 0; k < 216; k++) { /* turned back into the frame of the box */
    const double *p = one + 3 * k;
    double cross[3], along = cdem_dot3(axis, p);
    cdem_cross3(p, axis, cross);
    for (int c = 0; c < 3; c++)
      check_below(
          fabs(p[c] * cos(angle) + cross[c] * sin(angle) + axis[c] * along * (1 - cos(angle))),
          0.08);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_sphere_rolls_down_a_plane_and_a_mesh_alike),
      cmocka_unit_test(walls_feel_what_grains_lose),
      cmocka_unit_test(a_box_weighs_its_grains),
      cmocka_unit_test(a_disc_swings_in_a_drum),
      cmocka_unit_test(a_drum_takes_a_disc_along),
      cmocka_unit_test(a_plate_presses_a_column_with_its_force),
      cmocka_unit_test(a_tumbling_box_keeps_its_grains),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
