/* A finite element of its own: the second derivation that the springs of the program are held
 * against. It shares no line with the library and prefers the plain definition to the fast formula.
 *
 * Shape functions: the space of an element (its monomials) and N_a(node b) = delta_ab, solved as a
 * linear system, so that no formula of a shape function is written down. Nodes are numbered as in
 * the gmsh reference manual, "Node ordering". Strains are Voigt vectors xx yy zz yz xz xy with
 * engineering shear, moduli matrices in the same order, and K = sum w det(J) B^T D B is a dense
 * triple product. A plane Cosserat node has (ux, uy, omega) and the strains
 * ux,x  uy,y  uy,x - omega  ux,y + omega  omega,x  omega,y.
 */
#ifndef CDEM_TESTS_CLI_REFERENCE_ELEMENT_H
#define CDEM_TESTS_CLI_REFERENCE_ELEMENT_H

#include <stdbool.h>

enum { REFERENCE_MAX_NODES = 20, REFERENCE_MAX_DOFS = 60 };

typedef enum reference_rule {
  RULE_GAUSS_2, /* n points a direction, on lines, quadrilaterals and hexahedra */
  RULE_GAUSS_3,
  RULE_TRIANGLE_1,
  RULE_TRIANGLE_3,
  RULE_TETRAHEDRON_1,
  RULE_TETRAHEDRON_4,
  RULE_WEDGE_6,
  RULE_PYRAMID_8
} reference_rule;

/* What the corners span. */
typedef struct reference_shape {
  int dimension, corners, facets;
  double facet[6][4]; /* n x = d: the plane of a facet */
  int turn[2][8];     /* two turns of the shape onto itself: corner k goes to turn[.][k] */
} reference_shape;

typedef struct reference_element {
  const char *kind; /* name in the program's tables */
  int gmsh_type, nodes;
  const reference_shape *shape;
  const double (*node)[3];
  const signed char (*power)[3]; /* x^p y^q z^r; r < 0 is (1 - z)^r */
  reference_rule rule;
  bool cosserat;
} reference_element;

/* Moduli as the integral sees them. Classical: `moduli` in 3-D; plane states are taken from it. */
typedef struct reference_material {
  double moduli[6][6];
  double cosserat[6][6];
  bool plane_stress;
  double thickness;
} reference_material;

/* NULL when there is none of this name. */
const reference_element *reference_element_find(const char *kind);

int reference_dofs_of_node(const reference_element *element);

/* "edge", "face" or "body": the smallest entity that holds both nodes. */
const char *reference_class(const reference_element *element, int a, int b);

/* The two corners that mid-edge node `node` lies between. */
void reference_edge_of(const reference_element *element, int node, int corner[2]);

/* Stiffness matrix k[dofs][dofs], rows a * dofs_of_node + component; returns the smallest
 * det(J) at the points of the rule. */
double reference_stiffness(const reference_element *element, const double (*x)[3],
                           const reference_material *material, double *k);

void reference_isotropic(double young, double poisson, double moduli[6][6]);

/* constants: e1 e2 e3 nu12 nu13 nu23 g12 g13 g23 */
void reference_orthotropic(const double constants[9], double moduli[6][6]);

/* Moduli given along the axes (rows of `axis`) turned into x, y, z by C_ijkl. */
void reference_turn(double moduli[6][6], const double axis[3][3]);

/* D11 D12 D1212 D1221 and the couple modulus as the 6 x 6 matrix of the strains above. */
void reference_cosserat_cubic(const double constants[5], double moduli[6][6]);

/* a (n x n) x = b (n x m) by elimination with pivots; a is destroyed, b becomes x. */
void reference_solve(int n, int m, double *a, double *b);

#endif
