/* The energy book: what stands where at t_n, and what was done since the start.
 *
 * Kinetic energy is m v- v+/2 of the half steps around t_n, v+ by the forces and the damping of t_n
 * (as in the room dem). With the mean velocity u and the acceleration a of t_n that is
 * m (u^2 - (dt a/2)^2)/2: below nought where the velocity turns within a step, as at the start of
 * grains that overlap at rest. Of implicit modes it is the scheme's own g v-^2/2.
 *
 * Damping and the scheme's loss are summed by kicks (motion.c); of the kick at t_n, which is still
 * to come, half belongs to the time before t_n: m v- (v- + dt a - v+)/2 of damping, and dt Q v-/2
 * of implicit modes, the half of the trapezoid's work that the energy g v-^2/2 has not had yet.
 * After a change of the step dt is the kick's, (dt- + dt+)/2, in the last of them dt-, and v- is
 * taken dt/2 before t_n instead of dt-/2.
 */
#include "fdem/confine.h"

typedef struct {
  double translation, rotation, vibration, elastic, damping, numerical;
} sums;

/* v+ of v- and dt a, damped by the fraction 2 half of critical in a step. */
static double damped(double v, double push, double half) {
  return ((1.0 - half) * v + push) / (1.0 + half);
}

static void rigid(const cdem_fdem_store *s, int64_t g, double later, sums *sum) {
  double v[3], l[3], force[3], moment[3], next[3], lost[3], spin[3];
  const double step = s->kick;
  double half = 0.5 * step * s->options.mass_damping;
  cdem_fdem_resultant(s, g, force, moment);
  for (int c = 0; c < 3; c++) {
    double push = step * (force[c] / s->mass[g] + s->options.gravity[c]);
    v[c] = s->velocity[3 * g + c] + later * (push / step);
    l[c] = s->momentum[3 * g + c] + later * moment[c];
    double then = damped(v[c], push, half);
    sum->translation += 0.5 * s->mass[g] * v[c] * then;
    sum->damping += 0.5 * s->mass[g] * v[c] * (v[c] + push - then);
    next[c] = damped(l[c], step * moment[c], half);
    lost[c] = l[c] + step * moment[c] - next[c];
  }
  cdem_fdem_spin_of(s, g, s->turn + 9 * g, next, spin);
  sum->rotation += 0.5 * cdem_dot3(l, spin);
  cdem_fdem_spin_of(s, g, s->turn + 9 * g, lost, spin);
  sum->damping += 0.5 * cdem_dot3(l, spin);
}

static void modes(const cdem_fdem_store *s, int64_t g, const double *load, double later,
                  sums *sum) {
  const cdem_template *t = cdem_fdem_template(s, g);
  const double *q = s->q + s->mode[g], *speed = s->rate + s->mode[g];
  double density = s->options.density[s->material[g]], r = s->radius[g];
  double mass = density * r * r * r, last = s->kick + 2.0 * later;
  bool implicit = s->options.integration == CDEM_FDEM_IMPLICIT;
  for (int k = 0; k < t->modes; k++) {
    double stiff = r * t->lambda[k];
    sum->elastic += 0.5 * stiff * q[k] * q[k];
    if (implicit) {
      sum->vibration += 0.5 * mass * speed[k] * speed[k];
      sum->numerical += 0.5 * last * load[k] * speed[k];
      continue;
    }
    double push = s->kick * (load[k] - stiff * q[k]) / mass;
    double rate = s->options.mass_damping + 2.0 * s->options.damping_ratio * sqrt(stiff / mass);
    double v = speed[k] + later * (push / s->kick);
    double next = damped(v, push, 0.5 * s->kick * rate);
    sum->vibration += 0.5 * mass * v * next;
    sum->damping += 0.5 * mass * v * (v + push - next);
  }
}

static void sum_up(const cdem_fdem *fdem, cdem_fdem_energies *e) {
  const cdem_fdem_store *s = fdem->store;
  const double later = 0.5 * (s->kick - fdem->step);
  sums sum = {0};
  for (int32_t b = 0; b < s->blocks; b++) {
    const cdem_fdem_block *block = s->block + b;
    int count = s->options.shape[block->shape].modes;
    cdem_fdem_loads_of(s, b, s->work);
    for (int m = 0; m < block->count; m++) {
      int64_t g = s->member[block->first + m];
      rigid(s, g, later, &sum);
      modes(s, g, s->work->load + (int64_t)m * count, later, &sum);
    }
  }
  e->translation = sum.translation;
  e->rotation = sum.rotation;
  e->vibration = sum.vibration;
  e->elastic = sum.elastic;
  e->damping += sum.damping;
  e->numerical += sum.numerical;
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
