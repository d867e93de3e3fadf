/* The hot path of the elastic body: CDEM_LANES elements side by side.
 *
 * The same body is compiled for vectors of 8, 4 and 2 doubles; the widest the processor has is
 * taken. Formulas are derived in docs/rooms/cdem-body.md; the reference in plain loops, which
 * shares no code with this, is body_reference.c.
 */
#include "base/simd.h"
#include "cdem/body_store.h"

#include <math.h>
#include <stdlib.h>

enum {
  MAX_TURNS = 8, /* corrections of a rotation; two serve rock, four any start */
  MAX_ROOTS = 40 /* Newton steps to the largest root of the quartic */
};
/* Up to this |grad u|^2 the corrections converge from no rotation at all. */
#define NEAR_IDENTITY 0.09
/* A rotation is found when its correction is below this part of |grad u|: rounding. */
#define TURN_FOUND 3e-15
/* Below this part of tr^3 the determinant of tr(U) I - U is zero: the rotation is not defined. */
#define FLAT_STRETCH 1e-13

#if defined __x86_64__ && defined __GNUC__ && !defined CDEM_NO_MULTIVERSION
#define WIDE_VECTORS
#define WIDTH        8
#define KERNEL(name) name##_8
#define TARGET       __attribute__((target("arch=x86-64-v4")))
#include "cdem/body_kernels_width.h"
#define WIDTH        4
#define KERNEL(name) name##_4
#define TARGET       __attribute__((target("arch=x86-64-v3")))
#include "cdem/body_kernels_width.h"
#endif
#define WIDTH        2
#define KERNEL(name) name##_2
#define TARGET
#include "cdem/body_kernels_width.h"

const cdem_body_kernels *cdem_body_kernels_of_width(int width) {
  static const cdem_body_kernels two = {forces_2, energies_2, stresses_2, determinants_2,
                                        frames_2, opens_2,    releases_2, bounds_2};
#ifdef WIDE_VECTORS
  static const cdem_body_kernels eight = {forces_8, energies_8, stresses_8, determinants_8,
                                          frames_8, opens_8,    releases_8, bounds_8};
  static const cdem_body_kernels four = {forces_4, energies_4, stresses_4, determinants_4,
                                         frames_4, opens_4,    releases_4, bounds_4};
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

const cdem_body_kernels *cdem_body_kernels_widest(void) {
  const cdem_body_kernels *kernels = NULL;
  for (int width = CDEM_LANES; kernels == NULL; width /= 2)
    kernels = cdem_body_kernels_of_width(width);
  return kernels;
}
