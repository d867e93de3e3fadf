#include "io/case_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const cdem_case_series_forms[] = {
    "2 MPa                                                   constant",
    "{table: [[0 s, 0 MPa], [1 ms, 2 MPa]]}                  linear between points, constant "
    "outside",
    "{ramp: 2 MPa, over: 1 ms, from: 0 MPa, start: 0 s}      from `from` (0) to the value, then "
    "constant",
    "{sine: 1 mm, frequency: 50 Hz, phase: 0, start: 0 s, offset: 0 mm}",
    "{pulse: 2 MPa, duration: 1 ms, start: 0 s, offset: 0 MPa}   one sin^2 wave, smooth",
    NULL};

/* ---- the index ---- */

typedef struct {
  cdem_case_index *index;
  cdem_status status;
  cdem_fault *fault;
} collecting;

void cdem_case_plain_path(const char *path, char plain[CDEM_CASE_PATH]) {
  size_t used = 0;
  for (const char *c = path; *c != '\0' && used + 1 < CDEM_CASE_PATH; c++) {
    if (strncmp(c, ".NAME", 5) == 0 && (c[5] == '.' || c[5] == '\0')) {
      c += 4;
      continue;
    }
    if (*c == '[') {
      size_t inside = strcspn(c, "]");
      if (c[inside] == ']') {
        c += inside;
        continue;
      }
    }
    plain[used++] = *c;
  }
  plain[used] = '\0';
}

static void collect(void *context, const char *path, const cdem_case_key *key) {
  collecting *c = context;
  if (c->status == CDEM_OK)
    c->status = cdem_grow(&c->index->entry, &c->index->capacity, c->index->count + 1,
                          sizeof *c->index->entry, c->fault);
  if (c->status != CDEM_OK)
    return;
  cdem_case_entry *entry = &c->index->entry[c->index->count++];
  cdem_case_plain_path(path, entry->path);
  entry->key = *key;
  const cdem_case_key *materials = cdem_case_key_find(cdem_case_root(), "materials");
  entry->of_model = strncmp(entry->path, "materials.", 10) == 0 && strcmp(key->key, "model") != 0 &&
                    cdem_case_key_find(materials->section, key->key) == NULL;
}

cdem_status cdem_case_index_make(cdem_case_index *index, cdem_fault *fault) {
  collecting c = {index, CDEM_OK, fault};
  cdem_case_walk(collect, &c);
  return c.status;
}

void cdem_case_index_release(cdem_case_index *index) {
  free(index->entry);
  *index = (cdem_case_index){0};
}

/* ---- words ---- */

static bool is_number(const cdem_case_key *key) {
  return key->kind == CDEM_KEY_NUMBER || key->kind == CDEM_KEY_VECTOR ||
         key->kind == CDEM_KEY_SERIES || key->kind == CDEM_KEY_COMPONENTS;
}

/* Units as people write them; UDUNITS reads them too. */
static const char *unit_of(cdem_dimension dimension, char text[48]) {
  static const struct {
    cdem_dimension dimension;
    const char *unit;
  } common[] = {{{1, -1, 0}, "m/s"},   {{1, -2, 0}, "m/s2"}, {{0, -1, 0}, "1/s"},
                {{-3, 0, 1}, "kg/m3"}, {{0, -2, 1}, "J/m2"}, {{2, -2, 1}, "N.m"}};
  for (size_t i = 0; i < sizeof common / sizeof *common; i++)
    if (memcmp(&common[i].dimension, &dimension, sizeof dimension) == 0)
      return common[i].unit;
  return cdem_dimension_unit(dimension, text);
}

void cdem_case_unit_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]) {
  char text[48], turn[48];
  *out = '\0';
  if (key->kind == CDEM_KEY_INTEGER)
    snprintf(out, CDEM_CASE_PHRASE, "1");
  if (!is_number(key))
    return;
  const char *unit = unit_of(key->dimension, text);
  if (key->rotates)
    snprintf(out, CDEM_CASE_PHRASE, "%s; rotation %s", unit, unit_of(key->rotation, turn));
  else
    snprintf(out, CDEM_CASE_PHRASE, "%s", unit);
}

static void put_choices(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]) {
  size_t used = (size_t)snprintf(out, CDEM_CASE_PHRASE, "one of");
  for (int i = 0; key->choice[i] != NULL && used + 40 < CDEM_CASE_PHRASE; i++)
    used += (size_t)snprintf(out + used, CDEM_CASE_PHRASE - used, "%s %s", i > 0 ? "," : "",
                             key->choice[i]);
}

void cdem_case_kind_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]) {
  static const char *const words[] = {
      [CDEM_KEY_NUMBER] = "number",
      [CDEM_KEY_INTEGER] = "whole number",
      [CDEM_KEY_BOOLEAN] = "yes or no",
      [CDEM_KEY_TEXT] = "text",
      [CDEM_KEY_SERIES] = "function of time",
      [CDEM_KEY_TEXTS] = "text or list of texts",
      [CDEM_KEY_NUMBERS] = "map of names to numbers",
      [CDEM_KEY_MATERIAL] = "material",
      [CDEM_KEY_SECTION] = "map",
      [CDEM_KEY_LIST] = "list of maps",
      [CDEM_KEY_NAMED] = "map of names to maps",
  };
  char unit[CDEM_CASE_PHRASE];
  cdem_case_unit_text(key, unit);
  if (key->kind == CDEM_KEY_CHOICE)
    put_choices(key, out);
  else if (key->kind == CDEM_KEY_VECTOR && key->fewest < key->length)
    snprintf(out, CDEM_CASE_PHRASE, "list of %d to %d numbers", key->fewest, key->length);
  else if (key->kind == CDEM_KEY_VECTOR)
    snprintf(out, CDEM_CASE_PHRASE, "list of %d numbers", key->length);
  else if (key->kind == CDEM_KEY_COMPONENTS)
    snprintf(out, CDEM_CASE_PHRASE, "map of %s to functions of time",
             key->rotates ? "x, y, z, rotation" : "x, y, z");
  else
    snprintf(out, CDEM_CASE_PHRASE, "%s", words[key->kind]);
  size_t used = strlen(out);
  if (is_number(key) && strcmp(unit, "1") != 0)
    snprintf(out + used, CDEM_CASE_PHRASE - used, ", %.200s", unit);
}

void cdem_case_default_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]) {
  char text[48];
  const char *unit = unit_of(key->dimension, text);
  bool plain = strcmp(unit, "1") == 0 || key->fallback == 0.0;
  if (key->required)
    snprintf(out, CDEM_CASE_PHRASE, "required");
  else if (key->otherwise != NULL)
    snprintf(out, CDEM_CASE_PHRASE, "%s", key->otherwise);
  else if (key->kind == CDEM_KEY_CHOICE)
    snprintf(out, CDEM_CASE_PHRASE, "%s", key->choice[0]);
  else if (key->kind == CDEM_KEY_BOOLEAN)
    snprintf(out, CDEM_CASE_PHRASE, "%s", key->fallback != 0.0 ? "yes" : "no");
  else if (key->kind == CDEM_KEY_NUMBER || key->kind == CDEM_KEY_INTEGER ||
           key->kind == CDEM_KEY_VECTOR)
    snprintf(out, CDEM_CASE_PHRASE, "%.10g%s%s", key->fallback, plain ? "" : " ",
             plain ? "" : unit);
  else
    snprintf(out, CDEM_CASE_PHRASE, "none");
}

void cdem_case_range_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]) {
  *out = '\0';
  if (key->least == key->most)
    return;
  if (isinf(key->most))
    snprintf(out, CDEM_CASE_PHRASE, "%s %.10g", key->above ? "above" : "at least", key->least);
  else if (!key->above && !key->below)
    snprintf(out, CDEM_CASE_PHRASE, "%.10g to %.10g", key->least, key->most);
  else
    snprintf(out, CDEM_CASE_PHRASE, "%s %.10g, %s %.10g", key->above ? "above" : "at least",
             key->least, key->below ? "below" : "at most", key->most);
}
