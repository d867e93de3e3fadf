/* The solver of a case, its time step, and the solution of a static run.
 *
 * The step is chosen so that a whole number of steps ends at `end`: the safety of the automatic
 * step is lowered by what that takes, and output times fall on steps. Where the step changes on the
 * way (interfaces breaking), output goes to the step next to its time.
 */
#include "run/body.h"

#include <math.h>
#include <stdio.h>

static void fill_options(cdem_run_body *setup) {
  const cdem_case_values *values = cdem_run_values(setup->run);
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
                            .threads = setup->run->threads};
  for (int k = 0; k < 3; k++)
    setup->solver_options.gravity[k] = values->gravity[k];
}

/* A second start with the step that divides `end`. */
static cdem_status divide_end(cdem_run_body *setup, double step, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  cdem_solver_options *options = &setup->solver_options;
  double wanted = isnan(values->step) ? step : values->step;
  double even = cdem_run_even_step(setup->run, wanted);
  if (isnan(values->step))
    options->safety = (options->safety > 0.0 ? options->safety : 0.8) * even / step;
  else
    options->step = even;
  cdem_solver_release(&setup->solver);
  cdem_status status = cdem_solver_init(options, &setup->solver, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&setup->run->cases, "step", fault) : status;
}

/* Only the solution shows whether the supports suffice, so it belongs to what is looked at before a
 * folder is touched. */
static cdem_status solve(cdem_run_body *setup, cdem_fault *fault) {
  double end = cdem_run_values(setup->run)->end, time = isnan(end) ? 0.0 : end;
  CDEM_TRY(cdem_progress_report(setup->run->options->progress, "solving", 0, 0, fault));
  cdem_status status = cdem_solver_static(&setup->solver, time, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&setup->run->cases, "supports", fault) : status;
}

cdem_status cdem_run_body_solver(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  fill_options(setup);
  setup->solver_options.step = setup->fixed_step;
  cdem_status status = cdem_solver_init(&setup->solver_options, &setup->solver, fault);
  if (status == CDEM_INPUT)
    return cdem_case_blame(&setup->run->cases, "supports", fault);
  CDEM_TRY(status);
  snprintf(setup->run->limiter, sizeof setup->run->limiter, "nothing");
  if (values->analysis == CDEM_ANALYSIS_STATIC)
    return solve(setup, fault);
  if (setup->fixed_step > 0.0)
    return CDEM_OK;
  double limit = cdem_solver_limit(&setup->solver, setup->run->limiter);
  CDEM_TRY(cdem_run_check_step(setup->run, limit, fault));
  if (values->analysis == CDEM_ANALYSIS_DYNAMIC && values->end > 0.0 && isfinite(values->end))
    return divide_end(setup, setup->solver.step, fault);
  return CDEM_OK;
}
