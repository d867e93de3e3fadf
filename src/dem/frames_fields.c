/* Coarse-grained fields as a frame: a grid of points, the cells between them. */
#include "dem/frames.h"
#include "dem/measures.h"
#include "results/frame_draft.h"

/* Directions in which the grid has more than one point; `step` between neighbours of each. */
typedef struct {
  int directions;
  int64_t cells, along[3], step[3];
} lattice;

static lattice lattice_of(const cdem_coarse_grid *grid) {
  lattice made = {.cells = 1};
  int64_t step = 1;
  for (int c = 0; c < 3; c++) {
    if (grid->count[c] > 1) {
      made.along[made.directions] = grid->count[c] - 1;
      made.step[made.directions++] = step;
      made.cells *= grid->count[c] - 1;
    }
    step *= grid->count[c];
  }
  return made;
}

/* Corners of VTK's vertex, line, quadrilateral and hexahedron: which of them lie one step on. */
static const uint8_t corner_step[8] = {0, 1, 3, 2, 4, 5, 7, 6};

static void fill_cells(const lattice *l, cdem_frame_draft *r, cdem_frame *frame) {
  static const uint8_t type_of[4] = {1, 3, 9, 12};
  const int corners = 1 << l->directions;
  uint8_t *type = cdem_frame_draft_take(r, l->cells, sizeof *type);
  int64_t *offset = cdem_frame_draft_take(r, l->cells + 1, sizeof *offset);
  int32_t *node = cdem_frame_draft_take(r, corners * l->cells, sizeof *node);
  if (r->failed)
    return;
  for (int64_t cell = 0; cell < l->cells; cell++) {
    int64_t first = 0, rest = cell;
    for (int d = 0; d < l->directions; d++) {
      first += rest % l->along[d] * l->step[d];
      rest /= l->along[d];
    }
    for (int k = 0; k < corners; k++) {
      int64_t at = first;
      for (int d = 0; d < l->directions; d++)
        at += (corner_step[k] >> d & 1) * l->step[d];
      node[corners * cell + k] = (int32_t)at;
    }
    type[cell] = type_of[l->directions];
    offset[cell + 1] = corners * (cell + 1);
  }
  frame->cells = l->cells;
  frame->type = type;
  frame->offset = offset;
  frame->node = node;
}

/* The stress [force][branch] as VTK's symmetric tensor and the axial vector of the rest, and its
 * pressure over the directions of the model. */
static void fill_stress(const cdem_coarse *f, int dim, cdem_frame_draft *r) {
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  double *stress = cdem_frame_draft_take(r, 6 * f->points, sizeof *stress);
  double *skew = cdem_frame_draft_take(r, 3 * f->points, sizeof *skew);
  double *pressure = cdem_frame_draft_take(r, f->points, sizeof *pressure);
  if (r->failed)
    return;
  for (int64_t p = 0; p < f->points; p++) {
    const double *s = f->stress + 9 * p;
    for (int k = 0; k < 6; k++)
      stress[6 * p + k] = 0.5 * (s[3 * pair[k][0] + pair[k][1]] + s[3 * pair[k][1] + pair[k][0]]);
    for (int k = 0; k < 3; k++)
      skew[3 * p + k] =
          0.5 * (s[3 * ((k + 2) % 3) + (k + 1) % 3] - s[3 * ((k + 1) % 3) + (k + 2) % 3]);
    for (int k = 0; k < dim; k++)
      pressure[p] -= s[4 * k] / dim;
  }
  cdem_frame_draft_add(r, "stress", "Pa", false, 6, CDEM_FIELD_REAL, stress);
  cdem_frame_draft_add(r, "stress_skew", "Pa", false, 3, CDEM_FIELD_REAL, skew);
  cdem_frame_draft_add(r, "pressure", "Pa", false, 1, CDEM_FIELD_REAL, pressure);
}

cdem_status cdem_dem_fields_frame(const cdem_dem *dem, const cdem_coarse_grid *grid, int64_t index,
                                  const cdem_frame_sink *sink, cdem_fault *fault) {
  cdem_coarse f = {0};
  cdem_frame_draft r = {.fault = fault};
  cdem_frame frame = {.set = "fields", .index = index, .time = dem->time};
  const lattice l = lattice_of(grid);
  CDEM_TRY(cdem_coarse_fields(dem, grid, &f, fault));
  frame.points = f.points;
  frame.xyz = f.xyz;
  cdem_frame_draft_add(&r, "density", "kg/m3", false, 1, CDEM_FIELD_REAL, f.density);
  cdem_frame_draft_add(&r, "solid", "", false, 1, CDEM_FIELD_REAL, f.solid);
  cdem_frame_draft_add(&r, "velocity", "m/s", false, 3, CDEM_FIELD_REAL, f.velocity);
  cdem_frame_draft_add(&r, "wall_force", "N/m3", false, 3, CDEM_FIELD_REAL, f.wall_force);
  fill_stress(&f, dem->dim, &r);
  if (!r.failed)
    fill_cells(&l, &r, &frame);
  cdem_status status = cdem_frame_draft_send(&r, &frame, sink);
  cdem_coarse_release(&f);
  return status;
}
