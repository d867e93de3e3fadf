/* Room fdem: grains that deform (combined finite-discrete elements).
 *
 *     template.h   a grain shape: mesh, mass, modes        surface.h   its skin
 *     fdem.h       the solver (this file)                  store.h     how it holds its grains
 *
 * A grain is a free elastic body: centre of mass, a frame that turns with it, and the amplitudes q
 * of the modes of its template. Contact acts on surface nodes (Wang et al. 2024, eqs 1-3): a node
 * that is inside another grain, or beyond a wall, by d carries
 *
 *     F_n = |k d + c d'|+,  F_s = min(|k_s u_s + c_s u_s'|, mu F_n),  k = p A,  c = 2 beta sqrt(m
 * k)   (1)
 *
 * with d' and u_s' the speeds of sinking and sliding, A its tributary area and m its mass; the
 * triangle it is in takes the opposite force by its barycentric weights. Nodes of both grains of a
 * pair act.
 *
 * Time: v and w at half steps, as in the room dem. The rigid motion is explicit (angular momentum
 * is the variable, so it is kept to rounding by any shape); the modes are either explicit too, with
 * the step below 2/omega of the highest one, or implicit (backward Euler: modes the step does not
 * resolve follow their load at once, the energy that takes is in the book).
 *
 * One matrix of modes per template is applied to all its grains: two matrix-matrix products a step,
 * forces to amplitudes and amplitudes to places, in blocks of grains of fixed size. Same bits for
 * any number of threads; no absolute tolerances.
 */
#ifndef CDEM_FDEM_FDEM_H
#define CDEM_FDEM_FDEM_H

#include "dem/confinement.h"
#include "dem/walls.h"
#include "fdem/template.h"
#include "results/state.h"

/* Numbers of the contact of two materials. */
typedef struct {
  double penalty;       /* p, N/m^3, > 0 */
  double shear_ratio;   /* k_s/k, 0: 1 */
  double friction;      /* mu */
  double damping_ratio; /* beta, of both directions */
} cdem_fdem_contact_law;

typedef struct {
  int64_t grains;            /* below 2^31 */
  const double *xyz;         /* [grains][3] centres of mass, m */
  const double *radius;      /* [grains] of the ball of the same volume, m */
  const int32_t *shape;      /* [grains] template; NULL: all 0 */
  const int32_t *material;   /* [grains]; NULL: all 0 */
  const double *orientation; /* [grains][4] unit quaternions (w x y z); NULL: as in the template */
  const double *velocity, *spin; /* [grains][3] m/s, rad/s; NULL: at rest */
} cdem_fdem_grains;

typedef enum { CDEM_FDEM_IMPLICIT, CDEM_FDEM_EXPLICIT } cdem_fdem_integration;

typedef struct {
  cdem_fdem_grains grains; /* copied */
  int shapes;
  const cdem_template *shape;       /* [shapes] */
  int materials;                    /* of grains and walls */
  const double *density;            /* [materials] kg/m^3, of grains */
  const cdem_fdem_contact_law *law; /* [materials][materials], symmetric */
  int walls;
  const cdem_wall *wall;               /* planes, plates, cylinders */
  const cdem_confinement *confinement; /* a triaxial specimen with a membrane; NULL: none */
  double gravity[3];
  double mass_damping;  /* 1/s, on velocity, spin and modes */
  double damping_ratio; /* of every mode, beside what `implicit` takes: of critical */
  cdem_fdem_integration integration;
  double step;    /* s; 0: automatic, from the contacts there are */
  double safety;  /* part of the largest stable step of an automatic one; 0: 0.5 */
  double skin;    /* of the list of neighbours, in mean radii; 0: 0.1 */
  bool reference; /* one grain at a time, plain loops instead of products: slow, for tests */
  int threads;    /* 0: OpenMP's default */
} cdem_fdem_options;

/* J, since the start; signs as in cdem_dem_energies. */
typedef struct {
  double translation, rotation, vibration; /* kinetic */
  double elastic, normal, shear;           /* stored: in the grains, in the contact springs */
  double friction, damping, numerical;     /* dissipated: sliding; dashpots, mass and modal damping;
                                              by the implicit step */
  double membrane;                         /* all that it holds, contact with grains included */
  double gravity, walls; /* work; of the pressure, and of the plates on the membrane */
  double pressure;
  double initial, error, exchange;
} cdem_fdem_energies;

typedef struct cdem_fdem_store cdem_fdem_store;

typedef struct {
  int64_t grains, steps;
  double time, step;
  cdem_fdem_store *store;
} cdem_fdem;

/* CDEM_INPUT: grains, walls or numbers that cannot be, an unstable step. Borrows the templates and
 * what walls point to. Forces are those of t = 0. */
cdem_status cdem_fdem_init(const cdem_fdem_options *options, cdem_fdem *fdem, cdem_fault *fault);
void cdem_fdem_release(cdem_fdem *fdem);
/* CDEM_NUMERIC: a motion that is not finite, a grain that moves or a node that sinks in by more
 * than half a radius: names grain, time and place. */
cdem_status cdem_fdem_steps(cdem_fdem *fdem, int64_t steps, cdem_fault *fault);
/* Largest stable step for the contacts there are now. */
double cdem_fdem_limit(const cdem_fdem *fdem);
/* Lets an automatic step follow the contacts; to be called now and then, at steps that the model
 * alone decides. */
void cdem_fdem_follow(cdem_fdem *fdem);

void cdem_fdem_energies_now(const cdem_fdem *fdem, cdem_fdem_energies *energies);
/* Linear, kg m/s, and angular about the origin, at t_n - dt/2. */
void cdem_fdem_momentum(const cdem_fdem *fdem, double linear[3], double angular[3]);

/* Arrays by grain, copied out; NULL: not wanted. */
typedef struct {
  double *xyz, *velocity, *spin; /* [grains][3] of the centre; at t_n, t_n - dt/2, t_n - dt/2 */
  double *orientation;           /* [grains][4] */
  double *force;                 /* [grains][3] of all contacts */
  int32_t *contacts;             /* [grains] grains and walls touched now */
} cdem_fdem_view;
void cdem_fdem_look(const cdem_fdem *fdem, const cdem_fdem_view *view);
double cdem_fdem_mass(const cdem_fdem *fdem, int64_t grain);
const cdem_template *cdem_fdem_shape(const cdem_fdem *fdem, int64_t grain);
/* Surface nodes of a grain, borrowed: where they are, m, the contact force on each, N, and where
 * they are in the frame of the grain, from its centre, m; [surface nodes][3]. */
typedef struct {
  int32_t nodes;
  const double *now, *force, *place;
} cdem_fdem_nodes;
cdem_fdem_nodes cdem_fdem_nodes_of(const cdem_fdem *fdem, int64_t grain);

/* Nodes that touch now: force on the node, N, from partner (grain; wall: -1 - its index). */
typedef struct {
  int32_t grain, node, partner;
  double point[3], normal[3]; /* where the node is, m; normal from the grain into its partner */
  double force[3];            /* on `grain` */
  double push, depth;         /* N, m */
} cdem_fdem_touch;
cdem_status cdem_fdem_touches(const cdem_fdem *fdem, int64_t *touches, cdem_fdem_touch **touch,
                              cdem_fault *fault);
/* Force of the grains on a wall, where it is now and how fast. */
void cdem_fdem_wall_now(const cdem_fdem *fdem, int wall, double force[3], double center[3],
                        double velocity[3]);

/* ---- of a specimen ---- */
/* The high plate goes with this velocity along z from now on, in place of its servo. */
void cdem_fdem_shear(cdem_fdem *fdem, double velocity);
/* false: there is none. */
bool cdem_fdem_specimen(const cdem_fdem *fdem, cdem_specimen *now);
const cdem_membrane *cdem_fdem_membrane(const cdem_fdem *fdem);

cdem_status cdem_fdem_save(const cdem_fdem *fdem, cdem_state *state, cdem_fault *fault);
cdem_status cdem_fdem_restore(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault);

#endif
