/* What a solver of grains keeps beside store.h, and the calls between its files.
 *
 * Chunks are runs of grains in the internal order, of one fixed length. A chunk's pairs are those
 * its grains own. The reaction on a grain of the same chunk is added at once; on a grain of another
 * chunk it goes to a row of `far`, and every grain adds its far rows in order when it moves.
 * Nothing of this depends on the threads.
 *
 * Forces and far rows are zero when forces are evaluated: moving a grain uses its force up. At the
 * end of cdem_dem_steps far rows are added (cdem_dem_gather), so that between steps forces are
 * complete.
 */
#ifndef CDEM_DEM_SOLVER_STORE_H
#define CDEM_DEM_SOLVER_STORE_H

#include "base/mat3.h"
#include "base/memory.h"
#include "base/simd.h"
#include "dem/store.h"

/* Sums over chunks. The first group is booked by contacts, the second by the motion of grains. */
enum {
  CDEM_DEM_DAMPED,
  CDEM_DEM_SLID,
  CDEM_DEM_ROLLED,
  CDEM_DEM_CIRCULATED,
  CDEM_DEM_BROKEN,
  CDEM_DEM_MASS,   /* taken by mass damping */
  CDEM_DEM_LOCAL,  /* by local damping */
  CDEM_DEM_DRIVEN, /* of driven grains, of what guides others */
  CDEM_DEM_GUIDED,
  CDEM_DEM_APPLIED,
  CDEM_DEM_TRANSLATION,
  CDEM_DEM_ROTATION,
  CDEM_DEM_SUMS
};

/* An automatic skin lies between these parts of the mean radius. */
#define CDEM_DEM_LEAST_SKIN 0.05
#define CDEM_DEM_MOST_SKIN  0.6

/* A pair that touches: place among the pairs of the chunk, and whether its history is in use. */
typedef uint32_t cdem_hit;

enum { CDEM_BOND_HISTORY = 8 };

/* A bond with its state; A is the grain with the lower internal index. */
typedef struct {
  int32_t id[2]; /* of the grains, as now owned: A, B */
  int32_t law;
  int32_t owner, other; /* internal indices of A and B */
  int64_t target;       /* as pair_target */
  int64_t pair;         /* among the candidates; -1: none */
  uint8_t image;        /* of B */
  uint8_t holds;        /* 0: broken */
  double rest;          /* distance of centres at rest, m */
  double
      stretch[CDEM_BOND_HISTORY]; /* 0..2 sliding way (2-D: 0), 3..5 rolled (2-D: 3), 6 twisted */
} cdem_bond_state;

/* What one thread works on. */
typedef struct {
  cdem_batch batch;
  _Alignas(64) cdem_lanes force[3], on_a[3], on_b[3]; /* force on A, moments on A and B */
  _Alignas(64) double row_a[CDEM_BATCH + 1][8], row_b[CDEM_BATCH + 1][8];
  _Alignas(64) double place[CDEM_BATCH][4], radius_a[CDEM_BATCH];
  int64_t hits;       /* capacity */
  cdem_hit *hit;      /* [hits] */
  cdem_hit *ordered;  /* [hits] by model; NULL with one model */
  int64_t wall_items; /* capacity */
  cdem_wall_touch *wall_touch;
  int32_t *wall_grain, *wall_model;
} cdem_dem_work;

/* Totals of one chunk, on cache lines of their own. */
typedef struct {
  _Alignas(64) double sum[CDEM_DEM_SUMS];
  double moved2;       /* largest squared displacement since the last build, m^2 */
  double drift[3];     /* sum of displacements against the flow of the cell; in one that flows */
  int32_t bad;         /* a grain that moved too far, -1 */
  int32_t broke;       /* bonds in this evaluation */
  bool driven;         /* some of its grains are driven or guided */
  int32_t touches;     /* pairs that touch */
  double virial[9];    /* sum of f (x) branch; with servo-controlled cells */
  double image[27][3]; /* sum of forces on A across each image */
} cdem_dem_part;

/* Mean flow of the cell since the last build (solver_flow.c). */
typedef struct {
  bool on;
  double gradient[9], drift[3]; /* F - I and mean displacement against it, of the step before */
  double more[9], on_way[3];    /* by how much they grew in it */
  double inverse[9], center[3]; /* of the edges at the build, and the middle of the cell, m */
  double reach, largest;        /* from there to a corner; largest radius, m */
} cdem_dem_flow;

struct cdem_dem_core {
  cdem_grains start;     /* copy of the grains given */
  int threads;           /* that work together */
  int32_t chunk, chunks; /* grains a chunk, chunks */
  bool uniform;          /* one radius and one mass */
  bool driven, servos;   /* some are, or are guided; walls by force */
  double thickness;      /* of discs, m */
  int models;
  cdem_contact_model *model; /* [models] */
  int32_t *model_of;         /* [materials][materials] */
  double *radius;            /* [grains] by id */
  int32_t *material;         /* [grains] by id */
  double *since;             /* [grains][8] as travel, since the last build */
  double *gain;              /* [grains][8] of motion in the last kick; with energies only */
  double *seen;              /* [grains][8] motion that the forces were found with, where ... */
  bool seen_holds;           /* ... it is no longer `motion`: at the start, in a changed step */
  double *drive;             /* [grains][6] by id; NULL without driven and guided grains */
  double *drive_rate;        /* [grains][6] by id: growth of drive, 1/s; likewise */
  int32_t *pair_owner;       /* [pairs] */
  int32_t *pair_target;      /* [pairs] >= 0: grain of the same chunk; else -1 - far row */
  int64_t rows;              /* of far */
  double *far;               /* [rows][8], by grain; 64-byte aligned in far_block */
  void *far_block;
  double mean_radius;
  int32_t *far_start; /* [grains + 1] */
  int64_t capacity[4];
  void *block[12]; /* what aligned arrays were allocated as */
  int blocks;
  cdem_dem_part *part; /* [chunks] */
  double *wall_part;   /* [chunks][walls][8] force, moment about the centre, stiffness, push */
  double *wall_force;  /* [walls][6] on the walls at t_n */
  double *wall_stiff;  /* [walls] */
  double *wall_center; /* [walls][3] at the evaluation */
  cdem_dem_work *work; /* [threads] */
  int works;

  double *wall_push;            /* [walls] sum of the normal pushes of grains, N */
  struct cdem_confine *confine; /* confine.h; NULL: none */

  /* bonds */
  int64_t bonds, broken;
  cdem_bond_state *bond; /* [bonds] sorted by A, B (internal) */
  cdem_bond_state *bond_spare;
  int64_t *bond_start; /* [grains + 1] */
  int64_t held;        /* in `held_by`, those that hold */
  int32_t *held_by;    /* [bonds][2] lower id, higher id; sorted */

  /* time */
  double base_time;
  int64_t base_steps;
  bool automatic, failed;
  bool all;      /* every chunk moves by cdem_grains_move_all, not only those with driven grains */
  bool relook;   /* at the limit, when forces are complete */
  double wanted; /* step to change to then; 0: none */
  int64_t built_step;
  double wall_moved; /* since the last build */
  double built_image[27][3];
  cdem_dem_flow flow;

  /* book */
  double base[CDEM_DEM_SUMS]; /* half steps before the start */
  double wall_work, cell_work;
  double rate[9], stress[9], bulk; /* cell */
  double response;                 /* s: of a wave from the faces to the middle, or of dashpots */
  double viscosity;                /* Pa s, of the packing along one axis, at most */
  double joints;                   /* contacts and bonds that bulk and response were found with */
  double image_force[27][3];
  double initial, exchange;
  /* asked for by benches: seconds in test, fill, law, scatter, walls and bonds, motion, lists */
  double *clock;
};

/* ---- solver_setup.c ---- */
cdem_status cdem_dem_check(const cdem_dem_options *options, cdem_fault *fault);
cdem_status cdem_dem_models(cdem_dem *dem, cdem_fault *fault);
cdem_status cdem_dem_check_overlaps(const cdem_dem *dem, cdem_fault *fault);

/* ---- solver_lists.c ---- */
/* Candidates anew and everything that depends on them. */
cdem_status cdem_dem_rebuild(cdem_dem *dem, bool sort, cdem_fault *fault);
/* Owners, targets and far rows of the candidates there are. */
cdem_status cdem_dem_lists(cdem_dem *dem, cdem_fault *fault);

/* ---- force.c ---- */
/* Forces of one chunk; step 0: of the histories as they are. */
void cdem_dem_force_chunk(cdem_dem *dem, int32_t chunk, double step, cdem_dem_work *work);
/* Sums what chunks have found on walls and images; work of walls over the step that led here. */
void cdem_dem_force_after(cdem_dem *dem, double step);
/* All forces at once (outside of parallel regions); far rows are added. */
void cdem_dem_evaluate(cdem_dem *dem, double step);
void cdem_dem_gather(cdem_dem *dem);
/* Energy that a fresh contact of these two grains holds at an overlap. */
double cdem_dem_stored_at(cdem_dem *dem, int32_t a, int32_t b, const double n[3], double overlap);
/* Which of a chunk's pairs touch, ordered by model: model_start [models + 1]. */
int32_t cdem_dem_hits(cdem_dem *dem, int32_t chunk, cdem_dem_work *work, const cdem_hit **hit,
                      int32_t *model_start);
/* Law and resistances on a batch that is filled. */
void cdem_dem_law(const cdem_dem *dem, const cdem_contact_model *model, cdem_batch *batch,
                  bool energies);
/* Touches of a chunk with walls, in work->wall_*, ordered by model as hits. */
int32_t cdem_dem_wall_hits(cdem_dem *dem, int32_t chunk, cdem_dem_work *work, int32_t *model_start);
void cdem_dem_wall_fill(cdem_dem *dem, const cdem_contact_model *model, cdem_dem_work *work,
                        int32_t first, int count, double *history[CDEM_BATCH]);
bool cdem_dem_wall_room(cdem_dem_work *work, int64_t grains);
void cdem_dem_work_half(cdem_dem *dem, double step);
enum { CDEM_MODELS_MOST = 256 };

/* ---- solver_visit.c ---- */
/* A batch of contacts with their forces (row_a of work), all of pairs or all with walls. */
typedef struct {
  const cdem_dem *dem;
  cdem_dem_work *work;
  const cdem_contact_model *model;
  int32_t chunk;
  int count;
  bool wall;
  int64_t pair[CDEM_BATCH];
  int32_t touch[CDEM_BATCH]; /* into work->wall_touch and wall_grain */
} cdem_dem_visit;
typedef void cdem_dem_see(void *context, const cdem_dem_visit *visit);
void cdem_dem_visit_all(const cdem_dem *dem, cdem_dem_see *see, void *context);
/* Lets contacts see the velocities that the forces were found with; returns `motion`, to be put
 * back. */
double *cdem_dem_as_seen(const cdem_dem *dem);
/* As they would be after springs had grown for another `step`; nothing is kept. */
void cdem_dem_visit_at(const cdem_dem *dem, double step, cdem_dem_see *see, void *context);

/* ---- force_kernels.c ---- */
typedef struct {
  const cdem_dem_store *store;
  const cdem_dem_core *core;
  int64_t first; /* pair that hits are counted from */
  double step;
  bool arms_by_radius;
} cdem_pair_kernel;
int32_t cdem_pairs_test(const cdem_pair_kernel *kernel, int32_t count, cdem_hit *hit);
void cdem_pairs_fill(const cdem_pair_kernel *kernel, int count, const cdem_hit *hit,
                     cdem_dem_work *work);
/* Growth of the velocities, for the book. */
void cdem_pairs_gain(const cdem_pair_kernel *kernel, int count, const cdem_hit *hit,
                     cdem_dem_work *work);
/* Forces and moments of a batch as rows, for walls and reports. */
void cdem_pairs_rows(int dim, cdem_dem_work *work);
/* Adds them to the grains, and keeps the histories. */
void cdem_pairs_scatter(const cdem_pair_kernel *kernel, int count, const cdem_hit *hit,
                        cdem_dem_work *work);

/* ---- solver_move_kernels.c ---- */
typedef struct {
  cdem_dem_store *store;
  cdem_dem_core *core;
  double step;
  const double *applied; /* by id; NULL */
  bool commit;           /* false: only sums, nothing moves */
} cdem_move_kernel;
void cdem_grains_move(const cdem_move_kernel *kernel, int32_t from, int32_t to,
                      cdem_dem_part *part);
/* With everything that costs: local damping, applied forces, driven grains, the book. */
void cdem_grains_move_all(const cdem_move_kernel *kernel, int32_t from, int32_t to,
                          cdem_dem_part *part);
void cdem_grains_gather(const cdem_move_kernel *kernel, int32_t from, int32_t to);
/* Velocity and spin at t_n of internal grain i, [6]. */
void cdem_grain_velocity_now(const cdem_dem *dem, int32_t i, double now[6]);
/* Velocities of the last half step such that those at t_n are `now`. */
void cdem_grain_set_before(const cdem_dem *dem, int32_t i, const double now[6]);

/* ---- bonds_state.c, bonds_force.c ---- */
cdem_status cdem_bonds_init(cdem_dem *dem, cdem_fault *fault);
void cdem_bonds_release(cdem_dem_core *core);
/* Images after a build; owners, order, pairs, which are marked, before the far rows are laid out.
 */
cdem_status cdem_bonds_carry(cdem_dem *dem, cdem_fault *fault);
cdem_status cdem_bonds_sort(cdem_dem *dem, cdem_fault *fault);
void cdem_bonds_forces(cdem_dem *dem, int32_t chunk, double step);
/* The list of bonds that hold, after some broke. */
void cdem_bonds_update(cdem_dem *dem);
double cdem_bonds_stored(const cdem_dem *dem);
cdem_status cdem_bonds_save(const cdem_dem *dem, cdem_state *state, cdem_fault *fault);
cdem_status cdem_bonds_restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault);
/* Force on A [3], moment on A beside that of the force [3], arms and the unit vector to B. */
typedef struct {
  double n[3], length, force[3], shear[3], moment[3], arm[2], push, stored;
  double power; /* of the elastic part, W */
  bool breaks;
} cdem_bond_forces;
void cdem_bond_evaluate(const cdem_dem *dem, cdem_bond_state *bond, double step,
                        cdem_bond_forces *out, double *damped);

/* ---- solver_step.c ---- */
void cdem_dem_set_time(cdem_dem *dem, double time);
void cdem_dem_wall_centers(cdem_dem *dem);

/* ---- solver_flow.c ---- */
/* After a build. */
void cdem_dem_flow_start(cdem_dem *dem);
/* Displacements of a chunk's grains against the flow, for its moved2. */
void cdem_dem_flow_chunk(const cdem_dem *dem, int32_t chunk, cdem_dem_part *part);
/* Is the list outlived, if no grain has moved further than this? The cell has moved already. */
bool cdem_dem_flow_outlived(cdem_dem *dem, double moved);

/* ---- solver_energy.c ---- */
/* Kinetic energy before and after grains are brought into a moving cell: the difference is work of
 * the cell. */
void cdem_dem_wrap_begin(cdem_dem *dem);
void cdem_dem_wrap_end(cdem_dem *dem);
void cdem_dem_book_start(cdem_dem *dem);
/* What is done at t_n but not yet in the sums, or in them but not yet done; kinetic energy. */
void cdem_dem_book_now(const cdem_dem *dem, double sum[CDEM_DEM_SUMS]);

/* ---- solver_limit.c ---- */
/* Chooses the first step; CDEM_INPUT for a prescribed one that is unstable. */
cdem_status cdem_dem_first_step(cdem_dem *dem, cdem_fault *fault);
/* Looks at the limit after a build. */
cdem_status cdem_dem_relook(cdem_dem *dem, cdem_fault *fault);
/* Before velocities are set back to another half step than that of the forces. */
void cdem_dem_keep_seen(cdem_dem *dem);
/* Changes the step; velocities at t_n stay. */
void cdem_dem_change_step(cdem_dem *dem, double step);

/* For servos: stiffness of the packing in its cell, Pa, and how long a wave takes from the faces to
 * the middle, s; 0: no contacts. */
void cdem_dem_bulk(cdem_dem *dem);
/* The same, if contacts and bonds have become more than twice or less than half as many since. */
void cdem_dem_bulk_if_stale(cdem_dem *dem);

/* ---- reference.c ---- */
void cdem_dem_reference(cdem_dem *dem, double step);

static inline int32_t cdem_chunk_from(const cdem_dem *dem, int32_t chunk) {
  return chunk * dem->store->core->chunk;
}
static inline int32_t cdem_chunk_to(const cdem_dem *dem, int32_t chunk) {
  int64_t to = (int64_t)(chunk + 1) * dem->store->core->chunk;
  return to < dem->store->grains ? (int32_t)to : dem->store->grains;
}
static inline double cdem_inertia_factor(int dim) {
  return dim == 2 ? 0.5 : 0.4;
}

#endif
