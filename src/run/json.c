/* JSON in memory. Numbers have 17 digits and a point, whatever the locale. */
#include "run/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cdem_json_release(cdem_json *json) {
  free(json->text);
  *json = (cdem_json){0};
}

static void add(cdem_json *json, const char *text, size_t length) {
  if (json->status != CDEM_OK)
    return;
  json->status =
      cdem_grow(&json->text, &json->capacity, json->used + (int64_t)length + 1, 1, json->fault);
  if (json->status != CDEM_OK)
    return;
  memcpy(json->text + json->used, text, length);
  json->used += (int64_t)length;
  json->text[json->used] = '\0';
}

static void add_text(cdem_json *json, const char *text) {
  add(json, text, strlen(text));
}

static void add_quoted(cdem_json *json, const char *text) {
  add_text(json, "\"");
  for (const char *c = text; *c != '\0'; c++) {
    char escaped[8];
    if (*c == '"' || *c == '\\')
      snprintf(escaped, sizeof escaped, "\\%c", *c);
    else if ((unsigned char)*c < 0x20 || *c == 0x7f) /* which YAML, our reader, refuses */
      snprintf(escaped, sizeof escaped, "\\u%04x", (unsigned)(unsigned char)*c);
    else
      snprintf(escaped, sizeof escaped, "%c", *c);
    add_text(json, escaped);
  }
  add_text(json, "\"");
}

/* Comma, new line, indentation and name. */
static void begin(cdem_json *json, const char *name) {
  if (!json->first && json->depth > 0)
    add_text(json, ",");
  if (json->depth > 0)
    add_text(json, "\n");
  for (int i = 0; i < json->depth; i++)
    add_text(json, "  ");
  if (name != NULL) {
    add_quoted(json, name);
    add_text(json, ": ");
  }
  json->first = false;
}

void cdem_json_open(cdem_json *json, const char *name, char bracket) {
  begin(json, name);
  add(json, &bracket, 1);
  json->depth++;
  json->first = true;
}

void cdem_json_close(cdem_json *json, char bracket) {
  json->depth--;
  if (!json->first) {
    add_text(json, "\n");
    for (int i = 0; i < json->depth; i++)
      add_text(json, "  ");
  }
  add(json, &bracket, 1);
  json->first = false;
  if (json->depth == 0)
    add_text(json, "\n");
}

static void add_real(cdem_json *json, double value) {
  char text[40];
  if (!isfinite(value)) {
    add_text(json, "null");
    return;
  }
  snprintf(text, sizeof text, "%.15g", value);
  if (strtod(text, NULL) != value)
    snprintf(text, sizeof text, "%.17g", value);
  char *comma = strchr(text, ','); /* some locales */
  if (comma != NULL)
    *comma = '.';
  add_text(json, text);
}

void cdem_json_real(cdem_json *json, const char *name, double value) {
  begin(json, name);
  add_real(json, value);
}

void cdem_json_integer(cdem_json *json, const char *name, int64_t value) {
  char text[32];
  begin(json, name);
  snprintf(text, sizeof text, "%lld", (long long)value);
  add_text(json, text);
}

void cdem_json_boolean(cdem_json *json, const char *name, bool value) {
  begin(json, name);
  add_text(json, value ? "true" : "false");
}

void cdem_json_string(cdem_json *json, const char *name, const char *value) {
  begin(json, name);
  if (value == NULL)
    add_text(json, "null");
  else
    add_quoted(json, value);
}

void cdem_json_reals(cdem_json *json, const char *name, const double *value, int count) {
  begin(json, name);
  add_text(json, "[");
  for (int i = 0; i < count; i++) {
    if (i > 0)
      add_text(json, ", ");
    add_real(json, value[i]);
  }
  add_text(json, "]");
}
