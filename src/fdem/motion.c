/* Grains go from t_n to t_{n+1}: a block of one template at a time.
 *
 * Modes, with g = rho s^3 the generalised mass, w2 = lambda/(rho s^2), c = c_m + 2 zeta sqrt(w2):
 *     explicit  (v+ - v-)/dt = Q/g - w2 q_n - c (v+ + v-)/2
 *     implicit  (v+ - v-)/dt = Q/g - w2 q_{n+1} - c v+,   q_{n+1} = q_n + dt v+
 * Multiplied by g dt v+, the implicit one says what it takes out of the motion: g dt c v+^2 by
 * damping, and g (dv^2 + w2 dq^2)/2 by the scheme. Against works by the trapezoid, Q (dt- v- + dt
 * v+)/2, it takes Q (dt v+ - dt- v-)/2 less: `numerical` is what remains. dt- is the step before
 * this one. v of the explicit scheme and of the rigid motion belongs to the middle of a step, so it
 * is kicked by (dt- + dt)/2; that of the implicit one to its end.
 *
 * Rigid motion: v by its force, angular momentum L by its moment; the spin that turns the frame is
 * that of L at the orientation in the middle of the step.
 */
#include "base/quaternion.h"
#include "fdem/solver_store.h"

#include <cblas.h>
#include <string.h>

/* ---- rotations ---- */

/* out = exp(angle) q, the rotation by the vector `angle` after q; of unit length again. */
static void turn_by(const double angle[3], const double q[4], double out[4]) {
  double size = cdem_norm3(angle), part = size > 0.0 ? sin(0.5 * size) / size : 0.5;
  const double by[4] = {cos(0.5 * size), part * angle[0], part * angle[1], part * angle[2]};
  cdem_quaternion_product(by, q, out);
  cdem_quaternion_normalise(out);
}

static void times(const double m[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

static void back(const double m[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2];
}

void cdem_fdem_spin_of(const cdem_fdem_store *s, int64_t g, const double turn[9],
                       const double momentum[3], double spin[3]) {
  double in_body[3], turned[3];
  back(turn, momentum, in_body);
  times(s->spins + 9 * g, in_body, turned);
  times(turn, turned, spin);
}

/* ---- rigid motion ---- */

static void rotate(cdem_fdem_store *s, int64_t g, double step) {
  double spin[3], half[4], turn[9], angle[3], old[4];
  memcpy(old, s->quaternion + 4 * g, sizeof old);
  cdem_fdem_spin_of(s, g, s->turn + 9 * g, s->momentum + 3 * g, spin);
  for (int c = 0; c < 3; c++)
    angle[c] = 0.5 * step * spin[c];
  turn_by(angle, old, half);
  cdem_quaternion_matrix(half, turn);
  cdem_fdem_spin_of(s, g, turn, s->momentum + 3 * g, spin);
  for (int c = 0; c < 3; c++)
    angle[c] = step * spin[c];
  turn_by(angle, old, s->quaternion + 4 * g);
  cdem_quaternion_matrix(s->quaternion + 4 * g, s->turn + 9 * g);
}

void cdem_fdem_resultant(const cdem_fdem_store *s, int64_t g, double force[3], double moment[3]) {
  const double *center = s->center + 3 * g;
  for (int c = 0; c < 3; c++)
    force[c] = moment[c] = 0.0;
  for (int64_t i = s->first[g]; i < s->first[g + 1]; i++) {
    const double *f = s->force + 3 * i, *x = s->now + 3 * i;
    double arm[3] = {x[0] - center[0], x[1] - center[1], x[2] - center[2]}, part[3];
    cdem_cross3(arm, f, part);
    for (int c = 0; c < 3; c++) {
      force[c] += f[c];
      moment[c] += part[c];
    }
  }
}

/* Returns false when the motion cannot go on. */
static bool move_rigid(cdem_fdem_store *s, int64_t g, double step, cdem_fdem_sums *sums) {
  double force[3], moment[3], spin[3], mean[3], way = 0.0, power = 0.0;
  double half = 0.5 * s->kick * s->options.mass_damping;
  double *v = s->velocity + 3 * g, *l = s->momentum + 3 * g;
  cdem_fdem_resultant(s, g, force, moment);
  for (int c = 0; c < 3; c++) {
    double total = force[c] + s->mass[g] * s->options.gravity[c];
    double next = ((1.0 - half) * v[c] + s->kick * total / s->mass[g]) / (1.0 + half);
    double middle = 0.5 * (v[c] + next);
    power += s->mass[g] * middle * middle;
    v[c] = next;
    s->center[3 * g + c] += step * next;
    way += step * next * step * next;
    next = ((1.0 - half) * l[c] + s->kick * moment[c]) / (1.0 + half);
    mean[c] = 0.5 * (l[c] + next);
    l[c] = next;
  }
  cdem_fdem_spin_of(s, g, s->turn + 9 * g, mean, spin);
  sums->damping += 2.0 * half * (power + cdem_dot3(spin, mean));
  rotate(s, g, step);
  double bound = 0.5 * s->radius[g];
  return way < bound * bound;
}

/* ---- modes ---- */

typedef struct {
  const double *load, *lambda;
  double *q, *v;
  int modes;
  double mass, size, kick, step, last, damping, ratio; /* of the generalised masses; w2 = lambda
                                                          size; last: the step before */
} mode_row;

static void move_implicit(const mode_row *r, cdem_fdem_sums *sums) {
  double damped = 0.0, numerical = 0.0;
  for (int k = 0; k < r->modes; k++) {
    double w2 = r->lambda[k] * r->size;
    double c = r->damping + 2.0 * r->ratio * sqrt(w2);
    double pull = r->load[k] / r->mass, old = r->v[k];
    double next = (old + r->step * (pull - w2 * r->q[k])) / (1.0 + r->step * (r->step * w2 + c));
    double gain = next - old, way = r->step * next;
    damped += c * next * next;
    numerical += gain * gain + w2 * way * way - pull * (way - r->last * old);
    r->v[k] = next;
    r->q[k] += way;
  }
  sums->damping += r->mass * r->step * damped;
  sums->numerical += 0.5 * r->mass * numerical;
}

static void move_explicit(const mode_row *r, cdem_fdem_sums *sums) {
  double damped = 0.0;
  for (int k = 0; k < r->modes; k++) {
    double w2 = r->lambda[k] * r->size;
    double half = 0.5 * r->kick * (r->damping + 2.0 * r->ratio * sqrt(w2));
    double pull = r->load[k] / r->mass - w2 * r->q[k], old = r->v[k];
    double next = ((1.0 - half) * old + r->kick * pull) / (1.0 + half);
    damped += half * (old + next) * (old + next);
    r->v[k] = next;
    r->q[k] += r->step * next;
  }
  sums->damping += 0.5 * r->mass * damped;
}

static void move_modes(cdem_fdem_store *s, int64_t g, const double *load, double step,
                       cdem_fdem_sums *sums) {
  const cdem_template *t = cdem_fdem_template(s, g);
  double density = s->options.density[s->material[g]], radius = s->radius[g];
  mode_row row = {.load = load,
                  .lambda = t->lambda,
                  .q = s->q + s->mode[g],
                  .v = s->rate + s->mode[g],
                  .modes = t->modes,
                  .mass = density * radius * radius * radius,
                  .size = 1.0 / (density * radius * radius),
                  .kick = s->kick,
                  .step = step,
                  .last = 2.0 * s->kick - step,
                  .damping = s->options.mass_damping,
                  .ratio = s->options.damping_ratio};
  if (s->options.integration == CDEM_FDEM_IMPLICIT)
    move_implicit(&row, sums);
  else
    move_explicit(&row, sums);
}

/* ---- products ---- */

/* y [columns][rows] = a^T x or a x + y, a [inner or rows][...] as cblas takes it. */
static void project(const cdem_fdem_store *s, const cdem_template *t, int count, const double *skin,
                    double *load) {
  int rows = 3 * t->surface.nodes, modes = t->modes;
  if (!s->options.reference) {
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, modes, count, rows, 1.0, t->skin, rows,
                skin, rows, 0.0, load, modes);
    return;
  }
  for (int b = 0; b < count; b++)
    for (int k = 0; k < modes; k++) {
      double sum = 0.0;
      for (int i = 0; i < rows; i++)
        sum += t->skin[(int64_t)k * rows + i] * skin[(int64_t)b * rows + i];
      load[(int64_t)b * modes + k] = sum;
    }
}

static void expand(const cdem_fdem_store *s, const cdem_template *t, int count, const double *q,
                   double *skin) {
  int rows = 3 * t->surface.nodes, modes = t->modes;
  if (!s->options.reference) {
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows, count, modes, 1.0, t->skin, rows,
                q, modes, 1.0, skin, rows);
    return;
  }
  for (int b = 0; b < count; b++)
    for (int k = 0; k < modes; k++)
      for (int i = 0; i < rows; i++)
        skin[(int64_t)b * rows + i] += t->skin[(int64_t)k * rows + i] * q[(int64_t)b * modes + k];
}

void cdem_fdem_loads_of(const cdem_fdem_store *s, int32_t block, cdem_fdem_work *work) {
  const cdem_fdem_block *b = s->block + block;
  const cdem_template *t = s->options.shape + b->shape;
  int rows = 3 * t->surface.nodes;
  for (int m = 0; m < b->count; m++) {
    int64_t g = s->member[b->first + m];
    double *out = work->skin + (int64_t)m * rows;
    for (int64_t i = s->first[g]; i < s->first[g + 1]; i++, out += 3)
      back(s->turn + 9 * g, s->force + 3 * i, out);
  }
  project(s, t, b->count, work->skin, work->load);
}

/* ---- a block ---- */

void cdem_fdem_place_block(cdem_fdem_store *s, int32_t block, cdem_fdem_work *work) {
  const cdem_fdem_block *b = s->block + block;
  const cdem_template *t = s->options.shape + b->shape;
  int rows = 3 * t->surface.nodes;
  for (int m = 0; m < b->count; m++) {
    double radius = s->radius[s->member[b->first + m]];
    for (int i = 0; i < rows; i++)
      work->skin[(int64_t)m * rows + i] = radius * t->surface.reference[i];
  }
  expand(s, t, b->count, s->q + s->mode[s->member[b->first]], work->skin);
  for (int m = 0; m < b->count; m++) {
    int64_t g = s->member[b->first + m];
    const double *in = work->skin + (int64_t)m * rows, *center = s->center + 3 * g;
    for (int64_t i = s->first[g]; i < s->first[g + 1]; i++, in += 3) {
      double x[3];
      times(s->turn + 9 * g, in, x);
      for (int c = 0; c < 3; c++) {
        s->place[3 * i + c] = in[c];
        s->before[3 * i + c] = s->now[3 * i + c];
        s->now[3 * i + c] = center[c] + x[c];
      }
    }
  }
}

void cdem_fdem_move_block(cdem_fdem_store *s, int32_t block, double step, cdem_fdem_work *work) {
  const cdem_fdem_block *b = s->block + block;
  cdem_fdem_part *part = s->part + block;
  int modes = s->options.shape[b->shape].modes;
  *part = (cdem_fdem_part){.bad = -1};
  cdem_fdem_loads_of(s, block, work);
  for (int m = 0; m < b->count; m++) {
    int32_t g = s->member[b->first + m];
    if (!move_rigid(s, g, step, &part->sums) && part->bad < 0)
      part->bad = g;
    move_modes(s, g, work->load + (int64_t)m * modes, step, &part->sums);
    if (!isfinite(part->sums.damping + part->sums.numerical) && part->bad < 0)
      part->bad = g; /* nodes that are nowhere would only stop touching */
  }
  cdem_fdem_place_block(s, block, work);
}
