/* Depletion of cubes: the values of springs.md section 5, and what is safe. */
#include "network/deplete.h"

#include "network/support.h"

static void deplete_cubes(int32_t count, double nu, cdem_removal removal,
                          cdem_depletion *depletion) {
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_mesh_grid_options cubes = {
      .shape = CDEM_SHAPE_HEX8, .count = {count, count, count}, .size = {count, count, count}};
  check_ok(cdem_mesh_grid(&cubes, &mesh, &fault));
  cdem_material material = cdem_material_isotropic(1.0, nu);
  make_model(&mesh, &material, &model);
  cdem_convert_options options = {.frame = CDEM_FRAME_BODY};
  check_ok(cdem_network_deplete(&model, &options, &removal, 1, depletion, &fault));
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

/* The pair of tags of one class in the first cube: nodes 1-2, and the far corners, found by class.
 */
static cdem_removal one_pair(int class_) {
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_mesh_grid_options cube = {.shape = CDEM_SHAPE_HEX8, .count = {1, 1, 1}, .size = {1, 1, 1}};
  check_ok(cdem_mesh_grid(&cube, &mesh, &fault));
  int32_t body = cdem_mesh_find_group(&mesh, "body")->cell[0];
  const int32_t *node = cdem_mesh_cell(&mesh, body);
  const int far[] = {1, 2, 6};
  cdem_removal removal = {.element = mesh.cell_tag[body],
                          .node = {mesh.node_tag[node[0]], mesh.node_tag[node[far[class_]]]},
                          .class_ = class_,
                          .form = -1};
  cdem_mesh_release(&mesh);
  return removal;
}

/* springs.md section 5: mu = 1/4, one face or body group out of a cube; two digits are printed
 * there. */
static void one_face_or_body_group_makes_a_cube_unstable(void **state) {
  (void)state;
  cdem_depletion d;
  deplete_cubes(1, 0.25, one_pair(CDEM_CLASS_FACE), &d);
  check_near(d.lowest, -6.9e-3, 0, 0.05e-3);
  assert_true(d.negative_modes > 0 && !d.safe);
  deplete_cubes(1, 0.25, one_pair(CDEM_CLASS_BODY), &d);
  check_near(d.lowest, -1.9e-2, 0, 0.05e-2);
  assert_true(d.negative_modes > 0 && !d.safe);
  assert_int_equal(d.pairs, 1);
  assert_int_equal(d.springs, 4);
}

static void an_edge_group_loses_two_rotations(void **state) {
  (void)state;
  cdem_depletion d;
  deplete_cubes(1, 0.25, one_pair(CDEM_CLASS_EDGE), &d);
  assert_int_equal(d.negative_modes, 0);
  assert_int_equal(d.rigid_lost, 2);
  assert_int_equal(d.rigid_modes, 6);
  assert_false(d.safe);
  deplete_cubes(1, 0.2, one_pair(CDEM_CLASS_EDGE), &d);
  assert_true(d.negative_modes > 0);
  deplete_cubes(1, 0.3, one_pair(CDEM_CLASS_EDGE), &d);
  assert_true(d.negative_modes > 0);
}

/* At mu = 1/4 every block is symmetric, elsewhere a lost edge group leaves a skew part. */
static void skew_appears_away_from_a_quarter(void **state) {
  (void)state;
  cdem_depletion d;
  deplete_cubes(1, 0.25, one_pair(CDEM_CLASS_EDGE), &d);
  check_below(d.skew, 1e-14);
  deplete_cubes(1, 0.3, one_pair(CDEM_CLASS_EDGE), &d);
  assert_true(d.skew > 1e-3);
}

static void bigger_blocks_are_unstable_too(void **state) {
  (void)state;
  cdem_depletion d;
  cdem_removal removal = one_pair(CDEM_CLASS_FACE);
  removal.node[0] = removal.node[1] = 0; /* all faces of one cube */
  for (int32_t count = 2; count <= 5; count += 1) {
    deplete_cubes(count, 0.25, removal, &d);
    assert_true(d.negative_modes > 0 && d.lowest < -1e-4);
  }
}

static void whole_elements_may_go(void **state) {
  (void)state;
  cdem_depletion d;
  cdem_removal removal = {.element = one_pair(0).element, .class_ = -1, .form = -1};
  deplete_cubes(3, 0.3, removal, &d);
  assert_int_equal(d.pairs, 28);
  assert_int_equal(d.negative_modes, 0);
  check_below(d.skew, 1e-12);
  assert_int_equal(d.rigid_lost, 0);
  assert_true(d.safe);
}

static void what_is_not_there_cannot_be_removed(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  const cdem_element *element = cdem_element_find("hex8");
  make_grid(element, 1, 0.0, &mesh);
  cdem_material material = make_material(element);
  make_model(&mesh, &material, &model);
  cdem_removal removal = {.element = 4711, .class_ = -1, .form = -1};
  cdem_convert_options options = {0};
  cdem_depletion d;
  check_fails(cdem_network_deplete(&model, &options, &removal, 1, &d, &fault), CDEM_INPUT,
              "removal 1 matches no spring");
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_face_or_body_group_makes_a_cube_unstable),
      cmocka_unit_test(an_edge_group_loses_two_rotations),
      cmocka_unit_test(skew_appears_away_from_a_quarter),
      cmocka_unit_test(bigger_blocks_are_unstable_too),
      cmocka_unit_test(whole_elements_may_go),
      cmocka_unit_test(what_is_not_there_cannot_be_removed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
