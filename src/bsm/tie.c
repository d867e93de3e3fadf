#include "bsm/tie.h"

#include "base/mat3.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_tie_release(cdem_tie *tie) {
  cdem_weights_release(&tie->weights);
  free(tie->grain);
  free(tie->node);
  *tie = (cdem_tie){0};
}

static cdem_status list_nodes(const cdem_mesh *mesh, cdem_tie *tie, cdem_fault *fault) {
  uint8_t *met = cdem_allocate(mesh->nodes, 1, fault);
  if (met == NULL)
    return CDEM_MEMORY;
  for (int64_t k = 0; k < tie->weights.start[tie->grains]; k++)
    met[tie->weights.node[k]] = 1;
  for (int32_t n = 0; n < mesh->nodes; n++)
    tie->nodes += met[n];
  tie->node = cdem_allocate(tie->nodes, sizeof *tie->node, fault);
  for (int32_t n = 0, at = 0; tie->node != NULL && n < mesh->nodes; n++)
    if (met[n])
      tie->node[at++] = n;
  free(met);
  return tie->node != NULL ? CDEM_OK : CDEM_MEMORY;
}

cdem_status cdem_tie_init(const cdem_mesh *mesh, int dofs, int64_t grains, const int32_t *grain,
                          const int32_t *cell, const double *xi, cdem_tie *tie, cdem_fault *fault) {
  cdem_tie t = {.dim = cdem_mesh_dimension(mesh), .dofs = dofs, .grains = grains};
  cdem_status status = cdem_weights_init(mesh, grains, cell, xi, &t.weights, fault);
  t.grain = cdem_allocate(grains, sizeof *t.grain, fault);
  if (status == CDEM_OK && t.grain == NULL)
    status = CDEM_MEMORY;
  if (status == CDEM_OK) {
    for (int64_t a = 0; a < grains; a++)
      t.grain[a] = grain[a];
    status = list_nodes(mesh, &t, fault);
  }
  if (status != CDEM_OK) {
    cdem_tie_release(&t);
    return status;
  }
  *tie = t;
  return CDEM_OK;
}

static bool rotates(const cdem_tie *tie) {
  return tie->dim == 2 && tie->dofs == 3;
}

void cdem_tie_motion(const cdem_tie *tie, const double *v, double *motion) {
  const cdem_weights *w = &tie->weights;
  for (int64_t a = 0; a < tie->grains; a++) {
    double *m = motion + 6 * a;
    memset(m, 0, 6 * sizeof *m);
    for (int64_t k = w->start[a]; k < w->start[a + 1]; k++) {
      const double *of = v + (int64_t)w->node[k] * tie->dofs, *g = w->dn + 3 * k;
      double at[3] = {of[0], of[1], tie->dim == 3 ? of[2] : 0.0}, curl[3];
      cdem_cross3(g, at, curl);
      for (int c = 0; c < 3; c++) {
        m[c] += w->n[k] * at[c];
        m[3 + c] += rotates(tie) ? (c == 2 ? w->n[k] * of[2] : 0.0) : 0.5 * curl[c];
      }
    }
  }
}

void cdem_tie_forces(const cdem_tie *tie, const double *on, double *force) {
  const cdem_weights *w = &tie->weights;
  for (int64_t a = 0; a < tie->grains; a++) {
    const double *f = on + 6 * a;
    for (int64_t k = w->start[a]; k < w->start[a + 1]; k++) {
      double *to = force + (int64_t)w->node[k] * tie->dofs, turned[3];
      cdem_cross3(f + 3, w->dn + 3 * k, turned); /* transpose of 1/2 curl: 1/2 m x grad N */
      for (int c = 0; c < tie->dim; c++)
        to[c] += w->n[k] * f[c] + (rotates(tie) ? 0.0 : 0.5 * turned[c]);
      if (rotates(tie))
        to[2] += w->n[k] * f[5];
    }
  }
}

cdem_status cdem_tie_frequency2(const cdem_tie *tie, const double *stiffness, const double *turning,
                                const double *mass, double *bound, cdem_fault *fault) {
  const cdem_weights *w = &tie->weights;
  double most[2] = {0};
  int64_t rows = tie->nodes > 0 ? tie->node[tie->nodes - 1] + 1 : 0;
  double *row;
  CDEM_NEW(row, 2 * rows, fault);
  for (int64_t a = 0; a < tie->grains; a++) {
    double size = 0.0;
    for (int64_t k = w->start[a]; k < w->start[a + 1]; k++)
      size += 0.5 * cdem_norm3(w->dn + 3 * k);
    for (int64_t k = w->start[a]; k < w->start[a + 1]; k++) {
      double *r = row + 2 * (size_t)w->node[k];
      r[0] += stiffness[a] * fabs(w->n[k]);
      r[1] += turning[a] * (rotates(tie) ? fabs(w->n[k]) : 0.5 * cdem_norm3(w->dn + 3 * k) * size);
    }
  }
  for (int32_t i = 0; i < tie->nodes; i++) {
    size_t n = (size_t)tie->node[i];
    const double *m = mass + n * (size_t)tie->dofs;
    double turns = rotates(tie) ? m[2] : m[0];
    if (m[0] > 0.0)
      most[0] = fmax(most[0], row[2 * n] / m[0]);
    if (turns > 0.0)
      most[1] = fmax(most[1], row[2 * n + 1] / turns);
  }
  free(row);
  /* v and w of a grain come from the same nodes, and one spring may resist both. */
  double root = sqrt(most[0]) + sqrt(most[1]);
  *bound = rotates(tie) ? most[0] + most[1] : root * root;
  return CDEM_OK;
}
