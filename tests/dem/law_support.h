/* For the tests of contact laws: parameters for any law, random contacts, and the motion of two
 * grains (or of one on a plane) by the leapfrog of the solver. */
#ifndef CDEM_TESTS_DEM_LAW_SUPPORT_H
#define CDEM_TESTS_DEM_LAW_SUPPORT_H

#include "base/mat3.h"
#include "base/random.h"
#include "dem/batch.h"
#include "support/test.h"

static const cdem_grain_material glass = {"glass", 2800.0, 48e9, 0.2};

static inline cdem_contact_input no_input(void) {
  cdem_contact_input input;
  for (int key = 0; key < CDEM_LAW_KEYS; key++)
    input.value[key] = NAN;
  return input;
}

static inline bool wanted(const cdem_law_want *want, int wants, int key) {
  for (int i = 0; i < wants; i++)
    if ((int)want[i].key == key)
      return true;
  return false;
}

/* Something of everything that law and resistances want, for grains of 1 to 10 mm. Of words that
 * exclude each other, one: the input may be changed before use. */
static inline cdem_contact_input typical(const cdem_law *law, const cdem_resistance *rolling,
                                         const cdem_resistance *twisting) {
  static const struct {
    cdem_law_key key;
    double value;
  } table[] = {{CDEM_LAW_normal_stiffness, 1e6},      {CDEM_LAW_penalty_stiffness, 1e12},
               {CDEM_LAW_shear_stiffness, 3e5},       {CDEM_LAW_friction, 0.4},
               {CDEM_LAW_restitution, 0.7},           {CDEM_LAW_normal_dashpot, 10.0},
               {CDEM_LAW_shear_dashpot, 5.0},         {CDEM_LAW_rolling_stiffness, 5.0},
               {CDEM_LAW_rolling_dashpot, 1e-4},      {CDEM_LAW_rolling_friction, 0.1},
               {CDEM_LAW_rolling_length, 2e-4},       {CDEM_LAW_rolling_force_stiffness, 2e5},
               {CDEM_LAW_rolling_force_dashpot, 3.0}, {CDEM_LAW_rolling_force_friction, 0.2},
               {CDEM_LAW_twisting_stiffness, 4.0},    {CDEM_LAW_twisting_friction, 0.2}};
  cdem_contact_input input = no_input();
  bool restitution = wanted(law->want, law->wants, CDEM_LAW_restitution);
  for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
    int key = table[i].key;
    if (restitution && key == CDEM_LAW_normal_dashpot)
      continue;
    if (wanted(law->want, law->wants, key) || wanted(rolling->want, rolling->wants, key) ||
        wanted(twisting->want, twisting->wants, key))
      input.value[key] = table[i].value;
  }
  return input;
}

static inline void make_model(int dim, const cdem_law *law, const cdem_resistance *rolling,
                              const cdem_resistance *twisting, const cdem_contact_input *input,
                              cdem_contact_model *model) {
  cdem_fault fault = {0};
  check_ok(
      cdem_contact_model_init(dim, law, rolling, twisting, input, &glass, &glass, model, &fault));
}

/* The whole contact: law, rolling, twisting; fast or lane by lane. */
static inline void evaluate(int dim, const cdem_contact_model *m, bool energies, bool reference,
                            cdem_batch *b) {
  const cdem_resistance *beside[2] = {m->rolling, m->twisting};
  int d = dim - 2;
  for (int lane = 0; reference && lane < b->count; lane++) {
    m->law->one[d](&m->parameters[0], b, lane);
    for (int r = 0; r < 2; r++)
      if (beside[r]->one[d] != NULL)
        beside[r]->one[d](&m->parameters[1 + r], m->first[1 + r], b, lane);
  }
  if (reference)
    return;
  m->law->batch[d][energies](&m->parameters[0], b);
  for (int r = 0; r < 2; r++)
    if (beside[r]->batch[d][energies] != NULL)
      beside[r]->batch[d][energies](&m->parameters[1 + r], m->first[1 + r], b);
}

static inline void random_direction(cdem_random *random, int dim, double v[3]) {
  double length;
  do {
    for (int k = 0; k < 3; k++)
      v[k] = k < dim ? cdem_random_uniform(random, -1.0, 1.0) : 0.0;
    length = cdem_norm3(v);
  } while (length < 0.1 || length > 1.0);
  for (int k = 0; k < 3; k++)
    v[k] /= length;
}

/* Lanes 0 .. count - 1 with grains of 1 to 10 mm, histories of the size of the forces. */
static inline void random_batch(cdem_random *random, int dim, const cdem_contact_model *model,
                                int count, cdem_batch *b) {
  memset(b, 0, sizeof *b);
  b->count = count;
  b->step = 1e-6;
  for (int i = 0; i < CDEM_BATCH; i++) {
    b->n[0][i] = 1.0;
    b->arm[0][i] = b->arm[1][i] = b->mass[i] = b->radius[i] = 1.0;
  }
  for (int i = 0; i < count; i++) {
    double n[3], ra = cdem_random_uniform(random, 1e-3, 1e-2),
                 rb = cdem_random_uniform(random, 1e-3, 1e-2);
    double force = cdem_random_uniform(random, 0.0, 60.0), v[3];
    random_direction(random, dim, n);
    b->overlap[i] = cdem_random_uniform(random, 0.0, 1e-4);
    b->radius[i] = ra * rb / (ra + rb);
    b->mass[i] = cdem_random_uniform(random, 1e-5, 1e-2);
    b->arm[0][i] = ra - 0.5 * b->overlap[i];
    b->arm[1][i] = rb - 0.5 * b->overlap[i];
    b->label[i] = cdem_random_uniform(random, 0.0, 1.0) < 0.5 ? 1.0 : -1.0;
    for (int k = 0; k < dim; k++) {
      b->n[k][i] = n[k];
      b->velocity[k][i] = cdem_random_uniform(random, -2.0, 2.0);
      b->velocity_gain[k][i] = cdem_random_uniform(random, -0.1, 0.1);
    }
    for (int k = 0; k < (dim == 2 ? 1 : 3); k++) {
      b->turning[k][i] = cdem_random_uniform(random, -1.0, 1.0);
      b->turning_gain[k][i] = cdem_random_uniform(random, -0.1, 0.1);
      b->spin[k][i] = cdem_random_uniform(random, -200.0, 200.0);
      b->spin_gain[k][i] = cdem_random_uniform(random, -10.0, 10.0);
    }
    for (int h = 0; h < model->histories; h++)
      b->history[h][i] = cdem_random_uniform(random, -1.0, 1.0) * 0.01;
    /* tangent vectors near the plane, as the last step left them */
    int vectors = model->law->tangent_vectors;
    for (int h = 0; dim == 3 && h < vectors; h++) {
      random_direction(random, 3, v);
      double along = cdem_dot3(v, n);
      for (int k = 0; k < 3; k++)
        b->history[3 * h + k][i] = force / vectors * (v[k] - 0.99 * along * n[k]);
    }
    if (dim == 2 && vectors > 0)
      b->history[0][i] = cdem_random_uniform(random, -force, force);
    /* what is left are contact radii of hertz and mindlin, the largest, the last; or the overlap */
    double most = 1e-3;
    for (int h = 3 * vectors; dim == 3 && h < model->first[1]; h++)
      b->history[h][i] = most = cdem_random_uniform(random, 0.0, most);
  }
}

/* ---- two grains, or one on the plane of outward normal y (2-D) or z (3-D) through 0 ---- */

typedef struct {
  int dim;
  bool wall;
  double radius[2], mass[2], inertia[2];
  double x[2][3], v[2][3], w[2][3]; /* x at t_n, v and w at t_n - dt/2 */
  double gravity[3];
  cdem_contact_model model;
  bool reference;
  double time, step;
  /* of the contact at t_n */
  bool touching;
  double gain[2][6], overlap;
  double kinetic, stored, lost, work; /* at t_n; lost: damped + slid + rolled + circulated so far */
  double damped, slid, rolled, circulated;
  double force[3]; /* on A */
  cdem_batch batch;
} two_body;

static inline void two_body_init(two_body *t, int dim, bool wall, const cdem_contact_model *model,
                                 double radius_a, double radius_b, double density) {
  memset(t, 0, sizeof *t);
  t->dim = dim;
  t->wall = wall;
  t->model = *model;
  t->radius[0] = radius_a;
  t->radius[1] = radius_b;
  for (int g = 0; g < 2; g++) {
    double r = t->radius[g];
    t->mass[g] = dim == 2 ? density * M_PI * r * r : density * 4.0 / 3.0 * M_PI * r * r * r;
    t->inertia[g] = (dim == 2 ? 0.5 : 0.4) * t->mass[g] * r * r;
  }
}

static inline void two_body_geometry(two_body *t, double n[3]) {
  double length;
  if (t->wall) {
    for (int k = 0; k < 3; k++)
      n[k] = k == t->dim - 1 ? -1.0 : 0.0;
    t->overlap = t->radius[0] - t->x[0][t->dim - 1];
    return;
  }
  for (int k = 0; k < 3; k++)
    n[k] = t->x[1][k] - t->x[0][k];
  length = cdem_norm3(n);
  for (int k = 0; k < 3; k++)
    n[k] /= length;
  t->overlap = t->radius[0] + t->radius[1] - length;
}

static inline void two_body_fill(two_body *t, const double n[3]) {
  cdem_batch *b = &t->batch;
  double ra = t->radius[0], rb = t->radius[1];
  double length = t->wall ? ra - t->overlap : ra + rb - t->overlap;
  double arm[2] = {t->wall ? length : ra * length / (ra + rb),
                   t->wall ? 0.0 : rb * length / (ra + rb)};
  if (t->model.arms_by_radius) {
    arm[0] = ra;
    arm[1] = t->wall ? 0.0 : rb;
  }
  b->count = 1;
  b->step = t->step;
  b->overlap[0] = t->overlap;
  b->radius[0] = t->wall ? ra : ra * rb / (ra + rb);
  b->mass[0] = t->wall ? t->mass[0] : t->mass[0] * t->mass[1] / (t->mass[0] + t->mass[1]);
  b->label[0] = 1.0;
  b->fresh[0] = !t->touching;
  for (int g = 0; g < 2; g++)
    b->arm[g][0] = arm[g];
  for (int k = 0; k < t->dim; k++) {
    b->n[k][0] = n[k];
    b->velocity[k][0] = t->v[1][k] - t->v[0][k];
    b->velocity_gain[k][0] = t->gain[1][k] - t->gain[0][k];
  }
  for (int k = 0; k < (t->dim == 2 ? 1 : 3); k++) {
    int c = t->dim == 2 ? 2 : k;
    b->turning[k][0] = arm[0] * t->w[0][c] + arm[1] * t->w[1][c];
    b->turning_gain[k][0] = arm[0] * t->gain[0][3 + c] + arm[1] * t->gain[1][3 + c];
    b->spin[k][0] = t->w[1][c] - t->w[0][c];
    b->spin_gain[k][0] = t->gain[1][3 + c] - t->gain[0][3 + c];
  }
}

/* Forces at t_n, then the motion to t_{n+1}. */
static inline void two_body_step(two_body *t) {
  double n[3], force[2][3] = {{0}}, moment[2][3] = {{0}};
  cdem_batch *b = &t->batch;
  two_body_geometry(t, n);
  bool touches = t->overlap > 0.0;
  t->stored = 0.0;
  memset(t->force, 0, sizeof t->force);
  if (!touches)
    memset(b->history, 0, sizeof b->history);
  if (touches) {
    two_body_fill(t, n);
    evaluate(t->dim, &t->model, true, t->reference, b);
    double shear[3], pull[3];
    for (int k = 0; k < 3; k++)
      shear[k] = t->dim == 3 ? b->shear[k][0] : 0.0;
    if (t->dim == 2) {
      shear[0] = -n[1] * b->shear[0][0];
      shear[1] = n[0] * b->shear[0][0];
    }
    cdem_cross3(n, shear, pull);
    for (int k = 0; k < 3; k++) {
      double own = t->dim == 3 ? b->moment[k][0] : k == 2 ? b->moment[0][0] : 0.0;
      t->force[k] = force[0][k] = -b->normal[0] * n[k] + shear[k];
      force[1][k] = -force[0][k];
      moment[0][k] = b->arm[0][0] * pull[k] + own;
      moment[1][k] = b->arm[1][0] * pull[k] - own;
    }
    t->stored = b->stored_normal[0] + b->stored_shear[0] + b->stored_moment[0];
    t->damped += b->damped[0];
    t->slid += b->slid[0];
    t->rolled += b->rolled[0];
    t->circulated += b->circulated[0];
    t->lost = t->damped + t->slid + t->rolled + t->circulated;
  }
  t->touching = touches;
  t->kinetic = 0.0;
  for (int g = 0; g < (t->wall ? 1 : 2); g++)
    for (int k = 0; k < 3; k++) {
      double dv = (force[g][k] / t->mass[g] + t->gravity[k]) * t->step;
      double dw = moment[g][k] / t->inertia[g] * t->step;
      double v = t->v[g][k] + 0.5 * dv, w = t->w[g][k] + 0.5 * dw;
      t->kinetic += 0.5 * (t->mass[g] * v * v + t->inertia[g] * w * w);
      t->gain[g][k] = dv;
      t->gain[g][3 + k] = dw;
      t->work += t->mass[g] * t->gravity[k] * v * t->step;
      t->v[g][k] += dv;
      t->w[g][k] += dw;
      t->x[g][k] += t->v[g][k] * t->step;
    }
  t->time += t->step;
}

/* Until the two part again, at most `most` steps; how many they touched. */
static inline int64_t two_body_collide(two_body *t, int64_t most) {
  int64_t touched = 0;
  for (int64_t i = 0; i < most; i++) {
    two_body_step(t);
    touched += t->touching;
    if (touched > 0 && !t->touching)
      return touched;
  }
  fail_msg("no end of the collision in %lld steps", (long long)most);
  return 0;
}

#endif
