/* Frames: transversely isotropic blocks as one spring along the axis and three across. */
#include "springs/blocks.h"

/* The cube's body diagonal, side 1, E = 1 (Wei et al. 2006, section 3): k1 along (1, 1, 1), k2
 * across. */
static void body_block(double mu, double s[9], double *k1, double *k2) {
  double c = 1.0 / ((1.0 + mu) * (1.0 - 2.0 * mu));
  *k1 = c * (7.0 - 6.0 * mu) / 72.0;
  *k2 = c * (5.0 - 12.0 * mu) / 144.0;
  for (int e = 0; e < 9; e++)
    s[e] = (*k1 - *k2) / 3.0 + (e % 4 == 0 ? *k2 : 0.0);
}

static void cube_body_diagonal_is_a_frame(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const double expected[4][3] = {{1, 1, 1}, {-1, -1, 2}, {2, -1, -1}, {-1, 2, -1}};
  for (double mu = -0.8; mu < 0.5; mu += 0.1) {
    double s[9], k1, k2;
    cdem_spring_set set;
    body_block(mu, s, &k1, &k2);
    check_ok(cdem_springs_from_block(s, 3, true, &set, &fault));
    assert_int_equal(set.form, CDEM_FORM_FRAME);
    assert_int_equal(set.rows, 4);
    assert_true(isnan(set.cond));
    check_near(set.row[0].stiffness, k1, 1e-14, 0.0);
    for (int r = 0; r < 4; r++) {
      const cdem_spring_row *row = &set.row[r];
      assert_int_equal(row->spring, r + 1);
      assert_int_equal(row->couples_to, 0);
      assert_memory_equal(row->dir, row->dual, sizeof row->dir);
      if (r > 0) /* h = c (5 - 12 mu) / 216 */
        check_near(row->stiffness, k2 * 144.0 / 216.0, 0.0, 1e-14 * (fabs(k1) + fabs(k2)));
      for (int c = 0; c < 3; c++)
        check_near(row->dir[c], expected[r][c] / cdem_norm3(expected[r]), 0.0, 1e-14);
    }
    check_below(cdem_springs_residual(s, &set), 1e-14);
  }
}

/* The source prints c (5 - 12 mu) / 432 for h: half of what the block needs. At mu = 0.3 a set with
 * it misses 10.6 per cent of the largest entry. */
static void printed_value_does_not_rebuild(void **state) {
  (void)state;
  double s[9], rebuilt[9], k1, k2, worst = 0.0, largest = 0.0;
  cdem_spring_set set;
  const double d[3] = {1, 1, 1};
  body_block(0.3, s, &k1, &k2);
  cdem_springs_frame(k1, k2, d, &set);
  for (int r = 1; r < 4; r++)
    set.row[r].stiffness = k2 * 144.0 / 432.0;
  cdem_springs_rebuild(&set, rebuilt);
  for (int e = 0; e < 9; e++) {
    worst = fmax(worst, fabs(rebuilt[e] - s[e]));
    largest = fmax(largest, fabs(s[e]));
  }
  /* Lost on the diagonal: k2/2 * 2/3; the largest entry: (k1 + 2 k2)/3. */
  check_near(worst / largest, k2 / (k1 + 2.0 * k2), 1e-12, 0.0);
  check_near(worst / largest, 0.106, 0.0, 5e-4); /* as printed: three digits */
}

static void rebuild_gives_the_isotropic_plane(void **state) {
  (void)state;
  cdem_random random = {12};
  for (int i = 0; i < 200; i++) {
    double d[3], q[9], s[9], k1 = blocks_uniform(&random), k2 = blocks_uniform(&random);
    cdem_spring_set set;
    blocks_rotation(&random, 3, q);
    for (int c = 0; c < 3; c++)
      d[c] = 7.0 * q[c]; /* need not be of unit length */
    cdem_springs_frame(k1, k2, d, &set);
    cdem_springs_rebuild(&set, s);
    for (int e = 0; e < 9; e++)
      check_near(s[e], (k1 - k2) * q[e / 3] * q[e % 3] + (e % 4 == 0 ? k2 : 0.0), 0.0, 1e-14);
    assert_true(blocks_sign_ok(set.row[0].dir, 3));
  }
}

/* First direction: projection of the least aligned axis; then +120 degrees twice about d. */
static void directions_follow_the_rule(void **state) {
  (void)state;
  const struct {
    double d[3], first[3];
  } known[] = {
      {{1, 1, 1}, {-1, -1, 2}},  {{1, -1, 1}, {-1, 1, 2}},     {{0, 0, 1}, {0, 1, 0}},
      {{1, 0, 0}, {0, 0, 1}},    {{0, 1, 0}, {0, 0, 1}},       {{1, 2, 3}, {13, -2, -3}},
      {{3, 1, 2}, {-3, 13, -2}}, {{-3, -2, -1}, {-3, -2, 13}}, {{1, 1, 0}, {0, 0, 1}},
      {{1, 1, 3}, {-1, 10, -3}},
  };
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
    cdem_spring_set set;
    cdem_springs_frame(2.0, 1.0, known[i].d, &set);
    const double *d = set.row[0].dir;
    check_near(fabs(blocks_dot(d, known[i].d, 3)), cdem_norm3(known[i].d), 1e-15, 0.0);
    for (int c = 0; c < 3; c++)
      check_near(set.row[1].dir[c], known[i].first[c] / cdem_norm3(known[i].first), 0.0, 1e-15);
    for (int r = 1; r < 4; r++) {
      double turned[3];
      const double *from = set.row[r].dir, *to = set.row[1 + r % 3].dir;
      cdem_cross3(from, to, turned);
      check_near(blocks_dot(from, to, 3), -0.5, 0.0, 1e-15);
      check_near(blocks_dot(turned, d, 3), sqrt(0.75), 0.0, 1e-15);
    }
  }
}

/* Which blocks are frames: the relative bound, and not those whose axis has no direction. */
static void recognition_keeps_its_bound(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_random random = {77};
  for (int i = 0; i < 300; i++) {
    double s[9], noise[9], q[9], l[9] = {0}, norm = 0.0;
    cdem_spring_set set;
    l[0] = cdem_random_uniform(&random, 1.5, 3.0);
    l[4] = l[8] = 1.0;
    blocks_rotation(&random, 3, q);
    blocks_similar(3, q, l, true, s);
    for (int e = 0; e < 9; e++)
      noise[e] = blocks_uniform(&random);
    norm = cdem_frobenius(noise, 9) / cdem_frobenius(s, 9);
    /* A transversely isotropic family has 5 of the 9 dimensions near a block: a random step of
     * 1e-12 leaves the bound 2e-13, one of 1e-13 does not. */
    double step = i % 2 == 0 ? 1e-13 : 5e-12;
    for (int e = 0; e < 9; e++)
      s[e] += step / norm * noise[e];
    check_ok(cdem_springs_from_block(s, 3, true, &set, &fault));
    assert_int_equal(set.form == CDEM_FORM_FRAME, i % 2 == 0);
    check_below(cdem_springs_residual(s, &set), CDEM_SPRINGS_BOUND);
  }
}

static void nearly_spherical_blocks_are_diagonal(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_spring_set set;
  double s[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1 + 1e-7};
  check_ok(cdem_springs_from_block(s, 3, true, &set, &fault));
  assert_int_equal(set.form, CDEM_FORM_DIAGONAL);
  s[8] = 1 + 1e-5;
  check_ok(cdem_springs_from_block(s, 3, true, &set, &fault));
  assert_int_equal(set.form, CDEM_FORM_FRAME);
}

/* Frames scale with their block, and only the blocks asked for become frames. */
static void batches_make_frames_where_asked(void **state) {
  (void)state;
  cdem_fault fault = {0};
  enum { COUNT = 21 };
  static double s[3 * 72];
  bool wanted[24];
  cdem_spring_set set[24];
  double block[9], k1, k2;
  body_block(0.2, block, &k1, &k2);
  for (int i = 0; i < 24; i++) {
    wanted[i] = i % 3 == 1;
    for (int e = 0; e < 9; e++)
      s[blocks_place(3, i, e)] = ldexp(block[e], i % 2 == 0 ? 900 : -900);
  }
  check_ok(cdem_springs_from_blocks(s, COUNT, 3, wanted, set, &fault));
  for (int i = 0; i < COUNT; i++) {
    assert_int_equal(set[i].form, wanted[i] ? CDEM_FORM_FRAME : CDEM_FORM_DIAGONAL);
    assert_int_equal(set[i].slow, 0); /* a double value needs no LAPACK */
    check_near(set[i].row[0].stiffness, ldexp(k1, i % 2 == 0 ? 900 : -900), 1e-14, 0.0);
  }
  /* 2x2 blocks have no frames. */
  const double plane[4] = {1, 0, 0, 1};
  check_ok(cdem_springs_from_block(plane, 2, true, &set[0], &fault));
  assert_int_equal(set[0].form, CDEM_FORM_DIAGONAL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cube_body_diagonal_is_a_frame),
      cmocka_unit_test(printed_value_does_not_rebuild),
      cmocka_unit_test(rebuild_gives_the_isotropic_plane),
      cmocka_unit_test(directions_follow_the_rule),
      cmocka_unit_test(recognition_keeps_its_bound),
      cmocka_unit_test(nearly_spherical_blocks_are_diagonal),
      cmocka_unit_test(batches_make_frames_where_asked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
