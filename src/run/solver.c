/* The solver of a case, its time step, and the solution of a static run.
 *
 * The step is chosen so that a whole number of steps ends at `end`: the safety of the automatic
 * step is lowered by what that takes, and output times fall on steps. Where the step changes on the
 * way (interfaces breaking), output goes to the step next to its time.
 */
#include "run/setup.h"

#include <math.h>
#include <stdio.h>

static void fill_options(cdem_run_setup *setup) {
  const cdem_case_values *values = cdem_run_values(setup);
  const cdem_run_conditions *c = &setup->conditions;
  setup->solver_options =
      (cdem_solver_options){.body = &setup->body,
                            .blocks = &setup->blocks,
                            .interfaces = setup->has_interfaces ? &setup->interfaces : NULL,
                            .contact = setup->has_contact ? &setup->contact : NULL,
                            .thickness = setup->section.thickness,
                            .supports = c->supports,
                            .support = c->support,
                            .loads = c->loads,
                            .load = c->load,
                            .pressures = c->pressures,
                            .pressure = c->pressure,
                            .quiets = c->quiets,
                            .quiet = c->quiet,
                            .plates = c->plates,
                            .plate = c->plate,
                            .mass_damping = values->mass_damping,
                            .local_damping = values->local_damping,
                            .safety = isnan(values->safety) ? 0.0 : values->safety,
                            .velocity = c->velocity,
                            .fictitious_mass = values->analysis == CDEM_ANALYSIS_RELAXATION,
                            .threads = setup->threads};
  for (int k = 0; k < 3; k++)
    setup->solver_options.gravity[k] = values->gravity[k];
}

static cdem_status check_step(const cdem_run_setup *setup, double limit, cdem_fault *fault) {
  enum { MOST_DIGITS = 15 }; /* steps are counted in 64 bits, and nobody waits for them */
  double step = cdem_run_values(setup)->step, end = cdem_run_values(setup)->end;
  if (!(limit > 0.0) || !isfinite(limit))
    return cdem_case_fail(&setup->cases, "materials", CDEM_INPUT, fault,
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

/* A second start with the step that divides `end`. */
static cdem_status divide_end(cdem_run_setup *setup, double step, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup);
  cdem_solver_options *options = &setup->solver_options;
  double wanted = isnan(values->step) ? step : values->step;
  double even = values->end / ceil(values->end / wanted - 1e-9);
  if (isnan(values->step))
    options->safety = (options->safety > 0.0 ? options->safety : 0.8) * even / step;
  else
    options->step = even;
  cdem_solver_release(&setup->solver);
  cdem_status status = cdem_solver_init(options, &setup->solver, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&setup->cases, "step", fault) : status;
}

/* Only the solution shows whether the supports suffice, so it belongs to what is looked at before a
 * folder is touched. */
static cdem_status solve(cdem_run_setup *setup, cdem_fault *fault) {
  double end = cdem_run_values(setup)->end, time = isnan(end) ? 0.0 : end;
  CDEM_TRY(cdem_progress_report(setup->options->progress, "solving", 0, 0, fault));
  cdem_status status = cdem_solver_static(&setup->solver, time, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&setup->cases, "supports", fault) : status;
}

cdem_status cdem_run_setup_solver(cdem_run_setup *setup, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup);
  fill_options(setup);
  cdem_status status = cdem_solver_init(&setup->solver_options, &setup->solver, fault);
  if (status == CDEM_INPUT)
    return cdem_case_blame(&setup->cases, "supports", fault);
  CDEM_TRY(status);
  snprintf(setup->limiter, sizeof setup->limiter, "nothing");
  if (values->analysis == CDEM_ANALYSIS_STATIC)
    return solve(setup, fault);
  double limit = cdem_solver_limit(&setup->solver, setup->limiter);
  CDEM_TRY(check_step(setup, limit, fault));
  if (values->analysis == CDEM_ANALYSIS_DYNAMIC && values->end > 0.0 && isfinite(values->end))
    return divide_end(setup, setup->solver.step, fault);
  return CDEM_OK;
}
