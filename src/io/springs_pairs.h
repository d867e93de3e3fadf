/* Private to io: the assembled network as programs of particles see it, pair by pair.
 *
 * The tensor S of a pair, summed over all elements (S = -K_ij, the force on i is S (u_j - u_i)),
 * is split by the unit vector n from i to j, without a remainder:
 *
 *     S = along n n^T + across (I - n n^T) + other,
 *
 * where `across` is the mean over the directions across n, so that the three parts are orthogonal
 * in the Frobenius product. `other` holds what no force along and across a line can be: stiffness
 * that differs between the directions across, couplings of along and across, and the skew part.
 * Parts below rounding of the matrix are set to zero.
 */
#ifndef CDEM_IO_SPRINGS_PAIRS_H
#define CDEM_IO_SPRINGS_PAIRS_H

#include "io/springs_matrix.h"

#include <stdio.h>

typedef struct {
  int32_t position[2];            /* i < j, of the sparse matrix */
  double direction[3];            /* n; 2-D: n_z = 0 */
  double length;                  /* m */
  double along, across, other[9]; /* N/m; other row-major [dofs*dofs] */
  bool has_other;
} cdem_line_pair;

typedef struct {
  int64_t pairs, capacity;
  cdem_line_pair *pair; /* [pairs] those with any stiffness, by position */
  double shortest, longest;
  double stiffest; /* largest absolute row sum: bounds the eigenvalues of K, N/m */
} cdem_line_pairs;

/* Splits the matrix and drops what `carry` does not want. `loops`: the file can hold `other` too.
 * Fills matrix->writer.carried. CDEM_INPUT when everything is wanted (CDEM_CARRY_EXACT) and cannot
 * be had. Release at any stage. */
cdem_status cdem_line_pairs_init(cdem_matrix_writer *matrix, bool loops, cdem_line_pairs *pairs,
                                 cdem_fault *fault);
void cdem_line_pairs_release(cdem_line_pairs *pairs);

/* What the file is and what of the network is in it, a comment line each after '#'. */
void cdem_line_pairs_put_head(const cdem_matrix_writer *matrix, const char *program, FILE *stream);

/* Time step for particles of 1 kg: a tenth of the stability limit 2 / sqrt(stiffest). */
double cdem_line_pairs_step(const cdem_line_pairs *pairs);

#endif
