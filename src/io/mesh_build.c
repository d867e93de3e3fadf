#include "io/mesh_build.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

void cdem_builder_release(cdem_mesh_builder *builder) {
  cdem_mesh_release(&builder->mesh);
  cdem_tag_map_release(&builder->node);
  cdem_tag_map_release(&builder->cell);
  for (int64_t g = 0; g < builder->groups; g++) {
    free(builder->group[g].name);
    free(builder->group[g].cell);
  }
  free(builder->group);
  free(builder->same_as);
  *builder = (cdem_mesh_builder){0};
}

void cdem_builder_warn(const cdem_mesh_builder *builder, const char *format, ...) {
  if (builder->warnings == NULL || builder->warnings->warn == NULL)
    return;
  char message[CDEM_FAULT_LENGTH];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  builder->warnings->warn(builder->warnings->context, message);
}

cdem_status cdem_builder_claim_node(cdem_mesh_builder *builder, int64_t tag, cdem_fault *fault) {
  bool fresh;
  CDEM_TRY(cdem_tag_map_add(&builder->node, tag, &fresh, fault));
  CDEM_REQUIRE(fresh, fault, CDEM_INPUT, "node %" PRId64 " is defined twice", tag);
  return CDEM_OK;
}

cdem_status cdem_builder_place_node(cdem_mesh_builder *builder, int64_t tag, const double xyz[3],
                                    cdem_fault *fault) {
  for (int i = 0; i < 3; i++)
    CDEM_REQUIRE(isfinite(xyz[i]), fault, CDEM_INPUT,
                 "node %" PRId64 ": coordinate %c is %g, not a finite number", tag, 'x' + i,
                 xyz[i]);
  return cdem_mesh_add_nodes(&builder->mesh, 1, xyz, &tag, fault);
}

cdem_status cdem_builder_add_node(cdem_mesh_builder *builder, int64_t tag, const double xyz[3],
                                  cdem_fault *fault) {
  CDEM_TRY(cdem_builder_claim_node(builder, tag, fault));
  return cdem_builder_place_node(builder, tag, xyz, fault);
}

cdem_status cdem_builder_add_cell(cdem_mesh_builder *builder, cdem_shape shape, int64_t tag,
                                  const int64_t *node_tag, cdem_fault *fault) {
  int32_t node[CDEM_SHAPE_MAX_NODES];
  int nodes = cdem_shape_get(shape)->nodes;
  for (int i = 0; i < nodes; i++) {
    node[i] = cdem_tag_map_find(&builder->node, node_tag[i]);
    CDEM_REQUIRE(node[i] >= 0, fault, CDEM_INPUT,
                 "element %" PRId64 " names node %" PRId64 ", which is not defined", tag,
                 node_tag[i]);
    for (int j = 0; j < i; j++)
      CDEM_REQUIRE(node[i] != node[j], fault, CDEM_INPUT,
                   "element %" PRId64 " names node %" PRId64 " twice", tag, node_tag[i]);
  }
  bool fresh;
  CDEM_TRY(cdem_tag_map_add(&builder->cell, tag, &fresh, fault));
  CDEM_REQUIRE(fresh, fault, CDEM_INPUT, "element %" PRId64 " is defined twice", tag);
  return cdem_mesh_add_cells(&builder->mesh, shape, 1, node, &tag, fault);
}

void cdem_builder_add_stranger(cdem_mesh_builder *builder, const cdem_gmsh_type *type, int64_t tag,
                               const char *where) {
  cdem_build_stranger *stranger = &builder->stranger[type->dimension];
  if (stranger->count++ == 0) {
    stranger->type = type;
    stranger->tag = tag;
    snprintf(stranger->where, sizeof stranger->where, "%s", where);
  }
}

static cdem_status new_group(cdem_mesh_builder *builder, cdem_build_group group, int64_t *index,
                             cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&builder->group, &builder->group_capacity, builder->groups + 1,
                     sizeof *builder->group, fault));
  *index = builder->groups++;
  builder->group[*index] = group;
  return CDEM_OK;
}

cdem_status cdem_builder_physical(cdem_mesh_builder *builder, int dimension, int64_t number,
                                  int64_t *index, cdem_fault *fault) {
  for (*index = builder->groups - 1; *index >= 0; (*index)--)
    if (builder->group[*index].dimension == dimension && builder->group[*index].number == number)
      return CDEM_OK;
  return new_group(builder, (cdem_build_group){.dimension = dimension, .number = number}, index,
                   fault);
}

cdem_status cdem_builder_named(cdem_mesh_builder *builder, const char *name, int64_t *index,
                               cdem_fault *fault) {
  for (*index = 0; *index < builder->groups; (*index)++)
    if (strcasecmp(builder->group[*index].name, name) == 0)
      return CDEM_OK;
  char *copy = cdem_copy_text(name, fault);
  if (copy == NULL)
    return CDEM_MEMORY;
  cdem_status status =
      new_group(builder, (cdem_build_group){.name = copy, .dimension = -1}, index, fault);
  if (status != CDEM_OK)
    free(copy);
  return status;
}

static int compare_ids(const void *a, const void *b) {
  int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

/* Each cell once. */
static void drop_repeats(cdem_build_group *group) {
  int64_t kept = 1;
  qsort(group->cell, (size_t)group->cells, sizeof *group->cell, compare_ids);
  for (int64_t i = 1; i < group->cells; i++)
    if (group->cell[i] != group->cell[kept - 1])
      group->cell[kept++] = group->cell[i];
  group->cells = kept;
}

/* A set that names a set twice doubles it, and a deck of forty such lines would fill any memory: so
 * repeats are dropped whenever there are more members than twice the cells. */
cdem_status cdem_builder_add_members(cdem_mesh_builder *builder, int64_t index, int32_t first,
                                     int64_t count, cdem_fault *fault) {
  cdem_build_group *group = &builder->group[index];
  if (group->cells > 0 && group->cells + count > 2 * (int64_t)builder->mesh.cells)
    drop_repeats(group);
  CDEM_TRY(
      cdem_grow(&group->cell, &group->capacity, group->cells + count, sizeof *group->cell, fault));
  for (int64_t i = 0; i < count; i++)
    group->cell[group->cells++] = first + (int32_t)i;
  return CDEM_OK;
}

/* ---- finishing ---- */

/* Cells of a type that is not ours are an error when they are what would be converted, a warning
 * when they only bound it. */
static cdem_status judge_strangers(const cdem_mesh_builder *builder, cdem_fault *fault) {
  int dimension = cdem_mesh_dimension(&builder->mesh);
  for (int d = 3; d >= 0; d--) {
    const cdem_build_stranger *stranger = &builder->stranger[d];
    if (stranger->count == 0)
      continue;
    CDEM_REQUIRE(d < dimension, fault, CDEM_INPUT,
                 "%selement %" PRId64 " is a %s (gmsh type %d), which has no springs here; %s",
                 stranger->where, stranger->tag, stranger->type->name, stranger->type->type,
                 stranger->type->remedy);
    cdem_builder_warn(builder,
                      "%" PRId64 " boundary elements of type %s (the first is element %" PRId64
                      ") are left out; %s",
                      stranger->count, stranger->type->name, stranger->tag, stranger->type->remedy);
  }
  return CDEM_OK;
}

/* Named groups without a number take the dimension of their first cell; cdem_mesh_add_group finds
 * the cells that differ. */
static int group_dimension(const cdem_mesh_builder *builder, const cdem_build_group *group) {
  if (group->dimension >= 0 || group->cells == 0)
    return group->dimension >= 0 ? group->dimension : cdem_mesh_dimension(&builder->mesh);
  return cdem_shape_get((cdem_shape)builder->mesh.cell_shape[group->cell[0]])->dimension;
}

/* new_id [cells] receives the ids after dropping, -1 for dropped cells: points outside groups, and
 * cells merged into another, which pass their membership on. Returns how many stay. */
static int32_t number_cells(const cdem_mesh_builder *builder, int32_t *new_id) {
  const cdem_mesh *mesh = &builder->mesh;
  for (int32_t c = 0; c < mesh->cells; c++)
    new_id[c] = mesh->cell_shape[c] == CDEM_SHAPE_POINT1 ? -1 : 0;
  for (int64_t g = 0; g < builder->groups; g++)
    for (int64_t i = 0; i < builder->group[g].cells; i++)
      new_id[builder->group[g].cell[i]] = 0;
  int32_t kept = 0;
  for (int32_t c = 0; c < mesh->cells; c++) {
    if (builder->same_as != NULL && builder->same_as[c] != c)
      new_id[c] = -1;
    if (new_id[c] >= 0)
      new_id[c] = kept++;
  }
  return kept;
}

/* Moves the cells that stay to the front. */
static void pack_cells(cdem_mesh *mesh, const int32_t *new_id, int32_t kept) {
  int64_t used = 0;
  for (int32_t c = 0; c < mesh->cells; c++) {
    if (new_id[c] < 0)
      continue;
    int64_t from = mesh->cell_start[c], nodes = mesh->cell_start[c + 1] - from;
    memmove(mesh->cell_node + used, mesh->cell_node + from, (size_t)nodes * sizeof(int32_t));
    mesh->cell_shape[new_id[c]] = mesh->cell_shape[c];
    mesh->cell_tag[new_id[c]] = mesh->cell_tag[c];
    mesh->cell_start[new_id[c]] = used;
    used += nodes;
  }
  mesh->cells = kept;
  mesh->cell_start[kept] = used;
}

/* Drops nodes of no cell: centres of arcs, leftovers of a larger model. */
static cdem_status pack_nodes(cdem_mesh *mesh, cdem_fault *fault) {
  int32_t *new_id, kept = 0;
  CDEM_NEW(new_id, mesh->nodes, fault);
  for (int64_t k = 0; k < mesh->cell_start[mesh->cells]; k++)
    new_id[mesh->cell_node[k]] = 1;
  for (int32_t n = 0; n < mesh->nodes; n++) {
    if (new_id[n] == 0)
      continue;
    memmove(mesh->xyz + 3 * (int64_t)kept, mesh->xyz + 3 * (int64_t)n, 3 * sizeof *mesh->xyz);
    mesh->node_tag[kept] = mesh->node_tag[n];
    new_id[n] = kept++;
  }
  if (kept < mesh->nodes)
    for (int64_t k = 0; k < mesh->cell_start[mesh->cells]; k++)
      mesh->cell_node[k] = new_id[mesh->cell_node[k]];
  mesh->nodes = kept;
  free(new_id);
  return CDEM_OK;
}

/* The name of an unnamed physical group: its number; "surface 7" when something else, such as a
 * volume of that number, has that name. */
static bool is_taken(const cdem_mesh_builder *builder, int64_t index, const char *name) {
  for (int64_t g = 0; g < builder->groups; g++) {
    const cdem_build_group *other = &builder->group[g];
    char number[24];
    snprintf(number, sizeof number, "%" PRId64, other->number);
    if (g == index)
      continue;
    if (other->name != NULL
            ? strcmp(other->name, name) == 0
            : other->dimension > builder->group[index].dimension && strcmp(number, name) == 0)
      return true;
  }
  return false;
}

static const char *group_name(const cdem_mesh_builder *builder, int64_t index, char text[40]) {
  static const char *const kind[4] = {"point", "curve", "surface", "volume"};
  const cdem_build_group *group = &builder->group[index];
  if (group->name != NULL)
    return group->name;
  snprintf(text, 40, "%" PRId64, group->number);
  if (is_taken(builder, index, text))
    snprintf(text, 40, "%s %" PRId64, kind[group->dimension], group->number);
  return text;
}

static cdem_status add_groups(cdem_mesh_builder *builder, const int32_t *new_id,
                              cdem_fault *fault) {
  for (int64_t g = 0; g < builder->groups; g++) {
    cdem_build_group *group = &builder->group[g];
    for (int64_t i = 0; i < group->cells; i++) {
      int32_t cell = group->cell[i];
      group->cell[i] = new_id[builder->same_as != NULL ? builder->same_as[cell] : cell];
    }
    char text[40];
    CDEM_TRY(cdem_mesh_add_group(&builder->mesh, group_name(builder, g, text), group->dimension,
                                 group->cells, group->cell, fault));
  }
  return CDEM_OK;
}

static cdem_status settle(cdem_mesh_builder *builder, int32_t *new_id, cdem_fault *fault) {
  cdem_mesh *mesh = &builder->mesh;
  int32_t kept = number_cells(builder, new_id);
  /* Dimensions of groups are asked for while cells have their old ids. */
  for (int64_t g = 0; g < builder->groups; g++)
    builder->group[g].dimension = group_dimension(builder, &builder->group[g]);
  if (kept < mesh->cells)
    pack_cells(mesh, new_id, kept);
  CDEM_REQUIRE(mesh->cells > 0, fault, CDEM_INPUT, "the mesh has no elements");
  CDEM_TRY(pack_nodes(mesh, fault));
  CDEM_TRY(add_groups(builder, new_id, fault));
  return cdem_mesh_check(mesh, fault);
}

cdem_status cdem_builder_finish(cdem_mesh_builder *builder, cdem_mesh *mesh, cdem_fault *fault) {
  CDEM_TRY(judge_strangers(builder, fault));
  CDEM_REQUIRE(builder->mesh.cells > 0, fault, CDEM_INPUT, "the mesh has no elements");
  cdem_tag_map_release(&builder->node);
  cdem_tag_map_release(&builder->cell);
  int32_t *new_id;
  CDEM_NEW(new_id, builder->mesh.cells, fault);
  cdem_status status = settle(builder, new_id, fault);
  free(new_id);
  if (status == CDEM_OK) {
    *mesh = builder->mesh;
    builder->mesh = (cdem_mesh){0};
  }
  return status;
}
