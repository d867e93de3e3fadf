/* The stream: chunks of cells through moments, blocks and decomposition, in parallel, out in order.
 *
 * Within a chunk, cells of one kind are converted CDEM_LANES at a time. Each cell's pairs have a
 * fixed place in the chunk, and no result depends on a lane's neighbours, so the output is the same
 * for any number of threads. */
#include "network/network.h"

#include <math.h>
#include <omp.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* A chunk stays within a core's cache: 64 hexahedra are 1792 pairs or about 0.8 MB. */
enum { CHUNK_PAIRS = 1792 };

typedef struct {
  cdem_pair *pair;       /* [largest chunk] */
  double *coordinates;   /* [nodes][3][LANES] */
  double *moment;        /* [pairs][9][LANES] */
  double *block;         /* [pairs][9][LANES] */
  bool *frame;           /* [pairs][LANES] */
  cdem_spring_set **set; /* [pairs][LANES] where each set goes; NULL: idle lane */
  cdem_buffer *buffer;   /* [sinks] */
} workspace;

typedef struct {
  const cdem_model *model;
  const cdem_convert_options *options;
  const cdem_pair_sink *sinks;
  int sink_count;
  int32_t chunk_cells;
  int64_t chunk_pairs; /* most pairs of one chunk */
} conversion;

cdem_status cdem_buffer_reserve(cdem_buffer *buffer, int64_t more, cdem_fault *fault) {
  return cdem_grow(&buffer->data, &buffer->capacity, buffer->used + more, 1, fault);
}

void cdem_buffer_release(cdem_buffer *buffer) {
  free(buffer->data);
  memset(buffer, 0, sizeof *buffer);
}

static void workspace_release(workspace *work, int sink_count) {
  free(work->pair);
  free(work->coordinates);
  free(work->moment);
  free(work->block);
  free(work->frame);
  free(work->set);
  for (int i = 0; work->buffer != NULL && i < sink_count; i++)
    cdem_buffer_release(&work->buffer[i]);
  free(work->buffer);
}

static cdem_status workspace_init(const conversion *task, workspace *work, cdem_fault *fault) {
  int64_t lanes = (int64_t)CDEM_MAX_PAIRS * CDEM_LANES;
  CDEM_NEW(work->pair, task->chunk_pairs, fault);
  CDEM_NEW(work->coordinates, CDEM_SHAPE_MAX_NODES * 3 * CDEM_LANES, fault);
  CDEM_NEW(work->moment, lanes * 9, fault);
  CDEM_NEW(work->block, lanes * 9, fault);
  CDEM_NEW(work->frame, lanes, fault);
  CDEM_NEW(work->set, lanes, fault);
  CDEM_NEW(work->buffer, task->sink_count, fault);
  return CDEM_OK;
}

/* Coordinates of `cells` <= LANES cells side by side; the last one fills the idle lanes. */
static void gather(const cdem_model *model, const int32_t *index, int cells, double *x) {
  int nodes = cdem_element_nodes(cdem_model_element(model, index[0]));
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    double xyz[CDEM_SHAPE_MAX_NODES][3];
    cdem_model_coordinates(model, index[lane < cells ? lane : cells - 1], xyz);
    for (int a = 0; a < nodes; a++)
      for (int c = 0; c < 3; c++)
        x[(a * 3 + c) * CDEM_LANES + lane] = xyz[a][c];
  }
}

/* Cosserat blocks are decomposed with the rotation scaled by a length, so that every entry is N/m:
 * row and column of omega are divided by it, and the third components of dir and dual multiplied
 * afterwards. */
static void scale_rotation(double *block, int pairs, double factor) {
  for (int p = 0; p < pairs; p++)
    for (int e = 0; e < 9; e++) {
      double f = (e / 3 == 2 ? factor : 1.0) * (e % 3 == 2 ? factor : 1.0);
      for (int lane = 0; lane < CDEM_LANES; lane++)
        block[(p * 9 + e) * CDEM_LANES + lane] *= f;
    }
}

static void unscale_set(cdem_spring_set *set, double length) {
  for (int r = 0; r < set->rows; r++) {
    set->row[r].dir[2] *= length;
    set->row[r].dual[2] *= length;
  }
}

static cdem_status decompose(const conversion *task, const cdem_element *element, workspace *work,
                             cdem_fault *fault) {
  int pairs = cdem_element_pairs(element), size = cdem_element_dofs(element), entries = size * size;
  int64_t blocks = (int64_t)pairs * CDEM_LANES;
  if (!task->options->reference)
    return cdem_springs_from_blocks_to(work->block, blocks, size, work->frame, work->set, fault);
  for (int64_t i = 0; i < blocks; i++) {
    double s[9];
    for (int e = 0; e < entries; e++)
      s[e] = work->block[(i / CDEM_LANES * entries + e) * CDEM_LANES + i % CDEM_LANES];
    if (work->set[i] != NULL)
      CDEM_TRY(cdem_springs_from_block(s, size, work->frame[i], work->set[i], fault));
  }
  return CDEM_OK;
}

/* Pair p of lane `lane` of the batch into its place. */
static void fill_pair(const cdem_model *model, int32_t index, int lane, int p, int a, int b,
                      const workspace *work, cdem_pair *pair) {
  const cdem_element *element = cdem_model_element(model, index);
  const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[index]);
  int size = cdem_element_dofs(element), entries = size * size;
  pair->index = index;
  pair->node[0] = node[a];
  pair->node[1] = node[b];
  pair->local[0] = (uint8_t)a;
  pair->local[1] = (uint8_t)b;
  pair->class_ = model->kinds_of[model->kind[index]].class_[p];
  for (int e = 0; e < entries; e++)
    pair->block[e] = work->block[(p * entries + e) * CDEM_LANES + lane];
}

/* Converts `cells` <= LANES cells of one kind; place[lane]: where the pairs of that cell begin. */
static cdem_status convert_batch(const conversion *task, const int32_t *index, const int64_t *place,
                                 int cells, workspace *work, cdem_fault *fault) {
  const cdem_model *model = task->model;
  const cdem_tabulation *tabulation = &model->kinds_of[model->kind[index[0]]].tabulation;
  const cdem_element *element = tabulation->element;
  int nodes = cdem_element_nodes(element), pairs = cdem_element_pairs(element);
  bool cosserat = model->formulation == CDEM_PLANE_COSSERAT;
  cdem_frame_rule rule = task->options->frame;

  const cdem_contraction *contraction[CDEM_LANES];
  double least[CDEM_LANES];
  for (int lane = 0; lane < CDEM_LANES; lane++)
    contraction[lane] =
        &model->contraction[model->material[index[lane < cells ? lane : cells - 1]]];
  gather(model, index, cells, work->coordinates);
  cdem_moments_kernel(tabulation, work->coordinates, work->moment, least);
  cdem_blocks_kernel(pairs, contraction, work->moment, work->block);
  if (cosserat)
    scale_rotation(work->block, pairs, 1.0 / model->length);

  for (int p = 0; p < pairs; p++) {
    bool body = model->kinds_of[model->kind[index[0]]].class_[p] == CDEM_CLASS_BODY;
    bool frame = !cosserat && (rule == CDEM_FRAME_ALL || (rule == CDEM_FRAME_BODY && body));
    for (int lane = 0; lane < CDEM_LANES; lane++) {
      work->frame[p * CDEM_LANES + lane] = frame;
      work->set[p * CDEM_LANES + lane] = lane < cells ? &work->pair[place[lane] + p].set : NULL;
    }
  }
  CDEM_TRY(decompose(task, element, work, fault));
  if (cosserat)
    scale_rotation(work->block, pairs, model->length);

  for (int lane = 0; lane < cells; lane++)
    for (int a = 0, p = 0; a < nodes; a++)
      for (int b = a + 1; b < nodes; b++, p++) {
        cdem_pair *pair = &work->pair[place[lane] + p];
        fill_pair(model, index[lane], lane, p, a, b, work, pair);
        if (cosserat)
          unscale_set(&pair->set, model->length);
      }
  return CDEM_OK;
}

/* Drops the pairs the caller did not ask for; returns how many stay. */
static int64_t filter(const cdem_convert_options *options, cdem_pair *pair, int64_t pairs) {
  if (options->class_mask == 0 && options->form_mask == 0)
    return pairs;
  int64_t kept = 0;
  for (int64_t i = 0; i < pairs; i++) {
    bool in_class = options->class_mask == 0 || (options->class_mask >> pair[i].class_ & 1u);
    bool in_form = options->form_mask == 0 || (options->form_mask >> pair[i].set.form & 1u);
    if (in_class && in_form)
      pair[kept++] = pair[i];
  }
  return kept;
}

/* Cells first .. last - 1 of the model, all kinds, into work->pair. */
static cdem_status convert_chunk(const conversion *task, int32_t first, int32_t last,
                                 workspace *work, int64_t *pairs, cdem_fault *fault) {
  const cdem_model *model = task->model;
  int64_t total = 0;
  for (int kind = 0; kind < model->kinds; kind++) {
    int32_t index[CDEM_LANES];
    int64_t place[CDEM_LANES] = {0};
    int filled = 0;
    total = 0;
    for (int32_t i = first; i < last; i++) {
      if (model->kind[i] == kind) {
        index[filled] = i;
        place[filled++] = total;
      }
      total += cdem_element_pairs(cdem_model_element(model, i));
      if (filled == CDEM_LANES || (filled > 0 && i == last - 1)) {
        CDEM_TRY(convert_batch(task, index, place, filled, work, fault));
        filled = 0;
      }
    }
  }
  *pairs = filter(task->options, work->pair, total);
  return CDEM_OK;
}

static cdem_status encode(const conversion *task, const cdem_chunk *chunk, workspace *work,
                          cdem_fault *fault) {
  for (int i = 0; i < task->sink_count; i++) {
    work->buffer[i].used = 0;
    if (task->sinks[i].encode != NULL)
      CDEM_TRY(task->sinks[i].encode(task->sinks[i].context, chunk, &work->buffer[i], fault));
  }
  return CDEM_OK;
}

static cdem_status write_out(const conversion *task, const cdem_chunk *chunk, const workspace *work,
                             int32_t done, cdem_fault *fault) {
  for (int i = 0; i < task->sink_count; i++)
    CDEM_TRY(task->sinks[i].write(task->sinks[i].context, chunk, &work->buffer[i], fault));
  return cdem_progress_report(task->options->progress, "converting elements", done,
                              task->model->cells, fault);
}

/* Chunks are taken by any thread and handed out in order: who is early sleeps until it is its turn.
 */
typedef struct {
  pthread_mutex_t lock;
  pthread_cond_t turned;
  int64_t chunks, next, turn; /* next chunk to take, chunk whose turn it is to be written */
  cdem_status status;         /* the first failure, in the order of the chunks */
  cdem_fault fault;
} queue;

/* The next chunk, or -1 when all are taken or one has failed. */
static int64_t take_chunk(queue *q) {
  pthread_mutex_lock(&q->lock);
  int64_t chunk = q->status == CDEM_OK && q->next < q->chunks ? q->next++ : -1;
  pthread_mutex_unlock(&q->lock);
  return chunk;
}

/* Writes a converted chunk when its turn comes. */
static void hand_over(const conversion *task, queue *q, int64_t number, const cdem_chunk *chunk,
                      const workspace *work, cdem_status status, cdem_fault *own) {
  int32_t done = (int32_t)fmin((double)(number + 1) * task->chunk_cells, task->model->cells);
  pthread_mutex_lock(&q->lock);
  while (q->turn != number)
    pthread_cond_wait(&q->turned, &q->lock);
  bool go_on = q->status == CDEM_OK;
  pthread_mutex_unlock(&q->lock);
  if (go_on && status == CDEM_OK)
    status = write_out(task, chunk, work, done, own);
  pthread_mutex_lock(&q->lock);
  if (go_on && status != CDEM_OK) {
    q->status = status;
    q->fault = *own;
  }
  q->turn++;
  pthread_cond_broadcast(&q->turned);
  pthread_mutex_unlock(&q->lock);
}

/* One thread's share. A thread without memory takes no chunk; when none has any, the work has
 * failed. */
static void convert_in_team(const conversion *task, queue *q, int64_t *ready_threads) {
  const cdem_model *model = task->model;
  workspace work = {0};
  cdem_fault own = {0};
  if (workspace_init(task, &work, &own) == CDEM_OK) {
#pragma omp atomic
    ++*ready_threads;
    for (int64_t c = take_chunk(q); c >= 0; c = take_chunk(q)) {
      int32_t first = (int32_t)(c * task->chunk_cells), last = first + task->chunk_cells;
      cdem_chunk chunk = {.model = model, .pair = work.pair};
      cdem_status status = convert_chunk(task, first, last < model->cells ? last : model->cells,
                                         &work, &chunk.pairs, &own);
      if (status == CDEM_OK)
        status = encode(task, &chunk, &work, &own);
      hand_over(task, q, c, &chunk, &work, status, &own);
    }
  }
  workspace_release(&work, task->sink_count);
}

cdem_status cdem_network_convert(const cdem_model *model, const cdem_convert_options *options,
                                 const cdem_pair_sink *sinks, int sink_count, cdem_fault *fault) {
  int most = 0;
  for (int i = 0; i < model->kinds; i++) {
    int pairs = cdem_element_pairs(model->kinds_of[i].tabulation.element);
    most = pairs > most ? pairs : most;
  }
  int32_t cells = most > 0 ? CHUNK_PAIRS / most / CDEM_LANES * CDEM_LANES : CDEM_LANES;
  cells = cells < CDEM_LANES ? CDEM_LANES : cells;
  const conversion task = {.model = model,
                           .options = options,
                           .sinks = sinks,
                           .sink_count = sink_count,
                           .chunk_cells = cells,
                           .chunk_pairs = (int64_t)cells * most};
  queue q = {.lock = PTHREAD_MUTEX_INITIALIZER,
             .turned = PTHREAD_COND_INITIALIZER,
             .chunks = ((int64_t)model->cells + cells - 1) / cells};
  int64_t ready_threads = 0;
#pragma omp parallel num_threads(options->threads > 0 ? options->threads : omp_get_max_threads())
  convert_in_team(&task, &q, &ready_threads);
  if (ready_threads == 0)
    return cdem_fail(fault, CDEM_MEMORY, "out of memory: no room for a chunk of %d elements",
                     (int)cells);
  if (q.status != CDEM_OK && fault != NULL && fault->status == CDEM_OK)
    *fault = q.fault;
  return q.status;
}
