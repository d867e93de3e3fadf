/* What the benchmarks share: clocks, and the end of a run that cannot go on. */
#ifndef CDEM_BENCH_BENCH_H
#define CDEM_BENCH_BENCH_H

#include "base/base.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Seconds of a clock. */
static inline double clock_now(clockid_t clock) {
  struct timespec time;
  clock_gettime(clock, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static inline void give_up(cdem_status status, const cdem_fault *fault) {
  if (status == CDEM_OK)
    return;
  fprintf(stderr, "error: %s\n", fault->message);
  exit(cdem_status_exit_code(status));
}

#endif
