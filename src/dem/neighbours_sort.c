/* Neighbours: the order of grains in space.
 *
 * Cells as large as a mean grain stand in columns along the longest axis of the box, whose cross
 * section is such that CDEM_CHUNK consecutive grains fill a cube (a square in 2-D and in thin
 * layers). Columns are as wide as each other and run to and fro. So each run of CDEM_CHUNK grains
 * is a brick wherever it starts, which Hilbert's and Morton's curves give only for powers of 8
 * (docs/rooms/dem-neighbours.md has the comparison).
 */
#include "dem/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RADIX_BITS = 11, RADIX = 1 << RADIX_BITS };
static const double most_cells = 0x1p18; /* along an axis */

typedef struct {
  int axis[3]; /* along the columns, across them */
  double origin[3], size, shift[3];
  int64_t cells[3];
  int64_t columns[2], depth[2]; /* across: columns, most cells of a column */
} sort_grid;

void cdem_neighbours_merge_sort(int32_t *index, int32_t *spare, int64_t count,
                                cdem_neighbours_less *less, const void *context) {
  if (count <= 12) {
    for (int64_t i = 1; i < count; i++) {
      int32_t moving = index[i];
      int64_t to = i;
      for (; to > 0 && less(context, moving, index[to - 1]); to--)
        index[to] = index[to - 1];
      index[to] = moving;
    }
    return;
  }
  int64_t half = count / 2;
  cdem_neighbours_merge_sort(index, spare, half, less, context);
  cdem_neighbours_merge_sort(index + half, spare, count - half, less, context);
  if (!less(context, index[half], index[half - 1]))
    return;
  memcpy(spare, index, (size_t)half * sizeof *index);
  int64_t left = 0, right = half, to = 0;
  while (left < half)
    index[to++] =
        right < count && less(context, index[right], spare[left]) ? index[right++] : spare[left++];
}

void cdem_neighbours_box(const cdem_dem_store *s, double low[3], double high[3]) {
  for (int c = 0; c < 3; c++) {
    low[c] = INFINITY;
    high[c] = -INFINITY;
  }
  for (int64_t i = 0; i < s->grains; i++) {
    const double *place = cdem_place(s, i);
    for (int c = 0; c < 3; c++) {
      low[c] = place[c] < low[c] ? place[c] : low[c];
      high[c] = place[c] > high[c] ? place[c] : high[c];
    }
  }
}

/* Hoare's selection of the middle one. */
static double median(double *value, int64_t count) {
  int64_t low = 0, high = count - 1, middle = count / 2;
  while (low < high) {
    double pivot = value[low + (high - low) / 2];
    int64_t i = low, j = high;
    while (i <= j) {
      while (value[i] < pivot)
        i++;
      while (pivot < value[j])
        j--;
      if (i <= j) {
        double swap = value[i];
        value[i++] = value[j];
        value[j--] = swap;
      }
    }
    if (j < middle)
      low = i;
    if (middle < i)
      high = j;
  }
  return value[middle];
}

bool cdem_neighbours_origin(const cdem_dem_store *s, int axis, const double box[2],
                            const double cells[2], double *spare, double *origin) {
  *origin = box[0];
  if ((box[1] - box[0]) / cells[0] < cells[1])
    return true;
  for (int64_t i = 0; i < s->grains; i++)
    spare[i] = cdem_place(s, i)[axis];
  *origin = median(spare, s->grains);
  return false;
}

/* Edge of the cube (square) that holds one mean grain without gaps. A mean that does not depend on
 * the order of the sum: of integers. */
static double mean_size(const cdem_dem_store *s) {
  double largest = 0.0;
  for (int64_t i = 0; i < s->grains; i++)
    largest = fmax(largest, cdem_place(s, i)[3]);
  int64_t sum = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    double part = cdem_place(s, i)[3] / largest;
    sum += (int64_t)((s->dim == 2 ? part * part : part * part * part) * 0x1p31) + 1;
  }
  double mean = (double)sum / ((double)s->grains * 0x1p31);
  return 2.0 * largest * (s->dim == 2 ? sqrt(mean) : cbrt(mean));
}

static void set_columns(const cdem_dem_store *s, sort_grid *g) {
  /* Cells of a chunk: discs fill about 0.84 of the plane, spheres 0.6 of the space. */
  double chunk = CDEM_CHUNK * (s->dim == 2 ? 0.935 : 0.87);
  double wide = s->dim == 2 ? 1.0 : cbrt(chunk);
  int thin = g->cells[1] < g->cells[2] ? 0 : 1;
  for (int k = 0; k < 2; k++) {
    int across = k == 0 ? thin : 1 - thin;
    double cells = (double)g->cells[1 + across];
    if (k == 1)
      wide = sqrt(chunk / ((double)g->cells[1 + thin] / (double)g->columns[thin]));
    g->columns[across] = (int64_t)fmax(1.0, round(cells / wide));
    g->depth[across] = (g->cells[1 + across] + g->columns[across] - 1) / g->columns[across];
  }
}

static cdem_status set_grid(const cdem_dem_store *s, sort_grid *g, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  double low[3], high[3], origin[3], shift[3];
  int64_t cells[3];
  cdem_neighbours_box(s, low, high);
  CDEM_TRY(
      cdem_neighbours_room(&n->sort_key, &n->capacity[7], s->grains, sizeof *n->sort_key, fault));
  g->size = mean_size(s);
  int along = 0;
  for (int c = 0; c < 3; c++) {
    double box[2] = {low[c], high[c]}, limit[2] = {g->size, most_cells};
    bool corner = cdem_neighbours_origin(s, c, box, limit, n->sort_key, &origin[c]);
    shift[c] = corner ? 0.0 : 0.5 * most_cells;
    cells[c] = corner ? (int64_t)((high[c] - low[c]) / g->size) + 1 : (int64_t)most_cells;
    along = cells[c] > cells[along] ? c : along;
  }
  for (int k = 0; k < 3; k++) {
    int c = (along + k) % 3;
    g->axis[k] = c;
    g->origin[k] = origin[c];
    g->shift[k] = shift[c];
    g->cells[k] = cells[c];
  }
  set_columns(s, g);
  return CDEM_OK;
}

static inline int64_t sort_cell(const sort_grid *g, int k, const double *place) {
  double part = (place[g->axis[k]] - g->origin[k]) / g->size + g->shift[k];
  double last = (double)(g->cells[k] - 1);
  return (int64_t)(part > 0.0 ? part < last ? part : last : 0.0);
}

/* First cell of a column, such that columns differ by one cell at most. */
static inline int64_t column_start(const sort_grid *g, int across, int64_t column) {
  int64_t columns = g->columns[across];
  return (g->cells[1 + across] * column + columns - 1) / columns;
}

static uint64_t sort_key(const sort_grid *g, const double *place) {
  int64_t along = sort_cell(g, 0, place), column[2], in[2];
  for (int k = 0; k < 2; k++) {
    int64_t cell = sort_cell(g, 1 + k, place);
    column[k] = cell * g->columns[k] / g->cells[1 + k];
    in[k] = cell - column_start(g, k, column[k]);
  }
  if (column[1] % 2 != 0)
    column[0] = g->columns[0] - 1 - column[0];
  int64_t number = column[1] * g->columns[0] + column[0];
  if (number % 2 != 0)
    along = g->cells[0] - 1 - along;
  return (uint64_t)(((number * g->cells[0] + along) * g->depth[0] + in[0]) * g->depth[1] + in[1]);
}

static int compare(double a, double b) {
  return (a > b) - (a < b);
}

/* All that a grain is but its id. */
static bool grain_less(const void *context, int32_t a, int32_t b) {
  const cdem_dem_store *s = context;
  int order = 0;
  for (int k = 0; k < 4 && order == 0; k++)
    order = compare(cdem_place(s, a)[k], cdem_place(s, b)[k]);
  if (order == 0 && s->kind != NULL)
    order = compare(s->kind[a], s->kind[b]);
  if (order == 0 && s->material != NULL)
    order = compare(s->material[a], s->material[b]);
  for (int k = 0; k < 7 && order == 0; k++)
    order = compare(cdem_motion(s, a)[k], cdem_motion(s, b)[k]);
  for (int k = 0; k < 6 && order == 0 && s->travel != NULL; k++)
    order = compare(s->travel[8 * (int64_t)a + k], s->travel[8 * (int64_t)b + k]);
  return order < 0;
}

static void radix_sort(struct cdem_neighbours *n, int32_t *order, int64_t count, uint64_t most) {
  for (int shift = 0; shift < 64 && most >> shift != 0; shift += RADIX_BITS) {
    int64_t start[RADIX + 1] = {0};
    for (int64_t i = 0; i < count; i++)
      start[(n->key[i] >> shift) % RADIX + 1]++;
    for (int k = 0; k < RADIX; k++)
      start[k + 1] += start[k];
    for (int64_t i = 0; i < count; i++) {
      int64_t to = start[(n->key[i] >> shift) % RADIX]++;
      n->key_spare[to] = n->key[i];
      n->order_spare[to] = order[i];
    }
    memcpy(n->key, n->key_spare, (size_t)count * sizeof *n->key);
    memcpy(order, n->order_spare, (size_t)count * sizeof *order);
  }
}

cdem_status cdem_neighbours_order(const cdem_dem_store *s, int32_t *order, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  int64_t grains = s->grains, *room = n->capacity;
  if (grains == 0)
    return CDEM_OK;
  CDEM_TRY(cdem_neighbours_room(&n->key, &room[0], grains, sizeof *n->key, fault));
  CDEM_TRY(cdem_neighbours_room(&n->key_spare, &room[1], grains, sizeof *n->key_spare, fault));
  CDEM_TRY(cdem_neighbours_room(&n->order_spare, &room[2], grains, sizeof *n->order_spare, fault));
  sort_grid grid;
  CDEM_TRY(set_grid(s, &grid, fault));
  uint64_t most = 0;
  for (int64_t i = 0; i < grains; i++) {
    order[i] = (int32_t)i;
    n->key[i] = sort_key(&grid, cdem_place(s, i));
    most = n->key[i] > most ? n->key[i] : most;
  }
  radix_sort(n, order, grains, most);
  for (int64_t i = 0, end; i < grains; i = end) {
    for (end = i + 1; end < grains && n->key[end] == n->key[i]; end++)
      ;
    if (end - i > 1)
      cdem_neighbours_merge_sort(order + i, n->order_spare, end - i, grain_less, s);
  }
  return CDEM_OK;
}

static void permute(char *data, char *spare, size_t size, const int32_t *order, int64_t grains) {
  for (int64_t i = 0; i < grains; i++)
    memcpy(spare + (size_t)i * size, data + (size_t)order[i] * size, size);
  memcpy(data, spare, (size_t)grains * size);
}

cdem_status cdem_neighbours_permute(cdem_dem_store *s, const int32_t *order, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  size_t largest = 1;
  for (int k = 0; k < s->sorted; k++)
    largest = s->sort[k].size > largest ? s->sort[k].size : largest;
  CDEM_TRY(
      cdem_neighbours_room(&n->permuted, &n->capacity[3], s->grains * (int64_t)largest, 1, fault));
  for (int k = 0; k < s->sorted; k++) {
    char *data;
    memcpy(&data, s->sort[k].address, sizeof data);
    if (data == NULL)
      continue;
    switch (s->sort[k].size) {
    case 1:
      permute(data, n->permuted, 1, order, s->grains);
      break;
    case 4:
      permute(data, n->permuted, 4, order, s->grains);
      break;
    case 32:
      permute(data, n->permuted, 32, order, s->grains);
      break;
    case 64:
      permute(data, n->permuted, 64, order, s->grains);
      break;
    default:
      permute(data, n->permuted, s->sort[k].size, order, s->grains);
    }
  }
  for (int32_t i = 0; i < s->grains; i++)
    s->slot[s->id[i]] = i;
  return CDEM_OK;
}
