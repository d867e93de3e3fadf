#include "cases/places.h"

#include <stdlib.h>
#include <string.h>

cdem_status cdem_case_places_create(char *text, int overrides, const char *const *override,
                                    cdem_case_places **places, cdem_fault *fault) {
  cdem_case_places *made = cdem_allocate(1, sizeof *made, fault);
  if (made == NULL)
    return CDEM_MEMORY;
  made->override = cdem_allocate(overrides, sizeof *made->override, fault);
  cdem_status status = made->override != NULL ? CDEM_OK : CDEM_MEMORY;
  for (int i = 0; i < overrides && status == CDEM_OK; i++) {
    made->override[i] = cdem_copy_text(override[i], fault);
    status = made->override[i] != NULL ? CDEM_OK : CDEM_MEMORY;
    made->overrides++;
  }
  if (status == CDEM_OK) {
    made->text = text;
    *places = made;
    return CDEM_OK;
  }
  cdem_case_places_destroy(&made);
  return status;
}

void cdem_case_places_destroy(cdem_case_places **places) {
  cdem_case_places *p = *places;
  if (p == NULL)
    return;
  for (int64_t i = 0; i < p->places; i++)
    free(p->place[i].key);
  for (int64_t i = 0; i < p->quantities; i++)
    free(p->quantity[i].key);
  for (int64_t i = 0; i < p->openings; i++)
    free(p->opening[i].key);
  for (int i = 0; i < p->overrides; i++)
    free(p->override[i]);
  free(p->quantity);
  free(p->opening);
  free(p->place);
  free(p->override);
  free(p->text);
  free(p);
  *places = NULL;
}

cdem_status cdem_case_places_add(cdem_case_places *places, const char *key,
                                 const cdem_case_place *at, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&places->place, &places->capacity, places->places + 1, sizeof *places->place,
                     fault));
  cdem_case_place *place = &places->place[places->places];
  *place = *at;
  place->key = cdem_copy_text(key, fault);
  if (place->key == NULL)
    return CDEM_MEMORY;
  places->places++;
  return CDEM_OK;
}

const cdem_case_place *cdem_case_places_find(const cdem_case_places *places, const char *key) {
  for (int64_t i = 0; places != NULL && i < places->places; i++)
    if (strcmp(places->place[i].key, key) == 0)
      return &places->place[i];
  return NULL;
}

cdem_status cdem_case_places_add_quantity(cdem_case_places *places, const char *key,
                                          const cdem_case_quantity *at, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&places->quantity, &places->quantity_capacity, places->quantities + 1,
                     sizeof *places->quantity, fault));
  cdem_case_quantity *quantity = &places->quantity[places->quantities];
  *quantity = *at;
  quantity->key = cdem_copy_text(key, fault);
  if (quantity->key == NULL)
    return CDEM_MEMORY;
  places->quantities++;
  return CDEM_OK;
}

cdem_status cdem_case_places_add_opening(cdem_case_places *places, const char *key,
                                         const cdem_case_opening *at, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&places->opening, &places->opening_capacity, places->openings + 1,
                     sizeof *places->opening, fault));
  cdem_case_opening *opening = &places->opening[places->openings];
  *opening = *at;
  opening->key = cdem_copy_text(key, fault);
  if (opening->key == NULL)
    return CDEM_MEMORY;
  places->openings++;
  return CDEM_OK;
}

const cdem_case_opening *cdem_case_places_find_opening(const cdem_case_places *places,
                                                       const char *key) {
  for (int64_t i = 0; i < places->openings; i++)
    if (strcmp(places->opening[i].key, key) == 0)
      return &places->opening[i];
  return NULL;
}

const char *cdem_case_text_at(const char *text, int line, int column) {
  for (; line > 1 && text != NULL; line--) {
    text = strchr(text, '\n');
    text = text != NULL ? text + 1 : NULL;
  }
  for (; column > 1 && text != NULL && *text != '\0' && *text != '\n'; column--)
    do
      text++;
    while ((*text & 0xc0) == 0x80);
  return text;
}
