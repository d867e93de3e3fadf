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
  for (int i = 0; i < p->overrides; i++)
    free(p->override[i]);
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
