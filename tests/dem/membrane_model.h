/* Tubes for the tests of membranes. */
#ifndef CDEM_TESTS_DEM_MEMBRANE_MODEL_H
#define CDEM_TESTS_DEM_MEMBRANE_MODEL_H

#include "base/mat3.h"
#include "base/random.h"
#include "dem/membrane.h"
#include "support/test.h"

#include <string.h>

typedef struct {
  double value, time;
  cdem_membrane_options options;
  cdem_membrane membrane;
} tube;

/* 0.2 m wide, 0.3 m high, nodes at 20 mm; nothing acts but what a test sets. */
static inline void tube_init(tube *t, double pressure) {
  *t = (tube){.value = pressure,
              .options = {.center = {0.05, -0.02},
                          .radius = 0.1,
                          .low = -0.1,
                          .high = 0.2,
                          .spacing = 0.02,
                          .areal_density = 30.0,
                          .poisson = 0.3,
                          .thickness = 1e-3,
                          .penalty = 1e9}};
  t->options.pressure = (cdem_series){.points = 1, .time = &t->time, .value = &t->value};
}

static inline void tube_make(tube *t) {
  cdem_fault fault = {0};
  check_ok(cdem_membrane_create(&t->options, &t->membrane, &fault));
}

/* Places out of order by up to `size` in each direction; the ends stay flat. */
static inline void tube_crumple(tube *t, double size, uint64_t seed) {
  cdem_random random = {seed};
  int32_t n = t->membrane.around;
  for (int32_t k = 0; k < 3 * t->membrane.nodes; k++) {
    bool end = k / 3 < n || k / 3 >= t->membrane.nodes - n;
    double by = cdem_random_uniform(&random, -size, size);
    t->membrane.x[k] += end && k % 3 == 2 ? 0.0 : by;
  }
  cdem_membrane_evaluate(&t->membrane, 0.0);
}

/* Elastic energy, J. */
static inline double tube_energy(tube *t) {
  cdem_membrane_energies e;
  cdem_membrane_evaluate(&t->membrane, 0.0);
  cdem_membrane_energies_now(&t->membrane, 0.0, &e);
  return e.stretch + e.bending;
}

/* Sum of the forces, and of their moments about the origin. */
static inline void tube_sums(const tube *t, double force[3], double moment[3], double *scale) {
  *scale = 0.0;
  memset(force, 0, 3 * sizeof *force);
  memset(moment, 0, 3 * sizeof *moment);
  for (int32_t i = 0; i < t->membrane.nodes; i++) {
    const double *f = t->membrane.force + 3 * (int64_t)i;
    double turn[3];
    cdem_cross3(t->membrane.x + 3 * (int64_t)i, f, turn);
    for (int c = 0; c < 3; c++) {
      force[c] += f[c];
      moment[c] += turn[c];
    }
    *scale += cdem_norm3(f);
  }
}

#endif
