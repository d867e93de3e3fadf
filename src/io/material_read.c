/* One material from a map of keys. The keys of each model, their dimensions and bounds come from
 * the table in room elements; this file knows only the words around them. */
#include "io/material_read.h"

#include <math.h>
#include <string.h>

enum { MAX_KEYS = CDEM_MATERIAL_PARAMETERS + 16 };

static const char *const around[] = {"model", "axis1", "axis2"};

/* What is read from. */
typedef struct {
  cdem_yaml *yaml;
  cdem_units *units;
} reading;

static bool is_one_of(const char *word, const char *const *list, int count) {
  for (int i = 0; i < count; i++)
    if (strcmp(word, list[i]) == 0)
      return true;
  return false;
}

static int parameter_of(const cdem_material_model_info *info, const char *key) {
  for (int k = 0; k < info->keys; k++)
    if (strcmp(info->key[k].key, key) == 0)
      return k;
  return -1;
}

bool cdem_yaml_quantity(cdem_yaml *yaml, cdem_units *units, const cdem_yaml_node *at,
                        const char *key, cdem_dimension dimension, double *value) {
  cdem_fault fault = {0};
  if (at->kind != CDEM_YAML_SCALAR) {
    cdem_yaml_error(yaml, at, "'%s' must be a number, not %s", key, cdem_yaml_kind_name(at->kind));
    return false;
  }
  if (cdem_units_parse(units, at->text, dimension, value, &fault) != CDEM_OK) {
    cdem_yaml_error(yaml, at, "%s: %s", key, fault.message);
    return false;
  }
  if (cdem_grow(&yaml->number, &yaml->number_capacity, yaml->numbers + 1, sizeof *yaml->number,
                &fault) == CDEM_OK)
    yaml->number[yaml->numbers++] =
        (cdem_yaml_number){(int32_t)(at - yaml->node), dimension, *value};
  else
    yaml->lacks_memory = true;
  return true;
}

static bool read_axis(const reading *r, const cdem_yaml_node *at, const char *key, double axis[3]) {
  const cdem_yaml_node *component = cdem_yaml_child(r->yaml, at);
  if (at->kind != CDEM_YAML_LIST || at->children != 3) {
    cdem_yaml_error(r->yaml, at, "'%s' must be a list of three numbers, such as [1, 0, 0]", key);
    return false;
  }
  for (int c = 0; c < 3; c++, component = cdem_yaml_next(r->yaml, component))
    if (!cdem_yaml_quantity(r->yaml, r->units, component, key, CDEM_DIMENSIONLESS, &axis[c]))
      return false;
  return true;
}

/* Both axes or none, and they must span a plane. The bound, a sine of 1e-6, keeps ten digits of
 * the normal. */
static void read_axes(const reading *r, const cdem_yaml_node *map, cdem_material *material) {
  const cdem_yaml_node *first = cdem_yaml_find(r->yaml, map, "axis1");
  const cdem_yaml_node *second = cdem_yaml_find(r->yaml, map, "axis2");
  if (first == NULL && second == NULL)
    return;
  if (cdem_material_model_get(material->model)->isotropic) {
    cdem_yaml_error(r->yaml, first != NULL ? first : second,
                    "axes have no meaning for an isotropic material; leave them out");
    return;
  }
  if (first == NULL || second == NULL) {
    cdem_yaml_error(r->yaml, first != NULL ? first : second, "'%s' is missing beside '%s'",
                    first != NULL ? "axis2" : "axis1", first != NULL ? "axis1" : "axis2");
    return;
  }
  if (!read_axis(r, first, "axis1", material->axis1) ||
      !read_axis(r, second, "axis2", material->axis2))
    return;
  double normal[3], size = cdem_norm3(material->axis1) * cdem_norm3(material->axis2);
  cdem_cross3(material->axis1, material->axis2, normal);
  if (!(cdem_norm3(normal) > 1e-6 * size))
    cdem_yaml_error(r->yaml, second, "'axis1' and 'axis2' must not be zero or parallel");
  else
    material->rotated = true;
}

/* The model of a material, isotropic when it is not named; false after an error. */
static bool read_model(const reading *r, const cdem_yaml_node *map, cdem_material *material) {
  const cdem_yaml_node *at = cdem_yaml_find(r->yaml, map, "model");
  if (at == NULL)
    return true;
  if (at->kind != CDEM_YAML_SCALAR) {
    cdem_yaml_error(r->yaml, at, "'model' must be a name, not %s", cdem_yaml_kind_name(at->kind));
    return false;
  }
  material->model = cdem_material_model_find(at->text);
  if (material->model < CDEM_MATERIAL_MODEL_COUNT)
    return true;
  const char *name[CDEM_MATERIAL_MODEL_COUNT];
  for (int m = 0; m < CDEM_MATERIAL_MODEL_COUNT; m++)
    name[m] = cdem_material_model_get((cdem_material_model)m)->name;
  cdem_yaml_unknown(r->yaml, at, "material model", name, CDEM_MATERIAL_MODEL_COUNT);
  return false;
}

static void read_parameter(const reading *r, const cdem_yaml_node *value,
                           const cdem_material_key *key, double *parameter) {
  char unit[48];
  if (!cdem_yaml_quantity(r->yaml, r->units, value, key->key, key->dimension, parameter))
    return;
  if (key->positive && !(*parameter > 0.0))
    cdem_yaml_error(r->yaml, value, "%s is %g %s and must be positive", key->key, *parameter,
                    cdem_dimension_unit(key->dimension, unit));
}

/* Names the keys of the model that are not there. */
static void report_missing(const reading *r, const cdem_yaml_node *mark,
                           const cdem_material_model_info *info, const bool *given) {
  char list[256] = "";
  size_t used = 0;
  for (int k = 0; k < info->keys; k++)
    if (!given[k] && !info->key[k].optional && used + 32 < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s'%s'", used > 0 ? ", " : "",
                               info->key[k].key);
  if (used > 0)
    cdem_yaml_error(r->yaml, mark, "a material of model %s needs %s", info->name, list);
}

void cdem_yaml_material(cdem_yaml *yaml, cdem_units *units, const cdem_yaml_node *map,
                        const cdem_yaml_node *mark, const char *const *others, int other_keys,
                        cdem_material *material) {
  const reading r = {yaml, units};
  if (map->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(yaml, map, "a material must be a map of keys and values, not %s",
                    cdem_yaml_kind_name(map->kind));
    return;
  }
  if (!read_model(&r, map, material))
    return;
  const cdem_material_model_info *info = cdem_material_model_get(material->model);
  bool given[CDEM_MATERIAL_PARAMETERS] = {false};
  const char *known[MAX_KEYS];
  int names = 0;
  for (; names < info->keys; names++) {
    known[names] = info->key[names].key;
    material->parameter[names] = info->key[names].fallback;
  }
  for (int i = 0; i < 3; i++)
    known[names++] = around[i];
  for (int i = 0; i < other_keys && names < MAX_KEYS; i++)
    known[names++] = others[i];
  CDEM_YAML_EACH(yaml, map, key, value) {
    int k = key->kind == CDEM_YAML_SCALAR ? parameter_of(info, key->text) : -1;
    if (k >= 0) {
      given[k] = true;
      read_parameter(&r, value, &info->key[k], &material->parameter[k]);
    } else if (key->kind == CDEM_YAML_SCALAR &&
               !is_one_of(key->text, known + info->keys, names - info->keys)) {
      cdem_yaml_unknown(yaml, key, "key", known, names);
    }
  }
  report_missing(&r, mark, info, given);
  read_axes(&r, map, material);
}
