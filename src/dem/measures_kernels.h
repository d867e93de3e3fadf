/* Private to dem: the state that measures are taken of, and their kernels on bare arrays. */
#ifndef CDEM_DEM_MEASURES_KERNELS_H
#define CDEM_DEM_MEASURES_KERNELS_H

#include "dem/measures.h"
#include "dem/surface.h"

typedef struct {
  int dim, threads;
  double thickness; /* 2-D, m; 3-D: 1 */
  double time;
  int64_t grains;
  const double *xyz, *radius, *velocity, *mass; /* by id */
  const double *displacement, *rotation, *spin, *force;
  const int32_t *touching; /* contacts of each grain */
  int64_t contacts;
  const cdem_dem_contact *contact;
  const cdem_cell *cell; /* NULL: none */
  double drift[27][3];   /* velocity of each image against the grain itself, m/s */
} cdem_snapshot;

/* Copies out what stands where; release at any stage. */
cdem_status cdem_snapshot_take(const cdem_dem *dem, cdem_snapshot *snapshot, cdem_fault *fault);
void cdem_snapshot_release(cdem_snapshot *snapshot);

/* How many threads to use. */
int cdem_snapshot_threads(const cdem_snapshot *snapshot);
/* m^3; discs: times thickness. */
double cdem_grain_volume(const cdem_snapshot *s, double radius);
/* Box of the grains with their radii; without grains 0. */
void cdem_snapshot_box(const cdem_snapshot *s, double low[3], double high[3]);
/* Bounds of a region where it has none: see cdem_assembly.volume. */
void cdem_region_bounds(const cdem_snapshot *s, const cdem_region *region, cdem_region *bounds);
/* Area (2-D) or volume (3-D) of a disc or ball inside a box. */
double cdem_solid_inside(int dim, const double centre[3], double radius, const cdem_region *box);
/* Part 0..1 of the way from `from` to `from` + `branch` inside a box. */
double cdem_branch_inside(int dim, const double from[3], const double branch[3],
                          const cdem_region *box);

void cdem_measure_kernel(const cdem_snapshot *s, const cdem_region *region,
                         cdem_assembly *assembly);
void cdem_count_kernel(const cdem_snapshot *s, const cdem_region *region, cdem_count *count);
void cdem_grain_stress_kernel(const cdem_snapshot *s, double *stress);

cdem_status cdem_strain_reference_make(const cdem_snapshot *s, double reach,
                                       cdem_strain_reference **reference, cdem_fault *fault);
void cdem_grain_gradient_kernel(const cdem_snapshot *s, const cdem_strain_reference *reference,
                                double *gradient);
cdem_status cdem_coarse_make(const cdem_snapshot *s, const cdem_coarse_grid *grid,
                             cdem_coarse *fields, cdem_fault *fault);
cdem_status cdem_free_surface_make(const cdem_snapshot *s, const cdem_surface_options *options,
                                   cdem_surface *surface, cdem_fault *fault);

/* Things with a box each, filed by place: what may reach a place is in its bucket. */
typedef struct {
  double low[3], size[3]; /* of the first bucket; of all */
  int64_t count[3];
  int64_t *start; /* [buckets + 1] into item, ascending */
  int32_t *item;
} cdem_buckets;
/* box [things][6]: low, high. Buckets are about `size` wide, at most a few a thing. */
cdem_status cdem_buckets_build(int dim, int64_t things, const double *box, double size,
                               cdem_buckets *buckets, cdem_fault *fault);
void cdem_buckets_release(cdem_buckets *buckets);
/* The bucket of a place, or -1: nothing reaches it. */
int64_t cdem_buckets_find(const cdem_buckets *buckets, const double place[3]);

/* Grains and their images that are nearer than `margin` to a box: place [count][3] and id. */
typedef struct {
  int64_t count, capacity[2];
  double *place;
  int32_t *id;
} cdem_copies;
cdem_status cdem_copies_make(const cdem_snapshot *s, const double low[3], const double high[3],
                             double margin, cdem_copies *copies, cdem_fault *fault);
void cdem_copies_release(cdem_copies *copies);

#endif
