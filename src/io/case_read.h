/* Private to io: what the files that read a case share. */
#ifndef CDEM_IO_CASE_READ_H
#define CDEM_IO_CASE_READ_H

#include "base/suggest.h"
#include "cases/places.h"
#include "cases/schema.h"
#include "io/material_read.h"

/* Mistakes in the file go to the tree and reading goes on; `status` keeps the first failure that
 * ends it (memory). */
typedef struct {
  cdem_yaml yaml;
  cdem_units units;
  cdem_case *read;
  char path[CDEM_CASE_PATH]; /* of the value at hand: "interfaces[0].tension" */
  bool unchecked;            /* keys that exclude each other may stand side by side */
  cdem_status status;
  cdem_fault *fault;
} cdem_case_reader;

/* As cdem_read_case_text, without the checks that join several keys: for tests of the tables, which
 * give all keys at once. */
cdem_status cdem_case_read_unchecked(const char *path, const char *text, cdem_case *read,
                                     cdem_fault *fault);

/* Appends to the path; give the result to cdem_case_leave. */
__attribute__((format(printf, 2, 3))) size_t cdem_case_enter(cdem_case_reader *r,
                                                             const char *format, ...);
void cdem_case_leave(cdem_case_reader *r, size_t before);
/* Notes that the value at the path stands at this node. */
void cdem_case_note(cdem_case_reader *r, const cdem_yaml_node *at);

/* A number with its unit within the range of the key. False after an error. */
bool cdem_case_number(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                      double *value);
/* The value of a key of any kind but sections and lists of them. */
void cdem_case_value(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                     void *values);

/* Functions of time: see docs/rooms/cases.md for their forms. False after an error. */
bool cdem_case_series(cdem_case_reader *r, const cdem_yaml_node *at, const char *name,
                      cdem_dimension dimension, cdem_series *series);
void cdem_case_components_read(cdem_case_reader *r, const cdem_yaml_node *at,
                               const cdem_case_key *key, cdem_case_components *components);

/* Puts the overrides into the tree. */
void cdem_case_override(cdem_case_reader *r);

#endif
