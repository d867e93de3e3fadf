/* Interfaces: nodes that move as one, and faces that come in when their strength is reached. */
#include "base/sets.h"
#include "cdem/interfaces_store.h"

#include <math.h>

/* The first of the copies that a node is one of; they are one range of ids. */
static int32_t first_copy(const cdem_blocks *blocks, int32_t node) {
  while (node > 0 && blocks->original[node - 1] == blocks->original[node])
    node--;
  return node;
}

/* Labels the copies of one original node anew: union over the faces still tied there; the label is
 * the smallest of the cluster. */
static void label_copies(cdem_interfaces *interfaces, int32_t first) {
  cdem_interfaces_store *store = interfaces->store;
  const cdem_blocks *blocks = interfaces->blocks;
  int32_t *root = store->root, original = blocks->original[first], end = first;
  while (end < blocks->mesh.nodes && blocks->original[end] == original)
    end++;
  cdem_sets_init(root, first, end);
  for (int64_t k = store->tie_start[original]; k < store->tie_start[original + 1]; k++) {
    int64_t p = store->tie[k] / 4, corner = store->tie[k] % 4;
    if (store->tied[p])
      cdem_sets_join(root, blocks->pair[p].node[0][corner], blocks->pair[p].node[1][corner]);
  }
  cdem_sets_label(root, first, end);
}

/* Clusters of two or more, by their smallest node. */
static void list_clusters(cdem_interfaces *interfaces) {
  const cdem_blocks *blocks = interfaces->blocks;
  const int32_t *root = interfaces->store->root;
  cdem_ties *ties = &interfaces->ties;
  int32_t nodes = blocks->mesh.nodes, members = 0;
  ties->clusters = 0;
  ties->start[0] = 0;
  for (int32_t n = 0; n < nodes; n++) {
    int32_t own = members;
    if (root[n] != n)
      continue;
    ties->member[members++] = n;
    for (int32_t m = n + 1; m < nodes && blocks->original[m] == blocks->original[n]; m++)
      if (root[m] == n)
        ties->member[members++] = m;
    if (members == own + 1)
      members = own; /* alone */
    else
      ties->start[++ties->clusters] = members;
  }
}

void cdem_interfaces_tie_all(cdem_interfaces *interfaces) {
  const cdem_blocks *blocks = interfaces->blocks;
  for (int32_t n = 0; n < blocks->mesh.nodes; n++)
    if (n == 0 || blocks->original[n] != blocks->original[n - 1])
      label_copies(interfaces, n);
  list_clusters(interfaces);
}

/* Traction on side 1 of the mean stress of the two cells, in the frame of the mid-face. */
static bool face_traction(const cdem_interfaces *interfaces, int32_t p, const double *u,
                          const double *stress, cdem_interface_frame *frame, double traction[3]) {
  const cdem_face_pair *pair = &interfaces->blocks->pair[p];
  double middle[4][3] = {{0}}, mean[6], on[3];
  cdem_interface_middle(interfaces, p, u, middle);
  if (!cdem_interface_frame_of(interfaces->store->dimension, pair->corners, middle, frame))
    return false;
  for (int i = 0; i < 6; i++)
    mean[i] = (stress[6 * (int64_t)pair->cell[0] + i] + stress[6 * (int64_t)pair->cell[1] + i]) / 2;
  const double *n = frame->axis[0]; /* stress: xx yy zz yz xz xy */
  on[0] = mean[0] * n[0] + mean[5] * n[1] + mean[4] * n[2];
  on[1] = mean[5] * n[0] + mean[1] * n[1] + mean[3] * n[2];
  on[2] = mean[4] * n[0] + mean[3] * n[1] + mean[2] * n[2];
  cdem_interface_local(frame, on, traction);
  for (int i = 0; i < 3; i++)
    traction[i] = -traction[i];
  if (interfaces->store->dimension == 2)
    traction[2] = 0;
  return true;
}

/* The points at one original node whose nodes have parted, of faces let go now or before, come in
 * with the traction of this moment. */
static void insert_points(cdem_interfaces *interfaces, int32_t original, const double *u,
                          const double *stress) {
  cdem_interfaces_store *store = interfaces->store;
  for (int64_t k = store->tie_start[original]; k < store->tie_start[original + 1]; k++) {
    int32_t p = (int32_t)(store->tie[k] / 4), corner = (int32_t)(store->tie[k] % 4);
    const cdem_face_pair *pair = &interfaces->blocks->pair[p];
    int64_t at = store->first[p] + corner;
    if (store->tied[p] || store->phase[at] != CDEM_POINT_TIED ||
        store->root[pair->node[0][corner]] == store->root[pair->node[1][corner]])
      continue;
    cdem_interface_frame frame;
    double traction[3], jump[3], delta[3];
    if (!face_traction(interfaces, p, u, stress, &frame, traction))
      continue;
    cdem_interface_jump(interfaces, pair, corner, u, jump);
    cdem_interface_local(&frame, jump, delta);
    cdem_interface_law_insert(&interfaces->law[interfaces->law_of[p]], delta, &store->point[at],
                              traction);
    store->phase[at] = CDEM_POINT_ACTIVE;
  }
}

int32_t cdem_interfaces_insert(cdem_interfaces *interfaces, const double *u, const double *stress) {
  cdem_interfaces_store *store = interfaces->store;
  const cdem_blocks *blocks = interfaces->blocks;
  int32_t found = 0;
  if (store->tied_faces == 0)
    return 0;
#pragma omp parallel for schedule(static) num_threads(store->threads)
  for (int32_t p = 0; p < blocks->pairs; p++) {
    cdem_interface_frame frame;
    double traction[3];
    store->opens[p] = store->tied[p] && face_traction(interfaces, p, u, stress, &frame, traction) &&
                      cdem_interface_law_reached(&interfaces->law[interfaces->law_of[p]], traction);
  }
  for (int32_t p = 0; p < blocks->pairs; p++) {
    found += store->opens[p];
    store->tied[p] = store->tied[p] && !store->opens[p];
  }
  if (found == 0)
    return 0;
  for (int pass = 0; pass < 2; pass++) /* all labels before any point asks */
    for (int32_t p = 0; p < blocks->pairs; p++)
      for (int k = 0; store->opens[p] && k < blocks->pair[p].corners; k++) {
        int32_t node = blocks->pair[p].node[0][k];
        if (pass == 0)
          label_copies(interfaces, first_copy(blocks, node));
        else
          insert_points(interfaces, blocks->original[node], u, stress);
      }
  list_clusters(interfaces);
  store->tied_faces -= found;
  interfaces->ties.version++;
  interfaces->version++;
  return found;
}

bool cdem_interfaces_any_tied(const cdem_interfaces *interfaces) {
  return interfaces->store->tied_faces > 0;
}
