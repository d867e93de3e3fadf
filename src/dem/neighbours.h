/* Private to the neighbour search of dem: who is near whom, in O(grains).
 *
 * Build = wrap into the cell, sort in space (neighbours_sort.c), points with their images across
 * the faces of the cell (neighbours_points.c), rows of points (neighbours_rows.c), pairs
 * (neighbours_sweep.c), list and histories (neighbours_list.c).
 *
 * Points stand in levels by size s = 2 r + skin: level 0 holds the sizes within half of the
 * largest, level 1 those within half of the largest that is left, and so on. A pair is closer than
 * the mean of its two sizes. Each level has rows along one axis, as wide as its largest size, and
 * points in a row are sorted along it. A grain looks for others in its own level and in the coarser
 * ones: in the few rows near its own row a window of points moves along with it. So the work for a
 * grain does not depend on how much larger or smaller others are. Rows are found in a table, or by
 * hashing where a table would be much larger than the number of grains (a grain that flew away).
 *
 * Nothing here depends on the number of threads: what each grain finds is put into the order of the
 * list at the end. Cells and rows follow from ratios of lengths, so scaled models do the same.
 */
#ifndef CDEM_DEM_NEIGHBOURS_H
#define CDEM_DEM_NEIGHBOURS_H

#include "dem/store.h"

enum { CDEM_NEIGHBOUR_LEVELS = 32, CDEM_NEIGHBOUR_LANES = 8 };

typedef struct {
  double size;   /* largest 2 r + skin in the level, m: width of its rows, a little wider */
  double radius; /* largest, m */
  int64_t points;
  int64_t row_first, rows; /* among those of all levels */
  bool hashed;
  int64_t low[2], count[2];      /* numbers of its rows across: the first, how many */
  int64_t bucket_first;          /* rows are filled by buckets along them: the first of the level */
  int64_t buckets;               /* in a row */
  double near, far;              /* of the places along the rows */
  int64_t hash_first, hash_mask; /* slots among those of all levels */
} cdem_neighbour_level;

/* What a thread found: words (other << 8 | image), row after row; and pairs that belong to the row
 * of the other. */
typedef struct {
  uint64_t *word;
  int64_t words, word_capacity;
  uint64_t *back; /* [2 back] owner, word */
  int64_t backs, back_capacity;
  int64_t tests; /* pairs tested in this build */
  cdem_status status;
} cdem_neighbour_found;

struct cdem_neighbours {
  int64_t capacity[40];
  /* sorting */
  int32_t *order, *place_of; /* new to old, old to new */
  uint64_t *key, *key_spare;
  int32_t *order_spare;
  void *permuted;
  int16_t *turned; /* [grains][3] edges added to each old grain in this build */
  bool moved;      /* does `turned` hold anything, or did the cell flip? */
  int turns[9];    /* of cdem_cell_flip */
  /* points: grains, then images */
  int64_t points;
  double *ghost; /* [points - grains][4] */
  int32_t *ghost_of;
  uint8_t *ghost_image;
  uint8_t *level_of;
  int axis[3];               /* along the rows; across them */
  double origin[3], largest; /* radius, m */
  int levels;
  cdem_neighbour_level level[CDEM_NEIGHBOUR_LEVELS];
  double clamp; /* m: places further from the origin count as being there */
  /* rows */
  int32_t *bucket_of, *bucket; /* of each point; where each bucket starts */
  int32_t *row_key, *hash;     /* [rows][2] numbers of hashed rows; slots, row + 1 */
  int64_t rows, buckets;
  int64_t *row_begin, *row_end; /* [rows] among the points below */
  /* points row by row, LANES at infinity behind each row that is not empty */
  double *along, *across[2], *radius;
  int32_t *owner;
  uint8_t *image;
  double *sort_key;
  int32_t *sort_point;
  /* what was found */
  int threads;
  cdem_neighbour_found *found;
  int64_t *found_at; /* [grains] */
  int32_t *found_by, *found_count;
  int64_t *back_start;
  uint64_t *back_word, *row_word;
  bool any_back;
  int64_t tests; /* pairs tested in the last build */
  /* the list before, and its capacities */
  int64_t *start;
  int32_t *other;
  uint8_t *pair_image, *touch;
  double *history;
  int64_t list_capacity[5];
};

/* An array of at least this length, contents lost when it grows. */
cdem_status cdem_neighbours_room(void *array, int64_t *capacity, int64_t needed, size_t size,
                                 cdem_fault *fault);
/* Sorts `count` indices: less(context, a, b) is a strict weak order. Stable; spare [count]. */
typedef bool cdem_neighbours_less(const void *context, int32_t a, int32_t b);
void cdem_neighbours_merge_sort(int32_t *index, int32_t *spare, int64_t count,
                                cdem_neighbours_less *less, const void *context);

/* neighbours_sort.c: order of all grains in space, new to old; changes nothing of the grains. */
cdem_status cdem_neighbours_order(const cdem_dem_store *s, int32_t *order, cdem_fault *fault);
/* Puts all arrays of s->sort into an order. */
cdem_status cdem_neighbours_permute(cdem_dem_store *s, const int32_t *order, cdem_fault *fault);
/* Box of all centres. */
void cdem_neighbours_box(const cdem_dem_store *s, double low[3], double high[3]);
/* Where cells of this size are counted from: the low corner of the box; its medians (spare
 * [grains]) where the box holds more than `most` cells along an axis, since then a few grains are
 * far from all others. Returns whether it is the corner along this axis. */
bool cdem_neighbours_origin(const cdem_dem_store *s, int axis, const double box[2],
                            const double cells[2], double *spare, double *origin);

/* neighbours_points.c */
cdem_status cdem_neighbours_wrap(cdem_dem_store *s, cdem_fault *fault);
cdem_status cdem_neighbours_points(cdem_dem_store *s, cdem_fault *fault);
static inline const double *cdem_neighbours_place(const cdem_dem_store *s,
                                                  const struct cdem_neighbours *n, int64_t p) {
  return p < s->grains ? s->place + 4 * p : n->ghost + 4 * (p - s->grains);
}

/* neighbours_rows.c, neighbours_sweep.c, neighbours_list.c */
cdem_status cdem_neighbours_rows(cdem_dem_store *s, int threads, cdem_fault *fault);
/* Number of the row of a level across one axis at a place from the origin; the row itself, from 0
 * in its level, or -1. */
int64_t cdem_neighbours_row_number(const cdem_neighbour_level *level, double from_origin);
int64_t cdem_neighbours_row_find(const struct cdem_neighbours *n, const cdem_neighbour_level *level,
                                 int64_t a, int64_t b);
cdem_status cdem_neighbours_sweep(cdem_dem_store *s, int threads, cdem_fault *fault);
cdem_status cdem_neighbours_list(cdem_dem_store *s, bool sorted, int threads, cdem_fault *fault);

#endif
