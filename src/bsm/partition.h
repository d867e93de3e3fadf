/* Which grains are calculated, which move with the coarse medium, which are not there.
 *
 * Fine cells: those of the mesh whose grains are calculated; all other cells are the coarse medium.
 * Fine grains have their centres in fine cells (a centre on the edge between a fine and an outer
 * cell counts as fine). Interface grains are the true continuation of the packing (Li & Wan 2010,
 * section 1.3): all others whose surface is nearer to a fine grain's than `gap` times the largest
 * radius; they move with the outer cell they lie in (eq. 17). With the gap 0.3, that is one layer
 * of a lattice, and in a random packing enough that no grain escapes.
 */
#ifndef CDEM_BSM_PARTITION_H
#define CDEM_BSM_PARTITION_H

#include "dem/grains.h"
#include "mesh/mesh.h"

typedef struct {
  double low[3], high[3]; /* m; low >= high in a direction: all of it */
} cdem_bsm_box;

/* Cells of the highest dimension whose middle is in one of the boxes: *cell newly allocated,
 * ascending. CDEM_INPUT: a box that holds no cell (its index, and the box of the mesh). */
cdem_status cdem_bsm_cells(const cdem_mesh *mesh, int boxes, const cdem_bsm_box *box,
                           int32_t *cells, int32_t **cell, cdem_fault *fault);

typedef enum { CDEM_PART_AWAY, CDEM_PART_INTERFACE, CDEM_PART_FINE } cdem_bsm_part;

typedef struct {
  int32_t outer_cells;
  int32_t *outer_cell; /* [outer_cells] cells of the highest dimension that are not fine */
  int64_t grains;
  uint8_t *part; /* [grains] cdem_bsm_part */
  int32_t *cell; /* [grains] mesh cell of fine and interface grains; -1 of others */
  double *xi;    /* [grains][3] place in it */
  int64_t fine, interfaces;
} cdem_partition;

/* CDEM_INPUT: no grain in the fine region; an interface grain outside the mesh (its place); a face
 * between a fine and an outer cell that interface grains do not cover (the outer element, its place
 * and the part that is covered): the packing must go on beyond the fine region. Release at any
 * stage. */
cdem_status cdem_partition_init(const cdem_mesh *mesh, int32_t fine_cells, const int32_t *fine_cell,
                                const cdem_grains *grains, double gap, cdem_partition *partition,
                                cdem_fault *fault);
void cdem_partition_release(cdem_partition *partition);

#endif
