#include "network/spectrum.h"

#include <arpack.h>
#include <cholmod.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DENSE_ROWS = 300, ARNOLDI_VECTORS = 24, MAX_ITERATIONS = 3000 };

struct cdem_spectrum {
  cholmod_common common;
  cholmod_sparse *matrix; /* lower triangle of the symmetric part */
  cholmod_factor *symbolic;
  double norm;
};

/* Entry (a, b) of the symmetric part of block k; mirror: the block across the diagonal. */
static double symmetric_entry(const cdem_sparse *sparse, int64_t k, const double *mirror, int a,
                              int b) {
  int dofs = sparse->dofs;
  return (sparse->value[k * dofs * dofs + a * dofs + b] + mirror[b * dofs + a]) / 2.0;
}

/* weight [rows]: 1, or 1/sqrt |diagonal| (1 where that is zero). */
static void choose_weights(const cdem_sparse *sparse, bool balanced, double *weight) {
  int dofs = sparse->dofs;
  for (int32_t n = 0; n < sparse->nodes; n++) {
    const double *block = cdem_sparse_block(sparse, n, n);
    for (int a = 0; a < dofs; a++) {
      double diagonal = balanced ? fabs(block[a * dofs + a]) : 1.0;
      weight[n * dofs + a] = diagonal > 0.0 ? 1.0 / sqrt(diagonal) : 1.0;
    }
  }
}

/* Columns of the lower triangle; by symmetry column j is row j from the diagonal on. Returns the
 * norm. */
static double fill_matrix(const cdem_sparse *sparse, const double *weight, cholmod_sparse *matrix) {
  int dofs = sparse->dofs;
  int *start = matrix->p, *row = matrix->i, used = 0;
  double *value = matrix->x, norm = 0.0;
  for (int32_t n = 0; n < sparse->nodes; n++)
    for (int a = 0; a < dofs; a++) {
      int column = n * dofs + a;
      double sum = 0.0;
      start[column] = used;
      for (int64_t k = sparse->start[n]; k < sparse->start[n + 1]; k++) {
        const double *mirror = cdem_sparse_block(sparse, sparse->column[k], n);
        for (int b = 0; b < dofs; b++) {
          int other = sparse->column[k] * dofs + b;
          double entry = symmetric_entry(sparse, k, mirror, a, b) * weight[column] * weight[other];
          sum += fabs(entry);
          if (other < column)
            continue;
          row[used] = other;
          value[used++] = entry;
        }
      }
      norm = fmax(norm, sum);
    }
  start[sparse->nodes * dofs] = used;
  return norm;
}

static cdem_status cholmod_failure(cdem_fault *fault) {
  return cdem_fail(fault, CDEM_MEMORY, "out of memory in the sparse factorisation");
}

cdem_status cdem_spectrum_create(const cdem_sparse *sparse, bool balanced, cdem_spectrum **spectrum,
                                 cdem_fault *fault) {
  *spectrum = NULL;
  int64_t rows = (int64_t)sparse->nodes * sparse->dofs;
  int64_t entries = (sparse->start[sparse->nodes] * sparse->dofs * sparse->dofs + rows) / 2;
  CDEM_REQUIRE(rows > 0 && entries < INT32_MAX, fault, CDEM_NUMERIC,
               "the matrix has %lld entries; the sparse eigenvalue methods take up to 2147483647",
               (long long)entries);
  cdem_spectrum *made;
  CDEM_NEW(made, 1, fault);
  cholmod_start(&made->common);
  made->common.print = 0;
  made->common.supernodal = CHOLMOD_SIMPLICIAL;
  made->common.final_ll = 0;
  double *weight = cdem_allocate(rows, sizeof *weight, fault);
  made->matrix = cholmod_allocate_sparse((size_t)rows, (size_t)rows, (size_t)entries, 1, 1, -1,
                                         CHOLMOD_REAL, &made->common);
  cdem_status status = CDEM_OK;
  if (weight == NULL || made->matrix == NULL) {
    status = cholmod_failure(fault);
  } else {
    choose_weights(sparse, balanced, weight);
    made->norm = fill_matrix(sparse, weight, made->matrix);
    made->symbolic = cholmod_analyze(made->matrix, &made->common);
    if (made->symbolic == NULL)
      status = cholmod_failure(fault);
  }
  free(weight);
  if (status != CDEM_OK)
    cdem_spectrum_destroy(&made);
  *spectrum = made;
  return status;
}

void cdem_spectrum_destroy(cdem_spectrum **spectrum) {
  if (*spectrum == NULL)
    return;
  cdem_spectrum *s = *spectrum;
  cholmod_free_sparse(&s->matrix, &s->common);
  cholmod_free_factor(&s->symbolic, &s->common);
  cholmod_finish(&s->common);
  free(s);
  *spectrum = NULL;
}

double cdem_spectrum_norm(const cdem_spectrum *spectrum) {
  return spectrum->norm;
}

double cdem_spectrum_width(const cdem_spectrum *spectrum) {
  return 1e-14 * sqrt((double)spectrum->matrix->nrow) * spectrum->norm;
}

cdem_status cdem_spectrum_count(cdem_spectrum *spectrum, const cdem_progress *progress,
                                int64_t *negative, int64_t *zero, cdem_fault *fault) {
  double width = cdem_spectrum_width(spectrum);
  int64_t below = 0, above = (int64_t)spectrum->matrix->nrow;
  if (spectrum->norm > 0.0) { /* else all are zero */
    CDEM_TRY(cdem_progress_report(progress, "counting modes", 0, 2, fault));
    CDEM_TRY(cdem_spectrum_below(spectrum, -width, &below, fault));
    CDEM_TRY(cdem_progress_report(progress, "counting modes", 1, 2, fault));
    CDEM_TRY(cdem_spectrum_below(spectrum, width, &above, fault));
  }
  *negative = below;
  *zero = above - below;
  return CDEM_OK;
}

/* K - shift I = L D L^T in a new factor. */
static cdem_status factorise(cdem_spectrum *spectrum, double shift, cholmod_factor **factor,
                             cdem_fault *fault) {
  *factor = cholmod_copy_factor(spectrum->symbolic, &spectrum->common);
  if (*factor == NULL)
    return cholmod_failure(fault);
  double beta[2] = {-shift, 0.0};
  cholmod_factorize_p(spectrum->matrix, beta, NULL, 0, *factor, &spectrum->common);
  int outcome = spectrum->common.status;
  if (outcome >= 0 && (*factor)->minor == (*factor)->n && (*factor)->xtype == CHOLMOD_REAL)
    return CDEM_OK;
  cholmod_free_factor(factor, &spectrum->common);
  if (outcome == CHOLMOD_OUT_OF_MEMORY || outcome == CHOLMOD_TOO_LARGE)
    return cholmod_failure(fault);
  return cdem_fail(fault, CDEM_NUMERIC,
                   "the factorisation of the matrix shifted by %g N/m met a zero pivot", shift);
}

cdem_status cdem_spectrum_below(cdem_spectrum *spectrum, double shift, int64_t *count,
                                cdem_fault *fault) {
  cholmod_factor *factor;
  CDEM_TRY(factorise(spectrum, shift, &factor, fault));
  const int *start = factor->p;
  const double *value = factor->x;
  *count = 0;
  for (size_t j = 0; j < factor->n; j++)
    *count += value[start[j]] < 0.0;
  cholmod_free_factor(&factor, &spectrum->common);
  return CDEM_OK;
}

static cdem_status lowest_dense(const cdem_spectrum *spectrum, int wanted, double *value,
                                cdem_fault *fault) {
  int rows = (int)spectrum->matrix->nrow;
  const int *start = spectrum->matrix->p, *row = spectrum->matrix->i;
  const double *entry = spectrum->matrix->x;
  double *full = cdem_allocate((int64_t)rows * rows, sizeof *full, fault);
  double *all = cdem_allocate(rows, sizeof *all, fault);
  cdem_status status = full != NULL && all != NULL ? CDEM_OK : CDEM_MEMORY;
  if (status == CDEM_OK) {
    for (int j = 0; j < rows; j++)
      for (int k = start[j]; k < start[j + 1]; k++)
        full[(int64_t)j * rows + row[k]] = entry[k];
    if (LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', rows, full, rows, all) != 0)
      status = cdem_fail(fault, CDEM_NUMERIC, "the dense eigenvalue solver did not converge");
    else
      memcpy(value, all, (size_t)wanted * sizeof *value);
  }
  free(full);
  free(all);
  return status;
}

/* A shift below all eigenvalues but not far: the smallest power of ten (from 1e-8) times the norm
 * that does. */
static cdem_status shift_below_all(cdem_spectrum *spectrum, double *shift, cholmod_factor **factor,
                                   cdem_fault *fault) {
  *factor = NULL;
  for (*shift = -1e-8 * spectrum->norm; *shift > -20.0 * spectrum->norm; *shift *= 10.0) {
    int64_t below = 1;
    if (cdem_spectrum_below(spectrum, *shift, &below, NULL) == CDEM_OK && below == 0)
      return factorise(spectrum, *shift, factor, fault);
  }
  return cdem_fail(
      fault, CDEM_NUMERIC,
      "no shift below the spectrum was found; the matrix holds values that are not finite");
}

/* Work arrays of ARPACK's reverse communication. */
typedef struct {
  int rows, vectors;
  double *resid, *v, *workd, *workl;
  a_int parameter[11], pointer[14];
} lanczos;

static void lanczos_release(lanczos *l) {
  free(l->resid);
  free(l->v);
  free(l->workd);
  free(l->workl);
}

static cdem_status lanczos_init(lanczos *l, cdem_fault *fault) {
  int64_t rows = l->rows, vectors = l->vectors;
  CDEM_NEW(l->resid, rows, fault);
  CDEM_NEW(l->v, rows * vectors, fault);
  CDEM_NEW(l->workd, 3 * rows, fault);
  CDEM_NEW(l->workl, vectors * (vectors + 8), fault);
  l->parameter[0] = 1; /* exact shifts */
  l->parameter[2] = MAX_ITERATIONS;
  l->parameter[6] = 3; /* shift-invert */
  cdem_random random = {1};
  for (int64_t i = 0; i < rows; i++)
    l->resid[i] = cdem_random_uniform(&random, -1.0, 1.0);
  return CDEM_OK;
}

/* y = (K - shift I)^-1 x */
static bool apply_inverse(cdem_spectrum *spectrum, cholmod_factor *factor, const double *x,
                          double *y) {
  size_t rows = factor->n;
  cholmod_dense right = {
      .nrow = rows, .ncol = 1, .nzmax = rows, .d = rows, .x = (void *)x, .xtype = CHOLMOD_REAL};
  cholmod_dense *solution = cholmod_solve(CHOLMOD_A, factor, &right, &spectrum->common);
  if (solution == NULL)
    return false;
  memcpy(y, solution->x, rows * sizeof *y);
  cholmod_free_dense(&solution, &spectrum->common);
  return true;
}

static cdem_status iterate(cdem_spectrum *spectrum, cholmod_factor *factor, double shift,
                           int wanted, lanczos *l, double *value, cdem_fault *fault) {
  a_int ido = 0, info = 1; /* info 1: resid holds the start vector, so that runs repeat */
  a_int lworkl = l->vectors * (l->vectors + 8);
  for (;;) {
    dsaupd_c(&ido, "I", l->rows, "LM", wanted, 0.0, l->resid, l->vectors, l->v, l->rows,
             l->parameter, l->pointer, l->workd, l->workl, lworkl, &info);
    if (ido != -1 && ido != 1)
      break;
    if (!apply_inverse(spectrum, factor, l->workd + l->pointer[0] - 1,
                       l->workd + l->pointer[1] - 1))
      return cholmod_failure(fault);
  }
  a_int select[ARNOLDI_VECTORS * 4] = {0};
  if (info == 0)
    dseupd_c(0, "A", select, value, l->v, l->rows, shift, "I", l->rows, "LM", wanted, 0.0, l->resid,
             l->vectors, l->v, l->rows, l->parameter, l->pointer, l->workd, l->workl, lworkl,
             &info);
  CDEM_REQUIRE(info == 0, fault, CDEM_NUMERIC,
               "the Lanczos iteration for the lowest eigenvalues did not converge (%d)", (int)info);
  return CDEM_OK;
}

static int ascending(const void *left, const void *right) {
  double a = *(const double *)left, b = *(const double *)right;
  return (a > b) - (a < b);
}

cdem_status cdem_spectrum_lowest(cdem_spectrum *spectrum, int wanted, double *value,
                                 cdem_fault *fault) {
  int rows = (int)spectrum->matrix->nrow;
  if (rows <= DENSE_ROWS)
    return lowest_dense(spectrum, wanted, value, fault);
  double shift;
  cholmod_factor *factor = NULL;
  CDEM_TRY(shift_below_all(spectrum, &shift, &factor, fault));
  lanczos l = {.rows = rows, .vectors = 2 * wanted + ARNOLDI_VECTORS};
  l.vectors = l.vectors > 4 * ARNOLDI_VECTORS ? 4 * ARNOLDI_VECTORS : l.vectors;
  cdem_status status = lanczos_init(&l, fault);
  if (status == CDEM_OK)
    status = iterate(spectrum, factor, shift, wanted, &l, value, fault);
  lanczos_release(&l);
  cholmod_free_factor(&factor, &spectrum->common);
  if (status == CDEM_OK)
    qsort(value, (size_t)wanted, sizeof *value, ascending);
  return status;
}
