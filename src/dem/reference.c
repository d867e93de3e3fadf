/* Forces one contact at a time, in plain vector algebra: what the batches are tested against. */
#include "dem/solver_store.h"
#include "dem/walls_store.h"

#include <math.h>
#include <string.h>

/* One contact: geometry and motion, of a wall where `wall` says so. */
typedef struct {
  const cdem_contact_model *model;
  double n[3], overlap, arm[2], radius, mass, label;
  double velocity[3], wa[3], wb[3];                /* vB - vA, spins */
  double velocity_gain[3], wa_gain[3], wb_gain[3]; /* of the last kick */
  bool fresh;
  double *history;
} contact;

typedef struct {
  double force[3], on_a[3], on_b[3]; /* force on A; moments */
} answer;

static void lane_of(const contact *c, int dim, double step, int histories, cdem_batch *b) {
  b->count = 1;
  b->step = step;
  b->overlap[0] = c->overlap;
  b->arm[0][0] = c->arm[0];
  b->arm[1][0] = c->arm[1];
  b->radius[0] = c->radius;
  b->mass[0] = c->mass;
  b->label[0] = c->label;
  b->fresh[0] = c->fresh ? 1.0 : 0.0;
  for (int k = 0; k < 3; k++) {
    int from = dim == 3 ? k : 2;
    b->n[k][0] = c->n[k];
    b->velocity[k][0] = c->velocity[k];
    b->velocity_gain[k][0] = c->velocity_gain[k];
    b->turning[k][0] = c->arm[0] * c->wa[from] + c->arm[1] * c->wb[from];
    b->turning_gain[k][0] = c->arm[0] * c->wa_gain[from] + c->arm[1] * c->wb_gain[from];
    b->spin[k][0] = c->wb[from] - c->wa[from];
    b->spin_gain[k][0] = c->wb_gain[from] - c->wa_gain[from];
  }
  for (int h = 0; h < histories; h++)
    b->history[h][0] = c->fresh ? 0.0 : c->history[h];
}

static void evaluate(cdem_dem *dem, const contact *c, double step, answer *out,
                     cdem_dem_part *part) {
  const cdem_dem_store *s = dem->store;
  cdem_batch *b = &s->core->work[0].batch;
  const cdem_contact_model *m = c->model;
  int solid = dem->dim - 2;
  lane_of(c, dem->dim, step, s->histories, b);
  m->law->one[solid](&m->parameters[0], b, 0);
  if (m->rolling != NULL && m->rolling->one[solid] != NULL)
    m->rolling->one[solid](&m->parameters[1], m->first[1], b, 0);
  if (m->twisting != NULL && m->twisting->one[solid] != NULL)
    m->twisting->one[solid](&m->parameters[2], m->first[2], b, 0);
  double shear[3], moment[3] = {0}, turn[3];
  for (int k = 0; k < 3; k++) {
    shear[k] = solid ? b->shear[k][0] : 0.0;
    moment[k] = solid ? b->moment[k][0] : 0.0;
  }
  if (!solid) {
    shear[0] = -c->n[1] * b->shear[0][0];
    shear[1] = c->n[0] * b->shear[0][0];
    moment[2] = b->moment[0][0];
  }
  cdem_cross3(c->n, shear, turn);
  for (int k = 0; k < 3; k++) {
    out->force[k] = shear[k] - b->normal[0] * c->n[k];
    out->on_a[k] = c->arm[0] * turn[k] + moment[k];
    out->on_b[k] = c->arm[1] * turn[k] - moment[k];
  }
  for (int h = 0; h < s->histories; h++)
    c->history[h] = b->history[h][0];
  if (!s->options.energies || step == 0.0)
    return;
  part->sum[CDEM_DEM_DAMPED] += b->damped[0];
  part->sum[CDEM_DEM_SLID] += b->slid[0];
  part->sum[CDEM_DEM_ROLLED] += b->rolled[0];
  part->sum[CDEM_DEM_CIRCULATED] += b->circulated[0];
}

static const cdem_contact_model *model_of(const cdem_dem_store *s, int32_t a, int32_t b) {
  return &s->core->model[s->core->model_of[a * s->options.materials + b]];
}

/* Spin, and its growth in the last kick. */
static void spins(const cdem_dem_store *s, int32_t i, double w[3], double gain[3]) {
  memcpy(w, cdem_motion(s, i) + 3, 3 * sizeof *w);
  for (int k = 0; k < 3; k++)
    gain[k] = s->core->gain != NULL ? s->core->gain[8 * (int64_t)i + 3 + k] : 0.0;
}

static double gain_of(const cdem_dem_store *s, int32_t i, int k) {
  return s->core->gain != NULL ? s->core->gain[8 * (int64_t)i + k] : 0.0;
}

static void pair(cdem_dem *dem, int64_t p, double step, cdem_dem_part *part) {
  cdem_dem_store *s = dem->store;
  int32_t i = s->core->pair_owner[p], j = s->pair_other[p];
  const double *x = cdem_place(s, i), *y = cdem_place(s, j);
  const double *v = cdem_motion(s, i), *u = cdem_motion(s, j);
  const int image = s->pair_image != NULL ? s->pair_image[p] : CDEM_IMAGE_SELF;
  bool images = s->pair_image != NULL;
  contact c = {.model = model_of(s, s->material[i], s->material[j])};
  double d[3], sum = x[3] + y[3];
  for (int k = 0; k < 3; k++) {
    d[k] = y[k] - x[k] + (images ? s->image[image][k] : 0.0);
    c.velocity[k] = u[k] - v[k] + (images ? s->image_velocity[image][k] : 0.0);
    c.velocity_gain[k] = gain_of(s, j, k) - gain_of(s, i, k);
  }
  if (s->pair_touch[p] == 2)
    return;
  double length = cdem_norm3(d);
  if (cdem_dot3(d, d) >= sum * sum) {
    s->pair_touch[p] = 0;
    return;
  }
  for (int k = 0; k < 3; k++)
    c.n[k] = d[k] / length;
  c.overlap = sum - length;
  c.arm[0] = c.model->arms_by_radius ? x[3] : x[3] * length / sum;
  c.arm[1] = c.model->arms_by_radius ? y[3] : y[3] * length / sum;
  c.radius = x[3] * y[3] / sum;
  c.mass = v[6] * u[6] / (v[6] + u[6]);
  c.label = s->id[i] < s->id[j] ? 1.0 : -1.0;
  c.fresh = s->pair_touch[p] == 0;
  c.history = s->pair_history + p * s->histories;
  spins(s, i, c.wa, c.wa_gain);
  spins(s, j, c.wb, c.wb_gain);
  answer out;
  evaluate(dem, &c, step, &out, part);
  s->pair_touch[p] = 1;
  double *fi = cdem_force(s, i), *fj = cdem_force(s, j);
  for (int k = 0; k < 3; k++) {
    fi[k] += out.force[k];
    fj[k] -= out.force[k];
    fi[3 + k] += out.on_a[k];
    fj[3 + k] += out.on_b[k];
    s->core->image_force[image][k] += images ? out.force[k] : 0.0;
    for (int e = 0; images && e < 3; e++)
      s->core->stress[3 * k + e] += out.force[k] * d[e];
  }
}

static void wall(cdem_dem *dem, int32_t i, const cdem_wall_touch *t, double step,
                 cdem_dem_part *part) {
  cdem_dem_store *s = dem->store;
  const double *x = cdem_place(s, i), *v = cdem_motion(s, i);
  contact c = {.model = model_of(s, s->material[i], t->material), .label = 1.0};
  c.overlap = t->overlap;
  c.arm[0] = c.model->arms_by_radius ? x[3] : x[3] - t->overlap;
  c.radius = x[3];
  c.mass = v[6];
  c.history = cdem_walls_history(s, t, &c.fresh);
  spins(s, i, c.wa, c.wa_gain);
  for (int k = 0; k < 3; k++) {
    c.n[k] = t->n[k];
    c.velocity[k] = t->velocity[k] - v[k];
    c.velocity_gain[k] = -gain_of(s, i, k);
    c.wb[k] = t->spin[k];
  }
  answer out;
  evaluate(dem, &c, step, &out, part);
  double *f = cdem_force(s, i), *w = s->core->wall_force + 6 * (int64_t)t->wall, arm[3], turn[3];
  double normal, shear, dashpot[2];
  for (int k = 0; k < 3; k++)
    arm[k] = t->point[k] - s->core->wall_center[3 * (int64_t)t->wall + k];
  cdem_cross3(arm, out.force, turn);
  for (int k = 0; k < 3; k++) {
    f[k] += out.force[k];
    f[3 + k] += out.on_a[k];
    w[k] -= out.force[k];
    w[3 + k] += out.on_b[k] - turn[k];
  }
  c.model->law->stiffness(&c.model->parameters[0], c.radius, c.mass, c.overlap, &normal, &shear,
                          dashpot);
  s->core->wall_push[t->wall] -= cdem_dot3(out.force, t->n);
  s->core->wall_stiff[t->wall] += normal + (step > 0.0 ? dashpot[0] / step : 0.0);
}

static void walls(cdem_dem *dem, double step, cdem_dem_part *part) {
  cdem_dem_store *s = dem->store;
  const int32_t *row = cdem_walls_rows(s);
  memset(s->core->wall_force, 0, (size_t)s->options.walls * 6 * sizeof(double));
  memset(s->core->wall_stiff, 0, (size_t)s->options.walls * sizeof(double));
  memset(s->core->wall_push, 0, (size_t)s->options.walls * sizeof(double));
  for (int32_t i = 0; i < s->grains; i++) {
    cdem_wall_touch touch[CDEM_WALL_TOUCHES];
    int found = row[i] < row[i + 1] ? cdem_walls_find(s, i, touch) : 0;
    for (int k = 0; k < found; k++)
      wall(dem, i, &touch[k], step, part);
  }
}

void cdem_dem_reference(cdem_dem *dem, double step) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  cdem_dem_part *part = &core->part[0];
  double volume = cdem_cell_volume(s->dim, &s->cell) * (s->dim == 2 ? core->thickness : 1.0);
  memset(core->stress, 0, sizeof core->stress);
  memset(core->image_force, 0, sizeof core->image_force);
  part->touches = 0;
  for (int64_t p = 0; p < s->pairs; p++) {
    pair(dem, p, step, part);
    part->touches += s->pair_touch[p] == 1;
  }
  for (int32_t c = 0; core->bonds > 0 && c < core->chunks; c++)
    cdem_bonds_forces(dem, c, step);
  if (s->walls != NULL)
    walls(dem, step, part);
  for (int k = 0; k < 9; k++)
    core->stress[k] = volume > 0.0 ? core->stress[k] / volume : 0.0;
}
