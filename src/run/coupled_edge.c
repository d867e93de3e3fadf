/* Where grains are at the edge of the mesh, its supports and loads are theirs: grains that touch a
 * supported face move as its nodes would, and a traction is spread by eq. (18) of Li & Wan 2010. */
#include "run/coupled.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cdem_run_coupled_edge_release(cdem_run_coupled *c) {
  for (int64_t i = 0; i < c->loads; i++) {
    free(c->load[i].area);
    free(c->load[i].normal);
  }
  free(c->load);
  free(c->guide);
}

/* ---- faces of a group that belong to cells with grains ---- */

typedef struct {
  int64_t faces, room;
  cdem_bsm_face *face;
} face_list;

static bool is_fine(const cdem_run_coupled *c, int32_t cell) {
  const cdem_group fine = {.cells = c->fine_cells, .cell = c->fine_cell};
  return cdem_run_group_holds(&fine, cell);
}

static bool has_nodes(const cdem_mesh *mesh, int32_t cell, int nodes, const int32_t *node) {
  int64_t from = mesh->cell_start[cell], to = mesh->cell_start[cell + 1];
  for (int i = 0; i < nodes; i++) {
    bool found = false;
    for (int64_t k = from; k < to && !found; k++)
      found = mesh->cell_node[k] == node[i];
    if (!found)
      return false;
  }
  return true;
}

/* Turns a face so that it looks out of the cell behind it. */
static void turn_outward(const cdem_mesh *mesh, int32_t cell, cdem_bsm_face *face) {
  double middle[3] = {0}, a[3], b[3], n[3];
  const double *x = mesh->xyz + 3 * (int64_t)face->node[0];
  int64_t from = mesh->cell_start[cell], to = mesh->cell_start[cell + 1];
  for (int64_t k = from; k < to; k++)
    for (int c = 0; c < 3; c++)
      middle[c] += (mesh->xyz[3 * (int64_t)mesh->cell_node[k] + c] - x[c]) / (double)(to - from);
  for (int c = 0; c < 3; c++) {
    a[c] = mesh->xyz[3 * (int64_t)face->node[1] + c] - x[c];
    b[c] = mesh->xyz[3 * (int64_t)face->node[face->corners - 1] + c] - x[c];
  }
  if (face->corners == 2) { /* outward is to the right of the way */
    n[0] = a[1];
    n[1] = -a[0];
    n[2] = 0.0;
  } else {
    cdem_cross3(a, b, n);
  }
  if (cdem_dot3(n, middle) <= 0.0)
    return;
  for (int i = 0, j = face->corners - 1; i < j; i++, j--) {
    int32_t swap = face->node[i];
    face->node[i] = face->node[j];
    face->node[j] = swap;
  }
}

/* Cells of the highest dimension by node. */
typedef struct {
  int64_t *start;
  int32_t *cell;
} node_cells;

static cdem_status cells_by_node(const cdem_mesh *mesh, node_cells *by, cdem_fault *fault) {
  int dim = cdem_mesh_dimension(mesh);
  int64_t entries = 0;
  CDEM_NEW(by->start, (int64_t)mesh->nodes + 2, fault);
  for (int pass = 0; pass < 2; pass++) {
    for (int32_t c = 0; c < mesh->cells; c++)
      for (int64_t k = mesh->cell_start[c];
           cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension == dim &&
           k < mesh->cell_start[c + 1];
           k++) {
        if (pass == 0)
          by->start[mesh->cell_node[k] + 2]++;
        else
          by->cell[by->start[mesh->cell_node[k] + 1]++] = c;
      }
    for (int64_t n = 2; pass == 0 && n < (int64_t)mesh->nodes + 2; n++)
      by->start[n] += by->start[n - 1];
    entries = by->start[mesh->nodes + 1];
    if (pass == 0)
      CDEM_NEW(by->cell, entries, fault);
  }
  return CDEM_OK;
}

static cdem_status add_faces(const cdem_run_coupled *c, const cdem_group *group,
                             const node_cells *by, face_list *list, cdem_fault *fault) {
  const cdem_mesh *mesh = &c->body->mesh;
  bool all = c->version == CDEM_VERSION_GRAINS;
  for (int32_t i = 0; i < group->cells; i++) {
    const int32_t *node = cdem_mesh_cell(mesh, group->cell[i]);
    int corners = cdem_shape_get((cdem_shape)mesh->cell_shape[group->cell[i]])->corners;
    for (int64_t k = by->start[node[0]]; k < by->start[node[0] + 1]; k++) {
      if (!has_nodes(mesh, by->cell[k], corners, node) || (!all && !is_fine(c, by->cell[k])))
        continue;
      cdem_bsm_face face = {.corners = corners};
      memcpy(face.node, node, (size_t)corners * sizeof *node);
      turn_outward(mesh, by->cell[k], &face);
      CDEM_TRY(cdem_grow(&list->face, &list->room, list->faces + 1, sizeof *list->face, fault));
      list->face[list->faces++] = face;
      break;
    }
  }
  return CDEM_OK;
}

/* Nodes and cells that the body does not have: those of fine cells alone. */
static cdem_status check_outside(const cdem_run_coupled *c, const char *key,
                                 const cdem_group *group, cdem_fault *fault) {
  const cdem_mesh *mesh = &c->body->mesh;
  int dim = cdem_mesh_dimension(mesh);
  bool fine = c->version == CDEM_VERSION_GRAINS, cells = group->dimension == dim;
  uint8_t *outer = cdem_allocate(mesh->nodes, 1, fault);
  if (outer == NULL)
    return CDEM_MEMORY;
  for (int32_t i = 0; i < c->partition.outer_cells; i++)
    for (int64_t k = mesh->cell_start[c->partition.outer_cell[i]];
         k < mesh->cell_start[c->partition.outer_cell[i] + 1]; k++)
      outer[mesh->cell_node[k]] = 1;
  for (int32_t i = 0; i < group->cells && !fine; i++) {
    fine = cells && is_fine(c, group->cell[i]);
    for (int64_t k = mesh->cell_start[group->cell[i]]; k < mesh->cell_start[group->cell[i] + 1];
         k++)
      fine = fine || !outer[mesh->cell_node[k]];
  }
  free(outer);
  if (!fine)
    return CDEM_OK;
  return cdem_case_fail(&c->run->cases, key, CDEM_INPUT, fault,
                        "grains are held and loaded through groups of %s; '%s' is none%s",
                        dim == 2 ? "edges" : "faces", group->name,
                        c->version == CDEM_VERSION_GRAINS ? ""
                                                          : " and reaches into the fine region");
}

/* Faces with grains of the group of the value at `key`. Groups of other kinds have none, which is
 * an error where grains are. */
static cdem_status faces_of(const cdem_run_coupled *c, const char *key, const char *name,
                            face_list *list, cdem_fault *fault) {
  const cdem_mesh *mesh = &c->body->mesh;
  const cdem_group *group;
  node_cells by = {0};
  int dim = cdem_mesh_dimension(mesh);
  *list = (face_list){0};
  CDEM_TRY(cdem_run_find_group(c->body, key, name, 0, 3, &group, fault));
  if (group->dimension != dim - 1)
    return check_outside(c, key, group, fault);
  cdem_status status = cells_by_node(mesh, &by, fault);
  if (status == CDEM_OK)
    status = add_faces(c, group, &by, list, fault);
  free(by.start);
  free(by.cell);
  return status;
}

/* ---- supports ---- */

static cdem_status guide_of(cdem_run_coupled *c, int32_t grain, cdem_run_guided **guide,
                            cdem_fault *fault) {
  for (int64_t i = 0; i < c->guides; i++)
    if (c->guide[i].grain == grain) {
      *guide = &c->guide[i];
      return CDEM_OK;
    }
  CDEM_TRY(cdem_grow(&c->guide, &c->guide_room, c->guides + 1, sizeof *c->guide, fault));
  c->guide[c->guides] = (cdem_run_guided){.grain = grain};
  *guide = &c->guide[c->guides++];
  return CDEM_OK;
}

static cdem_status take_components(const cdem_run_coupled *c, const cdem_case_support *support,
                                   bool velocity, cdem_run_guided *guide, cdem_fault *fault) {
  static const int of[4] = {0, 1, 2, 5}; /* x y z rotation */
  const cdem_case_components *from = velocity ? &support->velocity : &support->displacement;
  const double *x = c->grains->grains.xyz + 3 * (int64_t)guide->grain;
  for (int k = 0; k < 4; k++) {
    if (!from->given[k] || (k == 2 && c->grains->dim == 2))
      continue;
    if ((guide->bits >> of[k] & 1u) &&
        (guide->velocity[of[k]] != velocity ||
         !cdem_series_same(guide->series[of[k]], &from->component[k])))
      return cdem_case_fail(&c->run->cases, "supports", CDEM_INPUT, fault,
                            "'%s' and a support above it prescribe %s of the grain at (%.4g, %.4g, "
                            "%.4g m) differently; leave %s out of one of them",
                            support->group, cdem_run_component[k], x[0], x[1], x[2],
                            cdem_run_component[k]);
    guide->bits |= 1u << of[k];
    guide->series[of[k]] = &from->component[k];
    guide->velocity[of[k]] = velocity;
  }
  return CDEM_OK;
}

/* Nodes may stand elsewhere at once, grains cannot. */
static cdem_status check_start(const cdem_run_coupled *c, int64_t index, cdem_fault *fault) {
  const cdem_case_components *moved = &cdem_run_values(c->run)->supports.item[index].displacement;
  char key[96], full[128];
  cdem_run_key(key, "supports", index, "displacement");
  for (int k = 0; k < 4; k++) {
    double start = moved->given[k] ? cdem_series_at(&moved->component[k], 0.0) : 0.0;
    snprintf(full, sizeof full, "%s.%s", key, cdem_run_component[k]);
    if (start != 0.0)
      return cdem_case_fail(&c->run->cases, full, CDEM_INPUT, fault,
                            "%s is %g at t = 0, and the grains at this support cannot jump there; "
                            "let it start from 0, as {ramp: %g, over: TIME} does",
                            cdem_run_component[k], start, start);
  }
  return CDEM_OK;
}

static cdem_status support(cdem_run_coupled *c, int64_t index, bool *touch, cdem_fault *fault) {
  const cdem_case_support *wanted = &cdem_run_values(c->run)->supports.item[index];
  cdem_grains *grains = &c->grains->grains;
  char key[96];
  face_list list;
  cdem_status status =
      faces_of(c, cdem_run_key(key, "supports", index, "group"), wanted->group, &list, fault);
  memset(touch, 0, (size_t)grains->grains * sizeof *touch);
  if (status == CDEM_OK)
    cdem_bsm_touching(&c->body->mesh, list.faces, list.face, grains,
                      cdem_run_coupled_values(c)->interface_gap, touch);
  free(list.face);
  for (int64_t i = 0; status == CDEM_OK && i < grains->grains; i++) {
    cdem_run_guided *guide;
    if (!touch[i] || grains->motion[i] == CDEM_GRAIN_DRIVEN)
      continue;
    status = check_start(c, index, fault);
    if (status == CDEM_OK)
      status = guide_of(c, (int32_t)i, &guide, fault);
    if (status == CDEM_OK)
      status = take_components(c, wanted, false, guide, fault);
    if (status == CDEM_OK)
      status = take_components(c, wanted, true, guide, fault);
  }
  return status;
}

cdem_status cdem_run_coupled_supports(cdem_run_coupled *c, cdem_fault *fault) {
  cdem_grains *grains = &c->grains->grains;
  bool *touch;
  CDEM_NEW(touch, grains->grains, fault);
  cdem_status status = CDEM_OK;
  for (int64_t i = 0; status == CDEM_OK && i < cdem_run_values(c->run)->supports.count; i++)
    status = support(c, i, touch, fault);
  free(touch);
  for (int64_t i = 0; status == CDEM_OK && i < c->guides; i++)
    grains->motion[c->guide[i].grain] = (uint8_t)(CDEM_GRAIN_GUIDED | c->guide[i].bits);
  return status;
}

/* ---- loads ---- */

static cdem_status edge_load(cdem_run_coupled *c, int64_t index, cdem_fault *fault) {
  const cdem_case_load *wanted = &cdem_run_values(c->run)->loads.item[index];
  const cdem_grains *grains = &c->grains->grains;
  char key[96];
  face_list list;
  cdem_status status =
      faces_of(c, cdem_run_key(key, "loads", index, "group"), wanted->group, &list, fault);
  bool traction = false;
  for (int k = 0; k < 4; k++)
    traction = traction || wanted->traction.given[k];
  if (status == CDEM_OK && list.faces > 0 && !traction && !wanted->has_pressure)
    status = cdem_case_fail(&c->run->cases, cdem_run_key(key, "loads", index, ""), CDEM_INPUT,
                            fault, "on grains a load is a 'traction' or a 'pressure'");
  if (status == CDEM_OK && list.faces > 0) {
    cdem_run_edge_load load = {.load = wanted};
    load.area = traction ? cdem_allocate(grains->grains, sizeof *load.area, fault) : NULL;
    load.normal = traction ? NULL : cdem_allocate(3 * grains->grains, sizeof *load.normal, fault);
    status = load.area == NULL && load.normal == NULL ? CDEM_MEMORY : CDEM_OK;
    if (status == CDEM_OK)
      status = cdem_grow(&c->load, &c->load_room, c->loads + 1, sizeof *c->load, fault);
    if (status == CDEM_OK)
      c->load[c->loads++] = load;
    if (status == CDEM_OK)
      status = cdem_bsm_tributary(
          &c->body->mesh, list.faces, list.face, grains, cdem_run_coupled_values(c)->interface_gap,
          cdem_run_values(c->run)->thickness, load.area, load.normal, fault);
    if (status == CDEM_INPUT)
      status = cdem_case_blame(&c->run->cases, key, fault);
  }
  free(list.face);
  return status;
}

/* A free edge in the place of a quiet one would throw all waves back. */
static cdem_status check_quiet(const cdem_run_coupled *c, const char *name, cdem_fault *fault) {
  face_list list;
  cdem_status status = faces_of(c, "quiet", name, &list, fault);
  free(list.face);
  if (status == CDEM_OK && list.faces > 0)
    status = cdem_case_fail(&c->run->cases, "quiet", CDEM_INPUT, fault,
                            "'%s' has grains behind it, which have no quiet boundary; take a group "
                            "of the coarse medium, or `mass_damping`",
                            name);
  return status;
}

cdem_status cdem_run_coupled_loads(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_case_values *v = cdem_run_values(c->run);
  for (int64_t i = 0; i < v->quiet.count; i++)
    CDEM_TRY(check_quiet(c, v->quiet.item[i], fault));
  for (int64_t i = 0; i < v->loads.count; i++)
    CDEM_TRY(edge_load(c, i, fault));
  return c->loads > 0 ? cdem_dem_want_applied(&c->grains->dem, fault) : CDEM_OK;
}

/* ---- in time ---- */

static double path(const cdem_run_guided *g, int component, double time) {
  const cdem_series *series = g->series[component];
  if (series == NULL)
    return 0.0;
  return g->velocity[component] ? cdem_series_integral(series, time) : cdem_series_at(series, time);
}

void cdem_run_coupled_edge(cdem_run_coupled *c, double from, double to) {
  double middle = 0.5 * (from + to);
  cdem_dem *dem = &c->grains->dem;
  for (int64_t i = 0; i < c->guides; i++) {
    const cdem_run_guided *g = &c->guide[i];
    cdem_dem_motion motion = {.velocity = {0.0}};
    for (int k = 0; k < 6; k++)
      (k < 3 ? motion.velocity : motion.spin)[k % 3] =
          (path(g, k, to) - path(g, k, from)) / (to - from);
    cdem_dem_drive(dem, g->grain, &motion, NULL);
  }
  if (c->loads > 0)
    memset(dem->applied, 0, 6 * (size_t)dem->grains * sizeof *dem->applied);
  if (c->loads > 0 && c->absorb.fine != NULL)
    cdem_absorb_forget(&c->absorb);
  for (int64_t l = 0; l < c->loads; l++) {
    const cdem_run_edge_load *load = &c->load[l];
    double traction[3] = {0}, pressure = 0.0;
    for (int k = 0; k < 3; k++)
      traction[k] = load->load->traction.given[k]
                        ? cdem_series_at(&load->load->traction.component[k], middle)
                        : 0.0;
    if (load->load->has_pressure)
      pressure = cdem_series_at(&load->load->pressure, middle);
    for (int64_t i = 0; i < dem->grains; i++)
      for (int k = 0; k < 3; k++)
        dem->applied[6 * i + k] +=
            load->area != NULL ? traction[k] * load->area[i] : -pressure * load->normal[3 * i + k];
  }
}
