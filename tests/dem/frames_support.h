/* A few discs or spheres with walls of all shapes but meshes, made by the solver. */
#ifndef CDEM_TESTS_DEM_FRAMES_SUPPORT_H
#define CDEM_TESTS_DEM_FRAMES_SUPPORT_H

#include "dem/dem.h"
#include "support/test.h"

typedef struct {
  cdem_grains grains;
  cdem_wall wall[3];
  cdem_grain_material stone;
  cdem_contact_input input;
  cdem_dem_options options;
  cdem_dem dem;
} scene;

/* A row of five touching grains on a floor, a plate at x = 3, and a circle or an endless tube along
 * y around it all. */
static inline void scene_init(scene *s, int dim) {
  cdem_fault fault = {0};
  *s = (scene){.grains = {.dim = dim}, .stone = {"stone", 2600, NAN, NAN}};
  int up = dim - 1;
  for (int k = 0; k < 5; k++) {
    double xyz[3] = {0.49 * k - 1, 0, 0};
    xyz[up] = 0.249;
    check_ok(cdem_grains_add(&s->grains, xyz, 0.25, &fault));
  }
  for (int k = 0; k < CDEM_LAW_KEYS; k++)
    s->input.value[k] = NAN;
  s->input.value[CDEM_LAW_normal_stiffness] = 1e6;
  s->input.value[CDEM_LAW_shear_ratio] = 0.5;
  s->input.value[CDEM_LAW_friction] = 0.3;
  s->input.value[CDEM_LAW_restitution] = 1.0;
  s->wall[0] = (cdem_wall){.name = "floor", .shape = CDEM_WALL_PLANE};
  s->wall[0].normal[up] = 1;
  s->wall[1] = (cdem_wall){.name = "plate",
                           .shape = CDEM_WALL_PLATE,
                           .center = {3, 0, 0},
                           .normal = {1, 0, 0},
                           .axis = {0, 1, 0},
                           .half = {0.5, 0.75}};
  s->wall[2] = (cdem_wall){
      .name = "drum", .shape = CDEM_WALL_CYLINDER, .axis = {0, dim == 3, dim == 2}, .radius = 5};
  s->options = (cdem_dem_options){.grains = &s->grains,
                                  .materials = 1,
                                  .material = &s->stone,
                                  .law = cdem_law_find("linear"),
                                  .contact = &s->input,
                                  .walls = 3,
                                  .wall = s->wall,
                                  .threads = 1};
  check_ok(cdem_dem_init(&s->options, &s->dem, &fault));
}

static inline void scene_release(scene *s) {
  cdem_dem_release(&s->dem);
  cdem_grains_release(&s->grains);
}

#endif
