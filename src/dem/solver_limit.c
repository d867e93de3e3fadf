/* The largest stable step.
 *
 * The scheme is stable for x* K x dt^2 + 2 x* C x dt <= 4 x* M x for all x (dashpots act with the
 * velocity of half a step before). With bounds k of K and c of C against M that is
 *     dt <= 4/(c + sqrt(c^2 + 4 k)).
 * Dashpots stand beside springs, so their bound is found in the same way; here for springs. Each
 * contact's energy k s^2/2 in its deformation s = s_A - s_B is at most k (w_A s_A^2 + w_B s_B^2)/2
 * with 1/w_A + 1/w_B = 1; with w_A = (mA + mB)/mB two grains alone get their exact 2/sqrt(k/m*). So
 * K falls apart into one 6x6 block a grain, and a bound of its largest eigenvalue against m and I
 * is wanted. Two are taken, the smaller one counts:
 *   - the sum over contacts of w max(kn, ks (1 + a^2 m/I)): exact for one contact;
 *   - the larger eigenvalue of [ |T|/m  |c|/sqrt(m I) ; . |R|/I ], T, R the translational and
 *     rotational blocks and c = sum of w ks a n their coupling, |.| the norm (Gershgorin's bound).
 * The stiffest candidate that does not touch yet is added as one more contact. A grain that is
 * alone is taken to meet its like.
 *
 * Stiffness that grows with overlap (hertz) is taken at the overlap that the pair's own energy, the
 * elastic one and that of its relative velocity, can press it to: from k ~ d^p, E = k
 * d^2/((1+p)(2+p)). At least 1/1000 of the reduced radius counts. What others press a contact to
 * beyond that is left to the safety: at 0.1 stiffness may grow to the 100-fold. */
#include "dem/confine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of one grain, of springs or of dashpots. */
typedef struct {
  double t[6], r[6], c[3]; /* xx yy zz xy yz xz */
  double sum, fresh;       /* first bound times m; of a contact to come */
} block;

typedef struct {
  block spring, dash;
  int32_t contacts;
} row;

typedef struct {
  const cdem_dem *dem;
  row *rows;
  double factor; /* m r^2/I */
  double *touched;
} limits;

typedef struct {
  double kn, ks, dash[2], rolling, twisting;
} stiffness;

static void at_overlap(const cdem_contact_model *model, double radius, double mass, double overlap,
                       stiffness *k) {
  model->law->stiffness(&model->parameters[0], radius, mass, overlap, &k->kn, &k->ks, k->dash);
}

/* Of a contact with this overlap (0: none yet) and relative speed. */
static void stiffness_of(const cdem_contact_model *model, double radius, double mass,
                         double overlap, double speed, stiffness *k) {
  stiffness twice;
  double least = fmax(overlap, 1e-3 * radius);
  at_overlap(model, radius, mass, least, k);
  at_overlap(model, radius, mass, 2.0 * least, &twice);
  if (twice.kn > k->kn && k->kn > 0.0) {
    double p = log2(twice.kn / k->kn);
    double here = k->kn * least * least / ((1.0 + p) * (2.0 + p));
    double more = 0.5 * mass * speed * speed;
    at_overlap(model, radius, mass, least * pow((here + more) / here, 1.0 / (2.0 + p)), k);
  }
  k->rolling = model->rolling != NULL && model->rolling->stiffness != NULL
                   ? model->rolling->stiffness(&model->parameters[1], radius)
                   : 0.0;
  k->twisting = model->twisting != NULL && model->twisting->stiffness != NULL
                    ? model->twisting->stiffness(&model->parameters[2], radius)
                    : 0.0;
}

static void add_block(block *g, const stiffness *k, double w, double arm, double lever,
                      const double n[3]) {
  static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  for (int e = 0; e < 6; e++) {
    double nn = n[at[e][0]] * n[at[e][1]], one = e < 3 ? 1.0 : 0.0;
    g->t[e] += w * (k->kn * nn + k->ks * (one - nn));
    g->r[e] += w * ((k->ks * (arm * arm) + k->rolling) * (one - nn) + k->twisting * nn);
  }
  for (int c = 0; c < 3; c++)
    g->c[c] += w * k->ks * arm * n[c];
  double rolling = fmax(k->rolling, k->twisting) * lever / (arm * arm);
  g->sum += w * (fmax(k->kn, k->ks * (1.0 + lever)) + rolling);
}

static stiffness dashpots(const stiffness *k) {
  return (stiffness){.kn = k->dash[0], .ks = k->dash[1]};
}

/* A contact on one of its grains. */
static void add(row *g, const stiffness *k, double w, double arm, double radius, double factor,
                const double n[3]) {
  double lever = factor * (arm / radius) * (arm / radius); /* a^2 m/I */
  stiffness dash = dashpots(k);
  add_block(&g->spring, k, w, arm, lever, n);
  add_block(&g->dash, &dash, w, arm, lever, n);
  g->contacts++;
}

static void add_fresh(row *g, const stiffness *k, double w, double factor) {
  g->spring.fresh = fmax(g->spring.fresh, w * fmax(k->kn, k->ks * (1.0 + factor)));
  g->dash.fresh = fmax(g->dash.fresh, w * fmax(k->dash[0], k->dash[1] * (1.0 + factor)));
}

static double relative_speed(const cdem_dem_store *s, int32_t i, int32_t j) {
  const double *a = cdem_motion(s, i), *b = cdem_motion(s, j);
  double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return cdem_norm3(d);
}

static void add_pairs(const limits *l) {
  const cdem_dem_store *s = l->dem->store;
  const cdem_dem_core *core = s->core;
  for (int64_t p = 0; p < s->pairs; p++) {
    int32_t i = core->pair_owner[p], j = s->pair_other[p];
    const double *x = cdem_place(s, i), *y = cdem_place(s, j);
    double ma = cdem_motion(s, i)[6], mb = cdem_motion(s, j)[6], n[3];
    double radius = x[3] * y[3] / (x[3] + y[3]), mass = ma * mb / (ma + mb);
    if (s->pair_touch[p] == 2)
      continue;
    for (int c = 0; c < 3; c++)
      n[c] = y[c] - x[c] + (s->pair_image != NULL ? s->image[s->pair_image[p]][c] : 0.0);
    double length = cdem_norm3(n), overlap = x[3] + y[3] - length;
    stiffness k;
    const cdem_contact_model *model =
        &core->model[core->model_of[s->material[i] * s->options.materials + s->material[j]]];
    stiffness_of(model, radius, mass, fmax(overlap, 0.0), relative_speed(s, i, j), &k);
    if (overlap > 0.0 && length > 0.0) {
      for (int c = 0; c < 3; c++)
        n[c] /= length;
      double share = length / (x[3] + y[3]);
      add(&l->rows[i], &k, (ma + mb) / mb, x[3] * share, x[3], l->factor, n);
      add(&l->rows[j], &k, (ma + mb) / ma, y[3] * share, y[3], l->factor, n);
    } else {
      add_fresh(&l->rows[i], &k, (ma + mb) / mb, l->factor);
      add_fresh(&l->rows[j], &k, (ma + mb) / ma, l->factor);
    }
  }
}

static void add_bonds(const limits *l) {
  const cdem_dem_store *s = l->dem->store;
  for (int64_t b = 0; b < s->core->bonds; b++) {
    const cdem_bond_state *bond = &s->core->bond[b];
    const cdem_bond_law *law = &s->options.bond_law[bond->law];
    const double *x = cdem_place(s, bond->owner), *y = cdem_place(s, bond->other);
    double ma = cdem_motion(s, bond->owner)[6], mb = cdem_motion(s, bond->other)[6], n[3];
    if (!bond->holds)
      continue;
    for (int c = 0; c < 3; c++)
      n[c] = y[c] - x[c] + (s->pair_image != NULL ? s->image[bond->image][c] : 0.0);
    double length = cdem_norm3(n), share = length / (x[3] + y[3]), mass = ma * mb / (ma + mb);
    for (int c = 0; c < 3; c++)
      n[c] /= length;
    stiffness k = {law->normal_stiffness,
                   law->shear_stiffness,
                   {2.0 * law->damping_ratio * sqrt(law->normal_stiffness * mass),
                    2.0 * law->damping_ratio * sqrt(law->shear_stiffness * mass)},
                   law->rolling_stiffness,
                   law->twisting_stiffness};
    add(&l->rows[bond->owner], &k, (ma + mb) / mb, x[3] * share, x[3], l->factor, n);
    add(&l->rows[bond->other], &k, (ma + mb) / ma, y[3] * share, y[3], l->factor, n);
  }
}

/* Walls do not move by their forces: w = 1. */
static void add_touch(void *context, const cdem_dem_visit *visit) {
  const limits *l = context;
  const cdem_batch *b = &visit->work->batch;
  for (int k = 0; visit->wall && k < visit->count; k++) {
    int32_t i = visit->work->wall_grain[visit->touch[k]];
    double n[3] = {b->n[0][k], b->n[1][k], l->dem->dim == 3 ? b->n[2][k] : 0.0}, v[3] = {0};
    stiffness stiff;
    for (int c = 0; c < l->dem->dim; c++)
      v[c] = b->velocity[c][k];
    stiffness_of(visit->model, b->radius[k], b->mass[k], b->overlap[k], cdem_norm3(v), &stiff);
    add(&l->rows[i], &stiff, 1.0, b->arm[0][k], b->radius[k], l->factor, n);
    l->touched[i] = 1.0;
  }
}

/* A wall near a grain that touches none; a grain all alone. */
static void add_what_may_come(const limits *l) {
  const cdem_dem_store *s = l->dem->store;
  const cdem_dem_core *core = s->core;
  const int32_t *wall_row = s->walls != NULL ? cdem_walls_rows(s) : NULL;
  for (int32_t i = 0; i < s->grains; i++) {
    const cdem_contact_model *model;
    double r = cdem_place(s, i)[3], m = cdem_motion(s, i)[6], speed = cdem_norm3(cdem_motion(s, i));
    const int32_t *models = core->model_of + (int64_t)s->material[i] * s->options.materials;
    stiffness k;
    if (wall_row != NULL && wall_row[i + 1] > wall_row[i] && l->touched[i] == 0.0)
      for (int w = 0; w < s->options.walls; w++) {
        model = &core->model[models[s->options.wall[w].material]];
        stiffness_of(model, r, m, 0.0, speed, &k);
        add_fresh(&l->rows[i], &k, 1.0, l->factor);
      }
    if (l->rows[i].contacts > 0 || l->rows[i].spring.fresh > 0.0)
      continue;
    model = &core->model[models[s->material[i]]];
    stiffness_of(model, 0.5 * r, 0.5 * m, 0.0, 2.0 * speed, &k);
    add_fresh(&l->rows[i], &k, 2.0, l->factor);
  }
}

/* Bound of the largest eigenvalue of a symmetric, positive matrix. */
static double norm(int dim, const double m[6]) {
  if (dim == 2) {
    double half = 0.5 * (m[0] - m[1]);
    return 0.5 * (m[0] + m[1]) + sqrt(half * half + m[3] * m[3]);
  }
  double a = fabs(m[0]) + fabs(m[3]) + fabs(m[5]), b = fabs(m[1]) + fabs(m[3]) + fabs(m[4]);
  double c = fabs(m[2]) + fabs(m[4]) + fabs(m[5]);
  double frobenius = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2] +
                          2.0 * (m[3] * m[3] + m[4] * m[4] + m[5] * m[5]));
  return fmin(fmax(a, fmax(b, c)), frobenius);
}

/* Bound of a grain's block against m and I; with what may come, as one more contact. */
static double block_bound(int dim, const block *g, double m, double inertia, bool fresh) {
  double spin = dim == 2 ? g->r[2] : norm(3, g->r);
  double a = norm(dim, g->t) / m, b = spin / inertia;
  double c2 = cdem_dot3(g->c, g->c) / (m * inertia), half = 0.5 * (a - b);
  double bound = fmin(g->sum / m, 0.5 * (a + b) + sqrt(half * half + c2));
  return fresh ? bound + g->fresh / m : bound;
}

static void limits_release(limits *l) {
  free(l->rows);
  free(l->touched);
}

/* A node of the membrane: along n only. */
static void add_node(void *context, int32_t grain, double spring, double dashpot,
                     const double n[3]) {
  const limits *l = context;
  const stiffness k = {.kn = spring, .dash = {dashpot, 0.0}};
  double radius = cdem_place(l->dem->store, grain)[3];
  add(&l->rows[grain], &k, 2.0, radius, radius, l->factor, n);
}

/* The rows of all grains. Released by the caller, after a failure too. */
static cdem_status gather(const cdem_dem *dem, bool fresh, limits *l, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  *l = (limits){.dem = dem, .factor = 1.0 / cdem_inertia_factor(dem->dim)};
  CDEM_NEW(l->rows, s->grains, fault);
  CDEM_NEW(l->touched, s->grains, fault);
  add_pairs(l);
  add_bonds(l);
  if (s->walls != NULL)
    cdem_dem_visit_all(dem, add_touch, l);
  if (s->core->confine != NULL)
    cdem_confine_visit(dem, add_node, l);
  if (fresh)
    add_what_may_come(l);
  return CDEM_OK;
}

cdem_status cdem_dem_stiffness(const cdem_dem *dem, double *resists, double *turning,
                               cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  limits l;
  cdem_status status = gather(dem, true, &l, fault);
  for (int32_t i = 0; status == CDEM_OK && i < s->grains; i++) {
    const block *g = &l.rows[i].spring;
    double r = cdem_place(s, i)[3];
    /* Candidates that may come: one on each side. */
    resists[s->id[i]] = norm(dem->dim, g->t) + 2.0 * g->fresh;
    if (turning != NULL)
      turning[s->id[i]] = (dem->dim == 2 ? g->r[2] : norm(3, g->r)) + 2.0 * g->fresh * r * r;
  }
  limits_release(&l);
  return status;
}

enum { CDEM_LIMIT_MEMBRANE = -2 }; /* in place of a grain */

static cdem_status find(const cdem_dem *dem, bool fresh, double *limit, int32_t *grain,
                        int32_t *contacts, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  limits l;
  *limit = INFINITY;
  *grain = -1;
  cdem_status status = gather(dem, fresh, &l, fault);
  if (status != CDEM_OK) {
    limits_release(&l);
    return status;
  }
  for (int32_t i = 0; i < s->grains; i++) {
    const row *g = &l.rows[i];
    double m = cdem_motion(s, i)[6], r = cdem_place(s, i)[3];
    double inertia = cdem_inertia_factor(dem->dim) * m * (r * r);
    double bound = block_bound(dem->dim, &g->spring, m, inertia, fresh);
    double dash = block_bound(dem->dim, &g->dash, m, inertia, fresh);
    if (s->kind[i] == CDEM_GRAIN_DRIVEN)
      continue;
    double step = bound > 0.0 ? 4.0 / (dash + sqrt(dash * dash + 4.0 * bound)) : INFINITY;
    /* by id where two are equal: the answer must not know the order */
    if (step < *limit || (step == *limit && *grain >= 0 && s->id[i] < *grain)) {
      *limit = step;
      *grain = s->id[i];
      *contacts = g->contacts;
    }
  }
  limits_release(&l);
  double membrane = s->core->confine != NULL ? cdem_confine_limit(dem) : INFINITY;
  if (membrane < *limit) {
    *limit = membrane;
    *grain = CDEM_LIMIT_MEMBRANE;
  }
  return CDEM_OK;
}

static double joints(const cdem_dem_core *core) {
  double sum = (double)core->held;
  for (int32_t c = 0; c < core->chunks; c++)
    sum += core->part[c].touches;
  return sum;
}

/* Of all contacts as if they stood in every direction: sum of kn L^2/(dim^2 V). Dashpots answer a
 * rate along one axis with less than sum of c L^2/(dim V) times it, within the step: a servo that
 * took less than this over K for its time would throw the cell to and fro. */
void cdem_dem_bulk(cdem_dem *dem) {
  const cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  core->bulk = core->response = core->viscosity = 0.0;
  if (s->pair_image == NULL)
    return;
  core->joints = joints(core);
  double mass = 0.0, longest = 0.0, dash = 0.0;
  double volume = cdem_cell_volume(s->dim, &s->cell) * (s->dim == 2 ? core->thickness : 1.0);
  double sum = 0.0;
  for (int64_t p = 0; p < s->pairs; p++) {
    int32_t i = core->pair_owner[p], j = s->pair_other[p];
    const double *x = cdem_place(s, i), *y = cdem_place(s, j);
    double ma = cdem_motion(s, i)[6], mb = cdem_motion(s, j)[6], both = x[3] + y[3];
    if (s->pair_touch[p] != 1)
      continue;
    stiffness k;
    at_overlap(&core->model[core->model_of[s->material[i] * s->options.materials + s->material[j]]],
               x[3] * y[3] / both, ma * mb / (ma + mb), 1e-3 * both, &k);
    sum += k.kn * both * both;
    dash += fmax(k.dash[0], k.dash[1]) * both * both;
  }
  for (int64_t b = 0; b < core->bonds; b++)
    if (core->bond[b].holds)
      sum += s->options.bond_law[core->bond[b].law].normal_stiffness *
             (core->bond[b].rest * core->bond[b].rest);
  if (!(volume > 0.0 && sum > 0.0))
    return;
  for (int32_t i = 0; i < s->grains; i++)
    mass += cdem_motion(s, i)[6];
  for (int c = 0; c < s->dim; c++)
    longest = fmax(longest, s->cell.h[c] * s->cell.h[c] + s->cell.h[3 + c] * s->cell.h[3 + c] +
                                s->cell.h[6 + c] * s->cell.h[6 + c]);
  core->bulk = sum / (s->dim * s->dim * volume);
  core->viscosity = dash / (s->dim * volume);
  core->response =
      fmax(0.5 * sqrt(longest * (mass / volume) / core->bulk), core->viscosity / core->bulk);
}

/* A list can last from a loose packing to a dense one: a servo that still took it for loose would
 * throw the cell to and fro at its largest rate. The gain leaves room for a factor of two. A
 * packing that is too loose still is pressed in any case. */
void cdem_dem_bulk_if_stale(cdem_dem *dem) {
  const cdem_dem_core *core = dem->store->core;
  double now = joints(core);
  if (cdem_cell_is_sought(&dem->store->cell, dem->time, core->stress) &&
      (now > 2.0 * core->joints || 2.0 * now < core->joints))
    cdem_dem_bulk(dem);
}

static void name_limiter(int32_t grain, int32_t contacts, char limiter[64]) {
  if (limiter == NULL)
    return;
  limiter[0] = 0;
  if (grain == CDEM_LIMIT_MEMBRANE)
    snprintf(limiter, 64, "the nodes of the membrane");
  else if (grain >= 0)
    snprintf(limiter, 64, "grain %d with %d contact%s", grain, contacts, contacts == 1 ? "" : "s");
}

cdem_status cdem_dem_limit(const cdem_dem *dem, double *limit, char limiter[64],
                           cdem_fault *fault) {
  int32_t grain, contacts = 0;
  CDEM_TRY(find(dem, true, limit, &grain, &contacts, fault));
  name_limiter(grain, contacts, limiter);
  return CDEM_OK;
}

static cdem_status refuse(double step, double limit, const char *limiter, cdem_fault *fault) {
  return cdem_fail(fault, CDEM_INPUT,
                   "the time step %.4g s is unstable: the limit is %.4g s, from %s; take a shorter "
                   "one, or leave it out",
                   step, limit, limiter);
}

cdem_status cdem_dem_first_step(cdem_dem *dem, cdem_fault *fault) {
  const cdem_dem_options *o = &dem->store->options;
  char limiter[64];
  double limit;
  CDEM_TRY(cdem_dem_limit(dem, &limit, limiter, fault));
  if (o->step > limit)
    return refuse(o->step, limit, limiter, fault);
  CDEM_REQUIRE(o->step > 0.0 || isfinite(limit), fault, CDEM_INPUT,
               "nothing limits the time step: give one");
  dem->step = o->step > 0.0 ? o->step : o->safety * limit;
  return CDEM_OK;
}

void cdem_dem_keep_seen(cdem_dem *dem) {
  cdem_dem_core *core = dem->store->core;
  if (!core->seen_holds)
    memcpy(core->seen, dem->store->motion, (size_t)dem->grains * 8 * sizeof *core->seen);
  core->seen_holds = true;
}

/* v_n = v_- + dt/2 a_n stays what it is. */
void cdem_dem_change_step(cdem_dem *dem, double step) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  cdem_dem_energies before, after;
  double booked[CDEM_DEM_SUMS], now_booked[CDEM_DEM_SUMS];
  if (s->options.energies) {
    cdem_dem_energies_now(dem, &before);
    cdem_dem_book_now(dem, booked);
  }
  double old = dem->step;
  cdem_dem_keep_seen(dem);
  for (int32_t i = 0; i < s->grains; i++) {
    double now[6];
    dem->step = old;
    cdem_grain_velocity_now(dem, i, now);
    dem->step = step;
    cdem_grain_set_before(dem, i, now);
  }
  if (core->confine != NULL)
    cdem_confine_change_step(dem, old, step);
  dem->step = step;
  cdem_dem_set_time(dem, dem->time);
  if (!s->options.energies)
    return;
  /* works: what is done stays done; half steps are of another length */
  cdem_dem_book_now(dem, now_booked);
  for (int k = 0; k < CDEM_DEM_SUMS; k++)
    if (k != CDEM_DEM_TRANSLATION && k != CDEM_DEM_ROTATION)
      core->base[k] += now_booked[k] - booked[k];
  cdem_dem_energies_now(dem, &after);
  core->initial += after.error - before.error; /* the leapfrog's measure of the kinetic energy */
}

cdem_status cdem_dem_set_step(cdem_dem *dem, double step, cdem_fault *fault) {
  char limiter[64];
  double limit;
  CDEM_TRY(cdem_dem_limit(dem, &limit, limiter, fault));
  CDEM_REQUIRE(step > 0.0 && isfinite(step), fault, CDEM_INPUT,
               "the time step is %g s; it is positive", step);
  if (step > limit)
    return refuse(step, limit, limiter, fault);
  dem->store->core->automatic = false;
  cdem_dem_change_step(dem, step);
  return CDEM_OK;
}

cdem_status cdem_dem_relook(cdem_dem *dem, cdem_fault *fault) {
  const cdem_dem_options *o = &dem->store->options;
  cdem_dem_core *core = dem->store->core;
  double limit;
  char limiter[64];
  int32_t grain, contacts = 0;
  core->wanted = 0.0;
  CDEM_TRY(find(dem, core->automatic, &limit, &grain, &contacts, fault));
  if (!core->automatic) {
    name_limiter(grain, contacts, limiter);
    CDEM_REQUIRE(
        dem->step <= limit, fault, CDEM_NUMERIC,
        "the time step %.4g s has become unstable at t = %.6g s: the limit is %.4g s, from %s",
        dem->step, dem->time, limit, limiter);
    return CDEM_OK;
  }
  double wanted = o->safety * limit;
  if (isfinite(wanted) && (dem->step > fmin(1.1 * wanted, limit) || dem->step * 1.5 < wanted))
    core->wanted = wanted;
  return CDEM_OK;
}
