/* Figures of a run: the curves of the case, the energies, and the last state with its cracks. */
#include "results/map.h"
#include "run/summary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CURVES = 8, LABEL = 200 };

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

/* "reaction.top_y [N]" with underscores as they are. */
static void label(const char *name, const char *unit, char text[LABEL]) {
  size_t used = 0;
  for (const char *c = name; *c != '\0' && used + 24 < LABEL; c++) {
    if (strchr("_^{}\\", *c) != NULL)
      text[used++] = '\\';
    text[used++] = *c;
  }
  snprintf(text + used, LABEL - used, "%s%.16s%s", unit[0] != '\0' ? " [" : "", unit,
           unit[0] != '\0' ? "]" : "");
}

/* A probe's own name, without "probe.". */
static const char *bare_name(const cdem_table *history, int column) {
  const char *name = history->column[column].name;
  return name + (strncmp(name, "probe.", 6) == 0 ? 6 : 0);
}

static cdem_status column_values(const cdem_table *history, int column, double scale,
                                 double **values, cdem_fault *fault) {
  CDEM_NEW(*values, history->rows, fault);
  for (int64_t r = 0; r < history->rows; r++) {
    const cdem_value *value = cdem_table_at(history, r, column);
    (*values)[r] = value->absent ? NAN : scale * value->real;
  }
  return CDEM_OK;
}

static cdem_status add_curve(const cdem_table *history, int column, double scale, curve_set *set,
                             cdem_fault *fault) {
  int i = set->curves;
  if (i == MOST_CURVES)
    return CDEM_OK;
  CDEM_TRY(column_values(history, column, scale, &set->y[i], fault));
  label(bare_name(history, column), "", set->title[i]);
  set->curve[i] = (cdem_curve){
      .title = set->title[i], .x = set->x, .y = set->y[i], .points = history->rows, .style = i};
  set->curves++;
  return CDEM_OK;
}

/* ---- units ---- */

/* An axis in the SI prefix that keeps its numbers short: 0.0004 s is drawn as 0.4 ms. */
typedef struct {
  double factor;
  char unit[40];
} axis_unit;

static axis_unit unit_for(const char *unit, double largest) {
  static const char *const prefixed[] = {"s", "m", "m/s", "N", "N m", "Pa", "J"};
  static const struct {
    double size;
    const char *symbol;
  } prefix[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"}, {1.0, ""},
                {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}};
  axis_unit found = {.factor = 1.0};
  snprintf(found.unit, sizeof found.unit, "%.30s", unit);
  bool known = false;
  for (size_t i = 0; i < sizeof prefixed / sizeof prefixed[0]; i++)
    known = known || strcmp(unit, prefixed[i]) == 0;
  for (size_t i = 0; known && largest > 0.0 && i < sizeof prefix / sizeof prefix[0]; i++)
    if (largest * (1.0 + 1e-6) >= prefix[i].size || i + 1 == sizeof prefix / sizeof prefix[0]) {
      found.factor = 1.0 / prefix[i].size;
      snprintf(found.unit, sizeof found.unit, "%s%.30s", prefix[i].symbol, unit);
      break;
    }
  return found;
}

static double largest_of(const double *value, int64_t count) {
  double largest = 0.0;
  for (int64_t i = 0; i < count; i++)
    if (fabs(value[i]) > largest)
      largest = fabs(value[i]);
  return largest;
}

static void rescale(double *value, int64_t count, double factor) {
  for (int64_t i = 0; i < count; i++)
    value[i] *= factor;
}

/* Puts x into a short unit, and all y into one. */
static axis_unit shorten_x(curve_set *set, const char *unit, int64_t rows) {
  axis_unit found = unit_for(unit, largest_of(set->x, rows));
  rescale(set->x, rows, found.factor);
  return found;
}

static double largest_y(const curve_set *set, int64_t rows) {
  double largest = 0.0;
  for (int i = 0; i < set->curves; i++)
    largest = fmax(largest, largest_of(set->y[i], rows));
  return largest;
}

static axis_unit shorten_y(curve_set *set, const char *unit, double largest, int64_t rows) {
  axis_unit found = unit_for(unit, largest);
  for (int i = 0; i < set->curves; i++)
    rescale(set->y[i], rows, found.factor);
  return found;
}

/* ---- the curves of the case ---- */

static cdem_status fill_curve(const cdem_case_curve *wanted, const cdem_table *history,
                              curve_set *set, char labels[2][LABEL], cdem_fault *fault) {
  int x = cdem_run_history_find(history, wanted->x != NULL ? wanted->x : "time");
  CDEM_TRY(column_values(history, x, wanted->x_scale, &set->x, fault));
  int y = 0;
  for (int64_t i = 0; i < wanted->y.count; i++) {
    y = cdem_run_history_find(history, wanted->y.item[i]);
    CDEM_TRY(add_curve(history, y, wanted->y_scale, set, fault));
  }
  /* A scaled column is no longer in its unit, and a label of the case knows its own. */
  axis_unit unit[2] = {{.factor = 1.0}, {.factor = 1.0}};
  if (fabs(wanted->x_scale) == 1.0 && wanted->x_label == NULL)
    unit[0] = shorten_x(set, history->column[x].unit, history->rows);
  if (fabs(wanted->y_scale) == 1.0 && wanted->y_label == NULL)
    unit[1] = shorten_y(set, history->column[y].unit, largest_y(set, history->rows), history->rows);
  label(bare_name(history, x), unit[0].unit, labels[0]);
  label(wanted->y.count == 1 ? bare_name(history, y) : "", unit[1].unit, labels[1]);
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

typedef struct {
  const char *title;
  const char *column[6];
} energy_group;

static const energy_group energies[3] = {
    {"stored", {"kinetic", "elastic", "interface", "contact", "plate"}},
    {"dissipated", {"fracture", "friction", "damping", "quiet"}},
    {"work done", {"load", "gravity", "support"}}};

static bool is_zero(const cdem_table *history, int column) {
  for (int64_t r = 0; r < history->rows; r++) {
    const cdem_value *value = cdem_table_at(history, r, column);
    if (!value->absent && value->real != 0.0)
      return false;
  }
  return true;
}

static cdem_status fill_energies(const cdem_table *history, const energy_group *group,
                                 curve_set *set, cdem_fault *fault) {
  CDEM_TRY(column_values(history, cdem_table_find(history, "time"), 1.0, &set->x, fault));
  for (int i = 0; i < 6 && group->column[i] != NULL; i++) {
    int column = cdem_table_find(history, group->column[i]);
    if (column >= 0 && !is_zero(history, column))
      CDEM_TRY(add_curve(history, column, 1.0, set, fault));
  }
  return CDEM_OK;
}

static cdem_status draw_energies(const char *folder, const cdem_table *history, cdem_fault *fault) {
  curve_set set[3] = {{0}};
  cdem_panel panel[3];
  char labels[2][64];
  int panels = 0;
  double largest = 0.0;
  cdem_status status = CDEM_OK;
  for (int g = 0; status == CDEM_OK && g < 3; g++) {
    status = fill_energies(history, &energies[g], &set[g], fault);
    largest = status == CDEM_OK ? fmax(largest, largest_y(&set[g], history->rows)) : 0.0;
  }
  for (int g = 0; status == CDEM_OK && g < 3; g++) {
    axis_unit time = shorten_x(&set[g], "s", history->rows),
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
  for (int g = 0; g < 3; g++)
    curve_set_release(&set[g]);
  return status;
}

/* ---- the last state ---- */

typedef struct {
  cdem_map map;
  bool flat, cracks, far, drawn; /* far: the body, or a part of it, has moved */
  int64_t failed;                /* lines of failed faces */
  char label[80];
} picture;

static const double view_flat[3] = {0, 0, -1}, view_solid[3] = {-0.5, 0.75, -0.5};
static const double up_flat[3] = {0, 1, 0}, up_solid[3] = {0, 0, 1};

static bool has_field(const cdem_frame *frame, const char *name) {
  for (int f = 0; f < frame->fields; f++)
    if (strcmp(frame->field[f].name, name) == 0)
      return true;
  return false;
}

/* Cracks and motion show best by displacements; a body in its place by its largest principal
 * stress. */
static cdem_status take_body(picture *p, const cdem_frame *frame, cdem_fault *fault) {
  bool moved = p->cracks || p->far || !has_field(frame, "stress");
  CDEM_TRY(cdem_map_from_frame(frame, moved ? "displacement" : "stress", moved ? -1 : -2,
                               p->flat ? view_flat : view_solid, p->flat ? up_flat : up_solid, 0.0,
                               &p->map, fault));
  p->drawn = true;
  axis_unit unit = unit_for(moved ? "m" : "Pa", largest_of(p->map.value, p->map.polygons));
  rescale(p->map.value, p->map.polygons, unit.factor);
  snprintf(p->label, sizeof p->label, "%s [%s]",
           moved ? "displacement" : "largest principal stress", unit.unit);
  p->map.value_label = p->label;
  p->map.diverging = !moved;
  return CDEM_OK;
}

/* Faces in one state as lines; a state that is nowhere has no entry in the legend. */
static cdem_status add_state(picture *p, const cdem_frame *frame, cdem_interface_state state,
                             const char *title, const char *colour, cdem_fault *fault) {
  CDEM_TRY(cdem_map_add_lines(&p->map, frame, "state", 1u << state,
                              p->flat ? view_flat : view_solid, p->flat ? up_flat : up_solid, title,
                              colour, 1.6, fault));
  cdem_map_lines *lines = &p->map.lines[p->map.line_sets - 1];
  p->failed += state != CDEM_INTERFACE_SOFTENING ? lines->segments : 0;
  lines->title = lines->segments > 0 ? title : NULL;
  return CDEM_OK;
}

/* What softens is shown as long as nothing has failed; after that it would hide the cracks. */
static cdem_status take_frame(void *context, const cdem_frame *frame, cdem_fault *fault) {
  picture *p = context;
  if (strcmp(frame->set, "body") == 0)
    return take_body(p, frame, fault);
  if (strcmp(frame->set, "interfaces") != 0 || !p->drawn)
    return CDEM_OK;
  CDEM_TRY(
      add_state(p, frame, CDEM_INTERFACE_TENSION_FAILED, "failed in tension", "#d7191c", fault));
  CDEM_TRY(add_state(p, frame, CDEM_INTERFACE_SHEAR_FAILED, "failed in shear", "#2166ac", fault));
  return p->failed > 0
             ? CDEM_OK
             : add_state(p, frame, CDEM_INTERFACE_SOFTENING, "softening", "#999999", fault);
}

/* Has anything moved by more than a hundredth of the size of all? Strains alone do not do that. */
static bool has_moved(const cdem_run_setup *setup) {
  const cdem_solver *solver = &setup->solver;
  const double *xyz = setup->blocks.mesh.xyz;
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  double largest = 0.0, size = 0.0;
  for (int64_t n = 0; n < solver->nodes; n++)
    for (int k = 0; k < setup->model.dimension; k++) {
      low[k] = fmin(low[k], xyz[3 * n + k]);
      high[k] = fmax(high[k], xyz[3 * n + k]);
      largest = fmax(largest, fabs(solver->u[n * solver->dofs + k]));
    }
  for (int k = 0; k < setup->model.dimension; k++)
    size = fmax(size, high[k] - low[k]);
  return largest > 0.01 * size;
}

static cdem_status draw_pattern(cdem_run_output *output, const char *folder, cdem_fault *fault) {
  const cdem_run_setup *setup = output->setup;
  picture p = {.flat = setup->model.dimension == 2,
               .cracks = setup->has_interfaces,
               .far = has_moved(setup)};
  const cdem_frame_sink sink = {.context = &p, .frame = take_frame};
  char title[80];
  cdem_status status = cdem_solver_frames(&setup->solver, 0, &sink, fault);
  if (status == CDEM_OK && p.drawn) {
    axis_unit time = unit_for("s", setup->solver.time);
    snprintf(title, sizeof title, "t = %.4g %s", time.factor * setup->solver.time, time.unit);
    bool steps = cdem_run_values(setup)->analysis == CDEM_ANALYSIS_DYNAMIC;
    p.map.title = steps ? title : "";
    p.map.x_label = p.flat ? "x [m]" : NULL;
    p.map.y_label = p.flat ? "y [m]" : NULL;
    p.map.outlines = setup->model.cells <= 20000;
    status = cdem_write_map(folder, "pattern", &p.map, fault);
  }
  cdem_map_release(&p.map);
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
    CDEM_TRY(draw_energies(folder, history, fault));
  return draw_pattern(output, folder, fault);
}

cdem_status cdem_run_figures(cdem_run_output *output, const cdem_table *history,
                             cdem_fault *fault) {
  cdem_fault local = {0};
  cdem_status status = draw_all(output, history, &local);
  const cdem_warnings *warnings = output->options->warnings;
  if (status == CDEM_FILE || status == CDEM_INPUT) { /* the run itself is whole */
    if (warnings != NULL && warnings->warn != NULL)
      warnings->warn(warnings->context, local.message);
    return CDEM_OK;
  }
  return status == CDEM_OK ? CDEM_OK : cdem_fail(fault, status, "%s", local.message);
}
