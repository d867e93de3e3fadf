#include "dem/packing_lattice.h"

/* Every second row is one radius further; every second layer stands in the hollows of the one
 * below: half a row of radii along x and a third of a row's height, 1/sqrt(3) radii, along y. */
static void hollow(int64_t row, int64_t layer, double shift[2]) {
  bool upper = layer % 2 != 0;
  shift[0] = (row % 2 != 0) != upper ? 1.0 : 0.0;
  shift[1] = upper ? 0.57735026918962576451 : 0.0;
}

static cdem_status make(const cdem_packing_options *options, cdem_grains *grains,
                        cdem_fault *fault) {
  /* Rows sqrt(3) radii apart, layers 2 sqrt(2/3). */
  const cdem_lattice lattice = {1.73205080756887729353, 1.63299316185545206546, hollow};
  return cdem_lattice_fill(options, &lattice, grains, fault);
}

const cdem_packing cdem_packing_hexagonal = {
    .name = "hexagonal",
    .help = "touching rows (2-D), hexagonal close packing with layers normal to z (3-D)",
    .dims = {[2] = true, [3] = true},
    .lattice = true,
    .make = make,
};
