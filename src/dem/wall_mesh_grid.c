/* The facets of a mesh wall: checked, taken into the body, and found again through a grid.
 *
 * The grid is made once, as facets do not move in the body. Cells are as large as a facet or a
 * grain on the average, so that neither asks many of them, and larger where a few large facets
 * would fill too many. A facet stands in all cells its box meets; a search reports it in one only,
 * the first that both boxes share. */
#include "base/memory.h"
#include "base/sort.h"
#include "dem/wall_mesh.h"

#include <stdlib.h>
#include <string.h>

/* ---- checks ---- */

/* Corners of a facet; false when one is missing. */
static bool corners_of(int dim, const cdem_wall *wall, int32_t facet, const double *corner[3]) {
  for (int k = 0; k < dim; k++) {
    int32_t id = wall->facet[(int64_t)dim * facet + k];
    if (id < 0 || id >= wall->corners)
      return false;
    corner[k] = wall->corner + 3 * (int64_t)id;
  }
  return true;
}

static void edges_of(int dim, const double *const corner[3], double e[2][3], double n[3]) {
  for (int c = 0; c < 3; c++) {
    e[0][c] = corner[1][c] - corner[0][c];
    e[1][c] = dim == 3 ? corner[2][c] - corner[0][c] : 0.0;
  }
  if (dim == 3) {
    cdem_cross3(e[0], e[1], n);
  } else {
    n[0] = -e[0][1];
    n[1] = e[0][0];
    n[2] = 0.0;
  }
}

/* Twice the area of a triangle is less than rounding errors leave of it when it is 1e-12 of the
 * square of its edges. */
static bool has_size(int dim, const double e[2][3], const double n[3]) {
  double size = cdem_norm3(n);
  if (dim == 2)
    return size > 0.0;
  return size > 1e-12 * fmax(cdem_dot3(e[0], e[0]), cdem_dot3(e[1], e[1]));
}

cdem_status cdem_wall_facets_check(int dim, const cdem_wall *wall, cdem_fault *fault) {
  const char *name = cdem_wall_name(wall), *shape = dim == 2 ? "segment" : "triangle";
  CDEM_REQUIRE(wall->facets >= 1 && wall->corners >= dim && wall->facet != NULL &&
                   wall->corner != NULL,
               fault, CDEM_INPUT,
               "wall '%s': a mesh of %d corners and %d facets is none; it needs at least one %s",
               name, wall->corners, wall->facets, shape);
  for (int64_t k = 0; k < 3 * (int64_t)wall->corners; k++)
    CDEM_REQUIRE(isfinite(wall->corner[k]) && (dim == 3 || k % 3 != 2 || wall->corner[k] == 0.0),
                 fault, CDEM_INPUT, "wall '%s': component %d of corner %d is %g m; it must be %s",
                 name, (int)(k % 3), (int)(k / 3), wall->corner[k],
                 k % 3 == 2 && dim == 2 ? "0 in 2-D" : "finite");
  for (int32_t f = 0; f < wall->facets; f++) {
    const double *corner[3];
    double e[2][3], n[3];
    CDEM_REQUIRE(corners_of(dim, wall, f, corner), fault, CDEM_INPUT,
                 "wall '%s': facet %d names a corner that is not among its %d", name, f,
                 wall->corners);
    edges_of(dim, corner, e, n);
    CDEM_REQUIRE(has_size(dim, (const double(*)[3])e, n), fault, CDEM_INPUT,
                 "wall '%s': facet %d, a %s at (%g, %g, %g) m, has no size; remove it", name, f,
                 shape, corner[0][0], corner[0][1], corner[0][2]);
  }
  return CDEM_OK;
}

/* ---- making ---- */

static void take_facet(int dim, const cdem_wall *wall, int32_t f, cdem_wall_facet *facet) {
  const double *corner[3] = {NULL, NULL, NULL};
  corners_of(dim, wall, f, corner);
  edges_of(dim, corner, facet->e, facet->n);
  cdem_wall_unit(facet->n);
  for (int c = 0; c < 3; c++) {
    facet->a[c] = corner[0][c] - wall->center[c];
    facet->e[2][c] = facet->e[1][c] - facet->e[0][c];
  }
  for (int k = 0; k < (dim == 2 ? 1 : 3); k++) {
    facet->inverse[k] = 1.0 / cdem_dot3(facet->e[k], facet->e[k]);
    /* n x e points into the triangle from a b, out of it from a c, into it from b c */
    cdem_cross3(facet->n, facet->e[k], facet->out[k]);
    cdem_wall_unit(facet->out[k]);
    for (int c = 0; k != 1 && c < 3; c++)
      facet->out[k][c] = -facet->out[k][c];
  }
  facet->offset = cdem_dot3(facet->out[2], facet->e[0]);
}

static void facet_box(const cdem_wall_facet *f, double low[3], double high[3]) {
  for (int c = 0; c < 3; c++) {
    low[c] = f->a[c] + fmin(0.0, fmin(f->e[0][c], f->e[1][c]));
    high[c] = f->a[c] + fmax(0.0, fmax(f->e[0][c], f->e[1][c]));
  }
}

/* Cells of a box, cut to the grid. */
static void cells_of(const cdem_wall_facets *mesh, const double low[3], const double high[3],
                     int32_t from[3], int32_t to[3]) {
  for (int c = 0; c < 3; c++) {
    double a = floor((low[c] - mesh->low[c]) / mesh->cell);
    double b = floor((high[c] - mesh->low[c]) / mesh->cell);
    double last = mesh->cells[c] - 1;
    from[c] = (int32_t)fmax(0.0, fmin(a, last));
    to[c] = (int32_t)fmax(0.0, fmin(b, last));
  }
}

/* Mean size of facets, or of grains if that is more. */
static double first_cell(const cdem_wall_facets *mesh, const cdem_grains *grains) {
  double size = 0.0, radius = 0.0;
  for (int32_t f = 0; f < mesh->facets; f++) {
    double low[3], high[3];
    facet_box(mesh->facet + f, low, high);
    size += fmax(high[0] - low[0], fmax(high[1] - low[1], high[2] - low[2]));
  }
  size /= mesh->facets;
  for (int64_t i = 0; grains != NULL && i < grains->grains; i++)
    radius += grains->radius[i];
  if (grains != NULL && grains->grains > 0)
    radius /= (double)grains->grains;
  return fmax(size, radius);
}

static double count_cells(cdem_wall_facets *mesh) {
  double cells = 1.0;
  for (int c = 0; c < 3; c++) {
    double along = floor((mesh->high[c] - mesh->low[c]) / mesh->cell) + 1.0;
    cells *= along;
    mesh->cells[c] = along < 1e9 ? (int32_t)along : 1000000000;
  }
  return cells;
}

static double count_members(const cdem_wall_facets *mesh) {
  double members = 0.0;
  for (int32_t f = 0; f < mesh->facets; f++) {
    double low[3], high[3];
    int32_t from[3], to[3];
    facet_box(mesh->facet + f, low, high);
    cells_of(mesh, low, high, from, to);
    members += (double)(to[0] - from[0] + 1) * (to[1] - from[1] + 1) * (to[2] - from[2] + 1);
  }
  return members;
}

static int64_t cell_at(const cdem_wall_facets *mesh, int32_t x, int32_t y, int32_t z) {
  return ((int64_t)z * mesh->cells[1] + y) * mesh->cells[0] + x;
}

static cdem_status fill_grid(cdem_wall_facets *mesh, cdem_fault *fault) {
  int64_t cells = (int64_t)mesh->cells[0] * mesh->cells[1] * mesh->cells[2];
  CDEM_NEW(mesh->first, cells + 2, fault);
  for (int pass = 0; pass < 2; pass++) {
    for (int32_t f = 0; f < mesh->facets; f++) {
      double low[3], high[3];
      int32_t from[3], to[3];
      facet_box(mesh->facet + f, low, high);
      cells_of(mesh, low, high, from, to);
      for (int32_t z = from[2]; z <= to[2]; z++)
        for (int32_t y = from[1]; y <= to[1]; y++)
          for (int32_t x = from[0]; x <= to[0]; x++) {
            int64_t cell = cell_at(mesh, x, y, z);
            if (pass == 0)
              mesh->first[cell + 2]++;
            else
              mesh->member[mesh->first[cell + 1]++] = f;
          }
    }
    if (pass == 1)
      break;
    for (int64_t k = 0; k < cells; k++)
      mesh->first[k + 2] += mesh->first[k + 1];
    CDEM_NEW(mesh->member, mesh->first[cells + 1], fault);
  }
  return CDEM_OK;
}

cdem_status cdem_wall_facets_init(cdem_wall_body *body, int dim, const cdem_grains *grains,
                                  cdem_fault *fault) {
  cdem_wall_facets *mesh;
  CDEM_NEW(mesh, 1, fault);
  body->facets = mesh;
  mesh->dim = dim;
  mesh->facets = body->wall.facets;
  CDEM_NEW(mesh->facet, mesh->facets, fault);
  double extent = 0.0;
  for (int32_t f = 0; f < mesh->facets; f++) {
    double low[3], high[3];
    take_facet(dim, &body->wall, f, mesh->facet + f);
    facet_box(mesh->facet + f, low, high);
    for (int c = 0; c < 3; c++) {
      mesh->low[c] = f == 0 ? low[c] : fmin(mesh->low[c], low[c]);
      mesh->high[c] = f == 0 ? high[c] : fmax(mesh->high[c], high[c]);
    }
  }
  for (int c = 0; c < 3; c++)
    extent = fmax(extent, mesh->high[c] - mesh->low[c]);
  /* Surfaces come in single precision (binary STL): corners are right to 2^-24 of their size. */
  mesh->close = extent * 0x1p-22;
  /* Doubled until cells and members are a fixed number a facet. */
  mesh->cell = first_cell(mesh, grains);
  double bound = 16.0 * mesh->facets + 64.0;
  while (count_cells(mesh) > bound || count_members(mesh) > bound)
    mesh->cell *= 2.0;
  return fill_grid(mesh, fault);
}

void cdem_wall_facets_release(cdem_wall_body *body) {
  if (body->facets == NULL)
    return;
  free(body->facets->facet);
  free(body->facets->first);
  free(body->facets->member);
  free(body->facets);
  body->facets = NULL;
}

/* ---- searching ---- */

/* Is this cell the first that the boxes of search and facet share? */
static bool first_shared(const cdem_wall_facets *mesh, int32_t f, const int32_t from[3],
                         const int32_t cell[3]) {
  double low[3], high[3];
  int32_t facet_from[3], facet_to[3];
  facet_box(mesh->facet + f, low, high);
  cells_of(mesh, low, high, facet_from, facet_to);
  for (int c = 0; c < 3; c++)
    if (cell[c] != (facet_from[c] > from[c] ? facet_from[c] : from[c]))
      return false;
  return true;
}

static int ascending(const void *a, const void *b) {
  int32_t x = ((const cdem_wall_candidate *)a)->facet, y = ((const cdem_wall_candidate *)b)->facet;
  return (x > y) - (x < y);
}

static cdem_status collect_one(const cdem_wall_facets *mesh, const double x[3], double within,
                               cdem_wall_candidate next, cdem_wall_list *list, cdem_fault *fault) {
  double low[3], high[3];
  int32_t from[3], to[3], cell[3];
  int64_t before = list->count;
  for (int c = 0; c < 3; c++) {
    low[c] = x[c] - within;
    high[c] = x[c] + within;
    if (low[c] > mesh->high[c] || high[c] < mesh->low[c])
      return CDEM_OK;
  }
  cells_of(mesh, low, high, from, to);
  for (cell[2] = from[2]; cell[2] <= to[2]; cell[2]++)
    for (cell[1] = from[1]; cell[1] <= to[1]; cell[1]++)
      for (cell[0] = from[0]; cell[0] <= to[0]; cell[0]++) {
        int64_t k = cell_at(mesh, cell[0], cell[1], cell[2]);
        for (int32_t m = mesh->first[k]; m < mesh->first[k + 1]; m++) {
          cdem_facet_near near;
          next.facet = mesh->member[m];
          if (cdem_facet_nearest(mesh->dim, mesh->facet + next.facet, x, within, &near) &&
              first_shared(mesh, next.facet, from, cell))
            CDEM_TRY(cdem_wall_list_add(list, next.grain, next.wall, next.facet, fault));
        }
      }
  if (list->count - before > 1)
    cdem_sort(list->item + before, list->count - before, sizeof *list->item, ascending);
  return CDEM_OK;
}

cdem_status cdem_wall_facets_collect(const cdem_dem_store *s, int32_t wall, cdem_wall_list *list,
                                     cdem_fault *fault) {
  const cdem_wall_body *body = s->walls->body + wall;
  for (int64_t i = 0; i < s->grains; i++) {
    const double *place = cdem_place(s, i);
    double p[3], x[3];
    for (int c = 0; c < 3; c++)
      p[c] = place[c] - body->center[c];
    cdem_wall_turned_back(body->turn, p, x);
    cdem_wall_candidate next = {(int32_t)i, wall, 0};
    CDEM_TRY(collect_one(body->facets, x, place[3] + 0.5 * s->skin, next, list, fault));
  }
  return CDEM_OK;
}
