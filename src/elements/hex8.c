#include "elements/basis.h"

static const double reference[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                       {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_product(3, reference, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_cube(degree == 0 ? 3 : degree, rule);
}

const cdem_element cdem_element_hex8 = {
    .name = "hex8",
    .shape = CDEM_SHAPE_HEX8,
    .formulation = CDEM_SOLID,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "trilinear Lagrange",
    .rule = "2x2x2 Gauss",
};
