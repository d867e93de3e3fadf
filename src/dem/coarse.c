/* Coarse-grained fields: sums of a bump over grains and along branches (measures.h). */
#include "dem/measures_kernels.h"

#include <stdlib.h>
#include <string.h>

/* A grain, or an image of one, and a contact, likewise: what a point gathers from. */
typedef struct {
  int32_t item; /* grain; or contacts from `grains` of the snapshot on */
  int32_t image;
} source;

typedef struct {
  const cdem_snapshot *s;
  const cdem_coarse *fields;
  double width, factor; /* of the bump: factor (1 - r^2/w^2)^3 */
  int64_t sources, capacity, boxes;
  source *source;
  double *box;         /* [sources][6] */
  double shift[27][3]; /* of the images */
  cdem_buckets buckets;
} coarse;

/* ---- the bump ---- */

/* One over the integral of (1 - r^2/w^2)^3: pi w^2/4 in the plane, 64 pi w^3/315 in space. */
static double bump_factor(const cdem_snapshot *s, double w) {
  const double pi = 3.14159265358979323846;
  return s->dim == 2 ? 4.0 / (pi * w * w * s->thickness) : 315.0 / (64.0 * pi * w * w * w);
}

static double bump(const coarse *c, const double d[3]) {
  double u = 1.0 - cdem_dot3(d, d) / (c->width * c->width);
  return u > 0.0 ? c->factor * u * u * u : 0.0;
}

/* Mean of the bump over the way from d by `branch`: a polynomial of degree six between where the
 * line enters and leaves, so that four Gauss points are exact. */
static double bump_along(const coarse *c, const double d[3], const double branch[3]) {
  static const double point[2] = {0.33998104358485626, 0.86113631159405258},
                      weight[2] = {0.65214515486254614, 0.34785484513745386};
  double w2 = c->width * c->width, l2 = cdem_dot3(branch, branch);
  if (!(l2 > 0.0))
    return bump(c, d);
  double nearest = -cdem_dot3(d, branch) / l2; /* where along the way the line is nearest */
  double off = cdem_dot3(d, d) - nearest * nearest * l2;
  if (off >= w2)
    return 0.0;
  double half = sqrt((w2 - off) / l2);
  double first = fmax(0.0, nearest - half), last = fmin(1.0, nearest + half), sum = 0.0;
  if (!(first < last))
    return 0.0;
  for (int k = 0; k < 4; k++) {
    double g = point[k / 2] * (k % 2 == 0 ? -1.0 : 1.0);
    double at = 0.5 * (first + last) + 0.5 * (last - first) * g - nearest;
    double u = 1.0 - (off + at * at * l2) / w2;
    sum += 0.5 * weight[k / 2] * u * u * u;
  }
  return c->factor * (last - first) * sum;
}

/* ---- sources ---- */

static cdem_status add_source(coarse *c, int64_t item, const double from[3], const double branch[3],
                              int image, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&c->source, &c->capacity, c->sources + 1, sizeof *c->source, fault));
  CDEM_TRY(cdem_grow(&c->box, &c->boxes, 6 * (c->sources + 1), sizeof *c->box, fault));
  c->source[c->sources] = (source){(int32_t)item, image};
  for (int k = 0; k < 3; k++) {
    double a = from[k] + c->shift[image][k], b = a + branch[k];
    c->box[6 * c->sources + k] = fmin(a, b) - c->width;
    c->box[6 * c->sources + 3 + k] = fmax(a, b) + c->width;
  }
  c->sources++;
  return CDEM_OK;
}

static bool reaches(const coarse *c, const double from[3], const double branch[3],
                    const double shift[3], const double low[3], const double high[3]) {
  bool near = true;
  for (int k = 0; k < c->s->dim; k++) {
    double a = from[k] + shift[k], b = a + branch[k];
    near &= fmin(a, b) - c->width <= high[k] && fmax(a, b) + c->width >= low[k];
  }
  return near;
}

static cdem_status add_all(coarse *c, int image, const double low[3], const double high[3],
                           cdem_fault *fault) {
  static const double none[3] = {0.0, 0.0, 0.0};
  const double *shift = c->shift[image];
  const cdem_snapshot *s = c->s;
  for (int64_t i = 0; i < s->grains; i++)
    if (reaches(c, s->xyz + 3 * i, none, shift, low, high))
      CDEM_TRY(add_source(c, i, s->xyz + 3 * i, none, image, fault));
  for (int64_t k = 0; k < s->contacts; k++) {
    const double *from = s->xyz + 3 * (int64_t)s->contact[k].a;
    if (reaches(c, from, s->contact[k].branch, shift, low, high))
      CDEM_TRY(add_source(c, s->grains + k, from, s->contact[k].branch, image, fault));
  }
  return CDEM_OK;
}

static cdem_status find_sources(coarse *c, const cdem_coarse_grid *grid, cdem_fault *fault) {
  const cdem_cell *cell = c->s->cell;
  if (cell != NULL)
    cdem_cell_images(cell, c->shift);
  for (int image = 0; image < 27; image++) {
    const int step[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
    bool real = cell != NULL || image == CDEM_IMAGE_SELF;
    for (int k = 0; k < 3 && real; k++)
      real = step[k] == 0 || (k < c->s->dim && cell->periodic[k]);
    if (real)
      CDEM_TRY(add_all(c, image, grid->low, grid->high, fault));
  }
  return cdem_buckets_build(c->s->dim, c->sources, c->box, c->width, &c->buckets, fault);
}

/* ---- points ---- */

static void add_grain(const coarse *c, int64_t p, int64_t i, const double drift[3], double part,
                      double square[9]) {
  const cdem_snapshot *s = c->s;
  const double *v = s->velocity + 3 * i, mass = part * s->mass[i];
  const double now[3] = {v[0] + drift[0], v[1] + drift[1], v[2] + drift[2]};
  c->fields->density[p] += mass;
  c->fields->solid[p] += part * cdem_grain_volume(s, s->radius[i]);
  for (int n = 0; n < 3; n++)
    c->fields->momentum[3 * p + n] += mass * now[n];
  for (int n = 0; n < 9; n++)
    square[n] += mass * now[n / 3] * now[n % 3];
}

static void gather(const coarse *c, int64_t p) {
  const cdem_snapshot *s = c->s;
  const cdem_coarse *f = c->fields;
  const double *x = f->xyz + 3 * p;
  double square[9] = {0.0}; /* sum m v (x) v */
  int64_t bucket = cdem_buckets_find(&c->buckets, x);
  for (int64_t k = bucket < 0 ? 0 : c->buckets.start[bucket];
       bucket >= 0 && k < c->buckets.start[bucket + 1]; k++) {
    const source *from = &c->source[c->buckets.item[k]];
    bool grain = from->item < s->grains;
    int64_t i = grain ? from->item : from->item - s->grains;
    const cdem_dem_contact *contact = grain ? NULL : &s->contact[i];
    const double *place = s->xyz + 3 * (grain ? i : (int64_t)contact->a);
    double d[3]; /* from the point */
    for (int n = 0; n < 3; n++)
      d[n] = place[n] + c->shift[from->image][n] - x[n];
    if (grain) {
      add_grain(c, p, i, s->drift[from->image], bump(c, d), square);
      continue;
    }
    double part = bump_along(c, d, contact->branch);
    for (int n = 0; n < 9; n++)
      f->stress[9 * p + n] += part * contact->force[n / 3] * contact->branch[n % 3];
    for (int n = 0; n < 3; n++)
      d[n] += contact->branch[n];
    part = contact->b < 0 ? bump(c, d) : 0.0;
    for (int n = 0; n < 3; n++)
      f->wall_force[3 * p + n] += part * contact->force[n];
  }
  for (int n = 0; n < 3 && f->density[p] > 0.0; n++)
    f->velocity[3 * p + n] = f->momentum[3 * p + n] / f->density[p];
  /* sum m (v - V) (x) (v - V) = sum m v (x) v - p (x) V */
  for (int n = 0; n < 9; n++)
    f->stress[9 * p + n] -= square[n] - f->momentum[3 * p + n / 3] * f->velocity[3 * p + n % 3];
}

/* ---- the call ---- */

static cdem_status check_grid(const cdem_snapshot *s, const cdem_coarse_grid *grid,
                              cdem_fault *fault) {
  CDEM_REQUIRE(grid->width >= 0.0 && isfinite(grid->width), fault, CDEM_USAGE,
               "a width of %g m for the fields; choose a positive one, or 0 for two diameters",
               grid->width);
  for (int c = 0; c < 3; c++) {
    CDEM_REQUIRE(grid->count[c] >= 1 && grid->count[c] <= 1000000, fault, CDEM_USAGE,
                 "%d points of the fields in direction %d; choose 1 to 1000000", grid->count[c], c);
    CDEM_REQUIRE(c >= s->dim || (isfinite(grid->low[c]) && grid->low[c] <= grid->high[c] &&
                                 isfinite(grid->high[c])),
                 fault, CDEM_USAGE, "the fields reach from %g to %g m in direction %d",
                 grid->low[c], grid->high[c], c);
  }
  CDEM_REQUIRE(s->dim == 3 || grid->count[2] == 1, fault, CDEM_USAGE,
               "%d layers of the fields of a plane model; it has one", grid->count[2]);
  CDEM_REQUIRE(s->grains + s->contacts < INT32_MAX / 2, fault, CDEM_INPUT,
               "%lld contacts are too many for coarse-grained fields", (long long)s->contacts);
  return CDEM_OK;
}

static cdem_status fields_init(const cdem_snapshot *s, const cdem_coarse_grid *grid, cdem_coarse *f,
                               cdem_fault *fault) {
  double diameter = 0.0;
  for (int64_t i = 0; i < s->grains; i++)
    diameter += 2.0 * s->radius[i] / (double)s->grains;
  f->width = grid->width > 0.0 ? grid->width : diameter > 0.0 ? 2.0 * diameter : 1.0;
  f->points = (int64_t)grid->count[0] * grid->count[1] * grid->count[2];
  double **array[] = {&f->xyz,    &f->density,    &f->momentum, &f->velocity,
                      &f->stress, &f->wall_force, &f->solid};
  static const int width[] = {3, 1, 3, 3, 9, 3, 1};
  for (int k = 0; k < 7; k++)
    CDEM_NEW(*array[k], width[k] * f->points, fault);
  for (int64_t p = 0; p < f->points; p++) {
    const int64_t at[3] = {p % grid->count[0], p / grid->count[0] % grid->count[1],
                           p / ((int64_t)grid->count[0] * grid->count[1])};
    for (int c = 0; c < s->dim; c++) {
      int intervals = grid->count[c] - 1;
      double part = intervals > 0 ? (double)at[c] / intervals : 0.5;
      f->xyz[3 * p + c] = (1.0 - part) * grid->low[c] + part * grid->high[c];
    }
  }
  return CDEM_OK;
}

cdem_status cdem_coarse_make(const cdem_snapshot *s, const cdem_coarse_grid *grid,
                             cdem_coarse *fields, cdem_fault *fault) {
  cdem_coarse made = {0};
  coarse c = {.s = s, .fields = &made};
  CDEM_TRY(check_grid(s, grid, fault));
  cdem_status status = fields_init(s, grid, &made, fault);
  c.width = made.width;
  c.factor = bump_factor(s, made.width);
  if (status == CDEM_OK)
    status = find_sources(&c, grid, fault);
  if (status == CDEM_OK) {
#pragma omp parallel for schedule(dynamic, 16) num_threads(cdem_snapshot_threads(s))
    for (int64_t p = 0; p < made.points; p++)
      gather(&c, p);
    *fields = made;
  } else
    cdem_coarse_release(&made);
  free(c.source);
  free(c.box);
  cdem_buckets_release(&c.buckets);
  return status;
}

cdem_status cdem_coarse_fields(const cdem_dem *dem, const cdem_coarse_grid *grid,
                               cdem_coarse *fields, cdem_fault *fault) {
  cdem_snapshot s;
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  cdem_status status = cdem_coarse_make(&s, grid, fields, fault);
  cdem_snapshot_release(&s);
  return status;
}

void cdem_coarse_release(cdem_coarse *fields) {
  double *array[] = {fields->xyz,    fields->density,    fields->momentum, fields->velocity,
                     fields->stress, fields->wall_force, fields->solid};
  for (int k = 0; k < 7; k++)
    free(array[k]);
  *fields = (cdem_coarse){0};
}
