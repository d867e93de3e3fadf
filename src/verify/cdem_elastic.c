/* Elastic checks: turned and spinning blocks, waves in a bar, the plate with a hole. */
#include "verify/cdem.h"
#include "verify/cdem_world.h"

#include <math.h>
#include <stdlib.h>

static const cdem_world_options rock = {.young = 30e9, .poisson = 0.25, .density = 2700.0};

/* ---- turned and spinning blocks ---- */

static cdem_status turned(cdem_world *world, cdem_shape shape, double *value, cdem_fault *fault) {
  int dim = shape == CDEM_SHAPE_HEX8 || shape == CDEM_SHAPE_TET4 ? 3 : 2;
  cdem_mesh_grid_options grid = {.shape = shape,
                                 .count = {3, 2, dim == 3 ? 2 : 0},
                                 .size = {3.0, 2.0, 2.0},
                                 .distortion = 0.2,
                                 .seed = 5};
  CDEM_TRY(cdem_mesh_grid(&grid, &world->mesh, fault));
  CDEM_TRY(cdem_world_build(world, &rock, fault));
  double *u, *force;
  CDEM_NEW(u, (int64_t)world->body.nodes * dim, fault);
  force = cdem_allocate((int64_t)world->body.nodes * dim, sizeof *force, fault);
  if (force == NULL) {
    free(u);
    return CDEM_MEMORY;
  }
  for (int32_t n = 0; n < world->body.nodes; n++) { /* (x, y) -> (-y, x) */
    const double *x = world->blocks.mesh.xyz + 3 * n;
    u[n * dim] = -x[1] - x[0];
    u[n * dim + 1] = x[0] - x[1];
  }
  cdem_body_forces(&world->body, u, force);
  *value = 0.0;
  for (int64_t i = 0; i < (int64_t)world->body.nodes * dim; i++)
    *value = fmax(*value, fabs(force[i]) / rock.young); /* edges of 1 m */
  free(u);
  free(force);
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_turned(int parameter, double *value, cdem_fault *fault) {
  static const cdem_shape shape[] = {CDEM_SHAPE_QUAD4, CDEM_SHAPE_TRI3, CDEM_SHAPE_HEX8,
                                     CDEM_SHAPE_TET4};
  cdem_world world = {0};
  cdem_status status = turned(&world, shape[parameter], value, fault);
  cdem_world_release(&world);
  return status;
}

/* A soft block that flies and spins so fast that it stretches by some percent; four turns. */
typedef struct {
  double linear, angular, energy; /* drift over the start; the book's largest error */
} drift;

static double largest_change(const double before[3], const double after[3]) {
  double worst = 0.0, scale = 0.0;
  for (int k = 0; k < 3; k++) {
    worst = fmax(worst, fabs(after[k] - before[k]));
    scale = fmax(scale, fabs(before[k]));
  }
  return worst / scale;
}

static cdem_status spinning(cdem_world *world, int dim, double safety, drift *found,
                            cdem_fault *fault) {
  const cdem_world_options soft = {.young = 1e6, .poisson = 0.25, .density = 1000.0};
  const double spin = 8.0;
  CDEM_TRY(cdem_world_grid(world, dim == 3 ? CDEM_SHAPE_HEX8 : CDEM_SHAPE_QUAD4,
                           (int32_t[]){3, 2, dim == 3 ? 2 : 0}, (double[]){1.5, 1.0, 1.0}, fault));
  CDEM_TRY(cdem_world_build(world, &soft, fault));
  for (int32_t n = 0; n < world->body.nodes; n++) {
    const double *x = world->blocks.mesh.xyz + 3 * n;
    world->velocity[n * dim] = 3.0 - spin * (x[1] - 0.5);
    world->velocity[n * dim + 1] = 1.0 + spin * (x[0] - 0.75);
  }
  world->motion.safety = safety;
  CDEM_TRY(cdem_world_start(world, fault));
  CDEM_TRY(cdem_solver_step(&world->solver, fault));
  double linear[2][3], angular[2][3];
  cdem_solver_momentum(&world->solver, linear[0], angular[0]);
  found->energy = 0.0;
  while (world->solver.time < 3.0) {
    CDEM_TRY(cdem_solver_step(&world->solver, fault));
    found->energy = fmax(found->energy, cdem_world_error(world));
  }
  cdem_solver_momentum(&world->solver, linear[1], angular[1]);
  found->linear = largest_change(linear[0], linear[1]);
  found->angular = largest_change(angular[0], angular[1]);
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_spinning(int parameter, double *value, cdem_fault *fault) {
  drift found[2] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int i = 0; i < 2; i++) {
    cdem_world world = {0};
    cdem_status status =
        spinning(&world, parameter < 4 ? 2 : 3, i == 0 ? 0.4 : 0.2, &found[i], fault);
    cdem_world_release(&world);
    CDEM_TRY(status);
  }
  const double answer[4] = {found[1].linear, found[1].angular, found[1].energy,
                            log2(found[0].energy / found[1].energy)};
  *value = answer[parameter % 4];
  return CDEM_OK;
}

/* ---- a bar ----
 *
 * 1 m long; in every second check its sides are on rollers and the wave is sqrt((lambda + 2G)/rho),
 * else Poisson's ratio is 0 and the wave sqrt(E/rho). A traction at x = 0 pushes; until the wave
 * arrives at the far end u(x, t) = J(t - x/c)/(rho c), J the impulse so far per area. */

typedef struct {
  double speed, impedance;
  cdem_series push; /* Pa */
} bar_truth;

static cdem_status start_bar(cdem_world *world, int cells, bool rollers, bool sudden,
                             bar_truth *truth, cdem_fault *fault) {
  const double peak = 1e3, along[3] = {1.0, 0.0, 0.0}; /* strains of 1e-8: linear */
  cdem_world_options options = rock;
  options.poisson = rollers ? 0.25 : 0.0;
  double modulus = options.young * (rollers ? 1.2 : 1.0); /* (1 - nu)/((1 + nu)(1 - 2 nu)) */
  truth->speed = sqrt(modulus / options.density);
  truth->impedance = truth->speed * options.density;
  CDEM_TRY(cdem_world_grid(world, CDEM_SHAPE_QUAD4, (int32_t[]){cells, 1, 0},
                           (double[]){1.0, 0.02, 0.0}, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  if (rollers) {
    CDEM_TRY(cdem_world_support(world, "y0", 1, false, 0.0, 0.0, fault));
    CDEM_TRY(cdem_world_support(world, "y1", 1, false, 0.0, 0.0, fault));
  }
  cdem_series series = {
      .kind = CDEM_SERIES_PULSE, .amplitude = peak, .duration = 0.4 / truth->speed};
  if (sudden)
    CDEM_TRY(cdem_series_constant(peak, &series, fault));
  CDEM_TRY(cdem_series_copy(&series, &truth->push, fault));
  CDEM_TRY(cdem_world_traction(world, "x0", along, &series, fault));
  world->motion.safety = 0.5;
  return CDEM_OK;
}

static double exact_u(const bar_truth *truth, double x, double time) {
  double since = time - x / truth->speed;
  return since > 0.0 ? cdem_series_integral(&truth->push, since) / truth->impedance : 0.0;
}

/* Root mean square error of u when the pulse is in the middle, and the speed of its centre. */
static cdem_status run_pulse(int cells, bool rollers, double *error, double *speed,
                             cdem_fault *fault) {
  cdem_world world = {0};
  bar_truth truth = {0};
  cdem_status status = start_bar(&world, cells, rollers, false, &truth, fault);
  if (status == CDEM_OK)
    status = cdem_world_start(&world, fault);
  if (status == CDEM_OK)
    status = cdem_world_run(&world, 0.8 / truth.speed, fault);
  double sum = 0.0, time = world.solver.time;
  double half = 0.5 * exact_u(&truth, 0.0, time), before = 0.0, *u = world.solver.u;
  for (int32_t n = 0; status == CDEM_OK && n <= cells; n++) { /* the lower row of nodes */
    double x = world.blocks.mesh.xyz[3 * n];
    sum += pow(u[2 * n] - exact_u(&truth, x, time), 2.0);
    if (n > 0 && u[2 * n] < half && before >= half)
      *speed = (x - (half - u[2 * n]) / (before - u[2 * n]) / cells) /
               (time - 0.5 * truth.push.duration) / truth.speed;
    before = u[2 * n];
  }
  *error = sqrt(sum / (cells + 1));
  cdem_series_release(&truth.push);
  cdem_world_release(&world);
  return status;
}

cdem_status cdem_cdem_measure_pulse_order(int parameter, double *value, cdem_fault *fault) {
  double error[2], speed;
  for (int i = 0; i < 2; i++)
    CDEM_TRY(run_pulse(i == 0 ? 100 : 200, parameter == 1, &error[i], &speed, fault));
  *value = log2(error[0] / error[1]);
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_pulse_speed(int parameter, double *value, cdem_fault *fault) {
  double error;
  *value = 0.0;
  return run_pulse(200, parameter == 1, &error, value, fault);
}

typedef struct {
  double speed, plateau, error; /* over the closed forms; mean of |v - exact| over the plateau */
} front;

static cdem_status read_front(const cdem_world *world, const bar_truth *truth, int cells,
                              front *found, cdem_fault *fault) {
  double *v, time = world->solver.time, plateau = 1e3 / truth->impedance, before = 0.0;
  int counted = 0;
  CDEM_NEW(v, (int64_t)world->body.nodes * 2, fault);
  cdem_solver_velocity(&world->solver, v);
  *found = (front){0};
  for (int32_t n = 0; n <= cells; n++) {
    double x = world->blocks.mesh.xyz[3 * n];
    double exact = x < truth->speed * time ? plateau : 0.0, now = v[2 * n] / plateau;
    found->error += fabs(now - exact / plateau) / (cells + 1);
    if (x >= 0.1 && x <= 0.4) {
      found->plateau += now;
      counted++;
    }
    if (n > 0 && now < 0.5 && before >= 0.5) /* the last crossing is the front */
      found->speed = (x - (0.5 - now) / (before - now) / cells) / time / truth->speed;
    before = now;
  }
  found->plateau /= counted;
  free(v);
  return CDEM_OK;
}

static cdem_status run_front(int cells, front *found, cdem_fault *fault) {
  cdem_world world = {0};
  bar_truth truth = {0};
  cdem_status status = start_bar(&world, cells, false, true, &truth, fault);
  if (status == CDEM_OK)
    status = cdem_world_start(&world, fault);
  if (status == CDEM_OK)
    status = cdem_world_run(&world, 0.7 / truth.speed, fault);
  if (status == CDEM_OK)
    status = read_front(&world, &truth, cells, found, fault);
  cdem_series_release(&truth.push);
  cdem_world_release(&world);
  return status;
}

cdem_status cdem_cdem_measure_front(int parameter, double *value, cdem_fault *fault) {
  front found[2];
  for (int i = 0; i < 2; i++)
    CDEM_TRY(run_front(i == 0 ? 200 : 400, &found[i], fault));
  const double answer[3] = {found[1].speed, found[1].plateau,
                            log2(found[0].error / found[1].error)};
  *value = answer[parameter];
  return CDEM_OK;
}

static cdem_status run_quiet(cdem_world *world, bar_truth *truth, double *value,
                             cdem_fault *fault) {
  CDEM_TRY(start_bar(world, 100, true, false, truth, fault));
  int32_t facets, *facet;
  CDEM_TRY(cdem_blocks_group_facets(&world->blocks, "x1", &facets, &facet, fault));
  const double impedance[2] = {truth->impedance, rock.density * sqrt(12e9 / rock.density)};
  world->quiet = (cdem_quiet){.facets = facets, .facet = facet, .impedance = impedance};
  world->motion.quiets = 1;
  world->motion.quiet = &world->quiet;
  cdem_status status = cdem_world_start(world, fault);
  if (status == CDEM_OK)
    status = cdem_world_run(world, 1.8 / truth->speed, fault);
  cdem_energy_book book = {0};
  if (status == CDEM_OK)
    cdem_solver_energies(&world->solver, &book);
  *value = (book.kinetic + book.elastic) / book.load;
  cdem_solver_release(&world->solver); /* before what it borrows here */
  free(facet);
  return status;
}

cdem_status cdem_cdem_measure_quiet(int parameter, double *value, cdem_fault *fault) {
  (void)parameter;
  cdem_world world = {0};
  bar_truth truth = {0};
  cdem_status status = run_quiet(&world, &truth, value, fault);
  cdem_series_release(&truth.push);
  cdem_world_release(&world);
  return status;
}
