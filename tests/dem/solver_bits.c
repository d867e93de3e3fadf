/* The same to the bit: threads, numbering, restart, scaling. And the batches against the plain
 * reference. */
#include "solver_model.h"

enum { STEPS = 150 };

static void lossy(model *m, int dim, const char *law) {
  model_init(m, dim, law);
  model_word(m, CDEM_LAW_friction, 0.4);
  if (strcmp(law, "li-chu") != 0) {
    model_word(m, CDEM_LAW_restitution, 0.7);
    return;
  }
  model_word(m, CDEM_LAW_rolling_force_stiffness, 1e3);
  model_word(m, CDEM_LAW_rolling_force_friction, 0.05);
}

static void heap(model *m, int dim, const char *law, int side) {
  lossy(m, dim, law);
  model_heap(m, side, 3.0, 0.05, 5);
  model_box(m, side);
  m->options.gravity[1] = -9.81;
}

typedef struct {
  double *xyz, *velocity, *spin, *force, *moment;
} seen;

static seen look(const cdem_dem *dem) {
  size_t bytes = (size_t)dem->grains * 3 * sizeof(double);
  seen s = {malloc(bytes), malloc(bytes), malloc(bytes), malloc(bytes), malloc(bytes)};
  assert_true(s.xyz && s.velocity && s.spin && s.force && s.moment);
  cdem_dem_look(dem, &(cdem_dem_view){.xyz = s.xyz,
                                      .velocity = s.velocity,
                                      .spin = s.spin,
                                      .force = s.force,
                                      .moment = s.moment});
  return s;
}

static void forget(seen *s) {
  free(s->xyz);
  free(s->velocity);
  free(s->spin);
  free(s->force);
  free(s->moment);
}

/* a[i] times factors = b[order ? order[i] : i], bit by bit. */
static void check_same(const seen *a, const seen *b, int64_t grains, const int64_t *order,
                       const double factor[5]) {
  const double *from[] = {a->xyz, a->velocity, a->spin, a->force, a->moment};
  const double *to[] = {b->xyz, b->velocity, b->spin, b->force, b->moment};
  for (int k = 0; k < 5; k++)
    for (int64_t i = 0; i < 3 * grains; i++) {
      int64_t j = order != NULL ? 3 * order[i / 3] + i % 3 : i;
      if (from[k][i] * (factor != NULL ? factor[k] : 1.0) != to[k][j])
        fail_msg("quantity %d of grain %lld: %.17g and %.17g", k, (long long)(i / 3), from[k][i],
                 to[k][j]);
    }
}

static seen run(model *m, int64_t steps) {
  cdem_dem dem;
  cdem_fault fault = {0};
  check_ok(cdem_dem_init(&m->options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, steps, &fault));
  seen s = look(&dem);
  cdem_dem_release(&dem);
  return s;
}

static void test_threads(void **state) {
  (void)state;
  model m;
  heap(&m, 3, "linear", 9); /* 729 grains: chunks enough for a team */
  seen one = run(&m, 60);
  for (int threads = 2; threads <= 4; threads += 2) {
    m.options.threads = threads;
    seen many = run(&m, 60);
    check_same(&one, &many, m.grains.grains, NULL, NULL);
    forget(&many);
  }
  forget(&one);
  model_release(&m);
}

static void test_numbering(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    model m, other;
    heap(&m, dim, dim == 2 ? "linear" : "hertz", dim == 2 ? 8 : 4);
    heap(&other, dim, dim == 2 ? "linear" : "hertz", dim == 2 ? 8 : 4);
    int64_t n = m.grains.grains, order[64];
    for (int64_t i = 0; i < n; i++) {
      order[i] = (i * 27 + 5) % n; /* n is a power of two */
      memcpy(other.grains.xyz + 3 * order[i], m.grains.xyz + 3 * i, 3 * sizeof(double));
      memcpy(other.grains.velocity + 3 * order[i], m.grains.velocity + 3 * i, 3 * sizeof(double));
      memcpy(other.grains.spin + 3 * order[i], m.grains.spin + 3 * i, 3 * sizeof(double));
      other.grains.radius[order[i]] = m.grains.radius[i];
    }
    seen a = run(&m, STEPS), b = run(&other, STEPS);
    check_same(&a, &b, n, order, NULL);
    forget(&a);
    forget(&b);
    model_release(&m);
    model_release(&other);
  }
}

static void test_restart(void **state) {
  (void)state;
  static const char *const laws[] = {"linear", "hertz", "li-chu", "mindlin", "penalty"};
  for (int k = 0; k < 5; k++) {
    model m;
    cdem_dem dem, again;
    cdem_fault fault = {0};
    cdem_state saved = {0};
    heap(&m, k == 2 ? 2 : 3, laws[k], k == 2 ? 8 : 4);
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    check_ok(cdem_dem_steps(&dem, 77, &fault));
    check_ok(cdem_dem_init(&m.options, &again, &fault));
    check_ok(cdem_dem_save(&dem, &saved, &fault));
    check_ok(cdem_dem_restore(&again, &saved, &fault));
    check_ok(cdem_dem_steps(&dem, 400, &fault));
    check_ok(cdem_dem_steps(&again, 400, &fault));
    seen a = look(&dem), b = look(&again);
    check_same(&a, &b, m.grains.grains, NULL, NULL);
    cdem_dem_energies e, f;
    cdem_dem_energies_now(&dem, &e);
    cdem_dem_energies_now(&again, &f);
    assert_memory_equal(&e, &f, sizeof e);
    forget(&a);
    forget(&b);
    cdem_dem_release(&dem);
    cdem_dem_release(&again);
    cdem_state_release(&saved);
    model_release(&m);
  }
}

/* Lengths 4, times 2, masses 8: a stiffness is worth mass/time^2. */
static void test_scaling(void **state) {
  (void)state;
  const double length = 4.0, time = 2.0, mass = 8.0;
  static const char *const laws[] = {"linear", "hertz", "li-chu", "mindlin", "penalty"};
  for (int k = 0; k < 5; k++) {
    model m, large;
    int dim = k == 2 ? 2 : 3, side = k == 2 ? 8 : 4;
    heap(&m, dim, laws[k], side);
    heap(&large, dim, laws[k], side);
    for (int64_t i = 0; i < 3 * m.grains.grains; i++) {
      large.grains.xyz[i] *= length;
      large.grains.velocity[i] *= length / time;
      large.grains.spin[i] /= time;
      large.grains.radius[i / 3] *= i % 3 == 0 ? length : 1.0;
    }
    for (int w = 0; w < large.options.walls; w++)
      for (int c = 0; c < 3; c++)
        large.wall[w].center[c] *= length;
    large.options.gravity[1] *= length / (time * time);
    large.options.thickness = length;
    large.material[0].density *= mass / (length * length * length);
    large.material[0].young *= mass / (length * time * time);
    for (int w = 0; w < CDEM_LAW_KEYS; w++) {
      cdem_dimension d = cdem_law_key_get(w)->dimension;
      model_word(&large, w,
                 m.contact[0].value[w] * pow(length, d.length) * pow(time, d.time) *
                     pow(mass, d.mass));
    }
    seen a = run(&m, STEPS), b = run(&large, STEPS);
    double force = mass * length / (time * time);
    check_same(&a, &b, m.grains.grains, NULL,
               (double[5]){length, length / time, 1.0 / time, force, force * length});
    forget(&a);
    forget(&b);
    model_release(&m);
    model_release(&large);
  }
}

/* Batches against the plain reference: to rounding over some steps, in which rounding grows little.
 */
static void test_reference(void **state) {
  (void)state;
  static const char *const laws[] = {"linear", "hertz", "li-chu", "mindlin", "penalty"};
  for (int k = 0; k < 5; k++)
    for (int dim = 2; dim <= 3; dim++) {
      model m;
      if (!cdem_law_find(laws[k])->dims[dim])
        continue;
      heap(&m, dim, laws[k], dim == 2 ? 8 : 4);
      seen fast = run(&m, 20);
      m.options.reference = true;
      seen plain = run(&m, 20);
      const double *a[] = {fast.xyz, fast.velocity, fast.spin, fast.force, fast.moment};
      const double *b[] = {plain.xyz, plain.velocity, plain.spin, plain.force, plain.moment};
      for (int q = 0; q < 5; q++) {
        double largest = 0.0;
        for (int64_t i = 0; i < 3 * m.grains.grains; i++)
          largest = fmax(largest, fabs(b[q][i]));
        for (int64_t i = 0; i < 3 * m.grains.grains; i++)
          check_near(a[q][i], b[q][i], 0.0, 1e-11 * largest);
      }
      forget(&fast);
      forget(&plain);
      model_release(&m);
    }
}

/* Steps one by one and many at once are the same steps. */
static void test_steps(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  heap(&m, 3, "linear", 4);
  seen many = run(&m, 40);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  for (int n = 0; n < 40; n++)
    check_ok(cdem_dem_step(&dem, &fault));
  seen single = look(&dem);
  check_same(&many, &single, m.grains.grains, NULL, NULL);
  forget(&many);
  forget(&single);
  cdem_dem_release(&dem);
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_threads),   cmocka_unit_test(test_numbering),
      cmocka_unit_test(test_restart),   cmocka_unit_test(test_scaling),
      cmocka_unit_test(test_reference), cmocka_unit_test(test_steps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
