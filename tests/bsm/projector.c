/* Room bsm: the projector of the bridging scale. Its identities, against plain loops, and what it
 * refuses. */
#include "bsm/bsm_support.h"

#include <lapacke.h>

static cdem_fault fault;

/* Random grains of sizes 1:3 in a distorted mesh, some in every cell, and their projector. */
typedef struct {
  cdem_mesh mesh;
  int32_t cells, *cell;
  int64_t grains;
  int32_t *home;
  double *xi, *xyz, *mass, *inertia;
  cdem_projector_options options;
  cdem_projector projector;
} scene;

static void scene_grains(cdem_shape shape, int32_t bricks, int per_cell, uint64_t seed, scene *s) {
  cdem_random random = {seed};
  memset(s, 0, sizeof *s);
  s->mesh = mesh_of(shape, bricks, 0.2, seed);
  s->cell = cells_of_mesh(&s->mesh, &s->cells);
  s->grains = (int64_t)per_cell * s->cells;
  s->home = cdem_allocate(s->grains, sizeof *s->home, &fault);
  s->xi = cdem_allocate(8 * s->grains, sizeof *s->xi, &fault);
  s->xyz = s->xi + 3 * s->grains;
  s->mass = s->xyz + 3 * s->grains;
  s->inertia = s->mass + s->grains;
  for (int64_t a = 0; a < s->grains; a++) {
    double radius = cdem_random_uniform(&random, 0.01, 0.03);
    s->home[a] = s->cell[a % s->cells];
    random_xi(shape, &random, 0.0, s->xi + 3 * a);
    map_to_space(&s->mesh, s->home[a], s->xi + 3 * a, s->xyz + 3 * a);
    s->mass[a] = 2500.0 * cdem_grain_solid(cdem_mesh_dimension(&s->mesh), radius);
    s->inertia[a] = 0.5 * s->mass[a] * radius * radius;
  }
  s->options = (cdem_projector_options){.mesh = &s->mesh,
                                        .cells = s->cells,
                                        .fine_cell = s->cell,
                                        .grains = s->grains,
                                        .cell = s->home,
                                        .xi = s->xi,
                                        .mass = s->mass,
                                        .inertia = s->inertia};
}

static void scene_make(cdem_shape shape, int32_t bricks, int per_cell, uint64_t seed, scene *s) {
  scene_grains(shape, bricks, per_cell, seed, s);
  check_ok(cdem_projector_init(&s->options, &s->projector, &fault));
}

static void scene_release(scene *s) {
  cdem_projector_release(&s->projector);
  cdem_mesh_release(&s->mesh);
  free(s->cell);
  free(s->home);
  free(s->xi);
}

static double *fresh(int64_t count) {
  double *v = cdem_allocate(count, sizeof *v, NULL);
  assert_non_null(v);
  return v;
}

static double *random_field(int64_t count, uint64_t seed) {
  cdem_random random = {seed};
  double *v = fresh(count);
  for (int64_t i = 0; i < count; i++)
    v[i] = cdem_random_uniform(&random, -1.0, 1.0);
  return v;
}

static void check_same(const double *a, const double *b, int64_t count, double bound) {
  for (int64_t i = 0; i < count; i++)
    check_near(a[i], b[i], 0.0, bound);
}

/* P P q = P q and Q P q = 0; Q N d = 0; N^T Mp Q q = 0; energies add up. */
static void check_identities(const scene *s, cdem_projector_shape shape, double bound) {
  const cdem_projector *p = &s->projector;
  int width = shape.translations + shape.rotations;
  int64_t m = p->grains * width, n = (int64_t)p->nodes * width;
  double *q = random_field(m, 5), *d = random_field(n, 6);
  double *coarse = fresh(m), *fine = fresh(m), *again = fresh(m), *back = fresh(n);
  double *load = fresh(n), *scale = fresh(n);
  check_ok(cdem_projector_split(p, shape, q, coarse, fine, &fault));
  for (int64_t i = 0; i < m; i++)
    check_near(coarse[i] + fine[i], q[i], 1e-15, 1e-15);
  check_ok(cdem_projector_split(p, shape, coarse, again, NULL, &fault));
  check_same(again, coarse, m, bound);
  check_ok(cdem_projector_split(p, shape, coarse, NULL, again, &fault));
  check_near(cdem_projector_energy(p, shape, again), 0.0, 0.0,
             bound * cdem_projector_energy(p, shape, q));
  for (int64_t a = 0; a < p->grains; a++) /* Mp Q q */
    for (int c = 0; c < width; c++)
      again[a * width + c] =
          (c < shape.translations ? p->mass[a] : p->inertia[a]) * fine[a * width + c];
  cdem_weights_gather(&p->weights, width, again, load);
  for (int64_t i = 0; i < m; i++)
    again[i] = fabs(again[i]);
  cdem_weights_gather(&p->weights, width, again, scale);
  for (int64_t i = 0; i < n; i++)
    check_near(load[i], 0.0, 0.0, bound * scale[i]);
  double whole = cdem_projector_energy(p, shape, q);
  check_near(cdem_projector_energy(p, shape, coarse) + cdem_projector_energy(p, shape, fine), whole,
             bound, 0.0);
  assert_true(cdem_projector_energy(p, shape, coarse) > 1e-3 * whole);
  assert_true(cdem_projector_energy(p, shape, fine) > 1e-3 * whole);
  cdem_weights_interpolate(&p->weights, width, d, q);
  check_ok(cdem_projector_split(p, shape, q, coarse, fine, &fault));
  check_same(coarse, q, m, bound);
  for (int64_t i = 0; i < m; i++)
    check_near(fine[i], 0.0, 0.0, bound);
  check_ok(cdem_projector_project(p, shape, q, back, &fault));
  check_same(back, d, n, 1e2 * bound); /* nodes at few grains: by the condition of M */
  double *const all[] = {q, d, coarse, fine, again, back, load, scale};
  for (int k = 0; k < 8; k++)
    free(all[k]);
}

/* Fields linear in the place, whatever the sizes of the grains. */
static void check_linear(const scene *s, cdem_projector_shape shape, double bound) {
  const cdem_projector *p = &s->projector;
  int width = shape.translations + shape.rotations;
  double *q = fresh(p->grains * width), *d = fresh((int64_t)p->nodes * width);
  const double g[6][3] = {{1, 2, 3},    {-2, 1, 0.5}, {0.3, -1, 2},
                          {4, 0.1, -1}, {1, 1, 1},    {-3, 2, 0.7}};
  for (int64_t a = 0; a < p->grains; a++)
    for (int c = 0; c < width; c++)
      q[a * width + c] = 0.2 * c + cdem_dot3(g[c], s->xyz + 3 * a);
  check_ok(cdem_projector_project(p, shape, q, d, &fault));
  for (int32_t n = 0; n < p->nodes; n++)
    for (int c = 0; c < width; c++)
      check_near(d[n * width + c], 0.2 * c + cdem_dot3(g[c], s->mesh.xyz + 3 * (int64_t)p->node[n]),
                 0.0, bound);
  free(q);
  free(d);
}

static void identities(void **state) {
  (void)state;
  const cdem_shape shape[6] = {CDEM_SHAPE_QUAD4, CDEM_SHAPE_TRI3,   CDEM_SHAPE_HEX8,
                               CDEM_SHAPE_TET4,  CDEM_SHAPE_WEDGE6, CDEM_SHAPE_PYR5};
  const cdem_projector_shape width[4] = {{2, 1}, {2, 0}, {3, 3}, {3, 0}};
  for (int k = 0; k < 6; k++) {
    scene s;
    bool solid = is_solid(shape[k]);
    scene_make(shape[k], solid ? 2 : 4, solid ? 24 : 12, 40 + (uint64_t)k, &s);
    for (int w = 0; w < 4; w++) {
      check_identities(&s, width[w], 1e-12);
      check_linear(&s, width[w], 1e-12);
    }
    scene_release(&s);
  }
}

/* M and P by plain loops and LAPACK, one matrix for each weight. */
static void against_dense_matrices(void **state) {
  (void)state;
  scene s;
  scene_make(CDEM_SHAPE_QUAD4, 2, 9, 3, &s);
  const cdem_projector *p = &s.projector;
  const cdem_projector_shape shape = {2, 1};
  int n = p->nodes, g = (int)p->grains;
  assert_int_equal(n, s.mesh.nodes);
  double *q = random_field(3 * (int64_t)g, 8), *d = fresh(3 * (int64_t)n);
  double *big = fresh((int64_t)g * n), *m = fresh((int64_t)n * n), *right = fresh(n);
  for (int a = 0; a < g; a++) {
    double value[8];
    const int32_t *node = cdem_mesh_cell(&s.mesh, s.home[a]);
    element_at(&s.mesh, s.home[a])->shape_functions(s.xi + 3 * a, value, NULL);
    for (int i = 0; i < 4; i++)
      big[a * n + node[i]] = value[i];
  }
  check_ok(cdem_projector_project(p, shape, q, d, &fault));
  for (int c = 0; c < 3; c++) {
    const double *weight = c < 2 ? s.mass : s.inertia;
    double total = 0.0, most = 0.0;
    for (int i = 0; i < n; i++) {
      right[i] = 0.0;
      for (int a = 0; a < g; a++)
        right[i] += big[a * n + i] * weight[a] * q[3 * a + c];
      for (int j = 0; j < n; j++) {
        m[i * n + j] = 0.0;
        for (int a = 0; a < g; a++)
          m[i * n + j] += big[a * n + i] * weight[a] * big[a * n + j];
        total += m[i * n + j];
      }
    }
    assert_true(total > 0.0);
    assert_int_equal(LAPACKE_dposv(LAPACK_ROW_MAJOR, 'U', n, 1, m, n, right, 1), 0);
    for (int i = 0; i < n; i++)
      most = fmax(most, fabs(right[i]));
    for (int i = 0; i < n; i++)
      check_near(d[3 * i + c], right[i], 0.0, 1e-12 * most);
  }
  double *const all[] = {q, d, big, m, right};
  for (int k = 0; k < 5; k++)
    free(all[k]);
  scene_release(&s);
}

/* Nodes of a part of a mesh only; lumped masses add up to the grains'. */
static void part_of_a_mesh(void **state) {
  (void)state;
  scene s;
  scene_grains(CDEM_SHAPE_QUAD4, 4, 9, 12, &s);
  const int32_t chosen[2] = {s.cell[5], s.cell[6]};
  int64_t kept = 0;
  for (int64_t a = 0; a < s.grains; a++)
    if (s.home[a] == chosen[0] || s.home[a] == chosen[1]) {
      s.home[kept] = s.home[a];
      memcpy(s.xi + 3 * kept, s.xi + 3 * a, 3 * sizeof *s.xi);
      s.mass[kept] = s.mass[a];
      s.inertia[kept++] = s.inertia[a];
    }
  s.options.grains = kept;
  s.options.cells = 2;
  s.options.fine_cell = chosen;
  check_ok(cdem_projector_init(&s.options, &s.projector, &fault));
  assert_int_equal(s.projector.nodes, 6);
  for (int i = 1; i < 6; i++)
    assert_true(s.projector.node[i] > s.projector.node[i - 1]);
  double mass[6], inertia[6], sum[4] = {0};
  cdem_projector_lumped(&s.projector, mass, inertia);
  for (int i = 0; i < 6; i++) {
    assert_true(mass[i] > 0.0 && inertia[i] > 0.0);
    sum[0] += mass[i];
    sum[1] += inertia[i];
  }
  for (int64_t a = 0; a < kept; a++) {
    sum[2] += s.mass[a];
    sum[3] += s.inertia[a];
  }
  check_near(sum[0], sum[2], 1e-14, 0.0);
  check_near(sum[1], sum[3], 1e-14, 0.0);
  scene_release(&s);
}

/* Element `at` of the scene with its first grains only, or on a line. */
static void refuse(cdem_shape shape, int keep, bool line, const char *why) {
  scene s;
  char text[160];
  scene_grains(shape, 2, 20, 6, &s);
  int32_t bad = s.cell[1];
  int64_t kept = 0;
  int seen = 0;
  for (int64_t a = 0; a < s.grains; a++) {
    if (s.home[a] == bad && seen >= keep)
      continue;
    s.home[kept] = s.home[a];
    memcpy(s.xi + 3 * kept, s.xi + 3 * a, 3 * sizeof *s.xi);
    if (s.home[kept] == bad) {
      if (line)
        for (int c = 0; c < 3; c++)
          s.xi[3 * kept + c] = c < 2 ? 0.05 + 0.02 * seen : 0.0;
      seen++;
    }
    kept++;
  }
  s.options.grains = kept;
  snprintf(text, sizeof text, "element %lld at (", (long long)s.mesh.cell_tag[bad]);
  check_fails(cdem_projector_init(&s.options, &s.projector, &fault), CDEM_INPUT, text);
  check_fails(cdem_projector_init(&s.options, &s.projector, &fault), CDEM_INPUT, why);
  assert_null(s.projector.node);
  assert_null(s.projector.factors);
  scene_release(&s);
}

static void grains_that_do_not_determine_an_element(void **state) {
  (void)state;
  refuse(CDEM_SHAPE_QUAD4, 3, false, "holds 3 grains, which are too few for its 4 nodes");
  refuse(CDEM_SHAPE_QUAD4, 1, false, "holds 1 grain, which are too few for its 4 nodes");
  refuse(CDEM_SHAPE_QUAD4, 0, false, "holds 0 grains");
  refuse(CDEM_SHAPE_QUAD4, 20, true, "holds 20 grains, which do not determine its 4 nodes");
  refuse(CDEM_SHAPE_TRI3, 10, true, "holds 10 grains, which do not determine its 3 nodes");
  refuse(CDEM_SHAPE_HEX8, 7, false, "holds 7 grains, which are too few for its 8 nodes");
  refuse(CDEM_SHAPE_TET4, 12, true, "holds 12 grains, which do not determine its 4 nodes");
  cdem_projector projector = {0};
  cdem_projector_options none = {0};
  check_fails(cdem_projector_init(&none, &projector, &fault), CDEM_INPUT,
              "the fine region has no elements");
}

static void what_is_no_number(void **state) {
  (void)state;
  scene s;
  scene_make(CDEM_SHAPE_QUAD4, 2, 9, 3, &s);
  double *q = random_field(2 * s.grains, 1), *d = fresh(2 * (int64_t)s.projector.nodes);
  d[0] = 42.0;
  q[7] = NAN;
  check_fails(cdem_projector_project(&s.projector, (cdem_projector_shape){2, 0}, q, d, &fault),
              CDEM_NUMERIC, "not finite");
  assert_true(d[0] == 42.0);
  free(q);
  free(d);
  scene_release(&s);
  scene_grains(CDEM_SHAPE_QUAD4, 2, 9, 3, &s);
  for (int64_t a = 0; a < s.grains; a++)
    s.mass[a] = -1.0;
  check_fails(cdem_projector_init(&s.options, &s.projector, &fault), CDEM_NUMERIC,
              "not positive definite");
  assert_null(s.projector.factors);
  scene_release(&s);
}

static void out_of_memory(void **state) {
  (void)state;
  scene s;
  scene_grains(CDEM_SHAPE_QUAD4, 2, 9, 3, &s);
  cdem_status status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    cdem_memory_fail_after(n);
    status = cdem_projector_init(&s.options, &s.projector, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || status == CDEM_MEMORY);
    assert_true(status == CDEM_OK || (s.projector.node == NULL && s.projector.mass == NULL &&
                                      s.projector.weights.n == NULL));
    assert_true(n < 100);
  }
  const cdem_projector_shape shape = {2, 0};
  double *q = random_field(2 * s.grains, 1), *u = fresh(2 * s.grains);
  status = CDEM_MEMORY;
  u[0] = 42.0;
  for (int n = 0; status != CDEM_OK; n++) {
    assert_true(u[0] == 42.0);
    cdem_memory_fail_after(n);
    status = cdem_projector_split(&s.projector, shape, q, NULL, u, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || status == CDEM_MEMORY);
    assert_true(n < 100);
  }
  memset(&fault, 0, sizeof fault);
  free(q);
  free(u);
  scene_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(identities),
      cmocka_unit_test(against_dense_matrices),
      cmocka_unit_test(part_of_a_mesh),
      cmocka_unit_test(grains_that_do_not_determine_an_element),
      cmocka_unit_test(what_is_no_number),
      cmocka_unit_test(out_of_memory),
  };
  return cmocka_run_group_tests_name("bsm projector", tests, NULL, NULL);
}
