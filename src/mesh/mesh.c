#include "mesh/mesh.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { XYZ, NODE_TAG, CELL_SHAPE, CELL_TAG, CELL_START, CELL_NODE }; /* of cdem_mesh.capacity */

void cdem_mesh_release(cdem_mesh *mesh) {
  if (mesh == NULL)
    return;
  for (int32_t g = 0; g < mesh->groups; g++) {
    free(mesh->group[g].name);
    free(mesh->group[g].cell);
  }
  free(mesh->group);
  free(mesh->source);
  free(mesh->xyz);
  free(mesh->node_tag);
  free(mesh->cell_shape);
  free(mesh->cell_tag);
  free(mesh->cell_start);
  free(mesh->cell_node);
  *mesh = (cdem_mesh){0};
}

cdem_status cdem_mesh_reserve(cdem_mesh *mesh, int64_t nodes, int64_t cells, int64_t cell_nodes,
                              cdem_fault *fault) {
  CDEM_REQUIRE(nodes <= INT32_MAX && cells < INT32_MAX, fault, CDEM_INPUT,
               "a mesh of %" PRId64 " nodes and %" PRId64 " cells is too large: at most %" PRId32
               " of each fit",
               nodes, cells, INT32_MAX - 1);
  int64_t *room = mesh->capacity;
  CDEM_TRY(cdem_grow(&mesh->xyz, &room[XYZ], nodes, 3 * sizeof *mesh->xyz, fault));
  CDEM_TRY(cdem_grow(&mesh->node_tag, &room[NODE_TAG], nodes, sizeof *mesh->node_tag, fault));
  CDEM_TRY(cdem_grow(&mesh->cell_shape, &room[CELL_SHAPE], cells, 1, fault));
  CDEM_TRY(cdem_grow(&mesh->cell_tag, &room[CELL_TAG], cells, sizeof *mesh->cell_tag, fault));
  CDEM_TRY(
      cdem_grow(&mesh->cell_start, &room[CELL_START], cells + 1, sizeof *mesh->cell_start, fault));
  return cdem_grow(&mesh->cell_node, &room[CELL_NODE], cell_nodes, sizeof *mesh->cell_node, fault);
}

/* Offsets of cells appended later start where the last cell ends. */
static int64_t used_cell_nodes(const cdem_mesh *mesh) {
  return mesh->cells > 0 ? mesh->cell_start[mesh->cells] : 0;
}

cdem_status cdem_mesh_add_nodes(cdem_mesh *mesh, int64_t count, const double *xyz,
                                const int64_t *tag, cdem_fault *fault) {
  CDEM_REQUIRE(count >= 0, fault, CDEM_USAGE, "cannot add %" PRId64 " nodes", count);
  int64_t nodes = mesh->nodes + count;
  CDEM_TRY(cdem_mesh_reserve(mesh, nodes, mesh->cells, used_cell_nodes(mesh), fault));
  if (count > 0)
    memcpy(mesh->xyz + 3 * (int64_t)mesh->nodes, xyz, (size_t)count * 3 * sizeof *xyz);
  for (int64_t i = 0; i < count; i++)
    mesh->node_tag[mesh->nodes + i] = tag != NULL ? tag[i] : mesh->nodes + i + 1;
  mesh->nodes = (int32_t)nodes;
  return CDEM_OK;
}

cdem_status cdem_mesh_add_cells(cdem_mesh *mesh, cdem_shape shape, int64_t count,
                                const int32_t *node, const int64_t *tag, cdem_fault *fault) {
  CDEM_REQUIRE(count >= 0, fault, CDEM_USAGE, "cannot add %" PRId64 " cells", count);
  int nodes = cdem_shape_get(shape)->nodes;
  int64_t used = used_cell_nodes(mesh), cells = mesh->cells + count;
  for (int64_t i = 0; i < count * nodes; i++)
    CDEM_REQUIRE(node[i] >= 0 && node[i] < mesh->nodes, fault, CDEM_USAGE,
                 "cell %" PRId64 " names node id %" PRId32 ", but the mesh has %" PRId32 " nodes",
                 mesh->cells + i / nodes, node[i], mesh->nodes);
  CDEM_TRY(cdem_mesh_reserve(mesh, mesh->nodes, cells, used + count * nodes, fault));
  mesh->cell_start[mesh->cells] = used;
  for (int64_t i = 0; i < count; i++) {
    int64_t cell = mesh->cells + i;
    mesh->cell_shape[cell] = (uint8_t)shape;
    mesh->cell_tag[cell] = tag != NULL ? tag[i] : cell + 1;
    mesh->cell_start[cell + 1] = used + (i + 1) * nodes;
  }
  if (count > 0)
    memcpy(mesh->cell_node + used, node, (size_t)(count * nodes) * sizeof *node);
  mesh->cells = (int32_t)cells;
  return CDEM_OK;
}

static int compare_ids(const void *a, const void *b) {
  int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

/* Sorts and drops duplicates; returns how many stay. Most lists come sorted. */
static int64_t sort_unique(int32_t *id, int64_t count) {
  bool ascending = true;
  for (int64_t i = 1; i < count && ascending; i++)
    ascending = id[i - 1] < id[i];
  if (ascending)
    return count;
  qsort(id, (size_t)count, sizeof *id, compare_ids);
  int64_t kept = 1;
  for (int64_t i = 1; i < count; i++)
    if (id[i] != id[kept - 1])
      id[kept++] = id[i];
  return kept;
}

static cdem_status check_group_cells(const cdem_mesh *mesh, const char *name, int dimension,
                                     int64_t count, const int32_t *cell, cdem_fault *fault) {
  CDEM_REQUIRE(count >= 0, fault, CDEM_USAGE, "group '%s': %" PRId64 " cells", name, count);
  for (int64_t i = 0; i < count; i++) {
    CDEM_REQUIRE(cell[i] >= 0 && cell[i] < mesh->cells, fault, CDEM_USAGE,
                 "group '%s' names cell id %" PRId32 ", but the mesh has %" PRId32 " cells", name,
                 cell[i], mesh->cells);
    int own = cdem_shape_get((cdem_shape)mesh->cell_shape[cell[i]])->dimension;
    CDEM_REQUIRE(own == dimension, fault, CDEM_INPUT,
                 "group '%s' is of mixed dimension: cell %" PRId64
                 " has dimension %d, the group %d; use one name a dimension",
                 name, mesh->cell_tag[cell[i]], own, dimension);
  }
  return CDEM_OK;
}

/* Appends an empty group. */
static cdem_status new_group(cdem_mesh *mesh, const char *name, int dimension, cdem_group **group,
                             cdem_fault *fault) {
  int64_t groups = mesh->groups;
  char *copy = cdem_copy_text(name, fault);
  if (copy == NULL)
    return CDEM_MEMORY;
  cdem_status status = cdem_grow(&mesh->group, &groups, groups + 1, sizeof *mesh->group, fault);
  if (status != CDEM_OK) {
    free(copy);
    return status;
  }
  *group = &mesh->group[mesh->groups++];
  **group = (cdem_group){.name = copy, .dimension = dimension};
  return CDEM_OK;
}

cdem_status cdem_mesh_add_group(cdem_mesh *mesh, const char *name, int dimension, int64_t count,
                                const int32_t *cell, cdem_fault *fault) {
  cdem_group *group = (cdem_group *)cdem_mesh_find_group(mesh, name);
  CDEM_REQUIRE(group == NULL || group->dimension == dimension, fault, CDEM_INPUT,
               "group '%s' is of mixed dimension: it has cells of dimension %d and of dimension "
               "%d; use one name a dimension",
               name, group->dimension, dimension);
  CDEM_TRY(check_group_cells(mesh, name, dimension, count, cell, fault));
  int64_t old = group != NULL ? group->cells : 0, kept = old + count;
  int32_t *all = cdem_allocate(kept, sizeof *all, fault);
  if (all == NULL)
    return CDEM_MEMORY;
  if (old > 0)
    memcpy(all, group->cell, (size_t)old * sizeof *all);
  if (count > 0)
    memcpy(all + old, cell, (size_t)count * sizeof *all);
  kept = sort_unique(all, kept);
  cdem_status status = group == NULL ? new_group(mesh, name, dimension, &group, fault) : CDEM_OK;
  if (status != CDEM_OK) {
    free(all);
    return status;
  }
  free(group->cell);
  group->cell = all;
  group->cells = (int32_t)kept;
  return CDEM_OK;
}

const cdem_group *cdem_mesh_find_group(const cdem_mesh *mesh, const char *name) {
  for (int32_t g = 0; g < mesh->groups; g++)
    if (strcmp(mesh->group[g].name, name) == 0)
      return &mesh->group[g];
  return NULL;
}

int cdem_mesh_dimension(const cdem_mesh *mesh) {
  bool present[CDEM_SHAPE_COUNT] = {false};
  for (int32_t c = 0; c < mesh->cells; c++)
    present[mesh->cell_shape[c]] = true;
  int dimension = -1;
  for (int s = 0; s < CDEM_SHAPE_COUNT; s++)
    if (present[s] && cdem_shape_get((cdem_shape)s)->dimension > dimension)
      dimension = cdem_shape_get((cdem_shape)s)->dimension;
  return dimension;
}

static int compare_tags(const void *a, const void *b) {
  int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

/* Tags of one kind are all different. Most files number upwards, so that no copy is needed. */
static cdem_status check_tags(const char *kind, const int64_t *tag, int64_t count,
                              cdem_fault *fault) {
  bool ascending = true;
  for (int64_t i = 1; i < count && ascending; i++)
    ascending = tag[i - 1] < tag[i];
  if (ascending)
    return CDEM_OK;
  int64_t *sorted = cdem_allocate(count, sizeof *sorted, fault);
  if (sorted == NULL)
    return CDEM_MEMORY;
  memcpy(sorted, tag, (size_t)count * sizeof *sorted);
  qsort(sorted, (size_t)count, sizeof *sorted, compare_tags);
  cdem_status status = CDEM_OK;
  for (int64_t i = 1; i < count && status == CDEM_OK; i++)
    if (sorted[i - 1] == sorted[i])
      status = cdem_fail(fault, CDEM_INPUT, "%s tag %" PRId64 " is used twice; number them apart",
                         kind, sorted[i]);
  free(sorted);
  return status;
}

static cdem_status check_cell_nodes(const cdem_mesh *mesh, int32_t cell, cdem_fault *fault) {
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  int nodes = cdem_shape_get((cdem_shape)mesh->cell_shape[cell])->nodes;
  for (int i = 1; i < nodes; i++)
    for (int j = 0; j < i; j++)
      CDEM_REQUIRE(node[i] != node[j], fault, CDEM_INPUT,
                   "element %" PRId64 " names node %" PRId64 " twice", mesh->cell_tag[cell],
                   mesh->node_tag[node[i]]);
  return CDEM_OK;
}

cdem_status cdem_mesh_check(const cdem_mesh *mesh, cdem_fault *fault) {
  for (int32_t n = 0; n < mesh->nodes; n++)
    for (int i = 0; i < 3; i++)
      CDEM_REQUIRE(isfinite(mesh->xyz[3 * (int64_t)n + i]), fault, CDEM_INPUT,
                   "node %" PRId64 ": coordinate %c is %g, not a finite number", mesh->node_tag[n],
                   'x' + i, mesh->xyz[3 * (int64_t)n + i]);
  CDEM_TRY(check_tags("node", mesh->node_tag, mesh->nodes, fault));
  CDEM_TRY(check_tags("element", mesh->cell_tag, mesh->cells, fault));
  for (int32_t c = 0; c < mesh->cells; c++)
    CDEM_TRY(check_cell_nodes(mesh, c, fault));
  return CDEM_OK;
}
