/* How many grain-element-steps a second: deformable spheres in a loose cloud that is compressed,
 * each touching some five others while it is measured. For each shape the rate with one and two
 * threads; what part is elastic (the two products of the matrix of modes with the forces and
 * amplitudes of all grains: the same grains far apart) and what contact; the rate of the products
 * in multiply-adds and its fraction of the machine's peak, which is measured by independent
 * multiply-adds in the same run.
 *
 * Multiply-adds of the elastic force: 2 * 3 surface nodes * modes a grain. Times are of the
 * processor with one thread, of the clock with two: use a quiet machine.
 *
 * usage: bench_fdem [GRAINS [STEPS]] */
#include "fdem/fdem.h"

#include "base/simd.h"
#include "bench.h"

#include <cblas.h>
#include <math.h>
#include <omp.h>
#include <string.h>

/* One thread by its processor time, which a loaded machine leaves alone. */
static double now(int threads) {
  return clock_now(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC);
}

/* ---- the bound ---- */

/* gcc would take vectors of four by itself; with eight, the processor's own are full. */
enum { CHAINS = 20, LANES = 8 * CHAINS };
CDEM_MULTIVERSION static double many_adds(const double *a, int64_t rounds, double b, double c) {
  cdem_vec8 x[CHAINS], sum = {0};
  memcpy(x, a, sizeof x);
  for (int64_t r = 0; r < rounds; r++)
#pragma GCC unroll 20
    for (int i = 0; i < CHAINS; i++)
      x[i] = x[i] * b + c;
  for (int i = 0; i < CHAINS; i++)
    sum += x[i];
  return sum[0] + sum[7];
}

/* Multiply-adds a second of so many threads. */
static double peak(int threads) {
  double best = 0.0;
  for (int trial = 0; trial < 5; trial++) {
    const int64_t rounds = 20000000;
    double sum = 0.0, begun = now(threads);
#pragma omp parallel num_threads(threads) reduction(+ : sum)
    {
      double a[LANES];
      for (int i = 0; i < LANES; i++)
        a[i] = 1.0 + i;
      sum += many_adds(a, rounds, 0.999999, 1e-9);
    }
    double time = now(threads) - begun;
    if (sum > 0.0)
      best = fmax(best, (double)threads * LANES * (double)rounds / time);
  }
  return best;
}

/* ---- grains ---- */

typedef struct {
  cdem_template shape;
  cdem_material rock;
  double *xyz, *radius, density;
  cdem_fdem_contact_law law;
  cdem_fdem_options options;
} work;

static void make(const char *name, int refinement, int64_t grains, work *w) {
  cdem_fault fault = {0};
  memset(w, 0, sizeof *w);
  w->rock = cdem_material_isotropic(40e9, 0.2);
  const cdem_template_options options = {.shape = cdem_grain_shape_find(name),
                                         .options = {.refinement = refinement},
                                         .material = &w->rock};
  give_up(cdem_template_init(&options, false, &w->shape, &fault), &fault);
  w->xyz = calloc((size_t)(3 * grains), sizeof *w->xyz);
  w->radius = calloc((size_t)grains, sizeof *w->radius);
  w->density = 2650.0;
  w->law = (cdem_fdem_contact_law){
      .penalty = 1.8e11, .shear_ratio = 1.0, .friction = 0.3, .damping_ratio = 0.2};
  w->options = (cdem_fdem_options){.grains = {.grains = grains, .xyz = w->xyz, .radius = w->radius},
                                   .shapes = 1,
                                   .shape = &w->shape,
                                   .materials = 1,
                                   .density = &w->density,
                                   .law = &w->law};
}

/* A shaken cubic lattice of this spacing in diameters. */
static void place(work *w, double spacing) {
  const double r = 0.0075;
  int64_t grains = w->options.grains.grains;
  int side = (int)ceil(cbrt((double)grains) - 1e-9);
  cdem_random random = {.state = 3};
  for (int64_t g = 0; g < grains; g++) {
    const int64_t at[3] = {g % side, g / side % side, g / side / side};
    w->radius[g] = r;
    for (int c = 0; c < 3; c++)
      w->xyz[3 * g + c] =
          2.0 * r * spacing * ((double)at[c] + cdem_random_uniform(&random, -0.005, 0.005));
  }
}

typedef struct {
  double seconds; /* a step */
  double contacts;
} timing;

static timing run(work *w, int threads, int64_t steps) {
  cdem_fault fault = {0};
  cdem_fdem fdem;
  w->options.threads = threads;
  give_up(cdem_fdem_init(&w->options, &fdem, &fault), &fault);
  give_up(cdem_fdem_steps(&fdem, steps / 10 + 1, &fault), &fault);
  timing t = {.seconds = INFINITY};
  for (int trial = 0; trial < 4; trial++) {
    double begun = now(threads);
    give_up(cdem_fdem_steps(&fdem, steps, &fault), &fault);
    t.seconds = fmin(t.seconds, (now(threads) - begun) / (double)steps);
  }
  int32_t *count = calloc((size_t)fdem.grains, sizeof *count);
  cdem_fdem_look(&fdem, &(cdem_fdem_view){.contacts = count});
  for (int64_t g = 0; g < fdem.grains; g++)
    t.contacts += count[g] / (double)fdem.grains;
  free(count);
  cdem_fdem_release(&fdem);
  return t;
}

static void measure(const char *name, int refinement, int64_t grains, int64_t steps,
                    const double bound[2]) {
  work w;
  make(name, refinement, grains, &w);
  double adds = 2.0 * 3.0 * w.shape.surface.nodes * w.shape.modes;
  for (int threads = 1; threads <= 2; threads++) {
    place(&w, 1.5);
    timing apart = run(&w, threads, steps);
    place(&w, 0.96);
    timing all = run(&w, threads, steps);
    double rate = adds * (double)grains / apart.seconds;
    printf("%-12s %d %5d %5d %5d %d %9.3g %12.4g %6.1f %10.3g %6.2f %8.2f\n", name, refinement,
           (int)w.shape.mesh.cells, w.shape.surface.nodes, w.shape.modes, threads,
           (double)grains / all.seconds, (double)grains * (double)w.shape.mesh.cells / all.seconds,
           all.contacts, rate, rate / bound[threads - 1], 1.0 - apart.seconds / all.seconds);
  }
  cdem_template_release(&w.shape);
  free(w.xyz);
  free(w.radius);
}

int main(int argc, char **argv) {
  int64_t grains = argc > 1 ? atoll(argv[1]) : 2000, steps = argc > 2 ? atoll(argv[2]) : 4;
  openblas_set_num_threads(1);
  const double bound[2] = {peak(1), peak(2)};
  printf("peak: %.3g and %.3g multiply-adds/s with one and two threads; %lld grains\n", bound[0],
         bound[1], (long long)grains);
  printf("%-12s %s %5s %5s %5s %s %9s %12s %6s %10s %6s %8s\n", "shape", "n", "cells", "skin",
         "modes", "t", "grains/s", "elements/s", "touch", "elastic/s", "peak", "contact");
  measure("cubesphere", 2, grains, 4 * steps, bound);
  measure("icosphere", 1, grains, steps, bound);
  measure("cubesphere", 4, grains, steps, bound);
  return 0;
}
