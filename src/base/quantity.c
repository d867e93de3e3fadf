#include "base/quantity.h"

#include <stdio.h>
#include <string.h>

static const struct {
  cdem_dimension dimension;
  const char *unit;
} named[] = {
    {{0, 0, 0}, "1"},  {{1, 0, 0}, "m"},    {{0, 1, 0}, "s"},
    {{0, 0, 1}, "kg"}, {{-1, -2, 1}, "Pa"}, {{1, -2, 1}, "N"},
    {{2, -2, 1}, "J"}, {{0, -2, 1}, "N/m"}, {{-2, -2, 1}, "Pa/m"},
};

char *cdem_dimension_unit(cdem_dimension dimension, char text[48]) {
  for (size_t i = 0; i < sizeof named / sizeof named[0]; i++)
    if (memcmp(&named[i].dimension, &dimension, sizeof dimension) == 0) {
      snprintf(text, 48, "%s", named[i].unit);
      return text;
    }
  const char *const base[] = {"kg", "m", "s"};
  const int exponent[] = {dimension.mass, dimension.length, dimension.time};
  size_t used = 0;
  for (int i = 0; i < 3; i++) {
    if (exponent[i] == 0)
      continue;
    used += (size_t)snprintf(text + used, 48 - used, "%s%s", used > 0 ? " " : "", base[i]);
    if (exponent[i] != 1)
      used += (size_t)snprintf(text + used, 48 - used, "%d", exponent[i]);
  }
  return text;
}
