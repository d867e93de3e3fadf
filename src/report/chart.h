/* Private to report: curves as inline SVG.
 *
 * A chart is 480 by 300 units, which is about the width of a column on a screen and still readable
 * at the width of a phone. It has no colours of its own: classes c0 .. c7 take colour and dashes
 * from the page's style (style.c), which knows light and dark. The text for who cannot see it names
 * the axes, the range of each curve and its last value.
 *
 * A curve of many points keeps what can be seen: of each run of points the lowest, the highest and
 * the last, and of those only the ones that are half a unit apart. tests/report/chart.c reads the
 * path back.
 */
#ifndef CDEM_REPORT_CHART_H
#define CDEM_REPORT_CHART_H

#include "report/text.h"
#include "results/results.h"

enum { CDEM_REPORT_STYLES = 8 };

typedef struct {
  const char *title, *x_label, *y_label; /* gnuplot's markup */
  int curves;
  const cdem_curve *curve; /* style: 0 .. 7; title NULL: no legend */
  bool logarithmic;        /* y: values that are not above 0 break the line */
} cdem_report_chart;

/* Nothing when no curve has two points. */
void cdem_report_chart_put(cdem_report_text *to, const cdem_report_chart *chart);

/* A small curve without axes, for a line of a table. */
void cdem_report_spark_put(cdem_report_text *to, const double *x, const double *y, int64_t points);

/* An axis: where it begins and ends, its ticks, and the power of ten its numbers are divided by. */
typedef struct {
  double low, high, step; /* logarithmic: exponents of ten */
  int power, decimals;
} cdem_report_axis;
/* Ticks at 1, 2 or 5 times a power of ten, four to nine of them; outward: the ends are ticks. */
cdem_report_axis cdem_report_axis_for(double low, double high, bool outward);

#endif
