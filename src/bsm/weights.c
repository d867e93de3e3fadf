#include "bsm/weights.h"

#include "base/mat3.h"
#include "base/memory.h"
#include "elements/elements.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_weights_release(cdem_weights *weights) {
  free(weights->start);
  free(weights->node);
  free(weights->n);
  free(weights->dn);
  *weights = (cdem_weights){0};
}

static const cdem_element *element_of(const cdem_mesh *mesh, int32_t cell) {
  cdem_shape shape = (cdem_shape)mesh->cell_shape[cell];
  bool solid = cdem_shape_get(shape)->dimension == 3;
  return cdem_element_for(shape, solid ? CDEM_SOLID : CDEM_PLANE);
}

/* A cell by its nodes, relative to the first of them: a mesh far from the origin keeps its digits.
 */
typedef struct {
  const cdem_element *element;
  int nodes, dim;
  double first[3], xyz[8][3], size; /* size: of the box, m */
} place;

static void place_of(const cdem_mesh *mesh, int32_t cell, place *p) {
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  p->element = element_of(mesh, cell);
  p->nodes = cdem_element_nodes(p->element);
  p->dim = cdem_element_dimension(p->element);
  p->size = 0.0;
  memcpy(p->first, mesh->xyz + 3 * (int64_t)node[0], sizeof p->first);
  for (int i = 0; i < p->nodes; i++)
    for (int c = 0; c < 3; c++) {
      p->xyz[i][c] = mesh->xyz[3 * (int64_t)node[i] + c] - p->first[c];
      p->size = fmax(p->size, fabs(p->xyz[i][c]));
    }
}

/* dx/dxi, row-major; in a plane with a unit third direction. */
static void jacobian(const place *p, const double (*dn)[3], double j[9]) {
  memset(j, 0, 9 * sizeof *j);
  for (int i = 0; i < p->nodes; i++)
    for (int r = 0; r < p->dim; r++)
      for (int c = 0; c < p->dim; c++)
        j[3 * r + c] += p->xyz[i][r] * dn[i][c];
  if (p->dim == 2)
    j[8] = 1.0;
}

/* ---- a point in a cell ---- */

/* By how much reference coordinates lie beyond a cell; 0 inside. */
static double beyond(cdem_shape shape, const double xi[3]) {
  double x = xi[0], y = xi[1], z = xi[2];
  double square = fmax(fabs(x), fabs(y)) - 1.0, line = fabs(z) - 1.0;
  double triangle = fmax(fmax(-x, -y), x + y - 1.0);
  switch (shape) {
  case CDEM_SHAPE_TRI3:
    return fmax(triangle, 0.0);
  case CDEM_SHAPE_QUAD4:
    return fmax(square, 0.0);
  case CDEM_SHAPE_TET4:
    return fmax(fmax(fmax(-x, -y), fmax(-z, x + y + z - 1.0)), 0.0);
  case CDEM_SHAPE_HEX8:
    return fmax(fmax(square, line), 0.0);
  case CDEM_SHAPE_WEDGE6:
    return fmax(fmax(triangle, line), 0.0);
  default: /* pyramid: |x|, |y| <= 1 - z, 0 <= z <= 1 */
    return fmax(fmax(fmax(fabs(x), fabs(y)) - (1.0 - z), -z), 0.0);
  }
}

/* Newton's iteration from the middle of the cell; bilinear maps of valid cells converge in a few
 * steps for points inside. Ends where the place is met to rounding before it looks at the slope,
 * which at the apex of a pyramid is none. Returns false where it does not converge: the point is
 * outside. */
static bool invert(const cdem_mesh *mesh, int32_t cell, const double x[3], double xi[3]) {
  enum { MOST_STEPS = 25 };
  place p;
  double n[8], dn[8][3], j[9], inverse[9], way = INFINITY;
  place_of(mesh, cell, &p);
  memset(xi, 0, 3 * sizeof *xi);
  for (int i = 0; i < p.nodes; i++)
    for (int c = 0; c < p.dim; c++)
      xi[c] += p.element->reference[i][c] / p.nodes;
  for (int step = 0; step < MOST_STEPS && way >= 1e-15; step++) {
    double r[3] = {0};
    p.element->shape_functions(xi, n, dn);
    for (int c = 0; c < p.dim; c++) {
      r[c] = x[c] - p.first[c];
      for (int i = 0; i < p.nodes; i++)
        r[c] -= n[i] * p.xyz[i][c];
    }
    if (cdem_norm3(r) <= 1e-16 * p.size)
      return true;
    jacobian(&p, (const double(*)[3])dn, j);
    if (!(fabs(cdem_inverse3(j, inverse)) > 0.0))
      return false;
    way = 0.0;
    for (int a = 0; a < p.dim; a++) {
      double d = cdem_dot3(inverse + 3 * a, r);
      xi[a] += d;
      way = fmax(way, fabs(d));
    }
    if (!(way < 1e3))
      return false;
  }
  return way < 1e-10; /* turning within rounding */
}

/* ---- a grid of the cells' boxes ---- */

typedef struct {
  int dim;
  double low[3], size;
  int64_t count[3], *start;
  int32_t *item; /* positions in the list of cells */
} boxes;

static void box_of(const cdem_mesh *mesh, int32_t cell, int dim, double low[3], double high[3]) {
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  int64_t nodes = mesh->cell_start[cell + 1] - mesh->cell_start[cell];
  for (int c = 0; c < 3; c++) {
    low[c] = c < dim ? INFINITY : 0.0;
    high[c] = c < dim ? -INFINITY : 0.0;
    for (int64_t i = 0; c < dim && i < nodes; i++) {
      low[c] = fmin(low[c], mesh->xyz[3 * (int64_t)node[i] + c]);
      high[c] = fmax(high[c], mesh->xyz[3 * (int64_t)node[i] + c]);
    }
    double margin = 1e-6 * (high[c] - low[c]);
    low[c] -= margin;
    high[c] += margin;
  }
}

static int64_t bin(const boxes *b, int c, double x) {
  double at = floor((x - b->low[c]) / b->size);
  if (!(at > 0.0)) /* not a number too: it is in no cell's box */
    return 0;
  return at >= (double)b->count[c] ? b->count[c] - 1 : (int64_t)at;
}

/* Visits the bins of a cell's box: counts them, or writes the cell into them. */
static void visit_bins(const cdem_mesh *mesh, const int32_t *cell, int32_t at, boxes *b,
                       int64_t *next) {
  double low[3], high[3];
  box_of(mesh, cell[at], b->dim, low, high);
  for (int64_t z = bin(b, 2, low[2]); z <= bin(b, 2, high[2]); z++)
    for (int64_t y = bin(b, 1, low[1]); y <= bin(b, 1, high[1]); y++)
      for (int64_t x = bin(b, 0, low[0]); x <= bin(b, 0, high[0]); x++) {
        int64_t k = (z * b->count[1] + y) * b->count[0] + x;
        if (next == NULL)
          b->start[k + 1]++;
        else
          b->item[next[k]++] = at;
      }
}

static cdem_status boxes_init(const cdem_mesh *mesh, int32_t cells, const int32_t *cell, boxes *b,
                              cdem_fault *fault) {
  double high[3] = {-INFINITY, -INFINITY, -INFINITY}, mean = 0.0;
  for (int c = 0; c < 3; c++)
    b->low[c] = INFINITY;
  for (int32_t k = 0; k < cells; k++) {
    double from[3], to[3], size = 0.0;
    box_of(mesh, cell[k], b->dim, from, to);
    for (int c = 0; c < 3; c++) {
      b->low[c] = fmin(b->low[c], from[c]);
      high[c] = fmax(high[c], to[c]);
      size = fmax(size, to[c] - from[c]);
    }
    mean += size / cells;
  }
  b->size = mean > 0.0 ? mean : 1.0;
  int64_t bins = 1;
  for (int c = 0; c < 3; c++) {
    double count = ceil((high[c] - b->low[c]) / b->size);
    b->count[c] = count < 1.0 ? 1 : count > 0x1p20 ? 1 << 20 : (int64_t)count;
    bins *= b->count[c];
  }
  /* A long thin set of cells must not make bins without end. */
  for (; bins > 64 * (int64_t)cells + 64; bins = b->count[0] * b->count[1] * b->count[2]) {
    b->size *= 2.0;
    for (int c = 0; c < 3; c++)
      b->count[c] = (b->count[c] + 1) / 2;
  }
  CDEM_NEW(b->start, bins + 1, fault);
  for (int32_t k = 0; k < cells; k++)
    visit_bins(mesh, cell, k, b, NULL);
  for (int64_t k = 0; k < bins; k++)
    b->start[k + 1] += b->start[k];
  int64_t *next;
  CDEM_NEW(next, bins, fault);
  memcpy(next, b->start, (size_t)bins * sizeof *next);
  b->item = cdem_allocate(b->start[bins], sizeof *b->item, fault);
  for (int32_t k = 0; b->item != NULL && k < cells; k++)
    visit_bins(mesh, cell, k, b, next);
  free(next);
  return b->item != NULL ? CDEM_OK : CDEM_MEMORY;
}

/* The first of the cells (in their order) that holds the point; -1: none. */
static int32_t find_cell(const cdem_mesh *mesh, const int32_t *cell, const boxes *b,
                         const double x[3], double xi[3]) {
  static const double inside = 1e-9;
  int64_t k = (bin(b, 2, x[2]) * b->count[1] + bin(b, 1, x[1])) * b->count[0] + bin(b, 0, x[0]);
  for (int64_t i = b->start[k]; i < b->start[k + 1]; i++) {
    int32_t at = cell[b->item[i]];
    double low[3], high[3];
    bool near = true;
    box_of(mesh, at, b->dim, low, high);
    for (int c = 0; c < b->dim; c++)
      near = near && x[c] >= low[c] && x[c] <= high[c];
    if (near && invert(mesh, at, x, xi) && beyond((cdem_shape)mesh->cell_shape[at], xi) <= inside)
      return at;
  }
  return -1;
}

cdem_status cdem_locate(const cdem_mesh *mesh, int32_t cells, const int32_t *cell, int64_t points,
                        const double *xyz, int32_t *found, double *xi, cdem_fault *fault) {
  boxes b = {.dim = cdem_mesh_dimension(mesh)};
  for (int32_t k = 0; k < cells; k++) {
    const cdem_shape_info *shape = cdem_shape_get((cdem_shape)mesh->cell_shape[cell[k]]);
    CDEM_REQUIRE(shape->nodes == shape->corners && shape->dimension == b.dim, fault, CDEM_INPUT,
                 "element %lld is a %s; grains lie in elements of first order: mesh with order 1",
                 (long long)mesh->cell_tag[cell[k]], shape->name);
  }
  cdem_status status = cells > 0 ? boxes_init(mesh, cells, cell, &b, fault) : CDEM_OK;
  for (int64_t a = 0; status == CDEM_OK && a < points; a++) {
    found[a] = cells > 0 ? find_cell(mesh, cell, &b, xyz + 3 * a, xi + 3 * a) : -1;
    if (found[a] < 0) /* nothing of a cell that was tried */
      memset(xi + 3 * a, 0, 3 * sizeof *xi);
  }
  free(b.start);
  free(b.item);
  return status;
}

/* ---- rows ---- */

static void fill_row(const cdem_mesh *mesh, int32_t cell, const double xi[3], int32_t *node,
                     double *value, double *gradient) {
  place p;
  double n[8], dn[8][3], j[9], inverse[9];
  place_of(mesh, cell, &p);
  p.element->shape_functions(xi, n, dn);
  jacobian(&p, (const double(*)[3])dn, j);
  cdem_inverse3(j, inverse);
  memcpy(node, cdem_mesh_cell(mesh, cell), (size_t)p.nodes * sizeof *node);
  memcpy(value, n, (size_t)p.nodes * sizeof *value);
  for (int i = 0; i < p.nodes; i++)
    for (int c = 0; c < p.dim; c++)
      for (int k = 0; k < p.dim; k++)
        gradient[3 * i + c] += dn[i][k] * inverse[3 * k + c];
}

cdem_status cdem_weights_init(const cdem_mesh *mesh, int64_t points, const int32_t *cell,
                              const double *xi, cdem_weights *weights, cdem_fault *fault) {
  cdem_weights w = {.points = points};
  w.start = cdem_allocate(points + 1, sizeof *w.start, fault);
  for (int64_t a = 0; w.start != NULL && a < points; a++)
    w.start[a + 1] = w.start[a] + mesh->cell_start[cell[a] + 1] - mesh->cell_start[cell[a]];
  int64_t entries = w.start != NULL ? w.start[points] : 0;
  w.node = cdem_allocate(entries, sizeof *w.node, fault);
  w.n = cdem_allocate(entries, sizeof *w.n, fault);
  w.dn = cdem_allocate(3 * entries, sizeof *w.dn, fault);
  if (w.start == NULL || w.node == NULL || w.n == NULL || w.dn == NULL) {
    cdem_weights_release(&w);
    return CDEM_MEMORY;
  }
  for (int64_t a = 0; a < points; a++)
    fill_row(mesh, cell[a], xi + 3 * a, w.node + w.start[a], w.n + w.start[a],
             w.dn + 3 * w.start[a]);
  *weights = w;
  return CDEM_OK;
}

void cdem_weights_interpolate(const cdem_weights *weights, int width, const double *d, double *u) {
  for (int64_t a = 0; a < weights->points; a++)
    for (int c = 0; c < width; c++) {
      double sum = 0.0;
      for (int64_t k = weights->start[a]; k < weights->start[a + 1]; k++)
        sum += weights->n[k] * d[(int64_t)weights->node[k] * width + c];
      u[a * width + c] = sum;
    }
}

void cdem_weights_gather(const cdem_weights *weights, int width, const double *f, double *d) {
  for (int64_t a = 0; a < weights->points; a++)
    for (int64_t k = weights->start[a]; k < weights->start[a + 1]; k++)
      for (int c = 0; c < width; c++)
        d[(int64_t)weights->node[k] * width + c] += weights->n[k] * f[a * width + c];
}
