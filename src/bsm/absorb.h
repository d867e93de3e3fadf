/* A layer of fine elements that takes away what the coarse medium cannot carry on: waves that are
 * too short for its mesh come back from the interface whole (docs/theory/bsm-waves.md).
 *
 *     F = -c Mp Q v        on the grains of the layer,                                         (1)
 *
 * Q of the projector of the layer's own elements (projector.h). Because N^T Mp Q = 0, these forces
 * have no resultant, no moment and no virtual work with any motion the mesh can express: loads at
 * rest, rigid motions and homogeneous strains do not feel them. They dissipate c times twice the
 * kinetic energy of Q v. Spins are treated as displacements are, each component by itself.
 *
 * v is that of half a step before, as of the dashpots of contacts: stable up to
 * c dt <= 2 (1 - (dt/limit)^2), the limit that of the grains without it. The forces stand in
 * cdem_dem.applied, beside what others have put there; they are found anew after each step of the
 * grains, and are part of its energy book (`applied`).
 */
#ifndef CDEM_BSM_ABSORB_H
#define CDEM_BSM_ABSORB_H

#include "bsm/projector.h"
#include "dem/dem.h"

/* Fine elements next to the outer ones: those that share a node with one, then those that share a
 * node with these, `layers` times. cell [cells] fine cells, ascending; *layer newly allocated,
 * ascending. */
cdem_status cdem_absorb_cells(const cdem_mesh *mesh, int32_t cells, const int32_t *cell, int layers,
                              int32_t *layer_cells, int32_t **layer, cdem_fault *fault);

typedef struct {
  const cdem_mesh *mesh;
  int32_t cells;
  const int32_t *layer; /* [cells] ascending */
  int64_t grains;       /* fine ones; those in other cells are passed over */
  const int32_t *grain; /* [grains] ids in the solver */
  const int32_t *cell;  /* [grains] mesh cells */
  const double *xi;     /* [grains][3] places in them */
  cdem_dem *fine;       /* borrowed; gets `applied` */
  double rate;          /* c, 1/s, > 0 */
} cdem_absorb_options;

typedef struct {
  cdem_dem *fine;
  double rate;
  cdem_projector projector;
  cdem_projector_shape shape;
  int32_t *grain; /* [projector.grains] ids */
  double *motion; /* [projector.grains][6] */
  double *v, *q;  /* [projector.grains][width] velocities, and of them Q v */
  double *force;  /* [projector.grains][6] what now stands in `applied` */
} cdem_absorb;

/* CDEM_INPUT: a rate that is unstable (names the largest), an element whose grains do not determine
 * its nodes. Nothing is applied yet. Release at any stage. */
cdem_status cdem_absorb_init(const cdem_absorb_options *options, cdem_absorb *absorb,
                             cdem_fault *fault);
void cdem_absorb_release(cdem_absorb *absorb);

/* Puts the forces of now in the place of those that stand in `applied`. */
cdem_status cdem_absorb_apply(cdem_absorb *absorb, cdem_fault *fault);
/* `applied` has been cleared by its other user: nothing of the layer stands there. */
void cdem_absorb_forget(cdem_absorb *absorb);
/* The solver of grains has been restored, with the forces of that time in `applied`. */
cdem_status cdem_absorb_restored(cdem_absorb *absorb, cdem_fault *fault);

#endif
