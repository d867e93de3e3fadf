/* The force kernel for one vector width: body_kernels.c includes this file once per width, with
 *   WIDTH         doubles in a vector; CDEM_LANES/WIDTH parts make a batch
 *   KERNEL(name)  the name of this width's own `name`
 *   TARGET        the attribute that lets the compiler use vectors so wide (or nothing)
 * Small 3x3 work stands here; the formulations in body_kernels_solid.h and body_kernels_plane.h.
 */
#define lanes         KERNEL(lanes)
#define lanes_at      KERNEL(lanes_at)
#define lane_mask     KERNEL(lane_mask)
#define select_lanes  KERNEL(select_lanes)
#define root          KERNEL(root)
#define reaches       KERNEL(reaches)
#define symmetric     KERNEL(symmetric)
#define gather        KERNEL(gather)
#define relative      KERNEL(relative)
#define turned_from   KERNEL(turned_from)
#define turn_matrix   KERNEL(turn_matrix)
#define compose       KERNEL(compose)
#define largest_root  KERNEL(largest_root)
#define best_turn     KERNEL(best_turn)
#define best_column   KERNEL(best_column)
#define polar         KERNEL(polar)
#define gradient3     KERNEL(gradient3)
#define determinant3  KERNEL(determinant3)
#define local3        KERNEL(local3)
#define springs3      KERNEL(springs3)
#define finish3       KERNEL(finish3)
#define frame3        KERNEL(frame3)
#define frame2        KERNEL(frame2)
#define solid_forces  KERNEL(solid_forces)
#define solid_energy  KERNEL(solid_energy)
#define polar2        KERNEL(polar2)
#define gradient2     KERNEL(gradient2)
#define local2        KERNEL(local2)
#define branch        KERNEL(branch)
#define springs2      KERNEL(springs2)
#define springs_c     KERNEL(springs_c)
#define finish2       KERNEL(finish2)
#define plane_forces  KERNEL(plane_forces)
#define plane_energy  KERNEL(plane_energy)
#define turned_stress KERNEL(turned_stress)
#define solid_stress  KERNEL(solid_stress)
#define plane_stress  KERNEL(plane_stress)
#define elongations   KERNEL(elongations)
#define close_up      KERNEL(close_up)
#define mean_gradient KERNEL(mean_gradient)
#define solid_frames  KERNEL(solid_frames)
#define plane_frames  KERNEL(plane_frames)
#define release_all   KERNEL(release_all)
#define any_lane      KERNEL(any_lane)
#define open_planes   KERNEL(open_planes)
#define turn_axes     KERNEL(turn_axes)
#define order_axes    KERNEL(order_axes)
#define definite      KERNEL(definite)
#define open_solids   KERNEL(open_solids)

#define open_principal KERNEL(open_principal)
#define square         KERNEL(square)
#define INLINE         CDEM_ALWAYS_INLINE TARGET

enum { KERNEL(PARTS) = CDEM_LANES / WIDTH };
#define PARTS KERNEL(PARTS)

typedef double lanes __attribute__((vector_size(8 * WIDTH)));
/* For arrays of double: no alignment asked for. Entry e of a batch stands at [e * PARTS]. */
typedef double lanes_at __attribute__((vector_size(8 * WIDTH), aligned(8), may_alias));
typedef int64_t lane_mask __attribute__((vector_size(8 * WIDTH)));

/* Entry e of a record: one number for all lanes, or one each. (x - 0 is x, for the compiler too.)
 */
#define ENTRY(record, e)                                                                           \
  (shared ? (record)[e] - (lanes){0} : (lanes)(*(const lanes_at *)((record) + CDEM_LANES * (e))))

/* *out = *yes where the mask is set, *no elsewhere (C has no ?: for vectors). */
INLINE void select_lanes(const lane_mask *mask, const lanes *yes, const lanes *no, lanes *out) {
  *out = (lanes)((*mask & (lane_mask)*yes) | (~*mask & (lane_mask)*no));
}

INLINE void root(lanes *x) {
  double value[WIDTH];
  *(lanes_at *)value = *x;
  for (int i = 0; i < WIDTH; i++)
    value[i] = sqrt(value[i]);
  *x = *(lanes_at *)value;
}

/* Whether a <= b in every lane, NaN counting as so (it cannot get better). */
INLINE bool reaches(const lanes *a, const lanes *b) {
  lane_mask above = *a > *b;
  int64_t any = 0;
  for (int i = 0; i < WIDTH; i++)
    any |= above[i];
  return any == 0;
}

/* Values of one node: v [dofs], from u by the ids of this part. */
INLINE void gather(int dofs, bool last_node, const int32_t *id, const double *u, lanes *v) {
#if WIDTH == 8
  if (dofs == 3 && !last_node) {
    /* Four values are read for three, eight rows turned into three columns. */
    typedef double four __attribute__((vector_size(32), aligned(8), may_alias));
#define ROW(k)     (*(const four *)(u + 3 * (int64_t)id[k]))
#define BOTH(a, b) __builtin_shufflevector(ROW(a), ROW(b), 0, 1, 2, 3, 4, 5, 6, 7)
    lanes r0 = BOTH(0, 4), r1 = BOTH(1, 5), r2 = BOTH(2, 6), r3 = BOTH(3, 7);
#undef BOTH
#undef ROW
    lanes t0 = __builtin_shufflevector(r0, r1, 0, 8, 2, 10, 4, 12, 6, 14);
    lanes t1 = __builtin_shufflevector(r0, r1, 1, 9, 3, 11, 5, 13, 7, 15);
    lanes t2 = __builtin_shufflevector(r2, r3, 0, 8, 2, 10, 4, 12, 6, 14);
    lanes t3 = __builtin_shufflevector(r2, r3, 1, 9, 3, 11, 5, 13, 7, 15);
    v[0] = __builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13);
    v[1] = __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13);
    v[2] = __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15);
    return;
  }
#endif
  (void)last_node;
  for (int c = 0; c < dofs; c++) {
    lanes value = {0};
    for (int i = 0; i < WIDTH; i++)
      value[i] = u[dofs * (int64_t)id[i] + c];
    v[c] = value;
  }
}

/* w [nodes][3]: the displacements of nodes 1, 2, .. less that of node 0 (w[0] = 0); a Cosserat
 * rotation stays whole. */
INLINE void relative(int nodes, int dofs, int moving, const cdem_body_task *task, int part,
                     lanes (*w)[3]) {
  const int32_t *id = task->id + part * WIDTH;
  lanes first[3] = {0};
  gather(dofs, task->last_node, id, task->u, first);
  for (int c = 0; c < dofs; c++)
    w[0][c] = c < moving ? (lanes){0} : first[c];
  for (int a = 1; a < nodes; a++) {
    gather(dofs, task->last_node, id + CDEM_LANES * a, task->u, w[a]);
    for (int c = 0; c < moving; c++)
      w[a][c] -= first[c];
  }
}

/* Takes an opening a (Voigt [6][CDEM_LANES]) out of local displacements: d_i -= a X_i. */
INLINE void close_up(int nodes, int dimension, bool shared, const double *place,
                     const cdem_body_task *task, int part, lanes (*d)[3]) {
  static const int8_t at[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
  if (task->opening == NULL)
    return;
  const double *opening = task->opening + part * WIDTH;
  for (int i = 1; i < nodes; i++)
    for (int r = 0; r < dimension; r++)
      for (int c = 0; c < dimension; c++)
        d[i][r] -= (r == c ? 1.0 : 0.5) *
                   (lanes)(*(const lanes_at *)(opening + CDEM_LANES * at[3 * r + c])) *
                   ENTRY(place, dimension * (i - 1) + c);
}

#include "cdem/body_kernels_polar.h"
#include "cdem/body_kernels_solid.h"
/* The plane forms stand after the solid ones. */
#include "cdem/body_kernels_plane.h"
#include "cdem/body_kernels_stress.h"
#include "cdem/body_kernels_tension.h"

#define EACH_PART for (int part = 0; part < PARTS; part++)

TARGET static void KERNEL(forces)(const cdem_body_task *task, double *force, double *determinant) {
  const int key = 16 * (int)task->kind->formulation + task->kind->nodes;
#define CASE(formulation, nodes, function, cosserat)                                               \
  case 16 * (formulation) + (nodes):                                                               \
    if (task->shared)                                                                              \
      EACH_PART function(nodes, cosserat, true, task, part, force, determinant);                   \
    else                                                                                           \
      EACH_PART function(nodes, cosserat, false, task, part, force, determinant);                  \
    return
  switch (key) {
    CASE(CDEM_SOLID, 4, solid_forces, false);
    CASE(CDEM_SOLID, 5, solid_forces, false);
    CASE(CDEM_SOLID, 6, solid_forces, false);
    CASE(CDEM_SOLID, 8, solid_forces, false);
    CASE(CDEM_PLANE, 3, plane_forces, false);
    CASE(CDEM_PLANE, 4, plane_forces, false);
    CASE(CDEM_PLANE_COSSERAT, 3, plane_forces, true);
    CASE(CDEM_PLANE_COSSERAT, 4, plane_forces, true);
  }
#undef CASE
}

/* Not in the loop of the steps: the number of nodes is no constant here. */
TARGET static void KERNEL(energies)(const cdem_body_task *task, double *energy) {
  const bool shared = task->shared;
  EACH_PART switch (task->kind->formulation) {
  case CDEM_SOLID:
    solid_energy(task->kind->nodes, shared, task, part, energy);
    break;
  case CDEM_PLANE:
    plane_energy(task->kind->nodes, false, shared, task, part, energy);
    break;
  case CDEM_PLANE_COSSERAT:
    plane_energy(task->kind->nodes, true, shared, task, part, energy);
    break;
  }
}

/* stress [6][CDEM_LANES]. */
TARGET static void KERNEL(stresses)(const cdem_body_task *task, const double (*law)[7],
                                    double *stress) {
  const int key = 16 * (int)task->kind->formulation + task->kind->nodes;
  lanes s[6] = {0};
#define CASE(formulation, nodes, call)                                                             \
  case 16 * (formulation) + (nodes):                                                               \
    call;                                                                                          \
    break
#define SOLID(nodes) CASE(CDEM_SOLID, nodes, solid_stress(nodes, task->shared, task, part, law, s))
#define PLANE(formulation, nodes, cosserat)                                                        \
  CASE(formulation, nodes, plane_stress(nodes, cosserat, task->shared, task, part, law, s))
  EACH_PART {
    switch (key) {
      SOLID(4);
      SOLID(5);
      SOLID(6);
      SOLID(8);
      PLANE(CDEM_PLANE, 3, false);
      PLANE(CDEM_PLANE, 4, false);
      PLANE(CDEM_PLANE_COSSERAT, 3, true);
      PLANE(CDEM_PLANE_COSSERAT, 4, true);
    }
    for (int v = 0; v < 6; v++)
      *(lanes_at *)(stress + CDEM_LANES * v + part * WIDTH) = s[v];
  }
#undef PLANE
#undef SOLID
#undef CASE
}

TARGET static void KERNEL(determinants)(const cdem_body_task *task, double *determinant) {
  const bool shared = task->shared;
  const int nodes = task->kind->nodes;
  EACH_PART {
    lanes w[CDEM_BODY_NODES][3], h[9], det;
    const double *record = task->record + (shared ? 0 : part * WIDTH);
    if (task->kind->formulation == CDEM_SOLID) {
      relative(nodes, 3, 3, task, part, w);
      gradient3(nodes, shared, task->kind, record, (const lanes(*)[3])w, h);
      determinant3(h, &det);
    } else {
      relative(nodes, task->kind->dofs, 2, task, part, w);
      gradient2(nodes, shared, task->kind, record, (const lanes(*)[3])w, h);
      det = 1.0 + (h[0] + h[3]) + (h[0] * h[3] - h[1] * h[2]);
    }
    *(lanes_at *)(determinant + part * WIDTH) = det;
  }
}

/* The number of nodes is a constant of the compiler in both. */
#define EACH_KIND(call_solid, call_plane)                                                          \
  switch (16 * (int)task->kind->formulation + task->kind->nodes) {                                 \
  case 16 * CDEM_SOLID + 4:                                                                        \
    call_solid(4);                                                                                 \
    break;                                                                                         \
  case 16 * CDEM_SOLID + 5:                                                                        \
    call_solid(5);                                                                                 \
    break;                                                                                         \
  case 16 * CDEM_SOLID + 6:                                                                        \
    call_solid(6);                                                                                 \
    break;                                                                                         \
  case 16 * CDEM_SOLID + 8:                                                                        \
    call_solid(8);                                                                                 \
    break;                                                                                         \
  case 16 * CDEM_PLANE + 3:                                                                        \
    call_plane(3, 2);                                                                              \
    break;                                                                                         \
  case 16 * CDEM_PLANE + 4:                                                                        \
    call_plane(4, 2);                                                                              \
    break;                                                                                         \
  case 16 * CDEM_PLANE_COSSERAT + 3:                                                               \
    call_plane(3, 3);                                                                              \
    break;                                                                                         \
  case 16 * CDEM_PLANE_COSSERAT + 4:                                                               \
    call_plane(4, 3);                                                                              \
    break;                                                                                         \
  }

TARGET static void KERNEL(frames)(const cdem_body_task *task, const double *mean,
                                  cdem_body_frames *frames){
#define SOLID(nodes)       solid_frames(nodes, task, mean, part, frames)
#define PLANE(nodes, dofs) plane_frames(nodes, dofs, task, mean, part, frames)
    EACH_PART EACH_KIND(SOLID, PLANE)
#undef PLANE
#undef SOLID
}

/* Openings of isotropic cells, [6][CDEM_LANES]; none where `active` is 0. */
TARGET static bool KERNEL(opens)(const cdem_body_isotropic *law, const cdem_body_frames *frames,
                                 double *opening) {
  int64_t any = 0;
  EACH_PART {
    lanes b[9], a[6] = {0}, zero = {0};
    for (int k = 0; k < 9; k++)
      b[k] = *(const lanes_at *)(frames->b[k] + part * WIDTH);
    const lanes strain[6] = {b[0], b[4], b[8], b[5] + b[7], b[2] + b[6], b[1] + b[3]};
    lanes first = *(const lanes_at *)(law->first + part * WIDTH);
    lanes second = *(const lanes_at *)(law->second + part * WIDTH);
    lane_mask active = *(const lanes_at *)(law->active + part * WIDTH) > zero;
    if (law->solid)
      open_solids(&first, &second, &active, strain, a);
    else
      open_planes(&first, &second, strain, a);
    lane_mask opens = active & ((a[0] + a[1] + a[2]) > zero);
    any |= any_lane(&opens);
    for (int v = 0; v < 6; v++) {
      lanes own;
      select_lanes(&opens, &a[v], &zero, &own);
      *(lanes_at *)(opening + CDEM_LANES * v + part * WIDTH) = own;
    }
  }
  return any != 0;
}

TARGET static void KERNEL(releases)(const cdem_body_task *task, const double *mean,
                                    const cdem_body_pulls *pulls, double *force) {
#define SOLID(nodes)       release_all(nodes, 3, 3, task, mean, part, pulls, force)
#define PLANE(nodes, dofs) release_all(nodes, 2, dofs, task, mean, part, pulls, force)
  EACH_PART EACH_KIND(SOLID, PLANE)
#undef PLANE
#undef SOLID
}
#undef EACH_KIND

/* b = a a for symmetric a [size][size], entries PARTS vectors apart; returns |b|^2. */
INLINE void square(int size, const lanes_at *a, lanes_at *b, lanes *norm2) {
  lanes sum = {0};
  for (int i = 0; i < size; i++)
    for (int j = i; j < size; j++) {
      const lanes_at *p = a + (ptrdiff_t)PARTS * size * i, *q = a + (ptrdiff_t)PARTS * size * j;
      lanes even = {0}, odd = {0};
      int k = 0;
      for (; k + 1 < size; k += 2) {
        even += p[k * PARTS] * q[k * PARTS];
        odd += p[(k + 1) * PARTS] * q[(k + 1) * PARTS];
      }
      if (k < size)
        even += p[k * PARTS] * q[k * PARTS];
      even += odd;
      b[((ptrdiff_t)size * i + j) * PARTS] = even;
      b[((ptrdiff_t)size * j + i) * PARTS] = even;
      sum += (i == j ? 1.0 : 2.0) * even * even;
    }
  *norm2 = sum;
}

/* The largest eigenvalue of a symmetric positive semidefinite matrix is at most tr(A^p)^(1/p), and
 * at least size^(-1/p) times that: p = 128 is six squarings and a norm, 2.5 % for 24 rows. Each
 * square is divided by its norm, whose roots make up the bound. The first norm has a dimension: a
 * square root, which is exact for powers of four where pow need not be; the others have none. */
TARGET static void KERNEL(bounds)(int size, double *a, double *work, double *bound) {
  enum { SQUARINGS = 6 };
  EACH_PART {
    lanes_at *now = (lanes_at *)(a + part * WIDTH), *next = (lanes_at *)(work + part * WIDTH);
    lanes norm2 = {0};
    double power[WIDTH];
    for (int e = 0; e < size * size; e++)
      norm2 += now[e * PARTS] * now[e * PARTS];
    for (int i = 0; i < WIDTH; i++)
      power[i] = sqrt(norm2[i]);
    double share = 0.25;
    for (int s = 0; s < SQUARINGS; s++, share *= 0.5) {
      root(&norm2);
      lanes factor = 1.0 / norm2;
      for (int e = 0; e < size * size; e++)
        now[e * PARTS] *= factor;
      square(size, now, next, &norm2);
      lanes_at *swap = now;
      now = next;
      next = swap;
      for (int i = 0; i < WIDTH; i++)
        power[i] *= pow(norm2[i], share);
    }
    for (int i = 0; i < WIDTH; i++)
      bound[part * WIDTH + i] = power[i];
  }
}

#undef EACH_PART
#undef ENTRY
#undef lanes
#undef lanes_at
#undef lane_mask
#undef select_lanes
#undef root
#undef reaches
#undef symmetric
#undef gather
#undef relative
#undef turned_from
#undef turn_matrix
#undef compose
#undef largest_root
#undef best_turn
#undef best_column
#undef polar
#undef gradient3
#undef determinant3
#undef local3
#undef springs3
#undef frame3
#undef frame2
#undef finish3
#undef solid_forces
#undef solid_energy
#undef polar2
#undef gradient2
#undef local2
#undef branch
#undef springs2
#undef springs_c
#undef finish2
#undef plane_forces
#undef plane_energy
#undef turned_stress
#undef solid_stress
#undef plane_stress
#undef elongations
#undef close_up
#undef mean_gradient
#undef solid_frames
#undef plane_frames
#undef release_all
#undef any_lane
#undef open_planes
#undef turn_axes
#undef order_axes
#undef definite
#undef open_solids
#undef open_principal
#undef square
#undef INLINE
#undef PARTS
#undef WIDTH
#undef KERNEL
#undef TARGET
