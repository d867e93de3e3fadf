/* A run and its scaled twin, number by number. */
#include "base/bits.h"
#include "io/io.h"
#include "io/run_files.h"
#include "run/run.h"
#include "run/scale.h"
#include "verify/scaling.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Arrays of a checkpoint have no units, and some hold records of several quantities: the numbers of
 * one array may follow so many powers of two, within these bounds. */
enum { QUANTITIES = 10, MOST_POWER = 40 };

static void note_off(cdem_scaling_difference *d, const char *format, const char *name, int64_t at,
                     double a, double b) {
  if (d->off++ == 0)
    snprintf(d->first, sizeof d->first, format, name, (long long)at, a, b);
}

static bool same(double a, double b) {
  return a == b || (isnan(a) && isnan(b));
}

/* ---- the history ---- */

static double value_at(const cdem_table *table, int64_t row, int column) {
  const cdem_value *value = cdem_table_at(table, row, column);
  return value->absent ? NAN : value->real;
}

/* The largest number of the columns of one dimension: a column of what cancels, such as the error
 * of an energy book, is small beside what it is made of. */
static double largest_of_kind(const cdem_table *table, cdem_dimension dimension) {
  const cdem_dimension none = CDEM_DIMENSIONLESS;
  double largest = memcmp(&dimension, &none, sizeof none) == 0 ? 1.0 : 0.0;
  for (int c = 0; c < table->columns; c++) {
    cdem_dimension own;
    bool like = cdem_dimension_of_unit(table->column[c].unit, &own) &&
                memcmp(&own, &dimension, sizeof own) == 0;
    for (int64_t r = 0; like && r < table->rows; r++)
      largest = fmax(largest, fabs(value_at(table, r, c))); /* passes over NaN */
  }
  return largest;
}

static void compare_column(const cdem_table *one, const cdem_table *other, int c, double factor,
                           double largest, cdem_scaling_difference *d) {
  double apart = 0.0;
  for (int64_t r = 0; r < one->rows; r++) {
    double a = value_at(one, r, c) * factor, b = value_at(other, r, c);
    d->numbers++;
    if (same(a, b))
      continue;
    note_off(d, "%s, row %lld: %.17g and %.17g", one->column[c].name, r, a, b);
    apart = isnan(a) || isnan(b) ? INFINITY : fmax(apart, fabs(a - b) / largest);
  }
  if (apart > d->apart) {
    d->apart = apart;
    snprintf(d->worst, sizeof d->worst, "%s", one->column[c].name);
  }
}

static cdem_status compare_histories(const cdem_table *one, const cdem_table *other,
                                     const cdem_ratios *ratios, cdem_scaling_difference *d,
                                     cdem_fault *fault) {
  if (one->rows != other->rows || one->columns != other->columns) {
    note_off(d, "%s %lld: %g and %g", "rows", 0, (double)one->rows, (double)other->rows);
    d->apart = INFINITY;
    return CDEM_OK;
  }
  for (int c = 0; c < one->columns; c++) {
    cdem_dimension dimension;
    CDEM_REQUIRE(cdem_dimension_of_unit(one->column[c].unit, &dimension), fault, CDEM_NUMERIC,
                 "the column '%s' has the unit '%s', whose dimension is not known",
                 one->column[c].name, one->column[c].unit);
    double factor = cdem_ratio(ratios, dimension);
    compare_column(one, other, c, factor, factor * largest_of_kind(one, dimension), d);
  }
  return CDEM_OK;
}

/* ---- the checkpoint ---- */

/* The power n of b = 2^n a; false where there is none. Zeros fit any. */
static bool find_power(double a, double b, int *n) {
  int ea, eb;
  if (!isfinite(a) || !isfinite(b) || a == 0.0 || b == 0.0)
    return same(a, b);
  double part = frexp(a, &ea), other = frexp(b, &eb);
  *n = eb - ea;
  return part == other && abs(*n) <= MOST_POWER;
}

/* The first number that fits none of the powers of its array; -1: all do. */
static int64_t first_off(const double *a, const double *b, int64_t count) {
  int power[QUANTITIES], powers = 0;
  for (int64_t i = 0; i < count; i++) {
    int n = 0, k = 0;
    if (cdem_same_bits(a[i], b[i])) /* whole numbers of a record, too */
      continue;
    if (!find_power(a[i], b[i], &n))
      return i;
    while (k < powers && power[k] != n)
      k++;
    if (k == QUANTITIES)
      return i;
    if (k == powers)
      power[powers++] = n;
  }
  return -1;
}

/* Wall times stand in the state, too. */
static bool is_of_the_clock(const char *name) {
  return strncmp(name, "run/", 4) == 0;
}

static void compare_arrays(const cdem_array *a, const cdem_array *b, cdem_scaling_difference *d) {
  if (b == NULL || b->count != a->count || b->type != a->type) {
    note_off(d, "array %s of %lld: %g and %g", a->name, a->count, (double)a->count,
             b != NULL ? (double)b->count : 0.0);
    return;
  }
  d->numbers += a->count;
  bool records = a->type == CDEM_ARRAY_BYTE && a->count % (int64_t)sizeof(double) == 0;
  if (a->type == CDEM_ARRAY_REAL || records) { /* bytes: records of numbers */
    int64_t at = first_off(a->data, b->data, records ? a->count / 8 : a->count);
    if (at >= 0)
      note_off(d, "array %s, number %lld: %.17g and %.17g", a->name, at,
               ((const double *)a->data)[at], ((const double *)b->data)[at]);
  } else if (memcmp(a->data, b->data, (size_t)a->count * cdem_array_size(a->type)) != 0) {
    note_off(d, "array %s of %lld whole numbers: they differ", a->name, a->count, 0.0, 0.0);
  }
}

static void compare_states(const cdem_state *one, const cdem_state *other,
                           cdem_scaling_difference *d) {
  for (int64_t i = 0; i < one->arrays; i++)
    if (one->array[i].count > 0 && !is_of_the_clock(one->array[i].name))
      compare_arrays(&one->array[i], cdem_state_find(other, one->array[i].name), d);
}

/* ---- the runs ---- */

/* What one run leaves. */
typedef struct {
  cdem_table history;
  cdem_state state;
} remains;

static cdem_status run_one(const char *scratch, const char *name, remains *left,
                           cdem_fault *fault) {
  char path[160], folder[128];
  cdem_run_summary summary = {0};
  snprintf(path, sizeof path, "%s/%s.yaml", scratch, name);
  snprintf(folder, sizeof folder, "%s/%s", scratch, name);
  const cdem_run_options options = {.path = path, .folder = folder, .threads = 1};
  CDEM_TRY(cdem_run(&options, &summary, fault));
  cdem_run_summary_release(&summary);
  snprintf(path, sizeof path, "%s/history.csv", folder);
  CDEM_TRY(cdem_read_history(path, &left->history, fault));
  snprintf(path, sizeof path, "%s/checkpoint.h5", folder);
  return cdem_read_state(path, &left->state, fault);
}

/* original.yaml and scaled.yaml. */
static cdem_status write_both(const char *scratch, const char *text, cdem_scaling scaling,
                              cdem_fault *fault) {
  char path[96], scaled[96];
  cdem_scaled_table table = {0};
  snprintf(path, sizeof path, "%s/original.yaml", scratch);
  snprintf(scaled, sizeof scaled, "%s/scaled.yaml", scratch);
  CDEM_TRY(cdem_write_text(path, text, (int64_t)strlen(text), fault));
  const cdem_scale_options options = {.path = path, .output = scaled, .scaling = scaling};
  CDEM_TRY(cdem_scale_case(&options, &table, fault));
  cdem_scaled_table_release(&table);
  return CDEM_OK;
}

static cdem_status run_both(const char *scratch, const char *text, cdem_scaling scaling,
                            remains left[2], cdem_fault *fault) {
  CDEM_TRY(write_both(scratch, text, scaling, fault));
  CDEM_TRY(run_one(scratch, "original", &left[0], fault));
  return run_one(scratch, "scaled", &left[1], fault);
}

static void release(remains left[2]) {
  for (int i = 0; i < 2; i++) {
    cdem_table_release(&left[i].history);
    cdem_state_release(&left[i].state);
  }
}

cdem_status cdem_scaling_last(const char *text, cdem_scaling scaling, const char *column,
                              double value[2], cdem_fault *fault) {
  char scratch[64];
  remains left[2] = {{.history = {0}}, {.history = {0}}};
  CDEM_TRY(cdem_make_scratch(scratch, fault));
  cdem_status status = run_both(scratch, text, scaling, left, fault);
  cdem_remove_scratch(scratch);
  for (int i = 0; i < 2 && status == CDEM_OK; i++) {
    const cdem_table *history = &left[i].history;
    int c = cdem_table_find(history, column);
    if (c < 0 || history->rows == 0)
      status = cdem_fail(fault, CDEM_NUMERIC, "there is no column '%s'", column);
    else
      value[i] = value_at(history, history->rows - 1, c);
  }
  release(left);
  return status;
}

cdem_status cdem_scaling_pair(const char *text, const cdem_ratios *ratios, bool bits,
                              cdem_scaling_difference *difference, cdem_fault *fault) {
  char scratch[64];
  remains left[2] = {{.history = {0}}, {.history = {0}}};
  cdem_scaling_difference d = {0};
  CDEM_TRY(cdem_make_scratch(scratch, fault));
  cdem_status status = run_both(scratch, text, cdem_scaling_exact(*ratios), left, fault);
  cdem_remove_scratch(scratch);
  if (status == CDEM_OK)
    status = compare_histories(&left[0].history, &left[1].history, ratios, &d, fault);
  if (status == CDEM_OK && bits)
    compare_states(&left[0].state, &left[1].state, &d);
  release(left);
  if (status == CDEM_OK)
    *difference = d;
  return status;
}
