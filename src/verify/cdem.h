/* Private to verify: what the checks of the group "cdem" measure. Each function fills one number;
 * the parameter chooses the case. */
#ifndef CDEM_VERIFY_CDEM_H
#define CDEM_VERIFY_CDEM_H

#include "base/base.h"

#define CDEM_CDEM_MEASURES(X)                                                                      \
  X(turned)   /* 0 quad4, 1 tri3, 2 hex8, 3 tet4: largest force of a block turned by 90 degrees,   \
                 over E L */                                                                       \
  X(spinning) /* 0..3 plane: drift of momentum, angular momentum, energy; order of the last; 4..7  \
                 solid */                                                                          \
  X(pulse_order) /* 0 free sides, 1 sides on rollers */                                            \
  X(pulse_speed) /* the same: speed over the closed form */                                        \
  X(front)       /* sudden load: 0 speed, 1 plateau over closed forms, 2 order of the L1 error */  \
  X(quiet)       /* share of a pulse's energy that a quiet end sends back */                       \
  X(kirsch)      /* 0: factor at the finest mesh, 1: order of its error */                         \
  X(parting)  /* one interface: 0 peak, 1 energy in tension, 2 friction, 3 peak, 4 energy in shear \
               */                                                                                  \
  X(softened) /* static, 0 quad4 in uniaxial strain at factor 10; specimen: 1 factor 100, 2 tied,  \
                 GPa */                                                                            \
  X(mohr_coulomb) /* peak of the compressed specimen, Pa: 0 penalty, 1 tied */                     \
  X(sliding)      /* 0: distance over Newmark's; 1: creep below, 2: acceleration above tan phi */  \
  X(bars)         /* 0 momentum, 1 energy book, 2 striker's last speed */                          \
  X(stack)        /* 0: drift of a stack at rest, 1: weight on the floor */

#define X(name)                                                                                    \
  cdem_status cdem_cdem_measure_##name(int parameter, double *value, cdem_fault *fault);
CDEM_CDEM_MEASURES(X)
#undef X

#endif
