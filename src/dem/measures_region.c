/* What is inside a box: of a branch, of a disc or ball, of a periodic state. */
#include "dem/measures_kernels.h"

#include <string.h>

void cdem_region_bounds(const cdem_snapshot *s, const cdem_region *region, cdem_region *bounds) {
  cdem_snapshot_box(s, bounds->low, bounds->high);
  for (int c = 0; c < s->dim; c++)
    if (region != NULL && region->low[c] < region->high[c]) {
      bounds->low[c] = region->low[c];
      bounds->high[c] = region->high[c];
    } else if (s->cell != NULL && s->cell->periodic[c]) {
      bounds->low[c] = s->cell->corner[c];
      bounds->high[c] = s->cell->corner[c] + fabs(s->cell->h[4 * c]);
    }
}

double cdem_branch_inside(int dim, const double from[3], const double branch[3],
                          const cdem_region *box) {
  double first = 0.0, last = 1.0;
  for (int c = 0; c < dim; c++) {
    if (branch[c] == 0.0) { /* along a face: of the box above it */
      if (!(from[c] >= box->low[c] && from[c] < box->high[c]))
        return 0.0;
      continue;
    }
    double a = (box->low[c] - from[c]) / branch[c], b = (box->high[c] - from[c]) / branch[c];
    first = fmax(first, fmin(a, b));
    last = fmin(last, fmax(a, b));
  }
  return last > first ? last - first : 0.0;
}

/* Integral of sqrt(r^2 - x^2) from 0 to x. */
static double under_arc(double x, double radius) {
  double at = fmax(-1.0, fmin(1.0, x / radius));
  return 0.5 * radius * radius * (at * sqrt(1.0 - at * at) + asin(at));
}

/* Disc about the origin and the rectangle x0 x1 y0 y1: between breaks, where the arc meets a side,
 * its upper and lower bounds are either an arc or a side. */
static double disc_inside(double radius, const double x[2], const double y[2]) {
  double at[6] = {fmax(x[0], -radius), fmin(x[1], radius)}, area = 0.0;
  int count = 2;
  if (!(at[0] < at[1]))
    return 0.0;
  for (int side = 0; side < 2; side++)
    if (fabs(y[side]) < radius)
      for (int sign = -1; sign <= 1; sign += 2) {
        double cut = sign * sqrt((radius - y[side]) * (radius + y[side]));
        if (cut > at[0] && cut < at[count - 1]) {
          int k = count++;
          for (at[k] = at[k - 1]; k > 1 && at[k - 1] > cut; k--)
            at[k] = at[k - 1];
          at[k] = cut;
        }
      }
  for (int k = 0; k + 1 < count; k++) {
    double middle = 0.5 * (at[k] + at[k + 1]), width = at[k + 1] - at[k];
    double half = sqrt(fmax(0.0, (radius - middle) * (radius + middle)));
    double arc = under_arc(at[k + 1], radius) - under_arc(at[k], radius);
    if (fmin(y[1], half) > fmax(y[0], -half))
      area += (half < y[1] ? arc : y[1] * width) - (-half > y[0] ? -arc : y[0] * width);
  }
  return area;
}

/* Slices of a ball between two heights: the substitution z = m - h cos(pi u) takes the roots at the
 * breaks away; eight Gauss points in each of eight panels, which
 * narrow towards the ends, where a side that is near the middle makes itself felt. */
static double ball_between(double radius, double low, double high, const double x[2],
                           const double y[2]) {
  static const double point[4] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674,
                                  0.96028985649753623},
                      weight[4] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447,
                                   0.10122853629037626};
  static const double edge[9] = {0.0, 0.015625, 0.0625, 0.25, 0.5, 0.75, 0.9375, 0.984375, 1.0};
  const double pi = 3.14159265358979323846;
  double sum = 0.0, half = 0.5 * (high - low), middle = 0.5 * (high + low);
  for (int k = 0; k < 64; k++) {
    double g = point[k / 2 % 4] * (k % 2 == 0 ? 1.0 : -1.0);
    double wide = edge[k / 8 + 1] - edge[k / 8], u = edge[k / 8] + 0.5 * wide * (1.0 + g);
    double z = middle - half * cos(pi * u);
    double slice = sqrt(fmax(0.0, (radius - z) * (radius + z)));
    if (slice > 0.0)
      sum += 0.5 * wide * weight[k / 2 % 4] * half * pi * sin(pi * u) * disc_inside(slice, x, y);
  }
  return sum;
}

static double ball_inside(double radius, const double x[2], const double y[2], const double z[2]) {
  double at[40] = {fmax(z[0], -radius), fmin(z[1], radius)}, volume = 0.0;
  int count = 2;
  if (!(at[0] < at[1]))
    return 0.0;
  /* Breaks: slices whose arc begins to meet a side or a corner. */
  for (int i = -1; i < 2; i++)
    for (int j = -1; j < 2; j++) {
      double a = i < 0 ? 0.0 : x[i], b = j < 0 ? 0.0 : y[j], off = sqrt(a * a + b * b);
      for (int sign = -1; sign <= 1 && off < radius; sign += 2) {
        double cut = sign * sqrt((radius - off) * (radius + off));
        if (cut > at[0] && cut < at[count - 1]) {
          int k = count++;
          for (at[k] = at[k - 1]; k > 1 && at[k - 1] > cut; k--)
            at[k] = at[k - 1];
          at[k] = cut;
        }
      }
    }
  for (int k = 0; k + 1 < count; k++)
    if (at[k + 1] > at[k])
      volume += ball_between(radius, at[k], at[k + 1], x, y);
  return volume;
}

double cdem_solid_inside(int dim, const double centre[3], double radius, const cdem_region *box) {
  double side[3][2];
  bool whole = true;
  for (int c = 0; c < dim; c++) {
    side[c][0] = box->low[c] - centre[c];
    side[c][1] = box->high[c] - centre[c];
    if (side[c][0] >= radius || side[c][1] <= -radius)
      return 0.0;
    whole &= side[c][0] <= -radius && side[c][1] >= radius;
  }
  if (whole)
    return cdem_grain_solid(dim, radius);
  return dim == 2 ? disc_inside(radius, side[0], side[1])
                  : ball_inside(radius, side[0], side[1], side[2]);
}
