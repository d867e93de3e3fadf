/* cdem springs MESH: reads a mesh, gives it a material, writes the spring sets, certifies them. */
#include "springs_figure.h"
#include "springs_options.h"
#include "springs_report.h"

#include <inttypes.h>
#include <string.h>
#include <time.h>

typedef struct {
  cdem_mesh mesh;
  cdem_material_file file;
  cdem_model model;
  cdem_springs_writer *writer[MOST_OUTPUTS];
  cdem_certifier *certifier;
  springs_figure *figure;
} things;

static void release(things *t) {
  for (int i = 0; i < MOST_OUTPUTS; i++)
    cdem_springs_writer_destroy(&t->writer[i]);
  cdem_certifier_destroy(&t->certifier);
  springs_figure_destroy(&t->figure);
  cdem_model_release(&t->model);
  cdem_material_file_release(&t->file);
  cdem_mesh_release(&t->mesh);
}

static cdem_status load(const springs_settings *s, things *t, cdem_fault *fault) {
  cdem_model_options options = {.mesh = &t->mesh,
                                .groups = s->groups,
                                .group = s->group,
                                .materials = 1,
                                .material = &s->material,
                                .default_material = -1,
                                .section = s->section,
                                .degree = s->degree,
                                .length = s->length};
  if (s->material_file != NULL) {
    CDEM_TRY(cdem_read_materials(s->material_file, &t->file, fault));
    options.materials = t->file.materials;
    options.material = t->file.material;
    options.assignments = t->file.assignments;
    options.assigned_group = (const char *const *)t->file.group;
    options.assigned_material = t->file.material_of;
    options.default_material = t->file.default_material;
  }
  const cdem_warnings warnings = command_warnings();
  command_say("reading %s", s->mesh);
  command_guard(s->mesh);
  cdem_status status = cdem_read_mesh(s->mesh, &t->mesh, &warnings, fault);
  command_guard(NULL);
  CDEM_TRY(status);
  status = cdem_model_init(&options, &t->model, fault);
  if (status != CDEM_OK) {
    cdem_fault_prefix(fault, "mesh '%s'", s->mesh);
    return status;
  }
  if (t->model.dimension == 2 && !(s->plane && s->thickness))
    command_say("plane %s, thickness %g m",
                s->section.plane == CDEM_PLANE_STRAIN ? "strain" : "stress", s->section.thickness);
  if (t->model.dimension == 3 && (s->plane || s->thickness))
    command_warn("--plane and --thickness mean nothing for a three-dimensional mesh");
  int64_t coincident;
  int32_t first, second;
  CDEM_TRY(cdem_mesh_coincident_nodes(&t->mesh, t->model.cell, t->model.cells, 0.0, &coincident,
                                      &first, &second, fault));
  if (coincident > 0)
    command_warn("%" PRId64 " pairs of nodes lie at one place (the first: nodes %" PRId64
                 " and %" PRId64 "); the network is not connected there",
                 coincident, t->mesh.node_tag[first], t->mesh.node_tag[second]);
  return CDEM_OK;
}

/* Counts what the filter lets through. */
static cdem_status count_pairs(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                               cdem_fault *fault) {
  (void)buffer, (void)fault;
  *(int64_t *)context += chunk->pairs;
  return CDEM_OK;
}

static cdem_status write_springs(const springs_settings *s, things *t, int64_t *written,
                                 cdem_fault *fault) {
  cdem_pair_sink sink[MOST_OUTPUTS + 2];
  int sinks = 0;
  for (int i = 0; i < s->outputs; i++) {
    const cdem_springs_format *format = springs_format_of(s, s->output[i]);
    bool filtered = s->convert.class_mask != 0 || s->convert.form_mask != 0;
    if (filtered && format->assembled)
      command_warn("'%s' holds the matrix of the filtered springs alone; such a network is not the "
                   "body and may "
                   "be unstable",
                   s->output[i]);
    CDEM_TRY(format->open(s->output[i], &t->model, &t->writer[i], fault));
    t->writer[i]->carry = s->carry;
    sink[sinks++] = t->writer[i]->sink;
  }
  sink[sinks++] = (cdem_pair_sink){.context = written, .write = count_pairs};
  if (s->figures != NULL) {
    CDEM_TRY(springs_figure_create(&t->model, &t->figure, fault));
    sink[sinks++] = springs_figure_sink(t->figure);
  }
  CDEM_TRY(cdem_network_convert(&t->model, &s->convert, sink, sinks, fault));
  if (*written == 0)
    command_warn("no pair passes the filter; the output is empty");
  return CDEM_OK;
}

/* Files appear when everything else has gone well. */
static cdem_status publish(const springs_settings *s, things *t, springs_report *report,
                           cdem_fault *fault) {
  for (int i = 0; i < s->outputs; i++) {
    CDEM_TRY(t->writer[i]->commit(t->writer[i], fault));
    const cdem_carried *c = &t->writer[i]->carried;
    report->carried[i] = *c;
    if (c->cut > 0)
      command_warn("'%s' lacks a part of %" PRId64 " of %" PRId64
                   " pairs, %.3g of the network's norm; it is not the body (--carry exact refuses "
                   "that)",
                   s->output[i], c->cut, c->pairs, c->lost);
  }
  if (s->figures != NULL)
    CDEM_TRY(springs_figure_write(t->figure, s->figures, fault));
  return CDEM_OK;
}

/* All pairs, whatever is filtered for writing. */
static cdem_convert_options unfiltered(const springs_settings *s) {
  cdem_convert_options options = s->convert;
  options.class_mask = options.form_mask = 0;
  return options;
}

static cdem_status certify(const springs_settings *s, things *t, cdem_certificate *certificate,
                           cdem_fault *fault) {
  const cdem_convert_options options = unfiltered(s);
  CDEM_TRY(cdem_certifier_create(&t->model, &t->certifier, fault));
  cdem_pair_sink sink = cdem_certifier_sink(t->certifier);
  CDEM_TRY(cdem_network_convert(&t->model, &options, &sink, 1, fault));
  CDEM_TRY(
      cdem_certifier_finish(t->certifier, s->mode_rows, s->convert.progress, certificate, fault));
  cdem_certifier_destroy(&t->certifier);
  return CDEM_OK;
}

static cdem_status work(const springs_settings *s, things *t, springs_report *report,
                        cdem_fault *fault) {
  struct timespec start, end;
  CDEM_TRY(load(s, t, fault));
  command_catch_interrupt();
  clock_gettime(CLOCK_MONOTONIC, &start);
  if (s->outputs > 0 || s->figures != NULL)
    CDEM_TRY(write_springs(s, t, &report->pairs_written, fault));
  clock_gettime(CLOCK_MONOTONIC, &end);
  report->seconds =
      (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
  if (report->certified)
    CDEM_TRY(certify(s, t, &report->certificate, fault));
  if (s->removals > 0) {
    const cdem_convert_options options = unfiltered(s);
    const cdem_depletion_options out = {s->removals, s->removal, s->mode_rows};
    CDEM_TRY(cdem_network_deplete(&t->model, &options, &out, &report->depletion, fault));
    report->depleted = true;
  }
  return publish(s, t, report, fault);
}

int cmd_springs(int argc, char **argv) {
  springs_settings s;
  springs_options_parse(argc, argv, &s);
  bool straight = false;
  for (int i = 0; i < s.outputs; i++)
    straight = straight || strcmp(s.output[i], "-") == 0;
  s.convert.progress = command_progress();
  things t = {0};
  cdem_fault fault = {0};
  bool nothing_else = s.outputs == 0 && s.removals == 0 && s.figures == NULL;
  springs_report report = {.mesh = s.mesh,
                           .model = &t.model,
                           .outputs = s.outputs,
                           .output = s.output,
                           .certified = s.certify || nothing_else};
  int code = 0;
  if (work(&s, &t, &report, &fault) != CDEM_OK) {
    code = command_fail(&fault);
  } else {
    command_progress_end();
    FILE *stream = straight ? stderr : stdout;
    (s.json ? springs_report_json : springs_report_text)(&report, stream);
    bool failed = (report.certified && !cdem_certificate_holds(&report.certificate)) ||
                  (report.depleted && !report.depletion.safe);
    code = failed ? cdem_status_exit_code(CDEM_CHECK) : 0;
  }
  release(&t);
  return code;
}
