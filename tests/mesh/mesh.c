/* Room mesh: building by parts, groups, and what the check refuses. */
#include "mesh/mesh.h"

#include "support/test.h"

static cdem_fault fault;

/* Two unit squares side by side, tags 10.. for nodes and 100.. for cells. */
static cdem_mesh two_squares(void) {
  cdem_mesh mesh = {0};
  const double xyz[6][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  const int64_t node_tag[6] = {10, 11, 12, 13, 14, 15}, cell_tag[2] = {100, 101};
  const int32_t quad[8] = {0, 1, 4, 3, 1, 2, 5, 4}, line[2] = {0, 3};
  check_ok(cdem_mesh_add_nodes(&mesh, 6, xyz[0], node_tag, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_QUAD4, 2, quad, cell_tag, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_LINE2, 1, line, NULL, &fault));
  return mesh;
}

static void parts_are_kept(void **state) {
  (void)state;
  cdem_mesh mesh = two_squares();
  assert_int_equal(cdem_mesh_dimension(&mesh), 2);
  assert_int_equal(mesh.cells, 3);
  assert_int_equal(cdem_mesh_cell(&mesh, 1)[2], 5);
  assert_int_equal(cdem_mesh_cell(&mesh, 2)[1], 3);
  assert_int_equal(mesh.cell_tag[2], 3);
  assert_int_equal(mesh.node_tag[5], 15);
  check_ok(cdem_mesh_check(&mesh, &fault));
  cdem_mesh_release(&mesh);
  assert_int_equal(cdem_mesh_dimension(&mesh), -1);
  check_ok(cdem_mesh_check(&mesh, &fault));
  cdem_mesh_release(&mesh);
  cdem_mesh_release(NULL);
}

static void groups_are_sorted_sets(void **state) {
  (void)state;
  cdem_mesh mesh = two_squares();
  const int32_t some[3] = {1, 0, 1}, zero[1] = {0}, side[1] = {2};
  check_ok(cdem_mesh_add_group(&mesh, "all", 2, 3, some, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "left", 2, 1, zero, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "left", 2, 2, some, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "side", 1, 1, side, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "empty", 3, 0, NULL, &fault));
  assert_int_equal(mesh.groups, 4);
  for (int g = 0; g < 2; g++) {
    assert_int_equal(mesh.group[g].cells, 2);
    assert_int_equal(mesh.group[g].cell[0], 0);
    assert_int_equal(mesh.group[g].cell[1], 1);
  }
  assert_ptr_equal(cdem_mesh_find_group(&mesh, "side"), &mesh.group[2]);
  assert_null(cdem_mesh_find_group(&mesh, "right"));
  cdem_mesh_release(&mesh);
}

static void many_groups_fit(void **state) {
  (void)state;
  cdem_mesh mesh = two_squares();
  const int32_t cell[1] = {1};
  char name[16];
  for (int g = 0; g < 200; g++) {
    snprintf(name, sizeof name, "g%d", g);
    check_ok(cdem_mesh_add_group(&mesh, name, 2, 1, cell, &fault));
  }
  assert_int_equal(mesh.groups, 200);
  assert_string_equal(mesh.group[199].name, "g199");
  cdem_mesh_release(&mesh);
}

static void wrong_ids_and_dimensions_are_refused(void **state) {
  (void)state;
  cdem_mesh mesh = two_squares();
  const int32_t far[4] = {0, 1, 4, 6}, mixed[2] = {0, 2}, none[1] = {3};
  check_fails(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_QUAD4, 1, far, NULL, &fault), CDEM_USAGE,
              "names node id 6, but the mesh has 6 nodes");
  check_fails(cdem_mesh_add_group(&mesh, "both", 2, 2, mixed, &fault), CDEM_INPUT,
              "group 'both' is of mixed dimension: cell 3 has dimension 1, the group 2");
  check_fails(cdem_mesh_add_group(&mesh, "none", 2, 1, none, &fault), CDEM_USAGE,
              "names cell id 3, but the mesh has 3 cells");
  check_ok(cdem_mesh_add_group(&mesh, "rock", 2, 1, mixed, &fault));
  check_fails(cdem_mesh_add_group(&mesh, "rock", 1, 1, mixed + 1, &fault), CDEM_INPUT,
              "it has cells of dimension 2 and of dimension 1");
  check_fails(cdem_mesh_add_nodes(&mesh, -1, NULL, NULL, &fault), CDEM_USAGE, "cannot add -1");
  check_fails(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_TRI3, -1, NULL, NULL, &fault), CDEM_USAGE,
              "cannot add -1");
  check_fails(cdem_mesh_reserve(&mesh, INT64_C(3000000000), 1, 1, &fault), CDEM_INPUT,
              "3000000000 nodes and 1 cells is too large");
  assert_int_equal(mesh.cells, 3);
  assert_int_equal(mesh.groups, 1);
  cdem_mesh_release(&mesh);
}

static void check_names_the_first_offender(void **state) {
  (void)state;
  cdem_mesh mesh = two_squares();
  mesh.xyz[3 * 4 + 1] = NAN;
  check_fails(cdem_mesh_check(&mesh, &fault), CDEM_INPUT, "node 14: coordinate y is nan");
  mesh.xyz[3 * 4 + 1] = -INFINITY;
  check_fails(cdem_mesh_check(&mesh, &fault), CDEM_INPUT, "node 14: coordinate y is -inf");
  mesh.xyz[3 * 4 + 1] = 1;
  mesh.node_tag[0] = 15;
  check_fails(cdem_mesh_check(&mesh, &fault), CDEM_INPUT, "node tag 15 is used twice");
  mesh.node_tag[0] = 1000; /* not ascending, but all different */
  check_ok(cdem_mesh_check(&mesh, &fault));
  mesh.cell_tag[2] = 100;
  check_fails(cdem_mesh_check(&mesh, &fault), CDEM_INPUT, "element tag 100 is used twice");
  mesh.cell_tag[2] = 102;
  mesh.cell_node[6] = 1;
  check_fails(cdem_mesh_check(&mesh, &fault), CDEM_INPUT, "element 101 names node 11 twice");
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_are_kept),
      cmocka_unit_test(groups_are_sorted_sets),
      cmocka_unit_test(many_groups_fit),
      cmocka_unit_test(wrong_ids_and_dimensions_are_refused),
      cmocka_unit_test(check_names_the_first_offender),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
