/* Checks of the mesh, the materials, blocks and interfaces. */
#include "cases/check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- mesh ---- */

enum { FIRST_SOLID = 3 }; /* among the choices of mesh.shape: none tri3 quad4 tet4 ... */

static cdem_status check_grid(const cdem_case *cases, cdem_fault *fault) {
  static const char *const file_only[] = {"mesh.parameters", "mesh.unit"};
  const cdem_case_mesh *mesh = &cases->values.mesh;
  int directions = mesh->shape >= FIRST_SOLID ? 3 : 2;
  char key[CDEM_CASE_PATH];
  for (int k = 0; k < 2; k++)
    if (cdem_case_given(cases, file_only[k]))
      return cdem_case_fail(cases, file_only[k], CDEM_INPUT, fault,
                            "'%s' belongs to a mesh file and has no meaning for a grid; leave it "
                            "out",
                            file_only[k]);
  for (int i = 0; i < directions; i++) {
    snprintf(key, sizeof key, "mesh.count[%d]", i);
    if (!(mesh->count[i] >= 1.0 && mesh->count[i] <= 1e6 &&
          mesh->count[i] == floor(mesh->count[i])))
      return cdem_case_fail(
          cases, key, CDEM_INPUT, fault,
          "a grid of this shape needs %d whole numbers of bricks in 'count', from "
          "1 to 1e6; number %d is %g",
          directions, i + 1, mesh->count[i]);
    snprintf(key, sizeof key, "mesh.size[%d]", i);
    if (!(mesh->size[i] > 0.0))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "a grid of this shape needs %d lengths in 'size'; number %d is %g m",
                            directions, i + 1, mesh->size[i]);
  }
  return CDEM_OK;
}

cdem_status cdem_case_check_mesh(const cdem_case *cases, cdem_fault *fault) {
  static const char *const grid_only[] = {"count", "size", "origin", "distortion", "seed"};
  const cdem_case_mesh *mesh = &cases->values.mesh;
  if (mesh->file != NULL && mesh->shape != 0)
    return cdem_case_fail(cases, "mesh.shape", CDEM_INPUT, fault,
                          "a mesh is a file or a grid, not both; leave out 'file' or 'shape'");
  if (mesh->file == NULL && mesh->shape == 0)
    return cdem_case_fail(cases, "mesh", CDEM_INPUT, fault,
                          "a mesh needs 'file', or 'shape', 'count' and 'size' of a grid");
  if (mesh->shape != 0)
    return check_grid(cases, fault);
  for (int k = 0; k < 5; k++) {
    char key[CDEM_CASE_PATH];
    cdem_case_named_key(key, "mesh", grid_only[k], "");
    if (cdem_case_given(cases, key))
      return cdem_case_fail(
          cases, key, CDEM_INPUT, fault,
          "'%s' belongs to a grid and has no meaning for a mesh file; leave it out", key);
  }
  return CDEM_OK;
}

/* ---- materials ---- */

static bool has_gravity(const cdem_case_values *v) {
  return v->gravity[0] != 0.0 || v->gravity[1] != 0.0 || v->gravity[2] != 0.0;
}

static cdem_status check_density(const cdem_case *cases, const cdem_case_material *material,
                                 cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  char key[CDEM_CASE_PATH];
  if (!isnan(material->density) || (v->analysis == CDEM_ANALYSIS_STATIC && !has_gravity(v)))
    return CDEM_OK;
  return cdem_case_fail(cases, cdem_case_named_key(key, "materials", material->name, ""),
                        CDEM_INPUT, fault, "material '%s' needs 'density': %s", material->name,
                        v->analysis == CDEM_ANALYSIS_STATIC ? "there is gravity"
                                                            : "the run moves masses");
}

/* The law opens along principal directions that moduli and strain share; cubic ones of a plane are
 * solved for. */
static cdem_status check_tension(const cdem_case *cases, const cdem_case_material *material,
                                 cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  cdem_material_model model = material->material.model;
  if (material->tension != CDEM_CASE_TENSION_NONE)
    return CDEM_OK;
  cdem_case_named_key(key, "materials", material->name, "tension");
  if (model == CDEM_ORTHOTROPIC || model == CDEM_ANISOTROPIC)
    return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                          "a material without tension wants isotropic moduli, and '%s' is %s; give "
                          "it 'young' and 'poisson', or 'tension: elastic'",
                          material->name, cdem_material_model_get(model)->name);
  if (cases->values.analysis == CDEM_ANALYSIS_STATIC)
    return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                          "a static run is linear, and a material without tension is not; take "
                          "'analysis: relaxation'");
  return CDEM_OK;
}

/* One material may have no groups, and no group may have two materials. */
static cdem_status check_groups(const cdem_case *cases, int64_t m, cdem_fault *fault) {
  const cdem_case_material *all = cases->values.materials.item, *material = &all[m];
  char key[CDEM_CASE_PATH];
  for (int64_t e = 0; e < m; e++) {
    if (material->groups.count == 0 && all[e].groups.count == 0)
      return cdem_case_fail(cases, cdem_case_named_key(key, "materials", material->name, ""),
                            CDEM_INPUT, fault,
                            "materials '%s' and '%s' both have no 'groups'; only one can be "
                            "wherever no other is",
                            all[e].name, material->name);
    for (int64_t g = 0; g < material->groups.count; g++)
      for (int64_t h = 0; h < all[e].groups.count; h++)
        if (strcmp(material->groups.item[g], all[e].groups.item[h]) == 0)
          return cdem_case_fail(
              cases, cdem_case_named_key(key, "materials", material->name, "groups"), CDEM_INPUT,
              fault, "group '%s' has material '%s' already", material->groups.item[g], all[e].name);
  }
  return CDEM_OK;
}

cdem_status cdem_case_check_materials(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  char key[CDEM_CASE_PATH];
  if (v->materials.count == 0)
    return cdem_case_fail(cases, "materials", CDEM_INPUT, fault, "a case needs a material");
  bool cosserat = cdem_material_is_cosserat(&v->materials.item[0].material);
  for (int64_t m = 0; m < v->materials.count; m++) {
    const cdem_case_material *material = &v->materials.item[m];
    CDEM_TRY(check_density(cases, material, fault));
    CDEM_TRY(check_groups(cases, m, fault));
    CDEM_TRY(check_tension(cases, material, fault));
    if (cdem_material_is_cosserat(&material->material) != cosserat)
      return cdem_case_fail(cases, cdem_case_named_key(key, "materials", material->name, "model"),
                            CDEM_INPUT, fault,
                            "Cosserat and other materials cannot be in one case: '%s' is %s, '%s' "
                            "is %s",
                            v->materials.item[0].name, cosserat ? "Cosserat" : "not",
                            material->name, cosserat ? "not" : "Cosserat");
    if (!cosserat && !isnan(material->micro_inertia))
      return cdem_case_fail(
          cases, cdem_case_named_key(key, "materials", material->name, "micro_inertia"), CDEM_INPUT,
          fault, "'micro_inertia' belongs to Cosserat materials; leave it out");
  }
  return CDEM_OK;
}

/* ---- interfaces ---- */

/* Energy for a strength that softens; the springs must be able to release no more than they store:
 * k >= strength^2/(2 energy). */
static cdem_status check_softening(const cdem_case *cases, int64_t i, int mode, cdem_fault *fault) {
  const cdem_case_interface *law = &cases->values.interfaces.item[i];
  const char *strength_name = mode == 1 ? "tension" : "cohesion";
  const char *energy_name = mode == 1 ? "energy_1" : "energy_2";
  const char *stiffness_name = mode == 1 ? "normal_stiffness" : "shear_stiffness";
  double strength = mode == 1 ? law->tension : law->cohesion;
  double energy = mode == 1 ? law->energy_1 : law->energy_2;
  double stiffness = mode == 1 ? law->normal_stiffness : law->shear_stiffness;
  char key[CDEM_CASE_PATH];
  bool linear = law->softening == 1;
  if (!linear && !isnan(energy))
    return cdem_case_fail(cases, cdem_case_item_key(key, "interfaces", i, energy_name), CDEM_INPUT,
                          fault, "'%s' is used by linear softening only; add 'softening: linear'",
                          energy_name);
  if (linear && strength > 0.0 && isnan(energy))
    return cdem_case_fail(cases, cdem_case_item_key(key, "interfaces", i, "softening"), CDEM_INPUT,
                          fault, "linear softening with '%s' needs '%s'", strength_name,
                          energy_name);
  double least = strength * strength / (2.0 * energy);
  if (linear && stiffness < least) /* false for NaN */
    return cdem_case_fail(cases, cdem_case_item_key(key, "interfaces", i, stiffness_name),
                          CDEM_INPUT, fault,
                          "%s is %g Pa/m and must be at least %s^2/(2 %s) = %g Pa/m: the interface "
                          "would snap back",
                          stiffness_name, stiffness, strength_name, energy_name, least);
  return CDEM_OK;
}

static cdem_status check_interface(const cdem_case *cases, int64_t i, cdem_fault *fault) {
  const cdem_case_interface *law = &cases->values.interfaces.item[i];
  char prefix[CDEM_CASE_PATH], key[CDEM_CASE_PATH];
  cdem_case_item_key(prefix, "interfaces", i, "");
  CDEM_TRY(cdem_case_check_exclusive(cases, prefix, "between", "joint", fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, prefix, "stiffness_factor", "normal_stiffness", fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, prefix, "shear_ratio", "shear_stiffness", fault));
  if (law->between.count != 0 && law->between.count != 2)
    return cdem_case_fail(cases, cdem_case_item_key(key, "interfaces", i, "between"), CDEM_INPUT,
                          fault,
                          "'between' must name two groups, not %d; [a, a] means inside group a",
                          (int)law->between.count);
  if (law->dilation > law->friction)
    return cdem_case_fail(cases, cdem_case_item_key(key, "interfaces", i, "dilation"), CDEM_INPUT,
                          fault,
                          "dilation is %g and must be at most the friction, %g: sliding would "
                          "produce energy",
                          law->dilation, law->friction);
  CDEM_TRY(check_softening(cases, i, 1, fault));
  return check_softening(cases, i, 2, fault);
}

cdem_status cdem_case_check_interfaces(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  if (v->interfaces.count > 0 && v->blocks.breakable.count == 0 && v->blocks.separate.count == 0 &&
      v->blocks.joints.count == 0)
    return cdem_case_fail(cases, "interfaces", CDEM_INPUT, fault,
                          "interfaces need 'blocks' that say where the mesh may come apart: "
                          "breakable, separate or joints");
  for (int64_t i = 0; i < v->interfaces.count; i++)
    CDEM_TRY(check_interface(cases, i, fault));
  return CDEM_OK;
}
