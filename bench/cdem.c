/* Speed of the room cdem: element-steps of the elastic body against the memory bound.
 *
 * A force evaluation must move the bytes of cdem_body_traffic: the records of elements that share
 * nothing, node ids, gather lists, displacements and forces once. The bound is that over the
 * bandwidth of a triad a = b + s c on arrays far beyond the caches, measured in the same run with
 * as many threads (24 bytes an element, the usual count).
 *
 *     bench_cdem [elements a side of the cube, 46]
 */
#define _POSIX_C_SOURCE 200809L
#include "base/base.h"
#include "bench.h"
#include "cdem/body.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now(void) {
  return clock_now(CLOCK_MONOTONIC);
}

/* Bytes a second of the triad, the best of some runs. */
static double triad(int threads) {
  const int64_t n = 16 << 20;
  double *a = malloc((size_t)n * sizeof *a), *b = malloc((size_t)n * sizeof *b);
  double *c = malloc((size_t)n * sizeof *c), best = INFINITY;
  if (a == NULL || b == NULL || c == NULL)
    exit(5);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int64_t i = 0; i < n; i++)
    a[i] = 0.0, b[i] = 1.0, c[i] = (double)i;
  for (int run = 0; run < 8; run++) {
    double start = now();
#pragma omp parallel for simd schedule(static) num_threads(threads)
    for (int64_t i = 0; i < n; i++)
      a[i] = b[i] + 1.5 * c[i];
    best = fmin(best, now() - start);
  }
  if (a[n / 2] < 0.0)
    printf("%g\n", a[n / 2]); /* keeps the loop */
  free(a), free(b), free(c);
  return 24.0 * (double)n / best;
}

typedef struct {
  cdem_mesh mesh;
  cdem_material material;
  cdem_model model;
  cdem_body body;
  double *u, *force, setup;
} elastic;

static void elastic_init(int32_t side, double distortion, int threads, bool no_tension,
                         elastic *e) {
  cdem_fault fault = {0};
  const double density = 2700.0;
  memset(e, 0, sizeof *e);
  cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_HEX8,
                                 .count = {side, side, side},
                                 .size = {1.0, 1.0, 1.0},
                                 .distortion = distortion,
                                 .seed = 1};
  give_up(cdem_mesh_grid(&grid, &e->mesh, &fault), &fault);
  e->material = cdem_material_isotropic(30e9, 0.25);
  const char *group[] = {"body"};
  cdem_model_options model = {
      .mesh = &e->mesh, .groups = 1, .group = group, .materials = 1, .material = &e->material};
  give_up(cdem_model_init(&model, &e->model, &fault), &fault);
  cdem_body_options body = {.density = &density, .no_tension = &no_tension, .threads = threads};
  double start = now();
  give_up(cdem_body_init(&e->model, &body, &e->body, &fault), &fault);
  e->setup = now() - start;
  int64_t size = (int64_t)e->body.nodes * e->body.dofs;
  e->u = malloc((size_t)size * sizeof *e->u);
  e->force = malloc((size_t)size * sizeof *e->force);
  if (e->u == NULL || e->force == NULL)
    exit(5);
  for (int64_t i = 0; i < size; i++) /* strains of 1e-4, as in rock */
    e->u[i] = 1e-4 * sin((double)(i % 1009)) / side;
}

static void elastic_release(elastic *e) {
  free(e->u);
  free(e->force);
  cdem_body_release(&e->body);
  cdem_model_release(&e->model);
  cdem_mesh_release(&e->mesh);
}

/* Seconds a call, the best of several rounds. */
static double time_forces(elastic *e, bool reference) {
  double best = INFINITY;
  for (int round = 0; round < 8; round++) {
    int calls = reference ? 1 : 4;
    double start = now();
    for (int i = 0; i < calls; i++)
      if (reference)
        cdem_body_forces_reference(&e->body, e->u, e->force);
      else
        cdem_body_forces(&e->body, e->u, e->force);
    best = fmin(best, (now() - start) / calls);
  }
  return best;
}

/* A turn of everything, so that no rotation is near the identity. */
static void turn(elastic *e) {
  const double c = cos(2.0), s = sin(2.0);
  for (int32_t n = 0; n < e->body.nodes; n++) {
    double *u = e->u + 3 * (int64_t)n;
    const double *x = e->mesh.xyz + 3 * (int64_t)n;
    double p = x[0] + u[0], q = x[1] + u[1];
    u[0] = c * p - s * q - x[0];
    u[1] = s * p + c * q - x[1];
  }
}

static void print_row(const char *what, int threads, const elastic *e, double seconds,
                      double bandwidth) {
  double cells = e->model.cells, traffic = (double)cdem_body_traffic(&e->body);
  printf("%-34s %2d %9.2f %9.0f %9.2f %8.2f %8.2f\n", what, threads, cells / seconds / 1e6,
         traffic / cells, bandwidth / 1e9, traffic / bandwidth / seconds, e->setup);
}

static void bench_elastic(int32_t side, const double bandwidth[3]) {
  printf("# elastic body, %" PRId32 " hex8: rate in million element-steps a second, bytes an "
         "element-step,\n# triad in GB/s, part of the memory bound, set-up in s\n",
         side * side * side);
  printf("%-34s %2s %9s %9s %9s %8s %8s\n", "# case", "n", "rate", "bytes", "triad", "bound",
         "set-up");
  for (int distorted = 1; distorted >= 0; distorted--)
    for (int threads = 1; threads <= 2; threads++) {
      elastic e;
      elastic_init(side, distorted ? 0.2 : 0.0, threads, false, &e);
      print_row(distorted ? "all-different" : "congruent", threads, &e, time_forces(&e, false),
                bandwidth[threads]);
      if (threads == 1)
        print_row(distorted ? "all-different, plain reference" : "congruent, plain reference",
                  threads, &e, time_forces(&e, true), bandwidth[threads]);
      turn(&e);
      print_row(distorted ? "all-different, turned by 115 deg" : "congruent, turned by 115 deg",
                threads, &e, time_forces(&e, false), bandwidth[threads]);
      elastic_release(&e);
    }
}

/* What no tension costs: bodies that are pressed everywhere, open everywhere, and both by turns
 * (the shaken state: every element has its own principal directions). */
static void bench_tension(int32_t side) {
  static const char *const state[] = {"pressed", "open", "mixed"};
  static const double stretch[] = {-1e-3, 1e-3, 0.0}, shaken[] = {0.05, 0.05, 1.0};
  printf("# hex8 without tension, one thread: ns an element-step, linear and without tension\n");
  for (int distorted = 1; distorted >= 0; distorted--)
    for (int k = 0; k < 3; k++) {
      double seconds[2];
      for (int none = 0; none < 2; none++) {
        elastic e;
        elastic_init(side, distorted ? 0.2 : 0.0, 1, none, &e);
        for (int64_t i = 0; i < 3 * (int64_t)e.body.nodes; i++)
          e.u[i] = shaken[k] * e.u[i] + stretch[k] * e.mesh.xyz[i];
        seconds[none] = time_forces(&e, false) / e.model.cells;
        elastic_release(&e);
      }
      printf("%-13s %-8s %9.1f %9.1f  ratio %.2f\n", distorted ? "all-different" : "congruent",
             state[k], 1e9 * seconds[0], 1e9 * seconds[1], seconds[1] / seconds[0]);
    }
}

int main(int argc, char **argv) {
  int32_t side = argc > 1 ? (int32_t)strtol(argv[1], NULL, 10) : 46;
  if (side < 1 || side > 400) {
    fprintf(stderr, "usage: bench_cdem [elements a side, 1 to 400]\n");
    return 2;
  }
  double bandwidth[3] = {0.0, triad(1), triad(2)};
  bench_elastic(side, bandwidth);
  bench_tension(side);
  return 0;
}
