/* Room springs: closed forms against exactly integrated blocks, in all three forms, and among
 * themselves. Tolerance 1e-13 of the block's norm: a few dozen roundings of two derivations. */
#include "springs/closed.h"

#include "springs/exact.h"
#include "support/test.h"

static double difference(const double *a, const double *b, int n) {
  double d[9];
  for (int i = 0; i < n; i++)
    d[i] = a[i] - b[i];
  return cdem_frobenius(d, n) / cdem_frobenius(b, n);
}

static void check_block(const cdem_closed *closed, const double *s, double tolerance) {
  double rebuilt[9];
  cdem_closed_rebuild(closed, rebuilt);
  check_below(difference(rebuilt, s, closed->size * closed->size), tolerance);
  for (int k = 0; k < closed->size; k++)
    check_near(cdem_norm3(closed->dir[k]), 1.0, 0, 1e-14);
}

/* Near a defect the eigenvectors' condition multiplies the rounding. */
static double allowed(const cdem_closed *closed) {
  int pair = closed->form == CDEM_FORM_DIAGONAL ? 0 : closed->size - 2;
  double cosine = fabs(cdem_dot3(closed->dir[pair], closed->dir[pair + 1]));
  return 1e-14 + 1e-14 / fmax(1.0 - cosine, 1e-12);
}

static void cube_forms_rebuild_the_block(void **state) {
  (void)state;
  for (int class_ = 0; class_ < CDEM_CLASS_COUNT; class_++)
    for (int i = 1; i < 300; i++) {
      double nu = -1.0 + 1.5 * i / 300.0, s[9];
      exact_pair pair = exact_cube_pair((cdem_class)class_);
      cdem_closed closed;
      exact_block(&pair, nu, s);
      cdem_closed_cube((cdem_class)class_, &(cdem_closed_solid){1, nu, 1}, &closed);
      check_block(&closed, s, allowed(&closed));
    }
}

static void cube_edge_has_the_form_of_its_interval(void **state) {
  (void)state;
  const double nu[] = {-0.5, 0.029, 0.02904, 0.25, 0.4709, 0.47098};
  const cdem_form form[] = {CDEM_FORM_COMPLEX,  CDEM_FORM_COMPLEX,  CDEM_FORM_DIAGONAL,
                            CDEM_FORM_DIAGONAL, CDEM_FORM_DIAGONAL, CDEM_FORM_COMPLEX};
  cdem_closed closed;
  for (int i = 0; i < 6; i++) {
    cdem_closed_cube(CDEM_CLASS_EDGE, &(cdem_closed_solid){1, nu[i], 1}, &closed);
    assert_int_equal(closed.form, form[i]);
  }
  cdem_closed_cube(CDEM_CLASS_FACE, &(cdem_closed_solid){1, -0.2, 1}, &closed);
  assert_int_equal(closed.form, CDEM_FORM_COMPLEX);
  cdem_closed_cube(CDEM_CLASS_FACE, &(cdem_closed_solid){1, 0.0, 1}, &closed);
  assert_int_equal(closed.form, CDEM_FORM_DIAGONAL);
}

/* At 1/4 -+ 5 sqrt(2)/32 and 1/4 - sqrt(2)/4 the radicand is zero to rounding. A square root of
 * rounding is about 1e-8, hence 1e-7. */
static void jordan_ends_rebuild_the_block(void **state) {
  (void)state;
  const double nu[] = {0.25 - 5.0 * sqrt(2.0) / 32.0, 0.25 + 5.0 * sqrt(2.0) / 32.0,
                       0.25 - sqrt(2.0) / 4.0};
  for (int i = 0; i < 3; i++) {
    cdem_class class_ = i < 2 ? CDEM_CLASS_EDGE : CDEM_CLASS_FACE;
    exact_pair pair = exact_cube_pair(class_);
    cdem_closed closed;
    double s[9];
    exact_block(&pair, nu[i], s);
    cdem_closed_cube(class_, &(cdem_closed_solid){1, nu[i], 1}, &closed);
    assert_int_equal(closed.form, CDEM_FORM_JORDAN2);
    check_block(&closed, s, 1e-7);
    check_near(closed.k[1], closed.k[2], 0, 0);
    check_near(cdem_dot3(closed.dir[1], closed.dir[2]), 0.0, 0, 1e-15);
  }
}

/* The formulas as the source prints them, eqs (13), (15), (17), (20), (22); signs as in the errata.
 */
static void stiffnesses_are_the_printed_ones(void **state) {
  (void)state;
  const double young = 3.0e9, length = 0.2;
  for (double nu = -0.95; nu < 0.499; nu += 0.013) {
    double c = young * length / ((1 + nu) * (1 - 2 * nu)), scale = 1e-13 * c;
    double edge = -512 * nu * nu + 256 * nu - 7, face = -32 * nu * nu + 16 * nu + 2;
    cdem_closed closed;
    cdem_closed_solid solid = {young, nu, length};
    cdem_closed_cube(CDEM_CLASS_EDGE, &solid, &closed);
    if (edge > 0) {
      check_near(closed.k[0], c * (1 + 3 * sqrt(edge)) / 288, 0, scale);
      check_near(closed.k[1], c * (1 - 3 * sqrt(edge)) / 288, 0, scale);
      check_near(closed.k[2], -c / 144, 0, scale);
    } else {
      check_near(closed.k[0], -c / 144, 0, scale);
      check_near(closed.k[2], c / 288, 0, scale);
      check_near(closed.coupling, c * sqrt(-edge) / 96, 0, scale);
    }
    cdem_closed_cube(CDEM_CLASS_FACE, &solid, &closed);
    if (face > 0) {
      check_near(closed.k[0], c * (10 - 12 * nu + 3 * sqrt(face)) / 144, 0, scale);
      check_near(closed.k[1], c * (10 - 12 * nu - 3 * sqrt(face)) / 144, 0, scale);
      check_near(closed.k[2], c * (1 - 3 * nu) / 36, 0, scale);
    } else {
      check_near(closed.k[0], c * (1 - 3 * nu) / 36, 0, scale);
      check_near(closed.k[1], c * (10 - 12 * nu) / 144, 0, scale);
      check_near(closed.coupling, c * sqrt(-face) / 48, 0, scale);
    }
    cdem_closed_cube(CDEM_CLASS_BODY, &solid, &closed);
    check_near(closed.k[0], c * (7 - 6 * nu) / 72, 0, scale);
    check_near(closed.k[2], c * (5 - 12 * nu) / 144, 0, scale);
  }
}

/* Tables 1 and 2 as ratios of components. */
static void directions_are_the_printed_ones(void **state) {
  (void)state;
  for (double nu = 0.035; nu < 0.465; nu += 0.01) {
    double edge = sqrt(-512 * nu * nu + 256 * nu - 7), face = sqrt(-32 * nu * nu + 16 * nu + 2);
    cdem_closed closed;
    cdem_closed_solid solid = {1, nu, 1};
    for (int i = 0; i < 2; i++) {
      double sign = i == 0 ? 1 : -1, *d = closed.dir[i];
      cdem_closed_cube(CDEM_CLASS_EDGE, &solid, &closed);
      check_near(d[0] * 4 * (4 * nu - 1), d[2] * (5 + sign * edge), 0, 1e-12);
      check_near(d[1], d[2], 0, 1e-15);
      cdem_closed_cube(CDEM_CLASS_FACE, &solid, &closed);
      check_near(d[0] * 2 * (4 * nu - 1), d[2] * (2 + sign * face), 0, 1e-12);
      check_near(d[1], d[0], 0, 1e-15);
    }
  }
}

static void four_springs_replace_the_double_value(void **state) {
  (void)state;
  exact_pair pair = exact_cube_pair(CDEM_CLASS_BODY);
  const double spring[4][3] = {{1, 1, 1}, {-1, -1, 2}, {2, -1, -1}, {-1, 2, -1}};
  double s[9], sum[9] = {0};
  cdem_closed closed;
  exact_block(&pair, 0.3, s);
  cdem_closed_cube(CDEM_CLASS_BODY, &(cdem_closed_solid){1, 0.3, 1}, &closed);
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 9; i++)
      sum[i] +=
          (k == 0 ? closed.k[0] / 3 : closed.frame_h / 6) * spring[k][i / 3] * spring[k][i % 3];
  check_below(difference(sum, s, 9), 1e-14);
}

/* Sum over the cubes around a pair: one for the body, the mirrored other for the face, all four
 * quarters for the edge. */
static void interior_sums_are_table_5(void **state) {
  (void)state;
  for (double nu = -0.9; nu < 0.49; nu += 0.1)
    for (int class_ = 0; class_ < CDEM_CLASS_COUNT; class_++) {
      double sum[9] = {0}, s[9];
      int ys = class_ == CDEM_CLASS_EDGE ? 2 : 1, zs = class_ == CDEM_CLASS_BODY ? 1 : 2;
      for (int y = 0; y < ys; y++)
        for (int z = 0; z < zs; z++) {
          exact_pair pair = exact_cube_pair((cdem_class)class_);
          if (y == 1)
            pair.near_[1] = pair.far[1] = 1;
          if (z == 1)
            pair.near_[2] = pair.far[2] = 1;
          exact_block(&pair, nu, s);
          for (int i = 0; i < 9; i++)
            sum[i] += s[i];
        }
      cdem_closed closed;
      cdem_closed_cube_interior((cdem_class)class_, &(cdem_closed_solid){1, nu, 1}, &closed);
      check_block(&closed, sum, 1e-14);
    }
}

static void rectangles_rebuild_the_block(void **state) {
  (void)state;
  for (int plane_stress = 0; plane_stress < 2; plane_stress++)
    for (int across = 1; across < 4; across++)
      for (double nu = -0.95; nu < 0.499; nu += 0.0373) {
        cdem_closed_sheet sheet = {2.5, nu, 1, plane_stress};
        exact_pair pair = {2, {1.5, 0.7 * across, 0}, {-1, -1}, {1, -1}, 2.5, plane_stress};
        cdem_closed closed;
        double s[4];
        exact_block(&pair, nu, s);
        cdem_closed_rectangle_edge(&sheet, pair.side[0], pair.side[1], &closed);
        check_block(&closed, s, allowed(&closed));
        pair.far[1] = 1;
        exact_block(&pair, nu, s);
        cdem_closed_rectangle_diagonal(&sheet, pair.side[0], pair.side[1], &closed);
        check_block(&closed, s, 1e-14);
      }
}

/* springs.md section 3: square, plane strain, and plane stress through mu/(1 + mu). */
static void squares_have_the_known_values(void **state) {
  (void)state;
  for (int plane_stress = 0; plane_stress < 2; plane_stress++)
    for (double nu = 0.01; nu < 0.49; nu += 0.03) {
      double mu = plane_stress ? nu / (1 + nu) : nu;
      double young = plane_stress ? (1 + 2 * nu) / ((1 + nu) * (1 + nu)) : 1;
      double c = young / ((1 + mu) * (1 - 2 * mu)), root = 6 * sqrt(2 * mu * (1 - 2 * mu));
      cdem_closed closed;
      cdem_closed_sheet sheet = {1, nu, 1, plane_stress};
      cdem_closed_rectangle_edge(&sheet, 1, 1, &closed);
      check_near(closed.k[0], c * (3 - 4 * mu + root) / 24, 1e-13, 0);
      check_near(closed.k[1], c * (3 - 4 * mu - root) / 24, 1e-13, 1e-15);
      cdem_closed_rectangle_diagonal(&sheet, 1, 1, &closed);
      check_near(closed.k[0], c * (9 - 8 * mu) / 24, 1e-13, 0);
      check_near(closed.k[1], c * (3 - 8 * mu) / 24, 1e-13, 1e-15);
      check_near(closed.dir[0][0], closed.dir[0][1], 0, 1e-14);
    }
  cdem_closed closed;
  cdem_closed_rectangle_edge(&(cdem_closed_sheet){1, 0, 1, false}, 1, 1, &closed);
  assert_int_equal(closed.form, CDEM_FORM_JORDAN2);
  cdem_closed_rectangle_edge(&(cdem_closed_sheet){1, -0.1, 1, false}, 1, 1, &closed);
  assert_int_equal(closed.form, CDEM_FORM_COMPLEX);
}

/* Constant gradients: S = -A [lambda gi gj^T + G gj gi^T + G gi.gj I]. */
static void triangle_block(const double gi[2], const double gj[2], double lambda, double shear,
                           double *s) {
  double area = sqrt(3.0) / 4.0, dot = gi[0] * gj[0] + gi[1] * gj[1];
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++)
      s[2 * a + b] -=
          area * (lambda * gi[a] * gj[b] + shear * gj[a] * gi[b] + (a == b ? shear * dot : 0.0));
}

static void triangles_rebuild_the_block(void **state) {
  (void)state;
  const double h = sqrt(3.0) / 2.0, left[2] = {-1, -0.5 / h}, right[2] = {1, -0.5 / h},
               left_below[2] = {-1, 0.5 / h}, right_below[2] = {1, 0.5 / h};
  for (int plane_stress = 0; plane_stress < 2; plane_stress++)
    for (double nu = -0.95; nu < 0.499; nu += 0.0373) {
      double shear = 1 / (2 * (1 + nu)), s[4] = {0};
      double lambda = nu / (plane_stress ? 1 - nu * nu : (1 + nu) * (1 - 2 * nu));
      cdem_closed_sheet sheet = {1, nu, 1, plane_stress};
      cdem_closed closed;
      triangle_block(left, right, lambda, shear, s);
      cdem_closed_triangle_edge(&sheet, &closed);
      check_block(&closed, s, allowed(&closed));
      triangle_block(left_below, right_below, lambda, shear, s);
      cdem_closed_triangle_interior(&sheet, &closed);
      check_block(&closed, s, 1e-14);
      double along =
          plane_stress ? (5 + nu) / (1 - nu * nu) : (5 - 4 * nu) / ((1 + nu) * (1 - 2 * nu));
      double normal =
          plane_stress ? (1 - 3 * nu) / (1 - nu * nu) : (1 - 4 * nu) / ((1 + nu) * (1 - 2 * nu));
      check_near(closed.k[0], sqrt(3.0) / 12 * along, 1e-14, 0);
      check_near(closed.k[1], sqrt(3.0) / 12 * normal, 1e-13, 1e-15);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cube_forms_rebuild_the_block),
      cmocka_unit_test(cube_edge_has_the_form_of_its_interval),
      cmocka_unit_test(jordan_ends_rebuild_the_block),
      cmocka_unit_test(stiffnesses_are_the_printed_ones),
      cmocka_unit_test(directions_are_the_printed_ones),
      cmocka_unit_test(four_springs_replace_the_double_value),
      cmocka_unit_test(interior_sums_are_table_5),
      cmocka_unit_test(rectangles_rebuild_the_block),
      cmocka_unit_test(squares_have_the_known_values),
      cmocka_unit_test(triangles_rebuild_the_block),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
