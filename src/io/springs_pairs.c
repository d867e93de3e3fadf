#include "io/springs_pairs.h"

#include "base/version.h"
#include "io/output.h"
#include "io/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static double norm(const double *tensor, int dofs) {
  double sum = 0.0;
  for (int e = 0; e < dofs * dofs; e++)
    sum += tensor[e] * tensor[e];
  return sqrt(sum);
}

/* The line of the pair from the places of its nodes. */
static void set_line(const cdem_matrix_writer *matrix, cdem_line_pair *pair) {
  const double *xyz = matrix->model->mesh->xyz;
  const double *from = xyz + 3 * (int64_t)matrix->sparse.node[pair->position[0]];
  const double *to = xyz + 3 * (int64_t)matrix->sparse.node[pair->position[1]];
  double sum = 0.0;
  for (int c = 0; c < matrix->sparse.dofs; c++) {
    pair->direction[c] = to[c] - from[c];
    sum += pair->direction[c] * pair->direction[c];
  }
  pair->length = sqrt(sum);
  for (int c = 0; c < matrix->sparse.dofs && pair->length > 0.0; c++)
    pair->direction[c] /= pair->length;
}

/* The parts of S = -block; what is below `rounding` is zero. Two nodes at one place have no line:
 * there `along` equals `across`. */
static void split(const double *block, int dofs, double rounding, cdem_line_pair *pair) {
  const double *n = pair->direction;
  double along = 0.0, trace = 0.0;
  for (int a = 0; a < dofs; a++) {
    trace -= block[a * dofs + a];
    for (int b = 0; b < dofs; b++)
      along -= n[a] * block[a * dofs + b] * n[b];
  }
  pair->across = pair->length > 0.0 ? (trace - along) / (dofs - 1) : trace / dofs;
  pair->along = pair->length > 0.0 ? along : pair->across;
  if (fabs(pair->across) <= rounding)
    pair->across = 0.0;
  if (fabs(pair->along) <= rounding)
    pair->along = 0.0;
  for (int a = 0; a < dofs; a++)
    for (int b = 0; b < dofs; b++)
      pair->other[a * dofs + b] = -block[a * dofs + b] - (a == b ? pair->across : 0.0) -
                                  (pair->along - pair->across) * n[a] * n[b];
  pair->has_other = norm(pair->other, dofs) > rounding;
}

/* Norm of the part of the pair that is left out. */
static double cut(cdem_line_pair *pair, int dofs, cdem_carry carry, bool loops) {
  double other = pair->has_other ? norm(pair->other, dofs) : 0.0, across = 0.0;
  if (carry == CDEM_CARRY_CENTRAL) {
    across = sqrt(dofs - 1.0) * fabs(pair->across);
    pair->across = 0.0;
  } else if (loops) {
    return 0.0;
  }
  pair->has_other = false;
  return sqrt(other * other + across * across);
}

/* One pair into the list and the account; the sums of squares of what is lost and of all. */
static cdem_status add(cdem_matrix_writer *matrix, bool loops, cdem_line_pair pair,
                       cdem_line_pairs *pairs, double square[2], cdem_fault *fault) {
  cdem_carried *carried = &matrix->writer.carried;
  int dofs = matrix->sparse.dofs;
  const double *block = cdem_sparse_block(&matrix->sparse, pair.position[0], pair.position[1]);
  double whole = norm(block, dofs);
  carried->pairs++;
  carried->along += !pair.has_other && pair.across == 0.0;
  carried->across += !pair.has_other && pair.across != 0.0;
  carried->other += pair.has_other;
  double lost = cut(&pair, dofs, matrix->writer.carry, loops);
  carried->looped += pair.has_other;
  carried->cut += lost > 0.0;
  square[0] += lost * lost;
  square[1] += whole * whole;
  if (lost > carried->worst * whole) {
    carried->worst = lost / whole;
    for (int i = 0; i < 2; i++)
      carried->worst_node[i] = matrix->model->mesh->node_tag[matrix->sparse.node[pair.position[i]]];
  }
  pairs->shortest = pairs->pairs == 0 ? pair.length : fmin(pairs->shortest, pair.length);
  pairs->longest = fmax(pairs->longest, pair.length);
  CDEM_TRY(cdem_grow(&pairs->pair, &pairs->capacity, pairs->pairs + 1, sizeof pair, fault));
  pairs->pair[pairs->pairs++] = pair;
  return CDEM_OK;
}

static void add_row_sums(const cdem_sparse *sparse, int32_t p, double *stiffest) {
  int dofs = sparse->dofs;
  for (int a = 0; a < dofs; a++) {
    double sum = 0.0;
    for (int64_t k = sparse->start[p]; k < sparse->start[p + 1]; k++)
      for (int b = 0; b < dofs; b++)
        sum += fabs(sparse->value[(k * dofs + a) * dofs + b]);
    *stiffest = fmax(*stiffest, sum);
  }
}

cdem_status cdem_line_pairs_init(cdem_matrix_writer *matrix, bool loops, cdem_line_pairs *pairs,
                                 cdem_fault *fault) {
  const cdem_sparse *sparse = &matrix->sparse;
  cdem_carried *carried = &matrix->writer.carried;
  double rounding = CDEM_MATRIX_ROUNDING * cdem_sparse_largest(sparse), square[2] = {0};
  for (int32_t p = 0; p < sparse->nodes; p++) {
    add_row_sums(sparse, p, &pairs->stiffest);
    for (int64_t k = sparse->start[p]; k < sparse->start[p + 1]; k++) {
      const double *block = sparse->value + k * sparse->dofs * sparse->dofs;
      if (sparse->column[k] <= p || norm(block, sparse->dofs) <= rounding)
        continue;
      cdem_line_pair pair = {.position = {p, sparse->column[k]}};
      set_line(matrix, &pair);
      split(block, sparse->dofs, rounding, &pair);
      CDEM_TRY(add(matrix, loops, pair, pairs, square, fault));
    }
  }
  carried->lost = square[1] > 0.0 ? sqrt(square[0] / square[1]) : 0.0;
  CDEM_REQUIRE(matrix->writer.carry != CDEM_CARRY_EXACT || carried->cut == 0, fault, CDEM_INPUT,
               "cannot write '%s': %" PRId64 " of %" PRId64
               " pairs are more than springs along and across their lines (%.3g of the network's "
               "norm; pair %" PRId64 "-%" PRId64
               ": %.3g of its own); write .mtx, or leave that part out with --carry all",
               cdem_output_name(matrix->output), carried->cut, carried->pairs, carried->lost,
               carried->worst_node[0], carried->worst_node[1], carried->worst);
  return CDEM_OK;
}

void cdem_line_pairs_release(cdem_line_pairs *pairs) {
  free(pairs->pair);
  *pairs = (cdem_line_pairs){0};
}

void cdem_line_pairs_put_head(const cdem_matrix_writer *matrix, const char *program, FILE *stream) {
  const cdem_carried *c = &matrix->writer.carried;
  const char *source = matrix->model->mesh->source;
  fprintf(stream, "# spring network of %s for %s, by cdem %s\n",
          source != NULL ? source : "a generated mesh", program, cdem_version());
  fprintf(stream,
          "# SI units; a pair is the sum over all elements. Of %" PRId64 " pairs\n"
          "#   %" PRId64 " are a spring along their line and nothing else,\n"
          "#   %" PRId64 " are that and one stiffness across it,\n"
          "#   %" PRId64 " hold more: stiffness that differs across, couplings, a skew part.\n",
          c->pairs, c->along, c->across, c->other);
  if (c->cut == 0) {
    fputs("# Everything is here.\n", stream);
    return;
  }
  fprintf(stream, "# NOT here: a part of %" PRId64 " pairs", c->cut);
  cdem_stream_real(stream, ", ", c->lost, " of the network's norm.\n");
  fprintf(stream, "# Pair %" PRId64 "-%" PRId64 " loses most", c->worst_node[0], c->worst_node[1]);
  cdem_stream_real(stream, ", ", c->worst, " of its own norm.\n");
}

double cdem_line_pairs_step(const cdem_line_pairs *pairs) {
  return pairs->stiffest > 0.0 ? 0.2 / sqrt(pairs->stiffest) : 1.0;
}
