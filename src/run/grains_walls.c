/* Walls and the cell of a case. */
#include "io/case_file.h"
#include "io/io.h"
#include "run/grains.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void unit(const double from[3], double to[3]) {
  double size = cdem_norm3(from);
  for (int k = 0; k < 3; k++)
    to[k] = size > 0.0 ? from[k] / size : 0.0;
}

/* The part of v across the unit vector n, as a unit vector. */
static void across(const double n[3], const double v[3], double to[3]) {
  double along = cdem_dot3(n, v), part[3];
  for (int k = 0; k < 3; k++)
    part[k] = v[k] - along * n[k];
  unit(part, to);
}

/* The axis that leans least towards n. */
static void least_axis(const double n[3], double axis[3]) {
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(n[k]) < fabs(n[least]))
      least = k;
  for (int k = 0; k < 3; k++)
    axis[k] = k == least ? 1.0 : 0.0;
}

static bool gives(const cdem_run_grains *g, const cdem_case_wall *wall, const char *rest) {
  char key[96];
  return cdem_case_given(&g->run->cases, cdem_run_named_key(key, "walls", wall->name, rest));
}

static cdem_status blame(const cdem_run_grains *g, const cdem_case_wall *wall, const char *rest,
                         cdem_fault *fault) {
  char key[96];
  return cdem_case_blame(&g->run->cases, cdem_run_named_key(key, "walls", wall->name, rest), fault);
}

/* ---- directions and places ---- */

static void direct(const cdem_run_grains *g, const cdem_case_wall *from, cdem_wall *wall) {
  static const double z[3] = {0, 0, 1};
  bool axis = gives(g, from, "axis");
  double any[3];
  unit(from->normal, wall->normal);
  if (wall->shape == CDEM_WALL_CYLINDER)
    unit(axis ? from->axis : z, wall->axis);
  if (wall->shape == CDEM_WALL_PLATE) {
    least_axis(wall->normal, any);
    across(wall->normal, axis ? from->axis : any, wall->axis);
  }
  unit(from->servo, wall->servo);
}

/* The plane that touches the outermost grain from outside, at the middle of all. */
static void touch(const cdem_run_grains *g, cdem_wall *wall) {
  double level = INFINITY, low[3], high[3], middle[3];
  for (int64_t i = 0; i < g->grains.grains; i++)
    level = fmin(level, cdem_dot3(wall->normal, &g->grains.xyz[3 * i]) - g->grains.radius[i]);
  cdem_grains_box(&g->grains, low, high);
  for (int k = 0; k < 3; k++)
    middle[k] = k < g->dim ? 0.5 * (low[k] + high[k]) : 0.0;
  double off = level - cdem_dot3(wall->normal, middle);
  for (int k = 0; k < 3; k++)
    wall->center[k] = middle[k] + off * wall->normal[k];
}

/* The middle of the box around the corners. */
static void find_middle(const cdem_run_facets *facets, double middle[3]) {
  for (int k = 0; k < 3; k++) {
    double low = INFINITY, high = -INFINITY;
    for (int64_t i = 0; i < facets->corners; i++) {
      low = fmin(low, facets->corner[3 * i + k]);
      high = fmax(high, facets->corner[3 * i + k]);
    }
    middle[k] = 0.5 * (low + high);
  }
}

/* ---- meshes ---- */

static bool is_chosen(const cdem_mesh *mesh, const cdem_group *group, int32_t cell, int dim) {
  if (cdem_shape_get((cdem_shape)mesh->cell_shape[cell])->dimension != dim - 1)
    return false;
  for (int32_t i = 0; group != NULL && i < group->cells; i++)
    if (group->cell[i] == cell)
      return true;
  return group == NULL;
}

/* Triangles (quadrilaterals as two) in 3-D, segments in 2-D, with the nodes they use. */
static cdem_status take_facets(const cdem_mesh *mesh, const cdem_group *group, double scale,
                               int dim, cdem_run_facets *facets, cdem_fault *fault) {
  int64_t room = 2 * (int64_t)mesh->cells;
  CDEM_NEW(facets->corner, 3 * (int64_t)mesh->nodes, fault);
  CDEM_NEW(facets->facet, dim * room, fault);
  for (int64_t i = 0; i < 3 * (int64_t)mesh->nodes; i++)
    facets->corner[i] = scale * mesh->xyz[i];
  facets->corners = mesh->nodes;
  for (int32_t c = 0; c < mesh->cells; c++) {
    if (!is_chosen(mesh, group, c, dim))
      continue;
    const int32_t *node = cdem_mesh_cell(mesh, c);
    int corners = cdem_shape_get((cdem_shape)mesh->cell_shape[c])->corners;
    for (int first = 1; first + dim - 2 < corners; first++, facets->facets++) {
      int32_t *to = facets->facet + dim * facets->facets;
      to[0] = node[0];
      for (int k = 1; k < dim; k++)
        to[k] = node[first + k - 1];
    }
  }
  return CDEM_OK;
}

static cdem_status read_facets(cdem_run_grains *g, const cdem_case_wall *from,
                               cdem_run_facets *facets, cdem_fault *fault) {
  const cdem_progress *progress = g->run->options->progress;
  cdem_mesh mesh = {0};
  char key[96];
  CDEM_TRY(cdem_progress_report(progress, "reading the mesh", 0, 0, fault)); /* may crash gmsh */
  char *path = cdem_case_file_path(&g->run->cases, from->file, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = cdem_read_mesh(path, &mesh, g->run->options->warnings, fault);
  free(path);
  if (status == CDEM_INPUT || status == CDEM_FILE)
    return blame(g, from, "file", fault);
  CDEM_TRY(status);
  status = cdem_progress_report(progress, "building", 0, 0, fault);
  if (status != CDEM_OK) {
    cdem_mesh_release(&mesh);
    return status;
  }
  const cdem_group *group = from->group != NULL ? cdem_mesh_find_group(&mesh, from->group) : NULL;
  if (from->group != NULL && group == NULL)
    status = cdem_case_fail(&g->run->cases, cdem_run_named_key(key, "walls", from->name, "group"),
                            CDEM_INPUT, fault, "'%s' has no group '%s'", from->file, from->group);
  else
    status = take_facets(&mesh, group, from->unit, g->dim, facets, fault);
  cdem_mesh_release(&mesh);
  if (status == CDEM_OK && facets->facets == 0)
    return cdem_case_fail(&g->run->cases, cdem_run_named_key(key, "walls", from->name, "file"),
                          CDEM_INPUT, fault, "'%s' has no %s a wall could be made of", from->file,
                          g->dim == 3 ? "triangles" : "segments");
  return status;
}

static cdem_status restore_facets(cdem_run_grains *g, int index, const cdem_state *state,
                                  cdem_fault *fault) {
  cdem_run_facets *facets = &g->facets[index];
  char name[64];
  int64_t count = 0;
  snprintf(name, sizeof name, "walls/%d/corner", index);
  CDEM_TRY(cdem_state_take(state, name, CDEM_ARRAY_REAL, &count, &facets->corner, fault));
  facets->corners = count / 3;
  snprintf(name, sizeof name, "walls/%d/facet", index);
  CDEM_TRY(cdem_state_take(state, name, CDEM_ARRAY_INT32, &count, &facets->facet, fault));
  facets->facets = count / g->dim;
  return CDEM_OK;
}

/* ---- walls ---- */

static void move(const cdem_case_wall *from, cdem_wall *wall) {
  for (int k = 0; k < 3; k++) {
    if (from->velocity.given[k])
      wall->velocity[k] = from->velocity.component[k];
    if (from->spin.given[k])
      wall->spin[k] = from->spin.component[k];
  }
  if (from->has_servo_force)
    wall->servo_force = from->servo_force;
  wall->servo_gain = from->servo_gain;
  wall->servo_speed = isnan(from->servo_speed) ? 0.0 : from->servo_speed;
  wall->start = from->start;
  wall->stop = isnan(from->stop) ? 0.0 : from->stop;
}

static cdem_status make_wall(cdem_run_grains *g, int index, const cdem_state *checkpoint,
                             cdem_fault *fault) {
  const cdem_case_wall *from = &cdem_run_grains_values(g)->walls.item[index];
  cdem_wall *wall = &g->wall[index];
  cdem_run_facets *facets = &g->facets[index];
  *wall = (cdem_wall){.name = from->name,
                      .shape = (cdem_wall_shape)from->shape,
                      .material = g->model_of[cdem_run_grains_material(g, from->material)],
                      .radius = isnan(from->radius) ? 0.0 : from->radius,
                      .outside = from->outside};
  memcpy(wall->center, from->center, sizeof wall->center);
  memcpy(wall->half, from->half_size, sizeof wall->half);
  direct(g, from, wall);
  move(from, wall);
  if (wall->shape == CDEM_WALL_MESH) {
    CDEM_TRY(checkpoint != NULL ? restore_facets(g, index, checkpoint, fault)
                                : read_facets(g, from, facets, fault));
    wall->corners = (int32_t)facets->corners;
    wall->facets = (int32_t)facets->facets;
    wall->corner = facets->corner;
    wall->facet = facets->facet;
  }
  if (!gives(g, from, "center") && wall->shape == CDEM_WALL_PLANE)
    touch(g, wall);
  if (!gives(g, from, "center") && wall->shape == CDEM_WALL_MESH)
    find_middle(facets, wall->center);
  cdem_status status = cdem_wall_check(g->dim, wall, fault);
  return status == CDEM_INPUT ? blame(g, from, "", fault) : status;
}

cdem_status cdem_run_grains_walls(cdem_run_grains *g, const cdem_state *checkpoint,
                                  cdem_fault *fault) {
  int64_t walls = cdem_run_grains_values(g)->walls.count;
  CDEM_NEW(g->wall, walls, fault);
  CDEM_NEW(g->facets, walls, fault);
  g->walls = (int)walls;
  for (int w = 0; w < g->walls; w++)
    CDEM_TRY(make_wall(g, w, checkpoint, fault));
  return CDEM_OK;
}

/* ---- the cell ---- */

static void fill_edges(cdem_run_grains *g, const cdem_case_cell *from) {
  bool sized = cdem_case_given(&g->run->cases, "cell.size");
  cdem_cell *cell = &g->cell;
  /* how far the edge of each column leans: y to x, z to x, z to y */
  const double lean[9] = {0, from->tilt[0], from->tilt[1], 0, 0, from->tilt[2], 0, 0, 0};
  for (int k = 0; k < 3; k++)
    cell->corner[k] = sized ? from->low[k] : g->low[k];
  for (int c = 0; c < 3; c++)
    for (int r = 0; cell->periodic[c] && r < 3; r++)
      cell->h[3 * r + c] = r != c  ? lean[3 * r + c]
                           : sized ? from->size[c]
                                   : g->high[c] - g->low[c];
}

cdem_status cdem_run_grains_cell(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_cell *from = &cdem_run_grains_values(g)->cell;
  g->has_cell = cdem_case_given(&g->run->cases, "cell");
  if (!g->has_cell)
    return CDEM_OK;
  for (int k = 0; k < g->dim; k++)
    g->cell.periodic[k] =
        from->periodic.count == 0 || cdem_case_names_direction(&from->periodic, k);
  fill_edges(g, from);
  for (int k = 0; k < 9; k++)
    if (from->rate.given[k])
      g->cell.rate[k] = from->rate.component[k];
  for (int k = 0; k < 3; k++) {
    g->cell.servo[k] = from->stress.given[4 * k];
    if (g->cell.servo[k])
      g->cell.stress[k] = from->stress.component[4 * k];
  }
  g->cell.servo_rate = isnan(from->servo_rate) ? 0.0 : from->servo_rate;
  g->cell.servo_gain = from->servo_gain;
  cdem_status status = cdem_cell_check(g->dim, &g->cell, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&g->run->cases, "cell", fault) : status;
}
