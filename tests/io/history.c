/* Histories: rows as they were, whatever interrupts their writing. */
#include "io/run_files.h"
#include "io/support.h"

static void add_columns(cdem_table *table) {
  cdem_fault fault = {0};
  check_ok(cdem_table_add_column(table, "time", CDEM_COLUMN_REAL, "s", &fault));
  check_ok(cdem_table_add_column(table, "cracks", CDEM_COLUMN_INTEGER, "", &fault));
  check_ok(cdem_table_add_column(table, "work, outer", CDEM_COLUMN_REAL, "J", &fault));
}

static void set_row(cdem_table *table, int i) {
  cdem_fault fault = {0};
  check_ok(cdem_table_add_row(table, &fault));
  cdem_table_set_real(table, 0, i / 3.0);
  cdem_table_set_integer(table, 1, 10 - i);
  cdem_table_set_real(table, 2, i == 1 ? NAN : i == 2 ? -INFINITY : -1e-300 * i);
}

/* Appends rows from..to - 1. */
static void write_rows(const char *path, int keep, int from, int to) {
  cdem_fault fault = {0};
  cdem_table table = {0};
  cdem_history_writer *writer;
  add_columns(&table);
  check_ok(cdem_history_create(path, &table, keep, &writer, &fault));
  for (int i = from; i < to; i++) {
    set_row(&table, i);
    check_ok(cdem_history_append(writer, &table, &fault));
  }
  cdem_history_destroy(&writer);
  assert_null(writer);
  cdem_history_destroy(&writer);
  cdem_table_release(&table);
}

static const char *const header = "time [s],cracks,\"work, outer [J]\"\n";
static const char *const rows[] = {"0,10,-0\n", "0.33333333333333331,9,\n",
                                   "0.66666666666666663,8,-inf\n",
                                   "1,7,-3.0000000000000002e-300\n"};

static void check_file(const char *path, int count) {
  char expected[512], *text = read_whole(path, NULL);
  strcpy(expected, header);
  for (int i = 0; i < count; i++)
    strcat(expected, rows[i]);
  assert_string_equal(text, expected);
  free(text);
}

static void rows_are_on_disk_as_they_come(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  cdem_history_writer *writer;
  const char *path = in_scratch("history.csv");
  write_whole(path, "something longer that was here before\n");
  add_columns(&table);
  check_ok(cdem_history_create(path, &table, 0, &writer, &fault));
  check_file(path, 0);
  for (int i = 0; i < 4; i++) {
    set_row(&table, i);
    check_ok(cdem_history_append(writer, &table, &fault));
    check_file(path, i + 1);
  }
  cdem_history_destroy(&writer);
  cdem_table_release(&table);
}

static void a_broken_run_goes_on(void **state) {
  (void)state;
  const char *path = in_scratch("resumed.csv");
  for (int keep = 1; keep <= 3; keep++) {
    write_rows(path, 0, 0, 3);
    FILE *file = fopen(path, "ab"); /* what a killed run left behind */
    fputs("0.999,12", file);
    fclose(file);
    write_rows(path, keep, keep, 4);
    check_file(path, 4);
  }
}

static void other_files_are_not_continued(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  cdem_history_writer *writer;
  const char *path = in_scratch("other.csv");
  write_rows(path, 0, 0, 2);
  add_columns(&table);
  check_fails(cdem_history_create(path, &table, 3, &writer, &fault), CDEM_INPUT,
              "it has 2 whole rows and 3 are needed");
  assert_null(writer);
  check_file(path, 2);
  check_ok(cdem_table_add_column(&table, "more", CDEM_COLUMN_REAL, "m", &fault));
  check_fails(cdem_history_create(path, &table, 1, &writer, &fault), CDEM_INPUT,
              "its columns are not those of this run");
  check_fails(cdem_history_create(in_scratch("none.csv"), &table, 1, &writer, &fault), CDEM_FILE,
              "No such file");
  check_file(path, 2);
  check_ok(cdem_history_create(in_scratch("more.csv"), &table, 0, &writer, &fault));
  check_fails(cdem_history_append(writer, &table, &fault), CDEM_USAGE, "has 4 columns and 0 rows");
  cdem_table_release(&table);
  add_columns(&table);
  set_row(&table, 0);
  check_fails(cdem_history_append(writer, &table, &fault), CDEM_USAGE, "its own 4 columns");
  cdem_history_destroy(&writer);
  cdem_table_release(&table);
}

static void histories_read_back(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table;
  const char *path = in_scratch("back.csv");
  write_rows(path, 0, 0, 4);
  FILE *file = fopen(path, "ab");
  fputs("7,1,2,broken", file);
  fclose(file);
  check_ok(cdem_read_history(path, &table, &fault));
  assert_int_equal(table.columns, 3);
  assert_int_equal(table.rows, 4);
  assert_string_equal(table.column[0].name, "time");
  assert_string_equal(table.column[0].unit, "s");
  assert_string_equal(table.column[1].name, "cracks");
  assert_string_equal(table.column[1].unit, "");
  assert_string_equal(table.column[2].name, "work, outer");
  assert_string_equal(table.column[2].unit, "J");
  for (int i = 0; i < 4; i++) {
    assert_true(cdem_table_at(&table, i, 0)->real == i / 3.0);
    assert_true(cdem_table_at(&table, i, 1)->real == 10 - i);
    assert_int_equal(cdem_table_at(&table, i, 2)->absent, i == 1);
  }
  assert_true(cdem_table_at(&table, 2, 2)->real == -INFINITY);
  assert_true(cdem_table_at(&table, 3, 2)->real == -1e-300 * 3);
  cdem_table_release(&table);
}

static void bad_histories_are_named_by_line(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table;
  const char *path = in_scratch("bad.csv");
  static const struct {
    const char *text, *message;
  } bad[] = {{"", "line 1: the header is missing"},
             {"time [s],force", "line 1: the header is missing"},
             {"time [s],force\n1,2\n3\n", "line 3: it has 1 fields, but the header has 2"},
             {"time [s],force\n1,2,3\n", "line 2: it has more fields than the header, which has 2"},
             {"time [s],force\n1,2\n3,much\n", "line 3: 'much' is not a number"}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    write_whole(path, bad[i].text);
    check_fails(cdem_read_history(path, &table, &fault), CDEM_INPUT, bad[i].message);
    assert_int_equal(table.columns, 0);
  }
  check_fails(cdem_read_history(in_scratch("no.csv"), &table, &fault), CDEM_FILE, "cannot read");
}

static void a_full_device_is_reported(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  cdem_history_writer *writer;
  add_columns(&table);
  check_fails(cdem_history_create("/dev/full", &table, 0, &writer, &fault), CDEM_FILE,
              "cannot write '/dev/full': No space left on device; free some space");
  check_fails(cdem_history_create("/no/such/folder/h.csv", &table, 0, &writer, &fault), CDEM_FILE,
              "No such file or directory");
  cdem_table_release(&table);
}

/* In a child whose files may not grow beyond the header and two and a half rows. */
static int fill_disk(const void *path) {
  cdem_fault fault = {0};
  cdem_table table = {0};
  cdem_history_writer *writer;
  add_columns(&table);
  if (cdem_history_create(path, &table, 0, &writer, &fault) != CDEM_OK)
    return 1;
  int written = 0;
  for (int i = 0; i < 4; i++) {
    set_row(&table, i);
    written += cdem_history_append(writer, &table, &fault) == CDEM_OK;
  }
  cdem_history_destroy(&writer);
  cdem_table_release(&table);
  return written == 2 && strstr(fault.message, "File too large; free some space") != NULL ? 0 : 2;
}

static void no_half_row_stays_when_the_disk_is_full(void **state) {
  (void)state;
  const char *path = in_scratch("full.csv");
  size_t room = strlen(header) + strlen(rows[0]) + strlen(rows[1]) + strlen(rows[2]) / 2;
  assert_int_equal(with_file_limit(room, fill_disk, path), 0);
  check_file(path, 2);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_on_disk_as_they_come),
      cmocka_unit_test(a_broken_run_goes_on),
      cmocka_unit_test(other_files_are_not_continued),
      cmocka_unit_test(histories_read_back),
      cmocka_unit_test(bad_histories_are_named_by_line),
      cmocka_unit_test(a_full_device_is_reported),
      cmocka_unit_test(no_half_row_stays_when_the_disk_is_full),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
