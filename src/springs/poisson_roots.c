/* Critical ratios: zeros of the discriminant of a pencil, in extended precision (see poisson.h). */
#include "springs/poisson.h"

#include <stdlib.h>
#include <string.h>

#if defined(__SIZEOF_FLOAT128__)
typedef __float128 wide;
#else
typedef long double wide;
#endif

enum { DEGREE = 6, CANDIDATES = 2 * DEGREE };

/* c[0] + c[1] x + ..., x in [-1, 1] over the range of the pencil. */
typedef struct {
  wide c[DEGREE + 1];
} polynomial;

typedef struct {
  int size;
  polynomial discriminant; /* (gap)^2 (2x2), product of the three squared gaps (3x3) */
  polynomial j2, j3;       /* 3x3: tr M^2/2 and det M of the traceless part M */
  polynomial norm;         /* squared Frobenius norm of the block itself */
  wide triple;             /* where all three values meet; 2 (outside) where they do not */
} invariants;

static wide magnitude(wide x) {
  return x < 0 ? -x : x;
}

static wide evaluate(const polynomial *p, wide x) {
  wide sum = 0;
  for (int i = DEGREE; i >= 0; i--)
    sum = sum * x + p->c[i];
  return sum;
}

static polynomial product(const polynomial *p, const polynomial *q) {
  polynomial r = {{0}};
  for (int i = 0; i <= DEGREE; i++)
    for (int j = 0; i + j <= DEGREE; j++)
      r.c[i + j] += p->c[i] * q->c[j];
  return r;
}

static void add(polynomial *p, wide factor, const polynomial *q) {
  for (int i = 0; i <= DEGREE; i++)
    p->c[i] += factor * q->c[i];
}

/* k-th derivative over k!: the Taylor coefficient of order k at any x. */
static polynomial taylor(const polynomial *p, int k) {
  polynomial r = {{0}};
  for (int i = k; i <= DEGREE; i++) {
    wide binomial = 1;
    for (int j = 0; j < k; j++)
      binomial = binomial * (i - j) / (j + 1);
    r.c[i - k] = binomial * p->c[i];
  }
  return r;
}

static void add_product(polynomial *sum, wide factor, const polynomial *p, const polynomial *q) {
  polynomial r = product(p, q);
  add(sum, factor, &r);
}

static void build_invariants(const cdem_pencil *pencil, invariants *v) {
  int n = pencil->size;
  wide middle = ((wide)pencil->low + pencil->high) / 2,
       half = ((wide)pencil->high - pencil->low) / 2;
  polynomial m[9] = {{{0}}}, trace = {{0}};
  memset(v, 0, sizeof *v);
  v->size = n;
  for (int i = 0; i < n * n; i++) {
    m[i].c[0] = pencil->a[i] + middle * pencil->b[i];
    m[i].c[1] = half * pencil->b[i];
    add_product(&v->norm, 1, &m[i], &m[i]);
  }
  for (int i = 0; i < n; i++)
    add(&trace, 1, &m[(n + 1) * i]);
  for (int i = 0; i < n; i++)
    add(&m[(n + 1) * i], (wide)-1 / n, &trace);
  if (n == 2) {
    add_product(&v->discriminant, 4, &m[0], &m[0]);
    add_product(&v->discriminant, 4, &m[1], &m[2]);
    return;
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      add_product(&v->j2, (wide)0.5, &m[3 * i + j], &m[3 * j + i]);
  for (int j = 0; j < 3; j++) {
    polynomial minor = {{0}};
    int a = (j + 1) % 3, b = (j + 2) % 3;
    add_product(&minor, 1, &m[3 + a], &m[6 + b]);
    add_product(&minor, -1, &m[3 + b], &m[6 + a]);
    add_product(&v->j3, 1, &m[j], &minor);
  }
  polynomial squared = product(&v->j2, &v->j2);
  add_product(&v->discriminant, 4, &squared, &v->j2);
  add_product(&v->discriminant, -27, &v->j3, &v->j3);
}

/* Squared gap of the nearest two values over the squared norm. Near a double value of a traceless M
 * with values s and -s/2 +- gap/2 the discriminant is gap^2 (9 s^2/4)^2 = gap^2 (3 J2)^2. */
static double squared_gap(const invariants *v, wide x) {
  wide norm = evaluate(&v->norm, x), d = magnitude(evaluate(&v->discriminant, x));
  if (norm <= 0)
    return 0.0;
  if (v->size == 2)
    return (double)(d / norm);
  wide j2 = evaluate(&v->j2, x), j3 = magnitude(evaluate(&v->j3, x));
  /* All three values equal (J3 too, else they are three roots of unity apart). */
  wide tiny = (wide)CDEM_POISSON_TOUCH * CDEM_POISSON_TOUCH * norm;
  if (magnitude(j2) <= tiny)
    return j3 * j3 <= tiny * tiny * tiny ? 0.0 : 1.0;
  return (double)(d / (9 * j2 * j2 * norm));
}

/* Around a triple value the discriminant has a zero of sixth order, which even 113 bits smear over
 * 1e-6; J2, of second order there, tells where it is. */
static bool is_touch(const invariants *v, wide x) {
  return magnitude(x - v->triple) <= (wide)1e-5 ||
         squared_gap(v, x) <= CDEM_POISSON_TOUCH * CDEM_POISSON_TOUCH;
}

static wide find_triple(const invariants *v) {
  if (v->size == 2 || v->j2.c[2] == 0)
    return 2;
  wide x = -v->j2.c[1] / (2 * v->j2.c[2]);
  wide bound = (wide)CDEM_POISSON_TOUCH * CDEM_POISSON_TOUCH * evaluate(&v->norm, x);
  return magnitude(evaluate(&v->j2, x)) <= bound &&
                 squared_gap(v, x) <= CDEM_POISSON_TOUCH * CDEM_POISSON_TOUCH
             ? x
             : 2;
}

static wide bisect(const polynomial *p, wide low, wide high) {
  bool rising = evaluate(p, high) > 0;
  for (int i = 0; i < 116; i++) {
    wide middle = (low + high) / 2;
    if ((evaluate(p, middle) > 0) == rising)
      high = middle;
    else
      low = middle;
  }
  return (low + high) / 2;
}

/* Sign changes of p on (-1, 1), ascending. Between neighbouring zeros of the derivative p is
 * monotonic, so each holds at most one; starting from the constant last derivative, all are found.
 * turn [DEGREE + 2] receives the zeros of the first derivative at 1 .. *turning, on the way. */
static int sign_changes(const polynomial *p, int degree, wide *zero, wide *turn, int *turning) {
  int turns = 1, zeros = 0;
  turn[0] = -1;
  for (int k = degree - 1; k >= 0; k--) {
    polynomial q = taylor(p, k);
    turn[turns] = 1;
    *turning = turns - 1;
    zeros = 0;
    for (int i = 0; i < turns; i++) {
      wide left = evaluate(&q, turn[i]), right = evaluate(&q, turn[i + 1]);
      if ((left < 0 && right > 0) || (left > 0 && right < 0))
        zero[zeros++] = bisect(&q, turn[i], turn[i + 1]);
      else if (right == 0 && i + 1 < turns)
        zero[zeros++] = turn[i + 1]; /* exactly zero at a turning point: keep it as a turn */
    }
    for (turns = 1; k > 0 && turns <= zeros; turns++)
      turn[turns] = zero[turns - 1];
  }
  return zeros;
}

static int compare(const void *a, const void *b) {
  wide x = *(const wide *)a, y = *(const wide *)b;
  return (x > y) - (x < y);
}

/* Sign changes of the discriminant, and its turning points at which two values are equal. */
static int find_candidates(const invariants *v, wide *candidate) {
  wide turn[DEGREE + 2];
  int degree = v->size == 2 ? 2 : 6, turns;
  int count = sign_changes(&v->discriminant, degree, candidate, turn, &turns);
  for (int i = 1; i <= turns; i++)
    if (is_touch(v, turn[i]))
      candidate[count++] = turn[i];
  qsort(candidate, (size_t)count, sizeof *candidate, compare);
  return count;
}

/* No two values part between a and b. */
static bool same_zero(const invariants *v, wide a, wide b) {
  for (int i = 1; i < 8; i++)
    if (!is_touch(v, a + (b - a) * i / 8))
      return false;
  return true;
}

/* Highest order m, of the parity the sign change tells, for which the zeros of a cluster look like
 * one zero when seen from the distance `reach`; *x moves to the zero of the (m-1)-st derivative. */
static int order_of_zero(const polynomial *p, int degree, bool odd, wide reach, wide *x) {
  for (int m = degree - (degree % 2 == (odd ? 1 : 0) ? 0 : 1); m >= 1; m -= 2) {
    polynomial last = taylor(p, m - 1), slope = taylor(p, m);
    wide centre = *x;
    for (int i = 0; i < 20; i++) {
      wide rate = m * evaluate(&slope, centre);
      if (rate == 0)
        break;
      centre -= evaluate(&last, centre) / rate;
    }
    if (!(magnitude(centre - *x) < reach / 10))
      continue;
    wide leading = magnitude(evaluate(&slope, centre)), bound = leading / 1000, power = 1;
    for (int j = 0; j < m; j++)
      power *= reach;
    bool one = leading > 0;
    bound *= power;
    power = 1;
    for (int j = 0; j < m && one; j++, power *= reach) {
      polynomial t = taylor(p, j);
      one = magnitude(evaluate(&t, centre)) * power <= bound;
    }
    if (one) {
      *x = centre;
      return m;
    }
  }
  return odd ? 1 : 2;
}

static void add_root(const cdem_pencil *pencil, const invariants *v, wide x, int order, wide before,
                     wide after, cdem_poisson_roots *roots) {
  bool at_end = same_zero(v, x, -1) || same_zero(v, x, 1);
  if (roots->count == CDEM_POISSON_ROOTS || (at_end && !roots->double_everywhere))
    return;
  wide middle = ((wide)pencil->low + pencil->high) / 2,
       half = ((wide)pencil->high - pencil->low) / 2;
  cdem_poisson_root *root = &roots->root[roots->count++];
  root->nu = (double)(middle + half * x);
  root->from = before > 0 ? CDEM_FORM_DIAGONAL : CDEM_FORM_COMPLEX;
  root->to = after > 0 ? CDEM_FORM_DIAGONAL : CDEM_FORM_COMPLEX;
  root->order = order;
  if (v->size == 3) {
    root->upper = evaluate(&v->j3, x) < 0;
    root->triple = magnitude(x - v->triple) <= (wide)1e-5;
  }
}

static bool is_double_everywhere(const invariants *v) {
  for (int i = 0; i <= 32; i++)
    if (squared_gap(v, (wide)(i - 16) / 16) > CDEM_POISSON_TOUCH * CDEM_POISSON_TOUCH)
      return false;
  return true;
}

void cdem_poisson_find_roots(const cdem_pencil *pencil, cdem_poisson_roots *roots) {
  invariants v;
  build_invariants(pencil, &v);
  v.triple = find_triple(&v);
  *roots = (cdem_poisson_roots){.start = CDEM_FORM_DIAGONAL};
  roots->double_everywhere = is_double_everywhere(&v);
  if (roots->double_everywhere) {
    if (magnitude(v.triple) < 1) /* only the third value can still meet the two */
      add_root(pencil, &v, v.triple, DEGREE, 1, 1, roots);
    return;
  }
  wide candidate[CANDIDATES];
  const polynomial *d = &v.discriminant;
  int count = find_candidates(&v, candidate), degree = v.size == 2 ? 2 : 6;
  wide below = count > 0 ? (candidate[0] - 1) / 2 : 0; /* a place left of the first candidate */
  roots->start = evaluate(d, below) > 0 ? CDEM_FORM_DIAGONAL : CDEM_FORM_COMPLEX;
  for (int i = 0, next; i < count; i = next) {
    for (next = i + 1; next < count && same_zero(&v, candidate[next - 1], candidate[next]); next++)
      continue;
    wide above = ((next < count ? candidate[next] : 1) + candidate[next - 1]) / 2;
    wide x = (candidate[i] + candidate[next - 1]) / 2, reach = (wide)1e-3;
    if (reach > (x - below) / 5)
      reach = (x - below) / 5;
    if (reach > (above - x) / 5)
      reach = (above - x) / 5;
    wide before = evaluate(d, below), after = evaluate(d, above);
    int order = order_of_zero(d, degree, (before > 0) != (after > 0), reach, &x);
    add_root(pencil, &v, x, order, before, after, roots);
    below = above;
  }
}
