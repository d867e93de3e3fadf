/* The elastic body at its limits: large strain and any turn, elements inside out, far from the
 * origin, mixed meshes, many steps; and what it refuses. */
#include "cdem/body.h"
#include "cdem/body_store.h"
#include "cdem/body_support.h"

/* One tetrahedron deformed by any F with det F > 0: stretches over four decades, any turn. The
 * kernel's quaternion against Newton's iteration. A rotation is defined to rounding times the ratio
 * of the stretches, which is 1e4 at most here. */
static void any_rotation_is_found(void **state) {
  (void)state;
  specimen s;
  specimen_make(cdem_element_find("tet4"), &(recipe){.count = 1, .separate = true}, &s);
  double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
  double *g = new_vector(s.size);
  cdem_random random = {99};
  const double shift[3] = {0};
  for (int trial = 0; trial < 700; trial++) {
    double m[9], r[9], p[9];
    double range = trial % 2 == 0 ? 2.0 : 0.5; /* decades up and down */
    rotation_about(3, cdem_random_uniform(&random, 0.0, 7.0), r);
    for (int i = 0; i < 9; i++)
      p[i] = i % 4 == 0 ? pow(10.0, cdem_random_uniform(&random, -range, range)) : 0.0;
    cdem_product3(r, p, m);
    for (int i = 0; i < 3; i++) /* p <- r p r^T */
      for (int j = 0; j < 3; j++)
        p[3 * i + j] = cdem_dot3(m + 3 * i, r + 3 * j);
    for (int32_t n = 0; n < s.body.nodes; n++)
      for (int i = 0; i < 3; i++)
        v[3 * n + i] = cdem_dot3(p + 3 * i, s.mesh.xyz + 3 * (int64_t)n) - s.mesh.xyz[3 * n + i];
    turn_all(&s, v, trial % 7 == 0 ? acos(-1.0) : cdem_random_uniform(&random, 0.0, 7.0), shift, u);
    cdem_body_forces(&s.body, u, f);
    cdem_body_forces_reference(&s.body, u, g);
    assert_int_equal(s.body.inverted, -1);
    check_below(difference(f, g, s.size), (trial % 2 == 0 ? 1e-9 : 1e-12) * largest(g, s.size));
  }
  free(v), free(u), free(f), free(g);
  specimen_release(&s);
}

/* Half turns about each axis, exactly, where a quaternion's scalar part is zero. */
static void exact_half_turns(void **state) {
  (void)state;
  specimen s;
  specimen_make(cdem_element_find("hex8"), &(recipe){.count = 2, .distortion = 0.1}, &s);
  double *u = new_vector(s.size), *f = new_vector(s.size);
  for (int axis = 0; axis < 3; axis++) {
    for (int64_t i = 0; i < s.size; i++)
      u[i] = i % 3 == axis ? 0.0 : -2.0 * s.mesh.xyz[i];
    cdem_body_forces(&s.body, u, f);
    check_below(largest(f, s.size), 1e-12 * 40e9 * 0.5);
    check_below(fabs(cdem_body_energy(&s.body, u, NULL)), 1e-24 * 40e9);
  }
  free(u), free(f);
  specimen_release(&s);
}

/* Inside out: the first cell is named, forces stay finite; not a number is noticed too. */
static void inverted_elements_are_found(void **state) {
  (void)state;
  for (int id = 0; id < CDEM_ELEMENT_COUNT; id++) {
    const cdem_element *element = cdem_element_get((cdem_element_id)id);
    if (!first_order(element))
      continue;
    specimen s;
    specimen_make(element, &(recipe){.count = 4}, &s);
    double *u = new_vector(s.size), *f = new_vector(s.size);
    int dofs = s.body.dofs;
    assert_int_equal(cdem_body_inverted(&s.body, u), -1);
    int32_t cell = s.model.cells - 2;
    const int32_t *node = cdem_mesh_cell(&s.mesh, s.model.cell[cell]);
    for (int a = 0; a < cdem_element_nodes(element); a++) /* mirrored, neighbours torn along */
      u[(int64_t)node[a] * dofs] = -2.0 * (s.mesh.xyz[3 * (int64_t)node[a]] - 1.0);
    cdem_body_forces(&s.body, u, f);
    assert_true(s.body.inverted >= 0 && s.body.inverted <= cell);
    assert_int_equal(cdem_body_inverted(&s.body, u), s.body.inverted);
    for (int64_t i = 0; i < s.size; i++)
      assert_true(isfinite(f[i]));
    memset(u, 0, (size_t)s.size * sizeof *u);
    for (int64_t i = 0; i < s.size; i++) /* all nodes at one place: F = 0 */
      u[i] = i % dofs < s.model.dimension ? -s.mesh.xyz[3 * (i / dofs) + i % dofs] : 0.0;
    cdem_body_forces(&s.body, u, f);
    for (int64_t i = 0; i < s.size; i++)
      assert_true(isfinite(f[i]));
    memset(u, 0, (size_t)s.size * sizeof *u);
    u[(int64_t)node[0] * dofs] = NAN;
    cdem_body_forces(&s.body, u, f);
    assert_true(s.body.inverted >= 0);
    free(u), free(f);
    specimen_release(&s);
  }
}

/* 4000 km away, and where the coordinates allow it to the bit: displacements are kept, not places.
 */
static void far_from_the_origin(void **state) {
  (void)state;
  cdem_fault fault = {0};
  double *f[2];
  int64_t size = 0;
  for (int far = 0; far < 2; far++) {
    specimen s = {.density = 2700.0, .material = rock(cdem_element_find("hex8"))};
    cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_HEX8,
                                   .count = {3, 3, 3},
                                   .size = {1, 1, 1},
                                   .distortion = 0.2,
                                   .seed = 3};
    check_ok(cdem_mesh_grid(&grid, &s.mesh, &fault));
    for (int64_t i = 0; i < 3 * (int64_t)s.mesh.nodes; i++)
      s.mesh.xyz[i] = ldexp(rint(ldexp(s.mesh.xyz[i], 20)), -20) + (far ? 0x1p22 : 0.0);
    specimen_build(&(recipe){0}, &s);
    double *u = new_vector(s.size);
    size = s.size;
    f[far] = new_vector(size);
    shake(&s, 1e-9, 6, u);
    cdem_body_forces(&s.body, u, f[far]);
    free(u);
    specimen_release(&s);
  }
  assert_true(largest(f[0], size) > 0.0);
  check_below(difference(f[0], f[1], size), 1e-13 * largest(f[0], size));
  free(f[0]), free(f[1]);
}

/* Triangles and quadrangles of two materials in one mesh, with a node of no cell in between. */
static void mixed_mesh(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_body body = {0};
  const double xyz[7][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {9, 9, 0},
                            {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  const int32_t quad[4] = {0, 1, 5, 4}, tri[2][3] = {{1, 2, 5}, {2, 6, 5}};
  const int32_t left[] = {0}, right[] = {1, 2};
  check_ok(cdem_mesh_add_nodes(&mesh, 7, &xyz[0][0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_QUAD4, 1, quad, NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_TRI3, 2, &tri[0][0], NULL, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "left", 2, 1, left, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "right", 2, 2, right, &fault));
  const cdem_material rocks[2] = {cdem_material_isotropic(1e9, 0.2),
                                  cdem_material_isotropic(4e9, 0.3)};
  const char *groups[] = {"left", "right"};
  const int which[] = {0, 1};
  cdem_model_options options = {.mesh = &mesh,
                                .materials = 2,
                                .material = rocks,
                                .assignments = 2,
                                .assigned_group = groups,
                                .assigned_material = which,
                                .default_material = -1,
                                .section = {CDEM_PLANE_STRAIN, 1.0}};
  check_ok(cdem_model_init(&options, &model, &fault));
  const double density[] = {1000.0, 2000.0};
  check_ok(cdem_body_init(&model, &(cdem_body_options){.density = density}, &body, &fault));
  const double mass[7] = {250, 250 + 1000.0 / 3, 2000.0 / 3, 0, 250, 250 + 2000.0 / 3, 1000.0 / 3};
  for (int i = 0; i < 14; i++)
    check_near(body.mass[i], mass[i / 2], 1e-14, 0.0);
  double u[14], f[14], g[14], stress[42];
  for (int i = 0; i < 14; i++)
    u[i] = 0.03 * sin(i), f[i] = NAN;
  cdem_body_forces(&body, u, f);
  cdem_body_forces_reference(&body, u, g);
  check_below(difference(f, g, 14), 1e-14 * largest(g, 14));
  assert_true(f[6] == 0.0 && f[7] == 0.0);
  cdem_body_node_stress(&body, u, stress);
  for (int e = 0; e < 6; e++)
    assert_true(stress[6 * 3 + e] == 0.0);
  cdem_body_release(&body);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

/* Angular momentum about the origin. */
static void spin_of(const specimen *s, const double *u, const double *v, double spin[3]) {
  spin[0] = spin[1] = spin[2] = 0.0;
  for (int32_t n = 0; n < s->body.nodes; n++) {
    double x[3], p[3], part[3];
    for (int c = 0; c < 3; c++) {
      x[c] = s->mesh.xyz[3 * (int64_t)n + c] + u[3 * n + c];
      p[c] = s->body.mass[3 * n + c] * v[3 * n + c];
    }
    cdem_cross3(x, p, part);
    for (int c = 0; c < 3; c++)
      spin[c] += part[c];
  }
}

/* A block spun at a rim speed of 100 m/s for many steps: momentum to rounding, no drift of the
 * energy. Without the terms of dR/dx both would run away at second order in the strain. */
static void spun_block_keeps_momentum_and_energy(void **state) {
  (void)state;
  specimen s;
  specimen_make(cdem_element_find("hex8"), &(recipe){.count = 2, .distortion = 0.2}, &s);
  double *u = new_vector(s.size), *v = new_vector(s.size), *f = new_vector(s.size);
  const double omega[3] = {40.0, -60.0, 80.0};
  double step = 0.5 * 2.0 / cdem_body_frequency(&s.body, NULL), start[3], spin[3];
  double low = INFINITY, high = 0.0;
  for (int32_t n = 0; n < s.body.nodes; n++)
    cdem_cross3(omega, s.mesh.xyz + 3 * (int64_t)n, v + 3 * (int64_t)n);
  spin_of(&s, u, v, start);
  for (int i = 0; i < 4000; i++) {
    double kinetic = 0.0;
    cdem_body_forces(&s.body, u, f);
    for (int64_t k = 0; k < s.size; k++) {
      double next = v[k] + (i == 0 ? 0.5 : 1.0) * step * f[k] / s.body.mass[k];
      kinetic += 0.5 * s.body.mass[k] * v[k] * next;
      v[k] = next;
    }
    double energy = kinetic + cdem_body_energy(&s.body, u, NULL);
    low = fmin(low, energy);
    high = fmax(high, energy);
    for (int64_t k = 0; k < s.size; k++)
      u[k] += step * v[k];
  }
  spin_of(&s, u, v, spin);
  for (int c = 0; c < 3; c++)
    check_near(spin[c], start[c], 0.0, 1e-11 * cdem_norm3(start));
  check_below(high - low, 1e-4 * high);
  free(u), free(v), free(f);
  specimen_release(&s);
}

static void bad_input_is_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_body body;
  memset(&body, 0xff, sizeof body);
  cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_QUAD8, .count = {1, 1, 0}, .size = {1, 1, 0}};
  check_ok(cdem_mesh_grid(&grid, &mesh, &fault));
  cdem_material material = cdem_material_isotropic(1e9, 0.2);
  cdem_model_options options = {
      .mesh = &mesh, .materials = 1, .material = &material, .section = {CDEM_PLANE_STRAIN, 1.0}};
  check_ok(cdem_model_init(&options, &model, &fault));
  double density = 1000.0, inertia = 0.0;
  cdem_body_options how = {.density = &density, .micro_inertia = &inertia};
  check_fails(cdem_body_init(&model, &how, &body, &fault), CDEM_INPUT,
              "(quad8) is of second order: a body that moves takes first-order elements only; mesh "
              "the volume with order 1");
  assert_null(body.store);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
  grid.shape = CDEM_SHAPE_QUAD4;
  check_ok(cdem_mesh_grid(&grid, &mesh, &fault));
  material = rock(cdem_element_find("quad4-cosserat"));
  snprintf(material.name, sizeof material.name, "sand");
  check_ok(cdem_model_init(&options, &model, &fault));
  check_fails(cdem_body_init(&model, &how, &body, &fault), CDEM_INPUT,
              "micro-inertia of material 'sand' = 0 m^2");
  density = NAN;
  check_fails(cdem_body_init(&model, &how, &body, &fault), CDEM_INPUT,
              "density of material 'sand' = nan kg/m^3");
  density = -1.0;
  check_fails(cdem_body_init(&model, &how, &body, &fault), CDEM_INPUT, "must be positive");
  cdem_body_release(&body); /* empty after a failure */
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

static void every_allocation_may_fail(void **state) {
  (void)state;
  specimen s;
  specimen_make(cdem_element_find("quad4"), &(recipe){.count = 30}, &s);
  cdem_body body = {0};
  cdem_body_options options = {.density = &s.density, .threads = 1};
  cdem_status status = CDEM_MEMORY;
  int n = 0;
  for (; status != CDEM_OK; n++) {
    cdem_fault fault = {0};
    cdem_memory_fail_after(n);
    status = cdem_body_init(&s.model, &options, &body, &fault);
    cdem_memory_fail_after(-1);
    if (status != CDEM_OK) {
      assert_int_equal(status, CDEM_MEMORY);
      assert_null(body.store);
      assert_null(body.mass);
    }
    assert_true(n < 300);
  }
  assert_true(n > 25);
  cdem_body_release(&body);
  specimen_release(&s);
}

/* Bytes counted are at least the records and at most what a hexahedron is known to take. */
static void memory_is_told(void **state) {
  (void)state;
  specimen s;
  specimen_make(cdem_element_find("hex8"), &(recipe){.count = 16, .separate = true}, &s);
  int64_t cells = s.model.cells, record = (9 + 21 + 252) * 8;
  assert_true(cdem_body_traffic(&s.body) >= cells * record);
  assert_true(cdem_body_memory(&s.body) >= cells * record);
  assert_true(cdem_body_memory(&s.body) < cells * (record + 600));
  specimen_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(any_rotation_is_found),
      cmocka_unit_test(exact_half_turns),
      cmocka_unit_test(inverted_elements_are_found),
      cmocka_unit_test(far_from_the_origin),
      cmocka_unit_test(mixed_mesh),
      cmocka_unit_test(spun_block_keeps_momentum_and_energy),
      cmocka_unit_test(bad_input_is_refused),
      cmocka_unit_test(every_allocation_may_fail),
      cmocka_unit_test(memory_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
