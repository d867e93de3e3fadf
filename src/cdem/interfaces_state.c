/* Interfaces: histories into a state and back, to the bit. */
#include "cdem/interfaces_store.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { REALS = 16, BYTES = 3 }; /* of a point; bytes: state, falling, phase */
_Static_assert(offsetof(cdem_interface_point, state) == REALS * sizeof(double),
               "the reals of a point come first, without gaps");

static cdem_status add_points(const cdem_interfaces_store *store, cdem_state *state,
                              cdem_fault *fault) {
  double *reals = cdem_allocate(REALS * store->points, sizeof *reals, fault);
  uint8_t *bytes = cdem_allocate(BYTES * store->points, 1, fault);
  cdem_status status = reals != NULL && bytes != NULL ? CDEM_OK : CDEM_MEMORY;
  for (int64_t at = 0; at < store->points && status == CDEM_OK; at++) {
    memcpy(reals + REALS * at, &store->point[at], REALS * sizeof *reals);
    bytes[BYTES * at] = store->point[at].state;
    bytes[BYTES * at + 1] = store->point[at].falling;
    bytes[BYTES * at + 2] = store->phase[at];
  }
  if (status == CDEM_OK) {
    status = cdem_state_add_owned(state, "interfaces/points", CDEM_ARRAY_REAL,
                                  REALS * store->points, reals, fault);
    reals = status == CDEM_OK ? NULL : reals;
  }
  if (status == CDEM_OK) {
    status = cdem_state_add_owned(state, "interfaces/phases", CDEM_ARRAY_BYTE,
                                  BYTES * store->points, bytes, fault);
    bytes = status == CDEM_OK ? NULL : bytes;
  }
  free(reals);
  free(bytes);
  return status;
}

/* Per pair: 1 released, 2 tied. */
static cdem_status add_pairs(const cdem_interfaces *interfaces, cdem_state *state,
                             cdem_fault *fault) {
  int32_t pairs = interfaces->blocks->pairs;
  uint8_t *flags;
  CDEM_NEW(flags, pairs, fault);
  for (int32_t p = 0; p < pairs; p++)
    flags[p] = (uint8_t)(interfaces->released[p] + 2 * interfaces->store->tied[p]);
  cdem_status status =
      cdem_state_add_owned(state, "interfaces/pairs", CDEM_ARRAY_BYTE, pairs, flags, fault);
  if (status != CDEM_OK)
    free(flags);
  return status;
}

cdem_status cdem_interfaces_save(const cdem_interfaces *interfaces, cdem_state *state,
                                 cdem_fault *fault) {
  const cdem_interfaces_store *store = interfaces->store;
  const double energy[4] = {store->stored, store->fracture, store->friction, store->constant};
  const int64_t version[2] = {interfaces->version, interfaces->ties.version};
  CDEM_TRY(add_points(store, state, fault));
  CDEM_TRY(add_pairs(interfaces, state, fault));
  CDEM_TRY(cdem_state_add_copy(state, "interfaces/energies", CDEM_ARRAY_REAL, 4, energy, fault));
  return cdem_state_add_copy(state, "interfaces/versions", CDEM_ARRAY_INT64, 2, version, fault);
}

/* What a state holds, before anything is overwritten. */
typedef struct {
  double *reals, energy[4];
  uint8_t *bytes, *flags;
  int64_t version[2];
} contents;

static cdem_status read_state(const cdem_interfaces *interfaces, const cdem_state *state,
                              contents *kept, cdem_fault *fault) {
  int64_t points = interfaces->store->points, pairs = interfaces->blocks->pairs;
  CDEM_NEW(kept->reals, REALS * points, fault);
  CDEM_NEW(kept->bytes, BYTES * points, fault);
  CDEM_NEW(kept->flags, pairs, fault);
  CDEM_TRY(cdem_state_get(state, "interfaces/points", CDEM_ARRAY_REAL, REALS * points, kept->reals,
                          fault));
  CDEM_TRY(cdem_state_get(state, "interfaces/phases", CDEM_ARRAY_BYTE, BYTES * points, kept->bytes,
                          fault));
  CDEM_TRY(cdem_state_get(state, "interfaces/pairs", CDEM_ARRAY_BYTE, pairs, kept->flags, fault));
  CDEM_TRY(cdem_state_get(state, "interfaces/energies", CDEM_ARRAY_REAL, 4, kept->energy, fault));
  CDEM_TRY(cdem_state_get(state, "interfaces/versions", CDEM_ARRAY_INT64, 2, kept->version, fault));
  for (int v = 0; v < 2; v++)
    CDEM_REQUIRE(kept->version[v] >= 0 && kept->version[v] < INT64_MAX / 2, fault, CDEM_INPUT,
                 "the array 'interfaces/versions' of the checkpoint does not belong to this case");
  for (int64_t p = 0; p < pairs; p++) {
    bool none = interfaces->law_of[p] < 0;
    CDEM_REQUIRE(kept->flags[p] <= 2 && (!none || kept->flags[p] == 1), fault, CDEM_INPUT,
                 "the array 'interfaces/pairs' of the checkpoint does not belong to this case");
  }
  for (int64_t at = 0; at < points; at++)
    CDEM_REQUIRE(kept->bytes[BYTES * at] < CDEM_INTERFACE_STATES &&
                     kept->bytes[BYTES * at + 1] <= 1 &&
                     kept->bytes[BYTES * at + 2] <= CDEM_POINT_GONE,
                 fault, CDEM_INPUT,
                 "the array 'interfaces/phases' of the checkpoint does not belong to this case");
  return CDEM_OK;
}

static void take_over(cdem_interfaces *interfaces, const contents *kept) {
  cdem_interfaces_store *store = interfaces->store;
  for (int64_t at = 0; at < store->points; at++) {
    memcpy(&store->point[at], kept->reals + REALS * at, REALS * sizeof(double));
    store->point[at].state = kept->bytes[BYTES * at];
    store->point[at].falling = kept->bytes[BYTES * at + 1];
    store->phase[at] = kept->bytes[BYTES * at + 2];
  }
  store->tied_faces = 0;
  for (int32_t p = 0; p < interfaces->blocks->pairs; p++) {
    interfaces->released[p] = kept->flags[p] == 1;
    store->tied[p] = kept->flags[p] == 2;
    store->tied_faces += store->tied[p];
  }
  store->stored = kept->energy[0];
  store->fracture = kept->energy[1];
  store->friction = kept->energy[2];
  store->constant = kept->energy[3];
  memset(store->force, 0, (size_t)(store->points * 2 * store->dimension) * sizeof(double));
  cdem_interfaces_tie_all(interfaces);
  interfaces->version = kept->version[0];
  interfaces->ties.version = kept->version[1];
}

cdem_status cdem_interfaces_restore(cdem_interfaces *interfaces, const cdem_state *state,
                                    cdem_fault *fault) {
  contents kept = {0};
  cdem_status status = read_state(interfaces, state, &kept, fault);
  if (status == CDEM_OK)
    take_over(interfaces, &kept);
  free(kept.reals);
  free(kept.bytes);
  free(kept.flags);
  return status;
}
