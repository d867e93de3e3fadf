#include "dem/packing_lattice.h"

int64_t cdem_lattice_steps(double length, double step) {
  double steps = floor(length / step * (1.0 + 0x1p-40) + 0x1p-40);
  return length < 0.0 ? -1 : (int64_t)fmin(steps, INT32_MAX);
}

static cdem_status fill_row(const cdem_packing_options *options, const double first[3],
                            double length, cdem_grains *grains, cdem_fault *fault) {
  double radius = options->sizes.radius;
  int64_t last = cdem_lattice_steps(length, 2.0 * radius);
  for (int64_t i = 0; i <= last; i++) {
    const double place[3] = {first[0] + (double)(2 * i) * radius, first[1], first[2]};
    CDEM_TRY(cdem_grains_add(grains, place, radius, fault));
  }
  return CDEM_OK;
}

cdem_status cdem_lattice_fill(const cdem_packing_options *options, const cdem_lattice *lattice,
                              cdem_grains *grains, cdem_fault *fault) {
  double radius = options->sizes.radius, margin = options->centres_inside ? 0.0 : radius;
  double corner[3] = {0}, length[3] = {0};
  for (int c = 0; c < options->dim; c++) {
    corner[c] = options->low[c] + margin;
    length[c] = options->high[c] - margin - corner[c];
  }
  int64_t layers = options->dim == 3 ? cdem_lattice_steps(length[2], lattice->layer * radius) : 0;
  for (int64_t k = 0; k <= layers; k++) {
    CDEM_TRY(cdem_progress_report(options->progress, "placing grains", k, layers + 1, fault));
    for (int64_t j = 0;; j++) {
      double shift[2];
      lattice->shift(j, k, shift);
      double y = ((double)j * lattice->row + shift[1]) * radius;
      if (y > length[1] * (1.0 + 0x1p-40))
        break;
      const double first[3] = {corner[0] + shift[0] * radius, corner[1] + y,
                               corner[2] + (double)k * lattice->layer * radius};
      CDEM_TRY(fill_row(options, first, length[0] - shift[0] * radius, grains, fault));
    }
  }
  return CDEM_OK;
}
