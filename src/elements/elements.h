/* Room elements: shape functions, quadrature, materials and element stiffness.
 *
 * One element = one file that defines a cdem_element, plus one line in elements.def. The enum, the
 * names, `cdem list elements`, and the contract tests follow from that line.
 *
 * The stiffness of a node pair is K_ij = integral of B_i^T D B_j. B_i depends on node i only
 * through few numbers, its features h: (N,x N,y [N,z]) in a classical solid, (N N,x N,y) in a plane
 * Cosserat continuum. Hence B_i = sum_k h_k E_k with constant matrices E_k, and
 *
 *     M_ij[k][l] = integral of h_k(i) h_l(j) dV          moments: geometry only
 *     K_ij[a][b] = sum_kl C[a][b][k][l] M_ij[k][l]       C = E_k^T D E_l: material only (1)
 *
 * so one kernel serves every element and every material. The plain B^T D B is kept beside it
 * (cdem_element_stiffness) as the reference.
 *
 * Order of degrees of freedom: (ux uy uz), (ux uy), (ux uy omega); omega counter-clockwise, rad.
 */
#ifndef CDEM_ELEMENTS_ELEMENTS_H
#define CDEM_ELEMENTS_ELEMENTS_H

#include "base/base.h"
#include "elements/material.h"
#include "mesh/mesh.h"

typedef enum { CDEM_SOLID, CDEM_PLANE, CDEM_PLANE_COSSERAT } cdem_formulation;

enum {
  CDEM_MAX_POINTS = 512, /* quadrature points of one element */
  CDEM_MAX_DOFS = 3,     /* per node */
  CDEM_MAX_PAIRS = 190   /* unordered node pairs of one element */
};

/* Quadrature points in reference coordinates with their weights; weights sum to the reference
 * volume. */
typedef struct {
  int points;
  double xi[CDEM_MAX_POINTS][3];
  double weight[CDEM_MAX_POINTS];
} cdem_quadrature;

typedef struct {
  const char *name; /* "hex8", "quad4-cosserat": the `kind` of the stable formats */
  cdem_shape shape;
  cdem_formulation formulation;
  const double (
      *reference)[3]; /* [nodes][3] reference coordinates; the reference shape of `cdem poisson` */
  /* n [nodes], dn [nodes][3]: values and derivatives by xi (unused components 0). Either may be
   * NULL. */
  void (*shape_functions)(const double xi[3], double *n, double (*dn)[3]);
  /* The rule that integrates polynomials of `degree` exactly (per direction where the shape is a
   * product); degree 0: the element's own full rule. Returns false when the rule would need too
   * many points. */
  bool (*quadrature)(int degree, cdem_quadrature *rule);
  const char *basis; /* one line for `cdem list elements` */
  const char *rule;  /* likewise: the full rule */
} cdem_element;

typedef enum {
#define X(identifier) CDEM_ELEMENT_##identifier,
#include "elements/elements.def"
#undef X
  CDEM_ELEMENT_COUNT
} cdem_element_id;

const cdem_element *cdem_element_get(cdem_element_id id);
/* By name, or by shape and formulation; NULL when there is none. */
const cdem_element *cdem_element_find(const char *name);
const cdem_element *cdem_element_for(cdem_shape shape, cdem_formulation formulation);

static inline int cdem_element_nodes(const cdem_element *element) {
  return cdem_shape_get(element->shape)->nodes;
}
static inline int cdem_element_dimension(const cdem_element *element) {
  return cdem_shape_get(element->shape)->dimension;
}
/* Degrees of freedom a node: 2 or 3. */
static inline int cdem_element_dofs(const cdem_element *element) {
  return element->formulation == CDEM_PLANE ? 2 : 3;
}
/* Features a node: 2 in a plane, else 3. */
static inline int cdem_element_features(const cdem_element *element) {
  return element->formulation == CDEM_PLANE ? 2 : 3;
}
/* Unordered pairs of different nodes; pair p of (a, b), a < b, in the order (0,1) (0,2) .. (1,2) ..
 */
static inline int cdem_element_pairs(const cdem_element *element) {
  int nodes = cdem_element_nodes(element);
  return nodes * (nodes - 1) / 2;
}

/* Material law as the coefficients of equation (1). In 2-D the thickness of the section is a factor
 * of c (and of lambda and mu), so that moments and kernels know no thickness. */
typedef struct {
  int dofs, features;
  double c[CDEM_MAX_DOFS][CDEM_MAX_DOFS][3][3]; /* [a][b][k][l] */
  /* c[a][b][k][l] = lambda d_ak d_bl + mu (d_ab d_kl + d_al d_bk): the kernels then take 15
   * multiply-adds a block instead of 81. Found from c itself, to 4 ulp of its largest entry. */
  bool isotropic;
  double lambda, mu;
} cdem_contraction;

/* From a material, for a formulation and section (NULL allowed for solids). CDEM_INPUT with the
 * bound when the material cannot be (see material.h) or does not fit the formulation, or when a
 * plane's thickness is not positive; CDEM_USAGE for a plane without section. */
cdem_status cdem_contraction_build(const cdem_material *material, cdem_formulation formulation,
                                   const cdem_section *section, cdem_contraction *contraction,
                                   cdem_fault *fault);

/* Shape functions tabulated at the points of a rule, ready for the kernels. */
typedef struct {
  const cdem_element *element;
  int points, nodes;
  double *weight; /* [points] */
  double *n;      /* [points][nodes] */
  double *dn;     /* [points][nodes][3] */
  double *corner; /* [corners][nodes][3] derivatives at the corners, for the validity check */
} cdem_tabulation;

/* degree as in cdem_element.quadrature; CDEM_USAGE when the element has no such rule. */
cdem_status cdem_tabulation_init(const cdem_element *element, int degree,
                                 cdem_tabulation *tabulation, cdem_fault *fault);
void cdem_tabulation_release(cdem_tabulation *tabulation);

/* Is this element usable? xyz [nodes][3] (2-D: z unused). CDEM_INPUT without the tag (the caller
 * prefixes it): Jacobian determinant not positive at a quadrature point, or negative at a corner;
 * the message tells an inverted element (all negative: "reverse its node order") from a folded and
 * from a flat one. Flat means a height below CDEM_FLAT_BOUND of the length, or of what rounding of
 * the coordinates does; no other measure of shape is applied, so that a needle passes. */
#define CDEM_FLAT_BOUND 1e-12
cdem_status cdem_element_check(const cdem_tabulation *tabulation, const double (*xyz)[3],
                               cdem_fault *fault);

/* Reference: the whole stiffness matrix by B^T D B, row-major [nodes*dofs][nodes*dofs], node-major
 * dofs, thickness included. Also the truth the certificate compares with. Fails as
 * cdem_element_check and cdem_contraction_build do. */
cdem_status cdem_element_stiffness(const cdem_tabulation *tabulation, const cdem_material *material,
                                   const cdem_section *section, const double (*xyz)[3], double *k,
                                   cdem_fault *fault);

/* Volume (area times thickness in 2-D), m^3. */
double cdem_element_volume(const cdem_tabulation *tabulation, double thickness,
                           const double (*xyz)[3]);

/* Fast path: CDEM_LANES elements of one kind side by side, lane last. Checks nothing and allocates
 * nothing, but reports the determinant.
 *   x      [nodes][3][CDEM_LANES]               coordinates, m (2-D: z unused)
 *   moment [pairs][features*features][CDEM_LANES] moments of the pairs a < b, M_ab row-major (k,
 * l); thickness not included least  [CDEM_LANES]                         smallest Jacobian
 * determinant over the quadrature points by the largest in size: not positive for an inverted,
 * folded or flat element Fewer elements than lanes: repeat one of them. */
enum { CDEM_LANES = 8 };
void cdem_moments_kernel(const cdem_tabulation *tabulation, const double *x, double *moment,
                         double *least);

/* Spring tensors S_ab = -K_ab of the same batch: s [pairs][dofs*dofs][CDEM_LANES] row-major blocks.
 * contraction [CDEM_LANES]: the law of each lane, all of one formulation; brings the thickness. */
void cdem_blocks_kernel(int pairs, const cdem_contraction *const contraction[CDEM_LANES],
                        const double *moment, double *s);

/* The same for one element at a time, where speed is no matter: s [pairs][dofs*dofs], row-major
 * blocks S_ab of the pairs a < b, thickness included through the contraction. xyz [nodes][3].
 * Fails as cdem_element_check does. */
cdem_status cdem_element_pair_blocks(const cdem_tabulation *tabulation,
                                     const cdem_contraction *contraction, const double (*xyz)[3],
                                     double *s, cdem_fault *fault);

#endif
