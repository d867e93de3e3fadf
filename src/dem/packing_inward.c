/* Inward packing of discs, after Bagi (2005, Granular Matter 7, 31-43): first along the sides of
 * the box, then layer by layer inwards, each new disc touching two things that are there.
 *
 * Where the front of the source is a closed chain of discs that must be cut where it meets itself,
 * here every disc asks in turn, in the order of placing, for places that touch it and something
 * else, until it has none left: it is then enclosed. The order of placing makes this a front that
 * moves inwards, and it can neither tangle nor leave a hole behind.
 *
 * Sizes: radii wait in a short queue that the size law refills. A place takes the oldest one that
 * fits. So every drawn radius is used but for the last queue, and the law comes out to
 * (length of the queue)/(number of discs) whatever fitted where.
 */
#include "dem/packing.h"
#include "dem/packing_grid.h"

#include <stdlib.h>
#include <string.h>

/* Rounding that a third disc may be overlapped by, in radii: enough for equal discs to close a
 * hexagon. */
#define SLACK 0x1p-36

enum { QUEUE = 48, QUEUE_SHARE = 200, REPORT = 1024 };

typedef struct {
  const cdem_packing_options *options;
  cdem_grains *grains;
  cdem_packing_grid grid;
  cdem_packing_list near; /* of the disc that asks, itself left out */
  cdem_random random;
  int queued;
  double queue[QUEUE];
  double *failed; /* [room] of each disc: the smallest radius that found no place at it */
  int64_t room;
  bool along_sides; /* only places that touch a side */
  int64_t expected;
} front;

typedef struct {
  double x, y;
  double depth; /* distance of the place from the nearest side */
} spot;

/* ---- places ---- */

/* Takes the place when it is free and less deep than what was found so far. skip: the neighbour it
 * touches by construction, -1: none. */
static void consider(const front *f, const spot *at, double radius, int64_t skip, spot *best) {
  if (!(at->depth < best->depth))
    return;
  for (int64_t k = 0; k < f->near.count; k++) {
    const cdem_packing_near *other = &f->near.near[k];
    double x = other->place[0] - at->x, y = other->place[1] - at->y;
    double touch = (other->radius + radius) * (1.0 - SLACK);
    if (k != skip && x * x + y * y < touch * touch)
      return;
  }
  *best = *at;
}

/* Depth; negative slack outside. */
static bool inside(const front *f, double radius, spot *at) {
  const double *low = f->options->low, *high = f->options->high;
  double sides = fmin(fmin(at->x - low[0], high[0] - at->x), fmin(at->y - low[1], high[1] - at->y));
  at->depth = sides;
  return sides >= radius;
}

/* Places touching the disc and a side; the coordinate on the side is exact. */
static void beside(const front *f, const double center[2], double own, double radius, spot *best) {
  for (int side = 0; side < 4; side++) {
    int c = side / 2, other = 1 - c;
    const double *low = f->options->low, *high = f->options->high;
    double on = side % 2 == 0 ? low[c] + radius : high[c] - radius;
    double way = on - center[c], arm = own + radius;
    if (!(fabs(way) < arm))
      continue;
    double half = sqrt((arm - way) * (arm + way));
    for (int sign = -1; sign <= 1; sign += 2) {
      double place[2];
      place[c] = on;
      place[other] = center[other] + sign * half;
      spot at = {place[0], place[1], radius};
      if (place[other] - low[other] >= radius && high[other] - place[other] >= radius)
        consider(f, &at, radius, -1, best);
    }
  }
}

/* Places touching two discs: from the first, `along` the line of centres and `off` it. */
static void between(const front *f, const double center[2], double own, int64_t k, double radius,
                    spot *best) {
  const cdem_packing_near *other = &f->near.near[k];
  double x = other->place[0] - center[0], y = other->place[1] - center[1];
  double square = x * x + y * y, distance;
  double a = own + radius, b = other->radius + radius;
  if (!(square < (a + b) * (a + b)))
    return;
  distance = sqrt(square);
  double along = 0.5 * (square + (a - b) * (a + b)) / distance;
  double off = (a - along) * (a + along);
  if (!(off > 0.0))
    return;
  off = sqrt(off);
  for (int sign = -1; sign <= 1; sign += 2) {
    spot at = {center[0] + (along * x - sign * off * y) / distance,
               center[1] + (along * y + sign * off * x) / distance, 0.0};
    if (inside(f, radius, &at))
      consider(f, &at, radius, k, best);
  }
}

static bool find(const front *f, const double center[2], double own, double radius, spot *best) {
  *best = (spot){.depth = INFINITY};
  beside(f, center, own, radius, best);
  if (!f->along_sides)
    for (int64_t k = 0; k < f->near.count; k++)
      between(f, center, own, k, radius, best);
  return best->depth < INFINITY;
}

/* ---- the queue ---- */

static void refill(front *f) {
  /* Long queues close gaps better; short packings keep to their size law. */
  int64_t wanted = f->expected / QUEUE_SHARE;
  int most = wanted < 1 ? 1 : wanted < QUEUE ? (int)wanted : QUEUE;
  while (f->queued < most)
    f->queue[f->queued++] = cdem_sizes_draw(f->options->dim, &f->options->sizes, &f->random);
}

static void take(front *f, int at) {
  memmove(f->queue + at, f->queue + at + 1, (size_t)(--f->queued - at) * sizeof *f->queue);
  refill(f);
}

static cdem_status place(front *f, const spot *at, double radius, cdem_fault *fault) {
  const double xyz[3] = {at->x, at->y, 0.0};
  CDEM_TRY(cdem_grains_add(f->grains, xyz, radius, fault));
  CDEM_TRY(cdem_grow(&f->failed, &f->room, f->grains->grains, sizeof *f->failed, fault));
  f->failed[f->grains->grains - 1] = INFINITY;
  return cdem_packing_grid_add(&f->grid, f->grains->grains - 1, fault);
}

/* ---- the front ---- */

static cdem_status neighbours(front *f, int64_t disc, const double center[3], double reach,
                              cdem_fault *fault) {
  CDEM_TRY(cdem_packing_grid_near(&f->grid, center, reach, &f->near, fault));
  for (int64_t k = 0; k < f->near.count; k++)
    if (f->near.near[k].grain == (int32_t)disc)
      f->near.near[k--] = f->near.near[--f->near.count];
  return CDEM_OK;
}

/* Surrounds a disc until nothing in the queue finds a place at it. Whatever is larger than a radius
 * that failed fails too: shrunk where it touches the disc, and rolled about it until it meets
 * something, it would have been a place. And what failed once fails for ever. */
static cdem_status enclose(front *f, int64_t disc, cdem_fault *fault) {
  const double center[3] = {f->grains->xyz[3 * disc], f->grains->xyz[3 * disc + 1], 0.0};
  double own = f->grains->radius[disc], reach = own + 2.0 * cdem_sizes_largest(&f->options->sizes);
  double failed = f->failed[disc];
  bool asked = false;
  for (int at = 0; at < f->queued; at++) {
    double radius = f->queue[at];
    spot best;
    if (!(radius < failed))
      continue;
    if (!asked)
      CDEM_TRY(neighbours(f, disc, center, reach, fault));
    asked = true;
    if (!find(f, center, own, radius, &best)) {
      failed = radius;
      continue;
    }
    CDEM_TRY(place(f, &best, radius, fault));
    CDEM_TRY(cdem_grow(&f->near.near, &f->near.capacity, f->near.count + 1, sizeof *f->near.near,
                       fault));
    f->near.near[f->near.count++] =
        (cdem_packing_near){{best.x, best.y, 0.0}, radius, (int32_t)(f->grains->grains - 1)};
    take(f, at--);
  }
  f->failed[disc] = failed;
  return CDEM_OK;
}

static cdem_status sweep(front *f, cdem_fault *fault) {
  for (int64_t i = 0; i < f->grains->grains; i++) {
    if (i % REPORT == 0)
      CDEM_TRY(cdem_progress_report(f->options->progress, "packing inwards", i,
                                    f->expected > i ? f->expected : 0, fault));
    CDEM_TRY(enclose(f, i, fault));
  }
  return CDEM_OK;
}

static cdem_status pack(front *f, cdem_fault *fault) {
  refill(f);
  double radius = f->queue[0];
  const spot corner = {f->options->low[0] + radius, f->options->low[1] + radius, radius};
  CDEM_TRY(place(f, &corner, radius, fault));
  take(f, 0);
  f->along_sides = true;
  CDEM_TRY(sweep(f, fault));
  f->along_sides = false;
  for (int64_t i = 0; i < f->grains->grains; i++)
    f->failed[i] = INFINITY;
  /* What the queue could not fill the first time, it may later: until a sweep places nothing. */
  for (int64_t before = -1; before < f->grains->grains;) {
    before = f->grains->grains;
    CDEM_TRY(sweep(f, fault));
  }
  return CDEM_OK;
}

static cdem_status make(const cdem_packing_options *options, cdem_grains *grains,
                        cdem_fault *fault) {
  const cdem_sizes *sizes = &options->sizes;
  const double bounds[2] = {cdem_sizes_smallest(sizes), cdem_sizes_largest(sizes)};
  const bool periodic[3] = {false};
  front f = {.options = options, .grains = grains, .random = {options->seed}};
  f.expected = (int64_t)(0.82 * cdem_packing_room(options) / cdem_sizes_mean_solid(2, sizes));
  CDEM_TRY(cdem_packing_grid_init(&f.grid, grains, options->low, options->high, periodic, bounds,
                                  f.expected, fault));
  cdem_status status = pack(&f, fault);
  cdem_packing_grid_release(&f.grid);
  free(f.near.near);
  free(f.failed);
  return status;
}

const cdem_packing cdem_packing_inward = {
    .name = "inward",
    .help = "random and dense, from the boundary inwards, each disc touching two (Bagi 2005)",
    .dims = {[2] = true},
    .make = make,
};
