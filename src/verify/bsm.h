/* Private to verify: what the checks of the group "bsm" measure. Each function fills one number;
 * the parameter chooses the case. The coarse medium comes first, then its coupling with grains. */
#ifndef CDEM_VERIFY_BSM_H
#define CDEM_VERIFY_BSM_H

#include "base/base.h"

#define CDEM_BSM_MEASURES(X)                                                                       \
  X(cosserat_patch) /* 100 material (0 isotropic, 1 lattice) + 10 element (0 quad4, 1 tri3) +      \
                     field (0 turned with the spin, 1 asymmetric shear, 2 linear rotation):        \
                     largest error of the free nodes and of the energy, relative */                \
  X(hole_closed)    /* R/l = 1.063, nu = 0.3; 0..3: N = 0.25, 0.5, 0.75, 0.9; 4: N = 1e-3 */       \
  X(hole)           /* the same by the static solver: 0..3 factor over the closed one, 20 + the    \
                     same: on a mesh twice as fine, 10 + the same: order of its error, 30 + the    \
                     same: order of the rotations' error */                                        \
  X(waves)          /* |R| of the interface, largest difference of measured and derived over some  \
                     waves, by the table in bsm_waves_checks.c */                                  \
  X(waves_energy) /* h = 5 a, a pulse above the cutoff: 0 part of its energy that enters the body, \
                   1 error of the books */                                                         \
  X(waves_derived) /* h = 10 a: 0 slope of |R| over its limit, 1 |R|/(k a) at the matched place,   \
                    above the cutoff: 2 largest of | |R| - 1 |, 4 and 5 largest |R|^2 with layers, \
                    7 as 2, m = 10; below it: 3 error of the sum of energies, 6 loss in layers */

#define X(name)                                                                                    \
  cdem_status cdem_bsm_measure_##name(int parameter, double *value, cdem_fault *fault);
CDEM_BSM_MEASURES(X)
#undef X

#endif
