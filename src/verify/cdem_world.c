#include "verify/cdem_world.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- mesh ---- */

cdem_status cdem_world_grid(cdem_world *world, cdem_shape shape, const int32_t count[3],
                            const double size[3], cdem_fault *fault) {
  cdem_mesh_grid_options options = {.shape = shape};
  for (int k = 0; k < 3; k++) {
    options.count[k] = count[k];
    options.size[k] = size[k];
  }
  return cdem_mesh_grid(&options, &world->mesh, fault);
}

/* A mesh behind those that are there; its groups get the name of the body in front. */
static cdem_status append(cdem_mesh *mesh, const cdem_mesh *part, const char *name,
                          cdem_fault *fault) {
  int32_t nodes = mesh->nodes, cells = mesh->cells;
  int32_t node[CDEM_SHAPE_MAX_NODES], *cell;
  CDEM_TRY(cdem_mesh_add_nodes(mesh, part->nodes, part->xyz, NULL, fault));
  for (int32_t c = 0; c < part->cells; c++) {
    int count = cdem_shape_get((cdem_shape)part->cell_shape[c])->nodes;
    for (int k = 0; k < count; k++)
      node[k] = nodes + cdem_mesh_cell(part, c)[k];
    CDEM_TRY(cdem_mesh_add_cells(mesh, (cdem_shape)part->cell_shape[c], 1, node, NULL, fault));
  }
  CDEM_NEW(cell, part->cells, fault);
  cdem_status status = CDEM_OK;
  for (int32_t g = 0; g < part->groups && status == CDEM_OK; g++) {
    const cdem_group *group = &part->group[g];
    char full[80];
    bool body = group->dimension == cdem_mesh_dimension(part);
    snprintf(full, sizeof full, "%s%s%s", name, body ? "" : ".", body ? "" : group->name);
    for (int32_t i = 0; i < group->cells; i++)
      cell[i] = cells + group->cell[i];
    status = cdem_mesh_add_group(mesh, full, group->dimension, group->cells, cell, fault);
  }
  free(cell);
  return status;
}

cdem_status cdem_world_add_box(cdem_world *world, const char *name, const int32_t count[3],
                               const double from[3], const double to[3], cdem_fault *fault) {
  cdem_mesh part = {0};
  cdem_mesh_grid_options options = {.shape = count[2] > 0 ? CDEM_SHAPE_HEX8 : CDEM_SHAPE_QUAD4};
  for (int k = 0; k < 3; k++) {
    options.count[k] = count[k];
    options.size[k] = to[k] - from[k];
  }
  CDEM_TRY(cdem_mesh_grid(&options, &part, fault));
  for (int32_t n = 0; n < part.nodes; n++)
    for (int k = 0; k < 3; k++)
      part.xyz[3 * n + k] += from[k];
  cdem_status status = append(&world->mesh, &part, name, fault);
  cdem_mesh_release(&part);
  return status;
}

cdem_status cdem_world_quarter_ring(cdem_world *world, int n, double outer, cdem_fault *fault) {
  const double half_pi = 1.57079632679489661923;
  cdem_mesh *mesh = &world->mesh;
  CDEM_TRY(cdem_world_grid(world, CDEM_SHAPE_QUAD4, (int32_t[]){2 * n, 2 * n, 0},
                           (double[]){1.0, 1.0, 0.0}, fault));
  for (int32_t i = 0; i < mesh->nodes; i++) { /* x: radius, y: angle */
    double *x = mesh->xyz + 3 * i, r = pow(outer, x[0]), angle = half_pi * x[1];
    x[0] = r * cos(angle);
    x[1] = r * sin(angle);
  }
  return CDEM_OK;
}

/* ---- body ---- */

static cdem_status build_model(cdem_world *world, cdem_fault *fault) {
  const cdem_world_options *o = &world->options;
  cdem_model_options options = {
      .mesh = &world->blocks.mesh,
      .materials = 1,
      .material = &world->material,
      .section = {.plane = o->plane_stress ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN,
                  .thickness = 1.0}};
  world->material =
      o->material != NULL ? *o->material : cdem_material_isotropic(o->young, o->poisson);
  CDEM_TRY(cdem_model_init(&options, &world->model, fault));
  cdem_body_options body = {.density = &world->options.density, .threads = 1};
  return cdem_body_init(&world->model, &body, &world->body, fault);
}

cdem_status cdem_world_build(cdem_world *world, const cdem_world_options *options,
                             cdem_fault *fault) {
  world->options = *options;
  int dofs = cdem_mesh_dimension(&world->mesh);
  cdem_blocks_options cut = {.mesh = &world->mesh,
                             .groups = options->only != NULL,
                             .group = &options->only,
                             .breakable = options->breakable != NULL,
                             .breakable_group = &options->breakable};
  CDEM_TRY(cdem_blocks_init(&cut, &world->blocks, fault));
  CDEM_TRY(build_model(world, fault));
  if (options->law != NULL) {
    int32_t *law_of;
    CDEM_NEW(law_of, world->blocks.pairs, fault);
    cdem_interfaces_options interfaces = {.blocks = &world->blocks,
                                          .dofs = dofs,
                                          .thickness = 1.0,
                                          .laws = 1,
                                          .law = options->law,
                                          .law_of = law_of,
                                          .release = 0.05,
                                          .threads = 1};
    cdem_status status = cdem_interfaces_init(&interfaces, &world->interfaces, fault);
    free(law_of);
    CDEM_TRY(status);
  }
  if (options->contact != NULL) {
    cdem_contact_options contact = {.blocks = &world->blocks,
                                    .dofs = dofs,
                                    .thickness = 1.0,
                                    .law = *options->contact,
                                    .mass = world->body.mass,
                                    .threads = 1};
    CDEM_TRY(cdem_contact_init(&contact, &world->contact, fault));
  }
  CDEM_NEW(world->velocity, (int64_t)world->body.nodes * world->body.dofs, fault);
  return CDEM_OK;
}

/* ---- conditions ---- */

cdem_status cdem_world_support(cdem_world *world, const char *group, int component, bool velocity,
                               double value, double over, cdem_fault *fault) {
  cdem_solver_options *motion = &world->motion;
  CDEM_REQUIRE(motion->supports < CDEM_WORLD_SUPPORTS, fault, CDEM_USAGE, "too many supports");
  cdem_support *support = &world->support[motion->supports];
  int32_t count, *node;
  CDEM_TRY(cdem_blocks_group_nodes(&world->blocks, group, &count, &node, fault));
  *support = (cdem_support){
      .name = group, .component = component, .velocity = velocity, .nodes = count, .node = node};
  motion->supports++;
  const double time[2] = {0.0, over}, values[2] = {0.0, value};
  return over > 0.0 ? cdem_series_table(2, time, values, &support->series, fault)
                    : cdem_series_constant(value, &support->series, fault);
}

static void add_facet(const cdem_world *world, const cdem_facet *facet, const double traction[3],
                      double *vector) {
  double area[3], share[4];
  cdem_facet_area(facet, world->blocks.mesh.xyz, 1.0, area, share);
  for (int c = 0; c < facet->corners; c++)
    for (int k = 0; k < world->body.dofs; k++)
      vector[facet->node[c] * world->body.dofs + k] += share[c] * traction[k];
}

cdem_status cdem_world_traction(cdem_world *world, const char *group, const double traction[3],
                                cdem_series *series, cdem_fault *fault) {
  cdem_solver_options *motion = &world->motion;
  CDEM_REQUIRE(motion->loads < CDEM_WORLD_LOADS, fault, CDEM_USAGE, "too many loads");
  cdem_load *load = &world->load[motion->loads];
  int32_t facets, *facet, *node;
  double *vector;
  CDEM_TRY(cdem_blocks_group_facets(&world->blocks, group, &facets, &facet, fault));
  *load = (cdem_load){.name = group, .series = *series, .nodes = world->body.nodes};
  *series = (cdem_series){0};
  motion->loads++;
  CDEM_NEW(node, load->nodes, fault);
  load->node = node;
  CDEM_NEW(vector, (int64_t)load->nodes * world->body.dofs, fault);
  load->vector = vector;
  for (int32_t n = 0; n < load->nodes; n++)
    node[n] = n;
  for (int32_t f = 0; f < facets; f++)
    add_facet(world, &world->blocks.facet[facet[f]], traction, vector);
  free(facet);
  return CDEM_OK;
}

cdem_status cdem_world_velocity(cdem_world *world, const char *group, const double velocity[3],
                                cdem_fault *fault) {
  int32_t count, *node;
  CDEM_TRY(cdem_blocks_group_nodes(&world->blocks, group, &count, &node, fault));
  for (int32_t i = 0; i < count; i++)
    for (int k = 0; k < world->body.dofs; k++)
      world->velocity[node[i] * world->body.dofs + k] += velocity[k];
  free(node);
  return CDEM_OK;
}

/* ---- motion ---- */

cdem_status cdem_world_start(cdem_world *world, cdem_fault *fault) {
  cdem_solver_options *motion = &world->motion;
  motion->body = &world->body;
  motion->blocks = &world->blocks;
  motion->interfaces = world->options.law != NULL ? &world->interfaces : NULL;
  motion->contact = world->options.contact != NULL ? &world->contact : NULL;
  motion->thickness = 1.0;
  motion->support = world->support;
  motion->load = world->load;
  motion->velocity = world->velocity;
  motion->threads = 1;
  return cdem_solver_init(motion, &world->solver, fault);
}

cdem_status cdem_world_run(cdem_world *world, double time, cdem_fault *fault) {
  while (world->solver.time < time - 0.5 * world->solver.step)
    CDEM_TRY(cdem_solver_step(&world->solver, fault));
  return CDEM_OK;
}

cdem_status cdem_world_mean(const cdem_world *world, const char *group, const double *values,
                            int component, double *mean, cdem_fault *fault) {
  int32_t count, *node;
  double sum = 0.0, mass = 0.0;
  CDEM_TRY(cdem_blocks_group_nodes(&world->blocks, group, &count, &node, fault));
  for (int32_t i = 0; i < count; i++) {
    int64_t at = (int64_t)node[i] * world->body.dofs + component;
    sum += world->body.mass[at] * values[at];
    mass += world->body.mass[at];
  }
  free(node);
  *mean = sum / mass;
  return CDEM_OK;
}

cdem_status cdem_world_crown_stress(const cdem_world *world, double *stress, cdem_fault *fault) {
  double *all, best = 1e300;
  CDEM_NEW(all, (int64_t)world->body.nodes * 6, fault);
  cdem_body_node_stress(&world->body, world->solver.u, all);
  for (int32_t i = 0; i < world->body.nodes; i++) {
    const double *x = world->blocks.mesh.xyz + 3 * i;
    double distance = hypot(x[0], x[1] - 1.0);
    if (distance < best) {
      best = distance;
      *stress = all[6 * i];
    }
  }
  free(all);
  return CDEM_OK;
}

double cdem_world_error(cdem_world *world) {
  cdem_energy_book book;
  cdem_solver_energies(&world->solver, &book);
  return fabs(book.error) / book.exchange;
}

void cdem_world_release(cdem_world *world) {
  cdem_solver_release(&world->solver);
  cdem_contact_release(&world->contact);
  cdem_interfaces_release(&world->interfaces);
  cdem_body_release(&world->body);
  cdem_model_release(&world->model);
  cdem_blocks_release(&world->blocks);
  cdem_mesh_release(&world->mesh);
  for (int i = 0; i < CDEM_WORLD_SUPPORTS; i++) {
    cdem_series_release(&world->support[i].series);
    free((void *)world->support[i].node);
  }
  for (int i = 0; i < CDEM_WORLD_LOADS; i++) {
    cdem_series_release(&world->load[i].series);
    free((void *)world->load[i].node);
    free((void *)world->load[i].vector);
  }
  free(world->velocity);
  *world = (cdem_world){0};
}
