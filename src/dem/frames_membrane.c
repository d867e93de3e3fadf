/* The membrane of a specimen as a frame of triangles. */
#include "dem/frames_membrane.h"

#include "base/mat3.h"
#include "results/frame_draft.h"

#include <string.h>

typedef struct {
  double *displacement, *radial, *push;
} arrays;

/* Way out of the axis, and what grains push by area, positive outwards. */
static void fill(const cdem_membrane *m, const arrays *to) {
  for (int32_t i = 0; i < m->nodes; i++) {
    const double *x = m->x + 3 * (int64_t)i, *start = m->start + 3 * (int64_t)i;
    double out[3] = {start[0] - m->options.center[0], start[1] - m->options.center[1], 0.0};
    double length = cdem_norm3(out);
    for (int c = 0; c < 3; c++) {
      to->displacement[3 * (int64_t)i + c] = x[c] - start[c];
      to->radial[i] += (x[c] - start[c]) * out[c] / length;
    }
    double normal[3];
    cdem_membrane_normal(m, i, normal);
    double area = cdem_norm3(normal);
    to->push[i] = area > 0.0 ? cdem_dot3(m->contact + 3 * (int64_t)i, normal) / (area * area) : 0.0;
  }
}

cdem_status cdem_membrane_frame(const cdem_membrane *m, double time, int64_t index,
                                const cdem_frame_sink *sink, cdem_fault *fault) {
  cdem_frame_draft draft = {.fault = fault}, *r = &draft;
  cdem_frame frame = {.set = "membrane",
                      .index = index,
                      .time = time,
                      .points = m->nodes,
                      .xyz = m->x,
                      .cells = m->faces,
                      .node = m->face};
  uint8_t *type = cdem_frame_draft_take(r, m->faces, sizeof *type);
  int64_t *offset = cdem_frame_draft_take(r, (int64_t)m->faces + 1, sizeof *offset);
  const arrays to = {.displacement =
                         cdem_frame_draft_take(r, 3 * (int64_t)m->nodes, sizeof(double)),
                     .radial = cdem_frame_draft_take(r, m->nodes, sizeof(double)),
                     .push = cdem_frame_draft_take(r, m->nodes, sizeof(double))};
  if (!r->failed) {
    memset(type, 5, (size_t)m->faces);
    for (int64_t f = 0; f < m->faces; f++)
      offset[f + 1] = 3 * (f + 1);
    frame.type = type;
    frame.offset = offset;
    fill(m, &to);
    cdem_frame_draft_add(r, "displacement", "m", false, 3, CDEM_FIELD_REAL, to.displacement);
    cdem_frame_draft_add(r, "radial_displacement", "m", false, 1, CDEM_FIELD_REAL, to.radial);
    cdem_frame_draft_add(r, "velocity", "m/s", false, 3, CDEM_FIELD_REAL, m->v);
    cdem_frame_draft_add(r, "contact_pressure", "Pa", false, 1, CDEM_FIELD_REAL, to.push);
    cdem_frame_draft_add(r, "contact_force", "N", false, 3, CDEM_FIELD_REAL, m->contact);
  }
  return cdem_frame_draft_send(r, &frame, sink);
}
