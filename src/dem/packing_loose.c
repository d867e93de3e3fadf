/* Loose packings: random places without contacts.
 *
 * Largest grains first, each at the first of some random places that is free (random sequential
 * addition). This alone slows down without bound towards its limit (0.38 of the room for equal
 * spheres, 0.55 for equal discs), so a grain that finds no place is put at a random one and whoever
 * overlaps is pushed apart, pair after pair, until nobody does. Ids are in the order of drawing, so
 * that they know nothing of sizes. */
#include "dem/packing.h"
#include "dem/packing_grid.h"

#include <stdlib.h>
#include <string.h>

/* Pairs are pushed this far beyond touching, in sums of radii. */
#define MARGIN 0x1p-10

enum { TRIES = 24, PUSHES = 200, REPORT = 4096, SLABS = 64 };

typedef struct {
  const cdem_packing_options *options;
  cdem_grains *grains;
  cdem_packing_grid grid;
  cdem_packing_list near;
  cdem_random random;
  int64_t *order; /* [grains] largest first; then those waiting to be looked at, as a ring */
  uint8_t *waits; /* [grains] in the ring */
  int64_t from, waiting;
  int64_t left; /* grains that found no place of their own */
  double left_solid;
} loose;

/* ---- how many of which sizes ---- */

/* As many of each class of a table as its share says, in random order: a few large grains more or
 * less would change how much solid there is. */
static cdem_status deal(loose *l, cdem_fault *fault) {
  const cdem_packing_options *o = l->options;
  const double nowhere[3] = {0};
  for (int64_t i = 0; i < o->count; i++) {
    double share = ((double)i + 0.5) / (double)o->count;
    double radius = cdem_sizes_quantile(o->dim, &o->sizes, share);
    CDEM_TRY(cdem_grains_add(l->grains, nowhere, radius, fault));
  }
  double *radius = l->grains->radius;
  for (int64_t i = o->count - 1; i > 0; i--) {
    int64_t j = (int64_t)(cdem_random_uniform(&l->random, 0.0, 1.0) * (double)(i + 1));
    double other = radius[j];
    radius[j] = radius[i];
    radius[i] = other;
  }
  return CDEM_OK;
}

static cdem_status draw(loose *l, cdem_fault *fault) {
  const cdem_packing_options *o = l->options;
  const double nowhere[3] = {0};
  double wanted = o->fraction * cdem_packing_room(o), sum = 0.0;
  double mean = cdem_sizes_mean_solid(o->dim, &o->sizes);
  CDEM_REQUIRE(o->count > 0 || wanted / mean < INT32_MAX, fault, CDEM_INPUT,
               "a solid fraction of %g means about %.3g grains; at most %d can be had", o->fraction,
               wanted / mean, INT32_MAX - 1);
  if (o->count > 0 && o->sizes.kind == CDEM_SIZES_TABLE)
    return deal(l, fault);
  for (int64_t i = 0; o->count == 0 || i < o->count; i++) {
    double radius = cdem_sizes_draw(o->dim, &o->sizes, &l->random);
    double solid = cdem_grain_solid(o->dim, radius);
    /* The last one only where it brings the sum nearer. */
    if (o->count == 0 && sum + 0.5 * solid > wanted)
      break;
    sum += solid;
    CDEM_TRY(cdem_grains_add(l->grains, nowhere, radius, fault));
  }
  CDEM_REQUIRE(l->grains->grains > 0, fault, CDEM_INPUT,
               "a solid fraction of %g of this box is less than half a grain of radius %g m",
               o->fraction, cdem_sizes_largest(&o->sizes));
  return CDEM_OK;
}

typedef struct {
  double radius;
  int64_t grain;
} sized;

static int by_size(const void *a, const void *b) {
  const sized *x = a, *y = b;
  if (x->radius != y->radius)
    return x->radius > y->radius ? -1 : 1;
  return (x->grain > y->grain) - (x->grain < y->grain);
}

static cdem_status sort(loose *l, cdem_fault *fault) {
  int64_t n = l->grains->grains;
  sized *list;
  CDEM_NEW(list, n, fault);
  for (int64_t i = 0; i < n; i++)
    list[i] = (sized){l->grains->radius[i], i};
  qsort(list, (size_t)n, sizeof *list, by_size);
  for (int64_t i = 0; i < n; i++)
    l->order[i] = list[i].grain;
  free(list);
  return CDEM_OK;
}

/* ---- places ---- */

/* Distance from the axis of the tube and how far a grain may be from it. */
static double from_axis(const cdem_packing_options *o, const double place[3], double radius,
                        double way[2], double *most) {
  for (int c = 0; c < 2; c++)
    way[c] = place[c] - 0.5 * (o->low[c] + o->high[c]);
  *most = 0.5 * fmin(o->high[0] - o->low[0], o->high[1] - o->low[1]) - radius;
  return sqrt(way[0] * way[0] + way[1] * way[1]);
}

/* In a tube first somewhere in the square about the circle that its centre may be in, which is a
 * point where the grain just fits. */
static void random_place(loose *l, double radius, double place[3]) {
  const cdem_packing_options *o = l->options;
  double way[2], most = 0.0;
  place[0] = place[1] = place[2] = 0.0;
  if (o->cylinder)
    from_axis(o, place, radius, way, &most);
  do
    for (int c = 0; c < o->dim; c++) {
      double margin = o->periodic[c] ? 0.0 : radius, middle = 0.5 * (o->low[c] + o->high[c]);
      bool round = o->cylinder && c < 2;
      place[c] = cdem_random_uniform(&l->random, round ? middle - most : o->low[c] + margin,
                                     round ? middle + most : o->high[c] - margin);
    }
  while (o->cylinder && from_axis(o, place, radius, way, &most) > most);
}

/* Back into the box or tube, or through a periodic face. */
static void confine(const cdem_packing_options *o, double radius, double place[3]) {
  for (int c = 0; c < o->dim; c++) {
    double length = o->high[c] - o->low[c];
    if (!o->periodic[c])
      place[c] = fmin(fmax(place[c], o->low[c] + radius), o->high[c] - radius);
    else if (place[c] < o->low[c])
      place[c] += length;
    else if (place[c] >= o->high[c])
      place[c] -= length;
  }
  double way[2], most;
  if (!o->cylinder)
    return;
  double distance = from_axis(o, place, radius, way, &most);
  if (distance > most)
    for (int c = 0; c < 2; c++)
      place[c] += way[c] * (most / distance - 1.0);
}

static void wait_in_line(loose *l, int64_t grain) {
  if (l->waits[grain])
    return;
  l->waits[grain] = 1;
  l->order[(l->from + l->waiting++) % l->grains->grains] = grain;
}

/* Those that found no place wait in the order of places, not of ids: neighbours one after another.
 */
static cdem_status line_up(loose *l, cdem_fault *fault) {
  const cdem_packing_options *o = l->options;
  int last = o->dim - 1;
  sized *list;
  int64_t count = 0;
  CDEM_NEW(list, l->left, fault);
  for (int64_t i = 0; i < l->grains->grains; i++)
    if (l->waits[i]) {
      const double *place = l->grains->xyz + 3 * i;
      double length = o->high[last] - o->low[last];
      double slab = floor((place[last] - o->low[last]) / length * SLABS);
      double along = (place[0] - o->low[0]) / (o->high[0] - o->low[0]);
      list[count++] = (sized){-slab - along, i};
      l->waits[i] = 0;
    }
  qsort(list, (size_t)count, sizeof *list, by_size);
  for (int64_t k = 0; k < count; k++)
    wait_in_line(l, list[k].grain);
  free(list);
  return CDEM_OK;
}

static cdem_status throw_in(loose *l, cdem_fault *fault) {
  int64_t n = l->grains->grains;
  for (int64_t k = 0; k < n; k++) {
    if (k % REPORT == 0)
      CDEM_TRY(cdem_progress_report(l->options->progress, "placing grains", k, n, fault));
    int64_t i = l->order[k];
    double radius = l->grains->radius[i], *place = l->grains->xyz + 3 * i;
    bool found = false;
    for (int t = 0; t < TRIES && !found; t++) {
      random_place(l, radius, place);
      found = cdem_packing_grid_is_free(&l->grid, place, radius);
    }
    CDEM_TRY(cdem_packing_grid_add(&l->grid, i, fault));
    if (!found) {
      l->left++;
      l->left_solid += cdem_grain_solid(l->options->dim, radius);
      l->waits[i] = 1;
    }
  }
  return line_up(l, fault);
}

/* ---- pushing apart ---- */

static cdem_status shift(loose *l, int64_t grain, const double way[3], cdem_fault *fault) {
  double *place = l->grains->xyz + 3 * grain;
  cdem_packing_grid_remove(&l->grid, grain);
  for (int c = 0; c < l->options->dim; c++)
    place[c] += way[c];
  confine(l->options, l->grains->radius[grain], place);
  wait_in_line(l, grain);
  return cdem_packing_grid_add(&l->grid, grain, fault);
}

/* Direction of a pair, drawn where the centres meet. */
static double direction(loose *l, const double from[3], const double to[3], double n[3]) {
  double distance;
  for (int c = 0; c < 3; c++)
    n[c] = to[c] - from[c];
  distance = cdem_norm3(n);
  if (distance > 0.0) {
    for (int c = 0; c < 3; c++)
      n[c] /= distance;
    return distance;
  }
  double size;
  do {
    for (int c = 0; c < l->options->dim; c++)
      n[c] = cdem_random_uniform(&l->random, -1.0, 1.0);
    size = cdem_norm3(n);
  } while (!(size > 0.1 && size <= 1.0));
  for (int c = 0; c < 3; c++)
    n[c] /= size;
  return 0.0;
}

/* The smaller grain of a pair goes the longer way. */
static cdem_status push(loose *l, int64_t i, cdem_fault *fault) {
  double place[3], radius = l->grains->radius[i], own[3] = {0};
  memcpy(place, l->grains->xyz + 3 * i, sizeof place);
  CDEM_TRY(cdem_packing_grid_near(&l->grid, place, radius, &l->near, fault));
  bool moved = false;
  for (int64_t k = 0; k < l->near.count; k++) {
    const cdem_packing_near *other = &l->near.near[k];
    if (other->grain == (int32_t)i)
      continue;
    double n[3], theirs[3], touch = radius + other->radius;
    double distance = direction(l, place, other->place, n);
    double apart = touch * (1.0 + MARGIN) - distance, share = other->radius / touch;
    for (int c = 0; c < 3; c++) {
      own[c] -= n[c] * apart * share;
      theirs[c] = n[c] * apart * (1.0 - share);
    }
    CDEM_TRY(shift(l, other->grain, theirs, fault));
    moved = true;
  }
  return moved ? shift(l, i, own, fault) : CDEM_OK;
}

static cdem_status push_apart(loose *l, cdem_fault *fault) {
  int64_t n = l->grains->grains, most = PUSHES * n + REPORT;
  for (int64_t pushes = 0; l->waiting > 0; pushes++) {
    if (pushes % REPORT == 0)
      CDEM_TRY(
          cdem_progress_report(l->options->progress, "pushing grains apart", pushes, 0, fault));
    CDEM_REQUIRE(pushes < most, fault, CDEM_NUMERIC,
                 "no room for %lld grains: %lld found a place without overlap, a solid fraction of "
                 "%.4f of the %.4f wanted; take fewer, or compact a looser packing",
                 (long long)n, (long long)(n - l->left),
                 (cdem_grains_solid(l->grains) - l->left_solid) / cdem_packing_room(l->options),
                 cdem_grains_solid(l->grains) / cdem_packing_room(l->options));
    int64_t i = l->order[l->from];
    l->from = (l->from + 1) % n;
    l->waiting--;
    l->waits[i] = 0;
    CDEM_TRY(push(l, i, fault));
  }
  return CDEM_OK;
}

static cdem_status pack(loose *l, cdem_fault *fault) {
  const cdem_packing_options *o = l->options;
  const double sizes[2] = {cdem_sizes_smallest(&o->sizes), cdem_sizes_largest(&o->sizes)};
  CDEM_TRY(draw(l, fault));
  CDEM_NEW(l->order, l->grains->grains, fault);
  CDEM_NEW(l->waits, l->grains->grains, fault);
  CDEM_TRY(sort(l, fault));
  CDEM_TRY(cdem_packing_grid_init(&l->grid, l->grains, o->low, o->high, o->periodic, sizes,
                                  l->grains->grains, fault));
  CDEM_TRY(throw_in(l, fault));
  return push_apart(l, fault);
}

static cdem_status make(const cdem_packing_options *options, cdem_grains *grains,
                        cdem_fault *fault) {
  loose l = {.options = options, .grains = grains, .random = {options->seed}};
  cdem_status status = pack(&l, fault);
  cdem_packing_grid_release(&l.grid);
  free(l.near.near);
  free(l.order);
  free(l.waits);
  return status;
}

const cdem_packing cdem_packing_loose = {
    .name = "loose",
    .help = "random, without contacts, to a count or a solid fraction; box, cylinder, periodic",
    .dims = {[2] = true, [3] = true},
    .loose = true,
    .make = make,
};
