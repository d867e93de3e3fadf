/* Values of a case as text: one key with its unit. */
#include "report/setting_value.h"

#include "io/case_text.h"
#include "report/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DIGITS = 6, MOST_POINTS = 12 };

/* The layout that all CDEM_CASE_LIST share. */
typedef CDEM_CASE_LIST(void) any_list;

void cdem_report_put_value_of(cdem_report_text *to, double value, const char *unit) {
  char text[CDEM_REPORT_NUMBER];
  cdem_report_escaped(
      to, cdem_report_quantity(value, DIGITS, strcmp(unit, "1") == 0 ? "" : unit, text));
}

static void put_vector(cdem_report_text *to, const double *value, const cdem_case_key *key,
                       const char *unit) {
  char text[CDEM_REPORT_NUMBER];
  int length = key->length;
  while (length > key->fewest && length > 1 && value[length - 1] == 0.0)
    length--;
  if (length == 1) {
    cdem_report_put_value_of(to, value[0], unit);
    return;
  }
  cdem_report_raw(to, "(");
  for (int i = 0; i < length; i++)
    cdem_report_format(to, "%s%s", i > 0 ? ", " : "", cdem_report_number(value[i], DIGITS, text));
  cdem_report_raw(to, ")");
  if (strcmp(unit, "1") != 0)
    cdem_report_format(to, " %s", cdem_report_unit(unit, text));
}

static void put_wave(cdem_report_text *to, const cdem_series *s, const char *unit) {
  bool sine = s->kind == CDEM_SERIES_SINE;
  cdem_report_raw(to, sine ? "sine of " : "pulse of ");
  cdem_report_put_value_of(to, s->amplitude, unit);
  cdem_report_raw(to, sine ? " at " : " over ");
  cdem_report_put_value_of(to, sine ? s->frequency : s->duration, sine ? "Hz" : "s");
  if (s->offset != 0.0) {
    cdem_report_raw(to, " about ");
    cdem_report_put_value_of(to, s->offset, unit);
  }
  if (s->start != 0.0) {
    cdem_report_raw(to, " from ");
    cdem_report_put_value_of(to, s->start, "s");
  }
}

static void put_series(cdem_report_text *to, const cdem_series *s, const char *unit) {
  if (s->kind != CDEM_SERIES_TABLE) {
    put_wave(to, s, unit);
    return;
  }
  if (s->points <= 1) {
    cdem_report_put_value_of(to, s->points == 1 ? s->value[0] : 0.0, unit);
    return;
  }
  for (int i = 0; i < s->points && i < MOST_POINTS; i++) {
    cdem_report_raw(to, i > 0 ? ", " : "");
    cdem_report_put_value_of(to, s->value[i], unit);
    cdem_report_raw(to, " at ");
    cdem_report_put_value_of(to, s->time[i], "s");
  }
  if (s->points > MOST_POINTS)
    cdem_report_format(to, ", … (%d points)", s->points);
}

static void put_components(cdem_report_text *to, const cdem_case_components *components,
                           const cdem_case_key *key, const char *unit) {
  static const char *const name[] = {"x", "y", "z", "rotation"};
  char turn[48];
  bool first = true;
  for (int k = 0; k < 4; k++) {
    if (!components->given[k])
      continue;
    cdem_report_format(to, "%s%s: ", first ? "" : "; ", name[k]);
    put_series(to, &components->component[k],
               k == 3 ? cdem_dimension_unit(key->rotation, turn) : unit);
    first = false;
  }
}

static void put_texts(cdem_report_text *to, const cdem_case_texts *texts) {
  for (int64_t i = 0; i < texts->count; i++) {
    cdem_report_raw(to, i > 0 ? ", " : "");
    cdem_report_escaped(to, texts->item[i]);
  }
}

static void put_numbers(cdem_report_text *to, const any_list *list) {
  const cdem_case_parameter *item = list->item;
  char text[CDEM_REPORT_NUMBER];
  for (int64_t i = 0; i < list->count; i++) {
    cdem_report_raw(to, i > 0 ? ", " : "");
    cdem_report_escaped(to, item[i].name);
    cdem_report_format(to, " = %s", cdem_report_number(item[i].value, DIGITS, text));
  }
}

void cdem_report_put_value(cdem_report_text *to, const cdem_case_key *key, const void *values) {
  const char *member = (const char *)values + key->offset, *words;
  char unit[CDEM_CASE_PHRASE], dimension[48];
  any_list list;
  cdem_case_unit_text(key, unit);
  if (strcmp(unit, "J/m2") == 0 && strstr(key->example, "N/m") != NULL)
    strcpy(unit, "N/m"); /* a stiffness, which has the dimension of an energy by area */
  if (key->rotates)      /* "m; rotation rad" */
    snprintf(unit, sizeof unit, "%s", cdem_dimension_unit(key->dimension, dimension));
  switch (key->kind) {
  case CDEM_KEY_NUMBER:
    cdem_report_put_value_of(to, *(const double *)(const void *)member, unit);
    break;
  case CDEM_KEY_INTEGER:
    cdem_report_format(to, "%lld", (long long)*(const int64_t *)(const void *)member);
    break;
  case CDEM_KEY_BOOLEAN:
    cdem_report_raw(to, *(const bool *)member ? "yes" : "no");
    break;
  case CDEM_KEY_TEXT:
    memcpy(&words, member, sizeof words);
    cdem_report_escaped(to, words != NULL ? words : "");
    break;
  case CDEM_KEY_CHOICE:
    cdem_report_escaped(to, key->choice[*(const int *)(const void *)member]);
    break;
  case CDEM_KEY_VECTOR:
    put_vector(to, (const double *)(const void *)member, key, unit);
    break;
  case CDEM_KEY_SERIES:
    put_series(to, (const cdem_series *)(const void *)member, unit);
    break;
  case CDEM_KEY_COMPONENTS:
    put_components(to, (const cdem_case_components *)(const void *)member, key, unit);
    break;
  case CDEM_KEY_TEXTS:
    put_texts(to, (const cdem_case_texts *)(const void *)member);
    break;
  case CDEM_KEY_NUMBERS:
    memcpy(&list, member, sizeof list);
    put_numbers(to, &list);
    break;
  default: /* sections and materials have rows of their own */
    break;
  }
}

void cdem_report_put_default(cdem_report_text *to, const cdem_case_key *key, const void *values) {
  char words[CDEM_CASE_PHRASE];
  const char *member = (const char *)values + key->offset;
  bool number = key->kind == CDEM_KEY_NUMBER && !isnan(*(const double *)(const void *)member);
  if (number && (key->otherwise == NULL || *(const double *)(const void *)member != 0.0)) {
    cdem_report_put_value(to, key, values);
    return;
  }
  cdem_case_default_text(key, words);
  cdem_report_escaped(to, words);
}
