/* Private to verify: a mesh made into a solver with few words, for the checks of the group cdem.
 *
 * Fill `mesh` (by hand or by cdem_mesh_grid), call cdem_world_build, add conditions, then
 * cdem_world_start. One material. Zero-initialise; release at any stage.
 */
#ifndef CDEM_VERIFY_CDEM_WORLD_H
#define CDEM_VERIFY_CDEM_WORLD_H

#include "cdem/cdem.h"

enum { CDEM_WORLD_SUPPORTS = 8, CDEM_WORLD_LOADS = 2 };

typedef struct {
  double young, poisson, density;
  const cdem_material *material; /* copied; NULL: isotropic of young and poisson */
  bool plane_stress;
  const char *only;                /* group the body is made of; NULL: all cells */
  const char *breakable;           /* group whose every cell is a block; NULL: none */
  const cdem_interface_law *law;   /* between blocks; NULL: none */
  const cdem_contact_law *contact; /* NULL: none */
} cdem_world_options;

typedef struct {
  cdem_mesh mesh;
  cdem_blocks blocks;
  cdem_model model;
  cdem_body body;
  cdem_interfaces interfaces;
  cdem_contact contact;
  cdem_solver solver;
  cdem_world_options options;
  cdem_material material;
  cdem_support support[CDEM_WORLD_SUPPORTS];
  cdem_load load[CDEM_WORLD_LOADS];
  cdem_quiet quiet;
  double *velocity;           /* [nodes][dofs] initial; zero at first */
  cdem_solver_options motion; /* gravity, damping, safety: may be set before the start */
} cdem_world;

/* A box of bricks or their plane kind. */
cdem_status cdem_world_grid(cdem_world *world, cdem_shape shape, const int32_t count[3],
                            const double size[3], cdem_fault *fault);
/* A row of nx * ny quadrilaterals (nz: hexahedra) from `from` to `to`, as a body of its own; group
 * NAME holds its cells, NAME.x0 ... NAME.z1 its sides. */
cdem_status cdem_world_add_box(cdem_world *world, const char *name, const int32_t count[3],
                               const double from[3], const double to[3], cdem_fault *fault);
/* A quarter of the plate around a hole of radius 1 m up to `outer`: 2 n cells around, 2 n rings
 * that grow with their radius. Groups: "x0" the hole, "x1" the outer circle, "y0" the x axis, "y1"
 * the y axis. */
cdem_status cdem_world_quarter_ring(cdem_world *world, int n, double outer, cdem_fault *fault);
cdem_status cdem_world_build(cdem_world *world, const cdem_world_options *options,
                             cdem_fault *fault);
/* Component of all nodes of a group: constant, or a ramp from 0 at t = 0 to `value` at `over` (>
 * 0), constant after it; of the displacement, or of the velocity. */
cdem_status cdem_world_support(cdem_world *world, const char *group, int component, bool velocity,
                               double value, double over, cdem_fault *fault);
/* Uniform traction on a group of faces times series(t), which the world takes over. */
cdem_status cdem_world_traction(cdem_world *world, const char *group, const double traction[3],
                                cdem_series *series, cdem_fault *fault);
/* Adds to the initial velocity of a group of cells. */
cdem_status cdem_world_velocity(cdem_world *world, const char *group, const double velocity[3],
                                cdem_fault *fault);
cdem_status cdem_world_start(cdem_world *world, cdem_fault *fault);
/* Steps until `time` has been reached. */
cdem_status cdem_world_run(cdem_world *world, double time, cdem_fault *fault);
/* Mean of a component of an array [nodes][dofs] over a group, weighted by mass. */
cdem_status cdem_world_mean(const cdem_world *world, const char *group, const double *values,
                            int component, double *mean, cdem_fault *fault);
/* Stress xx at the node next to the hole's crown, (0, 1). */
cdem_status cdem_world_crown_stress(const cdem_world *world, double *stress, cdem_fault *fault);
/* |error| of the energy book over its scale. */
double cdem_world_error(cdem_world *world);
void cdem_world_release(cdem_world *world);

#endif
