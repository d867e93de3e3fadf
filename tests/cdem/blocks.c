/* Room cdem: cutting a mesh, against counts and measures known in advance. */
#include "cdem/blocks.h"

#include "support/test.h"

static cdem_fault fault;

static const cdem_shape first_order[] = {CDEM_SHAPE_TRI3, CDEM_SHAPE_QUAD4,  CDEM_SHAPE_TET4,
                                         CDEM_SHAPE_PYR5, CDEM_SHAPE_WEDGE6, CDEM_SHAPE_HEX8};

static cdem_mesh grid(cdem_shape shape, int nx, int ny, int nz, double distortion) {
  cdem_mesh mesh = {0};
  check_ok(cdem_mesh_grid(&(cdem_mesh_grid_options){.shape = shape,
                                                    .count = {nx, ny, nz},
                                                    .size = {nx, ny, nz > 0 ? nz : 1},
                                                    .distortion = distortion,
                                                    .seed = 7},
                          &mesh, &fault));
  return mesh;
}

static cdem_mesh shaped(cdem_shape shape, double distortion) {
  return grid(shape, 3, 2, cdem_shape_get(shape)->dimension == 3 ? 2 : 0, distortion);
}

static const char *const body[] = {"body"};

static void add_lines(cdem_mesh *mesh, const char *group, int count, const int32_t (*node)[2]) {
  int32_t first = mesh->cells, id[16];
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_LINE2, count, &node[0][0], NULL, &fault));
  for (int i = 0; i < count; i++)
    id[i] = first + i;
  check_ok(cdem_mesh_add_group(mesh, group, 1, count, id, &fault));
}

/* Without cuts the copy is the mesh itself, and its facets are its surface. */
static void whole_mesh_is_copied(void **state) {
  (void)state;
  const int32_t surface[] = {10, 10, 64, 32, 44, 32};
  for (int s = 0; s < 6; s++) {
    cdem_mesh mesh = shaped(first_order[s], 0.2);
    cdem_blocks blocks = {0};
    check_ok(cdem_blocks_init(&(cdem_blocks_options){.mesh = &mesh}, &blocks, &fault));
    assert_int_equal(blocks.mesh.nodes, mesh.nodes);
    assert_int_equal(blocks.mesh.cells, mesh.cells);
    assert_int_equal(blocks.mesh.groups, mesh.groups);
    assert_memory_equal(blocks.mesh.xyz, mesh.xyz, (size_t)mesh.nodes * 3 * sizeof *mesh.xyz);
    assert_memory_equal(blocks.mesh.cell_node, mesh.cell_node,
                        (size_t)mesh.cell_start[mesh.cells] * sizeof *mesh.cell_node);
    assert_int_equal(blocks.blocks, 1);
    assert_int_equal(blocks.pairs, 0);
    assert_int_equal(blocks.facets, surface[s]);
    cdem_blocks_release(&blocks);
    cdem_mesh_release(&mesh);
  }
}

static void cell_center(const cdem_mesh *mesh, int32_t cell, double center[3]) {
  int64_t from = mesh->cell_start[cell], to = mesh->cell_start[cell + 1];
  for (int i = 0; i < 3; i++) {
    center[i] = 0;
    for (int64_t c = from; c < to; c++)
      center[i] += mesh->xyz[3 * mesh->cell_node[c] + i] / (double)(to - from);
  }
}

/* Facets of a cell that has all of its own: they point outward, close (areas add to zero), and
 * enclose the volume sum x.A/dimension (exact for flat faces, so that the box stays undistorted).
 */
static void check_closed_cells(const cdem_blocks *blocks, double volume) {
  const cdem_mesh *mesh = &blocks->mesh;
  double *sum = test_calloc((size_t)mesh->cells * 3, sizeof *sum), found = 0;
  for (int32_t f = 0; f < blocks->facets; f++) {
    const cdem_facet *facet = &blocks->facet[f];
    double area[3], share[4], center[3], middle[3] = {0}, total = 0;
    cdem_facet_area(facet, mesh->xyz, 1, area, share);
    cell_center(mesh, facet->cell, center);
    for (int k = 0; k < facet->corners; k++) {
      total += share[k];
      assert_int_equal(blocks->node_block[facet->node[k]], blocks->block[facet->cell]);
      for (int i = 0; i < 3; i++)
        middle[i] += mesh->xyz[3 * facet->node[k] + i] / facet->corners;
    }
    check_near(total, cdem_norm3(area), 1e-14, 0);
    double out[3] = {middle[0] - center[0], middle[1] - center[1], middle[2] - center[2]};
    assert_true(cdem_dot3(out, area) > 0);
    found += cdem_dot3(middle, area) / blocks->dimension;
    for (int i = 0; i < 3; i++)
      sum[3 * facet->cell + i] += area[i];
  }
  for (int32_t c = 0; c < 3 * mesh->cells; c++)
    check_below(fabs(sum[c]), 1e-14);
  check_near(found, volume, 1e-13, 0);
  test_free(sum);
}

static void check_pairs(const cdem_blocks *blocks) {
  const cdem_mesh *mesh = &blocks->mesh;
  for (int32_t p = 0; p < blocks->pairs; p++) {
    const cdem_face_pair *pair = &blocks->pair[p];
    assert_true(pair->cell[0] < pair->cell[1]);
    assert_true(p == 0 || pair[-1].cell[0] <= pair->cell[0]);
    for (int side = 0; side < 2; side++) {
      const cdem_facet *facet = &blocks->facet[blocks->pair_facet[2 * p + side]];
      assert_int_equal(facet->pair, p);
      assert_int_equal(facet->cell, pair->cell[side]);
      assert_int_equal(facet->corners, pair->corners);
      for (int k = 0; k < pair->corners; k++) {
        bool found = false;
        for (int l = 0; l < facet->corners; l++)
          found |= facet->node[l] == pair->node[side][k];
        assert_true(found);
      }
    }
    for (int k = 0; k < pair->corners; k++) {
      assert_int_equal(pair->node[0][k], blocks->facet[blocks->pair_facet[2 * p]].node[k]);
      assert_memory_equal(mesh->xyz + 3 * pair->node[0][k], mesh->xyz + 3 * pair->node[1][k],
                          3 * sizeof(double));
      assert_int_equal(blocks->original[pair->node[0][k]], blocks->original[pair->node[1][k]]);
    }
  }
}

/* Every cell its own block: nodes are the cells' corners, pairs the inner faces (Euler: twice the
 * inner ones and once the outer ones are all faces of cells). */
static void every_cell_breaks_free(void **state) {
  (void)state;
  for (int s = 0; s < 6; s++) {
    const cdem_shape_info *info = cdem_shape_get(first_order[s]);
    cdem_mesh mesh = shaped(first_order[s], 0);
    cdem_blocks blocks = {0}, whole = {0};
    check_ok(cdem_blocks_init(&(cdem_blocks_options){.mesh = &mesh}, &whole, &fault));
    check_ok(cdem_blocks_init(
        &(cdem_blocks_options){.mesh = &mesh, .breakable = 1, .breakable_group = body}, &blocks,
        &fault));
    int32_t cells = cdem_mesh_find_group(&mesh, "body")->cells;
    int faces = info->dimension == 3 ? info->faces : info->edges;
    assert_int_equal(blocks.blocks, cells);
    assert_int_equal(blocks.mesh.nodes, cells * info->nodes);
    assert_int_equal(blocks.facets, cells * faces);
    assert_int_equal(2 * blocks.pairs, cells * faces - whole.facets);
    check_closed_cells(&blocks, info->dimension == 3 ? 12 : 6);
    check_pairs(&blocks);
    for (int32_t n = 1; n < blocks.mesh.nodes; n++) /* copies follow each other */
      assert_true(blocks.original[n] >= blocks.original[n - 1]);
    for (int32_t n = 0; n < blocks.mesh.nodes; n++)
      assert_int_equal(blocks.mesh.node_tag[n], mesh.node_tag[blocks.original[n]]);
    int32_t count, *facet;
    check_ok(cdem_blocks_group_facets(&blocks, "x1", &count, &facet, &fault));
    assert_int_equal(count, cdem_mesh_find_group(&mesh, "x1")->cells);
    for (int32_t i = 0; i < count; i++)
      assert_int_equal(blocks.facet[facet[i]].pair, -1);
    free(facet);
    cdem_blocks_release(&whole);
    cdem_blocks_release(&blocks);
    cdem_mesh_release(&mesh);
  }
}

/* 4 x 4 squares, nodes 5 y + x, cut along y = 2. From the left side to the middle: the tip stays
 * single. Through: two blocks. One inner edge alone: nothing parts. */
static void joint_ends_inside(void **state) {
  (void)state;
  const int32_t line[4][2] = {{10, 11}, {11, 12}, {12, 13}, {13, 14}};
  const char *const joint[] = {"joint"};
  const struct {
    int from, to, nodes, blocks;
  } cases[] = {{0, 2, 27, 1}, {0, 4, 30, 2}, {1, 2, 25, 1}, {1, 3, 26, 1}};
  for (int c = 0; c < 4; c++) {
    cdem_mesh mesh = grid(CDEM_SHAPE_QUAD4, 4, 4, 0, 0);
    int edges = cases[c].to - cases[c].from;
    add_lines(&mesh, "joint", edges, &line[cases[c].from]);
    cdem_blocks blocks = {0};
    check_ok(cdem_blocks_init(
        &(cdem_blocks_options){.mesh = &mesh, .joints = 1, .joint_group = joint}, &blocks, &fault));
    assert_int_equal(blocks.mesh.nodes, cases[c].nodes);
    assert_int_equal(blocks.blocks, cases[c].blocks);
    assert_int_equal(blocks.pairs, edges);
    assert_int_equal(blocks.facets, 16 + 2 * edges);
    check_pairs(&blocks);
    int single = 0;
    for (int32_t p = 0; p < blocks.pairs; p++) {
      assert_int_equal(blocks.pair[p].joint, 0);
      for (int k = 0; k < 2; k++)
        single += blocks.pair[p].node[0][k] == blocks.pair[p].node[1][k];
    }
    assert_int_equal(single, c == 0 ? 1 : c == 1 ? 0 : 2);
    int32_t count, *list;
    check_ok(cdem_blocks_group_facets(&blocks, "joint", &count, &list, &fault));
    assert_int_equal(count, 2 * edges);
    free(list);
    check_ok(cdem_blocks_group_nodes(&blocks, "joint", &count, &list, &fault));
    assert_int_equal(count, edges + 1 + cases[c].nodes - 25);
    free(list);
    cdem_blocks_release(&blocks);
    cdem_mesh_release(&mesh);
  }
}

/* A joint of one face inside a 3-D grid parts no node; of 2 x 2 faces its middle node. */
static void joint_inside_a_body(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_HEX8, 4, 4, 2, 0);
  const char *const joint[] = {"joint"};
  int32_t id[4], quad[4][4];
  for (int i = 0; i < 4; i++) {
    int32_t n = 25 + 5 * (1 + i / 2) + 1 + i % 2;
    memcpy(quad[i], (int32_t[4]){n, n + 1, n + 6, n + 5}, sizeof quad[i]);
    id[i] = mesh.cells + i;
  }
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_QUAD4, 4, &quad[0][0], NULL, &fault));
  for (int faces = 1; faces <= 4; faces += 3) {
    check_ok(cdem_mesh_add_group(&mesh, "joint", 2, faces, id, &fault));
    cdem_blocks blocks = {0};
    check_ok(cdem_blocks_init(
        &(cdem_blocks_options){.mesh = &mesh, .joints = 1, .joint_group = joint}, &blocks, &fault));
    assert_int_equal(blocks.mesh.nodes, 75 + (faces == 4));
    assert_int_equal(blocks.pairs, faces);
    assert_int_equal(blocks.blocks, 1);
    check_pairs(&blocks);
    cdem_blocks_release(&blocks);
  }
  cdem_mesh_release(&mesh);
}

/* A row of six squares: the left two breakable, the next two separate, a joint between the last
 * two. 0|1|23|4|5, the rest (4, 5) parted by the joint. */
static void all_kinds_of_cuts_together(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_QUAD4, 6, 1, 0, 0);
  const int32_t line[1][2] = {{5, 12}};
  add_lines(&mesh, "joint", 1, line);
  check_ok(cdem_mesh_add_group(&mesh, "left", 2, 2, (int32_t[]){0, 1}, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "middle", 2, 2, (int32_t[]){2, 3}, &fault));
  const char *const left[] = {"left"}, *const middle[] = {"middle"}, *const joint[] = {"joint"};
  cdem_blocks_options options = {.mesh = &mesh,
                                 .breakable = 1,
                                 .breakable_group = left,
                                 .separate = 1,
                                 .separate_group = middle,
                                 .joints = 1,
                                 .joint_group = joint};
  cdem_blocks blocks = {0};
  check_ok(cdem_blocks_init(&options, &blocks, &fault));
  const int32_t block[6] = {0, 1, 2, 2, 3, 4};
  assert_int_equal(blocks.blocks, 5);
  assert_memory_equal(blocks.block, block, sizeof block);
  assert_int_equal(blocks.pairs, 4);
  for (int p = 0; p < 4; p++)
    assert_int_equal(blocks.pair[p].joint, p == 3 ? 0 : -1);
  assert_int_equal(blocks.mesh.nodes, 14 + 8);
  check_pairs(&blocks);
  cdem_blocks_release(&blocks);
  /* Of the chosen cells only: the rest of the mesh is dropped, the side x0 with it. */
  options = (cdem_blocks_options){.mesh = &mesh, .groups = 1, .group = middle};
  check_ok(cdem_blocks_init(&options, &blocks, &fault));
  assert_int_equal(blocks.mesh.nodes, 6);
  assert_int_equal(blocks.old_cell[0], 2);
  assert_int_equal(blocks.facets, 6);
  assert_int_equal(cdem_mesh_find_group(&blocks.mesh, "x0")->cells, 0);
  assert_int_equal(cdem_mesh_find_group(&blocks.mesh, "y0")->cells, 2);
  assert_int_equal(cdem_mesh_find_group(&blocks.mesh, "body")->cells, 2);
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
}

/* Two squares that meet at a corner only are parted there: no face joins them. */
static void cells_that_meet_at_a_corner_are_apart(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_QUAD4, 2, 2, 0, 0);
  const char *const both[] = {"both"};
  check_ok(cdem_mesh_add_group(&mesh, "both", 2, 2, (int32_t[]){0, 3}, &fault));
  cdem_blocks blocks = {0};
  check_ok(cdem_blocks_init(&(cdem_blocks_options){.mesh = &mesh, .groups = 1, .group = both},
                            &blocks, &fault));
  assert_int_equal(blocks.mesh.nodes, 8);
  assert_int_equal(blocks.blocks, 2);
  assert_int_equal(blocks.pairs, 0);
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
}

/* A cube with a pyramid on top, a wedge at its side and a tetrahedron on the pyramid: one of each
 * shape, joined by faces of three and four corners. Volumes 1, 1/3, 1/2, 1/6. */
static void mixed_shapes(void **state) {
  (void)state;
  const double xyz[][3] = {{0, 0, 0},     {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                           {0, 0, 1},     {1, 0, 1}, {1, 1, 1}, {0, 1, 1},
                           {0.5, 0.5, 2}, {2, 0, 0}, {2, 1, 0}, {1.5, 0.5, 2}};
  cdem_mesh mesh = {0};
  check_ok(cdem_mesh_add_nodes(&mesh, 12, &xyz[0][0], NULL, &fault));
  const int32_t hex[] = {0, 1, 2, 3, 4, 5, 6, 7}, pyr[] = {4, 5, 6, 7, 8},
                wedge[] = {1, 5, 9, 2, 6, 10}, tet[] = {5, 11, 6, 8};
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_HEX8, 1, hex, NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_PYR5, 1, pyr, NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_WEDGE6, 1, wedge, NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_TET4, 1, tet, NULL, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "body", 3, 4, (int32_t[]){0, 1, 2, 3}, &fault));
  const int32_t edge[] = {5, 6};
  const int32_t corner[] = {5};
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_LINE2, 1, edge, NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_POINT1, 1, corner, NULL, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "edge", 1, 1, (int32_t[]){4}, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "corner", 0, 1, (int32_t[]){5}, &fault));
  cdem_blocks blocks = {0};
  check_ok(cdem_blocks_init(
      &(cdem_blocks_options){.mesh = &mesh, .breakable = 1, .breakable_group = body}, &blocks,
      &fault));
  assert_int_equal(blocks.mesh.nodes, 8 + 5 + 6 + 4);
  assert_int_equal(blocks.pairs, 3);
  const int corners[] = {4, 4, 3};
  for (int p = 0; p < 3; p++)
    assert_int_equal(blocks.pair[p].corners, corners[p]);
  check_pairs(&blocks);
  check_closed_cells(&blocks, 1 + 1.0 / 3 + 0.5 + 1.0 / 6);
  int32_t count, *node;
  check_ok(cdem_blocks_group_nodes(&blocks, "edge", &count, &node, &fault));
  assert_int_equal(count, 8); /* four cells have it */
  free(node);
  check_ok(cdem_blocks_group_nodes(&blocks, "corner", &count, &node, &fault));
  assert_int_equal(count, 4);
  free(node);
  /* The line and the point themselves are of the first cell. */
  assert_int_equal(blocks.node_block[cdem_mesh_cell(&blocks.mesh, 4)[1]], 0);
  assert_int_equal(blocks.node_block[cdem_mesh_cell(&blocks.mesh, 5)[0]], 0);
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
}

/* Shares are the integrals of the shape functions: against Gauss points on a warped face. */
static void shares_are_integrals(void **state) {
  (void)state;
  const double xyz[4][3] = {{0, 0, 0}, {2, 0.1, 0.2}, {2.5, 1.5, 0}, {-0.3, 1, 0.3}};
  const double xi[4] = {-1, 1, 1, -1}, eta[4] = {-1, -1, 1, 1};
  cdem_facet facet = {.node = {0, 1, 2, 3}, .corners = 4};
  double area[3], share[4], sum[3] = {0}, part[4] = {0}, g = 1 / sqrt(3.0);
  cdem_facet_area(&facet, &xyz[0][0], 1, area, share);
  for (int pass = 0; pass < 2; pass++)
    for (int q = 0; q < 4; q++) {
      double u[3] = {0}, v[3] = {0}, normal[3];
      for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++) {
          u[i] += xi[k] * (1 + g * eta[k] * eta[q]) / 4 * xyz[k][i];
          v[i] += eta[k] * (1 + g * xi[k] * xi[q]) / 4 * xyz[k][i];
        }
      cdem_cross3(u, v, normal);
      for (int i = 0; i < 3 && pass == 0; i++)
        sum[i] += normal[i];
      for (int k = 0; k < 4 && pass == 1; k++)
        part[k] += (1 + g * xi[k] * xi[q]) * (1 + g * eta[k] * eta[q]) / 4 *
                   cdem_dot3(normal, sum) / cdem_norm3(sum);
    }
  for (int i = 0; i < 3; i++)
    check_near(area[i], sum[i], 1e-14, 1e-15);
  for (int k = 0; k < 4; k++)
    check_near(share[k], part[k], 1e-14, 0);
}

static void errors_say_what_to_do(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_QUAD4, 2, 2, 0, 0);
  cdem_blocks blocks = {0};
  const char *const none[] = {"nowhere"}, *const x0[] = {"x0"}, *const two[] = {"body", "x0"};
  cdem_blocks_options options = {.mesh = &mesh, .groups = 1, .group = none};
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT,
              "there is no group 'nowhere' in the mesh; there are 'body', 'x0', 'x1', 'y0', 'y1'");
  options.group = x0;
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT, "have dimension 1");
  options = (cdem_blocks_options){.mesh = &mesh, .groups = 2, .group = two};
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT,
              "group 'x0' has dimension 1, but 'body' has 2");
  options = (cdem_blocks_options){.mesh = &mesh, .breakable = 1, .breakable_group = x0};
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT,
              "breakable group 'x0' has dimension 1, but the chosen cells have 2");
  options = (cdem_blocks_options){.mesh = &mesh, .joints = 1, .joint_group = body};
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT,
              "joint group 'body' has dimension 2; a joint between cells of dimension 2 is a group "
              "of edges");
  options.joint_group = x0;
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT,
              "joint group 'x0': element 5 is no face between two chosen cells");
  const int32_t third[] = {1, 4, 8, 5}; /* a third cell on the edge 1-4 */
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_QUAD4, 1, third, NULL, &fault));
  options = (cdem_blocks_options){.mesh = &mesh};
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT, "share one face");
  assert_null(blocks.original);
  cdem_mesh_release(&mesh);
  mesh = grid(CDEM_SHAPE_TRI6, 1, 1, 0, 0);
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT, "mesh with order 1");
  cdem_mesh_release(&mesh);
  check_fails(cdem_blocks_init(&options, &blocks, &fault), CDEM_INPUT, "have dimension -1");
  mesh = grid(CDEM_SHAPE_QUAD4, 1, 1, 0, 0);
  check_ok(cdem_blocks_init(&options, &blocks, &fault));
  int32_t count, *list;
  check_fails(cdem_blocks_group_facets(&blocks, "body", &count, &list, &fault), CDEM_INPUT,
              "a surface of cells of dimension 2 is a group of edges");
  check_fails(cdem_blocks_group_nodes(&blocks, "z9", &count, &list, &fault), CDEM_INPUT,
              "there is no group 'z9'");
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
}

/* Each allocation in turn fails: the outputs are empty and nothing leaks (the sanitizer looks). */
static void memory_failures_leave_nothing(void **state) {
  (void)state;
  cdem_mesh mesh = grid(CDEM_SHAPE_HEX8, 2, 2, 2, 0);
  cdem_blocks_options options = {.mesh = &mesh, .breakable = 1, .breakable_group = body};
  cdem_blocks blocks = {0};
  cdem_status status = CDEM_MEMORY;
  int failures = 0;
  for (; status == CDEM_MEMORY && failures < 1000; failures++) {
    cdem_memory_fail_after(failures);
    status = cdem_blocks_init(&options, &blocks, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || blocks.original == NULL);
  }
  assert_int_equal(status, CDEM_OK);
  assert_true(failures > 25);
  int32_t count, *list;
  status = CDEM_MEMORY;
  for (int n = 0; status == CDEM_MEMORY; n++) {
    cdem_memory_fail_after(n);
    status = cdem_blocks_group_facets(&blocks, "x0", &count, &list, &fault);
    cdem_memory_fail_after(-1);
  }
  free(list);
  status = CDEM_MEMORY;
  for (int n = 0; status == CDEM_MEMORY; n++) {
    cdem_memory_fail_after(n);
    status = cdem_blocks_group_nodes(&blocks, "x0", &count, &list, &fault);
    cdem_memory_fail_after(-1);
  }
  assert_int_equal(count, 16);
  free(list);
  cdem_blocks_release(&blocks);
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
  memset(&fault, 0, sizeof fault);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(whole_mesh_is_copied),
      cmocka_unit_test(every_cell_breaks_free),
      cmocka_unit_test(joint_ends_inside),
      cmocka_unit_test(joint_inside_a_body),
      cmocka_unit_test(all_kinds_of_cuts_together),
      cmocka_unit_test(cells_that_meet_at_a_corner_are_apart),
      cmocka_unit_test(mixed_shapes),
      cmocka_unit_test(shares_are_integrals),
      cmocka_unit_test(errors_say_what_to_do),
      cmocka_unit_test(memory_failures_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
