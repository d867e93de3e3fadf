#include "verify/maw.h"

#include <math.h>

enum { SPRINGS = 200, STEPS = 2000 };

/* One half of the line of springs: forces over E* dx. */
typedef struct {
  double profile[SPRINGS], tangential[SPRINGS];
} springs;

/* Unit mass, E*, R, friction and normal velocity: the answer depends on nothing else. Returns the
 * normal force; *shear is the force against sliding. */
static double forces(springs *s, double width, double ratio, double depth, double slide,
                     double *shear) {
  double normal = 0.0;
  *shear = 0.0;
  for (int k = 0; k < SPRINGS; k++) {
    double push = depth - s->profile[k];
    if (push <= 0.0) {
      s->tangential[k] = 0.0;
      continue;
    }
    double pull = s->tangential[k] + ratio * slide;
    s->tangential[k] = fmin(fmax(pull, -push), push);
    normal += push;
    *shear += s->tangential[k];
  }
  *shear *= 2.0 * width;
  return 2.0 * width * normal;
}

double cdem_maw_rebound(double poisson, double inertia, double incidence) {
  const double ratio = 2.0 * (1.0 - poisson) / (2.0 - poisson); /* tangential to normal modulus */
  const double deepest = pow(15.0 / 16.0, 0.4), step = 2.9433 * deepest / STEPS;
  const double width = 1.0001 * sqrt(deepest) / SPRINGS, lightness = 1.0 + 1.0 / inertia;
  springs s;
  for (int k = 0; k < SPRINGS; k++) {
    double x = (k + 0.5) * width;
    s.profile[k] = x * x;
    s.tangential[k] = 0.0;
  }
  double depth = 0.0, approach = 1.0, sliding = incidence, shear;
  do { /* half steps of velocity are all there is to keep: forces are nothing at the start */
    depth += step * approach;
    double normal = forces(&s, width, ratio, depth, step * sliding, &shear);
    approach -= step * normal;
    sliding -= step * lightness * shear;
  } while (depth > 0.0);
  return sliding;
}
