/* Frames of grains, and their coarse-grained fields where the case asks for them. */
#include "dem/frames.h"
#include "run/grains.h"

#include <math.h>
#include <string.h>

static cdem_coarse_grid grid_of(const cdem_case_fields *wanted) {
  cdem_coarse_grid grid = {.width = isnan(wanted->width) ? 0.0 : wanted->width};
  memcpy(grid.low, wanted->low, sizeof grid.low);
  memcpy(grid.high, wanted->high, sizeof grid.high);
  for (int c = 0; c < 3; c++)
    grid.count[c] = wanted->count[c] > 1.0 ? (int)wanted->count[c] : 1;
  return grid;
}

cdem_status cdem_run_grains_frames(const cdem_run_grains *g, const cdem_strain_reference *strain,
                                   int64_t index, const cdem_frame_sink *sink, cdem_fault *fault) {
  CDEM_TRY(cdem_dem_frames(&g->dem, strain, index, sink, fault));
  if (!cdem_case_given(&g->run->cases, "grains.fields"))
    return CDEM_OK;
  const cdem_coarse_grid grid = grid_of(&cdem_run_values(g->run)->grains.fields);
  return cdem_dem_fields_frame(&g->dem, &grid, index, sink, fault);
}
