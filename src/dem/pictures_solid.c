/* Spheres as seen from one side: those in front are found in a depth buffer and painted from back
 * to front, each as a disc with a rim and a lit side. */
#include "dem/pictures_kernels.h"

#include <stdlib.h>
#include <string.h>

enum { PIXELS = 900 };
#define SIDE_SHADE 0.80 /* brightness of the side away from the light */
#define FAR_SHADE  0.72 /* of what is furthest away */

typedef struct {
  double xy[2], depth;
  int64_t grain;
} seen;

static int back_to_front(const void *a, const void *b) {
  const seen *x = a, *y = b;
  if (x->depth != y->depth)
    return x->depth < y->depth ? 1 : -1;
  return (x->grain > y->grain) - (x->grain < y->grain);
}

typedef struct {
  const cdem_snapshot *s;
  double low[2], pixel;
  int count[2];
  double *depth;
  int32_t *owner; /* grain + 1 */
} buffer;

static void splat(const buffer *b, const seen *p) {
  double r = b->s->radius[p->grain];
  int from[2], to[2];
  for (int c = 0; c < 2; c++) {
    from[c] = (int)fmax(0.0, floor((p->xy[c] - r - b->low[c]) / b->pixel));
    to[c] = (int)fmin(b->count[c] - 1.0, floor((p->xy[c] + r - b->low[c]) / b->pixel));
  }
  for (int y = from[1]; y <= to[1]; y++)
    for (int x = from[0]; x <= to[0]; x++) {
      double dx = b->low[0] + (x + 0.5) * b->pixel - p->xy[0];
      double dy = b->low[1] + (y + 0.5) * b->pixel - p->xy[1], left = r * r - dx * dx - dy * dy;
      int64_t at = (int64_t)y * b->count[0] + x;
      if (left < 0.0 || (b->owner[at] > 0 && b->depth[at] <= p->depth - sqrt(left)))
        continue;
      b->depth[at] = p->depth - sqrt(left);
      b->owner[at] = (int32_t)p->grain + 1;
    }
}

/* Moves the grains that own a pixel to the front of the list; returns how many. */
static int64_t keep_owners(const buffer *b, seen *list, int64_t count, bool *owns) {
  int64_t kept = 0;
  for (int64_t k = 0; k < (int64_t)b->count[0] * b->count[1]; k++)
    if (b->owner[k] > 0)
      owns[b->owner[k] - 1] = true;
  for (int64_t i = 0; i < count; i++)
    if (owns[list[i].grain])
      list[kept++] = list[i];
  return kept;
}

static cdem_status find_front(const cdem_snapshot *s, seen *list, int64_t all, int64_t *count,
                              cdem_fault *fault) {
  buffer b = {.s = s};
  double high[2] = {0.0, 0.0};
  for (int64_t i = 0; i < all; i++)
    for (int c = 0; c < 2; c++) {
      double r = s->radius[list[i].grain];
      b.low[c] = i == 0 ? list[i].xy[c] - r : fmin(b.low[c], list[i].xy[c] - r);
      high[c] = i == 0 ? list[i].xy[c] + r : fmax(high[c], list[i].xy[c] + r);
    }
  b.pixel = fmax(high[0] - b.low[0], high[1] - b.low[1]) / PIXELS;
  *count = all;
  if (!(b.pixel > 0.0))
    return CDEM_OK;
  for (int c = 0; c < 2; c++)
    b.count[c] = (int)ceil((high[c] - b.low[c]) / b.pixel) + 1;
  int64_t pixels = (int64_t)b.count[0] * b.count[1];
  b.depth = cdem_allocate(pixels, sizeof *b.depth, fault);
  b.owner = b.depth != NULL ? cdem_allocate(pixels, sizeof *b.owner, fault) : NULL;
  bool *owns = b.owner != NULL ? cdem_allocate(s->grains, sizeof *owns, fault) : NULL;
  if (owns != NULL) {
    for (int64_t i = 0; i < all; i++)
      splat(&b, &list[i]);
    *count = keep_owners(&b, list, all, owns);
  }
  cdem_status status = owns != NULL ? CDEM_OK : CDEM_MEMORY;
  free(owns);
  free(b.depth);
  free(b.owner);
  return status;
}

/* Two marks a sphere: the whole one with its rim, and its lit side towards the upper left. */
static cdem_status put_spheres(const cdem_snapshot *s, const seen *list, int64_t count,
                               const double *value, cdem_map *map, cdem_fault *fault) {
  cdem_map_marks *discs;
  double nearest = INFINITY, furthest = -INFINITY;
  CDEM_TRY(cdem_map_add_marks(map, CDEM_MAP_DISCS, 2 * count, true, true, &discs, fault));
  discs->rims = false;
  for (int64_t k = 0; k < count; k++) {
    nearest = fmin(nearest, list[k].depth);
    furthest = fmax(furthest, list[k].depth);
  }
  for (int64_t k = 0; k < count; k++) {
    double r = s->radius[list[k].grain];
    double part = furthest > nearest ? (list[k].depth - nearest) / (furthest - nearest) : 0.0;
    double light = 1.0 - (1.0 - FAR_SHADE) * part;
    for (int lit = 0; lit < 2; lit++) {
      int64_t m = 2 * k + lit;
      discs->xy[4 * m] = list[k].xy[0] - (lit ? 0.20 * r : 0.0);
      discs->xy[4 * m + 1] = list[k].xy[1] + (lit ? 0.24 * r : 0.0);
      discs->size[m] = lit ? 0.62 * r : r;
      discs->shade[m] = light * (lit ? 1.0 : SIDE_SHADE);
      discs->value[m] = value[list[k].grain];
    }
  }
  return CDEM_OK;
}

cdem_status cdem_picture_spheres(const cdem_snapshot *s, const cdem_picture_eye *eye,
                                 const double *value, cdem_map *map, cdem_fault *fault) {
  seen *list;
  int64_t count, all = 0;
  CDEM_NEW(list, s->grains, fault);
  for (int64_t i = 0; i < s->grains; i++) {
    if (!cdem_picture_shows(eye, s->xyz + 3 * i))
      continue;
    list[all++] =
        (seen){{cdem_dot3(s->xyz + 3 * i, eye->right), cdem_dot3(s->xyz + 3 * i, eye->up)},
               cdem_dot3(s->xyz + 3 * i, eye->into),
               i};
  }
  cdem_status status = find_front(s, list, all, &count, fault);
  if (status == CDEM_OK) {
    qsort(list, (size_t)count, sizeof *list, back_to_front);
    status = put_spheres(s, list, count, value, map, fault);
  }
  free(list);
  return status;
}
