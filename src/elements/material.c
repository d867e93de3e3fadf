/* Models and their keys: the one table from which files are read and help is printed. */
#include "elements/material.h"

#include <assert.h>
#include <string.h>

#define PRESSURE                                                                                   \
  { -1, -2, 1 }
#define FORCE                                                                                      \
  { 1, -2, 1 }
#define LENGTH                                                                                     \
  { 1, 0, 0 }
#define RATIO                                                                                      \
  { 0, 0, 0 }

static const cdem_material_key isotropic[] = {
    {"young", PRESSURE, false, 0, true, "Young's modulus"},
    {"poisson", RATIO, false, 0, false,
     "Poisson's ratio, -1 < poisson < 0.5, in plane stress -1 < poisson < 1"},
};

static const cdem_material_key orthotropic[] = {
    {"e1", PRESSURE, false, 0, true, "Young's modulus along axis 1"},
    {"e2", PRESSURE, false, 0, true, "Young's modulus along axis 2"},
    {"e3", PRESSURE, false, 0, true, "Young's modulus along axis 3"},
    {"nu12", RATIO, false, 0, false, "contraction along 2 by pull along 1; nu12/e1 = nu21/e2"},
    {"nu13", RATIO, false, 0, false, "contraction along 3 by pull along 1; nu13/e1 = nu31/e3"},
    {"nu23", RATIO, false, 0, false, "contraction along 3 by pull along 2; nu23/e2 = nu32/e3"},
    {"g12", PRESSURE, false, 0, true, "shear modulus in the plane of axes 1 and 2"},
    {"g13", PRESSURE, false, 0, true, "shear modulus in the plane of axes 1 and 3"},
    {"g23", PRESSURE, false, 0, true, "shear modulus in the plane of axes 2 and 3"},
};

#define STIFFNESS(row, column)                                                                     \
  {                                                                                                \
    "c" #row #column, PRESSURE, false, 0, row == column,                                           \
        "stiffness, row " #row ", column " #column " in the order xx yy zz yz xz xy"               \
  }
static const cdem_material_key anisotropic[] = {
    STIFFNESS(1, 1), STIFFNESS(1, 2), STIFFNESS(1, 3), STIFFNESS(1, 4), STIFFNESS(1, 5),
    STIFFNESS(1, 6), STIFFNESS(2, 2), STIFFNESS(2, 3), STIFFNESS(2, 4), STIFFNESS(2, 5),
    STIFFNESS(2, 6), STIFFNESS(3, 3), STIFFNESS(3, 4), STIFFNESS(3, 5), STIFFNESS(3, 6),
    STIFFNESS(4, 4), STIFFNESS(4, 5), STIFFNESS(4, 6), STIFFNESS(5, 5), STIFFNESS(5, 6),
    STIFFNESS(6, 6),
};

static const cdem_material_key cosserat[] = {
    {"young", PRESSURE, false, 0, true, "Young's modulus"},
    {"poisson", RATIO, false, 0, false,
     "Poisson's ratio, -1 < poisson < 0.5, in plane stress -1 < poisson < 1"},
    {"cosserat_modulus", PRESSURE, false, 0, true,
     "Gc: sigma_xy - sigma_yx = 2 Gc (eps_xy - eps_yx)"},
    {"characteristic_length", LENGTH, false, 0, true, "l of the couple modulus f G l^2"},
    {"couple_factor", RATIO, true, 1, true,
     "f of the couple modulus f G l^2: 1 Li & Wan, 2 de Borst, 4 literature on holes"},
};

static const cdem_material_key cosserat_cubic[] = {
    {"d11", PRESSURE, false, 0, true, "sigma_xx by eps_xx, and yy by yy"},
    {"d12", PRESSURE, false, 0, false, "sigma_xx by eps_yy; -d11 < d12 < d11"},
    {"d1212", PRESSURE, false, 0, true, "sigma_xy by eps_xy, and yx by yx"},
    {"d1221", PRESSURE, false, 0, false, "sigma_xy by eps_yx; -d1212 < d1221 < d1212"},
    {"couple_modulus", FORCE, false, 0, true, "m_x by kappa_x, and m_y by kappa_y"},
};

#define MODEL(name, keys, help)                                                                    \
  { name, (int)(sizeof(keys) / sizeof *(keys)), keys, help }
static const cdem_material_model_info models[CDEM_MATERIAL_MODEL_COUNT] = {
    [CDEM_ISOTROPIC] = MODEL("isotropic", isotropic, "linear elastic, the same in all directions"),
    [CDEM_ORTHOTROPIC] =
        MODEL("orthotropic", orthotropic, "linear elastic, three planes of symmetry"),
    [CDEM_ANISOTROPIC] =
        MODEL("anisotropic", anisotropic, "linear elastic, all 21 moduli, upper triangle"),
    [CDEM_COSSERAT] = MODEL("cosserat", cosserat, "plane Cosserat continuum, isotropic"),
    [CDEM_COSSERAT_CUBIC] =
        MODEL("cosserat-cubic", cosserat_cubic, "plane Cosserat continuum of a square lattice"),
};

const cdem_material_model_info *cdem_material_model_get(cdem_material_model model) {
  assert(model < CDEM_MATERIAL_MODEL_COUNT);
  return &models[model];
}

cdem_material_model cdem_material_model_find(const char *name) {
  int model = 0;
  while (model < CDEM_MATERIAL_MODEL_COUNT && strcmp(models[model].name, name) != 0)
    model++;
  return (cdem_material_model)model;
}

cdem_material cdem_material_isotropic(double young, double poisson) {
  return (cdem_material){.model = CDEM_ISOTROPIC, .parameter = {young, poisson}};
}

double cdem_material_length(const cdem_material *material) {
  const double *p = material->parameter;
  if (material->model == CDEM_COSSERAT) /* sqrt(f G l^2/G) */
    return sqrt(p[4]) * p[3];
  if (material->model == CDEM_COSSERAT_CUBIC) /* D1212 + D1221 = 2G */
    return sqrt(p[4] / (0.5 * (p[2] + p[3])));
  return 0.0;
}
