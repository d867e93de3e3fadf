/* Size laws: every law is its quantile function, radius against share by number, so that a draw is
 * one uniform number and a test can compare shares. Written in ratios of radii: a law scaled by a
 * power of two gives scaled bits. */
#include "dem/packing.h"

static const char *const kind_name[CDEM_SIZES_KINDS] = {"equal", "uniform", "power", "normal",
                                                        "table"};

const char *cdem_size_kind_name(int kind) {
  return kind >= 0 && kind < CDEM_SIZES_KINDS ? kind_name[kind] : NULL;
}

static bool is_positive(double value) {
  return isfinite(value) && value > 0.0;
}

/* Every draw goes through all classes. */
enum { MOST_CLASSES = 1000 };

static cdem_status check_table(const cdem_sizes *sizes, cdem_fault *fault) {
  CDEM_REQUIRE(sizes->entries > 0, fault, CDEM_INPUT, "a table of sizes needs at least one class");
  CDEM_REQUIRE(sizes->entries <= MOST_CLASSES, fault, CDEM_INPUT,
               "a table of sizes has %d classes, more than %d; gather grains of nearly the same "
               "size in one class",
               sizes->entries, MOST_CLASSES);
  for (int i = 0; i < sizes->entries; i++) {
    CDEM_REQUIRE(is_positive(sizes->class_radius[i]), fault, CDEM_INPUT,
                 "size class %d has radius %g m; a radius is positive", i + 1,
                 sizes->class_radius[i]);
    CDEM_REQUIRE(is_positive(sizes->class_fraction[i]), fault, CDEM_INPUT,
                 "size class %d has fraction %g; a fraction of the solid is positive", i + 1,
                 sizes->class_fraction[i]);
    CDEM_REQUIRE(i == 0 || sizes->class_radius[i] > sizes->class_radius[i - 1], fault, CDEM_INPUT,
                 "size class %d has radius %g m after %g m; classes ascend", i + 1,
                 sizes->class_radius[i], sizes->class_radius[i - 1]);
  }
  return CDEM_OK;
}

cdem_status cdem_sizes_check(const cdem_sizes *sizes, cdem_fault *fault) {
  CDEM_REQUIRE(cdem_size_kind_name(sizes->kind) != NULL, fault, CDEM_INPUT,
               "there is no size law %d", sizes->kind);
  if (sizes->kind == CDEM_SIZES_TABLE)
    return check_table(sizes, fault);
  if (sizes->kind == CDEM_SIZES_EQUAL || sizes->kind == CDEM_SIZES_NORMAL)
    CDEM_REQUIRE(is_positive(sizes->radius), fault, CDEM_INPUT,
                 "the radius is %g m; a radius is positive", sizes->radius);
  if (sizes->kind == CDEM_SIZES_EQUAL)
    return CDEM_OK;
  CDEM_REQUIRE(is_positive(sizes->least), fault, CDEM_INPUT,
               "the least radius is %g m; a radius is positive", sizes->least);
  CDEM_REQUIRE(isfinite(sizes->most) && sizes->most >= sizes->least, fault, CDEM_INPUT,
               "the largest radius is %g m; it must not be below the least, %g m", sizes->most,
               sizes->least);
  if (sizes->kind == CDEM_SIZES_POWER)
    CDEM_REQUIRE(isfinite(sizes->exponent), fault, CDEM_INPUT,
                 "the exponent of the size law is %g; a number is wanted", sizes->exponent);
  if (sizes->kind == CDEM_SIZES_NORMAL)
    CDEM_REQUIRE(is_positive(sizes->spread), fault, CDEM_INPUT,
                 "the spread of the radii is %g m; it must be positive", sizes->spread);
  return CDEM_OK;
}

double cdem_sizes_largest(const cdem_sizes *sizes) {
  if (sizes->kind == CDEM_SIZES_EQUAL)
    return sizes->radius;
  return sizes->kind == CDEM_SIZES_TABLE ? sizes->class_radius[sizes->entries - 1] : sizes->most;
}

double cdem_sizes_smallest(const cdem_sizes *sizes) {
  if (sizes->kind == CDEM_SIZES_EQUAL)
    return sizes->radius;
  return sizes->kind == CDEM_SIZES_TABLE ? sizes->class_radius[0] : sizes->least;
}

/* Number density ~ r^m: share = ((r/a)^k - 1)/((b/a)^k - 1), k = m + 1; the logarithm for k = 0. */
static double power_quantile(const cdem_sizes *sizes, double share) {
  double k = sizes->exponent + 1.0, range = log(sizes->most / sizes->least);
  if (k == 0.0)
    return sizes->least * exp(share * range);
  return sizes->least * exp(log1p(share * expm1(k * range)) / k);
}

static double power_share(const cdem_sizes *sizes, double radius) {
  double k = sizes->exponent + 1.0, range = log(sizes->most / sizes->least);
  double way = log(radius / sizes->least);
  if (range == 0.0)
    return 1.0;
  return k == 0.0 ? way / range : expm1(k * way) / expm1(k * range);
}

/* Of the normal law without cuts, from the mean: erfc keeps its digits in the lower tail. */
static double normal_share(const cdem_sizes *sizes, double radius) {
  const double root_half = 0.70710678118654752440;
  double low = 0.5 * erfc(-(sizes->least - sizes->radius) / sizes->spread * root_half);
  double high = 0.5 * erfc(-(sizes->most - sizes->radius) / sizes->spread * root_half);
  double here = 0.5 * erfc(-(radius - sizes->radius) / sizes->spread * root_half);
  /* Both cuts so far out on one side that nothing is left between them: all at the nearer one. */
  if (!(high > low))
    return sizes->radius > sizes->most ? (radius >= sizes->most) : 1.0;
  return (here - low) / (high - low);
}

static double normal_quantile(const cdem_sizes *sizes, double share) {
  double low = sizes->least, high = sizes->most;
  for (int i = 0; i < 60 && low < high; i++) {
    double middle = 0.5 * (low + high);
    if (normal_share(sizes, middle) <= share)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Fractions of the solid divided by the solid of one grain are numbers; in ratios to the largest
 * class. */
static double class_weight(int dim, const cdem_sizes *sizes, int i) {
  double ratio = cdem_sizes_largest(sizes) / sizes->class_radius[i];
  return sizes->class_fraction[i] * ratio * ratio * (dim == 3 ? ratio : 1.0);
}

static double table_share(int dim, const cdem_sizes *sizes, double radius) {
  double below = 0.0, all = 0.0;
  for (int i = 0; i < sizes->entries; i++) {
    double weight = class_weight(dim, sizes, i);
    all += weight;
    if (sizes->class_radius[i] <= radius)
      below += weight;
  }
  return below / all;
}

static double table_quantile(int dim, const cdem_sizes *sizes, double share) {
  double all = 0.0, sum = 0.0;
  for (int i = 0; i < sizes->entries; i++)
    all += class_weight(dim, sizes, i);
  for (int i = 0; i < sizes->entries; i++) {
    sum += class_weight(dim, sizes, i);
    if (share * all < sum)
      return sizes->class_radius[i];
  }
  return cdem_sizes_largest(sizes);
}

double cdem_sizes_quantile(int dim, const cdem_sizes *sizes, double share) {
  double radius = sizes->radius;
  switch (sizes->kind) {
  case CDEM_SIZES_UNIFORM:
    radius = sizes->least + share * (sizes->most - sizes->least);
    break;
  case CDEM_SIZES_POWER:
    radius = power_quantile(sizes, share);
    break;
  case CDEM_SIZES_NORMAL:
    radius = normal_quantile(sizes, share);
    break;
  case CDEM_SIZES_TABLE:
    return table_quantile(dim, sizes, share);
  default:
    return radius;
  }
  return fmin(fmax(radius, sizes->least), sizes->most);
}

double cdem_sizes_share(int dim, const cdem_sizes *sizes, double radius) {
  if (radius < cdem_sizes_smallest(sizes))
    return 0.0;
  if (radius >= cdem_sizes_largest(sizes))
    return 1.0;
  switch (sizes->kind) {
  case CDEM_SIZES_UNIFORM:
    return (radius - sizes->least) / (sizes->most - sizes->least);
  case CDEM_SIZES_POWER:
    return power_share(sizes, radius);
  case CDEM_SIZES_NORMAL:
    return normal_share(sizes, radius);
  case CDEM_SIZES_TABLE:
    return table_share(dim, sizes, radius);
  default:
    return 1.0;
  }
}

/* Large grains hold most of the solid of a table and may be fewer than a quantile shows. */
static double table_mean_solid(int dim, const cdem_sizes *sizes) {
  double solid = 0.0, all = 0.0;
  for (int i = 0; i < sizes->entries; i++) {
    double weight = class_weight(dim, sizes, i);
    solid += weight * cdem_grain_solid(dim, sizes->class_radius[i]);
    all += weight;
  }
  return solid / all;
}

double cdem_sizes_mean_solid(int dim, const cdem_sizes *sizes) {
  enum { QUANTILES = 1024 };
  double sum = 0.0;
  int points = sizes->kind == CDEM_SIZES_EQUAL ? 1 : QUANTILES;
  if (sizes->kind == CDEM_SIZES_TABLE)
    return table_mean_solid(dim, sizes);
  for (int i = 0; i < points; i++)
    sum += cdem_grain_solid(dim, cdem_sizes_quantile(dim, sizes, (i + 0.5) / points));
  return sum / points;
}

double cdem_sizes_draw(int dim, const cdem_sizes *sizes, cdem_random *random) {
  if (sizes->kind == CDEM_SIZES_EQUAL)
    return sizes->radius;
  return cdem_sizes_quantile(dim, sizes, cdem_random_uniform(random, 0.0, 1.0));
}
