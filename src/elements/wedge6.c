#include "elements/basis.h"

static const double reference[6][3] = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1},
                                       {0, 0, 1},  {1, 0, 1},  {0, 1, 1}};

/* Linear triangle times linear segment. */
static void shape_functions(const double xi[3], double *n, double (*dn)[3]) {
  double l[3], dl[3][3];
  cdem_basis_simplex_linear(2, xi, l, dl);
  for (int a = 0; a < 6; a++) {
    double side = reference[a][2], height = 0.5 * (1.0 + side * xi[2]);
    if (n != NULL)
      n[a] = l[a % 3] * height;
    if (dn != NULL) {
      dn[a][0] = dl[a % 3][0] * height;
      dn[a][1] = dl[a % 3][1] * height;
      dn[a][2] = 0.5 * side * l[a % 3];
    }
  }
}

static bool quadrature(int degree, cdem_quadrature *rule) {
  return cdem_rule_wedge(degree == 0 ? 2 : degree, rule);
}

const cdem_element cdem_element_wedge6 = {
    .name = "wedge6",
    .shape = CDEM_SHAPE_WEDGE6,
    .formulation = CDEM_SOLID,
    .reference = reference,
    .shape_functions = shape_functions,
    .quadrature = quadrature,
    .basis = "linear triangle times linear segment",
    .rule = "3 points (1/6,1/6) (2/3,1/6) (1/6,2/3) x 2 Gauss",
};
