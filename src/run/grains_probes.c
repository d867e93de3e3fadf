/* Probes of grains: what is in a region, the angle of the free surface, bands of strain. */
#include "dem/pushes.h"
#include "dem/surface.h"
#include "run/grains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { XX = 4, MAGNITUDE = 10 }; /* of `component`: x y z rotation xx yy zz yz xz xy magnitude */

const char *cdem_run_grains_unit(const cdem_case_probe *probe) {
  switch (probe->quantity) {
  case CDEM_PROBE_VELOCITY:
    return "m/s";
  case CDEM_PROBE_CENTER:
    return "m";
  case CDEM_PROBE_STRESS:
    return "Pa";
  case CDEM_PROBE_MASS:
    return "kg";
  case CDEM_PROBE_MEAN_PUSH:
  case CDEM_PROBE_BOUNDARY_PUSH:
    return "N";
  case CDEM_PROBE_SURFACE_ANGLE:
  case CDEM_PROBE_BAND_ANGLE:
    return "rad";
  default:
    return "";
  }
}

/* 2-D: (s1 - s3)/(s1 + s3), 3-D: q/p; NaN without pressure. */
static double stress_ratio(const cdem_assembly *assembly) {
  return assembly->pressure > 0.0 ? assembly->deviator / assembly->pressure : NAN;
}

static cdem_region region_of(const cdem_case_probe *probe) {
  cdem_region region;
  memcpy(region.low, probe->region.low, sizeof region.low);
  memcpy(region.high, probe->region.high, sizeof region.high);
  return region;
}

/* Also of a fabric. */
static double stress_of(const double s[9], int component) {
  static const int at[] = {0, 4, 8, 5, 2, 1}; /* xx yy zz yz xz xy, row-major */
  return s[at[component - XX]];
}

static double of_vector(const double v[3], int component) {
  return component == MAGNITUDE ? cdem_norm3(v) : v[component];
}

/* NaN where a mean is one of nothing. */
static double counted(const cdem_count *count, const cdem_case_probe *probe) {
  double mass = count->mass > 0.0 ? count->mass : NAN;
  switch (probe->quantity) {
  case CDEM_PROBE_COUNT:
    return (double)count->grains;
  case CDEM_PROBE_MASS:
    return count->mass;
  case CDEM_PROBE_CENTER:
    return of_vector(count->first, probe->component) / mass;
  default:
    return of_vector(count->momentum, probe->component) / mass;
  }
}

/* The range of the profile is that of the region along x, its axis the middle of it. */
static cdem_status surface_angle(const cdem_run_grains *g, const cdem_case_probe *probe,
                                 double *value, cdem_fault *fault) {
  const cdem_case_region *r = &probe->region;
  int upright = g->dim - 1;
  cdem_surface surface = {0};
  cdem_surface_options options = {.kind = (cdem_surface_kind)probe->surface};
  bool cone = options.kind == CDEM_SURFACE_CONE;
  double half = 0.5 * (r->high[0] - r->low[0]);
  for (int k = 0; k < g->dim; k++)
    if (r->high[k] > r->low[k])
      options.origin[k] = k == upright ? r->low[k] : cone ? 0.5 * (r->low[k] + r->high[k]) : 0.0;
  options.low = cone ? 0.0 : r->low[0];
  options.high = half > 0.0 ? (cone ? half : r->high[0]) : options.low;
  if (g->dim == 3 && !cone && r->high[1] > r->low[1]) {
    options.side_low = r->low[1];
    options.side_high = r->high[1];
  }
  CDEM_TRY(cdem_free_surface(&g->dem, &options, &surface, fault));
  *value = options.kind == CDEM_SURFACE_SLOPE ? surface.angle[0] : surface.repose;
  cdem_surface_release(&surface);
  return CDEM_OK;
}

/* Strains of all grains, once a row for all probes. */
static cdem_status look_bands(cdem_run_grains *g, cdem_fault *fault) {
  if (g->bands == NULL) {
    CDEM_NEW(g->bands, 4 * g->dem.grains, fault);
    g->bands_step = -1;
  }
  if (g->bands_step == g->dem.steps)
    return CDEM_OK;
  cdem_dem_look(&g->dem, &(cdem_dem_view){.xyz = g->bands});
  CDEM_TRY(cdem_grain_strain(&g->dem, g->strain, NULL, NULL, g->bands + 3 * g->dem.grains, fault));
  g->bands_step = g->dem.steps;
  return CDEM_OK;
}

static cdem_status band(cdem_run_grains *g, const cdem_case_probe *probe, double *value,
                        cdem_fault *fault) {
  const cdem_region region = region_of(probe);
  cdem_band found;
  CDEM_TRY(look_bands(g, fault));
  cdem_band_find(g->dem.grains, g->bands, g->bands + 3 * g->dem.grains, &region, &found);
  *value = probe->quantity == CDEM_PROBE_BAND_ANGLE ? found.angle : found.slenderness;
  return CDEM_OK;
}

static bool holds(const cdem_region *region, const double point[3]) {
  for (int c = 0; c < 3; c++)
    if (region->low[c] < region->high[c] &&
        !(point[c] >= region->low[c] && point[c] < region->high[c]))
      return false;
  return true;
}

/* NaN without contacts. */
static cdem_status mean_push(const cdem_run_grains *g, const cdem_case_probe *probe, double *value,
                             cdem_fault *fault) {
  const cdem_region region = region_of(probe);
  cdem_push_statistics found;
  cdem_push *push;
  int64_t all, inside = 0;
  int kind = probe->quantity == CDEM_PROBE_MEAN_PUSH ? CDEM_PUSH_GRAINS : CDEM_PUSH_BOUNDARY;
  CDEM_TRY(cdem_dem_pushes(&g->dem, &all, &push, fault));
  for (int64_t k = 0; k < all; k++)
    if (holds(&region, push[k].point))
      push[inside++] = push[k];
  cdem_status status = cdem_push_measure(g->dim, g->dem.grains, inside, push, 0.0, &found, fault);
  free(push);
  if (status == CDEM_OK)
    *value = found.contacts[kind] > 0 ? found.mean[kind] : NAN;
  return status;
}

static double of_assembly(const cdem_assembly *assembly, const cdem_case_probe *probe) {
  switch (probe->quantity) {
  case CDEM_PROBE_SOLID:
    return assembly->solid;
  case CDEM_PROBE_COORDINATION:
    return assembly->coordination;
  case CDEM_PROBE_MECHANICAL_COORDINATION:
    return assembly->mechanical;
  case CDEM_PROBE_RATTLERS:
    return assembly->rattlers;
  case CDEM_PROBE_ANISOTROPY:
    return assembly->anisotropy;
  case CDEM_PROBE_FABRIC:
    return stress_of(assembly->fabric, probe->component);
  case CDEM_PROBE_STRESS_RATIO:
    return stress_ratio(assembly);
  default:
    return stress_of(assembly->stress, probe->component);
  }
}

cdem_status cdem_run_grains_probe(cdem_run_grains *g, const cdem_case_probe *probe, double *value,
                                  cdem_fault *fault) {
  const cdem_region region = region_of(probe);
  cdem_count count = {0};
  cdem_assembly assembly = {0};
  switch (probe->quantity) {
  case CDEM_PROBE_SURFACE_ANGLE:
    return surface_angle(g, probe, value, fault);
  case CDEM_PROBE_BAND_ANGLE:
  case CDEM_PROBE_BAND_SLENDERNESS:
    return band(g, probe, value, fault);
  case CDEM_PROBE_MEAN_PUSH:
  case CDEM_PROBE_BOUNDARY_PUSH:
    return mean_push(g, probe, value, fault);
  case CDEM_PROBE_COUNT:
  case CDEM_PROBE_MASS:
  case CDEM_PROBE_VELOCITY:
  case CDEM_PROBE_CENTER:
    CDEM_TRY(cdem_count_region(&g->dem, &region, &count, fault));
    *value = counted(&count, probe);
    return CDEM_OK;
  default:
    CDEM_TRY(cdem_measure(&g->dem, &region, &assembly, fault));
    *value = of_assembly(&assembly, probe);
    return CDEM_OK;
  }
}
