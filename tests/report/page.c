/* Pages of runs made by hand: what is said of them, what is escaped, what is refused. */
#include "report/report.h"
#include "run/support.h"

#define CASE                                                                                       \
  "title: 'Rock & <roll> \"µ\"'\nend: 2 s\n"                                                      \
  "mesh: {shape: quad4, count: [1, 1], size: [1 m, 1 m]}\n"                                        \
  "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}}\n"                       \
  "supports:\n  - {group: x0, displacement: {x: 0}}\n  - {group: y0, displacement: {y: 0}}\n"      \
  "probes: {tip: {group: x1, quantity: displacement, component: x}}\n"                             \
  "curves: {pull: {title: 'k_1 < 2', x: tip, y: support}}\n"                                       \
  "results: {top: {of: support, take: max, reference: 4, tolerance: 0.1}}\n"
#define HISTORY                                                                                    \
  "time [s],elastic [J],damping [J],support [J],energy_error,probe.tip [m]\n"                      \
  "0,0,0,0,0,0\n0.5,1,0.5,1.5,0.001,1\n1,3,0.75,4,0.0625,2\n"
#define SUMMARY(difference)                                                                        \
  "{\"program\": \"cdem\", \"version\": \"9.9<9\", \"commit\": \"abc\", \"threads\": 2, "          \
  "\"wall_time\": 725, \"steps\": 12, \"novel_count\": 7, \"warnings\": [\"a <b> warning\"], "     \
  "\"results\": {\"top\": {\"value\": 4, \"unit\": \"J\", \"reference\": 4, "                      \
  "\"difference\": " difference ", \"tolerance\": 0.1}}}\n"

static char *page;

static int forget(void **state) {
  (void)state;
  free(page);
  page = NULL;
  return 0;
}

/* scratch/run with these files; NULL: none. */
static void make_run(const char *cases, const char *history, const char *summary) {
  char command[200];
  snprintf(command, sizeof command, "rm -rf '%s'", in_scratch("run"));
  assert_int_equal(system(command), 0);
  assert_int_equal(mkdir(in_scratch("run"), 0777), 0);
  if (cases != NULL)
    write_case("run/case.yaml", cases);
  if (history != NULL)
    write_case("run/history.csv", history);
  if (summary != NULL)
    write_case("run/summary.json", summary);
}

static cdem_status report(const char *path, cdem_report_made *made, cdem_fault *fault) {
  const cdem_report_options options = {
      .folder = in_scratch("run"), .path = path, .version = "test", .commit = "test"};
  return cdem_report(&options, made, fault);
}

/* The page of scratch/run into `page`. */
static cdem_report_made make_page(void) {
  cdem_fault fault = {0};
  cdem_report_made made = {0};
  check_ok(report(NULL, &made, &fault));
  assert_string_equal(made.path, in_scratch("run/report.html"));
  check_ok(cdem_read_text(made.path, &page, &fault));
  assert_int_equal(strlen(page), made.bytes);
  return made;
}

static void check_says(const char *text) {
  if (strstr(page, text) == NULL)
    fail_msg("the page does not hold '%s'", text);
}

static void check_silent(const char *text) {
  const char *found = strstr(page, text);
  if (found != NULL)
    fail_msg("the page holds '%s': '%.80s'", text, found);
}

/* ---- what is said ---- */

static void an_ended_run_is_judged(void **state) {
  (void)state;
  make_run(CASE, HISTORY, SUMMARY("0.05"));
  cdem_report_made made = make_page();
  assert_true(made.finished);
  /* the curve of the case, three sides of the book and its error */
  assert_int_equal(made.charts, 5);
  assert_int_equal(made.pictures, 0);
  check_says("class=\"badge good\">within</span> The key result with a tolerance is within it.");
  check_says("against its reference 4\u00a0J, a difference of +5 %");
  check_says("<td>12 min 5 s</td>");
  check_says("<th scope=\"row\">novel count</th><td>7</td>"); /* unknown here, shown all the same */
  check_says("<code>young</code></th><td>30\u00a0GPa</td>");
  check_says("-again --threads 2\ncdem compare ");
}

static void a_result_that_is_off_is_said_first(void **state) {
  (void)state;
  make_run(CASE, HISTORY, SUMMARY("-0.25"));
  make_page();
  check_says("class=\"badge bad\">off</span> 1 of 1 key results with a tolerance is off");
  check_says("a difference of −25 %");
}

static void a_result_without_a_value_is_off(void **state) {
  (void)state;
  make_run(CASE, HISTORY, SUMMARY("null"));
  make_page();
  check_says("class=\"badge bad\">off</span> 1 of 1");
}

/* stored 3 + dissipated 0.75 - work 4 = -0.25, by the largest term 4. */
static void the_book_is_added_up(void **state) {
  (void)state;
  make_run(CASE, HISTORY, SUMMARY("0"));
  make_page();
  check_says("Open: stored + dissipated − work</th><td></td><td "
             "class=\"number\">−250\u00a0mJ</td><td class=\"number\">−6.25 %</td>");
  check_says("<b>0.0625</b> of the largest term");
}

static void what_others_wrote_is_escaped(void **state) {
  (void)state;
  make_run(CASE, HISTORY, SUMMARY("0"));
  make_page();
  check_says("<h1>Rock &amp; &lt;roll&gt; &quot;µ&quot;</h1>");
  check_says("a &lt;b&gt; warning");
  check_says("9.9&lt;9");
  check_says("k<sub>1</sub> &lt; 2");
  check_silent("<roll>");
  check_silent("<b> warning");
}

static void a_run_that_has_not_ended_says_so(void **state) {
  (void)state;
  make_run(CASE, HISTORY, NULL);
  write_case("run/checkpoint.h5", "x");
  cdem_report_made made = make_page();
  assert_false(made.finished);
  check_says(
      "class=\"badge open\">not ended</span> The run has not ended: its history reaches to t = "
      "1\u00a0s of 2\u00a0s (50 %).");
  check_says("<code>cdem run --resume ");
  check_silent("id=\"results\"");
  check_says("id=\"balances\"");
}

/* The last row was being written when the run was killed. */
static void a_broken_last_row_is_passed_over(void **state) {
  (void)state;
  make_run(CASE, HISTORY "1.5,4,1,", NULL);
  make_page();
  check_says("reaches to t = 1\u00a0s");
}

static void a_run_without_rows_has_a_page(void **state) {
  (void)state;
  make_run(CASE, NULL, NULL);
  write_case("run/checkpoint.h5", "x");
  make_page();
  check_says("it has no history yet");
  check_silent("id=\"figures\"");
  check_silent("id=\"balances\"");
}

/* ---- pictures and links ---- */

static void write_bytes(const char *name, int64_t bytes) {
  FILE *file = fopen(in_scratch(name), "w");
  assert_non_null(file);
  for (int64_t i = 0; i < bytes; i++)
    putc('x', file);
  assert_int_equal(fclose(file), 0);
}

/* The smaller of two kinds is put inside; what the page draws itself is not put in twice; what is
 * too large is linked. */
static void pictures_are_put_inside(void **state) {
  (void)state;
  make_run(CASE, HISTORY, SUMMARY("0"));
  mkdir(in_scratch("run/figures"), 0777);
  write_case("run/figures/map.svg", "<svg>a long picture, longer than the other</svg>");
  write_case("run/figures/map.png", "foobar");
  write_case("run/figures/map.gp", "# script");
  write_case("run/figures/pull.png", "drawn by the page");
  write_case("run/figures/energies.png", "drawn by the page");
  write_bytes("run/figures/huge.png", 4000001);
  cdem_report_made made = make_page();
  assert_int_equal(made.pictures, 1);
  assert_int_equal(made.linked, 1);
  check_says("src=\"data:image/png;base64,Zm9vYmFy\"");
  check_says("Too large to be put into this page: <a href=\"figures/huge.png\">huge</a>.");
  check_silent("figures/pull.png");
  check_silent("image/svg+xml");
}

static void links_lead_from_the_page(void **state) {
  (void)state;
  static const char *const place[][2] = {{"page.html", "run/"},
                                         {"run/page.html", ""},
                                         {"other/deep er/page.html", "../../run/"},
                                         {"runner/page.html", "../run/"}};
  make_run(CASE, HISTORY, SUMMARY("0"));
  mkdir(in_scratch("other"), 0777);
  mkdir(in_scratch("other/deep er"), 0777);
  mkdir(in_scratch("runner"), 0777);
  for (size_t i = 0; i < sizeof place / sizeof place[0]; i++) {
    cdem_fault fault = {0};
    cdem_report_made made;
    char link[128];
    check_ok(report(in_scratch(place[i][0]), &made, &fault));
    free(page);
    check_ok(cdem_read_text(made.path, &page, &fault));
    snprintf(link, sizeof link, "<a href=\"%shistory.csv\">", place[i][1]);
    check_says(link);
  }
}

/* ---- what is refused ---- */

static void check_refused(cdem_status status, const char *text) {
  cdem_fault fault = {0};
  cdem_report_made made;
  check_fails(report(NULL, &made, &fault), status, text);
  assert_false(is_there("run/report.html"));
}

static void what_is_broken_is_named(void **state) {
  (void)state;
  make_run(CASE, NULL, NULL);
  check_refused(CDEM_INPUT, "is no folder of a run");
  make_run(NULL, HISTORY, SUMMARY("0"));
  check_refused(CDEM_INPUT, "lacks its case.yaml");
  make_run("title: [\n", HISTORY, SUMMARY("0"));
  check_refused(CDEM_INPUT, "run/case.yaml:");
  make_run(CASE, HISTORY, "{\"wall_time\": 2, \"results\": {");
  check_refused(CDEM_INPUT, "run/summary.json:");
  make_run(CASE, "time [s],elastic [J]\n0,1\n1,x\n", SUMMARY("0"));
  check_refused(CDEM_INPUT, "line 3: 'x' is not a number");
  make_run(CASE, NULL, SUMMARY("0"));
  check_refused(CDEM_FILE, "its history.csv is gone");
  make_run(CASE, HISTORY, SUMMARY("0"));
  mkdir(in_scratch("run/figures"), 0777);
  mkdir(in_scratch("run/figures/map.png"), 0777);
  make_page(); /* a folder is no picture */
}

static void an_earlier_page_survives_a_failure(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_report_made made;
  make_run(CASE, HISTORY, SUMMARY("0"));
  write_case("run/report.html", "earlier");
  write_case("run/summary.json", "{");
  check_fails(report(NULL, &made, &fault), CDEM_INPUT, "summary.json");
  assert_true(holds("run/report.html", "earlier"));
  write_case("run/summary.json", SUMMARY("0"));
  check_fails(report(in_scratch("nowhere/page.html"), &made, &fault), CDEM_FILE,
              "nowhere/page.html': No such file or directory; create the folder first");
}

static void no_allocation_is_taken_for_granted(void **state) {
  (void)state;
  cdem_status status = CDEM_MEMORY;
  make_run(CASE, HISTORY, SUMMARY("0"));
  for (int64_t n = 0; status == CDEM_MEMORY; n += n < 200 ? 1 : 37) {
    cdem_fault fault = {0};
    cdem_report_made made;
    cdem_memory_fail_after(n);
    status = report(NULL, &made, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || fault.message[0] != '\0');
  }
  assert_int_equal(status, CDEM_OK);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_teardown(an_ended_run_is_judged, forget),
      cmocka_unit_test_teardown(a_result_that_is_off_is_said_first, forget),
      cmocka_unit_test_teardown(a_result_without_a_value_is_off, forget),
      cmocka_unit_test_teardown(the_book_is_added_up, forget),
      cmocka_unit_test_teardown(what_others_wrote_is_escaped, forget),
      cmocka_unit_test_teardown(a_run_that_has_not_ended_says_so, forget),
      cmocka_unit_test_teardown(a_broken_last_row_is_passed_over, forget),
      cmocka_unit_test_teardown(a_run_without_rows_has_a_page, forget),
      cmocka_unit_test_teardown(pictures_are_put_inside, forget),
      cmocka_unit_test_teardown(links_lead_from_the_page, forget),
      cmocka_unit_test_teardown(what_is_broken_is_named, forget),
      cmocka_unit_test_teardown(an_earlier_page_survives_a_failure, forget),
      cmocka_unit_test_teardown(no_allocation_is_taken_for_granted, forget),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
