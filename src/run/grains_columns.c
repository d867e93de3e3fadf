/* The columns of history.csv of grains. */
#include "dem/measures.h"
#include "run/grains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a row says of all grains together. */
typedef struct {
  cdem_assembly all;
  double overlap; /* largest, in radii of the smaller grain */
  double speed;   /* largest, m/s */
} summary;

/* ---- looking ---- */

static double largest_overlap(const cdem_run_grains *g, int64_t contacts,
                              const cdem_dem_contact *contact) {
  const double *radius = cdem_dem_radius(&g->dem);
  double largest = 0.0;
  for (int64_t i = 0; i < contacts; i++) {
    const cdem_dem_contact *c = &contact[i];
    double size = c->b >= 0 ? fmin(radius[c->a], radius[c->b]) : radius[c->a];
    if (!c->bonded)
      largest = fmax(largest, c->overlap / size);
  }
  return largest;
}

static cdem_status look(cdem_run_grains *g, summary *found, cdem_fault *fault) {
  const cdem_dem_view view = {.velocity = g->velocity};
  cdem_dem_contact *contact = NULL;
  int64_t contacts = 0;
  double largest = 0.0;
  CDEM_TRY(cdem_measure(&g->dem, NULL, &found->all, fault));
  CDEM_TRY(cdem_dem_contacts(&g->dem, &contacts, &contact, fault));
  found->overlap = largest_overlap(g, contacts, contact);
  free(contact);
  cdem_dem_look(&g->dem, &view);
  for (int64_t i = 0; i < g->grains.grains; i++)
    largest = fmax(largest, cdem_dot3(&g->velocity[3 * i], &g->velocity[3 * i]));
  found->speed = sqrt(largest);
  return CDEM_OK;
}

/* ---- columns ---- */

static void put_energies(cdem_run_row *row, cdem_run_grains *g) {
  cdem_dem_energies book = {0};
  /* The scale of the error remembers every report, so declaring must not be one. */
  if (!row->declare)
    cdem_dem_energies_now(&g->dem, &book);
  cdem_run_put(row, "J", book.translation, "translation");
  cdem_run_put(row, "J", book.rotation, "rotation");
  cdem_run_put(row, "J", book.normal, "normal");
  cdem_run_put(row, "J", book.shear, "shear");
  cdem_run_put(row, "J", book.moment, "moment");
  if (g->bonds > 0)
    cdem_run_put(row, "J", book.bond, "bond");
  cdem_run_put(row, "J", book.friction, "friction");
  cdem_run_put(row, "J", book.rolling, "rolling");
  cdem_run_put(row, "J", book.damping, "damping");
  if (g->bonds > 0)
    cdem_run_put(row, "J", book.broken, "broken");
  cdem_run_put(row, "J", book.gravity, "gravity");
  cdem_run_put(row, "J", book.walls, "walls");
  if (g->has_cell)
    cdem_run_put(row, "J", book.cell, "cell");
  if (g->has_triaxial && g->confinement.membrane != NULL) {
    cdem_run_put(row, "J", book.membrane, "membrane");
    cdem_run_put(row, "J", book.pressure, "pressure");
  }
  cdem_run_put(row, "J", book.circulating, "circulating");
  cdem_run_put_energy_error(row, book.error, book.exchange);
}

static void put_assembly(cdem_run_row *row, cdem_run_grains *g) {
  summary found = {0};
  if (!row->declare && row->status == CDEM_OK)
    row->status = look(g, &found, row->fault);
  cdem_run_put(row, "", (double)found.all.contacts, "contacts");
  cdem_run_put(row, "", found.all.coordination, "coordination");
  cdem_run_put(row, "", found.all.sliding, "sliding");
  cdem_run_put(row, "", found.overlap, "overlap");
  cdem_run_put(row, "m/s", found.speed, "speed");
  cdem_run_put(row, "", row->declare ? 0.0 : cdem_dem_unbalanced(&g->dem), "unbalanced");
  if (g->bonds > 0)
    cdem_run_put(row, "", row->declare ? 0.0 : (double)cdem_dem_bonds_broken(&g->dem),
                 "bonds_broken");
  cdem_run_put(row, "", found.all.solid, "solid");
  cdem_run_put_stress(row, g->dim, found.all.stress);
}

static void put_walls(cdem_run_row *row, const cdem_run_grains *g) {
  double sum[3] = {0};
  for (int w = 0; !row->declare && w < g->walls; w++) {
    cdem_dem_wall at;
    cdem_dem_wall_now(&g->dem, w, &at);
    for (int k = 0; k < 3; k++)
      sum[k] += at.force[k];
  }
  if (g->walls > 0)
    cdem_run_put_vector(row, "N", g->dim, sum, "walls.f");
  for (int w = 0; w < g->walls; w++) {
    const char *name = g->wall[w].name;
    cdem_dem_wall at = {0};
    if (!row->declare)
      cdem_dem_wall_now(&g->dem, w, &at);
    cdem_run_put_vector(row, "N", g->dim, at.force, "wall.%s.f", name);
    if (g->dim == 3)
      cdem_run_put_vector(row, "N m", 3, at.moment, "wall.%s.m", name);
    else /* discs turn about z only */
      cdem_run_put(row, "N m", at.moment[2], "wall.%s.mz", name);
    cdem_run_put_vector(row, "m", g->dim, at.moved, "wall.%s.moved_", name);
  }
}

static void put_cell(cdem_run_row *row, const cdem_run_grains *g) {
  static const char axis[] = "xyz";
  const cdem_cell *cell = row->declare ? NULL : cdem_dem_cell(&g->dem);
  for (int k = 0; g->has_cell && k < g->dim; k++)
    if (g->cell.periodic[k])
      cdem_run_put(row, "m", cell != NULL ? cell->h[4 * k] : 0.0, "cell.%c", axis[k]);
  for (int c = 1; g->has_cell && c < g->dim; c++)
    for (int r = 0; r < c; r++)
      if (g->cell.periodic[c] && g->cell.periodic[r])
        cdem_run_put(row, "m", cell != NULL ? cell->h[3 * r + c] : 0.0, "cell.%c%c", axis[r],
                     axis[c]);
}

static void put_probe(cdem_run_row *row, cdem_run_grains *g, const cdem_case_probe *probe) {
  double value = 0.0;
  if (!row->declare && row->status == CDEM_OK)
    row->status = cdem_run_grains_probe(g, probe, &value, row->fault);
  cdem_run_put(row, cdem_run_grains_unit(probe), value, "probe.%s", probe->name);
}

void cdem_run_grains_columns(cdem_run_setup *run, cdem_run_row *row) {
  cdem_run_grains *g = run->context;
  const cdem_case_values *values = cdem_run_values(run);
  put_energies(row, g);
  put_assembly(row, g);
  cdem_run_grains_triaxial_columns(g, row);
  put_walls(row, g);
  put_cell(row, g);
  for (int64_t p = 0; p < values->probes.count; p++)
    if (values->probes.item[p].group == NULL) /* others look at a body */
      put_probe(row, g, &values->probes.item[p]);
}
