/* Material files. The keys of each model, their dimensions and bounds come from the table in room
 * elements; this file knows only the words around them. */
#include "io/io.h"
#include "io/units.h"
#include "io/yaml_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_KEYS = CDEM_MATERIAL_PARAMETERS + 8 };

static const char *const around[] = {"model", "axis1", "axis2"};
static const char *const sections[] = {"materials", "groups", "default"};

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

/* What a file being read consists of. */
typedef struct {
  cdem_yaml yaml;
  cdem_units units;
  cdem_material_file *file;
} reading;

/* A quantity with a unit; the error stands at the value. */
static bool read_quantity(reading *r, const cdem_yaml_node *at, const char *key,
                          cdem_dimension dimension, double *value) {
  cdem_fault fault = {0};
  if (at->kind != CDEM_YAML_SCALAR) {
    cdem_yaml_error(&r->yaml, at, "'%s' must be a number, not %s", key,
                    cdem_yaml_kind_name(at->kind));
    return false;
  }
  if (cdem_units_parse(&r->units, at->text, dimension, value, &fault) == CDEM_OK)
    return true;
  cdem_yaml_error(&r->yaml, at, "%s: %s", key, fault.message);
  return false;
}

static bool read_axis(reading *r, const cdem_yaml_node *at, const char *key, double axis[3]) {
  const cdem_yaml_node *component = cdem_yaml_child(&r->yaml, at);
  if (at->kind != CDEM_YAML_LIST || at->children != 3) {
    cdem_yaml_error(&r->yaml, at, "'%s' must be a list of three numbers, such as [1, 0, 0]", key);
    return false;
  }
  for (int c = 0; c < 3; c++, component = cdem_yaml_next(&r->yaml, component))
    if (!read_quantity(r, component, key, CDEM_DIMENSIONLESS, &axis[c]))
      return false;
  return true;
}

/* Both axes or none, and they must span a plane. The bound, a sine of 1e-6, keeps ten digits of
 * the normal. */
static void read_axes(reading *r, const cdem_yaml_node *map, cdem_material *material) {
  const cdem_yaml_node *first = cdem_yaml_find(&r->yaml, map, "axis1");
  const cdem_yaml_node *second = cdem_yaml_find(&r->yaml, map, "axis2");
  if (first == NULL && second == NULL)
    return;
  if (material->model == CDEM_ISOTROPIC || material->model == CDEM_COSSERAT) {
    cdem_yaml_error(&r->yaml, first != NULL ? first : second,
                    "axes have no meaning for an isotropic material; leave them out");
    return;
  }
  if (first == NULL || second == NULL) {
    cdem_yaml_error(&r->yaml, first != NULL ? first : second, "'%s' is missing beside '%s'",
                    first != NULL ? "axis2" : "axis1", first != NULL ? "axis1" : "axis2");
    return;
  }
  if (!read_axis(r, first, "axis1", material->axis1) ||
      !read_axis(r, second, "axis2", material->axis2))
    return;
  double normal[3], size = cdem_norm3(material->axis1) * cdem_norm3(material->axis2);
  cdem_cross3(material->axis1, material->axis2, normal);
  if (!(cdem_norm3(normal) > 1e-6 * size))
    cdem_yaml_error(&r->yaml, second, "'axis1' and 'axis2' must not be zero or parallel");
  else
    material->rotated = true;
}

/* The model of a material, isotropic when it is not named; false after an error. */
static bool read_model(reading *r, const cdem_yaml_node *map, cdem_material *material) {
  const cdem_yaml_node *at = cdem_yaml_find(&r->yaml, map, "model");
  if (at == NULL)
    return true;
  if (at->kind != CDEM_YAML_SCALAR) {
    cdem_yaml_error(&r->yaml, at, "'model' must be a name, not %s", cdem_yaml_kind_name(at->kind));
    return false;
  }
  material->model = cdem_material_model_find(at->text);
  if (material->model < CDEM_MATERIAL_MODEL_COUNT)
    return true;
  const char *name[CDEM_MATERIAL_MODEL_COUNT];
  for (int m = 0; m < CDEM_MATERIAL_MODEL_COUNT; m++)
    name[m] = cdem_material_model_get((cdem_material_model)m)->name;
  cdem_yaml_unknown(&r->yaml, at, "material model", name, CDEM_MATERIAL_MODEL_COUNT);
  return false;
}

static void read_parameter(reading *r, const cdem_yaml_node *value, const cdem_material_key *key,
                           double *parameter) {
  char unit[48];
  if (!read_quantity(r, value, key->key, key->dimension, parameter))
    return;
  if (key->positive && !(*parameter > 0.0))
    cdem_yaml_error(&r->yaml, value, "%s is %g %s and must be positive", key->key, *parameter,
                    cdem_dimension_unit(key->dimension, unit));
}

/* Names the keys of the model that are not there. */
static void report_missing(reading *r, const cdem_yaml_node *mark,
                           const cdem_material_model_info *info, const bool *given) {
  char list[256] = "";
  size_t used = 0;
  for (int k = 0; k < info->keys; k++)
    if (!given[k] && !info->key[k].optional && used + 32 < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s'%s'", used > 0 ? ", " : "",
                               info->key[k].key);
  if (used > 0)
    cdem_yaml_error(&r->yaml, mark, "a material of model %s needs %s", info->name, list);
}

/* One material; mark: where it begins. */
static void read_material(reading *r, const cdem_yaml_node *map, const cdem_yaml_node *mark,
                          cdem_material *material) {
  if (map->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(&r->yaml, map, "a material must be a map of keys and values, not %s",
                    cdem_yaml_kind_name(map->kind));
    return;
  }
  if (!read_model(r, map, material))
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
  CDEM_YAML_EACH(&r->yaml, map, key, value) {
    int k = key->kind == CDEM_YAML_SCALAR ? parameter_of(info, key->text) : -1;
    if (k >= 0) {
      given[k] = true;
      read_parameter(r, value, &info->key[k], &material->parameter[k]);
    } else if (key->kind == CDEM_YAML_SCALAR && !is_one_of(key->text, around, 3)) {
      cdem_yaml_unknown(&r->yaml, key, "key", known, names);
    }
  }
  report_missing(r, mark, info, given);
  read_axes(r, map, material);
}

static void name_material(reading *r, const cdem_yaml_node *at, const char *name, size_t length,
                          cdem_material *material) {
  if (length >= sizeof material->name) {
    cdem_yaml_error(&r->yaml, at, "the name of a material has at most %zu letters",
                    sizeof material->name - 1);
    length = sizeof material->name - 1;
  }
  memcpy(material->name, name, length);
  material->name[length] = '\0';
}

/* The file's name without folder and ending names its only material. */
static void name_after_file(reading *r, cdem_material *material) {
  const char *slash = strrchr(r->yaml.path, '/'), *base = slash ? slash + 1 : r->yaml.path;
  const char *dot = strrchr(base, '.');
  size_t length = dot != NULL && dot != base ? (size_t)(dot - base) : strlen(base);
  if (length >= sizeof material->name)
    length = sizeof material->name - 1;
  name_material(r, NULL, base, length, material);
}

static cdem_status read_section_materials(reading *r, const cdem_yaml_node *map,
                                          cdem_fault *fault) {
  if (map->kind != CDEM_YAML_MAP || map->children == 0) {
    cdem_yaml_error(&r->yaml, map, "'materials' must be a map of names and materials");
    return CDEM_OK;
  }
  CDEM_NEW(r->file->material, map->children / 2, fault);
  CDEM_YAML_EACH(&r->yaml, map, key, value) {
    if (key->kind != CDEM_YAML_SCALAR)
      continue;
    cdem_material *material = &r->file->material[r->file->materials++];
    name_material(r, key, key->text, strlen(key->text), material);
    read_material(r, value, key, material);
  }
  return CDEM_OK;
}

/* The index of the material a value names, -1 after an error. */
static int find_material(reading *r, const cdem_yaml_node *at, cdem_fault *fault,
                         cdem_status *status) {
  const cdem_material_file *file = r->file;
  if (at->kind != CDEM_YAML_SCALAR) {
    cdem_yaml_error(&r->yaml, at, "the name of a material is expected, not %s",
                    cdem_yaml_kind_name(at->kind));
    return -1;
  }
  for (int m = 0; m < file->materials; m++)
    if (strcmp(file->material[m].name, at->text) == 0)
      return m;
  const char **name = cdem_allocate(file->materials, sizeof *name, fault);
  if (name == NULL) {
    *status = CDEM_MEMORY;
    return -1;
  }
  for (int m = 0; m < file->materials; m++)
    name[m] = file->material[m].name;
  cdem_yaml_unknown(&r->yaml, at, "material", name, file->materials);
  free(name);
  return -1;
}

static cdem_status read_section_groups(reading *r, const cdem_yaml_node *map, cdem_fault *fault) {
  cdem_status status = CDEM_OK;
  if (map->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(&r->yaml, map, "'groups' must be a map of groups and materials, not %s",
                    cdem_yaml_kind_name(map->kind));
    return CDEM_OK;
  }
  CDEM_NEW(r->file->group, map->children / 2, fault);
  CDEM_NEW(r->file->material_of, map->children / 2, fault);
  CDEM_YAML_EACH(&r->yaml, map, key, value) {
    if (key->kind != CDEM_YAML_SCALAR)
      continue;
    int at = r->file->assignments;
    r->file->material_of[at] = find_material(r, value, fault, &status);
    CDEM_TRY(status);
    r->file->group[at] = cdem_copy_text(key->text, fault);
    if (r->file->group[at] == NULL)
      return CDEM_MEMORY;
    r->file->assignments++;
  }
  return CDEM_OK;
}

static cdem_status read_several(reading *r, const cdem_yaml_node *root, cdem_fault *fault) {
  cdem_status status = CDEM_OK;
  CDEM_YAML_EACH(&r->yaml, root, key, value) {
    if (key->kind == CDEM_YAML_SCALAR && !is_one_of(key->text, sections, 3))
      cdem_yaml_unknown(&r->yaml, key, "key", sections, 3);
    (void)value;
  }
  const cdem_yaml_node *materials = cdem_yaml_find(&r->yaml, root, "materials");
  const cdem_yaml_node *groups = cdem_yaml_find(&r->yaml, root, "groups");
  const cdem_yaml_node *fallback = cdem_yaml_find(&r->yaml, root, "default");
  if (materials == NULL) {
    cdem_yaml_error(&r->yaml, root, "'materials' is missing: a map of names and materials");
    return CDEM_OK;
  }
  CDEM_TRY(read_section_materials(r, materials, fault));
  if (groups != NULL)
    CDEM_TRY(read_section_groups(r, groups, fault));
  if (fallback != NULL)
    r->file->default_material = find_material(r, fallback, fault, &status);
  CDEM_TRY(status);
  if (groups == NULL && fallback == NULL && r->file->materials > 1)
    cdem_yaml_error(&r->yaml, root,
                    "several materials need 'groups' or 'default' to say where they are");
  if (groups == NULL && fallback == NULL && r->file->materials == 1)
    r->file->default_material = 0;
  return CDEM_OK;
}

static cdem_status read_root(reading *r, cdem_fault *fault) {
  const cdem_yaml_node *root = cdem_yaml_root(&r->yaml);
  if (root->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(&r->yaml, root, "a material file is a map of keys and values, not %s",
                    cdem_yaml_kind_name(root->kind));
    return CDEM_OK;
  }
  for (int i = 0; i < 3; i++)
    if (cdem_yaml_find(&r->yaml, root, sections[i]) != NULL)
      return read_several(r, root, fault);
  CDEM_NEW(r->file->material, 1, fault);
  r->file->materials = 1;
  r->file->default_material = 0;
  name_after_file(r, &r->file->material[0]);
  read_material(r, root, root, &r->file->material[0]);
  return CDEM_OK;
}

cdem_status cdem_read_materials(const char *path, cdem_material_file *file, cdem_fault *fault) {
  cdem_material_file made = {.default_material = -1};
  reading r = {.file = &made};
  cdem_status status = cdem_yaml_read(path, &r.yaml, fault);
  if (status == CDEM_OK)
    status = read_root(&r, fault);
  if (status == CDEM_OK)
    status = cdem_yaml_finish(&r.yaml, fault);
  cdem_yaml_release(&r.yaml);
  cdem_units_release(&r.units);
  if (status == CDEM_OK)
    *file = made;
  else
    cdem_material_file_release(&made);
  return status;
}

void cdem_material_file_release(cdem_material_file *file) {
  for (int i = 0; i < file->assignments; i++)
    free(file->group[i]);
  free(file->group);
  free(file->material_of);
  free(file->material);
  *file = (cdem_material_file){.default_material = -1};
}
