/* Springs for ParaView: what VTK's own reader finds in our files. */
#include "io/support.h"

/* Runs VTK's reader; its output, or NULL when VTK is not installed. */
static char *read_by_vtk(const char *path) {
  char command[512];
  snprintf(command, sizeof command, "/usr/bin/python3 '%s/vtk_read.py' '%s' > '%s' 2>'%s'",
           CDEM_TESTS_IO, path, in_scratch("vtk.out"), in_scratch("vtk.err"));
  int result = system(command);
  if (WEXITSTATUS(result) == 77 || WEXITSTATUS(result) == 127)
    return NULL;
  char *complaint = read_whole(in_scratch("vtk.err"), NULL);
  if (result != 0 || complaint[0] != '\0')
    fail_msg("VTK: %s", complaint);
  free(complaint);
  return read_whole(in_scratch("vtk.out"), NULL);
}

/* The next `count` numbers behind a word. */
static void numbers(char **line, const char *word, int count, double *value) {
  if (strncmp(*line, word, strlen(word)) != 0)
    fail_msg("'%.40s' instead of '%s'", *line, word);
  *line += strlen(word);
  for (int i = 0; i < count; i++)
    value[i] = strtod(*line, line);
  *line += strcspn(*line, "\n") + 1;
}

static void same(double value, double expected) {
  if (!(value == expected || (isnan(value) && isnan(expected))))
    fail_msg("%.17g instead of %.17g", value, expected);
}

static void check_cell(const hand_network *hand, const cdem_pair *pair, const cdem_spring_row *row,
                       const double *v) {
  int size = hand->model.formulation == CDEM_SOLID ? 3 : 2;
  same(v[0], 3); /* VTK_LINE */
  same(v[1], 2);
  same(v[2], pair->node[0]);
  same(v[3], pair->node[1]);
  same(v[4], row->stiffness);
  same(v[5], row->coupling);
  for (int c = 0; c < 3; c++) {
    same(v[6 + c], c < size ? row->dir[c] : 0.0);
    same(v[9 + c], c < size ? row->dual[c] : 0.0);
  }
  same(v[12], pair->set.cond);
  same(v[13], 4711);
  same(v[14], pair->class_);
  same(v[15], pair->set.form);
  same(v[16], row->spring);
  same(v[17], row->couples_to);
}

static void round_trip(const char *element, const char *ending) {
  cdem_fault fault = {0};
  hand_network hand;
  hand_network_init(&hand, element);
  char path[256];
  snprintf(path, sizeof path, "%s/%s.%s", scratch, element, ending);
  check_ok(hand_write(&hand, cdem_springs_format_of(path), path, 5, 1, &fault));
  char *text = read_by_vtk(path), *line = text;
  if (text == NULL) {
    hand_network_release(&hand);
    print_message("VTK's Python reader is not installed: skipped\n");
    skip();
  }
  char expected[64];
  snprintf(expected, sizeof expected, "points %d cells %d\n", hand.mesh.nodes, hand.rows);
  assert_memory_equal(line, expected, strlen(expected));
  line += strlen(expected);
  const char *const words =
      "class names edge face body\nform names diagonal jordan2 jordan3 complex frame\n";
  assert_memory_equal(line, words, strlen(words));
  line += strlen(words);
  double v[18];
  for (int n = 0; n < hand.mesh.nodes; n++) {
    numbers(&line, "point", 4, v);
    same(v[0], (double)hand.mesh.node_tag[n]);
    for (int c = 0; c < 3; c++)
      same(v[1 + c], hand.mesh.xyz[3 * n + c]);
  }
  for (int64_t p = 0; p < hand.model.pairs; p++)
    for (int r = 0; r < hand.pair[p].set.rows; r++) {
      numbers(&line, "cell", 18, v);
      check_cell(&hand, &hand.pair[p], &hand.pair[p].set.row[r], v);
    }
  assert_string_equal(line, "");
  free(text);
  hand_network_release(&hand);
}

static void solids_as_polydata(void **state) {
  (void)state;
  round_trip("hex8", "vtp");
}

static void solids_as_a_grid(void **state) {
  (void)state;
  round_trip("hex8", "vtu");
}

static void plane_elements(void **state) {
  (void)state;
  round_trip("quad4", "vtp");
}

static void cosserat_elements(void **state) {
  (void)state;
  round_trip("quad4-cosserat", "vtp");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solids_as_polydata),
      cmocka_unit_test(solids_as_a_grid),
      cmocka_unit_test(plane_elements),
      cmocka_unit_test(cosserat_elements),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
