/* Frames of grains that deform: their skins. */
#include "results/frame_draft.h"
#include "run/deformable.h"

#include <string.h>

typedef struct {
  double *xyz, *deformation, *force, *velocity;
  int32_t *id, *node;
  uint8_t *type;
  int64_t *offset;
  int64_t points, cells;
} skins;

static void count(const cdem_fdem *fdem, skins *s) {
  for (int64_t g = 0; g < fdem->grains; g++) {
    s->points += cdem_fdem_shape(fdem, g)->surface.nodes;
    s->cells += cdem_fdem_shape(fdem, g)->surface.triangles;
  }
}

static void fill(const cdem_run_deformable *d, skins *s) {
  enum { TRIANGLE = 5 };
  int64_t point = 0, cell = 0;
  for (int64_t g = 0; g < d->fdem.grains; g++) {
    const cdem_skin *skin = &cdem_fdem_shape(&d->fdem, g)->surface;
    cdem_fdem_nodes nodes = cdem_fdem_nodes_of(&d->fdem, g);
    double radius = d->grains->grains.radius[g];
    for (int32_t t = 0; t < skin->triangles; t++, cell++) {
      s->type[cell] = TRIANGLE;
      s->offset[cell + 1] = 3 * (cell + 1);
      for (int k = 0; k < 3; k++)
        s->node[3 * cell + k] = (int32_t)point + skin->triangle[3 * t + k];
    }
    memcpy(s->xyz + 3 * point, nodes.now, (size_t)(3 * nodes.nodes) * sizeof *nodes.now);
    memcpy(s->force + 3 * point, nodes.force, (size_t)(3 * nodes.nodes) * sizeof *nodes.force);
    for (int32_t i = 0; i < nodes.nodes; i++, point++) {
      s->id[point] = (int32_t)g;
      for (int c = 0; c < 3; c++) {
        s->deformation[3 * point + c] =
            nodes.place[3 * i + c] - radius * skin->reference[3 * i + c];
        s->velocity[3 * point + c] = d->velocity[3 * g + c];
      }
    }
  }
}

cdem_status cdem_run_deformable_frames(cdem_run_setup *run, int64_t index,
                                       const cdem_frame_sink *sink, cdem_fault *fault) {
  const cdem_run_deformable *d = cdem_run_deformable_of(run);
  cdem_frame_draft r = {.fault = fault};
  skins s = {0};
  count(&d->fdem, &s);
  cdem_fdem_look(&d->fdem, &(cdem_fdem_view){.velocity = d->velocity});
  s.xyz = cdem_frame_draft_take(&r, 3 * s.points, sizeof *s.xyz);
  s.deformation = cdem_frame_draft_take(&r, 3 * s.points, sizeof *s.deformation);
  s.force = cdem_frame_draft_take(&r, 3 * s.points, sizeof *s.force);
  s.velocity = cdem_frame_draft_take(&r, 3 * s.points, sizeof *s.velocity);
  s.id = cdem_frame_draft_take(&r, s.points, sizeof *s.id);
  s.node = cdem_frame_draft_take(&r, 3 * s.cells, sizeof *s.node);
  s.type = cdem_frame_draft_take(&r, s.cells, sizeof *s.type);
  s.offset = cdem_frame_draft_take(&r, s.cells + 1, sizeof *s.offset);
  if (!r.failed)
    fill(d, &s);
  cdem_frame frame = {.set = "grains",
                      .index = index,
                      .time = d->fdem.time,
                      .points = s.points,
                      .xyz = s.xyz,
                      .cells = s.cells,
                      .type = s.type,
                      .offset = s.offset,
                      .node = s.node};
  cdem_frame_draft_add(&r, "deformation", "m", false, 3, CDEM_FIELD_REAL, s.deformation);
  cdem_frame_draft_add(&r, "force", "N", false, 3, CDEM_FIELD_REAL, s.force);
  cdem_frame_draft_add(&r, "velocity", "m/s", false, 3, CDEM_FIELD_REAL, s.velocity);
  cdem_frame_draft_add(&r, "id", "", false, 1, CDEM_FIELD_INT32, s.id);
  CDEM_TRY(cdem_frame_draft_send(&r, &frame, sink));
  return cdem_run_deformable_membrane(d, index, sink, fault);
}
