/* The periodic cell: images, wrapping, deformation, flips, servo, and what it refuses. */
#include "dem/store.h"
#include "support/test.h"

static const bool all[3] = {true, true, true};

static cdem_cell make_cell(const bool periodic[3], const double h[9]) {
  cdem_cell cell = {0};
  for (int c = 0; c < 3; c++)
    cell.periodic[c] = periodic[c];
  memcpy(cell.h, h, sizeof cell.h);
  return cell;
}

/* A skewed cell at random, edges in the periodic directions only. */
static cdem_cell random_cell(cdem_random *random, int subset, double skew) {
  bool periodic[3] = {subset & 1, subset & 2, subset & 4};
  double h[9] = {0.0};
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++)
      if (periodic[r] && periodic[c])
        h[3 * r + c] = r == c  ? cdem_random_uniform(random, 1.0, 3.0)
                       : r < c ? cdem_random_uniform(random, -skew, skew)
                               : cdem_random_uniform(random, -0.1, 0.1);
  cdem_cell cell = make_cell(periodic, h);
  for (int c = 0; c < 3; c++)
    cell.corner[c] = cdem_random_uniform(random, -5.0, 5.0);
  return cell;
}

static void test_volume(void **state) {
  (void)state;
  cdem_cell cell = make_cell(all, (double[9]){2, 1, 0.5, 0, 3, 0.25, 0, 0, 4});
  check_near(cdem_cell_volume(3, &cell), 24.0, 1e-15, 0.0);
  double width[3];
  cdem_cell_widths(&cell, width);
  check_near(width[2], 4.0, 1e-15, 0.0);
  check_near(width[0] * sqrt(12.0 * 12.0 + 4.0 * 4.0 + 1.25 * 1.25), 24.0, 1e-14, 0.0);
  cell.periodic[2] = false;
  assert_true(cdem_cell_volume(3, &cell) == 0.0);
  check_near(cdem_cell_volume(2, &cell), 6.0, 1e-15, 0.0);
  cdem_cell_widths(&cell, width);
  assert_true(isinf(width[2]));
  assert_true(cdem_cell_is_periodic(&cell));
  cell.periodic[0] = cell.periodic[1] = false;
  assert_false(cdem_cell_is_periodic(&cell));
}

/* A wrapped place is in the cell, and a whole number of edges away. */
static void test_wrap(void **state) {
  (void)state;
  cdem_random random = {3};
  for (int k = 0; k < 2000; k++) {
    cdem_cell cell = random_cell(&random, 1 + k % 7, 6.0);
    double inverse[9], place[3], turns[3], from[3], before[3];
    cdem_cell_inverse(&cell, inverse);
    for (int c = 0; c < 3; c++)
      before[c] = place[c] = cdem_random_uniform(&random, -20.0, 20.0);
    cdem_cell_wrap_turns(&cell, place, turns);
    for (int c = 0; c < 3; c++)
      from[c] = place[c] - cell.corner[c];
    for (int c = 0; c < 3; c++) {
      double part = cdem_dot3(inverse + 3 * c, from);
      assert_true(!cell.periodic[c] || (part > -1e-12 && part < 1.0 + 1e-12));
      assert_true(turns[c] == round(turns[c]) && (cell.periodic[c] || turns[c] == 0.0));
      double shift = 0.0;
      for (int e = 0; e < 3; e++)
        shift += cell.h[3 * c + e] * turns[e];
      check_near(place[c], before[c] + shift, 0.0, 1e-13 * 400.0);
    }
    /* Out by one edge: the code says which. */
    int code = (int)(cdem_random_next(&random) % 27), back;
    double shift[27][3], inside[3] = {place[0], place[1], place[2]};
    cdem_cell_images(&cell, shift);
    for (int c = 0; c < 3; c++)
      inside[c] += shift[code][c];
    back = cdem_cell_wrap(&cell, inside);
    for (int c = 0; c < 3; c++)
      check_near(inside[c], place[c], 0.0, 1e-11);
    int edges[3], out[3];
    cdem_image_edges(code, edges);
    cdem_image_edges(back, out);
    for (int c = 0; c < 3; c++)
      assert_int_equal(out[c], cell.periodic[c] ? -edges[c] : 0);
    assert_int_equal(cdem_image_code(edges), code);
  }
}

/* Against a search through many images. */
static void test_nearest(void **state) {
  (void)state;
  cdem_random random = {5};
  for (int k = 0; k < 300; k++) {
    cdem_cell cell = random_cell(&random, 1 + k % 7, 3.0);
    double difference[3], least = INFINITY;
    for (int c = 0; c < 3; c++)
      difference[c] = cdem_random_uniform(&random, -6.0, 6.0);
    int n[3], most[3];
    for (int c = 0; c < 3; c++)
      most[c] = cell.periodic[c] ? 14 : 0;
    for (n[0] = -most[0]; n[0] <= most[0]; n[0]++)
      for (n[1] = -most[1]; n[1] <= most[1]; n[1]++)
        for (n[2] = -most[2]; n[2] <= most[2]; n[2]++) {
          double image[3];
          for (int r = 0; r < 3; r++)
            image[r] = difference[r] + cell.h[3 * r] * n[0] + cell.h[3 * r + 1] * n[1] +
                       cell.h[3 * r + 2] * n[2];
          least = fmin(least, cdem_norm3(image));
        }
    cdem_cell_nearest(&cell, difference);
    check_near(cdem_norm3(difference), least, 1e-12, 0.0);
  }
}

/* Second order: half the step, a quarter of the error. */
static void test_advance(void **state) {
  (void)state;
  static const double l[9] = {0.3, 0.5, -0.2, 0.0, -0.2, 0.4, 0.1, 0.0, 0.25};
  static const double h[9] = {2, 1, 0.5, 0, 3, 0.25, 0, 0, 4};
  double error[2];
  for (int k = 0; k < 2; k++) {
    int steps = 64 << k;
    cdem_cell cell = make_cell(all, h);
    for (int i = 0; i < steps; i++)
      cdem_cell_advance(&cell, l, 1.0 / steps);
    /* d ln(volume)/dt = trace L */
    error[k] = fabs(cdem_cell_volume(3, &cell) / (24.0 * exp(0.35)) - 1.0);
  }
  check_near(error[0] / error[1], 4.0, 0.05, 0.0);
  check_below(error[1], 1e-4);
}

/* Shear on and on: the cell stays short, wide and of the same lattice. */
static void test_flip(void **state) {
  (void)state;
  static const double l[9] = {0.0, 1.0, 0.5, 0.0, 0.0, 0.7, 0.0, 0.0, 0.0};
  static const double h[9] = {2, 0, 0, 0, 3, 0, 0, 0, 2.5};
  cdem_cell cell = make_cell(all, h);
  int flips = 0, turns[9];
  for (int k = 0; k < 1000; k++) {
    cdem_cell_advance(&cell, l, 0.01);
    cdem_cell old = cell;
    if (!cdem_cell_flip(&cell, turns)) {
      assert_memory_equal(old.h, cell.h, sizeof cell.h);
      continue;
    }
    flips++;
    /* Old edge c is turns[., c] new edges. */
    for (int c = 0; c < 3; c++)
      for (int r = 0; r < 3; r++) {
        double sum = 0.0;
        for (int d = 0; d < 3; d++)
          sum += cell.h[3 * r + d] * turns[3 * d + c];
        check_near(sum, old.h[3 * r + c], 1e-12, 1e-12);
      }
    double width[3];
    cdem_cell_widths(&cell, width);
    for (int c = 0; c < 3; c++)
      check_below(1.0, width[c]);
    check_near(cdem_cell_volume(3, &cell), 15.0, 1e-10, 0.0);
  }
  assert_true(flips >= 10);
}

static double rate_at(const cdem_cell *cell, double stress, double bulk) {
  double sigma[9] = {0.0}, rate[9] = {0.0};
  sigma[4] = stress;
  cdem_cell_rate(cell, 0.0, sigma, &(cdem_cell_answer){1e-3, bulk, 1e-3, 0.0}, rate);
  return rate[4];
}

/* Dashpots alone, which answer within a step and three times as hard as is known: at any step the
 * rate comes to a rest, on the way with no turn that a halved step does not halve. */
static double largest_jump(const cdem_cell *cell, double step, double *pressure) {
  const cdem_cell_answer answer = {step, 1e6, 1e-2, 1e4}; /* of 1e-2 s: viscosity over stiffness */
  double sigma[9] = {0.0}, rate[9] = {0.0}, elastic = 0.0, jump = 0.0;
  for (int k = 0; k < (int)(2.0 / step); k++) {
    double before = rate[4];
    cdem_cell_rate(cell, 0.0, sigma, &answer, rate);
    jump = fmax(jump, fabs(rate[4] - before));
    elastic -= answer.bulk * rate[4] * step;
    sigma[4] = -elastic + 3.0 * answer.viscosity * rate[4];
  }
  *pressure = elastic;
  return jump;
}

static void test_servo(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_cell cell = make_cell(all, (double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1});
  cell.servo[1] = true;
  cell.servo_rate = 2.0;
  check_ok(cdem_series_constant(1000.0, &cell.stress[1], &fault));
  check_ok(cdem_series_constant(0.125, &cell.rate[1], &fault));
  check_ok(cdem_cell_check(3, &cell, &fault));
  /* Pressure 1000 is wanted. */
  assert_true(rate_at(&cell, -1000.0, 1e6) == 0.0);
  check_near(rate_at(&cell, -1001.0, 1e6), 0.25 * 1.0 / (1e6 * 1e-3), 1e-12, 0.0); /* expands */
  check_near(rate_at(&cell, -999.0, 1e6), -0.25 * 1.0 / (1e6 * 1e-3), 1e-12, 0.0);
  assert_true(rate_at(&cell, 0.0, 1.0) == -2.0);
  assert_true(rate_at(&cell, -1e9, 1.0) == 2.0);
  assert_true(rate_at(&cell, 0.0, 0.0) == -2.0); /* no contacts: as fast as it may */
  cell.servo_gain = 0.5;
  check_near(rate_at(&cell, -1001.0, 1e6), 0.5 * 1.0 / (1e6 * 1e-3), 1e-12, 0.0);
  double zero[9] = {0.0}, rate[9] = {0.0};
  cdem_cell_rate(&cell, 3.0, zero, &(cdem_cell_answer){1e-3, 1e6, 1e-3, 0.0}, rate);
  assert_true(rate[1] == 0.125 && rate[0] == 0.0 && rate[8] == 0.0);
  /* A packing of this stiffness comes to the pressure: dp = -K rate dt. */
  double pressure = 0.0;
  for (int k = 0; k < 2000; k++)
    pressure -= 1e6 * 1e-3 * rate_at(&cell, -pressure, 1e6);
  check_near(pressure, 1000.0, 1e-9, 0.0);
  double jump = largest_jump(&cell, 1e-4, &pressure);
  check_near(pressure, 1000.0, 1e-3, 0.0);
  check_near(largest_jump(&cell, 5e-5, &pressure), 0.5 * jump, 0.1, 0.0);
  cdem_series_release(&cell.stress[1]);
  cdem_series_release(&cell.rate[1]);
}

static void test_errors(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static const double h[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  cdem_cell cell = make_cell(all, h);
  check_ok(cdem_cell_check(3, &cell, &fault));
  check_fails(cdem_cell_check(2, &cell, &fault), CDEM_INPUT,
              "plane model cannot be periodic along z");
  cell.h[4] = 0.0;
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "edge y has the length 0 m");
  cell.h[1] = 1.0;
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "edges that are not parallel");
  cell = make_cell((const bool[3]){true, false, false}, h);
  cell.h[3] = 0.5;
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT,
              "edge x has a component of 0.5 m along y, which is not periodic");
  cell.h[3] = 0.0;
  check_ok(cdem_series_constant(0.125, &cell.rate[1], &fault));
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "rate xy crosses direction y");
  cdem_series_release(&cell.rate[1]);
  cell.corner[0] = NAN;
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "corner has x = nan");
  cell.corner[0] = 0.0;
  cell.servo[1] = true;
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "a stress is wanted along y");
  cell.servo[1] = false;
  cell.servo[0] = true;
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "largest rate of the servo is 0");
  cell.servo_rate = 1.0;
  cell.servo_gain = -1.0;
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "gain of the servo is -1");
  cell.servo_gain = 0.0;
  check_ok(cdem_series_constant(0.125, &cell.rate[0], &fault));
  check_fails(cdem_cell_check(3, &cell, &fault), CDEM_INPUT, "both a rate and a stress");
  cdem_series_release(&cell.rate[0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_volume),  cmocka_unit_test(test_wrap),
                                     cmocka_unit_test(test_nearest), cmocka_unit_test(test_advance),
                                     cmocka_unit_test(test_flip),    cmocka_unit_test(test_servo),
                                     cmocka_unit_test(test_errors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
