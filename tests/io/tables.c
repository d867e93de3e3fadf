/* Tables and checks as CSV and JSON. */
#include "io/support.h"

static void make(cdem_table *table) {
  cdem_fault fault = {0};
  check_ok(cdem_table_add_column(table, "nu", CDEM_COLUMN_REAL, "", &fault));
  check_ok(cdem_table_add_column(table, "pair", CDEM_COLUMN_TEXT, "", &fault));
  check_ok(cdem_table_add_column(table, "rows", CDEM_COLUMN_INTEGER, "", &fault));
  check_ok(cdem_table_add_column(table, "k1", CDEM_COLUMN_REAL, "N/m", &fault));
  check_ok(cdem_table_add_row(table, &fault));
  cdem_table_set_real(table, 0, 0.25);
  check_ok(cdem_table_set_text(table, 1, "1-2", &fault));
  cdem_table_set_integer(table, 2, INT64_C(9007199254740993));
  cdem_table_set_real(table, 3, 1.0 / 3);
  check_ok(cdem_table_add_row(table, &fault));
  cdem_table_set_real(table, 0, 1e-300);
  check_ok(cdem_table_set_text(table, 1, "a, \"b\"\n\tc\\\x01", &fault));
  cdem_table_set_real(table, 3, INFINITY);
  check_ok(cdem_table_add_row(table, &fault));
}

static void check_file(const char *path, const char *expected) {
  char *text = read_whole(path, NULL);
  assert_non_null(text);
  assert_string_equal(text, expected);
  free(text);
}

static void csv(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  make(&table);
  check_ok(cdem_write_table_csv(in_scratch("t.csv"), &table, &fault));
  check_file(in_scratch("t.csv"), "nu,pair,rows,k1\n"
                                  "0.25,1-2,9007199254740993,0.33333333333333331\n"
                                  "1e-300,\"a, \"\"b\"\"\n\tc\\\x01\",,inf\n"
                                  ",,,\n");
  cdem_table_release(&table);
}

static void json(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  make(&table);
  check_ok(cdem_write_table_json(in_scratch("t.json"), &table, &fault));
  check_file(in_scratch("t.json"),
             "[\n {\"nu\": 0.25, \"pair\": \"1-2\", \"rows\": 9007199254740993, \"k1\": "
             "0.33333333333333331},\n"
             " {\"nu\": 1e-300, \"pair\": \"a, \\\"b\\\"\\n\\tc\\\\\\u0001\", "
             "\"rows\": null, \"k1\": null},\n"
             " {\"nu\": null, \"pair\": null, \"rows\": null, \"k1\": null}\n]\n");
  cdem_table_release(&table);
  check_ok(cdem_write_table_json(in_scratch("e.json"), &table, &fault));
  check_file(in_scratch("e.json"), "[\n]\n");
}

static void checks(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_check_list list = {0};
  check_ok(cdem_check_add(&list,
                          (cdem_check){.group = "springs",
                                       .name = "edge \"1-2\"",
                                       .source = "Wei et al. 2006, eq. 13",
                                       .reference = 0.5,
                                       .value = 0.5,
                                       .tolerance = 1e-12,
                                       .kind = CDEM_CHECK_CLOSED_FORM},
                          &fault));
  check_ok(cdem_check_add(
      &list, (cdem_check){.group = "g", .name = "n", .source = "s", .value = NAN}, &fault));
  FILE *file = fopen(in_scratch("c.json"), "w");
  check_ok(cdem_write_checks_json(file, &list, &fault));
  fclose(file);
  check_file(in_scratch("c.json"),
             "[\n {\"group\": \"springs\", \"name\": \"edge \\\"1-2\\\"\", \"source\": \"Wei et "
             "al. 2006, eq. 13\", \"kind\": \"closed form\", \"reference\": 0.5, \"value\": 0.5, "
             "\"tolerance\": "
             "9.9999999999999998e-13, \"pass\": true},\n"
             " {\"group\": \"g\", \"name\": \"n\", \"source\": \"s\", \"kind\": \"unstated\", "
             "\"reference\": 0, "
             "\"value\": null, \"tolerance\": 0, \"pass\": false}\n]\n");
  file = fopen("/dev/full", "w");
  check_fails(cdem_write_checks_json(file, &list, &fault), CDEM_FILE, "cannot write the checks");
  fclose(file);
  cdem_check_list_release(&list);
}

static void full_devices_and_missing_folders(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  make(&table);
  check_fails(cdem_write_table_csv("/dev/full", &table, &fault), CDEM_FILE, "No space left");
  check_fails(cdem_write_table_json("/dev/full", &table, &fault), CDEM_FILE, "No space left");
  check_fails(cdem_write_table_csv(in_scratch("no/t.csv"), &table, &fault), CDEM_FILE,
              "No such file or directory");
  check_fails(cdem_write_table_json(in_scratch("no/t.json"), &table, &fault), CDEM_FILE,
              "No such file or directory");
  cdem_table_release(&table);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(csv),
      cmocka_unit_test(json),
      cmocka_unit_test(checks),
      cmocka_unit_test(full_devices_and_missing_folders),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
