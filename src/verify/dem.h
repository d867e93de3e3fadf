/* Private to verify: what the checks of the group "dem" measure. Each function fills one number;
 * the parameter chooses the case. */
#ifndef CDEM_VERIFY_DEM_H
#define CDEM_VERIFY_DEM_H

#include "base/base.h"

#define CDEM_DEM_MEASURES(X)                                                                       \
  X(two_spheres)  /* Chung & Ooi 1: 0..2 glass, 3..5 limestone: peak force, overlap, duration */   \
  X(sphere_plane) /* 2: 0..2 aluminium, 3..5 magnesium */                                          \
  X(restitution)  /* 3: 0 aluminium oxide, 1 cast iron: worst of out less in; 2, 3: linear law */  \
  X(oblique)      /* 4: 0..2 sliding branch: restitution, spin, angle; 3..5 printed series; 6, 7   \
                     theory: all, from 20 degrees; 8, 9 mindlin: theory, two materials */          \
  X(micron)   /* 5: 0, 1 sliding branch: rebound, spin; 2, 3 printed ones; 4 theory; 5: the theory \
                 against finite elements; mindlin: 6, 7 theory, 8 finite elements */               \
  X(spinning) /* 6: 0 sliding branch, 1 nylon's; printed: 2 beta to 2.1, 3 recoil, 4 all beta; 5,  \
                 6 mindlin: theory, two materials */                                               \
  X(gears)    /* 7: 0 spin, 1 tangential velocity */                                               \
  X(unequal)  /* 8: 0, 1 sliding branch of two materials; 2, 3 mindlin: theory */                  \
  X(slope)    /* 0 sphere rolls, 1 disc rolls, 2 sphere slides, 3 slip below, 4 above the          \
                 bound */                                                                          \
  X(resisted) /* rolling resistance: 0 angle to the stop, 1 at rest below, 2 acceleration          \
                 above */                                                                          \
  X(two_bodies) /* linear law: 0 way in contact, 1 restitution */                                  \
  X(cloud)      /* 0 momentum, 1 angular momentum, 2, 3 the same in the plane, 4 li-chu, 5         \
                   hertz */                                                                        \
  X(arms)    /* li-chu: 0 angular momentum lost over its closed form, 1 share lost by default */   \
  X(book)    /* energy: 0 linear 3-D, 1 hertz 3-D, 2 linear 2-D, 3 li-chu */                       \
  X(lattice) /* bonded lattice at 45 degrees: 0 D11, 1 D12, 2 D1212, 3 D1221, 4 couple */          \
  X(chain)   /* 0, 1: wave numbers of a bonded chain; 2 front's speed */                           \
  X(bits)    /* numbers that differ: 0 threads, 1 numbering, 2 scaling */

#define X(name)                                                                                    \
  cdem_status cdem_dem_measure_##name(int parameter, double *value, cdem_fault *fault);
CDEM_DEM_MEASURES(X)
#undef X

#endif
