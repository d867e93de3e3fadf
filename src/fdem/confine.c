/* The specimen in the solver: plates, membrane, and the forces between it and grains. */
#include "fdem/confine.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* ---- beginning and end ---- */

static cdem_status check(const cdem_fdem_options *o, cdem_fault *fault) {
  const cdem_confinement *c = o->confinement;
  CDEM_REQUIRE(c->membrane != NULL, fault, CDEM_INPUT,
               "a specimen of deformable grains has a membrane around it; a cylinder with a servo "
               "knows rigid grains only");
  return cdem_confine_host_check(c, o->wall, o->walls, fault);
}

static cdem_status allocate(const cdem_fdem_store *s, struct cdem_fdem_confine *b,
                            cdem_fault *fault) {
  CDEM_NEW(b->row, (int64_t)b->host.membrane.nodes + 1, fault);
  CDEM_NEW(b->grain_row, s->grains + 1, fault);
  CDEM_NEW(b->built, 3 * s->grains, fault);
  CDEM_NEW(b->stiff, b->host.membrane.rings, fault);
  return CDEM_OK;
}

cdem_status cdem_fdem_confine_init(cdem_fdem *fdem, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  double smallest = INFINITY, mean = 0.0;
  if (s->options.confinement == NULL)
    return CDEM_OK;
  CDEM_TRY(check(&s->options, fault));
  CDEM_NEW(s->confine, 1, fault);
  struct cdem_fdem_confine *b = s->confine;
  for (int64_t g = 0; g < s->grains; g++) {
    smallest = fmin(smallest, s->radius[g]);
    mean += s->radius[g] / (double)s->grains;
  }
  b->skin = 0.1 * mean;
  CDEM_TRY(cdem_confine_host_init(&b->host, s->options.confinement, 2.0 * smallest,
                                  s->options.mass_damping, s->wall, fault));
  CDEM_TRY(allocate(s, b, fault));
  cdem_fdem_confine_aim(fdem);
  return cdem_fdem_confine_lists(fdem, true, fault);
}

void cdem_fdem_confine_release(cdem_fdem_store *s) {
  struct cdem_fdem_confine *b = s->confine;
  if (b == NULL)
    return;
  cdem_confine_host_release(&b->host);
  free(b->row);
  free(b->touch);
  free(b->grain_row);
  free(b->of_grain);
  free(b->built);
  free(b->stiff);
  free(b);
  s->confine = NULL;
}

/* ---- motion ---- */

void cdem_fdem_confine_aim(cdem_fdem *fdem) {
  cdem_confine_host *host = &fdem->store->confine->host;
  cdem_confine_host_aim(host, fdem->time, cdem_confine_host_volume(host),
                        cdem_confine_host_height(host, fdem->store->wall));
}

static void calm(cdem_fdem *fdem) {
  cdem_confine_host *host = &fdem->store->confine->host;
  fdem->store->options.mass_damping = cdem_confine_host_damping(host, fdem->time);
}

void cdem_fdem_confine_calm(cdem_fdem *fdem) {
  cdem_confine_host *host = &fdem->store->confine->host;
  if (host->options.quiet > 0.0)
    cdem_confine_host_quiet(host, cdem_fdem_limit(fdem));
  calm(fdem);
}

void cdem_fdem_confine_move(cdem_fdem *fdem) {
  cdem_confine_host *host = &fdem->store->confine->host;
  cdem_confine_host_move(host, fdem->store->wall, fdem->time, fdem->step);
  calm(fdem);
}

void cdem_fdem_confine_change_step(cdem_fdem *fdem, double old) {
  cdem_confine_host_change_step(&fdem->store->confine->host, old, fdem->step);
}

void cdem_fdem_shear(cdem_fdem *fdem, double velocity) {
  cdem_fdem_store *s = fdem->store;
  cdem_series way[3];
  if (s->confine == NULL)
    return;
  cdem_confine_host_shear(&s->confine->host, s->wall, velocity, way);
  cdem_wall_body_move(s->wall + s->confine->host.options.high, fdem->time, way, NULL);
}

/* ---- forces ---- */

/* How fast the touched triangle comes towards the node, along n. */
static double closing_of(const cdem_fdem_store *s, const cdem_fdem_membrane_touch *t,
                         const double n[3], const double v[3], double step) {
  double closing = -cdem_dot3(v, n);
  for (int k = 0; k < 3 && step > 0.0; k++) {
    int64_t at = 3 * (s->first[t->grain] + t->corner[k]);
    for (int c = 0; c < 3; c++)
      closing += t->weight[k] * (s->now[at + c] - s->before[at + c]) / step * n[c];
  }
  return step > 0.0 ? closing : 0.0;
}

static void touch(const cdem_fdem_store *s, struct cdem_fdem_confine *b, int32_t ring,
                  cdem_fdem_membrane_touch *t, double step, double *node_stiff) {
  cdem_membrane *m = &b->host.membrane;
  const double *x = m->x + 3 * (int64_t)t->node, *turn = s->turn + 9 * (int64_t)t->grain;
  double d[3], y[3], n[3], lost, stiffness = m->options.penalty * m->area[t->node];
  cdem_skin_touch skin;
  t->touches = false;
  for (int c = 0; c < 3; c++)
    d[c] = x[c] - s->center[3 * (int64_t)t->grain + c];
  cdem_wall_turned_back(turn, d, y);
  if (!cdem_skin_touches(s->surface[t->grain], s->place + 3 * s->first[t->grain],
                         s->radius[t->grain], y, &skin))
    return;
  t->touches = true;
  memcpy(t->corner, skin.node, sizeof t->corner);
  memcpy(t->weight, skin.weight, sizeof t->weight);
  cdem_wall_turned(turn, skin.normal, n);
  double dashpot = 2.0 * m->options.contact_damping * sqrt(m->mass[t->node] * stiffness);
  double closing = closing_of(s, t, n, m->v + 3 * (int64_t)t->node, step);
  double push = cdem_membrane_push(stiffness, dashpot, skin.depth, closing, &lost);
  for (int c = 0; c < 3; c++) {
    m->contact[3 * (int64_t)t->node + c] += push * n[c];
    t->push[c] = -push * n[c];
  }
  b->host.lost[ring] += lost;
  b->host.stored[ring] += 0.5 * stiffness * (skin.depth * skin.depth);
  *node_stiff += stiffness;
}

static void touch_ring(const cdem_fdem_store *s, struct cdem_fdem_confine *b, int32_t ring,
                       double step) {
  int32_t around = b->host.membrane.around;
  cdem_membrane_look(&b->host.membrane, ring);
  b->host.lost[ring] = b->host.stored[ring] = b->stiff[ring] = 0.0;
  for (int32_t i = ring * around; i < (ring + 1) * around; i++) {
    double stiff = 0.0;
    memset(b->host.membrane.contact + 3 * (int64_t)i, 0, 3 * sizeof(double));
    for (int64_t k = b->row[i]; k < b->row[i + 1]; k++)
      touch(s, b, ring, b->touch + k, step, &stiff);
    b->stiff[ring] = fmax(b->stiff[ring], stiff);
  }
}

static void add_to_grain(cdem_fdem_store *s, const struct cdem_fdem_confine *b, int64_t g) {
  for (int64_t k = b->grain_row[g]; k < b->grain_row[g + 1]; k++) {
    const cdem_fdem_membrane_touch *t = b->touch + b->of_grain[k];
    if (!t->touches)
      continue;
    for (int corner = 0; corner < 3; corner++)
      for (int c = 0; c < 3; c++)
        s->force[3 * (s->first[g] + t->corner[corner]) + c] += t->weight[corner] * t->push[c];
    s->stiff[g] += b->host.membrane.options.penalty * b->host.membrane.area[t->node];
  }
}

cdem_status cdem_fdem_confine_forces(cdem_fdem *fdem, double step, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  CDEM_REQUIRE(!isnan(b->host.moved), fault, CDEM_NUMERIC,
               "the membrane is no longer finite at t = %.6g s; the pressure may be too large, or "
               "the step too long",
               fdem->time);
  CDEM_TRY(cdem_fdem_confine_lists(fdem, false, fault));
#pragma omp parallel num_threads(s->threads)
  {
#pragma omp for schedule(static)
    for (int32_t ring = 0; ring < b->host.membrane.rings; ring++)
      touch_ring(s, b, ring, step);
#pragma omp for schedule(static) nowait
    for (int32_t ring = 0; ring < b->host.membrane.rings; ring++)
      cdem_membrane_gather(&b->host.membrane, ring);
#pragma omp for schedule(static)
    for (int64_t g = 0; g < s->grains; g++)
      add_to_grain(s, b, g);
  }
  cdem_confine_host_after(&b->host, step);
  return CDEM_OK;
}

double cdem_fdem_confine_limit(const cdem_fdem_store *s) {
  const struct cdem_fdem_confine *b = s->confine;
  const cdem_membrane *m = &b->host.membrane;
  double busiest = 0.0;
  for (int32_t r = 0; r < m->rings; r++)
    busiest = fmax(busiest, b->stiff[r] / (m->options.penalty * m->area[r * m->around]));
  return cdem_confine_host_limit(&b->host, busiest);
}

/* ---- looking ---- */

void cdem_fdem_confine_energies(const cdem_fdem *fdem, cdem_fdem_energies *e) {
  cdem_confine_book own = cdem_confine_host_book(&fdem->store->confine->host, fdem->step);
  e->membrane = own.membrane;
  e->damping += own.damping;
  e->pressure = own.pressure;
}

bool cdem_fdem_specimen(const cdem_fdem *fdem, cdem_specimen *now) {
  const cdem_fdem_store *s = fdem->store;
  const struct cdem_fdem_confine *b = s->confine;
  *now = (cdem_specimen){0};
  if (b == NULL)
    return false;
  const cdem_confinement *o = &b->host.options;
  cdem_confine_host_look(&b->host, s->wall, fdem->time, cdem_confine_host_volume(&b->host),
                         s->wall_force[3 * o->high + 2], s->wall_force[3 * o->low + 2], now);
  for (int32_t i = 0; i < b->host.membrane.nodes; i++)
    for (int64_t k = b->row[i]; k < b->row[i + 1]; k++)
      if (b->touch[k].touches) {
        now->touching++;
        break;
      }
  return true;
}

const cdem_membrane *cdem_fdem_membrane(const cdem_fdem *fdem) {
  const struct cdem_fdem_confine *b = fdem->store->confine;
  return b != NULL ? &b->host.membrane : NULL;
}

/* ---- state ---- */

enum { REALS = 6 };

static void walk(struct cdem_fdem_confine *b, double real[REALS], bool save) {
  double *const at[REALS - 1] = {&b->host.wanted, &b->host.speed, &b->host.moved,
                                 &b->host.quiet_damping, &b->host.damped};
  for (int i = 0; i < REALS - 1; i++)
    if (save)
      real[i] = *at[i];
    else
      *at[i] = real[i];
}

cdem_status cdem_fdem_confine_save(const cdem_fdem_store *s, cdem_state *state, cdem_fault *fault) {
  struct cdem_fdem_confine *b = s->confine;
  double real[REALS];
  walk(b, real, true);
  real[REALS - 1] = b->host.sheared;
  CDEM_TRY(cdem_state_add_copy(state, "fdem/confine", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(
      cdem_state_add(state, "fdem/confine_built", CDEM_ARRAY_REAL, 3 * s->grains, b->built, fault));
  CDEM_TRY(cdem_state_add(state, "fdem/confine_lost", CDEM_ARRAY_REAL, b->host.membrane.rings,
                          b->host.lost, fault));
  return cdem_membrane_save(&b->host.membrane, state, fault);
}

/* Rows with twice the skin, then those go on from where they were made: they are made anew in the
 * same step as without the break, so that states are the same, too. */
static cdem_status find_again(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault) {
  struct cdem_fdem_confine *b = fdem->store->confine;
  double moved = b->host.moved, skin = b->skin;
  b->skin = 2.0 * skin;
  cdem_status status = cdem_fdem_confine_lists(fdem, true, fault);
  b->skin = skin;
  CDEM_TRY(status);
  b->host.moved = moved;
  CDEM_TRY(cdem_state_get(state, "fdem/confine_built", CDEM_ARRAY_REAL, 3 * fdem->store->grains,
                          b->built, fault));
  return cdem_membrane_restore(&b->host.membrane, state, fault); /* the lists have marked it anew */
}

/* Before the walls are restored: a sheared plate has another function. Which touches there are
 * follows from the places, but their forces and losses are of the step that led here and of
 * velocities before that step was perhaps changed: those are kept. */
cdem_status cdem_fdem_confine_restore(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  double real[REALS];
  CDEM_TRY(cdem_state_get(state, "fdem/confine", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(cdem_membrane_restore(&b->host.membrane, state, fault));
  walk(b, real, false);
  if (real[REALS - 1] != 0.0)
    cdem_fdem_shear(fdem, b->host.speed);
  calm(fdem);
  CDEM_TRY(find_again(fdem, state, fault));
  for (int32_t ring = 0; ring < b->host.membrane.rings; ring++)
    touch_ring(s, b, ring, fdem->step);
  CDEM_TRY(cdem_membrane_restore(&b->host.membrane, state, fault));
  walk(b, real, false);
  return cdem_state_get(state, "fdem/confine_lost", CDEM_ARRAY_REAL, b->host.membrane.rings,
                        b->host.lost, fault);
}
