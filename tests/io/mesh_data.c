/* Room io: every mesh under data/meshes is read, valid, and as its README says. */
#include "io/mesh_support.h"

/* Counts of boundary and inner facets agree with one connected, conforming body. */
static void check_one_piece(const cdem_mesh *mesh) {
  int dimension = cdem_mesh_dimension(mesh);
  int32_t *cell = malloc((size_t)mesh->cells * sizeof *cell), cells = 0, components;
  int32_t *component = malloc((size_t)mesh->nodes * sizeof *component), a, b;
  int64_t pairs;
  for (int32_t c = 0; c < mesh->cells; c++)
    if (cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension == dimension)
      cell[cells++] = c;
  check_ok(cdem_mesh_components(mesh, cell, cells, component, &components, &fault));
  assert_int_equal(components, 1);
  check_ok(cdem_mesh_coincident_nodes(mesh, cell, cells, 1e-9, &pairs, &a, &b, &fault));
  assert_int_equal(pairs, 0);
  free(cell);
  free(component);
}

static void block_with_hole(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/block-with-hole.geo");
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_HEX8), 3072);
  assert_int_equal(cdem_mesh_find_group(&mesh, "rock")->cells, 3072);
  assert_int_equal(cdem_mesh_find_group(&mesh, "hole")->cells, 4 * 12 * 8);
  const char *side[] = {"left", "right", "front", "back"};
  for (int i = 0; i < 4; i++)
    assert_int_equal(cdem_mesh_find_group(&mesh, side[i])->cells, 12 * 8);
  assert_int_equal(cdem_mesh_find_group(&mesh, "bottom")->cells, 4 * 12 * 8);
  assert_int_equal(cdem_mesh_find_group(&mesh, "top")->cells, 4 * 12 * 8);
  /* The hole is a polygon of 48 sides in the mesh. */
  double hole = 0.5 * 48 * sin(2 * acos(-1) / 48) * 0.015 * 0.015;
  check_near(group_measure(&mesh, "rock"), (0.1 * 0.1 - hole) * 0.04, 1e-9, 0);
  check_one_piece(&mesh);
  cdem_mesh_release(&mesh);
}

static void two_layers(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/two-layers.geo");
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_HEX8), 16 * 4 * 5);
  assert_true(count_shape(&mesh, CDEM_SHAPE_WEDGE6) > 100);
  check_near(group_measure(&mesh, "clay"), 12 * 2 * 4, 1e-9, 0);
  /* Under the slope less under the interface, 4 m wide. */
  check_near(group_measure(&mesh, "sand"),
             4 * (5 * 4 + (5 + 3) / 2. * 3 + (3 + 2.5) / 2 * 5 - (2.5 + 1.5) / 2 * 12), 1e-9, 0);
  assert_int_equal(cdem_mesh_find_group(&mesh, "base")->cells, 16 * 5);
  assert_non_null(cdem_mesh_find_group(&mesh, "slope"));
  const cdem_group *slope = cdem_mesh_find_group(&mesh, "slope");
  for (int32_t i = 0; i < slope->cells; i++) /* on the line from (7,3) to (4,5) */
    for (int k = 0; k < 4; k++) {
      const double *x = mesh.xyz + 3 * cdem_mesh_cell(&mesh, slope->cell[i])[k];
      check_near(x[2], 3 + (7 - x[0]) * 2 / 3, 0, 1e-9);
    }
  check_one_piece(&mesh);
  cdem_mesh_release(&mesh);
}

static void plate(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/plate.geo");
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_QUAD4), 64);
  assert_true(count_shape(&mesh, CDEM_SHAPE_TRI3) > 100);
  check_near(group_measure(&mesh, "left half"), 1, 1e-9, 0);
  check_near(group_measure(&mesh, "right half"), 1, 1e-9, 0);
  assert_int_equal(cdem_mesh_find_group(&mesh, "clamped")->cells, 8);
  assert_int_equal(cdem_mesh_find_group(&mesh, "loaded")->dimension, 1);
  check_one_piece(&mesh);
  cdem_mesh_release(&mesh);
}

static void tunnel(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/tunnel.geo");
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_QUAD8), 4 * 6 * 3);
  assert_true(count_shape(&mesh, CDEM_SHAPE_TRI6) > 100);
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_LINE3),
                   mesh.cells - 72 - count_shape(&mesh, CDEM_SHAPE_TRI6));
  group_measure(&mesh, "ring");
  group_measure(&mesh, "ground");
  /* Mid nodes on arcs leave the chord by R (1 - cos(half angle)), 7.5 degrees, R = 3.5. */
  check_mid_nodes(&mesh, 3.5 * (1 - cos(7.5 * acos(-1) / 180)) * 1.001);
  const cdem_group *wall = cdem_mesh_find_group(&mesh, "wall");
  assert_int_equal(wall->cells, 24);
  for (int32_t i = 0; i < wall->cells; i++)
    for (int k = 0; k < 3; k++) {
      const double *x = mesh.xyz + 3 * cdem_mesh_cell(&mesh, wall->cell[i])[k];
      check_near(hypot(x[0], x[1]), 2, 1e-9, 0);
    }
  check_one_piece(&mesh);
  cdem_mesh_release(&mesh);
}

static void cantilever(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/cantilever.inp");
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_HEX8), 144);
  assert_int_equal(mesh.nodes, 13 * 5 * 4);
  check_near(group_measure(&mesh, "beam"), 1 * 0.3 * 0.2, 1e-6, 0); /* six decimals in the file */
  assert_int_equal(cdem_mesh_find_group(&mesh, "root")->cells, 12);
  assert_int_equal(cdem_mesh_find_group(&mesh, "lowest")->cells, 48);
  assert_int_equal(cdem_mesh_find_group(&mesh, "marked")->cells, 12 + 48 - 4);
  check_one_piece(&mesh);
  cdem_mesh_release(&mesh);
}

static void mixed(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/mixed.msh");
  const cdem_shape shape[] = {CDEM_SHAPE_HEX8, CDEM_SHAPE_WEDGE6, CDEM_SHAPE_PYR5, CDEM_SHAPE_TET4,
                              CDEM_SHAPE_QUAD4};
  for (int i = 0; i < 5; i++)
    assert_int_equal(count_shape(&mesh, shape[i]), 1);
  check_near(group_measure(&mesh, "block"), 1 + 0.5 * 0.6, 1e-14, 0);
  /* pyramid 0.8/3; tetrahedron: edge (0,1,0), (0,.5,.6), (.8,.5,-.5) */
  check_near(group_measure(&mesh, "cap"), 0.8 / 3 + 0.6 * 0.8 / 6, 1e-14, 0);
  /* Conforming: only the nodes are all on the surface, but of 6+5+5+4 faces 2 x 3 are inside. */
  int32_t cell[4] = {1, 2, 3, 4}, component[11], components;
  check_ok(cdem_mesh_components(&mesh, cell, 4, component, &components, &fault));
  assert_int_equal(components, 1);
  assert_int_equal(mesh.cell_tag[0], 1);
  cdem_mesh_release(&mesh);
}

static void step_is_in_metres(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/sample.step");
  assert_true(count_shape(&mesh, CDEM_SHAPE_TET4) > 100);
  double volume = 0, high = 0;
  for (int32_t c = 0; c < mesh.cells; c++)
    volume += mesh.cell_shape[c] == CDEM_SHAPE_TET4 ? cell_measure(&mesh, c) : 0;
  for (int32_t n = 0; n < mesh.nodes; n++)
    high = fmax(high, mesh.xyz[3 * n]);
  check_near(high, 0.1, 1e-9, 0);
  /* Chords cut the round hole: at the mesh's some twenty sides 2 % of the hole, 0.3 % of all. */
  check_near(volume, (0.1 * 0.1 - acos(-1) * 0.02 * 0.02) * 0.04, 0.01, 0);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(block_with_hole),
      cmocka_unit_test(two_layers),
      cmocka_unit_test(plate),
      cmocka_unit_test(tunnel),
      cmocka_unit_test(cantilever),
      cmocka_unit_test(mixed),
      cmocka_unit_test(step_is_in_metres),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
