/* Room elements: quadrature rules against the exact integrals of monomials, and volumes. */
#include "elements/specimens.h"

/* integral over -1 .. 1 of x^n */
static double line(int n) {
  return n % 2 == 0 ? 2.0 / (n + 1) : 0.0;
}

/* Exact integral of x^a y^b z^c over the reference shape (Dirichlet's formula on simplices; the
 * pyramid through its collapsed coordinates: 4/((a+1)(b+1)) B(c+1, a+b+3)). */
static double exact(const cdem_element *element, int a, int b, int c) {
  int corners = cdem_shape_get(element->shape)->corners;
  double triangle = tgamma(a + 1) * tgamma(b + 1) / tgamma(a + b + 3);
  if (cdem_element_dimension(element) == 2)
    return corners == 3 ? triangle : line(a) * line(b);
  switch (corners) {
  case 4:
    return tgamma(a + 1) * tgamma(b + 1) * tgamma(c + 1) / tgamma(a + b + c + 4);
  case 5:
    return line(a) * line(b) * tgamma(c + 1) * tgamma(a + b + 3) / tgamma(a + b + c + 4);
  case 6:
    return triangle * line(c);
  default:
    return line(a) * line(b) * line(c);
  }
}

/* Does the rule of this degree promise that monomial? Per direction where the shape is a product.
 */
static bool promised(const cdem_element *element, int degree, int a, int b, int c) {
  switch (cdem_shape_get(element->shape)->corners) {
  case 4:
    return cdem_element_dimension(element) == 2 ? a <= degree && b <= degree : a + b + c <= degree;
  case 6:
    return a + b <= degree && c <= degree;
  case 8:
    return a <= degree && b <= degree && c <= degree;
  default:
    return a + b + c <= degree;
  }
}

static void check_monomials(const cdem_element *element, int degree, const cdem_quadrature *rule) {
  int top = cdem_element_dimension(element) == 3 ? degree : 0;
  for (int a = 0; a <= degree; a++)
    for (int b = 0; b <= degree; b++)
      for (int c = 0; c <= top; c++) {
        if (!promised(element, degree, a, b, c))
          continue;
        double sum = 0.0;
        for (int q = 0; q < rule->points; q++)
          sum += rule->weight[q] * pow(rule->xi[q][0], a) * pow(rule->xi[q][1], b) *
                 pow(rule->xi[q][2], c);
        check_near(sum, exact(element, a, b, c), 0, 1e-13); /* some hundred ulp of the volume */
      }
}

static void rules_are_exact_to_their_degree(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) for (int degree = 1; degree <= 9; degree++) {
    cdem_quadrature rule;
    assert_true(element->quadrature(degree, &rule));
    check_monomials(element, degree, &rule);
  }
}

static void own_rules_are_as_stated(void **state) {
  (void)state;
  static const struct {
    const char *name;
    int points, degree;
  } stated[] = {{"tri3", 1, 1},   {"quad4", 4, 3},         {"tri6", 3, 2},
                {"quad8", 9, 5},  {"tet4", 1, 1},          {"pyr5", 8, 3},
                {"wedge6", 6, 2}, {"hex8", 8, 3},          {"tet10", 4, 2},
                {"hex20", 27, 5}, {"tri3-cosserat", 3, 2}, {"quad4-cosserat", 4, 3}};
  assert_int_equal(sizeof stated / sizeof *stated, CDEM_ELEMENT_COUNT); /* state a new one's too */
  for (size_t i = 0; i < sizeof stated / sizeof *stated; i++) {
    const cdem_element *element = cdem_element_find(stated[i].name);
    cdem_quadrature rule;
    assert_non_null(element);
    assert_true(element->quadrature(0, &rule));
    assert_int_equal(rule.points, stated[i].points);
    check_monomials(element, stated[i].degree, &rule);
  }
}

static void weights_are_positive_and_points_inside(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) for (int degree = 0; degree <= 9; degree++) {
    cdem_quadrature rule;
    double n[MAX_NODES];
    const cdem_element *linear = element;
    for (int id = 0; id < CDEM_ELEMENT_COUNT; id++) { /* the corners' basis is >= 0 inside */
      const cdem_element *other = cdem_element_get((cdem_element_id)id);
      if (cdem_element_dimension(other) == cdem_element_dimension(element) &&
          cdem_element_nodes(other) == cdem_shape_get(element->shape)->corners)
        linear = other;
    }
    assert_true(element->quadrature(degree, &rule));
    for (int q = 0; q < rule.points; q++) {
      assert_true(rule.weight[q] > 0.0);
      linear->shape_functions(rule.xi[q], n, NULL);
      for (int a = 0; a < cdem_element_nodes(linear); a++)
        assert_true(n[a] > 0.0);
    }
  }
}

static void impossible_degrees_are_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  FOR_EACH_ELEMENT(element) {
    cdem_tabulation tabulation = {0};
    cdem_quadrature rule;
    int degree = 1;
    char bound[64];
    while (element->quadrature(degree + 1, &rule)) {
      degree++;
      assert_true(rule.points <= CDEM_MAX_POINTS);
    }
    snprintf(bound, sizeof bound, "%s takes 1 to %d, or 0", element->name, degree);
    check_fails(cdem_tabulation_init(element, degree + 1, &tabulation, &fault), CDEM_USAGE, bound);
    check_fails(cdem_tabulation_init(element, 1000000, &tabulation, &fault), CDEM_USAGE,
                "quadrature degree 1000000 is out of range");
    check_fails(cdem_tabulation_init(element, -1, &tabulation, &fault), CDEM_USAGE,
                "quadrature degree -1 is out of range");
    assert_null(tabulation.weight);
    check_ok(cdem_tabulation_init(element, degree, &tabulation, &fault));
    cdem_tabulation_release(&tabulation);
  }
}

static double volume(const cdem_element *element, int degree, const double (*xyz)[3]) {
  cdem_fault fault = {0};
  cdem_tabulation tabulation = {0};
  check_ok(cdem_tabulation_init(element, degree, &tabulation, &fault));
  double v = cdem_element_volume(&tabulation, 1.5, xyz);
  cdem_tabulation_release(&tabulation);
  return v;
}

/* The determinant of a distorted element is a polynomial of degree 5 at most (per direction) in the
 * coordinates of its rule: own rules integrate it exactly, but that of tet10 (degree 3). */
static void volumes_do_not_depend_on_the_rule(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    double xyz[MAX_NODES][3];
    distort(element, DISTORTION, 11, xyz);
    double fine = volume(element, 9, (const double(*)[3])xyz);
    check_near(volume(element, 5, (const double(*)[3])xyz), fine, 1e-13, 0);
    if (element->shape != CDEM_SHAPE_TET10)
      check_near(volume(element, 0, (const double(*)[3])xyz), fine, 1e-13, 0);
  }
}

/* Shoelace formula: an independent area for straight edges. */
static void plane_areas_follow_the_shoelace_formula(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    int corners = cdem_shape_get(element->shape)->corners;
    if (cdem_element_dimension(element) != 2 || corners != cdem_element_nodes(element))
      continue;
    double xyz[MAX_NODES][3], area = 0.0;
    distort(element, DISTORTION, 12, xyz);
    for (int a = 0; a < corners; a++) {
      const double *p = xyz[a], *q = xyz[(a + 1) % corners];
      area += 0.5 * (p[0] * q[1] - q[0] * p[1]);
    }
    check_near(volume(element, 0, (const double(*)[3])xyz), 1.5 * area, 1e-14, 0);
  }
}

/* Reference volumes and an affine map: det of the map times the reference volume. */
static void volumes_follow_an_affine_map(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    const double plane = 1.1 * 0.9 + 0.15 * 0.2;
    const double solid[9] = {1.1, 0.2, -0.1, -0.15, 0.9, 0.3, 0.1, -0.2, 1.2};
    double xyz[MAX_NODES][3];
    distort(element, 0.0, 0, xyz);
    double expected = exact(element, 0, 0, 0) *
                      (cdem_element_dimension(element) == 2 ? 1.5 * plane : cdem_det3(solid));
    check_near(volume(element, 0, (const double(*)[3])xyz), expected, 1e-14, 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rules_are_exact_to_their_degree),
      cmocka_unit_test(own_rules_are_as_stated),
      cmocka_unit_test(weights_are_positive_and_points_inside),
      cmocka_unit_test(impossible_degrees_are_refused),
      cmocka_unit_test(volumes_do_not_depend_on_the_rule),
      cmocka_unit_test(plane_areas_follow_the_shoelace_formula),
      cmocka_unit_test(volumes_follow_an_affine_map),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
