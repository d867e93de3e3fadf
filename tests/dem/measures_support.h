/* States put together by hand, without a solver. */
#ifndef CDEM_TESTS_DEM_MEASURES_SUPPORT_H
#define CDEM_TESTS_DEM_MEASURES_SUPPORT_H

#include "dem/measures_kernels.h"
#include "support/test.h"

enum { MOST_GRAINS = 4000, MOST_CONTACTS = 16000 };

typedef struct {
  double xyz[3 * MOST_GRAINS], radius[MOST_GRAINS], velocity[3 * MOST_GRAINS], mass[MOST_GRAINS];
  int32_t touching[MOST_GRAINS];
  cdem_dem_contact contact[MOST_CONTACTS];
  cdem_snapshot s;
} assembly;

static inline assembly *assembly_new(int dim) {
  assembly *a = calloc(1, sizeof *a);
  assert_non_null(a);
  a->s = (cdem_snapshot){.dim = dim,
                         .threads = 1,
                         .thickness = dim == 2 ? 0.5 : 1.0,
                         .xyz = a->xyz,
                         .radius = a->radius,
                         .velocity = a->velocity,
                         .mass = a->mass,
                         .touching = a->touching,
                         .contact = a->contact};
  return a;
}

static inline void put_grain(assembly *a, double x, double y, double z, double radius) {
  int64_t i = a->s.grains++;
  assert_true(i < MOST_GRAINS);
  a->xyz[3 * i] = x;
  a->xyz[3 * i + 1] = y;
  a->xyz[3 * i + 2] = z;
  a->radius[i] = radius;
  a->mass[i] = 2.0;
}

/* Contact of a and b (through `shift` of b) that pushes, with a force across beside. */
static inline cdem_dem_contact *put_contact(assembly *a, int32_t i, int32_t j,
                                            const double shift[3], double push) {
  cdem_dem_contact *c = &a->contact[a->s.contacts++];
  assert_true(a->s.contacts < MOST_CONTACTS);
  *c = (cdem_dem_contact){.a = i, .b = j, .push = push};
  for (int k = 0; k < 3; k++)
    c->branch[k] = a->xyz[3 * j + k] - a->xyz[3 * i + k] + (shift != NULL ? shift[k] : 0.0);
  double length = cdem_norm3(c->branch);
  for (int k = 0; k < 3; k++) {
    c->normal[k] = c->branch[k] / length;
    c->point[k] = a->xyz[3 * i + k] + c->branch[k] * a->radius[i] / (a->radius[i] + a->radius[j]);
    c->force[k] = -push * c->normal[k];
  }
  a->touching[i]++;
  a->touching[j]++;
  return c;
}

static inline cdem_dem_contact *put_wall_contact(assembly *a, int32_t i, int wall,
                                                 const double normal[3], double push) {
  cdem_dem_contact *c = &a->contact[a->s.contacts++];
  *c = (cdem_dem_contact){.a = i, .b = -1 - wall, .push = push};
  for (int k = 0; k < 3; k++) {
    c->normal[k] = normal[k];
    c->branch[k] = 0.99 * a->radius[i] * normal[k];
    c->point[k] = a->xyz[3 * i + k] + c->branch[k];
    c->force[k] = -push * normal[k];
  }
  a->touching[i]++;
  return c;
}

/* A random cloud with contacts between all that are near, forces of any direction. */
static inline assembly *random_assembly(int dim, int grains, uint64_t seed) {
  assembly *a = assembly_new(dim);
  cdem_random random = {seed};
  for (int i = 0; i < grains; i++) {
    double x = cdem_random_uniform(&random, -1, 1), y = cdem_random_uniform(&random, -1, 1);
    double radius = cdem_random_uniform(&random, 0.05, 0.15);
    put_grain(a, x, y, dim == 3 ? cdem_random_uniform(&random, -1, 1) : 0.0, radius);
    a->mass[i] = cdem_random_uniform(&random, 1, 3);
    for (int k = 0; k < dim; k++)
      a->velocity[3 * i + k] = cdem_random_uniform(&random, -1, 1);
  }
  for (int i = 0; i < grains; i++)
    for (int j = i + 1; j < grains; j++) {
      double d[3];
      for (int k = 0; k < 3; k++)
        d[k] = a->xyz[3 * j + k] - a->xyz[3 * i + k];
      if (cdem_norm3(d) > 1.3 * (a->radius[i] + a->radius[j]))
        continue;
      cdem_dem_contact *c = put_contact(a, i, j, NULL, cdem_random_uniform(&random, 1, 4));
      for (int k = 0; k < dim; k++)
        c->force[k] += cdem_random_uniform(&random, -1, 1);
    }
  return a;
}

#endif
