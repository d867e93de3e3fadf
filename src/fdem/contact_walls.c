/* Which nodes are beyond a wall.
 *
 * Planes and endless cylinders have one side, and a node is as deep in them as it is beyond. Plates
 * and tubes with ends are touched from both sides: a node is beyond when it is on the other side
 * than the centre of its grain and its foot is within their bounds. Rims do not act, so a plate
 * should be wider than what it presses. */
#include "fdem/contact_store.h"

static bool one_sided(const cdem_wall_body *body) {
  return body->wall.shape == CDEM_WALL_PLANE ||
         (body->wall.shape == CDEM_WALL_CYLINDER && body->wall.half[0] == 0.0);
}

static bool plate_passed(const cdem_wall_body *body, const double center[3], const double x[3],
                         double *depth, double normal[3]) {
  double p[3], q[3];
  for (int c = 0; c < 3; c++) {
    p[c] = x[c] - body->center[c];
    q[c] = center[c] - body->center[c];
  }
  double h = cdem_dot3(p, body->normal), side = cdem_dot3(q, body->normal);
  if (!(h * side < 0.0) || fabs(cdem_dot3(p, body->axis)) > body->wall.half[0] ||
      fabs(cdem_dot3(p, body->third)) > body->wall.half[1])
    return false;
  *depth = fabs(h);
  for (int c = 0; c < 3; c++)
    normal[c] = side > 0.0 ? body->normal[c] : -body->normal[c];
  return true;
}

static double from_axis(const cdem_wall_body *body, const double x[3], double out[3],
                        double *along) {
  double p[3];
  for (int c = 0; c < 3; c++)
    p[c] = x[c] - body->center[c];
  *along = cdem_dot3(p, body->axis);
  for (int c = 0; c < 3; c++)
    out[c] = p[c] - *along * body->axis[c];
  return cdem_norm3(out);
}

static bool tube_passed(const cdem_wall_body *body, const double center[3], const double x[3],
                        double *depth, double normal[3]) {
  double out[3], other[3], along, ignored;
  double rho = from_axis(body, x, out, &along), gap = body->wall.radius - rho;
  double room = body->wall.radius - from_axis(body, center, other, &ignored);
  if (!(gap * room < 0.0) || fabs(along) > body->wall.half[0] || rho == 0.0)
    return false;
  *depth = fabs(gap);
  for (int c = 0; c < 3; c++)
    normal[c] = (room > 0.0 ? -out[c] : out[c]) / rho;
  return true;
}

bool cdem_wall_passed(const cdem_wall_body *body, const double center[3], const double x[3],
                      double *depth, double normal[3]) {
  cdem_wall_near near;
  if (!one_sided(body))
    return body->wall.shape == CDEM_WALL_PLATE ? plate_passed(body, center, x, depth, normal)
                                               : tube_passed(body, center, x, depth, normal);
  if (!body->kind->nearest(body, x, 0.0, &near))
    return false;
  *depth = -near.distance;
  for (int c = 0; c < 3; c++)
    normal[c] = -near.n[c];
  return true;
}

bool cdem_wall_in_reach(const cdem_wall_body *body, const double center[3], double reach) {
  cdem_wall_near near;
  return body->here && body->kind->nearest(body, center, reach, &near);
}

/* The velocity of the middle of the step, where node and wall were then: so a node that turns with
 * its wall does not slip, but for the third power of the angle. */
void cdem_wall_way(const cdem_wall_body *body, const double x[3], const double before[3],
                   double step, double way[3]) {
  double arm[3], turning[3];
  for (int c = 0; c < 3; c++)
    arm[c] = 0.5 * (x[c] + before[c]) - (body->center[c] - 0.5 * step * body->velocity[c]);
  cdem_cross3(body->spin, arm, turning);
  for (int c = 0; c < 3; c++)
    way[c] = step * (body->velocity[c] + turning[c]);
}
