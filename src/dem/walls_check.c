/* What cannot be a wall, and grains that are beyond one. */
#include "dem/walls_store.h"

#include <inttypes.h>

const char *cdem_wall_name(const cdem_wall *wall) {
  return wall->name != NULL ? wall->name : "?";
}

bool cdem_wall_unit(double v[3]) {
  double most = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
  if (!(most > 0.0) || !isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]))
    return false;
  double length = cdem_norm3(v);
  if (length != 1.0)
    for (int c = 0; c < 3; c++)
      v[c] /= length;
  return isfinite(length) && length > 0.0;
}

static cdem_status check_flat(const cdem_wall *wall, cdem_fault *fault) {
  const char *name = cdem_wall_name(wall);
  bool flat = wall->shape == CDEM_WALL_PLANE || wall->shape == CDEM_WALL_PLATE;
  CDEM_REQUIRE(wall->center[2] == 0.0, fault, CDEM_INPUT,
               "wall '%s': its center is at z = %g m; in 2-D everything is in the plane z = 0",
               name, wall->center[2]);
  CDEM_REQUIRE(!flat || wall->normal[2] == 0.0, fault, CDEM_INPUT,
               "wall '%s': its normal leaves the plane z = 0 (z component %g), which a 2-D wall "
               "cannot",
               name, wall->normal[2]);
  CDEM_REQUIRE(wall->servo[2] == 0.0, fault, CDEM_INPUT,
               "wall '%s': its servo leaves the plane z = 0 (z component %g), which a 2-D wall "
               "cannot",
               name, wall->servo[2]);
  return CDEM_OK;
}

static cdem_status check_servo(const cdem_wall *wall, cdem_fault *fault) {
  const char *name = cdem_wall_name(wall);
  double direction[3] = {wall->servo[0], wall->servo[1], wall->servo[2]};
  bool along = direction[0] != 0.0 || direction[1] != 0.0 || direction[2] != 0.0;
  CDEM_REQUIRE(!wall->servo_radius || (wall->shape == CDEM_WALL_CYLINDER && !along), fault,
               CDEM_INPUT,
               "wall '%s': a servo of the radius is one of a cylinder, without direction", name);
  if (!along && !wall->servo_radius)
    return CDEM_OK;
  CDEM_REQUIRE(wall->servo_radius || cdem_wall_unit(direction), fault, CDEM_INPUT,
               "wall '%s': the direction (%g, %g, %g) of its servo is none", name, wall->servo[0],
               wall->servo[1], wall->servo[2]);
  CDEM_REQUIRE(isfinite(wall->servo_speed) && wall->servo_speed > 0.0, fault, CDEM_INPUT,
               "wall '%s': the speed of its servo is %g m/s; it must be positive, as the wall "
               "looks for its contacts at this speed",
               name, wall->servo_speed);
  CDEM_REQUIRE(wall->servo_gain >= 0.0 && wall->servo_gain < 1.0, fault, CDEM_INPUT,
               "wall '%s': the gain of its servo is %g; it must be above 0 and below 1", name,
               wall->servo_gain);
  return CDEM_OK;
}

cdem_status cdem_wall_check(int dim, const cdem_wall *wall, cdem_fault *fault) {
  const char *name = cdem_wall_name(wall);
  const cdem_wall_kind *kind = cdem_wall_kind_of(wall->shape);
  CDEM_REQUIRE(kind != NULL, fault, CDEM_INPUT, "wall '%s': %d is no shape of a wall", name,
               (int)wall->shape);
  for (int c = 0; c < 3; c++)
    CDEM_REQUIRE(isfinite(wall->center[c]), fault, CDEM_INPUT,
                 "wall '%s': its center (%g, %g, %g) is not finite", name, wall->center[0],
                 wall->center[1], wall->center[2]);
  CDEM_REQUIRE(wall->material >= 0, fault, CDEM_INPUT, "wall '%s': it has no material (index %d)",
               name, wall->material);
  CDEM_REQUIRE(isfinite(wall->start) && isfinite(wall->stop) &&
                   (wall->stop == 0.0 || wall->stop > wall->start),
               fault, CDEM_INPUT,
               "wall '%s': it stops at %g s, not after its start at %g s; 0 means for ever", name,
               wall->stop, wall->start);
  if (dim == 2)
    CDEM_TRY(check_flat(wall, fault));
  CDEM_TRY(check_servo(wall, fault));
  return kind->check(dim, wall, fault);
}

/* The grain that is furthest beyond any wall. */
cdem_status cdem_walls_check(const cdem_dem_store *s, cdem_fault *fault) {
  double worst = 0.0;
  int64_t beyond = 0, grain = -1;
  const cdem_wall_body *of = NULL;
  if (s->walls == NULL)
    return CDEM_OK;
  for (int w = 0; w < s->walls->walls; w++) {
    const cdem_wall_body *body = s->walls->body + w;
    if (body->kind->beyond == NULL || !body->here)
      continue;
    for (int64_t i = 0; i < s->grains; i++) {
      double far = body->kind->beyond(body, cdem_place(s, i));
      beyond += far > 0.0;
      /* The lower id where two are equally far, so that the message does not know the order. */
      if (far > worst || (far == worst && grain >= 0 && of == body && s->id[i] < s->id[grain])) {
        worst = far;
        grain = i;
        of = body;
      }
    }
  }
  if (of == NULL)
    return CDEM_OK;
  const double *x = cdem_place(s, grain);
  return cdem_fail(fault, CDEM_INPUT,
                   "grain %" PRId32 " at (%g, %g, %g) m has its centre %g m beyond wall '%s' (%s), "
                   "and %" PRId64 " of all grains are beyond a wall; move the grains to the side "
                   "that the wall holds, or turn the wall round",
                   s->id[grain], x[0], x[1], x[2], worst, cdem_wall_name(&of->wall), of->kind->name,
                   beyond);
}
