/* Nodes, elements and entities of MSH 4.1: blocks by geometric entity. */
#include "io/mesh_msh.h"

#include <inttypes.h>
#include <stdlib.h>

/* ---- entities ---- */

void cdem_msh_entities_release(cdem_msh_entities *entities) {
  free(entities->entity);
  free(entities->physical);
  *entities = (cdem_msh_entities){0};
}

/* A point has 3 coordinates, the others a box of 6; all but points list what bounds them. */
static cdem_status read_entity(cdem_text *text, int dimension, cdem_msh_entities *all,
                               cdem_fault *fault) {
  cdem_msh_entity entity = {.dimension = dimension, .first = all->physicals};
  CDEM_TRY(cdem_msh_int(text, &entity.tag, fault));
  for (int i = 0; i < (dimension == 0 ? 3 : 6); i++) {
    double unused;
    CDEM_TRY(cdem_msh_real(text, &unused, fault));
  }
  CDEM_TRY(cdem_msh_count(text, 2, &entity.groups, fault));
  CDEM_TRY(cdem_grow(&all->physical, &all->physical_capacity, all->physicals + entity.groups,
                     sizeof *all->physical, fault));
  for (int64_t i = 0; i < entity.groups; i++) {
    int64_t number; /* a negative one asks gmsh for the other orientation */
    CDEM_TRY(cdem_msh_int(text, &number, fault));
    if (number < -INT32_MAX || number > INT32_MAX)
      return cdem_text_fail(text, fault, "%" PRId64 " is not the number of a physical group",
                            number);
    all->physical[all->physicals++] = number < 0 ? -number : number;
  }
  int64_t bounds = 0, unused;
  if (dimension > 0)
    CDEM_TRY(cdem_msh_count(text, 2, &bounds, fault));
  for (int64_t i = 0; i < bounds; i++)
    CDEM_TRY(cdem_msh_int(text, &unused, fault));
  CDEM_TRY(cdem_grow(&all->entity, &all->entity_capacity, all->entities + 1, sizeof *all->entity,
                     fault));
  all->entity[all->entities++] = entity;
  return CDEM_OK;
}

static int compare_entities(const void *a, const void *b) {
  const cdem_msh_entity *x = a, *y = b;
  if (x->dimension != y->dimension)
    return x->dimension < y->dimension ? -1 : 1;
  return (x->tag > y->tag) - (x->tag < y->tag);
}

cdem_status cdem_msh_read_entities(cdem_text *text, cdem_msh_entities *entities,
                                   cdem_fault *fault) {
  int64_t count[4];
  for (int d = 0; d < 4; d++)
    CDEM_TRY(cdem_msh_count(text, 10, &count[d], fault));
  for (int d = 0; d < 4; d++)
    for (int64_t i = 0; i < count[d]; i++)
      CDEM_TRY(read_entity(text, d, entities, fault));
  if (entities->entities > 0)
    qsort(entities->entity, (size_t)entities->entities, sizeof *entities->entity, compare_entities);
  return CDEM_OK;
}

/* ---- nodes ---- */

/* Number of blocks, of entries, smallest and largest tag. */
static cdem_status read_counts(cdem_text *text, int64_t least, int64_t *blocks, int64_t *entries,
                               cdem_fault *fault) {
  int64_t unused;
  CDEM_TRY(cdem_msh_count(text, 4, blocks, fault));
  CDEM_TRY(cdem_msh_count(text, least, entries, fault));
  CDEM_TRY(cdem_msh_size(text, &unused, fault));
  return cdem_msh_size(text, &unused, fault);
}

static cdem_status check_total(const cdem_text *text, int64_t found, int64_t announced,
                               cdem_fault *fault) {
  if (found != announced)
    return cdem_text_fail(text, fault,
                          "%s announces %" PRId64 " entries, but its blocks hold %" PRId64,
                          text->section, announced, found);
  return CDEM_OK;
}

/* The tags of a block come first; they wait in tag [count]. */
static cdem_status read_node_block(cdem_text *text, int64_t **tag, int64_t *capacity,
                                   int64_t *count, cdem_mesh_builder *builder, cdem_fault *fault) {
  int64_t dimension, entity, parametric;
  CDEM_TRY(cdem_msh_int(text, &dimension, fault));
  CDEM_TRY(cdem_msh_int(text, &entity, fault));
  CDEM_TRY(cdem_msh_int(text, &parametric, fault));
  CDEM_TRY(cdem_msh_count(text, 8, count, fault));
  if (dimension < 0 || dimension > 3)
    return cdem_text_fail(text, fault, "a block of nodes of dimension %" PRId64, dimension);
  CDEM_TRY(cdem_grow(tag, capacity, *count, sizeof **tag, fault));
  for (int64_t i = 0; i < *count; i++) {
    CDEM_TRY(cdem_msh_size(text, &(*tag)[i], fault));
    CDEM_TRY(cdem_text_prefix(text, fault, cdem_builder_claim_node(builder, (*tag)[i], fault)));
  }
  for (int64_t i = 0; i < *count; i++) {
    double xyz[3], unused;
    for (int k = 0; k < 3; k++)
      CDEM_TRY(cdem_msh_real(text, &xyz[k], fault));
    CDEM_TRY(
        cdem_text_prefix(text, fault, cdem_builder_place_node(builder, (*tag)[i], xyz, fault)));
    for (int k = 0; parametric != 0 && k < dimension; k++)
      CDEM_TRY(cdem_msh_real(text, &unused, fault));
  }
  return CDEM_OK;
}

cdem_status cdem_msh4_read_nodes(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault) {
  int64_t blocks, nodes, found = 0, capacity = 0, *tag = NULL;
  CDEM_TRY(read_counts(text, 8, &blocks, &nodes, fault));
  cdem_status status = cdem_mesh_reserve(&builder->mesh, nodes, 0, 0, fault);
  for (int64_t b = 0; b < blocks && status == CDEM_OK; b++) {
    int64_t count = 0;
    status = read_node_block(text, &tag, &capacity, &count, builder, fault);
    found += count;
  }
  free(tag);
  CDEM_TRY(status);
  return check_total(text, found, nodes, fault);
}

/* ---- elements ---- */

static cdem_status read_element(cdem_text *text, const cdem_gmsh_type *type,
                                cdem_mesh_builder *builder, cdem_fault *fault) {
  int64_t tag, node[CDEM_SHAPE_MAX_NODES], unused;
  bool ours = type->shape != CDEM_SHAPE_COUNT;
  CDEM_TRY(cdem_msh_size(text, &tag, fault));
  for (int i = 0; i < type->nodes; i++)
    CDEM_TRY(cdem_msh_size(text, ours ? &node[i] : &unused, fault));
  if (ours)
    return cdem_text_prefix(text, fault,
                            cdem_builder_add_cell(builder, type->shape, tag, node, fault));
  char where[48];
  cdem_text_where(text, where);
  cdem_builder_add_stranger(builder, type, tag, where);
  return CDEM_OK;
}

/* Cells from `first` to the last belong to the groups of their entity. */
static cdem_status join_groups(const cdem_msh_entities *entities, int64_t dimension, int64_t tag,
                               int32_t first, cdem_mesh_builder *builder, cdem_fault *fault) {
  cdem_msh_entity wanted = {.dimension = (int)dimension, .tag = tag};
  const cdem_msh_entity *entity =
      entities->entities > 0 ? bsearch(&wanted, entities->entity, (size_t)entities->entities,
                                       sizeof wanted, compare_entities)
                             : NULL;
  for (int64_t i = 0; entity != NULL && i < entity->groups; i++) {
    int64_t index;
    CDEM_TRY(cdem_builder_physical(builder, (int)dimension, entities->physical[entity->first + i],
                                   &index, fault));
    CDEM_TRY(cdem_builder_add_members(builder, index, first, builder->mesh.cells - first, fault));
  }
  return CDEM_OK;
}

static cdem_status read_element_block(cdem_text *text, const cdem_msh_entities *entities,
                                      int64_t *count, cdem_mesh_builder *builder,
                                      cdem_fault *fault) {
  int64_t dimension, tag, number;
  CDEM_TRY(cdem_msh_int(text, &dimension, fault));
  CDEM_TRY(cdem_msh_int(text, &tag, fault));
  CDEM_TRY(cdem_msh_int(text, &number, fault));
  CDEM_TRY(cdem_msh_count(text, 4, count, fault));
  const cdem_gmsh_type *type = cdem_gmsh_type_find(number);
  if (type == NULL)
    return cdem_text_fail(text, fault,
                          "elements of gmsh type %" PRId64 " are not known; set "
                          "Mesh.ElementOrder = 1 in gmsh",
                          number);
  if (type->dimension != dimension)
    return cdem_text_fail(text, fault, "elements of type %s in a block of dimension %" PRId64,
                          type->name, dimension);
  int32_t first = builder->mesh.cells;
  for (int64_t i = 0; i < *count; i++)
    CDEM_TRY(read_element(text, type, builder, fault));
  return join_groups(entities, dimension, tag, first, builder, fault);
}

cdem_status cdem_msh4_read_elements(cdem_text *text, const cdem_msh_entities *entities,
                                    cdem_mesh_builder *builder, cdem_fault *fault) {
  int64_t blocks, elements, found = 0;
  CDEM_TRY(read_counts(text, 4, &blocks, &elements, fault));
  /* In a binary file the section is 8 bytes a number: tag and nodes of each element. */
  int64_t numbers = text->binary ? (text->end - text->at) / 8 - elements : 0;
  CDEM_TRY(cdem_mesh_reserve(&builder->mesh, builder->mesh.nodes, elements,
                             numbers > 0 ? numbers : 0, fault));
  for (int64_t b = 0; b < blocks; b++) {
    int64_t count = 0;
    CDEM_TRY(read_element_block(text, entities, &count, builder, fault));
    found += count;
  }
  return check_total(text, found, elements, fault);
}
