/* Touches as they are, springs and forces, into a state and out of it. Lists of neighbours are not
 * kept: no result depends on them. */
#include "base/memory.h"
#include "fdem/contact_store.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { IDS = 6, NUMBERS = 30 };
/* From the weights on a touch is numbers only. */
static const size_t numbers_at = offsetof(cdem_node_touch, weight);
_Static_assert(sizeof(cdem_node_touch) ==
                   offsetof(cdem_node_touch, weight) + NUMBERS * sizeof(double),
               "a touch has other numbers");

typedef struct {
  int32_t *id;
  double *number;
} saved;

static void saved_release(saved *v) {
  free(v->id);
  free(v->number);
}

static cdem_status pack(const cdem_fdem_contacts *contacts, int64_t count, saved *v,
                        cdem_fault *fault) {
  int64_t at = 0;
  CDEM_NEW(v->id, IDS * count, fault);
  CDEM_NEW(v->number, NUMBERS * count, fault);
  for (int64_t g = 0; g < contacts->grains; g++)
    for (int32_t k = 0; k < contacts->row[g].count; k++, at++) {
      const cdem_node_touch *t = contacts->row[g].item + k;
      const int32_t id[IDS] = {(int32_t)g,   t->node,      t->partner,
                               t->corner[0], t->corner[1], t->corner[2]};
      memcpy(v->id + IDS * at, id, sizeof id);
      memcpy(v->number + NUMBERS * at, (const char *)t + numbers_at, NUMBERS * sizeof(double));
    }
  return CDEM_OK;
}

cdem_status cdem_fdem_contacts_save(const cdem_fdem_contacts *contacts, cdem_state *state,
                                    cdem_fault *fault) {
  saved v = {0};
  int64_t count = 0;
  for (int64_t g = 0; g < contacts->grains; g++)
    count += contacts->row[g].count;
  cdem_status status = pack(contacts, count, &v, fault);
  if (status == CDEM_OK)
    status = cdem_state_add_copy(state, "contact/ids", CDEM_ARRAY_INT32, IDS * count, v.id, fault);
  if (status == CDEM_OK)
    status = cdem_state_add_copy(state, "contact/numbers", CDEM_ARRAY_REAL, NUMBERS * count,
                                 v.number, fault);
  saved_release(&v);
  return status;
}

/* ---- restoring ---- */

static int64_t nodes_of(const cdem_contact_view *view, int64_t grain) {
  return view->first[grain + 1] - view->first[grain];
}

static bool can_be(const cdem_contact_view *view, const int32_t id[IDS]) {
  if (id[0] < 0 || id[0] >= view->grains || id[1] < 0 || id[1] >= nodes_of(view, id[0]) ||
      id[2] >= view->grains || id[2] < -view->walls || id[2] == id[0])
    return false;
  for (int k = 3; k < IDS && id[2] >= 0; k++)
    if (id[k] < 0 || id[k] >= nodes_of(view, id[2]))
      return false;
  return true;
}

/* By grain and node, grains before walls. */
static bool in_order(const int32_t before[IDS], const int32_t id[IDS]) {
  if (before[0] != id[0] || before[1] != id[1])
    return before[0] < id[0] || (before[0] == id[0] && before[1] < id[1]);
  return before[2] >= 0 && id[2] < 0;
}

static cdem_status unpack(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                          int64_t count, const saved *v, cdem_fault *fault) {
  for (int64_t k = 0; k < count; k++)
    CDEM_REQUIRE(can_be(view, v->id + IDS * k) &&
                     (k == 0 || in_order(v->id + IDS * (k - 1), v->id + IDS * k)),
                 fault, CDEM_INPUT,
                 "the saved contacts name grain %" PRId32 ", node %" PRId32 ", partner %" PRId32
                 ", which cannot be here; the checkpoint does not belong to this case",
                 v->id[IDS * k], v->id[IDS * k + 1], v->id[IDS * k + 2]);
  for (int64_t g = 0; g < contacts->grains; g++)
    contacts->row[g].count = contacts->row[g].walls = 0;
  for (int64_t k = 0; k < count; k++) {
    const int32_t *id = v->id + IDS * k;
    cdem_touch_row *row = contacts->row + id[0];
    CDEM_TRY(cdem_grow(&row->item, &row->capacity, row->count + 1, sizeof *row->item, fault));
    cdem_node_touch *t = row->item + row->count++;
    t->node = id[1];
    t->partner = id[2];
    memcpy(t->corner, id + 3, sizeof t->corner);
    memcpy((char *)t + numbers_at, v->number + NUMBERS * k, NUMBERS * sizeof(double));
    row->walls += t->partner < 0;
  }
  return CDEM_OK;
}

cdem_status cdem_fdem_contacts_restore(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                                       const cdem_state *state, cdem_fault *fault) {
  saved v = {0};
  int64_t ids = 0, numbers = 0;
  cdem_status status = cdem_state_take(state, "contact/ids", CDEM_ARRAY_INT32, &ids, &v.id, fault);
  if (status == CDEM_OK)
    status = cdem_state_take(state, "contact/numbers", CDEM_ARRAY_REAL, &numbers, &v.number, fault);
  if (status == CDEM_OK && (ids % IDS != 0 || numbers != NUMBERS * (ids / IDS)))
    status = cdem_fail(fault, CDEM_INPUT,
                       "the saved contacts have %" PRId64 " ids and %" PRId64
                       " numbers, %d and %d to each; the checkpoint does not belong to this case",
                       ids, numbers, IDS, NUMBERS);
  if (status == CDEM_OK)
    status = unpack(contacts, view, ids / IDS, &v, fault);
  if (status == CDEM_OK)
    status = cdem_contacts_reach(contacts, view, fault);
  saved_release(&v);
  return status;
}
