/* Grains that bounce, roll, tumble and collide: what a closed form or a conservation law says. */
#include "base/bits.h"
#include "base/mat3.h"
#include "mesh/mesh.h"
#include "verify/fdem.h"
#include "verify/fdem_world.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846, gravity = 9.81;

/* ---- one ball ---- */

typedef struct {
  cdem_fdem_integration integration;
  double safety, friction, damping;
} throw;

/* A ball falls slantwise on a floor and leaves it: the energy it has then by that before, and the
 * largest error of the book on the way. Without gravity, so that nothing else does work. */
static cdem_status throw_ball(const throw *how, double *left, double *error, cdem_fault *fault) {
  cdem_fdem_world world;
  cdem_fdem_energies before, e = {0};
  cdem_random random = {3};
  cdem_status status = cdem_fdem_world_init(&world, "cubesphere", 2, 40e9, 0.2, NULL, fault);
  int g = cdem_fdem_world_add(&world, 0.0, 0.0, 0.056, 0.05);
  cdem_fdem_world_turn(&world, g, &random);
  cdem_fdem_world_plane(&world, 0.0, 0.0, 1.0);
  world.velocity[0] = 0.4;
  world.velocity[2] = -2.0;
  world.law.friction = how->friction;
  world.law.damping_ratio = how->damping;
  world.options.integration = how->integration;
  world.options.safety = how->safety;
  *error = 0.0;
  if (status == CDEM_OK)
    status = cdem_fdem_world_start(&world, fault);
  if (status == CDEM_OK)
    cdem_fdem_energies_now(&world.fdem, &before);
  bool touched = false;
  while (status == CDEM_OK && world.fdem.time < 5e-3 && !(touched && e.normal == 0.0)) {
    status = cdem_fdem_steps(&world.fdem, 5, fault);
    cdem_fdem_energies_now(&world.fdem, &e);
    touched = touched || e.normal > 0.0;
    *error = fmax(*error, fabs(e.error) / e.exchange);
  }
  if (status == CDEM_OK && (!touched || e.normal != 0.0))
    status = cdem_fail(fault, CDEM_NUMERIC, "the ball has not met the floor and left it");
  if (status == CDEM_OK)
    *left = cdem_fdem_world_kept(&e) / cdem_fdem_world_kept(&before);
  cdem_fdem_world_release(&world);
  return status;
}

cdem_status cdem_fdem_measure_bounce(int parameter, double *value, cdem_fault *fault) {
  static const throw how[] = {{CDEM_FDEM_EXPLICIT, 0.1, 0.0, 0.0},
                              {CDEM_FDEM_EXPLICIT, 0.1, 0.3, 0.2},
                              {CDEM_FDEM_IMPLICIT, 0.1, 0.3, 0.2},
                              {CDEM_FDEM_EXPLICIT, 0.4, 0.3, 0.0}};
  double left, error, fine;
  CDEM_TRY(throw_ball(&how[parameter], &left, &error, fault));
  *value = parameter == 0 ? left : error;
  if (parameter < 3)
    return CDEM_OK;
  throw finer = how[parameter];
  finer.safety *= 0.25;
  CDEM_TRY(throw_ball(&finer, &left, &fine, fault));
  *value = fine / error;
  return CDEM_OK;
}

/* ---- down a slope ---- */

static cdem_status roll_on(cdem_fdem_world *world, double slope, double until, double *along,
                           double *spin, cdem_fault *fault) {
  double v[3], w[3];
  while (world->fdem.time < until)
    CDEM_TRY(cdem_fdem_steps(&world->fdem, 1, fault));
  cdem_fdem_look(&world->fdem, &(cdem_fdem_view){.velocity = v, .spin = w});
  *along = v[0] * cos(slope) - v[2] * sin(slope);
  *spin = w[1];
  return CDEM_OK;
}

/* It starts as deep in the slope as its weight sinks, p pi r d^2 = m g cos. */
cdem_status cdem_fdem_measure_roll(int parameter, double *value, cdem_fault *fault) {
  const double slope = 0.2, r = 0.05, penalty = 1e7, start = 0.1, end = 0.6;
  cdem_fdem_world world;
  cdem_random random = {5};
  double first = 0.0, last = 0.0, spin = 0.0;
  cdem_status status = cdem_fdem_world_init(&world, "cubesphere", 4, 40e9, 0.2, NULL, fault);
  const double mass = world.density * 4.0 / 3.0 * pi * r * r * r;
  const double height = r - sqrt(mass * gravity * cos(slope) / (penalty * pi * r));
  int g = cdem_fdem_world_add(&world, height * sin(slope), 0.0, height * cos(slope), r);
  cdem_fdem_world_turn(&world, g, &random);
  cdem_fdem_world_plane(&world, 0.0, sin(slope), cos(slope));
  world.law = (cdem_fdem_contact_law){
      .penalty = penalty, .shear_ratio = 1.0, .friction = 0.6, .damping_ratio = 0.05};
  world.options.gravity[2] = -gravity;
  world.options.safety = 0.1;
  if (status == CDEM_OK)
    status = cdem_fdem_world_start(&world, fault);
  if (status == CDEM_OK)
    status = roll_on(&world, slope, start, &first, &spin, fault);
  if (status == CDEM_OK)
    status = roll_on(&world, slope, end, &last, &spin, fault);
  double inertia = world.shape.inertia[0] / (4.0 / 3.0 * pi);
  double free = gravity * sin(slope) / (1.0 + inertia);
  *value = parameter == 0 ? (last - first) / (end - start) / free : spin * r / last;
  cdem_fdem_world_release(&world);
  return status;
}

/* ---- a box that tumbles ---- */

typedef struct {
  double linear, angular, energy; /* worst, relative */
} drift;

static double apart(const double a[3], const double b[3]) {
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return cdem_norm3(d);
}

static cdem_status follow(cdem_fdem_world *world, int bursts, int steps, drift *worst,
                          cdem_fault *fault) {
  double linear[2][3], angular[2][3];
  cdem_fdem_energies e[2];
  *worst = (drift){0};
  cdem_fdem_momentum(&world->fdem, linear[0], angular[0]);
  cdem_fdem_energies_now(&world->fdem, &e[0]);
  for (int n = 0; n < bursts; n++) {
    CDEM_TRY(cdem_fdem_steps(&world->fdem, steps, fault));
    cdem_fdem_momentum(&world->fdem, linear[1], angular[1]);
    cdem_fdem_energies_now(&world->fdem, &e[1]);
    double off = fabs(cdem_fdem_world_kept(&e[1]) / cdem_fdem_world_kept(&e[0]) - 1.0);
    worst->energy = fmax(worst->energy, off);
    worst->linear = fmax(worst->linear, apart(linear[0], linear[1]) / cdem_norm3(linear[0]));
    worst->angular = fmax(worst->angular, apart(angular[0], angular[1]) / cdem_norm3(angular[0]));
  }
  return CDEM_OK;
}

/* Thrown spinning about nearly its middle axis, so that it keeps turning over. */
static cdem_status tumble(double step, drift *worst, cdem_fault *fault) {
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_HEX8, .count = {2, 2, 2}, .size = {3.0, 2.0, 1.0}};
  cdem_mesh box;
  cdem_fdem_world world;
  CDEM_TRY(cdem_mesh_grid(&grid, &box, fault));
  cdem_status status = cdem_fdem_world_init(&world, "mesh", 0, 1e9, 0.2, &box, fault);
  int g = cdem_fdem_world_add(&world, 1.0, 2.0, 3.0, 0.5);
  memcpy(world.spin + 3 * g, (double[]){1.0, 20.0, 2.0}, 3 * sizeof(double));
  memcpy(world.velocity + 3 * g, (double[]){1.0, -2.0, 0.5}, 3 * sizeof(double));
  world.options.step = step;
  world.law.penalty = 1e6;
  if (status == CDEM_OK)
    status = cdem_fdem_world_start(&world, fault);
  if (status == CDEM_OK)
    status = follow(&world, 100, (int)lround(0.01 / step), worst, fault);
  cdem_fdem_world_release(&world);
  cdem_mesh_release(&box);
  return status;
}

cdem_status cdem_fdem_measure_spin(int parameter, double *value, cdem_fault *fault) {
  drift coarse, fine;
  CDEM_TRY(tumble(4e-5, &coarse, fault));
  if (parameter < 2) {
    *value = parameter == 0 ? coarse.linear : coarse.angular;
    return CDEM_OK;
  }
  CDEM_TRY(tumble(2e-5, &fine, fault));
  *value = fine.energy / coarse.energy;
  return CDEM_OK;
}

/* ---- a cloud ---- */

/* 48 balls that overlap here and there fly in all directions. */
static cdem_status cloud(int threads, cdem_fdem_world *world, cdem_fault *fault) {
  cdem_random random = {11};
  cdem_status status = cdem_fdem_world_init(world, "cubesphere", 2, 40e9, 0.2, NULL, fault);
  for (int i = 0; i < 48; i++) {
    const int row = i / 4 % 4, layer = i / 16;
    int g = cdem_fdem_world_add(world, 0.045 * (i % 4), 0.045 * row, 0.045 * layer,
                                cdem_random_uniform(&random, 0.018, 0.022));
    cdem_fdem_world_turn(world, g, &random);
    for (int c = 0; c < 3; c++) {
      world->velocity[3 * g + c] = cdem_random_uniform(&random, -5.0, 5.0);
      world->spin[3 * g + c] = cdem_random_uniform(&random, -50.0, 50.0);
    }
  }
  world->law = (cdem_fdem_contact_law){
      .penalty = 1e11, .shear_ratio = 0.8, .friction = 0.3, .damping_ratio = 0.1};
  world->options.threads = threads;
  world->options.safety = 0.2;
  return status == CDEM_OK ? cdem_fdem_world_start(world, fault) : status;
}

/* Momenta in parts of what they would be if all grains flew the same way. */
static cdem_status balances(int parameter, cdem_fdem_world *world, double *value,
                            cdem_fault *fault) {
  double linear[2][3], angular[2][3], size = 0.0, turn = 0.0;
  cdem_fdem_energies e;
  cdem_fdem_momentum(&world->fdem, linear[0], angular[0]);
  for (int64_t g = 0; g < world->fdem.grains; g++) {
    double part = cdem_fdem_mass(&world->fdem, g) * cdem_norm3(world->velocity + 3 * g);
    size += part;
    turn += part * cdem_norm3(world->xyz + 3 * g);
  }
  CDEM_TRY(cdem_fdem_steps(&world->fdem, 2000, fault));
  cdem_fdem_momentum(&world->fdem, linear[1], angular[1]);
  cdem_fdem_energies_now(&world->fdem, &e);
  CDEM_REQUIRE(e.friction > 0.0 && e.damping > 0.0, fault, CDEM_NUMERIC, "no grains have met");
  const double measured[] = {apart(linear[0], linear[1]) / size,
                             apart(angular[0], angular[1]) / turn, fabs(e.error) / e.exchange};
  *value = measured[parameter];
  return CDEM_OK;
}

static cdem_status bits(cdem_fdem_world *one, double *value, cdem_fault *fault) {
  double a[3 * CDEM_FDEM_WORLD_GRAINS], b[3 * CDEM_FDEM_WORLD_GRAINS];
  cdem_fdem_world two;
  cdem_status status = cloud(2, &two, fault);
  if (status == CDEM_OK)
    status = cdem_fdem_steps(&one->fdem, 600, fault);
  if (status == CDEM_OK)
    status = cdem_fdem_steps(&two.fdem, 600, fault);
  if (status == CDEM_OK) {
    cdem_fdem_look(&one->fdem, &(cdem_fdem_view){.xyz = a});
    cdem_fdem_look(&two.fdem, &(cdem_fdem_view){.xyz = b});
    *value = 0.0;
    for (int64_t i = 0; i < 3 * one->fdem.grains; i++)
      *value += !cdem_same_bits(a[i], b[i]);
  }
  cdem_fdem_world_release(&two);
  return status;
}

cdem_status cdem_fdem_measure_cloud(int parameter, double *value, cdem_fault *fault) {
  cdem_fdem_world world;
  cdem_status status = cloud(1, &world, fault);
  if (status == CDEM_OK)
    status = parameter < 3 ? balances(parameter, &world, value, fault) : bits(&world, value, fault);
  cdem_fdem_world_release(&world);
  return status;
}
