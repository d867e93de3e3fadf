/* The hot path: moments and spring tensors of CDEM_LANES elements side by side.
 *
 * Points come in chunks, so that the gradients of a chunk stay in the first-level cache (24 KB for
 * hex8) whatever the rule. Gradients are kept without their division by the determinant: with
 * g = adj(J)^T dN/dxi (= det J grad N) the integrand w det (grad N_a)(grad N_b)^T is g_a (w/det)
 * g_b^T, and the factor goes once into the right-hand copy. The pair loop then does nine
 * multiply-adds on six loads a point, its nine sums in registers.
 */
#include "base/simd.h"
#include "elements/basis.h"

#include <float.h>
#include <stdlib.h>

enum { CHUNK = 8, MAX_NODES = CDEM_SHAPE_MAX_NODES };
_Static_assert(CDEM_LANES * sizeof(double) == sizeof(cdem_vec8), "one vector holds the lanes");

typedef cdem_vec8 lanes;
typedef cdem_vec8_at lanes_at;

/* Features of one node at the points of a chunk. */
typedef lanes node_features[CHUNK][3];

typedef struct {
  node_features left[MAX_NODES], right[MAX_NODES]; /* right = left times weight/det */
  lanes least, largest;                            /* determinants met */
} workspace;

/* *out = *yes where the mask is set, *no elsewhere (C has no ?: for vectors). */
typedef int64_t lane_mask __attribute__((vector_size(64)));
CDEM_ALWAYS_INLINE void select_lanes(const lane_mask *mask, const lanes *yes, const lanes *no,
                                     lanes *out) {
  *out = (lanes)((*mask & (lane_mask)*yes) | (~*mask & (lane_mask)*no));
}

CDEM_ALWAYS_INLINE void note_determinant(const lanes *det, workspace *work) {
  lanes negative = -*det, size;
  lane_mask mask = *det < negative;
  select_lanes(&mask, &negative, det, &size);
  mask = *det < work->least;
  select_lanes(&mask, det, &work->least, &work->least);
  mask = size > work->largest;
  select_lanes(&mask, &size, &work->largest, &work->largest);
}

/* adj = adjugate of J = dx/dxi at one point; adj[3 k + i] = det J dxi_k/dx_i. */
CDEM_ALWAYS_INLINE void adjugate_solid(int nodes, const double *dn, const lanes_at *x, lanes adj[9],
                                       lanes *det) {
  lanes j[9] = {0};
  for (int a = 0; a < nodes; a++, dn += 3, x += 3) {
    lanes u = x[0], v = x[1], w = x[2];
    j[0] += dn[0] * u, j[1] += dn[1] * u, j[2] += dn[2] * u;
    j[3] += dn[0] * v, j[4] += dn[1] * v, j[5] += dn[2] * v;
    j[6] += dn[0] * w, j[7] += dn[1] * w, j[8] += dn[2] * w;
  }
  adj[0] = j[4] * j[8] - j[5] * j[7];
  adj[1] = j[2] * j[7] - j[1] * j[8];
  adj[2] = j[1] * j[5] - j[2] * j[4];
  adj[3] = j[5] * j[6] - j[3] * j[8];
  adj[4] = j[0] * j[8] - j[2] * j[6];
  adj[5] = j[2] * j[3] - j[0] * j[5];
  adj[6] = j[3] * j[7] - j[4] * j[6];
  adj[7] = j[1] * j[6] - j[0] * j[7];
  adj[8] = j[0] * j[4] - j[1] * j[3];
  *det = j[0] * adj[0] + j[1] * adj[3] + j[2] * adj[6];
}

CDEM_ALWAYS_INLINE void adjugate_plane(int nodes, const double *dn, const lanes_at *x, lanes adj[4],
                                       lanes *det) {
  lanes j[4] = {0};
  for (int a = 0; a < nodes; a++, dn += 3, x += 3) {
    lanes u = x[0], v = x[1];
    j[0] += dn[0] * u, j[1] += dn[1] * u;
    j[2] += dn[0] * v, j[3] += dn[1] * v;
  }
  adj[0] = j[3], adj[1] = -j[1], adj[2] = -j[2], adj[3] = j[0];
  *det = j[0] * j[3] - j[1] * j[2];
}

/* Point q of the rule into place `slot` of the chunk. */
CDEM_ALWAYS_INLINE void features_solid(const cdem_tabulation *t, int q, int slot, const lanes_at *x,
                                       workspace *work) {
  lanes adj[9], det;
  const double *dn = t->dn + (ptrdiff_t)3 * t->nodes * q;
  adjugate_solid(t->nodes, dn, x, adj, &det);
  note_determinant(&det, work);
  lanes factor = t->weight[q] / det;
  for (int a = 0; a < t->nodes; a++, dn += 3) {
    lanes *left = work->left[a][slot], *right = work->right[a][slot];
    for (int i = 0; i < 3; i++) {
      lanes g = dn[0] * adj[i] + dn[1] * adj[3 + i] + dn[2] * adj[6 + i];
      left[i] = g;
      right[i] = g * factor;
    }
  }
}

CDEM_ALWAYS_INLINE void features_plane(const cdem_tabulation *t, int q, int slot, bool cosserat,
                                       const lanes_at *x, workspace *work) {
  lanes adj[4], det;
  const double *dn = t->dn + (ptrdiff_t)3 * t->nodes * q;
  adjugate_plane(t->nodes, dn, x, adj, &det);
  note_determinant(&det, work);
  lanes factor = t->weight[q] / det;
  for (int a = 0; a < t->nodes; a++, dn += 3) {
    lanes *left = work->left[a][slot], *right = work->right[a][slot];
    int at = 0;
    if (cosserat) {
      left[0] = t->n[t->nodes * q + a] * det;
      right[0] = left[0] * factor;
      at = 1;
    }
    for (int i = 0; i < 2; i++) {
      lanes g = dn[0] * adj[i] + dn[1] * adj[2 + i];
      left[at + i] = g;
      right[at + i] = g * factor;
    }
  }
}

/* moment [9] (+)= sum over the points of left (x) right. */
CDEM_ALWAYS_INLINE void add_pair_3(int points, bool first, const lanes (*left)[3],
                                   const lanes (*right)[3], lanes_at *moment) {
  lanes m0 = {0}, m1 = m0, m2 = m0, m3 = m0, m4 = m0, m5 = m0, m6 = m0, m7 = m0, m8 = m0;
  if (!first) {
    m0 = moment[0], m1 = moment[1], m2 = moment[2];
    m3 = moment[3], m4 = moment[4], m5 = moment[5];
    m6 = moment[6], m7 = moment[7], m8 = moment[8];
  }
  for (int q = 0; q < points; q++) {
    lanes a0 = left[q][0], a1 = left[q][1], a2 = left[q][2];
    lanes b0 = right[q][0], b1 = right[q][1], b2 = right[q][2];
    m0 += a0 * b0, m1 += a0 * b1, m2 += a0 * b2;
    m3 += a1 * b0, m4 += a1 * b1, m5 += a1 * b2;
    m6 += a2 * b0, m7 += a2 * b1, m8 += a2 * b2;
  }
  moment[0] = m0, moment[1] = m1, moment[2] = m2;
  moment[3] = m3, moment[4] = m4, moment[5] = m5;
  moment[6] = m6, moment[7] = m7, moment[8] = m8;
}

CDEM_ALWAYS_INLINE void add_pair_2(int points, bool first, const lanes (*left)[3],
                                   const lanes (*right)[3], lanes_at *moment) {
  lanes m0 = {0}, m1 = m0, m2 = m0, m3 = m0;
  if (!first)
    m0 = moment[0], m1 = moment[1], m2 = moment[2], m3 = moment[3];
  for (int q = 0; q < points; q++) {
    lanes a0 = left[q][0], a1 = left[q][1], b0 = right[q][0], b1 = right[q][1];
    m0 += a0 * b0, m1 += a0 * b1, m2 += a1 * b0, m3 += a1 * b1;
  }
  moment[0] = m0, moment[1] = m1, moment[2] = m2, moment[3] = m3;
}

/* One formulation, known when compiled. */
CDEM_ALWAYS_INLINE void moments(const cdem_tabulation *t, cdem_formulation formulation,
                                const double *x, double *moment, workspace *work) {
  const lanes_at *at = (const lanes_at *)x;
  const int entries = formulation == CDEM_PLANE ? 4 : 9;
  for (int start = 0; start < t->points; start += CHUNK) {
    int points = t->points - start < CHUNK ? t->points - start : CHUNK;
    for (int slot = 0; slot < points; slot++)
      if (formulation == CDEM_SOLID)
        features_solid(t, start + slot, slot, at, work);
      else
        features_plane(t, start + slot, slot, formulation == CDEM_PLANE_COSSERAT, at, work);
    lanes_at *out = (lanes_at *)moment;
    for (int a = 0; a < t->nodes; a++)
      for (int b = a + 1; b < t->nodes; b++, out += entries) {
        const lanes(*left)[3] = (const lanes(*)[3])work->left[a];
        const lanes(*right)[3] = (const lanes(*)[3])work->right[b];
        if (entries == 4)
          add_pair_2(points, start == 0, left, right, out);
        else
          add_pair_3(points, start == 0, left, right, out);
      }
  }
}

CDEM_MULTIVERSION void cdem_moments_kernel(const cdem_tabulation *tabulation, const double *x,
                                           double *moment, double *least) {
  workspace work;
  work.largest = (lanes){0} + DBL_MIN; /* so that an element all flat reports 0, not NaN */
  work.least = (lanes){0} + DBL_MAX;
  switch (tabulation->element->formulation) {
  case CDEM_SOLID:
    moments(tabulation, CDEM_SOLID, x, moment, &work);
    break;
  case CDEM_PLANE:
    moments(tabulation, CDEM_PLANE, x, moment, &work);
    break;
  case CDEM_PLANE_COSSERAT:
    moments(tabulation, CDEM_PLANE_COSSERAT, x, moment, &work);
    break;
  }
  *(lanes_at *)least = work.least / work.largest;
}

/* S_ij = -(lambda M_ij + mu M_ji), on the diagonal -(lambda M_ii + mu (M_ii + tr M)). */
CDEM_ALWAYS_INLINE void isotropic_blocks(int pairs, int size, const lanes *lambda, const lanes *mu,
                                         const lanes_at *m, lanes_at *s) {
  lanes l = -*lambda, u = -*mu, both = l + u;
  for (int p = 0; p < pairs; p++, m += size * size, s += size * size) {
    lanes trace = m[0] + m[size + 1];
    if (size == 3)
      trace += m[8];
    lanes shear = u * trace;
    for (int i = 0; i < size; i++)
      for (int j = 0; j < size; j++)
        s[size * i + j] =
            i == j ? both * m[size * i + i] + shear : l * m[size * i + j] + u * m[size * j + i];
  }
}

/* c [size^2 blocks entries ij][size^2 moments kl] */
CDEM_ALWAYS_INLINE void general_blocks(int pairs, int size, const lanes *c, const lanes_at *m,
                                       lanes_at *s) {
  const int entries = size * size;
  for (int p = 0; p < pairs; p++, m += entries, s += entries)
    for (int e = 0; e < entries; e++) {
      lanes sum = {0};
      for (int k = 0; k < entries; k++)
        sum -= c[entries * e + k] * m[k];
      s[e] = sum;
    }
}

CDEM_ALWAYS_INLINE void blocks(int pairs, int size,
                               const cdem_contraction *const contraction[CDEM_LANES],
                               const double *moment, double *s) {
  lanes c[81], lambda, mu;
  bool isotropic = true, same = true;
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    isotropic = isotropic && contraction[lane]->isotropic;
    same = same && contraction[lane] == contraction[0];
    lambda[lane] = contraction[lane]->lambda;
    mu[lane] = contraction[lane]->mu;
  }
  if (isotropic) {
    isotropic_blocks(pairs, size, &lambda, &mu, (const lanes_at *)moment, (lanes_at *)s);
    return;
  }
  for (int e = 0; e < size * size * size * size; e++) {
    int k = e % (size * size), row = e / (size * size);
    c[e] = (lanes){0} + contraction[0]->c[row / size][row % size][k / size][k % size];
    for (int lane = 1; lane < CDEM_LANES && !same; lane++)
      c[e][lane] = contraction[lane]->c[row / size][row % size][k / size][k % size];
  }
  general_blocks(pairs, size, c, (const lanes_at *)moment, (lanes_at *)s);
}

CDEM_MULTIVERSION void cdem_blocks_kernel(int pairs,
                                          const cdem_contraction *const contraction[CDEM_LANES],
                                          const double *moment, double *s) {
  if (contraction[0]->dofs == 3)
    blocks(pairs, 3, contraction, moment, s);
  else
    blocks(pairs, 2, contraction, moment, s);
}

cdem_status cdem_element_pair_blocks(const cdem_tabulation *tabulation,
                                     const cdem_contraction *contraction, const double (*xyz)[3],
                                     double *s, cdem_fault *fault) {
  CDEM_TRY(cdem_element_check(tabulation, xyz, fault));
  int pairs = cdem_element_pairs(tabulation->element);
  int entries = contraction->dofs * contraction->dofs;
  double x[MAX_NODES * 3 * CDEM_LANES], least[CDEM_LANES], *moment, *block;
  const cdem_contraction *law[CDEM_LANES];
  CDEM_NEW(moment, (int64_t)2 * pairs * entries * CDEM_LANES, fault);
  block = moment + (ptrdiff_t)pairs * entries * CDEM_LANES;
  for (int lane = 0; lane < CDEM_LANES; lane++) {
    law[lane] = contraction;
    for (int i = 0; i < 3 * tabulation->nodes; i++)
      x[CDEM_LANES * i + lane] = xyz[i / 3][i % 3];
  }
  cdem_moments_kernel(tabulation, x, moment, least);
  cdem_blocks_kernel(pairs, law, moment, block);
  for (int i = 0; i < pairs * entries; i++)
    s[i] = block[(ptrdiff_t)CDEM_LANES * i];
  free(moment);
  return CDEM_OK;
}
