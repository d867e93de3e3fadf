/* Cell shapes: how many nodes a cell has, and which of them share an edge or a face.
 *
 * A shape is pure topology. Stiffness lives in the room elements, where one shape can serve several
 * elements (quad4 and quad4-cosserat). Nodes are numbered from 0 in the order of the mesh file
 * after reading; that order is gmsh's for every shape (corners first, counter-clockwise in 2-D and
 * on the bottom face seen from the top, then mid-edge nodes). Readers of other formats reorder.
 */
#ifndef CDEM_MESH_SHAPE_H
#define CDEM_MESH_SHAPE_H

#include <stdint.h>

typedef enum {
#define X(NAME, name, dimension, nodes, corners) CDEM_SHAPE_##NAME,
#include "mesh/shapes.def"
#undef X
  CDEM_SHAPE_COUNT
} cdem_shape;

enum { CDEM_SHAPE_MAX_NODES = 20, CDEM_SHAPE_MAX_EDGES = 12, CDEM_SHAPE_MAX_FACES = 6 };

typedef struct {
  const char *name;
  int dimension, nodes, corners;
  int edges;                            /* 0 for points; lines have one edge: themselves */
  int8_t edge[CDEM_SHAPE_MAX_EDGES][3]; /* two corners and the mid node, -1 when there is none */
  int faces;                            /* 2-D shapes have one face: themselves */
  int8_t face[CDEM_SHAPE_MAX_FACES]
             [8]; /* all nodes of the face, corners first in outward order, then -1 */
  int8_t face_corners[CDEM_SHAPE_MAX_FACES]; /* 3 or 4 */
} cdem_shape_info;

/* Never NULL for a valid shape. */
const cdem_shape_info *cdem_shape_get(cdem_shape shape);

/* The shape called `name`, or CDEM_SHAPE_COUNT. */
cdem_shape cdem_shape_find(const char *name);

/* Dimension (1 edge, 2 face, 3 body) of the smallest entity of the shape that holds both nodes a
 * and b (0-based, a != b). This is the class of a spring. */
int cdem_shape_pair_class(cdem_shape shape, int a, int b);

#endif
