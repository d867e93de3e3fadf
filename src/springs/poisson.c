#include "springs/poisson.h"

#include "springs/parts.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

double cdem_poisson_factor_solid(double nu) {
  return (1.0 + nu) * (1.0 - 2.0 * nu);
}

double cdem_poisson_factor_plane_stress(double nu) {
  return (1.0 - nu) * (1.0 + nu);
}

/* ---- the pencil ---- */

static cdem_status scaled_block(const cdem_poisson_family *family, double nu, double *t,
                                cdem_fault *fault) {
  CDEM_TRY(family->block(family->context, nu, t, fault));
  double factor = family->factor(nu);
  for (int i = 0; i < family->size * family->size; i++)
    t[i] *= factor;
  return CDEM_OK;
}

/* The line through two places of the range, tested at two more. */
static cdem_status fit_pencil(const cdem_poisson_family *family, cdem_pencil *pencil,
                              cdem_fault *fault) {
  int entries = family->size * family->size;
  double width = family->high - family->low, left = family->low + 0.3 * width,
         right = family->low + 0.8 * width, t[2][9];
  *pencil = (cdem_pencil){.size = family->size, .low = family->low, .high = family->high};
  CDEM_TRY(scaled_block(family, left, t[0], fault));
  CDEM_TRY(scaled_block(family, right, t[1], fault));
  for (int i = 0; i < entries; i++) {
    pencil->b[i] = (t[1][i] - t[0][i]) / (right - left);
    pencil->a[i] = t[0][i] - left * pencil->b[i];
  }
  for (int test = 0; test < 2; test++) {
    double nu = family->low + (test == 0 ? 0.1 : 0.55) * width, off[9];
    CDEM_TRY(scaled_block(family, nu, t[0], fault));
    for (int i = 0; i < entries; i++)
      off[i] = t[0][i] - pencil->a[i] - nu * pencil->b[i];
    double relative = cdem_frobenius(off, entries) / (cdem_frobenius(t[0], entries) + DBL_MIN);
    CDEM_REQUIRE(relative <= 1e-11, fault, CDEM_USAGE,
                 "the block times its factor is not linear in Poisson's ratio: off by %.3g at %g",
                 relative, nu);
  }
  return CDEM_OK;
}

/* ---- the order of the stiffnesses ---- */

/* First rank of the two values that meet at a root. */
static int first_rank(const cdem_poisson_roots *roots, int i, int size) {
  return size == 3 && !roots->root[i].upper ? 1 : 0;
}

static void swap(int8_t *a, int8_t *b) {
  int8_t c = *a;
  *a = *b;
  *b = c;
}

/* Labels on the far side of root i from those on the near side. A complex interval keeps its single
 * value in the last rank, the pair's labels before it. */
static void cross_root(const cdem_poisson_study *study, int i, bool upwards, const int8_t from[3],
                       int8_t to[3]) {
  const cdem_poisson_root *root = &study->roots.root[i];
  int size = study->family.size, first = first_rank(&study->roots, i, size);
  cdem_form near_ = upwards ? root->from : root->to, far = upwards ? root->to : root->from;
  memcpy(to, from, 3);
  if (near_ == far) {
    if (root->triple && root->order % 4 == 2)
      swap(&to[0], &to[2]); /* all three cross */
    else if (near_ == CDEM_FORM_DIAGONAL && root->order % 4 == 2)
      swap(&to[first], &to[first + 1]);
  } else if (size == 3 && first == 1) {
    /* The single value is the largest one: it goes to the last rank, or comes from there. */
    int shift = near_ == CDEM_FORM_DIAGONAL ? 1 : 2;
    for (int r = 0; r < 3; r++)
      to[r] = from[(r + shift) % 3];
  }
}

static cdem_form interval_form(const cdem_poisson_roots *roots, int interval) {
  return interval == 0 ? roots->start : roots->root[interval - 1].to;
}

static int interval_of(const cdem_poisson_roots *roots, double nu) {
  int interval = 0;
  while (interval < roots->count && nu >= roots->root[interval].nu)
    interval++;
  return interval;
}

static double interval_middle(const cdem_poisson_study *study, int interval) {
  const cdem_poisson_roots *roots = &study->roots;
  double low = interval == 0 ? study->family.low : roots->root[interval - 1].nu;
  double high = interval == roots->count ? study->family.high : roots->root[interval].nu;
  return 0.5 * (low + high);
}

/* Labels from the closed form: the rank of each of its stiffnesses. */
static void label_by_closed_form(cdem_poisson_study *study, int interval) {
  const cdem_poisson_family *family = &study->family;
  cdem_closed closed;
  if (family->closed == NULL || interval_form(&study->roots, interval) != CDEM_FORM_DIAGONAL ||
      !family->closed(family->context, interval_middle(study, interval), &closed) ||
      closed.form != CDEM_FORM_DIAGONAL)
    return;
  for (int i = 0; i < family->size; i++) {
    int rank = 0;
    for (int j = 0; j < family->size; j++)
      rank += closed.k[j] > closed.k[i] || (closed.k[j] == closed.k[i] && j < i);
    study->label[interval][rank] = (int8_t)i;
  }
}

static void label_intervals(cdem_poisson_study *study) {
  /* Isotropic blocks are symmetric at 1/4, where lambda = G; a touch there belongs to the left. */
  double anchor_nu = fmin(fmax(0.25, study->family.low), study->family.high);
  int count = study->roots.count, anchor = interval_of(&study->roots, anchor_nu - 1e-6);
  for (int r = 0; r < 3; r++)
    study->label[anchor][r] = (int8_t)r;
  for (int i = anchor; i < count; i++)
    cross_root(study, i, true, study->label[i], study->label[i + 1]);
  for (int i = anchor; i > 0; i--)
    cross_root(study, i - 1, false, study->label[i], study->label[i - 1]);
  for (int i = 0; i <= count; i++)
    label_by_closed_form(study, i);
}

cdem_status cdem_poisson_study_init(const cdem_poisson_family *family, cdem_poisson_study *study,
                                    cdem_fault *fault) {
  CDEM_REQUIRE(family->size == 2 || family->size == 3, fault, CDEM_USAGE,
               "a block of size %d has no springs; it must be 2 or 3", family->size);
  cdem_poisson_study made = {.family = *family};
  CDEM_TRY(fit_pencil(family, &made.pencil, fault));
  cdem_poisson_find_roots(&made.pencil, &made.roots);
  label_intervals(&made);
  *study = made;
  return CDEM_OK;
}

/* ---- one row ---- */

static void flip(double v[3]) {
  for (int i = 0; i < 3; i++)
    v[i] = 0.0 - v[i]; /* no negative zeros in files */
}

/* Unit length and canonical sign. */
static void normalise(double v[3]) {
  double length = cdem_norm3(v);
  for (int i = 0; i < 3; i++)
    v[i] /= length;
  if (cdem_springs_sign(v) < 0.0)
    flip(v);
}

/* 2-norm condition of the matrix of directions. */
static double condition_of(const double *dir, int size) {
  double p[9], value[3], work[3];
  for (int i = 0; i < size; i++)
    for (int k = 0; k < size; k++)
      p[size * i + k] = dir[3 * k + i];
  if (LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'N', 'N', size, size, p, size, value, NULL, 1, NULL, 1,
                     work) != 0)
    return NAN;
  return value[0] / value[size - 1];
}

/* Ranks of the three values, largest first. */
static void rank_values(const double *k, int size, int rank[3]) {
  for (int i = 0; i < size; i++) {
    rank[i] = 0;
    for (int j = 0; j < size; j++)
      rank[i] += k[j] > k[i] || (k[j] == k[i] && j < i);
  }
}

static void empty_row(double nu, int size, cdem_form form, cdem_poisson_row *row) {
  *row = (cdem_poisson_row){.nu = nu,
                            .size = size,
                            .form = form,
                            .k = {NAN, NAN, NAN},
                            .coupling = NAN,
                            .frame_h = NAN,
                            .cond = NAN,
                            .closed = {NAN, NAN, NAN},
                            .difference = NAN};
}

/* Labels for real values at nu: those of its interval, or of the neighbour when nu is so near a
 * change of form that the interval is complex and the block is not. */
static const int8_t *labels_at(const cdem_poisson_study *study, double nu) {
  const cdem_poisson_roots *roots = &study->roots;
  int i = interval_of(roots, nu);
  if (interval_form(roots, i) == CDEM_FORM_DIAGONAL)
    return study->label[i];
  bool below = i > 0 && (i == roots->count || nu - roots->root[i - 1].nu < roots->root[i].nu - nu);
  int neighbour = below ? i - 1 : i < roots->count ? i + 1 : i;
  return study->label[neighbour];
}

static void put_real(const cdem_spring_set *set, const int8_t *label, cdem_poisson_row *row) {
  double k[3] = {0};
  int rank[3];
  for (int i = 0; i < row->size; i++)
    k[i] = set->row[i].stiffness;
  rank_values(k, row->size, rank);
  for (int i = 0; i < row->size; i++) {
    row->k[label[rank[i]]] = k[i];
    memcpy(row->dir[label[rank[i]]], set->row[i].dir, sizeof row->dir[0]);
  }
}

static void put_coupled(const cdem_spring_set *set, cdem_poisson_row *row) {
  double coupling[2] = {0.0, 0.0};
  int couplings = 0;
  for (int r = 0; r < set->rows; r++) {
    const cdem_spring_row *from = &set->row[r];
    int i = from->spring - 1;
    if (r < row->size) {
      row->k[i] = from->stiffness;
      memcpy(row->dir[i], from->dir, sizeof row->dir[i]);
    }
    /* Rows that couple the single spring (a block kept whole in its Schur basis) have no column. */
    if (from->couples_to != 0 && (row->size == 2 || i > 0) && couplings < 2)
      coupling[couplings++] = from->coupling;
  }
  row->coupling =
      set->form == CDEM_FORM_COMPLEX ? sqrt(fabs(coupling[0] * coupling[1])) : coupling[0];
}

/* The row by decomposition, where no two values are too near to tell their directions apart. */
static cdem_status row_by_decomposition(const cdem_poisson_study *study, double nu,
                                        cdem_poisson_row *row, cdem_fault *fault) {
  double s[9];
  cdem_spring_set set;
  CDEM_TRY(study->family.block(study->family.context, nu, s, fault));
  CDEM_TRY(cdem_springs_from_block(s, study->family.size, false, &set, fault));
  empty_row(nu, study->family.size, (cdem_form)set.form, row);
  row->cond = set.cond;
  if (set.form == CDEM_FORM_DIAGONAL)
    put_real(&set, labels_at(study, nu), row);
  else
    put_coupled(&set, row);
  return CDEM_OK;
}

/* ---- double everywhere ---- */

/* Unit vector along the longest row (stride 1 within it) or column of m. */
static void longest(const double m[9], bool row, double v[3]) {
  double best = -1.0;
  for (int i = 0; i < 3; i++) {
    double w[3];
    for (int j = 0; j < 3; j++)
      w[j] = row ? m[3 * i + j] : m[3 * j + i];
    if (cdem_norm3(w) > best) {
      best = cdem_norm3(w);
      memcpy(v, w, sizeof w);
    }
  }
  normalise(v);
}

/* S = pair I + (single - pair) r l^T: false when the double value is a defect after all. */
static bool split_double(const double s[9], double *single, double *pair, double r[3],
                         double l[3]) {
  double mean = (s[0] + s[4] + s[8]) / 3.0, m[9], square[9], rest[9];
  for (int i = 0; i < 9; i++)
    m[i] = s[i] - (i % 4 == 0 ? mean : 0.0);
  cdem_product3(m, m, square);
  double j2 = 0.5 * (square[0] + square[4] + square[8]);
  double deviator = fabs(j2) > 0.0 ? 3.0 * cdem_det3(m) / j2 : 0.0;
  *single = mean + deviator;
  *pair = mean - 0.5 * deviator;
  for (int i = 0; i < 9; i++)
    rest[i] = s[i] - (i % 4 == 0 ? *pair : 0.0);
  double size = cdem_frobenius(rest, 9);
  if (size <= 1e-12 * cdem_frobenius(s, 9)) {
    memcpy(r, (double[3]){1, 0, 0}, 3 * sizeof *r);
    memcpy(l, r, 3 * sizeof *r);
    return true;
  }
  longest(rest, false, r);
  longest(rest, true, l);
  double off[9], along = (*single - *pair) / cdem_dot3(r, l);
  for (int i = 0; i < 9; i++)
    off[i] = rest[i] - along * r[i / 3] * l[i % 3];
  return cdem_frobenius(off, 9) <= 1e-11 * size;
}

static cdem_status row_of_double(const cdem_poisson_study *study, double nu, cdem_poisson_row *row,
                                 cdem_fault *fault) {
  int size = study->family.size;
  double s[9], single, pair, left[3], axis[3];
  CDEM_TRY(study->family.block(study->family.context, nu, s, fault));
  empty_row(nu, size, CDEM_FORM_DIAGONAL, row);
  if (size == 2) {
    /* Off-diagonal rounding aside, a multiple of the identity; otherwise a defect. */
    if (hypot(s[1], s[2]) + fabs(s[0] - s[3]) > 1e-11 * cdem_frobenius(s, 4))
      return row_by_decomposition(study, nu, row, fault);
    row->k[0] = row->k[1] = 0.5 * (s[0] + s[3]);
    row->dir[0][0] = row->dir[1][1] = row->cond = 1.0;
    return CDEM_OK;
  }
  if (!split_double(s, &single, &pair, row->dir[0], left))
    return row_by_decomposition(study, nu, row, fault);
  row->k[0] = single;
  row->k[1] = row->k[2] = pair;
  cdem_springs_least_axis(left, axis);
  cdem_springs_plane_basis(left, axis, row->dir[1], row->dir[2]);
  normalise(row->dir[1]);
  normalise(row->dir[2]);
  row->cond = condition_of(&row->dir[0][0], 3);
  if (study->family.frame && fabs(cdem_dot3(left, row->dir[0])) > 1.0 - 1e-12)
    row->frame_h = 2.0 / 3.0 * pair;
  return CDEM_OK;
}

/* ---- touches ---- */

/* Distance from root i to the nearest other place where directions are not analytic. */
static double clearance(const cdem_poisson_study *study, int i) {
  const cdem_poisson_roots *roots = &study->roots;
  double nu = roots->root[i].nu;
  double free_ = fmin(nu - study->family.low, study->family.high - nu);
  if (i > 0)
    free_ = fmin(free_, nu - roots->root[i - 1].nu);
  if (i + 1 < roots->count)
    free_ = fmin(free_, roots->root[i + 1].nu - nu);
  return free_;
}

/* Spacing of the places beside root i from which directions are continued across it. At 4e-3 the
 * gap of a touch of fourth order still stands 1e-5 above rounding's 1e-16, and six places leave an
 * error of the order (spacing/clearance)^6. */
static double spacing(const cdem_poisson_study *study, int i) {
  return fmin(4e-3, 0.05 * clearance(study, i));
}

/* Root whose touch is so near that the directions at nu drown in rounding; -1: none. The gap grows
 * with the distance to the power order/2. */
static int touch_near(const cdem_poisson_study *study, double nu) {
  for (int i = 0; i < study->roots.count; i++) {
    const cdem_poisson_root *root = &study->roots.root[i];
    double radius = root->order == 2 ? 1e-7 : 1e-3;
    if (root->from == root->to && fabs(nu - root->nu) <= fmin(radius, 0.25 * spacing(study, i)))
      return i;
  }
  return -1;
}

/* Directions at nu by Lagrange's polynomial through six places around root i; false when one of
 * them has no real directions. */
static cdem_status continue_directions(const cdem_poisson_study *study, int i, double nu,
                                       double dir[3][3], bool *found, cdem_fault *fault) {
  static const int place[6] = {-3, -2, -1, 1, 2, 3};
  int size = study->family.size;
  double h = spacing(study, i), at = (nu - study->roots.root[i].nu) / h, first[3][3];
  *found = false;
  memset(dir, 0, 9 * sizeof(double));
  for (int p = 0; p < 6; p++) {
    cdem_poisson_row row;
    CDEM_TRY(row_by_decomposition(study, study->roots.root[i].nu + place[p] * h, &row, fault));
    if (row.form != CDEM_FORM_DIAGONAL)
      return CDEM_OK;
    if (p == 0)
      memcpy(first, row.dir, sizeof first);
    double weight = 1.0;
    for (int q = 0; q < 6; q++)
      if (q != p)
        weight *= (at - place[q]) / (place[p] - place[q]);
    for (int k = 0; k < size; k++) {
      double sign = cdem_dot3(first[k], row.dir[k]) < 0.0 ? -weight : weight;
      for (int d = 0; d < 3; d++)
        dir[k][d] += sign * row.dir[k][d];
    }
  }
  for (int k = 0; k < size; k++)
    normalise(dir[k]);
  *found = true;
  return CDEM_OK;
}

static cdem_status row_of_touch(const cdem_poisson_study *study, int i, double nu,
                                cdem_poisson_row *row, cdem_fault *fault) {
  bool found;
  double dir[3][3], s[9], k[3] = {0};
  int size = study->family.size, rank[3];
  CDEM_TRY(continue_directions(study, i, nu, dir, &found, fault));
  if (!found)
    return row_by_decomposition(study, nu, row, fault);
  cdem_spring_set set;
  CDEM_TRY(study->family.block(study->family.context, nu, s, fault));
  CDEM_TRY(cdem_springs_from_block(s, size, false, &set, fault));
  empty_row(nu, size, CDEM_FORM_DIAGONAL, row);
  for (int r = 0; r < size; r++)
    k[r] = set.row[r].stiffness; /* real parts, whatever rounding made of the form */
  rank_values(k, size, rank);
  const int8_t *label = labels_at(study, nu);
  for (int r = 0; r < size; r++)
    row->k[label[rank[r]]] = k[r];
  memcpy(row->dir, dir, sizeof row->dir);
  row->cond = condition_of(&row->dir[0][0], size);
  return CDEM_OK;
}

/* ---- rows in all ---- */

/* Half difference of a pair, squared; negative for a complex pair. Unlike the values themselves it
 * is smooth through a change of form. */
static double pair_discriminant(cdem_form form, const double pair[2], double coupling) {
  double half = (pair[0] - pair[1]) / 2.0;
  return form == CDEM_FORM_COMPLEX ? -coupling * coupling : half * half;
}

/* Off the diagonal form: single value, mean and discriminant of the pair; the closed values are put
 * in the order of the row (single first). Returns the largest difference. */
static double compare_pairs(cdem_poisson_row *row, const cdem_closed *closed, double largest) {
  int first = row->size - 2, single = 0;
  double off = 0.0;
  for (int i = 0; first == 1 && i < 3; i++)
    if (fabs(closed->k[i] - row->k[0]) < fabs(closed->k[single] - row->k[0]))
      single = i;
  for (int i = 0, at = first; i < row->size; i++)
    row->closed[first == 1 && i == single ? 0 : at++] = closed->k[i];
  if (first == 1)
    off = fabs(row->k[0] - row->closed[0]);
  const double *ours = row->k + first, *theirs = row->closed + first;
  double mean = fabs(ours[0] + ours[1] - theirs[0] - theirs[1]) / 2.0;
  double bend = fabs(pair_discriminant(row->form, ours, row->coupling) -
                     pair_discriminant(closed->form, theirs, closed->coupling));
  return fmax(off, fmax(mean, bend / largest));
}

static void compare_with_closed_form(const cdem_poisson_study *study, cdem_poisson_row *row) {
  const cdem_poisson_family *family = &study->family;
  cdem_closed closed;
  if (family->closed == NULL || !family->closed(family->context, row->nu, &closed))
    return;
  double largest = 0.0, off = 0.0;
  for (int i = 0; i < row->size; i++) {
    row->closed[i] = closed.k[i];
    largest = fmax(largest, fabs(closed.k[i]));
    off = fmax(off, fabs(row->k[i] - closed.k[i]));
  }
  if (closed.form == CDEM_FORM_COMPLEX)
    largest = fmax(largest, fabs(closed.coupling));
  if (row->form != CDEM_FORM_DIAGONAL || closed.form != CDEM_FORM_DIAGONAL)
    off = compare_pairs(row, &closed, largest);
  row->difference = off / largest;
}

cdem_status cdem_poisson_at(const cdem_poisson_study *study, double nu, cdem_poisson_row *row,
                            cdem_fault *fault) {
  const cdem_poisson_family *family = &study->family;
  CDEM_REQUIRE(nu > family->low && nu < family->high, fault, CDEM_INPUT,
               "Poisson's ratio %g is outside its range: it must lie between %g and %g", nu,
               family->low, family->high);
  cdem_poisson_row made = {0};
  int touch = touch_near(study, nu);
  if (study->roots.double_everywhere)
    CDEM_TRY(row_of_double(study, nu, &made, fault));
  else if (touch >= 0)
    CDEM_TRY(row_of_touch(study, touch, nu, &made, fault));
  else
    CDEM_TRY(row_by_decomposition(study, nu, &made, fault));
  compare_with_closed_form(study, &made);
  *row = made;
  return CDEM_OK;
}

/* Turns each direction to the side of the one before it: the same spring where the form is the
 * same, else whichever is nearest. The two parts of a complex pair turn together. */
static void follow_signs(const cdem_poisson_row *before, cdem_poisson_row *row) {
  int size = row->size, pair = row->form == CDEM_FORM_COMPLEX ? size - 2 : size;
  for (int k = 0; k < size; k++) {
    if (k == pair + 1)
      continue;
    double best = cdem_dot3(row->dir[k], before->dir[k]);
    for (int j = 0; j < size && before->form != row->form; j++) {
      double dot = cdem_dot3(row->dir[k], before->dir[j]);
      if (fabs(dot) > fabs(best))
        best = dot;
    }
    if (best < 0.0) {
      flip(row->dir[k]);
      if (k == pair)
        flip(row->dir[k + 1]);
      else if (row->form == CDEM_FORM_JORDAN2 && k >= size - 2)
        row->coupling = -row->coupling;
    }
  }
}

cdem_status cdem_poisson_follow(const cdem_poisson_study *study, double nu, cdem_poisson_row *row,
                                cdem_fault *fault) {
  enum { MOST_STEPS = 200 };
  cdem_poisson_row now = *row, next = {0};
  int steps = row->size == 0 ? 1 : (int)ceil(fabs(nu - row->nu) / 0.01);
  steps = steps < 1 ? 1 : steps > MOST_STEPS ? MOST_STEPS : steps;
  for (int i = 1; i <= steps; i++) {
    double at = i == steps ? nu : row->nu + (nu - row->nu) * i / steps;
    CDEM_TRY(cdem_poisson_at(study, at, &next, fault));
    if (now.size != 0)
      follow_signs(&now, &next);
    now = next;
  }
  *row = now;
  return CDEM_OK;
}
