/* All values of a case, defaults included, as JSON: a walk over the same table from which it was
 * read. */
#include "cases/schema.h"
#include "run/summary.h"

#include <math.h>
#include <string.h>

/* The layout that all CDEM_CASE_LIST share. */
typedef CDEM_CASE_LIST(void) any_list;

static void put_section(cdem_json *json, const cdem_case_section *section, const void *values);

static void put_series(cdem_json *json, const char *name, const cdem_series *series) {
  if (series->kind == CDEM_SERIES_TABLE && series->points <= 1) {
    cdem_json_real(json, name, series->points == 1 ? series->value[0] : 0.0);
    return;
  }
  cdem_json_open(json, name, '{');
  if (series->kind == CDEM_SERIES_TABLE) {
    cdem_json_reals(json, "time", series->time, series->points);
    cdem_json_reals(json, "value", series->value, series->points);
  } else {
    bool sine = series->kind == CDEM_SERIES_SINE;
    cdem_json_string(json, "kind", sine ? "sine" : "pulse");
    cdem_json_real(json, "offset", series->offset);
    cdem_json_real(json, "amplitude", series->amplitude);
    cdem_json_real(json, "start", series->start);
    if (sine) {
      cdem_json_real(json, "frequency", series->frequency);
      cdem_json_real(json, "phase", series->phase);
    } else {
      cdem_json_real(json, "duration", series->duration);
    }
  }
  cdem_json_close(json, '}');
}

static void put_components(cdem_json *json, const char *name,
                           const cdem_case_components *components) {
  cdem_json_open(json, name, '{');
  for (int k = 0; k < 4; k++)
    if (components->given[k])
      put_series(json, cdem_run_component[k], &components->component[k]);
  cdem_json_close(json, '}');
}

static void put_material(cdem_json *json, const cdem_material *material) {
  const cdem_material_model_info *model = cdem_material_model_get(material->model);
  cdem_json_string(json, "model", model->name);
  for (int k = 0; k < model->keys; k++)
    cdem_json_real(json, model->key[k].key, material->parameter[k]);
  if (material->rotated) {
    cdem_json_reals(json, "axis1", material->axis1, 3);
    cdem_json_reals(json, "axis2", material->axis2, 3);
  }
}

static void put_texts(cdem_json *json, const char *name, const cdem_case_texts *texts) {
  cdem_json_open(json, name, '[');
  for (int64_t i = 0; i < texts->count; i++)
    cdem_json_string(json, NULL, texts->item[i]);
  cdem_json_close(json, ']');
}

static void put_list(cdem_json *json, const cdem_case_key *key, const void *member) {
  bool named = key->kind == CDEM_KEY_NAMED;
  any_list list;
  memcpy(&list, member, sizeof list);
  cdem_json_open(json, key->key, named ? '{' : '[');
  for (int64_t i = 0; i < list.count; i++) {
    const char *item = (const char *)list.item + (size_t)i * key->section->size, *name = NULL;
    if (named)
      memcpy(&name, item, sizeof name);
    cdem_json_open(json, name, '{');
    put_section(json, key->section, item);
    cdem_json_close(json, '}');
  }
  cdem_json_close(json, named ? '}' : ']');
}

static void put_numbers(cdem_json *json, const char *name, const void *member) {
  any_list list;
  memcpy(&list, member, sizeof list);
  const cdem_case_parameter *parameter = list.item;
  cdem_json_open(json, name, '{');
  for (int64_t i = 0; i < list.count; i++)
    cdem_json_real(json, parameter[i].name, parameter[i].value);
  cdem_json_close(json, '}');
}

static void put_text(cdem_json *json, const char *name, const void *member) {
  const char *text;
  memcpy(&text, member, sizeof text);
  cdem_json_string(json, name, text);
}

static void put_member(cdem_json *json, const cdem_case_key *key, const void *values) {
  const void *member = (const char *)values + key->offset;
  switch (key->kind) {
  case CDEM_KEY_NUMBER:
    cdem_json_real(json, key->key, *(const double *)member);
    break;
  case CDEM_KEY_INTEGER:
    cdem_json_integer(json, key->key, *(const int64_t *)member);
    break;
  case CDEM_KEY_BOOLEAN:
    cdem_json_boolean(json, key->key, *(const bool *)member);
    break;
  case CDEM_KEY_TEXT:
    put_text(json, key->key, member);
    break;
  case CDEM_KEY_CHOICE:
    cdem_json_string(json, key->key, key->choice[*(const int *)member]);
    break;
  case CDEM_KEY_VECTOR:
    cdem_json_reals(json, key->key, member, key->length);
    break;
  case CDEM_KEY_SERIES:
    if (*(const bool *)((const char *)values + key->given))
      put_series(json, key->key, member);
    break;
  case CDEM_KEY_COMPONENTS:
    put_components(json, key->key, member);
    break;
  case CDEM_KEY_TEXTS:
    put_texts(json, key->key, member);
    break;
  case CDEM_KEY_NUMBERS:
    put_numbers(json, key->key, member);
    break;
  case CDEM_KEY_MATERIAL:
    put_material(json, member);
    break;
  case CDEM_KEY_SECTION:
    cdem_json_open(json, key->key, '{');
    put_section(json, key->section, member);
    cdem_json_close(json, '}');
    break;
  case CDEM_KEY_LIST:
  case CDEM_KEY_NAMED:
    put_list(json, key, member);
    break;
  }
}

static void put_section(cdem_json *json, const cdem_case_section *section, const void *values) {
  for (int k = 0; k < section->keys; k++)
    put_member(json, &section->key[k], values);
}

void cdem_run_put_settings(cdem_json *json, const cdem_case_values *values) {
  cdem_json_open(json, "settings", '{');
  put_section(json, cdem_case_root(), values);
  cdem_json_close(json, '}');
}
