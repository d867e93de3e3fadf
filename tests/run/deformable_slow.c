/* Triaxial tests of deformable grains through the door of a run: same bits, the pressure that was
 * asked for, and rigid grains as their limit. */
#include "run/resume.h"

/* A short and fast triaxial test. */
static const char triaxial[] =
    "history_every: 0.5 ms\n"
    "frame_every: 2 ms\n"
    "checkpoint_every: 1 ms\n"
    "grains:\n"
    "  dimension: 3\n"
    "  law: penalty\n"
    "  deformable: {shape: cubesphere, refinement: 2}\n"
    "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.3], radius: "
    "30 mm, count: 50, compact: {height: 300 mm}}\n"
    "  materials: {rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}\n"
    "  most_overlap: 0.4\n"
    "contacts: [{penalty_stiffness: 1e10 N/m3, friction: 0.3, damping_ratio: 0.2}]\n"
    "triaxial: {pressure: 0.9 MPa, strain: 0.01, consolidation: 6 ms, rate: 4 1/s}\n";

/* All but the checkpoint, which holds the wall time. */
static const char *const written[] = {"history.csv", "grains/grains-000003.vtu",
                                      "membrane/membrane-000003.vtu", NULL};

static void threads_and_breaks_change_no_bit(void **state) {
  (void)state;
  check_threads_and_breaks(triaxial, written);
}

/* Loose grains that a lid presses together: the step becomes shorter on the way. */
static const char pressed[] =
    "end: 4 ms\n"
    "grains:\n"
    "  dimension: 3\n"
    "  law: penalty\n"
    "  deformable: {shape: cubesphere, refinement: 2}\n"
    "  packing: {kind: loose, cylinder: yes, low: [-0.06, -0.06, 0], high: [0.06, 0.06, 0.15], "
    "radius: 20 mm, count: 16}\n"
    "  materials: {rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}\n"
    "contacts: [{penalty_stiffness: 1e11 N/m3, friction: 0.3, damping_ratio: 0.2}]\n"
    "walls:\n"
    "  floor: {shape: plane, normal: [0, 0, 1]}\n"
    "  tube: {shape: cylinder, radius: 60 mm, center: [0, 0, 0], axis: [0, 0, 1]}\n"
    "  lid: {shape: plane, normal: [0, 0, -1], center: [0, 0, 0.16], velocity: {z: -15 m/s}}\n";

/* The automatic step follows the contacts by the number of steps alone: how often somebody wants a
 * row does not change what happens. */
static void rows_do_not_steer_the_motion(void **state) {
  (void)state;
  static const char *const rare[] = {
      "history_every=1 ms", "results={most: {of: time_step, take: max}, least: {of: time_step, "
                            "take: min}}"};
  static const char *const often[] = {"history_every=0.1 ms", "results={}"};
  cdem_fault fault = {0};
  cdem_state saved[2] = {{0}};
  cdem_run_summary s;
  char path[600];
  write_case("box.yaml", pressed);
  check_ok(run_case("box.yaml", "rare", 2, rare, &s, &fault));
  assert_true(key_value(&s, "most") > 1.05 * key_value(&s, "least")); /* it was changed */
  cdem_run_summary_release(&s);
  check_ok(run_case("box.yaml", "often", 2, often, &s, &fault));
  cdem_run_summary_release(&s);
  for (int i = 0; i < 2; i++) {
    snprintf(path, sizeof path, "%s/checkpoint.h5", in_scratch(i == 0 ? "rare" : "often"));
    check_ok(cdem_read_state(path, &saved[i], &fault));
  }
  static const char *const names[] = {"fdem/center", "fdem/amplitude", "fdem/force", "fdem/steps"};
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    const cdem_array *a = cdem_state_find(&saved[0], names[k]);
    const cdem_array *b = cdem_state_find(&saved[1], names[k]);
    assert_true(a != NULL && b != NULL && a->count == b->count);
    assert_memory_equal(a->data, b->data, (size_t)a->count * cdem_array_size(a->type));
  }
  cdem_state_release(&saved[0]);
  cdem_state_release(&saved[1]);
}

/* ---- rigid grains are the limit of stiff ones ---- */

/* 160 balls of 40 mm in a membrane. Stiff ones keep few modes: nothing excites them. */
static const char specimen[] =
    "grains:\n"
    "  dimension: 3\n"
    "  law: penalty\n"
    "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.3], radius: "
    "20 mm, count: 160, compact: {height: 260 mm}}\n"
    "  materials: {rock: {density: 2650 kg/m3, young: 1e14 Pa, poisson: 0.2}}\n"
    "  most_overlap: 0.4\n"
    "contacts: [{penalty_stiffness: 3e10 N/m3, friction: 0.3, damping_ratio: 0.2}]\n"
    "triaxial: {pressure: 0.9 MPa, strain: 0.02, consolidation: 30 ms, inertial_number: 4e-3}\n"
    "results:\n"
    "  lateral: {of: lateral_stress, take: mean, from: 20 ms}\n"
    "  ratio: {of: stress_ratio, take: last}\n"
    "  volumetric: {of: volumetric_strain, take: last}\n"
    "  axial: {of: axial_strain, take: last}\n"
    "  error: {of: energy_error, take: last}\n";

typedef struct {
  double lateral, ratio, volumetric;
} answer;

static answer shear(bool deformable) {
  const char *const mesh = "grains.deformable={shape: icosphere, refinement: 1, modes: 6}";
  cdem_fault fault = {0};
  cdem_run_summary s;
  write_case("specimen.yaml", specimen);
  check_ok(
      run_case("specimen.yaml", deformable ? "stiff" : "rigid", deformable, &mesh, &s, &fault));
  answer a = {key_value(&s, "lateral"), key_value(&s, "ratio"), key_value(&s, "volumetric")};
  check_near(key_value(&s, "axial"), 0.02, 0.01, 0.0);
  check_below(key_value(&s, "error"), 1e-3);
  cdem_run_summary_release(&s);
  return a;
}

/* The law penalty is 2 p pi R* d^2 with the same p. Faces of icosphere 1 lie 1 % of r deeper
 * than its nodes on the mean, so that its contacts are those of balls smaller by half of it, and
 * softer by their area, 0.98: on the way to the peak 10 % of the ratio is left for all that. Later
 * faces roll less well than spheres, and the peak is higher. */
static void stiff_grains_are_rigid_ones(void **state) {
  (void)state;
  answer rigid = shear(false), stiff = shear(true);
  check_near(rigid.lateral, 0.9e6, 0.01, 0.0);
  check_near(stiff.lateral, 0.9e6, 0.01, 0.0);
  /* It has been sheared: five packings have 0.74 to 1.00, and 1.0 to 1.3 %. */
  assert_true(rigid.ratio > 0.5 && rigid.volumetric > 5e-3);
  check_near(stiff.ratio, rigid.ratio, 0.1, 0.0);
  check_near(stiff.volumetric, rigid.volumetric, 0.15, 0.0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threads_and_breaks_change_no_bit),
      cmocka_unit_test(rows_do_not_steer_the_motion),
      cmocka_unit_test(stiff_grains_are_rigid_ones),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
