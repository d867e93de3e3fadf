/* Rigid motions that supports leave free.
 *
 * Each connected part has 3 (plane) or 6 rigid motions. The prescribed components of its nodes are
 * rows of a matrix C, one column a motion; motions in its null space are free. The Gram matrix C^T
 * C is small; its eigenvectors of eigenvalue zero are those motions. Turning is measured about the
 * part's centre and scaled by its size, so that all columns are alike.
 */
#include "base/mat3.h"
#include "base/sets.h"
#include "cdem/solver_store.h"

#include <lapacke.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  int32_t node; /* any node of the part */
  int32_t nodes;
  double low[3], high[3];
  double gram[36];
} part;

/* ---- connected parts ---- */

static void join_all(const cdem_solver *solver, const cdem_sparse *matrix, int64_t joins,
                     const int32_t (*joined)[2], int32_t *parent) {
  cdem_sets_init(parent, 0, solver->nodes);
  for (int32_t p = 0; p < matrix->nodes; p++)
    for (int64_t k = matrix->start[p]; k < matrix->start[p + 1]; k++)
      cdem_sets_join(parent, matrix->node[p], matrix->node[matrix->column[k]]);
  for (int64_t k = 0; k < joins; k++)
    cdem_sets_join(parent, joined[k][0], joined[k][1]);
  cdem_sets_label(parent, 0, solver->nodes);
}

/* ---- the rigid motions ---- */

/* Column values of component `c` at a node: translations, then rotations about the axes (plane:
 * about z). */
static void motion_row(const cdem_solver *solver, const part *p, int32_t node, int c,
                       double row[6]) {
  const double *xyz = solver->store->options.body->model->mesh->xyz + 3 * (size_t)node;
  int dim = solver->store->dimension;
  double size = 0.0, r[3];
  memset(row, 0, 6 * sizeof *row);
  for (int k = 0; k < 3; k++) {
    r[k] = xyz[k] - 0.5 * (p->low[k] + p->high[k]);
    size = fmax(size, p->high[k] - p->low[k]);
  }
  if (c >= dim) { /* rotation of a Cosserat node */
    row[2] = 1.0;
    return;
  }
  row[c] = 1.0;
  for (int a = 0; a < (dim == 3 ? 3 : 1); a++) {
    double axis[3] = {0}, turned[3];
    axis[dim == 3 ? a : 2] = 1.0;
    cdem_cross3(axis, r, turned);
    row[dim + a] = turned[c] / size;
  }
}

static void add_row(part *p, int motions, const double row[6]) {
  for (int i = 0; i < motions; i++)
    for (int j = 0; j < motions; j++)
      p->gram[motions * i + j] += row[i] * row[j];
}

/* ---- words ---- */

static void append(char *text, size_t size, const char *more) {
  size_t used = strlen(text);
  snprintf(text + used, size - used, "%s", more);
}

/* "move along x, z" or, where the directions are not those of the axes, their components. */
static void say(char *text, size_t size, const char *verb, double basis[3][3], int dimension) {
  bool axis[3];
  int named = 0;
  if (dimension == 0)
    return;
  for (int a = 0; a < 3; a++) {
    double inside = 0.0;
    for (int d = 0; d < dimension; d++)
      inside += basis[d][a] * basis[d][a];
    axis[a] = inside > 1.0 - 1e-6;
    named += axis[a];
  }
  append(text, size, text[0] != 0 ? " and " : "");
  append(text, size, verb);
  for (int a = 0, said = 0; a < 3; a++)
    if (axis[a] && named == dimension) {
      char word[8];
      snprintf(word, sizeof word, "%s %c", said++ > 0 ? "," : "", "xyz"[a]);
      append(text, size, word);
    }
  for (int d = 0; d < dimension && named != dimension; d++) {
    char word[80];
    snprintf(word, sizeof word, "%s (%.2f, %.2f, %.2f)", d > 0 ? "," : "", basis[d][0], basis[d][1],
             basis[d][2]);
    append(text, size, word);
  }
}

typedef struct {
  double move[3], turn[3];
} motion;

/* Takes from `m` (the free motions) those that turn, one after the other with the largest turn
 * first, each time clearing that direction of turning from the rest; what is left only moves. */
static void describe(motion m[6], int count, char *text, size_t size) {
  double turns[3][3], moves[3][3];
  int turn_count = 0, move_count = 0;
  for (int pass = 0; pass < 2; pass++)
    while ((pass == 0 ? turn_count : move_count) < 3) {
      double most = 1e-6;
      int best = -1;
      for (int i = 0; i < count; i++) {
        double length = cdem_norm3(pass == 0 ? m[i].turn : m[i].move);
        if (length > most) {
          most = length;
          best = i;
        }
      }
      if (best < 0)
        break;
      motion chosen = m[best];
      const double *from = pass == 0 ? chosen.turn : chosen.move;
      double *direction = pass == 0 ? turns[turn_count++] : moves[move_count++];
      for (int k = 0; k < 3; k++)
        direction[k] = from[k] / most;
      m[best] = m[--count];
      for (int i = 0; i < count; i++) {
        double share = cdem_dot3(pass == 0 ? m[i].turn : m[i].move, direction) / most;
        for (int k = 0; k < 3; k++) {
          m[i].move[k] -= share * chosen.move[k];
          m[i].turn[k] -= share * chosen.turn[k];
        }
      }
    }
  text[0] = 0;
  say(text, size, "move along", moves, move_count);
  say(text, size, "turn about", turns, turn_count);
}

/* Free motions of a part, in words; false when it has none. */
static bool free_motions(const part *p, int dim, char *text, size_t size) {
  int motions = dim == 3 ? 6 : 3, count = 0;
  double gram[36], value[6];
  motion m[6];
  memcpy(gram, p->gram, sizeof gram);
  if (LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', motions, gram, motions, value) != 0)
    return false;
  for (int k = 0; k < motions; k++) {
    if (value[k] > 1e-10 * fmax(value[motions - 1], 1e-300))
      continue;
    m[count] = (motion){0};
    for (int i = 0; i < dim; i++)
      m[count].move[i] = gram[motions * i + k];
    for (int i = dim; i < motions; i++)
      m[count].turn[dim == 3 ? i - 3 : 2] = gram[motions * i + k];
    count++;
  }
  if (count == 0)
    return false;
  describe(m, count, text, size);
  return true;
}

/* ---- all parts ---- */

static void measure_parts(const cdem_solver *solver, const cdem_sparse *matrix,
                          const int32_t *part_of, part *list) {
  const double *xyz = solver->store->options.body->model->mesh->xyz;
  for (int32_t q = 0; q < matrix->nodes; q++) {
    int32_t n = matrix->node[q];
    part *p = &list[part_of[n]];
    for (int k = 0; k < 3; k++) {
      double x = xyz[3 * (size_t)n + (size_t)k];
      p->low[k] = p->nodes == 0 ? x : fmin(p->low[k], x);
      p->high[k] = p->nodes == 0 ? x : fmax(p->high[k], x);
    }
    if (p->nodes++ == 0)
      p->node = n;
  }
  for (int32_t q = 0; q < matrix->nodes; q++) {
    int32_t n = matrix->node[q];
    for (int c = 0; c < solver->dofs; c++) {
      double row[6];
      if (!(solver->store->flag[n] >> c & 1))
        continue;
      motion_row(solver, &list[part_of[n]], n, c, row);
      add_row(&list[part_of[n]], solver->store->dimension == 3 ? 6 : 3, row);
    }
  }
}

static cdem_status report(const cdem_solver *solver, const part *p, int32_t parts,
                          const char *motions, cdem_fault *fault) {
  const cdem_solver_options *o = &solver->store->options;
  char name[96] = "the body";
  long long tag = (long long)o->body->model->mesh->node_tag[p->node];
  if (parts > 1 && o->blocks != NULL)
    snprintf(name, sizeof name, "block %d (with node %lld)", (int)o->blocks->node_block[p->node],
             tag);
  else if (parts > 1)
    snprintf(name, sizeof name, "the part with node %lld", tag);
  return cdem_fail(fault, CDEM_INPUT,
                   "%s can %s freely; a static solution needs supports that prevent it", name,
                   motions);
}

static cdem_status check_parts(const cdem_solver *solver, const cdem_sparse *matrix,
                               const int32_t *root, int32_t *part_of, cdem_fault *fault) {
  int32_t parts = 0;
  for (int32_t q = 0; q < matrix->nodes; q++) /* roots come before their members */
    part_of[matrix->node[q]] =
        root[matrix->node[q]] == matrix->node[q] ? parts++ : part_of[root[matrix->node[q]]];
  part *list;
  CDEM_NEW(list, parts, fault);
  measure_parts(solver, matrix, part_of, list);
  cdem_status status = CDEM_OK;
  for (int32_t p = 0; p < parts && status == CDEM_OK; p++) {
    char motions[256];
    if (free_motions(&list[p], solver->store->dimension, motions, sizeof motions))
      status = report(solver, &list[p], parts, motions, fault);
  }
  free(list);
  return status;
}

cdem_status cdem_static_check_supports(const cdem_solver *solver, const cdem_sparse *matrix,
                                       int64_t joins, const int32_t (*joined)[2],
                                       cdem_fault *fault) {
  int32_t *root = cdem_allocate(solver->nodes, sizeof *root, fault);
  int32_t *part_of = cdem_allocate(solver->nodes, sizeof *part_of, fault);
  cdem_status status = CDEM_MEMORY;
  if (root != NULL && part_of != NULL) {
    join_all(solver, matrix, joins, joined, root);
    status = check_parts(solver, matrix, root, part_of, fault);
  }
  free(root);
  free(part_of);
  return status;
}
