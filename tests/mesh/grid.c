/* Room mesh: structured boxes conform, fill the box with positive cells, and are reproducible. */
#include "mesh/mesh.h"
#include "support/test.h"

static cdem_fault fault;

static const cdem_shape grid_shape[] = {
    CDEM_SHAPE_TRI3,  CDEM_SHAPE_QUAD4, CDEM_SHAPE_TRI6,   CDEM_SHAPE_QUAD8, CDEM_SHAPE_TET4,
    CDEM_SHAPE_TET10, CDEM_SHAPE_PYR5,  CDEM_SHAPE_WEDGE6, CDEM_SHAPE_HEX8,  CDEM_SHAPE_HEX20};
enum { GRID_SHAPES = sizeof grid_shape / sizeof grid_shape[0] };

static cdem_mesh_grid_options options_of(cdem_shape shape, double distortion, uint64_t seed) {
  bool solid = cdem_shape_get(shape)->dimension == 3;
  return (cdem_mesh_grid_options){.shape = shape,
                                  .count = {5, 4, solid ? 3 : 0},
                                  .size = {10, 2, solid ? 0.7 : 0},
                                  .distortion = distortion,
                                  .seed = seed};
}

static cdem_mesh make(cdem_mesh_grid_options options) {
  cdem_mesh mesh = {0};
  check_ok(cdem_mesh_grid(&options, &mesh, &fault));
  return mesh;
}

static double triple(const double *o, const double *a, const double *b, const double *c) {
  double m[9];
  for (int i = 0; i < 3; i++) {
    m[i] = a[i] - o[i];
    m[3 + i] = b[i] - o[i];
    m[6 + i] = c[i] - o[i];
  }
  return cdem_det3(m);
}

/* Volume behind the faces, each cut around the mean of its corners, so that the two cells at a
 * warped face agree on it; area in 2-D. Tests the outward order of the faces as well. */
static double measure(const cdem_mesh *mesh, int32_t cell) {
  const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh->cell_shape[cell]);
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  const double zero[3] = {0}, up[3] = {0, 0, 1};
  double sum = 0;
  for (int f = 0; f < info->faces; f++) {
    int corners = info->face_corners[f];
    double centre[3] = {0};
    for (int c = 0; c < corners; c++)
      for (int i = 0; i < 3; i++)
        centre[i] += mesh->xyz[3 * node[info->face[f][c]] + i] / corners;
    for (int c = 0; c < corners; c++) {
      const double *a = mesh->xyz + 3 * node[info->face[f][c]];
      const double *b = mesh->xyz + 3 * node[info->face[f][(c + 1) % corners]];
      sum += info->dimension == 3 ? triple(zero, centre, a, b) / 6 : triple(centre, a, b, up) / 2;
    }
  }
  return sum;
}

static void cells_fill_the_box(void **state) {
  (void)state;
  for (int s = 0; s < GRID_SHAPES; s++)
    for (int seed = 0; seed < 20; seed++) {
      cdem_mesh mesh = make(options_of(grid_shape[s], seed == 0 ? 0 : 0.25, (uint64_t)seed));
      const cdem_group *body = cdem_mesh_find_group(&mesh, "body");
      double sum = 0, smallest = INFINITY;
      for (int32_t c = 0; c < body->cells; c++) {
        double own = measure(&mesh, body->cell[c]);
        sum += own;
        smallest = fmin(smallest, own);
      }
      double box = cdem_shape_get(grid_shape[s])->dimension == 3 ? 10 * 2 * 0.7 : 10 * 2;
      check_near(sum, box, 1e-13, 0); /* some hundred roundings */
      assert_true(smallest > 0);
      cdem_mesh_release(&mesh);
    }
}

/* Three edges from each corner, right-handed: positive corner determinants. The pyramid's apex has
 * four edges and is covered by its base corners. */
static const struct {
  cdem_shape shape;
  int corners;
  int8_t frame[8][4];
} frames[] = {
    {CDEM_SHAPE_TET4, 1, {{0, 1, 2, 3}}},
    {CDEM_SHAPE_PYR5, 4, {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}},
    {CDEM_SHAPE_WEDGE6,
     6,
     {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}},
    {CDEM_SHAPE_HEX8,
     8,
     {{0, 1, 3, 4},
      {1, 2, 0, 5},
      {2, 3, 1, 6},
      {3, 0, 2, 7},
      {4, 7, 5, 0},
      {5, 4, 6, 1},
      {6, 5, 7, 2},
      {7, 6, 4, 3}}},
};

static void corners_stay_right_handed_at_full_distortion(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++)
    for (int seed = 0; seed < 40; seed++) {
      cdem_mesh mesh = make(options_of(frames[k].shape, 0.25, (uint64_t)seed));
      const cdem_group *body = cdem_mesh_find_group(&mesh, "body");
      for (int32_t c = 0; c < body->cells; c++)
        for (int f = 0; f < frames[k].corners; f++) {
          const double *at[4];
          for (int i = 0; i < 4; i++)
            at[i] = mesh.xyz + 3 * cdem_mesh_cell(&mesh, body->cell[c])[frames[k].frame[f][i]];
          assert_true(triple(at[0], at[1], at[2], at[3]) > 0);
        }
      cdem_mesh_release(&mesh);
    }
}

/* A conforming mesh has no boundary inside: a gap between two cells would show there. */
static void cuts_conform(void **state) {
  (void)state;
  for (int s = 0; s < GRID_SHAPES; s++) {
    cdem_mesh mesh = make(options_of(grid_shape[s], 0.2, 3));
    const cdem_group *body = cdem_mesh_find_group(&mesh, "body");
    int dimension = cdem_shape_get(grid_shape[s])->dimension;
    const double size[3] = {10, 2, 0.7};
    bool *boundary = test_malloc((size_t)mesh.nodes);
    check_ok(cdem_mesh_boundary_nodes(&mesh, body->cell, body->cells, boundary, &fault));
    for (int n = 0; n < mesh.nodes; n++) {
      bool on_side = false;
      for (int i = 0; i < dimension; i++)
        on_side |= mesh.xyz[3 * n + i] == 0 || mesh.xyz[3 * n + i] == size[i];
      assert_int_equal(boundary[n], on_side);
    }
    test_free(boundary);
    int64_t pairs;
    int32_t a, b;
    check_ok(cdem_mesh_coincident_nodes(&mesh, NULL, 0, 1e-6, &pairs, &a, &b, &fault));
    assert_int_equal(pairs, 0);
    check_ok(cdem_mesh_check(&mesh, &fault));
    cdem_mesh_release(&mesh);
  }
}

static void mid_nodes_are_in_the_middle(void **state) {
  (void)state;
  for (int s = 0; s < GRID_SHAPES; s++) {
    cdem_mesh mesh = make(options_of(grid_shape[s], 0.25, 5));
    for (int32_t c = 0; c < mesh.cells; c++) {
      const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh.cell_shape[c]);
      const int32_t *node = cdem_mesh_cell(&mesh, c);
      for (int e = 0; e < info->edges && info->edge[e][2] >= 0; e++)
        for (int i = 0; i < 3; i++)
          check_near(mesh.xyz[3 * node[info->edge[e][2]] + i],
                     (mesh.xyz[3 * node[info->edge[e][0]] + i] +
                      mesh.xyz[3 * node[info->edge[e][1]] + i]) /
                         2,
                     1e-15, 0);
    }
    cdem_mesh_release(&mesh);
  }
}

static void sides_are_whole_and_face_outward(void **state) {
  (void)state;
  const char *name[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
  const double size[3] = {10, 2, 0.7};
  for (int s = 0; s < GRID_SHAPES; s++) {
    cdem_mesh mesh = make(options_of(grid_shape[s], 0.25, 5));
    int dimension = cdem_shape_get(grid_shape[s])->dimension;
    assert_int_equal(mesh.groups, 1 + 2 * dimension);
    for (int side = 0; side < 2 * dimension; side++) {
      const cdem_group *group = cdem_mesh_find_group(&mesh, name[side]);
      int axis = side / 2;
      assert_int_equal(group->dimension, dimension - 1);
      double area = 0; /* projected on the outward normal, so that a reversed facet is seen */
      for (int32_t c = 0; c < group->cells; c++) {
        const int32_t *node = cdem_mesh_cell(&mesh, group->cell[c]);
        const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh.cell_shape[group->cell[c]]);
        double normal[3], corner[4][3] = {{0}};
        for (int k = 0; k < info->corners; k++) {
          memcpy(corner[k], mesh.xyz + 3 * node[k], sizeof corner[k]);
          check_near(corner[k][axis], side % 2 ? size[axis] : 0, 0, 0);
        }
        double u[3], v[3] = {0, 0, 1}; /* half the cross product of the diagonals is the area */
        const double *far = corner[info->corners == 4 ? 2 : 1];
        for (int i = 0; i < 3; i++) {
          u[i] = far[i] - corner[0][i];
          if (dimension == 3)
            v[i] = corner[info->corners == 4 ? 3 : 2][i] - corner[info->corners == 4 ? 1 : 0][i];
        }
        cdem_cross3(u, v, normal);
        area += normal[axis] * (side % 2 ? 1 : -1) * (dimension == 3 ? 0.5 : 1);
      }
      double expected = 1;
      for (int i = 0; i < dimension; i++)
        expected *= i == axis ? 1 : size[i];
      check_near(area, expected, 1e-14, 0);
    }
    cdem_mesh_release(&mesh);
  }
}

static void counts_are_known(void **state) {
  (void)state;
  const struct {
    cdem_shape shape;
    int nodes, body, side;
  } known[] = {{CDEM_SHAPE_HEX8, 120, 60, 94},        {CDEM_SHAPE_WEDGE6, 120, 120, 134},
               {CDEM_SHAPE_PYR5, 180, 360, 94},       {CDEM_SHAPE_TET4, 120, 360, 188},
               {CDEM_SHAPE_HEX20, 120 + 286, 60, 94}, {CDEM_SHAPE_QUAD4, 30, 20, 18},
               {CDEM_SHAPE_TRI6, 99, 40, 18},         {CDEM_SHAPE_QUAD8, 79, 20, 18}};
  for (int k = 0; k < 8; k++) {
    cdem_mesh mesh = make(options_of(known[k].shape, 0, 0));
    assert_int_equal(mesh.nodes, known[k].nodes);
    assert_int_equal(cdem_mesh_find_group(&mesh, "body")->cells, known[k].body);
    assert_int_equal(mesh.cells, known[k].body + known[k].side);
    cdem_mesh_release(&mesh);
  }
}

static void same_seed_same_bits(void **state) {
  (void)state;
  cdem_mesh a = make(options_of(CDEM_SHAPE_HEX8, 0.2, 11));
  cdem_mesh b = make(options_of(CDEM_SHAPE_HEX8, 0.2, 11));
  cdem_mesh c = make(options_of(CDEM_SHAPE_HEX8, 0.2, 12));
  assert_memory_equal(a.xyz, b.xyz, (size_t)a.nodes * 3 * sizeof *a.xyz);
  assert_memory_not_equal(a.xyz, c.xyz, (size_t)a.nodes * 3 * sizeof *a.xyz);
  cdem_mesh_release(&a);
  cdem_mesh_release(&b);
  cdem_mesh_release(&c);
}

static void impossible_options_are_refused(void **state) {
  (void)state;
  cdem_mesh mesh = {0};
  cdem_mesh_grid_options options = options_of(CDEM_SHAPE_HEX8, 0.3, 1);
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE,
              "the distortion of a grid is 0.3; it must be from 0 to 0.25");
  options.distortion = NAN;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE, "nan");
  options.distortion = 0;
  options.size[1] = 0;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE, "along y is 0 m");
  options.size[1] = 1;
  options.count[2] = 0;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE, "at least 1 cell along z");
  options.shape = CDEM_SHAPE_QUAD4;
  options.count[2] = 3;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE, "takes 0 cells along z, not 3");
  options.shape = CDEM_SHAPE_LINE2;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE, "made of shape 'line2'");
  options.shape = CDEM_SHAPE_COUNT;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE, "made of shape '?'");
  options = options_of(CDEM_SHAPE_HEX8, 0, 1);
  for (int i = 0; i < 3; i++)
    options.count[i] = 2000;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_USAGE, "8e+09 bricks is too large");
  options.count[2] = 500; /* bricks can be counted, their nodes cannot */
  options.shape = CDEM_SHAPE_HEX20;
  check_fails(cdem_mesh_grid(&options, &mesh, &fault), CDEM_INPUT, "is too large");
  assert_int_equal(mesh.nodes, 0);
}

/* Every allocation of a grid and a further group fails once; nothing leaks, nothing half made. */
static void allocation_failures_leave_nothing(void **state) {
  (void)state;
  cdem_mesh_grid_options options = options_of(CDEM_SHAPE_HEX20, 0.1, 1);
  const int32_t cell[3] = {2, 0, 1};
  for (int after = 0;; after++) {
    cdem_mesh mesh = {0};
    memset(&fault, 0, sizeof fault);
    cdem_memory_fail_after(after);
    cdem_status status = cdem_mesh_grid(&options, &mesh, &fault);
    if (status == CDEM_OK) {
      int32_t groups = mesh.groups;
      status = cdem_mesh_add_group(&mesh, "some", 3, 3, cell, &fault);
      assert_int_equal(mesh.groups, groups + (status == CDEM_OK));
    } else {
      assert_null(mesh.xyz);
      assert_int_equal(mesh.cells, 0);
    }
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
      cmocka_unit_test(cells_fill_the_box),
      cmocka_unit_test(corners_stay_right_handed_at_full_distortion),
      cmocka_unit_test(cuts_conform),
      cmocka_unit_test(mid_nodes_are_in_the_middle),
      cmocka_unit_test(sides_are_whole_and_face_outward),
      cmocka_unit_test(counts_are_known),
      cmocka_unit_test(same_seed_same_bits),
      cmocka_unit_test(impossible_options_are_refused),
      cmocka_unit_test(allocation_failures_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
