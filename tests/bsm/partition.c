/* Room bsm: which grains are calculated, which move with the coarse medium. */
#include "bsm/bsm_support.h"
#include "dem/packing.h"

static cdem_fault fault;

static cdem_grains lattice(const char *name, int dim, const double low[3], const double high[3],
                           bool centres, double radius) {
  cdem_grains grains;
  cdem_packing_options o = {
      .dim = dim, .centres_inside = centres, .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = radius}};
  memcpy(o.low, low, sizeof o.low);
  memcpy(o.high, high, sizeof o.high);
  check_ok(cdem_packing_make(cdem_packing_find(name), &o, &grains, &fault));
  return grains;
}

/* A box of bricks with its low corner there. */
static cdem_mesh box_mesh(cdem_shape shape, const int32_t count[3], const double low[3],
                          const double size[3], double distortion) {
  cdem_mesh mesh;
  cdem_mesh_grid_options o = {.shape = shape,
                              .count = {count[0], count[1], count[2]},
                              .size = {size[0], size[1], size[2]},
                              .distortion = distortion,
                              .seed = 2};
  check_ok(cdem_mesh_grid(&o, &mesh, &fault));
  for (int64_t k = 0; k < 3 * (int64_t)mesh.nodes; k++)
    mesh.xyz[k] += low[k % 3];
  return mesh;
}

static double distance_of(const cdem_grains *g, int64_t i, int64_t j) {
  double d[3];
  for (int c = 0; c < 3; c++)
    d[c] = g->xyz[3 * i + c] - g->xyz[3 * j + c];
  return cdem_norm3(d);
}

/* Interface grains by two plain loops; counts, cells and places of all. */
static void check_partition(const cdem_mesh *mesh, int32_t cells, const int32_t *cell,
                            const cdem_grains *g, double gap, const cdem_partition *p) {
  int64_t count[3] = {0};
  double largest = 0.0;
  for (int64_t i = 0; i < g->grains; i++)
    largest = fmax(largest, g->radius[i]);
  for (int64_t i = 0; i < g->grains; i++) {
    bool fine_cell = false, near = false;
    count[p->part[i]]++;
    for (int32_t k = 0; k < cells; k++)
      fine_cell |= p->cell[i] == cell[k];
    assert_int_equal(p->part[i] == CDEM_PART_FINE, fine_cell);
    assert_int_equal(p->part[i] == CDEM_PART_AWAY, p->cell[i] == -1);
    if (p->part[i] != CDEM_PART_AWAY) {
      double x[3];
      map_to_space(mesh, p->cell[i], p->xi + 3 * i, x);
      for (int c = 0; c < 3; c++)
        check_near(x[c], g->xyz[3 * i + c], 0.0, 1e-11);
    }
    for (int64_t j = 0; j < g->grains && !near && p->part[i] != CDEM_PART_FINE; j++)
      near = p->part[j] == CDEM_PART_FINE && fabs(g->xyz[3 * i] - g->xyz[3 * j]) < 4 * largest &&
             distance_of(g, i, j) <= g->radius[i] + g->radius[j] + gap * largest;
    if (p->part[i] != CDEM_PART_FINE)
      assert_int_equal(p->part[i] == CDEM_PART_INTERFACE, near);
  }
  assert_int_equal(count[CDEM_PART_FINE], p->fine);
  assert_int_equal(count[CDEM_PART_INTERFACE], p->interfaces);
}

/* Li & Wan's foundation, 21 x 10.5 m, fine under the plate: 2426 and 6765 grains, and of the
 * lattice around them the layer that touches them. */
static void foundation(void **state) {
  (void)state;
  const double low[3] = {-10.5, -10.5, 0.0}, size[3] = {21.0, 10.5, 0.0};
  const double high[3] = {10.5, 0.0, 0.0}, radius[2] = {0.05, 0.03};
  const int64_t expected[2] = {2426, 6765};
  const cdem_bsm_box box = {{-3.5, -3.5, 0.0}, {3.5, 0.0, 0.0}};
  cdem_mesh mesh = box_mesh(CDEM_SHAPE_QUAD4, (int32_t[3]){18, 9, 0}, low, size, 0.0);
  int32_t cells, *cell;
  check_ok(cdem_bsm_cells(&mesh, 1, &box, &cells, &cell, &fault));
  assert_int_equal(mesh.nodes, 190);
  assert_int_equal(cells, 18);
  for (int k = 0; k < 2; k++) {
    cdem_partition p;
    cdem_grains g = lattice("square", 2, low, high, true, radius[k]);
    check_ok(cdem_partition_init(&mesh, cells, cell, &g, 0.3, &p, &fault));
    assert_int_equal(p.fine, expected[k]);
    assert_int_equal(p.outer_cells, 162 - 18);
    int64_t touching = 0, fine = 0;
    double reach = 3.5 + 3.0 * radius[k], inner = 3.5 - 3.0 * radius[k];
    int64_t *rim = cdem_allocate(p.fine, sizeof *rim, &fault); /* fine grains near the edge */
    for (int64_t i = 0; i < g.grains; i++)
      if (p.part[i] == CDEM_PART_FINE && (fabs(g.xyz[3 * i]) > inner || g.xyz[3 * i + 1] < -inner))
        rim[fine++] = i;
    for (int64_t i = 0; i < g.grains; i++) {
      bool near = false;
      if (p.part[i] == CDEM_PART_FINE)
        continue;
      if (fabs(g.xyz[3 * i]) < reach && g.xyz[3 * i + 1] > -reach)
        for (int64_t j = 0; j < fine && !near; j++)
          near = distance_of(&g, i, rim[j]) < 2.001 * radius[k];
      assert_int_equal(p.part[i] == CDEM_PART_INTERFACE, near);
      touching += near;
    }
    free(rim);
    assert_int_equal(p.interfaces, touching);
    cdem_partition_release(&p);
    cdem_grains_release(&g);
  }
  free(cell);
  cdem_mesh_release(&mesh);
}

/* 4 x 4 elements of 4 x 4 grains; two boxes of elements of a part of that are fine. */
static void check_boxes(int boxes, const cdem_bsm_box *box, int32_t elements, int64_t fine,
                        int64_t interfaces) {
  const double zero[3] = {0}, one[3] = {1.0, 1.0, 0.0};
  cdem_mesh mesh = box_mesh(CDEM_SHAPE_QUAD4, (int32_t[3]){4, 4, 0}, zero, one, 0.0);
  cdem_grains g = lattice("cubic", 2, zero, one, false, 1.0 / 32.0);
  cdem_partition p;
  int32_t cells, *cell;
  assert_int_equal(g.grains, 256);
  check_ok(cdem_bsm_cells(&mesh, boxes, box, &cells, &cell, &fault));
  assert_int_equal(cells, elements);
  for (int32_t k = 1; k < cells; k++)
    assert_true(cell[k] > cell[k - 1]);
  check_ok(cdem_partition_init(&mesh, cells, cell, &g, 0.3, &p, &fault));
  assert_int_equal(p.fine, fine);
  assert_int_equal(p.interfaces, interfaces);
  assert_int_equal(p.outer_cells, 16 - elements);
  check_partition(&mesh, cells, cell, &g, 0.3, &p);
  cdem_partition_release(&p);
  cdem_partition_release(&p);
  free(cell);
  cdem_grains_release(&g);
  cdem_mesh_release(&mesh);
}

static void where_the_region_lies(void **state) {
  (void)state;
  const cdem_bsm_box inside = {{0.25, 0.25, 0}, {0.75, 0.75, 0}};
  const cdem_bsm_box edge = {{0.25, 0.5, 0}, {0.75, 1.0, 0}};
  const cdem_bsm_box corner = {{0.5, 0.5, 0}, {1.0, 1.0, 0}};
  const cdem_bsm_box all = {{0}, {0}}, band = {{0.25, 0, 0}, {0.75, 0, 0}};
  const cdem_bsm_box two[2] = {{{0, 0, 0}, {0.25, 0.25, 0}}, {{0.5, 0.75, 0}, {0.75, 1.0, 0}}};
  const cdem_bsm_box overlapping[2] = {{{0.5, 0.5, 0}, {1.0, 1.0, 0}},
                                       {{0.75, 0.25, 0}, {1.0, 1.0, 0}}};
  check_boxes(1, &inside, 4, 64, 32);
  check_boxes(1, &edge, 4, 64, 24);
  check_boxes(1, &corner, 4, 64, 16);
  check_boxes(1, &all, 16, 256, 0);
  check_boxes(1, &band, 8, 128, 32);
  check_boxes(2, two, 2, 32, 8 + 12);
  check_boxes(2, overlapping, 5, 80, 8 + 4 + 4 + 4 - 1);
}

/* Centres on the edge of the fine region are fine; a wider gap takes in the diagonal neighbours. */
static void centres_on_the_edge(void **state) {
  (void)state;
  const double zero[3] = {0}, one[3] = {1.0, 1.0, 0.0}, gap[2] = {0.3, 0.9};
  const cdem_bsm_box box = {{0.25, 0.25, 0}, {0.75, 0.75, 0}};
  cdem_mesh mesh = box_mesh(CDEM_SHAPE_QUAD4, (int32_t[3]){4, 4, 0}, zero, one, 0.0);
  cdem_grains g = lattice("cubic", 2, zero, one, true, 1.0 / 32.0);
  int32_t cells, *cell;
  assert_int_equal(g.grains, 17 * 17);
  check_ok(cdem_bsm_cells(&mesh, 1, &box, &cells, &cell, &fault));
  for (int k = 0; k < 2; k++) {
    cdem_partition p;
    check_ok(cdem_partition_init(&mesh, cells, cell, &g, gap[k], &p, &fault));
    assert_int_equal(p.fine, 81);
    assert_int_equal(p.interfaces, k == 0 ? 36 : 40);
    cdem_partition_release(&p);
  }
  free(cell);
  cdem_grains_release(&g);
  cdem_mesh_release(&mesh);
}

static void spheres(void **state) {
  (void)state;
  const double zero[3] = {0}, one[3] = {1.0, 1.0, 1.0};
  const cdem_bsm_box box = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}};
  const cdem_shape shape[2] = {CDEM_SHAPE_HEX8, CDEM_SHAPE_PYR5};
  const int32_t bricks[2] = {1, 6};
  for (int k = 0; k < 2; k++) {
    cdem_mesh mesh = box_mesh(shape[k], (int32_t[3]){4, 4, 4}, zero, one, 0.0);
    cdem_grains g = lattice("cubic", 3, zero, one, false, 1.0 / 32.0);
    cdem_partition p;
    int32_t cells, *cell;
    check_ok(cdem_bsm_cells(&mesh, 1, &box, &cells, &cell, &fault));
    assert_int_equal(cells, 8 * bricks[k]);
    check_ok(cdem_partition_init(&mesh, cells, cell, &g, 0.3, &p, &fault));
    assert_int_equal(p.fine, 512);
    assert_int_equal(p.interfaces, 6 * 64);
    cdem_partition_release(&p);
    free(cell);
    cdem_grains_release(&g);
    cdem_mesh_release(&mesh);
  }
}

/* Sizes 1:10 at random in a distorted mesh, two regions that are far apart. */
static void sizes_of_all_kinds(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    cdem_random random = {17 + (uint64_t)dim};
    cdem_mesh mesh = mesh_of(dim == 2 ? CDEM_SHAPE_QUAD4 : CDEM_SHAPE_HEX8, 4, 0.2, 3);
    cdem_grains g = {.dim = dim};
    const cdem_bsm_box box[2] = {{{0, 0, 0}, {0.4, 0.3, 0.3}}, {{0.7, 0.5, 0}, {1.3, 1.0, 0}}};
    int32_t cells, *cell;
    for (int i = 0; i < (dim == 2 ? 1200 : 1500); i++) {
      double x[3] = {cdem_random_uniform(&random, 0.0, 1.3), cdem_random_uniform(&random, 0.0, 1.0),
                     dim == 3 ? cdem_random_uniform(&random, 0.0, 0.9) : 0.0};
      double most = dim == 2 ? 0.05 : 0.15;
      double size = cdem_random_uniform(&random, log(0.1 * most), log(most));
      check_ok(cdem_grains_add(&g, x, exp(size), &fault));
    }
    check_ok(cdem_bsm_cells(&mesh, 2, box, &cells, &cell, &fault));
    for (int k = 0; k < 3; k++) {
      double gap = 0.4 * k;
      cdem_partition p;
      check_ok(cdem_partition_init(&mesh, cells, cell, &g, gap, &p, &fault));
      assert_true(p.fine > 50 && p.interfaces > 50);
      check_partition(&mesh, cells, cell, &g, gap, &p);
      cdem_partition_release(&p);
    }
    free(cell);
    cdem_grains_release(&g);
    cdem_mesh_release(&mesh);
  }
}

/* Two small grains at opposite corners of a large box: bins by the number of grains. */
static void few_grains_far_apart(void **state) {
  (void)state;
  const double zero[3] = {0}, size[3] = {1.0, 1.0, 1.0};
  cdem_mesh mesh = box_mesh(CDEM_SHAPE_HEX8, (int32_t[3]){1, 1, 1}, zero, size, 0.0);
  cdem_grains g = {.dim = 3};
  cdem_partition p;
  int32_t cells, *cell = cells_of_mesh(&mesh, &cells);
  for (int i = 0; i < 2; i++) {
    const double x[3] = {0.001 + 0.998 * i, 0.001 + 0.998 * i, 0.001 + 0.998 * i};
    check_ok(cdem_grains_add(&g, x, 1e-6, &fault));
  }
  check_ok(cdem_partition_init(&mesh, cells, cell, &g, 0.3, &p, &fault));
  assert_int_equal(p.fine, 2);
  cdem_partition_release(&p);
  free(cell);
  cdem_grains_release(&g);
  cdem_mesh_release(&mesh);
}

/* ---- refusals ---- */

static void refuse(const cdem_grains *g, const char *text) {
  const double zero[3] = {0}, one[3] = {1.0, 1.0, 0.0};
  const cdem_bsm_box box = {{0.25, 0.5, 0}, {0.75, 1.0, 0}};
  cdem_mesh mesh = box_mesh(CDEM_SHAPE_QUAD4, (int32_t[3]){4, 4, 0}, zero, one, 0.0);
  cdem_partition p = {0};
  int32_t cells, *cell;
  check_ok(cdem_bsm_cells(&mesh, 1, &box, &cells, &cell, &fault));
  check_fails(cdem_partition_init(&mesh, cells, cell, g, 0.3, &p, &fault), CDEM_INPUT, text);
  assert_null(p.part);
  free(cell);
  cdem_mesh_release(&mesh);
}

static void refusals(void **state) {
  (void)state;
  const double zero[3] = {0}, one[3] = {1.0, 1.0, 0.0}, twice[3] = {1.0, 2.0, 0.0};
  const double right[3] = {0.25, 0.5, 0.0}, below[3] = {1.0, 0.4, 0.0};
  const cdem_bsm_box box[2] = {{{0}, {0}}, {{1.5, 0.5, 0}, {1.75, 1.0, 0}}};
  cdem_mesh mesh = box_mesh(CDEM_SHAPE_QUAD4, (int32_t[3]){4, 4, 0}, zero, one, 0.0);
  int32_t cells = 42, *cell = NULL;
  check_fails(cdem_bsm_cells(&mesh, 2, box, &cells, &cell, &fault), CDEM_INPUT,
              "fine region 1, from (1.5, 0.5, 0) to (1.75, 1, 0 m), holds no element of the mesh, "
              "which goes from (0, 0, 0) to (1, 1, 0 m)");
  assert_true(cells == 42 && cell == NULL);
  cdem_mesh_release(&mesh);
  cdem_grains g = lattice("cubic", 2, zero, below, false, 1.0 / 32.0);
  refuse(&g, "no grain has its centre in the fine region");
  cdem_grains_release(&g);
  g = lattice("cubic", 2, zero, twice, false, 1.0 / 32.0);
  refuse(&g, "m) touches the fine region but lies outside the mesh");
  cdem_grains_release(&g);
  g = lattice("cubic", 2, right, one, false, 1.0 / 32.0); /* nothing left of and below the region */
  refuse(&g, "interface grains are missing: element ");
  refuse(&g, "but only 0 % of that face has grains behind it");
  cdem_grains_release(&g);
}

static void out_of_memory(void **state) {
  (void)state;
  const double zero[3] = {0}, one[3] = {1.0, 1.0, 0.0};
  const cdem_bsm_box box = {{0.25, 0.5, 0}, {0.75, 1.0, 0}};
  cdem_mesh mesh = box_mesh(CDEM_SHAPE_QUAD4, (int32_t[3]){4, 4, 0}, zero, one, 0.0);
  cdem_grains g = lattice("cubic", 2, zero, one, false, 1.0 / 32.0);
  cdem_status status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    cdem_partition p = {0};
    int32_t cells = 42, *cell = NULL;
    cdem_memory_fail_after(n);
    status = cdem_bsm_cells(&mesh, 1, &box, &cells, &cell, &fault);
    if (status == CDEM_OK)
      status = cdem_partition_init(&mesh, cells, cell, &g, 0.3, &p, &fault);
    else
      assert_true(cells == 42 && cell == NULL);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || (status == CDEM_MEMORY && p.part == NULL && p.xi == NULL));
    cdem_partition_release(&p);
    free(cell);
    memset(&fault, 0, sizeof fault);
    assert_true(n < 100);
  }
  cdem_grains_release(&g);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(foundation),
      cmocka_unit_test(where_the_region_lies),
      cmocka_unit_test(centres_on_the_edge),
      cmocka_unit_test(spheres),
      cmocka_unit_test(sizes_of_all_kinds),
      cmocka_unit_test(few_grains_far_apart),
      cmocka_unit_test(refusals),
      cmocka_unit_test(out_of_memory),
  };
  return cmocka_run_group_tests_name("bsm partition", tests, NULL, NULL);
}
