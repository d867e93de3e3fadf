/* The specimen in the solver: plates, membrane, and the forces between it and grains. */
#include "fdem/confine.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* ---- beginning and end ---- */

static cdem_status check(const cdem_fdem_options *o, cdem_fault *fault) {
  const cdem_confinement *c = o->confinement;
  CDEM_REQUIRE(
      c->low >= 0 && c->low < o->walls && c->high >= 0 && c->high < o->walls && c->low != c->high,
      fault, CDEM_INPUT, "the plates of a specimen are walls %d and %d; there are %d walls", c->low,
      c->high, o->walls);
  CDEM_REQUIRE(c->membrane != NULL, fault, CDEM_INPUT,
               "a specimen of deformable grains has a membrane around it; a cylinder with a servo "
               "knows rigid grains only");
  CDEM_REQUIRE(!c->presses || o->wall[c->high].servo[2] > 0.0, fault, CDEM_INPUT,
               "the high plate of a specimen is to press it but has no servo along z");
  return CDEM_OK;
}

static cdem_series pointed(struct cdem_fdem_confine *b, double *value) {
  return (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 1, .time = b->time, .value = value};
}

static cdem_status allocate(const cdem_fdem_store *s, struct cdem_fdem_confine *b,
                            cdem_fault *fault) {
  CDEM_NEW(b->row, (int64_t)b->membrane.nodes + 1, fault);
  CDEM_NEW(b->grain_row, s->grains + 1, fault);
  CDEM_NEW(b->built, 3 * s->grains, fault);
  CDEM_NEW(b->lost, b->membrane.rings, fault);
  CDEM_NEW(b->stored, b->membrane.rings, fault);
  CDEM_NEW(b->stiff, b->membrane.rings, fault);
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
  b->options = *s->options.confinement;
  b->damping = s->options.mass_damping;
  b->skin = 0.1 * mean;
  cdem_membrane_options options = *b->options.membrane;
  options.pressure = b->options.pressure;
  CDEM_TRY(cdem_membrane_check(&options, 2.0 * smallest, fault));
  CDEM_TRY(cdem_membrane_create(&options, &b->membrane, fault));
  CDEM_TRY(allocate(s, b, fault));
  cdem_membrane_evaluate(&b->membrane, 0.0);
  if (b->options.presses)
    s->wall[b->options.high].wall.servo_force = pointed(b, &b->wanted);
  cdem_fdem_confine_aim(fdem);
  return cdem_fdem_confine_lists(fdem, true, fault);
}

void cdem_fdem_confine_release(cdem_fdem_store *s) {
  struct cdem_fdem_confine *b = s->confine;
  if (b == NULL)
    return;
  cdem_membrane_release(&b->membrane);
  free(b->row);
  free(b->touch);
  free(b->grain_row);
  free(b->of_grain);
  free(b->built);
  free(b->lost);
  free(b->stored);
  free(b->stiff);
  free(b);
  s->confine = NULL;
}

/* ---- motion ---- */

static double height_of(const cdem_fdem_store *s) {
  const cdem_confinement *o = &s->confine->options;
  return s->wall[o->high].center[2] - s->wall[o->low].center[2];
}

void cdem_fdem_confine_aim(cdem_fdem *fdem) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  if (b->options.presses && !b->sheared)
    b->wanted = cdem_series_at(&b->options.pressure, fdem->time) *
                (cdem_membrane_volume(&b->membrane) / height_of(s));
}

/* Damping falls to that of the options while the packing comes to rest. */
static void calm(cdem_fdem *fdem) {
  struct cdem_fdem_confine *b = fdem->store->confine;
  double left = b->options.quiet > 0.0 ? 1.0 - fdem->time / b->options.quiet : 0.0;
  double more = left > 0.0 ? b->quiet_damping * (left * left) : 0.0;
  fdem->store->options.mass_damping = b->membrane.drag = b->damping + more;
}

void cdem_fdem_confine_calm(cdem_fdem *fdem) {
  struct cdem_fdem_confine *b = fdem->store->confine;
  b->quiet_damping = b->options.quiet_damping;
  if (b->options.quiet > 0.0 && b->quiet_damping == 0.0)
    b->quiet_damping = 2.0 / cdem_fdem_limit(fdem);
  calm(fdem);
}

void cdem_fdem_confine_move(cdem_fdem *fdem) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  b->moved = sqrt(cdem_membrane_move(&b->membrane, fdem->step, s->wall[b->options.low].velocity[2],
                                     s->wall[b->options.high].velocity[2]));
  cdem_membrane_set_time(&b->membrane, fdem->time);
  calm(fdem);
}

void cdem_fdem_confine_change_step(cdem_fdem *fdem, double old) {
  struct cdem_fdem_confine *b = fdem->store->confine;
  cdem_membrane_change_step(&b->membrane, old, fdem->step);
  for (int32_t k = 0; k < b->membrane.rings; k++)
    b->damped += 0.5 * (fdem->step - old) * b->lost[k];
}

void cdem_fdem_shear(cdem_fdem *fdem, double velocity) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  if (b == NULL)
    return;
  const cdem_series way[3] = {{0}, {0}, pointed(b, &b->speed)};
  b->speed = velocity;
  b->sheared = true;
  s->wall[b->options.high].servo = false;
  cdem_wall_body_move(s->wall + b->options.high, fdem->time, way, NULL);
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
  cdem_membrane *m = &b->membrane;
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
  b->lost[ring] += lost;
  b->stored[ring] += 0.5 * stiffness * (skin.depth * skin.depth);
  *node_stiff += stiffness;
}

static void touch_ring(const cdem_fdem_store *s, struct cdem_fdem_confine *b, int32_t ring,
                       double step) {
  int32_t around = b->membrane.around;
  cdem_membrane_look(&b->membrane, ring);
  b->lost[ring] = b->stored[ring] = b->stiff[ring] = 0.0;
  for (int32_t i = ring * around; i < (ring + 1) * around; i++) {
    double stiff = 0.0;
    memset(b->membrane.contact + 3 * (int64_t)i, 0, 3 * sizeof(double));
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
    s->stiff[g] += b->membrane.options.penalty * b->membrane.area[t->node];
  }
}

cdem_status cdem_fdem_confine_forces(cdem_fdem *fdem, double step, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  CDEM_TRY(cdem_fdem_confine_lists(fdem, false, fault));
#pragma omp parallel num_threads(s->threads)
  {
#pragma omp for schedule(static)
    for (int32_t ring = 0; ring < b->membrane.rings; ring++)
      touch_ring(s, b, ring, step);
#pragma omp for schedule(static) nowait
    for (int32_t ring = 0; ring < b->membrane.rings; ring++)
      cdem_membrane_gather(&b->membrane, ring);
#pragma omp for schedule(static)
    for (int64_t g = 0; g < s->grains; g++)
      add_to_grain(s, b, g);
  }
  for (int32_t k = 0; k < b->membrane.rings; k++)
    b->damped += step * b->lost[k];
  return CDEM_OK;
}

/* As that of dem (confine.c there): one more touch may come to the busiest node. */
double cdem_fdem_confine_limit(const cdem_fdem_store *s) {
  const struct cdem_fdem_confine *b = s->confine;
  const cdem_membrane_options *o = &b->membrane.options;
  double k, c, ratio = o->penalty / o->areal_density;
  double busiest = 1.0;
  for (int32_t r = 0; r < b->membrane.rings; r++)
    busiest =
        fmax(busiest, 1.0 + b->stiff[r] / (o->penalty * b->membrane.area[r * b->membrane.around]));
  cdem_membrane_bounds(&b->membrane, &k, &c);
  k += 2.0 * busiest * ratio;
  c += 4.0 * busiest * o->contact_damping * sqrt(ratio);
  return 4.0 / (c + sqrt(c * c + 4.0 * k));
}

/* ---- looking ---- */

void cdem_fdem_confine_energies(const cdem_fdem *fdem, cdem_fdem_energies *e) {
  const struct cdem_fdem_confine *b = fdem->store->confine;
  cdem_membrane_energies m;
  cdem_membrane_energies_now(&b->membrane, fdem->step, &m);
  e->membrane = m.kinetic + m.stretch + m.bending;
  double ahead = 0.0;
  for (int32_t k = 0; k < b->membrane.rings; k++) {
    e->membrane += b->stored[k];
    ahead += 0.5 * fdem->step * b->lost[k];
  }
  e->damping += m.damping + b->damped - ahead;
  e->pressure = m.pressure + m.plates;
}

bool cdem_fdem_specimen(const cdem_fdem *fdem, cdem_specimen *now) {
  const cdem_fdem_store *s = fdem->store;
  const struct cdem_fdem_confine *b = s->confine;
  cdem_membrane_shape shape;
  *now = (cdem_specimen){0};
  if (b == NULL)
    return false;
  cdem_membrane_shape_now(&b->membrane, &shape);
  now->pressure = cdem_series_at(&b->options.pressure, fdem->time);
  now->height = height_of(s);
  now->volume = cdem_membrane_volume(&b->membrane);
  now->area = now->volume / now->height;
  now->axial = s->wall_force[3 * b->options.high + 2] / now->area;
  now->bottom = -s->wall_force[3 * b->options.low + 2] / now->area;
  now->lateral = shape.lateral;
  for (int32_t i = 0; i < b->membrane.nodes; i++)
    for (int64_t k = b->row[i]; k < b->row[i + 1]; k++)
      if (b->touch[k].touches) {
        now->touching++;
        break;
      }
  return true;
}

const cdem_membrane *cdem_fdem_membrane(const cdem_fdem *fdem) {
  const struct cdem_fdem_confine *b = fdem->store->confine;
  return b != NULL ? &b->membrane : NULL;
}

/* ---- state ---- */

enum { REALS = 6 };

static void walk(struct cdem_fdem_confine *b, double real[REALS], bool save) {
  double *const at[REALS - 1] = {&b->wanted, &b->speed, &b->moved, &b->quiet_damping, &b->damped};
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
  real[REALS - 1] = b->sheared;
  CDEM_TRY(cdem_state_add_copy(state, "fdem/confine", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(
      cdem_state_add(state, "fdem/confine_built", CDEM_ARRAY_REAL, 3 * s->grains, b->built, fault));
  CDEM_TRY(cdem_state_add(state, "fdem/confine_lost", CDEM_ARRAY_REAL, b->membrane.rings, b->lost,
                          fault));
  return cdem_membrane_save(&b->membrane, state, fault);
}

/* Rows with twice the skin, then those go on from where they were made: they are made anew in the
 * same step as without the break, so that states are the same, too. */
static cdem_status find_again(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault) {
  struct cdem_fdem_confine *b = fdem->store->confine;
  double moved = b->moved, skin = b->skin;
  b->skin = 2.0 * skin;
  cdem_status status = cdem_fdem_confine_lists(fdem, true, fault);
  b->skin = skin;
  CDEM_TRY(status);
  b->moved = moved;
  CDEM_TRY(cdem_state_get(state, "fdem/confine_built", CDEM_ARRAY_REAL, 3 * fdem->store->grains,
                          b->built, fault));
  return cdem_membrane_restore(&b->membrane, state, fault); /* the lists have marked it anew */
}

/* Before the walls are restored: a sheared plate has another function. Which touches there are
 * follows from the places, but their forces and losses are of the step that led here and of
 * velocities before that step was perhaps changed: those are kept. */
cdem_status cdem_fdem_confine_restore(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  struct cdem_fdem_confine *b = s->confine;
  double real[REALS];
  CDEM_TRY(cdem_state_get(state, "fdem/confine", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(cdem_membrane_restore(&b->membrane, state, fault));
  walk(b, real, false);
  if (real[REALS - 1] != 0.0)
    cdem_fdem_shear(fdem, b->speed);
  calm(fdem);
  CDEM_TRY(find_again(fdem, state, fault));
  for (int32_t ring = 0; ring < b->membrane.rings; ring++)
    touch_ring(s, b, ring, fdem->step);
  CDEM_TRY(cdem_membrane_restore(&b->membrane, state, fault));
  walk(b, real, false);
  return cdem_state_get(state, "fdem/confine_lost", CDEM_ARRAY_REAL, b->membrane.rings, b->lost,
                        fault);
}
