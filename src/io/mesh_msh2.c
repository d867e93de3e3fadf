/* Nodes and elements of MSH 2.2: each element carries its own physical group and entity. */
#include "io/mesh_msh.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

cdem_status cdem_msh2_read_nodes(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault) {
  int64_t nodes;
  CDEM_TRY(cdem_msh_text_count(text, 8, &nodes, fault));
  CDEM_TRY(cdem_mesh_reserve(&builder->mesh, nodes, 0, 0, fault));
  for (int64_t i = 0; i < nodes; i++) {
    int64_t tag;
    double xyz[3];
    CDEM_TRY(cdem_msh_int(text, &tag, fault));
    for (int k = 0; k < 3; k++)
      CDEM_TRY(cdem_msh_real(text, &xyz[k], fault));
    CDEM_TRY(cdem_text_prefix(text, fault, cdem_builder_add_node(builder, tag, xyz, fault)));
  }
  return CDEM_OK;
}

/* ---- elements ---- */

typedef struct {
  cdem_text *text;
  cdem_mesh_builder *builder;
  int64_t *physical; /* [cells] number of the group, 0: none */
  int64_t physicals, capacity;
} msh2_reader;

static cdem_status find_type(const cdem_text *text, int64_t number, const cdem_gmsh_type **type,
                             cdem_fault *fault) {
  *type = cdem_gmsh_type_find(number);
  if (*type == NULL)
    return cdem_text_fail(text, fault,
                          "elements of gmsh type %" PRId64 " are not known; set "
                          "Mesh.ElementOrder = 1 in gmsh",
                          number);
  return CDEM_OK;
}

/* What follows type and tag: the element's own tags (group, entity, partitions) and its nodes. */
static cdem_status read_element(msh2_reader *reader, const cdem_gmsh_type *type, int64_t tag,
                                int64_t tags, cdem_fault *fault) {
  cdem_text *text = reader->text;
  int64_t physical = 0, unused, node[CDEM_SHAPE_MAX_NODES];
  CDEM_TRY(cdem_msh_check_count(text, tags, 1, fault));
  for (int64_t i = 0; i < tags; i++)
    CDEM_TRY(cdem_msh_int(text, i == 0 ? &physical : &unused, fault));
  bool ours = type->shape != CDEM_SHAPE_COUNT;
  for (int i = 0; i < type->nodes; i++)
    CDEM_TRY(cdem_msh_int(text, ours ? &node[i] : &unused, fault));
  if (!ours) {
    char where[48];
    cdem_text_where(text, where);
    cdem_builder_add_stranger(reader->builder, type, tag, where);
    return CDEM_OK;
  }
  CDEM_TRY(cdem_text_prefix(text, fault,
                            cdem_builder_add_cell(reader->builder, type->shape, tag, node, fault)));
  CDEM_TRY(cdem_grow(&reader->physical, &reader->capacity, reader->physicals + 1,
                     sizeof *reader->physical, fault));
  if (physical < -INT32_MAX || physical > INT32_MAX)
    return cdem_text_fail(text, fault, "%" PRId64 " is not the number of a physical group",
                          physical);
  reader->physical[reader->physicals++] = physical < 0 ? -physical : physical;
  return CDEM_OK;
}

static cdem_status read_text_elements(msh2_reader *reader, int64_t elements, cdem_fault *fault) {
  for (int64_t i = 0; i < elements; i++) {
    int64_t tag, number, tags;
    const cdem_gmsh_type *type;
    CDEM_TRY(cdem_msh_int(reader->text, &tag, fault));
    CDEM_TRY(cdem_msh_int(reader->text, &number, fault));
    CDEM_TRY(find_type(reader->text, number, &type, fault));
    CDEM_TRY(cdem_msh_int(reader->text, &tags, fault));
    CDEM_TRY(read_element(reader, type, tag, tags, fault));
  }
  return CDEM_OK;
}

/* Binary elements come in runs of one type and one number of tags. */
static cdem_status read_binary_elements(msh2_reader *reader, int64_t elements, cdem_fault *fault) {
  for (int64_t i = 0; i < elements;) {
    int64_t number, run, tags, tag;
    const cdem_gmsh_type *type;
    CDEM_TRY(cdem_msh_int(reader->text, &number, fault));
    CDEM_TRY(find_type(reader->text, number, &type, fault));
    CDEM_TRY(cdem_msh_int(reader->text, &run, fault));
    CDEM_TRY(cdem_msh_int(reader->text, &tags, fault));
    if (run < 1 || run > elements - i)
      return cdem_text_fail(reader->text, fault,
                            "a run of %" PRId64 " elements where %" PRId64 " are left", run,
                            elements - i);
    for (int64_t k = 0; k < run; k++, i++) {
      CDEM_TRY(cdem_msh_int(reader->text, &tag, fault));
      CDEM_TRY(read_element(reader, type, tag, tags, fault));
    }
  }
  return CDEM_OK;
}

static cdem_status join_groups(msh2_reader *reader, cdem_fault *fault) {
  cdem_mesh_builder *builder = reader->builder;
  int64_t index = -1;
  for (int32_t c = 0; c < builder->mesh.cells; c++) {
    int dimension = cdem_shape_get((cdem_shape)builder->mesh.cell_shape[c])->dimension;
    if (reader->physical[c] == 0)
      continue;
    if (index < 0 || builder->group[index].dimension != dimension ||
        builder->group[index].number != reader->physical[c])
      CDEM_TRY(cdem_builder_physical(builder, dimension, reader->physical[c], &index, fault));
    CDEM_TRY(cdem_builder_add_members(builder, index, c, 1, fault));
  }
  return CDEM_OK;
}

/* ---- elements of several groups ---- */

static bool same_nodes(const cdem_mesh *mesh, int32_t a, int32_t b) {
  int64_t nodes = mesh->cell_start[a + 1] - mesh->cell_start[a];
  return mesh->cell_shape[a] == mesh->cell_shape[b] &&
         memcmp(cdem_mesh_cell(mesh, a), cdem_mesh_cell(mesh, b),
                (size_t)nodes * sizeof(int32_t)) == 0;
}

static uint64_t hash_cell(const cdem_mesh *mesh, int32_t cell) {
  uint64_t hash = mesh->cell_shape[cell];
  for (int64_t k = mesh->cell_start[cell]; k < mesh->cell_start[cell + 1]; k++) {
    cdem_random mix = {hash ^ (uint64_t)mesh->cell_node[k]};
    hash = cdem_random_next(&mix);
  }
  return hash;
}

/* gmsh lists an element of two groups twice, under two tags: the same nodes in the same order, but
 * another group. Such elements become one, under the first tag. The same element twice in one group
 * stays two, as the file says. */
static cdem_status find_repeats(msh2_reader *reader, cdem_fault *fault) {
  const cdem_mesh *mesh = &reader->builder->mesh;
  int64_t slots = 64;
  while (slots < 2 * (int64_t)mesh->cells)
    slots *= 2;
  int32_t *table, *same_as = cdem_allocate(mesh->cells, sizeof *same_as, fault);
  if (same_as == NULL)
    return CDEM_MEMORY;
  reader->builder->same_as = same_as;
  CDEM_NEW(table, slots, fault);
  for (int32_t c = 0; c < mesh->cells; c++) {
    same_as[c] = c;
    if (reader->physical[c] == 0)
      continue;
    uint64_t slot = hash_cell(mesh, c) & (uint64_t)(slots - 1);
    int32_t first = c;
    bool own_group = false;
    for (; table[slot] != 0; slot = (slot + 1) & (uint64_t)(slots - 1)) {
      int32_t other = table[slot] - 1;
      if (!same_nodes(mesh, c, other))
        continue;
      own_group |= reader->physical[c] == reader->physical[other];
      first = same_as[other] < first ? same_as[other] : first;
    }
    same_as[c] = own_group ? c : first;
    if (!own_group)
      table[slot] = c + 1;
  }
  free(table);
  return CDEM_OK;
}

static cdem_status read_elements(msh2_reader *reader, cdem_fault *fault) {
  int64_t elements;
  CDEM_TRY(cdem_msh_text_count(reader->text, 6, &elements, fault));
  int64_t numbers = reader->text->binary ? (reader->text->end - reader->text->at) / 4 : 0;
  int64_t nodes = numbers - 3 * elements; /* gmsh writes a tag and two tags with each element */
  CDEM_TRY(cdem_mesh_reserve(&reader->builder->mesh, reader->builder->mesh.nodes, elements,
                             nodes > 0 ? nodes : 0, fault));
  CDEM_TRY(reader->text->binary ? read_binary_elements(reader, elements, fault)
                                : read_text_elements(reader, elements, fault));
  CDEM_TRY(join_groups(reader, fault));
  return reader->builder->groups > 1 ? find_repeats(reader, fault) : CDEM_OK;
}

cdem_status cdem_msh2_read_elements(cdem_text *text, cdem_mesh_builder *builder,
                                    cdem_fault *fault) {
  msh2_reader reader = {.text = text, .builder = builder};
  cdem_status status = read_elements(&reader, fault);
  free(reader.physical);
  return status;
}
