/* Rolling and twisting resistance against closed forms, and springs that turn with their contact.
 */
#include "law_support.h"

static const double g = 9.81, kn = 1e5;

/* A grain at rest on a plane, pressed by gravity; half a step before, its velocity is there. */
static void lay(two_body *t, int dim, const char *rolling, const char *twisting, double friction) {
  cdem_contact_input input = no_input();
  cdem_contact_model model;
  input.value[CDEM_LAW_normal_stiffness] = kn;
  input.value[CDEM_LAW_restitution] = 0.3;
  input.value[CDEM_LAW_friction] = 0.6;
  input.value[rolling[0] != 'n' ? CDEM_LAW_rolling_friction : CDEM_LAW_twisting_friction] =
      friction;
  make_model(dim, cdem_law_find("linear"), cdem_rolling_find(rolling), cdem_twisting_find(twisting),
             &input, &model);
  two_body_init(t, dim, true, &model, 0.01, 0.0, 2500.0);
  t->step = 0.05 * sqrt(t->mass[0] / kn);
  t->gravity[dim - 1] = -g;
  t->x[0][dim - 1] = t->radius[0] - t->mass[0] * g / kn;
  t->v[0][dim - 1] = 0.5 * g * t->step;
}

static void roll(two_body *t, double speed) {
  t->v[0][0] = speed;
  t->w[0][t->dim == 2 ? 2 : 1] = (t->dim == 2 ? -speed : speed) / t->radius[0];
}

/* Moment mu R m g stops what rolls after (1 + beta) v^2/(2 mu g), beta = I/m r^2; arms are shorter
 * than the radius by the overlap, 1e-4 to 1e-2 of it. */
static void rolling_stops_after_the_way_of_its_energy(void **state) {
  (void)state;
  static const char *const kinds[] = {"constant", "spring"};
  for (int dim = 2; dim <= 3; dim++)
    for (int kind = 0; kind < 2; kind++) {
      two_body t;
      double mu = 0.05, speed = 0.05, beta = dim == 2 ? 0.5 : 0.4;
      lay(&t, dim, kinds[kind], "none", mu);
      roll(&t, speed);
      double way = (1.0 + beta) * speed * speed / (2.0 * mu * g);
      double until = 1.6 * 2.0 * way / speed, furthest = 0.0;
      while (t.time < until) {
        two_body_step(&t);
        furthest = fmax(furthest, t.x[0][0]);
      }
      double shallow = t.mass[0] * g / kn / t.radius[0];
      /* the spring stretches first, by cap/k, and pays for it with a longer way */
      double stretch =
          kind == 0 ? 0.0 : mu * t.mass[0] * g / (kn * (dim == 2 ? 1.0 / 3.0 : 2.0 / 7.0));
      check_near(furthest, way + 0.5 * stretch, 2.0 * shallow + 2e-3, 0.0);
      check_below(fabs(t.v[0][0]), kind == 0 ? 2e-3 * speed : 0.02 * speed);
    }
}

/* The constant moment is its cap, or what stops the slowest grain of this mass and radius at once.
 */
static void constant_moment_does_not_turn_rolling_around(void **state) {
  (void)state;
  cdem_random random = {31};
  static cdem_batch b;
  for (int dim = 2; dim <= 3; dim++) {
    const cdem_law *law = cdem_law_find("linear");
    const cdem_resistance *constant = cdem_rolling_find("constant");
    cdem_contact_input input = typical(law, constant, cdem_twisting_at(0));
    cdem_contact_model model;
    make_model(dim, law, constant, NULL, &input, &model);
    random_batch(&random, dim, &model, 40, &b);
    int stopped = 0;
    for (int i = 0; i < 40; i++)
      for (int k = 0; k < 3 && i % 2; k++)
        b.spin[k][i] *= 1e-6;
    evaluate(dim, &model, false, false, &b);
    for (int i = 0; i < 40; i++) {
      double n[3] = {b.n[0][i], b.n[1][i], b.n[2][i]}, w[3] = {0}, moment = 0.0;
      for (int k = 0; k < (dim == 2 ? 1 : 3); k++) {
        w[k] = b.spin[k][i];
        moment += b.moment[k][i] * b.moment[k][i];
      }
      double about = dim == 3 ? cdem_dot3(w, n) : 0.0;
      for (int k = 0; k < dim; k++)
        w[k] -= about * n[k];
      double cap = (0.1 * b.radius[i] + 2e-4) * b.normal[i];
      double stop =
          (dim == 2 ? 0.5 : 0.4) * b.mass[i] * b.radius[i] * b.radius[i] * cdem_norm3(w) / b.step;
      check_near(sqrt(moment), fmin(cap, stop), 1e-12, 0.0);
      stopped += stop < cap;
    }
    assert_true(stopped > 5 && stopped < 38);
  }
}

/* On a slope a grain stays where tan(theta) < mu_r (spring), else its acceleration is
 * g (sin(theta) - mu_r cos(theta))/(1 + beta); without resistance g sin(theta)/(1 + beta). */
static double slope_speed(int dim, const char *rolling, double mu, double angle, double until) {
  two_body t;
  lay(&t, dim, rolling, "none", mu);
  t.gravity[0] = g * sin(angle);
  t.gravity[dim - 1] = -g * cos(angle);
  while (t.time < until)
    two_body_step(&t);
  return t.v[0][0];
}

static void slopes_hold_or_accelerate_as_they_should(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    double mu = 0.1, beta = dim == 2 ? 0.5 : 0.4, until = 0.3, steep = atan(0.25);
    double a = g * sin(steep) / (1.0 + beta), b = a - mu * g * cos(steep) / (1.0 + beta);
    check_near(slope_speed(dim, "constant", 0.0, steep, until), a * until, 2e-2, 0.0);
    check_near(slope_speed(dim, "spring", mu, steep, until), b * until, 2e-2, 0.0);
    check_near(slope_speed(dim, "constant", mu, steep, until), b * until, 2e-2, 0.0);
    check_below(fabs(slope_speed(dim, "spring", mu, atan(0.95 * mu), until)), 2e-3 * b * until);
    assert_true(slope_speed(dim, "spring", mu, atan(1.1 * mu), until) > 1e-2 * b * until);
  }
}

/* A sphere spinning about the vertical: I w/(mu r m g). */
static void twisting_stops_in_the_time_of_its_moment(void **state) {
  (void)state;
  two_body t;
  double mu = 0.05, spin = 20.0;
  lay(&t, 3, "none", "spring", mu);
  t.w[0][2] = spin;
  double stops = t.inertia[0] * spin / (mu * t.radius[0] * t.mass[0] * g), at = 0.0;
  while (t.time < 1.5 * stops) {
    two_body_step(&t);
    if (at == 0.0 && t.w[0][2] <= 0.0)
      at = t.time;
  }
  check_near(at, stops, 1e-2, 0.0);
  check_below(fabs(t.w[0][2]), 0.02 * spin);
  check_near(t.x[0][0], 0.0, 0.0, 1e-15);
}

/* Two grains with springs stretched turn as one body about any axis, n included: no spring changes
 * but by turning along. What is left is of second order in the step. */
static double turned_error(const cdem_contact_model *m, const double axis[3], int steps) {
  static cdem_batch b;
  double n[3] = {0.6, -0.48, 0.64}, force[3] = {0.8, 0.36, -0.48}, worst = 0.0;
  double start[2][3], arm = 0.01, angle = 1.5;
  memset(&b, 0, sizeof b);
  b.count = 1;
  b.step = angle / steps; /* spin 1 */
  b.overlap[0] = 1e-5;
  b.radius[0] = 5e-3;
  b.mass[0] = 1e-2;
  b.arm[0][0] = 1.3 * arm;
  b.arm[1][0] = arm;
  double along = cdem_dot3(force, n);
  for (int k = 0; k < 3; k++)
    start[0][k] = start[1][k] = 0.01 * (force[k] - along * n[k]);
  for (int k = 0; k < 3; k++) {
    b.history[k][0] = start[0][k];
    b.history[m->first[1] + k][0] = 1e-4 * start[1][k];
  }
  if (m->first[1] == 4)
    b.history[3][0] = m->law == cdem_law_find("penalty") ? 1e-5               /* the overlap */
                                                         : sqrt(5e-3 * 1e-5); /* contact radius */
  for (int i = 1; i <= steps; i++) {
    double a = angle * i / steps, c = cos(a), s = sin(a), across[3], now[3], dn[3];
    double on = cdem_dot3(axis, n);
    cdem_cross3(axis, n, across);
    for (int k = 0; k < 3; k++)
      now[k] = c * n[k] + s * across[k] + (1.0 - c) * on * axis[k];
    cdem_cross3(axis, now, dn);
    for (int k = 0; k < 3; k++) {
      b.n[k][0] = now[k];
      b.velocity[k][0] = 2.3 * arm * dn[k];
      b.turning[k][0] = 2.3 * arm * axis[k];
    }
    evaluate(3, m, true, false, &b);
    for (int h = 0; h < 2; h++) {
      cdem_cross3(axis, start[h], across);
      on = cdem_dot3(axis, start[h]);
      for (int k = 0; k < 3; k++) {
        double ideal = c * start[h][k] + s * across[k] + (1.0 - c) * on * axis[k];
        double is = b.history[m->first[h] + k][0] * (h ? 1e4 : 1.0);
        worst = fmax(worst, fabs(is - ideal) / cdem_norm3(start[h]));
      }
    }
    check_below(b.slid[0] + b.rolled[0] + b.damped[0], 1e-12);
  }
  return worst;
}

static void springs_turn_with_the_pair(void **state) {
  (void)state;
  static const double axes[3][3] = {{0.6, -0.48, 0.64}, {0.0, 0.8, 0.6}, {0.48, 0.6, -0.64}};
  for (int l = 0; cdem_law_at(l) != NULL; l++) {
    const cdem_law *law = cdem_law_at(l);
    if (!law->dims[3])
      continue;
    cdem_contact_input input = typical(law, cdem_rolling_find("spring"), cdem_twisting_at(0));
    cdem_contact_model model;
    make_model(3, law, cdem_rolling_find("spring"), NULL, &input, &model);
    for (int a = 0; a < 3; a++) {
      double coarse = turned_error(&model, axes[a], 100), fine = turned_error(&model, axes[a], 400);
      check_below(coarse, 1e-3);
      check_below(fine, coarse / 12.0 + 1e-8 /* rounding of the slip times k */);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rolling_stops_after_the_way_of_its_energy),
      cmocka_unit_test(constant_moment_does_not_turn_rolling_around),
      cmocka_unit_test(slopes_hold_or_accelerate_as_they_should),
      cmocka_unit_test(twisting_stops_in_the_time_of_its_moment),
      cmocka_unit_test(springs_turn_with_the_pair),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
