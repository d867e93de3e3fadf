/* The reference path, one block at a time. The order of the questions:
 *
 *   1. symmetric up to rounding: orthonormal springs by LAPACK's dsyev;
 *   2. real Schur form by dgees; for each choice of a single real value, the plane of the two
 *      others (dtrexc) and the condition number of their separation; the best choice leads;
 *   3. eigenvectors, when cond(P) <= CDEM_SPRINGS_MAX_COND;
 *   4. else a plane decoupled orthogonally from a direction, when there is one (a defect beside a
 *      third equal value: no eigenvalue tells them apart);
 *   5. else the best plane as a Schur block, when its separation is well conditioned;
 *   6. else the exact triple defect (a staircase of kernels), then the Schur form of the block.
 *
 * Differences below CDEM_SPRINGS_ROUNDING |S|_F choose no form. */
#include "springs/extended.h"
#include "springs/parts.h"

#include <assert.h>
#include <lapacke.h>
#include <string.h>

/* A block divided by 2^exponent, and what every step needs of it. */
typedef struct {
  int size;
  double s[9]; /* row-major, exactly symmetric where it is symmetric up to rounding */
  bool symmetric;
  int exponent;
  double bound;            /* CDEM_SPRINGS_ROUNDING |S|_F */
  long double deviator[9]; /* 3x3: s - mean I */
  long double mean;
} problem;

/* The single value's pair of vectors: left is the unit normal of the others' plane. */
typedef struct {
  long double left[3], right[3];
  double cond; /* of (right, orthonormal basis of the plane) */
} separation;

/* Real Schur form, column-major. */
typedef struct {
  double t[9], u[9];
} schur_form;

static void prepare(problem *block) {
  int n = block->size;
  double norm = cdem_frobenius(block->s, n * n), skew = cdem_springs_skew(block->s, n);
  block->bound = CDEM_SPRINGS_ROUNDING * norm;
  block->symmetric = 2.0 * skew <= CDEM_SPRINGS_ROUNDING;
  if (block->symmetric)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < i; j++)
        block->s[n * i + j] = block->s[n * j + i] =
            0.5 * (block->s[n * i + j] + block->s[n * j + i]);
  if (n == 2)
    return;
  block->mean = ((long double)block->s[0] + block->s[4] + block->s[8]) / 3.0L;
  for (int i = 0; i < 9; i++)
    block->deviator[i] = block->s[i] - (i % 4 == 0 ? block->mean : 0.0L);
}

/* P with right along spring 1 and the plane's directions a u + b w. */
static void place(cdem_canonical *canonical, const long double right[3], const long double u[3],
                  const long double w[3], const long double a[2], const long double b[2]) {
  long double length = sqrtl(cdem_dot3l(right, right));
  for (int c = 0; c < 3; c++) {
    canonical->p[0][c] = right[c] / length;
    canonical->p[1][c] = a[0] * u[c] + a[1] * w[c];
    canonical->p[2][c] = b[0] * u[c] + b[1] * w[c];
  }
}

static void put_plane(cdem_canonical *canonical, long double single, long double l[2][2]) {
  memset(canonical->l, 0, sizeof canonical->l);
  canonical->l[0][0] = single;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      canonical->l[1 + i][1 + j] = l[i][j];
}

/* The documented directions of the plane normal to n. */
static void plane_basis(const long double n[3], long double u[3], long double w[3]) {
  double rounded[3] = {(double)n[0], (double)n[1], (double)n[2]}, axis[3];
  cdem_springs_least_axis(rounded, axis);
  long double part = n[0] * axis[0] + n[1] * axis[1] + n[2] * axis[2];
  long double scale = 1.0L / sqrtl(1.0L - part * part);
  for (int c = 0; c < 3; c++)
    u[c] = (axis[c] - part * n[c]) * scale;
  cdem_cross3l(n, u, w);
}

/* The deviator in the basis (u, w), and its images. */
static cdem_plane plane_of(const problem *block, const long double u[3], const long double w[3],
                           long double du[3], long double dw[3]) {
  cdem_multiply3l(block->deviator, u, du);
  cdem_multiply3l(block->deviator, w, dw);
  long double c00 = cdem_dot3l(u, du), c11 = cdem_dot3l(w, dw);
  return (cdem_plane){.mean = 0.5L * (c00 + c11),
                      .h = 0.5L * (c00 - c11),
                      .b = cdem_dot3l(u, dw),
                      .c = cdem_dot3l(w, du)};
}

static void add_mean(cdem_canonical *canonical, long double mean) {
  for (int k = 0; k < 3; k++)
    canonical->l[k][k] += mean;
}

/* Symmetric 3x3: an orthonormal set. Equal values: a plane keeps its documented directions, a
 * spherical block the axes. */
static bool symmetric_set(const problem *block, cdem_canonical *canonical) {
  double v[9], k[3], work[64];
  memcpy(v, block->s, sizeof v);
  if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'U', 3, v, 3, k, work, 64) != 0)
    return false;
  memset(canonical, 0, sizeof *canonical);
  canonical->size = 3;
  canonical->form = CDEM_FORM_DIAGONAL;
  canonical->cond = 1.0;
  double spread = 0.0;
  for (int i = 0; i < 9; i++)
    spread += (double)(block->deviator[i] * block->deviator[i]);
  bool spherical = sqrt(spread) <= block->bound;
  for (int i = 0; i < 3; i++) {
    canonical->l[i][i] = spherical ? block->mean : k[2 - i];
    for (int c = 0; c < 3; c++)
      canonical->p[i][c] = spherical ? (i == c) : v[3 * (2 - i) + c];
  }
  for (int single = 0; single < 3 && !spherical; single += 2) {
    int i = single == 0 ? 1 : 0; /* the pair is i, i + 1 */
    if ((double)(canonical->l[i][i] - canonical->l[i + 1][i + 1]) > sqrt(2.0) * block->bound)
      continue;
    plane_basis(canonical->p[single], canonical->p[i], canonical->p[i + 1]);
    canonical->l[i][i] = canonical->l[i + 1][i + 1] =
        0.5L * (canonical->l[i][i] + canonical->l[i + 1][i + 1]);
  }
  memcpy(canonical->q, canonical->p, sizeof canonical->q);
  return true;
}

static bool schur(const problem *block, schur_form *form, double wi[3]) {
  double wr[3], work[64];
  lapack_int unused = 0;
  for (int i = 0; i < 9; i++)
    form->t[i] = block->s[3 * (i % 3) + i / 3];
  return LAPACKE_dgees_work(LAPACK_COL_MAJOR, 'V', 'N', NULL, 3, form->t, 3, &unused, wr, wi,
                            form->u, 3, work, 64, NULL) == 0;
}

static bool move(schur_form *form, int from, int to) {
  double work[3];
  lapack_int first = from, last = to; /* from 1 */
  return from == to || LAPACKE_dtrexc_work(LAPACK_COL_MAJOR, 'V', 3, form->t, 3, form->u, 3, &first,
                                           &last, work) == 0;
}

/* Single value last in the Schur form: the first two vectors span the others' plane, its normal is
 * the third; right = U (y, 1) with (C - value) y = -t. */
static void separate(const schur_form *form, separation *single) {
  const double *t = form->t, *u = form->u;
  double c00 = t[0] - t[8], c10 = t[1], c01 = t[3], c11 = t[4] - t[8], x = t[6], z = t[7];
  double det = c00 * c11 - c01 * c10;
  double y0 = -(c11 * x - c01 * z) / det, y1 = -(c00 * z - c10 * x) / det;
  double length = sqrt(1.0 + y0 * y0 + y1 * y1), cosine = sqrt(y0 * y0 + y1 * y1) / length;
  single->cond = isfinite(length) ? (1.0 + cosine) * length : INFINITY;
  for (int c = 0; c < 3; c++) {
    single->left[c] = u[6 + c];
    single->right[c] = (y0 * u[c] + y1 * u[3 + c] + u[6 + c]) / length;
  }
}

/* One Newton step, as cdem_springs_kernel3_improve explains. */
static void improve(const problem *block, separation *single) {
  long double u[3], w[3], du[3], dw[3], dr[3], next[3];
  plane_basis(single->left, u, w);
  cdem_plane plane = plane_of(block, u, w, du, dw);
  cdem_multiply3l(block->deviator, single->right, dr);
  long double factor = 1.0L / cdem_dot3l(single->left, single->right);
  long double x = factor * cdem_dot3l(single->left, dr);
  long double ur = cdem_dot3l(u, single->right), wr = cdem_dot3l(w, single->right);
  long double g0 = cdem_dot3l(u, dr) - ur * x, g1 = cdem_dot3l(w, dr) - wr * x;
  long double f0 = factor * cdem_dot3l(single->left, du);
  long double f1 = factor * cdem_dot3l(single->left, dw);
  long double x0 = x - plane.mean - plane.h, x3 = x - plane.mean + plane.h;
  long double det = x0 * x3 - plane.b * plane.c;
  long double y0 = (x3 * g0 + plane.b * g1) / det, y1 = (plane.c * g0 + x0 * g1) / det;
  long double z0 = (f0 * x3 + f1 * plane.c) / det, z1 = (f0 * plane.b + f1 * x0) / det;
  for (int c = 0; c < 3; c++) {
    next[c] = factor * (1.0L - z0 * ur - z1 * wr) * single->left[c] + z0 * u[c] + z1 * w[c];
    single->right[c] += y0 * u[c] + y1 * w[c];
  }
  long double length = sqrtl(cdem_dot3l(next, next));
  for (int c = 0; c < 3; c++)
    single->left[c] = next[c] / length;
}

/* All choices of a single value, best separated first; returns their number. Several must be
 * tried: beside a double value without defect, rounding may separate one of the two better than
 * the third. */
static int separations(const problem *block, const schur_form *form, const double wi[3],
                       separation choice[3]) {
  int count = 0;
  for (int from = 1; from <= 3; from++) {
    if (wi[from - 1] != 0.0)
      continue;
    schur_form moved = *form;
    separation single;
    if (!move(&moved, from, 3))
      continue; /* values too close to change places */
    separate(&moved, &single);
    if (single.cond > 10.0 * CDEM_SPRINGS_MAX_COND)
      continue;
    for (int step = 0; step < 2; step++)
      improve(block, &single);
    int place_of = count++;
    for (; place_of > 0 && choice[place_of - 1].cond > single.cond; place_of--)
      choice[place_of] = choice[place_of - 1];
    choice[place_of] = single;
  }
  return count;
}

/* |P L P^-1 - S|_F: what a difference taken for rounding costs, cond(P) times its size. */
static long double error_of(const problem *block, const cdem_canonical *canonical) {
  long double error = 0.0L;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      long double difference = -block->s[3 * i + j];
      for (int k = 0; k < 3; k++)
        for (int m = 0; m < 3; m++)
          difference += canonical->p[k][i] * canonical->l[k][m] * canonical->q[m][j];
      error += difference * difference;
    }
  return sqrtl(error);
}

/* Springs of a separated block: eigenvectors, or the plane's Schur block, with differences below
 * `bound` taken for rounding. False when cond(P) or the error is too large. */
static bool separated_with(const problem *block, const separation *single, bool eigenvectors,
                           double bound, cdem_canonical *canonical) {
  long double u[3], w[3], du[3], dw[3], a[2], b[2], l[2][2];
  plane_basis(single->left, u, w);
  cdem_plane plane = plane_of(block, u, w, du, dw);
  cdem_multiply3l(block->deviator, single->right, du);
  long double value = cdem_dot3l(single->left, du) / cdem_dot3l(single->left, single->right);
  canonical->size = 3;
  if (!eigenvectors)
    cdem_plane_schur(&plane, bound, a, b, l, &canonical->form);
  else if (!cdem_plane_eigenvectors(&plane, bound, a, b, l, &canonical->form))
    return false;
  place(canonical, single->right, u, w, a, b);
  put_plane(canonical, value, l);
  add_mean(canonical, block->mean);
  return cdem_canonical_invert(canonical) && canonical->cond <= CDEM_SPRINGS_MAX_COND &&
         error_of(block, canonical) <= 10.0L * block->bound;
}

static bool separated_set(const problem *block, const separation *single, bool eigenvectors,
                          cdem_canonical *canonical) {
  return separated_with(block, single, eigenvectors, block->bound, canonical) ||
         separated_with(block, single, eigenvectors, 0.0, canonical);
}

/* Singular vectors of the deviator: largest left and right, smallest right and its value. */
static bool singular_vectors(const problem *block, double u[9], double v[9], double value[3]) {
  double m[9], vt[9], work[64];
  for (int i = 0; i < 9; i++)
    m[i] = (double)block->deviator[3 * (i % 3) + i / 3];
  if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'A', 'A', 3, 3, m, 3, value, u, 3, vt, 3, work, 64) !=
      0)
    return false;
  for (int i = 0; i < 9; i++)
    v[i] = vt[3 * (i % 3) + i / 3]; /* v[3 k + c]: component c of vector k */
  return true;
}

/* A block k I + (rank one, nilpotent or nearly so) = k I + sigma u v^T decouples from w = u x v. */
static bool decoupled_direction(const problem *block, const double u[9], const double v[9],
                                separation *single) {
  long double ul[3] = {u[0], u[1], u[2]}, vl[3] = {v[0], v[1], v[2]}, w[3], dw[3], wd[3];
  cdem_cross3l(ul, vl, w);
  long double length = sqrtl(cdem_dot3l(w, w));
  if (length < 0.5L)
    return false;
  for (int c = 0; c < 3; c++)
    w[c] /= length;
  long double away = 0.0L;
  cdem_multiply3l(block->deviator, w, dw);
  for (int j = 0; j < 3; j++)
    wd[j] =
        w[0] * block->deviator[j] + w[1] * block->deviator[3 + j] + w[2] * block->deviator[6 + j];
  long double k = cdem_dot3l(w, dw);
  for (int c = 0; c < 3; c++) {
    long double right = dw[c] - k * w[c], left = wd[c] - k * w[c];
    away += right * right + left * left;
    single->left[c] = single->right[c] = w[c];
  }
  single->cond = 1.0;
  return sqrtl(away) <= block->bound;
}

/* The exact triple defect: each kernel of the staircase within rounding. */
static bool staircase_set(const problem *block, const double v[9], double smallest,
                          cdem_canonical *canonical) {
  long double q[3] = {v[6], v[7], v[8]}, u[3], w[3], du[3], dw[3], a[2], b[2], l[2][2], d2[3],
              d3[3];
  if (smallest > block->bound)
    return false;
  plane_basis(q, u, w);
  cdem_plane plane = plane_of(block, u, w, du, dw);
  cdem_plane_schur(&plane, block->bound, a, b, l, &canonical->form);
  if (canonical->form != CDEM_FORM_JORDAN2 || l[0][0] != l[1][1] ||
      fabsl(plane.mean) > block->bound)
    return false;
  canonical->size = 3;
  canonical->form = CDEM_FORM_JORDAN3;
  place(canonical, q, u, w, a, b);
  put_plane(canonical, 0.0L, l);
  cdem_multiply3l(block->deviator, canonical->p[1], d2);
  cdem_multiply3l(block->deviator, canonical->p[2], d3);
  for (int k = 0; k < 3; k++)
    canonical->l[k][k] = block->mean;
  canonical->l[0][1] = cdem_dot3l(canonical->p[0], d2);
  canonical->l[0][2] = cdem_dot3l(canonical->p[0], d3);
  if (fabsl(canonical->l[0][2]) <= block->bound)
    canonical->l[0][2] = 0.0L;
  return cdem_canonical_invert(canonical);
}

/* The whole block in its orthonormal Schur basis, always possible. Real values descend. */
static bool whole_set(const problem *block, schur_form *form, const double wi[3],
                      cdem_canonical *canonical) {
  bool conjugate = wi[0] != 0.0 || wi[1] != 0.0;
  if (conjugate && form->t[1] != 0.0 && !move(form, 3, 1))
    return false;
  if (!conjugate)
    for (int first = 1; first < 3; first++)
      for (int k = first + 1; k <= 3; k++)
        if (form->t[4 * (k - 1)] > form->t[4 * (first - 1)] && !move(form, k, first))
          break; /* equal but for rounding */
  canonical->size = 3;
  canonical->form = conjugate ? CDEM_FORM_COMPLEX : CDEM_FORM_JORDAN3;
  for (int k = 0; k < 3; k++)
    for (int c = 0; c < 3; c++) {
      canonical->p[k][c] = form->u[3 * k + c];
      canonical->l[c][k] = c > k && !conjugate ? 0.0 : form->t[3 * k + c];
    }
  canonical->l[1][0] = canonical->l[2][0] = 0.0L;
  if (conjugate && fabsl(canonical->l[1][2]) < fabsl(canonical->l[2][1])) {
    /* Turn the plane by a right angle: (2, 3) become (3, -2). */
    for (int c = 0; c < 3; c++) {
      long double p = canonical->p[1][c], l = canonical->l[c][1];
      canonical->p[1][c] = canonical->p[2][c], canonical->p[2][c] = -p;
      if (c == 0)
        canonical->l[0][1] = canonical->l[0][2], canonical->l[0][2] = -l;
    }
    long double b = canonical->l[1][2];
    canonical->l[1][2] = -canonical->l[2][1], canonical->l[2][1] = -b;
  }
  for (int j = 1; j < 3; j++)
    if (fabsl(canonical->l[0][j]) <= block->bound)
      canonical->l[0][j] = 0.0L;
  memcpy(canonical->q, canonical->p, sizeof canonical->q);
  canonical->cond = 1.0;
  return true;
}

static bool general_set(const problem *block, cdem_canonical *canonical) {
  schur_form form;
  separation choice[3], decoupled;
  double wi[3], u[9], v[9], value[3];
  if (!schur(block, &form, wi))
    return false;
  int choices = separations(block, &form, wi, choice);
  for (int i = 0; i < choices; i++)
    if (separated_set(block, &choice[i], true, canonical))
      return true;
  if (!singular_vectors(block, u, v, value))
    return false;
  if (decoupled_direction(block, u, v, &decoupled) &&
      separated_set(block, &decoupled, false, canonical))
    return true;
  for (int i = 0; i < choices; i++)
    if (separated_set(block, &choice[i], false, canonical))
      return true;
  return staircase_set(block, v, value[2], canonical) || whole_set(block, &form, wi, canonical);
}

static bool plane_set(const problem *block, cdem_canonical *canonical) {
  const double *s = block->s;
  cdem_plane plane = {.mean = 0.5L * ((long double)s[0] + s[3]),
                      .h = 0.5L * ((long double)s[0] - s[3]),
                      .b = s[1],
                      .c = s[2]};
  long double l[2][2];
  memset(canonical, 0, sizeof *canonical);
  canonical->size = 2;
  bool found = cdem_plane_eigenvectors(&plane, block->bound, canonical->p[0], canonical->p[1], l,
                                       &canonical->form) &&
               cdem_canonical_invert(canonical) && canonical->cond <= CDEM_SPRINGS_MAX_COND;
  if (!found) {
    cdem_plane_schur(&plane, block->bound, canonical->p[0], canonical->p[1], l, &canonical->form);
    found = cdem_canonical_invert(canonical);
  }
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      canonical->l[i][j] = l[i][j];
  return found;
}

static cdem_status refuse(const double *s, int size, cdem_fault *fault) {
  int e = 0;
  while (isfinite(s[e]))
    e++;
  return cdem_fail(fault, CDEM_NUMERIC,
                   "stiffness block is not finite: row %d, column %d is %g; check the element's "
                   "shape and material",
                   e / size + 1, e % size + 1, s[e]);
}

cdem_status cdem_springs_from_block(const double *s, int size, bool frame, cdem_spring_set *set,
                                    cdem_fault *fault) {
  CDEM_REQUIRE(size == 2 || size == 3, fault, CDEM_NUMERIC,
               "stiffness block is %d x %d, and only 2 x 2 and 3 x 3 blocks have spring sets", size,
               size);
  problem block = {.size = size};
  if (!cdem_springs_scale(s, size * size, block.s, &block.exponent))
    return refuse(s, size, fault);
  if (frame && size == 3 && cdem_springs_recognise_frame(s, set)) {
    set->slow = 1;
    return CDEM_OK;
  }
  prepare(&block);
  cdem_canonical canonical = {0};
  bool done = size == 2         ? plane_set(&block, &canonical)
              : block.symmetric ? symmetric_set(&block, &canonical)
                                : general_set(&block, &canonical);
  CDEM_REQUIRE(
      done, fault, CDEM_NUMERIC,
      "stiffness block has no spring set: LAPACK finds no eigenvalues of a block with first "
      "row %g %g",
      s[0], s[1]);
  cdem_canonical_store(&canonical, block.exponent, set);
  return CDEM_OK;
}
