/* Room mesh: components, boundary and coincident nodes against counts known in advance. */
#include "mesh/mesh.h"
#include "support/test.h"

static cdem_fault fault;

static cdem_mesh grid(cdem_shape shape, int nx, int ny, int nz) {
  cdem_mesh mesh = {0};
  check_ok(cdem_mesh_grid(&(cdem_mesh_grid_options){.shape = shape,
                                                    .count = {nx, ny, nz},
                                                    .size = {nx, ny, nz > 0 ? nz : 1}},
                          &mesh, &fault));
  return mesh;
}

static int64_t count_true(const bool *flag, int64_t count) {
  int64_t found = 0;
  for (int64_t i = 0; i < count; i++)
    found += flag[i];
  return found;
}

/* A node is marked exactly when it lies on the surface of the box, for every grid shape. */
static void boundary_nodes_lie_on_the_box(void **state) {
  (void)state;
  const cdem_shape shape[] = {
      CDEM_SHAPE_TRI3,  CDEM_SHAPE_QUAD4, CDEM_SHAPE_TRI6, CDEM_SHAPE_QUAD8,  CDEM_SHAPE_TET4,
      CDEM_SHAPE_TET10, CDEM_SHAPE_PYR5,  CDEM_SHAPE_HEX8, CDEM_SHAPE_WEDGE6, CDEM_SHAPE_HEX20};
  for (int s = 0; s < 10; s++) {
    int dimension = cdem_shape_get(shape[s])->dimension;
    const int size[3] = {4, 3, dimension == 3 ? 2 : 0};
    cdem_mesh mesh = grid(shape[s], size[0], size[1], size[2]);
    const cdem_group *body = cdem_mesh_find_group(&mesh, "body");
    bool *boundary = test_malloc((size_t)mesh.nodes * sizeof *boundary);
    check_ok(cdem_mesh_boundary_nodes(&mesh, body->cell, body->cells, boundary, &fault));
    for (int n = 0; n < mesh.nodes; n++) {
      bool on_side = false;
      for (int i = 0; i < dimension; i++)
        on_side |= mesh.xyz[3 * n + i] == 0 || mesh.xyz[3 * n + i] == size[i];
      assert_int_equal(boundary[n], on_side);
    }
    test_free(boundary);
    cdem_mesh_release(&mesh);
  }
}

/* n^3 bricks have (n+1)^3 - (n-1)^3 surface nodes; the facets of a part bound that part. */
static void boundary_of_a_part(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_HEX8, 5, 5, 5);
  bool boundary[216];
  int32_t cell[125];
  for (int c = 0; c < 125; c++)
    cell[c] = c;
  check_ok(cdem_mesh_boundary_nodes(&mesh, cell, 125, boundary, &fault));
  assert_int_equal(count_true(boundary, 216), 216 - 64);
  check_ok(cdem_mesh_boundary_nodes(&mesh, cell, 25, boundary, &fault)); /* one layer */
  assert_int_equal(count_true(boundary, 216), 72);
  check_ok(cdem_mesh_boundary_nodes(&mesh, cell, 0, boundary, &fault));
  assert_int_equal(count_true(boundary, 216), 0);
  const cdem_group *side = cdem_mesh_find_group(&mesh, "x1");
  check_ok(cdem_mesh_boundary_nodes(&mesh, side->cell, side->cells, boundary, &fault));
  assert_int_equal(count_true(boundary, 216), 20); /* the edges of one side */
  cdem_mesh_release(&mesh);
}

/* A fan: 200 triangles around one node put 400 edges into one bucket, more than are sorted by
 * insertion. Its rim is the boundary and the hub is not. */
static void hub_of_a_fan_is_inside(void **state) {
  (void)state;
  enum { SPOKES = 200 };
  cdem_mesh mesh = {0};
  double xyz[SPOKES + 1][3] = {{0}};
  int32_t triangle[SPOKES][3], cell[SPOKES];
  for (int i = 0; i < SPOKES; i++) {
    double angle = 2 * 3.14159265358979 * i / SPOKES;
    xyz[i + 1][0] = cos(angle);
    xyz[i + 1][1] = sin(angle);
    memcpy(triangle[i], (int32_t[3]){0, i + 1, (i + 1) % SPOKES + 1}, sizeof *triangle);
    cell[i] = i;
  }
  check_ok(cdem_mesh_add_nodes(&mesh, SPOKES + 1, xyz[0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_TRI3, SPOKES, triangle[0], NULL, &fault));
  bool boundary[SPOKES + 1];
  check_ok(cdem_mesh_boundary_nodes(&mesh, cell, SPOKES, boundary, &fault));
  assert_false(boundary[0]);
  assert_int_equal(count_true(boundary, SPOKES + 1), SPOKES);
  cdem_mesh_release(&mesh);
}

static void boundary_of_a_line_is_its_ends(void **state) {
  (void)state;
  cdem_mesh mesh = {0};
  const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const int32_t line[6] = {0, 1, 1, 2, 2, 3}, cell[3] = {0, 1, 2};
  bool boundary[4];
  check_ok(cdem_mesh_add_nodes(&mesh, 4, xyz[0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_LINE2, 3, line, NULL, &fault));
  check_ok(cdem_mesh_boundary_nodes(&mesh, cell, 3, boundary, &fault));
  assert_true(boundary[0] && !boundary[1] && !boundary[2] && boundary[3]);
  cdem_mesh_release(&mesh);
}

/* Layers 0 and 2 of a column of bricks do not touch; layer 1 joins them. */
static void components_are_counted(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_HEX8, 3, 2, 3);
  int32_t cell[18], component[48], components = -1;
  for (int c = 0; c < 6; c++) {
    cell[c] = c;
    cell[6 + c] = 12 + c;
    cell[12 + c] = 6 + c;
  }
  check_ok(cdem_mesh_components(&mesh, cell, 12, component, &components, &fault));
  assert_int_equal(components, 2);
  for (int n = 0; n < 48; n++)
    assert_int_equal(component[n], n < 24 ? 0 : 1);
  check_ok(cdem_mesh_components(&mesh, cell, 18, component, &components, &fault));
  assert_int_equal(components, 1);
  check_ok(cdem_mesh_components(&mesh, cell, 6, component, &components, &fault));
  assert_int_equal(component[0], 0);
  assert_int_equal(component[47], -1);
  check_ok(cdem_mesh_components(&mesh, cell, 0, component, &components, &fault));
  assert_int_equal(components, 0);
  cdem_mesh_release(&mesh);
}

/* Two boxes glued by place but not by nodes: every node of the common side is a pair. */
static cdem_mesh unglued(double gap) {
  cdem_mesh one = grid(CDEM_SHAPE_HEX8, 2, 3, 4), mesh = {0};
  check_ok(cdem_mesh_add_nodes(&mesh, one.nodes, one.xyz, NULL, &fault));
  for (int n = 0; n < one.nodes; n++)
    one.xyz[3 * n] += 2 + gap;
  check_ok(cdem_mesh_add_nodes(&mesh, one.nodes, one.xyz, NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_HEX8, 24, one.cell_node, NULL, &fault));
  for (int k = 0; k < 24 * 8; k++)
    one.cell_node[k] += one.nodes;
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_HEX8, 24, one.cell_node, NULL, &fault));
  cdem_mesh_release(&one);
  return mesh;
}

static void coincident_nodes_are_found(void **state) {
  (void)state;
  int64_t pairs;
  int32_t a, b;
  cdem_mesh mesh = unglued(0);
  check_ok(cdem_mesh_coincident_nodes(&mesh, NULL, 0, 0, &pairs, &a, &b, &fault));
  assert_int_equal(pairs, 20);
  assert_int_equal(a, 2);
  assert_int_equal(b, 60);
  int32_t cell[24];
  for (int c = 0; c < 24; c++)
    cell[c] = c;
  check_ok(cdem_mesh_coincident_nodes(&mesh, cell, 24, 0.5, &pairs, &a, &b, &fault));
  assert_int_equal(pairs, 0);
  assert_int_equal(a, -1);
  cdem_mesh_release(&mesh);
  mesh = unglued(1e-6);
  check_ok(cdem_mesh_coincident_nodes(&mesh, NULL, 0, 0.999e-6, &pairs, &a, &b, &fault));
  assert_int_equal(pairs, 0);
  check_ok(cdem_mesh_coincident_nodes(&mesh, NULL, 0, 1.001e-6, &pairs, &a, &b, &fault));
  assert_int_equal(pairs, 20);
  cdem_mesh_release(&mesh);
}

/* The hashed search against all pairs, random places, tolerances from none to most. */
static void coincident_nodes_agree_with_all_pairs(void **state) {
  (void)state;
  enum { NODES = 240 };
  cdem_random random = {7};
  double xyz[NODES][3];
  int32_t tetrahedron[NODES];
  for (int n = 0; n < NODES; n++) {
    tetrahedron[n] = n;
    for (int i = 0; i < 3; i++) /* some places repeat: coarse steps, zeros of both signs */
      xyz[n][i] = floor(cdem_random_uniform(&random, -2, 3)) * (n % 2 ? -0.3 : 0.3) +
                  (n % 5 == 0 ? cdem_random_uniform(&random, 0, 0.1) : 0);
  }
  cdem_mesh mesh = {0};
  check_ok(cdem_mesh_add_nodes(&mesh, NODES, xyz[0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_TET4, NODES / 4, tetrahedron, NULL, &fault));
  const double tolerance[5] = {0, 1e-9, 0.02, 0.1, 0.7};
  for (int t = 0; t < 5; t++) {
    int64_t expected = 0, pairs;
    int32_t a, b;
    for (int i = 0; i < NODES; i++)
      for (int j = 0; j < i; j++) {
        double d[3] = {xyz[i][0] - xyz[j][0], xyz[i][1] - xyz[j][1], xyz[i][2] - xyz[j][2]};
        expected += cdem_dot3(d, d) <= tolerance[t] * tolerance[t];
      }
    assert_true(expected > 0);
    check_ok(cdem_mesh_coincident_nodes(&mesh, NULL, 0, tolerance[t], &pairs, &a, &b, &fault));
    assert_int_equal(pairs, expected);
    assert_true(a < b && a >= 0);
  }
  cdem_mesh_release(&mesh);
}

/* A hundred thousand nodes at one place are one heap, not five thousand million comparisons. */
static void a_heap_of_nodes_is_cheap(void **state) {
  (void)state;
  enum { NODES = 100000 };
  cdem_mesh mesh = {0};
  double *xyz = test_calloc(NODES * 3, sizeof *xyz);
  int32_t *node = test_calloc(NODES, sizeof *node);
  for (int n = 0; n < NODES; n++)
    node[n] = n;
  check_ok(cdem_mesh_add_nodes(&mesh, NODES, xyz, NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_TET4, NODES / 4, node, NULL, &fault));
  int64_t pairs;
  int32_t a, b;
  check_ok(cdem_mesh_coincident_nodes(&mesh, NULL, 0, 1e-9, &pairs, &a, &b, &fault));
  assert_int_equal(pairs, (int64_t)NODES * (NODES - 1) / 2);
  test_free(xyz);
  test_free(node);
  cdem_mesh_release(&mesh);
}

static void wrong_choices_are_refused(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_HEX8, 1, 1, 1);
  const int32_t mixed[2] = {0, 1}, far[1] = {7};
  int32_t component[8], components, a, b;
  int64_t pairs;
  bool boundary[8];
  check_fails(cdem_mesh_components(&mesh, mixed, 2, component, &components, &fault), CDEM_USAGE,
              "mixed dimension: element 2 has dimension 2, those before it 3");
  check_fails(cdem_mesh_boundary_nodes(&mesh, far, 1, boundary, &fault), CDEM_USAGE,
              "cell id 7 is outside the mesh of 7 cells");
  check_fails(cdem_mesh_components(&mesh, far, -1, component, &components, &fault), CDEM_USAGE,
              "cannot choose -1 cells");
  check_fails(cdem_mesh_coincident_nodes(&mesh, far, 1, 0, &pairs, &a, &b, &fault), CDEM_USAGE,
              "cell id 7 is outside");
  check_fails(cdem_mesh_coincident_nodes(&mesh, NULL, 0, -1, &pairs, &a, &b, &fault), CDEM_USAGE,
              "tolerance of coincident nodes is -1 m");
  mesh.xyz[0] = NAN;
  check_fails(cdem_mesh_coincident_nodes(&mesh, NULL, 0, 0, &pairs, &a, &b, &fault), CDEM_INPUT,
              "node 1: coordinate x is not a finite number");
  cdem_mesh_release(&mesh);
}

static void allocation_failures_are_reported(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_HEX8, 1, 1, 1);
  const int32_t cell[1] = {0};
  int32_t component[8], components, a, b;
  int64_t pairs;
  bool boundary[8];
  for (int after = 0; after < 2; after++) {
    cdem_memory_fail_after(after);
    check_fails(cdem_mesh_boundary_nodes(&mesh, cell, 1, boundary, &fault), CDEM_MEMORY, "memory");
  }
  for (int after = 0; after < 4; after++) {
    cdem_memory_fail_after(after);
    check_fails(cdem_mesh_coincident_nodes(&mesh, cell, 1, 0, &pairs, &a, &b, &fault), CDEM_MEMORY,
                "memory");
  }
  cdem_memory_fail_after(0);
  check_fails(cdem_mesh_components(&mesh, cell, 1, component, &components, &fault), CDEM_MEMORY,
              "memory");
  cdem_memory_fail_after(-1);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boundary_nodes_lie_on_the_box),
      cmocka_unit_test(boundary_of_a_part),
      cmocka_unit_test(hub_of_a_fan_is_inside),
      cmocka_unit_test(boundary_of_a_line_is_its_ends),
      cmocka_unit_test(components_are_counted),
      cmocka_unit_test(coincident_nodes_are_found),
      cmocka_unit_test(coincident_nodes_agree_with_all_pairs),
      cmocka_unit_test(a_heap_of_nodes_is_cheap),
      cmocka_unit_test(wrong_choices_are_refused),
      cmocka_unit_test(allocation_failures_are_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
