/* Coupled cases with an absorbing layer: broken runs go on to the same bits, also where loads share
 * the applied forces with it; a rate of 0 is no layer; what is refused. */
#include "run/support.h"

static const char box[] =
    "end: 20 ms\n"
    "step: 50 us\n"
    "history_every: 1 ms\n"
    "frame_every: 10 ms\n"
    "mass_damping: 5 1/s\n"
    "mesh: {shape: quad4, count: [6, 3], size: [6 m, 3 m], origin: [-3 m, -3 m]}\n"
    "materials: {soil: {young: 100 MPa, poisson: 0.2, density: 2042 kg/m3}}\n"
    "supports: [{group: y0, displacement: {x: 0, y: 0}}]\n"
    "loads: [{group: y1, traction: {y: -10 kPa}}]\n"
    "grains:\n"
    "  dimension: 2\n"
    "  law: linear\n"
    "  packing: {kind: square, low: [-3 m, -3 m], high: [3 m, 0 m], radius: 0.1 m, "
    "centres_inside: yes}\n"
    "  materials: {grain: {density: 2600 kg/m3}}\n"
    "contacts: [{normal_stiffness: 1e8 N/m, shear_stiffness: 5e7 N/m, friction: 0.5, "
    "damping_ratio: 0.0}]\n"
    "coupling: {regions: [{low: [-1 m, -1 m], high: [1 m, 0.1 m]}], cycles: 4, absorb: 500}\n";

typedef struct {
  int calls, stop_at;
} stopper;

static bool report(void *context, const char *what, int64_t done, int64_t total) {
  stopper *s = context;
  (void)done;
  (void)total;
  if (strncmp(what, "running", 7) == 0)
    s->calls++;
  return s->calls < s->stop_at;
}

static cdem_status run_until(const char *folder, bool resume, int stop_at, cdem_fault *fault) {
  stopper stop = {.stop_at = stop_at};
  const cdem_progress progress = {.context = &stop, .report = report};
  return run_box(folder, resume, 1, &progress, fault);
}

static void a_continued_run_gives_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_case("box.yaml", box);
  check_ok(run_until("whole", false, 1 << 30, &fault));
  for (int stop_at = 2; stop_at < 6; stop_at += 3) {
    check_fails(run_until("broken", false, stop_at, &fault), CDEM_INTERRUPTED, "continue with");
    check_ok(run_until("broken", true, 1 << 30, &fault));
    assert_true(same_files("whole/history.csv", "broken/history.csv"));
  }
}

static void a_rate_of_zero_is_no_layer(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_run_summary summary;
  char without[sizeof box];
  const char *const zero[] = {"coupling.absorb=0"};
  write_case("box.yaml", box);
  strcpy(without, box);
  strcpy(strstr(without, ", absorb"), "}\n");
  write_case("without.yaml", without);
  check_ok(run_case("box.yaml", "with", 0, NULL, &summary, &fault));
  cdem_run_summary_release(&summary);
  check_ok(run_case("box.yaml", "zero", 1, zero, &summary, &fault));
  cdem_run_summary_release(&summary);
  check_ok(run_case("without.yaml", "none", 0, NULL, &summary, &fault));
  cdem_run_summary_release(&summary);
  assert_true(same_files("zero/history.csv", "none/history.csv"));
  assert_false(same_files("with/history.csv", "none/history.csv"));
}

static void bad_layers_are_refused(void **state) {
  (void)state;
  write_case("box.yaml", box);
  check_bad("box.yaml", "coupling.absorb=1e6", "is stable up to");
  check_bad("box.yaml", "coupling.absorb_layers=0", "absorb_layers");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_continued_run_gives_the_same_bits),
      cmocka_unit_test(a_rate_of_zero_is_no_layer),
      cmocka_unit_test(bad_layers_are_refused),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
