/* The law that carries no tension: conditions of the least energy, the stress as its derivative,
 * and closed forms, for isotropic and cubic moduli. */
#include "cdem/tension_law.h"

#include "base/random.h"
#include "support/test.h"

/* The laws tried: a solid and a plane of each Poisson's ratio (plane strain; a negative one opens
 * in no other order), and cubic planes, stiff and soft in shear. */
enum { LAWS = 12 };

static cdem_tension_law law_at(int index) {
  static const double poisson[4] = {-0.6, 0.0, 0.3, 0.49};
  static const double ratio[4] = {0.05, 0.5, 3.0, 40.0};
  double nu = poisson[index % 4], mu = 1.0 / (2.0 * (1.0 + nu)),
         lambda = 2 * mu * nu / (1 - 2 * nu);
  if (index < 4)
    return (cdem_tension_law){.kind = CDEM_TENSION_SOLID, .lambda = lambda, .mu = mu};
  double half = 2.0 * mu * (index < 8 ? 1.0 : ratio[index % 4]);
  return (cdem_tension_law){.kind = CDEM_TENSION_PLANE, .k = {2 * (lambda + mu), 2 * mu, half}};
}

static double product(const double stress[6], const double strain[6]) {
  double sum = 0.0;
  for (int i = 0; i < 6; i++)
    sum += stress[i] * strain[i];
  return sum;
}

static double largest6(const double v[6]) {
  double most = 0.0;
  for (int i = 0; i < 6; i++)
    most = fmax(most, fabs(v[i]));
  return most;
}

/* The largest eigenvalue of a symmetric tensor, of which shears count by `shear`. */
static double top(const double v[6], double shear) {
  double m[3][3] = {{v[0], shear * v[5], shear * v[4]},
                    {shear * v[5], v[1], shear * v[3]},
                    {shear * v[4], shear * v[3], v[2]}};
  double value[3], n[3][3];
  cdem_tension_principal(m, value, n);
  return fmax(value[0], fmax(value[1], value[2]));
}

static void random_strain(const cdem_tension_law *law, cdem_random *random, double e[6]) {
  for (int i = 0; i < 6; i++)
    e[i] = cdem_random_uniform(random, -1.0, 1.0);
  double shift = cdem_random_uniform(random, -2.0, 2.0);
  for (int i = 0; i < 3; i++)
    e[i] += shift;
  for (int i = 2; i < 5 && law->kind == CDEM_TENSION_PLANE; i++)
    e[i] = 0.0;
}

/* Stress and energy of what has not opened. */
static double settle(const cdem_tension_law *law, const double e[6], double s[6], double a[6]) {
  double elastic[6];
  cdem_tension_open(law, e, a);
  for (int i = 0; i < 6; i++)
    elastic[i] = e[i] - a[i];
  cdem_tension_stress(law, elastic, s);
  return 0.5 * product(s, elastic);
}

/* s <= 0, a >= 0, s . a = 0: with a convex energy that is the least one. Each of the cases, none to
 * all directions open, comes up. Rounding, against the stress without opening. */
static void conditions_of_the_least_energy(void **state) {
  (void)state;
  for (int l = 0; l < LAWS; l++) {
    cdem_tension_law law = law_at(l);
    cdem_random random = {5};
    int none = 0, some = 0, all = 0;
    for (int k = 0; k < 4000; k++) {
      double e[6], s[6], a[6], whole[6], closing[6];
      random_strain(&law, &random, e);
      cdem_tension_stress(&law, e, whole);
      settle(&law, e, s, a);
      double scale = largest6(whole) + law.k[1] + law.k[2] + law.mu;
      for (int i = 0; i < 6; i++)
        closing[i] = -a[i];
      check_below(top(s, 1.0), 2e-14 * scale);
      check_below(top(closing, 0.5), 1e-14);
      check_near(product(s, a), 0.0, 0.0, 4e-14 * scale);
      *(largest6(a) == 0.0 ? &none : largest6(s) < 1e-13 * scale ? &all : &some) += 1;
    }
    assert_true(none > 20 && some > 50 && all > 50);
  }
}

/* No other opening has less energy: W(e - b) for random b >= 0. */
static void no_opening_is_better(void **state) {
  (void)state;
  for (int l = 0; l < LAWS; l++) {
    cdem_tension_law law = law_at(l);
    cdem_random random = {6};
    for (int k = 0; k < 2000; k++) {
      double e[6], s[6], a[6], b[6], rest[6], energy;
      random_strain(&law, &random, e);
      energy = settle(&law, e, s, a);
      double n[3], size = cdem_random_uniform(&random, 0.0, 0.2);
      for (int i = 0; i < 3; i++)
        n[i] = cdem_random_uniform(&random, -1.0, 1.0);
      if (law.kind == CDEM_TENSION_PLANE)
        n[2] = 0.0;
      double keep = cdem_random_uniform(&random, 0.5, 1.0); /* some of the best, and one more */
      const double more[6] = {n[0] * n[0],     n[1] * n[1],     n[2] * n[2],
                              2 * n[1] * n[2], 2 * n[0] * n[2], 2 * n[0] * n[1]};
      for (int i = 0; i < 6; i++) {
        b[i] = keep * a[i] + size * more[i];
        rest[i] = e[i] - b[i];
      }
      cdem_tension_stress(&law, rest, s);
      assert_true(0.5 * product(s, rest) >= energy * (1.0 - 1e-13));
    }
  }
}

/* The stress is dW/de: differences over 1e-6 of second order, and first where a case ends between.
 */
static void stress_is_the_derivative(void **state) {
  (void)state;
  for (int l = 0; l < LAWS; l++) {
    cdem_tension_law law = law_at(l);
    cdem_random random = {7};
    for (int k = 0; k < 1000; k++) {
      double e[6], to[6], p[6], q[6], s[6], a[6], unused[6], h = 1e-6;
      random_strain(&law, &random, e);
      random_strain(&law, &random, to);
      settle(&law, e, s, a);
      for (int i = 0; i < 6; i++) {
        p[i] = e[i] + h * to[i];
        q[i] = e[i] - h * to[i];
      }
      double slope = (settle(&law, p, unused, a) - settle(&law, q, unused, a)) / (2.0 * h);
      double stiffest = law.k[0] + law.k[1] + law.k[2] + 3 * law.lambda + 2 * law.mu;
      check_near(slope, product(s, to), 0.0, 1e-5 * stiffest);
    }
  }
}

/* From full pressure through each case to all open and back again: steps of the stress along the
 * way are no larger than those without opening. (A projection does not lengthen.) */
static void stress_has_no_jumps(void **state) {
  (void)state;
  for (int l = 0; l < LAWS; l++) {
    cdem_tension_law law = law_at(l);
    const double from[6] = {-3, -2, -2.5, 0.2, 0.1, 0.5}, to[6] = {3, 2, 4, -0.3, 0.2, -0.4};
    double last[6] = {0}, e[6], s[6], a[6], step[6], change[6];
    const int steps = 2000;
    for (int k = 0; k <= steps; k++) {
      for (int i = 0; i < 6; i++) {
        bool out = law.kind == CDEM_TENSION_PLANE && i > 1 && i < 5;
        step[i] = out ? 0.0 : (to[i] - from[i]) / steps;
        e[i] = out ? 0.0 : from[i] + k * step[i];
      }
      settle(&law, e, s, a);
      double hooke[6], sum = 0.0;
      cdem_tension_stress(&law, step, hooke);
      for (int i = 0; i < 6; i++)
        change[i] = s[i] - last[i];
      /* ds . de lies between ds . D^-1 ds and nothing, at most de . D de */
      for (int i = 0; i < 6; i++)
        sum += change[i] * step[i];
      if (k > 0)
        assert_true(sum >= -1e-14 && sum <= product(hooke, step) * (1.0 + 1e-9));
      memcpy(last, s, sizeof last);
    }
  }
}

/* Uniaxial strain and stress, planes and solids: nothing in tension, Hooke in compression; and the
 * moduli that are left when directions have opened. */
static void closed_forms(void **state) {
  (void)state;
  for (int l = 0; l < 8; l++) {
    cdem_tension_law law = law_at(l);
    bool solid = law.kind == CDEM_TENSION_SOLID;
    double mu = solid ? law.mu : 0.5 * law.k[1];
    double lambda = solid ? law.lambda : 0.5 * law.k[0] - mu, s[6], a[6], want[6];
    double pull[6] = {1e-3}, push[6] = {-1e-3};
    settle(&law, pull, s, a);
    check_below(largest6(s), lambda < 0.0 ? 1e-3 : 1e-17);
    settle(&law, push, s, a);
    if (lambda >= 0.0) { /* confined, all pressures: bit for bit */
      cdem_tension_stress(&law, push, want);
      assert_memory_equal(s, want, sizeof s);
      assert_true(largest6(a) == 0.0);
    }
    const double sheet[6] = {5e-3, -1e-3}; /* x wide open, y pressed, z held */
    settle(&law, sheet, s, a);
    double modulus = 4 * mu * (lambda + mu) / (lambda + 2 * mu);
    if (solid && lambda < 0.0) /* pressed along y it would draw in along z, so z opens too */
      modulus = 1.0;
    check_near(s[1], -1e-3 * modulus, 1e-13, 0.0);
    check_near(s[0], 0.0, 0.0, 1e-17);
    if (!solid)
      continue;
    const double column[6] = {5e-3, -1e-3, 5e-3}; /* x and z wide open: Young's modulus, 1 */
    settle(&law, column, s, a);
    check_near(s[1], -1e-3, 1e-12, 0.0);
    check_below(fmax(fabs(s[0]), fabs(s[2])), 1e-17);
  }
}

/* A cubic plane that is isotropic to a hair opens as the isotropic one. */
static void cubic_ends_in_isotropic(void **state) {
  (void)state;
  cdem_random random = {8};
  for (int k = 0; k < 2000; k++) {
    const double round[3] = {3.0, 2.0, 2.0}, cubic[3] = {3.0, 2.0, 2.0 * (1.0 + 1e-13)};
    double e[3], a[3], b[3];
    for (int i = 0; i < 3; i++)
      e[i] = cdem_random_uniform(&random, -1.0, 1.0);
    assert_int_equal(cdem_tension_open_plane(round, e, a), cdem_tension_open_plane(cubic, e, b));
    for (int i = 0; i < 3; i++)
      check_near(b[i], a[i], 0.0, 1e-12);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(conditions_of_the_least_energy),
      cmocka_unit_test(no_opening_is_better),
      cmocka_unit_test(stress_is_the_derivative),
      cmocka_unit_test(stress_has_no_jumps),
      cmocka_unit_test(closed_forms),
      cmocka_unit_test(cubic_ends_in_isotropic),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
