/* The foundation of Li & Wan (2010), section 3, in its versions: coupled against grains everywhere,
 * loose and bonded; softening and bands of the assemblies. */
#include "verify/bsm.h"
#include "verify/bsm_runs.h"

#include <math.h>
#include <stdio.h>

typedef enum { COUPLED, FROZEN, GRAINS } version;
static const char *const version_name[] = {"coupling.version=coupled", "coupling.version=frozen",
                                           "coupling.version=grains"};

static const double after_start = 10e-3; /* s: the first load is the jump of the start */
static const char load[] = "load.plate.fy";

/* ---- assembly A against grains everywhere ---- */

enum { LOAD, PEAK, PLACE, QUANTITIES };
static const char *const extreme[] = {"region.effective_strain", "region.volumetric_strain",
                                      "region.volumetric_stress", "region.effective_stress"};

static double number(const cdem_table *history, int what) {
  int64_t row = 0;
  double peak = cdem_bsm_largest(history, load, after_start, &row);
  return what == LOAD    ? cdem_bsm_last(history, load)
         : what == PEAK  ? peak
         : what == PLACE ? fabs(cdem_bsm_at(history, row, "load.plate.moved_y"))
                         : cdem_bsm_last(history, extreme[what - QUANTITIES]);
}

cdem_status cdem_bsm_measure_foundation(int parameter, double *value, cdem_fault *fault) {
  int what = parameter / 1000;
  double of[3];
  for (int v = COUPLED; v <= GRAINS; v += GRAINS) {
    char damped[64];
    const cdem_table *history;
    snprintf(damped, sizeof damped, "mass_damping=%d 1/s", parameter % 1000);
    CDEM_TRY(cdem_bsm_run(CDEM_BSM_FOUNDATION, (const char *const[]){version_name[v], damped, NULL},
                          &history, fault));
    of[v] = number(history, what);
  }
  *value = what == PLACE ? of[COUPLED] - of[GRAINS] : (of[COUPLED] - of[GRAINS]) / fabs(of[GRAINS]);
  return CDEM_OK;
}

/* ---- the three assemblies ---- */

static const char inward[] =
    "grains.packing={kind: inward, low: [-10.5, -10.5], high: [10.5, 0], sizes: power, least: 20 "
    "mm, most: 50 mm, exponent: -2.5}";

static cdem_status assembly(int which, const cdem_table **history, cdem_fault *fault) {
  static const char *const override[3][CDEM_BSM_OVERRIDES] = {
      {"coupling.version=coupled", NULL},
      {"coupling.version=coupled", "grains.packing.radius=30 mm", "step=12 us", NULL},
      {"coupling.version=coupled", inward, "step=8 us", "grains.most_overlap=0.2", NULL}};
  return cdem_bsm_run(CDEM_BSM_FOUNDATION, override[which], history, fault);
}

cdem_status cdem_bsm_measure_softening(int parameter, double *value, cdem_fault *fault) {
  const cdem_table *history;
  CDEM_TRY(assembly(parameter, &history, fault));
  *value = cdem_bsm_last(history, load) / cdem_bsm_largest(history, load, after_start, NULL);
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_bands(int parameter, double *value, cdem_fault *fault) {
  static const char *const column[] = {"probe.left_angle", "probe.right_angle",
                                       "probe.left_slenderness", "probe.right_slenderness"};
  const cdem_table *history;
  CDEM_TRY(assembly(parameter / 10, &history, fault));
  *value = cdem_bsm_last(history, column[parameter % 10]);
  if (parameter % 10 < 2)
    *value *= 180.0 / 3.14159265358979323846;
  return CDEM_OK;
}

/* ---- bonded grains ---- */

static const char bonds[] =
    "bonds=[{gap: 0.01, normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, rolling_stiffness: "
    "700 N m}]";
static const char medium[] =
    "materials={soil: {model: cosserat-lattice, normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 "
    "N/m, rolling_stiffness: 700 N m, radius: 50 mm, density: 2042.035 kg/m3}}";

static cdem_status bonded(version v, bool fine_mesh, const cdem_table **history,
                          cdem_fault *fault) {
  return cdem_bsm_run(
      CDEM_BSM_FOUNDATION,
      (const char *const[]){version_name[v], bonds, medium, "mass_damping=100 1/s",
                            fine_mesh ? "mesh.count=[36, 18]" : "mesh.count=[18, 9]", NULL},
      history, fault);
}

cdem_status cdem_bsm_measure_bonded(int parameter, double *value, cdem_fault *fault) {
  const cdem_table *coupled, *grains, *null;
  CDEM_TRY(bonded(COUPLED, parameter == 1, &coupled, fault));
  *value = cdem_bsm_largest(coupled, "energy_error", 0.0, NULL);
  if (parameter == 3)
    return CDEM_OK;
  CDEM_TRY(bonded(GRAINS, false, &grains, fault));
  double truth = cdem_bsm_last(grains, load), off = cdem_bsm_last(coupled, load) - truth;
  *value = off / truth;
  if (parameter < 2)
    return CDEM_OK;
  CDEM_TRY(bonded(FROZEN, false, &null, fault));
  *value = fabs(off / (cdem_bsm_last(null, load) - truth));
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_undamped(int parameter, double *value, cdem_fault *fault) {
  const cdem_table *history[2];
  for (int grains = 0; grains < (parameter == 0 ? 2 : 1); grains++)
    CDEM_TRY(cdem_bsm_run(CDEM_BSM_FOUNDATION,
                          (const char *const[]){version_name[grains ? GRAINS : COUPLED], bonds,
                                                medium, "mass_damping=0 1/s", "end=300 ms",
                                                "step=40 us", "walls.plate.velocity.y=-0.2 m/s",
                                                "history_every=1 ms", NULL},
                          &history[grains], fault));
  if (parameter == 0) {
    double truth = cdem_bsm_last(history[1], load);
    *value = (cdem_bsm_last(history[0], load) - truth) / truth;
    return CDEM_OK;
  }
  double early = 0.0;
  for (int64_t r = 0; 2 * r < history[0]->rows; r++)
    early = fmax(early, cdem_bsm_at(history[0], r, "coarse.kinetic"));
  *value = cdem_bsm_last(history[0], "coarse.kinetic") / early;
  return CDEM_OK;
}
