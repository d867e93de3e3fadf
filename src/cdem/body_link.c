/* Gather lists: which element forces make up the force of a node, tile by tile. */
#include "cdem/body_store.h"

#include <stdlib.h>

typedef struct {
  int32_t *touching; /* [nodes] element nodes there, over the whole body */
  int32_t *tile_of;  /* [nodes] 1 + the tile last seen there */
  int32_t *target;   /* [nodes] its target in that tile, from the tile's first */
  int32_t *tiles;    /* [nodes] tiles that end at a partial sum there */
  int32_t *count;    /* [targets of a tile] entries, then the next free one */
  int64_t capacity[2];
  int64_t targets, entries;
} linking;

/* One loop over the element nodes in use of a tile; entry row * CDEM_LANES + lane. */
#define EACH_ENTRY(store, t)                                                                       \
  for (int64_t b = (store)->tile_batch[t]; b < (store)->tile_batch[(t) + 1]; b++)                  \
    for (int a = 0; a < (store)->kind[(store)->batch[b].kind].nodes; a++)                          \
      for (int lane = 0; lane < (store)->batch[b].cells; lane++)
#define ENTRY_NODE(store) ((store)->id[((int64_t)(store)->batch[b].id + a) * CDEM_LANES + lane])

static cdem_status link_tile(cdem_body_store *store, int32_t t, linking *work, cdem_fault *fault) {
  int64_t first = work->targets;
  EACH_ENTRY(store, t) {
    int32_t node = ENTRY_NODE(store);
    if (work->tile_of[node] != t + 1) {
      CDEM_TRY(cdem_grow(&store->target, &work->capacity[0], work->targets + 1,
                         sizeof *store->target, fault));
      work->tile_of[node] = t + 1;
      work->target[node] = (int32_t)(work->targets - first);
      work->count[work->targets - first] = 0;
      store->target[work->targets++] = node;
    }
    work->count[work->target[node]]++;
  }
  CDEM_TRY(cdem_grow(&store->entry_start, &work->capacity[1], work->targets + 1,
                     sizeof *store->entry_start, fault));
  for (int64_t i = first; i < work->targets; i++) {
    int32_t node = store->target[i], count = work->count[i - first];
    store->entry_start[i] = work->entries;
    work->count[i - first] = 0;
    work->entries += count;
    if (count < work->touching[node])
      work->tiles[node]++;
  }
  store->entry_start[work->targets] = work->entries;
  EACH_ENTRY(store, t) {
    int32_t target = work->target[ENTRY_NODE(store)];
    store->entry[store->entry_start[first + target] + work->count[target]++] =
        (uint16_t)((store->batch[b].row + a) * CDEM_LANES + lane);
  }
  store->tile_node[t + 1] = work->targets;
  return CDEM_OK;
}

/* Slots of partial sums, node by node and in the order of the tiles. */
static cdem_status link_joints(int32_t nodes, cdem_body_store *store, linking *work, int dofs,
                               cdem_fault *fault) {
  int64_t slots = 0;
  for (int32_t n = 0; n < nodes; n++) {
    store->joints += work->tiles[n] > 0;
    store->lonely += work->touching[n] == 0;
  }
  CDEM_BODY_NEW(store, store->joint, store->joints, fault);
  CDEM_BODY_NEW(store, store->joint_start, store->joints + 1, fault);
  CDEM_BODY_NEW(store, store->lonely_node, store->lonely, fault);
  int32_t joint = 0, lonely = 0;
  for (int32_t n = 0; n < nodes; n++) {
    if (work->touching[n] == 0)
      store->lonely_node[lonely++] = n;
    if (work->tiles[n] == 0) {
      work->target[n] = -1;
      continue;
    }
    work->target[n] = (int32_t)slots; /* the next free slot */
    store->joint[joint++] = n;
    slots += work->tiles[n];
    store->joint_start[joint] = slots;
  }
  for (int64_t i = 0; i < work->targets; i++)
    if (work->target[store->target[i]] >= 0)
      store->target[i] = -1 - work->target[store->target[i]]++;
  CDEM_BODY_NEW(store, store->partial, slots * dofs, fault);
  return CDEM_OK;
}

static cdem_status link_all(const cdem_model *model, cdem_body_store *store, linking *work,
                            cdem_fault *fault) {
  for (int32_t t = 0; t < store->tiles; t++)
    EACH_ENTRY(store, t) {
      work->touching[ENTRY_NODE(store)]++;
      work->entries++;
    }
  CDEM_BODY_NEW(store, store->entry, work->entries, fault);
  work->entries = 0;
  for (int32_t t = 0; t < store->tiles; t++)
    CDEM_TRY(link_tile(store, t, work, fault));
  store->bytes += work->capacity[0] * (int64_t)sizeof *store->target +
                  work->capacity[1] * (int64_t)sizeof *store->entry_start;
  return link_joints(model->mesh->nodes, store, work, model->dofs, fault);
}

cdem_status cdem_body_link(const cdem_model *model, int threads, cdem_body_store *store,
                           cdem_fault *fault) {
  int32_t nodes = model->mesh->nodes;
  CDEM_BODY_NEW(store, store->tile_node, store->tiles + 1, fault);
  CDEM_BODY_NEW(store, store->tile_energy, (int64_t)store->tiles * CDEM_CLASSES, fault);
  CDEM_BODY_NEW(store, store->buffer, (int64_t)threads * store->rows * model->dofs * CDEM_LANES,
                fault);
  linking work = {.touching = cdem_allocate(nodes, sizeof *work.touching, fault),
                  .tile_of = cdem_allocate(nodes, sizeof *work.tile_of, fault),
                  .target = cdem_allocate(nodes, sizeof *work.target, fault),
                  .tiles = cdem_allocate(nodes, sizeof *work.tiles, fault),
                  .count =
                      cdem_allocate(CDEM_BODY_TILE * CDEM_BODY_NODES, sizeof *work.count, fault)};
  cdem_status status = CDEM_MEMORY;
  if (work.touching != NULL && work.tile_of != NULL && work.target != NULL && work.tiles != NULL &&
      work.count != NULL)
    status = link_all(model, store, &work, fault);
  free(work.touching);
  free(work.tile_of);
  free(work.target);
  free(work.tiles);
  free(work.count);
  return status;
}
