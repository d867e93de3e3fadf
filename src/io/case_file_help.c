/* Case files: the schema as help and as the page docs/reference/case.md. */
#include "base/suggest.h"
#include "io/case_file.h"
#include "io/case_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cdem_status judge_stream(FILE *stream, cdem_fault *fault) {
  CDEM_REQUIRE(!ferror(stream), fault, CDEM_FILE,
               "the description of case files could not be written; is the disk full?");
  return CDEM_OK;
}

/* Depth of a path: the number of its dots. */
static int depth_of(const char *path) {
  int dots = 0;
  for (const char *c = path; *c != '\0'; c++)
    dots += *c == '.';
  return dots;
}

static const char *last_part(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot != NULL ? dot + 1 : path;
}

static bool lies_in(const char *path, const char *section) {
  size_t length = strlen(section);
  return strncmp(path, section, length) == 0 && path[length] == '.';
}

/* ---- help ---- */

/* Words broken at `width` columns, indented. */
static void put_wrapped(FILE *stream, const char *text, int indent, int width) {
  int column = 0;
  while (*text != '\0') {
    int length = (int)strcspn(text, " ");
    if (column > 0 && column + 1 + length > width) {
      fputc('\n', stream);
      column = 0;
    }
    if (column == 0)
      column = fprintf(stream, "%*s%.*s", indent, "", length, text);
    else
      column += fprintf(stream, " %.*s", length, text);
    text += length;
    text += strspn(text, " ");
  }
  fputc('\n', stream);
}

static void put_key(FILE *stream, const cdem_case_entry *entry) {
  char kind[CDEM_CASE_PHRASE], otherwise[CDEM_CASE_PHRASE], range[CDEM_CASE_PHRASE];
  char facts[4 * CDEM_CASE_PHRASE];
  cdem_case_kind_text(&entry->key, kind);
  cdem_case_default_text(&entry->key, otherwise);
  cdem_case_range_text(&entry->key, range);
  fprintf(stream, "  %s\n", entry->path);
  put_wrapped(stream, entry->key.help, 6, 86);
  snprintf(facts, sizeof facts, "%s%s%s; %s%s", kind, *range != '\0' ? "; " : "", range,
           entry->key.required ? "" : "default: ", otherwise);
  put_wrapped(stream, facts, 6, 86);
  fprintf(stream, "      Example: %s: %s\n", entry->key.key, entry->key.example);
}

static void put_line(FILE *stream, const cdem_case_entry *entry) {
  char unit[CDEM_CASE_PHRASE], otherwise[CDEM_CASE_PHRASE], range[CDEM_CASE_PHRASE];
  cdem_case_unit_text(&entry->key, unit);
  cdem_case_default_text(&entry->key, otherwise);
  cdem_case_range_text(&entry->key, range);
  fprintf(stream, "  %-17s %-18s %-20s %s", last_part(entry->path), unit, range, otherwise);
  for (int i = 1; entry->key.kind == CDEM_KEY_CHOICE && entry->key.choice[i] != NULL; i++)
    fprintf(stream, "%s %s", i == 1 ? ", or" : "", entry->key.choice[i]);
  fputc('\n', stream);
}

static void put_forms(FILE *stream) {
  fputs("Functions of time:\n", stream);
  for (int i = 0; cdem_case_series_forms[i] != NULL; i++)
    fprintf(stream, "  %s\n", cdem_case_series_forms[i]);
}

/* Which keys each material model takes, one model a line. */
static void put_models(FILE *stream, const char *indent, const char *quote) {
  for (int m = 0; m < CDEM_MATERIAL_MODEL_COUNT; m++) {
    const cdem_material_model_info *info = cdem_material_model_get((cdem_material_model)m);
    bool many = info->keys > 9 && *quote == '\0'; /* c11 c12 .. c66 */
    fprintf(stream, "%s%s%s%s:", indent, quote, info->name, quote);
    for (int k = 0; k < info->keys; k++)
      if (!many || k < 2 || k + 1 == info->keys)
        fprintf(stream, "%s %s%s%s%s%s", many && k + 1 == info->keys ? " .." : "",
                info->key[k].optional ? "[" : "", quote, info->key[k].key, quote,
                info->key[k].optional ? "]" : "");
    fputs("\n", stream);
  }
}

static void put_overview(FILE *stream, const cdem_case_index *index) {
  fputs(
      "A case is a YAML file of the keys below: unit of a plain number (1: none), range, default.\n"
      "Other units are written behind the number: 40 GPa, 60 mm. `cdem help case KEY` says "
      "more.\n\n",
      stream);
  for (int64_t i = 0; i < index->count; i++)
    if (depth_of(index->entry[i].path) == 0 && index->entry[i].key.section == NULL)
      put_line(stream, &index->entry[i]);
  for (int64_t i = 0; i < index->count; i++) {
    const cdem_case_entry *entry = &index->entry[i];
    if (entry->key.section != NULL) {
      char kind[CDEM_CASE_PHRASE];
      cdem_case_kind_text(&entry->key, kind);
      fprintf(stream, "\n%s: %s%s\n", entry->path, kind, entry->key.required ? ", required" : "");
      put_wrapped(stream, entry->key.help, 2, 86);
    } else if (depth_of(entry->path) > 0 && !entry->of_model) {
      put_line(stream, entry);
      if (entry->key.kind == CDEM_KEY_CHOICE && strcmp(entry->path, "materials.model") == 0)
        put_models(stream, "    ", "");
    }
  }
  fputc('\n', stream);
  put_forms(stream);
}

/* Prints what a topic names: a section with its keys, a key by its path, or every key of that name.
 * Returns whether there was something. */
static bool put_topic(FILE *stream, const cdem_case_index *index, const char *topic) {
  bool found = false, forms = false;
  for (int64_t i = 0; i < index->count; i++) {
    const cdem_case_entry *entry = &index->entry[i];
    bool here = strcmp(entry->path, topic) == 0 || lies_in(entry->path, topic);
    if (!here && (strchr(topic, '.') != NULL || strcmp(last_part(entry->path), topic) != 0))
      continue;
    if (found)
      fputc('\n', stream);
    put_key(stream, entry);
    forms = forms || entry->key.kind == CDEM_KEY_SERIES || entry->key.kind == CDEM_KEY_COMPONENTS;
    found = true;
  }
  if (forms) {
    fputc('\n', stream);
    put_forms(stream);
  }
  return found;
}

static cdem_status fail_topic(const cdem_case_index *index, const char *topic, cdem_fault *fault) {
  const char **known = cdem_allocate(2 * index->count, sizeof *known, fault);
  if (known == NULL)
    return CDEM_MEMORY;
  for (int64_t i = 0; i < index->count; i++) {
    known[i] = index->entry[i].path;
    known[index->count + i] = last_part(index->entry[i].path);
  }
  const char *near = cdem_suggest(topic, known, (int)(2 * index->count));
  free(known);
  return cdem_fail(fault, CDEM_USAGE, "a case has no key '%s'%s%s%s", topic,
                   near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                   near != NULL ? "'?" : "; `cdem help case` lists all");
}

cdem_status cdem_write_case_help(FILE *stream, const char *topic, cdem_fault *fault) {
  cdem_case_index index = {0};
  char plain[CDEM_CASE_PATH] = "";
  cdem_status status = cdem_case_index_make(&index, fault);
  if (topic != NULL)
    cdem_case_plain_path(topic, plain);
  if (status == CDEM_OK && (topic == NULL || strcmp(topic, "case") == 0))
    put_overview(stream, &index);
  else if (status == CDEM_OK && !put_topic(stream, &index, plain))
    status = fail_topic(&index, topic, fault);
  cdem_case_index_release(&index);
  return status == CDEM_OK ? judge_stream(stream, fault) : status;
}

/* ---- the reference page ---- */

static void put_row(FILE *stream, const cdem_case_entry *entry) {
  static const char *const tags[] = {"", "grain", "grain", "domain"};
  char kind[CDEM_CASE_PHRASE], otherwise[CDEM_CASE_PHRASE], range[CDEM_CASE_PHRASE];
  cdem_case_kind_text(&entry->key, kind);
  cdem_case_default_text(&entry->key, otherwise);
  cdem_case_range_text(&entry->key, range);
  fprintf(stream, "| `%s` | %s | %s | %s | %s | %s | `%s` |\n", last_part(entry->path),
          entry->key.help, kind, range, otherwise, tags[entry->key.tag], entry->key.example);
}

static void put_head(FILE *stream) {
  fputs("\n| Key | Meaning | Value | Range | Default | Scales as | Example |\n"
        "|---|---|---|---|---|---|---|\n",
        stream);
}

static void put_section(FILE *stream, const cdem_case_index *index,
                        const cdem_case_entry *section) {
  char kind[CDEM_CASE_PHRASE];
  cdem_case_kind_text(&section->key, kind);
  fprintf(stream, "\n## %s\n\n%s\nValue: %s%s.\n", section->path, section->key.help, kind,
          section->key.required ? ", required" : "");
  fprintf(stream, "Example: `%s: %s`.\n", section->path, section->key.example);
  put_head(stream);
  for (int64_t i = 0; i < index->count; i++)
    if (lies_in(index->entry[i].path, section->path))
      put_row(stream, &index->entry[i]);
  if (strcmp(section->path, "materials") == 0) {
    fputs("\nModels and their keys, optional ones in brackets:\n\n", stream);
    put_models(stream, "- ", "`");
  }
}

cdem_status cdem_write_case_reference(FILE *stream, cdem_fault *fault) {
  cdem_case_index index = {0};
  cdem_status status = cdem_case_index_make(&index, fault);
  if (status == CDEM_OK) {
    fputs("# Keys of a case file\n\n"
          "<!-- Written by `cdem help case --markdown` from the tables in src/cases; do not edit. "
          "-->\n\n"
          "Plain numbers are in the unit named under Value; other units are written behind the "
          "number (`40 GPa`, `60 mm`).\n"
          "`Scales as` says whether a quantity belongs to the grains and material points or to the "
          "domain as a whole.\n\n## At the top\n",
          stream);
    put_head(stream);
    for (int64_t i = 0; i < index.count; i++)
      if (depth_of(index.entry[i].path) == 0 && index.entry[i].key.section == NULL)
        put_row(stream, &index.entry[i]);
    for (int64_t i = 0; i < index.count; i++)
      if (index.entry[i].key.section != NULL)
        put_section(stream, &index, &index.entry[i]);
    fputs("\n## Functions of time\n\n```\n", stream);
    for (int i = 0; cdem_case_series_forms[i] != NULL; i++)
      fprintf(stream, "%s\n", cdem_case_series_forms[i]);
    fputs("```\n", stream);
    status = judge_stream(stream, fault);
  }
  cdem_case_index_release(&index);
  return status;
}
