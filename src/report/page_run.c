/* What was computed, how to repeat it, and the files. */
#include "report/number.h"
#include "report/source.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- what was computed ---- */

/* Facts of summary.json with a name of their own; others are shown under the name they have there.
 */
static const struct {
  const char *fact, *title, *unit;
} known[] = {{"steps", "Steps", ""},
             {"time", "Time of the run", "s"},
             {"time_step", "Step at the end", "s"},
             {"step_limited_by", "Step limited by", ""},
             {"nodes", "Nodes", ""},
             {"unknowns", "Unknowns", ""},
             {"elements", "Elements", ""},
             {"distinct_elements", "Distinct elements", ""},
             {"blocks", "Blocks", ""},
             {"interfaces", "Faces between blocks", ""},
             {"grains", "Grains", ""},
             {"solid", "Volume of the grains", "m3"},
             {"contacts", "Contacts at the end", ""},
             {"walls", "Walls", ""},
             {"bonds", "Bonds", ""},
             {"grain_steps_per_second", "Grains times steps a second", ""},
             {"fine_grains", "Grains of the fine region", ""},
             {"interface_grains", "Interface grains", ""},
             {"cycles", "Steps of the grains a step of the medium", ""},
             {"coarse_step_limit", "Longest stable step of the medium", "s"},
             {"wall_time", "Wall time", "s"},
             {"wall_fine", "Wall time of the grains", "s"},
             {"wall_coarse", "Wall time of the medium", "s"},
             {"wall_transfer", "Wall time of the coupling", "s"},
             {"energy_error", "Closing error of the energy book", ""}};

/* Told elsewhere on the page. */
static bool is_provenance(const char *fact) {
  static const char *const told[] = {"program", "version", "commit", "build",
                                     "title",   "case",    "threads"};
  for (size_t i = 0; i < sizeof told / sizeof told[0]; i++)
    if (strcmp(fact, told[i]) == 0)
      return true;
  return strncmp(fact, "checksums.", 10) == 0;
}

static void put_fact(const cdem_summary_fact *fact, bool plane, cdem_report_text *to) {
  const char *title = NULL, *unit = "";
  char text[CDEM_REPORT_NUMBER];
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
    if (strcmp(fact->name, known[i].fact) == 0) {
      title = known[i].title;
      unit = known[i].unit;
    }
  if (plane && strcmp(fact->name, "solid") == 0) {
    title = "Area of the grains";
    unit = "m2";
  }
  cdem_report_raw(to, "<tr><th scope=\"row\">");
  if (title != NULL)
    cdem_report_raw(to, title);
  else
    cdem_report_words(to, fact->name);
  cdem_report_raw(to, "</th><td>");
  bool whole = fabs(fact->number) < 1e15 && fact->number == floor(fact->number);
  if (isnan(fact->number))
    cdem_report_escaped(to, fact->text);
  else if (strncmp(fact->name, "wall_", 5) == 0)
    cdem_report_raw(to, cdem_report_duration(fact->number, text));
  else
    cdem_report_raw(to, cdem_report_quantity(fact->number, whole ? 15 : 5, unit, text));
  cdem_report_raw(to, "</td></tr>\n");
}

static void begin_table(cdem_report_text *to, const char *caption) {
  cdem_report_format(
      to, "<div class=\"wide\"><table class=\"facts\"><caption><span>%s</span></caption><tbody>\n",
      caption);
}

/* Of a run that has not ended: what its history says. */
static void put_reached(const cdem_table *history, cdem_report_text *to) {
  static const char *const column[] = {"step", "time", "time_step"}, *const unit[] = {"", "s", "s"};
  char text[CDEM_REPORT_NUMBER];
  begin_table(to, "Where the run stands by the last row of its history; sizes are told at its end");
  for (int i = 0; i < 3; i++) {
    int c = cdem_table_find(history, column[i]);
    if (c < 0 || history->rows == 0)
      continue;
    const cdem_value *value = cdem_table_at(history, history->rows - 1, c);
    cdem_report_raw(to, "<tr><th scope=\"row\">");
    cdem_report_words(to, column[i]);
    cdem_report_format(to, "</th><td>%s</td></tr>\n",
                       cdem_report_quantity(value->absent ? (double)NAN : value->real,
                                            i == 0 ? 15 : 5, unit[i], text));
  }
  cdem_report_raw(to, "</tbody></table></div>\n");
}

void cdem_report_put_computed(const cdem_report_source *source, cdem_report_text *to,
                              cdem_report_made *made) {
  const cdem_summary_file *summary = &source->summary;
  (void)made;
  if (!source->finished) {
    put_reached(&source->history, to);
    return;
  }
  begin_table(to, "Sizes, steps and what they took");
  for (int64_t i = 0; i < summary->facts; i++) {
    const cdem_summary_fact *fact = &summary->fact[i];
    bool empty = fact->text == NULL || fact->text[0] == '\0';
    if (!is_provenance(fact->name) && !empty)
      put_fact(fact, source->cases.values.grains.dimension == 2, to);
  }
  cdem_report_raw(to, "</tbody></table></div>\n");
}

/* ---- how to repeat it ---- */

static void put_line(cdem_report_text *to, const char *title, const char *value) {
  if (value == NULL || value[0] == '\0')
    return;
  cdem_report_format(to, "<tr><th scope=\"row\">%s</th><td>", title);
  cdem_report_escaped(to, value);
  cdem_report_raw(to, "</td></tr>\n");
}

static void put_integer(cdem_report_text *to, const char *title, int64_t value) {
  cdem_report_format(to, "<tr><th scope=\"row\">%s</th><td>%lld</td></tr>\n", title,
                     (long long)value);
}

/* Seeds of what is made by chance in this case. */
static void put_seeds(const cdem_case *cases, cdem_report_text *to) {
  const cdem_case_values *values = &cases->values;
  if (cdem_case_given(cases, "grains.packing"))
    put_integer(to, "Seed of the packing", values->grains.packing.seed);
  if (cdem_case_has_deformable(cases))
    put_integer(to, "Seed of the grains' turns", values->grains.deformable.seed);
  if (values->mesh.distortion > 0.0)
    put_integer(to, "Seed of the mesh", values->mesh.seed);
}

static void put_provenance(const cdem_report_source *source, cdem_report_text *to) {
  const cdem_summary_file *summary = &source->summary;
  const cdem_listed *written =
      cdem_listing_find(&source->listing, source->finished ? "summary.json" : "history.csv");
  char text[CDEM_REPORT_NUMBER];
  begin_table(to, "Where the numbers come from");
  put_line(to, "Program", cdem_summary_fact_find(summary, "program"));
  put_line(to, "Version", cdem_summary_fact_find(summary, "version"));
  put_line(to, "Commit", cdem_summary_fact_find(summary, "commit"));
  put_line(to, "Build", cdem_summary_fact_find(summary, "build"));
  put_line(to, "Case file", cdem_summary_fact_find(summary, "case"));
  put_line(to, "Checksum of the case", cdem_summary_fact_find(summary, "checksums.case"));
  put_line(to, "Checksum of the mesh", cdem_summary_fact_find(summary, "checksums.mesh"));
  put_line(to, "Checksum of the grains", cdem_summary_fact_find(summary, "checksums.grains"));
  put_seeds(&source->cases, to);
  put_line(to, "Threads", cdem_summary_fact_find(summary, "threads"));
  if (source->finished)
    put_line(to, "Wall time", cdem_report_duration(summary->wall_time, text));
  if (written != NULL)
    put_line(to, source->finished ? "Ended" : "Last row written",
             cdem_report_date(written->changed, text));
  if (source->finished && summary->warnings == 0)
    put_line(to, "Warnings", "none");
  cdem_report_raw(to, "</tbody></table></div>\n");
}

static void put_path(cdem_report_text *to, const char *place, const char *rest) {
  char path[4400];
  snprintf(path, sizeof path, "%.4000s%s", place, rest);
  cdem_report_argument(to, path);
}

void cdem_report_put_repeat(const cdem_report_source *source, cdem_report_text *to,
                            cdem_report_made *made) {
  const char *place = source->place, *threads = cdem_summary_fact_find(&source->summary, "threads");
  (void)made;
  cdem_report_raw(to, "<p>The folder holds the case with everything that was set; the same version "
                      "computes the same bits from it, with any number of threads.</p>\n"
                      "<div class=\"wide\"><pre class=\"command\">cdem run ");
  put_path(to, place, "/case.yaml");
  cdem_report_raw(to, " -o ");
  put_path(to, place, "-again");
  if (threads != NULL) {
    cdem_report_raw(to, " --threads ");
    cdem_report_argument(to, threads);
  }
  cdem_report_raw(to, "\ncdem compare ");
  put_path(to, place, "");
  cdem_report_raw(to, " ");
  put_path(to, place, "-again");
  cdem_report_raw(to, "\n");
  if (!source->finished) {
    cdem_report_raw(to, "cdem run --resume ");
    put_path(to, place, "");
    cdem_report_raw(to, "\n");
  }
  cdem_report_raw(to, "cdem report ");
  put_path(to, place, "");
  cdem_report_raw(to, "</pre></div>\n");
  put_provenance(source, to);
}

/* ---- files ---- */

static void put_link(const cdem_report_source *source, const char *file, cdem_report_text *to) {
  cdem_report_raw(to, "<tr><th scope=\"row\"><a href=\"");
  cdem_report_link(to, source->way);
  cdem_report_link(to, file);
  cdem_report_raw(to, "\"><code>");
  cdem_report_escaped(to, file);
  cdem_report_raw(to, "</code></a></th><td>");
}

static void end_link(cdem_report_text *to, int64_t bytes) {
  char text[CDEM_REPORT_NUMBER];
  cdem_report_format(to, "</td><td class=\"number\">%s</td></tr>\n", cdem_report_size(bytes, text));
}

static void put_sets(const cdem_report_source *source, cdem_report_text *to) {
  for (int64_t i = 0; i < source->sets; i++) {
    const cdem_report_set *set = &source->set[i];
    put_link(source, set->file, to);
    cdem_report_format(to, "%lld frame%s for ParaView", (long long)set->frames,
                       set->frames == 1 ? "" : "s");
    end_link(to, set->bytes);
  }
}

static void put_figures(const cdem_report_source *source, cdem_report_text *to) {
  int64_t bytes = 0;
  for (int64_t i = 0; i < source->figures.count; i++)
    bytes += source->figures.item[i].bytes;
  if (source->figures.count == 0)
    return;
  put_link(source, "figures/", to);
  cdem_report_format(to,
                     "%lld files: pictures as PNG and SVG, with the data and scripts that draw "
                     "them",
                     (long long)source->figures.count);
  end_link(to, bytes);
}

void cdem_report_put_files(const cdem_report_source *source, cdem_report_text *to,
                           cdem_report_made *made) {
  static const struct {
    const char *name, *what;
  } file[] = {{"summary.json", "settings, sizes, key results, for scripts"},
              {"history.csv", "every number over time"},
              {"case.yaml", "the case as run"},
              {"checkpoint.h5", "the last state, to go on from"}};
  (void)made;
  cdem_report_raw(to,
                  "<div class=\"wide\"><table><caption><span>Files of the run; the links lead from "
                  "where this page was written to</span></caption><thead><tr><th "
                  "scope=\"col\">File</th><th scope=\"col\">What</th><th scope=\"col\" "
                  "class=\"number\">Size</th></tr></thead><tbody>\n");
  put_sets(source, to);
  put_figures(source, to);
  for (size_t i = 0; i < sizeof file / sizeof file[0]; i++) {
    const cdem_listed *found = cdem_listing_find(&source->listing, file[i].name);
    if (found == NULL)
      continue;
    put_link(source, file[i].name, to);
    cdem_report_raw(to, file[i].what);
    if (strcmp(file[i].name, "history.csv") == 0)
      cdem_report_format(to, ", %lld rows of %d columns", (long long)source->history.rows,
                         source->history.columns);
    end_link(to, found->bytes);
  }
  cdem_report_raw(to, "</tbody></table></div>\n");
}
