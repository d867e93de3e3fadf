/* Room bsm: where points lie in a mesh, and the rows of N there. */
#include "bsm/bsm_support.h"

static cdem_fault fault;

enum { POINTS = 400 };

typedef struct {
  cdem_mesh mesh;
  int32_t cells, *cell;
  int32_t home[POINTS], found[POINTS];
  double xyz[POINTS][3], xi[POINTS][3];
} scene;

/* Random points inside random cells, `offset` away from the origin; located. */
static void scene_make(cdem_shape shape, double margin, double offset, uint64_t seed, scene *s) {
  cdem_random random = {seed};
  s->mesh = mesh_of(shape, 4, 0.2, seed);
  for (int64_t k = 0; k < 3 * (int64_t)s->mesh.nodes; k++)
    s->mesh.xyz[k] += k % 3 < cdem_mesh_dimension(&s->mesh) ? offset : 0.0;
  s->cell = cells_of_mesh(&s->mesh, &s->cells);
  for (int a = 0; a < POINTS; a++) {
    double xi[3];
    s->home[a] = s->cell[cdem_random_next(&random) % (uint64_t)s->cells];
    random_xi(shape, &random, margin, xi);
    map_to_space(&s->mesh, s->home[a], xi, s->xyz[a]);
  }
  check_ok(cdem_locate(&s->mesh, s->cells, s->cell, POINTS, s->xyz[0], s->found, s->xi[0], &fault));
}

static void scene_release(scene *s) {
  cdem_mesh_release(&s->mesh);
  free(s->cell);
}

/* Every point inside is found where it was put, and x(xi) is the point again. */
static void points_inside(void **state) {
  (void)state;
  for (int k = 0; k < FIRST_ORDER_SHAPES; k++)
    for (int far = 0; far < 2; far++) {
      scene s;
      double offset = far ? 1e4 : 0.0;
      scene_make(first_order_shapes[k], 1e-3, offset, 11 + (uint64_t)k, &s);
      for (int a = 0; a < POINTS; a++) {
        double x[3];
        assert_int_equal(s.found[a], s.home[a]);
        map_to_space(&s.mesh, s.found[a], s.xi[a], x);
        for (int c = 0; c < 3; c++)
          check_near(x[c], s.xyz[a][c], 1e-15, far ? 4e-12 : 1e-12);
      }
      scene_release(&s);
    }
}

/* Corners and middles of edges: in the first of the cells that have them, with a place to
 * rounding. The apex of a pyramid is one of them. */
static void points_on_edges(void **state) {
  (void)state;
  for (int k = 0; k < FIRST_ORDER_SHAPES; k++) {
    cdem_mesh mesh = mesh_of(first_order_shapes[k], 2, 0.2, 5);
    int32_t cells, *cell = cells_of_mesh(&mesh, &cells), found;
    const cdem_shape_info *shape = cdem_shape_get(first_order_shapes[k]);
    for (int32_t i = 0; i < cells; i++)
      for (int e = 0; e < shape->corners + shape->edges; e++) {
        const int32_t *node = cdem_mesh_cell(&mesh, cell[i]);
        int from = e < shape->corners ? e : shape->edge[e - shape->corners][0];
        int to = e < shape->corners ? e : shape->edge[e - shape->corners][1];
        int32_t first = -1;
        double x[3], xi[3], back[3];
        for (int c = 0; c < 3; c++)
          x[c] = 0.5 * (mesh.xyz[3 * node[from] + c] + mesh.xyz[3 * node[to] + c]);
        for (int32_t j = 0; j < cells && first < 0; j++) {
          bool has[2] = {false, false};
          for (int n = 0; n < shape->nodes; n++) {
            has[0] |= cdem_mesh_cell(&mesh, cell[j])[n] == node[from];
            has[1] |= cdem_mesh_cell(&mesh, cell[j])[n] == node[to];
          }
          if (has[0] && has[1])
            first = cell[j];
        }
        check_ok(cdem_locate(&mesh, cells, cell, 1, x, &found, xi, &fault));
        assert_int_equal(found, first);
        map_to_space(&mesh, found, xi, back);
        for (int c = 0; c < 3; c++)
          check_near(back[c], x[c], 0.0, 1e-12);
      }
    free(cell);
    cdem_mesh_release(&mesh);
  }
}

/* Random points of a larger box: in no cell outside, in exactly one inside (the box is convex), and
 * in no other than those asked for. */
static void points_outside(void **state) {
  (void)state;
  for (int k = 0; k < FIRST_ORDER_SHAPES; k++) {
    cdem_mesh mesh = mesh_of(first_order_shapes[k], 3, 0.25, 9);
    int32_t cells, *cell = cells_of_mesh(&mesh, &cells), found[POINTS], one[POINTS];
    int dim = cdem_mesh_dimension(&mesh);
    double x[POINTS][3] = {{0}}, xi[POINTS][3];
    const double size[3] = {1.3, 1.0, 0.9};
    int32_t holders[POINTS] = {0};
    cdem_random random = {77};
    for (int a = 0; a < POINTS; a++)
      for (int c = 0; c < dim; c++)
        x[a][c] = cdem_random_uniform(&random, -0.3, size[c] + 0.3);
    x[0][0] = NAN; /* in no cell */
    check_ok(cdem_locate(&mesh, cells, cell, POINTS, x[0], found, xi[0], &fault));
    for (int32_t i = 0; i < cells; i++) {
      check_ok(cdem_locate(&mesh, 1, &cell[i], POINTS, x[0], one, xi[0], &fault));
      for (int a = 0; a < POINTS; a++) {
        assert_true(one[a] == -1 || one[a] == cell[i]);
        holders[a] += one[a] == cell[i];
        assert_true(one[a] == -1 || found[a] == cell[i]);
        assert_true(one[a] != -1 || (xi[a][0] == 0.0 && xi[a][1] == 0.0 && xi[a][2] == 0.0));
      }
    }
    for (int a = 0; a < POINTS; a++) {
      bool inside = true;
      for (int c = 0; c < dim; c++)
        inside = inside && x[a][c] >= 0.0 && x[a][c] <= size[c];
      assert_int_equal(holders[a], inside);
      assert_int_equal(found[a] >= 0, inside);
    }
    check_ok(cdem_locate(&mesh, 0, NULL, POINTS, x[0], found, xi[0], &fault));
    assert_int_equal(found[POINTS - 1], -1);
    free(cell);
    cdem_mesh_release(&mesh);
  }
}

/* sum N = 1, sum grad N = 0; a linear field and its gradient come back. */
static void rows_reproduce_linear_fields(void **state) {
  (void)state;
  const double g[3] = {0.7, -1.9, 0.4};
  for (int k = 0; k < FIRST_ORDER_SHAPES; k++) {
    scene s;
    cdem_weights w;
    scene_make(first_order_shapes[k], 0.0, 0.0, 31, &s);
    int dim = cdem_mesh_dimension(&s.mesh);
    check_ok(cdem_weights_init(&s.mesh, POINTS, s.found, s.xi[0], &w, &fault));
    for (int a = 0; a < POINTS; a++) {
      double one = 0.0, value = 0.0, zero[3] = {0}, slope[3] = {0}, wanted = 0.3;
      for (int64_t i = w.start[a]; i < w.start[a + 1]; i++) {
        double f = 0.3 + cdem_dot3(g, s.mesh.xyz + 3 * (int64_t)w.node[i]);
        one += w.n[i];
        value += w.n[i] * f;
        for (int c = 0; c < 3; c++) {
          zero[c] += w.dn[3 * i + c];
          slope[c] += w.dn[3 * i + c] * f;
        }
      }
      wanted += cdem_dot3(g, s.xyz[a]);
      check_near(one, 1.0, 1e-14, 0.0);
      check_near(value, wanted, 0.0, 1e-13);
      for (int c = 0; c < 3; c++) {
        check_near(zero[c], 0.0, 0.0, 1e-12);
        check_near(slope[c], c < dim ? g[c] : 0.0, 0.0, 1e-11);
      }
    }
    cdem_weights_release(&w);
    scene_release(&s);
  }
}

/* f . N d = d . N^T f, and N^T adds. */
static void gather_is_the_transpose(void **state) {
  (void)state;
  for (int k = 0; k < FIRST_ORDER_SHAPES; k++)
    for (int width = 1; width <= 6; width += 5) {
      scene s;
      cdem_weights w;
      cdem_random random = {91};
      scene_make(first_order_shapes[k], 0.0, 0.0, 17, &s);
      check_ok(cdem_weights_init(&s.mesh, POINTS, s.found, s.xi[0], &w, &fault));
      int64_t n = (int64_t)s.mesh.nodes * width, m = (int64_t)POINTS * width;
      double *d = cdem_allocate(2 * n + 2 * m, sizeof *d, &fault), *back = d + n, *f = back + n,
             *u = f + m, left = 0.0, right = 0.0, scale = 0.0;
      for (int64_t i = 0; i < n; i++) {
        d[i] = cdem_random_uniform(&random, -1.0, 1.0);
        back[i] = 1.0;
      }
      for (int64_t i = 0; i < m; i++)
        f[i] = cdem_random_uniform(&random, -1.0, 1.0);
      cdem_weights_interpolate(&w, width, d, u);
      cdem_weights_gather(&w, width, f, back);
      for (int64_t i = 0; i < m; i++) {
        left += f[i] * u[i];
        scale += fabs(f[i] * u[i]);
      }
      for (int64_t i = 0; i < n; i++)
        right += d[i] * (back[i] - 1.0);
      check_near(left, right, 0.0, 1e-13 * scale);
      free(d);
      cdem_weights_release(&w);
      scene_release(&s);
    }
}

/* A row of very many cells takes no longer a point than a few: bins follow the cells. */
static void long_rows(void **state) {
  (void)state;
  cdem_mesh mesh;
  cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_QUAD4, .count = {20000, 1, 0}, .size = {20000.0, 1.0}};
  check_ok(cdem_mesh_grid(&grid, &mesh, &fault));
  int32_t cells, *cell = cells_of_mesh(&mesh, &cells);
  double *x = cdem_allocate(6 * (int64_t)cells, sizeof *x, &fault), *xi = x + 3 * (int64_t)cells;
  int32_t *found = cdem_allocate(cells, sizeof *found, &fault);
  for (int32_t i = 0; i < cells; i++) {
    x[3 * i] = i + 0.25;
    x[3 * i + 1] = 0.5;
  }
  check_ok(cdem_locate(&mesh, cells, cell, cells, x, found, xi, &fault));
  for (int32_t i = 0; i < cells; i++) {
    assert_int_equal(found[i], cell[i]);
    check_near(xi[3 * i], -0.5, 0.0, 1e-12);
  }
  free(x);
  free(found);
  free(cell);
  cdem_mesh_release(&mesh);
}

static void second_order_is_refused(void **state) {
  (void)state;
  const cdem_shape shape[4] = {CDEM_SHAPE_TRI6, CDEM_SHAPE_QUAD8, CDEM_SHAPE_TET10,
                               CDEM_SHAPE_HEX20};
  for (int k = 0; k < 4; k++) {
    cdem_mesh mesh = mesh_of(shape[k], 2, 0.0, 1);
    int32_t cells, *cell = cells_of_mesh(&mesh, &cells), found = 42;
    double x[3] = {0.1, 0.1, 0.1}, xi[3] = {7.0, 7.0, 7.0};
    char text[96];
    snprintf(text, sizeof text, "element %lld is a %s; grains lie in elements of first order",
             (long long)mesh.cell_tag[cell[0]], cdem_shape_get(shape[k])->name);
    check_fails(cdem_locate(&mesh, cells, cell, 1, x, &found, xi, &fault), CDEM_INPUT, text);
    assert_int_equal(found, 42);
    assert_true(xi[0] == 7.0);
    free(cell);
    cdem_mesh_release(&mesh);
  }
}

/* Whatever allocation fails, nothing is half made. */
static void out_of_memory(void **state) {
  (void)state;
  scene s;
  scene_make(CDEM_SHAPE_QUAD4, 0.0, 0.0, 3, &s);
  cdem_status status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    cdem_weights w = {0};
    int32_t found = 42;
    double xi[3];
    cdem_memory_fail_after(n);
    status = cdem_locate(&s.mesh, s.cells, s.cell, 1, s.xyz[0], &found, xi, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK ? found >= 0 : status == CDEM_MEMORY && found == 42);
    cdem_memory_fail_after(n);
    cdem_status built = cdem_weights_init(&s.mesh, POINTS, s.found, s.xi[0], &w, &fault);
    cdem_memory_fail_after(-1);
    assert_true(built == CDEM_OK || (built == CDEM_MEMORY && w.start == NULL && w.n == NULL));
    if (built != CDEM_OK)
      status = built;
    cdem_weights_release(&w);
    cdem_weights_release(&w);
    memset(&fault, 0, sizeof fault);
    assert_true(n < 100);
  }
  scene_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_inside),           cmocka_unit_test(points_on_edges),
      cmocka_unit_test(points_outside),          cmocka_unit_test(rows_reproduce_linear_fields),
      cmocka_unit_test(gather_is_the_transpose), cmocka_unit_test(long_rows),
      cmocka_unit_test(second_order_is_refused), cmocka_unit_test(out_of_memory),
  };
  return cmocka_run_group_tests_name("bsm weights", tests, NULL, NULL);
}
