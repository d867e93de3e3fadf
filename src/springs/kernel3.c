/* Closed form of 3x3 blocks, a batch of 8 at a time.
 *
 * Let D = S - (tr S / 3) I. Its characteristic polynomial is x^3 - 3 J x - 2 R with J = tr D^2 / 6,
 * R = det D / 2 (Wei et al. 2006, eqs 3-5, with p = -3J, q = -2R, and the signs of eq 5 put right).
 * The real root x of the sign of R and largest in size is always well separated from the two
 * others, so it is found first:
 *
 *   - R^2 < J^3, three real roots: x = 2 sqrt(J) cos(acos(r)/3), r = |R| / J^(3/2). The function
 *     2 cos(acos(r)/3) is analytic on [0, 1], a polynomial of degree 4 gives 6e-6;
 *   - else, one real root: x = w + J/w, w = cbrt(|R| + sqrt(R^2 - J^3));
 *     two Newton steps finish both;
 *   - adj(D - xI) = adj(D) + x D + x^2 I is the product of the right and the left eigenvector;
 *   - the plane of the two other values is normal to the left eigenvector. In an orthonormal basis
 *     of it D is a 2x2 block, solved without cancellation: a pair of nearly equal values that are
 *     not defective costs no accuracy.
 *
 * tests/springs/reconstruct.h compares with the robust path. */
#include "springs/kernels.h"
#include "springs/parts.h"
#include "springs/plane.h"

#include <string.h>

/* x^(-1/3) of a positive number, to rounding: minus a third of the exponent (6 per cent), then two
 * steps of fourth order, y *= (1 - h)^(-1/3) with h = 1 - x y^3. */
CDEM_ALWAYS_INLINE double inverse_cube_root(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  bits = (UINT64_C(0x553ef0ff) - (((bits >> 32) * UINT64_C(0x55555556)) >> 32)) << 32;
  double y;
  memcpy(&y, &bits, sizeof y);
  double h = 1.0 - x * (y * y * y);
  y += y * h * (1.0 / 3.0 + h * (2.0 / 9.0 + h * (14.0 / 81.0)));
  h = 1.0 - x * (y * y * y);
  return y + y * h * (1.0 / 3.0 + h * (2.0 / 9.0 + h * (14.0 / 81.0)));
}

/* 2 cos(acos(r) / 3) on [0, 1] to 6e-6: interpolated at the zeros of the Chebyshev polynomial. */
CDEM_ALWAYS_INLINE double rough_trisection(double r) {
  return 1.7320608640453818 +
         r * (0.3328234435751921 +
              r * (-0.09184386626152857 + r * (0.03502437715042219 + r * -0.008070797433311152)));
}

/* One Halley step towards the root of x^3 - 3 j x - 2 r: the error is cubed. */
CDEM_ALWAYS_INLINE double polish_root(double x, double j, double r) {
  double square = x * x, f = x * (square - 3.0 * j) - 2.0 * r, slope = 3.0 * (square - j);
  return x - f * slope / (slope * slope - 3.0 * x * f);
}

/* The positive root of x^3 - 3 j x - 2 r, r >= 0. NaN when j and r are both zero. */
CDEM_ALWAYS_INLINE double positive_root(double j, double r) {
  double delta = r * r - j * j * j;
  int real = delta < 0.0;
  double root = sqrt(real ? j : delta);
  double trisection = root * rough_trisection(r / (root * j));
  double sum = r + root, inverse = inverse_cube_root(sum);
  double cardano = inverse * (sum * inverse + j);
  return polish_root(real ? trisection : cardano, j, r);
}

CDEM_ALWAYS_INLINE double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

CDEM_ALWAYS_INLINE void multiply(const double m[9], const double v[3], double out[3]) {
  out[0] = dot(m, v);
  out[1] = dot(m + 3, v);
  out[2] = dot(m + 6, v);
}

CDEM_ALWAYS_INLINE void load9(const cdem_lanes *from, int lane, double m[9]) {
  m[0] = from[0][lane], m[1] = from[1][lane], m[2] = from[2][lane];
  m[3] = from[3][lane], m[4] = from[4][lane], m[5] = from[5][lane];
  m[6] = from[6][lane], m[7] = from[7][lane], m[8] = from[8][lane];
}

/* Entries of a batch as the caller holds it: no alignment asked for. */
CDEM_ALWAYS_INLINE void load_block(const double *s, int lane, double m[9]) {
  s += lane;
  m[0] = s[0], m[1] = s[8], m[2] = s[16];
  m[3] = s[24], m[4] = s[32], m[5] = s[40];
  m[6] = s[48], m[7] = s[56], m[8] = s[64];
}

CDEM_ALWAYS_INLINE void load3(const cdem_lanes *from, int lane, double v[3]) {
  v[0] = from[0][lane], v[1] = from[1][lane], v[2] = from[2][lane];
}

CDEM_ALWAYS_INLINE void save3(const double v[3], cdem_lanes *to, int lane) {
  to[0][lane] = v[0], to[1][lane] = v[1], to[2][lane] = v[2];
}

/* Scaled block of one lane into the deviator; symmetrised where its skew part is rounding. */
CDEM_ALWAYS_INLINE void take_block(const double *s, int lane, cdem_batch *batch, double d[9]) {
  double m[9];
  load_block(s, lane, m);
  double row0 = cdem_larger(fabs(m[0]), cdem_larger(fabs(m[1]), fabs(m[2])));
  double row1 = cdem_larger(fabs(m[3]), cdem_larger(fabs(m[4]), fabs(m[5])));
  double row2 = cdem_larger(fabs(m[6]), cdem_larger(fabs(m[7]), fabs(m[8])));
  double scale, unscale;
  cdem_powers_of_two(cdem_larger(row0, cdem_larger(row1, row2)), &scale, &unscale);
  m[0] *= scale, m[1] *= scale, m[2] *= scale;
  m[3] *= scale, m[4] *= scale, m[5] *= scale;
  m[6] *= scale, m[7] *= scale, m[8] *= scale;
  double norm2 = dot(m, m) + dot(m + 3, m + 3) + dot(m + 6, m + 6);
  double z = m[1] - m[3], y = m[2] - m[6], x = m[5] - m[7];
  int symmetric =
      2.0 * (x * x + y * y + z * z) <= CDEM_SPRINGS_ROUNDING * CDEM_SPRINGS_ROUNDING * norm2;
  double mean = (m[0] + m[4] + m[8]) * (1.0 / 3.0);
  double m01 = 0.5 * (m[1] + m[3]), m02 = 0.5 * (m[2] + m[6]), m12 = 0.5 * (m[5] + m[7]);
  d[0] = m[0] - mean;
  d[4] = m[4] - mean;
  d[8] = -(d[0] + d[4]); /* traceless, however small it is beside the mean */
  d[1] = symmetric ? m01 : m[1], d[3] = symmetric ? m01 : m[3];
  d[2] = symmetric ? m02 : m[2], d[6] = symmetric ? m02 : m[6];
  d[5] = symmetric ? m12 : m[5], d[7] = symmetric ? m12 : m[7];
  save3(d, batch->deviator, lane);
  save3(d + 3, batch->deviator + 3, lane);
  save3(d + 6, batch->deviator + 6, lane);
  batch->mean[lane] = mean;
  batch->scale[lane] = scale;
  batch->unscale[lane] = unscale;
  batch->norm2[lane] = norm2;
  batch->symmetric[lane] = symmetric ? 1.0 : 0.0;
}

CDEM_MULTIVERSION void cdem_springs_kernel3_single(const double *restrict s, int batches,
                                                   cdem_batch *restrict batch) {
  for (; batches > 0; batches--, batch++, s += 9 * CDEM_SPRINGS_LANES)
    CDEM_SPRINGS_LANE_LOOP
  for (int lane = 0; lane < CDEM_SPRINGS_LANES; lane++) {
    double d[9], m[9];
    take_block(s, lane, batch, d);
    m[0] = d[4] * d[8] - d[5] * d[7];
    m[1] = d[2] * d[7] - d[1] * d[8];
    m[2] = d[1] * d[5] - d[2] * d[4];
    m[3] = d[5] * d[6] - d[3] * d[8];
    m[4] = d[0] * d[8] - d[2] * d[6];
    m[5] = d[2] * d[3] - d[0] * d[5];
    m[6] = d[3] * d[7] - d[4] * d[6];
    m[7] = d[1] * d[6] - d[0] * d[7];
    m[8] = d[0] * d[4] - d[1] * d[3];
    double j = (d[0] * d[0] + d[4] * d[4] + d[8] * d[8]) * (1.0 / 6.0) +
               (d[1] * d[3] + d[2] * d[6] + d[5] * d[7]) * (1.0 / 3.0);
    double r = 0.5 * (d[0] * m[0] + d[1] * m[3] + d[2] * m[6]);
    double x = copysign(positive_root(j, fabs(r)), r), square = x * x;
    m[0] += x * d[0] + square, m[1] += x * d[1], m[2] += x * d[2];
    m[3] += x * d[3], m[4] += x * d[4] + square, m[5] += x * d[5];
    m[6] += x * d[6], m[7] += x * d[7], m[8] += x * d[8] + square;
    /* m = right left^T up to a factor: the largest row is the left vector. */
    double n0 = dot(m, m), n1 = dot(m + 3, m + 3), n2 = dot(m + 6, m + 6);
    int second = n1 > n0;
    double most = second ? n1 : n0;
    int third = n2 > most;
    double left[3] = {second ? m[3] : m[0], second ? m[4] : m[1], second ? m[5] : m[2]};
    left[0] = third ? m[6] : left[0], left[1] = third ? m[7] : left[1];
    left[2] = third ? m[8] : left[2];
    double length = 1.0 / sqrt(third ? n2 : most), right[3], axis[3];
    left[0] *= length, left[1] *= length, left[2] *= length;
    multiply(m, left, right);
    int symmetric = batch->symmetric[lane] > 0.0;
    right[0] = symmetric ? left[0] : right[0];
    right[1] = symmetric ? left[1] : right[1];
    right[2] = symmetric ? left[2] : right[2];
    save3(left, batch->left, lane);
    save3(right, batch->right, lane);
    cdem_springs_least_axis(left, axis);
    save3(axis, batch->axis, lane);
  }
}

/* The deviator in the plane normal to the left vector: basis, images and 2x2 block c (row-major).
 */
CDEM_ALWAYS_INLINE void plane_block(const double d[9], const double left[3], const double axis[3],
                                    double u[3], double w[3], double c[4], double du[3],
                                    double dw[3]) {
  cdem_springs_plane_basis(left, axis, u, w);
  multiply(d, u, du);
  multiply(d, w, dw);
  c[0] = dot(u, du), c[1] = dot(u, dw);
  c[2] = dot(w, du), c[3] = dot(w, dw);
}

/* One Newton step on the pair of left and right vectors of the single value x. In the basis (right,
 * u, w) D is [[x, f], [g, C]] with small f and g; right += [u w] y, left += z [u w]^-1 with
 * (x - C) y = g, z (x - C) = f remove them to second order. */
CDEM_MULTIVERSION void cdem_springs_kernel3_improve(cdem_batch *restrict batch) {
  CDEM_SPRINGS_LANE_LOOP
  for (int lane = 0; lane < CDEM_SPRINGS_LANES; lane++) {
    double d[9], left[3], right[3], axis[3], u[3], w[3], c[4], du[3], dw[3], dr[3];
    load9(batch->deviator, lane, d);
    load3(batch->left, lane, left);
    load3(batch->axis, lane, axis);
    load3(batch->right, lane, right);
    plane_block(d, left, axis, u, w, c, du, dw);
    multiply(d, right, dr);
    double factor = 1.0 / dot(left, right), x = dot(left, dr) * factor;
    double ur = dot(u, right), wr = dot(w, right);
    double g0 = dot(u, dr) - ur * x, g1 = dot(w, dr) - wr * x;
    double f0 = dot(left, du) * factor, f1 = dot(left, dw) * factor;
    double x0 = x - c[0], x3 = x - c[3], inverse = 1.0 / (x0 * x3 - c[1] * c[2]);
    double y0 = (x3 * g0 + c[1] * g1) * inverse, y1 = (c[2] * g0 + x0 * g1) * inverse;
    double z0 = (f0 * x3 + f1 * c[2]) * inverse, z1 = (f0 * c[1] + f1 * x0) * inverse;
    double own = factor * (1.0 - z0 * ur - z1 * wr);
    double next[3] = {own * left[0] + z0 * u[0] + z1 * w[0], own * left[1] + z0 * u[1] + z1 * w[1],
                      own * left[2] + z0 * u[2] + z1 * w[2]};
    double length = 1.0 / sqrt(dot(next, next));
    int wanted = batch->wanting[lane] > 0.0;
    left[0] = wanted ? next[0] * length : left[0];
    left[1] = wanted ? next[1] * length : left[1];
    left[2] = wanted ? next[2] * length : left[2];
    right[0] += wanted ? y0 * u[0] + y1 * w[0] : 0.0;
    right[1] += wanted ? y0 * u[1] + y1 * w[1] : 0.0;
    right[2] += wanted ? y0 * u[2] + y1 * w[2] : 0.0;
    save3(left, batch->left, lane);
    save3(right, batch->right, lane);
    cdem_springs_least_axis(left, axis);
    save3(axis, batch->axis, lane);
  }
}

/* Direction a u + b w. */
CDEM_ALWAYS_INLINE void combine(double a, double b, const double u[3], const double w[3],
                                double v[3]) {
  v[0] = a * u[0] + b * w[0];
  v[1] = a * u[1] + b * w[1];
  v[2] = a * u[2] + b * w[2];
}

CDEM_ALWAYS_INLINE void turn(double factor, double v[3]) {
  v[0] = v[0] * factor + 0.0; /* + 0.0: no negative zeros in files */
  v[1] = v[1] * factor + 0.0;
  v[2] = v[2] * factor + 0.0;
}

CDEM_MULTIVERSION void cdem_springs_kernel3_directions(int batches, cdem_batch *restrict batch) {
  for (; batches > 0; batches--, batch++)
    CDEM_SPRINGS_LANE_LOOP
  for (int lane = 0; lane < CDEM_SPRINGS_LANES; lane++) {
    double d[9], left[3], one[3], two[3], three[3], axis[3], u[3], w[3], c[4], du[3], dw[3];
    load9(batch->deviator, lane, d);
    load3(batch->left, lane, left);
    load3(batch->axis, lane, axis);
    load3(batch->right, lane, one);
    int symmetric = batch->symmetric[lane] > 0.0;
    plane_block(d, left, axis, u, w, c, du, dw);
    multiply(d, one, du);
    double single = dot(left, du) / dot(left, one), length = 1.0 / sqrt(dot(one, one));
    cdem_plane_pair pair = cdem_solve_plane(c, symmetric, batch->norm2[lane]);
    combine(pair.a[0], pair.a[1], u, w, two);
    combine(pair.b[0], pair.b[1], u, w, three);
    double sign2 = cdem_springs_sign(two), sign3 = cdem_springs_sign(three);
    turn(length, one);
    turn(cdem_springs_sign(one), one);
    turn(sign2, two);
    turn(pair.conjugate ? sign2 : sign3, three);
    double k2 = pair.mean + (pair.conjugate ? 0.0 : pair.split);
    double k3 = pair.mean - (pair.conjugate ? 0.0 : pair.split);
    /* Diagonal stiffnesses descend: the single one is first or last of them. */
    int last = !pair.conjugate & (single < k2);
    batch->k[0][lane] = last ? k2 : single;
    batch->k[1][lane] = last ? k3 : k2;
    batch->k[2][lane] = last ? single : k3;
    batch->p[0][0][lane] = last ? two[0] : one[0];
    batch->p[0][1][lane] = last ? two[1] : one[1];
    batch->p[0][2][lane] = last ? two[2] : one[2];
    batch->p[1][0][lane] = last ? three[0] : two[0];
    batch->p[1][1][lane] = last ? three[1] : two[1];
    batch->p[1][2][lane] = last ? three[2] : two[2];
    batch->p[2][0][lane] = last ? one[0] : three[0];
    batch->p[2][1][lane] = last ? one[1] : three[1];
    batch->p[2][2][lane] = last ? one[2] : three[2];
    batch->coupling[lane] = pair.conjugate ? pair.split : 0.0;
    batch->conjugate[lane] = pair.conjugate ? 1.0 : 0.0;
  }
}

/* 2-norm condition number of three unit columns with determinant det. The Gram matrix I + G has the
 * eigenvalues 1 + x, x^3 - 3 j x - 2 r = 0, with 3 j the sum of squares and r the product of the
 * cosines: always real. For r >= 0 the root found first gives the largest eigenvalue `high`; the
 * two others have the sum 3 - high and the product det^2 / high, so the smallest follows without
 * cancellation. For r < 0 it gives the smallest. */
CDEM_ALWAYS_INLINE double condition(const double a[3], const double b[3], const double c[3],
                                    double det) {
  double ab = dot(a, b), ac = dot(a, c), bc = dot(b, c);
  double j = (ab * ab + ac * ac + bc * bc) * (1.0 / 3.0) + 1e-40, r = ab * ac * bc;
  double root = sqrt(j), ratio = fabs(r) / (j * root);
  double x = polish_root(root * rough_trisection(ratio < 1.0 ? ratio : 1.0), j, fabs(r));
  int first = r >= 0.0; /* x > 0 is the largest root, else -x the smallest */
  double high = 1.0 + x, rest = (2.0 - x) * high;
  double inside = first ? rest * rest - 4.0 * det * det * high : 3.0 * j - 0.75 * x * x;
  double split = sqrt(cdem_larger(inside, 0.0));
  double above = first ? 0.5 * high * (rest + split) : 1.0 + 0.5 * x + split;
  return sqrt(above / (first ? det * det : 1.0 - x));
}

/* Duals, condition number, residual, and the rows in the block's own unit. */
CDEM_MULTIVERSION void cdem_springs_kernel3_finish(const double *restrict s, int batches,
                                                   cdem_batch *restrict batch) {
  for (; batches > 0; batches--, batch++, s += 9 * CDEM_SPRINGS_LANES)
    CDEM_SPRINGS_LANE_LOOP
  for (int lane = 0; lane < CDEM_SPRINGS_LANES; lane++) {
    double p0[3], p1[3], p2[3], q0[3], q1[3], q2[3], m[9];
    load3(batch->p[0], lane, p0);
    load3(batch->p[1], lane, p1);
    load3(batch->p[2], lane, p2);
    cdem_cross3(p1, p2, q0);
    cdem_cross3(p2, p0, q1);
    cdem_cross3(p0, p1, q2);
    double det = dot(p0, q0), inverse = 1.0 / det;
    int symmetric = batch->symmetric[lane] > 0.0;
    q0[0] = symmetric ? p0[0] : q0[0] * inverse + 0.0;
    q0[1] = symmetric ? p0[1] : q0[1] * inverse + 0.0;
    q0[2] = symmetric ? p0[2] : q0[2] * inverse + 0.0;
    q1[0] = symmetric ? p1[0] : q1[0] * inverse + 0.0;
    q1[1] = symmetric ? p1[1] : q1[1] * inverse + 0.0;
    q1[2] = symmetric ? p1[2] : q1[2] * inverse + 0.0;
    q2[0] = symmetric ? p2[0] : q2[0] * inverse + 0.0;
    q2[1] = symmetric ? p2[1] : q2[1] * inverse + 0.0;
    q2[2] = symmetric ? p2[2] : q2[2] * inverse + 0.0;
    double mean = batch->mean[lane], unscale = batch->unscale[lane],
           coupling = batch->coupling[lane];
    double k0 = batch->k[0][lane] + mean, k1 = batch->k[1][lane] + mean,
           k2 = batch->k[2][lane] + mean;
    double scale = batch->scale[lane], error = 0.0;
    load_block(s, lane, m);
#define COLUMN(j)                                                                                  \
  do {                                                                                             \
    double g0 = k0 * q0[j], g1 = k1 * q1[j] + coupling * q2[j],                                    \
           g2 = k2 * q2[j] - coupling * q1[j];                                                     \
    double e0 = p0[0] * g0 + p1[0] * g1 + p2[0] * g2 - scale * m[j];                               \
    double e1 = p0[1] * g0 + p1[1] * g1 + p2[1] * g2 - scale * m[3 + j];                           \
    double e2 = p0[2] * g0 + p1[2] * g1 + p2[2] * g2 - scale * m[6 + j];                           \
    error += e0 * e0 + e1 * e1 + e2 * e2;                                                          \
  } while (0)
    COLUMN(0);
    COLUMN(1);
    COLUMN(2);
#undef COLUMN
    double cond = symmetric ? 1.0 : condition(p0, p1, p2, det), norm2 = batch->norm2[lane];
    const double bound2 = 0.01 * CDEM_SPRINGS_BOUND * CDEM_SPRINGS_BOUND;
    batch->cond[lane] = cond;
    batch->wanting[lane] = error > CDEM_SPRINGS_IMPROVE2 * norm2 ? 1.0 : 0.0;
    double exact = error <= bound2 * norm2 ? 1.0 : 0.0, normal = unscale > 0.0 ? 1.0 : 0.0;
    double mild = cond <= CDEM_SPRINGS_MAX_COND ? 1.0 : 0.0;
    double ascent = coupling > 0.0 ? 0.0 : cdem_larger(k1 - k0, k2 - k1);
    double order = ascent <= 0.0 ? 1.0 : 0.0;
    batch->accepted[lane] = exact * normal * mild * order;
    batch->row[0][0][lane] = k0 * unscale + 0.0, batch->row[0][1][lane] = 0.0;
    batch->row[1][0][lane] = k1 * unscale + 0.0, batch->row[1][1][lane] = coupling * unscale;
    batch->row[2][0][lane] = k2 * unscale + 0.0, batch->row[2][1][lane] = 0.0 - coupling * unscale;
    save3(p0, batch->row[0] + 2, lane), save3(q0, batch->row[0] + 5, lane);
    save3(p1, batch->row[1] + 2, lane), save3(q1, batch->row[1] + 5, lane);
    save3(p2, batch->row[2] + 2, lane), save3(q2, batch->row[2] + 5, lane);
  }
}
