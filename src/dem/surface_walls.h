/* Private to dem: walls where they are now, as lines (2-D) or facets (3-D), for frames and
 * pictures. Endless walls end where the grains and the other walls do. */
#ifndef CDEM_DEM_SURFACE_WALLS_H
#define CDEM_DEM_SURFACE_WALLS_H

#include "dem/dem.h"

typedef struct {
  int64_t points, facets;
  double *xyz;      /* [points][3] */
  double *velocity; /* [points][3] */
  int64_t *offset;  /* [facets + 1] into node */
  int32_t *node;    /* corners of facets; 2 in the plane, 3 or 4 in space */
  int32_t *wall;    /* [facets] */
  int64_t capacity[5];
} cdem_wall_surface;

cdem_status cdem_wall_surface_make(const cdem_dem *dem, cdem_wall_surface *surface,
                                   cdem_fault *fault);
void cdem_wall_surface_release(cdem_wall_surface *surface);

#endif
