/* Numbers as text: what printf's %.17g gives in the C locale (locale.c: in
 * every locale). */
#include "io/text.h"

#include "io/support.h"

#include <float.h>

static void put(char *text, double value) {
  *cdem_put_real(text, value) = '\0';
}

static void check_as_printf(double value) {
  char ours[CDEM_REAL_WIDTH + 1], reference[64];
  put(ours, value);
  snprintf(reference, sizeof reference, "%.17g", value);
  if (strcmp(ours, reference) != 0)
    fail_msg("%s, printf gives %s", ours, reference);
}

static void special_numbers_match_printf(void **state) {
  (void)state;
  const double values[] = {0.0,
                           -0.0,
                           1.0,
                           -1.0,
                           0.1,
                           0.5,
                           1e15,
                           1e16,
                           1e17,
                           1e18,
                           1e22,
                           1e23,
                           1e-4,
                           1e-5,
                           9.9e-5,
                           123456789,
                           1.0 / 3,
                           DBL_MAX,
                           -DBL_MAX,
                           DBL_MIN,
                           5e-324,
                           1e100,
                           1e-100,
                           2.5,
                           99999999999999999.0,
                           999999999999999.9,
                           0.99999999999999989,
                           9007199254740993.0,
                           1e15 + 0.5,
                           4503599627370497.5,
                           0.3,
                           1e-300};
  for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
    check_as_printf(values[i]);
    check_as_printf(nextafter(values[i], INFINITY));
    check_as_printf(nextafter(values[i], -INFINITY));
  }
  for (int power = -320; power <= 308; power++)
    check_as_printf(pow(10.0, power));
  char text[CDEM_REAL_WIDTH + 1];
  put(text, NAN);
  assert_string_equal(text, "nan");
  put(text, -INFINITY);
  assert_string_equal(text, "-inf");
}

static void random_numbers_match_printf(void **state) {
  (void)state;
  cdem_random random = {7};
  for (int i = 0; i < 10000; i++) {
    uint64_t bits = cdem_random_next(&random);
    double any;
    memcpy(&any, &bits, sizeof any);
    if (isfinite(any))
      check_as_printf(any);
    check_as_printf(cdem_random_uniform(&random, -1.0, 1.0));
    check_as_printf(cdem_random_uniform(&random, -1.0, 1.0) *
                    pow(10.0, (double)(cdem_random_next(&random) % 60) - 30.0));
    check_as_printf((double)(int64_t)(bits >> (i % 60))); /* integers of every length */
    check_as_printf((double)(bits >> 40) / 1024.0);       /* exact ties */
  }
}

static void integers_are_written_whole(void **state) {
  (void)state;
  const int64_t values[] = {0, 7, 10, 99, 100, -1, 12345, INT64_MAX, INT64_MIN};
  for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
    char ours[32], reference[32];
    *cdem_put_integer(ours, values[i]) = '\0';
    snprintf(reference, sizeof reference, "%lld", (long long)values[i]);
    assert_string_equal(ours, reference);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(special_numbers_match_printf),
      cmocka_unit_test(random_numbers_match_printf),
      cmocka_unit_test(integers_are_written_whole),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
