/* Grains inside a body that breaks: what the coupling must not change, in small runs of a footing
 * on blocks with weak faces. The shipped case is for tests/cli/test-cemented.sh. */
#include "run/resume.h"

static const char box[] =
    "title: Small footing on blocks\n"
    "end: 8 ms\n"
    "step: 8 us\n"
    "mass_damping: 200 1/s\n"
    "history_every: 0.4 ms\n"
    "frame_every: 2 ms\n"
    "checkpoint_every: 1 ms\n"
    "mesh: {shape: quad4, count: [8, 4], size: [2 m, 1 m], origin: [-1 m, -1 m]}\n"
    "materials: {ground: {young: 90 MPa, poisson: 0.3, density: 2042 kg/m3}}\n"
    "blocks: {breakable: body}\n"
    "interfaces:\n"
    "  - {insertion: tied, tension: 5 kPa, cohesion: 30 kPa, friction: 0.5, softening: linear,\n"
    "     energy_1: 0.2 J/m2, energy_2: 2 J/m2}\n"
    "contact: {friction: 0.5}\n"
    "supports: [{group: y0, displacement: {x: 0, y: 0}}]\n"
    "grains:\n"
    "  dimension: 2\n"
    "  law: linear\n"
    "  packing: {kind: square, low: [-1, -1], high: [1, 0], radius: 20 mm, centres_inside: yes}\n"
    "  materials: {grain: {density: 2600 kg/m3}}\n"
    "contacts: [{normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, friction: 0.5,\n"
    "            damping_ratio: 0.1}]\n"
    "bonds: [{normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, gap: 0.01, tension: 4 kN,\n"
    "         cohesion: 8 kN, friction: 0.5}]\n"
    "walls: {plate: {shape: plate, center: [0, 0], normal: [0, -1], half_size: [0.25 m],\n"
    "                velocity: {y: {ramp: -1 m/s, over: 1 ms}}}}\n"
    "coupling: {regions: [{low: [-0.5 m, -0.5 m], high: [0.5 m, 0.1 m]}], cycles: 5}\n"
    "results:\n"
    "  cracks: {of: coarse.cracks, take: last}\n"
    "  broken: {of: fine.bonds_broken, take: last}\n"
    "  load: {of: load.plate.fy, take: last}\n";

/* Spheres in bricks, bonded; both forms of the force. */
static const char solid[] =
    "title: Small footing in space\n"
    "end: 4 ms\n"
    "step: 50 us\n"
    "mass_damping: 300 1/s\n"
    "history_every: 0.4 ms\n"
    "frame_every: 1 ms\n"
    "mesh: {shape: hex8, count: [3, 3, 2], size: [1.2 m, 1.2 m, 0.8 m], origin: [-0.6, -0.6, "
    "-0.8]}\n"
    "materials: {ground: {young: 250 MPa, poisson: 0, density: 1361 kg/m3}}\n"
    "supports: [{group: z0, displacement: {x: 0, y: 0, z: 0}}]\n"
    "grains:\n"
    "  dimension: 3\n"
    "  law: linear\n"
    "  packing: {kind: cubic, low: [-0.6, -0.6, -0.8], high: [0.6, 0.6, 0], radius: 50 mm}\n"
    "  materials: {grain: {density: 2600 kg/m3}}\n"
    "contacts: [{normal_stiffness: 2.5e7 N/m, shear_stiffness: 1e7 N/m, friction: 0.5,\n"
    "            damping_ratio: 0}]\n"
    "bonds: [{normal_stiffness: 2.5e7 N/m, shear_stiffness: 1e7 N/m, gap: 0.01}]\n"
    "walls: {plate: {shape: plate, center: [0, 0, 0], normal: [0, 0, -1], half_size: [0.1, 0.1],\n"
    "                velocity: {z: -0.5 m/s}}}\n"
    "coupling: {regions: [{low: [-0.2, -0.2, -0.4], high: [0.2, 0.2, 0.1]}], cycles: 2}\n"
    "results: {load: {of: load.plate.fz, take: last}, error: {of: energy_error, take: last}}\n";

static const char *const written[] = {"history.csv",
                                      "body/body-000004.vtu",
                                      "interfaces/interfaces-000004.vtu",
                                      "grains/grains-000004.vtu",
                                      "projection/projection-000004.vtu",
                                      NULL};

/* Both parts break, else the tests below say little. */
static void blocks_and_bonds_break(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary = {0};
  write_case("box.yaml", box);
  check_ok(run_case("box.yaml", "look", 0, NULL, &summary, &fault));
  assert_true(key_value(&summary, "cracks") >= 2.0);
  assert_true(key_value(&summary, "broken") >= 2.0);
  cdem_run_summary_release(&summary);
}

static void a_continued_run_gives_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_case("box.yaml", box);
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  for (int stop_at = 2; stop_at < 9; stop_at += 3) {
    check_fails(run_until("broken", false, stop_at, 2, &fault), CDEM_INTERRUPTED,
                "continue with `cdem run --resume");
    check_ok(run_until("broken", true, 1 << 30, 1, &fault));
    check_same_files("whole", "broken", written);
    check_same_state("whole", "broken");
  }
}

static void two_threads_give_the_bits_of_one(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_case("box.yaml", box);
  check_ok(run_until("one", false, 1 << 30, 1, &fault));
  check_ok(run_until("two", false, 1 << 30, 2, &fault));
  check_same_files("one", "two", written);
  check_same_state("one", "two");
}

/* Faces that are tied and never reach their strength are no faces. */
static void unbroken_blocks_are_one_body(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary tied = {0}, whole = {0};
  const char *const strong[] = {
      "interfaces=[{insertion: tied, tension: 1e9 MPa, cohesion: 1e9 MPa}]"};
  const char *const none[] = {"blocks={}", "interfaces=[]",
                              "results={load: {of: load.plate.fy, take: last}}"};
  write_case("box.yaml", box);
  check_ok(run_case("box.yaml", "tied", 1, strong, &tied, &fault));
  check_ok(run_case("box.yaml", "body", 3, none, &whole, &fault));
  assert_true(key_value(&tied, "cracks") == 0.0);
  double a = key_value(&tied, "load"), b = key_value(&whole, "load");
  if (!(fabs(a - b) <= 1e-10 * fabs(b)) || b == 0.0)
    fail_msg("loads %.17g and %.17g", a, b);
  cdem_run_summary_release(&tied);
  cdem_run_summary_release(&whole);
}

/* The number of cycles is found before anything has opened, and must do for what comes: stiff faces
 * once had runs fail when the first ones were let go. */
static void automatic_cycles_last_when_faces_open(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary = {0};
  const char *const stiff[] = {"interfaces[0].stiffness_factor=1000", "coupling.cycles=0"};
  write_case("box.yaml", box);
  check_ok(run_case("box.yaml", "stiff", 2, stiff, &summary, &fault));
  assert_true(key_value(&summary, "cracks") >= 1.0);
  cdem_run_summary_release(&summary);
}

/* A larger micro-inertia makes a new body: contact must not look at the masses of the old one (the
 * address sanitizer sees it). */
static void blocks_of_a_cosserat_medium_break(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary = {0};
  const char *const cosserat[] = {
      "materials={ground: {model: cosserat, young: 90 MPa, poisson: 0.3, cosserat_modulus: 50 MPa, "
      "characteristic_length: 0.02 m, density: 2042 kg/m3, micro_inertia: 0.0002 m2}}",
      "coupling.rotation=scaled", "contact={friction: 0.5, damping: 0.1}"};
  write_case("box.yaml", box);
  check_ok(run_case("box.yaml", "cosserat", 3, cosserat, &summary, &fault));
  assert_true(key_value(&summary, "cracks") >= 1.0);
  cdem_run_summary_release(&summary);
}

/* History and last checkpoint, interrupted in the middle with two threads. */
static void spheres_in_bricks_give_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_case("box.yaml", solid);
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  check_fails(run_until("broken", false, 3, 2, &fault), CDEM_INTERRUPTED, "--resume");
  check_ok(run_until("broken", true, 1 << 30, 2, &fault));
  assert_true(same_files("whole/history.csv", "broken/history.csv"));
  check_same_state("whole", "broken");
}

/* The two forms are two ways to the same elastic answer; neither makes energy. */
static void both_forms_agree_in_space(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary[2] = {{0}};
  const char *const form[2] = {"coupling.form=interface", "coupling.form=virtual-work"};
  write_case("box.yaml", solid);
  for (int i = 0; i < 2; i++)
    check_ok(run_case("box.yaml", form[i], 1, &form[i], &summary[i], &fault));
  double a = key_value(&summary[0], "load"), b = key_value(&summary[1], "load");
  if (!(a > 0.0) || !(fabs(a - b) < 0.02 * a))
    fail_msg("loads %g and %g", a, b);
  for (int i = 0; i < 2; i++) {
    assert_true(key_value(&summary[i], "error") < 1e-3);
    cdem_run_summary_release(&summary[i]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_and_bonds_break),
      cmocka_unit_test(a_continued_run_gives_the_same_bits),
      cmocka_unit_test(two_threads_give_the_bits_of_one),
      cmocka_unit_test(unbroken_blocks_are_one_body),
      cmocka_unit_test(automatic_cycles_last_when_faces_open),
      cmocka_unit_test(blocks_of_a_cosserat_medium_break),
      cmocka_unit_test(spheres_in_bricks_give_the_same_bits),
      cmocka_unit_test(both_forms_agree_in_space),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
