/* Elasticity that carries no tension: how a strain opens.
 *
 * A strain e is split into what is elastic and an opening a, a tensor without negative eigenvalue
 * across which nothing is carried. Of all openings the one with the least energy is taken,
 *
 *     W*(e) = min over a >= 0 of W(e - a),    W(e) = 1/2 e . D e                           (1)
 *
 * (Del Piero 1989: masonry-like materials). W* is convex and once continuously differentiable, and
 * its derivative is the stress s = D (e - a). The minimum is where
 *
 *     s <= 0,   a >= 0,   s . a = 0                                                        (2)
 *
 * so that no principal stress is tensile: s is the projection of D e to such stresses by the norm
 * of energy. Derivations: docs/theory/cdem.md, section 1b. tests/cdem/tension_law.c holds (1) and
 * (2) against any other opening, and the stress against differences of W*.
 *
 * In a plane only the plane opens. Under plane strain the stress across the plane is then
 * nu (s_xx + s_yy), which is no tension for nu >= 0, so nothing is lost; a sheet has none.
 *
 * Strains are Voigt (xx yy zz yz xz xy) with engineering shears, stresses Pa, tension positive.
 */
#ifndef CDEM_CDEM_TENSION_LAW_H
#define CDEM_CDEM_TENSION_LAW_H

#include <math.h>
#include <stdbool.h>

typedef enum { CDEM_TENSION_ELASTIC, CDEM_TENSION_PLANE, CDEM_TENSION_SOLID } cdem_tension_kind;

/* A plane law acts on three numbers: the mean of e_xx and e_yy, half their difference, and e_xy.
 * Their stresses are k times as much. All plane stresses that pull nowhere are the cone
 * s_0 + sqrt(s_1^2 + s_2^2) <= 0, all openings its dual, a_0 >= sqrt(a_1^2 + a_2^2). */
typedef struct {
  cdem_tension_kind kind;
  double k[3];       /* plane, Pa: D11 + D12, D11 - D12, 2 G (cubic where the last two differ) */
  double lambda, mu; /* solid, Pa */
} cdem_tension_law;

/* Cubic moduli: s = t (-1, cos f, sin f) on the cone and a = mu t (1, cos f, sin f), so
 * s_1 = e_1/(1/k_1 + mu), s_2 = e_2/(1/k_2 + mu), and mu is the one root of
 *     (mu - 1/k_0) sqrt(s_1^2 + s_2^2) = e_0,
 * whose left side grows with mu. The roots for k_1 = k_2 = either modulus enclose it. Newton, with
 * bisection where that would leave the bracket. */
static inline void cdem_tension_open_cubic(const double k[3], const double e[3], double r,
                                           double a[3]) {
  const double alpha = 1.0 / k[0], beta1 = 1.0 / k[1], beta2 = 1.0 / k[2], y = e[0] / r;
  double m1 = (alpha + beta1 * y) / (1.0 - y), m2 = (alpha + beta2 * y) / (1.0 - y);
  double low = fmax(0.0, fmin(m1, m2)), high = fmax(m1, m2), mu = 0.5 * (low + high);
  double s1 = 0.0, s2 = 0.0, t = 0.0;
  for (int step = 0; step < 80; step++) {
    s1 = e[1] / (beta1 + mu);
    s2 = e[2] / (beta2 + mu);
    t = sqrt(s1 * s1 + s2 * s2);
    double value = (mu - alpha) * t - e[0];
    double slope = t - (mu - alpha) * (s1 * s1 / (beta1 + mu) + s2 * s2 / (beta2 + mu)) / t;
    if (value < 0.0)
      low = mu;
    else
      high = mu;
    double next = mu - value / slope;
    if (!(next >= low && next <= high))
      next = 0.5 * (low + high);
    if (fabs(next - mu) <= 4e-16 * mu)
      break;
    mu = next;
  }
  a[0] = mu * t;
  a[1] = mu * s1;
  a[2] = mu * s2;
}

/* Opening a of e = (mean, half difference, shear); false, and a = 0, when there is none. */
static inline bool cdem_tension_open_plane(const double k[3], const double e[3], double a[3]) {
  double s0 = k[0] * e[0], s1 = k[1] * e[1], s2 = k[2] * e[2], r = sqrt(e[1] * e[1] + e[2] * e[2]);
  double most = s0 + sqrt(s1 * s1 + s2 * s2); /* the larger principal stress */
  a[0] = a[1] = a[2] = 0.0;
  if (!(most > 0.0))
    return false;
  if (e[0] >= r) { /* no principal strain is negative: all of it opens */
    a[0] = e[0], a[1] = e[1], a[2] = e[2];
  } else if (k[1] == k[2]) { /* a = n (x) n most/D11, n the direction of the larger strain */
    a[0] = most / (k[0] + k[1]);
    a[1] = a[0] * e[1] / r;
    a[2] = a[0] * e[2] / r;
  } else {
    cdem_tension_open_cubic(k, e, r, a);
  }
  return true;
}

/* Eigenvalues v and unit eigenvectors n[k] of a symmetric 3x3 by Jacobi's rotations, which keep
 * their accuracy where eigenvalues meet. m is used up. */
static inline void cdem_tension_principal(double m[3][3], double v[3], double n[3][3]) {
  double size = 0.0;
  for (int i = 0; i < 9; i++) {
    n[i / 3][i % 3] = i % 4 == 0 ? 1.0 : 0.0;
    size += m[i / 3][i % 3] * m[i / 3][i % 3];
  }
  for (int sweep = 0; sweep < 10; sweep++) {
    double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
    if (!(off > 1e-33 * size))
      break;
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (m[p][q] == 0.0)
          continue;
        int r = 3 - p - q;
        double half = 0.5 * (m[q][q] - m[p][p]), b = m[p][q];
        double t = b / (fabs(half) + sqrt(half * half + b * b));
        t = half < 0.0 ? -t : t;
        double c = 1.0 / sqrt(1.0 + t * t), s = t * c, rp = m[r][p], rq = m[r][q];
        m[p][p] -= t * b;
        m[q][q] += t * b;
        m[p][q] = m[q][p] = 0.0;
        m[r][p] = m[p][r] = c * rp - s * rq;
        m[r][q] = m[q][r] = s * rp + c * rq;
        for (int i = 0; i < 3; i++) {
          double x = n[p][i], z = n[q][i];
          n[p][i] = c * x - s * z;
          n[q][i] = s * x + c * z;
        }
      }
  }
  for (int i = 0; i < 3; i++)
    v[i] = m[i][i];
}

/* Openings of principal strains e[0] >= e[1] >= e[2]: none, or as many as leave the rest under
 * pressure. The stress across the next one, while those before it are open, decides. */
static inline void cdem_tension_open_principal(double lambda, double mu, const double e[3],
                                               double a[3]) {
  double along = lambda + 2.0 * mu, sheet = 2.0 * lambda * mu / along;
  double poisson = 0.5 * lambda / (lambda + mu);
  double first = lambda * (e[0] + e[1] + e[2]) + 2.0 * mu * e[0];
  double second = sheet * (e[1] + e[2]) + 2.0 * mu * e[1];
  a[0] = a[1] = a[2] = 0.0;
  if (!(first > 0.0))
    return;
  if (!(second > 0.0)) {
    a[0] = first / along;
  } else if (e[2] < 0.0) {
    a[0] = e[0] + poisson * e[2];
    a[1] = e[1] + poisson * e[2];
  } else {
    a[0] = e[0], a[1] = e[1], a[2] = e[2];
  }
}

/* Is the symmetric tensor m (Voigt, shears once) positive definite? */
static inline bool cdem_tension_definite(const double m[6]) {
  double minor = m[0] * m[1] - m[5] * m[5];
  double det =
      m[2] * minor - m[3] * (m[0] * m[3] - m[4] * m[5]) + m[4] * (m[3] * m[5] - m[4] * m[1]);
  return m[0] > 0.0 && minor > 0.0 && det > 0.0;
}

/* As cdem_tension_open_plane, of a strain in Voigt order. Most of a body is under pressure in every
 * direction or in none; both are seen without principal directions. */
static inline bool cdem_tension_open_solid(double lambda, double mu, const double e[6],
                                           double a[6]) {
  const double trace = lambda * (e[0] + e[1] + e[2]);
  const double pressed[6] = {-trace - 2.0 * mu * e[0],
                             -trace - 2.0 * mu * e[1],
                             -trace - 2.0 * mu * e[2],
                             -mu * e[3],
                             -mu * e[4],
                             -mu * e[5]};
  const double open[6] = {e[0], e[1], e[2], 0.5 * e[3], 0.5 * e[4], 0.5 * e[5]};
  for (int i = 0; i < 6; i++)
    a[i] = 0.0;
  if (cdem_tension_definite(pressed))
    return false;
  if (cdem_tension_definite(open)) {
    for (int i = 0; i < 6; i++)
      a[i] = e[i];
    return true;
  }
  double m[3][3] = {
      {open[0], open[5], open[4]}, {open[5], open[1], open[3]}, {open[4], open[3], open[2]}};
  double v[3], n[3][3], sorted[3], part[3];
  int order[3] = {0, 1, 2};
  cdem_tension_principal(m, v, n);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2 - i; j++)
      if (v[order[j]] < v[order[j + 1]]) {
        int swap = order[j];
        order[j] = order[j + 1];
        order[j + 1] = swap;
      }
  for (int i = 0; i < 3; i++)
    sorted[i] = v[order[i]];
  cdem_tension_open_principal(lambda, mu, sorted, part);
  for (int i = 0; i < 3; i++) {
    const double *d = n[order[i]];
    a[0] += part[i] * d[0] * d[0], a[1] += part[i] * d[1] * d[1], a[2] += part[i] * d[2] * d[2];
    a[3] += 2.0 * part[i] * d[1] * d[2], a[4] += 2.0 * part[i] * d[0] * d[2];
    a[5] += 2.0 * part[i] * d[0] * d[1];
  }
  return part[0] > 0.0;
}

/* The opening of a strain; false, and zeros, when there is none. */
static inline bool cdem_tension_open(const cdem_tension_law *law, const double e[6], double a[6]) {
  if (law->kind == CDEM_TENSION_SOLID)
    return cdem_tension_open_solid(law->lambda, law->mu, e, a);
  for (int i = 0; i < 6; i++)
    a[i] = 0.0;
  if (law->kind == CDEM_TENSION_ELASTIC)
    return false;
  const double plane[3] = {0.5 * (e[0] + e[1]), 0.5 * (e[0] - e[1]), 0.5 * e[5]};
  double open[3];
  if (!cdem_tension_open_plane(law->k, plane, open))
    return false;
  a[0] = open[0] + open[1], a[1] = open[0] - open[1], a[5] = 2.0 * open[2];
  return true;
}

/* D a, in the plane of a plane law. */
static inline void cdem_tension_stress(const cdem_tension_law *law, const double a[6],
                                       double s[6]) {
  s[2] = s[3] = s[4] = 0.0;
  if (law->kind == CDEM_TENSION_SOLID) {
    double trace = law->lambda * (a[0] + a[1] + a[2]);
    for (int i = 0; i < 3; i++) {
      s[i] = trace + 2.0 * law->mu * a[i];
      s[3 + i] = law->mu * a[3 + i];
    }
    return;
  }
  double mean = 0.5 * law->k[0] * (a[0] + a[1]), half = 0.5 * law->k[1] * (a[0] - a[1]);
  s[0] = mean + half, s[1] = mean - half, s[5] = 0.5 * law->k[2] * a[5];
}

#endif
