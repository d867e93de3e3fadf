/* The order in which flat convex faces are painted so that each covers those behind it.
 *
 * Two faces whose pictures overlap are compared at a point of the overlap: the one that is farther
 * there comes first. All such pairs, found on a grid, make a graph, and a depth-first walk through
 * it, begun in the order of middle depths, gives the order; a ring of faces that cover each other
 * is broken where the walk meets it. (The idea of ordering by overlapping pairs is Newell, Newell
 * and Sancha 1972, "A solution to the hidden surface problem".) */
#include "results/map_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 8 }; /* of two quadrilaterals' overlap */

/* Overlaps smaller than this part of the smaller face are those of neighbours. */
static const double least_overlap = 1e-3;

typedef struct {
  int32_t near, far;
} cover;

typedef struct {
  int64_t faces;
  const cdem_map_flat *face;
  int64_t covers, capacity;
  cover *cover;
  double low[2], cell[2]; /* of the grid */
  int64_t count[2];
} sorter;

static double area_of(const double (*xy)[2], int corners) {
  double area = 0.0;
  for (int i = 0; i < corners; i++) {
    const double *a = xy[i], *b = xy[(i + 1) % corners];
    area += 0.5 * ((a[0] - xy[0][0]) * (b[1] - xy[0][1]) - (a[1] - xy[0][1]) * (b[0] - xy[0][0]));
  }
  return area;
}

/* Keeps the part of a polygon on the left of the line from a to b (Sutherland and Hodgman 1974). */
static int cut(double (*xy)[2], int corners, const double a[2], const double b[2]) {
  double from[CORNERS][2], side[CORNERS];
  int kept = 0;
  memcpy(from, xy, (size_t)corners * sizeof from[0]);
  for (int i = 0; i < corners; i++)
    side[i] = (b[0] - a[0]) * (from[i][1] - a[1]) - (b[1] - a[1]) * (from[i][0] - a[0]);
  for (int i = 0; i < corners; i++) {
    int next = (i + 1) % corners;
    if (side[i] >= 0.0 && kept < CORNERS)
      memcpy(xy[kept++], from[i], sizeof from[i]);
    if (side[i] * side[next] < 0.0 && kept < CORNERS) {
      double t = side[i] / (side[i] - side[next]);
      for (int c = 0; c < 2; c++)
        xy[kept][c] = from[i][c] + t * (from[next][c] - from[i][c]);
      kept++;
    }
  }
  return kept;
}

/* The middle of the overlap of two faces; false when they do not overlap. */
static bool overlap(const cdem_map_flat *p, const cdem_map_flat *q, double middle[2]) {
  double xy[CORNERS][2], area_p = area_of(p->xy, p->corners), area_q = area_of(q->xy, q->corners);
  int corners = p->corners;
  memcpy(xy, p->xy, sizeof p->xy);
  for (int i = 0; i < q->corners && corners > 0; i++) {
    const double *a = q->xy[i], *b = q->xy[(i + 1) % q->corners];
    corners = cut(xy, corners, area_q > 0.0 ? a : b, area_q > 0.0 ? b : a);
  }
  if (corners < 3 || !(fabs(area_of((const double(*)[2])xy, corners)) >
                       least_overlap * fmin(fabs(area_p), fabs(area_q))))
    return false;
  middle[0] = middle[1] = 0.0;
  for (int i = 0; i < corners; i++)
    for (int c = 0; c < 2; c++)
      middle[c] += xy[i][c] / corners;
  return true;
}

/* Depth of a face's plane at a place of the picture. */
static double depth_at(const cdem_map_flat *face, const double at[2]) {
  return face->plane[0] + face->plane[1] * at[0] + face->plane[2] * at[1];
}

static cdem_status compare(sorter *s, int32_t i, int32_t j, cdem_fault *fault) {
  const cdem_map_flat *p = &s->face[i], *q = &s->face[j];
  double at[2];
  for (int c = 0; c < 2; c++)
    if (p->high[c] <= q->low[c] || q->high[c] <= p->low[c])
      return CDEM_OK;
  if (!overlap(p, q, at))
    return CDEM_OK;
  double farther = depth_at(p, at) - depth_at(q, at);
  CDEM_TRY(cdem_grow(&s->cover, &s->capacity, s->covers + 1, sizeof *s->cover, fault));
  s->cover[s->covers++] = farther > 0.0 ? (cover){j, i} : (cover){i, j};
  return CDEM_OK;
}

/* ---- pairs on a grid ---- */

static int64_t place(const sorter *s, double value, int c) {
  int64_t at = (int64_t)((value - s->low[c]) / s->cell[c]);
  return at < 0 ? 0 : at < s->count[c] ? at : s->count[c] - 1;
}

static void make_grid(sorter *s) {
  double high[2] = {-INFINITY, -INFINITY}, size[2] = {0.0, 0.0};
  s->low[0] = s->low[1] = INFINITY;
  for (int64_t i = 0; i < s->faces; i++)
    for (int c = 0; c < 2; c++) {
      s->low[c] = fmin(s->low[c], s->face[i].low[c]);
      high[c] = fmax(high[c], s->face[i].high[c]);
      size[c] += (s->face[i].high[c] - s->face[i].low[c]) / (double)s->faces;
    }
  for (int c = 0; c < 2; c++) {
    double extent = high[c] - s->low[c], most = ceil(sqrt((double)s->faces));
    s->count[c] = size[c] > 0.0 ? (int64_t)fmin(most, fmax(1.0, extent / size[c])) : 1;
    s->cell[c] = extent > 0.0 ? extent / (double)s->count[c] : 1.0;
  }
}

/* Walks over the grid cells that a face touches: counts them, or (list) files the face. */
static void file_face(const sorter *s, int32_t i, int64_t *start, int32_t *list) {
  const cdem_map_flat *face = &s->face[i];
  for (int64_t y = place(s, face->low[1], 1); y <= place(s, face->high[1], 1); y++)
    for (int64_t x = place(s, face->low[0], 0); x <= place(s, face->high[0], 0); x++) {
      int64_t at = y * s->count[0] + x;
      if (list == NULL)
        start[at + 1]++;
      else
        list[start[at]++] = i;
    }
}

/* A pair that meets in several grid cells is compared in the first of them only. */
static bool first_meeting(const sorter *s, int32_t i, int32_t j, int64_t at) {
  const cdem_map_flat *p = &s->face[i], *q = &s->face[j];
  int64_t x = place(s, fmax(p->low[0], q->low[0]), 0);
  return at == place(s, fmax(p->low[1], q->low[1]), 1) * s->count[0] + x;
}

static cdem_status compare_all(sorter *s, const int64_t *start, const int32_t *list,
                               cdem_fault *fault) {
  for (int64_t at = 0; at < s->count[0] * s->count[1]; at++)
    for (int64_t a = at > 0 ? start[at - 1] : 0; a < start[at]; a++)
      for (int64_t b = a + 1; b < start[at]; b++)
        if (first_meeting(s, list[a], list[b], at))
          CDEM_TRY(compare(s, list[a], list[b], fault));
  return CDEM_OK;
}

static cdem_status find_covers(sorter *s, cdem_fault *fault) {
  make_grid(s);
  int64_t cells = s->count[0] * s->count[1], *start;
  CDEM_NEW(start, cells + 1, fault);
  for (int64_t i = 0; i < s->faces; i++)
    file_face(s, (int32_t)i, start, NULL);
  for (int64_t c = 0; c < cells; c++)
    start[c + 1] += start[c];
  int32_t *list = cdem_allocate(start[cells], sizeof *list, fault);
  cdem_status status = list != NULL ? CDEM_OK : CDEM_MEMORY;
  /* Filing moves each start to its end, which is where the next begins. */
  for (int64_t i = 0; i < s->faces && status == CDEM_OK; i++)
    file_face(s, (int32_t)i, start, list);
  if (status == CDEM_OK)
    status = compare_all(s, start, list, fault);
  free(list);
  free(start);
  return status;
}

/* ---- the walk ---- */

typedef struct {
  int64_t *next, *end; /* [faces] into behind: what is still to be looked at */
  int32_t *behind, *stack;
  bool *met;
} walk;

static cdem_status make_walk(const sorter *s, walk *w, cdem_fault *fault) {
  CDEM_NEW(w->next, s->faces + 1, fault);
  CDEM_NEW(w->end, s->faces, fault);
  CDEM_NEW(w->behind, s->covers, fault);
  CDEM_NEW(w->stack, s->faces, fault);
  CDEM_NEW(w->met, s->faces, fault);
  for (int64_t c = 0; c < s->covers; c++)
    w->next[s->cover[c].near + 1]++;
  for (int64_t i = 0; i < s->faces; i++)
    w->next[i + 1] += w->next[i];
  memcpy(w->end, w->next, (size_t)s->faces * sizeof *w->end);
  for (int64_t c = 0; c < s->covers; c++)
    w->behind[w->end[s->cover[c].near]++] = s->cover[c].far;
  return CDEM_OK;
}

static void free_walk(walk *w) {
  free(w->next);
  free(w->end);
  free(w->behind);
  free(w->stack);
  free(w->met);
}

/* Paints what is behind a face, then the face. */
static void visit(walk *w, int32_t face, int32_t *order, int64_t *painted) {
  int64_t height = 0;
  w->stack[height++] = face;
  w->met[face] = true;
  while (height > 0) {
    int32_t top = w->stack[height - 1];
    if (w->next[top] == w->end[top]) {
      order[(*painted)++] = top;
      height--;
      continue;
    }
    int32_t other = w->behind[w->next[top]++];
    if (!w->met[other]) {
      w->met[other] = true;
      w->stack[height++] = other;
    }
  }
}

cdem_status cdem_map_order(int64_t faces, const cdem_map_flat *face, int32_t *order,
                           cdem_fault *fault) {
  sorter s = {.faces = faces, .face = face};
  walk w = {NULL, NULL, NULL, NULL, NULL};
  CDEM_REQUIRE(faces <= INT32_MAX, fault, CDEM_INPUT,
               "a map of %lld polygons cannot be drawn; at most %d can", (long long)faces,
               INT32_MAX);
  cdem_status status = faces > 0 ? find_covers(&s, fault) : CDEM_OK;
  if (status == CDEM_OK)
    status = make_walk(&s, &w, fault);
  int64_t painted = 0;
  for (int64_t i = 0; i < faces && status == CDEM_OK; i++)
    if (!w.met[i])
      visit(&w, (int32_t)i, order, &painted);
  free_walk(&w);
  free(s.cover);
  return status;
}
