/* Room verify: specimens have edges of length 1, the blocks of their element, and rotations scaled.
 */
#include "verify/specimen.h"

#include "support/test.h"

static cdem_specimen made(const char *name, cdem_specimen_options options) {
  cdem_fault fault = {0};
  cdem_specimen specimen = {0};
  options.element = cdem_element_find(name);
  assert_non_null(options.element);
  check_ok(cdem_specimen_init(&options, &specimen, &fault));
  return specimen;
}

/* Between corners all edges of the shape are 1 long; second-order elements have nodes in the
 * middle. */
static void edges_have_unit_length(void **state) {
  (void)state;
  for (int e = 0; e < CDEM_ELEMENT_COUNT; e++) {
    const cdem_element *element = cdem_element_get((cdem_element_id)e);
    const cdem_shape_info *shape = cdem_shape_get(element->shape);
    cdem_specimen specimen = made(element->name, (cdem_specimen_options){0});
    for (int k = 0; k < shape->edges; k++) {
      const double *a = specimen.xyz[shape->edge[k][0]], *b = specimen.xyz[shape->edge[k][1]];
      double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      check_near(cdem_norm3(along), 1.0, 0, 1e-15);
      for (int d = 0; d < 3 && shape->edge[k][2] >= 0; d++)
        check_near(specimen.xyz[shape->edge[k][2]][d], 0.5 * (a[d] + b[d]), 0, 1e-15);
    }
    cdem_specimen_release(&specimen);
  }
}

/* Against the reference B^T D B; Cosserat rotations scaled by the characteristic length. */
static void blocks_are_the_element_stiffness(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int e = 0; e < CDEM_ELEMENT_COUNT; e++) {
    cdem_specimen specimen = made(cdem_element_get((cdem_element_id)e)->name,
                                  (cdem_specimen_options){.young = 3,
                                                          .box = {1.2, 0.8, 0.9},
                                                          .section = {CDEM_PLANE_STRESS, 0.3},
                                                          .length = 0.7});
    const cdem_element *element = specimen.options.element;
    const cdem_material material = cdem_specimen_material(&specimen, 0.2);
    double length = cdem_material_length(&material);
    int size = specimen.family.size, n = size * cdem_element_nodes(element);
    double s[CDEM_MAX_PAIRS * 9], *k = calloc((size_t)n * (size_t)n, sizeof *k);
    check_ok(cdem_specimen_blocks(&specimen, 0.2, s, &fault));
    check_ok(cdem_element_stiffness(&specimen.tabulation, &material, &specimen.options.section,
                                    (const double(*)[3])specimen.xyz, k, &fault));
    for (int p = 0; p < cdem_element_pairs(element); p++) {
      cdem_specimen_pair pair = cdem_specimen_pair_at(&specimen, p);
      for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
          double scale = 1.0;
          if (element->formulation == CDEM_PLANE_COSSERAT)
            scale = (i == 2 ? length : 1.0) * (j == 2 ? length : 1.0);
          double entry = k[(size * pair.node[0] + i) * n + size * pair.node[1] + j];
          check_near(scale * s[(p * size + i) * size + j], -entry, 1e-12, 1e-13);
        }
    }
    free(k);
    cdem_specimen_release(&specimen);
  }
}

static void pairs_and_classes(void **state) {
  (void)state;
  cdem_specimen cube = made("hex8", (cdem_specimen_options){0});
  const int expected[][4] = {{0, 0, 1, CDEM_CLASS_EDGE},
                             {1, 0, 2, CDEM_CLASS_FACE},
                             {5, 0, 6, CDEM_CLASS_BODY},
                             {7, 1, 2, CDEM_CLASS_EDGE},
                             {27, 6, 7, CDEM_CLASS_EDGE}};
  for (int i = 0; i < 5; i++) {
    cdem_specimen_pair pair = cdem_specimen_pair_at(&cube, expected[i][0]);
    assert_int_equal(pair.node[0], expected[i][1]);
    assert_int_equal(pair.node[1], expected[i][2]);
    assert_int_equal(pair.class_, expected[i][3]);
  }
  cdem_specimen_release(&cube);
}

/* Every pair for which a closed form is claimed, not only the first of its class. */
static void closed_forms_hold_for_all_pairs(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const struct {
    const char *name;
    double box[3];
    bool known;
  } cases[] = {{"hex8", {2, 2, 2}, true},           {"hex8", {2, 2, 1}, false},
               {"quad4", {1.5, 0.7, 1}, true},      {"tri3", {3, 3, 1}, true},
               {"tri3", {3, 2, 1}, false},          {"tet4", {1, 1, 1}, false},
               {"quad4-cosserat", {1, 1, 1}, false}};
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    cdem_specimen_options options = {.young = 5};
    memcpy(options.box, cases[c].box, sizeof options.box);
    cdem_specimen specimen = made(cases[c].name, options);
    for (int p = 0; p < cdem_element_pairs(specimen.options.element); p++) {
      cdem_specimen_pair pair = cdem_specimen_pair_at(&specimen, p);
      cdem_poisson_family family = cdem_specimen_family(&pair);
      cdem_poisson_study study;
      cdem_poisson_row row;
      check_ok(cdem_poisson_study_init(&family, &study, &fault));
      check_ok(cdem_poisson_at(&study, 0.31, &row, &fault));
      assert_int_equal(!isnan(row.difference), cases[c].known);
      if (cases[c].known)
        check_below(row.difference, 1e-13);
    }
    cdem_specimen_release(&specimen);
  }
}

/* The form a decomposition finds is the form the critical ratios tell, for every element, distorted
 * or not; near a change (cond(P) above 100) the decomposition may call it otherwise. */
static void roots_tell_the_form_everywhere(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_random random = {51};
  for (int e = 0; e < 2 * CDEM_ELEMENT_COUNT; e++) {
    cdem_specimen specimen =
        made(cdem_element_get((cdem_element_id)(e / 2))->name, (cdem_specimen_options){0});
    if (e % 2 == 1) {
      cdem_specimen_options options = specimen.options;
      double xyz[CDEM_SHAPE_MAX_NODES][3];
      memcpy(xyz, specimen.xyz, sizeof xyz);
      for (int a = 0; a < cdem_element_nodes(options.element); a++)
        for (int d = 0; d < cdem_element_dimension(options.element); d++)
          xyz[a][d] += cdem_random_uniform(&random, -0.06, 0.06);
      options.xyz = (const double(*)[3])xyz;
      cdem_specimen_release(&specimen);
      check_ok(cdem_specimen_init(&options, &specimen, &fault));
    }
    for (int p = 0; p < cdem_element_pairs(specimen.options.element) && p < 2; p++) {
      cdem_specimen_pair pair = cdem_specimen_pair_at(&specimen, p);
      cdem_poisson_family family = cdem_specimen_family(&pair);
      cdem_poisson_study study;
      check_ok(cdem_poisson_study_init(&family, &study, &fault));
      for (int i = 0; i < 40; i++) {
        double nu = cdem_random_uniform(&random, -0.99, 0.49), s[9];
        cdem_spring_set set;
        check_ok(family.block(family.context, nu, s, &fault));
        check_ok(cdem_springs_from_block(s, family.size, false, &set, &fault));
        int below = 0;
        while (below < study.roots.count && study.roots.root[below].nu < nu)
          below++;
        cdem_form form = below == 0 ? study.roots.start : study.roots.root[below - 1].to;
        if (set.cond < 100 && !study.roots.double_everywhere)
          assert_int_equal(set.form, form);
      }
    }
    cdem_specimen_release(&specimen);
  }
}

static void mistakes_are_told(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_specimen specimen = {0};
  const double flat[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  cdem_specimen_options options = {.element = cdem_element_find("quad4"), .xyz = flat};
  check_fails(cdem_specimen_init(&options, &specimen, &fault), CDEM_INPUT, "");
  assert_null(specimen.moment);
  options.xyz = NULL;
  for (int i = 0; i < 8; i++) {
    cdem_memory_fail_after(i);
    cdem_status status = cdem_specimen_init(&options, &specimen, NULL);
    cdem_memory_fail_after(-1);
    if (status == CDEM_OK)
      break;
    assert_int_equal(status, CDEM_MEMORY);
    assert_null(specimen.moment);
  }
  assert_non_null(specimen.moment);
  double s[CDEM_MAX_PAIRS * 9];
  check_fails(cdem_specimen_blocks(&specimen, 0.5, s, &fault), CDEM_INPUT, "poisson");
  cdem_specimen_release(&specimen);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(edges_have_unit_length),
      cmocka_unit_test(blocks_are_the_element_stiffness),
      cmocka_unit_test(pairs_and_classes),
      cmocka_unit_test(closed_forms_hold_for_all_pairs),
      cmocka_unit_test(roots_tell_the_form_everywhere),
      cmocka_unit_test(mistakes_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
