/* The assembled network as Matrix Market and as a CalculiX deck: the files hold the finite-element
 * matrix itself, and CalculiX moves the springs as the elements would move. */
#include "io/support.h"
#include "network/assemble.h"

#include <lapacke.h>

enum { MOST = 36 };

typedef struct {
  cdem_mesh mesh;
  cdem_material material;
  cdem_model model;
  int rows;
  double k[MOST * MOST]; /* the finite-element matrix, by B^T D B */
} network;

static cdem_model_options options_of(const cdem_mesh *mesh, const cdem_material *material) {
  return (cdem_model_options){.mesh = mesh,
                              .materials = 1,
                              .material = material,
                              .default_material = 0,
                              .section = {CDEM_PLANE_STRAIN, 1.0}};
}

/* A strip of distorted cells: two quad4, or two hex8. */
static void network_init(network *n, cdem_shape shape, cdem_material material) {
  cdem_fault fault = {0};
  bool solid = shape == CDEM_SHAPE_HEX8;
  memset(n, 0, sizeof *n);
  const cdem_mesh_grid_options grid = {
      .shape = shape, .count = {2, 1, solid ? 1 : 0}, .size = {2.0, 1.0, solid ? 1.0 : 0.0}};
  n->material = material;
  check_ok(cdem_mesh_grid(&grid, &n->mesh, &fault));
  n->mesh.xyz[3] += 0.15; /* so that no two blocks are alike */
  n->mesh.xyz[7] -= 0.1;
  const cdem_model_options options = options_of(&n->mesh, &n->material);
  check_ok(cdem_model_init(&options, &n->model, &fault));
  n->rows = n->mesh.nodes * n->model.dofs;
  assert_true(n->rows <= MOST);
  cdem_sparse sparse = {0};
  check_ok(cdem_sparse_init(&n->model, &sparse, &fault));
  check_ok(cdem_sparse_add_elements(&n->model, 1.0, &sparse, NULL, &fault));
  int dofs = n->model.dofs;
  for (int p = 0; p < sparse.nodes; p++)
    for (int64_t k = sparse.start[p]; k < sparse.start[p + 1]; k++)
      for (int e = 0; e < dofs * dofs; e++)
        n->k[(p * dofs + e / dofs) * n->rows + sparse.column[k] * dofs + e % dofs] =
            sparse.value[k * dofs * dofs + e];
  cdem_sparse_release(&sparse);
}

static void network_release(network *n) {
  cdem_model_release(&n->model);
  cdem_mesh_release(&n->mesh);
}

static cdem_status write_network(const network *n, const char *path, cdem_fault *fault) {
  cdem_springs_writer *writer = NULL;
  const cdem_convert_options options = {.threads = 2};
  cdem_status status = cdem_springs_format_of(path)->open(path, &n->model, &writer, fault);
  if (status == CDEM_OK)
    status = cdem_network_convert(&n->model, &options, &writer->sink, 1, fault);
  if (status == CDEM_OK)
    status = writer->commit(writer, fault);
  cdem_springs_writer_destroy(&writer);
  return status;
}

static double largest(const network *n) {
  double most = 0.0;
  for (int i = 0; i < n->rows * n->rows; i++)
    most = fmax(most, fabs(n->k[i]));
  return most;
}

/* Springs rebuild their blocks to 1e-12 of the block's norm, a row adds up to 2 x 8 blocks. */
static void check_matrix(const network *n, const double *k) {
  for (int i = 0; i < n->rows * n->rows; i++)
    check_near(k[i], n->k[i], 0, 1.6e-11 * largest(n));
}

static void read_mtx(const network *n, const char *path, const char *symmetry, const char *tags,
                     double *k) {
  char *text = read_whole(path, NULL), *line = text, expected[64];
  snprintf(expected, sizeof expected, "%%%%MatrixMarket matrix coordinate real %s\n", symmetry);
  assert_memory_equal(text, expected, strlen(expected));
  bool tags_found = false;
  for (; *line == '%'; line += strcspn(line, "\n") + 1)
    tags_found |= strncmp(line, tags, strlen(tags)) == 0;
  assert_true(tags_found);
  int rows, columns, entries, used;
  assert_int_equal(sscanf(line, "%d %d %d%n", &rows, &columns, &entries, &used), 3);
  assert_int_equal(rows, n->rows);
  assert_int_equal(columns, n->rows);
  line += used;
  memset(k, 0, sizeof(double) * MOST * MOST);
  for (int e = 0; e < entries; e++) {
    int i, j;
    double value;
    assert_int_equal(sscanf(line, "%d %d %lf%n", &i, &j, &value, &used), 3);
    line += used;
    k[(i - 1) * n->rows + j - 1] = value;
    if (strcmp(symmetry, "symmetric") == 0) {
      assert_true(i >= j);
      k[(j - 1) * n->rows + i - 1] = value;
    }
  }
  assert_string_equal(line, "\n");
  free(text);
}

static void matrix_market_holds_the_matrix(void **state) {
  (void)state;
  static const cdem_shape shapes[] = {CDEM_SHAPE_QUAD4, CDEM_SHAPE_HEX8};
  for (int s = 0; s < 2; s++) {
    cdem_fault fault = {0};
    network n;
    double k[MOST * MOST];
    network_init(&n, shapes[s], cdem_material_isotropic(4e10, 0.3));
    check_ok(write_network(&n, in_scratch("k.mtx"), &fault));
    read_mtx(&n, in_scratch("k.mtx"), "symmetric", "% 1 2 3 4 5 6", k);
    check_matrix(&n, k);
    network_release(&n);
  }
}

/* A network whose matrix is not symmetric: any rows do. Its matrix from the rows, by
 * K_ij -= S, K_ii += S, K_ji -= S^T, K_jj += S^T. */
static void unsymmetric_networks_are_general(void **state) {
  (void)state;
  cdem_fault fault = {0};
  hand_network hand;
  network n = {.rows = 24};
  double k[MOST * MOST];
  hand_network_init(&hand, "hex8");
  check_ok(hand_write(&hand, cdem_springs_format_find("mtx"), in_scratch("g.mtx"), 28, 1, &fault));
  for (int64_t p = 0; p < hand.model.pairs; p++) {
    double s[9];
    int i = hand.pair[p].node[0] * 3, j = hand.pair[p].node[1] * 3;
    rows_to_block(hand.pair[p].set.row, hand.pair[p].set.rows, 3, s);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        n.k[(i + a) * 24 + j + b] -= s[3 * a + b];
        n.k[(i + a) * 24 + i + b] += s[3 * a + b];
        n.k[(j + a) * 24 + i + b] -= s[3 * b + a];
        n.k[(j + a) * 24 + j + b] += s[3 * b + a];
      }
  }
  read_mtx(&n, in_scratch("g.mtx"), "general", "% 1000 993 986 979", k);
  check_matrix(&n, k);
  check_fails(
      hand_write(&hand, cdem_springs_format_find("inp"), in_scratch("g.inp"), 28, 1, &fault),
      CDEM_INPUT, "is not symmetric");
  assert_int_equal(access(in_scratch("g.inp"), F_OK), -1);
  hand_network_release(&hand);
}

static void cosserat_decks_are_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  hand_network hand;
  hand_network_init(&hand, "quad4-cosserat");
  check_fails(hand_write(&hand, cdem_springs_format_find("inp"), in_scratch("c.inp"), 6, 1, &fault),
              CDEM_INPUT, "CalculiX has no spring between a displacement and a rotation");
  hand_network_release(&hand);
}

static void tags_beyond_calculix_are_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  network n;
  network_init(&n, CDEM_SHAPE_QUAD4, cdem_material_isotropic(4e10, 0.3));
  n.mesh.node_tag[2] = INT64_C(3000000000);
  check_fails(write_network(&n, in_scratch("k.inp"), &fault), CDEM_INPUT,
              "node tag 3000000000 is not within 1 and 2147483647");
  network_release(&n);
}

/* Matrix from the deck's text: SPRING2 of stiffness k between a and b. No number may be longer
 * than the 20 columns CalculiX reads. */
static void read_deck(const network *n, const char *path, double *k) {
  char *text = read_whole(path, NULL), *rest = text;
  int dofs = n->model.dofs, component[2] = {0, 0};
  double stiffness = NAN;
  memset(k, 0, sizeof(double) * MOST * MOST);
  for (char *line; (line = strsep(&rest, "\n")) != NULL;) {
    assert_null(strstr(line, "SPRING1"));
    if (strncmp(line, "*SPRING", 7) == 0) {
      assert_int_equal(sscanf(strsep(&rest, "\n"), "%d,%d", &component[0], &component[1]), 2);
      char *number = strsep(&rest, "\n");
      assert_true(strlen(number) <= 20);
      stiffness = strtod(number, NULL);
    }
    if (strncmp(line, "*ELEMENT", 8) != 0)
      continue;
    while (*rest != '*' && *rest != '\0') {
      int node[2];
      assert_int_equal(sscanf(strsep(&rest, "\n"), "%*d,%d,%d", &node[0], &node[1]), 2);
      int a = (node[0] - 1) * dofs + component[0] - 1, b = (node[1] - 1) * dofs + component[1] - 1;
      k[a * n->rows + a] += stiffness;
      k[b * n->rows + b] += stiffness;
      k[a * n->rows + b] -= stiffness;
      k[b * n->rows + a] -= stiffness;
    }
  }
  free(text);
}

static void decks_hold_the_matrix(void **state) {
  (void)state;
  static const cdem_shape shapes[] = {CDEM_SHAPE_QUAD4, CDEM_SHAPE_HEX8};
  for (int s = 0; s < 2; s++) {
    cdem_fault fault = {0};
    network n;
    double k[MOST * MOST];
    network_init(&n, shapes[s], cdem_material_isotropic(4e10, 0.3));
    check_ok(write_network(&n, in_scratch("k.inp"), &fault));
    read_deck(&n, in_scratch("k.inp"), k);
    check_matrix(&n, k);
    network_release(&n);
  }
}

/* Displacements under unit loads with all nodes at x = 0 held, by a dense solver. */
static void solve(const network *n, const double *force, double *u) {
  double k[MOST * MOST];
  int dofs = n->model.dofs, pivot[MOST];
  memcpy(k, n->k, sizeof k);
  for (int i = 0; i < n->rows; i++) {
    u[i] = force[i];
    if (n->mesh.xyz[3 * (i / dofs)] != 0.0)
      continue;
    u[i] = 0.0;
    for (int j = 0; j < n->rows; j++)
      k[i * n->rows + j] = i == j;
  }
  assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, n->rows, 1, k, n->rows, pivot, u, 1), 0);
}

/* A job around the deck: hold x = 0, pull the last node; reads the displacements back. */
static bool run_calculix(const network *n, const double *force, double *u) {
  char job[4096], command[256];
  int dofs = n->model.dofs, used;
  used = snprintf(job, sizeof job, "*INCLUDE, INPUT=net.inp\n*BOUNDARY\n");
  for (int p = 0; p < n->mesh.nodes; p++)
    if (n->mesh.xyz[3 * p] == 0.0)
      used += snprintf(job + used, sizeof job - (size_t)used, "%d,1,%d\n", p + 1, dofs);
  used += snprintf(job + used, sizeof job - (size_t)used, "*STEP\n*STATIC\n*CLOAD\n");
  for (int i = 0; i < n->rows; i++)
    if (force[i] != 0.0)
      used += snprintf(job + used, sizeof job - (size_t)used, "%d,%d,%g\n", i / dofs + 1,
                       i % dofs + 1, force[i]);
  snprintf(job + used, sizeof job - (size_t)used, "*NODE PRINT, NSET=Nall\nU\n*END STEP\n");
  write_whole(in_scratch("job.inp"), job);
  snprintf(command, sizeof command, "cd '%s' && ccx -i job > ccx.log 2>&1", scratch);
  int result = system(command);
  if (WEXITSTATUS(result) == 127)
    return false;
  assert_int_equal(result, 0);
  char *text = read_whole(in_scratch("job.dat"), NULL), *line = strstr(text, "displacements");
  assert_non_null(line);
  line = strchr(line, '\n');
  for (int p = 0; p < n->mesh.nodes; p++) {
    double value[4];
    for (int c = 0; c < 4; c++)
      value[c] = strtod(line, &line);
    assert_true(value[0] == p + 1);
    for (int c = 0; c < dofs; c++)
      u[p * dofs + c] = value[1 + c];
  }
  free(text);
  return true;
}

/* CalculiX prints seven digits: half a unit of the last one of the largest displacement, and as
 * much of each. */
static void calculix_moves_springs_as_elements_move(void **state) {
  (void)state;
  static const cdem_shape shapes[] = {CDEM_SHAPE_QUAD4, CDEM_SHAPE_HEX8};
  for (int s = 0; s < 2; s++) {
    cdem_fault fault = {0};
    network n;
    double force[MOST] = {0}, expected[MOST], u[MOST], most = 0.0;
    network_init(&n, shapes[s], cdem_material_isotropic(4e10, 0.3));
    check_ok(write_network(&n, in_scratch("net.inp"), &fault));
    for (int c = 0; c < n.model.dofs; c++)
      force[n.rows - 1 - c] = 1e9 * (c + 1);
    solve(&n, force, expected);
    bool ran = run_calculix(&n, force, u);
    for (int i = 0; i < n.rows && ran; i++)
      most = fmax(most, fabs(expected[i]));
    for (int i = 0; i < n.rows && ran; i++)
      check_near(u[i], expected[i], 1e-6, 1e-6 * most);
    network_release(&n);
    if (!ran) {
      print_message("ccx is not installed: skipped\n");
      skip();
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(matrix_market_holds_the_matrix),
      cmocka_unit_test(unsymmetric_networks_are_general),
      cmocka_unit_test(cosserat_decks_are_refused),
      cmocka_unit_test(tags_beyond_calculix_are_refused),
      cmocka_unit_test(decks_hold_the_matrix),
      cmocka_unit_test(calculix_moves_springs_as_elements_move),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
