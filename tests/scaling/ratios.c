/* Factors of exact scaling and coarse graining. */
#include "scaling/scaling.h"
#include "support/test.h"

#include <math.h>

/* Dimensions of the source's table 1 and of what else physics wants, and the power of h by eq 9. */
static const struct {
  const char *name;
  cdem_dimension dimension;
  int power;
} table[] = {
    {"length", {1, 0, 0}, 1},
    {"time", {0, 1, 0}, 1},
    {"mass", {0, 0, 1}, 3},
    {"force", {1, -2, 1}, 2},
    {"stress", {-1, -2, 1}, 0},
    {"penalty stiffness", {-2, -2, 1}, -1},
    {"contact stiffness", {0, -2, 1}, 1},
    {"acceleration", {1, -2, 0}, -1},
    {"mass damping", {0, -1, 0}, -1},
    {"velocity", {1, -1, 0}, 0},
    {"energy", {2, -2, 1}, 3},
    {"moment per rotation", {2, -2, 1}, 3},
    {"fracture energy", {0, -2, 1}, 1},
    {"contact dashpot", {0, -1, 1}, 2},
    {"rolling dashpot", {2, -1, 1}, 4},
    {"viscosity", {-1, -1, 1}, 1},
    {"density", {-3, 0, 1}, 0},
};

static void table_1_follows_from_equation_9(void **state) {
  (void)state;
  static const double sizes[] = {2.0, 4.0, 0.5, 3.0, 1.5, 1.0 / 3.0, 0.1};
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
    cdem_ratios ratios = cdem_ratios_of_size(sizes[s]);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
      double factor = cdem_ratio(&ratios, table[i].dimension);
      check_near(factor, pow(sizes[s], table[i].power), 1e-15, 0.0);
      if (table[i].power == 0 && factor != 1.0)
        fail_msg("%s is not left alone by h = %.17g: %.17g", table[i].name, sizes[s], factor);
    }
  }
}

static void powers_of_two_are_exact(void **state) {
  (void)state;
  for (int n = -3; n <= 3; n++) {
    cdem_ratios ratios = cdem_ratios_of_size(ldexp(1.0, n));
    assert_true(cdem_ratios_are_exact(&ratios));
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
      assert_true(cdem_ratio(&ratios, table[i].dimension) == ldexp(1.0, n * table[i].power));
  }
  cdem_ratios three = cdem_ratios_of_size(3.0), mixed = {2.0, 4.0, 8.0}, odd = {2.0, 3.0, 8.0};
  assert_false(cdem_ratios_are_exact(&three));
  assert_true(cdem_ratios_are_exact(&mixed));
  assert_false(cdem_ratios_are_exact(&odd));
  assert_true(cdem_ratio(&mixed, (cdem_dimension){-1, -2, 1}) == 0.25);
}

/* A window of the exactly scaled system: the domain stays, the grains follow eq 9. */
static void a_domain_keeps_its_size(void **state) {
  (void)state;
  const cdem_dimension length = {1, 0, 0}, time = {0, 1, 0}, velocity = {1, -1, 0},
                       rate = {0, -1, 0}, gravity = {1, -2, 0}, stress = {-1, -2, 1},
                       force = {1, -2, 1}, stiffness = {0, -2, 1};
  cdem_scaling s = cdem_scaling_coarse(3.0, 3);
#define FACTOR(dimension, tag, keeps) cdem_scaling_factor(&s, dimension, CDEM_TAG_##tag, keeps)
  assert_true(FACTOR(length, DOMAIN, false) == 1.0);
  assert_true(FACTOR(gravity, DOMAIN, false) == 1.0);
  assert_true(FACTOR(stress, DOMAIN, false) == 1.0);
  assert_true(FACTOR(force, DOMAIN, false) == 1.0);
  assert_true(FACTOR(length, NONE, false) == 1.0);
  assert_true(FACTOR(length, GRAIN, false) == 3.0);
  assert_true(FACTOR(force, GRAIN, false) == 9.0);
  assert_true(FACTOR(stiffness, LAW, false) == 3.0);
  assert_true(FACTOR(length, LAW, false) == 3.0);
  /* at the same inertial number: rate d sqrt(density/pressure) */
  assert_true(FACTOR(time, DOMAIN, false) == 3.0);
  check_near(FACTOR(rate, DOMAIN, false) * FACTOR(length, GRAIN, false), 1.0, 1e-15, 0.0);
  check_near(FACTOR(velocity, DOMAIN, false) * FACTOR(time, DOMAIN, false), 1.0, 1e-15, 0.0);
  assert_true(FACTOR(velocity, DOMAIN, true) == 1.0);
  s.slow = false;
  assert_true(FACTOR(time, DOMAIN, false) == 1.0);
  assert_true(FACTOR(velocity, DOMAIN, false) == 1.0);
  assert_true(FACTOR(time, GRAIN, false) == 3.0);
  /* without the rule sizes alone grow */
  s.rule = false;
  assert_true(FACTOR(length, GRAIN, false) == 3.0);
  assert_true(FACTOR(stiffness, GRAIN, false) == 1.0);
  assert_true(FACTOR(length, LAW, false) == 1.0);
  /* 2-D: the layer is thicker with the grains, and so are forces on its edges */
  s = cdem_scaling_coarse(3.0, 2);
  assert_true(FACTOR(force, DOMAIN, false) == 3.0);
  assert_true(FACTOR(stress, DOMAIN, false) == 1.0);
  s.rule = false;
  assert_true(FACTOR(force, DOMAIN, false) == 1.0);
#undef FACTOR
}

static void units_of_columns_have_dimensions(void **state) {
  (void)state;
  static const struct {
    const char *unit;
    cdem_dimension dimension;
  } known[] = {{"", {0, 0, 0}},        {"rad", {0, 0, 0}},    {"m", {1, 0, 0}},
               {"m2", {2, 0, 0}},      {"m/s", {1, -1, 0}},   {"N m", {2, -2, 1}},
               {"N.m", {2, -2, 1}},    {"rad/s", {0, -1, 0}}, {"1/s", {0, -1, 0}},
               {"kg m-3", {-3, 0, 1}}, {"Pa", {-1, -2, 1}},   {"Pa/m", {-2, -2, 1}},
               {"J/m^2", {0, -2, 1}},  {"kg/m3", {-3, 0, 1}}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    cdem_dimension found = {9, 9, 9};
    assert_true(cdem_dimension_of_unit(known[i].unit, &found));
    assert_memory_equal(&found, &known[i].dimension, sizeof found);
    char text[48];
    if (i != 1 && i > 0) { /* and back */
      cdem_dimension again;
      assert_true(cdem_dimension_of_unit(cdem_dimension_unit(found, text), &again));
      assert_memory_equal(&found, &again, sizeof found);
    }
  }
  static const char *const strange[] = {"furlong", "mm", "N^x", "m3.5", "percent", "m--2", "kPa"};
  for (size_t i = 0; i < sizeof strange / sizeof *strange; i++) {
    cdem_dimension found = {9, 9, 9};
    if (cdem_dimension_of_unit(strange[i], &found))
      fail_msg("'%s' has a dimension", strange[i]);
    assert_int_equal(found.length, 9);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(table_1_follows_from_equation_9),
      cmocka_unit_test(powers_of_two_are_exact),
      cmocka_unit_test(a_domain_keeps_its_size),
      cmocka_unit_test(units_of_columns_have_dimensions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
