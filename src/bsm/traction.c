#include "bsm/traction.h"

#include "base/mat3.h"
#include "base/memory.h"
#include "bsm/face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool touches(const cdem_bsm_frame *f, const cdem_grains *grains, int64_t i, double reach,
                    double margin) {
  const double *x = grains->xyz + 3 * i;
  double way[3];
  for (int c = 0; c < 3; c++)
    way[c] = x[c] - f->x[0][c];
  double depth = -cdem_dot3(way, f->normal), radius = grains->radius[i];
  return depth >= -radius && depth <= radius + reach && cdem_bsm_on_face(f, x, margin * radius);
}

static bool is_driven(const cdem_grains *grains, int64_t i) {
  return grains->motion != NULL && grains->motion[i] == CDEM_GRAIN_DRIVEN;
}

static double largest_radius(const cdem_grains *grains) {
  double largest = 0.0;
  for (int64_t i = 0; i < grains->grains; i++)
    largest = fmax(largest, grains->radius[i]);
  return largest;
}

void cdem_bsm_touching(const cdem_mesh *mesh, int64_t faces, const cdem_bsm_face *face,
                       const cdem_grains *grains, double gap, bool *touch) {
  double reach = gap * largest_radius(grains);
  for (int64_t k = 0; k < faces; k++) {
    cdem_bsm_frame f;
    cdem_bsm_frame_of(mesh, face[k].corners, face[k].node, &f);
    for (int64_t i = 0; i < grains->grains; i++)
      touch[i] = touch[i] || touches(&f, grains, i, reach, 1.0);
  }
}

/* ---- eq. (18) ---- */

typedef struct {
  double s; /* along the face, from its first corner, m */
  int64_t grain;
} stop;

static int compare_stops(const void *a, const void *b) {
  const stop *x = a, *y = b;
  if (x->s != y->s)
    return x->s < y->s ? -1 : 1;
  return (x->grain > y->grain) - (x->grain < y->grain);
}

typedef struct {
  double thickness, *area, *normal;
} sums;

static void add(const sums *to, const double normal[3], int64_t grain, double area) {
  to->area[grain] += area;
  for (int c = 0; c < 3; c++)
    to->normal[3 * grain + c] += area * normal[c];
}

/* Hats between the stops, constant beyond the first and the last: over the piece from p to q their
 * mean is their value in its middle. */
static void hats(const cdem_bsm_frame *f, int64_t count, const stop *at, const sums *to) {
  double from = 0.0;
  for (int64_t i = 0; i <= count && from < f->length; i++) {
    double end = i < count ? fmin(fmax(at[i].s, 0.0), f->length) : f->length;
    double middle = 0.5 * (from + end), area = (end - from) * to->thickness;
    if (end <= from)
      continue;
    if (i == 0 || i == count) {
      add(to, f->normal, at[i == 0 ? 0 : count - 1].grain, area);
    } else {
      double t = (middle - at[i - 1].s) / (at[i].s - at[i - 1].s);
      add(to, f->normal, at[i - 1].grain, (1.0 - t) * area);
      add(to, f->normal, at[i].grain, t * area);
    }
    from = end;
  }
}

/* Place at u, v of the unit square or triangle, and the area vector there: of a quadrilateral that
 * is not flat it turns. Linear in u and v each, so that sums over middles of parts are exact. */
static void place_on(const cdem_bsm_frame *f, double u, double v, double x[3], double area[3]) {
  double n[4], du[4], dv[4], a[3] = {0}, b[3] = {0};
  if (f->corners == 3) {
    const double n3[3] = {1.0 - u - v, u, v}, u3[3] = {-1, 1, 0}, v3[3] = {-1, 0, 1};
    memcpy(n, n3, sizeof n3);
    memcpy(du, u3, sizeof u3);
    memcpy(dv, v3, sizeof v3);
  } else {
    const double n4[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    const double u4[4] = {v - 1, 1 - v, v, -v}, v4[4] = {u - 1, -u, u, 1 - u};
    memcpy(n, n4, sizeof n4);
    memcpy(du, u4, sizeof u4);
    memcpy(dv, v4, sizeof v4);
  }
  memset(x, 0, 3 * sizeof *x);
  for (int i = 0; i < f->corners; i++)
    for (int c = 0; c < 3; c++) {
      x[c] += n[i] * f->x[i][c];
      a[c] += du[i] * f->x[i][c];
      b[c] += dv[i] * f->x[i][c];
    }
  cdem_cross3(a, b, area);
}

static int64_t nearest(const cdem_bsm_frame *f, const cdem_grains *grains, int64_t count,
                       const stop *at, const double x[3]) {
  double least = INFINITY;
  int64_t best = 0;
  for (int64_t i = 0; i < count; i++) {
    double d[3], above;
    for (int c = 0; c < 3; c++)
      d[c] = grains->xyz[3 * at[i].grain + c] - x[c];
    above = cdem_dot3(d, f->normal);
    double distance2 = cdem_dot3(d, d) - above * above;
    if (distance2 < least) {
      least = distance2;
      best = at[i].grain;
    }
  }
  return best;
}

static void cells_of(const cdem_bsm_frame *f, const cdem_grains *grains, int64_t count,
                     const stop *at, const sums *to) {
  double least = INFINITY;
  for (int64_t i = 0; i < count; i++)
    least = fmin(least, grains->radius[at[i].grain]);
  double longest = 0.0; /* distances of corners */
  for (int i = 0; i < f->corners; i++)
    for (int k = 0; k < i; k++) {
      double d[3] = {f->x[i][0] - f->x[k][0], f->x[i][1] - f->x[k][1], f->x[i][2] - f->x[k][2]};
      longest = fmax(longest, cdem_norm3(d));
    }
  double wanted = ceil(4.0 * longest / least);
  int n = wanted < 8.0 ? 8 : wanted > 256.0 ? 256 : (int)wanted;
  bool triangle = f->corners == 3;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < (triangle ? 2 * (n - i) - 1 : n); j++) {
      /* a triangle falls apart into upright and hanging ones */
      double part = triangle ? (j % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0) : 0.5, x[3], normal[3];
      double u = (i + part) / n, v = ((triangle ? j / 2 : j) + part) / n;
      place_on(f, u, v, x, normal);
      double size = cdem_norm3(normal);
      for (int c = 0; c < 3; c++)
        normal[c] /= size;
      add(to, normal, nearest(f, grains, count, at, x),
          size * (triangle ? 0.5 : 1.0) / ((double)n * n));
    }
}

static cdem_status one_face(const cdem_bsm_frame *f, const cdem_grains *grains, double reach,
                            stop *at, const sums *to, cdem_fault *fault) {
  int64_t count = 0;
  bool touched = false;
  /* Hats reach over the corners of a face to the next grain beyond it. */
  for (int64_t i = 0; i < grains->grains; i++)
    if (!is_driven(grains, i) && touches(f, grains, i, reach, 3.0)) {
      double way[3];
      for (int c = 0; c < 3; c++)
        way[c] = grains->xyz[3 * i + c] - f->x[0][c];
      at[count++] = (stop){cdem_dot3(way, f->tangent), i};
      touched = touched || touches(f, grains, i, reach, 1.0);
    }
  CDEM_REQUIRE(touched, fault, CDEM_INPUT,
               "no grain touches the face at (%.4g, %.4g, %.4g m) that is loaded; let the packing "
               "reach the edge of the mesh",
               f->x[0][0], f->x[0][1], f->x[0][2]);
  qsort(at, (size_t)count, sizeof *at, compare_stops);
  if (f->dim == 2)
    hats(f, count, at, to);
  else
    cells_of(f, grains, count, at, to);
  return CDEM_OK;
}

cdem_status cdem_bsm_tributary(const cdem_mesh *mesh, int64_t faces, const cdem_bsm_face *face,
                               const cdem_grains *grains, double gap, double thickness,
                               double *area, double *normal, cdem_fault *fault) {
  double reach = gap * largest_radius(grains), *own; /* until every face has succeeded */
  int64_t n = grains->grains;
  stop *at = cdem_allocate(n, sizeof *at, fault);
  if (at == NULL)
    return CDEM_MEMORY;
  own = cdem_allocate(4 * n, sizeof *own, fault);
  cdem_status status = own != NULL ? CDEM_OK : CDEM_MEMORY;
  const sums to = {thickness, own, own != NULL ? own + n : NULL};
  for (int64_t k = 0; k < faces && status == CDEM_OK; k++) {
    cdem_bsm_frame f;
    cdem_bsm_frame_of(mesh, face[k].corners, face[k].node, &f);
    status = one_face(&f, grains, reach, at, &to, fault);
  }
  for (int64_t i = 0; status == CDEM_OK && area != NULL && i < n; i++)
    area[i] += to.area[i];
  for (int64_t i = 0; status == CDEM_OK && normal != NULL && i < 3 * n; i++)
    normal[i] += to.normal[i];
  free(own);
  free(at);
  return status;
}
