/* For threads.sh: a sum over threads, right or, with RACE, wrong. The sanitizer must tell the two
 * apart. */
#include <stdio.h>

int main(void) {
  enum { COUNT = 1000 };
  static double part[COUNT];
  double sum = 0.0;
#pragma omp parallel for
  for (int i = 0; i < COUNT; i++)
    part[i] = i;
#ifdef RACE
#pragma omp parallel for
#else
#pragma omp parallel for reduction(+ : sum)
#endif
  for (int i = 0; i < COUNT; i++)
    sum += part[COUNT - 1 - i]; /* written by another thread, before the barrier */
  printf("%g\n", sum);
  return 0;
}
