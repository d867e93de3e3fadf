/* Functions of time: values and integrals against closed forms and against numerical quadrature;
 * and the caret under a line, which room base lends to the readers. */
#include "base/series.h"

#include "base/caret.h"
#include "support/test.h"

static const double pi = 3.14159265358979323846;

/* The integral by Gauss-Legendre with three points on `pieces` equal pieces of [0, time]. */
static double quadrature(const cdem_series *series, double time, int pieces) {
  const double place = sqrt(0.6), h = time / pieces;
  double sum = 0.0;
  for (int i = 0; i < pieces; i++) {
    double middle = (i + 0.5) * h;
    sum += h / 18.0 *
           (5.0 * cdem_series_at(series, middle - 0.5 * h * place) +
            8.0 * cdem_series_at(series, middle) +
            5.0 * cdem_series_at(series, middle + 0.5 * h * place));
  }
  return sum;
}

static void tables(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_series s = {0};
  static const double time[] = {1.0, 2.0, 4.0}, value[] = {3.0, -1.0, 5.0};
  check_ok(cdem_series_table(3, time, value, &s, &fault));
  static const double at[][3] = {/* t, value, integral from 0 */
                                 {-2.0, 3.0, -6.0}, {0.0, 3.0, 0.0},   {1.0, 3.0, 3.0},
                                 {1.5, 1.0, 4.0},   {2.0, -1.0, 4.0},  {3.0, 2.0, 4.5},
                                 {4.0, 5.0, 8.0},   {10.0, 5.0, 38.0}, {0.5, 3.0, 1.5}};
  for (int i = 0; i < 9; i++) {
    check_near(cdem_series_at(&s, at[i][0]), at[i][1], 1e-15, 0);
    check_near(cdem_series_integral(&s, at[i][0]), at[i][2], 1e-15, 0);
  }
  cdem_series copy = {0};
  check_ok(cdem_series_copy(&s, &copy, &fault));
  assert_ptr_not_equal(copy.time, s.time);
  cdem_series_release(&s);
  assert_true(cdem_series_at(&s, 1.0) == 0.0 && cdem_series_integral(&s, 5.0) == 0.0);
  check_near(cdem_series_at(&copy, 3.0), 2.0, 1e-15, 0);
  cdem_series_release(&copy);
  cdem_series_release(&copy);
}

/* Tables that begin before 0 and end after it; integrals to negative times are minus those from
 * there to 0. */
static void tables_around_zero(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_series s = {0};
  static const double time[] = {-3.0, -1.0, 1.0}, value[] = {2.0, 0.0, 4.0};
  check_ok(cdem_series_table(3, time, value, &s, &fault));
  check_near(cdem_series_at(&s, 0.0), 2.0, 1e-15, 0);
  check_near(cdem_series_integral(&s, 1.0), 3.0, 1e-15, 0);
  check_near(cdem_series_integral(&s, -1.0), -1.0, 1e-15, 0);
  check_near(cdem_series_integral(&s, -3.0), -3.0, 1e-15, 0);
  check_near(cdem_series_integral(&s, -4.0), -5.0, 1e-15, 0);
  cdem_series_release(&s);
  check_ok(cdem_series_constant(7.0, &s, &fault));
  assert_true(cdem_series_at(&s, -1.0) == 7.0 && cdem_series_at(&s, 1.0) == 7.0);
  check_near(cdem_series_integral(&s, 3.0), 21.0, 1e-15, 0);
  check_near(cdem_series_integral(&s, -3.0), -21.0, 1e-15, 0);
  cdem_series_release(&s);
}

static void sines(void **state) {
  (void)state;
  const cdem_series s = {.kind = CDEM_SERIES_SINE,
                         .offset = 0.5,
                         .amplitude = 2.0,
                         .frequency = 3.0,
                         .phase = 0.7,
                         .start = 0.25};
  const double before = 0.5 + 2.0 * sin(0.7), w = 6.0 * pi;
  check_near(cdem_series_at(&s, -1.0), before, 1e-15, 0);
  check_near(cdem_series_at(&s, 0.25), before, 1e-15, 0);
  check_near(cdem_series_at(&s, 0.6), 0.5 + 2.0 * sin(w * 0.35 + 0.7), 1e-14, 0);
  check_near(cdem_series_integral(&s, 0.2), 0.2 * before, 1e-15, 0);
  check_near(cdem_series_integral(&s, -2.0), -2.0 * before, 1e-15, 0);
  for (int i = 0; i < 40; i++) {
    double t = 0.25 + 0.13 * i;
    double closed =
        0.25 * before + 0.5 * (t - 0.25) + 2.0 / w * (cos(0.7) - cos(w * (t - 0.25) + 0.7));
    check_near(cdem_series_integral(&s, t), closed, 1e-13, 1e-14);
  }
  /* a start before 0: only what lies between 0 and t counts */
  cdem_series early = s;
  early.start = -1.0;
  double closed = 0.5 * 0.4 + 2.0 / w * (cos(w + 0.7) - cos(w * 1.4 + 0.7));
  check_near(cdem_series_integral(&early, 0.4), closed, 1e-13, 0);
  /* no frequency: a constant */
  early.frequency = 0.0;
  check_near(cdem_series_integral(&early, 2.0), 2.0 * before, 1e-15, 0);
}

static void pulses(void **state) {
  (void)state;
  const cdem_series s = {
      .kind = CDEM_SERIES_PULSE, .offset = -1.0, .amplitude = 4.0, .start = 0.5, .duration = 2.0};
  static const double at[][2] = {{-1, -1}, {0.5, -1}, {1.0, 1}, {1.5, 3},
                                 {2.0, 1}, {2.5, -1}, {9, -1}};
  for (int i = 0; i < 7; i++)
    check_near(cdem_series_at(&s, at[i][0]), at[i][1], 1e-14, 1e-14);
  check_near(cdem_series_integral(&s, 0.5), -0.5, 1e-15, 0);
  check_near(cdem_series_integral(&s, -3.0), 3.0, 1e-15, 0);
  check_near(cdem_series_integral(&s, 1.5), -1.5 + 2.0, 1e-14, 0); /* half of A d/2 */
  check_near(cdem_series_integral(&s, 2.5), -2.5 + 4.0, 1e-14, 0);
  check_near(cdem_series_integral(&s, 7.0), -7.0 + 4.0, 1e-14, 0);
  for (int i = 0; i <= 20; i++) {
    double x = 0.1 * i; /* A (x/2 - d sin(2 pi x/d)/(4 pi)) */
    check_near(cdem_series_integral(&s, 0.5 + x),
               -(0.5 + x) + 4.0 * (0.5 * x - 2.0 / (4.0 * pi) * sin(pi * x)), 1e-13, 1e-14);
  }
  cdem_series none = s;
  none.duration = 0.0;
  assert_true(cdem_series_at(&none, 0.5) == -1.0 && cdem_series_integral(&none, 3.0) == -3.0);
}

/* Prescribed velocities are followed by their integral: it must be the antiderivative everywhere,
 * also across the kinks. */
static void integrals_agree_with_quadrature(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_series all[3] = {
      {.kind = CDEM_SERIES_TABLE},
      {.kind = CDEM_SERIES_SINE, .amplitude = 1.0, .frequency = 1.3, .start = 0.8},
      {.kind = CDEM_SERIES_PULSE, .amplitude = 1.0, .start = 0.4, .duration = 1.7}};
  cdem_random random = {7};
  double time[12], value[12];
  for (int i = 0; i < 12; i++) {
    time[i] = (i > 0 ? time[i - 1] : -0.5) + cdem_random_uniform(&random, 0.01, 0.6);
    value[i] = cdem_random_uniform(&random, -1.0, 1.0);
  }
  check_ok(cdem_series_table(12, time, value, &all[0], &fault));
  for (int k = 0; k < 3; k++)
    for (int i = 1; i <= 10; i++) {
      double t = 0.37 * i;
      /* kinks lie inside at most a dozen of 4000 pieces: 12 h^2 of the slope, below 1e-5 */
      check_near(cdem_series_integral(&all[k], t), quadrature(&all[k], t, 4000), 0, 1e-5);
      /* the mean slope over 2h is a value in between: off by at most h times the steepest slope,
       * 200 (values differ by 2 over 0.01) */
      double h = 1e-6,
             slope = (cdem_series_integral(&all[k], t + h) - cdem_series_integral(&all[k], t - h)) /
                     (2 * h);
      check_near(slope, cdem_series_at(&all[k], t), 0, 200 * h + 1e-9);
    }
  cdem_series_release(&all[0]);
}

static void wrong_tables(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_series s = {0};
  static const double good[] = {0, 1, 2}, twice[] = {0, 1, 1}, wild[] = {0, NAN, 2};
  check_fails(cdem_series_table(0, good, good, &s, &fault), CDEM_INPUT,
              "at least one point, not 0");
  check_fails(cdem_series_table(3, twice, good, &s, &fault), CDEM_INPUT,
              "must ascend: point 3 is at 1 s, the one before it at 1 s");
  check_fails(cdem_series_table(3, good, wild, &s, &fault), CDEM_INPUT,
              "point 2 of the table is not");
  check_fails(cdem_series_table(3, wild, good, &s, &fault), CDEM_INPUT, "is not finite");
  assert_null(s.time);
  for (int after = 0; after < 2; after++) {
    cdem_memory_fail_after(after);
    assert_int_equal(cdem_series_table(3, good, good, &s, NULL), CDEM_MEMORY);
    cdem_memory_fail_after(-1);
    assert_null(s.time);
  }
}

/* ---- carets ---- */

static void carets(void **state) {
  (void)state;
  char out[512];
  cdem_caret_put("one\ntwo three\nfour\n", 2, 5, 5, out, sizeof out);
  assert_string_equal(out, "\n  two three\n      ^~~~~");
  cdem_caret_put("\tx: 1", 1, 2, 1, out, sizeof out); /* tabs would move the caret */
  assert_string_equal(out, "\n   x: 1\n   ^");
  cdem_caret_put("gr\xc3\xb6\xc3\x9f"
                 "e: 1",
                 1, 8, 1, out, sizeof out); /* letters, not bytes */
  assert_string_equal(out, "\n  gr\xc3\xb6\xc3\x9f"
                           "e: 1\n         ^");
  cdem_caret_put("one\n", 5, 1, 1, out, sizeof out);
  assert_string_equal(out, "");
  cdem_caret_put("one\n", 0, 1, 1, out, sizeof out);
  assert_string_equal(out, "");
  cdem_caret_put("one\n", 1, 1, 1, out, 20); /* too little room */
  assert_string_equal(out, "");
  char longer[400];
  memset(longer, 'a', sizeof longer);
  longer[200] = 'b';
  longer[399] = '\0';
  cdem_caret_put(longer, 1, 201, 300, out, sizeof out);
  const char *line = strchr(out + 1, '\n');
  assert_non_null(line);
  assert_int_equal(line - out, 3 + 72);
  assert_int_equal(strchr(out, 'b') - out - 1,
                   strchr(line, '^') - line - 1);  /* one below the other */
  cdem_caret_put("ab", 1, 90, 3, out, sizeof out); /* beyond the end of the line */
  assert_true(strlen(out) < 200);
}

static void alike(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const double time[2] = {0.0, 1.0}, value[2] = {2.0, 3.0}, other[2] = {2.0, 4.0};
  cdem_series a, b, c;
  const cdem_series sine = {.kind = CDEM_SERIES_SINE, .amplitude = 1.0};
  assert_int_equal(cdem_series_table(2, time, value, &a, &fault), CDEM_OK);
  assert_int_equal(cdem_series_copy(&a, &b, &fault), CDEM_OK);
  assert_int_equal(cdem_series_table(2, time, other, &c, &fault), CDEM_OK);
  assert_true(cdem_series_same(&a, &b) && cdem_series_same(&sine, &sine));
  assert_false(cdem_series_same(&a, &c) || cdem_series_same(&a, &sine));
  cdem_series_release(&a);
  cdem_series_release(&b);
  cdem_series_release(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tables),
      cmocka_unit_test(tables_around_zero),
      cmocka_unit_test(sines),
      cmocka_unit_test(pulses),
      cmocka_unit_test(integrals_agree_with_quadrature),
      cmocka_unit_test(alike),
      cmocka_unit_test(wrong_tables),
      cmocka_unit_test(carets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
