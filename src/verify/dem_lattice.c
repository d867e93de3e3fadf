/* Bonded grains as springs: moduli of the lattice at 45 degrees (Li & Wan 2010), waves in a chain,
 * and two discs of the law of Li & Chu (2005). */
#include "base/memory.h"
#include "verify/dem.h"
#include "verify/dem_world.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* ---- lattice ----
 *
 * All grains move as the gradient says (they are so heavy that forces do not matter), so every bond
 * of one direction carries the same force; the stress is that of one grain and its two bonds up, on
 * the 4 r^2 it owns. */

enum { SIDE = 6 };

static cdem_status start_lattice(cdem_dem_world *world, const double gradient[4], double curl,
                                 cdem_fault *fault) {
  const double r = 0.05, a = sqrt(2.0) * r;
  CDEM_TRY(cdem_dem_world_init(world, 2, "linear", 1e15, fault));
  cdem_dem_world_set(world, CDEM_LAW_normal_stiffness, 2.5e8);
  cdem_dem_world_set(world, CDEM_LAW_damping_ratio, 0.0);
  world->bond_law = (cdem_bond_law){
      .normal_stiffness = 2.5e8, .shear_stiffness = 5e7, .rolling_stiffness = 700.0};
  for (int row = 0; row < SIDE; row++)
    for (int k = 0; k < SIDE; k++) {
      double x[3] = {(2 * k + row % 2) * a, row * a, 0.0}, v[3] = {0};
      v[0] = gradient[0] * x[0] + gradient[1] * x[1];
      v[1] = gradient[2] * x[0] + gradient[3] * x[1];
      CDEM_TRY(cdem_dem_world_add(world, x, r, v, (double[]){0.0, 0.0, curl * x[0]}, fault));
    }
  for (int row = 0; row + 1 < SIDE; row++)
    for (int k = 0; k < SIDE; k++)
      for (int side = -1; side <= 1; side += 2) {
        int other = k + (row % 2 == 0 ? (side < 0 ? -1 : 0) : (side < 0 ? 0 : 1));
        if (other >= 0 && other < SIDE)
          CDEM_TRY(cdem_dem_world_bond(world, row * SIDE + k, (row + 1) * SIDE + other, fault));
      }
  world->options.step = 1e-5;
  return cdem_dem_world_start(world, fault);
}

/* Stress, row-major, and couple stress along x, of the grain in the middle. */
static cdem_status lattice_stress(cdem_dem_world *world, double stress[4], double *couple,
                                  cdem_fault *fault) {
  const int32_t middle = SIDE / 2 * SIDE + SIDE / 2;
  cdem_dem_contact *contact = NULL;
  int64_t contacts = 0;
  stress[0] = stress[1] = stress[2] = stress[3] = *couple = 0.0;
  CDEM_TRY(cdem_dem_contacts(&world->dem, &contacts, &contact, fault));
  for (int64_t i = 0; i < contacts; i++) {
    const cdem_dem_contact *c = &contact[i];
    if (c->a != middle || c->b < middle) /* the two upwards */
      continue;
    double owns = 4.0 * 0.05 * 0.05;
    for (int k = 0; k < 4; k++)
      stress[k] += c->force[k / 2] * c->branch[k % 2] / owns;
    *couple += c->moment[2] * c->branch[0] / owns;
  }
  free(contact);
  return CDEM_OK;
}

cdem_status cdem_dem_measure_lattice(int parameter, double *value, cdem_fault *fault) {
  double gradient[4] = {0}, stress[4], couple = 0.0, curl = parameter == 4 ? 1e-3 : 0.0;
  if (parameter < 4)
    gradient[parameter < 2 ? 0 : 1] = 1e-3;
  cdem_dem_world world;
  cdem_status status = start_lattice(&world, gradient, curl, fault);
  if (status == CDEM_OK)
    status = cdem_dem_steps(&world.dem, 50, fault);
  if (status == CDEM_OK)
    status = lattice_stress(&world, stress, &couple, fault);
  if (status == CDEM_OK) {
    const int component[] = {0, 3, 1, 2};
    double way = 1e-3 * world.dem.time;
    *value = parameter == 4 ? couple / way : stress[component[parameter]] / way;
  }
  cdem_dem_world_release(&world);
  return status;
}

/* ---- chain ---- */

static cdem_status start_chain(cdem_dem_world *world, int grains, double first, int mode,
                               double safety, cdem_fault *fault) {
  const double r = 0.01, kn = 1e6, mass = 2600.0 * 4.0 / 3.0 * pi * r * r * r;
  CDEM_TRY(cdem_dem_world_init(world, 3, "linear", 2600.0, fault));
  cdem_dem_world_set(world, CDEM_LAW_normal_stiffness, kn);
  cdem_dem_world_set(world, CDEM_LAW_damping_ratio, 0.0);
  world->bond_law = (cdem_bond_law){.normal_stiffness = kn, .shear_stiffness = kn};
  for (int i = 0; i < grains; i++) {
    bool end = i == 0 || i == grains - 1;
    double v = mode > 0 && !end ? 1e-4 * sin(mode * pi * i / (grains - 1)) : i == 0 ? first : 0.0;
    CDEM_TRY(cdem_dem_world_add(world, (double[]){2.0 * r * i, 0.0, 0.0}, r,
                                (double[]){v, 0.0, 0.0}, NULL, fault));
    world->grains.motion[i] = end ? CDEM_GRAIN_DRIVEN : CDEM_GRAIN_FREE;
    if (i > 0)
      CDEM_TRY(cdem_dem_world_bond(world, i - 1, i, fault));
  }
  world->options.step = safety * sqrt(mass / kn);
  return cdem_dem_world_start(world, fault);
}

/* The amplitude a_n of a mode obeys a_(n+1) - 2 a_n + a_(n-1) = -(w dt)^2 a_n with w = 2 sqrt(k/m)
 * sin(q/2): after `steps` it is what that recurrence makes of its first two values. */
static cdem_status wave(int mode, double *value, cdem_fault *fault) {
  const int grains = 33, watched = 5, steps = 2000;
  const double safety = 0.2, w = 2.0 * safety * sin(0.5 * mode * pi / (grains - 1));
  cdem_dem_world world;
  double a[3] = {0.0}, largest = 0.0, worst = 0.0;
  cdem_status status = start_chain(&world, grains, 0.0, mode, safety, fault);
  for (int n = 1; n <= steps && status == CDEM_OK; n++) {
    status = cdem_dem_step(&world.dem, fault);
    double now = cdem_dem_world_grain(&world, watched).place[0] - 0.02 * watched;
    double expected = n < 2 ? now : (2.0 - w * w) * a[1] - a[0];
    a[0] = a[1];
    a[1] = expected;
    largest = fmax(largest, fabs(now));
    worst = fmax(worst, fabs(now - expected));
  }
  cdem_dem_world_release(&world);
  *value = worst / largest;
  return status;
}

/* Momentum over m v of a chain whose first grain moves at v from t = 0 on: c t/d + 1/2, c = d
 * sqrt(k/m), up to terms that fade like t^(-1/2) (the sum of the Bessel functions of the
 * semi-infinite chain). */
static cdem_status front(double *value, cdem_fault *fault) {
  const int grains = 200, steps = 750;
  const double safety = 0.2, speed = 1e-4;
  cdem_dem_world world;
  double linear[3], angular[3];
  cdem_status status = start_chain(&world, grains, speed, 0, safety, fault);
  if (status == CDEM_OK)
    status = cdem_dem_steps(&world.dem, steps, fault);
  if (status == CDEM_OK) {
    cdem_dem_momentum(&world.dem, linear, angular);
    double mass = 2600.0 * 4.0 / 3.0 * pi * 1e-6;
    *value = (linear[0] / (mass * speed) - 0.5) / (safety * steps);
  }
  cdem_dem_world_release(&world);
  return status;
}

cdem_status cdem_dem_measure_chain(int parameter, double *value, cdem_fault *fault) {
  return parameter < 2 ? wave(parameter == 0 ? 1 : 20, value, fault) : front(value, fault);
}

/* ---- arms of Li & Chu ----
 *
 * With arms rA and rB the moments of a shear force F_s exceed that of the pair by F_s overlap. A
 * disc that slides through all of an impact loses the integral of mu kn overlap^2, mu kn (v/w)^2
 * pi/(2 w), w^2 = kn/m_reduced. */
cdem_status cdem_dem_measure_arms(int parameter, double *value, cdem_fault *fault) {
  const double r = 0.05, kn = 2.5e8, mu = 0.2, speed = 1.0;
  const double mass = 2600.0 * pi * r * r, w = sqrt(2.0 * kn / mass);
  cdem_dem_world world;
  double linear[3], before[3], after[3];
  cdem_status status = cdem_dem_world_init(&world, 2, "li-chu", 2600.0, fault);
  cdem_dem_world_set(&world, CDEM_LAW_normal_stiffness, kn);
  cdem_dem_world_set(&world, CDEM_LAW_shear_stiffness, kn);
  cdem_dem_world_set(&world, CDEM_LAW_friction, mu);
  cdem_dem_world_set(&world, CDEM_LAW_arms_by_radius, parameter == 0 ? 1.0 : 0.0);
  for (int i = 0; i < 2 && status == CDEM_OK; i++)
    status = cdem_dem_world_add(&world, (double[]){2.0 * r * i, 0.0, 0.0}, r,
                                (double[]){i == 0 ? 0.5 * speed : -0.5 * speed, 0.0, 0.0},
                                (double[]){0.0, 0.0, 100.0}, fault);
  world.options.step = pi / w / 2000.0;
  if (status == CDEM_OK)
    status = cdem_dem_world_start(&world, fault);
  if (status == CDEM_OK) {
    cdem_dem_momentum(&world.dem, linear, before);
    status = cdem_dem_steps(&world.dem, 2100, fault);
    cdem_dem_momentum(&world.dem, linear, after);
    double closed = mu * kn * speed * speed / (w * w) * pi / (2.0 * w);
    *value =
        parameter == 0 ? (before[2] - after[2]) / closed : fabs(before[2] - after[2]) / before[2];
  }
  cdem_dem_world_release(&world);
  return status;
}
