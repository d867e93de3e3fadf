/* Neighbours: the build from beginning to end. */
#include "dem/neighbours.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

cdem_status cdem_neighbours_room(void *array, int64_t *capacity, int64_t needed, size_t size,
                                 cdem_fault *fault) {
  void *old, *block;
  memcpy(&old, array, sizeof old);
  if (old != NULL && needed <= *capacity)
    return CDEM_OK;
  int64_t larger = needed + needed / 8;
  block = cdem_allocate(larger, size, fault);
  if (block == NULL)
    return CDEM_MEMORY;
  free(old);
  memcpy(array, &block, sizeof block);
  *capacity = larger;
  return CDEM_OK;
}

static cdem_status sort_grains(cdem_dem_store *s, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  int64_t *room = n->capacity + 27;
  CDEM_TRY(cdem_neighbours_room(&n->order, &room[0], s->grains, sizeof *n->order, fault));
  CDEM_TRY(cdem_neighbours_room(&n->place_of, &room[1], s->grains, sizeof *n->place_of, fault));
  CDEM_TRY(cdem_neighbours_order(s, n->order, fault));
  for (int32_t i = 0; i < s->grains; i++)
    n->place_of[n->order[i]] = i;
  return cdem_neighbours_permute(s, n->order, fault);
}

static cdem_status build(cdem_dem_store *s, bool sort, int threads, cdem_fault *fault) {
  CDEM_TRY(cdem_neighbours_wrap(s, fault));
  if (sort)
    CDEM_TRY(sort_grains(s, fault));
  CDEM_TRY(cdem_neighbours_points(s, fault));
  CDEM_TRY(cdem_neighbours_rows(s, threads, fault));
  CDEM_TRY(cdem_neighbours_sweep(s, threads, fault));
  return cdem_neighbours_list(s, sort, threads, fault);
}

void cdem_neighbours_forget(cdem_dem_store *s) {
  s->pairs = 0;
  if (s->pair_start != NULL)
    memset(s->pair_start, 0, (size_t)(s->grains + 1) * sizeof *s->pair_start);
}

cdem_status cdem_neighbours_build(cdem_dem_store *s, bool sort, int threads, cdem_fault *fault) {
  if (s->search == NULL)
    CDEM_NEW(s->search, 1, fault);
  /* A thread for a few grains waits longer than it works. */
  int most = 1 + s->grains / 256, wanted = threads > 0 ? threads : omp_get_max_threads();
  cdem_status status = build(s, sort, wanted < most ? wanted : most, fault);
  if (status != CDEM_OK) { /* grains may have moved in the store already */
    cdem_neighbours_forget(s);
    return status;
  }
  s->builds++;
  return CDEM_OK;
}

static void release_search(struct cdem_neighbours *n) {
  void *array[] = {
      n->order,     n->place_of,  n->key,      n->key_spare,   n->order_spare, n->permuted,
      n->turned,    n->ghost,     n->ghost_of, n->ghost_image, n->level_of,    n->bucket_of,
      n->bucket,    n->row_key,   n->hash,     n->along,       n->across[0],   n->across[1],
      n->radius,    n->owner,     n->image,    n->sort_key,    n->sort_point,  n->found_at,
      n->found_by,  n->row_begin, n->row_end,  n->row_word,    n->found_count, n->back_start,
      n->back_word, n->start,     n->other,    n->pair_image,  n->touch,       n->history};
  for (size_t k = 0; k < sizeof array / sizeof *array; k++)
    free(array[k]);
  for (int t = 0; t < n->threads; t++) {
    free(n->found[t].word);
    free(n->found[t].back);
  }
  free(n->found);
  free(n);
}

void cdem_neighbours_release(cdem_dem_store *s) {
  free(s->pair_start);
  free(s->pair_other);
  free(s->pair_image);
  free(s->pair_touch);
  free(s->pair_history);
  s->pair_start = NULL;
  s->pair_other = NULL;
  s->pair_image = s->pair_touch = NULL;
  s->pair_history = NULL;
  s->pairs = 0;
  memset(s->capacity, 0, sizeof s->capacity);
  if (s->search != NULL)
    release_search(s->search);
  s->search = NULL;
}
