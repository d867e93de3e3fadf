/* How fast stiffness blocks become spring sets, on one core and on several, beside what the machine
 * can do at most. Blocks are those of randomly distorted hexahedra (28 node pairs each: edges, face
 * and body diagonals) of random Poisson's ratio; and generic random blocks.
 *
 * Everything is timed in turn, in one run, several times over; the table shows medians. Nothing is
 * asserted: speed belongs to the machine.
 *
 * Arithmetic of a 3x3 block in the closed form, counted in the instructions of the AVX-512 kernels
 * (a fused multiply-add is two operations; divisions and roots one each):
 *
 *     stage        operations   of them / and sqrt
 *     single           210            5
 *     directions       230           12
 *     finish           243            8
 *     sum              683           25
 *
 * The bound takes every operation for half a fused multiply-add, which no division is. */
#include "base/simd.h"
#include "bench.h"
#include "springs/springs.h"

#include <lapacke.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
  HEXAHEDRA = 64,
  PAIRS = 28,
  BLOCKS = HEXAHEDRA * PAIRS, /* as many as stay in the caches with their sets */
  STREAM = 128 * BLOCKS,      /* as many as do not */
  ROUNDS = 15,
  OPERATIONS = 683
};

/* Not static: the compilers choose among versions of a function by its symbol. */
double bench_multiply_add(int64_t rounds);
void bench_fill(double *restrict to, int64_t vectors, double value);

static double now(void) {
  return clock_now(CLOCK_MONOTONIC);
}

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(const double *values) {
  double sorted[ROUNDS];
  memcpy(sorted, values, sizeof sorted);
  qsort(sorted, ROUNDS, sizeof *sorted, compare);
  return sorted[ROUNDS / 2];
}

static void put_block(double *s, int64_t i, const double block[9]) {
  for (int e = 0; e < 9; e++)
    s[i / 8 * 72 + e * 8 + i % 8] = block[e];
}

static void get_block(const double *s, int64_t i, double block[9]) {
  for (int e = 0; e < 9; e++)
    block[e] = s[i / 8 * 72 + e * 8 + i % 8];
}

/* Gradients of the eight trilinear functions at a point; returns det J. */
static double gradients(double xyz[8][3], const double xi[3], double g[8][3]) {
  static const int corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  double local[8][3], jacobian[9] = {0}, inverse[9];
  for (int a = 0; a < 8; a++) {
    double f[3];
    for (int c = 0; c < 3; c++)
      f[c] = 0.5 * (1.0 + corner[a][c] * xi[c]);
    for (int c = 0; c < 3; c++)
      local[a][c] = 0.5 * corner[a][c] * f[(c + 1) % 3] * f[(c + 2) % 3];
    for (int e = 0; e < 9; e++)
      jacobian[e] += local[a][e / 3] * xyz[a][e % 3]; /* row: xi, column: x */
  }
  double det = cdem_inverse3(jacobian, inverse);
  for (int a = 0; a < 8; a++)
    for (int i = 0; i < 3; i++)
      g[a][i] = inverse[3 * i] * local[a][0] + inverse[3 * i + 1] * local[a][1] +
                inverse[3 * i + 2] * local[a][2];
  return det;
}

/* S_ij = -K_ij of a distorted hexahedron, 2x2x2 points: K_ij = sum w (lambda g_i g_j^T + mu g_j
 * g_i^T + mu (g_i . g_j) I). */
static void hexahedron(cdem_random *random, double *s, int64_t first) {
  double xyz[8][3], g[8][3], k[PAIRS][9] = {{0}};
  double nu = cdem_random_uniform(random, 0.05, 0.45);
  double lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 / (1.0 + nu);
  for (int a = 0; a < 8; a++) {
    const int corner[3] = {(a + 1) / 2 % 2, a / 2 % 2, a / 4};
    for (int c = 0; c < 3; c++)
      xyz[a][c] = corner[c] + cdem_random_uniform(random, -0.2, 0.2);
  }
  for (int point = 0; point < 8; point++) {
    double xi[3];
    for (int c = 0; c < 3; c++)
      xi[c] = (point >> c & 1 ? 1.0 : -1.0) / sqrt(3.0);
    double det = gradients(xyz, xi, g);
    for (int i = 0, pair = 0; i < 8; i++)
      for (int j = i + 1; j < 8; j++, pair++)
        for (int e = 0; e < 9; e++)
          k[pair][e] -= det * (lambda * g[i][e / 3] * g[j][e % 3] + mu * g[j][e / 3] * g[i][e % 3] +
                               (e % 4 == 0 ? mu * cdem_dot3(g[i], g[j]) : 0.0));
  }
  for (int pair = 0; pair < PAIRS; pair++)
    put_block(s, first + pair, k[pair]);
}

/* The straightforward way: eigenvalues and vectors by LAPACKE_dgeev, P real, its inverse by
 * LAPACKE_dgetrf and LAPACKE_dgetri. Returns something that depends on all of it. */
static double plain_lapack(const double *s, int64_t n) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; i++) {
    double block[9], wr[3], wi[3], p[9], unused[1];
    lapack_int pivot[3];
    get_block(s, i, block);
    LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'V', 3, block, 3, wr, wi, unused, 3, p, 3);
    LAPACKE_dgetrf(LAPACK_ROW_MAJOR, 3, 3, p, 3, pivot);
    LAPACKE_dgetri(LAPACK_ROW_MAJOR, 3, p, 3, pivot);
    sum += wr[0] + p[8];
  }
  return sum;
}

static void robust(const double *s, int64_t n, cdem_spring_set *set) {
  for (int64_t i = 0; i < n; i++) {
    double block[9];
    get_block(s, i, block);
    cdem_springs_from_block(block, 3, false, &set[i], NULL);
  }
}

/* 2 x 8 x 12 x rounds operations without memory: twelve independent chains hide the latency. */
CDEM_MULTIVERSION double bench_multiply_add(int64_t rounds) {
  cdem_vec8 a0 = {0.1}, a1 = {0.2}, a2 = {0.3}, a3 = {0.4}, a4 = {0.5}, a5 = {0.6}, a6 = {0.7},
            a7 = {0.8};
  cdem_vec8 b0 = {1.1}, b1 = {1.2}, b2 = {1.3}, b3 = {1.4};
  const cdem_vec8 x = {0.999, 0.998, 0.997, 0.996, 0.995, 0.994, 0.993, 0.992};
  const cdem_vec8 y = {1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3, 7e-3, 8e-3};
  for (int64_t r = 0; r < rounds; r++) {
    a0 = a0 * x + y, a1 = a1 * x + y, a2 = a2 * x + y, a3 = a3 * x + y;
    a4 = a4 * x + y, a5 = a5 * x + y, a6 = a6 * x + y, a7 = a7 * x + y;
    b0 = b0 * x + y, b1 = b1 * x + y, b2 = b2 * x + y, b3 = b3 * x + y;
  }
  cdem_vec8 sum = a0 + a1 + a2 + a3 + a4 + a5 + a6 + a7 + b0 + b1 + b2 + b3;
  return sum[0] + sum[3] + sum[7];
}

CDEM_MULTIVERSION void bench_fill(double *restrict to, int64_t vectors, double value) {
  const cdem_vec8 v = {value, value, value, value, value, value, value, value};
  for (int64_t i = 0; i < vectors; i++)
    *(cdem_vec8_at *)(to + 8 * i) = v;
}

typedef struct {
  double plain[ROUNDS], robust[ROUNDS], fast[ROUNDS], random[ROUNDS], stream[ROUNDS];
  double threads[2][ROUNDS]; /* both stream: 1 and 2 threads */
  double peak[ROUNDS], store[ROUNDS];
} timings;

/* Sets of all STREAM blocks by `threads` threads, a chunk of BLOCKS each time. */
static double stream(const double *s, int threads, cdem_spring_set *set) {
  double start = now();
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int chunk = 0; chunk < STREAM / BLOCKS; chunk++)
    cdem_springs_from_blocks(s, BLOCKS, 3, NULL, set + (int64_t)chunk * BLOCKS, NULL);
  return (now() - start) / STREAM;
}

/* As a network does it: every thread keeps its chunk of sets in its cache. */
static double chunks(const double *s, int threads, cdem_spring_set *set) {
  double start = now();
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int chunk = 0; chunk < STREAM / BLOCKS; chunk++)
    cdem_springs_from_blocks(s, BLOCKS, 3, NULL, set + (int64_t)omp_get_thread_num() * BLOCKS,
                             NULL);
  return (now() - start) / STREAM;
}

static volatile double keep; /* what nobody reads is not computed */

static void one_round(int round, const double *s, const double *generic, cdem_spring_set *set,
                      timings *t) {
  enum { FEW = BLOCKS / 4, MULTIPLY_ADDS = 2000000 };
  const int64_t bytes = (int64_t)STREAM * (int64_t)sizeof *set;
  double start = now();
  keep = plain_lapack(s, FEW);
  t->plain[round] = (now() - start) / FEW;
  start = now();
  robust(s, FEW, set);
  t->robust[round] = (now() - start) / FEW;
  t->fast[round] = chunks(s, 1, set);
  t->random[round] = chunks(generic, 1, set);
  t->threads[0][round] = chunks(s, 1, set);
  t->threads[1][round] = chunks(s, 2, set);
  t->stream[round] = stream(s, 1, set);
  start = now();
  keep = bench_multiply_add(MULTIPLY_ADDS);
  t->peak[round] = 12.0 * 16.0 * MULTIPLY_ADDS / (now() - start);
  start = now();
  bench_fill((double *)set, bytes / 64, 0.0);
  t->store[round] = (double)bytes / (now() - start);
}

static void name_machine(void) {
  char line[256];
  FILE *file = fopen("/proc/cpuinfo", "r");
  while (file != NULL && fgets(line, sizeof line, file) != NULL)
    if (strncmp(line, "model name", 10) == 0) {
      printf("machine: %s", strchr(line, ':') + 2);
      break;
    }
  if (file != NULL)
    fclose(file);
  printf("vectors: %s, compiler %s, %d processors\n",
         __builtin_cpu_supports("avx512f") ? "AVX-512"
         : __builtin_cpu_supports("avx2")  ? "AVX2"
                                           : "SSE2",
         __VERSION__, omp_get_num_procs());
}

static void census(const char *name, const double *s, cdem_spring_set *set) {
  int slow = 0, forms[CDEM_FORM_COUNT] = {0};
  double worst = 0.0, block[9];
  cdem_springs_from_blocks(s, BLOCKS, 3, NULL, set, NULL);
  for (int64_t i = 0; i < BLOCKS; i++) {
    get_block(s, i, block);
    worst = fmax(worst, cdem_springs_residual(block, &set[i]));
    slow += set[i].slow;
    forms[set[i].form]++;
  }
  printf("%s: %d blocks, %.3f %% slow, %.1f %% diagonal, %.1f %% complex, worst residual %.2g\n",
         name, (int)BLOCKS, 100.0 * slow / BLOCKS, 100.0 * forms[CDEM_FORM_DIAGONAL] / BLOCKS,
         100.0 * forms[CDEM_FORM_COMPLEX] / BLOCKS, worst);
}

static void print_rate(const char *what, double seconds, double base) {
  printf("%-48s %9.1f ns %9.3g blocks/s %8.1f x\n", what, 1e9 * seconds, 1.0 / seconds,
         base / seconds);
}

static void report(const timings *t) {
  double plain = median(t->plain), fast = median(t->fast), flow = median(t->stream);
  double peak = median(t->peak), store = median(t->store);
  printf("\n%-48s %12s %18s %10s\n", "3x3 blocks, one core", "per block", "rate", "to (a)");
  print_rate("(a) LAPACKE_dgeev, dgetrf, dgetri", plain, plain);
  print_rate("(b) robust path", median(t->robust), plain);
  print_rate("(c) fast path, distorted hexahedra", fast, plain);
  print_rate("    fast path, generic random blocks", median(t->random), plain);
  print_rate("    fast path, sets streamed to memory", flow, plain);
  printf("\n%-48s %9.3g /s; %d a block: (c) runs at %.0f %% of it\n",
         "operations, measured peak of one core", peak, (int)OPERATIONS,
         100.0 * OPERATIONS / fast / peak);
  double bytes = (double)sizeof(cdem_spring_set);
  printf("%-48s %9.3g B/s; %g B a set: streaming runs at %.0f %% of it\n",
         "stores to memory, measured", store, bytes, 100.0 * bytes / flow / store);
  printf("%-48s %9.3g s; streaming runs at %.0f %% of it\n", "  both bounds in turn, a block",
         OPERATIONS / peak + bytes / store, 100.0 * (OPERATIONS / peak + bytes / store) / flow);
  for (int k = 0; k < 2; k++)
    printf("%d thread%-39s %9.1f ns %9.3g blocks/s %8.2f x\n", k + 1, k == 0 ? "" : "s",
           1e9 * median(t->threads[k]), 1.0 / median(t->threads[k]),
           median(t->threads[0]) / median(t->threads[k]));
}

int main(void) {
  double *s = aligned_alloc(64, (size_t)BLOCKS * 72);
  double *generic = aligned_alloc(64, (size_t)BLOCKS * 72);
  cdem_spring_set *set = aligned_alloc(64, (size_t)STREAM * sizeof *set);
  if (s == NULL || generic == NULL || set == NULL) {
    fprintf(stderr, "out of memory\n");
    return 5;
  }
  static timings t;
  cdem_random random = {2006};
  for (int64_t h = 0; h < HEXAHEDRA; h++)
    hexahedron(&random, s, h * PAIRS);
  for (int64_t e = 0; e < (int64_t)BLOCKS * 9; e++)
    generic[e] = cdem_random_uniform(&random, -1.0, 1.0);
  memset(set, 0, (size_t)STREAM * sizeof *set);
  name_machine();
  census("distorted hexahedra", s, set);
  census("generic random", generic, set);
  for (int round = 0; round < ROUNDS; round++)
    one_round(round, s, generic, set, &t);
  report(&t);
  free(s);
  free(generic);
  free(set);
  return 0;
}
