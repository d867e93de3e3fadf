#include "elements/basis.h"

static const double reference[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_simplex_linear(3, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_tetrahedron(degree == 0 ? 1 : degree, rule);
}

const cdem_element cdem_element_tet4 = {
    .name = "tet4",
    .shape = CDEM_SHAPE_TET4,
    .formulation = CDEM_SOLID,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "linear Lagrange",
    .rule = "1 point",
};
