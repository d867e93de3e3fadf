/* Private to blocks: the working tables of one cut.
 *
 * The chosen cells are numbered by position. A slot is a face (an edge in 2-D) of a chosen cell, a
 * corner a node of one; both are numbered on through the cells. Slots find each other through a
 * hash of their sorted nodes, so that everything here is O(n).
 */
#ifndef CDEM_CDEM_BLOCKS_CUT_H
#define CDEM_CDEM_BLOCKS_CUT_H

#include "cdem/blocks.h"

typedef struct {
  const cdem_mesh *mesh;
  int dimension;
  int32_t chosen;
  int32_t *cell;       /* [chosen] mesh cell ids, ascending */
  int32_t *position;   /* [mesh->cells] position among the chosen, -1 */
  int64_t *slot_start; /* [chosen + 1] */
  int32_t *slot_cell;  /* [slots] position of the cell */
  int32_t *mate;       /* [slots] slot of the other cell on the face, -1 */
  int16_t *joint;      /* [slots] joint group, -1 */
  bool *cut;           /* [slots] */
  int64_t entries;     /* of the hash, a power of two */
  int32_t *entry;      /* [entries] slot + 1 of the first cell that has the face, 0: empty */
  int32_t *block;      /* [chosen] */
  int32_t blocks;
  int64_t *corner_start; /* [chosen + 1] */
  int32_t *corner_node;  /* [corners] new node id */
  int32_t *new_cell;     /* [mesh->cells] id in the new mesh, -1 */
} cdem_cut;

/* Slots a cell has. */
static inline int cdem_cut_slots(const cdem_shape_info *info) {
  return info->dimension == 3 ? info->faces : info->edges;
}

/* Local nodes of slot `face` in outward order; returns how many. */
static inline int cdem_cut_face(const cdem_shape_info *info, int face, const int8_t **local) {
  *local = info->dimension == 3 ? info->face[face] : info->edge[face];
  return info->dimension == 3 ? info->face_corners[face] : 2;
}

static inline const cdem_shape_info *cdem_cut_info(const cdem_cut *cut, int32_t position) {
  return cdem_shape_get((cdem_shape)cut->mesh->cell_shape[cut->cell[position]]);
}

/* A group that must be there; the message lists those there are. */
cdem_status cdem_cut_group(const cdem_mesh *mesh, const char *name, const cdem_group **group,
                           cdem_fault *fault);
/* Node ids of a face in ascending order, -1 behind the last. */
void cdem_cut_key(const int32_t *node, const int8_t *local, int corners, int32_t key[4]);
uint64_t cdem_cut_hash(const int32_t key[4]);

/* The steps, in this order. */
cdem_status cdem_cut_choose(cdem_cut *cut, const cdem_blocks_options *options, cdem_fault *fault);
cdem_status cdem_cut_match(cdem_cut *cut, cdem_fault *fault);
cdem_status cdem_cut_joints(cdem_cut *cut, const cdem_blocks_options *options, cdem_fault *fault);
cdem_status cdem_cut_blocks(cdem_cut *cut, const cdem_blocks_options *options, cdem_fault *fault);
cdem_status cdem_cut_nodes(cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault);
cdem_status cdem_cut_cells(cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault);
cdem_status cdem_cut_groups(const cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault);
cdem_status cdem_cut_facets(const cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault);

/* Slot of the first chosen cell that has exactly these corners, -1. */
int32_t cdem_cut_find(const cdem_cut *cut, const int32_t key[4]);

#endif
