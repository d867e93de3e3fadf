/* Room io: MSH files written by hand: groups, tags, and every refusal with its line. */
#include "io/mesh_support.h"

#include <locale.h>
#include <sys/stat.h>

/* A line of two quads; tags with gaps, out of order; quad 70 in two groups (listed twice, as gmsh
 * does), an unnamed group 7, node 99 and point 2 used by nothing that counts. */
static const char quads22[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                              "$PhysicalNames\n3\n2 1 \"left part\"\n2 2 \"both\"\n1 3 \"edge\"\n"
                              "$EndPhysicalNames\n"
                              "$Nodes\n7\n"
                              "10 0 0 0\n"
                              "20 1 0 0\n"
                              "1000000007 2 0 0\n"
                              "11 0 1 0\n"
                              "21 1 1 0\n"
                              "31 2.5e0 1 0\n"
                              "99 5 5 5\n"
                              "$EndNodes\n"
                              "$Elements\n6\n"
                              "2 15 2 0 1 99\n"
                              "5 1 2 3 1 10 11\n"
                              "70 3 2 1 1 10 20 21 11\n"
                              "71 3 2 2 1 10 20 21 11\n"
                              "80 3 2 2 2 20 1000000007 31 21\n"
                              "81 1 2 7 9 10 20\n"
                              "$EndElements\n";

static const char quads41[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n2 1 \"left part\"\n2 2 \"both\"\n1 3 \"edge\"\n$EndPhysicalNames\n"
    "$Entities\n1 2 2 0\n1 0 0 0 0\n1 0 0 0 0 1 0 1 3 0\n9 0 0 0 1 0 0 1 -7 0\n"
    "1 0 0 0 1 1 0 2 1 2 0\n2 1 0 0 2 1 0 1 2 0\n$EndEntities\n"
    "$Nodes\n2 7 10 1000000007\n"
    "2 1 0 5\n10\n20\n1000000007\n11\n21\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n"
    "1 9 1 2\n31\n99\n2.5 1 0 0.5\n5 5 5 0.7\n$EndNodes\n"
    "$Elements\n5 5 2 81\n"
    "0 1 15 1\n2 99\n"
    "1 1 1 1\n5 10 11\n"
    "2 1 3 1\n70 10 20 21 11\n"
    "2 2 3 1\n80 20 1000000007 31 21\n"
    "1 9 1 1\n81 10 20\n"
    "$EndElements\n";

static void check_quads(const char *path) {
  cdem_mesh mesh = read_mesh(path);
  assert_int_equal(mesh.nodes, 6);
  assert_int_equal(mesh.cells, 4);
  assert_int_equal(mesh.node_tag[2], 1000000007);
  check_near(mesh.xyz[3 * 5], 2.5, 0, 0);
  assert_int_equal(mesh.groups, 4);
  const cdem_group *left = cdem_mesh_find_group(&mesh, "left part");
  const cdem_group *both = cdem_mesh_find_group(&mesh, "both");
  const cdem_group *edge = cdem_mesh_find_group(&mesh, "edge");
  const cdem_group *seven = cdem_mesh_find_group(&mesh, "7");
  assert_int_equal(left->cells, 1);
  assert_int_equal(mesh.cell_tag[left->cell[0]], 70);
  assert_int_equal(both->cells, 2);
  assert_int_equal(both->cell[0], left->cell[0]);
  assert_int_equal(mesh.cell_tag[both->cell[1]], 80);
  assert_int_equal(edge->dimension, 1);
  assert_int_equal(mesh.cell_tag[edge->cell[0]], 5);
  assert_int_equal(seven->cells, 1);
  const int32_t *node = cdem_mesh_cell(&mesh, both->cell[1]);
  const int expected[4] = {1, 2, 5, 4};
  for (int i = 0; i < 4; i++)
    assert_int_equal(node[i], expected[i]);
  cdem_mesh_release(&mesh);
}

static void both_versions_give_the_same_mesh(void **state) {
  (void)state;
  check_quads(write_text("a.msh", quads22));
  check_quads(write_text("b.MSH", quads41));
}

static void line_ends_of_windows_and_other_sections_do_not_matter(void **state) {
  (void)state;
  char text[2 * sizeof quads22 + 200], *out = text;
  out += sprintf(out, "$Comments\nanything\n$EndComments\n");
  for (const char *at = quads22; *at != '\0'; at++) {
    if (*at == '\n')
      *out++ = '\r';
    *out++ = *at;
  }
  strcpy(out, "$NodeData\n1\n\"u\"\n$EndNodeData\n");
  check_quads(write_text("a.msh", text));
}

/* The first locale with a decimal comma, if the machine has one; the reader must not care, nor may
 * it leave another locale behind. */
static void decimal_comma_does_not_matter(void **state) {
  (void)state;
  const char *names[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "fr_FR"}, *set = NULL;
  for (int i = 0; i < 4 && set == NULL; i++)
    set = setlocale(LC_NUMERIC, names[i]);
  check_quads(write_text("a.msh", quads22));
  check_quads(write_text("b.msh", quads41));
  setlocale(LC_NUMERIC, "C");
}

static void group_of_two_dimensions_is_refused(void **state) {
  (void)state;
  char *text = replaced(quads22, "\"edge\"", "\"both\"");
  check_unreadable(write_text("a.msh", text), CDEM_INPUT,
                   "group 'both' is of mixed dimension: it has cells of dimension 2 and of "
                   "dimension 1; use one name a dimension");
  free(text);
}

static void same_number_in_two_dimensions_is_told_apart(void **state) {
  (void)state;
  char *unnamed = replaced(quads22, "3\n2 1 \"left part\"\n2 2 \"both\"\n1 3 \"edge\"\n", "0\n");
  char *text = replaced(unnamed, "5 1 2 3 1", "5 1 2 2 1");
  cdem_mesh mesh = read_mesh(write_text("a.msh", text));
  assert_int_equal(cdem_mesh_find_group(&mesh, "2")->dimension, 2);
  assert_int_equal(cdem_mesh_find_group(&mesh, "curve 2")->dimension, 1);
  assert_int_equal(cdem_mesh_find_group(&mesh, "7")->dimension, 1);
  cdem_mesh_release(&mesh);
  free(text);
  free(unnamed);
}

static void point_cells_stay_in_groups_only(void **state) {
  (void)state;
  char *text = replaced(quads22, "2 15 2 0 1 99", "2 15 2 4 1 99");
  cdem_mesh mesh = read_mesh(write_text("a.msh", text));
  assert_int_equal(mesh.nodes, 7);
  assert_int_equal(cdem_mesh_find_group(&mesh, "4")->dimension, 0);
  cdem_mesh_release(&mesh);
  free(text);
}

/* One change of a good file, and what must be said. The text starts with the path. */
static const struct {
  const char *base, *old, *with, *message;
} wrong[] = {
    {quads22, "20 1 0 0", "20 nan 0 0", "line 13: node 20: coordinate x is nan, not a finite"},
    {quads22, "20 1 0 0", "20 1 -inf 0", "line 13: node 20: coordinate y is -inf, not a finite"},
    {quads22, "20 1 0 0", "20 1x 0 0", "line 13: '1x' in $Nodes is not a number"},
    {quads22, "20 1 0 0", "20 0x1 0 0", "line 13: '0x1' in $Nodes is not a number"},
    {quads22, "20 1 0 0", "20 1,5 0 0", "line 13: '1,5' in $Nodes is not a number"},
    {quads22, "20 1 0 0", "2.5 1 0 0", "line 13: '2.5' in $Nodes is not a whole number"},
    {quads22, "20 1 0 0", "10 1 0 0", "line 13: node 10 is defined twice"},
    {quads22, "20 1 0 0\n", "", "line 18: $EndNodes comes before all entries announced by $Nodes"},
    {quads22, "99 5 5 5\n", "99 5 5 5\n98 5 5 5\n",
     "line 19: '98' stands where $EndNodes should: more entries than announced"},
    {quads22, "31 21\n81", "9000 21\n81",
     "line 26: element 80 names node 9000, which is not defined"},
    {quads22, "20 1000000007 31 21", "20 20 31 21", "line 26: element 80 names node 20 twice"},
    {quads22, "81 1 2 7", "80 1 2 7", "line 27: element 80 is defined twice"},
    {quads22, "81 1 2 7", "81 200 2 7", "line 27: elements of gmsh type 200 are not known"},
    {quads22, "$EndElements", "", "the file ends where $EndElements should stand"},
    {quads22, "$EndElements\n", "$EndEleme", "'$EndEleme' stands where $EndElements should"},
    {quads22, "$Elements\n6", "$Elements\n6000000", "announces 6000000 entries, but only"},
    {quads22, "$Elements\n6", "$Elements\n-6", "announces -6 entries"},
    {quads22, "2.2 0 8", "2.1 0 8",
     "line 2: MSH version 2.1 is not read, only 2.2 and 4.1; convert"},
    {quads22, "2.2 0 8", "2.2 2 8", "line 2: the file type 2 and data size 8 must be"},
    {quads22, "2.2 0 8", "2.2 0 4", "line 2: the file type 0 and data size 4 must be"},
    {quads22, "1 3 \"edge\"", "1 3 edge", "line 8: a physical name is a dimension"},
    {quads22, "1 3 \"edge\"", "4 3 \"edge\"", "line 8: a physical name is a dimension"},
    {quads22, "1 3 \"edge\"", "2 1 \"edge\"",
     "line 8: physical group 1 of dimension 2 is named twice"},
    {quads22, "$Nodes", "$Knots", "is not closed by $EndKnots"},
    {quads22, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "",
     "line 1: $PhysicalNames comes before $MeshFormat"},
    {quads22, "$Elements\n", "garbage\n$Elements\n",
     "line 20: 'garbage' stands where a section such as $Nodes should start"},
    {quads22, "$Elements\n", "$Nodes\n0\n$EndNodes\n$Elements\n",
     "line 20: a second section $Nodes"},
    {quads41, "1 1 0\n1 9", "1 nan 0\n1 9", "line 30: node 21: coordinate y is nan"},
    {quads41, "\n20\n1000000007\n11", "\n20\n20\n11", "line 23: node 20 is defined twice"},
    {quads41, "80 20 1000000007", "80 20 9000", "line 46: element 80 names node 9000, which is"},
    {quads41, "80 20 1000000007", "70 20 1000000007", "line 46: element 70 is defined twice"},
    {quads41, "2 7 10 1000000007", "2 8 10 1000000007",
     "$Nodes announces 8 entries, but its blocks hold 7"},
    {quads41, "5 5 2 81", "4 5 2 81", "$Elements announces 5 entries, but its blocks hold 4"},
    {quads41, "5 5 2 81", "6 5 2 81",
     "$EndElements comes before all entries announced by $Elements"},
    {quads41, "2 2 3 1\n", "2 2 5 1\n", "elements of type hex8 in a block of dimension 2"},
    {quads41, "2 2 3 1\n", "2 2 300 1\n", "elements of gmsh type 300 are not known"},
    {quads41, "2 1 0 5", "7 1 0 5", "a block of nodes of dimension 7"},
    {quads41, "$Entities", "$PartitionedEntities", "the mesh is partitioned, which is not read"},
};

static void errors_name_line_and_cause(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    char *text = replaced(wrong[i].base, wrong[i].old, wrong[i].with);
    const char *path = write_text("wrong.msh", text);
    char start[160];
    snprintf(start, sizeof start, "cannot read '%s': ", path);
    check_unreadable(path, CDEM_INPUT, wrong[i].message);
    check_unreadable(path, CDEM_INPUT, start);
    free(text);
  }
}

static void elements_before_nodes(void **state) {
  (void)state;
  char text[sizeof quads22];
  const char *nodes = strstr(quads22, "$Nodes"), *elements = strstr(quads22, "$Elements");
  sprintf(text, "%.*s%s%.*s", (int)(nodes - quads22), quads22, elements, (int)(elements - nodes),
          nodes);
  check_unreadable(write_text("a.msh", text), CDEM_INPUT, "$Elements comes before $Nodes");
  sprintf(text, "%.*s", (int)(elements - quads22), quads22);
  check_unreadable(write_text("a.msh", text), CDEM_INPUT, "the file has no section $Elements");
}

static void no_elements_at_all(void **state) {
  (void)state;
  check_unreadable(write_text("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n"
                                       "$EndNodes\n$Elements\n0\n$EndElements\n"),
                   CDEM_INPUT, "the mesh has no elements");
  check_unreadable(write_text("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n"
                                       "$EndNodes\n$Elements\n1\n1 15 2 0 1 1\n$EndElements\n"),
                   CDEM_INPUT, "the mesh has no elements");
}

/* A 9-node quadrilateral is an error as a body, a warning as the side of a hexahedron. */
static void foreign_types_by_dimension(void **state) {
  (void)state;
  char text[2000], *out = text;
  out += sprintf(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n13\n");
  for (int n = 0; n < 13; n++)
    out += sprintf(out, "%d %d %d %d\n", n + 1, n == 1 || n == 2 || n == 5 || n == 6,
                   n == 2 || n == 3 || n == 6 || n == 7, n >= 4 ? n : 0);
  char *elements = out;
  sprintf(elements, "$EndNodes\n$Elements\n1\n4 10 2 0 1 1 2 3 4 5 6 7 8 9\n$EndElements\n");
  check_unreadable(write_text("a.msh", text), CDEM_INPUT,
                   "line 22: element 4 is a quad9 (gmsh type 10), which has no springs here; set "
                   "Mesh.SecondOrderIncomplete = 1 in gmsh");
  sprintf(elements, "$EndNodes\n$Elements\n2\n4 10 2 0 1 1 2 3 4 5 6 7 8 9\n"
                    "5 5 2 0 1 1 2 3 4 5 6 7 8\n$EndElements\n");
  heard said = {0};
  cdem_mesh mesh = {0};
  check_ok(cdem_read_mesh(write_text("a.msh", text), &mesh, &(cdem_warnings){&said, hear}, &fault));
  assert_int_equal(mesh.cells, 1);
  assert_int_equal(mesh.nodes, 8);
  assert_int_equal(said.count, 1);
  assert_non_null(strstr(said.last, "1 boundary elements of type quad9 (the first is element 4)"));
  cdem_mesh_release(&mesh);
}

static void files_that_are_no_meshes(void **state) {
  (void)state;
  check_unreadable(write_text("a.msh", ""), CDEM_INPUT, "the file is empty");
  check_unreadable(write_text("a.msh", " \n"), CDEM_INPUT, "no section $Nodes");
  check_unreadable(write_text("a.msh", "Dear reader,\n"), CDEM_INPUT,
                   "line 1: the file does not start with $MeshFormat");
  check_unreadable(write_text("a.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n"), CDEM_INPUT,
                   "no MSH file of version 2.2 or 4.1");
  check_unreadable(write_bytes("a.msh", "\0\1\2\3", 4), CDEM_INPUT, "does not start with");
  check_unreadable(in_folder("none.msh"), CDEM_FILE, "No such file or directory");
  mkdir(in_folder("folder.msh"), 0700);
  check_unreadable(in_folder("folder.msh"), CDEM_FILE, "it is a directory");
  rmdir(in_folder("folder.msh"));
  check_unreadable(write_text("a.vtu", "x"), CDEM_INPUT, "none of .msh .geo .step .stp .inp");
  check_unreadable(write_text("a", "x"), CDEM_INPUT, "none of .msh .geo .step .stp .inp");
  if (geteuid() != 0) { /* root reads everything */
    const char *path = write_text("locked.msh", quads22);
    chmod(path, 0);
    check_unreadable(path, CDEM_FILE, "Permission denied");
  }
}

/* Every allocation on the way fails once. */
static void allocation_failures_leave_nothing(void **state) {
  (void)state;
  const char *path[2] = {write_text("a.msh", quads22), write_text("b.msh", quads41)};
  for (int i = 0; i < 2; i++)
    for (int after = 0;; after++) {
      cdem_mesh mesh = {0};
      memset(&fault, 0, sizeof fault);
      cdem_memory_fail_after(after);
      cdem_status status = cdem_read_mesh(path[i], &mesh, NULL, &fault);
      cdem_memory_fail_after(-1);
      cdem_mesh_release(&mesh);
      if (status == CDEM_OK) {
        assert_true(after > 20);
        break;
      }
      assert_int_equal(status, CDEM_MEMORY);
      assert_non_null(strstr(fault.message, "out of memory"));
    }
  memset(&fault, 0, sizeof fault);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(both_versions_give_the_same_mesh),
      cmocka_unit_test(line_ends_of_windows_and_other_sections_do_not_matter),
      cmocka_unit_test(decimal_comma_does_not_matter),
      cmocka_unit_test(group_of_two_dimensions_is_refused),
      cmocka_unit_test(same_number_in_two_dimensions_is_told_apart),
      cmocka_unit_test(point_cells_stay_in_groups_only),
      cmocka_unit_test(errors_name_line_and_cause),
      cmocka_unit_test(elements_before_nodes),
      cmocka_unit_test(no_elements_at_all),
      cmocka_unit_test(foreign_types_by_dimension),
      cmocka_unit_test(files_that_are_no_meshes),
      cmocka_unit_test(allocation_failures_leave_nothing),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
