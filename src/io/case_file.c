/* Case files: sections and lists, by the table of room cases alone. */
#include "io/case_file.h"

#include "io/case_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SECTION_KEYS = 48 };

static void read_section(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_yaml_node *mark,
                         const cdem_case_section *section, void *values);

/* ---- paths and places ---- */

size_t cdem_case_enter(cdem_case_reader *r, const char *format, ...) {
  size_t before = strlen(r->path);
  va_list arguments;
  va_start(arguments, format);
  if (before > 0 && *format != '[')
    snprintf(r->path + before, sizeof r->path - before, ".");
  size_t used = strlen(r->path);
  vsnprintf(r->path + used, sizeof r->path - used, format, arguments);
  va_end(arguments);
  return before;
}

void cdem_case_leave(cdem_case_reader *r, size_t before) {
  r->path[before] = '\0';
}

void cdem_case_note(cdem_case_reader *r, const cdem_yaml_node *at) {
  const cdem_case_place place = {
      .line = at->line, .column = at->column, .width = at->width, .override = at->origin - 1};
  if (r->status == CDEM_OK)
    r->status = cdem_case_places_add(r->read->places, r->path, &place, r->fault);
}

/* Notes the numbers of the tree from this one on as those of the key, whose path is r->path. node:
 * those that stand there alone; -1: all. */
static void note_numbers(cdem_case_reader *r, int64_t first, int32_t node,
                         const cdem_case_key *key) {
  for (int64_t i = first; i < r->yaml.numbers && r->status == CDEM_OK; i++) {
    const cdem_yaml_number *number = &r->yaml.number[i];
    const cdem_yaml_node *at = &r->yaml.node[number->node];
    if (node >= 0 && number->node != node)
      continue;
    const cdem_case_quantity quantity = {.line = at->line,
                                         .column = at->column,
                                         .width = at->width,
                                         .override = at->origin - 1,
                                         .dimension = number->dimension,
                                         .tag = key->tag,
                                         .keeps_rate = key->keeps_rate,
                                         .counts = key->kind == CDEM_KEY_INTEGER &&
                                                   key->tag == CDEM_TAG_GRAIN,
                                         .value = number->value};
    r->status = cdem_case_places_add_quantity(r->read->places, r->path, &quantity, r->fault);
  }
}

/* ---- lists ---- */

/* The layout that all CDEM_CASE_LIST share. */
typedef CDEM_CASE_LIST(void) any_list;

static void *make_items(cdem_case_reader *r, const cdem_case_section *section, int64_t count,
                        void *member) {
  any_list list = {count, cdem_allocate(count, section->size, r->fault)};
  if (list.item == NULL) {
    r->status = CDEM_MEMORY;
    return NULL;
  }
  memcpy(member, &list, sizeof list);
  return list.item;
}

static void read_list(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                      void *member) {
  if (at->kind != CDEM_YAML_LIST) {
    cdem_yaml_error(&r->yaml, at, "'%s' must be a list of maps, each begun with '- ', not %s",
                    key->key, cdem_yaml_kind_name(at->kind));
    return;
  }
  char *item = make_items(r, key->section, at->children, member);
  int i = 0;
  for (const cdem_yaml_node *c = cdem_yaml_child(&r->yaml, at); c != NULL && r->status == CDEM_OK;
       c = cdem_yaml_next(&r->yaml, c), i++) {
    size_t before = cdem_case_enter(r, "[%d]", i);
    cdem_case_note(r, c);
    read_section(r, c, c, key->section, item + (size_t)i * key->section->size);
    cdem_case_leave(r, before);
  }
}

/* Names become columns, file names and parts of paths. */
static bool check_name(cdem_case_reader *r, const cdem_yaml_node *at) {
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  size_t length = strlen(at->text), good = strspn(at->text, letters);
  if (length > 0 && length == good && length < sizeof((cdem_material *)NULL)->name)
    return true;
  cdem_yaml_error(&r->yaml, at,
                  "'%s' cannot be a name: letters, digits, '_' and '-', at most %zu of them",
                  at->text, sizeof((cdem_material *)NULL)->name - 1);
  return false;
}

static void read_named(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                       void *member) {
  if (at->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(&r->yaml, at, "'%s' must be a map of names, each with a map of keys, not %s",
                    key->key, cdem_yaml_kind_name(at->kind));
    return;
  }
  char *item = make_items(r, key->section, at->children / 2, member);
  if (item == NULL)
    return;
  CDEM_YAML_EACH(&r->yaml, at, name, value) {
    if (r->status != CDEM_OK)
      return;
    if (name->kind == CDEM_YAML_SCALAR && check_name(r, name)) {
      char *copy = cdem_copy_text(name->text, r->fault);
      if (copy == NULL)
        r->status = CDEM_MEMORY;
      size_t before = cdem_case_enter(r, "%s", name->text);
      cdem_case_note(r, name);
      memcpy(item, &copy, sizeof copy); /* `name` is the first member */
      if (r->status == CDEM_OK)
        read_section(r, value, name, key->section, item);
      cdem_case_leave(r, before);
    }
    item += key->section->size;
  }
}

/* ---- sections ---- */

static void read_key(cdem_case_reader *r, const cdem_yaml_node *name, const cdem_yaml_node *value,
                     const cdem_case_key *key, void *values) {
  void *member = (char *)values + key->offset;
  size_t before = cdem_case_enter(r, "%s", key->key);
  cdem_case_note(r, value->kind == CDEM_YAML_SCALAR ? value : name);
  if (r->status != CDEM_OK)
    ;
  else if (key->kind == CDEM_KEY_SECTION)
    read_section(r, value, name, key->section, member);
  else if (key->kind == CDEM_KEY_LIST)
    read_list(r, value, key, member);
  else if (key->kind == CDEM_KEY_NAMED)
    read_named(r, value, key, member);
  else {
    int64_t first = r->yaml.numbers;
    cdem_case_value(r, value, key, values);
    note_numbers(r, first, -1, key);
  }
  cdem_case_leave(r, before);
}

/* Names the required keys that are not there. */
static void report_missing(cdem_case_reader *r, const cdem_yaml_node *map,
                           const cdem_yaml_node *mark, const cdem_case_section *section) {
  char list[256] = "";
  size_t used = 0;
  for (int k = 0; k < section->keys; k++)
    if (section->key[k].required && cdem_yaml_find(&r->yaml, map, section->key[k].key) == NULL &&
        used + 32 < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s'%s'", used > 0 ? ", " : "",
                               section->key[k].key);
  if (used > 0)
    cdem_yaml_error(&r->yaml, mark, "%s needs %s", *r->path != '\0' ? r->path : "a case", list);
}

/* The places of the keys that the material reader takes; it names unknown keys too. */
static void read_material_part(cdem_case_reader *r, const cdem_yaml_node *at,
                               const cdem_yaml_node *mark, const cdem_case_section *section,
                               const cdem_case_key *key, cdem_material *material) {
  const char *others[MAX_SECTION_KEYS];
  int count = 0;
  int64_t first = r->yaml.numbers;
  for (int k = 0; k < section->keys && count < MAX_SECTION_KEYS; k++)
    if (section->key[k].kind != CDEM_KEY_MATERIAL)
      others[count++] = section->key[k].key;
  const char *dot = strrchr(r->path, '.'); /* the name, which check_name has measured */
  snprintf(material->name, sizeof material->name, "%.63s", dot != NULL ? dot + 1 : r->path);
  cdem_yaml_material(&r->yaml, &r->units, at, mark, others, count, material);
  CDEM_YAML_EACH(&r->yaml, at, name, value) {
    if (name->kind != CDEM_YAML_SCALAR || cdem_case_key_find(section, name->text) != NULL)
      continue;
    size_t before = cdem_case_enter(r, "%s", name->text);
    cdem_case_note(r, value->kind == CDEM_YAML_SCALAR ? value : name);
    note_numbers(r, first, (int32_t)(value - r->yaml.node), key);
    cdem_case_leave(r, before);
  }
}

static void report_unknown(cdem_case_reader *r, const cdem_yaml_node *name,
                           const cdem_case_section *section) {
  const char *known[MAX_SECTION_KEYS];
  int count = 0;
  for (; count < section->keys && count < MAX_SECTION_KEYS; count++)
    known[count] = section->key[count].key;
  cdem_yaml_unknown(&r->yaml, name, "key", known, count);
}

/* True when the value is no map and has been dealt with. */
static bool read_without_map(cdem_case_reader *r, const cdem_yaml_node *at,
                             const cdem_case_section *section, void *values) {
  if (at->kind == CDEM_YAML_MAP)
    return false;
  if (at->kind == CDEM_YAML_SCALAR && *at->text != '\0' && section->shorthand != NULL)
    read_key(r, at, at, cdem_case_key_find(section, section->shorthand), values);
  else
    cdem_yaml_error(&r->yaml, at, "%s must be a map of keys and values, not %s%s",
                    *r->path != '\0' ? r->path : "a case", cdem_yaml_kind_name(at->kind),
                    at->kind == CDEM_YAML_SCALAR && *at->text == '\0'
                        ? "; write {} where all keys keep their defaults"
                        : "");
  return true;
}

/* values: zeroed; of a named section with its name. */
static void read_section(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_yaml_node *mark,
                         const cdem_case_section *section, void *values) {
  char *name = NULL;
  if (r->status != CDEM_OK)
    return;
  if (section->named)
    memcpy(&name, values, sizeof name);
  r->status = cdem_case_defaults(section, values, r->fault);
  if (section->named)
    memcpy(values, &name, sizeof name);
  if (r->status != CDEM_OK || read_without_map(r, at, section, values))
    return;
  const cdem_yaml_node *opening = cdem_yaml_child(&r->yaml, at);
  if (opening != NULL && opening->origin == 0) {
    const cdem_case_opening place = {
        .line = opening->line, .column = opening->column, .braces = at->braces};
    r->status = cdem_case_places_add_opening(r->read->places, r->path, &place, r->fault);
  }
  const cdem_case_key *material = NULL;
  for (int k = 0; k < section->keys; k++)
    if (section->key[k].kind == CDEM_KEY_MATERIAL)
      material = &section->key[k];
  CDEM_YAML_EACH(&r->yaml, at, key_node, value) {
    if (key_node->kind != CDEM_YAML_SCALAR || cdem_yaml_find(&r->yaml, at, key_node->text) != value)
      continue; /* a key given twice is an error already */
    const cdem_case_key *key = cdem_case_key_find(section, key_node->text);
    if (key != NULL && key != material)
      read_key(r, key_node, value, key, values);
    else if (material == NULL)
      report_unknown(r, key_node, section);
    if (r->status != CDEM_OK)
      return;
  }
  report_missing(r, at, mark, section);
  if (material != NULL)
    read_material_part(r, at, mark, section, material,
                       (cdem_material *)((char *)values + material->offset));
}

/* ---- the file ---- */

/* The text that gives the same case again, and the places' own copy for carets. */
static void keep_source(cdem_case_reader *r, int overrides, const char *const *override) {
  char *text = cdem_copy_text(r->yaml.source, r->fault);
  if (text == NULL) {
    r->status = CDEM_MEMORY;
    return;
  }
  r->status = cdem_case_places_create(text, overrides, override, &r->read->places, r->fault);
  if (r->status != CDEM_OK)
    free(text);
  else if (overrides > 0)
    r->status = cdem_yaml_text(&r->yaml, &r->read->source, r->fault);
  else if ((r->read->source = cdem_copy_text(r->yaml.source, r->fault)) == NULL)
    r->status = CDEM_MEMORY;
}

/* What follows from other keys where it was not given. */
static void settle(cdem_case *read) {
  cdem_case_values *v = &read->values;
  if (!cdem_case_given(read, "contact.active"))
    v->contact.active = cdem_case_given(read, "contact");
  if (!cdem_case_given(read, "local_damping"))
    v->local_damping = v->analysis == CDEM_ANALYSIS_RELAXATION ? 0.8 : 0.0;
  if (v->analysis == CDEM_ANALYSIS_DYNAMIC) { /* NaN without an end, which is an error anyway */
    v->history_every = isnan(v->history_every) ? v->end / 400.0 : v->history_every;
    v->frame_every = isnan(v->frame_every) ? v->end / 20.0 : v->frame_every;
  }
  for (int64_t m = 0; m < v->materials.count; m++)
    v->cosserat = v->cosserat || cdem_material_is_cosserat(&v->materials.item[m].material);
}

static cdem_status read_all(cdem_case_reader *r, const char *path, const char *text, int overrides,
                            const char *const *override) {
  CDEM_TRY(text != NULL ? cdem_yaml_read_text(path, text, &r->yaml, r->fault)
                        : cdem_yaml_read(path, &r->yaml, r->fault));
  r->yaml.overrides = overrides;
  r->yaml.override = override;
  r->read->path = cdem_copy_text(path, r->fault);
  if (r->read->path == NULL)
    return CDEM_MEMORY;
  cdem_case_override(r);
  if (r->status == CDEM_OK)
    keep_source(r, overrides, override);
  CDEM_TRY(r->status);
  const cdem_yaml_node *root = cdem_yaml_root(&r->yaml);
  read_section(r, root, root, cdem_case_root(), &r->read->values);
  CDEM_TRY(r->status);
  CDEM_TRY(cdem_yaml_finish(&r->yaml, r->fault));
  settle(r->read);
  return r->unchecked ? CDEM_OK : cdem_case_check(r->read, r->fault);
}

static cdem_status read_any(cdem_case_reader r, const char *path, const char *text, int overrides,
                            const char *const *override, cdem_case *read) {
  cdem_case made = {0};
  r.read = &made;
  cdem_status status = read_all(&r, path, text, overrides, override);
  cdem_yaml_release(&r.yaml);
  cdem_units_release(&r.units);
  if (status == CDEM_OK)
    *read = made;
  else
    cdem_case_release(&made);
  return status;
}

cdem_status cdem_read_case(const char *path, int overrides, const char *const *override,
                           cdem_case *read, cdem_fault *fault) {
  return read_any((cdem_case_reader){.fault = fault}, path, NULL, overrides, override, read);
}

cdem_status cdem_read_case_text(const char *path, const char *text, cdem_case *read,
                                cdem_fault *fault) {
  return read_any((cdem_case_reader){.fault = fault}, path, text, 0, NULL, read);
}

cdem_status cdem_case_read_unchecked(const char *path, const char *text, cdem_case *read,
                                     cdem_fault *fault) {
  return read_any((cdem_case_reader){.fault = fault, .unchecked = true}, path, text, 0, NULL, read);
}
