/* Room mesh: nodes, cells and named groups in memory; topology; structured generators; validity.
 *
 * A mesh is a set of flat arrays. Ids are 0-based positions in those arrays; tags are the numbers
 * the mesh file gave, kept for messages and results. Cells of all dimensions live in one list
 * (boundary faces are cells too), so that every group is a list of cell ids. Coordinates are
 * metres, always three per node (z = 0 or constant in 2-D).
 *
 * Build one with cdem_mesh_add_*; read one with io; make one with cdem_mesh_grid. After building,
 * cdem_mesh_check finds what cannot be: a node that is not finite, a cell that names a node twice.
 */
#ifndef CDEM_MESH_MESH_H
#define CDEM_MESH_MESH_H

#include "base/base.h"
#include "mesh/shape.h"

#include <stdbool.h>

/* A named set of cells, all of one dimension. */
typedef struct {
  char *name;
  int dimension;
  int32_t cells;
  int32_t *cell; /* [cells] cell ids, ascending, no duplicates */
} cdem_group;

typedef struct {
  char *source; /* file name for messages; NULL when generated */
  int32_t nodes;
  double *xyz;       /* [nodes][3], m */
  int64_t *node_tag; /* [nodes] */
  int32_t cells;
  uint8_t *cell_shape; /* [cells] cdem_shape */
  int64_t *cell_tag;   /* [cells] */
  int64_t *cell_start; /* [cells + 1] offsets into cell_node */
  int32_t *cell_node;  /* [cell_start[cells]] node ids */
  int32_t groups;
  cdem_group *group;   /* [groups] */
  int64_t capacity[6]; /* of the arrays above while building; private */
} cdem_mesh;

/* Zero-initialise a mesh (`cdem_mesh mesh = {0};`), release it at any stage. */
void cdem_mesh_release(cdem_mesh *mesh);

/* Makes room for that many nodes, cells and cell nodes in all, so that appending does not double
 * the arrays of a large mesh. CDEM_INPUT when ids of 32 bits cannot count them. */
cdem_status cdem_mesh_reserve(cdem_mesh *mesh, int64_t nodes, int64_t cells, int64_t cell_nodes,
                              cdem_fault *fault);

/* Appends nodes: xyz [count][3], tag [count] (NULL: numbered on from the last id + 1). */
cdem_status cdem_mesh_add_nodes(cdem_mesh *mesh, int64_t count, const double *xyz,
                                const int64_t *tag, cdem_fault *fault);

/* Appends cells of one shape: node [count][nodes of the shape] are node ids, tag as above. */
cdem_status cdem_mesh_add_cells(cdem_mesh *mesh, cdem_shape shape, int64_t count,
                                const int32_t *node, const int64_t *tag, cdem_fault *fault);

/* Adds a group or extends the one of that name (dimensions must agree: CDEM_INPUT names both). The
 * ids are sorted and made unique. */
cdem_status cdem_mesh_add_group(cdem_mesh *mesh, const char *name, int dimension, int64_t count,
                                const int32_t *cell, cdem_fault *fault);

/* The group called `name`, or NULL. */
const cdem_group *cdem_mesh_find_group(const cdem_mesh *mesh, const char *name);

/* Node ids of a cell. */
static inline const int32_t *cdem_mesh_cell(const cdem_mesh *mesh, int32_t cell) {
  return mesh->cell_node + mesh->cell_start[cell];
}

/* Highest dimension of any cell; -1 for a mesh without cells. */
int cdem_mesh_dimension(const cdem_mesh *mesh);

/* CDEM_INPUT with the tag of the first offender: coordinates that are not finite, a node or cell
 * tag used twice within its kind, a cell that names one node twice. */
cdem_status cdem_mesh_check(const cdem_mesh *mesh, cdem_fault *fault);

/* Number of pairs of different nodes at the same place (within `tolerance` m; 0: exactly) that are
 * both used by the given cells. Such a mesh is not connected there: worth a warning, no error. cell
 * [cells] ids, NULL for all cells. *first, *second: node ids of the first pair. */
cdem_status cdem_mesh_coincident_nodes(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                       double tolerance, int64_t *pairs, int32_t *first,
                                       int32_t *second, cdem_fault *fault);

/* Two of the given cells that have the same nodes, in any order: *first, *second cell ids, or -1.
 */
cdem_status cdem_mesh_find_twins(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                 int32_t *first, int32_t *second, cdem_fault *fault);

/* Topology of a chosen set of cells, all of one dimension. cell [cells] ids. */

/* Connected components by shared nodes. node_component [mesh->nodes] receives 0.. or -1 for nodes
 * of no chosen cell. */
cdem_status cdem_mesh_components(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                 int32_t *node_component, int32_t *components, cdem_fault *fault);

/* Marks nodes on the boundary of the set: those on a facet (edge in 2-D, face in 3-D) that belongs
 * to one cell only. boundary [mesh->nodes] receives true or false. */
cdem_status cdem_mesh_boundary_nodes(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                     bool *boundary, cdem_fault *fault);

/* Structured generator: a box of nx*ny*nz bricks (nz = 0: nx*ny plane cells) of the given shape,
 * from the origin to size[3] (m). Shapes: tri3, quad4, tri6, quad8 (nz = 0); tet4, tet10, pyr5,
 * wedge6, hex8, hex20 (each brick cut into 5 or 6 tetrahedra, 6 pyramids or 2 wedges, conforming).
 * `distortion` (0 to 0.25) moves every inner corner by up to that fraction of the cell size,
 * reproducibly from `seed`, so that all cells differ and every cell stays valid (the bound is
 * derived in grid.c); mid nodes stay in the middle of their edges. Groups: "body", and the cells of
 * the sides "x0","x1","y0","y1" (and "z0","z1"). *mesh is overwritten; empty after a failure.
 * CDEM_USAGE: an option out of range. */
typedef struct {
  cdem_shape shape;
  int32_t count[3]; /* bricks a direction; count[2] = 0 in 2-D */
  double size[3];   /* m */
  double distortion;
  uint64_t seed;
} cdem_mesh_grid_options;

cdem_status cdem_mesh_grid(const cdem_mesh_grid_options *options, cdem_mesh *mesh,
                           cdem_fault *fault);

#endif
