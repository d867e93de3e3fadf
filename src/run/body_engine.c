/* The engine of bodies: what the files of a run ask of it, answered by the solver. */
#include "io/run_files.h"
#include "run/body.h"

#include <stdlib.h>
#include <string.h>

static cdem_run_body *body_of(const cdem_run_setup *run) {
  return run->context;
}

/* ---- from the case to the solver ---- */

static cdem_status read_mesh(cdem_run_body *body, cdem_fault *fault) {
  const cdem_progress *progress = body->run->options->progress;
  CDEM_TRY(cdem_progress_report(progress, "reading the mesh", 0, 0, fault));
  CDEM_TRY(cdem_run_body_mesh(body, fault));
  return cdem_progress_report(progress, "building", 0, 0, fault);
}

static void sum_mesh(cdem_run_body *body) {
  const cdem_mesh *mesh = &body->mesh;
  uint64_t sum =
      cdem_run_checksum(CDEM_RUN_SUM_START, mesh->xyz, (size_t)mesh->nodes * 3 * sizeof *mesh->xyz);
  sum = cdem_run_checksum(sum, mesh->cell_shape, (size_t)mesh->cells);
  body->run->input_sum = cdem_run_checksum(
      sum, mesh->cell_node, (size_t)mesh->cell_start[mesh->cells] * sizeof *mesh->cell_node);
}

cdem_status cdem_run_body_create(cdem_run_setup *run, const cdem_state *checkpoint,
                                 cdem_run_body **made, cdem_fault *fault) {
  cdem_run_body *body = cdem_allocate(1, sizeof *body, fault);
  if (body == NULL)
    return CDEM_MEMORY;
  run->context = body;
  body->run = run;
  *made = body;
  const cdem_case_values *values = cdem_run_values(run);
  body->section =
      (cdem_section){.plane = (cdem_plane)values->plane, .thickness = values->thickness};
  if (checkpoint != NULL)
    CDEM_TRY(cdem_mesh_from_state(checkpoint, "mesh", &body->mesh, fault));
  else
    CDEM_TRY(read_mesh(body, fault));
  sum_mesh(body);
  return CDEM_OK;
}

cdem_status cdem_run_body_build(cdem_run_body *body, cdem_fault *fault) {
  CDEM_TRY(cdem_run_body_model(body, fault));
  CDEM_TRY(cdem_run_body_interfaces(body, fault));
  CDEM_TRY(cdem_run_body_contact(body, fault));
  CDEM_TRY(cdem_run_body_conditions(body, fault));
  return cdem_run_body_loads(body, fault);
}

cdem_status cdem_run_body_start(cdem_run_body *body, cdem_fault *fault) {
  CDEM_TRY(cdem_run_body_solver(body, fault));
  return cdem_run_probes_init(body, &body->probes, fault);
}

static cdem_status build(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  cdem_run_body *body;
  CDEM_TRY(cdem_run_body_create(run, checkpoint, &body, fault));
  CDEM_TRY(cdem_run_body_build(body, fault));
  return cdem_run_body_start(body, fault);
}

static void release(cdem_run_setup *run) {
  cdem_run_body *body = body_of(run);
  if (body == NULL)
    return;
  cdem_run_probes_release(body, &body->probes);
  cdem_solver_release(&body->solver);
  cdem_contact_release(&body->contact);
  cdem_interfaces_release(&body->interfaces);
  cdem_body_release(&body->body);
  cdem_run_conditions_release(&body->conditions);
  cdem_model_release(&body->model);
  cdem_blocks_release(&body->blocks);
  cdem_mesh_release(&body->mesh);
  free(body->density);
  free(body->micro_inertia);
  free(body->no_tension);
  free(body->moduli);
  free(body->model_of);
  free(body->volume);
  free(body);
  run->context = NULL;
}

static cdem_status save(const cdem_run_setup *run, cdem_state *state, cdem_fault *fault) {
  const cdem_run_body *body = body_of(run);
  CDEM_TRY(cdem_mesh_to_state(&body->mesh, "mesh", state, fault));
  return cdem_solver_save(&body->solver, state, fault);
}

static cdem_status restore(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  return cdem_solver_restore(&body_of(run)->solver, checkpoint, fault);
}

/* ---- on its way ---- */

static void now(const cdem_run_setup *run, cdem_run_now *at) {
  const cdem_solver *solver = &body_of(run)->solver;
  *at = (cdem_run_now){.time = solver->time, .step = solver->step, .steps = solver->steps};
}

static cdem_status advance(cdem_run_setup *run, int64_t steps, cdem_fault *fault) {
  for (int64_t i = 0; i < steps; i++)
    CDEM_TRY(cdem_solver_step(&body_of(run)->solver, fault));
  return CDEM_OK;
}

static double unbalanced(const cdem_run_setup *run) {
  return cdem_solver_unbalanced(&body_of(run)->solver);
}

static cdem_status frames(cdem_run_setup *run, int64_t index, const cdem_frame_sink *sink,
                          cdem_fault *fault) {
  return cdem_solver_frames(&body_of(run)->solver, index, sink, fault);
}

/* ---- sizes ---- */

static cdem_status sizes(const cdem_run_setup *run, cdem_run_summary *summary, cdem_fault *fault) {
  (void)fault;
  const cdem_run_body *body = body_of(run);
  summary->nodes = body->body.nodes;
  summary->unknowns = (int64_t)body->body.nodes * body->body.dofs;
  summary->elements = body->model.cells;
  summary->distinct = body->body.distinct;
  summary->blocks = body->blocks.blocks;
  summary->interfaces = body->blocks.pairs;
  return CDEM_OK;
}

static void put_sizes(cdem_json *json, const cdem_run_summary *summary) {
  cdem_json_integer(json, "nodes", summary->nodes);
  cdem_json_integer(json, "unknowns", summary->unknowns);
  cdem_json_integer(json, "elements", summary->elements);
  cdem_json_integer(json, "distinct_elements", summary->distinct);
  cdem_json_integer(json, "blocks", summary->blocks);
  cdem_json_integer(json, "interfaces", summary->interfaces);
}

const cdem_run_engine cdem_run_engine_body = {
    .name = "body",
    .row_every = 100,
    .look_every = 20,
    .energies = {{"stored", {"kinetic", "elastic", "interface", "contact", "plate"}},
                 {"dissipated", {"fracture", "friction", "damping", "quiet"}},
                 {"work done", {"load", "gravity", "support"}}},
    .build = build,
    .release = release,
    .save = save,
    .restore = restore,
    .now = now,
    .advance = advance,
    .unbalanced = unbalanced,
    .frames = frames,
    .columns = cdem_run_body_columns,
    .sizes = sizes,
    .put_sizes = put_sizes,
    .pictures = cdem_run_body_pictures};
