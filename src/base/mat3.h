/* Small vectors and 3x3 matrices, row-major: m[3*i + j] is row i, column j. Plain inline functions.
 */
#ifndef CDEM_BASE_MAT3_H
#define CDEM_BASE_MAT3_H

#include <math.h>

static inline double cdem_dot3(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double cdem_norm3(const double a[3]) {
  return sqrt(cdem_dot3(a, a));
}

static inline void cdem_cross3(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double cdem_det3(const double m[9]) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/* out = inverse of m by the adjugate; the determinant is returned and must be tested by the caller
 * (out holds infinities when it is zero). */
static inline double cdem_inverse3(const double m[9], double out[9]) {
  double det = cdem_det3(m), r = 1.0 / det;
  out[0] = (m[4] * m[8] - m[5] * m[7]) * r;
  out[1] = (m[2] * m[7] - m[1] * m[8]) * r;
  out[2] = (m[1] * m[5] - m[2] * m[4]) * r;
  out[3] = (m[5] * m[6] - m[3] * m[8]) * r;
  out[4] = (m[0] * m[8] - m[2] * m[6]) * r;
  out[5] = (m[2] * m[3] - m[0] * m[5]) * r;
  out[6] = (m[3] * m[7] - m[4] * m[6]) * r;
  out[7] = (m[1] * m[6] - m[0] * m[7]) * r;
  out[8] = (m[0] * m[4] - m[1] * m[3]) * r;
  return det;
}

/* out = a b; out must not alias a or b. */
static inline void cdem_product3(const double a[9], const double b[9], double out[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

/* Frobenius norm of n entries. */
static inline double cdem_frobenius(const double *m, int n) {
  double sum = 0.0;
  for (int i = 0; i < n; i++)
    sum += m[i] * m[i];
  return sqrt(sum);
}

#endif
