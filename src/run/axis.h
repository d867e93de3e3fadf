/* Axes and legends in units that keep their numbers short, for the figures of a run and whoever
 * shows its numbers. */
#ifndef CDEM_RUN_AXIS_H
#define CDEM_RUN_AXIS_H

#include "results/results.h"

/* A unit with the SI prefix that keeps its numbers short: 0.0004 s is drawn as 0.4 ms. */
typedef struct {
  double factor;
  char unit[40];
} cdem_run_axis;

cdem_run_axis cdem_run_axis_for(const char *unit, double largest);
double cdem_run_largest(const double *value, int64_t count);
void cdem_run_rescale(double *value, int64_t count, double factor);

enum { CDEM_RUN_LABEL = 200 };
/* "reaction.top_y [N]" with underscores as they are: gnuplot's markup is switched off. unit "":
 * none.
 */
void cdem_run_label(const char *name, const char *unit, char text[CDEM_RUN_LABEL]);
/* A column as the case names it: in full, or the bare name of a probe; -1 when there is none. */
int cdem_run_history_find(const cdem_table *table, const char *name);
/* A probe's own name, without "probe.". */
const char *cdem_run_bare_name(const cdem_table *history, int column);
/* A column times a scale as a new array [history->rows]; NaN where it has no value. */
cdem_status cdem_run_column_values(const cdem_table *history, int column, double scale,
                                   double **values, cdem_fault *fault);

#endif
