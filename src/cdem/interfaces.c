/* Interfaces: setting up points, gather lists and ties. */
#include "cdem/interfaces.h"

#include "cdem/interfaces_store.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static cdem_status check_options(const cdem_interfaces_options *options, cdem_fault *fault) {
  const cdem_blocks *blocks = options->blocks;
  CDEM_REQUIRE(options->dofs >= blocks->dimension, fault, CDEM_USAGE,
               "%d unknowns a node cannot hold %d displacements", options->dofs, blocks->dimension);
  CDEM_REQUIRE(blocks->dimension == 3 || (isfinite(options->thickness) && options->thickness > 0),
               fault, CDEM_INPUT, "interfaces in 2-D need a positive thickness, not %g m",
               options->thickness);
  CDEM_REQUIRE(isfinite(options->release) && options->release > 0, fault, CDEM_INPUT,
               "release = %g; it must be a positive fraction of the face's size", options->release);
  for (int l = 0; l < options->laws; l++)
    CDEM_TRY(cdem_interface_law_check(&options->law[l], fault));
  for (int32_t p = 0; p < blocks->pairs; p++)
    CDEM_REQUIRE(options->law_of[p] >= -1 && options->law_of[p] < options->laws, fault, CDEM_USAGE,
                 "face pair %" PRId32 " names law %" PRId32 " of %d", p, options->law_of[p],
                 options->laws);
  return CDEM_OK;
}

static cdem_status copy_laws(const cdem_interfaces_options *options, cdem_interfaces *interfaces,
                             cdem_fault *fault) {
  int32_t pairs = options->blocks->pairs;
  CDEM_NEW(interfaces->law, options->laws, fault);
  CDEM_NEW(interfaces->law_of, pairs, fault);
  CDEM_NEW(interfaces->released, pairs, fault);
  for (int l = 0; l < options->laws; l++)
    interfaces->law[l] = options->law[l];
  for (int32_t p = 0; p < pairs; p++) {
    interfaces->law_of[p] = options->law_of[p];
    interfaces->released[p] = options->law_of[p] < 0;
  }
  return CDEM_OK;
}

/* Areas, sizes and first phases of the points of one pair. */
static void start_pair(cdem_interfaces *interfaces, int32_t p) {
  cdem_interfaces_store *store = interfaces->store;
  const cdem_blocks *blocks = interfaces->blocks;
  const cdem_face_pair *pair = &blocks->pair[p];
  const cdem_interface_law *law = &interfaces->law[interfaces->law_of[p]];
  double area[3], share[4];
  cdem_facet_area(&blocks->facet[blocks->pair_facet[2 * (int64_t)p]], blocks->mesh.xyz,
                  interfaces->thickness, area, share);
  double size = cdem_norm3(area);
  store->size[p] = blocks->dimension == 3 ? sqrt(size) : size / interfaces->thickness;
  bool loose = cdem_interface_is_loose(law), welded = true;
  for (int k = 0; k < pair->corners; k++)
    welded &= pair->node[0][k] == pair->node[1][k];
  store->tied[p] = law->insertion == CDEM_INSERTION_TIED && !loose && !welded;
  store->tied_faces += store->tied[p];
  for (int k = 0; k < pair->corners; k++) {
    int64_t at = store->first[p] + k;
    store->area[at] = share[k];
    store->point[at].damage = loose;
    store->phase[at] = pair->node[0][k] == pair->node[1][k] ? CDEM_POINT_NONE
                       : store->tied[p]                     ? CDEM_POINT_TIED
                       : loose                              ? CDEM_POINT_ACTIVE
                                                            : CDEM_POINT_VIRGIN;
  }
}

static cdem_status make_points(cdem_interfaces *interfaces, cdem_fault *fault) {
  cdem_interfaces_store *store = interfaces->store;
  const cdem_blocks *blocks = interfaces->blocks;
  CDEM_NEW(store->first, (int64_t)blocks->pairs + 1, fault);
  for (int32_t p = 0; p < blocks->pairs; p++)
    store->first[p + 1] =
        store->first[p] + (interfaces->law_of[p] >= 0 ? blocks->pair[p].corners : 0);
  store->points = store->first[blocks->pairs];
  CDEM_NEW(store->area, store->points, fault);
  CDEM_NEW(store->size, blocks->pairs, fault);
  CDEM_NEW(store->phase, store->points, fault);
  CDEM_NEW(store->point, store->points, fault);
  CDEM_NEW(store->force, store->points * 2 * store->dimension, fault);
  CDEM_NEW(store->tied, blocks->pairs, fault);
  CDEM_NEW(store->opens, blocks->pairs, fault);
  store->chunks = (blocks->pairs + CDEM_INTERFACE_CHUNK - 1) / CDEM_INTERFACE_CHUNK;
  CDEM_NEW(store->part, store->chunks, fault);
  for (int32_t p = 0; p < blocks->pairs; p++)
    if (interfaces->law_of[p] >= 0)
      start_pair(interfaces, p);
  return CDEM_OK;
}

/* Calls of the two passes below: counts first, then places. start [of + 1] zeroed. */
static void place(int64_t *start, int64_t *list, int64_t key, int64_t value) {
  if (list == NULL)
    start[key + 1]++;
  else
    list[start[key]++] = value;
}

static void add_up(int64_t *start, int64_t of) {
  for (int64_t i = 0; i < of; i++)
    start[i + 1] += start[i];
}

/* After placing, start[i] is the end of i; shifts back. */
static void shift_back(int64_t *start, int64_t of) {
  for (int64_t i = of; i > 0; i--)
    start[i] = start[i - 1];
  start[0] = 0;
}

static void walk_points(const cdem_interfaces *interfaces, int64_t *start, int64_t *list) {
  const cdem_interfaces_store *store = interfaces->store;
  for (int32_t p = 0; p < interfaces->blocks->pairs; p++)
    for (int64_t at = store->first[p]; at < store->first[p + 1]; at++)
      for (int side = 0; side < 2; side++)
        place(start, list, interfaces->blocks->pair[p].node[side][at - store->first[p]],
              2 * at + side);
}

/* Lists by node; then only the nodes that have any are kept. */
static cdem_status make_gather(cdem_interfaces *interfaces, cdem_fault *fault) {
  cdem_interfaces_store *store = interfaces->store;
  int32_t nodes = interfaces->blocks->mesh.nodes;
  CDEM_NEW(store->gather_start, (int64_t)nodes + 1, fault);
  CDEM_NEW(store->gather, 2 * store->points, fault);
  CDEM_NEW(store->node, nodes, fault);
  walk_points(interfaces, store->gather_start, NULL);
  add_up(store->gather_start, nodes);
  walk_points(interfaces, store->gather_start, store->gather);
  shift_back(store->gather_start, nodes);
  for (int32_t n = 0; n < nodes; n++) {
    int64_t from = store->gather_start[n], to = store->gather_start[n + 1];
    if (from == to)
      continue;
    store->node[store->nodes] = n;
    store->gather_start[store->nodes++] = from;
  }
  store->gather_start[store->nodes] = store->gather_start[nodes];
  return CDEM_OK;
}

static void walk_ties(const cdem_interfaces *interfaces, int64_t *start, int64_t *list) {
  const cdem_blocks *blocks = interfaces->blocks;
  for (int32_t p = 0; p < blocks->pairs; p++)
    for (int k = 0; interfaces->store->tied[p] && k < blocks->pair[p].corners; k++)
      place(start, list, blocks->original[blocks->pair[p].node[0][k]], 4 * (int64_t)p + k);
}

static cdem_status make_ties(cdem_interfaces *interfaces, cdem_fault *fault) {
  cdem_interfaces_store *store = interfaces->store;
  const cdem_blocks *blocks = interfaces->blocks;
  int32_t nodes = blocks->mesh.nodes;
  int64_t originals = nodes > 0 ? (int64_t)blocks->original[nodes - 1] + 1 : 0;
  CDEM_NEW(store->tie_start, originals + 1, fault);
  CDEM_NEW(store->root, nodes, fault);
  CDEM_NEW(store->room, 2 * (int64_t)nodes, fault);
  CDEM_NEW(interfaces->ties.start, (int64_t)nodes + 1, fault);
  CDEM_NEW(interfaces->ties.member, nodes, fault);
  walk_ties(interfaces, store->tie_start, NULL);
  add_up(store->tie_start, originals);
  CDEM_NEW(store->tie, store->tie_start[originals], fault);
  walk_ties(interfaces, store->tie_start, store->tie);
  shift_back(store->tie_start, originals);
  cdem_interfaces_tie_all(interfaces);
  return CDEM_OK;
}

static cdem_status make_all(const cdem_interfaces_options *options, cdem_interfaces *interfaces,
                            cdem_fault *fault) {
  CDEM_TRY(check_options(options, fault));
  CDEM_TRY(copy_laws(options, interfaces, fault));
  CDEM_NEW(interfaces->store, 1, fault);
  interfaces->store->dimension = options->blocks->dimension;
  interfaces->store->release = options->release;
  interfaces->store->threads = options->threads > 0 ? options->threads : omp_get_max_threads();
  CDEM_TRY(make_points(interfaces, fault));
  CDEM_TRY(make_gather(interfaces, fault));
  return make_ties(interfaces, fault);
}

cdem_status cdem_interfaces_init(const cdem_interfaces_options *options,
                                 cdem_interfaces *interfaces, cdem_fault *fault) {
  *interfaces = (cdem_interfaces){.blocks = options->blocks,
                                  .dofs = options->dofs,
                                  .thickness = options->thickness,
                                  .laws = options->laws};
  cdem_status status = make_all(options, interfaces, fault);
  if (status != CDEM_OK)
    cdem_interfaces_release(interfaces);
  return status;
}

static void release_store(cdem_interfaces_store *store) {
  if (store == NULL)
    return;
  free(store->first);
  free(store->area);
  free(store->size);
  free(store->phase);
  free(store->point);
  free(store->force);
  free(store->part);
  free(store->node);
  free(store->gather_start);
  free(store->gather);
  free(store->tied);
  free(store->opens);
  free(store->root);
  free(store->tie_start);
  free(store->tie);
  free(store->room);
  free(store);
}

void cdem_interfaces_release(cdem_interfaces *interfaces) {
  if (interfaces == NULL)
    return;
  free(interfaces->law);
  free(interfaces->law_of);
  free(interfaces->released);
  free(interfaces->ties.start);
  free(interfaces->ties.member);
  release_store(interfaces->store);
  *interfaces = (cdem_interfaces){0};
}
