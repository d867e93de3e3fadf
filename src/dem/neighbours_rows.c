/* Neighbours: points of each level in rows, sorted along them. */
#include "dem/neighbours.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static const double most_cells = 0x1p24; /* along an axis, with the origin in the corner */

/* Longest axis along the rows. */
static cdem_status set_axes(cdem_dem_store *s, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  double low[3], high[3], least = n->level[n->levels - 1].size;
  cdem_neighbours_box(s, low, high);
  CDEM_TRY(
      cdem_neighbours_room(&n->sort_key, &n->capacity[7], n->points, sizeof *n->sort_key, fault));
  int along = 0;
  for (int c = 0; c < 3; c++) {
    double box[2] = {low[c], high[c]}, limit[2] = {least, most_cells};
    cdem_neighbours_origin(s, c, box, limit, n->sort_key, &n->origin[c]);
    along = high[c] - low[c] > high[along] - low[along] ? c : along;
  }
  for (int k = 0; k < 3; k++)
    n->axis[k] = (along + k) % 3;
  n->clamp = 0x1p30 * least;
  return CDEM_OK;
}

int64_t cdem_neighbours_row_number(const cdem_neighbour_level *level, double from_origin) {
  return (int64_t)floor(from_origin / level->size);
}

static inline double clamped(const struct cdem_neighbours *n, int axis, double place) {
  double from = place - n->origin[axis];
  return from > n->clamp ? n->clamp : from < -n->clamp ? -n->clamp : from;
}

/* What is found in a box of each level: how many points, and from where to where. */
static void level_boxes(const cdem_dem_store *s, struct cdem_neighbours *n, double low[][3],
                        double high[][3]) {
  for (int l = 0; l < n->levels; l++)
    for (int k = 0; k < 3; k++) {
      low[l][k] = INFINITY;
      high[l][k] = -INFINITY;
    }
  for (int64_t p = 0; p < n->points; p++) {
    const double *place = cdem_neighbours_place(s, n, p);
    int l = n->level_of[p];
    n->level[l].points++;
    for (int k = 0; k < 3; k++) {
      double x = place[n->axis[k]];
      low[l][k] = x < low[l][k] ? x : low[l][k];
      high[l][k] = x > high[l][k] ? x : high[l][k];
    }
  }
}

/* Tables of rows where they are not much larger than the number of points, else hashing. */
static cdem_status set_tables(const cdem_dem_store *s, struct cdem_neighbours *n,
                              cdem_fault *fault) {
  double low[CDEM_NEIGHBOUR_LEVELS][3], high[CDEM_NEIGHBOUR_LEVELS][3];
  level_boxes(s, n, low, high);
  int64_t rows = 0, buckets = 0, slots = 0;
  for (int l = 0; l < n->levels; l++) {
    cdem_neighbour_level *level = &n->level[l];
    for (int k = 0; k < 2; k++) {
      level->low[k] = cdem_neighbours_row_number(level, clamped(n, n->axis[1 + k], low[l][1 + k]));
      level->count[k] =
          cdem_neighbours_row_number(level, clamped(n, n->axis[1 + k], high[l][1 + k])) -
          level->low[k] + 1;
    }
    int64_t most = 2 * level->points + 64;
    level->hashed = level->count[0] > most || level->count[1] > most / level->count[0];
    level->rows = level->hashed ? level->points : level->count[0] * level->count[1];
    level->near = low[l][0];
    level->far = high[l][0];
    level->buckets = 1;
    if (!level->hashed) {
      int64_t most_buckets = (4 * level->points + 1024) / level->rows;
      double wanted = (level->far - level->near) / level->size;
      level->buckets = (int64_t)fmax(1.0, fmin(wanted, (double)most_buckets));
    } else {
      for (level->hash_mask = 16; level->hash_mask < 2 * level->points; level->hash_mask *= 2)
        ;
      level->hash_first = slots;
      slots += level->hash_mask--;
    }
    level->row_first = rows;
    level->bucket_first = buckets;
    rows += level->rows;
    buckets += level->rows * level->buckets;
  }
  CDEM_TRY(
      cdem_neighbours_room(&n->bucket, &n->capacity[10], buckets + 2, sizeof *n->bucket, fault));
  CDEM_TRY(cdem_neighbours_room(&n->hash, &n->capacity[11], slots, sizeof *n->hash, fault));
  CDEM_TRY(cdem_neighbours_room(&n->row_key, &n->capacity[12], slots > 0 ? 2 * rows : 0,
                                sizeof *n->row_key, fault));
  CDEM_TRY(
      cdem_neighbours_room(&n->row_begin, &n->capacity[29], rows, sizeof *n->row_begin, fault));
  CDEM_TRY(cdem_neighbours_room(&n->row_end, &n->capacity[30], rows, sizeof *n->row_end, fault));
  memset(n->bucket, 0, (size_t)(buckets + 2) * sizeof *n->bucket);
  memset(n->hash, 0, (size_t)slots * sizeof *n->hash);
  n->rows = rows;
  n->buckets = buckets;
  return CDEM_OK;
}

static inline uint64_t hash_of(int64_t a, int64_t b) {
  uint64_t z = (uint64_t)a * 0x9e3779b97f4a7c15u + (uint64_t)b * 0xc2b2ae3d27d4eb4fu;
  z = (z ^ (z >> 29)) * 0xbf58476d1ce4e5b9u;
  return z ^ (z >> 32);
}

/* Slot of a hashed row, or the empty one where it would be. */
static int64_t slot_of(const struct cdem_neighbours *n, const cdem_neighbour_level *level,
                       int64_t a, int64_t b) {
  int64_t at = (int64_t)(hash_of(a, b) & (uint64_t)level->hash_mask);
  for (;; at = (at + 1) & level->hash_mask) {
    int32_t row = n->hash[level->hash_first + at];
    if (row == 0)
      break;
    const int32_t *key = n->row_key + 2 * (level->row_first + row - 1);
    if (key[0] == a && key[1] == b)
      break;
  }
  return level->hash_first + at;
}

int64_t cdem_neighbours_row_find(const struct cdem_neighbours *n, const cdem_neighbour_level *level,
                                 int64_t a, int64_t b) {
  if (level->hashed)
    return (int64_t)n->hash[slot_of(n, level, a, b)] - 1;
  a -= level->low[0];
  b -= level->low[1];
  if (a < 0 || a >= level->count[0] || b < 0 || b >= level->count[1])
    return -1;
  return b * level->count[0] + a;
}

/* The same for a point, making hashed rows as they are met. */
static int64_t row_of_point(struct cdem_neighbours *n, cdem_neighbour_level *level, int64_t *used,
                            const double *place) {
  int64_t a = cdem_neighbours_row_number(level, clamped(n, n->axis[1], place[n->axis[1]]));
  int64_t b = cdem_neighbours_row_number(level, clamped(n, n->axis[2], place[n->axis[2]]));
  if (!level->hashed)
    return (b - level->low[1]) * level->count[0] + a - level->low[0];
  int64_t slot = slot_of(n, level, a, b);
  if (n->hash[slot] == 0) {
    int32_t *key = n->row_key + 2 * (level->row_first + *used);
    key[0] = (int32_t)a;
    key[1] = (int32_t)b;
    n->hash[slot] = (int32_t)++ * used;
  }
  return n->hash[slot] - 1;
}

static void fill_buckets(const cdem_dem_store *s, struct cdem_neighbours *n) {
  int64_t used[CDEM_NEIGHBOUR_LEVELS] = {0};
  int32_t *count = n->bucket + 2;
  for (int64_t p = 0; p < n->points; p++) {
    const double *place = cdem_neighbours_place(s, n, p);
    cdem_neighbour_level *level = &n->level[n->level_of[p]];
    int64_t bucket = row_of_point(n, level, &used[n->level_of[p]], place) * level->buckets;
    if (level->buckets > 1) {
      double part = (place[n->axis[0]] - level->near) / (level->far - level->near);
      double at = part * (double)level->buckets, last = (double)(level->buckets - 1);
      bucket += (int64_t)(at < last ? at : last);
    }
    bucket += level->bucket_first;
    n->bucket_of[p] = (int32_t)bucket;
    count[bucket]++;
  }
  for (int64_t k = 1; k < n->buckets; k++)
    count[k] += count[k - 1];
  /* bucket[k + 1] is where bucket k starts, and becomes its end: where k + 1 starts. */
  for (int64_t p = 0; p < n->points; p++)
    n->sort_point[n->bucket[n->bucket_of[p] + 1]++] = (int32_t)p;
}

typedef struct {
  const cdem_dem_store *s;
  const struct cdem_neighbours *n;
} along_order;

static bool is_before(const void *context, int32_t a, int32_t b) {
  const along_order *order = context;
  int axis = order->n->axis[0];
  return cdem_neighbours_place(order->s, order->n, a)[axis] <
         cdem_neighbours_place(order->s, order->n, b)[axis];
}

/* Sorts points along the axis of the rows; `key` [count] and `spare` [count] are for work. Buckets
 * are in order along the row, so few points move; if not (one bucket is full) they are merged. */
static void sort_row(const cdem_dem_store *s, struct cdem_neighbours *n, int32_t *point,
                     double *key, int32_t *spare, int64_t count) {
  int64_t moves = 0, most = 16 * count + 64;
  for (int64_t k = 0; k < count; k++)
    key[k] = cdem_neighbours_place(s, n, point[k])[n->axis[0]];
  for (int64_t k = 1; k < count && moves < most; k++) {
    double moving = key[k];
    int32_t what = point[k];
    int64_t to = k;
    for (; to > 0 && moving < key[to - 1] && moves < most; to--, moves++) {
      key[to] = key[to - 1];
      point[to] = point[to - 1];
    }
    key[to] = moving;
    point[to] = what;
  }
  if (moves >= most) {
    along_order order = {s, n};
    cdem_neighbours_merge_sort(point, spare, count, is_before, &order);
  }
}

/* A row and the points at infinity behind it. */
static void fill_row(const cdem_dem_store *s, struct cdem_neighbours *n, const int32_t *point,
                     int64_t begin, int64_t end) {
  for (int64_t k = begin; k < end; k++) {
    int64_t p = point[k - begin];
    const double *place = cdem_neighbours_place(s, n, p);
    n->along[k] = place[n->axis[0]];
    n->across[0][k] = place[n->axis[1]];
    n->across[1][k] = place[n->axis[2]];
    n->radius[k] = place[3];
    n->owner[k] = (int32_t)(p < s->grains ? p : n->ghost_of[p - s->grains]);
    n->image[k] = p < s->grains ? CDEM_IMAGE_SELF : n->ghost_image[p - s->grains];
  }
  for (int64_t k = end; k < end + CDEM_NEIGHBOUR_LANES; k++) {
    n->along[k] = INFINITY;
    n->across[0][k] = n->across[1][k] = n->radius[k] = 0.0;
    n->owner[k] = -1;
    n->image[k] = CDEM_IMAGE_SELF;
  }
}

/* Where rows begin and end, with room for the points at infinity behind each that is not empty. */
static cdem_status place_rows(struct cdem_neighbours *n, cdem_fault *fault) {
  int64_t *room = n->capacity + 15, at = 0;
  for (int l = 0; l < n->levels; l++)
    for (int64_t r = 0; r < n->level[l].rows; r++) {
      int64_t first = n->level[l].bucket_first + r * n->level[l].buckets;
      int64_t count = n->bucket[first + n->level[l].buckets] - n->bucket[first];
      n->row_begin[n->level[l].row_first + r] = at;
      n->row_end[n->level[l].row_first + r] = at + count;
      at += count > 0 ? count + CDEM_NEIGHBOUR_LANES : 0;
    }
  CDEM_TRY(cdem_neighbours_room(&n->along, &room[0], at, sizeof(double), fault));
  CDEM_TRY(cdem_neighbours_room(&n->across[0], &room[1], at, sizeof(double), fault));
  CDEM_TRY(cdem_neighbours_room(&n->across[1], &room[2], at, sizeof(double), fault));
  CDEM_TRY(cdem_neighbours_room(&n->radius, &room[3], at, sizeof(double), fault));
  CDEM_TRY(cdem_neighbours_room(&n->owner, &room[4], at, sizeof(int32_t), fault));
  return cdem_neighbours_room(&n->image, &room[5], at, 1, fault);
}

static void sort_rows(const cdem_dem_store *s, struct cdem_neighbours *n, int l, int threads) {
  const cdem_neighbour_level *level = &n->level[l];
#pragma omp parallel for schedule(dynamic, 16) num_threads(threads)
  for (int64_t r = 0; r < level->rows; r++) {
    int64_t from = n->bucket[level->bucket_first + r * level->buckets];
    int64_t begin = n->row_begin[level->row_first + r], end = n->row_end[level->row_first + r];
    if (begin == end)
      continue;
    int32_t *point = n->sort_point + from;
    sort_row(s, n, point, n->along + begin, n->owner + begin, end - begin);
    fill_row(s, n, point, begin, end);
  }
}

cdem_status cdem_neighbours_rows(cdem_dem_store *s, int threads, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  int64_t *room = n->capacity + 13;
  CDEM_TRY(set_axes(s, fault));
  CDEM_TRY(set_tables(s, n, fault));
  CDEM_TRY(cdem_neighbours_room(&n->bucket_of, &room[0], n->points, sizeof(int32_t), fault));
  CDEM_TRY(cdem_neighbours_room(&n->sort_point, &room[1], n->points, sizeof(int32_t), fault));
  fill_buckets(s, n);
  CDEM_TRY(place_rows(n, fault));
  for (int l = 0; l < n->levels; l++)
    sort_rows(s, n, l, threads);
  return CDEM_OK;
}
