/* Tags of mesh files, and the element types of gmsh. */
#include "io/mesh_build.h"

#include <stdlib.h>

void cdem_tag_map_release(cdem_tag_map *map) {
  free(map->tag);
  free(map->id);
  *map = (cdem_tag_map){0};
}

/* Slot of a tag, or the free slot where it belongs. */
static int64_t slot_of(const cdem_tag_map *map, int64_t tag) {
  cdem_random mix = {(uint64_t)tag};
  int64_t mask = map->slots - 1, slot = (int64_t)(cdem_random_next(&mix) & (uint64_t)mask);
  while (map->id[slot] != 0 && map->tag[slot] != tag)
    slot = (slot + 1) & mask;
  return slot;
}

/* Moves to a table at most half full. */
static cdem_status enlarge(cdem_tag_map *map, cdem_fault *fault) {
  cdem_tag_map larger = {.count = map->count, .slots = 64};
  while (larger.slots < 4 * map->count)
    larger.slots *= 2;
  CDEM_NEW(larger.tag, larger.slots, fault);
  larger.id = cdem_allocate(larger.slots, sizeof *larger.id, fault);
  if (larger.id == NULL) {
    free(larger.tag);
    return CDEM_MEMORY;
  }
  for (int64_t i = 0; i < (map->slots > 0 ? map->slots : map->count); i++) {
    if (map->slots > 0 && map->id[i] == 0)
      continue;
    int64_t tag = map->slots > 0 ? map->tag[i] : map->first + i;
    int64_t slot = slot_of(&larger, tag);
    larger.tag[slot] = tag;
    larger.id[slot] = map->slots > 0 ? map->id[i] : (int32_t)i + 1;
  }
  cdem_tag_map_release(map);
  *map = larger;
  return CDEM_OK;
}

/* Differences of tags are taken without sign, where they cannot overflow. */
static bool is_counted(const cdem_tag_map *map, int64_t tag) {
  return (uint64_t)tag - (uint64_t)map->first < (uint64_t)map->count;
}

cdem_status cdem_tag_map_add(cdem_tag_map *map, int64_t tag, bool *fresh, cdem_fault *fault) {
  *fresh = false;
  CDEM_REQUIRE(map->count < INT32_MAX - 1, fault, CDEM_INPUT,
               "more than %d nodes or elements do not fit", INT32_MAX - 1);
  if (map->slots == 0) {
    if (map->count == 0)
      map->first = tag;
    if (is_counted(map, tag))
      return CDEM_OK;
    if ((uint64_t)tag - (uint64_t)map->first == (uint64_t)map->count) {
      map->count++;
      *fresh = true;
      return CDEM_OK;
    }
  }
  if (2 * (map->count + 1) > map->slots)
    CDEM_TRY(enlarge(map, fault));
  int64_t slot = slot_of(map, tag);
  if (map->id[slot] != 0)
    return CDEM_OK;
  map->tag[slot] = tag;
  map->id[slot] = (int32_t)++map->count;
  *fresh = true;
  return CDEM_OK;
}

int32_t cdem_tag_map_find(const cdem_tag_map *map, int64_t tag) {
  if (map->slots == 0)
    return is_counted(map, tag) ? (int32_t)((uint64_t)tag - (uint64_t)map->first) : -1;
  return map->id[slot_of(map, tag)] - 1;
}

/* Names and node counts as gmsh's manual lists them (MSH file format). */
#define INCOMPLETE "set Mesh.SecondOrderIncomplete = 1 in gmsh"
#define LINEAR     "set Mesh.ElementOrder = 1 in gmsh"
#define LOWER      "set Mesh.ElementOrder = 1 or 2 in gmsh"
#define OURS(type, NAME, dimension, nodes, name)                                                   \
  { type, CDEM_SHAPE_##NAME, dimension, nodes, name, "" }
#define OTHER(type, dimension, nodes, name, remedy)                                                \
  { type, CDEM_SHAPE_COUNT, dimension, nodes, name, remedy }
static const cdem_gmsh_type types[] = {
    OURS(1, LINE2, 1, 2, "line2"),       OURS(2, TRI3, 2, 3, "tri3"),
    OURS(3, QUAD4, 2, 4, "quad4"),       OURS(4, TET4, 3, 4, "tet4"),
    OURS(5, HEX8, 3, 8, "hex8"),         OURS(6, WEDGE6, 3, 6, "wedge6"),
    OURS(7, PYR5, 3, 5, "pyr5"),         OURS(8, LINE3, 1, 3, "line3"),
    OURS(9, TRI6, 2, 6, "tri6"),         OTHER(10, 2, 9, "quad9", INCOMPLETE),
    OURS(11, TET10, 3, 10, "tet10"),     OTHER(12, 3, 27, "hex27", INCOMPLETE),
    OTHER(13, 3, 18, "wedge18", LINEAR), OTHER(14, 3, 14, "pyr14", LINEAR),
    OURS(15, POINT1, 0, 1, "point1"),    OURS(16, QUAD8, 2, 8, "quad8"),
    OURS(17, HEX20, 3, 20, "hex20"),     OTHER(18, 3, 15, "wedge15", LINEAR),
    OTHER(19, 3, 13, "pyr13", LINEAR),   OTHER(20, 2, 9, "tri9", LOWER),
    OTHER(21, 2, 10, "tri10", LOWER),    OTHER(22, 2, 12, "tri12", LOWER),
    OTHER(23, 2, 15, "tri15", LOWER),    OTHER(24, 2, 15, "tri15i", LOWER),
    OTHER(25, 2, 21, "tri21", LOWER),    OTHER(26, 1, 4, "line4", LOWER),
    OTHER(27, 1, 5, "line5", LOWER),     OTHER(28, 1, 6, "line6", LOWER),
    OTHER(29, 3, 20, "tet20", LOWER),    OTHER(30, 3, 35, "tet35", LOWER),
    OTHER(31, 3, 56, "tet56", LOWER),    OTHER(36, 2, 16, "quad16", LOWER),
    OTHER(37, 2, 25, "quad25", LOWER),   OTHER(39, 2, 12, "quad12", LOWER),
    OTHER(90, 3, 40, "wedge40", LOWER),  OTHER(92, 3, 64, "hex64", LOWER),
    OTHER(93, 3, 125, "hex125", LOWER),  OTHER(99, 3, 32, "hex32", LOWER),
};

const cdem_gmsh_type *cdem_gmsh_type_find(int64_t type) {
  for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
    if (types[i].type == type)
      return &types[i];
  return NULL;
}
