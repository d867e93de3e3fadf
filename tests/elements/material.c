/* Room elements: moduli against their closed forms and independent derivations; every refusal. */
#include "elements/specimens.h"

#include <lapacke.h>

static double d[36];
static int rows;

static void solid(const cdem_material *material) {
  cdem_fault fault = {0};
  check_ok(cdem_material_moduli(material, CDEM_MODULI_SOLID, NULL, d, &rows, &fault));
  assert_int_equal(rows, 6);
}
static void plane(const cdem_material *material, cdem_plane which) {
  cdem_fault fault = {0};
  const cdem_section section = {which, 1.0};
  check_ok(cdem_material_moduli(material, CDEM_MODULI_PLANE, &section, d, &rows, &fault));
  assert_int_equal(rows, 3);
}

static void isotropic_moduli(void **state) {
  (void)state;
  for (double nu = -0.95; nu < 0.5; nu += 0.1) {
    cdem_material m = cdem_material_isotropic(7.0, nu);
    double lambda = 7.0 * nu / ((1 + nu) * (1 - 2 * nu)), mu = 3.5 / (1 + nu);
    double expected[36] = {0};
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++)
        expected[6 * i + j] = lambda + (i == j ? 2 * mu : 0);
      expected[7 * (i + 3)] = mu;
    }
    solid(&m);
    check_same(d, expected, 36, 1e-14 * (fabs(lambda) + 2 * mu), "isotropic");
  }
}

static void inverse(const double *m, int n, double *out) {
  lapack_int pivot[6];
  memcpy(out, m, sizeof(double) * (size_t)(n * n));
  assert_int_equal(LAPACKE_dgetrf(LAPACK_ROW_MAJOR, n, n, out, n, pivot), 0);
  assert_int_equal(LAPACKE_dgetri(LAPACK_ROW_MAJOR, n, out, n, pivot), 0);
}

/* The definition of the engineering constants: pull along 1 alone, and so on. */
static void orthotropic_constants_are_those_measured(void **state) {
  (void)state;
  cdem_material m = specimen(1);
  const double *p = m.parameter;
  double s[36];
  solid(&m);
  inverse(d, 6, s);
  const double bound = 1e-14 / 4e9; /* the largest compliance is 1/g23 */
  for (int i = 0; i < 3; i++)
    check_near(s[7 * i], 1 / p[i], 0, bound);
  check_near(-s[1] / s[0], p[3], 1e-13, 0);
  check_near(-s[2] / s[0], p[4], 1e-13, 0);
  check_near(-s[8] / s[7], p[5], 1e-13, 0);
  check_near(s[35], 1 / p[6], 0, bound); /* xy: g12 */
  check_near(s[28], 1 / p[7], 0, bound); /* xz: g13 */
  check_near(s[21], 1 / p[8], 0, bound); /* yz: g23 */
}

/* C_ijkl = r_ip r_jq r_kr r_ls C_pqrs, all indices written out. */
static void rotation_is_that_of_a_tensor(void **state) {
  (void)state;
  static const int voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  for (int which = 2; which < 4; which++) {
    cdem_material m = specimen(which), plain = m;
    double c[36], r[9], a2[3];
    plain.rotated = false;
    solid(&plain);
    memcpy(c, d, sizeof c);
    solid(&m);
    /* Gram-Schmidt by hand: columns of r */
    double n1 = cdem_norm3(m.axis1), along = cdem_dot3(m.axis1, m.axis2) / (n1 * n1), axis[3][3];
    for (int i = 0; i < 3; i++)
      axis[0][i] = m.axis1[i] / n1, a2[i] = m.axis2[i] - along * m.axis1[i];
    for (int i = 0; i < 3; i++)
      axis[1][i] = a2[i] / cdem_norm3(a2);
    cdem_cross3(axis[0], axis[1], axis[2]);
    for (int i = 0; i < 9; i++)
      r[i] = axis[i % 3][i / 3];
    for (int n = 0; n < 81; n++) {
      int i = n / 27, j = n / 9 % 3, k = n / 3 % 3, l = n % 3;
      double sum = 0.0;
      for (int e = 0; e < 81; e++) {
        int p = e / 27, q = e / 9 % 3, s = e / 3 % 3, t = e % 3;
        sum += r[3 * i + p] * r[3 * j + q] * r[3 * k + s] * r[3 * l + t] *
               c[6 * voigt[p][q] + voigt[s][t]];
      }
      check_near(d[6 * voigt[i][j] + voigt[k][l]], sum, 0, 1e-14 * largest(c, 36));
    }
  }
}

static void plane_strain_takes_the_rows(void **state) {
  (void)state;
  static const int take[3] = {0, 1, 5};
  for (int which = 0; which < 4; which++) {
    cdem_material m = specimen(which);
    double c[36];
    solid(&m);
    memcpy(c, d, sizeof c);
    plane(&m, CDEM_PLANE_STRAIN);
    for (int i = 0; i < 9; i++)
      assert_true(d[i] == c[6 * take[i / 3] + take[i % 3]]);
  }
}

/* In plane stress the plane's compliance is a part of the solid's compliance. */
static void plane_stress_keeps_the_compliance(void **state) {
  (void)state;
  static const int take[3] = {0, 1, 5};
  for (int which = 0; which < 4; which++) {
    cdem_material m = specimen(which);
    double s[36], s_plane[9];
    solid(&m);
    inverse(d, 6, s);
    plane(&m, CDEM_PLANE_STRESS);
    inverse(d, 3, s_plane);
    for (int i = 0; i < 9; i++)
      check_near(s_plane[i], s[6 * take[i / 3] + take[i % 3]], 0, 1e-13 * largest(s, 36));
  }
}

/* mu -> mu/(1+mu), E -> E(1+2mu)/(1+mu)^2 makes plane stress of plane strain (springs.md). */
static void plane_stress_by_substitution(void **state) {
  (void)state;
  for (double nu = -0.45; nu < 1.0; nu += 0.1) { /* beyond 1/2 too; -1/2 < nu: E' > 0 */
    cdem_material m = cdem_material_isotropic(3.0, nu), other;
    double stress[9];
    plane(&m, CDEM_PLANE_STRESS);
    memcpy(stress, d, sizeof stress);
    other = cdem_material_isotropic(3.0 * (1 + 2 * nu) / ((1 + nu) * (1 + nu)), nu / (1 + nu));
    plane(&other, CDEM_PLANE_STRAIN);
    check_same(stress, d, 9, 1e-13 * largest(d, 9), "substitution");
  }
}

/* Li & Wan 2010, eqs 19-20, isotropic: written out from E and nu. */
static void cosserat_moduli(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material m = specimen(4);
  const double e = 30e9, nu = 0.2, g = e / 2.4, gc = 4e9;
  for (int stress = 0; stress < 2; stress++) {
    const cdem_section section = {stress ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN, 1.0};
    double d11 = stress ? e / (1 - nu * nu) : e * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    double d12 = stress ? nu * d11 : nu / (1 - nu) * d11;
    double expected[36] = {0};
    expected[0] = expected[7] = d11, expected[1] = expected[6] = d12;
    expected[14] = expected[21] = g + gc, expected[15] = expected[20] = g - gc;
    expected[28] = expected[35] = 2.0 * g * 0.4 * 0.4;
    check_ok(cdem_material_moduli(&m, CDEM_MODULI_PLANE_COSSERAT, &section, d, &rows, &fault));
    assert_int_equal(rows, 6);
    check_same(d, expected, 36, 1e-14 * d11, "Cosserat");
  }
  check_near(cdem_material_length(&m), sqrt(2.0) * 0.4, 1e-15, 0);
  cdem_material cubic = specimen(5); /* couple 1e9 N, 2G = 8e9 + 3e9 Pa */
  check_near(cdem_material_length(&cubic), sqrt(1e9 / 5.5e9), 1e-15, 0);
  cdem_material classical = specimen(0);
  assert_true(cdem_material_length(&classical) == 0.0);
}

static void models_are_found_by_name(void **state) {
  (void)state;
  for (int i = 0; i < CDEM_MATERIAL_MODEL_COUNT; i++) {
    const cdem_material_model_info *info = cdem_material_model_get((cdem_material_model)i);
    assert_int_equal(cdem_material_model_find(info->name), i);
    assert_true(info->keys <= CDEM_MATERIAL_PARAMETERS);
    for (int k = 0; k < info->keys; k++)
      assert_non_null(info->key[k].help);
  }
  assert_int_equal(cdem_material_model_find("rubber"), CDEM_MATERIAL_MODEL_COUNT);
  const cdem_material_model_info *last = cdem_material_model_get(CDEM_ANISOTROPIC);
  assert_int_equal(last->keys, 21);
  assert_string_equal(last->key[6].key, "c22"); /* upper triangle by rows */
  assert_string_equal(last->key[20].key, "c66");
}

/* One parameter changed to an impossible value; nothing is written. */
static void refused(int which, int parameter, double value, cdem_moduli_kind kind, cdem_plane form,
                    const char *text) {
  cdem_fault fault = {0};
  cdem_material m = specimen(which);
  cdem_section section = {form, 1.0};
  m.parameter[parameter] = value;
  d[0] = 7.0, rows = 9;
  check_fails(cdem_material_moduli(&m, kind, &section, d, &rows, &fault), CDEM_INPUT, text);
  assert_true(d[0] == 7.0 && rows == 9);
}

static void impossible_values_are_refused(void **state) {
  (void)state;
  const cdem_plane e = CDEM_PLANE_STRAIN, s = CDEM_PLANE_STRESS;
  const cdem_moduli_kind body = CDEM_MODULI_SOLID, flat = CDEM_MODULI_PLANE,
                         couple = CDEM_MODULI_PLANE_COSSERAT;
  refused(0, 0, 0.0, body, e, "young = 0 Pa is out of range: it must be positive");
  refused(0, 0, -3.0, flat, s, "young = -3 Pa is out of range: it must be positive");
  refused(0, 0, NAN, body, e, "young = nan is not a finite number");
  refused(0, 1, INFINITY, body, e, "poisson = inf is not a finite number");
  refused(0, 1, 0.5, body, e, "poisson = 0.5 is out of range: a solid needs -1 < poisson < 0.5");
  refused(0, 1, 0.5, flat, e,
          "poisson = 0.5 is out of range: plane strain needs -1 < poisson < 0.5");
  refused(0, 1, -1.0, body, e, "poisson = -1 is out of range: a solid needs -1 < poisson < 0.5");
  refused(0, 1, 1.0, flat, s, "poisson = 1 is out of range: plane stress needs -1 < poisson < 1");
  refused(0, 1, -1.0, flat, s, "poisson = -1 is out of range: plane stress needs -1 < poisson < 1");
  refused(0, 0, 1.5e308, body, e, "moduli overflow");
  refused(1, 6, 0.0, body, e, "g12 = 0 Pa is out of range: it must be positive");
  refused(1, 3, 2.0, body, e,
          "orthotropic material is not positive definite: the smallest "
          "eigenvalue of its compliance is -");
  refused(3, 0, 1e9, body, e,
          "anisotropic material is not positive definite: the smallest "
          "eigenvalue of c11 .. c66 is -");
  refused(3, 0, -1e9, body, e, "c11 = -1000000000 Pa is out of range: it must be positive");
  refused(4, 2, 0.0, couple, e, "cosserat_modulus = 0 Pa is out of range: it must be positive");
  refused(4, 3, -0.1, couple, e,
          "characteristic_length = -0.1 m is out of range: it must be positive");
  refused(4, 4, 0.0, couple, e, "couple_factor = 0 is out of range: it must be positive");
  refused(4, 1, 0.5, couple, e, "poisson = 0.5 is out of range: plane strain needs");
  refused(4, 1, 1.2, couple, s, "poisson = 1.2 is out of range: plane stress needs");
  refused(5, 1, 20e9, couple, e, "needs -d11 < d12 < d11 = 2e+10 Pa");
  refused(5, 3, -8e9, couple, e, "needs -d1212 < d1221 < d1212 = 8000000000 Pa");
  refused(5, 4, -1.0, couple, e, "couple_modulus = -1 N is out of range");
}

/* Singular to rounding is not positive definite: nu12 = nu23 = nu13 = 1/2 of equal moduli. */
static void incompressible_is_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material m = specimen(1);
  const double p[] = {1, 1, 1, 0.5, 0.5, 0.5, 1, 1, 1};
  memcpy(m.parameter, p, sizeof p);
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_SOLID, NULL, d, &rows, &fault), CDEM_INPUT,
              "not positive definite");
  m.parameter[3] = m.parameter[4] = m.parameter[5] = 0.4999999;
  check_ok(cdem_material_moduli(&m, CDEM_MODULI_SOLID, NULL, d, &rows, &fault));
}

static void axes_are_checked(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material m = specimen(2), cubic = specimen(5);
  const double twice[3] = {-1.2, -1.6, -0.2};
  memcpy(m.axis2, twice, sizeof twice);
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_SOLID, NULL, d, &rows, &fault), CDEM_INPUT,
              "axis1 and axis2 are parallel");
  memset(m.axis2, 0, sizeof m.axis2);
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_SOLID, NULL, d, &rows, &fault), CDEM_INPUT,
              "axis2 = (0, 0, 0) is no direction");
  m.axis1[1] = NAN;
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_SOLID, NULL, d, &rows, &fault), CDEM_INPUT,
              "is no direction: it must be finite and not zero");
  cubic.rotated = true;
  check_fails(
      cdem_material_moduli(&cubic, CDEM_MODULI_PLANE_COSSERAT, &strain_section, d, &rows, &fault),
      CDEM_INPUT, "axis1 and axis2 are not for cosserat-cubic");
}

static void materials_must_fit_the_element(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_contraction law;
  cdem_material cosserat = specimen(4), isotropic = specimen(0), orthotropic = specimen(1);
  const char *solid_text = "a cosserat material fits Cosserat elements only (2-D cells: tri3, "
                           "quad4), not a solid";
  check_fails(cdem_contraction_build(&cosserat, CDEM_SOLID, NULL, &law, &fault), CDEM_INPUT,
              solid_text);
  check_fails(cdem_contraction_build(&cosserat, CDEM_PLANE, &strain_section, &law, &fault),
              CDEM_INPUT, "not a classical plane");
  check_fails(
      cdem_contraction_build(&isotropic, CDEM_PLANE_COSSERAT, &strain_section, &law, &fault),
      CDEM_INPUT, "an isotropic material has no couple stresses");
  check_fails(
      cdem_contraction_build(&orthotropic, CDEM_PLANE_COSSERAT, &strain_section, &law, &fault),
      CDEM_INPUT, "use cosserat or cosserat-cubic");
}

static void sections_are_checked(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_contraction law;
  cdem_material m = specimen(0);
  const double bad[] = {0.0, -1.0, NAN, INFINITY};
  for (int i = 0; i < 4; i++) {
    cdem_section section = {CDEM_PLANE_STRAIN, bad[i]};
    check_fails(cdem_contraction_build(&m, CDEM_PLANE, &section, &law, &fault), CDEM_INPUT,
                "m is out of range: it must be positive and finite");
    check_ok(cdem_contraction_build(&m, CDEM_SOLID, &section, &law, &fault));
  }
  check_fails(cdem_contraction_build(&m, CDEM_PLANE, NULL, &law, &fault), CDEM_USAGE,
              "a plane body needs a section");
}

static void messages_name_the_material(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material m = cdem_material_isotropic(1.0, 0.7);
  snprintf(m.name, sizeof m.name, "granite");
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_SOLID, NULL, d, &rows, &fault), CDEM_INPUT,
              "material 'granite': poisson = 0.7 is out of range");
  assert_int_equal(cdem_material_moduli(&m, CDEM_MODULI_SOLID, NULL, d, &rows, NULL), CDEM_INPUT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(isotropic_moduli),
      cmocka_unit_test(orthotropic_constants_are_those_measured),
      cmocka_unit_test(rotation_is_that_of_a_tensor),
      cmocka_unit_test(plane_strain_takes_the_rows),
      cmocka_unit_test(plane_stress_keeps_the_compliance),
      cmocka_unit_test(plane_stress_by_substitution),
      cmocka_unit_test(cosserat_moduli),
      cmocka_unit_test(models_are_found_by_name),
      cmocka_unit_test(impossible_values_are_refused),
      cmocka_unit_test(incompressible_is_refused),
      cmocka_unit_test(axes_are_checked),
      cmocka_unit_test(materials_must_fit_the_element),
      cmocka_unit_test(sections_are_checked),
      cmocka_unit_test(messages_name_the_material),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
