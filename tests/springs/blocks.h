/* Families of stiffness blocks that a decomposition must stand, and the laws every spring set
 * obeys. */
#ifndef CDEM_TESTS_SPRINGS_BLOCKS_H
#define CDEM_TESTS_SPRINGS_BLOCKS_H

#include "springs/springs.h"
#include "support/test.h"

typedef enum {
  BLOCKS_RANDOM,
  BLOCKS_SYMMETRIC,
  BLOCKS_NEARLY_SYMMETRIC, /* asymmetry 1e-2 .. 1e-18 */
  BLOCKS_ROTATION,         /* strongly complex, some exactly circular */
  BLOCKS_CONDITIONED,      /* P L P^-1, cond(P) about 1 .. 1e8 */
  BLOCKS_NEAR_JORDAN2,     /* rotated Jordan block + relative 1e-2 .. 1e-16 */
  BLOCKS_NEAR_JORDAN3,
  BLOCKS_NEAR_SPHERE, /* k I + relative 1e-1 .. 1e-16 */
  BLOCKS_RANK1,
  BLOCKS_RANK2,
  BLOCKS_SKEW,
  BLOCKS_TRANSVERSE, /* rotated transversely isotropic + relative 1e-12 .. 1e-20 */
  BLOCKS_DOUBLE,     /* P diag(k, k, l) P^-1, not symmetric */
  BLOCKS_INTEGERS,   /* -1, 0, 1: many exact defects and equal values */
  BLOCKS_SCALED,     /* random times 2^-900 .. 2^900 */
  BLOCKS_FAMILIES
} blocks_family;

static inline double blocks_uniform(cdem_random *random) {
  return cdem_random_uniform(random, -1.0, 1.0);
}

/* 10^-(from .. to) */
static inline double blocks_small(cdem_random *random, double from, double to) {
  return pow(10.0, -cdem_random_uniform(random, from, to));
}

/* Orthonormal rows by Gram-Schmidt. */
static inline void blocks_rotation(cdem_random *random, int size, double q[9]) {
  for (int i = 0; i < size; i++) {
    double norm = 0.0;
    for (int j = 0; j < size; j++)
      q[size * i + j] = blocks_uniform(random);
    for (int pass = 0; pass < 2; pass++)
      for (int k = 0; k < i; k++) {
        double part = 0.0;
        for (int j = 0; j < size; j++)
          part += q[size * i + j] * q[size * k + j];
        for (int j = 0; j < size; j++)
          q[size * i + j] -= part * q[size * k + j];
      }
    for (int j = 0; j < size; j++)
      norm += q[size * i + j] * q[size * i + j];
    for (int j = 0; j < size; j++)
      q[size * i + j] /= sqrt(norm);
  }
}

/* s = p l p^-1 of any size 2, 3; orthonormal p: p^T. */
static inline void blocks_similar(int size, const double *p, const double *l, bool orthonormal,
                                  double *s) {
  double full[9] = {0, 0, 0, 0, 0, 0, 0, 0, 1}, inverse[9], left[9] = {0};
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++)
      full[3 * i + j] = p[size * i + j];
  if (size == 2)
    full[2] = full[5] = full[6] = full[7] = 0.0;
  if (orthonormal)
    for (int i = 0; i < 9; i++)
      inverse[i] = full[3 * (i % 3) + i / 3];
  else
    cdem_inverse3(full, inverse);
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++)
      for (int k = 0; k < size; k++)
        left[3 * i + j] += full[3 * i + k] * l[size * k + j];
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++) {
      s[size * i + j] = 0.0;
      for (int k = 0; k < size; k++)
        s[size * i + j] += left[3 * i + k] * inverse[3 * k + j];
    }
}

static inline void blocks_perturb(cdem_random *random, int n, double size, double *s) {
  double norm = cdem_frobenius(s, n);
  for (int e = 0; e < n; e++)
    s[e] += size * norm * blocks_uniform(random);
}

/* Diagonal or Jordan blocks in a rotated or oblique basis. */
static inline void blocks_structured(cdem_random *random, blocks_family family, int size,
                                     double *s) {
  double p[9], l[9] = {0}, k = blocks_uniform(random), other = blocks_uniform(random);
  bool orthonormal = family != BLOCKS_CONDITIONED && family != BLOCKS_DOUBLE;
  blocks_rotation(random, size, p);
  for (int i = 0; i < size; i++)
    l[(size + 1) * i] = i == 0 ? other : k;
  switch (family) {
  case BLOCKS_CONDITIONED:
    for (int i = 0; i < size; i++) {
      l[(size + 1) * i] = blocks_uniform(random);
      p[size * i] = p[size * i + 1] + blocks_small(random, 0.0, 8.0) * p[size * i];
    }
    break;
  case BLOCKS_DOUBLE:
    for (int e = 0; e < size * size; e++)
      p[e] = (e % (size + 1) == 0) + 0.3 * blocks_uniform(random);
    break;
  case BLOCKS_NEAR_JORDAN2:
    l[size * (size - 2) + size - 1] = blocks_uniform(random);
    break;
  case BLOCKS_NEAR_JORDAN3:
    l[0] = k;
    for (int i = 0; i + 1 < size; i++)
      l[size * i + i + 1] = blocks_uniform(random);
    break;
  case BLOCKS_NEAR_SPHERE:
    l[0] = k;
    break;
  default:
    break;
  }
  blocks_similar(size, p, l, orthonormal, s);
  if (family == BLOCKS_NEAR_JORDAN2 || family == BLOCKS_NEAR_JORDAN3)
    blocks_perturb(random, size * size, blocks_small(random, 2.0, 17.0), s);
  if (family == BLOCKS_NEAR_SPHERE)
    blocks_perturb(random, size * size, blocks_small(random, 1.0, 17.0), s);
  if (family == BLOCKS_TRANSVERSE)
    blocks_perturb(random, size * size, blocks_small(random, 12.0, 20.0), s);
}

static inline void blocks_make(cdem_random *random, blocks_family family, int size, double *s) {
  int n = size * size;
  double factor;
  for (int e = 0; e < n; e++)
    s[e] = blocks_uniform(random);
  switch (family) {
  case BLOCKS_SYMMETRIC:
  case BLOCKS_NEARLY_SYMMETRIC:
  case BLOCKS_SKEW:
    factor = family == BLOCKS_NEARLY_SYMMETRIC ? blocks_small(random, 2.0, 18.0) : 0.0;
    for (int i = 0; i < size; i++)
      for (int j = 0; j <= i; j++) {
        double lower = s[size * i + j], upper = s[size * j + i];
        s[size * i + j] = (family == BLOCKS_SKEW ? -upper : upper) + factor * lower;
        if (family == BLOCKS_SKEW && i == j)
          s[size * i + j] = 0.0;
      }
    break;
  case BLOCKS_ROTATION:
    blocks_rotation(random, size, s);
    break;
  case BLOCKS_RANK1:
    for (int e = n - 1; e >= size; e--)
      s[e] = s[e / size * size] * s[e % size];
    break;
  case BLOCKS_RANK2:
    for (int j = 0; j < size; j++)
      s[n - size + j] = size == 2 ? 0.0 : s[j] - 0.5 * s[size + j];
    break;
  case BLOCKS_INTEGERS:
    for (int e = 0; e < n; e++)
      s[e] = nearbyint(1.49 * s[e]);
    break;
  case BLOCKS_SCALED:
    factor = ldexp(1.0, (int)cdem_random_uniform(random, -900.0, 900.0));
    for (int e = 0; e < n; e++)
      s[e] *= factor;
    break;
  case BLOCKS_RANDOM:
    break;
  default:
    blocks_structured(random, family, size, s);
  }
}

/* Entry e of block i of a batched array. */
static inline int64_t blocks_place(int size, int64_t i, int e) {
  return i / 8 * size * size * 8 + e * 8 + i % 8;
}

/* L of a set without extra directions: rows -> matrix [size][size]. */
static inline void blocks_canonical(const cdem_spring_set *set, double *l) {
  int n = set->size;
  for (int e = 0; e < n * n; e++)
    l[e] = 0.0;
  for (int r = 0; r < set->rows; r++) {
    const cdem_spring_row *row = &set->row[r];
    l[(n + 1) * (row->spring - 1)] += row->stiffness;
    if (row->couples_to != 0)
      l[n * (row->spring - 1) + row->couples_to - 1] += row->coupling;
  }
}

static inline double blocks_dot(const double *a, const double *b, int n) {
  double sum = 0.0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* The last component above 1e-6 is positive; within 1e-9 of that bound either sign passes. */
static inline bool blocks_sign_ok(const double *dir, int n) {
  for (int c = n - 1; c >= 0; c--) {
    if (fabs(dir[c]) > 1e-6 + 1e-9)
      return dir[c] > 0.0;
    if (fabs(dir[c]) > 1e-6 - 1e-9)
      return true;
  }
  return false;
}

/* Fails with the set in words. */
static inline void blocks_fail(const cdem_spring_set *set, const char *law) {
  for (int r = 0; r < set->rows; r++) {
    const cdem_spring_row *row = &set->row[r];
    print_message("spring %d k %.17g couples to %d by %.17g dir %.17g %.17g %.17g\n", row->spring,
                  row->stiffness, row->couples_to, row->coupling, row->dir[0], row->dir[1],
                  row->dir[2]);
  }
  fail_msg("%s set of size %d, slow %d, cond %g: %s", cdem_form_name((cdem_form)set->form),
           set->size, set->slow, set->cond, law);
}

#define BLOCKS_LAW(condition)                                                                      \
  do {                                                                                             \
    if (!(condition))                                                                              \
      blocks_fail(set, #condition);                                                                \
  } while (0)

/* Laws of every set that is not a frame. */
static inline void blocks_check_laws(const cdem_spring_set *set) {
  int n = set->size;
  double l[9];
  blocks_canonical(set, l);
  bool complex_form = set->form == CDEM_FORM_COMPLEX;
  for (int k = 0; k < n; k++) {
    const cdem_spring_row *row = &set->row[k];
    assert_int_equal(row->spring, k + 1);
    /* Rounding, which grows like cond where a complex pair nearly merges. */
    check_near(blocks_dot(row->dir, row->dir, n), 1.0, 0.0, 1e-15 * (20.0 + set->cond));
    for (int j = 0; j < n; j++) /* dual rows invert the directions, but for rounding of size cond */
      check_near(blocks_dot(row->dual, set->row[j].dir, n), j == k, 0.0,
                 1e-15 * (10.0 + set->cond));
    if (!(complex_form && k == n - 1))
      BLOCKS_LAW(blocks_sign_ok(row->dir, n));
    if (set->form == CDEM_FORM_DIAGONAL) {
      assert_int_equal(row->couples_to, 0);
      BLOCKS_LAW(k == 0 || row->stiffness <= set->row[k - 1].stiffness);
    }
    if (n == 2)
      BLOCKS_LAW(row->dir[2] == 0.0 && row->dual[2] == 0.0);
  }
  for (int r = n; r < set->rows; r++) { /* an extra row repeats its spring */
    const cdem_spring_row *row = &set->row[r], *own = &set->row[row->spring - 1];
    BLOCKS_LAW(row->stiffness == 0.0 && row->couples_to != own->couples_to);
    assert_memory_equal(row->dir, own->dir, sizeof row->dir);
    assert_memory_equal(row->dual, own->dual, sizeof row->dual);
  }
  check_below(set->cond, CDEM_SPRINGS_MAX_COND);
  if (complex_form) {
    assert_int_equal(set->row[n - 2].couples_to, n);
    double b = l[n * (n - 2) + n - 1], c = l[n * (n - 1) + n - 2];
    BLOCKS_LAW(b > 0.0 && c < 0.0);
    check_below(-blocks_dot(set->row[n - 2].dir, set->row[n - 1].dir, n), 1e-13);
    check_near(set->row[n - 2].stiffness, set->row[n - 1].stiffness, 1e-15, 0.0);
  }
  if (set->form == CDEM_FORM_JORDAN2 || set->form == CDEM_FORM_JORDAN3)
    check_near(blocks_dot(set->row[n - 2].dir, set->row[n - 1].dir, n), 0.0, 0.0, 1e-14);
}

#endif
