/* Tiles and batches: cells along a Morton curve, cut into tiles, sorted within a tile so that cells
 * of one template stand together. */
#include "cdem/body_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A rest of a template of at least so many cells still gets a batch of its own template: idle lanes
 * cost less than own records. */
enum { FEWEST_SHARED = 4 };

typedef struct {
  uint64_t key;
  int32_t cell;
} spot;

/* A cell within its tile. */
typedef struct {
  int32_t kind, template_, rank, cell;
} member;

typedef struct {
  const cdem_model *model;
  const int32_t *template_of;
  cdem_body_store *store;
  int32_t *uses;       /* [cells] of the template with that lowest cell */
  int64_t *record;     /* [cells] 1 + offset of its shared record; 0: none yet */
  spot *spot;          /* [cells] */
  int64_t capacity[3]; /* of batch, cell, id */
  int32_t rows;        /* of the present tile */
} arrangement;

static int by_key(const void *a, const void *b) {
  const spot *p = a, *q = b;
  return p->key != q->key ? (p->key < q->key ? -1 : 1) : (p->cell > q->cell) - (p->cell < q->cell);
}

static int by_template(const void *a, const void *b) {
  const member *p = a, *q = b;
  if (p->kind != q->kind)
    return p->kind < q->kind ? -1 : 1;
  if (p->template_ != q->template_)
    return p->template_ < q->template_ ? -1 : 1;
  return (p->rank > q->rank) - (p->rank < q->rank);
}

/* Centre of a cell: the mean of its nodes. */
static void centre(const cdem_model *model, int32_t cell, double out[3]) {
  const cdem_mesh *mesh = model->mesh;
  const int32_t *node = cdem_mesh_cell(mesh, model->cell[cell]);
  int nodes = cdem_element_nodes(cdem_model_element(model, cell));
  for (int c = 0; c < 3; c++) {
    out[c] = 0.0;
    for (int a = 0; a < nodes; a++)
      out[c] += mesh->xyz[3 * (int64_t)node[a] + c] / nodes;
  }
}

static uint64_t interleave(const double place[3], const double low[3], double scale,
                           int dimension) {
  int bits = dimension == 3 ? 21 : 31;
  uint64_t key = 0;
  for (int c = 0; c < dimension; c++) {
    uint64_t q = (uint64_t)((place[c] - low[c]) * scale * (double)((UINT64_C(1) << bits) - 1));
    for (int b = 0; b < bits; b++)
      key |= (q >> b & 1u) << (b * dimension + c);
  }
  return key;
}

static void sort_cells(const cdem_model *model, spot *spot_of) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  double place[3], size = 0.0;
  for (int32_t i = 0; i < model->cells; i++) {
    centre(model, i, place);
    for (int c = 0; c < 3; c++) {
      low[c] = fmin(low[c], place[c]);
      high[c] = fmax(high[c], place[c]);
    }
  }
  for (int c = 0; c < 3; c++)
    size = fmax(size, high[c] - low[c]);
  double scale = size > 0.0 ? 1.0 / size : 0.0;
  for (int32_t i = 0; i < model->cells; i++) {
    centre(model, i, place);
    spot_of[i] = (spot){interleave(place, low, scale, model->dimension), i};
  }
  qsort(spot_of, (size_t)model->cells, sizeof *spot_of, by_key);
}

/* Appends a batch of `cells` members. */
static cdem_status add_batch(arrangement *task, const member *from, int cells, bool shared,
                             cdem_fault *fault) {
  cdem_body_store *store = task->store;
  const cdem_body_kind *kind = &store->kind[from->kind];
  const cdem_mesh *mesh = task->model->mesh;
  int64_t n = store->batches;
  CDEM_TRY(cdem_grow(&store->batch, &task->capacity[0], n + 1, sizeof *store->batch, fault));
  CDEM_TRY(cdem_grow(&store->cell, &task->capacity[1], (n + 1) * CDEM_LANES, sizeof *store->cell,
                     fault));
  CDEM_TRY(cdem_grow(&store->id, &task->capacity[2], (store->ids + kind->nodes) * CDEM_LANES,
                     sizeof *store->id, fault));
  cdem_body_batch *batch = &store->batch[n];
  *batch = (cdem_body_batch){.id = (int32_t)store->ids,
                             .row = (uint16_t)task->rows,
                             .kind = (uint8_t)from->kind,
                             .cells = (uint8_t)cells,
                             .shared = shared,
                             .record = store->doubles};
  if (!shared) {
    store->doubles += (int64_t)CDEM_LANES * kind->record;
    store->own_doubles += (int64_t)CDEM_LANES * kind->record;
  } else if (task->record[from->template_] == 0) {
    batch->fills = true;
    task->record[from->template_] = 1 + store->doubles;
    store->doubles += kind->record;
  }
  if (shared)
    batch->record = task->record[from->template_] - 1;
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    int32_t cell = from[lane < cells ? lane : cells - 1].cell;
    const int32_t *node = cdem_mesh_cell(mesh, task->model->cell[cell]);
    store->cell[n * CDEM_LANES + lane] = lane < cells ? cell : -1;
    if (lane < cells)
      store->place[cell] = (int32_t)(n * CDEM_LANES + lane);
    for (int a = 0; a < kind->nodes; a++) {
      store->id[(store->ids + a) * CDEM_LANES + lane] = node[a];
      batch->last_node = batch->last_node || node[a] == mesh->nodes - 1;
    }
  }
  store->batches++;
  store->ids += kind->nodes;
  task->rows += kind->nodes;
  return CDEM_OK;
}

/* Batches of the sorted members of one tile: whole batches of a template first, then the rests of
 * a kind together. */
static cdem_status add_tile(arrangement *task, member *m, int members, cdem_fault *fault) {
  member rest[CDEM_BODY_TILE];
  task->rows = 0;
  for (int start = 0; start < members;) {
    int kind = m[start].kind, rests = 0;
    while (start < members && m[start].kind == kind) {
      int end = start + 1;
      while (end < members && m[end].kind == kind && m[end].template_ == m[start].template_)
        end++;
      bool several = task->uses[m[start].template_] >= FEWEST_SHARED;
      while (several && end - start >= FEWEST_SHARED) {
        int cells = end - start < CDEM_LANES ? end - start : CDEM_LANES;
        CDEM_TRY(add_batch(task, m + start, cells, true, fault));
        start += cells;
      }
      for (; start < end; start++)
        rest[rests++] = m[start];
    }
    for (int i = 0; i < rests; i += CDEM_LANES)
      CDEM_TRY(
          add_batch(task, rest + i, rests - i < CDEM_LANES ? rests - i : CDEM_LANES, false, fault));
  }
  if (task->rows > task->store->rows)
    task->store->rows = task->rows;
  return CDEM_OK;
}

static cdem_status add_tiles(arrangement *task, cdem_fault *fault) {
  const cdem_model *model = task->model;
  cdem_body_store *store = task->store;
  sort_cells(model, task->spot);
  for (int32_t i = 0; i < model->cells; i++)
    task->uses[task->template_of[i]]++;
  for (int32_t t = 0; t < store->tiles; t++) {
    member m[CDEM_BODY_TILE];
    int members = 0;
    for (int32_t i = t * CDEM_BODY_TILE; i < model->cells && members < CDEM_BODY_TILE; i++) {
      int32_t cell = task->spot[i].cell;
      m[members] = (member){model->kind[cell], task->template_of[cell], members, cell};
      /* Cells without a like keep their order along the curve. */
      if (task->uses[task->template_of[cell]] < FEWEST_SHARED)
        m[members].template_ = INT32_MAX;
      members++;
    }
    qsort(m, (size_t)members, sizeof *m, by_template);
    for (int i = 0; i < members; i++)
      m[i].template_ = task->template_of[m[i].cell];
    CDEM_TRY(add_tile(task, m, members, fault));
    store->tile_batch[t + 1] = store->batches;
  }
  return CDEM_OK;
}

cdem_status cdem_body_arrange(const cdem_model *model, const int32_t *template_of,
                              cdem_body_store *store, cdem_fault *fault) {
  store->tiles = (model->cells + CDEM_BODY_TILE - 1) / CDEM_BODY_TILE;
  CDEM_BODY_NEW(store, store->tile_batch, store->tiles + 1, fault);
  CDEM_BODY_NEW(store, store->place, model->cells, fault);
  arrangement task = {.model = model,
                      .template_of = template_of,
                      .store = store,
                      .uses = cdem_allocate(model->cells, sizeof *task.uses, fault),
                      .record = cdem_allocate(model->cells, sizeof *task.record, fault),
                      .spot = cdem_allocate(model->cells, sizeof *task.spot, fault)};
  cdem_status status = CDEM_MEMORY;
  if (task.uses != NULL && task.record != NULL && task.spot != NULL)
    status = add_tiles(&task, fault);
  store->bytes += task.capacity[0] * (int64_t)sizeof *store->batch +
                  (task.capacity[1] + task.capacity[2]) * (int64_t)sizeof *store->cell;
  free(task.uses);
  free(task.record);
  free(task.spot);
  return status;
}
