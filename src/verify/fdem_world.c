#include "verify/fdem_world.h"

#include <math.h>
#include <string.h>

cdem_status cdem_fdem_world_init(cdem_fdem_world *world, const char *shape, int refinement,
                                 double young, double poisson, const cdem_mesh *mesh,
                                 cdem_fault *fault) {
  memset(world, 0, sizeof *world);
  world->rock = cdem_material_isotropic(young, poisson);
  world->density = 2650.0;
  world->law = (cdem_fdem_contact_law){.penalty = 1e11, .shear_ratio = 1.0};
  const cdem_template_options options = {.shape = cdem_grain_shape_find(shape),
                                         .options = {.refinement = refinement, .mesh = mesh},
                                         .material = &world->rock};
  CDEM_REQUIRE(options.shape != NULL, fault, CDEM_INPUT, "there is no grain shape '%s'", shape);
  return cdem_template_init(&options, false, &world->shape, fault);
}

int cdem_fdem_world_add(cdem_fdem_world *world, double x, double y, double z, double radius) {
  int g = (int)world->options.grains.grains++;
  const double place[3] = {x, y, z}, as_meshed[4] = {1.0, 0.0, 0.0, 0.0}, rest[3] = {0.0, 0.0, 0.0};
  memcpy(world->xyz + 3 * g, place, sizeof place);
  memcpy(world->orientation + 4 * g, as_meshed, sizeof as_meshed);
  memcpy(world->velocity + 3 * g, rest, sizeof rest);
  memcpy(world->spin + 3 * g, rest, sizeof rest);
  world->radius[g] = radius;
  return g;
}

/* Points of a ball in four dimensions, put onto its surface. */
void cdem_fdem_world_turn(cdem_fdem_world *world, int grain, cdem_random *random) {
  double *q = world->orientation + 4 * grain, square = 0.0;
  do {
    square = 0.0;
    for (int c = 0; c < 4; c++) {
      q[c] = cdem_random_uniform(random, -1.0, 1.0);
      square += q[c] * q[c];
    }
  } while (square > 1.0 || square < 0.01);
  for (int c = 0; c < 4; c++)
    q[c] /= sqrt(square);
}

cdem_wall *cdem_fdem_world_plane(cdem_fdem_world *world, double z, double nx, double nz) {
  cdem_wall *wall = &world->wall[world->options.walls++];
  *wall = (cdem_wall){
      .name = "plane", .shape = CDEM_WALL_PLANE, .center = {0.0, 0.0, z}, .normal = {nx, 0.0, nz}};
  return wall;
}

cdem_status cdem_fdem_world_start(cdem_fdem_world *world, cdem_fault *fault) {
  cdem_fdem_options *o = &world->options;
  cdem_fdem_release(&world->fdem);
  o->grains = (cdem_fdem_grains){.grains = o->grains.grains,
                                 .xyz = world->xyz,
                                 .radius = world->radius,
                                 .velocity = world->velocity,
                                 .spin = world->spin,
                                 .orientation = world->orientation};
  o->shapes = o->materials = 1;
  o->shape = &world->shape;
  o->density = &world->density;
  o->law = &world->law;
  o->wall = world->wall;
  o->threads = o->threads > 0 ? o->threads : 1;
  return cdem_fdem_init(o, &world->fdem, fault);
}

void cdem_fdem_world_release(cdem_fdem_world *world) {
  cdem_fdem_release(&world->fdem);
  cdem_template_release(&world->shape);
}

double cdem_fdem_world_kept(const cdem_fdem_energies *e) {
  return e->translation + e->rotation + e->vibration + e->elastic + e->normal + e->shear;
}
