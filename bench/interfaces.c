/* Interfaces: point-steps a second of a grid of hexahedra in which every face may break, with all
 * points intact and with all of them sliding and softening.
 *
 *     bench_interfaces [ELEMENTS A SIDE, 24]
 */
#include "cdem/interfaces.h"

#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { STEPS = 20 };

static double now(void) {
  return clock_now(CLOCK_MONOTONIC);
}

/* Every block moves a little on its own; `size` m a step says whether that is elastic. */
static void move(const cdem_blocks *blocks, double size, int step, double *u) {
  for (int32_t n = 0; n < blocks->mesh.nodes; n++)
    for (int c = 0; c < 3; c++)
      u[3 * n + c] = size * step * (double)((blocks->node_block[n] * (7 + 4 * c)) % 5 - 2);
}

static void bench(const cdem_blocks *blocks, const char *what, double size, int threads) {
  cdem_fault fault = {0};
  const cdem_interface_law law = {.softening = CDEM_SOFTENING_LINEAR,
                                  .kn = 1e13,
                                  .ks = 4e12,
                                  .tension = 1e6,
                                  .cohesion = 3e6,
                                  .friction = 0.3,
                                  .energy_1 = 10,
                                  .energy_2 = 50};
  int32_t *law_of = calloc((size_t)blocks->pairs, sizeof *law_of);
  double *u = calloc(3 * (size_t)blocks->mesh.nodes, sizeof *u);
  double *force = calloc(3 * (size_t)blocks->mesh.nodes, sizeof *force);
  cdem_interfaces interfaces = {0};
  give_up(law_of == NULL || u == NULL || force == NULL ? CDEM_MEMORY : CDEM_OK, &fault);
  give_up(cdem_interfaces_init(&(cdem_interfaces_options){.blocks = blocks,
                                                          .dofs = 3,
                                                          .laws = 1,
                                                          .law = &law,
                                                          .law_of = law_of,
                                                          .release = 10.0,
                                                          .threads = threads},
                               &interfaces, &fault),
          &fault);
  double seconds = 0.0;
  for (int step = 1; step <= STEPS; step++) {
    move(blocks, size, step, u);
    double start = now();
    cdem_interfaces_forces(&interfaces, u, force);
    seconds += now() - start;
  }
  cdem_interfaces_totals totals;
  cdem_interfaces_sum(&interfaces, &totals);
  printf("%-24s %8d %10lld %10lld %12.2f\n", what, threads, (long long)totals.points,
         (long long)(totals.softening + totals.tension_failed + totals.shear_failed),
         (double)totals.points * STEPS / seconds / 1e6);
  cdem_interfaces_release(&interfaces);
  free(law_of);
  free(u);
  free(force);
}

int main(int argc, char **argv) {
  int32_t side = argc > 1 ? (int32_t)strtol(argv[1], NULL, 10) : 24;
  static const char *const body[] = {"body"};
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_blocks blocks = {0};
  if (side < 2 || side > 200) {
    fprintf(stderr, "usage: bench_interfaces [elements a side, 2 to 200]\n");
    return 2;
  }
  give_up(cdem_mesh_grid(&(cdem_mesh_grid_options){.shape = CDEM_SHAPE_HEX8,
                                                   .count = {side, side, side},
                                                   .size = {1.0, 1.0, 1.0},
                                                   .distortion = 0.2,
                                                   .seed = 1},
                         &mesh, &fault),
          &fault);
  give_up(cdem_blocks_init(
              &(cdem_blocks_options){.mesh = &mesh, .breakable = 1, .breakable_group = body},
              &blocks, &fault),
          &fault);
  printf("%-24s %8s %10s %10s %12s\n", "points", "threads", "points", "damaged", "M/s");
  for (int threads = 1; threads <= 2; threads++) {
    bench(&blocks, "intact", 1e-10, threads);
    bench(&blocks, "softening and sliding", 1e-7, threads);
  }
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
  return 0;
}
