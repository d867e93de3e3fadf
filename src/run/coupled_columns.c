/* The columns of history.csv of a coupled case: those of the body with the prefix "coarse.", those
 * of the grains with "fine.", and what joins them, the same in all versions. */
#include "dem/measures.h"
#include "run/coupled.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- extremes in the fine region ---- */

static void take(cdem_run_fine *f, double volumetric, double effective, double mean,
                 double deviator) {
  /* fmin and fmax pass over NaN: grains whose neighbours have left */
  f->volumetric_strain = fmin(f->volumetric_strain, volumetric);
  f->effective_strain = fmax(f->effective_strain, effective);
  f->volumetric_stress = fmin(f->volumetric_stress, mean);
  f->effective_stress = fmax(f->effective_stress, deviator);
}

static cdem_status look_grains(const cdem_run_coupled *c, cdem_run_fine *found, cdem_fault *fault) {
  const cdem_dem *dem = &c->grains->dem;
  double *all;
  CDEM_NEW(all, 8 * dem->grains, fault);
  double *stress = all, *volumetric = all + 6 * dem->grains, *effective = all + 7 * dem->grains;
  cdem_status status = cdem_grain_stress(dem, stress, fault);
  if (status == CDEM_OK)
    status = cdem_grain_strain(dem, c->strain, NULL, volumetric, effective, fault);
  for (int64_t a = 0; status == CDEM_OK && a < c->fine; a++) {
    int64_t id = c->fine_grain[a];
    double mean = 0.0;
    for (int k = 0; k < dem->dim; k++)
      mean += stress[6 * id + k] / dem->dim;
    take(found, volumetric[id], effective[id], mean,
         cdem_effective_stress(dem->dim, stress + 6 * id));
  }
  free(all);
  return status;
}

/* Of elements at their centres, small strains. */
static cdem_status look_cells(const cdem_run_coupled *c, cdem_run_fine *found, cdem_fault *fault) {
  const cdem_run_body *body = c->body;
  int dim = body->model.dimension;
  double *all;
  CDEM_NEW(all, 12 * (int64_t)body->model.cells, fault);
  double *stress = all, *strain = all + 6 * (int64_t)body->model.cells;
  cdem_body_cell_fields(&body->body, body->solver.u,
                        &(cdem_body_fields){.stress = stress, .strain = strain});
  for (int32_t k = 0; k < c->fine_cells; k++) {
    /* the whole mesh is the body: its cells are in the order of the mesh */
    int32_t i = body->model_of[c->fine_cell[k]];
    cdem_run_cell_numbers n =
        cdem_run_coupled_cell(dim, stress + 6 * (int64_t)i, strain + 6 * (int64_t)i);
    take(found, n.volumetric_strain, n.effective_strain, n.volumetric_stress, n.effective_stress);
  }
  free(all);
  return CDEM_OK;
}

/* Kinetic energy of the fine grains, and of its part that the mesh can express. */
static cdem_status look_kinetic(const cdem_run_coupled *c, cdem_run_fine *found,
                                cdem_fault *fault) {
  cdem_projector_shape shape = cdem_run_coupled_shape(c);
  const cdem_dem *dem = &c->grains->dem;
  double *all;
  CDEM_NEW(all, 6 * dem->grains, fault);
  cdem_dem_look(dem, &(cdem_dem_view){.velocity = all, .spin = all + 3 * dem->grains});
  cdem_run_coupled_gather(c, all, all + 3 * dem->grains);
  free(all);
  CDEM_TRY(cdem_projector_split(&c->projector, shape, c->u, c->kept, NULL, fault));
  found->kinetic = cdem_projector_energy(&c->projector, shape, c->u);
  found->coarse_part = cdem_projector_energy(&c->projector, shape, c->kept);
  return CDEM_OK;
}

/* Fine grains more than a diameter away from their start, with their centres in outer elements:
 * they have slipped through the interface grains, and the medium does not know them. */
static cdem_status look_strayed(const cdem_run_coupled *c, cdem_run_fine *found,
                                cdem_fault *fault) {
  const cdem_dem *dem = &c->grains->dem;
  const double *radius = cdem_dem_radius(dem);
  int64_t far = 0;
  double *all;
  CDEM_NEW(all, 12 * dem->grains, fault);
  double *xyz = all, *way = all + 3 * dem->grains, *places = all + 6 * dem->grains;
  cdem_dem_look(dem, &(cdem_dem_view){.xyz = xyz, .displacement = way});
  for (int64_t a = 0; a < c->fine; a++) {
    int64_t id = c->fine_grain[a];
    if (cdem_norm3(way + 3 * id) > 2.0 * radius[id])
      memcpy(places + 3 * far++, xyz + 3 * id, 3 * sizeof *xyz);
  }
  int32_t *cell = cdem_allocate(far, sizeof *cell, fault);
  cdem_status status = cell == NULL ? CDEM_MEMORY : CDEM_OK;
  if (status == CDEM_OK && far > 0)
    status = cdem_locate(&c->body->mesh, c->partition.outer_cells, c->partition.outer_cell, far,
                         places, cell, all + 9 * dem->grains, fault);
  for (int64_t k = 0; status == CDEM_OK && k < far; k++)
    found->strayed += cell[k] >= 0;
  free(cell);
  free(all);
  return status;
}

static cdem_status look(const cdem_run_coupled *c, cdem_run_fine *found, cdem_fault *fault) {
  *found = (cdem_run_fine){INFINITY, -INFINITY, INFINITY, -INFINITY, 0.0, 0.0, 0};
  if (!c->has_grains)
    return look_cells(c, found, fault);
  CDEM_TRY(look_grains(c, found, fault));
  if (c->version != CDEM_VERSION_GRAINS)
    CDEM_TRY(look_strayed(c, found, fault));
  return look_kinetic(c, found, fault);
}

/* ---- plates: walls of the grains and plates of the body of one name ---- */

static void add_force(const cdem_run_coupled *c, const char *name, double force[3],
                      double moved[3]) {
  const cdem_run_conditions *plates = &c->body->conditions;
  memset(force, 0, 3 * sizeof *force);
  memset(moved, 0, 3 * sizeof *moved);
  for (int i = 0; c->has_body && i < plates->plates; i++)
    if (strcmp(plates->plate[i].name, name) == 0)
      cdem_solver_plate(&c->body->solver, i, force, moved);
  for (int w = 0; c->has_grains && w < c->grains->walls; w++)
    if (strcmp(c->grains->wall[w].name, name) == 0) {
      cdem_dem_wall at;
      cdem_dem_wall_now(&c->grains->dem, w, &at);
      for (int k = 0; k < 3; k++) {
        force[k] += at.force[k];
        moved[k] = at.moved[k];
      }
    }
}

static void put_load(cdem_run_row *row, const cdem_run_coupled *c, const char *name) {
  double force[3] = {0}, moved[3] = {0};
  int dim = (int)cdem_run_values(c->run)->grains.dimension;
  if (!row->declare)
    add_force(c, name, force, moved);
  cdem_run_put_vector(row, "N", dim, force, "load.%s.f", name);
  cdem_run_put_vector(row, "m", dim, moved, "load.%s.moved_", name);
}

static void put_loads(cdem_run_row *row, const cdem_run_coupled *c) {
  const cdem_case_values *v = cdem_run_values(c->run);
  for (int64_t p = 0; p < v->plates.count; p++)
    put_load(row, c, v->plates.item[p].name);
  for (int64_t w = 0; w < v->walls.count; w++) {
    bool met = false;
    for (int64_t p = 0; p < v->plates.count; p++)
      met = met || strcmp(v->plates.item[p].name, v->walls.item[w].name) == 0;
    if (!met)
      put_load(row, c, v->walls.item[w].name);
  }
}

/* ---- energies of both ---- */

/* What is missing in both books and in the exchange between them, by the largest term of any. In
 * the form virtual-work the grains' work on inner nodes has no counterpart: the books stay apart.
 */
static void put_book(cdem_run_row *row, const cdem_run_coupled *c) {
  cdem_energy_book coarse = {0};
  cdem_dem_energies fine = {0};
  bool both = c->has_body && c->has_grains && c->fine_tie.grains == 0;
  if (!row->declare && c->has_body)
    cdem_solver_energies(&c->body->solver, &coarse);
  if (!row->declare && c->has_grains)
    cdem_dem_energies_now(&c->grains->dem, &fine);
  double exchange = both ? fine.driven + c->coupling.work : 0.0;
  double scale = fmax(coarse.exchange, fine.exchange);
  cdem_run_put(row, "J", exchange, "exchange");
  cdem_run_put_energy_error(row, coarse.error + fine.error + exchange, scale);
  if (c->has_body && c->has_grains)
    cdem_run_put(row, "J", fine.driven, "fine.driven");
  if (c->guides > 0)
    cdem_run_put(row, "J", fine.guided, "fine.guided");
  if (c->loads > 0)
    cdem_run_put(row, "J", fine.applied, "fine.applied");
}

void cdem_run_coupled_columns(cdem_run_setup *run, cdem_run_row *row) {
  cdem_run_coupled *c = cdem_run_coupled_of(run);
  cdem_run_fine f = {0};
  if (!row->declare && row->status == CDEM_OK)
    row->status = look(c, &f, row->fault);
  put_loads(row, c);
  cdem_run_put(row, "", f.volumetric_strain, "region.volumetric_strain");
  cdem_run_put(row, "", f.effective_strain, "region.effective_strain");
  cdem_run_put(row, "Pa", f.volumetric_stress, "region.volumetric_stress");
  cdem_run_put(row, "Pa", f.effective_stress, "region.effective_stress");
  cdem_run_put(row, "", (double)f.strayed, "region.strayed");
  cdem_run_put(row, "J", f.coarse_part, "coarse_part");
  cdem_run_put(row, "J", f.kinetic - f.coarse_part, "fine_part");
  put_book(row, c);
  if (c->has_body) {
    row->prefix = "coarse.";
    cdem_run_engine_body.columns(&c->body_run, row);
  }
  if (c->has_grains) {
    row->prefix = "fine.";
    cdem_run_engine_grains.columns(&c->grains_run, row);
  }
  row->prefix = NULL;
}
