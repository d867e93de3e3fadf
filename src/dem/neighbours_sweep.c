/* Neighbours: pairs, by windows that move along the rows. */
#include "base/simd.h"
#include "dem/neighbours.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = CDEM_NEIGHBOUR_LANES, WINDOWS = 9 };

/* Points of a row, sorted along it; LANES points at infinity follow. */
typedef struct {
  const double *x, *y, *z, *r;
} row_points;

static inline row_points points_at(const struct cdem_neighbours *n, int64_t at) {
  return (row_points){n->along + at, n->across[0] + at, n->across[1] + at, n->radius + at};
}

/* Four doubles side by side: one register of AVX2, which all that follows is good with. */
typedef double lanes4 __attribute__((vector_size(32)));
typedef double lanes4_at __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t mask4 __attribute__((vector_size(32)));

/* Which of LANES points are near a point (x, y, z, r): bits. */
CDEM_ALWAYS_INLINE uint64_t near_bits(const row_points *of, int64_t at, const double point[4],
                                      double skin) {
  static const mask4 weight[2] = {{1, 2, 4, 8}, {16, 32, 64, 128}};
  mask4 bits = {0};
  for (int half = 0; half < 2; half++, at += 4) {
    lanes4 dx = *(const lanes4_at *)(of->x + at) - point[0];
    lanes4 dy = *(const lanes4_at *)(of->y + at) - point[1];
    lanes4 dz = *(const lanes4_at *)(of->z + at) - point[2];
    lanes4 reach = point[3] + *(const lanes4_at *)(of->r + at) + skin;
    bits |= (dx * dx + dy * dy + dz * dz < reach * reach) & weight[half];
  }
  return (uint64_t)((bits[0] | bits[1]) | (bits[2] | bits[3]));
}

/* Where places along a row reach this one. */
static int64_t lower_bound(const double *along, int64_t begin, int64_t end, double place) {
  while (begin < end) {
    int64_t middle = begin + (end - begin) / 2;
    if (along[middle] < place)
      begin = middle + 1;
    else
      end = middle;
  }
  return begin;
}

/* First point of a window that has moved on: most often only few points are left behind. */
CDEM_ALWAYS_INLINE int64_t advance(const double *x, int64_t at, int64_t end, double low) {
  at += (x[at] < low) + (x[at + 1] < low) + (x[at + 2] < low) + (x[at + 3] < low);
  return x[at] < low ? lower_bound(x, at + 1, end, low) : at;
}

/* ---- pairs in one level ---- */

static bool room_for(cdem_neighbour_found *f, int64_t more) {
  if (f->words + more <= f->word_capacity)
    return true;
  cdem_status status =
      cdem_grow(&f->word, &f->word_capacity, f->words + more, sizeof *f->word, NULL);
  f->status = status != CDEM_OK ? status : f->status;
  return status == CDEM_OK;
}

/* Writes the points whose bits are set, if they come after the grain in the order of grains. */
CDEM_ALWAYS_INLINE int64_t write_words(const struct cdem_neighbours *n, uint64_t bits,
                                       const int64_t *start, int32_t own, uint64_t *word) {
  int64_t words = 0;
  for (; bits != 0; bits &= bits - 1) {
    int bit = __builtin_ctzll(bits);
    int64_t at = start[bit / LANES] + bit % LANES;
    word[words] = (uint64_t)n->owner[at] << 8 | n->image[at];
    words += n->owner[at] > own;
  }
  return words;
}

/* What lies in a window beyond its first lanes. */
static bool look_on(const struct cdem_neighbours *n, int64_t at, const double point[4], double high,
                    double skin, int32_t own, cdem_neighbour_found *f) {
  row_points all = points_at(n, 0);
  for (; n->along[at] <= high; at += LANES) {
    if (!room_for(f, LANES))
      return false;
    f->words += write_words(n, near_bits(&all, at, point, skin), &at, own, f->word + f->words);
    f->tests += LANES;
  }
  return true;
}

/* Windows in the rows around a row: from `start`, which moves on, to the end of the row. */
typedef struct {
  int windows;
  int64_t start[WINDOWS], end[WINDOWS];
  double reach;
} row_windows;

/* All grains of a row against the windows around it. */
CDEM_MULTIVERSION static void sweep_windows(struct cdem_neighbours *n, const int64_t row[2],
                                            row_windows *around, double skin, int thread) {
  cdem_neighbour_found *f = &n->found[thread];
  row_points all = points_at(n, 0);
  int64_t *start = around->start;
  const int64_t *end = around->end;
  int windows = around->windows;
  double reach = around->reach;
  for (int64_t k = row[0]; k < row[1]; k++) {
    int32_t own = n->owner[k];
    double point[4] = {all.x[k], all.y[k], all.z[k], all.r[k]};
    double low = point[0] - reach, high = point[0] + reach;
    if (n->image[k] != CDEM_IMAGE_SELF)
      continue;
    if (!room_for(f, (WINDOWS + 1) * LANES))
      return;
    int64_t from = f->words;
    uint64_t bits = 0, last = 0, more = 0;
    for (int w = 0; w < windows; w++) {
      start[w] = advance(all.x, start[w], end[w], low);
      last = near_bits(&all, start[w], point, skin);
      more |= (uint64_t)(all.x[start[w] + LANES - 1] <= high) << w;
      bits |= w < LANES ? last << LANES * w : 0;
    }
    f->tests += windows * LANES;
    f->words += write_words(n, bits, start, own, f->word + f->words);
    if (windows == WINDOWS)
      f->words += write_words(n, last, start + WINDOWS - 1, own, f->word + f->words);
    for (; more != 0; more &= more - 1)
      if (!look_on(n, start[__builtin_ctzll(more)] + LANES, point, high, skin, own, f))
        return;
    n->found_at[own] = from;
    n->found_by[own] = thread;
    n->found_count[own] = (int32_t)(f->words - from);
  }
}

/* ---- pairs with coarser levels ---- */

/* Writes pairs of a point with those of another level whose bits are set. Grains of the finer level
 * are no images: the pair of an image with an image is found as that of their grains. */
static bool write_pairs(const struct cdem_neighbours *n, uint64_t bits, int64_t at, int64_t p,
                        bool fine, cdem_neighbour_found *f) {
  if (f->backs + 2 * LANES > f->back_capacity) {
    f->status = cdem_grow(&f->back, &f->back_capacity, f->backs + 2 * LANES, sizeof *f->back, NULL);
    if (f->status != CDEM_OK)
      return false;
  }
  for (; bits != 0; bits &= bits - 1) {
    int64_t q = at + __builtin_ctzll(bits), j = fine ? p : q, k = fine ? q : p;
    uint64_t a = (uint64_t)n->owner[j], b = (uint64_t)n->owner[k], image = n->image[k];
    f->back[f->backs] = a < b ? a : b;
    f->back[f->backs + 1] = a < b ? b << 8 | image : a << 8 | (26 - image);
    f->backs += n->image[j] == CDEM_IMAGE_SELF ? 2 : 0;
  }
  return true;
}

/* Points of one row, each with a window of another. Which of them is the finer one? */
CDEM_MULTIVERSION static void sweep_between(struct cdem_neighbours *n, const int64_t few[2],
                                            const int64_t many[2], bool fine, double reach,
                                            double skin, cdem_neighbour_found *f) {
  row_points all = points_at(n, 0);
  double high = all.x[many[1] - 1] + reach;
  int64_t at = many[0], p = lower_bound(all.x, few[0], few[1], all.x[many[0]] - reach);
  for (; p < few[1] && all.x[p] <= high; p++) {
    double point[4] = {all.x[p], all.y[p], all.z[p], all.r[p]};
    at = advance(all.x, at, many[1], point[0] - reach);
    for (int64_t q = at; all.x[q] <= point[0] + reach; q += LANES) {
      uint64_t bits = near_bits(&all, q, point, skin);
      f->tests += LANES;
      if (bits != 0 && !write_pairs(n, bits, q, p, fine, f))
        return;
    }
  }
}

/* ---- rows ---- */

static bool row_range(const struct cdem_neighbours *n, const cdem_neighbour_level *level,
                      int64_t row, int64_t range[2]) {
  if (row < 0)
    return false;
  range[0] = n->row_begin[level->row_first + row];
  range[1] = n->row_end[level->row_first + row];
  return range[0] < range[1];
}

static void sweep_own(struct cdem_neighbours *n, int l, const int64_t row[2],
                      const int64_t number[2], double skin, int thread) {
  const cdem_neighbour_level *level = &n->level[l];
  row_windows around = {.reach = (2.0 * level->radius + skin) * (1.0 + 0x1p-16)};
  int64_t range[2];
  for (int db = -1; db <= 1; db++)
    for (int da = -1; da <= 1; da++)
      if (row_range(n, level, cdem_neighbours_row_find(n, level, number[0] + da, number[1] + db),
                    range)) {
        double low = n->along[row[0]] - around.reach;
        around.start[around.windows] = lower_bound(n->along, range[0], range[1], low);
        around.end[around.windows++] = range[1];
      }
  sweep_windows(n, row, &around, skin, thread);
}

static void sweep_coarse(struct cdem_neighbours *n, const int64_t row[2], const int64_t to[2],
                         double reach, double skin, int thread) {
  cdem_neighbour_found *f = &n->found[thread];
  if (row[1] - row[0] < to[1] - to[0])
    sweep_between(n, row, to, true, reach, skin, f);
  else
    sweep_between(n, to, row, false, reach, skin, f);
}

/* A row is wider than the largest size in it by more than rounding, so what is near in one level
 * is in the rows beside it. In a coarser level it is in the rows that reach gets to. */
static void sweep_row(cdem_dem_store *s, int l, int64_t r, int thread) {
  struct cdem_neighbours *n = s->search;
  const cdem_neighbour_level *level = &n->level[l];
  int64_t row[2], number[2], range[2];
  if (!row_range(n, level, r, row) || n->found[thread].status != CDEM_OK)
    return;
  if (level->hashed) {
    number[0] = n->row_key[2 * (level->row_first + r)];
    number[1] = n->row_key[2 * (level->row_first + r) + 1];
  } else {
    number[0] = level->low[0] + r % level->count[0];
    number[1] = level->low[1] + r / level->count[0];
  }
  sweep_own(n, l, row, number, s->skin, thread);
  for (int t = l - 1; t >= 0; t--) {
    const cdem_neighbour_level *to = &n->level[t];
    double reach = (level->radius + to->radius + s->skin) * (1.0 + 0x1p-16);
    int64_t low[2], high[2];
    for (int c = 0; c < 2; c++) {
      double at = (double)number[c] * level->size;
      low[c] = cdem_neighbours_row_number(to, at - reach);
      high[c] = cdem_neighbours_row_number(to, at + level->size + reach);
    }
    for (int64_t b = low[1]; b <= high[1]; b++)
      for (int64_t a = low[0]; a <= high[0]; a++)
        if (row_range(n, to, cdem_neighbours_row_find(n, to, a, b), range))
          sweep_coarse(n, row, range, reach, s->skin, thread);
  }
}

static cdem_status found_arrays(cdem_dem_store *s, int threads, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  int64_t *room = n->capacity + 21;
  CDEM_TRY(cdem_neighbours_room(&n->found_at, &room[0], s->grains, sizeof(int64_t), fault));
  CDEM_TRY(cdem_neighbours_room(&n->found_by, &room[1], s->grains, sizeof(int32_t), fault));
  CDEM_TRY(cdem_neighbours_room(&n->found_count, &room[2], s->grains, sizeof(int32_t), fault));
  if (threads > n->threads) {
    int64_t have = n->threads;
    CDEM_TRY(cdem_grow(&n->found, &have, threads, sizeof *n->found, fault));
    n->threads = (int)have;
  }
  for (int t = 0; t < n->threads; t++) {
    n->found[t].words = n->found[t].backs = n->found[t].tests = 0;
    n->found[t].status = CDEM_OK;
  }
  return CDEM_OK;
}

cdem_status cdem_neighbours_sweep(cdem_dem_store *s, int threads, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  CDEM_TRY(found_arrays(s, threads, fault));
  for (int l = 0; l < n->levels; l++) {
    int64_t rows = n->level[l].rows;
#pragma omp parallel for schedule(dynamic, 16) num_threads(threads)
    for (int64_t r = 0; r < rows; r++)
      sweep_row(s, l, r, omp_get_thread_num());
  }
  n->tests = 0;
  for (int t = 0; t < n->threads; t++) {
    n->tests += n->found[t].tests;
    if (n->found[t].status != CDEM_OK)
      return cdem_fail(fault, n->found[t].status,
                       "neighbours: out of memory for the pairs of %d grains", (int)s->grains);
  }
  return CDEM_OK;
}
