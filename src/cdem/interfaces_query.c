/* Interfaces: totals, fields, stiffness and the bound of the frequency. */
#include "cdem/interfaces_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void sum_pair(const cdem_interfaces *interfaces, int32_t p, cdem_interfaces_totals *totals) {
  const cdem_interfaces_store *store = interfaces->store;
  const cdem_face_pair *pair = &interfaces->blocks->pair[p];
  bool loose = cdem_interface_is_loose(&interfaces->law[interfaces->law_of[p]]);
  int points = 0, through = 0;
  for (int k = 0; k < pair->corners; k++) {
    const cdem_interface_point *point = &store->point[store->first[p] + k];
    if (cdem_interface_is_welded(pair, k))
      continue;
    points++;
    totals->softening += point->state == CDEM_INTERFACE_SOFTENING;
    totals->tension_failed += point->state == CDEM_INTERFACE_TENSION_FAILED;
    totals->shear_failed += point->state == CDEM_INTERFACE_SHEAR_FAILED;
    if (loose || point->damage < 1)
      continue;
    through++;
    totals->cracked_area += store->area[store->first[p] + k];
  }
  totals->points += points;
  totals->cracks += points > 0 && through == points;
}

void cdem_interfaces_sum(const cdem_interfaces *interfaces, cdem_interfaces_totals *totals) {
  const cdem_interfaces_store *store = interfaces->store;
  *totals = (cdem_interfaces_totals){
      .stored = store->stored, .fracture = store->fracture, .friction = store->friction};
  for (int32_t p = 0; p < interfaces->blocks->pairs; p++)
    if (interfaces->law_of[p] >= 0)
      sum_pair(interfaces, p, totals);
}

/* Whether the point pulls on its nodes, now or when it closes. */
static bool has_spring(const cdem_interfaces_store *store, int64_t at) {
  return store->phase[at] == CDEM_POINT_VIRGIN || store->phase[at] == CDEM_POINT_ACTIVE;
}

/* |K_aa| + |K_ab| of a point's 3x3 blocks in the 2-norm: twice its stiffer spring. */
void cdem_interfaces_row_sums(const cdem_interfaces *interfaces, double *stiffness) {
  const cdem_interfaces_store *store = interfaces->store;
  for (int32_t p = 0; p < interfaces->blocks->pairs; p++) {
    if (interfaces->law_of[p] < 0 || interfaces->released[p])
      continue;
    const cdem_interface_law *law = &interfaces->law[interfaces->law_of[p]];
    const cdem_face_pair *pair = &interfaces->blocks->pair[p];
    for (int k = 0; k < pair->corners; k++) {
      int64_t at = store->first[p] + k;
      for (int side = 0; side < 2 && has_spring(store, at); side++)
        stiffness[pair->node[side][k]] += 2 * fmax(law->kn, law->ks) * store->area[at];
    }
  }
}

double cdem_interfaces_frequency2(const cdem_interfaces *interfaces, const double *mass) {
  const cdem_interfaces_store *store = interfaces->store;
  int32_t nodes = interfaces->blocks->mesh.nodes;
  double *stiffness = store->room, *heavy = store->room + nodes, highest = 0;
  memset(stiffness, 0, (size_t)nodes * sizeof *stiffness);
  cdem_interfaces_row_sums(interfaces, stiffness);
  /* A cluster moves as one: stiffness and mass of its members go to its first. */
  for (int32_t n = 0; n < nodes; n++)
    heavy[n] = mass[(int64_t)n * interfaces->dofs];
  for (int32_t n = 0; n < nodes; n++) {
    int32_t root = store->root[n];
    if (root == n)
      continue;
    stiffness[root] += stiffness[n];
    heavy[root] += heavy[n];
    stiffness[n] = 0;
  }
  for (int32_t n = 0; n < nodes; n++)
    if (stiffness[n] > 0)
      highest = fmax(highest, stiffness[n] / heavy[n]);
  return highest;
}

double cdem_interfaces_open_frequency2(const cdem_interfaces *interfaces, const double *mass,
                                       double least) {
  const cdem_interfaces_store *store = interfaces->store;
  int32_t nodes = interfaces->blocks->mesh.nodes;
  double *stiffness = store->room, highest = 0;
  memset(stiffness, 0, (size_t)nodes * sizeof *stiffness);
  for (int32_t p = 0; p < interfaces->blocks->pairs; p++) {
    if (interfaces->law_of[p] < 0)
      continue;
    const cdem_interface_law *law = &interfaces->law[interfaces->law_of[p]];
    const cdem_face_pair *pair = &interfaces->blocks->pair[p];
    double spring = fmax(least, fmax(law->kn, law->ks));
    for (int k = 0; k < pair->corners; k++)
      for (int side = 0; side < 2; side++)
        stiffness[pair->node[side][k]] += 2 * spring * store->area[store->first[p] + k];
  }
  for (int32_t n = 0; n < nodes; n++)
    if (stiffness[n] > 0)
      highest = fmax(highest, stiffness[n] / mass[(int64_t)n * interfaces->dofs]);
  return highest;
}

typedef void add_block(void *context, int32_t node_a, int32_t node_b, const double *block);

/* Springs of one pair in its frame at the start. */
static void pair_stiffness(const cdem_interfaces *interfaces, int32_t p, add_block *add,
                           void *context) {
  const cdem_interfaces_store *store = interfaces->store;
  const cdem_face_pair *pair = &interfaces->blocks->pair[p];
  const cdem_interface_law *law = &interfaces->law[interfaces->law_of[p]];
  int dimension = store->dimension;
  double middle[4][3] = {{0}}, own[9], across[9];
  cdem_interface_frame frame;
  for (int k = 0; k < pair->corners; k++)
    memcpy(middle[k], interfaces->blocks->mesh.xyz + 3 * (int64_t)pair->node[0][k],
           sizeof middle[k]);
  if (!cdem_interface_frame_of(dimension, pair->corners, middle, &frame))
    return;
  for (int k = 0; k < pair->corners; k++) {
    int64_t at = store->first[p] + k;
    if (!has_spring(store, at) || (store->point[at].damage >= 1 && !cdem_interface_is_loose(law)))
      continue;
    for (int e = 0; e < dimension * dimension; e++) {
      int i = e / dimension, j = e % dimension;
      double nn = frame.axis[0][i] * frame.axis[0][j];
      own[e] = store->area[at] * (law->ks * (i == j) + (law->kn - law->ks) * nn);
      across[e] = -own[e];
    }
    int32_t a = pair->node[0][k], b = pair->node[1][k];
    add(context, a, a, own);
    add(context, b, b, own);
    add(context, a, b, across);
    add(context, b, a, across);
  }
}

void cdem_interfaces_stiffness(const cdem_interfaces *interfaces,
                               void (*add)(void *context, int32_t node_a, int32_t node_b,
                                           const double *block),
                               void *context) {
  for (int32_t p = 0; p < interfaces->blocks->pairs; p++)
    if (interfaces->law_of[p] >= 0 && !interfaces->released[p])
      pair_stiffness(interfaces, p, add, context);
}

static cdem_status new_fields(int64_t points, cdem_interface_fields *fields, cdem_fault *fault) {
  fields->points = points;
  CDEM_NEW(fields->pair, points, fault);
  CDEM_NEW(fields->corner, points, fault);
  CDEM_NEW(fields->state, points, fault);
  CDEM_NEW(fields->open, points, fault);
  CDEM_NEW(fields->opening, points, fault);
  CDEM_NEW(fields->slip, points, fault);
  CDEM_NEW(fields->normal_traction, points, fault);
  CDEM_NEW(fields->shear_traction, points, fault);
  CDEM_NEW(fields->damage, points, fault);
  return CDEM_OK;
}

static void fill_point(const cdem_interfaces *interfaces, int32_t p, int k,
                       const cdem_interface_frame *frame, const double *u,
                       cdem_interface_fields *fields) {
  const cdem_interfaces_store *store = interfaces->store;
  const cdem_interface_law *law = &interfaces->law[interfaces->law_of[p]];
  int64_t at = store->first[p] + k;
  double jump[3], delta[3] = {0}, traction[3] = {0};
  cdem_interface_jump(interfaces, &interfaces->blocks->pair[p], k, u, jump);
  if (frame != NULL)
    cdem_interface_local(frame, jump, delta);
  if (has_spring(store, at))
    cdem_interface_law_traction(law, delta, &store->point[at], traction);
  fields->pair[at] = p;
  fields->corner[at] = (uint8_t)k;
  fields->state[at] = store->point[at].state;
  fields->damage[at] = store->point[at].damage;
  fields->opening[at] = delta[0];
  fields->slip[at] = hypot(delta[1], delta[2]);
  fields->normal_traction[at] = traction[0];
  fields->shear_traction[at] = hypot(traction[1], traction[2]);
  bool apart =
      store->phase[at] == CDEM_POINT_GONE ? delta[0] > store->point[at].dilated : traction[0] <= 0;
  fields->open[at] = store->point[at].damage >= 1 && apart &&
                     !cdem_interface_is_welded(&interfaces->blocks->pair[p], k);
}

cdem_status cdem_interfaces_fields(const cdem_interfaces *interfaces, const double *u,
                                   cdem_interface_fields *fields, cdem_fault *fault) {
  *fields = (cdem_interface_fields){0};
  cdem_status status = new_fields(interfaces->store->points, fields, fault);
  if (status != CDEM_OK) {
    cdem_interface_fields_release(fields);
    return status;
  }
  for (int32_t p = 0; p < interfaces->blocks->pairs; p++) {
    int corners = interfaces->blocks->pair[p].corners;
    double middle[4][3] = {{0}};
    cdem_interface_frame frame;
    if (interfaces->law_of[p] < 0)
      continue;
    cdem_interface_middle(interfaces, p, u, middle);
    bool sound = cdem_interface_frame_of(interfaces->store->dimension, corners, middle, &frame);
    for (int k = 0; k < corners; k++)
      fill_point(interfaces, p, k, sound ? &frame : NULL, u, fields);
  }
  return CDEM_OK;
}

void cdem_interface_fields_release(cdem_interface_fields *fields) {
  if (fields == NULL)
    return;
  free(fields->pair);
  free(fields->corner);
  free(fields->state);
  free(fields->open);
  free(fields->opening);
  free(fields->slip);
  free(fields->normal_traction);
  free(fields->shear_traction);
  free(fields->damage);
  *fields = (cdem_interface_fields){0};
}

bool cdem_interfaces_last_force(const cdem_interfaces *interfaces, int32_t pair,
                                double force[4][3]) {
  memset(force, 0, 12 * sizeof(double));
  if (interfaces->law_of[pair] < 0 || !interfaces->released[pair])
    return false;
  for (int k = 0; k < interfaces->blocks->pair[pair].corners; k++)
    memcpy(force[k], interfaces->store->point[interfaces->store->first[pair] + k].last,
           3 * sizeof(double));
  return true;
}
