/* Maps: what is seen of a body, in which order, how bright and of which value. */
#include "results/map.h"

#include "results/map_view.h"
#include "results/tensor.h"
#include "support/test.h"

static const double front[3] = {0, 0, -1}, upwards[3] = {0, 1, 0};
static const double slanted[3] = {-1, 1.6, -0.8}, zenith[3] = {0, 0, 1};

/* ---- tensors ---- */

static void invariants_in_closed_form(void **unused) {
  (void)unused;
  static const struct {
    double t[6], mises, principal[3];
  } known[] = {
      {{-5, 0, 0, 0, 0, 0}, 5, {0, 0, -5}},
      {{0, 0, 0, 0, 2, 0}, 3.4641016151377546, {2, 0, -2}}, /* sqrt(3) times the shear */
      {{7, 7, 7, 0, 0, 0}, 0, {7, 7, 7}},
      {{2, 2, 0, 1, 0, 0}, 2.6457513110645906, {3, 1, 0}},
      {{0, 0, 0, 0, 0, 0}, 0, {0, 0, 0}},
      {{1, 3, 2, 0, 0, 0}, 1.7320508075688772, {3, 2, 1}},
  };
  for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
    for (int power = -290; power <= 290; power += 145) {
      double t[6], value[3], scale = pow(10.0, power);
      for (int i = 0; i < 6; i++)
        t[i] = known[k].t[i] * scale;
      cdem_tensor_principal(t, value);
      for (int i = 0; i < 3; i++) /* 1e-7: two of the values may coincide */
        check_near(value[i], known[k].principal[i] * scale, 1e-14, 1e-7 * scale);
      if (abs(power) <= 145) /* squares stay finite */
        check_near(cdem_tensor_von_mises(t), known[k].mises * scale, 1e-14, 1e-15 * scale);
    }
}

/* R diag(a, b, c) R^T by a rotation about an arbitrary axis (Rodrigues). */
static void turned(const double diagonal[3], const double axis[3], double angle, double t[6]) {
  static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  double n = cdem_norm3(axis), x = axis[0] / n, y = axis[1] / n, z = axis[2] / n;
  double c = cos(angle), s = sin(angle), d = 1 - c;
  const double r[9] = {c + x * x * d,     x * y * d - z * s, x * z * d + y * s,
                       y * x * d + z * s, c + y * y * d,     y * z * d - x * s,
                       z * x * d - y * s, z * y * d + x * s, c + z * z * d};
  for (int k = 0; k < 6; k++) {
    t[k] = 0.0;
    for (int i = 0; i < 3; i++)
      t[k] += r[3 * at[k][0] + i] * diagonal[i] * r[3 * at[k][1] + i];
  }
}

static void invariants_do_not_turn(void **unused) {
  (void)unused;
  cdem_random random = {11};
  const double diagonal[3] = {4.0, 1.5, -3.0};
  for (int i = 0; i < 200; i++) {
    double axis[3], t[6], value[3];
    for (int c = 0; c < 3; c++)
      axis[c] = cdem_random_uniform(&random, -1, 1);
    turned(diagonal, axis, cdem_random_uniform(&random, 0, 6), t);
    cdem_tensor_principal(t, value);
    for (int c = 0; c < 3; c++)
      check_near(value[c], diagonal[c], 1e-13, 0);
    check_near(cdem_tensor_von_mises(t), sqrt(0.5 * (2.5 * 2.5 + 4.5 * 4.5 + 49)), 1e-13, 0);
  }
}

/* ---- plane bodies ---- */

/* Two cells that share an edge: a quadrilateral 0 1 2 3 and a triangle 1 4 2, and a line. */
static const double plane_xyz[15] = {0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0, 3, 0.5, 0};
static const uint8_t plane_type[3] = {9, 5, 3};
static const int64_t plane_offset[4] = {0, 4, 7, 9};
static const int32_t plane_node[9] = {0, 1, 2, 3, 1, 4, 2, 0, 3};

static void plane_bodies_keep_their_order(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  const double energy[3] = {5, -7, 1}, heat[5] = {1, 2, 4, 8, 16};
  const double force[9] = {3, 4, 0, 0, -2, 0, 9, 9, 9}, move[15] = {0, 0, 0, 0.1, 0.2};
  const cdem_field field[4] = {{"energy", "J", true, 1, CDEM_FIELD_REAL, energy, 0, NULL},
                               {"heat", "", false, 1, CDEM_FIELD_REAL, heat, 0, NULL},
                               {"force", "N", true, 3, CDEM_FIELD_REAL, force, 0, NULL},
                               {"displacement", "m", false, 3, CDEM_FIELD_REAL, move, 0, NULL}};
  const cdem_frame frame = {"body",       0,          0, 5,    plane_xyz, 3, plane_type,
                            plane_offset, plane_node, 4, field};
  static const struct {
    const char *field;
    int component;
    double value[2];
  } wanted[] = {{"energy", 0, {5, -7}},
                {"energy", -1, {5, -7}},
                {"heat", -1, {3.75, 22.0 / 3}},
                {"force", 1, {4, -2}},
                {"force", -1, {5, 2}}};
  static const int corner[7] = {0, 1, 2, 3, 1, 4, 2};
  for (int k = 0; k < 5; k++)
    for (int magnify = 0; magnify <= 10; magnify += 5) {
      cdem_map map;
      check_ok(cdem_map_from_frame(&frame, wanted[k].field, wanted[k].component, front, upwards,
                                   magnify, &map, &fault));
      assert_int_equal(map.polygons, 2);
      assert_int_equal(map.start[1], 4);
      assert_int_equal(map.start[2], 7);
      assert_null(map.shade);
      double more = magnify == 0 ? 0 : magnify - 1;
      for (int n = 0; n < 7; n++)
        for (int c = 0; c < 2; c++)
          check_near(map.xy[2 * n + c],
                     plane_xyz[3 * corner[n] + c] + more * move[3 * corner[n] + c], 1e-15, 0);
      for (int p = 0; p < 2; p++)
        check_near(map.value[p], wanted[k].value[p], 1e-15, 0);
      cdem_map_release(&map);
      assert_null(map.xy);
    }
  cdem_map map;
  check_ok(cdem_map_from_frame(&frame, NULL, 0, front, upwards, 1, &map, &fault));
  assert_true(isnan(map.value[0]) && isnan(map.value[1]));
  cdem_map_release(&map);
}

/* ---- solids: n^3 hexahedra, each turned to another start and some mirrored ---- */

enum { SIDE = 4, LARGEST = 64 };

typedef struct {
  int64_t points, cells, offset[LARGEST + 1];
  double xyz[3 * (SIDE + 1) * (SIDE + 1) * (SIDE + 1)], value[LARGEST];
  uint8_t type[LARGEST];
  int32_t node[8 * LARGEST];
  cdem_field field;
  cdem_frame frame;
} block;

static void fill_block(block *b, int n) {
  *b = (block){.points = (n + 1) * (n + 1) * (n + 1)};
  for (int64_t p = 0; p < b->points; p++) {
    b->xyz[3 * p] = (double)(p % (n + 1));
    b->xyz[3 * p + 1] = (double)(p / (n + 1) % (n + 1));
    b->xyz[3 * p + 2] = (double)(p / ((n + 1) * (n + 1)));
  }
  for (int c = 0; c < n * n * n; c++) {
    int m = n + 1, at = c / (n * n) * m * m + c / n % n * m + c % n;
    const int32_t straight[8] = {at,         at + 1,         at + 1 + m,         at + m,
                                 at + m * m, at + 1 + m * m, at + 1 + m + m * m, at + m + m * m};
    for (int i = 0; i < 8; i++) /* odd cells upside down: their volume is negative */
      b->node[8 * c + i] = straight[c % 2 == 0 ? i : (i + 4) % 8];
    b->type[c] = 12;
    b->offset[c + 1] = 8 * (c + 1);
    b->value[c] = c;
  }
  b->field = (cdem_field){"cell", "", true, 1, CDEM_FIELD_REAL, b->value, 0, NULL};
  b->cells = n * n * n;
  b->frame = (cdem_frame){"body",  0,         0,       b->points, b->xyz,   b->cells,
                          b->type, b->offset, b->node, 1,         &b->field};
}

static void inner_faces_are_hidden(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  for (int n = 1; n <= SIDE; n++) {
    block b;
    cdem_map map;
    int64_t faces = 0;
    cdem_map_face *face = NULL;
    fill_block(&b, n);
    check_ok(cdem_map_outer_faces(&b.frame, &faces, &face, &fault));
    assert_int_equal(faces, 6 * n * n);
    free(face);
    check_ok(cdem_map_from_frame(&b.frame, "cell", 0, slanted, zenith, 0, &map, &fault));
    assert_int_equal(map.polygons, 3 * n * n); /* three sides face the eye */
    cdem_map_release(&map);
    check_ok(cdem_map_from_frame(&b.frame, "cell", 0, front, upwards, 0, &map, &fault));
    assert_int_equal(map.polygons, n * n);
    for (int64_t p = 0; p < map.polygons; p++)
      assert_true(map.value[p] >= n * n * (n - 1)); /* the top layer */
    cdem_map_release(&map);
  }
}

static void faces_of_all_cells(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  static const struct {
    uint8_t type[2];
    int64_t offset[3];
    int32_t node[16];
    int64_t outer;
  } known[] = {
      {{10, 10}, {0, 4, 8}, {0, 1, 2, 3, 2, 1, 0, 4}, 6},                    /* 4 + 4 - 2 */
      {{12, 13}, {0, 8, 14}, {0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 2, 5, 9, 6}, 9}, /* 6 + 5 - 2 */
      {{12, 14}, {0, 8, 13}, {0, 1, 2, 3, 4, 5, 6, 7, 7, 6, 5, 4, 8}, 9},    /* 6 + 5 - 2 */
      {{14, 10}, {0, 5, 9}, {0, 1, 2, 3, 4, 4, 1, 0, 5}, 7},                 /* 5 + 4 - 2 */
      {{13, 5}, {0, 6, 9}, {0, 1, 2, 3, 4, 5, 0, 1, 2}, 6}, /* a plane cell stays */
      {{1, 3}, {0, 1, 3}, {0, 1, 2}, 0},
  };
  for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
    int64_t faces = -1;
    cdem_map_face *face = NULL;
    const cdem_frame frame = {
        "body", 0, 0, 10, plane_xyz, 2, known[k].type, known[k].offset, known[k].node, 0, NULL};
    check_ok(cdem_map_outer_faces(&frame, &faces, &face, &fault));
    assert_int_equal(faces, known[k].outer);
    free(face);
  }
}

static void slopes_are_shaded(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  block b;
  cdem_map map;
  fill_block(&b, 1);
  check_ok(cdem_map_from_frame(&b.frame, NULL, 0, slanted, zenith, 0, &map, &fault));
  assert_int_equal(map.polygons, 3);
  double low = 1, high = 0, top = 0;
  for (int p = 0; p < 3; p++) {
    double y = 0; /* the top is the one whose picture is highest */
    for (int n = 0; n < 4; n++)
      y += map.xy[2 * (map.start[p] + n) + 1];
    low = fmin(low, map.shade[p]);
    high = fmax(high, map.shade[p]);
    top = y > 4 * 0.9 ? map.shade[p] : top;
    check_near(map.shade[p], 0.775, 0, 0.225);
  }
  assert_true(top == high && low < 0.8 * high);
  cdem_map_release(&map);
}

/* ---- what covers what: bricks, walls and slabs in a heap, looked at along rays ---- */

enum { BOXES = 40 };

/* Boxes of all proportions, turned about the vertical, one in each place of a loose pile. */
static void fill_heap(double xyz[BOXES][8][3], uint64_t seed) {
  static const int sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                 {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  cdem_random random = {seed};
  for (int b = 0; b < BOXES; b++) {
    double half[3], angle = cdem_random_uniform(&random, -0.1, 0.1);
    for (int c = 0; c < 3; c++)
      half[c] = cdem_random_uniform(&random, 0.05, c == 2 ? 0.5 : 0.45);
    for (int n = 0; n < 8; n++) {
      double x = half[0] * sign[n][0], y = half[1] * sign[n][1];
      xyz[b][n][0] = b % 4 + x * cos(angle) - y * sin(angle);
      xyz[b][n][1] = b / 4 % 2 + x * sin(angle) + y * cos(angle);
      xyz[b][n][2] = b / 8 + half[2] * (sign[n][2] + 1);
    }
  }
}

/* Depth at which a ray enters a triangle; infinite when it misses (Moeller and Trumbore 1997). */
static double hit(const double from[3], const double along[3], const double *a, const double *b,
                  const double *c) {
  double e[3], f[3], h[3], s[3], q[3];
  for (int i = 0; i < 3; i++) {
    e[i] = b[i] - a[i];
    f[i] = c[i] - a[i];
    s[i] = from[i] - a[i];
  }
  cdem_cross3(along, f, h);
  double det = cdem_dot3(e, h), u = cdem_dot3(s, h) / det;
  cdem_cross3(s, e, q);
  double v = cdem_dot3(along, q) / det;
  return det != 0 && u >= 0 && v >= 0 && u + v <= 1 ? cdem_dot3(f, q) / det : INFINITY;
}

static int nearest_box(double xyz[BOXES][8][3], const double from[3], const double along[3]) {
  const cdem_vtk_cell *hex = cdem_vtk_cell_get(12);
  double nearest = INFINITY;
  int found = -1;
  for (int b = 0; b < BOXES; b++)
    for (int f = 0; f < 6; f++)
      for (int half = 0; half < 2; half++) {
        const int8_t *n = hex->face[f];
        double depth = hit(from, along, xyz[b][n[0]], xyz[b][n[1 + half]], xyz[b][n[2 + half]]);
        if (depth < nearest) {
          nearest = depth;
          found = b;
        }
      }
  return found;
}

/* The box painted last at a place of the picture; -1: none. */
static int painted_box(const cdem_map *map, double x, double y) {
  for (int64_t p = map->polygons - 1; p >= 0; p--) {
    int left = 0, corners = (int)(map->start[p + 1] - map->start[p]);
    for (int i = 0; i < corners; i++) {
      const double *a = map->xy + 2 * (map->start[p] + i);
      const double *b = map->xy + 2 * (map->start[p] + (i + 1) % corners);
      left += (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0;
    }
    if (left == 0 || left == corners)
      return (int)map->value[p];
  }
  return -1;
}

static void the_nearest_is_painted_last(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  static double xyz[BOXES][8][3];
  uint8_t type[BOXES];
  int64_t offset[BOXES + 1];
  int32_t node[8 * BOXES], number[BOXES];
  for (int i = 0; i < 8 * BOXES; i++)
    node[i] = i;
  for (int b = 0; b <= BOXES; b++)
    offset[b] = 8 * b;
  for (int b = 0; b < BOXES; b++) {
    type[b] = 12;
    number[b] = b;
  }
  const cdem_field field = {"box", "", true, 1, CDEM_FIELD_INT32, number, 0, NULL};
  const cdem_frame frame = {"body", 0,      0,    8 * BOXES, xyz[0][0], BOXES,
                            type,   offset, node, 1,         &field};
  const double views[3][3] = {{-1, 1.6, -0.8}, {1, 0.3, -0.2}, {0.4, -1, -2}};
  int seen = 0;
  for (int v = 0; v < 3; v++) {
    fill_heap(xyz, (uint64_t)v + 1);
    cdem_map map;
    cdem_map_view view;
    check_ok(cdem_map_view_init(views[v], zenith, &view, &fault));
    check_ok(cdem_map_from_frame(&frame, "box", 0, views[v], zenith, 0, &map, &fault));
    cdem_random random = {7};
    for (int i = 0; i < 3000; i++) {
      double x = cdem_random_uniform(&random, -4, 4), y = cdem_random_uniform(&random, -2, 6);
      double from[3];
      for (int c = 0; c < 3; c++)
        from[c] = x * view.right[c] + y * view.up[c] - 100 * view.into[c];
      int expected = nearest_box(xyz, from, view.into);
      assert_int_equal(painted_box(&map, x, y), expected);
      seen += expected >= 0;
    }
    cdem_map_release(&map);
  }
  assert_in_range(seen, 1500, 9000);
}

/* ---- lines ---- */

static void lines_are_chosen_by_state(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  const uint8_t state[3] = {0, 2, 3};
  const cdem_field field[2] = {{"state", "", true, 1, CDEM_FIELD_UINT8, state, 0, NULL},
                               {"real", "", true, 1, CDEM_FIELD_REAL, plane_xyz, 0, NULL}};
  const cdem_frame frame = {"joints",     0,          0, 5,    plane_xyz, 3, plane_type,
                            plane_offset, plane_node, 2, field};
  cdem_map map = {0};
  check_ok(cdem_map_add_lines(&map, &frame, "state", 1u << 3 | 1u << 2, front, upwards, "shear",
                              "#b2182b", 1.5, &fault));
  check_ok(cdem_map_add_lines(&map, &frame, NULL, 0, front, upwards, NULL, "#000000", 0.5, &fault));
  check_ok(cdem_map_add_lines(&map, &frame, "state", 1u << 7, front, upwards, "none", "#000000", 1,
                              &fault));
  assert_int_equal(map.line_sets, 3);
  assert_string_equal(map.lines[0].title, "shear");
  assert_string_equal(map.lines[0].colour, "#b2182b");
  assert_true(map.lines[0].width == 1.5);
  const double expected[16] = {2, 0, 3, 0.5, 3, 0.5, 2, 1, 2, 1, 2, 0, 0, 0, 0, 1};
  assert_int_equal(map.lines[0].segments, 4); /* the triangle's edges, the line */
  assert_memory_equal(map.lines[0].xy, expected, sizeof expected);
  assert_int_equal(map.lines[1].segments, 8);
  assert_int_equal(map.lines[2].segments, 0);
  check_fails(cdem_map_add_lines(&map, &frame, "real", 1, front, upwards, "", "", 1, &fault),
              CDEM_INPUT, "no field 'real' of one integer a cell");
  check_fails(cdem_map_add_lines(&map, &frame, "gone", 1, front, upwards, "", "", 1, &fault),
              CDEM_INPUT, "'joints' has no field 'gone'");
  assert_int_equal(map.line_sets, 3);
  cdem_map_release(&map);
}

static void what_cannot_be_drawn_is_named(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  block b;
  cdem_map map;
  fill_block(&b, 1);
  check_fails(cdem_map_from_frame(&b.frame, "stress", 0, slanted, zenith, 0, &map, &fault),
              CDEM_INPUT, "the data set 'body' has no field 'stress'");
  check_fails(cdem_map_from_frame(&b.frame, "cell", 1, slanted, zenith, 0, &map, &fault),
              CDEM_USAGE, "component 1 of the field 'cell' cannot be drawn; it has 1");
  check_fails(cdem_map_from_frame(&b.frame, "cell", -4, slanted, zenith, 0, &map, &fault),
              CDEM_USAGE, "component -4");
  check_fails(cdem_map_from_frame(&b.frame, "cell", -2, slanted, zenith, 0, &map, &fault),
              CDEM_USAGE, "principal values are those of a symmetric tensor");
  check_fails(cdem_map_from_frame(&b.frame, "cell", 0, zenith, zenith, 0, &map, &fault), CDEM_USAGE,
              "choose two directions that are not parallel");
  check_fails(cdem_map_from_frame(&b.frame, "cell", 0, slanted, zenith, 20, &map, &fault),
              CDEM_INPUT, "no field 'displacement' of vectors at points to magnify");
  assert_int_equal(map.polygons, 0);
  for (int allowed = 0;; allowed++) {
    cdem_memory_fail_after(allowed);
    cdem_status status = cdem_map_from_frame(&b.frame, "cell", 0, slanted, zenith, 0, &map, &fault);
    if (status == CDEM_OK)
      status = cdem_map_add_lines(&map, &b.frame, NULL, 0, slanted, zenith, "", "", 1, &fault);
    cdem_memory_fail_after(-1);
    cdem_map_release(&map);
    if (status == CDEM_OK) {
      assert_true(allowed > 10);
      return;
    }
    assert_int_equal(status, CDEM_MEMORY);
  }
}

/* ---- marks and segments ---- */

static void marks_are_sets_of_zeroed_arrays(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_map map = {0};
  cdem_map_marks *marks;
  cdem_map_lines *lines;
  check_ok(cdem_map_add_marks(&map, CDEM_MAP_DISCS, 3, true, false, &marks, &fault));
  assert_true(marks->value != NULL && marks->shade == NULL && marks->size[2] == 0.0);
  check_ok(cdem_map_add_marks(&map, CDEM_MAP_ARROWS, 0, false, true, &marks, &fault));
  assert_true(marks == &map.marks[1] && marks->kind == CDEM_MAP_ARROWS && marks->shade != NULL);
  check_ok(cdem_map_add_segments(&map, 2, "wall", "#000000", 1.5, &lines, &fault));
  assert_true(lines->segments == 2 && lines->xy[7] == 0.0 && lines->width == 1.5);
  for (int n = 0; n < 4; n++) { /* what was made before is kept, and all of it is released */
    cdem_memory_fail_after(n);
    check_fails(cdem_map_add_marks(&map, CDEM_MAP_STROKES, 5, true, true, &marks, &fault),
                CDEM_MEMORY, "");
  }
  cdem_memory_fail_after(-1);
  assert_int_equal(map.marks[0].marks, 3);
  cdem_map_release(&map);
  assert_true(map.marks == NULL && map.mark_sets == 0 && map.lines == NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(invariants_in_closed_form),
      cmocka_unit_test(invariants_do_not_turn),
      cmocka_unit_test(plane_bodies_keep_their_order),
      cmocka_unit_test(inner_faces_are_hidden),
      cmocka_unit_test(faces_of_all_cells),
      cmocka_unit_test(slopes_are_shaded),
      cmocka_unit_test(the_nearest_is_painted_last),
      cmocka_unit_test(lines_are_chosen_by_state),
      cmocka_unit_test(what_cannot_be_drawn_is_named),
      cmocka_unit_test(marks_are_sets_of_zeroed_arrays),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
