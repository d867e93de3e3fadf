/* Private to run: the files of a run folder while it runs, and how far they have come. */
#ifndef CDEM_RUN_OUTPUT_H
#define CDEM_RUN_OUTPUT_H

#include "io/run_files.h"
#include "run/history.h"

/* What a checkpoint keeps beside the solver's state. */
typedef struct {
  int64_t rows, frames;                          /* written so far */
  int64_t next_row, next_frame, next_checkpoint; /* in multiples of their times */
  int64_t last_row_step, last_frame_step;        /* steps at which they were written; -1 */
  double peak;                                   /* of the column that may end the run */
  double wall;                                   /* s, of this run before this start */
} cdem_run_counters;

typedef struct {
  cdem_run_setup *setup;
  const cdem_run_options *options;
  cdem_table history; /* columns, and at most one row */
  cdem_history_writer *rows;
  cdem_frame_writer *frames; /* NULL: none are written */
  cdem_run_counters counters;
  int64_t stride;        /* steps at once that the clock allows at present */
  double started, saved; /* s, monotonic clock */
  double ended;          /* likewise, once the loop is over; 0 before */
  bool over;             /* nothing is left to step: a checkpoint says so */
} cdem_run_output;

/* Opens the files of options->folder. checkpoint NULL: a new run, of which row 0, frame 0 and a
 * first checkpoint are written; else the solver has been restored, and files are cut back. */
cdem_status cdem_run_output_open(cdem_run_setup *setup, const cdem_state *checkpoint,
                                 cdem_run_output *output, cdem_fault *fault);
void cdem_run_output_close(cdem_run_output *output);

/* A row (*stop: the column that may end the run has fallen far enough), a frame, a checkpoint. The
 * first two do nothing when this step has one. */
cdem_status cdem_run_output_row(cdem_run_output *output, bool *stop, cdem_fault *fault);
cdem_status cdem_run_output_frame(cdem_run_output *output, cdem_fault *fault);
cdem_status cdem_run_output_checkpoint(cdem_run_output *output, cdem_fault *fault);

/* Wall time of the run so far, s. */
double cdem_run_output_wall(const cdem_run_output *output);
double cdem_run_clock(void);

/* loop.c: runs to the end of the case. */
cdem_status cdem_run_loop(cdem_run_output *output, cdem_fault *fault);

/* "FOLDER/NAME" into text [4096]. */
const char *cdem_run_path(char text[4096], const char *folder, const char *name);

#endif
