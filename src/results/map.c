#include "results/map.h"

#include "results/map_view.h"
#include "results/tensor.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- values ---- */

static cdem_status check_field(const cdem_frame *frame, const char *name, int component,
                               const cdem_field **field, cdem_fault *fault) {
  *field = NULL;
  if (name == NULL)
    return CDEM_OK;
  const cdem_field *found = cdem_frame_find_field(frame, name);
  CDEM_REQUIRE(found != NULL, fault, CDEM_INPUT, "the data set '%s' has no field '%s' to colour by",
               frame->set, name);
  CDEM_REQUIRE(component >= -3 && component < found->components, fault, CDEM_USAGE,
               "component %d of the field '%s' cannot be drawn; it has %d, counted from 0, and -1, "
               "-2 and -3 are its size and its largest and least principal value",
               component, name, found->components);
  CDEM_REQUIRE(component >= -1 || found->components == 6, fault, CDEM_USAGE,
               "the field '%s' has %d components; principal values are those of a symmetric tensor "
               "of 6",
               name, found->components);
  *field = found;
  return CDEM_OK;
}

static double reduce(const double *v, int components, int component) {
  double principal[3], sum = 0.0;
  if (component >= 0)
    return v[component];
  if (component == -1 && components == 6)
    return cdem_tensor_von_mises(v);
  if (component == -1 && components == 1)
    return v[0];
  for (int c = 0; c < components; c++)
    sum += v[c] * v[c];
  if (component == -1)
    return sqrt(sum);
  cdem_tensor_principal(v, principal);
  return principal[component == -2 ? 0 : 2];
}

/* A tensor of points is averaged before its invariants are taken. */
static double value_of(const cdem_frame *frame, const cdem_field *field, int component,
                       int64_t cell) {
  double v[6] = {0.0};
  int64_t first = frame->offset[cell], last = frame->offset[cell + 1];
  int components = field->components < 6 ? field->components : 6;
  for (int c = 0; c < components; c++) {
    if (field->on_cells) {
      v[c] = cdem_field_at(field, cell * field->components + c);
      continue;
    }
    for (int64_t n = first; n < last; n++)
      v[c] += cdem_field_at(field, (int64_t)frame->node[n] * field->components + c);
    v[c] /= (double)(last - first);
  }
  return reduce(v, components, component);
}

/* ---- geometry ---- */

/* Positions as they are drawn: borrowed, or a copy to be freed. */
static cdem_status magnified(const cdem_frame *frame, double magnify, double **xyz,
                             cdem_fault *fault) {
  *xyz = NULL;
  if (magnify == 0.0 || magnify == 1.0)
    return CDEM_OK;
  const cdem_field *field = cdem_frame_find_field(frame, "displacement");
  CDEM_REQUIRE(
      field != NULL && !field->on_cells && field->components == 3 && field->type == CDEM_FIELD_REAL,
      fault, CDEM_INPUT,
      "the data set '%s' has no field 'displacement' of vectors at points to magnify", frame->set);
  CDEM_NEW(*xyz, 3 * frame->points, fault);
  const double *displacement = field->data;
  for (int64_t i = 0; i < 3 * frame->points; i++)
    (*xyz)[i] = frame->xyz[i] + (magnify - 1.0) * displacement[i];
  return CDEM_OK;
}

static void mean_of(const double *xyz, const int32_t *node, int64_t count, double mean[3]) {
  for (int c = 0; c < 3; c++) {
    mean[c] = 0.0;
    for (int64_t n = 0; n < count; n++)
      mean[c] += xyz[3 * node[n] + c];
    mean[c] /= (double)count;
  }
}

/* Twice the area times the normal: half the cross product of the diagonals, of a triangle the cross
 * product of two sides. */
static void normal_of(const double *xyz, const cdem_map_face *face, double normal[3]) {
  double a[3], b[3];
  int last = face->corners - 1, opposite = face->corners == 4 ? 1 : 0;
  for (int c = 0; c < 3; c++) {
    a[c] = xyz[3 * face->node[2] + c] - xyz[3 * face->node[0] + c];
    b[c] =
        xyz[3 * face->node[face->corners == 4 ? last : 1] + c] - xyz[3 * face->node[opposite] + c];
  }
  cdem_cross3(a, b, normal);
}

typedef struct {
  double depth; /* of the middle */
  int64_t face;
  double shade;
  double normal[3];
} painted;

/* From back to front; the order of the frame among equals. */
static int compare_depth(const void *a, const void *b) {
  const painted *x = a, *y = b;
  if (x->depth != y->depth)
    return x->depth < y->depth ? 1 : -1;
  return (x->face > y->face) - (x->face < y->face);
}

/* Light over the left shoulder of the viewer. */
static double shade_of(const cdem_map_view *view, const double normal[3]) {
  const double light[3] = {-0.37, 0.59, 0.72}; /* right, up, towards the eye; length 1 */
  double along = light[0] * cdem_dot3(normal, view->right) +
                 light[1] * cdem_dot3(normal, view->up) - light[2] * cdem_dot3(normal, view->into);
  return 0.55 + 0.45 * fmax(0.0, along / cdem_norm3(normal));
}

/* Depth and shade of a face; false when it is not seen. */
static bool see(const cdem_frame *frame, const double *xyz, const cdem_map_view *view,
                const cdem_map_face *face, painted *out) {
  double centre[3], middle[3], *normal = out->normal, outwards = 0.0;
  int64_t first = frame->offset[face->cell];
  mean_of(xyz, face->node, face->corners, centre);
  normal_of(xyz, face, normal);
  out->depth = cdem_dot3(centre, view->into);
  out->shade = 1.0;
  if (!isfinite(out->depth))
    return false;
  if (cdem_vtk_cell_get(frame->type[face->cell])->dimension < 3)
    return true;
  /* Outwards is away from the middle of the cell, whatever the order of its nodes. */
  mean_of(xyz, frame->node + first, frame->offset[face->cell + 1] - first, middle);
  for (int c = 0; c < 3; c++)
    outwards += normal[c] * (centre[c] - middle[c]);
  for (int c = 0; c < 3 && outwards < 0.0; c++)
    normal[c] = -normal[c];
  out->shade = shade_of(view, normal);
  return cdem_dot3(normal, view->into) < -1e-9 * cdem_norm3(normal);
}

/* On the face's plane normal . (x - centre) = 0; the depth is x . into. */
static void flatten(const double *xyz, const cdem_map_view *view, const cdem_map_face *face,
                    const painted *seen, cdem_map_flat *flat) {
  *flat = (cdem_map_flat){
      .corners = face->corners, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
  double middle[2] = {0.0, 0.0}, steep = cdem_dot3(seen->normal, view->into);
  for (int n = 0; n < face->corners; n++) {
    flat->xy[n][0] = cdem_dot3(xyz + 3 * face->node[n], view->right);
    flat->xy[n][1] = cdem_dot3(xyz + 3 * face->node[n], view->up);
    for (int c = 0; c < 2; c++) {
      flat->low[c] = fmin(flat->low[c], flat->xy[n][c]);
      flat->high[c] = fmax(flat->high[c], flat->xy[n][c]);
      middle[c] += flat->xy[n][c] / face->corners;
    }
  }
  if (steep != 0.0) {
    flat->plane[1] = -cdem_dot3(seen->normal, view->right) / steep;
    flat->plane[2] = -cdem_dot3(seen->normal, view->up) / steep;
  }
  flat->plane[0] = seen->depth - flat->plane[1] * middle[0] - flat->plane[2] * middle[1];
}

/* ---- the map ---- */

static cdem_status allocate_map(cdem_map *map, int64_t polygons, bool solid, cdem_fault *fault) {
  CDEM_NEW(map->start, polygons + 1, fault);
  CDEM_NEW(map->xy, 8 * polygons, fault);
  CDEM_NEW(map->value, polygons, fault);
  if (solid)
    CDEM_NEW(map->shade, polygons, fault);
  return CDEM_OK;
}

static void put_polygon(cdem_map *map, const double *xyz, const cdem_map_view *view,
                        const cdem_map_face *face, double value, double shade) {
  int64_t at = map->start[map->polygons];
  for (int n = 0; n < face->corners; n++) {
    map->xy[2 * (at + n)] = cdem_dot3(xyz + 3 * face->node[n], view->right);
    map->xy[2 * (at + n) + 1] = cdem_dot3(xyz + 3 * face->node[n], view->up);
  }
  map->value[map->polygons] = value;
  if (map->shade != NULL)
    map->shade[map->polygons] = shade;
  map->start[++map->polygons] = at + face->corners;
}

typedef struct {
  const cdem_frame *frame;
  const cdem_field *field;
  int component;
  cdem_map_view view;
  const double *xyz;
} painter;

/* Order in which the sorted faces are painted. A plane body, all of one depth, keeps its order. */
static cdem_status find_order(const painter *p, const cdem_map_face *face, int64_t count,
                              const painted *seen, int32_t *order, cdem_fault *fault) {
  for (int64_t i = 0; i < count; i++)
    order[i] = (int32_t)i;
  if (count == 0 || seen[0].depth == seen[count - 1].depth)
    return CDEM_OK;
  cdem_map_flat *flat = cdem_allocate(count, sizeof *flat, fault);
  if (flat == NULL)
    return CDEM_MEMORY;
  for (int64_t i = 0; i < count; i++)
    flatten(p->xyz, &p->view, &face[seen[i].face], &seen[i], &flat[i]);
  cdem_status status = cdem_map_order(count, flat, order, fault);
  free(flat);
  return status;
}

static cdem_status paint_faces(const painter *p, int64_t faces, const cdem_map_face *face,
                               painted *seen, int32_t *order, cdem_map *map, cdem_fault *fault) {
  int64_t count = 0;
  bool solid = false;
  for (int64_t f = 0; f < faces; f++) {
    seen[count].face = f;
    solid |= cdem_vtk_cell_get(p->frame->type[face[f].cell])->dimension == 3;
    count += see(p->frame, p->xyz, &p->view, &face[f], &seen[count]);
  }
  qsort(seen, (size_t)count, sizeof *seen, compare_depth);
  CDEM_TRY(find_order(p, face, count, seen, order, fault));
  CDEM_TRY(allocate_map(map, count, solid, fault));
  for (int64_t i = 0; i < count; i++) {
    const painted *next = &seen[order[i]];
    const cdem_map_face *f = &face[next->face];
    double value = p->field != NULL ? value_of(p->frame, p->field, p->component, f->cell) : NAN;
    put_polygon(map, p->xyz, &p->view, f, value, next->shade);
  }
  return CDEM_OK;
}

static cdem_status paint(const painter *p, cdem_map *map, cdem_fault *fault) {
  int64_t faces = 0;
  cdem_map_face *face = NULL;
  CDEM_TRY(cdem_map_outer_faces(p->frame, &faces, &face, fault));
  painted *seen = cdem_allocate(faces, sizeof *seen, fault);
  int32_t *order = cdem_allocate(faces, sizeof *order, fault);
  cdem_status status = CDEM_MEMORY;
  if (seen != NULL && order != NULL)
    status = paint_faces(p, faces, face, seen, order, map, fault);
  free(order);
  free(seen);
  free(face);
  return status;
}

cdem_status cdem_map_from_frame(const cdem_frame *frame, const char *field, int component,
                                const double view[3], const double up[3], double magnify,
                                cdem_map *map, cdem_fault *fault) {
  painter p = {.frame = frame, .component = component};
  double *xyz = NULL;
  *map = (cdem_map){0};
  CDEM_TRY(check_field(frame, field, component, &p.field, fault));
  CDEM_TRY(cdem_map_view_init(view, up, &p.view, fault));
  CDEM_TRY(magnified(frame, magnify, &xyz, fault));
  p.xyz = xyz != NULL ? xyz : frame->xyz;
  cdem_status status = paint(&p, map, fault);
  free(xyz);
  if (status != CDEM_OK)
    cdem_map_release(map);
  return status;
}

/* ---- lines ---- */

static bool is_wanted(const cdem_field *field, unsigned mask, int64_t cell) {
  if (field == NULL)
    return true;
  double value = cdem_field_at(field, cell);
  return value >= 0 && value < 32 && (mask >> (int)value & 1u) != 0;
}

static void put_edges(const cdem_frame *frame, const cdem_map_view *view, int64_t cell,
                      cdem_map_lines *lines) {
  const cdem_vtk_cell *shape = cdem_vtk_cell_get(frame->type[cell]);
  for (int e = 0; e < shape->edges; e++) {
    double *xy = lines->xy + 4 * lines->segments++;
    for (int end = 0; end < 2; end++) {
      const double *xyz = frame->xyz + 3 * frame->node[frame->offset[cell] + shape->edge[e][end]];
      xy[2 * end] = cdem_dot3(xyz, view->right);
      xy[2 * end + 1] = cdem_dot3(xyz, view->up);
    }
  }
}

cdem_status cdem_map_add_lines(cdem_map *map, const cdem_frame *frame, const char *field,
                               unsigned mask, const double into[3], const double up[3],
                               const char *title, const char *colour, double width,
                               cdem_fault *fault) {
  cdem_map_view view;
  const cdem_field *states = field != NULL ? cdem_frame_find_field(frame, field) : NULL;
  CDEM_REQUIRE(field == NULL || (states != NULL && states->on_cells && states->components == 1 &&
                                 states->type != CDEM_FIELD_REAL),
               fault, CDEM_INPUT,
               "the data set '%s' has no field '%s' of one integer a cell to choose lines by",
               frame->set, field);
  CDEM_TRY(cdem_map_view_init(into, up, &view, fault));
  int64_t segments = 0;
  cdem_map_lines *lines;
  for (int64_t c = 0; c < frame->cells; c++)
    if (is_wanted(states, mask, c))
      segments += cdem_vtk_cell_get(frame->type[c])->edges;
  CDEM_TRY(cdem_map_add_segments(map, segments, title, colour, width, &lines, fault));
  lines->segments = 0;
  for (int64_t c = 0; c < frame->cells; c++)
    if (is_wanted(states, mask, c))
      put_edges(frame, &view, c, lines);
  return CDEM_OK;
}

cdem_status cdem_map_add_segments(cdem_map *map, int64_t segments, const char *title,
                                  const char *colour, double width, cdem_map_lines **lines,
                                  cdem_fault *fault) {
  int64_t capacity = map->line_sets;
  CDEM_TRY(cdem_grow(&map->lines, &capacity, map->line_sets + 1, sizeof *map->lines, fault));
  cdem_map_lines *made = &map->lines[map->line_sets];
  *made = (cdem_map_lines){.title = title, .colour = colour, .width = width, .segments = segments};
  CDEM_NEW(made->xy, 4 * segments, fault);
  map->line_sets++;
  *lines = made;
  return CDEM_OK;
}

/* ---- marks ---- */

cdem_status cdem_map_add_marks(cdem_map *map, cdem_map_mark kind, int64_t count, bool value,
                               bool shade, cdem_map_marks **marks, cdem_fault *fault) {
  int64_t capacity = map->mark_sets;
  CDEM_TRY(cdem_grow(&map->marks, &capacity, map->mark_sets + 1, sizeof *map->marks, fault));
  cdem_map_marks *made = &map->marks[map->mark_sets++]; /* counted at once: released with the map */
  *made = (cdem_map_marks){.kind = kind, .marks = count};
  CDEM_NEW(made->xy, 4 * count, fault);
  CDEM_NEW(made->size, count, fault);
  if (value)
    CDEM_NEW(made->value, count, fault);
  if (shade)
    CDEM_NEW(made->shade, count, fault);
  *marks = made;
  return CDEM_OK;
}

void cdem_map_release(cdem_map *map) {
  for (int i = 0; i < map->mark_sets; i++) {
    free(map->marks[i].xy);
    free(map->marks[i].size);
    free(map->marks[i].value);
    free(map->marks[i].shade);
  }
  free(map->marks);
  for (int i = 0; i < map->line_sets; i++)
    free(map->lines[i].xy);
  free(map->lines);
  free(map->start);
  free(map->xy);
  free(map->value);
  free(map->shade);
  *map = (cdem_map){0};
}
