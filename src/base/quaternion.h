/* Rotations as unit quaternions (w x y z). Plain inline functions. */
#ifndef CDEM_BASE_QUATERNION_H
#define CDEM_BASE_QUATERNION_H

#include "base/mat3.h"

/* The rotation as a matrix, row-major. */
static inline void cdem_quaternion_matrix(const double q[4], double m[9]) {
  double w = q[0], x = q[1], y = q[2], z = q[3];
  m[0] = 1.0 - 2.0 * (y * y + z * z);
  m[1] = 2.0 * (x * y - w * z);
  m[2] = 2.0 * (x * z + w * y);
  m[3] = 2.0 * (x * y + w * z);
  m[4] = 1.0 - 2.0 * (x * x + z * z);
  m[5] = 2.0 * (y * z - w * x);
  m[6] = 2.0 * (x * z - w * y);
  m[7] = 2.0 * (y * z + w * x);
  m[8] = 1.0 - 2.0 * (x * x + y * y);
}

/* out = r q, q first; out must alias neither. */
static inline void cdem_quaternion_product(const double r[4], const double q[4], double out[4]) {
  double cross[3];
  cdem_cross3(r + 1, q + 1, cross);
  out[0] = r[0] * q[0] - cdem_dot3(r + 1, q + 1);
  for (int c = 0; c < 3; c++)
    out[1 + c] = r[0] * q[1 + c] + q[0] * r[1 + c] + cross[c];
}

static inline void cdem_quaternion_normalise(double q[4]) {
  double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int k = 0; k < 4; k++)
    q[k] /= norm;
}

#endif
