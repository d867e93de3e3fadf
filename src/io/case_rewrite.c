/* Changing the text of a case in place: the numbers and keys that change, and nothing else. */
#include "base/sort.h"
#include "cases/places.h"
#include "io/case_file.h"
#include "io/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes [from, to) become `text`. */
typedef struct {
  int64_t from, to;
  char *text; /* owned */
} edit;

typedef struct {
  const cdem_case *cases;
  const char *source; /* as the places count */
  int64_t edits;
  edit *list;
  cdem_fault *fault;
} editing;

static const char *number_text(double value, char text[CDEM_REAL_WIDTH + 1]) {
  *cdem_put_real(text, value) = '\0';
  return text;
}

/* Replaces `width` characters at a place. */
static cdem_status replace(editing *e, const char *key, int line, int column, int width,
                           const char *text) {
  const char *from = cdem_case_text_at(e->source, line, column);
  const char *to = from != NULL ? cdem_case_text_at(from, 1, width + 1) : NULL;
  if (to == NULL || to <= from)
    return cdem_case_fail(e->cases, key, CDEM_INPUT, e->fault,
                          "'%s' cannot be changed here; write its value on one line", key);
  edit *next = &e->list[e->edits];
  *next = (edit){from - e->source, to - e->source, cdem_copy_text(text, e->fault)};
  e->edits += next->text != NULL;
  return next->text != NULL ? CDEM_OK : CDEM_MEMORY;
}

/* Puts "key: value" before the first key of a map: on a line of its own, or, between braces, before
 * a comma. */
static cdem_status insert(editing *e, const cdem_case_opening *opening, const char *key,
                          const char *value) {
  char text[CDEM_CASE_PATH + 64];
  const char *at = cdem_case_text_at(e->source, opening->line, opening->column);
  CDEM_REQUIRE(at != NULL, e->fault, CDEM_INPUT, "'%s' has no place for the key '%s'", opening->key,
               key);
  if (opening->braces)
    snprintf(text, sizeof text, "%s: %s, ", key, value);
  else
    snprintf(text, sizeof text, "%s: %s\n%*s", key, value,
             opening->column - 1 < 100 ? opening->column - 1 : 100, "");
  edit *next = &e->list[e->edits];
  *next = (edit){at - e->source, at - e->source, cdem_copy_text(text, e->fault)};
  e->edits += next->text != NULL;
  return next->text != NULL ? CDEM_OK : CDEM_MEMORY;
}

/* A section that is a plain text, "mesh: plate.geo", becomes the map that it stands for. */
static cdem_status open_shorthand(editing *e, const char *section, const char *key,
                                  const char *value) {
  const cdem_case_place *place = cdem_case_places_find(e->cases->places, section);
  const cdem_case_key *of = cdem_case_key_find(cdem_case_root(), section);
  const char *from =
      place != NULL ? cdem_case_text_at(e->source, place->line, place->column) : NULL;
  const char *to = from != NULL ? cdem_case_text_at(from, 1, place->width + 1) : NULL;
  bool plain = to != NULL && to > from && of != NULL && of->section != NULL &&
               of->section->shorthand != NULL;
  if (!plain)
    return cdem_case_fail(e->cases, section, CDEM_INPUT, e->fault,
                          "the key '%s' cannot be written here; give it in the case", key);
  char text[4096];
  int used = snprintf(text, sizeof text, "{%s: %.*s, %s: %s}", of->section->shorthand,
                      (int)(to - from), from, key, value);
  CDEM_REQUIRE(used > 0 && (size_t)used < sizeof text, e->fault, CDEM_INPUT,
               "'%s' is too long a text", section);
  return replace(e, section, place->line, place->column, place->width, text);
}

static cdem_status change_key(editing *e, const cdem_case_change *change) {
  char number[CDEM_REAL_WIDTH + 1];
  if (change->text != NULL) {
    const cdem_case_place *place = cdem_case_places_find(e->cases->places, change->key);
    CDEM_REQUIRE(place != NULL, e->fault, CDEM_USAGE, "the case does not give '%s'", change->key);
    return replace(e, change->key, place->line, place->column, place->width, change->text);
  }
  const cdem_case_opening *opening =
      cdem_case_places_find_opening(e->cases->places, change->section);
  number_text(change->value, number);
  return opening != NULL ? insert(e, opening, change->key, number)
                         : open_shorthand(e, change->section, change->key, number);
}

static cdem_status change_number(editing *e, const cdem_case_change *change) {
  const cdem_case_quantity *q = &e->cases->places->quantity[change->quantity];
  char number[CDEM_REAL_WIDTH + 1];
  CDEM_REQUIRE(q->override < 0, e->fault, CDEM_USAGE, "'%s' comes from an override", q->key);
  return replace(e, q->key, q->line, q->column, q->width, number_text(change->value, number));
}

static int by_place(const void *a, const void *b) {
  int64_t x = ((const edit *)a)->from, y = ((const edit *)b)->from;
  return (x > y) - (x < y);
}

static cdem_status apply(const editing *e, const char *heading, char **text) {
  size_t room = strlen(e->source) + strlen(heading) + 1;
  for (int64_t i = 0; i < e->edits; i++)
    room += strlen(e->list[i].text);
  char *made = cdem_allocate((int64_t)room, 1, e->fault), *at = made;
  if (made == NULL)
    return CDEM_MEMORY;
  cdem_sort(e->list, e->edits, sizeof *e->list, by_place);
  at = stpcpy(at, heading);
  int64_t done = 0;
  for (int64_t i = 0; i < e->edits; i++) {
    size_t kept = (size_t)(e->list[i].from - done);
    memcpy(at, e->source + done, kept);
    at = stpcpy(at + kept, e->list[i].text);
    done = e->list[i].to;
  }
  strcpy(at, e->source + done);
  *text = made;
  return CDEM_OK;
}

cdem_status cdem_case_rewrite(const cdem_case *cases, const char *heading, int64_t changes,
                              const cdem_case_change *change, char **text, cdem_fault *fault) {
  editing e = {.cases = cases, .source = cases->places->text, .fault = fault};
  CDEM_REQUIRE(cases->places->overrides == 0, fault, CDEM_USAGE,
               "the text of a case with overrides cannot be changed in place; read its own text");
  CDEM_NEW(e.list, changes, fault);
  cdem_status status = CDEM_OK;
  for (int64_t i = 0; i < changes && status == CDEM_OK; i++)
    status = change[i].quantity >= 0 ? change_number(&e, &change[i]) : change_key(&e, &change[i]);
  if (status == CDEM_OK)
    status = apply(&e, heading != NULL ? heading : "", text);
  for (int64_t i = 0; i < e.edits; i++)
    free(e.list[i].text);
  free(e.list);
  return status;
}
