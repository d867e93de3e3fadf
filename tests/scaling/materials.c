/* Moduli of every material model follow the dimensions of its parameters, to the last bit: no model
 * has a length of its own. */
#include "elements/material.h"
#include "scaling/scaling.h"
#include "support/test.h"

static cdem_material scaled(const cdem_material *from, const cdem_ratios *ratios) {
  const cdem_material_model_info *info = cdem_material_model_get(from->model);
  cdem_material to = *from;
  for (int k = 0; k < info->keys; k++)
    to.parameter[k] *= cdem_ratio(ratios, info->key[k].dimension);
  return to;
}

static void check_moduli(const cdem_material *material, cdem_moduli_kind kind) {
  static const cdem_ratios ratios[] = {{2.0, 2.0, 8.0}, {0.5, 0.5, 0.125}, {2.0, 8.0, 4.0}};
  cdem_fault fault = {0};
  for (int r = 0; r < 3; r++) {
    const cdem_section section = {CDEM_PLANE_STRESS, 0.3};
    const cdem_section thick = {CDEM_PLANE_STRESS, 0.3 * ratios[r].length};
    const cdem_material twin = scaled(material, &ratios[r]);
    double one[36], other[36];
    int rows, same;
    check_ok(cdem_material_moduli(material, kind, &section, one, &rows, &fault));
    check_ok(cdem_material_moduli(&twin, kind, &thick, other, &same, &fault));
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < rows; j++) {
        bool couples = kind == CDEM_MODULI_PLANE_COSSERAT && i >= 4 && j >= 4;
        double factor = cdem_ratio(&ratios[r], couples ? CDEM_FORCE : CDEM_PRESSURE);
        if (other[rows * i + j] != one[rows * i + j] * factor)
          fail_msg("model %s, modulus %d %d: %.17g and %.17g",
                   cdem_material_model_get(material->model)->name, i, j, one[rows * i + j],
                   other[rows * i + j]);
      }
  }
}

static void moduli_follow_their_parameters(void **state) {
  (void)state;
  static const cdem_material cosserat[] = {
      {.model = CDEM_COSSERAT, .parameter = {5e8, 0.23, 7e7, 0.05, 4}},
      {.model = CDEM_COSSERAT_CUBIC, .parameter = {5e8, 1e8, 2e8, 0.7e8, 4e4}},
      {.model = CDEM_COSSERAT_LATTICE, .parameter = {2.5e8, 5e7, 700, 0.05}},
      {.model = CDEM_COSSERAT_AVERAGE, .parameter = {2.5e8, 5e7, 700, 0.05, 0.57}},
      {.model = CDEM_COSSERAT_PRINTED, .parameter = {2.5e8, 5e7, 700, 0.05, 0.57, 1e6, 0.11}}};
  static const cdem_material solids[] = {
      {.model = CDEM_ISOTROPIC, .parameter = {3e10, 0.23}},
      {.model = CDEM_ORTHOTROPIC,
       .parameter = {3e10, 2e10, 1e10, 0.2, 0.15, 0.1, 7e9, 6e9, 5e9},
       .rotated = true,
       .axis1 = {1, 2, 0},
       .axis2 = {-2, 1, 1}},
      {.model = CDEM_ANISOTROPIC,
       .parameter = {9e10, 1e10, 2e10, 1e9, 2e9,  3e9, 8e10, 3e9,  2e9, 1e9, 4e9,
                     7e10, 1e9,  2e9,  3e9, 6e10, 1e9, 2e9,  5e10, 1e9, 4e10}}};
  for (size_t i = 0; i < sizeof cosserat / sizeof *cosserat; i++)
    check_moduli(&cosserat[i], CDEM_MODULI_PLANE_COSSERAT);
  for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
    check_moduli(&solids[i], CDEM_MODULI_SOLID);
    check_moduli(&solids[i], CDEM_MODULI_PLANE);
  }
  assert_int_equal(sizeof cosserat / sizeof *cosserat + sizeof solids / sizeof *solids,
                   CDEM_MATERIAL_MODEL_COUNT);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(moduli_follow_their_parameters)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
