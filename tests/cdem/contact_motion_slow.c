/* Contact in motion: energy, friction, restitution, speed limits, and that nothing is missed. */
#include "cdem/contact_support.h"

/* Leapfrog of a scene of rigid bodies that do not turn; body 0 is held. Velocities [bodies][3]. */
static void drift(scene *s, double (*velocity)[3], const double gravity[3], double dt) {
  for (int b = 1; b < s->bodies; b++) {
    double f[3], by[3];
    scene_resultant(s, b, f);
    for (int k = 0; k < 3; k++) {
      velocity[b][k] += dt * (f[k] / s->body[b].mass + gravity[k]);
      by[k] = dt * velocity[b][k];
    }
    scene_move(s, b, by);
    scene_velocity(s, b, velocity[b]);
  }
  scene_forces(s, dt);
}

static const double none[3] = {0.0};

/* A box thrown at another one: speed after over speed before. */
static double bounce(int dim, double damping, double *lost) {
  scene s;
  scene_box box[2] = {{{2, 2, 2}, {1, 1, 1}, {0, 0, 0}, 0},
                      {{3, 3, 3}, {0.8, 0.8, 0.8}, {0.1, 0.1, 1.01}, 0}};
  if (dim == 2)
    box[1].origin[1] = 1.01;
  cdem_contact_law law = {.kn = 1e9, .kt = 5e8, .friction = 0.5, .damping = damping};
  double velocity[2][3] = {{0.0}, {0.0}};
  scene_make(&s, dim, 2, box);
  scene_start(&s, &law);
  velocity[1][dim - 1] = -1.0;
  double omega = sqrt(1e9 * (dim == 2 ? 0.8 : 0.64) / s.body[1].mass), dt = 0.02 / omega;
  double before = 0.5 * s.body[1].mass;
  scene_forces(&s, 0.0);
  for (int i = 0; i < 4000 && velocity[1][dim - 1] * dt * i < 0.03; i++)
    drift(&s, velocity, none, dt);
  cdem_contact_totals t = scene_totals(&s);
  double v = velocity[1][dim - 1];
  assert_int_equal(t.contacts, 0);
  /* the book is exact: kinetic energy lost is what the dashpots and the last step took */
  check_near(0.5 * s.body[1].mass * v * v + t.damping + t.friction, before, 1e-12, 0.0);
  assert_true(t.damping >= 0.0 && t.friction >= 0.0);
  *lost = t.damping / before;
  scene_release(&s);
  return v;
}

static void bounces_keep_energy_or_lose_it_to_dashpots(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    double lost, last = 1.0 + 1e-3;
    check_near(bounce(dim, 0.0, &lost), 1.0, 5e-4, 0.0);
    check_below(fabs(lost), 1e-3); /* the steps of first and last touch, (omega dt)^2 */
    for (double damping = 0.05; damping < 0.45; damping += 0.1) {
      double v = bounce(dim, damping, &lost);
      assert_true(v > 0.0 && v < last - 0.02 && lost > 0.0);
      last = v;
    }
  }
}

/* On a slope (gravity is turned): below tan phi it stays, above it slides with g (sin - mu cos),
 * and what it loses is booked as friction. */
static void incline(int dim, double tangent, double mu) {
  scene s;
  scene_box box[2] = {{{20, dim == 2 ? 1 : 2, 1}, {10, 1, 1}, {0, 0, 0}, 0},
                      {{2, 2, 2}, {0.9, 0.8, 0.5}, {1, 0.1, 1}, 0}};
  if (dim == 2)
    box[1].origin[1] = 1.0;
  cdem_contact_law law = {.kn = 1e8, .kt = 1e8, .friction = mu, .damping = 0.3};
  double velocity[2][3] = {{0.0}, {0.0}}, angle = atan(tangent), gravity[3] = {0.0};
  gravity[0] = 10.0 * sin(angle);
  gravity[dim - 1] = -10.0 * cos(angle);
  scene_make(&s, dim, 2, box);
  scene_start(&s, &law);
  double area = dim == 2 ? 0.9 : 0.72, mass = s.body[1].mass, dt = 0.2 / sqrt(1e8 * area / mass);
  double sink = mass * 10.0 * cos(angle) / (1e8 * area), by[3] = {0.0};
  by[dim - 1] = -sink;
  scene_move(&s, 1, by);
  scene_forces(&s, 0.0);
  double time = 0.5;
  int steps = (int)(time / dt);
  double pull = gravity[0], half = 0.0;
  steps += steps % 2;
  for (int i = 0; i < steps; i++) {
    if (tangent < mu) /* loaded slowly: a sudden load would overshoot */
      gravity[0] = pull * fmin(1.0, 2.0 * i / steps);
    drift(&s, velocity, gravity, dt);
    if (2 * (i + 1) == steps)
      half = velocity[1][0];
  }
  time = steps * dt;
  double moved = s.u[s.body[1].first * dim];
  double acceleration = 10.0 * (sin(angle) - mu * cos(angle));
  cdem_contact_totals t = scene_totals(&s);
  if (tangent < mu) {
    /* the shear springs' elastic displacement, and no more */
    check_near(moved, sink * tangent, 0.02, 0.0);
    check_below(t.friction, 1e-3 * mass * 10.0 * sink);
  } else {
    /* from half time on: what the build-up of the springs gave it is behind */
    check_near((velocity[1][0] - half) / (0.5 * time), acceleration, 1e-3, 0.0);
    check_near(t.friction, mu * mass * 10.0 * cos(angle) * moved, 5e-3, 0.0);
  }
  scene_release(&s);
}

static void slopes_hold_and_let_slide(void **state) {
  (void)state;
  incline(2, 0.45, 0.5);
  incline(2, 0.60, 0.5);
  incline(3, 0.45, 0.5);
  incline(3, 0.60, 0.5);
}

/* At any speed a box either bounces or the run stops with a message; it never comes through. */
static void fast_boxes_do_not_pass(void **state) {
  (void)state;
  int stopped = 0, bounced = 0;
  for (double speed = 1.0; speed < 1e5; speed *= 3.0)
    for (double start = 1.05; start < 1.6; start += 0.13) {
      scene s;
      cdem_fault fault = {0};
      scene_box box[2] = {{{3, 3}, {1, 0.5}, {0, 0.5}, 0}, {{1, 1}, {0.4, 0.4}, {0.23, start}, 0}};
      cdem_contact_law law = {.kn = 1e9};
      double velocity[3] = {0.0, -speed}, dt = 1e-4, by[3] = {0.0};
      scene_make(&s, 2, 2, box);
      scene_start(&s, &law);
      scene_forces(&s, 0.0);
      cdem_status status = CDEM_OK;
      for (int i = 0; i < 20000 && status == CDEM_OK && velocity[1] < 0.0; i++) {
        double f[3];
        scene_resultant(&s, 1, f);
        velocity[1] += dt * f[1] / s.body[1].mass;
        by[1] = dt * velocity[1];
        scene_move(&s, 1, by);
        scene_velocity(&s, 1, velocity);
        memset(s.force, 0, (size_t)s.blocks.mesh.nodes * 2 * sizeof(double));
        status = cdem_contact_forces(&s.contact, s.u, s.v, dt, s.force, &fault);
      }
      if (status == CDEM_OK) {
        bounced++;
        assert_true(velocity[1] >= 0.0 && start + s.u[2 * s.body[1].first + 1] > 0.75);
      } else {
        stopped++;
        assert_int_equal(status, CDEM_NUMERIC);
        assert_non_null(strstr(fault.message, "is inside element"));
        assert_non_null(strstr(fault.message, "time step is too long"));
      }
      scene_release(&s);
    }
  assert_true(bounced > 10 && stopped > 10);
}

/* The same from a list that is as good as all pairs: a skin as large as the heap. */
static void no_pair_is_missed(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    scene a, b;
    cdem_random random = {11};
    make_heap(&a, 40, dim, 1);
    make_heap(&b, 40, dim, 1);
    cdem_contact_release(&b.contact);
    cdem_contact_options o = {.skin = 100.0,
                              .threads = 1,
                              .law = {.kn = 1e8, .kt = 5e7, .friction = 0.4, .damping = 0.1}};
    scene_start_with(&b, &o);
    int64_t contacts = 0;
    for (int step = 0; step < 40; step++) {
      for (int body = 0; body < a.bodies && step > 0; body++) {
        double by[3], v[3];
        for (int k = 0; k < 3; k++) {
          by[k] = cdem_random_uniform(&random, -0.02, 0.02);
          v[k] = by[k] / 1e-3;
        }
        scene_move(&a, body, by);
        scene_move(&b, body, by);
        scene_velocity(&a, body, v);
        scene_velocity(&b, body, v);
      }
      assert_int_equal(status_of_heap(&a, 1e-3), status_of_heap(&b, 1e-3));
      for (int32_t i = 0; i < a.blocks.mesh.nodes * dim; i++)
        assert_true(a.force[i] == b.force[i]);
      assert_int_equal(scene_totals(&a).contacts, scene_totals(&b).contacts);
      contacts += scene_totals(&a).contacts;
    }
    assert_true(contacts > 1000);
    assert_true(scene_totals(&a).candidates < scene_totals(&b).candidates / 4);
    assert_true(scene_totals(&a).rebuilds > 3 && scene_totals(&b).rebuilds == 1);
    scene_release(&a);
    scene_release(&b);
  }
}

/* Twice the boxes, twice the work of a rebuild: counted, not timed. */
static void rebuilds_are_linear(void **state) {
  (void)state;
  double last = 0.0;
  for (int boxes = 50; boxes <= 400; boxes *= 2) {
    scene s;
    make_heap(&s, boxes, 3, 1);
    status_of_heap(&s, 0.0);
    double work = (double)scene_totals(&s).visits / boxes;
    if (last > 0.0)
      check_below(work, 1.5 * last);
    last = work;
    scene_release(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bounces_keep_energy_or_lose_it_to_dashpots),
      cmocka_unit_test(slopes_hold_and_let_slide),
      cmocka_unit_test(fast_boxes_do_not_pass),
      cmocka_unit_test(no_pair_is_missed),
      cmocka_unit_test(rebuilds_are_linear),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
