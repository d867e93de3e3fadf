/* Private to dem: the specimen of a solver, and the calls between its files.
 *
 * Candidates (grains near nodes) stand as rows of nodes, grains ascending in the internal order,
 * and again as lists of the grains that have any: the force on a grain is added in the order of
 * nodes. Nothing depends on the threads. */
#ifndef CDEM_DEM_CONFINE_H
#define CDEM_DEM_CONFINE_H

#include "dem/confine_host.h"
#include "dem/solver_store.h"

struct cdem_confine {
  cdem_confine_host host;
  /* candidates */
  int64_t *row;         /* [nodes + 1] */
  int32_t *grain;       /* [row[nodes]] internal */
  double *push;         /* [row[nodes]][3] on the grain, N */
  int32_t held;         /* grains that have any */
  int32_t *of;          /* [held] ascending */
  int64_t *entry_start; /* [held + 1] */
  int64_t *entry;       /* candidates of each, ascending */
  int64_t capacity[8];
  int32_t *cell, *cell_grain; /* scratch of the search */
  /* of the last evaluation, ring by ring */
  int32_t *touching;     /* [rings] most of one node */
  int32_t *touching_all; /* [rings] nodes */
  double side_wanted;    /* what the series of the servo of the side points at, N */
};

cdem_status cdem_confine_init(cdem_dem *dem, cdem_fault *fault);
void cdem_confine_release(cdem_dem_core *core);
/* After a build: candidates within the skin. CDEM_NUMERIC: a grain is outside. */
cdem_status cdem_confine_build(cdem_dem *dem, cdem_fault *fault);
/* Damping at the start. */
cdem_status cdem_confine_calm(cdem_dem *dem, cdem_fault *fault);
/* The wanted force of the plate, before walls move; after: the membrane moves to t_n+1. */
void cdem_confine_aim(cdem_dem *dem);
void cdem_confine_move(cdem_dem *dem);
/* By all threads of a team: forces of t_n+1, those on grains are added. */
void cdem_confine_forces(cdem_dem *dem);
/* Once: the book of the evaluation. */
void cdem_confine_after(cdem_dem *dem, double step);
void cdem_confine_change_step(cdem_dem *dem, double old, double step);
/* Stored and kinetic; dissipated; works. */
void cdem_confine_energies(const cdem_dem *dem, cdem_dem_energies *energies);
/* Bound of the step by the nodes; each touch of the membrane: add(context, grain, stiffness, n,
 * beta dashpot). */
double cdem_confine_limit(const cdem_dem *dem);
typedef void cdem_confine_see(void *context, int32_t grain, double stiffness, double dashpot,
                              const double n[3]);
void cdem_confine_visit(const cdem_dem *dem, cdem_confine_see *see, void *context);
cdem_status cdem_confine_save(const cdem_dem *dem, cdem_state *state, cdem_fault *fault);
cdem_status cdem_confine_restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault);

/* Overlap of a node and a grain, unit vector from the grain's centre to the node. */
static inline double cdem_confine_overlap(const double *grain, const double *node, double n[3]) {
  double d2 = 0.0;
  for (int c = 0; c < 3; c++) {
    n[c] = node[c] - grain[c];
    d2 += n[c] * n[c];
  }
  if (d2 >= grain[3] * grain[3] || d2 == 0.0)
    return 0.0;
  double distance = __builtin_sqrt(d2);
  for (int c = 0; c < 3; c++)
    n[c] /= distance;
  return grain[3] - distance;
}

#endif
