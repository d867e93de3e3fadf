/* Small models for the tests of the solver. */
#ifndef CDEM_TESTS_DEM_SOLVER_MODEL_H
#define CDEM_TESTS_DEM_SOLVER_MODEL_H

#include "base/mat3.h"
#include "base/random.h"
#include "dem/dem.h"
#include "support/test.h"

#include <string.h>

enum { MODEL_MATERIALS = 3, MODEL_WALLS = 8 };

typedef struct {
  cdem_grains grains;
  cdem_grain_material material[MODEL_MATERIALS];
  cdem_contact_input contact[MODEL_MATERIALS * MODEL_MATERIALS];
  cdem_wall wall[MODEL_WALLS];
  cdem_dem_options options;
} model;

static inline void model_word(model *m, cdem_law_key key, double value) {
  for (int k = 0; k < MODEL_MATERIALS * MODEL_MATERIALS; k++)
    m->contact[k].value[key] = value;
}

/* A model of `law` without grains. */
static inline void model_init(model *m, int dim, const char *law) {
  *m = (model){.grains = {.dim = dim}};
  for (int k = 0; k < MODEL_MATERIALS; k++) {
    m->material[k] = (cdem_grain_material){.density = 2500.0, .young = 1e8, .poisson = 0.25};
    snprintf(m->material[k].name, sizeof m->material[k].name, "m%d", k);
  }
  for (int k = 0; k < MODEL_MATERIALS * MODEL_MATERIALS; k++)
    for (int w = 0; w < CDEM_LAW_KEYS; w++)
      m->contact[k].value[w] = NAN;
  if (strcmp(law, "penalty") == 0)
    model_word(m, CDEM_LAW_penalty_stiffness, 3e9);
  else if (strcmp(law, "hertz") != 0 && strcmp(law, "mindlin") != 0)
    model_word(m, CDEM_LAW_normal_stiffness, 1e5);
  if (strcmp(law, "li-chu") == 0) {
    model_word(m, CDEM_LAW_shear_stiffness, 2e4);
  }
  m->options = (cdem_dem_options){.grains = &m->grains,
                                  .materials = 1,
                                  .material = m->material,
                                  .contact = m->contact,
                                  .law = cdem_law_find(law),
                                  .wall = m->wall,
                                  .energies = true,
                                  .most_overlap = 0.5,
                                  .threads = 1};
  assert_non_null(m->options.law);
}

static inline int64_t model_add(model *m, double x, double y, double z, double radius) {
  cdem_fault fault = {0};
  double at[3] = {x, y, z};
  check_ok(cdem_grains_add(&m->grains, at, radius, &fault));
  check_ok(cdem_grains_complete(&m->grains, &fault));
  return m->grains.grains - 1;
}

static inline void model_move(model *m, int64_t grain, double vx, double vy, double vz) {
  double v[3] = {vx, vy, vz};
  memcpy(m->grains.velocity + 3 * grain, v, sizeof v);
}

static inline void model_plane(model *m, double x, double y, double z, double nx, double ny,
                               double nz) {
  cdem_wall *wall = &m->wall[m->options.walls++];
  *wall = (cdem_wall){.name = "plane", .shape = CDEM_WALL_PLANE};
  const double center[3] = {x, y, z}, normal[3] = {nx, ny, nz};
  memcpy(wall->center, center, sizeof center);
  memcpy(wall->normal, normal, sizeof normal);
}

/* side^dim grains on a shaken lattice, some touching, with random motion, between walls. */
static inline void model_heap(model *m, int side, double ratio, double speed, uint64_t seed) {
  cdem_random random = {.state = seed};
  const double r = 0.01, spacing = 1.9 * r;
  int dim = m->grains.dim, count = dim == 2 ? side * side : side * side * side;
  for (int k = 0; k < count; k++) {
    double at[3] = {k % side, k / side % side, k / side / side}, v[6];
    double size = r / (1.0 + (ratio - 1.0) * cdem_random_uniform(&random, 0.0, 1.0));
    for (int c = 0; c < 3; c++)
      at[c] = c < dim ? at[c] * spacing + 0.1 * r * cdem_random_uniform(&random, -1.0, 1.0) : 0.0;
    for (int c = 0; c < 6; c++)
      v[c] = speed * cdem_random_uniform(&random, -1.0, 1.0) * (c < 3 ? 1.0 : 1.0 / r);
    model_add(m, at[0], at[1], at[2], size);
    model_move(m, k, v[0], v[1], dim == 3 ? v[2] : 0.0);
    for (int c = 0; c < 3; c++)
      m->grains.spin[3 * k + c] = dim == 3 || c == 2 ? v[3 + c] : 0.0;
  }
}

static inline void model_box(model *m, int side) {
  const double r = 0.01, low = -1.05 * r, high = (side - 1) * 1.9 * r + 1.05 * r;
  for (int c = 0; c < m->grains.dim; c++) {
    double n[3] = {c == 0, c == 1, c == 2};
    model_plane(m, n[0] * low, n[1] * low, n[2] * low, n[0], n[1], n[2]);
    model_plane(m, n[0] * high, n[1] * high, n[2] * high, -n[0], -n[1], -n[2]);
  }
}

static inline void model_release(model *m) {
  cdem_grains_release(&m->grains);
}

static inline double energy_error(cdem_dem *dem, cdem_dem_energies *e) {
  cdem_dem_energies_now(dem, e);
  return fabs(e->error) / e->exchange;
}

#endif
