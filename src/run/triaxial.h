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

#include "dem/membrane.h"
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

/* What a solver says of its specimen now; compression positive. */
typedef struct {
  double pressure, height, volume; /* wanted, Pa; m; m^3 */
  double axial, bottom, lateral;   /* Pa, over V/H; lateral: of the grains on the side */
  double speed;                    /* of the upper plate along z, m/s */
} cdem_run_specimen;

/* Fills the plan and what follows from it in the case: `end`, `history_every`, `frame_every`, usual
 * results and curves where those of the same name are not given. */
cdem_status cdem_run_triaxial_plan(cdem_run_setup *run, const cdem_run_triaxial_sizes *sizes,
                                   cdem_run_triaxial *plan, cdem_fault *fault);
/* Options of its membrane; low and high: of the box whose cylinder it is, as
 * wide as its narrower edge. */
void cdem_run_triaxial_membrane(const cdem_run_setup *run, const cdem_run_triaxial *plan,
                                const double low[3], const double high[3],
                                cdem_membrane_options *options);
/* Steps until the shear begins: 0: now or before. */
int64_t cdem_run_triaxial_steps(const cdem_run_triaxial *plan, const cdem_run_now *now);
/* The shear begins; returns the velocity of the upper plate, m/s. */
double cdem_run_triaxial_shear(cdem_run_triaxial *plan, double height, double volume);
void cdem_run_triaxial_columns(cdem_run_triaxial *plan, const cdem_run_specimen *specimen,
                               cdem_run_row *row);
cdem_status cdem_run_triaxial_save(const cdem_run_triaxial *plan, cdem_state *state,
                                   cdem_fault *fault);
cdem_status cdem_run_triaxial_restore(cdem_run_triaxial *plan, const cdem_state *state,
                                      cdem_fault *fault);

#endif
