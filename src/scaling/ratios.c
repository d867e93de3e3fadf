/* Base ratios and the factors that follow from them. */
#include "scaling/scaling.h"

#include <math.h>
#include <string.h>

cdem_ratios cdem_ratios_of_size(double h) {
  return (cdem_ratios){h, h, h * h * h};
}

/* Numerator and denominator apart, each multiplied in one order: a factor that is 1 by eq 9
 * (density, stress, velocity) comes out as 1 whatever h is. */
double cdem_ratio(const cdem_ratios *ratios, cdem_dimension dimension) {
  const double base[3] = {ratios->length, ratios->time, ratios->mass};
  const int power[3] = {dimension.length, dimension.time, dimension.mass};
  double above = 1.0, below = 1.0;
  for (int i = 0; i < 3; i++) {
    for (int n = 0; n < power[i]; n++)
      above *= base[i];
    for (int n = 0; n > power[i]; n--)
      below *= base[i];
  }
  return above / below;
}

static bool is_power_of_two(double x) {
  int exponent;
  return x > 0.0 && isfinite(x) && frexp(x, &exponent) == 0.5;
}

bool cdem_ratios_are_exact(const cdem_ratios *ratios) {
  return is_power_of_two(ratios->length) && is_power_of_two(ratios->time) &&
         is_power_of_two(ratios->mass);
}

cdem_scaling cdem_scaling_exact(cdem_ratios ratios) {
  return (cdem_scaling){.ratios = ratios};
}

cdem_scaling cdem_scaling_coarse(double h, int dim) {
  return (cdem_scaling){
      .ratios = cdem_ratios_of_size(h), .coarse = true, .rule = true, .slow = true, .dim = dim};
}

static bool is(cdem_dimension dimension, int length, int time, int mass) {
  return dimension.length == length && dimension.time == time && dimension.mass == mass;
}

/* A number of the domain in coarse graining. */
static double domain_factor(const cdem_scaling *s, cdem_dimension d, bool keeps_rate) {
  bool drives = is(d, 0, 1, 0) || is(d, 1, -1, 0) || is(d, 0, -1, 0); /* s, m/s, 1/s */
  if (drives)
    return !s->slow || keeps_rate ? 1.0 : d.time > 0 ? s->ratios.time : 1.0 / s->ratios.time;
  /* N, N m or J, kg: of the whole thickness, which is the grains' */
  bool extends = is(d, 1, -2, 1) || is(d, 2, -2, 1) || is(d, 0, 0, 1);
  return s->dim == 2 && s->rule && extends ? s->ratios.length : 1.0;
}

double cdem_scaling_factor(const cdem_scaling *scaling, cdem_dimension dimension,
                           cdem_scale_tag tag, bool keeps_rate) {
  if (!scaling->coarse)
    return cdem_ratio(&scaling->ratios, dimension);
  switch (tag) {
  case CDEM_TAG_DOMAIN:
    return domain_factor(scaling, dimension, keeps_rate);
  case CDEM_TAG_GRAIN:
    return scaling->rule || is(dimension, 1, 0, 0) ? cdem_ratio(&scaling->ratios, dimension) : 1.0;
  case CDEM_TAG_LAW:
    return scaling->rule ? cdem_ratio(&scaling->ratios, dimension) : 1.0;
  default:
    return 1.0;
  }
}
