/* The free surface of a heap or a drum, profiles along an axis, and what is in a region: numbers of
 * runs. */
#ifndef CDEM_DEM_SURFACE_H
#define CDEM_DEM_SURFACE_H

#include "dem/measures.h"

typedef enum {
  CDEM_SURFACE_HEAP,  /* two flanks, beside the highest place */
  CDEM_SURFACE_CONE,  /* 3-D, around an upright axis through `origin`: one flank, over the radius */
  CDEM_SURFACE_SLOPE, /* one flank over the whole range: a drum, an avalanche */
} cdem_surface_kind;

/* Vertical rays, four to a bin of the profile (3-D: `depth` rows of them side by side, or around
 * the axis), meet the highest grain; grains without contacts, which fly, do not count. The height
 * of a bin is that of its highest ray, in 3-D the mean over its rows. A flank is a range of bins
 * fitted by least squares: from where the height (above the foot, a mean of five bins) falls below
 * the part `flank_high` of the highest to where it falls below `flank_low`. */
typedef struct {
  cdem_surface_kind kind;
  double up[3];                 /* against gravity; 0 0 0: y in 2-D, z in 3-D */
  double along[3];              /* of the profile, across `up`; 0 0 0: x. Cone: not used */
  double origin[3];             /* where the profile counts from; its height is the foot */
  double low, high;             /* range of the profile, m; equal: of the grains (cone: from 0) */
  double side_low, side_high;   /* 3-D: range across, m; equal: of the grains */
  int bins, depth;              /* 0: about a diameter each; cone: 32 around */
  double flank_low, flank_high; /* 0, 0: 0.15, 0.85; slope: of the range, in the middle */
} cdem_surface_options;

typedef struct {
  int bins;
  double *place, *height;    /* [bins] m; NaN: no grain there */
  double crest, crest_place; /* highest bin, m */
  int flanks;
  /* Of each flank: angle to the horizontal in rad (heap, cone: positive where it falls outwards;
   * slope: positive where it rises along the profile), its standard error, scatter of the heights
   * about the line (standard deviation, m), and how many bins were fitted. NaN: fewer than three.
   */
  double angle[2], error[2], scatter[2];
  int points[2];
  double repose; /* mean of the flanks' sizes, rad */
} cdem_surface;
cdem_status cdem_free_surface(const cdem_dem *dem, const cdem_surface_options *options,
                              cdem_surface *surface, cdem_fault *fault);
void cdem_surface_release(cdem_surface *surface);

/* Slabs across axis 0, 1, 2 of a region (NULL: everything): a table of place, solid fraction,
 * grains, mean velocity of their mass. */
cdem_status cdem_solid_profile(const cdem_dem *dem, int axis, const cdem_region *region, int bins,
                               cdem_table *table, cdem_fault *fault);

typedef struct {
  int64_t grains;     /* centres in the region: low <= x < high; images of a cell count, where they
                         are and as fast as they are there */
  double mass;        /* kg */
  double first[3];    /* kg m: sum of m x; over the mass, the centre of mass */
  double momentum[3]; /* kg m/s */
  double flow[3];     /* kg/s: momentum over the extent of the region; 0 where it has no bounds */
  double kinetic;     /* J */
  double low[3], high[3]; /* of the centres; 0 without any */
} cdem_count;
cdem_status cdem_count_region(const cdem_dem *dem, const cdem_region *region, cdem_count *count,
                              cdem_fault *fault);

#endif
