/* Both paths rebuild every block to 1e-12, obey the laws, and agree in the sense of springs.md:
 * same form away from the switch, three invariants, eigenvalues where cond(P) is small. */
#ifndef CDEM_TESTS_SPRINGS_RECONSTRUCT_H
#define CDEM_TESTS_SPRINGS_RECONSTRUCT_H

#include "springs/blocks.h"

enum { RECONSTRUCT_CHUNK = 1000 }; /* not a multiple of 8 times 4: the last batch is padded */

/* Invariants of the pair: trace, sum of principal minors, determinant. */
static inline void reconstruct_invariants(const double *m, int n, double invariant[3]) {
  if (n == 2) {
    invariant[0] = m[0] + m[3];
    invariant[1] = m[0] * m[3] - m[1] * m[2];
    invariant[2] = 0.0;
    return;
  }
  invariant[0] = m[0] + m[4] + m[8];
  invariant[1] = m[0] * m[4] - m[1] * m[3] + m[0] * m[8] - m[2] * m[6] + m[4] * m[8] - m[5] * m[7];
  invariant[2] = cdem_det3(m);
}

/* Least distance of two eigenvalues of a diagonal or complex L. */
static inline double reconstruct_gap(const double *l, int n) {
  double least = INFINITY;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      least = fmin(least, hypot(l[(n + 1) * i] - l[(n + 1) * j], l[n * i + j]));
  return least;
}

static inline void reconstruct_compare(const double *s, const cdem_spring_set *fast,
                                       const cdem_spring_set *robust) {
  int n = fast->size, exponent;
  double norm = cdem_frobenius(s, n * n), a[9], b[9], ia[3], ib[3];
  if (!(norm > 1e-90 && norm < 1e90)) /* cubes of stiffnesses leave the range */
    return;
  (void)frexp(norm, &exponent);
  blocks_canonical(fast, a);
  blocks_canonical(robust, b);
  for (int e = 0; e < n * n; e++)
    a[e] = ldexp(a[e], -exponent), b[e] = ldexp(b[e], -exponent);
  reconstruct_invariants(a, n, ia);
  reconstruct_invariants(b, n, ib);
  /* The residual 1e-12 allows each invariant a change of that size times |P| |P^-1|; both paths
   * stay far below it, so 1e-12 with the block scaled to 1 is asked of the invariants too. */
  for (int i = 0; i < 3; i++)
    check_near(ia[i], ib[i], 0.0, 1e-12);
  /* Directions turn by the rounding of the block times cond(P) over the least gap of values; where
   * that is 1e-6 the block has no definite form. */
  if (reconstruct_gap(a, n) > 5e-8 * fast->cond && fast->cond < 0.999 * CDEM_SPRINGS_MAX_COND) {
    assert_int_equal(fast->form, robust->form);
    check_near(fast->cond, robust->cond, 1e-6, 0.0);
  }
  if (fast->form == robust->form && fast->form <= CDEM_FORM_COMPLEX && fast->cond < 1e3)
    for (int e = 0; e < n * n; e++) /* eigenvalues move by cond(P) times a change of the block */
      check_near(a[e], b[e], 0.0, 1e-15 * (20.0 + fast->cond * fast->cond));
}

static inline void reconstruct_chunk(cdem_random *random, int size, int64_t *slow) {
  static double s[RECONSTRUCT_CHUNK * 9];
  static cdem_spring_set set[RECONSTRUCT_CHUNK];
  cdem_fault fault = {0};
  double block[9];
  for (int64_t i = 0; i < RECONSTRUCT_CHUNK; i++) {
    blocks_make(random, (blocks_family)(i % BLOCKS_FAMILIES), size, block);
    for (int e = 0; e < size * size; e++)
      s[blocks_place(size, i, e)] = block[e];
  }
  check_ok(cdem_springs_from_blocks(s, RECONSTRUCT_CHUNK, size, NULL, set, &fault));
  for (int64_t i = 0; i < RECONSTRUCT_CHUNK; i++) {
    for (int e = 0; e < size * size; e++)
      block[e] = s[blocks_place(size, i, e)];
    double residual = cdem_springs_residual(block, &set[i]);
    if (!(residual <= CDEM_SPRINGS_BOUND))
      fail_msg("block %d of family %d: residual %g", (int)i, (int)(i % BLOCKS_FAMILIES), residual);
    blocks_check_laws(&set[i]);
    slow[i % BLOCKS_FAMILIES] += set[i].slow;
    if (set[i].slow)
      continue;
    cdem_spring_set robust;
    check_ok(cdem_springs_from_block(block, size, false, &robust, &fault));
    check_below(cdem_springs_residual(block, &robust), CDEM_SPRINGS_BOUND);
    blocks_check_laws(&robust);
    reconstruct_compare(block, &set[i], &robust);
  }
}

static inline void reconstruct_many(int64_t blocks) {
  cdem_random random = {20060611};
  int64_t slow[2][BLOCKS_FAMILIES] = {{0}}, chunks = blocks / RECONSTRUCT_CHUNK / 2;
  for (int64_t chunk = 0; chunk < chunks; chunk++)
    for (int size = 2; size <= 3; size++)
      reconstruct_chunk(&random, size, slow[size - 2]);
  /* The fast path serves ordinary blocks itself: fewer than one in a thousand is done again. */
  double each = (double)(chunks * RECONSTRUCT_CHUNK) / BLOCKS_FAMILIES;
  for (int size = 2; size <= 3; size++)
    for (int f = 0; f < BLOCKS_FAMILIES; f++) {
      if (getenv("CDEM_TEST_VERBOSE") != NULL)
        print_message("size %d family %2d slow %.5f\n", size, f, (double)slow[size - 2][f] / each);
      if (f == BLOCKS_RANDOM || f == BLOCKS_SYMMETRIC || f == BLOCKS_SKEW || f == BLOCKS_ROTATION ||
          f == BLOCKS_TRANSVERSE)
        check_below((double)slow[size - 2][f], 1e-3 * each + 2.0);
    }
}

#endif
