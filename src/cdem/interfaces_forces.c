/* Interfaces: forces of the points, in frames that turn with the mid-faces. */
#include "cdem/interfaces_store.h"

#include <math.h>
#include <string.h>

/* Equal and opposite forces f at two parted nodes leave the moment delta x f, and a frame that
 * turns does work the law does not know: both are undone by forces q on the corners of the mid-face
 * whose power is the moment times the frame's spin, formula (7). */
static inline void spin_forces(int corners, const cdem_interface_frame *frame,
                               const double middle[4][3], const double moment[3], double q[4][3]) {
  const double *n = frame->axis[0], *t = frame->axis[2];
  double about = cdem_dot3(moment, n) / frame->edge, half = 1 / (2 * frame->size);
  double g[3], a[3], b[3];
  memset(q, 0, 12 * sizeof(double));
  cdem_cross3(moment, n, g);
  for (int i = 0; i < 3; i++)
    g[i] = (g[i] - frame->lean * about * t[i]) * half;
  int first = corners == 4 ? 1 : 0; /* the second diagonal, or edge, starts here */
  double d[2][3];
  for (int i = 0; i < 3; i++) {
    d[0][i] = corners == 4 ? middle[2][i] - middle[0][i] : middle[1][i] - middle[0][i];
    d[1][i] = corners == 4 ? middle[3][i] - middle[1][i] : middle[2][i] - middle[0][i];
  }
  cdem_cross3(d[1], g, a); /* (dd_0 x d_1).g = dd_0.(d_1 x g) */
  cdem_cross3(g, d[0], b);
  for (int i = 0; i < 3; i++) {
    q[corners == 4 ? 2 : 1][i] += a[i];
    q[0][i] -= a[i];
    q[corners == 4 ? 3 : 2][i] += b[i];
    q[first][i] -= b[i];
    q[1][i] += about * t[i];
    q[0][i] -= about * t[i];
  }
}

static void spin_forces_plane(const cdem_interface_frame *frame, double moment, double q[4][3]) {
  for (int i = 0; i < 3; i++) {
    q[0][i] = moment / frame->edge * frame->axis[0][i];
    q[1][i] = -q[0][i];
  }
}

/* Elastic and within both strengths: what most points are. false: the full law is needed. */
static inline bool intact(const cdem_interface_law *law, const double delta[3], double traction[3],
                          double *stored) {
  double sigma = law->kn * delta[0], s = law->ks * delta[1], t = law->ks * delta[2];
  double limit = law->cohesion - sigma * law->friction;
  traction[0] = -sigma;
  traction[1] = -s;
  traction[2] = -t;
  *stored = (sigma * delta[0] + s * delta[1] + t * delta[2]) / 2;
  return sigma <= law->tension && limit >= 0 && s * s + t * t <= limit * limit;
}

static void point_traction(const cdem_interface_law *law, const double delta[3], uint8_t *phase,
                           cdem_interface_point *point, double area, double traction[3],
                           cdem_interface_part *part) {
  double stored;
  if (*phase == CDEM_POINT_VIRGIN && intact(law, delta, traction, &stored)) {
    part->stored += stored * area;
    return;
  }
  *phase = CDEM_POINT_ACTIVE;
  cdem_interface_work work;
  cdem_interface_law_update(law, delta, point, traction, &work);
  part->stored += work.stored * area;
  part->fracture += work.fracture * area;
  part->friction += work.friction * area;
}

/* All strength gone and one point far enough (farthest: m^2): contact takes over after this step.
 */
static bool is_through(const cdem_interfaces_store *store, int32_t p, double farthest) {
  bool any = false;
  double bound = store->release * store->size[p];
  if (!(farthest > bound * bound))
    return false;
  for (int64_t at = store->first[p]; at < store->first[p + 1]; at++) {
    if (store->phase[at] == CDEM_POINT_NONE)
      continue;
    any = true;
    if (store->phase[at] != CDEM_POINT_ACTIVE || store->point[at].damage < 1 ||
        store->point[at].falling)
      return false;
  }
  return any;
}

/* Forces of the points of a released pair stop; what they held as springs that came in loaded stays
 * in the book. */
static void retire(cdem_interfaces_store *store, int32_t p, cdem_interface_part *part) {
  for (int64_t at = store->first[p]; at < store->first[p + 1]; at++) {
    if (store->phase[at] == CDEM_POINT_GONE)
      continue;
    store->phase[at] = CDEM_POINT_GONE;
    part->constant -= store->point[at].credit[2] * store->area[at];
    memset(store->force + at * 2 * store->dimension, 0,
           2 * (size_t)store->dimension * sizeof(double));
  }
}

static inline void write_forces(cdem_interfaces_store *store, int32_t p, int dimension, int corners,
                                const double force[4][3], const double q[4][3]) {
  for (int k = 0; k < corners; k++) {
    double *out = store->force + (store->first[p] + k) * 2 * dimension;
    for (int i = 0; i < dimension; i++) {
      out[i] = -force[k][i] - q[k][i] / 2;
      out[dimension + i] = force[k][i] - q[k][i] / 2;
    }
  }
}

static void release_pair(cdem_interfaces *interfaces, int32_t p, int corners,
                         const double force[4][3], cdem_interface_part *part) {
  cdem_interfaces_store *store = interfaces->store;
  interfaces->released[p] = true;
  part->released++;
  for (int k = 0; k < corners; k++)
    memcpy(store->point[store->first[p] + k].last, force[k], 3 * sizeof(double));
}

/* Called with constants for dimension and corners, so that each kind has loops of its own. */
static inline __attribute__((always_inline)) void pair_forces(cdem_interfaces *interfaces,
                                                              int32_t p, const double *u,
                                                              int dimension, int corners,
                                                              cdem_interface_part *part) {
  cdem_interfaces_store *store = interfaces->store;
  const cdem_face_pair *pair = &interfaces->blocks->pair[p];
  const cdem_interface_law *law = &interfaces->law[interfaces->law_of[p]];
  double middle[4][3] = {{0}}, force[4][3] = {{0}}, q[4][3] = {{0}}, moment[3] = {0}, farthest = 0;
  cdem_interface_frame frame;
  cdem_interface_middle_of(interfaces, p, dimension, corners, u, middle);
  bool sound = cdem_interface_frame_of(dimension, corners, middle, &frame);
  for (int k = 0; sound && k < corners; k++) {
    int64_t at = store->first[p] + k;
    if (store->phase[at] == CDEM_POINT_NONE || store->phase[at] == CDEM_POINT_TIED)
      continue;
    double jump[3], delta[3], traction[3], turn[3], area = store->area[at];
    cdem_interface_jump(interfaces, pair, k, u, jump);
    cdem_interface_local(&frame, jump, delta);
    point_traction(law, delta, &store->phase[at], &store->point[at], area, traction, part);
    for (int i = 0; i < 3; i++)
      force[k][i] = area * (traction[0] * frame.axis[0][i] + traction[1] * frame.axis[1][i] +
                            traction[2] * frame.axis[2][i]);
    cdem_cross3(jump, force[k], turn);
    for (int i = 0; i < 3; i++)
      moment[i] += turn[i];
    double way = cdem_dot3(jump, jump);
    farthest = way > farthest ? way : farthest;
  }
  if (sound && dimension == 3)
    spin_forces(corners, &frame, middle, moment, q);
  else if (sound)
    spin_forces_plane(&frame, moment[2], q);
  write_forces(store, p, dimension, corners, force, q);
  if (is_through(store, p, farthest))
    release_pair(interfaces, p, corners, force, part);
}

static void chunk_forces(cdem_interfaces *interfaces, int64_t chunk, const double *u) {
  cdem_interfaces_store *store = interfaces->store;
  cdem_interface_part *part = &store->part[chunk];
  int64_t from = chunk * CDEM_INTERFACE_CHUNK, to = from + CDEM_INTERFACE_CHUNK;
  *part = (cdem_interface_part){0};
  for (int64_t p = from; p < to && p < interfaces->blocks->pairs; p++) {
    if (interfaces->law_of[p] < 0 || store->tied[p])
      continue;
    if (interfaces->released[p])
      retire(store, (int32_t)p, part);
    else if (store->dimension == 2)
      pair_forces(interfaces, (int32_t)p, u, 2, 2, part);
    else if (interfaces->blocks->pair[p].corners == 4)
      pair_forces(interfaces, (int32_t)p, u, 3, 4, part);
    else
      pair_forces(interfaces, (int32_t)p, u, 3, 3, part);
  }
}

/* Each node takes its forces in the order of the points: no thread counts. */
static void gather_forces(const cdem_interfaces *interfaces, double *force) {
  const cdem_interfaces_store *store = interfaces->store;
  int dimension = store->dimension, dofs = interfaces->dofs;
#pragma omp parallel for schedule(static) num_threads(store->threads)
  for (int32_t n = 0; n < store->nodes; n++) {
    double *own = force + (int64_t)store->node[n] * dofs;
    for (int64_t k = store->gather_start[n]; k < store->gather_start[n + 1]; k++)
      for (int i = 0; i < dimension; i++)
        own[i] += store->force[store->gather[k] * dimension + i];
  }
}

void cdem_interfaces_forces(cdem_interfaces *interfaces, const double *u, double *force) {
  cdem_interfaces_store *store = interfaces->store;
#pragma omp parallel for schedule(static) num_threads(store->threads)
  for (int64_t c = 0; c < store->chunks; c++)
    chunk_forces(interfaces, c, u);
  gather_forces(interfaces, force);
  int64_t released = 0;
  store->stored = 0;
  for (int64_t c = 0; c < store->chunks; c++) {
    store->stored += store->part[c].stored;
    store->fracture += store->part[c].fracture;
    store->friction += store->part[c].friction;
    store->constant += store->part[c].constant;
    released += store->part[c].released;
  }
  store->stored += store->constant;
  interfaces->version += released > 0;
}
