/* A rectangle, in 2-D a segment, without thickness, that acts from both sides, by its edges and by
 * its corners: all through the nearest point, which is the place in the plane of the plate cut back
 * to the half lengths. */
#include "dem/walls_store.h"

static cdem_status check(int dim, const cdem_wall *wall, cdem_fault *fault) {
  const char *name = cdem_wall_name(wall);
  double n[3], a[3];
  for (int c = 0; c < 3; c++) {
    n[c] = wall->normal[c];
    a[c] = wall->axis[c];
  }
  CDEM_REQUIRE(cdem_wall_unit(n), fault, CDEM_INPUT,
               "wall '%s': the normal (%g, %g, %g) of a plate has no length; give a direction "
               "across the plate",
               name, wall->normal[0], wall->normal[1], wall->normal[2]);
  for (int k = 0; k < dim - 1; k++)
    CDEM_REQUIRE(isfinite(wall->half[k]) && wall->half[k] > 0.0, fault, CDEM_INPUT,
                 "wall '%s': half length %d of a plate is %g m; it must be positive", name, k + 1,
                 wall->half[k]);
  if (dim == 2)
    return CDEM_OK;
  CDEM_REQUIRE(cdem_wall_unit(a), fault, CDEM_INPUT,
               "wall '%s': the axis (%g, %g, %g) of a plate has no length; give the direction of "
               "its first half length",
               name, wall->axis[0], wall->axis[1], wall->axis[2]);
  double cosine = cdem_dot3(n, a);
  CDEM_REQUIRE(fabs(cosine) < 1e-6, fault, CDEM_INPUT,
               "wall '%s': the axis of a plate leans on its normal (cosine %g); it must lie in the "
               "plate",
               name, cosine);
  return CDEM_OK;
}

static inline double cut(double a, double half) {
  return a > half ? a - half : (a < -half ? a + half : 0.0);
}

static bool nearest(const cdem_wall_body *body, const double x[3], double within,
                    cdem_wall_near *near) {
  double p[3] = {x[0] - body->center[0], x[1] - body->center[1], x[2] - body->center[2]};
  double h = cdem_dot3(p, body->normal);
  if (fabs(h) >= within)
    return false;
  double a = cut(cdem_dot3(p, body->axis), body->wall.half[0]);
  double b = body->dim == 2 ? 0.0 : cut(cdem_dot3(p, body->third), body->wall.half[1]);
  double square = a * a + b * b;
  if (square == 0.0) {
    double sign = h >= 0.0 ? -1.0 : 1.0;
    near->distance = fabs(h);
    for (int c = 0; c < 3; c++)
      near->n[c] = sign * body->normal[c];
    return true;
  }
  square += h * h;
  if (square >= within * within)
    return false;
  near->distance = sqrt(square);
  for (int c = 0; c < 3; c++)
    near->n[c] = -(a * body->axis[c] + b * body->third[c] + h * body->normal[c]) / near->distance;
  return true;
}

/* The way of a point is an affine function of the point, so the furthest way is that of a corner.
 */
static double moved(const cdem_wall_body *body) {
  double furthest = 0.0;
  for (int corner = 0; corner < 4; corner++) {
    double a = corner & 1 ? body->wall.half[0] : -body->wall.half[0];
    double b = body->dim == 2 ? 0.0 : (corner & 2 ? body->wall.half[1] : -body->wall.half[1]);
    double body_axis[3], third[3], point[3], before[3], way[3];
    for (int c = 0; c < 3; c++)
      body_axis[c] = body->wall.axis[c];
    cdem_cross3(body->wall.normal, body_axis, third);
    for (int c = 0; c < 3; c++) {
      point[c] = a * body_axis[c] + b * third[c];
      way[c] = body->center[c] - body->built_center[c] + a * body->axis[c] + b * body->third[c];
    }
    cdem_wall_turned(body->built_turn, point, before);
    for (int c = 0; c < 3; c++)
      way[c] -= before[c];
    furthest = fmax(furthest, cdem_norm3(way));
  }
  return furthest;
}

const cdem_wall_kind cdem_wall_plate_kind = {
    .name = "plate", .check = check, .nearest = nearest, .moved = moved};
