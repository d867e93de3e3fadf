/* A store with nothing but grains, as the neighbour search needs it. */
#ifndef CDEM_TESTS_DEM_NEIGHBOURS_SUPPORT_H
#define CDEM_TESTS_DEM_NEIGHBOURS_SUPPORT_H

#include "dem/neighbours.h"
#include "support/test.h"

#define STORE_TRY(call)                                                                            \
  do {                                                                                             \
    if ((call) == NULL)                                                                            \
      fail_msg("no memory");                                                                       \
  } while (0)

static inline void store_init(cdem_dem_store *s, int dim, int32_t grains, double skin) {
  *s = (cdem_dem_store){.dim = dim, .grains = grains, .skin = skin};
  STORE_TRY(s->place = calloc((size_t)grains, 32));
  STORE_TRY(s->motion = calloc((size_t)grains, 64));
  STORE_TRY(s->id = calloc((size_t)grains, sizeof(int32_t)));
  STORE_TRY(s->slot = calloc((size_t)grains, sizeof(int32_t)));
  for (int32_t i = 0; i < grains; i++)
    s->id[i] = s->slot[i] = i;
  s->sort[0] = (cdem_dem_sorted){&s->place, 32};
  s->sort[1] = (cdem_dem_sorted){&s->motion, 64};
  s->sort[2] = (cdem_dem_sorted){&s->id, 4};
  s->sorted = 3;
}

static inline void store_release(cdem_dem_store *s) {
  cdem_neighbours_release(s);
  free(s->place);
  free(s->motion);
  free(s->id);
  free(s->slot);
}

/* Grains at random in a box, radii between two numbers (few large ones: r^-3). */
static inline void store_fill(cdem_dem_store *s, const double box[3], double small, double large,
                              uint64_t seed) {
  cdem_random random = {seed};
  for (int64_t i = 0; i < s->grains; i++) {
    double *place = cdem_place(s, i);
    for (int c = 0; c < 3; c++)
      place[c] = c < s->dim ? cdem_random_uniform(&random, 0.0, box[c]) : 0.0;
    double u = cdem_random_uniform(&random, 0.0, 1.0), a = 1.0 / (small * small);
    place[3] = small == large ? small : 1.0 / sqrt(a + u * (1.0 / (large * large) - a));
    for (int c = 0; c < s->dim; c++)
      cdem_motion(s, i)[c] = cdem_random_uniform(&random, -1.0, 1.0);
  }
}

static inline void store_cell(cdem_dem_store *s, const bool periodic[3], const double h[9]) {
  for (int c = 0; c < 3; c++)
    s->cell.periodic[c] = periodic[c];
  for (int k = 0; k < 9; k++)
    s->cell.h[k] = h[k];
  cdem_cell_images(&s->cell, s->image);
}

/* Numbers held by the search, of whatever size. */
static inline int64_t memory_of(const cdem_dem_store *s) {
  const struct cdem_neighbours *n = s->search;
  int64_t sum = 0;
  for (size_t k = 0; k < sizeof n->capacity / sizeof *n->capacity; k++)
    sum += n->capacity[k];
  for (int t = 0; t < n->threads; t++)
    sum += n->found[t].word_capacity + n->found[t].back_capacity;
  return sum;
}

#endif
