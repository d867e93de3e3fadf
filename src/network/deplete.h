/* Depletion: what is left when springs are taken out of an exact network.
 *
 * An exact network must not lose single springs: non-axial springs do work in a rigid rotation, and
 * only the full set cancels. The three measures say whether a given removal is safe: no negative
 * eigenvalue of the symmetric part, a symmetric matrix, and every rigid mode still free of force
 * (springs.md section 5).
 *
 * Taking a spring out removes its force, in all its rows, and the couplings of other springs to its
 * elongation.
 */
#ifndef CDEM_NETWORK_DEPLETE_H
#define CDEM_NETWORK_DEPLETE_H

#include "network/assemble.h"

/* Which springs go; every condition that is set must hold. Tags are the mesh file's. */
typedef struct {
  const char *text; /* as the user wrote it, for messages */
  int64_t element;  /* 0: any */
  int64_t node[2];  /* the pair, in any order; 0: any */
  int class_;       /* cdem_class; -1: any */
  int form;         /* cdem_form; -1: any */
  int spring;       /* number within the pair; 0: all of it */
} cdem_removal;

typedef struct {
  int64_t pairs, springs; /* touched pairs, removed springs */
  double norm;            /* bound of the eigenvalues of what is left, N/m */
  double lowest;          /* eigenvalue of the symmetric part, N/m */
  int64_t negative_modes; /* of the balanced matrix (spectrum.h) */
  int64_t zero_modes;     /* likewise */
  double skew;            /* |K - K^T| / (2 |K|) */
  int rigid_modes;        /* 3 or 6 */
  int rigid_lost;         /* rigid modes that now meet a force */
  bool safe;              /* negative_modes 0, skew <= 1e-10, rigid_lost 0 */
} cdem_depletion;

/* mode_rows: larger matrices are refused (CDEM_INPUT), since the eigenvalues take sparse
 * factorisations. */
typedef struct {
  int removals;
  const cdem_removal *removal; /* [removals] */
  int64_t mode_rows;
} cdem_depletion_options;

/* Measures what is left without the union of the removals. CDEM_INPUT when one matches no spring.
 */
cdem_status cdem_network_deplete(const cdem_model *model, const cdem_convert_options *convert,
                                 const cdem_depletion_options *options, cdem_depletion *depletion,
                                 cdem_fault *fault);

#endif
