/* Random numbers that are the same everywhere: splitmix64 (Steele, Lea, Flood 2014). One 64-bit
 * state, no globals, so that a seed in a case gives the same run on every machine and thread count.
 */
#ifndef CDEM_BASE_RANDOM_H
#define CDEM_BASE_RANDOM_H

#include <stdint.h>

typedef struct {
  uint64_t state; /* the seed, at first */
} cdem_random;

static inline uint64_t cdem_random_next(cdem_random *random) {
  uint64_t z = (random->state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* Uniform in [low, high). */
static inline double cdem_random_uniform(cdem_random *random, double low, double high) {
  return low + (high - low) * (double)(cdem_random_next(random) >> 11) * 0x1.0p-53;
}

#endif
