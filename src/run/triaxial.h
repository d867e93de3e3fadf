/* Private to run: a triaxial test as stages, strains and stresses, whoever calculates the grains.
 *
 * A plan is made from the case and from the sizes of the grains; then the engine's solver carries
 * the pressure on all sides until `begin` (consolidation), and at the step nearest to that time it
 * is told to shear: the upper plate goes down with the constant velocity rate * H0. H0 and V0 are
 * height and volume at that step. The end follows: ln(H0/H) = strain there.
 *
 * Strains are logarithmic, positive in compression: axial ln(H0/H), volumetric ln(V0/V), so that
 * dilation is negative (minus eqs 12, 13 of Wang et al. 2024). Stresses are positive in
 * compression: axial F/(V/H) (eq 14), ratio 3 (sl - s0)/(sl + 2 s0) (eq 15) with s0 the wanted
 * pressure.
 */
#ifndef CDEM_RUN_TRIAXIAL_H
#define CDEM_RUN_TRIAXIAL_H

#include "dem/confinement.h"
#include "run/setup.h"

/* Of the grains: what dimensionless numbers are made of. */
typedef struct {
  double diameter; /* mean by number, m */
  double smallest; /* diameter, m */
  double density;  /* mean over the solid, kg/m^3 */
  double solid;    /* volume of all, m^3 */
} cdem_run_triaxial_sizes;

typedef struct {
  cdem_run_triaxial_sizes sizes;
  double clock;       /* mean diameter * sqrt(density/pressure), s */
  double begin, rate; /* of the shear, s, 1/s */
  double time[2], value[2];
  cdem_series pressure; /* Pa: rises from a tenth over the first half of the consolidation */
  bool shears;
  double height, volume; /* H0, V0 */
  double contraction;    /* the largest volumetric strain of the rows so far */
} cdem_run_triaxial;

/* A solver that carries out the plan. */
typedef struct {
  void *solver;
  cdem_run_now (*now)(const void *solver);
  cdem_status (*steps)(void *solver, int64_t steps, cdem_fault *fault);
  void (*specimen)(const void *solver, cdem_specimen *specimen);
  void (*shear)(void *solver, double velocity); /* the high plate goes with it from now on */
} cdem_run_triaxial_host;

/* Fills the plan and what follows from it in the case: `end`, `history_every`, `frame_every`, usual
 * results and curves where those of the same name are not given. */
cdem_status cdem_run_triaxial_plan(cdem_run_setup *run, const cdem_run_triaxial_sizes *sizes,
                                   cdem_run_triaxial *plan, cdem_fault *fault);
/* Options of its membrane; low and high: of the box whose cylinder it is, as
 * wide as its narrower edge. */
void cdem_run_triaxial_membrane(const cdem_run_setup *run, const cdem_run_triaxial *plan,
                                const double low[3], const double high[3],
                                cdem_membrane_options *options);
/* So many steps; the shear begins at the step nearest to its time, however steps are parted into
 * calls. */
cdem_status cdem_run_triaxial_advance(cdem_run_triaxial *plan, const cdem_run_triaxial_host *host,
                                      int64_t steps, cdem_fault *fault);
void cdem_run_triaxial_columns(cdem_run_triaxial *plan, const cdem_run_triaxial_host *host,
                               cdem_run_row *row);
cdem_status cdem_run_triaxial_save(const cdem_run_triaxial *plan, cdem_state *state,
                                   cdem_fault *fault);
cdem_status cdem_run_triaxial_restore(cdem_run_triaxial *plan, const cdem_state *state,
                                      cdem_fault *fault);

#endif
