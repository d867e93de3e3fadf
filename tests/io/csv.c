/* Springs as CSV: the stable columns, and the spring tensor from the rows alone. */
#include "io/support.h"

enum { MAX_FIELDS = 24 };

/* Cuts a line at its commas; empty fields stay. */
static int cut(char *line, char *field[MAX_FIELDS]) {
  int count = 0;
  for (char *at = line; at != NULL && count < MAX_FIELDS;) {
    char *comma = strchr(at, ',');
    field[count++] = at;
    if (comma != NULL)
      *comma++ = '\0';
    at = comma;
  }
  return count;
}

static double number(const char *field) {
  char *end;
  double value = strtod(field, &end);
  assert_true(end != field && *end == '\0');
  return value;
}

static void check_header(const char *line, const char *more) {
  char expected[256];
  snprintf(expected, sizeof expected,
           "element,kind,node_i,node_j,class,form,spring,stiffness,couples_to,coupling,"
           "dir_x,dir_y,dir_z,dual_x,dual_y,dual_z,cond%s",
           more);
  assert_string_equal(line, expected);
}

/* Fields of one row that are the same for all rows of a pair. */
static void check_pair(const hand_network *hand, const cdem_pair *pair, char *const *field,
                       const char *kind) {
  char text[32];
  assert_string_equal(field[0], "4711");
  assert_string_equal(field[1], kind);
  for (int n = 0; n < 2; n++) {
    snprintf(text, sizeof text, "%lld", (long long)hand->mesh.node_tag[pair->node[n]]);
    assert_string_equal(field[2 + n], text);
  }
  assert_string_equal(field[4], cdem_class_name((cdem_class)pair->class_));
  assert_string_equal(field[5], cdem_form_name((cdem_form)pair->set.form));
  if (pair->set.form == CDEM_FORM_FRAME)
    assert_string_equal(field[16], "");
  else
    assert_true(number(field[16]) == pair->set.cond);
}

/* One row of text back into a row of numbers. */
static cdem_spring_row read_row(char *const *field, int size, bool cosserat) {
  cdem_spring_row row = {.spring = (int8_t)number(field[6]), .stiffness = number(field[7])};
  assert_int_equal(field[8][0] == '\0', field[9][0] == '\0');
  if (field[8][0] != '\0') {
    row.couples_to = (int8_t)number(field[8]);
    row.coupling = number(field[9]);
  }
  for (int c = 0; c < 3; c++) {
    bool rotation = c == 2 && cosserat, there = c < size && !rotation;
    if (there || rotation) {
      row.dir[c] = number(field[rotation ? 17 : 10 + c]);
      row.dual[c] = number(field[rotation ? 18 : 13 + c]);
    }
    if (!there) {
      assert_string_equal(field[10 + c], "");
      assert_string_equal(field[13 + c], "");
    }
  }
  return row;
}

/* Writes the network and reads it back pair by pair. 17 digits return each double exactly, so the
 * tensors must agree to the last bit. */
static void round_trip(const char *element, const char *more) {
  cdem_fault fault = {0};
  hand_network hand;
  hand_network_init(&hand, element);
  bool cosserat = hand.model.formulation == CDEM_PLANE_COSSERAT;
  int size = hand.model.dofs, lines = 0;
  check_ok(hand_write(&hand, &*cdem_springs_format_find("csv"), in_scratch("s.csv"), 5, 1, &fault));
  char *text = read_whole(in_scratch("s.csv"), NULL), *rest = text;
  check_header(strsep(&rest, "\n"), more);
  for (int64_t p = 0; p < hand.model.pairs; p++) {
    const cdem_pair *pair = &hand.pair[p];
    cdem_spring_row row[CDEM_SPRING_ROWS];
    double rebuilt[9], expected[9];
    for (int r = 0; r < pair->set.rows; r++, lines++) {
      char *field[MAX_FIELDS];
      assert_int_equal(cut(strsep(&rest, "\n"), field), cosserat ? 20 : 17);
      check_pair(&hand, pair, field, element);
      if (cosserat)
        assert_true(number(field[19]) == hand.model.length);
      row[r] = read_row(field, size, cosserat);
    }
    rows_to_block(row, pair->set.rows, size, rebuilt);
    rows_to_block(pair->set.row, pair->set.rows, size, expected);
    assert_memory_equal(rebuilt, expected, sizeof(double) * (size_t)(size * size));
  }
  assert_int_equal(lines, hand.rows);
  assert_string_equal(rest, "");
  free(text);
  hand_network_release(&hand);
}

static void solids(void **state) {
  (void)state;
  round_trip("hex8", "");
}

static void plane_elements(void **state) {
  (void)state;
  round_trip("quad4", "");
}

static void cosserat_elements(void **state) {
  (void)state;
  round_trip("quad4-cosserat", ",dir_rz,dual_rz,length");
}

/* The test's own equation (1) is that of room springs. */
static void the_formula_is_that_of_the_springs(void **state) {
  (void)state;
  hand_network hand;
  hand_network_init(&hand, "hex8");
  for (int64_t p = 0; p < hand.model.pairs; p++) {
    double ours[9], theirs[9];
    rows_to_block(hand.pair[p].set.row, hand.pair[p].set.rows, 3, ours);
    cdem_springs_rebuild(&hand.pair[p].set, theirs);
    for (int e = 0; e < 9; e++) /* four terms of size 1e9, summed in another order */
      check_near(ours[e], theirs[e], 0, 4e9 * 8 * 0x1p-53);
  }
  hand_network_release(&hand);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solids),
      cmocka_unit_test(plane_elements),
      cmocka_unit_test(cosserat_elements),
      cmocka_unit_test(the_formula_is_that_of_the_springs),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
