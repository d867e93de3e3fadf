/* Curves as inline SVG. */
#include "report/chart.h"

#include "report/number.h"
#include "run/axis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  WIDTH = 480,
  HEIGHT = 300,
  LEFT = 66,
  RIGHT = 14,
  TOP = 28,
  BOTTOM = 52,
  SPARK_WIDTH = 120,
  SPARK_HEIGHT = 28,
  MOST_RUNS = 1200 /* of points that are thinned: three a unit of the width */
};

/* ---- axes ---- */

static double nice_step(double range) {
  double rough = range / 6.0, power = pow(10.0, floor(log10(rough))), part = rough / power;
  return power * (part <= 1.0 ? 1.0 : part <= 2.0 ? 2.0 : part <= 5.0 ? 5.0 : 10.0);
}

cdem_report_axis cdem_report_axis_for(double low, double high, bool outward) {
  double size = fmax(fabs(low), fabs(high));
  if (!(high - low > 1e-9 * size)) { /* one value: room around it */
    double room = size > 0.0 ? 0.1 * size : 1.0;
    low -= room;
    high += room;
  }
  cdem_report_axis axis = {.low = low, .high = high, .step = nice_step(high - low)};
  if (outward) {
    axis.low = axis.step * floor(low / axis.step + 1e-9);
    axis.high = axis.step * ceil(high / axis.step - 1e-9);
  }
  int tens = (int)floor(log10(fmax(fabs(axis.low), fabs(axis.high))));
  if (tens >= 5 || tens <= -3)
    axis.power = 3 * (int)floor(tens / 3.0);
  int fine = (int)floor(log10(axis.step) + 1e-9) - axis.power;
  axis.decimals = fine < 0 ? -fine : 0;
  return axis;
}

/* Whole powers of ten around the values. */
static cdem_report_axis decades_for(double low, double high) {
  cdem_report_axis axis = {.low = floor(log10(low) + 1e-9), .high = ceil(log10(high) - 1e-9)};
  if (axis.high - axis.low < 1.0)
    axis.high = axis.low + 1.0;
  axis.step = ceil((axis.high - axis.low) / 7.0);
  return axis;
}

/* ---- ranges ---- */

typedef struct {
  double x_low, x_high, y_low, y_high;
  int64_t points;
} range;

static bool is_seen(const cdem_curve *curve, int64_t i, bool logarithmic) {
  return isfinite(curve->x[i]) && isfinite(curve->y[i]) && (!logarithmic || curve->y[i] > 0.0);
}

static void widen(range *r, const cdem_curve *curve, bool logarithmic) {
  for (int64_t i = 0; i < curve->points; i++)
    if (is_seen(curve, i, false)) {
      r->x_low = fmin(r->x_low, curve->x[i]);
      r->x_high = fmax(r->x_high, curve->x[i]);
      if (!is_seen(curve, i, logarithmic))
        continue;
      r->y_low = fmin(r->y_low, curve->y[i]);
      r->y_high = fmax(r->y_high, curve->y[i]);
      r->points++;
    }
}

static const range nothing = {INFINITY, -INFINITY, INFINITY, -INFINITY, 0};

/* ---- lines ---- */

/* From values to units of the picture. */
typedef struct {
  cdem_report_axis x, y;
  double left, right, top, bottom;
  bool logarithmic;
} frame;

static double at_x(const frame *f, double x) {
  return f->left + (f->right - f->left) * (x - f->x.low) / (f->x.high - f->x.low);
}

static double at_y(const frame *f, double y) {
  double value = f->logarithmic ? log10(y) : y;
  return f->bottom - (f->bottom - f->top) * (value - f->y.low) / (f->y.high - f->y.low);
}

/* Tenths of a unit, without a look at the locale. */
static void put_place(cdem_report_text *to, const char *before, double value) {
  long tenths = lround(10.0 * value);
  cdem_report_format(to, "%s%s%ld", before, tenths < 0 ? "-" : "", labs(tenths) / 10);
  if (tenths % 10 != 0)
    cdem_report_format(to, ".%ld", labs(tenths) % 10);
}

typedef struct {
  double x, y;
  bool down; /* is the pen? */
} pen;

static void draw_to(cdem_report_text *to, const frame *f, const cdem_curve *curve, int64_t i,
                    bool last, pen *p) {
  if (!is_seen(curve, i, f->logarithmic)) {
    p->down = false;
    return;
  }
  double x = at_x(f, curve->x[i]), y = at_y(f, curve->y[i]);
  if (p->down && !last && fabs(x - p->x) < 0.5 && fabs(y - p->y) < 0.5)
    return;
  put_place(to, p->down ? "L" : "M", x);
  put_place(to, " ", y);
  *p = (pen){x, y, true};
}

/* Of the points first .. end - 1 the lowest, the highest and the last, in their order; one that
 * cannot be seen breaks the line. */
static void draw_run(cdem_report_text *to, const frame *f, const cdem_curve *curve, int64_t first,
                     int64_t end, pen *p) {
  int64_t low = -1, high = -1;
  for (int64_t i = first; i < end; i++) {
    bool seen = is_seen(curve, i, f->logarithmic);
    p->down = p->down && seen;
    if (seen && (low < 0 || curve->y[i] < curve->y[low]))
      low = i;
    if (seen && (high < 0 || curve->y[i] > curve->y[high]))
      high = i;
  }
  if (low < 0)
    return;
  int64_t a = low < high ? low : high, b = low < high ? high : low;
  bool over = end == curve->points;
  draw_to(to, f, curve, a, over && a == end - 1, p);
  if (b != a)
    draw_to(to, f, curve, b, over && b == end - 1, p);
  if (b != end - 1)
    draw_to(to, f, curve, end - 1, over, p);
}

static void put_line(cdem_report_text *to, const frame *f, const cdem_curve *curve) {
  int64_t stride = (curve->points + MOST_RUNS - 1) / MOST_RUNS;
  pen p = {0};
  cdem_report_format(to, "<path class=\"c%d\" d=\"",
                     (curve->style % CDEM_REPORT_STYLES + CDEM_REPORT_STYLES) % CDEM_REPORT_STYLES);
  for (int64_t i = 0; i < curve->points; i += stride) {
    int64_t end = i + stride < curve->points ? i + stride : curve->points;
    draw_run(to, f, curve, i, end, &p);
  }
  cdem_report_raw(to, "\"/>");
}

/* ---- axes in the picture ---- */

static void tick_text(const cdem_report_axis *axis, bool logarithmic, double at,
                      char out[CDEM_REPORT_NUMBER]) {
  if (logarithmic) {
    cdem_report_power((int)lround(at), out);
    return;
  }
  double value = fabs(at) < 1e-6 * axis->step ? 0.0 : at * pow(10.0, -axis->power);
  char plain[64];
  snprintf(plain, sizeof plain, "%.*f", axis->decimals, fabs(value));
  char *comma = strchr(plain, ','); /* some locales */
  if (comma != NULL)
    *comma = '.';
  snprintf(out, CDEM_REPORT_NUMBER, "%s%s", value < 0.0 ? "−" : "", plain);
}

static void put_ticks(cdem_report_text *to, const frame *f, bool upright) {
  const cdem_report_axis *axis = upright ? &f->y : &f->x;
  double first = axis->step * ceil(axis->low / axis->step - 1e-9);
  int count = (int)floor((axis->high - first) / axis->step + 1e-6);
  for (int k = 0; k <= count; k++) {
    double value = first + k * axis->step, part = (value - axis->low) / (axis->high - axis->low);
    double at =
        upright ? f->bottom - part * (f->bottom - f->top) : f->left + part * (f->right - f->left);
    char text[CDEM_REPORT_NUMBER];
    tick_text(axis, upright && f->logarithmic, value, text);
    put_place(to, "<path class=\"rule\" d=\"M", upright ? f->left : at);
    put_place(to, " ", upright ? at : f->top);
    put_place(to, upright ? "H" : "V", upright ? f->right : f->bottom);
    put_place(to, "\"/><text x=\"", upright ? f->left - 7.0 : at);
    put_place(to, "\" y=\"", upright ? at + 4.5 : f->bottom + 20.0);
    cdem_report_format(to, "\" text-anchor=\"%s\">%s</text>", upright ? "end" : "middle", text);
  }
}

static void put_power(cdem_report_text *to, const frame *f, bool upright) {
  const cdem_report_axis *axis = upright ? &f->y : &f->x;
  char text[CDEM_REPORT_NUMBER];
  if (axis->power == 0)
    return;
  put_place(to, "<text x=\"", upright ? f->left - 7.0 : f->right);
  put_place(to, "\" y=\"", upright ? f->top - 14.0 : f->bottom + 43.0);
  cdem_report_format(to, "\" text-anchor=\"%s\">× %s</text>", upright ? "middle" : "end",
                     cdem_report_power(axis->power, text));
}

static void put_labels(cdem_report_text *to, const cdem_report_chart *chart, const frame *f) {
  put_place(to, "<text class=\"label\" text-anchor=\"middle\" x=\"", 0.5 * (f->left + f->right));
  put_place(to, "\" y=\"", f->bottom + 43.0);
  cdem_report_raw(to, "\">");
  cdem_report_label(to, chart->x_label, CDEM_REPORT_IN_SVG);
  put_place(to, "</text><text class=\"label\" text-anchor=\"middle\" transform=\"translate(15 ",
            0.5 * (f->top + f->bottom));
  cdem_report_raw(to, ") rotate(-90)\">");
  cdem_report_label(to, chart->y_label, CDEM_REPORT_IN_SVG);
  cdem_report_raw(to, "</text>");
}

/* ---- in words ---- */

static double last_seen(const cdem_curve *curve, bool logarithmic) {
  for (int64_t i = curve->points - 1; i >= 0; i--)
    if (is_seen(curve, i, logarithmic))
      return curve->y[i];
  return NAN;
}

static void put_words(cdem_report_text *to, const cdem_report_chart *chart, const range *all) {
  char a[CDEM_REPORT_NUMBER], b[CDEM_REPORT_NUMBER], c[CDEM_REPORT_NUMBER];
  cdem_report_label(to, chart->title, CDEM_REPORT_IN_WORDS);
  cdem_report_raw(to, ". Horizontal: ");
  cdem_report_label(to, chart->x_label, CDEM_REPORT_IN_WORDS);
  cdem_report_format(to, ", %s to %s. Vertical: ", cdem_report_number(all->x_low, 4, a),
                     cdem_report_number(all->x_high, 4, b));
  cdem_report_label(to, chart->y_label, CDEM_REPORT_IN_WORDS);
  for (int i = 0; i < chart->curves; i++) {
    range own = nothing;
    widen(&own, &chart->curve[i], chart->logarithmic);
    cdem_report_raw(to, i == 0 ? ". " : "; ");
    if (chart->curve[i].title != NULL)
      cdem_report_label(to, chart->curve[i].title, CDEM_REPORT_IN_WORDS);
    if (own.points == 0)
      cdem_report_raw(to, " has no values");
    else
      cdem_report_format(to, " between %s and %s, at the end %s",
                         cdem_report_number(own.y_low, 4, a), cdem_report_number(own.y_high, 4, b),
                         cdem_report_number(last_seen(&chart->curve[i], chart->logarithmic), 4, c));
  }
  cdem_report_raw(to, ".");
}

static void put_legend(cdem_report_text *to, const cdem_report_chart *chart) {
  if (chart->curves == 0 || chart->curve[0].title == NULL)
    return;
  cdem_report_raw(to, "<ul class=\"legend\">");
  for (int i = 0; i < chart->curves; i++) {
    cdem_report_format(to,
                       "<li><svg viewBox=\"0 0 26 8\" aria-hidden=\"true\"><path class=\"c%d\" "
                       "d=\"M0 4H26\"/></svg>",
                       chart->curve[i].style % CDEM_REPORT_STYLES);
    cdem_report_label(to, chart->curve[i].title, CDEM_REPORT_IN_HTML);
    cdem_report_raw(to, "</li>");
  }
  cdem_report_raw(to, "</ul>");
}

/* ---- the whole ---- */

static frame frame_for(const range *all, bool logarithmic) {
  double low = all->y_low, high = all->y_high, left = all->x_low;
  if (left > 0.0 && left < 0.05 * all->x_high)
    left = 0.0;
  if (low > 0.0 && low < 0.5 * high) /* near enough to zero to show it */
    low = 0.0;
  return (frame){.x = cdem_report_axis_for(left, all->x_high, false),
                 .y = logarithmic ? decades_for(all->y_low, high)
                                  : cdem_report_axis_for(low, high, true),
                 .left = LEFT,
                 .right = WIDTH - RIGHT,
                 .top = TOP,
                 .bottom = HEIGHT - BOTTOM,
                 .logarithmic = logarithmic};
}

void cdem_report_chart_put(cdem_report_text *to, const cdem_report_chart *chart) {
  range all = nothing;
  for (int i = 0; i < chart->curves; i++)
    widen(&all, &chart->curve[i], chart->logarithmic);
  if (all.points < 2)
    return;
  const frame f = frame_for(&all, chart->logarithmic);
  cdem_report_raw(to, "<figure class=\"chart\"><figcaption>");
  cdem_report_label(to, chart->title, CDEM_REPORT_IN_HTML);
  cdem_report_format(to, "</figcaption><svg viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"",
                     WIDTH, HEIGHT);
  put_words(to, chart, &all);
  cdem_report_raw(to, "\">");
  put_ticks(to, &f, false);
  put_ticks(to, &f, true);
  put_power(to, &f, false);
  put_power(to, &f, true);
  cdem_report_format(to, "<path class=\"axis\" d=\"M%d %dV%dH%d\"/>", LEFT, TOP, HEIGHT - BOTTOM,
                     WIDTH - RIGHT);
  for (int i = 0; i < chart->curves; i++)
    put_line(to, &f, &chart->curve[i]);
  put_labels(to, chart, &f);
  cdem_report_raw(to, "</svg>");
  put_legend(to, chart);
  cdem_report_raw(to, "</figure>\n");
}

void cdem_report_spark_put(cdem_report_text *to, const double *x, const double *y, int64_t points) {
  const cdem_curve curve = {.x = x, .y = y, .points = points};
  range all = nothing;
  widen(&all, &curve, false);
  if (all.points < 2)
    return;
  const frame f = {
      .x = {.low = all.x_low, .high = all.x_high > all.x_low ? all.x_high : all.x_low + 1.0},
      .y = cdem_report_axis_for(all.y_low, all.y_high, false),
      .left = 2.0,
      .right = SPARK_WIDTH - 2.0,
      .top = 3.0,
      .bottom = SPARK_HEIGHT - 3.0};
  cdem_report_format(to, "<svg class=\"spark\" viewBox=\"0 0 %d %d\" aria-hidden=\"true\">",
                     SPARK_WIDTH, SPARK_HEIGHT);
  put_line(to, &f, &curve);
  cdem_report_raw(to, "</svg>");
}
