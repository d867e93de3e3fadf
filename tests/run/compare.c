/* Finished runs side by side: numbers out of rows made by hand, differences, what is missing, and
 * each error with its remedy. */
#include "run/compare.h"

#include "cases/case.h"
#include "run/support.h"
#include "run/take.h"

/* ---- one number out of a history ---- */

/* time 0 .. 4, v = 3 1 4 1 5, w = 10 20 (none) 40 50 */
static void make_rows(cdem_table *table) {
  static const double v[] = {3, 1, 4, 1, 5}, w[] = {10, 20, NAN, 40, 50};
  cdem_fault fault = {0};
  check_ok(cdem_table_add_column(table, "time", CDEM_COLUMN_REAL, "s", &fault));
  check_ok(cdem_table_add_column(table, "v", CDEM_COLUMN_REAL, "N", &fault));
  check_ok(cdem_table_add_column(table, "w", CDEM_COLUMN_REAL, "m", &fault));
  for (int i = 0; i < 5; i++) {
    check_ok(cdem_table_add_row(table, &fault));
    cdem_table_set_real(table, 0, i);
    cdem_table_set_real(table, 1, v[i]);
    cdem_table_set_real(table, 2, w[i]);
  }
}

static void each_take_is_what_it_says(void **state) {
  (void)state;
  cdem_table table = {0};
  make_rows(&table);
  const int v = 1, w = 2, both[2] = {1, 2};
  const struct {
    int take, columns;
    const int *column;
    double factor, from, to;
    int along;
    double expected;
  } sample[] = {
      {CDEM_TAKE_MAX, 1, &v, 1, NAN, NAN, 0, 5},
      {CDEM_TAKE_MAX, 1, &v, 1, NAN, 3, 0, 4},
      {CDEM_TAKE_MIN, 1, &v, -2, NAN, NAN, 0, -10},
      {CDEM_TAKE_LAST, 1, &v, 1, NAN, 2, 0, 4},
      {CDEM_TAKE_MEAN, 1, &v, 1, NAN, NAN, 0, 2.8},
      {CDEM_TAKE_MEAN, 1, &w, 1, NAN, NAN, 0, 30},
      {CDEM_TAKE_MEAN, 1, &w, 1, 1.5, 2.5, 0, NAN},
      {CDEM_TAKE_SLOPE, 1, &v, 1, NAN, NAN, 0, 0.4},
      /* squares about 2.8: 0.04 3.24 1.44 3.24 4.84 */
      {CDEM_TAKE_SCATTER, 1, &v, 1, NAN, NAN, 0, 1.7888543819998317},
      {CDEM_TAKE_SCATTER, 1, &v, -3, NAN, NAN, 0, 5.3665631459994954},
      {CDEM_TAKE_SCATTER, 1, &v, 1, 3.5, NAN, 0, NAN}, /* one row */
      {CDEM_TAKE_PLACE_OF_MAX, 1, &v, 1, NAN, NAN, 0, 4},
      {CDEM_TAKE_PLACE_OF_MAX, 1, &v, -1, NAN, NAN, 0, 1}, /* the first of two */
      {CDEM_TAKE_PLACE_OF_MIN, 1, &v, 1, 2, NAN, 2, 40},
      {CDEM_TAKE_PLACE_OF_MAX, 1, &v, 1, NAN, 3, 2, NAN}, /* w has no value there */
      {CDEM_TAKE_PLACE_OF_MAX, 1, &v, 1, 9, NAN, 0, NAN},
      {CDEM_TAKE_PLACE_OF_MIN, 2, both, 1, NAN, NAN, 1, 3}, /* sums 13 21 - 41 55 */
  };
  for (size_t i = 0; i < sizeof sample / sizeof sample[0]; i++) {
    const cdem_run_taking taking = {.take = sample[i].take,
                                    .from = sample[i].from,
                                    .to = sample[i].to,
                                    .factor = sample[i].factor,
                                    .columns = sample[i].columns,
                                    .column = sample[i].column,
                                    .along = sample[i].along};
    double found = cdem_run_take(&table, &taking);
    if (isnan(sample[i].expected) ? !isnan(found)
                                  : !(fabs(found - sample[i].expected) <= 1e-14 * fabs(found)))
      fail_msg("sample %zu: %.17g, expected %.17g", i, found, sample[i].expected);
  }
  cdem_table_release(&table);
}

/* A mean of 1e9 hides nothing: 1e9 + (0 1 2) scatters by 1, whatever the first row was. */
static void scatter_keeps_its_digits(void **state) {
  (void)state;
  cdem_table table = {0};
  cdem_fault fault = {0};
  check_ok(cdem_table_add_column(&table, "v", CDEM_COLUMN_REAL, "", &fault));
  for (int i = 0; i < 300; i++) {
    check_ok(cdem_table_add_row(&table, &fault));
    cdem_table_set_real(&table, 0, 1e9 + i % 3);
  }
  const int column = 0;
  const cdem_run_taking taking = {.take = CDEM_TAKE_SCATTER,
                                  .from = NAN,
                                  .to = NAN,
                                  .factor = 1.0,
                                  .columns = 1,
                                  .column = &column};
  check_near(cdem_run_take(&table, &taking), sqrt(200.0 / 299.0), 1e-9, 0);
  cdem_table_release(&table);
}

/* ---- runs made by hand ---- */

static void make_run(const char *folder, const char *summary, const char *history) {
  char name[64];
  mkdir(in_scratch(folder), 0777);
  snprintf(name, sizeof name, "%s/summary.json", folder);
  write_case(name, summary);
  snprintf(name, sizeof name, "%s/history.csv", folder);
  if (history != NULL)
    write_case(name, history);
}

#define SETTINGS                                                                                   \
  "\"settings\": {\"results\": {\"load\": {\"of\": \"force\", \"take\": \"mean\", \"from\": 1, "   \
  "\"to\": null, \"factor\": -1}, \"peak\": {\"of\": \"force\", \"take\": \"min\"}}}}\n"

static void make_two(void) {
  make_run("a",
           "{\"wall_time\": 2, \"results\": {\n"
           "\"load\": {\"value\": 20, \"unit\": \"N\", \"reference\": null},\n"
           "\"peak\": {\"value\": -30, \"unit\": \"N\"}, \"old\": {\"value\": 0, \"unit\": \"\"}},"
           "\n" SETTINGS,
           "time [s],force [N],probe.tip [m]\n0,-90,1\n1,-10,2\n2,-20,3\n3,-30,\n");
  make_run("b",
           "{\"wall_time\": 3, \"results\": {\n"
           "\"load\": {\"value\": 22, \"unit\": \"N\"}, \"peak\": {\"value\": -33, \"unit\": "
           "\"N\"},\n\"new\": {\"value\": 7.5, \"unit\": \"m\"}},\n" SETTINGS,
           "time [s],force [N]\n0,-80\n1,-22\n2,-22\n");
}

static cdem_status compare(int runs, const char *const *folder, int columns,
                           const char *const *column, double from, double to,
                           cdem_comparison *comparison, cdem_fault *fault) {
  const char *path[4];
  for (int r = 0; r < runs; r++)
    path[r] = in_scratch(folder[r]);
  const cdem_compare_options options = {
      .runs = runs, .folder = path, .columns = columns, .column = column, .from = from, .to = to};
  return cdem_compare(&options, comparison, fault);
}

static void check_row(const cdem_comparison *c, int64_t row, const char *name, const char *unit,
                      const double expected[5]) {
  const cdem_compared *a = &c->row[row].run[0], *b = &c->row[row].run[1];
  const double found[5] = {a->value, a->scatter, b->value, b->scatter, b->difference};
  assert_string_equal(c->row[row].name, name);
  assert_string_equal(c->row[row].unit, unit);
  assert_true(isnan(a->difference));
  for (int k = 0; k < 5; k++)
    if (isnan(expected[k]) ? !isnan(found[k])
                           : !(fabs(found[k] - expected[k]) <= 1e-14 * fabs(found[k])))
      fail_msg("%s, number %d: %.17g, expected %.17g", name, k, found[k], expected[k]);
}

static void two_runs_stand_side_by_side(void **state) {
  (void)state;
  const char *const folder[] = {"a", "b/"}, *const column[] = {"force", "tip"};
  cdem_comparison c = {0};
  cdem_fault fault = {0};
  make_two();
  check_ok(compare(2, folder, 2, column, 0.5, 2.5, &c, &fault));
  assert_int_equal(c.rows, 7);
  assert_string_equal(c.run[0], "a");
  assert_string_equal(c.run[1], "b");
  check_row(&c, 0, "load", "N", (double[]){20, 10, 22, 0, 0.1});
  check_row(&c, 1, "peak", "N", (double[]){-30, NAN, -33, NAN, -0.1});
  check_row(&c, 2, "old", "", (double[]){0, NAN, NAN, NAN, NAN});
  check_row(&c, 3, "new", "m", (double[]){NAN, NAN, 7.5, NAN, NAN});
  check_row(&c, 4, "force", "N", (double[]){-15, sqrt(50), -22, 0, -7.0 / 15});
  check_row(&c, 5, "tip", "m", (double[]){2.5, sqrt(0.5), NAN, NAN, NAN});
  check_row(&c, 6, "wall_time", "s", (double[]){2, NAN, 3, NAN, 0.5});
  cdem_comparison_release(&c);
}

/* Alike folders of different places are called by their whole paths. */
static void names_tell_runs_apart(void **state) {
  (void)state;
  const char *const folder[] = {"a", "b", "other/a"};
  cdem_comparison c = {0};
  cdem_fault fault = {0};
  make_two();
  mkdir(in_scratch("other"), 0777);
  make_run("other/a", "{\"wall_time\": 2, \"results\": {}}\n", NULL);
  check_ok(compare(3, folder, 0, NULL, NAN, NAN, &c, &fault));
  assert_string_equal(c.run[0], in_scratch("a"));
  assert_string_equal(c.run[2], in_scratch("other/a"));
  assert_true(isnan(c.row[0].run[2].value));
  cdem_comparison_release(&c);
}

static void no_allocation_is_taken_for_granted(void **state) {
  (void)state;
  const char *const folder[] = {"a", "b"}, *const column[] = {"force"};
  cdem_status status = CDEM_MEMORY;
  make_two();
  for (int64_t n = 0; status == CDEM_MEMORY; n++) {
    cdem_comparison c = {0};
    cdem_fault fault = {0};
    char *text = NULL;
    cdem_memory_fail_after(n);
    status = compare(2, folder, 1, column, NAN, NAN, &c, &fault);
    if (status == CDEM_OK)
      status = cdem_comparison_json(&c, &text, &fault);
    cdem_memory_fail_after(-1);
    free(text);
    cdem_comparison_release(&c);
  }
  assert_int_equal(status, CDEM_OK);
}

/* ---- errors ---- */

static void check_refused(const char *folder, cdem_status status, const char *text) {
  const char *const both[] = {"a", folder};
  cdem_comparison c = {0};
  cdem_fault fault = {0};
  check_fails(compare(2, both, 0, NULL, NAN, NAN, &c, &fault), status, text);
}

static void what_is_no_run_is_named(void **state) {
  (void)state;
  make_two();
  check_refused("absent", CDEM_INPUT, "there is no folder");
  check_refused("a/history.csv", CDEM_INPUT, "is a file");
  mkdir(in_scratch("plain"), 0777);
  check_refused("plain", CDEM_INPUT, "is no folder of a run");
  write_case("plain/checkpoint.h5", "x");
  check_refused("plain", CDEM_INPUT, "has not ended");
}

static void broken_summaries_are_shown(void **state) {
  (void)state;
  static const struct {
    const char *text, *said;
  } sample[] = {
      {"", "it is empty"},
      {"{\"wall_time\": 2, \"results\": {\"x\": {\"value\": 1", "did not find expected"},
      {"no summary\n", "this is a text; a summary is a map"},
      {"{\"results\": {}}\n", "there is no 'wall_time'"},
      {"{\"wall_time\": 2}\n", "there is no 'results'"},
      {"{\"wall_time\": 2, \"results\": []}\n", "'results' is a list, not a map"},
      {"{\"wall_time\": fast, \"results\": {}}\n", "'fast' is not a number"},
      {"{\"wall_time\": 1e999, \"results\": {}}\n", "'1e999' is not a number"},
      {"{\"wall_time\": 2, \"results\": {\"x\": 1}}\n", "there is no 'value'"},
      {"{\"wall_time\": 2, \"wall_time\": 3, \"results\": {}}\n", "was given already"},
  };
  make_two();
  for (size_t i = 0; i < sizeof sample / sizeof sample[0]; i++) {
    make_run("broken", sample[i].text, NULL);
    check_refused("broken", CDEM_INPUT, sample[i].said);
    check_refused("broken", CDEM_INPUT, "run the case again");
  }
}

static void what_does_not_fit_is_named(void **state) {
  (void)state;
  const char *const folder[] = {"a", "b"}, *const wrong = "forse", *const right = "force";
  cdem_comparison c = {0};
  cdem_fault fault = {0};
  make_two();
  check_fails(compare(2, folder, 1, &wrong, NAN, NAN, &c, &fault), CDEM_INPUT,
              "no run has a column 'forse' in its history.csv; did you mean 'force'?");
  check_fails(compare(2, folder, 1, &right, 5, 6, &c, &fault), CDEM_INPUT,
              "from 5 s to 6 s; the histories reach from 0 s to 3 s");
  make_run("pressed",
           "{\"wall_time\": 2, \"results\": {\"peak\": {\"value\": 1, \"unit\": \"Pa\"}}}",
           "time [s],force [kN]\n0,1\n");
  check_refused("pressed", CDEM_INPUT, "it has N in 'a' and Pa in 'pressed'");
  make_run("lost",
           "{\"wall_time\": 2, \"results\": {\"load\": {\"value\": 1, \"unit\": \"N\"}}," SETTINGS,
           NULL);
  check_refused("lost", CDEM_FILE, "lost/history.csv");
  make_run("lost",
           "{\"wall_time\": 2, \"results\": {\"load\": {\"value\": 1, \"unit\": \"N\"}}," SETTINGS,
           "time [s]\n0\n");
  check_refused("lost", CDEM_INPUT, "has no column 'force', of which 'load' is the mean");
}

/* ---- as text ---- */

static void values_are_written_with_their_scatter(void **state) {
  (void)state;
  static const struct {
    double value, scatter;
    const char *text;
  } sample[] = {
      {1.684e6, 2.1e4, "1.684e6 ± 2.1e4"},
      {123.456, 0.0123, "123.456 ± 0.012"},
      {-0.0251, 3e-5, "-0.025100 ± 3.0e-5"},
      {0.5, 12, "0.5000 ± 12"},
      {0, 0.25, "0 ± 0.25"},
      {9.81, 0, "9.81 ± 0"},
      {1e-7, NAN, "1e-7"},
      {-2.5e-12, NAN, "-2.5e-12"},
      {1234567.8, NAN, "1.23457e6"},
      {NAN, NAN, ""},
      {NAN, 1, ""},
      {1234.4, 1.5, "1234.4 ± 1.5"},
      {1e300, 1e-300, "1.00000000e300 ± 1.0e-300"},
  };
  for (size_t i = 0; i < sizeof sample / sizeof sample[0]; i++) {
    char text[CDEM_COMPARED_TEXT];
    const cdem_compared compared = {.value = sample[i].value, .scatter = sample[i].scatter};
    cdem_compared_text(&compared, text);
    assert_string_equal(text, sample[i].text);
  }
}

/* ---- a whole run ---- */

/* summary.json says what the run has found, and a place is where its history has it. */
static void a_run_comes_back_as_it_was(void **state) {
  (void)state;
  cdem_run_summary summary;
  cdem_summary_file kept = {0};
  cdem_table rows = {0};
  cdem_fault fault = {0};
  write_case("bar.yaml",
             "end: 0.2 ms\nmesh: {shape: quad4, count: [4, 2], size: [1 m, 0.5 m]}\n"
             "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}}\n"
             "supports: [{group: x0, displacement: {x: 0, y: 0}}]\n"
             "loads: [{group: x1, traction: {x: {pulse: 1 MPa, duration: 0.1 ms}}}]\n"
             "probes: {tip: {group: x1, quantity: displacement, component: x}}\n"
             "results:\n  where: {of: kinetic, take: place_of_max, along: tip, factor: 7}\n"
             "  when: {of: kinetic, take: place_of_max}\n"
             "  swing: {of: tip, take: scatter, from: 0.1 ms}\n"
             "  mean: {of: tip, take: mean, from: 0.1 ms, factor: 1000}\n");
  check_ok(run_case("bar.yaml", "bar", 0, NULL, &summary, &fault));
  check_ok(cdem_read_summary(in_scratch("bar/summary.json"), &kept, &fault));
  check_ok(cdem_read_history(in_scratch("bar/history.csv"), &rows, &fault));
  static const char *const unit[] = {"m", "s", "m", ""};
  int64_t best = 0;
  int kinetic = cdem_table_find(&rows, "kinetic"), tip = cdem_table_find(&rows, "probe.tip");
  for (int64_t r = 0; r < rows.rows; r++)
    if (cdem_table_at(&rows, r, kinetic)->real > cdem_table_at(&rows, best, kinetic)->real)
      best = r;
  assert_int_equal(kept.results, 4);
  assert_true(kept.wall_time == summary.wall);
  assert_true(key_value(&summary, "where") == cdem_table_at(&rows, best, tip)->real);
  assert_true(key_value(&summary, "when") == cdem_table_at(&rows, best, 0)->real);
  assert_true(key_value(&summary, "swing") > 0.0);
  for (int i = 0; i < 4; i++) {
    assert_true(kept.result[i].value == key_value(&summary, kept.result[i].name));
    assert_string_equal(kept.result[i].unit, unit[i]);
  }
  assert_string_equal(kept.result[3].take, "mean");
  assert_true(kept.result[3].from == 1e-4 && isnan(kept.result[3].to));
  assert_true(kept.result[3].factor == 1000.0);
  cdem_table_release(&rows);
  cdem_summary_file_release(&kept);
  cdem_run_summary_release(&summary);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_take_is_what_it_says),
      cmocka_unit_test(scatter_keeps_its_digits),
      cmocka_unit_test(two_runs_stand_side_by_side),
      cmocka_unit_test(names_tell_runs_apart),
      cmocka_unit_test(no_allocation_is_taken_for_granted),
      cmocka_unit_test(what_is_no_run_is_named),
      cmocka_unit_test(broken_summaries_are_shown),
      cmocka_unit_test(what_does_not_fit_is_named),
      cmocka_unit_test(values_are_written_with_their_scatter),
      cmocka_unit_test(a_run_comes_back_as_it_was),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
