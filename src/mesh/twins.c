/* Cells with the same nodes: a cell that is there twice would count twice. */
#include "mesh/mesh.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  uint64_t key; /* sum of scrambled node ids: the same in any order */
  int32_t cell;
} marked;

static int by_key(const void *left, const void *right) {
  const marked *a = left, *b = right;
  if (a->key != b->key)
    return a->key < b->key ? -1 : 1;
  return (a->cell > b->cell) - (a->cell < b->cell);
}

static int by_id(const void *left, const void *right) {
  int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
  return (a > b) - (a < b);
}

static bool same_nodes(const cdem_mesh *mesh, int32_t first, int32_t second) {
  int32_t a[CDEM_SHAPE_MAX_NODES], b[CDEM_SHAPE_MAX_NODES];
  size_t nodes = (size_t)cdem_shape_get(mesh->cell_shape[first])->nodes;
  if (mesh->cell_shape[first] != mesh->cell_shape[second])
    return false;
  memcpy(a, cdem_mesh_cell(mesh, first), nodes * sizeof *a);
  memcpy(b, cdem_mesh_cell(mesh, second), nodes * sizeof *b);
  qsort(a, nodes, sizeof *a, by_id);
  qsort(b, nodes, sizeof *b, by_id);
  return memcmp(a, b, nodes * sizeof *a) == 0;
}

cdem_status cdem_mesh_find_twins(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                 int32_t *first, int32_t *second, cdem_fault *fault) {
  *first = *second = -1;
  marked *mark;
  CDEM_NEW(mark, cells, fault);
  for (int32_t i = 0; i < cells; i++) {
    const int32_t *node = cdem_mesh_cell(mesh, cell[i]);
    mark[i].cell = cell[i];
    for (int a = 0; a < cdem_shape_get(mesh->cell_shape[cell[i]])->nodes; a++) {
      cdem_random scramble = {(uint64_t)node[a]};
      mark[i].key += cdem_random_next(&scramble);
    }
  }
  if (cells > 1)
    qsort(mark, (size_t)cells, sizeof *mark, by_key);
  for (int32_t i = 1; i < cells && *first < 0; i++)
    if (mark[i].key == mark[i - 1].key && same_nodes(mesh, mark[i - 1].cell, mark[i].cell)) {
      *first = mark[i - 1].cell;
      *second = mark[i].cell;
    }
  free(mark);
  return CDEM_OK;
}
