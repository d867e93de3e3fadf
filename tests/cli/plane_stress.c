/* Plane stress quadrilaterals: the static solution of the solver against a dense finite-element
 * solution by a second derivation (reference_element.c), which takes plane stress from the moduli
 * of the solid. CalculiX is no reference here: it expands CPS4 into solids. */
#include "cdem/cdem.h"
#include "reference_element.h"
#include "support/test.h"

#include <string.h>

enum { NX = 6, NY = 4, NODES = (NX + 1) * (NY + 1), DOFS = 2 * NODES };

static const double young = 210e9, poisson = 0.3, thickness = 0.02, pull[2] = {3e4, -1e4};

static cdem_fault fault;

/* Adds the mesh's elements to a dense matrix. */
static void assemble(const cdem_mesh *mesh, double *matrix) {
  reference_material material = {.plane_stress = true, .thickness = thickness};
  const reference_element *element = reference_element_find("quad4");
  assert_non_null(element);
  reference_isotropic(young, poisson, material.moduli);
  for (int32_t c = 0; c < mesh->cells; c++) {
    if (mesh->cell_shape[c] != CDEM_SHAPE_QUAD4)
      continue;
    const int32_t *node = cdem_mesh_cell(mesh, c);
    double x[4][3], k[64];
    for (int a = 0; a < 4; a++)
      memcpy(x[a], mesh->xyz + 3 * node[a], sizeof x[a]);
    assert_true(reference_stiffness(element, (const double(*)[3])x, &material, k) > 0);
    for (int i = 0; i < 8; i++)
      for (int j = 0; j < 8; j++)
        matrix[(2 * node[i / 2] + i % 2) * DOFS + 2 * node[j / 2] + j % 2] += k[8 * i + j];
  }
}

/* The left side is held, the nodes of the right side are pulled alike. */
static void solve_reference(const cdem_mesh *mesh, double *u) {
  double *matrix = calloc((size_t)DOFS * DOFS, sizeof *matrix);
  assemble(mesh, matrix);
  memset(u, 0, DOFS * sizeof *u);
  for (int n = 0; n < NODES; n++)
    for (int k = 0; k < 2; k++) {
      int row = 2 * n + k;
      if (mesh->xyz[3 * n] > 0.999)
        u[row] = pull[k];
      if (mesh->xyz[3 * n] >= 0.001)
        continue;
      for (int j = 0; j < DOFS; j++)
        matrix[row * DOFS + j] = matrix[j * DOFS + row] = 0.0;
      matrix[row * DOFS + row] = young * thickness;
    }
  reference_solve(DOFS, 1, matrix, u);
  free(matrix);
}

static void solve_cdem(const cdem_mesh *mesh, double *u) {
  cdem_blocks blocks = {0};
  cdem_model model = {0};
  cdem_body body = {0};
  cdem_solver solver = {0};
  const double density = 1.0;
  const cdem_material steel = cdem_material_isotropic(young, poisson);
  check_ok(cdem_blocks_init(&(cdem_blocks_options){.mesh = mesh}, &blocks, &fault));
  const cdem_model_options chosen = {
      .mesh = &blocks.mesh,
      .materials = 1,
      .material = &steel,
      .section = {.plane = CDEM_PLANE_STRESS, .thickness = thickness}};
  check_ok(cdem_model_init(&chosen, &model, &fault));
  check_ok(cdem_body_init(&model, &(cdem_body_options){.density = &density}, &body, &fault));
  assert_int_equal(blocks.mesh.nodes, NODES);
  int32_t held, pulled, *held_node, *pulled_node;
  check_ok(cdem_blocks_group_nodes(&blocks, "x0", &held, &held_node, &fault));
  check_ok(cdem_blocks_group_nodes(&blocks, "x1", &pulled, &pulled_node, &fault));
  double vector[2 * (NY + 1)];
  for (int i = 0; i < 2 * (NY + 1); i++)
    vector[i] = pull[i % 2];
  cdem_series one = {0}, none = {0};
  check_ok(cdem_series_constant(1.0, &one, &fault));
  check_ok(cdem_series_constant(0.0, &none, &fault));
  const cdem_support support[2] = {
      {.name = "x0", .component = 0, .series = none, .nodes = held, .node = held_node},
      {.name = "x0", .component = 1, .series = none, .nodes = held, .node = held_node}};
  const cdem_load load = {
      .name = "x1", .series = one, .nodes = pulled, .node = pulled_node, .vector = vector};
  const cdem_solver_options options = {.body = &body,
                                       .blocks = &blocks,
                                       .thickness = thickness,
                                       .supports = 2,
                                       .support = support,
                                       .loads = 1,
                                       .load = &load};
  check_ok(cdem_solver_init(&options, &solver, &fault));
  check_ok(cdem_solver_static(&solver, 0.0, &fault));
  for (int n = 0; n < NODES; n++)
    memcpy(u + 2 * blocks.original[n], solver.u + 2 * n, 2 * sizeof *u);
  cdem_solver_release(&solver);
  cdem_body_release(&body);
  cdem_model_release(&model);
  cdem_blocks_release(&blocks);
  cdem_series_release(&one);
  cdem_series_release(&none);
  free(held_node);
  free(pulled_node);
}

static void plane_stress_is_that_of_the_second_derivation(void **state) {
  (void)state;
  cdem_mesh mesh = {0};
  const cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_QUAD4,
                                       .count = {NX, NY, 0},
                                       .size = {1.0, 0.3, 0.0},
                                       .distortion = 0.2,
                                       .seed = 3};
  check_ok(cdem_mesh_grid(&grid, &mesh, &fault));
  double reference[DOFS], u[DOFS], largest = 0, worst = 0;
  solve_reference(&mesh, reference);
  solve_cdem(&mesh, u);
  for (int i = 0; i < DOFS; i++) {
    largest = fmax(largest, fabs(reference[i]));
    worst = fmax(worst, fabs(reference[i] - u[i]));
  }
  print_message("largest displacement %.6e m, difference %.2e of it\n", largest, worst / largest);
  assert_true(largest > 1e-6 && largest < 1e-2);
  assert_true(worst <= 1e-12 * largest);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plane_stress_is_that_of_the_second_derivation)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
