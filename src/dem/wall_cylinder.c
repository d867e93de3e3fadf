/* A tube about an axis; in 2-D a circle.
 *
 * Without ends it has one side: grains are inside (or outside) however deep they are in it. With
 * ends it is a thin open tube, touched from both sides and, beyond its ends, at the nearest point
 * of its rim. */
#include "dem/walls_store.h"

static cdem_status check(int dim, const cdem_wall *wall, cdem_fault *fault) {
  const char *name = cdem_wall_name(wall);
  double a[3] = {wall->axis[0], wall->axis[1], wall->axis[2]};
  CDEM_REQUIRE(isfinite(wall->radius) && wall->radius > 0.0, fault, CDEM_INPUT,
               "wall '%s': the radius of a cylinder is %g m; it must be positive", name,
               wall->radius);
  CDEM_REQUIRE(!wall->servo_radius || (!wall->outside && wall->half[0] == 0.0), fault, CDEM_INPUT,
               "wall '%s': a servo of the radius wants grains inside a cylinder without ends",
               name);
  if (dim == 2)
    return CDEM_OK;
  CDEM_REQUIRE(cdem_wall_unit(a), fault, CDEM_INPUT,
               "wall '%s': the axis (%g, %g, %g) of a cylinder has no length", name, wall->axis[0],
               wall->axis[1], wall->axis[2]);
  CDEM_REQUIRE(isfinite(wall->half[0]) && wall->half[0] >= 0.0, fault, CDEM_INPUT,
               "wall '%s': the half length of a cylinder is %g m; it must be positive, or 0 for a "
               "cylinder without ends",
               name, wall->half[0]);
  return CDEM_OK;
}

/* x about the center: along the axis, away from it, and the unit vector away from it. On the axis
 * itself any direction is as good; the third one is taken. */
static inline double away(const cdem_wall_body *body, const double x[3], double *along,
                          double out[3]) {
  double p[3] = {x[0] - body->center[0], x[1] - body->center[1], x[2] - body->center[2]};
  *along = cdem_dot3(p, body->axis);
  for (int c = 0; c < 3; c++)
    out[c] = p[c] - *along * body->axis[c];
  double rho = cdem_norm3(out);
  for (int c = 0; c < 3; c++)
    out[c] = rho > 0.0 ? out[c] / rho : body->third[c];
  return rho;
}

static bool endless(const cdem_wall_body *body) {
  return body->dim == 2 || body->wall.half[0] == 0.0;
}

static bool nearest(const cdem_wall_body *body, const double x[3], double within,
                    cdem_wall_near *near) {
  double along, out[3], rho = away(body, x, &along, out), gap = body->wall.radius - rho;
  double past = fabs(along) - body->wall.half[0];
  if (endless(body) || past <= 0.0) {
    bool outside = body->wall.outside;
    if (!endless(body) && gap != 0.0)
      outside = gap < 0.0;
    near->distance = outside ? -gap : gap;
    for (int c = 0; c < 3; c++)
      near->n[c] = outside ? -out[c] : out[c];
    return near->distance < within;
  }
  double square = gap * gap + past * past;
  if (square >= within * within)
    return false;
  near->distance = sqrt(square);
  for (int c = 0; c < 3; c++)
    near->n[c] = (gap * out[c] - (along > 0.0 ? past : -past) * body->axis[c]) / near->distance;
  return true;
}

/* Turning about its own axis moves a tube nowhere; a tilt from a to a' takes a point at distance d
 * from the center by at most d |a' - a|. */
static double moved(const cdem_wall_body *body) {
  double before[3], way[3], tilt[3];
  cdem_wall_turned(body->built_turn, body->wall.axis, before);
  for (int c = 0; c < 3; c++) {
    way[c] = body->center[c] - body->built_center[c];
    tilt[c] = body->axis[c] - before[c];
  }
  double reach = body->reach + body->wall.radius;
  if (endless(body)) {
    double along = cdem_dot3(way, body->axis);
    for (int c = 0; c < 3; c++)
      way[c] -= along * body->axis[c];
  } else {
    reach = sqrt(body->wall.half[0] * body->wall.half[0] + body->wall.radius * body->wall.radius);
  }
  return cdem_norm3(way) + reach * cdem_norm3(tilt) + fabs(body->wall.radius - body->built_radius);
}

static double beyond(const cdem_wall_body *body, const double x[3]) {
  double along, out[3], rho = away(body, x, &along, out), gap = body->wall.radius - rho;
  if (!endless(body) && fabs(along) > body->wall.half[0])
    return 0.0;
  double wrong = body->wall.outside ? gap : -gap;
  return wrong > 0.0 ? wrong : 0.0;
}

const cdem_wall_kind cdem_wall_cylinder_kind = {
    .name = "cylinder", .check = check, .nearest = nearest, .moved = moved, .beyond = beyond};
