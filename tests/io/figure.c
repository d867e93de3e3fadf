/* Figures: gnuplot's files are whole or not there, names need no quoting, failures are told. */
#include "io/figure.h"

#include "io/support.h"

enum { POINTS = 101 };

static double x[POINTS], y[3][POINTS];

/* Two panels: curves with a gap, one without any point, a guide line, names with quotes. */
static cdem_figure make(cdem_panel panel[2], cdem_curve curve[4]) {
  for (int i = 0; i < POINTS; i++) {
    x[i] = i / 100.0;
    y[0][i] = sin(6 * x[i]);
    y[1][i] = i >= 40 && i < 50 ? NAN : 1e9 * cos(6 * x[i]);
    y[2][i] = NAN;
  }
  curve[0] = (cdem_curve){"it's a 'sine'", x, y[0], POINTS, 0};
  curve[1] = (cdem_curve){"k_1 \"broken\"\nline", x, y[1], POINTS, 9};
  curve[2] = (cdem_curve){NULL, x, y[2], POINTS, -1};
  panel[0] = (cdem_panel){"first", "x (m)", "y", 1, &curve[0], 0.0, 0.0};
  panel[1] = (cdem_panel){"second", "ν", "stiffness (N/m)", 2, &curve[1], -2e9, 2e9};
  return (cdem_figure){"two", 2, 2, panel};
}

static bool have_gnuplot(void) {
  return system("gnuplot --version >/dev/null 2>&1") == 0;
}

static int width_of_png(const char *path) {
  size_t bytes = 0;
  unsigned char *data = (unsigned char *)read_whole(path, &bytes);
  assert_non_null(data);
  assert_true(bytes > 1000);
  assert_memory_equal(data, "\x89PNG\r\n\x1a\n", 8);
  assert_memory_equal(data + bytes - 8, "IEND", 4); /* whole to its end */
  int width = data[16] << 24 | data[17] << 16 | data[18] << 8 | data[19];
  free(data);
  return width;
}

/* Names in folders that a shell would tear apart. */
static void figures_are_drawn(void **state) {
  (void)state;
  static const char *const names[] = {"plain", "with space", "it's \"quoted\" $HOME", "-dash",
                                      ".hidden"};
  cdem_fault fault = {0};
  cdem_panel panel[2];
  cdem_curve curve[4];
  cdem_figure figure = make(panel, curve);
  char folder[256], path[512];
  if (!have_gnuplot()) {
    print_message("gnuplot is not installed: skipped\n");
    skip();
  }
  snprintf(folder, sizeof folder, "%s/a folder's \"name\"", scratch);
  mkdir(folder, 0777);
  for (int i = 0; i < 5; i++) {
    check_ok(cdem_write_figure(folder, names[i], &figure, &fault));
    assert_int_equal(count_files(folder), 4 * (i + 1));
    snprintf(path, sizeof path, "%s/%s.png", folder, names[i]);
    assert_true(width_of_png(path) > 1000);
    snprintf(path, sizeof path, "%s/%s.svg", folder, names[i]);
    char *svg = read_whole(path, NULL);
    assert_non_null(svg);
    assert_non_null(strstr(svg, "</svg>"));
    assert_non_null(strstr(svg, "stiffness (N/m)"));
    free(svg);
  }
}

/* The kept script draws the same picture when run by hand. */
static void scripts_can_be_run_again(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_panel panel[2];
  cdem_curve curve[4];
  cdem_figure figure = make(panel, curve);
  char command[256];
  if (!have_gnuplot())
    skip();
  check_ok(cdem_write_figure(scratch, "again", &figure, &fault));
  int width = width_of_png(in_scratch("again.png"));
  unlink(in_scratch("again.png"));
  snprintf(command, sizeof command, "cd '%s' && gnuplot again.gp", scratch);
  assert_int_equal(system(command), 0);
  assert_int_equal(width_of_png(in_scratch("again.png")), width);
}

/* Blocks in the order of the curves, gaps as single empty lines. */
static void data_has_a_block_a_curve(void **state) {
  (void)state;
  cdem_panel panel[2];
  cdem_curve curve[4];
  cdem_figure figure = make(panel, curve);
  char *text = NULL;
  size_t bytes;
  FILE *stream = open_memstream(&text, &bytes);
  cdem_figure_put_data(stream, &figure);
  fclose(stream);
  int blocks = 1, gaps = 0, points = 0;
  for (char *c = text; (c = strchr(c, '\n')) != NULL; c++) {
    points += c[1] != '\n' && c[1] != '#' && c[1] != '\0';
    if (c[1] == '\n' && c[2] == '\n' && c[3] == '#')
      blocks++;
    else if (c[1] == '\n' && c[2] != '\n' && c[2] != '#')
      gaps++;
  }
  assert_int_equal(blocks, 3);
  assert_int_equal(gaps, 1);
  assert_int_equal(points, POINTS + POINTS - 10 + 1);
  free(text);
}

static void write_program(const char *name, const char *text) {
  write_whole(in_scratch(name), text);
  chmod(in_scratch(name), 0755);
}

/* With a PATH of our own: no gnuplot, one that fails, one that draws nothing. */
static void gnuplot_can_fail(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_panel panel[2];
  cdem_curve curve[4];
  cdem_figure figure = make(panel, curve);
  char *before = strdup(getenv("PATH"));
  mkdir(in_scratch("bin"), 0777);
  mkdir(in_scratch("out"), 0777);
  setenv("PATH", in_scratch("bin"), 1);
  check_fails(cdem_write_figure(in_scratch("out"), "f", &figure, &fault), CDEM_FILE,
              "gnuplot was not found; install the package gnuplot-nox");
  write_program("bin/gnuplot",
                "#!/bin/sh\nprintf '\\n\\nline 3: undefined variable\\nmore\\n' >&2\n"
                "echo half > .f.png.part-$PPID\nexit 1\n");
  check_fails(cdem_write_figure(in_scratch("out"), "f", &figure, &fault), CDEM_FILE,
              "gnuplot failed: line 3: undefined variable; run gnuplot f.gp");
  write_program("bin/gnuplot", "#!/bin/sh\nexit 0\n");
  check_fails(cdem_write_figure(in_scratch("out"), "f", &figure, &fault), CDEM_FILE,
              "cannot write");
  setenv("PATH", before, 1);
  free(before);
  assert_int_equal(access(in_scratch("out/f.png"), F_OK), -1);
  assert_int_equal(count_files(in_scratch("out")), 2); /* f.dat and f.gp are kept */
}

static void places_that_cannot_be_written(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_panel panel[2];
  cdem_curve curve[4];
  cdem_figure figure = make(panel, curve);
  FILE *in_the_way = fopen(in_scratch("none"), "w");
  assert_non_null(in_the_way);
  fclose(in_the_way);
  check_fails(cdem_write_figure(in_scratch("none/deeper"), "f", &figure, &fault), CDEM_FILE,
              "Not a directory");
  check_ok(cdem_write_figure(in_scratch("new/folder/"), "f", &figure, &fault));
  assert_int_equal(access(in_scratch("new/folder/f.png"), F_OK), 0);
  check_fails(cdem_write_figure(scratch, "a/b", &figure, &fault), CDEM_USAGE,
              "cannot be the name of a figure");
  check_fails(cdem_write_figure(scratch, "", &figure, &fault), CDEM_USAGE,
              "cannot be the name of a figure");
}

static void lack_of_memory_leaves_no_figure(void **state) {
  (void)state;
  cdem_panel panel[2];
  cdem_curve curve[4];
  cdem_figure figure = make(panel, curve);
  if (!have_gnuplot())
    skip();
  mkdir(in_scratch("memory"), 0777);
  int failures = 0;
  for (;; failures++) {
    cdem_fault fault = {0};
    cdem_memory_fail_after(failures);
    cdem_status status = cdem_write_figure(in_scratch("memory"), "f", &figure, &fault);
    cdem_memory_fail_after(-1);
    if (status == CDEM_OK)
      break;
    assert_int_equal(status, CDEM_MEMORY);
    assert_int_equal(access(in_scratch("memory/f.png"), F_OK), -1);
  }
  assert_true(failures > 8);
}

/* 2 ms and 200 kN: both axes in numbers divided by a power of ten that is written once. */
static void large_and_small_numbers_share_a_power(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const double at[2] = {0, 2e-3}, load[2] = {-1e5, 2e5};
  const cdem_curve curve = {NULL, at, load, 2, 0};
  const cdem_panel panel = {"load", "time, s", "force, N", 1, &curve, -1e5, 2e5};
  const cdem_figure figure = {NULL, 1, 1, &panel};
  check_ok(cdem_write_figure(in_scratch("power"), "f", &figure, &fault));
  char *text = read_whole(in_scratch("power/f.gp"), NULL);
  static const char *const parts[] = {"set xrange [0:2]\n", "set yrange [-100:200]\n",
                                      "'×10^{−3}' at graph 1,", "'×10^{3}' at graph -0.02,",
                                      "using ($1*1e3):($2*1e-3) with lines"};
  for (int i = 0; i < 5; i++)
    if (strstr(text, parts[i]) == NULL)
      fail_msg("'%s' is not in the script", parts[i]);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(figures_are_drawn),
      cmocka_unit_test(scripts_can_be_run_again),
      cmocka_unit_test(data_has_a_block_a_curve),
      cmocka_unit_test(gnuplot_can_fail),
      cmocka_unit_test(places_that_cannot_be_written),
      cmocka_unit_test(lack_of_memory_leaves_no_figure),
      cmocka_unit_test(large_and_small_numbers_share_a_power),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
