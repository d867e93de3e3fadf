/* The verdict, and the key results against their references. */
#include "report/number.h"
#include "report/source.h"

#include <math.h>
#include <string.h>

enum { DIGITS = 5 };

typedef enum { FREE, WITHIN, OFF } outcome; /* FREE: nothing was asked of it */

static outcome judge(const cdem_summary_result *result) {
  if (isnan(result->tolerance))
    return FREE;
  return fabs(result->difference) <= result->tolerance ? WITHIN : OFF;
}

static void put_badge(cdem_report_text *to, const char *class, const char *text) {
  cdem_report_format(to, "<span class=\"badge %s\">%s</span>", class, text);
}

static void put_outcome(cdem_report_text *to, outcome found) {
  static const char *const class[] = {"", "good", "bad"};
  static const char *const text[] = {"", "within", "off"};
  if (found != FREE)
    put_badge(to, class[found], text[found]);
}

/* Relative, or in the unit where the reference is 0. */
static void put_difference(cdem_report_text *to, const cdem_summary_result *result, double value) {
  char text[CDEM_REPORT_NUMBER];
  if (isnan(value))
    return;
  if (value > 0.0)
    cdem_report_raw(to, "+");
  if (result->reference == 0.0)
    cdem_report_raw(to,
                    cdem_report_quantity(value, 3, result->unit != NULL ? result->unit : "", text));
  else
    cdem_report_format(to, "%s %%", cdem_report_number(100.0 * value, 3, text));
}

static const char *value_text(const cdem_summary_result *result, double value,
                              char text[CDEM_REPORT_NUMBER]) {
  return cdem_report_quantity(value, DIGITS, result->unit != NULL ? result->unit : "", text);
}

/* ---- the verdict ---- */

static void put_first(const cdem_summary_file *summary, cdem_report_text *to) {
  char text[CDEM_REPORT_NUMBER];
  const cdem_summary_result *shown = NULL;
  for (int64_t i = 0; i < summary->results && shown == NULL; i++)
    if (judge(&summary->result[i]) == OFF)
      shown = &summary->result[i];
  for (int64_t i = 0; i < summary->results && shown == NULL; i++)
    if (!isnan(summary->result[i].reference))
      shown = &summary->result[i];
  if (shown == NULL)
    return;
  cdem_report_raw(to, " <b>");
  cdem_report_escaped(to, shown->name);
  cdem_report_format(to, "</b> is %s", value_text(shown, shown->value, text));
  cdem_report_format(to, " against its reference %s", value_text(shown, shown->reference, text));
  if (!isnan(shown->difference)) {
    cdem_report_raw(to, ", a difference of ");
    put_difference(to, shown, shown->difference);
  }
  cdem_report_raw(to, ".");
}

static void put_ended(const cdem_summary_file *summary, cdem_report_text *to) {
  int judged = 0, off = 0;
  for (int64_t i = 0; i < summary->results; i++) {
    judged += judge(&summary->result[i]) != FREE;
    off += judge(&summary->result[i]) == OFF;
  }
  if (judged == 0) {
    put_badge(to, "plain", "ended");
    cdem_report_raw(to, summary->results > 0 ? " No key result has a tolerance to be judged by."
                                             : " The case names no key results.");
  } else if (off > 0) {
    put_badge(to, "bad", "off");
    cdem_report_format(to, " %d of %d key results with a tolerance %s off by more than it.", off,
                       judged, off == 1 ? "is" : "are");
  } else {
    put_badge(to, "good", "within");
    cdem_report_format(to,
                       judged == 1 ? " The key result with a tolerance is within it."
                                   : " All %d key results with a tolerance are within it.",
                       judged);
  }
  put_first(summary, to);
}

/* How far a run has come that has not ended. */
static void put_going(const cdem_report_source *source, cdem_report_text *to) {
  const cdem_table *history = &source->history;
  char now[CDEM_REPORT_NUMBER], end[CDEM_REPORT_NUMBER];
  int clock = cdem_table_find(history, "time");
  double wanted = source->cases.values.end;
  put_badge(to, "open", "not ended");
  if (history->rows == 0 || clock < 0) {
    cdem_report_raw(to, " The run has not ended, and it has no history yet.");
  } else {
    const cdem_value *last = cdem_table_at(history, history->rows - 1, clock);
    double time = last->absent ? (double)NAN : last->real;
    cdem_report_format(to, " The run has not ended: its history reaches to t = %s",
                       cdem_report_quantity(time, 4, "s", now));
    if (wanted > 0.0)
      cdem_report_format(to, " of %s (%s %%)", cdem_report_quantity(wanted, 4, "s", end),
                         cdem_report_number(100.0 * time / wanted, 3, now));
    cdem_report_raw(to, ". What follows is what is there; key results are found at the end.");
  }
  if (source->process > 0) {
    cdem_report_format(to, " Process %lld is writing to its folder.", (long long)source->process);
  } else {
    cdem_report_raw(to, " To finish it: <code>cdem run --resume ");
    cdem_report_argument(to, source->place);
    cdem_report_raw(to, "</code>");
  }
}

static void put_warnings(const cdem_summary_file *summary, cdem_report_text *to) {
  if (summary->warnings == 0)
    return;
  cdem_report_format(to, "<div class=\"warnings\"><p>%s of the run:</p><ul>",
                     summary->warnings == 1 ? "Warning" : "Warnings");
  for (int64_t i = 0; i < summary->warnings; i++)
    if (summary->warning[i] != NULL) {
      cdem_report_raw(to, "<li>");
      cdem_report_escaped(to, summary->warning[i]);
      cdem_report_raw(to, "</li>");
    }
  cdem_report_raw(to, "</ul></div>\n");
}

void cdem_report_put_verdict(const cdem_report_source *source, cdem_report_text *to) {
  cdem_report_raw(to, "<p class=\"verdict\">");
  if (source->finished)
    put_ended(&source->summary, to);
  else
    put_going(source, to);
  cdem_report_raw(to, "</p>\n");
  put_warnings(&source->summary, to);
}

/* ---- the table ---- */

bool cdem_report_has_results(const cdem_report_source *source) {
  return source->summary.results > 0;
}

/* "max of force, from 10 ms" */
static void put_taking(cdem_report_text *to, const cdem_summary_result *result) {
  char text[CDEM_REPORT_NUMBER];
  if (result->take == NULL || result->of == NULL)
    return;
  cdem_report_words(to, result->take);
  cdem_report_raw(to, " of <code>");
  cdem_report_escaped(to, result->of);
  cdem_report_raw(to, "</code>");
  if (!isnan(result->from))
    cdem_report_format(to, ", from %s", cdem_report_quantity(result->from, 4, "s", text));
  if (!isnan(result->to))
    cdem_report_format(to, ", to %s", cdem_report_quantity(result->to, 4, "s", text));
}

static void put_allowed(cdem_report_text *to, const cdem_summary_result *result) {
  char text[CDEM_REPORT_NUMBER];
  cdem_report_raw(to, "<td class=\"number\">");
  if (!isnan(result->tolerance) && result->reference == 0.0)
    cdem_report_format(to, "±%s", value_text(result, result->tolerance, text));
  else if (!isnan(result->tolerance))
    cdem_report_format(to, "±%s %%", cdem_report_number(100.0 * result->tolerance, 3, text));
  cdem_report_raw(to, "</td><td>");
  put_outcome(to, judge(result));
  cdem_report_raw(to, "</td>");
}

static void put_row(cdem_report_text *to, const cdem_summary_result *result, bool judged) {
  char text[CDEM_REPORT_NUMBER];
  cdem_report_raw(to, "<tr><th scope=\"row\">");
  cdem_report_escaped(to, result->name);
  cdem_report_format(to, "</th><td class=\"number\">%s</td><td class=\"number\">",
                     value_text(result, result->value, text));
  if (!isnan(result->reference))
    cdem_report_raw(to, value_text(result, result->reference, text));
  cdem_report_raw(to, "</td><td class=\"number\">");
  put_difference(to, result, result->difference);
  cdem_report_raw(to, "</td>");
  if (judged)
    put_allowed(to, result);
  cdem_report_raw(to, "<td class=\"note\">");
  put_taking(to, result);
  cdem_report_raw(to, "</td></tr>\n");
}

void cdem_report_put_results(const cdem_report_source *source, cdem_report_text *to,
                             cdem_report_made *made) {
  const cdem_summary_file *summary = &source->summary;
  bool judged = false;
  (void)made;
  for (int64_t i = 0; i < summary->results; i++)
    judged = judged || judge(&summary->result[i]) != FREE;
  cdem_report_raw(to,
                  "<div class=\"wide\"><table><caption><span>Key numbers of the case, beside what "
                  "is expected of them</span></caption><thead><tr><th scope=\"col\">Result</th>"
                  "<th scope=\"col\" class=\"number\">Value</th><th scope=\"col\" "
                  "class=\"number\">Reference</th><th scope=\"col\" "
                  "class=\"number\">Difference</th>");
  if (judged)
    cdem_report_raw(to, "<th scope=\"col\" class=\"number\">Allowed</th><th "
                        "scope=\"col\">Outcome</th>");
  cdem_report_raw(to, "<th scope=\"col\">Taken from the history</th></tr></thead><tbody>\n");
  for (int64_t i = 0; i < summary->results; i++)
    put_row(to, &summary->result[i], judged);
  cdem_report_raw(to, "</tbody></table></div>\n");
}
