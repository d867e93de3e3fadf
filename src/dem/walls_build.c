/* Which grains are near which walls, and the history of those that touch, carried over. */
#include "base/memory.h"
#include "dem/walls_store.h"

#include <string.h>

cdem_status cdem_wall_list_add(cdem_wall_list *list, int32_t grain, int32_t wall, int32_t facet,
                               cdem_fault *fault) {
  if (list->count == list->capacity)
    CDEM_TRY(cdem_grow(&list->item, &list->capacity, list->count + 1, sizeof *list->item, fault));
  list->item[list->count++] = (cdem_wall_candidate){grain, wall, facet};
  return CDEM_OK;
}

/* A wall of one piece against all grains. */
static cdem_status collect(const cdem_dem_store *s, int32_t w, cdem_wall_list *list,
                           cdem_fault *fault) {
  const cdem_wall_body *body = s->walls->body + w;
  cdem_wall_near near;
  for (int64_t i = 0; i < s->grains; i++) {
    const double *x = cdem_place(s, i);
    if (body->kind->nearest(body, x, x[3] + 0.5 * s->skin, &near))
      CDEM_TRY(cdem_wall_list_add(list, (int32_t)i, w, 0, fault));
  }
  return CDEM_OK;
}

/* Grains anywhere may be reached by an endless wall that tilts. */
void cdem_wall_set_reach(const cdem_dem_store *s, cdem_wall_body *body) {
  double square = 0.0;
  body->reach = 0.0;
  if (body->turning == CDEM_WALL_STILL)
    return;
  for (int64_t i = 0; i < s->grains; i++) {
    const double *x = cdem_place(s, i);
    double p[3] = {x[0] - body->built_center[0], x[1] - body->built_center[1],
                   x[2] - body->built_center[2]};
    square = fmax(square, cdem_dot3(p, p));
  }
  body->reach = sqrt(square) + s->skin;
}

/* ---- rows and slots ---- */

static cdem_status make_room(cdem_wall_slots *slots, int64_t count, int histories, bool meshes,
                             cdem_fault *fault) {
  int64_t capacity[6];
  for (int k = 0; k < 6; k++)
    capacity[k] = slots->capacity;
  if (count <= slots->capacity && slots->wall != NULL)
    return CDEM_OK;
  CDEM_TRY(cdem_grow(&slots->wall, capacity, count, sizeof *slots->wall, fault));
  CDEM_TRY(cdem_grow(&slots->facet, capacity + 1, count, sizeof *slots->facet, fault));
  CDEM_TRY(cdem_grow(&slots->id, capacity + 2, count, sizeof *slots->id, fault));
  CDEM_TRY(cdem_grow(&slots->touch, capacity + 3, count, sizeof *slots->touch, fault));
  if (meshes)
    CDEM_TRY(cdem_grow(&slots->last, capacity + 4, count, 3 * sizeof *slots->last, fault));
  if (histories > 0)
    CDEM_TRY(cdem_grow(&slots->history, capacity + 5, count,
                       (size_t)histories * sizeof *slots->history, fault));
  slots->capacity = capacity[0];
  return CDEM_OK;
}

cdem_status cdem_walls_arrange(cdem_dem_store *s, const cdem_wall_list *list, cdem_fault *fault) {
  cdem_walls *walls = s->walls;
  CDEM_REQUIRE(list->count < INT32_MAX, fault, CDEM_INPUT,
               "the walls have more than %d facets near grains; use coarser surfaces", INT32_MAX);
  CDEM_TRY(make_room(&walls->old, list->count, s->histories, walls->meshes, fault));
  cdem_wall_slots swap = walls->old;
  walls->old = walls->slots;
  walls->slots = swap;
  memset(walls->fill, 0, (size_t)(s->grains + 1) * sizeof *walls->fill);
  for (int64_t k = 0; k < list->count; k++)
    walls->fill[list->item[k].grain]++;
  walls->row[0] = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    walls->row[i + 1] = walls->row[i] + walls->fill[i];
    walls->fill[i] = walls->row[i];
  }
  for (int64_t k = 0; k < list->count; k++) {
    const cdem_wall_candidate *c = list->item + k;
    int32_t slot = walls->fill[c->grain]++;
    walls->slots.wall[slot] = c->wall;
    walls->slots.facet[slot] = c->facet;
    walls->slots.id[slot] = s->id[c->grain];
    walls->slots.touch[slot] = 0;
  }
  walls->slots.count = list->count;
  return CDEM_OK;
}

/* Histories go to the candidate of the same grain, wall and facet. A contact that touched at the
 * last force evaluation is at most one step from it and so within the skin. */
static void carry_over(cdem_dem_store *s) {
  cdem_walls *walls = s->walls;
  const cdem_wall_slots *from = &walls->old;
  cdem_wall_slots *to = &walls->slots;
  for (int64_t k = 0; k < from->count; k++) {
    if (from->touch[k] == 0)
      continue;
    int32_t i = s->slot[from->id[k]];
    for (int32_t slot = walls->row[i]; slot < walls->row[i + 1]; slot++) {
      if (to->wall[slot] != from->wall[k] || to->facet[slot] != from->facet[k])
        continue;
      to->touch[slot] = 1;
      if (s->histories > 0)
        memcpy(to->history + (int64_t)s->histories * slot,
               from->history + (int64_t)s->histories * k,
               (size_t)s->histories * sizeof *to->history);
      if (walls->meshes)
        memcpy(to->last + 3 * (int64_t)slot, from->last + 3 * k, 3 * sizeof *to->last);
      break;
    }
  }
}

cdem_status cdem_walls_build(cdem_dem_store *s, cdem_fault *fault) {
  cdem_walls *walls = s->walls;
  if (walls == NULL)
    return CDEM_OK;
  walls->list.count = 0;
  for (int32_t w = 0; w < walls->walls; w++) {
    cdem_wall_body *body = walls->body + w;
    if (body->wall.stop == 0.0 || walls->time < body->wall.stop) {
      if (body->kind->collect != NULL)
        CDEM_TRY(body->kind->collect(s, w, &walls->list, fault));
      else
        CDEM_TRY(collect(s, w, &walls->list, fault));
    }
    cdem_wall_keep_built(body);
    cdem_wall_set_reach(s, body);
  }
  CDEM_TRY(cdem_walls_arrange(s, &walls->list, fault));
  carry_over(s);
  return CDEM_OK;
}
