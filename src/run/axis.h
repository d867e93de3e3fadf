/* Private to run: axes and legends in units that keep their numbers short. */
#ifndef CDEM_RUN_AXIS_H
#define CDEM_RUN_AXIS_H

#include <stdint.h>

/* A unit with the SI prefix that keeps its numbers short: 0.0004 s is drawn as 0.4 ms. */
typedef struct {
  double factor;
  char unit[40];
} cdem_run_axis;

cdem_run_axis cdem_run_axis_for(const char *unit, double largest);
double cdem_run_largest(const double *value, int64_t count);
void cdem_run_rescale(double *value, int64_t count, double factor);

#endif
