/* Scaled cases. */
#include "run/scale.h"

#include "api/store.h"

#include <math.h>
#include <string.h>

static cdem_status check_ratio(double ratio, cdem_fault *fault) {
  CDEM_REQUIRE(ratio >= 1e-9 && ratio <= 1e9, fault, CDEM_USAGE,
               "ratio %g: a number from 1e-9 to 1e9 is wanted", ratio);
  return CDEM_OK;
}

static cdem_status scale(const char *path, cdem_scaling scaling, const char *output,
                         const libcdem_listener *listener, cdem_fault *fault) {
  cdem_api_ears ears;
  cdem_scaled_table table = {0};
  CDEM_TRY(cdem_api_want(path, "the path of a case", fault));
  CDEM_TRY(cdem_api_want(output, "a path for the scaled case", fault));
  CDEM_REQUIRE(strcmp(output, "-") != 0, fault, CDEM_USAGE, "the scaled case needs a file");
  cdem_api_listen(listener, &ears);
  cdem_api_quiet_gsl();
  const cdem_scale_options options = {.path = path,
                                      .output = output,
                                      .scaling = scaling,
                                      .progress = ears.progress,
                                      .warnings = &ears.warnings};
  cdem_status status = cdem_scale_case(&options, &table, fault);
  cdem_scaled_table_release(&table);
  return status;
}

libcdem_status libcdem_case_scale(const char *path, const double *ratio, const char *output,
                                  const libcdem_listener *listener, libcdem_fault *fault) {
  cdem_fault own = {0};
  cdem_status status = cdem_api_want(ratio, "three ratios", &own);
  for (int i = 0; i < 3 && status == CDEM_OK; i++)
    status = check_ratio(ratio[i], &own);
  if (status == CDEM_OK) {
    const cdem_ratios ratios = {ratio[0], ratio[1], ratio[2]};
    status = scale(path, cdem_scaling_exact(ratios), output, listener, &own);
  }
  return cdem_api_end(status, &own, fault);
}

libcdem_status libcdem_case_coarsen(const char *path, double h, const char *output,
                                    const libcdem_listener *listener, libcdem_fault *fault) {
  cdem_fault own = {0};
  cdem_status status = check_ratio(h, &own);
  if (status == CDEM_OK) /* of which dimension, the case says */
    status = scale(path, cdem_scaling_coarse(h, 3), output, listener, &own);
  return cdem_api_end(status, &own, fault);
}
