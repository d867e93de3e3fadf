/* The engine of coupled cases: what the files of a run ask of it, answered by body and grains. */
#include "dem/frames.h"
#include "io/run_files.h"
#include "run/coupled.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- from the case to the solvers ---- */

/* The case again, for an engine of its own. */
static void view_of(const cdem_run_setup *run, const cdem_run_engine *engine,
                    cdem_run_setup *view) {
  *view = *run;
  view->engine = engine;
  view->context = NULL;
}

static cdem_status build_grains(cdem_run_coupled *c, const cdem_state *checkpoint,
                                cdem_fault *fault) {
  view_of(c->run, &cdem_run_engine_grains, &c->grains_run);
  CDEM_TRY(cdem_run_grains_create(&c->grains_run, checkpoint, &c->grains, fault));
  if (checkpoint == NULL)
    CDEM_TRY(cdem_run_coupled_check_grains(c, fault));
  CDEM_TRY(cdem_run_coupled_divide(c, fault));
  CDEM_TRY(cdem_run_coupled_supports(c, fault));
  CDEM_TRY(cdem_run_grains_build(c->grains, checkpoint, fault));
  CDEM_TRY(cdem_run_coupled_projector(c, fault));
  CDEM_TRY(cdem_run_coupled_loads(c, fault));
  return cdem_strain_reference_create(&c->grains->dem, 0.0, &c->strain, fault);
}

static cdem_status build_body(cdem_run_coupled *c, cdem_fault *fault) {
  if (c->has_grains)
    CDEM_TRY(cdem_run_coupled_ties(c, fault));
  return cdem_run_body_build(c->body, fault);
}

static void say_sizes(cdem_run_coupled *c) {
  c->run->input_sum = c->body_run.input_sum;
  c->run->threads = c->has_grains ? c->grains_run.threads : c->body_run.threads;
  if (!c->has_body)
    memcpy(c->run->limiter, c->grains_run.limiter, sizeof c->run->limiter);
  else if (!c->has_grains)
    memcpy(c->run->limiter, c->body_run.limiter, sizeof c->run->limiter);
}

static cdem_status build(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  cdem_run_coupled *c = cdem_allocate(1, sizeof *c, fault);
  if (c == NULL)
    return CDEM_MEMORY;
  run->context = c;
  c->run = run;
  c->version = (cdem_case_version)cdem_run_values(run)->coupling.version;
  c->has_body = c->version == CDEM_VERSION_COUPLED || c->version == CDEM_VERSION_CONTINUUM;
  c->has_grains = c->version != CDEM_VERSION_CONTINUUM;
  view_of(run, &cdem_run_engine_body, &c->body_run);
  CDEM_TRY(cdem_run_body_create(&c->body_run, checkpoint, &c->body, fault));
  CDEM_TRY(cdem_run_coupled_cells(c, fault));
  if (c->has_grains)
    CDEM_TRY(build_grains(c, checkpoint, fault));
  if (c->has_body)
    CDEM_TRY(build_body(c, fault));
  CDEM_TRY(cdem_run_coupled_start(c, fault));
  say_sizes(c);
  return CDEM_OK;
}

static void release(cdem_run_setup *run) {
  cdem_run_coupled *c = cdem_run_coupled_of(run);
  if (c == NULL)
    return;
  cdem_coupling_release(&c->coupling);
  cdem_absorb_release(&c->absorb);
  cdem_tie_release(&c->tie);
  cdem_tie_release(&c->fine_tie);
  cdem_projector_release(&c->projector);
  cdem_partition_release(&c->partition);
  cdem_run_coupled_edge_release(c);
  cdem_strain_reference_destroy(&c->strain);
  cdem_run_engine_body.release(&c->body_run);
  cdem_run_engine_grains.release(&c->grains_run);
  free(c->fine_cell);
  free(c->fine_grain);
  free(c->not_fine);
  free(c->spare);
  free(c->u);
  free(c->d);
  free(c->kept);
  free(c);
  run->context = NULL;
}

/* ---- checkpoints ---- */

static cdem_status save(const cdem_run_setup *run, cdem_state *state, cdem_fault *fault) {
  const cdem_run_coupled *c = cdem_run_coupled_of(run);
  if (c->has_body)
    CDEM_TRY(cdem_run_engine_body.save(&c->body_run, state, fault));
  else
    CDEM_TRY(cdem_mesh_to_state(&c->body->mesh, "mesh", state, fault));
  if (c->has_grains)
    CDEM_TRY(cdem_run_engine_grains.save(&c->grains_run, state, fault));
  return c->has_body && c->has_grains ? cdem_coupling_save(&c->coupling, state, fault) : CDEM_OK;
}

static cdem_status restore(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  cdem_run_coupled *c = cdem_run_coupled_of(run);
  if (c->has_grains)
    CDEM_TRY(cdem_run_engine_grains.restore(&c->grains_run, checkpoint, fault));
  if (c->has_body)
    CDEM_TRY(cdem_run_engine_body.restore(&c->body_run, checkpoint, fault));
  return c->has_body && c->has_grains ? cdem_coupling_restore(&c->coupling, checkpoint, fault)
                                      : CDEM_OK;
}

/* ---- on its way ---- */

static void now(const cdem_run_setup *run, cdem_run_now *at) {
  const cdem_run_coupled *c = cdem_run_coupled_of(run);
  if (c->has_body) {
    const cdem_solver *solver = &c->body->solver;
    *at = (cdem_run_now){.time = solver->time, .step = solver->step, .steps = solver->steps};
    return;
  }
  const cdem_dem *dem = &c->grains->dem;
  *at = (cdem_run_now){
      .time = dem->time, .step = c->cycles * dem->step, .steps = dem->steps / c->cycles};
}

static cdem_status advance_one(cdem_run_coupled *c, cdem_fault *fault) {
  if (!c->has_grains)
    return cdem_solver_step(&c->body->solver, fault);
  double from = c->grains->dem.time;
  cdem_run_coupled_edge(c, from, from + c->cycles * c->grains->dem.step);
  return c->has_body ? cdem_coupling_step(&c->coupling, fault)
                     : cdem_dem_steps(&c->grains->dem, c->cycles, fault);
}

static cdem_status advance(cdem_run_setup *run, int64_t steps, cdem_fault *fault) {
  for (int64_t i = 0; i < steps; i++)
    CDEM_TRY(advance_one(cdem_run_coupled_of(run), fault));
  return CDEM_OK;
}

/* Coupled runs go through time; nothing asks for a balance. */
static double unbalanced(const cdem_run_setup *run) {
  (void)run;
  return INFINITY;
}

/* ---- sizes ---- */

static cdem_status sizes(const cdem_run_setup *run, cdem_run_summary *summary, cdem_fault *fault) {
  const cdem_run_coupled *c = cdem_run_coupled_of(run);
  if (c->has_body)
    CDEM_TRY(cdem_run_engine_body.sizes(&c->body_run, summary, fault));
  if (c->has_grains)
    CDEM_TRY(cdem_run_engine_grains.sizes(&c->grains_run, summary, fault));
  summary->fine = c->fine;
  summary->interface_grains =
      c->version == CDEM_VERSION_COUPLED || c->version == CDEM_VERSION_FROZEN
          ? c->partition.interfaces
          : 0;
  summary->cycles = c->cycles;
  summary->coarse_limit = c->coarse_limit;
  summary->wall_fine = c->coupling.cost.fine;
  summary->wall_coarse = c->coupling.cost.coarse;
  summary->wall_transfer = c->coupling.cost.transfer;
  return CDEM_OK;
}

static void put_sizes(cdem_json *json, const cdem_run_summary *summary) {
  cdem_run_engine_body.put_sizes(json, summary);
  cdem_run_engine_grains.put_sizes(json, summary);
  cdem_json_integer(json, "fine_grains", summary->fine);
  cdem_json_integer(json, "interface_grains", summary->interface_grains);
  cdem_json_integer(json, "cycles", summary->cycles);
  cdem_json_real(json, "coarse_step_limit", summary->coarse_limit);
  if (summary->coarse_limit > 0.0) {
    cdem_json_real(json, "wall_fine", summary->wall_fine);
    cdem_json_real(json, "wall_coarse", summary->wall_coarse);
    cdem_json_real(json, "wall_transfer", summary->wall_transfer);
  }
}

const cdem_run_engine cdem_run_engine_coupled = {
    .name = "coupled",
    .strides = true,
    .row_every = 1000,
    .look_every = 200,
    .energies = {{"coarse", {"coarse.kinetic", "coarse.elastic", "coarse.damping", "coarse.load"}},
                 {"grains",
                  {"fine.translation", "fine.normal", "fine.shear", "fine.friction", "fine.damping",
                   "fine.walls"}},
                 {"exchange", {"exchange", "coarse_part", "fine_part"}}},
    .build = build,
    .release = release,
    .save = save,
    .restore = restore,
    .now = now,
    .advance = advance,
    .unbalanced = unbalanced,
    .frames = cdem_run_coupled_frames,
    .columns = cdem_run_coupled_columns,
    .sizes = sizes,
    .put_sizes = put_sizes,
    .pictures = cdem_run_coupled_pictures};
