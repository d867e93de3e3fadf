/* A membrane by itself: closed forms, gradients, invariance, its book and its bits. */
#include "membrane_model.h"

#include <math.h>

/* ---- pressure ---- */

/* Sum over a closed surface of (x, y, 0) . n dA = 2 V, and linear fields are integrated exactly. */
static void pressure_does_two_volumes_of_work_per_swelling(void **state) {
  (void)state;
  tube t;
  cdem_membrane_shape shape;
  tube_init(&t, 3e4);
  tube_make(&t);
  tube_crumple(&t, 2e-3, 5);
  cdem_membrane_shape_now(&t.membrane, &shape);
  double sum = 0.0;
  for (int32_t i = 0; i < t.membrane.nodes; i++)
    for (int c = 0; c < 2; c++)
      sum += t.membrane.force[3 * i + c] * (t.membrane.x[3 * i + c] - t.options.center[c]);
  check_near(sum, -2.0 * t.value * shape.volume, 1e-12, 0.0);
  cdem_membrane_release(&t.membrane);
}

/* The hoop force of a thin tube, p R: half a tube is pushed by p 2 R H. */
static void half_a_tube_is_pushed_by_its_shadow(void **state) {
  (void)state;
  tube t;
  tube_init(&t, 2e4);
  t.options.spacing = 0.005;
  tube_make(&t);
  cdem_membrane_evaluate(&t.membrane, 0.0);
  double sum = 0.0;
  for (int32_t i = 0; i < t.membrane.nodes; i++)
    if (t.membrane.x[3 * i] > t.options.center[0])
      sum += t.membrane.force[3 * i];
  double expected = -t.value * 2.0 * t.options.radius * (t.options.high - t.options.low);
  check_near(sum, expected, 1e-3, 0.0); /* polygons of 126 corners: 1 - cos(pi/126) = 3e-4 */
  cdem_membrane_release(&t.membrane);
}

static void end_area(const tube *t, int32_t ring, double area[3]) {
  const cdem_membrane *m = &t->membrane;
  memset(area, 0, 3 * sizeof *area);
  for (int32_t j = 0; j < m->around; j++) {
    const double *a = m->x + 3 * (ring * m->around + j),
                 *b = m->x + 3 * (ring * m->around + (j + 1) % m->around);
    double n[3];
    cdem_cross3(a, b, n);
    for (int c = 0; c < 3; c++)
      area[c] += 0.5 * n[c];
  }
}

/* A closed surface is not pushed anywhere: what the side gets, both ends would give back. */
static void pressure_on_all_sides_is_no_force(void **state) {
  (void)state;
  tube t;
  double force[3], moment[3], scale, low[3], high[3];
  tube_init(&t, 1e5);
  tube_make(&t);
  tube_crumple(&t, 3e-3, 8);
  tube_sums(&t, force, moment, &scale);
  end_area(&t, 0, low);
  end_area(&t, t.membrane.rings - 1, high);
  for (int c = 0; c < 3; c++)
    check_near(force[c], t.value * (high[c] - low[c]), 0.0, 1e-13 * scale);
  cdem_membrane_release(&t.membrane);
}

static void forces_of_pressure_are_the_gradient_of_the_volume(void **state) {
  (void)state;
  tube t;
  tube_init(&t, 1e5);
  tube_make(&t);
  tube_crumple(&t, 3e-3, 9);
  cdem_membrane *m = &t.membrane;
  const double by = 1e-4; /* the volume is linear in each place */
  for (int32_t at = 3 * m->around; at < 3 * (m->nodes - m->around); at += 97) {
    double x = m->x[at], volume[2];
    cdem_membrane_evaluate(m, 0.0);
    double force = m->force[at];
    for (int k = 0; k < 2; k++) {
      m->x[at] = x + (k - 0.5) * by;
      cdem_membrane_evaluate(m, 0.0);
      volume[k] = cdem_membrane_volume(m);
    }
    m->x[at] = x;
    check_near(force, -t.value * (volume[1] - volume[0]) / by, 1e-7, 1e-9 * t.value * m->area[0]);
  }
  cdem_membrane_release(m);
}

/* V = n/2 sin(2 pi/n) R^2 H of a straight prism; turned rings make it smaller by O(1/n^2). */
static void volume_and_its_rate_are_those_of_a_cylinder(void **state) {
  (void)state;
  tube t;
  cdem_membrane_shape shape;
  tube_init(&t, 0.0);
  t.options.spacing = 0.004;
  tube_make(&t);
  for (int32_t i = 0; i < t.membrane.nodes; i++)
    for (int c = 0; c < 2; c++)
      t.membrane.v[3 * i + c] = 0.5 * (t.membrane.x[3 * i + c] - t.options.center[c]);
  cdem_membrane_evaluate(&t.membrane, 0.0);
  cdem_membrane_shape_now(&t.membrane, &shape);
  double radius = t.options.radius, height = t.options.high - t.options.low;
  check_near(shape.volume, M_PI * radius * radius * height, 2e-3, 0.0);
  check_near(shape.rate, 2.0 * 0.5 * shape.volume, 1e-12, 0.0);
  check_near(shape.area, 2.0 * M_PI * radius * height, 1e-3, 0.0);
  check_near(shape.height, height, 1e-14, 0.0);
  cdem_membrane_release(&t.membrane);
}

/* ---- stretch and bending ---- */

static void forces_are_minus_the_gradient_of_the_energy(void **state) {
  (void)state;
  for (int which = 0; which < 3; which++) {
    tube t;
    tube_init(&t, 0.0);
    t.options.young = which != 1 ? 1e6 : 0.0;
    t.options.bending = which != 0 ? 20.0 : 0.0;
    tube_make(&t);
    tube_crumple(&t, 2e-3, 11);
    cdem_membrane *m = &t.membrane;
    double largest = 0.0, by = 1e-6;
    for (int32_t k = 0; k < 3 * m->nodes; k++)
      largest = fmax(largest, fabs(m->force[k]));
    for (int32_t at = 1; at < 3 * m->nodes; at += 61) {
      double x = m->x[at], energy[2];
      for (int k = 0; k < 2; k++) {
        m->x[at] = x + (k - 0.5) * by;
        energy[k] = tube_energy(&t);
      }
      m->x[at] = x;
      cdem_membrane_evaluate(m, 0.0);
      check_near(m->force[at], -(energy[1] - energy[0]) / by, 0.0, 1e-6 * largest);
    }
    cdem_membrane_release(m);
  }
}

static void inner_forces_have_no_sum_and_no_moment_about_the_axis(void **state) {
  (void)state;
  tube t;
  double force[3], moment[3], scale;
  tube_init(&t, 0.0);
  t.options.young = 1e6;
  t.options.bending = 20.0;
  tube_make(&t);
  tube_crumple(&t, 4e-3, 12);
  tube_sums(&t, force, moment, &scale);
  for (int c = 0; c < 3; c++)
    check_near(force[c], 0.0, 0.0, 1e-13 * scale);
  check_near(moment[2], 0.0, 0.0, 1e-13 * scale);
  cdem_membrane_release(&t.membrane);
}

/* Turned about any axis and carried away: nothing is felt. */
static void a_rigid_motion_is_no_force(void **state) {
  (void)state;
  const double axis[3] = {0.6, -0.48, 0.64}, angle = 0.7;
  tube t;
  tube_init(&t, 0.0);
  t.options.young = 1e6;
  t.options.bending = 20.0;
  tube_make(&t);
  double largest = 0.0, edge = t.options.young * t.options.thickness * t.options.spacing;
  for (int32_t i = 0; i < t.membrane.nodes; i++) {
    double *x = t.membrane.x + 3 * i, cross[3], along = cdem_dot3(axis, x);
    cdem_cross3(axis, x, cross);
    for (int c = 0; c < 3; c++)
      x[c] = cos(angle) * x[c] + sin(angle) * cross[c] + (1.0 - cos(angle)) * along * axis[c] + 0.3;
  }
  cdem_membrane_evaluate(&t.membrane, 0.0);
  for (int32_t k = 0; k < 3 * t.membrane.nodes; k++)
    largest = fmax(largest, fabs(t.membrane.force[k]));
  check_below(largest, 1e-11 * edge);
  cdem_membrane_release(&t.membrane);
}

/* However crumpled, bending does not press on what is inside: no work when the tube swells. */
static void bending_does_not_confine(void **state) {
  (void)state;
  tube t;
  tube_init(&t, 0.0);
  t.options.bending = 20.0;
  tube_make(&t);
  tube_crumple(&t, 4e-3, 13);
  double sum = 0.0, scale = 0.0;
  for (int32_t i = 0; i < t.membrane.nodes; i++)
    for (int c = 0; c < 2; c++) {
      double work = t.membrane.force[3 * i + c] * (t.membrane.x[3 * i + c] - t.options.center[c]);
      sum += work;
      scale += fabs(work);
    }
  check_near(sum, 0.0, 0.0, 1e-12 * scale);
  cdem_membrane_release(&t.membrane);
}

/* Uniform hoop strain e = (l^2 - 1)/2: energy Y t/(1 - nu^2) e^2/2 by area, which is felt as a
 * pressure of S/R on the swollen tube, S = Y t e/(1 - nu^2). */
static void a_swollen_tube_pulls_like_a_hoop(void **state) {
  (void)state;
  const double swell = 1.1, e = 0.5 * (swell * swell - 1.0);
  tube t;
  cdem_membrane_shape shape;
  tube_init(&t, 0.0);
  t.options.young = 2e6;
  t.options.spacing = 0.005;
  tube_make(&t);
  double area = 0.0, work = 0.0;
  for (int32_t i = 0; i < t.membrane.nodes; i++) {
    area += t.membrane.area[i];
    for (int c = 0; c < 2; c++)
      t.membrane.x[3 * i + c] =
          t.options.center[c] + swell * (t.membrane.x[3 * i + c] - t.options.center[c]);
  }
  double plane = t.options.young * t.options.thickness / (1.0 - 0.3 * 0.3);
  check_near(tube_energy(&t), 0.5 * plane * e * e * area, 2e-3, 0.0);
  for (int32_t i = 0; i < t.membrane.nodes; i++)
    for (int c = 0; c < 2; c++)
      work += t.membrane.force[3 * i + c] * (t.membrane.x[3 * i + c] - t.options.center[c]);
  cdem_membrane_shape_now(&t.membrane, &shape);
  double pressure = -0.5 * work / shape.volume;
  check_near(pressure, plane * e / t.options.radius, 2e-3, 0.0);
  cdem_membrane_release(&t.membrane);
}

/* A wave along the tube, w = a cos(q z) out of it, of which only bending remains: B (q^2 a)^2/4. */
static void long_waves_have_the_stiffness_that_was_asked_for(void **state) {
  (void)state;
  const double a = 1e-4;
  tube t;
  tube_init(&t, 0.0);
  t.options.bending = 20.0;
  t.options.spacing = 0.004;
  tube_make(&t);
  double q = 4.0 * M_PI / (t.options.high - t.options.low), area = 0.0;
  for (int32_t i = 0; i < t.membrane.nodes; i++) {
    double *x = t.membrane.x + 3 * i,
           turn = atan2(x[1] - t.options.center[1], x[0] - t.options.center[0]);
    double out = a * cos(q * (x[2] - t.options.low));
    area += t.membrane.area[i];
    x[0] += out * cos(turn);
    x[1] += out * sin(turn);
  }
  double bend = q * q * a;
  /* 4 % at the ends, whose rings bend in their own plane only */
  check_near(tube_energy(&t), 0.25 * t.options.bending * bend * bend * area, 0.05, 0.0);
  cdem_membrane_release(&t.membrane);
}

/* ---- in motion ---- */

static double book(tube *t, double step, double *stored) {
  cdem_membrane_energies e;
  cdem_membrane_energies_now(&t->membrane, step, &e);
  *stored = e.stretch + e.bending;
  return e.kinetic + *stored + e.damping - e.pressure - e.plates;
}

static double stable_step(const tube *t) {
  double k, c;
  cdem_membrane_bounds(&t->membrane, &k, &c);
  return 4.0 / (c + sqrt(c * c + 4.0 * k));
}

static void go(tube *t, double step, int steps, double low, double high) {
  for (int i = 0; i < steps; i++) {
    cdem_membrane_move(&t->membrane, step, low, high);
    cdem_membrane_evaluate(&t->membrane, 0.0);
  }
}

/* Squeezed by its ends under a pressure, with all kinds of damping. */
static void the_book_of_an_oscillation_closes(void **state) {
  (void)state;
  for (int damped = 0; damped < 2; damped++) {
    tube t;
    double stored = 0.0, most = 0.0, worst = 0.0;
    tube_init(&t, -1e3);
    t.options.young = 1e6;
    t.options.bending = 2.0;
    t.options.damping = damped ? 0.1 : 0.0;
    tube_make(&t);
    t.membrane.drag = damped ? 20.0 : 0.0;
    cdem_membrane_evaluate(&t.membrane, 0.0);
    double step = 0.05 * stable_step(&t);
    cdem_membrane_change_step(&t.membrane, 0.0, step);
    double start = book(&t, step, &stored);
    for (int i = 0; i < 40; i++) {
      go(&t, step, 50, 0.2, -0.2);
      worst = fmax(worst, fabs(book(&t, step, &stored) - start));
      most = fmax(most, stored);
    }
    assert_true(most > 0.0);
    check_below(worst, 2e-3 * most);
    cdem_membrane_energies e;
    cdem_membrane_energies_now(&t.membrane, step, &e);
    assert_true(damped ? e.damping > 0.0 : e.damping == 0.0);
    cdem_membrane_release(&t.membrane);
  }
}

static void the_bound_of_the_step_is_stable(void **state) {
  (void)state;
  for (int which = 0; which < 2; which++) {
    tube t;
    tube_init(&t, 0.0);
    t.options.young = which == 0 ? 1e7 : 1e4;
    t.options.bending = which == 0 ? 0.1 : 50.0;
    t.options.damping = 0.2;
    tube_make(&t);
    tube_crumple(&t, 2e-4, 21);
    double stored, most, step = stable_step(&t);
    book(&t, 0.0, &most);
    go(&t, step, 3000, 0.0, 0.0);
    book(&t, step, &stored);
    check_below(stored, 10.0 * most);
    cdem_membrane_release(&t.membrane);
  }
}

/* Lengths and times doubled, masses eightfold: the same bits but for the exponents. */
static void a_scaled_tube_has_scaled_bits(void **state) {
  (void)state;
  tube t[2];
  for (int k = 0; k < 2; k++) {
    double h = k == 0 ? 1.0 : 2.0;
    tube_init(&t[k], 3e4);
    t[k].options = (cdem_membrane_options){.center = {0.05 * h, -0.02 * h},
                                           .radius = 0.1 * h,
                                           .low = -0.1 * h,
                                           .high = 0.2 * h,
                                           .poisson = 0.3,
                                           .pressure = t[k].options.pressure};
    cdem_membrane_complete(&t[k].options, 3e4, 0.06 * h, 2600.0);
    tube_make(&t[k]);
    cdem_membrane_evaluate(&t[k].membrane, 0.0);
    go(&t[k], 0.1 * stable_step(&t[k]), 200, 0.0, -0.1);
  }
  assert_int_equal(t[0].membrane.nodes, t[1].membrane.nodes);
  for (int32_t i = 0; i < 3 * t[0].membrane.nodes; i++) {
    assert_true(t[1].membrane.x[i] == 2.0 * t[0].membrane.x[i]);
    assert_true(t[1].membrane.v[i] == t[0].membrane.v[i]);
    assert_true(t[1].membrane.force[i] == 4.0 * t[0].membrane.force[i]);
  }
  for (int k = 0; k < 2; k++)
    cdem_membrane_release(&t[k].membrane);
}

static void a_restored_tube_goes_on_to_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  tube t[2];
  cdem_state kept = {0};
  double step = 0.0;
  for (int k = 0; k < 2; k++) {
    tube_init(&t[k], 3e4);
    t[k].options.young = 1e6;
    t[k].options.bending = 2.0;
    t[k].options.damping = 0.2;
    tube_make(&t[k]);
    cdem_membrane_evaluate(&t[k].membrane, 0.0);
    step = 0.2 * stable_step(&t[k]);
  }
  go(&t[0], step, 100, 0.0, -0.1);
  check_ok(cdem_membrane_save(&t[0].membrane, &kept, &fault));
  check_ok(cdem_membrane_restore(&t[1].membrane, &kept, &fault));
  cdem_state_release(&kept);
  for (int k = 0; k < 2; k++)
    go(&t[k], step, 100, 0.0, -0.1);
  size_t bytes = (size_t)t[0].membrane.nodes * 3 * sizeof(double);
  assert_memory_equal(t[0].membrane.x, t[1].membrane.x, bytes);
  assert_memory_equal(t[0].membrane.force, t[1].membrane.force, bytes);
  double stored[2];
  assert_true(book(&t[0], step, &stored[0]) == book(&t[1], step, &stored[1]));
  for (int k = 0; k < 2; k++)
    cdem_membrane_release(&t[k].membrane);
}

static void clamped_ends_stay_where_they_are_across(void **state) {
  (void)state;
  tube t;
  tube_init(&t, 1e4);
  t.options.clamped = true;
  t.options.bending = 2.0;
  tube_make(&t);
  cdem_membrane_evaluate(&t.membrane, 0.0);
  double step = 0.2 * stable_step(&t);
  go(&t, step, 50, 0.0, -0.1);
  const double *x = t.membrane.x, *was = t.membrane.start;
  int32_t last = 3 * (t.membrane.nodes - 1), middle = 3 * (t.membrane.nodes / 2);
  assert_true(x[last] == was[last] && x[last + 1] == was[last + 1]);
  check_near(x[last + 2], was[last + 2] - 50 * step * 0.1, 1e-12, 0.0);
  assert_true(x[middle] != was[middle]);
  cdem_membrane_release(&t.membrane);
}

/* ---- what cannot be ---- */

static void grains_do_not_fit_between_nodes(void **state) {
  (void)state;
  cdem_fault fault = {0};
  tube t;
  tube_init(&t, 0.0);
  check_ok(cdem_membrane_check(&t.options, 0.04, &fault));
  check_fails(cdem_membrane_check(&t.options, 0.039, &fault), CDEM_INPUT,
              "let grains of 0.039 m through");
  t.options.radius = -1.0;
  check_fails(cdem_membrane_check(&t.options, 0.0, &fault), CDEM_INPUT,
              "the radius -1 m; it is positive");
  t.options.radius = 0.1;
  t.options.poisson = 0.6;
  check_fails(cdem_membrane_check(&t.options, 0.0, &fault), CDEM_INPUT, "Poisson's ratio 0.6");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_does_two_volumes_of_work_per_swelling),
      cmocka_unit_test(half_a_tube_is_pushed_by_its_shadow),
      cmocka_unit_test(pressure_on_all_sides_is_no_force),
      cmocka_unit_test(forces_of_pressure_are_the_gradient_of_the_volume),
      cmocka_unit_test(volume_and_its_rate_are_those_of_a_cylinder),
      cmocka_unit_test(forces_are_minus_the_gradient_of_the_energy),
      cmocka_unit_test(inner_forces_have_no_sum_and_no_moment_about_the_axis),
      cmocka_unit_test(a_rigid_motion_is_no_force),
      cmocka_unit_test(bending_does_not_confine),
      cmocka_unit_test(a_swollen_tube_pulls_like_a_hoop),
      cmocka_unit_test(long_waves_have_the_stiffness_that_was_asked_for),
      cmocka_unit_test(the_book_of_an_oscillation_closes),
      cmocka_unit_test(the_bound_of_the_step_is_stable),
      cmocka_unit_test(a_scaled_tube_has_scaled_bits),
      cmocka_unit_test(a_restored_tube_goes_on_to_the_same_bits),
      cmocka_unit_test(clamped_ends_stay_where_they_are_across),
      cmocka_unit_test(grains_do_not_fit_between_nodes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
