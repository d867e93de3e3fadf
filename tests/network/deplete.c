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
  cdem_depletion_options out = {.removals = 1, .removal = &removal, .mode_rows = 30000};
  check_ok(cdem_network_deplete(&model, &options, &out, depletion, &fault));
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

/* A spring meets the elongation of dir on one node and of dual on the other: at nu = 1/4, where
 * every isotropic block is symmetric (lambda = mu) and they agree, one rotation is lost, elsewhere
 * two. A whole pair turns freely about its own line and takes two. Cosserat pairs are rigidly
 * transported: none. Distorted bodies, where nothing is zero by symmetry. */
static void rotations_are_counted_in_distorted_bodies(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const struct {
    const char *kind;
    double nu;
    int spring, lost;
  } row[] = {{"hex8", 0.25, 1, 1}, {"hex8", 0.23, 1, 2},          {"hex8", 0.25, 0, 2},
             {"hex8", 0.23, 0, 2}, {"tet4", 0.25, 1, 1},          {"tet4", 0.3, 1, 2},
             {"tet4", 0.3, 0, 2},  {"quad4-cosserat", 0.3, 1, 0}, {"quad4", 0.3, 0, 1},
             {"wedge6", 0.3, 0, 2}};
  for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
    const cdem_element *element = cdem_element_find(row[i].kind);
    cdem_mesh mesh = {0};
    cdem_model model = {0};
    make_grid(element, 2, 0.2, &mesh);
    cdem_material material = make_material(element);
    material.parameter[1] = row[i].nu;
    make_model(&mesh, &material, &model);
    const int32_t *node = cdem_mesh_cell(&mesh, model.cell[0]);
    cdem_removal removal = {.element = mesh.cell_tag[model.cell[0]],
                            .node = {mesh.node_tag[node[0]], mesh.node_tag[node[1]]},
                            .class_ = -1,
                            .form = -1,
                            .spring = row[i].spring};
    cdem_depletion_options out = {.removals = 1, .removal = &removal, .mode_rows = 30000};
    cdem_convert_options options = {.frame = CDEM_FRAME_BODY};
    cdem_depletion d;
    check_ok(cdem_network_deplete(&model, &options, &out, &d, &fault));
    assert_int_equal(d.springs, row[i].spring > 0 ? 1 : model.dofs);
    if (d.rigid_lost != row[i].lost)
      fail_msg("%s at %g, spring %d: %d rotations lost, expected %d", row[i].kind, row[i].nu,
               row[i].spring, d.rigid_lost, row[i].lost);
    cdem_model_release(&model);
    cdem_mesh_release(&mesh);
  }
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
  cdem_removal removal = {.text = "element=4711", .element = 4711, .class_ = -1, .form = -1};
  cdem_depletion_options out = {.removals = 1, .removal = &removal, .mode_rows = 30000};
  cdem_convert_options options = {0};
  cdem_depletion d;
  check_fails(cdem_network_deplete(&model, &options, &out, &d, &fault), CDEM_INPUT,
              "'element=4711' matches no spring");
  out.mode_rows = 23;
  check_fails(cdem_network_deplete(&model, &options, &out, &d, &fault), CDEM_INPUT,
              "a matrix of 24 rows, more than the 23 allowed");
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
      cmocka_unit_test(rotations_are_counted_in_distorted_bodies),
      cmocka_unit_test(what_is_not_there_cannot_be_removed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
