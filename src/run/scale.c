/* From a case file to its scaled copy. */
#include "run/scale.h"

#include "cases/places.h"
#include "io/case_file.h"
#include "io/grains_file.h"
#include "run/history.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const cdem_scale_options *options;
  cdem_scaling scaling;
  cdem_case cases; /* read from its own text, so that each number has a place in it */
  cdem_scaled_list list;
  cdem_table columns;       /* of the history, where they are needed */
  char grains[4096];        /* path of the scaled table of grains; "": none */
  char *grains_name;        /* as the case names it */
  char *text;               /* of the scaled case */
  cdem_case_change *change; /* [changes] */
  int64_t changes;
} scaling_job;

/* ---- the case, with files that are found from the new place ---- */

/* "a/b.yaml" -> "a", "b.yaml" -> "."; newly allocated, from the root on; NULL: there is none. */
static char *folder_of(const char *path) {
  char folder[4096];
  const char *slash = strrchr(path, '/');
  snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - path) : 1,
           slash != NULL ? path : ".");
  return realpath(slash == path ? "/" : folder, NULL);
}

static bool same_folder(const char *one, const char *other) {
  char *a = folder_of(one), *b = folder_of(strcmp(other, "-") == 0 ? "" : other);
  bool same = a != NULL && b != NULL && strcmp(a, b) == 0;
  free(a);
  free(b);
  return same;
}

/* The scaled case must not take the place of its original. */
static bool same_file(const char *one, const char *other) {
  char *a = realpath(one, NULL), *b = realpath(other, NULL);
  bool same = a != NULL && b != NULL && strcmp(a, b) == 0;
  free(a);
  free(b);
  return same;
}

static cdem_status read_case(scaling_job *job, cdem_fault *fault) {
  const cdem_scale_options *o = job->options;
  cdem_case first = {0};
  CDEM_REQUIRE(o->output == NULL || !same_file(o->path, o->output), fault, CDEM_USAGE,
               "'%s' is the case itself; give the scaled one another name with -o", o->output);
  CDEM_TRY(cdem_read_case(o->path, o->overrides, o->override, &first, fault));
  cdem_status status = CDEM_OK;
  if (o->output != NULL && strcmp(o->output, "-") == 0 && cdem_case_given(&first, "grains.file"))
    status = cdem_case_fail(&first, "grains.file", CDEM_INPUT, fault,
                            "the table of grains is scaled into a file beside the case; name the "
                            "case with -o");
  if (status == CDEM_OK && o->output != NULL && !same_folder(o->path, o->output))
    status = cdem_case_settle_files(&first, o->overrides, o->override, fault);
  if (status == CDEM_OK)
    status = cdem_read_case_text(o->path, first.source, &job->cases, fault);
  cdem_case_release(&first);
  if (status == CDEM_OK && cdem_case_has_grains(&job->cases))
    job->scaling.dim = (int)job->cases.values.grains.dimension;
  return status;
}

/* ---- units of columns ---- */

static const char *unit_of(void *context, const char *column) {
  const cdem_table *table = context;
  int found = cdem_run_history_find(table, column);
  return found >= 0 ? table->column[found].unit : NULL;
}

static cdem_status find_columns(scaling_job *job, cdem_fault *fault) {
  const cdem_scale_options *o = job->options;
  const cdem_run_options options = {.path = o->path,
                                    .overrides = o->overrides,
                                    .override = o->override,
                                    .check = true,
                                    .progress = o->progress,
                                    .warnings = o->warnings};
  cdem_run_setup setup = {0};
  CDEM_TRY(cdem_run_setup_init(&options, NULL, &setup, fault));
  cdem_status status = cdem_run_history_init(&setup, &job->columns, fault);
  cdem_run_setup_release(&setup);
  return status;
}

static cdem_status apply(scaling_job *job, cdem_fault *fault) {
  const cdem_scaling_columns columns = {&job->columns, unit_of};
  bool needed = cdem_scaling_needs_columns(&job->cases);
  if (needed)
    CDEM_TRY(find_columns(job, fault));
  return cdem_scaling_apply(&job->cases, &job->scaling, needed ? &columns : NULL, &job->list,
                            fault);
}

/* ---- tables of grains ---- */

static void multiply(double *value, int64_t count, double factor) {
  for (int64_t i = 0; value != NULL && i < count; i++)
    value[i] *= factor;
}

/* The copy must not take the place of the table, either. */
static cdem_status check_grains(const scaling_job *job, const char *path, cdem_fault *fault) {
  if (!same_file(path, job->grains))
    return CDEM_OK;
  return cdem_case_fail(&job->cases, "grains.file", CDEM_USAGE, fault,
                        "the scaled table of grains would overwrite '%s'; give the scaled case "
                        "another name with -o",
                        path);
}

static cdem_status scale_grains(const scaling_job *job, cdem_fault *fault) {
  static const cdem_dimension velocity = {1, -1, 0}, rate = {0, -1, 0};
  const cdem_ratios *ratios = &job->scaling.ratios;
  cdem_grain_table table = {0};
  char *path = cdem_case_file_path(&job->cases, job->cases.values.grains.file, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = check_grains(job, path, fault);
  if (status == CDEM_OK) {
    status = cdem_read_grains(path, (int)job->cases.values.grains.dimension, &table, fault);
    if (status != CDEM_OK)
      cdem_case_blame(&job->cases, "grains.file", fault);
  }
  free(path);
  CDEM_TRY(status);
  cdem_grains *g = &table.grains;
  multiply(g->xyz, 3 * g->grains, cdem_ratio(ratios, CDEM_LENGTH));
  multiply(g->radius, g->grains, cdem_ratio(ratios, CDEM_LENGTH));
  multiply(g->velocity, 3 * g->grains, cdem_ratio(ratios, velocity));
  multiply(g->spin, 3 * g->grains, cdem_ratio(ratios, rate));
  status = cdem_write_grains(job->grains, g, table.names, (const char *const *)table.name, fault);
  cdem_grain_table_release(&table);
  return status;
}

/* "out/scaled.yaml" -> "out/scaled-grains.csv", which the case calls "scaled-grains.csv". */
static cdem_status name_grains(scaling_job *job, cdem_fault *fault) {
  const char *output = job->options->output;
  if (!cdem_case_given(&job->cases, "grains.file") || output == NULL)
    return CDEM_OK;
  const char *slash = strrchr(output, '/'), *name = slash != NULL ? slash + 1 : output;
  const char *dot = strrchr(name, '.');
  int stem = dot != NULL && dot != name ? (int)(dot - output) : (int)strlen(output);
  int used = snprintf(job->grains, sizeof job->grains, "%.*s-grains.csv", stem, output);
  CDEM_REQUIRE(used > 0 && (size_t)used < sizeof job->grains, fault, CDEM_INPUT,
               "the name '%.40s...' is too long", output);
  name = job->grains + (name - output);
  job->grains_name = cdem_allocate(2 * (int64_t)strlen(name) + 3, 1, fault);
  if (job->grains_name == NULL)
    return CDEM_MEMORY;
  char *at = job->grains_name;
  *at++ = '\'';
  for (; *name != '\0'; name++) { /* YAML doubles an apostrophe */
    *at++ = *name;
    if (*name == '\'')
      *at++ = *name;
  }
  strcpy(at, "'");
  return CDEM_OK;
}

/* ---- the text ---- */

static cdem_status collect_changes(scaling_job *job, cdem_fault *fault) {
  CDEM_NEW(job->change, job->list.count + 1, fault);
  for (int64_t i = 0; i < job->list.count; i++) {
    const cdem_scaled *item = &job->list.item[i];
    if (item->factor == 1.0)
      continue;
    job->change[job->changes++] = (cdem_case_change){.quantity = item->quantity,
                                                     .section = item->section,
                                                     .key = item->key,
                                                     .value = item->value};
  }
  if (job->grains_name != NULL)
    job->change[job->changes++] =
        (cdem_case_change){.quantity = -1, .key = "grains.file", .text = job->grains_name};
  return CDEM_OK;
}

/* What was done, for people; without a place, so that the same case gives the same text anywhere.
 */
static void write_heading(const scaling_job *job, char text[600]) {
  const cdem_scaling *s = &job->scaling;
  const char *path = job->options->path, *slash = strrchr(path, '/');
  const char *name = slash != NULL ? slash + 1 : path;
  if (s->coarse)
    snprintf(text, 600,
             "# %.200s, coarse-grained by h = %.17g (cdem scale): %s; the domain is driven %s.\n",
             name, s->ratios.length,
             s->rule ? "parameters of the grains by the rule" : "sizes of the grains alone",
             s->slow ? "slower by h" : "as before");
  else
    snprintf(text, 600,
             "# %.200s, scaled exactly (cdem scale): length %.17g, time %.17g, mass %.17g.\n", name,
             s->ratios.length, s->ratios.time, s->ratios.mass);
}

/* Each number of the text must come back as it was meant: the bits are what scaling promises. */
static cdem_status check_text(const scaling_job *job, cdem_fault *fault) {
  cdem_case again = {0};
  const char *output = job->options->output;
  cdem_status status = cdem_read_case_text(strcmp(output, "-") == 0 ? "scaled case" : output,
                                           job->text, &again, fault);
  if (status != CDEM_OK) {
    cdem_fault_prefix(fault, "the scaled case cannot be used");
    return status;
  }
  int64_t next = 0;
  for (int64_t i = 0; i < job->list.count && status == CDEM_OK; i++) {
    const cdem_scaled *item = &job->list.item[i];
    if (item->quantity < 0)
      continue;
    while (next < again.places->quantities &&
           strcmp(again.places->quantity[next].key, item->key) != 0)
      next++; /* added keys come in between */
    if (next == again.places->quantities || again.places->quantity[next].value != item->value)
      status = cdem_case_fail(&job->cases, item->key, CDEM_INPUT, fault,
                              "'%s' cannot be written as %.17g here; write its value plainly, on "
                              "one line",
                              item->key, item->value);
    next++;
  }
  cdem_case_release(&again);
  return status;
}

/* The case is written, but for its name, before its table of grains takes the place of an older
 * one: what fails on the way leaves both as they were. */
static cdem_status write_case_and_grains(const scaling_job *job, cdem_fault *fault) {
  cdem_output *file = NULL;
  CDEM_TRY(cdem_output_open(job->options->output, &file, fault));
  cdem_status status = cdem_output_write(file, job->text, strlen(job->text), fault);
  bool written = status == CDEM_OK && fflush(cdem_output_stream(file)) == 0;
  if (written && job->grains_name != NULL)
    status = scale_grains(job, fault);
  if (status == CDEM_OK)
    status = cdem_output_commit(&file, fault); /* tells what flushing met */
  cdem_output_discard(&file);
  return status;
}

static cdem_status write_all(scaling_job *job, cdem_fault *fault) {
  char heading[600];
  CDEM_TRY(name_grains(job, fault));
  if (job->options->output == NULL)
    return CDEM_OK;
  CDEM_TRY(collect_changes(job, fault));
  write_heading(job, heading);
  CDEM_TRY(cdem_case_rewrite(&job->cases, heading, job->changes, job->change, &job->text, fault));
  CDEM_TRY(check_text(job, fault));
  return write_case_and_grains(job, fault);
}

/* ---- what was done, key by key ---- */

/* "walls.left.velocity" -> "walls.velocity", "supports[1].velocity" -> "supports.velocity": the
 * names of entries and their numbers go. */
static void plain_key(const cdem_scaled *item, char key[CDEM_CASE_PATH]) {
  const cdem_case_section *section = cdem_case_root();
  char path[CDEM_CASE_PATH], *rest = path;
  bool added = item->added != NULL && item->section[0] != '\0';
  snprintf(path, sizeof path, "%.120s%s%.120s", added ? item->section : "", added ? "." : "",
           item->key);
  size_t used = 0;
  for (char *word; (word = strsep(&rest, ".")) != NULL;) {
    word[strcspn(word, "[")] = '\0';
    used += (size_t)snprintf(key + used, CDEM_CASE_PATH - used, "%s%s", used > 0 ? "." : "", word);
    const cdem_case_key *found = section != NULL ? cdem_case_key_find(section, word) : NULL;
    section = found != NULL ? found->section : NULL;
    if (found != NULL && found->kind == CDEM_KEY_NAMED)
      strsep(&rest, "."); /* a name */
  }
}

static bool is_same_row(const cdem_scaled_row *row, const cdem_scaled_row *other) {
  return strcmp(row->key, other->key) == 0 && row->factor == other->factor &&
         memcmp(&row->dimension, &other->dimension, sizeof row->dimension) == 0;
}

static cdem_status fill_table(const scaling_job *job, cdem_scaled_table *table, cdem_fault *fault) {
  *table = (cdem_scaled_table){.scaling = job->scaling};
  CDEM_NEW(table->row, job->list.count, fault);
  for (int64_t i = 0; i < job->list.count; i++) {
    const cdem_scaled *item = &job->list.item[i];
    const cdem_dimension d = item->dimension;
    cdem_scaled_row row = {.dimension = d,
                           .tag = item->tag,
                           .counts = item->counts,
                           .added = item->added != NULL,
                           .factor = item->factor};
    if (d.length == 0 && d.time == 0 && d.mass == 0 && item->factor == 1.0)
      continue;
    plain_key(item, row.key);
    int64_t known = 0;
    while (known < table->rows && !is_same_row(&table->row[known], &row))
      known++;
    if (known == table->rows)
      table->row[table->rows++] = row;
  }
  return CDEM_OK;
}

void cdem_scaled_table_release(cdem_scaled_table *table) {
  free(table->row);
  *table = (cdem_scaled_table){0};
}

/* ---- the whole ---- */

static void release(scaling_job *job) {
  cdem_scaled_list_release(&job->list);
  cdem_table_release(&job->columns);
  cdem_case_release(&job->cases);
  free(job->grains_name);
  free(job->text);
  free(job->change);
}

cdem_status cdem_scale_case(const cdem_scale_options *options, cdem_scaled_table *table,
                            cdem_fault *fault) {
  scaling_job job = {.options = options, .scaling = options->scaling};
  cdem_scaled_table made = {0};
  cdem_status status = read_case(&job, fault);
  if (status == CDEM_OK)
    status = apply(&job, fault);
  if (status == CDEM_OK)
    status = fill_table(&job, &made, fault);
  if (status == CDEM_OK)
    status = write_all(&job, fault);
  release(&job);
  if (status == CDEM_OK)
    *table = made;
  else
    cdem_scaled_table_release(&made);
  return status;
}
