#include "springs_report.h"

#include "io/io.h"

#include <inttypes.h>
#include <math.h>

/* One line of the certificate: both writers walk the same list. */
typedef struct {
  const char *key, *text;
  double value, bound; /* bound NaN: reported only */
  const cdem_worst *where;
  bool known;
} certificate_line;

enum { LINES = 9 };

static int certificate_lines(const cdem_certificate *c, certificate_line line[LINES]) {
  const certificate_line all[LINES] = {
      {"rebuild", "rows rebuild S_ij, |S - rows|/|S|", c->rebuild.value, c->rebuild_bound,
       &c->rebuild, true},
      {"translation", "no force in a translation, against B'DB", c->translation.value,
       c->translation_bound, &c->translation, true},
      {"rotation", "no force in a rotation", c->rotation.value, c->rotation_bound, &c->rotation,
       c->has_rotation},
      {"assembled", "assembled network - finite elements", c->assembled, c->assembled_bound, NULL,
       true},
      {"patch", "patch test, force on interior nodes", c->patch, c->patch_bound, NULL,
       c->patch_nodes > 0},
      {"zero_modes", "zero modes - rigid modes", fabs((double)(c->zero_modes - c->rigid_modes)),
       0.0, NULL, c->zero_modes >= 0},
      {"negative_modes", "negative modes", (double)c->negative_modes, 0.0, NULL,
       c->negative_modes >= 0},
      {"skew", "largest skew fraction, |S - S'|/(2|S|)", c->skew.value, NAN, &c->skew, true},
      {"cond", "largest cond(P)", c->cond.value, NAN, &c->cond, true},
  };
  for (int i = 0; i < LINES; i++)
    line[i] = all[i];
  return LINES;
}

static void print_where(const cdem_worst *where, FILE *stream) {
  if (where == NULL || where->element < 0)
    return;
  fprintf(stream, "  element %" PRId64, where->element);
  if (where->node[1] >= 0)
    fprintf(stream, ", pair %" PRId64 "-%" PRId64, where->node[0], where->node[1]);
  else
    fprintf(stream, ", node %" PRId64, where->node[0]);
}

static void print_certificate(const cdem_certificate *c, FILE *stream) {
  certificate_line line[LINES];
  fprintf(stream, "\n%-42s %10s %8s\n", "certificate", "value", "bound");
  for (int i = 0; i < certificate_lines(c, line); i++) {
    if (!line[i].known) {
      fprintf(stream, "  %-40s %10s\n", line[i].text, "not done");
      continue;
    }
    fprintf(stream, "  %-40s %10.2e", line[i].text, line[i].value);
    if (isnan(line[i].bound))
      fprintf(stream, " %8s      ", "");
    else
      fprintf(stream, " %8.0e  %s", line[i].bound,
              line[i].value <= line[i].bound ? "ok  " : "FAIL");
    print_where(line[i].where, stream);
    fputc('\n', stream);
  }
  fprintf(stream, "  %" PRId32 " connected part%s; ", c->components, c->components == 1 ? "" : "s");
  if (c->zero_modes >= 0)
    fprintf(stream, "%" PRId64 " zero modes counted, %" PRId64 " expected; ", c->zero_modes,
            c->rigid_modes);
  else
    fprintf(stream, "zero modes not counted (--mode-rows); ");
  fprintf(stream, "%" PRId64 " interior nodes in the patch test\n", c->patch_nodes);
}

static void print_census(const springs_report *report, FILE *stream) {
  const cdem_certificate *c = &report->certificate;
  fprintf(stream, "\n%-8s", "pairs");
  for (int f = 0; f < CDEM_FORM_COUNT; f++)
    fprintf(stream, " %12s", cdem_form_name(f));
  fputc('\n', stream);
  for (int k = 0; k < CDEM_CLASS_COUNT; k++) {
    fprintf(stream, "  %-6s", cdem_class_name(k));
    for (int f = 0; f < CDEM_FORM_COUNT; f++)
      fprintf(stream, " %12" PRId64, c->census[k][f]);
    fputc('\n', stream);
  }
  fprintf(stream,
          "  %" PRId64 " springs, %" PRId64
          " of them negative (%.1f %%); mean skew fraction %.3g\n",
          c->springs, c->negative,
          c->springs > 0 ? 100.0 * (double)c->negative / (double)c->springs : 0.0, c->skew_mean);
}

static void print_depletion(const cdem_depletion *d, FILE *stream) {
  fprintf(stream, "\ndepletion: %" PRId64 " springs of %" PRId64 " pairs taken out\n", d->springs,
          d->pairs);
  fprintf(stream,
          "  lowest eigenvalue of the symmetric part  %.6e N/m (bound of all: %.3e), %" PRId64
          " negative, %" PRId64 " zero  %s\n",
          d->lowest, d->norm, d->negative_modes, d->zero_modes,
          d->negative_modes == 0 ? "ok" : "UNSAFE");
  fprintf(stream, "  skew fraction of the matrix              %.3e  %s\n", d->skew,
          d->skew <= 1e-10 ? "ok" : "UNSAFE");
  fprintf(stream, "  rigid modes no longer force-free         %d of %d  %s\n", d->rigid_lost,
          d->rigid_modes, d->rigid_lost == 0 ? "ok" : "UNSAFE");
  fprintf(stream, "  the depleted network is %s\n",
          d->safe ? "safe" : "NOT safe: put fracture on interfaces between blocks");
}

static void print_carried(const cdem_carried *c, FILE *stream) {
  if (c->pairs == 0)
    return;
  fprintf(stream, "  of %" PRId64 " pairs, summed over the elements\n", c->pairs);
  fprintf(stream, "    %12" PRId64 " are a spring along their line\n", c->along);
  fprintf(stream, "    %12" PRId64 " are that and one stiffness across it\n", c->across);
  fprintf(stream, "    %12" PRId64 " hold more", c->other);
  if (c->looped > 0)
    fprintf(stream, ", in a loop of the script");
  if (c->cut > 0)
    fprintf(stream,
            "\n    %12" PRId64 " are cut: %.3g of the network's norm is lost; pair %" PRId64
            "-%" PRId64 " loses %.3g of its own",
            c->cut, c->lost, c->worst_node[0], c->worst_node[1], c->worst);
  fputc('\n', stream);
}

void springs_report_text(const springs_report *report, FILE *stream) {
  const cdem_model *model = report->model;
  fprintf(stream, "%s: %" PRId32 " elements (", report->mesh, model->cells);
  for (int i = 0; i < model->kinds; i++)
    fprintf(stream, "%s%" PRId64 " %s", i > 0 ? ", " : "", model->kinds_of[i].cells,
            model->kinds_of[i].tabulation.element->name);
  fprintf(stream, "), %" PRId64 " node pairs\n", model->pairs);
  for (int i = 0; i < report->outputs; i++) {
    fprintf(stream, "%s %s (%" PRId64 " pairs)\n", i == 0 ? "wrote" : "     ", report->output[i],
            report->pairs_written);
    print_carried(&report->carried[i], stream);
  }
  if (report->certified) {
    print_census(report, stream);
    print_certificate(&report->certificate, stream);
  }
  if (report->depleted)
    print_depletion(&report->depletion, stream);
}

/* ---- JSON ---- */

static void json_worst(FILE *stream, const cdem_worst *where) {
  if (where == NULL || where->element < 0)
    return;
  fprintf(stream, ", \"element\": %" PRId64 ", \"nodes\": [%" PRId64, where->element,
          where->node[0]);
  if (where->node[1] >= 0)
    fprintf(stream, ", %" PRId64, where->node[1]);
  fprintf(stream, "]");
}

static void json_certificate(const cdem_certificate *c, FILE *stream) {
  certificate_line line[LINES];
  fprintf(stream, ",\n  \"census\": {");
  for (int k = 0; k < CDEM_CLASS_COUNT; k++) {
    fprintf(stream, "%s\"%s\": {", k > 0 ? ", " : "", cdem_class_name(k));
    for (int f = 0; f < CDEM_FORM_COUNT; f++)
      fprintf(stream, "%s\"%s\": %" PRId64, f > 0 ? ", " : "", cdem_form_name(f), c->census[k][f]);
    fprintf(stream, "}");
  }
  fprintf(stream,
          "},\n  \"springs\": %" PRId64 ", \"negative_springs\": %" PRId64 ", \"mean_skew\": ",
          c->springs, c->negative);
  cdem_json_number(stream, c->skew_mean);
  fprintf(stream,
          ",\n  \"certificate\": {\n    \"pass\": %s, \"parts\": %" PRId32
          ", \"rigid_modes\": %" PRId64 ", \"zero_modes_counted\": ",
          cdem_certificate_holds(c) ? "true" : "false", c->components, c->rigid_modes);
  if (c->zero_modes >= 0)
    fprintf(stream, "%" PRId64, c->zero_modes);
  else
    fprintf(stream, "null");
  fprintf(stream, ", \"patch_nodes\": %" PRId64, c->patch_nodes);
  for (int i = 0; i < certificate_lines(c, line); i++) {
    fprintf(stream, ",\n    \"%s\": {\"value\": ", line[i].key);
    cdem_json_number(stream, line[i].known ? line[i].value : NAN);
    fprintf(stream, ", \"bound\": ");
    cdem_json_number(stream, line[i].bound);
    if (line[i].known)
      json_worst(stream, line[i].where);
    fprintf(stream, "}");
  }
  fprintf(stream, "\n  }");
}

static void json_depletion(const cdem_depletion *d, FILE *stream) {
  fprintf(stream,
          ",\n  \"depletion\": {\"safe\": %s, \"springs\": %" PRId64 ", \"pairs\": %" PRId64
          ", \"lowest_eigenvalue\": ",
          d->safe ? "true" : "false", d->springs, d->pairs);
  cdem_json_number(stream, d->lowest);
  fprintf(stream, ", \"norm\": ");
  cdem_json_number(stream, d->norm);
  fprintf(stream, ", \"negative_modes\": %" PRId64 ", \"zero_modes\": %" PRId64 ", \"skew\": ",
          d->negative_modes, d->zero_modes);
  cdem_json_number(stream, d->skew);
  fprintf(stream, ", \"rigid_modes\": %d, \"rigid_modes_lost\": %d}", d->rigid_modes,
          d->rigid_lost);
}

/* One object an output, null for formats that hold everything. */
static void json_carried(const springs_report *report, FILE *stream) {
  fprintf(stream, "],\n  \"carried\": [");
  for (int i = 0; i < report->outputs; i++) {
    const cdem_carried *c = &report->carried[i];
    fputs(i > 0 ? ", " : "", stream);
    if (c->pairs == 0) {
      fputs("null", stream);
      continue;
    }
    fprintf(stream,
            "{\"pairs\": %" PRId64 ", \"along\": %" PRId64 ", \"across\": %" PRId64
            ", \"other\": %" PRId64 ", \"looped\": %" PRId64 ", \"cut\": %" PRId64 ", \"lost\": ",
            c->pairs, c->along, c->across, c->other, c->looped, c->cut);
    cdem_json_number(stream, c->lost);
    fputs("}", stream);
  }
}

void springs_report_json(const springs_report *report, FILE *stream) {
  const cdem_model *model = report->model;
  fprintf(stream, "{\n  \"mesh\": ");
  cdem_json_text(stream, report->mesh);
  fprintf(stream, ",\n  \"elements\": %" PRId32 ", \"kinds\": {", model->cells);
  for (int i = 0; i < model->kinds; i++)
    fprintf(stream, "%s\"%s\": %" PRId64, i > 0 ? ", " : "",
            model->kinds_of[i].tabulation.element->name, model->kinds_of[i].cells);
  fprintf(stream, "},\n  \"pairs\": %" PRId64 ", \"pairs_written\": %" PRId64 ", \"outputs\": [",
          model->pairs, report->pairs_written);
  for (int i = 0; i < report->outputs; i++) {
    fprintf(stream, "%s", i > 0 ? ", " : "");
    cdem_json_text(stream, report->output[i]);
  }
  json_carried(report, stream);
  fprintf(stream, "],\n  \"seconds\": ");
  cdem_json_number(stream, report->seconds);
  if (report->certified)
    json_certificate(&report->certificate, stream);
  if (report->depleted)
    json_depletion(&report->depletion, stream);
  fprintf(stream, "\n}\n");
}
