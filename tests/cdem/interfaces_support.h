/* Grids whose every cell is a block with interfaces on all faces, for the tests of interfaces. */
#ifndef CDEM_TESTS_CDEM_INTERFACES_SUPPORT_H
#define CDEM_TESTS_CDEM_INTERFACES_SUPPORT_H

#include "cdem/interfaces.h"
#include "support/test.h"

#include <stdbool.h>

static cdem_fault fault;

enum { MOST = 4096 };

static const cdem_interface_law soft = {.softening = CDEM_SOFTENING_LINEAR,
                                        .kn = 1e13,
                                        .ks = 4e12,
                                        .tension = 1e6,
                                        .cohesion = 3e6,
                                        .friction = 0.3,
                                        .energy_1 = 10,
                                        .energy_2 = 50};
/* Never fails: an elastic spring. */
static const cdem_interface_law strong = {
    .kn = 3e6, .ks = 1e6, .tension = 1e30, .cohesion = 1e30, .energy_1 = 1e60, .energy_2 = 1e60};

/* A grid whose every cell is a block, with one law on all faces. */
typedef struct {
  cdem_mesh mesh;
  cdem_blocks blocks;
  cdem_interfaces interfaces;
  int32_t law_of[2000];
  int dofs;
  int64_t unknowns;
  double u[MOST], force[MOST];
} specimen;

static inline void build(specimen *s, cdem_shape shape, const int count[3], double distortion,
                         int dofs, const cdem_interface_law *law, int threads) {
  static const char *const body[] = {"body"};
  memset(s, 0, sizeof *s);
  check_ok(cdem_mesh_grid(
      &(cdem_mesh_grid_options){.shape = shape,
                                .count = {count[0], count[1], count[2]},
                                .size = {count[0], count[1], count[2] > 0 ? count[2] : 1},
                                .distortion = distortion,
                                .seed = 3},
      &s->mesh, &fault));
  check_ok(cdem_blocks_init(
      &(cdem_blocks_options){.mesh = &s->mesh, .breakable = 1, .breakable_group = body}, &s->blocks,
      &fault));
  assert_true(s->blocks.pairs <= 2000);
  s->dofs = dofs;
  s->unknowns = (int64_t)s->blocks.mesh.nodes * dofs;
  assert_true(s->unknowns <= MOST);
  check_ok(cdem_interfaces_init(&(cdem_interfaces_options){.blocks = &s->blocks,
                                                           .dofs = dofs,
                                                           .thickness = 0.5,
                                                           .laws = 1,
                                                           .law = law,
                                                           .law_of = s->law_of,
                                                           .release = 0.05,
                                                           .threads = threads},
                                &s->interfaces, &fault));
}

static inline void drop(specimen *s) {
  cdem_interfaces_release(&s->interfaces);
  cdem_blocks_release(&s->blocks);
  cdem_mesh_release(&s->mesh);
}

static inline void evaluate(specimen *s) {
  memset(s->force, 0, (size_t)s->unknowns * sizeof *s->force);
  cdem_interfaces_forces(&s->interfaces, s->u, s->force);
}

static inline cdem_interfaces_totals totals_of(const specimen *s) {
  cdem_interfaces_totals totals;
  cdem_interfaces_sum(&s->interfaces, &totals);
  return totals;
}

/* u = R X - X + noise for all nodes. axis: a rotation vector. */
static inline void displace(specimen *s, const double axis[3], double noise, uint64_t seed) {
  cdem_random random = {seed};
  int dimension = s->blocks.dimension;
  double angle = cdem_norm3(axis), k[3] = {0, 0, 1};
  for (int i = 0; i < 3 && angle > 0; i++)
    k[i] = axis[i] / angle;
  for (int32_t n = 0; n < s->blocks.mesh.nodes; n++) {
    const double *x = s->blocks.mesh.xyz + 3 * n;
    double cross[3], along = cdem_dot3(k, x) * (1 - cos(angle));
    cdem_cross3(k, x, cross);
    for (int i = 0; i < s->dofs; i++)
      s->u[n * s->dofs + i] =
          (i < dimension ? cos(angle) * x[i] + sin(angle) * cross[i] + along * k[i] - x[i] : 0) +
          noise * cdem_random_uniform(&random, -1, 1);
  }
}

static const int two[3] = {2, 1, 1}, two_plane[3] = {2, 1, 0};

#endif
