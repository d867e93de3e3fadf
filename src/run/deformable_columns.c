/* The columns of history.csv of grains that deform: named as those of rigid grains. */
#include "run/deformable.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a row says of all grains together. */
typedef struct {
  double contacts, coordination, sliding, overlap, speed, solid, stress[9];
  double clusters;
  cdem_push_statistics pushes;
} summary;

/* ---- looking ---- */

/* Box of all grains, in which stress and solid fraction are meant. */
static double box_volume(const cdem_run_deformable *d, const double *center) {
  double volume = 1.0;
  for (int c = 0; c < 3; c++) {
    double low = INFINITY, high = -INFINITY;
    for (int64_t i = 0; i < d->fdem.grains; i++) {
      double r = d->grains->grains.radius[i];
      low = fmin(low, center[3 * i + c] - r);
      high = fmax(high, center[3 * i + c] + r);
    }
    volume *= high - low;
  }
  return volume;
}

static void sum_contacts(const cdem_run_deformable *d, int64_t contacts,
                         const cdem_dem_contact *contact, double volume, summary *found) {
  double ends = 0.0;
  for (int64_t k = 0; k < contacts; k++) {
    const cdem_dem_contact *c = &contact[k];
    ends += c->b >= 0 ? 2.0 : 1.0;
    found->sliding += c->sliding;
    found->overlap = fmax(found->overlap, c->overlap / d->grains->grains.radius[c->a]);
    for (int i = 0; i < 9; i++)
      found->stress[i] += c->force[i / 3] * c->branch[i % 3] / volume;
  }
  found->contacts = (double)contacts;
  found->coordination = ends / (double)d->fdem.grains;
  if (contacts > 0)
    found->sliding /= (double)contacts;
}

static cdem_status look_at_pushes(const cdem_run_deformable *d, summary *found, cdem_fault *fault) {
  cdem_cluster_contacts clusters;
  CDEM_TRY(cdem_run_deformable_pushes(d, &clusters, fault));
  found->clusters = (double)clusters.contacts;
  cdem_status status = cdem_push_measure(3, d->fdem.grains, clusters.contacts, clusters.contact,
                                         0.0, &found->pushes, fault);
  cdem_cluster_contacts_release(&clusters);
  return status;
}

static cdem_status look(cdem_run_deformable *d, summary *found, cdem_fault *fault) {
  cdem_dem_contact *contact = NULL;
  int64_t contacts = 0, grains = d->fdem.grains;
  double *center = NULL;
  CDEM_NEW(center, 3 * grains, fault);
  cdem_fdem_look(&d->fdem, &(cdem_fdem_view){.xyz = center, .velocity = d->velocity});
  cdem_status status = cdem_run_deformable_contacts(d, &contacts, &contact, fault);
  if (status == CDEM_OK) {
    double volume = box_volume(d, center);
    sum_contacts(d, contacts, contact, volume, found);
    found->solid = cdem_grains_solid(&d->grains->grains) / volume;
    for (int64_t i = 0; i < grains; i++)
      found->speed = fmax(found->speed, cdem_norm3(d->velocity + 3 * i));
  }
  free(contact);
  free(center);
  return status == CDEM_OK ? look_at_pushes(d, found, fault) : status;
}

/* ---- columns ---- */

static void put_energies(cdem_run_row *row, cdem_run_deformable *d) {
  cdem_fdem_energies book = {0};
  if (!row->declare)
    cdem_fdem_energies_now(&d->fdem, &book);
  cdem_run_put(row, "J", book.translation, "translation");
  cdem_run_put(row, "J", book.rotation, "rotation");
  cdem_run_put(row, "J", book.vibration, "vibration");
  cdem_run_put(row, "J", book.elastic, "elastic");
  cdem_run_put(row, "J", book.normal, "normal");
  cdem_run_put(row, "J", book.shear, "shear");
  if (d->grains->has_triaxial) {
    cdem_run_put(row, "J", book.membrane, "membrane");
    cdem_run_put(row, "J", book.pressure, "pressure");
  }
  cdem_run_put(row, "J", book.friction, "friction");
  cdem_run_put(row, "J", book.damping, "damping");
  cdem_run_put(row, "J", book.numerical, "numerical");
  cdem_run_put(row, "J", book.gravity, "gravity");
  cdem_run_put(row, "J", book.walls, "walls");
  cdem_run_put_energy_error(row, book.error, book.exchange);
}

static void put_assembly(cdem_run_row *row, cdem_run_deformable *d) {
  summary found = {0};
  if (!row->declare && row->status == CDEM_OK)
    row->status = look(d, &found, row->fault);
  cdem_run_put(row, "", found.contacts, "contacts");
  cdem_run_put(row, "", found.coordination, "coordination");
  cdem_run_put(row, "", found.sliding, "sliding");
  cdem_run_put(row, "", found.overlap, "overlap");
  cdem_run_put(row, "m/s", found.speed, "speed");
  cdem_run_put(row, "", found.solid, "solid");
  cdem_run_put(row, "", found.clusters, "clusters");
  cdem_run_put(row, "N", found.pushes.mean[CDEM_PUSH_GRAINS], "mean_push");
  cdem_run_put(row, "N", found.pushes.mean[CDEM_PUSH_BOUNDARY], "boundary_push");
  cdem_run_put(row, "", found.pushes.anisotropy, "anisotropy");
  cdem_run_put(row, "", found.pushes.mechanical, "mechanical");
  cdem_run_put(row, "", found.pushes.rattlers, "rattlers");
  cdem_run_put_stress(row, 3, found.stress);
}

static void put_walls(cdem_run_row *row, const cdem_run_deformable *d) {
  for (int w = 0; w < d->grains->walls; w++) {
    const cdem_wall *wall = &d->grains->wall[w];
    double force[3] = {0.0}, center[3] = {0.0}, velocity[3], moved[3];
    if (!row->declare)
      cdem_fdem_wall_now(&d->fdem, w, force, center, velocity);
    for (int k = 0; k < 3; k++)
      moved[k] = center[k] - wall->center[k];
    cdem_run_put_vector(row, "N", 3, force, "wall.%s.f", wall->name);
    cdem_run_put_vector(row, "m", 3, moved, "wall.%s.moved_", wall->name);
  }
}

void cdem_run_deformable_columns(cdem_run_setup *run, cdem_run_row *row) {
  cdem_run_deformable *d = cdem_run_deformable_of(run);
  put_energies(row, d);
  put_assembly(row, d);
  put_walls(row, d);
  cdem_run_deformable_triaxial_columns(d, row);
}
