/* Tables of laws and resistances, and what a contact model refuses. */
#include "dem/law.h"

#include "law_support.h"

static void tables_are_complete_and_found_by_name(void **state) {
  (void)state;
  assert_string_equal(cdem_law_at(0)->name, "linear");
  static const char *const names[] = {
#define X(identifier, name) name,
#include "dem/laws.def"
#undef X
  };
  int laws = 0;
  for (const cdem_law *law; (law = cdem_law_at(laws)) != NULL; laws++) {
    assert_string_equal(law->name, names[laws]);
    assert_ptr_equal(cdem_law_find(law->name), law);
    assert_true(law->help != NULL && law->wants <= CDEM_LAW_WANTS);
    assert_true(law->dims[2] || law->dims[3]);
    assert_true((law->dims[2] && law->dims[3]) || law->why != NULL);
    for (int d = 0; d < 2; d++) {
      assert_true(law->history[d] <= CDEM_LAW_HISTORY);
      for (int e = 0; e < 2; e++)
        assert_int_equal(law->batch[d][e] != NULL, law->dims[2 + d]);
      assert_int_equal(law->one[d] != NULL, law->dims[2 + d]);
      for (int h = 0; h < law->history[d]; h++)
        assert_true(fabs(law->parity[d][h]) == 1.0);
    }
  }
  assert_int_equal(laws, sizeof names / sizeof *names);
  assert_null(cdem_law_at(-1));
  assert_null(cdem_law_find("herz"));
  assert_string_equal(cdem_rolling_at(0)->name, "none");
  assert_string_equal(cdem_twisting_at(0)->name, "none");
  for (int i = 0; cdem_rolling_at(i) != NULL; i++)
    assert_ptr_equal(cdem_rolling_find(cdem_rolling_at(i)->name), cdem_rolling_at(i));
  for (int i = 0; cdem_twisting_at(i) != NULL; i++)
    assert_ptr_equal(cdem_twisting_find(cdem_twisting_at(i)->name), cdem_twisting_at(i));
  assert_null(cdem_rolling_find("springs"));
  assert_null(cdem_twisting_find("constant"));
}

static void words_have_dimension_and_help(void **state) {
  (void)state;
  for (int key = 0; key < CDEM_LAW_KEYS; key++) {
    assert_non_null(cdem_law_key_get(key));
    assert_true(strlen(cdem_law_key_get(key)->help) > 10);
  }
  assert_null(cdem_law_key_get(CDEM_LAW_KEYS));
  assert_null(cdem_law_key_get(-1));
  const cdem_law_key_info *info = cdem_law_key_get(CDEM_LAW_normal_dashpot);
  assert_string_equal(info->name, "normal_dashpot");
  assert_true(info->dimension.length == 0 && info->dimension.time == -1 &&
              info->dimension.mass == 1);
}

static cdem_contact_input linear_input(void) {
  cdem_contact_input input = no_input();
  input.value[CDEM_LAW_normal_stiffness] = 1e6;
  input.value[CDEM_LAW_restitution] = 0.5;
  return input;
}

static const cdem_grain_material steel = {"steel", 7850.0, 210e9, 0.3};

static void a_missing_or_wrong_word_is_named_with_both_materials(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_contact_model model = {0};
  const cdem_law *law = cdem_law_find("linear");
  cdem_contact_input input = linear_input();
#define INIT(dim)                                                                                  \
  cdem_contact_model_init(dim, law, NULL, NULL, &input, &glass, &steel, &model, &fault)
  input.value[CDEM_LAW_normal_stiffness] = NAN;
  check_fails(INIT(3), CDEM_INPUT,
              "contact of 'glass' with 'steel': law 'linear' needs "
              "'normal_stiffness'");
  check_fails(INIT(3), CDEM_INPUT, "force per overlap. Unit: N/m)");
  input.value[CDEM_LAW_normal_stiffness] = 0.0;
  check_fails(INIT(3), CDEM_INPUT, "'normal_stiffness' = 0 must exceed 0");
  input.value[CDEM_LAW_normal_stiffness] = INFINITY;
  check_fails(INIT(3), CDEM_INPUT, "'normal_stiffness' is not finite");
  input = linear_input();
  input.value[CDEM_LAW_restitution] = 1.5;
  check_fails(INIT(3), CDEM_INPUT, "'restitution' = 1.5 must be at most 1");
  input.value[CDEM_LAW_restitution] = NAN;
  check_fails(INIT(2), CDEM_INPUT, "none of 'restitution', 'damping_ratio' and 'normal_dashpot'");
  input.value[CDEM_LAW_restitution] = 0.5;
  input.value[CDEM_LAW_damping_ratio] = 0.1;
  check_fails(INIT(2), CDEM_INPUT, "more than one of 'restitution'");
  input = linear_input();
  input.value[CDEM_LAW_friction] = -0.1;
  check_fails(INIT(3), CDEM_INPUT, "'friction' = -0.1 must be at least 0");
  input = linear_input();
  input.value[CDEM_LAW_shear_ratio] = input.value[CDEM_LAW_shear_stiffness] = 0.3;
  check_fails(INIT(3), CDEM_INPUT, "'shear_stiffness' and 'shear_ratio' were both given");
  input = linear_input();
  input.value[CDEM_LAW_shear_dashpot] = input.value[CDEM_LAW_shear_damping_ratio] = 0.3;
  check_fails(INIT(3), CDEM_INPUT, "'shear_dashpot' and 'shear_damping_ratio' were both given");
  assert_null(model.law); /* untouched */
#undef INIT
}

static void a_word_that_nobody_uses_is_refused_with_the_nearest(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_contact_model model;
  cdem_contact_input input = linear_input();
  input.value[CDEM_LAW_rolling_stiffness] = 1.0;
  check_fails(cdem_contact_model_init(3, cdem_law_find("linear"), NULL, NULL, &input, &glass,
                                      &glass, &model, &fault),
              CDEM_INPUT,
              "'rolling_stiffness' is not used by law 'linear' with rolling 'none' and twisting "
              "'none'; did you mean 'normal_stiffness'?");
  input = no_input();
  input.value[CDEM_LAW_restitution] = 0.5;
  input.value[CDEM_LAW_normal_dashpot] = 1.0;
  check_fails(cdem_contact_model_init(3, cdem_law_find("hertz"), NULL, NULL, &input, &glass, &glass,
                                      &model, &fault),
              CDEM_INPUT, "'normal_dashpot' is not used by law 'hertz'");
}

static void combinations_that_cannot_be_are_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_contact_model model;
  cdem_contact_input input = no_input();
  const cdem_law *hertz = cdem_law_find("hertz"), *li_chu = cdem_law_find("li-chu");
  const cdem_resistance *spring = cdem_rolling_find("spring");
  cdem_grain_material soft = {"clay", 1800.0, NAN, 0.3}, odd = {"cork", 200.0, 1e7, 0.7};
  cdem_grain_material rigid = {"rigid", 1.0, INFINITY, 0.0};
  input.value[CDEM_LAW_restitution] = 0.5;
#define INIT(dim, law, rolling, twisting, a)                                                       \
  cdem_contact_model_init(dim, law, rolling, twisting, &input, a, a, &model, &fault)
  check_fails(INIT(2, hertz, NULL, NULL, &glass), CDEM_INPUT, "law 'hertz' does not know discs");
  check_fails(INIT(3, li_chu, NULL, NULL, &glass), CDEM_INPUT, "'li-chu' does not know spheres");
  check_fails(INIT(3, hertz, NULL, NULL, &soft), CDEM_INPUT, "needs 'young' of material 'clay'");
  check_fails(INIT(3, hertz, NULL, NULL, &odd), CDEM_INPUT, "needs 'poisson' of material 'cork'");
  check_fails(INIT(3, hertz, NULL, NULL, &rigid), CDEM_INPUT, "both materials are rigid");
  check_fails(INIT(2, li_chu, spring, NULL, &glass), CDEM_INPUT, "rolling resistance of its own");
  check_fails(INIT(2, cdem_law_find("linear"), NULL, cdem_twisting_find("spring"), &glass),
              CDEM_INPUT, "discs do not twist");
  check_fails(INIT(3, hertz, cdem_rolling_find("constant"), NULL, &glass), CDEM_INPUT,
              "needs 'rolling_friction' or 'rolling_length'");
  input.value[CDEM_LAW_rolling_friction] = 0.1;
  check_fails(INIT(3, hertz, spring, NULL, &glass), CDEM_INPUT,
              "needs 'rolling_stiffness': the law has no constant shear stiffness");
  input.value[CDEM_LAW_rolling_friction] = NAN;
  check_fails(INIT(3, hertz, spring, NULL, &glass), CDEM_INPUT,
              "'spring' needs 'rolling_friction' or 'rolling_length'");
  input.value[CDEM_LAW_twisting_friction] = 0.1;
  check_fails(INIT(3, hertz, NULL, cdem_twisting_find("spring"), &glass), CDEM_INPUT,
              "needs 'twisting_stiffness'");
  input = no_input();
  input.value[CDEM_LAW_normal_stiffness] = input.value[CDEM_LAW_shear_stiffness] = 1e6;
  input.value[CDEM_LAW_friction] = 0.4;
  input.value[CDEM_LAW_arms_by_radius] = 0.5;
  check_fails(INIT(2, li_chu, NULL, NULL, &glass), CDEM_INPUT, "'arms_by_radius' = 0.5 must be 0");
#undef INIT
}

static void histories_follow_each_other(void **state) {
  (void)state;
  cdem_contact_model model;
  cdem_contact_input input = linear_input();
  input.value[CDEM_LAW_rolling_friction] = input.value[CDEM_LAW_twisting_friction] = 0.1;
  make_model(3, cdem_law_find("linear"), cdem_rolling_find("spring"), cdem_twisting_find("spring"),
             &input, &model);
  assert_int_equal(model.histories, 7);
  assert_int_equal(model.first[1], 3);
  assert_int_equal(model.first[2], 6);
  assert_true(model.parity[2] == -1.0 && model.parity[5] == -1.0 && model.parity[6] == 1.0);
  assert_false(model.arms_by_radius);
  /* rolling spring from the shear stiffness, 2/7 of the normal one */
  check_near(model.rolling->stiffness(&model.parameters[1], 0.01), 2e6 / 7.0 * 1e-4, 1e-15, 0.0);
  input.value[CDEM_LAW_twisting_friction] = NAN;
  make_model(2, cdem_law_find("linear"), cdem_rolling_find("spring"), NULL, &input, &model);
  assert_int_equal(model.histories, 2);
  check_near(model.rolling->stiffness(&model.parameters[1], 0.01), 1e6 / 3.0 * 1e-4, 1e-15, 0.0);
  input = no_input();
  input.value[CDEM_LAW_normal_stiffness] = input.value[CDEM_LAW_shear_stiffness] = 1e6;
  input.value[CDEM_LAW_friction] = 0.4;
  input.value[CDEM_LAW_arms_by_radius] = 1.0;
  make_model(2, cdem_law_find("li-chu"), NULL, NULL, &input, &model);
  assert_true(model.arms_by_radius);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tables_are_complete_and_found_by_name),
      cmocka_unit_test(words_have_dimension_and_help),
      cmocka_unit_test(a_missing_or_wrong_word_is_named_with_both_materials),
      cmocka_unit_test(a_word_that_nobody_uses_is_refused_with_the_nearest),
      cmocka_unit_test(combinations_that_cannot_be_are_refused),
      cmocka_unit_test(histories_follow_each_other),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
