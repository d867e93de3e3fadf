/* For hosts of a specimen (confinement.h), here and in fdem: what every solver that holds one does
 * alike, whatever its grains are. The host finds which grains touch the membrane and by how much;
 * plates, pressure, damping at the start, the book and the step of the nodes are kept here.
 *
 * Walls are the host's, passed as the array of all of them. Without a membrane (`flexible` false,
 * a cylinder with a servo) the calls about it do nothing or say so. Time is that of the solvers:
 * t_n. */
#ifndef CDEM_DEM_CONFINE_HOST_H
#define CDEM_DEM_CONFINE_HOST_H

#include "dem/confinement.h"
#include "dem/walls_store.h"

typedef struct {
  cdem_confinement options;
  bool flexible;
  cdem_membrane membrane;
  double *lost, *stored; /* [rings] of the touches at t_n, W and J: the host's to set */
  /* what the series of the high plate point at: one value each, of all times */
  double time[1], wanted, speed;
  bool sheared;
  double damping, quiet_damping; /* mass damping of the options; more at the start, 1/s */
  double moved;                  /* of a node since the host's lists were made, m */
  double damped;                 /* by the touches, J */
} cdem_confine_host;

/* CDEM_INPUT: plates that are not there, or cannot press. */
cdem_status cdem_confine_host_check(const cdem_confinement *options, const cdem_wall *wall,
                                    int walls, cdem_fault *fault);
/* diameter: of the smallest grain, m; mass_damping: that of the solver, 1/s. The high plate gets
 * the pressure as the force of its servo. After a failure: release. */
cdem_status cdem_confine_host_init(cdem_confine_host *host, const cdem_confinement *options,
                                   double diameter, double mass_damping, cdem_wall_body *wall,
                                   cdem_fault *fault);
void cdem_confine_host_release(cdem_confine_host *host);

/* A series of one value that the host keeps. */
static inline cdem_series cdem_confine_host_pointed(cdem_confine_host *host, double *value) {
  return (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 1, .time = host->time, .value = value};
}

/* Between the plates, m; within them and the membrane, m^3. */
double cdem_confine_host_height(const cdem_confine_host *host, const cdem_wall_body *wall);
double cdem_confine_host_volume(const cdem_confine_host *host);
/* The force the high plate is to carry now, if it still presses. */
void cdem_confine_host_aim(cdem_confine_host *host, double time, double volume, double height);
/* The membrane to t_n+1 with the plates. */
void cdem_confine_host_move(cdem_confine_host *host, const cdem_wall_body *wall, double time,
                            double step);
/* From now on the high plate has no servo; `velocity` is what it is to move by. */
void cdem_confine_host_shear(cdem_confine_host *host, cdem_wall_body *wall, double speed,
                             cdem_series velocity[3]);

/* Where the options leave the damping at the start open: 2/limit, limit the largest step then. */
void cdem_confine_host_quiet(cdem_confine_host *host, double limit);
/* Mass damping of grains and membrane at this time, 1/s: falls to that of the options. */
double cdem_confine_host_damping(cdem_confine_host *host, double time);

/* The largest step for the nodes, s, where the busiest touches `busiest` grains. */
double cdem_confine_host_limit(const cdem_confine_host *host, double busiest);
void cdem_confine_host_change_step(cdem_confine_host *host, double old, double step);
/* Power at t_n with the velocity of half a step before, for a whole step. */
void cdem_confine_host_after(cdem_confine_host *host, double step);

/* J: stored and kinetic; dissipated; done by the pressure and by plates on the end rings. */
typedef struct {
  double membrane, damping, pressure;
} cdem_confine_book;
cdem_confine_book cdem_confine_host_book(const cdem_confine_host *host, double step);

/* All but `touching` and, without a membrane, `lateral`. high, low: force of the grains on the
 * plates along z, N. */
void cdem_confine_host_look(const cdem_confine_host *host, const cdem_wall_body *wall, double time,
                            double volume, double high, double low, cdem_specimen *now);

#endif
