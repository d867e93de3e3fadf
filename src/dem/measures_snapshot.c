/* What measures are taken of: a state copied out, its images, and buckets of places. */
#include "dem/measures_kernels.h"
#include "dem/store.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* ---- snapshot ---- */

static cdem_status look(const cdem_dem *dem, cdem_snapshot *s, cdem_fault *fault) {
  int64_t n = dem->grains;
  double *block;
  int32_t *touching;
  cdem_dem_contact *contact = NULL;
  CDEM_NEW(block, 19 * n, fault);
  s->xyz = block;
  CDEM_NEW(touching, n, fault);
  s->touching = touching;
  const cdem_dem_view view = {.xyz = block,
                              .velocity = block + 3 * n,
                              .displacement = block + 6 * n,
                              .rotation = block + 9 * n,
                              .spin = block + 12 * n,
                              .force = block + 15 * n,
                              .mass = block + 18 * n,
                              .contacts = touching};
  cdem_dem_look(dem, &view);
  s->velocity = view.velocity;
  s->displacement = view.displacement;
  s->rotation = view.rotation;
  s->spin = view.spin;
  s->force = view.force;
  s->mass = view.mass;
  CDEM_TRY(cdem_dem_contacts(dem, &s->contacts, &contact, fault));
  s->contact = contact;
  return CDEM_OK;
}

cdem_status cdem_snapshot_take(const cdem_dem *dem, cdem_snapshot *snapshot, cdem_fault *fault) {
  const cdem_dem_options *options = cdem_dem_options_of(dem);
  const cdem_cell *cell = cdem_dem_cell(dem);
  bool discs = dem->dim == 2;
  *snapshot =
      (cdem_snapshot){.dim = dem->dim,
                      .threads = options->threads,
                      .thickness = discs && options->thickness > 0.0 ? options->thickness : 1.0,
                      .time = dem->time,
                      .grains = dem->grains,
                      .radius = cdem_dem_radius(dem),
                      .cell = cell != NULL && cdem_cell_is_periodic(cell) ? cell : NULL};
  if (snapshot->cell != NULL)
    memcpy(snapshot->drift, dem->store->image_velocity, sizeof snapshot->drift);
  cdem_status status = look(dem, snapshot, fault);
  if (status != CDEM_OK)
    cdem_snapshot_release(snapshot);
  return status;
}

void cdem_snapshot_release(cdem_snapshot *snapshot) {
  free((void *)snapshot->xyz);
  free((void *)snapshot->touching);
  free((void *)snapshot->contact);
  *snapshot = (cdem_snapshot){0};
}

int cdem_snapshot_threads(const cdem_snapshot *snapshot) {
  return snapshot->threads > 0 ? snapshot->threads : omp_get_max_threads();
}

double cdem_grain_volume(const cdem_snapshot *s, double radius) {
  return cdem_grain_solid(s->dim, radius) * s->thickness;
}

void cdem_snapshot_box(const cdem_snapshot *s, double low[3], double high[3]) {
  for (int c = 0; c < 3; c++) {
    low[c] = high[c] = 0.0;
    for (int64_t i = 0; i < s->grains && c < s->dim; i++) {
      double a = s->xyz[3 * i + c] - s->radius[i], b = s->xyz[3 * i + c] + s->radius[i];
      low[c] = i == 0 || a < low[c] ? a : low[c];
      high[c] = i == 0 || b > high[c] ? b : high[c];
    }
  }
}

/* ---- copies ---- */

static cdem_status put_copy(cdem_copies *copies, const double place[3], int64_t id,
                            cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&copies->place, &copies->capacity[0], 3 * (copies->count + 1),
                     sizeof *copies->place, fault));
  CDEM_TRY(
      cdem_grow(&copies->id, &copies->capacity[1], copies->count + 1, sizeof *copies->id, fault));
  memcpy(copies->place + 3 * copies->count, place, 3 * sizeof *place);
  copies->id[copies->count++] = (int32_t)id;
  return CDEM_OK;
}

static cdem_status put_images(const cdem_snapshot *s, const double low[3], const double high[3],
                              double margin, cdem_copies *copies, cdem_fault *fault) {
  double shift[27][3] = {{0.0}};
  if (s->cell != NULL)
    cdem_cell_images(s->cell, shift);
  for (int image = 0; image < 27; image++) {
    if (image != CDEM_IMAGE_SELF && (s->cell == NULL || cdem_norm3(shift[image]) == 0.0 ||
                                     (image % 3 != 1 && !s->cell->periodic[0]) ||
                                     (image / 3 % 3 != 1 && !s->cell->periodic[1]) ||
                                     (image / 9 != 1 && !(s->dim == 3 && s->cell->periodic[2]))))
      continue;
    for (int64_t i = 0; i < s->grains; i++) {
      double place[3];
      bool near = true;
      for (int c = 0; c < 3; c++) {
        place[c] = s->xyz[3 * i + c] + (image == CDEM_IMAGE_SELF ? 0.0 : shift[image][c]);
        near &= c >= s->dim || (place[c] >= low[c] - margin && place[c] <= high[c] + margin);
      }
      if (near)
        CDEM_TRY(put_copy(copies, place, i, fault));
    }
  }
  return CDEM_OK;
}

cdem_status cdem_copies_make(const cdem_snapshot *s, const double low[3], const double high[3],
                             double margin, cdem_copies *copies, cdem_fault *fault) {
  *copies = (cdem_copies){0};
  cdem_status status = put_images(s, low, high, margin, copies, fault);
  if (status != CDEM_OK)
    cdem_copies_release(copies);
  return status;
}

void cdem_copies_release(cdem_copies *copies) {
  free(copies->place);
  free(copies->id);
  *copies = (cdem_copies){0};
}

/* ---- buckets ---- */

static int64_t bucket_along(const cdem_buckets *b, double place, int c) {
  if (b->count[c] == 1 || !(b->size[c] > 0.0))
    return 0;
  double at = floor((place - b->low[c]) / b->size[c] * (double)b->count[c]);
  return at < 0.0 ? 0 : at < (double)b->count[c] ? (int64_t)at : b->count[c] - 1;
}

/* Counts the things of each bucket, or (item) files them; starts move to their ends. */
static void file_things(const cdem_buckets *b, int64_t things, const double *box, int64_t *start,
                        int32_t *item) {
  for (int64_t t = 0; t < things; t++) {
    int64_t from[3], to[3];
    for (int c = 0; c < 3; c++) {
      from[c] = bucket_along(b, box[6 * t + c], c);
      to[c] = bucket_along(b, box[6 * t + 3 + c], c);
    }
    for (int64_t z = from[2]; z <= to[2]; z++)
      for (int64_t y = from[1]; y <= to[1]; y++)
        for (int64_t x = from[0]; x <= to[0]; x++) {
          int64_t at = (z * b->count[1] + y) * b->count[0] + x;
          if (item == NULL)
            start[at + 1]++;
          else
            item[start[at]++] = (int32_t)t;
        }
  }
}

static void size_buckets(int dim, int64_t things, const double *box, double size, cdem_buckets *b) {
  double most = dim == 2 ? sqrt(4.0 * (double)things + 1.0) : cbrt(4.0 * (double)things + 1.0);
  for (int c = 0; c < 3; c++) {
    double low = 0.0, high = 0.0;
    for (int64_t t = 0; t < things && c < dim; t++) {
      low = t == 0 || box[6 * t + c] < low ? box[6 * t + c] : low;
      high = t == 0 || box[6 * t + 3 + c] > high ? box[6 * t + 3 + c] : high;
    }
    b->low[c] = low;
    b->size[c] = high - low;
    double count = size > 0.0 && high > low ? ceil((high - low) / size) : 1.0;
    b->count[c] = (int64_t)fmax(1.0, fmin(count, 2.0 * most));
  }
}

cdem_status cdem_buckets_build(int dim, int64_t things, const double *box, double size,
                               cdem_buckets *buckets, cdem_fault *fault) {
  cdem_buckets b = {0};
  CDEM_REQUIRE(things < INT32_MAX, fault, CDEM_INPUT, "more than %d things to measure", INT32_MAX);
  size_buckets(dim, things, box, size, &b);
  int64_t all = b.count[0] * b.count[1] * b.count[2];
  CDEM_NEW(b.start, all + 1, fault);
  file_things(&b, things, box, b.start, NULL);
  for (int64_t i = 0; i < all; i++)
    b.start[i + 1] += b.start[i];
  b.item = cdem_allocate(b.start[all], sizeof *b.item, fault);
  if (b.item == NULL) {
    free(b.start);
    return CDEM_MEMORY;
  }
  file_things(&b, things, box, b.start, b.item);
  memmove(b.start + 1, b.start, (size_t)all * sizeof *b.start);
  b.start[0] = 0;
  *buckets = b;
  return CDEM_OK;
}

void cdem_buckets_release(cdem_buckets *buckets) {
  free(buckets->start);
  free(buckets->item);
  *buckets = (cdem_buckets){0};
}

int64_t cdem_buckets_find(const cdem_buckets *buckets, const double place[3]) {
  int64_t at[3];
  for (int c = 0; c < 3; c++) {
    double off = place[c] - buckets->low[c];
    if (buckets->count[c] > 1 && !(off >= 0.0 && off <= buckets->size[c]))
      return -1;
    at[c] = bucket_along(buckets, place[c], c);
  }
  return (at[2] * buckets->count[1] + at[1]) * buckets->count[0] + at[0];
}
