/* Inside room elements: what the element files share. Not for other rooms.
 *
 * Basis functions write n [nodes] and dn [nodes][3], either of which may be NULL. Rules return
 * false when the degree is below 1 or needs more than CDEM_MAX_POINTS points.
 */
#ifndef CDEM_ELEMENTS_BASIS_H
#define CDEM_ELEMENTS_BASIS_H

#include "elements/elements.h"

#define X(identifier) extern const cdem_element cdem_element_##identifier;
#include "elements/elements.def"
#undef X

/* Triangle and tetrahedron in barycentric coordinates. edge: the corners of each mid node. */
void cdem_basis_simplex_linear(int dimension, const double xi[3], double *n, double (*dn)[3]);
void cdem_basis_simplex_quadratic(int dimension, const int (*edge)[2], const double xi[3],
                                  double *n, double (*dn)[3]);

/* Square and cube -1..1. reference: node coordinates, each component -1, 0 or 1. */
void cdem_basis_product(int dimension, const double (*reference)[3], const double xi[3], double *n,
                        double (*dn)[3]);
void cdem_basis_serendipity(int dimension, int nodes, const double (*reference)[3],
                            const double xi[3], double *n, double (*dn)[3]);

/* The moduli a formulation asks for. */
cdem_moduli_kind cdem_formulation_moduli(cdem_formulation formulation);
/* *thickness = the section's, 1 for a solid; fails as cdem_contraction_build does. */
cdem_status cdem_formulation_thickness(cdem_formulation formulation, const cdem_section *section,
                                       double *thickness, cdem_fault *fault);

/* The parameter of a key that the model has. */
double cdem_material_value(const cdem_material *material, const char *key);
/* m = D11 D12 D1212 D1221 Dm of an isotropic plane Cosserat continuum; spin is Gc. */
void cdem_isotropic_numbers(double lambda, double shear, double spin, double couple, double m[5]);
/* The same five of cosserat-lattice and cosserat-average, times the thickness of the discs (N/m;
 * the last N m). */
void cdem_packing_numbers(const cdem_material *material, double m[5]);
/* Li & Wan's eqs 21-24 as printed, times the thickness of the discs (N/m; the last m^2). */
typedef struct {
  double shear, lambda, spin, length_squared;
} cdem_packing_constants;
void cdem_packing_printed(const cdem_material *material, cdem_packing_constants *constants);

bool cdem_rule_triangle(int degree, cdem_quadrature *rule);
bool cdem_rule_square(int degree, cdem_quadrature *rule);
bool cdem_rule_tetrahedron(int degree, cdem_quadrature *rule);
bool cdem_rule_pyramid(int degree, cdem_quadrature *rule);
bool cdem_rule_wedge(int degree, cdem_quadrature *rule);
bool cdem_rule_cube(int degree, cdem_quadrature *rule);

/* The kernels of elements.h for vectors of 8, 4 or 2 doubles; NULL where the processor or the build
 * has none so wide. Width 2 is always there. */
typedef struct {
  void (*moments)(const cdem_tabulation *tabulation, const double *x, double *moment,
                  double *least);
  void (*blocks)(int pairs, const cdem_contraction *const contraction[CDEM_LANES],
                 const double *moment, double *s);
} cdem_kernels;
const cdem_kernels *cdem_kernels_of_width(int width);

/* j[3 i + k] = dx_i/dxi_k from derivatives dn [nodes][3]; a plane element is continued as a prism
 * of unit height. Returns the determinant. */
static inline double cdem_jacobian(int dimension, int nodes, const double (*dn)[3],
                                   const double (*xyz)[3], double j[9]) {
  for (int i = 0; i < 9; i++)
    j[i] = dimension == 2 && i == 8 ? 1.0 : 0.0;
  for (int a = 0; a < nodes; a++)
    for (int i = 0; i < dimension; i++)
      for (int k = 0; k < dimension; k++)
        j[3 * i + k] += xyz[a][i] * dn[a][k];
  return cdem_det3(j);
}

/* The derivatives [nodes][3] at point q of a tabulation. */
static inline const double (*cdem_tabulated(const cdem_tabulation *tabulation, int q))[3] {
  return (const double(*)[3])(tabulation->dn + (ptrdiff_t)3 * tabulation->nodes * q);
}

#endif
