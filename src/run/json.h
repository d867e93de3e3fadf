/* Private to run: a JSON text in memory, indented, to be handed to io as a whole. */
#ifndef CDEM_RUN_JSON_H
#define CDEM_RUN_JSON_H

#include "base/base.h"

#include <stdbool.h>

/* Zero-initialise; release at any stage. After a failure nothing more is added and status tells. */
typedef struct {
  char *text;
  int64_t used, capacity;
  int depth;
  bool first; /* nothing in the present object or array yet */
  cdem_status status;
  cdem_fault *fault;
} cdem_json;

void cdem_json_release(cdem_json *json);
/* name NULL: an entry of an array. */
void cdem_json_open(cdem_json *json, const char *name, char bracket); /* '{' or '[' */
void cdem_json_close(cdem_json *json, char bracket);                  /* '}' or ']' */
void cdem_json_real(cdem_json *json, const char *name, double value); /* not finite: null */
void cdem_json_integer(cdem_json *json, const char *name, int64_t value);
void cdem_json_boolean(cdem_json *json, const char *name, bool value);
void cdem_json_string(cdem_json *json, const char *name, const char *value); /* NULL: null */
/* Numbers on one line. */
void cdem_json_reals(cdem_json *json, const char *name, const double *value, int count);

#endif
