/* Where each value of a case stands: plain data that the reader of case files fills, so that a
 * failure found later still shows the line and the caret. */
#ifndef CDEM_CASES_PLACES_H
#define CDEM_CASES_PLACES_H

#include "cases/case.h"
#include "cases/schema.h"

typedef struct {
  char *key;               /* "interfaces[0].tension" */
  int line, column, width; /* from 1, in the text of the file */
  int override;            /* -1: the file; else the override it came from */
} cdem_case_place;

/* A number of the file: what scaling works on. Functions of time have several; a function's numbers
 * stand under its key. */
typedef struct {
  char *key;               /* "interfaces[0].tension", "materials.rock.young" */
  int line, column, width; /* from 1, with the quotes; width in characters, 0: not on one line */
  int override;            /* as above */
  cdem_dimension dimension;
  cdem_scale_tag tag;
  bool keeps_rate; /* of its key */
  bool counts;     /* a number of grains */
  double value;    /* SI */
} cdem_case_quantity;

/* A map of the file, by its first key: where further keys go. */
typedef struct {
  char *key; /* of the section: "mesh", "" */
  int line, column;
  bool braces; /* {key: value}; else a key a line */
} cdem_case_opening;

struct cdem_case_places {
  char *text; /* of the file as it was read; owned */
  int overrides;
  char **override; /* [overrides] owned */
  int64_t places, capacity;
  cdem_case_place *place; /* [places] in the order of reading */
  int64_t quantities, quantity_capacity;
  cdem_case_quantity *quantity; /* [quantities] the same */
  int64_t openings, opening_capacity;
  cdem_case_opening *opening; /* [openings] the same */
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

/* The same for numbers and maps. */
cdem_status cdem_case_places_add_quantity(cdem_case_places *places, const char *key,
                                          const cdem_case_quantity *at, cdem_fault *fault);
cdem_status cdem_case_places_add_opening(cdem_case_places *places, const char *key,
                                         const cdem_case_opening *at, cdem_fault *fault);
/* NULL: the section has no map in the file. */
const cdem_case_opening *cdem_case_places_find_opening(const cdem_case_places *places,
                                                       const char *key);
/* The byte of a text at a place; columns count characters. NULL: the text has no such place. */
const char *cdem_case_text_at(const char *text, int line, int column);

#endif
