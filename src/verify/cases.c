/* Group cases: shipped cases as they are, each key result over its reference in the case file; what
 * they are is told in docs/cases.md. Tolerances are those of the files (tests/verify/verify.c
 * compares). CMake makes texts of the library out of the cases and their meshes. */
#include "verify/cases.h"

#include "io/io.h"
#include "io/run_files.h"
#include "run/run.h"
#include "verify/shipped_cases.h"
#include "verify/verify.h"

#include <stdio.h>
#include <string.h>

#define MEASURE(of, row)                                                                           \
  .kind = CDEM_CHECK_##of, .measure = cdem_cases_measure_result, .parameter = row

/* Rows of the table of key results. */
enum {
  CANTILEVER,
  PLATE,
  BAR_FINISH,
  BAR_LET_OUT,
  DISC,
  BEAM,
  SLOPE,
  STACK,
  IMPACT,
  SETTLING_WEIGHT,
  SETTLING_SOLID,
  HOPPER,
  DRUM_TORQUE,
  DRUM_POWER,
  DRUM_ANGLE,
  REPOSE,
  BIAXIAL_PEAK,
  BIAXIAL_CRITICAL,
  BIAXIAL_SOLID,
  BIAXIAL_PRESSURE,
  TRIAXIAL,
  FOUNDATION,
  ROWS
};

static const struct {
  cdem_shipped_case shipped;
  const char *key;
} rows[ROWS] = {
    [CANTILEVER] = {CDEM_SHIPPED_cantilever, "tip"},
    [PLATE] = {CDEM_SHIPPED_plate_with_hole, "factor"},
    [BAR_FINISH] = {CDEM_SHIPPED_bar_wave, "finish"},
    [BAR_LET_OUT] = {CDEM_SHIPPED_bar_wave, "let_out"},
    [DISC] = {CDEM_SHIPPED_brazilian_disc, "peak"},
    [BEAM] = {CDEM_SHIPPED_notched_beam, "dissipated"},
    [SLOPE] = {CDEM_SHIPPED_slope_joint, "distance"},
    [STACK] = {CDEM_SHIPPED_block_stack, "top_x"},
    [IMPACT] = {CDEM_SHIPPED_impact, "struck"},
    [SETTLING_WEIGHT] = {CDEM_SHIPPED_settling, "weight"},
    [SETTLING_SOLID] = {CDEM_SHIPPED_settling, "solid_fraction"},
    [HOPPER] = {CDEM_SHIPPED_hopper, "flow"},
    [DRUM_TORQUE] = {CDEM_SHIPPED_drum, "torque"},
    [DRUM_POWER] = {CDEM_SHIPPED_drum, "power"},
    [DRUM_ANGLE] = {CDEM_SHIPPED_drum, "angle"},
    [REPOSE] = {CDEM_SHIPPED_angle_of_repose, "angle"},
    [BIAXIAL_PEAK] = {CDEM_SHIPPED_biaxial, "peak"},
    [BIAXIAL_CRITICAL] = {CDEM_SHIPPED_biaxial, "critical"},
    [BIAXIAL_SOLID] = {CDEM_SHIPPED_biaxial, "critical_solid"},
    [BIAXIAL_PRESSURE] = {CDEM_SHIPPED_biaxial, "side_pressure"},
    [TRIAXIAL] = {CDEM_SHIPPED_triaxial, "lateral"},
    [FOUNDATION] = {CDEM_SHIPPED_foundation_a, "load"},
};

static const cdem_verification checks[] = {
    {"cantilever: deflection of the end", "CalculiX 2.20, C3D8, the same mesh", 1, 1e-6,
     MEASURE(PROGRAM, CANTILEVER)},
    {"plate-with-hole: factor at the crown", "Kirsch 1898: 3", 1, 0.01,
     MEASURE(CLOSED_FORM, PLATE)},
    {"bar-wave: speed of the far end", "d'Alembert: p/(rho c)", 1, 2e-3,
     MEASURE(CLOSED_FORM, BAR_FINISH)},
    {"bar-wave: energy let out by the quiet end", "d'Alembert: integral of p^2/(rho c)", 1, 2e-3,
     MEASURE(CLOSED_FORM, BAR_LET_OUT)},
    {"brazilian-disc: peak load", "CalculiX 2.20, CPE3, elastic disc between rigid strips", 1, 0.05,
     MEASURE(PROGRAM, DISC), .slow = true},
    {"notched-beam: dissipated energy", "G_I A (1 - 1/(2 n))", 1, 0.01, MEASURE(CLOSED_FORM, BEAM),
     .slow = true},
    {"slope-joint: way of the wedge", "rigid wedge with friction", 1, 0.01,
     MEASURE(CLOSED_FORM, SLOPE), .slow = true},
    {"block-stack: way of the top", "rigid tower, its equation of motion integrated", 1, 0.05,
     MEASURE(SECOND_WAY, STACK)},
    {"impact: speed of the struck bar", "Saint-Venant 1867: half of the striker's", 1, 0.01,
     MEASURE(CLOSED_FORM, IMPACT)},
    {"settling: force on floor and sides", "weight of the spheres", 1, 2e-3,
     MEASURE(LAW, SETTLING_WEIGHT), .slow = true},
    {"settling: solid fraction in the middle", "Onoda & Liniger 1990: 0.55 to 0.64", 1, 0.075,
     MEASURE(PUBLISHED, SETTLING_SOLID), .slow = true},
    {"hopper: flow through the slot", "Beverloo's law for slots, factors of Nedderman 1992", 1, 0.1,
     MEASURE(PUBLISHED, HOPPER), .slow = true},
    {"drum: torque", "weight times lever of the centre of mass", 1, 0.02, MEASURE(LAW, DRUM_TORQUE),
     .slow = true},
    {"drum: work of the drum", "what friction, rolling and dashpots take", 1, 0.05,
     MEASURE(LAW, DRUM_POWER), .slow = true},
    {"drum: angle of the surface", "plane surface of a segment with that lever", 1, 0.15,
     MEASURE(LAW, DRUM_ANGLE), .slow = true},
    {"angle-of-repose: angle of the flanks", "peak friction of the same discs, biaxial test", 1,
     0.2, MEASURE(SECOND_WAY, REPOSE), .slow = true},
    {"biaxial: stress ratio at the peak", "Rowe 1962", 1, 0.15, MEASURE(LAW, BIAXIAL_PEAK),
     .slow = true},
    {"biaxial: stress ratio behind the peak", "da Cruz et al. 2005: 0.26", 1, 0.3,
     MEASURE(PUBLISHED, BIAXIAL_CRITICAL), .slow = true},
    {"biaxial: solid fraction at the end", "da Cruz et al. 2005: 0.81", 1, 0.015,
     MEASURE(PUBLISHED, BIAXIAL_SOLID), .slow = true},
    {"biaxial: pressure on the sides", "the servo's 10 kPa", 1, 0.12,
     MEASURE(LAW, BIAXIAL_PRESSURE), .slow = true},
    {"triaxial: lateral stress in the shear", "the membrane's 0.9 MPa", 1, 0.01,
     MEASURE(LAW, TRIAXIAL), .slow = true},
    {"foundation-a: load on the plate, 58 to 60 ms", "Li & Wan 2010, table 2: 1.691 MN", 1, 0.04,
     MEASURE(PUBLISHED, FOUNDATION), .slow = true},
};

const cdem_verify_group cdem_verify_cases = {
    .name = "cases",
    .summary = "shipped cases: key results over their references",
    .checks = sizeof checks / sizeof checks[0],
    .check = checks,
};

/* Key results of cases that have run, for the life of the process: several checks look at one. */
static cdem_table kept[CDEM_SHIPPED_CASES];

static cdem_status run_in(const char *scratch, cdem_shipped_case shipped, cdem_table *keys,
                          cdem_fault *fault) {
  char path[160], folder[128];
  cdem_run_summary summary = {0};
  const char *text = cdem_shipped[shipped].text, *mesh = cdem_shipped[shipped].mesh;
  if (mesh != NULL) {
    snprintf(path, sizeof path, "%s/%s", scratch, cdem_shipped[shipped].mesh_name);
    CDEM_TRY(cdem_write_text(path, mesh, (int64_t)strlen(mesh), fault));
  }
  snprintf(path, sizeof path, "%s/case.yaml", scratch);
  snprintf(folder, sizeof folder, "%s/run", scratch);
  CDEM_TRY(cdem_write_text(path, text, (int64_t)strlen(text), fault));
  const cdem_run_options options = {.path = path, .folder = folder};
  cdem_status status = cdem_run(&options, &summary, fault);
  if (status == CDEM_OK) {
    *keys = summary.keys;
    summary.keys = (cdem_table){0};
  }
  cdem_run_summary_release(&summary);
  return status;
}

static cdem_status run(cdem_shipped_case shipped, cdem_table *keys, cdem_fault *fault) {
  char scratch[64];
  CDEM_TRY(cdem_make_scratch(scratch, fault));
  cdem_status status = run_in(scratch, shipped, keys, fault);
  cdem_remove_scratch(scratch);
  return status;
}

const char *cdem_cases_key(int parameter) {
  return rows[parameter].key;
}

cdem_status cdem_cases_measure_result(int parameter, double *value, cdem_fault *fault) {
  cdem_table *keys = &kept[rows[parameter].shipped];
  if (keys->rows == 0)
    CDEM_TRY(run(rows[parameter].shipped, keys, fault));
  const int name = cdem_table_find(keys, "name");
  for (int64_t r = 0; r < keys->rows; r++)
    if (strcmp(cdem_table_at(keys, r, name)->text, rows[parameter].key) == 0) {
      *value = cdem_table_at(keys, r, cdem_table_find(keys, "value"))->real /
               cdem_table_at(keys, r, cdem_table_find(keys, "reference"))->real;
      return CDEM_OK;
    }
  return cdem_fail(fault, CDEM_USAGE, "the case has no key result '%s'", rows[parameter].key);
}
