/* Where each value of a case stands: plain data that the reader of case files fills, so that a
 * failure found later still shows the line and the caret. */
#ifndef CDEM_CASES_PLACES_H
#define CDEM_CASES_PLACES_H

#include "cases/case.h"

typedef struct {
  char *key;               /* "interfaces[0].tension" */
  int line, column, width; /* from 1, in the text of the file */
  int override;            /* -1: the file; else the override it came from */
} cdem_case_place;

struct cdem_case_places {
  char *text; /* of the file as it was read; owned */
  int overrides;
  char **override; /* [overrides] owned */
  int64_t places, capacity;
  cdem_case_place *place; /* [places] in the order of reading */
};

/* Takes over the file's text; copies the overrides. */
cdem_status cdem_case_places_create(char *text, int overrides, const char *const *override,
                                    cdem_case_places **places, cdem_fault *fault);
void cdem_case_places_destroy(cdem_case_places **places);
/* `at->key` is not copied from: the key is `key`. */
cdem_status cdem_case_places_add(cdem_case_places *places, const char *key,
                                 const cdem_case_place *at, cdem_fault *fault);
/* The place of a key, NULL when it was not given. */
const cdem_case_place *cdem_case_places_find(const cdem_case_places *places, const char *key);

#endif
