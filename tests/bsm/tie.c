/* Room bsm: grains that move with a body, and their forces on it. */
#include "bsm/bsm_support.h"

#include <lapacke.h>

static cdem_fault fault;

enum { GRAINS = 60 };

typedef struct {
  cdem_shape shape;
  int dofs;
} kind;

static const kind kinds[] = {{CDEM_SHAPE_QUAD4, 2},  {CDEM_SHAPE_QUAD4, 3}, {CDEM_SHAPE_TRI3, 2},
                             {CDEM_SHAPE_TRI3, 3},   {CDEM_SHAPE_HEX8, 3},  {CDEM_SHAPE_TET4, 3},
                             {CDEM_SHAPE_WEDGE6, 3}, {CDEM_SHAPE_PYR5, 3}};
enum { KINDS = sizeof kinds / sizeof *kinds };

typedef struct {
  cdem_mesh mesh;
  int32_t cells, *cell;
  int32_t home[GRAINS], id[GRAINS];
  double xi[GRAINS][3], xyz[GRAINS][3];
  cdem_tie tie;
  int dim, dofs;
  int64_t size;
} scene;

/* Random grains in the cells of one half of the mesh. */
static void scene_make(kind k, uint64_t seed, scene *s) {
  cdem_random random = {seed};
  s->mesh = mesh_of(k.shape, 2, 0.2, seed);
  s->cell = cells_of_mesh(&s->mesh, &s->cells);
  s->dim = cdem_mesh_dimension(&s->mesh);
  s->dofs = k.dofs;
  s->size = (int64_t)s->mesh.nodes * k.dofs;
  for (int a = 0; a < GRAINS; a++) {
    s->id[a] = 3 * a + 1;
    s->home[a] = s->cell[cdem_random_next(&random) % (uint64_t)(s->cells / 2)];
    random_xi(k.shape, &random, 0.01, s->xi[a]);
    map_to_space(&s->mesh, s->home[a], s->xi[a], s->xyz[a]);
  }
  check_ok(cdem_tie_init(&s->mesh, k.dofs, GRAINS, s->id, s->home, s->xi[0], &s->tie, &fault));
}

static void scene_release(scene *s) {
  cdem_tie_release(&s->tie);
  cdem_mesh_release(&s->mesh);
  free(s->cell);
}

static double *random_numbers(int64_t count, double low, double high, uint64_t seed) {
  cdem_random random = {seed};
  double *v = cdem_allocate(count, sizeof *v, NULL);
  assert_non_null(v);
  for (int64_t i = 0; i < count; i++)
    v[i] = cdem_random_uniform(&random, low, high);
  return v;
}

static bool cosserat(const scene *s) {
  return s->dim == 2 && s->dofs == 3;
}

static void nodes_and_ids(void **state) {
  (void)state;
  for (int k = 0; k < KINDS; k++) {
    scene s;
    scene_make(kinds[k], 5, &s);
    assert_int_equal(s.tie.grains, GRAINS);
    assert_memory_equal(s.tie.grain, s.id, sizeof s.id);
    assert_true(s.tie.nodes > 0 && s.tie.nodes < s.mesh.nodes);
    int32_t at = 0;
    for (int32_t n = 0; n < s.mesh.nodes; n++) {
      bool met = false;
      for (int a = 0; a < GRAINS; a++)
        for (int64_t i = s.mesh.cell_start[s.home[a]]; i < s.mesh.cell_start[s.home[a] + 1]; i++)
          met |= s.mesh.cell_node[i] == n;
      if (met)
        assert_int_equal(s.tie.node[at++], n);
    }
    assert_int_equal(at, s.tie.nodes);
    scene_release(&s);
  }
}

/* Nodes that move by v + w x X (Cosserat nodes turn by w too): grains do the same. */
static void rigid_motions(void **state) {
  (void)state;
  for (int k = 0; k < KINDS; k++) {
    scene s;
    double motion[GRAINS][6];
    scene_make(kinds[k], 7, &s);
    bool solid = s.dim == 3;
    const double v[3] = {0.3, -1.2, solid ? 0.7 : 0.0};
    const double w[3] = {solid ? 2.0 : 0.0, solid ? -0.4 : 0.0, 1.5};
    double *of = cdem_allocate(s.size, sizeof *of, &fault), turn[3];
    for (int32_t n = 0; n < s.mesh.nodes; n++) {
      cdem_cross3(w, s.mesh.xyz + 3 * (int64_t)n, turn);
      for (int c = 0; c < s.dim; c++)
        of[n * s.dofs + c] = v[c] + turn[c];
      if (cosserat(&s))
        of[n * s.dofs + 2] = w[2];
    }
    cdem_tie_motion(&s.tie, of, motion[0]);
    for (int a = 0; a < GRAINS; a++) {
      cdem_cross3(w, s.xyz[a], turn);
      for (int c = 0; c < 3; c++) {
        check_near(motion[a][c], v[c] + turn[c], 0.0, 1e-13);
        check_near(motion[a][3 + c], w[c], 0.0, 1e-12);
      }
    }
    free(of);
    scene_release(&s);
  }
}

/* F . B v = v . B^T F, and forces are added to what is there. */
static void virtual_work(void **state) {
  (void)state;
  for (int k = 0; k < KINDS; k++) {
    scene s;
    double motion[GRAINS][6], left = 0.0, right = 0.0, scale = 0.0;
    scene_make(kinds[k], 9, &s);
    double *v = random_numbers(s.size, -1.0, 1.0, 1);
    double *on = random_numbers(6 * GRAINS, -1.0, 1.0, 2);
    double *force = random_numbers(s.size, 1.0, 1.0, 3);
    cdem_tie_motion(&s.tie, v, motion[0]);
    cdem_tie_forces(&s.tie, on, force);
    for (int i = 0; i < 6 * GRAINS; i++) {
      left += on[i] * motion[i / 6][i % 6];
      scale += fabs(on[i] * motion[i / 6][i % 6]);
    }
    for (int64_t i = 0; i < s.size; i++)
      right += v[i] * (force[i] - 1.0);
    check_near(left, right, 0.0, 1e-13 * scale);
    free(v);
    free(on);
    free(force);
    scene_release(&s);
  }
}

/* The body receives the force and the moment about the origin that the grains have. */
static void resultants(void **state) {
  (void)state;
  for (int k = 0; k < KINDS; k++) {
    scene s;
    double total[6] = {0}, received[6] = {0}, turn[3];
    scene_make(kinds[k], 13, &s);
    double *on = random_numbers(6 * GRAINS, -1.0, 1.0, 2);
    double *force = random_numbers(s.size, 0.0, 0.0, 3);
    for (int i = 0; i < 6 * GRAINS && s.dim == 2; i++)
      if (i % 6 >= 2 && i % 6 <= 4)
        on[i] = 0.0; /* in its plane */
    cdem_tie_forces(&s.tie, on, force);
    for (int a = 0; a < GRAINS; a++) {
      cdem_cross3(s.xyz[a], on + 6 * a, turn);
      for (int c = 0; c < 3; c++) {
        total[c] += on[6 * a + c];
        total[3 + c] += turn[c] + on[6 * a + 3 + c];
      }
    }
    for (int32_t n = 0; n < s.mesh.nodes; n++) {
      const double *f = force + (int64_t)n * s.dofs;
      const double full[3] = {f[0], f[1], s.dim == 3 ? f[2] : 0.0};
      cdem_cross3(s.mesh.xyz + 3 * (int64_t)n, full, turn);
      for (int c = 0; c < 3; c++) {
        received[c] += full[c];
        received[3 + c] += turn[c];
      }
      received[5] += cosserat(&s) ? f[2] : 0.0;
    }
    for (int c = 0; c < 6; c++)
      check_near(received[c], total[c], 0.0, 1e-11);
    free(on);
    free(force);
    scene_release(&s);
  }
}

/* Largest eigenvalue of B^T K B against M, K of one grain with rows of v and w coupled by `mixed`
 * times the root of their product: -1 .. 1. */
static double largest_frequency2(const scene *s, const double *stiffness, const double *turning,
                                 double mixed, const double *mass) {
  int n = (int)s->size;
  double *b = cdem_allocate(6 * (int64_t)GRAINS * n, sizeof *b, &fault);
  double *a = cdem_allocate((int64_t)n * n + 2 * n, sizeof *a, &fault), *unit = a + n * n,
         *value = unit + n, motion[GRAINS][6];
  for (int j = 0; j < n; j++) {
    memset(unit, 0, (size_t)n * sizeof *unit);
    unit[j] = 1.0 / sqrt(mass[j]);
    cdem_tie_motion(&s->tie, unit, motion[0]);
    memcpy(b + 6 * (size_t)GRAINS * (size_t)j, motion, sizeof motion);
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int g = 0; g < GRAINS && j <= i; g++) {
        const double *x = b + 6 * (GRAINS * i + g), *y = b + 6 * (GRAINS * j + g);
        double cross = mixed * sqrt(stiffness[g] * turning[g]);
        for (int c = 0; c < 3; c++) /* x pairs with the turn about z, y about x, z about y */
          a[i * n + j] += stiffness[g] * x[c] * y[c] + turning[g] * x[3 + c] * y[3 + c] +
                          cross * (x[c] * y[3 + (c + 2) % 3] + x[3 + (c + 2) % 3] * y[c]);
      }
  assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'L', n, a, n, value), 0);
  double largest = value[n - 1];
  free(a);
  free(b);
  return largest;
}

/* The bound holds for springs of any size on v and w, coupled ones too (a shear spring at the
 * surface of a grain resists both at once), and is not far off. */
static void frequency_bound(void **state) {
  (void)state;
  double worst = 0.0;
  for (int k = 0; k < KINDS; k++)
    for (int what = 0; what < 3; what++) {
      scene s;
      scene_make(kinds[k], 21 + (uint64_t)what, &s);
      double *stiffness = random_numbers(GRAINS, 0.0, what == 1 ? 0.0 : 2.0, 4);
      double *turning = random_numbers(GRAINS, 0.0, what == 0 ? 0.0 : 0.2, 5);
      double *mass = random_numbers(s.size, 0.5, 1.5, 6);
      for (int64_t i = 0; i < s.size; i++) /* one mass a node; Cosserat: one inertia */
        mass[i] = cosserat(&s) && i % 3 == 2 ? 0.1 * mass[i] : mass[i - i % s.dofs];
      for (double mixed = what == 2 ? -1.0 : 1.0; mixed <= 1.0; mixed += 2.0) {
        double bound;
        check_ok(cdem_tie_frequency2(&s.tie, stiffness, turning, mass, &bound, &fault));
        double truth = largest_frequency2(&s, stiffness, turning, mixed, mass);
        check_below(truth, bound * (1.0 + 1e-12));
        worst = fmax(worst, bound / truth);
      }
      free(stiffness);
      free(turning);
      free(mass);
      scene_release(&s);
    }
  check_below(worst, 12.0);
}

/* One grain at a corner, where its place and its spin move the same node: the two springs together
 * are stiffer than the sum of their frequencies says. */
static void frequency_of_one_grain(void **state) {
  (void)state;
  double least = INFINITY;
  for (int k = 0; k < 5; k++)
    for (int corner = 0; corner < cdem_shape_get(kinds[k].shape)->corners; corner++) {
      scene s;
      double stiffness[GRAINS] = {1.0}, turning[GRAINS] = {0.05};
      scene_make(kinds[k], 2, &s);
      for (int a = 0; a < GRAINS; a++)
        memcpy(s.xi[a], element_at(&s.mesh, s.home[a])->reference[corner], sizeof s.xi[a]);
      cdem_tie_release(&s.tie);
      check_ok(cdem_tie_init(&s.mesh, s.dofs, GRAINS, s.id, s.home, s.xi[0], &s.tie, &fault));
      double *mass = random_numbers(s.size, 1.0, 1.0, 6);
      double bound;
      check_ok(cdem_tie_frequency2(&s.tie, stiffness, turning, mass, &bound, &fault));
      for (double mixed = -1.0; mixed <= 1.0; mixed += 2.0) {
        double truth = largest_frequency2(&s, stiffness, turning, mixed, mass);
        check_below(truth, bound * (1.0 + 1e-12));
        least = fmin(least, bound / truth);
      }
      free(mass);
      scene_release(&s);
    }
  check_below(least, 1.3);
}

static void out_of_memory(void **state) {
  (void)state;
  scene s;
  scene_make(kinds[0], 3, &s);
  cdem_status status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    cdem_tie tie = {0};
    cdem_memory_fail_after(n);
    status = cdem_tie_init(&s.mesh, 2, GRAINS, s.id, s.home, s.xi[0], &tie, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || (status == CDEM_MEMORY && tie.grain == NULL));
    cdem_tie_release(&tie);
    cdem_tie_release(&tie);
    memset(&fault, 0, sizeof fault);
    assert_true(n < 100);
  }
  const double one[3 * GRAINS] = {0};
  double bound = -1.0;
  cdem_memory_fail_after(0);
  assert_int_equal(cdem_tie_frequency2(&s.tie, one, one, one, &bound, NULL), CDEM_MEMORY);
  assert_true(bound == -1.0);
  cdem_memory_fail_after(-1);
  scene_release(&s);
}

static void no_grains(void **state) {
  (void)state;
  cdem_mesh mesh = mesh_of(CDEM_SHAPE_QUAD4, 2, 0.0, 1);
  cdem_tie tie = {0};
  check_ok(cdem_tie_init(&mesh, 2, 0, NULL, NULL, NULL, &tie, &fault));
  assert_int_equal(tie.nodes, 0);
  double bound = -1.0;
  check_ok(cdem_tie_frequency2(&tie, NULL, NULL, NULL, &bound, &fault));
  assert_true(bound == 0.0);
  cdem_tie_release(&tie);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nodes_and_ids),   cmocka_unit_test(rigid_motions),
      cmocka_unit_test(virtual_work),    cmocka_unit_test(resultants),
      cmocka_unit_test(frequency_bound), cmocka_unit_test(frequency_of_one_grain),
      cmocka_unit_test(out_of_memory),   cmocka_unit_test(no_grains),
  };
  return cmocka_run_group_tests_name("bsm tie", tests, NULL, NULL);
}
