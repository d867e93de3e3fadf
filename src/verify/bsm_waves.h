/* Private to verify (and to bench/bsm-waves.c): what the interface of a coupled body and grains
 * throws back of a plane wave, derived and measured (docs/theory/bsm-waves.md).
 *
 * Two equal rows of discs along x, a apart, each disc bonded to the next, up to the edge of a fine
 * region; beyond it a strip of quad4 elements of length h = n a, as stiff and as heavy as the rows.
 * Everything moves along x alone. Units: a = 1 m, mass of a disc 1 kg, bonds 1 N/m, so that long
 * waves have the speed 1 m/s and the chain's angular frequency is w = 2 sin(k a/2).
 */
#ifndef CDEM_VERIFY_BSM_WAVES_H
#define CDEM_VERIFY_BSM_WAVES_H

#include "bsm/coupling.h"

typedef struct {
  int ratio;    /* n = h/a, at least 2 */
  double place; /* of the interface grain beyond the edge, in a; 0: 1/2, the continued packing */
  cdem_bsm_form form;
  cdem_bsm_way way; /* of interface grains within a step of the body */
  int cycles;       /* m; 0: 1 */
  double step; /* of the grains, s; 0: 0.2, which is a tenth of a period of the shortest wave */
  int layers;  /* of the absorbing layer, elements; 0: none */
  double rate; /* its c in units of (speed of long waves)/h */
  int grains;  /* in a row, of the measurement; 0: 80 n, at least 400 */
} cdem_bsm_chain;

/* Amplitude of the wave that comes back, |R|, and part of the energy that goes on, of a wave of
 * this k a, 0 < k a < pi. With the layer and m > 1 the layer is not told of the motion within a
 * step of the body (which fades within a spacing or two). */
typedef struct {
  double back, on;
} cdem_bsm_reflection;
cdem_status cdem_bsm_waves_derive(const cdem_bsm_chain *chain, double ka,
                                  cdem_bsm_reflection *derived, cdem_fault *fault);

/* |R| from one pulse with all waves of 0 < k a < 2: back [waves] for ka [waves]. */
cdem_status cdem_bsm_waves_measure(const cdem_bsm_chain *chain, int waves, const double *ka,
                                   double *back, cdem_fault *fault);

/* A pulse of waves of low < k a < high alone: which part of the energy that was put in is in the
 * body once the pulse has met the interface; and what is missing in the books of body, grains and
 * exchange, as a part of their largest term. */
typedef struct {
  double on, error;
} cdem_bsm_energy;
cdem_status cdem_bsm_waves_energy(const cdem_bsm_chain *chain, double low, double high,
                                  cdem_bsm_energy *energy, cdem_fault *fault);

#endif
