/* Settings: every section of the case that is given, key by key with unit and meaning, and what
 * holds for the keys that are not. A walk over the table from which the case was read. */
#include "report/setting_value.h"
#include "report/source.h"

#include <stdio.h>
#include <string.h>

enum { PATH = CDEM_CASE_PATH, MOST_KEYS = 96 };

/* The layout that all CDEM_CASE_LIST share. */
typedef CDEM_CASE_LIST(void) any_list;

typedef struct {
  const cdem_case *cases;
  cdem_report_text *to;
} walk;

/* Entries of a list or of a map of names, with their keys: those of plain sections inside an entry
 * ("region.low") count as its own. */
typedef struct {
  const cdem_case_key *of;
  const char *path; /* of the list: "walls" */
  any_list list;
  int keys;
  struct {
    const cdem_case_key *key;
    size_t base; /* bytes of the section's struct in the entry's */
    char name[96];
  } key[MOST_KEYS];
} entries;

static void path_of(const char *path, const char *key, char of[PATH]) {
  snprintf(of, PATH, "%.190s%s%.60s", path, *path != '\0' ? "." : "", key);
}

static bool is_plain(const cdem_case_key *key) {
  return key->section == NULL && key->kind != CDEM_KEY_MATERIAL;
}

static const char *entry_at(const entries *e, int64_t i) {
  return (const char *)e->list.item + (size_t)i * e->of->section->size;
}

/* "walls.floor", "supports[1]" */
static void entry_path(const entries *e, int64_t i, char of[PATH]) {
  const char *name;
  memcpy(&name, entry_at(e, i), sizeof name); /* of a named one; else not looked at */
  if (e->of->kind == CDEM_KEY_NAMED)
    snprintf(of, PATH, "%.160s.%.64s", e->path, name);
  else
    snprintf(of, PATH, "%.200s[%lld]", e->path, (long long)i);
}

/* ---- one key a row ---- */

static void begin_row(cdem_report_text *to, const char *key) {
  cdem_report_raw(to, "<tr><th scope=\"row\"><code>");
  cdem_report_escaped(to, key);
  cdem_report_raw(to, "</code></th><td>");
}

/* The first sentence of the help says what a key is; `cdem help case` has the rest. */
static void end_row(cdem_report_text *to, const char *help) {
  const char *end = strstr(help, ". ");
  char first[512];
  snprintf(first, sizeof first, "%.*s", end != NULL ? (int)(end - help) + 1 : 511, help);
  cdem_report_raw(to, "</td><td class=\"note\">");
  cdem_report_prose(to, first);
  cdem_report_raw(to, "</td></tr>\n");
}

/* The rows of a material: its model, the model's moduli, its axes. */
static void put_material(cdem_report_text *to, const cdem_material *material) {
  const cdem_material_model_info *model = cdem_material_model_get(material->model);
  char unit[48];
  begin_row(to, "model");
  cdem_report_raw(to, model->name);
  end_row(to, "Elastic model.");
  for (int k = 0; k < model->keys; k++) {
    begin_row(to, model->key[k].key);
    cdem_report_put_value_of(to, material->parameter[k],
                             cdem_dimension_unit(model->key[k].dimension, unit));
    end_row(to, model->key[k].help);
  }
  for (int a = 0; material->rotated && a < 2; a++) {
    const cdem_case_key axis = {.kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 3};
    begin_row(to, a == 0 ? "axis1" : "axis2");
    cdem_report_put_value(to, &axis, a == 0 ? material->axis1 : material->axis2);
    end_row(to, "Material axis.");
  }
}

static void put_row(cdem_report_text *to, const cdem_case_key *key, const char *name,
                    const void *values, bool given) {
  begin_row(to, name);
  if (given)
    cdem_report_put_value(to, key, values);
  else
    cdem_report_put_default(to, key, values);
  end_row(to, key->help);
}

static void begin_table(cdem_report_text *to, const char *caption) {
  cdem_report_raw(to, "<div class=\"wide\"><table class=\"settings\"><caption><span>");
  cdem_report_prose(to, caption);
  cdem_report_raw(to, "</span></caption><thead><tr>");
}

static void begin_rows(cdem_report_text *to, const char *caption) {
  begin_table(to, caption);
  cdem_report_raw(to, "<th scope=\"col\">Key</th><th scope=\"col\">Value</th><th "
                      "scope=\"col\">Meaning</th></tr></thead><tbody>\n");
}

static void end_table(cdem_report_text *to) {
  cdem_report_raw(to, "</tbody></table></div>\n");
}

static void begin_defaults(cdem_report_text *to, int count) {
  cdem_report_format(to, "<details><summary>%d default%s</summary>\n", count,
                     count == 1 ? "" : "s");
  begin_rows(to, "Not given, so that this holds:");
}

static void end_defaults(cdem_report_text *to) {
  end_table(to);
  cdem_report_raw(to, "</details>\n");
}

static void put_heading(cdem_report_text *to, const char *path) {
  cdem_report_raw(to, "<h3>");
  cdem_report_raw(to, *path != '\0' ? "<code>" : "At the top of the case");
  cdem_report_escaped(to, path);
  cdem_report_raw(to, *path != '\0' ? "</code></h3>\n" : "</h3>\n");
}

/* ---- a section ---- */

static int count_rows(const walk *w, const cdem_case_section *section, const char *path,
                      bool given) {
  int rows = 0;
  for (int k = 0; k < section->keys; k++) {
    char of[PATH];
    path_of(path, section->key[k].key, of);
    rows += given && section->key[k].kind == CDEM_KEY_MATERIAL;
    rows += is_plain(&section->key[k]) && cdem_case_given(w->cases, of) == given;
  }
  return rows;
}

static void put_rows(const walk *w, const cdem_case_section *section, const char *path,
                     const void *values, bool given) {
  for (int k = 0; k < section->keys; k++) {
    const cdem_case_key *key = &section->key[k];
    char of[PATH];
    path_of(path, key->key, of);
    if (given && key->kind == CDEM_KEY_MATERIAL)
      put_material(w->to,
                   (const cdem_material *)(const void *)((const char *)values + key->offset));
    if (is_plain(key) && cdem_case_given(w->cases, of) == given)
      put_row(w->to, key, key->key, values, given);
  }
}

static void put_section(const walk *w, const cdem_case_section *section, const char *path,
                        const void *values) {
  int given = count_rows(w, section, path, true), others = count_rows(w, section, path, false);
  put_heading(w->to, path);
  if (given > 0) {
    begin_rows(w->to, section->help);
    put_rows(w, section, path, values, true);
    end_table(w->to);
  }
  if (others > 0) {
    begin_defaults(w->to, others);
    put_rows(w, section, path, values, false);
    end_defaults(w->to);
  }
}

/* ---- entries alike: one a row, one key a column ---- */

static bool any_gives(const walk *w, const entries *e, const char *name) {
  for (int64_t i = 0; i < e->list.count; i++) {
    char entry[PATH], of[PATH];
    entry_path(e, i, entry);
    path_of(entry, name, of);
    if (cdem_case_given(w->cases, of))
      return true;
  }
  return false;
}

static void collect_keys(const walk *w, const cdem_case_section *section, const char *prefix,
                         size_t base, entries *e) {
  for (int k = 0; k < section->keys && e->keys < MOST_KEYS; k++) {
    const cdem_case_key *key = &section->key[k];
    char name[PATH];
    path_of(prefix, key->key, name);
    if (key->kind == CDEM_KEY_SECTION && any_gives(w, e, name))
      collect_keys(w, key->section, name, base + key->offset, e);
    if (!is_plain(key) || e->keys == MOST_KEYS)
      continue;
    e->key[e->keys].key = key;
    e->key[e->keys].base = base;
    snprintf(e->key[e->keys++].name, sizeof e->key[0].name, "%.95s", name);
  }
}

static void put_entry(const walk *w, const entries *e, int64_t i, const bool *given) {
  char entry[PATH], of[PATH];
  entry_path(e, i, entry);
  cdem_report_raw(w->to, "<tr><th scope=\"row\"><code>");
  cdem_report_escaped(w->to, entry + strlen(e->path) + (e->of->kind == CDEM_KEY_NAMED));
  cdem_report_raw(w->to, "</code></th>");
  for (int k = 0; k < e->keys; k++) {
    if (!given[k])
      continue;
    path_of(entry, e->key[k].name, of);
    cdem_report_raw(w->to, "<td>");
    if (cdem_case_given(w->cases, of))
      cdem_report_put_value(w->to, e->key[k].key, entry_at(e, i) + e->key[k].base);
    cdem_report_raw(w->to, "</td>");
  }
  cdem_report_raw(w->to, "</tr>\n");
}

static void put_entries(const walk *w, const entries *e) {
  bool given[MOST_KEYS];
  int others = 0;
  put_heading(w->to, e->path);
  begin_table(w->to, e->of->help);
  cdem_report_raw(w->to, "<th scope=\"col\"></th>");
  for (int k = 0; k < e->keys; k++) {
    given[k] = any_gives(w, e, e->key[k].name);
    others += !given[k];
    if (given[k])
      cdem_report_format(w->to, "<th scope=\"col\"><code>%s</code></th>", e->key[k].name);
  }
  cdem_report_raw(w->to, "</tr></thead><tbody>\n");
  for (int64_t i = 0; i < e->list.count; i++)
    put_entry(w, e, i, given);
  end_table(w->to);
  if (others == 0)
    return;
  begin_defaults(w->to, others);
  for (int k = 0; k < e->keys; k++)
    if (!given[k])
      put_row(w->to, e->key[k].key, e->key[k].name, entry_at(e, 0) + e->key[k].base, false);
  end_defaults(w->to);
}

/* ---- the walk ---- */

static void walk_inside(const walk *w, const cdem_case_section *section, const char *path,
                        const void *values, bool lists_only);

/* Whether entries are told in one table: several, none with a material's many moduli. */
static bool is_table(const entries *e) {
  bool moduli = false;
  for (int k = 0; k < e->of->section->keys; k++)
    moduli = moduli || e->of->section->key[k].kind == CDEM_KEY_MATERIAL;
  return e->list.count > 1 && !moduli;
}

static void walk_entries(const walk *w, const cdem_case_key *key, const char *path,
                         const void *member) {
  entries e = {.of = key, .path = path};
  memcpy(&e.list, member, sizeof e.list);
  bool table = is_table(&e);
  if (table) {
    collect_keys(w, key->section, "", 0, &e);
    put_entries(w, &e);
  }
  for (int64_t i = 0; i < e.list.count; i++) {
    char of[PATH];
    entry_path(&e, i, of);
    if (!table)
      put_section(w, key->section, of, entry_at(&e, i));
    walk_inside(w, key->section, of, entry_at(&e, i), table);
  }
}

/* The sections and lists in a section; lists_only: its plain sections have been told. */
static void walk_inside(const walk *w, const cdem_case_section *section, const char *path,
                        const void *values, bool lists_only) {
  for (int k = 0; k < section->keys; k++) {
    const cdem_case_key *key = &section->key[k];
    const char *member = (const char *)values + key->offset;
    char of[PATH];
    path_of(path, key->key, of);
    if (key->section == NULL || !cdem_case_given(w->cases, of))
      continue;
    if (key->kind != CDEM_KEY_SECTION) {
      walk_entries(w, key, of, member);
      continue;
    }
    if (!lists_only)
      put_section(w, key->section, of, member);
    walk_inside(w, key->section, of, member, lists_only);
  }
}

void cdem_report_put_settings(const cdem_report_source *source, cdem_report_text *to,
                              cdem_report_made *made) {
  const walk w = {.cases = &source->cases, .to = to};
  (void)made;
  cdem_report_raw(to, "<p>Everything the case says, with its unit, and folded below each part what "
                      "holds for the keys it does not give. <code>cdem help case KEY</code> says "
                      "more of a key.</p>\n");
  put_section(&w, cdem_case_root(), "", &source->cases.values);
  walk_inside(&w, cdem_case_root(), "", &source->cases.values, false);
}
