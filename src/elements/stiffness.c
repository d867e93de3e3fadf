/* The reference: K = integral of B^T D B over the element, B the matrix of the textbooks in Voigt
 * order, built at each point. It shares with the moments path (contraction.c, kernels.c) only the
 * shape functions and the moduli. */
#include "elements/basis.h"

#include <string.h>

enum { MAX_SIZE = CDEM_SHAPE_MAX_NODES * CDEM_MAX_DOFS, MAX_ROWS = 6 };

/* Columns of B of one node with value n and gradient g, written into b [rows][MAX_SIZE] at `at`. */
static void solid_columns(const double g[3], double (*b)[MAX_SIZE], int at) {
  b[0][at] = g[0];
  b[1][at + 1] = g[1];
  b[2][at + 2] = g[2];
  b[3][at + 1] = g[2], b[3][at + 2] = g[1];
  b[4][at] = g[2], b[4][at + 2] = g[0];
  b[5][at] = g[1], b[5][at + 1] = g[0];
}

static void plane_columns(const double g[3], double (*b)[MAX_SIZE], int at) {
  b[0][at] = g[0];
  b[1][at + 1] = g[1];
  b[2][at] = g[1], b[2][at + 1] = g[0];
}

static void cosserat_columns(double n, const double g[3], double (*b)[MAX_SIZE], int at) {
  b[0][at] = g[0];
  b[1][at + 1] = g[1];
  b[2][at + 1] = g[0], b[2][at + 2] = -n;
  b[3][at] = g[1], b[3][at + 2] = n;
  b[4][at + 2] = g[0];
  b[5][at + 2] = g[1];
}

/* B at point q; returns the Jacobian determinant. */
static double strain_matrix(const cdem_tabulation *t, int q, const double (*xyz)[3],
                            double (*b)[MAX_SIZE]) {
  int dofs = cdem_element_dofs(t->element);
  const double(*dn)[3] = cdem_tabulated(t, q);
  double j[9], inverse[9];
  double det = cdem_jacobian(cdem_element_dimension(t->element), t->nodes, dn, xyz, j);
  cdem_inverse3(j, inverse);
  memset(b, 0, MAX_ROWS * sizeof *b);
  for (int a = 0; a < t->nodes; a++) {
    double g[3];
    for (int i = 0; i < 3; i++)
      g[i] = dn[a][0] * inverse[i] + dn[a][1] * inverse[3 + i] + dn[a][2] * inverse[6 + i];
    if (t->element->formulation == CDEM_SOLID)
      solid_columns(g, b, dofs * a);
    else if (t->element->formulation == CDEM_PLANE)
      plane_columns(g, b, dofs * a);
    else
      cosserat_columns(t->n[t->nodes * q + a], g, b, dofs * a);
  }
  return det;
}

/* k += factor B^T D B */
static void add_product(int size, int rows, double factor, const double *d,
                        const double (*b)[MAX_SIZE], double *k) {
  double db[MAX_ROWS][MAX_SIZE];
  for (int r = 0; r < rows; r++)
    for (int i = 0; i < size; i++) {
      db[r][i] = 0.0;
      for (int s = 0; s < rows; s++)
        db[r][i] += factor * d[rows * r + s] * b[s][i];
    }
  for (int i = 0; i < size; i++)
    for (int r = 0; r < rows; r++)
      for (int j = 0; j < size; j++)
        k[size * i + j] += b[r][i] * db[r][j];
}

cdem_status cdem_element_stiffness(const cdem_tabulation *tabulation, const cdem_material *material,
                                   const cdem_section *section, const double (*xyz)[3], double *k,
                                   cdem_fault *fault) {
  const cdem_element *element = tabulation->element;
  double d[36], thickness, b[MAX_ROWS][MAX_SIZE];
  int rows, size = tabulation->nodes * cdem_element_dofs(element);
  CDEM_TRY(cdem_material_moduli(material, cdem_formulation_moduli(element->formulation), section, d,
                                &rows, fault));
  CDEM_TRY(cdem_formulation_thickness(element->formulation, section, &thickness, fault));
  CDEM_TRY(cdem_element_check(tabulation, xyz, fault));
  memset(k, 0, sizeof *k * (size_t)(size * size));
  for (int q = 0; q < tabulation->points; q++) {
    double det = strain_matrix(tabulation, q, xyz, b);
    add_product(size, rows, thickness * tabulation->weight[q] * det, d,
                (const double(*)[MAX_SIZE])b, k);
  }
  return CDEM_OK;
}
