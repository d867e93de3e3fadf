/* Forces of contact against formulas written by hand; both momenta; walls; friction; what is
 * refused. */
#include "base/memory.h"
#include "contact_support.h"

static cdem_mesh mesh_of[3];
static cdem_skin skin_of[3]; /* a cube of 26 nodes, a ball of 38, a notch */

static int make_skins(void **state) {
  (void)state;
  cdem_fault fault = {0};
  int32_t nodes[3] = {
      box_mesh(CDEM_SHAPE_HEX8, (int32_t[3]){2, 2, 2}, (double[3]){1.0, 1.0, 1.0}, 0.0, mesh_of),
      ball_mesh(3, mesh_of + 1), notch_mesh(mesh_of + 2)};
  for (int k = 0; k < 3; k++)
    check_ok(cdem_skin_build(mesh_of + k, nodes[k], 0.05, skin_of + k, &fault));
  return 0;
}

static int release_skins(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    cdem_skin_release(skin_of + k);
    cdem_mesh_release(mesh_of + k);
  }
  return 0;
}

static const cdem_fdem_contact_law law = {
    .penalty = 1e9, .shear_ratio = 0.5, .friction = 0.4, .damping_ratio = 0.3};

/* Two cubes of 20 mm; the second stands on the first by 0.1 mm less, shifted by 3 mm and 4 mm. */
static void two_cubes(model *m) {
  const cdem_skin *skins[2] = {skin_of, skin_of};
  model_make(m, 2, skins, 0.02, law);
  m->center[3] = 0.003;
  m->center[4] = 0.004;
  m->center[5] = 0.0199;
}

/* Nodes of the second cube's lower face are at -7, 3, 13 mm and -6, 4, 14 mm: four of nine are in
 * the first one, and likewise four of its upper face in the second. */
static void a_node_is_pushed_by_its_area_and_depth(void **state) {
  (void)state;
  model m;
  two_cubes(&m);
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  int pushed = 0;
  double total[2] = {0.0}, stiff = 0.0;
  int64_t touches;
  cdem_fdem_touch *touch;
  cdem_fault fault = {0};
  check_ok(cdem_fdem_contacts_list(m.contacts, &m.view, &touches, &touch, &fault));
  assert_int_equal(touches, 8);
  for (int64_t k = 0; k < touches; k++) {
    int g = touch[k].grain, sign = g == 0 ? -1 : 1;
    int64_t n = m.first[g] + touch[k].node;
    double k_of = 1e9 * m.area[n];
    assert_int_equal(touch[k].partner, 1 - g);
    check_near(touch[k].depth, 1e-4, 1e-11, 0.0);
    check_near(touch[k].push, k_of * 1e-4, 1e-11, 0.0);
    check_near(touch[k].force[2], sign * k_of * 1e-4, 1e-11, 0.0);
    check_near(touch[k].normal[2], -sign, 1e-14, 0.0);
    check_near(touch[k].force[0], 0.0, 0.0, 1e-15 * touch[k].push);
    total[g] += touch[k].push;
    stiff += k_of;
    pushed++;
  }
  free(touch);
  double force[3], moment[3];
  load_of(&m, 0, force, moment);
  check_near(force[2], -(total[0] + total[1]), 1e-13, 0.0);
  load_of(&m, 1, force, moment);
  check_near(force[2], total[0] + total[1], 1e-13, 0.0);
  check_near(m.stiff[0], stiff, 1e-14, 0.0);
  check_near(m.stiff[1], stiff, 1e-14, 0.0);
  check_near(m.book.normal, 0.5 * stiff * 1e-8, 1e-11, 0.0);
  int32_t count[2];
  cdem_fdem_contacts_count(m.contacts, &m.view, count);
  assert_int_equal(count[0], 1);
  assert_int_equal(count[1], 1);
  model_release(&m);
}

/* Sinking at v: k d + c v with c = 2 beta sqrt(m k); leaving fast enough: nothing, never a pull. */
static void dashpots_push_and_never_pull(void **state) {
  (void)state;
  for (int leaving = 0; leaving < 2; leaving++) {
    model m;
    two_cubes(&m);
    model_start(&m, 0.0, 1);
    double v = leaving ? 30.0 : -0.2, step = 1e-6;
    for (int64_t n = m.first[1]; n < m.first[2]; n++)
      m.before[3 * n + 2] = m.now[3 * n + 2] - v * step;
    model_forces(&m, step);
    cdem_fault fault = {0};
    int64_t touches;
    cdem_fdem_touch *touch;
    check_ok(cdem_fdem_contacts_list(m.contacts, &m.view, &touches, &touch, &fault));
    assert_int_equal(touches, 8);
    for (int64_t k = 0; k < touches; k++) {
      int64_t n = m.first[touch[k].grain] + touch[k].node;
      double stiffness = 1e9 * m.area[n], c = 0.6 * sqrt(m.mass[n] * stiffness);
      check_near(touch[k].push, leaving ? 0.0 : stiffness * 1e-4 - c * v, 1e-9, 0.0);
    }
    free(touch);
    model_release(&m);
  }
}

/* One that leaves so fast that nothing pushes gives what its spring held to the dashpot, not to the
 * motion: half of it while it still touches, by the trapezoid, half when it has left. */
static void a_spring_left_behind_goes_to_the_dashpot(void **state) {
  (void)state;
  model m;
  two_cubes(&m);
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  double held = m.book.normal, dissipated = 0.0;
  for (int k = 0; k < 2; k++) { /* 0.05 mm, then out */
    memcpy(m.before, m.now, 3 * (size_t)m.nodes * sizeof *m.now);
    m.center[5] += k == 0 ? 5e-5 : 1e-3;
    set_now(&m);
    model_forces(&m, 1e-6);
    assert_true(m.force[2] == 0.0);
    dissipated += m.book.damping;
  }
  assert_true(m.book.normal == 0.0);
  /* k d^2/2 = (0 + F)(d - d')/2 + F d'/2 with F = k d', d' = d/2: 3/8 by k d^2/2 and 1/4 of it */
  check_near(m.book.damping, 0.25 * held, 1e-9, 0.0);
  check_near(dissipated, 0.5 * held, 1e-9, 0.0);
  model_release(&m);
}

/* Nodes on an edge of a cube that are in a grain below by 0.1 mm and in one beside by 0.2 mm. */
static void a_node_touches_the_grain_it_is_deepest_in(void **state) {
  (void)state;
  for (int below = 1; below <= 2; below++) {
    const cdem_skin *skins[3] = {skin_of, skin_of, skin_of};
    const double place[3][3] = {
        {0.0, 0.0, 0.0}, {-0.003, 0.002, -0.0199}, {-0.0198, 0.002, -0.003}};
    cdem_fault fault = {0};
    cdem_fdem_touch *touch;
    int64_t touches;
    int on_the_edge = 0;
    model m;
    model_make(&m, 3, skins, 0.02, law);
    memcpy(m.center + 3 * below, place[1], sizeof place[1]);
    memcpy(m.center + 3 * (3 - below), place[2], sizeof place[2]);
    model_start(&m, 0.0, 1);
    model_forces(&m, 0.0);
    check_ok(cdem_fdem_contacts_list(m.contacts, &m.view, &touches, &touch, &fault));
    for (int64_t k = 0; k < touches && touch[k].grain == 0; k++) {
      assert_true(k == 0 || touch[k].node > touch[k - 1].node);
      if (touch[k].point[0] < -0.005 && touch[k].point[2] < -0.005) {
        assert_int_equal(touch[k].partner, 3 - below);
        check_near(touch[k].depth, 2e-4, 1e-11, 0.0);
        on_the_edge++;
      }
    }
    assert_int_equal(on_the_edge, 2);
    free(touch);
    model_release(&m);
  }
}

/* ---- both momenta ---- */

/* A heap of cubes, balls and notches that overlap, deformed, turned anyhow and moving. */
static void heap(model *m, int grains, cdem_random *random) {
  const cdem_skin **skins = calloc((size_t)grains, sizeof *skins);
  double *scale = calloc((size_t)grains, sizeof *scale);
  for (int g = 0; g < grains; g++) { /* all as large as a ball of 0.25 m */
    skins[g] = skin_of + g % 3;
    scale[g] = 0.25 * cbrt(4.0 / 3.0 * M_PI / skins[g]->volume);
  }
  model_make_sized(m, grains, skins, scale, law);
  free(skins);
  free(scale);
  int side = 1;
  while (side * side * side < grains)
    side++;
  for (int g = 0; g < grains; g++) {
    double axis[3];
    for (int c = 0; c < 3; c++) {
      int at = c == 0 ? g % side : (c == 1 ? g / side % side : g / side / side);
      m->center[3 * g + c] = 0.45 * at + cdem_random_uniform(random, -0.02, 0.02);
      m->velocity[3 * g + c] = cdem_random_uniform(random, -1.0, 1.0);
      m->momentum[3 * g + c] = m->inertia[9 * g] * cdem_random_uniform(random, -5.0, 5.0);
      axis[c] = cdem_random_uniform(random, -1.0, 1.0);
    }
    turn_about(m->turn + 9 * g, axis, 2.0);
    m->material[g] = g % 2;
  }
  for (int64_t k = 0; k < 3 * m->nodes; k++)
    m->place[k] += 0.25 * 0.01 * cdem_random_uniform(random, -1.0, 1.0);
  m->law[1].friction = m->law[2].friction = 0.1;
}

static void both_momenta_are_kept(void **state) {
  (void)state;
  cdem_random random = {17};
  model m;
  heap(&m, 27, &random);
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  for (int step = 0; step < 20; step++) {
    double force[3] = {0}, moment[3] = {0}, forces = 0.0, moments = 0.0;
    drift(&m, 1e-4);
    model_forces(&m, 1e-4);
    for (int64_t n = 0; n < m.nodes; n++) {
      double turning[3];
      cdem_cross3(m.now + 3 * n, m.force + 3 * n, turning);
      forces += cdem_norm3(m.force + 3 * n);
      moments += cdem_norm3(turning);
      for (int c = 0; c < 3; c++) {
        force[c] += m.force[3 * n + c];
        moment[c] += turning[c];
      }
    }
    assert_true(forces > 0.0 && m.book.shear > 0.0);
    check_below(cdem_norm3(force), 1e-13 * forces);
    check_below(cdem_norm3(moment), 1e-13 * moments);
  }
  assert_true(m.sum.friction > 0.0);
  model_release(&m);
}

/* ---- friction ---- */

/* A cube 0.1 mm in a floor, drawn along it: k_s u as long as that is below mu F, then mu F; drawn
 * back, the force falls at once from there. */
static void friction_is_a_spring_with_a_cap(void **state) {
  (void)state;
  const cdem_skin *skins[1] = {skin_of};
  const double w = 1e-6, depth = 1e-4;
  model m;
  model_make(&m, 1, skins, 0.02, law);
  m.law[0].damping_ratio = 0.0;
  m.center[2] = 0.01 - depth;
  model_wall(&m, &(cdem_wall){.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1.0}});
  model_start(&m, 0.0, 1);
  model_forces(&m, 0.0);
  double stiff = 0.0, sliding = 0.0, spring = 0.0, work = 0.0, last = 0.0;
  for (int64_t n = 0; n < m.nodes; n++)
    stiff += m.now[3 * n + 2] < 0.0 ? 1e9 * m.area[n] : 0.0;
  check_near(stiff, 1e9 * (4e-4 + 4 * 1e-4), 1e-12, 0.0); /* the face, a quarter of its sides */
  check_near(m.wall_force[0][2], -stiff * depth, 1e-11, 0.0);
  check_near(m.wall_stiff[0], stiff, 1e-14, 0.0);
  for (int step = 0; step < 200; step++) {
    double way = step < 120 ? w : -w, force[3], moment[3];
    memcpy(m.before, m.now, 3 * (size_t)m.nodes * sizeof *m.now);
    m.center[1] += way;
    set_now(&m);
    model_forces(&m, 1e-6);
    spring += way;
    double cap = 0.4 * depth / 0.5; /* mu F/k_s */
    if (fabs(spring) > cap) {
      sliding += 0.4 * stiff * depth * (fabs(spring) - cap);
      spring = spring > 0.0 ? cap : -cap;
    }
    load_of(&m, 0, force, moment);
    check_near(force[1], -0.5 * stiff * spring, 1e-9, 1e-12 * stiff * depth);
    check_near(force[2], stiff * depth, 1e-10, 0.0);
    check_near(m.wall_force[0][1], -force[1], 1e-13, 1e-13 * stiff * depth);
    work -= 0.5 * (force[1] + last) * way;
    last = force[1];
    check_near(m.book.shear, 0.25 * stiff * spring * spring, 1e-9, 1e-12 * stiff * depth * depth);
    check_near(m.sum.friction + m.book.shear, work, 1e-9, 1e-12 * stiff * depth * depth);
  }
  check_near(m.sum.friction, sliding, 0.05, 0.0); /* the step in which it begins to slide */
  check_below(fabs(m.sum.damping), 1e-10 * m.sum.friction);
  model_release(&m);
}

/* Friction without normal force, and a node that has left: nothing is remembered. */
static void springs_are_forgotten_with_the_touch(void **state) {
  (void)state;
  const cdem_skin *skins[1] = {skin_of};
  model m;
  model_make(&m, 1, skins, 0.02, law);
  m.law[0].damping_ratio = 0.0;
  model_wall(&m, &(cdem_wall){.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1.0}});
  model_start(&m, 0.0, 1);
  const double height[] = {0.0099, 0.0099, 0.0101, 0.0099}, force[] = {0.0, -1.0, 0.0, 0.0};
  for (int k = 0; k < 4; k++) {
    double f[3], moment[3];
    memcpy(m.before, m.now, 3 * (size_t)m.nodes * sizeof *m.now);
    m.center[2] = height[k];
    m.center[0] += 1e-6;
    set_now(&m);
    model_forces(&m, k == 0 ? 0.0 : 1e-6);
    load_of(&m, 0, f, moment);
    check_near(f[0], force[k] * 0.5 * m.wall_stiff[0] * 1e-6, 1e-9, 1e-12 * m.wall_stiff[0] * 1e-6);
  }
  model_release(&m);
}

/* A ball on a cube, or a cube on a table that turns, pressed together. */
static void held_pair(model *m, bool pair, cdem_series *spin) {
  const cdem_skin *skins[2] = {skin_of, skin_of + 1};
  cdem_fault fault = {0};
  model_make(m, pair ? 2 : 1, skins, 0.02, law);
  m->law[0].damping_ratio = 0.0;
  m->center[2] = 0.0099;
  check_ok(cdem_series_constant(100.0, spin, &fault));
  if (pair) {
    m->center[3] = 0.002;
    m->center[4] = -0.001;
    m->center[5] = 0.0099 + 0.01 + 0.0195;
  } else {
    cdem_wall wall = {.name = "table", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1.0}};
    wall.spin[2] = *spin;
    model_wall(m, &wall);
  }
  model_start(m, 0.0, 1);
  model_forces(m, 0.0);
}

static void turn_all(model *m, const double axis[3], double angle) {
  double by[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  memcpy(m->before, m->now, 3 * (size_t)m->nodes * sizeof *m->now);
  turn_about(by, axis, angle);
  for (int g = 0; g < m->grains; g++) {
    double old[3] = {m->center[3 * g], m->center[3 * g + 1], m->center[3 * g + 2]};
    cdem_wall_turned(by, old, m->center + 3 * g);
    turn_about(m->turn + 9 * g, axis, angle);
  }
  set_now(m);
}

/* Turned as one body, forces turn with it. A wall's way in a step is w dt x, that of a node which
 * is turned 2 tan(w dt/2) x: the third power of the angle remains. */
static void what_turns_as_one_body_does_not_slip(void **state) {
  (void)state;
  for (int pair = 0; pair < 2; pair++) {
    const double axis[3] = {pair ? 0.3 : 0.0, pair ? 0.8 : 0.0, 0.6};
    double before[3], after[3], moment[3], turned[3], turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double allowed = pair ? 1e-9 : 1e-4;
    cdem_series spin;
    model m;
    held_pair(&m, pair, &spin);
    /* shifted a little, so that the springs hold something */
    memcpy(m.before, m.now, 3 * (size_t)m.nodes * sizeof *m.now);
    m.center[0] += 1e-5;
    set_now(&m);
    model_forces(&m, 1e-5);
    double held = m.book.shear;
    load_of(&m, 0, before, moment);
    assert_true(held > 0.0);
    for (int step = 0; step < 500; step++) {
      turn_about(turn, axis, 1e-3);
      turn_all(&m, axis, 1e-3);
      for (int w = 0; w < m.view.walls; w++)
        cdem_wall_body_advance(m.wall + w, 1e-5 * step, 1e-5, NULL, 0.0);
      model_forces(&m, 1e-5);
    }
    cdem_wall_turned(turn, before, turned);
    load_of(&m, 0, after, moment);
    check_near(m.book.shear, held, allowed, 0.0);
    for (int c = 0; c < 3; c++)
      check_near(after[c], turned[c], 0.0, allowed * cdem_norm3(before));
    cdem_series_release(&spin);
    model_release(&m);
  }
}

/* ---- what is refused ---- */

static void what_cannot_be_is_refused(void **state) {
  (void)state;
  static const double corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  static const int32_t facet[3] = {0, 1, 2};
  const cdem_skin *skins[2] = {skin_of, skin_of + 1};
  cdem_fault fault = {0};
  model m;
  model_make(&m, 2, skins, 0.02, law);
  m.center[3] = 1.0;
  m.wall[0].wall = (cdem_wall){.name = "chute",
                               .shape = CDEM_WALL_MESH,
                               .corners = 3,
                               .facets = 1,
                               .corner = corner,
                               .facet = facet};
  model_start(&m, 0.0, 1);
  cdem_fdem_contacts *other = NULL;
  m.view.walls = 1;
  check_fails(cdem_fdem_contacts_create(&m.view, 0.1, 1, &other, &fault), CDEM_INPUT,
              "wall 'chute' is a mesh");
  assert_null(other);
  m.view.walls = 0;
  check_fails(cdem_fdem_contacts_create(&m.view, -1.0, 1, &other, &fault), CDEM_INPUT,
              "-1 mean radii");
  m.center[3] = 0.008;
  set_now(&m);
  cdem_contact_forces out = model_out(&m);
  check_fails(cdem_fdem_contacts_forces(m.contacts, &m.view, &out, &m.book, &fault), CDEM_NUMERIC,
              "grain 0: its node at (0.01, ");
  model_release(&m);
  model_make(&m, 1, skins, 0.02, law);
  m.center[2] = -0.001;
  model_wall(&m, &(cdem_wall){.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1.0}});
  model_start(&m, 0.0, 1);
  out = model_out(&m);
  check_fails(cdem_fdem_contacts_forces(m.contacts, &m.view, &out, &m.book, &fault), CDEM_NUMERIC,
              "m is 0.011 m deep in wall 'floor'");
  model_release(&m);
  model_make(&m, 1, skins, 0.02, law);
  model_start(&m, 0.0, 1);
  for (int c = 0; c < 3; c++) /* one node is pulled out by more than the skin has room for */
    m.place[c] *= 1.5;
  out = model_out(&m);
  check_fails(cdem_fdem_contacts_forces(m.contacts, &m.view, &out, &m.book, &fault), CDEM_NUMERIC,
              "its strains are not small");
  model_release(&m);
}

static void memory_that_ends_is_told(void **state) {
  (void)state;
  cdem_random random = {5};
  cdem_fault fault = {0};
  model m;
  heap(&m, 3, &random);
  model_start(&m, 0.0, 1);
  cdem_fdem_contacts_destroy(&m.contacts);
  const cdem_contact_forces out = model_out(&m);
  cdem_status status = CDEM_MEMORY;
  int failures = 0;
  for (; status == CDEM_MEMORY; failures++) {
    fault.status = CDEM_OK;
    cdem_memory_fail_after(failures);
    status = cdem_fdem_contacts_create(&m.view, 0.1, 1, &m.contacts, &fault);
    if (status == CDEM_OK)
      status = cdem_fdem_contacts_forces(m.contacts, &m.view, &out, &m.book, &fault);
    cdem_memory_fail_after(-1);
    if (status != CDEM_OK)
      cdem_fdem_contacts_destroy(&m.contacts);
  }
  if (status != CDEM_OK)
    fail_msg("%s", fault.message);
  assert_true(failures > 15);
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_node_is_pushed_by_its_area_and_depth),
      cmocka_unit_test(dashpots_push_and_never_pull),
      cmocka_unit_test(a_spring_left_behind_goes_to_the_dashpot),
      cmocka_unit_test(a_node_touches_the_grain_it_is_deepest_in),
      cmocka_unit_test(both_momenta_are_kept),
      cmocka_unit_test(friction_is_a_spring_with_a_cap),
      cmocka_unit_test(springs_are_forgotten_with_the_touch),
      cmocka_unit_test(what_turns_as_one_body_does_not_slip),
      cmocka_unit_test(what_cannot_be_is_refused),
      cmocka_unit_test(memory_that_ends_is_told),
  };
  return cmocka_run_group_tests(tests, make_skins, release_skins);
}
