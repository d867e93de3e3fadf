/* Skins against closed forms, nearest points against all triangles, inside against solid angles. */
#include "surface_support.h"

static const double size[3] = {1.0, 1.5, 2.0};
static const int32_t count[3] = {2, 2, 3};

static void a_box_has_the_skin_of_a_box(void **state) {
  (void)state;
  static const cdem_shape shapes[] = {CDEM_SHAPE_TET4,   CDEM_SHAPE_TET10, CDEM_SHAPE_PYR5,
                                      CDEM_SHAPE_WEDGE6, CDEM_SHAPE_HEX8,  CDEM_SHAPE_HEX20};
  static const int a_quad[] = {2, 8, 2, 2, 2, 6};
  cdem_fault fault = {0};
  for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++) {
    cdem_mesh mesh;
    cdem_skin skin;
    int32_t nodes = box_mesh(shapes[k], count, size, 0.0, &mesh);
    check_ok(cdem_skin_build(&mesh, nodes, 0.05, &skin, &fault));
    assert_int_equal(skin.triangles, a_quad[k] * 2 * (2 * 2 + 2 * 3 + 2 * 3));
    check_near(skin.volume, 3.0, 1e-14, 0.0);
    check_near(skin.total, 2.0 * (1.5 + 2.0 + 3.0), 1e-14, 0.0);
    check_near(skin.reach, sqrt(0.25 + 0.5625 + 1.0), 1e-15, 0.0);
    check_near(skin.least, 0.5, 1e-15, 0.0);
    double sum = 0.0, closed[3] = {0};
    for (int32_t n = 0; n < nodes; n++) {
      assert_true(skin.area[n] > 0.0);
      sum += skin.area[n];
    }
    check_near(sum, skin.total, 1e-14, 0.0);
    for (int32_t t = 0; t < skin.triangles; t++) {
      const int32_t *v = skin.triangle + 3 * t;
      double ab[3], ac[3], n[3];
      for (int c = 0; c < 3; c++) {
        ab[c] = skin.reference[3 * v[1] + c] - skin.reference[3 * v[0] + c];
        ac[c] = skin.reference[3 * v[2] + c] - skin.reference[3 * v[0] + c];
      }
      cdem_cross3(ab, ac, n);
      assert_true(cdem_dot3(n, skin.reference + 3 * v[0]) > 0.0); /* outwards */
      for (int c = 0; c < 3; c++)
        closed[c] += n[c];
    }
    check_below(cdem_norm3(closed), 1e-14);
    cdem_skin_release(&skin);
    cdem_mesh_release(&mesh);
  }
}

/* A corner of a box of eight-node faces: the third of three triangles, each an eighth of a face. */
static void areas_are_thirds_of_triangles(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh;
  cdem_skin skin;
  const double cube[3] = {2.0, 2.0, 2.0};
  int32_t nodes = box_mesh(CDEM_SHAPE_HEX20, (int32_t[3]){1, 1, 1}, cube, 0.0, &mesh);
  check_ok(cdem_skin_build(&mesh, nodes, 0.0, &skin, &fault));
  for (int32_t n = 0; n < nodes; n++)
    if (cdem_norm3(skin.reference + 3 * n) > 1.6)
      check_near(skin.area[n], 3 * 0.5 / 3.0, 1e-15, 0.0);
  cdem_skin_release(&skin);
  cdem_mesh_release(&mesh);
}

/* ---- all triangles, in another way ---- */

static double to_segment(const double y[3], const double a[3], const double b[3]) {
  double e[3], r[3];
  for (int c = 0; c < 3; c++) {
    e[c] = b[c] - a[c];
    r[c] = y[c] - a[c];
  }
  double part = fmin(1.0, fmax(0.0, cdem_dot3(e, r) / cdem_dot3(e, e)));
  for (int c = 0; c < 3; c++)
    r[c] -= part * e[c];
  return cdem_norm3(r);
}

static double to_triangle(const double y[3], const double *p[3]) {
  double least = INFINITY, edge[3][3], n[3], side;
  bool within = true;
  for (int k = 0; k < 3; k++)
    for (int c = 0; c < 3; c++)
      edge[k][c] = p[(k + 1) % 3][c] - p[k][c];
  cdem_cross3(edge[0], edge[1], n);
  for (int k = 0; k < 3; k++) {
    double r[3] = {y[0] - p[k][0], y[1] - p[k][1], y[2] - p[k][2]}, in[3];
    cdem_cross3(n, edge[k], in);
    within = within && cdem_dot3(in, r) >= 0.0;
    least = fmin(least, to_segment(y, p[k], p[(k + 1) % 3]));
  }
  side =
      ((y[0] - p[0][0]) * n[0] + (y[1] - p[0][1]) * n[1] + (y[2] - p[0][2]) * n[2]) / cdem_norm3(n);
  return within ? fabs(side) : least;
}

/* Solid angle of a triangle seen from y (Van Oosterom and Strackee 1983). */
static double solid_angle(const double y[3], const double *p[3]) {
  double r[3][3], length[3], cross[3];
  for (int k = 0; k < 3; k++) {
    for (int c = 0; c < 3; c++)
      r[k][c] = p[k][c] - y[c];
    length[k] = cdem_norm3(r[k]);
  }
  cdem_cross3(r[1], r[2], cross);
  double below = length[0] * length[1] * length[2] + cdem_dot3(r[0], r[1]) * length[2] +
                 cdem_dot3(r[0], r[2]) * length[1] + cdem_dot3(r[1], r[2]) * length[0];
  return 2.0 * atan2(cdem_dot3(r[0], cross), below);
}

/* Depth by all triangles; <= 0: outside. */
static double slow_depth(const cdem_skin *skin, const double *place, const double y[3]) {
  double least = INFINITY, angle = 0.0;
  for (int32_t t = 0; t < skin->triangles; t++) {
    const double *p[3];
    for (int k = 0; k < 3; k++)
      p[k] = place + 3 * skin->triangle[3 * t + k];
    least = fmin(least, to_triangle(y, p));
    angle += solid_angle(y, p);
  }
  return angle > 2.0 * M_PI ? least : -least;
}

/* Nodes moved by up to the margin, all scaled. */
static double *deform(const cdem_skin *skin, double scale, double part, cdem_random *random) {
  double *place = malloc(3 * (size_t)skin->nodes * sizeof *place);
  for (int32_t n = 0; n < skin->nodes; n++) {
    double u[3];
    do
      for (int c = 0; c < 3; c++)
        u[c] = cdem_random_uniform(random, -1.0, 1.0);
    while (cdem_dot3(u, u) > 1.0);
    for (int c = 0; c < 3; c++)
      place[3 * n + c] = scale * (skin->reference[3 * n + c] + part * skin->margin * u[c]);
  }
  return place;
}

static void compare(const cdem_skin *skin, const double *place, double scale, int tries,
                    cdem_random *random) {
  int inside = 0;
  for (int i = 0; i < tries; i++) {
    double y[3], p[3] = {0}, reach = 1.1 * skin->reach * scale;
    cdem_skin_touch touch;
    for (int c = 0; c < 3; c++)
      y[c] = cdem_random_uniform(random, -reach, reach);
    if (i % 3 == 1) { /* near a node */
      for (int c = 0; c < 3; c++)
        y[c] = 0.03 * y[c] + place[3 * (i % skin->nodes) + c];
    } else if (i % 3 == 2) { /* near the surface */
      const int32_t *v = skin->triangle + 3 * (i % skin->triangles);
      double a = cdem_random_uniform(random, 0.0, 1.0), b = cdem_random_uniform(random, 0.0, 1.0);
      for (int c = 0; c < 3; c++)
        y[c] = 0.1 * y[c] + place[3 * v[0] + c] * (1.0 - a) +
               a * (place[3 * v[1] + c] * (1.0 - b) + b * place[3 * v[2] + c]);
    }
    double depth = slow_depth(skin, place, y);
    bool touches = cdem_skin_touches(skin, place, scale, y, &touch);
    assert_int_equal(touches, depth > 0.0);
    if (!touches)
      continue;
    inside++;
    check_near(touch.depth, depth, 1e-12, 1e-14 * scale);
    check_near(cdem_norm3(touch.normal), 1.0, 1e-14, 0.0);
    check_near(touch.weight[0] + touch.weight[1] + touch.weight[2], 1.0, 1e-15, 0.0);
    for (int k = 0; k < 3; k++) {
      assert_true(touch.weight[k] >= 0.0);
      for (int c = 0; c < 3; c++)
        p[c] += touch.weight[k] * place[3 * touch.node[k] + c];
    }
    for (int c = 0; c < 3; c++)
      check_near(y[c] + touch.depth * touch.normal[c], p[c], 0.0, 1e-13 * scale);
  }
  assert_true(inside > tries / 8 && inside < tries);
}

static void any(int32_t (*make)(cdem_mesh *mesh), double margin) {
  cdem_fault fault = {0};
  cdem_random random = {11};
  cdem_mesh mesh;
  cdem_skin skin;
  int32_t nodes = make(&mesh);
  check_ok(cdem_skin_build(&mesh, nodes, margin, &skin, &fault));
  for (int part = 0; part < 3; part++) {
    double scale = part == 1 ? 1.0 : 0.015;
    double *place = deform(&skin, scale, 0.5 * part, &random);
    compare(&skin, place, scale, 3000, &random);
    free(place);
  }
  cdem_skin_release(&skin);
  cdem_mesh_release(&mesh);
}

static int32_t make_ball(cdem_mesh *mesh) {
  return ball_mesh(4, mesh);
}
static int32_t make_brick(cdem_mesh *mesh) {
  return box_mesh(CDEM_SHAPE_TET4, count, size, 0.2, mesh);
}
static int32_t make_quadratic(cdem_mesh *mesh) {
  return box_mesh(CDEM_SHAPE_TET10, (int32_t[3]){1, 1, 1}, size, 0.0, mesh);
}

static void nearest_points_are_the_nearest_of_all(void **state) {
  (void)state;
  any(make_ball, 0.05);
  any(make_brick, 0.1);
  any(make_quadratic, 0.15);
}

static void a_notch_is_outside(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh;
  cdem_skin skin;
  cdem_skin_touch touch;
  any(notch_mesh, 0.08);
  int32_t nodes = notch_mesh(&mesh);
  check_ok(cdem_skin_build(&mesh, nodes, 0.08, &skin, &fault));
  assert_false(cdem_skin_touches(&skin, skin.reference, 1.0, (double[3]){0.0, 0.1, 0.3}, &touch));
  /* below the edge of the notch at x = -0.25, z = -0.25 the nearest point is on that edge */
  assert_true(
      cdem_skin_touches(&skin, skin.reference, 1.0, (double[3]){-0.28, 0.1, -0.29}, &touch));
  check_near(touch.depth, 0.05, 1e-13, 0.0);
  check_near(touch.normal[0], 0.6, 1e-13, 0.0);
  check_near(touch.normal[1], 0.0, 0.0, 1e-15);
  check_near(touch.normal[2], 0.8, 1e-13, 0.0);
  cdem_skin_release(&skin);
  cdem_mesh_release(&mesh);
}

/* The flat tip of a body, its lower side cut into four: there the mean of the triangles' normals
 * points down, and takes places above the tip for inside; that by angles does not. */
static void triangles_at_a_corner_count_by_their_angles(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_skin skin;
  cdem_skin_touch touch;
  const double tip[7][3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.2}, {1.0, -1.0, 0.0}, {1.0, -0.5, 0.0},
                            {1.0, 0.0, 0.0}, {1.0, 0.5, 0.0}, {1.0, 1.0, 0.0}};
  check_ok(cdem_mesh_add_nodes(&mesh, 7, tip[0], NULL, &fault));
  for (int32_t k = 0; k < 4; k++)
    check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_TET4, 1, (int32_t[4]){0, 2 + k, 3 + k, 1}, NULL,
                                 &fault));
  check_ok(cdem_skin_build(&mesh, 7, 0.05, &skin, &fault));
  assert_false(
      cdem_skin_touches(&skin, skin.reference, 1.0, (double[3]){-1e-3, 0.0, 4e-3}, &touch));
  assert_false(
      cdem_skin_touches(&skin, skin.reference, 1.0, (double[3]){-1e-3, 0.0, -4e-3}, &touch));
  assert_true(cdem_skin_touches(&skin, skin.reference, 1.0, (double[3]){0.1, 0.0, 1e-3}, &touch));
  cdem_skin_release(&skin);
  cdem_mesh_release(&mesh);
}

/* depth' = -normal . y' + sum weight normal . x' by central differences. */
static void a_depth_shrinks_along_its_normal(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_random random = {5};
  cdem_mesh mesh;
  cdem_skin skin;
  cdem_skin_touch touch, after, before;
  int32_t nodes = notch_mesh(&mesh);
  check_ok(cdem_skin_build(&mesh, nodes, 0.05, &skin, &fault));
  double *place = deform(&skin, 1.0, 0.5, &random);
  double *there = malloc(3 * (size_t)nodes * sizeof *there), way = 1e-5;
  int tried = 0;
  for (int i = 0; i < 400; i++) {
    double y[3], dy[3], rate = 0.0;
    for (int c = 0; c < 3; c++) {
      y[c] = cdem_random_uniform(&random, -0.8, 0.8);
      dy[c] = cdem_random_uniform(&random, -1.0, 1.0);
    }
    double *dx = deform(&skin, 1.0, 0.5, &random);
    if (cdem_skin_touches(&skin, place, 1.0, y, &touch)) {
      for (int c = 0; c < 3; c++) {
        rate -= touch.normal[c] * dy[c];
        for (int k = 0; k < 3; k++)
          rate += touch.weight[k] * touch.normal[c] * dx[3 * touch.node[k] + c];
      }
      for (int sign = -1; sign <= 1; sign += 2) {
        double z[3];
        for (int c = 0; c < 3; c++)
          z[c] = y[c] + sign * way * dy[c];
        for (int k = 0; k < 3 * nodes; k++)
          there[k] = place[k] + sign * way * dx[k];
        if (!cdem_skin_touches(&skin, there, 1.0, z, sign < 0 ? &before : &after))
          rate = NAN;
      }
      /* not where the nearest point jumps from one triangle to another */
      if (rate == rate && memcmp(before.node, after.node, sizeof after.node) == 0 &&
          cdem_dot3(before.normal, after.normal) > 0.999) {
        check_near((after.depth - before.depth) / (2.0 * way), rate, 1e-6, 1e-6);
        tried++;
      }
    }
    free(dx);
  }
  assert_true(tried > 80);
  free(there);
  free(place);
  cdem_skin_release(&skin);
  cdem_mesh_release(&mesh);
}

static void twice_as_large_is_twice_as_deep(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_random random = {7};
  cdem_mesh mesh;
  cdem_skin skin;
  int32_t nodes = ball_mesh(3, &mesh), inside = 0;
  check_ok(cdem_skin_build(&mesh, nodes, 0.05, &skin, &fault));
  double *place = deform(&skin, 0.3, 1.0, &random);
  double *large = malloc(3 * (size_t)nodes * sizeof *large);
  for (int k = 0; k < 3 * nodes; k++)
    large[k] = 4.0 * place[k];
  for (int i = 0; i < 500; i++) {
    cdem_skin_touch a, b;
    double y[3], z[3];
    for (int c = 0; c < 3; c++) {
      y[c] = cdem_random_uniform(&random, -0.3, 0.3);
      z[c] = 4.0 * y[c];
    }
    bool touches = cdem_skin_touches(&skin, place, 0.3, y, &a);
    assert_int_equal(touches, cdem_skin_touches(&skin, large, 1.2, z, &b));
    if (!touches)
      continue;
    inside++;
    a.depth *= 4.0;
    assert_memory_equal(&a.depth, &b.depth, sizeof a.depth);
    assert_memory_equal(a.normal, b.normal, sizeof a.normal);
    assert_memory_equal(a.weight, b.weight, sizeof a.weight);
    assert_memory_equal(a.node, b.node, sizeof a.node);
  }
  assert_true(inside > 100);
  free(large);
  free(place);
  cdem_skin_release(&skin);
  cdem_mesh_release(&mesh);
}

/* Near the surface a question costs few triangles. */
static void lists_are_short(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int n = 3; n <= 8; n += 5) {
    cdem_mesh mesh;
    cdem_skin skin;
    int64_t items = 0, cells = 0;
    int32_t nodes = ball_mesh(n, &mesh);
    check_ok(cdem_skin_build(&mesh, nodes, 0.02, &skin, &fault));
    for (int32_t t = 0; t < skin.triangles; t++) {
      int64_t at = 0;
      for (int c = 0; c < 3; c++) {
        double middle = 0.0;
        for (int k = 0; k < 3; k++)
          middle += skin.reference[3 * skin.triangle[3 * t + k] + c] / 3.0;
        at = at * skin.cells + (int64_t)((0.98 * middle - skin.low[c]) / skin.cell);
      }
      int32_t list = skin.list[at];
      assert_true(list > 0);
      items += skin.start[list + 1] - skin.start[list];
      cells++;
    }
    printf("%d triangles: %.1f a question, %d lists\n", skin.triangles,
           (double)items / (double)cells, skin.lists);
    check_below((double)items / (double)cells, 10.0);
    cdem_skin_release(&skin);
    cdem_mesh_release(&mesh);
  }
}

/* ---- errors ---- */

static void two_cubes(const double apart[3], cdem_mesh *mesh, cdem_fault *fault) {
  static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  *mesh = (cdem_mesh){0};
  for (int cube = 0; cube < 2; cube++) {
    int32_t node[8];
    for (int k = 0; k < 8; k++)
      node[k] = ball_node(mesh, (double[3]){corner[k][0] + cube * apart[0],
                                            corner[k][1] + cube * apart[1],
                                            corner[k][2] + cube * apart[2]});
    assert_int_equal(cdem_mesh_add_cells(mesh, CDEM_SHAPE_HEX8, 1, node, NULL, fault), CDEM_OK);
  }
}

static void what_is_no_skin_is_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh;
  cdem_skin skin;
  int32_t nodes = box_mesh(CDEM_SHAPE_HEX8, (int32_t[3]){2, 2, 2}, size, 0.0, &mesh);
  check_fails(cdem_skin_build(&mesh, nodes, -0.1, &skin, &fault), CDEM_INPUT, "-0.1 radii");
  check_fails(cdem_skin_build(&mesh, 28, 0.1, &skin, &fault), CDEM_INPUT, "at most all");
  check_fails(cdem_skin_build(&mesh, nodes - 1, 0.1, &skin, &fault), CDEM_INPUT,
              "node 26 of the mesh of a grain is on its surface but not among the first 25");
  check_fails(cdem_skin_build(&mesh, nodes + 1, 0.1, &skin, &fault), CDEM_INPUT,
              "node 27 of the mesh of a grain is among the first 27 but not on the surface");
  assert_null(skin.triangle);
  shift_mesh(&mesh, (double[3]){0.0, 0.0, 0.0}, -1.0);
  check_fails(cdem_skin_build(&mesh, nodes, 0.1, &skin, &fault), CDEM_INPUT, "inside out");
  shift_mesh(&mesh, (double[3]){0.0, 0.0, 0.0}, 0.0);
  check_fails(cdem_skin_build(&mesh, nodes, 0.1, &skin, &fault), CDEM_INPUT,
              "make a triangle of area 0");
  cdem_mesh_release(&mesh);
  two_cubes((double[3]){1.0, 1.0, 0.0}, &mesh, &fault);
  check_fails(cdem_skin_build(&mesh, mesh.nodes, 0.1, &skin, &fault), CDEM_INPUT,
              "4 triangles meet at the edge");
  cdem_mesh_release(&mesh);
  two_cubes((double[3]){1.0, 1.0, 1.0}, &mesh, &fault);
  check_fails(cdem_skin_build(&mesh, mesh.nodes, 0.1, &skin, &fault), CDEM_INPUT,
              "touches itself at node 7");
  cdem_mesh_release(&mesh);
  mesh = (cdem_mesh){0};
  check_ok(cdem_mesh_add_nodes(&mesh, 4, (double[12]){0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, NULL,
                               &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_QUAD4, 1, (int32_t[4]){0, 1, 2, 3}, NULL, &fault));
  check_fails(cdem_skin_build(&mesh, 4, 0.1, &skin, &fault), CDEM_INPUT, "no volume cells");
  cdem_mesh_release(&mesh);
}

static void memory_that_ends_leaves_nothing_behind(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh;
  cdem_skin skin;
  int32_t nodes = ball_mesh(2, &mesh);
  cdem_status status = CDEM_MEMORY;
  int failures = 0;
  for (; status == CDEM_MEMORY; failures++) {
    cdem_memory_fail_after(failures);
    status = cdem_skin_build(&mesh, nodes, 0.1, &skin, &fault);
    if (status != CDEM_OK)
      assert_null(skin.triangle);
  }
  cdem_memory_fail_after(-1);
  assert_int_equal(status, CDEM_OK);
  assert_true(failures > 10);
  cdem_skin_release(&skin);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_has_the_skin_of_a_box),
      cmocka_unit_test(areas_are_thirds_of_triangles),
      cmocka_unit_test(nearest_points_are_the_nearest_of_all),
      cmocka_unit_test(a_notch_is_outside),
      cmocka_unit_test(triangles_at_a_corner_count_by_their_angles),
      cmocka_unit_test(a_depth_shrinks_along_its_normal),
      cmocka_unit_test(twice_as_large_is_twice_as_deep),
      cmocka_unit_test(lists_are_short),
      cmocka_unit_test(what_is_no_skin_is_refused),
      cmocka_unit_test(memory_that_ends_leaves_nothing_behind),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
