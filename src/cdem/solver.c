#include "cdem/solver_store.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* ---- options ---- */

static cdem_status check_options(const cdem_solver_options *o, cdem_fault *fault) {
  CDEM_REQUIRE(o->safety >= 0.0 && o->safety <= 1.0, fault, CDEM_INPUT,
               "the safety of the step is %g; it must be above 0 and at most 1", o->safety);
  CDEM_REQUIRE(o->local_damping >= 0.0 && o->local_damping < 1.0, fault, CDEM_INPUT,
               "local damping is %g; it must be at least 0 and below 1", o->local_damping);
  CDEM_REQUIRE(o->mass_damping >= 0.0 && isfinite(o->mass_damping), fault, CDEM_INPUT,
               "mass damping is %g 1/s; it must not be negative", o->mass_damping);
  CDEM_REQUIRE(o->step >= 0.0 && isfinite(o->step), fault, CDEM_INPUT,
               "the step is %g s; it must be positive, or 0 for the longest stable one", o->step);
  CDEM_REQUIRE(o->blocks == NULL || o->body->model->dimension == 3 || o->thickness > 0.0, fault,
               CDEM_INPUT, "the thickness is %g m; it must be positive", o->thickness);
  CDEM_REQUIRE(o->blocks != NULL || (o->interfaces == NULL && o->contact == NULL &&
                                     o->pressures == 0 && o->quiets == 0 && o->plates == 0),
               fault, CDEM_USAGE,
               "interfaces, contact, pressures, quiet boundaries and plates need blocks");
  CDEM_REQUIRE(o->supports < INT16_MAX, fault, CDEM_INPUT, "%d supports are too many", o->supports);
  return CDEM_OK;
}

/* ---- arrays ---- */

static cdem_status allocate_state(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  int64_t nodes = solver->nodes, count = nodes * solver->dofs;
  CDEM_NEW(solver->u, count, fault);
  CDEM_NEW(solver->v, count, fault);
  CDEM_NEW(solver->force, count, fault);
  CDEM_NEW(solver->external, count, fault);
  CDEM_NEW(solver->applied, count, fault);
  CDEM_NEW(s->flag, nodes, fault);
  CDEM_NEW(s->support_of, count, fault);
  CDEM_NEW(s->path, o->supports, fault);
  CDEM_NEW(s->partial, (nodes / CDEM_SOLVER_CHUNK + 1) * CDEM_SUMS, fault);
  CDEM_NEW(s->pair_force, (int64_t)o->body->model->cells * CDEM_CLASSES, fault);
  CDEM_NEW(s->scratch, count, fault);
  for (int64_t i = 0; i < count; i++)
    s->support_of[i] = -1;
  for (int64_t n = 0; n < nodes; n++)
    if (!(o->body->mass[n * solver->dofs] > 0.0))
      s->flag[n] |= CDEM_NODE_EMPTY;
  if (o->fictitious_mass) {
    CDEM_NEW(s->fictitious, count, fault);
    CDEM_NEW(s->row_body, nodes, fault);
    CDEM_NEW(s->row_couple, nodes, fault);
    CDEM_NEW(s->row_sum, nodes, fault);
  }
  s->inertia = o->fictitious_mass ? s->fictitious : o->body->mass;
  return CDEM_OK;
}

static cdem_status allocate_joints(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  const cdem_interfaces *interfaces = s->options.interfaces;
  if (interfaces == NULL)
    return CDEM_OK;
  CDEM_NEW(s->cluster_of, solver->nodes, fault);
  CDEM_NEW(s->handed, s->options.blocks->pairs, fault);
  s->ties_version = -1;
  cdem_solver_ties(solver);
  if (cdem_interfaces_any_tied(interfaces)) {
    CDEM_NEW(s->cell_stress, 6 * (int64_t)s->options.body->model->cells, fault);
    CDEM_NEW(s->mesh_stress, 6 * (int64_t)s->options.body->model->mesh->cells, fault);
  }
  return CDEM_OK;
}

void cdem_solver_release(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  if (s != NULL) {
    cdem_solver_plates_release(solver);
    void *owned[] = {s->fictitious, s->row_body,   s->row_couple, s->row_sum,     s->flag,
                     s->support_of, s->path,       s->cluster_of, s->loaded_node, s->pressed,
                     s->quiet_node, s->dashpot_of, s->dashpot,    s->cell_stress, s->mesh_stress,
                     s->pair_force, s->scratch,    s->partial,    s->handed};
    for (size_t i = 0; i < sizeof owned / sizeof owned[0]; i++)
      free(owned[i]);
  }
  free(s);
  free(solver->u);
  free(solver->v);
  free(solver->force);
  free(solver->external);
  free(solver->applied);
  *solver = (cdem_solver){0};
}

/* ---- the start ---- */

/* What is free surface from the start touches from the start. */
static void open_contact(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  const cdem_blocks *blocks = s->options.blocks;
  if (s->options.contact == NULL)
    return;
  for (int32_t f = 0; f < blocks->facets; f++)
    if (blocks->facet[f].pair < 0)
      cdem_contact_activate(s->options.contact, f);
  for (int32_t p = 0; p < blocks->pairs; p++) {
    if (s->options.interfaces != NULL && !s->options.interfaces->released[p])
      continue;
    if (s->handed != NULL)
      s->handed[p] = 1;
    cdem_contact_hand_over(s->options.contact, p, NULL);
  }
}

static void start_state(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  size_t count = (size_t)solver->nodes * (size_t)solver->dofs;
  if (s->options.velocity != NULL)
    memcpy(solver->v, s->options.velocity, count * sizeof *solver->v);
  cdem_solver_paths(solver, 0.0);
  for (size_t i = 0; i < count; i++)
    if (s->support_of[i] >= 0)
      solver->u[i] = s->path[s->support_of[i]];
  if (s->options.interfaces == NULL)
    return;
  const cdem_ties *ties = &s->options.interfaces->ties;
  for (int32_t c = 0; c < ties->clusters; c++) {
    cdem_point point;
    solver->step = 1.0; /* any: only the displacements are asked for */
    cdem_solver_cluster(solver, c, &point);
    for (int32_t k = ties->start[c]; k < ties->start[c + 1]; k++)
      for (int32_t l = ties->start[c]; l < ties->start[c + 1]; l++)
        for (int i = 0; i < solver->dofs; i++) {
          size_t to = (size_t)ties->member[k] * (size_t)solver->dofs + (size_t)i;
          size_t from = (size_t)ties->member[l] * (size_t)solver->dofs + (size_t)i;
          if (s->support_of[to] < 0 && s->support_of[from] >= 0)
            solver->u[to] = solver->u[from];
        }
  }
  solver->step = 0.0;
}

static cdem_status start(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  CDEM_TRY(allocate_state(solver, fault));
  CDEM_TRY(allocate_joints(solver, fault));
  CDEM_TRY(cdem_solver_supports_init(solver, fault));
  CDEM_TRY(cdem_solver_loads_init(solver, fault));
  CDEM_TRY(cdem_solver_quiet_init(solver, fault));
  CDEM_TRY(cdem_solver_plates_init(solver, fault));
  start_state(solver);
  open_contact(solver);
  cdem_solver_body_limit(solver);
  if (o->fictitious_mass) {
    cdem_body_row_sums(o->body, s->row_body, s->row_couple);
    cdem_solver_masses(solver);
  }
  CDEM_TRY(cdem_solver_evaluate(solver, 0.0, fault));
  CDEM_TRY(cdem_solver_first_step(solver, fault));
  cdem_solver_paths(solver, solver->step);
  cdem_solver_start(solver);
  cdem_solver_book_start(solver);
  return CDEM_OK;
}

cdem_status cdem_solver_init(const cdem_solver_options *options, cdem_solver *solver,
                             cdem_fault *fault) {
  *solver = (cdem_solver){0};
  CDEM_TRY(check_options(options, fault));
  CDEM_NEW(solver->store, 1, fault);
  cdem_solver_store *s = solver->store;
  s->options = *options;
  s->dimension = options->body->model->dimension;
  s->threads = options->threads > 0 ? options->threads : omp_get_max_threads();
  solver->options = &s->options;
  solver->nodes = options->body->nodes;
  solver->dofs = options->body->dofs;
  cdem_status status = start(solver, fault);
  if (status != CDEM_OK)
    cdem_solver_release(solver);
  return status;
}
