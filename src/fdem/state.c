/* Checkpoints: what changes while the grains move. */
#include "base/quaternion.h"
#include "fdem/confine.h"

#include <stdlib.h>
#include <string.h>

enum { NUMBERS = 13 };

/* The loose numbers, either way. */
static void walk(cdem_fdem *fdem, double value[NUMBERS], bool save) {
  cdem_fdem_store *s = fdem->store;
  double *const at[] = {&fdem->time,         &fdem->step,       &s->kick,
                        &s->base_time,       &s->sums.damping,  &s->sums.numerical,
                        &s->contact.normal,  &s->contact.shear, &s->contact.friction,
                        &s->contact.damping, &s->contact.walls, &s->initial,
                        &s->exchange};
  for (size_t i = 0; i < sizeof at / sizeof *at; i++)
    if (save)
      value[i] = *at[i];
    else
      *at[i] = value[i];
}

typedef struct {
  const char *name;
  int64_t count;
  double *data;
} field;
enum { FIELDS = 11 };

static void fields_of(const cdem_fdem_store *s, field out[FIELDS]) {
  const field all[FIELDS] = {{"fdem/center", 3 * s->grains, s->center},
                             {"fdem/quaternion", 4 * s->grains, s->quaternion},
                             {"fdem/velocity", 3 * s->grains, s->velocity},
                             {"fdem/momentum", 3 * s->grains, s->momentum},
                             {"fdem/start", 3 * s->grains, s->start},
                             {"fdem/stiff", s->grains, s->stiff},
                             {"fdem/amplitude", s->amplitudes, s->q},
                             {"fdem/rate", s->amplitudes, s->rate},
                             {"fdem/before", 3 * s->nodes, s->before},
                             {"fdem/force", 3 * s->nodes, s->force},
                             {"fdem/wall_force", 3 * (int64_t)s->options.walls, s->wall_force}};
  memcpy(out, all, sizeof all);
}

static cdem_status save_walls(const cdem_fdem_store *s, cdem_state *state, cdem_fault *fault) {
  int walls = s->options.walls;
  double *motion = NULL;
  CDEM_NEW(motion, (int64_t)CDEM_WALL_RECORD * walls, fault);
  for (int w = 0; w < walls; w++)
    cdem_wall_body_record(s->wall + w, motion + (int64_t)CDEM_WALL_RECORD * w, true);
  cdem_status status = cdem_state_add_copy(state, "fdem/walls", CDEM_ARRAY_REAL,
                                           (int64_t)CDEM_WALL_RECORD * walls, motion, fault);
  free(motion);
  CDEM_TRY(status);
  return cdem_state_add(state, "fdem/wall_stiff", CDEM_ARRAY_REAL, walls, s->wall_stiff, fault);
}

cdem_status cdem_fdem_save(const cdem_fdem *fdem, cdem_state *state, cdem_fault *fault) {
  const cdem_fdem_store *s = fdem->store;
  cdem_fdem copy = *fdem;
  double number[NUMBERS] = {0.0};
  field all[FIELDS];
  const int64_t count[2] = {fdem->steps, s->base_steps};
  walk(&copy, number, true);
  fields_of(s, all);
  CDEM_TRY(cdem_state_add_copy(state, "fdem/numbers", CDEM_ARRAY_REAL, NUMBERS, number, fault));
  CDEM_TRY(cdem_state_add_copy(state, "fdem/steps", CDEM_ARRAY_INT64, 2, count, fault));
  for (int i = 0; i < FIELDS; i++)
    CDEM_TRY(cdem_state_add(state, all[i].name, CDEM_ARRAY_REAL, all[i].count, all[i].data, fault));
  CDEM_TRY(save_walls(s, state, fault));
  if (s->confine != NULL)
    CDEM_TRY(cdem_fdem_confine_save(s, state, fault));
  return cdem_fdem_contacts_save(s->contacts, state, fault);
}

static cdem_status restore_walls(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  int walls = s->options.walls;
  double *motion = NULL;
  CDEM_TRY(cdem_state_get(state, "fdem/wall_stiff", CDEM_ARRAY_REAL, walls, s->wall_stiff, fault));
  CDEM_NEW(motion, (int64_t)CDEM_WALL_RECORD * walls, fault);
  cdem_status status = cdem_state_get(state, "fdem/walls", CDEM_ARRAY_REAL,
                                      (int64_t)CDEM_WALL_RECORD * walls, motion, fault);
  for (int w = 0; w < walls && status == CDEM_OK; w++) {
    cdem_wall_body_record(s->wall + w, motion + (int64_t)CDEM_WALL_RECORD * w, false);
    cdem_wall_place(s->wall + w, fdem->time);
  }
  free(motion);
  return status;
}

cdem_status cdem_fdem_restore(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  double number[NUMBERS];
  field all[FIELDS];
  int64_t count[2];
  fields_of(s, all);
  CDEM_TRY(cdem_state_get(state, "fdem/numbers", CDEM_ARRAY_REAL, NUMBERS, number, fault));
  CDEM_TRY(cdem_state_get(state, "fdem/steps", CDEM_ARRAY_INT64, 2, count, fault));
  for (int i = 0; i < FIELDS; i++)
    CDEM_TRY(cdem_state_get(state, all[i].name, CDEM_ARRAY_REAL, all[i].count, all[i].data, fault));
  CDEM_REQUIRE(number[0] >= 0.0 && number[1] > 0.0 && count[0] >= 0 && count[0] < INT64_MAX / 2 &&
                   count[1] >= 0 && count[1] <= count[0],
               fault, CDEM_INPUT,
               "the checkpoint stands at t = %g s after %lld steps of %g s, which cannot be; it "
               "does not belong to this case",
               number[0], (long long)count[0], number[1]);
  walk(fdem, number, false);
  fdem->steps = count[0];
  s->base_steps = count[1];
  for (int64_t g = 0; g < s->grains; g++)
    cdem_quaternion_matrix(s->quaternion + 4 * g, s->turn + 9 * g);
  for (int32_t b = 0; b < s->blocks; b++)
    cdem_fdem_place_block(s, b, s->work);
  /* Placing took `now` for `before`. */
  for (int i = 0; i < FIELDS; i++)
    if (all[i].data == s->before)
      CDEM_TRY(cdem_state_get(state, all[i].name, CDEM_ARRAY_REAL, all[i].count, s->before, fault));
  cdem_contact_view view = cdem_fdem_contact_view(s, fdem->step);
  CDEM_TRY(cdem_fdem_contacts_restore(s->contacts, &view, state, fault));
  if (s->confine != NULL)
    CDEM_TRY(cdem_fdem_confine_restore(fdem, state, fault));
  return restore_walls(fdem, state, fault);
}
