/* The free surface: vertical rays through bins of a profile, and lines fitted to its flanks. */
#include "dem/surface.h"

#include "dem/measures_kernels.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  const cdem_snapshot *s;
  cdem_surface_options o;
  double across[3];
  double low, high, side_low, side_high;
  int bins, depth;
  double *top; /* [bins][depth]; NaN */
} scan;

/* ---- set-up ---- */

static cdem_status unit(double v[3], int axis, const char *what, cdem_fault *fault) {
  double length = cdem_norm3(v);
  if (length == 0.0)
    v[axis] = length = 1.0;
  CDEM_REQUIRE(isfinite(length), fault, CDEM_USAGE, "the direction '%s' of a surface is not finite",
               what);
  for (int c = 0; c < 3; c++)
    v[c] /= length;
  return CDEM_OK;
}

static cdem_status directions(scan *n, cdem_fault *fault) {
  CDEM_TRY(unit(n->o.up, n->s->dim - 1, "up", fault));
  CDEM_TRY(unit(n->o.along, 0, "along", fault));
  double tilt = cdem_dot3(n->o.up, n->o.along);
  CDEM_REQUIRE(
      fabs(tilt) <= 1e-6 || n->o.kind == CDEM_SURFACE_CONE, fault, CDEM_USAGE,
      "a profile of a surface runs across its upward direction; the cosine between them is "
      "%g",
      tilt);
  if (n->o.kind == CDEM_SURFACE_CONE) { /* any direction across */
    int least = 0;
    for (int c = 1; c < 3; c++)
      least = fabs(n->o.up[c]) < fabs(n->o.up[least]) ? c : least;
    for (int c = 0; c < 3; c++)
      n->o.along[c] = (c == least ? 1.0 : 0.0) - n->o.up[least] * n->o.up[c];
    CDEM_TRY(unit(n->o.along, 0, "along", fault));
  }
  cdem_cross3(n->o.up, n->o.along, n->across);
  return CDEM_OK;
}

/* Where a grain is in the picture: along, across, height; a cone: radius, azimuth, height. */
static void place_of(const scan *n, int64_t i, double at[3]) {
  double d[3];
  for (int c = 0; c < 3; c++)
    d[c] = n->s->xyz[3 * i + c] - n->o.origin[c];
  at[0] = cdem_dot3(d, n->o.along);
  at[1] = cdem_dot3(d, n->across);
  at[2] = cdem_dot3(d, n->o.up);
}

static void find_range(scan *n) {
  double radius = 0.0, low[2] = {0.0, 0.0}, high[2] = {0.0, 0.0};
  for (int64_t i = 0; i < n->s->grains; i++) {
    double at[3], r = n->s->radius[i];
    place_of(n, i, at);
    if (n->o.kind == CDEM_SURFACE_CONE)
      at[0] = sqrt(at[0] * at[0] + at[1] * at[1]);
    for (int c = 0; c < 2; c++) {
      low[c] = i == 0 ? at[c] - r : fmin(low[c], at[c] - r);
      high[c] = i == 0 ? at[c] + r : fmax(high[c], at[c] + r);
    }
    radius += r / (double)n->s->grains;
  }
  bool cone = n->o.kind == CDEM_SURFACE_CONE, given = n->o.low < n->o.high;
  n->low = given ? n->o.low : cone ? 0.0 : low[0];
  n->high = given ? n->o.high : high[0];
  given = n->o.side_low < n->o.side_high;
  n->side_low = given ? n->o.side_low : low[1];
  n->side_high = given ? n->o.side_high : high[1];
  double bins = radius > 0.0 ? ceil(0.5 * (n->high - n->low) / radius) : 1.0;
  double depth = radius > 0.0 ? ceil(0.5 * (n->side_high - n->side_low) / radius) : 1.0;
  n->bins = n->o.bins > 0 ? n->o.bins : (int)fmax(1.0, fmin(bins, 4096.0));
  n->depth = n->o.depth > 0 ? n->o.depth : cone ? 32 : (int)fmax(1.0, fmin(depth, 1024.0));
  n->depth = n->s->dim == 2 ? 1 : n->depth;
}

/* ---- rays ---- */

static double bin_place(const scan *n, int bin) {
  return n->low + (bin + 0.5) * (n->high - n->low) / n->bins;
}

/* Where a ray stands, along and across. Several rays go through a bin, so that the highest of them
 * does not fall through a gap between two grains. */
enum { RAYS = 4 };
static void ray_place(const scan *n, int bin, int sub, int k, double at[2]) {
  const double pi = 3.14159265358979323846;
  double place = bin_place(n, bin) + ((sub + 0.5) / RAYS - 0.5) * (n->high - n->low) / n->bins;
  if (n->o.kind == CDEM_SURFACE_CONE) {
    double angle = 2.0 * pi * (k + 0.5) / n->depth;
    at[0] = place * cos(angle);
    at[1] = place * sin(angle);
  } else {
    at[0] = place;
    at[1] = n->side_low + (k + 0.5) * (n->side_high - n->side_low) / n->depth;
  }
}

static int clamp_bin(double at, int count) {
  return at < 0.0 ? 0 : at < count ? (int)at : count - 1;
}

static void meet_grain(const scan *n, int64_t i) {
  double at[3], r = n->s->radius[i], width = (n->high - n->low) / n->bins;
  place_of(n, i, at);
  bool cone = n->o.kind == CDEM_SURFACE_CONE, plane = n->s->dim == 2;
  double place = cone ? sqrt(at[0] * at[0] + at[1] * at[1]) : at[0];
  if (!(width > 0.0) || place + r < n->low || place - r > n->high)
    return;
  int first = clamp_bin((place - r - n->low) / width, n->bins);
  int last = clamp_bin((place + r - n->low) / width, n->bins);
  int from = 0, to = n->depth - 1;
  if (!cone && !plane) {
    double side = (n->side_high - n->side_low) / n->depth;
    from = clamp_bin((at[1] - r - n->side_low) / side, n->depth);
    to = clamp_bin((at[1] + r - n->side_low) / side, n->depth);
  }
  for (int ray_of = first * RAYS; ray_of < (last + 1) * RAYS; ray_of++)
    for (int k = from; k <= to; k++) {
      double ray[2], *top = &n->top[(int64_t)(ray_of / RAYS) * n->depth + k];
      ray_place(n, ray_of / RAYS, ray_of % RAYS, k, ray);
      double x = ray[0] - at[0], y = plane ? 0.0 : ray[1] - at[1], left = r * r - x * x - y * y;
      if (left >= 0.0 && !(*top >= at[2] + sqrt(left)))
        *top = at[2] + sqrt(left);
    }
}

static void shoot(const scan *n, cdem_surface *surface) {
  for (int64_t k = 0; k < (int64_t)n->bins * n->depth; k++)
    n->top[k] = NAN;
  for (int64_t i = 0; i < n->s->grains; i++)
    if (n->s->touching[i] > 0)
      meet_grain(n, i);
  surface->crest = -INFINITY;
  for (int bin = 0; bin < n->bins; bin++) {
    double sum = 0.0;
    int rays = 0;
    for (int k = 0; k < n->depth; k++) {
      double top = n->top[(int64_t)bin * n->depth + k];
      rays += isfinite(top);
      sum += isfinite(top) ? top : 0.0;
    }
    /* Rays that meet nothing meet the foot: where the heap ends its height is a mean with them. */
    bool heap = n->o.kind != CDEM_SURFACE_SLOPE;
    surface->place[bin] = bin_place(n, bin);
    surface->height[bin] = rays > 0 ? sum / (heap ? n->depth : rays) : NAN;
    if (surface->height[bin] > surface->crest) {
      surface->crest = surface->height[bin];
      surface->crest_place = surface->place[bin];
    }
  }
  if (!isfinite(surface->crest))
    surface->crest = surface->crest_place = NAN;
}

/* ---- lines ---- */

/* Mean height about a bin. */
static double smooth(const cdem_surface *f, int bin) {
  double sum = 0.0;
  int count = 0;
  for (int b = bin - 2; b <= bin + 2; b++)
    if (b >= 0 && b < f->bins && isfinite(f->height[b])) {
      sum += f->height[b];
      count++;
    }
  return count > 0 ? sum / count : 0.0;
}

/* The flank as a range of bins: chosen by place, not bin by bin by height, which would leave out
 * the low ones at its foot and the high ones at its top and so make it flatter. */
static void find_flank(const scan *n, const cdem_surface *f, int flank, int range[2]) {
  if (n->o.kind == CDEM_SURFACE_SLOPE) {
    range[0] = (int)ceil(n->o.flank_low * f->bins - 0.5);
    range[1] = (int)floor(n->o.flank_high * f->bins - 0.5);
    return;
  }
  int outwards = f->flanks == 2 && flank == 0 ? -1 : 1, bin = 0;
  while (bin < f->bins - 1 && f->place[bin] < f->crest_place)
    bin++;
  while (bin >= 0 && bin < f->bins && smooth(f, bin) > n->o.flank_high * f->crest)
    bin += outwards;
  int first = bin;
  while (bin >= 0 && bin < f->bins && smooth(f, bin) >= n->o.flank_low * f->crest)
    bin += outwards;
  range[0] = outwards > 0 ? first : bin + 1;
  range[1] = outwards > 0 ? bin - 1 : first;
}

/* Least squares: slope, its standard error from the scatter, both turned into an angle. */
static void fit_flank(const scan *n, cdem_surface *f, int flank) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, rest = 0.0;
  int points = 0, range[2];
  find_flank(n, f, flank, range);
  for (int b = range[0]; b <= range[1]; b++)
    if (isfinite(f->height[b])) {
      points++;
      x += f->place[b];
      y += f->height[b];
    }
  f->points[flank] = points;
  f->angle[flank] = f->error[flank] = f->scatter[flank] = NAN;
  if (points < 3)
    return;
  x /= points;
  y /= points;
  for (int b = range[0]; b <= range[1]; b++)
    if (isfinite(f->height[b])) {
      xx += (f->place[b] - x) * (f->place[b] - x);
      xy += (f->place[b] - x) * (f->height[b] - y);
    }
  double slope = xy / xx;
  for (int b = range[0]; b <= range[1]; b++)
    if (isfinite(f->height[b])) {
      double off = f->height[b] - y - slope * (f->place[b] - x);
      rest += off * off;
    }
  bool falls = n->o.kind == CDEM_SURFACE_CONE || (n->o.kind == CDEM_SURFACE_HEAP && flank == 1);
  f->angle[flank] = atan(falls ? -slope : slope);
  f->scatter[flank] = sqrt(rest / (points - 2));
  f->error[flank] = f->scatter[flank] / sqrt(xx) / (1.0 + slope * slope);
}

static cdem_status check_options(const cdem_snapshot *s, cdem_surface_options *o,
                                 cdem_fault *fault) {
  if (o->flank_low == 0.0 && o->flank_high == 0.0) {
    o->flank_low = 0.15;
    o->flank_high = 0.85;
  }
  CDEM_REQUIRE(o->flank_low >= 0.0 && o->flank_low < o->flank_high && o->flank_high <= 1.0, fault,
               CDEM_USAGE,
               "the flank of a surface reaches from %g to %g of its height; choose "
               "parts between 0 and 1, the lower one first",
               o->flank_low, o->flank_high);
  CDEM_REQUIRE(o->bins >= 0 && o->bins <= 100000 && o->depth >= 0 && o->depth <= 10000, fault,
               CDEM_USAGE, "a surface of %d bins and %d rays each; choose up to 100000 and 10000",
               o->bins, o->depth);
  CDEM_REQUIRE(o->kind != CDEM_SURFACE_CONE || s->dim == 3, fault, CDEM_USAGE,
               "discs make no cone; choose the surface of a heap");
  return CDEM_OK;
}

cdem_status cdem_free_surface_make(const cdem_snapshot *s, const cdem_surface_options *options,
                                   cdem_surface *surface, cdem_fault *fault) {
  scan n = {.s = s, .o = *options};
  cdem_surface made = {.flanks = options->kind == CDEM_SURFACE_HEAP ? 2 : 1};
  CDEM_TRY(check_options(s, &n.o, fault));
  CDEM_TRY(directions(&n, fault));
  find_range(&n);
  made.bins = n.bins;
  n.top = cdem_allocate((int64_t)n.bins * n.depth, sizeof *n.top, fault);
  made.place = n.top != NULL ? cdem_allocate(n.bins, sizeof(double), fault) : NULL;
  made.height = made.place != NULL ? cdem_allocate(n.bins, sizeof(double), fault) : NULL;
  if (made.height == NULL) {
    free(n.top);
    cdem_surface_release(&made);
    return CDEM_MEMORY;
  }
  shoot(&n, &made);
  made.angle[1] = made.error[1] = made.scatter[1] = NAN;
  for (int k = 0; k < made.flanks; k++) {
    fit_flank(&n, &made, k);
    made.repose += fabs(made.angle[k]) / made.flanks;
  }
  free(n.top);
  *surface = made;
  return CDEM_OK;
}

cdem_status cdem_free_surface(const cdem_dem *dem, const cdem_surface_options *options,
                              cdem_surface *surface, cdem_fault *fault) {
  cdem_snapshot s;
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  cdem_status status = cdem_free_surface_make(&s, options, surface, fault);
  cdem_snapshot_release(&s);
  return status;
}

void cdem_surface_release(cdem_surface *surface) {
  free(surface->place);
  free(surface->height);
  *surface = (cdem_surface){0};
}
