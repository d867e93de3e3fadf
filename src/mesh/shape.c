#include "mesh/shape.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

/* One macro a shape: edges {corner, corner, mid}, faces, corners a face. Mid nodes follow gmsh: its
 * tet10 ends with the edges (2,3) (1,3) and its hex20 lists the edges by their lower corner, both
 * unlike Abaqus and VTK. tests/io compares these tables with gmsh's own reference coordinates. */
/* clang-format off */
#define TOPOLOGY_POINT1 0, {{0}}, 0, {{0}}, {0}
#define TOPOLOGY_LINE2  1, {{0, 1, -1}}, 0, {{0}}, {0}
#define TOPOLOGY_LINE3  1, {{0, 1, 2}}, 0, {{0}}, {0}
#define TOPOLOGY_TRI3                                                                              \
  3, {{0, 1, -1}, {1, 2, -1}, {2, 0, -1}},                                                         \
  1, {{0, 1, 2, -1, -1, -1, -1, -1}}, {3}
#define TOPOLOGY_TRI6                                                                              \
  3, {{0, 1, 3}, {1, 2, 4}, {2, 0, 5}},                                                            \
  1, {{0, 1, 2, 3, 4, 5, -1, -1}}, {3}
#define TOPOLOGY_QUAD4                                                                             \
  4, {{0, 1, -1}, {1, 2, -1}, {2, 3, -1}, {3, 0, -1}},                                             \
  1, {{0, 1, 2, 3, -1, -1, -1, -1}}, {4}
#define TOPOLOGY_QUAD8                                                                             \
  4, {{0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}},                                                 \
  1, {{0, 1, 2, 3, 4, 5, 6, 7}}, {4}
#define TOPOLOGY_TET4                                                                              \
  6, {{0, 1, -1}, {1, 2, -1}, {2, 0, -1}, {3, 0, -1}, {2, 3, -1}, {1, 3, -1}},                     \
  4, {{0, 2, 1, -1, -1, -1, -1, -1}, {0, 1, 3, -1, -1, -1, -1, -1},                                \
      {1, 2, 3, -1, -1, -1, -1, -1}, {2, 0, 3, -1, -1, -1, -1, -1}}, {3, 3, 3, 3}
#define TOPOLOGY_TET10                                                                             \
  6, {{0, 1, 4}, {1, 2, 5}, {2, 0, 6}, {3, 0, 7}, {2, 3, 8}, {1, 3, 9}},                           \
  4, {{0, 2, 1, 6, 5, 4, -1, -1}, {0, 1, 3, 4, 9, 7, -1, -1},                                      \
      {1, 2, 3, 5, 8, 9, -1, -1}, {2, 0, 3, 6, 7, 8, -1, -1}}, {3, 3, 3, 3}
#define TOPOLOGY_PYR5                                                                              \
  8, {{0, 1, -1}, {1, 2, -1}, {2, 3, -1}, {3, 0, -1},                                              \
      {0, 4, -1}, {1, 4, -1}, {2, 4, -1}, {3, 4, -1}},                                             \
  5, {{0, 3, 2, 1, -1, -1, -1, -1}, {0, 1, 4, -1, -1, -1, -1, -1},                                 \
      {1, 2, 4, -1, -1, -1, -1, -1}, {2, 3, 4, -1, -1, -1, -1, -1},                                \
      {3, 0, 4, -1, -1, -1, -1, -1}}, {4, 3, 3, 3, 3}
#define TOPOLOGY_WEDGE6                                                                            \
  9, {{0, 1, -1}, {1, 2, -1}, {2, 0, -1}, {3, 4, -1}, {4, 5, -1}, {5, 3, -1},                      \
      {0, 3, -1}, {1, 4, -1}, {2, 5, -1}},                                                         \
  5, {{0, 2, 1, -1, -1, -1, -1, -1}, {3, 4, 5, -1, -1, -1, -1, -1},                                \
      {0, 1, 4, 3, -1, -1, -1, -1}, {1, 2, 5, 4, -1, -1, -1, -1},                                  \
      {2, 0, 3, 5, -1, -1, -1, -1}}, {3, 3, 4, 4, 4}
#define TOPOLOGY_HEX8                                                                              \
  12, {{0, 1, -1}, {0, 3, -1}, {0, 4, -1}, {1, 2, -1}, {1, 5, -1}, {2, 3, -1},                     \
       {2, 6, -1}, {3, 7, -1}, {4, 5, -1}, {4, 7, -1}, {5, 6, -1}, {6, 7, -1}},                    \
  6, {{0, 3, 2, 1, -1, -1, -1, -1}, {4, 5, 6, 7, -1, -1, -1, -1},                                  \
      {0, 1, 5, 4, -1, -1, -1, -1}, {1, 2, 6, 5, -1, -1, -1, -1},                                  \
      {2, 3, 7, 6, -1, -1, -1, -1}, {3, 0, 4, 7, -1, -1, -1, -1}}, {4, 4, 4, 4, 4, 4}
#define TOPOLOGY_HEX20                                                                             \
  12, {{0, 1, 8}, {0, 3, 9}, {0, 4, 10}, {1, 2, 11}, {1, 5, 12}, {2, 3, 13},                       \
       {2, 6, 14}, {3, 7, 15}, {4, 5, 16}, {4, 7, 17}, {5, 6, 18}, {6, 7, 19}},                    \
  6, {{0, 3, 2, 1, 9, 13, 11, 8}, {4, 5, 6, 7, 16, 18, 19, 17},                                    \
      {0, 1, 5, 4, 8, 12, 16, 10}, {1, 2, 6, 5, 11, 14, 18, 12},                                   \
      {2, 3, 7, 6, 13, 15, 19, 14}, {3, 0, 4, 7, 9, 10, 17, 15}}, {4, 4, 4, 4, 4, 4}
/* clang-format on */

static const cdem_shape_info shapes[CDEM_SHAPE_COUNT] = {
#define X(NAME, name, dimension, nodes, corners)                                                   \
  [CDEM_SHAPE_##NAME] = {#name, dimension, nodes, corners, TOPOLOGY_##NAME},
#include "mesh/shapes.def"
#undef X
};

const cdem_shape_info *cdem_shape_get(cdem_shape shape) {
  assert((int)shape >= 0 && shape < CDEM_SHAPE_COUNT);
  return &shapes[shape];
}

cdem_shape cdem_shape_find(const char *name) {
  for (int s = 0; s < CDEM_SHAPE_COUNT; s++)
    if (strcmp(shapes[s].name, name) == 0)
      return (cdem_shape)s;
  return CDEM_SHAPE_COUNT;
}

static bool holds(const int8_t *nodes, int count, int a, int b) {
  bool found_a = false, found_b = false;
  for (int i = 0; i < count; i++) {
    found_a |= nodes[i] == a;
    found_b |= nodes[i] == b;
  }
  return found_a && found_b;
}

int cdem_shape_pair_class(cdem_shape shape, int a, int b) {
  const cdem_shape_info *info = cdem_shape_get(shape);
  assert(a != b && a >= 0 && b >= 0 && a < info->nodes && b < info->nodes);
  for (int e = 0; e < info->edges; e++)
    if (holds(info->edge[e], 3, a, b))
      return 1;
  for (int f = 0; f < info->faces; f++)
    if (holds(info->face[f], 8, a, b))
      return 2;
  return 3;
}
