/* Walls that move: paths, rotations, servos, gates; saving and restoring to the bit. */
#include "dem/walls_store.h"
#include "walls_support.h"

static cdem_series constant(double *value) {
  static double zero = 0.0;
  return (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 1, .time = &zero, .value = value};
}

static void advance(walled *w, double dt, int steps) {
  double moved;
  for (int i = 0; i < steps; i++)
    cdem_walls_advance(&w->s, w->s.walls->time, dt, NULL, &moved);
}

/* ---- paths ---- */

static void the_path_is_the_integral_of_the_velocity(void **state) {
  (void)state;
  cdem_wall wall = {.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}};
  wall.velocity[2] = (cdem_series){.kind = CDEM_SERIES_PULSE, .amplitude = 3.0, .duration = 0.7};
  wall.velocity[0] =
      (cdem_series){.kind = CDEM_SERIES_SINE, .amplitude = 2.0, .frequency = 1.3, .phase = 0.4};
  walled w;
  cdem_dem_wall now;
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  advance(&w, 0.001, 600);
  cdem_walls_now(&w.s, 0, &now);
  double time = w.s.walls->time;
  check_near(now.moved[2], cdem_series_integral(&wall.velocity[2], time), 1e-15, 0.0);
  check_near(now.moved[0], cdem_series_integral(&wall.velocity[0], time), 1e-15, 0.0);
  check_near(now.velocity[2], cdem_series_at(&wall.velocity[2], time - 0.0005), 1e-12, 0.0);
  assert_true(now.moved[1] == 0.0);
  walled_release(&w);
}

static void a_drum_has_the_speed_of_its_surface(void **state) {
  (void)state;
  double rate = 2.5, t0 = 0.3;
  cdem_wall wall = {.name = "drum",
                    .shape = CDEM_WALL_CYLINDER,
                    .center = {1.0, 0.0, 0.0},
                    .axis = {0.0, 1.0, 0.0},
                    .radius = 4.0,
                    .spin = {{0}, constant(&rate), {0}}};
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  double moved;
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  for (int i = 0; i < 100; i++)
    cdem_walls_advance(&w.s, i * t0, t0, NULL, &moved);
  check_below(moved, 1e-13); /* no reason to search anew */
  for (double a = 0.0; a < 6.0; a += 0.5) {
    assert_int_equal(walled_touch(&w, 1.0 + 3.25 * cos(a), 9.0, 3.25 * sin(a), 1.0, t), 1);
    check_near(t[0].overlap, 0.25, 0.0, 1e-14);
    check_near(cdem_norm3(t[0].velocity), rate * 4.0, 1e-14, 0.0);
    check_near(cdem_dot3(t[0].velocity, t[0].n), 0.0, 0.0, 1e-13);
    /* w e_y x e_x = -w e_z */
    check_near(t[0].velocity[2], -rate * 4.0 * cos(a), 0.0, 1e-13);
    check_vector(t[0].spin, 0.0, rate, 0.0, 0.0);
  }
  walled_release(&w);
}

/* Rodrigues' formula. */
static void rotated(const double axis[3], double angle, const double v[3], double out[3]) {
  double cross[3], along = cdem_dot3(axis, v);
  cdem_cross3(axis, v, cross);
  for (int c = 0; c < 3; c++)
    out[c] = v[c] * cos(angle) + cross[c] * sin(angle) + axis[c] * along * (1.0 - cos(angle));
}

static void a_spin_about_one_direction_is_exact(void **state) {
  (void)state;
  double rate[3] = {0.6, -1.2, 1.2}, unit[3] = {1.0 / 3, -2.0 / 3, 2.0 / 3}, e[3];
  cdem_wall wall = {.name = "plate",
                    .shape = CDEM_WALL_PLATE,
                    .center = {5.0, 6.0, 7.0},
                    .normal = {0, 0, 1},
                    .axis = {1, 0, 0},
                    .half = {1, 2}};
  const double x[3] = {1, 0, 0}, z[3] = {0, 0, 1};
  walled w;
  for (int c = 0; c < 3; c++)
    wall.spin[c] = constant(rate + c);
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  advance(&w, 0.01, 1000);
  rotated(unit, 1.8 * w.s.walls->time, z, e);
  check_vector(w.s.walls->body->normal, e[0], e[1], e[2], 1e-14);
  rotated(unit, 1.8 * w.s.walls->time, x, e);
  check_vector(w.s.walls->body->axis, e[0], e[1], e[2], 1e-14);
  walled_release(&w);
  /* one component, any function: the angle is its integral */
  wall.spin[0] = wall.spin[1] = (cdem_series){0};
  wall.spin[2] = (cdem_series){.kind = CDEM_SERIES_SINE, .amplitude = 9.0, .frequency = 2.0};
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  advance(&w, 0.01, 1030);
  double angle = cdem_series_integral(&wall.spin[2], w.s.walls->time);
  check_vector(w.s.walls->body->axis, cos(angle), sin(angle), 0.0, 1e-14);
  walled_release(&w);
}

/* A top: w = rotation about z at `rate` of a vector. Seen from the turning frame it is constant, so
 * the exact turn is exp(rate t z) exp((w0 - rate z) t). */
static double tumbling_error(int steps) {
  const double rate = 1.5, z[3] = {0, 0, 1}, end = 2.0;
  const double total = sqrt(1.2 * 1.2 + 1.1 * 1.1), inner[3] = {1.2 / total, 0, -1.1 / total};
  double spin_z = 0.4, v[3], once[3], twice[3];
  cdem_wall wall = {.name = "top", .shape = CDEM_WALL_PLANE, .normal = {0.6, 0.0, 0.8}};
  const double frequency = rate / (2 * M_PI);
  wall.spin[0] = (cdem_series){
      .kind = CDEM_SERIES_SINE, .amplitude = 1.2, .frequency = frequency, .phase = M_PI / 2};
  wall.spin[1] = (cdem_series){.kind = CDEM_SERIES_SINE, .amplitude = 1.2, .frequency = frequency};
  wall.spin[2] = constant(&spin_z);
  walled w;
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  advance(&w, end / steps, steps);
  rotated(inner, total * end, wall.normal, once);
  rotated(z, rate * end, once, twice);
  for (int c = 0; c < 3; c++)
    v[c] = w.s.walls->body->normal[c] - twice[c];
  check_near(cdem_norm3(w.s.walls->body->normal), 1.0, 1e-15, 0.0);
  walled_release(&w);
  return cdem_norm3(v);
}

static void any_spin_is_of_second_order(void **state) {
  (void)state;
  double coarse = tumbling_error(100), fine = tumbling_error(200), finest = tumbling_error(400);
  check_near(coarse / fine, 4.0, 0.02, 0.0);
  check_near(fine / finest, 4.0, 0.02, 0.0);
  check_below(finest, 1e-5);
}

static void turned_walls_stay_at_right_angles(void **state) {
  (void)state;
  cdem_wall wall = {.name = "top", .shape = CDEM_WALL_PLANE, .normal = {0.0, 0.0, 1.0}};
  for (int c = 0; c < 3; c++)
    wall.spin[c] = (cdem_series){
        .kind = CDEM_SERIES_SINE, .offset = 30.0, .amplitude = 90.0 * c, .frequency = 1.0 + c};
  walled w;
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  advance(&w, 0.003, 30000);
  const double *m = w.s.walls->body->turn;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      check_near(cdem_dot3(m + 3 * i, m + 3 * j), i == j, 0.0, 2e-15);
  walled_release(&w);
}

/* A material point of the wall moves by velocity times step, to first order in the step. */
static void velocities_are_those_of_the_points(void **state) {
  (void)state;
  double rate[3] = {0.6, -1.2, 1.3};
  cdem_wall wall = {.name = "plate",
                    .shape = CDEM_WALL_PLATE,
                    .normal = {0, 0, 1},
                    .axis = {1, 0, 0},
                    .half = {3, 3}};
  for (int c = 0; c < 3; c++) {
    wall.spin[c] = constant(rate + c);
    wall.velocity[c] = constant(rate + (c + 1) % 3);
  }
  const double local[3] = {1.5, -2.0, 0.0}, dt = 1e-6;
  double before[3], after[3];
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  advance(&w, 0.01, 77);
  const cdem_wall_body *body = w.s.walls->body;
  cdem_wall_turned(body->turn, local, before);
  for (int c = 0; c < 3; c++)
    before[c] += body->center[c];
  advance(&w, dt, 1);
  cdem_wall_turned(body->turn, local, after);
  for (int c = 0; c < 3; c++)
    after[c] += body->center[c];
  const double *n = body->normal;
  assert_int_equal(
      walled_touch(&w, after[0] + 0.5 * n[0], after[1] + 0.5 * n[1], after[2] + 0.5 * n[2], 1.0, t),
      1);
  for (int c = 0; c < 3; c++) {
    check_near(t[0].point[c], after[c], 0.0, 1e-14);
    check_near((after[c] - before[c]) / dt, t[0].velocity[c], 0.0, 1e-5);
  }
  walled_release(&w);
}

/* ---- how far ---- */

/* No point has come nearer to any wall by more than `moved`. */
static void no_wall_comes_nearer_than_it_says(void **state) {
  (void)state;
  cdem_random random = {23};
  static const cdem_wall_shape shapes[3] = {CDEM_WALL_PLANE, CDEM_WALL_PLATE, CDEM_WALL_CYLINDER};
  double largest = 0.0;
  for (int trial = 0; trial < 300; trial++) {
    enum { GRAINS = 40 };
    cdem_wall wall = {.name = "any", .shape = shapes[trial % 3], .half = {2.0, 1.0}, .radius = 3.0};
    double rate[6], other[3] = {0.3, 0.1, -0.7}, before[GRAINS], moved = 0.0;
    if (trial % 2)
      wall.half[0] = trial % 3 == 2 ? 0.0 : 0.5;
    for (int c = 0; c < 3; c++) {
      wall.normal[c] = cdem_random_uniform(&random, -1, 1);
      wall.center[c] = cdem_random_uniform(&random, -1, 1);
      rate[c] = cdem_random_uniform(&random, -1, 1);
      rate[3 + c] = cdem_random_uniform(&random, -1, 1);
      wall.velocity[c] = constant(rate + c);
      wall.spin[c] = constant(rate + 3 + c);
    }
    cdem_cross3(wall.normal, other, wall.axis);
    walled w;
    walled_make(&w, 3, GRAINS, 1, &wall);
    for (int i = 0; i < GRAINS; i++)
      walled_place(&w, i, cdem_random_uniform(&random, -9, 9), cdem_random_uniform(&random, -9, 9),
                   cdem_random_uniform(&random, -9, 9), 0.5);
    walled_build(&w);
    const cdem_wall_body *body = w.s.walls->body;
    cdem_wall_near near;
    for (int i = 0; i < GRAINS; i++) {
      body->kind->nearest(body, cdem_place(&w.s, i), 1e9, &near);
      before[i] = near.distance;
    }
    for (int step = 0; step < 5; step++)
      cdem_walls_advance(&w.s, 0.03 * step, 0.03, NULL, &moved);
    for (int i = 0; i < GRAINS; i++) {
      body->kind->nearest(body, cdem_place(&w.s, i), 1e9, &near);
      double came = fabs(before[i] - near.distance);
      check_below(came, moved * (1.0 + 1e-12));
      largest = fmax(largest, came / moved);
    }
    walled_release(&w);
  }
  assert_true(largest > 0.9); /* and the bound is no wild guess */
}

/* A plane that begins to tilt long after the lists were made says how near it comes to a grain far
 * away. */
static void a_wall_that_begins_to_turn_says_so(void **state) {
  (void)state;
  double rate = 1e-3, moved = 0.0;
  cdem_wall wall = {.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}};
  const cdem_series spin[3] = {{0}, constant(&rate), {0}};
  walled w;
  cdem_wall_near near;
  walled_make(&w, 3, 1, 1, &wall);
  walled_place(&w, 0, 100.0, 0.0, 1.2, 1.0);
  walled_build(&w);
  const cdem_wall_body *body = w.s.walls->body;
  cdem_walls_advance(&w.s, 0.0, 1.0, NULL, &moved);
  assert_true(moved == 0.0);
  cdem_walls_move(&w.s, 0, NULL, spin);
  cdem_walls_advance(&w.s, 1.0, 1.0, NULL, &moved);
  assert_true(body->kind->nearest(body, cdem_place(&w.s, 0), 1e9, &near));
  check_near(fabs(near.distance - 1.2), 0.1, 1e-4, 0.0); /* 100 m times sin(1e-3) */
  check_below(fabs(near.distance - 1.2), moved);
  check_below(moved, 0.11);
  walled_release(&w);
}

/* Lists built anew by this bound, and by no other: the same path as with a list built every step.
 */
static void run_through_the_skin(bool always, double x[3], int *builds) {
  double rate = 3.0;
  const double corner[12] = {-4, -4, 0, 4, -4, 0, 4, 4, 0, -4, 4, 0};
  const int32_t facet[6] = {0, 1, 2, 0, 2, 3};
  cdem_wall wall = {.name = "paddle",
                    .shape = CDEM_WALL_MESH,
                    .corners = 4,
                    .corner = corner,
                    .facets = 2,
                    .facet = facet,
                    .spin = {constant(&rate), {0}, {0}}};
  ball b = {.x = {0.2, 2.0, 1.5}, .radius = 1.0, .mass = 1.0, .inertia = 0.4, .kn = 1e4, .kt = 3e3};
  b.mu = 0.5;
  b.v[2] = -1.0;
  walled w;
  walled_make(&w, 3, 1, 1, &wall);
  w.s.skin = 0.2;
  walled_place(&w, 0, b.x[0], b.x[1], b.x[2], b.radius);
  walled_build(&w);
  double moved = 0.0, way = 0.0;
  const double dt = 5e-4;
  *builds = 0;
  for (int i = 0; i < 6000; i++) {
    ball_step(&w, &b, dt);
    way += dt * cdem_norm3(b.v);
    cdem_walls_advance(&w.s, i * dt, dt, NULL, &moved);
    if (always || way + moved > 0.1) {
      walled_place(&w, 0, b.x[0], b.x[1], b.x[2], b.radius);
      walled_build(&w);
      way = 0.0;
      ++*builds;
    }
  }
  memcpy(x, b.x, sizeof b.x);
  walled_release(&w);
}

static void a_skin_changes_nothing(void **state) {
  (void)state;
  double often[3], seldom[3];
  int all, some;
  run_through_the_skin(true, often, &all);
  run_through_the_skin(false, seldom, &some);
  assert_memory_equal(often, seldom, sizeof often);
  assert_true(some < all / 3);
  assert_true(fabs(often[1]) > 5.0); /* it was hit and thrown */
}

/* ---- a mesh is what it stands for ---- */

static void a_turning_mesh_is_a_turning_plate(void **state) {
  (void)state;
  double rate[6] = {0.5, -0.2, 0.1, 1.0, 2.0, -0.5};
  const double corner[12] = {-2, -3, 1, 4, -3, 1, 4, 3, 1, -2, 3, 1};
  const int32_t facet[6] = {0, 1, 2, 0, 2, 3};
  cdem_wall wall[2] = {{.name = "mesh",
                        .shape = CDEM_WALL_MESH,
                        .corners = 4,
                        .corner = corner,
                        .facets = 2,
                        .facet = facet},
                       {.name = "plate",
                        .shape = CDEM_WALL_PLATE,
                        .normal = {0, 0, 1},
                        .axis = {1, 0, 0},
                        .half = {3, 3}}};
  cdem_random random = {31};
  int touches = 0;
  for (int k = 0; k < 2; k++) {
    wall[k].center[0] = wall[k].center[2] = 1.0;
    for (int c = 0; c < 3; c++) {
      wall[k].velocity[c] = constant(rate + c);
      wall[k].spin[c] = constant(rate + 3 + c);
    }
  }
  walled w;
  walled_make(&w, 3, 1, 2, wall);
  walled_build(&w);
  for (int i = 0; i < 2000; i++) {
    cdem_wall_touch t[CDEM_WALL_TOUCHES];
    advance(&w, 0.003, 1);
    int count =
        walled_touch(&w, cdem_random_uniform(&random, -5, 5), cdem_random_uniform(&random, -5, 5),
                     cdem_random_uniform(&random, -5, 5), 1.0, t);
    assert_true(count == 0 || count == 2);
    touches += count;
    if (count == 0)
      continue;
    check_near(t[0].overlap, t[1].overlap, 0.0, 1e-14);
    check_vector(t[0].n, t[1].n[0], t[1].n[1], t[1].n[2], 1e-13);
    check_vector(t[0].velocity, t[1].velocity[0], t[1].velocity[1], t[1].velocity[2], 1e-13);
  }
  assert_true(touches > 100);
  walled_release(&w);
}

/* ---- gates and phases ---- */

static void a_gate_is_there_from_start_to_stop(void **state) {
  (void)state;
  cdem_wall wall = {
      .name = "gate", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}, .start = 0.25, .stop = 0.75};
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  bool fresh;
  walled_make(&w, 3, 1, 1, &wall);
  walled_place(&w, 0, 0.0, 0.0, 0.9, 1.0);
  walled_build(&w);
  for (int i = 0; i < 8; i++) {
    int expected = i >= 2 && i < 6;
    assert_int_equal(cdem_walls_find(&w.s, 0, t), expected);
    if (expected)
      cdem_walls_history(&w.s, t, &fresh);
    advance(&w, 0.125, 1);
  }
  walled_build(&w); /* for ever gone */
  assert_int_equal(cdem_walls_rows(&w.s)[1], 0);
  walled_release(&w);
}

static void new_functions_go_on_from_where_the_wall_is(void **state) {
  (void)state;
  double one = 1.0, minus = -2.0;
  cdem_wall wall = {.name = "plate",
                    .shape = CDEM_WALL_PLATE,
                    .normal = {0, 1, 0},
                    .half = {1.0},
                    .velocity = {constant(&one), {0}, {0}},
                    .spin = {{0}, {0}, constant(&one)}};
  const cdem_series back[3] = {constant(&minus), {0}, {0}}, rest[3] = {{0}, {0}, {0}};
  walled w;
  cdem_dem_wall now;
  walled_make(&w, 2, 1, 1, &wall);
  walled_build(&w);
  advance(&w, 0.125, 8);
  cdem_walls_move(&w.s, 0, back, back); /* the spin about x is nothing in 2-D */
  advance(&w, 0.125, 4);
  cdem_walls_now(&w.s, 0, &now);
  check_near(now.moved[0], 0.0, 0.0, 1e-15);
  check_near(now.velocity[0], -2.0, 0.0, 0.0);
  /* the axis (-n_y, n_x) was turned by one radian and stays */
  check_vector(w.s.walls->body->axis, -cos(1.0), -sin(1.0), 0.0, 1e-15);
  cdem_walls_move(&w.s, 0, rest, NULL);
  advance(&w, 0.125, 4);
  cdem_walls_now(&w.s, 0, &now);
  check_near(now.moved[0], 0.0, 0.0, 1e-15);
  walled_release(&w);
}

/* ---- servos ---- */

/* A block of linear springs of stiffness k, its surface at height 0, under a plate whose place is
 * `moved`; sign -1: above it. The force on the plate along z. */
static double block_force(double stiffness, double side, double place) {
  double overlap = side > 0.0 ? -place : place;
  return overlap > 0.0 ? side * stiffness * overlap : 0.0;
}

typedef struct {
  double force, place, speed;
} servo_result;

/* Plate with its servo along `direction` z; the block below it (side 1) or above it (-1). */
static servo_result servo_run(double side, double direction, double wanted, double unit,
                              int steps) {
  double value[2] = {wanted * unit, 0.5 * wanted * unit}, time[2] = {0.999, 1.0};
  cdem_wall wall = {.name = "plate",
                    .shape = CDEM_WALL_PLATE,
                    .normal = {0, 0, 1},
                    .axis = {1, 0, 0},
                    .half = {1, 1},
                    .center = {0.0, 0.0, 0.01 * side * unit},
                    .servo = {0, 0, direction},
                    .servo_speed = 0.5 * unit};
  wall.servo_force =
      (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 2, .time = time, .value = value};
  walled w;
  walled_make(&w, 3, 1, 1, &wall);
  walled_build(&w);
  const double dt = 1e-3, stiffness = 1e4;
  servo_result r = {0};
  for (int i = 0; i < steps; i++) {
    cdem_dem_wall now;
    double moved, force[6] = {0}, f = block_force(stiffness, side, 0.01 * side * unit + r.place);
    double k = f != 0.0 ? stiffness : 0.0;
    force[2] = f;
    cdem_walls_advance(&w.s, i * dt, dt, &(cdem_wall_loads){force, &k, NULL}, &moved);
    cdem_walls_now(&w.s, 0, &now);
    assert_true(fabs(now.velocity[2]) <= 0.5 * unit * (1.0 + 1e-12));
    check_near(now.moved[2] - r.place, now.velocity[2] * dt, 0.0, 1e-14 * unit);
    r.place = now.moved[2];
    r.speed = now.velocity[2];
    r.force = direction * block_force(stiffness, side, 0.01 * side * unit + r.place);
  }
  walled_release(&w);
  return r;
}

static void a_servo_reaches_its_force_from_either_side(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    double side = k & 1 ? 1.0 : -1.0, direction = k & 2 ? 1.0 : -1.0;
    double wanted = 40.0 * side * direction; /* the block pushes the plate away from it */
    servo_result r = servo_run(side, direction, wanted, 1.0, 400);
    check_near(r.force, wanted, 1e-12, 0.0);
    check_below(fabs(r.speed), 1e-12);
    /* and follows a step of the wanted force */
    r = servo_run(side, direction, wanted, 1.0, 1400);
    check_near(r.force, 0.5 * wanted, 1e-12, 0.0);
  }
  /* a pull that no block can give: it goes away at full speed */
  servo_result r = servo_run(1.0, 1.0, -40.0, 1.0, 50);
  check_near(r.speed, 0.5, 0.0, 0.0);
}

static void a_servo_does_not_know_units(void **state) {
  (void)state;
  servo_result one = servo_run(1.0, 1.0, 40.0, 1.0, 120), two;
  two = servo_run(1.0, 1.0, 40.0, 0x1p-20, 120);
  assert_true(two.place == 0x1p-20 * one.place && two.force == 0x1p-20 * one.force);
}

/* ---- restart ---- */

static const double cone_corner[15] = {-4, -4, 0, 4, -4, 0, 4, 4, 0, -4, 4, 0, 0, 0, -1};
static const int32_t cone_facet[12] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};

typedef struct {
  walled w;
  ball b;
  int step;
} tossed;

static void toss(tossed *r, int steps, double phase) {
  const double dt = 1e-3;
  for (int k = 0; k < steps; k++, r->step++) {
    double moved, force[12] = {0}, stiffness[2] = {0.0, 3e3};
    force[8] = phase * r->step; /* on the servo's wall */
    if (r->step % 7 == 0) {
      walled_place(&r->w, 0, r->b.x[0], r->b.x[1], r->b.x[2], r->b.radius);
      walled_build(&r->w);
    }
    ball_step(&r->w, &r->b, dt);
    cdem_walls_advance(&r->w.s, r->step * dt, dt, &(cdem_wall_loads){force, stiffness, NULL},
                       &moved);
  }
}

static void a_restored_wall_goes_on_to_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  double rate = 1.0, wanted = 3.0, slow = 0.3;
  cdem_wall wall[2] = {{.name = "bowl",
                        .shape = CDEM_WALL_MESH,
                        .corners = 5,
                        .corner = cone_corner,
                        .facets = 4,
                        .facet = cone_facet},
                       {.name = "lid",
                        .shape = CDEM_WALL_PLANE,
                        .center = {0, 0, 1.4},
                        .normal = {0, 0, -1},
                        .servo = {0, 0, 1},
                        .servo_speed = 0.01}};
  wall[0].spin[2] = constant(&rate);
  wall[0].spin[0] = (cdem_series){.kind = CDEM_SERIES_SINE, .amplitude = 0.5, .frequency = 2.0};
  wall[0].velocity[1] = wall[0].spin[0];
  wall[1].servo_force = constant(&wanted);
  const cdem_series later[3] = {{0}, {0}, constant(&slow)};
  tossed a = {.b = {.x = {0.3, 0.2, 0.1}, .radius = 1.0, .mass = 1.0, .inertia = 0.4}}, b;
  a.b.kn = 3e3, a.b.kt = 2e3, a.b.mu = 0.6, a.b.damping = 1.0, a.b.gravity[2] = -9.0;
  memset(&a.w, 0, sizeof a.w);
  walled_make(&a.w, 3, 1, 2, wall);
  toss(&a, 300, 0.1);
  cdem_walls_move(&a.w.s, 0, wall[0].velocity, later);
  toss(&a, 303, 0.1);
  cdem_state saved = {0};
  check_ok(cdem_walls_save(&a.w.s, &saved, &fault));
  b = a;
  walled_make(&b.w, 3, 1, 2, wall);
  cdem_walls_move(&b.w.s, 0, wall[0].velocity, later);
  check_ok(cdem_walls_restore(&b.w.s, &saved, &fault));
  assert_true(a.b.contacts >= 1);
  toss(&a, 400, 0.1);
  toss(&b, 400, 0.1);
  assert_memory_equal(a.b.x, b.b.x, sizeof a.b.x);
  assert_memory_equal(a.b.w, b.b.w, sizeof a.b.w);
  cdem_dem_wall one = {0}, two = {0};
  for (int k = 0; k < 2; k++) {
    cdem_walls_now(&a.w.s, k, &one);
    cdem_walls_now(&b.w.s, k, &two);
    assert_memory_equal(&one, &two, sizeof one);
    assert_memory_equal(a.w.s.walls->body[k].turn, b.w.s.walls->body[k].turn, 9 * sizeof(double));
  }
  walled_release(&b.w);
  /* a state of another case is refused, and the walls stay as they are */
  walled_make(&b.w, 3, 1, 1, wall);
  check_fails(cdem_walls_restore(&b.w.s, &saved, &fault), CDEM_INPUT, "walls/motion");
  walled_release(&b.w);
  cdem_state_release(&saved);
  walled_release(&a.w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_path_is_the_integral_of_the_velocity),
      cmocka_unit_test(a_drum_has_the_speed_of_its_surface),
      cmocka_unit_test(a_spin_about_one_direction_is_exact),
      cmocka_unit_test(any_spin_is_of_second_order),
      cmocka_unit_test(turned_walls_stay_at_right_angles),
      cmocka_unit_test(velocities_are_those_of_the_points),
      cmocka_unit_test(no_wall_comes_nearer_than_it_says),
      cmocka_unit_test(a_wall_that_begins_to_turn_says_so),
      cmocka_unit_test(a_skin_changes_nothing),
      cmocka_unit_test(a_turning_mesh_is_a_turning_plate),
      cmocka_unit_test(a_gate_is_there_from_start_to_stop),
      cmocka_unit_test(new_functions_go_on_from_where_the_wall_is),
      cmocka_unit_test(a_servo_reaches_its_force_from_either_side),
      cmocka_unit_test(a_servo_does_not_know_units),
      cmocka_unit_test(a_restored_wall_goes_on_to_the_same_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
