/* Private to verify: what the checks of the group "fdem" measure. Each function fills one number;
 * the parameter chooses the case. */
#ifndef CDEM_VERIFY_FDEM_H
#define CDEM_VERIFY_FDEM_H

#include "base/base.h"

#define CDEM_FDEM_MEASURES(X)                                                                      \
  X(sizes)  /* the source's grain: 0 elements, 1 nodes, 2 surface nodes, 3 elastic modes */        \
  X(strain) /* a ball pulled evenly, answered by modes: worst error of strain; refinement */       \
  X(lamb)   /* a free ball, wave number of the lowest vibration, extrapolated: 0, 1 torsion from   \
               cubesphere 2 and 4, 4 and 6; 2 spheroidal, 4 and 6, nu = 1/4; 3: error of torsion,  \
               4 by 2 */                                                                           \
  X(hertz)  /* two balls pressed together, cubesphere of this refinement: error of the force in    \
               parts of what the facets may make of it; negative: the error by that of the         \
               refinement before */                                                                \
  X(rigid)  /* stiff balls against the law penalty, 10 shape + overlap (3, 5, 8 % of r): force by  \
               that at the overlap of the facets; shapes: 0 icosphere 1, 1 tetrasphere 2, 2        \
               cubesphere 4; 30 + overlap: error against smooth spheres, tetrasphere 2 by 1 */     \
  X(bounce) /* a ball on a floor: 0 energy it leaves with, of that it came with; 1 book with       \
               friction and dashpots, 2 the same, implicit; 3 error of the book, a fourth of the   \
               step by the whole */                                                                \
  X(roll)   /* down a slope: 0 acceleration, 1 slip of the contact by the speed */                 \
  X(spin)   /* a box that tumbles: 0 momentum, 1 angular momentum, 2 energy, half by whole step */ \
  X(cloud)  /* balls that collide: 0 momentum, 1 angular momentum, 2 book, 3 numbers that differ   \
               between one thread and two */

#define X(name)                                                                                    \
  cdem_status cdem_fdem_measure_##name(int parameter, double *value, cdem_fault *fault);
CDEM_FDEM_MEASURES(X)
#undef X

#endif
