/* Nodes beyond walls: depths, pushes, works. */
#include "contact_support.h"

static cdem_mesh mesh_of[2];
static cdem_skin skin_of[2]; /* a cube of 26 nodes, a ball of 38 */

static int make_skins(void **state) {
  (void)state;
  cdem_fault fault = {0};
  int32_t nodes[2] = {
      box_mesh(CDEM_SHAPE_HEX8, (int32_t[3]){2, 2, 2}, (double[3]){1.0, 1.0, 1.0}, 0.0, mesh_of),
      ball_mesh(3, mesh_of + 1)};
  for (int k = 0; k < 2; k++)
    check_ok(cdem_skin_build(mesh_of + k, nodes[k], 0.05, skin_of + k, &fault));
  return 0;
}

static int release_skins(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    cdem_skin_release(skin_of + k);
    cdem_mesh_release(mesh_of + k);
  }
  return 0;
}

static const cdem_fdem_contact_law law = {
    .penalty = 1e9, .shear_ratio = 0.5, .friction = 0.4, .damping_ratio = 0.3};

static void check_wall(const cdem_wall *wall, const double center[3], int nodes, double depth,
                       const double push[3]) {
  const cdem_skin *skins[1] = {skin_of};
  cdem_fault fault = {0};
  cdem_fdem_touch *touch;
  int64_t touches;
  double sum = 0.0;
  model m;
  model_make(&m, 1, skins, 0.02, law);
  memcpy(m.center, center, 3 * sizeof *center);
  model_wall(&m, wall);
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  check_ok(cdem_fdem_contacts_list(m.contacts, &m.view, &touches, &touch, &fault));
  assert_int_equal(touches, nodes);
  for (int64_t k = 0; k < touches; k++) {
    assert_int_equal(touch[k].partner, -1);
    check_near(touch[k].depth, depth, 1e-10, 0.0);
    check_near(touch[k].push, 1e9 * m.area[touch[k].node] * depth, 1e-10, 0.0);
    for (int c = 0; c < 3; c++) {
      check_near(touch[k].normal[c], -push[c], 0.0, 1e-14);
      check_near(touch[k].force[c], push[c] * touch[k].push, 0.0, 1e-14 * touch[k].push);
    }
    sum += touch[k].push;
  }
  for (int c = 0; c < 3; c++)
    check_near(m.wall_force[0][c], -push[c] * sum, 1e-14, 1e-14 * sum);
  int32_t count;
  cdem_fdem_contacts_count(m.contacts, &m.view, &count);
  assert_int_equal(count, nodes > 0);
  free(touch);
  model_release(&m);
}

static void walls_push_nodes_back(void **state) {
  (void)state;
  const double up[3] = {0.0, 0.0, 1.0}, down[3] = {0.0, 0.0, -1.0};
  cdem_wall plane = {.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 2.0}};
  check_wall(&plane, (double[3]){5.0, 1.0, 0.0098}, 9, 2e-4, up);
  check_wall(&plane, (double[3]){5.0, 1.0, 0.0101}, 0, 0.0, up);
  cdem_wall plate = {.name = "plate",
                     .shape = CDEM_WALL_PLATE,
                     .normal = {0, 0, 1.0},
                     .axis = {1.0, 0, 0},
                     .half = {0.05, 0.05}};
  check_wall(&plate, (double[3]){0.0, 0.0, 0.0098}, 9, 2e-4, up);
  check_wall(&plate, (double[3]){0.0, 0.0, -0.0098}, 9, 2e-4, down);
  check_wall(&plate, (double[3]){0.045, 0.0, -0.0098}, 6, 2e-4, down); /* two rows of three */
  check_wall(&plate, (double[3]){0.062, 0.0, -0.0098}, 0, 0.0, down);
}

static void tubes_push_along_their_radius(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) { /* inside, outside, thin and short */
    const cdem_skin *skins[1] = {skin_of + 1};
    cdem_wall tube = {.name = "tube",
                      .shape = CDEM_WALL_CYLINDER,
                      .axis = {0, 0, 1.0},
                      .radius = 0.1,
                      .outside = kind == 1,
                      .half = {kind == 2 ? 0.3 : 0.0}};
    double inside = kind == 1 ? -1.0 : 1.0, pushed = 0.0;
    cdem_fault fault = {0};
    cdem_fdem_touch *touch;
    int64_t touches;
    model m;
    model_make(&m, 1, skins, 0.02, law);
    m.center[0] = kind == 1 ? 0.119 : 0.081;
    m.center[2] = kind == 2 ? 0.29 : 0.0;
    model_wall(&m, &tube);
    model_start(&m, 0.0, 1);
    model_forces(&m, 0.0);
    check_ok(cdem_fdem_contacts_list(m.contacts, &m.view, &touches, &touch, &fault));
    assert_true(touches > 0);
    for (int64_t k = 0; k < touches; k++) {
      double rho = hypot(touch[k].point[0], touch[k].point[1]);
      check_near(touch[k].depth, inside * (rho - 0.1), 1e-11, 1e-16);
      check_near(touch[k].normal[0], inside * touch[k].point[0] / rho, 1e-13, 0.0);
      check_near(touch[k].normal[1], inside * touch[k].point[1] / rho, 0.0, 1e-13);
      assert_true(kind < 2 || touch[k].point[2] <= 0.3);
      pushed += touch[k].push;
    }
    assert_true(pushed > 0.0);
    free(touch);
    model_release(&m);
  }
}

/* A floor that rises v dt a step into a cube that is held: its work is what the springs get. */
static void walls_do_work(void **state) {
  (void)state;
  const cdem_skin *skins[1] = {skin_of};
  cdem_fault fault = {0};
  cdem_series rise, along;
  model m;
  model_make(&m, 1, skins, 0.02, law);
  m.center[2] = 0.01;
  check_ok(cdem_series_constant(0.1, &rise, &fault));
  check_ok(cdem_series_constant(0.02, &along, &fault));
  model_wall(&m, &(cdem_wall){.name = "floor",
                              .shape = CDEM_WALL_PLANE,
                              .normal = {0, 0, 1.0},
                              .velocity = {along, {0}, rise}});
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  for (int step = 0; step < 100; step++) {
    drift(&m, 1e-5);
    model_forces(&m, 1e-5);
  }
  double held = m.book.normal + m.book.shear, lost = m.sum.friction + m.sum.damping;
  assert_true(m.book.normal > 0.0 && m.book.shear > 0.0 && m.sum.damping > 0.0);
  check_near(m.sum.walls, held + lost, 1e-9, 0.0);
  cdem_series_release(&rise);
  cdem_series_release(&along);
  model_release(&m);
}

/* A floor that is taken away takes with it what its springs hold. */
static void a_wall_that_goes_takes_its_springs(void **state) {
  (void)state;
  const cdem_skin *skins[1] = {skin_of};
  model m;
  model_make(&m, 1, skins, 0.02, law);
  m.center[2] = 0.0099;
  model_wall(&m,
             &(cdem_wall){
                 .name = "gate", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1.0}, .stop = 1.5e-5});
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  m.velocity[0] = 0.1;
  drift(&m, 1e-5);
  model_forces(&m, 1e-5);
  double held = m.book.normal + m.book.shear;
  assert_true(m.book.normal > 0.0 && m.book.shear > 0.0 && m.sum.walls == 0.0);
  drift(&m, 1e-5);
  model_forces(&m, 1e-5);
  assert_true(m.book.normal == 0.0 && m.book.shear == 0.0 && m.wall_force[0][2] == 0.0);
  check_near(m.sum.walls, -held, 1e-13, 0.0);
  model_release(&m);
}

/* A node in a corner of two walls is pushed by the one it is deeper in. */
static void the_deeper_of_two_walls_acts(void **state) {
  (void)state;
  const cdem_skin *skins[1] = {skin_of};
  cdem_fault fault = {0};
  cdem_fdem_touch *touch;
  int64_t touches, in_both = 0;
  model m;
  model_make(&m, 1, skins, 0.02, law);
  m.center[0] = 0.0098;
  m.center[2] = 0.0099;
  model_wall(&m, &(cdem_wall){.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1.0}});
  model_wall(&m, &(cdem_wall){.name = "side", .shape = CDEM_WALL_PLANE, .normal = {1.0, 0, 0}});
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  check_ok(cdem_fdem_contacts_list(m.contacts, &m.view, &touches, &touch, &fault));
  assert_int_equal(touches, 15); /* 9 at the side, 6 more at the floor */
  for (int64_t k = 0; k < touches; k++) {
    bool side = touch[k].point[0] < 0.0;
    in_both += side && touch[k].point[2] < 0.0;
    assert_int_equal(touch[k].partner, side ? -2 : -1);
    check_near(touch[k].depth, side ? 2e-4 : 1e-4, 1e-11, 0.0);
  }
  assert_int_equal(in_both, 3);
  int32_t count;
  cdem_fdem_contacts_count(m.contacts, &m.view, &count);
  assert_int_equal(count, 2);
  free(touch);
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(walls_push_nodes_back),
      cmocka_unit_test(tubes_push_along_their_radius),
      cmocka_unit_test(walls_do_work),
      cmocka_unit_test(a_wall_that_goes_takes_its_springs),
      cmocka_unit_test(the_deeper_of_two_walls_acts),
  };
  return cmocka_run_group_tests(tests, make_skins, release_skins);
}
