/* Meshes of grains for tests: boxes, a ball, a body with a notch; surface nodes first. */
#ifndef CDEM_TESTS_FDEM_SURFACE_SUPPORT_H
#define CDEM_TESTS_FDEM_SURFACE_SUPPORT_H

#include "base/mat3.h"
#include "base/memory.h"
#include "base/random.h"
#include "fdem/surface.h"
#include "support/test.h"

/* The volume cells that `keep` wants (NULL: all), surface nodes first, others after them, unused
 * ones left out. Releases `from`; returns how many are on the surface. */
static int32_t surface_first(cdem_mesh *from, bool (*keep)(const double middle[3]), cdem_mesh *to) {
  cdem_fault fault = {0};
  int32_t *cell = calloc((size_t)from->cells, sizeof *cell), cells = 0;
  int32_t *number = calloc((size_t)from->nodes, sizeof *number), nodes = 0, surface = 0;
  bool *outside = calloc((size_t)from->nodes, sizeof *outside);
  uint8_t *used = calloc((size_t)from->nodes, 1);
  for (int32_t i = 0; i < from->cells; i++) {
    const cdem_shape_info *info = cdem_shape_get((cdem_shape)from->cell_shape[i]);
    double middle[3] = {0};
    for (int k = 0; k < info->nodes; k++)
      for (int c = 0; c < 3; c++)
        middle[c] += from->xyz[3 * cdem_mesh_cell(from, i)[k] + c] / info->nodes;
    if (info->dimension < 3 || (keep != NULL && !keep(middle)))
      continue;
    cell[cells++] = i;
    for (int k = 0; k < info->nodes; k++)
      used[cdem_mesh_cell(from, i)[k]] = 1;
  }
  check_ok(cdem_mesh_boundary_nodes(from, cell, cells, outside, &fault));
  *to = (cdem_mesh){0};
  for (int pass = 0; pass < 2; pass++)
    for (int32_t n = 0; n < from->nodes; n++)
      if (used[n] && outside[n] == (pass == 0)) {
        check_ok(cdem_mesh_add_nodes(to, 1, from->xyz + 3 * n, NULL, &fault));
        number[n] = nodes++;
        surface += pass == 0;
      }
  for (int32_t i = 0; i < cells; i++) {
    int32_t node[20];
    cdem_shape shape = (cdem_shape)from->cell_shape[cell[i]];
    for (int k = 0; k < cdem_shape_get(shape)->nodes; k++)
      node[k] = number[cdem_mesh_cell(from, cell[i])[k]];
    check_ok(cdem_mesh_add_cells(to, shape, 1, node, NULL, &fault));
  }
  cdem_mesh_release(from);
  free(cell);
  free(number);
  free(outside);
  free(used);
  return surface;
}

static void shift_mesh(cdem_mesh *mesh, const double by[3], double factor) {
  for (int64_t k = 0; k < 3 * (int64_t)mesh->nodes; k++)
    mesh->xyz[k] = factor * (mesh->xyz[k] + by[k % 3]);
}

/* A box about the origin. */
static inline int32_t box_mesh(cdem_shape shape, const int32_t count[3], const double size[3],
                               double distortion, cdem_mesh *mesh) {
  cdem_fault fault = {0};
  cdem_mesh grid;
  cdem_mesh_grid_options options = {.shape = shape, .distortion = distortion, .seed = 3};
  memcpy(options.count, count, sizeof options.count);
  memcpy(options.size, size, sizeof options.size);
  check_ok(cdem_mesh_grid(&options, &grid, &fault));
  int32_t surface = surface_first(&grid, NULL, mesh);
  shift_mesh(mesh, (double[3]){-0.5 * size[0], -0.5 * size[1], -0.5 * size[2]}, 1.0);
  return surface;
}

static inline bool not_in_the_notch(const double middle[3]) {
  return !(fabs(middle[0] - 1.5) < 0.5 && middle[2] > 1.0);
}

/* A U of unit cells: 3 x 2 x 3 without the upper two of the middle, about its middle, half as
 * large. */
static inline int32_t notch_mesh(cdem_mesh *mesh) {
  cdem_fault fault = {0};
  cdem_mesh grid;
  check_ok(cdem_mesh_grid(&(cdem_mesh_grid_options){.shape = CDEM_SHAPE_HEX8,
                                                    .count = {3, 2, 3},
                                                    .size = {3.0, 2.0, 3.0}},
                          &grid, &fault));
  int32_t surface = surface_first(&grid, not_in_the_notch, mesh);
  shift_mesh(mesh, (double[3]){-1.5, -1.0, -1.5}, 0.5);
  return surface;
}

/* Node at a place, as one that is there already if there is one. */
static int32_t ball_node(cdem_mesh *mesh, const double at[3]) {
  cdem_fault fault = {0};
  for (int32_t n = 0; n < mesh->nodes; n++) {
    double d[3] = {mesh->xyz[3 * n] - at[0], mesh->xyz[3 * n + 1] - at[1],
                   mesh->xyz[3 * n + 2] - at[2]};
    if (cdem_norm3(d) < 1e-9)
      return n;
  }
  check_ok(cdem_mesh_add_nodes(mesh, 1, at, NULL, &fault));
  return mesh->nodes - 1;
}

/* A ball: the octahedron's faces cut into n^2, nodes on the sphere, a tetrahedron to the centre
 * each; the volume is that of the unit ball. 4 n^2 + 2 surface nodes. */
static inline int32_t ball_mesh(int n, cdem_mesh *mesh) {
  cdem_fault fault = {0};
  int32_t(*face)[3] = calloc((size_t)(8 * n * n), sizeof *face), faces = 0;
  double volume = 0.0;
  *mesh = (cdem_mesh){0};
  for (int octant = 0; octant < 8; octant++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n - i; j++)
        for (int up = 0; up < (j < n - i - 1 ? 2 : 1); up++) {
          const int at[2][3][2] = {{{i, j}, {i + 1, j}, {i, j + 1}},
                                   {{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
          int sign[3] = {octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
          for (int k = 0; k < 3; k++) {
            double p[3] = {sign[0] * at[up][k][0], sign[1] * at[up][k][1],
                           sign[2] * (n - at[up][k][0] - at[up][k][1])};
            double norm = cdem_norm3(p);
            for (int c = 0; c < 3; c++)
              p[c] /= norm;
            bool turned = sign[0] * sign[1] * sign[2] < 0;
            face[faces][turned ? 2 - k : k] = ball_node(mesh, p);
          }
          faces++;
        }
  int32_t surface = mesh->nodes;
  check_ok(cdem_mesh_add_nodes(mesh, 1, (double[3]){0.0, 0.0, 0.0}, NULL, &fault));
  for (int32_t f = 0; f < faces; f++) {
    int32_t node[4] = {face[f][0], face[f][1], face[f][2], surface};
    double m[9];
    for (int k = 0; k < 3; k++)
      memcpy(m + 3 * k, mesh->xyz + 3 * face[f][k], 3 * sizeof *m);
    volume += cdem_det3(m) / 6.0;
    /* a tetrahedron's fourth corner is on the side its first face's normal points to */
    node[1] = face[f][2];
    node[2] = face[f][1];
    check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_TET4, 1, node, NULL, &fault));
  }
  free(face);
  shift_mesh(mesh, (double[3]){0.0, 0.0, 0.0}, cbrt(4.0 / 3.0 * M_PI / volume));
  return surface;
}

#endif
