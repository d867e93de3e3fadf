/* Models and their keys: the one table from which files are read and help is printed. */
#include "elements/basis.h"

#include <assert.h>
#include <string.h>

#define PRESSURE                                                                                   \
  { -1, -2, 1 }
#define FORCE                                                                                      \
  { 1, -2, 1 }
#define STIFFNESS_OF_CONTACT                                                                       \
  { 0, -2, 1 }
#define MOMENT                                                                                     \
  { 2, -2, 1 }
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

/* The words of the contact laws (dem/law_keys.def), the first four of every packing. */
#define CONTACTS                                                                                   \
  {"normal_stiffness", STIFFNESS_OF_CONTACT, false, 0, true, "force per overlap of two discs"},    \
      {"shear_stiffness", STIFFNESS_OF_CONTACT, false, 0, true, "force per sliding way"},          \
      {"rolling_stiffness", MOMENT, false, 0, true, "moment per relative rotation"}, {             \
    "radius", LENGTH, false, 0, true,                                                              \
        "of the discs, of several sizes sqrt(sum r^4/sum r^2): micro-inertia r^2/2 per mass"       \
  }
#define CONTACT_DENSITY                                                                            \
  {                                                                                                \
    "contact_density", RATIO, false, 0, true,                                                      \
        "N r^2/area, contacts counted once: coordination number * solid fraction/(2 pi)"           \
  }
static const cdem_material_key cosserat_lattice[] = {CONTACTS};
static const cdem_material_key cosserat_average[] = {CONTACTS, CONTACT_DENSITY};
static const cdem_material_key cosserat_printed[] = {
    CONTACTS,
    CONTACT_DENSITY,
    {"rolling_force_stiffness", STIFFNESS_OF_CONTACT, true, 0, false, "k_r of eq 24, not negative"},
    {"representative_length", LENGTH, false, 0, true, "L of eq 24"},
};

#define MODEL(name, keys, isotropic, help)                                                         \
  { name, (int)(sizeof(keys) / sizeof *(keys)), keys, isotropic, help }
static const cdem_material_model_info models[CDEM_MATERIAL_MODEL_COUNT] = {
    [CDEM_ISOTROPIC] =
        MODEL("isotropic", isotropic, true, "linear elastic, the same in all directions"),
    [CDEM_ORTHOTROPIC] =
        MODEL("orthotropic", orthotropic, false, "linear elastic, three planes of symmetry"),
    [CDEM_ANISOTROPIC] =
        MODEL("anisotropic", anisotropic, false, "linear elastic, all 21 moduli, upper triangle"),
    [CDEM_COSSERAT] = MODEL("cosserat", cosserat, true, "plane Cosserat continuum, isotropic"),
    [CDEM_COSSERAT_CUBIC] = MODEL("cosserat-cubic", cosserat_cubic, false,
                                  "plane Cosserat continuum of a square lattice"),
    [CDEM_COSSERAT_LATTICE] = MODEL("cosserat-lattice", cosserat_lattice, false,
                                    "discs in the square lattice at 45 degrees, from contacts"),
    [CDEM_COSSERAT_AVERAGE] =
        MODEL("cosserat-average", cosserat_average, true,
              "discs with contacts in all directions alike, two-dimensional average"),
    [CDEM_COSSERAT_PRINTED] =
        MODEL("cosserat-printed", cosserat_printed, true,
              "Li & Wan's eqs 21-24 as printed; eq 21 is the three-dimensional pattern"),
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
  if (material->model == CDEM_COSSERAT_PRINTED) {
    cdem_packing_constants c;
    cdem_packing_printed(material, &c);
    return sqrt(c.length_squared);
  }
  if (!cdem_material_is_cosserat(material))
    return 0.0;
  double m[5]; /* the thickness is in both and cancels */
  cdem_packing_numbers(material, m);
  return sqrt(m[4] / (0.5 * (m[2] + m[3])));
}

double cdem_material_micro_inertia(const cdem_material *material) {
  double length = cdem_material_length(material);
  if (material->model >= CDEM_COSSERAT_LATTICE && cdem_material_is_cosserat(material))
    length = sqrt(0.5) * cdem_material_value(material, "radius");
  return length * length;
}
