/* The rational pyramid (Bedrosian 1992): the five functions that meet bilinear quadrilaterals and
 * linear triangles on their faces without a gap. In the collapsed coordinates a = xi/(1 - zeta), b
 * = eta/(1 - zeta) they are N = (1 - zeta)(1 + r a)(1 + s b)/4 at the base corner (r, s) and N =
 * zeta at the apex. By xi, eta, zeta their derivatives are r (1 + s b)/4, s (1 + r a)/4, (r s a b -
 * 1)/4: functions of a and b alone. So is the Jacobian; at the apex the derivatives depend on the
 * direction of approach, here that of the axis (a = b = 0), and a check of the base corners covers
 * all directions. */
#include "elements/basis.h"

static const double reference[5][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  double height = 1.0 - xi[2];
  double a = height == 0.0 ? 0.0 : xi[0] / height, b = height == 0.0 ? 0.0 : xi[1] / height;
  for (int i = 0; i < 4; i++) {
    double r = reference[i][0], s = reference[i][1];
    if (n != NULL)
      n[i] = 0.25 * height * (1.0 + r * a) * (1.0 + s * b);
    if (dn != NULL) {
      dn[i][0] = 0.25 * r * (1.0 + s * b);
      dn[i][1] = 0.25 * s * (1.0 + r * a);
      dn[i][2] = 0.25 * (r * s * a * b - 1.0);
    }
  }
  if (n != NULL)
    n[4] = xi[2];
  if (dn != NULL) {
    dn[4][0] = dn[4][1] = 0.0;
    dn[4][2] = 1.0;
  }
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_pyramid(degree == 0 ? 3 : degree, rule);
}

const cdem_element cdem_element_pyr5 = {
    .name = "pyr5",
    .shape = CDEM_SHAPE_PYR5,
    .formulation = CDEM_SOLID,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "rational (Bedrosian) on the base -1..1 with apex (0,0,1): (1-z)(1+ra)(1+sb)/4, a = "
             "x/(1-z), b = y/(1-z)",
    .rule = "2x2x2 conical product: Gauss-Legendre in a, b, Gauss-Jacobi with weight (1-z)^2 in z",
};
