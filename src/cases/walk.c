/* Finding keys, and all of them in one walk. */
#include "cases/places.h"
#include "cases/tables.h"

#include <stdio.h>
#include <string.h>

const cdem_case_key *cdem_case_key_find(const cdem_case_section *section, const char *key) {
  for (int k = 0; k < section->keys; k++)
    if (strcmp(section->key[k].key, key) == 0)
      return &section->key[k];
  return NULL;
}

typedef struct {
  void (*visit)(void *context, const char *path, const cdem_case_key *key);
  void *context;
} walker;

static const char *const model_names[CDEM_MATERIAL_MODEL_COUNT + 1] = {
    [CDEM_ISOTROPIC] = "isotropic",
    [CDEM_ORTHOTROPIC] = "orthotropic",
    [CDEM_ANISOTROPIC] = "anisotropic",
    [CDEM_COSSERAT] = "cosserat",
    [CDEM_COSSERAT_CUBIC] = "cosserat-cubic",
    [CDEM_COSSERAT_LATTICE] = "cosserat-lattice",
    [CDEM_COSSERAT_AVERAGE] = "cosserat-average",
    [CDEM_COSSERAT_PRINTED] = "cosserat-printed"};

static void visit_at(const walker *walk, const char *prefix, const cdem_case_key *key) {
  char path[CDEM_CASE_PATH];
  snprintf(path, sizeof path, "%s.%s", prefix, key->key);
  walk->visit(walk->context, path, key);
}

static bool met_before(int model, const char *key) {
  for (int m = 0; m < model; m++) {
    const cdem_material_model_info *info = cdem_material_model_get((cdem_material_model)m);
    for (int k = 0; k < info->keys; k++)
      if (strcmp(info->key[k].key, key) == 0)
        return true;
  }
  return false;
}

static const char *example_of(cdem_dimension dimension) {
  if (dimension.mass == 0)
    return dimension.length == 0 ? "0.25" : "2 mm";
  static const char *const by_length[] = {[0] = "250 MN/m", [1] = "40 kN", [2] = "700 N m"};
  return dimension.length < 0 ? "30 GPa" : by_length[dimension.length];
}

/* The keys that CDEM_KEY_MATERIAL stands for, from the table of models. */
static void walk_material(const walker *walk, const char *prefix) {
  static const cdem_case_key around[] = {
      {.key = "model",
       .kind = CDEM_KEY_CHOICE,
       .choice = model_names,
       .help = "Elastic model; each has moduli of its own.",
       .example = "orthotropic"},
      {.key = "axis1",
       .kind = CDEM_KEY_VECTOR,
       .length = 3,
       .fewest = 3,
       .otherwise = "x",
       .help = "Material axis 1 of a model with directions, beside axis2.",
       .example = "[1, 1, 0]"},
      {.key = "axis2",
       .kind = CDEM_KEY_VECTOR,
       .length = 3,
       .fewest = 3,
       .otherwise = "y",
       .help = "Direction that spans the plane of axes 1 and 2 together with axis1.",
       .example = "[-1, 1, 0]"}};
  for (int i = 0; i < 3; i++)
    visit_at(walk, prefix, &around[i]);
  for (int m = 0; m < CDEM_MATERIAL_MODEL_COUNT; m++) {
    const cdem_material_model_info *info = cdem_material_model_get((cdem_material_model)m);
    for (int k = 0; k < info->keys; k++) {
      const cdem_material_key *from = &info->key[k];
      bool plain = from->dimension.length == 0 && from->dimension.time == 0;
      cdem_case_key key = {.key = from->key,
                           .kind = CDEM_KEY_NUMBER,
                           .dimension = from->dimension,
                           .fallback = from->optional ? from->fallback : NAN,
                           .most = from->positive ? INFINITY : 0.0,
                           .above = from->positive,
                           .tag = plain ? CDEM_TAG_NONE : CDEM_TAG_LAW,
                           .otherwise = from->optional ? NULL : "required by its models",
                           .help = from->help,
                           .example = example_of(from->dimension)};
      if (!met_before(m, from->key))
        visit_at(walk, prefix, &key);
    }
  }
}

static void walk_section(const walker *walk, const char *prefix, const cdem_case_section *section) {
  for (int k = 0; k < section->keys; k++) {
    const cdem_case_key *key = &section->key[k];
    char path[CDEM_CASE_PATH];
    if (key->kind == CDEM_KEY_MATERIAL) {
      walk_material(walk, prefix);
      continue;
    }
    snprintf(path, sizeof path, "%s%s%s", prefix, *prefix != '\0' ? "." : "", key->key);
    walk->visit(walk->context, path, key);
    if (key->section == NULL)
      continue;
    const char *of = key->kind == CDEM_KEY_NAMED ? ".NAME" : key->kind == CDEM_KEY_LIST ? "[]" : "";
    size_t used = strlen(path);
    snprintf(path + used, sizeof path - used, "%s", of);
    walk_section(walk, path, key->section);
  }
}

void cdem_case_walk(void (*visit)(void *context, const char *path, const cdem_case_key *key),
                    void *context) {
  const walker walk = {visit, context};
  walk_section(&walk, "", cdem_case_root());
}

/* ---- what a case gives ---- */

/* The layout that all CDEM_CASE_LIST share. */
typedef CDEM_CASE_LIST(void) any_list;

typedef struct {
  const cdem_case *cases;
  void (*visit)(void *context, const char *path, const cdem_case_section *section);
  void *context;
} given_walker;

static void walk_given(const given_walker *walk, const char *path, const void *values,
                       const cdem_case_section *section);

static void walk_items(const given_walker *walk, const char *path, const void *member,
                       const cdem_case_key *key) {
  any_list list;
  memcpy(&list, member, sizeof list);
  for (int64_t i = 0; i < list.count; i++) {
    char of[CDEM_CASE_PATH];
    const char *name, *item = (const char *)list.item + (size_t)i * key->section->size;
    memcpy(&name, item, sizeof name); /* of a named one; else not looked at */
    if (key->kind == CDEM_KEY_NAMED)
      snprintf(of, sizeof of, "%.160s.%.64s", path, name);
    else
      snprintf(of, sizeof of, "%.200s[%lld]", path, (long long)i);
    walk_given(walk, of, item, key->section);
  }
}

static void walk_given(const given_walker *walk, const char *path, const void *values,
                       const cdem_case_section *section) {
  walk->visit(walk->context, path, section);
  for (int k = 0; k < section->keys; k++) {
    const cdem_case_key *key = &section->key[k];
    const char *member = (const char *)values + key->offset;
    char of[CDEM_CASE_PATH];
    snprintf(of, sizeof of, "%.190s%s%.60s", path, *path != '\0' ? "." : "", key->key);
    if (key->section == NULL || !cdem_case_given(walk->cases, of))
      continue;
    if (key->kind == CDEM_KEY_SECTION)
      walk_given(walk, of, member, key->section);
    else
      walk_items(walk, of, member, key);
  }
}

void cdem_case_walk_given(const cdem_case *cases,
                          void (*visit)(void *context, const char *path,
                                        const cdem_case_section *section),
                          void *context) {
  const given_walker walk = {cases, visit, context};
  walk_given(&walk, "", &cases->values, cdem_case_root());
}
