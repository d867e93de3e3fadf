/* Contact: a block on a slope, two bars, a stack at rest. */
#include "verify/cdem.h"
#include "verify/cdem_world.h"

#include <math.h>

/* ---- a block on a slope ----
 *
 * Axes along and across the slope; gravity is turned instead. The block starts with the overlap
 * that carries its weight and the contact is soft against the block, so that the normal force is
 * steady.
 */

typedef struct {
  double slope, friction, speed; /* rad, -, m/s down the slope */
  double damping;                /* of mass, 1/s */
  double time;
} slide;

static const double gravity = 9.81, height = 0.1;

static cdem_status run_slide(cdem_world *world, const slide *s, cdem_fault *fault) {
  const cdem_contact_law contact = {
      .kn = 1e9, .kt = 0.4e9, .friction = s->friction, .damping = 0.1};
  const cdem_world_options options = {
      .young = 10e9, .poisson = 0.2, .density = 2500.0, .contact = &contact};
  double overlap = options.density * gravity * cos(s->slope) * height / contact.kn;
  CDEM_TRY(cdem_world_add_box(world, "base", (int32_t[]){6, 1, 0}, (double[]){-0.5, -0.2, 0.0},
                              (double[]){1.0, 0.0, 0.0}, fault));
  CDEM_TRY(cdem_world_add_box(world, "block", (int32_t[]){2, 1, 0}, (double[]){0.0, -overlap, 0.0},
                              (double[]){0.2, height - overlap, 0.0}, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  CDEM_TRY(cdem_world_support(world, "base", 0, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "base", 1, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_velocity(world, "block", (double[]){s->speed, 0.0, 0.0}, fault));
  world->motion.gravity[0] = gravity * sin(s->slope);
  world->motion.gravity[1] = -gravity * cos(s->slope);
  world->motion.mass_damping = s->damping;
  CDEM_TRY(cdem_world_start(world, fault));
  return cdem_world_run(world, s->time, fault);
}

cdem_status cdem_cdem_measure_sliding(int parameter, double *value, cdem_fault *fault) {
  const double friction = 0.5, margin = 1e-3;
  slide s = {.friction = friction, .speed = 1.0, .slope = 0.25, .time = 0.6};
  double truth = 1.0 / (2.0 * gravity * (friction * cos(s.slope) - sin(s.slope)));
  /* A thousandth less, or more, steep than tan phi; damping carries the start's ringing away, and a
   * block that slides then does so at its final speed, (driving less friction)/damping. */
  if (parameter > 0) {
    s.slope = atan(friction * (1.0 + (parameter == 1 ? -margin : margin)));
    s.speed = 0.0;
    s.damping = 50.0;
    s.time = 0.4;
    truth = gravity * (sin(s.slope) - friction * cos(s.slope)) / s.damping;
  }
  cdem_world world = {0};
  cdem_status status = run_slide(&world, &s, fault);
  if (status == CDEM_OK)
    status = cdem_world_mean(&world, "block", parameter == 0 ? world.solver.u : world.solver.v, 0,
                             value, fault);
  cdem_world_release(&world);
  *value /= fabs(truth);
  return status;
}

/* ---- two bars ---- */

static cdem_status run_bars(cdem_world *world, int what, double *value, cdem_fault *fault) {
  const cdem_contact_law contact = {.kn = 30e9 * 40.0 * 10.0, .kt = 1e9};
  const cdem_world_options options = {
      .young = 30e9, .poisson = 0.0, .density = 2700.0, .contact = &contact};
  const double speed = 1.0, wave = sqrt(30e9 / 2700.0), gap = 1e-5;
  double linear[2][3], angular[3];
  CDEM_TRY(cdem_world_add_box(world, "striker", (int32_t[]){40, 2, 0},
                              (double[]){-1.0 - gap, 0.0, 0.0}, (double[]){-gap, 0.1, 0.0}, fault));
  CDEM_TRY(cdem_world_add_box(world, "struck", (int32_t[]){80, 2, 0}, (double[]){0.0, 0.0, 0.0},
                              (double[]){2.0, 0.1, 0.0}, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  CDEM_TRY(cdem_world_velocity(world, "striker", (double[]){speed, 0.0, 0.0}, fault));
  CDEM_TRY(cdem_world_start(world, fault));
  cdem_solver_momentum(&world->solver, linear[0], angular);
  CDEM_TRY(cdem_world_run(world, gap / speed + 3.0 / wave, fault));
  cdem_solver_momentum(&world->solver, linear[1], angular);
  if (what == 0)
    *value = hypot(linear[1][0] - linear[0][0], linear[1][1] - linear[0][1]) / linear[0][0];
  if (what == 1)
    *value = cdem_world_error(world);
  return what == 2 ? cdem_world_mean(world, "striker", world->solver.v, 0, value, fault) : CDEM_OK;
}

cdem_status cdem_cdem_measure_bars(int parameter, double *value, cdem_fault *fault) {
  cdem_world world = {0};
  cdem_status status = run_bars(&world, parameter, value, fault);
  cdem_world_release(&world);
  return status;
}

/* ---- a stack at rest ----
 *
 * Three bricks on a floor. They settle for 2e4 steps; in the next 1e5 nothing may creep. */

static cdem_status run_stack(cdem_world *world, int what, double *value, cdem_fault *fault) {
  const cdem_contact_law contact = {.kn = 1e10, .kt = 4e9, .friction = 0.5, .damping = 0.2};
  const cdem_world_options options = {
      .young = 1e9, .poisson = 0.2, .density = 2500.0, .contact = &contact};
  static const char *const name[] = {"a", "b", "c"};
  CDEM_TRY(cdem_world_add_box(world, "floor", (int32_t[]){1, 1, 1}, (double[]){-0.2, -0.2, -0.1},
                              (double[]){0.4, 0.4, 0.0}, fault));
  for (int i = 0; i < 3; i++)
    CDEM_TRY(cdem_world_add_box(world, name[i], (int32_t[]){1, 1, 1},
                                (double[]){0.02 * i, 0.01 * i, 0.1 * i},
                                (double[]){0.2 + 0.02 * i, 0.2 + 0.01 * i, 0.1 * i + 0.1}, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  for (int k = 0; k < 3; k++)
    CDEM_TRY(cdem_world_support(world, "floor", k, false, 0.0, 0.0, fault));
  world->motion.gravity[2] = -gravity;
  world->motion.local_damping = 0.3;
  CDEM_TRY(cdem_world_start(world, fault));
  double before[3], after;
  for (int i = 0; i < 20000; i++)
    CDEM_TRY(cdem_solver_step(&world->solver, fault));
  for (int k = 0; k < 3; k++)
    CDEM_TRY(cdem_world_mean(world, "c", world->solver.u, k, &before[k], fault));
  for (int i = 0; i < 100000 && what == 0; i++)
    CDEM_TRY(cdem_solver_step(&world->solver, fault));
  *value = 0.0;
  for (int k = 0; k < 3 && what == 0; k++) {
    CDEM_TRY(cdem_world_mean(world, "c", world->solver.u, k, &after, fault));
    *value = fmax(*value, fabs(after - before[k]) / 0.1);
  }
  if (what == 1) /* with the floor's own weight */
    *value = cdem_solver_reaction(&world->solver, 2) /
             (2500.0 * gravity * (3.0 * 0.2 * 0.2 * 0.1 + 0.6 * 0.6 * 0.1));
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_stack(int parameter, double *value, cdem_fault *fault) {
  cdem_world world = {0};
  cdem_status status = run_stack(&world, parameter, value, fault);
  cdem_world_release(&world);
  return status;
}
