/* The distribution of directions, and profiles, as tables. */
#include "dem/measures_kernels.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  const char *name, *unit;
} heading;

static cdem_status begin(int bins, int columns, const heading *column, cdem_table *table,
                         cdem_fault *fault) {
  CDEM_REQUIRE(bins >= 1 && bins <= 1000000, fault, CDEM_USAGE,
               "%d bins of a distribution; choose 1 to 1000000", bins);
  for (int c = 0; c < columns; c++)
    CDEM_TRY(cdem_table_add_column(table, column[c].name, CDEM_COLUMN_REAL, column[c].unit, fault));
  return CDEM_OK;
}

static cdem_status put_row(cdem_table *table, int values, const double *value, cdem_fault *fault) {
  CDEM_TRY(cdem_table_add_row(table, fault));
  for (int c = 0; c < values; c++)
    cdem_table_set_real(table, c, value[c]);
  return CDEM_OK;
}

/* The table is handed out whole, or not at all. */
static cdem_status end(cdem_status status, cdem_snapshot *s, double *sums, cdem_table *made,
                       cdem_table *table) {
  free(sums);
  cdem_snapshot_release(s);
  if (status == CDEM_OK)
    *table = *made;
  else
    cdem_table_release(made);
  return status;
}

static int bin_of(double place, int bins) {
  int at = (int)(place * bins);
  return at < 0 ? 0 : at < bins ? at : bins - 1;
}

/* ---- normals ---- */

static double direction_of(int dim, const double n[3]) {
  const double pi = 3.14159265358979323846;
  if (dim == 3)
    return fabs(n[2]);
  double angle = atan2(n[1], n[0]) / pi;
  return angle < 0.0 ? angle + 1.0 : angle >= 1.0 ? 0.0 : angle;
}

static cdem_status fill_normals(const cdem_snapshot *s, int bins, double *sums, cdem_table *table,
                                cdem_fault *fault) {
  static const heading columns[2][5] = {
      {{"angle", "rad"},
       {"contacts", ""},
       {"density", "1/rad"},
       {"mean_push", "N"},
       {"mean_shear", "N"}},
      {{"cosine", ""}, {"contacts", ""}, {"density", ""}, {"mean_push", "N"}, {"mean_shear", "N"}}};
  const double range = s->dim == 2 ? 3.14159265358979323846 : 1.0;
  double contacts = 0.0;
  CDEM_TRY(begin(bins, 5, columns[s->dim - 2], table, fault));
  for (int64_t k = 0; k < s->contacts; k++) {
    const cdem_dem_contact *c = &s->contact[k];
    if (c->b < 0)
      continue;
    double along = cdem_dot3(c->force, c->normal), shear[3];
    for (int i = 0; i < 3; i++)
      shear[i] = c->force[i] - along * c->normal[i];
    double *bin = sums + 3 * bin_of(direction_of(s->dim, c->normal), bins);
    bin[0] += 1.0;
    bin[1] += c->push;
    bin[2] += cdem_norm3(shear);
    contacts += 1.0;
  }
  for (int b = 0; b < bins; b++) {
    const double *bin = sums + 3 * b;
    const double row[5] = {
        (b + 0.5) * range / bins, bin[0], bin[0] * bins / (range * fmax(1.0, contacts)),
        bin[0] > 0.0 ? bin[1] / bin[0] : NAN, bin[0] > 0.0 ? bin[2] / bin[0] : NAN};
    CDEM_TRY(put_row(table, 5, row, fault));
  }
  return CDEM_OK;
}

cdem_status cdem_normal_distribution(const cdem_dem *dem, int bins, cdem_table *table,
                                     cdem_fault *fault) {
  cdem_snapshot s;
  cdem_table made = {0};
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  double *sums = cdem_allocate(bins > 0 ? 3 * (int64_t)bins : 0, sizeof *sums, fault);
  cdem_status status = sums != NULL ? fill_normals(&s, bins, sums, &made, fault) : CDEM_MEMORY;
  return end(status, &s, sums, &made, table);
}

/* ---- profiles ---- */

/* Sums of a slab: solid, grains, mass, momentum. Each grain goes through the slabs it reaches. */
static void sum_slabs(const cdem_snapshot *s, int axis, const cdem_region *whole, int bins,
                      double *sums) {
  double width = (whole->high[axis] - whole->low[axis]) / bins;
  for (int64_t i = 0; i < s->grains; i++) {
    const double *x = s->xyz + 3 * i, r = s->radius[i];
    double from = floor((x[axis] - r - whole->low[axis]) / width);
    bool inside = true;
    for (int c = 0; c < s->dim; c++)
      inside &= x[c] >= whole->low[c] && x[c] < whole->high[c];
    for (int b = from < 0.0 ? 0 : from < bins ? (int)from : bins; b < bins; b++) {
      cdem_region slab = *whole;
      slab.low[axis] = whole->low[axis] + b * width;
      slab.high[axis] = b + 1 < bins ? whole->low[axis] + (b + 1) * width : whole->high[axis];
      if (slab.low[axis] > x[axis] + r)
        break;
      sums[6 * b] += s->thickness * cdem_solid_inside(s->dim, x, r, &slab);
      if (!inside || x[axis] < slab.low[axis] || x[axis] >= slab.high[axis])
        continue;
      sums[6 * b + 1] += 1.0;
      sums[6 * b + 2] += s->mass[i];
      for (int c = 0; c < 3; c++)
        sums[6 * b + 3 + c] += s->mass[i] * s->velocity[3 * i + c];
    }
  }
}

static cdem_status fill_profile(const cdem_snapshot *s, int axis, const cdem_region *region,
                                int bins, double *sums, cdem_table *table, cdem_fault *fault) {
  static const heading columns[6] = {{"place", "m"},        {"solid_fraction", ""},
                                     {"grains", ""},        {"velocity_x", "m/s"},
                                     {"velocity_y", "m/s"}, {"velocity_z", "m/s"}};
  CDEM_REQUIRE(axis >= 0 && axis < s->dim, fault, CDEM_USAGE,
               "a profile along axis %d of a model in %d dimensions; choose 0 to %d", axis, s->dim,
               s->dim - 1);
  CDEM_TRY(begin(bins, 6, columns, table, fault));
  cdem_region whole;
  cdem_region_bounds(s, region, &whole);
  double width = (whole.high[axis] - whole.low[axis]) / bins, volume = s->thickness * width;
  for (int c = 0; c < s->dim; c++)
    volume *= c == axis ? 1.0 : whole.high[c] - whole.low[c];
  if (width > 0.0)
    sum_slabs(s, axis, &whole, bins, sums);
  for (int b = 0; b < bins; b++) {
    const double *sum = sums + 6 * b, mass = sum[2];
    const double row[6] = {whole.low[axis] + (b + 0.5) * width,
                           volume > 0.0 ? sum[0] / volume : 0.0,
                           sum[1],
                           mass > 0.0 ? sum[3] / mass : NAN,
                           mass > 0.0 ? sum[4] / mass : NAN,
                           mass > 0.0 ? sum[5] / mass : NAN};
    CDEM_TRY(put_row(table, 6, row, fault));
  }
  return CDEM_OK;
}

cdem_status cdem_solid_profile(const cdem_dem *dem, int axis, const cdem_region *region, int bins,
                               cdem_table *table, cdem_fault *fault) {
  cdem_snapshot s;
  cdem_table made = {0};
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  double *sums = cdem_allocate(bins > 0 ? 6 * (int64_t)bins : 0, sizeof *sums, fault);
  cdem_status status =
      sums != NULL ? fill_profile(&s, axis, region, bins, sums, &made, fault) : CDEM_MEMORY;
  return end(status, &s, sums, &made, table);
}
