/* The typed case: defaults and release by the table, and failures that show their place. */
#include "cases/case.h"

#include "base/caret.h"
#include "cases/places.h"
#include "cases/schema.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The layout that all CDEM_CASE_LIST share. */
typedef CDEM_CASE_LIST(void) any_list;

static void *member_of(void *values, const cdem_case_key *key) {
  return (char *)values + key->offset;
}

/* ---- release ---- */

static void release_texts(cdem_case_texts *texts) {
  for (int64_t i = 0; i < texts->count; i++)
    free(texts->item[i]);
  free(texts->item);
  *texts = (cdem_case_texts){0};
}

static void release_parameters(void *member) {
  any_list list;
  memcpy(&list, member, sizeof list);
  cdem_case_parameter *parameter = list.item;
  for (int64_t i = 0; i < list.count; i++)
    free(parameter[i].name);
  free(parameter);
  memset(member, 0, sizeof list);
}

static void release_list(const cdem_case_key *key, void *member) {
  any_list list;
  memcpy(&list, member, sizeof list);
  for (int64_t i = 0; i < list.count; i++) {
    char *item = (char *)list.item + (size_t)i * key->section->size;
    cdem_case_values_release(key->section, item);
  }
  free(list.item);
  memset(member, 0, sizeof list);
}

static void release_member(const cdem_case_key *key, void *member) {
  char *text = NULL;
  switch (key->kind) {
  case CDEM_KEY_TEXT:
    memcpy(&text, member, sizeof text);
    free(text);
    break;
  case CDEM_KEY_TEXTS:
    release_texts(member);
    break;
  case CDEM_KEY_NUMBERS:
    release_parameters(member);
    break;
  case CDEM_KEY_SERIES:
    cdem_series_release(member);
    break;
  case CDEM_KEY_COMPONENTS:
    for (int c = 0; c < 4; c++)
      cdem_series_release(&((cdem_case_components *)member)->component[c]);
    break;
  case CDEM_KEY_SECTION:
    cdem_case_values_release(key->section, member);
    break;
  case CDEM_KEY_LIST:
  case CDEM_KEY_NAMED:
    release_list(key, member);
    break;
  default:
    break;
  }
}

void cdem_case_values_release(const cdem_case_section *section, void *values) {
  for (int k = 0; k < section->keys; k++)
    release_member(&section->key[k], member_of(values, &section->key[k]));
  if (section->named) { /* the first member is the name */
    char *name;
    memcpy(&name, values, sizeof name);
    free(name);
  }
  memset(values, 0, section->size);
}

void cdem_case_release(cdem_case *cases) {
  cdem_case_values_release(cdem_case_root(), &cases->values);
  cdem_case_places_destroy(&cases->places);
  free(cases->path);
  free(cases->source);
  *cases = (cdem_case){0};
}

/* ---- defaults ---- */

cdem_status cdem_case_defaults(const cdem_case_section *section, void *values, cdem_fault *fault) {
  memset(values, 0, section->size);
  for (int k = 0; k < section->keys; k++) {
    const cdem_case_key *key = &section->key[k];
    void *member = member_of(values, key);
    double *number = member;
    switch (key->kind) {
    case CDEM_KEY_NUMBER:
      *number = key->fallback;
      break;
    case CDEM_KEY_INTEGER:
      *(int64_t *)member = (int64_t)key->fallback;
      break;
    case CDEM_KEY_BOOLEAN:
      *(bool *)member = key->fallback != 0.0;
      break;
    case CDEM_KEY_VECTOR:
      for (int i = 0; i < key->length; i++)
        number[i] = key->fallback;
      break;
    case CDEM_KEY_SECTION:
      CDEM_TRY(cdem_case_defaults(key->section, member, fault));
      break;
    default: /* nothing, an empty list, the first choice */
      break;
    }
  }
  return CDEM_OK;
}

/* ---- failures with a place ---- */

/* The place of the key or of the nearest section above it; NULL: the file as a whole. */
static const cdem_case_place *nearest_place(const cdem_case *cases, const char *key) {
  char path[CDEM_CASE_PATH];
  snprintf(path, sizeof path, "%s", key);
  while (*path != '\0') {
    const cdem_case_place *place = cdem_case_places_find(cases->places, path);
    if (place != NULL)
      return place;
    char *dot = strrchr(path, '.'), *bracket = strrchr(path, '[');
    char *cut = dot > bracket ? dot : bracket;
    *(cut != NULL ? cut : path) = '\0';
  }
  return NULL;
}

/* "WHERE: message" and the caret, at most room bytes. */
static void show(const cdem_case *cases, const char *key, const char *message, char *out,
                 size_t room) {
  const cdem_case_place *place = nearest_place(cases, key);
  const char *path = cases->path != NULL ? cases->path : "case";
  int used;
  if (place == NULL)
    used = snprintf(out, room, "%s: %s", path, message);
  else if (place->override >= 0)
    used =
        snprintf(out, room, "override '%s': %s", cases->places->override[place->override], message);
  else
    used = snprintf(out, room, "%s:%d:%d: %s", path, place->line, place->column, message);
  if (place == NULL || place->override >= 0 || used < 0 || (size_t)used >= room)
    return;
  cdem_caret_put(cases->places->text, place->line, place->column, place->width, out + used,
                 room - (size_t)used);
}

cdem_status cdem_case_fail(const cdem_case *cases, const char *key, cdem_status status,
                           cdem_fault *fault, const char *format, ...) {
  char message[CDEM_FAULT_LENGTH], whole[CDEM_FAULT_LENGTH];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  show(cases, key, message, whole, sizeof whole);
  return cdem_fail(fault, status, "%s", whole);
}

cdem_status cdem_case_blame(const cdem_case *cases, const char *key, cdem_fault *fault) {
  if (fault == NULL || fault->status == CDEM_OK)
    return fault == NULL ? CDEM_INPUT : CDEM_OK;
  cdem_status status = fault->status;
  char whole[CDEM_FAULT_LENGTH];
  show(cases, key, fault->message, whole, sizeof whole);
  memcpy(fault->message, whole, sizeof whole);
  return status;
}

bool cdem_case_given(const cdem_case *cases, const char *key) {
  return cdem_case_places_find(cases->places, key) != NULL;
}

bool cdem_case_is_coupled(const cdem_case *cases) {
  return cdem_case_given(cases, "coupling");
}

bool cdem_case_is_triaxial(const cdem_case *cases) {
  return cdem_case_given(cases, "triaxial");
}

bool cdem_case_has_grains(const cdem_case *cases) {
  return cdem_case_given(cases, "grains");
}
