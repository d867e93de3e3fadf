/* The grains of a case at its start, of a run folder at its last checkpoint, or of a table, written
 * for other programs (io/grains_scene.h). */
#ifndef CDEM_RUN_EXPORT_H
#define CDEM_RUN_EXPORT_H

#include "run/run.h"

enum { CDEM_EXPORTS = 8 };

typedef struct {
  const char *path; /* a table (.csv), a case (.yaml), or the folder of a run */
  int outputs;
  const char *const *output; /* [outputs] at most CDEM_EXPORTS */
  double density;            /* kg/m^3, of the grains of a table; NaN: none */
  double thickness;          /* m, of its discs */
  int threads;
  const cdem_warnings *warnings;
} cdem_export_options;

typedef struct {
  int dim;
  int64_t grains;
  double time;                  /* s, of the state; NaN: of a table */
  char lost[CDEM_EXPORTS][256]; /* what each file lacks */
} cdem_export_summary;

/* CDEM_INPUT for everything a user can have wrong: a case of something else than grains alone, a
 * folder without a checkpoint, a table whose grains need a density and have none, an ending. */
cdem_status cdem_export(const cdem_export_options *options, cdem_export_summary *summary,
                        cdem_fault *fault);

#endif
