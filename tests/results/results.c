/* Room results: tables keep what they are given, absent stays absent, checks pass by their bound.
 */
#include "results/results.h"

#include "support/test.h"

enum { NAME, COUNT, VALUE };

static void make(cdem_table *table) {
  cdem_fault fault = {0};
  check_ok(cdem_table_add_column(table, "name", CDEM_COLUMN_TEXT, "", &fault));
  check_ok(cdem_table_add_column(table, "count", CDEM_COLUMN_INTEGER, "", &fault));
  check_ok(cdem_table_add_column(table, "value", CDEM_COLUMN_REAL, "N/m", &fault));
}

static void tables_keep_values(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  make(&table);
  for (int r = 0; r < 100; r++) {
    check_ok(cdem_table_add_row(&table, &fault));
    for (int c = 0; c < 3; c++)
      assert_true(cdem_table_at(&table, r, c)->absent);
    check_ok(cdem_table_set_text(&table, NAME, "first", &fault));
    check_ok(cdem_table_set_text(&table, NAME, r % 2 ? "odd" : "even", &fault));
    cdem_table_set_integer(&table, COUNT, INT64_MAX - r);
    cdem_table_set_real(&table, VALUE, r == 7 ? NAN : 0.1 * r);
  }
  assert_int_equal(table.rows, 100);
  for (int r = 0; r < 100; r++) {
    assert_string_equal(cdem_table_at(&table, r, NAME)->text, r % 2 ? "odd" : "even");
    assert_true(cdem_table_at(&table, r, COUNT)->integer == INT64_MAX - r);
    assert_int_equal(cdem_table_at(&table, r, VALUE)->absent, r == 7);
    if (r != 7)
      assert_true(cdem_table_at(&table, r, VALUE)->real == 0.1 * r);
  }
  assert_int_equal(cdem_table_find(&table, "value"), VALUE);
  assert_int_equal(cdem_table_find(&table, "Value"), -1);
  assert_string_equal(table.column[VALUE].unit, "N/m");
  cdem_table_release(&table);
  assert_int_equal(table.columns, 0);
  cdem_table_release(&table);
}

/* Every allocation fails once; the table stays usable and nothing leaks (address sanitizer). */
static void tables_survive_lack_of_memory(void **state) {
  (void)state;
  int failures = 0;
  for (int allowed = 0;; allowed++, failures++) {
    cdem_fault fault = {0};
    cdem_table table = {0};
    cdem_memory_fail_after(allowed);
    cdem_status status = cdem_table_add_column(&table, "a", CDEM_COLUMN_TEXT, "", &fault);
    if (status == CDEM_OK)
      status = cdem_table_add_row(&table, &fault);
    if (status == CDEM_OK) {
      status = cdem_table_set_text(&table, 0, "text", &fault);
      assert_int_equal(cdem_table_at(&table, 0, 0)->absent, status != CDEM_OK);
    }
    cdem_memory_fail_after(-1);
    cdem_table_release(&table);
    if (status == CDEM_OK)
      break;
    assert_int_equal(status, CDEM_MEMORY);
    assert_non_null(strstr(fault.message, "out of memory"));
  }
  assert_int_equal(failures, 5); /* column, name, unit, row, text */
}

static bool passes(double reference, double value, double tolerance) {
  const cdem_check check = {.reference = reference, .value = value, .tolerance = tolerance};
  return cdem_check_passes(&check);
}

static void checks_pass_by_their_bound(void **state) {
  (void)state;
  assert_true(passes(1.0, 1.25, 0.25));
  assert_true(passes(1.0, 0.75, 0.25));
  assert_false(passes(1.0, 1.25 + 0x1p-50, 0.25));
  assert_true(passes(3.0, 3.0, 0.0));
  assert_false(passes(3.0, nextafter(3.0, 4.0), 0.0));
  assert_false(passes(0.0, NAN, 1.0));
  assert_false(passes(NAN, 0.0, 1.0));
  assert_false(passes(0.0, 0.0, NAN));
  assert_false(passes(0.0, INFINITY, INFINITY));
  assert_true(passes(INFINITY, INFINITY, 0.0));
}

static void check_lists_grow(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_check_list list = {0};
  for (int i = 0; i < 40; i++)
    check_ok(cdem_check_add(&list, (cdem_check){.group = "g", .name = "n", .value = i}, &fault));
  assert_int_equal(list.checks, 40);
  for (int i = 0; i < 40; i++)
    assert_true(list.check[i].value == i);
  cdem_memory_fail_after(0);
  list.checks = list.capacity;
  check_fails(cdem_check_add(&list, list.check[0], &fault), CDEM_MEMORY, "out of memory");
  cdem_memory_fail_after(-1);
  cdem_check_list_release(&list);
  assert_null(list.check);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tables_keep_values),
      cmocka_unit_test(tables_survive_lack_of_memory),
      cmocka_unit_test(checks_pass_by_their_bound),
      cmocka_unit_test(check_lists_grow),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
