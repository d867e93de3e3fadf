/* The spring files of the program against a second derivation.
 *
 * Every case writes a mesh, runs `cdem springs`, rebuilds each S_ij from the rows of the file
 * alone, S = sum over rows of dir (x) (stiffness dual + coupling dual[couples_to]), and compares it
 * with -K_ij of a finite element that shares no line with the library (reference_element.c). The
 * CSV, the HDF5 and the Matrix Market file are read for every case. The vectors and labels of every
 * row are held to docs/formats.md on the way.
 *
 * usage: rebuild PROGRAM FOLDER
 */
#include "rebuild_case.h"
#include "rebuild_read.h"
#include "support/test.h"

#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { MAX_CASES = 48, MAX_PAIR_ROWS = 8, MAX_SPRINGS = 4 };

/* Command line, and what all cases met together. */
static const char *program, *folder;
static struct {
  int pairs, diagonal, jordan2, jordan3, complex, frame, further_rows;
  double worst_tensor, worst_inverse, worst_cond, worst_matrix;
} met;

static void note(double *worst, double value) {
  if (value > *worst)
    *worst = value;
}

/* The rows of one pair; rotations are in units of length, so that every entry has one unit. */
typedef struct pair_rows {
  const rebuild_row *row[MAX_PAIR_ROWS];
  int count, springs, width;
  const rebuild_row *first[MAX_SPRINGS]; /* the row of each spring that holds its stiffness */
  double p[MAX_SPRINGS][3], q[MAX_SPRINGS][3];
  double unit[3]; /* 1, or the length for a rotation */
  double s[3][3]; /* reference, scaled */
  double largest; /* entry of the element's stiffness, scaled */
  char where[160];
} pair_rows;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void gather(const rebuild_rows *rows, int64_t element, int64_t node_i, int64_t node_j,
                   const char *where, pair_rows *pair) {
  snprintf(pair->where, sizeof pair->where, "%s: element %lld, nodes %lld-%lld", where,
           (long long)element, (long long)node_i, (long long)node_j);
  pair->width = rows->width;
  pair->count = 0;
  for (int r = 0; r < rows->count; r++) {
    const rebuild_row *row = &rows->row[r];
    if (row->element != element || row->node_i != node_i || row->node_j != node_j)
      continue;
    if (pair->count == MAX_PAIR_ROWS)
      fail_msg("%s: more than %d rows", pair->where, MAX_PAIR_ROWS);
    pair->row[pair->count++] = row;
  }
  if (pair->count == 0)
    fail_msg("%s: no row", pair->where);
}

/* Springs 1 .. n, each with one row that holds the stiffness; a further row repeats dir and dual,
 * has stiffness 0 and a coupling of its own. */
static void sort_springs(pair_rows *pair) {
  memset(pair->first, 0, sizeof pair->first);
  pair->springs = 0;
  for (int r = 0; r < pair->count; r++) {
    const rebuild_row *row = pair->row[r];
    if (row->spring < 1 || row->spring > MAX_SPRINGS)
      fail_msg("%s: spring %d", pair->where, row->spring);
    const rebuild_row *first = pair->first[row->spring - 1];
    if (first == NULL) {
      pair->first[row->spring - 1] = row;
      pair->springs++;
      continue;
    }
    met.further_rows++;
    if (row->stiffness != 0 || row->couples_to == 0 || row->couples_to == first->couples_to ||
        memcmp(row->dir, first->dir, sizeof row->dir) != 0 ||
        memcmp(row->dual, first->dual, sizeof row->dual) != 0)
      fail_msg("%s: spring %d stands twice and the second row is no further coupling", pair->where,
               row->spring);
  }
  for (int s = 0; s < pair->springs; s++) {
    if (pair->first[s] == NULL)
      fail_msg("%s: %d springs, none is number %d", pair->where, pair->springs, s + 1);
    for (int c = 0; c < 3; c++) {
      pair->p[s][c] = pair->first[s]->dir[c] / pair->unit[c];
      pair->q[s][c] = pair->first[s]->dual[c] / pair->unit[c];
    }
  }
}

static void check_labels(const pair_rows *pair, const char *kind, const char *class) {
  for (int r = 0; r < pair->count; r++) {
    const rebuild_row *row = pair->row[r];
    bool same_cond =
        row->cond == pair->row[0]->cond || (isnan(row->cond) && isnan(pair->row[0]->cond));
    if (strcmp(row->kind, kind) != 0 || strcmp(row->class, class) != 0 ||
        strcmp(row->form, pair->row[0]->form) != 0 || !same_cond ||
        (isfinite(row->length) && row->length != pair->unit[2]))
      fail_msg("%s: %s, %s, %s, cond %g; expected %s, %s, and one form, cond and length",
               pair->where, row->kind, row->class, row->form, row->cond, kind, class);
    if (row->couples_to < 0 || row->couples_to > pair->springs || row->couples_to == row->spring)
      fail_msg("%s: spring %d couples to %d", pair->where, row->spring, row->couples_to);
  }
}

/* S from the rows alone. */
static void check_tensor(const pair_rows *pair) {
  double s[3][3] = {{0}};
  for (int r = 0; r < pair->count; r++) {
    const rebuild_row *row = pair->row[r];
    const double *p = pair->p[row->spring - 1], *q = pair->q[row->spring - 1];
    const double *other = row->couples_to > 0 ? pair->q[row->couples_to - 1] : q;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        s[a][b] += p[a] * (row->stiffness * q[b] + row->coupling * other[b]);
  }
  for (int a = 0; a < pair->width; a++)
    for (int b = 0; b < pair->width; b++) {
      double off = fabs(s[a][b] - pair->s[a][b]) / pair->largest;
      note(&met.worst_tensor, off);
      if (!(off <= 1e-11)) /* the promised 1e-12 and the rounding of two integrations */
        fail_msg("%s, %s: S[%d][%d] = %.17g from the rows, %.17g from the element, off by %.3g of "
                 "the element's largest entry %.6g",
                 pair->where, pair->row[0]->form, a, b, s[a][b], pair->s[a][b], off, pair->largest);
    }
}

/* Ratio of the singular values of the matrix with columns p, by one-sided Jacobi turns. */
static double condition(const pair_rows *pair) {
  double u[3][3], norm[3];
  int n = pair->springs;
  memcpy(u, pair->p, sizeof u);
  for (int sweep = 0; sweep < 30; sweep++)
    for (int i = 0; i < n; i++)
      for (int j = i + 1; j < n; j++) {
        double angle = 0.5 * atan2(2 * dot(u[i], u[j]), dot(u[i], u[i]) - dot(u[j], u[j]));
        for (int c = 0; c < 3; c++) {
          double x = u[i][c], y = u[j][c];
          u[i][c] = cos(angle) * x + sin(angle) * y;
          u[j][c] = cos(angle) * y - sin(angle) * x;
        }
      }
  double largest = 0, smallest = INFINITY;
  for (int i = 0; i < n; i++) {
    norm[i] = sqrt(dot(u[i], u[i]));
    largest = fmax(largest, norm[i]);
    smallest = fmin(smallest, norm[i]);
  }
  return largest / smallest;
}

/* dir of unit length; as many springs as components; dual the inverse of dir; cond that of dir. */
static void check_basis(const pair_rows *pair) {
  double cond = pair->row[0]->cond, own = condition(pair);
  if (pair->springs != pair->width)
    fail_msg("%s: %d springs of form %s", pair->where, pair->springs, pair->row[0]->form);
  for (int i = 0; i < pair->springs; i++)
    for (int j = 0; j < pair->springs; j++) {
      /* An inverse in double precision: a few units in the last place times cond. */
      double off = fabs(dot(pair->q[i], pair->p[j]) - (i == j));
      note(&met.worst_inverse, off / own);
      if (!(off <= 1e-14 * own))
        fail_msg("%s: dual %d . dir %d = %.17g, cond %g", pair->where, i + 1, j + 1,
                 dot(pair->q[i], pair->p[j]), own);
    }
  /* cond judges a basis: ten digits are more than that takes. */
  note(&met.worst_cond, fabs(cond / own - 1));
  if (!(fabs(cond / own - 1) <= 1e-10))
    fail_msg("%s: cond %.17g, but the directions have %.17g", pair->where, cond, own);
}

/* Discriminant of the characteristic polynomial over its own size: > 0 for real and different
 * values, < 0 for a complex pair. */
static double discriminant(const pair_rows *pair) {
  const double(*s)[3] = pair->s;
  double size = 0;
  for (int k = 0; k < 9; k++)
    size += s[k / 3][k % 3] * s[k / 3][k % 3];
  double trace = s[0][0] + s[1][1];
  double minor = s[0][0] * s[1][1] - s[0][1] * s[1][0];
  if (pair->width == 2)
    return (trace * trace - 4 * minor) / size;
  double b = -(trace + s[2][2]);
  double c = minor + s[0][0] * s[2][2] - s[0][2] * s[2][0] + s[1][1] * s[2][2] - s[1][2] * s[2][1];
  double d = -s[0][0] * (s[1][1] * s[2][2] - s[1][2] * s[2][1]) +
             s[0][1] * (s[1][0] * s[2][2] - s[1][2] * s[2][0]) -
             s[0][2] * (s[1][0] * s[2][1] - s[1][1] * s[2][0]);
  return (18 * b * c * d - 4 * b * b * b * d + b * b * c * c - 4 * c * c * c - 27 * d * d) /
         (size * size * size);
}

/* One spring along the diagonal and three at 120 degrees in the plane across it, dual = dir; the
 * first of the three along the projection of the global axis least aligned with the diagonal. */
static void check_frame(const pair_rows *pair) {
  const double(*p)[3] = pair->p, *d = p[0];
  if (pair->springs != 4 || pair->count != 4 || !isnan(pair->row[0]->cond))
    fail_msg("%s: a frame of %d springs, cond %g", pair->where, pair->springs, pair->row[0]->cond);
  int axis = 2;
  for (int c = 1; c >= 0; c--)
    if (fabs(d[c]) < fabs(d[axis]) - 1e-9)
      axis = c;
  for (int c = 0; c < 3; c++) {
    double across = ((c == axis) - d[axis] * d[c]) / sqrt(1 - d[axis] * d[axis]);
    double turned = -0.5 * across + sqrt(0.75) * (d[(c + 1) % 3] * p[1][(c + 2) % 3] -
                                                  d[(c + 2) % 3] * p[1][(c + 1) % 3]);
    /* Unit vectors from normalised sums: a few units in the last place. */
    if (!(fabs(p[1][c] - across) <= 1e-14) || !(fabs(p[2][c] - turned) <= 1e-14) ||
        !(fabs(p[1][c] + p[2][c] + p[3][c]) <= 1e-14))
      fail_msg("%s: the springs across the diagonal do not stand as they should", pair->where);
  }
  for (int s = 0; s < 4; s++)
    if (memcmp(pair->p[s], pair->q[s], sizeof pair->p[s]) != 0 || pair->first[s]->couples_to != 0 ||
        (s > 0 && pair->first[s]->stiffness != pair->first[1]->stiffness))
      fail_msg("%s: dual, coupling or stiffness of spring %d of a frame", pair->where, s + 1);
}

/* Couplings as the form names them, and the form as the eigenvalues want it where they are clear:
 * the program may change the form only close to a defect, and at 1e-6 there is none close. */
static void check_form(const pair_rows *pair) {
  const char *form = pair->row[0]->form;
  bool diagonal = strcmp(form, "diagonal") == 0, is_complex = strcmp(form, "complex") == 0;
  bool jordan2 = strcmp(form, "jordan2") == 0, jordan3 = strcmp(form, "jordan3") == 0;
  bool frame = strcmp(form, "frame") == 0;
  int couplings = 0;
  double back_and_forth = 0;
  for (int r = 0; r < pair->count; r++) {
    couplings += pair->row[r]->couples_to > 0;
    for (int t = 0; t < pair->count; t++)
      if (pair->row[r]->couples_to == pair->row[t]->spring &&
          pair->row[t]->couples_to == pair->row[r]->spring)
        back_and_forth = pair->row[r]->coupling * pair->row[t]->coupling;
  }
  met.diagonal += diagonal;
  met.complex += is_complex;
  met.jordan2 += jordan2;
  met.jordan3 += jordan3;
  met.frame += frame;
  bool right = (diagonal && couplings == 0) ||
               (is_complex && couplings >= 2 && back_and_forth < 0) ||
               (jordan2 && couplings >= 1 && back_and_forth == 0) ||
               (jordan3 && couplings >= 2 && back_and_forth == 0) || (frame && couplings == 0);
  double sign = discriminant(pair);
  if (!right || (sign > 1e-6 && !diagonal) || (sign < -1e-6 && !is_complex))
    fail_msg("%s: form %s with %d couplings, discriminant %g", pair->where, form, couplings, sign);
  if (frame)
    check_frame(pair);
  else
    check_basis(pair);
}

static void check_unit_directions(const pair_rows *pair) {
  for (int s = 0; s < pair->springs; s++) /* rounded once more by the division by length */
    if (!(fabs(sqrt(dot(pair->p[s], pair->p[s])) - 1) <= 1e-15 * 4))
      fail_msg("%s: dir %d has the length %.17g", pair->where, s + 1,
               sqrt(dot(pair->p[s], pair->p[s])));
}

/* Entries of a cell's stiffness, rotations in units of length. */
static double scaled_entry(const double *k, int dofs, int width, const double unit[3], int row,
                           int column) {
  return k[row * dofs + column] / (unit[row % width] * unit[column % width]);
}

/* Every pair of a cell; returns the number of its rows. */
static int check_cell(const rebuild_mesh *mesh, const rebuild_cell *cell,
                      const reference_material *material, const rebuild_rows *rows,
                      const char *where) {
  const reference_element *element = cell->element;
  double x[REFERENCE_MAX_NODES][3], k[REFERENCE_MAX_DOFS * REFERENCE_MAX_DOFS];
  for (int n = 0; n < element->nodes; n++)
    memcpy(x[n], mesh->x[cell->node[n]], sizeof x[n]);
  assert_true(reference_stiffness(element, x, material, k) > 0);
  int width = reference_dofs_of_node(element), dofs = width * element->nodes, used = 0;
  pair_rows pair = {.unit = {1, 1, element->cosserat ? rows->row[0].length : 1}};
  for (int e = 0; e < dofs * dofs; e++)
    note(&pair.largest, fabs(scaled_entry(k, dofs, width, pair.unit, e / dofs, e % dofs)));
  if (rows->width != width || rows->cosserat != element->cosserat || !(pair.unit[2] > 0))
    fail_msg("%s: %d components, length %g", where, rows->width, pair.unit[2]);
  for (int a = 0; a < element->nodes; a++)
    for (int b = a + 1; b < element->nodes; b++) {
      gather(rows, cell->tag, mesh->tag[cell->node[a]], mesh->tag[cell->node[b]], where, &pair);
      for (int e = 0; e < width * width; e++)
        pair.s[e / width][e % width] =
            -scaled_entry(k, dofs, width, pair.unit, a * width + e / width, b * width + e % width);
      sort_springs(&pair);
      check_labels(&pair, element->kind, reference_class(element, a, b));
      check_unit_directions(&pair);
      check_tensor(&pair);
      check_form(&pair);
      used += pair.count;
      met.pairs++;
    }
  return used;
}

static void check_rows(const rebuild_case *c, const rebuild_body *body, const rebuild_rows *rows,
                       const char *path) {
  int used = 0, cells = 0, frames = met.frame;
  assert_true(rows->count > 0);
  for (int k = 0; k < body->mesh.cells; k++)
    if (rebuild_cell_is_taken(c, &body->mesh, k)) {
      const rebuild_cell *cell = &body->mesh.cell[k];
      used += check_cell(&body->mesh, cell, &body->material[cell->group], rows, path);
      cells++;
    }
  if (c->length > 0 && rows->row[0].length != c->length)
    fail_msg("%s: length %.17g, asked for %.17g", path, rows->row[0].length, c->length);
  if (used != rows->count)
    fail_msg("%s: %d rows are of no pair in the element's order", path, rows->count - used);
  if (met.frame - frames != c->frames_per_cell * cells)
    fail_msg("%s: %d pairs of form frame, expected %d", path, met.frame - frames,
             c->frames_per_cell * cells);
}

/* Both files hold the same numbers: 17 digits give a double back. */
static void check_same(const rebuild_rows *csv, const rebuild_rows *hdf5) {
  assert_int_equal(csv->count, hdf5->count);
  for (int r = 0; r < csv->count; r++) {
    const rebuild_row *row = &csv->row[r], *other = NULL;
    for (int t = 0; t < hdf5->count && other == NULL; t++) {
      const rebuild_row *at = &hdf5->row[(r + t) % hdf5->count];
      if (at->element == row->element && at->node_i == row->node_i && at->node_j == row->node_j &&
          at->spring == row->spring && at->couples_to == row->couples_to)
        other = at;
    }
    assert_non_null(other);
    assert_true(row->stiffness == other->stiffness && row->coupling == other->coupling);
    assert_memory_equal(row->dir, other->dir, sizeof row->dir);
    assert_memory_equal(row->dual, other->dual, sizeof row->dual);
  }
}

static int place_of(const rebuild_matrix *matrix, int64_t tag) {
  for (int n = 0; n < matrix->nodes; n++)
    if (matrix->tag[n] == tag)
      return n;
  fail_msg("the matrix has no node %lld", (long long)tag);
  return -1;
}

static void assemble(const rebuild_mesh *mesh, const rebuild_cell *cell,
                     const reference_material *material, const rebuild_matrix *matrix,
                     double *own) {
  const reference_element *element = cell->element;
  double x[REFERENCE_MAX_NODES][3], k[REFERENCE_MAX_DOFS * REFERENCE_MAX_DOFS];
  int width = reference_dofs_of_node(element), dofs = width * element->nodes;
  int place[REFERENCE_MAX_NODES];
  for (int n = 0; n < element->nodes; n++) {
    memcpy(x[n], mesh->x[cell->node[n]], sizeof x[n]);
    place[n] = place_of(matrix, mesh->tag[cell->node[n]]);
  }
  reference_stiffness(element, x, material, k);
  for (int e = 0; e < dofs * dofs; e++) {
    int row = e / dofs, column = e % dofs;
    own[(place[row / width] * width + row % width) * matrix->size + place[column / width] * width +
        column % width] += k[e];
  }
}

/* The assembled network is the assembled finite-element matrix; diagonal blocks included. */
static void check_matrix(const rebuild_case *c, const rebuild_body *body, const char *path) {
  rebuild_matrix matrix;
  rebuild_read_mtx(path, &matrix);
  int width = reference_dofs_of_node(body->mesh.cell[0].element);
  assert_int_equal(matrix.size, matrix.nodes * width);
  size_t entries = (size_t)matrix.size * (size_t)matrix.size;
  double *own = calloc(entries, sizeof *own), largest = 0;
  assert_non_null(own);
  for (int k = 0; k < body->mesh.cells; k++)
    if (rebuild_cell_is_taken(c, &body->mesh, k)) {
      const rebuild_cell *cell = &body->mesh.cell[k];
      assemble(&body->mesh, cell, &body->material[cell->group], &matrix, own);
    }
  for (size_t e = 0; e < entries; e++)
    note(&largest, fabs(own[e]));
  for (size_t e = 0; e < entries; e++) {
    double off = fabs(own[e] - matrix.value[e]) / largest;
    note(&met.worst_matrix, off);
    if (!(off <= 1e-12)) /* sums of a few dozen products, each right to a few units */
      fail_msg("%s: entry %zu %zu is %.17g, expected %.17g, off by %.3g of the largest", path,
               e / (size_t)matrix.size + 1, e % (size_t)matrix.size + 1, matrix.value[e], own[e],
               off);
  }
  free(own);
  rebuild_matrix_release(&matrix);
}

enum { CSV, HDF5, MTX, MESH, LOG, PLAIN, PATHS };

static void name_files(const rebuild_case *c, char path[PATHS][512]) {
  static const char *const end[PATHS] = {"csv", "h5", "mtx", "msh", "log", "dat"};
  for (int k = 0; k < PATHS; k++)
    snprintf(path[k], 512, "%s/%s.%s", folder, c->name, end[k]);
}

/* Runs `cdem springs` on the case with the words of `output`, NULL at their end. */
static void run_program(const rebuild_body *body, char path[PATHS][512],
                        const char *const *output) {
  const char *argument[REBUILD_MAX_OPTIONS + 16] = {program, "springs", path[MESH]};
  int count = 3, status;
  for (int k = 0; k < body->options; k++)
    argument[count++] = body->option[k];
  for (; *output != NULL; output++)
    argument[count++] = *output;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, path[LOG], O_WRONLY | O_CREAT | O_TRUNC, 0666);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t child;
  assert_int_equal(posix_spawn(&child, program, &actions, NULL, (char *const *)argument, environ),
                   0);
  posix_spawn_file_actions_destroy(&actions);
  assert_int_equal(waitpid(child, &status, 0), child);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    fail_msg("status %d; see %s", status, path[LOG]);
}

static const char plane_kinds[] = "tri3 quad4 tri6 quad8 quad4 tri6 quad8 tri3";
static const char solid_kinds[] = "hex8 wedge6 pyr5 tet4 tet10 hex20 hex20 hex8";
static const char cosserat_kinds[] =
    "tri3-cosserat quad4-cosserat quad4-cosserat tri3-cosserat quad4-cosserat";

static void remove_outputs(char path[PATHS][512]) {
  unlink(path[CSV]);
  unlink(path[HDF5]);
  unlink(path[MTX]);
  unlink(path[PLAIN]);
}

static void run_case(void **state) {
  const rebuild_case *c = *state;
  rebuild_body body;
  rebuild_rows csv, hdf5;
  char path[PATHS][512];
  name_files(c, path);
  remove_outputs(path);
  rebuild_body_make(c, folder, &body);
  run_program(&body, path,
              (const char *[]){"-o", path[CSV], "-o", path[HDF5], "-o", path[MTX], NULL});
  rebuild_read_csv(path[CSV], &csv);
  rebuild_read_hdf5(path[HDF5], &hdf5);
  check_rows(c, &body, &csv, path[CSV]);
  check_rows(c, &body, &hdf5, path[HDF5]);
  check_same(&csv, &hdf5);
  check_matrix(c, &body, path[MTX]);
  rebuild_rows_release(&csv);
  rebuild_rows_release(&hdf5);
}

/* --format wins over the ending of the file. */
static void format_is_asked_for(void **state) {
  (void)state;
  const rebuild_case c = {.name = "format",
                          .kinds = solid_kinds,
                          .material = MATERIAL_BY_GROUP,
                          .poisson = 0.2,
                          .amount = 0.1};
  rebuild_body body;
  rebuild_rows rows;
  char path[PATHS][512];
  name_files(&c, path);
  remove_outputs(path);
  rebuild_body_make(&c, folder, &body);
  run_program(&body, path, (const char *[]){"-o", path[PLAIN], "--format", "h5", NULL});
  rebuild_read_hdf5(path[PLAIN], &rows);
  check_rows(&c, &body, &rows, path[PLAIN]);
  rebuild_rows_release(&rows);
}

/* The cases. */

static rebuild_case cases[MAX_CASES];
static int case_count;

static rebuild_case *add(const rebuild_case *c, const char *name) {
  assert_true(case_count < MAX_CASES);
  cases[case_count] = *c;
  snprintf(cases[case_count].name, sizeof cases[0].name, "%s", name);
  return &cases[case_count++];
}

static const char *const material_name[] = {"isotropic", "orthotropic",   "anisotropic",
                                            "cosserat",  "cosserat-file", "cosserat-cubic",
                                            "ratios",    "by-group"};

/* Every kind in one file, for the program takes longer to start than to convert it. */
static rebuild_case *add_mixed(const char *kinds, rebuild_material material, bool stress,
                               double poisson) {
  char name[64];
  rebuild_case c = {.kinds = kinds,
                    .material = material,
                    .plane_stress = stress,
                    .poisson = poisson,
                    .couple_factor = material == MATERIAL_COSSERAT_FILE ? 2 : 1,
                    .amount = 0.12};
  snprintf(name, sizeof name, "%s-%s%s%s", kinds == solid_kinds ? "solid" : "plane",
           material_name[material], stress ? "-stress" : "", poisson < 0 ? "-auxetic" : "");
  return add(&c, name);
}

static void add_distorted(void) {
  static const rebuild_material classical[] = {MATERIAL_ISOTROPIC, MATERIAL_ORTHOTROPIC,
                                               MATERIAL_ANISOTROPIC, MATERIAL_BY_GROUP};
  for (size_t m = 0; m < sizeof classical / sizeof *classical; m++) {
    add_mixed(solid_kinds, classical[m], false, 0.23);
    add_mixed(plane_kinds, classical[m], false, 0.23);
    add_mixed(plane_kinds, classical[m], true, 0.31);
  }
  add_mixed(solid_kinds, MATERIAL_ISOTROPIC, false, -0.4);
  add_mixed(plane_kinds, MATERIAL_ISOTROPIC, false, -0.4);
  add_mixed(cosserat_kinds, MATERIAL_COSSERAT, false, 0.23);
  add_mixed(cosserat_kinds, MATERIAL_COSSERAT, true, 0.31)->length = 0.7;
  add_mixed(cosserat_kinds, MATERIAL_COSSERAT_FILE, false, -0.2);
  add_mixed(cosserat_kinds, MATERIAL_COSSERAT_CUBIC, false, 0);
}

/* Cubes and squares: frames, double values and defects. The body pairs of a cube are isotropic
 * across the pair, at mu = 1/4 the face pairs too; of hex20 the four diagonals of corners are, by
 * their threefold axis. The edge pair of a cube is defective at 1/4 +- 5 sqrt(2)/32 and has a
 * double value at 1/4 + sqrt(3)/8; a square's edge pair in plane strain is defective at 0. */
static void add_regular(void) {
  static double cubes[9], squares[4] = {0, -1e-13, 1e-13, 0.3};
  const double defect = 0.25 + 5 * sqrt(2) / 32, touch = 0.25 + sqrt(3) / 8;
  const double ratio[9] = {0.25, -0.5,  defect,        defect - 1e-10, defect + 1e-10,
                           0.3,  touch, touch + 1e-11, 0.5 - defect};
  memcpy(cubes, ratio, sizeof cubes);
  rebuild_case list = {.kinds = "hex8 hex8 hex8 hex8 hex8 hex20 hex8 hex8 hex8",
                       .material = MATERIAL_RATIOS,
                       .ratio = cubes,
                       .frames_per_cell = 4};
  add(&list, "cubes");
  list.kinds = "quad4 quad4 quad4 quad4";
  list.ratio = squares;
  list.frames_per_cell = 0;
  add(&list, "squares");
  rebuild_case cube = {.kinds = "hex8", .poisson = 0.3, .frame = "none"};
  add(&cube, "cube-frame-none");
  cube.frame = "all";
  cube.poisson = 0.25;
  cube.frames_per_cell = 4 + 12;
  add(&cube, "cube-frame-all");
  rebuild_case group = {
      .kinds = solid_kinds, .material = MATERIAL_BY_GROUP, .amount = 0.1, .group = "soft layer"};
  add(&group, "one-group");
}

/* The cases above would say nothing of a form that none of them meets. */
static void every_form_was_met(void **state) {
  (void)state;
  print_message("%d pairs: %d diagonal, %d jordan2, %d jordan3, %d complex, %d frame; %d further "
                "rows\n",
                met.pairs, met.diagonal, met.jordan2, met.jordan3, met.complex, met.frame,
                met.further_rows);
  print_message(
      "worst: S %.2g, matrix %.2g of the largest entry; dual . dir %.2g cond; cond %.2g\n",
      met.worst_tensor, met.worst_matrix, met.worst_inverse, met.worst_cond);
  assert_true(met.diagonal > 0 && met.jordan2 > 0 && met.complex > 0 && met.frame > 0);
}

int main(int argc, char **argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: rebuild PROGRAM FOLDER\n");
    return 2;
  }
  program = argv[1];
  folder = argv[2];
  add_distorted();
  add_regular();
  struct CMUnitTest tests[MAX_CASES + 2] = {{0}};
  for (int k = 0; k < case_count; k++)
    tests[k] = (struct CMUnitTest){cases[k].name, run_case, NULL, NULL, &cases[k]};
  tests[case_count] = (struct CMUnitTest)cmocka_unit_test(format_is_asked_for);
  tests[case_count + 1] = (struct CMUnitTest)cmocka_unit_test(every_form_was_met);
  return cmocka_run_group_tests_name("cli.rebuild", tests, NULL, NULL);
}
