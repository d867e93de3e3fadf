#include "verify/cosserat_hole.h"

#include <gsl/gsl_sf_bessel.h>
#include <math.h>

/* 8 (1 - nu) N^2/(4 + x^2 + 2 x K0(x)/K1(x)), x = R/c = N R/l, eq. (23). */
static double couple_term(double radius, double poisson, double coupling, double length) {
  double x = coupling * radius / length;
  double quotient = gsl_sf_bessel_K0_scaled(x) / gsl_sf_bessel_K1_scaled(x);
  return 8.0 * (1.0 - poisson) * coupling * coupling / (4.0 + x * x + 2.0 * x * quotient);
}

double cdem_cosserat_hole_factor(double radius, double poisson, double coupling, double length) {
  double f = couple_term(radius, poisson, coupling, length);
  return (3.0 + f) / (1.0 + f);
}

/* K2(x) exp(s) and its derivative over x times exp(s). */
static double k2(double x, double shift) {
  return gsl_sf_bessel_Kn_scaled(2, x) * exp(shift - x);
}
static double k2_slope(double x, double shift) {
  return -gsl_sf_bessel_K1_scaled(x) * exp(shift - x) - 2.0 * k2(x, shift) / x;
}

/* a[4] multiplies K2(r/c) exp(R/c): no overflow however small c is. */
void cdem_cosserat_hole_init(double radius, double tension, double poisson, double coupling,
                             double length, cdem_cosserat_hole *hole) {
  double area = radius * radius, c = length / coupling, x = radius / c;
  double f = couple_term(radius, poisson, coupling, length);
  *hole = (cdem_cosserat_hole){
      .radius = radius, .tension = tension, .couple_length = length, .shear_length = c};
  double *a = hole->a;
  a[0] = -0.5 * tension * area; /* the rows of eq. (22) */
  a[2] = 0.5 * tension * area / (1.0 + f);
  a[3] = 8.0 * (1.0 - poisson) * length * length * a[2];
  a[4] = 2.0 * a[3] * c / (area * radius * k2_slope(x, x));
  double g = f * a[2];
  a[1] = area * area / 6.0 * (-0.5 * tension + (4.0 * g - 2.0 * a[2]) / area);
}

/* Eq. (20) written out for eq. (21). */
void cdem_cosserat_hole_stress(const cdem_cosserat_hole *hole, double r, double t,
                               cdem_polar_stress *stress) {
  const double *a = hole->a;
  double c = hole->shear_length, shift = hole->radius / c, x = r / c, r2 = r * r, r4 = r2 * r2;
  double half = 0.5 * hole->tension, cosine = cos(2.0 * t), sine = sin(2.0 * t);
  double bessel = a[4] * k2(x, shift), slope = a[4] * k2_slope(x, shift) / c;
  double g = a[3] / r2 + bessel, g1 = -2.0 * a[3] / (r2 * r) + slope;
  /* K2'' = K2 - K2'/x + 4 K2/x^2 */
  double g2 = 6.0 * a[3] / r4 + bessel / (c * c) - slope / r + 4.0 * bessel / r2;
  double turn = 2.0 * (g1 / r - g / r2);
  stress->rr = half + a[0] / r2 + (half - 6.0 * a[1] / r4 - 4.0 * a[2] / r2 - turn) * cosine;
  stress->tt = half - a[0] / r2 + (-half + 6.0 * a[1] / r4 + turn) * cosine;
  double shear = -half - 6.0 * a[1] / r4 - 2.0 * a[2] / r2;
  stress->rt = (shear - g1 / r + 4.0 * g / r2) * sine;
  stress->tr = (shear + g2) * sine;
  stress->psi = g * sine;
  stress->mr = g1 * sine;
  stress->mt = 2.0 * g / r * cosine;
}
