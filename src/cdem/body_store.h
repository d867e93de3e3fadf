/* Inside room cdem: how the elastic body is stored. Not for other rooms.
 *
 * A record is what the force kernel reads of one element: the inverse Jacobian at the centre, the
 * places of nodes 1, 2, .. relative to node 0, and the spring tensors of the pairs. Records are
 * doubles; of a shared batch one record serves all lanes, of an own batch the eight records stand
 * side by side, lane last.
 *
 * Cells are sorted along a Morton curve and cut into tiles of CDEM_BODY_TILE cells. A tile is the
 * unit of work: its element forces stay in a core's cache and are gathered there, in the fixed
 * order of its cells, into the nodes that no other tile has; nodes of several tiles get one
 * partial sum a tile, and these are added, in the order of the tiles, at the end. Tiles do not
 * depend on the number of threads, hence neither do the bits.
 */
#ifndef CDEM_CDEM_BODY_STORE_H
#define CDEM_CDEM_BODY_STORE_H

#include "base/mat3.h"
#include "cdem/body.h"
#include "cdem/tension_law.h"

enum { CDEM_BODY_TILE = 512, CDEM_BODY_NODES = 8, CDEM_BODY_PAIRS = 28 };

/* What elements of one kind share. */
typedef struct {
  cdem_formulation formulation;
  int dimension, dofs, nodes, pairs;
  int place, spring, record; /* offsets of the places and the springs, and the length of a
                                record, in doubles; the inverse Jacobian is at 0 */
  double derivative[CDEM_BODY_NODES][3]; /* of the shape functions at the centre, by xi */
  double shape[CDEM_BODY_NODES];         /* shape functions there */
  uint8_t class_[CDEM_BODY_PAIRS];       /* 0 .. CDEM_CLASSES - 1 */
} cdem_body_kind;

/* Inverse Jacobian inverse[3 k + c] = dxi_k/dX_c from derivatives dn by xi. Returns the determinant
 * over the cube of the Jacobian's size, which does not depend on the unit of length: in 2-D the
 * third direction is given that size. */
static inline double cdem_body_jacobian(const cdem_body_kind *kind, const double (*xyz)[3],
                                        const double (*dn)[3], double inverse[9]) {
  double j[9] = {0};
  for (int a = 0; a < kind->nodes; a++)
    for (int i = 0; i < kind->dimension; i++)
      for (int k = 0; k < kind->dimension; k++)
        j[3 * i + k] += xyz[a][i] * dn[a][k];
  double size = cdem_frobenius(j, 9);
  if (kind->dimension == 2)
    j[8] = size;
  return cdem_inverse3(j, inverse) / (size * size * size);
}

typedef struct {
  int64_t record; /* offset into the data, in doubles */
  int32_t id;     /* offset into the node ids, in groups of CDEM_LANES */
  uint16_t row;   /* first element node of the batch within its tile */
  uint8_t kind;
  uint8_t cells;  /* lanes in use; the others repeat the last */
  bool shared;    /* one record for all lanes */
  bool fills;     /* the first batch of that record */
  bool last_node; /* holds the mesh's last node: three values must not be read as four */
} cdem_body_batch;

/* Stress = stress [6][7] times the local strain (Voigt, engineering shears, then the relative
 * rotation of a Cosserat point) and whole strain = strain [6][6] times it: brings what a plane has
 * out of its plane. */
typedef struct {
  double stress[6][7], strain[6][6];
} cdem_body_law;
cdem_status cdem_body_law_build(const cdem_model *model, int material, cdem_body_law *law,
                                cdem_fault *fault);

struct cdem_body_store {
  int kinds;
  cdem_body_kind *kind;
  int64_t batches;
  cdem_body_batch *batch;
  int32_t *cell;       /* [batches][CDEM_LANES] model cell, -1 for idle lanes */
  int32_t *place;      /* [model cells] batch * CDEM_LANES + lane */
  int32_t *id;         /* [..][CDEM_LANES] mesh nodes: of a batch [nodes][CDEM_LANES] */
  int64_t ids;         /* groups in id */
  double *data;        /* records */
  int64_t doubles;     /* in data */
  int64_t own_doubles; /* of own batches: read every time */
  int32_t tiles;
  int64_t *tile_batch;  /* [tiles + 1] */
  int64_t *tile_node;   /* [tiles + 1] offsets into target */
  int32_t *target;      /* mesh node, or -1 - slot of a partial sum */
  int64_t *entry_start; /* [targets + 1] */
  uint16_t *entry;      /* element node of the tile: row * CDEM_LANES + lane */
  int32_t rows;         /* most element-node rows of a tile */
  int32_t joints;       /* nodes of several tiles */
  int32_t *joint;       /* [joints] mesh nodes */
  int64_t *joint_start; /* [joints + 1] slots */
  double *partial;      /* [slots][dofs] */
  int32_t lonely;       /* nodes of no cell */
  int32_t *lonely_node;
  double *buffer;                  /* [threads][rows][dofs][CDEM_LANES] */
  double *tile_energy;             /* [tiles][CDEM_CLASSES] */
  double *density, *micro_inertia; /* [model materials] */
  cdem_body_law *law;              /* [model materials], of those in use */
  cdem_tension_law *tension;       /* [model materials], NULL: all carry tension */
  int64_t *mean_start;             /* [batches] offset into mean, -1: all cells carry tension */
  double *mean;      /* of a batch: volume, then mean gradients [nodes][dimension], side
                        by side as in its record */
  int64_t own_means; /* doubles of own batches in it */
  double *volume;    /* [nodes] sum of the shares, m^3 */
  int64_t bytes;     /* held */
};

/* One record: entry e stands at data[e * stride]. */
typedef struct {
  const cdem_body_kind *kind;
  const double *data;
  int stride;
} cdem_body_record;

static inline cdem_body_record cdem_body_record_of(const cdem_body_store *store, int32_t cell) {
  int32_t place = store->place[cell];
  const cdem_body_batch *batch = &store->batch[place / CDEM_LANES];
  return (cdem_body_record){.kind = &store->kind[batch->kind],
                            .data = store->data + batch->record +
                                    (batch->shared ? 0 : place % CDEM_LANES),
                            .stride = batch->shared ? 1 : CDEM_LANES};
}

/* Groups cells into templates: template_of [model cells] receives the lowest cell that is congruent
 * (itself when `separate`). *distinct: how many there are. */
cdem_status cdem_body_congruent(const cdem_model *model, bool separate, int threads,
                                int32_t *template_of, int64_t *distinct, cdem_fault *fault);
/* Tiles, batches, node ids. */
cdem_status cdem_body_arrange(const cdem_model *model, const int32_t *template_of,
                              cdem_body_store *store, cdem_fault *fault);
/* Records of all batches. */
cdem_status cdem_body_fill(const cdem_model *model, int threads, cdem_body_store *store,
                           cdem_fault *fault);
/* Gather lists. */
cdem_status cdem_body_link(const cdem_model *model, int threads, cdem_body_store *store,
                           cdem_fault *fault);

static inline bool cdem_body_is_tensionless(const cdem_model *model, const cdem_body_store *store,
                                            int32_t cell) {
  return store->tension != NULL &&
         store->tension[model->material[cell]].kind != CDEM_TENSION_ELASTIC;
}

/* Laws and mean gradients of materials without tension: of cells that do not carry it. */
cdem_status cdem_body_tension_fill(const cdem_model *model, const bool *no_tension,
                                   cdem_body_store *store, cdem_fault *fault);

/* Allocates and counts the bytes held. */
#define CDEM_BODY_NEW(store, pointer, count, fault)                                                \
  do {                                                                                             \
    CDEM_NEW(pointer, count, fault);                                                               \
    (store)->bytes += (int64_t)(count) * (int64_t)sizeof *(pointer);                               \
  } while (0)

/* Integrals of the shape functions over a cell: share [nodes], m^3 (thickness included). */
void cdem_body_shares(const cdem_model *model, int32_t cell, double share[CDEM_BODY_NODES]);
/* Means of the gradients of the shape functions over a cell, by the rule of its stiffness, and its
 * volume, m^3. */
double cdem_body_mean_gradients(const cdem_model *model, int32_t cell,
                                double (*mean)[3]); /* [nodes] */

/* The state of one element, for the paths where speed is no matter. */
typedef struct {
  cdem_body_record record;
  const int32_t *node;                 /* mesh nodes */
  double x[CDEM_BODY_NODES][3];        /* places relative to node 0 */
  double gradient[CDEM_BODY_NODES][3]; /* of the shape functions at the centre */
  double rotation[9], stretch[9];      /* R and U = sym(R^T F); identities when linear */
  double determinant;                  /* of F */
  double opening[6];                   /* local, Voigt; 0 where tension is carried */
  double y[CDEM_BODY_NODES][3];        /* local places */
  double d[CDEM_BODY_NODES][3];        /* local displacements less the opening: what springs feel;
                                          Cosserat: third is omega less the angle */
} cdem_body_element;
void cdem_body_element_at(const cdem_body *body, const double *u, int32_t cell,
                          cdem_body_element *element);
/* Spring tensor of pair p, row-major [dofs][dofs]. */
void cdem_body_spring(const cdem_body_element *element, int p, double s[9]);
/* d_j - T_ij d_i [dofs]. */
void cdem_body_elongation(const cdem_body_element *element, int i, int j, double g[3]);

/* The force kernel on one batch. */
typedef struct {
  const cdem_body_kind *kind;
  const double *record;
  const int32_t *id;     /* [nodes][CDEM_LANES] */
  const double *u;       /* [mesh nodes][dofs] */
  const double *opening; /* [6][CDEM_LANES] Voigt; NULL: none. Energies heed it */
  bool shared, last_node, linear;
} cdem_body_task;

static inline cdem_body_task cdem_body_task_of(const cdem_body *body, const double *u, int64_t n) {
  const cdem_body_store *store = body->store;
  const cdem_body_batch *batch = &store->batch[n];
  return (cdem_body_task){.kind = &store->kind[batch->kind],
                          .record = store->data + batch->record,
                          .id = store->id + (int64_t)batch->id * CDEM_LANES,
                          .u = u,
                          .shared = batch->shared,
                          .last_node = batch->last_node,
                          .linear = body->linear};
}

/* Where the elements of a batch stand: E = R - I, the inverse of tr(U) I - U (Voigt), and
 * b = R^T F_m - I with F_m the mean of F. Row-major; of a plane as of a solid that keeps its z. */
typedef struct {
  double e[9][CDEM_LANES], inverse[6][CDEM_LANES], b[9][CDEM_LANES];
} cdem_body_frames;

/* Isotropic laws without tension of a batch. solid: lambda and mu; plane: D11 + D12 and D11 - D12.
 * active: 1, or 0 for a cell that carries tension or is none. */
typedef struct {
  bool solid;
  double first[CDEM_LANES], second[CDEM_LANES], active[CDEM_LANES];
} cdem_body_isotropic;

/* What openings add to the forces: pull m_i - turn g_i with m_i the mean gradients of the shape
 * functions and g_i those at the centre; global axes. */
typedef struct {
  double pull[9][CDEM_LANES], turn[9][CDEM_LANES];
} cdem_body_pulls;

/* force [nodes][dofs][CDEM_LANES]; energy [CDEM_CLASSES][CDEM_LANES]; stress [6][CDEM_LANES] by one
 * law (cdem_body_law) for all lanes; determinant of F [CDEM_LANES]. */
typedef struct {
  void (*forces)(const cdem_body_task *task, double *force, double *determinant);
  void (*energies)(const cdem_body_task *task, double *energy);
  void (*stresses)(const cdem_body_task *task, const double (*law)[7], double *stress);
  void (*determinants)(const cdem_body_task *task, double *determinant);
  /* mean: of the batch. The second tells whether anything opens; the third adds to the forces of
   * the first of all these functions. */
  void (*frames)(const cdem_body_task *task, const double *mean, cdem_body_frames *frames);
  bool (*opens)(const cdem_body_isotropic *law, const cdem_body_frames *frames, double *opening);
  void (*releases)(const cdem_body_task *task, const double *mean, const cdem_body_pulls *pulls,
                   double *force);
  /* a [size][size][CDEM_LANES] symmetric; bound [CDEM_LANES] of its largest eigenvalue; work as
   * long as a. */
  void (*bounds)(int size, double *a, double *work, double *bound);
} cdem_body_kernels;
/* For vectors of 8, 4 or 2 doubles, NULL where there are none so wide; and the widest there is. */
const cdem_body_kernels *cdem_body_kernels_of_width(int width);
const cdem_body_kernels *cdem_body_kernels_widest(void);

/* Openings [6][CDEM_LANES] of a batch that has cells without tension; false when nothing opens. */
bool cdem_body_openings(const cdem_body *body, const cdem_body_kernels *kernels,
                        const cdem_body_task *task, int64_t n, cdem_body_frames *frames,
                        double opening[6 * CDEM_LANES]);
/* Takes the tension out of the forces of a batch. */
void cdem_body_tension_forces(const cdem_body *body, const cdem_body_kernels *kernels,
                              const cdem_body_task *task, int64_t n, double *force);
/* Takes the tension out of the stress of the cells of a batch. */
void cdem_body_tension_stress(const cdem_body *body, const cdem_body_kernels *kernels,
                              const cdem_body_task *task, int64_t n, double *stress);

#endif
