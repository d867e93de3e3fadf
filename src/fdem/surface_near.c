/* Is a place inside a deformed surface, and how deep? */
#include "fdem/surface_near.h"

#include "base/mat3.h"

static void corners(const cdem_skin *surface, const double *place, int32_t t,
                    const double *corner[3]) {
  const int32_t *node = surface->triangle + 3 * (int64_t)t;
  for (int k = 0; k < 3; k++)
    corner[k] = place + 3 * (int64_t)node[k];
}

/* Twice the area, and the normal times that. */
static double normal_of(const cdem_skin *surface, const double *place, int32_t t,
                        double normal[3]) {
  const double *corner[3];
  double ab[3], ac[3];
  corners(surface, place, t, corner);
  for (int c = 0; c < 3; c++) {
    ab[c] = corner[1][c] - corner[0][c];
    ac[c] = corner[2][c] - corner[0][c];
  }
  cdem_cross3(ab, ac, normal);
  return cdem_norm3(normal);
}

static void add_unit_normal(const cdem_skin *surface, const double *place, int32_t t, double factor,
                            double sum[3]) {
  double normal[3], twice = normal_of(surface, place, t, normal);
  for (int c = 0; c < 3 && twice > 0.0; c++)
    sum[c] += factor * normal[c] / twice;
}

static double angle_at(const cdem_skin *surface, const double *place, int32_t t, int32_t node) {
  const int32_t *at = surface->triangle + 3 * (int64_t)t;
  int k = at[0] == node ? 0 : (at[1] == node ? 1 : 2);
  const double *corner[3];
  double p[3], q[3], cross[3];
  corners(surface, place, t, corner);
  for (int c = 0; c < 3; c++) {
    p[c] = corner[(k + 1) % 3][c] - corner[k][c];
    q[c] = corner[(k + 2) % 3][c] - corner[k][c];
  }
  cdem_cross3(p, q, cross);
  return atan2(cdem_norm3(cross), cdem_dot3(p, q));
}

static void pseudo_normal(const cdem_skin *surface, const double *place, int32_t t, int feature,
                          double sum[3]) {
  sum[0] = sum[1] = sum[2] = 0.0;
  if (feature >= CDEM_NEAR_EDGE) {
    add_unit_normal(surface, place, t, 1.0, sum);
    add_unit_normal(surface, place, surface->beside[3 * (int64_t)t + feature - CDEM_NEAR_EDGE], 1.0,
                    sum);
    return;
  }
  int32_t node = surface->triangle[3 * (int64_t)t + feature];
  for (int32_t k = surface->around_from[node]; k < surface->around_from[node + 1]; k++) {
    int32_t at = surface->around[k];
    add_unit_normal(surface, place, at, angle_at(surface, place, at, node), sum);
  }
}

double cdem_near_side(const cdem_skin *surface, const double *place, int32_t t,
                      const cdem_near *near, const double y[3]) {
  const double *corner[3];
  double normal[3], out[3], u = 1.0 - near->v - near->w;
  corners(surface, place, t, corner);
  if (near->feature == CDEM_NEAR_FACE) {
    double twice = normal_of(surface, place, t, normal), dot = 0.0;
    for (int c = 0; c < 3; c++)
      dot += normal[c] * (y[c] - corner[0][c]);
    return dot / twice;
  }
  pseudo_normal(surface, place, t, near->feature, normal);
  for (int c = 0; c < 3; c++)
    out[c] = y[c] - (u * corner[0][c] + near->v * corner[1][c] + near->w * corner[2][c]);
  double distance = cdem_norm3(out);
  return cdem_dot3(normal, out) >= 0.0 ? distance : -distance;
}

/* The list of the cell that holds y; false where nothing can be inside. */
static bool look_up(const cdem_skin *surface, double scale, const double y[3], int64_t *from,
                    int64_t *to) {
  int64_t at = 0;
  double to_units = 1.0 / scale, to_cells = 1.0 / surface->cell;
  for (int c = 0; c < 3; c++) {
    double cell = (y[c] * to_units - surface->low[c]) * to_cells;
    if (!(cell >= 0.0 && cell < surface->cells))
      return false;
    at = at * surface->cells + (int64_t)cell;
  }
  int32_t list = surface->list[at];
  *from = surface->start[list];
  *to = surface->start[list + 1];
  return list > 0;
}

static void fill(const cdem_skin *surface, const double *place, int32_t t, const cdem_near *near,
                 const double y[3], cdem_skin_touch *touch) {
  const double *corner[3];
  double u = 1.0 - near->v - near->w;
  corners(surface, place, t, corner);
  touch->weight[0] = u > 0.0 ? u : 0.0;
  touch->weight[1] = near->v;
  touch->weight[2] = near->w;
  for (int k = 0; k < 3; k++)
    touch->node[k] = surface->triangle[3 * (int64_t)t + k];
  if (near->feature == CDEM_NEAR_FACE) {
    double twice = normal_of(surface, place, t, touch->normal);
    for (int c = 0; c < 3; c++)
      touch->normal[c] /= twice;
    return;
  }
  /* |p - y| as cdem_near_side has it, so that the normal is of unit length */
  for (int c = 0; c < 3; c++)
    touch->normal[c] =
        (u * corner[0][c] + near->v * corner[1][c] + near->w * corner[2][c] - y[c]) / touch->depth;
}

bool cdem_skin_touches(const cdem_skin *surface, const double *place, double scale,
                       const double y[3], cdem_skin_touch *touch) {
  int64_t from, to;
  if (!look_up(surface, scale, y, &from, &to))
    return false;
  cdem_near best = {.square = INFINITY}, near;
  int32_t nearest = -1;
  for (int64_t k = from; k < to; k++) {
    const double *corner[3];
    corners(surface, place, surface->item[k], corner);
    cdem_near_triangle(corner[0], corner[1], corner[2], y, &near);
    if (near.square < best.square) {
      best = near;
      nearest = surface->item[k];
    }
  }
  if (nearest < 0)
    return false;
  double side = cdem_near_side(surface, place, nearest, &best, y);
  if (!(side < 0.0))
    return false;
  touch->depth = -side;
  fill(surface, place, nearest, &best, y, touch);
  return true;
}
