/* The energy book: what stands where at t_n, and what was done since the start.
 *
 * Kinetic energy is m v- v+/2 of the half steps around t_n, v+ by the forces of t_n (as in the room
 * dem). Of implicit modes it is g v- (v- + dt Q/g)/2: the scheme's own energy with the half of the
 * trapezoid that is still to come (motion.c).
 */
#include "fdem/confine.h"

typedef struct {
  double translation, rotation, vibration, elastic;
} kinetic;

static void rigid(const cdem_fdem_store *s, int64_t g, double step, kinetic *sum) {
  const double *v = s->velocity + 3 * g, *l = s->momentum + 3 * g, *center = s->center + 3 * g;
  double next[3] = {l[0], l[1], l[2]}, spin[3], force[3] = {0.0, 0.0, 0.0};
  for (int64_t i = s->first[g]; i < s->first[g + 1]; i++) {
    const double *x = s->now + 3 * i, *f = s->force + 3 * i;
    double arm[3] = {x[0] - center[0], x[1] - center[1], x[2] - center[2]}, part[3];
    cdem_cross3(arm, f, part);
    for (int c = 0; c < 3; c++) {
      next[c] += step * part[c];
      force[c] += f[c];
    }
  }
  for (int c = 0; c < 3; c++)
    sum->translation +=
        0.5 * s->mass[g] * v[c] * (v[c] + step * (force[c] / s->mass[g] + s->options.gravity[c]));
  cdem_fdem_spin_of(s, g, s->turn + 9 * g, next, spin);
  sum->rotation += 0.5 * cdem_dot3(l, spin);
}

static void modes(const cdem_fdem_store *s, int64_t g, const double *load, double step,
                  kinetic *sum) {
  const cdem_template *t = cdem_fdem_template(s, g);
  const double *q = s->q + s->mode[g], *v = s->rate + s->mode[g];
  double density = s->options.density[s->material[g]], r = s->radius[g];
  double mass = density * r * r * r;
  bool implicit = s->options.integration == CDEM_FDEM_IMPLICIT;
  for (int k = 0; k < t->modes; k++) {
    double stiff = r * t->lambda[k], pull = load[k] - (implicit ? 0.0 : stiff * q[k]);
    sum->vibration += 0.5 * v[k] * (mass * v[k] + step * pull);
    sum->elastic += 0.5 * stiff * q[k] * q[k];
  }
}

static void sum_up(const cdem_fdem *fdem, cdem_fdem_energies *e) {
  const cdem_fdem_store *s = fdem->store;
  kinetic sum = {0};
  for (int32_t b = 0; b < s->blocks; b++) {
    const cdem_fdem_block *block = s->block + b;
    int count = s->options.shape[block->shape].modes;
    cdem_fdem_loads_of(s, b, s->work);
    for (int m = 0; m < block->count; m++) {
      int64_t g = s->member[block->first + m];
      rigid(s, g, fdem->step, &sum);
      modes(s, g, s->work->load + (int64_t)m * count, fdem->step, &sum);
    }
  }
  e->translation = sum.translation;
  e->rotation = sum.rotation;
  e->vibration = sum.vibration;
  e->elastic = sum.elastic;
}

void cdem_fdem_energies_now(const cdem_fdem *fdem, cdem_fdem_energies *e) {
  cdem_fdem_store *s = fdem->store;
  *e = (cdem_fdem_energies){.normal = s->contact.normal,
                            .shear = s->contact.shear,
                            .friction = s->contact.friction,
                            .damping = s->contact.damping + s->sums.damping,
                            .numerical = s->sums.numerical,
                            .walls = s->contact.walls,
                            .initial = s->initial};
  sum_up(fdem, e);
  for (int64_t g = 0; g < s->grains; g++)
    for (int c = 0; c < 3; c++)
      e->gravity +=
          s->mass[g] * s->options.gravity[c] * (s->center[3 * g + c] - s->start[3 * g + c]);
  if (s->confine != NULL)
    cdem_fdem_confine_energies(fdem, e);
  double kept =
      e->translation + e->rotation + e->vibration + e->elastic + e->normal + e->shear + e->membrane;
  double done = e->gravity + e->walls + e->pressure;
  e->error = kept + e->friction + e->damping + e->numerical - done - e->initial;
  const double term[] = {e->initial, kept,     e->friction, e->damping,     e->numerical,
                         e->gravity, e->walls, e->elastic,  e->translation, e->pressure};
  for (size_t i = 0; i < sizeof term / sizeof *term; i++)
    s->exchange = fmax(s->exchange, fabs(term[i]));
  e->exchange = s->exchange;
}

void cdem_fdem_book_start(cdem_fdem *fdem) {
  cdem_fdem_energies e;
  cdem_fdem_store *s = fdem->store;
  s->contact.friction = s->contact.damping = s->contact.walls = 0.0;
  s->exchange = s->initial = 0.0;
  cdem_fdem_energies_now(fdem, &e);
  s->initial = e.error;
}

void cdem_fdem_momentum(const cdem_fdem *fdem, double linear[3], double angular[3]) {
  const cdem_fdem_store *s = fdem->store;
  for (int c = 0; c < 3; c++)
    linear[c] = angular[c] = 0.0;
  for (int64_t g = 0; g < s->grains; g++) {
    double p[3], orbit[3], middle[3];
    for (int c = 0; c < 3; c++) {
      p[c] = s->mass[g] * s->velocity[3 * g + c];
      middle[c] = s->center[3 * g + c] - 0.5 * fdem->step * s->velocity[3 * g + c];
    }
    cdem_cross3(middle, p, orbit);
    for (int c = 0; c < 3; c++) {
      linear[c] += p[c];
      angular[c] += orbit[c] + s->momentum[3 * g + c];
    }
  }
}
