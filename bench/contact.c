/* How many contacts a second: a wall of cubes, each pressed on the ones around it, moved a little
 * at every step. Prints contact-steps a second by the clock and by the time of the processors
 * (which a loaded machine leaves alone), and the time of the first step (which makes the list), for
 * 1 and more threads. Nothing is asserted. */
#include "cdem/contact.h"

#include "bench.h"
#include "cdem/blocks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { STEPS = 40 };

static cdem_status run(const cdem_blocks *blocks, int threads, cdem_fault *fault) {
  int64_t count = 3 * (int64_t)blocks->mesh.nodes;
  double *mass, *u, *v, *force;
  CDEM_NEW(mass, count, fault);
  CDEM_NEW(u, count, fault);
  CDEM_NEW(v, count, fault);
  CDEM_NEW(force, count, fault);
  for (int64_t i = 0; i < count; i++)
    mass[i] = 1.0;
  cdem_contact contact;
  cdem_contact_options options = {.blocks = blocks,
                                  .dofs = 3,
                                  .law = {.kn = 1e9, .kt = 5e8, .friction = 0.5, .damping = 0.1},
                                  .mass = mass,
                                  .threads = threads};
  CDEM_TRY(cdem_contact_init(&options, &contact, fault));
  for (int32_t p = 0; p < blocks->pairs; p++)
    cdem_contact_hand_over(&contact, p, NULL);
  /* every block a little larger than its place */
  for (int32_t n = 0; n < blocks->mesh.nodes; n++)
    for (int k = 0; k < 3; k++)
      u[3 * n + k] = 1e-4 * ((blocks->node_block[n] * 7 + k) % 5 - 2);
  double start = clock_now(CLOCK_MONOTONIC);
  CDEM_TRY(cdem_contact_forces(&contact, u, v, 0.0, force, fault));
  double first = clock_now(CLOCK_MONOTONIC) - start;
  int64_t contacts = 0;
  start = clock_now(CLOCK_MONOTONIC);
  double spent = clock_now(CLOCK_PROCESS_CPUTIME_ID);
  for (int step = 0; step < STEPS; step++) {
    for (int64_t i = 0; i < count; i++)
      u[i] += 1e-7 * (double)(i % 3);
    CDEM_TRY(cdem_contact_forces(&contact, u, v, 0.0, force, fault));
  }
  double time = clock_now(CLOCK_MONOTONIC) - start;
  spent = clock_now(CLOCK_PROCESS_CPUTIME_ID) - spent;
  cdem_contact_totals totals;
  cdem_contact_sum(&contact, &totals);
  contacts = STEPS * totals.contacts;
  printf("%8d %12lld %12lld %16.3g %14.3g %14.3g\n", threads, (long long)totals.contacts,
         (long long)totals.candidates, (double)contacts / time, (double)contacts / spent, first);
  cdem_contact_release(&contact);
  free(mass);
  free(u);
  free(v);
  free(force);
  return CDEM_OK;
}

int main(int arguments, char **argument) {
  int side = arguments > 1 ? atoi(argument[1]) : 16;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_blocks blocks = {0};
  const char *body = "body";
  cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_HEX8, .count = {side, side, side}, .size = {side, side, side}};
  cdem_blocks_options options = {.mesh = &mesh, .breakable = 1, .breakable_group = &body};
  cdem_status status = cdem_mesh_grid(&grid, &mesh, &fault);
  if (status == CDEM_OK)
    status = cdem_blocks_init(&options, &blocks, &fault);
  printf("%d cubes, %d face pairs\n", side * side * side, blocks.pairs);
  printf("%8s %12s %12s %16s %14s %14s\n", "threads", "contacts", "candidates", "contact-steps/s",
         "by CPU time", "first step, s");
  for (int threads = 1; threads <= 4 && status == CDEM_OK; threads *= 2)
    status = run(&blocks, threads, &fault);
  if (status != CDEM_OK)
    fprintf(stderr, "error: %s\n", fault.message);
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
  return status == CDEM_OK ? 0 : 1;
}
