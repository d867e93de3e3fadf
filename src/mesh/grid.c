/* Structured boxes. Every shape is a template that cuts one brick; templates cut the common face of
 * two bricks alike, so the meshes conform.
 *
 * Corners of a brick are numbered by bits: corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1); 8 is
 * the centre (pyramids). Tetrahedra are Kuhn's: the six shortest paths from corner 0 to corner 7.
 * All edges then run from a grid point p to p + d, d in {0,1}^3 and not 0, which also numbers the
 * mid nodes: one block of them per direction d.
 *
 * Why cells stay valid. An inner corner moves by a vector u in the ball |u| <= a (in cell sizes, so
 * the bound holds for bricks of any aspect ratio). Each row of a hexahedron's Jacobian, at any
 * point, is e_i plus a weighted mean of differences u - u', so it leaves e_i by at most 2a. The
 * rows of a Kuhn tetrahedron along its path, and those of a wedge, do the same. The determinant is
 * positive while the Frobenius norm of the deviation, at most 2a sqrt(3), is under 1: a < 0.288.
 * (2-D: a < 0.353.) A pyramid's apex is the mean of the eight corners; with a = 0.25 its third row
 * (apex less centre of the base diagonal, in halves) leaves e_z by at most 3/4 in directions that
 * the shared corners exclude together; the test tries many seeds. */
#include "mesh/mesh.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double largest_distortion = 0.25;

typedef struct {
  cdem_shape linear;  /* the shape of the corners alone */
  cdem_shape side[2]; /* shapes of its facets with 3 and 4 (2-D: 2) corners, of the same order */
  int cells;
  int8_t corner[6][8];
} template;

#define KUHN                                                                                       \
  {                                                                                                \
    {0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {                        \
      0, 5, 1, 7                                                                                   \
    }                                                                                              \
  }
static const template templates[CDEM_SHAPE_COUNT] = {
    [CDEM_SHAPE_TRI3] = {CDEM_SHAPE_TRI3, {0, CDEM_SHAPE_LINE2}, 2, {{0, 1, 3}, {0, 3, 2}}},
    [CDEM_SHAPE_TRI6] = {CDEM_SHAPE_TRI3, {0, CDEM_SHAPE_LINE3}, 2, {{0, 1, 3}, {0, 3, 2}}},
    [CDEM_SHAPE_QUAD4] = {CDEM_SHAPE_QUAD4, {0, CDEM_SHAPE_LINE2}, 1, {{0, 1, 3, 2}}},
    [CDEM_SHAPE_QUAD8] = {CDEM_SHAPE_QUAD4, {0, CDEM_SHAPE_LINE3}, 1, {{0, 1, 3, 2}}},
    [CDEM_SHAPE_TET4] = {CDEM_SHAPE_TET4, {CDEM_SHAPE_TRI3, 0}, 6, KUHN},
    [CDEM_SHAPE_TET10] = {CDEM_SHAPE_TET4, {CDEM_SHAPE_TRI6, 0}, 6, KUHN},
    [CDEM_SHAPE_PYR5] = {CDEM_SHAPE_PYR5,
                         {CDEM_SHAPE_TRI3, CDEM_SHAPE_QUAD4},
                         6,
                         {{0, 1, 3, 2, 8},
                          {4, 6, 7, 5, 8},
                          {0, 4, 5, 1, 8},
                          {2, 3, 7, 6, 8},
                          {0, 2, 6, 4, 8},
                          {1, 5, 7, 3, 8}}},
    [CDEM_SHAPE_WEDGE6] = {CDEM_SHAPE_WEDGE6,
                           {CDEM_SHAPE_TRI3, CDEM_SHAPE_QUAD4},
                           2,
                           {{0, 1, 3, 4, 5, 7}, {0, 3, 2, 4, 7, 6}}},
    [CDEM_SHAPE_HEX8] = {CDEM_SHAPE_HEX8, {0, CDEM_SHAPE_QUAD4}, 1, {{0, 1, 3, 2, 4, 5, 7, 6}}},
    [CDEM_SHAPE_HEX20] = {CDEM_SHAPE_HEX20, {0, CDEM_SHAPE_QUAD8}, 1, {{0, 1, 3, 2, 4, 5, 7, 6}}},
};

typedef struct {
  const cdem_mesh_grid_options *options;
  const cdem_shape_info *info;
  const template *cut;
  int dimension;
  int64_t bricks[3];     /* 1 in the unused direction, of which no corner is taken */
  int64_t points[3];     /* grid points a direction; 1 in the unused direction */
  int64_t middle[8];     /* first mid node of edges in direction d, -1: this shape has none */
  int64_t centre;        /* first centre node, -1: none */
  int64_t nodes, inside; /* all nodes; cells of the body */
  int64_t side_cells;
} grid;

static int bit(int corner, int axis) {
  return corner >> axis & 1;
}

static int64_t point_id(const grid *box, int64_t i, int64_t j, int64_t k) {
  return i + box->points[0] * (j + box->points[1] * k);
}

/* Edges in direction d start at points[axis] - d[axis] points. */
static int64_t edge_span(const grid *box, int d, int axis) {
  return box->points[axis] - bit(d, axis);
}

/* Mesh node of a brick's corner (or centre, 8). */
static int64_t corner_node(const grid *box, const int64_t brick[3], int corner) {
  if (corner == 8)
    return box->centre + brick[0] + box->bricks[0] * (brick[1] + box->bricks[1] * brick[2]);
  return point_id(box, brick[0] + bit(corner, 0), brick[1] + bit(corner, 1),
                  brick[2] + bit(corner, 2));
}

/* Mesh node in the middle of an edge of a brick. Along an edge no bit goes down while another goes
 * up, so the common bits are its start. */
static int64_t middle_node(const grid *box, const int64_t brick[3], int a, int b) {
  int start = a & b, d = a ^ b;
  return box->middle[d] + brick[0] + bit(start, 0) +
         edge_span(box, d, 0) *
             (brick[1] + bit(start, 1) + edge_span(box, d, 1) * (brick[2] + bit(start, 2)));
}

/* Node ids of cell `index` of the template in a brick. */
static void cell_nodes(const grid *box, const int64_t brick[3], int index, int32_t *node) {
  const int8_t *corner = box->cut->corner[index];
  for (int c = 0; c < box->info->corners; c++)
    node[c] = (int32_t)corner_node(box, brick, corner[c]);
  for (int e = 0; e < box->info->edges && box->info->edge[e][2] >= 0; e++) {
    const int8_t *edge = box->info->edge[e];
    node[edge[2]] = (int32_t)middle_node(box, brick, corner[edge[0]], corner[edge[1]]);
  }
}

/* Facets of cell `index` that lie on side (axis, value) of the brick: local nodes of the next one
 * from *at on, or 0. */
static int next_side_facet(const grid *box, int index, int axis, int value, int *at,
                           int8_t local[8], int *corners) {
  const cdem_shape_info *info = box->info;
  for (int facets = info->dimension == 3 ? info->faces : info->edges; *at < facets;) {
    int f = (*at)++, nodes = 0, limit = info->dimension == 3 ? 8 : 3;
    const int8_t *list = info->dimension == 3 ? info->face[f] : info->edge[f];
    *corners = info->dimension == 3 ? info->face_corners[f] : 2;
    bool on_side = true;
    for (int c = 0; c < *corners; c++) {
      int corner = box->cut->corner[index][list[c]];
      on_side &= corner < 8 && bit(corner, axis) == value;
    }
    for (; on_side && nodes < limit && list[nodes] >= 0; nodes++)
      local[nodes] = list[nodes];
    if (on_side)
      return nodes;
  }
  return 0;
}

static cdem_status check_options(const cdem_mesh_grid_options *options, cdem_fault *fault) {
  CDEM_REQUIRE((int)options->shape >= 0 && options->shape < CDEM_SHAPE_COUNT &&
                   templates[options->shape].cells > 0,
               fault, CDEM_USAGE, "a grid cannot be made of shape '%s'",
               (int)options->shape >= 0 && options->shape < CDEM_SHAPE_COUNT
                   ? cdem_shape_get(options->shape)->name
                   : "?");
  int dimension = cdem_shape_get(options->shape)->dimension;
  CDEM_REQUIRE(dimension == 3 || options->count[2] == 0, fault, CDEM_USAGE,
               "a plane grid of %s takes 0 cells along z, not %" PRId32,
               cdem_shape_get(options->shape)->name, options->count[2]);
  for (int i = 0; i < dimension; i++) {
    CDEM_REQUIRE(options->count[i] > 0, fault, CDEM_USAGE,
                 "a grid needs at least 1 cell along %c, not %" PRId32, 'x' + i, options->count[i]);
    CDEM_REQUIRE(options->size[i] > 0 && isfinite(options->size[i]), fault, CDEM_USAGE,
                 "the size of a grid along %c is %g m; it must be positive", 'x' + i,
                 options->size[i]);
  }
  CDEM_REQUIRE(options->distortion >= 0 && options->distortion <= largest_distortion, fault,
               CDEM_USAGE, "the distortion of a grid is %g; it must be from 0 to %g",
               options->distortion, largest_distortion);
  return CDEM_OK;
}

/* Numbers everything: grid points, then mid nodes by direction, then centres. */
static cdem_status plan(const cdem_mesh_grid_options *options, grid *box, cdem_fault *fault) {
  CDEM_TRY(check_options(options, fault));
  *box = (grid){.options = options,
                .info = cdem_shape_get(options->shape),
                .cut = &templates[options->shape],
                .centre = -1};
  box->dimension = box->info->dimension;
  double bricks = 1;
  for (int i = 0; i < 3; i++) {
    box->bricks[i] = i < box->dimension ? options->count[i] : 1;
    box->points[i] = i < box->dimension ? box->bricks[i] + 1 : 1;
    bricks *= (double)box->bricks[i];
  }
  CDEM_REQUIRE(bricks <= INT32_MAX, fault, CDEM_USAGE,
               "a grid of %g bricks is too large: at most %" PRId32 " fit", bricks, INT32_MAX);
  box->nodes = box->points[0] * box->points[1] * box->points[2];
  bool present[8] = {false};
  for (int c = 0; c < box->cut->cells; c++)
    for (int e = 0; e < box->info->edges && box->info->edge[e][2] >= 0; e++)
      present[box->cut->corner[c][box->info->edge[e][0]] ^
              box->cut->corner[c][box->info->edge[e][1]]] = true;
  for (int d = 1; d < 8; d++) {
    box->middle[d] = present[d] ? box->nodes : -1;
    if (present[d])
      box->nodes += edge_span(box, d, 0) * edge_span(box, d, 1) * edge_span(box, d, 2);
  }
  int64_t total = box->bricks[0] * box->bricks[1] * box->bricks[2];
  if (options->shape == CDEM_SHAPE_PYR5) {
    box->centre = box->nodes;
    box->nodes += total;
  }
  box->inside = total * box->cut->cells;
  for (int axis = 0; axis < box->dimension; axis++)
    for (int value = 0; value < 2; value++)
      for (int c = 0; c < box->cut->cells; c++) {
        int8_t local[8];
        int at = 0, corners;
        while (next_side_facet(box, c, axis, value, &at, local, &corners) > 0)
          box->side_cells += total / box->bricks[axis];
      }
  return CDEM_OK;
}

/* A random vector of the unit ball (disc), by rejection. */
static void random_vector(cdem_random *random, int dimension, double u[3]) {
  double norm2;
  do {
    norm2 = 0;
    for (int i = 0; i < dimension; i++) {
      u[i] = cdem_random_uniform(random, -1, 1);
      norm2 += u[i] * u[i];
    }
  } while (norm2 > 1);
}

static void place_points(const grid *box, double *xyz) {
  const cdem_mesh_grid_options *options = box->options;
  cdem_random random = {options->seed};
  double step[3] = {0};
  for (int i = 0; i < box->dimension; i++)
    step[i] = options->size[i] / (double)box->bricks[i];
  int64_t at[3];
  for (at[2] = 0; at[2] < box->points[2]; at[2]++)
    for (at[1] = 0; at[1] < box->points[1]; at[1]++)
      for (at[0] = 0; at[0] < box->points[0]; at[0]++, xyz += 3) {
        bool inner = options->distortion > 0;
        for (int i = 0; i < box->dimension; i++)
          inner &= at[i] > 0 && at[i] < box->bricks[i];
        double u[3] = {0};
        if (inner)
          random_vector(&random, box->dimension, u);
        for (int i = 0; i < 3; i++) /* the last plane must be the size to the last bit */
          xyz[i] = i < box->dimension && at[i] == box->bricks[i]
                       ? options->size[i]
                       : ((double)at[i] + options->distortion * u[i]) * step[i];
      }
}

static void place_middles(const grid *box, double *xyz) {
  for (int d = 1; d < 8; d++) {
    if (box->middle[d] < 0)
      continue;
    double *out = xyz + 3 * box->middle[d];
    for (int64_t k = 0; k < edge_span(box, d, 2); k++)
      for (int64_t j = 0; j < edge_span(box, d, 1); j++)
        for (int64_t i = 0; i < edge_span(box, d, 0); i++, out += 3) {
          const double *a = xyz + 3 * point_id(box, i, j, k);
          const double *b = xyz + 3 * point_id(box, i + bit(d, 0), j + bit(d, 1), k + bit(d, 2));
          for (int x = 0; x < 3; x++)
            out[x] = 0.5 * (a[x] + b[x]);
        }
  }
}

static void place_centres(const grid *box, double *xyz) {
  double *out = xyz + 3 * box->centre;
  int64_t brick[3];
  for (brick[2] = 0; brick[2] < box->bricks[2]; brick[2]++)
    for (brick[1] = 0; brick[1] < box->bricks[1]; brick[1]++)
      for (brick[0] = 0; brick[0] < box->bricks[0]; brick[0]++, out += 3)
        for (int c = 0; c < 8; c++)
          for (int x = 0; x < 3; x++)
            out[x] += 0.125 * xyz[3 * corner_node(box, brick, c) + x];
}

/* The arrays are reserved; appending a cell is writing behind the last one. */
static void append_cell(cdem_mesh *mesh, cdem_shape shape, const int32_t *node) {
  int nodes = cdem_shape_get(shape)->nodes;
  int64_t start = mesh->cell_start[mesh->cells];
  memcpy(mesh->cell_node + start, node, (size_t)nodes * sizeof *node);
  mesh->cell_shape[mesh->cells] = (uint8_t)shape;
  mesh->cell_tag[mesh->cells] = (int64_t)mesh->cells + 1;
  mesh->cell_start[++mesh->cells] = start + nodes;
}

static void fill_body(const grid *box, cdem_mesh *mesh) {
  int64_t brick[3];
  for (brick[2] = 0; brick[2] < box->bricks[2]; brick[2]++)
    for (brick[1] = 0; brick[1] < box->bricks[1]; brick[1]++)
      for (brick[0] = 0; brick[0] < box->bricks[0]; brick[0]++)
        for (int c = 0; c < box->cut->cells; c++) {
          int32_t node[CDEM_SHAPE_MAX_NODES];
          cell_nodes(box, brick, c, node);
          append_cell(mesh, box->options->shape, node);
        }
}

static void append_side_facets(const grid *box, const int64_t brick[3], int axis, int value,
                               cdem_mesh *mesh) {
  for (int c = 0; c < box->cut->cells; c++) {
    int32_t node[CDEM_SHAPE_MAX_NODES], facet[8];
    int8_t local[8];
    int at = 0, corners, nodes;
    while ((nodes = next_side_facet(box, c, axis, value, &at, local, &corners)) > 0) {
      cell_nodes(box, brick, c, node);
      for (int n = 0; n < nodes; n++)
        facet[n] = node[local[n]];
      append_cell(mesh, box->cut->side[corners == 3 ? 0 : 1], facet);
    }
  }
}

static void fill_side(const grid *box, int axis, int value, cdem_mesh *mesh) {
  int64_t low[3] = {0}, high[3], brick[3];
  memcpy(high, box->bricks, sizeof high);
  low[axis] = value == 0 ? 0 : box->bricks[axis] - 1;
  high[axis] = low[axis] + 1;
  for (brick[2] = low[2]; brick[2] < high[2]; brick[2]++)
    for (brick[1] = low[1]; brick[1] < high[1]; brick[1]++)
      for (brick[0] = low[0]; brick[0] < high[0]; brick[0]++)
        append_side_facets(box, brick, axis, value, mesh);
}

/* The cells from `first` to the end of the mesh as a group. */
static cdem_status group_from(cdem_mesh *mesh, const char *name, int dimension, int32_t first,
                              cdem_fault *fault) {
  int32_t *cell;
  CDEM_NEW(cell, mesh->cells - first, fault);
  for (int32_t c = first; c < mesh->cells; c++)
    cell[c - first] = c;
  cdem_status status = cdem_mesh_add_group(mesh, name, dimension, mesh->cells - first, cell, fault);
  free(cell);
  return status;
}

static cdem_status fill(const grid *box, cdem_mesh *mesh, cdem_fault *fault) {
  /* The larger kind of side cell: wedges and pyramids have both. */
  int side_nodes = cdem_shape_get(box->cut->side[1] ? box->cut->side[1] : box->cut->side[0])->nodes;
  CDEM_TRY(cdem_mesh_reserve(mesh, box->nodes, box->inside + box->side_cells,
                             box->inside * box->info->nodes + box->side_cells * side_nodes, fault));
  place_points(box, mesh->xyz);
  place_middles(box, mesh->xyz);
  if (box->centre >= 0)
    place_centres(box, mesh->xyz);
  mesh->nodes = (int32_t)box->nodes;
  for (int64_t n = 0; n < box->nodes; n++)
    mesh->node_tag[n] = n + 1;
  fill_body(box, mesh);
  CDEM_TRY(group_from(mesh, "body", box->dimension, 0, fault));
  for (int axis = 0; axis < box->dimension; axis++)
    for (int value = 0; value < 2; value++) {
      const char name[3] = {(char)('x' + axis), (char)('0' + value), '\0'};
      int32_t first = mesh->cells;
      fill_side(box, axis, value, mesh);
      CDEM_TRY(group_from(mesh, name, box->dimension - 1, first, fault));
    }
  return CDEM_OK;
}

cdem_status cdem_mesh_grid(const cdem_mesh_grid_options *options, cdem_mesh *mesh,
                           cdem_fault *fault) {
  grid box;
  cdem_mesh built = {0};
  cdem_status status = plan(options, &box, fault);
  if (status == CDEM_OK)
    status = fill(&box, &built, fault);
  if (status != CDEM_OK)
    cdem_mesh_release(&built);
  *mesh = built;
  return status;
}
