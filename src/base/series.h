/* Functions of time: what a load, a support or a plate follows.
 *
 * A table is piecewise linear and constant before its first and after its last point; a constant is
 * a table of one point, a ramp one of two. A sine is offset + amplitude sin(2 pi frequency (t -
 * start) + phase) from `start` on and its value at `start` before. A pulse is offset + amplitude
 * sin^2(pi (t - start)/duration) while it lasts and `offset` elsewhere: smooth, with a continuous
 * first derivative.
 */
#ifndef CDEM_BASE_SERIES_H
#define CDEM_BASE_SERIES_H

#include "base/fault.h"

#include <stdbool.h>

typedef enum { CDEM_SERIES_TABLE, CDEM_SERIES_SINE, CDEM_SERIES_PULSE } cdem_series_kind;

typedef struct {
  cdem_series_kind kind;
  int points;    /* of a table, >= 1; 0: the function zero */
  double *time;  /* [points] s, strictly ascending */
  double *value; /* [points] */
  double offset, amplitude;
  double frequency, phase; /* Hz, rad */
  double start, duration;  /* s */
} cdem_series;

double cdem_series_at(const cdem_series *series, double time);
/* The integral from 0 to `time`, exact: the path of a prescribed velocity. */
double cdem_series_integral(const cdem_series *series, double time);
cdem_status cdem_series_constant(double value, cdem_series *series, cdem_fault *fault);
cdem_status cdem_series_table(int points, const double *time, const double *value,
                              cdem_series *series, cdem_fault *fault);
cdem_status cdem_series_copy(const cdem_series *from, cdem_series *to, cdem_fault *fault);
/* Written alike: the same kind and the same numbers. */
bool cdem_series_same(const cdem_series *a, const cdem_series *b);
void cdem_series_release(cdem_series *series);

#endif
