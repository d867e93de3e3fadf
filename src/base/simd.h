/* Function multiversioning: one hot function, compiled for several generations of x86-64 processor,
 * the best of which is chosen when the program starts.
 *
 *     CDEM_MULTIVERSION void cdem_some_kernel(...) { ... }
 *
 * x86-64-v4 has AVX-512 (8 doubles), v3 has AVX2 with fused multiply-add (4), the default SSE2 (2).
 * Helpers that the function calls must be inlined into it (static inline, CDEM_ALWAYS_INLINE), or
 * they stay at the baseline. Under -std=c17 the compilers fuse multiply and add only with
 * -ffp-contract=fast, which the room sets for the file of its kernels. CDEM_NO_MULTIVERSION (the
 * sanitizer builds) keeps the baseline alone: the choice is made before their run time is up. So
 * does clang, whose version 14 gives the function a name of its own that no caller finds. Helpers
 * are then left as functions: watched, and inlined into every kernel, they keep a compiler for
 * minutes instead of seconds.
 */
#ifndef CDEM_BASE_SIMD_H
#define CDEM_BASE_SIMD_H

#if defined __x86_64__ && defined __GNUC__ && !defined __clang__ && !defined CDEM_NO_MULTIVERSION
#define CDEM_MULTIVERSIONED
#define CDEM_MULTIVERSION                                                                          \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CDEM_MULTIVERSION
#endif

#ifdef CDEM_NO_MULTIVERSION
#define CDEM_ALWAYS_INLINE static inline
#else
#define CDEM_ALWAYS_INLINE static inline __attribute__((always_inline))
#endif

/* Eight doubles side by side, as the compiler's own vector. Arrays of double are read and written
 * through cdem_vec8_at, which asks for no alignment. Hand both on by pointer: by value the calling
 * convention depends on the processor. On a processor without AVX-512 gcc takes such a vector apart
 * through memory: good for moving data, ten times too slow for arithmetic (there, plain loops over
 * lanes, or one body per width as in elements/kernels.c). */
typedef double cdem_vec8 __attribute__((vector_size(64)));
typedef double cdem_vec8_at __attribute__((vector_size(64), aligned(8), may_alias));

#endif
