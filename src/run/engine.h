/* Private to run: what moves, seen from the files of a run.
 *
 * A run is the same for bodies and grains: a folder, rows, frames, checkpoints, a summary. What
 * differs is an engine: a table of functions over a context that only they know. One engine is one
 * line in setup.c and files of its own (body_*.c, grains_*.c); that of coupled runs (coupled_*.c)
 * is made of the other two.
 *
 * A function that may be NULL says so. Each gets the setup, whose `context` is the engine's.
 */
#ifndef CDEM_RUN_ENGINE_H
#define CDEM_RUN_ENGINE_H

#include "results/frame.h"
#include "results/state.h"
#include "run/json.h"
#include "run/row.h"
#include "run/run.h"

typedef struct cdem_run_setup cdem_run_setup;

/* Where a run stands. */
typedef struct {
  double time, step; /* s */
  int64_t steps;
} cdem_run_now;

/* Columns of history.csv that one panel of the figure of energies shows. */
enum { CDEM_RUN_PANELS = 3, CDEM_RUN_PANEL_COLUMNS = 7 };
typedef struct {
  const char *title;
  const char *column[CDEM_RUN_PANEL_COLUMNS]; /* ended by NULL */
} cdem_run_energy_panel;

typedef struct {
  const char *name;     /* "body" */
  bool strides;         /* many steps at once are faster than as many single ones */
  int64_t row_every;    /* steps between two rows of a relaxation that names no time ... */
  int64_t look_every;   /* ... and between two looks at its balance */
  int64_t follow_every; /* steps between two calls of `look`; 0: at rows */
  cdem_run_energy_panel energies[CDEM_RUN_PANELS];

  /* From the case to a state at time zero; checkpoint: of a broken run, from which files that were
   * read need not be read again (the state follows by `restore`), or NULL. The context may be
   * released after a failure. */
  cdem_status (*build)(cdem_run_setup *setup, const cdem_state *checkpoint, cdem_fault *fault);
  void (*release)(cdem_run_setup *setup);
  /* Everything that changes, and what `build` takes from a checkpoint. */
  cdem_status (*save)(const cdem_run_setup *setup, cdem_state *state, cdem_fault *fault);
  cdem_status (*restore)(cdem_run_setup *setup, const cdem_state *checkpoint, cdem_fault *fault);

  void (*now)(const cdem_run_setup *setup, cdem_run_now *now);
  /* The state after `steps` steps does not depend on how they were parted into calls. */
  cdem_status (*advance)(cdem_run_setup *setup, int64_t steps, cdem_fault *fault);
  /* Called at steps that are multiples of `follow_every`, or where that is 0 where a row is due,
   * before it is written: at steps that the case alone decides. NULL: nothing to do. */
  cdem_status (*look)(cdem_run_setup *setup, cdem_fault *fault);
  /* Ratio by which a relaxation is balanced; INFINITY while there is nothing to be balanced. */
  double (*unbalanced)(const cdem_run_setup *setup);
  cdem_status (*frames)(cdem_run_setup *setup, int64_t index, const cdem_frame_sink *sink,
                        cdem_fault *fault);
  /* Columns behind time, step and time_step, declared and filled by one walk (row.h). */
  void (*columns)(cdem_run_setup *setup, cdem_run_row *row);
  /* Sizes of the problem, into the summary and into summary.json. */
  cdem_status (*sizes)(const cdem_run_setup *setup, cdem_run_summary *summary, cdem_fault *fault);
  void (*put_sizes)(cdem_json *json, const cdem_run_summary *summary);
  /* The present state as pictures in a folder; tag: end of the names of their files ("": none). */
  cdem_status (*pictures)(cdem_run_setup *setup, const char *folder, const char *tag,
                          cdem_fault *fault);
} cdem_run_engine;

extern const cdem_run_engine cdem_run_engine_body, cdem_run_engine_grains, cdem_run_engine_coupled,
    cdem_run_engine_deformable;

#endif
