/* Small steps of the closed form, inlined into the kernels: straight-line code without branches or
 * library calls, so that the loop over the lanes becomes vector instructions. */
#ifndef CDEM_SPRINGS_PLANE_H
#define CDEM_SPRINGS_PLANE_H

#include "springs/parts.h"

#include <string.h>

CDEM_ALWAYS_INLINE double cdem_larger(double a, double b) {
  return a > b ? a : b;
}

/* 2^-e and 2^e of a positive normal number's exponent e. Other numbers give factors that spoil the
 * residual, so that their lane is not accepted. */
CDEM_ALWAYS_INLINE void cdem_powers_of_two(double x, double *down, double *up) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  bits &= UINT64_C(0x7ff0000000000000);
  uint64_t inverse = UINT64_C(0x7fe0000000000000) - bits;
  memcpy(up, &bits, sizeof bits);
  memcpy(down, &inverse, sizeof inverse);
}

/* Two springs of a 2x2 block in an orthonormal basis. */
typedef struct {
  double a[2], b[2];  /* unit columns: of the larger value, or Re v; of the other, or Im v */
  double mean, split; /* values mean +- split, or mean +- i split */
  int conjugate;
} cdem_plane_pair;

/* c = [[mean + h, b], [c, mean - h]]. Real: columns (z, c) and (-b, z), z = h +- s of the sign of
 * h. Complex: v = (h + i s, c), turned by the phase that makes |Re v| = |Im v|: with A = |Re|^2, B
 * = |Im|^2, C = Re.Im the angle is tan 2 phi = (A - B) / 2C, and Re.Im > 0 after it. */
CDEM_ALWAYS_INLINE cdem_plane_pair cdem_solve_plane(const double m[4], int symmetric,
                                                    double norm2) {
  const double tiny2 = CDEM_SPRINGS_ROUNDING * CDEM_SPRINGS_ROUNDING;
  double h = 0.5 * (m[0] - m[3]), middle = 0.5 * (m[1] + m[2]);
  double b = symmetric ? middle : m[1], c = symmetric ? middle : m[2];
  int isotropic = 2.0 * h * h + b * b + c * c <= tiny2 * norm2;
  h = isotropic ? 0.0 : h, b = isotropic ? 0.0 : b, c = isotropic ? 0.0 : c;
  double square = h * h + b * c, s = sqrt(fabs(square));
  int conjugate = square < 0.0, swap = h < 0.0;
  double z = isotropic ? 1.0 : h + copysign(s, h);
  double a_minus_b = 2.0 * h * h + c * (b + c), twice_c = 2.0 * h * s, sum = c * (c - b);
  double spread2 = a_minus_b * a_minus_b + twice_c * twice_c;
  int circular = spread2 <= tiny2 * sum * sum;
  /* Weights, not choices: the compiler would branch, and take both roots in every lane. */
  double weight = conjugate ? 1.0 : 0.0, other = 1.0 - weight;
  double length0 = 1.0 / sqrt(weight * (0.5 * sum) + other * (z * z + c * c));
  double length1 = 1.0 / sqrt(weight * spread2 + other * (z * z + b * b) + 1e-300);
  double cosine2 = twice_c * length1, sine2 = a_minus_b * length1;
  double big = sqrt(0.5 + 0.5 * fabs(conjugate ? cosine2 : 1.0)), small = 0.5 * sine2 / big;
  double cosine = cosine2 >= 0.0 ? big : small, sine = cosine2 >= 0.0 ? small : big;
  cosine = circular ? 0.0 : cosine, sine = circular ? 1.0 : sine;
  double plus0 = z * length0, plus1 = c * length0, minus0 = -b * length1, minus1 = z * length1;
  cdem_plane_pair pair = {.mean = 0.5 * (m[0] + m[3]), .split = s, .conjugate = conjugate};
  pair.a[0] = conjugate ? (cosine * h - sine * s) * length0 : swap ? minus0 : plus0;
  pair.a[1] = conjugate ? cosine * c * length0 : swap ? minus1 : plus1;
  pair.b[0] = conjugate ? (sine * h + cosine * s) * length0 : swap ? plus0 : minus0;
  pair.b[1] = conjugate ? sine * c * length0 : swap ? plus1 : minus1;
  return pair;
}

#endif
