#include "elements/basis.h"

static const double reference[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_simplex_linear(2, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_triangle(degree == 0 ? 1 : degree, rule);
}

const cdem_element cdem_element_tri3 = {
    .name = "tri3",
    .shape = CDEM_SHAPE_TRI3,
    .formulation = CDEM_PLANE,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "linear Lagrange",
    .rule = "1 point",
};
