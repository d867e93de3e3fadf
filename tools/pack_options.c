/* Options of cdem pack. */
#include "base/suggest.h"
#include "pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  OPTION_SIZE = 256,
  OPTION_BOX,
  OPTION_RADIUS,
  OPTION_SIZES,
  OPTION_LEAST,
  OPTION_MOST,
  OPTION_EXPONENT,
  OPTION_SPREAD,
  OPTION_TABLE,
  OPTION_COUNT,
  OPTION_FRACTION,
  OPTION_CYLINDER,
  OPTION_PERIODIC,
  OPTION_CENTRES_INSIDE,
  OPTION_SEED,
  OPTION_COMPACT,
  OPTION_PRESSURE,
  OPTION_HEIGHT,
  OPTION_FRICTION,
  OPTION_INERTIAL,
  OPTION_MATERIAL,
  OPTION_THREADS,
  OPTION_JSON,
};

const struct argp_option pack_option_table[] = {
    {NULL, 0, NULL, 0, "Where:", 1},
    {"size", OPTION_SIZE, "LX,LY[,LZ]", 0, "box from the origin; three lengths: spheres", 1},
    {"box", OPTION_BOX, "X0,Y0[,Z0],X1,Y1[,Z1]", 0, "box by two corners", 1},
    {"cylinder", OPTION_CYLINDER, NULL, 0, "loose, 3-D: the tube about z in the box", 1},
    {"periodic", OPTION_PERIODIC, "xyz", 0, "loose: directions in which the box is periodic", 1},
    {"centres-inside", OPTION_CENTRES_INSIDE, NULL, 0,
     "lattices: centres in the box, not whole grains", 1},
    {NULL, 0, NULL, 0, "Sizes:", 2},
    {"radius", OPTION_RADIUS, "R", 0, "of equal grains; of --sizes normal the mean", 2},
    {"sizes", OPTION_SIZES, "LAW", 0,
     "equal (default), uniform, power (number density ~ r^exponent), normal, table", 2},
    {"least", OPTION_LEAST, "R", 0, "smallest radius of uniform, power, normal", 2},
    {"most", OPTION_MOST, "R", 0, "largest radius", 2},
    {"exponent", OPTION_EXPONENT, "M", 0, "of power", 2},
    {"spread", OPTION_SPREAD, "S", 0, "standard deviation of normal", 2},
    {"table", OPTION_TABLE, "FILE", 0,
     "of table: a CSV file with columns radius [m] and fraction (of the solid)", 2},
    {NULL, 0, NULL, 0, "How many (loose):", 3},
    {"count", OPTION_COUNT, "N", 0, "number of grains", 3},
    {"fraction", OPTION_FRACTION, "F", 0,
     "solid fraction of the box; with --compact: after the compaction", 3},
    {"seed", OPTION_SEED, "N", 0, "of the random numbers (default 1)", 3},
    {NULL, 0, NULL, 0, "Compaction (loose):", 4},
    {"compact", OPTION_COMPACT, NULL, 0,
     "press the grains to --pressure, --fraction or --height; the box shrinks about its low "
     "corner, a "
     "cylinder along its axis",
     4},
    {"pressure", OPTION_PRESSURE, "P", 0, "of the compacted packing", 4},
    {"height", OPTION_HEIGHT, "H", 0,
     "of the compacted cylinder; --count grains are put loosely into a higher one", 4},
    {"friction", OPTION_FRICTION, "MU", 0, "of the grains meanwhile (default 0: densest)", 4},
    {"inertial", OPTION_INERTIAL, "I", 0, "inertial number, how slow (default 1e-3)", 4},
    {"threads", OPTION_THREADS, "N", 0, "threads of the compaction; results do not depend on it",
     4},
    {NULL, 0, NULL, 0, "Output:", 5},
    {"output", 'o', "FILE", 0, "table (.csv) or points (.vtp); may be given several times", 5},
    {"material", OPTION_MATERIAL, "NAME", 0, "write a column material with this name", 5},
    {"json", OPTION_JSON, NULL, 0, "print the summary as JSON", 5},
    {"quiet", 'q', NULL, 0, "no talk, no progress, no summary", 5},
    {0},
};

static double positive(const char *option, const char *text, cdem_dimension dimension) {
  double value = command_quantity(option, text, dimension);
  if (!(value > 0.0) || isinf(value))
    command_usage("%s %s: a number above 0 is wanted", option, text);
  return value;
}

/* Lengths parted by commas; how many. */
static int lengths(const char *option, const char *text, double value[6]) {
  const char *at = text;
  for (int count = 0;; at++) {
    char part[64];
    size_t length = strcspn(at, ",");
    if (count == 6 || length == 0 || length >= sizeof part)
      command_usage("%s %s: lengths parted by commas are wanted", option, text);
    snprintf(part, sizeof part, "%.*s", (int)length, at);
    value[count++] = command_quantity(option, part, CDEM_LENGTH);
    at += length;
    if (*at == '\0')
      return count;
  }
}

static void box_of(pack_settings *s, const char *option, const char *text, bool corners) {
  double value[6];
  int count = lengths(option, text, value), dim = corners ? count / 2 : count;
  if (s->has_box)
    command_usage("--size and --box: one of them, once");
  if ((dim != 2 && dim != 3) || (corners && count % 2 != 0))
    command_usage("%s %s: %s", option, text,
                  corners ? "two corners are wanted, 4 or 6 numbers"
                          : "two lengths (discs) or three (spheres) are wanted");
  s->has_box = true;
  s->options.dim = dim;
  for (int c = 0; c < dim; c++) {
    s->options.low[c] = corners ? value[c] : 0.0;
    s->options.high[c] = value[corners ? dim + c : c];
  }
}

static void sizes_of(pack_settings *s, const char *text) {
  const char *names[CDEM_SIZES_KINDS];
  for (int k = 0; k < CDEM_SIZES_KINDS; k++) {
    names[k] = cdem_size_kind_name(k);
    if (strcmp(text, names[k]) == 0) {
      s->options.sizes.kind = (cdem_size_kind)k;
      s->has_sizes = true;
      return;
    }
  }
  const char *nearest = cdem_suggest(text, names, CDEM_SIZES_KINDS);
  if (nearest != NULL)
    command_usage("--sizes %s: there is no such law; did you mean '%s'?", text, nearest);
  command_usage("--sizes %s: equal, uniform, power, normal or table is wanted", text);
}

static void periodic_of(pack_settings *s, const char *text) {
  for (const char *c = text; *c != '\0'; c++) {
    if (*c < 'x' || *c > 'z')
      command_usage("--periodic %s: letters out of x, y, z are wanted", text);
    s->options.periodic[*c - 'x'] = true;
  }
}

static bool parse_sizes(pack_settings *s, int key, const char *text) {
  cdem_sizes *sizes = &s->options.sizes;
  switch (key) {
  case OPTION_RADIUS:
    sizes->radius = positive("--radius", text, CDEM_LENGTH);
    return s->has_radius = true;
  case OPTION_SIZES:
    sizes_of(s, text);
    return true;
  case OPTION_LEAST:
    sizes->least = positive("--least", text, CDEM_LENGTH);
    return s->has_least = true;
  case OPTION_MOST:
    sizes->most = positive("--most", text, CDEM_LENGTH);
    return s->has_most = true;
  case OPTION_EXPONENT:
    sizes->exponent = command_number("--exponent", text);
    return s->has_exponent = true;
  case OPTION_SPREAD:
    sizes->spread = positive("--spread", text, CDEM_LENGTH);
    return s->has_spread = true;
  case OPTION_TABLE:
    s->table = text;
    return true;
  }
  return false;
}

static bool parse_box(pack_settings *s, int key, const char *text) {
  switch (key) {
  case OPTION_SIZE:
    box_of(s, "--size", text, false);
    return true;
  case OPTION_BOX:
    box_of(s, "--box", text, true);
    return true;
  case OPTION_CYLINDER:
    return s->options.cylinder = true;
  case OPTION_PERIODIC:
    periodic_of(s, text);
    return true;
  case OPTION_CENTRES_INSIDE:
    return s->options.centres_inside = true;
  case OPTION_COUNT:
    s->options.count = command_integer("--count", text, 1, INT32_MAX - 1);
    return true;
  case OPTION_FRACTION:
    s->options.fraction = positive("--fraction", text, CDEM_DIMENSIONLESS);
    return true;
  case OPTION_SEED:
    s->options.seed = (uint64_t)command_integer("--seed", text, 0, INT32_MAX);
    return true;
  }
  return false;
}

static void output_of(pack_settings *s, const char *text) {
  size_t length = strlen(text);
  if (s->outputs == PACK_OUTPUTS)
    command_usage("-o: %d files at most", PACK_OUTPUTS);
  if (length < 5 ||
      (strcmp(text + length - 4, ".csv") != 0 && strcmp(text + length - 4, ".vtp") != 0))
    command_usage("the ending of '%s' names no file of grains; .csv or .vtp is wanted", text);
  s->output[s->outputs++] = text;
}

bool pack_parse(pack_settings *s, int key, const char *text) {
  if (parse_sizes(s, key, text) || parse_box(s, key, text))
    return true;
  switch (key) {
  case OPTION_COMPACT:
    return s->compact = true;
  case OPTION_PRESSURE:
    s->compaction.pressure = positive("--pressure", text, CDEM_PRESSURE);
    return true;
  case OPTION_HEIGHT:
    s->compaction.height = positive("--height", text, CDEM_LENGTH);
    return true;
  case OPTION_FRICTION:
    s->compaction.friction = command_number("--friction", text);
    if (!(s->compaction.friction >= 0.0))
      command_usage("--friction %s: a number that is not negative is wanted", text);
    return true;
  case OPTION_INERTIAL:
    s->compaction.inertial = positive("--inertial", text, CDEM_DIMENSIONLESS);
    return true;
  case OPTION_THREADS:
    s->compaction.threads = (int)command_integer("--threads", text, 1, 1024);
    return true;
  case OPTION_MATERIAL:
    s->material = text;
    return true;
  case OPTION_JSON:
    return s->json = true;
  case 'o':
    output_of(s, text);
    return true;
  case 'q':
    return command_quiet = true;
  }
  return false;
}

/* ---- what goes together ---- */

static void check_sizes(const pack_settings *s) {
  cdem_size_kind kind = s->options.sizes.kind;
  const char *law = cdem_size_kind_name(kind);
  bool ranged = kind == CDEM_SIZES_UNIFORM || kind == CDEM_SIZES_POWER || kind == CDEM_SIZES_NORMAL;
  if ((kind == CDEM_SIZES_EQUAL || kind == CDEM_SIZES_NORMAL) && !s->has_radius)
    command_usage("a radius is wanted: --radius R%s",
                  kind == CDEM_SIZES_EQUAL ? " (or --sizes with --least and --most)" : "");
  if (ranged != (s->has_least || s->has_most) || (ranged && !(s->has_least && s->has_most)))
    command_usage("--sizes %s takes %s", law,
                  ranged ? "--least and --most" : "no --least and --most");
  if (s->has_exponent != (kind == CDEM_SIZES_POWER))
    command_usage("--exponent and --sizes power go together");
  if (s->has_spread != (kind == CDEM_SIZES_NORMAL))
    command_usage("--spread and --sizes normal go together");
  if ((s->table != NULL) != (kind == CDEM_SIZES_TABLE))
    command_usage("--table and --sizes table go together");
}

void pack_check(pack_settings *s) {
  if (s->packing == NULL)
    command_usage("a kind of packing is wanted: square, hexagonal, cubic, inward or loose");
  if (!s->has_box)
    command_usage("a box is wanted: --size LX,LY[,LZ] or --box X0,Y0,X1,Y1");
  if (s->options.dim == 2 && s->options.periodic[2])
    command_usage("--periodic: discs cannot be periodic in z; letters out of x, y are wanted");
  if (s->table != NULL && !s->has_sizes)
    s->options.sizes.kind = CDEM_SIZES_TABLE;
  check_sizes(s);
  if (!s->compact && (s->compaction.pressure > 0.0 || s->compaction.friction > 0.0 ||
                      s->compaction.inertial > 0.0 || s->compaction.height > 0.0))
    command_usage("--pressure, --height, --friction and --inertial are for --compact");
  if (s->compact && !s->packing->loose)
    command_usage("--compact presses a loose packing; '%s' is not", s->packing->name);
  if (s->compact &&
      (s->compaction.pressure > 0.0) + (s->options.fraction > 0.0) + (s->compaction.height > 0.0) !=
          1)
    command_usage("--compact needs one target: --pressure, --fraction or --height");
  if (s->compact) {
    memcpy(s->compaction.periodic, s->options.periodic, sizeof s->options.periodic);
    s->compaction.fraction = s->options.fraction;
    s->options.fraction = s->options.count > 0 ? 0.0 : s->options.dim == 3 ? 0.3 : 0.5;
  }
}
