/* The body of the kernels for one vector width: kernels.c includes it once per width, with
 *   WIDTH         doubles in a vector; CDEM_LANES/WIDTH parts make a batch
 *   KERNEL(name)  the name of this width's own `name`
 *   TARGET        the attribute that lets the compiler use vectors so wide (or nothing)
 * The compiler's own vector types serve, but only at a width the processor has: wider ones are
 * taken apart through memory, at a tenth of the speed.
 */
#define lanes            KERNEL(lanes)
#define lanes_at         KERNEL(lanes_at)
#define node_features    KERNEL(node_features)
#define workspace        KERNEL(workspace)
#define lane_mask        KERNEL(lane_mask)
#define select_lanes     KERNEL(select_lanes)
#define note_determinant KERNEL(note_determinant)
#define adjugate_solid   KERNEL(adjugate_solid)
#define adjugate_plane   KERNEL(adjugate_plane)
#define features_solid   KERNEL(features_solid)
#define features_plane   KERNEL(features_plane)
#define add_pair_3       KERNEL(add_pair_3)
#define add_pair_2       KERNEL(add_pair_2)
#define moments          KERNEL(moments)
#define isotropic_blocks KERNEL(isotropic_blocks)
#define general_blocks   KERNEL(general_blocks)
#define blocks           KERNEL(blocks)
#define INLINE           CDEM_ALWAYS_INLINE TARGET

enum { KERNEL(PARTS) = CDEM_LANES / WIDTH };
#define PARTS KERNEL(PARTS)

typedef double lanes __attribute__((vector_size(8 * WIDTH)));
/* For arrays of double: no alignment asked for. Entry e of a batch stands at [e * PARTS]. */
typedef double lanes_at __attribute__((vector_size(8 * WIDTH), aligned(8), may_alias));

/* Features of one node at the points of a chunk. */
typedef lanes node_features[CHUNK][3];

typedef struct {
  node_features left[MAX_NODES], right[MAX_NODES]; /* right = left times weight/det */
  lanes least, largest;                            /* determinants met */
} workspace;

/* *out = *yes where the mask is set, *no elsewhere (C has no ?: for vectors). */
typedef int64_t lane_mask __attribute__((vector_size(8 * WIDTH)));
INLINE void select_lanes(const lane_mask *mask, const lanes *yes, const lanes *no, lanes *out) {
  *out = (lanes)((*mask & (lane_mask)*yes) | (~*mask & (lane_mask)*no));
}

INLINE void note_determinant(const lanes *det, workspace *work) {
  lanes negative = -*det, size;
  lane_mask mask = *det < negative;
  select_lanes(&mask, &negative, det, &size);
  mask = *det < work->least;
  select_lanes(&mask, det, &work->least, &work->least);
  mask = size > work->largest;
  select_lanes(&mask, &size, &work->largest, &work->largest);
}

/* adj = adjugate of J = dx/dxi at one point; adj[3 k + i] = det J dxi_k/dx_i. */
INLINE void adjugate_solid(int nodes, const double *dn, const lanes_at *x, lanes adj[9],
                           lanes *det) {
  lanes j[9] = {0};
  for (int a = 0; a < nodes; a++, dn += 3, x += 3 * PARTS) {
    lanes u = x[0], v = x[PARTS], w = x[2 * PARTS];
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

INLINE void adjugate_plane(int nodes, const double *dn, const lanes_at *x, lanes adj[4],
                           lanes *det) {
  lanes j[4] = {0};
  for (int a = 0; a < nodes; a++, dn += 3, x += 3 * PARTS) {
    lanes u = x[0], v = x[PARTS];
    j[0] += dn[0] * u, j[1] += dn[1] * u;
    j[2] += dn[0] * v, j[3] += dn[1] * v;
  }
  adj[0] = j[3], adj[1] = -j[1], adj[2] = -j[2], adj[3] = j[0];
  *det = j[0] * j[3] - j[1] * j[2];
}

/* Point q of the rule into place `slot` of the chunk. */
INLINE void features_solid(const cdem_tabulation *t, int q, int slot, const lanes_at *x,
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

INLINE void features_plane(const cdem_tabulation *t, int q, int slot, bool cosserat,
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
INLINE void add_pair_3(int points, bool first, const lanes (*left)[3], const lanes (*right)[3],
                       lanes_at *moment) {
  lanes m0 = {0}, m1 = m0, m2 = m0, m3 = m0, m4 = m0, m5 = m0, m6 = m0, m7 = m0, m8 = m0;
  if (!first) {
    m0 = moment[0 * PARTS], m1 = moment[1 * PARTS], m2 = moment[2 * PARTS];
    m3 = moment[3 * PARTS], m4 = moment[4 * PARTS], m5 = moment[5 * PARTS];
    m6 = moment[6 * PARTS], m7 = moment[7 * PARTS], m8 = moment[8 * PARTS];
  }
  for (int q = 0; q < points; q++) {
    lanes a0 = left[q][0], a1 = left[q][1], a2 = left[q][2];
    lanes b0 = right[q][0], b1 = right[q][1], b2 = right[q][2];
    m0 += a0 * b0, m1 += a0 * b1, m2 += a0 * b2;
    m3 += a1 * b0, m4 += a1 * b1, m5 += a1 * b2;
    m6 += a2 * b0, m7 += a2 * b1, m8 += a2 * b2;
  }
  moment[0 * PARTS] = m0, moment[1 * PARTS] = m1, moment[2 * PARTS] = m2;
  moment[3 * PARTS] = m3, moment[4 * PARTS] = m4, moment[5 * PARTS] = m5;
  moment[6 * PARTS] = m6, moment[7 * PARTS] = m7, moment[8 * PARTS] = m8;
}

INLINE void add_pair_2(int points, bool first, const lanes (*left)[3], const lanes (*right)[3],
                       lanes_at *moment) {
  lanes m0 = {0}, m1 = m0, m2 = m0, m3 = m0;
  if (!first)
    m0 = moment[0 * PARTS], m1 = moment[1 * PARTS], m2 = moment[2 * PARTS], m3 = moment[3 * PARTS];
  for (int q = 0; q < points; q++) {
    lanes a0 = left[q][0], a1 = left[q][1], b0 = right[q][0], b1 = right[q][1];
    m0 += a0 * b0, m1 += a0 * b1, m2 += a1 * b0, m3 += a1 * b1;
  }
  moment[0 * PARTS] = m0, moment[1 * PARTS] = m1, moment[2 * PARTS] = m2, moment[3 * PARTS] = m3;
}

/* One formulation, known when compiled; one part of the batch. */
INLINE void moments(const cdem_tabulation *t, cdem_formulation formulation, const lanes_at *x,
                    lanes_at *moment, workspace *work) {
  const int entries = formulation == CDEM_PLANE ? 4 : 9;
  for (int start = 0; start < t->points; start += CHUNK) {
    int points = t->points - start < CHUNK ? t->points - start : CHUNK;
    for (int slot = 0; slot < points; slot++)
      if (formulation == CDEM_SOLID)
        features_solid(t, start + slot, slot, x, work);
      else
        features_plane(t, start + slot, slot, formulation == CDEM_PLANE_COSSERAT, x, work);
    lanes_at *out = moment;
    for (int a = 0; a < t->nodes; a++)
      for (int b = a + 1; b < t->nodes; b++, out += entries * PARTS) {
        const lanes(*left)[3] = (const lanes(*)[3])work->left[a];
        const lanes(*right)[3] = (const lanes(*)[3])work->right[b];
        if (entries == 4)
          add_pair_2(points, start == 0, left, right, out);
        else
          add_pair_3(points, start == 0, left, right, out);
      }
  }
}

TARGET static void KERNEL(moments_kernel)(const cdem_tabulation *tabulation, const double *x,
                                          double *moment, double *least) {
  workspace work;
  for (int part = 0; part < PARTS; part++, x += WIDTH, moment += WIDTH, least += WIDTH) {
    work.largest = (lanes){0} + DBL_MIN; /* so that an element all flat reports 0, not NaN */
    work.least = (lanes){0} + DBL_MAX;
    const lanes_at *from = (const lanes_at *)x;
    lanes_at *to = (lanes_at *)moment;
    switch (tabulation->element->formulation) {
    case CDEM_SOLID:
      moments(tabulation, CDEM_SOLID, from, to, &work);
      break;
    case CDEM_PLANE:
      moments(tabulation, CDEM_PLANE, from, to, &work);
      break;
    case CDEM_PLANE_COSSERAT:
      moments(tabulation, CDEM_PLANE_COSSERAT, from, to, &work);
      break;
    }
    *(lanes_at *)least = work.least / work.largest;
  }
}

/* S_ij = -(lambda M_ij + mu M_ji), on the diagonal -(lambda M_ii + mu (M_ii + tr M)). */
INLINE void isotropic_blocks(int pairs, int size, const lanes *lambda, const lanes *mu,
                             const lanes_at *moment, lanes_at *s) {
  lanes l = -*lambda, u = -*mu, both = l + u;
  for (int p = 0; p < pairs; p++) {
    lanes m[9];
    for (int e = 0; e < size * size; e++, moment += PARTS)
      m[e] = *moment;
    lanes trace = m[0] + m[size + 1];
    if (size == 3)
      trace += m[8];
    lanes shear = u * trace;
    for (int i = 0; i < size; i++)
      for (int j = 0; j < size; j++, s += PARTS)
        *s = i == j ? both * m[size * i + i] + shear : l * m[size * i + j] + u * m[size * j + i];
  }
}

/* c [size^2 entries ij of the block][size^2 moments kl] */
INLINE void general_blocks(int pairs, int size, const lanes *c, const lanes_at *moment,
                           lanes_at *s) {
  const int entries = size * size;
  for (int p = 0; p < pairs; p++) {
    lanes m[9];
    for (int e = 0; e < entries; e++, moment += PARTS)
      m[e] = *moment;
    for (int e = 0; e < entries; e++, s += PARTS) {
      lanes sum = {0};
      for (int k = 0; k < entries; k++)
        sum -= c[entries * e + k] * m[k];
      *s = sum;
    }
  }
}

/* One part of the batch: contraction [WIDTH]. */
INLINE void blocks(int pairs, int size, const cdem_contraction *const *contraction,
                   const lanes_at *moment, lanes_at *s) {
  lanes c[81], lambda, mu;
  bool isotropic = true, same = true;
  for (int lane = 0; lane < WIDTH; lane++) {
    isotropic = isotropic && contraction[lane]->isotropic;
    same = same && contraction[lane] == contraction[0];
    lambda[lane] = contraction[lane]->lambda;
    mu[lane] = contraction[lane]->mu;
  }
  if (isotropic) {
    isotropic_blocks(pairs, size, &lambda, &mu, moment, s);
    return;
  }
  for (int e = 0; e < size * size * size * size; e++) {
    int k = e % (size * size), row = e / (size * size);
    c[e] = (lanes){0} + contraction[0]->c[row / size][row % size][k / size][k % size];
    for (int lane = 1; lane < WIDTH && !same; lane++)
      c[e][lane] = contraction[lane]->c[row / size][row % size][k / size][k % size];
  }
  general_blocks(pairs, size, c, moment, s);
}

TARGET static void KERNEL(blocks_kernel)(int pairs,
                                         const cdem_contraction *const contraction[CDEM_LANES],
                                         const double *moment, double *s) {
  for (int part = 0; part < PARTS; part++, moment += WIDTH, s += WIDTH) {
    const cdem_contraction *const *law = contraction + part * WIDTH;
    if (law[0]->dofs == 3)
      blocks(pairs, 3, law, (const lanes_at *)moment, (lanes_at *)s);
    else
      blocks(pairs, 2, law, (const lanes_at *)moment, (lanes_at *)s);
  }
}

#undef lanes
#undef lanes_at
#undef node_features
#undef workspace
#undef lane_mask
#undef select_lanes
#undef note_determinant
#undef adjugate_solid
#undef adjugate_plane
#undef features_solid
#undef features_plane
#undef add_pair_3
#undef add_pair_2
#undef moments
#undef isotropic_blocks
#undef general_blocks
#undef blocks
#undef INLINE
#undef PARTS
#undef WIDTH
#undef KERNEL
#undef TARGET
