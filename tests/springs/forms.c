/* Known blocks get the forms, springs and messages they must. */
#include "springs/blocks.h"

enum { FAST, ROBUST, PATHS };

/* One block by either path, frames recognised or not. */
static cdem_spring_set decompose(const double *s, int size, int path, bool frame) {
  cdem_fault fault = {0};
  cdem_spring_set set[8];
  double batch[72];
  bool frames[8] = {frame, frame, frame, frame, frame, frame, frame, frame};
  for (int i = 0; i < 8; i++)
    for (int e = 0; e < size * size; e++)
      batch[blocks_place(size, i, e)] = s[e];
  if (path == ROBUST)
    check_ok(cdem_springs_from_block(s, size, frame, &set[0], &fault));
  else
    check_ok(cdem_springs_from_blocks(batch, 8, size, frames, set, &fault));
  return set[0];
}

static void check_form(const double *s, int size, cdem_form form, int rows) {
  for (int path = 0; path < PATHS; path++) {
    cdem_spring_set set = decompose(s, size, path, false);
    if (set.form != form || (rows > 0 && set.rows != rows))
      blocks_fail(&set, cdem_form_name(form));
    check_below(cdem_springs_residual(s, &set), 1e-13);
    blocks_check_laws(&set);
  }
}

/* P^-1 L P with the unimodular integer P of P^-1 = [[1,1,0],[0,1,1],[0,0,1]] and one of another
 * order: entries stay exact integers. */
static void integer_similar(const double l[9], int which, double s[9]) {
  const double p[2][9] = {{1, 1, 0, 0, 1, 1, 0, 0, 1}, {1, 0, 0, 2, 1, 0, -1, 1, 1}};
  double inverse[9], left[9];
  cdem_inverse3(p[which], inverse); /* determinant 1: exact */
  cdem_product3(p[which], l, left);
  cdem_product3(left, inverse, s);
}

static void exact_defects_are_named(void **state) {
  (void)state;
  const struct {
    double l[9];
    cdem_form form;
    int rows; /* 0: with or without a coupling of spring 1 to 3 */
  } known[] = {
      {{7, 0, 0, 0, 2, 1, 0, 0, 2}, CDEM_FORM_JORDAN2, 3},
      {{-3, 0, 0, 0, 2, 5, 0, 0, 2}, CDEM_FORM_JORDAN2, 3},
      {{2, 0, 0, 0, 2, 1, 0, 0, 2}, CDEM_FORM_JORDAN2, 3}, /* beside an equal third value */
      {{0, 0, 0, 0, 0, 4, 0, 0, 0}, CDEM_FORM_JORDAN2, 3}, /* nilpotent of rank 1 */
      {{2, 1, 0, 0, 2, 1, 0, 0, 2}, CDEM_FORM_JORDAN3, 0},
      {{0, 3, 0, 0, 0, 1, 0, 0, 0}, CDEM_FORM_JORDAN3, 0}, /* nilpotent of rank 2 */
      {{1, 0, 0, 0, 2, 0, 0, 0, 4}, CDEM_FORM_DIAGONAL, 3},
      {{3, 0, 0, 0, 2, 0, 0, 0, 2}, CDEM_FORM_DIAGONAL, 3}, /* double, no defect */
      {{3, 0, 0, 0, 0, 0, 0, 0, 0}, CDEM_FORM_DIAGONAL, 3}, /* rank 1 */
      {{3, 0, 0, 0, 1, 2, 0, -2, 1}, CDEM_FORM_COMPLEX, 3},
  };
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
    for (int which = 0; which < 2; which++) {
      double s[9], factor[3] = {1.0, 0x1p500, 0x1p-500};
      integer_similar(known[i].l, which, s);
      for (int f = 0; f < 3; f++) {
        double scaled[9];
        for (int e = 0; e < 9; e++)
          scaled[e] = s[e] * factor[f];
        check_form(scaled, 3, known[i].form, known[i].rows);
      }
    }
}

static void jordan_rows_hold_their_values_and_chains(void **state) {
  (void)state;
  const double l2[9] = {7, 0, 0, 0, 2, 1, 0, 0, 2}, l3[9] = {2, 1, 0, 0, 2, 1, 0, 0, 2};
  double s[9];
  integer_similar(l2, 0, s);
  cdem_spring_set set = decompose(s, 3, ROBUST, false);
  check_near(set.row[0].stiffness, 7.0, 1e-14, 0.0); /* simple value: rounding times cond */
  check_near(set.row[1].stiffness, 2.0, 1e-13, 0.0);
  assert_true(set.row[1].stiffness == set.row[2].stiffness);
  assert_int_equal(set.row[1].couples_to, 3);
  assert_int_equal(set.row[2].couples_to, 0);
  integer_similar(l3, 1, s);
  set = decompose(s, 3, ROBUST, false);
  for (int k = 0; k < 3; k++)
    check_near(set.row[k].stiffness, 2.0, 1e-15, 0.0); /* a third of the trace */
  assert_int_equal(set.row[0].couples_to, 2);
  assert_int_equal(set.row[1].couples_to, 3);
  assert_int_equal(set.row[2].couples_to, 0);
  assert_int_equal(set.row[3].spring, 1);
  assert_int_equal(set.row[3].couples_to, 3);
}

static void plane_blocks_have_their_forms(void **state) {
  (void)state;
  const struct {
    double s[4];
    cdem_form form;
  } known[] = {
      {{0, 0, 0, 0}, CDEM_FORM_DIAGONAL},  {{5, 0, 0, 5}, CDEM_FORM_DIAGONAL},
      {{1, 2, 2, -3}, CDEM_FORM_DIAGONAL}, {{1, 3, 0, 2}, CDEM_FORM_DIAGONAL},
      {{2, 1, 0, 2}, CDEM_FORM_JORDAN2},   {{0, 0, 3, 0}, CDEM_FORM_JORDAN2},
      {{3, 1, -1, 1}, CDEM_FORM_JORDAN2},  {{0, 1, -1, 0}, CDEM_FORM_COMPLEX},
      {{1, 5, -2, 1}, CDEM_FORM_COMPLEX},  {{2, 1, 1e-16, 2}, CDEM_FORM_JORDAN2},
  };
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
    check_form(known[i].s, 2, known[i].form, 2);
}

/* Values that differ, and couplings that come, by the rounding of the block make no other form. */
static void rounding_chooses_no_form(void **state) {
  (void)state;
  cdem_random random = {41};
  for (int i = 0; i < 300; i++) {
    double q[9], s[9], l[9] = {0};
    l[0] = i % 3 == 0 ? 1.0 : blocks_uniform(&random);
    l[4] = l[8] = i % 3 == 1 ? 0.0 : 1.0; /* sphere, rank one, transversely isotropic */
    blocks_rotation(&random, 3, q);
    blocks_similar(3, q, l, true, s);
    blocks_perturb(&random, 9, 2e-16, s);
    check_form(s, 3, CDEM_FORM_DIAGONAL, 3);
    for (int path = 0; path < PATHS; path++) {
      cdem_spring_set set = decompose(s, 3, path, false);
      check_near(set.cond, 1.0, 1e-12, 0.0); /* orthonormal */
    }
  }
}

/* A double value: its plane's first direction is the projection of the least aligned axis. */
static void double_values_get_documented_directions(void **state) {
  (void)state;
  const double d[3] = {2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0};
  double s[9];
  for (int e = 0; e < 9; e++)
    s[e] = 3.0 * d[e / 3] * d[e % 3] + (e % 4 == 0 ? 1.0 : 0.0);
  for (int path = 0; path < PATHS; path++) {
    cdem_spring_set set = decompose(s, 3, path, false);
    const double first[3] = {45.0 / 49.0, -6.0 / 49.0, -12.0 / 49.0}; /* e_x - d_x d */
    double length = cdem_norm3(first);
    check_near(set.row[0].stiffness, 4.0, 1e-14, 0.0);
    check_near(set.row[1].stiffness, 1.0, 1e-14, 0.0);
    assert_true(set.row[1].stiffness == set.row[2].stiffness);
    for (int c = 0; c < 3; c++) {
      check_near(set.row[0].dir[c], d[c], 0.0, 1e-14);
      check_near(set.row[1].dir[c], -first[c] / length, 0.0, 1e-14); /* last component positive */
    }
  }
}

static void zero_and_spherical_blocks_lie_along_the_axes(void **state) {
  (void)state;
  const double values[] = {0.0, 5.0, -2.5e7, 3e-200};
  for (int size = 2; size <= 3; size++)
    for (int v = 0; v < 4; v++)
      for (int path = 0; path < PATHS; path++) {
        double s[9] = {0};
        for (int i = 0; i < size; i++)
          s[(size + 1) * i] = values[v];
        cdem_spring_set set = decompose(s, size, path, true);
        assert_int_equal(set.form, CDEM_FORM_DIAGONAL);
        assert_int_equal(set.rows, size);
        check_near(set.cond, 1.0, 1e-15, 0.0);
        assert_true(cdem_springs_residual(s, &set) == 0.0);
        for (int k = 0; k < size; k++)
          for (int c = 0; c < 3; c++) {
            assert_true(set.row[k].dir[c] == (c == k) && set.row[k].dual[c] == (c == k));
            assert_true(set.row[k].stiffness == values[v]);
          }
      }
}

/* Eigenvalues and vectors of a hand-made complex block: S p2 = a p2 - b p3, S p3 = b p2 + a p3. */
static void complex_rows_mean_what_they_say(void **state) {
  (void)state;
  const double s[9] = {1, 4, 0, -1, 1, 0, 0, 0, 5};
  for (int path = 0; path < PATHS; path++) {
    cdem_spring_set set = decompose(s, 3, path, false);
    assert_int_equal(set.form, CDEM_FORM_COMPLEX);
    check_near(set.row[0].stiffness, 5.0, 1e-15, 0.0);
    check_near(set.row[1].stiffness, 1.0, 1e-15, 0.0);
    check_near(set.row[1].coupling, 2.0, 1e-15, 0.0); /* sqrt(4 * 1) */
    check_near(set.row[2].coupling, -2.0, 1e-15, 0.0);
    for (int i = 0; i < 3; i++) {
      double sp2 = blocks_dot(s + 3 * i, set.row[1].dir, 3);
      double sp3 = blocks_dot(s + 3 * i, set.row[2].dir, 3);
      check_near(sp2, set.row[1].dir[i] - 2.0 * set.row[2].dir[i], 0.0, 1e-14);
      check_near(sp3, 2.0 * set.row[1].dir[i] + set.row[2].dir[i], 0.0, 1e-14);
    }
  }
}

static void powers_of_two_scale_exactly(void **state) {
  (void)state;
  cdem_random random = {5};
  for (int i = 0; i < 200; i++)
    for (int path = 0; path < PATHS; path++) {
      double s[9], scaled[9];
      blocks_make(&random, (blocks_family)(i % BLOCKS_SCALED), 3, s);
      int exponent = (int)cdem_random_uniform(&random, -500.0, 500.0);
      for (int e = 0; e < 9; e++)
        scaled[e] = ldexp(s[e], exponent);
      cdem_spring_set one = decompose(s, 3, path, false), two = decompose(scaled, 3, path, false);
      assert_int_equal(one.form, two.form);
      for (int r = 0; r < one.rows; r++) {
        assert_true(ldexp(one.row[r].stiffness, exponent) == two.row[r].stiffness);
        assert_true(ldexp(one.row[r].coupling, exponent) == two.row[r].coupling);
        assert_memory_equal(one.row[r].dir, two.row[r].dir, sizeof one.row[r].dir);
        assert_memory_equal(one.row[r].dual, two.row[r].dual, sizeof one.row[r].dual);
      }
    }
}

static void huge_and_tiny_blocks_are_rebuilt(void **state) {
  (void)state;
  cdem_random random = {6};
  for (int i = 0; i < 100; i++)
    for (int path = 0; path < PATHS; path++) {
      double s[9], factor = i % 2 == 0 ? 1e300 : 1e-290;
      for (int e = 0; e < 9; e++)
        s[e] = factor * blocks_uniform(&random);
      cdem_spring_set set = decompose(s, 3, path, false);
      check_below(cdem_springs_residual(s, &set), CDEM_SPRINGS_BOUND);
    }
}

static void skew_fraction_follows_its_definition(void **state) {
  (void)state;
  const double symmetric[4] = {1, 2, 2, 3}, skew[4] = {0, 1e200, -1e200, 0}, zero[9] = {0};
  const double mixed[9] = {1, 2, 0, 0, 1, 0, 0, 0, 1}; /* |S - S^T| = sqrt 8, |S| = sqrt 7 */
  assert_true(cdem_springs_skew(symmetric, 2) == 0.0);
  check_near(cdem_springs_skew(skew, 2), 1.0, 1e-15, 0.0);
  check_near(cdem_springs_skew(mixed, 3), sqrt(8.0 / 7.0) / 2.0, 1e-15, 0.0);
  assert_true(cdem_springs_skew(zero, 3) == 0.0);
}

static void names_are_found(void **state) {
  (void)state;
  for (int f = 0; f < CDEM_FORM_COUNT; f++)
    assert_int_equal(cdem_form_find(cdem_form_name((cdem_form)f)), f);
  for (int c = 0; c < CDEM_CLASS_COUNT; c++)
    assert_int_equal(cdem_class_find(cdem_class_name((cdem_class)c)), c);
  assert_string_equal(cdem_form_name(CDEM_FORM_JORDAN2), "jordan2");
  assert_string_equal(cdem_class_name(CDEM_CLASS_BODY), "body");
  assert_int_equal(cdem_form_find("spiral"), CDEM_FORM_COUNT);
  assert_int_equal(cdem_class_find(""), CDEM_CLASS_COUNT);
}

static void blocks_that_are_not_finite_are_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_spring_set set[40];
  double s[5 * 72], block[9] = {1, 2, 3, 4, 5, INFINITY, 7, 8, 9};
  cdem_random random = {1};
  for (int e = 0; e < 5 * 72; e++)
    s[e] = blocks_uniform(&random);
  memset(set, 1, sizeof set);
  cdem_spring_set before = set[0];
  check_fails(
      cdem_springs_from_block(block, 3, true, &set[0], &fault), CDEM_NUMERIC,
      "stiffness block is not finite: row 2, column 3 is inf; check the element's shape and "
      "material");
  assert_memory_equal(&before, &set[0], sizeof before); /* untouched */
  s[blocks_place(3, 37, 3)] = NAN;
  check_fails(cdem_springs_from_blocks(s, 40, 3, NULL, set, &fault), CDEM_NUMERIC,
              "block 37 of 40: stiffness block is not finite: row 2, column 1 is");
  for (int i = 0; i < 40; i++)
    assert_int_equal(set[i].rows, 0); /* empty */
  check_fails(cdem_springs_from_block(block, 4, true, &set[0], &fault), CDEM_NUMERIC,
              "stiffness block is 4 x 4, and only 2 x 2 and 3 x 3");
  check_fails(cdem_springs_from_blocks(s, 1, 6, NULL, set, &fault), CDEM_NUMERIC,
              "stiffness blocks are 6 x 6, and only 2 x 2 and 3 x 3");
  assert_int_equal(cdem_springs_from_blocks(s, 0, 3, NULL, set, &fault), CDEM_OK);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact_defects_are_named),
      cmocka_unit_test(jordan_rows_hold_their_values_and_chains),
      cmocka_unit_test(plane_blocks_have_their_forms),
      cmocka_unit_test(rounding_chooses_no_form),
      cmocka_unit_test(double_values_get_documented_directions),
      cmocka_unit_test(zero_and_spherical_blocks_lie_along_the_axes),
      cmocka_unit_test(complex_rows_mean_what_they_say),
      cmocka_unit_test(powers_of_two_scale_exactly),
      cmocka_unit_test(huge_and_tiny_blocks_are_rebuilt),
      cmocka_unit_test(skew_fraction_follows_its_definition),
      cmocka_unit_test(names_are_found),
      cmocka_unit_test(blocks_that_are_not_finite_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
