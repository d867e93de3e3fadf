/* Footings: bonded spheres in bricks against spheres everywhere, and grains inside a body that
 * breaks. */
#include "verify/bsm.h"
#include "verify/bsm_runs.h"

#include <math.h>

/* ---- spheres in bricks ---- */

cdem_status cdem_bsm_measure_solid_footing(int parameter, double *value, cdem_fault *fault) {
  static const char *const version[] = {"coupling.version=coupled", "coupling.version=grains",
                                        "coupling.version=frozen"};
  static const char load[] = "load.plate.fz";
  const cdem_table *run[3];
  for (int v = 0; v < 3; v++)
    CDEM_TRY(cdem_bsm_run(CDEM_BSM_SOLID, (const char *const[]){version[v], NULL}, &run[v], fault));
  double truth = cdem_bsm_last(run[1], load), off = cdem_bsm_last(run[0], load) - truth;
  const double found[] = {off / truth, cdem_bsm_apart(run[0], run[1], load),
                          fabs(off / (cdem_bsm_last(run[2], load) - truth)),
                          cdem_bsm_largest(run[0], "energy_error", 0.0, NULL)};
  *value = found[parameter];
  return CDEM_OK;
}

/* ---- a body that breaks ---- */

static cdem_status cemented(const char *one, const char *other, const cdem_table **history,
                            cdem_fault *fault) {
  return cdem_bsm_run(CDEM_BSM_CEMENTED, (const char *const[]){one, other, NULL}, history, fault);
}

/* Largest difference of the loads by the largest load: tied faces that nothing opens, one body. */
static cdem_status unbroken(double *value, cdem_fault *fault) {
  const cdem_table *tied, *body;
  CDEM_TRY(cemented("interfaces=[{insertion: tied, tension: 1e9 MPa, cohesion: 1e9 MPa, friction: "
                    "0.5}]",
                    NULL, &tied, fault));
  CDEM_TRY(cemented("blocks={}", "interfaces=[]", &body, fault));
  *value = tied->rows == body->rows ? 0.0 : NAN;
  for (int64_t r = 0; r < body->rows; r++)
    *value = fmax(*value, fabs(cdem_bsm_at(tied, r, "load.plate.fy") -
                               cdem_bsm_at(body, r, "load.plate.fy")));
  *value /= cdem_bsm_largest(body, "load.plate.fy", 0.0, NULL);
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_cemented(int parameter, double *value, cdem_fault *fault) {
  static const char load[] = "load.plate.fy";
  const cdem_table *broken, *larger;
  if (parameter == 0)
    return unbroken(value, fault);
  CDEM_TRY(cemented(NULL, NULL, &broken, fault));
  if (parameter == 1) {
    *value = cdem_bsm_largest(broken, "energy_error", 0.0, NULL);
    return CDEM_OK;
  }
  double cracks = cdem_bsm_at(broken, broken->rows - 1, "coarse.cracks");
  CDEM_REQUIRE(cracks >= 10.0, fault, CDEM_NUMERIC,
               "only %g faces crack, with which the comparison would show nothing", cracks);
  CDEM_TRY(cemented("coupling.regions=[{low: [-1.25 m, -1.25 m], high: [1.25 m, 0.1 m]}]", NULL,
                    &larger, fault));
  double end = cdem_bsm_last(broken, load);
  *value = parameter == 2 ? cdem_bsm_apart(larger, broken, load)
                          : (cdem_bsm_last(larger, load) - end) / end;
  return CDEM_OK;
}
