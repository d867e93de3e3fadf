#include "dem/packing_lattice.h"

static void no_shift(int64_t row, int64_t layer, double shift[2]) {
  (void)row;
  (void)layer;
  shift[0] = shift[1] = 0.0;
}

static cdem_status make(const cdem_packing_options *options, cdem_grains *grains,
                        cdem_fault *fault) {
  return cdem_lattice_fill(options, &(cdem_lattice){2.0, 2.0, no_shift}, grains, fault);
}

const cdem_packing cdem_packing_cubic = {
    .name = "cubic",
    .help = "touching rows along the axes",
    .dims = {[2] = true, [3] = true},
    .lattice = true,
    .make = make,
};
