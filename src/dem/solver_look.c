#include "dem/solver_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const cdem_dem_store *store;
  int32_t *count;
  double force;
  int64_t contacts;
} tally;

static void count_batch(void *context, const cdem_dem_visit *visit) {
  tally *t = context;
  const cdem_dem_store *s = t->store;
  for (int k = 0; k < visit->count; k++) {
    t->force += cdem_norm3(visit->work->row_a[k]);
    t->contacts++;
    if (t->count == NULL)
      continue;
    if (visit->wall) {
      t->count[s->id[visit->work->wall_grain[visit->touch[k]]]]++;
      continue;
    }
    t->count[s->id[s->core->pair_owner[visit->pair[k]]]]++;
    t->count[s->id[s->pair_other[visit->pair[k]]]]++;
  }
}

static void tally_all(const cdem_dem *dem, tally *t) {
  const cdem_dem_core *core = dem->store->core;
  cdem_dem_visit_all(dem, count_batch, t);
  double *motion = cdem_dem_as_seen(dem);
  for (int64_t b = 0; b < core->bonds; b++) {
    cdem_bond_state bond = core->bond[b];
    cdem_bond_forces f;
    if (!bond.holds)
      continue;
    cdem_bond_evaluate(dem, &bond, 0.0, &f, NULL);
    t->force += cdem_norm3(f.force);
    t->contacts++;
    if (t->count != NULL) {
      t->count[bond.id[0]]++;
      t->count[bond.id[1]]++;
    }
  }
  dem->store->motion = motion;
}

/* Ratio of free flight: how much of the forces on free grains is not balanced. */
double cdem_dem_unbalanced(const cdem_dem *dem) {
  const cdem_dem_store *s = dem->store;
  tally t = {.store = s};
  double largest = 0.0;
  tally_all(dem, &t);
  if (t.contacts == 0 || t.force == 0.0)
    return 0.0;
  for (int32_t i = 0; i < s->grains; i++) {
    double f[3];
    unsigned held = cdem_grain_held(s->kind[i]);
    for (int c = 0; c < 3; c++)
      f[c] = held >> c & 1u
                 ? 0.0
                 : cdem_force(s, i)[c] + cdem_motion(s, i)[6] * s->options.gravity[c] +
                       (dem->applied != NULL ? dem->applied[6 * (int64_t)s->id[i] + c] : 0.0);
    largest = fmax(largest, cdem_norm3(f));
  }
  return largest / (t.force / (double)t.contacts);
}

/* Where the grain would be without the cell, against its start. A grain that never left gets the
 * sum of its steps, which keeps small displacements exact. */
static void way_of(const cdem_dem_store *s, int32_t i, double way[3]) {
  const int32_t *turns = s->turns != NULL ? s->turns + 4 * (int64_t)i : NULL;
  const double *start = s->core->start.xyz + 3 * (int64_t)s->id[i], *h = s->cell.h;
  bool left = turns != NULL && (turns[0] != 0 || turns[1] != 0 || turns[2] != 0);
  for (int r = 0; r < 3; r++) {
    way[r] = s->travel[8 * (int64_t)i + r] + s->core->since[8 * (int64_t)i + r];
    if (left)
      way[r] = cdem_place(s, i)[r] - start[r];
    for (int c = 0; left && c < 3; c++)
      way[r] -= turns[c] != 0 ? turns[c] * h[3 * r + c] : 0.0;
  }
}

static void put3(double *out, int64_t id, const double *from) {
  if (out != NULL)
    memcpy(out + 3 * id, from, 3 * sizeof *out);
}

void cdem_dem_look(const cdem_dem *dem, const cdem_dem_view *view) {
  const cdem_dem_store *s = dem->store;
  if (view->contacts != NULL) {
    tally t = {.store = s, .count = view->contacts};
    memset(view->contacts, 0, (size_t)s->grains * sizeof *view->contacts);
    tally_all(dem, &t);
  }
  for (int32_t i = 0; i < s->grains; i++) {
    int64_t id = s->id[i];
    double way[6], now[6], place[3];
    way_of(s, i, way);
    for (int c = 3; c < 6; c++)
      way[c] = s->travel[8 * (int64_t)i + c] + s->core->since[8 * (int64_t)i + c];
    memcpy(place, cdem_place(s, i), sizeof place);
    if (s->pair_image != NULL && view->xyz != NULL)
      cdem_cell_wrap(&s->cell, place);
    put3(view->xyz, id, place);
    put3(view->displacement, id, way);
    put3(view->rotation, id, way + 3);
    if (view->velocity != NULL || view->spin != NULL) {
      cdem_grain_velocity_now(dem, i, now);
      put3(view->velocity, id, now);
      put3(view->spin, id, now + 3);
    }
    put3(view->force, id, cdem_force(s, i));
    put3(view->moment, id, cdem_force(s, i) + 3);
    double mass = cdem_motion(s, i)[6], r = cdem_place(s, i)[3];
    if (view->mass != NULL)
      view->mass[id] = mass;
    if (view->inertia != NULL)
      view->inertia[id] = cdem_inertia_factor(s->dim) * mass * (r * r);
  }
}

void cdem_dem_momentum(const cdem_dem *dem, double linear[3], double angular[3]) {
  const cdem_dem_store *s = dem->store;
  memset(linear, 0, 3 * sizeof *linear);
  memset(angular, 0, 3 * sizeof *angular);
  for (int32_t i = 0; i < s->grains; i++) {
    const double *x = cdem_place(s, i), *v = cdem_motion(s, i);
    double m = v[6], inertia = cdem_inertia_factor(s->dim) * m * (x[3] * x[3]), cross[3];
    cdem_cross3(x, v, cross);
    for (int c = 0; c < 3; c++) {
      linear[c] += m * v[c];
      angular[c] += m * cross[c] + inertia * v[3 + c];
    }
  }
}

const double *cdem_dem_radius(const cdem_dem *dem) {
  return dem->store->core->radius;
}
const int32_t *cdem_dem_material(const cdem_dem *dem) {
  return dem->store->core->material;
}
const cdem_dem_options *cdem_dem_options_of(const cdem_dem *dem) {
  return &dem->store->options;
}
int64_t cdem_dem_bonds_broken(const cdem_dem *dem) {
  return dem->store->core->broken;
}
const cdem_cell *cdem_dem_cell(const cdem_dem *dem) {
  return dem->store->options.cell != NULL ? &dem->store->cell : NULL;
}

void cdem_dem_wall_now(const cdem_dem *dem, int wall, cdem_dem_wall *now) {
  const cdem_dem_core *core = dem->store->core;
  *now = (cdem_dem_wall){0};
  cdem_walls_now(dem->store, wall, now);
  memcpy(now->force, core->wall_force + 6 * (int64_t)wall, sizeof now->force);
  memcpy(now->moment, core->wall_force + 6 * (int64_t)wall + 3, sizeof now->moment);
}

void cdem_dem_wall_move(cdem_dem *dem, int wall, const cdem_series velocity[3],
                        const cdem_series spin[3]) {
  cdem_walls_move(dem->store, wall, velocity, spin);
}

void cdem_dem_forces_on(const cdem_dem *dem, int64_t count, const int32_t *grain, double *out) {
  const cdem_dem_store *s = dem->store;
  for (int64_t k = 0; k < count; k++)
    memcpy(out + 6 * k, cdem_force(s, s->slot[grain[k]]), 6 * sizeof *out);
}

void cdem_dem_motions_of(const cdem_dem *dem, int64_t count, const int32_t *grain, double *out) {
  const cdem_dem_store *s = dem->store;
  for (int64_t k = 0; k < count; k++)
    memcpy(out + 6 * k, cdem_motion(s, s->slot[grain[k]]), 6 * sizeof *out);
}
