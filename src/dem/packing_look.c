/* How the grains of a packing stand to each other. */
#include "dem/packing.h"
#include "dem/packing_grid.h"

#include <stdlib.h>

typedef struct {
  cdem_packing_grid grid;
  cdem_packing_list list;
} view;

static void note(const cdem_grains *grains, int64_t i, const cdem_packing_near *other, double near,
                 cdem_packing_contacts *contacts) {
  const double *x = grains->xyz + 3 * i;
  double way[3];
  for (int c = 0; c < 3; c++)
    way[c] = other->place[c] - x[c];
  double smaller = fmin(grains->radius[i], other->radius);
  double overlap = (grains->radius[i] + other->radius - cdem_norm3(way)) / smaller;
  if (overlap > -near)
    contacts->coordination += 1.0;
  if (overlap > contacts->overlap) {
    contacts->overlap = overlap;
    contacts->pair[0] = i;
    contacts->pair[1] = other->grain;
  }
}

static cdem_status look(const cdem_grains *grains, double near, view *v,
                        cdem_packing_contacts *contacts, cdem_fault *fault) {
  for (int64_t i = 0; i < grains->grains; i++)
    CDEM_TRY(cdem_packing_grid_add(&v->grid, i, fault));
  for (int64_t i = 0; i < grains->grains; i++) {
    const double *x = grains->xyz + 3 * i;
    double reach = grains->radius[i] * (1.0 + fmax(near, 0.0));
    CDEM_TRY(cdem_packing_grid_near(&v->grid, x, reach, &v->list, fault));
    for (int64_t k = 0; k < v->list.count; k++)
      if (v->list.near[k].grain != (int32_t)i)
        note(grains, i, &v->list.near[k], near, contacts);
  }
  contacts->coordination /= (double)grains->grains;
  return CDEM_OK;
}

cdem_status cdem_packing_look(const cdem_grains *grains, const double low[3], const double high[3],
                              const bool periodic[3], double near, cdem_packing_contacts *contacts,
                              cdem_fault *fault) {
  double sizes[2] = {INFINITY, 0.0};
  view v = {0};
  *contacts = (cdem_packing_contacts){.overlap = -INFINITY, .pair = {-1, -1}};
  CDEM_TRY(cdem_grains_check(grains, fault));
  for (int64_t i = 0; i < grains->grains; i++) {
    sizes[0] = fmin(sizes[0], grains->radius[i]);
    sizes[1] = fmax(sizes[1], grains->radius[i]);
  }
  CDEM_TRY(
      cdem_packing_grid_init(&v.grid, grains, low, high, periodic, sizes, grains->grains, fault));
  cdem_status status = look(grains, near, &v, contacts, fault);
  cdem_packing_grid_release(&v.grid);
  free(v.list.near);
  return status;
}
