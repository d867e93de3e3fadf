/* Room springs: critical ratios of pencils. Known roots are asked for to 1e-12 where the form
 * changes and to 1e-9 at touches, the bounds of the program; what is found is far nearer, and the
 * cube is asked for to 1e-13. */
#include "springs/exact.h"
#include "springs/poisson.h"
#include "support/test.h"

/* A + nu B from exact blocks: linear, because lambda and G times the factor are. */
static cdem_pencil exact_pencil(const exact_pair *pair) {
  cdem_pencil pencil = {.size = pair->size, .low = -1.0, .high = 0.5};
  double one[9];
  /* Plane strain: factor lambda = nu, factor G = (1 - 2 nu)/2; plane stress: nu, (1 - nu)/2. */
  exact_lame_block(pair, 0.0, 0.5, pencil.a);
  exact_lame_block(pair, 1.0, pair->plane_stress ? -0.5 : -1.0, one);
  memcpy(pencil.b, one, sizeof one);
  return pencil;
}

static void check_root(const cdem_poisson_root *root, double nu, cdem_form from, cdem_form to,
                       int order, double tolerance) {
  check_near(root->nu, nu, 0, tolerance);
  assert_int_equal(root->from, from);
  assert_int_equal(root->to, to);
  assert_int_equal(root->order, order);
}

static void cube_has_the_known_roots(void **state) {
  (void)state;
  cdem_poisson_roots roots;
  exact_pair pair = exact_cube_pair(CDEM_CLASS_EDGE);
  cdem_pencil pencil = exact_pencil(&pair);
  double change = 5 * sqrt(2.0) / 32, touch = sqrt(3.0) / 8;
  cdem_poisson_find_roots(&pencil, &roots);
  assert_int_equal(roots.count, 4);
  assert_int_equal(roots.start, CDEM_FORM_COMPLEX);
  check_root(&roots.root[0], 0.25 - change, CDEM_FORM_COMPLEX, CDEM_FORM_DIAGONAL, 1, 1e-13);
  check_root(&roots.root[1], 0.25 - touch, CDEM_FORM_DIAGONAL, CDEM_FORM_DIAGONAL, 2, 1e-13);
  check_root(&roots.root[2], 0.25 + touch, CDEM_FORM_DIAGONAL, CDEM_FORM_DIAGONAL, 2, 1e-13);
  check_root(&roots.root[3], 0.25 + change, CDEM_FORM_DIAGONAL, CDEM_FORM_COMPLEX, 1, 1e-13);

  pair = exact_cube_pair(CDEM_CLASS_FACE);
  pencil = exact_pencil(&pair);
  cdem_poisson_find_roots(&pencil, &roots);
  assert_int_equal(roots.count, 2);
  check_root(&roots.root[0], 0.25 - sqrt(2.0) / 4, CDEM_FORM_COMPLEX, CDEM_FORM_DIAGONAL, 1, 1e-13);
  check_root(&roots.root[1], 0.25, CDEM_FORM_DIAGONAL, CDEM_FORM_DIAGONAL, 4, 1e-13);

  pair = exact_cube_pair(CDEM_CLASS_BODY);
  pencil = exact_pencil(&pair);
  cdem_poisson_find_roots(&pencil, &roots);
  assert_int_equal(roots.count, 0);
  assert_true(roots.double_everywhere);
}

/* data/reference/cube-critical-ratios.csv, which `cdem poisson --roots` is compared with. */
static void reference_table_holds_the_roots(void **state) {
  (void)state;
  FILE *file = fopen(CDEM_DATA "/reference/cube-critical-ratios.csv", "r");
  assert_non_null(file);
  char line[128], class_[16], from[16], to[16];
  double nu;
  int row[CDEM_CLASS_COUNT] = {0};
  assert_non_null(fgets(line, sizeof line, file));
  assert_string_equal(line, "class,nu,from,to\n");
  while (fgets(line, sizeof line, file) != NULL) {
    assert_int_equal(sscanf(line, "%15[^,],%lf,%15[^,],%15s", class_, &nu, from, to), 4);
    cdem_class class_of = cdem_class_find(class_);
    exact_pair pair = exact_cube_pair(class_of);
    cdem_pencil pencil = exact_pencil(&pair);
    cdem_poisson_roots roots;
    cdem_poisson_find_roots(&pencil, &roots);
    assert_true(row[class_of] < roots.count);
    const cdem_poisson_root *root = &roots.root[row[class_of]++];
    check_near(root->nu, nu, 0, 1e-13);
    assert_string_equal(cdem_form_name(root->from), from);
    assert_string_equal(cdem_form_name(root->to), to);
  }
  fclose(file);
  assert_int_equal(row[CDEM_CLASS_EDGE], 4);
  assert_int_equal(row[CDEM_CLASS_FACE], 2);
}

static void squares_change_at_zero(void **state) {
  (void)state;
  for (int plane_stress = 0; plane_stress < 2; plane_stress++) {
    exact_pair pair = {2, {1, 1, 0}, {-1, -1}, {1, -1}, 1, plane_stress};
    cdem_pencil pencil = exact_pencil(&pair);
    cdem_poisson_roots roots;
    cdem_poisson_find_roots(&pencil, &roots);
    assert_int_equal(roots.count, 1);
    check_root(&roots.root[0], 0.0, CDEM_FORM_COMPLEX, CDEM_FORM_DIAGONAL, 1, 1e-15);
    pair.far[1] = 1;
    pencil = exact_pencil(&pair);
    cdem_poisson_find_roots(&pencil, &roots);
    assert_int_equal(roots.count, 0);
    assert_int_equal(roots.start, CDEM_FORM_DIAGONAL);
  }
}

/* V (a + nu b) V^-1 with a random V, all in double: the pencil carries rounding as blocks do. */
static cdem_pencil turned(const double a[9], const double b[9], cdem_random *random) {
  cdem_pencil pencil = {.size = 3, .low = -1.0, .high = 0.5};
  double v[9], inverse[9], half[9];
  do
    for (int i = 0; i < 9; i++)
      v[i] = cdem_random_uniform(random, -1, 1);
  while (fabs(cdem_inverse3(v, inverse)) < 0.3);
  cdem_product3(v, a, half);
  cdem_product3(half, inverse, pencil.a);
  cdem_product3(v, b, half);
  cdem_product3(half, inverse, pencil.b);
  return pencil;
}

/* Three lines cross in up to three places; every crossing in the range is found, and nothing else.
 */
static void crossing_lines_are_touches(void **state) {
  (void)state;
  cdem_random random = {11};
  for (int trial = 0; trial < 40; trial++) {
    double a[9] = {0}, b[9] = {0}, crossing[3];
    int crossings = 0;
    for (int i = 0; i < 3; i++) {
      a[4 * i] = cdem_random_uniform(&random, -1, 1);
      b[4 * i] = cdem_random_uniform(&random, -3, 3);
    }
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3;
      double nu = (a[4 * j] - a[4 * i]) / (b[4 * i] - b[4 * j]);
      if (nu > -1 && nu < 0.5)
        crossing[crossings++] = nu;
    }
    cdem_pencil pencil = turned(a, b, &random);
    cdem_poisson_roots roots;
    cdem_poisson_find_roots(&pencil, &roots);
    assert_int_equal(roots.count, crossings);
    for (int i = 0; i < crossings; i++) {
      double nearest = 9;
      for (int j = 0; j < crossings; j++)
        nearest = fmin(nearest, fabs(roots.root[i].nu - crossing[j]));
      /* Lines that cross at a small angle cross where rounding says. */
      check_below(nearest, 1e-9);
      assert_int_equal(roots.root[i].order, 2);
      assert_int_equal(roots.root[i].from, CDEM_FORM_DIAGONAL);
      assert_int_equal(roots.root[i].to, CDEM_FORM_DIAGONAL);
    }
  }
}

/* Pair with discriminant 4 sign (nu - r1)(nu - r2) beside a value far away. */
static void planted_changes_are_found(void **state) {
  (void)state;
  cdem_random random = {12};
  for (int trial = 0; trial < 40; trial++) {
    double r1 = cdem_random_uniform(&random, -0.95, -0.3),
           r2 = cdem_random_uniform(&random, -0.2, 0.45), sign = trial % 2 ? 1 : -1;
    const double a[9] = {1, -r1, 0, -sign * r2, 1, 0, 0, 0, 9},
                 b[9] = {0, 1, 0, sign, 0, 0, 0, 0, 1};
    cdem_pencil pencil = turned(a, b, &random);
    cdem_poisson_roots roots;
    cdem_poisson_find_roots(&pencil, &roots);
    cdem_form outside = sign > 0 ? CDEM_FORM_DIAGONAL : CDEM_FORM_COMPLEX;
    cdem_form inside = sign > 0 ? CDEM_FORM_COMPLEX : CDEM_FORM_DIAGONAL;
    assert_int_equal(roots.count, 2);
    assert_int_equal(roots.start, outside);
    check_root(&roots.root[0], r1, outside, inside, 1, 1e-12);
    check_root(&roots.root[1], r2, inside, outside, 1, 1e-12);
    assert_false(roots.root[0].upper);
  }
}

static cdem_pencil plain(double a11, double a12, double a21, double a22, double b11, double b12,
                         double b21, double b22) {
  return (cdem_pencil){
      .size = 2, .a = {a11, a12, a21, a22}, .b = {b11, b12, b21, b22}, .low = -1, .high = 0.5};
}

static void near_touches_are_not_touches(void **state) {
  (void)state;
  const double r = 0.125, gap[] = {1e-3, 1e-6, 3e-7};
  cdem_poisson_roots roots;
  for (int i = 0; i < 3; i++) {
    double e = gap[i]; /* on top of a common value 1, so that e is relative to the norm */
    cdem_pencil avoided = plain(1 - r, e, e, 1 + r, 1, 0, 0, -1);
    cdem_poisson_find_roots(&avoided, &roots);
    assert_int_equal(roots.count, 0);
    /* The skew twin is complex between r - e and r + e. */
    cdem_pencil island = plain(1 - r, e, -e, 1 + r, 1, 0, 0, -1);
    cdem_poisson_find_roots(&island, &roots);
    assert_int_equal(roots.count, 2);
    check_root(&roots.root[0], r - e, CDEM_FORM_DIAGONAL, CDEM_FORM_COMPLEX, 1, 1e-12);
    check_root(&roots.root[1], r + e, CDEM_FORM_COMPLEX, CDEM_FORM_DIAGONAL, 1, 1e-12);
  }
}

static void complex_pairs_touch_too(void **state) {
  (void)state;
  cdem_poisson_roots roots;
  cdem_pencil pencil = plain(1, 0.25, -0.25, 1, 0, 1, -1, 0);
  cdem_poisson_find_roots(&pencil, &roots);
  assert_int_equal(roots.count, 1);
  check_root(&roots.root[0], -0.25, CDEM_FORM_COMPLEX, CDEM_FORM_COMPLEX, 2, 1e-12);
}

static void three_values_meet(void **state) {
  (void)state;
  cdem_random random = {13};
  const double a[9] = {1, 0, 0, 0, 2, 0, 0, 0, 4}, b[9] = {10, 0, 0, 0, 20, 0, 0, 0, 40};
  cdem_pencil pencil = turned(a, b, &random);
  cdem_poisson_roots roots;
  for (int i = 0; i < 3; i++)
    pencil.a[4 * i] += 3;
  cdem_poisson_find_roots(&pencil, &roots);
  assert_int_equal(roots.count, 1);
  check_root(&roots.root[0], -0.1, CDEM_FORM_DIAGONAL, CDEM_FORM_DIAGONAL, 6, 1e-9);
  assert_true(roots.root[0].triple);
  /* A value that is double everywhere, and meets the third. */
  const double a2[9] = {1, 0, 0, 0, 1, 0, 0, 0, 3}, b2[9] = {2, 0, 0, 0, 2, 0, 0, 0, -3};
  pencil = turned(a2, b2, &random);
  cdem_poisson_find_roots(&pencil, &roots);
  assert_true(roots.double_everywhere);
  assert_int_equal(roots.count, 1);
  check_near(roots.root[0].nu, 0.4, 0, 1e-9);
}

/* Two values that touch while a coupling stays: [[1 + n, 1], [0, 1 - n]] over n = nu - r. Rounding
 * of the corner that should be zero parts the touch into two changes of form, or lifts it; it must
 * be one touch either way. */
static void touches_with_a_defect_survive_rounding(void **state) {
  (void)state;
  const double corner[] = {0, 1e-16, -1e-16, 5e-16, -5e-16};
  cdem_poisson_roots roots;
  for (int i = 0; i < 5; i++) {
    cdem_pencil pencil = plain(1.3, 1, corner[i], 0.7, 1, 0, 0, -1);
    cdem_poisson_find_roots(&pencil, &roots);
    assert_int_equal(roots.count, 1);
    check_root(&roots.root[0], -0.3, CDEM_FORM_DIAGONAL, CDEM_FORM_DIAGONAL, 2, 1e-12);
    /* The same at an end is none. */
    pencil = plain(0.5, 1, corner[i], 1.5, 1, 0, 0, -1);
    cdem_poisson_find_roots(&pencil, &roots);
    assert_int_equal(roots.count, 0);
  }
}

static void ends_are_excluded(void **state) {
  (void)state;
  cdem_poisson_roots roots;
  for (int end = 0; end < 2; end++) {
    double r = end == 0 ? -1.0 : 0.5;
    cdem_pencil change = plain(0, -r, 1, 0, 0, 1, 0, 0), touch = plain(-r, 0, 0, r, 1, 0, 0, -1);
    cdem_poisson_find_roots(&change, &roots);
    assert_int_equal(roots.count, 0);
    cdem_poisson_find_roots(&touch, &roots);
    assert_int_equal(roots.count, 0);
  }
}

/* ---- brute force: the sign of the discriminant straight from the blocks ---- */

static double brute_discriminant(const exact_pair *pair, double nu) {
  double s[9] = {0}, m[9], square[9];
  int n = pair->size;
  exact_block(pair, nu, s);
  double norm = cdem_frobenius(s, n * n);
  for (int i = 0; i < n * n; i++)
    s[i] /= norm;
  if (n == 2)
    return (s[0] - s[3]) * (s[0] - s[3]) + 4 * s[1] * s[2];
  double mean = (s[0] + s[4] + s[8]) / 3;
  for (int i = 0; i < 9; i++)
    m[i] = s[i] - (i % 4 == 0 ? mean : 0);
  cdem_product3(m, m, square);
  double j2 = 0.5 * (square[0] + square[4] + square[8]), j3 = cdem_det3(m);
  return 4 * j2 * j2 * j2 - 27 * j3 * j3;
}

/* On every point of a grid whose sign is not rounding's, and in the middle of every interval
 * between roots, the block has the form that the roots tell. So each change of sign lies between
 * grid points that a root separates, and no root is invented. */
static void compare_forms(const exact_pair *pair, int steps) {
  cdem_pencil pencil = exact_pencil(pair);
  cdem_poisson_roots roots;
  cdem_poisson_find_roots(&pencil, &roots);
  for (int i = 1; i < steps + roots.count; i++) {
    int middle = i - steps, below = 0;
    double nu = i < steps ? -1 + 1.5 * i / steps
                          : 0.5 * (roots.root[middle].nu +
                                   (middle + 1 < roots.count ? roots.root[middle + 1].nu : 0.5));
    double d = brute_discriminant(pair, nu);
    if (fabs(d) < 1e-15)
      continue;
    while (below < roots.count && roots.root[below].nu < nu)
      below++;
    cdem_form form = below == 0 ? roots.start : roots.root[below - 1].to;
    assert_int_equal(form, d > 0 ? CDEM_FORM_DIAGONAL : CDEM_FORM_COMPLEX);
  }
  for (int i = 0; i < roots.count; i++)
    assert_int_equal(roots.root[i].from, i == 0 ? roots.start : roots.root[i - 1].to);
}

static void bricks_agree_with_brute_force(void **state) {
  (void)state;
  cdem_random random = {14};
  for (int trial = 0; trial < 8; trial++)
    for (int class_ = 0; class_ < CDEM_CLASS_COUNT; class_++) {
      exact_pair pair = exact_cube_pair((cdem_class)class_);
      for (int d = 0; d < 3; d++)
        pair.side[d] = cdem_random_uniform(&random, 0.3, 2.0);
      compare_forms(&pair, 2000);
      pair.size = 2;
      compare_forms(&pair, 2000);
    }
}

/* With a square section across the edge the third spring keeps its direction and value
 * k3 = S_yy - S_yz, so touches are the zeros of the in-plane characteristic polynomial at k3: a
 * quadratic in nu, solved here. */
static void square_bricks_have_the_touches_of_their_symmetry(void **state) {
  (void)state;
  for (int trial = 1; trial < 20; trial++) {
    exact_pair pair = exact_cube_pair(CDEM_CLASS_EDGE);
    double p[3], touch[2];
    pair.side[0] = 0.2 * trial;
    cdem_pencil pencil = exact_pencil(&pair);
    for (int i = 0; i < 3; i++) { /* p(nu) at -0.5, 0, 0.5 */
      double nu = 0.5 * (i - 1), t[9];
      for (int e = 0; e < 9; e++)
        t[e] = pencil.a[e] + nu * pencil.b[e];
      double k3 = t[4] - t[5];
      p[i] = (t[0] - k3) * (t[4] + t[5] - k3) - 2 * t[1] * t[3];
    }
    double c0 = p[1], c1 = p[2] - p[0], c2 = 2 * (p[0] + p[2] - 2 * p[1]);
    double root = c1 * c1 - 4 * c0 * c2;
    int expected = 0, found = 0;
    for (int i = 0; i < 2 && root > 0; i++) {
      touch[expected] = (-c1 + (i == 0 ? -1 : 1) * sqrt(root)) / (2 * c2);
      expected += touch[expected] > -1 && touch[expected] < 0.5;
    }
    cdem_poisson_roots roots;
    cdem_poisson_find_roots(&pencil, &roots);
    for (int i = 0; i < roots.count; i++) {
      if (roots.root[i].from != roots.root[i].to)
        continue;
      double nearest = 9;
      for (int j = 0; j < expected; j++)
        nearest = fmin(nearest, fabs(roots.root[i].nu - touch[j]));
      check_below(nearest, 1e-9);
      found++;
    }
    assert_int_equal(found, expected);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cube_has_the_known_roots),
      cmocka_unit_test(reference_table_holds_the_roots),
      cmocka_unit_test(squares_change_at_zero),
      cmocka_unit_test(crossing_lines_are_touches),
      cmocka_unit_test(planted_changes_are_found),
      cmocka_unit_test(near_touches_are_not_touches),
      cmocka_unit_test(complex_pairs_touch_too),
      cmocka_unit_test(three_values_meet),
      cmocka_unit_test(touches_with_a_defect_survive_rounding),
      cmocka_unit_test(ends_are_excluded),
      cmocka_unit_test(bricks_agree_with_brute_force),
      cmocka_unit_test(square_bricks_have_the_touches_of_their_symmetry),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
