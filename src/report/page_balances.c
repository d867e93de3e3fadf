/* Balances: the energy book as tables and curves, its closing error, and the unbalanced force. */
#include "report/chart.h"
#include "report/number.h"
#include "report/source.h"
#include "run/axis.h"
#include "run/book.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TERMS = 16, DIGITS = 4 };

static const char *const side_title[] = {"", "Stored", "Dissipated", "Work done"};

/* The terms of one side of a book that are not zero in every row. */
typedef struct {
  int terms, column[MOST_TERMS];
} side;

static double real_at(const cdem_table *history, int64_t row, int column) {
  const cdem_value *value = cdem_table_at(history, row, column);
  return value->absent ? (double)NAN : value->real;
}

static bool is_zero(const cdem_table *history, int column) {
  for (int64_t r = 0; r < history->rows; r++)
    if (real_at(history, r, column) != 0.0 && !isnan(real_at(history, r, column)))
      return false;
  return true;
}

static side side_of(const cdem_table *history, cdem_book_of of, cdem_book_side which) {
  side found = {0};
  for (int c = 0; c < history->columns && found.terms < MOST_TERMS; c++) {
    cdem_book_of whose;
    if (cdem_run_book_side(history->column[c].name, &whose) == which && whose == of &&
        !is_zero(history, c))
      found.column[found.terms++] = c;
  }
  return found;
}

static const char *term_name(const cdem_table *history, int column) {
  const char *name = history->column[column].name, *dot = strchr(name, '.');
  return dot != NULL ? dot + 1 : name;
}

/* ---- tables ---- */

static void put_line(cdem_report_text *to, const char *name, double first, double last,
                     double scale) {
  char text[CDEM_REPORT_NUMBER];
  cdem_report_raw(to, "<tr><th scope=\"row\">");
  cdem_report_words(to, name);
  cdem_report_format(to, "</th><td class=\"number\">%s</td>",
                     cdem_report_quantity(first, DIGITS, "J", text));
  cdem_report_format(to, "<td class=\"number\">%s</td>",
                     cdem_report_quantity(last, DIGITS, "J", text));
  cdem_report_format(
      to, "<td class=\"number\">%s %%</td></tr>\n",
      cdem_report_number(scale > 0.0 ? 100.0 * (last - first) / scale : 0.0, 3, text));
}

static void put_sum(cdem_report_text *to, const char *name, double value, double scale) {
  char text[CDEM_REPORT_NUMBER];
  cdem_report_format(to,
                     "<tr class=\"sum\"><th scope=\"row\">%s</th><td></td><td class=\"number\">%s"
                     "</td>",
                     name, cdem_report_quantity(value, DIGITS, "J", text));
  cdem_report_format(to, "<td class=\"number\">%s %%</td></tr>\n",
                     cdem_report_number(scale > 0.0 ? 100.0 * value / scale : 0.0, 3, text));
}

static void put_sides(const cdem_table *history, cdem_book_of of, const cdem_run_book *book,
                      cdem_report_text *to) {
  const double sum[] = {0.0, book->stored, book->dissipated, book->work};
  static const char *const total[] = {"", "Change of what is stored", "Dissipated", "Work done"};
  for (int k = CDEM_BOOK_STORED; k <= CDEM_BOOK_WORK; k++) {
    const side terms = side_of(history, of, (cdem_book_side)k);
    cdem_report_format(to, "<tbody><tr><th scope=\"rowgroup\" colspan=\"4\">%s</th></tr>\n",
                       side_title[k]);
    for (int i = 0; i < terms.terms; i++)
      put_line(to, term_name(history, terms.column[i]), real_at(history, 0, terms.column[i]),
               real_at(history, history->rows - 1, terms.column[i]), book->scale);
    put_sum(to, total[k], sum[k], book->scale);
    cdem_report_raw(to, "</tbody>");
  }
}

static void put_table(const cdem_table *history, cdem_book_of of, const cdem_run_book *book,
                      cdem_report_text *to) {
  static const char *const whose[] = {"Energy book of the run", "Energy book of the medium",
                                      "Energy book of the grains"};
  char text[CDEM_REPORT_NUMBER];
  cdem_report_format(
      to,
      "<div class=\"wide\"><table><caption><span>%s, by its first and last row; the share is "
      "of the largest term in any row, %s. Terms that stay zero are left out."
      "</span></caption><thead><tr><th scope=\"col\">Term</th><th scope=\"col\" "
      "class=\"number\">Start</th><th scope=\"col\" class=\"number\">End</th><th "
      "scope=\"col\" class=\"number\">Share</th></tr></thead>",
      whose[of], cdem_report_quantity(book->scale, DIGITS, "J", text));
  put_sides(history, of, book, to);
  cdem_report_raw(to, "<tbody>");
  put_sum(to, "Open: stored + dissipated − work", book->open, book->scale);
  cdem_report_raw(to, "</tbody></table></div>\n");
}

/* ---- curves ---- */

static const char *chart_title(cdem_book_of of, cdem_book_side which, char title[64]) {
  static const char *const whose[] = {"", " in the medium", " by the grains"};
  static const char *const stored[] = {"Stored", "Stored in the medium", "Stored in the grains"};
  if (which == CDEM_BOOK_STORED)
    return stored[of];
  return strcat(strcpy(title, side_title[which]), whose[of]);
}

static void draw_side(const cdem_report_source *source, cdem_book_of of, cdem_book_side which,
                      cdem_report_text *to, cdem_report_made *made) {
  const cdem_table *history = &source->history;
  const side terms = side_of(history, of, which);
  cdem_curve curve[CDEM_REPORT_STYLES];
  double *x = cdem_report_column(source, cdem_table_find(history, "time"), 1.0, to);
  double *y[CDEM_REPORT_STYLES] = {0}, largest = 0.0;
  char labels[2][CDEM_RUN_LABEL], title[64], name[CDEM_REPORT_STYLES][CDEM_RUN_LABEL];
  int curves = 0;
  for (; curves < terms.terms && curves < CDEM_REPORT_STYLES && to->status == CDEM_OK; curves++) {
    y[curves] = cdem_report_column(source, terms.column[curves], 1.0, to);
    largest = to->status == CDEM_OK ? fmax(largest, cdem_run_largest(y[curves], history->rows)) : 0;
    cdem_run_label(term_name(history, terms.column[curves]), "", name[curves]);
  }
  if (to->status == CDEM_OK && curves > 0) {
    const cdem_run_axis time = cdem_run_axis_for("s", cdem_run_largest(x, history->rows)),
                        joule = cdem_run_axis_for("J", largest);
    cdem_run_rescale(x, history->rows, time.factor);
    for (int i = 0; i < curves; i++) {
      cdem_run_rescale(y[i], history->rows, joule.factor);
      curve[i] =
          (cdem_curve){.title = name[i], .x = x, .y = y[i], .points = history->rows, .style = i};
    }
    cdem_run_label("time", time.unit, labels[0]);
    cdem_run_label("energy", joule.unit, labels[1]);
    const cdem_report_chart chart = {.title = chart_title(of, which, title),
                                     .x_label = labels[0],
                                     .y_label = labels[1],
                                     .curves = curves,
                                     .curve = curve};
    cdem_report_chart_put(to, &chart);
    made->charts++;
  }
  free(x);
  for (int i = 0; i < curves; i++)
    free(y[i]);
}

/* A ratio of the history over time, on a scale of powers of ten. */
static void draw_ratio(const cdem_report_source *source, const char *column, const char *title,
                       const char *label, cdem_report_text *to, cdem_report_made *made) {
  const cdem_table *history = &source->history;
  int found = cdem_table_find(history, column);
  if (found < 0 || is_zero(history, found))
    return;
  double *x = cdem_report_column(source, cdem_table_find(history, "time"), 1.0, to);
  double *y = cdem_report_column(source, found, 1.0, to);
  char time_label[CDEM_RUN_LABEL];
  if (to->status == CDEM_OK) {
    const cdem_run_axis time = cdem_run_axis_for("s", cdem_run_largest(x, history->rows));
    cdem_run_rescale(x, history->rows, time.factor);
    cdem_run_label("time", time.unit, time_label);
    const cdem_curve curve = {.x = x, .y = y, .points = history->rows, .style = 0};
    const cdem_report_chart chart = {.title = title,
                                     .x_label = time_label,
                                     .y_label = label,
                                     .curves = 1,
                                     .curve = &curve,
                                     .logarithmic = true};
    cdem_report_chart_put(to, &chart);
    made->charts++;
  }
  free(x);
  free(y);
}

/* ---- the section ---- */

bool cdem_report_has_balances(const cdem_report_source *source) {
  const cdem_table *history = &source->history;
  bool any = false;
  for (int of = 0; of < CDEM_BOOKS; of++)
    any = any || cdem_run_book_sum(history, (cdem_book_of)of).scale > 0.0;
  return any && history->rows >= 2 && cdem_table_find(history, "time") >= 0;
}

static void put_error(const cdem_table *history, cdem_report_text *to) {
  char text[CDEM_REPORT_NUMBER];
  int error = cdem_table_find(history, "energy_error");
  if (error < 0)
    return;
  cdem_report_format(
      to,
      "<p>Closing error at the end: <b>%s</b> of the largest term, as the run itself "
      "found it (<code>energy_error</code>)",
      cdem_report_number(real_at(history, history->rows - 1, error), 3, text));
  double worst = 0.0;
  for (int64_t r = 0; r < history->rows; r++)
    worst = fmax(worst, real_at(history, r, error));
  cdem_report_format(to, "; the largest in any row is %s.</p>\n",
                     cdem_report_number(worst, 3, text));
}

void cdem_report_put_balances(const cdem_report_source *source, cdem_report_text *to,
                              cdem_report_made *made) {
  static const struct {
    const char *column, *title;
  } forces[] = {{"unbalanced", "Balance of forces"},
                {"coarse.unbalanced", "Balance of forces in the medium"},
                {"fine.unbalanced", "Balance of forces of the grains"}};
  const cdem_table *history = &source->history;
  cdem_report_raw(to, "<p>Energy is stored, dissipated, or brought in as work; a book closes when "
                      "stored + dissipated = work.</p>\n");
  put_error(history, to);
  for (int of = 0; of < CDEM_BOOKS; of++) {
    const cdem_run_book book = cdem_run_book_sum(history, (cdem_book_of)of);
    if (book.scale > 0.0)
      put_table(history, (cdem_book_of)of, &book, to);
  }
  cdem_report_raw(to, "<div class=\"grid\">\n");
  for (int of = 0; of < CDEM_BOOKS; of++)
    for (int k = CDEM_BOOK_STORED; k <= CDEM_BOOK_WORK; k++)
      draw_side(source, (cdem_book_of)of, (cdem_book_side)k, to, made);
  draw_ratio(source, "energy_error", "Closing error of the energy book",
             "share of the largest term", to, made);
  if (source->cases.values.analysis ==
      CDEM_ANALYSIS_RELAXATION) /* else nothing is to be balanced */
    for (size_t i = 0; i < sizeof forces / sizeof forces[0]; i++)
      draw_ratio(source, forces[i].column, forces[i].title, "unbalanced force ratio", to, made);
  cdem_report_raw(to, "</div>\n");
}
