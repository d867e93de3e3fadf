/* Bodies and motions that the tests of the elastic body share. */
#ifndef CDEM_TESTS_CDEM_BODY_SUPPORT_H
#define CDEM_TESTS_CDEM_BODY_SUPPORT_H

#include "base/mat3.h"
#include "base/random.h"
#include "cdem/body.h"
#include "mesh/mesh.h"
#include "support/test.h"

/* A body of one element kind with all that it stands on. */
typedef struct {
  cdem_mesh mesh;
  cdem_material material;
  double density;
  bool no_tension;
  cdem_model model;
  cdem_body body;
  int64_t size; /* nodes * dofs */
} specimen;

typedef struct {
  int32_t count; /* bricks a direction */
  double distortion;
  bool linear, separate, no_tension;
  int threads;
  cdem_plane plane;
} recipe;

static inline bool first_order(const cdem_element *element) {
  const cdem_shape_info *shape = cdem_shape_get(element->shape);
  return shape->nodes == shape->corners;
}

static inline cdem_material rock(const cdem_element *element) {
  cdem_material material = cdem_material_isotropic(40e9, 0.23);
  if (element->formulation == CDEM_PLANE_COSSERAT) {
    material.model = CDEM_COSSERAT;
    material.parameter[2] = 7e9;
    material.parameter[3] = 0.07;
    material.parameter[4] = 1.0;
  }
  return material;
}

/* Model and body of a specimen that has its mesh, material and density. */
static inline void specimen_build(const recipe *how, specimen *s) {
  cdem_fault fault = {0};
  cdem_model_options options = {.mesh = &s->mesh,
                                .materials = 1,
                                .material = &s->material,
                                .default_material = -1,
                                .section = {how->plane, 0.7}};
  check_ok(cdem_model_init(&options, &s->model, &fault));
  s->no_tension = how->no_tension;
  cdem_body_options body = {.density = &s->density,
                            .no_tension = &s->no_tension,
                            .linear = how->linear,
                            .separate = how->separate,
                            .threads = how->threads};
  check_ok(cdem_body_init(&s->model, &body, &s->body, &fault));
  s->size = (int64_t)s->body.nodes * s->body.dofs;
}

static inline void specimen_make(const cdem_element *element, const recipe *how, specimen *s) {
  cdem_fault fault = {0};
  memset(s, 0, sizeof *s);
  bool solid = cdem_element_dimension(element) == 3;
  cdem_mesh_grid_options grid = {.shape = element->shape,
                                 .count = {how->count, how->count, solid ? how->count : 0},
                                 .size = {1.3, 1.0, solid ? 0.9 : 0.0},
                                 .distortion = how->distortion,
                                 .seed = 7};
  check_ok(cdem_mesh_grid(&grid, &s->mesh, &fault));
  s->material = rock(element);
  s->density = 2700.0;
  specimen_build(how, s);
}

static inline void specimen_release(specimen *s) {
  cdem_body_release(&s->body);
  cdem_model_release(&s->model);
  cdem_mesh_release(&s->mesh);
}

static inline double *new_vector(int64_t size) {
  double *v = cdem_allocate(size, sizeof *v, NULL);
  assert_non_null(v);
  return v;
}

static inline double largest(const double *v, int64_t size) {
  double most = 0.0;
  for (int64_t i = 0; i < size; i++)
    if (!(fabs(v[i]) <= most))
      most = fabs(v[i]);
  return most;
}

static inline double difference(const double *a, const double *b, int64_t size) {
  double most = 0.0;
  for (int64_t i = 0; i < size; i++)
    if (!(fabs(a[i] - b[i]) <= most))
      most = fabs(a[i] - b[i]);
  return most;
}

/* R of `angle` about z in a plane, else about a skew axis (Rodrigues). */
static inline void rotation_about(int dimension, double angle, double r[9]) {
  const double axis[3] = {dimension == 3 ? 2.0 / 7 : 0.0, dimension == 3 ? -3.0 / 7 : 0.0,
                          dimension == 3 ? 6.0 / 7 : 1.0};
  const double k[9] = {0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0};
  for (int i = 0; i < 9; i++)
    r[i] = (i % 4 == 0 ? cos(angle) : 0.0) + sin(angle) * k[i] +
           (1.0 - cos(angle)) * axis[i / 3] * axis[i % 3];
}

/* u = R (x + v) + shift - x: the motion v and then a rigid one; Cosserat rotations turn too. */
static inline void turn_all(const specimen *s, const double *v, double angle, const double shift[3],
                            double *u) {
  double r[9];
  int dofs = s->body.dofs, moving = s->model.dimension;
  rotation_about(moving, angle, r);
  for (int32_t n = 0; n < s->body.nodes; n++) {
    const double *x = s->mesh.xyz + 3 * (int64_t)n, *from = v + (int64_t)n * dofs;
    double *to = u + (int64_t)n * dofs;
    for (int i = 0; i < moving; i++) {
      to[i] = shift[i] - x[i];
      for (int k = 0; k < moving; k++)
        to[i] += r[3 * i + k] * (x[k] + from[k]);
    }
    if (dofs > moving)
      to[2] = from[2] + angle;
  }
}

/* A random field of this size at the nodes. */
static inline void shake(const specimen *s, double size, uint64_t seed, double *u) {
  cdem_random random = {seed};
  for (int64_t i = 0; i < s->size; i++)
    u[i] = cdem_random_uniform(&random, -size, size);
}

#endif
