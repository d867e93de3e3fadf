/* The robust path's own algebra, in extended precision: LAPACK finds the values and a first set of
 * vectors in double precision, a Newton step and the last operations here leave nothing but the
 * rounding of the stored numbers. Where long double is double, the path still holds its bound. */
#ifndef CDEM_SPRINGS_EXTENDED_H
#define CDEM_SPRINGS_EXTENDED_H

#include "springs/springs.h"

/* A block S = P L P^-1 on its way to a set; scaled to entries of size 1. */
typedef struct {
  int size;
  cdem_form form;
  long double p[3][3]; /* [spring][component] columns of P */
  long double q[3][3]; /* [spring][component] rows of P^-1 */
  long double l[3][3]; /* row = spring that pulls, column = spring that measures */
  double cond;
} cdem_canonical;

/* A 2x2 block [[mean + h, b], [c, mean - h]] in an orthonormal basis. */
typedef struct {
  long double mean, h, b, c;
} cdem_plane;

static inline long double cdem_dot3l(const long double a[3], const long double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cdem_cross3l(const long double a[3], const long double b[3],
                                long double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/* out = m v, m row-major. */
static inline void cdem_multiply3l(const long double m[9], const long double v[3],
                                   long double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = cdem_dot3l(m + 3 * i, v);
}

/* Is the difference of the plane's two springs, and every coupling, below `bound`? */
bool cdem_plane_isotropic(const cdem_plane *plane, long double bound);

/* Eigenvectors: unit columns a, b [2] and l [2][2] of the form diagonal or complex (of equal
 * lengths |Re v| = |Im v|). False for an exact defect. An isotropic plane keeps its basis. */
bool cdem_plane_eigenvectors(const cdem_plane *plane, long double bound, long double a[2],
                             long double b[2], long double l[2][2], cdem_form *form);

/* Orthonormal columns a, b with l the standardised real Schur block: [[k2, s], [0, k3]] with k2 >=
 * k3 (jordan2) or [[m, b], [c, m]] with b c < 0, |b| >= |c| (complex). A coupling c or a split
 * below `bound` is zero. */
void cdem_plane_schur(const cdem_plane *plane, long double bound, long double a[2],
                      long double b[2], long double l[2][2], cdem_form *form);

/* Fills q from p, and cond by LAPACK's singular values. False when P is singular. */
bool cdem_canonical_invert(cdem_canonical *canonical);

/* Canonical signs and order, rounding to double, rows; the block was divided by 2^exponent. */
void cdem_canonical_store(cdem_canonical *canonical, int exponent, cdem_spring_set *set);

#endif
