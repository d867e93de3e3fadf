/* Walls: rigid bodies that grains touch, with prescribed motion or a servo-controlled force.
 *
 * - plane: endless; grains are on the side the normal points to, however deep they are in it.
 * - plate: a rectangle (2-D: a segment) that acts from both sides; nearest point, so that edges and
 *   corners act.
 * - cylinder: a tube about an axis (2-D: a circle). Without ends, grains are inside, or outside (a
 *   roller). With ends it is thin and open, touched from both sides and at its rims; `outside` then
 *   only says where grains must be at the start.
 * - mesh: triangles (2-D: segments) that act from both sides. A contact is felt where the distance
 *   to the whole surface is least: once on flat parts, ridges and corners that stand out, on each
 *   side of a valley.
 *
 * A wall moves as a rigid body: velocity of its `center` and spin about it, both functions of time,
 * the velocity along `servo` found from its force where a servo is set. Surface points have
 * velocity v + w x (p - c): a drum is a cylinder whose spin is along its axis. Force and moment on
 * a wall are those the grains exert (moment about its center).
 *
 * Contact history belongs to the grain and the wall (mesh: handed from triangle to triangle while
 * the contact slides on). Walls know nothing of periodic images: across a periodic direction of a
 * cell a wall must reach as far as grains can.
 */
#ifndef CDEM_DEM_WALLS_H
#define CDEM_DEM_WALLS_H

#include "base/base.h"
#include "base/series.h"
#include "mesh/mesh.h"

#include <stdbool.h>

typedef enum {
  CDEM_WALL_PLANE,
  CDEM_WALL_PLATE,
  CDEM_WALL_CYLINDER,
  CDEM_WALL_MESH
} cdem_wall_shape;

typedef struct {
  const char *name; /* borrowed */
  cdem_wall_shape shape;
  int material;     /* index into the materials of the model */
  double center[3]; /* a point of the plane; the middle of plate, circle or tube; of a mesh, the
                       point its motion is told about. m */
  double normal[3]; /* plane, plate: unit (2-D: in the plane z = 0) */
  double
      axis[3]; /* plate: unit, direction of half[0] (2-D: ignored); cylinder: unit (2-D: ignored) */
  double half[2]; /* plate: half lengths along axis and normal x axis (2-D: half[0] only); cylinder:
                     half[0] its half length, 0: endless. m */
  double radius;  /* cylinder, m */
  bool outside;   /* cylinder: grains are outside it */
  int32_t corners, facets; /* mesh */
  const double *corner;    /* [corners][3] m, borrowed */
  const int32_t *facet;    /* [facets][3], 2-D [facets][2] (stride 2), borrowed */
  cdem_series velocity[3]; /* of the center, m/s; points 0: at rest. Borrowed */
  cdem_series spin[3];     /* about the center, rad/s; 2-D only the third. Borrowed */
  /* Servo: along `servo` (unit; all 0: none) the wall moves so that the grains' force on it along
   * `servo` becomes servo_force(t). Its speed there is gain (force - wanted)/(stiffness of its
   * contacts, with their dashpots over the step, times the step), at most servo_speed; without
   * contacts it goes at servo_speed. A wall that grains push along `servo` wants a positive force,
   * one that they push back a negative one. The component of `velocity` along `servo` has no
   * effect. */
  double servo[3];
  cdem_series servo_force; /* N */
  /* Cylinder: the servo is one of its radius instead; servo_force is the sum of the normal pushes
   * of the grains, positive with grains inside. */
  bool servo_radius;
  double servo_gain;  /* 0 < gain < 1; 0: 0.25 */
  double servo_speed; /* m/s, > 0 with a servo */
  double start;       /* s: the wall is there from this time on ... */
  double stop;        /* ... until this one (a gate that opens); 0: for ever */
} cdem_wall;

/* CDEM_INPUT for a normal or axis of no length, half lengths, radius, facets that cannot be, a
 * servo without speed: names the wall. */
cdem_status cdem_wall_check(int dim, const cdem_wall *wall, cdem_fault *fault);

/* The facets of a mesh wall out of a mesh that was read (.stl, .msh, .inp, ...). Zero-initialise;
 * safe to release twice. */
typedef struct {
  int32_t corners, facets;
  double *corner;  /* [corners][3] m */
  int32_t *facet;  /* [facets][dim] */
  int32_t dropped; /* cells of no size, left out */
} cdem_wall_mesh;
/* dim 3: triangles and quadrilaterals (cut in two); dim 2: lines, and z is set to 0. Cells of
 * second order count by their corners. group NULL: all such cells of the mesh. CDEM_INPUT: the
 * group is of another dimension, or nothing is left. */
cdem_status cdem_wall_take_surface(int dim, const cdem_mesh *mesh, const cdem_group *group,
                                   cdem_wall_mesh *surface, cdem_fault *fault);
void cdem_wall_mesh_release(cdem_wall_mesh *surface);

#endif
