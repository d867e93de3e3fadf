/* Room fdem: grain shapes and their modes. */
#include "fdem/template.h"

#include "support/test.h"

static cdem_fault fault;
static const double unit_ball = 4.18879020478639098;

typedef struct {
  const char *name;
  int refinement;
} which;
static const which shapes[] = {{"icosphere", 0},   {"icosphere", 1},  {"tetrasphere", 1},
                               {"tetrasphere", 2}, {"cubesphere", 1}, {"cubesphere", 2},
                               {"cubesphere", 3}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static cdem_template make(which w, const cdem_material *material) {
  cdem_template t;
  cdem_template_options options = {.shape = cdem_grain_shape_find(w.name),
                                   .options = {.refinement = w.refinement},
                                   .material = material};
  assert_non_null(options.shape);
  check_ok(cdem_template_init(&options, true, &t, &fault));
  return t;
}

/* The source's grain: 80 elements, 205 nodes, 162 of them at the surface. */
static void test_sizes(void **state) {
  (void)state;
  cdem_material rock = cdem_material_isotropic(40e9, 0.2);
  cdem_template t = make((which){"icosphere", 1}, &rock);
  assert_int_equal(t.nodes, 205);
  assert_int_equal(t.mesh.cells, 80);
  assert_int_equal(t.surface.nodes, 162);
  assert_int_equal(t.modes, 609);
  cdem_template_release(&t);
  t = make((which){"cubesphere", 2}, &rock);
  assert_int_equal(t.nodes, 53);
  assert_int_equal(t.mesh.cells, 32);
  assert_int_equal(t.surface.nodes, 26);
  cdem_template_release(&t);
}

static void test_reference(void **state) {
  (void)state;
  cdem_material rock = cdem_material_isotropic(40e9, 0.2);
  for (int i = 0; i < SHAPES; i++) {
    cdem_template t = make(shapes[i], &rock);
    double mass = 0.0, least = INFINITY;
    for (int32_t n = 0; n < t.nodes; n++) {
      mass += t.mass[n];
      least = fmin(least, t.mass[n]);
    }
    check_near(mass, unit_ball, 1e-12, 0.0);
    assert_true(least > 0.0);
    /* Symmetric shapes: the same inertia about all axes, a little above the ball's 2/5 m r^2. */
    for (int k = 0; k < 9; k++)
      check_near(t.inertia[k], k % 4 == 0 ? t.inertia[0] : 0.0, 1e-12, 1e-12);
    check_near(t.inertia[0], 0.4 * unit_ball, 0.12, 0.0);
    assert_true(t.inertia[0] > 0.4 * unit_ball);
    cdem_template_release(&t);
  }
}

/* phi^T M phi = 1, phi^T K phi = lambda, no part of a rigid motion; K of a rigid motion vanishes.
 */
static void test_modes(void **state) {
  (void)state;
  cdem_material rock = cdem_material_isotropic(1.0, 0.2);
  for (int i = 0; i < SHAPES; i++) {
    cdem_template t = make(shapes[i], &rock);
    int64_t size = 3 * (int64_t)t.nodes;
    double *force = cdem_allocate(size, sizeof *force, NULL);
    for (int k = 0; k < t.modes; k += 7) {
      const double *phi = t.mode + k * size;
      double unit = 0.0, energy = 0.0, rigid[6] = {0.0};
      for (int64_t r = 0; r < size; r++) {
        force[r] = 0.0;
        for (int64_t c = 0; c < size; c++)
          force[r] += t.stiffness[size * r + c] * phi[c];
        unit += t.mass[r / 3] * phi[r] * phi[r];
        energy += phi[r] * force[r];
      }
      for (int32_t n = 0; n < t.nodes; n++) {
        double turn[3];
        cdem_cross3(t.mesh.xyz + 3 * n, phi + 3 * n, turn);
        for (int c = 0; c < 3; c++) {
          rigid[c] += t.mass[n] * phi[3 * n + c];
          rigid[3 + c] += t.mass[n] * turn[c];
        }
      }
      check_near(unit, 1.0, 1e-12, 0.0);
      check_near(energy, t.lambda[k], 1e-9, 0.0);
      for (int c = 0; c < 6; c++)
        check_near(rigid[c], 0.0, 0.0, 1e-12);
    }
    free(force);
    cdem_template_release(&t);
  }
}

/* Lamb 1882: the lowest vibration of a free ball is the torsion of degree 2, whose wave number
 * is 2.501 over the radius, below that of the spheroidal one (2.64 for nu = 0.25). The error of
 * linear elements goes with the square of their size. */
static void test_ball_vibrates(void **state) {
  (void)state;
  cdem_material rock = cdem_material_isotropic(1.0, 0.25);
  const double shear = 1.0 / 2.5, exact = 2.501;
  double x[2];
  for (int i = 0; i < 2; i++) {
    cdem_template t = make((which){"cubesphere", 2 << i}, &rock);
    x[i] = sqrt(t.lambda[0] / shear);
    cdem_template_release(&t);
  }
  check_below(fabs(x[1] - exact), 0.35 * fabs(x[0] - exact));
  check_near((4.0 * x[1] - x[0]) / 3.0, exact, 0.01, 0.0);
}

/* A ball pulled along z by surface tractions p n_z e_z is stressed evenly by p: the modes answer
 * with the strains p/E, -nu p/E, whatever the mesh. */
static void test_even_stress(void **state) {
  (void)state;
  const double young = 3.0, poisson = 0.3, pull = 0.01;
  cdem_material rock = cdem_material_isotropic(young, poisson);
  cdem_template t = make((which){"tetrasphere", 2}, &rock);
  int64_t size = 3 * (int64_t)t.nodes;
  double *force = cdem_allocate(size, sizeof *force, NULL);
  for (int32_t f = 0; f < t.surface.triangles; f++) {
    const int32_t *node = t.surface.triangle + 3 * f;
    double a[3], b[3], n[3];
    for (int c = 0; c < 3; c++) {
      a[c] = t.surface.reference[3 * node[1] + c] - t.surface.reference[3 * node[0] + c];
      b[c] = t.surface.reference[3 * node[2] + c] - t.surface.reference[3 * node[0] + c];
    }
    cdem_cross3(a, b, n);
    for (int k = 0; k < 3; k++)
      force[3 * node[k] + 2] += pull * 0.5 * n[2] / 3.0;
  }
  double *u = cdem_allocate(size, sizeof *u, NULL);
  for (int k = 0; k < t.modes; k++) {
    double load = 0.0;
    for (int64_t r = 0; r < size; r++)
      load += t.mode[k * size + r] * force[r];
    for (int64_t r = 0; r < size; r++)
      u[r] += t.mode[k * size + r] * load / t.lambda[k];
  }
  for (int32_t n = 1; n < t.nodes; n++) { /* how far from the first node: turning does not count */
    double grown = 0.0, expected = 0.0;
    for (int c = 0; c < 3; c++) {
      double d = t.mesh.xyz[3 * n + c] - t.mesh.xyz[c];
      grown += d * (u[3 * n + c] - u[c]);
      expected += d * (c == 2 ? 1.0 : -poisson) * pull / young * d;
    }
    check_near(grown, expected, 1e-10, 1e-12);
  }
  free(force);
  free(u);
  cdem_template_release(&t);
}

static void test_any_mesh(void **state) {
  (void)state;
  cdem_material rock = cdem_material_isotropic(1.0, 0.2);
  cdem_mesh box;
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_HEX8, .count = {3, 2, 2}, .size = {3.0, 2.0, 1.0}};
  check_ok(cdem_mesh_grid(&grid, &box, &fault));
  cdem_template_options options = {
      .shape = cdem_grain_shape_find("mesh"), .options = {.mesh = &box}, .material = &rock};
  cdem_template t;
  check_ok(cdem_template_init(&options, false, &t, &fault));
  assert_int_equal(t.surface.nodes, box.nodes - 2);
  const double size2 = pow(6.0 / unit_ball, 2.0 / 3.0);
  check_near(t.inertia[0], unit_ball * (4.0 + 1.0) / 12.0 / size2, 1e-12, 0.0);
  check_near(t.inertia[4], unit_ball * (9.0 + 1.0) / 12.0 / size2, 1e-12, 0.0);
  check_near(t.inertia[8], unit_ball * (9.0 + 4.0) / 12.0 / size2, 1e-12, 0.0);
  assert_null(t.stiffness);
  cdem_template_release(&t);
  cdem_mesh_release(&box);
}

static void test_errors(void **state) {
  (void)state;
  cdem_material rock = cdem_material_isotropic(1.0, 0.2);
  cdem_template t;
  cdem_template_options options = {
      .shape = cdem_grain_shape_find("icosphere"), .options = {.refinement = 7}, .material = &rock};
  check_fails(cdem_template_init(&options, false, &t, &fault), CDEM_INPUT,
              "refinement 7 of the grain shape 'icosphere': it must be 0 to 2");
  options.shape = cdem_grain_shape_find("mesh");
  check_fails(cdem_template_init(&options, false, &t, &fault), CDEM_INPUT,
              "needs a mesh of solid cells");
  /* Two tetrahedra that share an edge swing about it. */
  const double xyz[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}};
  const int32_t tet[2][4] = {{0, 1, 2, 3}, {0, 1, 4, 5}};
  cdem_mesh two = {0};
  check_ok(cdem_mesh_add_nodes(&two, 6, xyz[0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(&two, CDEM_SHAPE_TET4, 2, tet[0], NULL, &fault));
  options.options.mesh = &two;
  assert_int_not_equal(cdem_template_init(&options, false, &t, &fault), CDEM_OK);
  cdem_mesh_release(&two);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_sizes),       cmocka_unit_test(test_reference),
      cmocka_unit_test(test_modes),       cmocka_unit_test(test_ball_vibrates),
      cmocka_unit_test(test_even_stress), cmocka_unit_test(test_any_mesh),
      cmocka_unit_test(test_errors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
