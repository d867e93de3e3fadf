/* Room springs: one stiffness block <-> one spring set. It sees dense blocks, never meshes.
 *
 * The spring tensor of a node pair is S = -K_ij: the force on i from j is S (u_j - u_i). Its real
 * canonical form S = P L P^-1 (Wei et al. 2006, eqs 6-11) is a set of springs: columns of P are
 * force directions of unit length (dir), rows of P^-1 measure displacement (dual), L holds
 * stiffnesses and couplings. Written as rows,
 *
 *     S = sum over rows of dir (x) (stiffness * dual + coupling * dual[spring couples_to]) (1)
 *
 * Forms
 *
 * - diagonal: two or three springs, no coupling; stiffness descending. Equal stiffnesses leave
 *   their plane's directions free: the first is then chosen as for a frame, the second is normal to
 *   it; three equal ones lie along the axes.
 *
 * - complex: (3-D) spring 1 real, springs 2 and 3 the pair a +- ib: dirs Re v and Im v, |Re v| =
 *   |Im v|, row 2 couples +b to 3, row 3 couples -b to 2, b > 0. 2x2 blocks: springs 1 and 2 are
 * the pair.
 *
 * - jordan2: spring 1 real, springs 2 and 3 an orthonormal pair with row 2 coupled to 3 (2x2: 1 and
 *   2).
 *
 * - jordan3: three orthonormal springs, row 1 coupled to 2, row 2 to 3; a coupling of row 1 to 3 is
 *   an extra row with the same spring, dir and dual and stiffness 0.
 *
 * - frame: transversely isotropic symmetric blocks S = k1 d d^T + k2 (I - d d^T): one spring along
 * d and three in the normal plane 120 degrees apart, each h = (2/3) k2; dual = dir, no P.
 *
 * Near a defect neither the diagonal nor the exact Jordan form keeps 1e-12, so when cond(P) of the
 * eigenvectors exceeds CDEM_SPRINGS_MAX_COND the plane of the nearly equal pair is kept in an
 * orthonormal basis as a standardised real Schur block: [[k2, s], [0, k3]] is called jordan2 (k2
 * and k3 may differ slightly);
 * [[a, b], [c, a]] with bc < 0 is called complex. When even the separation of that plane from
 * spring 1 is worse than CDEM_SPRINGS_MAX_COND, the whole block is kept in its orthonormal Schur
 * basis: jordan3, or complex with spring 1 coupled to 2 and 3. Equation (1) then holds to 1e-12 of
 * |S| at any distance from a defect.
 *
 * Differences below 1e-14 |S| are rounding of the block and choose no form: such a skew part leaves
 * it symmetric (P orthonormal, dual = dir), such a coupling leaves it diagonal, such a split of two
 * values leaves them equal. A block times a power of two has the same directions, bit by bit.
 *
 * Signs and order are canonical: the last component of dir that exceeds 1e-6 in size is positive
 * (complex: of Re v, and then Im v follows from b > 0 with Re v . Im v >= 0); diagonal stiffnesses
 * descend.
 */
#ifndef CDEM_SPRINGS_SPRINGS_H
#define CDEM_SPRINGS_SPRINGS_H

#include "base/base.h"

#include <stdbool.h>

/* X(NAME, name) */
#define CDEM_FORMS(X)                                                                              \
  X(DIAGONAL, diagonal) X(JORDAN2, jordan2) X(JORDAN3, jordan3) X(COMPLEX, complex) X(FRAME, frame)
#define CDEM_CLASSES(X) X(EDGE, edge) X(FACE, face) X(BODY, body)

typedef enum {
#define X(NAME, name) CDEM_FORM_##NAME,
  CDEM_FORMS(X)
#undef X
      CDEM_FORM_COUNT
} cdem_form;

/* Class of a pair: dimension of the smallest entity of the element that holds both nodes, minus
 * one. */
typedef enum {
#define X(NAME, name) CDEM_CLASS_##NAME,
  CDEM_CLASSES(X)
#undef X
      CDEM_CLASS_COUNT
} cdem_class;

const char *cdem_form_name(cdem_form form);
const char *cdem_class_name(cdem_class class_);
/* By name; CDEM_FORM_COUNT / CDEM_CLASS_COUNT when there is none. */
cdem_form cdem_form_find(const char *name);
cdem_class cdem_class_find(const char *name);

#define CDEM_SPRINGS_MAX_COND 1e3 /* switch from eigenvectors to Schur blocks */
#define CDEM_SPRINGS_FRAME_BOUND                                                                   \
  2e-13 /* |S - transversely isotropic| / |S| below which a block is a frame */
#define CDEM_SPRINGS_BOUND 1e-12 /* what equation (1) promises, relative to the Frobenius norm */

enum { CDEM_SPRING_ROWS = 4 };

/* One term of equation (1). 2x2 blocks leave the third component zero. */
typedef struct {
  double stiffness, coupling;
  double dir[3], dual[3];
  int8_t spring;     /* 1-based number of the spring */
  int8_t couples_to; /* 1-based, 0: none */
} cdem_spring_row;

/* One spring set. */
typedef struct {
  double cond;  /* 2-norm condition number of P; NaN for frames */
  uint8_t form; /* cdem_form */
  uint8_t size; /* 2 or 3 */
  uint8_t rows; /* 2 .. 4 */
  uint8_t slow; /* 1: this block took the robust path (statistics only) */
  cdem_spring_row row[CDEM_SPRING_ROWS];
} cdem_spring_set;

/* Reference path, one block at a time: LAPACK eigenvalues, vectors and Schur form. s [size*size]
 * row-major, N/m. A zero block gives a diagonal set of zero stiffness along the axes. frame:
 * recognise frames. CDEM_NUMERIC when the block is not finite. */
cdem_status cdem_springs_from_block(const double *s, int size, bool frame, cdem_spring_set *set,
                                    cdem_fault *fault);

/* Fast path: n blocks of one size. s is in batches of 8 side by side: entry e of block i stands at
 * s[(i/8)*size*size*8 + e*8 + i%8]; the last batch is padded by repeating a valid block (any finite
 * values). frame [n] (NULL: nowhere): recognise frames for block i. Blocks for which the closed
 * form does not reach CDEM_SPRINGS_BOUND/10 are done again by the robust path. set [n]. Serial;
 * call it from many threads. A set does not depend on the other blocks. CDEM_NUMERIC when a block
 * is not finite, with its index; all n sets are then zero. */
cdem_status cdem_springs_from_blocks(const double *s, int64_t n, int size, const bool *frame,
                                     cdem_spring_set *set, cdem_fault *fault);

/* The same, each set to a place of its own: set [n]; NULL for a block that only fills a lane. */
cdem_status cdem_springs_from_blocks_to(const double *s, int64_t n, int size, const bool *frame,
                                        cdem_spring_set *const *set, cdem_fault *fault);

/* Equation (1): s [size*size] row-major from the rows alone. */
void cdem_springs_rebuild(const cdem_spring_set *set, double *s);

/* |S - rebuilt|_F / |S|_F; 0 for a zero block that is rebuilt as zero. */
double cdem_springs_residual(const double *s, const cdem_spring_set *set);

/* Skew fraction |S - S^T|_F / (2 |S|_F); 0 for a zero block. */
double cdem_springs_skew(const double *s, int size);

/* The four springs of a frame from k1, k2 and the unit vector d (the body diagonal rule of
 * springs.md: first direction = projection of the global axis least aligned with d, ties to z, then
 * +120 degrees twice about d). */
void cdem_springs_frame(double k1, double k2, const double d[3], cdem_spring_set *set);

#endif
