/* What bodies and grains start with and what pulls on all of a body, against closed forms that hold
 * to rounding: rigid motions; and the angle that a probe sees. */
#include "run/support.h"

#include <math.h>

/* Nobody holds it. Lumped masses of n x n elements have the moment of inertia m a^2/6 (1 + 2/n^2).
 */
#define SQUARE                                                                                     \
  "end: 1 ns\n"                                                                                    \
  "step: 1 ns\n"                                                                                   \
  "mesh: {shape: quad4, count: [4, 4], size: [2 m, 2 m], origin: [-1 m, -1 m]}\n"                  \
  "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2500 kg/m3}}\n"

static const double mass = 2500.0 * 4.0, edge = 2.0, cells = 4.0;

static double result_of(const char *text, const char *name) {
  cdem_fault fault = {0};
  cdem_run_summary summary;
  write_case("start.yaml", text);
  check_ok(run_case("start.yaml", "start", 0, NULL, &summary, &fault));
  double value = key_value(&summary, name);
  cdem_run_summary_release(&summary);
  char command[600];
  snprintf(command, sizeof command, "rm -r '%s'", in_scratch("start"));
  assert_int_equal(system(command), 0);
  return value;
}

#define KINETIC "results: {kinetic: {of: kinetic, take: max}}\n"

static void a_body_starts_with_the_energy_of_its_motion(void **state) {
  (void)state;
  const double inertia = mass * edge * edge / 6.0 * (1.0 + 2.0 / (cells * cells));
  /* Everything moves on by (3, -4) and turns about its middle by 0.5 a second. */
  double moving =
      result_of(SQUARE "initial: [{velocity: [3, -4], spin: [0, 0, 0.5]}]\n" KINETIC, "kinetic");
  check_near(moving, 0.5 * mass * 25.0 + 0.5 * inertia * 0.25, 1e-9, 0.0);
  /* About a corner: the middle goes round it, too. */
  double round =
      result_of(SQUARE "initial: [{spin: [0, 0, 0.5], center: [1, 1, 0]}]\n" KINETIC, "kinetic");
  check_near(round, 0.5 * (inertia + mass * 2.0) * 0.25, 1e-9, 0.0);
}

/* An edge carries the mass of half a column of elements. */
static void a_velocity_is_that_of_its_groups(void **state) {
  (void)state;
  double kinetic =
      result_of(SQUARE "initial: [{groups: [x0, x1], velocity: [3, 4]}]\n" KINETIC, "kinetic");
  check_near(kinetic, 0.5 * mass * 25.0 * 2.0 / (2.0 * cells), 1e-9, 0.0);
}

/* A force on all of a body is shared by mass: it only accelerates, and nothing is strained. */
static void a_force_on_a_volume_accelerates_it(void **state) {
  (void)state;
  const char text[] = "end: 1 ms\n"
                      "step: 10 us\n"
                      "mesh: {shape: hex8, count: [2, 3, 2], size: [1 m, 1 m, 2 m]}\n"
                      "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2500 kg/m3}}\n"
                      "loads: [{group: body, force: {z: 7 kN}}]\n"
                      "probes: {end: {group: z1, quantity: displacement, component: z}}\n"
                      "results:\n"
                      "  end: {of: probe.end, take: last}\n";
  const double acceleration = 7e3 / 5000.0, steps = 100.0, step = 1e-5;
  /* Leap-frog from rest with a first half step: u = a h^2 n^2/2. */
  double moved = result_of(text, "end") / (acceleration * step * step);
  check_near(moved, 0.5 * steps * steps, 1e-9, 0.0);
}

/* Discs cut off at atan 1/2 on both sides, touching: a heap whose slopes are known. */
static void a_probe_sees_the_slope_of_a_heap(void **state) {
  (void)state;
  FILE *file = fopen(in_scratch("heap.csv"), "w");
  assert_non_null(file);
  fputs("x [m],y [m],radius [m]\n", file);
  for (int column = -80; column <= 80; column++)
    for (int row = 0; row < 1 + (80 - abs(column)) / 2; row++)
      fprintf(file, "%g,%g,0.005\n", 0.00999 * column, 0.005 + 0.00999 * row);
  assert_int_equal(fclose(file), 0);
  const char text[] =
      "end: 1 us\n"
      "step: 1 us\n"
      "grains: {dimension: 2, file: heap.csv, materials: {sand: {density: 2600}}}\n"
      "contacts: [{normal_stiffness: 1e5, friction: 0.5, restitution: 1}]\n"
      "probes:\n"
      "  slope: {quantity: surface_angle, surface: slope, region: {low: [0, 0], high: [0.8, 1]}}\n"
      "  other: {quantity: surface_angle, surface: slope, region: {low: [-0.8, 0], high: [0, 1]}}\n"
      "  flank: {quantity: surface_angle, region: {low: [-0.8, 0], high: [0.8, 1]}}\n"
      "results:\n"
      "  slope: {of: probe.slope, take: last}\n"
      "  other: {of: probe.other, take: last}\n"
      "  flank: {of: probe.flank, take: last}\n";
  check_near(result_of(text, "slope"), -atan(0.5), 1e-3, 0.0);
  check_near(result_of(text, "other"), atan(0.5), 1e-3, 0.0);
  check_near(result_of(text, "flank"), atan(0.5), 1e-3, 0.0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_body_starts_with_the_energy_of_its_motion),
      cmocka_unit_test(a_velocity_is_that_of_its_groups),
      cmocka_unit_test(a_force_on_a_volume_accelerates_it),
      cmocka_unit_test(a_probe_sees_the_slope_of_a_heap),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
