/* Frames of a coupled case: those of body and grains, and "projection": the elements of the fine
 * region as the projection of its grains moves them. */
#include "results/frame_draft.h"
#include "run/coupled.h"

#include <stdlib.h>
#include <string.h>

/* Nodal displacements of the fine region, d = M^-1 N^T Mp q, into c->d. */
static cdem_status project(const cdem_run_coupled *c, cdem_fault *fault) {
  cdem_projector_shape shape = cdem_run_coupled_shape(c);
  const cdem_dem *dem = &c->grains->dem;
  double *all;
  CDEM_NEW(all, 6 * dem->grains, fault);
  cdem_dem_look(dem, &(cdem_dem_view){.displacement = all, .rotation = all + 3 * dem->grains});
  cdem_run_coupled_gather(c, all, all + 3 * dem->grains);
  free(all);
  return cdem_projector_project(&c->projector, shape, c->u, c->d, fault);
}

static void fill_points(const cdem_run_coupled *c, cdem_frame_draft *r, cdem_frame *frame) {
  const cdem_projector *p = &c->projector;
  int dim = c->grains->dim, width = dim == 2 ? 3 : 6;
  double *xyz = cdem_frame_draft_take(r, 3 * (int64_t)p->nodes, sizeof *xyz);
  double *displacement = cdem_frame_draft_take(r, 3 * (int64_t)p->nodes, sizeof *displacement);
  double *rotation = cdem_frame_draft_take(r, 3 * (int64_t)p->nodes, sizeof *rotation);
  for (int32_t n = 0; !r->failed && n < p->nodes; n++) {
    const double *d = c->d + (int64_t)n * width;
    for (int k = 0; k < dim; k++)
      displacement[3 * n + k] = d[k];
    for (int k = 0; k < 3; k++) {
      xyz[3 * n + k] = c->body->mesh.xyz[3 * (int64_t)p->node[n] + k] + displacement[3 * n + k];
      rotation[3 * n + k] = dim == 3 ? d[3 + k] : k == 2 ? d[2] : 0.0;
    }
  }
  if (r->failed)
    return;
  frame->points = p->nodes;
  frame->xyz = xyz;
  cdem_frame_draft_add(r, "displacement", "m", false, 3, CDEM_FIELD_REAL, displacement);
  cdem_frame_draft_add(r, "micro_rotation", "rad", false, 3, CDEM_FIELD_REAL, rotation);
}

static void fill_cells(const cdem_run_coupled *c, cdem_frame_draft *r, cdem_frame *frame) {
  const cdem_mesh *mesh = &c->body->mesh;
  const cdem_projector *p = &c->projector;
  uint8_t *type = cdem_frame_draft_take(r, c->fine_cells, sizeof *type);
  int64_t *offset = cdem_frame_draft_take(r, (int64_t)c->fine_cells + 1, sizeof *offset), all = 0;
  int32_t *place = cdem_frame_draft_take(r, mesh->nodes, sizeof *place);
  int32_t *grains = cdem_frame_draft_take(r, c->fine_cells, sizeof *grains);
  int32_t *index = cdem_frame_draft_take(r, mesh->cells, sizeof *index);
  for (int32_t k = 0; k < c->fine_cells; k++)
    all += mesh->cell_start[c->fine_cell[k] + 1] - mesh->cell_start[c->fine_cell[k]];
  int32_t *node = cdem_frame_draft_take(r, all, sizeof *node);
  if (r->failed)
    return;
  for (int32_t n = 0; n < p->nodes; n++)
    place[p->node[n]] = n;
  for (int32_t k = 0; k < c->fine_cells; k++) {
    int32_t cell = c->fine_cell[k];
    int64_t count = mesh->cell_start[cell + 1] - mesh->cell_start[cell];
    type[k] = cdem_frame_cell_type((cdem_shape)mesh->cell_shape[cell]);
    index[cell] = k;
    for (int64_t i = 0; i < count; i++)
      node[offset[k] + i] = place[cdem_mesh_cell(mesh, cell)[i]];
    offset[k + 1] = offset[k] + count;
  }
  for (int64_t a = 0; a < c->fine; a++)
    grains[index[c->partition.cell[c->fine_grain[a]]]]++;
  frame->cells = c->fine_cells;
  frame->type = type;
  frame->offset = offset;
  frame->node = node;
  cdem_frame_draft_add(r, "grains", "", true, 1, CDEM_FIELD_INT32, grains);
}

static cdem_status projection(const cdem_run_coupled *c, int64_t index, const cdem_frame_sink *sink,
                              cdem_fault *fault) {
  cdem_frame_draft r = {.fault = fault};
  cdem_frame frame = {.set = "projection", .index = index, .time = c->grains->dem.time};
  CDEM_TRY(project(c, fault));
  fill_points(c, &r, &frame);
  if (!r.failed)
    fill_cells(c, &r, &frame);
  return cdem_frame_draft_send(&r, &frame, sink);
}

/* Data sets whose names both have ("contacts") are told apart by a prefix. */
typedef struct {
  const cdem_frame_sink *to;
} renamed;

static cdem_status rename_contacts(void *context, const cdem_frame *frame, cdem_fault *fault) {
  const renamed *r = context;
  cdem_frame copy = *frame;
  if (strcmp(copy.set, "contacts") == 0)
    copy.set = "block_contacts";
  return r->to->frame(r->to->context, &copy, fault);
}

cdem_status cdem_run_coupled_frames(cdem_run_setup *run, int64_t index, const cdem_frame_sink *sink,
                                    cdem_fault *fault) {
  const cdem_run_coupled *c = cdem_run_coupled_of(run);
  renamed r = {sink};
  const cdem_frame_sink body = {.context = &r, .frame = rename_contacts};
  if (c->has_body)
    CDEM_TRY(cdem_solver_frames(&c->body->solver, index, &body, fault));
  if (!c->has_grains)
    return CDEM_OK;
  CDEM_TRY(cdem_run_grains_frames(c->grains, c->strain, index, sink, fault));
  return projection(c, index, sink, fault);
}
