/* Grains that deform from the case to the folder: broken triaxial tests, words that mean nothing.
 */
#include "run/resume.h"

#include <math.h>

static void write_specimen(const char *name, const char *law) {
  char text[2048];
  snprintf(
      text, sizeof text,
      "safety: 0.5\n"
      "grains:\n"
      "  dimension: 3\n"
      "  law: penalty\n"
      "  material: rock\n"
      "  deformable: {shape: cubesphere, refinement: 2}\n"
      "  packing: {kind: loose, cylinder: yes, low: [-0.08, -0.08, 0], high: [0.08, 0.08, "
      "0.16], radius: 0.025, count: 26, seed: 3, compact: {height: 0.16}}\n"
      "  materials: {smooth: {}, rock: {density: 2650, young: 40 GPa, poisson: 0.2}}\n"
      "  most_overlap: 0.4\n"
      "contacts:\n"
      "  - {between: [rock, smooth], penalty_stiffness: 1e10, friction: 0, damping_ratio: 0.2}\n"
      "  - {penalty_stiffness: 1e10, friction: 0.3, %s}\n"
      "triaxial: {pressure: 0.5 MPa, inertial_number: 2e-2, strain: 0.02, material: smooth, "
      "consolidation: 8 ms}\n",
      law);
  write_case(name, text);
}

/* Wherever it was broken, before or in the shear, and whatever the threads. */
static void a_broken_test_goes_on_to_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_specimen("box.yaml", "damping_ratio: 0.2");
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  for (int part = 0; part < 2; part++) {
    char folder[32];
    snprintf(folder, sizeof folder, "broken%d", part);
    cdem_status status = run_until(folder, false, part == 0 ? 60 : 350, 1, &fault);
    assert_int_equal(status, CDEM_INTERRUPTED);
    fault = (cdem_fault){0};
    check_ok(run_until(folder, true, 1 << 30, 2, &fault));
    check_same_state("whole", folder);
  }
}

static void what_nodes_cannot_do_is_refused(void **state) {
  (void)state;
  write_specimen("restitution.yaml", "restitution: 0.5");
  check_bad("restitution.yaml", "title=x", "damped one by one");
  write_specimen("shear.yaml", "damping_ratio: 0.2, shear_damping_ratio: 0.5");
  check_bad("shear.yaml", "title=x", "one 'damping_ratio' for both directions");
  write_specimen("ratio.yaml", "damping_ratio: 0.2, shear_ratio: 0");
  check_bad("ratio.yaml", "title=x", "the shear ratio of deformable grains is 0");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_broken_test_goes_on_to_the_same_bits),
                                     cmocka_unit_test(what_nodes_cannot_do_is_refused)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
