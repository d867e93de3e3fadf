#include "dem/frames.h"

#include "dem/frames_membrane.h"
#include "dem/measures_kernels.h"
#include "dem/surface_walls.h"
#include "results/frame_draft.h"

#include <stdlib.h>
#include <string.h>

/* One state of grains becomes up to four frames. */
typedef struct {
  cdem_frame_draft draft;
  const cdem_dem *dem;
  int64_t index;
} making;

static void add_states(cdem_frame_draft *r, const char *name, const uint8_t *data,
                       const char *const *state) {
  cdem_field *field = cdem_frame_draft_add(r, name, "", true, 1, CDEM_FIELD_UINT8, data);
  field->states = 2;
  field->state = state;
}

static cdem_status finish(making *m, cdem_frame *frame, const cdem_frame_sink *sink) {
  frame->index = m->index;
  frame->time = m->dem->time;
  return cdem_frame_draft_send(&m->draft, frame, sink);
}

/* Cells of `corners` points each, one after the other. */
static void simple_cells(cdem_frame_draft *r, int64_t cells, uint8_t type, int corners,
                         cdem_frame *frame) {
  uint8_t *types = cdem_frame_draft_take(r, cells, sizeof *types);
  int64_t *offset = cdem_frame_draft_take(r, cells + 1, sizeof *offset);
  int32_t *node = cdem_frame_draft_take(r, corners * cells, sizeof *node);
  if (r->failed)
    return;
  memset(types, type, (size_t)cells);
  for (int64_t c = 0; c < cells; c++)
    offset[c + 1] = corners * (c + 1);
  for (int64_t n = 0; n < corners * cells; n++)
    node[n] = (int32_t)n;
  frame->cells = cells;
  frame->type = types;
  frame->offset = offset;
  frame->node = node;
}

/* ---- grains ---- */

static void add_strain(cdem_frame_draft *r, const cdem_snapshot *s,
                       const cdem_strain_reference *strain) {
  double *gradient = cdem_frame_draft_take(r, 9 * s->grains, sizeof *gradient);
  double *volumetric = cdem_frame_draft_take(r, s->grains, sizeof *volumetric);
  double *effective = cdem_frame_draft_take(r, s->grains, sizeof *effective);
  if (r->failed)
    return;
  cdem_grain_gradient_kernel(s, strain, gradient);
  for (int64_t i = 0; i < s->grains; i++)
    cdem_strain_measure(s->dim, CDEM_STRAIN_HENCKY, gradient + 9 * i, volumetric + i, effective + i,
                        NULL);
  cdem_frame_draft_add(r, "volumetric_strain", "", false, 1, CDEM_FIELD_REAL, volumetric);
  cdem_frame_draft_add(r, "effective_strain", "", false, 1, CDEM_FIELD_REAL, effective);
}

static void add_stress(cdem_frame_draft *r, const cdem_snapshot *s) {
  double *stress = cdem_frame_draft_take(r, 6 * s->grains, sizeof *stress);
  double *pressure = cdem_frame_draft_take(r, s->grains, sizeof *pressure);
  if (r->failed)
    return;
  cdem_grain_stress_kernel(s, stress);
  for (int64_t i = 0; i < s->grains; i++)
    for (int c = 0; c < s->dim; c++)
      pressure[i] -= stress[6 * i + c] / s->dim;
  cdem_frame_draft_add(r, "stress", "Pa", false, 6, CDEM_FIELD_REAL, stress);
  cdem_frame_draft_add(r, "pressure", "Pa", false, 1, CDEM_FIELD_REAL, pressure);
}

static cdem_status grains_frame(making *m, const cdem_snapshot *s,
                                const cdem_strain_reference *strain, const cdem_frame_sink *sink) {
  cdem_frame_draft *r = &m->draft;
  cdem_frame frame = {.set = "grains", .points = s->grains, .xyz = s->xyz};
  simple_cells(r, s->grains, 1, 1, &frame);
  int32_t *id = cdem_frame_draft_take(r, s->grains, sizeof *id),
          *material = cdem_frame_draft_take(r, s->grains, sizeof *material);
  if (r->failed)
    return finish(m, &frame, sink);
  const int32_t *of = cdem_dem_material(m->dem);
  for (int64_t i = 0; i < s->grains; i++) {
    id[i] = (int32_t)i;
    material[i] = of != NULL ? of[i] : 0;
  }
  cdem_frame_draft_add(r, "radius", "m", false, 1, CDEM_FIELD_REAL, s->radius);
  cdem_frame_draft_add(r, "displacement", "m", false, 3, CDEM_FIELD_REAL, s->displacement);
  cdem_frame_draft_add(r, "rotation", "rad", false, 3, CDEM_FIELD_REAL, s->rotation);
  cdem_frame_draft_add(r, "velocity", "m/s", false, 3, CDEM_FIELD_REAL, s->velocity);
  cdem_frame_draft_add(r, "spin", "rad/s", false, 3, CDEM_FIELD_REAL, s->spin);
  cdem_frame_draft_add(r, "force", "N", false, 3, CDEM_FIELD_REAL, s->force);
  cdem_frame_draft_add(r, "contacts", "", false, 1, CDEM_FIELD_INT32, s->touching);
  cdem_frame_draft_add(r, "material", "", false, 1, CDEM_FIELD_INT32, material);
  cdem_frame_draft_add(r, "id", "", false, 1, CDEM_FIELD_INT32, id);
  add_stress(r, s);
  if (strain != NULL)
    add_strain(r, s, strain);
  return finish(m, &frame, sink);
}

/* ---- contacts ---- */

typedef struct {
  double *xyz, *force, *normal, *push, *overlap;
  uint8_t *sliding, *bonded;
  int32_t *wall;
} contact_arrays;

static void fill_contact(const cdem_snapshot *s, int64_t k, const contact_arrays *to) {
  const cdem_dem_contact *c = &s->contact[k];
  for (int n = 0; n < 3; n++) {
    to->xyz[6 * k + n] = s->xyz[3 * (int64_t)c->a + n];
    to->xyz[6 * k + 3 + n] = to->xyz[6 * k + n] + c->branch[n];
    to->force[3 * k + n] = c->force[n];
    to->normal[3 * k + n] = c->normal[n];
  }
  to->push[k] = c->push;
  to->overlap[k] = c->overlap;
  to->sliding[k] = c->sliding;
  to->bonded[k] = c->bonded;
  to->wall[k] = c->b < 0 ? -1 - c->b : -1;
}

static cdem_status contacts_frame(making *m, const cdem_snapshot *s, const cdem_frame_sink *sink) {
  cdem_frame_draft *r = &m->draft;
  static const char *const sliding[] = {"sticking", "sliding"};
  static const char *const bonded[] = {"touching", "bonded"};
  int64_t n = s->contacts;
  cdem_frame frame = {.set = "contacts", .points = 2 * n};
  simple_cells(r, n, 3, 2, &frame);
  const contact_arrays to = {.xyz = cdem_frame_draft_take(r, 6 * n, sizeof(double)),
                             .force = cdem_frame_draft_take(r, 3 * n, sizeof(double)),
                             .normal = cdem_frame_draft_take(r, 3 * n, sizeof(double)),
                             .push = cdem_frame_draft_take(r, n, sizeof(double)),
                             .overlap = cdem_frame_draft_take(r, n, sizeof(double)),
                             .sliding = cdem_frame_draft_take(r, n, 1),
                             .bonded = cdem_frame_draft_take(r, n, 1),
                             .wall = cdem_frame_draft_take(r, n, sizeof(int32_t))};
  if (r->failed)
    return finish(m, &frame, sink);
  for (int64_t k = 0; k < n; k++)
    fill_contact(s, k, &to);
  frame.xyz = to.xyz;
  cdem_frame_draft_add(r, "force", "N", true, 3, CDEM_FIELD_REAL, to.force);
  cdem_frame_draft_add(r, "normal", "", true, 3, CDEM_FIELD_REAL, to.normal);
  cdem_frame_draft_add(r, "push", "N", true, 1, CDEM_FIELD_REAL, to.push);
  cdem_frame_draft_add(r, "overlap", "m", true, 1, CDEM_FIELD_REAL, to.overlap);
  add_states(r, "sliding", to.sliding, sliding);
  add_states(r, "bonded", to.bonded, bonded);
  cdem_frame_draft_add(r, "wall", "", true, 1, CDEM_FIELD_INT32, to.wall);
  return finish(m, &frame, sink);
}

/* ---- walls ---- */

static cdem_status walls_frame(making *m, const cdem_wall_surface *w, const cdem_frame_sink *sink) {
  cdem_frame_draft *r = &m->draft;
  static const uint8_t types[5] = {0, 0, 3, 5, 9};
  static const int64_t none[1] = {0};
  cdem_frame frame = {.set = "walls",
                      .points = w->points,
                      .xyz = w->xyz,
                      .cells = w->facets,
                      .offset = w->facets > 0 ? w->offset : none,
                      .node = w->node};
  uint8_t *type = cdem_frame_draft_take(r, w->facets, sizeof *type);
  for (int64_t f = 0; f < w->facets && !r->failed; f++)
    type[f] = types[w->offset[f + 1] - w->offset[f]];
  frame.type = type;
  cdem_frame_draft_add(r, "wall", "", true, 1, CDEM_FIELD_INT32, w->wall);
  cdem_frame_draft_add(r, "velocity", "m/s", false, 3, CDEM_FIELD_REAL, w->velocity);
  return finish(m, &frame, sink);
}

cdem_status cdem_dem_frames(const cdem_dem *dem, const cdem_strain_reference *strain, int64_t index,
                            const cdem_frame_sink *sink, cdem_fault *fault) {
  making m = {.draft = {.fault = fault}, .dem = dem, .index = index};
  cdem_snapshot s;
  cdem_wall_surface walls = {0};
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  cdem_status status = grains_frame(&m, &s, strain, sink);
  if (status == CDEM_OK)
    status = contacts_frame(&m, &s, sink);
  cdem_snapshot_release(&s);
  if (status == CDEM_OK && cdem_dem_options_of(dem)->walls > 0) {
    status = cdem_wall_surface_make(dem, &walls, fault);
    if (status == CDEM_OK)
      status = walls_frame(&m, &walls, sink);
  }
  cdem_wall_surface_release(&walls);
  const cdem_membrane *membrane = cdem_dem_membrane(dem);
  if (status == CDEM_OK && membrane != NULL)
    status = cdem_membrane_frame(membrane, dem->time, index, sink, fault);
  return status;
}
