/* Packings through libcdem. */
#include "support.h"

static const double low[3] = {0.0, 0.0, 0.0}, high[3] = {0.1, 0.1, 0.1};

/* Largest overlap of two grains, in radii of the first. */
static double overlap(const libcdem_packing *packing) {
  const double *xyz = libcdem_packing_centres(packing), *r = libcdem_packing_radii(packing);
  int64_t grains = libcdem_packing_grains(packing);
  double most = -1.0;
  for (int64_t i = 0; i < grains; i++)
    for (int64_t j = 0; j < i; j++) {
      double square = 0.0;
      for (int c = 0; c < 3; c++)
        square += (xyz[3 * i + c] - xyz[3 * j + c]) * (xyz[3 * i + c] - xyz[3 * j + c]);
      most = fmax(most, (r[i] + r[j] - sqrt(square)) / r[i]);
    }
  return most;
}

static void a_lattice_touches_and_stays_in_its_box(void **state) {
  (void)state;
  libcdem_fault fault = {0};
  libcdem_packing *packing = NULL;
  struct stat file;
  check_ok(libcdem_packing_create("cubic", 3, low, high, &packing, &fault));
  assert_int_equal(libcdem_packing_grains(packing), 0);
  check_fails(libcdem_packing_write(packing, in_scratch("a.csv"), &fault), LIBCDEM_USAGE,
              "no grains yet");
  check_ok(libcdem_packing_set(packing, "radius", 0.01, &fault));
  check_ok(libcdem_packing_make(packing, NULL, &fault));
  assert_int_equal(libcdem_packing_grains(packing), 125);
  assert_true(fabs(overlap(packing)) < 1e-12);
  const double *xyz = libcdem_packing_centres(packing);
  for (int k = 0; k < 3 * 125; k++) /* a radius away from the faces */
    assert_true(xyz[k] >= low[k % 3] + 0.01 - 1e-12 && xyz[k] <= high[k % 3] - 0.01 + 1e-12);
  check_ok(libcdem_packing_write(packing, in_scratch("a.csv"), &fault));
  assert_int_equal(stat(in_scratch("a.csv"), &file), 0);
  libcdem_packing_destroy(&packing);
  assert_null(packing);
}

/* Same seed, same grains; another seed, others; sizes between least and most. */
static void seeds_decide(void **state) {
  (void)state;
  libcdem_fault fault = {0};
  libcdem_packing *one = NULL, *two = NULL;
  check_ok(libcdem_packing_create("loose", 3, low, high, &one, &fault));
  check_ok(libcdem_packing_create("loose", 3, low, high, &two, &fault));
  libcdem_packing *const both[2] = {one, two};
  for (int i = 0; i < 2; i++) {
    check_ok(libcdem_packing_set(both[i], "least", 0.004, &fault));
    check_ok(libcdem_packing_set(both[i], "most", 0.008, &fault));
    check_ok(libcdem_packing_set(both[i], "count", 100, &fault));
    check_ok(libcdem_packing_make(both[i], NULL, &fault));
    assert_int_equal(libcdem_packing_grains(both[i]), 100);
    assert_true(overlap(both[i]) <= 0.0);
  }
  const size_t bytes = 300 * sizeof(double);
  assert_memory_equal(libcdem_packing_centres(one), libcdem_packing_centres(two), bytes);
  for (int i = 0; i < 100; i++)
    assert_true(libcdem_packing_radii(one)[i] >= 0.004 && libcdem_packing_radii(one)[i] <= 0.008);
  check_ok(libcdem_packing_set(two, "seed", 2, &fault));
  check_ok(libcdem_packing_make(two, NULL, &fault));
  assert_memory_not_equal(libcdem_packing_centres(one), libcdem_packing_centres(two), bytes);
  libcdem_packing_destroy(&one);
  libcdem_packing_destroy(&two);
}

/* Pressed discs fill the fraction that was asked for in the box that is left. */
static void pressing_shrinks_the_box(void **state) {
  (void)state;
  const double pi = 3.14159265358979323846;
  double least[3], most[3], solid = 0.0;
  libcdem_fault fault = {0};
  libcdem_packing *packing = NULL;
  check_ok(libcdem_packing_create("loose", 2, low, high, &packing, &fault));
  check_ok(libcdem_packing_set(packing, "radius", 0.005, &fault));
  check_ok(libcdem_packing_set(packing, "fraction", 0.4, &fault));
  check_ok(libcdem_packing_set(packing, "press_fraction", 0.6, &fault));
  check_ok(libcdem_packing_make(packing, NULL, &fault));
  libcdem_packing_box(packing, least, most);
  for (int64_t i = 0; i < libcdem_packing_grains(packing); i++)
    solid += pi * libcdem_packing_radii(packing)[i] * libcdem_packing_radii(packing)[i];
  assert_true(most[0] < high[0] && least[0] == low[0]);
  assert_true(fabs(solid / ((most[0] - least[0]) * (most[1] - least[1])) - 0.6) < 1e-3);
  libcdem_packing_destroy(&packing);
}

static void misuse_is_refused(void **state) {
  (void)state;
  libcdem_fault fault = {0};
  libcdem_packing *packing = NULL;
  check_fails(libcdem_packing_create("heap", 3, low, high, &packing, &fault), LIBCDEM_USAGE,
              "'heap'");
  check_fails(libcdem_packing_create("cubic", 1, low, high, &packing, &fault), LIBCDEM_USAGE,
              "dimension 1");
  assert_null(packing);
  check_ok(libcdem_packing_create("cubic", 3, low, high, &packing, &fault));
  check_fails(libcdem_packing_set(packing, "radios", 1.0, &fault), LIBCDEM_USAGE, "'radius'");
  check_fails(libcdem_packing_set(packing, "radius", -1.0, &fault), LIBCDEM_USAGE, "radius -1");
  check_fails(libcdem_packing_set(packing, "count", 1.5, &fault), LIBCDEM_USAGE, "whole");
  check_fails(libcdem_packing_make(packing, NULL, &fault), LIBCDEM_INPUT, "radius");
  check_ok(libcdem_packing_set(packing, "radius", 0.01, &fault));
  check_ok(libcdem_packing_set(packing, "press_pressure", 1e4, &fault));
  check_fails(libcdem_packing_make(packing, NULL, &fault), LIBCDEM_USAGE, "loose");
  assert_int_equal(libcdem_packing_grains(packing), 0);
  assert_null(libcdem_packing_centres(packing));
  libcdem_packing_destroy(&packing);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_lattice_touches_and_stays_in_its_box),
      cmocka_unit_test(seeds_decide),
      cmocka_unit_test(pressing_shrinks_the_box),
      cmocka_unit_test(misuse_is_refused),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
