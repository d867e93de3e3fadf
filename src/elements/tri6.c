#include "elements/basis.h"

static const double reference[6][3] = {{0, 0, 0},   {1, 0, 0},     {0, 1, 0},
                                       {0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};

static const int edge[3][2] = {{0, 1}, {1, 2}, {2, 0}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_simplex_quadratic(2, edge, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_triangle(degree == 0 ? 2 : degree, rule);
}

const cdem_element cdem_element_tri6 = {
    .name = "tri6",
    .shape = CDEM_SHAPE_TRI6,
    .formulation = CDEM_PLANE,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "quadratic Lagrange",
    .rule = "3 points (1/6,1/6) (2/3,1/6) (1/6,2/3)",
};
