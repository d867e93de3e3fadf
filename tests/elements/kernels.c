/* Room elements: the fast path against the reference B^T D B, lane by lane, in every vector
 * width this processor has.
 *
 * Bound 1e-13 of the largest entry: both sum the same points in another order, and the fast path
 * keeps gradients multiplied by the determinant. */
#include "elements/basis.h"
#include "elements/specimens.h"

#define ROUNDING 1e-13

static _Alignas(64) double x[MAX_NODES * 3 * CDEM_LANES], least[CDEM_LANES];
static _Alignas(64) double moment[CDEM_MAX_PAIRS * 9 * CDEM_LANES];
static _Alignas(64) double fast[CDEM_MAX_PAIRS * 9 * CDEM_LANES];

/* Blocks S_ab = -K_ab [pairs][dofs*dofs] from the reference matrix. */
static void reference_blocks(const cdem_tabulation *t, const cdem_material *material,
                             const cdem_section *section, double (*xyz)[3], double *s) {
  static double k[MAX_SIZE * MAX_SIZE];
  cdem_fault fault = {0};
  int nodes = t->nodes, dofs = cdem_element_dofs(t->element);
  check_ok(cdem_element_stiffness(t, material, section, (const double(*)[3])xyz, k, &fault));
  for (int a = 0; a < nodes; a++)
    for (int b = a + 1; b < nodes; b++)
      for (int e = 0; e < dofs * dofs; e++)
        *s++ = -k[nodes * dofs * (dofs * a + e / dofs) + dofs * b + e % dofs];
}

static void load_lane(int lane, int nodes, double (*xyz)[3]) {
  for (int i = 0; i < 3 * nodes; i++)
    x[CDEM_LANES * i + lane] = xyz[i / 3][i % 3];
}

/* Eight different elements; lane l is of materials[l % count]. */
static void check_batch(const cdem_element *element, int degree, const cdem_section *section,
                        const cdem_material *materials, int count) {
  static double expected[CDEM_LANES][CDEM_MAX_PAIRS * 9], single[CDEM_MAX_PAIRS * 9];
  cdem_fault fault = {0};
  cdem_tabulation t = {0};
  cdem_contraction laws[CDEM_LANES];
  const cdem_contraction *law[CDEM_LANES];
  int pairs = cdem_element_pairs(element), entries = cdem_element_dofs(element);
  entries *= entries;
  check_ok(cdem_tabulation_init(element, degree, &t, &fault));
  for (int m = 0; m < count; m++)
    check_ok(
        cdem_contraction_build(&materials[m], element->formulation, section, &laws[m], &fault));
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    double xyz[MAX_NODES][3];
    distort(element, DISTORTION, 100 + (uint64_t)lane, xyz);
    load_lane(lane, t.nodes, xyz);
    law[lane] = &laws[lane % count];
    reference_blocks(&t, &materials[lane % count], section, xyz, expected[lane]);
    check_ok(cdem_element_pair_blocks(&t, law[lane], (const double(*)[3])xyz, single, &fault));
    check_same(single, expected[lane], pairs * entries,
               ROUNDING * largest(expected[lane], pairs * entries), element->name);
  }
  for (int width = 8; width >= 2; width /= 2) {
    const cdem_kernels *kernels = cdem_kernels_of_width(width);
    if (kernels == NULL)
      continue;
    kernels->moments(&t, x, moment, least);
    kernels->blocks(pairs, law, moment, fast);
    for (int lane = 0; lane < CDEM_LANES; lane++) {
      double bound = ROUNDING * largest(expected[lane], pairs * entries);
      for (int i = 0; i < pairs * entries; i++)
        check_near(fast[CDEM_LANES * i + lane], expected[lane][i], 0, bound);
    }
  }
  cdem_tabulation_release(&t);
}

static void fast_blocks_are_the_reference_blocks(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element)
  for (int which = first_specimen(element->formulation);
       which < last_specimen(element->formulation); which++)
    for (int s = 0; s < sections(element); s++) {
      cdem_material material = specimen(which);
      check_batch(element, 0, section_of(s), &material, 1);
    }
}

/* Width 2 is always there, others only where the processor has them; no width but 8, 4 and 2. */
static void kernels_come_in_three_widths(void **state) {
  (void)state;
  assert_non_null(cdem_kernels_of_width(2));
  assert_null(cdem_kernels_of_width(1));
  assert_null(cdem_kernels_of_width(16));
}

/* Rules of more points than one chunk of the kernel holds, and of a part of one. */
static void every_rule_gives_the_reference_blocks(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) for (int degree = 2; degree <= 6; degree += 2) {
    cdem_material material = specimen(first_specimen(element->formulation));
    check_batch(element, degree, &strain_section, &material, 1);
  }
}

static void lanes_may_differ_in_material(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    cdem_material mixed[SPECIMENS], isotropic[3];
    int first = first_specimen(element->formulation), count = 0;
    for (int which = first; which < last_specimen(element->formulation); which++)
      mixed[count++] = specimen(which);
    check_batch(element, 0, &strain_section, mixed, count);
    for (int m = 0; m < 3; m++) {
      isotropic[m] = specimen(first);
      isotropic[m].parameter[1] = 0.1 * m;
    }
    check_batch(element, 0, &stress_section, isotropic, 3);
  }
}

/* c of an isotropic law is the Lame form, detected exactly there. */
static void isotropy_is_found_and_changes_nothing(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int s = 0; s < 2; s++)
    FOR_EACH_ELEMENT(element) {
      cdem_material material = specimen(first_specimen(element->formulation));
      cdem_contraction law, general;
      const cdem_contraction *shortcut[CDEM_LANES], *plain[CDEM_LANES];
      check_ok(
          cdem_contraction_build(&material, element->formulation, section_of(s), &law, &fault));
      assert_int_equal(law.isotropic, element->formulation != CDEM_PLANE_COSSERAT);
      general = law;
      general.isotropic = false;
      int values = cdem_element_pairs(element) * law.dofs * law.dofs * CDEM_LANES;
      cdem_random random = {7};
      for (int i = 0; i < values; i++)
        moment[i] = cdem_random_uniform(&random, -1, 1);
      for (int lane = 0; lane < CDEM_LANES; lane++)
        shortcut[lane] = &law, plain[lane] = &general;
      static double other[CDEM_MAX_PAIRS * 9 * CDEM_LANES];
      cdem_blocks_kernel(cdem_element_pairs(element), shortcut, moment, fast);
      cdem_blocks_kernel(cdem_element_pairs(element), plain, moment, other);
      check_same(fast, other, values, 1e-14 * largest(other, values), element->name);
    }
  for (int which = 1; which < 4; which++) {
    cdem_material material = specimen(which);
    cdem_contraction law;
    check_ok(cdem_contraction_build(&material, CDEM_SOLID, NULL, &law, &fault));
    assert_false(law.isotropic);
  }
}

/* An orthotropic material of isotropic numbers, in turned axes, is isotropic to rounding. */
static void isotropy_is_seen_through_an_orthotropic_law(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const double e = 30e9, nu = 0.3, g = e / 2.6;
  const double p[] = {e, e, e, nu, nu, nu, g, g, g};
  cdem_material material = specimen(2), plain = cdem_material_isotropic(e, nu);
  cdem_contraction law, expected;
  memcpy(material.parameter, p, sizeof p);
  check_ok(cdem_contraction_build(&material, CDEM_SOLID, NULL, &law, &fault));
  check_ok(cdem_contraction_build(&plain, CDEM_SOLID, NULL, &expected, &fault));
  /* found or not, the coefficients agree to the rounding of rotating them */
  check_same(&law.c[0][0][0][0], &expected.c[0][0][0][0], 81, 1e-15 * 6 * e, "coefficients");
  material.rotated = false;
  check_ok(cdem_contraction_build(&material, CDEM_SOLID, NULL, &law, &fault));
  assert_true(law.isotropic);
  check_near(law.mu, g, 1e-15, 0);
}

static void thickness_enters_once(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int f = CDEM_PLANE; f <= CDEM_PLANE_COSSERAT; f++) {
    cdem_formulation formulation = (cdem_formulation)f;
    cdem_material material = specimen(first_specimen(formulation));
    cdem_section thin = {CDEM_PLANE_STRESS, 1.0}, thick = {CDEM_PLANE_STRESS, 4.0};
    cdem_contraction one, four;
    check_ok(cdem_contraction_build(&material, formulation, &thin, &one, &fault));
    check_ok(cdem_contraction_build(&material, formulation, &thick, &four, &fault));
    for (int i = 0; i < 81; i++)
      check_near((&four.c[0][0][0][0])[i], 4.0 * (&one.c[0][0][0][0])[i], 1e-15, 0);
    check_near(four.lambda, 4.0 * one.lambda, 1e-15, 0);
  }
}

/* Smallest determinant by the largest in size, from the element's own rule and basis. */
static double expected_least(const cdem_element *element, double (*xyz)[3]) {
  cdem_quadrature rule;
  double low = INFINITY, size = 0.0;
  assert_true(element->quadrature(0, &rule));
  for (int q = 0; q < rule.points; q++) {
    double dn[MAX_NODES][3], j[9] = {0};
    element->shape_functions(rule.xi[q], NULL, dn);
    for (int a = 0; a < cdem_element_nodes(element); a++)
      for (int i = 0; i < 9; i++)
        j[i] += xyz[a][i / 3] * dn[a][i % 3];
    double det = cdem_element_dimension(element) == 2 ? j[0] * j[4] - j[1] * j[3] : cdem_det3(j);
    low = fmin(low, det);
    size = fmax(size, fabs(det));
  }
  return low / size;
}

/* least: shapes distorted until many are inverted or folded, and one turned inside out. */
static void least_tells_bad_elements(void **state) {
  (void)state;
  cdem_fault fault = {0};
  FOR_EACH_ELEMENT(element) {
    cdem_tabulation t = {0};
    int last = cdem_element_dimension(element) - 1, nodes = cdem_element_nodes(element);
    double expected[CDEM_LANES];
    check_ok(cdem_tabulation_init(element, 0, &t, &fault));
    for (int lane = 0; lane < CDEM_LANES; lane++) {
      double xyz[MAX_NODES][3];
      distort(element, lane < 2 ? 0.0 : 0.3 * lane, 40 + (uint64_t)lane, xyz);
      for (int a = 0; a < nodes && lane == 1; a++)
        xyz[a][last] = -xyz[a][last];
      load_lane(lane, nodes, xyz);
      expected[lane] = lane < 2 ? 1.0 - 2.0 * lane : expected_least(element, xyz);
    }
    for (int width = 8; width >= 2; width /= 2)
      if (cdem_kernels_of_width(width) != NULL) {
        cdem_kernels_of_width(width)->moments(&t, x, moment, least);
        /* det of J with cancellation */
        check_same(least, expected, CDEM_LANES, 1e-12, element->name);
      }
    for (int i = 0; i < 3 * nodes; i++) /* all in one plane */
      for (int lane = 0; lane < CDEM_LANES && i % 3 == last; lane++)
        x[CDEM_LANES * i + lane] = 0.0;
    cdem_moments_kernel(&t, x, moment, least);
    for (int lane = 0; lane < CDEM_LANES; lane++)
      assert_true(least[lane] == 0.0);
    cdem_tabulation_release(&t);
  }
}

static void out_of_memory_leaves_nothing_behind(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const cdem_element *element = cdem_element_find("hex8");
  cdem_tabulation t = {0};
  double xyz[MAX_NODES][3], s[28 * 9];
  int failures = 0;
  for (;; failures++) {
    cdem_memory_fail_after(failures);
    cdem_status status = cdem_tabulation_init(element, 0, &t, &fault);
    cdem_memory_fail_after(-1);
    if (status == CDEM_OK)
      break;
    assert_int_equal(status, CDEM_MEMORY);
    assert_non_null(strstr(fault.message, "out of memory"));
    assert_null(t.weight);
    assert_null(t.corner);
    memset(&fault, 0, sizeof fault);
  }
  assert_int_equal(failures, 4); /* weight, n, dn, corner */
  cdem_material material = specimen(0);
  cdem_contraction law;
  check_ok(cdem_contraction_build(&material, CDEM_SOLID, NULL, &law, &fault));
  distort(element, DISTORTION, 5, xyz);
  s[0] = 7.0;
  cdem_memory_fail_after(0);
  check_fails(cdem_element_pair_blocks(&t, &law, (const double(*)[3])xyz, s, &fault), CDEM_MEMORY,
              "out of memory");
  cdem_memory_fail_after(-1);
  assert_true(s[0] == 7.0);
  cdem_tabulation_release(&t);
  assert_null(t.dn);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fast_blocks_are_the_reference_blocks),
      cmocka_unit_test(kernels_come_in_three_widths),
      cmocka_unit_test(every_rule_gives_the_reference_blocks),
      cmocka_unit_test(lanes_may_differ_in_material),
      cmocka_unit_test(isotropy_is_found_and_changes_nothing),
      cmocka_unit_test(isotropy_is_seen_through_an_orthotropic_law),
      cmocka_unit_test(thickness_enters_once),
      cmocka_unit_test(least_tells_bad_elements),
      cmocka_unit_test(out_of_memory_leaves_nothing_behind),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
