#include "results/tensor.h"

#include <math.h>

double cdem_tensor_von_mises(const double t[6]) {
  double a = t[0] - t[1], b = t[1] - t[2], c = t[2] - t[0];
  return sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]));
}

/* Smith, Communications of the ACM 4 (1961) 168. With q the mean and s the deviator divided by
 * p = sqrt(s:s / 6), the principal values are q + 2 p cos(phi + 2 pi k / 3), cos(3 phi) = det / 2.
 * The tensor is scaled first, so that squares and cubes stay finite. */
void cdem_tensor_principal(const double t[6], double value[3]) {
  double scale = 0.0;
  for (int i = 0; i < 6; i++)
    scale = fmax(scale, fabs(t[i]));
  if (!(scale > 0.0) || !isfinite(scale)) {
    value[0] = value[1] = value[2] = scale;
    return;
  }
  double a[6], mean = 0.0, square = 0.0;
  for (int i = 0; i < 6; i++)
    a[i] = t[i] / scale;
  mean = (a[0] + a[1] + a[2]) / 3.0;
  for (int i = 0; i < 3; i++) {
    a[i] -= mean;
    square += a[i] * a[i] + 2.0 * a[3 + i] * a[3 + i];
  }
  double p = sqrt(square / 6.0);
  double det = a[0] * (a[1] * a[2] - a[4] * a[4]) - a[3] * (a[3] * a[2] - a[4] * a[5]) +
               a[5] * (a[3] * a[4] - a[1] * a[5]);
  double half = p > 0.0 ? fmin(1.0, fmax(-1.0, det / (2.0 * p * p * p))) : 1.0;
  double phi = acos(half) / 3.0, third = 2.0 * acos(-1.0) / 3.0;
  value[0] = scale * (mean + 2.0 * p * cos(phi));
  value[2] = scale * (mean + 2.0 * p * cos(phi + third));
  value[1] = 3.0 * scale * mean - value[0] - value[2];
}
