/* Case files: one value of a key. */
#include "io/case_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- numbers ---- */

/* "at least 0 Pa", "above 0", "between 0 and 0.25". */
static void put_range(const cdem_case_key *key, const char *unit, char out[128]) {
  if (isinf(key->most))
    snprintf(out, 128, "%s %g%s", key->above ? "above" : "at least", key->least, unit);
  else
    snprintf(out, 128, "%s %g and %s %g%s", key->above ? "above" : "at least", key->least,
             key->below ? "below" : "at most", key->most, unit);
}

static bool check_range(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                        double value) {
  bool low = key->above ? value > key->least : value >= key->least;
  bool high = key->below ? value < key->most : value <= key->most;
  if (key->least == key->most || (low && high))
    return true;
  char unit[48], space_unit[56] = "", range[128];
  cdem_dimension_unit(key->dimension, unit);
  if (strcmp(unit, "1") != 0)
    snprintf(space_unit, sizeof space_unit, " %s", unit);
  put_range(key, space_unit, range);
  cdem_yaml_error(&r->yaml, at, "%s is %g%s and must be %s", key->key, value, space_unit, range);
  return false;
}

bool cdem_case_number(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                      double *value) {
  double number;
  if (!cdem_yaml_quantity(&r->yaml, &r->units, at, key->key, key->dimension, &number) ||
      !check_range(r, at, key, number))
    return false;
  *value = number;
  return true;
}

static void read_integer(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                         int64_t *value) {
  double number;
  if (!cdem_yaml_quantity(&r->yaml, &r->units, at, key->key, CDEM_DIMENSIONLESS, &number))
    return;
  if (number != floor(number) || fabs(number) > 9007199254740992.0) /* 2^53 */
    cdem_yaml_error(&r->yaml, at, "%s is '%s' and must be a whole number", key->key, at->text);
  else if (check_range(r, at, key, number))
    *value = (int64_t)number;
}

static void read_vector(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                        double *value) {
  if (at->kind != CDEM_YAML_LIST || at->children < key->fewest || at->children > key->length) {
    char count[32];
    snprintf(count, sizeof count, key->fewest < key->length ? "%d to %d" : "%d", key->fewest,
             key->length);
    cdem_yaml_error(&r->yaml, at, "'%s' must be a list of %s numbers, such as %s", key->key, count,
                    key->example);
    return;
  }
  int i = 0;
  for (const cdem_yaml_node *c = cdem_yaml_child(&r->yaml, at); c != NULL;
       c = cdem_yaml_next(&r->yaml, c), i++) {
    size_t before = cdem_case_enter(r, "[%d]", i);
    cdem_case_note(r, c);
    cdem_case_number(r, c, key, &value[i]);
    cdem_case_leave(r, before);
  }
}

/* ---- words ---- */

static bool is_scalar(cdem_case_reader *r, const cdem_yaml_node *at, const char *name,
                      const char *what) {
  if (at->kind == CDEM_YAML_SCALAR && *at->text != '\0')
    return true;
  cdem_yaml_error(&r->yaml, at, "'%s' must be %s, not %s", name, what,
                  at->kind == CDEM_YAML_SCALAR ? "nothing" : cdem_yaml_kind_name(at->kind));
  return false;
}

static void read_boolean(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                         bool *value) {
  static const char *const words[] = {"no", "yes", "false", "true", "off", "on"};
  if (!is_scalar(r, at, key->key, "yes or no"))
    return;
  for (int i = 0; i < 6; i++)
    if (strcmp(at->text, words[i]) == 0) {
      *value = i % 2 == 1;
      return;
    }
  cdem_yaml_error(&r->yaml, at, "'%s' must be yes or no, not '%s'", key->key, at->text);
}

static void read_text(cdem_case_reader *r, const cdem_yaml_node *at, const char *name,
                      char **value) {
  if (r->status != CDEM_OK || !is_scalar(r, at, name, "a text"))
    return;
  *value = cdem_copy_text(at->text, r->fault);
  if (*value == NULL)
    r->status = CDEM_MEMORY;
}

static void read_choice(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                        int *value) {
  int count = 0;
  char list[256] = "";
  if (!is_scalar(r, at, key->key, "a word"))
    return;
  for (size_t used = 0; key->choice[count] != NULL; count++) {
    if (strcmp(at->text, key->choice[count]) == 0) {
      *value = count;
      return;
    }
    if (used + 32 < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, " %s", key->choice[count]);
  }
  const char *near = cdem_suggest(at->text, key->choice, count);
  cdem_yaml_error(&r->yaml, at, "unknown %s '%s'; %s%s%s%s", key->key, at->text,
                  near != NULL ? "did you mean '" : "it is one of:", near != NULL ? near : list,
                  near != NULL ? "'?" : "", "");
}

static void read_texts(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                       cdem_case_texts *texts) {
  if (at->kind == CDEM_YAML_MAP || (at->kind == CDEM_YAML_SCALAR && *at->text == '\0') ||
      (at->kind == CDEM_YAML_LIST && at->children == 0)) {
    cdem_yaml_error(&r->yaml, at, "'%s' must be one text or a list of texts", key->key);
    return;
  }
  bool list = at->kind == CDEM_YAML_LIST;
  texts->item = cdem_allocate(list ? at->children : 1, sizeof *texts->item, r->fault);
  if (texts->item == NULL) {
    r->status = CDEM_MEMORY;
    return;
  }
  texts->count = list ? at->children : 1;
  int i = 0;
  for (const cdem_yaml_node *c = list ? cdem_yaml_child(&r->yaml, at) : at; c != NULL;
       c = list ? cdem_yaml_next(&r->yaml, c) : NULL, i++) {
    size_t before = cdem_case_enter(r, "[%d]", i);
    cdem_case_note(r, c);
    read_text(r, c, key->key, &texts->item[i]);
    cdem_case_leave(r, before);
  }
}

/* ---- named numbers ---- */

typedef CDEM_CASE_LIST(cdem_case_parameter) parameter_list;

static void read_numbers(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                         void *member) {
  if (at->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(&r->yaml, at, "'%s' must be a map of names and numbers, such as %s", key->key,
                    key->example);
    return;
  }
  parameter_list list = {0, cdem_allocate(at->children / 2, sizeof *list.item, r->fault)};
  if (list.item == NULL) {
    r->status = CDEM_MEMORY;
    return;
  }
  CDEM_YAML_EACH(&r->yaml, at, name, value) {
    if (name->kind != CDEM_YAML_SCALAR)
      continue;
    cdem_case_parameter *parameter = &list.item[list.count++];
    size_t before = cdem_case_enter(r, "%s", name->text);
    cdem_case_note(r, value);
    cdem_yaml_quantity(&r->yaml, &r->units, value, name->text, CDEM_DIMENSIONLESS,
                       &parameter->value);
    read_text(r, name, key->key, &parameter->name);
    cdem_case_leave(r, before);
  }
  memcpy(member, &list, sizeof list);
}

/* ---- all ---- */

void cdem_case_value(cdem_case_reader *r, const cdem_yaml_node *at, const cdem_case_key *key,
                     void *values) {
  void *member = (char *)values + key->offset;
  switch (key->kind) {
  case CDEM_KEY_NUMBER:
    cdem_case_number(r, at, key, member);
    break;
  case CDEM_KEY_INTEGER:
    read_integer(r, at, key, member);
    break;
  case CDEM_KEY_BOOLEAN:
    read_boolean(r, at, key, member);
    break;
  case CDEM_KEY_TEXT: {
    char *text = NULL;
    read_text(r, at, key->key, &text);
    memcpy(member, &text, sizeof text);
    break;
  }
  case CDEM_KEY_CHOICE:
    read_choice(r, at, key, member);
    break;
  case CDEM_KEY_VECTOR:
    read_vector(r, at, key, member);
    break;
  case CDEM_KEY_SERIES:
    *(bool *)((char *)values + key->given) =
        cdem_case_series(r, at, key->key, key->dimension, member);
    break;
  case CDEM_KEY_COMPONENTS:
    cdem_case_components_read(r, at, key, member);
    break;
  case CDEM_KEY_TEXTS:
    read_texts(r, at, key, member);
    break;
  case CDEM_KEY_NUMBERS:
    read_numbers(r, at, key, member);
    break;
  default: /* sections: case_file.c */
    break;
  }
}
