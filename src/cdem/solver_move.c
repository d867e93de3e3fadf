#include "cdem/solver_store.h"

#include <math.h>
#include <string.h>

/* Local damping -alpha |F| sign(v), v the velocity at t_n itself: implicit, so that it never adds
 * energy. Where it would turn v around it stops it. `diagonal`: mass (with mass damping) that h =
 * kick/2 works against, `mean` the velocity at t_n without it. */
static inline double local_force(double alpha, double force, double diagonal, double h,
                                 double mean) {
  return -copysign(fmin(alpha * fabs(force), diagonal * fabs(mean) / h), mean);
}

/* Kinetic energy of a component at t_n as the works of a step dt of trapezoids want it, m v^2/2 -+
 * dt/2 v F with the whole force F = m (after - before)/kick: from the step before and, less that,
 * from the step after. Both are m before after/2 while the step is the same. */
static inline void kinetic(const cdem_motion *w, double mass, double before, double after,
                           double *sums) {
  if (w->old_half == w->new_half) {
    sums[CDEM_SUM_KINETIC] += 0.5 * mass * before * after;
    return;
  }
  double force = mass * (after - before) / w->kick;
  double from_before = 0.5 * mass * before * before + w->old_half * before * force;
  double from_after = 0.5 * mass * after * after - w->new_half * after * force;
  sums[CDEM_SUM_KINETIC] += from_before;
  sums[CDEM_SUM_CHANGE] += from_after - from_before;
}

/* Solves the rows of the free components of A x = b, x given where fixed. No pivots are needed: A
 * is positive definite. */
static void solve3(int dofs, unsigned fixed, const double a[9], const double b[3], double x[3]) {
  double m[9], r[3];
  memcpy(m, a, sizeof m);
  for (int i = 0; i < dofs; i++) {
    r[i] = b[i];
    for (int j = 0; j < dofs; j++)
      if (fixed >> j & 1U)
        r[i] -= m[3 * i + j] * x[j];
  }
  for (int i = 0; i < dofs; i++)
    for (int k = i + 1; k < dofs && !(fixed >> i & 1U); k++) {
      if (fixed >> k & 1U)
        continue;
      double part = m[3 * k + i] / m[4 * i];
      for (int j = i; j < dofs; j++)
        m[3 * k + j] -= part * m[3 * i + j];
      r[k] -= part * r[i];
    }
  for (int i = dofs - 1; i >= 0; i--) {
    if (fixed >> i & 1U)
      continue;
    for (int j = i + 1; j < dofs; j++)
      if (!(fixed >> j & 1U))
        r[i] -= m[3 * i + j] * x[j];
    x[i] = r[i] / m[4 * i];
  }
}

/* Velocities at t_n, (v_{n-1/2} + v_{n+1/2})/2: (m (1 + h a) + h C) mean = m v_{n-1/2} + h (F +
 * F_local), h = kick/2, which is (1) of solver.h. */
static void mean_velocity(const cdem_motion *w, int dofs, const cdem_point *p, double mean[3],
                          double local[3]) {
  double h = w->kick / 2.0, a[9] = {0}, b[3] = {0};
  for (int i = 0; i < dofs; i++) {
    a[4 * i] = p->mass[i] * (1.0 + h * w->mass_damping);
    b[i] = p->mass[i] * p->before[i] + h * p->force[i];
    local[i] = 0.0;
    mean[i] = (p->before[i] + p->target[i]) / 2.0;
    for (int j = 0; j < dofs && p->quiet; j++)
      a[3 * i + j] += h * p->dashpot[3 * i + j];
  }
  solve3(dofs, p->fixed, a, b, mean);
  if (w->local_damping == 0.0)
    return;
  for (int i = 0; i < dofs; i++)
    if (!(p->fixed >> i & 1U)) {
      local[i] = local_force(w->local_damping, p->force[i], a[4 * i], h, mean[i]);
      b[i] += h * local[i];
    }
  solve3(dofs, p->fixed, a, b, mean);
}

void cdem_point_move(const cdem_motion *w, int dofs, const cdem_point *p, double after[3],
                     double reaction[3], double *sums) {
  double mean[3], local[3];
  mean_velocity(w, dofs, p, mean, local);
  for (int i = 0; i < dofs; i++) {
    bool fixed = p->fixed >> i & 1U;
    after[i] = fixed ? p->target[i] : 2.0 * mean[i] - p->before[i];
    double way = w->left * p->before[i] + w->right * after[i];
    double drag = w->mass_damping * p->mass[i] * mean[i], dash = 0.0;
    for (int j = 0; j < dofs && p->quiet; j++)
      dash += p->dashpot[3 * i + j] * mean[j];
    reaction[i] =
        fixed ? p->mass[i] * (after[i] - p->before[i]) / w->kick + drag + dash - p->force[i] : 0.0;
    sums[CDEM_SUM_SUPPORT] += reaction[i] * way;
    sums[CDEM_SUM_MASS] += drag * way;
    sums[CDEM_SUM_QUIET] += dash * way;
    sums[CDEM_SUM_LOCAL] -= local[i] * way;
    kinetic(w, p->mass[i], p->before[i], after[i], sums);
    sums[CDEM_SUM_SPEED] += fabs(after[i]);
  }
}

void cdem_solver_motion(const cdem_solver *solver, bool commit, cdem_motion *motion) {
  const cdem_solver_store *s = solver->store;
  double previous = s->previous;
  motion->kick = previous > 0.0 ? (previous + solver->step) / 2.0 : solver->step;
  motion->old_half = (previous > 0.0 ? previous : solver->step) / 2.0;
  motion->new_half = solver->step / 2.0;
  motion->left = previous / 2.0;
  motion->right = commit ? solver->step / 2.0 : 0.0;
  motion->mass_damping = s->options.mass_damping;
  motion->local_damping = s->options.local_damping;
}

/* ---- points ---- */

static void point_add(const cdem_solver *solver, int32_t node, cdem_point *p) {
  const cdem_solver_store *s = solver->store;
  int dofs = solver->dofs;
  size_t first = (size_t)node * (size_t)dofs;
  for (int i = 0; i < dofs; i++) {
    p->mass[i] += s->inertia[first + i];
    p->force[i] += solver->force[first + i] + solver->applied[first + i];
    p->before[i] = solver->v[first + i];
    if ((s->flag[node] >> i & 1U) && !(p->fixed >> i & 1U)) {
      p->fixed |= 1U << i;
      p->target[i] = (s->path[s->support_of[first + i]] - solver->u[first + i]) / solver->step;
    }
  }
  if (s->flag[node] & CDEM_NODE_QUIET) {
    const double *dashpot = s->dashpot + (size_t)9 * (size_t)s->dashpot_of[node];
    p->quiet = true;
    for (int k = 0; k < 9; k++)
      p->dashpot[k] += dashpot[k];
  }
}

void cdem_solver_cluster(const cdem_solver *solver, int32_t cluster, cdem_point *point) {
  const cdem_ties *ties = &solver->store->options.interfaces->ties;
  *point = (cdem_point){0};
  for (int32_t k = ties->start[cluster]; k < ties->start[cluster + 1]; k++)
    point_add(solver, ties->member[k], point);
}

void cdem_solver_point(const cdem_solver *solver, int32_t node, cdem_point *point) {
  if (solver->store->flag[node] & CDEM_NODE_TIED) {
    cdem_solver_cluster(solver, solver->store->cluster_of[node], point);
    return;
  }
  *point = (cdem_point){0};
  point_add(solver, node, point);
}

/* ---- one kick of everything ---- */

/* Work of loads and of the applied forces of a coupled solver; gravity has its potential. */
static double load_work(const cdem_solver *solver, const cdem_motion *w, int32_t node,
                        const double *after) {
  const cdem_solver_store *s = solver->store;
  int dofs = solver->dofs;
  size_t first = (size_t)node * (size_t)dofs;
  double work = 0.0;
  for (int i = 0; i < dofs; i++) {
    double weight =
        i < s->dimension ? s->options.body->mass[first + i] * s->options.gravity[i] : 0.0;
    double load = s->flag[node] & CDEM_NODE_LOADED ? solver->external[first + i] - weight : 0.0;
    work += (load + solver->applied[first + i]) *
            (w->left * solver->v[first + i] + w->right * after[i]);
  }
  return work;
}

typedef struct {
  const cdem_solver *solver;
  cdem_motion motion;
  bool commit;
  double *after;
} kick;

static void put(const kick *k, int32_t node, unsigned fixed, const double after[3]) {
  const cdem_solver *solver = k->solver;
  const cdem_solver_store *s = solver->store;
  int dofs = solver->dofs;
  size_t first = (size_t)node * (size_t)dofs;
  for (int i = 0; i < dofs; i++) {
    if (k->after != NULL)
      k->after[first + i] = after[i];
    if (!k->commit)
      continue;
    solver->u[first + i] += solver->step * after[i];
    if ((fixed >> i & 1U) && (s->flag[node] >> i & 1U))
      solver->u[first + i] = s->path[s->support_of[first + i]];
  }
}

static void move_node(const kick *k, int32_t node, double *sums) {
  cdem_point point = {0};
  double after[3], reaction[3];
  point_add(k->solver, node, &point);
  cdem_point_move(&k->motion, k->solver->dofs, &point, after, reaction, sums);
  sums[CDEM_SUM_LOAD] += load_work(k->solver, &k->motion, node, after);
  put(k, node, point.fixed, after);
}

static void move_cluster(const kick *k, int32_t cluster, double *sums) {
  const cdem_solver *solver = k->solver;
  const cdem_ties *ties = &solver->store->options.interfaces->ties;
  cdem_point point;
  double after[3], reaction[3];
  cdem_solver_cluster(solver, cluster, &point);
  cdem_point_move(&k->motion, solver->dofs, &point, after, reaction, sums);
  for (int32_t m = ties->start[cluster]; m < ties->start[cluster + 1]; m++) {
    sums[CDEM_SUM_LOAD] += load_work(solver, &k->motion, ties->member[m], after);
    put(k, ties->member[m], point.fixed, after);
  }
  if (!k->commit || point.fixed == 0)
    return;
  /* What holds one member holds all, to the bit. */
  for (int32_t m = ties->start[cluster]; m < ties->start[cluster + 1]; m++)
    for (int i = 0; i < solver->dofs; i++) {
      if (!(point.fixed >> i & 1U) || (solver->store->flag[ties->member[m]] >> i & 1U))
        continue;
      size_t at = (size_t)ties->member[m] * (size_t)solver->dofs + (size_t)i;
      for (int32_t l = ties->start[cluster]; l < ties->start[cluster + 1]; l++)
        if (solver->store->flag[ties->member[l]] >> i & 1U)
          solver->u[at] = solver->u[(size_t)ties->member[l] * (size_t)solver->dofs + (size_t)i];
    }
}

/* Nodes without anything special, which are nearly all: the loop that must be cheap. */
static inline void move_free(const kick *k, int32_t node, const int dofs, double *sums) {
  const cdem_solver *solver = k->solver;
  const cdem_motion *w = &k->motion;
  const double h = w->kick / 2.0, grow = 1.0 + h * w->mass_damping;
  const size_t first = (size_t)node * (size_t)dofs;
  for (int i = 0; i < dofs; i++) {
    double mass = solver->store->inertia[first + i], before = solver->v[first + i];
    double applied = solver->applied[first + i], force = solver->force[first + i] + applied;
    double diagonal = mass * grow, mean = (mass * before + h * force) / diagonal;
    double local = 0.0;
    if (w->local_damping != 0.0) {
      local = local_force(w->local_damping, force, diagonal, h, mean);
      mean += h * local / diagonal;
    }
    double after = 2.0 * mean - before, way = w->left * before + w->right * after;
    sums[CDEM_SUM_LOAD] += applied * way;
    sums[CDEM_SUM_MASS] += w->mass_damping * mass * mean * way;
    sums[CDEM_SUM_LOCAL] -= local * way;
    kinetic(w, mass, before, after, sums);
    sums[CDEM_SUM_SPEED] += fabs(after);
    if (k->after != NULL)
      k->after[first + i] = after;
    if (k->commit)
      solver->u[first + i] += solver->step * after;
  }
}

static void move_chunk(const kick *k, int64_t chunk, double *sums) {
  const cdem_solver *solver = k->solver;
  const uint8_t *flag = solver->store->flag;
  int32_t from = (int32_t)(chunk * CDEM_SOLVER_CHUNK);
  int64_t end = (chunk + 1) * CDEM_SOLVER_CHUNK;
  int32_t to = (int32_t)(end < solver->nodes ? end : solver->nodes);
  for (int32_t n = from; n < to; n++) {
    if (flag[n] & (CDEM_NODE_TIED | CDEM_NODE_EMPTY))
      continue;
    if (flag[n] != 0)
      move_node(k, n, sums);
    else if (solver->dofs == 3)
      move_free(k, n, 3, sums);
    else
      move_free(k, n, 2, sums);
  }
}

/* Sums the first `chunks` rows of the partial sums. */
static void gather_sums(const cdem_solver *solver, int64_t chunks, double *sums) {
  const double *partial = solver->store->partial;
  for (int64_t c = 0; c < chunks; c++)
    for (int k = 0; k < CDEM_SUMS; k++)
      sums[k] += partial[c * CDEM_SUMS + k];
}

void cdem_solver_pass(const cdem_solver *solver, bool commit, double *after, double *sums) {
  cdem_solver_store *s = solver->store;
  kick k = {.solver = solver, .commit = commit, .after = after};
  cdem_solver_motion(solver, commit, &k.motion);
  memset(sums, 0, CDEM_SUMS * sizeof *sums);
  int64_t chunks = (solver->nodes + CDEM_SOLVER_CHUNK - 1) / CDEM_SOLVER_CHUNK;
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int64_t c = 0; c < chunks; c++) {
    double own[CDEM_SUMS] = {0};
    move_chunk(&k, c, own);
    memcpy(s->partial + c * CDEM_SUMS, own, sizeof own);
  }
  gather_sums(solver, chunks, sums);
  int32_t clusters = s->options.interfaces != NULL ? s->options.interfaces->ties.clusters : 0;
  if (clusters == 0)
    return;
  chunks = (clusters + CDEM_SOLVER_CHUNK - 1) / CDEM_SOLVER_CHUNK;
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int64_t c = 0; c < chunks; c++) {
    double own[CDEM_SUMS] = {0};
    int64_t end = (c + 1) * CDEM_SOLVER_CHUNK < clusters ? (c + 1) * CDEM_SOLVER_CHUNK : clusters;
    for (int64_t cluster = c * CDEM_SOLVER_CHUNK; cluster < end; cluster++)
      move_cluster(&k, (int32_t)cluster, own);
    memcpy(s->partial + c * CDEM_SUMS, own, sizeof own);
  }
  gather_sums(solver, chunks, sums);
}

/* ---- the start ---- */

/* v_{-1/2} = v_0 - dt/2 a_0 with the acceleration at t = 0, so that the mean of the velocities
 * around t = 0 is v_0: second order. Prescribed components keep v_0: theirs before the start. */
static void start_point(const cdem_solver *solver, cdem_point *p) {
  const cdem_solver_store *s = solver->store;
  double h = solver->step / 2.0, v0[3];
  memcpy(v0, p->before, sizeof v0);
  for (int i = 0; i < solver->dofs; i++) {
    if (p->fixed >> i & 1U)
      continue;
    double force = p->force[i] - s->options.mass_damping * p->mass[i] * v0[i];
    if (v0[i] != 0.0)
      force -= copysign(s->options.local_damping * fabs(p->force[i]), v0[i]);
    for (int j = 0; j < solver->dofs && p->quiet; j++)
      force -= p->dashpot[3 * i + j] * v0[j];
    p->before[i] = v0[i] - h * force / p->mass[i];
  }
}

void cdem_solver_start(cdem_solver *solver) {
  const cdem_solver_store *s = solver->store;
  int dofs = solver->dofs;
  for (int32_t n = 0; n < solver->nodes; n++) {
    cdem_point point;
    if (s->flag[n] & (CDEM_NODE_TIED | CDEM_NODE_EMPTY))
      continue;
    cdem_solver_point(solver, n, &point);
    start_point(solver, &point);
    memcpy(solver->v + (size_t)n * (size_t)dofs, point.before, (size_t)dofs * sizeof(double));
  }
  if (s->options.interfaces == NULL)
    return;
  const cdem_ties *ties = &s->options.interfaces->ties;
  for (int32_t c = 0; c < ties->clusters; c++) {
    cdem_point point;
    double momentum[3] = {0};
    cdem_solver_cluster(solver, c, &point);
    for (int32_t k = ties->start[c]; k < ties->start[c + 1]; k++)
      for (int i = 0; i < dofs; i++) {
        size_t at = (size_t)ties->member[k] * (size_t)dofs + (size_t)i;
        momentum[i] += s->inertia[at] * solver->v[at];
      }
    for (int i = 0; i < dofs; i++)
      point.before[i] = momentum[i] / point.mass[i];
    start_point(solver, &point);
    for (int32_t k = ties->start[c]; k < ties->start[c + 1]; k++)
      memcpy(solver->v + (size_t)ties->member[k] * (size_t)dofs, point.before,
             (size_t)dofs * sizeof(double));
  }
}
