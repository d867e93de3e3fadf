/* The products N_i N_j of the rotation ask for degree 2, where the classical triangle needs one
 * point. */
#include "elements/basis.h"

static const double reference[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_simplex_linear(2, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_triangle(degree == 0 ? 2 : degree, rule);
}

const cdem_element cdem_element_tri3_cosserat = {
    .name = "tri3-cosserat",
    .shape = CDEM_SHAPE_TRI3,
    .formulation = CDEM_PLANE_COSSERAT,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "linear Lagrange, displacement and rotation alike",
    .rule = "3 points (1/6,1/6) (2/3,1/6) (1/6,2/3)",
};
