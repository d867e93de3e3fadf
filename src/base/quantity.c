#include "base/quantity.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
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

/* ---- units ---- */

static const struct {
  const char *symbol;
  cdem_dimension dimension;
} symbols[] = {{"m", {1, 0, 0}},    {"s", {0, 1, 0}},  {"kg", {0, 0, 1}}, {"N", {1, -2, 1}},
               {"Pa", {-1, -2, 1}}, {"J", {2, -2, 1}}, {"W", {2, -3, 1}}, {"Hz", {0, -1, 0}},
               {"rad", {0, 0, 0}},  {"1", {0, 0, 0}}};

/* One symbol with its exponent, "m-2"; what is behind it, or NULL. */
static const char *take_symbol(const char *at, int sign, int sum[3]) {
  size_t length = *at == '1' ? 1 : 0;
  while (*at != '1' && isalpha((unsigned char)at[length]))
    length++;
  for (size_t i = 0; length > 0 && i < sizeof symbols / sizeof *symbols; i++) {
    if (strlen(symbols[i].symbol) != length || strncmp(symbols[i].symbol, at, length) != 0)
      continue;
    at += length;
    at += *at == '^';
    char *end = NULL;
    long power = isdigit((unsigned char)*at) || *at == '-' ? strtol(at, &end, 10) : 1;
    if (end == at || power < -9 || power > 9)
      return NULL;
    const cdem_dimension d = symbols[i].dimension;
    sum[0] += sign * (int)power * d.length;
    sum[1] += sign * (int)power * d.time;
    sum[2] += sign * (int)power * d.mass;
    return end != NULL ? end : at;
  }
  return NULL;
}

bool cdem_dimension_of_unit(const char *unit, cdem_dimension *dimension) {
  int sum[3] = {0}, sign = 1;
  for (const char *at = unit; *at != '\0'; sign = 1) {
    for (; *at == ' ' || *at == '.' || *at == '*' || *at == '/'; at++)
      sign = *at == '/' ? -1 : sign;
    at = take_symbol(at, sign, sum);
    if (at == NULL)
      return false;
  }
  for (int i = 0; i < 3; i++)
    if (sum[i] < -100 || sum[i] > 100)
      return false;
  *dimension = (cdem_dimension){(int8_t)sum[0], (int8_t)sum[1], (int8_t)sum[2]};
  return true;
}
