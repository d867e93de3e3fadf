/* The engine of grains that deform. */
#include "run/deformable.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- from the case to the solver ---- */

static cdem_status build(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  cdem_run_deformable *d = cdem_allocate(1, sizeof *d, fault);
  if (d == NULL)
    return CDEM_MEMORY;
  d->run = run;
  run->context = d;
  cdem_status status = cdem_run_grains_create(run, checkpoint, &d->grains, fault);
  run->context = d;
  CDEM_TRY(status);
  CDEM_NEW(d->velocity, 3 * d->grains->grains.grains, fault);
  CDEM_TRY(cdem_run_grains_surround(d->grains, checkpoint, fault));
  return cdem_run_deformable_solver(d, fault);
}

static void release(cdem_run_setup *run) {
  cdem_run_deformable *d = cdem_run_deformable_of(run);
  if (d == NULL)
    return;
  cdem_fdem_release(&d->fdem);
  for (int s = 0; d->shape != NULL && s < d->shapes; s++)
    cdem_template_release(&d->shape[s]);
  free(d->shape);
  free(d->shape_of);
  free(d->orientation);
  free(d->density);
  free(d->law);
  free(d->velocity);
  run->context = d->grains;
  if (d->grains != NULL)
    cdem_run_engine_grains.release(run);
  free(d);
  run->context = NULL;
}

static cdem_status save(const cdem_run_setup *run, cdem_state *state, cdem_fault *fault) {
  const cdem_run_deformable *d = cdem_run_deformable_of(run);
  CDEM_TRY(cdem_run_grains_save(d->grains, state, fault));
  if (d->grains->has_triaxial)
    CDEM_TRY(cdem_run_triaxial_save(&d->grains->triaxial, state, fault));
  return cdem_fdem_save(&d->fdem, state, fault);
}

static cdem_status restore(cdem_run_setup *run, const cdem_state *checkpoint, cdem_fault *fault) {
  cdem_run_deformable *d = cdem_run_deformable_of(run);
  if (d->grains->has_triaxial)
    CDEM_TRY(cdem_run_triaxial_restore(&d->grains->triaxial, checkpoint, fault));
  return cdem_fdem_restore(&d->fdem, checkpoint, fault);
}

/* ---- on its way ---- */

static void now(const cdem_run_setup *run, cdem_run_now *at) {
  const cdem_fdem *fdem = &cdem_run_deformable_of(run)->fdem;
  *at = (cdem_run_now){.time = fdem->time, .step = fdem->step, .steps = fdem->steps};
}

static cdem_status advance(cdem_run_setup *run, int64_t steps, cdem_fault *fault) {
  return cdem_run_deformable_advance(cdem_run_deformable_of(run), steps, fault);
}

static cdem_status look(cdem_run_setup *run, cdem_fault *fault) {
  cdem_fdem *fdem = &cdem_run_deformable_of(run)->fdem;
  CDEM_TRY(cdem_run_check_stable(run, cdem_fdem_limit(fdem), run->limiter, fault));
  cdem_fdem_follow(fdem);
  return CDEM_OK;
}

/* Largest force on a grain by the mean push of a contact. */
static double unbalanced(const cdem_run_setup *run) {
  const cdem_run_deformable *d = cdem_run_deformable_of(run);
  cdem_dem_contact *contact = NULL;
  int64_t contacts = 0;
  double sum = 0.0, most = 0.0;
  const cdem_fdem_view view = {.force = d->velocity};
  if (cdem_run_deformable_contacts(d, &contacts, &contact, NULL) != CDEM_OK || contacts == 0) {
    free(contact);
    return INFINITY;
  }
  for (int64_t k = 0; k < contacts; k++)
    sum += contact[k].push;
  free(contact);
  cdem_fdem_look(&d->fdem, &view);
  const double *gravity = cdem_run_deformable_values(d)->gravity;
  for (int64_t i = 0; i < d->grains->grains.grains; i++) {
    double force[3], mass = cdem_fdem_mass(&d->fdem, i);
    for (int c = 0; c < 3; c++)
      force[c] = d->velocity[3 * i + c] + mass * gravity[c];
    most = fmax(most, cdem_norm3(force));
  }
  return most * (double)contacts / sum;
}

/* ---- sizes ---- */

static cdem_status sizes(const cdem_run_setup *run, cdem_run_summary *summary, cdem_fault *fault) {
  const cdem_run_deformable *d = cdem_run_deformable_of(run);
  cdem_dem_contact *contact = NULL;
  summary->grains = d->grains->grains.grains;
  summary->walls = d->grains->walls;
  summary->solid = cdem_grains_solid(&d->grains->grains);
  CDEM_TRY(cdem_run_deformable_contacts(d, &summary->contacts, &contact, fault));
  free(contact);
  summary->nodes = summary->elements = 0;
  for (int64_t i = 0; i < summary->grains; i++) {
    const cdem_template *shape = &d->shape[d->shape_of[i]];
    summary->nodes += shape->nodes;
    summary->elements += shape->mesh.cells;
  }
  return CDEM_OK;
}

static void put_sizes(cdem_json *json, const cdem_run_summary *summary) {
  cdem_run_engine_grains.put_sizes(json, summary);
  cdem_json_integer(json, "nodes", summary->nodes);
  cdem_json_integer(json, "elements", summary->elements);
}

/* The distribution of forces; frames show grains better than a picture could. */
static cdem_status pictures(cdem_run_setup *run, const char *folder, const char *tag,
                            cdem_fault *fault) {
  const cdem_run_deformable *d = cdem_run_deformable_of(run);
  const char *title = cdem_run_deformable_values(d)->title;
  cdem_cluster_contacts clusters;
  char name[96];
  CDEM_TRY(cdem_run_deformable_pushes(d, &clusters, fault));
  cdem_status status =
      cdem_run_pushes(clusters.contacts, clusters.contact, title != NULL ? title : "", folder,
                      cdem_run_picture_file(name, CDEM_RUN_PUSHES, tag), fault);
  cdem_cluster_contacts_release(&clusters);
  return status;
}

const cdem_run_engine cdem_run_engine_deformable = {
    .name = "deformable",
    .strides = true,
    .row_every = 1000,
    .look_every = 200,
    .follow_every = 250,
    .energies = {{"stored",
                  {"translation", "rotation", "vibration", "elastic", "normal", "shear",
                   "membrane"}},
                 {"dissipated", {"friction", "damping", "numerical"}},
                 {"work done", {"gravity", "walls", "pressure"}}},
    .build = build,
    .release = release,
    .save = save,
    .restore = restore,
    .now = now,
    .advance = advance,
    .look = look,
    .unbalanced = unbalanced,
    .frames = cdem_run_deformable_frames,
    .columns = cdem_run_deformable_columns,
    .sizes = sizes,
    .put_sizes = put_sizes,
    .pictures = pictures};
