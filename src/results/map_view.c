#include "results/map_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

cdem_status cdem_map_view_init(const double into[3], const double up[3], cdem_map_view *view,
                               cdem_fault *fault) {
  double right[3], length = cdem_norm3(into);
  cdem_cross3(into, up, right);
  double size = cdem_norm3(right);
  CDEM_REQUIRE(size > 1e-6 * length * cdem_norm3(up) && isfinite(size), fault, CDEM_USAGE,
               "a map cannot be seen along (%g, %g, %g) with (%g, %g, %g) upwards; choose two "
               "directions that are not parallel",
               into[0], into[1], into[2], up[0], up[1], up[2]);
  for (int c = 0; c < 3; c++) {
    view->right[c] = right[c] / size;
    view->into[c] = into[c] / length;
  }
  cdem_cross3(view->right, view->into, view->up);
  return CDEM_OK;
}

const cdem_field *cdem_frame_find_field(const cdem_frame *frame, const char *name) {
  for (int f = 0; f < frame->fields; f++)
    if (strcmp(frame->field[f].name, name) == 0)
      return &frame->field[f];
  return NULL;
}

double cdem_field_at(const cdem_field *field, int64_t index) {
  return field->type == CDEM_FIELD_REAL    ? ((const double *)field->data)[index]
         : field->type == CDEM_FIELD_INT32 ? ((const int32_t *)field->data)[index]
                                           : ((const uint8_t *)field->data)[index];
}

const cdem_vtk_cell *cdem_vtk_cell_get(uint8_t type) {
  static const cdem_vtk_cell cells[15] = {
      [3] = {1, 0, 1, {{0}}, {{0, 1}}},
      [5] = {2, 1, 3, {{0, 1, 2, -1}}, {{0, 1}, {1, 2}, {2, 0}}},
      [9] = {2, 1, 4, {{0, 1, 2, 3}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
      [10] = {3,
              4,
              6,
              {{0, 1, 2, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 2, 3, -1}},
              {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
      [12] = {3,
              6,
              12,
              {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},
              {{0, 1},
               {1, 2},
               {2, 3},
               {3, 0},
               {4, 5},
               {5, 6},
               {6, 7},
               {7, 4},
               {0, 4},
               {1, 5},
               {2, 6},
               {3, 7}}},
      [13] = {3,
              5,
              9,
              {{0, 1, 2, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
              {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
      [14] = {3,
              5,
              8,
              {{0, 1, 2, 3}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}},
              {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
  };
  return &cells[type < 15 ? type : 0];
}

/* ---- outer faces: a hash table of the faces' nodes, open addressing ---- */

static void sort_nodes(const cdem_map_face *face, int32_t key[4]) {
  for (int i = 0; i < 4; i++)
    key[i] = i < face->corners ? face->node[i] : -1;
  for (int i = 1; i < face->corners; i++)
    for (int j = i; j > 0 && key[j - 1] > key[j]; j--) {
      int32_t swap = key[j];
      key[j] = key[j - 1];
      key[j - 1] = swap;
    }
}

static uint64_t hash(const int32_t key[4]) {
  uint64_t h = 0x9e3779b97f4a7c15u;
  for (int i = 0; i < 4; i++)
    h = (h ^ (uint32_t)key[i]) * 0xff51afd7ed558ccdu, h ^= h >> 29;
  return h;
}

static void fill_face(const cdem_frame *frame, int64_t cell, int f, cdem_map_face *face) {
  const int8_t *local = cdem_vtk_cell_get(frame->type[cell])->face[f];
  const int32_t *node = frame->node + frame->offset[cell];
  *face = (cdem_map_face){.cell = cell};
  for (; face->corners < 4 && local[face->corners] >= 0; face->corners++)
    face->node[face->corners] = node[local[face->corners]];
}

/* Marks a face of a 3-D cell and its twin; a face of three cells stays hidden. */
static void meet(cdem_map_face *face, int64_t i, int64_t *slot, uint64_t mask, bool *inner) {
  int32_t key[4], other[4];
  sort_nodes(&face[i], key);
  for (uint64_t at = hash(key) & mask;; at = (at + 1) & mask) {
    if (slot[at] == 0) {
      slot[at] = i + 1;
      return;
    }
    sort_nodes(&face[slot[at] - 1], other);
    if (memcmp(key, other, sizeof key) == 0) {
      inner[slot[at] - 1] = inner[i] = true;
      return;
    }
  }
}

cdem_status cdem_map_outer_faces(const cdem_frame *frame, int64_t *faces, cdem_map_face **face,
                                 cdem_fault *fault) {
  int64_t all = 0, kept = 0, slots = 16;
  for (int64_t c = 0; c < frame->cells; c++)
    all += cdem_vtk_cell_get(frame->type[c])->faces;
  while (slots < 2 * all)
    slots *= 2;
  cdem_map_face *list = cdem_allocate(all, sizeof *list, fault);
  int64_t *slot = list != NULL ? cdem_allocate(slots, sizeof *slot, fault) : NULL;
  bool *inner = slot != NULL ? cdem_allocate(all, sizeof *inner, fault) : NULL;
  if (inner == NULL) {
    free(list);
    free(slot);
    return CDEM_MEMORY;
  }
  int64_t i = 0;
  for (int64_t c = 0; c < frame->cells; c++) {
    const cdem_vtk_cell *cell = cdem_vtk_cell_get(frame->type[c]);
    for (int f = 0; f < cell->faces; f++, i++) {
      fill_face(frame, c, f, &list[i]);
      if (cell->dimension == 3)
        meet(list, i, slot, (uint64_t)slots - 1, inner);
    }
  }
  for (i = 0; i < all; i++)
    if (!inner[i])
      list[kept++] = list[i];
  free(slot);
  free(inner);
  *faces = kept;
  *face = list;
  return CDEM_OK;
}
