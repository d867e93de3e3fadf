/* The misprints of Wei et al. 2006 (docs/theory/errata-wei-2006.md): for each, the printed value is
 * computed and shown to be wrong, and the right one to be right, on exactly integrated blocks. The
 * number in a test's name is that of the list. "Wrong" means off by far more than the three digits
 * the source prints. */
#include "springs/closed.h"
#include "springs/exact.h"
#include "support/test.h"

static void cube_block(cdem_class class_, double nu, double s[9]) {
  exact_pair pair = exact_cube_pair(class_);
  exact_block(&pair, nu, s);
}

/* Eqs (3)-(5): coefficients of l^3 + k1 l^2 + k2 l + k3 and the depressed p, q, D. */
typedef struct {
  double k1, k2, k3, p, q, d;
} cubic;

static double principal_minors(const double m[9]) {
  return m[4] * m[8] - m[5] * m[7] + m[0] * m[8] - m[2] * m[6] + m[0] * m[4] - m[1] * m[3];
}

static cubic cubic_of(const double m[9]) {
  cubic c = {.k1 = -(m[0] + m[4] + m[8]), .k2 = principal_minors(m), .k3 = -cdem_det3(m)};
  c.p = c.k2 - c.k1 * c.k1 / 3;
  c.q = 2 * c.k1 * c.k1 * c.k1 / 27 - c.k1 * c.k2 / 3 + c.k3;
  c.d = c.q * c.q / 4 + c.p * c.p * c.p / 27;
  return c;
}

/* |S v - k v| / (|S| |v|). */
static double off_eigenvector(const double s[9], double k, double x, double y, double z) {
  const double v[3] = {x, y, z};
  double r[3];
  for (int i = 0; i < 3; i++)
    r[i] = s[3 * i] * x + s[3 * i + 1] * y + s[3 * i + 2] * z - k * v[i];
  return cdem_norm3(r) / (cdem_frobenius(s, 9) * cdem_norm3(v));
}

/* Eigenvalues 1, 2 and 4: k2 is the plus sum of the principal minors, 2 + 4 + 8. */
static void e01_equation_4_sign_of_k2(void **state) {
  (void)state;
  const double m[9] = {1, 5, 7, 0, 2, 3, 0, 0, 4};
  cubic c = cubic_of(m);
  for (int i = 0; i < 3; i++) {
    double l = m[4 * i], printed = -principal_minors(m);
    check_near(((l + c.k1) * l + c.k2) * l + c.k3, 0, 0, 1e-13);
    assert_true(fabs(((l + c.k1) * l + printed) * l + c.k3) > 1);
  }
}

/* Eigenvalues 6 and 1 +- 2i: real root u + v - k1/3, imaginary part (sqrt(3)/2) (u - v). */
static void e02_equation_5_shift_and_factor(void **state) {
  (void)state;
  const double m[9] = {6, 0, 0, 0, 1, 2, 0, -2, 1};
  cubic c = cubic_of(m);
  double u = cbrt(-c.q / 2 + sqrt(c.d)), v = cbrt(-c.q / 2 - sqrt(c.d));
  check_near(u + v - c.k1 / 3, 6, 1e-14, 0);
  check_near(-(u + v) / 2 - c.k1 / 3, 1, 1e-14, 0);
  check_near(sqrt(3.0) / 2 * fabs(u - v), 2, 1e-14, 0);
  assert_true(fabs(u + v + c.k1 / 3 - 6) > 1);
  assert_true(fabs(sqrt(3.0) / 3 * fabs(u - v) - 2) > 0.5);
}

/* "r = 3" in eqs (9)-(11): the rank of K - lambda I is below 3 for every eigenvalue; it is 1 for a
 * double value without defect and 2 for both Jordan forms. */
static void e03_conditions_on_the_rank(void **state) {
  (void)state;
  const double plain[9] = {5, 0, 0, 0, 2, 0, 0, 0, 2}, jordan2[9] = {5, 0, 0, 0, 2, 1, 0, 0, 2},
               jordan3[9] = {2, 1, 0, 0, 2, 1, 0, 0, 2};
  const double *form[3] = {plain, jordan2, jordan3};
  const int rank[3] = {1, 2, 2};
  for (int f = 0; f < 3; f++) {
    double m[9], largest_minor = 0;
    for (int i = 0; i < 9; i++)
      m[i] = form[f][i] - (i % 4 == 0 ? 2 : 0);
    check_near(cdem_det3(m), 0, 0, 0);
    for (int i = 0; i < 9; i++) {
      int r = (i / 3 + 1) % 3, s = (i / 3 + 2) % 3, a = (i % 3 + 1) % 3, b = (i % 3 + 2) % 3;
      double minor = m[3 * r + a] * m[3 * s + b] - m[3 * r + b] * m[3 * s + a];
      largest_minor = fmax(largest_minor, fabs(minor));
    }
    assert_int_equal(largest_minor > 0 ? 2 : 1, rank[f]);
  }
}

/* Eq (9) wants D < 0 for a double value; a double value is D = 0, and inside the edge's diagonal
 * interval D touches zero at 1/4 -+ sqrt(3)/8. */
static void e04_equation_9_double_value(void **state) {
  (void)state;
  for (int side = -1; side <= 1; side += 2) {
    double nu = 0.25 + side * sqrt(3.0) / 8, s[9];
    cube_block(CDEM_CLASS_EDGE, nu, s);
    cubic c = cubic_of(s);
    check_near(c.d / (c.q * c.q), 0, 0, 1e-14);
    cube_block(CDEM_CLASS_EDGE, nu + 1e-3 * side, s);
    c = cubic_of(s);
    assert_true(c.d < -1e-6 * c.q * c.q);
    cube_block(CDEM_CLASS_EDGE, nu - 1e-3 * side, s);
    c = cubic_of(s);
    assert_true(c.d < -1e-6 * c.q * c.q);
  }
}

/* "p != q" in eqs (9) and (10) means that not both are zero: diag(3, -3/2, -3/2) has a double value
 * and p = q. */
static void e05_p_unequal_q(void **state) {
  (void)state;
  const double m[9] = {3, 0, 0, 0, -1.5, 0, 0, 0, -1.5};
  cubic c = cubic_of(m);
  check_near(c.d, 0, 0, 1e-13);
  check_near(c.p, c.q, 1e-15, 0);
  assert_true(fabs(c.p) > 1);
}

/* The 1 of eqs (10), (11), (14), (18) has the unit of a stiffness: with directions of unit length
 * it grows with E; at the edge's defect it is 30 c/288. */
static void e06_jordan_coupling_is_a_stiffness(void **state) {
  (void)state;
  double nu = 0.25 - 5 * sqrt(2.0) / 32;
  cdem_closed one, thousand;
  cdem_closed_cube(CDEM_CLASS_EDGE, &(cdem_closed_solid){1, nu, 1}, &one);
  cdem_closed_cube(CDEM_CLASS_EDGE, &(cdem_closed_solid){1000, nu, 1}, &thousand);
  assert_int_equal(one.form, CDEM_FORM_JORDAN2);
  check_near(thousand.coupling, 1000 * one.coupling, 1e-12, 0);
  /* N = [[15, -15], [15, -15]] c/288 in an orthonormal basis has norm 30 c/288. */
  double c = 1 / ((1 + nu) * (1 - 2 * nu));
  check_near(fabs(one.coupling), 30 * c / 288, 1e-7, 0);
}

/* Section 2 decomposes K_ij; eqs (12)-(22) are those of -K_ij, the spring tensor. */
static void e07_sign_of_the_block(void **state) {
  (void)state;
  double nu = 0.2, c = 1 / ((1 + nu) * (1 - 2 * nu)), s[9], k[9];
  double k1 = c * (1 + 3 * sqrt(-512 * nu * nu + 256 * nu - 7)) / 288, k3 = -c / 144;
  cube_block(CDEM_CLASS_EDGE, nu, s);
  for (int i = 0; i < 9; i++)
    k[i] = -s[i];
  check_below(off_eigenvector(s, k3, 0, -1, 1), 1e-15);
  assert_true(off_eigenvector(k, k3, 0, -1, 1) > 0.1);
  cubic spring = cubic_of(s), stiffness = cubic_of(k);
  check_near(((k1 + spring.k1) * k1 + spring.k2) * k1 + spring.k3, 0, 0, 1e-15);
  assert_true(fabs(((k1 + stiffness.k1) * k1 + stiffness.k2) * k1 + stiffness.k3) > 5e-5);
  check_near(spring.q, 5.36e-6 * (72 * nu * nu - 36 * nu + 1) * c * c * c, 1e-3, 0);
}

static void e08_equation_12_discriminant(void **state) {
  (void)state;
  for (double nu = -0.8; nu < 0.49; nu += 0.11) {
    double c = 1 / ((1 + nu) * (1 - 2 * nu)), s[9];
    double first = 512 * nu * nu - 256 * nu + 7, second = 64 * nu * nu - 32 * nu + 1;
    cube_block(CDEM_CLASS_EDGE, nu, s);
    cubic r = cubic_of(s);
    check_near(r.d, 3.03e-12 * first * second * second * pow(c, 6), 2e-3, 0);
    assert_true(fabs(r.d / (3.03e-12 * first * second * pow(c, 6)) - 1) > 0.1);
    check_near(r.p, 1.45e-4 * (384 * nu * nu - 192 * nu + 5) * c * c, 3e-3, 0);
  }
}

/* Eqs (14), (18) put the double value in places 1 and 2 of a matrix whose block couples 2 to 3. The
 * printed matrix has three values of which 2 and 3 differ, so it is diagonalisable: no Jordan form.
 */
static void e09_order_in_the_jordan_form(void **state) {
  (void)state;
  double nu = 0.25 - 5 * sqrt(2.0) / 32, c = 1 / ((1 + nu) * (1 - 2 * nu));
  double pair = c / 288, single = -c / 144;
  const double printed[9] = {pair, 0, 0, 0, pair, 1, 0, 0, single};
  /* Its third column is an eigenvector with a third component: nothing is missing. */
  check_below(off_eigenvector(printed, single, 0, 1 / (single - pair), 1), 1e-15);
  check_below(off_eigenvector(printed, pair, 1, 0, 0), 1e-15);
  check_below(off_eigenvector(printed, pair, 0, 1, 0), 1e-15);
  cdem_closed closed;
  cdem_closed_cube(CDEM_CLASS_EDGE, &(cdem_closed_solid){1, nu, 1}, &closed);
  check_near(closed.k[0], single, 1e-13, 0);
  check_near(closed.k[1], pair, 1e-12, 0);
  check_near(closed.k[2], pair, 1e-12, 0);
}

/* In the complex range the printed radicand is negative; its opposite gives the imaginary part. */
static void check_radicand(cdem_class class_, double nu, double radicand, double real,
                           double divisor) {
  double c = 1 / ((1 + nu) * (1 - 2 * nu)), s[9];
  cube_block(class_, nu, s);
  assert_true(radicand < 0);
  cubic r = cubic_of(s);
  double a = real * c, b = c * sqrt(-radicand) / divisor;
  double single = -r.k1 - 2 * a; /* trace */
  check_near(single * (a * a + b * b), -r.k3, 1e-12, 0);
  check_near(2 * single * a + a * a + b * b, r.k2, 1e-12, 1e-16);
}

static void e10_equation_15_radicand(void **state) {
  (void)state;
  for (double nu = -0.9; nu < 0.02; nu += 0.1)
    check_radicand(CDEM_CLASS_EDGE, nu, -512 * nu * nu + 256 * nu - 7, 1.0 / 288, 96);
}

static void e11_equation_20_radicand(void **state) {
  (void)state;
  for (double nu = -0.9; nu < -0.11; nu += 0.1)
    check_radicand(CDEM_CLASS_FACE, nu, -32 * nu * nu + 16 * nu + 2, (10 - 12 * nu) / 144, 48);
}

static void e12_equation_16_coefficient(void **state) {
  (void)state;
  for (double nu = -0.8; nu < 0.49; nu += 0.11) {
    double c = 1 / ((1 + nu) * (1 - 2 * nu)), s[9];
    double shape = (16 * nu * nu - 8 * nu - 1) * pow(4 * nu - 1, 4) * pow(c, 6);
    cube_block(CDEM_CLASS_FACE, nu, s);
    cubic r = cubic_of(s);
    check_near(r.d, 2.42e-11 * shape, 2e-3, 1e-22);
    assert_true(fabs(r.d) < 1e-4 * fabs(2.42e-6 * shape));
  }
}

/* Text after eq (19) and conclusion 2: the face block is complex below 1/4 - sqrt(2)/4, not below
 * 1/4 - 5 sqrt(2)/32. */
static void e13_complex_range_of_the_face(void **state) {
  (void)state;
  const double nu[] = {0.25 - sqrt(2.0) / 4 - 1e-6, 0.25 - sqrt(2.0) / 4 + 1e-6, 0.0,
                       0.25 - 5 * sqrt(2.0) / 32 - 1e-3, 0.25 + 5 * sqrt(2.0) / 32 + 1e-3};
  for (int i = 0; i < 5; i++) {
    double s[9];
    cube_block(CDEM_CLASS_FACE, nu[i], s);
    assert_int_equal(cubic_of(s).d > 0, i == 0);
  }
}

static void e14_table_2_third_direction(void **state) {
  (void)state;
  double nu = 0.3, k3 = (1 - 3 * nu) / (36 * (1 + nu) * (1 - 2 * nu)), s[9];
  cube_block(CDEM_CLASS_FACE, nu, s);
  check_below(off_eigenvector(s, k3, -1, 1, 0), 1e-15);
  assert_true(off_eigenvector(s, k3, -1, -1, 0) > 0.1);
}

static double angle_between(const double a[3], const double b[3]) {
  return acos(fmin(1.0, fabs(cdem_dot3(a, b)))) * 180 / M_PI;
}

/* Text after table 1: "when D = 0 ... the largest angle between the two is 90 degrees" speaks of
 * D < 0. Where D = 0 the two coincide (Jordan), or enclose 11.5 degrees; 90 degrees is at 1/4. */
static void e15_angle_between_the_edge_springs(void **state) {
  (void)state;
  const double nu[] = {0.25 - 5 * sqrt(2.0) / 32 + 1e-13, 0.25 + sqrt(3.0) / 8, 0.25};
  const double angle[] = {0.0, acos(4 / sqrt(50.0 / 3)) * 180 / M_PI, 90.0};
  for (int i = 0; i < 3; i++) {
    cdem_closed closed;
    cdem_closed_cube(CDEM_CLASS_EDGE, &(cdem_closed_solid){1, nu[i], 1}, &closed);
    assert_int_equal(closed.form, CDEM_FORM_DIAGONAL);
    /* A direction turns with the root of the distance to a defect: 1e-13 makes 1e-4 degrees. */
    check_near(angle_between(closed.dir[0], closed.dir[1]), angle[i], 0, 1e-3);
  }
}

/* Text after table 2: at 1/4 the indefinite pair is k2, k3 (eq (19)), normal to the face diagonal;
 * k1 is definite, along the diagonal. */
static void e16_indefinite_pair_of_the_face(void **state) {
  (void)state;
  double s[9];
  cube_block(CDEM_CLASS_FACE, 0.25, s);
  check_below(off_eigenvector(s, 13.0 / 90, 1, 1, 0), 1e-15);
  for (double turn = 0; turn < 3; turn += 0.3) /* any direction of the normal plane serves */
    check_below(off_eigenvector(s, 1.0 / 90, -cos(turn), cos(turn), M_SQRT2 * sin(turn)), 1e-15);
  assert_true(off_eigenvector(s, 13.0 / 90, 1, 1, 0.1) > 0.05); /* k1 may not turn */
}

/* Table 4: with 432 the four springs miss half of the transverse stiffness, 10.6 % of the largest
 * entry at 0.3. */
static void e17_table_4_stiffness(void **state) {
  (void)state;
  const double spring[4][3] = {{1, 1, 1}, {-1, -1, 2}, {2, -1, -1}, {-1, 2, -1}};
  double nu = 0.3, c = 1 / ((1 + nu) * (1 - 2 * nu)), s[9], error[2];
  cube_block(CDEM_CLASS_BODY, nu, s);
  for (int printed = 0; printed < 2; printed++) {
    double g = c * (7 - 6 * nu) / 72, h = c * (5 - 12 * nu) / (printed ? 432 : 216);
    error[printed] = 0;
    for (int i = 0; i < 9; i++) {
      double sum = 0;
      for (int k = 0; k < 4; k++)
        sum += (k == 0 ? g / 3 : h / 6) * spring[k][i / 3] * spring[k][i % 3];
      error[printed] = fmax(error[printed], fabs(sum - s[i]) / s[0]);
    }
  }
  check_below(error[0], 1e-15);
  check_near(error[1], 0.106, 0, 5e-4);
}

/* Section 4 prints the triangles' values with the sign of K_ij: negative for a bond that pulls. */
static void e18_signs_of_the_triangles(void **state) {
  (void)state;
  double nu = 0.2, a = sqrt(3.0) / 12;
  const double printed[2][2] = {
      {-a * (4 * nu - 5) / ((1 + nu) * (2 * nu - 1)),
       -a * (4 * nu - 1) / ((1 + nu) * (2 * nu - 1))},
      {a * (5 + nu) / ((1 + nu) * (nu - 1)), -a * (3 * nu - 1) / ((1 + nu) * (nu - 1))}};
  for (int plane_stress = 0; plane_stress < 2; plane_stress++) {
    cdem_closed closed;
    cdem_closed_triangle_interior(&(cdem_closed_sheet){1, nu, 1, plane_stress}, &closed);
    assert_true(closed.k[0] > 0);
    for (int k = 0; k < 2; k++)
      check_near(closed.k[k], -printed[plane_stress][k], 1e-14, 0);
  }
}

/* English abstract: 1/4 belongs to plane strain and 1/3 to plane stress, as the Chinese one and
 * section 4 say; there the spring across the bond vanishes. */
static void e19_abstract_swaps_the_planes(void **state) {
  (void)state;
  for (int plane_stress = 0; plane_stress < 2; plane_stress++) {
    double right = plane_stress ? 1.0 / 3 : 0.25, printed = plane_stress ? 0.25 : 1.0 / 3;
    cdem_closed closed;
    cdem_closed_triangle_interior(&(cdem_closed_sheet){1, right, 1, plane_stress}, &closed);
    check_near(closed.k[1], 0, 0, 1e-16);
    cdem_closed_triangle_interior(&(cdem_closed_sheet){1, printed, 1, plane_stress}, &closed);
    assert_true(fabs(closed.k[1]) > 0.02 * closed.k[0]);
  }
}

/* Introduction: the spring that four blocks share is the edge's; four body springs would make
 * c (7 - 6 mu)/18 along the pair, and no inner node pair of a block has it. */
static void e20_spring_shared_by_four_blocks(void **state) {
  (void)state;
  double nu = 0.25, c = 1.6, s[9], along = 0;
  cdem_closed closed;
  cdem_closed_cube_interior(CDEM_CLASS_EDGE, &(cdem_closed_solid){1, nu, 1}, &closed);
  for (int block = 0; block < 4; block++) {
    cube_block(CDEM_CLASS_EDGE, nu, s);
    along += s[0];
  }
  check_near(along, closed.k[0], 1e-14, 0);
  assert_true(fabs(4 * c * (7 - 6 * nu) / 72 - closed.k[0]) > 0.1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(e01_equation_4_sign_of_k2),
      cmocka_unit_test(e02_equation_5_shift_and_factor),
      cmocka_unit_test(e03_conditions_on_the_rank),
      cmocka_unit_test(e04_equation_9_double_value),
      cmocka_unit_test(e05_p_unequal_q),
      cmocka_unit_test(e06_jordan_coupling_is_a_stiffness),
      cmocka_unit_test(e07_sign_of_the_block),
      cmocka_unit_test(e08_equation_12_discriminant),
      cmocka_unit_test(e09_order_in_the_jordan_form),
      cmocka_unit_test(e10_equation_15_radicand),
      cmocka_unit_test(e11_equation_20_radicand),
      cmocka_unit_test(e12_equation_16_coefficient),
      cmocka_unit_test(e13_complex_range_of_the_face),
      cmocka_unit_test(e14_table_2_third_direction),
      cmocka_unit_test(e15_angle_between_the_edge_springs),
      cmocka_unit_test(e16_indefinite_pair_of_the_face),
      cmocka_unit_test(e17_table_4_stiffness),
      cmocka_unit_test(e18_signs_of_the_triangles),
      cmocka_unit_test(e19_abstract_swaps_the_planes),
      cmocka_unit_test(e20_spring_shared_by_four_blocks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
