/* The foundation of Li & Wan (2010), section 3, in its versions: whole runs of the shipped case.
 *
 * Several checks look at one run, and some runs take half a minute: what a run gave is kept for the
 * life of the process. */
#include "base/memory.h"
#include "io/io.h"
#include "io/run_files.h"
#include "run/run.h"
#include "verify/bsm.h"
#include "verify/foundation_case.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_OVERRIDES = 10, KEPT = 40 };

/* What is asked of a run. Means are those of the last two milliseconds. */
typedef struct {
  double load, peak, place; /* N; largest load after the first 10 ms; displacement there, m */
  double volumetric_strain, effective_strain, volumetric_stress, effective_stress;
  double stress_scatter; /* standard deviation of the last one in these milliseconds */
  double error;          /* of the energy book, largest of all rows */
  double growth; /* kinetic energy of the coarse medium at the end over its largest in the first
                    half */
} outcome;

static struct {
  char key[400];
  outcome got;
} kept[KEPT];
static int kept_count;

/* ---- one run ---- */

typedef struct {
  const cdem_table *table;
  int64_t from;
} window;

static double at(const cdem_table *table, int64_t row, const char *name) {
  int column = cdem_table_find(table, name);
  if (column < 0)
    return NAN;
  const cdem_value *value = cdem_table_at(table, row, column);
  return value->absent ? NAN : value->real;
}

static double mean(const window *w, const char *name) {
  double sum = 0.0;
  for (int64_t r = w->from; r < w->table->rows; r++)
    sum += at(w->table, r, name) / (double)(w->table->rows - w->from);
  return sum;
}

static double scatter(const window *w, const char *name) {
  double middle = mean(w, name), sum = 0.0;
  int64_t rows = w->table->rows - w->from;
  for (int64_t r = w->from; r < w->table->rows; r++)
    sum += (at(w->table, r, name) - middle) * (at(w->table, r, name) - middle);
  return rows > 1 ? sqrt(sum / (double)(rows - 1)) : NAN;
}

static outcome look(const cdem_table *t) {
  outcome o = {.peak = -INFINITY};
  double end = at(t, t->rows - 1, "time"), early = 0.0;
  window w = {t, t->rows - 1};
  while (w.from > 0 && at(t, w.from - 1, "time") > end - 2.0e-3 - 1e-9)
    w.from--;
  for (int64_t r = 0; r < t->rows; r++) {
    double load = at(t, r, "load.plate.fy"), time = at(t, r, "time");
    o.error = fmax(o.error, at(t, r, "energy_error"));
    if (time < 0.5 * end)
      early = fmax(early, at(t, r, "coarse.kinetic"));
    if (time < 10e-3 || !(load > o.peak))
      continue;
    o.peak = load;
    o.place = fabs(at(t, r, "load.plate.moved_y"));
  }
  o.load = mean(&w, "load.plate.fy");
  o.volumetric_strain = mean(&w, "region.volumetric_strain");
  o.effective_strain = mean(&w, "region.effective_strain");
  o.volumetric_stress = mean(&w, "region.volumetric_stress");
  o.effective_stress = mean(&w, "region.effective_stress");
  o.stress_scatter = scatter(&w, "region.effective_stress");
  o.growth = early > 0.0 ? mean(&w, "coarse.kinetic") / early : 0.0;
  return o;
}

static cdem_status write_case(const char *path, cdem_fault *fault) {
  cdem_output *file = NULL;
  CDEM_TRY(cdem_output_open(path, &file, fault));
  cdem_status status = cdem_output_write(file, foundation_case, sizeof foundation_case - 1, fault);
  if (status == CDEM_OK)
    status = cdem_output_commit(&file, fault);
  cdem_output_discard(&file);
  return status;
}

static cdem_status run_case(int count, const char *const *override, outcome *o, cdem_fault *fault) {
  char scratch[64], path[160], folder[128];
  cdem_run_summary summary = {0};
  cdem_table history = {0};
  CDEM_TRY(cdem_make_scratch(scratch, fault));
  snprintf(path, sizeof path, "%s/foundation.yaml", scratch);
  snprintf(folder, sizeof folder, "%s/run", scratch);
  const cdem_run_options options = {
      .path = path, .folder = folder, .overrides = count, .override = override};
  cdem_status status = write_case(path, fault);
  if (status == CDEM_OK)
    status = cdem_run(&options, &summary, fault);
  snprintf(path, sizeof path, "%s/history.csv", folder);
  if (status == CDEM_OK)
    status = cdem_read_history(path, &history, fault);
  if (status == CDEM_OK)
    *o = look(&history);
  cdem_table_release(&history);
  cdem_run_summary_release(&summary);
  cdem_remove_scratch(scratch);
  return status;
}

/* The same once more is not run again. */
static cdem_status run_once(int count, const char *const *override, outcome *o, cdem_fault *fault) {
  char key[sizeof kept[0].key] = "";
  for (int i = 0; i < count; i++) {
    size_t used = strlen(key);
    snprintf(key + used, sizeof key - used, "%s;", override[i]);
  }
  for (int i = 0; i < kept_count; i++)
    if (strcmp(kept[i].key, key) == 0) {
      *o = kept[i].got;
      return CDEM_OK;
    }
  CDEM_TRY(run_case(count, override, o, fault));
  if (kept_count < KEPT) {
    memcpy(kept[kept_count].key, key, sizeof key);
    kept[kept_count++].got = *o;
  }
  return CDEM_OK;
}

/* ---- the foundation ---- */

typedef enum { COUPLED, FROZEN, GRAINS } version;
static const char *const version_name[] = {"coupling.version=coupled", "coupling.version=frozen",
                                           "coupling.version=grains"};

typedef enum {
  LOAD,
  PEAK,
  PLACE,
  EFFECTIVE,
  VOLUMETRIC,
  VOLUMETRIC_STRESS,
  EFFECTIVE_STRESS
} look_at;

static double number(const outcome *o, look_at what) {
  const double of[] = {o->load,
                       o->peak,
                       o->place,
                       o->effective_strain,
                       o->volumetric_strain,
                       o->volumetric_stress,
                       o->effective_stress};
  return of[what];
}

static cdem_status foundation(version v, int damping, outcome *o, cdem_fault *fault) {
  char damped[64];
  snprintf(damped, sizeof damped, "mass_damping=%d 1/s", damping);
  const char *const override[] = {version_name[v], damped};
  return run_once(2, override, o, fault);
}

/* parameter: 1000 times look_at + damping. Coupled against grains everywhere, relative; the place
 * of the peak in m. */
cdem_status cdem_bsm_measure_foundation(int parameter, double *value, cdem_fault *fault) {
  outcome coupled, grains;
  int damping = parameter % 1000;
  look_at what = (look_at)(parameter / 1000);
  CDEM_TRY(foundation(GRAINS, damping, &grains, fault));
  CDEM_TRY(foundation(COUPLED, damping, &coupled, fault));
  double a = number(&coupled, what), b = number(&grains, what);
  *value = what == PLACE ? a - b : (a - b) / fabs(b);
  if (what == EFFECTIVE_STRESS) /* of single discs: it jumps by a tenth from one row to the next */
    *value = (a - b) / hypot(coupled.stress_scatter, grains.stress_scatter);
  return CDEM_OK;
}

/* Load at 60 mm over its peak: 0 A, 1 B, 2 C, coupled. */
cdem_status cdem_bsm_measure_softening(int parameter, double *value, cdem_fault *fault) {
  static const char *const assembly[][4] = {{NULL},
                                            {"grains.packing.radius=30 mm", "step=12 us", NULL},
                                            {"grains.packing={kind: inward, low: [-10.5, -10.5], "
                                             "high: [10.5, 0], sizes: power, least: 20 "
                                             "mm, most: 50 mm, exponent: -2.5}",
                                             "step=8 us", "grains.most_overlap=0.2", NULL}};
  const char *override[MOST_OVERRIDES] = {version_name[COUPLED]};
  int count = 1;
  outcome o;
  for (int i = 0; assembly[parameter][i] != NULL; i++)
    override[count++] = assembly[parameter][i];
  CDEM_TRY(run_once(count, override, &o, fault));
  *value = o.load / o.peak;
  return CDEM_OK;
}

/* ---- bonded grains ---- */

static const char *const bonded[] = {
    "bonds=[{gap: 0.01, normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, rolling_stiffness: "
    "700 N m}]",
    "materials={soil: {model: cosserat-lattice, normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 "
    "N/m, rolling_stiffness: 700 N m, radius: 50 mm, density: 2042.035 kg/m3}}"};

static cdem_status linear(version v, bool fine_mesh, outcome *o, cdem_fault *fault) {
  const char *override[MOST_OVERRIDES] = {version_name[v], bonded[0], bonded[1],
                                          "mass_damping=100 1/s"};
  int count = 4;
  if (fine_mesh)
    override[count++] = "mesh.count=[36, 18]";
  return run_once(count, override, o, fault);
}

/* Load at 60 mm against bonded grains everywhere: 0 coupled, h = 7/6 m; 1 with half of that; 2
 * error of the first over that of the null; 3 largest error of the energy book. */
cdem_status cdem_bsm_measure_bonded(int parameter, double *value, cdem_fault *fault) {
  outcome coupled, grains, null;
  CDEM_TRY(linear(COUPLED, parameter == 1, &coupled, fault));
  *value = coupled.error;
  if (parameter == 3)
    return CDEM_OK;
  CDEM_TRY(linear(GRAINS, false, &grains, fault));
  *value = (coupled.load - grains.load) / grains.load;
  if (parameter < 2)
    return CDEM_OK;
  CDEM_TRY(linear(FROZEN, false, &null, fault));
  *value = fabs((coupled.load - grains.load) / (null.load - grains.load));
  return CDEM_OK;
}

/* No damping, slowly, for long: 0 load against grains everywhere, 1 growth of the coarse motion. */
cdem_status cdem_bsm_measure_undamped(int parameter, double *value, cdem_fault *fault) {
  outcome got[2];
  for (int grains = 0; grains < (parameter == 0 ? 2 : 1); grains++) {
    const char *const override[] = {version_name[grains ? GRAINS : COUPLED],
                                    bonded[0],
                                    bonded[1],
                                    "mass_damping=0 1/s",
                                    "end=300 ms",
                                    "step=40 us",
                                    "coupling.cycles=10",
                                    "walls.plate.velocity.y=-0.2 m/s",
                                    "history_every=1 ms"};
    CDEM_TRY(run_once(9, override, &got[grains], fault));
  }
  *value = parameter == 0 ? (got[0].load - got[1].load) / got[1].load : got[0].growth;
  return CDEM_OK;
}
