#include "cdem/frames.h"

#include "base/memory.h"
#include "results/frame_draft.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

uint8_t cdem_frame_cell_type(cdem_shape shape) {
  switch (shape) {
  case CDEM_SHAPE_TRI3:
    return 5;
  case CDEM_SHAPE_QUAD4:
    return 9;
  case CDEM_SHAPE_TET4:
    return 10;
  case CDEM_SHAPE_HEX8:
    return 12;
  case CDEM_SHAPE_WEDGE6:
    return 13;
  case CDEM_SHAPE_PYR5:
    return 14;
  default:
    return 0;
  }
}

/* ---- body ---- */

/* Vectors of the nodes, three components each. */
static double *vectors(const cdem_solver *solver, cdem_frame_draft *r, const double *from) {
  double *to = cdem_frame_draft_take(r, 3 * (int64_t)solver->nodes, sizeof *to);
  int dim = solver->options->body->model->dimension;
  for (size_t n = 0; to != NULL && n < (size_t)solver->nodes; n++)
    for (int k = 0; k < dim; k++)
      to[3 * n + (size_t)k] = from[n * (size_t)solver->dofs + (size_t)k];
  return to;
}

static double *places(const cdem_solver *solver, cdem_frame_draft *r, const double *displacement) {
  const double *xyz = solver->options->body->model->mesh->xyz;
  double *to = cdem_frame_draft_take(r, 3 * (int64_t)solver->nodes, sizeof *to);
  for (size_t i = 0; to != NULL && i < 3 * (size_t)solver->nodes; i++)
    to[i] = xyz[i] + displacement[i];
  return to;
}

/* xx yy zz yz xz xy of the body -> xx yy zz xy yz xz of VTK. */
static void reorder(double *tensor, int64_t cells) {
  for (int64_t c = 0; c < cells; c++) {
    double *t = tensor + 6 * c, yz = t[3], xz = t[4], xy = t[5];
    t[3] = xy;
    t[4] = yz;
    t[5] = xz;
  }
}

static void body_points(const cdem_solver *solver, cdem_frame_draft *r, cdem_frame *frame) {
  int64_t nodes = solver->nodes;
  double *displacement = vectors(solver, r, solver->u);
  double *at = cdem_frame_draft_take(r, nodes * solver->dofs, sizeof *at);
  if (r->failed)
    return;
  cdem_solver_velocity(solver, at);
  double *velocity = vectors(solver, r, at);
  frame->points = nodes;
  frame->xyz = places(solver, r, displacement);
  cdem_frame_draft_add(r, "displacement", "m", false, 3, CDEM_FIELD_REAL, displacement);
  cdem_frame_draft_add(r, "velocity", "m/s", false, 3, CDEM_FIELD_REAL, velocity);
  if (solver->dofs == solver->options->body->model->dimension)
    return;
  double *turn = cdem_frame_draft_take(r, nodes, sizeof *turn);
  for (int64_t n = 0; !r->failed && n < nodes; n++)
    turn[n] = solver->u[3 * n + 2];
  cdem_frame_draft_add(r, "micro_rotation", "rad", false, 1, CDEM_FIELD_REAL, turn);
}

static void body_cells(const cdem_solver *solver, cdem_frame_draft *r, cdem_frame *frame) {
  const cdem_model *model = solver->options->body->model;
  uint8_t *type = cdem_frame_draft_take(r, model->cells, sizeof *type);
  int64_t *offset = cdem_frame_draft_take(r, model->cells + 1, sizeof *offset), count = 0;
  for (int32_t c = 0; c < model->cells; c++)
    count += cdem_shape_get((cdem_shape)model->mesh->cell_shape[model->cell[c]])->nodes;
  int32_t *node = cdem_frame_draft_take(r, count, sizeof *node);
  if (r->failed)
    return;
  for (int32_t c = 0; c < model->cells; c++) {
    cdem_shape shape = (cdem_shape)model->mesh->cell_shape[model->cell[c]];
    int nodes = cdem_shape_get(shape)->nodes;
    type[c] = cdem_frame_cell_type(shape);
    memcpy(node + offset[c], cdem_mesh_cell(model->mesh, model->cell[c]),
           (size_t)nodes * sizeof *node);
    offset[c + 1] = offset[c] + nodes;
  }
  frame->cells = model->cells;
  frame->type = type;
  frame->offset = offset;
  frame->node = node;
}

/* Rotation vector (axis times angle, rad) of a rotation: through the largest component of its
 * quaternion (w, x, y, z), so that no angle is a bad one. */
static void rotation_vector(const double r[9], double vector[3]) {
  double q[4] = {1.0 + r[0] + r[4] + r[8], 1.0 + r[0] - r[4] - r[8], 1.0 - r[0] + r[4] - r[8],
                 1.0 - r[0] - r[4] + r[8]}; /* 4 w^2, 4 x^2, 4 y^2, 4 z^2 */
  const double product[4][4] = {
      {q[0], r[7] - r[5], r[2] - r[6], r[3] - r[1]}, /* 4 w w, 4 w x, .. */
      {r[7] - r[5], q[1], r[1] + r[3], r[2] + r[6]},
      {r[2] - r[6], r[1] + r[3], q[2], r[5] + r[7]},
      {r[3] - r[1], r[2] + r[6], r[5] + r[7], q[3]}};
  int best = 0;
  for (int k = 1; k < 4; k++)
    best = q[k] > q[best] ? k : best;
  double scale = 1.0 / (2.0 * sqrt(q[best])), sign = product[best][0] < 0.0 ? -1.0 : 1.0;
  double part[3], size = 0.0;
  for (int k = 0; k < 3; k++) {
    part[k] = sign * scale * product[best][k + 1];
    size += part[k] * part[k];
  }
  size = sqrt(size); /* sine of half the angle */
  double angle = 2.0 * atan2(size, sign * scale * product[best][0]);
  for (int k = 0; k < 3; k++)
    vector[k] = size > 0.0 ? part[k] * angle / size : 0.0;
}

static void body_fields(const cdem_solver *solver, cdem_frame_draft *r) {
  const cdem_model *model = solver->options->body->model;
  const cdem_blocks *blocks = solver->options->blocks;
  int64_t cells = model->cells;
  cdem_body_fields fields = {
      .stress = cdem_frame_draft_take(r, 6 * cells, sizeof(double)),
      .strain = cdem_frame_draft_take(r, 6 * cells, sizeof(double)),
      .energy = cdem_frame_draft_take(r, CDEM_CLASSES * cells, sizeof(double)),
      .pair_force = cdem_frame_draft_take(r, CDEM_CLASSES * cells, sizeof(double)),
      .rotation = cdem_frame_draft_take(r, 9 * cells, sizeof(double))};
  double *turn = cdem_frame_draft_take(r, 3 * cells, sizeof *turn);
  int32_t *block = cdem_frame_draft_take(r, cells, sizeof *block),
          *material = cdem_frame_draft_take(r, cells, sizeof *material);
  if (r->failed)
    return;
  cdem_body_cell_fields(solver->options->body, solver->u, &fields);
  for (int64_t c = 0; c < cells; c++)
    rotation_vector(fields.rotation + 9 * c, turn + 3 * c);
  for (int64_t c = 0; c < cells; c++)
    for (int k = 3; k < 6; k++) /* tensor shears, half of the engineering ones */
      fields.strain[6 * c + k] *= 0.5;
  reorder(fields.stress, cells);
  reorder(fields.strain, cells);
  cdem_frame_draft_add(r, "stress", "Pa", true, 6, CDEM_FIELD_REAL, fields.stress);
  cdem_frame_draft_add(r, "strain", "", true, 6, CDEM_FIELD_REAL, fields.strain);
  cdem_frame_draft_add(r, "rotation", "rad", true, 3, CDEM_FIELD_REAL, turn);
  /* By spring class: edge, face, body. */
  cdem_frame_draft_add(r, "spring_energy", "J", true, CDEM_CLASSES, CDEM_FIELD_REAL, fields.energy);
  cdem_frame_draft_add(r, "spring_force", "N", true, CDEM_CLASSES, CDEM_FIELD_REAL,
                       fields.pair_force);
  for (int64_t c = 0; c < cells; c++) {
    block[c] = blocks != NULL ? blocks->block[model->cell[c]] : 0;
    material[c] = model->material[c];
  }
  cdem_frame_draft_add(r, "material", "", true, 1, CDEM_FIELD_INT32, material);
  if (blocks != NULL)
    cdem_frame_draft_add(r, "block", "", true, 1, CDEM_FIELD_INT32, block);
}

static cdem_status body_frame(const cdem_solver *solver, int64_t index, const cdem_frame_sink *sink,
                              cdem_fault *fault) {
  cdem_frame_draft r = {.fault = fault};
  cdem_frame frame = {.set = "body"};
  body_points(solver, &r, &frame);
  if (!r.failed)
    body_cells(solver, &r, &frame);
  if (!r.failed)
    body_fields(solver, &r);
  frame.index = index;
  frame.time = solver->time;
  cdem_status status = cdem_frame_draft_send(&r, &frame, sink);
  return status;
}

/* ---- interfaces ---- */

/* Means of the points of a face, and the worst of their states. */
typedef struct {
  double *opening, *slip, *normal, *shear, *damage;
  uint8_t *state, *open, *released;
} face_fields;

static void face_values(const cdem_interface_fields *f, int64_t first, int64_t end, int64_t face,
                        const face_fields *to) {
  double part = 1.0 / (double)(end - first);
  to->open[face] = 1;
  for (int64_t p = first; p < end; p++) {
    to->state[face] = f->state[p] > to->state[face] ? f->state[p] : to->state[face];
    to->open[face] &= f->open[p];
    to->opening[face] += part * f->opening[p];
    to->slip[face] += part * f->slip[p];
    to->normal[face] += part * f->normal_traction[p];
    to->shear[face] += part * f->shear_traction[p];
    to->damage[face] += part * f->damage[p];
  }
}

/* Corners of the mid-face: half way between the two sides. */
static void face_shape(const cdem_solver *solver, const cdem_face_pair *pair, double *xyz) {
  const double *reference = solver->options->body->model->mesh->xyz;
  int dim = solver->options->body->model->dimension;
  for (int c = 0; c < pair->corners; c++)
    for (int k = 0; k < 3; k++) {
      double sum = 0.0;
      for (int side = 0; side < 2; side++) {
        size_t node = (size_t)pair->node[side][c];
        sum += reference[3 * node + (size_t)k];
        sum += k < dim ? solver->u[node * (size_t)solver->dofs + (size_t)k] : 0.0;
      }
      xyz[3 * c + k] = 0.5 * sum;
    }
}

static void face_arrays(cdem_frame_draft *r, int64_t faces, face_fields *to) {
  double **real[] = {&to->opening, &to->slip, &to->normal, &to->shear, &to->damage};
  uint8_t **byte[] = {&to->state, &to->open, &to->released};
  static const char *const name[] = {"opening", "slip", "normal_traction", "shear_traction",
                                     "damage"},
                           *const unit[] = {"m", "m", "Pa", "Pa", ""};
  static const char *const state[] = {"intact", "softening", "tension-failed", "shear-failed"};
  static const char *const open[] = {"closed", "open"};
  static const char *const released[] = {"joined", "released"};
  for (int k = 0; k < 5; k++)
    *real[k] = cdem_frame_draft_take(r, faces, sizeof(double));
  for (int k = 0; k < 3; k++)
    *byte[k] = cdem_frame_draft_take(r, faces, sizeof(uint8_t));
  cdem_field *f = cdem_frame_draft_add(r, "state", "", true, 1, CDEM_FIELD_UINT8, to->state);
  f->states = CDEM_INTERFACE_STATES;
  f->state = state;
  f = cdem_frame_draft_add(r, "open", "", true, 1, CDEM_FIELD_UINT8, to->open);
  f->states = 2;
  f->state = open;
  f = cdem_frame_draft_add(r, "released", "", true, 1, CDEM_FIELD_UINT8, to->released);
  f->states = 2;
  f->state = released;
  for (int k = 0; k < 5; k++)
    cdem_frame_draft_add(r, name[k], unit[k], true, 1, CDEM_FIELD_REAL, *real[k]);
}

static void faces(const cdem_solver *solver, const cdem_interface_fields *f, cdem_frame_draft *r,
                  cdem_frame *frame) {
  const cdem_blocks *blocks = solver->options->blocks;
  int64_t count = 0;
  for (int64_t p = 0; p < f->points; p++)
    count += p == 0 || f->pair[p] != f->pair[p - 1];
  face_fields to = {0};
  face_arrays(r, count, &to);
  double *xyz = cdem_frame_draft_take(r, 3 * f->points, sizeof *xyz);
  uint8_t *type = cdem_frame_draft_take(r, count, sizeof *type);
  int64_t *offset = cdem_frame_draft_take(r, count + 1, sizeof *offset);
  int32_t *node = cdem_frame_draft_take(r, f->points, sizeof *node),
          *law = cdem_frame_draft_take(r, count, sizeof *law);
  if (r->failed)
    return;
  cdem_frame_draft_add(r, "law", "", true, 1, CDEM_FIELD_INT32, law);
  static const uint8_t types[] = {0, 0, 3, 5, 9};
  int64_t face = 0;
  for (int64_t p = 0; p < f->points; face++) {
    const cdem_face_pair *pair = &blocks->pair[f->pair[p]];
    face_shape(solver, pair, xyz + 3 * p);
    face_values(f, p, p + pair->corners, face, &to);
    to.released[face] = solver->options->interfaces->released[f->pair[p]];
    law[face] = solver->options->interfaces->law_of[f->pair[p]];
    type[face] = types[pair->corners];
    p += pair->corners;
    offset[face + 1] = p;
  }
  for (int64_t p = 0; p < f->points; p++)
    node[p] = (int32_t)p;
  frame->points = f->points;
  frame->xyz = xyz;
  frame->cells = count;
  frame->type = type;
  frame->offset = offset;
  frame->node = node;
}

static cdem_status interfaces_frame(const cdem_solver *solver, int64_t index,
                                    const cdem_frame_sink *sink, cdem_fault *fault) {
  cdem_frame_draft r = {.fault = fault};
  cdem_frame frame = {.set = "interfaces"};
  cdem_interface_fields fields = {0};
  CDEM_TRY(cdem_interfaces_fields(solver->options->interfaces, solver->u, &fields, fault));
  faces(solver, &fields, &r, &frame);
  frame.index = index;
  frame.time = solver->time;
  cdem_status status = cdem_frame_draft_send(&r, &frame, sink);
  cdem_interface_fields_release(&fields);
  return status;
}

/* ---- contacts ---- */

static cdem_status contacts_frame(const cdem_solver *solver, int64_t index,
                                  const cdem_frame_sink *sink, cdem_fault *fault) {
  static const char *const sliding[] = {"sticking", "sliding"};
  cdem_frame_draft r = {.fault = fault};
  cdem_contact_fields f = {0};
  CDEM_TRY(cdem_contact_fields_get(solver->options->contact, &f, fault));
  uint8_t *type = cdem_frame_draft_take(&r, f.contacts, sizeof *type);
  int64_t *offset = cdem_frame_draft_take(&r, f.contacts + 1, sizeof *offset);
  int32_t *node = cdem_frame_draft_take(&r, f.contacts, sizeof *node);
  cdem_frame frame = {.set = "contacts",
                      .points = f.contacts,
                      .xyz = f.position,
                      .cells = f.contacts,
                      .type = type,
                      .offset = offset,
                      .node = node};
  for (int64_t k = 0; !r.failed && k < f.contacts; k++) {
    type[k] = 1;
    offset[k + 1] = k + 1;
    node[k] = (int32_t)k;
  }
  cdem_frame_draft_add(&r, "force", "N", false, 3, CDEM_FIELD_REAL, f.force);
  cdem_frame_draft_add(&r, "normal", "", false, 3, CDEM_FIELD_REAL, f.normal);
  cdem_field *field =
      cdem_frame_draft_add(&r, "sliding", "", false, 1, CDEM_FIELD_UINT8, f.sliding);
  field->states = 2;
  field->state = sliding;
  frame.index = index;
  frame.time = solver->time;
  cdem_status status = cdem_frame_draft_send(&r, &frame, sink);
  cdem_contact_fields_release(&f);
  return status;
}

cdem_status cdem_solver_frames(const cdem_solver *solver, int64_t index,
                               const cdem_frame_sink *sink, cdem_fault *fault) {
  CDEM_TRY(body_frame(solver, index, sink, fault));
  if (solver->options->interfaces != NULL)
    CDEM_TRY(interfaces_frame(solver, index, sink, fault));
  if (solver->options->contact != NULL)
    CDEM_TRY(contacts_frame(solver, index, sink, fault));
  return CDEM_OK;
}
