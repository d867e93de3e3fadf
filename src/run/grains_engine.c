/* The engine of grains: what the files of a run ask of it, answered by the solver. */
#include "run/grains.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static cdem_run_grains *grains_of(const cdem_run_setup *run) {
  return run->context;
}

/* ---- from the case to the solver ---- */

cdem_status cdem_run_grains_create(cdem_run_setup *run, const cdem_state *checkpoint,
                                   cdem_run_grains **made, cdem_fault *fault) {
  cdem_run_grains *g = cdem_allocate(1, sizeof *g, fault);
  if (g == NULL)
    return CDEM_MEMORY;
  *made = g;
  run->context = g;
  g->run = run;
  g->dim = (int)cdem_run_values(run)->grains.dimension;
  return cdem_run_grains_start(g, checkpoint, fault);
}

/* A membrane follows from the grains; those of a checkpoint that is not of this case could ask for
 * one of any size. */
static cdem_status check_membrane(const cdem_run_grains *g, const cdem_state *checkpoint,
                                  cdem_fault *fault) {
  if (checkpoint == NULL || g->confinement.membrane == NULL)
    return CDEM_OK;
  const cdem_array *kept = cdem_state_find(checkpoint, "membrane/place");
  int64_t nodes = cdem_membrane_nodes(&g->membrane);
  CDEM_REQUIRE(kept != NULL && kept->count == 3 * nodes, fault, CDEM_INPUT,
               "the checkpoint does not belong to this case: its grains want a membrane of %lld "
               "nodes, and it has %lld",
               (long long)nodes, (long long)(kept != NULL ? kept->count / 3 : 0));
  return CDEM_OK;
}

cdem_status cdem_run_grains_surround(cdem_run_grains *g, const cdem_state *checkpoint,
                                     cdem_fault *fault) {
  CDEM_TRY(cdem_run_grains_materials(g, fault));
  CDEM_TRY(cdem_run_grains_contacts(g, fault));
  if (!cdem_case_is_triaxial(&g->run->cases))
    return cdem_run_grains_walls(g, checkpoint, fault);
  CDEM_TRY(cdem_run_grains_triaxial(g, fault));
  return check_membrane(g, checkpoint, fault);
}

cdem_status cdem_run_grains_build(cdem_run_grains *g, const cdem_state *checkpoint,
                                  cdem_fault *fault) {
  CDEM_TRY(cdem_run_grains_surround(g, checkpoint, fault));
  CDEM_TRY(cdem_run_grains_cell(g, fault));
  CDEM_TRY(cdem_run_grains_bonds(g, fault));
  CDEM_TRY(cdem_run_grains_solver(g, fault));
  CDEM_TRY(cdem_run_grains_pictures_init(g, fault));
  CDEM_NEW(g->velocity, 3 * g->grains.grains, fault);
  return CDEM_OK;
}

static cdem_status build(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  cdem_run_grains *g;
  CDEM_TRY(cdem_run_grains_create(run, checkpoint, &g, fault));
  return cdem_run_grains_build(g, checkpoint, fault);
}

static void release(cdem_run_setup *run) {
  cdem_run_grains *g = grains_of(run);
  if (g == NULL)
    return;
  cdem_dem_release(&g->dem);
  cdem_grains_release(&g->grains);
  for (int w = 0; g->facets != NULL && w < g->walls; w++) {
    free(g->facets[w].corner);
    free(g->facets[w].facet);
  }
  free(g->facets);
  free(g->wall);
  free(g->case_material);
  free(g->used);
  free(g->model_of);
  free(g->of_grains);
  free(g->material);
  free(g->contact);
  free(g->contact_entry);
  free(g->bond_law);
  free(g->bond);
  free(g->velocity);
  free(g->bands);
  cdem_strain_reference_destroy(&g->strain);
  free(g);
  run->context = NULL;
}

static cdem_status save_facets(const cdem_run_grains *g, cdem_state *state, cdem_fault *fault) {
  char name[64];
  for (int w = 0; w < g->walls; w++) {
    const cdem_run_facets *facets = &g->facets[w];
    if (facets->facets == 0)
      continue;
    snprintf(name, sizeof name, "walls/%d/corner", w);
    CDEM_TRY(
        cdem_state_add(state, name, CDEM_ARRAY_REAL, 3 * facets->corners, facets->corner, fault));
    snprintf(name, sizeof name, "walls/%d/facet", w);
    CDEM_TRY(cdem_state_add(state, name, CDEM_ARRAY_INT32, g->dim * facets->facets, facets->facet,
                            fault));
  }
  return CDEM_OK;
}

static cdem_status save(const cdem_run_setup *run, cdem_state *state, cdem_fault *fault) {
  const cdem_run_grains *g = grains_of(run);
  CDEM_TRY(cdem_run_grains_save(g, state, fault));
  CDEM_TRY(save_facets(g, state, fault));
  if (g->has_triaxial)
    CDEM_TRY(cdem_run_triaxial_save(&g->triaxial, state, fault));
  return cdem_dem_save(&g->dem, state, fault);
}

static cdem_status restore(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  cdem_run_grains *g = grains_of(run);
  if (g->has_triaxial)
    CDEM_TRY(cdem_run_triaxial_restore(&g->triaxial, checkpoint, fault));
  return cdem_dem_restore(&g->dem, checkpoint, fault);
}

/* ---- on its way ---- */

static void now(const cdem_run_setup *run, cdem_run_now *at) {
  const cdem_dem *dem = &grains_of(run)->dem;
  *at = (cdem_run_now){.time = dem->time, .step = dem->step, .steps = dem->steps};
}

static cdem_status advance(cdem_run_setup *run, int64_t steps, cdem_fault *fault) {
  return cdem_run_grains_advance(grains_of(run), steps, fault);
}

/* Without a contact there is nothing that could be balanced. */
static double unbalanced(const cdem_run_setup *run) {
  double ratio = cdem_dem_unbalanced(&grains_of(run)->dem);
  return ratio > 0.0 ? ratio : INFINITY;
}

static cdem_status frames(cdem_run_setup *run, int64_t index, const cdem_frame_sink *sink,
                          cdem_fault *fault) {
  return cdem_run_grains_frames(grains_of(run), NULL, index, sink, fault);
}

/* ---- sizes ---- */

static cdem_status sizes(const cdem_run_setup *run, cdem_run_summary *summary, cdem_fault *fault) {
  const cdem_run_grains *g = grains_of(run);
  cdem_dem_contact *contact = NULL;
  summary->grains = g->grains.grains;
  summary->walls = g->walls;
  summary->bonds = g->bonds;
  summary->solid = cdem_grains_solid(&g->grains);
  CDEM_TRY(cdem_dem_contacts(&g->dem, &summary->contacts, &contact, fault));
  free(contact);
  return CDEM_OK;
}

static void put_sizes(cdem_json *json, const cdem_run_summary *summary) {
  double work = (double)summary->grains * (double)summary->steps;
  work *= summary->cycles > 0 ? summary->cycles : 1; /* of a coupled run */
  cdem_json_integer(json, "grains", summary->grains);
  cdem_json_real(json, "solid", summary->solid);
  cdem_json_integer(json, "contacts", summary->contacts);
  cdem_json_integer(json, "walls", summary->walls);
  cdem_json_integer(json, "bonds", summary->bonds);
  cdem_json_real(json, "grain_steps_per_second", summary->wall > 0.0 ? work / summary->wall : 0.0);
}

const cdem_run_engine cdem_run_engine_grains = {
    .name = "grains",
    .strides = true,
    .row_every = 1000,
    .look_every = 200,
    .energies = {{"stored",
                  {"translation", "rotation", "normal", "shear", "moment", "bond", "membrane"}},
                 {"dissipated", {"friction", "rolling", "damping", "broken"}},
                 {"work done", {"gravity", "walls", "cell", "circulating", "pressure"}}},
    .build = build,
    .release = release,
    .save = save,
    .restore = restore,
    .now = now,
    .advance = advance,
    .look = cdem_run_grains_look,
    .unbalanced = unbalanced,
    .frames = frames,
    .columns = cdem_run_grains_columns,
    .sizes = sizes,
    .put_sizes = put_sizes,
    .pictures = cdem_run_grains_pictures};
