/* Materials without tension in the elastic body.
 *
 * The springs of an element feel d_i - a X_i, with the opening a of its mean strain. What they then
 * carry less is, by the patch test, that of the even stress D a: V D a m_i at node i, with V the
 * volume and m_i the means of grad N_i. With M = sum y_i x (V D a m_i) and (tr(U) I - U) h = M the
 * forces so change by R (V D a m_i - h x grad N_i) (docs/theory/cdem.md, section 1b). Only cells of
 * such materials are visited. body_reference.c takes the opening out of d itself.
 */
#include "cdem/body_store.h"

#include <stdlib.h>
#include <string.h>

/* ---- what is stored ---- */

static cdem_status law_of(const cdem_model *model, int m, cdem_tension_law *law,
                          cdem_fault *fault) {
  const cdem_material *material = &model->materials_of[m];
  double d[36];
  int rows;
  bool cubic = material->model == CDEM_COSSERAT_CUBIC || material->model == CDEM_COSSERAT_LATTICE;
  bool isotropic =
      material->model == CDEM_ISOTROPIC || (cdem_material_is_cosserat(material) && !cubic);
  CDEM_REQUIRE(isotropic || cubic, fault, CDEM_INPUT,
               "material '%s' is %s and cannot be without tension: that law wants isotropic moduli",
               material->name, cdem_material_model_get(material->model)->name);
  if (model->formulation == CDEM_SOLID) {
    CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_SOLID, NULL, d, &rows, fault));
    *law = (cdem_tension_law){.kind = CDEM_TENSION_SOLID, .lambda = d[1], .mu = d[21]};
    return CDEM_OK;
  }
  bool cosserat = model->formulation == CDEM_PLANE_COSSERAT;
  CDEM_TRY(cdem_material_moduli(material, cosserat ? CDEM_MODULI_PLANE_COSSERAT : CDEM_MODULI_PLANE,
                                &model->section, d, &rows, fault));
  *law = (cdem_tension_law){.kind = CDEM_TENSION_PLANE, .k = {d[0] + d[1], d[0] - d[1]}};
  law->k[2] = cosserat ? d[14] + d[15] : 2.0 * d[8]; /* D1212 + D1221 = 2 G */
  if (isotropic)
    law->k[2] = law->k[1];
  return CDEM_OK;
}

static int mean_length(const cdem_body_kind *kind) {
  return 1 + kind->nodes * kind->dimension;
}

static void fill_means(const cdem_model *model, cdem_body_store *store, int64_t n) {
  const cdem_body_batch *batch = &store->batch[n];
  const cdem_body_kind *kind = &store->kind[batch->kind];
  int stride = batch->shared ? 1 : CDEM_LANES;
  for (int lane = 0; lane < stride; lane++) {
    double mean[CDEM_BODY_NODES][3], *to = store->mean + store->mean_start[n] + lane;
    int32_t cell = store->cell[n * CDEM_LANES + (lane < batch->cells ? lane : batch->cells - 1)];
    *to = cdem_body_mean_gradients(model, cell, mean);
    for (int a = 0; a < kind->nodes; a++)
      for (int c = 0; c < kind->dimension; c++)
        to[(ptrdiff_t)stride * (1 + kind->dimension * a + c)] = mean[a][c];
  }
}

cdem_status cdem_body_tension_fill(const cdem_model *model, const bool *no_tension,
                                   cdem_body_store *store, cdem_fault *fault) {
  int64_t doubles = 0;
  bool any = false;
  for (int32_t i = 0; i < model->cells && no_tension != NULL; i++)
    any = any || no_tension[model->material[i]];
  if (!any)
    return CDEM_OK;
  CDEM_BODY_NEW(store, store->tension, model->materials, fault);
  for (int m = 0; m < model->materials; m++)
    if (no_tension[m])
      CDEM_TRY(law_of(model, m, &store->tension[m], fault));
  CDEM_BODY_NEW(store, store->mean_start, store->batches, fault);
  for (int64_t n = 0; n < store->batches; n++) {
    const cdem_body_batch *batch = &store->batch[n];
    bool has = false;
    for (int lane = 0; lane < batch->cells; lane++)
      has = has || cdem_body_is_tensionless(model, store, store->cell[n * CDEM_LANES + lane]);
    store->mean_start[n] = has ? doubles : -1;
    int64_t length = mean_length(&store->kind[batch->kind]);
    doubles += !has ? 0 : batch->shared ? length : length * CDEM_LANES;
    store->own_means += has && !batch->shared ? length * CDEM_LANES : 0;
  }
  CDEM_BODY_NEW(store, store->mean, doubles, fault);
  for (int64_t n = 0; n < store->batches; n++)
    if (store->mean_start[n] >= 0)
      fill_means(model, store, n);
  return CDEM_OK;
}

/* ---- what opens: by the kernel, cubic planes by the plain law ---- */

/* The laws of a batch for the kernel; false where one is cubic. */
static bool isotropic_of(const cdem_body *body, int64_t n, cdem_body_isotropic *law) {
  const cdem_body_store *store = body->store;
  law->solid = body->model->formulation == CDEM_SOLID;
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    int32_t cell = store->cell[n * CDEM_LANES + lane];
    const cdem_tension_law *own = cell >= 0 ? &store->tension[body->model->material[cell]] : NULL;
    bool active = own != NULL && own->kind != CDEM_TENSION_ELASTIC;
    if (active && own->k[1] != own->k[2])
      return false;
    law->active[lane] = active ? 1.0 : 0.0;
    law->first[lane] = !active ? 1.0 : law->solid ? own->lambda : own->k[0];
    law->second[lane] = !active ? 1.0 : law->solid ? own->mu : own->k[1];
  }
  return true;
}

bool cdem_body_openings(const cdem_body *body, const cdem_body_kernels *kernels,
                        const cdem_body_task *task, int64_t n, cdem_body_frames *frames,
                        double opening[6 * CDEM_LANES]) {
  const cdem_body_store *store = body->store;
  cdem_body_isotropic law;
  bool any = false;
  if (store->mean_start[n] < 0)
    return false;
  kernels->frames(task, store->mean + store->mean_start[n], frames);
  if (isotropic_of(body, n, &law))
    return kernels->opens(&law, frames, opening);
  memset(opening, 0, 6 * CDEM_LANES * sizeof *opening);
  for (int lane = 0; lane < store->batch[n].cells; lane++) {
    int material = body->model->material[store->cell[n * CDEM_LANES + lane]];
    const double(*b)[CDEM_LANES] = (const double(*)[CDEM_LANES])frames->b;
    const double strain[6] = {b[0][lane], b[4][lane], 0.0, 0.0, 0.0, b[1][lane] + b[3][lane]};
    double a[6];
    if (!cdem_tension_open(&store->tension[material], strain, a))
      continue;
    any = true;
    for (int v = 0; v < 6; v++)
      opening[CDEM_LANES * v + lane] = a[v];
  }
  return any;
}

/* pull = R P and turn = R [h]x of one lane, P = V D a and h from M = sum y_i x (P m_i), which is
 * the axial vector of b P since sum y_i (x) m_i = I + b and P is symmetric. */
static void pull_of(const cdem_tension_law *law, const cdem_body_frames *frames, double volume,
                    const double a[6], int lane, cdem_body_pulls *pulls) {
  double s[6], r[9], b[9], moment[3], h[3], product[9];
  cdem_tension_stress(law, a, s);
  const double p[9] = {volume * s[0], volume * s[5], volume * s[4], volume * s[5], volume * s[1],
                       volume * s[3], volume * s[4], volume * s[3], volume * s[2]};
  for (int k = 0; k < 9; k++) {
    r[k] = frames->e[k][lane] + (k % 4 == 0 ? 1.0 : 0.0);
    b[k] = frames->b[k][lane];
  }
  cdem_product3(b, p, product);
  moment[0] = product[5] - product[7];
  moment[1] = product[6] - product[2];
  moment[2] = product[1] - product[3];
  const double g[6] = {frames->inverse[0][lane], frames->inverse[1][lane],
                       frames->inverse[2][lane], frames->inverse[3][lane],
                       frames->inverse[4][lane], frames->inverse[5][lane]};
  h[0] = g[0] * moment[0] + g[5] * moment[1] + g[4] * moment[2];
  h[1] = g[5] * moment[0] + g[1] * moment[1] + g[3] * moment[2];
  h[2] = g[4] * moment[0] + g[3] * moment[1] + g[2] * moment[2];
  const double skew[9] = {0.0, -h[2], h[1], h[2], 0.0, -h[0], -h[1], h[0], 0.0};
  cdem_product3(r, p, product);
  for (int k = 0; k < 9; k++)
    pulls->pull[k][lane] = product[k];
  cdem_product3(r, skew, product);
  for (int k = 0; k < 9; k++)
    pulls->turn[k][lane] = product[k];
}

void cdem_body_tension_forces(const cdem_body *body, const cdem_body_kernels *kernels,
                              const cdem_body_task *task, int64_t n, double *force) {
  const cdem_body_store *store = body->store;
  cdem_body_frames frames;
  cdem_body_pulls pulls;
  double opening[6 * CDEM_LANES];
  if (!cdem_body_openings(body, kernels, task, n, &frames, opening))
    return;
  const double *mean = store->mean + store->mean_start[n];
  memset(&pulls, 0, sizeof pulls);
  for (int lane = 0; lane < store->batch[n].cells; lane++) {
    int material = body->model->material[store->cell[n * CDEM_LANES + lane]];
    double a[6];
    for (int v = 0; v < 6; v++)
      a[v] = opening[CDEM_LANES * v + lane];
    if (a[0] + a[1] + a[2] > 0.0) /* no opening has a trace below zero */
      pull_of(&store->tension[material], &frames, mean[task->shared ? 0 : lane], a, lane, &pulls);
  }
  kernels->releases(task, mean, &pulls, force);
}

void cdem_body_tension_stress(const cdem_body *body, const cdem_body_kernels *kernels,
                              const cdem_body_task *task, int64_t n, double *stress) {
  static const int8_t row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
  const cdem_body_store *store = body->store;
  cdem_body_frames frames;
  double opening[6 * CDEM_LANES];
  if (!cdem_body_openings(body, kernels, task, n, &frames, opening))
    return;
  for (int lane = 0; lane < store->batch[n].cells; lane++) {
    int32_t cell = store->cell[n * CDEM_LANES + lane];
    const cdem_body_law *law = &store->law[body->model->material[cell]];
    double s[6] = {0}, r[9];
    for (int i = 0; i < 6; i++)
      for (int v = 0; v < 6; v++)
        s[i] += law->stress[i][v] * opening[CDEM_LANES * v + lane];
    const double m[9] = {s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2]};
    for (int k = 0; k < 9; k++)
      r[k] = frames.e[k][lane] + (k % 4 == 0 ? 1.0 : 0.0);
    for (int v = 0; v < 6; v++)
      for (int k = 0; k < 9; k++)
        stress[6 * (int64_t)cell + v] -= r[3 * row[v] + k / 3] * m[k] * r[3 * column[v] + k % 3];
  }
}
