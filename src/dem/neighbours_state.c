/* Neighbours: what a checkpoint holds of the order of the grains, the list and the histories.
 *
 * The order and the list are saved as they are: a list built anew at the restart would hold other
 * pairs near the edge of the skin, and the next build would come at another step.
 */
#include "dem/neighbours.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static int64_t touching(const uint8_t *touch, int64_t pairs) {
  int64_t count = 0;
  for (int64_t k = 0; k < pairs; k++)
    count += touch[k] == 1;
  return count;
}

cdem_status cdem_neighbours_save(const cdem_dem_store *s, cdem_state *state, cdem_fault *fault) {
  int64_t touches = touching(s->pair_touch, s->pairs), at = 0;
  CDEM_REQUIRE(s->pair_start != NULL, fault, CDEM_USAGE,
               "neighbours: there is no list to save; build it first");
  double *history;
  CDEM_NEW(history, touches * s->histories, fault);
  for (int64_t k = 0; k < s->pairs; k++)
    if (s->pair_touch[k] == 1)
      for (int h = 0; h < s->histories; h++)
        history[at++] = s->pair_history[k * s->histories + h];
  cdem_status status =
      cdem_state_add_owned(state, "dem/pairs/history", CDEM_ARRAY_REAL, at, history, fault);
  if (status != CDEM_OK) {
    free(history);
    return status;
  }
  CDEM_TRY(cdem_state_add_copy(state, "dem/pairs/builds", CDEM_ARRAY_INT64, 1, &s->builds, fault));
  CDEM_TRY(cdem_state_add(state, "dem/pairs/order", CDEM_ARRAY_INT32, s->grains, s->id, fault));
  CDEM_TRY(cdem_state_add(state, "dem/pairs/start", CDEM_ARRAY_INT64, s->grains + 1, s->pair_start,
                          fault));
  CDEM_TRY(
      cdem_state_add(state, "dem/pairs/other", CDEM_ARRAY_INT32, s->pairs, s->pair_other, fault));
  CDEM_TRY(
      cdem_state_add(state, "dem/pairs/touch", CDEM_ARRAY_BYTE, s->pairs, s->pair_touch, fault));
  if (cdem_cell_is_periodic(&s->cell))
    CDEM_TRY(
        cdem_state_add(state, "dem/pairs/image", CDEM_ARRAY_BYTE, s->pairs, s->pair_image, fault));
  return CDEM_OK;
}

/* ---- back ---- */

typedef struct {
  int32_t *id;
  int64_t *start;
  int32_t *other;
  uint8_t *touch, *image;
  double *history;
  int64_t builds, pairs;
} saved_list;

static cdem_status no_list(cdem_fault *fault, const char *what) {
  return cdem_fail(fault, CDEM_INPUT,
                   "the checkpoint does not belong to this case: its list of neighbours %s; "
                   "restart with the case that wrote it",
                   what);
}

static cdem_status take(const cdem_dem_store *s, const cdem_state *state, saved_list *l,
                        cdem_fault *fault) {
  CDEM_NEW(l->id, s->grains, fault);
  CDEM_NEW(l->start, (int64_t)s->grains + 1, fault);
  CDEM_TRY(cdem_state_get(state, "dem/pairs/builds", CDEM_ARRAY_INT64, 1, &l->builds, fault));
  CDEM_TRY(cdem_state_get(state, "dem/pairs/order", CDEM_ARRAY_INT32, s->grains, l->id, fault));
  CDEM_TRY(cdem_state_get(state, "dem/pairs/start", CDEM_ARRAY_INT64, (int64_t)s->grains + 1,
                          l->start, fault));
  CDEM_TRY(
      cdem_state_take(state, "dem/pairs/other", CDEM_ARRAY_INT32, &l->pairs, &l->other, fault));
  CDEM_NEW(l->touch, l->pairs, fault);
  CDEM_TRY(cdem_state_get(state, "dem/pairs/touch", CDEM_ARRAY_BYTE, l->pairs, l->touch, fault));
  if (cdem_cell_is_periodic(&s->cell)) {
    CDEM_NEW(l->image, l->pairs, fault);
    CDEM_TRY(cdem_state_get(state, "dem/pairs/image", CDEM_ARRAY_BYTE, l->pairs, l->image, fault));
  }
  int64_t numbers = touching(l->touch, l->pairs) * s->histories;
  CDEM_NEW(l->history, numbers, fault);
  return cdem_state_get(state, "dem/pairs/history", CDEM_ARRAY_REAL, numbers, l->history, fault);
}

static cdem_status check(const cdem_dem_store *s, const saved_list *l, int32_t *order,
                         cdem_fault *fault) {
  for (int32_t i = 0; i < s->grains; i++)
    order[i] = -1;
  for (int32_t i = 0; i < s->grains; i++) {
    if (l->id[i] < 0 || l->id[i] >= s->grains || order[l->id[i]] >= 0)
      return no_list(fault, "does not name every grain once");
    order[l->id[i]] = i;
  }
  if (l->builds < 0 || l->builds >= INT64_MAX / 2)
    return no_list(fault, "was made a number of times that cannot be");
  if (l->start[0] != 0 || l->start[s->grains] != l->pairs)
    return no_list(fault, "has another number of pairs than its rows");
  for (int64_t i = 0; i < s->grains; i++)
    if (l->start[i + 1] < l->start[i] || l->start[i + 1] > l->pairs)
      return no_list(fault, "has rows of negative length");
  for (int64_t i = 0; i < s->grains; i++)
    for (int64_t k = l->start[i]; k < l->start[i + 1]; k++)
      if (l->other[k] <= i || l->other[k] >= s->grains || l->touch[k] > 2 ||
          (l->image != NULL && l->image[k] > 26))
        return no_list(fault, "holds a pair that cannot be");
  for (int32_t i = 0; i < s->grains; i++)
    order[i] = s->slot[l->id[i]];
  return CDEM_OK;
}

static cdem_status list_arrays(cdem_dem_store *s, int64_t pairs, cdem_fault *fault) {
  int64_t *room = s->capacity;
  CDEM_TRY(cdem_neighbours_room(&s->pair_start, &room[0], (int64_t)s->grains + 1,
                                sizeof *s->pair_start, fault));
  CDEM_TRY(cdem_neighbours_room(&s->pair_other, &room[1], pairs, sizeof *s->pair_other, fault));
  if (cdem_cell_is_periodic(&s->cell))
    CDEM_TRY(cdem_neighbours_room(&s->pair_image, &room[2], pairs, 1, fault));
  CDEM_TRY(cdem_neighbours_room(&s->pair_touch, &room[3], pairs, 1, fault));
  if (s->histories > 0)
    CDEM_TRY(cdem_neighbours_room(&s->pair_history, &room[4], pairs * s->histories,
                                  sizeof *s->pair_history, fault));
  return CDEM_OK;
}

static cdem_status put_back(cdem_dem_store *s, const saved_list *l, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  CDEM_TRY(cdem_neighbours_room(&n->order, &n->capacity[27], s->grains, sizeof *n->order, fault));
  CDEM_TRY(check(s, l, n->order, fault));
  cdem_status status = list_arrays(s, l->pairs, fault);
  if (status == CDEM_OK)
    status = cdem_neighbours_permute(s, n->order, fault);
  if (status != CDEM_OK) {
    cdem_neighbours_forget(s);
    return status;
  }
  size_t pairs = (size_t)l->pairs;
  memcpy(s->pair_start, l->start, ((size_t)s->grains + 1) * sizeof *l->start);
  memcpy(s->pair_other, l->other, pairs * sizeof *l->other);
  memcpy(s->pair_touch, l->touch, pairs);
  if (l->image != NULL)
    memcpy(s->pair_image, l->image, pairs);
  const double *history = l->history;
  for (int64_t k = 0; k < l->pairs && s->histories > 0; k++)
    if (l->touch[k] == 1) {
      memcpy(s->pair_history + k * s->histories, history, (size_t)s->histories * sizeof *history);
      history += s->histories;
    }
  s->pairs = l->pairs;
  s->builds = l->builds;
  return CDEM_OK;
}

cdem_status cdem_neighbours_restore(cdem_dem_store *s, const cdem_state *state, cdem_fault *fault) {
  if (s->search == NULL)
    CDEM_NEW(s->search, 1, fault);
  saved_list list = {0};
  cdem_status status = take(s, state, &list, fault);
  if (status == CDEM_OK)
    status = put_back(s, &list, fault);
  free(list.id);
  free(list.start);
  free(list.other);
  free(list.touch);
  free(list.image);
  free(list.history);
  return status;
}
