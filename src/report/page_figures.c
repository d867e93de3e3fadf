/* Figures: the curves of the case, drawn here from the history, and the pictures of the run. */
#include "report/chart.h"
#include "report/source.h"
#include "run/axis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL = CDEM_RUN_LABEL, MOST_PROBES = 6 };

/* A curve of the case, or one made up like it: columns over a column. */
typedef struct {
  const char *title;
  const char *x; /* NULL: time */
  int columns;
  const char *column[CDEM_REPORT_STYLES];
  double x_scale, y_scale;
  const char *x_label, *y_label; /* NULL: column and unit */
} wanted;

typedef struct {
  double *x, *y[CDEM_REPORT_STYLES];
  char title[CDEM_REPORT_STYLES][LABEL];
  cdem_curve curve[CDEM_REPORT_STYLES];
  int curves;
} drawn;

static void release(drawn *d) {
  free(d->x);
  for (int i = 0; i < d->curves; i++)
    free(d->y[i]);
}

/* A scaled column is no longer in its unit, and a label of the case knows its own. */
static void shorten_all(const wanted *w, const cdem_table *history, int x, int y, drawn *d,
                        cdem_run_axis unit[2]) {
  int64_t rows = history->rows;
  double largest = 0.0;
  unit[0] = unit[1] = (cdem_run_axis){.factor = 1.0};
  if (fabs(w->x_scale) == 1.0 && w->x_label == NULL)
    unit[0] = cdem_run_axis_for(history->column[x].unit, cdem_run_largest(d->x, rows));
  for (int i = 0; i < d->curves; i++)
    largest = fmax(largest, cdem_run_largest(d->y[i], rows));
  if (fabs(w->y_scale) == 1.0 && w->y_label == NULL)
    unit[1] = cdem_run_axis_for(history->column[y].unit, largest);
  cdem_run_rescale(d->x, rows, unit[0].factor);
  for (int i = 0; i < d->curves; i++)
    cdem_run_rescale(d->y[i], rows, unit[1].factor);
}

static void draw(const cdem_report_source *source, const wanted *w, cdem_report_text *to,
                 cdem_report_made *made) {
  const cdem_table *history = &source->history;
  drawn d = {0};
  char labels[2][LABEL];
  cdem_run_axis unit[2];
  int x = cdem_run_history_find(history, w->x != NULL ? w->x : "time"), y = x;
  d.x = cdem_report_column(source, x, w->x_scale, to);
  for (int i = 0; i < w->columns && to->status == CDEM_OK; i++) {
    y = cdem_run_history_find(history, w->column[i]);
    d.y[d.curves++] = cdem_report_column(source, y, w->y_scale, to);
    cdem_run_label(cdem_run_bare_name(history, y), "", d.title[i]);
    d.curve[i] = (cdem_curve){.title = w->columns > 1 ? d.title[i] : NULL,
                              .x = d.x,
                              .y = d.y[i],
                              .points = history->rows,
                              .style = i};
  }
  if (to->status == CDEM_OK) {
    shorten_all(w, history, x, y, &d, unit);
    cdem_run_label(cdem_run_bare_name(history, x), unit[0].unit, labels[0]);
    cdem_run_label(w->columns == 1 ? cdem_run_bare_name(history, y) : "", unit[1].unit, labels[1]);
    const cdem_report_chart chart = {.title = w->title,
                                     .x_label = w->x_label != NULL ? w->x_label : labels[0],
                                     .y_label = w->y_label != NULL ? w->y_label : labels[1],
                                     .curves = d.curves,
                                     .curve = d.curve};
    cdem_report_chart_put(to, &chart);
    made->charts++;
  }
  release(&d);
}

/* ---- which ---- */

static void draw_case(const cdem_report_source *source, const cdem_case_curve *curve,
                      cdem_report_text *to, cdem_report_made *made) {
  wanted w = {.title = curve->title != NULL ? curve->title : curve->name,
              .x = curve->x,
              .x_scale = curve->x_scale,
              .y_scale = curve->y_scale,
              .x_label = curve->x_label,
              .y_label = curve->y_label};
  for (int64_t i = 0; i < curve->y.count && i < CDEM_REPORT_STYLES; i++)
    w.column[w.columns++] = curve->y.item[i];
  draw(source, &w, to, made);
}

/* What a triaxial test is made for, where its case names no curves. */
static const wanted triaxial[] = {{.title = "Stress on the plates and on the side",
                                   .x = "axial_strain",
                                   .columns = 3,
                                   .column = {"axial_stress", "bottom_stress", "lateral_stress"},
                                   .x_scale = 1.0,
                                   .y_scale = 1.0,
                                   .x_label = "axial strain"},
                                  {.title = "Volume against axial strain",
                                   .x = "axial_strain",
                                   .columns = 1,
                                   .column = {"volumetric_strain"},
                                   .x_scale = 1.0,
                                   .y_scale = 1.0,
                                   .x_label = "axial strain",
                                   .y_label = "volumetric strain"}};

static bool has_all(const cdem_table *history, const wanted *w) {
  bool all = history->rows >= 2 && cdem_run_history_find(history, w->x) >= 0;
  for (int i = 0; i < w->columns; i++)
    all = all && cdem_run_history_find(history, w->column[i]) >= 0;
  return all;
}

/* The probes over time, where a case names neither curves nor a triaxial test. */
static int probes_shown(const cdem_report_source *source) {
  const cdem_case_values *values = &source->cases.values;
  int count = 0;
  for (int64_t p = 0; source->history.rows >= 2 && p < values->probes.count; p++)
    count += cdem_run_history_find(&source->history, values->probes.item[p].name) >= 0;
  return count < MOST_PROBES ? count : MOST_PROBES;
}

static void draw_probes(const cdem_report_source *source, cdem_report_text *to,
                        cdem_report_made *made) {
  const cdem_case_values *values = &source->cases.values;
  int left = probes_shown(source);
  for (int64_t p = 0; p < values->probes.count && left > 0; p++) {
    char title[LABEL];
    const char *name = values->probes.item[p].name;
    cdem_run_label(name, "", title);
    const wanted w = {
        .title = title, .columns = 1, .column = {name}, .x_scale = 1.0, .y_scale = 1.0};
    if (cdem_run_history_find(&source->history, name) < 0)
      continue;
    draw(source, &w, to, made);
    left--;
  }
}

static bool has_curves(const cdem_report_source *source) {
  const cdem_case_values *values = &source->cases.values;
  for (int64_t i = 0; i < values->curves.count; i++)
    if (cdem_report_has_columns(source, &values->curves.item[i]))
      return true;
  return cdem_case_is_triaxial(&source->cases) ? has_all(&source->history, &triaxial[0])
                                               : probes_shown(source) > 0;
}

static void draw_curves(const cdem_report_source *source, cdem_report_text *to,
                        cdem_report_made *made) {
  const cdem_case_values *values = &source->cases.values;
  bool test = cdem_case_is_triaxial(&source->cases);
  for (int64_t i = 0; i < values->curves.count; i++)
    if (cdem_report_has_columns(source, &values->curves.item[i]))
      draw_case(source, &values->curves.item[i], to, made);
  for (size_t i = 0; test && i < sizeof triaxial / sizeof triaxial[0]; i++)
    if (has_all(&source->history, &triaxial[i]))
      draw(source, &triaxial[i], to, made);
  if (!test && values->curves.count == 0)
    draw_probes(source, to, made);
}

/* ---- pictures ---- */

static void put_picture(const cdem_report_source *source, const cdem_report_picture *picture,
                        cdem_report_text *to) {
  cdem_report_raw(to, "<figure class=\"picture\"><figcaption>");
  cdem_report_words(to, picture->name);
  cdem_report_raw(to, "</figcaption><a href=\"");
  cdem_report_link(to, source->way);
  cdem_report_link(to, picture->file);
  cdem_report_format(to, "\"><img alt=\"Picture of the run: ");
  cdem_report_words(to, picture->name);
  cdem_report_format(to, "\" src=\"data:%s;base64,", picture->type);
  cdem_report_base64(to, picture->data, picture->bytes);
  cdem_report_raw(to, "\"/></a></figure>\n");
}

static void put_linked(const cdem_report_source *source, cdem_report_text *to,
                       cdem_report_made *made) {
  cdem_report_raw(to, "<p class=\"note\">Too large to be put into this page:");
  for (int i = 0; i < source->pictures; i++)
    if (source->picture[i].data == NULL) {
      cdem_report_raw(to, made->linked++ > 0 ? ", <a href=\"" : " <a href=\"");
      cdem_report_link(to, source->way);
      cdem_report_link(to, source->picture[i].file);
      cdem_report_raw(to, "\">");
      cdem_report_words(to, source->picture[i].name);
      cdem_report_raw(to, "</a>");
    }
  cdem_report_raw(to, ".</p>\n");
}

bool cdem_report_has_figures(const cdem_report_source *source) {
  return source->pictures > 0 || has_curves(source);
}

void cdem_report_put_figures(const cdem_report_source *source, cdem_report_text *to,
                             cdem_report_made *made) {
  bool linked = false;
  cdem_report_raw(to, "<div class=\"grid\">\n");
  draw_curves(source, to, made);
  for (int i = 0; i < source->pictures; i++) {
    linked = linked || source->picture[i].data == NULL;
    if (source->picture[i].data == NULL)
      continue;
    put_picture(source, &source->picture[i], to);
    made->pictures++;
  }
  cdem_report_raw(to, "</div>\n");
  if (linked)
    put_linked(source, to, made);
}
