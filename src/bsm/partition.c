#include "bsm/partition.h"

#include "base/mat3.h"
#include "base/memory.h"
#include "base/sort.h"
#include "bsm/face.h"
#include "bsm/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_partition_release(cdem_partition *partition) {
  free(partition->outer_cell);
  free(partition->part);
  free(partition->cell);
  free(partition->xi);
  *partition = (cdem_partition){0};
}

static void middle_of(const cdem_mesh *mesh, int32_t cell, double middle[3]) {
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  int64_t nodes = mesh->cell_start[cell + 1] - mesh->cell_start[cell];
  memset(middle, 0, 3 * sizeof *middle);
  for (int64_t i = 0; i < nodes; i++)
    for (int c = 0; c < 3; c++)
      middle[c] += mesh->xyz[3 * (int64_t)node[i] + c] / (double)nodes;
}

static bool holds(const cdem_bsm_box *box, const double x[3]) {
  for (int c = 0; c < 3; c++)
    if (box->low[c] < box->high[c] && !(x[c] >= box->low[c] && x[c] <= box->high[c]))
      return false;
  return true;
}

/* ---- fine cells ---- */

static cdem_status empty_box(const cdem_mesh *mesh, int index, const cdem_bsm_box *box,
                             cdem_fault *fault) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int64_t n = 0; n < mesh->nodes; n++)
    for (int c = 0; c < 3; c++) {
      low[c] = fmin(low[c], mesh->xyz[3 * n + c]);
      high[c] = fmax(high[c], mesh->xyz[3 * n + c]);
    }
  return cdem_fail(
      fault, CDEM_INPUT,
      "fine region %d, from (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g m), holds no "
      "element of the mesh, which goes from (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g m)",
      index, box->low[0], box->low[1], box->low[2], box->high[0], box->high[1], box->high[2],
      low[0], low[1], low[2], high[0], high[1], high[2]);
}

cdem_status cdem_bsm_cells(const cdem_mesh *mesh, int boxes, const cdem_bsm_box *box,
                           int32_t *cells, int32_t **cell, cdem_fault *fault) {
  int dim = cdem_mesh_dimension(mesh);
  int64_t *held;
  int32_t *list;
  CDEM_NEW(held, boxes, fault);
  list = cdem_allocate(mesh->cells, sizeof *list, fault);
  cdem_status status = list != NULL ? CDEM_OK : CDEM_MEMORY;
  int32_t count = 0;
  for (int32_t c = 0; status == CDEM_OK && c < mesh->cells; c++) {
    double middle[3];
    bool inside = false;
    if (cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension != dim)
      continue;
    middle_of(mesh, c, middle);
    for (int b = 0; b < boxes; b++)
      if (holds(&box[b], middle)) {
        held[b]++;
        inside = true;
      }
    if (inside)
      list[count++] = c;
  }
  for (int b = 0; status == CDEM_OK && b < boxes; b++)
    if (held[b] == 0)
      status = empty_box(mesh, b, &box[b], fault);
  free(held);
  if (status != CDEM_OK) {
    free(list);
    return status;
  }
  *cells = count;
  *cell = list;
  return CDEM_OK;
}

/* ---- neighbours of fine grains ---- */

typedef struct {
  double low[3], size;
  int64_t count[3], *start;
  int32_t *item;
} bins;

static int64_t bin_of(const bins *b, int c, double x) {
  double at = floor((x - b->low[c]) / b->size);
  if (!(at > 0.0))
    return 0;
  return at >= (double)b->count[c] ? b->count[c] - 1 : (int64_t)at;
}

static int64_t bin_at(const bins *b, const double x[3]) {
  return (bin_of(b, 2, x[2]) * b->count[1] + bin_of(b, 1, x[1])) * b->count[0] + bin_of(b, 0, x[0]);
}

/* Fine grains by place; bins as wide as any grain's reach. */
static cdem_status sort_fine(const cdem_grains *grains, const uint8_t *part, double reach, bins *b,
                             cdem_fault *fault) {
  double high[3] = {-INFINITY, -INFINITY, -INFINITY};
  int64_t total = 1, fine = 0;
  for (int c = 0; c < 3; c++)
    b->low[c] = INFINITY;
  for (int64_t i = 0; i < grains->grains; i++)
    for (int c = 0; part[i] == CDEM_PART_FINE && c < 3; c++) {
      b->low[c] = fmin(b->low[c], grains->xyz[3 * i + c]);
      high[c] = fmax(high[c], grains->xyz[3 * i + c]);
      fine += c == 0;
    }
  /* Few grains far apart must not make bins without end. */
  for (b->size = reach;; b->size *= 2.0) {
    double count = 1.0;
    for (int c = 0; c < 3; c++)
      count *= floor((high[c] - b->low[c]) / b->size) + 1.0;
    if (!(count > 64.0 * (double)fine + 64.0))
      break;
  }
  for (int c = 0; c < 3; c++) {
    b->count[c] = (int64_t)floor((high[c] - b->low[c]) / b->size) + 1;
    total *= b->count[c];
  }
  CDEM_NEW(b->start, total + 2, fault);
  CDEM_NEW(b->item, fine, fault);
  for (int64_t i = 0; i < grains->grains; i++)
    if (part[i] == CDEM_PART_FINE)
      b->start[bin_at(b, grains->xyz + 3 * i) + 2]++;
  for (int64_t k = 2; k <= total; k++)
    b->start[k] += b->start[k - 1];
  for (int64_t i = 0; i < grains->grains; i++)
    if (part[i] == CDEM_PART_FINE)
      b->item[b->start[bin_at(b, grains->xyz + 3 * i) + 1]++] = (int32_t)i;
  return CDEM_OK;
}

static bool near_fine(const cdem_grains *grains, const bins *b, int64_t i, double gap) {
  const double *x = grains->xyz + 3 * i;
  int64_t from[3], to[3];
  for (int c = 0; c < 3; c++) {
    if (x[c] < b->low[c] - b->size || x[c] > b->low[c] + b->size * (double)(b->count[c] + 1))
      return false;
    from[c] = bin_of(b, c, x[c] - b->size);
    to[c] = bin_of(b, c, x[c] + b->size);
  }
  for (int64_t z = from[2]; z <= to[2]; z++)
    for (int64_t y = from[1]; y <= to[1]; y++)
      for (int64_t k = (z * b->count[1] + y) * b->count[0] + from[0],
                   end = (z * b->count[1] + y) * b->count[0] + to[0];
           k <= end; k++)
        for (int64_t p = b->start[k]; p < b->start[k + 1]; p++) {
          int64_t j = b->item[p];
          double d[3];
          for (int c = 0; c < 3; c++)
            d[c] = x[c] - grains->xyz[3 * j + c];
          if (cdem_norm3(d) <= grains->radius[i] + grains->radius[j] + gap)
            return true;
        }
  return false;
}

static cdem_status mark_interface(const cdem_grains *grains, double gap, cdem_partition *p,
                                  cdem_fault *fault) {
  double largest = 0.0;
  bins b = {0};
  for (int64_t i = 0; i < grains->grains; i++)
    largest = fmax(largest, grains->radius[i]);
  cdem_status status = sort_fine(grains, p->part, (2.0 + gap) * largest, &b, fault);
  for (int64_t i = 0; status == CDEM_OK && i < grains->grains; i++)
    if (p->part[i] != CDEM_PART_FINE && near_fine(grains, &b, i, gap * largest)) {
      p->part[i] = CDEM_PART_INTERFACE;
      p->interfaces++;
    }
  free(b.start);
  free(b.item);
  return status;
}

/* ---- are the faces between fine and outer cells covered? ---- */

typedef struct {
  int32_t node[4]; /* ascending; 2-D: the last two are -1 */
} face;

static int compare_faces(const void *a, const void *b) {
  return memcmp(a, b, sizeof(face));
}

/* Corners of a face in order around it, and the face to compare. */
static int face_of(const cdem_mesh *mesh, int32_t cell, int index, int32_t corner[4], face *f) {
  const cdem_shape_info *shape = cdem_shape_get((cdem_shape)mesh->cell_shape[cell]);
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  bool plane = shape->dimension == 2;
  int corners = plane ? 2 : shape->face_corners[index];
  for (int i = 0; i < 4; i++)
    f->node[i] = -1;
  for (int i = 0; i < corners; i++) {
    int at = i;
    corner[i] = node[plane ? shape->edge[index][i] : shape->face[index][i]];
    for (; at > 0 && f->node[at - 1] > corner[i]; at--)
      f->node[at] = f->node[at - 1];
    f->node[at] = corner[i];
  }
  return corners;
}

static int faces_of(const cdem_mesh *mesh, int32_t cell) {
  const cdem_shape_info *shape = cdem_shape_get((cdem_shape)mesh->cell_shape[cell]);
  return shape->dimension == 2 ? shape->edges : shape->faces;
}

static cdem_status uncovered(const cdem_mesh *mesh, int32_t cell, double part, cdem_fault *fault) {
  double x[3];
  middle_of(mesh, cell, x);
  return cdem_fail(fault, CDEM_INPUT,
                   "interface grains are missing: element %lld at (%.4g, %.4g, %.4g m) borders on "
                   "the fine region, but only %.0f %% of that face has grains behind it; let the "
                   "packing go on beyond the fine region by two diameters",
                   (long long)mesh->cell_tag[cell], x[0], x[1], x[2], 100.0 * part);
}

/* What stands behind faces: interface grains by their cells, outer cells by their nodes. */
typedef struct {
  int64_t faces;
  face *face;           /* [faces] of fine cells, sorted */
  int64_t *grain_start; /* [mesh cells + 2] */
  int32_t *grain;       /* [interface grains] */
  int64_t *cell_start;  /* [mesh nodes + 2] */
  int32_t *cell;        /* outer cells of each node */
  int64_t *seen;        /* [mesh cells] the face that has counted a cell last */
} cover;

static void cover_release(cover *c) {
  free(c->face);
  free(c->grain_start);
  free(c->grain);
  free(c->cell_start);
  free(c->cell);
  free(c->seen);
}

static cdem_status cover_init(const cdem_mesh *mesh, int32_t fine_cells, const int32_t *fine_cell,
                              const cdem_partition *p, cover *c, cdem_fault *fault) {
  int32_t corner[4];
  int64_t entries = 0;
  for (int32_t k = 0; k < p->outer_cells; k++)
    entries += mesh->cell_start[p->outer_cell[k] + 1] - mesh->cell_start[p->outer_cell[k]];
  CDEM_NEW(c->face, 6 * (int64_t)fine_cells, fault);
  CDEM_NEW(c->grain_start, (int64_t)mesh->cells + 2, fault);
  CDEM_NEW(c->grain, p->interfaces, fault);
  CDEM_NEW(c->cell_start, (int64_t)mesh->nodes + 2, fault);
  CDEM_NEW(c->cell, entries, fault);
  CDEM_NEW(c->seen, mesh->cells, fault);
  for (int32_t k = 0; k < fine_cells; k++)
    for (int i = 0; i < faces_of(mesh, fine_cell[k]); i++)
      face_of(mesh, fine_cell[k], i, corner, &c->face[c->faces++]);
  cdem_sort(c->face, c->faces, sizeof *c->face, compare_faces);
  /* Both lists: counted two places on, summed, then filled one place on. */
  for (int64_t i = 0; i < p->grains; i++)
    if (p->part[i] == CDEM_PART_INTERFACE)
      c->grain_start[p->cell[i] + 2]++;
  for (int32_t k = 2; k <= mesh->cells; k++)
    c->grain_start[k] += c->grain_start[k - 1];
  for (int64_t i = 0; i < p->grains; i++)
    if (p->part[i] == CDEM_PART_INTERFACE)
      c->grain[c->grain_start[p->cell[i] + 1]++] = (int32_t)i;
  for (int pass = 0; pass < 2; pass++) {
    for (int32_t k = 0; k < p->outer_cells; k++)
      for (int64_t n = mesh->cell_start[p->outer_cell[k]];
           n < mesh->cell_start[p->outer_cell[k] + 1]; n++) {
        if (pass == 0)
          c->cell_start[mesh->cell_node[n] + 2]++;
        else
          c->cell[c->cell_start[mesh->cell_node[n] + 1]++] = p->outer_cell[k];
      }
    for (int32_t n = 2; pass == 0 && n <= mesh->nodes; n++)
      c->cell_start[n] += c->cell_start[n - 1];
  }
  return CDEM_OK;
}

/* Size of the interface grains whose foot is on a face, in whatever cell around it they lie: cells
 * that taper (tetrahedra, pyramids) leave part of the layer to their neighbours. `mark`: other than
 * at any call before. */
static double behind(const cover *c, const cdem_grains *grains, const cdem_bsm_frame *f,
                     int corners, const int32_t *corner, int64_t mark) {
  double size = 0.0;
  for (int i = 0; i < corners; i++)
    for (int64_t k = c->cell_start[corner[i]]; k < c->cell_start[corner[i] + 1]; k++) {
      int32_t cell = c->cell[k];
      if (c->seen[cell] == mark)
        continue;
      c->seen[cell] = mark;
      for (int64_t g = c->grain_start[cell]; g < c->grain_start[cell + 1]; g++)
        if (cdem_bsm_on_face(f, grains->xyz + 3 * (int64_t)c->grain[g], 0.0))
          size += pow(2.0 * grains->radius[c->grain[g]], grains->dim - 1);
    }
  return size;
}

static cdem_status check_cover(const cdem_mesh *mesh, const cdem_grains *grains,
                               const cdem_partition *p, const cover *c, cdem_fault *fault) {
  static const double least = 0.3; /* a lattice at 45 degrees has 0.7 */
  int64_t mark = 0;
  for (int32_t k = 0; k < p->outer_cells; k++)
    for (int i = 0; i < faces_of(mesh, p->outer_cell[k]); i++) {
      face f;
      int32_t corner[4];
      cdem_bsm_frame frame;
      int corners = face_of(mesh, p->outer_cell[k], i, corner, &f);
      if (bsearch(&f, c->face, (size_t)c->faces, sizeof f, compare_faces) == NULL)
        continue;
      cdem_bsm_frame_of(mesh, corners, corner, &frame);
      double size = cdem_bsm_face_size(&frame);
      double covered = behind(c, grains, &frame, corners, corner, ++mark);
      if (covered < least * size)
        return uncovered(mesh, p->outer_cell[k], covered / size, fault);
    }
  return CDEM_OK;
}

/* ---- all ---- */

static cdem_status list_outer(const cdem_mesh *mesh, int32_t fine_cells, const int32_t *fine_cell,
                              cdem_partition *p, cdem_fault *fault) {
  int dim = cdem_mesh_dimension(mesh);
  int32_t next = 0;
  CDEM_NEW(p->outer_cell, mesh->cells, fault);
  for (int32_t c = 0; c < mesh->cells; c++) {
    if (next < fine_cells && fine_cell[next] == c)
      next++;
    else if (cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension == dim)
      p->outer_cell[p->outer_cells++] = c;
  }
  return CDEM_OK;
}

static cdem_status place_interface(const cdem_grains *grains, const int32_t *cell, const double *xi,
                                   cdem_partition *p, cdem_fault *fault) {
  for (int64_t i = 0; i < p->grains; i++) {
    const double *x = grains->xyz + 3 * i;
    if (p->part[i] != CDEM_PART_INTERFACE)
      continue;
    CDEM_REQUIRE(cell[i] >= 0, fault, CDEM_INPUT,
                 "grain %lld at (%.4g, %.4g, %.4g m) touches the fine region but lies outside the "
                 "mesh; let the packing end where the mesh ends",
                 (long long)i, x[0], x[1], x[2]);
    p->cell[i] = cell[i];
    memcpy(p->xi + 3 * i, xi + 3 * i, 3 * sizeof *xi);
  }
  return CDEM_OK;
}

static cdem_status divide(const cdem_mesh *mesh, int32_t fine_cells, const int32_t *fine_cell,
                          const cdem_grains *grains, double gap, cdem_partition *p,
                          cdem_fault *fault) {
  int32_t *cell;
  double *xi;
  p->grains = grains->grains;
  CDEM_NEW(p->part, p->grains, fault);
  CDEM_NEW(p->cell, p->grains, fault);
  CDEM_NEW(p->xi, 3 * p->grains, fault);
  CDEM_TRY(list_outer(mesh, fine_cells, fine_cell, p, fault));
  CDEM_TRY(cdem_locate(mesh, fine_cells, fine_cell, p->grains, grains->xyz, p->cell, p->xi, fault));
  for (int64_t i = 0; i < p->grains; i++)
    if (p->cell[i] >= 0) {
      p->part[i] = CDEM_PART_FINE;
      p->fine++;
    }
  CDEM_REQUIRE(p->fine > 0, fault, CDEM_INPUT,
               "no grain has its centre in the fine region; look at the box of the packing and the "
               "units of both");
  CDEM_TRY(mark_interface(grains, gap, p, fault));
  cell = cdem_allocate(p->grains, sizeof *cell, fault);
  xi = cdem_allocate(3 * p->grains, sizeof *xi, fault);
  cdem_status status = cell == NULL || xi == NULL ? CDEM_MEMORY : CDEM_OK;
  if (status == CDEM_OK)
    status =
        cdem_locate(mesh, p->outer_cells, p->outer_cell, p->grains, grains->xyz, cell, xi, fault);
  if (status == CDEM_OK)
    status = place_interface(grains, cell, xi, p, fault);
  free(cell);
  free(xi);
  CDEM_TRY(status);
  cover c = {0};
  status = cover_init(mesh, fine_cells, fine_cell, p, &c, fault);
  if (status == CDEM_OK)
    status = check_cover(mesh, grains, p, &c, fault);
  cover_release(&c);
  return status;
}

cdem_status cdem_partition_init(const cdem_mesh *mesh, int32_t fine_cells, const int32_t *fine_cell,
                                const cdem_grains *grains, double gap, cdem_partition *partition,
                                cdem_fault *fault) {
  cdem_partition p = {0};
  cdem_status status = divide(mesh, fine_cells, fine_cell, grains, gap, &p, fault);
  if (status != CDEM_OK) {
    cdem_partition_release(&p);
    return status;
  }
  *partition = p;
  return CDEM_OK;
}
