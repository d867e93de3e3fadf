#include "run/export.h"

#include "io/grains_file.h"
#include "io/grains_scene.h"
#include "io/run_files.h"
#include "run/grains.h"
#include "run/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static cdem_status write_all(const cdem_export_options *options, const cdem_scene *scene,
                             cdem_export_summary *summary, cdem_fault *fault) {
  summary->dim = scene->grains.dim;
  summary->grains = scene->grains.grains;
  for (int i = 0; i < options->outputs; i++)
    CDEM_TRY(cdem_write_scene(options->output[i], scene, summary->lost[i], fault));
  return CDEM_OK;
}

/* ---- a table ---- */

static cdem_status check_density(const cdem_export_options *options, cdem_fault *fault) {
  for (int i = 0; i < options->outputs; i++) {
    const cdem_grain_format *format = cdem_grain_format_of(options->output[i]);
    CDEM_REQUIRE(!isnan(options->density) || format == NULL || !format->masses, fault, CDEM_INPUT,
                 "cannot write '%s': grains have masses there, and the table '%s' has none; give "
                 "--density",
                 options->output[i], options->path);
  }
  return CDEM_OK;
}

static cdem_status of_table(const cdem_export_options *options, cdem_export_summary *summary,
                            cdem_fault *fault) {
  cdem_grain_table table = {0};
  cdem_grain_material *material = NULL;
  CDEM_TRY(check_density(options, fault));
  CDEM_TRY(cdem_read_grains(options->path, 0, &table, fault));
  int materials = table.names > 0 ? (int)table.names : 1;
  cdem_status status = cdem_grains_complete(&table.grains, fault);
  if (status == CDEM_OK) {
    material = cdem_allocate(materials, sizeof *material, fault);
    status = material != NULL ? CDEM_OK : CDEM_MEMORY;
  }
  for (int m = 0; status == CDEM_OK && m < materials; m++) {
    material[m] = (cdem_grain_material){.density = options->density};
    snprintf(material[m].name, sizeof material[m].name, "%.63s",
             table.names > 0 ? table.name[m] : "grains");
  }
  const cdem_scene scene = {.grains = table.grains,
                            .materials = materials,
                            .material = material,
                            .thickness = options->thickness};
  summary->time = NAN;
  if (status == CDEM_OK)
    status = write_all(options, &scene, summary, fault);
  free(material);
  cdem_grain_table_release(&table);
  return status;
}

/* ---- a case, or the folder of a run ---- */

static cdem_status write_grains(const cdem_export_options *options, const cdem_run_setup *setup,
                                cdem_export_summary *summary, cdem_fault *fault) {
  const cdem_run_grains *g = setup->context;
  const cdem_dem_options *model = cdem_dem_options_of(&g->dem);
  cdem_grains now = {0};
  CDEM_TRY(cdem_grains_copy(&g->grains, &now, fault));
  cdem_dem_look(&g->dem,
                &(cdem_dem_view){.xyz = now.xyz, .velocity = now.velocity, .spin = now.spin});
  const cdem_scene scene = {.grains = now,
                            .materials = g->materials,
                            .material = g->material,
                            .thickness = model->thickness > 0.0 ? model->thickness : 1.0,
                            .dem = &g->dem};
  summary->time = g->dem.time;
  cdem_status status = write_all(options, &scene, summary, fault);
  cdem_grains_release(&now);
  return status;
}

static cdem_status of_case(const cdem_export_options *options, bool folder,
                           cdem_export_summary *summary, cdem_fault *fault) {
  const cdem_run_options run = {.path = folder ? NULL : options->path,
                                .folder = folder ? options->path : NULL,
                                .resume = folder,
                                .check = !folder,
                                .threads = options->threads,
                                .warnings = options->warnings};
  cdem_run_setup setup = {0};
  cdem_state checkpoint = {0};
  char path[4096];
  cdem_status status = CDEM_OK;
  if (folder) {
    cdem_run_path(path, options->path, "checkpoint.h5");
    CDEM_REQUIRE(access(path, F_OK) == 0, fault, CDEM_INPUT,
                 "there is no run in '%s': it has no checkpoint.h5", options->path);
    status = cdem_read_state(path, &checkpoint, fault);
  }
  if (status == CDEM_OK)
    status = cdem_run_setup_init(&run, folder ? &checkpoint : NULL, &setup, fault);
  if (status == CDEM_OK && setup.engine != &cdem_run_engine_grains)
    status = cdem_fail(fault, CDEM_INPUT,
                       "'%s' is a case of engine '%s'; grains are exported of cases that have "
                       "nothing else",
                       options->path, setup.engine->name);
  if (status == CDEM_OK && folder)
    status = setup.engine->restore(&setup, &checkpoint, fault);
  if (status == CDEM_OK)
    status = write_grains(options, &setup, summary, fault);
  cdem_run_setup_release(&setup);
  cdem_state_release(&checkpoint);
  return status;
}

cdem_status cdem_export(const cdem_export_options *options, cdem_export_summary *summary,
                        cdem_fault *fault) {
  struct stat found;
  bool folder = stat(options->path, &found) == 0 && S_ISDIR(found.st_mode);
  *summary = (cdem_export_summary){0};
  for (int i = 0; i < options->outputs; i++)
    CDEM_REQUIRE(cdem_grain_format_of(options->output[i]) != NULL, fault, CDEM_INPUT,
                 "the ending of '%s' names no file of grains; see `cdem list formats`",
                 options->output[i]);
  const cdem_grain_format *format = cdem_grain_format_of(options->path);
  if (!folder && format != NULL && strcmp(format->name, "csv") == 0)
    return of_table(options, summary, fault);
  return of_case(options, folder, summary, fault);
}
