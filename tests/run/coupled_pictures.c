/* Pictures of coupled runs: windows, given scales, states on the way; and what the parts cost. */
#include "run/support.h"

#define FOUNDATION                                                                                 \
  "end: 2 ms\n"                                                                                    \
  "step: 20 us\n"                                                                                  \
  "mass_damping: 500 1/s\n"                                                                        \
  "mesh: {shape: quad4, count: [4, 2], size: [4, 2], origin: [-2, -2]}\n"                          \
  "materials:\n"                                                                                   \
  "  soil: {model: cosserat, young: 500 MPa, poisson: 0.2, cosserat_modulus: 70 MPa,\n"            \
  "         characteristic_length: 0.05, density: 2042, micro_inertia: 0.005}\n"                   \
  "supports: [{group: y0, displacement: {x: 0, y: 0, rotation: 0}}]\n"                             \
  "grains:\n"                                                                                      \
  "  dimension: 2\n"                                                                               \
  "  packing: {kind: square, low: [-2, -2], high: [2, 0], radius: 0.1, centres_inside: yes}\n"     \
  "  materials: {grain: {density: 2600}}\n"                                                        \
  "  pictures: [pressure, effective_strain]\n"                                                     \
  "  picture_window: {low: [-1, -1], high: [1, 0.1], of: [effective_strain]}\n"                    \
  "  picture_ranges: {pressure: [0, 3 MPa]}\n"                                                     \
  "  picture_times: [1 ms]\n"                                                                      \
  "contacts: [{normal_stiffness: 2.5e8, shear_stiffness: 5e7, friction: 0.5, damping_ratio: 0}]\n" \
  "walls: {plate: {shape: plate, center: [0, 0], normal: [0, -1], half_size: [0.5], "              \
  "velocity: {y: -1}}}\n"                                                                          \
  "plates: {plate: {point: [0, 0], normal: [0, -1], half_size: [0.5], velocity: {y: -1}}}\n"       \
  "coupling: {regions: [{low: [-1, -1], high: [1, 0.1]}], rotation: scaled, cycles: 5}\n"

/* Numbers of the line of a script that starts with `word`. */
static void range_of(const char *name, const char *word, double range[2]) {
  char *read = NULL;
  cdem_fault fault = {0};
  check_ok(cdem_read_text(in_scratch(name), &read, &fault));
  const char *at = strstr(read, word);
  assert_non_null(at);
  assert_int_equal(sscanf(at + strlen(word), " [%lf:%lf]", &range[0], &range[1]), 2);
  free(read);
}

static void run_version(const char *version) {
  char override[64];
  const char *const list[] = {override};
  snprintf(override, sizeof override, "coupling.version=%s", version);
  const cdem_run_options options = {.path = in_scratch("foundation.yaml"),
                                    .folder = in_scratch(version),
                                    .overrides = 1,
                                    .override = list,
                                    .figures = true,
                                    .threads = 1,
                                    .version = "test",
                                    .commit = "test"};
  cdem_fault fault = {0};
  cdem_run_summary summary;
  check_ok(cdem_run(&options, &summary, &fault));
  bool coupled = strcmp(version, "coupled") == 0;
  assert_true(coupled == (summary.wall_fine > 0.0 && summary.wall_coarse > 0.0));
  assert_true(summary.wall_fine + summary.wall_coarse + summary.wall_transfer <= summary.wall);
  cdem_run_summary_release(&summary);
}

/* Whichever version, a picture with the window shows it alone, one with a scale has it, and both
 * are drawn of the state on the way. */
static void versions_can_be_compared(void **state) {
  (void)state;
  static const char *const version[] = {"coupled", "frozen", "grains", "continuum"};
  write_case("foundation.yaml", FOUNDATION);
  for (int v = 0; v < 4; v++) {
    char name[96];
    double range[2];
    run_version(version[v]);
    for (int at = 0; at < 2; at++) {
      const char *tag = at == 0 ? "-1ms" : "";
      snprintf(name, sizeof name, "%s/figures/effective_strain%s.png", version[v], tag);
      assert_true(is_there(name));
      snprintf(name, sizeof name, "%s/figures/effective_strain%s.gp", version[v], tag);
      range_of(name, "set xrange", range);
      assert_true(range[0] > -1.5 && range[0] < -0.9 && range[1] > 0.9 && range[1] < 1.5);
      snprintf(name, sizeof name, "%s/figures/pressure%s.gp", version[v], tag);
      range_of(name, "set cbrange", range);
      check_near(range[1] - range[0], 3.0, 1e-12, 0.0);
      range_of(name, "set xrange", range);
      bool all = strcmp(version[v], "frozen") != 0;
      assert_true(all == (range[0] < -1.9 && range[1] > 1.9));
    }
  }
  assert_true(holds("coupled/summary.json", "\"wall_transfer\": "));
  assert_false(holds("frozen/summary.json", "\"wall_transfer\": "));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(versions_can_be_compared)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
