/* The one assembler: spring tensors of pairs -> sparse matrix of the network.
 *
 * K is stored by node blocks (block CSR). Position p of the matrix is mesh node `node[p]`; nodes of
 * no chosen cell do not appear. Degree of freedom a of node position p is row p * dofs + a.
 *
 * A pair i, j with spring tensor S adds (Cosserat: T the rigid transport, else the identity)
 *     K_ij -= S    K_ii += S T_ij    K_ji -= S^T    K_jj += S^T T_ji
 * so that f = -K u is the sum of F_i = S (u_j - T_ij u_i). S is rebuilt from the rows of the set,
 * not taken from the block: what is assembled is what is written.
 */
#ifndef CDEM_NETWORK_ASSEMBLE_H
#define CDEM_NETWORK_ASSEMBLE_H

#include "network/network.h"

typedef struct {
  int32_t nodes;
  int dofs;       /* per node */
  int32_t *node;  /* [nodes] mesh node ids, ascending */
  int64_t *start; /* [nodes + 1] offsets into column */
  int32_t
      *column; /* [start[nodes]] positions, ascending within a row; the diagonal is always there */
  double *value; /* [start[nodes]][dofs][dofs] row-major blocks, N/m (Cosserat: N, N m) */
} cdem_sparse;

/* The zero matrix with the pattern of the model. Zero-initialise; release at any stage. */
cdem_status cdem_sparse_init(const cdem_model *model, cdem_sparse *sparse, cdem_fault *fault);
void cdem_sparse_release(cdem_sparse *sparse);

/* Block (row, column) by positions, or NULL when the pattern has none. */
double *cdem_sparse_block(const cdem_sparse *sparse, int32_t row, int32_t column);

/* Position of a mesh node, -1 when it is not in the matrix. O(log nodes). */
int32_t cdem_sparse_position(const cdem_sparse *sparse, int32_t node);

/* y = K x; x, y [nodes * dofs], not aliased. Rows in parallel, bits independent of the threads. */
void cdem_sparse_multiply(const cdem_sparse *sparse, const double *x, double *y);

/* Largest |entry|. */
double cdem_sparse_largest(const cdem_sparse *sparse);

/* Frobenius norm of the skew part over that of the whole: |K - K^T| / (2 |K|). */
double cdem_sparse_skew(const cdem_sparse *sparse);

/* Sink that adds every pair it is fed to `sparse` (which must come from the pairs' model). */
cdem_pair_sink cdem_sparse_sink(cdem_sparse *sparse);

/* Adds `factor` times the stiffness of every cell by the reference B^T D B: the finite-element
 * matrix itself. */
cdem_status cdem_sparse_add_elements(const cdem_model *model, double factor, cdem_sparse *sparse,
                                     const cdem_progress *progress, cdem_fault *fault);

/* Divides rows and columns of Cosserat rotations by `length` (m), so that all entries are N/m;
 * other matrices are left alone. 1/length undoes it. */
void cdem_sparse_scale_rotations(const cdem_model *model, double length, cdem_sparse *sparse);

#endif
