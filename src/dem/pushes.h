/* Statistics of contacts from a plain list: rigid grains, or the clusters of deformable ones
 * (clusters.h), whoever made it.
 *
 * Contacts between grains and contacts with a boundary (plate, wall, membrane: b < 0) are counted
 * apart. A list may leave the boundary out; coordination then knows nothing of it. What pushes too
 * little does not count: `cutoff` times the mean push of all that push.
 *
 * Sources: forces over their mean and shares of strong (above 4) and weak (below 0.2) ones after
 * Wang et al. (2024), figures 9, 10; fabric and anisotropy as in measures.h.
 */
#ifndef CDEM_DEM_PUSHES_H
#define CDEM_DEM_PUSHES_H

#include "dem/dem.h"
#include "results/results.h"

typedef struct {
  int64_t a, b;     /* grains; b < 0: a boundary */
  double normal[3]; /* unit, from a to b */
  double push;      /* normal force, N, >= 0 */
  double point[3];  /* m */
} cdem_push;

enum { CDEM_PUSH_GRAINS, CDEM_PUSH_BOUNDARY, CDEM_PUSH_KINDS };
typedef struct {
  int64_t contacts[CDEM_PUSH_KINDS]; /* that count */
  double mean[CDEM_PUSH_KINDS];      /* push, N; 0 without contacts */
  double largest;                    /* between grains, N */
  double strong, weak;               /* share of those between grains above 4, below 0.2 means */
  double fabric[9];                  /* mean of n (x) n, between grains */
  double anisotropy;                 /* of it, as cdem_assembly.anisotropy */
  double coordination;               /* contacts a grain, of both kinds */
  double mechanical, rattlers;       /* ... of grains with two at least; share of all others */
} cdem_push_statistics;

/* CDEM_INPUT: a grain out of range; CDEM_MEMORY. */
cdem_status cdem_push_measure(int dim, int64_t grains, int64_t contacts, const cdem_push *push,
                              double cutoff, cdem_push_statistics *statistics, cdem_fault *fault);

/* Distribution of the pushes between grains over their mean: rows of a table (push_over_mean, the
 * middle of a bin; contacts; density, whose integral over all pushes is 1). Bins are equally wide
 * in the logarithm, from `low` to `high` means. */
cdem_status cdem_push_distribution(int64_t contacts, const cdem_push *push, int bins, double low,
                                   double high, cdem_table *table, cdem_fault *fault);

/* Contacts of a solver of rigid grains, walls among them but without those of a membrane, that
 * push. A new array; free() it. */
cdem_status cdem_dem_pushes(const cdem_dem *dem, int64_t *contacts, cdem_push **push,
                            cdem_fault *fault);

#endif
