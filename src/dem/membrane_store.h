/* Private to dem: what a membrane keeps beside membrane.h. */
#ifndef CDEM_DEM_MEMBRANE_STORE_H
#define CDEM_DEM_MEMBRANE_STORE_H

#include "dem/membrane.h"

enum { CDEM_MEMBRANE_NEAR = 6 };

/* Sums since the start, J. */
enum { CDEM_MEMBRANE_PRESSED, CDEM_MEMBRANE_PLATES, CDEM_MEMBRANE_DAMPED, CDEM_MEMBRANE_SUMS };

struct cdem_membrane_store {
  int32_t *near;   /* [nodes][6] neighbours, around the node; end rings: the two in the ring, -1 */
  int32_t *corner; /* [nodes][6] face * 3 + corner, ascending; -1 */
  double *inverse; /* [faces][4] of the edges at rest in the plane of the face, 1/m */
  double *rest;    /* [faces] area at rest, m^2 */
  double *pull;    /* [faces][3][3] stretch force on each corner, N */
  double *normal;  /* [faces][3] area vector, m^2 */
  double *stored;  /* [faces] J */
  int32_t *taker;  /* [nodes][6] the nodes in whose D each node stands; -1 */
  double *bent;    /* [nodes][3] b (g Dx, g Dy, Dz), N */
  double *rate;    /* [nodes][3] dashpot times dD/dt, N */
  double *mean;    /* [rings][6] place and velocity */
  double *size;    /* [rings][2] g, and the outward force by distance from the axis, N/m */
  double *band;    /* [rings] volume of the faces above each, about the axis' low end, m^3 */
  double *press;   /* [nodes][3] part of the force that is pressure, N */
  double *damp;    /* [nodes][3] ... that is damping, N */
  double *marked;  /* [nodes][3] */
  double round[2]; /* c of D: end rings, others */
  double stiff[2], dash[2]; /* b, N/m, and its dashpot, N s/m: end rings, others */
  double sum[CDEM_MEMBRANE_SUMS];
};

static inline bool cdem_membrane_is_end(const cdem_membrane *m, int32_t node) {
  return node < m->around || node >= m->nodes - m->around;
}

#endif
