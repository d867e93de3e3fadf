/* What a solver keeps behind its handle, and the calls between the files of the solver. */
#ifndef CDEM_CDEM_SOLVER_STORE_H
#define CDEM_CDEM_SOLVER_STORE_H

#include "base/memory.h"
#include "cdem/solver.h"

/* Sums run over fixed chunks of nodes, and over the chunks in their order: the bits do not depend
 * on the number of threads. */
enum { CDEM_SOLVER_CHUNK = 1024, CDEM_SOLVER_LIMIT_EVERY = 64 };

/* Flags of a node; the lowest three bits say which components are prescribed. */
enum {
  CDEM_NODE_FIXED = 7,
  CDEM_NODE_TIED = 8,    /* member of a cluster */
  CDEM_NODE_QUIET = 16,  /* has a dashpot */
  CDEM_NODE_LOADED = 32, /* a load or a pressure may act */
  CDEM_NODE_EMPTY = 64   /* of no cell */
};

/* Work done and energy taken over the two half steps around t_n (J); and what a pass finds on the
 * way. */
enum {
  CDEM_SUM_LOAD,
  CDEM_SUM_SUPPORT,
  CDEM_SUM_MASS,   /* taken by mass damping */
  CDEM_SUM_LOCAL,  /* by local damping */
  CDEM_SUM_QUIET,  /* by quiet boundaries */
  CDEM_SUM_CHANGE, /* by which a change of the step shifts the kinetic energy */
  CDEM_SUM_KINETIC,
  CDEM_SUM_SPEED, /* of one pass, sum of |v| and |spin|: finite as long as all are */
  CDEM_SUMS
};

/* A velocity update: the kick (mean of the steps on both sides of t_n) and the halves of the two
 * steps, over which forces at t_n do their work. */
typedef struct {
  double kick, left, right;
  double old_half, new_half; /* of the steps before and after t_n */
  double mass_damping, local_damping;
} cdem_motion;

/* What moves as one: a node, or a cluster of tied nodes with its sums. */
typedef struct {
  unsigned fixed; /* bits of the components that are prescribed */
  double mass[3], force[3], before[3];
  double target[3]; /* velocity of prescribed components */
  bool quiet;       /* dashpot [9] holds something, N s/m */
  double dashpot[9];
} cdem_point;

typedef struct {
  int32_t nodes;
  int32_t *node;             /* [nodes] surface nodes */
  double *share;             /* [nodes] m^2, of all facets */
  double *area;              /* [nodes] m^2, of those that faced the plate when the node came */
  double *distance;          /* [nodes] n . (X - point), m */
  double *slip;              /* [nodes][2] elastic sliding along the plate's axes, m */
  double *last;              /* [nodes][2] place along the axes at the last evaluation, m */
  double *normal;            /* [nodes] normal force, N */
  uint8_t *touch;            /* [nodes] */
  double axis[3][3];         /* normal and the two in-plane axes */
  double moved[3], force[3]; /* of the plate; on the plate */
  double stored;
} cdem_plate_store;

/* Sums of one plate over a chunk of its nodes. */
typedef struct {
  double force[3], before[3]; /* of the plate on the body, now and at the last evaluation */
  double stored, friction;
} cdem_plate_sums;

struct cdem_solver_store {
  cdem_solver_options options;
  int dimension, threads;
  const double *inertia; /* [nodes][dofs] body->mass or `fictitious` */
  double *fictitious;
  double *row_body, *row_couple, *row_sum; /* [nodes] for the relaxation's masses */
  uint8_t *flag;                           /* [nodes] */
  int16_t *support_of;                     /* [nodes][dofs] support that prescribes it, -1 */
  double *path;                            /* [supports] value at t_{n+1} */
  int32_t *cluster_of;                     /* [nodes] -1: none; NULL without interfaces */
  int32_t loaded;                          /* nodes with loads or pressures */
  int32_t *loaded_node;
  double *pressed; /* [facets of the largest pressure][4][3] */
  int32_t quiet;   /* nodes with dashpots */
  int32_t *quiet_node;
  int32_t *dashpot_of;                    /* [nodes], NULL without quiet boundaries */
  double *dashpot;                        /* [quiet][9] */
  cdem_plate_store *plate;                /* [plates] */
  cdem_plate_sums *plate_part;            /* [chunks] */
  int64_t *surface_start, *surface_facet; /* [nodes + 1]; 4 facet + corner */
  double *cell_stress;                    /* [model cells][6]; NULL unless a face may be tied */
  double *mesh_stress;                    /* [mesh cells][6] */
  double *pair_force;                     /* [model cells][CDEM_CLASSES] */
  double *scratch;                        /* [nodes][dofs] */
  double *partial;                        /* [chunks][CDEM_SUMS] */
  uint8_t *handed;                        /* [pairs] given to contact */
  int64_t ties_version, interfaces_version, contact_version;
  double omega2_body, omega2_interfaces, omega2_contact, omega2_plates; /* (rad/s)^2 */
  char limiter_body[48];
  int limiter_plate;
  double base_time; /* time = base_time + (steps - base_steps) step */
  int64_t base_steps;
  double previous; /* the step that led to t_n; 0 at the start */
  bool stale;      /* the forces are not those of u */
  double total[CDEM_SUMS];
  double plate_work, plate_friction;
  double gravity_start, initial, exchange;
};

/* solver_move.c: motion of points. */

/* Velocity of the point after the kick, the reaction on its prescribed components, and what was
 * done on the way, added to sums [CDEM_SUMS] (load is not known here). */
void cdem_point_move(const cdem_motion *motion, int dofs, const cdem_point *point, double after[3],
                     double reaction[3], double *sums);
void cdem_solver_motion(const cdem_solver *solver, bool commit, cdem_motion *motion);
/* The point of a node (of its cluster when it is tied), before the kick at t_n. */
void cdem_solver_point(const cdem_solver *solver, int32_t node, cdem_point *point);
void cdem_solver_cluster(const cdem_solver *solver, int32_t cluster, cdem_point *point);
/* One kick of all points. after [nodes][dofs] receives the velocities (NULL: only the sums); commit
 * moves the state: velocities, displacements. */
void cdem_solver_pass(const cdem_solver *solver, bool commit, double *after, double *sums);
/* v_{-1/2} from the velocities v_0 in solver->v. */
void cdem_solver_start(cdem_solver *solver);

/* solver_loads.c: supports, loads, pressures, quiet boundaries. */
cdem_status cdem_solver_supports_init(cdem_solver *solver, cdem_fault *fault);
double cdem_support_path(const cdem_support *support, double time);
void cdem_solver_paths(cdem_solver *solver, double time);
cdem_status cdem_solver_loads_init(cdem_solver *solver, cdem_fault *fault);
cdem_status cdem_solver_quiet_init(cdem_solver *solver, cdem_fault *fault);
/* external at `time` on the surface at displacements u. */
void cdem_solver_external(cdem_solver *solver, const double *u, double time);
/* Each corner's integral of N_i n dA, m^2: the gradient of the volume behind the facet. */
void cdem_surface_vectors(const double xyz[4][3], int corners, double thickness,
                          double vector[4][3]);
/* Corners of a facet at displacements u (NULL: reference), from its first corner's reference place:
 * places far from the origin keep their digits. */
void cdem_solver_corners(const cdem_solver *solver, const cdem_facet *facet, const double *u,
                         double xyz[4][3]);
/* Each corner's share of the reference area, m^2, and the unit outward normal. */
void cdem_solver_shares(const cdem_solver *solver, int32_t facet, double share[4],
                        double normal[3]);

/* solver_step.c */
/* All forces at time t_n and displacements u_n; dt: the step that led there. */
cdem_status cdem_solver_evaluate(cdem_solver *solver, double dt, cdem_fault *fault);
void cdem_solver_ties(cdem_solver *solver);
void cdem_solver_set_time(cdem_solver *solver, double time);
static inline double cdem_solver_next_time(const cdem_solver *solver) {
  return solver->store->base_time +
         (double)(solver->steps + 1 - solver->store->base_steps) * solver->step;
}

/* solver_limit.c */
void cdem_solver_body_limit(cdem_solver *solver);
/* Looks at the bounds whose versions changed and changes the step where it must (or may). */
void cdem_solver_relook(cdem_solver *solver, bool all);
cdem_status cdem_solver_first_step(cdem_solver *solver, cdem_fault *fault);
/* Masses of a relaxation. */
void cdem_solver_masses(cdem_solver *solver);

/* plates.c */
cdem_status cdem_solver_plates_init(cdem_solver *solver, cdem_fault *fault);
void cdem_solver_plates_release(cdem_solver *solver);
void cdem_solver_plates_forces(cdem_solver *solver);
/* Greatest squared frequency a plate may add; *plate: which. */
double cdem_solver_plates_frequency2(const cdem_solver *solver, int *plate);
void cdem_solver_plates_row_sums(const cdem_solver *solver, double *stiffness);

/* solver_energy.c */
/* Makes the book start here. */
void cdem_solver_book_start(cdem_solver *solver);

/* static_modes.c: rigid motions. */
/* CDEM_INPUT when the supports leave a rigid motion of a connected part free. joined [joins][2]:
 * pairs of nodes held together beyond the matrix (interfaces, ties). */
cdem_status cdem_static_check_supports(const cdem_solver *solver, const cdem_sparse *matrix,
                                       int64_t joins, const int32_t (*joined)[2],
                                       cdem_fault *fault);

#endif
