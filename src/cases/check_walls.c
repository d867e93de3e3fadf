/* Checks of walls and of the cell around grains. */
#include "cases/check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PLANE, PLATE, CYLINDER, MESH }; /* the choices of `shape` */

static bool gives(const cdem_case *cases, const cdem_case_wall *wall, const char *rest) {
  char key[CDEM_CASE_PATH];
  return cdem_case_given(cases, cdem_case_named_key(key, "walls", wall->name, rest));
}

static double size_of(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* ---- which keys a shape wants and knows ---- */

static const struct {
  const char *key;
  char use[4]; /* plane, plate, cylinder, mesh: ! wants, + knows, - does not know */
} uses[] = {{"center", {'+', '!', '!', '+'}}, {"normal", {'!', '!', '-', '-'}},
            {"axis", {'-', '+', '+', '-'}},   {"half_size", {'-', '!', '+', '-'}},
            {"radius", {'-', '-', '!', '-'}}, {"outside", {'-', '-', '+', '-'}},
            {"file", {'-', '-', '-', '!'}},   {"group", {'-', '-', '-', '+'}},
            {"unit", {'-', '-', '-', '+'}}};
static const char *const shape_names[] = {"plane", "plate", "cylinder", "mesh"};

static cdem_status check_shape(const cdem_case *cases, const cdem_case_wall *wall,
                               cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  for (size_t i = 0; i < sizeof uses / sizeof *uses; i++) {
    char use = uses[i].use[wall->shape];
    bool given = gives(cases, wall, uses[i].key);
    if (use == '!' && !given)
      return cdem_case_fail(cases, cdem_case_named_key(key, "walls", wall->name, ""), CDEM_INPUT,
                            fault, "wall '%s' is a %s and needs '%s'", wall->name,
                            shape_names[wall->shape], uses[i].key);
    if (use == '-' && given)
      return cdem_case_fail(cases, cdem_case_named_key(key, "walls", wall->name, uses[i].key),
                            CDEM_INPUT, fault, "'%s' has no meaning for a wall of shape %s",
                            uses[i].key, shape_names[wall->shape]);
  }
  return CDEM_OK;
}

static cdem_status wall_fail(const cdem_case *cases, const cdem_case_wall *wall, const char *rest,
                             cdem_fault *fault, const char *message) {
  char key[CDEM_CASE_PATH];
  return cdem_case_fail(cases, cdem_case_named_key(key, "walls", wall->name, rest), CDEM_INPUT,
                        fault, "%s", message);
}

static cdem_status check_directions(const cdem_case *cases, const cdem_case_wall *wall,
                                    cdem_fault *fault) {
  bool plate = wall->shape == PLATE;
  if ((wall->shape == PLANE || plate) && !(size_of(wall->normal) > 0.0))
    return wall_fail(cases, wall, "normal", fault, "the normal of a wall must not be zero");
  if (gives(cases, wall, "axis") && !(size_of(wall->axis) > 0.0))
    return wall_fail(cases, wall, "axis", fault, "the axis of a wall must not be zero");
  double cross[3], size = size_of(wall->normal) * size_of(wall->axis);
  cdem_cross3(wall->normal, wall->axis, cross);
  /* a sine of 1e-6 keeps ten digits of the direction in the face */
  if (plate && gives(cases, wall, "axis") && !(size_of(cross) > 1e-6 * size))
    return wall_fail(cases, wall, "axis", fault,
                     "the axis of a plate must not be along its normal");
  if (plate && !(wall->half_size[0] > 0.0))
    return wall_fail(cases, wall, "half_size", fault,
                     "a plate needs half lengths above 0; an endless wall is a plane");
  if (plate && cases->values.grains.dimension == 3 && !(wall->half_size[1] > 0.0))
    return wall_fail(cases, wall, "half_size", fault,
                     "a plate in 3-D needs two half lengths above 0; an endless wall is a plane");
  return CDEM_OK;
}

/* What points out of the plane of discs. */
static cdem_status check_flat(const cdem_case *cases, const cdem_case_wall *wall,
                              cdem_fault *fault) {
  const double *const vector[] = {wall->center, wall->normal, wall->servo};
  static const char *const name[] = {"center", "normal", "servo"};
  char rest[32];
  if (cases->values.grains.dimension != 2)
    return CDEM_OK;
  for (int i = 0; i < 3; i++)
    if (vector[i][2] != 0.0) {
      snprintf(rest, sizeof rest, "%s[2]", name[i]);
      return wall_fail(cases, wall, rest, fault,
                       "discs lie in the plane z = 0; leave the third number out");
    }
  if (wall->velocity.given[2])
    return wall_fail(cases, wall, "velocity.z", fault,
                     "discs lie in the plane z = 0; leave `z` out");
  if (wall->spin.given[0] || wall->spin.given[1])
    return wall_fail(cases, wall, wall->spin.given[0] ? "spin.x" : "spin.y", fault,
                     "walls of discs turn about z only");
  return CDEM_OK;
}

static cdem_status check_servo(const cdem_case *cases, const cdem_case_wall *wall,
                               cdem_fault *fault) {
  static const char *const beside[] = {"servo_force", "servo_speed", "servo_gain"};
  bool servo = gives(cases, wall, "servo");
  for (int i = 0; !servo && i < 3; i++)
    if (gives(cases, wall, beside[i]))
      return wall_fail(cases, wall, beside[i], fault,
                       "this key has a meaning beside 'servo' only, the direction of the force");
  if (!servo)
    return CDEM_OK;
  if (!(size_of(wall->servo) > 0.0))
    return wall_fail(cases, wall, "servo", fault, "the direction of a servo must not be zero");
  if (!wall->has_servo_force)
    return wall_fail(cases, wall, "servo", fault, "a servo needs 'servo_force' beside it");
  if (isnan(wall->servo_speed))
    return wall_fail(cases, wall, "servo", fault,
                     "a servo needs 'servo_speed' beside it, its largest speed");
  return CDEM_OK;
}

cdem_status cdem_case_check_walls(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  char key[CDEM_CASE_PATH];
  for (int64_t i = 0; i < v->walls.count; i++) {
    const cdem_case_wall *wall = &v->walls.item[i];
    cdem_case_named_key(key, "walls", wall->name, "material");
    CDEM_TRY(cdem_case_check_grain_material(cases, key, wall->material, fault));
    CDEM_TRY(check_shape(cases, wall, fault));
    CDEM_TRY(check_directions(cases, wall, fault));
    CDEM_TRY(check_flat(cases, wall, fault));
    CDEM_TRY(check_servo(cases, wall, fault));
    if (!isnan(wall->stop) && !(wall->stop > wall->start))
      return cdem_case_fail(cases, cdem_case_named_key(key, "walls", wall->name, "stop"),
                            CDEM_INPUT, fault, "'stop' is %g s and must be after 'start', %g s",
                            wall->stop, wall->start);
  }
  return CDEM_OK;
}

/* ---- cell ---- */

cdem_status cdem_case_check_directions(const cdem_case *cases, const char *key,
                                       const cdem_case_texts *directions, cdem_fault *fault) {
  for (int64_t i = 0; i < directions->count; i++) {
    const char *text = directions->item[i];
    bool known = text[0] >= 'x' && text[0] <= 'z' && text[1] == '\0';
    if (!known || (text[0] == 'z' && cases->values.grains.dimension == 2))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault, "'%s' is no direction; there are %s",
                            text, cases->values.grains.dimension == 2 ? "x and y" : "x, y and z");
  }
  return CDEM_OK;
}

bool cdem_case_names_direction(const cdem_case_texts *directions, int direction) {
  for (int64_t i = 0; i < directions->count; i++)
    if (directions->item[i][0] == 'x' + direction)
      return true;
  return false;
}

/* A size that is given, or a packing whose box it is. */
static cdem_status check_size(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_cell *cell = &cases->values.cell;
  char key[CDEM_CASE_PATH];
  if (!cdem_case_given(cases, "cell.size")) {
    if (cases->values.grains.file != NULL)
      return cdem_case_fail(cases, "cell", CDEM_INPUT, fault,
                            "the cell of grains from a file needs 'size'");
    if (cdem_case_given(cases, "cell.low"))
      return cdem_case_fail(cases, "cell.low", CDEM_INPUT, fault,
                            "'low' has a meaning beside 'size' only; the box of the packing has "
                            "its own");
    return CDEM_OK;
  }
  if (cdem_case_given(cases, "grains.packing.compact"))
    return cdem_case_fail(cases, "cell.size", CDEM_INPUT, fault,
                          "the size of the cell is found by 'compact'; leave it out");
  for (int k = 0; k < cases->values.grains.dimension; k++)
    if (!(cell->size[k] > 0.0)) {
      snprintf(key, sizeof key, "cell.size[%d]", k);
      return cdem_case_fail(cases, key, CDEM_INPUT, fault, "the cell needs a size along %c",
                            "xyz"[k]);
    }
  return CDEM_OK;
}

cdem_status cdem_case_check_cell(const cdem_case *cases, cdem_fault *fault) {
  static const int diagonal[3] = {0, 4, 8};
  const cdem_case_cell *cell = &cases->values.cell;
  bool stress = false;
  char key[CDEM_CASE_PATH];
  if (!cdem_case_given(cases, "cell"))
    return CDEM_OK;
  CDEM_TRY(cdem_case_check_directions(cases, "cell.periodic", &cell->periodic, fault));
  CDEM_TRY(check_size(cases, fault));
  for (int k = 0; k < 9; k++)
    if (cases->values.grains.dimension == 2 && (k % 3 == 2 || k / 3 == 2) &&
        (cell->rate.given[k] || cell->stress.given[k])) {
      snprintf(key, sizeof key, "cell.%s.%c%c", cell->rate.given[k] ? "rate" : "stress",
               "xyz"[k / 3], "xyz"[k % 3]);
      return cdem_case_fail(
          cases, key, CDEM_INPUT, fault,
          "discs lie in the plane z = 0: components with z have no meaning there");
    }
  for (int k = 0; k < 3; k++) {
    stress = stress || cell->stress.given[diagonal[k]];
    if (cell->stress.given[diagonal[k]] && cell->rate.given[diagonal[k]]) {
      snprintf(key, sizeof key, "cell.rate.%c%c", "xyz"[k], "xyz"[k]);
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "a component of the cell follows a rate or a stress, not both");
    }
  }
  if (stress && isnan(cell->servo_rate))
    return cdem_case_fail(cases, "cell.stress", CDEM_INPUT, fault,
                          "a stress needs 'servo_rate' beside it, the largest rate");
  if (!stress && !isnan(cell->servo_rate))
    return cdem_case_fail(cases, "cell.servo_rate", CDEM_INPUT, fault,
                          "'servo_rate' has a meaning beside 'stress' only");
  return CDEM_OK;
}
