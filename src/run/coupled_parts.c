/* Fine and outer cells, fine and interface grains, and the operators between them. */
#include "run/coupled.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char outer[] = "outer elements"; /* group of the coarse medium of a coupled run */

/* ---- cells ---- */

cdem_status cdem_run_coupled_cells(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_case_coupling *v = cdem_run_coupled_values(c);
  cdem_bsm_box *box;
  int dim = cdem_mesh_dimension(&c->body->mesh);
  int64_t grains_dim = cdem_run_values(c->run)->grains.dimension;
  if (dim != grains_dim)
    return cdem_case_fail(&c->run->cases, "grains.dimension", CDEM_INPUT, fault,
                          "the mesh has %d dimensions and the grains %d", dim, (int)grains_dim);
  CDEM_NEW(box, v->regions.count, fault);
  for (int64_t i = 0; i < v->regions.count; i++)
    for (int k = 0; k < dim; k++) {
      box[i].low[k] = v->regions.item[i].low[k];
      box[i].high[k] = v->regions.item[i].high[k];
    }
  cdem_status status = cdem_bsm_cells(&c->body->mesh, (int)v->regions.count, box, &c->fine_cells,
                                      &c->fine_cell, fault);
  free(box);
  return status == CDEM_INPUT ? cdem_case_blame(&c->run->cases, "coupling.regions", fault) : status;
}

/* ---- grains ---- */

/* The medium starts at rest, and driven grains are those of the interface: with others the two
 * books of energy would not meet. */
cdem_status cdem_run_coupled_check_grains(const cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_grains *g = &c->grains->grains;
  for (int64_t i = 0; i < g->grains; i++) {
    bool driven = g->motion != NULL && g->motion[i] == CDEM_GRAIN_DRIVEN;
    bool moves = (g->velocity != NULL && cdem_norm3(g->velocity + 3 * i) > 0.0) ||
                 (g->spin != NULL && cdem_norm3(g->spin + 3 * i) > 0.0);
    if (driven || moves)
      return cdem_case_fail(&c->run->cases, "grains", CDEM_INPUT, fault,
                            "grain %lld %s; grains in a body are free and start at rest",
                            (long long)i, driven ? "is driven" : "moves at the start");
  }
  return CDEM_OK;
}

/* Keeps the grains whose mark is not CDEM_PART_AWAY, in their order. */
static void keep_grains(cdem_run_grains *g, const uint8_t *part) {
  cdem_grains *grains = &g->grains;
  int64_t kept = 0;
  for (int64_t i = 0; i < grains->grains; i++) {
    if (part[i] == CDEM_PART_AWAY)
      continue;
    memmove(grains->xyz + 3 * kept, grains->xyz + 3 * i, 3 * sizeof(double));
    memmove(grains->velocity + 3 * kept, grains->velocity + 3 * i, 3 * sizeof(double));
    memmove(grains->spin + 3 * kept, grains->spin + 3 * i, 3 * sizeof(double));
    grains->radius[kept] = grains->radius[i];
    grains->material[kept] = grains->material[i];
    grains->motion[kept] = grains->motion[i];
    g->case_material[kept++] = g->case_material[i];
  }
  grains->grains = kept;
}

static cdem_status partition(cdem_run_coupled *c, cdem_fault *fault) {
  cdem_partition_release(&c->partition);
  cdem_status status =
      cdem_partition_init(&c->body->mesh, c->fine_cells, c->fine_cell, &c->grains->grains,
                          cdem_run_coupled_values(c)->interface_gap, &c->partition, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&c->run->cases, "coupling.regions", fault) : status;
}

cdem_status cdem_run_coupled_divide(cdem_run_coupled *c, cdem_fault *fault) {
  bool all = c->version == CDEM_VERSION_GRAINS;
  CDEM_TRY(partition(c, fault));
  if (!all) { /* places in the thinner list are found anew; what touches what stays the same */
    keep_grains(c->grains, c->partition.part);
    CDEM_TRY(partition(c, fault));
  }
  CDEM_NEW(c->fine_grain, c->partition.fine, fault);
  CDEM_NEW(c->not_fine, c->partition.grains, fault);
  for (int64_t i = 0; i < c->partition.grains; i++) {
    if (c->partition.part[i] == CDEM_PART_FINE) {
      c->fine_grain[c->fine++] = (int32_t)i;
    } else if (!all) {
      c->grains->grains.motion[i] = CDEM_GRAIN_DRIVEN;
      c->not_fine[i] = 1;
    }
  }
  return CDEM_OK;
}

/* ---- the projector ---- */

/* Numbers of the fine grains, one after the other. */
typedef struct {
  int32_t *cell;
  double *xi, *mass, *inertia, *all;
} gathered;

static void gathered_release(gathered *f) {
  free(f->cell);
  free(f->xi);
  free(f->mass);
  free(f->inertia);
  free(f->all);
}

static cdem_status gather(const cdem_run_coupled *c, gathered *f, cdem_fault *fault) {
  int64_t grains = c->grains->grains.grains;
  CDEM_NEW(f->cell, c->fine, fault);
  CDEM_NEW(f->xi, 3 * c->fine, fault);
  CDEM_NEW(f->mass, c->fine, fault);
  CDEM_NEW(f->inertia, c->fine, fault);
  CDEM_NEW(f->all, 2 * grains, fault);
  cdem_dem_look(&c->grains->dem, &(cdem_dem_view){.mass = f->all, .inertia = f->all + grains});
  for (int64_t a = 0; a < c->fine; a++) {
    int32_t id = c->fine_grain[a];
    f->cell[a] = c->partition.cell[id];
    memcpy(f->xi + 3 * a, c->partition.xi + 3 * (int64_t)id, 3 * sizeof *f->xi);
    f->mass[a] = f->all[id];
    f->inertia[a] = f->all[grains + id];
  }
  return CDEM_OK;
}

cdem_status cdem_run_coupled_projector(cdem_run_coupled *c, cdem_fault *fault) {
  gathered f = {0};
  cdem_projector_shape shape = cdem_run_coupled_shape(c);
  int width = shape.translations + shape.rotations;
  cdem_status status = gather(c, &f, fault);
  if (status == CDEM_OK) {
    const cdem_projector_options options = {.mesh = &c->body->mesh,
                                            .cells = c->fine_cells,
                                            .fine_cell = c->fine_cell,
                                            .grains = c->fine,
                                            .cell = f.cell,
                                            .xi = f.xi,
                                            .mass = f.mass,
                                            .inertia = f.inertia};
    status = cdem_projector_init(&options, &c->projector, fault);
    if (status == CDEM_INPUT)
      status = cdem_case_blame(&c->run->cases, "coupling.regions", fault);
  }
  gathered_release(&f);
  CDEM_TRY(status);
  CDEM_NEW(c->u, c->fine * width, fault);
  CDEM_NEW(c->kept, c->fine * width, fault);
  CDEM_NEW(c->d, (int64_t)c->projector.nodes * width, fault);
  return CDEM_OK;
}

/* ---- the body's cells and nodes ---- */

/* Nodes of fine cells that no outer cell has. */
static cdem_status find_spares(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_mesh *mesh = &c->body->mesh;
  uint8_t *used = cdem_allocate(mesh->nodes, 1, fault);
  if (used == NULL)
    return CDEM_MEMORY;
  for (int32_t k = 0; k < c->partition.outer_cells; k++) {
    int32_t cell = c->partition.outer_cell[k];
    for (int64_t i = mesh->cell_start[cell]; i < mesh->cell_start[cell + 1]; i++)
      used[mesh->cell_node[i]] = 1;
  }
  c->spare = cdem_allocate(c->projector.nodes, sizeof *c->spare, fault);
  int32_t spares = 0;
  for (int32_t i = 0; c->spare != NULL && i < c->projector.nodes; i++)
    if (!used[c->projector.node[i]])
      c->spare[spares++] = c->projector.node[i];
  free(used);
  if (c->spare == NULL)
    return CDEM_MEMORY;
  c->body->spare = spares;
  c->body->spares = c->spare;
  return CDEM_OK;
}

/* The coarse medium of a coupled run is the rest of the mesh: a group of its own. */
cdem_status cdem_run_coupled_ties(cdem_run_coupled *c, cdem_fault *fault) {
  const cdem_case_coupling *v = cdem_run_coupled_values(c);
  int dim = cdem_mesh_dimension(&c->body->mesh);
  if (c->partition.outer_cells == 0)
    return cdem_case_fail(
        &c->run->cases, "coupling.regions", CDEM_INPUT, fault,
        "the fine region is the whole mesh: nothing is left of the coarse medium; "
        "run the version of grains, or take a smaller region");
  CDEM_TRY(cdem_mesh_add_group(&c->body->mesh, outer, dim, c->partition.outer_cells,
                               c->partition.outer_cell, fault));
  c->body->only = outer;
  if (v->form == CDEM_BSM_VIRTUAL_WORK) {
    if (cdem_case_given(&c->run->cases, "blocks"))
      return cdem_case_fail(&c->run->cases, "coupling.form", CDEM_INPUT, fault,
                            "the form virtual-work shares nodes between grains and body, which a "
                            "body that may break does not have; take the form interface");
    CDEM_TRY(find_spares(c, fault));
  }
  return CDEM_OK;
}
