/* Meshes and random places that the tests of the room bsm share. */
#ifndef CDEM_TESTS_BSM_SUPPORT_H
#define CDEM_TESTS_BSM_SUPPORT_H

#include "base/random.h"
#include "bsm/bsm.h"
#include "elements/elements.h"
#include "support/test.h"

static const cdem_shape first_order_shapes[] = {CDEM_SHAPE_TRI3,   CDEM_SHAPE_QUAD4,
                                                CDEM_SHAPE_TET4,   CDEM_SHAPE_PYR5,
                                                CDEM_SHAPE_WEDGE6, CDEM_SHAPE_HEX8};
enum { FIRST_ORDER_SHAPES = 6 };

static inline bool is_solid(cdem_shape shape) {
  return cdem_shape_get(shape)->dimension == 3;
}

/* A box of count^dim bricks, 1.3 x 1.0 x 0.9 m, from the origin. */
static inline cdem_mesh mesh_of(cdem_shape shape, int32_t count, double distortion, uint64_t seed) {
  cdem_fault fault = {0};
  cdem_mesh mesh;
  cdem_mesh_grid_options grid = {.shape = shape,
                                 .count = {count, count, is_solid(shape) ? count : 0},
                                 .size = {1.3, 1.0, is_solid(shape) ? 0.9 : 0.0},
                                 .distortion = distortion,
                                 .seed = seed};
  check_ok(cdem_mesh_grid(&grid, &mesh, &fault));
  return mesh;
}

/* The cells of the highest dimension; free() them. */
static inline int32_t *cells_of_mesh(const cdem_mesh *mesh, int32_t *count) {
  int32_t *list = cdem_allocate(mesh->cells, sizeof *list, NULL);
  int dim = cdem_mesh_dimension(mesh);
  assert_non_null(list);
  *count = 0;
  for (int32_t c = 0; c < mesh->cells; c++)
    if (cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension == dim)
      list[(*count)++] = c;
  return list;
}

static inline const cdem_element *element_at(const cdem_mesh *mesh, int32_t cell) {
  cdem_shape shape = (cdem_shape)mesh->cell_shape[cell];
  return cdem_element_for(shape, is_solid(shape) ? CDEM_SOLID : CDEM_PLANE);
}

/* x(xi) of a cell. */
static inline void map_to_space(const cdem_mesh *mesh, int32_t cell, const double xi[3],
                                double x[3]) {
  double n[8];
  const cdem_element *element = element_at(mesh, cell);
  element->shape_functions(xi, n, NULL);
  memset(x, 0, 3 * sizeof *x);
  for (int i = 0; i < cdem_element_nodes(element); i++)
    for (int c = 0; c < 3; c++)
      x[c] += n[i] * mesh->xyz[3 * (int64_t)cdem_mesh_cell(mesh, cell)[i] + c];
}

/* A place in a reference cell, `margin` away from its faces. */
static inline void random_xi(cdem_shape shape, cdem_random *random, double margin, double xi[3]) {
  const cdem_element *element = cdem_element_for(shape, is_solid(shape) ? CDEM_SOLID : CDEM_PLANE);
  double sum = 0.0, part[8];
  int nodes = cdem_element_nodes(element);
  /* A convex mixture of the corners, some way towards their middle. */
  for (int i = 0; i < nodes; i++)
    sum += part[i] = pow(cdem_random_uniform(random, 0.0, 1.0), 3.0);
  memset(xi, 0, 3 * sizeof *xi);
  for (int i = 0; i < nodes; i++)
    for (int c = 0; c < 3; c++)
      xi[c] += element->reference[i][c] * ((1.0 - margin) * part[i] / sum + margin / nodes);
}

#endif
