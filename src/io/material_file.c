/* Material files: which materials there are and where they hold. */
#include "io/io.h"
#include "io/material_read.h"

#include <stdlib.h>
#include <string.h>

static const char *const sections[] = {"materials", "groups", "default"};

static bool is_one_of(const char *word, const char *const *list, int count) {
  for (int i = 0; i < count; i++)
    if (strcmp(word, list[i]) == 0)
      return true;
  return false;
}

/* What a file being read consists of. */
typedef struct {
  cdem_yaml yaml;
  cdem_units units;
  cdem_material_file *file;
} reading;

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
    cdem_yaml_material(&r->yaml, &r->units, value, key, NULL, 0, material);
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
  cdem_yaml_material(&r->yaml, &r->units, root, root, NULL, 0, &r->file->material[0]);
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
