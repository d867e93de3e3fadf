/* A plane without end. Grains are on the side the normal points to, however deep they are in it. */
#include "dem/walls_store.h"

static cdem_status check(int dim, const cdem_wall *wall, cdem_fault *fault) {
  double n[3] = {wall->normal[0], wall->normal[1], wall->normal[2]};
  (void)dim;
  CDEM_REQUIRE(cdem_wall_unit(n), fault, CDEM_INPUT,
               "wall '%s': the normal (%g, %g, %g) of a plane has no length; give the direction in "
               "which the grains are",
               cdem_wall_name(wall), wall->normal[0], wall->normal[1], wall->normal[2]);
  return CDEM_OK;
}

static inline double height(const cdem_wall_body *body, const double x[3]) {
  return (x[0] - body->center[0]) * body->normal[0] + (x[1] - body->center[1]) * body->normal[1] +
         (x[2] - body->center[2]) * body->normal[2];
}

static bool nearest(const cdem_wall_body *body, const double x[3], double within,
                    cdem_wall_near *near) {
  near->distance = height(body, x);
  if (near->distance >= within)
    return false;
  for (int c = 0; c < 3; c++)
    near->n[c] = -body->normal[c];
  return true;
}

/* (x - c').n' - (x - c).n = (x - c).(n' - n) - (c' - c).n': how far the plane came nearer to x. A
 * belt that runs along itself has not moved. */
static double moved(const cdem_wall_body *body) {
  double way[3], before[3], tilt[3];
  cdem_wall_turned(body->built_turn, body->wall.normal, before);
  for (int c = 0; c < 3; c++) {
    way[c] = body->center[c] - body->built_center[c];
    tilt[c] = body->normal[c] - before[c];
  }
  return fabs(cdem_dot3(way, body->normal)) + body->reach * cdem_norm3(tilt);
}

static double beyond(const cdem_wall_body *body, const double x[3]) {
  double h = height(body, x);
  return h < 0.0 ? -h : 0.0;
}

const cdem_wall_kind cdem_wall_plane_kind = {
    .name = "plane", .check = check, .nearest = nearest, .moved = moved, .beyond = beyond};
