/* Laws of a case from outside: stiffness from the factor, which entry fits, what is missing. */
#include "run/support.h"

/* Two bricks in a row, h = 0.5 m, cut at the middle; plane strain, nu = 0: lambda + 2G = E. */
static const char pair[] = "analysis: static\n"
                           "mesh: {shape: quad4, count: [2, 1], size: [1 m, 1 m]}\n"
                           "materials: {rock: {young: 10 GPa, poisson: 0}}\n"
                           "blocks: {breakable: body}\n"
                           "interfaces: [{stiffness_factor: 4, tension: 1 GPa, cohesion: 1 GPa}]\n"
                           "supports:\n"
                           "  - {group: x0, displacement: {x: 0}}\n"
                           "  - {group: y0, displacement: {y: 0}}\n"
                           "loads: [{group: x1, force: {x: 1 MN}}]\n"
                           "probes: {tip: {group: x1, quantity: displacement, component: x}}\n"
                           "results: {tip: {of: tip, take: last}}\n";

static double tip_with(const char *override) {
  cdem_fault fault = {0};
  cdem_run_summary summary;
  write_case("pair.yaml", pair);
  check_ok(run_case("pair.yaml", "pair", override != NULL, &override, &summary, &fault));
  double tip = key_value(&summary, "tip");
  assert_int_equal(summary.interfaces, 1);
  assert_int_equal(summary.blocks, 2);
  cdem_run_summary_release(&summary);
  return tip;
}

/* 1 MN on 1 m2: the body gives p L/E = 1e-4, the face p/kn = p h/(factor E) = 1e-4/8. */
static void the_factor_gives_the_stiffness(void **state) {
  (void)state;
  check_near(tip_with(NULL), 1.125e-4, 1e-6, 0.0);
  check_near(tip_with("interfaces=[{normal_stiffness: 1e10 Pa/m, tension: 1 GPa}]"), 2e-4, 1e-9,
             0.0);
  check_near(tip_with("interfaces[0].insertion=tied"), 1e-4, 1e-9, 0.0);
}

/* Two entries: the first one that fits counts. */
static void the_first_entry_that_fits_counts(void **state) {
  (void)state;
  check_near(tip_with("interfaces=[{normal_stiffness: 1e10 Pa/m}, {normal_stiffness: 1e9 Pa/m}]"),
             2e-4, 1e-9, 0.0);
  check_near(tip_with("interfaces=[{between: [body, body], normal_stiffness: 1e9 Pa/m}, "
                      "{normal_stiffness: 1e10 Pa/m}]"),
             1.1e-3, 1e-9, 0.0);
}

static void what_is_missing_is_named(void **state) {
  (void)state;
  write_case("pair.yaml", pair);
  check_bad("pair.yaml", "interfaces=[{between: [body, roof]}]", "no group 'roof'");
  check_bad("pair.yaml", "interfaces=[{joint: x0}]", "not among `blocks.joints`");
  check_bad("pair.yaml", "interfaces=[]", "no entry fits the faces between groups 'body'");
  check_bad("pair.yaml", "supports=[]", "");
  check_bad("pair.yaml", "blocks.breakable=roof", "no group 'roof'");
  check_bad("pair.yaml", "interfaces[0].dilation=0.5", "dilation");
}

static void weight_and_waves_need_a_density(void **state) {
  (void)state;
  write_case("pair.yaml", pair);
  check_bad("pair.yaml", "gravity=[0, -9.81 m/s2]", "density");
  check_bad("pair.yaml", "supports[0].displacement.z=0", "no z component");
  check_bad("pair.yaml", "supports[0].displacement.rotation=0", "Cosserat materials only");
  check_bad("pair.yaml", "loads[0].group=body9", "no group 'body9'");
  check_bad("pair.yaml", "probes.tip.group=nix", "no group 'nix'");
}

/* A pair pulled apart at a steady speed: the peak is sigma_t A, what breaking costs G_I A. */
static void pulling_costs_the_fracture_energy(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  write_case("pull.yaml",
             "end: 30 ms\n"
             "mesh: {shape: quad4, count: [2, 1], size: [0.2 m, 0.1 m]}\n"
             "materials: {rock: {young: 10 GPa, poisson: 0, density: 2500 kg/m3}}\n"
             "blocks: {breakable: body}\n"
             "interfaces: [{tension: 1 MPa, cohesion: 5 MPa, friction: 0.5, softening: linear, "
             "energy_1: 50 J/m2, energy_2: 500 J/m2}]\n"
             "mass_damping: 2000 1/s\n"
             "supports:\n"
             "  - {group: x0, displacement: {x: 0}}\n"
             "  - {group: y0, displacement: {y: 0}}\n"
             "  - {group: x1, velocity: {x: {ramp: 5 mm/s, over: 2 ms}}}\n"
             "history_every: 20 us\n"
             "results:\n"
             "  peak: {of: reaction.x1.x, take: max}\n"
             "  fracture: {of: fracture, take: last}\n"
             "  cracks: {of: cracks, take: last}\n"
             "  area: {of: cracked_area, take: last}\n");
  check_ok(run_case("pull.yaml", "pull", 0, NULL, &summary, &fault));
  /* Inertia and damping of half a bar at 5 mm/s add about 1 % to the reaction. */
  check_near(key_value(&summary, "peak"), 1e5, 0.015, 0.0);
  check_near(key_value(&summary, "fracture"), 5.0, 1e-3, 0.0);
  check_near(key_value(&summary, "area"), 0.1, 1e-12, 0.0);
  assert_true(key_value(&summary, "cracks") == 1.0);
  check_below(summary.energy_error, 1e-3);
  cdem_run_summary_release(&summary);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_factor_gives_the_stiffness),
      cmocka_unit_test(the_first_entry_that_fits_counts),
      cmocka_unit_test(what_is_missing_is_named),
      cmocka_unit_test(weight_and_waves_need_a_density),
      cmocka_unit_test(pulling_costs_the_fracture_energy),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
