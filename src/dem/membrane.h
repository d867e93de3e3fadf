/* A flexible membrane around a specimen: a triangulated tube with an upright axis, z.
 *
 * It knows nothing of what it holds. Its host (a solver of grains, rigid or deformable) finds what
 * touches the nodes, adds those forces to `contact`, and moves the membrane along with itself. Time
 * is that of the solvers here: places x at t_n, velocities v at t_n - dt/2, forces at t_n.
 *
 * Nodes stand in rings from the low end to the high one, `around` a ring, every other ring turned
 * by half a spacing, so that the triangles of the tube at rest are nearly equilateral. Node = ring
 * * around + place. Rings 0 and rings - 1 follow the plates along z; across they are free, or held
 * where they started (`clamped`). A node is a penalty point of stiffness penalty * area, area its
 * part of the tube at rest.
 *
 * Forces (docs/theory/triaxial.md has the equations, tests/dem/membrane.c the closed forms):
 *   pressure   on the faces as they are now: -p n/3 at each corner, n the face's area vector.
 *              Exactly p times the gradient of the enclosed volume, but at the end rings.
 *   stretch    constant-strain triangles, St Venant-Kirchhoff in plane stress: Young * thickness.
 *   bending    stiffness `bending` B, against differences between neighbours only: E = sum of
 *              b/2 (g Dx^2 + g Dy^2 + Dz^2), D = sum over the neighbours of (x_j - x_i) + c (x_i -
 *              mean of the ring), c such that D = 0 on a round tube of any radius, g = R^2 over the
 *              mean square distance of the ring from its middle, so that E does not change when the
 *              tube, however crumpled, swells. At the end rings the two neighbours in the ring
 *              count. B (w'')^2/2 where w varies slowly. No hoop force, no mean lateral stress.
 *
 * Why bending and hardly any stretch: a tension T that spans gaps between grains adds T/R to the
 * confining pressure, and T is pressure times the radius to which the membrane bulges, of the order
 * of a grain; so a coarse specimen would be confined by up to d/R more than it is told. Bending
 * spans gaps and leaves the mean stress at p exactly, since a cut through the specimen meets no
 * membrane force: it filters deflections shorter than a few grains.
 *
 * Sizes follow from dimensionless numbers (cdem_membrane_complete), so that a scaled specimen has a
 * scaled membrane. No leak: between three nodes at distance s a sphere of radius r sinks in by the
 * sagitta r - sqrt(r^2 - s^2/3) before it touches them; s <= r is asked for, where that is 0.18 r,
 * and s = 2r/3 is taken, 0.08 r.
 *
 * Each ring's forces are gathered in a fixed order: the same bits for any number of threads.
 */
#ifndef CDEM_DEM_MEMBRANE_H
#define CDEM_DEM_MEMBRANE_H

#include "base/base.h"
#include "base/series.h"
#include "results/state.h"

#include <stdbool.h>

typedef struct {
  double center[2];         /* of the axis, x and y, m */
  double radius, low, high; /* m */
  double spacing;           /* of nodes, wanted, m; the mesh has the next smaller one that fits */
  double areal_density;     /* kg/m^2 */
  double young, poisson;    /* Pa, -; young 0: no stretch */
  double thickness;         /* m */
  double bending;           /* B, N m; 0: none */
  double damping;           /* of bending: ratio to critical of its highest mode, 0 .. 1 */
  double penalty;           /* Pa/m of the nodes' area against what they touch */
  double contact_damping;   /* beta: dashpot 2 beta sqrt(m k), m the node's mass */
  bool clamped;             /* end rings do not move across the axis */
  cdem_series pressure;     /* outside minus inside, Pa, of time; borrowed */
} cdem_membrane_options;

/* J; works since the start. stored + kinetic + damping - pressure - plates is what the contacts of
 * the host have given it. */
typedef struct {
  double kinetic, stretch, bending; /* now */
  double pressure, plates;          /* work of the pressure; of what moves the end rings */
  double damping;                   /* dissipated */
} cdem_membrane_energies;

typedef struct {
  double volume;  /* enclosed, with fans to the middle of the end rings, m^3 */
  double rate;    /* dV/dt with v (of half a step before), m^3/s */
  double area;    /* of the faces, m^2 */
  double height;  /* between the means of the end rings, m */
  double lateral; /* what the host's contacts push outwards by, Pa: sum of w rho . contact over sum
                     of w rho . (area vector), rho from the middle of the ring, w = sin^2 from 0 at
                     the ends to 1: clamped ends carry a part of the pressure next to them */
} cdem_membrane_shape;

typedef struct cdem_membrane_store cdem_membrane_store;

typedef struct {
  cdem_membrane_options options;
  int32_t rings, around;
  int32_t nodes, faces;
  int32_t *face;   /* [faces][3] corners, normals point outwards */
  double *start;   /* [nodes][3] places at rest, m */
  double *x, *v;   /* [nodes][3] m, m/s */
  double *force;   /* [nodes][3] all, contact included, N */
  double *contact; /* [nodes][3] the host's: set before cdem_membrane_gather */
  double *mass;    /* [nodes] kg */
  double *area;    /* [nodes] at rest, m^2 */
  double pressure; /* now, Pa */
  double drag;     /* mass damping now, 1/s: the host's to set */
  double spacing;  /* around a ring at rest, m */
  cdem_membrane_store *store;
} cdem_membrane;

/* Fills what is 0 by dimensionless numbers: d the smallest diameter and `density` that of the
 * grains, p the pressure it is to carry (its largest value):
 *     spacing d/3               penalty 1000 p/d           young * thickness p d/10
 *     thickness d/100           bending p d^3/10           areal density density d/2
 *     damping 0.2               contact damping 0.2 */
void cdem_membrane_complete(cdem_membrane_options *options, double pressure, double diameter,
                            double density);
/* CDEM_INPUT: a size that cannot be; names it. diameter > 0: smallest grain, for the leak bound. */
cdem_status cdem_membrane_check(const cdem_membrane_options *options, double diameter,
                                cdem_fault *fault);
/* How many nodes such a tube has. */
int64_t cdem_membrane_nodes(const cdem_membrane_options *options);
/* A tube at rest, unstressed, with the forces of the pressure at t = 0 not yet evaluated. */
cdem_status cdem_membrane_create(const cdem_membrane_options *options, cdem_membrane *membrane,
                                 cdem_fault *fault);
void cdem_membrane_release(cdem_membrane *membrane);

/* ---- a step of the host ----
 *
 *     cdem_membrane_move   (one call)          places of t_n+1
 *     cdem_membrane_look   (rings, any order)  the faces and differences of a ring
 *     host: contact        (any order)
 *     cdem_membrane_gather (rings, any order)  forces of t_n+1
 * Between the four the host waits for all its threads. */

/* v += dt F/m, x += dt v; end rings go with these velocities along z. Returns the largest squared
 * distance of a node from where it was at cdem_membrane_mark. */
double cdem_membrane_move(cdem_membrane *membrane, double step, double low, double high);
/* From where distances are counted (new lists of neighbours). */
void cdem_membrane_mark(cdem_membrane *membrane);
/* The pressure from now on. */
void cdem_membrane_set_time(cdem_membrane *membrane, double time);
void cdem_membrane_look(cdem_membrane *membrane, int32_t ring);
void cdem_membrane_gather(cdem_membrane *membrane, int32_t ring);
/* All rings: look and gather. */
void cdem_membrane_evaluate(cdem_membrane *membrane, double time);
/* Velocities of half a step before, so that those at t_n stay what they are; old 0: v is now that
 * of t_n (at the start). */
void cdem_membrane_change_step(cdem_membrane *membrane, double old, double step);

/* Push of a node on what it overlaps by `overlap` > 0, closing at the speed `closing`; never pulls.
 * *lost: power of the dashpot, W. */
static inline double cdem_membrane_push(double stiffness, double dashpot, double overlap,
                                        double closing, double *lost) {
  double spring = stiffness * overlap, push = spring + dashpot * closing;
  push = push > 0.0 ? push : 0.0;
  *lost = (push - spring) * closing;
  return push;
}

/* ---- looking ---- */
/* Enclosed volume, of the last look (cheap), and between which mean heights. */
double cdem_membrane_volume(const cdem_membrane *membrane);
void cdem_membrane_shape_now(const cdem_membrane *membrane, cdem_membrane_shape *shape);
void cdem_membrane_energies_now(const cdem_membrane *membrane, double step,
                                cdem_membrane_energies *energies);
/* Outward area vector of a node: a third of those of its faces, m^2. */
void cdem_membrane_normal(const cdem_membrane *membrane, int32_t node, double normal[3]);
/* Bounds of the largest eigenvalues of stiffness and damping by mass of all but contacts, 1/s^2 and
 * 1/s, stretches up to 2 allowed for: dt <= 4/(c + sqrt(c^2 + 4 k)), with the contacts' added. */
void cdem_membrane_bounds(const cdem_membrane *membrane, double *k, double *c);

/* What changes: "membrane/...". */
cdem_status cdem_membrane_save(const cdem_membrane *membrane, cdem_state *state, cdem_fault *fault);
cdem_status cdem_membrane_restore(cdem_membrane *membrane, const cdem_state *state,
                                  cdem_fault *fault);

#endif
