/* From options to an engine at time zero. */
#include "run/setup.h"

#include "io/case_file.h"
#include "io/run_files.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *cdem_run_key(char text[96], const char *section, int64_t index, const char *rest) {
  snprintf(text, 96, "%s[%lld]%s%s", section, (long long)index, rest[0] != '\0' ? "." : "", rest);
  return text;
}

const char *cdem_run_named_key(char text[96], const char *section, const char *name,
                               const char *rest) {
  snprintf(text, 96, "%s.%s%s%s", section, name, rest[0] != '\0' ? "." : "", rest);
  return text;
}

const char *cdem_run_wall_key(const cdem_run_setup *setup, const char *message, char text[96]) {
  const cdem_case_values *values = cdem_run_values(setup);
  char quoted[80];
  for (int64_t w = 0; w < values->walls.count; w++) {
    const char *name = values->walls.item[w].name;
    snprintf(quoted, sizeof quoted, "wall '%.64s'", name);
    if (strstr(message, quoted) != NULL)
      return cdem_run_named_key(text, "walls", name, "");
  }
  return NULL;
}

cdem_status cdem_run_refused(const cdem_run_setup *setup, const char *key, cdem_status status,
                             const char *message, cdem_fault *fault) {
  return status == CDEM_INPUT ? cdem_case_fail(&setup->cases, key, status, fault, "%s", message)
                              : cdem_fail(fault, status, "%s", message);
}

const char *const cdem_run_component[4] = {"x", "y", "z", "rotation"};

uint64_t cdem_run_checksum(uint64_t sum, const void *data, size_t bytes) {
  const unsigned char *byte = data;
  for (size_t i = 0; i < bytes; i++)
    sum = (sum ^ byte[i]) * 0x100000001b3u;
  return sum;
}

static uint64_t sum_text(const char *text) {
  return cdem_run_checksum(CDEM_RUN_SUM_START, text, strlen(text));
}

/* ---- the step ---- */

cdem_status cdem_run_check_step(const cdem_run_setup *setup, double limit, cdem_fault *fault) {
  enum { MOST_DIGITS = 15 }; /* steps are counted in 64 bits, and nobody waits for them */
  double step = cdem_run_values(setup)->step, end = cdem_run_values(setup)->end;
  const char *stiff = cdem_case_has_grains(&setup->cases) ? "grains" : "materials";
  if (!(limit > 0.0) || !isfinite(limit))
    return cdem_case_fail(&setup->cases, stiff, CDEM_INPUT, fault,
                          "there is no stable time step (the limit comes out as %g s): a modulus, "
                          "a density or a length is far out of range; look at their units",
                          limit);
  double steps = end / (isnan(step) ? limit : step);
  if (steps > pow(10.0, MOST_DIGITS)) /* false without an end */
    return cdem_case_fail(&setup->cases, "end", CDEM_INPUT, fault,
                          "%.3g s take %.3g steps of at most %.3g s (set by %s); look at the unit "
                          "of 'end', and at the moduli, densities and sizes",
                          end, steps, isnan(step) ? limit : step, setup->limiter);
  if (isnan(step) || step <= limit)
    return CDEM_OK;
  return cdem_case_fail(&setup->cases, "step", CDEM_INPUT, fault,
                        "a step of %.4g s is unstable: the limit is %.4g s, set by %s; take a "
                        "smaller one, or leave `step` out to have it chosen",
                        step, limit, setup->limiter);
}

cdem_status cdem_run_check_stable(const cdem_run_setup *setup, double limit, const char *limiter,
                                  cdem_fault *fault) {
  const cdem_run_now now = cdem_run_where(setup);
  if (isnan(cdem_run_values(setup)->step) || now.step <= limit)
    return CDEM_OK;
  return cdem_case_fail(&setup->cases, "step", CDEM_NUMERIC, fault,
                        "at t = %.6g s the step of %.4g s has become unstable: the limit is now "
                        "%.4g s, set by %s; take a smaller one, or leave `step` out",
                        now.time, now.step, limit, limiter);
}

double cdem_run_even_step(const cdem_run_setup *setup, double step) {
  double end = cdem_run_values(setup)->end;
  return end / ceil(end / step - 1e-9);
}

/* ---- all ---- */

static cdem_status read_case(const cdem_run_options *options, cdem_run_setup *setup,
                             cdem_fault *fault) {
  char path[4096];
  cdem_case *cases = &setup->cases;
  if (options->resume) {
    snprintf(path, sizeof path, "%s/case.yaml", options->folder);
    CDEM_TRY(cdem_read_case(path, 0, NULL, cases, fault));
  } else {
    CDEM_TRY(cdem_read_case(options->path, options->overrides, options->override, cases, fault));
  }
  /* The sum of what a person wrote must not depend on the folder in which it was run. */
  setup->case_sum = sum_text(cases->source);
  if (!options->resume)
    CDEM_TRY(cdem_case_settle_files(cases, options->overrides, options->override, fault));
  setup->kept_sum = sum_text(cases->source);
  return CDEM_OK;
}

static const cdem_run_engine *engine_of(const cdem_case *cases) {
  if (cdem_case_is_coupled(cases))
    return &cdem_run_engine_coupled;
  if (!cdem_case_has_grains(cases))
    return &cdem_run_engine_body;
  return cdem_case_has_deformable(cases) ? &cdem_run_engine_deformable : &cdem_run_engine_grains;
}

static cdem_status build(const cdem_run_options *options, const cdem_state *checkpoint,
                         cdem_run_setup *setup, cdem_fault *fault) {
  setup->options = options;
  CDEM_TRY(read_case(options, setup, fault));
  setup->engine = engine_of(&setup->cases);
  return setup->engine->build(setup, checkpoint, fault);
}

cdem_status cdem_run_setup_init(const cdem_run_options *options, const cdem_state *checkpoint,
                                cdem_run_setup *setup, cdem_fault *fault) {
  cdem_status status = build(options, checkpoint, setup, fault);
  if (status != CDEM_OK)
    cdem_run_setup_release(setup);
  return status;
}

void cdem_run_setup_release(cdem_run_setup *setup) {
  if (setup->engine != NULL)
    setup->engine->release(setup);
  cdem_case_release(&setup->cases);
  *setup = (cdem_run_setup){0};
}
