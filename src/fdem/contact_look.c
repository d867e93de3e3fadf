/* What touches what now, for those who ask. */
#include "base/memory.h"
#include "fdem/contact_store.h"

cdem_status cdem_fdem_contacts_list(const cdem_fdem_contacts *contacts,
                                    const cdem_contact_view *view, int64_t *touches,
                                    cdem_fdem_touch **touch, cdem_fault *fault) {
  int64_t count = 0, at = 0;
  for (int64_t g = 0; g < contacts->grains; g++)
    count += contacts->row[g].count;
  cdem_fdem_touch *list;
  CDEM_NEW(list, count, fault);
  for (int64_t g = 0; g < contacts->grains; g++)
    for (int32_t k = 0; k < contacts->row[g].count; k++) {
      const cdem_node_touch *t = contacts->row[g].item + k;
      cdem_fdem_touch *out = list + at++;
      out->grain = (int32_t)g;
      out->node = t->node;
      out->partner = t->partner;
      out->push = t->push;
      out->depth = t->depth;
      for (int c = 0; c < 3; c++) {
        out->point[c] = view->now[3 * (view->first[g] + t->node) + c];
        out->normal[c] = -t->normal[c];
        out->force[c] = t->force[c];
      }
    }
  *touches = count;
  *touch = list;
  return CDEM_OK;
}

static bool names(const cdem_touch_row *row, int64_t partner) {
  for (int32_t k = 0; k < row->count; k++)
    if (row->item[k].partner == partner)
      return true;
  return false;
}

void cdem_fdem_contacts_count(const cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                              int32_t *count) {
  const cdem_contact_neighbours *list = &contacts->list;
#pragma omp parallel for schedule(static) num_threads(contacts->threads)
  for (int64_t g = 0; g < contacts->grains; g++) {
    const cdem_touch_row *row = contacts->row + g;
    count[g] = 0;
    for (int64_t j = list->row[g]; j < list->row[g + 1]; j++)
      count[g] += names(row, list->other[j]) || names(contacts->row + list->other[j], g);
    for (int w = 0; row->walls > 0 && w < view->walls; w++)
      count[g] += names(row, -1 - w);
  }
}
