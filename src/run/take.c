/* One number out of the rows of a history; tests/run/compare.c holds each against rows made by
 * hand. */
#include "run/take.h"

#include "cases/case.h"

#include <math.h>

static double value_at(const cdem_table *history, int64_t row, int column) {
  const cdem_value *value = cdem_table_at(history, row, column);
  return value->absent ? NAN : value->real;
}

/* Sum of columns in a row; NaN where one has no value. */
static double sum_of(const cdem_table *history, int64_t row, int columns, const int *column) {
  double sum = 0.0;
  for (int c = 0; c < columns; c++)
    sum += value_at(history, row, column[c]);
  return sum;
}

/* The slope of the line that fits best over time; sums about the first row, whose digits would
 * else be lost in the squares. */
typedef struct {
  double t0, v0, t, v, tt, tv;
} line;

static void line_add(line *l, bool first, double time, double value) {
  if (first)
    *l = (line){.t0 = time, .v0 = value};
  double t = time - l->t0, v = value - l->v0;
  l->t += t;
  l->v += v;
  l->tt += t * t;
  l->tv += t * v;
}

/* Squares about the mean so far (Welford 1962): a first row far from the others costs no digits. */
typedef struct {
  double mean, squares;
} spread;

static void spread_add(spread *s, double count, double value) {
  double off = value - s->mean;
  s->mean += off / count;
  s->squares += off * (value - s->mean);
}

/* What one walk over the rows gathers. */
typedef struct {
  double n, sum, found;
  int64_t row; /* of `found` */
  line line;
  spread spread;
} gathered;

static bool is_better(int take, double value, double found) {
  bool most = take == CDEM_TAKE_MAX || take == CDEM_TAKE_PLACE_OF_MAX,
       least = take == CDEM_TAKE_MIN || take == CDEM_TAKE_PLACE_OF_MIN;
  return take == CDEM_TAKE_LAST || (most && value > found) || (least && value < found);
}

static gathered gather(const cdem_table *history, const cdem_run_taking *taking) {
  gathered g = {.found = NAN, .row = -1};
  int clock = cdem_table_find(history, "time");
  for (int64_t r = 0; r < history->rows; r++) {
    double v = taking->factor * sum_of(history, r, taking->columns, taking->column),
           time = clock >= 0 ? value_at(history, r, clock) : 0.0;
    if (isnan(v) || time < taking->from || time > taking->to)
      continue;
    bool first = g.n == 0.0;
    g.n += 1.0;
    g.sum += v;
    line_add(&g.line, first, time, v);
    spread_add(&g.spread, g.n, v);
    if (first || is_better(taking->take, v, g.found)) {
      g.found = v;
      g.row = r;
    }
  }
  return g;
}

double cdem_run_take(const cdem_table *history, const cdem_run_taking *taking) {
  const gathered g = gather(history, taking);
  const line *l = &g.line;
  switch (taking->take) {
  case CDEM_TAKE_MEAN:
    return g.n > 0.0 ? g.sum / g.n : NAN;
  case CDEM_TAKE_SLOPE:
    return (g.n * l->tv - l->t * l->v) / (g.n * l->tt - l->t * l->t);
  case CDEM_TAKE_SCATTER:
    return g.n > 1.0 ? sqrt(g.spread.squares / (g.n - 1.0)) : NAN;
  case CDEM_TAKE_PLACE_OF_MAX:
  case CDEM_TAKE_PLACE_OF_MIN:
    return g.row >= 0 ? value_at(history, g.row, taking->along) : NAN;
  default:
    return g.found;
  }
}
