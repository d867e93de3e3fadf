/* Private to the solver of fdem: its memory, and the steps of a step, one file each. */
#ifndef CDEM_FDEM_SOLVER_STORE_H
#define CDEM_FDEM_SOLVER_STORE_H

#include "fdem/store.h"

/* Grains of one template side by side: what one product works on. Large blocks pay for laying out
 * the matrix, small ones give many threads something to do; their size follows from the number of
 * grains alone. */
enum { CDEM_FDEM_BLOCK_LEAST = 32, CDEM_FDEM_BLOCK_MOST = 128, CDEM_FDEM_BLOCKS = 16 };
typedef struct {
  int32_t shape, first, count; /* members first .. first + count - 1 */
} cdem_fdem_block;

/* Sums of the book, J. */
typedef struct {
  double damping, numerical;
} cdem_fdem_sums;

/* What a block tells: its sums of a step, and a grain whose motion cannot go on (-1: none). */
typedef struct {
  cdem_fdem_sums sums;
  int32_t bad;
} cdem_fdem_part;

/* Scratch of one thread: [block][3 surface nodes], [block][modes]. */
typedef struct {
  double *skin, *load;
} cdem_fdem_work;

struct cdem_fdem_store {
  cdem_fdem_options options; /* its pointers to arrays are those below, or the caller's */
  int threads;
  int64_t grains, nodes, amplitudes;
  /* never changing */
  const cdem_skin **surface;
  int64_t *first; /* [grains + 1] surface nodes */
  int64_t *mode;  /* [grains] where the amplitudes of a grain begin */
  int32_t *shape, *material;
  double *radius, *mass;
  double *inertia, *spins;  /* [grains][9] about the centre, in the body; and its inverse */
  double *area, *node_mass; /* [nodes] */
  double *start;            /* [grains][3] centres at t = 0 */
  int32_t *member;          /* [grains] in the order of the templates */
  int32_t blocks;
  cdem_fdem_block *block;
  /* t_n */
  double *center, *quaternion, *turn; /* [grains][3], [4], [9] */
  double *q;                          /* [amplitudes], a grain's side by side, by member */
  double *place, *now, *before;       /* [nodes][3] */
  double *force;                      /* [nodes][3] */
  double *stiff;                      /* [grains] */
  /* t_n - dt/2 */
  double *velocity, *momentum; /* [grains][3]; angular, about the centre */
  double *rate;                /* [amplitudes] */

  cdem_wall_body *wall;
  double *wall_force, *wall_stiff; /* [walls][3], [walls] */
  cdem_fdem_contacts *contacts;
  struct cdem_fdem_confine *confine; /* confine.h; NULL: no specimen */

  double kick; /* the step by which velocities grow next: the mean of the last and the next one */
  double base_time;
  int64_t base_steps;
  cdem_fdem_sums sums;
  cdem_contact_book contact; /* stored now, dissipated and done since the start */
  double initial, exchange;
  bool failed;
  cdem_fdem_part *part; /* [blocks] */
  cdem_fdem_work *work; /* [threads] */
};

static inline const cdem_template *cdem_fdem_template(const cdem_fdem_store *s, int64_t grain) {
  return s->options.shape + s->shape[grain];
}

/* solver_setup.c: checks, then everything that never changes. */
cdem_status cdem_fdem_check(const cdem_fdem_options *options, cdem_fault *fault);
cdem_status cdem_fdem_setup(cdem_fdem_store *s, cdem_fault *fault);

/* motion.c: a block from t_n to t_{n+1}; or, `commit` false, only its forces on the modes into
 * work->load. */
void cdem_fdem_move_block(cdem_fdem_store *s, int32_t block, double step, cdem_fdem_work *work);
void cdem_fdem_loads_of(const cdem_fdem_store *s, int32_t block, cdem_fdem_work *work);
/* Places of a block from centres, quaternions and amplitudes. */
void cdem_fdem_place_block(cdem_fdem_store *s, int32_t block, cdem_fdem_work *work);
/* Spin from angular momentum at an orientation. */
void cdem_fdem_spin_of(const cdem_fdem_store *s, int64_t grain, const double turn[9],
                       const double momentum[3], double spin[3]);

/* Force, N, and moment about the centre, N m, of all that touches the grain. */
void cdem_fdem_resultant(const cdem_fdem_store *s, int64_t grain, double force[3],
                         double moment[3]);

/* contact.c's view of this store. */
cdem_contact_view cdem_fdem_contact_view(const cdem_fdem_store *s, double step);

/* limit.c */
cdem_status cdem_fdem_first_step(cdem_fdem *fdem, cdem_fault *fault);

/* book.c */
void cdem_fdem_book_start(cdem_fdem *fdem);

#endif
