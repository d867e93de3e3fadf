/* Room elements: basis functions. Laws (partition of unity, nodal delta, derivatives) and an
 * independent reference: gmsh's own basis functions and node coordinates of the same elements. */
#include "elements/specimens.h"

#include <gmshc.h>

/* gmsh keeps what it once made for prisms; the leak checker of the sanitizer builds asks here. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libgmsh";
}

/* A point inside the reference shape. */
static void inside(const cdem_element *element, cdem_random *random, double xi[3]) {
  double weight[MAX_NODES], sum = 0.0;
  int corners = cdem_shape_get(element->shape)->corners;
  for (int a = 0; a < corners; a++)
    sum += weight[a] = cdem_random_uniform(random, 0.05, 1.0);
  memset(xi, 0, 3 * sizeof *xi);
  for (int a = 0; a < corners; a++)
    for (int i = 0; i < 3; i++)
      xi[i] += weight[a] / sum * element->reference[a][i];
}

static void basis_sums_to_one(void **state) {
  (void)state;
  cdem_random random = {1};
  FOR_EACH_ELEMENT(element) for (int trial = 0; trial < 10; trial++) {
    double xi[3], n[MAX_NODES], dn[MAX_NODES][3], sum = 0.0, slope[3] = {0};
    inside(element, &random, xi);
    element->shape_functions(xi, n, dn);
    for (int a = 0; a < cdem_element_nodes(element); a++) {
      sum += n[a];
      for (int k = 0; k < 3; k++)
        slope[k] += dn[a][k];
    }
    check_near(sum, 1.0, 1e-14, 0); /* some ulp a node */
    for (int k = 0; k < 3; k++)
      check_near(slope[k], 0.0, 0, 1e-13);
  }
}

static void basis_is_one_at_its_node(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) for (int b = 0; b < cdem_element_nodes(element); b++) {
    double n[MAX_NODES];
    element->shape_functions(element->reference[b], n, NULL);
    for (int a = 0; a < cdem_element_nodes(element); a++)
      check_near(n[a], a == b ? 1.0 : 0.0, 0, 1e-15);
  }
}

/* Basis functions reproduce the position, so that x = sum N_a x_a has constant fields of strain. */
static void basis_reproduces_position(void **state) {
  (void)state;
  cdem_random random = {2};
  FOR_EACH_ELEMENT(element) for (int trial = 0; trial < 10; trial++) {
    double xi[3], n[MAX_NODES], sum[3] = {0};
    inside(element, &random, xi);
    element->shape_functions(xi, n, NULL);
    for (int a = 0; a < cdem_element_nodes(element); a++)
      for (int i = 0; i < 3; i++)
        sum[i] += n[a] * element->reference[a][i];
    for (int i = 0; i < 3; i++)
      check_near(sum[i], xi[i], 0, 1e-14);
  }
}

static void derivatives_match_differences(void **state) {
  (void)state;
  cdem_random random = {3};
  /* central differences: error h^2 N'''/6 (rational pyramid: N''' of some 100 near the apex) plus
   * rounding 1e-16/h, both below 1e-8 at h = 1e-5 */
  const double h = 1e-5;
  FOR_EACH_ELEMENT(element) for (int trial = 0; trial < 10; trial++) {
    double xi[3], dn[MAX_NODES][3], plus[MAX_NODES], minus[MAX_NODES];
    inside(element, &random, xi);
    element->shape_functions(xi, NULL, dn);
    for (int k = 0; k < 3; k++) {
      double up[3] = {xi[0], xi[1], xi[2]}, down[3] = {xi[0], xi[1], xi[2]};
      up[k] += h, down[k] -= h;
      element->shape_functions(up, plus, NULL);
      element->shape_functions(down, minus, NULL);
      for (int a = 0; a < cdem_element_nodes(element); a++)
        if (k < cdem_element_dimension(element))
          check_near(dn[a][k], (plus[a] - minus[a]) / (2 * h), 0, 1e-8);
        else
          assert_true(dn[a][k] == 0.0);
    }
  }
}

/* gmsh's element type of a shape. */
static int gmsh_type(const cdem_element *element) {
  static const struct {
    cdem_shape shape;
    const char *family;
    int order, serendipity;
  } types[] = {{CDEM_SHAPE_TRI3, "Triangle", 1, 0},    {CDEM_SHAPE_TRI6, "Triangle", 2, 0},
               {CDEM_SHAPE_QUAD4, "Quadrangle", 1, 0}, {CDEM_SHAPE_QUAD8, "Quadrangle", 2, 1},
               {CDEM_SHAPE_TET4, "Tetrahedron", 1, 0}, {CDEM_SHAPE_TET10, "Tetrahedron", 2, 0},
               {CDEM_SHAPE_PYR5, "Pyramid", 1, 0},     {CDEM_SHAPE_WEDGE6, "Prism", 1, 0},
               {CDEM_SHAPE_HEX8, "Hexahedron", 1, 0},  {CDEM_SHAPE_HEX20, "Hexahedron", 2, 1}};
  int failed = 0;
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    if (types[i].shape == element->shape)
      return gmshModelMeshGetElementType(types[i].family, types[i].order, types[i].serendipity,
                                         &failed);
  fail_msg("element %s has no gmsh counterpart in this test", element->name);
  return 0;
}

static void nodes_are_in_the_order_of_gmsh(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    char *name = NULL;
    double *local = NULL;
    size_t count = 0;
    int dimension, order, nodes, primary, failed = 0;
    gmshModelMeshGetElementProperties(gmsh_type(element), &name, &dimension, &order, &nodes, &local,
                                      &count, &primary, &failed);
    assert_int_equal(failed, 0);
    assert_int_equal(nodes, cdem_element_nodes(element));
    assert_int_equal(dimension, cdem_element_dimension(element));
    assert_int_equal(primary, cdem_shape_get(element->shape)->corners);
    for (int a = 0; a < nodes; a++)
      for (int i = 0; i < dimension; i++)
        check_near(element->reference[a][i], local[dimension * a + i], 0, 1e-15);
    gmshFree(name);
    gmshFree(local);
  }
}

/* values [nodes][components] of gmsh at xi. */
static double *gmsh_values(const cdem_element *element, double xi[3], const char *space,
                           int components) {
  double *values = NULL;
  size_t count = 0;
  int found = 0, orientations = 0, failed = 0;
  gmshModelMeshGetBasisFunctions(gmsh_type(element), xi, 3, space, &found, &values, &count,
                                 &orientations, NULL, 0, &failed);
  assert_int_equal(failed, 0);
  assert_int_equal(found, components);
  assert_int_equal(count, components * cdem_element_nodes(element));
  return values;
}

static void basis_is_that_of_gmsh(void **state) {
  (void)state;
  cdem_random random = {4};
  FOR_EACH_ELEMENT(element) for (int trial = 0; trial < 5; trial++) {
    double xi[3], n[MAX_NODES], dn[MAX_NODES][3];
    inside(element, &random, xi);
    element->shape_functions(xi, n, dn);
    double *value = gmsh_values(element, xi, "Lagrange", 1);
    double *gradient = gmsh_values(element, xi, "GradLagrange", 3);
    for (int a = 0; a < cdem_element_nodes(element); a++) {
      /* gmsh inverts a Vandermonde matrix of condition below 1e3 */
      check_near(n[a], value[a], 0, 1e-13);
      for (int k = 0; k < 3; k++)
        check_near(dn[a][k], gradient[3 * a + k], 0, 2e-12);
    }
    gmshFree(value);
    gmshFree(gradient);
  }
}

static void table_finds_elements(void **state) {
  (void)state;
  FOR_EACH_ELEMENT(element) {
    assert_ptr_equal(cdem_element_find(element->name), element);
    assert_ptr_equal(cdem_element_for(element->shape, element->formulation), element);
    assert_true(cdem_element_pairs(element) <= CDEM_MAX_PAIRS);
    assert_non_null(element->basis);
    assert_non_null(element->rule);
  }
  assert_null(cdem_element_find("hex9"));
  assert_null(cdem_element_for(CDEM_SHAPE_LINE2, CDEM_SOLID));
  assert_null(cdem_element_for(CDEM_SHAPE_HEX8, CDEM_PLANE));
}

static int start_gmsh(void **state) {
  (void)state;
  int failed = 0;
  gmshInitialize(0, NULL, 0, &failed);
  gmshOptionSetNumber("General.Terminal", 0, &failed);
  gmshOptionSetNumber("General.AbortOnError", 0, &failed);
  return failed;
}

static int stop_gmsh(void **state) {
  (void)state;
  int failed = 0;
  gmshFinalize(&failed);
  return failed;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(basis_sums_to_one),
      cmocka_unit_test(basis_is_one_at_its_node),
      cmocka_unit_test(basis_reproduces_position),
      cmocka_unit_test(derivatives_match_differences),
      cmocka_unit_test(nodes_are_in_the_order_of_gmsh),
      cmocka_unit_test(basis_is_that_of_gmsh),
      cmocka_unit_test(table_finds_elements),
  };
  return cmocka_run_group_tests(tests, start_gmsh, stop_gmsh);
}
