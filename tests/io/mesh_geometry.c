/* Room io: .geo and .step through gmsh: options of the file, groups, gmsh's own errors, and what
 * gmsh must not change in the process. */
#include "io/mesh_support.h"

#include <locale.h>
#include <signal.h>

#define LOOP                                                                                       \
  "Point(1) = {0, 0, 0}; Point(2) = {1.5, 0, 0}; Point(3) = {1.5, 1, 0}; Point(4) = {0, 1, 0};\n"  \
  "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"                      \
  "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
#define SQUARE                                                                                     \
  LOOP "Transfinite Curve {1, 3} = 4; Transfinite Curve {2, 4} = 3;\n"                             \
       "Transfinite Surface {1}; Recombine Surface {1};\n"
#define BOX     SQUARE "e[] = Extrude {0, 0, 2} { Surface{1}; Layers{2}; Recombine; };\n"
#define ORDER_2 "Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1;\n"

static void dimension_and_options_of_the_file(void **state) {
  (void)state;
  const struct {
    const char *text;
    cdem_shape shape;
    int count;
    double measure;
  } known[] = {{SQUARE, CDEM_SHAPE_QUAD4, 6, 1.5},
               {SQUARE ORDER_2, CDEM_SHAPE_QUAD8, 6, 1.5},
               {BOX, CDEM_SHAPE_HEX8, 12, 3},
               {BOX ORDER_2, CDEM_SHAPE_HEX20, 12, 3},
               {SQUARE "Mesh 2;\n", CDEM_SHAPE_QUAD4, 6, 1.5},
               {SQUARE "Mesh 2;\nRefineMesh;\n", CDEM_SHAPE_QUAD4, 24, 1.5}};
  for (int i = 0; i < 6; i++) {
    cdem_mesh mesh = read_mesh(write_text("a.geo", known[i].text));
    assert_int_equal(count_shape(&mesh, known[i].shape), known[i].count);
    assert_int_equal(mesh.groups, 0);
    double sum = 0;
    for (int32_t c = 0; c < mesh.cells; c++)
      if (mesh.cell_shape[c] == known[i].shape)
        sum += cell_measure(&mesh, c);
    check_near(sum, known[i].measure, 1e-12, 0);
    check_mid_nodes(&mesh, 1e-10); /* gmsh places nodes on curves to about 1e-12 */
    cdem_mesh_release(&mesh);
  }
}

static void groups_and_what_lies_outside_them(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(write_text("a.geo", BOX "Physical Volume(\"all\") = {e[1]};\n"
                                                     "Physical Volume(\"also\") = {e[1]};\n"
                                                     "Physical Surface(7) = {1};\n"));
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_HEX8), 12);
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_QUAD4), 32); /* 6 + 6 + 2 (6 + 4) */
  assert_int_equal(cdem_mesh_find_group(&mesh, "all")->cells, 12);
  assert_int_equal(cdem_mesh_find_group(&mesh, "also")->cells, 12);
  assert_int_equal(cdem_mesh_find_group(&mesh, "7")->cells, 6);
  assert_int_equal(mesh.groups, 3);
  cdem_mesh_release(&mesh);
  check_unreadable(write_text("a.geo", BOX "Physical Volume(\"all\") = {e[1]};\n"
                                           "Physical Surface(\"all\") = {1};\n"),
                   CDEM_INPUT, "group 'all' is of mixed dimension");
}

static void errors_are_gmshs_own(void **state) {
  (void)state;
  check_unreadable(write_text("a.geo", "Point(1) = {0, 0;\n"), CDEM_INPUT, "syntax error");
  check_unreadable(write_text("a.geo", SQUARE "Curve Loop(9) = {1, 2, 77};\n"
                                              "Plane Surface(9) = {9};\n"),
                   CDEM_INPUT, "gmsh, reading the geometry: Unknown curve 77");
  check_unreadable(write_text("a.geo", LOOP "Surface Loop(1) = {1}; Volume(1) = {1};\n"),
                   CDEM_INPUT, "gmsh, meshing: No elements in volume 1");
  check_unreadable(write_text("a.geo", SQUARE "Mesh.MeshOnlyVisible = 1; Hide { Surface{1}; }\n"),
                   CDEM_INPUT, "gmsh, meshing: surface 1 got no elements");
  check_unreadable(write_text("a.geo", ""), CDEM_INPUT, "the file is empty");
  check_unreadable(write_text("a.geo", "x = 1;\n"), CDEM_INPUT, "no curve, surface or volume");
  check_unreadable(write_text("a.geo", SQUARE "Mesh.Algorithm = 8;\n"), CDEM_INPUT,
                   "Mesh.Algorithm = 8 ends gmsh");
  check_unreadable(write_text("a.geo", SQUARE "Mesh.ElementOrder = 2;\n"), CDEM_INPUT,
                   "is a quad9 (gmsh type 10), which has no springs here; set "
                   "Mesh.SecondOrderIncomplete = 1");
  check_unreadable(write_text("a.geo", BOX "Mesh.ElementOrder = 3;\n"), CDEM_INPUT, "is a hex64");
  check_unreadable(write_text("a.step", "no STEP file\n"), CDEM_INPUT,
                   "line 1: the file does not start with ISO-10303-21;");
  check_unreadable(write_text("a.step", "ISO-10303-21;\nHEADER;\n"), CDEM_INPUT,
                   "the file does not end with END-ISO-10303-21;");
  check_unreadable(in_folder("none.geo"), CDEM_FILE, "No such file");
  check_unreadable(in_folder("none.step"), CDEM_FILE, "No such file");
}

static void a_failure_does_not_spoil_the_next_file(void **state) {
  (void)state;
  for (int i = 0; i < 3; i++) {
    check_unreadable(write_text("a.geo", "Point(1) = {0, 0;\n"), CDEM_INPUT, "syntax error");
    cdem_mesh mesh = read_mesh(write_text("a.geo", BOX));
    assert_int_equal(count_shape(&mesh, CDEM_SHAPE_HEX8), 12);
    cdem_mesh_release(&mesh);
  }
}

/* Handlers, locale and standard streams are the caller's. */
static void the_process_is_left_as_it_was(void **state) {
  (void)state;
  struct sigaction before[32], after;
  for (int s = 1; s < 32; s++)
    sigaction(s, NULL, &before[s]);
  const char *comma = setlocale(LC_NUMERIC, "de_DE.UTF-8");
  char name[100];
  snprintf(name, sizeof name, "%s", setlocale(LC_NUMERIC, NULL));
  cdem_mesh mesh = read_mesh(write_text("a.geo", BOX));
  assert_string_equal(setlocale(LC_NUMERIC, NULL), name);
  check_near(mesh.xyz[3], 1.5, 0, 0); /* node 2, whatever the decimal mark is */
  cdem_mesh_release(&mesh);
  for (int s = 1; s < 32; s++) {
    sigaction(s, NULL, &after);
    assert_ptr_equal((void *)before[s].sa_handler, (void *)after.sa_handler);
  }
  if (comma != NULL)
    setlocale(LC_NUMERIC, "C");
}

static void warnings_are_passed_on(void **state) {
  (void)state;
  heard said = {0};
  cdem_mesh mesh = {0};
  const char *path = write_text("a.geo", SQUARE "Mesh.MshFileVersion = 2.2; Mesh.NoSuch = 1;\n");
  cdem_status status = cdem_read_mesh(path, &mesh, &(cdem_warnings){&said, hear}, &fault);
  if (status == CDEM_OK) /* this gmsh warns of unknown options, others may refuse them */
    assert_true(said.count > 0 && strstr(said.last, "gmsh: ") != NULL);
  else
    assert_int_equal(status, CDEM_INPUT);
  memset(&fault, 0, sizeof fault);
  cdem_mesh_release(&mesh);
}

static void allocation_failures_leave_nothing(void **state) {
  (void)state;
  const char *path = write_text("a.geo", SQUARE "Physical Surface(\"all\") = {1};\n");
  for (int after = 0;; after++) {
    cdem_mesh mesh = {0};
    memset(&fault, 0, sizeof fault);
    cdem_memory_fail_after(after);
    cdem_status status = cdem_read_mesh(path, &mesh, NULL, &fault);
    cdem_memory_fail_after(-1);
    cdem_mesh_release(&mesh);
    if (status == CDEM_OK) {
      assert_true(after > 15);
      break;
    }
    assert_int_equal(status, CDEM_MEMORY);
  }
  memset(&fault, 0, sizeof fault);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(dimension_and_options_of_the_file),
      cmocka_unit_test(groups_and_what_lies_outside_them),
      cmocka_unit_test(errors_are_gmshs_own),
      cmocka_unit_test(a_failure_does_not_spoil_the_next_file),
      cmocka_unit_test(the_process_is_left_as_it_was),
      cmocka_unit_test(warnings_are_passed_on),
      cmocka_unit_test(allocation_failures_leave_nothing),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
