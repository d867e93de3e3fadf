/* Blocks: a mesh cut along the faces where it may break.
 *
 * A block is a connected set of elements that never splits inside. From any conforming mesh a copy
 * is made in which the elements on the two sides of a cut face have nodes of their own; the cut
 * faces become face pairs (interfaces are built on them), and every face that could touch something
 * becomes a facet (contact is built on those).
 *
 * A face is cut when its two cells are of different blocks, or when it is a cell of a joint group.
 * Blocks: every cell of a `breakable` group is a block of its own; every connected part of a
 * `separate` group is one; the rest splits into its connected parts. At each node the cells that
 * stay connected through uncut faces around that node share one copy, so that a joint may end
 * inside a block (its tip node stays single).
 *
 * The new mesh holds the chosen cells and, of the cells of lower dimension, those that lie on them;
 * nodes of no cell are dropped. Order: cells and groups as before; copies of one node follow each
 * other, nodes otherwise in the old order. Tags are those of the old mesh, so that copies share a
 * tag. A boundary facet in a group has the nodes of its own element; a facet between two elements
 * those of the first; a point or (in 3-D) a line those of the lowest cell that has it. Groups of
 * which nothing is left stay, empty. Where a joint ends, both faces have the same node at its tip.
 */
#ifndef CDEM_CDEM_BLOCKS_H
#define CDEM_CDEM_BLOCKS_H

#include "mesh/mesh.h"

#include <stdbool.h>

typedef struct {
  const cdem_mesh *mesh;    /* borrowed during the call only */
  int groups;               /* 0: all cells of the highest dimension */
  const char *const *group; /* [groups] chosen cells */
  int breakable;            /* groups whose every cell is a block */
  const char *const *breakable_group;
  int separate; /* groups cut off from their surroundings */
  const char *const *separate_group;
  int joints; /* groups of faces (3-D) or edges (2-D) along which is cut */
  const char *const *joint_group;
} cdem_blocks_options;

/* Two faces at the same place, one of each side. */
typedef struct {
  int32_t cell[2];    /* of the new mesh; cell[0] < cell[1] */
  int32_t node[2][4]; /* new node ids; node[0][i] and node[1][i] coincide; in the outward order of
                         side 0 (2-D: the interior of side 0 on the left of node 0 -> node 1) */
  uint8_t corners;    /* 2 in 2-D, 3 or 4 in 3-D */
  int16_t joint;      /* index of the joint group, -1: between blocks */
} cdem_face_pair;

/* A face that is, or after breaking can be, on the surface. Side s of face pair p is facet
 * `pair_facet[2 p + s]`. */
typedef struct {
  int32_t cell;
  int32_t
      node[4]; /* outward order (counter-clockwise seen from outside; 2-D: interior on the left) */
  uint8_t corners;
  int32_t pair; /* face pair, -1: on the surface from the start */
} cdem_facet;

typedef struct {
  cdem_mesh mesh;      /* the cut copy; owned */
  int dimension;       /* 2 or 3 */
  int32_t *original;   /* [mesh.nodes] node id in the old mesh */
  int32_t *old_cell;   /* [mesh.cells] cell id in the old mesh */
  int32_t *block;      /* [mesh.cells] block of a chosen cell, -1 for cells of lower dimension */
  int32_t *node_block; /* [mesh.nodes] block of the node */
  int32_t blocks;
  int32_t pairs;
  cdem_face_pair *pair; /* [pairs], ordered by (cell[0], face of cell[0]) */
  int32_t facets;
  cdem_facet *facet;   /* [facets], ordered by (cell, face of the cell) */
  int32_t *pair_facet; /* [2 pairs] */
} cdem_blocks;

/* CDEM_INPUT: an unknown group (the message lists those there are), a joint group of wrong
 * dimension or with a cell that is no face between two chosen cells (its tag), a face shared by
 * three cells, an element of second order. O(n). Zero-initialise; release at any stage. */
cdem_status cdem_blocks_init(const cdem_blocks_options *options, cdem_blocks *blocks,
                             cdem_fault *fault);
void cdem_blocks_release(cdem_blocks *blocks);

/* Facets of a group of faces (edges in 2-D), by their position in `blocks->facet`, ascending: of a
 * surface group one each, of a cut face both sides, of a face inside a block none. *facet is newly
 * allocated [*count]. CDEM_INPUT when the group is unknown or of another dimension. */
cdem_status cdem_blocks_group_facets(const cdem_blocks *blocks, const char *group, int32_t *count,
                                     int32_t **facet, cdem_fault *fault);
/* Nodes of a group of any dimension, ascending: of cells and of faces (2-D: edges) their own, of a
 * cut face those of both sides; of what is smaller all copies. */
cdem_status cdem_blocks_group_nodes(const cdem_blocks *blocks, const char *group, int32_t *count,
                                    int32_t **node, cdem_fault *fault);

/* Area vector of a facet (outward; in 2-D of length edge times `thickness`), m^2, and each corner's
 * share of the area (integral of its shape function), from positions xyz [nodes][3]. */
void cdem_facet_area(const cdem_facet *facet, const double *xyz, double thickness, double area[3],
                     double share[4]);

#endif
