/* Room dem: discs and spheres that push, slide and roll on each other and on walls.
 *
 *     grains.h    what a model starts from        packing.h   how to make it
 *     law.h       contact laws, one file each     bonds.h     grains held together
 *     walls.h     rigid walls                     cell.h      periodic cell
 *     membrane.h  around a specimen           confinement.h  a specimen between plates
 *     dem.h       the solver (this file)          measures.h  stress, strain, fabric, fields
 *     surface.h   free surface, profiles, counts  pictures.h  grains, chains, arrows as maps
 *     frames.h    grains and contacts on their way to a file
 *
 * Time: velocity-Verlet (Li & Wan 2010, eqs 25-30) with mass damping taken implicitly. The state
 * between steps is x at t_n, v and w at t_n + dt/2 - dt (half steps, as in the room cdem),
 * histories and forces at t_n. Histories grow by v_{n+1/2} dt, the way that was gone.
 *
 * Same bits: grains are sorted in space by a rule that does not know their ids, forces are added in
 * an order that does not know the threads. So neither the number of threads nor (for laws without
 * labels) the numbering of grains changes a bit, and a restored solver goes on to the same bits.
 * No absolute tolerance: a model scaled by powers of two gives scaled bits.
 *
 * All pointers of the options are borrowed and must outlive the solver, but `grains`, `bond` and
 * those of walls of shape mesh, which are copied.
 */
#ifndef CDEM_DEM_DEM_H
#define CDEM_DEM_DEM_H

#include "dem/bonds.h"
#include "dem/cell.h"
#include "dem/confinement.h"
#include "dem/grains.h"
#include "dem/law.h"
#include "dem/walls.h"
#include "results/state.h"

typedef struct {
  const cdem_grains *grains;
  double thickness; /* of discs, m; 0: 1 m */
  int materials;
  const cdem_grain_material *material; /* [materials] */
  const cdem_law *law;
  const cdem_resistance *rolling, *twisting; /* NULL: none */
  /* For each pair of materials, [materials][materials], symmetric. */
  const cdem_contact_input *contact;
  int walls;
  const cdem_wall *wall;
  int bond_laws;
  const cdem_bond_law *bond_law;
  int64_t bonds;
  const cdem_bond *bond;
  const cdem_cell *cell;               /* NULL: not periodic */
  const cdem_confinement *confinement; /* NULL: none */
  double gravity[3];                   /* m/s^2 */
  double mass_damping;                 /* c_m, 1/s, on velocity and spin */
  double local_damping;                /* Cundall's alpha, 0 <= alpha < 1 */
  double step;                         /* s; 0: automatic. CDEM_INPUT when it is unstable */
  /* Part of the largest stable step that the automatic step takes, 0 < safety <= 1; 0: 0.1, with
   * which a collision lasts some 16 steps and the energy book closes to 1e-3 or better (0.2: to
   * some 5e-3; errors go with its square). The automatic step follows the contacts: it is looked at
   * after each build of the list. */
  double safety;
  double skin;         /* of the neighbour list, in mean radii; 0: automatic */
  double most_overlap; /* of grains at the start, in radii of the smaller one; 0: 0.1 */
  bool energies;       /* keep the energy book (costs a little) */
  bool reference;      /* plain kernels, one contact at a time: slow, for tests */
  int threads;         /* 0: OpenMP's default */
} cdem_dem_options;

/* J. Works are of the forces on the grains since the start. Kinetic energy is m v- v+/2 of the half
 * steps around t_n; works go by the trapezoid, so that the book of a linear contact that lasts is
 * exact and everything else is of second order in the step. What remains comes from contacts that
 * begin and end within a step. With li-chu, `friction` may be a little negative: its springs keep
 * what dashpots gave them. */
typedef struct {
  double translation, rotation;              /* kinetic now */
  double normal, shear, moment, bond;        /* stored now */
  double friction, rolling, damping, broken; /* dissipated: sliding; rolling and twisting; dashpots,
                                                mass and local damping; in bonds that broke */
  double gravity, walls, cell;    /* work of gravity, of moving walls, of the deforming cell */
  double driven, guided, applied; /* ... of driven grains, of guided ones, of `applied` */
  double membrane;                /* of a membrane and its touches, kinetic too */
  double pressure;                /* work of the pressure on it, and of the plates on its ends */
  double circulating;             /* work of forces that neither store nor dissipate */
  double initial;                 /* energy at the start */
  double error;                   /* stored and kinetic + dissipated - works - initial */
  double exchange; /* scale of the error: the largest of all terms so far seen at a report */
} cdem_dem_energies;

typedef struct cdem_dem_store cdem_dem_store;

typedef struct {
  int dim;
  int64_t grains, steps;
  double time, step; /* t_n, dt */
  double *applied; /* [grains][6] by id: force and moment of a coupled solver, added while set; all
                      0 at first, NULL until asked for by cdem_dem_want_applied */
  cdem_dem_store *store;
} cdem_dem;

/* CDEM_INPUT: a grain or wall that cannot be, grains that overlap by more than most_overlap (names
 * the worst pair and how many), a grain beyond a wall (names both), an unstable step (names the
 * limit and where it comes from), a word of a law (names the two materials). Evaluates the forces
 * at t = 0. */
cdem_status cdem_dem_init(const cdem_dem_options *options, cdem_dem *dem, cdem_fault *fault);
void cdem_dem_release(cdem_dem *dem);

/* One step; many steps at once are faster (threads stay together). CDEM_NUMERIC when the motion is
 * no longer finite or a grain moved by more than its radius in a step: names time, grain and place.
 */
cdem_status cdem_dem_step(cdem_dem *dem, cdem_fault *fault);
cdem_status cdem_dem_steps(cdem_dem *dem, int64_t steps, cdem_fault *fault);

/* Largest stable step now, s, and what limits it ("grain 17 with 4 contacts"; may be NULL). */
cdem_status cdem_dem_limit(const cdem_dem *dem, double *limit, char limiter[64], cdem_fault *fault);
cdem_status cdem_dem_set_step(cdem_dem *dem, double step, cdem_fault *fault);

void cdem_dem_energies_now(cdem_dem *dem, cdem_dem_energies *energies);
/* Linear momentum, kg m/s, and angular momentum about the origin, spins included, at t_n - dt/2. */
void cdem_dem_momentum(const cdem_dem *dem, double linear[3], double angular[3]);
/* Ratio of the largest to the mean: unbalanced force of a grain by mean contact force; 0 without
 * contacts. */
double cdem_dem_unbalanced(const cdem_dem *dem);

/* ---- what stands where: arrays by id, copied out; NULL: not wanted ---- */
typedef struct {
  double *xyz;          /* [grains][3] in the cell where there is one, m */
  double *displacement; /* [grains][3] since the start, m; of the grain that was never brought back
                           into the cell, mean flow included */
  double
      *rotation; /* [grains][3] accumulated, rad (exact in 2-D; in 3-D the integral of the spin) */
  double *velocity;       /* [grains][3] at t_n, m/s */
  double *spin;           /* [grains][3] at t_n, rad/s */
  double *force;          /* [grains][3] of all contacts, bonds and walls, N (driven grains too) */
  double *moment;         /* [grains][3] N m */
  double *mass, *inertia; /* [grains] kg, kg m^2 */
  int32_t *contacts;      /* [grains] now touching: grains, walls, bonds */
} cdem_dem_view;
void cdem_dem_look(const cdem_dem *dem, const cdem_dem_view *view);
/* Radius and material by id, never changing: [grains]. */
const double *cdem_dem_radius(const cdem_dem *dem);
const int32_t *cdem_dem_material(const cdem_dem *dem);
const cdem_dem_options *cdem_dem_options_of(const cdem_dem *dem);

/* ---- contacts that touch now ---- */
typedef struct {
  int32_t a, b;     /* ids; b of a wall: -1 - its index */
  double point[3];  /* m, on A's side of a periodic cell */
  double normal[3]; /* unit, from A to B */
  double branch[3]; /* from A's centre to B's (image); to the contact point of a wall */
  double overlap;   /* m; a bond: as if it were a contact, may be negative */
  double force[3];  /* on A, N */
  double moment[3]; /* on A beside that of the force, N m */
  double push;      /* F_N, N; a bond that pulls: negative */
  bool bonded;
  bool sliding; /* all of the contact: friction (of the law's sliding part) is at its bound,
                   friction times push, to rounding; partial slip of mindlin is none */
} cdem_dem_contact;
/* A new array, ordered by a, then b; free() it. Forces are those of the state (t_n), found again
 * from histories: where a contact with dashpots slides, the direction of its shear force may differ
 * by what the dashpot does beside the cut spring. Pairs of driven grains are no contacts. */
cdem_status cdem_dem_contacts(const cdem_dem *dem, int64_t *contacts, cdem_dem_contact **contact,
                              cdem_fault *fault);
int64_t cdem_dem_bonds_broken(const cdem_dem *dem);

/* ---- moved from outside ---- */
/* Driven and guided grains: velocity and spin of the components that are given, from now on (they
 * move by them in the next step), by id. After each step they grow by the rates times the step, so
 * that a smooth motion needs no call a step; NULL: 0. */
typedef struct {
  double velocity[3], spin[3]; /* of the next step */
} cdem_dem_motion;
void cdem_dem_drive(cdem_dem *dem, int64_t grain, const cdem_dem_motion *motion,
                    const cdem_dem_motion *rate);
/* Force and moment on some grains at t_n, of all contacts, bonds and walls: out [count][6]. */
void cdem_dem_forces_on(const cdem_dem *dem, int64_t count, const int32_t *grain, double *out);
/* Velocity and spin of some grains at t_n - dt/2: out [count][6]. */
void cdem_dem_motions_of(const cdem_dem *dem, int64_t count, const int32_t *grain, double *out);
/* Bound of the stiffness of the contacts and bonds of each grain now, against a motion of the grain
 * alone: N/m, [grains] by id; and, NULL allowed, against its rotation, N m/rad. */
cdem_status cdem_dem_stiffness(const cdem_dem *dem, double *resists, double *turning,
                               cdem_fault *fault);
/* Allocates `applied`. */
cdem_status cdem_dem_want_applied(cdem_dem *dem, cdem_fault *fault);
/* Wall: force and moment of the grains on it, where its center is and how far it has moved. */
typedef struct {
  double force[3], moment[3], center[3], moved[3], velocity[3];
} cdem_dem_wall;
void cdem_dem_wall_now(const cdem_dem *dem, int wall, cdem_dem_wall *now);
/* Replaces velocity and spin functions of a wall from now on (a new phase of a test). Borrowed. */
void cdem_dem_wall_move(cdem_dem *dem, int wall, const cdem_series velocity[3],
                        const cdem_series spin[3]);
/* The specimen as it is now; false: there is none. */
bool cdem_dem_specimen(const cdem_dem *dem, cdem_specimen *now);
/* Its membrane; NULL: none. */
const cdem_membrane *cdem_dem_membrane(const cdem_dem *dem);
/* From now on its high plate moves with this velocity along z, m/s; its servo is off. Part of the
 * state: who restores need not call it again. */
void cdem_dem_shear(cdem_dem *dem, double velocity);
/* The cell as it is now; NULL: none. And the mean stress in it, Pa, tension positive, row-major. */
const cdem_cell *cdem_dem_cell(const cdem_dem *dem);

/* Everything that changes. Restoring needs a solver made from the same options; it then continues
 * to the same bits. */
cdem_status cdem_dem_save(const cdem_dem *dem, cdem_state *state, cdem_fault *fault);
cdem_status cdem_dem_restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault);

#endif
