/* A wall held by another solver: it moves as one in a store does, and its record carries it over.
 */
#include "dem/walls_store.h"
#include "walls_support.h"

static cdem_series sine(double amplitude, double frequency) {
  return (cdem_series){.kind = CDEM_SERIES_SINE, .amplitude = amplitude, .frequency = frequency};
}

static cdem_wall moving(void) {
  static double wanted = 40.0, zero = 0.0;
  cdem_wall wall = {.name = "press",
                    .shape = CDEM_WALL_PLATE,
                    .center = {1.0, 2.0, 3.0},
                    .normal = {0, 0, 1.0},
                    .axis = {1.0, 0, 0},
                    .half = {1.0, 2.0},
                    .velocity = {sine(0.3, 2.0), {0}, {0}},
                    .spin = {sine(1.0, 1.0), sine(0.4, 3.0), {0}},
                    .servo = {0, 0, 1.0},
                    .servo_speed = 0.5};
  wall.servo_force =
      (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 1, .time = &zero, .value = &wanted};
  return wall;
}

static void same_pose(const cdem_wall_body *a, const cdem_wall_body *b) {
  assert_memory_equal(a->center, b->center, sizeof a->center);
  assert_memory_equal(a->turn, b->turn, sizeof a->turn);
  assert_memory_equal(a->normal, b->normal, sizeof a->normal);
  assert_memory_equal(a->velocity, b->velocity, sizeof a->velocity);
  assert_memory_equal(a->spin, b->spin, sizeof a->spin);
}

static void alone_it_moves_as_in_a_store(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_wall wall = moving();
  const cdem_series other[3] = {{0}, sine(0.2, 1.0), {0}};
  cdem_wall_body body = {0};
  walled w;
  double moved, step = 0.01, record[CDEM_WALL_RECORD] = {0};
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  check_ok(cdem_wall_body_init(&body, 3, &wall, NULL, &fault));
  same_pose(&body, w.s.walls->body);
  for (int k = 0; k < 120; k++) {
    double force[6] = {1.0, 2.0, 35.0 + 0.1 * k, 4.0, 5.0, 6.0}, stiffness = k < 60 ? 1e3 : 0.0;
    if (k == 50) {
      cdem_walls_move(&w.s, 0, other, NULL);
      cdem_wall_body_move(&body, k * step, other, NULL);
    }
    if (k == 80) { /* goes on in another body, which is told the functions first */
      cdem_wall_body next = {0};
      check_ok(cdem_wall_body_init(&next, 3, &wall, NULL, &fault));
      cdem_wall_body_move(&next, 0.0, other, NULL);
      cdem_wall_body_record(&body, record, true);
      cdem_wall_body_record(&next, record, false);
      cdem_wall_place(&next, k * step);
      cdem_wall_body_release(&body);
      body = next;
      same_pose(&body, w.s.walls->body);
    }
    w.s.walls->time = k * step;
    const cdem_wall_loads loads = {.force = force, .stiffness = &stiffness};
    cdem_walls_advance(&w.s, k * step, step, &loads, &moved);
    cdem_wall_body_advance(&body, k * step, step, force, stiffness);
    same_pose(&body, w.s.walls->body);
  }
  assert_true(fabs(body.servo_path) > 0.1);
  assert_true(fabs(body.path[1]) > 0.01);
  cdem_wall_body_release(&body);
  walled_release(&w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(alone_it_moves_as_in_a_store),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
