#include "cdem/solver_store.h"

#include <math.h>
#include <string.h>

/* ---- forces at t_n ---- */

void cdem_solver_ties(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  if (s->options.interfaces == NULL || s->options.interfaces->ties.version == s->ties_version)
    return;
  const cdem_ties *ties = &s->options.interfaces->ties;
  s->ties_version = ties->version;
  for (int32_t n = 0; n < solver->nodes; n++) {
    s->flag[n] &= (uint8_t)~CDEM_NODE_TIED;
    s->cluster_of[n] = -1;
  }
  for (int32_t c = 0; c < ties->clusters; c++)
    for (int32_t k = ties->start[c]; k < ties->start[c + 1]; k++) {
      s->flag[ties->member[k]] |= CDEM_NODE_TIED;
      s->cluster_of[ties->member[k]] = c;
    }
}

/* Faces whose stress has reached the strength let go before the interfaces are evaluated: their
 * springs then bring the traction that the tie has carried. */
static void insert_interfaces(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  cdem_interfaces *interfaces = s->options.interfaces;
  if (s->cell_stress == NULL || !cdem_interfaces_any_tied(interfaces))
    return;
  const cdem_model *model = s->options.body->model;
  cdem_body_cell_stress(s->options.body, solver->u, s->cell_stress);
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int32_t c = 0; c < model->cells; c++)
    memcpy(s->mesh_stress + (size_t)6 * (size_t)model->cell[c],
           s->cell_stress + (size_t)6 * (size_t)c, 6 * sizeof(double));
  if (cdem_interfaces_insert(interfaces, solver->u, s->mesh_stress) > 0)
    cdem_solver_ties(solver);
}

/* Pairs that were released in this evaluation go over to contact, which has them from the next one
 * on: in this one the interfaces still held them. */
static void hand_over(cdem_solver *solver, int64_t version) {
  cdem_solver_store *s = solver->store;
  cdem_interfaces *interfaces = s->options.interfaces;
  if (interfaces == NULL || s->options.contact == NULL || interfaces->version == version)
    return;
  for (int32_t p = 0; p < s->options.blocks->pairs; p++) {
    double force[4][3];
    if (!interfaces->released[p] || s->handed[p])
      continue;
    s->handed[p] = 1;
    bool known = cdem_interfaces_last_force(interfaces, p, force);
    cdem_contact_hand_over(s->options.contact, p, known ? (const double(*)[3])force : NULL);
  }
}

static void add_external(cdem_solver *solver) {
  int64_t count = (int64_t)solver->nodes * solver->dofs;
  double *force = solver->force;
  const double *external = solver->external;
#pragma omp parallel for schedule(static) num_threads(solver->store->threads)
  for (int64_t i = 0; i < count; i++)
    force[i] += external[i];
}

cdem_status cdem_solver_evaluate(cdem_solver *solver, double dt, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  cdem_body_forces(o->body, solver->u, solver->force);
  int64_t version = 0;
  if (o->interfaces != NULL) {
    insert_interfaces(solver);
    version = o->interfaces->version;
    cdem_interfaces_forces(o->interfaces, solver->u, solver->force);
  }
  if (o->contact != NULL)
    CDEM_TRY(cdem_contact_forces(o->contact, solver->u, solver->v, dt, solver->force, fault));
  hand_over(solver, version);
  cdem_solver_plates_forces(solver);
  cdem_solver_external(solver, solver->u, solver->time);
  add_external(solver);
  s->stale = false;
  return CDEM_OK;
}

/* ---- one step ---- */

void cdem_solver_set_time(cdem_solver *solver, double time) {
  solver->time = time;
  solver->store->base_time = time;
  solver->store->base_steps = solver->steps;
}

static const char *likely_cause(const cdem_solver *solver) {
  const cdem_solver_options *o = &solver->store->options;
  if (o->step > 0.0)
    return "the step may be too long (leave it out, or take less), or a load too large";
  if (o->supports == 0 && (o->loads > 0 || o->pressures > 0))
    return "loads act on a body without supports, or are too large for it";
  return "a load or a prescribed motion may be too large or too sudden";
}

static cdem_status report_infinite(const cdem_solver *solver, cdem_fault *fault) {
  const cdem_mesh *mesh = solver->store->options.body->model->mesh;
  int64_t count = (int64_t)solver->nodes * solver->dofs, at = 0;
  while (at < count - 1 && isfinite(solver->v[at]))
    at++;
  int32_t node = (int32_t)(at / solver->dofs);
  const double *place = mesh->xyz + 3 * (size_t)node;
  return cdem_fail(fault, CDEM_NUMERIC,
                   "the motion is no longer finite at t = %.6g s, at node %lld (%.4g, %.4g, %.4g "
                   "m); %s",
                   solver->time, (long long)mesh->node_tag[node], place[0], place[1], place[2],
                   likely_cause(solver));
}

static cdem_status check_elements(const cdem_solver *solver, cdem_fault *fault) {
  const cdem_body *body = solver->store->options.body;
  int64_t cell = body->inverted;
  if (body->linear || cell < 0)
    return CDEM_OK;
  const cdem_mesh *mesh = body->model->mesh;
  int32_t id = body->model->cell[cell];
  const double *place = mesh->xyz + 3 * (size_t)cdem_mesh_cell(mesh, id)[0];
  return cdem_fail(fault, CDEM_NUMERIC,
                   "element %lld near (%.4g, %.4g, %.4g m) turned inside out at t = %.6g s; %s",
                   (long long)mesh->cell_tag[id], place[0], place[1], place[2], solver->time,
                   likely_cause(solver));
}

cdem_status cdem_solver_step(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  if (s->stale)
    CDEM_TRY(cdem_solver_evaluate(solver, 0.0, fault));
  double sums[CDEM_SUMS], dt = solver->step;
  cdem_solver_paths(solver, cdem_solver_next_time(solver));
  cdem_solver_pass(solver, true, solver->v, sums);
  for (int k = 0; k < CDEM_SUM_SPEED; k++)
    s->total[k] += sums[k];
  solver->time = cdem_solver_next_time(solver);
  solver->steps++;
  s->previous = dt;
  if (!isfinite(sums[CDEM_SUM_SPEED]))
    return report_infinite(solver, fault);
  CDEM_TRY(cdem_solver_evaluate(solver, dt, fault));
  CDEM_TRY(check_elements(solver, fault));
  cdem_solver_relook(solver, false);
  cdem_solver_paths(solver, cdem_solver_next_time(solver));
  return CDEM_OK;
}
