/* The reflection of a plane wave at the interface, derived: docs/theory/bsm-waves.md, eqs (5)-(14).
 * Units: a, mass of a grain and stiffness of a bond are 1.
 *
 * Unknowns of one frequency: R, the grains of the last elements of the fine region, U_0 and U_1.
 * What is left of these grains is e^(ikx) + R e^(-ikx), what is right of U_1 its outgoing wave. */
#include "base/memory.h"
#include "verify/bsm_waves.h"

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double complex number;
static const double pi = 3.14159265358979323846;

typedef struct {
  int n, grains;    /* per element, and of the unknowns */
  double place;     /* b/a */
  double step;      /* of the grains */
  cdem_bsm_way way; /* eq. (11), or with acceleration (10) */
  double w;         /* angular frequency */
  double fine2;     /* squared frequency that the leapfrog of the grains has, eq. (5) */
  double body2;     /* ... and that of the body, m times as slow */
  number first;     /* part of the interface grains' motion at w itself, eq. (12) */
  number others;    /* sum over the others of c_p mu_p */
} wave;

static double leapfrog2(double w, double step) {
  double s = 2.0 / step * sin(0.5 * w * step);
  return s * s;
}

/* The factor from one mass to the next of the wave that goes away (or fades), of cos(angle) =
 * `cosine`; sign: of the frequency. */
static number outgoing(double cosine, double sign) {
  if (fabs(cosine) <= 1.0)
    return cosine + I * sign * sqrt(1.0 - cosine * cosine);
  return cosine - copysign(sqrt(cosine * cosine - 1.0), cosine);
}

/* ---- interface grains within a step of the body ---- */

/* Their place after s of m steps, with 1 at the start: velocity v_n and constant acceleration a_n
 * (eq. 10), or the velocity v_(n+1/2) (eq. 11). */
static number at_step(const wave *q, int m, int s) {
  double long_step = m * q->step, t = s * q->step;
  double turn = 0.5 * q->w * long_step;
  if (q->way == CDEM_BSM_VELOCITY)
    return 1.0 + (cexp(-2.0 * I * turn) - 1.0) * t / long_step;
  number velocity = -I * sin(2.0 * turn) / long_step;
  double acceleration = -4.0 / (long_step * long_step) * sin(turn) * sin(turn);
  return 1.0 + velocity * t + 0.5 * acceleration * t * t;
}

/* c_p, eq. (12), and mu_p of the frequency w + 2 pi p/(m dt). */
static void overtone(const wave *q, int m, int p, number *part, number *factor) {
  double shifted = q->w + 2.0 * pi * p / (m * q->step);
  number sum = 0.0;
  for (int s = 0; s < m; s++)
    sum += at_step(q, m, s) * cexp(I * shifted * s * q->step);
  double cosine = 1.0 - 0.5 * leapfrog2(shifted, q->step);
  double wrapped = remainder(shifted, 2.0 * pi / q->step);
  *part = sum / m;
  *factor = outgoing(cosine, copysign(1.0, wrapped));
}

static void sum_overtones(wave *q, int m) {
  number part, factor;
  q->others = 0.0;
  overtone(q, m, 0, &q->first, &factor);
  for (int p = 1; p < m; p++) {
    overtone(q, m, p, &part, &factor);
    q->others += part * factor;
  }
}

/* What the overtones do in the sum of N_0 times the forces on fine grains. */
static number overtone_forces(const wave *q, int m) {
  number sum = 0.0, part, factor;
  for (int p = 1; p < m; p++) {
    overtone(q, m, p, &part, &factor);
    double w2 = leapfrog2(q->w + 2.0 * pi * p / (m * q->step), q->step);
    number at = factor;
    for (int j = q->n - 1; j >= 0; j--, at *= factor)
      sum -= (q->place + j) / q->n * w2 * part * at;
  }
  return sum;
}

/* ---- the system ---- */

typedef struct {
  int size;
  number *a, *b; /* [size][size], [size] */
} linear_system;

static void add_to(linear_system *s, int row, int column, number value) {
  s->a[(int64_t)row * s->size + column] += value;
}

/* Rows of the grains: u_0 of the wave outside, then the equation of motion of each. */
static void put_grains(const wave *q, number k, linear_system *s) {
  int g = q->grains;
  double beta = q->place / q->n;
  add_to(s, 0, 0, -1.0);
  add_to(s, 0, 1, 1.0);
  s->b[0] = 1.0;
  for (int i = 0; i < g; i++) {
    add_to(s, 1 + i, 1 + i, 2.0 - q->fine2);
    if (i > 0)
      add_to(s, 1 + i, i, -1.0);
    if (i + 1 < g)
      add_to(s, 1 + i, 2 + i, -1.0);
  }
  add_to(s, 1, 0, -k);
  s->b[1] = 1.0 / k;
  add_to(s, g, g + 1, -q->first * (1.0 - beta));
  add_to(s, g, g + 2, -q->first * beta);
}

/* Shape functions of the layer's nodes at its grains, n [grains][nodes], and M = N^T N. */
static void put_shapes(const wave *q, int nodes, double *n, double *m) {
  for (int i = 0; i < q->grains; i++) {
    double at = (i + q->place) / q->n;
    int cell = i / q->n;
    n[i * nodes + cell] = 1.0 + cell - at;
    n[i * nodes + cell + 1] = at - cell;
    for (int k = cell; k < cell + 2; k++)
      for (int l = cell; l < cell + 2; l++)
        m[k * nodes + l] += n[i * nodes + k] * n[i * nodes + l];
  }
}

/* Forces of the layer: c Q (u_n - u_(n-1))/dt, Q = 1 - N M^-1 N^T of its own elements. */
static cdem_status put_layer(const wave *q, double rate, linear_system *s, cdem_fault *fault) {
  int grains = q->grains, nodes = grains / q->n + 1;
  number lag = rate * (1.0 - cexp(I * q->w * q->step)) / q->step;
  double *n, *m, *d;
  CDEM_NEW(n, 2 * (int64_t)grains * nodes + (int64_t)nodes * nodes, fault);
  d = n + (int64_t)grains * nodes; /* M^-1 N^T, its columns one after the other */
  m = d + (int64_t)grains * nodes;
  put_shapes(q, nodes, n, m);
  memcpy(d, n, (size_t)grains * (size_t)nodes * sizeof *d);
  int info = LAPACKE_dposv(LAPACK_COL_MAJOR, 'U', nodes, grains, m, nodes, d, nodes);
  for (int i = 0; i < grains; i++)
    for (int a = 0; a < grains; a++) {
      double p = 0.0;
      for (int k = 0; k < nodes; k++)
        p += n[i * nodes + k] * d[a * nodes + k];
      add_to(s, 1 + i, 1 + a, lag * ((i == a ? 1.0 : 0.0) - p));
    }
  free(n);
  CDEM_REQUIRE(info == 0, fault, CDEM_NUMERIC, "the grains do not determine the layer's nodes");
  return CDEM_OK;
}

/* Rows of the two nodes, eqs (7), (8). */
static void put_nodes(const wave *q, number next, linear_system *s) {
  int g = q->grains, node = g + 1;
  double h = q->n, beta = q->place / h, share[2] = {1.0 - beta, beta};
  number bond = 1.0 - q->others; /* of u_I in the force, eq. (13) */
  for (int i = 0; i < 2; i++) {
    add_to(s, node + i, g, -share[i]);
    for (int k = 0; k < 2; k++)
      add_to(s, node + i, node + k, share[i] * share[k] * bond + (i == k ? 1.0 : -1.0) / h);
  }
  add_to(s, node, node, -0.5 * h * q->body2);
  add_to(s, node + 1, node + 1, -h * q->body2 + (1.0 - next) / h);
}

/* Virtual work: the grains' masses in the edge node, and their forces on it. */
static void put_virtual_work(const wave *q, int m, linear_system *s) {
  int node = q->grains + 1;
  double beta = q->place / q->n;
  number forces = overtone_forces(q, m);
  for (int j = 0; j < q->n; j++) {
    double shape = (q->place + j) / q->n;
    add_to(s, node, node, -shape * q->body2);
    add_to(s, node, 1 + q->grains - q->n + j, shape * q->fine2);
  }
  add_to(s, node, node, -forces * (1.0 - beta));
  add_to(s, node, node + 1, -forces * beta);
}

/* ---- one wave ---- */

static cdem_status solve(const cdem_bsm_chain *chain, const wave *q, double ka, linear_system *s,
                         lapack_int *pivot, cdem_bsm_reflection *derived, cdem_fault *fault) {
  int m = chain->cycles > 1 ? chain->cycles : 1;
  double h = q->n;
  number next = outgoing(1.0 - 0.5 * q->body2 * h * h, 1.0);
  put_grains(q, cexp(I * ka), s);
  put_nodes(q, next, s);
  if (chain->layers > 0)
    CDEM_TRY(put_layer(q, chain->rate / h, s, fault));
  if (chain->form == CDEM_BSM_VIRTUAL_WORK)
    put_virtual_work(q, m, s);
  int info = LAPACKE_zgesv(LAPACK_ROW_MAJOR, s->size, 1, s->a, s->size, pivot, s->b, 1);
  CDEM_REQUIRE(info == 0, fault, CDEM_NUMERIC, "k a = %g: no single reflected wave", ka);
  double node = cabs(s->b[q->grains + 2]);
  *derived = (cdem_bsm_reflection){cabs(s->b[0]), node * node * cimag(next) / h / sin(ka)};
  return CDEM_OK;
}

cdem_status cdem_bsm_waves_derive(const cdem_bsm_chain *chain, double ka,
                                  cdem_bsm_reflection *derived, cdem_fault *fault) {
  int m = chain->cycles > 1 ? chain->cycles : 1;
  wave q = {.n = chain->ratio,
            .grains = chain->ratio * (chain->layers > 1 ? chain->layers : 1),
            .place = chain->place > 0.0 ? chain->place : 0.5,
            .step = chain->step > 0.0 ? chain->step : 0.2,
            .way = chain->way};
  linear_system s = {.size = q.grains + 3};
  lapack_int *pivot;
  q.w = 2.0 / q.step * asin(q.step * sin(0.5 * ka));
  q.fine2 = leapfrog2(q.w, q.step);
  q.body2 = leapfrog2(q.w, m * q.step);
  sum_overtones(&q, m);
  CDEM_NEW(s.a, (int64_t)s.size * (s.size + 1), fault);
  s.b = s.a + (int64_t)s.size * s.size;
  pivot = cdem_allocate(s.size, sizeof *pivot, fault);
  cdem_status status =
      pivot != NULL ? solve(chain, &q, ka, &s, pivot, derived, fault) : CDEM_MEMORY;
  free(pivot);
  free(s.a);
  return status;
}
