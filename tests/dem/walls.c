/* Shapes of walls against closed forms; what cannot be a wall; candidates against brute force. */
#include "walls_support.h"

/* Rounding of a few operations on numbers of size 1. */
static const double tight = 4e-15;

static void a_plane_is_one_sided(void **state) {
  (void)state;
  cdem_wall wall = {.name = "floor",
                    .shape = CDEM_WALL_PLANE,
                    .center = {1.0, 2.0, 3.0},
                    .normal = {0, 3.0, 4.0}};
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled_make(&w, 3, 1, 1, &wall);
  /* 0.9 above, and 0.2 below: still pushed the same way */
  for (int below = 0; below < 2; below++) {
    double h = below ? -0.2 : 0.9;
    assert_int_equal(walled_touch(&w, 7.0, 2.0 + 0.6 * h, 3.0 + 0.8 * h, 1.0, t), 1);
    check_near(t[0].overlap, 1.0 - h, 0.0, tight);
    check_vector(t[0].n, 0.0, -0.6, -0.8, tight);
    check_vector(t[0].point, 7.0, 2.0, 3.0, tight);
  }
  assert_int_equal(walled_touch(&w, 7.0, 2.0 + 0.6 * 1.01, 3.0 + 0.8 * 1.01, 1.0, t), 0);
  walled_release(&w);
}

static void a_plate_acts_by_faces_edges_and_corners(void **state) {
  (void)state;
  cdem_wall wall = {.name = "plate",
                    .shape = CDEM_WALL_PLATE,
                    .center = {1.0, 0.0, 0.0},
                    .normal = {0.0, 0.0, 2.0},
                    .axis = {1.0, 0.0, 0.0},
                    .half = {2.0, 3.0}};
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, 0.0, 1.0, 0.75, 1.0, t), 1);
  check_vector(t[0].n, 0.0, 0.0, -1.0, 0.0);
  check_near(t[0].overlap, 0.25, 0.0, 0.0);
  assert_int_equal(walled_touch(&w, 0.0, 1.0, -0.75, 1.0, t), 1);
  check_vector(t[0].n, 0.0, 0.0, 1.0, 0.0);
  /* edge x = 3: 0.3 out, 0.4 up; the other edge y = -3 */
  assert_int_equal(walled_touch(&w, 3.3, 1.0, 0.4, 1.0, t), 1);
  check_near(t[0].overlap, 0.5, 0.0, tight);
  check_vector(t[0].n, -0.6, 0.0, -0.8, tight);
  check_vector(t[0].point, 3.0, 1.0, 0.0, tight);
  assert_int_equal(walled_touch(&w, 1.0, -3.3, 0.4, 1.0, t), 1);
  check_vector(t[0].point, 1.0, -3.0, 0.0, tight);
  /* corner (3, 3, 0): 2/7, 3/7, 6/7 of 0.7 */
  assert_int_equal(walled_touch(&w, 3.2, 3.3, 0.6, 1.0, t), 1);
  check_near(t[0].overlap, 0.3, 0.0, tight);
  check_vector(t[0].n, -2.0 / 7, -3.0 / 7, -6.0 / 7, tight);
  assert_int_equal(walled_touch(&w, 3.7, 3.7, 0.6, 1.0, t), 0);
  walled_release(&w);
}

static void a_segment_acts_by_its_ends(void **state) {
  (void)state;
  cdem_wall wall = {.name = "blade",
                    .shape = CDEM_WALL_PLATE,
                    .center = {0.0, 1.0, 0.0},
                    .normal = {1.0, 0.0, 0.0},
                    .half = {2.0}};
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled_make(&w, 2, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, -0.5, 0.0, 0.0, 1.0, t), 1);
  check_vector(t[0].n, 1.0, 0.0, 0.0, 0.0);
  check_near(t[0].overlap, 0.5, 0.0, 0.0);
  assert_int_equal(walled_touch(&w, 0.4, 3.3, 0.0, 1.0, t), 1);
  check_vector(t[0].n, -0.8, -0.6, 0.0, tight);
  check_vector(t[0].point, 0.0, 3.0, 0.0, tight);
  check_near(t[0].overlap, 0.5, 0.0, tight);
  walled_release(&w);
}

static void a_cylinder_curves(void **state) {
  (void)state;
  cdem_wall wall = {
      .name = "drum", .shape = CDEM_WALL_CYLINDER, .axis = {0.0, 0.0, 5.0}, .radius = 4.0};
  cdem_wall roller = wall;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled w;
  roller.outside = true;
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, 0.6 * 3.25, 0.8 * 3.25, 100.0, 1.0, t), 1);
  check_near(t[0].overlap, 0.25, 0.0, tight);
  check_vector(t[0].n, 0.6, 0.8, 0.0, tight);
  check_vector(t[0].point, 2.4, 3.2, 100.0, 4 * tight);
  /* beyond the wall it is pushed back in */
  assert_int_equal(walled_touch(&w, 4.5, 0.0, 0.0, 1.0, t), 1);
  check_near(t[0].overlap, 1.5, 0.0, tight);
  check_vector(t[0].n, 1.0, 0.0, 0.0, tight);
  assert_int_equal(walled_touch(&w, 0.0, 0.0, 0.0, 1.0, t), 0);
  walled_release(&w);
  walled_make(&w, 3, 1, 1, &roller);
  assert_int_equal(walled_touch(&w, 0.6 * 4.75, 0.8 * 4.75, 1.0, 1.0, t), 1);
  check_near(t[0].overlap, 0.25, 0.0, tight);
  check_vector(t[0].n, -0.6, -0.8, 0.0, tight);
  walled_release(&w);
  walled_make(&w, 2, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, 0.0, -3.5, 0.0, 1.0, t), 1);
  check_vector(t[0].n, 0.0, -1.0, 0.0, tight);
  walled_release(&w);
}

static void a_tube_is_open_and_has_rims(void **state) {
  (void)state;
  cdem_wall wall = {.name = "tube",
                    .shape = CDEM_WALL_CYLINDER,
                    .axis = {1.0, 0.0, 0.0},
                    .radius = 2.0,
                    .half = {5.0}};
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled w;
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, 4.0, 1.5, 0.0, 1.0, t), 1); /* inside */
  check_vector(t[0].n, 0.0, 1.0, 0.0, tight);
  assert_int_equal(walled_touch(&w, 4.0, 2.5, 0.0, 1.0, t),
                   1); /* a grain that left, from outside */
  check_vector(t[0].n, 0.0, -1.0, 0.0, tight);
  check_near(t[0].overlap, 0.5, 0.0, tight);
  assert_int_equal(walled_touch(&w, 5.3, 1.6, 0.0, 1.0, t), 1); /* rim */
  check_vector(t[0].n, -0.6, 0.8, 0.0, tight);
  check_vector(t[0].point, 5.0, 2.0, 0.0, tight);
  check_near(t[0].overlap, 0.5, 0.0, tight);
  assert_int_equal(walled_touch(&w, -5.3, 0.0, -2.4, 1.0, t), 1); /* the other rim, from outside */
  check_vector(t[0].n, 0.6, 0.0, 0.8, tight);
  assert_int_equal(walled_touch(&w, 5.3, 0.0, 0.0, 1.0, t), 0); /* open */
  walled_release(&w);
}

/* ---- candidates ---- */

static void random_wall(cdem_random *random, cdem_wall *wall) {
  static const cdem_wall_shape shapes[3] = {CDEM_WALL_PLANE, CDEM_WALL_PLATE, CDEM_WALL_CYLINDER};
  memset(wall, 0, sizeof *wall);
  wall->name = "any";
  wall->shape = shapes[(int)cdem_random_uniform(random, 0.0, 2.999)];
  for (int c = 0; c < 3; c++) {
    wall->center[c] = cdem_random_uniform(random, -5.0, 5.0);
    wall->normal[c] = cdem_random_uniform(random, -1.0, 1.0);
  }
  double other[3] = {0.3, -0.2, 0.9};
  cdem_cross3(wall->normal, other, wall->axis);
  wall->half[0] = cdem_random_uniform(random, 0.5, 4.0);
  wall->half[1] = cdem_random_uniform(random, 0.5, 4.0);
  wall->radius = cdem_random_uniform(random, 0.5, 8.0);
  wall->outside = cdem_random_uniform(random, 0.0, 1.0) > 0.5;
}

/* The distance by looking at many points of the shape would be blunt; instead the law that holds
 * for any shape: moving a grain to its wall's point leaves no distance, and the candidates are
 * those grains whose touch appears when their radius grows by the skin. */
static void candidates_are_all_grains_near_a_wall(void **state) {
  (void)state;
  enum { GRAINS = 60, WALLS = 5 };
  cdem_random random = {7};
  for (int trial = 0; trial < 20; trial++) {
    cdem_wall wall[WALLS];
    walled w, one;
    cdem_wall_touch t[CDEM_WALL_TOUCHES];
    for (int k = 0; k < WALLS; k++)
      random_wall(&random, wall + k);
    walled_make(&w, 3, GRAINS, WALLS, wall);
    for (int i = 0; i < GRAINS; i++)
      walled_place(&w, i, cdem_random_uniform(&random, -6, 6), cdem_random_uniform(&random, -6, 6),
                   cdem_random_uniform(&random, -6, 6), cdem_random_uniform(&random, 0.1, 1.0));
    walled_build(&w);
    const int32_t *row = cdem_walls_rows(&w.s);
    for (int i = 0; i < GRAINS; i++) {
      const double *x = cdem_place(&w.s, i);
      int near = 0, touching = 0;
      for (int k = 0; k < WALLS; k++) {
        walled_make(&one, 3, 1, 1, wall + k);
        one.s.skin = 100.0;
        near += walled_touch(&one, x[0], x[1], x[2], x[3] + 0.5 * w.s.skin, t);
        touching += walled_touch(&one, x[0], x[1], x[2], x[3], t);
        walled_release(&one);
      }
      assert_int_equal(row[i + 1] - row[i], near);
      assert_int_equal(cdem_walls_find(&w.s, i, t), touching);
      for (int k = 1; k < touching; k++)
        assert_true(t[k].wall > t[k - 1].wall);
    }
    walled_release(&w);
  }
}

/* ---- histories ---- */

static void a_history_lasts_while_the_contact_does(void **state) {
  (void)state;
  cdem_wall wall = {.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0.0, 0.0, 1.0}};
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled w;
  bool fresh;
  walled_make(&w, 3, 3, 1, &wall);
  for (int i = 0; i < 3; i++)
    walled_place(&w, i, 3.0 * i, 0.0, 0.9, 1.0);
  walled_build(&w);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(cdem_walls_find(&w.s, i, t), 1);
    double *h = cdem_walls_history(&w.s, t, &fresh);
    assert_true(fresh);
    for (int k = 0; k < 3; k++) {
      assert_true(h[k] == 0.0);
      h[k] = 10.0 * i + k;
    }
    cdem_walls_history(&w.s, t, &fresh);
    assert_false(fresh);
  }
  /* the grains are sorted anew: 2 0 1 */
  int32_t order[3] = {2, 0, 1};
  for (int i = 0; i < 3; i++) {
    w.s.id[i] = order[i];
    w.s.slot[order[i]] = i;
    walled_place(&w, i, 3.0 * order[i], 0.0, 0.9, 1.0);
  }
  walled_build(&w);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(cdem_walls_find(&w.s, i, t), 1);
    double *h = cdem_walls_history(&w.s, t, &fresh);
    assert_false(fresh);
    assert_true(h[1] == 10.0 * order[i] + 1.0);
  }
  /* parted for one step: forgotten */
  walled_place(&w, 0, 6.0, 0.0, 1.05, 1.0);
  assert_int_equal(cdem_walls_find(&w.s, 0, t), 0);
  walled_place(&w, 0, 6.0, 0.0, 0.9, 1.0);
  assert_int_equal(cdem_walls_find(&w.s, 0, t), 1);
  assert_true(cdem_walls_history(&w.s, t, &fresh)[1] == 0.0);
  assert_true(fresh);
  walled_release(&w);
}

/* ---- scaling ---- */

static void scaled_by_a_power_of_two_gives_scaled_bits(void **state) {
  (void)state;
  const double f = 0x1p-13;
  cdem_random random = {7};
  for (int trial = 0; trial < 200; trial++) {
    cdem_wall wall, scaled;
    walled w, v;
    cdem_wall_touch a[CDEM_WALL_TOUCHES], b[CDEM_WALL_TOUCHES];
    double x[3];
    random_wall(&random, &wall);
    scaled = wall;
    scaled.radius *= f;
    for (int c = 0; c < 3; c++) {
      x[c] = cdem_random_uniform(&random, -3.0, 3.0);
      scaled.center[c] *= f;
      if (c < 2)
        scaled.half[c] *= f;
    }
    walled_make(&w, 3, 1, 1, &wall);
    walled_make(&v, 3, 1, 1, &scaled);
    v.s.skin *= f;
    int count = walled_touch(&w, x[0], x[1], x[2], 1.5, a);
    assert_int_equal(walled_touch(&v, f * x[0], f * x[1], f * x[2], 1.5 * f, b), count);
    if (count == 1) {
      assert_true(b[0].overlap == f * a[0].overlap);
      assert_memory_equal(a[0].n, b[0].n, sizeof a[0].n);
    }
    walled_release(&w);
    walled_release(&v);
  }
}

/* ---- errors ---- */

static void what_cannot_be_a_wall_is_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const cdem_wall plane = {.name = "a", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}};
  const cdem_wall plate = {.name = "b",
                           .shape = CDEM_WALL_PLATE,
                           .normal = {0, 0, 1},
                           .axis = {1, 0, 0},
                           .half = {1, 1}};
  const cdem_wall tube = {
      .name = "c", .shape = CDEM_WALL_CYLINDER, .axis = {0, 0, 1}, .radius = 1.0};
  cdem_wall bad;
  check_ok(cdem_wall_check(3, &plane, &fault));
  check_ok(cdem_wall_check(3, &plate, &fault));
  check_ok(cdem_wall_check(3, &tube, &fault));
  bad = plane, bad.normal[2] = 0.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "wall 'a': the normal (0, 0, 0)");
  bad = plane, bad.center[1] = NAN;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "is not finite");
  check_fails(cdem_wall_check(2, &plane, &fault), CDEM_INPUT, "leaves the plane z = 0");
  bad = plane, bad.start = 2.0, bad.stop = 1.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "stops at 1 s, not after its start");
  bad = plane, bad.servo[0] = 1.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "the speed of its servo is 0 m/s");
  bad.servo_speed = 1.0, bad.servo_gain = 1.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "the gain of its servo is 1;");
  bad = plane, bad.material = -1;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "no material");
  bad = plane, bad.shape = (cdem_wall_shape)17;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "17 is no shape");
  bad = plate, bad.half[1] = 0.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "half length 2 of a plate is 0 m");
  bad = plate, bad.axis[2] = 1.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "leans on its normal");
  bad = plate, bad.axis[0] = 0.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "the axis (0, 0, 0) of a plate");
  bad = tube, bad.radius = -1.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "the radius of a cylinder is -1 m");
  bad = tube, bad.axis[2] = 0.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "axis (0, 0, 0) of a cylinder");
  bad = tube, bad.half[0] = -2.0;
  check_fails(cdem_wall_check(3, &bad, &fault), CDEM_INPUT, "half length of a cylinder is -2 m");
}

static void grains_beyond_walls_are_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_wall wall[3] = {
      {.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}},
      {.name = "drum", .shape = CDEM_WALL_CYLINDER, .axis = {0, 0, 1}, .radius = 5.0},
      {.name = "core",
       .shape = CDEM_WALL_CYLINDER,
       .axis = {0, 0, 1},
       .radius = 1.0,
       .half = {3.0},
       .outside = true}};
  walled w;
  walled_make(&w, 3, 3, 3, wall);
  walled_place(&w, 0, 2.0, 0.0, 0.5, 1.0); /* overlaps, but is on the right side of all */
  walled_place(&w, 1, 0.0, 0.0, 4.0, 0.1); /* above the core */
  walled_place(&w, 2, 3.0, 0.0, 1.0, 1.0);
  check_ok(cdem_walls_check(&w.s, &fault));
  walled_place(&w, 0, 2.0, 0.0, -0.5, 1.0);
  check_fails(cdem_walls_check(&w.s, &fault), CDEM_INPUT,
              "grain 0 at (2, 0, -0.5) m has its centre 0.5 m beyond wall 'floor' (plane)");
  walled_place(&w, 2, 0.0, 7.0, 1.0, 1.0);
  check_fails(cdem_walls_check(&w.s, &fault), CDEM_INPUT,
              "2 m beyond wall 'drum' (cylinder), and 2");
  walled_place(&w, 0, 2.0, 0.0, 0.5, 1.0);
  walled_place(&w, 2, 0.25, 0.0, 1.0, 1.0);
  check_fails(cdem_walls_check(&w.s, &fault), CDEM_INPUT, "grain 2");
  walled_release(&w);
  /* a wall that is not there yet holds nobody */
  wall[0].start = 1.0;
  walled_make(&w, 3, 1, 1, wall);
  walled_place(&w, 0, 0.0, 0.0, -1.0, 0.5);
  check_ok(cdem_walls_check(&w.s, &fault));
  walled_release(&w);
}

static void every_failed_allocation_leaves_nothing(void **state) {
  (void)state;
  cdem_wall wall[2] = {{.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}},
                       {.name = "mesh", .shape = CDEM_WALL_MESH}};
  const double corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const int32_t facet[3] = {0, 1, 2};
  wall[1].corners = 3, wall[1].corner = corner, wall[1].facets = 1, wall[1].facet = facet;
  walled w;
  walled_make(&w, 3, 1, 2, wall);
  cdem_walls_release(&w.s);
  bool done = false;
  for (int64_t k = 0; !done; k++) {
    cdem_fault fault = {0};
    assert_true(k < 100);
    cdem_memory_fail_after(k);
    cdem_status status = cdem_walls_init(&w.s, &fault);
    if (status == CDEM_OK)
      status = cdem_walls_build(&w.s, &fault);
    cdem_memory_fail_after(-1);
    done = status == CDEM_OK;
    if (!done)
      assert_int_equal(status, CDEM_MEMORY);
    cdem_walls_release(&w.s);
    assert_null(w.s.walls);
  }
  walled_release(&w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_plane_is_one_sided),
      cmocka_unit_test(a_plate_acts_by_faces_edges_and_corners),
      cmocka_unit_test(a_segment_acts_by_its_ends),
      cmocka_unit_test(a_cylinder_curves),
      cmocka_unit_test(a_tube_is_open_and_has_rims),
      cmocka_unit_test(candidates_are_all_grains_near_a_wall),
      cmocka_unit_test(a_history_lasts_while_the_contact_does),
      cmocka_unit_test(scaled_by_a_power_of_two_gives_scaled_bits),
      cmocka_unit_test(what_cannot_be_a_wall_is_named),
      cmocka_unit_test(grains_beyond_walls_are_named),
      cmocka_unit_test(every_failed_allocation_leaves_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
