/* Numbers as they stand in memory: -0 is not 0, and a NaN is itself. */
#ifndef CDEM_BASE_BITS_H
#define CDEM_BASE_BITS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static inline bool cdem_same_bits(double a, double b) {
  uint64_t one, two;
  memcpy(&one, &a, sizeof one);
  memcpy(&two, &b, sizeof two);
  return one == two;
}

#endif
