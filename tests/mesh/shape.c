/* Room mesh: the shape table obeys the laws of polyhedra, for every line of the table. */
#include "mesh/shape.h"

#include "support/test.h"

#define FOR_EACH_SHAPE(info)                                                                       \
  for (int s = 0; s < CDEM_SHAPE_COUNT; s++)                                                       \
    for (const cdem_shape_info *info = cdem_shape_get((cdem_shape)s); info != NULL; info = NULL)

static void names_lead_back_to_shapes(void **state) {
  (void)state;
  FOR_EACH_SHAPE(info) assert_int_equal(cdem_shape_find(info->name), s);
  assert_int_equal(cdem_shape_find("hex9"), CDEM_SHAPE_COUNT);
  assert_string_equal(cdem_shape_get(CDEM_SHAPE_HEX20)->name, "hex20");
}

/* V - E + F: 2 on a sphere, 1 on a disc; a segment has 2 - 1. */
static void euler_characteristic(void **state) {
  (void)state;
  FOR_EACH_SHAPE(info) {
    int euler = info->corners - info->edges + info->faces;
    assert_int_equal(euler, info->dimension == 3 ? 2 : 1);
  }
}

/* Corner after corner `c` on face `f`. */
static int next_on_face(const cdem_shape_info *info, int f, int c) {
  return info->face[f][(c + 1) % info->face_corners[f]];
}

/* Each edge lies in exactly two faces of a solid, and outward faces run through it once each way.
 */
static void edges_are_shared_by_two_faces_in_opposite_sense(void **state) {
  (void)state;
  FOR_EACH_SHAPE(info) {
    for (int e = 0; e < info->edges && info->dimension >= 2; e++) {
      int forward = 0, backward = 0;
      for (int f = 0; f < info->faces; f++)
        for (int c = 0; c < info->face_corners[f]; c++) {
          int a = info->face[f][c], b = next_on_face(info, f, c);
          forward += a == info->edge[e][0] && b == info->edge[e][1];
          backward += a == info->edge[e][1] && b == info->edge[e][0];
        }
      assert_int_equal(forward + backward, info->dimension == 3 ? 2 : 1);
      if (info->dimension == 3)
        assert_int_equal(forward, backward);
    }
  }
}

/* Every node is a corner or the middle of exactly one edge; second-order faces list after their
 * corners the mid nodes of the sides in order. */
static void mid_nodes_belong_to_one_edge_and_follow_the_face(void **state) {
  (void)state;
  FOR_EACH_SHAPE(info) {
    int uses[CDEM_SHAPE_MAX_NODES] = {0};
    for (int e = 0; e < info->edges; e++)
      if (info->edge[e][2] >= 0)
        uses[info->edge[e][2]]++;
    for (int n = 0; n < info->nodes; n++)
      assert_int_equal(uses[n], n < info->corners ? 0 : 1);
    for (int f = 0; f < info->faces; f++) {
      int corners = info->face_corners[f], listed = 0;
      while (listed < 8 && info->face[f][listed] >= 0)
        listed++;
      assert_int_equal(listed, info->nodes > info->corners ? 2 * corners : corners);
      for (int c = 0; c < listed - corners; c++) {
        int a = info->face[f][c], b = next_on_face(info, f, c), found = 0;
        for (int e = 0; e < info->edges; e++)
          if ((info->edge[e][0] == a && info->edge[e][1] == b) ||
              (info->edge[e][0] == b && info->edge[e][1] == a))
            found += info->edge[e][2] == info->face[f][corners + c];
        assert_int_equal(found, 1);
      }
    }
  }
}

static void count_classes(cdem_shape shape, int count[4]) {
  int nodes = cdem_shape_get(shape)->nodes;
  memset(count, 0, 4 * sizeof *count);
  for (int a = 0; a < nodes; a++)
    for (int b = a + 1; b < nodes; b++) {
      int class_ = cdem_shape_pair_class(shape, a, b);
      assert_int_equal(class_, cdem_shape_pair_class(shape, b, a));
      assert_true(class_ >= 1 && class_ <= cdem_shape_get(shape)->dimension);
      count[class_]++;
    }
}

/* Counted by hand: an edge of m nodes holds m(m-1)/2 pairs and shares none with other edges; a face
 * adds its pairs less those of its edges; the rest goes through the body. */
static void pair_classes_add_up(void **state) {
  (void)state;
  FOR_EACH_SHAPE(info) {
    if (info->dimension == 0)
      continue;
    int count[4], on_edge = info->nodes > info->corners ? 3 : 1, face = 0;
    count_classes((cdem_shape)s, count);
    for (int f = 0; f < info->faces; f++) {
      int n = info->face_corners[f] * (info->nodes > info->corners ? 2 : 1);
      face += n * (n - 1) / 2 - info->face_corners[f] * on_edge;
    }
    assert_int_equal(count[1], info->edges * on_edge);
    assert_int_equal(count[2], face);
    assert_int_equal(count[3], info->nodes * (info->nodes - 1) / 2 - count[1] - count[2]);
  }
}

static void classes_of_well_known_cells(void **state) {
  (void)state;
  int count[4];
  count_classes(CDEM_SHAPE_HEX8, count);
  assert_int_equal(count[1], 12);
  assert_int_equal(count[2], 12);
  assert_int_equal(count[3], 4);
  count_classes(CDEM_SHAPE_QUAD4, count);
  assert_int_equal(count[1], 4);
  assert_int_equal(count[2], 2);
  count_classes(CDEM_SHAPE_TET4, count);
  assert_int_equal(count[1], 6);
  assert_int_equal(count[2] + count[3], 0);
}

/* Reference places of the hex20 nodes, from the corners and gmsh's order of mid nodes: a pair is of
 * class edge, face or body as it agrees in 2, 1 or 0 bounding planes. */
static void hex20_classes_follow_from_geometry(void **state) {
  (void)state;
  const cdem_shape_info *info = cdem_shape_get(CDEM_SHAPE_HEX20);
  int place[20][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                      {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  for (int e = 0; e < 12; e++)
    for (int i = 0; i < 3; i++)
      place[info->edge[e][2]][i] = (place[info->edge[e][0]][i] + place[info->edge[e][1]][i]) / 2;
  for (int a = 0; a < 20; a++)
    for (int b = 0; b < 20; b++) {
      int planes = 0;
      for (int i = 0; i < 3; i++)
        planes += place[a][i] != 0 && place[a][i] == place[b][i];
      if (a != b)
        assert_int_equal(cdem_shape_pair_class(CDEM_SHAPE_HEX20, a, b), 3 - planes);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_lead_back_to_shapes),
      cmocka_unit_test(euler_characteristic),
      cmocka_unit_test(edges_are_shared_by_two_faces_in_opposite_sense),
      cmocka_unit_test(mid_nodes_belong_to_one_edge_and_follow_the_face),
      cmocka_unit_test(pair_classes_add_up),
      cmocka_unit_test(classes_of_well_known_cells),
      cmocka_unit_test(hex20_classes_follow_from_geometry),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
