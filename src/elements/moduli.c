/* From a material to its moduli: checks, rotation to its axes, plane sections. */
#include "elements/basis.h"

#include <assert.h>
#include <float.h>
#include <lapacke.h>
#include <string.h>

enum { V = 6 }; /* Voigt components: xx yy zz yz xz xy */
static const int voigt[V][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};

/* An eigenvalue below this part of the largest is rounding: such a matrix is not definite. */
#define DEFINITE_BOUND 1e-14

/* Bounds of single keys: finite, and positive where the table says so. */
static cdem_status check_keys(const cdem_material *material, cdem_fault *fault) {
  const cdem_material_model_info *info = cdem_material_model_get(material->model);
  for (int k = 0; k < info->keys; k++) {
    const cdem_material_key *key = &info->key[k];
    double v = material->parameter[k];
    char unit[48];
    cdem_dimension_unit(key->dimension, unit);
    const char *space = " ";
    if (strcmp(unit, "1") == 0)
      unit[0] = '\0', space = "";
    CDEM_REQUIRE(isfinite(v), fault, CDEM_INPUT, "%s = %g is not a finite number", key->key, v);
    CDEM_REQUIRE(!key->positive || v > 0.0, fault, CDEM_INPUT,
                 "%s = %.10g%s%s is out of range: it must be positive", key->key, v, space, unit);
  }
  return CDEM_OK;
}

/* body: "a solid", "plane strain" or "plane stress". */
static cdem_status check_poisson(double poisson, const char *body, double most, cdem_fault *fault) {
  CDEM_REQUIRE(poisson > -1.0 && poisson < most, fault, CDEM_INPUT,
               "poisson = %.10g is out of range: %s needs -1 < poisson < %g", poisson, body, most);
  return CDEM_OK;
}

static cdem_status check_plane_poisson(double poisson, cdem_plane plane, cdem_fault *fault) {
  return plane == CDEM_PLANE_STRESS ? check_poisson(poisson, "plane stress", 1.0, fault)
                                    : check_poisson(poisson, "plane strain", 0.5, fault);
}

/* Eigenvalues of a symmetric 6x6, least and largest. */
static cdem_status extremes(const double m[V * V], double *least, double *largest,
                            cdem_fault *fault) {
  double copy[V * V], eigenvalue[V];
  memcpy(copy, m, sizeof copy);
  lapack_int info = LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', V, copy, V, eigenvalue);
  CDEM_REQUIRE(info == 0, fault, CDEM_NUMERIC,
               "eigenvalues of the material's stiffness cannot be found (dsyev: %d)", (int)info);
  *least = eigenvalue[0];
  *largest = eigenvalue[V - 1];
  return CDEM_OK;
}

static void isotropic_stiffness(double young, double poisson, double c[V * V]) {
  double mu = 0.5 * young / (1.0 + poisson);
  double lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
  memset(c, 0, V * V * sizeof *c);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      c[V * i + j] = i == j ? lambda + 2.0 * mu : lambda;
    c[V * (i + 3) + i + 3] = mu;
  }
}

static cdem_status orthotropic_stiffness(const cdem_material *material, double c[V * V],
                                         cdem_fault *fault) {
  const double e[3] = {cdem_material_value(material, "e1"), cdem_material_value(material, "e2"),
                       cdem_material_value(material, "e3")};
  const double nu12 = cdem_material_value(material, "nu12"),
               nu13 = cdem_material_value(material, "nu13"),
               nu23 = cdem_material_value(material, "nu23");
  const double shear[3] = {cdem_material_value(material, "g23"),
                           cdem_material_value(material, "g13"),
                           cdem_material_value(material, "g12")};
  double compliance[V * V] = {0}, normal[9], inverse[9], least = 0.0, largest = 0.0;
  for (int i = 0; i < 3; i++) {
    normal[4 * i] = 1.0 / e[i];
    compliance[(V + 1) * (i + 3)] = 1.0 / shear[i];
  }
  normal[1] = normal[3] = -nu12 / e[0];
  normal[2] = normal[6] = -nu13 / e[0];
  normal[5] = normal[7] = -nu23 / e[1];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      compliance[V * i + j] = normal[3 * i + j];
  CDEM_TRY(extremes(compliance, &least, &largest, fault));
  CDEM_REQUIRE(least > DEFINITE_BOUND * largest, fault, CDEM_INPUT,
               "orthotropic material is not positive definite: the smallest eigenvalue of its "
               "compliance is %.6g 1/Pa; nu12, nu13, nu23 are too large for e1, e2, e3",
               least);
  cdem_inverse3(normal, inverse);
  memset(c, 0, V * V * sizeof *c);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      c[V * i + j] = 0.5 * (inverse[3 * i + j] + inverse[3 * j + i]);
    c[(V + 1) * (i + 3)] = shear[i];
  }
  return CDEM_OK;
}

static cdem_status anisotropic_stiffness(const cdem_material *material, double c[V * V],
                                         cdem_fault *fault) {
  double least = 0.0, largest = 0.0;
  for (int i = 0, k = 0; i < V; i++)
    for (int j = i; j < V; j++, k++)
      c[V * i + j] = c[V * j + i] = material->parameter[k];
  CDEM_TRY(extremes(c, &least, &largest, fault));
  CDEM_REQUIRE(least > DEFINITE_BOUND * largest, fault, CDEM_INPUT,
               "anisotropic material is not positive definite: the smallest eigenvalue of c11 .. "
               "c66 is %.6g Pa, it must be positive",
               least);
  return CDEM_OK;
}

/* r[3 i + p] = component i of the material's axis p, orthonormal, right-handed. */
static cdem_status axes(const cdem_material *material, double r[9], cdem_fault *fault) {
  const double *given[2] = {material->axis1, material->axis2};
  double unit[2][3];
  for (int p = 0; p < 2; p++) {
    double largest = fmax(fmax(fabs(given[p][0]), fabs(given[p][1])), fabs(given[p][2]));
    CDEM_REQUIRE(
        isfinite(given[p][0]) && isfinite(given[p][1]) && isfinite(given[p][2]) && largest > 0.0,
        fault, CDEM_INPUT, "axis%d = (%g, %g, %g) is no direction: it must be finite and not zero",
        p + 1, given[p][0], given[p][1], given[p][2]);
    for (int i = 0; i < 3; i++)
      unit[p][i] = given[p][i] / largest; /* first: squares must not overflow */
    double length = cdem_norm3(unit[p]);
    for (int i = 0; i < 3; i++)
      unit[p][i] /= length;
  }
  double normal[3], second[3];
  cdem_cross3(unit[0], unit[1], normal);
  double sine = cdem_norm3(normal);
  CDEM_REQUIRE(sine > 1e-6, fault, CDEM_INPUT,
               "axis1 and axis2 are parallel (sine of their angle %.3g, it must exceed 1e-6)",
               sine);
  for (int i = 0; i < 3; i++)
    normal[i] /= sine;
  cdem_cross3(normal, unit[0], second);
  for (int i = 0; i < 3; i++) {
    r[3 * i] = unit[0][i];
    r[3 * i + 1] = second[i];
    r[3 * i + 2] = normal[i];
  }
  return CDEM_OK;
}

/* C_ijkl <- r_ip r_jq r_kr r_ls C_pqrs, as M C M^T with the Bond matrix M that rotates stress. */
static void rotate(const double r[9], double c[V * V]) {
  double bond[V][V], half[V][V];
  for (int a = 0; a < V; a++)
    for (int b = 0; b < V; b++) {
      int i = voigt[a][0], j = voigt[a][1], k = voigt[b][0], l = voigt[b][1];
      bond[a][b] = r[3 * i + k] * r[3 * j + l];
      if (k != l)
        bond[a][b] += r[3 * i + l] * r[3 * j + k];
    }
  for (int a = 0; a < V; a++)
    for (int b = 0; b < V; b++) {
      half[a][b] = 0.0;
      for (int k = 0; k < V; k++)
        half[a][b] += bond[a][k] * c[V * k + b];
    }
  for (int a = 0; a < V; a++)
    for (int b = a; b < V; b++) {
      double sum = 0.0;
      for (int k = 0; k < V; k++)
        sum += half[a][k] * bond[b][k];
      c[V * a + b] = c[V * b + a] = sum;
    }
}

static cdem_status solid_moduli(const cdem_material *material, double c[V * V], cdem_fault *fault) {
  if (material->model == CDEM_ISOTROPIC) { /* the same in any axes */
    CDEM_TRY(check_poisson(cdem_material_value(material, "poisson"), "a solid", 0.5, fault));
    isotropic_stiffness(cdem_material_value(material, "young"),
                        cdem_material_value(material, "poisson"), c);
    return CDEM_OK;
  }
  if (material->model == CDEM_ORTHOTROPIC)
    CDEM_TRY(orthotropic_stiffness(material, c, fault));
  else
    CDEM_TRY(anisotropic_stiffness(material, c, fault));
  if (material->rotated) {
    double r[9] = {0};
    CDEM_TRY(axes(material, r, fault));
    rotate(r, c);
  }
  return CDEM_OK;
}

/* Plane stress: the strains that go with no stress out of the plane are eliminated,
 * D = C_pp - C_pq C_qq^-1 C_qp, p = (xx yy xy), q = (zz yz xz). C_qq is positive definite. */
static void condense(const double c[V * V], double d[9]) {
  static const int p[3] = {0, 1, 5}, q[3] = {2, 3, 4};
  double qq[9], inverse[9];
  for (int i = 0; i < 9; i++)
    qq[i] = c[V * q[i / 3] + q[i % 3]];
  cdem_inverse3(qq, inverse);
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++) {
      double sum = c[V * p[i] + p[j]];
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
          sum -= c[V * p[i] + q[k]] * inverse[3 * k + l] * c[V * q[l] + p[j]];
      d[3 * i + j] = d[3 * j + i] = sum;
    }
}

static cdem_status plane_moduli(const cdem_material *material, cdem_plane plane, double d[9],
                                cdem_fault *fault) {
  static const int p[3] = {0, 1, 5};
  double c[V * V];
  if (material->model == CDEM_ISOTROPIC)
    CDEM_TRY(check_plane_poisson(cdem_material_value(material, "poisson"), plane, fault));
  if (plane == CDEM_PLANE_STRESS && material->model == CDEM_ISOTROPIC) {
    /* written out, because it reaches beyond 1/2, where no solid is left to condense */
    double young = cdem_material_value(material, "young"),
           poisson = cdem_material_value(material, "poisson");
    double factor = young / ((1.0 - poisson) * (1.0 + poisson));
    memset(d, 0, 9 * sizeof *d);
    d[0] = d[4] = factor;
    d[1] = d[3] = factor * poisson;
    d[8] = 0.5 * young / (1.0 + poisson);
    return CDEM_OK;
  }
  CDEM_TRY(solid_moduli(material, c, fault));
  if (plane == CDEM_PLANE_STRESS)
    condense(c, d);
  for (int i = 0; plane == CDEM_PLANE_STRAIN && i < 9; i++)
    d[i] = c[V * p[i / 3] + p[i % 3]];
  return CDEM_OK;
}

static cdem_status cubic_numbers(const cdem_material *material, double m[5], cdem_fault *fault) {
  memcpy(m, material->parameter, 5 * sizeof *m);
  CDEM_REQUIRE(fabs(m[1]) < m[0], fault, CDEM_INPUT,
               "d12 = %.10g Pa is out of range: a stable body needs -d11 < d12 < d11 = %.10g Pa",
               m[1], m[0]);
  CDEM_REQUIRE(fabs(m[3]) < m[2], fault, CDEM_INPUT,
               "d1221 = %.10g Pa is out of range: a stable body needs -d1212 < d1221 < d1212 = "
               "%.10g Pa",
               m[3], m[2]);
  return CDEM_OK;
}

static cdem_status isotropic_cosserat_numbers(const cdem_material *material, cdem_plane plane,
                                              double m[5], cdem_fault *fault) {
  double poisson = cdem_material_value(material, "poisson"),
         length = cdem_material_value(material, "characteristic_length");
  bool stress = plane == CDEM_PLANE_STRESS;
  CDEM_TRY(check_plane_poisson(poisson, plane, fault));
  double shear = 0.5 * cdem_material_value(material, "young") / (1.0 + poisson);
  double lambda = 2.0 * shear * poisson / (stress ? 1.0 - poisson : 1.0 - 2.0 * poisson);
  double factor = cdem_material_value(material, "couple_factor");
  cdem_isotropic_numbers(lambda, shear, cdem_material_value(material, "cosserat_modulus"),
                         factor * shear * length * length, m);
  return CDEM_OK;
}

/* Discs as thick as the section. The printed moduli have a lambda of space, the others one of the
 * plane. */
static cdem_status packing_numbers(const cdem_material *material, const cdem_section *section,
                                   double m[5], cdem_fault *fault) {
  double thickness = 1.0;
  CDEM_TRY(cdem_formulation_thickness(CDEM_PLANE_COSSERAT, section, &thickness, fault));
  if (material->model == CDEM_COSSERAT_PRINTED) {
    double force = cdem_material_value(material, "rolling_force_stiffness");
    CDEM_REQUIRE(force >= 0.0, fault, CDEM_INPUT,
                 "rolling_force_stiffness = %.10g N/m is out of range: it must not be negative",
                 force);
    cdem_packing_constants c;
    cdem_packing_printed(material, &c);
    if (section->plane == CDEM_PLANE_STRESS)
      c.lambda *= 2.0 * c.shear / (c.lambda + 2.0 * c.shear);
    cdem_isotropic_numbers(c.lambda, c.shear, c.spin, c.shear * c.length_squared, m);
  } else
    cdem_packing_numbers(material, m);
  for (int i = 0; i < 5; i++)
    m[i] /= thickness;
  return CDEM_OK;
}

/* The five numbers D11 D12 D1212 D1221 Dm. */
static cdem_status cosserat_numbers(const cdem_material *material, const cdem_section *section,
                                    double m[5], cdem_fault *fault) {
  const cdem_material_model_info *info = cdem_material_model_get(material->model);
  CDEM_REQUIRE(info->isotropic || !material->rotated, fault, CDEM_INPUT,
               "axis1 and axis2 are not for %s: its axes are x and y", info->name);
  if (material->model == CDEM_COSSERAT)
    return isotropic_cosserat_numbers(material, section->plane, m, fault);
  if (material->model == CDEM_COSSERAT_CUBIC)
    return cubic_numbers(material, m, fault);
  return packing_numbers(material, section, m, fault);
}

static cdem_status cosserat_moduli(const cdem_material *material, const cdem_section *section,
                                   double d[V * V], cdem_fault *fault) {
  double m[5] = {0};
  CDEM_TRY(cosserat_numbers(material, section, m, fault));
  memset(d, 0, V * V * sizeof *d);
  for (int i = 0; i < 2; i++) {
    d[(V + 1) * i] = m[0];
    d[V * i + 1 - i] = m[1];
    d[(V + 1) * (i + 2)] = m[2];
    d[V * (i + 2) + 3 - i] = m[3];
    d[(V + 1) * (i + 4)] = m[4];
  }
  return CDEM_OK;
}

/* Any of the three kinds; *rows of d. */
static cdem_status moduli(const cdem_material *material, cdem_moduli_kind kind,
                          const cdem_section *section, double d[36], int *rows, cdem_fault *fault) {
  CDEM_TRY(check_keys(material, fault));
  const char *model = cdem_material_model_get(material->model)->name;
  bool cosserat = cdem_material_is_cosserat(material);
  CDEM_REQUIRE(!cosserat || kind == CDEM_MODULI_PLANE_COSSERAT, fault, CDEM_INPUT,
               "a %s material fits Cosserat elements only (2-D cells: tri3, quad4), not %s", model,
               kind == CDEM_MODULI_SOLID ? "a solid" : "a classical plane");
  CDEM_REQUIRE(cosserat || kind != CDEM_MODULI_PLANE_COSSERAT, fault, CDEM_INPUT,
               "%s %s material has no couple stresses and does not fit Cosserat elements; use "
               "cosserat or cosserat-cubic",
               strchr("aio", model[0]) ? "an" : "a", model);
  *rows = kind == CDEM_MODULI_PLANE ? 3 : 6;
  if (kind == CDEM_MODULI_SOLID)
    return solid_moduli(material, d, fault);
  CDEM_REQUIRE(section != NULL, fault, CDEM_USAGE,
               "a plane body needs a section: plane strain or plane stress, and a thickness");
  return kind == CDEM_MODULI_PLANE ? plane_moduli(material, section->plane, d, fault)
                                   : cosserat_moduli(material, section, d, fault);
}

cdem_status cdem_material_moduli(const cdem_material *material, cdem_moduli_kind kind,
                                 const cdem_section *section, double d[36], int *rows,
                                 cdem_fault *fault) {
  double result[36] = {0};
  int count = 0;
  cdem_status status = moduli(material, kind, section, result, &count, fault);
  for (int i = 0; status == CDEM_OK && i < count * count; i++)
    if (!isfinite(result[i])) /* values near the limits of double, or a ratio next to its bound */
      status =
          cdem_fail(fault, CDEM_INPUT,
                    "moduli overflow: bring the material's values into a range a body can have");
  if (status != CDEM_OK) {
    if (material->name[0] != '\0')
      cdem_fault_prefix(fault, "material '%s'", material->name);
    return status;
  }
  memcpy(d, result, sizeof(double) * (size_t)(count * count));
  *rows = count;
  return CDEM_OK;
}
