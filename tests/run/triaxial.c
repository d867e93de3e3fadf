/* Cases of triaxial tests that cannot be run. */
#include "run/triaxial.h"

#include "run/triaxial_box.h"

#include <math.h>

static void what_a_triaxial_test_makes_itself_is_refused(void **state) {
  (void)state;
  write_triaxial("bad.yaml", 1.0, "{pressure: 0.5 MPa}");
  check_bad("bad.yaml", "end=1 s", "'end' has no meaning in a triaxial test; it follows from");
  check_bad("bad.yaml", "walls.top.shape=plane", "'walls' has no meaning in a triaxial test");
  check_bad("bad.yaml", "analysis=relaxation", "a triaxial test goes through time");
  check_bad("bad.yaml", "grains.dimension=2", "a triaxial test is one of spheres");
  check_bad("bad.yaml", "grains.packing.cylinder=no", "add 'cylinder: yes'");
  check_bad("bad.yaml", "triaxial.side_material=smooth", "beside 'boundary: cylinder' only");
  check_bad("bad.yaml", "triaxial.material=wood", "there is no material 'wood'");
}

static void one_rate_and_one_side_are_enough(void **state) {
  (void)state;
  write_triaxial("two.yaml", 1.0, "{pressure: 0.5 MPa, rate: 0.1 1/s}");
  check_bad("two.yaml", "triaxial.inertial_number=1e-3",
            "'rate' and 'inertial_number' cannot both be given");
  write_triaxial("side.yaml", 1.0, "{pressure: 0.5 MPa, boundary: cylinder}");
  check_bad("side.yaml", "triaxial.membrane.poisson=0.4", "beside 'boundary: membrane' only");
}

static void nodes_that_let_grains_through_are_refused(void **state) {
  (void)state;
  write_triaxial("leak.yaml", 1.0, "{pressure: 0.5 MPa}");
  check_bad("leak.yaml", "triaxial.membrane.spacing=30 mm", "let grains of 0.05 m through");
}

/* What is not given follows from pressure, diameter and density; a ratio of 0 is given. */
static void a_membrane_without_damping_has_none(void **state) {
  (void)state;
  const double low[3] = {0.0, 1.0, 0.0}, high[3] = {2.0, 4.0, 5.0};
  const cdem_run_triaxial plan = {.sizes = {.smallest = 0.1, .density = 2000.0}};
  cdem_run_setup run = {0};
  cdem_membrane_options options;
  cdem_case_triaxial *t = &run.cases.values.triaxial;
  t->pressure = 1e5;
  t->membrane = (cdem_case_membrane){.spacing = NAN,
                                     .penalty = NAN,
                                     .young = NAN,
                                     .thickness = NAN,
                                     .bending = NAN,
                                     .areal_density = NAN,
                                     .contact_damping = NAN};
  cdem_run_triaxial_membrane(&run, &plan, low, high, &options);
  assert_true(options.damping == 0.0);
  check_near(options.contact_damping, 0.2, 1e-15, 0.0);
  check_near(options.young * options.thickness, 0.1 * 1e5 * 0.1, 1e-15, 0.0);
  check_near(options.bending, 0.1 * 1e5 * 1e-3, 1e-14, 0.0);
  check_near(options.areal_density, 100.0, 1e-15, 0.0);
  assert_true(options.radius == 1.0 && options.center[0] == 1.0 && options.center[1] == 2.5);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_a_triaxial_test_makes_itself_is_refused),
                                     cmocka_unit_test(one_rate_and_one_side_are_enough),
                                     cmocka_unit_test(nodes_that_let_grains_through_are_refused),
                                     cmocka_unit_test(a_membrane_without_damping_has_none)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
