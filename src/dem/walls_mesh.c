/* From a mesh that was read to the facets of a mesh wall. */
#include "base/memory.h"
#include "dem/walls.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_wall_mesh_release(cdem_wall_mesh *surface) {
  free(surface->corner);
  free(surface->facet);
  *surface = (cdem_wall_mesh){0};
}

typedef struct {
  int dim;
  const cdem_mesh *mesh;
  int32_t *corner_of; /* [nodes] corner, -1: none yet */
  cdem_wall_mesh made;
} taking;

static bool has_size(const taking *t, const int32_t *node) {
  const double *x = t->mesh->xyz;
  double e[2][3], square[2] = {0.0, 0.0}, dot = 0.0;
  for (int c = 0; c < t->dim; c++) {
    for (int k = 0; k < t->dim - 1; k++) {
      e[k][c] = x[3 * (int64_t)node[k + 1] + c] - x[3 * (int64_t)node[0] + c];
      square[k] += e[k][c] * e[k][c];
    }
    dot += t->dim == 3 ? e[0][c] * e[1][c] : 0.0;
  }
  if (t->dim == 2)
    return square[0] > 0.0;
  double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                 e[0][0] * e[1][1] - e[0][1] * e[1][0]};
  double area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  /* A little above the bound of cdem_wall_check, so that what is taken passes there. */
  return area > 4e-12 * fmax(square[0], square[1]);
}

static void take_facet(taking *t, const int32_t *node) {
  if (!has_size(t, node)) {
    t->made.dropped++;
    return;
  }
  int32_t *facet = t->made.facet + (int64_t)t->dim * t->made.facets++;
  for (int k = 0; k < t->dim; k++) {
    int32_t *corner = t->corner_of + node[k];
    if (*corner < 0) {
      *corner = t->made.corners++;
      double *to = t->made.corner + 3 * (int64_t)*corner;
      memcpy(to, t->mesh->xyz + 3 * (int64_t)node[k], 3 * sizeof *to);
      if (t->dim == 2)
        to[2] = 0.0;
    }
    facet[k] = *corner;
  }
}

/* A quadrilateral is cut along its shorter diagonal, the first where they are equal. */
static void take_cell(taking *t, int32_t cell) {
  const cdem_shape_info *info = cdem_shape_get((cdem_shape)t->mesh->cell_shape[cell]);
  const int32_t *n = cdem_mesh_cell(t->mesh, cell);
  if (info->corners != 4 || t->dim == 2) {
    take_facet(t, n);
    return;
  }
  double diagonal[2] = {0.0, 0.0};
  for (int k = 0; k < 2; k++)
    for (int c = 0; c < 3; c++) {
      double d = t->mesh->xyz[3 * (int64_t)n[k + 2] + c] - t->mesh->xyz[3 * (int64_t)n[k] + c];
      diagonal[k] += d * d;
    }
  int s = diagonal[1] < diagonal[0];
  const int32_t one[3] = {n[s], n[s + 1], n[s + 2]}, two[3] = {n[s], n[s + 2], n[(s + 3) % 4]};
  take_facet(t, one);
  take_facet(t, two);
}

static bool is_facet(const taking *t, int32_t cell) {
  return cdem_shape_get((cdem_shape)t->mesh->cell_shape[cell])->dimension == t->dim - 1;
}

static cdem_status take_cells(taking *t, const cdem_group *group, cdem_fault *fault) {
  int32_t cells = group != NULL ? group->cells : t->mesh->cells;
  int64_t most = 0;
  for (int32_t k = 0; k < cells; k++)
    most += is_facet(t, group != NULL ? group->cell[k] : k) ? 2 : 0;
  CDEM_NEW(t->corner_of, t->mesh->nodes, fault);
  CDEM_NEW(t->made.corner, 3 * (int64_t)t->mesh->nodes, fault);
  CDEM_NEW(t->made.facet, t->dim * most, fault);
  CDEM_REQUIRE(most < INT32_MAX, fault, CDEM_INPUT, "the surface has more than %d facets",
               INT32_MAX);
  for (int32_t k = 0; k < t->mesh->nodes; k++)
    t->corner_of[k] = -1;
  for (int32_t k = 0; k < cells; k++) {
    int32_t cell = group != NULL ? group->cell[k] : k;
    if (is_facet(t, cell))
      take_cell(t, cell);
  }
  CDEM_REQUIRE(t->made.facets > 0, fault, CDEM_INPUT,
               "the mesh%s%s%s has no %s for a wall (%d of no size); mesh the surface, or name the "
               "group of its boundary",
               group != NULL ? " group '" : "", group != NULL ? group->name : "",
               group != NULL ? "'" : "", t->dim == 3 ? "triangles or quadrilaterals" : "lines",
               t->made.dropped);
  return CDEM_OK;
}

cdem_status cdem_wall_take_surface(int dim, const cdem_mesh *mesh, const cdem_group *group,
                                   cdem_wall_mesh *surface, cdem_fault *fault) {
  taking t = {.dim = dim, .mesh = mesh};
  *surface = (cdem_wall_mesh){0};
  CDEM_REQUIRE(group == NULL || group->dimension == dim - 1, fault, CDEM_INPUT,
               "group '%s' has cells of dimension %d; a wall in %d-D is made of cells of dimension "
               "%d",
               group->name, group->dimension, dim, dim - 1);
  cdem_status status = take_cells(&t, group, fault);
  free(t.corner_of);
  if (status == CDEM_OK)
    *surface = t.made;
  else
    cdem_wall_mesh_release(&t.made);
  return status;
}
