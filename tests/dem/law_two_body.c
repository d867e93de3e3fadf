/* Two grains, or a grain and a plane, against closed forms. */
#include "dem/law_damping.h"
#include "law_support.h"

static cdem_contact_model linear_model(int dim, double kn, double restitution, double friction) {
  cdem_contact_model model;
  cdem_contact_input input = no_input();
  input.value[CDEM_LAW_normal_stiffness] = kn;
  input.value[CDEM_LAW_restitution] = restitution;
  input.value[CDEM_LAW_friction] = friction;
  make_model(dim, cdem_law_find("linear"), NULL, NULL, &input, &model);
  return model;
}

static cdem_contact_model hertz_model(const cdem_grain_material *a, const cdem_grain_material *b,
                                      double restitution, double friction) {
  cdem_contact_model model;
  cdem_fault fault = {0};
  cdem_contact_input input = no_input();
  input.value[CDEM_LAW_restitution] = restitution;
  input.value[CDEM_LAW_friction] = friction;
  check_ok(
      cdem_contact_model_init(3, cdem_law_find("hertz"), NULL, NULL, &input, a, b, &model, &fault));
  return model;
}

/* Half steps: positions touch exactly at t = 0 with velocity v. */
static void head_on(two_body *t, double speed, double step) {
  int axis = t->wall ? t->dim - 1 : 0;
  t->step = step;
  t->x[0][axis] = t->wall ? t->radius[0] : 0.0;
  t->v[0][axis] = t->wall ? -speed : 0.5 * speed;
  if (!t->wall) {
    t->x[1][0] = t->radius[0] + t->radius[1];
    t->v[1][0] = -0.5 * speed;
  }
}

static double restitution_of(two_body *t, double speed, double step) {
  head_on(t, speed, step);
  two_body_collide(t, 10000000);
  return t->wall ? t->v[0][t->dim - 1] / speed : (t->v[1][0] - t->v[0][0]) / speed;
}

static void damping_inverts_restitution(void **state) {
  (void)state;
  /* against the published solution (Schwager & Poeschel 2007, eq. 21), with beta = c/2m, w0^2 =
   * k/m, here w0 = 1: e = exp(-beta/w (pi - atan(2 beta w/(w^2 - beta^2)))) for beta < w0/sqrt(2)
   */
  for (double zeta = 0.05; zeta < 0.7; zeta += 0.05) {
    double w = sqrt(1.0 - zeta * zeta);
    check_near(cdem_law_restitution(zeta),
               exp(-zeta / w * (M_PI - atan(2.0 * zeta * w / (w * w - zeta * zeta)))), 1e-14, 0.0);
  }
  check_near(cdem_law_restitution(1.0), exp(-2.0), 1e-14, 0.0);
  check_near(cdem_law_restitution(1.0 - 1e-7), cdem_law_restitution(1.0 + 1e-7), 1e-6, 0.0);
  /* overdamped, its own closed form: e = ((z + s)/(z - s))^(-z/s), s = sqrt(z^2 - 1) */
  double s = sqrt(3.0);
  check_near(cdem_law_restitution(2.0), pow((2.0 + s) / (2.0 - s), -2.0 / s), 1e-14, 0.0);
  for (double e = 1e-3; e < 1.0; e += 0.037)
    check_near(cdem_law_restitution(cdem_law_damping_for(e)), e, 1e-13, 0.0);
  assert_true(cdem_law_damping_for(1.0) == 0.0);
}

/* The dashpot lags by half a step, so e is off by order dt; extrapolated, by order dt^2. */
static void restitution_comes_out_as_asked(void **state) {
  (void)state;
  static const double wanted[] = {0.05, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0};
  cdem_grain_material oxide = {"aluminium oxide", 4000.0, 380e9, 0.23};
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
    for (int kind = 0; kind < 3; kind++) {
      cdem_contact_model model = kind == 2 ? hertz_model(&oxide, &oxide, wanted[i], 0.0)
                                           : linear_model(2 + kind, 1e6, wanted[i], 0.3);
      double e[2];
      for (int fine = 0; fine < 2; fine++) {
        two_body t;
        two_body_init(&t, kind == 0 ? 2 : 3, kind == 1, &model, 2.5e-3, 4e-3, 4000.0);
        double mass = t.wall ? t.mass[0] : t.mass[0] * t.mass[1] / (t.mass[0] + t.mass[1]);
        double period = kind == 2 ? 7e-6 : sqrt(mass / 1e6);
        e[fine] = restitution_of(&t, 3.9, period * (fine ? 5e-4 : 1e-3));
      }
      check_near(2.0 * e[1] - e[0], wanted[i], 5e-5, 1e-5);
      check_near(e[1], wanted[i], 1e-3, 2e-4);
    }
}

static void hertz_restitution_does_not_depend_on_velocity(void **state) {
  (void)state;
  cdem_contact_model model = hertz_model(&glass, &glass, 0.5, 0.0);
  double e[2];
  for (int i = 0; i < 2; i++) {
    two_body t;
    double speed = i ? 10.0 : 0.1; /* duration as v^(-1/5) */
    two_body_init(&t, 3, false, &model, 0.01, 0.01, 2800.0);
    e[i] = restitution_of(&t, speed, 1e-8 * pow(speed, -0.2));
  }
  check_near(e[0], e[1], 1e-5, 0.0);
}

/* Damped oscillator: F = 0 at w t = atan2(2 zeta s, 2 zeta^2 - 1), s = sqrt(1 - zeta^2). */
static void linear_contact_lasts_and_pushes_as_an_oscillator(void **state) {
  (void)state;
  cdem_contact_model model;
  cdem_contact_input input = no_input();
  double kn = 1e6, zeta = 0.3, speed = 0.2;
  input.value[CDEM_LAW_normal_stiffness] = kn;
  input.value[CDEM_LAW_damping_ratio] = zeta;
  make_model(3, cdem_law_find("linear"), NULL, NULL, &input, &model);
  two_body t;
  two_body_init(&t, 3, false, &model, 0.01, 0.01, 2500.0);
  double m = 0.5 * t.mass[0], w0 = sqrt(kn / m), s = sqrt(1.0 - zeta * zeta), w = w0 * s;
  double until = atan2(2.0 * zeta * s, 2.0 * zeta * zeta - 1.0) / w;
  head_on(&t, speed, until / 20000.0);
  double largest = 0.0, last = 0.0, deepest = 0.0;
  for (int i = 0; i < 30000; i++) {
    two_body_step(&t);
    largest = fmax(largest, t.force[0] < 0.0 ? -t.force[0] : 0.0);
    deepest = fmax(deepest, t.overlap);
    if (t.force[0] < 0.0)
      last = t.time - t.step;
  }
  check_near(last, until, 2e-4, 0.0);
  /* overlap v/w exp(-zeta w0 t) sin wt is largest at tan wt = w/(zeta w0) */
  double top = atan2(s, zeta) / w;
  check_near(deepest, speed / w * exp(-zeta * w0 * top) * sin(w * top), 2e-4, 0.0);
  /* force m times deceleration, largest where its rate vanishes: tan wt = s(1-4 zeta^2)/(zeta(3-4
   * zeta^2)) */
  double at = atan2(s * (1.0 - 4.0 * zeta * zeta), zeta * (3.0 - 4.0 * zeta * zeta)) / w;
  double force = speed * exp(-zeta * w0 * at) *
                 (kn / w * sin(w * at) +
                  2.0 * zeta * sqrt(kn * m) * (cos(w * at) - zeta * w0 / w * sin(w * at)));
  check_near(largest, force, 2e-4, 0.0);
}

typedef struct {
  cdem_grain_material material;
  bool wall;
  double radius, speed, force, overlap, duration;
} hertz_case;

/* Chung & Ooi (2011), tests 1 and 2: Hertz. Here the closed forms themselves are the reference, F =
 * K (5 m v^2/4K)^(3/5), d = (5 m v^2/4K)^(2/5), 2.9432 d/v; the published digits agree to 1e-5. */
static void hertz_impacts_of_chung_and_ooi(void **state) {
  (void)state;
  static const hertz_case cases[] = {
      {{"glass", 2800, 48e9, 0.20}, false, 0.01, 20.0, 10696.9, 274.11e-6, 40.34e-6},
      {{"limestone", 2500, 20e9, 0.25}, false, 0.01, 20.0, 7108.2, 368.30e-6, 54.20e-6},
      {{"aluminium", 2699, 70e9, 0.30}, true, 0.1, 0.2, 11369.9, 49.72e-6, 731.7e-6},
      {{"magnesium", 1800, 40e9, 0.35}, true, 0.1, 0.2, 7232.7, 52.12e-6, 767.1e-6}};
  cdem_grain_material rigid = {"rigid", 1.0, INFINITY, 0.0};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const hertz_case *c = &cases[i];
    cdem_contact_model model = hertz_model(&c->material, c->wall ? &rigid : &c->material, 1.0, 0.3);
    two_body t;
    two_body_init(&t, 3, c->wall, &model, c->radius, c->radius, c->material.density);
    double soft = (c->wall ? 1.0 : 2.0) * (1.0 - c->material.poisson * c->material.poisson) /
                  c->material.young;
    double m = c->wall ? t.mass[0] : 0.5 * t.mass[0], r = c->wall ? c->radius : 0.5 * c->radius;
    double k = 4.0 / 3.0 / soft * sqrt(r), depth = pow(1.25 * m * c->speed * c->speed / k, 0.4);
    double lasts = 2.943275 * depth / c->speed;
    double largest = 0.0, deepest = 0.0;
    head_on(&t, c->speed, c->duration / 20000.0);
    int64_t steps = 0;
    do {
      two_body_step(&t);
      largest = fmax(largest, cdem_norm3(t.force));
      deepest = fmax(deepest, t.overlap);
    } while ((t.touching || t.time < 0.1 * lasts) && ++steps < 100000);
    check_near(largest, k * pow(depth, 1.5), 1e-6, 0.0);
    check_near(deepest, depth, 1e-6, 0.0);
    check_near((double)steps * t.step, lasts, 2e-4, 0.0);
    check_near(largest, c->force, 1e-5, 0.0);
    check_near(deepest, c->overlap, 1.1e-4, 0.0); /* four digits */
    check_near(lasts, c->duration, 2e-4, 0.0);
  }
}

/* Thrown along a plane without spin, a sphere ends with 5/7 of its speed, a disc with 2/3, whatever
 * the friction: angular momentum about the plane. */
static void sliding_turns_into_rolling(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    cdem_contact_model model = linear_model(dim, 1e5, 0.3, 0.4);
    two_body t;
    two_body_init(&t, dim, true, &model, 0.01, 0.0, 2500.0);
    t.gravity[dim - 1] = -9.81;
    t.step = 0.03 * sqrt(t.mass[0] / 1e5);
    t.x[0][dim - 1] = t.radius[0] - t.mass[0] * 9.81 / 1e5;
    t.v[0][0] = 0.2;
    t.v[0][dim - 1] = 0.5 * 9.81 * t.step; /* half a step before rest */
    double stop = 2.0 * 0.2 / (0.4 * 9.81 * (dim == 2 ? 3.0 : 3.5));
    while (t.time < stop)
      two_body_step(&t);
    /* arms are r less the overlap, so to the overlap by the radius, 1e-4 */
    double shallow = t.mass[0] * 9.81 / 1e5 / t.radius[0];
    check_near(t.v[0][0], 0.2 * (dim == 2 ? 2.0 / 3.0 : 5.0 / 7.0), 2.0 * shallow, 0.0);
    double spin = dim == 2 ? -t.w[0][2] : t.w[0][1];
    check_near(spin * t.radius[0], t.v[0][0], 2.0 * shallow, 0.0);
  }
}

static void glance(two_body *t, double step) {
  t->step = step;
  t->x[1][0] = t->radius[0] + t->radius[1];
  t->v[0][0] = 0.6;
  t->v[1][1] = 0.5;
  t->w[0][2] = 30.0;
  t->w[1][2] = -12.0;
  if (t->dim == 3) {
    t->v[0][2] = -0.2;
    t->w[0][0] = 20.0;
    t->w[1][1] = 15.0;
  }
}

static void momentum_of(const two_body *t, double linear[3], double angular[3]) {
  for (int k = 0; k < 3; k++)
    linear[k] = angular[k] = 0.0;
  for (int g = 0; g < 2; g++) {
    double x[3], turned[3];
    /* at the half step the place is half a step back */
    for (int k = 0; k < 3; k++)
      x[k] = t->x[g][k] - 0.5 * t->step * t->v[g][k];
    cdem_cross3(x, t->v[g], turned);
    for (int k = 0; k < 3; k++) {
      linear[k] += t->mass[g] * t->v[g][k];
      angular[k] += t->mass[g] * turned[k] + t->inertia[g] * t->w[g][k];
    }
  }
}

static void momentum_is_kept(void **state) {
  (void)state;
  for (int l = 0; cdem_law_at(l) != NULL; l++)
    for (int dim = 2; dim <= 3; dim++)
      for (int printed = 0; printed < 2; printed++) {
        const cdem_law *law = cdem_law_at(l);
        if (!law->dims[dim] || (printed && !law->rolls))
          continue;
        cdem_contact_input input = typical(law, cdem_rolling_at(0), cdem_twisting_at(0));
        if (law->rolls)
          input.value[CDEM_LAW_arms_by_radius] = printed;
        cdem_contact_model model;
        make_model(dim, law, NULL, NULL, &input, &model);
        two_body t;
        two_body_init(&t, dim, false, &model, 0.01, 0.007, 2500.0);
        glance(&t, 1e-6);
        double linear[2][3], angular[2][3], change[3], spun[3];
        momentum_of(&t, linear[0], angular[0]);
        two_body_collide(&t, 100000);
        momentum_of(&t, linear[1], angular[1]);
        for (int k = 0; k < 3; k++) {
          check_near(linear[1][k], linear[0][k], 1e-12, 1e-12 * t.mass[0]);
          change[k] = angular[1][k] - angular[0][k];
          spun[k] = t.inertia[0] * 30.0;
        }
        double loss = cdem_norm3(change) / fabs(spun[2]);
        if (printed) /* the known violation: arms longer than the distance, by overlap/(rA + rB) */
          assert_true(loss > 1e-4 && loss < 0.1);
        else
          check_below(loss, 1e-11);
      }
}

/* Kinetic, stored and dissipated energy make one sum; what is left falls as dt^2. */
static void energy_book_closes_to_second_order(void **state) {
  (void)state;
  for (int l = 0; cdem_law_at(l) != NULL; l++)
    for (int dim = 2; dim <= 3; dim++)
      for (int r = 0; cdem_rolling_at(r) != NULL; r++) {
        const cdem_law *law = cdem_law_at(l);
        const cdem_resistance *twisting = cdem_twisting_at(dim == 3 && r > 0);
        if (!law->dims[dim] || (law->rolls && r > 0))
          continue;
        cdem_contact_input input = typical(law, cdem_rolling_at(r), twisting);
        cdem_contact_model model;
        make_model(dim, law, cdem_rolling_at(r), twisting, &input, &model);
        double worst[2] = {0.0, 0.0};
        for (int fine = 0; fine < 2; fine++) {
          two_body t;
          two_body_init(&t, dim, false, &model, 0.01, 0.007, 2500.0);
          double m = t.mass[0] * t.mass[1] / (t.mass[0] + t.mass[1]);
          double duration = strcmp(law->name, "hertz") == 0 ? 6e-5 : M_PI * sqrt(m / 1e6);
          glance(&t, duration / (fine ? 800.0 : 100.0));
          two_body_step(&t);
          double first = t.kinetic;
          for (int i = 0; i < (fine ? 1600 : 200); i++) {
            two_body_step(&t);
            /* half of the last step's damping lies ahead of t_n */
            double ahead = 0.5 * (t.batch.damped[0] + t.batch.circulated[0]) * t.touching;
            if (strcmp(model.rolling->name, "constant") == 0)
              ahead += 0.5 * t.batch.rolled[0] * t.touching;
            double error = fabs(t.kinetic + t.stored + t.lost - ahead - first) / first;
            worst[fine] = fmax(worst[fine], error);
          }
          assert_false(t.touching);
          assert_true(t.lost > 0.01 * first);
        }
        if (getenv("LAW_TALK"))
          printf("%s %d %s: %.2e %.2e\n", law->name, dim, cdem_rolling_at(r)->name, worst[0],
                 worst[1]);
        /* eight times finer: 64 at second order, but for a constant moment against rolling that
         * has stopped, which jumps from step to step */
        bool jumps = strcmp(model.rolling->name, "constant") == 0;
        check_below(worst[1], worst[0] / (jumps ? 3.0 : 24.0));
        check_below(worst[1], 1e-4);
      }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damping_inverts_restitution),
      cmocka_unit_test(restitution_comes_out_as_asked),
      cmocka_unit_test(hertz_restitution_does_not_depend_on_velocity),
      cmocka_unit_test(linear_contact_lasts_and_pushes_as_an_oscillator),
      cmocka_unit_test(hertz_impacts_of_chung_and_ooi),
      cmocka_unit_test(sliding_turns_into_rolling),
      cmocka_unit_test(momentum_is_kept),
      cmocka_unit_test(energy_book_closes_to_second_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
