/* Private to dem: lattices that are made of equal rows along x. */
#ifndef CDEM_DEM_PACKING_LATTICE_H
#define CDEM_DEM_PACKING_LATTICE_H

#include "dem/packing.h"

/* Rows `row` apart within a layer, layers `layer` apart (0: one layer). Row j of layer k begins
 * shifted by shift(j, k), which also holds how the layer is shifted along y. All lengths in radii.
 */
typedef struct {
  double row, layer;
  void (*shift)(int64_t row, int64_t layer, double shift[2]);
} cdem_lattice;

/* How many steps fit into a length, one that is whole but for rounding being whole; below 0: none,
 * and never more than there can be grains. */
int64_t cdem_lattice_steps(double length, double step);
/* Fills the box from its low corner, rows along x first, then along y, then along z. */
cdem_status cdem_lattice_fill(const cdem_packing_options *options, const cdem_lattice *lattice,
                              cdem_grains *grains, cdem_fault *fault);

#endif
