/* Curves as SVG: the path is read back and held against the values it stands for. */
#include "report/chart.h"

#include "support/test.h"

enum { MOST = 8192 };

typedef struct {
  double x[MOST], y[MOST];
  bool begins[MOST]; /* a new line */
  int points;
} path;

/* The points of the first curve of class c0. */
static void read_path(const char *svg, path *found) {
  const char *at = strstr(svg, "<path class=\"c0\" d=\"");
  assert_non_null(at);
  at = strstr(at, " d=\"") + 4;
  for (found->points = 0; *at == 'M' || *at == 'L'; found->points++) {
    char *end;
    assert_true(found->points < MOST);
    found->begins[found->points] = *at == 'M';
    found->x[found->points] = strtod(at + 1, &end);
    found->y[found->points] = strtod(end, &end);
    at = end;
  }
  assert_int_equal(*at, '"');
}

static char *chart_of(const double *x, const double *y, int64_t points, bool logarithmic) {
  cdem_report_text to = {0};
  const cdem_curve curve = {.title = "a <curve>", .x = x, .y = y, .points = points};
  const cdem_report_chart chart = {.title = "Title",
                                   .x_label = "time [s]",
                                   .y_label = "force [N]",
                                   .curves = 1,
                                   .curve = &curve,
                                   .logarithmic = logarithmic};
  cdem_report_raw(&to, "");
  cdem_report_chart_put(&to, &chart);
  assert_int_equal(to.status, CDEM_OK);
  return to.text;
}

/* Equal distances stay equal, y points upwards. */
static void a_line_stays_a_line(void **state) {
  (void)state;
  const double x[] = {0, 1, 2, 4}, y[] = {10, 20, 30, 50};
  path p;
  char *svg = chart_of(x, y, 4, false);
  read_path(svg, &p);
  assert_int_equal(p.points, 4);
  for (int i = 1; i < 4; i++) {
    check_near((p.x[i] - p.x[0]) / (p.x[3] - p.x[0]), (x[i] - x[0]) / (x[3] - x[0]), 0, 1e-3);
    check_near((p.y[i] - p.y[0]) / (p.y[3] - p.y[0]), (y[i] - y[0]) / (y[3] - y[0]), 0, 1e-3);
    assert_true(p.y[i] < p.y[i - 1]);
    assert_false(p.begins[i]);
  }
  assert_non_null(strstr(svg, "a &lt;curve&gt;"));
  assert_non_null(strstr(svg, "between 10 and 50, at the end 50"));
  free(svg);
}

static void absent_values_break_the_line(void **state) {
  (void)state;
  const double x[] = {0, 1, 2, 3, 4}, y[] = {1, 2, (double)NAN, 2, 1};
  path p;
  char *svg = chart_of(x, y, 5, false);
  read_path(svg, &p);
  assert_int_equal(p.points, 4);
  assert_true(p.begins[0] && !p.begins[1] && p.begins[2] && !p.begins[3]);
  free(svg);
}

/* On a scale of powers of ten equal ratios are equal distances, and 0 is nowhere. */
static void powers_of_ten_are_evenly_spaced(void **state) {
  (void)state;
  const double x[] = {0, 1, 2, 3}, y[] = {0, 1e-6, 1e-4, 1e-2};
  path p;
  char *svg = chart_of(x, y, 4, true);
  read_path(svg, &p);
  assert_int_equal(p.points, 3);
  assert_true(p.y[0] - p.y[1] > 10.0);
  check_near(p.y[0] - p.y[1], p.y[1] - p.y[2], 0, 0.11); /* places are rounded to a tenth */
  assert_non_null(strstr(svg, ">10⁻⁴<"));
  free(svg);
}

/* Of a million points what can be seen is kept: a spike of one point at its full height, the ends,
 * and no more points than there is room for. */
static void a_long_curve_keeps_its_spikes(void **state) {
  (void)state;
  enum { POINTS = 1000000, SPIKE = 333333, DIP = 777777 };
  double *x = malloc(POINTS * sizeof *x), *y = malloc(POINTS * sizeof *y);
  for (int i = 0; i < POINTS; i++) {
    x[i] = i;
    y[i] = sin(1e-4 * i);
  }
  y[SPIKE] = 10.0;
  y[DIP] = -10.0;
  path p;
  char *svg = chart_of(x, y, POINTS, false);
  read_path(svg, &p);
  double top = 1e9, bottom = -1e9;
  for (int i = 0; i < p.points; i++) {
    top = fmin(top, p.y[i]);
    bottom = fmax(bottom, p.y[i]);
  }
  double middle = 0.5 * (top + bottom), unit = (bottom - top) / 20.0; /* of y */
  check_near(p.y[0], middle, 0, 0.2);
  check_near(p.y[p.points - 1], middle - unit * y[POINTS - 1], 0, 0.2);
  int spike = 0;
  for (int i = 0; i < p.points; i++)
    spike = p.y[i] < p.y[spike] ? i : spike;
  check_near((p.x[spike] - p.x[0]) / (p.x[p.points - 1] - p.x[0]), SPIKE / (double)POINTS, 0, 1e-3);
  assert_in_range(p.points, 500, 3700);
  free(svg);
  free(x);
  free(y);
}

static void nothing_is_drawn_of_nothing(void **state) {
  (void)state;
  const double x[] = {0, 1}, y[] = {(double)NAN, 1};
  char *svg = chart_of(x, y, 2, false);
  assert_string_equal(svg, "");
  free(svg);
}

/* Ticks are 1, 2 or 5 times a power of ten, and the axis holds the values. */
static void axes_have_round_ticks(void **state) {
  (void)state;
  static const double range[][2] = {{0, 1},         {-3, 17},     {1e-9, 4e-9}, {0, 123456},
                                    {5, 5},         {0, 0},       {-2e7, -1e7}, {1e300, 2e300},
                                    {0.999, 1.001}, {-1e-12, 1e3}};
  for (size_t i = 0; i < sizeof range / sizeof range[0]; i++) {
    const cdem_report_axis axis = cdem_report_axis_for(range[i][0], range[i][1], true);
    double digit = axis.step / pow(10.0, floor(log10(axis.step) + 1e-9));
    assert_true(fabs(digit - 1) < 1e-6 || fabs(digit - 2) < 1e-6 || fabs(digit - 5) < 1e-6);
    double room = 1e-6 * axis.step;
    assert_true(axis.low <= range[i][0] + room && axis.high >= range[i][1] - room);
    assert_in_range((int)((axis.high - axis.low) / axis.step + 0.5), 3, 9);
    check_near(axis.low / axis.step, round(axis.low / axis.step), 0, 1e-6);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_line_stays_a_line),
      cmocka_unit_test(absent_values_break_the_line),
      cmocka_unit_test(powers_of_ten_are_evenly_spaced),
      cmocka_unit_test(a_long_curve_keeps_its_spikes),
      cmocka_unit_test(nothing_is_drawn_of_nothing),
      cmocka_unit_test(axes_have_round_ticks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
