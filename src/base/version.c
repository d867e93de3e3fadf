#include "base/version.h"

#include "base/simd.h"

/* What CMake knows comes as a text (CMakeLists.txt of this room), the rest from the compiler. */
#if defined _OPENMP && _OPENMP == 201511
#define OPENMP ", OpenMP 4.5"
#elif defined _OPENMP
#define OPENMP ", OpenMP"
#else
#define OPENMP ", without OpenMP"
#endif

#ifdef CDEM_MULTIVERSIONED
#define KERNELS ", kernels for three generations of processors"
#else
#define KERNELS ", kernels for the baseline processor"
#endif

const char *cdem_version(void) {
  return CDEM_VERSION;
}

const char *cdem_version_build(void) {
  return CDEM_BUILD OPENMP KERNELS;
}
