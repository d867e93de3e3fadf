/* gmsh's node order: mid nodes follow the edges 01 03 04 12 15 23 26 37 45 47 56 67, not bottom,
 * top, sides as in Abaqus. */
#include "elements/basis.h"

static const double reference[20][3] = {
    {-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},
    {-1, 1, 1},   {0, -1, -1}, {-1, 0, -1}, {-1, -1, 0}, {1, 0, -1},  {1, -1, 0}, {0, 1, -1},
    {1, 1, 0},    {-1, 1, 0},  {0, -1, 1},  {-1, 0, 1},  {1, 0, 1},   {0, 1, 1}};

static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  cdem_basis_serendipity(3, 20, reference, xi, n, dn);
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_cube(degree == 0 ? 5 : degree, rule);
}

const cdem_element cdem_element_hex20 = {
    .name = "hex20",
    .shape = CDEM_SHAPE_HEX20,
    .formulation = CDEM_SOLID,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "quadratic serendipity",
    .rule = "3x3x3 Gauss",
};
