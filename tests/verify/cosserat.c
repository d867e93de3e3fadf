/* Room verify: the closed field around a hole in a Cosserat medium is one: balance, compatibility
 * and the law by finite differences, which know nothing of stress functions; free at the hole; and
 * its crown is the printed factor. */
#include "support/test.h"
#include "verify/cosserat_hole.h"

static const double nu = 0.3, coupling = 0.6, length = 0.8, shear = 2.0; /* R = 1, tension 1 */

enum { XX, YY, XY, YX, MX, MY, PSI, FIELDS };

/* Cartesian components of the stress at (x, y), and psi. */
static void stress_at(double x, double y, double s[FIELDS]) {
  cdem_cosserat_hole hole;
  cdem_polar_stress p;
  double t = atan2(y, x), c = cos(t), n = sin(t);
  cdem_cosserat_hole_init(1.0, 1.0, nu, coupling, length, &hole);
  cdem_cosserat_hole_stress(&hole, hypot(x, y), t, &p);
  s[XX] = c * c * p.rr - c * n * (p.rt + p.tr) + n * n * p.tt;
  s[YY] = n * n * p.rr + c * n * (p.rt + p.tr) + c * c * p.tt;
  s[XY] = c * n * (p.rr - p.tt) + c * c * p.rt - n * n * p.tr;
  s[YX] = c * n * (p.rr - p.tt) - n * n * p.rt + c * c * p.tr;
  s[MX] = c * p.mr - n * p.mt;
  s[MY] = n * p.mr + c * p.mt;
  s[PSI] = p.psi;
}

/* Strains xx yy xy yx and omega from stresses: the inverse of the isotropic law, plane strain. */
static void strain_at(double x, double y, double e[5]) {
  double s[FIELDS], n2 = coupling * coupling, gc = shear * n2 / (1.0 - n2);
  double lambda = 2.0 * shear * nu / (1.0 - 2.0 * nu);
  stress_at(x, y, s);
  double mean = (s[XX] + s[YY]) / (4.0 * (lambda + shear));
  double half = (s[XX] - s[YY]) / (4.0 * shear);
  double symmetric = (s[XY] + s[YX]) / (4.0 * shear), skew = (s[XY] - s[YX]) / (4.0 * gc);
  e[0] = mean + half;
  e[1] = mean - half;
  e[2] = symmetric + skew;
  e[3] = symmetric - skew;
  e[4] = s[PSI] / (4.0 * shear * length * length);
}

#define STEP 1e-4
/* Central differences of fourth order along x and y. */
static void slopes(void (*at)(double, double, double *), int fields, double x, double y,
                   double (*d)[2]) {
  static const double weight[] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12};
  static const int place[] = {-2, -1, 1, 2};
  for (int i = 0; i < fields; i++)
    d[i][0] = d[i][1] = 0.0;
  for (int k = 0; k < 4; k++)
    for (int axis = 0; axis < 2; axis++) {
      double value[FIELDS], h = place[k] * STEP;
      at(axis == 0 ? x + h : x, axis == 1 ? y + h : y, value);
      for (int i = 0; i < fields; i++)
        d[i][axis] += weight[k] * value[i] / STEP;
    }
}

static void field_is_a_solution(void **state) {
  (void)state;
  cdem_random random = {17};
  for (int trial = 0; trial < 50; trial++) {
    double r = cdem_random_uniform(&random, 1.1, 4.0), t = cdem_random_uniform(&random, 0, 6.28);
    double x = r * cos(t), y = r * sin(t), s[FIELDS], ds[FIELDS][2], de[5][2];
    stress_at(x, y, s);
    slopes(stress_at, FIELDS, x, y, ds);
    check_near(ds[XX][0] + ds[YX][1], 0, 0, 1e-10);
    check_near(ds[XY][0] + ds[YY][1], 0, 0, 1e-10);
    check_near(ds[MX][0] + ds[MY][1] + s[XY] - s[YX], 0, 0, 1e-10);
    check_near(ds[PSI][0], s[MX], 0, 1e-10);
    check_near(ds[PSI][1], s[MY], 0, 1e-10);
    slopes(strain_at, 5, x, y, de);
    check_near(de[0][1] - de[3][0], -de[4][0], 0, 1e-10); /* u_x,xy */
    check_near(de[1][0] - de[2][1], de[4][1], 0, 1e-10);  /* u_y,xy */
  }
}

static void hole_is_free(void **state) {
  (void)state;
  cdem_cosserat_hole hole;
  cdem_polar_stress s;
  cdem_cosserat_hole_init(1.5, 3.0, nu, coupling, length, &hole);
  for (int i = 0; i < 20; i++) {
    cdem_cosserat_hole_stress(&hole, 1.5, 0.31 * i, &s);
    check_near(s.rr, 0, 0, 1e-14);
    check_near(s.rt, 0, 0, 1e-14);
    check_near(s.mr, 0, 0, 1e-14);
    cdem_cosserat_hole_stress(&hole, 1e5, 0.31 * i, &s);
    check_near(s.rr, 1.5 * (1 + cos(0.62 * i)), 0, 1e-8);
    check_near(s.rt, -1.5 * sin(0.62 * i), 0, 1e-8);
    check_near(s.mr, 0, 0, 1e-8);
  }
}

static void crown_is_the_factor(void **state) {
  (void)state;
  cdem_cosserat_hole hole;
  cdem_polar_stress s;
  for (double n = 0.05; n < 1.0; n += 0.1)
    for (double l = 0.01; l < 20.0; l *= 3) {
      cdem_cosserat_hole_init(1.0, 2.0, nu, n, l, &hole);
      cdem_cosserat_hole_stress(&hole, 1.0, 1.57079632679489661923, &s);
      check_near(s.tt / 2.0, cdem_cosserat_hole_factor(1.0, nu, n, l), 1e-12, 0);
    }
  /* a hole far larger than the length is classical */
  check_near(cdem_cosserat_hole_factor(1.0, nu, 0.5, 1e-4), 3.0, 1e-6, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(field_is_a_solution),
      cmocka_unit_test(hole_is_free),
      cmocka_unit_test(crown_is_the_factor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
