/* One grain on a plane, two grains that meet: closed forms of rolling, sliding and rebound. */
#include "verify/dem.h"
#include "verify/dem_world.h"

#include <math.h>

static const double pi = 3.14159265358979323846, gravity = 9.81;

/* ---- on a slope ----
 *
 * Axes along and across the slope: gravity is turned instead. Overlap at rest is 1e-5 radii, which
 * is by how much the arm to the contact point is shorter than the radius. */

typedef struct {
  int dim;
  double slope, friction, speed; /* rad, -, m/s rolling down */
  double resistance;             /* rolling friction; 0: none */
  double time;
} descent;

static const double radius = 0.1, softness = 1e-5, give = 1e-4; /* rad: elastic rolling */

static double weight(int dim) {
  return 2600.0 * pi * radius * radius * (dim == 2 ? 1.0 : 4.0 / 3.0 * radius) * gravity;
}

static cdem_status start_descent(cdem_dem_world *world, const descent *s, cdem_fault *fault) {
  int up = s->dim - 1;
  double place[3] = {0}, velocity[3] = {s->speed}, spin[3] = {0}, normal[3] = {0};
  double kn = weight(s->dim) / (softness * radius);
  CDEM_TRY(cdem_dem_world_init(world, s->dim, "linear", 2600.0, fault));
  cdem_dem_world_set(world, CDEM_LAW_normal_stiffness, kn);
  cdem_dem_world_set(world, CDEM_LAW_friction, s->friction);
  cdem_dem_world_set(world, CDEM_LAW_damping_ratio, 0.3);
  if (s->resistance > 0.0) {
    world->options.rolling = cdem_rolling_find("spring");
    cdem_dem_world_set(world, CDEM_LAW_rolling_friction, s->resistance);
    cdem_dem_world_set(world, CDEM_LAW_rolling_stiffness,
                       s->resistance * radius * weight(s->dim) / give);
  }
  normal[up] = 1.0;
  place[up] = radius * (1.0 - softness * cos(s->slope));
  spin[s->dim == 2 ? 2 : 1] = (s->dim == 2 ? -1.0 : 1.0) * s->speed / radius;
  CDEM_TRY(cdem_dem_world_add(world, place, radius, velocity, spin, fault));
  CDEM_TRY(cdem_dem_world_plane(world, (double[3]){0}, normal, fault));
  world->options.gravity[0] = gravity * sin(s->slope);
  world->options.gravity[up] = -gravity * cos(s->slope);
  world->options.step = 0.1 * sqrt(softness * radius / gravity);
  return cdem_dem_world_start(world, fault);
}

/* Speed, spin down the slope and angle, at half the time and at its end. */
static cdem_status descend(const descent *s, double half[3], double end[3], double *span,
                           cdem_fault *fault) {
  cdem_dem_world world;
  cdem_status status = start_descent(&world, s, fault);
  double sign = s->dim == 2 ? -1.0 : 1.0, *out[2] = {half, end};
  for (int part = 0; part < 2 && status == CDEM_OK; part++) {
    int64_t steps = (int64_t)(0.5 * s->time / world.dem.step);
    status = cdem_dem_steps(&world.dem, steps, fault);
    if (status != CDEM_OK)
      break;
    cdem_dem_grain now = cdem_dem_world_grain(&world, 0);
    out[part][0] = now.velocity[0];
    out[part][1] = sign * now.spin[s->dim == 2 ? 2 : 1];
    out[part][2] = sign * now.rotation[s->dim == 2 ? 2 : 1];
    *span = (double)steps * world.dem.step;
  }
  cdem_dem_world_release(&world);
  return status;
}

cdem_status cdem_dem_measure_slope(int parameter, double *value, cdem_fault *fault) {
  const double bound = 3.5; /* 1 + m r^2/I of a sphere */
  descent s = {.dim = parameter == 1 ? 2 : 3, .slope = 0.3, .friction = 0.5, .time = 0.6};
  if (parameter >= 2) {
    s.friction = 0.1;
    s.slope = parameter == 2 ? 0.6 : atan(bound * s.friction * (parameter == 3 ? 0.99 : 1.01));
  }
  double half[3], end[3], span;
  CDEM_TRY(descend(&s, half, end, &span, fault));
  double rate = (end[0] - half[0]) / span, slip[2];
  for (int i = 0; i < 2; i++)
    slip[i] = i == 0 ? half[0] - radius * half[1] : end[0] - radius * end[1];
  double drive = gravity * sin(s.slope), friction = s.friction * gravity * cos(s.slope);
  if (parameter < 2)
    *value = rate / (drive / (parameter == 0 ? 1.4 : 1.5));
  else if (parameter == 2)
    *value = rate / (drive - friction);
  else if (parameter == 3)
    *value = slip[1] / end[0];
  else
    *value = (slip[1] - slip[0]) / span / (drive - bound * friction);
  return CDEM_OK;
}

/* A disc that rolls with M = mu_r r N against it: (m r^2 + I) w^2/2 = M angle. */
cdem_status cdem_dem_measure_resisted(int parameter, double *value, cdem_fault *fault) {
  descent s = {.dim = 2, .friction = 0.8, .resistance = 0.1, .speed = 0.5, .time = 1.2};
  if (parameter > 0) {
    s.speed = 0.0;
    s.slope = atan(s.resistance * (parameter == 1 ? 0.99 : 1.5));
    s.time = parameter == 1 ? 1.6 : 0.8;
  }
  double half[3], end[3], span;
  CDEM_TRY(descend(&s, half, end, &span, fault));
  if (parameter == 0)
    *value = end[2] / (1.5 * s.speed * s.speed / (2.0 * s.resistance * radius * gravity));
  else if (parameter == 1)
    *value = fabs(end[2] - half[2]) / give;
  else
    *value =
        (end[0] - half[0]) / span / (gravity * (sin(s.slope) - s.resistance * cos(s.slope)) / 1.5);
  return CDEM_OK;
}

/* ---- two bodies, spring and dashpot ---- */

cdem_status cdem_dem_measure_two_bodies(int parameter, double *value, cdem_fault *fault) {
  const double zeta = 0.2, kn = 1e6, r = 0.01, speed = 0.5;
  double mass = 2600.0 * 4.0 / 3.0 * pi * r * r * r, w = sqrt(2.0 * kn / mass);
  double damped = w * sqrt(1.0 - zeta * zeta), deepest = 2.0 * speed / w, worst = 0.0;
  cdem_dem_world world;
  cdem_status status = cdem_dem_world_init(&world, 3, "linear", 2600.0, fault);
  cdem_dem_world_set(&world, CDEM_LAW_normal_stiffness, kn);
  cdem_dem_world_set(&world, CDEM_LAW_damping_ratio, zeta);
  for (int i = 0; i < 2 && status == CDEM_OK; i++)
    status = cdem_dem_world_add(&world, (double[]){i * 2.0 * r, 0.0, 0.0}, r,
                                (double[]){i == 0 ? speed : -speed, 0.0, 0.0}, NULL, fault);
  world.options.step = pi / damped / 4000.0;
  if (status == CDEM_OK)
    status = cdem_dem_world_start(&world, fault);
  for (int i = 0; i < 4500 && status == CDEM_OK; i++) {
    status = cdem_dem_step(&world.dem, fault);
    cdem_dem_grain a = cdem_dem_world_grain(&world, 0), b = cdem_dem_world_grain(&world, 1);
    double t = world.dem.time, overlap = 2.0 * r - (b.place[0] - a.place[0]);
    double closed = 2.0 * speed / damped * exp(-zeta * w * t) * sin(damped * t);
    if (i < 3000) /* the force ends at w_d t = 2 acos(zeta), step 3488 */
      worst = fmax(worst, fabs(overlap - closed) / deepest);
    if (parameter == 1)
      worst = -a.velocity[0] / speed;
  }
  *value = worst;
  cdem_dem_world_release(&world);
  return status;
}
