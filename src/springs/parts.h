/* What the files of this room share and nobody else sees. */
#ifndef CDEM_SPRINGS_PARTS_H
#define CDEM_SPRINGS_PARTS_H

#include "base/simd.h"
#include "springs/springs.h"

#include <math.h>
#include <stdint.h>

/* Deviations of a block below this share of |S|_F are the rounding of whoever made the block, so
 * they choose no form: a skew part makes no block unsymmetric, a coupling no Jordan block, a
 * difference no two stiffnesses. It is a tenth of the bound that the fast path must reach. */
#define CDEM_SPRINGS_ROUNDING 1e-14

/* Components of a direction below this are zero when signs and axes are chosen. */
#define CDEM_SPRINGS_TIE 1e-6

/* The global axis least aligned with the unit vector n, as a unit vector; of equals the last. */
CDEM_ALWAYS_INLINE void cdem_springs_least_axis(const double n[3], double axis[3]) {
  double x = fabs(n[0]) + CDEM_SPRINGS_TIE, y = fabs(n[1]) + CDEM_SPRINGS_TIE, z = fabs(n[2]);
  double other = fabs(n[1]) <= x ? 1.0 : 0.0; /* y rather than x */
  axis[2] = z <= (x < y ? x : y) ? 1.0 : 0.0;
  axis[1] = (1.0 - axis[2]) * other;
  axis[0] = (1.0 - axis[2]) * (1.0 - other);
}

/* Directions of a plane that no eigenvector chooses: u is the projection of the least aligned axis
 * on the plane with unit normal n, w = n x u. */
CDEM_ALWAYS_INLINE void cdem_springs_plane_basis(const double n[3], const double axis[3],
                                                 double u[3], double w[3]) {
  double part = n[0] * axis[0] + n[1] * axis[1] + n[2] * axis[2];
  double scale = 1.0 / sqrt(1.0 - part * part); /* part^2 <= 1/3 */
  u[0] = (axis[0] - part * n[0]) * scale;
  u[1] = (axis[1] - part * n[1]) * scale;
  u[2] = (axis[2] - part * n[2]) * scale;
  w[0] = n[1] * u[2] - n[2] * u[1];
  w[1] = n[2] * u[0] - n[0] * u[2];
  w[2] = n[0] * u[1] - n[1] * u[0];
}

/* +1 or -1: the factor that makes the last component above the tie bound positive. */
CDEM_ALWAYS_INLINE double cdem_springs_sign(const double v[3]) {
  double last = fabs(v[1]) > CDEM_SPRINGS_TIE ? v[1] : v[0];
  return copysign(1.0, fabs(v[2]) > CDEM_SPRINGS_TIE ? v[2] : last);
}

/* scaled [n] = s 2^-exponent with the largest entry in [1, 2); a zero block stays with exponent 0.
 * False when an entry is not finite. */
bool cdem_springs_scale(const double *s, int n, double *scaled, int *exponent);

/* Writes the frame of a 3x3 block and returns true when it is one: |S - (k1 d d^T + k2 (I - d
 * d^T))| <= CDEM_SPRINGS_FRAME_BOUND |S| and |k1 - k2| > CDEM_SPRINGS_TIE |S| (else the axis has no
 * direction). */
bool cdem_springs_recognise_frame(const double s[9], cdem_spring_set *set);

#endif
