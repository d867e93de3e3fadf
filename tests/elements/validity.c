/* Room elements: which shapes an element accepts, and what it says of the others. */
#include "elements/specimens.h"

static cdem_fault fault;

static cdem_status check(const cdem_element *element, double (*xyz)[3]) {
  cdem_tabulation t = {0};
  memset(&fault, 0, sizeof fault);
  check_ok(cdem_tabulation_init(element, 0, &t, &fault));
  cdem_status status = cdem_element_check(&t, (const double(*)[3])xyz, &fault);
  cdem_tabulation_release(&t);
  return status;
}

static void check_says(const char *name, const double (*xyz)[3], const char *text) {
  double copy[MAX_NODES][3];
  const cdem_element *element = cdem_element_find(name);
  memcpy(copy, xyz, sizeof *copy * (size_t)cdem_element_nodes(element));
  if (text == NULL) {
    if (check(element, copy) != CDEM_OK)
      fail_msg("%s refused: %s", name, fault.message);
    return;
  }
  assert_int_equal(check(element, copy), CDEM_INPUT);
  if (strstr(fault.message, text) == NULL)
    fail_msg("message '%s' does not hold '%s'", fault.message, text);
}

/* Powers of two scale without rounding; any size from atoms to continents. */
static void sound_elements_pass_at_any_size(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) for (int power = -60; power <= 60; power += 20) {
    double xyz[MAX_NODES][3];
    distort(element, DISTORTION, 31, xyz);
    for (int i = 0; i < 3 * MAX_NODES && i / 3 < cdem_element_nodes(element); i++)
      xyz[i / 3][i % 3] = ldexp(xyz[i / 3][i % 3], power);
    if (check(element, xyz) != CDEM_OK)
      fail_msg("%s at 2^%d: %s", element->name, power, fault.message);
  }
}

static void needles_pass(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    double xyz[MAX_NODES][3];
    distort(element, 0.0, 0, xyz);
    for (int a = 0; a < cdem_element_nodes(element); a++)
      xyz[a][0] *= 1e8;
    if (check(element, xyz) != CDEM_OK)
      fail_msg("%s as a needle: %s", element->name, fault.message);
  }
  /* a sliver: height a millionth of the base */
  const double sliver[3][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0}};
  check_says("tri3", sliver, NULL);
}

static void inverted_elements_are_named(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    int last = cdem_element_dimension(element) - 1;
    double xyz[MAX_NODES][3];
    distort(element, DISTORTION, 32, xyz);
    for (int a = 0; a < cdem_element_nodes(element); a++)
      xyz[a][last] = -xyz[a][last];
    assert_int_equal(check(element, xyz), CDEM_INPUT);
    assert_non_null(strstr(fault.message, "element is inverted"));
    assert_non_null(strstr(fault.message, "reverse its node order"));
  }
}

static void flat_elements_are_named(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) for (int power = -40; power <= 40; power += 40) {
    int last = cdem_element_dimension(element) - 1;
    double xyz[MAX_NODES][3];
    distort(element, 0.0, 0, xyz);
    for (int a = 0; a < cdem_element_nodes(element); a++)
      for (int i = 0; i < 3; i++)
        xyz[a][i] = i == last ? ldexp(0.3 * xyz[a][0], power) : ldexp(xyz[a][i], power);
    assert_int_equal(check(element, xyz), CDEM_INPUT);
    assert_non_null(strstr(fault.message, "element is flat"));
  }
  FOR_EACH_ELEMENT(element) { /* all on one line: here the areas are rounding too */
    const double along[3] = {0.37, 0.71, -0.43};
    double xyz[MAX_NODES][3];
    distort(element, 0.3, 33, xyz);
    for (int a = 0; a < cdem_element_nodes(element); a++) {
      double place = xyz[a][0] + 0.3 * xyz[a][1];
      for (int i = 0; i < 3; i++)
        xyz[a][i] = place * along[i];
    }
    assert_int_equal(check(element, xyz), CDEM_INPUT);
    assert_non_null(strstr(fault.message, "element is flat"));
  }
  /* in national grid coordinates the line is straight only to rounding */
  const double far[3][3] = {
      {5e6 + 0.1, 4e6 + 0.1, 0}, {5e6 + 0.2, 4e6 + 0.2, 0}, {5e6 + 0.35, 4e6 + 0.35, 0}};
  check_says("tri3", far, "element is flat: its nodes lie on one line");
  double point[MAX_NODES][3] = {{0}};
  assert_int_equal(check(cdem_element_find("hex20"), point), CDEM_INPUT);
  assert_non_null(strstr(fault.message, "element is flat"));
}

/* A plate or strip of relative height h is flat below CDEM_FLAT_BOUND = 1e-12 and fine above. */
static void height_decides_what_is_flat(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) for (int thin = 0; thin < 2; thin++) {
    int last = cdem_element_dimension(element) - 1;
    double xyz[MAX_NODES][3];
    memcpy(xyz, element->reference, sizeof *xyz * (size_t)cdem_element_nodes(element));
    for (int a = 0; a < cdem_element_nodes(element); a++)
      xyz[a][last] *= thin ? 1e-13 : 1e-11;
    assert_int_equal(check(element, xyz), thin ? CDEM_INPUT : CDEM_OK);
  }
  /* In national grid coordinates a height of 1e-9 is rounding, a millimetre is not. */
  double tet[4][3] = {{5e6, 4e6, 0}, {5e6 + 1, 4e6, 0}, {5e6, 4e6 + 1, 0}, {5e6, 4e6, 1e-9}};
  check_says("tet4", (const double(*)[3])tet, "element is flat: its nodes lie in one plane");
  tet[3][2] = 1e-3;
  check_says("tet4", (const double(*)[3])tet, NULL);
}

/* A map whose derivatives all vanish at one point of the rule: (xi - 2/3 + i (eta - 1/6))^2. */
static void vanishing_derivatives_are_degenerate(void **state) {
  (void)state;
  double xyz[6][3] = {{0}};
  const cdem_element *element = cdem_element_find("tri6");
  for (int a = 0; a < 6; a++) {
    double u = element->reference[a][0] - 2.0 / 3, v = element->reference[a][1] - 1.0 / 6;
    xyz[a][0] = u * u - v * v;
    xyz[a][1] = 2 * u * v;
  }
  check_says("tri6", (const double(*)[3])xyz, "element is degenerate");
}

static void folded_elements_are_named(void **state) {
  (void)state;
  const double bow_tie[4][3] = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  check_says("quad4", bow_tie, "element is folded");
  /* a dart: positive at the Gauss points, negative at the corner that points inwards */
  const double dart[4][3] = {{0, 0, 0}, {1, 0, 0}, {0.45, 0.45, 0}, {0, 1, 0}};
  check_says("quad4", dart, "at a corner, it must not be negative; untangle its nodes");
  /* the mid node of one edge pulled past the quarter point: the corner beside it turns over */
  const double quarter[6][3] = {{0, 0, 0},   {1, 0, 0},     {0, 1, 0},
                                {0.2, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};
  check_says("tri6", quarter, "element is folded");
  double hex[8][3];
  memcpy(hex, cdem_element_find("hex8")->reference, sizeof hex);
  hex[6][0] = hex[6][1] = hex[6][2] = -0.9; /* pushed nearly through to the opposite corner */
  check_says("hex8", (const double(*)[3])hex, "element is folded");
}

/* Limits that are still allowed: a corner of 180 degrees and a mid node at the quarter point
 * (determinant zero at a corner only), two corners in one place. */
static void zero_at_a_corner_passes(void **state) {
  (void)state;
  const double straight[4][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.5, 0}, {0, 1, 0}};
  const double quarter[6][3] = {{0, 0, 0},    {1, 0, 0},     {0, 1, 0},
                                {0.25, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};
  const double collapsed[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  check_says("quad4", straight, NULL);
  check_says("tri6", quarter, NULL);
  check_says("quad4", collapsed, NULL);
}

/* The mid node of the slanted edge moved by t along x: det = 1 + 4 t eta, zero for t = -3/8 at the
 * rule's point eta = 2/3 and 3/4 at the others. */
static void degenerate_elements_are_named(void **state) {
  (void)state;
  const double xyz[6][3] = {{0, 0, 0},   {1, 0, 0},       {0, 1, 0},
                            {0.5, 0, 0}, {0.125, 0.5, 0}, {0, 0.5, 0}};
  check_says("tri6", xyz, "element is degenerate");
}

static void coordinates_must_be_finite(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    double xyz[MAX_NODES][3];
    distort(element, 0.0, 0, xyz);
    xyz[1][1] = NAN;
    assert_int_equal(check(element, xyz), CDEM_INPUT);
    assert_non_null(strstr(fault.message, "y = nan; coordinates must be finite"));
  }
}

/* The calls that compute refuse what the check refuses, and write nothing. */
static void nothing_is_computed_for_a_bad_element(void **state) {
  (void)state;
  const cdem_element *element = cdem_element_find("tri3");
  const double inverted[3][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  cdem_material material = cdem_material_isotropic(1, 0.2);
  cdem_tabulation t = {0};
  cdem_contraction law;
  double k[36] = {7}, s[12] = {7};
  memset(&fault, 0, sizeof fault);
  check_ok(cdem_tabulation_init(element, 0, &t, &fault));
  check_ok(cdem_contraction_build(&material, CDEM_PLANE, &strain_section, &law, &fault));
  check_fails(cdem_element_stiffness(&t, &material, &strain_section, inverted, k, &fault),
              CDEM_INPUT, "in gmsh: turn the curve loop round or use ReverseMesh Surface");
  check_fails(cdem_element_pair_blocks(&t, &law, inverted, s, &fault), CDEM_INPUT, "inverted");
  material.parameter[1] = 3;
  check_fails(cdem_element_stiffness(&t, &material, &strain_section, inverted, k, &fault),
              CDEM_INPUT, "poisson = 3");
  assert_true(k[0] == 7 && s[0] == 7);
  cdem_tabulation_release(&t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sound_elements_pass_at_any_size),
      cmocka_unit_test(needles_pass),
      cmocka_unit_test(inverted_elements_are_named),
      cmocka_unit_test(flat_elements_are_named),
      cmocka_unit_test(height_decides_what_is_flat),
      cmocka_unit_test(vanishing_derivatives_are_degenerate),
      cmocka_unit_test(folded_elements_are_named),
      cmocka_unit_test(zero_at_a_corner_passes),
      cmocka_unit_test(degenerate_elements_are_named),
      cmocka_unit_test(coordinates_must_be_finite),
      cmocka_unit_test(nothing_is_computed_for_a_bad_element),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
