/* Room run: from a case to a finished run folder.
 *
 * Reads the case and its mesh, builds the solver, steps it, and hands what comes out to io: frames,
 * history, checkpoints, figures and summary.json. The program, the verification and the tests all
 * run cases through this door.
 *
 *     DIR/case.yaml        the case as run (overrides applied), so that the folder stands alone
 *     DIR/checkpoint.h5    the mesh and the last state
 *     DIR/history.csv      one row per output time, header with units
 *     DIR/SET.pvd, SET/    frames
 *     DIR/figures/         curves of the case, energies, final pattern
 *     DIR/summary.json     settings, version, checksums, wall time, key results
 *     DIR/.lock            held while a run writes here
 */
#ifndef CDEM_RUN_RUN_H
#define CDEM_RUN_RUN_H

#include "base/base.h"
#include "io/io.h"

#include <stdbool.h>

typedef struct {
  const char *path; /* of the case; NULL with resume */
  const char *folder;
  bool resume; /* continue folder's run from its checkpoint */
  bool check;  /* build everything, run nothing, write nothing; folder may be NULL */
  int overrides;
  const char *const *override;  /* "mesh.parameters.h=2" */
  int threads;                  /* 0: OpenMP's default */
  bool figures;                 /* draw them */
  bool frames;                  /* write them */
  const char *version, *commit; /* for summary.json */
  const char *build;            /* likewise, how the program was compiled; NULL: not said */
  const cdem_progress *progress;
  const cdem_warnings *warnings;
} cdem_run_options;

typedef struct {
  char *title; /* NULL: none */
  int64_t steps;
  double time, wall;          /* s; wall: of all parts of a run that was continued */
  int64_t nodes, unknowns;    /* of the cut mesh; unknowns: nodes times their freedoms */
  int64_t elements, distinct; /* distinct: templates of congruent elements */
  int64_t blocks, interfaces; /* interfaces: faces between blocks */
  int64_t grains, contacts;   /* of a run of grains, 0 in one of a body; contacts: now */
  int64_t walls, bonds;
  int64_t fine, interface_grains;               /* of a coupled run, else 0 */
  int cycles;                                   /* steps of the grains a step */
  double coarse_limit;                          /* s, longest stable step of the coarse medium */
  double wall_fine, wall_coarse, wall_transfer; /* s, parts of `wall` since the last start */
  double solid;                                 /* volume (2-D: area) of the grains, m^3 (m^2) */
  double step;                                  /* s, the present one */
  char limiter[64];                             /* what limits it */
  double energy_error;                          /* |error| of the book by its scale */
  int results;                                  /* key results with a reference */
  int failed;                                   /* ... that are off by more than their tolerance */
  int64_t warnings, warning_capacity;
  char **warning;  /* [warnings] given by this run since it was last started */
  cdem_table keys; /* name, value, unit, reference, difference (relative; absolute where the
                      reference is 0); no unit where a factor was applied */
} cdem_run_summary;

/* A new run in the folder of an earlier one replaces its files. Not balanced within most_steps:
 * CDEM_NUMERIC, with rows, frames and checkpoint in place. Pictures that cannot be drawn are a
 * warning.
 *
 * CDEM_INTERRUPTED after a wish to stop: a checkpoint has been written and the message says how to
 * go on. CDEM_INPUT when the folder is in use by another run. */
cdem_status cdem_run(const cdem_run_options *options, cdem_run_summary *summary, cdem_fault *fault);
void cdem_run_summary_release(cdem_run_summary *summary);

#endif
