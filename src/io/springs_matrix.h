/* Private to io: writers of the assembled network. The pair sink is the assembler's; everything is
 * written at commit. */
#ifndef CDEM_IO_SPRINGS_MATRIX_H
#define CDEM_IO_SPRINGS_MATRIX_H

#include "io/springs.h"
#include "network/assemble.h"

/* Below this part of the largest entry a difference is rounding: a row of a hexahedral mesh sums
 * 8 elements with 8 nodes of blocks that are each right to 1e-12 of their norm. */
#define CDEM_MATRIX_ROUNDING 1e-11

typedef struct cdem_matrix_writer {
  cdem_springs_writer writer;
  const cdem_model *model;
  cdem_output *output;
  cdem_sparse sparse;
  cdem_status (*put)(struct cdem_matrix_writer *matrix, cdem_fault *fault);
} cdem_matrix_writer;

/* put: writes the assembled matrix to the output, at commit. */
cdem_status cdem_matrix_writer_open(const char *path, const cdem_model *model,
                                    cdem_status (*put)(cdem_matrix_writer *, cdem_fault *),
                                    cdem_springs_writer **writer, cdem_fault *fault);

/* CDEM_INPUT for a Cosserat network, which the program of this format cannot carry, and why. */
cdem_status cdem_matrix_refuse_cosserat(const char *path, const cdem_model *model, const char *why,
                                        cdem_fault *fault);

/* Symmetric up to CDEM_MATRIX_ROUNDING. */
bool cdem_matrix_is_symmetric(const cdem_sparse *sparse);

/* Are all node tags within 1 and INT32_MAX? CDEM_INPUT names the first that is not and `program`.
 */
cdem_status cdem_matrix_check_tags(const cdem_matrix_writer *matrix, const char *program,
                                   cdem_fault *fault);

#endif
