/* The assembled network matrix as Matrix Market, and the wrapper all writers of the
 * assembled network share. */
#include "base/version.h"
#include "io/output.h"
#include "io/springs_matrix.h"
#include "io/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* ---- shared with the other writers of the assembled network ---- */

static void destroy(cdem_springs_writer *writer) {
  cdem_matrix_writer *matrix = (cdem_matrix_writer *)writer;
  cdem_output_discard(&matrix->output);
  cdem_sparse_release(&matrix->sparse);
  free(matrix);
}

static cdem_status commit(cdem_springs_writer *writer, cdem_fault *fault) {
  cdem_matrix_writer *matrix = (cdem_matrix_writer *)writer;
  CDEM_TRY(matrix->put(matrix, fault));
  return cdem_output_commit(&matrix->output, fault);
}

cdem_status cdem_matrix_writer_open(const char *path, const cdem_model *model,
                                    cdem_status (*put)(cdem_matrix_writer *, cdem_fault *),
                                    cdem_springs_writer **writer, cdem_fault *fault) {
  cdem_matrix_writer *matrix;
  *writer = NULL;
  CDEM_NEW(matrix, 1, fault);
  matrix->model = model;
  matrix->put = put;
  cdem_status status = cdem_output_open(path, &matrix->output, fault);
  if (status == CDEM_OK)
    status = cdem_sparse_init(model, &matrix->sparse, fault);
  if (status != CDEM_OK) {
    destroy(&matrix->writer);
    return status;
  }
  matrix->writer = (cdem_springs_writer){
      .sink = cdem_sparse_sink(&matrix->sparse), .commit = commit, .destroy = destroy};
  *writer = &matrix->writer;
  return CDEM_OK;
}

cdem_status cdem_matrix_refuse_cosserat(const char *path, const cdem_model *model, const char *why,
                                        cdem_fault *fault) {
  if (!cdem_model_is_cosserat(model))
    return CDEM_OK;
  return cdem_fail(fault, CDEM_INPUT, "cannot write '%s': %s; write .csv, .h5 or .mtx instead",
                   path, why);
}

bool cdem_matrix_is_symmetric(const cdem_sparse *sparse) {
  int dofs = sparse->dofs;
  double bound = CDEM_MATRIX_ROUNDING * cdem_sparse_largest(sparse);
  for (int32_t p = 0; p < sparse->nodes; p++)
    for (int64_t k = sparse->start[p]; k < sparse->start[p + 1]; k++) {
      const double *block = sparse->value + k * dofs * dofs;
      const double *other = cdem_sparse_block(sparse, sparse->column[k], p);
      for (int a = 0; a < dofs; a++)
        for (int b = 0; b < dofs; b++)
          if (other == NULL || !(fabs(block[a * dofs + b] - other[b * dofs + a]) <= bound))
            return false;
    }
  return true;
}

cdem_status cdem_matrix_check_tags(const cdem_matrix_writer *matrix, const char *program,
                                   cdem_fault *fault) {
  for (int32_t p = 0; p < matrix->sparse.nodes; p++) {
    int64_t tag = matrix->model->mesh->node_tag[matrix->sparse.node[p]];
    CDEM_REQUIRE(tag >= 1 && tag <= INT32_MAX, fault, CDEM_INPUT,
                 "cannot write '%s': node tag %" PRId64
                 " is not within 1 and %d, as %s needs; renumber the mesh",
                 cdem_output_name(matrix->output), tag, INT32_MAX, program);
  }
  return CDEM_OK;
}

/* ---- Matrix Market ---- */

/* Comments: where the numbers come from and which row is which degree of freedom. */
static void put_comments(const cdem_matrix_writer *matrix, FILE *stream) {
  const cdem_sparse *sparse = &matrix->sparse;
  const cdem_mesh *mesh = matrix->model->mesh;
  const char *components = sparse->dofs == 2 ? "ux, uy" : "ux, uy, uz";
  if (cdem_model_is_cosserat(matrix->model))
    components = "ux, uy, rotation";
  fprintf(stream, "%% stiffness matrix of the spring network of %s, by cdem %s\n",
          mesh->source != NULL ? mesh->source : "a generated mesh", cdem_version());
  fprintf(stream, "%% f = K u; N/m (rotations: N and N m)\n");
  fprintf(stream, "%% row %d*(p - 1) + c is component c of the p-th node below, c = 1..%d for %s\n",
          sparse->dofs, sparse->dofs, components);
  fprintf(stream, "%% nodes %" PRId32 ", their tags in order:\n", sparse->nodes);
  for (int32_t p = 0; p < sparse->nodes; p++)
    fprintf(stream, "%s%" PRId64 "%s", p % 10 == 0 ? "% " : " ", mesh->node_tag[sparse->node[p]],
            p % 10 == 9 || p == sparse->nodes - 1 ? "\n" : "");
}

/* Is entry (a, b) of block (p, q) written? Zeros are not, nor the upper triangle of a symmetric
 * matrix. */
static bool is_written(bool symmetric, int64_t row, int64_t column, double value) {
  return value != 0.0 && (!symmetric || row >= column);
}

static cdem_status put_entries(const cdem_matrix_writer *matrix, bool symmetric, int64_t *entries,
                               cdem_output *output, cdem_fault *fault) {
  const cdem_sparse *sparse = &matrix->sparse;
  int dofs = sparse->dofs;
  *entries = 0;
  for (int32_t p = 0; p < sparse->nodes; p++)
    for (int a = 0; a < dofs; a++)
      for (int64_t k = sparse->start[p]; k < sparse->start[p + 1]; k++)
        for (int b = 0; b < dofs; b++) {
          double value = sparse->value[(k * dofs + a) * dofs + b];
          int64_t row = (int64_t)p * dofs + a, column = (int64_t)sparse->column[k] * dofs + b;
          if (!is_written(symmetric, row, column, value))
            continue;
          ++*entries;
          if (output == NULL)
            continue;
          char line[2 * CDEM_INTEGER_WIDTH + CDEM_REAL_WIDTH + 4], *at = line;
          at = cdem_put_integer(at, row + 1);
          *at++ = ' ';
          at = cdem_put_integer(at, column + 1);
          *at++ = ' ';
          at = cdem_put_real(at, value);
          *at++ = '\n';
          CDEM_TRY(cdem_output_write(output, line, (size_t)(at - line), fault));
        }
  return CDEM_OK;
}

static cdem_status put_mtx(cdem_matrix_writer *matrix, cdem_fault *fault) {
  FILE *stream = cdem_output_stream(matrix->output);
  bool symmetric = cdem_matrix_is_symmetric(&matrix->sparse);
  int64_t rows = (int64_t)matrix->sparse.nodes * matrix->sparse.dofs, entries;
  fprintf(stream, "%%%%MatrixMarket matrix coordinate real %s\n",
          symmetric ? "symmetric" : "general");
  put_comments(matrix, stream);
  CDEM_TRY(put_entries(matrix, symmetric, &entries, NULL, fault));
  fprintf(stream, "%" PRId64 " %" PRId64 " %" PRId64 "\n", rows, rows, entries);
  return put_entries(matrix, symmetric, &entries, matrix->output, fault);
}

static cdem_status open_mtx(const char *path, const cdem_model *model, cdem_springs_writer **writer,
                            cdem_fault *fault) {
  return cdem_matrix_writer_open(path, model, put_mtx, writer, fault);
}

const cdem_springs_format cdem_springs_mtx = {
    "mtx", ".mtx", "Matrix Market file of the assembled network", open_mtx, true};
