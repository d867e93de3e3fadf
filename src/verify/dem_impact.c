#include "verify/dem_impact.h"

#include "verify/dem_world.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* The measure of the step: half a period of the spring, or Hertz's duration 2.9432 (m*^2/(R* E*^2
 * v))^(1/5); the numbers follow from Johnson 1985, eqs (11.23)-(11.24). */
static double duration_of(const cdem_impact *p) {
  double mass = p->material.density * 4.0 / 3.0 * pi * p->radius * p->radius * p->radius;
  double modulus = p->material.young / (1.0 - p->material.poisson * p->material.poisson);
  double radius = p->radius, speed = p->normal;
  if (p->stiffness > 0.0)
    return pi * sqrt(mass / p->stiffness);
  if (p->other > 0.0) {
    radius = p->radius * p->other / (p->radius + p->other);
    if (!p->resting)
      mass /= 2.0, modulus /= 2.0, speed *= 2.0;
  }
  double deepest = pow(15.0 * mass * speed * speed / (16.0 * modulus * sqrt(radius)), 0.4);
  return 2.943275 * deepest / speed;
}

static cdem_status prepare(const cdem_impact *p, double gap, cdem_dem_world *world,
                           cdem_fault *fault) {
  CDEM_TRY(
      cdem_dem_world_init(world, 3, p->law != NULL ? p->law : "hertz", p->material.density, fault));
  cdem_dem_world_elastic(world, p->material.young, p->material.poisson, p->resting ? 1e3 : 1e9);
  cdem_dem_world_set(world, CDEM_LAW_friction, p->friction);
  cdem_dem_world_set(world, CDEM_LAW_restitution, p->restitution);
  if (p->stiffness > 0.0)
    cdem_dem_world_set(world, CDEM_LAW_normal_stiffness, p->stiffness);
  CDEM_TRY(cdem_dem_world_add(world, (double[]){0.0, 0.0, p->radius + gap}, p->radius,
                              (double[]){p->tangential, 0.0, -p->normal},
                              (double[]){0.0, p->spin, 0.0}, fault));
  if (p->other <= 0.0)
    return cdem_dem_world_plane(world, (double[3]){0}, (double[]){0.0, 0.0, 1.0}, fault);
  double way = p->resting ? 0.0 : 1.0;
  CDEM_TRY(cdem_dem_world_add(world, (double[]){0.0, 0.0, -p->other}, p->other,
                              (double[]){0.0, 0.0, way * p->normal},
                              (double[]){0.0, -way * p->spin, 0.0}, fault));
  world->material[1].density *= p->resting ? 1e3 : 1.0;
  world->grains.material[1] = p->resting ? 1 : 0;
  return CDEM_OK;
}

/* Runs until contact is lost; afterwards nothing acts. */
static cdem_status follow(const cdem_impact *p, double gap, cdem_dem_world *world,
                          cdem_rebound *rebound, cdem_fault *fault) {
  int burst = p->peaks ? 1 : 25, limit = 200 * (p->fineness > 0 ? p->fineness : 500);
  bool touched = false;
  cdem_dem_grain now = {0};
  for (int step = 0; step < limit; step += burst) {
    CDEM_TRY(cdem_dem_steps(&world->dem, burst, fault));
    now = cdem_dem_world_grain(world, 0);
    double below = p->other > 0.0 ? cdem_dem_world_grain(world, 1).place[2] + p->other : 0.0;
    rebound->force = fmax(rebound->force, fabs(now.force[2]));
    rebound->overlap = fmax(rebound->overlap, p->radius + below - now.place[2]);
    touched = touched || now.contacts > 0;
    if (touched && now.contacts == 0)
      break;
  }
  CDEM_REQUIRE(touched && now.contacts == 0, fault, CDEM_NUMERIC, "the spheres did not part");
  /* Back along the free flight after the contact, forth along the one before it. */
  double speeds = p->other > 0.0 ? 2.0 : 1.0;
  double part = now.place[2] - p->radius;
  if (p->other > 0.0)
    part -= cdem_dem_world_grain(world, 1).place[2] + p->other;
  rebound->normal = now.velocity[2];
  rebound->tangential = now.velocity[0];
  rebound->spin = now.spin[1];
  rebound->slide = now.velocity[0] - p->radius * now.spin[1];
  rebound->duration =
      world->dem.time - gap / (speeds * p->normal) - part / (speeds * now.velocity[2]);
  return CDEM_OK;
}

cdem_status cdem_impact_run(const cdem_impact *impact, cdem_rebound *rebound, cdem_fault *fault) {
  cdem_dem_world world;
  memset(rebound, 0, sizeof *rebound);
  double step = duration_of(impact) / (impact->fineness > 0 ? impact->fineness : 500);
  double gap = 0.5 * step * impact->normal;
  cdem_status status = prepare(impact, gap, &world, fault);
  world.options.step = step;
  if (status == CDEM_OK)
    status = cdem_dem_world_start(&world, fault);
  if (status == CDEM_OK)
    status = follow(impact, gap, &world, rebound, fault);
  cdem_dem_world_release(&world);
  return status;
}
