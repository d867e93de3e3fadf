/* The look of a figure: sizes in points of the page, colours that stay apart for colour-blind eyes
 * (Okabe and Ito 2008) and, in grey print, by their dashes; a legend that covers no curve. */
#include "io/figure.h"

#include "io/gnuplot.h"
#include "io/text.h"

#include <math.h>
#include <stdbool.h>

/* One panel's axes and what stands around them, in pixels of the simple resolution; the .png has
 * twice as many. The sizes of the legend were measured on drawn figures. */
#define AXES_WIDTH     240.0
#define AXES_HEIGHT    190.0
#define MARGIN_LEFT    66.0
#define MARGIN_RIGHT   14.0
#define MARGIN_BOTTOM  44.0
#define MARGIN_TOP     24.0
#define FIGURE_TITLE   24.0
#define X_LABEL        30.0 /* from the axes down to the middle of the label */
#define Y_LABEL        55.0 /* from the axes to the middle of the label */
#define LETTER_WIDTH   6.7  /* mean advance */
#define LINE_HEIGHT    16.0
#define LEGEND_SAMPLE  34.0
#define LEGEND_PADDING 22.0 /* left and right together */
#define LEGEND_MARGIN  10.0 /* above and below together */

enum { STYLES = 8, SAMPLES = 32 };

static const struct {
  const char *colour, *dashes;
} styles[STYLES] = {
    {"#0072b2", "solid"},      {"#d55e00", "(14,5)"}, {"#009e73", "(14,4,3,4)"},
    {"#cc79a7", "(3,3)"},      {"#e69f00", "(22,5)"}, {"#000000", "(8,4,2,4,2,4)"},
    {"#56b4e9", "(20,4,3,4)"}, {"#8c564b", "(6,3)"},
};

typedef struct {
  double low, high;
} range;

/* ---- data ---- */

static bool has_rings(const cdem_curve *curve) {
  return curve->style >= CDEM_CURVE_RINGS;
}

static bool is_drawn(const cdem_curve *curve, int64_t i) {
  return isfinite(curve->x[i]) && isfinite(curve->y[i]);
}

static void put_point(FILE *stream, double x, double y) {
  char line[2 * CDEM_REAL_WIDTH + 2], *at = cdem_put_real(line, x);
  *at++ = ' ';
  at = cdem_put_real(at, y);
  *at++ = '\n';
  fwrite(line, 1, (size_t)(at - line), stream);
}

/* A gap in a line is one empty line; two would begin the next block. */
static void put_curve(FILE *stream, const cdem_curve *curve) {
  bool begun = false, gap = false;
  for (int64_t i = 0; i < curve->points; i++) {
    if (!is_drawn(curve, i)) {
      gap = begun;
      continue;
    }
    if (gap)
      fputc('\n', stream);
    put_point(stream, curve->x[i], curve->y[i]);
    begun = true;
    gap = false;
  }
  if (!begun)
    fputs("NaN NaN\n", stream);
}

void cdem_figure_put_data(FILE *stream, const cdem_figure *figure) {
  bool first = true;
  for (int p = 0; p < figure->panels; p++)
    for (int c = 0; c < figure->panel[p].curves; c++) {
      const cdem_curve *curve = &figure->panel[p].curve[c];
      fprintf(stream, "%s# panel %d, curve %d: ", first ? "" : "\n\n", p + 1, c + 1);
      for (const char *t = curve->title != NULL ? curve->title : ""; *t != '\0'; t++)
        fputc((unsigned char)*t < ' ' ? ' ' : *t, stream);
      fputc('\n', stream);
      put_curve(stream, curve);
      first = false;
    }
}

/* ---- ranges and the place of the legend ---- */

static void widen(range *r, double value) {
  r->low = value < r->low ? value : r->low;
  r->high = value > r->high ? value : r->high;
}

static range finish_range(range r, double margin) {
  if (!(r.low <= r.high))
    return (range){0.0, 1.0};
  double size = r.high - r.low;
  if (!(size > 1e-12 * fmax(fabs(r.low), fabs(r.high))))
    size = r.low != 0.0 ? fabs(r.low) : 1.0;
  return (range){r.low - margin * size, r.high + margin * size};
}

static range x_range(const cdem_panel *panel) {
  range r = {INFINITY, -INFINITY};
  for (int c = 0; c < panel->curves; c++)
    for (int64_t i = 0; i < panel->curve[c].points; i++)
      if (is_drawn(&panel->curve[c], i))
        widen(&r, panel->curve[c].x[i]);
  return finish_range(r, r.low < r.high ? 0.0 : 0.5);
}

static range y_range(const cdem_panel *panel) {
  if (panel->y_min != panel->y_max)
    return (range){panel->y_min, panel->y_max};
  range r = {INFINITY, -INFINITY};
  for (int c = 0; c < panel->curves; c++)
    for (int64_t i = 0; i < panel->curve[c].points; i++)
      if (is_drawn(&panel->curve[c], i))
        widen(&r, panel->curve[c].y[i]);
  return finish_range(r, 0.05);
}

static bool has_entry(const cdem_curve *curve) {
  return curve->title != NULL && curve->title[0] != '\0';
}

/* Size of the legend as parts of the axes; zero when there is none. */
static void legend_size(const cdem_panel *panel, double *width, double *height) {
  int longest = 0, entries = 0;
  for (int c = 0; c < panel->curves; c++)
    if (has_entry(&panel->curve[c])) {
      int n = cdem_gnuplot_letters(panel->curve[c].title);
      longest = n > longest ? n : longest;
      entries++;
    }
  if (entries == 0) {
    *width = *height = 0.0;
    return;
  }
  *width = (longest * LETTER_WIDTH + LEGEND_SAMPLE + LEGEND_PADDING) / AXES_WIDTH;
  *height = (entries * LINE_HEIGHT + LEGEND_MARGIN) / AXES_HEIGHT;
}

typedef struct {
  const char *key;
  double x, y; /* 0 left or bottom, 0.5 middle, 1 right or top */
} place;

static const place places[] = {{"right top", 1, 1},      {"left top", 0, 1},
                               {"right bottom", 1, 0},   {"left bottom", 0, 0},
                               {"center top", 0.5, 1},   {"center bottom", 0.5, 0},
                               {"right center", 1, 0.5}, {"left center", 0, 0.5}};
enum { PLACES = sizeof places / sizeof places[0] };

/* Points of all lines, sampled along each segment, that fall into the legend's box at a place. */
static int64_t covered(const cdem_panel *panel, range x, range y, const place *at, double width,
                       double height) {
  double left = at->x * (1 - width), bottom = at->y * (1 - height);
  int64_t hits = 0;
  for (int c = 0; c < panel->curves; c++) {
    const cdem_curve *curve = &panel->curve[c];
    for (int64_t i = 0; i < curve->points; i++) {
      bool line = !has_rings(curve) && i > 0 && is_drawn(curve, i) && is_drawn(curve, i - 1);
      for (int s = 0; s < SAMPLES && (line || (s == 0 && is_drawn(curve, i))); s++) {
        double t = (double)s / SAMPLES;
        double px = curve->x[i] + (line ? t * (curve->x[i - 1] - curve->x[i]) : 0.0);
        double py = curve->y[i] + (line ? t * (curve->y[i - 1] - curve->y[i]) : 0.0);
        double u = (px - x.low) / (x.high - x.low), v = (py - y.low) / (y.high - y.low);
        hits += u >= left && u <= left + width && v >= bottom && v <= bottom + height;
      }
    }
  }
  return hits;
}

/* The emptiest place. Where none is empty and the axis is ours to choose, the axis is made longer
 * at its top until the legend stands above all curves. */
static const place *place_legend(const cdem_panel *panel, range x, range *y) {
  double width, height;
  legend_size(panel, &width, &height);
  const place *best = NULL;
  int64_t least = INT64_MAX;
  for (int i = 0; i < PLACES; i++) {
    int64_t hits = covered(panel, x, *y, &places[i], width, height);
    if (hits < least) {
      least = hits;
      best = &places[i];
    }
  }
  if (least > 0 && panel->y_min == panel->y_max && height < 0.6) {
    y->high = y->low + (y->high - y->low) / (1 - height);
    best = &places[0];
  }
  return best;
}

/* ---- script ---- */

static void put_plot(FILE *stream, const cdem_panel *panel, int first, const int power[2]) {
  fputs("plot ", stream);
  for (int c = 0; c < panel->curves; c++) {
    const cdem_curve *curve = &panel->curve[c];
    bool guide = curve->style < 0;
    int style = guide ? 0 : curve->style % STYLES;
    fprintf(stream, "%sdata index %d using ", c > 0 ? ", \\\n     " : "", first + c);
    cdem_gnuplot_column(stream, 1, power[0]);
    fputc(':', stream);
    cdem_gnuplot_column(stream, 2, power[1]);
    if (has_rings(curve))
      fprintf(stream, " with points pt 6 ps 0.75 lw 1.2 lc rgb '%s' ", styles[style].colour);
    else
      fprintf(stream, " with lines lw %s lc rgb '%s' dt %s ", guide ? "0.7" : "1.5",
              guide ? "#9a9a9a" : styles[style].colour, guide ? "solid" : styles[style].dashes);
    fputs(has_entry(curve) ? "title " : "notitle", stream);
    if (has_entry(curve))
      cdem_gnuplot_text(stream, curve->title);
  }
  if (panel->curves == 0)
    fputs("1/0 notitle", stream);
  fputc('\n', stream);
}

/* The range of an axis in numbers divided by a power of ten, which is written at its end. */
static void put_scaled(FILE *stream, const char *axis, range r, int power, const char *where,
                       double height) {
  char text[32];
  double factor = pow(10.0, power);
  cdem_gnuplot_power_text(power, text);
  cdem_gnuplot_range(stream, axis, r.low / factor, r.high / factor);
  fprintf(stream, "set label %d ", axis[0] == 'x' ? 5 : 6);
  cdem_gnuplot_text(stream, text);
  fprintf(stream, " at %s", where);
  cdem_gnuplot_number(stream, height);
  fprintf(stream, " right font '" CDEM_GNUPLOT_FONT ",%g'\n", CDEM_GNUPLOT_TICS_SIZE);
}

/* Panel p stands in column p % columns of row p / columns, from the top. */
static void put_panel(FILE *stream, const cdem_figure *figure, int p, int first, double width,
                      double height) {
  const cdem_panel *panel = &figure->panel[p];
  int columns = figure->columns > 0 ? figure->columns : 1, row = p / columns;
  double left = (p % columns) * (MARGIN_LEFT + AXES_WIDTH + MARGIN_RIGHT) + MARGIN_LEFT;
  double top = height - (figure->title != NULL && figure->title[0] != '\0' ? FIGURE_TITLE : 0.0) -
               row * (MARGIN_TOP + AXES_HEIGHT + MARGIN_BOTTOM) - MARGIN_TOP;
  const double edge[4] = {left / width, (left + AXES_WIDTH) / width, (top - AXES_HEIGHT) / height,
                          top / height};
  range x = x_range(panel), y = y_range(panel);
  const place *legend = place_legend(panel, x, &y);
  fputs("\nset margins screen ", stream);
  for (int e = 0; e < 4; e++) {
    fputs(e == 0 ? "" : ", screen ", stream);
    cdem_gnuplot_number(stream, edge[e]);
  }
  fputc('\n', stream);
  const int power[2] = {cdem_gnuplot_power(x.low, x.high), cdem_gnuplot_power(y.low, y.high)};
  put_scaled(stream, "x", x, power[0], "graph 1, screen ", (top - AXES_HEIGHT - X_LABEL) / height);
  put_scaled(stream, "y", y, power[1], "graph -0.02, screen ", (top + 10.0) / height);
  fputs("set xlabel ", stream);
  cdem_gnuplot_text(stream, panel->x_label);
  /* A label of our own: gnuplot would move it with the width of the tick labels. */
  fputs("\nset label 3 ", stream);
  cdem_gnuplot_text(stream, panel->y_label);
  fputs(" at screen ", stream);
  cdem_gnuplot_number(stream, (left - Y_LABEL) / width);
  fputs(", graph 0.5 center rotate by 90", stream);
  fprintf(stream, "\nset key %s\nset label 1 ", legend->key);
  cdem_gnuplot_text(stream, panel->title);
  fputs(" at graph 0, 1.055 left\n", stream);
  if (figure->panels > 1)
    fprintf(stream, "set label 2 '(%c)' at graph 1, 1.055 right\n", 'a' + p % 26);
  put_plot(stream, panel, first, power);
}

void cdem_figure_put_script(FILE *stream, const char *name, const cdem_figure *figure) {
  int columns = figure->columns > 0 ? figure->columns : 1;
  int rows = (figure->panels + columns - 1) / columns;
  int across = figure->panels < columns ? figure->panels : columns;
  bool titled = figure->title != NULL && figure->title[0] != '\0';
  double width = across * (MARGIN_LEFT + AXES_WIDTH + MARGIN_RIGHT);
  double height = rows * (MARGIN_TOP + AXES_HEIGHT + MARGIN_BOTTOM) + (titled ? FIGURE_TITLE : 0.0);
  cdem_gnuplot_begin(stream, name, width, height, "");
  fprintf(stream,
          "set border 31 lw 0.6 lc rgb '#222222'\n"
          "set tics in scale 0.6,0.3 font '" CDEM_GNUPLOT_FONT ",%g' textcolor rgb 'black'\n"
          "set mxtics 2\nset mytics 2\n"
          "set xzeroaxis lw 0.4 lc rgb '#b0b0b0' dt solid\n"
          "set key nobox Left reverse samplen 2.4 spacing 1.05\n"
          "set xlabel offset 0,0.4\n"
          "set multiplot\n",
          CDEM_GNUPLOT_TICS_SIZE);
  if (titled) {
    fputs("set label 4 ", stream);
    cdem_gnuplot_text(stream, figure->title);
    fprintf(stream, " at screen 0.5, screen ");
    cdem_gnuplot_number(stream, 1.0 - 0.55 * FIGURE_TITLE / height);
    fprintf(stream, " center font '" CDEM_GNUPLOT_FONT ",%g'\n", CDEM_GNUPLOT_FONT_SIZE + 1);
  }
  for (int p = 0, first = 0; p < figure->panels; p++) {
    put_panel(stream, figure, p, first, width, height);
    first += figure->panel[p].curves;
    if (p == 0 && titled)
      fputs("unset label 4\n", stream);
  }
  fputs("\nunset multiplot\n", stream);
  cdem_gnuplot_end(stream);
}

static void put_data(FILE *stream, const void *picture) {
  cdem_figure_put_data(stream, picture);
}

static void put_script(FILE *stream, const char *name, const void *picture) {
  cdem_figure_put_script(stream, name, picture);
}

cdem_status cdem_write_figure(const char *folder, const char *name, const cdem_figure *figure,
                              cdem_fault *fault) {
  return cdem_gnuplot_draw(folder, name, &(cdem_drawing){figure, put_data, put_script}, fault);
}
