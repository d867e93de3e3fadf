/* Forces, energies, stresses and the sign of det F over all batches: tile by tile, in parallel. */
#include "base/simd.h"
#include "cdem/body_store.h"

#include <omp.h>
#include <string.h>

/* The lowest of `worst` and the batch's cells whose determinant is not positive. */
static int32_t note_inverted(const cdem_body_store *store, int64_t n, const double *determinant,
                             int32_t worst) {
  for (int lane = 0; lane < store->batch[n].cells; lane++) {
    int32_t cell = store->cell[n * CDEM_LANES + lane];
    if (!(determinant[lane] > 0.0) && cell < worst)
      worst = cell;
  }
  return worst;
}

static int32_t tile_forces(const cdem_body *body, const cdem_body_kernels *kernels, const double *u,
                           int32_t t, double *buffer) {
  const cdem_body_store *store = body->store;
  int32_t worst = INT32_MAX;
  for (int64_t n = store->tile_batch[t]; n < store->tile_batch[t + 1]; n++) {
    cdem_body_task task = cdem_body_task_of(body, u, n);
    double determinant[CDEM_LANES];
    double *of_batch = buffer + (ptrdiff_t)store->batch[n].row * body->dofs * CDEM_LANES;
    kernels->forces(&task, of_batch, determinant);
    if (store->tension != NULL)
      cdem_body_tension_forces(body, kernels, &task, n, of_batch);
    bool positive = true;
    for (int lane = 0; lane < CDEM_LANES; lane++)
      positive = positive && determinant[lane] > 0.0;
    if (!positive)
      worst = note_inverted(store, n, determinant, worst);
  }
  return worst;
}

/* Sums of a tile's element forces, to the nodes it has alone and to partial sums. dofs is known
 * when compiled. */
CDEM_ALWAYS_INLINE void gather(const cdem_body_store *store, const int dofs, int32_t t,
                               const double *buffer, double *force) {
  for (int64_t i = store->tile_node[t]; i < store->tile_node[t + 1]; i++) {
    const uint16_t *entry = store->entry + store->entry_start[i];
    const uint16_t *end = store->entry + store->entry_start[i + 1];
    int32_t target = store->target[i];
    double x = 0.0, y = 0.0, z = 0.0;
    for (; entry < end; entry++) {
      const unsigned lane = *entry % CDEM_LANES;
      const double *f = buffer + (*entry - lane) * (unsigned)dofs + lane;
      x += f[0];
      y += f[CDEM_LANES];
      if (dofs == 3)
        z += f[2 * CDEM_LANES];
    }
    double *to = target >= 0 ? force + (int64_t)target * dofs
                             : store->partial + (-1 - (int64_t)target) * dofs;
    to[0] = x;
    to[1] = y;
    if (dofs == 3)
      to[2] = z;
  }
}

static void tile_gather(const cdem_body_store *store, int dofs, int32_t t, const double *buffer,
                        double *force) {
  if (dofs == 3)
    gather(store, 3, t, buffer, force);
  else
    gather(store, 2, t, buffer, force);
}

/* The force of a node of several tiles. */
static void join(const cdem_body_store *store, int dofs, int32_t j, double *force) {
  const double *from = store->partial + store->joint_start[j] * dofs;
  const double *end = store->partial + store->joint_start[j + 1] * dofs;
  double *to = force + (int64_t)store->joint[j] * dofs, x = 0.0, y = 0.0, z = 0.0;
  for (; from < end; from += dofs) {
    x += from[0];
    y += from[1];
    if (dofs == 3)
      z += from[2];
  }
  to[0] = x;
  to[1] = y;
  if (dofs == 3)
    to[2] = z;
}

void cdem_body_forces(cdem_body *body, const double *u, double *force) {
  const cdem_body_store *store = body->store;
  const cdem_body_kernels *kernels = cdem_body_kernels_widest();
  int dofs = body->dofs;
  int32_t worst = INT32_MAX;
#pragma omp parallel num_threads(body->threads) reduction(min : worst) if (store->tiles > 1)
  {
    double *buffer =
        store->buffer + (ptrdiff_t)omp_get_thread_num() * store->rows * dofs * CDEM_LANES;
#pragma omp for schedule(static)
    for (int32_t t = 0; t < store->tiles; t++) {
      int32_t cell = tile_forces(body, kernels, u, t, buffer);
      worst = cell < worst ? cell : worst;
      tile_gather(store, dofs, t, buffer, force);
    }
#pragma omp for schedule(static)
    for (int32_t j = 0; j < store->joints; j++)
      join(store, dofs, j, force);
  }
  for (int32_t i = 0; i < store->lonely; i++)
    memset(force + (int64_t)store->lonely_node[i] * dofs, 0, (size_t)dofs * sizeof *force);
  body->inverted = worst == INT32_MAX ? -1 : worst;
}

int64_t cdem_body_inverted(const cdem_body *body, const double *u) {
  const cdem_body_store *store = body->store;
  const cdem_body_kernels *kernels = cdem_body_kernels_widest();
  int32_t worst = INT32_MAX;
#pragma omp parallel for schedule(static) num_threads(body->threads)                               \
    reduction(min                                                                                  \
              : worst) if (store->tiles > 1)
  for (int64_t n = 0; n < store->batches; n++) {
    cdem_body_task task = cdem_body_task_of(body, u, n);
    double determinant[CDEM_LANES];
    kernels->determinants(&task, determinant);
    worst = note_inverted(store, n, determinant, worst);
  }
  return worst == INT32_MAX ? -1 : worst;
}

double cdem_body_energy(const cdem_body *body, const double *u, double by_class[CDEM_CLASSES]) {
  const cdem_body_store *store = body->store;
  const cdem_body_kernels *kernels = cdem_body_kernels_widest();
#pragma omp parallel for schedule(static) num_threads(body->threads) if (store->tiles > 1)
  for (int32_t t = 0; t < store->tiles; t++) {
    double sum[CDEM_CLASSES] = {0}, energy[CDEM_CLASSES * CDEM_LANES];
    for (int64_t n = store->tile_batch[t]; n < store->tile_batch[t + 1]; n++) {
      cdem_body_task task = cdem_body_task_of(body, u, n);
      double opening[6 * CDEM_LANES];
      cdem_body_frames frames;
      if (store->tension != NULL && cdem_body_openings(body, kernels, &task, n, &frames, opening))
        task.opening = opening;
      kernels->energies(&task, energy);
      for (int c = 0; c < CDEM_CLASSES; c++)
        for (int lane = 0; lane < store->batch[n].cells; lane++)
          sum[c] += energy[CDEM_LANES * c + lane];
    }
    memcpy(store->tile_energy + (ptrdiff_t)CDEM_CLASSES * t, sum, sizeof sum);
  }
  double total[CDEM_CLASSES] = {0};
  for (int32_t t = 0; t < store->tiles; t++)
    for (int c = 0; c < CDEM_CLASSES; c++)
      total[c] += store->tile_energy[(ptrdiff_t)CDEM_CLASSES * t + c];
  if (by_class != NULL)
    memcpy(by_class, total, sizeof total);
  return total[0] + total[1] + total[2];
}

/* A batch of elements of their own may hold several materials: one pass for each. */
static void batch_stress(const cdem_body *body, const cdem_body_kernels *kernels, const double *u,
                         int64_t n, double *stress) {
  const cdem_body_store *store = body->store;
  const int32_t *cell = store->cell + n * CDEM_LANES;
  cdem_body_task task = cdem_body_task_of(body, u, n);
  int cells = store->batch[n].cells;
  unsigned left = (1U << cells) - 1U;
  for (int first = 0; first < cells; first++) {
    double out[6 * CDEM_LANES];
    int material = body->model->material[cell[first]];
    if (!(left >> first & 1U))
      continue;
    kernels->stresses(&task, (const double(*)[7])store->law[material].stress, out);
    for (int lane = first; lane < cells; lane++) {
      if (body->model->material[cell[lane]] != material)
        continue;
      left &= ~(1U << lane);
      for (int v = 0; v < 6; v++)
        stress[6 * (int64_t)cell[lane] + v] = out[CDEM_LANES * v + lane];
    }
  }
  if (store->tension != NULL)
    cdem_body_tension_stress(body, kernels, &task, n, stress);
}

void cdem_body_cell_stress(const cdem_body *body, const double *u, double *stress) {
  const cdem_body_store *store = body->store;
  const cdem_body_kernels *kernels = cdem_body_kernels_widest();
#pragma omp parallel for schedule(static) num_threads(body->threads) if (store->tiles > 1)
  for (int64_t n = 0; n < store->batches; n++)
    batch_stress(body, kernels, u, n, stress);
}
