/* Bases on the square and the cube -1..1, from the coordinates r of the nodes.
 *
 * Linear in each direction: N = prod (1 + r_k x_k) / 2^d. Serendipity, quadratic: at corners
 * N = prod (1 + r_k x_k) (sum r_k x_k - d + 1) / 2^d, at the middle of an edge along m (r_m = 0)
 * N = (1 - x_m^2) prod_{k /= m} (1 + r_k x_k) / 2^(d-1). */
#include "elements/basis.h"

/* One node: value and derivatives of a product of one factor f_k(x_k) per direction. */
static void multiply(int dimension, const double f[3], const double df[3], double *value,
                     double gradient[3]) {
  *value = 1.0;
  for (int k = 0; k < dimension; k++)
    *value *= f[k];
  for (int k = 0; k < 3; k++) {
    gradient[k] = k < dimension ? df[k] : 0.0;
    for (int m = 0; m < dimension; m++)
      if (m != k)
        gradient[k] *= f[m];
  }
}

static void store(int node, double value, const double gradient[3], double *n, double (*dn)[3]) {
  if (n != NULL)
    n[node] = value;
  for (int k = 0; dn != NULL && k < 3; k++)
    dn[node][k] = gradient[k];
}

void cdem_basis_product(int dimension, const double (*reference)[3], const double xi[3], double *n,
                        double (*dn)[3]) {
  for (int a = 0; a < 1 << dimension; a++) {
    double f[3] = {0}, df[3] = {0}, value, gradient[3];
    for (int k = 0; k < dimension; k++) {
      f[k] = 0.5 * (1.0 + reference[a][k] * xi[k]);
      df[k] = 0.5 * reference[a][k];
    }
    multiply(dimension, f, df, &value, gradient);
    store(a, value, gradient, n, dn);
  }
}

void cdem_basis_serendipity(int dimension, int nodes, const double (*reference)[3],
                            const double xi[3], double *n, double (*dn)[3]) {
  for (int a = 0; a < nodes; a++) {
    const double *r = reference[a];
    double f[3] = {0}, df[3] = {0}, value, gradient[3], sum = 1.0 - dimension;
    for (int k = 0; k < dimension; k++) {
      sum += r[k] * xi[k];
      f[k] = r[k] == 0.0 ? 1.0 - xi[k] * xi[k] : 0.5 * (1.0 + r[k] * xi[k]);
      df[k] = r[k] == 0.0 ? -2.0 * xi[k] : 0.5 * r[k];
    }
    multiply(dimension, f, df, &value, gradient);
    if (a < 1 << dimension) { /* corners come first */
      for (int k = 0; k < dimension; k++)
        gradient[k] = gradient[k] * sum + value * r[k];
      value *= sum;
    }
    store(a, value, gradient, n, dn);
  }
}
