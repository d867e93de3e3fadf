/* Which grains are near which nodes of the membrane. */
#include "dem/confine.h"

#include <math.h>
#include <string.h>

/* A grid over the grains: cells as wide as a node can see, wider where they would be many. */
typedef struct {
  double low[3], width;
  int32_t count[3];
} grid;

static void make_grid(const cdem_dem_store *s, double reach, grid *g) {
  double high[3], room = 8.0 * (double)s->grains + 64.0, cells = INFINITY;
  for (int c = 0; c < 3; c++) {
    g->low[c] = INFINITY;
    high[c] = -INFINITY;
  }
  for (int32_t i = 0; i < s->grains; i++)
    for (int c = 0; c < 3; c++) {
      g->low[c] = fmin(g->low[c], cdem_place(s, i)[c]);
      high[c] = fmax(high[c], cdem_place(s, i)[c]);
    }
  for (g->width = reach; cells > room; g->width *= 2.0) {
    cells = 1.0;
    for (int c = 0; c < 3; c++)
      cells *= floor((high[c] - g->low[c]) / g->width) + 1.0;
    if (cells <= room)
      break;
  }
  for (int c = 0; c < 3; c++)
    g->count[c] = (int32_t)floor((high[c] - g->low[c]) / g->width) + 1;
}

/* Cell of a place along an axis, -1 .. count outside. */
static int32_t along(const grid *g, const double *x, int c) {
  double at = floor((x[c] - g->low[c]) / g->width);
  return at < -1.0 ? -2 : at > g->count[c] ? g->count[c] + 1 : (int32_t)at;
}

static int64_t cell_of(const grid *g, const double *x) {
  int64_t at[3];
  for (int c = 0; c < 3; c++) {
    int32_t k = along(g, x, c);
    at[c] = k < 0 ? 0 : k >= g->count[c] ? g->count[c] - 1 : k;
  }
  return (at[2] * g->count[1] + at[1]) * g->count[0] + at[0];
}

/* Counting sort: grains of a cell ascend. */
static cdem_status fill_grid(cdem_dem_store *s, struct cdem_confine *b, const grid *g,
                             cdem_fault *fault) {
  int64_t cells = (int64_t)g->count[0] * g->count[1] * g->count[2];
  CDEM_TRY(cdem_grow(&b->cell, &b->capacity[0], cells + 2, sizeof *b->cell, fault));
  CDEM_TRY(cdem_grow(&b->cell_grain, &b->capacity[1], s->grains, sizeof *b->cell_grain, fault));
  memset(b->cell, 0, (size_t)(cells + 2) * sizeof *b->cell);
  for (int32_t i = 0; i < s->grains; i++)
    b->cell[cell_of(g, cdem_place(s, i)) + 2]++;
  for (int64_t k = 2; k < cells + 2; k++)
    b->cell[k] += b->cell[k - 1];
  for (int32_t i = 0; i < s->grains; i++)
    b->cell_grain[b->cell[cell_of(g, cdem_place(s, i)) + 1]++] = i;
  return CDEM_OK;
}

static bool is_near(const double *grain, const double *x, double skin) {
  double d2 = 0.0, reach = grain[3] + skin;
  for (int c = 0; c < 3; c++)
    d2 += (grain[c] - x[c]) * (grain[c] - x[c]);
  return d2 < reach * reach;
}

static void sort_row(int32_t *row, int64_t count) {
  for (int64_t k = 1; k < count; k++) {
    int32_t value = row[k];
    int64_t j = k;
    for (; j > 0 && row[j - 1] > value; j--)
      row[j] = row[j - 1];
    row[j] = value;
  }
}

/* Candidates of one node behind those there are. */
static cdem_status node_row(const cdem_dem_store *s, struct cdem_confine *b, const grid *g,
                            int32_t node, cdem_fault *fault) {
  const double *x = b->host.membrane.x + 3 * (int64_t)node;
  int64_t first = b->row[node], count = first;
  int32_t from[3], to[3];
  for (int c = 0; c < 3; c++) {
    int32_t at = along(g, x, c);
    from[c] = at - 1 < 0 ? 0 : at - 1;
    to[c] = at + 1 >= g->count[c] ? g->count[c] - 1 : at + 1;
  }
  for (int32_t k = from[2]; k <= to[2]; k++)
    for (int32_t j = from[1]; j <= to[1]; j++)
      for (int32_t i = from[0]; i <= to[0]; i++) {
        int64_t cell = ((int64_t)k * g->count[1] + j) * g->count[0] + i;
        for (int32_t at = b->cell[cell]; at < b->cell[cell + 1]; at++) {
          int32_t grain = b->cell_grain[at];
          if (!is_near(cdem_place(s, grain), x, s->skin))
            continue;
          CDEM_TRY(cdem_grow(&b->grain, &b->capacity[2], count + 1, sizeof *b->grain, fault));
          b->grain[count++] = grain;
        }
      }
  if (count > first)
    sort_row(b->grain + first, count - first);
  b->row[node + 1] = count;
  return CDEM_OK;
}

/* The same candidates by grain. */
static cdem_status transpose(const cdem_dem_store *s, struct cdem_confine *b, cdem_fault *fault) {
  int64_t count = b->row[b->host.membrane.nodes];
  CDEM_TRY(cdem_grow(&b->push, &b->capacity[3], count + 1, 3 * sizeof *b->push, fault));
  CDEM_TRY(cdem_grow(&b->entry, &b->capacity[4], count + 1, sizeof *b->entry, fault));
  CDEM_TRY(cdem_grow(&b->cell, &b->capacity[0], s->grains + 1, sizeof *b->cell, fault));
  CDEM_TRY(cdem_grow(&b->of, &b->capacity[5], s->grains + 1, sizeof *b->of, fault));
  CDEM_TRY(
      cdem_grow(&b->entry_start, &b->capacity[6], s->grains + 2, sizeof *b->entry_start, fault));
  int32_t *number = b->cell; /* of candidates of each grain, then its place in `of` */
  memset(number, 0, (size_t)s->grains * sizeof *number);
  for (int64_t k = 0; k < count; k++)
    number[b->grain[k]]++;
  b->held = 0;
  b->entry_start[0] = 0;
  for (int32_t i = 0; i < s->grains; i++) {
    if (number[i] == 0)
      continue;
    b->of[b->held] = i;
    b->entry_start[b->held + 1] = b->entry_start[b->held] + number[i];
    number[i] = b->held++;
  }
  for (int64_t k = 0; k < count; k++)
    b->entry[b->entry_start[number[b->grain[k]]]++] = k;
  for (int32_t h = b->held; h > 0; h--)
    b->entry_start[h] = b->entry_start[h - 1];
  b->entry_start[0] = 0;
  return CDEM_OK;
}

/* A node that a grain pushes inwards has the grain on its outer side. Half, since the membrane may
 * lie slantwise over a grain. */
static cdem_status check_inside(const cdem_dem *dem, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  const struct cdem_confine *b = s->core->confine;
  for (int32_t i = 0; i < b->host.membrane.nodes; i++)
    for (int64_t k = b->row[i]; k < b->row[i + 1]; k++) {
      double n[3], normal[3];
      const double *x = cdem_place(s, b->grain[k]);
      if (cdem_confine_overlap(x, b->host.membrane.x + 3 * (int64_t)i, n) <= 0.0)
        continue;
      cdem_membrane_normal(&b->host.membrane, i, normal);
      CDEM_REQUIRE(
          cdem_dot3(n, normal) >= -0.5 * cdem_norm3(normal), fault, CDEM_NUMERIC,
          "grain %d at (%.4g, %.4g, %.4g m) is outside of the membrane at t = %.6g s: take "
          "a narrower spacing of its nodes than %.4g m or a larger penalty",
          s->id[b->grain[k]], x[0], x[1], x[2], dem->time, b->host.membrane.spacing);
    }
  return CDEM_OK;
}

cdem_status cdem_confine_build(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  struct cdem_confine *b = s->core->confine;
  double largest = 0.0;
  grid g;
  if (!b->host.flexible)
    return CDEM_OK;
  for (int32_t i = 0; i < s->grains; i++)
    largest = fmax(largest, cdem_place(s, i)[3]);
  make_grid(s, largest + s->skin, &g);
  CDEM_TRY(fill_grid(s, b, &g, fault));
  for (int32_t i = 0; i < b->host.membrane.nodes; i++)
    CDEM_TRY(node_row(s, b, &g, i, fault));
  CDEM_TRY(transpose(s, b, fault));
  cdem_membrane_mark(&b->host.membrane);
  b->host.moved = 0.0;
  return check_inside(dem, fault);
}
