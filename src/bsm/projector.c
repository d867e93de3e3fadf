#include "bsm/projector.h"

#include "base/memory.h"

#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct cdem_projector_factors {
  cholmod_common common;
  bool started;
  cholmod_factor *translation, *rotation;
  double unit[2]; /* of mass and inertia: the factors are those of matrices over these */
};

void cdem_projector_release(cdem_projector *projector) {
  cdem_projector_factors *f = projector->factors;
  if (f != NULL && f->started) {
    cholmod_l_free_factor(&f->translation, &f->common);
    cholmod_l_free_factor(&f->rotation, &f->common);
    cholmod_l_finish(&f->common);
  }
  free(f);
  cdem_weights_release(&projector->weights);
  free(projector->node);
  free(projector->mass);
  free(projector->inertia);
  *projector = (cdem_projector){0};
}

/* ---- do the grains of each element determine its nodes? ---- */

/* Smallest over largest eigenvalue of a symmetric positive matrix of n <= 8 rows, by Jacobi's
 * rotations. */
static double least_ratio(int n, double a[8][8]) {
  for (int sweep = 0; sweep < 30; sweep++) {
    double off = 0.0;
    for (int p = 0; p < n; p++)
      for (int q = p + 1; q < n; q++) {
        off = fmax(off, fabs(a[p][q]));
        if (a[p][q] == 0.0)
          continue;
        double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
        double t = copysign(1.0, theta) / (fabs(theta) + sqrt(theta * theta + 1.0));
        double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
        for (int k = 0; k < n; k++) {
          double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < n; k++) {
          double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
        }
      }
    if (off == 0.0)
      break;
  }
  double least = INFINITY, most = 0.0;
  for (int k = 0; k < n; k++) {
    least = fmin(least, a[k][k]);
    most = fmax(most, a[k][k]);
  }
  return most > 0.0 ? least / most : 0.0;
}

static int compare_ids(const void *a, const void *b) {
  int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

static int32_t position_of(int32_t count, const int32_t *list, int32_t id) {
  const int32_t *at = bsearch(&id, list, (size_t)count, sizeof *list, compare_ids);
  return at != NULL ? (int32_t)(at - list) : -1;
}

/* Every cell on its own: N^T N of its grains must be of full rank. An element that borrows what it
 * lacks from its neighbours would pass a test of the whole and still follow single grains. */
static cdem_status check_rank(const cdem_projector_options *o, const cdem_weights *w,
                              cdem_fault *fault) {
  static const double least = 1e-4; /* of the largest eigenvalue: three grains near a corner */
  double(*gram)[8][8];
  int32_t *count;
  cdem_status status = CDEM_OK;
  CDEM_NEW(gram, o->cells, fault);
  count = cdem_allocate(o->cells, sizeof *count, fault);
  if (count == NULL) {
    free(gram);
    return CDEM_MEMORY;
  }
  for (int64_t a = 0; a < o->grains; a++) {
    int32_t c = position_of(o->cells, o->fine_cell, o->cell[a]);
    const double *n = w->n + w->start[a];
    int nodes = (int)(w->start[a + 1] - w->start[a]);
    count[c]++;
    for (int i = 0; i < nodes; i++)
      for (int j = 0; j < nodes; j++)
        gram[c][i][j] += n[i] * n[j];
  }
  for (int32_t c = 0; c < o->cells && status == CDEM_OK; c++) {
    int32_t cell = o->fine_cell[c];
    int nodes = (int)(o->mesh->cell_start[cell + 1] - o->mesh->cell_start[cell]);
    double middle[3] = {0};
    if (count[c] >= nodes && least_ratio(nodes, gram[c]) > least)
      continue;
    for (int i = 0; i < nodes; i++)
      for (int k = 0; k < 3; k++)
        middle[k] += o->mesh->xyz[3 * (int64_t)cdem_mesh_cell(o->mesh, cell)[i] + k] / nodes;
    status = cdem_fail(
        fault, CDEM_INPUT,
        "element %lld at (%.4g, %.4g, %.4g m) holds %d grain%s, which %s its %d nodes; take "
        "larger elements or smaller grains, or leave it out of the fine region",
        (long long)o->mesh->cell_tag[cell], middle[0], middle[1], middle[2], count[c],
        count[c] == 1 ? "" : "s", count[c] < nodes ? "are too few for" : "do not determine", nodes);
  }
  free(gram);
  free(count);
  return status;
}

/* ---- the matrices ---- */

static cdem_status out_of_memory(cdem_fault *fault) {
  return cdem_fail(fault, CDEM_MEMORY, "out of memory in the factors of the projector");
}

/* The power of two at or below the largest weight. Cholesky takes roots: of a matrix over this unit
 * they are the same bits for the same masses times any power of two, an odd one too (a case that is
 * scaled by 2 has masses times 8). */
static double unit_of(int64_t count, const double *weight) {
  double most = 0.0;
  int exponent;
  for (int64_t a = 0; a < count; a++)
    most = fmax(most, weight[a]);
  frexp(most, &exponent);
  return ldexp(1.0, exponent - 1);
}

/* N^T diag(weight/unit) N, factorised. */
static cdem_status factorise(const cdem_projector *p, const double *weight, double unit,
                             cholmod_factor **factor, cdem_fault *fault) {
  cholmod_common *common = &p->factors->common;
  const cdem_weights *w = &p->weights;
  size_t entries = 0;
  for (int64_t a = 0; a < p->grains; a++)
    entries += (size_t)((w->start[a + 1] - w->start[a]) * (w->start[a + 1] - w->start[a] + 1) / 2);
  cholmod_triplet *triplet = cholmod_l_allocate_triplet((size_t)p->nodes, (size_t)p->nodes, entries,
                                                        -1, CHOLMOD_REAL, common);
  if (triplet == NULL)
    return out_of_memory(fault);
  SuiteSparse_long *row = triplet->i, *column = triplet->j;
  double *value = triplet->x;
  for (int64_t a = 0; a < p->grains; a++)
    for (int64_t i = w->start[a]; i < w->start[a + 1]; i++)
      for (int64_t j = w->start[a]; j <= i; j++) {
        bool below = w->node[i] >= w->node[j];
        row[triplet->nnz] = below ? w->node[i] : w->node[j];
        column[triplet->nnz] = below ? w->node[j] : w->node[i];
        value[triplet->nnz++] = weight[a] / unit * w->n[i] * w->n[j];
      }
  cholmod_sparse *matrix = cholmod_l_triplet_to_sparse(triplet, triplet->nnz, common);
  cholmod_l_free_triplet(&triplet, common);
  if (matrix == NULL)
    return out_of_memory(fault);
  *factor = cholmod_l_analyze(matrix, common);
  bool done = *factor != NULL && cholmod_l_factorize(matrix, *factor, common);
  bool positive = done && common->status == CHOLMOD_OK && (*factor)->minor == (*factor)->n;
  cholmod_l_free_sparse(&matrix, common);
  if (!done)
    return out_of_memory(fault);
  CDEM_REQUIRE(positive, fault, CDEM_NUMERIC,
               "the mass matrix of the projector is not positive definite; look at the masses");
  return CDEM_OK;
}

/* The nodes of the cells, and the rows of N by their positions. */
static cdem_status number_nodes(const cdem_projector_options *o, cdem_projector *p,
                                cdem_fault *fault) {
  int64_t total = 0;
  for (int32_t c = 0; c < o->cells; c++)
    total += o->mesh->cell_start[o->fine_cell[c] + 1] - o->mesh->cell_start[o->fine_cell[c]];
  CDEM_NEW(p->node, total, fault);
  int64_t all = 0;
  for (int32_t c = 0; c < o->cells; c++)
    for (int64_t k = o->mesh->cell_start[o->fine_cell[c]];
         k < o->mesh->cell_start[o->fine_cell[c] + 1]; k++)
      p->node[all++] = o->mesh->cell_node[k];
  qsort(p->node, (size_t)all, sizeof *p->node, compare_ids);
  for (int64_t k = 0; k < all; k++)
    if (k == 0 || p->node[k] != p->node[k - 1])
      p->node[p->nodes++] = p->node[k];
  for (int64_t k = 0; k < p->weights.start[p->grains]; k++)
    p->weights.node[k] = position_of(p->nodes, p->node, p->weights.node[k]);
  return CDEM_OK;
}

static cdem_status build(const cdem_projector_options *o, cdem_projector *p, cdem_fault *fault) {
  p->grains = o->grains;
  CDEM_TRY(cdem_weights_init(o->mesh, o->grains, o->cell, o->xi, &p->weights, fault));
  CDEM_TRY(check_rank(o, &p->weights, fault));
  CDEM_NEW(p->mass, o->grains, fault);
  CDEM_NEW(p->inertia, o->grains, fault);
  memcpy(p->mass, o->mass, (size_t)o->grains * sizeof *p->mass);
  memcpy(p->inertia, o->inertia, (size_t)o->grains * sizeof *p->inertia);
  CDEM_TRY(number_nodes(o, p, fault));
  CDEM_NEW(p->factors, 1, fault);
  cholmod_l_start(&p->factors->common);
  p->factors->started = true;
  p->factors->common.print = 0;
  p->factors->common.final_ll = 1; /* L D L^T would take masses of either sign */
  double *unit = p->factors->unit;
  unit[0] = unit_of(p->grains, p->mass);
  unit[1] = unit_of(p->grains, p->inertia);
  CDEM_TRY(factorise(p, p->mass, unit[0], &p->factors->translation, fault));
  return factorise(p, p->inertia, unit[1], &p->factors->rotation, fault);
}

cdem_status cdem_projector_init(const cdem_projector_options *options, cdem_projector *projector,
                                cdem_fault *fault) {
  cdem_projector p = {0};
  CDEM_REQUIRE(options->cells > 0, fault, CDEM_INPUT, "the fine region has no elements");
  cdem_status status = build(options, &p, fault);
  if (status != CDEM_OK) {
    cdem_projector_release(&p);
    return status;
  }
  *projector = p;
  return CDEM_OK;
}

/* ---- use ---- */

/* right [nodes][width] (overwritten by the solution): columns `from` .. `to`, all translations or
 * all rotations, by one factor. */
static cdem_status solve(const cdem_projector *p, bool turns, int width, int from, int to,
                         double *right, cdem_fault *fault) {
  cholmod_common *common = &p->factors->common;
  cholmod_factor *factor = turns ? p->factors->rotation : p->factors->translation;
  double unit = p->factors->unit[turns];
  size_t nodes = (size_t)p->nodes, columns = (size_t)(to - from);
  if (to <= from)
    return CDEM_OK;
  cholmod_dense *b = cholmod_l_allocate_dense(nodes, columns, nodes, CHOLMOD_REAL, common);
  if (b == NULL)
    return out_of_memory(fault);
  for (size_t c = 0; c < columns; c++)
    for (size_t n = 0; n < nodes; n++)
      ((double *)b->x)[c * nodes + n] = right[n * (size_t)width + (size_t)from + c] / unit;
  cholmod_dense *x = cholmod_l_solve(CHOLMOD_A, factor, b, common);
  for (size_t c = 0; x != NULL && c < columns; c++)
    for (size_t n = 0; n < nodes; n++)
      right[n * (size_t)width + (size_t)from + c] = ((double *)x->x)[c * nodes + n];
  cholmod_l_free_dense(&b, common);
  if (x == NULL)
    return out_of_memory(fault);
  cholmod_l_free_dense(&x, common);
  return CDEM_OK;
}

cdem_status cdem_projector_project(const cdem_projector *p, cdem_projector_shape shape,
                                   const double *q, double *d, cdem_fault *fault) {
  int width = shape.translations + shape.rotations;
  int64_t count = (int64_t)p->nodes * width;
  double *right, *weighted;
  CDEM_NEW(right, count + p->grains * width, fault);
  weighted = right + count;
  for (int64_t a = 0; a < p->grains; a++)
    for (int c = 0; c < width; c++)
      weighted[a * width + c] =
          (c < shape.translations ? p->mass[a] : p->inertia[a]) * q[a * width + c];
  cdem_weights_gather(&p->weights, width, weighted, right);
  cdem_status status = solve(p, false, width, 0, shape.translations, right, fault);
  if (status == CDEM_OK)
    status = solve(p, true, width, shape.translations, width, right, fault);
  double sum = 0.0;
  for (int64_t k = 0; k < count; k++)
    sum += fabs(right[k]);
  if (status == CDEM_OK && !isfinite(sum))
    status = cdem_fail(fault, CDEM_NUMERIC, "the motion of the grains is not finite");
  if (status == CDEM_OK)
    memcpy(d, right, (size_t)count * sizeof *d);
  free(right);
  return status;
}

cdem_status cdem_projector_split(const cdem_projector *p, cdem_projector_shape shape,
                                 const double *q, double *coarse, double *fine, cdem_fault *fault) {
  int width = shape.translations + shape.rotations;
  double *d, *kept = NULL;
  CDEM_NEW(d, (int64_t)p->nodes * width, fault);
  cdem_status status = cdem_projector_project(p, shape, q, d, fault);
  double *u =
      coarse != NULL ? coarse : (kept = cdem_allocate(p->grains * width, sizeof *kept, fault));
  if (status == CDEM_OK && u == NULL)
    status = CDEM_MEMORY;
  if (status == CDEM_OK) {
    cdem_weights_interpolate(&p->weights, width, d, u);
    for (int64_t k = 0; fine != NULL && k < p->grains * width; k++)
      fine[k] = q[k] - u[k];
  }
  free(kept);
  free(d);
  return status;
}

double cdem_projector_energy(const cdem_projector *p, cdem_projector_shape shape, const double *v) {
  int width = shape.translations + shape.rotations;
  double sum = 0.0;
  for (int64_t a = 0; a < p->grains; a++)
    for (int c = 0; c < width; c++)
      sum += 0.5 * (c < shape.translations ? p->mass[a] : p->inertia[a]) * v[a * width + c] *
             v[a * width + c];
  return sum;
}

void cdem_projector_lumped(const cdem_projector *p, double *mass, double *inertia) {
  memset(mass, 0, (size_t)p->nodes * sizeof *mass);
  memset(inertia, 0, (size_t)p->nodes * sizeof *inertia);
  cdem_weights_gather(&p->weights, 1, p->mass, mass);
  cdem_weights_gather(&p->weights, 1, p->inertia, inertia);
}
