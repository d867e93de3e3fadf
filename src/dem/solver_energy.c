/* The energy book. Kinetic energy at t_n is m v_- v_+/2, works go by the trapezoid: with these the
 * book of linear forces closes to rounding but for the curvature of what they do within a step. */
#include "dem/confine.h"

#include <math.h>
#include <string.h>

static void add_stored(void *context, const cdem_dem_visit *visit) {
  cdem_dem_energies *e = context;
  const cdem_batch *b = &visit->work->batch;
  for (int k = 0; k < visit->count; k++) {
    e->normal += b->stored_normal[k];
    e->shear += b->stored_shear[k];
    e->moment += b->stored_moment[k];
  }
}

/* ---- halves of the last step ----
 *
 * Dashpots, and moments that remember nothing, are booked as power at t_n times the step, half of
 * which lies ahead (batch.h). Their power is found again with a step so short that springs do not
 * grow in it. */

static const double shortly = 0x1.0p-40;

static void add_ahead(void *context, const cdem_dem_visit *visit) {
  double *sum = context, step = visit->dem->step;
  const cdem_contact_model *model = visit->model;
  const cdem_resistance *resistance[2] = {model->rolling, model->twisting};
  cdem_batch *b = &visit->work->batch;
  int solid = visit->dem->dim - 2;
  for (int k = 0; k < visit->count; k++) {
    sum[CDEM_DEM_DAMPED] -= 0.5 / shortly * b->damped[k];
    sum[CDEM_DEM_CIRCULATED] -= 0.5 / shortly * b->circulated[k];
  }
  for (int r = 0; r < 2; r++) {
    if (resistance[r] == NULL || resistance[r]->batch[solid][true] == NULL ||
        resistance[r]->history[solid] > 0)
      continue;
    memset(b->rolled, 0, sizeof b->rolled);
    b->step = step;
    resistance[r]->batch[solid][true](&model->parameters[1 + r], model->first[1 + r], b);
    for (int k = 0; k < visit->count; k++)
      sum[CDEM_DEM_ROLLED] -= 0.5 * b->rolled[k];
  }
}

static void add_ahead_of_bonds(const cdem_dem *dem, double sum[CDEM_DEM_SUMS]) {
  const cdem_dem_store *s = dem->store;
  for (int64_t k = 0; k < s->core->bonds; k++) {
    cdem_bond_state bond = s->core->bond[k];
    cdem_bond_forces f;
    double damped;
    if (!bond.holds ||
        (s->kind[bond.owner] == CDEM_GRAIN_DRIVEN && s->kind[bond.other] == CDEM_GRAIN_DRIVEN))
      continue;
    cdem_bond_evaluate(dem, &bond, shortly * dem->step, &f, &damped);
    sum[CDEM_DEM_DAMPED] -= 0.5 / shortly * damped;
  }
}

void cdem_dem_book_now(const cdem_dem *dem, double sum[CDEM_DEM_SUMS]) {
  cdem_dem_core *core = dem->store->core;
  cdem_move_kernel kernel = {dem->store, core, dem->step, dem->applied, false};
  memset(sum, 0, CDEM_DEM_SUMS * sizeof *sum);
  for (int32_t c = 0; c < core->chunks; c++) {
    cdem_dem_part part = {.bad = -1};
    cdem_grains_move_all(&kernel, cdem_chunk_from(dem, c), cdem_chunk_to(dem, c), &part);
    for (int k = 0; k < CDEM_DEM_SUMS; k++)
      sum[k] += part.sum[k];
  }
  cdem_dem_visit_at(dem, shortly * dem->step, add_ahead, sum);
  add_ahead_of_bonds(dem, sum);
}

/* Gravity's potential is linear: its work is m g . u. */
static double gravity_work(const cdem_dem *dem) {
  const cdem_dem_store *s = dem->store;
  const double *g = s->options.gravity;
  double sum = 0.0;
  for (int32_t i = 0; i < s->grains; i++) {
    const double *old = s->travel + 8 * (int64_t)i, *since = s->core->since + 8 * (int64_t)i;
    double u[3] = {old[0] + since[0], old[1] + since[1], old[2] + since[2]};
    if (s->kind[i] != CDEM_GRAIN_DRIVEN)
      sum += cdem_motion(s, i)[6] * cdem_dot3(g, u);
  }
  return sum;
}

static void fill(const cdem_dem *dem, cdem_dem_energies *e) {
  const cdem_dem_store *s = dem->store;
  const cdem_dem_core *core = s->core;
  double sum[CDEM_DEM_SUMS];
  cdem_dem_book_now(dem, sum);
  *e = (cdem_dem_energies){.initial = core->initial,
                           .translation = sum[CDEM_DEM_TRANSLATION],
                           .rotation = sum[CDEM_DEM_ROTATION]};
  for (int k = 0; k < CDEM_DEM_SUMS; k++) {
    sum[k] -= core->base[k];
    for (int32_t c = 0; c < core->chunks; c++)
      sum[k] += core->part[c].sum[k];
  }
  cdem_dem_visit_all(dem, add_stored, e);
  e->bond = cdem_bonds_stored(dem);
  e->friction = sum[CDEM_DEM_SLID];
  e->rolling = sum[CDEM_DEM_ROLLED];
  e->damping = sum[CDEM_DEM_DAMPED] + sum[CDEM_DEM_MASS] + sum[CDEM_DEM_LOCAL];
  e->broken = sum[CDEM_DEM_BROKEN];
  e->gravity = gravity_work(dem);
  e->walls = core->wall_work;
  e->cell = core->cell_work;
  e->driven = sum[CDEM_DEM_DRIVEN];
  e->guided = sum[CDEM_DEM_GUIDED];
  e->applied = sum[CDEM_DEM_APPLIED];
  e->circulating = -sum[CDEM_DEM_CIRCULATED];
  if (core->confine != NULL)
    cdem_confine_energies(dem, e);
}

static double imbalance(const cdem_dem_energies *e) {
  double stored =
      e->translation + e->rotation + e->normal + e->shear + e->moment + e->bond + e->membrane;
  double dissipated = e->friction + e->rolling + e->damping + e->broken;
  double works = e->gravity + e->walls + e->cell + e->driven + e->guided + e->applied +
                 e->circulating + e->pressure;
  return stored + dissipated - works - e->initial;
}

void cdem_dem_energies_now(cdem_dem *dem, cdem_dem_energies *e) {
  cdem_dem_core *core = dem->store->core;
  *e = (cdem_dem_energies){0};
  if (!dem->store->options.energies)
    return;
  fill(dem, e);
  e->error = imbalance(e);
  const double term[] = {e->translation, e->rotation,    e->normal,  e->shear,    e->moment,
                         e->bond,        e->friction,    e->rolling, e->damping,  e->broken,
                         e->gravity,     e->walls,       e->cell,    e->driven,   e->guided,
                         e->applied,     e->circulating, e->initial, e->membrane, e->pressure};
  for (size_t k = 0; k < sizeof term / sizeof term[0]; k++)
    core->exchange = fmax(core->exchange, fabs(term[k]));
  e->exchange = core->exchange;
}

void cdem_dem_book_start(cdem_dem *dem) {
  cdem_dem_core *core = dem->store->core;
  cdem_dem_energies e;
  if (!dem->store->options.energies)
    return;
  core->initial = 0.0;
  cdem_dem_book_now(dem, core->base);
  core->base[CDEM_DEM_TRANSLATION] = core->base[CDEM_DEM_ROTATION] = 0.0;
  fill(dem, &e);
  core->initial = imbalance(&e);
}

/* Kinetic energy with velocities at t_n to second order. */
static double kinetic_now(const cdem_dem *dem) {
  const cdem_dem_store *s = dem->store;
  double sum = 0.0;
  for (int32_t i = 0; i < s->grains; i++) {
    const double *v = cdem_motion(s, i), *gain = s->core->gain + 8 * (int64_t)i;
    double now[3];
    for (int c = 0; c < 3; c++)
      now[c] = v[c] + 0.5 * gain[c];
    if (s->kind[i] != CDEM_GRAIN_DRIVEN)
      sum += 0.5 * v[6] * cdem_dot3(now, now);
  }
  return sum;
}

void cdem_dem_wrap_begin(cdem_dem *dem) {
  if (dem->store->options.energies && dem->store->pair_image != NULL)
    dem->store->core->cell_work -= kinetic_now(dem);
}

void cdem_dem_wrap_end(cdem_dem *dem) {
  if (dem->store->options.energies && dem->store->pair_image != NULL)
    dem->store->core->cell_work += kinetic_now(dem);
}
