/* Lagrange bases of triangle and tetrahedron in barycentric coordinates L_0 = 1 - sum xi, L_i =
 * xi_{i-1}: linear N_i = L_i; quadratic N_i = L_i (2 L_i - 1) at corners, 4 L_i L_j on edges. */
#include "elements/basis.h"

/* dL_i/dxi_k */
static double slope(int i, int k) {
  return i == 0 ? -1.0 : i == k + 1 ? 1.0 : 0.0;
}

static void barycentric(int dimension, const double xi[3], double l[4]) {
  l[0] = 1.0;
  for (int k = 0; k < dimension; k++) {
    l[k + 1] = xi[k];
    l[0] -= xi[k];
  }
}

void cdem_basis_simplex_linear(int dimension, const double xi[3], double *n, double (*dn)[3]) {
  double l[4];
  barycentric(dimension, xi, l);
  for (int i = 0; i <= dimension; i++) {
    if (n != NULL)
      n[i] = l[i];
    for (int k = 0; dn != NULL && k < 3; k++)
      dn[i][k] = k < dimension ? slope(i, k) : 0.0;
  }
}

void cdem_basis_simplex_quadratic(int dimension, const int (*edge)[2], const double xi[3],
                                  double *n, double (*dn)[3]) {
  double l[4];
  barycentric(dimension, xi, l);
  int corners = dimension + 1, nodes = corners * (corners + 1) / 2;
  for (int i = 0; i < corners; i++) {
    if (n != NULL)
      n[i] = l[i] * (2.0 * l[i] - 1.0);
    for (int k = 0; dn != NULL && k < 3; k++)
      dn[i][k] = k < dimension ? (4.0 * l[i] - 1.0) * slope(i, k) : 0.0;
  }
  for (int m = corners; m < nodes; m++) {
    int i = edge[m - corners][0], j = edge[m - corners][1];
    if (n != NULL)
      n[m] = 4.0 * l[i] * l[j];
    for (int k = 0; dn != NULL && k < 3; k++)
      dn[m][k] = k < dimension ? 4.0 * (l[i] * slope(j, k) + l[j] * slope(i, k)) : 0.0;
  }
}
