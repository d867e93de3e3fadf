/* Bonds: two grains held together by two-sided linear springs, with a strength where it is wanted.
 *
 * At rest where and how the grains stand when the bond is made (t = 0). Normal force kn times the
 * change of distance since then, shear force ks times the sliding way (with the arms of law.h,
 * which share out the distance as it is now), moments k_rolling and k_twisting (3-D) times the
 * relative rotation; dashpots as fractions of critical damping. Breaks when the pull exceeds
 * `tension`, the shear force `cohesion` + friction times the push, or the moment `moment` (0:
 * unbreakable). While a bond holds, its two grains have no other contact; once broken they are
 * grains like others. Strength is compared with the springs' forces, without dashpots. Two driven
 * grains have no bond.
 */
#ifndef CDEM_DEM_BONDS_H
#define CDEM_DEM_BONDS_H

#include "base/base.h"

typedef struct {
  double normal_stiffness, shear_stiffness;     /* N/m */
  double rolling_stiffness, twisting_stiffness; /* N m/rad */
  double damping_ratio;                         /* of normal and shear dashpots */
  double tension, cohesion;                     /* N; 0: unbreakable in that way */
  double friction;                              /* tan phi */
  double moment;                                /* N m; 0: unbreakable */
} cdem_bond_law;

typedef struct {
  int32_t grain[2]; /* ids */
  int32_t law;
} cdem_bond;

#endif
