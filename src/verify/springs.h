/* Private to verify: what the checks of the group "springs" measure. Each function fills one
 * number; most take the element or the case as parameter. */
#ifndef CDEM_VERIFY_SPRINGS_H
#define CDEM_VERIFY_SPRINGS_H

#include "base/base.h"

#define CDEM_SPRINGS_MEASURES(X)                                                                   \
  X(cube_closed_form)   /* 0..5: edge diagonal, complex, jordan2, face diagonal, complex, body */  \
  X(cube_stiffnesses)   /* class: worst difference of k1..k3 to the closed form */                 \
  X(root)               /* 10 class + index: a critical ratio of the cube */                       \
  X(root_count)         /* class */                                                                \
  X(root_order)         /* 10 class + index: order of the discriminant's zero */                   \
  X(square_closed_form) /* 0..3 plane strain: edge real, complex, at 0, diagonal; 4..7 stress */   \
  X(square_root)        /* 0 plane strain, 1 plane stress: where the edge changes its form */      \
  X(triangle_closed_form) /* 0 plane strain, 1 plane stress */                                     \
  X(triangle_across)      /* ratio across/along at 1/4 (0) and 1/3 (1) */                          \
  X(triangle_along)       /* the bond's stiffness there */                                         \
  X(interior_sum)         /* class: worst difference of a block's inner pair to table 5 */         \
  X(frame_rebuild)        /* 0: with 216, 1: with the printed 432 */                               \
  X(near_jordan)          /* 0 robust, 1 fast path: worst residual beside defects */               \
  X(fast_invariants)      /* worst difference of the two paths' invariants */                      \
  X(fast_values)          /* the same of stiffnesses where cond(P) < 1e3 */                        \
  X(rebuild)              /* element: worst residual over distorted elements */                    \
  X(assembly)             /* element: springs put together against B^T D B */                      \
  X(transport)            /* element: sum of K_ij T_ij */                                          \
  X(skew_exchange)        /* skew fraction of S_ij against that of S_ji */                         \
  X(depletion_lowest)     /* 10 class + 0, 1, 2: nu = 1/4, 0.2, 0.3; eigenvalue over E L */        \
  X(depletion_negative)   /* the same: 1 when an eigenvalue is negative */                         \
  X(depletion_rotations)  /* class: rotations that meet a force, at 1/4 */                         \
  X(coefficient)          /* 10 class + 0, 1, 2: number before D, p, q of eqs (12), (16), (21) */  \
  X(grid) /* 0..5: distorted hex8 grid: rebuild, translation, assembled, patch, zero, negative     \
             modes */

#define X(name)                                                                                    \
  cdem_status cdem_springs_measure_##name(int parameter, double *value, cdem_fault *fault);
CDEM_SPRINGS_MEASURES(X)
#undef X

#endif
