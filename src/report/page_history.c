/* Every column of the history in one line: a small curve, its range, and its last value. */
#include "report/chart.h"
#include "report/number.h"
#include "report/source.h"

#include <math.h>
#include <stdlib.h>

enum { DIGITS = 4 };

bool cdem_report_has_history(const cdem_report_source *source) {
  return source->history.rows > 0;
}

static void put_number(cdem_report_text *to, double value, const char *unit) {
  char text[CDEM_REPORT_NUMBER];
  cdem_report_raw(to, "<td class=\"number\">");
  bool count = unit[0] == '\0' && fabs(value) < 1e15 && value == floor(value);
  cdem_report_escaped(to, cdem_report_quantity(value, count ? 15 : DIGITS, unit, text));
  cdem_report_raw(to, "</td>");
}

static void put_column(const cdem_report_source *source, int column, const double *time,
                       const double *y, cdem_report_text *to) {
  const cdem_table *history = &source->history;
  const char *unit = history->column[column].unit;
  double low = NAN, high = NAN;
  for (int64_t r = 0; r < history->rows; r++) {
    low = fmin(low, y[r]); /* pass over NaN */
    high = fmax(high, y[r]);
  }
  cdem_report_raw(to, "<tr><th scope=\"row\"><code>");
  cdem_report_escaped(to, history->column[column].name);
  cdem_report_raw(to, "</code></th><td>");
  if (low < high && time != NULL)
    cdem_report_spark_put(to, time, y, history->rows);
  cdem_report_raw(to, "</td>");
  put_number(to, low, unit);
  put_number(to, high, unit);
  put_number(to, y[history->rows - 1], unit);
  cdem_report_raw(to, "</tr>\n");
}

void cdem_report_put_history(const cdem_report_source *source, cdem_report_text *to,
                             cdem_report_made *made) {
  const cdem_table *history = &source->history;
  int clock = cdem_table_find(history, "time");
  double *time = clock >= 0 ? cdem_report_column(source, clock, 1.0, to) : NULL;
  (void)made;
  cdem_report_format(
      to,
      "<p>%lld row%s of <code>history.csv</code>, each column with its curve over "
      "the time of the run.</p>\n<details><summary>%d columns</summary>\n<div "
      "class=\"wide\"><table><caption><span>Columns of the history</span></caption><thead><tr><th "
      "scope=\"col\">Column</th><th scope=\"col\">Over time</th><th scope=\"col\" "
      "class=\"number\">Least</th><th scope=\"col\" class=\"number\">Most</th><th "
      "scope=\"col\" class=\"number\">Last</th></tr></thead><tbody>\n",
      (long long)history->rows, history->rows == 1 ? "" : "s", history->columns);
  for (int c = 0; c < history->columns && to->status == CDEM_OK; c++) {
    double *y = cdem_report_column(source, c, 1.0, to);
    if (y != NULL)
      put_column(source, c, time, y, to);
    free(y);
  }
  free(time);
  cdem_report_raw(to, "</tbody></table></div></details>\n");
}
