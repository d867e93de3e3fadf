/* Which triangles may be nearest to the places of a cell.
 *
 * Deforming moves each point of the surface by at most m = margin, and with it each distance. Let C
 * be the centre of a box and h its half diagonal, d_t the distance of triangle t in the reference.
 * For a place y of the box and the triangle t that is nearest to it in the deformed body
 *
 *     d_t(C) <= d_t(y) + h <= min d(y) + 2 m + h <= min d(C) + 2 m + 2 h (1)
 *
 * so all other triangles may be left out. The box is halved again and again, each time from the
 * list of the box before, which holds all nearest triangles of its places. A cell joins the lists
 * of its eight octants, for which h is half as large.
 *
 * A box further outside than m + h holds nothing that can be inside: while the surface moves there
 * from the reference it never passes a place further away than m. Boxes deep inside are not halved,
 * their cells share a list: nodes come there seldom. */
#include "base/memory.h"
#include "fdem/surface_near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CELLS = 64, FEW = 4 };

typedef struct {
  cdem_skin *s;
  double deep;
  int64_t items, capacity, starts;
  uint8_t *chosen;  /* [triangles] by an octant */
  double *distance; /* [triangles] */
} builder;

typedef struct {
  double center[3], half; /* edge/2 */
  int32_t count;
  int32_t *item; /* [count] ascending */
} box;

typedef enum { BOX_EMPTY, BOX_DEEP, BOX_NEAR } box_kind;

/* Keeps those of `from` that (1) lets in. The bound is taken a little larger than rounding. */
static box_kind sift(builder *b, const box *from, box *to) {
  const cdem_skin *s = b->s;
  const double h = sqrt(3.0) * to->half;
  cdem_near near, best = {.square = INFINITY};
  int32_t nearest = from->item[0];
  for (int32_t k = 0; k < from->count; k++) {
    const int32_t *node = s->triangle + 3 * (int64_t)from->item[k];
    cdem_near_triangle(s->reference + 3 * (int64_t)node[0], s->reference + 3 * (int64_t)node[1],
                       s->reference + 3 * (int64_t)node[2], to->center, &near);
    b->distance[k] = sqrt(near.square);
    if (near.square < best.square) {
      best = near;
      nearest = from->item[k];
    }
  }
  double side = cdem_near_side(s, s->reference, nearest, &best, to->center);
  if (side > s->margin + h)
    return BOX_EMPTY;
  double bound = (sqrt(best.square) + 2.0 * s->margin + 2.0 * h) * (1.0 + 0x1p-40);
  to->count = 0;
  for (int32_t k = 0; k < from->count; k++)
    if (b->distance[k] <= bound)
      to->item[to->count++] = from->item[k];
  bool inside = -side > s->margin + h;
  return inside && (-side - h > b->deep || to->count <= FEW) ? BOX_DEEP : BOX_NEAR;
}

static cdem_status add_list(builder *b, const int32_t *item, int32_t count, cdem_fault *fault) {
  cdem_skin *s = b->s;
  CDEM_TRY(cdem_grow(&s->item, &b->capacity, b->items + count, sizeof *s->item, fault));
  CDEM_TRY(cdem_grow(&s->start, &b->starts, s->lists + 2, sizeof *s->start, fault));
  if (count > 0)
    memcpy(s->item + b->items, item, (size_t)count * sizeof *item);
  b->items += count;
  s->lists++;
  s->start[s->lists] = b->items;
  return CDEM_OK;
}

/* The last list for the `side`^3 cells from `cell` on. */
static void give(builder *b, const int32_t cell[3], int32_t side) {
  cdem_skin *s = b->s;
  for (int32_t i = cell[0]; i < cell[0] + side; i++)
    for (int32_t j = cell[1]; j < cell[1] + side; j++)
      for (int32_t k = cell[2]; k < cell[2] + side; k++)
        s->list[((int64_t)i * s->cells + j) * s->cells + k] = s->lists - 1;
}

static void octant_of(const box *whole, int octant, box *part) {
  part->half = 0.5 * whole->half;
  for (int c = 0; c < 3; c++)
    part->center[c] = whole->center[c] + (octant >> c & 1 ? part->half : -part->half);
}

static cdem_status fill_cell(builder *b, const box *whole, box *part, const int32_t cell[3],
                             cdem_fault *fault) {
  memset(b->chosen, 0, (size_t)b->s->triangles);
  for (int octant = 0; octant < 8; octant++) {
    octant_of(whole, octant, part);
    if (sift(b, whole, part) == BOX_EMPTY)
      continue;
    for (int32_t k = 0; k < part->count; k++)
      b->chosen[part->item[k]] = 1;
  }
  part->count = 0;
  for (int32_t k = 0; k < whole->count; k++)
    if (b->chosen[whole->item[k]])
      part->item[part->count++] = whole->item[k];
  if (part->count == 0)
    return CDEM_OK;
  CDEM_TRY(add_list(b, part->item, part->count, fault));
  give(b, cell, 1);
  return CDEM_OK;
}

/* level [..]: boxes for this one's octants and all below. Depth: log2(MOST_CELLS) + 1. */
static cdem_status fill_box(builder *b, box *level, const int32_t cell[3], int32_t side,
                            cdem_fault *fault) {
  if (side == 1)
    return fill_cell(b, level, level + 1, cell, fault);
  for (int octant = 0; octant < 8; octant++) {
    int32_t corner[3];
    octant_of(level, octant, level + 1);
    for (int c = 0; c < 3; c++)
      corner[c] = cell[c] + (octant >> c & 1 ? side / 2 : 0);
    box_kind kind = sift(b, level, level + 1);
    if (kind == BOX_NEAR) {
      CDEM_TRY(fill_box(b, level + 1, corner, side / 2, fault));
    } else if (kind == BOX_DEEP) {
      CDEM_TRY(add_list(b, level[1].item, level[1].count, fault));
      give(b, corner, side / 2);
    }
  }
  return CDEM_OK;
}

/* A cube about the reference with room for the margin; cells of a third of a triangle's edge. */
static void size_up(cdem_skin *s, box *whole) {
  double low[3], high[3], edge = 0.0;
  for (int c = 0; c < 3; c++) {
    low[c] = high[c] = s->reference[c];
    for (int32_t n = 1; n < s->nodes; n++) {
      low[c] = fmin(low[c], s->reference[3 * (int64_t)n + c]);
      high[c] = fmax(high[c], s->reference[3 * (int64_t)n + c]);
    }
    edge = fmax(edge, high[c] - low[c]);
  }
  edge = (edge + 2.0 * s->margin) * (1.0 + 0x1p-20); /* rounding */
  double triangle = sqrt(4.0 / sqrt(3.0) * s->total / s->triangles);
  s->cells = 8;
  while (s->cells < MOST_CELLS && edge / s->cells > 0.3 * triangle)
    s->cells *= 2;
  s->cell = edge / s->cells;
  whole->half = 0.5 * edge;
  for (int c = 0; c < 3; c++) {
    whole->center[c] = 0.5 * (low[c] + high[c]);
    s->low[c] = whole->center[c] - whole->half;
  }
}

enum { LEVELS = 8 };

static cdem_status fill_all(builder *b, box level[LEVELS], cdem_fault *fault) {
  static const int32_t origin[3] = {0, 0, 0};
  cdem_skin *s = b->s;
  CDEM_NEW(b->chosen, s->triangles, fault);
  CDEM_NEW(b->distance, s->triangles, fault);
  for (int l = 0; l < LEVELS; l++)
    CDEM_NEW(level[l].item, s->triangles, fault);
  for (int32_t t = 0; t < s->triangles; t++)
    level[0].item[t] = t;
  level[0].count = s->triangles;
  size_up(s, level);
  CDEM_NEW(s->list, (int64_t)s->cells * s->cells * s->cells, fault);
  CDEM_TRY(add_list(b, NULL, 0, fault));
  return fill_box(b, level, origin, s->cells, fault);
}

cdem_status cdem_skin_grid(cdem_skin *surface, cdem_fault *fault) {
  builder b = {.s = surface, .deep = 0.25 * surface->reach};
  box level[LEVELS] = {0};
  cdem_status status = fill_all(&b, level, fault);
  for (int l = 0; l < LEVELS; l++)
    free(level[l].item);
  free(b.chosen);
  free(b.distance);
  return status;
}
