/* The two steps of a coupled run, and how many of the one make one of the other.
 *
 * The grains' step is the case's, or a fraction of their limit; the body takes m of them. A whole
 * number of the body's steps ends at `end`. With a step and a number of cycles in the case, all
 * versions with grains take the same steps, so that their rows can be compared. */
#include "run/coupled.h"
#include "run/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CYCLES = 20 };               /* beyond, the body costs nothing any more */
static const double coarse_safety = 0.8; /* of the automatic number of cycles */

/* ---- the body and its limit ---- */

/* Masses of the fine grains, lumped, in the nodes of the fine region (form virtual-work). */
static cdem_status add_masses(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_projector *p = &c->projector;
  cdem_run_body *body = c->body;
  int32_t *of; /* [nodes of the mesh] node of the body */
  double *lumped;
  if (cdem_run_coupled_values(c)->form != CDEM_BSM_VIRTUAL_WORK)
    return CDEM_OK;
  CDEM_NEW(of, body->mesh.nodes, fault);
  lumped = cdem_allocate(2 * (int64_t)p->nodes, sizeof *lumped, fault);
  if (lumped == NULL) {
    free(of);
    return CDEM_MEMORY;
  }
  for (int32_t n = 0; n < body->blocks.mesh.nodes; n++)
    of[body->blocks.original[n]] = n;
  cdem_projector_lumped(p, lumped, lumped + p->nodes);
  for (int32_t i = 0; i < p->nodes; i++) {
    double *mass = body->body.mass + (int64_t)of[p->node[i]] * body->body.dofs;
    for (int k = 0; k < body->body.dofs; k++)
      mass[k] += k < c->grains->dim ? lumped[i] : lumped[p->nodes + i];
  }
  free(lumped);
  free(of);
  return CDEM_OK;
}

/* The body with this factor on its micro-inertia, its solver at the step of the grains, and the
 * longest step it may take with its interface grains. */
static cdem_status make_body(cdem_run_coupled *c, double factor, double step, cdem_fault *fault) {
  cdem_run_body *body = c->body;
  cdem_solver_release(&body->solver);
  if (body->body.nodes == 0 || factor != fmax(body->rotation_factor, 1.0)) {
    body->rotation_factor = factor;
    CDEM_TRY(cdem_run_body_elastic(body, fault));
    CDEM_TRY(add_masses(c, fault));
    if (body->has_contact) { /* it looks at the masses of the body that is no more */
      cdem_contact_release(&body->contact);
      CDEM_TRY(cdem_run_body_contact(body, fault));
    }
  }
  body->fixed_step = step;
  CDEM_TRY(cdem_run_body_solver(body, fault));
  double own = cdem_solver_limit(&body->solver, c->run->limiter);
  return cdem_coupling_limit(&body->body, own, &c->tie, &c->grains->dem, &c->coarse_limit, fault);
}

/* Rotations are slow enough when a larger inertia no longer lengthens the step. */
static cdem_status scale_rotation(cdem_run_coupled *c, double step, cdem_fault *fault) {
  enum { MOST_DOUBLINGS = 40 };
  double factor = 1.0, before = c->coarse_limit;
  if (cdem_run_coupled_values(c)->rotation == 0 ||
      c->body->model.formulation != CDEM_PLANE_COSSERAT)
    return CDEM_OK;
  for (int i = 0; i < MOST_DOUBLINGS; i++) {
    factor *= 2.0;
    CDEM_TRY(make_body(c, factor, step, fault));
    if (c->coarse_limit < 1.01 * before)
      return CDEM_OK;
    before = c->coarse_limit;
  }
  return CDEM_OK;
}

/* ---- ties ---- */

/* Grains of one part with their cells in the body's mesh; cell_of NULL: in the mesh as read. */
static cdem_status make_tie(cdem_run_coupled *c, cdem_bsm_part part, const int32_t *cell_of,
                            cdem_tie *tie, cdem_fault *fault) {
  const cdem_partition *p = &c->partition;
  int64_t most = p->grains, count = 0;
  int32_t *grain = cdem_allocate(most, sizeof *grain, fault);
  int32_t *cell = cdem_allocate(most, sizeof *cell, fault);
  double *xi = cdem_allocate(3 * most, sizeof *xi, fault);
  bool there = grain != NULL && cell != NULL && xi != NULL;
  for (int64_t i = 0; there && i < p->grains; i++) {
    if (p->part[i] != part)
      continue;
    grain[count] = (int32_t)i;
    cell[count] = cell_of != NULL ? cell_of[p->cell[i]] : p->cell[i];
    memcpy(xi + 3 * count++, p->xi + 3 * i, 3 * sizeof *xi);
  }
  cdem_status status = there
                           ? cdem_tie_init(cell_of != NULL ? &c->body->blocks.mesh : &c->body->mesh,
                                           c->body->body.dofs, count, grain, cell, xi, tie, fault)
                           : CDEM_MEMORY;
  free(grain);
  free(cell);
  free(xi);
  return status;
}

static cdem_status tie_interface(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_blocks *blocks = &c->body->blocks;
  int32_t *cell_of;
  CDEM_NEW(cell_of, c->body->mesh.cells, fault);
  for (int32_t k = 0; k < blocks->mesh.cells; k++)
    cell_of[blocks->old_cell[k]] = k;
  cdem_status status = make_tie(c, CDEM_PART_INTERFACE, cell_of, &c->tie, fault);
  free(cell_of);
  return status;
}

/* Fine grains to the nodes of the body: their cells are not among the body's, so the rows of the
 * mesh as read get the body's numbers. */
static cdem_status tie_fine(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_run_body *body = c->body;
  cdem_tie *tie = &c->fine_tie;
  int32_t *of;
  CDEM_TRY(make_tie(c, CDEM_PART_FINE, NULL, tie, fault));
  CDEM_NEW(of, body->mesh.nodes, fault);
  for (int32_t n = 0; n < body->blocks.mesh.nodes; n++)
    of[body->blocks.original[n]] = n;
  for (int64_t k = 0; k < tie->weights.start[tie->grains]; k++)
    tie->weights.node[k] = of[tie->weights.node[k]];
  for (int32_t k = 0; k < tie->nodes; k++)
    tie->node[k] = of[tie->node[k]];
  free(of);
  return CDEM_OK;
}

/* ---- cycles ---- */

/* The limit of the body when all of its faces have opened: tied ones add their springs and lose the
 * masses of their copies, and contact, which opens and closes, counts four times (cdem/solver). The
 * number of cycles cannot change on the way. */
static double limit_when_open(const cdem_run_coupled *c) {
  enum { UNILATERAL = 4 };
  const cdem_run_body *body = c->body;
  if (!body->has_interfaces)
    return c->coarse_limit;
  double now = 2.0 / c->coarse_limit,
         contact = body->has_contact ? UNILATERAL * cdem_run_contact_stiffness(body) : 0.0;
  return 2.0 / sqrt(now * now +
                    cdem_interfaces_open_frequency2(&body->interfaces, body->body.mass, contact));
}

static cdem_status choose_cycles(cdem_run_coupled *c, double step, cdem_fault *fault) {
  const cdem_case_coupling *v = cdem_run_coupled_values(c);
  double most = floor(coarse_safety * limit_when_open(c) / step);
  int largest = (int)fmin(floor(c->coarse_limit / step), 1e9);
  if (v->cycles > largest || largest < 1)
    return cdem_case_fail(&c->run->cases, "coupling.cycles", CDEM_INPUT, fault,
                          "%d steps of the grains of %.4g s are more than the coarse medium can "
                          "take: its longest stable step is %.4g s, set by %s; take at most %d%s",
                          v->cycles > 0 ? (int)v->cycles : 1, step, c->coarse_limit,
                          c->run->limiter, largest,
                          v->rotation == 0 && c->body->model.formulation == CDEM_PLANE_COSSERAT
                              ? ", or let `rotation` be scaled"
                              : "");
  c->cycles = v->cycles > 0 ? (int)v->cycles : most < 1.0 ? 1 : (int)fmin(most, MOST_CYCLES);
  return CDEM_OK;
}

/* The grains' step such that whole steps of the body end at `end`. */
static cdem_status set_steps(cdem_run_coupled *c, double step, cdem_fault *fault) {
  double coarse = cdem_run_even_step(c->run, c->cycles * step);
  cdem_status status = cdem_dem_set_step(&c->grains->dem, coarse / c->cycles, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&c->run->cases, "step", fault) : status;
}

/* ---- the absorbing layer ---- */

static cdem_status make_layer(cdem_run_coupled *c, cdem_absorb_options *layer, cdem_fault *fault) {
  const cdem_partition *p = &c->partition;
  int32_t *cell;
  double *xi;
  CDEM_NEW(cell, c->fine, fault);
  xi = cdem_allocate(3 * c->fine, sizeof *xi, fault);
  if (xi == NULL) {
    free(cell);
    return CDEM_MEMORY;
  }
  for (int64_t a = 0; a < c->fine; a++) {
    cell[a] = p->cell[c->fine_grain[a]];
    memcpy(xi + 3 * a, p->xi + 3 * (int64_t)c->fine_grain[a], 3 * sizeof *xi);
  }
  layer->cell = cell;
  layer->xi = xi;
  cdem_status status = cdem_absorb_init(layer, &c->absorb, fault);
  free(cell);
  free(xi);
  return status == CDEM_INPUT ? cdem_case_blame(&c->run->cases, "coupling.absorb", fault) : status;
}

static cdem_status absorb(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_case_coupling *v = cdem_run_coupled_values(c);
  cdem_absorb_options layer = {.mesh = &c->body->mesh,
                               .grains = c->fine,
                               .grain = c->fine_grain,
                               .fine = &c->grains->dem,
                               .rate = v->absorb};
  int32_t *cell;
  if (!(v->absorb > 0.0))
    return CDEM_OK;
  CDEM_TRY(cdem_absorb_cells(&c->body->mesh, c->fine_cells, c->fine_cell, (int)v->absorb_layers,
                             &layer.cells, &cell, fault));
  layer.layer = cell;
  cdem_status status = make_layer(c, &layer, fault);
  free(cell);
  return status;
}

static cdem_status couple(cdem_run_coupled *c, double step, cdem_fault *fault) {
  const cdem_case_coupling *v = cdem_run_coupled_values(c);
  bool whole = v->form == CDEM_BSM_VIRTUAL_WORK;
  CDEM_TRY(tie_interface(c, fault));
  if (whole)
    CDEM_TRY(tie_fine(c, fault));
  CDEM_TRY(add_masses(c, fault));
  CDEM_TRY(make_body(c, 1.0, 1e-6 * step, fault)); /* short enough to be no step at all */
  CDEM_TRY(scale_rotation(c, 1e-6 * step, fault));
  CDEM_TRY(choose_cycles(c, step, fault));
  CDEM_TRY(set_steps(c, step, fault));
  CDEM_TRY(make_body(c, c->body->rotation_factor, c->cycles * c->grains->dem.step, fault));
  CDEM_TRY(absorb(c, fault));
  const cdem_coupling_options options = {.coarse = &c->body->solver,
                                         .fine = &c->grains->dem,
                                         .form = whole ? CDEM_BSM_VIRTUAL_WORK : CDEM_BSM_INTERFACE,
                                         .way = (cdem_bsm_way)v->interface_motion,
                                         .cycles = c->cycles,
                                         .tie = &c->tie,
                                         .fine_tie = whole ? &c->fine_tie : NULL,
                                         .absorb = v->absorb > 0.0 ? &c->absorb : NULL,
                                         .most_step = c->coarse_limit,
                                         .clock = cdem_run_clock};
  return cdem_coupling_init(&options, &c->coupling, fault);
}

cdem_status cdem_run_coupled_start(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_case_values *v = cdem_run_values(c->run);
  if (!c->has_grains)
    return cdem_run_body_start(c->body, fault);
  double step = isnan(v->step) ? c->grains->dem.step : v->step;
  if (c->has_body) {
    CDEM_TRY(couple(c, step, fault));
    return cdem_run_probes_init(c->body, &c->body->probes, fault);
  }
  c->cycles = v->coupling.cycles > 0 ? (int)v->coupling.cycles : 1;
  return set_steps(c, step, fault);
}
