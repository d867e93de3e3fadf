/* Private to dem: how a solver holds its grains, and who does what in a step.
 *
 * Grains stand in an internal order, sorted in space (neighbours_sort.c), in packs of four and
 * eight doubles so that one gather of a grain is one or two cache lines:
 *
 *     place[4 i]    x y z r              motion[8 i]   vx vy vz wx wy wz m -     (half steps)
 *     force[8 i]    fx fy fz mx my mz 1/m 1/I (inverse mass and inertia; 0 of driven grains)
 *
 * 2-D uses the same packs, with z, vz, wx, wy zero. `id` goes from internal to id, `slot` back.
 *
 * Pairs: candidates (closer than the skin) as rows of their owner, the lower internal index, others
 * ascending: pair_start[grains + 1], pair_other, pair_image (periodic only), with the history of
 * each pair (pair_history[histories * pair], `touch` says whether it is in use). A is the owner.
 * Arrays that are sorted keep their addresses: they are permuted through a scratch copy.
 * Wall candidates the same, as rows of grains: walls know the rest (walls_store.h).
 *
 * A step: (1) forces of each chunk of grains, a fixed number of neighbours in space; what falls on
 * grains of other chunks waits in `far`. (2) each grain adds its far forces in order, and moves.
 * Chunks do not depend on the threads, so neither do sums.
 */
#ifndef CDEM_DEM_STORE_H
#define CDEM_DEM_STORE_H

#include "dem/batch.h"
#include "dem/dem.h"

enum { CDEM_CHUNK = 1024, CDEM_CHUNK_LEAST = 128 };

/* An array that goes along when grains are sorted anew. */
typedef struct {
  void *address; /* of the pointer to the array */
  size_t size;   /* bytes a grain */
} cdem_dem_sorted;

typedef struct cdem_walls cdem_walls;       /* walls_store.h */
typedef struct cdem_dem_core cdem_dem_core; /* solver_store.h: book, bonds, far forces, threads */

struct cdem_dem_store {
  cdem_dem_options options;
  int dim;
  int32_t grains;
  double *place, *motion, *force; /* 64-byte aligned */
  int32_t *id, *slot;
  int32_t *material; /* internal order */
  uint8_t *kind;     /* cdem_grain_motion, internal order */
  double *travel;    /* [grains][8] ux uy uz rx ry rz - -: displacement and rotation up to the last
                        build; what came since is with the solver */
  int32_t *turns; /* [grains][4] whole edges of the cell that were added to each place so far; NULL
                     without a cell */
  int sorted;     /* everything above but slot, and what others add */
  cdem_dem_sorted sort[16];

  /* neighbours */
  double skin;    /* m: pairs closer than this are candidates */
  int64_t builds; /* of the list so far */
  int64_t pairs;
  int64_t *pair_start; /* [grains + 1] */
  int32_t *pair_other; /* [pairs] */
  uint8_t *pair_image; /* [pairs]; NULL without a cell: image of the other that is near */
  uint8_t *pair_touch; /* [pairs] 1: history in use; 2: no contact (bonded, or both are driven) */
  int histories;       /* numbers a contact remembers, law and resistances together */
  double parity[CDEM_BATCH_HISTORY]; /* what becomes of each when owner and other change places */
  double *pair_history;              /* [pairs][histories] */
  int64_t capacity[8];
  struct cdem_neighbours *search; /* neighbours.h: what a build needs and keeps */

  cdem_cell cell;                             /* as it is now; periodic all false: none */
  double image[27][3], image_velocity[27][3]; /* shifts and L shifts */

  cdem_walls *walls; /* NULL: none */
  cdem_dem_core *core;
};

static inline double *cdem_place(const cdem_dem_store *s, int64_t i) {
  return s->place + 4 * i;
}
static inline double *cdem_motion(const cdem_dem_store *s, int64_t i) {
  return s->motion + 8 * i;
}
static inline double *cdem_force(const cdem_dem_store *s, int64_t i) {
  return s->force + 8 * i;
}

/* ---- neighbours.c ---- */

/* Finds candidates anew: all pairs closer than rA + rB + skin (periodic: nearest images; CDEM_INPUT
 * when an edge of the cell is so short that two images of one grain could touch another). `sort`:
 * first brings grains into the cell (velocity gets image_velocity), then sorts them in space (all
 * arrays of s->sort; id and slot); without it no order changes. Histories of pairs that touch
 * follow; a pair that left the list was not touching. O(grains), sizes 1:10 and more. Same order
 * whatever the threads or the ids. */
cdem_status cdem_neighbours_build(cdem_dem_store *s, bool sort, int threads, cdem_fault *fault);
/* After a build: the image of grain b that was `image` to grain a before it (both by their indices
 * before); -1: further than one edge away. */
int cdem_neighbours_image_now(const cdem_dem_store *s, int64_t a, int64_t b, int image);
/* History of all pairs that touch, with ids and images, for saving; and back after a build. */
cdem_status cdem_neighbours_save(const cdem_dem_store *s, cdem_state *state, cdem_fault *fault);
cdem_status cdem_neighbours_restore(cdem_dem_store *s, const cdem_state *state, cdem_fault *fault);
void cdem_neighbours_release(cdem_dem_store *s);
/* No pairs any more: after a failure, so that what is looked at afterwards fits together. */
void cdem_neighbours_forget(cdem_dem_store *s);

/* ---- walls.c ---- */

/* One touch of a grain and a wall. */
typedef struct {
  int32_t wall;
  int32_t slot; /* of its history among the candidates, for cdem_walls_history */
  int material;
  double n[3];        /* from the grain to the wall */
  double overlap;     /* > 0 */
  double velocity[3]; /* of the wall's point there */
  double spin[3];     /* of the wall */
  double point[3];
} cdem_wall_touch;
enum { CDEM_WALL_TOUCHES = 8 }; /* of one grain at most */

cdem_status cdem_walls_init(cdem_dem_store *s, cdem_fault *fault); /* from s->options */
void cdem_walls_release(cdem_dem_store *s);
/* Candidates of all grains (within r + skin/2 of a wall; the skin is shared by grain and wall);
 * called right after cdem_neighbours_build. Histories of touching candidates follow. */
cdem_status cdem_walls_build(cdem_dem_store *s, cdem_fault *fault);
/* Does this grain have candidates? Rows of grains [grains + 1]. */
const int32_t *cdem_walls_rows(const cdem_dem_store *s);
/* What grain i touches now, ordered by wall; marks candidates that do not touch as not in use. Only
 * reads what other grains' calls write. Returns how many. */
int cdem_walls_find(cdem_dem_store *s, int32_t i, cdem_wall_touch touch[CDEM_WALL_TOUCHES]);
/* [histories] of a touch, zeroed when fresh; *fresh is set to whether it is and the slot is in use
 * from now on. */
double *cdem_walls_history(cdem_dem_store *s, const cdem_wall_touch *touch, bool *fresh);
/* Of the grains on the walls: force and moment about its centre [walls][6]; sum of the normal
 * stiffnesses of its contacts [walls], N/m; sum of the normal pushes [walls], N. NULL: none, as all
 * of them. */
typedef struct {
  const double *force, *stiffness, *push;
} cdem_wall_loads;
/* Moves the walls to t + dt, servos by their loads. Furthest way of any point of a wall near grains
 * since the last build goes to *moved. */
void cdem_walls_advance(cdem_dem_store *s, double time, double step, const cdem_wall_loads *loads,
                        double *moved);
/* CDEM_INPUT: a grain with its centre on the wrong side of a plane, outside a cylinder (names
 * both). */
cdem_status cdem_walls_check(const cdem_dem_store *s, cdem_fault *fault);
void cdem_walls_now(const cdem_dem_store *s, int wall, cdem_dem_wall *now);
void cdem_walls_move(cdem_dem_store *s, int wall, const cdem_series velocity[3],
                     const cdem_series spin[3]);
cdem_status cdem_walls_save(const cdem_dem_store *s, cdem_state *state, cdem_fault *fault);
cdem_status cdem_walls_restore(cdem_dem_store *s, const cdem_state *state, cdem_fault *fault);

/* ---- cell_servo.c ---- */
/* Does a servo seek a stress of which the packing holds half already? Pa, tension positive. */
bool cdem_cell_is_sought(const cdem_cell *cell, double time, const double stress[9]);
/* How a packing answers: its stiffness, Pa; in which time, s, the step or longer; viscosity of its
 * dashpots, Pa s. */
typedef struct {
  double step, bulk, time, viscosity;
} cdem_cell_answer;
/* Rate of the cell now: given, or, for servos, on from that of the step before, which stands in
 * `rate`, by the mean stress (row-major, Pa, tension positive). */
void cdem_cell_rate(const cdem_cell *cell, double time, const double stress[9],
                    const cdem_cell_answer *answer, double rate[9]);

#endif
