/* Interfaces: springs with strength between the two faces of a face pair.
 *
 * Integration points are the pairs of coinciding corners, with the corner's share of the face's
 * area as A (constant traction is then exact and neighbouring points do not talk). The relative
 * displacement of a point is delta = u_1 - u_0 (side 1 minus side 0), taken apart in the frame of
 * the mid-face in the current configuration: normal n from side 0 to side 1, and tangents that turn
 * with the face (3-D: s along its first edge). Opening positive, compression F_n > 0:
 *
 *     F_n = -kn A (delta_n - delta_n^p)        F_s = -ks A (delta_s - delta_s^p)           (1)
 *     tension   -F_n <= sigma_t (1 - d) A
 *     shear     |F_s| <= max(0, F_n tan phi + c (1 - d) A)                                  (2)
 *
 * which is the incremental law of standard CDEM written with plastic (irreversible) parts.
 * Brittle: after the first failure sigma_t = c = 0 at that point. Linear softening: d is the larger
 * of the two damages D_n sigma_t/(2 G_I) and D_s c/(2 G_II) of the irreversible paths. Sliding
 * under pressure opens by dilation: D delta_n^p = tan psi |D delta_s^p|. What is dissipated in
 * excess of friction is fracture energy: in pure modes G_I, G_II per area, exactly; in mixed mode
 * at most G_I + G_II. Forces on a face add up to no force and no moment; while elastic they are the
 * gradient of the stored energy.
 *
 * Insertion `penalty`: the springs are there from the start. `tied`: the corners are tied (they
 * move as one, see cdem_ties) until the mean stress of the two cells reaches the strength on the
 * face; then the springs come in with the traction they replace, so that nothing jumps. A joint
 * starts as its law says, also with zero strength.
 *
 * When all points of a face have lost all strength and one has moved by more than `release` of the
 * face's size, the pair is released: its facets are free surface and contact takes over, starting
 * from the forces of the points.
 */
#ifndef CDEM_CDEM_INTERFACES_H
#define CDEM_CDEM_INTERFACES_H

#include "cdem/blocks.h"
#include "results/state.h"

typedef enum { CDEM_INSERTION_PENALTY, CDEM_INSERTION_TIED } cdem_insertion;
typedef enum { CDEM_SOFTENING_BRITTLE, CDEM_SOFTENING_LINEAR } cdem_softening;
typedef enum { CDEM_UNLOADING_ELASTIC, CDEM_UNLOADING_ORIGIN } cdem_unloading;

typedef struct {
  cdem_insertion insertion;
  cdem_softening softening;
  cdem_unloading unloading;
  double kn, ks;             /* Pa/m */
  double tension, cohesion;  /* Pa */
  double friction;           /* tan phi */
  double dilation;           /* tan psi, <= friction */
  double energy_1, energy_2; /* G_I, G_II, J/m^2; used by linear softening */
} cdem_interface_law;

/* CDEM_INPUT names the key and the bound: kn, ks positive; strengths and tangents not negative;
 * dilation <= friction; linear softening needs positive energies; with penalty insertion such that
 * nothing snaps back, kn >= sigma_t^2/(2 G_I), ks >= c^2/(2 G_II) (a spring that comes in loaded
 * has shed its rising branch). */
cdem_status cdem_interface_law_check(const cdem_interface_law *law, cdem_fault *fault);

/* State of one point, as shown in results. */
typedef enum {
  CDEM_INTERFACE_INTACT,
  CDEM_INTERFACE_SOFTENING,
  CDEM_INTERFACE_TENSION_FAILED,
  CDEM_INTERFACE_SHEAR_FAILED,
  CDEM_INTERFACE_STATES
} cdem_interface_state;

/* One point of the law in its own axes: what the tests of a material point drive. Stateless
 * functions below. Lengths m, tractions Pa (per area). A virgin point is all zeros (damage 1 where
 * the law has no strength). */
typedef struct {
  double plastic[3]; /* delta^p: n, s, t; with unloading to the origin its lasting part only */
  double dilated;    /* part of plastic[0] that sliding opened: where parted faces meet again */
  double opened, slipped; /* D_n, D_s: irreversible paths, m */
  double secant[2];       /* unloading to the origin: 1 - secant stiffness / (kn, ks) */
  double damage;          /* 0 .. 1 */
  double pressure;        /* at the last update, Pa */
  double credit[3];       /* J/m^2 stored when the spring came in loaded, which nobody worked on it:
                             taken off fracture and friction as damage grows, and off what is stored */
  double last[3];         /* delta at the last update, once the point has failed */
  uint8_t state;          /* cdem_interface_state */
  uint8_t falling;        /* that was the last step: the traction is still that of the strength */
} cdem_interface_point;

typedef struct {
  double stored, fracture, friction; /* J/m^2: elastic now; dissipated in this step */
} cdem_interface_work;

/* traction [3] on side 1 along (n, s, t) is F/A of (1), the force that side 1 feels: normal
 * component > 0 pushes side 1 away (compression). delta [3] in the same axes. Closed forms
 * throughout; docs/rooms/cdem-interfaces.md derives them. */
void cdem_interface_law_update(const cdem_interface_law *law, const double delta[3],
                               cdem_interface_point *point, double traction[3],
                               cdem_interface_work *work);
/* The traction of a point as it is, without history; at the last delta that of the last update. */
void cdem_interface_law_traction(const cdem_interface_law *law, const double delta[3],
                                 const cdem_interface_point *point, double traction[3]);
/* A tied point comes in at `delta`, carrying `traction` (cut back to the strength, in place). */
void cdem_interface_law_insert(const cdem_interface_law *law, const double delta[3],
                               cdem_interface_point *point, double traction[3]);
/* Whether this traction has reached the strength of an undamaged point. */
bool cdem_interface_law_reached(const cdem_interface_law *law, const double traction[3]);

/* Nodes that move as one: clusters of two or more copies. */
typedef struct {
  int32_t clusters;
  int32_t *start;  /* [clusters + 1] */
  int32_t *member; /* [start[clusters]] node ids, ascending within a cluster */
  int64_t version; /* grows whenever the clusters change */
} cdem_ties;

typedef struct cdem_interfaces_store cdem_interfaces_store;

typedef struct {
  const cdem_blocks *blocks; /* borrowed */
  int dofs;
  double thickness; /* 2-D, m */
  int laws;
  cdem_interface_law *law; /* [laws] owned copy */
  int32_t *law_of; /* [blocks->pairs] index into law; -1: no interface there (contact only) */
  bool *released;  /* [blocks->pairs] */
  cdem_ties ties;
  int64_t version; /* grows whenever stiffness or topology changes (step, contact facets) */
  cdem_interfaces_store *store;
} cdem_interfaces;

typedef struct {
  const cdem_blocks *blocks;
  int dofs;
  double thickness;
  int laws;
  const cdem_interface_law *law;
  const int32_t *law_of; /* [blocks->pairs]; -1: released from the start */
  double release;        /* fraction of the face's size, > 0; 0.05 */
  int threads;
} cdem_interfaces_options;

cdem_status cdem_interfaces_init(const cdem_interfaces_options *options,
                                 cdem_interfaces *interfaces, cdem_fault *fault);
void cdem_interfaces_release(cdem_interfaces *interfaces);

/* Adds the forces at displacements u [nodes][dofs] to force and takes the history one step on. May
 * release pairs (version grows). */
void cdem_interfaces_forces(cdem_interfaces *interfaces, const double *u, double *force);

/* Tied faces: looks for faces whose mean stress [model cells][6] has reached the strength and lets
 * them go. stress is that of the cells by *mesh cell id* (blocks->mesh), rows of others unused.
 * Returns the number of faces let go (ties.version and version grow). */
int32_t cdem_interfaces_insert(cdem_interfaces *interfaces, const double *u, const double *stress);
/* Whether any face is still tied: the solver then computes stresses each step. */
bool cdem_interfaces_any_tied(const cdem_interfaces *interfaces);

/* Totals since the start. Energies in J; areas in m^2. */
typedef struct {
  double stored, fracture, friction;
  int64_t points, softening, tension_failed,
      shear_failed;    /* of points not released plus released */
  int64_t cracks;      /* faces of which all points have lost their strength */
  double cracked_area; /* of points without strength */
} cdem_interfaces_totals;
void cdem_interfaces_sum(const cdem_interfaces *interfaces, cdem_interfaces_totals *totals);

/* Greatest squared frequency the springs add, (rad/s)^2, by Gershgorin with the nodes' masses
 * [nodes][dofs] (a tied cluster counts with its members' sum); 0 when there are none. */
double cdem_interfaces_frequency2(const cdem_interfaces *interfaces, const double *mass);
/* The same once no face is tied or released: every node alone against the springs of all its faces,
 * each of at least `least`, Pa/m (of what may take over, contact). A bound for every state to come
 * of bodies that stay where they are. */
double cdem_interfaces_open_frequency2(const cdem_interfaces *interfaces, const double *mass,
                                       double least);
/* Adds each node's spring stiffness (Gershgorin row sum, N/m) to stiffness [nodes]. */
void cdem_interfaces_row_sums(const cdem_interfaces *interfaces, double *stiffness);

/* Fields of the points, in the order of pairs and corners: point [points] of the pairs with law >=
 * 0 (released ones included). Tractions are those of the springs: 0 while tied (see the stress of
 * the cells) and after release (see contact). */
typedef struct {
  int64_t points;
  int32_t *pair;   /* [points] */
  uint8_t *corner; /* [points] */
  uint8_t *state;  /* [points] cdem_interface_state */
  uint8_t *open;   /* [points] 1 when parted (no compression and no strength) */
  double *opening; /* [points] delta_n, m */
  double *slip;    /* [points] |delta_s|, m */
  double *normal_traction, *shear_traction; /* [points] Pa, compression positive */
  double *damage;                           /* [points] */
} cdem_interface_fields;
cdem_status cdem_interfaces_fields(const cdem_interfaces *interfaces, const double *u,
                                   cdem_interface_fields *fields, cdem_fault *fault);
void cdem_interface_fields_release(cdem_interface_fields *fields);

/* Intact springs as 3x3 or 2x2 blocks for the static solution: calls add(context, node_a, node_b,
 * block [dim*dim] row-major) with K_aa, K_bb, K_ab, K_ba of every point with springs. */
void cdem_interfaces_stiffness(const cdem_interfaces *interfaces,
                               void (*add)(void *context, int32_t node_a, int32_t node_b,
                                           const double *block),
                               void *context);

/* The force (N) on side 1 of the points of a released pair when it was released: the start of its
 * contact history. force [4][3], by corner; false when the pair was free from the start. */
bool cdem_interfaces_last_force(const cdem_interfaces *interfaces, int32_t pair,
                                double force[4][3]);

cdem_status cdem_interfaces_save(const cdem_interfaces *interfaces, cdem_state *state,
                                 cdem_fault *fault);
cdem_status cdem_interfaces_restore(cdem_interfaces *interfaces, const cdem_state *state,
                                    cdem_fault *fault);

#endif
