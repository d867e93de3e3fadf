/* Figures of a run: the curves of the case, the energies, and the last state by its engine. */
#include "run/axis.h"
#include "run/summary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CURVES = 8, LABEL = CDEM_RUN_LABEL };

/* Columns as arrays, and texts with gnuplot's markup switched off. */
typedef struct {
  double *x, *y[MOST_CURVES];
  char title[MOST_CURVES][LABEL];
  cdem_curve curve[MOST_CURVES];
  int curves;
} curve_set;

static void curve_set_release(curve_set *set) {
  free(set->x);
  for (int i = 0; i < MOST_CURVES; i++)
    free(set->y[i]);
}

static cdem_status add_curve(const cdem_table *history, int column, double scale, curve_set *set,
                             cdem_fault *fault) {
  int i = set->curves;
  if (i == MOST_CURVES)
    return CDEM_OK;
  CDEM_TRY(cdem_run_column_values(history, column, scale, &set->y[i], fault));
  cdem_run_label(cdem_run_bare_name(history, column), "", set->title[i]);
  set->curve[i] = (cdem_curve){
      .title = set->title[i], .x = set->x, .y = set->y[i], .points = history->rows, .style = i};
  set->curves++;
  return CDEM_OK;
}

/* Puts x into a short unit, and all y into one. */
static cdem_run_axis shorten_x(curve_set *set, const char *unit, int64_t rows) {
  cdem_run_axis found = cdem_run_axis_for(unit, cdem_run_largest(set->x, rows));
  cdem_run_rescale(set->x, rows, found.factor);
  return found;
}

static double largest_y(const curve_set *set, int64_t rows) {
  double largest = 0.0;
  for (int i = 0; i < set->curves; i++)
    largest = fmax(largest, cdem_run_largest(set->y[i], rows));
  return largest;
}

static cdem_run_axis shorten_y(curve_set *set, const char *unit, double largest, int64_t rows) {
  cdem_run_axis found = cdem_run_axis_for(unit, largest);
  for (int i = 0; i < set->curves; i++)
    cdem_run_rescale(set->y[i], rows, found.factor);
  return found;
}

/* ---- the curves of the case ---- */

static cdem_status fill_curve(const cdem_case_curve *wanted, const cdem_table *history,
                              curve_set *set, char labels[2][LABEL], cdem_fault *fault) {
  int x = cdem_run_history_find(history, wanted->x != NULL ? wanted->x : "time");
  CDEM_TRY(cdem_run_column_values(history, x, wanted->x_scale, &set->x, fault));
  int y = 0;
  for (int64_t i = 0; i < wanted->y.count; i++) {
    y = cdem_run_history_find(history, wanted->y.item[i]);
    CDEM_TRY(add_curve(history, y, wanted->y_scale, set, fault));
  }
  /* A scaled column is no longer in its unit, and a label of the case knows its own. */
  cdem_run_axis unit[2] = {{.factor = 1.0}, {.factor = 1.0}};
  if (fabs(wanted->x_scale) == 1.0 && wanted->x_label == NULL)
    unit[0] = shorten_x(set, history->column[x].unit, history->rows);
  if (fabs(wanted->y_scale) == 1.0 && wanted->y_label == NULL)
    unit[1] = shorten_y(set, history->column[y].unit, largest_y(set, history->rows), history->rows);
  cdem_run_label(cdem_run_bare_name(history, x), unit[0].unit, labels[0]);
  cdem_run_label(wanted->y.count == 1 ? cdem_run_bare_name(history, y) : "", unit[1].unit,
                 labels[1]);
  if (set->curves == 1)
    set->curve[0].title = NULL;
  return CDEM_OK;
}

static cdem_status draw_curve(const cdem_run_output *output, const cdem_case_curve *wanted,
                              const char *folder, const cdem_table *history, cdem_fault *fault) {
  (void)output;
  curve_set set = {0};
  char labels[2][LABEL];
  cdem_status status = fill_curve(wanted, history, &set, labels, fault);
  if (status == CDEM_OK) {
    const cdem_panel panel = {.title = "",
                              .x_label = wanted->x_label != NULL ? wanted->x_label : labels[0],
                              .y_label = wanted->y_label != NULL ? wanted->y_label : labels[1],
                              .curves = set.curves,
                              .curve = set.curve};
    const cdem_figure figure = {.title = wanted->title != NULL ? wanted->title : wanted->name,
                                .columns = 1,
                                .panels = 1,
                                .panel = &panel};
    status = cdem_write_figure(folder, wanted->name, &figure, fault);
  }
  curve_set_release(&set);
  return status;
}

/* ---- energies ---- */

static bool is_zero(const cdem_table *history, int column) {
  for (int64_t r = 0; r < history->rows; r++) {
    const cdem_value *value = cdem_table_at(history, r, column);
    if (!value->absent && value->real != 0.0)
      return false;
  }
  return true;
}

static cdem_status fill_energies(const cdem_table *history, const cdem_run_energy_panel *group,
                                 curve_set *set, cdem_fault *fault) {
  CDEM_TRY(cdem_run_column_values(history, cdem_table_find(history, "time"), 1.0, &set->x, fault));
  for (int i = 0; i < CDEM_RUN_PANEL_COLUMNS && group->column[i] != NULL; i++) {
    int column = cdem_table_find(history, group->column[i]);
    if (column >= 0 && !is_zero(history, column))
      CDEM_TRY(add_curve(history, column, 1.0, set, fault));
  }
  return CDEM_OK;
}

static cdem_status draw_energies(const cdem_run_energy_panel energies[CDEM_RUN_PANELS],
                                 const char *folder, const cdem_table *history, cdem_fault *fault) {
  curve_set set[CDEM_RUN_PANELS] = {{0}};
  cdem_panel panel[CDEM_RUN_PANELS];
  char labels[2][64];
  int panels = 0;
  double largest = 0.0;
  cdem_status status = CDEM_OK;
  for (int g = 0; status == CDEM_OK && g < CDEM_RUN_PANELS; g++) {
    status = fill_energies(history, &energies[g], &set[g], fault);
    largest = status == CDEM_OK ? fmax(largest, largest_y(&set[g], history->rows)) : 0.0;
  }
  for (int g = 0; status == CDEM_OK && g < CDEM_RUN_PANELS; g++) {
    cdem_run_axis time = shorten_x(&set[g], "s", history->rows),
                  joule = shorten_y(&set[g], "J", largest, history->rows);
    snprintf(labels[0], sizeof labels[0], "time [%s]", time.unit);
    snprintf(labels[1], sizeof labels[1], "energy [%s]", joule.unit);
    if (set[g].curves > 0)
      panel[panels++] = (cdem_panel){.title = energies[g].title,
                                     .x_label = labels[0],
                                     .y_label = labels[1],
                                     .curves = set[g].curves,
                                     .curve = set[g].curve};
  }
  const cdem_figure figure = {
      .title = "Energy", .columns = panels, .panels = panels, .panel = panel};
  if (status == CDEM_OK && panels > 0)
    status = cdem_write_figure(folder, "energies", &figure, fault);
  for (int g = 0; g < CDEM_RUN_PANELS; g++)
    curve_set_release(&set[g]);
  return status;
}

/* ---- all ---- */

static cdem_status draw_all(cdem_run_output *output, const cdem_table *history, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(output->setup);
  char folder[4096];
  cdem_run_path(folder, output->options->folder, "figures");
  for (int64_t i = 0; history->rows > 1 && i < values->curves.count; i++)
    CDEM_TRY(draw_curve(output, &values->curves.item[i], folder, history, fault));
  if (history->rows > 1)
    CDEM_TRY(draw_energies(output->setup->engine->energies, folder, history, fault));
  return output->setup->engine->pictures(output->setup, folder, "", fault);
}

/* Pictures that cannot be drawn are a warning: the run itself is whole. */
static cdem_status forgive(const cdem_run_output *output, cdem_status status,
                           const cdem_fault *found, cdem_fault *fault) {
  const cdem_warnings *warnings = output->options->warnings;
  if (status == CDEM_FILE || status == CDEM_INPUT) {
    if (warnings != NULL && warnings->warn != NULL)
      warnings->warn(warnings->context, found->message);
    return CDEM_OK;
  }
  return status == CDEM_OK ? CDEM_OK : cdem_fail(fault, status, "%s", found->message);
}

cdem_status cdem_run_figures(cdem_run_output *output, const cdem_table *history,
                             cdem_fault *fault) {
  cdem_fault local = {0};
  return forgive(output, draw_all(output, history, &local), &local, fault);
}

cdem_status cdem_run_figures_at(cdem_run_output *output, double time, cdem_fault *fault) {
  cdem_fault local = {0};
  char folder[4096], tag[64];
  const cdem_run_axis axis = cdem_run_axis_for("s", time);
  snprintf(tag, sizeof tag, "-%.4g%s", axis.factor * time, axis.unit);
  cdem_run_path(folder, output->options->folder, "figures");
  cdem_status status = output->setup->engine->pictures(output->setup, folder, tag, &local);
  return forgive(output, status, &local, fault);
}
