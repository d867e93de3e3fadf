/* The lattice of Li & Wan's foundation (2010, figure 6): a square lattice turned by 45 degrees. */
#include "dem/packing_lattice.h"

static cdem_status make(const cdem_packing_options *options, cdem_grains *grains,
                        cdem_fault *fault) {
  double radius = options->sizes.radius, spacing = 1.41421356237309504880 * radius;
  double margin = options->centres_inside ? 0.0 : radius, top = options->high[1] - radius;
  double middle = 0.5 * (options->low[0] + options->high[0]);
  double half = 0.5 * (options->high[0] - options->low[0]) - margin;
  double depth = top - options->low[1] - margin;
  if (!(half >= 0.0 && depth >= 0.0))
    return CDEM_OK;
  int64_t columns = cdem_lattice_steps(half, spacing),
          rows = cdem_lattice_steps(depth, spacing) + 1;
  for (int64_t row = rows - 1; row >= 0; row--) {
    CDEM_TRY(
        cdem_progress_report(options->progress, "placing grains", rows - 1 - row, rows, fault));
    /* The top row (0) takes odd columns, the next even ones. */
    int64_t first = -columns;
    if ((first + row) % 2 == 0)
      first++;
    for (int64_t column = first; column <= columns; column += 2) {
      const double place[3] = {middle + (double)column * spacing, top - (double)row * spacing, 0.0};
      CDEM_TRY(cdem_grains_add(grains, place, radius, fault));
    }
  }
  return CDEM_OK;
}

const cdem_packing cdem_packing_square = {
    .name = "square",
    .help = "touching rows turned by 45 degrees, top row tangent to the top (Li & Wan 2010)",
    .dims = {[2] = true},
    .lattice = true,
    .make = make,
};
