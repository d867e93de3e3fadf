/* Axes and legends in units that keep their numbers short. */
#include "run/axis.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

cdem_run_axis cdem_run_axis_for(const char *unit, double largest) {
  static const char *const prefixed[] = {"s", "m", "m/s", "N", "N m", "Pa", "J"};
  static const struct {
    double size;
    const char *symbol;
  } prefix[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"}, {1.0, ""},
                {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}};
  cdem_run_axis found = {.factor = 1.0};
  snprintf(found.unit, sizeof found.unit, "%.30s", unit);
  bool known = false;
  for (size_t i = 0; i < sizeof prefixed / sizeof prefixed[0]; i++)
    known = known || strcmp(unit, prefixed[i]) == 0;
  for (size_t i = 0; known && largest > 0.0 && i < sizeof prefix / sizeof prefix[0]; i++)
    if (largest * (1.0 + 1e-6) >= prefix[i].size || i + 1 == sizeof prefix / sizeof prefix[0]) {
      found.factor = 1.0 / prefix[i].size;
      snprintf(found.unit, sizeof found.unit, "%s%.30s", prefix[i].symbol, unit);
      break;
    }
  return found;
}

double cdem_run_largest(const double *value, int64_t count) {
  double largest = 0.0;
  for (int64_t i = 0; i < count; i++)
    if (fabs(value[i]) > largest)
      largest = fabs(value[i]);
  return largest;
}

void cdem_run_rescale(double *value, int64_t count, double factor) {
  for (int64_t i = 0; i < count; i++)
    value[i] *= factor;
}
