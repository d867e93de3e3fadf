#include "base/series.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---- values ---- */

static double table_at(const cdem_series *s, double time) {
  int low = 0, high = s->points - 1;
  if (s->points == 0)
    return 0.0;
  if (!(time > s->time[0]))
    return s->value[0];
  if (time >= s->time[high])
    return s->value[high];
  while (high - low > 1) { /* time[low] <= time < time[high] */
    int middle = low + (high - low) / 2;
    if (s->time[middle] <= time)
      low = middle;
    else
      high = middle;
  }
  double part = (time - s->time[low]) / (s->time[high] - s->time[low]);
  return s->value[low] + part * (s->value[high] - s->value[low]);
}

double cdem_series_at(const cdem_series *series, double time) {
  double after = time - series->start;
  if (series->kind == CDEM_SERIES_TABLE)
    return table_at(series, time);
  if (series->kind == CDEM_SERIES_SINE) {
    double angle = series->phase + (after > 0.0 ? 2.0 * pi * series->frequency * after : 0.0);
    return series->offset + series->amplitude * sin(angle);
  }
  if (!(after > 0.0 && after < series->duration))
    return series->offset;
  double wave = sin(pi * after / series->duration);
  return series->offset + series->amplitude * wave * wave;
}

/* ---- integrals from a to b, a <= b ---- */

/* Trapezoids between the breaks inside (a, b): exact, and free of the cancellation that the
 * difference of two antiderivatives would bring. */
static double table_integral(const cdem_series *s, double a, double b) {
  double sum = 0.0, from = a, before = table_at(s, a);
  for (int i = 0; i < s->points && s->time[i] < b; i++) {
    if (s->time[i] <= a)
      continue;
    sum += 0.5 * (before + s->value[i]) * (s->time[i] - from);
    from = s->time[i];
    before = s->value[i];
  }
  return sum + 0.5 * (before + table_at(s, b)) * (b - from);
}

/* Of sin(phase + w x) over 0 <= p <= x <= q: (cos(phase + w p) - cos(phase + w q))/w as a product,
 * which also holds for w = 0. */
static double sine_integral(const cdem_series *s, double p, double q) {
  double w = 2.0 * pi * s->frequency, half = 0.5 * w * (q - p);
  double ratio = half != 0.0 ? sin(half) / half : 1.0;
  return (q - p) * sin(s->phase + 0.5 * w * (p + q)) * ratio;
}

/* Of sin^2(pi x/d) over 0 <= p <= x <= q <= d. */
static double pulse_integral(double d, double p, double q) {
  return 0.5 * (q - p) - d / (4.0 * pi) * (sin(2.0 * pi * q / d) - sin(2.0 * pi * p / d));
}

static double integral(const cdem_series *s, double a, double b) {
  if (s->kind == CDEM_SERIES_TABLE)
    return table_integral(s, a, b);
  double sum = s->offset * (b - a);
  double p = a > s->start ? a - s->start : 0.0, q = b > s->start ? b - s->start : 0.0;
  if (s->kind == CDEM_SERIES_SINE) {
    double rest = (b < s->start ? b : s->start) - a; /* what of it lies before the start */
    if (rest > 0.0)
      sum += s->amplitude * sin(s->phase) * rest;
    return sum + s->amplitude * sine_integral(s, p, q);
  }
  if (!(s->duration > 0.0))
    return sum;
  p = p < s->duration ? p : s->duration;
  q = q < s->duration ? q : s->duration;
  return sum + s->amplitude * pulse_integral(s->duration, p, q);
}

double cdem_series_integral(const cdem_series *series, double time) {
  return time >= 0.0 ? integral(series, 0.0, time) : -integral(series, time, 0.0);
}

/* ---- making ---- */

cdem_status cdem_series_table(int points, const double *time, const double *value,
                              cdem_series *series, cdem_fault *fault) {
  CDEM_REQUIRE(points >= 1, fault, CDEM_INPUT, "a table needs at least one point, not %d", points);
  for (int i = 0; i < points; i++) {
    CDEM_REQUIRE(isfinite(time[i]) && isfinite(value[i]), fault, CDEM_INPUT,
                 "point %d of the table is not finite: %g at %g s", i + 1, value[i], time[i]);
    CDEM_REQUIRE(i == 0 || time[i] > time[i - 1], fault, CDEM_INPUT,
                 "the times of a table must ascend: point %d is at %g s, the one before it at %g s",
                 i + 1, time[i], i > 0 ? time[i - 1] : 0.0);
  }
  cdem_series made = {.kind = CDEM_SERIES_TABLE, .points = points};
  made.time = cdem_allocate(points, sizeof *made.time, fault);
  made.value = cdem_allocate(points, sizeof *made.value, fault);
  if (made.time == NULL || made.value == NULL) {
    cdem_series_release(&made);
    return CDEM_MEMORY;
  }
  memcpy(made.time, time, (size_t)points * sizeof *time);
  memcpy(made.value, value, (size_t)points * sizeof *value);
  *series = made;
  return CDEM_OK;
}

cdem_status cdem_series_constant(double value, cdem_series *series, cdem_fault *fault) {
  const double time = 0.0;
  return cdem_series_table(1, &time, &value, series, fault);
}

cdem_status cdem_series_copy(const cdem_series *from, cdem_series *to, cdem_fault *fault) {
  if (from->kind == CDEM_SERIES_TABLE && from->points > 0)
    return cdem_series_table(from->points, from->time, from->value, to, fault);
  *to = *from;
  to->time = to->value = NULL;
  return CDEM_OK;
}

bool cdem_series_same(const cdem_series *a, const cdem_series *b) {
  if (a->kind != b->kind || a->points != b->points || a->offset != b->offset ||
      a->amplitude != b->amplitude || a->frequency != b->frequency || a->phase != b->phase ||
      a->start != b->start || a->duration != b->duration)
    return false;
  for (int i = 0; i < a->points && a->kind == CDEM_SERIES_TABLE; i++)
    if (a->time[i] != b->time[i] || a->value[i] != b->value[i])
      return false;
  return true;
}

void cdem_series_release(cdem_series *series) {
  free(series->time);
  free(series->value);
  *series = (cdem_series){0};
}
