/* Room base: faults keep the first failure, allocation checks sizes, growth keeps contents. */
#include "support/test.h"

static void first_failure_is_kept(void **state) {
  (void)state;
  cdem_fault fault = {0};
  assert_int_equal(cdem_fail(&fault, CDEM_INPUT, "line %d is wrong", 7), CDEM_INPUT);
  assert_int_equal(cdem_fail(&fault, CDEM_FILE, "later"), CDEM_FILE);
  assert_int_equal(fault.status, CDEM_INPUT);
  assert_string_equal(fault.message, "line 7 is wrong");
  cdem_fault_prefix(&fault, "mesh '%s'", "a.msh");
  assert_string_equal(fault.message, "mesh 'a.msh': line 7 is wrong");
}

static void long_messages_are_cut(void **state) {
  (void)state;
  cdem_fault fault = {0};
  char text[3 * CDEM_FAULT_LENGTH];
  memset(text, 'x', sizeof text - 1);
  text[sizeof text - 1] = '\0';
  cdem_fail(&fault, CDEM_INPUT, "%s", text);
  cdem_fault_prefix(&fault, "%s", text);
  assert_int_equal(strlen(fault.message), CDEM_FAULT_LENGTH - 1);
}

static void statuses_have_the_documented_exit_codes(void **state) {
  (void)state;
  const cdem_status status[] = {CDEM_OK,      CDEM_CHECK,  CDEM_USAGE, CDEM_INPUT,
                                CDEM_NUMERIC, CDEM_MEMORY, CDEM_FILE};
  for (int i = 0; i < 7; i++)
    assert_int_equal(cdem_status_exit_code(status[i]), i);
  assert_int_equal(cdem_status_exit_code(CDEM_INTERRUPTED), 130);
}

static void allocation_fails_cleanly(void **state) {
  (void)state;
  cdem_fault fault = {0};
  assert_null(cdem_allocate(INT64_MAX, sizeof(double), &fault));
  assert_int_equal(fault.status, CDEM_MEMORY);
  cdem_memory_fail_after(1);
  void *first = cdem_allocate(1, 1, NULL);
  assert_non_null(first);
  assert_null(cdem_allocate(1, 1, NULL));
  cdem_memory_fail_after(-1);
  free(first);
}

static void growing_keeps_contents_and_zeroes_the_rest(void **state) {
  (void)state;
  cdem_fault fault = {0};
  int *numbers = NULL;
  int64_t capacity = 0;
  for (int i = 0; i < 1000; i++) {
    check_ok(cdem_grow(&numbers, &capacity, i + 1, sizeof *numbers, &fault));
    assert_int_equal(numbers[i], 0);
    numbers[i] = i;
  }
  for (int i = 0; i < 1000; i++)
    assert_int_equal(numbers[i], i);
  cdem_memory_fail_after(0);
  check_fails(cdem_grow(&numbers, &capacity, 1 << 20, sizeof *numbers, &fault), CDEM_MEMORY,
              "out of memory");
  cdem_memory_fail_after(-1);
  assert_int_equal(numbers[999], 999);
  check_fails(cdem_grow(&numbers, &capacity, INT64_MAX, sizeof *numbers, &fault), CDEM_MEMORY,
              "out of memory");
  free(numbers);
}

static void dimensions_have_units(void **state) {
  (void)state;
  char text[48];
  assert_string_equal(cdem_dimension_unit(CDEM_PRESSURE, text), "Pa");
  assert_string_equal(cdem_dimension_unit(CDEM_DENSITY, text), "kg m-3");
}

static bool stop(void *context, const char *what, int64_t done, int64_t total) {
  (void)context, (void)what, (void)total;
  return done < 5;
}

static void progress_can_stop_work(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_progress progress = {NULL, stop};
  check_ok(cdem_progress_report(NULL, "counting", 9, 10, &fault));
  check_ok(cdem_progress_report(&progress, "counting", 4, 10, &fault));
  check_fails(cdem_progress_report(&progress, "counting", 5, 10, &fault), CDEM_INTERRUPTED,
              "counting");
}

static void inverse_and_product(void **state) {
  (void)state;
  const double m[9] = {2, 1, 0, -1, 3, 2, 0.5, 0, 4};
  double inverse[9], product[9];
  check_near(cdem_inverse3(m, inverse), 29.0, 1e-15, 0);
  cdem_product3(m, inverse, product);
  for (int i = 0; i < 9; i++)
    check_near(product[i], i % 4 == 0 ? 1.0 : 0.0, 0, 1e-15);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_failure_is_kept),
      cmocka_unit_test(long_messages_are_cut),
      cmocka_unit_test(statuses_have_the_documented_exit_codes),
      cmocka_unit_test(allocation_fails_cleanly),
      cmocka_unit_test(growing_keeps_contents_and_zeroes_the_rest),
      cmocka_unit_test(dimensions_have_units),
      cmocka_unit_test(progress_can_stop_work),
      cmocka_unit_test(inverse_and_product),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
