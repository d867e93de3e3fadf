/* Grains that move with a body: displacements and spins of grains from those of nodes, and forces
 * back by the same numbers, so that the work is the same on both sides.
 *
 *     v_a = sum over I of N_I(x_a) v_I                                                       (1)
 *     w_a = sum over I of N_I(x_a) w_I          nodes that rotate (plane Cosserat)           (2)
 *     w_a = 1/2 curl v (x_a)                    others: the spin of the continuum            (3)
 *
 * N at the places at the start (Li & Wan 2010, eq. 17).
 */
#ifndef CDEM_BSM_TIE_H
#define CDEM_BSM_TIE_H

#include "bsm/weights.h"

typedef struct {
  int dim, dofs; /* of nodes: 2, or 3 (2-D: Cosserat) */
  int64_t grains;
  int32_t *grain;       /* [grains] ids in the solver of grains */
  cdem_weights weights; /* nodes: ids of the body */
  int32_t nodes;
  int32_t *node; /* [nodes] of the body that some grain moves with, ascending */
} cdem_tie;

/* cell [grains] cells of the body's mesh, xi [grains][3] places in them. Release at any stage. */
cdem_status cdem_tie_init(const cdem_mesh *mesh, int dofs, int64_t grains, const int32_t *grain,
                          const int32_t *cell, const double *xi, cdem_tie *tie, cdem_fault *fault);
void cdem_tie_release(cdem_tie *tie);

/* motion [grains][6] of velocities (or displacements) of nodes v [nodes of the body][dofs]. */
void cdem_tie_motion(const cdem_tie *tie, const double *v, double *motion);
/* force [nodes of the body][dofs] += what forces and moments on [grains][6] do there. */
void cdem_tie_forces(const cdem_tie *tie, const double *on, double *force);
/* Bound of the squared frequency that springs on the grains add to nodes of these masses,
 * (rad/s)^2: stiffness, turning [grains] N/m, N m/rad; mass [nodes of the body][dofs]. By row sums.
 * Springs may couple place and spin, as shear springs at the surface of a grain do: the frequencies
 * of both are added where the same unknowns give both, else their squares. CDEM_MEMORY. */
cdem_status cdem_tie_frequency2(const cdem_tie *tie, const double *stiffness, const double *turning,
                                const double *mass, double *bound, cdem_fault *fault);

#endif
