/* The schema in words: for help, the reference page, the JSON Schema, and whoever shows the values
 * of a case. */
#ifndef CDEM_IO_CASE_TEXT_H
#define CDEM_IO_CASE_TEXT_H

#include "cases/schema.h"

#include <stdio.h>

/* A key as cdem_case_walk visits it, with the path it has in help: "interfaces.tension". */
typedef struct {
  char path[CDEM_CASE_PATH];
  cdem_case_key key;
  bool of_model; /* a modulus or an axis: there are many */
} cdem_case_entry;

typedef struct {
  int64_t count, capacity;
  cdem_case_entry *entry;
} cdem_case_index;

/* All keys, in the order of the tables. */
cdem_status cdem_case_index_make(cdem_case_index *index, cdem_fault *fault);
void cdem_case_index_release(cdem_case_index *index);

/* "interfaces[0].tension", "materials.NAME.young" -> "interfaces.tension", "materials.young". */
void cdem_case_plain_path(const char *path, char plain[CDEM_CASE_PATH]);

enum { CDEM_CASE_PHRASE = 320 };
/* What a value is: "number, Pa", "one of brittle, linear", "list of 2 to 3 numbers, m". */
void cdem_case_kind_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]);
/* The SI unit of a plain number, "1" for a ratio, "" for what is no number. */
void cdem_case_unit_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]);
/* "1 m", "required", "automatic: ...". */
void cdem_case_default_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]);
/* "above 0", "0 to 0.25", "" when there is none. */
void cdem_case_range_text(const cdem_case_key *key, char out[CDEM_CASE_PHRASE]);

/* The forms of functions of time, one a line. */
extern const char *const cdem_case_series_forms[];

#endif
