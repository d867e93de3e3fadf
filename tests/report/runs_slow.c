/* Whole runs of every engine: the book that a page shows has all terms. A term that is missing,
 * counted twice or on the wrong side leaves an error of its own size; what the run itself found
 * missing is 1e-3 of the largest term or less. */
#include "report/report.h"
#include "run/book.h"
#include "run/deformable_tube.h"
#include "run/support.h"

static const char body[] =
    "end: 1 ms\n"
    "safety: 0.1\n"
    "mesh: {shape: tri3, count: [6, 3], size: [1 m, 0.5 m]}\n"
    "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}}\n"
    "blocks: {breakable: body}\n"
    "interfaces: [{insertion: penalty, tension: 0.2 MPa, cohesion: 1 MPa, friction: 0.3, "
    "softening: "
    "linear, energy_1: 1 J/m2, energy_2: 10 J/m2}]\n"
    "contact: {friction: 0.3}\n"
    "mass_damping: 200 1/s\n"
    "gravity: [0, -9.81 m/s2]\n"
    "quiet: [y0]\n"
    "supports: [{group: x0, displacement: {x: 0, y: 0}}]\n"
    "loads: [{group: x1, traction: {x: {pulse: 2 MPa, duration: 0.4 ms}}}]\n";

static const char tube[] = "end: 0.4 ms\n" DEFORMABLE_TUBE;

static void run(const char *path, int overrides, const char *const *override) {
  cdem_fault fault = {0};
  cdem_run_summary summary;
  const cdem_run_options options = {.path = path,
                                    .folder = in_scratch("run"),
                                    .overrides = overrides,
                                    .override = override,
                                    .threads = 1,
                                    .version = "test",
                                    .commit = "test"};
  check_ok(cdem_run(&options, &summary, &fault));
  cdem_run_summary_release(&summary);
}

static double last(const cdem_table *history, const char *name) {
  int column = cdem_table_find(history, name);
  assert_true(column >= 0);
  return cdem_table_at(history, history->rows - 1, column)->real;
}

/* The sums over the columns are those from which the run's own error was made. The last digits of
 * sums of large terms are lost in it. */
static void check_book(int64_t fewest, bool coupled) {
  cdem_fault fault = {0};
  cdem_table history = {0};
  cdem_report_made made;
  check_ok(cdem_read_history(in_scratch("run/history.csv"), &history, &fault));
  double open = coupled ? last(&history, "exchange") : 0.0, scale = 0.0;
  int64_t terms = 0;
  for (int of = 0; of < CDEM_BOOKS; of++) {
    const cdem_run_book book = cdem_run_book_sum(&history, (cdem_book_of)of);
    open += book.open;
    scale = fmax(scale, book.scale);
    terms += book.terms;
  }
  double error = last(&history, "energy_error");
  cdem_table_release(&history);
  assert_true(terms >= fewest && scale > 0.0);
  check_below(error, 1e-3);
  check_near(fabs(open) / scale, error, 0.01, 1e-12);
  const cdem_report_options options = {
      .folder = in_scratch("run"), .version = "test", .commit = "test"};
  check_ok(cdem_report(&options, &made, &fault));
  assert_true(made.finished && made.charts >= 3);
}

static void a_body_is_accounted_for(void **state) {
  (void)state;
  write_case("body.yaml", body);
  run(in_scratch("body.yaml"), 0, NULL);
  check_book(12, false);
}

static void grains_are_accounted_for(void **state) {
  (void)state;
  static const char *const few[] = {"grains.packing.count=60",
                                    "end=0.3 s",
                                    "walls.gate.stop=0.1 s",
                                    "results.flow.from=0.2 s",
                                    "results.packed.from=0.2 s",
                                    "results.flow.tolerance=100",
                                    "safety=0.05"};
  run(CDEM_DATA "/cases/hopper.yaml", 7, few);
  check_book(11, false);
}

static void deformable_grains_are_accounted_for(void **state) {
  (void)state;
  write_case("tube.yaml", tube);
  run(in_scratch("tube.yaml"), 0, NULL);
  check_book(11, false);
}

static void a_coupled_run_is_accounted_for(void **state) {
  (void)state;
  static const char *const brief[] = {
      "end=12 ms",
      "results.load.from=10 ms",
      "results.load_scatter.from=10 ms",
      "results.volumetric_stress.from=10 ms",
      "results.effective_stress.from=10 ms",
      "results.volumetric_strain.from=10 ms",
      "results.effective_strain.from=10 ms",
  };
  run(CDEM_DATA "/cases/foundation-a.yaml", sizeof brief / sizeof brief[0], brief);
  check_book(24, true);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_body_is_accounted_for),
      cmocka_unit_test(grains_are_accounted_for),
      cmocka_unit_test(deformable_grains_are_accounted_for),
      cmocka_unit_test(a_coupled_run_is_accounted_for),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
