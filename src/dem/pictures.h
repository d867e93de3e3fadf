/* Pictures of a state: grains coloured by a field, force chains, velocities. What is drawn goes
 * into a map (results/map.h), which io makes a file of.
 *
 * Discs are seen as they are. Of spheres, either those in front as seen along `view`, lit, in a
 * scale bar's picture; or, cut by a plane, the circles of the cut. Chains and arrows of spheres are
 * those within a mean diameter of the plane.
 *
 * Colours reach to where all but one grain in a hundred are below them; what is beyond has the
 * colour of the end. Values that are the same or unknown (NaN) everywhere are drawn grey.
 */
#ifndef CDEM_DEM_PICTURES_H
#define CDEM_DEM_PICTURES_H

#include "dem/measures.h"
#include "results/map.h"

/* Name, label of the colour bar, is it signed, does it need a strain reference? */
typedef enum {
  CDEM_GRAIN_RADIUS,
  CDEM_GRAIN_SPEED,
  CDEM_GRAIN_DISPLACEMENT,
  CDEM_GRAIN_ROTATION,         /* 2-D: with its sign; 3-D: size */
  CDEM_GRAIN_PRESSURE,         /* -tr/dim of the stress of the grain */
  CDEM_GRAIN_EFFECTIVE_STRESS, /* sqrt(3/2 s:s), s its deviator (2-D: in the plane) */
  CDEM_GRAIN_VOLUMETRIC_STRAIN,
  CDEM_GRAIN_EFFECTIVE_STRAIN,
  CDEM_GRAIN_CONTACTS,
  CDEM_GRAIN_FIELDS
} cdem_grain_field;
/* "effective_strain"; NULL past the last. */
const char *cdem_grain_field_name(int field);
/* -1: there is none of this name. */
int cdem_grain_field_find(const char *name);

typedef enum {
  CDEM_PICTURE_GRAINS, /* coloured by `field`, with rims */
  CDEM_PICTURE_BAND,   /* coloured by `field`, without: bands of strain */
  CDEM_PICTURE_CHAINS, /* lines between centres as wide and as bright as their push, over pale
                          grains; those with fewer than two contacts paler */
  CDEM_PICTURE_ARROWS  /* velocities over pale grains; of many grains one in each square */
} cdem_picture_kind;

typedef struct {
  cdem_picture_kind kind;
  cdem_grain_field field;
  const cdem_strain_reference *strain; /* for fields of strain, else NULL */
  const char *title;                   /* NULL: none. Borrowed by the map */
  double value_min, value_max;         /* equal: automatic. Chains: pushes in N in place of those
                                          over their mean, a fifth of the larger as wide as the mean
                                          else; arrows are as long as it says */
  double view[3], up[3]; /* 3-D, from the eye into the picture; 0 0 0: along y, z up */
  bool slice;            /* 3-D: cut across `view` through `through` */
  bool middle;           /* ... or through the middle of the grains */
  double through[3];
  cdem_region window;      /* only grains with centres in it are drawn */
  const uint8_t *left_out; /* [grains] by id, 1: not drawn; NULL: none */
  bool no_walls;
} cdem_picture;

/* CDEM_USAGE: a field of strain without its reference. */
cdem_status cdem_dem_picture(const cdem_dem *dem, const cdem_picture *picture, cdem_map *map,
                             cdem_fault *fault);

#endif
