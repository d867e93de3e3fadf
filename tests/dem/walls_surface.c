/* From meshes to the facets of walls. */
#include "base/memory.h"
#include "dem/walls.h"
#include "support/test.h"

/* A square of two second-order triangles beside a quadrilateral whose second diagonal is shorter, a
 * line, a triangle without size, and a body. */
static void make_mesh(cdem_mesh *mesh) {
  cdem_fault fault = {0};
  const double xyz[][3] = {{0, 0, 1},   {1, 0, 1},   {1, 1, 1},     {0, 1, 1},
                           {0.5, 0, 1}, {1, 0.5, 1}, {0.5, 0.5, 1}, {0.5, 1, 1},
                           {0, 0.5, 1}, {3, 0, 1},   {2, 1, 1},     {0, 0, 2}};
  const int32_t tri[12] = {0, 1, 2, 4, 5, 6, 0, 2, 3, 6, 7, 8}, quad[4] = {1, 9, 10, 2};
  const int32_t line[4] = {0, 1, 1, 9}, flat[3] = {0, 4, 1}, tet[4] = {0, 1, 2, 11};
  const int32_t side[3] = {0, 1, 2}, base[2] = {3, 4}, none[1] = {5}, body[1] = {6};
  check_ok(cdem_mesh_add_nodes(mesh, 12, xyz[0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_TRI6, 2, tri, NULL, &fault));
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_QUAD4, 1, quad, NULL, &fault));
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_LINE2, 2, line, NULL, &fault));
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_TRI3, 1, flat, NULL, &fault));
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_TET4, 1, tet, NULL, &fault));
  check_ok(cdem_mesh_add_group(mesh, "side", 2, 3, side, &fault));
  check_ok(cdem_mesh_add_group(mesh, "base", 1, 2, base, &fault));
  check_ok(cdem_mesh_add_group(mesh, "none", 2, 1, none, &fault));
  check_ok(cdem_mesh_add_group(mesh, "body", 3, 1, body, &fault));
}

static void surfaces_are_taken_by_their_corners(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_wall_mesh s = {0};
  make_mesh(&mesh);
  const cdem_group *group = cdem_mesh_find_group(&mesh, "side");
  check_ok(cdem_wall_take_surface(3, &mesh, group, &s, &fault));
  assert_int_equal(s.facets, 4);
  assert_int_equal(s.corners, 6); /* no mid nodes */
  assert_int_equal(s.dropped, 0);
  double area = 0.0, longest = 0.0;
  for (int32_t f = 0; f < s.facets; f++)
    for (int k = 0; k < 3; k++) {
      const double *a = s.corner + 3 * s.facet[3 * f + k];
      const double *b = s.corner + 3 * s.facet[3 * f + (k + 1) % 3];
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      longest = fmax(longest, (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
      assert_true(a[2] == 1.0);
    }
  check_near(area, 1.0 + 1.5, 1e-15, 0.0);
  check_near(longest, 4.0, 0.0, 0.0); /* the diagonal of length sqrt(2), not that of sqrt(5) */
  cdem_wall_mesh_release(&s);
  /* all of the mesh: the triangle without size is left out */
  check_ok(cdem_wall_take_surface(3, &mesh, NULL, &s, &fault));
  assert_int_equal(s.facets, 4);
  assert_int_equal(s.dropped, 1);
  cdem_wall wall = {.name = "w",
                    .shape = CDEM_WALL_MESH,
                    .corners = s.corners,
                    .corner = s.corner,
                    .facets = s.facets,
                    .facet = s.facet};
  check_ok(cdem_wall_check(3, &wall, &fault));
  cdem_wall_mesh_release(&s);
  cdem_wall_mesh_release(&s);
  cdem_mesh_release(&mesh);
}

static void lines_make_walls_in_the_plane(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_wall_mesh s = {0};
  make_mesh(&mesh);
  check_ok(cdem_wall_take_surface(2, &mesh, NULL, &s, &fault));
  assert_int_equal(s.facets, 2);
  assert_int_equal(s.corners, 3);
  assert_int_equal(s.facet[1], s.facet[2]);
  for (int32_t k = 0; k < 3; k++)
    assert_true(s.corner[3 * k + 2] == 0.0);
  cdem_wall_mesh_release(&s);
  cdem_mesh_release(&mesh);
}

static void what_is_no_surface_is_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_wall_mesh s = {0};
  make_mesh(&mesh);
  check_fails(cdem_wall_take_surface(3, &mesh, cdem_mesh_find_group(&mesh, "body"), &s, &fault),
              CDEM_INPUT,
              "group 'body' has cells of dimension 3; a wall in 3-D is made of cells of "
              "dimension 2");
  check_fails(cdem_wall_take_surface(3, &mesh, cdem_mesh_find_group(&mesh, "none"), &s, &fault),
              CDEM_INPUT,
              "the mesh group 'none' has no triangles or quadrilaterals for a wall (1 of no size)");
  assert_null(s.corner);
  for (int64_t k = 0; k < 3; k++) {
    cdem_memory_fail_after(k);
    cdem_status status = cdem_wall_take_surface(3, &mesh, NULL, &s, NULL);
    cdem_memory_fail_after(-1);
    assert_int_equal(status, CDEM_MEMORY);
    assert_null(s.facet);
  }
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(surfaces_are_taken_by_their_corners),
      cmocka_unit_test(lines_make_walls_in_the_plane),
      cmocka_unit_test(what_is_no_surface_is_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
