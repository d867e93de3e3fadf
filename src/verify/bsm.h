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
  X(solid_identity) /* spheres in distorted bricks: 0 P^2 = P, 1 Q N = 0, 2 N^T Mp Q = 0, 3 the    \
                     kinetic energy splits, 4 linear fields are reproduced: largest error,         \
                     relative */                                                                   \
  X(solid_lattice)  /* bonded cubic lattice, free to spin: 0 c11 in kn/(2 r), 1 c12 in the same, 2 \
                     c44 in ks/(4 r) */                                                            \
  X(solid_patch)    /* 10 spheres along an element + field (0 pulled across a face, 1 sheared, 2   \
                     turned): largest residual of an edge node in traction h^2 */

#define X(name)                                                                                    \
  cdem_status cdem_bsm_measure_##name(int parameter, double *value, cdem_fault *fault);
CDEM_BSM_MEASURES(X)
#undef X

#endif
