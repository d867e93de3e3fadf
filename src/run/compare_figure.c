/* Curves of several runs in one figure: a panel a column, a curve a run. */
#include "run/axis.h"
#include "run/compare.h"
#include "run/compared.h"
#include "run/history.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RUNS = CDEM_COMPARE_MOST_CURVES, PANELS = CDEM_COMPARE_MOST_PANELS };

typedef struct {
  const cdem_compare_figure *wanted;
  cdem_table history[RUNS];
  char *name[RUNS], legend[RUNS][CDEM_RUN_LABEL];
  double *x[RUNS], *y[PANELS][RUNS];
  char x_label[CDEM_RUN_LABEL], y_label[PANELS][CDEM_RUN_LABEL];
  cdem_curve curve[PANELS][RUNS];
  cdem_panel panel[PANELS];
  bool named[RUNS]; /* has an entry in the legend of some panel */
} sheet;

static void sheet_release(sheet *s) {
  for (int r = 0; r < RUNS; r++) {
    cdem_table_release(&s->history[r]);
    free(s->name[r]);
    free(s->x[r]);
    for (int p = 0; p < PANELS; p++)
      free(s->y[p][r]);
  }
}

static cdem_status read_all(sheet *s, cdem_fault *fault) {
  const cdem_compare_figure *wanted = s->wanted;
  for (int r = 0; r < wanted->runs; r++) {
    CDEM_TRY(cdem_compared_check(wanted->folder[r], fault));
    CDEM_TRY(cdem_compared_history(wanted->folder[r], &s->history[r], fault));
  }
  CDEM_TRY(cdem_compared_names(wanted->runs, wanted->folder, s->name, fault));
  for (int r = 0; r < wanted->runs; r++)
    cdem_run_label(s->name[r], "", s->legend[r]);
  return CDEM_OK;
}

/* The column in the first run that has it, and its unit, which all others must share. */
static cdem_status find_unit(const sheet *s, const char *name, int *first, const char **unit,
                             cdem_fault *fault) {
  *first = -1;
  CDEM_TRY(cdem_compared_column(s->history, s->wanted->runs, name, fault));
  for (int r = 0; r < s->wanted->runs; r++) {
    int column = cdem_run_history_find(&s->history[r], name);
    if (column < 0)
      continue;
    const char *other = s->history[r].column[column].unit;
    if (*first < 0) {
      *first = r;
      *unit = other;
    }
    CDEM_REQUIRE(strcmp(*unit, other) == 0, fault, CDEM_INPUT,
                 "'%s' cannot be drawn in one figure: its unit is '%s' in '%s' and '%s' in '%s'",
                 name, *unit, s->name[*first], other, s->name[r]);
  }
  return CDEM_OK;
}

/* A column of each run that has it, in one short unit where neither scale nor label have fixed it;
 * the label of the axis. */
static cdem_status fill_axis(const sheet *s, const char *name, double scale, const char *given,
                             double *values[RUNS], char label[CDEM_RUN_LABEL], cdem_fault *fault) {
  int first;
  const char *unit = "";
  double largest = 0.0;
  CDEM_TRY(find_unit(s, name, &first, &unit, fault));
  for (int r = first; r < s->wanted->runs; r++) {
    int column = cdem_run_history_find(&s->history[r], name);
    if (column < 0)
      continue;
    CDEM_TRY(cdem_run_column_values(&s->history[r], column, scale, &values[r], fault));
    largest = fmax(largest, cdem_run_largest(values[r], s->history[r].rows));
  }
  cdem_run_axis axis = {.factor = 1.0};
  if (fabs(scale) == 1.0 && given == NULL)
    axis = cdem_run_axis_for(unit, largest);
  for (int r = 0; r < s->wanted->runs; r++)
    if (values[r] != NULL)
      cdem_run_rescale(values[r], s->history[r].rows, axis.factor);
  int column = cdem_run_history_find(&s->history[first], name);
  cdem_run_label(cdem_run_bare_name(&s->history[first], column), axis.unit, label);
  return CDEM_OK;
}

/* Rows outside the window are gaps. */
static void cut_window(sheet *s, int run) {
  const cdem_table *history = &s->history[run];
  int clock = cdem_table_find(history, "time");
  for (int64_t i = 0; clock >= 0 && i < history->rows; i++) {
    double time = cdem_table_at(history, i, clock)->real;
    if (time < s->wanted->from || time > s->wanted->to) /* false with NaN */
      s->x[run][i] = NAN;
  }
}

static cdem_status fill_x(sheet *s, cdem_fault *fault) {
  const cdem_compare_figure *wanted = s->wanted;
  const char *name = wanted->x != NULL ? wanted->x : "time";
  CDEM_TRY(fill_axis(s, name, wanted->x_scale, wanted->x_label, s->x, s->x_label, fault));
  for (int r = 0; r < wanted->runs; r++) {
    CDEM_REQUIRE(
        s->x[r] != NULL, fault, CDEM_INPUT,
        "'%s/history.csv' has no column '%s' for the x axis; choose one that all runs have",
        wanted->folder[r], name);
    cut_window(s, r);
  }
  return CDEM_OK;
}

/* A run is named in the first panel in which it is drawn; colours and dashes tell in the others. */
static cdem_status fill_panel(sheet *s, int p, cdem_fault *fault) {
  const cdem_compare_figure *wanted = s->wanted;
  const char *label = wanted->y_label != NULL ? wanted->y_label[p] : NULL;
  int curves = 0;
  CDEM_TRY(fill_axis(s, wanted->column[p], wanted->y_scale, label, s->y[p], s->y_label[p], fault));
  for (int r = 0; r < wanted->runs; r++) {
    const char *own = wanted->label != NULL ? wanted->label[r] : NULL;
    if (s->y[p][r] == NULL)
      continue;
    s->curve[p][curves++] = (cdem_curve){.title = s->named[r]   ? NULL
                                                  : own != NULL ? own
                                                                : s->legend[r],
                                         .x = s->x[r],
                                         .y = s->y[p][r],
                                         .points = s->history[r].rows,
                                         .style = r};
    s->named[r] = true;
  }
  s->panel[p] = (cdem_panel){.title = "",
                             .x_label = wanted->x_label != NULL ? wanted->x_label : s->x_label,
                             .y_label = label != NULL ? label : s->y_label[p],
                             .curves = curves,
                             .curve = s->curve[p]};
  return CDEM_OK;
}

static cdem_status draw(sheet *s, const char *folder, const char *name, cdem_fault *fault) {
  const cdem_compare_figure *wanted = s->wanted;
  CDEM_TRY(read_all(s, fault));
  CDEM_TRY(fill_x(s, fault));
  for (int p = 0; p < wanted->columns; p++)
    CDEM_TRY(fill_panel(s, p, fault));
  const cdem_figure figure = {.title = wanted->title != NULL ? wanted->title : "",
                              .columns = wanted->columns == 4   ? 2
                                         : wanted->columns <= 3 ? wanted->columns
                                                                : 3,
                              .panels = wanted->columns,
                              .panel = s->panel};
  return cdem_write_figure(folder, name, &figure, fault);
}

cdem_status cdem_compare_draw(const cdem_compare_figure *figure, const char *folder,
                              const char *name, cdem_fault *fault) {
  CDEM_REQUIRE(figure->runs >= 1 && figure->runs <= RUNS, fault, CDEM_USAGE,
               "a figure takes 1 to %d runs, not %d", RUNS, figure->runs);
  CDEM_REQUIRE(figure->columns >= 1 && figure->columns <= PANELS, fault, CDEM_USAGE,
               "a figure takes 1 to %d columns, not %d", PANELS, figure->columns);
  sheet s = {.wanted = figure};
  cdem_status status = draw(&s, folder, name, fault);
  sheet_release(&s);
  return status;
}
