/* Saving and restoring what changes of walls: motion, candidates and histories.
 *
 * Candidates are saved by the id of their grain, with the pose at which they were found, so that a
 * restored solver rebuilds its lists when the unbroken one does. Functions of cdem_walls_move are
 * borrowed and not in a state: who restores into a later phase calls it first. */
#include "base/memory.h"
#include "dem/wall_mesh.h"

#include <stdlib.h>
#include <string.h>

/* What a body has to keep, one number after the other. `pack`: into the record, else out of it. */
enum { MOTION = 48 };
typedef struct {
  double *record;
  bool pack;
} walker;

static void walk(walker *w, double *value, int count) {
  if (w->pack)
    memcpy(w->record, value, (size_t)count * sizeof *value);
  else
    memcpy(value, w->record, (size_t)count * sizeof *value);
  w->record += count;
}

static void walk_body(cdem_wall_body *body, double *record, bool pack) {
  walker w = {record, pack};
  walk(&w, body->center, 3);
  walk(&w, body->velocity, 3);
  walk(&w, body->spin, 3);
  walk(&w, body->quaternion, 4);
  walk(&w, body->path, 3);
  walk(&w, &body->since, 1);
  walk(&w, body->path_since, 3);
  walk(&w, body->quaternion_since, 4);
  walk(&w, &body->servo_path, 1);
  walk(&w, &body->servo_speed, 1);
  walk(&w, body->built_center, 3);
  walk(&w, body->built_turn, 9);
  walk(&w, &body->reach, 1);
  walk(&w, &body->wall.radius, 1);
  walk(&w, &body->radius_speed, 1);
  walk(&w, &body->built_radius, 1);
}

/* ---- saving ---- */

typedef struct {
  double *motion, *real;
  int32_t *id;
  uint8_t *touch;
} saved;

static void saved_release(saved *v) {
  free(v->motion);
  free(v->real);
  free(v->id);
  free(v->touch);
}

static int reals(const cdem_dem_store *s) {
  return s->histories + (s->walls->meshes ? 3 : 0);
}

static cdem_status pack(const cdem_dem_store *s, saved *v, cdem_fault *fault) {
  const cdem_walls *walls = s->walls;
  const cdem_wall_slots *slots = &walls->slots;
  CDEM_NEW(v->motion, (int64_t)MOTION * walls->walls + 1, fault);
  CDEM_NEW(v->id, 3 * slots->count, fault);
  CDEM_NEW(v->touch, slots->count, fault);
  CDEM_NEW(v->real, reals(s) * slots->count, fault);
  for (int w = 0; w < walls->walls; w++)
    walk_body(walls->body + w, v->motion + (size_t)MOTION * (size_t)w, true);
  v->motion[(size_t)MOTION * (size_t)walls->walls] = walls->time;
  double *real = v->real;
  for (int64_t k = 0; k < slots->count; k++) {
    v->id[3 * k] = slots->id[k];
    v->id[3 * k + 1] = slots->wall[k];
    v->id[3 * k + 2] = slots->facet[k];
    v->touch[k] = slots->touch[k];
    /* What an unused slot holds is nobody's. */
    if (slots->touch[k] != 0) {
      if (s->histories > 0)
        memcpy(real, slots->history + (int64_t)s->histories * k,
               (size_t)s->histories * sizeof *real);
      if (walls->meshes)
        memcpy(real + s->histories, slots->last + 3 * k, 3 * sizeof *real);
    }
    real += reals(s);
  }
  return CDEM_OK;
}

cdem_status cdem_walls_save(const cdem_dem_store *s, cdem_state *state, cdem_fault *fault) {
  saved v = {0};
  if (s->walls == NULL)
    return CDEM_OK;
  int64_t count = s->walls->slots.count;
  cdem_status status = pack(s, &v, fault);
  if (status == CDEM_OK)
    status = cdem_state_add_copy(state, "walls/motion", CDEM_ARRAY_REAL,
                                 (int64_t)MOTION * s->walls->walls + 1, v.motion, fault);
  if (status == CDEM_OK)
    status =
        cdem_state_add_copy(state, "walls/candidates", CDEM_ARRAY_INT32, 3 * count, v.id, fault);
  if (status == CDEM_OK)
    status = cdem_state_add_copy(state, "walls/touch", CDEM_ARRAY_BYTE, count, v.touch, fault);
  if (status == CDEM_OK)
    status = cdem_state_add_copy(state, "walls/history", CDEM_ARRAY_REAL, reals(s) * count, v.real,
                                 fault);
  saved_release(&v);
  return status;
}

/* ---- restoring ---- */

static bool is_candidate(const cdem_dem_store *s, const int32_t id[3]) {
  if (id[0] < 0 || id[0] >= s->grains || id[1] < 0 || id[1] >= s->walls->walls || id[2] < 0)
    return false;
  const cdem_wall_facets *facets = s->walls->body[id[1]].facets;
  return id[2] < (facets != NULL ? facets->facets : 1);
}

static cdem_status unpack(cdem_dem_store *s, int64_t count, const saved *v, cdem_fault *fault) {
  cdem_walls *walls = s->walls;
  cdem_wall_slots *slots = &walls->slots;
  walls->list.count = 0;
  for (int64_t k = 0; k < count; k++) {
    const int32_t *id = v->id + 3 * k;
    CDEM_REQUIRE(is_candidate(s, id), fault, CDEM_INPUT,
                 "the saved state of the walls names grain %d, wall %d, facet %d, which this case "
                 "has not; the checkpoint does not belong to this case",
                 id[0], id[1], id[2]);
    CDEM_TRY(cdem_wall_list_add(&walls->list, s->slot[id[0]], id[1], id[2], fault));
  }
  CDEM_TRY(cdem_walls_arrange(s, &walls->list, fault));
  for (int32_t i = 0; i <= s->grains; i++)
    walls->fill[i] = walls->row[i];
  for (int64_t k = 0; k < count; k++) {
    int32_t slot = walls->fill[walls->list.item[k].grain]++;
    const double *real = v->real + reals(s) * k;
    slots->touch[slot] = v->touch[k];
    if (s->histories > 0)
      memcpy(slots->history + (int64_t)s->histories * slot, real,
             (size_t)s->histories * sizeof *real);
    if (walls->meshes)
      memcpy(slots->last + 3 * (int64_t)slot, real + s->histories, 3 * sizeof *real);
  }
  for (int w = 0; w < walls->walls; w++)
    walk_body(walls->body + w, v->motion + (size_t)MOTION * (size_t)w, false);
  walls->time = v->motion[(size_t)MOTION * (size_t)walls->walls];
  for (int w = 0; w < walls->walls; w++)
    cdem_wall_place(walls->body + w, walls->time);
  return CDEM_OK;
}

cdem_status cdem_walls_restore(cdem_dem_store *s, const cdem_state *state, cdem_fault *fault) {
  saved v = {0};
  int64_t ids = 0, count = 0;
  if (s->walls == NULL)
    return CDEM_OK;
  int64_t motion = (int64_t)MOTION * s->walls->walls + 1;
  cdem_status status =
      cdem_state_take(state, "walls/candidates", CDEM_ARRAY_INT32, &ids, &v.id, fault);
  count = ids / 3;
  v.motion = cdem_allocate(motion, sizeof *v.motion, fault);
  v.touch = cdem_allocate(count, sizeof *v.touch, fault);
  v.real = cdem_allocate(reals(s) * count, sizeof *v.real, fault);
  if (status == CDEM_OK && (v.motion == NULL || v.touch == NULL || v.real == NULL))
    status = CDEM_MEMORY;
  if (status == CDEM_OK)
    status = cdem_state_get(state, "walls/motion", CDEM_ARRAY_REAL, motion, v.motion, fault);
  if (status == CDEM_OK)
    status = cdem_state_get(state, "walls/touch", CDEM_ARRAY_BYTE, count, v.touch, fault);
  if (status == CDEM_OK)
    status =
        cdem_state_get(state, "walls/history", CDEM_ARRAY_REAL, reals(s) * count, v.real, fault);
  if (status == CDEM_OK)
    status = unpack(s, count, &v, fault);
  saved_release(&v);
  return status;
}
