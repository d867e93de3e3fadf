/* Statistics of a plain list of contacts. */
#include "dem/pushes.h"

#include "base/mat3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STRONG 4.0 /* of the mean push */
#define WEAK   0.2

static int kind_of(const cdem_push *push) {
  return push->b < 0 ? CDEM_PUSH_BOUNDARY : CDEM_PUSH_GRAINS;
}

/* Below this a push does not count, N. */
static double least(int64_t contacts, const cdem_push *push, double cutoff) {
  double sum = 0.0;
  int64_t count = 0;
  for (int64_t k = 0; k < contacts; k++)
    if (push[k].push > 0.0) {
      sum += push[k].push;
      count++;
    }
  return count > 0 ? cutoff * sum / (double)count : 0.0;
}

static bool counts(const cdem_push *push, double bound) {
  return push->push > 0.0 && push->push >= bound;
}

/* Of the symmetric fabric: as in measures.h. */
static double anisotropy_of(int dim, const double fabric[9]) {
  double trace = 0.0, sum = 0.0;
  for (int c = 0; c < dim; c++)
    trace += fabric[4 * c] / dim;
  for (int i = 0; i < dim; i++)
    for (int j = 0; j < dim; j++) {
      double d = fabric[3 * i + j] - (i == j ? trace : 0.0);
      sum += d * d;
    }
  return sqrt(sum) * (dim == 2 ? 4.0 * sqrt(0.5) : 7.5 * sqrt(1.5));
}

static void measure_forces(int dim, int64_t contacts, const cdem_push *push, double bound,
                           cdem_push_statistics *s) {
  for (int64_t k = 0; k < contacts; k++) {
    int kind = kind_of(&push[k]);
    if (!counts(&push[k], bound))
      continue;
    s->contacts[kind]++;
    s->mean[kind] += push[k].push;
    if (kind != CDEM_PUSH_GRAINS)
      continue;
    s->largest = fmax(s->largest, push[k].push);
    for (int m = 0; m < 9; m++)
      s->fabric[m] += push[k].normal[m / 3] * push[k].normal[m % 3];
  }
  for (int kind = 0; kind < CDEM_PUSH_KINDS; kind++)
    s->mean[kind] /= fmax(1.0, (double)s->contacts[kind]);
  double between = fmax(1.0, (double)s->contacts[CDEM_PUSH_GRAINS]);
  for (int m = 0; m < 9; m++)
    s->fabric[m] /= between;
  s->anisotropy = anisotropy_of(dim, s->fabric);
  for (int64_t k = 0; k < contacts; k++) {
    if (!counts(&push[k], bound) || kind_of(&push[k]) != CDEM_PUSH_GRAINS)
      continue;
    s->strong += push[k].push > STRONG * s->mean[CDEM_PUSH_GRAINS] ? 1.0 / between : 0.0;
    s->weak += push[k].push < WEAK * s->mean[CDEM_PUSH_GRAINS] ? 1.0 / between : 0.0;
  }
}

static void measure_grains(int64_t grains, const int32_t *touching, cdem_push_statistics *s) {
  int64_t all = 0, carried = 0, carrying = 0;
  for (int64_t i = 0; i < grains; i++) {
    all += touching[i];
    carried += touching[i] >= 2 ? touching[i] : 0;
    carrying += touching[i] >= 2;
  }
  s->coordination = grains > 0 ? (double)all / (double)grains : 0.0;
  s->mechanical = carrying > 0 ? (double)carried / (double)carrying : 0.0;
  s->rattlers = grains > 0 ? (double)(grains - carrying) / (double)grains : 0.0;
}

cdem_status cdem_push_measure(int dim, int64_t grains, int64_t contacts, const cdem_push *push,
                              double cutoff, cdem_push_statistics *statistics, cdem_fault *fault) {
  cdem_push_statistics s = {0};
  double bound = least(contacts, push, cutoff);
  int32_t *touching;
  for (int64_t k = 0; k < contacts; k++)
    CDEM_REQUIRE(push[k].a >= 0 && push[k].a < grains && push[k].b < grains, fault, CDEM_INPUT,
                 "contact %lld is of grains %lld and %lld; there are %lld", (long long)k,
                 (long long)push[k].a, (long long)push[k].b, (long long)grains);
  CDEM_NEW(touching, grains, fault);
  for (int64_t k = 0; k < contacts; k++)
    if (counts(&push[k], bound)) {
      touching[push[k].a]++;
      if (push[k].b >= 0)
        touching[push[k].b]++;
    }
  measure_grains(grains, touching, &s);
  free(touching);
  measure_forces(dim, contacts, push, bound, &s);
  *statistics = s;
  return CDEM_OK;
}

/* ---- distribution ---- */

static cdem_status put_rows(const int64_t *count, int bins, double low, double high, double all,
                            cdem_table *table, cdem_fault *fault) {
  static const char *const name[3] = {"push_over_mean", "contacts", "density"};
  for (int c = 0; c < 3; c++)
    CDEM_TRY(cdem_table_add_column(table, name[c], CDEM_COLUMN_REAL, "", fault));
  for (int b = 0; b < bins; b++) {
    double from = low * pow(high / low, (double)b / bins);
    double to = low * pow(high / low, (double)(b + 1) / bins);
    const double row[3] = {sqrt(from * to), (double)count[b],
                           (double)count[b] / fmax(1.0, all) / (to - from)};
    CDEM_TRY(cdem_table_add_row(table, fault));
    for (int c = 0; c < 3; c++)
      cdem_table_set_real(table, c, row[c]);
  }
  return CDEM_OK;
}

cdem_status cdem_push_distribution(int64_t contacts, const cdem_push *push, int bins, double low,
                                   double high, cdem_table *table, cdem_fault *fault) {
  CDEM_REQUIRE(bins >= 1 && bins <= 1000000, fault, CDEM_USAGE,
               "%d bins of a distribution; choose 1 to 1000000", bins);
  CDEM_REQUIRE(low > 0.0 && high > low && isfinite(high), fault, CDEM_USAGE,
               "logarithmic bins from %g to %g means; both must be positive, the second larger",
               low, high);
  double sum = 0.0, all = 0.0;
  for (int64_t k = 0; k < contacts; k++)
    if (push[k].push > 0.0 && push[k].b >= 0) {
      sum += push[k].push;
      all += 1.0;
    }
  int64_t *count;
  CDEM_NEW(count, bins, fault);
  for (int64_t k = 0; k < contacts; k++) {
    double part = push[k].push > 0.0 && push[k].b >= 0 ? push[k].push / (sum / all) : 0.0;
    if (part < low || part >= high)
      continue;
    int at = (int)(log(part / low) / log(high / low) * bins);
    count[at < bins ? at : bins - 1]++;
  }
  cdem_table made = {0};
  cdem_status status = put_rows(count, bins, low, high, all, &made, fault);
  free(count);
  if (status == CDEM_OK)
    *table = made;
  else
    cdem_table_release(&made);
  return status;
}

/* ---- rigid grains ---- */

cdem_status cdem_dem_pushes(const cdem_dem *dem, int64_t *contacts, cdem_push **push,
                            cdem_fault *fault) {
  cdem_dem_contact *from;
  cdem_push *list;
  int64_t all, count = 0;
  CDEM_TRY(cdem_dem_contacts(dem, &all, &from, fault));
  list = cdem_allocate(all, sizeof *list, fault);
  for (int64_t k = 0; list != NULL && k < all; k++)
    if (from[k].push > 0.0) {
      list[count] = (cdem_push){.a = from[k].a, .b = from[k].b, .push = from[k].push};
      memcpy(list[count].normal, from[k].normal, sizeof list->normal);
      memcpy(list[count++].point, from[k].point, sizeof list->point);
    }
  free(from);
  if (list == NULL)
    return CDEM_MEMORY;
  *contacts = count;
  *push = list;
  return CDEM_OK;
}
