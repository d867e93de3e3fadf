/* The static solution: K u = f on the linear network, by Cholesky.
 *
 * Unknowns are the free components of nodes, one for all members of a tied cluster. K is that of
 * the network plus the springs of intact interfaces; the factor is that of its symmetric part,
 * scaled by its diagonal. Refinement takes the residual of K itself, so that the solution satisfies
 * the equations to rounding.
 */
#include "cdem/solver_store.h"

#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REFINEMENTS = 3 };

typedef struct {
  int32_t node[2];
  double block[9]; /* [dim][dim] */
} joint;

typedef struct {
  cdem_solver *solver;
  cdem_sparse matrix;
  int64_t joints, joint_capacity;
  joint *joint;
  int64_t joins, join_capacity;
  int32_t (*join)[2];
  int64_t unknowns;
  int64_t *unknown;                    /* [nodes][dofs] -1: prescribed or of no cell */
  double *residual, *product, *packed; /* [nodes][dofs], [matrix nodes][dofs] twice */
  double *reduced, *scale;             /* [unknowns] */
  double unit;                         /* of the matrix, see unit_of */
  cholmod_common common;
  bool started;
  cholmod_sparse *reduced_matrix;
  cholmod_factor *factor;
  cdem_status status; /* of the interfaces' callback */
  cdem_fault *fault;
} statics;

static void statics_release(statics *t) {
  if (t->started) {
    cholmod_l_free_sparse(&t->reduced_matrix, &t->common);
    cholmod_l_free_factor(&t->factor, &t->common);
    cholmod_l_finish(&t->common);
  }
  cdem_sparse_release(&t->matrix);
  free(t->joint);
  free(t->join);
  free(t->unknown);
  free(t->residual);
  free(t->product);
  free(t->packed);
  free(t->reduced);
  free(t->scale);
}

/* ---- what holds together ---- */

static void take_joint(void *context, int32_t node_a, int32_t node_b, const double *block) {
  statics *t = context;
  size_t dim = (size_t)t->solver->store->dimension;
  if (t->status == CDEM_OK)
    t->status = cdem_grow(&t->joint, &t->joint_capacity, t->joints + 1, sizeof *t->joint, t->fault);
  if (t->status != CDEM_OK)
    return;
  joint *j = &t->joint[t->joints++];
  j->node[0] = node_a;
  j->node[1] = node_b;
  memcpy(j->block, block, dim * dim * sizeof *block);
}

static cdem_status add_join(statics *t, int32_t a, int32_t b) {
  CDEM_TRY(cdem_grow(&t->join, &t->join_capacity, t->joins + 1, sizeof *t->join, t->fault));
  t->join[t->joins][0] = a;
  t->join[t->joins++][1] = b;
  return CDEM_OK;
}

static cdem_status gather_joints(statics *t) {
  const cdem_interfaces *interfaces = t->solver->store->options.interfaces;
  if (interfaces == NULL)
    return CDEM_OK;
  cdem_interfaces_stiffness(interfaces, take_joint, t);
  CDEM_TRY(t->status);
  for (int64_t k = 0; k < t->joints; k++)
    if (t->joint[k].node[0] != t->joint[k].node[1])
      CDEM_TRY(add_join(t, t->joint[k].node[0], t->joint[k].node[1]));
  for (int32_t c = 0; c < interfaces->ties.clusters; c++)
    for (int32_t k = interfaces->ties.start[c] + 1; k < interfaces->ties.start[c + 1]; k++)
      CDEM_TRY(add_join(t, interfaces->ties.member[k - 1], interfaces->ties.member[k]));
  return CDEM_OK;
}

/* ---- unknowns ---- */

/* Which components of the point are prescribed, and by which support. */
static int16_t owner_of(const cdem_solver *solver, int32_t node, int component) {
  const cdem_solver_store *s = solver->store;
  size_t dofs = (size_t)solver->dofs, i = (size_t)component;
  if (!(s->flag[node] & CDEM_NODE_TIED))
    return s->support_of[(size_t)node * dofs + i];
  const cdem_ties *ties = &s->options.interfaces->ties;
  int32_t c = s->cluster_of[node];
  for (int32_t k = ties->start[c]; k < ties->start[c + 1]; k++)
    if (s->support_of[(size_t)ties->member[k] * dofs + i] >= 0)
      return s->support_of[(size_t)ties->member[k] * dofs + i];
  return -1;
}

static cdem_status number_unknowns(statics *t, double time) {
  cdem_solver *solver = t->solver;
  const cdem_solver_store *s = solver->store;
  size_t dofs = (size_t)solver->dofs;
  CDEM_NEW(t->unknown, (int64_t)solver->nodes * solver->dofs, t->fault);
  memset(solver->u, 0, (size_t)solver->nodes * dofs * sizeof *solver->u);
  memset(solver->v, 0, (size_t)solver->nodes * dofs * sizeof *solver->v);
  for (int32_t n = 0; n < solver->nodes; n++)
    for (int i = 0; i < solver->dofs; i++) {
      int64_t *own = &t->unknown[(size_t)n * dofs + (size_t)i];
      int16_t owner = owner_of(solver, n, i);
      int32_t first = n;
      if (s->flag[n] & CDEM_NODE_TIED)
        first =
            s->options.interfaces->ties.member[s->options.interfaces->ties.start[s->cluster_of[n]]];
      *own = -1;
      if (owner >= 0)
        solver->u[(size_t)n * dofs + (size_t)i] =
            cdem_support_path(&s->options.support[owner], time);
      else if (!(s->flag[n] & CDEM_NODE_EMPTY))
        *own = first == n ? t->unknowns++ : t->unknown[(size_t)first * dofs + (size_t)i];
    }
  return CDEM_OK;
}

/* ---- the matrix ---- */

typedef struct {
  cholmod_triplet *triplet;
  const statics *t;
} filler;

/* Adds K_ij to the lower triangle of the symmetric part. */
static void fill(filler *f, int32_t node_i, int i, int32_t node_j, int j, double value) {
  size_t dofs = (size_t)f->t->solver->dofs;
  int64_t row = f->t->unknown[(size_t)node_i * dofs + (size_t)i];
  int64_t column = f->t->unknown[(size_t)node_j * dofs + (size_t)j];
  if (row < 0 || column < 0)
    return;
  SuiteSparse_long *rows = f->triplet->i, *columns = f->triplet->j;
  size_t at = f->triplet->nnz++;
  rows[at] = row > column ? row : column;
  columns[at] = row > column ? column : row;
  ((double *)f->triplet->x)[at] = row == column ? value : 0.5 * value;
}

static void fill_all(filler *f) {
  const statics *t = f->t;
  const cdem_sparse *k = &t->matrix;
  int dofs = k->dofs, dim = t->solver->store->dimension;
  for (int32_t p = 0; p < k->nodes; p++)
    for (int64_t b = k->start[p]; b < k->start[p + 1]; b++)
      for (int i = 0; i < dofs; i++)
        for (int j = 0; j < dofs; j++)
          fill(f, k->node[p], i, k->node[k->column[b]], j, k->value[(b * dofs + i) * dofs + j]);
  for (int64_t l = 0; l < t->joints; l++)
    for (int i = 0; i < dim; i++)
      for (int j = 0; j < dim; j++)
        fill(f, t->joint[l].node[0], i, t->joint[l].node[1], j, t->joint[l].block[dim * i + j]);
}

static cdem_status out_of_memory(cdem_fault *fault) {
  return cdem_fail(fault, CDEM_MEMORY, "out of memory in the sparse factorisation");
}

/* The power of two at or below the largest stiffness of a displacement: roots of stiffness over it
 * are the same bits for the same stiffness times any power of two, an odd one too. Rotations have
 * another dimension, by the square of a length, whose root is as exact. */
static double unit_of(const statics *t, const double *diagonal) {
  int dofs = t->solver->dofs, dim = t->solver->store->dimension, exponent;
  double most = 0.0;
  for (int64_t i = 0; i < (int64_t)t->solver->nodes * dofs; i++)
    if (t->unknown[i] >= 0 && i % dofs < dim)
      most = fmax(most, diagonal[t->unknown[i]]);
  frexp(most, &exponent);
  return most > 0.0 && isfinite(most) ? ldexp(1.0, exponent - 1) : 1.0;
}

/* Rows and columns divided by the root of the diagonal: rotations and soft parts weigh the same. */
static cdem_status scale_matrix(statics *t) {
  const SuiteSparse_long *start = t->reduced_matrix->p, *row = t->reduced_matrix->i;
  double *value = t->reduced_matrix->x;
  CDEM_NEW(t->scale, t->unknowns, t->fault);
  for (int64_t c = 0; c < t->unknowns; c++)
    for (SuiteSparse_long k = start[c]; k < start[c + 1]; k++)
      if (row[k] == c)
        t->scale[c] = value[k];
  t->unit = unit_of(t, t->scale);
  for (int64_t k = 0; k < start[t->unknowns]; k++)
    value[k] /= t->unit;
  for (int64_t c = 0; c < t->unknowns; c++)
    t->scale[c] = t->scale[c] > 0.0 ? 1.0 / sqrt(t->scale[c] / t->unit) : 1.0;
  for (int64_t c = 0; c < t->unknowns; c++)
    for (SuiteSparse_long k = start[c]; k < start[c + 1]; k++)
      value[k] *= t->scale[c] * t->scale[row[k]];
  return CDEM_OK;
}

static cdem_status build_matrix(statics *t) {
  int dofs = t->matrix.dofs, dim = t->solver->store->dimension;
  size_t entries = (size_t)(t->matrix.start[t->matrix.nodes] * dofs * dofs + t->joints * dim * dim);
  size_t rows = (size_t)t->unknowns;
  cholmod_l_start(&t->common);
  t->started = true;
  t->common.print = 0;
  cholmod_triplet *triplet =
      cholmod_l_allocate_triplet(rows, rows, entries, -1, CHOLMOD_REAL, &t->common);
  if (triplet == NULL)
    return out_of_memory(t->fault);
  filler f = {triplet, t};
  fill_all(&f);
  t->reduced_matrix = cholmod_l_triplet_to_sparse(triplet, triplet->nnz, &t->common);
  cholmod_l_free_triplet(&triplet, &t->common);
  if (t->reduced_matrix == NULL)
    return out_of_memory(t->fault);
  return scale_matrix(t);
}

static cdem_status factorise(statics *t) {
  const cdem_mesh *mesh = t->solver->store->options.body->model->mesh;
  t->factor = cholmod_l_analyze(t->reduced_matrix, &t->common);
  if (t->factor == NULL)
    return out_of_memory(t->fault);
  cholmod_l_factorize(t->reduced_matrix, t->factor, &t->common);
  if (t->common.status == CHOLMOD_OUT_OF_MEMORY || t->common.status == CHOLMOD_TOO_LARGE)
    return out_of_memory(t->fault);
  if (t->common.status == CHOLMOD_OK && t->factor->minor == t->factor->n)
    return CDEM_OK;
  size_t pivot = t->factor->minor < t->factor->n ? t->factor->minor : 0;
  int64_t unknown = ((SuiteSparse_long *)t->factor->Perm)[pivot], at = 0;
  while (t->unknown[at] != unknown)
    at++;
  return cdem_fail(t->fault, CDEM_NUMERIC,
                   "the stiffness is not positive definite near node %lld: parts hang together by "
                   "single points, or a material is not stable",
                   (long long)mesh->node_tag[at / t->solver->dofs]);
}

/* ---- solving ---- */

/* residual = external + applied - K u at all components; returns the largest entry. */
static void take_residual(statics *t) {
  cdem_solver *solver = t->solver;
  size_t dofs = (size_t)solver->dofs, dim = (size_t)solver->store->dimension;
  for (size_t i = 0; i < (size_t)solver->nodes * dofs; i++)
    t->residual[i] = solver->external[i] + solver->applied[i];
  for (int32_t p = 0; p < t->matrix.nodes; p++)
    memcpy(t->packed + (size_t)p * dofs, solver->u + (size_t)t->matrix.node[p] * dofs,
           dofs * sizeof(double));
  cdem_sparse_multiply(&t->matrix, t->packed, t->product);
  for (int32_t p = 0; p < t->matrix.nodes; p++)
    for (size_t i = 0; i < dofs; i++)
      t->residual[(size_t)t->matrix.node[p] * dofs + i] -= t->product[(size_t)p * dofs + i];
  for (int64_t l = 0; l < t->joints; l++)
    for (size_t i = 0; i < dim; i++)
      for (size_t j = 0; j < dim; j++)
        t->residual[(size_t)t->joint[l].node[0] * dofs + i] -=
            t->joint[l].block[dim * i + j] * solver->u[(size_t)t->joint[l].node[1] * dofs + j];
}

/* Adds the solution for the present residual to u. */
static cdem_status correct(statics *t) {
  cdem_solver *solver = t->solver;
  size_t count = (size_t)solver->nodes * (size_t)solver->dofs, rows = (size_t)t->unknowns;
  memset(t->reduced, 0, rows * sizeof *t->reduced);
  for (size_t i = 0; i < count; i++)
    if (t->unknown[i] >= 0)
      t->reduced[t->unknown[i]] += t->residual[i] / t->unit * t->scale[t->unknown[i]];
  cholmod_dense right = {
      .nrow = rows, .ncol = 1, .nzmax = rows, .d = rows, .x = t->reduced, .xtype = CHOLMOD_REAL};
  cholmod_dense *solution = cholmod_l_solve(CHOLMOD_A, t->factor, &right, &t->common);
  if (solution == NULL)
    return out_of_memory(t->fault);
  const double *x = solution->x;
  for (size_t i = 0; i < count; i++)
    if (t->unknown[i] >= 0)
      solver->u[i] += x[t->unknown[i]] * t->scale[t->unknown[i]];
  cholmod_l_free_dense(&solution, &t->common);
  return CDEM_OK;
}

static cdem_status solve(statics *t, double time) {
  cdem_solver *solver = t->solver;
  cdem_solver_store *s = solver->store;
  int64_t count = (int64_t)solver->nodes * solver->dofs;
  CDEM_TRY(cdem_body_stiffness(s->options.body, &t->matrix, t->fault));
  CDEM_TRY(gather_joints(t));
  CDEM_TRY(cdem_static_check_supports(solver, &t->matrix, t->joins, (const int32_t(*)[2])t->join,
                                      t->fault));
  CDEM_NEW(t->residual, count, t->fault);
  CDEM_NEW(t->product, count, t->fault);
  CDEM_NEW(t->packed, count, t->fault);
  CDEM_TRY(number_unknowns(t, time));
  CDEM_NEW(t->reduced, t->unknowns, t->fault);
  cdem_solver_external(solver, NULL, time);
  if (t->unknowns > 0) {
    CDEM_TRY(build_matrix(t));
    CDEM_TRY(factorise(t));
  }
  for (int k = 0; k < REFINEMENTS; k++) {
    take_residual(t);
    if (t->unknowns > 0)
      CDEM_TRY(correct(t));
  }
  take_residual(t);
  for (int64_t i = 0; i < count; i++)
    solver->force[i] = t->residual[i] - solver->applied[i];
  return CDEM_OK;
}

cdem_status cdem_solver_static(cdem_solver *solver, double time, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  CDEM_REQUIRE(s->options.plates == 0, fault, CDEM_INPUT,
               "a static solution knows no plates; take supports with displacements instead, or "
               "relax the body");
  CDEM_REQUIRE(s->options.contact == NULL, fault, CDEM_INPUT,
               "a static solution knows no contact; leave it out, or relax the body");
  int tensionless = s->options.body->tensionless;
  CDEM_REQUIRE(tensionless < 0, fault, CDEM_INPUT,
               "material '%s' carries no tension and so is not linear, but a static solution is; "
               "relax the body (analysis: relaxation)",
               s->options.body->model->materials_of[tensionless].name);
  statics t = {.solver = solver, .fault = fault};
  cdem_status status = solve(&t, time);
  statics_release(&t);
  if (status != CDEM_OK)
    return status;
  s->stale = true;
  cdem_solver_set_time(solver, time);
  cdem_solver_paths(solver, cdem_solver_next_time(solver));
  cdem_solver_book_start(solver);
  return CDEM_OK;
}
