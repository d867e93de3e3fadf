/* Coupled cases through the door of a run: bonded grains in their own medium answer like grains
 * everywhere, loads and supports reach grains, and neither threads nor interruptions change a bit.
 */
#include "run/resume.h"

/* 4 m x 3 m of discs in elements of 1 m, exact moduli, everything linear; grains where `regions`
 * say. */
#define MEDIUM                                                                                     \
  "end: 6 ms\n"                                                                                    \
  "step: 50 us\n"                                                                                  \
  "mass_damping: 200 1/s\n"                                                                        \
  "history_every: 0.5 ms\n"                                                                        \
  "frame_every: 2 ms\n"                                                                            \
  "mesh: {shape: quad4, count: [4, 3], size: [4 m, 3 m], origin: [-2 m, -3 m]}\n"                  \
  "materials: {soil: {model: cosserat-lattice, normal_stiffness: 2.5e8 N/m, "                      \
  "shear_stiffness: 5e7 N/m, rolling_stiffness: 3000 N m, radius: 0.1 m, density: 2042 kg/m3}}\n"  \
  "supports:\n"                                                                                    \
  "  - {group: y0, displacement: {x: 0, y: 0, rotation: 0}}\n"                                     \
  "  - {group: x0, displacement: {x: 0}}\n"                                                        \
  "  - {group: x1, displacement: {x: 0}}\n"                                                        \
  "grains:\n"                                                                                      \
  "  dimension: 2\n"                                                                               \
  "  packing: {kind: square, low: [-2, -3], high: [2, 0], radius: 0.1 m, centres_inside: yes}\n"   \
  "  materials: {disc: {density: 2600 kg/m3}}\n"                                                   \
  "contacts: [{normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, friction: 0.5, "             \
  "normal_dashpot: 0}]\n"                                                                          \
  "bonds: [{gap: 0.01, normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, "                    \
  "rolling_stiffness: 3000 N m}]\n"
#define PLATE                                                                                      \
  "walls: {press: {shape: plate, center: [0, 0], normal: [0, -1], half_size: [0.5 m], velocity: "  \
  "{y: -1 m/s}}}\n"                                                                                \
  "results: {load: {of: load.press.fy, take: last}, error: {of: energy_error, take: max}, fine: "  \
  "{of: fine_part, take: max}, coarse: {of: coarse_part, take: max}}\n"
#define COUPLING(more)                                                                             \
  "coupling: {regions: [{low: [-1, -2], high: [1, 0.1]}], rotation: scaled, cycles: 5" more "}\n"

static cdem_run_summary run_version(const char *version, const char *form) {
  char set[2][64];
  snprintf(set[0], sizeof set[0], "coupling.version=%s", version);
  snprintf(set[1], sizeof set[1], "coupling.form=%s", form);
  const char *const override[] = {set[0], set[1], "end=20 ms", "mass_damping=100 1/s"};
  cdem_run_summary summary;
  cdem_fault fault = {0};
  check_ok(run_case("box.yaml", version, 4, override, &summary, &fault));
  return summary;
}

/* The bounds are those of the table for the foundation; a region of 20 grains across is smaller
 * than that, so the null is further off. */
static void bonded_grains_answer_like_grains_everywhere(void **state) {
  (void)state;
  static const char *const form[] = {"interface", "virtual-work"};
  write_case("box.yaml", MEDIUM PLATE COUPLING(""));
  cdem_run_summary all = run_version("grains", "interface"),
                   null = run_version("frozen", "interface");
  double load = key_value(&all, "load"), off = fabs(key_value(&null, "load") - load);
  assert_true(all.grains > 250 && null.grains < all.grains);
  check_below(0.1 * load, off);
  for (int f = 0; f < 2; f++) {
    cdem_run_summary s = run_version("coupled", form[f]);
    assert_true(s.fine > 100 && s.interface_grains > 20 && s.cycles == 5 && s.elements == 8);
    assert_int_equal(s.steps, all.steps);
    check_below(fabs(key_value(&s, "load") - load), 0.2 * off);
    check_below(key_value(&s, "error"), 1e-3);
    assert_true(key_value(&s, "fine") > 0.0 && key_value(&s, "coarse") > 0.0);
    cdem_run_summary_release(&s);
  }
  cdem_run_summary_release(&all);
  cdem_run_summary_release(&null);
}

/* A pressure over the whole top goes down through grains as through elements, whatever part is
 * grains, to supports that hold either: at rest, the stress in the middle of the grains is that
 * pressure, but for what is left over at the edge of the fine region. */
static void tractions_and_supports_reach_grains(void **state) {
  (void)state;
  static const char *const where[][2] = {
      {"[{low: [-1, -2], high: [1, 0.1]}]", "{low: [-0.6, -1.6], high: [0.6, -0.4]}"},
      {"[{low: [-2.1, -3.1], high: [0, 0.1]}]", "{low: [-1.6, -2.6], high: [-0.4, -0.4]}"},
      {"[{low: [-2, -2], high: [-1, 0]}, {low: [1, -2], high: [2, 0]}]",
       "{low: [-1.8, -1.6], high: [-1.2, -0.4]}"}};
  write_case("box.yaml", MEDIUM
             "loads: [{group: y1, pressure: 1 MPa}]\n"
             "probes: {inside: {quantity: stress, component: yy, region: {low: [0, 0], high: [1, "
             "1]}}}\n"
             "results: {stress: {of: inside, take: last}}\n" COUPLING(""));
  for (int w = 0; w < 3; w++) {
    char regions[128], probe[128];
    snprintf(regions, sizeof regions, "coupling.regions=%s", where[w][0]);
    snprintf(probe, sizeof probe, "probes.inside.region=%s", where[w][1]);
    const char *const override[] = {regions, probe, "mass_damping=280 1/s", "end=100 ms"};
    cdem_run_summary s;
    cdem_fault fault = {0};
    check_ok(run_case("box.yaml", "pressed", 4, override, &s, &fault));
    check_near(key_value(&s, "stress"), -1e6, 0.05, 0.0);
    cdem_run_summary_release(&s);
  }
}

/* ---- same bits ---- */

static const char *const written[] = {"history.csv", "body/body-000002.vtu",
                                      "grains/grains-000003.vtu",
                                      "projection/projection-000003.vtu", NULL};

static void threads_and_breaks_change_no_bit(void **state) {
  (void)state;
  static const char *const form[] = {"", ", form: virtual-work"};
  for (int f = 0; f < 2; f++) {
    cdem_fault fault = {0};
    char text[4000];
    snprintf(text, sizeof text, "%s", MEDIUM PLATE COUPLING(""));
    if (f == 1) {
      char *at = strstr(text, ", cycles: 5");
      snprintf(at, sizeof text - (size_t)(at - text), ", cycles: 5%s}\n", form[f]);
    }
    write_case("box.yaml", text);
    check_ok(run_until("whole", false, 1 << 30, 1, &fault));
    check_ok(run_until("team", false, 1 << 30, 2, &fault));
    check_fails(run_until("broken", false, 7, 1, &fault), CDEM_INTERRUPTED, "--resume");
    check_fails(run_until("broken", true, 15, 2, &fault), CDEM_INTERRUPTED, "--resume");
    check_ok(run_until("broken", true, 1 << 30, 1, &fault));
    check_same_files("whole", "team", written);
    check_same_files("whole", "broken", written);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bonded_grains_answer_like_grains_everywhere),
      cmocka_unit_test(tractions_and_supports_reach_grains),
      cmocka_unit_test(threads_and_breaks_change_no_bit),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
