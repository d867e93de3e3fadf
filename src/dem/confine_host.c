/* A specimen, as far as it does not matter what its grains are. */
#include "dem/confine_host.h"

#include <math.h>
#include <stdlib.h>

/* ---- beginning and end ---- */

cdem_status cdem_confine_host_check(const cdem_confinement *o, const cdem_wall *wall, int walls,
                                    cdem_fault *fault) {
  CDEM_REQUIRE(
      o->low >= 0 && o->low < walls && o->high >= 0 && o->high < walls && o->low != o->high, fault,
      CDEM_INPUT, "the plates of a specimen are walls %d and %d; there are %d walls", o->low,
      o->high, walls);
  CDEM_REQUIRE(!o->presses || wall[o->high].servo[2] > 0.0, fault, CDEM_INPUT,
               "the high plate of a specimen is to press it but has no servo along z");
  return CDEM_OK;
}

static cdem_status init_membrane(cdem_confine_host *host, double diameter, cdem_fault *fault) {
  cdem_membrane_options options = *host->options.membrane;
  options.pressure = host->options.pressure;
  CDEM_TRY(cdem_membrane_check(&options, diameter, fault));
  CDEM_TRY(cdem_membrane_create(&options, &host->membrane, fault));
  CDEM_NEW(host->lost, host->membrane.rings, fault);
  CDEM_NEW(host->stored, host->membrane.rings, fault);
  cdem_membrane_evaluate(&host->membrane, 0.0);
  return CDEM_OK;
}

cdem_status cdem_confine_host_init(cdem_confine_host *host, const cdem_confinement *options,
                                   double diameter, double mass_damping, cdem_wall_body *wall,
                                   cdem_fault *fault) {
  *host = (cdem_confine_host){.options = *options,
                              .flexible = options->membrane != NULL,
                              .damping = mass_damping,
                              .quiet_damping = options->quiet_damping};
  if (host->flexible)
    CDEM_TRY(init_membrane(host, diameter, fault));
  if (options->presses)
    wall[options->high].wall.servo_force = cdem_confine_host_pointed(host, &host->wanted);
  return CDEM_OK;
}

void cdem_confine_host_release(cdem_confine_host *host) {
  cdem_membrane_release(&host->membrane);
  free(host->lost);
  free(host->stored);
  *host = (cdem_confine_host){0};
}

/* ---- motion ---- */

double cdem_confine_host_height(const cdem_confine_host *host, const cdem_wall_body *wall) {
  return wall[host->options.high].center[2] - wall[host->options.low].center[2];
}

double cdem_confine_host_volume(const cdem_confine_host *host) {
  return cdem_membrane_volume(&host->membrane);
}

void cdem_confine_host_aim(cdem_confine_host *host, double time, double volume, double height) {
  if (host->options.presses && !host->sheared)
    host->wanted = cdem_series_at(&host->options.pressure, time) * (volume / height);
}

void cdem_confine_host_move(cdem_confine_host *host, const cdem_wall_body *wall, double time,
                            double step) {
  if (!host->flexible)
    return;
  host->moved = sqrt(cdem_membrane_move(&host->membrane, step, wall[host->options.low].velocity[2],
                                        wall[host->options.high].velocity[2]));
  cdem_membrane_set_time(&host->membrane, time);
}

void cdem_confine_host_shear(cdem_confine_host *host, cdem_wall_body *wall, double speed,
                             cdem_series velocity[3]) {
  host->speed = speed;
  host->sheared = true;
  wall[host->options.high].servo = false;
  velocity[0] = velocity[1] = (cdem_series){0};
  velocity[2] = cdem_confine_host_pointed(host, &host->speed);
}

void cdem_confine_host_quiet(cdem_confine_host *host, double limit) {
  if (host->options.quiet > 0.0 && host->quiet_damping == 0.0)
    host->quiet_damping = 2.0 / limit;
}

double cdem_confine_host_damping(cdem_confine_host *host, double time) {
  double left = host->options.quiet > 0.0 ? 1.0 - time / host->options.quiet : 0.0;
  double more = left > 0.0 ? host->quiet_damping * (left * left) : 0.0;
  host->membrane.drag = host->damping + more;
  return host->membrane.drag;
}

/* ---- the step ---- */

/* Both sides of a touch take half of its energy twice (w = 2, solver_limit.c). One more grain than
 * the busiest node has may come. */
double cdem_confine_host_limit(const cdem_confine_host *host, double busiest) {
  const cdem_membrane_options *o = &host->membrane.options;
  double k, c, ratio = o->penalty / o->areal_density;
  if (!host->flexible)
    return INFINITY;
  cdem_membrane_bounds(&host->membrane, &k, &c);
  k += 2.0 * (busiest + 1.0) * ratio;
  c += 4.0 * (busiest + 1.0) * o->contact_damping * sqrt(ratio);
  return 4.0 / (c + sqrt(c * c + 4.0 * k));
}

void cdem_confine_host_change_step(cdem_confine_host *host, double old, double step) {
  if (!host->flexible)
    return;
  cdem_membrane_change_step(&host->membrane, old, step);
  for (int32_t k = 0; k < host->membrane.rings; k++)
    host->damped += 0.5 * (step - old) * host->lost[k];
}

void cdem_confine_host_after(cdem_confine_host *host, double step) {
  for (int32_t k = 0; k < host->membrane.rings; k++)
    host->damped += step * host->lost[k];
}

/* ---- looking ---- */

cdem_confine_book cdem_confine_host_book(const cdem_confine_host *host, double step) {
  cdem_membrane_energies m;
  if (!host->flexible)
    return (cdem_confine_book){0};
  cdem_membrane_energies_now(&host->membrane, step, &m);
  cdem_confine_book e = {.membrane = m.kinetic + m.stretch + m.bending};
  double ahead = 0.0;
  for (int32_t k = 0; k < host->membrane.rings; k++) {
    e.membrane += host->stored[k];
    ahead += 0.5 * step * host->lost[k];
  }
  e.damping = m.damping + host->damped - ahead;
  e.pressure = m.pressure + m.plates;
  return e;
}

void cdem_confine_host_look(const cdem_confine_host *host, const cdem_wall_body *wall, double time,
                            double volume, double high, double low, cdem_specimen *now) {
  *now = (cdem_specimen){0};
  now->pressure = cdem_series_at(&host->options.pressure, time);
  now->height = cdem_confine_host_height(host, wall);
  now->volume = volume;
  now->area = now->volume / now->height;
  now->axial = high / now->area;
  now->bottom = -low / now->area;
  now->speed = wall[host->options.high].velocity[2];
  if (!host->flexible)
    return;
  cdem_membrane_shape shape;
  cdem_membrane_shape_now(&host->membrane, &shape);
  now->lateral = shape.lateral;
}
