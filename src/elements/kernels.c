/* The hot path: moments and spring tensors of CDEM_LANES elements side by side.
 *
 * Points come in chunks, so that the gradients of a chunk stay in the first-level cache (24 KB for
 * hex8) whatever the rule. Gradients are kept without their division by the determinant: with
 * g = adj(J)^T dN/dxi (= det J grad N) the integrand w det (grad N_a)(grad N_b)^T is g_a (w/det)
 * g_b^T, and the factor goes once into the right-hand copy. The pair loop then does nine
 * multiply-adds on six loads a point, its nine sums in registers.
 *
 * The same body is compiled for vectors of 8, 4 and 2 doubles; the widest the processor has is
 * taken at each call.
 */
#include "base/simd.h"
#include "elements/basis.h"

#include <float.h>
#include <stdlib.h>

enum { CHUNK = 8, MAX_NODES = CDEM_SHAPE_MAX_NODES };

#if defined __x86_64__ && defined __GNUC__ && !defined CDEM_NO_MULTIVERSION
#define WIDE_VECTORS
#define WIDTH        8
#define KERNEL(name) name##_8
#define TARGET       __attribute__((target("arch=x86-64-v4")))
#include "elements/kernels_width.h"
#define WIDTH        4
#define KERNEL(name) name##_4
#define TARGET       __attribute__((target("arch=x86-64-v3")))
#include "elements/kernels_width.h"
#endif
#define WIDTH        2
#define KERNEL(name) name##_2
#define TARGET
#include "elements/kernels_width.h"

const cdem_kernels *cdem_kernels_of_width(int width) {
  static const cdem_kernels two = {moments_kernel_2, blocks_kernel_2};
#ifdef WIDE_VECTORS
  static const cdem_kernels eight = {moments_kernel_8, blocks_kernel_8};
  static const cdem_kernels four = {moments_kernel_4, blocks_kernel_4};
  if (width == 8)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl")
               ? &eight
               : NULL;
  if (width == 4)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                   __builtin_cpu_supports("bmi2")
               ? &four
               : NULL;
#endif
  return width == 2 ? &two : NULL;
}

static const cdem_kernels *widest(void) {
  const cdem_kernels *kernels = NULL;
  for (int width = CDEM_LANES; kernels == NULL; width /= 2)
    kernels = cdem_kernels_of_width(width);
  return kernels;
}

void cdem_moments_kernel(const cdem_tabulation *tabulation, const double *x, double *moment,
                         double *least) {
  widest()->moments(tabulation, x, moment, least);
}

void cdem_blocks_kernel(int pairs, const cdem_contraction *const contraction[CDEM_LANES],
                        const double *moment, double *s) {
  widest()->blocks(pairs, contraction, moment, s);
}

cdem_status cdem_element_pair_blocks(const cdem_tabulation *tabulation,
                                     const cdem_contraction *contraction, const double (*xyz)[3],
                                     double *s, cdem_fault *fault) {
  CDEM_TRY(cdem_element_check(tabulation, xyz, fault));
  int pairs = cdem_element_pairs(tabulation->element);
  int entries = contraction->dofs * contraction->dofs;
  double x[MAX_NODES * 3 * CDEM_LANES], least[CDEM_LANES], *moment, *block;
  const cdem_contraction *law[CDEM_LANES];
  CDEM_NEW(moment, (int64_t)2 * pairs * entries * CDEM_LANES, fault);
  block = moment + (ptrdiff_t)pairs * entries * CDEM_LANES;
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    law[lane] = contraction;
    for (int i = 0; i < 3 * tabulation->nodes; i++)
      x[CDEM_LANES * i + lane] = xyz[i / 3][i % 3];
  }
  cdem_moments_kernel(tabulation, x, moment, least);
  cdem_blocks_kernel(pairs, law, moment, block);
  for (int i = 0; i < pairs * entries; i++)
    s[i] = block[(ptrdiff_t)CDEM_LANES * i];
  free(moment);
  return CDEM_OK;
}
