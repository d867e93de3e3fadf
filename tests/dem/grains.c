/* Room dem: the arrays of grains. */
#include "dem/grains.h"

#include "support/test.h"

static cdem_fault fault;

static cdem_grains three(int dim) {
  cdem_grains grains = {.dim = dim};
  for (int i = 0; i < 3; i++)
    check_ok(cdem_grains_add(&grains, (double[3]){i, 2 * i, dim == 3 ? 3 * i : 0}, 1 + i, &fault));
  return grains;
}

static void grow_and_complete(void **state) {
  (void)state;
  cdem_grains grains = three(3), copy;
  check_ok(cdem_grains_complete(&grains, &fault));
  /* Arrays that are there grow along, with zeros. */
  for (int i = 0; i < 1000; i++)
    check_ok(cdem_grains_add(&grains, (double[3]){i, 0.5, 0.25}, 2.0, &fault));
  assert_int_equal(grains.grains, 1003);
  for (int64_t i = 0; i < grains.grains; i++) {
    assert_true(grains.velocity[3 * i] == 0.0 && grains.spin[3 * i + 2] == 0.0);
    assert_true(grains.material[i] == 0 && grains.motion[i] == CDEM_GRAIN_FREE);
  }
  assert_true(grains.xyz[3 * 1002] == 999.0 && grains.radius[2] == 3.0);
  check_ok(cdem_grains_copy(&grains, &copy, &fault));
  assert_memory_equal(copy.xyz, grains.xyz, 3 * 1003 * sizeof *copy.xyz);
  check_ok(cdem_grains_add(&copy, (double[3]){0}, 1.0, &fault));
  cdem_grains_release(&copy);
  cdem_grains_release(&grains);
  cdem_grains_release(&grains);
  assert_int_equal(grains.dim, 3);
}

static void solid_and_box(void **state) {
  (void)state;
  const double pi = 3.14159265358979323846;
  double low[3], high[3];
  cdem_grains discs = three(2), spheres = three(3);
  check_near(cdem_grains_solid(&discs), pi * 14.0, 1e-15, 0.0);
  check_near(cdem_grains_solid(&spheres), 4.0 / 3.0 * pi * 36.0, 1e-15, 0.0);
  cdem_grains_box(&discs, low, high);
  assert_true(low[0] == -1.0 && high[0] == 5.0 && low[1] == -1.0 && high[1] == 7.0);
  assert_true(low[2] == 0.0 && high[2] == 0.0);
  cdem_grains_box(&spheres, low, high);
  assert_true(low[2] == -1.0 && high[2] == 9.0);
  cdem_grains_release(&discs);
  cdem_grains_release(&spheres);
}

static void refusals(void **state) {
  (void)state;
  cdem_grains grains = three(2), none = {.dim = 2};
  check_fails(cdem_grains_check(&none, &fault), CDEM_INPUT, "there are no grains");
  grains.radius[1] = 0.0;
  check_fails(cdem_grains_check(&grains, &fault), CDEM_INPUT, "grain 1 has radius 0 m");
  grains.radius[1] = NAN;
  check_fails(cdem_grains_check(&grains, &fault), CDEM_INPUT, "grain 1 has radius nan m");
  grains.radius[1] = 1.0;
  grains.xyz[6] = INFINITY;
  check_fails(cdem_grains_check(&grains, &fault), CDEM_INPUT, "grain 2 has no place: (inf, 4, 0)");
  grains.xyz[6] = 0.0;
  grains.xyz[2] = 0.5;
  check_fails(cdem_grains_check(&grains, &fault), CDEM_INPUT, "disc 0 stands at z = 0.5 m");
  grains.dim = 1;
  check_fails(cdem_grains_check(&grains, &fault), CDEM_INPUT, "grains have dimension 1");
  cdem_grains_release(&grains);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(grow_and_complete),
      cmocka_unit_test(solid_and_box),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests_name("dem grains", tests, NULL, NULL);
}
