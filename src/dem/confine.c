/* A specimen in a solver: forces between the membrane and grains, servo and shear of its plate. */
#include "dem/confine.h"

#include "dem/walls_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---- beginning and end ---- */

static cdem_status check(const cdem_dem *dem, const cdem_confinement *o, cdem_fault *fault) {
  const cdem_dem_options *d = &dem->store->options;
  CDEM_REQUIRE(dem->dim == 3, fault, CDEM_INPUT,
               "a specimen is one of spheres: discs have no membrane; let the dimension be 3");
  CDEM_REQUIRE(d->cell == NULL, fault, CDEM_INPUT,
               "a specimen stands between plates; it is not periodic: leave the cell out");
  CDEM_REQUIRE(
      o->low >= 0 && o->low < d->walls && o->high >= 0 && o->high < d->walls && o->low != o->high,
      fault, CDEM_INPUT, "the plates of a specimen are walls %d and %d; there are %d walls", o->low,
      o->high, d->walls);
  CDEM_REQUIRE(o->membrane != NULL ||
                   (o->side >= 0 && o->side < d->walls &&
                    d->wall[o->side].shape == CDEM_WALL_CYLINDER && d->wall[o->side].servo_radius),
               fault, CDEM_INPUT,
               "the side of a specimen is a membrane or a cylinder with a servo of its radius");
  CDEM_REQUIRE(!o->presses || d->wall[o->high].servo[2] > 0.0, fault, CDEM_INPUT,
               "the high plate of a specimen is to press it but has no servo along z");
  return CDEM_OK;
}

/* A series of one value that we keep. */
static cdem_series pointed(struct cdem_confine *b, double *value) {
  return (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 1, .time = b->time, .value = value};
}

static void aim_walls(cdem_dem *dem) {
  struct cdem_confine *b = dem->store->core->confine;
  cdem_wall_body *body = dem->store->walls->body;
  if (b->options.presses)
    body[b->options.high].wall.servo_force = pointed(b, &b->wanted);
  if (!b->flexible)
    body[b->options.side].wall.servo_force = pointed(b, &b->side_wanted);
}

static cdem_status init_membrane(cdem_dem *dem, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  struct cdem_confine *b = s->core->confine;
  double smallest = INFINITY;
  for (int32_t i = 0; i < s->grains; i++)
    smallest = fmin(smallest, cdem_place(s, i)[3]);
  cdem_membrane_options options = *b->options.membrane;
  options.pressure = b->options.pressure;
  CDEM_TRY(cdem_membrane_check(&options, 2.0 * smallest, fault));
  CDEM_TRY(cdem_membrane_create(&options, &b->membrane, fault));
  CDEM_NEW(b->row, (int64_t)b->membrane.nodes + 1, fault);
  CDEM_NEW(b->lost, b->membrane.rings, fault);
  CDEM_NEW(b->stored, b->membrane.rings, fault);
  CDEM_NEW(b->touching, b->membrane.rings, fault);
  CDEM_NEW(b->touching_all, b->membrane.rings, fault);
  cdem_membrane_evaluate(&b->membrane, 0.0);
  return CDEM_OK;
}

cdem_status cdem_confine_init(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_core *core = dem->store->core;
  const cdem_confinement *o = dem->store->options.confinement;
  if (o == NULL)
    return CDEM_OK;
  CDEM_TRY(check(dem, o, fault));
  CDEM_NEW(core->confine, 1, fault);
  core->confine->options = *o;
  core->confine->damping = dem->store->options.mass_damping;
  core->confine->flexible = o->membrane != NULL;
  if (o->membrane != NULL)
    CDEM_TRY(init_membrane(dem, fault));
  aim_walls(dem);
  cdem_confine_aim(dem);
  return CDEM_OK;
}

void cdem_confine_release(cdem_dem_core *core) {
  struct cdem_confine *b = core->confine;
  if (b == NULL)
    return;
  cdem_membrane_release(&b->membrane);
  free(b->row);
  free(b->grain);
  free(b->push);
  free(b->of);
  free(b->entry_start);
  free(b->entry);
  free(b->cell);
  free(b->cell_grain);
  free(b->lost);
  free(b->stored);
  free(b->touching);
  free(b->touching_all);
  free(b);
  core->confine = NULL;
}

/* ---- motion ---- */

/* Mass damping of the kick at this time: falls to that of the options. */
static void calm(cdem_dem *dem) {
  struct cdem_confine *b = dem->store->core->confine;
  double left = b->options.quiet > 0.0 ? 1.0 - dem->time / b->options.quiet : 0.0;
  double more = left > 0.0 ? b->quiet_damping * (left * left) : 0.0;
  dem->store->options.mass_damping = b->damping + more;
  b->membrane.drag = dem->store->options.mass_damping;
}

cdem_status cdem_confine_calm(cdem_dem *dem, cdem_fault *fault) {
  struct cdem_confine *b = dem->store->core->confine;
  b->quiet_damping = b->options.quiet_damping;
  if (b->options.quiet > 0.0 && b->quiet_damping == 0.0) {
    double limit;
    CDEM_TRY(cdem_dem_limit(dem, &limit, NULL, fault));
    b->quiet_damping = 2.0 / limit;
  }
  calm(dem);
  return CDEM_OK;
}

static double height_of(const cdem_dem *dem) {
  const cdem_confinement *o = &dem->store->core->confine->options;
  const cdem_wall_body *body = dem->store->walls->body;
  return body[o->high].center[2] - body[o->low].center[2];
}

static double volume_of(const cdem_dem *dem) {
  const struct cdem_confine *b = dem->store->core->confine;
  if (b->flexible)
    return cdem_membrane_volume(&b->membrane);
  double radius = dem->store->walls->body[b->options.side].wall.radius;
  return pi * (radius * radius) * height_of(dem);
}

void cdem_confine_aim(cdem_dem *dem) {
  struct cdem_confine *b = dem->store->core->confine;
  double pressure = cdem_series_at(&b->options.pressure, dem->time);
  if (b->options.presses && !b->sheared)
    b->wanted = pressure * (volume_of(dem) / height_of(dem));
  if (!b->flexible)
    b->side_wanted = pressure * (2.0 * pi * dem->store->walls->body[b->options.side].wall.radius *
                                 height_of(dem));
}

void cdem_confine_move(cdem_dem *dem) {
  struct cdem_confine *b = dem->store->core->confine;
  const cdem_wall_body *body = dem->store->walls->body;
  if (b->flexible) {
    b->moved = sqrt(cdem_membrane_move(&b->membrane, dem->step, body[b->options.low].velocity[2],
                                       body[b->options.high].velocity[2]));
    cdem_membrane_set_time(&b->membrane, dem->time);
  }
  calm(dem);
}

void cdem_confine_change_step(cdem_dem *dem, double old, double step) {
  struct cdem_confine *b = dem->store->core->confine;
  if (!b->flexible)
    return;
  cdem_membrane_change_step(&b->membrane, old, step);
  for (int32_t k = 0; k < b->membrane.rings; k++)
    b->damped += 0.5 * (step - old) * b->lost[k];
}

/* A velocity in place of the servo, with all that has been done kept. */
static void shear(cdem_dem *dem, double speed) {
  struct cdem_confine *b = dem->store->core->confine;
  cdem_series velocity[3] = {{0}, {0}, pointed(b, &b->speed)};
  b->speed = speed;
  b->sheared = true;
  dem->store->walls->body[b->options.high].servo = false;
  cdem_walls_move(dem->store, b->options.high, velocity, NULL);
}

void cdem_dem_shear(cdem_dem *dem, double velocity) {
  if (dem->store->core->confine != NULL)
    shear(dem, velocity);
}

/* ---- forces ---- */

/* One node: what it touches, and the sums of its ring. */
static void touch(const cdem_dem_store *s, struct cdem_confine *b, int64_t i, int32_t ring) {
  cdem_membrane *m = &b->membrane;
  const double *x = m->x + 3 * i, *v = m->v + 3 * i;
  double *contact = m->contact + 3 * i, stiffness = m->options.penalty * m->area[i], n[3], lost;
  double dashpot = 2.0 * m->options.contact_damping * sqrt(m->mass[i] * stiffness);
  int32_t touching = 0;
  contact[0] = contact[1] = contact[2] = 0.0;
  for (int64_t k = b->row[i]; k < b->row[i + 1]; k++) {
    const double *grain = cdem_place(s, b->grain[k]), *speed = cdem_motion(s, b->grain[k]);
    double *push = b->push + 3 * k, overlap = cdem_confine_overlap(grain, x, n);
    push[0] = push[1] = push[2] = 0.0;
    if (overlap <= 0.0)
      continue;
    double closing = (speed[0] - v[0]) * n[0] + (speed[1] - v[1]) * n[1] + (speed[2] - v[2]) * n[2];
    double size = cdem_membrane_push(stiffness, dashpot, overlap, closing, &lost);
    for (int c = 0; c < 3; c++) {
      contact[c] += size * n[c];
      push[c] = -size * n[c];
    }
    b->lost[ring] += lost;
    b->stored[ring] += 0.5 * stiffness * (overlap * overlap);
    touching++;
  }
  b->touching[ring] = touching > b->touching[ring] ? touching : b->touching[ring];
  b->touching_all[ring] += touching > 0;
}

static void touch_ring(const cdem_dem_store *s, struct cdem_confine *b, int32_t ring) {
  int64_t from = (int64_t)ring * b->membrane.around;
  b->lost[ring] = b->stored[ring] = 0.0;
  b->touching[ring] = b->touching_all[ring] = 0;
  for (int64_t i = from; i < from + b->membrane.around; i++)
    touch(s, b, i, ring);
}

void cdem_confine_forces(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  struct cdem_confine *b = s->core->confine;
  if (!b->flexible)
    return;
#pragma omp for schedule(static)
  for (int32_t ring = 0; ring < b->membrane.rings; ring++) {
    cdem_membrane_look(&b->membrane, ring);
    touch_ring(s, b, ring);
  }
#pragma omp for schedule(static) nowait
  for (int32_t ring = 0; ring < b->membrane.rings; ring++)
    cdem_membrane_gather(&b->membrane, ring);
#pragma omp for schedule(static)
  for (int32_t h = 0; h < b->held; h++) {
    double *f = cdem_force(s, b->of[h]), sum[3] = {0};
    for (int64_t e = b->entry_start[h]; e < b->entry_start[h + 1]; e++)
      for (int c = 0; c < 3; c++)
        sum[c] += b->push[3 * b->entry[e] + c];
    for (int c = 0; c < 3; c++)
      f[c] += sum[c];
  }
}

/* Power at t_n with the velocity of half a step before, for a whole step. */
void cdem_confine_after(cdem_dem *dem, double step) {
  struct cdem_confine *b = dem->store->core->confine;
  for (int32_t k = 0; b->flexible && k < b->membrane.rings; k++)
    b->damped += step * b->lost[k];
}

/* ---- looking ---- */

void cdem_confine_energies(const cdem_dem *dem, cdem_dem_energies *e) {
  const struct cdem_confine *b = dem->store->core->confine;
  cdem_membrane_energies m;
  if (!b->flexible)
    return;
  cdem_membrane_energies_now(&b->membrane, dem->step, &m);
  e->membrane = m.kinetic + m.stretch + m.bending;
  double ahead = 0.0;
  for (int32_t k = 0; k < b->membrane.rings; k++) {
    e->membrane += b->stored[k];
    ahead += 0.5 * dem->step * b->lost[k];
  }
  e->damping += m.damping + b->damped - ahead;
  e->pressure = m.pressure + m.plates;
}

bool cdem_dem_specimen(const cdem_dem *dem, cdem_specimen *now) {
  const struct cdem_confine *b = dem->store->core->confine;
  *now = (cdem_specimen){0};
  if (b == NULL)
    return false;
  const double *force = dem->store->core->wall_force;
  now->pressure = cdem_series_at(&b->options.pressure, dem->time);
  now->height = height_of(dem);
  now->volume = volume_of(dem);
  now->area = now->volume / now->height;
  now->axial = force[6 * (int64_t)b->options.high + 2] / now->area;
  now->bottom = -force[6 * (int64_t)b->options.low + 2] / now->area;
  now->speed = dem->store->walls->body[b->options.high].velocity[2];
  if (!b->flexible) {
    const cdem_wall_body *side = dem->store->walls->body + b->options.side;
    now->lateral =
        dem->store->core->wall_push[b->options.side] / (2.0 * pi * side->wall.radius * now->height);
    return true;
  }
  cdem_membrane_shape shape;
  cdem_membrane_shape_now(&b->membrane, &shape);
  now->lateral = shape.lateral;
  for (int32_t k = 0; k < b->membrane.rings; k++)
    now->touching += b->touching_all[k];
  return true;
}

const cdem_membrane *cdem_dem_membrane(const cdem_dem *dem) {
  const struct cdem_confine *b = dem->store->core->confine;
  return b != NULL && b->flexible ? &b->membrane : NULL;
}

/* ---- the step ---- */

/* Both sides of a touch take half of its energy twice (w = 2, solver_limit.c). One more grain than
 * the busiest node has may come. */
double cdem_confine_limit(const cdem_dem *dem) {
  const struct cdem_confine *b = dem->store->core->confine;
  if (!b->flexible)
    return INFINITY;
  const cdem_membrane_options *o = &b->membrane.options;
  double k, c, ratio = o->penalty / o->areal_density;
  int32_t most = 0;
  for (int32_t ring = 0; ring < b->membrane.rings; ring++)
    most = b->touching[ring] > most ? b->touching[ring] : most;
  cdem_membrane_bounds(&b->membrane, &k, &c);
  k += 2.0 * (most + 1) * ratio;
  c += 4.0 * (most + 1) * o->contact_damping * sqrt(ratio);
  return 4.0 / (c + sqrt(c * c + 4.0 * k));
}

void cdem_confine_visit(const cdem_dem *dem, cdem_confine_see *see, void *context) {
  const cdem_dem_store *s = dem->store;
  const struct cdem_confine *b = s->core->confine;
  const cdem_membrane *m = &b->membrane;
  for (int64_t i = 0; b->flexible && i < m->nodes; i++)
    for (int64_t k = b->row[i]; k < b->row[i + 1]; k++) {
      double n[3], stiffness = m->options.penalty * m->area[i];
      if (cdem_confine_overlap(cdem_place(s, b->grain[k]), m->x + 3 * i, n) > 0.0)
        see(context, b->grain[k], stiffness,
            2.0 * m->options.contact_damping * sqrt(m->mass[i] * stiffness), n);
    }
}

/* ---- state ---- */

enum { REALS = 7 };

cdem_status cdem_confine_save(const cdem_dem *dem, cdem_state *state, cdem_fault *fault) {
  const struct cdem_confine *b = dem->store->core->confine;
  const double real[REALS] = {b->wanted,
                              b->speed,
                              b->sheared,
                              b->moved,
                              b->damped,
                              b->quiet_damping,
                              dem->store->options.mass_damping};
  CDEM_TRY(cdem_state_add_copy(state, "confine/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  if (!b->flexible)
    return CDEM_OK;
  int64_t rings = b->membrane.rings;
  CDEM_TRY(cdem_state_add(state, "confine/lost", CDEM_ARRAY_REAL, rings, b->lost, fault));
  CDEM_TRY(cdem_state_add(state, "confine/stored", CDEM_ARRAY_REAL, rings, b->stored, fault));
  CDEM_TRY(cdem_state_add(state, "confine/most", CDEM_ARRAY_INT32, rings, b->touching, fault));
  CDEM_TRY(
      cdem_state_add(state, "confine/touching", CDEM_ARRAY_INT32, rings, b->touching_all, fault));
  return cdem_membrane_save(&b->membrane, state, fault);
}

/* Before the walls are restored: a sheared plate has other functions. Candidates are found again
 * with twice the skin, as those of walls; distances go on from where they were. */
cdem_status cdem_confine_restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault) {
  struct cdem_confine *b = dem->store->core->confine;
  double real[REALS];
  CDEM_TRY(cdem_state_get(state, "confine/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  if (real[2] != 0.0)
    shear(dem, real[1]);
  b->wanted = real[0];
  b->damped = real[4];
  b->quiet_damping = real[5];
  dem->store->options.mass_damping = real[6];
  if (!b->flexible)
    return CDEM_OK;
  int64_t rings = b->membrane.rings;
  CDEM_TRY(cdem_state_get(state, "confine/lost", CDEM_ARRAY_REAL, rings, b->lost, fault));
  CDEM_TRY(cdem_state_get(state, "confine/stored", CDEM_ARRAY_REAL, rings, b->stored, fault));
  CDEM_TRY(cdem_state_get(state, "confine/most", CDEM_ARRAY_INT32, rings, b->touching, fault));
  CDEM_TRY(
      cdem_state_get(state, "confine/touching", CDEM_ARRAY_INT32, rings, b->touching_all, fault));
  CDEM_TRY(cdem_membrane_restore(&b->membrane, state, fault));
  double skin = dem->store->skin;
  dem->store->skin = 2.0 * skin;
  cdem_status status = cdem_confine_build(dem, fault);
  dem->store->skin = skin;
  CDEM_TRY(status);
  CDEM_TRY(cdem_membrane_restore(&b->membrane, state, fault)); /* the build has marked anew */
  b->moved = real[3];
  return CDEM_OK;
}
