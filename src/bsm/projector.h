/* The projector of the bridging scale (Li & Wan 2010, eqs 3-8): what of the motion of grains a mesh
 * can express.
 *
 *     M = N^T Mp N,   P = N M^-1 N^T Mp,   Q = 1 - P,   q = N d + Q q  with  d = M^-1 N^T Mp q
 *
 * N: shape functions of the fine region's nodes at the centres of its grains. Mp: masses for
 * displacements, moments of inertia for rotations; both M are consistent and factorised, P is never
 * formed. (With a lumped M, P^2 would not be P.) Then P^2 = P, Q N = 0, N^T Mp Q = 0, fields that
 * are linear in a cell are reproduced, and kinetic energy is the sum of that of P v and that of Q
 * v.
 *
 * All nodes of the fine region's elements take part, those on its edge too; which of them move by
 * the coarse medium instead is for the coupling to say.
 */
#ifndef CDEM_BSM_PROJECTOR_H
#define CDEM_BSM_PROJECTOR_H

#include "bsm/weights.h"

typedef struct cdem_projector_factors cdem_projector_factors; /* private: the two M, factorised */

typedef struct {
  int64_t grains;
  int32_t nodes;        /* of the fine region */
  int32_t *node;        /* [nodes] mesh node ids, ascending */
  cdem_weights weights; /* by positions in `node` */
  double *mass;         /* [grains] kg */
  double *inertia;      /* [grains] kg m^2 */
  cdem_projector_factors *factors;
} cdem_projector;

/* Grains in cells: cell [grains] mesh ids (ascending lists of `cells` fine_cell), xi [grains][3],
 * as cdem_locate found them; mass, inertia [grains] > 0. CDEM_INPUT: an element whose grains do not
 * determine its nodes, too few or all on a line (names element, place and count). Zero-initialise,
 * release at any stage. */
typedef struct {
  const cdem_mesh *mesh;
  int32_t cells;
  const int32_t *fine_cell;
  int64_t grains;
  const int32_t *cell;
  const double *xi, *mass, *inertia;
} cdem_projector_options;
cdem_status cdem_projector_init(const cdem_projector_options *options, cdem_projector *projector,
                                cdem_fault *fault);
void cdem_projector_release(cdem_projector *projector);

/* A field of grains, q [grains][translations + rotations]; the same widths for nodes. */
typedef struct {
  int translations, rotations;
} cdem_projector_shape;

/* d [nodes][width] = M^-1 N^T Mp q. CDEM_MEMORY, CDEM_NUMERIC (a number that is none). */
cdem_status cdem_projector_project(const cdem_projector *projector, cdem_projector_shape shape,
                                   const double *q, double *d, cdem_fault *fault);
/* coarse [grains][width] = P q, fine = Q q; either may be NULL. */
cdem_status cdem_projector_split(const cdem_projector *projector, cdem_projector_shape shape,
                                 const double *q, double *coarse, double *fine, cdem_fault *fault);
/* 1/2 v Mp v of a velocity field, J; its sum over all grains in their order. */
double cdem_projector_energy(const cdem_projector *projector, cdem_projector_shape shape,
                             const double *v);
/* Row sums of N^T Mp: lumped masses and inertias of the fine region's nodes, [nodes]. */
void cdem_projector_lumped(const cdem_projector *projector, double *mass, double *inertia);

#endif
