/* A comma locale changes no file and no number read: every writer and reader of the room. */
#include "io/run_files.h"
#include "io/support.h"
#include "io/text.h"

static bool comma;

static int setup(void **state) {
  if (scratch_make(state) != 0)
    return 1;
  comma = use_comma_locale();
  setlocale(LC_ALL, "C");
  return 0;
}

/* Skips without such a locale; otherwise switches to it. */
static void to_comma(void) {
  if (!comma) {
    print_message("no locale with a decimal comma can be made: skipped\n");
    skip();
  }
  use_comma_locale();
}

static int to_c(void **state) {
  (void)state;
  setlocale(LC_ALL, "C");
  return 0;
}

static void numbers(void **state) {
  (void)state;
  to_comma();
  /* 0.1 takes the exact path through printf, 1/3 the fast one. */
  const double values[] = {0.1, 1.0 / 3, 12.5, 1e-300};
  const char *const texts[] = {"0.10000000000000001", "0.33333333333333331", "12.5", "1e-300"};
  for (int i = 0; i < 4; i++) {
    char text[CDEM_REAL_WIDTH + 1], *end;
    *cdem_put_real(text, values[i]) = '\0';
    assert_string_equal(text, texts[i]);
    assert_true(cdem_get_real(text, &end) == values[i]);
    assert_int_equal(*end, '\0');
  }
}

static void quantities(void **state) {
  (void)state;
  cdem_fault fault = {0};
  double value = 0.0;
  to_comma();
  check_ok(cdem_parse_quantity("40.5 GPa", CDEM_PRESSURE, &value, &fault));
  check_near(value, 40.5e9, 1e-15, 0);
  check_fails(cdem_parse_quantity("40,5 GPa", CDEM_PRESSURE, &value, &fault), CDEM_INPUT,
              "decimals with a point");
  assert_true(strcmp(setlocale(LC_NUMERIC, NULL), "C") != 0);
}

static char *written(const hand_network *hand, const cdem_springs_format *format, size_t *bytes) {
  cdem_fault fault = {0};
  check_ok(hand_write(hand, format, in_scratch("s"), 28, 1, &fault));
  char *text = read_whole(in_scratch("s"), bytes);
  unlink(in_scratch("s"));
  return text;
}

static void springs(void **state) {
  (void)state;
  hand_network hand;
  hand_network_init(&hand, "hex8");
  hand_make_symmetric(&hand);
  for (int f = 0; cdem_springs_format_at(f) != NULL; f++) {
    const cdem_springs_format *format = cdem_springs_format_at(f);
    if (strcmp(format->name, "h5") == 0)
      continue; /* binary but for the material, which hdf5.c compares */
    size_t bytes[2];
    setlocale(LC_ALL, "C");
    char *plain = written(&hand, format, &bytes[0]);
    to_comma();
    char *other = written(&hand, format, &bytes[1]);
    assert_int_equal(bytes[0], bytes[1]);
    assert_memory_equal(plain, other, bytes[0]);
    free(plain);
    free(other);
  }
  hand_network_release(&hand);
}

static void tables(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0};
  to_comma();
  check_ok(cdem_table_add_column(&table, "x", CDEM_COLUMN_REAL, "", &fault));
  check_ok(cdem_table_add_row(&table, &fault));
  cdem_table_set_real(&table, 0, 0.1);
  check_ok(cdem_write_table_csv(in_scratch("t.csv"), &table, &fault));
  char *text = read_whole(in_scratch("t.csv"), NULL);
  assert_string_equal(text, "x\n0.10000000000000001\n");
  free(text);
  cdem_table_release(&table);
}

static void histories(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_table table = {0}, back;
  cdem_history_writer *writer;
  to_comma();
  check_ok(cdem_table_add_column(&table, "x", CDEM_COLUMN_REAL, "m", &fault));
  check_ok(cdem_history_create(in_scratch("h.csv"), &table, 0, &writer, &fault));
  check_ok(cdem_table_add_row(&table, &fault));
  cdem_table_set_real(&table, 0, 0.1);
  check_ok(cdem_history_append(writer, &table, &fault));
  cdem_history_destroy(&writer);
  char *text = read_whole(in_scratch("h.csv"), NULL);
  assert_string_equal(text, "x [m]\n0.10000000000000001\n");
  free(text);
  check_ok(cdem_read_history(in_scratch("h.csv"), &back, &fault));
  assert_true(cdem_table_at(&back, 0, 0)->real == 0.1);
  cdem_table_release(&back);
  cdem_table_release(&table);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_teardown(numbers, to_c),   cmocka_unit_test_teardown(quantities, to_c),
      cmocka_unit_test_teardown(springs, to_c),   cmocka_unit_test_teardown(tables, to_c),
      cmocka_unit_test_teardown(histories, to_c),
  };
  return cmocka_run_group_tests(tests, setup, scratch_remove);
}
