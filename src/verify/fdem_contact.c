/* Contact of grains against Hertz, where they give way, and against the law penalty, where they do
 * not. A surface of flat faces is not a ball: what that makes of the force is known beforehand, and
 * that is what these checks hold the solver to. */
#include "base/mat3.h"
#include "verify/fdem.h"
#include "verify/fdem_world.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double young = 40e9, poisson = 0.2; /* of the balls that give way */

/* ---- Hertz ---- */

enum { FINEST = 6 };
typedef struct {
  double error; /* of the force, in parts of Hertz's */
  double band;  /* what the facets may make of it */
  bool made;
} pressed;

/* Balls of the same mesh, pole to pole, the second turned about the axis by 22.5 degrees, between
 * two planes that come nearer until the contact is some a = 0.3 r wide; then they come to rest. The
 * penalty of 10 E/r makes nodes sink in by a thirtieth of the approach. */
static cdem_status press(cdem_fdem_world *world, double radius, cdem_fault *fault) {
  const double ramp = 1.5e-4;
  const double time[2] = {ramp, 1.0001 * ramp}, speed[2] = {-4.0 * 0.09 * radius / ramp, 0.0};
  cdem_fdem_world_add(world, 0.0, 0.0, radius, radius);
  double *turn =
      world->orientation + 4 * cdem_fdem_world_add(world, 0.0, 0.0, 3.0 * radius, radius);
  turn[0] = cos(pi / 16.0);
  turn[3] = sin(pi / 16.0);
  cdem_fdem_world_plane(world, 0.0, 0.0, 1.0);
  cdem_wall *top = cdem_fdem_world_plane(world, 4.0 * radius, 0.0, -1.0);
  CDEM_TRY(cdem_series_table(2, time, speed, &top->velocity[2], fault));
  world->law = (cdem_fdem_contact_law){
      .penalty = 10.0 * young / radius, .shear_ratio = 1.0, .friction = 0.5, .damping_ratio = 0.3};
  world->options.mass_damping = 5e4; /* 1/s, near critical for the two against each other */
  cdem_status status = cdem_fdem_world_start(world, fault);
  while (status == CDEM_OK && world->fdem.time < 2.5 * ramp)
    status = cdem_fdem_steps(&world->fdem, 20, fault);
  cdem_series_release(&top->velocity[2]);
  return status;
}

static double hertz(double radius, double approach) {
  double modulus = young / (2.0 * (1.0 - poisson * poisson));
  double deep = fmax(approach, 0.0);
  return 4.0 / 3.0 * modulus * sqrt(0.5 * radius * deep) * deep;
}

/* The approach is counted from where the furthest points would touch, R = reach r; the surfaces lie
 * between that and `least` r, so it is uncertain by 2 (reach - least) r. */
static cdem_status compare(cdem_fdem_world *world, double radius, pressed *result,
                           cdem_fault *fault) {
  cdem_fdem_touch *touch = NULL;
  int64_t touches = 0;
  double x[6], force = 0.0;
  const cdem_skin *skin = &world->shape.surface;
  CDEM_TRY(cdem_fdem_touches(&world->fdem, &touches, &touch, fault));
  for (int64_t i = 0; i < touches; i++)
    if (touch[i].partner >= 0)
      force += touch[i].grain == 0 ? -touch[i].force[2] : touch[i].force[2];
  free(touch);
  cdem_fdem_look(&world->fdem, &(cdem_fdem_view){.xyz = x});
  double ball = radius * skin->reach, lack = 2.0 * radius * (skin->reach - skin->least);
  double way[3] = {x[3] - x[0], x[4] - x[1], x[5] - x[2]};
  double approach = 2.0 * ball - cdem_norm3(way), exact = hertz(ball, approach);
  result->error = force / exact - 1.0;
  result->band = (result->error > 0.0 ? hertz(ball, approach + lack) - exact
                                      : exact - hertz(ball, approach - lack)) /
                 exact;
  result->made = true;
  return CDEM_OK;
}

/* Runs are kept while the process lives: two checks look at each. */
static cdem_status press_once(int refinement, pressed *result, cdem_fault *fault) {
  static pressed known[FINEST + 1];
  const double radius = 0.05;
  cdem_fdem_world world = {.density = 0.0};
  if (!known[refinement].made) {
    cdem_status status =
        cdem_fdem_world_init(&world, "cubesphere", refinement, young, poisson, NULL, fault);
    if (status == CDEM_OK)
      status = press(&world, radius, fault);
    if (status == CDEM_OK)
      status = compare(&world, radius, &known[refinement], fault);
    cdem_fdem_world_release(&world);
    CDEM_TRY(status);
  }
  *result = known[refinement];
  return CDEM_OK;
}

cdem_status cdem_fdem_measure_hertz(int parameter, double *value, cdem_fault *fault) {
  pressed fine, coarse;
  CDEM_TRY(press_once(abs(parameter), &fine, fault));
  *value = fabs(fine.error) / fine.band;
  if (parameter > 0)
    return CDEM_OK;
  CDEM_TRY(press_once(abs(parameter) - 2, &coarse, fault));
  *value = fabs(fine.error / coarse.error);
  return CDEM_OK;
}

/* ---- balls that keep their shape ---- */

static const double overlap_of[] = {0.03, 0.05, 0.08}; /* of the radius */

/* Mean force of so many pairs of balls that overlap, turned at random, by 2 p pi R* d^2. */
static cdem_status mean_force(cdem_fdem_world *world, double radius, double overlap, double *force,
                              cdem_fault *fault) {
  enum { PAIRS = CDEM_FDEM_WORLD_GRAINS / 2, TIMES = 10 };
  double pull[3 * CDEM_FDEM_WORLD_GRAINS];
  cdem_random random = {17};
  *force = 0.0;
  for (int t = 0; t < TIMES; t++) {
    world->options.grains.grains = 0;
    for (int i = 0; i < CDEM_FDEM_WORLD_GRAINS; i++) {
      const int pair = i / 2;
      cdem_fdem_world_turn(world,
                           cdem_fdem_world_add(world, i % 2 * (2.0 * radius - overlap),
                                               5.0 * radius * pair, 0.0, radius),
                           &random);
    }
    CDEM_TRY(cdem_fdem_world_start(world, fault));
    cdem_fdem_look(&world->fdem, &(cdem_fdem_view){.force = pull});
    for (int i = 0; i < PAIRS; i++)
      *force += pull[6 * i + 3] / (PAIRS * TIMES);
  }
  *force /= 2.0 * world->law.penalty * pi * 0.5 * radius * overlap * overlap;
  return CDEM_OK;
}

/* Nodes stand at `reach`; the faces they meet are those of a body of the volume of the skin, so at
 * the mean level (V/V_ball)^(1/3): the overlap they feel is larger by both. They share out the area
 * of the skin. */
static double expected(const cdem_skin *skin, double overlap) {
  double level = cbrt(skin->volume / (4.0 / 3.0 * pi));
  double deep = 1.0 + (skin->reach - 1.0 + level - 1.0) / overlap;
  return skin->total / (4.0 * pi) * deep * deep;
}

static cdem_status stiff_balls(const char *shape, int refinement, double overlap, double *force,
                               double *by_facets, cdem_fault *fault) {
  const double radius = 0.05;
  cdem_fdem_world world;
  cdem_status status = cdem_fdem_world_init(&world, shape, refinement, 1e20, 0.2, NULL, fault);
  if (status == CDEM_OK)
    status = mean_force(&world, radius, overlap * radius, force, fault);
  if (status == CDEM_OK)
    *by_facets = expected(&world.shape.surface, overlap);
  cdem_fdem_world_release(&world);
  return status;
}

cdem_status cdem_fdem_measure_rigid(int parameter, double *value, cdem_fault *fault) {
  static const struct {
    const char *name;
    int refinement;
  } shape[] = {{"icosphere", 1}, {"tetrasphere", 2}, {"cubesphere", 4}};
  double overlap = overlap_of[parameter % 10], force, by_facets, coarse;
  if (parameter < 30) {
    int which = parameter / 10;
    CDEM_TRY(stiff_balls(shape[which].name, shape[which].refinement, overlap, &force, &by_facets,
                         fault));
    *value = force / by_facets;
    return CDEM_OK;
  }
  CDEM_TRY(stiff_balls("tetrasphere", 1, overlap, &coarse, &by_facets, fault));
  CDEM_TRY(stiff_balls("tetrasphere", 2, overlap, &force, &by_facets, fault));
  *value = (force - 1.0) / (coarse - 1.0);
  return CDEM_OK;
}
