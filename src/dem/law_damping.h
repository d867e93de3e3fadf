/* Private to the laws: dashpots found from the restitution they shall give.
 *
 * A collision of a spring and a dashpot that cannot pull, F = max(0, k d + c d'), ends when F
 * vanishes, before the overlap does (Schwager & Poeschel 2007, Granular Matter 9, 465). With
 * zeta = c/(2 sqrt(k m)) the force vanishes at w t = 2 acos(zeta)/sqrt(1 - zeta^2) (w^2 = k/m),
 * when the velocity is
 *
 *     e = exp(-2 zeta acos(zeta)/sqrt(1 - zeta^2)),    zeta > 1: acosh, sqrt(zeta^2 - 1)     (1)
 *
 * of the initial one; e(1) = exp(-2), e falls to 0 as zeta grows. Hertz with the dashpot of Tsuji
 * et al. (1992), c = alpha sqrt(m k(d)) with k the tangent stiffness, is the same oscillator in the
 * variable d^(5/4) (after Antypov & Elliott 2011, EPL 94, 50004), with zeta = sqrt(6/5) alpha/2;
 * its force vanishes where that of the oscillator does, so (1) holds for it too, whatever the
 * velocity. Tests: dem.law_two_body.
 */
#ifndef CDEM_DEM_LAW_DAMPING_H
#define CDEM_DEM_LAW_DAMPING_H

#include "dem/law.h"

/* e of (1), zeta >= 0. */
double cdem_law_restitution(double zeta);
/* zeta for 0 < e <= 1. */
double cdem_law_damping_for(double restitution);

/* The one of restitution, damping_ratio and, if `dashpot`, normal_dashpot that was given:
 * CDEM_INPUT unless it is exactly one. Either *zeta or *normal_dashpot is set, the other is 0. */
cdem_status cdem_law_damping(const cdem_contact_input *input, bool dashpot, double *zeta,
                             double *normal_dashpot, cdem_fault *fault);

#endif
