/* The solver: a body, its interfaces and contacts, what acts on them, and time.
 *
 * State: displacements u at t_n and velocities v at t_n - dt/2 (central differences, leapfrog), and
 * the forces at t_n. cdem_solver_step moves the state by one step and evaluates the forces there:
 *
 *     (m + dt/2 c) v_{n+1/2} = (m - dt/2 c) v_{n-1/2} + dt (F_n + F_local)                   (1)
 *     u_{n+1} = u_n + dt v_{n+1/2}
 *
 * c: mass-proportional damping a m and the dashpots of quiet boundaries (3x3 a node, taken
 * implicitly: they never limit the step). F_local = -alpha |F| sign(v) (Cundall). Prescribed
 * components follow their series exactly at t_{n+1}. Tied nodes move with their common force and
 * mass. F_local takes the sign of the velocity at t_n itself, (v_{n-1/2} + v_{n+1/2})/2, and stops
 * what it would turn around: it never adds energy. Where the step changes, dt in (1) is the mean of
 * the old and the new one.
 *
 * Energy book, exact for linear forces: kinetic energy at t_n is m v_{n-1/2} v_{n+1/2}/2, the work
 * of a force over a step (F_n + F_{n+1})/2 . (u_{n+1} - u_n); with these the book closes to
 * rounding but for the curvature of nonlinear energies within a step.
 *
 * The step is safety * 2/omega, omega^2 the sum of the bounds of body, interfaces, four times
 * contact and plates; it is looked at again whenever their versions change, and never grows by less
 * than a quarter.
 *
 * All pointers of the options are borrowed and must outlive the solver.
 */
#ifndef CDEM_CDEM_SOLVER_H
#define CDEM_CDEM_SOLVER_H

#include "base/series.h"
#include "cdem/body.h"
#include "cdem/contact.h"
#include "cdem/interfaces.h"

/* One component of some nodes follows a function of time. */
typedef struct {
  const char *name; /* for reports: the group */
  int component;    /* 0 .. dofs - 1 */
  bool velocity;    /* series is m/s (its integral is followed), else m; rad for omega */
  cdem_series series;
  int32_t nodes;
  const int32_t *node;
} cdem_support;

/* Dead loads: vector [nodes][dofs] (N, Cosserat N m) times series(t). */
typedef struct {
  const char *name;
  cdem_series series;
  int32_t nodes;
  const int32_t *node;
  const double *vector;
} cdem_load;

/* Pressure (Pa, positive pushes in) on facets, following the surface. */
typedef struct {
  const char *name;
  cdem_series series;
  int32_t facets;
  const int32_t *facet; /* into blocks->facet */
} cdem_pressure;

/* Viscous boundary (Lysmer & Kuhlemeyer 1969): traction -rho c_p v_n n - rho c_s v_t. */
typedef struct {
  int32_t facets;
  const int32_t *facet;
  const double *impedance; /* [facets][2] rho c_p, rho c_s, Pa s/m */
} cdem_quiet;

/* A rigid plate that pushes surface nodes (all nodes of facets; overlap against the node's share of
 * the surface area) and reports its force. Finite when half > 0: nodes beyond its edges do not
 * touch, nor do those that come below its face from the side. */
typedef struct {
  const char *name;
  double point[3], normal[3]; /* a point of the face, and out of the plate towards the body; unit */
  double axis[3];             /* in-plane direction of half[0]; half[1] is along normal x axis */
  double half[2];             /* m; 0: infinite */
  cdem_series velocity[3];    /* m/s */
  double kn, kt;              /* Pa/m */
  double friction;
} cdem_plate;

typedef struct {
  cdem_body *body;
  const cdem_blocks *blocks;   /* NULL: no interfaces, contact, pressure, quiet, plates */
  cdem_interfaces *interfaces; /* NULL: none */
  cdem_contact *contact;       /* NULL: none */
  double thickness;            /* 2-D, m */
  int supports;
  const cdem_support *support;
  int loads;
  const cdem_load *load;
  int pressures;
  const cdem_pressure *pressure;
  int quiets;
  const cdem_quiet *quiet;
  int plates;
  const cdem_plate *plate;
  double gravity[3];      /* m/s^2 */
  double mass_damping;    /* a, 1/s */
  double local_damping;   /* alpha, 0 <= alpha < 1 */
  double step;            /* s; 0: automatic. CDEM_INPUT when it is unstable */
  double safety;          /* of the automatic step, 0 < safety <= 1; 0: 0.8 */
  const double *velocity; /* [nodes][dofs] initial, m/s; NULL: rest */
  bool fictitious_mass;   /* relaxation: masses such that every node's own critical step is 1 */
  int threads;
} cdem_solver_options;

/* J. Works are of the forces on the body since the start. */
typedef struct {
  double kinetic, elastic, interface, contact, plate; /* stored now */
  double fracture, friction, damping, quiet; /* dissipated (damping: mass, local, contact) */
  double load, gravity, support;             /* work of loads and pressures, gravity,
                                                prescribed motions of nodes and plates */
  double initial;                            /* energy at the start */
  double step;     /* by which changes of the time step have shifted the leapfrog's measure of the
                      kinetic     energy: no work, of second order in the step */
  double error;    /* stored + dissipated - work - initial - step */
  double exchange; /* scale of the error: the largest of all terms so far seen at a report */
} cdem_energy_book;

typedef struct cdem_solver_store cdem_solver_store;

typedef struct {
  const cdem_solver_options *options; /* copied inside */
  int32_t nodes;
  int dofs;
  int64_t steps;
  double time, step; /* t_n, the present dt */
  double *u;         /* [nodes][dofs] at t_n */
  double *v;         /* [nodes][dofs] at t_n - dt/2 */
  double *force;     /* [nodes][dofs] all forces but reactions and damping, at t_n */
  double *external;  /* [nodes][dofs] of loads, pressures and gravity in force */
  double *applied;   /* [nodes][dofs] forces at t_n of a coupled solver, added (beside `force`) when
                        the   velocities are moved: set them between steps; zero at first */
  cdem_solver_store *store;
} cdem_solver;

/* CDEM_INPUT: an unstable step was asked for (names the limit and where it comes from), two
 * supports that prescribe one component of one node differently (names both and the node).
 * Evaluates the forces at t = 0. */
cdem_status cdem_solver_init(const cdem_solver_options *options, cdem_solver *solver,
                             cdem_fault *fault);
void cdem_solver_release(cdem_solver *solver);

/* One step. CDEM_NUMERIC when the motion is no longer finite or an element turned inside out: names
 * time, node or element with its place, and the likely cause; the state is that of the failure. */
cdem_status cdem_solver_step(cdem_solver *solver, cdem_fault *fault);

/* Largest stable step now, s, and what limits it ("element 17", "interfaces", "contact"). */
double cdem_solver_limit(const cdem_solver *solver, char limiter[64]);

/* Static solution of the linear network (intact interfaces as springs, tied nodes as one) for the
 * loads and supports at `time`, by CHOLMOD; u is overwritten. CDEM_INPUT: not enough supports
 * (names the rigid motions that are free), a plate or contact (static runs know neither), a
 * material without tension (it is not linear). */
cdem_status cdem_solver_static(cdem_solver *solver, double time, cdem_fault *fault);

/* Ratio of the largest unbalanced nodal force (free components) to the mean nodal force (mean over
 * the nodes of the sum of absolute element, interface and external forces): FLAC's measure of
 * equilibrium. */
double cdem_solver_unbalanced(const cdem_solver *solver);

void cdem_solver_energies(cdem_solver *solver, cdem_energy_book *book);

/* Reaction of a support, N: the sum over its nodes of what must be added to hold them (shared
 * nodes count for each; what holds a tied cluster is shared by its members that are held). Plate:
 * force of the body on the plate, and how far it has moved. */
double cdem_solver_reaction(const cdem_solver *solver, int support);
void cdem_solver_plate(const cdem_solver *solver, int plate, double force[3], double moved[3]);

/* What holds or pushes some nodes (ascending), [dofs], N: the sum of loads, pressures and what is
 * missing to equilibrium over their points, each tied cluster taken whole and once. */
void cdem_solver_held(const cdem_solver *solver, int32_t nodes, const int32_t *node,
                      double force[3]);

/* Velocity at t_n, (v_{n-1/2} + v_{n+1/2})/2, [nodes][dofs]. */
void cdem_solver_velocity(const cdem_solver *solver, double *velocity);
/* Linear momentum (dim), kg m/s, and angular momentum about the origin, at t_n - dt/2. */
void cdem_solver_momentum(const cdem_solver *solver, double linear[3], double angular[3]);

/* Everything that changes, the histories of interfaces and contact included. Restoring needs a
 * solver made from the same options; it then continues to the same bits. */
cdem_status cdem_solver_save(const cdem_solver *solver, cdem_state *state, cdem_fault *fault);
cdem_status cdem_solver_restore(cdem_solver *solver, const cdem_state *state, cdem_fault *fault);

#endif
