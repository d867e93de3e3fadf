/* Which cells are congruent: a hash of kind, material and quantised places finds the candidates,
 * the places themselves decide. */
#include "cdem/body_store.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Places of one size are alike to this part of it. */
#define ALIKE 1e-12

static uint64_t mix(uint64_t hash, uint64_t value) {
  /* The finaliser of splitmix64 (Steele, Lea & Flood 2014) over a running sum. */
  uint64_t z = hash + value * UINT64_C(0x9e3779b97f4a7c15) + UINT64_C(0x7f4a7c15f39cc060);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

/* A quantum that equal sizes share: a power of two, which changes at 1.46 2^n, a size that no
 * regular mesh has (at 2^n rounding would part equal cells). */
static double quantum(int nodes, const double (*xyz)[3]) {
  double size = 0.0;
  int power;
  for (int i = 0; i < 3 * nodes; i++)
    size = fmax(size, fabs(xyz[i / 3][i % 3]));
  (void)frexp(size * 1.37, &power);
  return ldexp(ALIKE, power - 1);
}

static uint64_t hash_of(const cdem_model *model, int32_t cell) {
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  int nodes = cdem_element_nodes(cdem_model_element(model, cell));
  cdem_model_coordinates(model, cell, xyz);
  double step = quantum(nodes, (const double(*)[3])xyz);
  uint64_t hash = mix(model->kind[cell], model->material[cell]);
  for (int i = 3; i < 3 * nodes; i++)
    hash = mix(hash, (uint64_t)llround(xyz[i / 3][i % 3] / step));
  return hash;
}

static bool alike(const cdem_model *model, int32_t a, int32_t b) {
  if (model->kind[a] != model->kind[b] || model->material[a] != model->material[b])
    return false;
  double p[CDEM_SHAPE_MAX_NODES][3], q[CDEM_SHAPE_MAX_NODES][3];
  int nodes = cdem_element_nodes(cdem_model_element(model, a));
  cdem_model_coordinates(model, a, p);
  cdem_model_coordinates(model, b, q);
  double step = 1.001 * quantum(nodes, (const double(*)[3])p);
  for (int i = 3; i < 3 * nodes; i++)
    if (!(fabs(p[i / 3][i % 3] - q[i / 3][i % 3]) <= step))
      return false;
  return true;
}

/* Open addressing; the first cell of a kind of template keeps its slot. */
static int64_t insert_all(const cdem_model *model, const uint64_t *hash, int32_t *slot,
                          int64_t mask, int32_t *template_of) {
  int64_t distinct = 0;
  for (int32_t i = 0; i < model->cells; i++) {
    int64_t at = (int64_t)(hash[i] & (uint64_t)mask);
    while (slot[at] != 0 && !(hash[slot[at] - 1] == hash[i] && alike(model, slot[at] - 1, i)))
      at = (at + 1) & mask;
    if (slot[at] == 0) {
      slot[at] = i + 1;
      distinct++;
    }
    template_of[i] = slot[at] - 1;
  }
  return distinct;
}

cdem_status cdem_body_congruent(const cdem_model *model, bool separate, int threads,
                                int32_t *template_of, int64_t *distinct, cdem_fault *fault) {
  if (separate) {
    for (int32_t i = 0; i < model->cells; i++)
      template_of[i] = i;
    *distinct = model->cells;
    return CDEM_OK;
  }
  int64_t slots = 16;
  while (slots < 2 * (int64_t)model->cells)
    slots *= 2;
  uint64_t *hash;
  CDEM_NEW(hash, model->cells, fault);
  int32_t *slot = cdem_allocate(slots, sizeof *slot, fault);
  if (slot == NULL) {
    free(hash);
    return CDEM_MEMORY;
  }
#pragma omp parallel for schedule(static) num_threads(threads) if (model->cells > CDEM_BODY_TILE)
  for (int32_t i = 0; i < model->cells; i++)
    hash[i] = hash_of(model, i);
  *distinct = insert_all(model, hash, slot, slots - 1, template_of);
  free(hash);
  free(slot);
  return CDEM_OK;
}
