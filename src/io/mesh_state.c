/* A mesh as arrays of a state, and back through the doors of room mesh, which check it. */
#include "io/run_files.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 256 };

static cdem_status path_of(const char *prefix, const char *name, char path[NAME],
                           cdem_fault *fault) {
  int length = snprintf(path, NAME, "%s/%s", prefix, name);
  CDEM_REQUIRE(length > 0 && length < NAME, fault, CDEM_USAGE,
               "the prefix '%.40s...' of a mesh in a state is too long", prefix);
  return CDEM_OK;
}

static cdem_status put(cdem_state *state, const char *prefix, const char *name,
                       cdem_array_type type, int64_t count, const void *data, cdem_fault *fault) {
  char path[NAME];
  CDEM_TRY(path_of(prefix, name, path, fault));
  return cdem_state_add(state, path, type, count, data, fault);
}

/* A list that the state shall own. */
static cdem_status put_owned(cdem_state *state, const char *prefix, const char *name,
                             cdem_array_type type, int64_t count, void *data, cdem_fault *fault) {
  char path[NAME];
  cdem_status status = path_of(prefix, name, path, fault);
  if (status == CDEM_OK)
    status = cdem_state_add_owned(state, path, type, count, data, fault);
  if (status != CDEM_OK)
    free(data);
  return status;
}

/* Names one behind the other, each ended by zero; dimensions and numbers of cells; cells. */
static cdem_status put_groups(const cdem_mesh *mesh, const char *prefix, cdem_state *state,
                              cdem_fault *fault) {
  int64_t letters = 0, cells = 0;
  for (int32_t g = 0; g < mesh->groups; g++) {
    letters += (int64_t)strlen(mesh->group[g].name) + 1;
    cells += mesh->group[g].cells;
  }
  char *name = cdem_allocate(letters, 1, fault);
  int32_t *facts = cdem_allocate(2 * (int64_t)mesh->groups, sizeof *facts, fault);
  int32_t *cell = cdem_allocate(cells, sizeof *cell, fault);
  if (name == NULL || facts == NULL || cell == NULL) {
    free(name);
    free(facts);
    free(cell);
    return CDEM_MEMORY;
  }
  char *letter = name;
  int32_t *next = cell;
  for (int32_t g = 0; g < mesh->groups; g++) {
    const cdem_group *group = &mesh->group[g];
    letter = stpcpy(letter, group->name) + 1;
    facts[2 * g] = group->dimension;
    facts[2 * g + 1] = group->cells;
    if (group->cells > 0)
      memcpy(next, group->cell, (size_t)group->cells * sizeof *cell);
    next += group->cells;
  }
  cdem_status status =
      put_owned(state, prefix, "group_name", CDEM_ARRAY_BYTE, letters, name, fault);
  if (status == CDEM_OK)
    status = put_owned(state, prefix, "group", CDEM_ARRAY_INT32, 2 * (int64_t)mesh->groups, facts,
                       fault);
  else
    free(facts);
  if (status == CDEM_OK)
    return put_owned(state, prefix, "group_cell", CDEM_ARRAY_INT32, cells, cell, fault);
  free(cell);
  return status;
}

cdem_status cdem_mesh_to_state(const cdem_mesh *mesh, const char *prefix, cdem_state *state,
                               cdem_fault *fault) {
  const char *source = mesh->source != NULL ? mesh->source : "";
  int64_t nodes = mesh->cells > 0 ? mesh->cell_start[mesh->cells] : 0;
  CDEM_TRY(put(state, prefix, "source", CDEM_ARRAY_BYTE, (int64_t)strlen(source), source, fault));
  CDEM_TRY(put(state, prefix, "xyz", CDEM_ARRAY_REAL, 3 * (int64_t)mesh->nodes, mesh->xyz, fault));
  CDEM_TRY(put(state, prefix, "node_tag", CDEM_ARRAY_INT64, mesh->nodes, mesh->node_tag, fault));
  CDEM_TRY(put(state, prefix, "cell_shape", CDEM_ARRAY_BYTE, mesh->cells, mesh->cell_shape, fault));
  CDEM_TRY(put(state, prefix, "cell_tag", CDEM_ARRAY_INT64, mesh->cells, mesh->cell_tag, fault));
  CDEM_TRY(put(state, prefix, "cell_node", CDEM_ARRAY_INT32, nodes, mesh->cell_node, fault));
  return put_groups(mesh, prefix, state, fault);
}

/* ---- and back ---- */

/* An array of the state, NULL data when it is empty. */
static cdem_status get(const cdem_state *state, const char *prefix, const char *name,
                       cdem_array_type type, const cdem_array **array, cdem_fault *fault) {
  char path[NAME];
  CDEM_TRY(path_of(prefix, name, path, fault));
  *array = cdem_state_find(state, path);
  CDEM_REQUIRE(*array != NULL && (*array)->type == type, fault, CDEM_INPUT,
               "the checkpoint has no array '%s' of type %s; it holds no mesh", path,
               cdem_array_type_name(type));
  return CDEM_OK;
}

static cdem_status get_nodes(const cdem_state *state, const char *prefix, cdem_mesh *mesh,
                             cdem_fault *fault) {
  const cdem_array *xyz, *tag;
  CDEM_TRY(get(state, prefix, "xyz", CDEM_ARRAY_REAL, &xyz, fault));
  CDEM_TRY(get(state, prefix, "node_tag", CDEM_ARRAY_INT64, &tag, fault));
  CDEM_REQUIRE(xyz->count == 3 * tag->count && tag->count <= INT32_MAX, fault, CDEM_INPUT,
               "the mesh of the checkpoint has %" PRId64 " coordinates and %" PRId64
               " node tags; the file is damaged",
               xyz->count, tag->count);
  return cdem_mesh_add_nodes(mesh, tag->count, xyz->data, tag->data, fault);
}

/* Cells in runs of one shape. */
static cdem_status get_cells(const cdem_state *state, const char *prefix, cdem_mesh *mesh,
                             cdem_fault *fault) {
  const cdem_array *shape, *tag, *node;
  CDEM_TRY(get(state, prefix, "cell_shape", CDEM_ARRAY_BYTE, &shape, fault));
  CDEM_TRY(get(state, prefix, "cell_tag", CDEM_ARRAY_INT64, &tag, fault));
  CDEM_TRY(get(state, prefix, "cell_node", CDEM_ARRAY_INT32, &node, fault));
  const uint8_t *shapes = shape->data;
  int64_t nodes = 0;
  bool good = shape->count == tag->count && tag->count <= INT32_MAX;
  for (int64_t c = 0; c < shape->count && good; c++) {
    good = shapes[c] < CDEM_SHAPE_COUNT;
    nodes += good ? cdem_shape_get((cdem_shape)shapes[c])->nodes : 0;
  }
  CDEM_REQUIRE(good && nodes == node->count, fault, CDEM_INPUT,
               "the cells of the mesh of the checkpoint do not fit together; the file is damaged");
  CDEM_TRY(cdem_mesh_reserve(mesh, mesh->nodes, tag->count, nodes, fault));
  const int32_t *next = node->data;
  for (int64_t c = 0, run; c < shape->count; c += run) {
    for (run = 1; c + run < shape->count && shapes[c + run] == shapes[c];)
      run++;
    CDEM_TRY(cdem_mesh_add_cells(mesh, (cdem_shape)shapes[c], run, next,
                                 (const int64_t *)tag->data + c, fault));
    next += run * cdem_shape_get((cdem_shape)shapes[c])->nodes;
  }
  return CDEM_OK;
}

static cdem_status get_groups(const cdem_state *state, const char *prefix, cdem_mesh *mesh,
                              cdem_fault *fault) {
  const cdem_array *name, *facts, *cell;
  CDEM_TRY(get(state, prefix, "group_name", CDEM_ARRAY_BYTE, &name, fault));
  CDEM_TRY(get(state, prefix, "group", CDEM_ARRAY_INT32, &facts, fault));
  CDEM_TRY(get(state, prefix, "group_cell", CDEM_ARRAY_INT32, &cell, fault));
  const char *letter = name->data, *end = letter + name->count;
  const int32_t *fact = facts->data, *next = cell->data;
  int64_t left = cell->count;
  for (int64_t g = 0; g < facts->count / 2; g++) {
    size_t room = (size_t)(end - letter), length = room > 0 ? strnlen(letter, room) : 0;
    int32_t cells = fact[2 * g + 1];
    CDEM_REQUIRE(length < room && cells >= 0 && cells <= left, fault, CDEM_INPUT,
                 "the groups of the mesh of the checkpoint do not fit together; the file is "
                 "damaged");
    CDEM_TRY(cdem_mesh_add_group(mesh, letter, fact[2 * g], cells, next, fault));
    letter += length + 1;
    next += cells;
    left -= cells;
  }
  return CDEM_OK;
}

static cdem_status get_mesh(const cdem_state *state, const char *prefix, cdem_mesh *mesh,
                            cdem_fault *fault) {
  const cdem_array *source;
  CDEM_TRY(get(state, prefix, "source", CDEM_ARRAY_BYTE, &source, fault));
  if (source->count > 0) {
    CDEM_NEW(mesh->source, source->count + 1, fault);
    memcpy(mesh->source, source->data, (size_t)source->count);
  }
  CDEM_TRY(get_nodes(state, prefix, mesh, fault));
  CDEM_TRY(get_cells(state, prefix, mesh, fault));
  return get_groups(state, prefix, mesh, fault);
}

cdem_status cdem_mesh_from_state(const cdem_state *state, const char *prefix, cdem_mesh *mesh,
                                 cdem_fault *fault) {
  *mesh = (cdem_mesh){0};
  cdem_status status = get_mesh(state, prefix, mesh, fault);
  if (status == CDEM_OK)
    status = cdem_mesh_check(mesh, fault);
  if (status != CDEM_OK)
    cdem_mesh_release(mesh);
  if (status != CDEM_USAGE)
    return status;
  /* Room mesh calls wrong ids the caller's mistake; here they come from a file. */
  if (fault != NULL)
    fault->status = CDEM_INPUT;
  cdem_fault_prefix(fault, "the mesh of the checkpoint is damaged");
  return CDEM_INPUT;
}
