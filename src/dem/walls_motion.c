/* How walls move: rigid bodies by functions of time, and servos.
 *
 * The path of the center is the exact integral of its velocity. A spin about one direction turns by
 * the exact integral of its speed; any other spin by one exponential a step, of the integral of the
 * spin over the step (the first term of Magnus' series, second order), as a unit quaternion.
 * Velocities are those of the middle of the step that led to the pose, as the grains' are.
 *
 * Servo. F is the grains' force on the wall along `servo`, K the stiffness of the contacts. Moved
 * by ds along `servo`, the wall presses grains in front of it, whose push is against `servo`, by
 * K ds more, or those behind it, whose push is along `servo`, by K ds less: dF/ds = -K either way.
 * To reach the wanted force it must go (F - wanted)/K; it goes the part `gain` of that in a step.
 * Without contacts F = 0, and it goes the same way, against the sign of the wanted force, at full
 * speed. */
#include "base/quaternion.h"
#include "dem/walls_store.h"

static bool moves(const cdem_series *f) {
  return f->kind != CDEM_SERIES_TABLE || f->points > 0;
}

static bool constant(const cdem_series *f) {
  return f->kind == CDEM_SERIES_TABLE && f->points <= 1;
}

/* Components a wall can have in this dimension. */
static int first_spin(const cdem_wall_body *body) {
  return body->dim == 2 ? 2 : 0;
}

static void set_turning(cdem_wall_body *body) {
  int active = 0, one = 2;
  bool steady = true;
  double w[3] = {0.0, 0.0, 0.0};
  for (int c = first_spin(body); c < 3; c++) {
    if (!moves(&body->wall.spin[c]))
      continue;
    active++;
    one = c;
    steady = steady && constant(&body->wall.spin[c]);
    w[c] = cdem_series_at(&body->wall.spin[c], 0.0);
  }
  for (int c = 0; c < 3; c++)
    body->about[c] = c == one ? 1.0 : 0.0;
  body->turning = active == 0 ? CDEM_WALL_STILL : CDEM_WALL_TUMBLES;
  if (active == 1)
    body->turning = CDEM_WALL_ABOUT;
  if (active > 1 && steady) {
    body->turning = cdem_wall_unit(w) ? CDEM_WALL_ABOUT : CDEM_WALL_STILL;
    for (int c = 0; c < 3; c++)
      body->about[c] = w[c];
  }
}

/* Velocity functions at a time, without what the servo replaces. */
static void velocity_at(const cdem_wall_body *body, double time, double v[3]) {
  for (int c = 0; c < 3; c++)
    v[c] = c < body->dim ? cdem_series_at(&body->wall.velocity[c], time) : 0.0;
  if (!body->servo)
    return;
  double along = cdem_dot3(v, body->wall.servo);
  for (int c = 0; c < 3; c++)
    v[c] -= along * body->wall.servo[c];
}

static void spin_at(const cdem_wall_body *body, double time, double w[3]) {
  for (int c = 0; c < 3; c++)
    w[c] = c >= first_spin(body) ? cdem_series_at(&body->wall.spin[c], time) : 0.0;
}

void cdem_wall_motion_init(cdem_wall_body *body) {
  static const double identity[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  body->servo = cdem_wall_unit(body->wall.servo);
  if (body->wall.servo_gain == 0.0)
    body->wall.servo_gain = 0.25;
  body->quaternion[0] = body->quaternion_since[0] = 1.0;
  for (int k = 0; k < 9; k++)
    body->turn[k] = identity[k];
  for (int c = 0; c < 3; c++)
    body->center[c] = body->wall.center[c];
  set_turning(body);
  velocity_at(body, 0.0, body->velocity);
  spin_at(body, 0.0, body->spin);
  cdem_wall_place(body, 0.0);
  cdem_wall_keep_built(body);
}

/* ---- rotation ---- */

/* out = exp(angle * direction) q, direction a unit vector. */
static void turn_by(const double direction[3], double angle, const double q[4], double out[4]) {
  double s = sin(0.5 * angle);
  const double by[4] = {cos(0.5 * angle), s * direction[0], s * direction[1], s * direction[2]};
  cdem_quaternion_product(by, q, out);
}

static void turn(cdem_wall_body *body, double time, double next) {
  const cdem_series *spin = body->wall.spin;
  double angle[3] = {0.0, 0.0, 0.0};
  if (body->turning == CDEM_WALL_STILL)
    return;
  double from = body->turning == CDEM_WALL_ABOUT ? body->since : time;
  for (int c = first_spin(body); c < 3; c++)
    angle[c] = cdem_series_integral(&spin[c], next) - cdem_series_integral(&spin[c], from);
  if (body->turning == CDEM_WALL_ABOUT) {
    turn_by(body->about, cdem_dot3(angle, body->about), body->quaternion_since, body->quaternion);
  } else {
    double old[4], size = cdem_norm3(angle);
    for (int k = 0; k < 4; k++)
      old[k] = body->quaternion[k];
    if (cdem_wall_unit(angle))
      turn_by(angle, size, old, body->quaternion);
  }
  cdem_quaternion_normalise(body->quaternion);
}

/* ---- pose ---- */

void cdem_wall_place(cdem_wall_body *body, double time) {
  const cdem_wall *wall = &body->wall;
  cdem_quaternion_matrix(body->quaternion, body->turn);
  cdem_wall_turned(body->turn, wall->normal, body->normal);
  cdem_wall_turned(body->turn, wall->axis, body->axis);
  cdem_cross3(body->normal, body->axis, body->third);
  body->here = time >= wall->start && (wall->stop == 0.0 || time < wall->stop);
}

void cdem_wall_keep_built(cdem_wall_body *body) {
  for (int c = 0; c < 3; c++)
    body->built_center[c] = body->center[c];
  for (int k = 0; k < 9; k++)
    body->built_turn[k] = body->turn[k];
  body->built_radius = body->wall.radius;
}

static void shift(cdem_wall_body *body, double next) {
  double way[3];
  for (int c = 0; c < 3; c++) {
    const cdem_series *v = &body->wall.velocity[c];
    way[c] = c < body->dim && moves(v)
                 ? cdem_series_integral(v, next) - cdem_series_integral(v, body->since)
                 : 0.0;
  }
  double along = body->servo ? cdem_dot3(way, body->wall.servo) : 0.0;
  for (int c = 0; c < 3; c++) {
    body->path[c] = body->path_since[c] + way[c] - along * body->wall.servo[c];
    body->center[c] = body->wall.center[c] + body->path[c] + body->servo_path * body->wall.servo[c];
  }
}

/* ---- servo ---- */

static double servo_speed(const cdem_wall_body *body, double time, double step, double force,
                          double stiffness) {
  double most = body->wall.servo_speed;
  double excess = force - cdem_series_at(&body->wall.servo_force, time);
  if (!(stiffness > 0.0))
    return excess > 0.0 ? most : (excess < 0.0 ? -most : 0.0);
  double speed = body->wall.servo_gain * excess / (stiffness * step);
  return speed > most ? most : (speed < -most ? -most : speed);
}

/* A tube that grains push outwards by dF more per radius lost: as above. */
static void swell(cdem_wall_body *body, double time, double step, double push, double stiffness) {
  body->radius_speed = body->here ? servo_speed(body, time, step, push, stiffness) : 0.0;
  body->wall.radius += body->radius_speed * step;
}

void cdem_wall_body_advance(cdem_wall_body *body, double time, double step, const double *force,
                            double stiffness) {
  double next = time + step, middle = time + 0.5 * step;
  if (body->servo) {
    double along = force != NULL ? cdem_dot3(force, body->wall.servo) : 0.0;
    body->servo_speed = body->here ? servo_speed(body, next, step, along, stiffness) : 0.0;
    body->servo_path += body->servo_speed * step;
  }
  shift(body, next);
  turn(body, time, next);
  velocity_at(body, middle, body->velocity);
  spin_at(body, middle, body->spin);
  if (body->servo)
    for (int c = 0; c < 3; c++)
      body->velocity[c] += body->servo_speed * body->wall.servo[c];
  cdem_wall_place(body, next);
}

void cdem_walls_advance(cdem_dem_store *s, double time, double step, const cdem_wall_loads *loads,
                        double *moved) {
  cdem_walls *walls = s->walls;
  *moved = 0.0;
  if (walls == NULL)
    return;
  for (int w = 0; w < walls->walls; w++) {
    cdem_wall_body *body = walls->body + w;
    static const cdem_wall_loads none = {0};
    const cdem_wall_loads *by = loads != NULL ? loads : &none;
    double stiffness = by->stiffness != NULL ? by->stiffness[w] : 0.0;
    cdem_wall_body_advance(body, time, step, by->force != NULL ? by->force + 6 * w : NULL,
                           stiffness);
    if (body->wall.servo_radius)
      swell(body, time + step, step, by->push != NULL ? by->push[w] : 0.0, stiffness);
    *moved = fmax(*moved, body->kind->moved(body));
  }
  walls->time = time + step;
}

void cdem_wall_body_move(cdem_wall_body *body, double time, const cdem_series velocity[3],
                         const cdem_series spin[3]) {
  body->since = time;
  for (int k = 0; k < 4; k++)
    body->quaternion_since[k] = body->quaternion[k];
  for (int c = 0; c < 3; c++) {
    body->path_since[c] = body->path[c];
    if (velocity != NULL)
      body->wall.velocity[c] = velocity[c];
    if (spin != NULL)
      body->wall.spin[c] = spin[c];
  }
  set_turning(body);
}

void cdem_walls_move(cdem_dem_store *s, int wall, const cdem_series velocity[3],
                     const cdem_series spin[3]) {
  cdem_wall_body *body = s->walls->body + wall;
  cdem_wall_body_move(body, s->walls->time, velocity, spin);
  /* A wall that begins to turn does so with lists that were made for one at rest. */
  cdem_wall_set_reach(s, body);
}
