/* Which grains are near which nodes of the membrane.
 *
 * A node is a candidate of every grain that it could touch before both have moved by the skin, the
 * grain deformed by as much as its surface has room for (`margin`); twice the skin, since rows of a
 * restored specimen are made when a part of that way is done. Grains are looked for in a window of
 * heights. */
#include "base/sort.h"
#include "fdem/confine.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  double z;
  int32_t grain;
} level;

static int by_height(const void *a, const void *b) {
  const level *p = a, *q = b;
  if (p->z != q->z)
    return p->z < q->z ? -1 : 1;
  return p->grain < q->grain ? -1 : p->grain > q->grain;
}

static int by_grain(const void *a, const void *b) {
  const cdem_fdem_membrane_touch *p = a, *q = b;
  return p->grain < q->grain ? -1 : p->grain > q->grain;
}

static double reach_of(const cdem_fdem_store *s, int64_t g) {
  return s->radius[g] * (s->surface[g]->reach + s->surface[g]->margin);
}

/* First level at or above z. */
static int64_t first_above(const level *sorted, int64_t count, double z) {
  int64_t low = 0, high = count;
  while (low < high) {
    int64_t middle = (low + high) / 2;
    if (sorted[middle].z < z)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static cdem_status find_row(const cdem_fdem_store *s, struct cdem_fdem_confine *b,
                            const level *sorted, double window, int32_t node, int64_t *count,
                            cdem_fault *fault) {
  const double *x = b->host.membrane.x + 3 * (int64_t)node;
  int64_t from = *count;
  for (int64_t k = first_above(sorted, s->grains, x[2] - window);
       k < s->grains && sorted[k].z <= x[2] + window; k++) {
    const double *center = s->center + 3 * (int64_t)sorted[k].grain;
    double d[3] = {x[0] - center[0], x[1] - center[1], x[2] - center[2]};
    double near = reach_of(s, sorted[k].grain) + 2.0 * b->skin;
    if (cdem_dot3(d, d) > near * near)
      continue;
    CDEM_TRY(cdem_grow(&b->touch, &b->capacity[0], *count + 1, sizeof *b->touch, fault));
    b->touch[(*count)++] = (cdem_fdem_membrane_touch){.grain = sorted[k].grain, .node = node};
  }
  cdem_sort(b->touch + from, *count - from, sizeof *b->touch, by_grain);
  return CDEM_OK;
}

/* The same by grain. */
static cdem_status transpose(const cdem_fdem_store *s, struct cdem_fdem_confine *b,
                             cdem_fault *fault) {
  int64_t count = b->row[b->host.membrane.nodes];
  CDEM_TRY(cdem_grow(&b->of_grain, &b->capacity[1], count, sizeof *b->of_grain, fault));
  memset(b->grain_row, 0, (size_t)(s->grains + 1) * sizeof *b->grain_row);
  for (int64_t k = 0; k < count; k++)
    b->grain_row[b->touch[k].grain + 1]++;
  for (int64_t g = 0; g < s->grains; g++)
    b->grain_row[g + 1] += b->grain_row[g];
  for (int64_t k = count - 1; k >= 0; k--)
    b->of_grain[--b->grain_row[b->touch[k].grain + 1]] = k;
  /* Counting down has left each end at its beginning. */
  for (int64_t g = 0; g < s->grains; g++)
    b->grain_row[g] = b->grain_row[g + 1];
  b->grain_row[s->grains] = count;
  return CDEM_OK;
}

/* From the axis. */
static double distance(const cdem_membrane *m, const double x[3]) {
  double d[2] = {x[0] - m->options.center[0], x[1] - m->options.center[1]};
  return sqrt(d[0] * d[0] + d[1] * d[1]);
}

/* How far out the membrane is where it stands before a centre: at the node that comes nearest to it
 * when all go along their radii to its distance from the axis. (The nearest one in space may be in
 * a gap beside a grain and deeper than its centre.) */
static double room_before(const cdem_membrane *m, const double center[3], double out) {
  const double *axis = m->options.center;
  double least = INFINITY, room = INFINITY;
  for (int32_t i = 0; i < m->nodes; i++) {
    const double *x = m->x + 3 * (int64_t)i;
    double far = distance(m, x);
    double part = far > 0.0 ? out / far : 0.0, d[3] = {0.0, 0.0, x[2] - center[2]};
    for (int c = 0; c < 2; c++)
      d[c] = part * (x[c] - axis[c]) - (center[c] - axis[c]);
    double square = cdem_dot3(d, d);
    room = square < least ? far : room;
    least = fmin(least, square);
  }
  return room;
}

/* A centre beyond the membrane has left the specimen. */
static cdem_status check_inside(const cdem_fdem *fdem, cdem_fault *fault) {
  const cdem_fdem_store *s = fdem->store;
  const cdem_membrane *m = &s->confine->host.membrane;
  double least = INFINITY;
  for (int32_t i = 0; i < m->nodes; i++)
    least = fmin(least, distance(m, m->x + 3 * (int64_t)i));
  for (int64_t g = 0; g < s->grains; g++) {
    const double *center = s->center + 3 * g;
    double out = distance(m, center);
    CDEM_REQUIRE(out <= least || out <= room_before(m, center, out), fault, CDEM_NUMERIC,
                 "grain %lld has left the specimen through the membrane at t = %.6g s, at (%.4g, "
                 "%.4g, %.4g m); take a finer membrane or a larger `penalty` of it",
                 (long long)g, fdem->time, center[0], center[1], center[2]);
  }
  return CDEM_OK;
}

static cdem_status build(cdem_fdem *fdem, level *sorted, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  int64_t count = 0;
  double window = 0.0;
  for (int64_t g = 0; g < s->grains; g++) {
    sorted[g] = (level){s->center[3 * g + 2], (int32_t)g};
    window = fmax(window, reach_of(s, g) + 2.0 * b->skin);
  }
  cdem_sort(sorted, s->grains, sizeof *sorted, by_height);
  for (int32_t i = 0; i < b->host.membrane.nodes; i++) {
    b->row[i] = count;
    CDEM_TRY(find_row(s, b, sorted, window, i, &count, fault));
  }
  b->row[b->host.membrane.nodes] = count;
  CDEM_TRY(transpose(s, b, fault));
  memcpy(b->built, s->center, (size_t)(3 * s->grains) * sizeof *s->center);
  cdem_membrane_mark(&b->host.membrane);
  b->host.moved = 0.0;
  return check_inside(fdem, fault);
}

cdem_status cdem_fdem_confine_lists(cdem_fdem *fdem, bool always, cdem_fault *fault) {
  const cdem_fdem_store *s = fdem->store;
  const struct cdem_fdem_confine *b = s->confine;
  double most = 0.0;
  for (int64_t g = 0; g < s->grains; g++) {
    double d[3];
    for (int c = 0; c < 3; c++)
      d[c] = s->center[3 * g + c] - b->built[3 * g + c];
    most = fmax(most, cdem_dot3(d, d));
  }
  if (!always && b->host.moved + sqrt(most) < b->skin)
    return CDEM_OK;
  level *sorted = cdem_allocate(s->grains, sizeof *sorted, fault);
  cdem_status status = sorted != NULL ? build(fdem, sorted, fault) : CDEM_MEMORY;
  free(sorted);
  return status;
}
