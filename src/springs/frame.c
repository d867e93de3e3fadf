/* Frames: a transversely isotropic block as one spring along its axis and three in the normal plane
 * 120 degrees apart, so that a discontinuous model has definite directions (Wei et al. 2006, table
 * 4).
 *
 * For three unit vectors e 120 degrees apart in the plane with normal d, sum e e^T = (3/2) (I - d
 * d^T). To carry k2 (I - d d^T) each must therefore have h = (2/3) k2. The source prints 432 where
 * the body diagonal of the cube needs 216, and restores half of k2 only; tests/springs/frame.c
 * shows both. */
#include "springs/parts.h"

#include <string.h>

static void put_row(cdem_spring_row *row, int spring, double stiffness, const double dir[3]) {
  row->stiffness = stiffness;
  row->spring = (int8_t)spring;
  for (int c = 0; c < 3; c++)
    row->dir[c] = row->dual[c] = dir[c] + 0.0; /* + 0.0: no negative zeros in files */
}

void cdem_springs_frame(double k1, double k2, const double d[3], cdem_spring_set *set) {
  const double cosine = -0.5, sine = 0.5 * sqrt(3.0);
  double axis[3], least[3], u[3], w[3], dir[3];
  double length = cdem_norm3(d);
  for (int c = 0; c < 3; c++)
    axis[c] = d[c] / length;
  double sign = cdem_springs_sign(axis);
  for (int c = 0; c < 3; c++)
    axis[c] *= sign;
  cdem_springs_least_axis(axis, least);
  cdem_springs_plane_basis(axis, least, u, w);
  memset(set, 0, sizeof *set);
  set->cond = NAN;
  set->form = CDEM_FORM_FRAME;
  set->size = 3;
  set->rows = 4;
  double h = 2.0 / 3.0 * k2;
  put_row(&set->row[0], 1, k1, axis);
  put_row(&set->row[1], 2, h, u);
  for (int turn = 0; turn < 2; turn++) {
    for (int c = 0; c < 3; c++)
      dir[c] = cosine * u[c] + (turn == 0 ? sine : -sine) * w[c];
    put_row(&set->row[2 + turn], 3 + turn, h, dir);
  }
}

bool cdem_springs_recognise_frame(const double s[9], cdem_spring_set *set) {
  double a[9], dev[9];
  int exponent;
  if (!cdem_springs_scale(s, 9, a, &exponent))
    return false;
  double norm = cdem_frobenius(a, 9), bound = CDEM_SPRINGS_FRAME_BOUND * norm;
  double skew[3] = {a[1] - a[3], a[2] - a[6], a[5] - a[7]};
  if (cdem_norm3(skew) > 2.0 * bound) /* most blocks leave here */
    return false;
  double mean = (a[0] + a[4] + a[8]) / 3.0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      dev[3 * i + j] = 0.5 * (a[3 * i + j] + a[3 * j + i]) - (i == j ? mean : 0.0);
  /* Eigenvalues of the deviator are (2e, -e, -e): tr dev^2 = 6 e^2, det dev = 2 e^3. */
  double square = cdem_frobenius(dev, 9), e = 3.0 * cdem_det3(dev) / (square * square);
  if (!(fabs(3.0 * e) > CDEM_SPRINGS_TIE * norm))
    return false;
  /* dev + e I = 3 e d d^T: its column with the largest diagonal entry is along d. */
  int column = 0;
  for (int i = 1; i < 3; i++)
    if (dev[4 * i] / e > dev[4 * column] / e)
      column = i;
  double d[3];
  for (int i = 0; i < 3; i++)
    d[i] = dev[3 * i + column] + (i == column ? e : 0.0);
  double length = cdem_norm3(d), k1 = 0.0, error = 0.0;
  for (int i = 0; i < 3; i++)
    d[i] /= length;
  for (int i = 0; i < 9; i++)
    k1 += a[i] * d[i / 3] * d[i % 3];
  double k2 = 0.5 * (3.0 * mean - k1);
  for (int i = 0; i < 9; i++) {
    double part = a[i] - (k1 - k2) * d[i / 3] * d[i % 3] - (i % 4 == 0 ? k2 : 0.0);
    error += part * part;
  }
  if (!(sqrt(error) <= bound))
    return false;
  cdem_springs_frame(ldexp(k1, exponent), ldexp(k2, exponent), d, set);
  return true;
}
