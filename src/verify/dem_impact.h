/* Private to verify: one sphere meets a rigid plane or another sphere, and what comes of it. */
#ifndef CDEM_VERIFY_DEM_IMPACT_H
#define CDEM_VERIFY_DEM_IMPACT_H

#include "base/base.h"

typedef struct {
  double young, poisson, density; /* Pa, -, kg/m^3 */
} cdem_impact_material;

typedef struct {
  cdem_impact_material material;
  double radius;
  double normal, tangential, spin; /* before: towards the plane, along it (m/s), about y (rad/s) */
  double friction, restitution;
  const char *law;  /* NULL: hertz */
  double stiffness; /* N/m, of laws that want one, on a plane; else 0 */
  /* 0: a plane; else a second sphere of this radius in the plane's place, on its way with -normal
   * and with the spin -spin (or, `resting`, at rest and a thousand times as stiff and dense). */
  double other;
  bool resting;
  int fineness; /* steps of Hertz's duration; 0: 500 */
  bool peaks;   /* follow force and overlap */
} cdem_impact;

typedef struct {
  double normal, tangential, spin; /* after: away from the plane, along it, about y */
  double slide;                    /* of the contact point: tangential - radius spin */
  double force, overlap, duration; /* peaks; duration only with restitution 1 */
} cdem_rebound;

cdem_status cdem_impact_run(const cdem_impact *impact, cdem_rebound *rebound, cdem_fault *fault);

#endif
