/* Packings: grains put in place before anything moves. One file = packing_NAME.c + one line in
 * packings.def.
 *
 * square     2-D. Touching rows and columns turned by 45 degrees: places on rows and columns of
 *            spacing sqrt(2) r, of which every second one is taken, so that a disc touches four
 *            others along the diagonals. The top row is tangent to the top of the box and its discs
 *            stand at odd columns to both sides of the middle of the box (none in the middle), the
 *            next at even columns, and so on down. Numbered row by row from the bottom, left to
 *            right. With centres_inside this is the counting rule of Li & Wan's foundation: 7.0 x
 *            3.5 m gives 2426 discs for r = 0.05 m and 6765 for r = 0.03 m
 * hexagonal  2-D: touching rows. 3-D: hexagonal close packing, layers normal to z stacked ABAB
 * cubic      2-D, 3-D: touching along the axes
 * inward     2-D. Random and dense, built from the boundary inwards: each new disc touches two
 *            things that are there, discs or sides of the box (after Bagi 2005, Granular Matter 7,
 *            31-43). Any sizes; ends when no place is left
 * loose      2-D, 3-D. Random, without contacts, any sizes; in a box, a tube, or periodic.
 *            `compact` presses it together. A count of a table of sizes has as many of each class
 *            as its share says, to rounding
 *
 * Touching lattices touch to rounding: gaps and overlaps of neighbours are of the order of 1e-16
 * times the coordinates, of either sign. A law that acts on overlap > 0 sees some of these contacts
 * and not others, with forces of rounding size; who asks which grains touch (bonds, coordination)
 * does so with a gap below a fraction of the radius, 1e-6 say, never with overlap > 0.
 *
 * Every packing is a function of its options alone: same seed, same bits, whatever the threads, and
 * options scaled by a power of two give places and radii scaled by it.
 */
#ifndef CDEM_DEM_PACKING_H
#define CDEM_DEM_PACKING_H

#include "base/progress.h"
#include "dem/grains.h"

/* Sizes: how radii are drawn. */
typedef enum {
  CDEM_SIZES_EQUAL,   /* radius */
  CDEM_SIZES_UNIFORM, /* between least and most by number */
  CDEM_SIZES_POWER,   /* number density ~ r^exponent between least and most */
  CDEM_SIZES_NORMAL,  /* mean `radius`, standard deviation `spread`, cut at least and most */
  CDEM_SIZES_TABLE,   /* classes: radius [entries], fraction of the solid volume (area) [entries] */
  CDEM_SIZES_KINDS
} cdem_size_kind;

typedef struct {
  cdem_size_kind kind;
  double radius, least, most, exponent, spread; /* m, -, m */
  int entries;
  const double *class_radius, *class_fraction; /* 1000 at most, ascending; borrowed */
} cdem_sizes;

/* "equal", "uniform", "power", "normal", "table"; NULL past the last. */
const char *cdem_size_kind_name(int kind);
cdem_status cdem_sizes_check(const cdem_sizes *sizes, cdem_fault *fault);
double cdem_sizes_largest(const cdem_sizes *sizes);
double cdem_sizes_smallest(const cdem_sizes *sizes);
/* The radius below which this share of the grains by number lies, 0 <= share < 1. */
double cdem_sizes_quantile(int dim, const cdem_sizes *sizes, double share);
/* Share of the grains, by number, with a radius up to this one. */
double cdem_sizes_share(int dim, const cdem_sizes *sizes, double radius);
/* Mean area (2-D, m^2) or volume (3-D, m^3) of a grain; of a table exact, else from quantiles. */
double cdem_sizes_mean_solid(int dim, const cdem_sizes *sizes);
/* Draws one radius by number. */
double cdem_sizes_draw(int dim, const cdem_sizes *sizes, cdem_random *random);

typedef struct {
  int dim;
  double low[3], high[3]; /* box, m (2-D: z ignored) */
  bool centres_inside;    /* lattices: centres in the box, else whole grains */
  bool cylinder;          /* loose, 3-D: the tube about z inscribed in the box */
  bool periodic[3];       /* loose: overlaps are looked for through these faces (2-D: z ignored) */
  cdem_sizes sizes;
  int64_t count;   /* loose: how many; 0: by fraction */
  double fraction; /* loose: of the area or volume of the box (tube) */
  uint64_t seed;
  const cdem_progress *progress;
} cdem_packing_options;

typedef struct {
  const char *name, *help;
  bool dims[4];
  bool lattice; /* sizes must be equal; knows centres_inside */
  bool loose;   /* knows count, fraction, periodic, cylinder */
  cdem_status (*make)(const cdem_packing_options *options, cdem_grains *grains, cdem_fault *fault);
} cdem_packing;
const cdem_packing *cdem_packing_at(int index); /* NULL past the last */
const cdem_packing *cdem_packing_find(const char *name);
/* Checks the options, then makes new grains (what was in `grains` is not released). CDEM_INPUT:
 * what cannot be; CDEM_NUMERIC: no place was found for so many (says how many fitted and what
 * fraction that is). */
cdem_status cdem_packing_make(const cdem_packing *packing, const cdem_packing_options *options,
                              cdem_grains *grains, cdem_fault *fault);
/* Area or volume that fractions are of: the box, or the tube in it. */
double cdem_packing_room(const cdem_packing_options *options);

/* How grains stand to each other: the largest overlap in radii of the smaller grain of the pair
 * (negative: the smallest gap that was looked for, none: -INFINITY), and the mean number of
 * neighbours with a gap below `near` radii of the smaller one. Faces of the box low, high are
 * periodic where asked for. */
typedef struct {
  double overlap, coordination;
  int64_t pair[2]; /* of the largest overlap; -1: none */
} cdem_packing_contacts;
cdem_status cdem_packing_look(const cdem_grains *grains, const double low[3], const double high[3],
                              const bool periodic[3], double near, cdem_packing_contacts *contacts,
                              cdem_fault *fault);

/* Presses grains together with the solver, without gravity, until target and rest are reached:
 * walls of the box (periodic directions: the cell) move inwards. Friction decides how dense: 0
 * gives the densest random packing (0.64 for equal spheres). The box shrinks about its low corner,
 * by the same ratio in all directions; its walls have no friction.
 *
 * The strain rate is bounded by the inertial number I = rate d sqrt(density/pressure), a
 * hundredfold (I at most 0.1) while there is hardly any pressure; energy is drained by inelastic
 * contacts and local damping. A fraction alone has no pressure: grains are then as stiff as sets
 * the clock, and the packing is refused as jammed where overlaps would exceed 1e-2 radii.
 *
 * A cylinder keeps its radius: the plate above comes down to a height or a fraction. How many
 * grains there are is then given with it, so overlaps are what is left over: the packing is jammed
 * where they would exceed 1e-1 radii in the mean. */
typedef struct {
  double fraction;  /* of solid in the box; 0: by pressure or height */
  double pressure;  /* Pa; 0: by fraction or height */
  double height;    /* of a cylinder, m; 0: by fraction or pressure */
  double thickness; /* of discs, m; 0: 1 m */
  double stiffness; /* normal, N/m, of the whole thickness in 2-D; 0: from pressure so that overlaps
                       stay below 1e-3 radii */
  double friction, restitution; /* restitution 0: 0.5 */
  double inertial;              /* inertial number of the compaction, 0: 1e-3 */
  double density;               /* kg/m^3; 0: 2600 */
  double tolerance; /* of pressure, and of unbalanced forces against the mean contact, 0: 1e-2; in a
                       cylinder the mean of the grains' forces, else the largest */
  bool periodic[3];
  int threads;
  const cdem_progress *progress;
} cdem_compaction;
typedef struct {
  double low[3], high[3];                              /* the box at the end */
  double fraction, pressure, unbalanced, most_overlap; /* reached; overlap in radii */
  double coordination;                                 /* contacts a grain that has any */
  int64_t steps;
} cdem_compacted;
/* Makes the cylinder of the options so high that its grains, loosely put in, fill no more than 0.3
 * of it; one that is higher stays. Does nothing unless a height and a count are given. */
void cdem_packing_make_room(cdem_packing_options *options, const cdem_compaction *compaction);
/* grains: in the box of the options, without overlaps, at rest (velocities are not looked at);
 * afterwards where they came to rest, velocities and spins zero. CDEM_INPUT: no target or two, a
 * fraction below that of the start, a height that is none of a cylinder or above that of the start;
 * CDEM_NUMERIC: jammed before the fraction was reached (says at which), or no rest after very many
 * steps. Grains are then as they were. */
cdem_status cdem_packing_compact(const cdem_packing_options *options,
                                 const cdem_compaction *compaction, cdem_grains *grains,
                                 cdem_compacted *compacted, cdem_fault *fault);

#endif
