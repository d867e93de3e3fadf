/* Measures: what a state of grains says about the medium.
 *
 * Stress is tension positive. Of contacts: 1/V sum f (x) l, f the force on A, l the branch from A
 * to B (to a wall: to the contact point; in a periodic cell: through the image). Of velocities:
 * -1/V sum m v' (x) v', v' against the mean velocity of the region.
 *
 * Region: a box. Sums over contacts count each by the part of its branch that is inside, the exact
 * mean of the line integral of stress over the box: so stress times volume adds up over regions
 * side by side. A grain belongs to the region that holds its centre (low <= x < high), its solid
 * volume counts as far as it is inside (exactly in 2-D, to 1e-9 in 3-D).
 *
 * Coarse-grained fields (Goldhirsch 2010, Granular Matter 12, 239; Weinhart et al. 2012, Granular
 * Matter 14, 289) are sums of a smooth bump (1 - r^2/w^2)^3 with integral exactly one. Density and
 * momentum integrate to exactly the mass and momentum of the grains; d rho/dt + div(momentum) = 0
 * and d(rho v)/dt + div(rho v (x) v) = div(stress) + rho g + wall_force hold at every point. The
 * integral of the bump along a branch is exact: a polynomial of degree six, by four Gauss points.
 */
#ifndef CDEM_DEM_MEASURES_H
#define CDEM_DEM_MEASURES_H

#include "dem/dem.h"
#include "results/results.h"

typedef struct {
  double low[3], high[3]; /* low >= high in a direction: all of it */
} cdem_region;

typedef struct {
  int64_t grains, contacts;  /* with centre or point in the region */
  double volume;             /* of the region (2-D: area times thickness), m^3; directions without
                                bounds: the edge of the cell, or the box of the grains */
  double solid;              /* fraction */
  double stress[9];          /* Pa, row-major [force][branch] */
  double kinetic_stress[9];  /* Pa */
  double pressure, deviator; /* -tr/dim, and sqrt(3/2 s:s) (2-D: half the difference of the
                                principal values) of the symmetric part of both stresses, Pa */
  double coordination;       /* mean number of contacts of a grain, walls too */
  double mechanical;         /* ... of those with two at least */
  double rattlers;           /* share of grains with fewer than two */
  double fabric[9];          /* mean of n (x) n over contacts of grains */
  /* Of the density of normals E(n) = (1 + a_ij n_i n_j)/(2 pi or 4 pi), a the deviator of the
   * fabric times 4 (2-D) or 15/2 (3-D): sqrt(a:a/2) in 2-D, that is 2 (F1 - F2), where E = (1 + a
   * cos 2(theta - theta_0))/(2 pi); sqrt(3/2 a:a) in 3-D. 0: isotropic. */
  double anisotropy;
  double mean_push, largest_push; /* N */
  double sliding;                 /* share of contacts at the friction bound */
} cdem_assembly;
/* region NULL: everything. */
cdem_status cdem_measure(const cdem_dem *dem, const cdem_region *region, cdem_assembly *assembly,
                         cdem_fault *fault);

/* Per grain: stress [grains][6] (xx yy zz xy yz xz; symmetric part of 1/V_grain sum f (x) arm), Pa.
 * Grain volumes times these sum to the sum over contacts. */
cdem_status cdem_grain_stress(const cdem_dem *dem, double *stress, cdem_fault *fault);
/* sqrt(3/2 s:s) of a stress xx yy zz xy yz xz, s its deviator; in 2-D of the part in the plane, as
 * if zz were the mean of the others. */
double cdem_effective_stress(int dim, const double stress[6]);

/* Per grain, nominal strain between a reference and now. The deformation gradient F is the one that
 * fits the motion of the neighbours best (least squares over the neighbours in the reference state:
 * those within `reach` mean radii of both, centre to centre; 0: 3, which is the first shell and in
 * a square lattice its diagonals). So it is exact where the motion is affine, turned or not.
 *
 * Hencky: of ln U, F = R U: volumetric ln det F, effective sqrt(2/3 e:e), e the deviator of ln U
 * (2-D: of plane strain, zz = 0 counts). Blind to rotations however large, exact for volumes, and
 * the nominal strain of small deformations. Small: the same of the symmetric part of F - 1, which
 * sees rotations of theta as a strain of 1 - cos theta. NaN where neighbours do not span space, or
 * are turned inside out (det F <= 0).
 */
typedef enum { CDEM_STRAIN_HENCKY, CDEM_STRAIN_SMALL } cdem_strain_kind;
typedef struct cdem_strain_reference cdem_strain_reference;
cdem_status cdem_strain_reference_create(const cdem_dem *dem, double reach,
                                         cdem_strain_reference **reference, cdem_fault *fault);
void cdem_strain_reference_destroy(cdem_strain_reference **reference);
/* gradient [grains][9] F - 1, row-major; volumetric, effective [grains], Hencky; NULL: not wanted.
 */
cdem_status cdem_grain_strain(const cdem_dem *dem, const cdem_strain_reference *reference,
                              double *gradient, double *volumetric, double *effective,
                              cdem_fault *fault);
/* Strains of one gradient F - 1; rotation: vector of R (angle times axis; 2-D: the third), rad.
 * Outputs that are NULL are not wanted. */
void cdem_strain_measure(int dim, cdem_strain_kind kind, const double gradient[9],
                         double *volumetric, double *effective, double rotation[3]);

/* Where strain has gathered (2-D): grains of the region whose effective strain is above half of the
 * largest in it, as one body. Its longer principal axis is the direction of a band, the ratio of
 * the two radii of gyration says whether there is one: L/w of an even strip of length L and width
 * w, 1 of a disc, sqrt 2 to 2 of a wedge. Two bands that cross are one body: choose the region so
 * that it holds one, without the corners of what pushes. */
typedef struct {
  int64_t grains;     /* above half of the largest */
  double largest;     /* effective strain; NaN: no grain in the region has one */
  double center[2];   /* m */
  double angle;       /* rad, -pi/2 .. pi/2, of the longer axis against x; NaN: no direction */
  double slenderness; /* at least 1; NaN: fewer than three grains; infinity: all on a line */
} cdem_band;
/* Of places [grains][3], m, and strains [grains] in 2-D, of which NaN does not count; region NULL:
 * everything. */
void cdem_band_find(int64_t grains, const double *xyz, const double *effective,
                    const cdem_region *region, cdem_band *band);

/* Directions of contacts between grains: bins of the angle of n to x in 0 .. pi (2-D), of |cos| to
 * z (3-D), with count, density (integral 1), mean push and mean shear force, N. */
cdem_status cdem_normal_distribution(const cdem_dem *dem, int bins, cdem_table *table,
                                     cdem_fault *fault);

/* Coarse-grained fields at the points of a grid. */
typedef struct {
  double low[3], high[3];
  int count[3]; /* points a direction, from low to high; 1: in the middle; 2-D: count[2] = 1 */
  double width; /* w: where the bump ends, m; 0: 2 mean diameters */
} cdem_coarse_grid;
typedef struct {
  int64_t points;
  double width;       /* that was used, m */
  double *xyz;        /* [points][3], x fastest */
  double *density;    /* [points] kg/m^3 (2-D: per volume of the thickness) */
  double *momentum;   /* [points][3] kg/(m^2 s) */
  double *velocity;   /* [points][3] m/s; 0 where there is no mass */
  double *stress;     /* [points][9] contacts and velocities, Pa, row-major [force][branch] */
  double *wall_force; /* [points][3] of walls on grains, N/m^3 */
  double *solid;      /* [points] fraction */
} cdem_coarse;
cdem_status cdem_coarse_fields(const cdem_dem *dem, const cdem_coarse_grid *grid,
                               cdem_coarse *fields, cdem_fault *fault);
void cdem_coarse_release(cdem_coarse *fields);

#endif
