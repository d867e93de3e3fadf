/* A specimen of spheres between two plates, under one pressure from all sides: the triaxial test.
 *
 * The side is a flexible membrane (membrane.h) whose end rings go up and down with the plates, or a
 * rigid cylinder whose radius a servo finds. While the high plate `presses`, a servo moves it so
 * that the grains push it with the pressure times the mean area V/H of the specimen; from
 * cdem_dem_shear on it moves with a constant velocity. The low plate is whatever its wall does.
 *
 * A node of the membrane that is inside a sphere is pushed out along the line of both centres by
 * k overlap, k = penalty * area of the node, with the dashpot of membrane.h; the opposite force
 * acts on the centre of the grain. No friction. These touches are no contacts of cdem_dem_contacts;
 * those with the plates are contacts with their walls.
 */
#ifndef CDEM_DEM_CONFINEMENT_H
#define CDEM_DEM_CONFINEMENT_H

#include "dem/membrane.h"

typedef struct {
  const cdem_membrane_options *membrane; /* its pressure is not looked at; NULL: `side` */
  int side;      /* wall of shape cylinder with `servo_radius`; of no meaning with a membrane */
  int low, high; /* walls of shape plane, normal to z */
  bool presses;  /* the high plate has a servo along +z and carries the pressure */
  cdem_series pressure; /* Pa, of time; borrowed */
  /* A packing that was pressed together by force must not burst: until this time, s, grains and
   * membrane have mass damping more, quiet_damping (1 - t/quiet)^2; 0: none. */
  double quiet;
  double quiet_damping; /* 1/s; 0: 2/(stable step at the start), at which contacts creep apart */
} cdem_confinement;

/* Compression positive, Pa. */
typedef struct {
  double pressure;       /* wanted now */
  double height, volume; /* m, m^3 */
  double area;           /* V/H, m^2 */
  double axial, bottom;  /* force of the grains on the high and the low plate over V/H */
  double lateral;   /* mean of what the grains push the side out by; of a membrane mostly in its
                       middle (cdem_membrane_shape) */
  double speed;     /* of the high plate along z, m/s */
  int32_t touching; /* nodes of the membrane that touch a grain */
} cdem_specimen;

#endif
