/* Which grains are near each other: cells as large as the largest pair can reach, hashed, so that
 * memory and time grow with the number of grains however far they have flown. */
#include "base/memory.h"
#include "fdem/contact_store.h"

#include <stdlib.h>
#include <string.h>

cdem_status cdem_contact_neighbours_init(cdem_contact_neighbours *list,
                                         const cdem_contact_view *view, double skin,
                                         cdem_fault *fault) {
  double sum = 0.0;
  list->grains = view->grains;
  for (int64_t g = 0; g < view->grains; g++)
    sum += view->scale[g];
  list->length = view->grains > 0 ? skin * (sum / (double)view->grains) : 0.0;
  list->entries = 64;
  while (list->entries < 2 * view->grains)
    list->entries *= 2;
  CDEM_NEW(list->row, view->grains + 1, fault);
  CDEM_NEW(list->center, 3 * view->grains, fault);
  CDEM_NEW(list->reach, view->grains, fault);
  CDEM_NEW(list->at, view->grains, fault);
  CDEM_NEW(list->next, view->grains, fault);
  CDEM_NEW(list->head, list->entries, fault);
  return CDEM_OK;
}

void cdem_contact_neighbours_release(cdem_contact_neighbours *list) {
  free(list->row);
  free(list->other);
  free(list->center);
  free(list->reach);
  free(list->at);
  free(list->next);
  free(list->head);
}

/* Two grains that are not on the list were at least R_a + R_b + length apart. Centres have come
 * nearer by their ways, reaches have grown: as long as twice the largest sum of both is less than
 * the length, they are further apart than they reach. */
static bool outlived(const cdem_contact_neighbours *list, const double *center,
                     const double *reach) {
  double most = 0.0;
  for (int64_t g = 0; g < list->grains; g++) {
    double way[3];
    for (int c = 0; c < 3; c++)
      way[c] = center[3 * g + c] - list->center[3 * g + c];
    double used = cdem_norm3(way) + (reach[g] - list->reach[g]);
    most = used > most || !(used == used) ? used : most;
  }
  return !(2.0 * most < list->length);
}

static int64_t entry_of(const cdem_contact_neighbours *list, const int32_t at[3]) {
  uint64_t h = 0;
  for (int c = 0; c < 3; c++)
    h = (h ^ (uint32_t)at[c]) * 0x9e3779b97f4a7c15u;
  return (int64_t)((h >> 32) & (uint64_t)(list->entries - 1));
}

static void sort_into_cells(cdem_contact_neighbours *list, const double *center, double edge) {
  double low[3] = {INFINITY, INFINITY, INFINITY};
  for (int64_t g = 0; g < list->grains; g++)
    for (int c = 0; c < 3; c++)
      low[c] = fmin(low[c], center[3 * g + c]);
  for (int64_t e = 0; e < list->entries; e++)
    list->head[e] = -1;
  for (int64_t g = list->grains - 1; g >= 0; g--) {
    for (int c = 0; c < 3; c++) /* a NaN goes to 0 and is reported by whoever made it */
      list->at[g][c] = (int32_t)fmin(1e9, fmax(0.0, floor((center[3 * g + c] - low[c]) / edge)));
    int64_t entry = entry_of(list, list->at[g]);
    list->next[g] = list->head[entry];
    list->head[entry] = (int32_t)g;
  }
}

static bool near_each_other(const cdem_contact_neighbours *list, const double *center,
                            const double *reach, int64_t a, int64_t b) {
  double d[3], sum = reach[a] + reach[b] + list->length;
  for (int c = 0; c < 3; c++)
    d[c] = center[3 * a + c] - center[3 * b + c];
  return cdem_dot3(d, d) < sum * sum;
}

static cdem_status append(cdem_contact_neighbours *list, int64_t *count, int64_t from,
                          int32_t grain, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&list->other, &list->capacity, *count + 1, sizeof *list->other, fault));
  int64_t at = (*count)++;
  for (; at > from && list->other[at - 1] > grain; at--)
    list->other[at] = list->other[at - 1];
  list->other[at] = grain;
  return CDEM_OK;
}

static cdem_status build(cdem_contact_neighbours *list, const double *center, const double *reach,
                         cdem_fault *fault) {
  double most = 0.0;
  int64_t count = 0;
  list->made = false;
  for (int64_t g = 0; g < list->grains; g++)
    most = fmax(most, reach[g]);
  sort_into_cells(list, center, 2.0 * most + list->length);
  for (int64_t g = 0; g < list->grains; g++) {
    int64_t from = count;
    for (int cell = 0; cell < 27; cell++) {
      int32_t at[3] = {list->at[g][0] + cell / 9 - 1, list->at[g][1] + cell / 3 % 3 - 1,
                       list->at[g][2] + cell % 3 - 1};
      for (int32_t o = list->head[entry_of(list, at)]; o >= 0; o = list->next[o])
        if (o != g && memcmp(list->at[o], at, sizeof at) == 0 &&
            near_each_other(list, center, reach, g, o))
          CDEM_TRY(append(list, &count, from, o, fault));
    }
    list->row[g + 1] = count;
  }
  list->made = true;
  list->builds++;
  memcpy(list->center, center, 3 * (size_t)list->grains * sizeof *center);
  memcpy(list->reach, reach, (size_t)list->grains * sizeof *reach);
  return CDEM_OK;
}

cdem_status cdem_contact_neighbours_update(cdem_contact_neighbours *list, const double *center,
                                           const double *reach, cdem_fault *fault) {
  if (list->made && !outlived(list, center, reach))
    return CDEM_OK;
  return build(list, center, reach, fault);
}
