/* Grains: what a granular model starts from. Discs (dim 2, in the plane z = 0) or spheres (dim 3).
 *
 * A grain is known by its id, its index in these arrays, for as long as the model lives; solvers
 * sort grains in space inside and answer by id. Packings make grains, io reads and writes them, the
 * solver copies what it needs.
 *
 * Mass: spheres rho 4/3 pi r^3 with inertia 2/5 m r^2; discs rho pi r^2 thickness with 1/2 m r^2.
 */
#ifndef CDEM_DEM_GRAINS_H
#define CDEM_DEM_GRAINS_H

#include "base/base.h"

#include <stdbool.h>

typedef enum {
  CDEM_GRAIN_FREE,         /* moves by its forces */
  CDEM_GRAIN_DRIVEN,       /* moves with the velocity and spin it is given, whatever its forces */
  CDEM_GRAIN_GUIDED = 0x40 /* added to bits 1 << c: only these of vx vy vz wx wy wz are given */
} cdem_grain_motion;

/* Bits of the components of velocity and spin that are given to a grain. */
static inline unsigned cdem_grain_held(unsigned motion) {
  return motion == CDEM_GRAIN_DRIVEN ? 0x3fu : motion & CDEM_GRAIN_GUIDED ? motion & 0x3fu : 0u;
}

typedef struct {
  int dim;           /* 2 or 3 */
  int64_t grains;    /* below 2^31 */
  double *xyz;       /* [grains][3] centres, m; z = 0 in 2-D */
  double *radius;    /* [grains] m, > 0 */
  double *velocity;  /* [grains][3] m/s; NULL: at rest */
  double *spin;      /* [grains][3] rad/s, in 2-D only the third; NULL: at rest */
  int32_t *material; /* [grains] index into the materials of the model; NULL: all 0 */
  uint8_t *motion;   /* [grains] cdem_grain_motion; NULL: all free */
  int64_t capacity;  /* private */
} cdem_grains;

/* Safe on zeroed grains and twice. */
void cdem_grains_release(cdem_grains *grains);
/* Appends one grain (first call after `dim` was set); arrays that are NULL stay so. */
cdem_status cdem_grains_add(cdem_grains *grains, const double xyz[3], double radius,
                            cdem_fault *fault);
/* All arrays of `motion`, `material`, `velocity`, `spin` that are NULL become zeroed arrays. */
cdem_status cdem_grains_complete(cdem_grains *grains, cdem_fault *fault);
cdem_status cdem_grains_copy(const cdem_grains *from, cdem_grains *to, cdem_fault *fault);
/* CDEM_INPUT for a radius that is not positive, a place that is not finite, z != 0 in 2-D, none at
 * all: names the grain (counted from 0) and the value. */
cdem_status cdem_grains_check(const cdem_grains *grains, cdem_fault *fault);
/* Area (2-D, m^2) or volume (3-D, m^3) of a grain. */
double cdem_grain_solid(int dim, double radius);
/* Sum of areas (2-D, m^2) or volumes (3-D, m^3). */
double cdem_grains_solid(const cdem_grains *grains);
/* Box of the grains with their radii: low, high [3]. */
void cdem_grains_box(const cdem_grains *grains, double low[3], double high[3]);

#endif
