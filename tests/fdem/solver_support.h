/* What the tests of the solver share: a few grains, walls and their numbers. */
#ifndef CDEM_TESTS_FDEM_SOLVER_SUPPORT_H
#define CDEM_TESTS_FDEM_SOLVER_SUPPORT_H

#include "fdem/fdem.h"
#include "support/test.h"

enum { SCENE_GRAINS = 64, SCENE_WALLS = 6 };

typedef struct {
  cdem_material rock;
  cdem_template shape;
  double xyz[3 * SCENE_GRAINS], radius[SCENE_GRAINS], velocity[3 * SCENE_GRAINS],
      spin[3 * SCENE_GRAINS], orientation[4 * SCENE_GRAINS];
  double density;
  cdem_fdem_contact_law law;
  cdem_wall wall[SCENE_WALLS];
  cdem_fdem_options options;
} scene;

static inline void scene_of(const char *shape, int refinement, double young, double poisson,
                            const cdem_mesh *mesh, scene *s) {
  cdem_fault fault = {0};
  memset(s, 0, sizeof *s);
  s->rock = cdem_material_isotropic(young, poisson);
  const cdem_template_options options = {.shape = cdem_grain_shape_find(shape),
                                         .options = {.refinement = refinement, .mesh = mesh},
                                         .material = &s->rock};
  check_ok(cdem_template_init(&options, false, &s->shape, &fault));
  s->density = 2650.0;
  s->law = (cdem_fdem_contact_law){.penalty = 1e11, .shear_ratio = 1.0};
  s->options = (cdem_fdem_options){.grains = {.xyz = s->xyz,
                                              .radius = s->radius,
                                              .velocity = s->velocity,
                                              .spin = s->spin,
                                              .orientation = s->orientation},
                                   .shapes = 1,
                                   .shape = &s->shape,
                                   .materials = 1,
                                   .density = &s->density,
                                   .law = &s->law,
                                   .wall = s->wall,
                                   .threads = 1};
}

/* A grain at a place; turned somehow unless `seed` is 0. */
static inline int scene_add(scene *s, double x, double y, double z, double radius, uint64_t seed) {
  int g = (int)s->options.grains.grains++;
  double *q = s->orientation + 4 * g, place[3] = {x, y, z};
  memcpy(s->xyz + 3 * g, place, sizeof place);
  s->radius[g] = radius;
  cdem_random random = {seed};
  for (int k = 0; k < 4; k++)
    q[k] = seed == 0 ? (k == 0) : cdem_random_uniform(&random, -1.0, 1.0);
  return g;
}

static inline cdem_wall *scene_floor(scene *s, double z, double nx, double nz) {
  cdem_wall *wall = &s->wall[s->options.walls++];
  *wall = (cdem_wall){
      .name = "floor", .shape = CDEM_WALL_PLANE, .center = {0.0, 0.0, z}, .normal = {nx, 0.0, nz}};
  return wall;
}

static inline void scene_release(scene *s) {
  cdem_template_release(&s->shape);
}

/* Kinetic and stored energy together. */
static inline double kept(const cdem_fdem_energies *e) {
  return e->translation + e->rotation + e->vibration + e->elastic + e->normal + e->shear;
}

#endif
