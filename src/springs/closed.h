/* Closed forms: spring sets that are known on paper (Wei et al. 2006, section 3 and 4; theory in
 * docs/theory/springs.md, misprints of the source in docs/theory/errata-wei-2006.md).
 *
 * They are here to be compared with, not to compute with: each one is checked against the blocks of
 * the element it speaks of, for all three forms. c = E L/((1 + mu)(1 - 2 mu)) throughout; a sheet's
 * formulas are written in lambda and G, so that plane stress is the same formula with
 * lambda = E mu/(1 - mu^2) in place of E mu/((1 + mu)(1 - 2 mu)).
 *
 * Order of the stiffnesses is the source's: in a diagonal set k[0] and k[1] are the values with the
 * root, + before -, and k[2] is the third one. In complex and jordan2 sets k[0] is the single value
 * and k[1] = k[2] the pair (2x2: k[0] = k[1]), with `coupling` the imaginary part, or the Jordan
 * coupling, of the convention of springs.h. Directions are unit vectors with canonical signs; in
 * complex and jordan2 sets they belong to that coupling.
 */
#ifndef CDEM_SPRINGS_CLOSED_H
#define CDEM_SPRINGS_CLOSED_H

#include "springs/springs.h"

typedef struct {
  cdem_form form; /* diagonal, complex or jordan2 */
  int size;       /* 2 or 3 */
  double k[3];    /* N/m */
  double coupling;
  double frame_h;   /* stiffness of each of the three transverse springs of a frame; else NaN */
  double dir[3][3]; /* [spring][component] */
} cdem_closed;

/* A cube of side length (m), one point per half side in each direction (hex8, 2x2x2 Gauss). */
typedef struct {
  double young, poisson, length;
} cdem_closed_solid;

/* A sheet: plane strain unless plane_stress. */
typedef struct {
  double young, poisson, thickness;
  bool plane_stress;
} cdem_closed_sheet;

/* One cube of hex8. Pairs: edge 1-2 along x, face diagonal 1-3 in xy, body diagonal 1-7. Directions
 * of the body pair: the diagonal, then the canonical basis of the normal plane. Eqs (13)-(22). */
void cdem_closed_cube(cdem_class class_, const cdem_closed_solid *solid, cdem_closed *closed);

/* The same pairs inside a regular block of cubes, all cubes around the pair summed: the network of
 * Gusev 2004 (Wei et al., table 5). k[0] along the pair, k[1] = k[2] across. */
void cdem_closed_cube_interior(cdem_class class_, const cdem_closed_solid *solid,
                               cdem_closed *closed);

/* One rectangle of quad4 (2x2 Gauss). Edge of length `along` in x; the other side is `across`. */
void cdem_closed_rectangle_edge(const cdem_closed_sheet *sheet, double along, double across,
                                cdem_closed *closed);
/* Its diagonal 1-3, from the origin to (width, height): symmetric, hence always diagonal. */
void cdem_closed_rectangle_diagonal(const cdem_closed_sheet *sheet, double width, double height,
                                    cdem_closed *closed);

/* Equilateral tri3, bond along x: the pair of one triangle, and of the two triangles that share an
 * inner bond (source, section 4: along the bond, then across). Any side length. */
void cdem_closed_triangle_edge(const cdem_closed_sheet *sheet, cdem_closed *closed);
void cdem_closed_triangle_interior(const cdem_closed_sheet *sheet, cdem_closed *closed);

/* The block a closed form stands for: s [size*size] row-major, P L P^-1 (Cramer's rule; for tests
 * and verification). */
void cdem_closed_rebuild(const cdem_closed *closed, double *s);

#endif
