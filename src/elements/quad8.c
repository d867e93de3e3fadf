#include "elements/basis.h"

static const double reference[8][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0},
                                       {0, -1, 0},  {1, 0, 0},  {0, 1, 0}, {-1, 0, 0}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_serendipity(2, 8, reference, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_square(degree == 0 ? 5 : degree, rule);
}

const cdem_element cdem_element_quad8 = {
    .name = "quad8",
    .shape = CDEM_SHAPE_QUAD8,
    .formulation = CDEM_PLANE,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "quadratic serendipity",
    .rule = "3x3 Gauss",
};
