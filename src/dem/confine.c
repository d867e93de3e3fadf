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
  CDEM_REQUIRE(o->membrane != NULL ||
                   (o->side >= 0 && o->side < d->walls &&
                    d->wall[o->side].shape == CDEM_WALL_CYLINDER && d->wall[o->side].servo_radius),
               fault, CDEM_INPUT,
               "the side of a specimen is a membrane or a cylinder with a servo of its radius");
  return cdem_confine_host_check(o, d->wall, d->walls, fault);
}

cdem_status cdem_confine_init(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_core *core = dem->store->core;
  const cdem_dem_store *s = dem->store;
  const cdem_confinement *o = s->options.confinement;
  double smallest = INFINITY;
  if (o == NULL)
    return CDEM_OK;
  CDEM_TRY(check(dem, o, fault));
  cdem_wall_body *wall = s->walls->body;
  CDEM_NEW(core->confine, 1, fault);
  struct cdem_confine *b = core->confine;
  for (int32_t i = 0; i < s->grains; i++)
    smallest = fmin(smallest, cdem_place(s, i)[3]);
  CDEM_TRY(
      cdem_confine_host_init(&b->host, o, 2.0 * smallest, s->options.mass_damping, wall, fault));
  if (b->host.flexible) {
    CDEM_NEW(b->row, (int64_t)b->host.membrane.nodes + 1, fault);
    CDEM_NEW(b->touching, b->host.membrane.rings, fault);
    CDEM_NEW(b->touching_all, b->host.membrane.rings, fault);
  } else {
    wall[o->side].wall.servo_force = cdem_confine_host_pointed(&b->host, &b->side_wanted);
  }
  cdem_confine_aim(dem);
  return CDEM_OK;
}

void cdem_confine_release(cdem_dem_core *core) {
  struct cdem_confine *b = core->confine;
  if (b == NULL)
    return;
  cdem_confine_host_release(&b->host);
  free(b->row);
  free(b->grain);
  free(b->push);
  free(b->of);
  free(b->entry_start);
  free(b->entry);
  free(b->cell);
  free(b->cell_grain);
  free(b->touching);
  free(b->touching_all);
  free(b);
  core->confine = NULL;
}

/* ---- motion ---- */

cdem_status cdem_confine_calm(cdem_dem *dem, cdem_fault *fault) {
  cdem_confine_host *host = &dem->store->core->confine->host;
  if (host->options.quiet > 0.0) {
    double limit;
    CDEM_TRY(cdem_dem_limit(dem, &limit, NULL, fault));
    cdem_confine_host_quiet(host, limit);
  }
  dem->store->options.mass_damping = cdem_confine_host_damping(host, dem->time);
  return CDEM_OK;
}

static double height_of(const cdem_dem *dem) {
  return cdem_confine_host_height(&dem->store->core->confine->host, dem->store->walls->body);
}

static double volume_of(const cdem_dem *dem) {
  const cdem_confine_host *host = &dem->store->core->confine->host;
  if (host->flexible)
    return cdem_confine_host_volume(host);
  double radius = dem->store->walls->body[host->options.side].wall.radius;
  return pi * (radius * radius) * height_of(dem);
}

void cdem_confine_aim(cdem_dem *dem) {
  struct cdem_confine *b = dem->store->core->confine;
  const cdem_confinement *o = &b->host.options;
  double height = height_of(dem);
  cdem_confine_host_aim(&b->host, dem->time, volume_of(dem), height);
  if (!b->host.flexible)
    b->side_wanted = cdem_series_at(&o->pressure, dem->time) *
                     (2.0 * pi * dem->store->walls->body[o->side].wall.radius * height);
}

void cdem_confine_move(cdem_dem *dem) {
  cdem_confine_host *host = &dem->store->core->confine->host;
  cdem_confine_host_move(host, dem->store->walls->body, dem->time, dem->step);
  dem->store->options.mass_damping = cdem_confine_host_damping(host, dem->time);
}

void cdem_confine_change_step(cdem_dem *dem, double old, double step) {
  cdem_confine_host_change_step(&dem->store->core->confine->host, old, step);
}

void cdem_dem_shear(cdem_dem *dem, double velocity) {
  struct cdem_confine *b = dem->store->core->confine;
  cdem_series way[3];
  if (b == NULL)
    return;
  cdem_confine_host_shear(&b->host, dem->store->walls->body, velocity, way);
  cdem_walls_move(dem->store, b->host.options.high, way, NULL);
}

/* ---- forces ---- */

/* One node: what it touches, and the sums of its ring. */
static void touch(const cdem_dem_store *s, struct cdem_confine *b, int64_t i, int32_t ring) {
  cdem_membrane *m = &b->host.membrane;
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
    b->host.lost[ring] += lost;
    b->host.stored[ring] += 0.5 * stiffness * (overlap * overlap);
    touching++;
  }
  b->touching[ring] = touching > b->touching[ring] ? touching : b->touching[ring];
  b->touching_all[ring] += touching > 0;
}

static void touch_ring(const cdem_dem_store *s, struct cdem_confine *b, int32_t ring) {
  int64_t from = (int64_t)ring * b->host.membrane.around;
  b->host.lost[ring] = b->host.stored[ring] = 0.0;
  b->touching[ring] = b->touching_all[ring] = 0;
  for (int64_t i = from; i < from + b->host.membrane.around; i++)
    touch(s, b, i, ring);
}

void cdem_confine_forces(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  struct cdem_confine *b = s->core->confine;
  cdem_membrane *m = &b->host.membrane;
  if (!b->host.flexible)
    return;
#pragma omp for schedule(static)
  for (int32_t ring = 0; ring < m->rings; ring++) {
    cdem_membrane_look(m, ring);
    touch_ring(s, b, ring);
  }
#pragma omp for schedule(static) nowait
  for (int32_t ring = 0; ring < m->rings; ring++)
    cdem_membrane_gather(m, ring);
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

void cdem_confine_after(cdem_dem *dem, double step) {
  cdem_confine_host_after(&dem->store->core->confine->host, step);
}

/* ---- looking ---- */

void cdem_confine_energies(const cdem_dem *dem, cdem_dem_energies *e) {
  cdem_confine_book own = cdem_confine_host_book(&dem->store->core->confine->host, dem->step);
  e->membrane = own.membrane;
  e->damping += own.damping;
  e->pressure = own.pressure;
}

bool cdem_dem_specimen(const cdem_dem *dem, cdem_specimen *now) {
  const struct cdem_confine *b = dem->store->core->confine;
  *now = (cdem_specimen){0};
  if (b == NULL)
    return false;
  const cdem_confinement *o = &b->host.options;
  const cdem_wall_body *wall = dem->store->walls->body;
  const double *force = dem->store->core->wall_force;
  cdem_confine_host_look(&b->host, wall, dem->time, volume_of(dem), force[6 * (int64_t)o->high + 2],
                         force[6 * (int64_t)o->low + 2], now);
  if (!b->host.flexible)
    now->lateral =
        dem->store->core->wall_push[o->side] / (2.0 * pi * wall[o->side].wall.radius * now->height);
  for (int32_t k = 0; k < b->host.membrane.rings; k++)
    now->touching += b->touching_all[k];
  return true;
}

const cdem_membrane *cdem_dem_membrane(const cdem_dem *dem) {
  const struct cdem_confine *b = dem->store->core->confine;
  return b != NULL && b->host.flexible ? &b->host.membrane : NULL;
}

/* ---- the step ---- */

double cdem_confine_limit(const cdem_dem *dem) {
  const struct cdem_confine *b = dem->store->core->confine;
  int32_t most = 0;
  for (int32_t ring = 0; ring < b->host.membrane.rings; ring++)
    most = b->touching[ring] > most ? b->touching[ring] : most;
  return cdem_confine_host_limit(&b->host, most);
}

void cdem_confine_visit(const cdem_dem *dem, cdem_confine_see *see, void *context) {
  const cdem_dem_store *s = dem->store;
  const struct cdem_confine *b = s->core->confine;
  const cdem_membrane *m = &b->host.membrane;
  for (int64_t i = 0; i < m->nodes; i++)
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
  const cdem_confine_host *h = &b->host;
  const double real[REALS] = {h->wanted,
                              h->speed,
                              h->sheared,
                              h->moved,
                              h->damped,
                              h->quiet_damping,
                              dem->store->options.mass_damping};
  CDEM_TRY(cdem_state_add_copy(state, "confine/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  if (!h->flexible)
    return CDEM_OK;
  int64_t rings = h->membrane.rings;
  CDEM_TRY(cdem_state_add(state, "confine/lost", CDEM_ARRAY_REAL, rings, h->lost, fault));
  CDEM_TRY(cdem_state_add(state, "confine/stored", CDEM_ARRAY_REAL, rings, h->stored, fault));
  CDEM_TRY(cdem_state_add(state, "confine/most", CDEM_ARRAY_INT32, rings, b->touching, fault));
  CDEM_TRY(
      cdem_state_add(state, "confine/touching", CDEM_ARRAY_INT32, rings, b->touching_all, fault));
  return cdem_membrane_save(&h->membrane, state, fault);
}

/* Before the walls are restored: a sheared plate has other functions. Candidates are found again
 * with twice the skin, as those of walls; distances go on from where they were. */
cdem_status cdem_confine_restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault) {
  struct cdem_confine *b = dem->store->core->confine;
  cdem_confine_host *h = &b->host;
  double real[REALS];
  CDEM_TRY(cdem_state_get(state, "confine/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  if (real[2] != 0.0)
    cdem_dem_shear(dem, real[1]);
  h->wanted = real[0];
  h->damped = real[4];
  h->quiet_damping = real[5];
  dem->store->options.mass_damping = real[6];
  if (!h->flexible)
    return CDEM_OK;
  int64_t rings = h->membrane.rings;
  CDEM_TRY(cdem_state_get(state, "confine/lost", CDEM_ARRAY_REAL, rings, h->lost, fault));
  CDEM_TRY(cdem_state_get(state, "confine/stored", CDEM_ARRAY_REAL, rings, h->stored, fault));
  CDEM_TRY(cdem_state_get(state, "confine/most", CDEM_ARRAY_INT32, rings, b->touching, fault));
  CDEM_TRY(
      cdem_state_get(state, "confine/touching", CDEM_ARRAY_INT32, rings, b->touching_all, fault));
  CDEM_TRY(cdem_membrane_restore(&h->membrane, state, fault));
  double skin = dem->store->skin;
  dem->store->skin = 2.0 * skin;
  cdem_status status = cdem_confine_build(dem, fault);
  dem->store->skin = skin;
  CDEM_TRY(status);
  CDEM_TRY(cdem_membrane_restore(&h->membrane, state, fault)); /* the build has marked anew */
  h->moved = real[3];
  return CDEM_OK;
}
