/* Private to run: Kirsch's solution (1898), an infinite plate under tension along x with a round
 * hole, at any radius. With p the tension, c = a^2/r^2:
 *
 *     s_rr = p/2 (1 - c) + p/2 (1 - 4 c + 3 c^2) cos 2 theta
 *     s_tt = p/2 (1 + c) - p/2 (1 + 3 c^2) cos 2 theta
 *     s_rt = -p/2 (1 + 2 c - 3 c^2) sin 2 theta                                            (1)
 *
 * Checked: s_rr = s_rt = 0 at r = a; s_xx -> p far away; both equations of equilibrium (tests/run).
 */
#ifndef CDEM_RUN_KIRSCH_H
#define CDEM_RUN_KIRSCH_H

#include <math.h>

/* stress: xx yy xy at (x, y) from the hole's centre. */
static inline void cdem_run_kirsch(double tension, double radius, double x, double y,
                                   double stress[3]) {
  double r2 = x * x + y * y, c = radius * radius / r2, p = 0.5 * tension;
  double cosine = (x * x - y * y) / r2, sine = 2.0 * x * y / r2; /* of 2 theta */
  double rr = p * (1.0 - c) + p * (1.0 - 4.0 * c + 3.0 * c * c) * cosine;
  double tt = p * (1.0 + c) - p * (1.0 + 3.0 * c * c) * cosine;
  double rt = -p * (1.0 + 2.0 * c - 3.0 * c * c) * sine;
  double mean = 0.5 * (rr + tt), half = 0.5 * (rr - tt);
  stress[0] = mean + half * cosine - rt * sine;
  stress[1] = mean - half * cosine + rt * sine;
  stress[2] = half * sine + rt * cosine;
}

#endif
