/* Room io: numbers set in a .geo file. */
#include "io/mesh_support.h"

#include <locale.h>

#define LINE                                                                                       \
  "Point(1) = {0, 0, 0}; Point(2) = {length, 0, 0}; Point(3) = {length, 1, 0};\n"                  \
  "Point(4) = {0, 1, 0}; Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, "     \
  "1};\n"                                                                                          \
  "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Transfinite Curve {1, 3} = n + 1;\n"      \
  "Transfinite Curve {2, 4} = 2; Transfinite Surface {1}; Recombine Surface {1};\n"
#define DECLARED                                                                                   \
  "// DefineConstant[ commented = 3 ];\n/* DefineConstant[ also = 3 ]; */\n"                       \
  "DefineConstant[\n  length = 2, // a, b ]\n  n = {3, Min 1, Max 99, Name \"Parameters/n\"},\n"   \
  "  label = \"text, not = a number\",\n  title = {\"x\", Name \"Title\"} ];\n"                    \
  "DefineConstant [ unused ];\n"

static cdem_status read_with(const char *path, int count, const char *const *name,
                             const double *value, cdem_mesh *mesh) {
  memset(&fault, 0, sizeof fault);
  return cdem_read_mesh_with(path, count, name, value, mesh, NULL, &fault);
}

/* By name of the constant, with attributes or without; what is not set keeps its number, also
 * after a reading that set it. */
static void numbers_are_set(void **state) {
  (void)state;
  static const char *const name[] = {"n", "length"};
  static const double value[] = {5, 0.1}; /* 0.1 needs all its digits */
  const char *path = write_text("a.geo", DECLARED LINE);
  static const struct {
    int count, first, quads;
    double length;
  } runs[] = {{0, 0, 3, 2}, {1, 0, 5, 2}, {2, 0, 5, 0.1}, {1, 1, 3, 0.1}, {0, 0, 3, 2}};
  for (int i = 0; i < 5; i++) {
    cdem_mesh mesh = {0};
    int first = runs[i].first;
    check_ok(read_with(path, runs[i].count, name + first, value + first, &mesh));
    assert_int_equal(count_shape(&mesh, CDEM_SHAPE_QUAD4), runs[i].quads);
    double right = 0;
    for (int32_t n = 0; n < mesh.nodes; n++)
      right = mesh.xyz[3 * n] > right ? mesh.xyz[3 * n] : right;
    assert_true(right == runs[i].length);
    assert_string_equal(mesh.source, path);
    cdem_mesh_release(&mesh);
  }
}

static void a_decimal_comma_changes_nothing(void **state) {
  (void)state;
  static const char *const name[] = {"length"};
  static const double value[] = {0.1};
  cdem_mesh mesh = {0};
  setlocale(LC_ALL, "de_DE.UTF-8"); /* where it is installed */
  check_ok(read_with(write_text("a.geo", DECLARED LINE), 1, name, value, &mesh));
  setlocale(LC_ALL, "C");
  assert_true(mesh.xyz[3] == 0.1);
  cdem_mesh_release(&mesh);
}

static void names_that_are_none(void **state) {
  (void)state;
  static const char *const name[] = {"lenght", "commented", "also", "label", "Min", "x", "length"};
  static const double value[] = {1, 1, 1, 1, 1, 1, INFINITY};
  const char *path = write_text("a.geo", DECLARED LINE);
  cdem_mesh mesh = {0};
  check_fails(read_with(path, 1, name, value, &mesh), CDEM_INPUT,
              "a.geo': the geometry has no parameter 'lenght'; it has: length, n, unused; did you "
              "mean 'length'?");
  for (int i = 1; i < 6; i++) {
    assert_int_equal(read_with(path, 1, name + i, value, &mesh), CDEM_INPUT);
    if (strstr(fault.message, "it has: length, n, unused") == NULL)
      fail_msg("%s: %s", name[i], fault.message);
  }
  check_fails(read_with(path, 1, name + 6, value + 6, &mesh), CDEM_INPUT,
              "parameter 'length' is inf and must be finite");
  check_fails(
      read_with(write_text("b.geo", "length = 1; n = 1;\n" LINE), 1, name + 6, value, &mesh),
      CDEM_INPUT,
      "the geometry has no parameter 'length': no number is declared by DefineConstant[]");
  check_fails(read_with(in_folder("none.geo"), 1, name, value, &mesh), CDEM_FILE, "No such file");
  assert_null(mesh.xyz);
}

static void other_formats_have_none(void **state) {
  (void)state;
  static const char *const name[] = {"h"};
  static const double value[] = {1};
  cdem_mesh mesh = {0};
  static const char *const files[] = {"a.msh", "a.inp", "a.step"};
  for (int i = 0; i < 3; i++)
    check_fails(read_with(write_text(files[i], "anything\n"), 1, name, value, &mesh), CDEM_INPUT,
                "parameter 'h' has no meaning here: only .geo files have parameters");
}

/* Text that ends in the middle of something. */
static void cut_declarations(void **state) {
  (void)state;
  static const char *const name[] = {"zz"};
  static const double value[] = {1};
  static const char text[] = DECLARED;
  cdem_mesh mesh = {0};
  char part[sizeof text];
  for (size_t length = 1; length < sizeof text; length++) {
    memcpy(part, text, length);
    part[length] = '\0';
    check_fails(read_with(write_text("a.geo", part), 1, name, value, &mesh), CDEM_INPUT,
                "the geometry has no parameter 'zz'");
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_are_set),     cmocka_unit_test(a_decimal_comma_changes_nothing),
      cmocka_unit_test(names_that_are_none), cmocka_unit_test(other_formats_have_none),
      cmocka_unit_test(cut_declarations),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
