/* The largest eigenfrequency, element by element, and row sums. The largest eigenvalue of body and
 * lumped mass is at most the largest of its elements with their own shares of the mass (Irons:
 * Rayleigh's quotient of the whole is a mean of those of the elements). */
#include "cdem/body_store.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum { MAX_SIZE = CDEM_BODY_NODES * CDEM_MAX_DOFS };

/* Elements without tension open and close between steps. Their curvature never exceeds that of the
 * linear element, so that no single state is unstable; but a step that ends deep in the spring on
 * the way in and leaves it on the way out gains energy, and undamped bodies that rattle are pumped
 * up near the linear limit (docs/rooms/cdem-body.md has numbers). As of contacts (solver_limit.c),
 * four times the square of their frequency is taken: half the step. */
enum { UNILATERAL = 4 };

/* Rounding of the squarings, generously. */
#define ROUNDING 1e-12

/* Stiffness of one element from its record, row-major [size][size], entries `stride` apart. */
static void stiffness_of(const cdem_body_record *record, double *k, int stride) {
  const cdem_body_kind *kind = record->kind;
  int n = kind->dofs, size = n * kind->nodes;
  bool cosserat = kind->formulation == CDEM_PLANE_COSSERAT;
  for (int e = 0; e < size * size; e++)
    k[e * stride] = 0.0;
#define K(i, a, j, b) k[(ptrdiff_t)stride * (size * (n * (i) + (a)) + n * (j) + (b))]
#define PLACE(i, c)                                                                                \
  ((i) == 0 ? 0.0 : record->data[(ptrdiff_t)record->stride * (kind->place + 2 * ((i)-1) + (c))])
  const double *s = record->data + (ptrdiff_t)record->stride * kind->spring;
  for (int i = 0; i < kind->nodes; i++)
    for (int j = i + 1; j < kind->nodes; j++) {
      double rx = cosserat ? PLACE(j, 0) - PLACE(i, 0) : 0.0;
      double ry = cosserat ? PLACE(j, 1) - PLACE(i, 1) : 0.0;
      for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++, s += record->stride) {
          K(i, a, j, b) -= *s;
          K(j, b, i, a) -= *s;
          K(i, a, i, b) += *s;
          K(j, b, j, a) += *s;
          if (cosserat && b < 2) /* S T_ij: column omega */
            K(i, a, i, 2) += b == 0 ? -*s * ry : *s * rx;
          if (cosserat && a < 2) /* S^T T_ji, the arm reversed */
            K(j, b, j, 2) += a == 0 ? *s * ry : -*s * rx;
        }
    }
#undef K
#undef PLACE
}

/* sqrt(unit/mass) of the lumped masses of one cell: out [size]. The unit, a power of two near the
 * mass of the first node, keeps roots the same bits where all masses are multiplied by a power of
 * two, an odd one too (docs/theory/scaling.md); rotations differ by the square of a length. */
static double mass_roots(const cdem_body *body, int32_t cell, double *out) {
  const cdem_body_store *store = body->store;
  int material = body->model->material[cell];
  const cdem_body_kind *kind = &store->kind[body->model->kind[cell]];
  double share[CDEM_BODY_NODES];
  int exponent;
  cdem_body_shares(body->model, cell, share);
  frexp(store->density[material] * share[0], &exponent);
  double unit = ldexp(1.0, exponent);
  for (int i = 0; i < kind->nodes; i++)
    for (int a = 0; a < kind->dofs; a++) {
      double mass = store->density[material] * share[i];
      if (a >= kind->dimension)
        mass *= store->micro_inertia[material];
      out[kind->dofs * i + a] = 1.0 / sqrt(mass / unit);
    }
  return unit;
}

/* Bounds of omega^2 of the cells of a batch [CDEM_LANES]. */
static void batch_bounds(const cdem_body *body, int64_t n, double *bound) {
  const cdem_body_store *store = body->store;
  const cdem_body_batch *batch = &store->batch[n];
  const cdem_body_kind *kind = &store->kind[batch->kind];
  double a[MAX_SIZE * MAX_SIZE * CDEM_LANES], work[MAX_SIZE * MAX_SIZE * CDEM_LANES];
  int size = kind->nodes * kind->dofs;
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    int32_t cell = store->cell[n * CDEM_LANES + (lane < batch->cells ? lane : batch->cells - 1)];
    cdem_body_record record = cdem_body_record_of(store, cell);
    double scale[MAX_SIZE];
    stiffness_of(&record, a + lane, CDEM_LANES);
    double unit = mass_roots(body, cell, scale);
    for (int i = 0; i < size; i++)
      for (int j = 0; j < size; j++)
        a[(size * i + j) * CDEM_LANES + lane] *= scale[i] * scale[j] / unit;
  }
  cdem_body_kernels_widest()->bounds(size, a, work, bound);
}

double cdem_body_frequency(const cdem_body *body, int32_t *cell) {
  const cdem_body_store *store = body->store;
  double largest = -1.0;
  int32_t where = 0;
#pragma omp parallel for schedule(static) num_threads(body->threads) if (body->store->tiles > 1)
  for (int64_t n = 0; n < store->batches; n++) {
    if (store->batch[n].shared && !store->batch[n].fills)
      continue;
    double bound[CDEM_LANES];
    batch_bounds(body, n, bound);
    /* The largest, and of equal ones the lowest cell: whatever the order. */
#pragma omp critical(cdem_body_frequency)
    for (int lane = 0; lane < store->batch[n].cells; lane++) {
      int32_t here = store->cell[n * CDEM_LANES + lane];
      if (cdem_body_is_tensionless(body->model, store, here))
        bound[lane] *= UNILATERAL;
      if (bound[lane] > largest || (bound[lane] == largest && here < where)) {
        largest = bound[lane];
        where = here;
      }
    }
  }
  if (cell != NULL)
    *cell = where;
  return sqrt(fmax(largest, 0.0)) * (1.0 + ROUNDING);
}

void cdem_body_row_sums(const cdem_body *body, double *stiffness, double *couple) {
  const cdem_model *model = body->model;
  double length = model->length;
  memset(stiffness, 0, sizeof *stiffness * (size_t)body->nodes);
  if (couple != NULL)
    memset(couple, 0, sizeof *couple * (size_t)body->nodes);
  for (int32_t cell = 0; cell < model->cells; cell++) {
    cdem_body_record record = cdem_body_record_of(body->store, cell);
    const cdem_body_kind *kind = record.kind;
    const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[cell]);
    double k[MAX_SIZE * MAX_SIZE];
    int n = kind->dofs, size = n * kind->nodes;
    stiffness_of(&record, k, 1);
    for (int i = 0; i < kind->nodes; i++) {
      double most = 0.0;
      for (int a = 0; a < n; a++) {
        double sum = 0.0; /* N/m: rotations count by the model's length */
        for (int c = 0; c < size; c++)
          sum += fabs(k[size * (n * i + a) + c]) / (c % n >= kind->dimension ? length : 1.0);
        if (a < kind->dimension)
          most = fmax(most, sum);
        else if (couple != NULL)
          couple[node[i]] += sum * length;
      }
      stiffness[node[i]] += most;
    }
  }
}
