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
  X(counts)         /* fine grains of the foundation: 0 r = 0.05 m, 1 r = 0.03 m */                \
  X(identity) /* of the projector, masses all different, relative: 0 PP - P, 1 QN, 2 N^T Mp Q, 3   \
                 split of the kinetic energy, 4 linear fields */                                   \
  X(patch) /* 10 form (0 interface, 1 virtual work) + size (0 h = 1 m, 1 h = 0.5 m): largest force \
              left at the edge of the fine region by traction times h, four strains */             \
  X(foundation) /* assembly A, coupled against grains everywhere, means of 58 to 60 ms, relative:  \
                   damping in 1/s + 1000 (0 load, 1 peak, 2 place of the peak in m, 3 largest      \
                   effective, 4 least volumetric strain, 5 least volumetric, 6 largest effective   \
                   stress) */                                                                      \
  X(softening)  /* load at 60 mm over the peak, coupled: assembly 0 A, 1 B, 2 C */                 \
  X(bands)      /* 10 assembly + 0 left, 1 right: direction in degrees, 2, 3: slenderness */       \
  X(bonded)   /* bonded grains at 60 mm against bonded grains everywhere: 0 load, 1 with elements  \
                 half as large, 2 error of the first over that of the null, 3 energy book */       \
  X(undamped) /* bonded, no damping, 300 ms: 0 load, 1 coarse kinetic energy, last over early */   \
  X(solid_footing) /* bonded spheres, coupled against spheres everywhere: 0 load at the end, 1     \
                      over the curve, 2 error over that of the null, 3 energy book */              \
  X(cemented) /* a body that breaks: 0 unbroken against one body, 1 energy book, 2 a larger fine   \
                 region over the curve, 3 at the end */                                            \
  X(solid_identity) /* spheres in distorted bricks: 0 P^2 = P, 1 Q N = 0, 2 N^T Mp Q = 0, 3 the    \
                     kinetic energy splits, 4 linear fields are reproduced: largest error,         \
                     relative */                                                                   \
  X(solid_lattice)  /* bonded cubic lattice, free to spin: 0 c11 in kn/(2 r), 1 c12 in the same, 2 \
                     c44 in ks/(4 r) */                                                            \
  X(solid_patch)    /* 10 spheres along an element + field (0 pulled across a face, 1 sheared, 2   \
                     turned): largest residual of an edge node in traction h^2 */                  \
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
