/* Private to the laws: one lane of a batch, as inline functions from which the loops are made.
 *
 * `dim` and `energies` are constants where these are called, so that each loop holds only what it
 * needs; conditions are selects, so that it vectorises. Vectors of the tangent plane: in 2-D one
 * number along t (x, the others unused), in 3-D three.
 *
 * A spring T in the tangent plane and its dashpot D = c s' meet the cap together: F = T + D, and
 * where |F| > cap both are cut by the same factor. The spring's force after the cut is its history.
 * Then D.s' >= 0, the dashpot never drives, and what the cut takes from the spring is never
 * negative either (docs/theory/dem.md, eqs 10 to 12).
 */
#ifndef CDEM_DEM_LAW_LANES_H
#define CDEM_DEM_LAW_LANES_H

#include "base/simd.h"
#include "dem/batch.h"

#include <math.h>
#include <string.h>

typedef struct {
  double x, y, z;
} lane_vector;

CDEM_ALWAYS_INLINE int lane_count(const cdem_batch *batch) {
  return (batch->count + 7) & ~7;
}

CDEM_ALWAYS_INLINE double lane_max(double a, double b) {
  return a > b ? a : b;
}

CDEM_ALWAYS_INLINE double lane_min(double a, double b) {
  return a < b ? a : b;
}

CDEM_ALWAYS_INLINE double lane_dot(int dim, lane_vector a, lane_vector b) {
  return dim == 2 ? a.x * b.x : a.x * b.x + a.y * b.y + a.z * b.z;
}

CDEM_ALWAYS_INLINE lane_vector lane_scaled(int dim, lane_vector a, double f) {
  return dim == 2 ? (lane_vector){a.x * f, 0.0, 0.0} : (lane_vector){a.x * f, a.y * f, a.z * f};
}

/* a + f b */
CDEM_ALWAYS_INLINE lane_vector lane_sum(int dim, lane_vector a, double f, lane_vector b) {
  return dim == 2 ? (lane_vector){a.x + f * b.x, 0.0, 0.0}
                  : (lane_vector){a.x + f * b.x, a.y + f * b.y, a.z + f * b.z};
}

/* 1/sqrt(x) to about one unit in the last place; 0 gives something finite. Division and square root
 * of eight lanes take as long as some forty multiplications, so: the first guess by halving the
 * exponent (3.4 % off), then twice y (1 + e/2 + 3/8 e^2 + 5/16 e^3) with e = 1 - x y^2, 0.27 e^4
 * off. Scaling x by 4 scales the bits of the result by 1/2: x must be the square of a physical
 * quantity.
 */
CDEM_ALWAYS_INLINE double lane_inverse_root(double x) {
  int64_t bits;
  double y;
  memcpy(&bits, &x, sizeof bits);
  bits = 0x5fe6eb50c7b537a9 - (int64_t)((uint64_t)bits >> 1);
  memcpy(&y, &bits, sizeof y);
  double e = 1.0 - x * y * y;
  y += y * e * (0.5 + e * (0.375 + e * 0.3125));
  e = 1.0 - x * y * y;
  return y + y * e * (0.5 + e * (0.375 + e * 0.3125));
}

CDEM_ALWAYS_INLINE double lane_root(double x) {
  return x * lane_inverse_root(x);
}

/* By what T + D is cut so as not to be longer than cap >= 0. */
CDEM_ALWAYS_INLINE double lane_cut(int dim, lane_vector a, double cap) {
  const double square = dim == 2 ? a.x * a.x : lane_dot(3, a, a);
  return square > cap * cap ? cap * lane_inverse_root(square) : 1.0;
}

CDEM_ALWAYS_INLINE lane_vector lane_get(int dim, const cdem_lanes *lanes, int i) {
  return dim == 2 ? (lane_vector){lanes[0][i], 0.0, 0.0}
                  : (lane_vector){lanes[0][i], lanes[1][i], lanes[2][i]};
}

CDEM_ALWAYS_INLINE void lane_put(int dim, cdem_lanes *lanes, int i, lane_vector a) {
  lanes[0][i] = a.x;
  if (dim == 3) {
    lanes[1][i] = a.y;
    lanes[2][i] = a.z;
  }
}

/* Normal part of a velocity, and its tangential part less turning x n. */
CDEM_ALWAYS_INLINE double lane_normal_rate(int dim, const cdem_lanes *v, lane_vector n, int i) {
  double plane = v[0][i] * n.x + v[1][i] * n.y;
  return dim == 2 ? plane : plane + v[2][i] * n.z;
}

CDEM_ALWAYS_INLINE lane_vector lane_slide_rate(int dim, const cdem_lanes *v,
                                               const cdem_lanes *turning, lane_vector n,
                                               double normal, int i) {
  if (dim == 2)
    return (lane_vector){v[1][i] * n.x - v[0][i] * n.y - turning[0][i], 0.0, 0.0};
  lane_vector w = lane_get(3, turning, i);
  return (lane_vector){v[0][i] - normal * n.x - (w.y * n.z - w.z * n.y),
                       v[1][i] - normal * n.y - (w.z * n.x - w.x * n.z),
                       v[2][i] - normal * n.z - (w.x * n.y - w.y * n.x)};
}

/* Growth of the velocities, for the book (batch.h). The last kick did not know what this contact
 * does now: the change of its own push is added, as if the pair were alone. Without it dashpots
 * would be booked too high by (w dt)^2/2 of what they take, and their sudden begin to first order
 * only. `before`: the push a step ago, of overlap `lane_overlap_before` and speed `away` - `gain`,
 * with `gain` the growth in the last kick. */
CDEM_ALWAYS_INLINE double lane_overlap_before(const cdem_batch *b, double away, int i) {
  const double d = b->overlap[i] + b->step * away;
  return b->fresh[i] == 0.0 && d > 0.0 ? d : 0.0;
}

CDEM_ALWAYS_INLINE double lane_own_gain(const cdem_batch *b, double gain, double push,
                                        double before, int i) {
  return gain + b->step * (push - before) / b->mass[i];
}

/* The same of sliding, but only where it begins: 1/m_t = (1/m)(1 + r^2 m/I). */
CDEM_ALWAYS_INLINE lane_vector lane_slide_gain(int dim, const cdem_batch *b, lane_vector n,
                                               lane_vector force, int i) {
  const double along = lane_normal_rate(dim, b->velocity_gain, n, i);
  const double lighter = dim == 2 ? 3.0 : 3.5;
  return lane_sum(dim, lane_slide_rate(dim, b->velocity_gain, b->turning_gain, n, along, i),
                  -lighter * b->fresh[i] * b->step / b->mass[i], force);
}

CDEM_ALWAYS_INLINE lane_vector lane_normal(int dim, const cdem_batch *b, int i) {
  return dim == 2 ? (lane_vector){b->n[0][i], b->n[1][i], 0.0} : lane_get(3, b->n, i);
}

/* A vector of the last step's tangent plane turned into this one's, keeping its length: the normal
 * turned by the least rotation, from n - dn to n, which takes a to a - (a.n)(n - dn/2) to second
 * order, dn = step velocity/(a_A + a_B) but for a part along n; and the mean spin of the two grains
 * about n, (turning + spin (a_A - a_B)/2).n/(a_A + a_B). Everything is multiplied by a_A + a_B,
 * because the length is set afterwards anyway. On a plane a.n is 0; on a curved wall dn is another,
 * and the direction right to first order. 2-D: nothing to do. */
CDEM_ALWAYS_INLINE lane_vector lane_turned(int dim, const cdem_batch *b, lane_vector n,
                                           lane_vector a, double step, int i) {
  if (dim == 2)
    return a;
  const double arm_a = b->arm[0][i], arm_b = b->arm[1][i], arms = arm_a + arm_b;
  const lane_vector sum =
      lane_sum(3, lane_get(3, b->turning, i), 0.5 * (arm_a - arm_b), lane_get(3, b->spin, i));
  const double angle = lane_dot(3, sum, n) * step;
  lane_vector u = {arms * a.x + angle * (n.y * a.z - n.z * a.y),
                   arms * a.y + angle * (n.z * a.x - n.x * a.z),
                   arms * a.z + angle * (n.x * a.y - n.y * a.x)};
  u = lane_sum(3, u, 0.5 * step * lane_dot(3, a, n), lane_get(3, b->velocity, i));
  u = lane_sum(3, u, -lane_dot(3, u, n), n);
  const double p = lane_dot(3, a, a), q = lane_dot(3, u, u);
  return lane_scaled(3, u, p * lane_inverse_root(p * q));
}

#endif
