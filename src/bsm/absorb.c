#include "bsm/absorb.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_absorb_release(cdem_absorb *absorb) {
  cdem_projector_release(&absorb->projector);
  free(absorb->grain);
  free(absorb->motion);
  free(absorb->v);
  free(absorb->q);
  free(absorb->force);
  *absorb = (cdem_absorb){0};
}

/* ---- which elements ---- */

enum { OTHER, FREE, TAKEN }; /* of no interest (or of lower dimension); fine; of the layer */

static void mark_nodes(const cdem_mesh *mesh, int32_t cell, uint8_t *met) {
  for (int64_t k = mesh->cell_start[cell]; k < mesh->cell_start[cell + 1]; k++)
    met[mesh->cell_node[k]] = 1;
}

static bool touches(const cdem_mesh *mesh, int32_t cell, const uint8_t *met) {
  bool found = false;
  for (int64_t k = mesh->cell_start[cell]; k < mesh->cell_start[cell + 1]; k++)
    found = found || met[mesh->cell_node[k]] != 0;
  return found;
}

cdem_status cdem_absorb_cells(const cdem_mesh *mesh, int32_t cells, const int32_t *cell, int layers,
                              int32_t *layer_cells, int32_t **layer, cdem_fault *fault) {
  int dim = cdem_mesh_dimension(mesh);
  int32_t *found, count = 0;
  uint8_t *state, *met;
  CDEM_NEW(found, cells, fault);
  state = cdem_allocate((int64_t)mesh->cells + mesh->nodes, sizeof *state, fault);
  if (state == NULL) {
    free(found);
    return CDEM_MEMORY;
  }
  met = state + mesh->cells;
  for (int32_t i = 0; i < cells; i++)
    state[cell[i]] = FREE;
  for (int32_t c = 0; c < mesh->cells; c++)
    if (state[c] == OTHER && cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension == dim)
      mark_nodes(mesh, c, met);
  bool more = true;
  for (int l = 0; l < layers && more; l++) {
    more = false;
    for (int32_t i = 0; i < cells; i++)
      if (state[cell[i]] == FREE && touches(mesh, cell[i], met)) {
        state[cell[i]] = TAKEN;
        more = true;
      }
    for (int32_t i = 0; i < cells; i++)
      if (state[cell[i]] == TAKEN)
        mark_nodes(mesh, cell[i], met);
  }
  for (int32_t i = 0; i < cells; i++)
    if (state[cell[i]] == TAKEN)
      found[count++] = cell[i];
  free(state);
  *layer_cells = count;
  *layer = found;
  return CDEM_OK;
}

/* ---- the layer ---- */

/* Grains of the layer, one after the other. */
typedef struct {
  int64_t grains;
  int32_t *cell;
  double *xi, *mass, *inertia, *all;
} gathered;

static void gathered_release(gathered *g) {
  free(g->cell);
  free(g->xi);
  free(g->mass);
  free(g->inertia);
  free(g->all);
}

static int by_id(const void *a, const void *b) {
  int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

static cdem_status gather(const cdem_absorb_options *o, cdem_absorb *absorb, gathered *g,
                          cdem_fault *fault) {
  int64_t all = o->fine->grains;
  CDEM_NEW(absorb->grain, o->grains, fault);
  CDEM_NEW(g->cell, o->grains, fault);
  CDEM_NEW(g->xi, 3 * o->grains, fault);
  CDEM_NEW(g->mass, o->grains, fault);
  CDEM_NEW(g->inertia, o->grains, fault);
  CDEM_NEW(g->all, 2 * all, fault);
  cdem_dem_look(o->fine, &(cdem_dem_view){.mass = g->all, .inertia = g->all + all});
  for (int64_t a = 0; a < o->grains; a++) {
    int64_t n = g->grains;
    if (bsearch(&o->cell[a], o->layer, (size_t)o->cells, sizeof *o->layer, by_id) == NULL)
      continue;
    absorb->grain[n] = o->grain[a];
    g->cell[n] = o->cell[a];
    memcpy(g->xi + 3 * n, o->xi + 3 * a, 3 * sizeof *g->xi);
    g->mass[n] = g->all[o->grain[a]];
    g->inertia[n] = g->all[all + o->grain[a]];
    g->grains++;
  }
  return CDEM_OK;
}

/* By the bound that dashpots obey (dem/solver_limit.c): k dt^2 + 2 c dt <= 4 for all motions. */
static cdem_status check_rate(const cdem_absorb_options *o, cdem_fault *fault) {
  double limit;
  CDEM_TRY(cdem_dem_limit(o->fine, &limit, NULL, fault));
  double part = o->fine->step / limit;
  double most = 2.0 * (1.0 - part * part) / o->fine->step;
  CDEM_REQUIRE(o->rate > 0.0 && o->rate <= most, fault, CDEM_INPUT,
               "the layer takes %.4g of the motion a second; with steps of %.4g s it is stable up "
               "to %.4g 1/s",
               o->rate, o->fine->step, most);
  return CDEM_OK;
}

static cdem_status build(const cdem_absorb_options *o, cdem_absorb *absorb, gathered *g,
                         cdem_fault *fault) {
  CDEM_TRY(check_rate(o, fault));
  CDEM_TRY(gather(o, absorb, g, fault));
  const cdem_projector_options projector = {.mesh = o->mesh,
                                            .cells = o->cells,
                                            .fine_cell = o->layer,
                                            .grains = g->grains,
                                            .cell = g->cell,
                                            .xi = g->xi,
                                            .mass = g->mass,
                                            .inertia = g->inertia};
  CDEM_TRY(cdem_projector_init(&projector, &absorb->projector, fault));
  int width = absorb->shape.translations + absorb->shape.rotations;
  CDEM_NEW(absorb->motion, 6 * g->grains, fault);
  CDEM_NEW(absorb->v, width * g->grains, fault);
  CDEM_NEW(absorb->q, width * g->grains, fault);
  CDEM_NEW(absorb->force, 6 * g->grains, fault);
  return cdem_dem_want_applied(o->fine, fault);
}

cdem_status cdem_absorb_init(const cdem_absorb_options *options, cdem_absorb *absorb,
                             cdem_fault *fault) {
  cdem_absorb a = {.fine = options->fine,
                   .rate = options->rate,
                   .shape = options->fine->dim == 2 ? (cdem_projector_shape){2, 1}
                                                    : (cdem_projector_shape){3, 3}};
  gathered g = {0};
  cdem_status status = build(options, &a, &g, fault);
  gathered_release(&g);
  if (status != CDEM_OK) {
    cdem_absorb_release(&a);
    return status;
  }
  *absorb = a;
  return CDEM_OK;
}

/* ---- forces ---- */

/* Component of velocity and spin, and of force and moment, that is column c of the fields. */
static int component(const cdem_absorb *absorb, int c) {
  int translations = absorb->shape.translations;
  return c < translations ? c : absorb->shape.rotations == 1 ? 5 : 3 + c - translations;
}

static cdem_status find(cdem_absorb *absorb, cdem_fault *fault) {
  const cdem_projector *p = &absorb->projector;
  int width = absorb->shape.translations + absorb->shape.rotations;
  cdem_dem_motions_of(absorb->fine, p->grains, absorb->grain, absorb->motion);
  for (int64_t a = 0; a < p->grains; a++)
    for (int c = 0; c < width; c++)
      absorb->v[a * width + c] = absorb->motion[6 * a + component(absorb, c)];
  CDEM_TRY(cdem_projector_split(p, absorb->shape, absorb->v, NULL, absorb->q, fault));
  for (int64_t a = 0; a < p->grains; a++)
    for (int c = 0; c < width; c++)
      absorb->force[6 * a + component(absorb, c)] =
          -absorb->rate * (c < absorb->shape.translations ? p->mass[a] : p->inertia[a]) *
          absorb->q[a * width + c];
  return CDEM_OK;
}

static void add(const cdem_absorb *absorb, double sign) {
  for (int64_t a = 0; a < absorb->projector.grains; a++)
    for (int k = 0; k < 6; k++)
      absorb->fine->applied[6 * (int64_t)absorb->grain[a] + k] += sign * absorb->force[6 * a + k];
}

cdem_status cdem_absorb_apply(cdem_absorb *absorb, cdem_fault *fault) {
  add(absorb, -1.0);
  CDEM_TRY(find(absorb, fault));
  add(absorb, 1.0);
  return CDEM_OK;
}

void cdem_absorb_forget(cdem_absorb *absorb) {
  memset(absorb->force, 0, 6 * (size_t)absorb->projector.grains * sizeof *absorb->force);
}

cdem_status cdem_absorb_restored(cdem_absorb *absorb, cdem_fault *fault) {
  return find(absorb, fault);
}
