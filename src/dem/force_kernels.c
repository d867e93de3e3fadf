/* The loops over pairs: which touch, their geometry and motion side by side, and back to grains.
 *
 * Rows of four and eight doubles are moved whole and turned into lanes by the compiler's shuffles:
 * one load a grain instead of one a number. */
#include "dem/solver_store.h"

#include <math.h>

enum { BLOCK = 64, EIGHT = 8, AHEAD = 12 };

typedef double vec4 __attribute__((vector_size(32), may_alias));

/* From the place of A to that of B, and the sum of their radii. */
CDEM_ALWAYS_INLINE void between(const double *place, int64_t i, int64_t j, double row[4]) {
  const vec4 sign = {-1.0, -1.0, -1.0, 1.0};
  *(vec4 *)row = *(const vec4 *)(place + 4 * j) + sign * *(const vec4 *)(place + 4 * i);
}

CDEM_ALWAYS_INLINE int32_t test(const cdem_pair_kernel *kernel, bool images, int32_t count,
                                cdem_hit *hit) {
  const cdem_dem_store *s = kernel->store;
  const double *place = s->place;
  const int32_t *owner = kernel->core->pair_owner + kernel->first;
  const int32_t *other = s->pair_other + kernel->first;
  uint8_t *touch = s->pair_touch + kernel->first;
  const uint8_t *image = images ? s->pair_image + kernel->first : NULL;
  _Alignas(64) double row[BLOCK][4];
  uint32_t inside[BLOCK];
  int32_t hits = 0;
  for (int32_t b = 0; b < count; b += BLOCK) {
    int m = count - b < BLOCK ? count - b : BLOCK;
    for (int k = 0; k < m; k++) {
      if (b + k + AHEAD < count)
        __builtin_prefetch(place + 4 * (int64_t)other[b + k + AHEAD]);
      between(place, owner[b + k], other[b + k], row[k]);
      if (images)
        for (int c = 0; c < 3; c++)
          row[k][c] += s->image[image[b + k]][c];
    }
    for (int k = 0; k < m; k++) {
      double d2 = row[k][0] * row[k][0] + row[k][1] * row[k][1] + row[k][2] * row[k][2];
      inside[k] = d2 < row[k][3] * row[k][3];
    }
    for (int k = 0; k < m; k++) {
      uint32_t old = touch[b + k], in = inside[k] & (old < 2);
      hit[hits] = (cdem_hit)(b + k) << 1 | old;
      hits += (int32_t)in;
      touch[b + k] = (uint8_t)(in | (old & 2));
    }
  }
  return hits;
}

CDEM_MULTIVERSION int32_t cdem_pairs_test(const cdem_pair_kernel *kernel, int32_t count,
                                          cdem_hit *hit) {
  if (kernel->store->pair_image != NULL)
    return test(kernel, true, count, hit);
  return test(kernel, false, count, hit);
}

/* ---- lanes ---- */

/* Places, motions and histories of the pairs as rows; lanes past the last are harmless. */
CDEM_ALWAYS_INLINE void collect(int dim, const cdem_pair_kernel *kernel, bool images, int count,
                                const cdem_hit *hit, cdem_dem_work *w) {
  const cdem_dem_store *s = kernel->store;
  const int32_t *owner = kernel->core->pair_owner + kernel->first;
  const int32_t *other = s->pair_other + kernel->first;
  cdem_batch *lane = &w->batch;
  for (int k = 0; k < count; k++) {
    int64_t p = hit[k] >> 1, i = owner[p], j = other[p];
    if (k + AHEAD < count) {
      int64_t next = hit[k + AHEAD] >> 1;
      __builtin_prefetch(s->motion + 8 * (int64_t)other[next]);
      __builtin_prefetch(s->motion + 8 * (int64_t)owner[next]);
    }
    between(s->place, i, j, w->place[k]);
    w->radius_a[k] = s->place[4 * i + 3];
    if (dim == 2) { /* few numbers: one by one */
      const double *mi = s->motion + 8 * i, *mj = s->motion + 8 * j;
      lane->velocity[0][k] = mj[0] - mi[0];
      lane->velocity[1][k] = mj[1] - mi[1];
      lane->spin[0][k] = mj[5] - mi[5];
      lane->turning[0][k] = mi[5];
      lane->mass[k] = mi[6];
      lane->radius[k] = mj[6];
    } else {
      const cdem_vec8 mi = *(const cdem_vec8 *)(s->motion + 8 * i);
      *(cdem_vec8 *)w->row_a[k] = mi;
      *(cdem_vec8 *)w->row_b[k] = *(const cdem_vec8 *)(s->motion + 8 * j) - mi;
    }
    if (images) {
      const uint8_t code = s->pair_image[kernel->first + p];
      for (int c = 0; c < 3; c++) {
        w->place[k][c] += s->image[code][c];
        if (dim == 3)
          w->row_b[k][c] += s->image_velocity[code][c];
        else if (c < 2)
          lane->velocity[c][k] += s->image_velocity[code][c];
      }
    }
  }
  for (int k = count; k % EIGHT != 0; k++) {
    if (dim == 2) {
      lane->velocity[0][k] = lane->velocity[1][k] = lane->spin[0][k] = lane->turning[0][k] = 0.0;
      lane->mass[k] = lane->radius[k] = 2.0;
    } else {
      for (int c = 0; c < EIGHT; c++)
        w->row_a[k][c] = w->row_b[k][c] = 0.0;
      w->row_a[k][6] = 2.0;
    }
    w->place[k][0] = w->place[k][3] = w->radius_a[k] = 1.0;
    w->place[k][1] = w->place[k][2] = 0.0;
  }
}

/* Histories as lanes, zero where they are not in use yet. */
CDEM_ALWAYS_INLINE void histories(const cdem_pair_kernel *kernel, int numbers, int count,
                                  const cdem_hit *hit, cdem_batch *b) {
  const double *history = kernel->store->pair_history + kernel->first * numbers;
  for (int k = 0; k < count; k++) {
    const double *kept = history + (int64_t)(hit[k] >> 1) * numbers;
    b->fresh[k] = hit[k] & 1 ? 0.0 : 1.0;
    for (int h = 0; h < numbers; h++)
      b->history[h][k] = kept[h];
  }
  for (int k = count; k % EIGHT != 0; k++)
    b->fresh[k] = 1.0;
  for (int h = 0; h < numbers; h++)
    for (int k = 0; k < (count + EIGHT - 1) / EIGHT * EIGHT; k++)
      b->history[h][k] = b->fresh[k] > 0.0 ? 0.0 : b->history[h][k];
}

/* law.h: arms that meet at the contact point; everything from the rows. */
CDEM_ALWAYS_INLINE void lanes(int dim, bool uniform, bool by_radius, int padded, cdem_dem_work *w) {
  cdem_batch *restrict b = &w->batch;
  for (int k = 0; k < padded; k++) {
    double x = w->place[k][0], y = w->place[k][1], z = dim == 3 ? w->place[k][2] : 0.0;
    double sum = w->place[k][3], ra = w->radius_a[k];
    double length = sqrt(x * x + y * y + z * z), inverse = 1.0 / length;
    double each = uniform ? 0.5 * length : length / sum;
    double arm_a = uniform ? each : ra * each, arm_b = uniform ? each : (sum - ra) * each;
    double both = length;
    if (by_radius) {
      arm_a = ra;
      arm_b = sum - ra;
      both = sum;
    }
    b->n[0][k] = x * inverse;
    b->n[1][k] = y * inverse;
    if (dim == 3)
      b->n[2][k] = z * inverse;
    b->overlap[k] = sum - length;
    b->arm[0][k] = arm_a;
    b->arm[1][k] = arm_b;
    if (dim == 3) {
      double ma = w->row_a[k][6], mb = ma + w->row_b[k][6];
      b->mass[k] = uniform ? 0.5 * ma : ma * mb / (ma + mb);
      for (int c = 0; c < 3; c++) {
        b->velocity[c][k] = w->row_b[k][c];
        b->spin[c][k] = w->row_b[k][3 + c];
        b->turning[c][k] = both * w->row_a[k][3 + c] + arm_b * w->row_b[k][3 + c];
      }
    } else { /* collected here: spin of A, masses of A and B */
      double ma = b->mass[k], mb = b->radius[k];
      b->mass[k] = uniform ? 0.5 * ma : ma * mb / (ma + mb);
      b->turning[0][k] = both * b->turning[0][k] + arm_b * b->spin[0][k];
    }
    b->radius[k] = uniform ? 0.5 * ra : ra * (sum - ra) / sum;
  }
}

CDEM_ALWAYS_INLINE void fill(int dim, const cdem_pair_kernel *kernel, int count,
                             const cdem_hit *hit, cdem_dem_work *w) {
  const cdem_dem_store *s = kernel->store;
  cdem_batch *b = &w->batch;
  int padded = (count + EIGHT - 1) / EIGHT * EIGHT;
  b->count = count;
  b->step = kernel->step;
  if (s->pair_image != NULL)
    collect(dim, kernel, true, count, hit, w);
  else
    collect(dim, kernel, false, count, hit, w);
  if (kernel->arms_by_radius)
    lanes(dim, false, true, padded, w);
  else if (kernel->core->uniform)
    lanes(dim, true, false, padded, w);
  else
    lanes(dim, false, false, padded, w);
  switch (s->histories) {
  case 1:
    histories(kernel, 1, count, hit, b);
    break;
  case 3:
    histories(kernel, 3, count, hit, b);
    break;
  default:
    histories(kernel, s->histories, count, hit, b);
  }
  if (s->options.law->labels)
    for (int k = 0; k < count; k++) {
      int64_t p = kernel->first + (hit[k] >> 1);
      b->label[k] = s->id[kernel->core->pair_owner[p]] < s->id[s->pair_other[p]] ? 1.0 : -1.0;
    }
}

CDEM_MULTIVERSION void cdem_pairs_fill(const cdem_pair_kernel *kernel, int count,
                                       const cdem_hit *hit, cdem_dem_work *work) {
  if (kernel->store->dim == 2)
    fill(2, kernel, count, hit, work);
  else
    fill(3, kernel, count, hit, work);
}

void cdem_pairs_gain(const cdem_pair_kernel *kernel, int count, const cdem_hit *hit,
                     cdem_dem_work *work) {
  const cdem_dem_store *s = kernel->store;
  cdem_batch *b = &work->batch;
  bool solid = s->dim == 3;
  for (int k = 0; k < count; k++) {
    int64_t p = kernel->first + (hit[k] >> 1);
    const double *gi = kernel->core->gain + 8 * (int64_t)kernel->core->pair_owner[p];
    const double *gj = kernel->core->gain + 8 * (int64_t)s->pair_other[p];
    for (int c = 0; c < s->dim; c++)
      b->velocity_gain[c][k] = gj[c] - gi[c];
    for (int c = 0; c < (solid ? 3 : 1); c++) {
      int at = solid ? 3 + c : 5;
      b->spin_gain[c][k] = gj[at] - gi[at];
      b->turning_gain[c][k] = b->arm[0][k] * gi[at] + b->arm[1][k] * gj[at];
    }
  }
}

/* ---- back to the grains ---- */

/* Force on A, moments on A and on B. */
CDEM_ALWAYS_INLINE void turn(int dim, int padded, cdem_dem_work *restrict w) {
  const cdem_batch *restrict b = &w->batch;
  for (int k = 0; k < padded; k++) {
    double nx = b->n[0][k], ny = b->n[1][k], push = b->normal[k];
    double aa = b->arm[0][k], ab = b->arm[1][k];
    double f[3] = {0}, c[3] = {0}, m[3] = {0};
    if (dim == 3) {
      double nz = b->n[2][k];
      double tx = b->shear[0][k], ty = b->shear[1][k], tz = b->shear[2][k];
      f[0] = tx - push * nx;
      f[1] = ty - push * ny;
      f[2] = tz - push * nz;
      c[0] = ny * tz - nz * ty;
      c[1] = nz * tx - nx * tz;
      c[2] = nx * ty - ny * tx;
      for (int i = 0; i < 3; i++)
        m[i] = b->moment[i][k];
    } else {
      double t = b->shear[0][k];
      f[0] = -push * nx - t * ny;
      f[1] = t * nx - push * ny;
      c[2] = t;
      m[2] = b->moment[0][k];
    }
    for (int i = 0; i < 3; i++) {
      w->force[i][k] = f[i];
      w->on_a[i][k] = aa * c[i] + m[i];
      w->on_b[i][k] = ab * c[i] - m[i];
    }
  }
}

/* As rows of the contacts. */
CDEM_MULTIVERSION void cdem_pairs_rows(int dim, cdem_dem_work *work) {
  int padded = (work->batch.count + EIGHT - 1) / EIGHT * EIGHT;
  if (dim == 2)
    turn(2, padded, work);
  else
    turn(3, padded, work);
  for (int k = 0; k < padded; k++)
    for (int c = 0; c < 3; c++) {
      work->row_a[k][c] = work->force[c][k];
      work->row_a[k][3 + c] = work->on_a[c][k];
      work->row_b[k][c] = -work->force[c][k];
      work->row_b[k][3 + c] = work->on_b[c][k];
    }
}

/* Number by number: rows would have to be turned first, for a few per cent in 3-D only. */
CDEM_ALWAYS_INLINE void scatter(int dim, const cdem_pair_kernel *kernel, int numbers, int count,
                                const cdem_hit *hit, cdem_dem_work *w) {
  const cdem_dem_store *s = kernel->store;
  const int32_t *owner = kernel->core->pair_owner + kernel->first;
  const int32_t *target = kernel->core->pair_target + kernel->first;
  double *history = s->pair_history + kernel->first * numbers;
  turn(dim, (count + EIGHT - 1) / EIGHT * EIGHT, w);
  for (int k = 0; k < count; k++) {
    int64_t p = hit[k] >> 1, t = target[p];
    double *a = s->force + 8 * (int64_t)owner[p];
    double *b = t >= 0 ? s->force + 8 * t : kernel->core->far + 8 * (-1 - t);
    if (k + AHEAD < count) {
      int64_t next = target[hit[k + AHEAD] >> 1];
      __builtin_prefetch(next >= 0 ? s->force + 8 * next : kernel->core->far + 8 * (-1 - next), 1);
    }
    for (int c = 0; c < dim; c++) {
      a[c] += w->force[c][k];
      b[c] -= w->force[c][k];
    }
    for (int c = dim == 3 ? 0 : 2; c < 3; c++) {
      a[3 + c] += w->on_a[c][k];
      b[3 + c] += w->on_b[c][k];
    }
    for (int h = 0; h < numbers; h++)
      history[p * numbers + h] = w->batch.history[h][k];
  }
}

CDEM_MULTIVERSION void cdem_pairs_scatter(const cdem_pair_kernel *kernel, int count,
                                          const cdem_hit *hit, cdem_dem_work *work) {
  int dim = kernel->store->dim, numbers = kernel->store->histories;
  if (dim == 2 && numbers == 1)
    scatter(2, kernel, 1, count, hit, work);
  else if (dim == 2)
    scatter(2, kernel, numbers, count, hit, work);
  else if (numbers == 3)
    scatter(3, kernel, 3, count, hit, work);
  else
    scatter(3, kernel, numbers, count, hit, work);
}
