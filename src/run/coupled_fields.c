/* What columns, frames and pictures of a coupled case share: fields of fine grains as the projector
 * wants them, and numbers of an element beside those of grains. */
#include "dem/measures.h"
#include "run/coupled.h"

#include <math.h>

void cdem_run_coupled_gather(const cdem_run_coupled *c, const double *linear,
                             const double *angular) {
  cdem_projector_shape shape = cdem_run_coupled_shape(c);
  int width = shape.translations + shape.rotations;
  for (int64_t a = 0; a < c->fine; a++) {
    int64_t id = c->fine_grain[a];
    for (int k = 0; k < shape.translations; k++)
      c->u[a * width + k] = linear[3 * id + k];
    for (int k = 0; k < shape.rotations; k++) /* discs turn about z */
      c->u[a * width + shape.translations + k] = angular[3 * id + (shape.rotations == 1 ? 2 : k)];
  }
}

cdem_run_cell_numbers cdem_run_coupled_cell(int dim, const double stress[6],
                                            const double strain[6]) {
  const double ordered[6] = {stress[0], stress[1], stress[2], stress[5], stress[3], stress[4]};
  double trace = strain[0] + strain[1] + strain[2], mean = 0.0, sum = 0.0;
  for (int d = 0; d < 3; d++)
    sum += (strain[d] - trace / 3.0) * (strain[d] - trace / 3.0) +
           0.5 * strain[3 + d] * strain[3 + d]; /* shears are engineering ones */
  for (int d = 0; d < dim; d++)
    mean += stress[d] / dim;
  return (cdem_run_cell_numbers){.volumetric_strain = trace,
                                 .effective_strain = sqrt(2.0 / 3.0 * sum),
                                 .volumetric_stress = mean,
                                 .effective_stress = cdem_effective_stress(dim, ordered)};
}
