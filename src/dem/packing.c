#include "dem/packing.h"

#include <string.h>

#define X(name) extern const cdem_packing cdem_packing_##name;
#include "dem/packings.def"
#undef X

static const cdem_packing *const table[] = {
#define X(name) &cdem_packing_##name,
#include "dem/packings.def"
#undef X
};
enum { PACKINGS = sizeof table / sizeof table[0] };

const cdem_packing *cdem_packing_at(int index) {
  return index >= 0 && index < PACKINGS ? table[index] : NULL;
}

const cdem_packing *cdem_packing_find(const char *name) {
  for (int i = 0; i < PACKINGS; i++)
    if (strcmp(name, table[i]->name) == 0)
      return table[i];
  return NULL;
}

double cdem_packing_room(const cdem_packing_options *options) {
  const double pi = 3.14159265358979323846;
  double edge[3], room = 1.0;
  for (int c = 0; c < 3; c++)
    edge[c] = options->high[c] - options->low[c];
  if (options->cylinder) {
    double diameter = fmin(edge[0], edge[1]);
    return 0.25 * pi * diameter * diameter * edge[2];
  }
  for (int c = 0; c < options->dim; c++)
    room *= edge[c];
  return room;
}

static cdem_status check_box(const cdem_packing_options *options, cdem_fault *fault) {
  double diameter = 2.0 * cdem_sizes_largest(&options->sizes);
  for (int c = 0; c < options->dim; c++) {
    double low = options->low[c], high = options->high[c];
    CDEM_REQUIRE(isfinite(low) && isfinite(high) && high > low, fault, CDEM_INPUT,
                 "the box reaches from %g to %g m in %c; the second must be above the first", low,
                 high, 'x' + c);
    /* Through a periodic face a grain must not meet itself, nor another one twice. */
    double least = options->periodic[c] ? 2.0 * diameter : options->centres_inside ? 0.0 : diameter;
    CDEM_REQUIRE(high - low >= least, fault, CDEM_INPUT,
                 "the box is %g m long in %c, too short for grains of diameter %g m%s", high - low,
                 'x' + c, diameter,
                 options->periodic[c] ? ": a periodic one needs at least two of them" : "");
  }
  return CDEM_OK;
}

static cdem_status check_loose(const cdem_packing *packing, const cdem_packing_options *options,
                               cdem_fault *fault) {
  bool periodic = options->periodic[0] || options->periodic[1] || options->periodic[2];
  if (!packing->loose) {
    CDEM_REQUIRE(options->count == 0 && options->fraction == 0.0, fault, CDEM_INPUT,
                 "a packing '%s' fills its box; count and fraction are for 'loose'", packing->name);
    CDEM_REQUIRE(!periodic, fault, CDEM_INPUT, "a packing '%s' has no periodic faces; 'loose' has",
                 packing->name);
    CDEM_REQUIRE(!options->cylinder, fault, CDEM_INPUT,
                 "a packing '%s' fills a box; only 'loose' fills a cylinder", packing->name);
    return CDEM_OK;
  }
  CDEM_REQUIRE(options->count >= 0 && options->count < INT32_MAX, fault, CDEM_INPUT,
               "%lld grains are wanted; between 1 and %d can be had", (long long)options->count,
               INT32_MAX - 1);
  CDEM_REQUIRE(options->count > 0 || options->fraction > 0.0, fault, CDEM_INPUT,
               "a packing '%s' needs a count or a solid fraction", packing->name);
  CDEM_REQUIRE(options->count == 0 || options->fraction == 0.0, fault, CDEM_INPUT,
               "count (%lld) and fraction (%g) exclude each other", (long long)options->count,
               options->fraction);
  CDEM_REQUIRE(options->fraction < 1.0, fault, CDEM_INPUT,
               "the solid fraction is %g; it must lie between 0 and 1", options->fraction);
  CDEM_REQUIRE(!options->cylinder ||
                   (options->dim == 3 && !options->periodic[0] && !options->periodic[1]),
               fault, CDEM_INPUT,
               "a cylinder needs spheres (3-D) and may be periodic along its axis z only");
  return CDEM_OK;
}

/* Before memory is filled: every packing that fills its box fills at least half of it, but for what
 * the box is too narrow for. */
static cdem_status check_many(const cdem_packing *packing, const cdem_packing_options *options,
                              cdem_fault *fault) {
  double solid = cdem_sizes_mean_solid(options->dim, &options->sizes);
  double about = 0.5 * cdem_packing_room(options) / solid;
  CDEM_REQUIRE(
      packing->loose || about < INT32_MAX, fault, CDEM_INPUT,
      "the box would hold more than %.3g grains; at most %d can be had: take a smaller box "
      "or larger grains",
      about, INT32_MAX - 1);
  return CDEM_OK;
}

static cdem_status check(const cdem_packing *packing, const cdem_packing_options *options,
                         cdem_fault *fault) {
  CDEM_REQUIRE(options->dim == 2 || options->dim == 3, fault, CDEM_INPUT,
               "packings are of dimension 2 or 3, not %d", options->dim);
  CDEM_REQUIRE(packing->dims[options->dim], fault, CDEM_INPUT, "a packing '%s' is of %s",
               packing->name, options->dim == 3 ? "discs (2-D) only" : "spheres (3-D) only");
  CDEM_TRY(cdem_sizes_check(&options->sizes, fault));
  CDEM_REQUIRE(!packing->lattice || options->sizes.kind == CDEM_SIZES_EQUAL, fault, CDEM_INPUT,
               "a packing '%s' is a lattice of equal grains; sizes '%s' are for 'inward' and "
               "'loose'",
               packing->name, cdem_size_kind_name(options->sizes.kind));
  CDEM_REQUIRE(packing->lattice || !options->centres_inside, fault, CDEM_INPUT,
               "a packing '%s' keeps whole grains in the box; centres_inside is for lattices",
               packing->name);
  CDEM_TRY(check_loose(packing, options, fault));
  CDEM_TRY(check_box(options, fault));
  return check_many(packing, options, fault);
}

cdem_status cdem_packing_make(const cdem_packing *packing, const cdem_packing_options *options,
                              cdem_grains *grains, cdem_fault *fault) {
  *grains = (cdem_grains){.dim = options->dim};
  CDEM_TRY(check(packing, options, fault));
  cdem_status status = packing->make(options, grains, fault);
  if (status == CDEM_OK && grains->grains == 0)
    status = cdem_fail(fault, CDEM_INPUT, "no grain of radius %g m fits into the box",
                       cdem_sizes_largest(&options->sizes));
  if (status != CDEM_OK)
    cdem_grains_release(grains);
  return status;
}
