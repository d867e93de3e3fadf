/* Motion of grains: velocities of half steps, places, and what the book wants to know of it.
 *
 * With mass damping c taken at t_n, v_n = (v_- + v_+)/2 (Li & Wan 2010, eqs 25-30 in half steps):
 *     (1 + c dt/2) v_+ = (1 - c dt/2) v_- + dt (F + F_local)/m
 * Local damping F_local = -alpha |F| sign(v_n), component by component; where it would turn v_n
 * around it stops it: it never adds energy. */
#include "dem/solver_store.h"

#include <math.h>

CDEM_ALWAYS_INLINE void gather(const cdem_move_kernel *kernel, int32_t i, double force[8]) {
  const cdem_dem_core *core = kernel->core;
  for (int64_t r = core->far_start[i]; r < core->far_start[i + 1]; r++) {
    double *far = core->far + 8 * r;
    *(cdem_vec8 *)force += *(cdem_vec8 *)far;
    *(cdem_vec8 *)far = (cdem_vec8){0};
  }
}

CDEM_MULTIVERSION void cdem_grains_gather(const cdem_move_kernel *kernel, int32_t from,
                                          int32_t to) {
  for (int32_t i = from; i < to; i++)
    gather(kernel, i, cdem_force(kernel->store, i));
}

CDEM_MULTIVERSION void cdem_grains_move(const cdem_move_kernel *kernel, int32_t from, int32_t to,
                                        cdem_dem_part *part) {
  cdem_dem_store *s = kernel->store;
  const double dt = kernel->step, half = 0.5 * s->options.mass_damping * dt;
  const double keep = (1.0 - half) / (1.0 + half), kick = dt / (1.0 + half);
  const double *g = s->options.gravity;
  const cdem_vec8 weight = {g[0], g[1], g[2], 0.0, 0.0, 0.0, 0.0, 0.0};
  const cdem_vec8 keeps = {keep, keep, keep, keep, keep, keep, 1.0, 1.0};
  double most = part->moved2;
  int32_t bad = -1;
  for (int32_t i = from; i < to; i++) {
    double *f = cdem_force(s, i), *m = cdem_motion(s, i), *x = cdem_place(s, i);
    double *u = kernel->core->since + 8 * (int64_t)i;
    const double im = f[6], ii = f[7], r = x[3];
    gather(kernel, i, f);
    const cdem_vec8 inverse = {im, im, im, ii, ii, ii, 0.0, 0.0};
    cdem_vec8 v = *(cdem_vec8 *)m;
    cdem_vec8 force = *(cdem_vec8 *)f;
    v = v * keeps + kick * (force * inverse + weight);
    *(cdem_vec8 *)m = v;
    *(cdem_vec8 *)f = (cdem_vec8){0.0, 0.0, 0.0, 0.0, 0.0, 0.0, im, ii};
    const cdem_vec8 way = dt * v, to_date = *(cdem_vec8 *)u + way;
    *(cdem_vec8 *)u = to_date;
    x[0] += way[0];
    x[1] += way[1];
    x[2] += way[2];
    double step2 = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
    double way2 = to_date[0] * to_date[0] + to_date[1] * to_date[1] + to_date[2] * to_date[2];
    most = way2 > most ? way2 : most;
    if (!(step2 <= r * r))
      bad = bad < 0 ? i : bad;
  }
  part->moved2 = most;
  if (bad >= 0 && part->bad < 0)
    part->bad = bad;
}

/* ---- one grain with everything ---- */

typedef struct {
  double inverse[6], force[6]; /* 1/m, 1/I; all forces and gravity */
  double after[6], local[6];   /* velocity after the kick, local damping */
} kick;

/* Force on a grain, gravity and what is applied included; then the kick. */
static void kick_of(const cdem_move_kernel *kernel, int32_t i, kick *k) {
  const cdem_dem_store *s = kernel->store;
  const double *f = cdem_force(s, i), *v = cdem_motion(s, i);
  const double dt = kernel->step, half = 0.5 * s->options.mass_damping * dt;
  const double alpha = s->options.local_damping;
  const double *applied = kernel->applied != NULL ? kernel->applied + 6 * (int64_t)s->id[i] : NULL;
  for (int c = 0; c < 6; c++) {
    k->inverse[c] = c < 3 ? f[6] : f[7];
    k->force[c] = f[c] + (applied != NULL ? applied[c] : 0.0);
    if (c < 3)
      k->force[c] += v[6] * s->options.gravity[c];
    double free = v[c] + 0.5 * dt * k->inverse[c] * k->force[c]; /* (1 + half) v_n without local */
    double most = alpha * fabs(k->force[c]);
    double stop = 0.5 * dt * k->inverse[c] * most;
    k->local[c] =
        fabs(free) > stop ? -copysign(most, free) : (stop > 0.0 ? -most * (free / stop) : 0.0);
    k->after[c] =
        ((1.0 - half) * v[c] + dt * k->inverse[c] * (k->force[c] + k->local[c])) / (1.0 + half);
  }
}

/* Work over the two half steps around t_n: of whole ones when the grain moves on, of the first one
 * at a report. */
static void book(const cdem_move_kernel *kernel, int32_t i, const kick *k, unsigned held,
                 double *sum) {
  const cdem_dem_store *s = kernel->store;
  const double *v = cdem_motion(s, i);
  const double dt = kernel->step;
  const double *applied = kernel->applied != NULL ? kernel->applied + 6 * (int64_t)s->id[i] : NULL;
  for (int c = 0; c < 6; c++) {
    double way = 0.5 * dt * (kernel->commit ? v[c] + k->after[c] : v[c]);
    if (s->kind[i] == CDEM_GRAIN_DRIVEN) { /* its own mass is not ours to move */
      sum[CDEM_DEM_DRIVEN] -= cdem_force(s, i)[c] * way;
      continue;
    }
    double mass = k->inverse[c] > 0.0 ? 1.0 / k->inverse[c] : 0.0;
    double now = 0.5 * (v[c] + k->after[c]);
    if (held >> c & 1u) { /* what guides it, the change of its kinetic energy included */
      double guide = mass * (k->after[c] - v[c]) / dt - k->force[c];
      sum[CDEM_DEM_GUIDED] += guide * way;
      if (applied != NULL)
        sum[CDEM_DEM_APPLIED] += applied[c] * way;
      sum[c < 3 ? CDEM_DEM_TRANSLATION : CDEM_DEM_ROTATION] += 0.5 * mass * v[c] * k->after[c];
      continue;
    }
    sum[CDEM_DEM_MASS] += s->options.mass_damping * mass * now * way;
    sum[CDEM_DEM_LOCAL] -= k->local[c] * way;
    if (applied != NULL)
      sum[CDEM_DEM_APPLIED] += applied[c] * way;
    sum[c < 3 ? CDEM_DEM_TRANSLATION : CDEM_DEM_ROTATION] += 0.5 * mass * v[c] * k->after[c];
  }
}

/* Components that are given take what cdem_dem_drive has set for the step to come. */
static void guide(const cdem_dem_core *core, int32_t id, unsigned held, double after[6]) {
  for (int c = 0; held != 0 && c < 6; c++)
    if (held >> c & 1u)
      after[c] = core->drive[6 * (int64_t)id + c];
}

void cdem_grains_move_all(const cdem_move_kernel *kernel, int32_t from, int32_t to,
                          cdem_dem_part *part) {
  cdem_dem_store *s = kernel->store;
  cdem_dem_core *core = kernel->core;
  const double dt = kernel->step;
  for (int32_t i = from; i < to; i++) {
    double *f = cdem_force(s, i), *m = cdem_motion(s, i), *x = cdem_place(s, i);
    double *u = core->since + 8 * (int64_t)i;
    unsigned held = cdem_grain_held(s->kind[i]);
    kick k;
    gather(kernel, i, f);
    kick_of(kernel, i, &k);
    guide(core, s->id[i], held, k.after);
    if (core->gain != NULL)
      book(kernel, i, &k, held, part->sum);
    if (!kernel->commit)
      continue;
    if (held != 0)
      for (int64_t d = 6 * (int64_t)s->id[i], end = d + 6; d < end; d++)
        core->drive[d] += dt * core->drive_rate[d];
    double step2 = 0.0, way2 = 0.0;
    for (int c = 0; c < 6; c++) {
      if (core->gain != NULL)
        core->gain[8 * (int64_t)i + c] = k.after[c] - m[c];
      m[c] = k.after[c];
      f[c] = 0.0;
      u[c] += dt * m[c];
      if (c < 3) {
        x[c] += dt * m[c];
        step2 += dt * m[c] * (dt * m[c]);
        way2 += u[c] * u[c];
      }
    }
    part->moved2 = way2 > part->moved2 ? way2 : part->moved2;
    if (!(step2 <= x[3] * x[3]) && part->bad < 0)
      part->bad = i;
  }
}

static cdem_move_kernel kernel_now(const cdem_dem *dem) {
  return (cdem_move_kernel){dem->store, dem->store->core, dem->step, dem->applied, false};
}

void cdem_grain_velocity_now(const cdem_dem *dem, int32_t i, double now[6]) {
  const cdem_dem_store *s = dem->store;
  cdem_move_kernel kernel = kernel_now(dem);
  const double *v = cdem_motion(s, i);
  kick k;
  kick_of(&kernel, i, &k);
  guide(s->core, s->id[i], cdem_grain_held(s->kind[i]), k.after);
  for (int c = 0; c < 6; c++)
    now[c] = 0.5 * (v[c] + k.after[c]);
}

/* v_n = (v_- + dt/2 (F + F_local)/m)/(1 + c dt/2), solved for v_-. */
void cdem_grain_set_before(const cdem_dem *dem, int32_t i, const double now[6]) {
  cdem_dem_store *s = dem->store;
  cdem_move_kernel kernel = kernel_now(dem);
  double *v = cdem_motion(s, i), half = 0.5 * s->options.mass_damping * dem->step;
  unsigned held = cdem_grain_held(s->kind[i]);
  kick k;
  if (s->kind[i] == CDEM_GRAIN_DRIVEN)
    return;
  kick_of(&kernel, i, &k);
  for (int c = 0; c < 6; c++) {
    if (held >> c & 1u)
      continue;
    double most = s->options.local_damping * fabs(k.force[c]);
    double local = now[c] == 0.0 ? 0.0 : -copysign(most, now[c]);
    v[c] = (1.0 + half) * now[c] - 0.5 * dem->step * k.inverse[c] * (k.force[c] + local);
    if (s->core->gain != NULL)
      s->core->gain[8 * (int64_t)i + c] = 2.0 * (now[c] - v[c]);
  }
}
