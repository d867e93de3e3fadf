#include "verify/dem_world.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

cdem_status cdem_dem_world_init(cdem_dem_world *world, int dim, const char *law, double density,
                                cdem_fault *fault) {
  memset(world, 0, sizeof *world);
  world->grains.dim = dim;
  for (int m = 0; m < 2; m++)
    world->material[m] =
        (cdem_grain_material){.name = "grains", .density = density, .young = NAN, .poisson = NAN};
  strcpy(world->material[1].name, "walls");
  for (int p = 0; p < 4; p++)
    for (int k = 0; k < CDEM_LAW_KEYS; k++)
      world->contact[p].value[k] = NAN;
  world->options = (cdem_dem_options){.law = cdem_law_find(law), .materials = 2, .threads = 1};
  CDEM_REQUIRE(world->options.law != NULL, fault, CDEM_INPUT, "there is no law '%s'", law);
  return CDEM_OK;
}

void cdem_dem_world_elastic(cdem_dem_world *world, double young, double poisson, double rigid) {
  for (int m = 0; m < 2; m++) {
    world->material[m].young = m == 0 ? young : young * rigid;
    world->material[m].poisson = poisson;
  }
}

void cdem_dem_world_set(cdem_dem_world *world, cdem_law_key key, double value) {
  for (int p = 0; p < 4; p++)
    world->contact[p].value[key] = value;
}

cdem_status cdem_dem_world_add(cdem_dem_world *world, const double place[3], double radius,
                               const double velocity[3], const double spin[3], cdem_fault *fault) {
  cdem_grains *g = &world->grains;
  int64_t i = g->grains;
  CDEM_TRY(cdem_grains_add(g, place, radius, fault));
  if (i == 0)
    CDEM_TRY(cdem_grains_complete(g, fault));
  for (int d = 0; d < 3; d++) {
    g->velocity[3 * i + d] = velocity != NULL ? velocity[d] : 0.0;
    g->spin[3 * i + d] = spin != NULL ? spin[d] : 0.0;
  }
  g->material[i] = 0;
  g->motion[i] = CDEM_GRAIN_FREE;
  return CDEM_OK;
}

cdem_status cdem_dem_world_plane(cdem_dem_world *world, const double center[3],
                                 const double normal[3], cdem_fault *fault) {
  int at = world->options.walls;
  CDEM_REQUIRE(at < CDEM_DEM_WORLD_WALLS, fault, CDEM_INPUT, "more than %d walls",
               CDEM_DEM_WORLD_WALLS);
  cdem_wall *wall = &world->wall[at];
  *wall = (cdem_wall){.name = "plane", .shape = CDEM_WALL_PLANE, .material = 1};
  memcpy(wall->center, center, sizeof wall->center);
  memcpy(wall->normal, normal, sizeof wall->normal);
  world->options.walls++;
  return CDEM_OK;
}

cdem_status cdem_dem_world_bond(cdem_dem_world *world, int32_t a, int32_t b, cdem_fault *fault) {
  int64_t at = world->options.bonds;
  CDEM_TRY(cdem_grow(&world->bond, &world->bond_capacity, at + 1, sizeof *world->bond, fault));
  world->bond[at] = (cdem_bond){.grain = {a, b}};
  world->options.bonds++;
  return CDEM_OK;
}

cdem_status cdem_dem_world_start(cdem_dem_world *world, cdem_fault *fault) {
  cdem_dem_options *o = &world->options;
  o->grains = &world->grains;
  o->material = world->material;
  o->contact = world->contact;
  o->wall = world->wall;
  o->bond_laws = o->bonds > 0 ? 1 : 0;
  o->bond_law = &world->bond_law;
  o->bond = world->bond;
  return cdem_dem_init(o, &world->dem, fault);
}

void cdem_dem_world_release(cdem_dem_world *world) {
  cdem_dem_release(&world->dem);
  cdem_grains_release(&world->grains);
  free(world->bond);
  memset(world, 0, sizeof *world);
}

cdem_dem_grain cdem_dem_world_grain(const cdem_dem_world *world, int64_t grain) {
  double xyz[CDEM_DEM_WORLD_FEW * 3], velocity[CDEM_DEM_WORLD_FEW * 3];
  double spin[CDEM_DEM_WORLD_FEW * 3], rotation[CDEM_DEM_WORLD_FEW * 3];
  double force[CDEM_DEM_WORLD_FEW * 3];
  int32_t contacts[CDEM_DEM_WORLD_FEW];
  cdem_dem_grain now = {0};
  if (world->dem.grains > CDEM_DEM_WORLD_FEW)
    return now;
  cdem_dem_look(&world->dem, &(cdem_dem_view){.xyz = xyz,
                                              .velocity = velocity,
                                              .spin = spin,
                                              .rotation = rotation,
                                              .force = force,
                                              .contacts = contacts});
  for (int d = 0; d < 3; d++) {
    now.place[d] = xyz[3 * grain + d];
    now.velocity[d] = velocity[3 * grain + d];
    now.spin[d] = spin[3 * grain + d];
    now.rotation[d] = rotation[3 * grain + d];
    now.force[d] = force[3 * grain + d];
  }
  now.contacts = contacts[grain];
  return now;
}
