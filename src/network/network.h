/* Room network: all springs of a mesh; the only assembler.
 *
 * A model says what is converted: which cells of a mesh, as which element, of which material.
 * Conversion streams: cells go in chunks through stiffness and decomposition (in parallel) and
 * leave as pairs, in the order of the cells, to a sink. Memory is the mesh plus the chunks in
 * flight. The assembler adds spring tensors to a sparse matrix.
 *
 * Cosserat pairs act on d_j - T_ij d_i, T_ij the rigid transport from i to j (springs.md section
 * 4): u_j = u_i + omega_i e_z x (x_j - x_i). Blocks are decomposed with omega scaled by the model's
 * length l, so that all entries are N/m: dir = (p_x, p_y, l p_omega), dual = (q_x, q_y, l q_omega)
 * in the rows.
 */
#ifndef CDEM_NETWORK_NETWORK_H
#define CDEM_NETWORK_NETWORK_H

#include "elements/elements.h"
#include "mesh/mesh.h"
#include "springs/springs.h"

typedef enum { CDEM_FRAME_BODY, CDEM_FRAME_ALL, CDEM_FRAME_NONE } cdem_frame_rule;

/* What to convert. Strings and mesh are borrowed. */
typedef struct {
  const cdem_mesh *mesh;
  int groups;               /* 0: all cells of the highest dimension */
  const char *const *group; /* [groups] names of groups, one dimension */
  int materials;
  const cdem_material *material;     /* [materials] */
  int assignments;                   /* 0: material[0] everywhere */
  const char *const *assigned_group; /* [assignments] cells of this group ... */
  const int *assigned_material;      /* [assignments] ... are of this material */
  int default_material; /* for cells of no assigned group; -1: such a cell is an error */
  cdem_section section;
  int degree;    /* quadrature; 0: each element's full rule */
  double length; /* m, scales omega; 0: square root of the elements' mean area */
} cdem_model_options;

/* Cells of one element kind. */
typedef struct {
  cdem_tabulation tabulation; /* holds the element */
  int64_t cells;
  uint8_t class_[CDEM_MAX_PAIRS]; /* cdem_class of each pair */
} cdem_model_kind;

typedef struct {
  const cdem_mesh *mesh;
  cdem_formulation formulation;
  int dimension, dofs; /* per node */
  cdem_section section;
  double length; /* m; 1 unless Cosserat */
  int32_t cells;
  int32_t *cell;      /* [cells] mesh cell ids, ascending */
  uint8_t *kind;      /* [cells] index into kinds */
  uint16_t *material; /* [cells] index into materials */
  int kinds;
  cdem_model_kind *kinds_of; /* [kinds] */
  int materials;
  cdem_material *materials_of;   /* [materials] */
  cdem_contraction *contraction; /* [materials] */
  int64_t pairs;                 /* over all cells */
} cdem_model;

/* CDEM_INPUT for everything a user can have wrong: unknown group, groups of mixed dimension, no
 * convertible cells, an unsupported cell shape, a cell in two groups of different material, a cell
 * without material, impossible material, 2-D mesh out of plane z = const, inverted or degenerate
 * element (with its tag). CDEM_INPUT too for zero thickness. */
cdem_status cdem_model_init(const cdem_model_options *options, cdem_model *model,
                            cdem_fault *fault);
void cdem_model_release(cdem_model *model);

static inline const cdem_element *cdem_model_element(const cdem_model *model, int32_t index) {
  return model->kinds_of[model->kind[index]].tabulation.element;
}

/* Node coordinates of cell `index` of the model, relative to the cell's first node (springs do not
 * feel a translation, and a mesh far from the origin keeps its digits): xyz [nodes][3]. */
void cdem_model_coordinates(const cdem_model *model, int32_t index, double (*xyz)[3]);

/* One converted pair. */
typedef struct {
  int32_t index;    /* of the cell in the model */
  int32_t node[2];  /* mesh node ids, node[0] before node[1] in the element's own numbering */
  uint8_t local[2]; /* their places in the element, from 0 */
  uint8_t class_;   /* cdem_class */
  double block[9];  /* S_ij row-major [dofs*dofs], N/m (Cosserat: natural units, N and N m too) */
  cdem_spring_set set;
} cdem_pair;

/* Consecutive pairs. */
typedef struct {
  const cdem_model *model;
  int64_t pairs;
  const cdem_pair *pair;
} cdem_chunk;

/* Bytes made by `encode` and consumed by `write`; grows as needed, reused from chunk to chunk. */
typedef struct {
  char *data;
  int64_t used, capacity;
} cdem_buffer;

cdem_status cdem_buffer_reserve(cdem_buffer *buffer, int64_t more, cdem_fault *fault);
void cdem_buffer_release(cdem_buffer *buffer);

/* Where pairs go. `encode` (may be NULL) runs in any thread, several at once, and may only read
 * context; `write` runs in one thread, in the order of the cells. `partial` data worth keeping per
 * chunk goes into the buffer. */
typedef struct {
  void *context;
  cdem_status (*encode)(void *context, const cdem_chunk *chunk, cdem_buffer *buffer,
                        cdem_fault *fault);
  cdem_status (*write)(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                       cdem_fault *fault);
} cdem_pair_sink;

typedef struct {
  cdem_frame_rule frame;
  unsigned class_mask; /* bit 1 << cdem_class; 0: all */
  unsigned form_mask;  /* bit 1 << cdem_form; 0: all */
  bool reference;      /* use the LAPACK path (tests, comparison) */
  int threads;         /* 0: OpenMP's default */
  const cdem_progress *progress;
} cdem_convert_options;

/* Streams every pair of the model to the sinks (all see the same chunks). The result does not
 * depend on the number of threads. */
cdem_status cdem_network_convert(const cdem_model *model, const cdem_convert_options *options,
                                 const cdem_pair_sink *sinks, int sink_count, cdem_fault *fault);

#endif
