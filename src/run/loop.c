/* Time: steps, with rows, frames and checkpoints where they are due.
 *
 * What is due is decided by step and time alone, never by the clock (a checkpoint changes nothing),
 * so that a run broken and continued goes through the same states as an unbroken one.
 */
#include "run/output.h"

#include <math.h>
#include <stdio.h>

enum {
  LOOK_EVERY = 20, /* steps between two looks at the balance of a relaxation */
  ROW_EVERY = 100, /* steps between two rows of a relaxation that names no time */
  REPORT_EVERY = 8 /* steps between two reports of progress */
};
static const double wall_between_checkpoints = 300.0; /* s */

/* Multiples of `every` that the time has reached, to half a step. */
static int64_t reached(const cdem_solver *solver, double every) {
  double times = floor((solver->time + 0.5 * solver->step) / every);
  return times < 9e18 ? (int64_t)times : INT64_MAX - 1;
}

/* Is one due? Then *next is the one after. */
static bool due(const cdem_solver *solver, double every, int64_t *next) {
  int64_t now = reached(solver, every);
  if (now < *next)
    return false;
  *next = now + 1;
  return true;
}

static bool row_is_due(cdem_run_output *output) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  const cdem_solver *solver = &output->setup->solver;
  if (values->analysis == CDEM_ANALYSIS_RELAXATION && isnan(values->history_every))
    return solver->steps % ROW_EVERY == 0;
  return due(solver, values->history_every, &output->counters.next_row);
}

static bool frame_is_due(cdem_run_output *output) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  if (values->analysis == CDEM_ANALYSIS_RELAXATION && isnan(values->frame_every))
    return false;
  return due(&output->setup->solver, values->frame_every, &output->counters.next_frame);
}

static bool checkpoint_is_due(cdem_run_output *output) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  if (!isnan(values->checkpoint_every))
    return due(&output->setup->solver, values->checkpoint_every, &output->counters.next_checkpoint);
  return cdem_run_clock() - output->saved > wall_between_checkpoints;
}

/* Rows, frames and checkpoints of this step. */
static cdem_status write_due(cdem_run_output *output, bool *stop, cdem_fault *fault) {
  if (row_is_due(output))
    CDEM_TRY(cdem_run_output_row(output, stop, fault));
  if (frame_is_due(output))
    CDEM_TRY(cdem_run_output_frame(output, fault));
  if (checkpoint_is_due(output))
    CDEM_TRY(cdem_run_output_checkpoint(output, fault));
  return CDEM_OK;
}

/* A run that cannot go on keeps what it had: the state of the failure as row and frame, and the
 * last good checkpoint. Failures of keeping do not hide the first one. */
static cdem_status keep(cdem_run_output *output, cdem_status status) {
  cdem_run_output_row(output, NULL, NULL);
  cdem_run_output_frame(output, NULL);
  return status;
}

static cdem_status interrupted(cdem_run_output *output, cdem_fault *fault) {
  const cdem_solver *solver = &output->setup->solver;
  CDEM_TRY(cdem_run_output_checkpoint(output, fault));
  return cdem_fail(fault, CDEM_INTERRUPTED,
                   "interrupted at step %lld, t = %.6g s; continue with `cdem run --resume %s`",
                   (long long)solver->steps, solver->time, output->options->folder);
}

static cdem_status report(cdem_run_output *output, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  const cdem_solver *solver = &output->setup->solver;
  bool relaxing = values->analysis == CDEM_ANALYSIS_RELAXATION;
  double left = relaxing ? 0.0 : ceil((values->end - solver->time) / solver->step);
  if (solver->steps % REPORT_EVERY != 0)
    return CDEM_OK;
  cdem_status status = cdem_progress_report(
      output->options->progress, relaxing ? "relaxing, steps" : "running, steps", solver->steps,
      relaxing ? 0 : solver->steps + (int64_t)fmax(left, 0.0), NULL);
  return status == CDEM_INTERRUPTED ? interrupted(output, fault) : status;
}

static cdem_status run_dynamic(cdem_run_output *output, cdem_fault *fault) {
  cdem_solver *solver = &output->setup->solver;
  double end = cdem_run_values(output->setup)->end;
  bool stop = false;
  while (!stop && solver->time + 0.5 * solver->step < end) {
    CDEM_TRY(report(output, fault));
    cdem_status status = cdem_solver_step(solver, fault);
    if (status != CDEM_OK)
      return keep(output, status);
    CDEM_TRY(write_due(output, &stop, fault));
  }
  return CDEM_OK;
}

static cdem_status run_relaxation(cdem_run_output *output, cdem_fault *fault) {
  cdem_solver *solver = &output->setup->solver;
  const cdem_case_values *values = cdem_run_values(output->setup);
  bool stop = false;
  double ratio = INFINITY;
  while (!stop && solver->steps < values->most_steps) {
    CDEM_TRY(report(output, fault));
    cdem_status status = cdem_solver_step(solver, fault);
    if (status != CDEM_OK)
      return keep(output, status);
    CDEM_TRY(write_due(output, &stop, fault));
    if (solver->steps % LOOK_EVERY == 0 &&
        (ratio = cdem_solver_unbalanced(solver)) < values->tolerance)
      return CDEM_OK;
  }
  if (stop)
    return CDEM_OK;
  ratio = cdem_solver_unbalanced(solver);
  keep(output, CDEM_OK);
  CDEM_TRY(cdem_run_output_checkpoint(output, fault));
  return cdem_case_fail(&output->setup->cases, "most_steps", CDEM_NUMERIC, fault,
                        "the forces are not balanced after %lld steps: ratio %.3g, wanted %.3g; "
                        "allow more steps or a larger tolerance, or look for a body that no "
                        "support holds",
                        (long long)solver->steps, ratio, values->tolerance);
}

cdem_status cdem_run_loop(cdem_run_output *output, cdem_fault *fault) {
  switch (cdem_run_values(output->setup)->analysis) {
  case CDEM_ANALYSIS_STATIC: /* solved while it was set up */
    break;
  case CDEM_ANALYSIS_RELAXATION:
    CDEM_TRY(run_relaxation(output, fault));
    break;
  default:
    CDEM_TRY(run_dynamic(output, fault));
  }
  output->ended = cdem_run_clock();
  CDEM_TRY(cdem_run_output_row(output, NULL, fault));
  CDEM_TRY(cdem_run_output_frame(output, fault));
  return cdem_run_output_checkpoint(output, fault);
}
