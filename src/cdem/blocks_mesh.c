/* Blocks: the cut mesh, its groups, its face pairs and facets. */
#include "base/sets.h"
#include "cdem/blocks_cut.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Local number of a node in a chosen cell, -1 when it is not there. */
static int local_node(const cdem_cut *cut, int32_t position, int32_t node) {
  const int32_t *own = cdem_mesh_cell(cut->mesh, cut->cell[position]);
  int nodes = cdem_cut_info(cut, position)->nodes;
  for (int k = 0; k < nodes; k++)
    if (own[k] == node)
      return k;
  return -1;
}

/* Id in the new mesh of an old node as the chosen cell has it. */
static int32_t new_node(const cdem_cut *cut, int32_t position, int32_t node) {
  return cut->corner_node[cut->corner_start[position] + local_node(cut, position, node)];
}

/* Corners at one node are one copy where uncut faces join their cells. */
static void join_corners(const cdem_cut *cut, int32_t *parent) {
  cdem_sets_init(parent, 0, (int32_t)cut->corner_start[cut->chosen]);
  for (int32_t s = 0; s < cut->slot_start[cut->chosen]; s++) {
    if (cut->cut[s] || cut->mate[s] < s) /* -1: on the surface */
      continue;
    int32_t a = cut->slot_cell[s], b = cut->slot_cell[cut->mate[s]];
    const int32_t *node = cdem_mesh_cell(cut->mesh, cut->cell[a]);
    const int8_t *local;
    int corners = cdem_cut_face(cdem_cut_info(cut, a), (int)(s - cut->slot_start[a]), &local);
    for (int k = 0; k < corners; k++)
      cdem_sets_join(parent, (int32_t)(cut->corner_start[a] + local[k]),
                     (int32_t)(cut->corner_start[b] + local_node(cut, b, node[local[k]])));
  }
}

/* Numbers the copies: nodes in the old order, copies by their first corner. start [old nodes + 1]
 * zeroed; returns how many. */
static int32_t number_corners(cdem_cut *cut, int32_t *parent, int32_t *start) {
  const cdem_mesh *mesh = cut->mesh;
  for (int pass = 0; pass < 2; pass++) {
    for (int32_t i = 0; i < cut->chosen; i++) {
      const int32_t *node = cdem_mesh_cell(mesh, cut->cell[i]);
      for (int64_t c = cut->corner_start[i]; c < cut->corner_start[i + 1]; c++) {
        int32_t root = cdem_sets_root(parent, (int32_t)c);
        int32_t own = node[c - cut->corner_start[i]];
        if (pass == 0)
          start[own + 1] += root == c;
        else
          cut->corner_node[c] = root == c ? start[own]++ : cut->corner_node[root];
      }
    }
    for (int32_t n = 0; n < mesh->nodes && pass == 0; n++)
      start[n + 1] += start[n];
  }
  return start[mesh->nodes];
}

static cdem_status add_nodes(const cdem_cut *cut, int32_t nodes, cdem_blocks *blocks,
                             cdem_fault *fault) {
  const cdem_mesh *mesh = cut->mesh;
  CDEM_NEW(blocks->original, nodes, fault);
  CDEM_NEW(blocks->node_block, nodes, fault);
  for (int32_t i = 0; i < cut->chosen; i++) {
    const int32_t *node = cdem_mesh_cell(mesh, cut->cell[i]);
    for (int64_t c = cut->corner_start[i]; c < cut->corner_start[i + 1]; c++) {
      blocks->original[cut->corner_node[c]] = node[c - cut->corner_start[i]];
      blocks->node_block[cut->corner_node[c]] = cut->block[i];
    }
  }
  CDEM_TRY(cdem_mesh_reserve(&blocks->mesh, nodes, 0, 0, fault));
  for (int32_t n = 0; n < nodes; n++) {
    int32_t old = blocks->original[n];
    CDEM_TRY(cdem_mesh_add_nodes(&blocks->mesh, 1, mesh->xyz + 3 * (int64_t)old,
                                 &mesh->node_tag[old], fault));
  }
  return CDEM_OK;
}

cdem_status cdem_cut_nodes(cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault) {
  int64_t corners = cut->corner_start[cut->chosen];
  CDEM_NEW(cut->corner_node, corners, fault);
  int32_t *parent = cdem_allocate(corners, sizeof *parent, fault);
  int32_t *start = cdem_allocate((int64_t)cut->mesh->nodes + 1, sizeof *start, fault);
  cdem_status status = CDEM_MEMORY;
  if (parent != NULL && start != NULL) {
    join_corners(cut, parent);
    status = add_nodes(cut, number_corners(cut, parent, start), blocks, fault);
  }
  free(parent);
  free(start);
  return status;
}

/* Whether the nodes are the ends of an edge of the cell (3-D lines), or one of its nodes. */
static bool cell_has(const cdem_cut *cut, int32_t position, const int32_t *node, int nodes) {
  if (nodes == 1)
    return local_node(cut, position, node[0]) >= 0;
  const cdem_shape_info *info = cdem_cut_info(cut, position);
  int a = local_node(cut, position, node[0]), b = local_node(cut, position, node[1]);
  for (int e = 0; e < info->edges; e++)
    if ((info->edge[e][0] == a && info->edge[e][1] == b) ||
        (info->edge[e][0] == b && info->edge[e][1] == a))
      return true;
  return false;
}

/* Which chosen cells are around each node: around [start[n] .. start[n + 1]) ascending. */
typedef struct {
  int32_t *start, *around;
} node_cells;

static cdem_status list_cells(const cdem_cut *cut, node_cells *list, cdem_fault *fault) {
  const cdem_mesh *mesh = cut->mesh;
  CDEM_NEW(list->start, (int64_t)mesh->nodes + 2, fault);
  CDEM_NEW(list->around, cut->corner_start[cut->chosen], fault);
  for (int pass = 0; pass < 2; pass++) {
    for (int32_t i = 0; i < cut->chosen; i++) {
      const int32_t *node = cdem_mesh_cell(mesh, cut->cell[i]);
      int nodes = cdem_cut_info(cut, i)->nodes;
      for (int k = 0; k < nodes; k++)
        if (pass == 0)
          list->start[node[k] + 2]++;
        else
          list->around[list->start[node[k] + 1]++] = i;
    }
    for (int32_t n = 0; n < mesh->nodes && pass == 0; n++)
      list->start[n + 2] += list->start[n + 1];
  }
  return CDEM_OK;
}

/* The chosen cell that carries a cell of lower dimension: the first that has it, -1. */
static int32_t carrier_of(const cdem_cut *cut, const node_cells *list, int32_t cell) {
  const int32_t *node = cdem_mesh_cell(cut->mesh, cell);
  const cdem_shape_info *info = cdem_shape_get((cdem_shape)cut->mesh->cell_shape[cell]);
  if (info->nodes != info->corners)
    return -1;
  if (info->dimension == cut->dimension - 1) {
    int32_t key[4];
    cdem_cut_key(node, NULL, info->corners, key);
    int32_t slot = cdem_cut_find(cut, key);
    return slot < 0 ? -1 : cut->slot_cell[slot];
  }
  for (int32_t k = list->start[node[0]]; k < list->start[node[0] + 1]; k++)
    if (cell_has(cut, list->around[k], node, info->nodes))
      return list->around[k];
  return -1;
}

static cdem_status add_cell(cdem_cut *cut, const node_cells *list, int32_t cell,
                            cdem_blocks *blocks, cdem_fault *fault) {
  const cdem_mesh *mesh = cut->mesh;
  int32_t position = cut->position[cell];
  const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh->cell_shape[cell]);
  cut->new_cell[cell] = -1;
  if (position < 0 && info->dimension < cut->dimension)
    position = carrier_of(cut, list, cell);
  if (position < 0)
    return CDEM_OK;
  int32_t node[CDEM_SHAPE_MAX_NODES];
  for (int k = 0; k < info->nodes; k++)
    node[k] = new_node(cut, position, cdem_mesh_cell(mesh, cell)[k]);
  int32_t id = blocks->mesh.cells;
  CDEM_TRY(cdem_mesh_add_cells(&blocks->mesh, (cdem_shape)mesh->cell_shape[cell], 1, node,
                               &mesh->cell_tag[cell], fault));
  cut->new_cell[cell] = id;
  blocks->old_cell[id] = cell;
  blocks->block[id] = cut->position[cell] >= 0 ? cut->block[position] : -1;
  return CDEM_OK;
}

cdem_status cdem_cut_cells(cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault) {
  const cdem_mesh *mesh = cut->mesh;
  CDEM_NEW(cut->new_cell, mesh->cells, fault);
  CDEM_NEW(blocks->old_cell, mesh->cells, fault);
  CDEM_NEW(blocks->block, mesh->cells, fault);
  if (mesh->source != NULL && (blocks->mesh.source = cdem_copy_text(mesh->source, fault)) == NULL)
    return CDEM_MEMORY;
  CDEM_TRY(cdem_mesh_reserve(&blocks->mesh, blocks->mesh.nodes, cut->chosen,
                             cut->corner_start[cut->chosen], fault));
  node_cells list = {0};
  cdem_status status = list_cells(cut, &list, fault);
  for (int32_t c = 0; c < mesh->cells && status == CDEM_OK; c++)
    status = add_cell(cut, &list, c, blocks, fault);
  free(list.start);
  free(list.around);
  return status;
}

cdem_status cdem_cut_groups(const cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault) {
  int32_t *kept = NULL;
  int64_t room = 0;
  for (int32_t g = 0; g < cut->mesh->groups; g++) {
    const cdem_group *group = &cut->mesh->group[g];
    int32_t cells = 0;
    cdem_status status = cdem_grow(&kept, &room, group->cells, sizeof *kept, fault);
    for (int32_t k = 0; k < group->cells && status == CDEM_OK; k++)
      if (cut->new_cell[group->cell[k]] >= 0)
        kept[cells++] = cut->new_cell[group->cell[k]];
    if (status == CDEM_OK)
      status =
          cdem_mesh_add_group(&blocks->mesh, group->name, group->dimension, cells, kept, fault);
    if (status != CDEM_OK) {
      free(kept);
      return status;
    }
  }
  free(kept);
  return CDEM_OK;
}

/* The pair of a cut slot and its mate. */
static cdem_face_pair pair_of(const cdem_cut *cut, int32_t slot) {
  int32_t position[2] = {cut->slot_cell[slot], cut->slot_cell[cut->mate[slot]]};
  const int32_t *node = cdem_mesh_cell(cut->mesh, cut->cell[position[0]]);
  const int8_t *local;
  int corners = cdem_cut_face(cdem_cut_info(cut, position[0]),
                              (int)(slot - cut->slot_start[position[0]]), &local);
  cdem_face_pair pair = {.corners = (uint8_t)corners, .joint = cut->joint[slot]};
  for (int side = 0; side < 2; side++) {
    pair.cell[side] = cut->new_cell[cut->cell[position[side]]];
    for (int k = 0; k < 4; k++)
      pair.node[side][k] = k < corners ? new_node(cut, position[side], node[local[k]]) : -1;
  }
  return pair;
}

static cdem_facet facet_of(const cdem_cut *cut, int32_t slot) {
  int32_t position = cut->slot_cell[slot];
  const int8_t *local;
  int corners =
      cdem_cut_face(cdem_cut_info(cut, position), (int)(slot - cut->slot_start[position]), &local);
  cdem_facet facet = {
      .cell = cut->new_cell[cut->cell[position]], .corners = (uint8_t)corners, .pair = -1};
  for (int k = 0; k < 4; k++)
    facet.node[k] = k < corners ? cut->corner_node[cut->corner_start[position] + local[k]] : -1;
  return facet;
}

/* pair_of_slot [slots] is room for the pairs' numbers. */
static void fill_facets(const cdem_cut *cut, int32_t *pair_of_slot, cdem_blocks *blocks) {
  int32_t pairs = 0, facets = 0;
  for (int32_t s = 0; s < cut->slot_start[cut->chosen]; s++) {
    if (cut->mate[s] >= 0 && !cut->cut[s])
      continue;
    cdem_facet facet = facet_of(cut, s);
    if (cut->cut[s]) {
      bool first = s < cut->mate[s];
      if (first)
        blocks->pair[pairs] = pair_of(cut, s);
      facet.pair = pair_of_slot[s] = first ? pairs++ : pair_of_slot[cut->mate[s]];
      blocks->pair_facet[2 * (int64_t)facet.pair + !first] = facets;
    }
    blocks->facet[facets++] = facet;
  }
}

cdem_status cdem_cut_facets(const cdem_cut *cut, cdem_blocks *blocks, cdem_fault *fault) {
  int32_t slots = (int32_t)cut->slot_start[cut->chosen];
  for (int32_t s = 0; s < slots; s++) {
    blocks->facets += cut->cut[s] || cut->mate[s] < 0;
    blocks->pairs += cut->cut[s] && s < cut->mate[s];
  }
  CDEM_NEW(blocks->pair, blocks->pairs, fault);
  CDEM_NEW(blocks->facet, blocks->facets, fault);
  CDEM_NEW(blocks->pair_facet, 2 * (int64_t)blocks->pairs, fault);
  int32_t *pair_of_slot;
  CDEM_NEW(pair_of_slot, slots, fault);
  fill_facets(cut, pair_of_slot, blocks);
  free(pair_of_slot);
  return CDEM_OK;
}
