/* Grains at the start: from a table, a packing, or the checkpoint of a broken run; and how they
 * move then. */
#include "dem/packing.h"
#include "io/case_file.h"
#include "io/grains_file.h"
#include "run/grains.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int cdem_run_grains_material(const cdem_run_grains *g, const char *name) {
  const cdem_case_grains *wanted = &cdem_run_grains_values(g)->grains;
  for (int64_t m = 0; name != NULL && m < wanted->materials.count; m++)
    if (strcmp(wanted->materials.item[m].name, name) == 0)
      return (int)m;
  return 0;
}

/* ---- packings ---- */

static cdem_status fill_sizes(const cdem_case_packing *wanted, cdem_sizes *sizes, double **classes,
                              cdem_fault *fault) {
  int entries = (int)wanted->classes.count;
  *sizes = (cdem_sizes){.kind = (cdem_size_kind)wanted->sizes};
  sizes->radius = isnan(wanted->radius) ? 0.0 : wanted->radius;
  sizes->least = isnan(wanted->least) ? 0.0 : wanted->least;
  sizes->most = isnan(wanted->most) ? 0.0 : wanted->most;
  sizes->exponent = isnan(wanted->exponent) ? 0.0 : wanted->exponent;
  sizes->spread = isnan(wanted->spread) ? 0.0 : wanted->spread;
  CDEM_NEW(*classes, 2 * (int64_t)entries, fault);
  for (int i = 0; i < entries; i++) {
    (*classes)[i] = wanted->classes.item[i].radius;
    (*classes)[entries + i] = wanted->classes.item[i].fraction;
  }
  sizes->entries = entries;
  sizes->class_radius = *classes;
  sizes->class_fraction = *classes + entries;
  return CDEM_OK;
}

/* Faces through which a packing continues itself: as told, else those of the cell, where the
 * packing can. */
static void fill_periodic(const cdem_run_grains *g, const cdem_packing *packing, bool periodic[3]) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  const cdem_case *cases = &g->run->cases;
  bool told = cdem_case_given(cases, "grains.packing.periodic");
  bool cell = cdem_case_given(cases, "cell") && packing->loose;
  for (int k = 0; k < 3; k++) {
    bool all = v->cell.periodic.count == 0 && k < g->dim;
    periodic[k] = told ? cdem_case_names_direction(&v->grains.packing.periodic, k)
                       : cell && (all || cdem_case_names_direction(&v->cell.periodic, k));
  }
}

/* `compact`, as the packing wants it. */
static cdem_compaction compaction_of(const cdem_run_grains *g,
                                     const cdem_packing_options *options) {
  const cdem_case_grains *grains = &cdem_run_grains_values(g)->grains;
  const cdem_case_compact *wanted = &grains->packing.compact;
  int usual = cdem_run_grains_material(g, grains->material);
  double density = usual >= 0 ? grains->materials.item[usual].density : NAN;
  cdem_compaction compaction = {.fraction = isnan(wanted->fraction) ? 0.0 : wanted->fraction,
                                .pressure = isnan(wanted->pressure) ? 0.0 : wanted->pressure,
                                .height = isnan(wanted->height) ? 0.0 : wanted->height,
                                .thickness = cdem_run_grains_values(g)->thickness,
                                .stiffness = isnan(wanted->stiffness) ? 0.0 : wanted->stiffness,
                                .density = isnan(density) ? 0.0 : density,
                                .friction = wanted->friction,
                                .restitution = wanted->restitution,
                                .threads = cdem_run_grains_threads(g),
                                .progress = options->progress};
  memcpy(compaction.periodic, options->periodic, sizeof compaction.periodic);
  return compaction;
}

static cdem_status press(cdem_run_grains *g, const cdem_packing_options *options,
                         const cdem_compaction *compaction, cdem_fault *fault) {
  cdem_compacted reached = {0};
  cdem_status status = cdem_packing_compact(options, compaction, &g->grains, &reached, fault);
  if (status != CDEM_OK)
    return status == CDEM_INPUT || status == CDEM_NUMERIC
               ? cdem_case_blame(&g->run->cases, "grains.packing.compact", fault)
               : status;
  memcpy(g->low, reached.low, sizeof g->low);
  memcpy(g->high, reached.high, sizeof g->high);
  return CDEM_OK;
}

static cdem_status pack(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_packing *wanted = &cdem_run_grains_values(g)->grains.packing;
  const cdem_packing *packing = cdem_packing_at(wanted->kind);
  cdem_packing_options options = {.dim = g->dim,
                                  .centres_inside = wanted->centres_inside,
                                  .cylinder = wanted->cylinder,
                                  .count = wanted->count,
                                  .fraction = isnan(wanted->fraction) ? 0.0 : wanted->fraction,
                                  .seed = (uint64_t)wanted->seed,
                                  .progress = g->run->options->progress};
  double *classes = NULL;
  memcpy(options.low, wanted->low, sizeof options.low);
  memcpy(options.high, wanted->high, sizeof options.high);
  memcpy(g->low, wanted->low, sizeof g->low);
  memcpy(g->high, wanted->high, sizeof g->high);
  fill_periodic(g, packing, options.periodic);
  bool pressed = cdem_case_given(&g->run->cases, "grains.packing.compact");
  cdem_status status = fill_sizes(wanted, &options.sizes, &classes, fault);
  const cdem_compaction compaction = compaction_of(g, &options);
  if (status == CDEM_OK && pressed)
    cdem_packing_make_room(&options, &compaction);
  if (status == CDEM_OK)
    status = cdem_packing_make(packing, &options, &g->grains, fault);
  if (status == CDEM_INPUT || status == CDEM_NUMERIC)
    status = cdem_case_blame(&g->run->cases, "grains.packing", fault);
  if (status == CDEM_OK && pressed)
    status = press(g, &options, &compaction, fault);
  free(classes);
  return status;
}

/* ---- tables ---- */

/* Names of the table's materials are those of the case. */
static cdem_status name_table(cdem_run_grains *g, const cdem_grain_table *table,
                              cdem_fault *fault) {
  const cdem_case_grains *wanted = &cdem_run_grains_values(g)->grains;
  for (int64_t i = 0; g->grains.material != NULL && i < g->grains.grains; i++) {
    const char *name = table->name[g->grains.material[i]];
    int at = cdem_run_grains_material(g, name);
    if (strcmp(wanted->materials.item[at].name, name) != 0)
      return cdem_case_fail(&g->run->cases, "grains.file", CDEM_INPUT, fault,
                            "grain %lld of '%s' is of material '%s', which is not among "
                            "grains.materials",
                            (long long)i, wanted->file, name);
    g->grains.material[i] = at;
  }
  return CDEM_OK;
}

static cdem_status read_table(cdem_run_grains *g, cdem_fault *fault) {
  const char *file = cdem_run_grains_values(g)->grains.file;
  cdem_grain_table table = {0};
  char *path = cdem_case_file_path(&g->run->cases, file, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = cdem_read_grains(path, g->dim, &table, fault);
  free(path);
  if (status == CDEM_INPUT || status == CDEM_FILE)
    status = cdem_case_blame(&g->run->cases, "grains.file", fault);
  if (status == CDEM_OK) {
    g->grains = table.grains;
    table.grains = (cdem_grains){0};
    status = name_table(g, &table, fault);
  }
  cdem_grain_table_release(&table);
  if (status == CDEM_OK)
    cdem_grains_box(&g->grains, g->low, g->high);
  return status;
}

/* ---- materials and motion ---- */

static cdem_status complete(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_grains *wanted = &cdem_run_grains_values(g)->grains;
  bool named = g->grains.material != NULL;
  int usual = cdem_run_grains_material(g, wanted->material);
  CDEM_TRY(cdem_grains_complete(&g->grains, fault));
  CDEM_NEW(g->case_material, g->grains.grains, fault);
  for (int64_t i = 0; i < g->grains.grains; i++) {
    g->case_material[i] = named ? g->grains.material[i] : usual;
    if (g->case_material[i] < 0 || g->case_material[i] >= wanted->materials.count)
      return cdem_case_fail(&g->run->cases, "grains.file", CDEM_INPUT, fault,
                            "grain %lld has material %d; grains.materials has %d, counted from 0",
                            (long long)i, (int)g->case_material[i], (int)wanted->materials.count);
  }
  return CDEM_OK;
}

/* Entries of `initial` are added to what the table says: a motion of all as one rigid body. */
static void set_in_motion(cdem_run_grains *g) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  for (int64_t e = 0; e < v->initial.count; e++) {
    const cdem_case_initial *initial = &v->initial.item[e];
    for (int64_t i = 0; i < g->grains.grains; i++) {
      double arm[3], turning[3];
      for (int k = 0; k < 3; k++)
        arm[k] = g->grains.xyz[3 * i + k] - initial->center[k];
      cdem_cross3(initial->spin, arm, turning);
      for (int k = 0; k < 3; k++) {
        g->grains.velocity[3 * i + k] += k < g->dim ? initial->velocity[k] + turning[k] : 0.0;
        g->grains.spin[3 * i + k] += g->dim == 3 || k == 2 ? initial->spin[k] : 0.0;
      }
    }
  }
}

/* ---- checkpoints ---- */

static cdem_status check_restored(const cdem_run_grains *g, cdem_fault *fault) {
  int64_t materials = cdem_run_grains_values(g)->grains.materials.count;
  CDEM_TRY(cdem_grains_check(&g->grains, fault));
  for (int64_t i = 0; i < g->grains.grains; i++)
    CDEM_REQUIRE(g->case_material[i] >= 0 && g->case_material[i] < materials, fault, CDEM_INPUT,
                 "grain %lld has material %d; grains.materials has %d, counted from 0",
                 (long long)i, (int)g->case_material[i], (int)materials);
  return CDEM_OK;
}

static cdem_status restore(cdem_run_grains *g, const cdem_state *state, cdem_fault *fault) {
  cdem_grains *grains = &g->grains;
  int64_t count = 0;
  double box[6];
  grains->dim = g->dim;
  CDEM_TRY(
      cdem_state_take(state, "grains/radius", CDEM_ARRAY_REAL, &count, &grains->radius, fault));
  grains->grains = count;
  CDEM_TRY(cdem_state_take(state, "grains/xyz", CDEM_ARRAY_REAL, &count, &grains->xyz, fault));
  CDEM_REQUIRE(count == 3 * grains->grains, fault, CDEM_INPUT,
               "the checkpoint has %lld grains at %lld numbers of place", (long long)grains->grains,
               (long long)count);
  CDEM_TRY(cdem_grains_complete(grains, fault));
  CDEM_NEW(g->case_material, grains->grains, fault);
  CDEM_TRY(cdem_state_get(state, "grains/velocity", CDEM_ARRAY_REAL, 3 * grains->grains,
                          grains->velocity, fault));
  CDEM_TRY(cdem_state_get(state, "grains/spin", CDEM_ARRAY_REAL, 3 * grains->grains, grains->spin,
                          fault));
  CDEM_TRY(cdem_state_get(state, "grains/motion", CDEM_ARRAY_BYTE, grains->grains, grains->motion,
                          fault));
  CDEM_TRY(cdem_state_get(state, "grains/material", CDEM_ARRAY_INT32, grains->grains,
                          g->case_material, fault));
  CDEM_TRY(cdem_state_get(state, "grains/box", CDEM_ARRAY_REAL, 6, box, fault));
  memcpy(g->low, box, sizeof g->low);
  memcpy(g->high, box + 3, sizeof g->high);
  cdem_status status = check_restored(g, fault);
  if (status == CDEM_INPUT)
    cdem_fault_prefix(fault, "the checkpoint does not belong to this case");
  return status;
}

cdem_status cdem_run_grains_save(const cdem_run_grains *g, cdem_state *state, cdem_fault *fault) {
  const cdem_grains *grains = &g->grains;
  int64_t n = grains->grains;
  double box[6];
  memcpy(box, g->low, sizeof g->low);
  memcpy(box + 3, g->high, sizeof g->high);
  CDEM_TRY(cdem_state_add(state, "grains/xyz", CDEM_ARRAY_REAL, 3 * n, grains->xyz, fault));
  CDEM_TRY(cdem_state_add(state, "grains/radius", CDEM_ARRAY_REAL, n, grains->radius, fault));
  CDEM_TRY(
      cdem_state_add(state, "grains/velocity", CDEM_ARRAY_REAL, 3 * n, grains->velocity, fault));
  CDEM_TRY(cdem_state_add(state, "grains/spin", CDEM_ARRAY_REAL, 3 * n, grains->spin, fault));
  CDEM_TRY(cdem_state_add(state, "grains/motion", CDEM_ARRAY_BYTE, n, grains->motion, fault));
  CDEM_TRY(cdem_state_add(state, "grains/material", CDEM_ARRAY_INT32, n, g->case_material, fault));
  return cdem_state_add_copy(state, "grains/box", CDEM_ARRAY_REAL, 6, box, fault);
}

/* ---- all ---- */

static void sum_grains(cdem_run_grains *g) {
  size_t n = (size_t)g->grains.grains;
  uint64_t sum = cdem_run_checksum(CDEM_RUN_SUM_START, g->grains.xyz, 3 * n * sizeof(double));
  sum = cdem_run_checksum(sum, g->grains.radius, n * sizeof(double));
  g->run->input_sum = cdem_run_checksum(sum, g->case_material, n * sizeof *g->case_material);
}

cdem_status cdem_run_grains_start(cdem_run_grains *g, const cdem_state *checkpoint,
                                  cdem_fault *fault) {
  const cdem_progress *progress = g->run->options->progress;
  bool table = cdem_run_grains_values(g)->grains.file != NULL;
  g->grains.dim = g->dim;
  if (checkpoint != NULL) {
    CDEM_TRY(restore(g, checkpoint, fault));
  } else {
    CDEM_TRY(cdem_progress_report(progress, table ? "reading the grains" : "packing", 0, 0, fault));
    CDEM_TRY(table ? read_table(g, fault) : pack(g, fault));
    cdem_status status = cdem_grains_check(&g->grains, fault);
    if (status == CDEM_INPUT)
      return cdem_case_blame(&g->run->cases, table ? "grains.file" : "grains.packing", fault);
    CDEM_TRY(status);
    CDEM_TRY(complete(g, fault));
    set_in_motion(g);
  }
  sum_grains(g);
  return CDEM_OK;
}
