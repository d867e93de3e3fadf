/* gmsh's node order: the last two mid nodes lie on edges 2-3 and 1-3 (Abaqus swaps them). */
#include "elements/basis.h"

static const double reference[10][3] = {{0, 0, 0},     {1, 0, 0},     {0, 1, 0},   {0, 0, 1},
                                        {0.5, 0, 0},   {0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0.5},
                                        {0, 0.5, 0.5}, {0.5, 0, 0.5}};

static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_simplex_quadratic(3, edge, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_tetrahedron(degree == 0 ? 2 : degree, rule);
}

const cdem_element cdem_element_tet10 = {
    .name = "tet10",
    .shape = CDEM_SHAPE_TET10,
    .formulation = CDEM_SOLID,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "quadratic Lagrange",
    .rule = "4 points, degree 2",
};
