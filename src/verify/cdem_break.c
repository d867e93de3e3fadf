/* Breaking: one interface driven by hand, what interfaces cost in stiffness, and the compressed
 * specimen. */
#include "verify/cdem.h"
#include "verify/cdem_world.h"

#include <math.h>
#include <stdlib.h>

/* ---- one interface between two rigidly driven bodies ---- */

static const cdem_interface_law softening = {.insertion = CDEM_INSERTION_PENALTY,
                                             .softening = CDEM_SOFTENING_LINEAR,
                                             .unloading = CDEM_UNLOADING_ELASTIC,
                                             .kn = 1e13,
                                             .ks = 1e13,
                                             .tension = 1e6,
                                             .cohesion = 3e6,
                                             .friction = 0.3,
                                             .energy_1 = 2.0,
                                             .energy_2 = 10.0};
static const double side = 0.01; /* of the squares, m: area 0.01 m^2 */

/* All nodes of a block follow a path: points of (time, displacement). */
static cdem_status drive(cdem_world *world, int32_t block, int component, int points,
                         const double *time, const double *path, cdem_fault *fault) {
  cdem_support *support = &world->support[world->motion.supports];
  int32_t *node, count = 0;
  CDEM_NEW(node, world->blocks.mesh.nodes, fault);
  for (int32_t n = 0; n < world->blocks.mesh.nodes; n++)
    if (world->blocks.node_block[n] == block)
      node[count++] = n;
  *support = (cdem_support){
      .name = block == 0 ? "lower" : "upper", .component = component, .nodes = count, .node = node};
  world->motion.supports++;
  return cdem_series_table(points, time, path, &support->series, fault);
}

typedef struct {
  double pull, shear;    /* largest forces, over what the law allows */
  double friction;       /* |tangential| over normal force at the end */
  double tension_energy; /* fracture energy after the pull, over G_I A */
  double shear_energy;   /* after the shear, over G_II A */
} parting;

/* Pulled by 5 um, closed again and pressed in by 0.3 um, sheared by 10 um. The second world is not
 * pulled before it is pressed and sheared. */
static cdem_status part(cdem_world *world, bool pulled, parting *found, cdem_fault *fault) {
  const cdem_world_options options = {
      .young = 30e9, .poisson = 0.25, .density = 2700.0, .breakable = "body", .law = &softening};
  const double time[4] = {0.0, 10e-3, 20e-3, 40e-3};
  const double up[4] = {0.0, pulled ? 5e-6 : 0.0, -0.3e-6, -0.3e-6}, right[4] = {0, 0, 0, 10e-6};
  const double rest[4] = {0.0, 0.0, 0.0, 0.0};
  CDEM_TRY(cdem_world_grid(world, CDEM_SHAPE_QUAD4, (int32_t[]){1, 2, 0},
                           (double[]){side, 2.0 * side, 0.0}, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  CDEM_TRY(drive(world, 0, 0, 4, time, rest, fault));
  CDEM_TRY(drive(world, 0, 1, 4, time, rest, fault));
  CDEM_TRY(drive(world, 1, 0, 4, time, right, fault));
  CDEM_TRY(drive(world, 1, 1, 4, time, up, fault));
  CDEM_TRY(cdem_world_start(world, fault));
  cdem_energy_book book = {0};
  double pressed = softening.kn * 0.3e-6;
  while (world->solver.time < 0.975 * time[3]) { /* a stop is a blow */
    CDEM_TRY(cdem_solver_step(&world->solver, fault));
    double x = cdem_solver_reaction(&world->solver, 2), y = cdem_solver_reaction(&world->solver, 3);
    if (world->solver.time < time[1]) {
      found->pull = fmax(found->pull, y / (softening.tension * side));
      cdem_solver_energies(&world->solver, &book);
      found->tension_energy = book.fracture / (softening.energy_1 * side);
    } else if (world->solver.time > time[2]) {
      found->shear = fmax(found->shear, x / ((softening.cohesion + 0.3 * pressed) * side));
      found->friction = fabs(x / y);
    }
  }
  cdem_solver_energies(&world->solver, &book);
  found->shear_energy = book.fracture / (softening.energy_2 * side);
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_parting(int parameter, double *value, cdem_fault *fault) {
  cdem_world world = {0};
  parting found = {0};
  cdem_status status = part(&world, parameter < 3, &found, fault);
  cdem_world_release(&world);
  const double answer[] = {found.pull, found.tension_energy, found.friction, found.shear,
                           found.shear_energy};
  *value = answer[parameter];
  return status;
}

/* ---- what interfaces cost ---- */

static cdem_interface_law rock_law(cdem_insertion insertion, double kn, double ratio) {
  return (cdem_interface_law){.insertion = insertion,
                              .kn = kn,
                              .ks = ratio * kn,
                              .tension = 1e6,
                              .cohesion = 3e6,
                              .friction = 0.3};
}

/* Mean stress over mean strain of a column of quadrilaterals under prescribed ends, GPa. */
static cdem_status column(cdem_world *world, int parameter, double *value, cdem_fault *fault) {
  const double young = 30e9, poisson = 0.3, w = 0.05, l = 0.1, h = 0.01, squeeze = -1e-6;
  const double wave = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  const cdem_interface_law law =
      rock_law(parameter == 2 ? CDEM_INSERTION_TIED : CDEM_INSERTION_PENALTY,
               (parameter == 0 ? 10.0 : 100.0) * wave / h, 2.0 / 7.0);
  const cdem_world_options options = {
      .young = young, .poisson = poisson, .density = 2700.0, .breakable = "body", .law = &law};
  CDEM_TRY(cdem_world_grid(world, CDEM_SHAPE_QUAD4, (int32_t[]){parameter == 0 ? 1 : 5, 10, 0},
                           (double[]){w, l, 0.0}, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  CDEM_TRY(cdem_world_support(world, "y1", 1, false, squeeze, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "y0", 1, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "x0", 0, false, 0.0, 0.0, fault));
  if (parameter == 0)
    CDEM_TRY(cdem_world_support(world, "x1", 0, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_start(world, fault));
  CDEM_TRY(cdem_solver_static(&world->solver, 0.0, fault));
  double slope = cdem_solver_reaction(&world->solver, 0) / w / (squeeze / l);
  /* The top and bottom cells have no interface outside: 9 of them on 10 cells. */
  *value = parameter == 0 ? slope / wave : slope * 1e-9;
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_softened(int parameter, double *value, cdem_fault *fault) {
  cdem_world world = {0};
  cdem_status status = column(&world, parameter, value, fault);
  cdem_world_release(&world);
  return status;
}

/* ---- uniaxial compression ----
 *
 * 50 mm x 100 mm, rows 4/3 times as high as columns are wide, each brick cut along the diagonal
 * that rises by 4 in 3: 53.13 degrees. The specimen starts with the velocities of uniform
 * compression, so that nothing but breaking makes waves. */

static cdem_status compress(cdem_world *world, bool tied, double *peak, cdem_fault *fault) {
  const double young = 30e9, poisson = 0.3, w = 0.05, l = 0.1, speed = 0.1;
  const double wave = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  const cdem_interface_law law = rock_law(tied ? CDEM_INSERTION_TIED : CDEM_INSERTION_PENALTY,
                                          100.0 * wave / (w / 8.0), 2.0 / 7.0);
  const cdem_contact_law contact = {.kn = law.kn, .kt = law.ks, .friction = 0.3};
  const cdem_world_options options = {.young = young,
                                      .poisson = poisson,
                                      .density = 2700.0,
                                      .breakable = "body",
                                      .law = &law,
                                      .contact = &contact};
  CDEM_TRY(
      cdem_world_grid(world, CDEM_SHAPE_TRI3, (int32_t[]){8, 12, 0}, (double[]){w, l, 0.0}, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  for (int32_t n = 0; n < world->body.nodes; n++) {
    const double *x = world->blocks.mesh.xyz + 3 * n;
    world->velocity[2 * n] = speed / l * poisson / (1.0 - poisson) * (x[0] - 0.5 * w);
    world->velocity[2 * n + 1] = -speed / l * x[1];
  }
  CDEM_TRY(cdem_world_support(world, "y1", 1, true, -speed, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "y0", 1, true, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_start(world, fault));
  *peak = 0.0;
  while (world->solver.time < 0.32e-3) { /* 32 um; Mohr-Coulomb's peak needs 24 */
    CDEM_TRY(cdem_solver_step(&world->solver, fault));
    *peak = fmax(*peak, -cdem_solver_reaction(&world->solver, 0) / w);
  }
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_mohr_coulomb(int parameter, double *value, cdem_fault *fault) {
  cdem_world world = {0};
  cdem_status status = compress(&world, parameter == 1, value, fault);
  cdem_world_release(&world);
  return status;
}
