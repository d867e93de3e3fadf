/* What the batches hold: places, inverse Jacobians and spring tensors, computed side by side
 * straight into their place. */
#include "base/mat3.h"
#include "cdem/body_store.h"

#include <omp.h>
#include <string.h>

/* Inverse Jacobian at the centre: out[dimension k + c] = dxi_k/dX_c. */
static void inverse_jacobian(const cdem_body_kind *kind, const double (*xyz)[3], double *out) {
  double inverse[9];
  cdem_body_jacobian(kind, xyz, kind->derivative, inverse);
  for (int k = 0; k < kind->dimension; k++)
    for (int c = 0; c < kind->dimension; c++)
      out[kind->dimension * k + c] = inverse[3 * k + c];
}

/* The record's entries but the springs, at data[e * stride]. */
static void fill_geometry(const cdem_body_kind *kind, const double (*xyz)[3], double *data,
                          int stride) {
  double inverse[9];
  int dimension = kind->dimension;
  inverse_jacobian(kind, xyz, inverse);
  for (int e = 0; e < dimension * dimension; e++)
    data[e * stride] = inverse[e];
  for (int a = 1; a < kind->nodes; a++)
    for (int c = 0; c < dimension; c++)
      data[(kind->place + dimension * (a - 1) + c) * stride] = xyz[a][c];
}

static void fill_batch(const cdem_model *model, cdem_body_store *store, int64_t n) {
  const cdem_body_batch *batch = &store->batch[n];
  const cdem_body_kind *kind = &store->kind[batch->kind];
  double x[CDEM_BODY_NODES * 3 * CDEM_LANES], least[CDEM_LANES];
  double moment[CDEM_BODY_PAIRS * 9 * CDEM_LANES], spring[CDEM_BODY_PAIRS * 9 * CDEM_LANES];
  double *data = store->data + batch->record;
  const cdem_contraction *law[CDEM_LANES];
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    double xyz[CDEM_SHAPE_MAX_NODES][3];
    int32_t cell = store->cell[n * CDEM_LANES + (lane < batch->cells ? lane : batch->cells - 1)];
    if (batch->shared)
      cell = store->cell[n * CDEM_LANES];
    law[lane] = &model->contraction[model->material[cell]];
    cdem_model_coordinates(model, cell, xyz);
    for (int i = 0; i < 3 * kind->nodes; i++)
      x[CDEM_LANES * i + lane] = xyz[i / 3][i % 3];
    if (!batch->shared)
      fill_geometry(kind, (const double(*)[3])xyz, data + lane, CDEM_LANES);
    else if (lane == 0)
      fill_geometry(kind, (const double(*)[3])xyz, data, 1);
  }
  const cdem_tabulation *tabulation = &model->kinds_of[batch->kind].tabulation;
  cdem_moments_kernel(tabulation, x, moment, least);
  double *s = batch->shared ? spring : data + (ptrdiff_t)CDEM_LANES * kind->spring;
  cdem_blocks_kernel(kind->pairs, law, moment, s);
  int entries = kind->pairs * kind->dofs * kind->dofs;
  for (int e = 0; batch->shared && e < entries; e++)
    data[kind->spring + e] = spring[CDEM_LANES * e];
}

cdem_status cdem_body_fill(const cdem_model *model, int threads, cdem_body_store *store,
                           cdem_fault *fault) {
  CDEM_BODY_NEW(store, store->data, store->doubles, fault);
#pragma omp parallel for schedule(static) num_threads(threads) if (store->tiles > 1)
  for (int64_t n = 0; n < store->batches; n++)
    if (!store->batch[n].shared || store->batch[n].fills)
      fill_batch(model, store, n);
  return CDEM_OK;
}

void cdem_body_shares(const cdem_model *model, int32_t cell, double share[CDEM_BODY_NODES]) {
  const cdem_tabulation *t = &model->kinds_of[model->kind[cell]].tabulation;
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  cdem_model_coordinates(model, cell, xyz);
  double thickness = model->dimension == 2 ? model->section.thickness : 1.0;
  for (int a = 0; a < t->nodes; a++)
    share[a] = 0.0;
  for (int q = 0; q < t->points; q++) {
    double j[9] = {0};
    if (model->dimension == 2)
      j[8] = 1.0;
    for (int a = 0; a < t->nodes; a++)
      for (int i = 0; i < model->dimension; i++)
        for (int k = 0; k < model->dimension; k++)
          j[3 * i + k] += xyz[a][i] * t->dn[3 * (t->nodes * q + a) + k];
    double weight = thickness * t->weight[q] * cdem_det3(j);
    for (int a = 0; a < t->nodes; a++)
      share[a] += weight * t->n[t->nodes * q + a];
  }
}

double cdem_body_mean_gradients(const cdem_model *model, int32_t cell, double (*mean)[3]) {
  const cdem_tabulation *t = &model->kinds_of[model->kind[cell]].tabulation;
  double xyz[CDEM_SHAPE_MAX_NODES][3], volume = 0.0;
  cdem_model_coordinates(model, cell, xyz);
  double thickness = model->dimension == 2 ? model->section.thickness : 1.0;
  memset(mean, 0, (size_t)t->nodes * sizeof *mean);
  for (int q = 0; q < t->points; q++) {
    const double *dn = t->dn + (ptrdiff_t)3 * t->nodes * q;
    double j[9] = {0}, inverse[9];
    if (model->dimension == 2)
      j[8] = 1.0;
    for (int a = 0; a < t->nodes; a++)
      for (int i = 0; i < model->dimension; i++)
        for (int k = 0; k < model->dimension; k++)
          j[3 * i + k] += xyz[a][i] * dn[3 * a + k];
    double weight = thickness * t->weight[q] * cdem_inverse3(j, inverse);
    volume += weight;
    for (int a = 0; a < t->nodes; a++)
      for (int i = 0; i < model->dimension; i++)
        for (int k = 0; k < model->dimension; k++)
          mean[a][i] += weight * dn[3 * a + k] * inverse[3 * k + i];
  }
  for (int i = 0; i < 3 * t->nodes; i++)
    mean[i / 3][i % 3] /= volume;
  return volume;
}
