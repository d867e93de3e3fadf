/* Material files and quantities: what is right is read, and what is wrong is shown where it is. */
#include "io/support.h"

static cdem_status read_text(const char *text, cdem_material_file *file, cdem_fault *fault) {
  write_whole(in_scratch("m.yaml"), text);
  memset(file, 0, sizeof *file);
  return cdem_read_materials(in_scratch("m.yaml"), file, fault);
}

/* ---- quantities ---- */

static void quantities_become_si(void **state) {
  (void)state;
  static const struct {
    const char *text;
    cdem_dimension dimension;
    double value;
  } cases[] = {
      {"40 GPa", {-1, -2, 1}, 40e9},
      {"40e9", {-1, -2, 1}, 40e9},
      {"4.0e+4 MPa", {-1, -2, 1}, 40e9},
      {"60 mm", {1, 0, 0}, 0.06},
      {"60mm", {1, 0, 0}, 0.06},
      {"  -2.5e-3  ", {0, 0, 0}, -2.5e-3},
      {"2700 kg/m3", {-3, 0, 1}, 2700},
      {"2.7 g/cm3", {-3, 0, 1}, 2700},
      {"2700 kg m-3 ", {-3, 0, 1}, 2700},
      {"3 kN", {1, -2, 1}, 3000},
      {"25 %", {0, 0, 0}, 0.25},
      {".5", {0, 0, 0}, 0.5},
      {"+1", {0, 0, 0}, 1},
      {"1 psi", {-1, -2, 1}, 6894.757293168361},
      {"12 N/mm2", {-1, -2, 1}, 12e6},
      {"2 µm", {1, 0, 0}, 2e-6},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    cdem_fault fault = {0};
    double value = NAN;
    check_ok(cdem_parse_quantity(cases[i].text, cases[i].dimension, &value, &fault));
    /* number times scale, where the scale itself is a product of a few rounded factors */
    check_near(value, cases[i].value, 1e-15, 0);
  }
}

static void rates_may_be_written_as_fractions(void **state) {
  (void)state;
  static const char *const texts[] = {"200 1/s", "200 s-1", "0.2 1/ms", "200 Hz", "200"};
  for (int i = 0; i < 5; i++) {
    cdem_fault fault = {0};
    double value = NAN;
    check_ok(cdem_parse_quantity(texts[i], (cdem_dimension){0, -1, 0}, &value, &fault));
    check_near(value, 200, 1e-15, 0);
  }
}

static void quantities_that_are_none(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } cases[] = {
      {"40 m", "'40 m' has the wrong dimension; expected a unit of Pa"},
      {"40 GPaa", "unknown unit 'GPaa'"},
      {"40 GPa oops !", "unknown unit"},
      {"GPa", "'GPa' is not a number"},
      {"", "'' is not a number"},
      {"   ", "is not a number"},
      {"-", "is not a number"},
      {".", "is not a number"},
      {"nan", "'nan' is not a number"},
      {".nan", "is not a number"},
      {"inf GPa", "is not a number"},
      {"-.inf", "is not a number"},
      {"0x10", "is not a number"},
      {"1e999", "is too large"},
      {"1e305 GPa", "is too large"},
      {"40,5 GPa", "decimals with a point"},
      {"1 000", "without separators"},
      {"5 1/2", "without separators"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    cdem_fault fault = {0};
    double value = 7.0;
    check_fails(cdem_parse_quantity(cases[i].text, CDEM_PRESSURE, &value, &fault), CDEM_INPUT,
                cases[i].message);
    assert_true(value == 7.0);
  }
  cdem_fault fault = {0};
  double value;
  const cdem_dimension temperature = {0, 0, 0};
  check_fails(cdem_parse_quantity("3 m", temperature, &value, &fault), CDEM_INPUT,
              "wrong dimension; expected a unit of 1");
}

/* ---- files that are right ---- */

static void one_material(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material_file file;
  check_ok(read_text("young: 40 GPa\npoisson: \"0.25\"\n", &file, &fault));
  assert_int_equal(file.materials, 1);
  assert_int_equal(file.assignments, 0);
  assert_int_equal(file.default_material, 0);
  assert_int_equal(file.material[0].model, CDEM_ISOTROPIC);
  assert_string_equal(file.material[0].name, "m");
  check_near(file.material[0].parameter[0], 40e9, 1e-15, 0);
  assert_true(file.material[0].parameter[1] == 0.25);
  assert_false(file.material[0].rotated);
  cdem_material_file_release(&file);
  assert_int_equal(file.materials, 0);
  cdem_material_file_release(&file);
}

static void optional_keys_have_their_fallback(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material_file file;
  check_ok(read_text("{model: cosserat, young: 1, poisson: 0, cosserat_modulus: 1, "
                     "characteristic_length: 3 mm}",
                     &file, &fault));
  const cdem_material_model_info *info = cdem_material_model_get(CDEM_COSSERAT);
  for (int k = 0; k < info->keys; k++)
    if (info->key[k].optional)
      assert_true(file.material[0].parameter[k] == info->key[k].fallback);
  check_near(file.material[0].parameter[3], 0.003, 1e-15, 0);
  cdem_material_file_release(&file);
}

static void several_materials(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material_file file;
  check_ok(read_text("groups: {top: b, 'lower part': a}\n"
                     "default: b\n"
                     "materials:\n"
                     "  a: {young: 1 Pa, poisson: 0.1}\n"
                     "  b:\n"
                     "    young: 2 Pa\n"
                     "    poisson: 0.2\n",
                     &file, &fault));
  assert_int_equal(file.materials, 2);
  assert_string_equal(file.material[0].name, "a");
  assert_true(file.material[1].parameter[0] == 2.0);
  assert_int_equal(file.assignments, 2);
  assert_string_equal(file.group[0], "top");
  assert_int_equal(file.material_of[0], 1);
  assert_string_equal(file.group[1], "lower part");
  assert_int_equal(file.material_of[1], 0);
  assert_int_equal(file.default_material, 1);
  cdem_material_file_release(&file);
}

static void examples_can_be_read(void **state) {
  (void)state;
  static const struct {
    const char *name;
    cdem_material_model model;
    int materials;
  } examples[] = {{"granite", CDEM_ISOTROPIC, 1},
                  {"shale", CDEM_ORTHOTROPIC, 1},
                  {"quartz", CDEM_ANISOTROPIC, 1},
                  {"cosserat-sand", CDEM_COSSERAT, 1},
                  {"disc-lattice", CDEM_COSSERAT_LATTICE, 1},
                  {"two-layers", CDEM_ISOTROPIC, 2}};
  const cdem_section section = {CDEM_PLANE_STRAIN, 1.0};
  for (int e = 0; e < 6; e++) {
    cdem_fault fault = {0};
    cdem_material_file file;
    char path[512];
    snprintf(path, sizeof path, "%s/materials/%s.yaml", CDEM_DATA, examples[e].name);
    check_ok(cdem_read_materials(path, &file, &fault));
    assert_int_equal(file.materials, examples[e].materials);
    for (int m = 0; m < file.materials; m++) {
      double d[36];
      int rows;
      bool cosserat = cdem_material_is_cosserat(&file.material[m]);
      assert_int_equal(file.material[m].model, examples[e].model);
      check_ok(cdem_material_moduli(&file.material[m],
                                    cosserat ? CDEM_MODULI_PLANE_COSSERAT : CDEM_MODULI_SOLID,
                                    &section, d, &rows, &fault));
    }
    cdem_material_file_release(&file);
  }
}

/* ---- files that are wrong ---- */

static void errors_show_where_they_are(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } cases[] = {
      {"yuong: 40 GPa\npoisson: 0.2\n",
       "m.yaml:1:1: unknown key 'yuong'; did you mean 'young'?\n  yuong: 40 GPa\n  ^~~~~"},
      {"young: 40 m\npoisson: 0.2\n",
       "m.yaml:1:8: young: '40 m' has the wrong dimension; expected a unit of Pa\n  young: 40 m\n"
       "         ^~~~"},
      {"young: 1\n", "m.yaml:1:1: a material of model isotropic needs 'poisson'"},
      {"{}", "needs 'young', 'poisson'"},
      {"young: 1\nyoung: 2\npoisson: 0\n", "m.yaml:2:1: key 'young' was given already in line 1"},
      {"young: -1 GPa\npoisson: 0\n", "young is -1e+09 Pa and must be positive"},
      {"young: 0\npoisson: 0\n", "young is 0 Pa and must be positive"},
      {"young: .nan\npoisson: 0\n", "'.nan' is not a number"},
      {"young: .inf\npoisson: 0\n", "'.inf' is not a number"},
      {"young: [1, 2]\npoisson: 0\n", "m.yaml:1:8: 'young' must be a number, not a list"},
      {"young:\npoisson: 0\n", "'' is not a number"},
      {"young: &a 1\npoisson: *a\n", "m.yaml:1:8: anchors are not allowed"},
      {"young: 1\npoisson: *a\n", "m.yaml:2:10: aliases are not allowed"},
      {"young: !!float 1\npoisson: 0\n", "tags are not allowed"},
      {"young: 1\npoisson: 0\n---\nyoung: 2\n", "m.yaml:3:1: a second document begins here"},
      {"? [a]\n: 1\n", "a key must be a word, not a list"},
      {"- young\n", "a material file is a map of keys and values, not a list"},
      {"just words\n", "not a text"},
      {"", "it is empty"},
      {"# only a comment\n", "it is empty"},
      {"young: 1\n poisson: 0\n", "m.yaml:2:"},
      {"young: \"1\npoisson: 0\n", "m.yaml:"},
      {"model: isotropc\nyoung: 1\npoisson: 0\n",
       "m.yaml:1:8: unknown material model 'isotropc'; did you mean 'isotropic'?"},
      {"model: [isotropic]\n", "'model' must be a name, not a list"},
      {"young: 1\npoisson: 0\naxis1: [1, 0, 0]\n", "axes have no meaning for an isotropic"},
      {"materials: {a: {young: 1, poisson: 0}}\ngroups: {g: b}\n",
       "m.yaml:2:13: unknown material 'b'"},
      {"materials: {sand: {young: 1, poisson: 0}}\ndefault: snad\n", "did you mean 'sand'?"},
      {"materials: {a: {young: 1, poisson: 0}}\ndefualt: a\n", "did you mean 'default'?"},
      {"materials: {a: {young: 1, poisson: 0}, b: {young: 1, poisson: 0}}\n",
       "several materials need 'groups' or 'default'"},
      {"materials: {a: 3}\n", "a material must be a map of keys and values, not a text"},
      {"materials: []\n", "'materials' must be a map of names and materials"},
      {"materials: {}\n", "'materials' must be a map of names and materials"},
      {"groups: {a: b}\n", "'materials' is missing"},
      {"materials: {a: {young: 1, poisson: 0}}\ngroups: a\n", "'groups' must be a map"},
      {"materials: {a: {young: 1, poisson: 0}}\ngroups: {g: [a]}\n",
       "the name of a material is expected, not a list"},
      {"[[[[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]]]", "is nested deeper than 16 levels"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    cdem_fault fault = {0};
    cdem_material_file file = {.materials = 0};
    check_fails(read_text(cases[i].text, &file, &fault), CDEM_INPUT, cases[i].message);
    assert_null(file.material);
  }
}

static void axes_are_checked(void **state) {
  (void)state;
  static const char *const base = "model: orthotropic\ne1: 1\ne2: 1\ne3: 1\nnu12: 0\nnu13: 0\n"
                                  "nu23: 0\ng12: 1\ng13: 1\ng23: 1\n";
  static const struct {
    const char *text, *message;
  } cases[] = {{"axis1: [1, 0, 0]\n", "'axis2' is missing beside 'axis1'"},
               {"axis2: [1, 0, 0]\n", "'axis1' is missing beside 'axis2'"},
               {"axis1: [1, 0]\naxis2: [0, 1, 0]\n", "'axis1' must be a list of three numbers"},
               {"axis1: 1\naxis2: [0, 1, 0]\n", "'axis1' must be a list of three numbers"},
               {"axis1: [1, 0, 0]\naxis2: [0, 1, x]\n", "axis2: 'x' is not a number"},
               {"axis1: [1, 2, 0]\naxis2: [2, 4, 0]\n", "must not be zero or parallel"},
               {"axis1: [0, 0, 0]\naxis2: [2, 4, 0]\n", "must not be zero or parallel"}};
  char text[512];
  cdem_fault fault = {0};
  cdem_material_file file;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    snprintf(text, sizeof text, "%s%s", base, cases[i].text);
    check_fails(read_text(text, &file, &fault), CDEM_INPUT, cases[i].message);
  }
  snprintf(text, sizeof text, "%saxis1: [0, 1, 0]\naxis2: [-1, 0, 0.5]\n", base);
  check_ok(read_text(text, &file, &fault));
  assert_true(file.material[0].rotated);
  assert_true(file.material[0].axis1[1] == 1.0 && file.material[0].axis2[2] == 0.5);
  cdem_material_file_release(&file);
}

static void several_errors_are_told_at_once(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material_file file;
  assert_int_equal(
      read_text("yuong: 1\npoison: 2\nmodle: isotropic\na: 1\nb: 1\nc: 1\n", &file, &fault),
      CDEM_INPUT);
  const char *const parts[] = {"m.yaml:1:1: unknown key 'yuong'",
                               "\n/tmp/",
                               "m.yaml:2:1:",
                               "did you mean 'poisson'?",
                               "did you mean 'model'?",
                               "m.yaml:5:1:",
                               "\nand 2 more errors"};
  for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
    if (strstr(fault.message, parts[i]) == NULL)
      fail_msg("'%s' not in\n%s", parts[i], fault.message);
  assert_null(strstr(fault.message, "m.yaml:6:1:"));
}

/* A caret stays under its word behind tabs, wide letters and in long lines. */
static void carets_point(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material_file file;
  char text[400];
  check_fails(read_text("{'größe': 1, yuong: 2}\n", &file, &fault), CDEM_INPUT,
              "\n  {'größe': 1, yuong: 2}\n               ^~~~~");
  snprintf(text, sizeof text, "{young: 1, poisson: 0, %120s oops: 2}\n", "");
  check_fails(read_text(text, &file, &fault), CDEM_INPUT,
              "oops: 2}\n                                     ^~~~");
}

static void files_that_cannot_be_read(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material_file file = {.materials = 0};
  check_fails(cdem_read_materials(in_scratch("none.yaml"), &file, &fault), CDEM_FILE,
              "none.yaml': No such file or directory");
  check_fails(cdem_read_materials(scratch, &file, &fault), CDEM_FILE, "Is a directory");
  write_whole(in_scratch("bytes.yaml"), "young: \xff\xfe\x01\n");
  check_fails(cdem_read_materials(in_scratch("bytes.yaml"), &file, &fault), CDEM_INPUT,
              "bytes.yaml:");
}

static void lack_of_memory(void **state) {
  (void)state;
  int failures = 0;
  for (;; failures++) {
    cdem_fault fault = {0};
    cdem_material_file file = {.materials = 0};
    write_whole(in_scratch("m.yaml"), "materials: {a: {young: 1 Pa, poisson: 0.1}}\n"
                                      "groups: {g: a}\ndefault: a\n");
    cdem_memory_fail_after(failures);
    cdem_status status = cdem_read_materials(in_scratch("m.yaml"), &file, &fault);
    cdem_memory_fail_after(-1);
    if (status == CDEM_OK) {
      cdem_material_file_release(&file);
      break;
    }
    assert_int_equal(status, CDEM_MEMORY);
    assert_null(file.material);
  }
  assert_true(failures > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quantities_become_si),
      cmocka_unit_test(rates_may_be_written_as_fractions),
      cmocka_unit_test(quantities_that_are_none),
      cmocka_unit_test(one_material),
      cmocka_unit_test(optional_keys_have_their_fallback),
      cmocka_unit_test(several_materials),
      cmocka_unit_test(examples_can_be_read),
      cmocka_unit_test(errors_show_where_they_are),
      cmocka_unit_test(axes_are_checked),
      cmocka_unit_test(several_errors_are_told_at_once),
      cmocka_unit_test(carets_point),
      cmocka_unit_test(files_that_cannot_be_read),
      cmocka_unit_test(lack_of_memory),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
