/* The page: head, verdict, contents, sections. And the way from a folder to a file. */
#include "report/number.h"
#include "report/report.h"
#include "report/source.h"

#include <stdio.h>
#include <string.h>

static const cdem_report_section section[] = {
    {"results", "Key results", cdem_report_has_results, cdem_report_put_results},
    {"figures", "Figures", cdem_report_has_figures, cdem_report_put_figures},
    {"balances", "Balances", cdem_report_has_balances, cdem_report_put_balances},
    {"computed", "What was computed", NULL, cdem_report_put_computed},
    {"settings", "Settings", NULL, cdem_report_put_settings},
    {"repeat", "Repeat and check", NULL, cdem_report_put_repeat},
    {"files", "Files", NULL, cdem_report_put_files},
    {"history", "History", cdem_report_has_history, cdem_report_put_history}};
enum { SECTIONS = sizeof section / sizeof section[0] };

static const char *title_of(const cdem_report_source *source) {
  const char *title = source->cases.values.title;
  return title != NULL && title[0] != '\0' ? title : source->name;
}

static const char *kind_of(const cdem_case *cases) {
  static const char *const body[] = {"Body, dynamic", "Body, relaxation", "Body, static solution"};
  if (cdem_case_is_coupled(cases)) {
    static const char *const version[] = {"Grains coupled with a medium",
                                          "Grains beside a medium at rest", "Grains everywhere",
                                          "Medium everywhere"};
    return version[cases->values.coupling.version];
  }
  if (cdem_case_has_deformable(cases))
    return cdem_case_is_triaxial(cases) ? "Triaxial test of deformable grains"
                                        : "Deformable grains";
  if (cdem_case_has_grains(cases))
    return cdem_case_is_triaxial(cases) ? "Triaxial test of grains" : "Grains";
  return body[cases->values.analysis];
}

static void put_head(const cdem_report_source *source, cdem_report_text *to) {
  cdem_report_raw(to, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
                      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
                      "<meta name=\"color-scheme\" content=\"light dark\"/>\n"
                      "<meta name=\"generator\" content=\"cdem ");
  cdem_report_escaped(to, source->options->version);
  cdem_report_raw(to, "\"/>\n<link rel=\"icon\" href=\"data:,\"/>\n<title>");
  cdem_report_escaped(to, title_of(source));
  cdem_report_raw(to, "</title>\n<style>\n");
  cdem_report_raw(to, cdem_report_style);
  cdem_report_raw(to, "</style>\n</head>\n");
}

static void put_contents(const cdem_report_source *source, cdem_report_text *to) {
  cdem_report_raw(to, "<nav aria-label=\"Contents\"><ul>");
  for (int i = 0; i < SECTIONS; i++)
    if (section[i].there == NULL || section[i].there(source))
      cdem_report_format(to, "<li><a href=\"#%s\">%s</a></li>", section[i].id, section[i].title);
  cdem_report_raw(to, "<li><a href=\"#case\">Case</a></li></ul></nav>\n");
}

static void put_case(const cdem_report_source *source, cdem_report_text *to) {
  cdem_report_raw(to,
                  "<section id=\"case\"><h2><a href=\"#case\">Case</a></h2>\n<p>The case as it was "
                  "run, with what was set on the command line; comments are gone where "
                  "something was.</p>\n<div class=\"wide\"><pre>");
  cdem_report_escaped(to, source->cases.source);
  cdem_report_raw(to, "</pre></div></section>\n");
}

cdem_status cdem_report_page(const cdem_report_source *source, cdem_report_text *page,
                             cdem_report_made *made) {
  put_head(source, page);
  cdem_report_raw(page, "<body>\n<header>\n<p class=\"kind\">");
  cdem_report_escaped(page, kind_of(&source->cases));
  cdem_report_raw(page, "</p>\n<h1>");
  cdem_report_escaped(page, title_of(source));
  cdem_report_raw(page, "</h1>\n");
  cdem_report_put_verdict(source, page);
  put_contents(source, page);
  cdem_report_raw(page, "</header>\n<main>\n");
  for (int i = 0; i < SECTIONS; i++)
    if (section[i].there == NULL || section[i].there(source)) {
      cdem_report_format(page, "<section id=\"%s\"><h2><a href=\"#%s\">%s</a></h2>\n",
                         section[i].id, section[i].id, section[i].title);
      section[i].put(source, page, made);
      cdem_report_raw(page, "</section>\n");
    }
  put_case(source, page);
  cdem_report_raw(page, "</main>\n<footer><p>Made by <code>cdem report</code>, version ");
  cdem_report_escaped(page, source->options->version);
  cdem_report_raw(page, ", commit ");
  cdem_report_escaped(page, source->options->commit);
  cdem_report_raw(page, ".</p></footer>\n</body>\n</html>\n");
  return page->status;
}

cdem_status cdem_report(const cdem_report_options *options, cdem_report_made *made,
                        cdem_fault *fault) {
  cdem_report_source source = {0};
  cdem_report_text page = {.fault = fault};
  cdem_report_made found = {0};
  size_t length = strlen(options->folder);
  bool slash = length > 0 && options->folder[length - 1] == '/';
  if (options->path != NULL)
    snprintf(found.path, sizeof found.path, "%s", options->path);
  else
    snprintf(found.path, sizeof found.path, "%s%sreport.html", options->folder, slash ? "" : "/");
  cdem_status status = cdem_report_source_read(options, found.path, &source, fault);
  if (status == CDEM_OK)
    status = cdem_report_page(&source, &page, &found);
  if (status == CDEM_OK)
    status = cdem_write_text(found.path, page.text, page.used, fault);
  found.bytes = page.used;
  found.finished = source.finished;
  cdem_report_text_release(&page);
  cdem_report_source_release(&source);
  if (status == CDEM_OK)
    *made = found;
  return status;
}
