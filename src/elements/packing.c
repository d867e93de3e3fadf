/* Cosserat moduli of discs from the stiffness of their contacts; the derivations are in
 * docs/theory/cosserat.md, the equation numbers below are its own.
 *
 * Contacts are counted once. A disc is as thick as the section, and its stiffness in N/m is that of
 * the whole thickness, so moduli in Pa come with a factor 1/thickness, which the caller brings: the
 * numbers here are moduli times thickness. */
#include "elements/basis.h"

#include <math.h>
#include <string.h>

double cdem_material_value(const cdem_material *material, const char *key) {
  const cdem_material_model_info *info = cdem_material_model_get(material->model);
  int k = 0;
  while (strcmp(info->key[k].key, key) != 0)
    k++;
  return material->parameter[k];
}

/* Square lattice at 45 degrees, eqs. (10), (11): two contacts on 4 r^2. */
static void lattice(double kn, double ks, double rolling, double m[5]) {
  const double density = 0.5;
  m[0] = m[2] = density * (kn + ks);
  m[1] = m[3] = density * (kn - ks);
  m[4] = 2.0 * density * rolling;
}

void cdem_isotropic_numbers(double lambda, double shear, double spin, double couple, double m[5]) {
  m[0] = lambda + 2.0 * shear;
  m[1] = lambda;
  m[2] = shear + spin;
  m[3] = shear - spin;
  m[4] = couple;
}

void cdem_packing_printed(const cdem_material *material, cdem_packing_constants *c) {
  double kn = cdem_material_value(material, "normal_stiffness");
  double ks = cdem_material_value(material, "shear_stiffness");
  double density = cdem_material_value(material, "contact_density");
  double r = cdem_material_value(material, "radius");
  double l = cdem_material_value(material, "representative_length");
  double moment = 2.0 * l * l * ks +
                  r * r * cdem_material_value(material, "rolling_force_stiffness") +
                  cdem_material_value(material, "rolling_stiffness");
  c->shear = 0.5 * density * (2.0 * kn + 3.0 * ks); /* Li & Wan's eqs 21-24 */
  c->lambda = 0.5 * density * (kn - ks);
  c->spin = 2.0 / 3.0 * density * ks;
  c->length_squared = 4.0 / 3.0 * moment / (kn + ks);
}

void cdem_packing_numbers(const cdem_material *material, double m[5]) {
  double kn = cdem_material_value(material, "normal_stiffness");
  double ks = cdem_material_value(material, "shear_stiffness");
  double rolling = cdem_material_value(material, "rolling_stiffness");
  if (material->model == CDEM_COSSERAT_LATTICE) {
    lattice(kn, ks, rolling, m);
    return;
  }
  /* All directions alike, eqs. (12), (13). */
  double density = cdem_material_value(material, "contact_density");
  cdem_isotropic_numbers(0.5 * density * (kn - ks), 0.5 * density * (kn + ks), density * ks,
                         2.0 * density * rolling, m);
}
