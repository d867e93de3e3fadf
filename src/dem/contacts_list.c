/* Contacts as a list for reports: by ids, ordered by a, then b. */
#include "base/sort.h"
#include "dem/solver_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const cdem_dem_store *store;
  int64_t count, capacity;
  cdem_dem_contact *contact;
  cdem_status status;
  cdem_fault *fault;
} list;

static cdem_dem_contact *append(list *l) {
  if (l->status == CDEM_OK)
    l->status = cdem_grow(&l->contact, &l->capacity, l->count + 1, sizeof *l->contact, l->fault);
  if (l->status != CDEM_OK)
    return NULL;
  cdem_dem_contact *contact = &l->contact[l->count++];
  *contact = (cdem_dem_contact){0};
  return contact;
}

/* Seen from the grain with the lower id: b, at y; a is at x. In a cell the point goes with it to
 * the other side: x + branch is the image of b that a touches. */
static void turn_around(cdem_dem_contact *c, const double *x, const double *y) {
  int32_t a = c->a;
  c->a = c->b;
  c->b = a;
  for (int k = 0; k < 3; k++) {
    c->point[k] = y[k] + (c->point[k] - x[k] - c->branch[k]);
    c->normal[k] = -c->normal[k];
    c->branch[k] = -c->branch[k];
    c->force[k] = -c->force[k];
    c->moment[k] = -c->moment[k];
  }
}

/* At the bound: laws cut the force back to it, so that both agree to rounding. */
static bool slides(const cdem_dem_visit *visit, int k, int32_t a, int32_t b) {
  const cdem_batch *batch = &visit->work->batch;
  const cdem_dem_options *o = &visit->dem->store->options;
  const cdem_law *law = visit->model->law;
  double friction = o->contact[a * o->materials + b].value[CDEM_LAW_friction], t2 = 0.0;
  for (int c = 0; c < (visit->dem->dim == 3 ? 3 : 1); c++)
    t2 += batch->shear[c][k] * batch->shear[c][k];
  double held =
      law->sliding != NULL ? fabs(law->sliding(&visit->model->parameters[0], batch, k)) : sqrt(t2);
  return friction > 0.0 && batch->normal[k] > 0.0 &&
         held >= (1.0 - 1e-9) * friction * batch->normal[k];
}

static void see(void *context, const cdem_dem_visit *visit) {
  list *l = context;
  const cdem_dem_store *s = l->store;
  const cdem_batch *b = &visit->work->batch;
  bool solid = s->dim == 3;
  for (int k = 0; k < visit->count; k++) {
    cdem_dem_contact *c = append(l);
    if (c == NULL)
      return;
    int32_t i = visit->wall ? visit->work->wall_grain[visit->touch[k]]
                            : s->core->pair_owner[visit->pair[k]];
    const double *x = cdem_place(s, i);
    c->a = s->id[i];
    c->overlap = b->overlap[k];
    c->push = b->normal[k];
    c->sliding = slides(visit, k, s->material[i],
                        visit->wall ? visit->work->wall_touch[visit->touch[k]].material
                                    : s->material[s->pair_other[visit->pair[k]]]);
    double reach = visit->wall ? x[3] - b->overlap[k] : b->arm[0][k];
    for (int d = 0; d < 3; d++) {
      c->normal[d] = d < s->dim ? b->n[d][k] : 0.0;
      c->force[d] = visit->work->row_a[k][d];
      c->moment[d] = solid ? b->moment[d][k] : d == 2 ? b->moment[0][k] : 0.0;
      c->point[d] = x[d] + reach * c->normal[d];
    }
    if (visit->wall) {
      const cdem_wall_touch *t = &visit->work->wall_touch[visit->touch[k]];
      c->b = -1 - t->wall;
      for (int d = 0; d < 3; d++)
        c->branch[d] = c->point[d] - x[d];
      continue;
    }
    const double *y = cdem_place(s, s->pair_other[visit->pair[k]]);
    c->b = s->id[s->pair_other[visit->pair[k]]];
    for (int d = 0; d < 3; d++)
      c->branch[d] = (x[3] + y[3] - c->overlap) * c->normal[d];
    if (visit->model->arms_by_radius)
      for (int d = 0; d < 3; d++)
        c->point[d] = x[d] + c->branch[d] * (x[3] / (x[3] + y[3]));
    if (c->a > c->b)
      turn_around(c, x, y);
  }
}

static void add_bonds(const cdem_dem *dem, list *l) {
  const cdem_dem_store *s = dem->store;
  for (int64_t b = 0; b < s->core->bonds; b++) {
    cdem_bond_state bond = s->core->bond[b];
    cdem_bond_forces f;
    cdem_dem_contact *c = bond.holds ? append(l) : NULL;
    if (c == NULL)
      continue;
    cdem_bond_evaluate(dem, &bond, 0.0, &f, NULL);
    const double *x = cdem_place(s, bond.owner), *y = cdem_place(s, bond.other);
    *c = (cdem_dem_contact){.a = bond.id[0],
                            .b = bond.id[1],
                            .overlap = x[3] + y[3] - f.length,
                            .push = f.push,
                            .bonded = true};
    for (int d = 0; d < 3; d++) {
      c->normal[d] = f.n[d];
      c->force[d] = f.force[d];
      c->moment[d] = f.moment[d];
      c->branch[d] = f.length * f.n[d];
      c->point[d] = x[d] + f.arm[0] * f.n[d];
    }
    if (c->a > c->b)
      turn_around(c, x, y);
  }
}

static int by_ids(const void *left, const void *right) {
  const cdem_dem_contact *p = left, *q = right;
  if (p->a != q->a)
    return p->a < q->a ? -1 : 1;
  if (p->b != q->b)
    return p->b < q->b ? -1 : 1;
  for (int k = 0; k < 3; k++) /* two images of one grain; two touches of one wall */
    if (p->normal[k] != q->normal[k])
      return p->normal[k] < q->normal[k] ? -1 : 1;
  return 0;
}

cdem_status cdem_dem_contacts(const cdem_dem *dem, int64_t *contacts, cdem_dem_contact **contact,
                              cdem_fault *fault) {
  list l = {.store = dem->store, .fault = fault};
  *contacts = 0;
  *contact = NULL;
  cdem_dem_visit_all(dem, see, &l);
  double *motion = cdem_dem_as_seen(dem);
  if (l.status == CDEM_OK)
    add_bonds(dem, &l);
  dem->store->motion = motion;
  if (l.status == CDEM_OK && l.contact == NULL) {
    l.contact = cdem_allocate(0, sizeof *l.contact, fault);
    l.status = l.contact != NULL ? CDEM_OK : CDEM_MEMORY;
  }
  if (l.status != CDEM_OK) {
    free(l.contact);
    return l.status;
  }
  cdem_sort(l.contact, l.count, sizeof *l.contact, by_ids);
  *contacts = l.count;
  *contact = l.contact;
  return CDEM_OK;
}
