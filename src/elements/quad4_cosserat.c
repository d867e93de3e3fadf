#include "elements/basis.h"

static const double reference[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_product(2, reference, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_square(degree == 0 ? 3 : degree, rule);
}

const cdem_element cdem_element_quad4_cosserat = {
    .name = "quad4-cosserat",
    .shape = CDEM_SHAPE_QUAD4,
    .formulation = CDEM_PLANE_COSSERAT,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "bilinear Lagrange, displacement and rotation alike",
    .rule = "2x2 Gauss",
};
