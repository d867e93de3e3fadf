/* Coarse graining where the answer is known: a cubic lattice in a periodic cell that is a little
 * smaller than the lattice. Every contact has the same overlap, eps d, whatever the size of the
 * grains. */
#include "verify/scaling.h"

#include <stdio.h>

#define STRAIN    1.25e-3
#define DIAMETER  10e-3
#define STIFFNESS 1e6

/* 8 x 8 x 8 spheres; `analysis` is a line, `law` the words behind contacts. */
static void write_lattice(char text[1000], const char *analysis, const char *law,
                          const char *contact, const char *cell) {
  snprintf(text, 1000,
           "%s\n"
           "local_damping: 0.5\n"
           "grains:\n"
           "  dimension: 3\n"
           "  law: %s\n"
           "  packing: {kind: cubic, high: [80 mm, 80 mm, 80 mm], radius: 5 mm}\n"
           "  materials: {sand: {density: 2600 kg/m3, young: 1 GPa, poisson: 0.2}}\n"
           "contacts: [{%s}]\n"
           "cell: {low: [0, 0, 0], size: [79.9 mm, 79.9 mm, 79.9 mm]%s}\n",
           analysis, law, contact, cell);
}

cdem_status cdem_scaling_measure_window(int parameter, double *value, cdem_fault *fault) {
  char text[1000];
  double last[2];
  bool hertz = parameter == 3, steps = parameter >= 4;
  cdem_scaling scaling = cdem_scaling_coarse(2.0, 3);
  scaling.rule = parameter != 2 && parameter != 3;
  scaling.slow = parameter != 5;
  write_lattice(text, steps ? "end: 20 ms" : "analysis: relaxation", hertz ? "hertz" : "linear",
                hertz ? "restitution: 0.5" : "normal_stiffness: 1e6 N/m, damping_ratio: 0.3",
                steps ? ", rate: {zz: -0.01 1/s}" : "");
  CDEM_TRY(cdem_scaling_last(text, scaling, steps ? "step" : "stress.zz", last, fault));
  double apart = DIAMETER * (1.0 - STRAIN);
  *value = parameter == 0 ? -last[0] / (STIFFNESS * STRAIN * DIAMETER / (apart * apart))
                          : last[1] / last[0];
  return CDEM_OK;
}
