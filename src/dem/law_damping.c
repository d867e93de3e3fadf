#include "dem/law_damping.h"

#include <math.h>

/* -ln e = 2 zeta acos(zeta)/sqrt(1 - zeta^2), smooth and growing through zeta = 1. */
static double exponent(double zeta) {
  double s = (1.0 - zeta) * (1.0 + zeta);
  /* acos(z)/sqrt(1 - z^2) = atan(y)/(z y), y = sqrt(1 - z^2)/z: series where y is small. */
  if (fabs(s) < 1e-6 * zeta * zeta) {
    double y2 = s / (zeta * zeta);
    return 2.0 * (1.0 - y2 / 3.0 + y2 * y2 / 5.0);
  }
  if (s > 0.0)
    return 2.0 * zeta * atan2(sqrt(s), zeta) / sqrt(s);
  return 2.0 * zeta * asinh(sqrt(-s)) / sqrt(-s);
}

double cdem_law_restitution(double zeta) {
  return exp(-exponent(zeta));
}

double cdem_law_damping_for(double restitution) {
  if (restitution >= 1.0)
    return 0.0;
  double wanted = -log(restitution);
  /* pi zeta >= exponent(zeta) brackets from below; doubling finds the other side. */
  double low = wanted / 4.0, high = wanted;
  while (exponent(low) > wanted)
    low *= 0.5;
  while (exponent(high) < wanted)
    high *= 2.0;
  for (int i = 0; i < 200; i++) {
    double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high)
      break;
    if (exponent(middle) < wanted)
      low = middle;
    else
      high = middle;
  }
  return high;
}

cdem_status cdem_law_damping(const cdem_contact_input *input, bool dashpot, double *zeta,
                             double *normal_dashpot, cdem_fault *fault) {
  double e = input->value[CDEM_LAW_restitution], ratio = input->value[CDEM_LAW_damping_ratio],
         c = input->value[CDEM_LAW_normal_dashpot];
  int given = !isnan(e) + !isnan(ratio) + (dashpot && !isnan(c));
  CDEM_REQUIRE(given == 1, fault, CDEM_INPUT,
               "%s of 'restitution'%s 'damping_ratio'%s %s given: give exactly one",
               given == 0 ? "none" : "more than one", dashpot ? "," : " and",
               dashpot ? " and 'normal_dashpot'" : "", given == 0 ? "was" : "were");
  *zeta = !isnan(e) ? cdem_law_damping_for(e) : !isnan(ratio) ? ratio : 0.0;
  *normal_dashpot = given == 1 && isnan(e) && isnan(ratio) ? c : 0.0;
  return CDEM_OK;
}
