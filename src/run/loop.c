/* Time: steps, with rows, frames and checkpoints where they are due.
 *
 * What is due is decided by step and time alone, never by the clock (a checkpoint changes nothing),
 * so that a run broken and continued goes through the same states as an unbroken one. Engines for
 * which many steps at once are faster get as many as there are to the next thing due, but no more
 * than a fraction of a second is worth, so that a wish to stop is heard.
 */
#include "run/summary.h"

#include <math.h>
#include <stdio.h>

enum { REPORT_EVERY = 8 }; /* steps between two reports of progress, one at a time */
static const double wall_between_checkpoints = 300.0; /* s */
static const double wall_of_stride = 0.1;             /* s */

/* Multiples of `every` that the time has reached, to half a step. */
static int64_t reached(const cdem_run_now *now, double every) {
  double times = floor((now->time + 0.5 * now->step) / every);
  return times < 9e18 ? (int64_t)times : INT64_MAX - 1;
}

/* Is one due? Then *next is the one after. */
static bool due(const cdem_run_now *now, double every, int64_t *next) {
  int64_t count = reached(now, every);
  if (count < *next)
    return false;
  *next = count + 1;
  return true;
}

/* ---- strides ---- */

/* Steps that can be taken without missing a time; at least one. Rounding cannot make it one too
 * many: the step at which something is due is the floor itself or the one after. */
static int64_t steps_until(const cdem_run_now *now, double time) {
  double steps = floor((time - now->time) / now->step - 0.5);
  return steps < 1.0 ? 1 : steps < 1e15 ? (int64_t)steps : (int64_t)1e15;
}

static int64_t least_of(int64_t a, int64_t b) {
  return a < b ? a : b;
}

static int64_t until_multiple(int64_t steps, int64_t every) {
  return every - steps % every;
}

static int64_t until_picture(const cdem_run_output *output, const cdem_run_now *now,
                             int64_t steps) {
  const double *time = cdem_run_values(output->setup)->grains.picture_times;
  for (int i = 0; i < CDEM_CASE_PICTURE_TIMES; i++)
    if (time[i] > now->time)
      steps = least_of(steps, steps_until(now, time[i]));
  return steps;
}

static int64_t stride(const cdem_run_output *output) {
  const cdem_run_setup *setup = output->setup;
  const cdem_case_values *v = cdem_run_values(setup);
  const cdem_run_counters *c = &output->counters;
  const cdem_run_now now = cdem_run_where(setup);
  if (!setup->engine->strides)
    return 1;
  int64_t steps = output->stride;
  if (setup->engine->follow_every > 0)
    steps = least_of(steps, until_multiple(now.steps, setup->engine->follow_every));
  if (v->analysis == CDEM_ANALYSIS_RELAXATION) {
    steps = least_of(steps, until_multiple(now.steps, setup->engine->look_every));
    steps = least_of(steps, v->most_steps - now.steps);
    if (isnan(v->history_every))
      steps = least_of(steps, until_multiple(now.steps, setup->engine->row_every));
  } else {
    steps = least_of(steps, steps_until(&now, v->end));
  }
  if (!isnan(v->history_every))
    steps = least_of(steps, steps_until(&now, v->history_every * (double)c->next_row));
  if (!isnan(v->frame_every))
    steps = least_of(steps, steps_until(&now, v->frame_every * (double)c->next_frame));
  if (!isnan(v->checkpoint_every))
    steps = least_of(steps, steps_until(&now, v->checkpoint_every * (double)c->next_checkpoint));
  return until_picture(output, &now, steps);
}

/* The next stride by the clock: it decides how often we look, not what we see. */
static cdem_status advance(cdem_run_output *output, cdem_fault *fault) {
  int64_t steps = stride(output);
  double begun = cdem_run_clock();
  CDEM_TRY(output->setup->engine->advance(output->setup, steps, fault));
  double wall = cdem_run_clock() - begun;
  if (wall > 2.0 * wall_of_stride && output->stride > 1)
    output->stride /= 2;
  else if (wall < 0.5 * wall_of_stride && steps == output->stride && steps < 1 << 20)
    output->stride *= 2;
  return CDEM_OK;
}

/* ---- what is due ---- */

static bool row_is_due(cdem_run_output *output, const cdem_run_now *now) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  if (values->analysis == CDEM_ANALYSIS_RELAXATION && isnan(values->history_every))
    return now->steps % output->setup->engine->row_every == 0;
  return due(now, values->history_every, &output->counters.next_row);
}

static bool frame_is_due(cdem_run_output *output, const cdem_run_now *now) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  if (values->analysis == CDEM_ANALYSIS_RELAXATION && isnan(values->frame_every))
    return false;
  return due(now, values->frame_every, &output->counters.next_frame);
}

static bool checkpoint_is_due(cdem_run_output *output, const cdem_run_now *now) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  if (!isnan(values->checkpoint_every))
    return due(now, values->checkpoint_every, &output->counters.next_checkpoint);
  return cdem_run_clock() - output->saved > wall_between_checkpoints;
}

/* Those of the step nearest to their time; their drawing does not count as time of the run. */
static cdem_status draw_due(cdem_run_output *output, const cdem_run_now *now, cdem_fault *fault) {
  const double *time = cdem_run_values(output->setup)->grains.picture_times;
  double begun = cdem_run_clock();
  for (int i = 0; output->options->figures && i < CDEM_CASE_PICTURE_TIMES; i++)
    if (time[i] > 0.0 && now->time + 0.5 * now->step >= time[i] &&
        now->time - 0.5 * now->step < time[i])
      CDEM_TRY(cdem_run_figures_at(output, time[i], fault));
  output->started += cdem_run_clock() - begun;
  return CDEM_OK;
}

/* Asked at every so many steps. */
static bool is_balanced(const cdem_run_output *output, const cdem_run_now *now) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  const cdem_run_engine *engine = output->setup->engine;
  return values->analysis == CDEM_ANALYSIS_RELAXATION && now->steps % engine->look_every == 0 &&
         engine->unbalanced(output->setup) < values->tolerance;
}

/* Rows, frames, pictures and checkpoints of this step. */
static cdem_status write_due(cdem_run_output *output, bool *stop, cdem_fault *fault) {
  const cdem_run_now now = cdem_run_where(output->setup);
  const cdem_run_engine *engine = output->setup->engine;
  bool row = row_is_due(output, &now), multiple = engine->follow_every > 0;
  if (engine->look != NULL && (multiple ? now.steps % engine->follow_every == 0 : row))
    CDEM_TRY(engine->look(output->setup, fault));
  if (row)
    CDEM_TRY(cdem_run_output_row(output, stop, fault));
  if (frame_is_due(output, &now))
    CDEM_TRY(cdem_run_output_frame(output, fault));
  CDEM_TRY(draw_due(output, &now, fault));
  if (!checkpoint_is_due(output, &now))
    return CDEM_OK;
  output->over = *stop || is_balanced(output, &now);
  return cdem_run_output_checkpoint(output, fault);
}

/* A run that cannot go on keeps what it had: the state of the failure as row and frame, and the
 * last good checkpoint. Failures of keeping do not hide the first one. */
static cdem_status keep(cdem_run_output *output, cdem_status status) {
  cdem_run_output_row(output, NULL, NULL);
  cdem_run_output_frame(output, NULL);
  return status;
}

static cdem_status interrupted(cdem_run_output *output, cdem_fault *fault) {
  const cdem_run_now now = cdem_run_where(output->setup);
  CDEM_TRY(cdem_run_output_checkpoint(output, fault));
  return cdem_fail(fault, CDEM_INTERRUPTED,
                   "interrupted at step %lld, t = %.6g s; continue with `cdem run --resume %s`",
                   (long long)now.steps, now.time, output->options->folder);
}

static cdem_status report(cdem_run_output *output, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  const cdem_run_now now = cdem_run_where(output->setup);
  bool relaxing = values->analysis == CDEM_ANALYSIS_RELAXATION;
  double left = relaxing ? 0.0 : ceil((values->end - now.time) / now.step);
  if (!output->setup->engine->strides && now.steps % REPORT_EVERY != 0)
    return CDEM_OK;
  cdem_status status = cdem_progress_report(
      output->options->progress, relaxing ? "relaxing, steps" : "running, steps", now.steps,
      relaxing ? 0 : now.steps + (int64_t)fmax(left, 0.0), NULL);
  return status == CDEM_INTERRUPTED ? interrupted(output, fault) : status;
}

/* ---- the three analyses ---- */

static cdem_status run_dynamic(cdem_run_output *output, cdem_fault *fault) {
  double end = cdem_run_values(output->setup)->end;
  cdem_run_now now = cdem_run_where(output->setup);
  bool stop = false;
  while (!stop && now.time + 0.5 * now.step < end) {
    CDEM_TRY(report(output, fault));
    cdem_status status = advance(output, fault);
    if (status != CDEM_OK)
      return keep(output, status);
    CDEM_TRY(write_due(output, &stop, fault));
    now = cdem_run_where(output->setup);
  }
  return CDEM_OK;
}

static cdem_status run_relaxation(cdem_run_output *output, cdem_fault *fault) {
  const cdem_run_setup *setup = output->setup;
  const cdem_case_values *values = cdem_run_values(setup);
  cdem_run_now now = cdem_run_where(setup);
  bool stop = false;
  while (!stop && now.steps < values->most_steps) {
    CDEM_TRY(report(output, fault));
    cdem_status status = advance(output, fault);
    if (status != CDEM_OK)
      return keep(output, status);
    CDEM_TRY(write_due(output, &stop, fault));
    now = cdem_run_where(setup);
    if (is_balanced(output, &now))
      return CDEM_OK;
  }
  if (stop)
    return CDEM_OK;
  double ratio = setup->engine->unbalanced(setup);
  keep(output, CDEM_OK);
  CDEM_TRY(cdem_run_output_checkpoint(output, fault));
  return cdem_case_fail(&setup->cases, "most_steps", CDEM_NUMERIC, fault,
                        "the forces are not balanced after %lld steps: ratio %.3g, wanted %.3g; "
                        "allow more steps or a larger tolerance, or look for %s",
                        (long long)now.steps, ratio, values->tolerance,
                        cdem_case_has_grains(&setup->cases) ? "grains that nothing holds"
                                                            : "a body that no support holds");
}

/* A run that was broken behind its last step has none to go. */
static cdem_status step_to_end(cdem_run_output *output, cdem_fault *fault) {
  if (output->over)
    return CDEM_OK;
  switch (cdem_run_values(output->setup)->analysis) {
  case CDEM_ANALYSIS_STATIC: /* solved while it was set up */
    return CDEM_OK;
  case CDEM_ANALYSIS_RELAXATION:
    return run_relaxation(output, fault);
  default:
    return run_dynamic(output, fault);
  }
}

cdem_status cdem_run_loop(cdem_run_output *output, cdem_fault *fault) {
  CDEM_TRY(step_to_end(output, fault));
  output->over = true;
  output->ended = cdem_run_clock();
  CDEM_TRY(cdem_run_output_row(output, NULL, fault));
  CDEM_TRY(cdem_run_output_frame(output, fault));
  return cdem_run_output_checkpoint(output, fault);
}
