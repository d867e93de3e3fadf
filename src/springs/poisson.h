/* Springs against Poisson's ratio: how one pair's spring set changes with nu, and where its form
 * does (Wei et al. 2006, section 3; theory in docs/theory/springs.md).
 *
 * A family is a block S(nu) that becomes linear in nu when multiplied with a positive factor:
 * (1 + nu)(1 - 2 nu) in solids and plane strain, 1 - nu^2 in plane stress, because the moduli times
 * that factor are. The factor scales stiffnesses and leaves forms and directions alone. So
 *
 *     factor(nu) S(nu) = A + nu B                                                        (1)
 *
 * is a pencil, and the discriminant of its characteristic polynomial is a polynomial in nu, of
 * degree 6 (3x3) or 2 (2x2). Its zeros on the open range are the critical ratios: at a zero of odd
 * order two real values become a complex pair, at a zero of even order two values touch. A touch is
 * of second order when two values cross and of fourth order when they kiss, as the face pair of the
 * cube does at nu = 1/4; such a zero loses three quarters of the digits when it is looked for in
 * double precision, so the polynomial is made and solved in 113 bits from A and B, and a zero of
 * order m is placed where its (m-1)-st derivative vanishes, which the rounding of A and B moves by
 * no more than its own size.
 *
 * Between two critical ratios no two values are equal, so a real value keeps its rank; the order of
 * k1, k2, k3 on each interval follows from one anchor (the closed form where one is known, else
 * descending order on the interval of nu = 1/4) by crossing the critical ratios one by one.
 */
#ifndef CDEM_SPRINGS_POISSON_H
#define CDEM_SPRINGS_POISSON_H

#include "springs/closed.h"
#include "springs/springs.h"

/* Right-hand side of equation (1), row-major, on the open range low < nu < high. */
typedef struct {
  int size; /* 2 or 3 */
  double a[9], b[9];
  double low, high;
} cdem_pencil;

/* One critical ratio. from = to: a touch. */
typedef struct {
  double nu;
  cdem_form from, to; /* diagonal or complex: below and above nu */
  int order;          /* of the discriminant's zero */
  bool upper;         /* 3x3: the two larger of the three real values meet, else the two smaller */
  bool triple;        /* all three meet */
} cdem_poisson_root;

enum { CDEM_POISSON_ROOTS = 6 };

typedef struct {
  int count;
  cdem_poisson_root root[CDEM_POISSON_ROOTS]; /* ascending */
  bool double_everywhere; /* two values are equal at every nu: then only triple values are roots */
  cdem_form start;        /* above `low`; diagonal when double everywhere */
} cdem_poisson_roots;

/* Two values nearer than this, relative to the block's norm, are equal: where a defect meets a
 * touch the rounding 1e-16 of a block parts them by its root, 1e-8. Nothing a mesh does by chance
 * comes as near, and a critical ratio at an end of the range, which is none, is known by the same
 * measure. */
#define CDEM_POISSON_TOUCH 1e-7

/* All critical ratios of a pencil. */
void cdem_poisson_find_roots(const cdem_pencil *pencil, cdem_poisson_roots *roots);

/* Where a family comes from. Borrowed by the study. */
typedef struct {
  int size;
  void *context;
  /* S(nu), row-major [size*size], N/m. */
  cdem_status (*block)(void *context, double nu, double *s, cdem_fault *fault);
  double (*factor)(double nu);
  /* The closed form at nu, false where none is known; NULL: nowhere. */
  bool (*closed)(void *context, double nu, cdem_closed *closed);
  bool frame; /* look for the four springs of a transversely isotropic block */
  double low, high;
} cdem_poisson_family;

double cdem_poisson_factor_solid(double nu);        /* (1 + nu)(1 - 2 nu): solids, plane strain */
double cdem_poisson_factor_plane_stress(double nu); /* 1 - nu^2 */

typedef struct {
  cdem_poisson_family family;
  cdem_pencil pencil;
  cdem_poisson_roots roots;
  /* Order on the interval below root i (and above the last): label[rank] = position of the value
   * with that rank, largest first. Complex intervals: where the values go on coming back. */
  int8_t label[CDEM_POISSON_ROOTS + 1][3];
} cdem_poisson_study;

/* CDEM_USAGE when the factor does not make the block linear. Owns nothing. */
cdem_status cdem_poisson_study_init(const cdem_poisson_family *family, cdem_poisson_study *study,
                                    cdem_fault *fault);

/* One row of the table. Absent numbers are NaN. */
typedef struct {
  double nu;
  int size; /* 0: no row yet */
  cdem_form form;
  double k[3]; /* order of closed.h */
  double coupling, frame_h, cond;
  double closed[3], difference; /* max |k - closed| / max |closed| */
  double dir[3][3];             /* [spring][component], as in closed.h */
} cdem_poisson_row;

/* The row at nu, with the canonical signs of springs.h. At a touch (and so near it that directions
 * drown in rounding) the directions are those of the neighbourhood, continued; the pair of a block
 * that is double everywhere lies along the projection of the axis least aligned with its normal.
 * CDEM_INPUT outside the family's range. */
cdem_status cdem_poisson_at(const cdem_poisson_study *study, double nu, cdem_poisson_row *row,
                            cdem_fault *fault);

/* Replaces *row by the row at nu, following the signs of directions from the row that was there
 * (size 0: starts anew). */
cdem_status cdem_poisson_follow(const cdem_poisson_study *study, double nu, cdem_poisson_row *row,
                                cdem_fault *fault);

#endif
