#include "springs/extended.h"

#include "springs/parts.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

bool cdem_plane_isotropic(const cdem_plane *plane, long double bound) {
  return 2.0L * plane->h * plane->h + plane->b * plane->b + plane->c * plane->c <= bound * bound;
}

static void set2(long double m[2][2], long double m00, long double m01, long double m10,
                 long double m11) {
  m[0][0] = m00, m[0][1] = m01;
  m[1][0] = m10, m[1][1] = m11;
}

/* v = (h + i s, c), turned until its real and imaginary part are equally long: after a turn by phi,
 * |Re|^2 - |Im|^2 = cos 2phi (A - B) - 2 sin 2phi C and 2 Re.Im = sin 2phi (A - B) + 2 cos 2phi C.
 * Circular vectors are so at any phase; Re v then is the first axis. */
static void complex_pair(const cdem_plane *plane, long double s, long double a[2],
                         long double b[2]) {
  long double h = plane->h, c = plane->c;
  long double difference = 2.0L * h * h + c * (plane->b + c), twice = 2.0L * h * s;
  long double sum = c * (c - plane->b), spread = hypotl(difference, twice);
  long double cosine = 0.0L, sine = 1.0L;
  if (spread > CDEM_SPRINGS_ROUNDING * sum) {
    long double angle = 0.5L * atan2l(difference, twice);
    cosine = cosl(angle), sine = sinl(angle);
  }
  long double length = sqrtl(0.5L * sum);
  a[0] = (cosine * h - sine * s) / length, a[1] = cosine * c / length;
  b[0] = (sine * h + cosine * s) / length, b[1] = sine * c / length;
}

bool cdem_plane_eigenvectors(const cdem_plane *plane, long double bound, long double a[2],
                             long double b[2], long double l[2][2], cdem_form *form) {
  if (cdem_plane_isotropic(plane, bound)) {
    a[0] = b[1] = 1.0L, a[1] = b[0] = 0.0L;
    set2(l, plane->mean, 0.0L, 0.0L, plane->mean);
    *form = CDEM_FORM_DIAGONAL;
    return true;
  }
  long double square = plane->h * plane->h + plane->b * plane->c, s = sqrtl(fabsl(square));
  if (square < 0.0L) {
    complex_pair(plane, s, a, b);
    set2(l, plane->mean, s, -s, plane->mean);
    *form = CDEM_FORM_COMPLEX;
    return true;
  }
  /* (z, c) belongs to mean + split and (-b, z) to mean - split, split of the sign of h. */
  long double split = copysignl(s, plane->h), z = plane->h + split;
  long double first = hypotl(z, plane->c), second = hypotl(z, plane->b);
  if (first == 0.0L || second == 0.0L || s == 0.0L)
    return false;
  bool swap = split < 0.0L;
  long double *large = swap ? b : a, *small = swap ? a : b;
  large[0] = z / first, large[1] = plane->c / first;
  small[0] = -plane->b / second, small[1] = z / second;
  set2(l, plane->mean + s, 0.0L, 0.0L, plane->mean - s);
  *form = CDEM_FORM_DIAGONAL;
  return true;
}

void cdem_plane_schur(const cdem_plane *plane, long double bound, long double a[2],
                      long double b[2], long double l[2][2], cdem_form *form) {
  /* A rotation by theta turns (h, q = (b + c)/2) by 2 theta and leaves w = (b - c)/2: choose h = 0
   * and q of the sign of w, so that b is the larger coupling. */
  long double q = 0.5L * (plane->b + plane->c), w = 0.5L * (plane->b - plane->c);
  long double size = hypotl(plane->h, q), sign = copysignl(1.0L, w);
  long double angle = size > 0.0L ? 0.5L * atan2l(-sign * plane->h, sign * q) : 0.0L;
  long double large = w + sign * size, small = sign * size - w;
  a[0] = cosl(angle), a[1] = sinl(angle);
  b[0] = -a[1], b[1] = a[0];
  if (fabsl(small) <= bound)
    small = 0.0L;
  if (large * small < 0.0L) {
    set2(l, plane->mean, large, small, plane->mean);
    *form = CDEM_FORM_COMPLEX;
    return;
  }
  *form = CDEM_FORM_JORDAN2;
  set2(l, plane->mean, large, 0.0L, plane->mean);
  if (small == 0.0L)
    return;
  /* Real values mean +- s: the eigenvector (large, s) of the larger one leads. */
  long double s = sqrtl(large * small), length = hypotl(large, s);
  long double x = large / length, y = s / length;
  long double first[2] = {x * a[0] + y * b[0], x * a[1] + y * b[1]};
  b[0] = -first[1], b[1] = first[0];
  a[0] = first[0], a[1] = first[1];
  set2(l, plane->mean + s, large - small, 0.0L, plane->mean - s);
}

static double condition(const cdem_canonical *canonical) {
  double p[9], value[3], work[64], unused;
  int n = canonical->size;
  for (int k = 0; k < n; k++)
    for (int c = 0; c < n; c++)
      p[n * k + c] = (double)canonical->p[k][c];
  lapack_int info = LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'N', 'N', n, n, p, n, value, &unused, 1,
                                        &unused, 1, work, 64);
  return info == 0 ? value[0] / value[n - 1] : INFINITY;
}

bool cdem_canonical_invert(cdem_canonical *canonical) {
  if (canonical->size == 2) /* complete P by the third axis */
    for (int c = 0; c < 3; c++) {
      canonical->p[2][c] = c == 2;
      canonical->p[0][2] = canonical->p[1][2] = 0.0L;
    }
  long double(*p)[3] = canonical->p, (*q)[3] = canonical->q;
  for (int k = 0; k < 3; k++)
    cdem_cross3l(p[(k + 1) % 3], p[(k + 2) % 3], q[k]);
  long double det = cdem_dot3l(p[0], q[0]);
  if (!(fabsl(det) > 0.0L))
    return false;
  for (int k = 0; k < 3; k++)
    for (int c = 0; c < 3; c++)
      q[k][c] /= det;
  canonical->cond = condition(canonical);
  return true;
}

static void swap_springs(cdem_canonical *canonical, int i, int j) {
  for (int c = 0; c < 3; c++) {
    long double p = canonical->p[i][c], q = canonical->q[i][c];
    canonical->p[i][c] = canonical->p[j][c], canonical->p[j][c] = p;
    canonical->q[i][c] = canonical->q[j][c], canonical->q[j][c] = q;
  }
  long double value = canonical->l[i][i];
  canonical->l[i][i] = canonical->l[j][j], canonical->l[j][j] = value;
}

static void flip(cdem_canonical *canonical, int k) {
  for (int c = 0; c < 3; c++) {
    canonical->p[k][c] = -canonical->p[k][c];
    canonical->q[k][c] = -canonical->q[k][c];
    canonical->l[k][c] = -canonical->l[k][c];
  }
  for (int c = 0; c < 3; c++) /* the diagonal is flipped twice */
    canonical->l[c][k] = -canonical->l[c][k];
}

static void make_canonical(cdem_canonical *canonical) {
  int n = canonical->size;
  if (canonical->form == CDEM_FORM_DIAGONAL)
    for (int pass = 0; pass < n; pass++) /* stable: equal stiffnesses keep their order */
      for (int k = 0; k + 1 < n; k++)
        if (canonical->l[k][k] < canonical->l[k + 1][k + 1])
          swap_springs(canonical, k, k + 1);
  for (int k = 0; k < n; k++) {
    double dir[3] = {(double)canonical->p[k][0], (double)canonical->p[k][1],
                     n == 3 ? (double)canonical->p[k][2] : 0.0};
    bool wrong = cdem_springs_sign(dir) < 0.0;
    if (canonical->form == CDEM_FORM_COMPLEX && k == n - 1) /* follows from b > 0 */
      wrong = canonical->l[n - 2][n - 1] < 0.0L;
    if (wrong)
      flip(canonical, k);
  }
}

/* The next row of the set, for spring k (from 0). */
static cdem_spring_row *add_row(const cdem_canonical *canonical, int k, cdem_spring_set *set) {
  cdem_spring_row *row = &set->row[set->rows++];
  row->spring = (int8_t)(k + 1);
  for (int c = 0; c < canonical->size; c++) {
    row->dir[c] = (double)canonical->p[k][c] + 0.0; /* + 0.0: no negative zeros in files */
    row->dual[c] = (double)canonical->q[k][c] + 0.0;
  }
  return row;
}

void cdem_canonical_store(cdem_canonical *canonical, int exponent, cdem_spring_set *set) {
  make_canonical(canonical);
  int n = canonical->size;
  memset(set, 0, sizeof *set);
  set->cond = canonical->cond;
  set->form = (uint8_t)canonical->form;
  set->size = (uint8_t)n;
  set->slow = 1;
  for (int k = 0; k < n; k++) {
    cdem_spring_row *row = add_row(canonical, k, set);
    row->stiffness = ldexp((double)canonical->l[k][k], exponent) + 0.0;
    for (int j = 0; j < n; j++)
      if (j != k && canonical->l[k][j] != 0.0L && row->couples_to == 0) {
        row->couples_to = (int8_t)(j + 1);
        row->coupling = ldexp((double)canonical->l[k][j], exponent);
      }
  }
  for (int k = 0; k < n; k++)
    for (int j = 0; j < n; j++)
      if (j != k && canonical->l[k][j] != 0.0L && j + 1 != set->row[k].couples_to) {
        cdem_spring_row *extra = add_row(canonical, k, set);
        extra->couples_to = (int8_t)(j + 1);
        extra->coupling = ldexp((double)canonical->l[k][j], exponent);
      }
}
