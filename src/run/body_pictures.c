/* The last state of a body: stress or displacement, with its cracks. */
#include "io/run_files.h"
#include "results/map.h"
#include "run/axis.h"
#include "run/body.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct {
  cdem_map map;
  bool flat, cracks, far, drawn; /* far: the body, or a part of it, has moved */
  int64_t failed;                /* lines of failed faces */
  char label[80];
} picture;

static const double view_flat[3] = {0, 0, -1}, view_solid[3] = {-0.5, 0.75, -0.5};
static const double up_flat[3] = {0, 1, 0}, up_solid[3] = {0, 0, 1};

static bool has_field(const cdem_frame *frame, const char *name) {
  for (int f = 0; f < frame->fields; f++)
    if (strcmp(frame->field[f].name, name) == 0)
      return true;
  return false;
}

/* Cracks and motion show best by displacements; a body in its place by its largest principal
 * stress. */
static cdem_status take_body(picture *p, const cdem_frame *frame, cdem_fault *fault) {
  bool moved = p->cracks || p->far || !has_field(frame, "stress");
  CDEM_TRY(cdem_map_from_frame(frame, moved ? "displacement" : "stress", moved ? -1 : -2,
                               p->flat ? view_flat : view_solid, p->flat ? up_flat : up_solid, 0.0,
                               &p->map, fault));
  p->drawn = true;
  cdem_run_axis unit =
      cdem_run_axis_for(moved ? "m" : "Pa", cdem_run_largest(p->map.value, p->map.polygons));
  cdem_run_rescale(p->map.value, p->map.polygons, unit.factor);
  snprintf(p->label, sizeof p->label, "%s [%s]",
           moved ? "displacement" : "largest principal stress", unit.unit);
  p->map.value_label = p->label;
  p->map.diverging = !moved;
  return CDEM_OK;
}

/* Faces in one state as lines; a state that is nowhere has no entry in the legend. */
static cdem_status add_state(picture *p, const cdem_frame *frame, cdem_interface_state state,
                             const char *title, const char *colour, cdem_fault *fault) {
  CDEM_TRY(cdem_map_add_lines(&p->map, frame, "state", 1u << state,
                              p->flat ? view_flat : view_solid, p->flat ? up_flat : up_solid, title,
                              colour, 1.6, fault));
  cdem_map_lines *lines = &p->map.lines[p->map.line_sets - 1];
  p->failed += state != CDEM_INTERFACE_SOFTENING ? lines->segments : 0;
  lines->title = lines->segments > 0 ? title : NULL;
  return CDEM_OK;
}

/* What softens is shown as long as nothing has failed; after that it would hide the cracks. */
static cdem_status take_frame(void *context, const cdem_frame *frame, cdem_fault *fault) {
  picture *p = context;
  if (strcmp(frame->set, "body") == 0)
    return take_body(p, frame, fault);
  if (strcmp(frame->set, "interfaces") != 0 || !p->drawn)
    return CDEM_OK;
  CDEM_TRY(
      add_state(p, frame, CDEM_INTERFACE_TENSION_FAILED, "failed in tension", "#d7191c", fault));
  CDEM_TRY(add_state(p, frame, CDEM_INTERFACE_SHEAR_FAILED, "failed in shear", "#2166ac", fault));
  return p->failed > 0
             ? CDEM_OK
             : add_state(p, frame, CDEM_INTERFACE_SOFTENING, "softening", "#999999", fault);
}

/* Has anything moved by more than a hundredth of the size of all? Strains alone do not do that. */
static bool has_moved(const cdem_run_body *setup) {
  const cdem_solver *solver = &setup->solver;
  const double *xyz = setup->blocks.mesh.xyz;
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  double largest = 0.0, size = 0.0;
  for (int64_t n = 0; n < solver->nodes; n++)
    for (int k = 0; k < setup->model.dimension; k++) {
      low[k] = fmin(low[k], xyz[3 * n + k]);
      high[k] = fmax(high[k], xyz[3 * n + k]);
      largest = fmax(largest, fabs(solver->u[n * solver->dofs + k]));
    }
  for (int k = 0; k < setup->model.dimension; k++)
    size = fmax(size, high[k] - low[k]);
  return largest > 0.01 * size;
}

cdem_status cdem_run_body_pictures(cdem_run_setup *run, const char *folder, const char *tag,
                                   cdem_fault *fault) {
  const cdem_run_body *setup = run->context;
  picture p = {.flat = setup->model.dimension == 2,
               .cracks = setup->has_interfaces,
               .far = has_moved(setup)};
  const cdem_frame_sink sink = {.context = &p, .frame = take_frame};
  char title[80], name[96];
  snprintf(name, sizeof name, "pattern%s", tag);
  cdem_status status = cdem_solver_frames(&setup->solver, 0, &sink, fault);
  if (status == CDEM_OK && p.drawn) {
    cdem_run_axis time = cdem_run_axis_for("s", setup->solver.time);
    snprintf(title, sizeof title, "t = %.4g %s", time.factor * setup->solver.time, time.unit);
    bool steps = cdem_run_values(run)->analysis == CDEM_ANALYSIS_DYNAMIC;
    p.map.title = steps ? title : "";
    p.map.x_label = p.flat ? "x [m]" : NULL;
    p.map.y_label = p.flat ? "y [m]" : NULL;
    p.map.outlines = setup->model.cells <= 20000;
    status = cdem_write_map(folder, name, &p.map, fault);
  }
  cdem_map_release(&p.map);
  return status;
}
