/* Nominal strain of grains: the deformation gradient that fits best the motion of the neighbours of
 * a reference state (least squares as in Falk & Langer 1998, Phys. Rev. E 57, 7192, eqs 2.12-2.14),
 * and finite strain measures of it. */
#include "dem/measures_kernels.h"

#include <stdlib.h>
#include <string.h>

struct cdem_strain_reference {
  int64_t grains;
  int64_t *start; /* [grains + 1] */
  int32_t *other;
  double *from; /* [start[grains]][3]: from the grain to its neighbour (image) */
  bool cell;
  double h[9]; /* of the cell */
};

/* ---- reference ---- */

typedef struct {
  const cdem_snapshot *s;
  double reach;
  cdem_copies copies;
  cdem_buckets buckets;
} finder;

/* Neighbours of grain i: counts them, or writes them down. Ordered by copy, so always the same. */
static int64_t find_neighbours(const finder *f, int64_t i, int32_t *other, double *from) {
  const double *x = f->s->xyz + 3 * i;
  int64_t found = 0, bucket = cdem_buckets_find(&f->buckets, x);
  if (bucket < 0)
    return 0;
  for (int64_t k = f->buckets.start[bucket]; k < f->buckets.start[bucket + 1]; k++) {
    int32_t copy = f->buckets.item[k], j = f->copies.id[copy];
    double d[3], reach = 0.5 * f->reach * (f->s->radius[i] + f->s->radius[j]);
    for (int c = 0; c < 3; c++)
      d[c] = f->copies.place[3 * (int64_t)copy + c] - x[c];
    double squared = cdem_dot3(d, d);
    if (!(squared > 0.0 && squared <= reach * reach))
      continue;
    if (other != NULL) {
      other[found] = j;
      memcpy(from + 3 * found, d, sizeof d);
    }
    found++;
  }
  return found;
}

static cdem_status finder_init(const cdem_snapshot *s, double reach, finder *f, cdem_fault *fault) {
  double low[3], high[3], largest = 0.0;
  *f = (finder){.s = s, .reach = reach};
  for (int64_t i = 0; i < s->grains; i++)
    largest = fmax(largest, s->radius[i]);
  cdem_snapshot_box(s, low, high);
  CDEM_TRY(cdem_copies_make(s, low, high, reach * largest, &f->copies, fault));
  double *box = cdem_allocate(6 * f->copies.count, sizeof *box, fault);
  if (box == NULL)
    return CDEM_MEMORY;
  for (int64_t k = 0; k < f->copies.count; k++)
    for (int c = 0; c < 3; c++) {
      double most = 0.5 * reach * (s->radius[f->copies.id[k]] + largest);
      box[6 * k + c] = f->copies.place[3 * k + c] - most;
      box[6 * k + 3 + c] = f->copies.place[3 * k + c] + most;
    }
  cdem_status status =
      cdem_buckets_build(s->dim, f->copies.count, box, reach * largest, &f->buckets, fault);
  free(box);
  return status;
}

static cdem_status fill_reference(const finder *f, cdem_strain_reference *r, cdem_fault *fault) {
  const cdem_snapshot *s = f->s;
  CDEM_NEW(r->start, s->grains + 1, fault);
  for (int64_t i = 0; i < s->grains; i++)
    r->start[i + 1] = r->start[i] + find_neighbours(f, i, NULL, NULL);
  CDEM_NEW(r->other, r->start[s->grains], fault);
  CDEM_NEW(r->from, 3 * r->start[s->grains], fault);
  for (int64_t i = 0; i < s->grains; i++)
    find_neighbours(f, i, r->other + r->start[i], r->from + 3 * r->start[i]);
  if (s->cell != NULL)
    memcpy(r->h, s->cell->h, sizeof r->h);
  r->cell = s->cell != NULL;
  r->grains = s->grains;
  return CDEM_OK;
}

cdem_status cdem_strain_reference_make(const cdem_snapshot *s, double reach,
                                       cdem_strain_reference **reference, cdem_fault *fault) {
  cdem_strain_reference *made;
  finder f;
  CDEM_REQUIRE(
      reach == 0.0 || (reach >= 2.0 && reach <= 100.0), fault, CDEM_USAGE,
      "a reach of %g radii for the neighbours of a grain; choose 2 (touching) to 100, or 0 "
      "for 3",
      reach);
  CDEM_NEW(made, 1, fault);
  cdem_status status = finder_init(s, reach > 0.0 ? reach : 3.0, &f, fault);
  if (status == CDEM_OK)
    status = fill_reference(&f, made, fault);
  cdem_copies_release(&f.copies);
  cdem_buckets_release(&f.buckets);
  if (status == CDEM_OK)
    *reference = made;
  else
    cdem_strain_reference_destroy(&made);
  return status;
}

cdem_status cdem_strain_reference_create(const cdem_dem *dem, double reach,
                                         cdem_strain_reference **reference, cdem_fault *fault) {
  cdem_snapshot s;
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  cdem_status status = cdem_strain_reference_make(&s, reach, reference, fault);
  cdem_snapshot_release(&s);
  return status;
}

void cdem_strain_reference_destroy(cdem_strain_reference **reference) {
  if (*reference == NULL)
    return;
  free((*reference)->start);
  free((*reference)->other);
  free((*reference)->from);
  free(*reference);
  *reference = NULL;
}

/* ---- gradients ---- */

/* How a vector between grains became what it is: in a cell the image that is nearest to where the
 * deformation of the cell would have taken it. */
typedef struct {
  const cdem_snapshot *s;
  const double *map; /* h now times inverse of h then; NULL: no cell */
} motion;

static void vector_now(const motion *m, int64_t i, int32_t j, const double from[3], double now[3]) {
  const cdem_snapshot *s = m->s;
  if (m->map == NULL) {
    for (int c = 0; c < 3; c++)
      now[c] = s->xyz[3 * (int64_t)j + c] - s->xyz[3 * i + c];
    return;
  }
  double guess[3], off[3];
  for (int c = 0; c < 3; c++) {
    guess[c] = cdem_dot3(m->map + 3 * c, from);
    off[c] = s->xyz[3 * (int64_t)j + c] - s->xyz[3 * i + c] - guess[c];
  }
  cdem_cell_nearest(s->cell, off);
  for (int c = 0; c < 3; c++)
    now[c] = guess[c] + off[c];
}

static void fit(const motion *m, const cdem_strain_reference *r, int64_t i, double gradient[9]) {
  int dim = m->s->dim;
  double moment[9] = {0.0}, product[9] = {0.0}, inverse[9], size = 0.0;
  for (int64_t k = r->start[i]; k < r->start[i + 1]; k++) {
    double now[3];
    const double *from = r->from + 3 * k;
    vector_now(m, i, r->other[k], from, now);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        product[3 * a + b] += (now[a] - from[a]) * from[b];
        moment[3 * a + b] += from[a] * from[b];
      }
  }
  for (int c = 0; c < dim; c++)
    size += moment[4 * c] / dim;
  if (dim == 2) { /* out of the plane nothing moves */
    moment[8] = size;
    moment[2] = moment[5] = moment[6] = moment[7] = 0.0;
  }
  double det = cdem_inverse3(moment, inverse);
  /* Flat neighbourhoods: the moment's determinant against that of a round one. */
  if (!(det > 1e-9 * size * size * size)) {
    for (int k = 0; k < 9; k++)
      gradient[k] = NAN;
    return;
  }
  cdem_product3(product, inverse, gradient);
}

void cdem_grain_gradient_kernel(const cdem_snapshot *s, const cdem_strain_reference *reference,
                                double *gradient) {
  double map[9], inverse[9], h[2][9];
  motion m = {s, NULL};
  if (s->cell != NULL && reference->cell) {
    memcpy(h[0], reference->h, sizeof h[0]);
    memcpy(h[1], s->cell->h, sizeof h[1]);
    for (int k = 0; k < 2; k++) /* directions without an edge stay as they are */
      for (int c = 0; c < 3; c++)
        if (!s->cell->periodic[c] || c >= s->dim)
          for (int row = 0; row < 3; row++)
            h[k][3 * row + c] = row == c ? 1.0 : 0.0;
    cdem_inverse3(h[0], inverse);
    cdem_product3(h[1], inverse, map);
    m.map = map;
  }
#pragma omp parallel for schedule(static) num_threads(cdem_snapshot_threads(s))
  for (int64_t i = 0; i < s->grains; i++)
    fit(&m, reference, i, gradient + 9 * i);
}

/* ---- measures ---- */

/* Eigenvalues and vectors (columns) of a symmetric matrix by Jacobi rotations. */
static void jacobi(double a[9], double v[9]) {
  for (int k = 0; k < 9; k++)
    v[k] = k % 4 == 0 ? 1.0 : 0.0;
  for (int sweep = 0; sweep < 30; sweep++)
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        double off = a[3 * p + q];
        if (off == 0.0)
          continue;
        double theta = 0.5 * (a[4 * q] - a[4 * p]) / off;
        double t = (theta < 0.0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
        double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
        for (int k = 0; k < 3; k++) {
          double x = a[3 * k + p], y = a[3 * k + q];
          a[3 * k + p] = c * x - s * y;
          a[3 * k + q] = s * x + c * y;
        }
        for (int k = 0; k < 3; k++) {
          double x = a[3 * p + k], y = a[3 * q + k];
          a[3 * p + k] = c * x - s * y;
          a[3 * q + k] = s * x + c * y;
          x = v[3 * k + p], y = v[3 * k + q];
          v[3 * k + p] = c * x - s * y;
          v[3 * k + q] = s * x + c * y;
        }
        a[3 * p + q] = a[3 * q + p] = 0.0;
      }
}

static double effective_of(const double principal[3]) {
  double mean = (principal[0] + principal[1] + principal[2]) / 3.0, sum = 0.0;
  for (int c = 0; c < 3; c++)
    sum += (principal[c] - mean) * (principal[c] - mean);
  return sqrt(2.0 / 3.0 * sum);
}

/* R = F U^-1, and its vector; near half a turn the axis is that of R + 1. */
static void rotation_of(const double f[9], const double stretch[3], const double v[9],
                        double rotation[3]) {
  double u[9] = {0.0}, r[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        u[3 * i + j] += v[3 * i + k] * v[3 * j + k] / stretch[k];
  cdem_product3(f, u, r);
  const double axis[3] = {0.5 * (r[7] - r[5]), 0.5 * (r[2] - r[6]), 0.5 * (r[3] - r[1])};
  double sine = cdem_norm3(axis), cosine = 0.5 * (r[0] + r[4] + r[8] - 1.0);
  double angle = atan2(sine, cosine);
  int best = 0;
  for (int c = 1; c < 3; c++)
    best = r[4 * c] > r[4 * best] ? c : best;
  double column[3], sign = 0.0;
  for (int c = 0; c < 3; c++) {
    column[c] = 0.5 * (r[3 * c + best] + r[3 * best + c]) - (c == best ? cosine : 0.0);
    sign += column[c] * axis[c];
  }
  double length = cdem_norm3(column);
  for (int c = 0; c < 3; c++)
    rotation[c] = cosine > -0.9 ? (sine > 0.0 ? axis[c] * angle / sine : 0.0)
                                : (sign < 0.0 ? -1.0 : 1.0) * column[c] * angle / length;
}

static void hencky(int dim, const double h[9], double *volumetric, double *effective,
                   double rotation[3]) {
  double f[9], c[9], v[9], logarithm[3], stretch[3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) { /* C - 1, which keeps the digits of small strains */
      c[3 * i + j] = h[3 * i + j] + h[3 * j + i];
      for (int k = 0; k < 3; k++)
        c[3 * i + j] += h[3 * k + i] * h[3 * k + j];
      f[3 * i + j] = h[3 * i + j] + (i == j ? 1.0 : 0.0);
    }
  bool whole = cdem_det3(f) > 0.0;
  jacobi(c, v);
  for (int k = 0; k < 3; k++) {
    logarithm[k] = whole ? 0.5 * log1p(c[4 * k]) : NAN;
    stretch[k] = exp(logarithm[k]);
  }
  *volumetric = logarithm[0] + logarithm[1] + logarithm[2];
  *effective = effective_of(logarithm);
  if (dim == 2) {
    rotation[0] = rotation[1] = 0.0;
    rotation[2] = whole ? atan2(f[3] - f[1], f[0] + f[4]) : NAN;
  } else
    rotation_of(f, stretch, v, rotation);
}

static void small_strain(const double h[9], double *volumetric, double *effective) {
  double sum = 0.0, trace = h[0] + h[4] + h[8];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double e = 0.5 * (h[3 * i + j] + h[3 * j + i]) - (i == j ? trace / 3.0 : 0.0);
      sum += e * e;
    }
  *volumetric = trace;
  *effective = sqrt(2.0 / 3.0 * sum);
}

void cdem_strain_measure(int dim, cdem_strain_kind kind, const double gradient[9],
                         double *volumetric, double *effective, double rotation[3]) {
  double v, e, r[3];
  hencky(dim, gradient, &v, &e, r);
  if (kind == CDEM_STRAIN_SMALL)
    small_strain(gradient, &v, &e);
  if (volumetric != NULL)
    *volumetric = v;
  if (effective != NULL)
    *effective = e;
  if (rotation != NULL)
    memcpy(rotation, r, sizeof r);
}

cdem_status cdem_grain_strain(const cdem_dem *dem, const cdem_strain_reference *reference,
                              double *gradient, double *volumetric, double *effective,
                              cdem_fault *fault) {
  cdem_snapshot s;
  double *own = gradient;
  CDEM_REQUIRE(reference->grains == dem->grains, fault, CDEM_USAGE,
               "the reference of the strains has %lld grains, the model %lld",
               (long long)reference->grains, (long long)dem->grains);
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  if (own == NULL)
    own = cdem_allocate(9 * s.grains, sizeof *own, fault);
  if (own != NULL) {
    cdem_grain_gradient_kernel(&s, reference, own);
    for (int64_t i = 0; i < s.grains; i++)
      cdem_strain_measure(s.dim, CDEM_STRAIN_HENCKY, own + 9 * i,
                          volumetric != NULL ? volumetric + i : NULL,
                          effective != NULL ? effective + i : NULL, NULL);
  }
  cdem_snapshot_release(&s);
  cdem_status status = own != NULL ? CDEM_OK : CDEM_MEMORY;
  if (gradient == NULL)
    free(own);
  return status;
}
