/* Private to dem: pictures of a state on bare arrays. */
#ifndef CDEM_DEM_PICTURES_KERNELS_H
#define CDEM_DEM_PICTURES_KERNELS_H

#include "dem/measures_kernels.h"
#include "dem/pictures.h"
#include "dem/surface_walls.h"

/* value [grains]: the field, NaN: grey; NULL for chains and arrows. */
cdem_status cdem_picture_make(const cdem_snapshot *s, const cdem_wall_surface *walls,
                              const double *value, const cdem_picture *picture, cdem_map *map,
                              cdem_fault *fault);

/* How the picture looks at the grains. */
typedef struct {
  double right[3], up[3], into[3];
  bool flat, cut; /* 2-D; across a plane */
  double plane;   /* depth of the cut */
  double reach;   /* half the thickness of what chains and arrows are shown of */
  double mean_radius;
  double most; /* upper end of the range that is given; 0: none */
  cdem_region window;
  const uint8_t *left_out;
} cdem_picture_eye;

/* Is a place in the window? */
bool cdem_picture_shows(const cdem_picture_eye *eye, const double xyz[3]);

/* pictures_solid.c: spheres in front, lit. */
cdem_status cdem_picture_spheres(const cdem_snapshot *s, const cdem_picture_eye *eye,
                                 const double *value, cdem_map *map, cdem_fault *fault);

#endif
