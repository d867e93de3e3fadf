/* Packings, told one number at a time so that one more is one line of a table. */
#include "dem/packing.h"

#include "api/store.h"
#include "base/suggest.h"
#include "io/grains_file.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

struct libcdem_packing {
  const cdem_packing *kind;
  cdem_packing_options options;
  cdem_compaction compaction;
  double count, seed, centres_inside, cylinder, periodic[3]; /* as told; put in place by `settle` */
  double low[3], high[3];                                    /* of what was made */
  cdem_grains grains;
};

/* Which numbers may be told, where they go, and the most they may be. */
typedef struct {
  const char *name;
  size_t offset;
  double most;
  bool whole;
} number;

#define PLACE(member) offsetof(libcdem_packing, member)
static const number numbers[] = {
    {"radius", PLACE(options.sizes.radius), INFINITY, false},
    {"least", PLACE(options.sizes.least), INFINITY, false},
    {"most", PLACE(options.sizes.most), INFINITY, false},
    {"exponent", PLACE(options.sizes.exponent), INFINITY, false},
    {"spread", PLACE(options.sizes.spread), INFINITY, false},
    {"count", PLACE(count), 2147483647.0, true},
    {"fraction", PLACE(options.fraction), 1.0, false},
    {"seed", PLACE(seed), 9007199254740992.0, true},
    {"centres_inside", PLACE(centres_inside), 1.0, true},
    {"cylinder", PLACE(cylinder), 1.0, true},
    {"periodic_x", PLACE(periodic[0]), 1.0, true},
    {"periodic_y", PLACE(periodic[1]), 1.0, true},
    {"periodic_z", PLACE(periodic[2]), 1.0, true},
    {"press_fraction", PLACE(compaction.fraction), 1.0, false},
    {"press_pressure", PLACE(compaction.pressure), INFINITY, false},
    {"press_height", PLACE(compaction.height), INFINITY, false},
    {"press_friction", PLACE(compaction.friction), INFINITY, false},
    {"press_inertial", PLACE(compaction.inertial), INFINITY, false},
};
#undef PLACE
enum { NUMBERS = sizeof numbers / sizeof *numbers };

static cdem_status create(const char *kind, int dimension, const double *low, const double *high,
                          libcdem_packing **packing, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(kind, "the kind of the packing", fault));
  CDEM_TRY(cdem_api_want(low, "the low corner of the box", fault));
  CDEM_TRY(cdem_api_want(high, "the high corner of the box", fault));
  CDEM_TRY(cdem_api_want(packing, "a place for the packing", fault));
  CDEM_REQUIRE(dimension == 2 || dimension == 3, fault, CDEM_USAGE, "dimension %d: 2 or 3",
               dimension);
  const cdem_packing *found = cdem_packing_find(kind);
  CDEM_REQUIRE(found != NULL, fault, CDEM_USAGE,
               "there is no packing '%.40s'; there are square, hexagonal, cubic, inward and loose",
               kind);
  CDEM_NEW(*packing, 1, fault);
  libcdem_packing *p = *packing;
  p->kind = found;
  p->options.dim = dimension;
  p->seed = 1.0;
  for (int c = 0; c < dimension; c++) {
    p->options.low[c] = p->low[c] = low[c];
    p->options.high[c] = p->high[c] = high[c];
  }
  return CDEM_OK;
}

libcdem_status libcdem_packing_create(const char *kind, int dimension, const double *low,
                                      const double *high, libcdem_packing **packing,
                                      libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(create(kind, dimension, low, high, packing, &own), &own, fault);
}

void libcdem_packing_destroy(libcdem_packing **packing) {
  if (packing == NULL || *packing == NULL)
    return;
  cdem_grains_release(&(*packing)->grains);
  free(*packing);
  *packing = NULL;
}

static cdem_status no_number(const char *name, cdem_fault *fault) {
  const char *names[NUMBERS];
  for (int i = 0; i < NUMBERS; i++)
    names[i] = numbers[i].name;
  const char *nearest = cdem_suggest(name, names, NUMBERS);
  if (nearest != NULL)
    return cdem_fail(fault, CDEM_USAGE, "a packing has no '%.40s'; did you mean '%s'?", name,
                     nearest);
  return cdem_fail(fault, CDEM_USAGE, "a packing has no '%.40s'", name);
}

static cdem_status set(libcdem_packing *packing, const char *name, double value,
                       cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(packing, "a packing", fault));
  CDEM_TRY(cdem_api_want(name, "the name of a number", fault));
  for (int i = 0; i < NUMBERS; i++) {
    const number *n = &numbers[i];
    if (strcmp(n->name, name) != 0)
      continue;
    bool signed_ = strcmp(name, "exponent") == 0;
    CDEM_REQUIRE(isfinite(value) && (signed_ || value >= 0.0) && value <= n->most &&
                     (!n->whole || floor(value) == value),
                 fault, CDEM_USAGE, "%s %g: a%s number from 0 to %g is wanted", name, value,
                 n->whole ? " whole" : "", n->most);
    *(double *)((char *)packing + n->offset) = value;
    return CDEM_OK;
  }
  return no_number(name, fault);
}

libcdem_status libcdem_packing_set(libcdem_packing *packing, const char *name, double value,
                                   libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(set(packing, name, value, &own), &own, fault);
}

/* ---- making ---- */

static bool is_pressed(const cdem_compaction *c) {
  return c->fraction > 0.0 || c->pressure > 0.0 || c->height > 0.0;
}

/* The law of sizes follows from which of its numbers were told. */
static cdem_size_kind size_kind(const cdem_sizes *sizes) {
  if (sizes->spread > 0.0)
    return CDEM_SIZES_NORMAL;
  if (sizes->exponent != 0.0)
    return CDEM_SIZES_POWER;
  return sizes->most > 0.0 ? CDEM_SIZES_UNIFORM : CDEM_SIZES_EQUAL;
}

static void settle(libcdem_packing *p, const cdem_progress *progress) {
  cdem_packing_options *o = &p->options;
  o->sizes.kind = size_kind(&o->sizes);
  o->count = (int64_t)p->count;
  o->seed = (uint64_t)p->seed;
  o->centres_inside = p->centres_inside != 0.0;
  o->cylinder = p->cylinder != 0.0;
  for (int c = 0; c < 3; c++)
    o->periodic[c] = p->compaction.periodic[c] = p->periodic[c] != 0.0;
  o->progress = p->compaction.progress = progress;
}

static cdem_status press(const libcdem_packing *p, const cdem_packing_options *options,
                         cdem_grains *grains, cdem_compacted *pressed, cdem_fault *fault) {
  CDEM_REQUIRE(p->kind->loose, fault, CDEM_USAGE,
               "only a loose packing can be pressed together; '%s' is not", p->kind->name);
  return cdem_packing_compact(options, &p->compaction, grains, pressed, fault);
}

static cdem_status make(libcdem_packing *p, const libcdem_listener *listener, cdem_fault *fault) {
  cdem_api_ears ears;
  cdem_grains grains = {0};
  cdem_compacted pressed = {0};
  CDEM_TRY(cdem_api_want(p, "a packing", fault));
  cdem_api_listen(listener, &ears);
  settle(p, ears.progress);
  cdem_packing_options options = p->options;
  if (is_pressed(&p->compaction))
    cdem_packing_make_room(&options, &p->compaction);
  CDEM_TRY(cdem_packing_make(p->kind, &options, &grains, fault));
  memcpy(pressed.low, options.low, sizeof pressed.low);
  memcpy(pressed.high, options.high, sizeof pressed.high);
  cdem_status status = CDEM_OK;
  if (is_pressed(&p->compaction))
    status = press(p, &options, &grains, &pressed, fault);
  if (status != CDEM_OK) {
    cdem_grains_release(&grains);
    return status;
  }
  cdem_grains_release(&p->grains);
  p->grains = grains;
  memcpy(p->low, pressed.low, sizeof p->low);
  memcpy(p->high, pressed.high, sizeof p->high);
  return CDEM_OK;
}

libcdem_status libcdem_packing_make(libcdem_packing *packing, const libcdem_listener *listener,
                                    libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(make(packing, listener, &own), &own, fault);
}

int64_t libcdem_packing_grains(const libcdem_packing *packing) {
  return packing != NULL ? packing->grains.grains : 0;
}

const double *libcdem_packing_centres(const libcdem_packing *packing) {
  return packing != NULL ? packing->grains.xyz : NULL;
}

const double *libcdem_packing_radii(const libcdem_packing *packing) {
  return packing != NULL ? packing->grains.radius : NULL;
}

void libcdem_packing_box(const libcdem_packing *packing, double *low, double *high) {
  memcpy(low, packing->low, sizeof packing->low);
  memcpy(high, packing->high, sizeof packing->high);
}

static cdem_status write_grains(const libcdem_packing *packing, const char *path,
                                cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(packing, "a packing", fault));
  CDEM_TRY(cdem_api_want(path, "the path of a file", fault));
  CDEM_REQUIRE(packing->grains.grains > 0, fault, CDEM_USAGE,
               "there are no grains yet; make the packing first");
  return cdem_write_grains(path, &packing->grains, 0, NULL, fault);
}

libcdem_status libcdem_packing_write(const libcdem_packing *packing, const char *path,
                                     libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(write_grains(packing, path, &own), &own, fault);
}
