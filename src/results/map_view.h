/* Private to results: how a map looks at a frame. */
#ifndef CDEM_RESULTS_MAP_VIEW_H
#define CDEM_RESULTS_MAP_VIEW_H

#include "results/map.h"

/* Unit vectors; right = into x up. */
typedef struct {
  double right[3], up[3], into[3];
} cdem_map_view;

/* CDEM_USAGE when `into` and `up` are parallel or zero. */
cdem_status cdem_map_view_init(const double into[3], const double up[3], cdem_map_view *view,
                               cdem_fault *fault);

/* The field of that name, or NULL. */
const cdem_field *cdem_frame_find_field(const cdem_frame *frame, const char *name);
/* One number of a field. */
double cdem_field_at(const cdem_field *field, int64_t index);

/* Faces and edges of a VTK cell type: local nodes, -1 behind the last. Unknown types have none. */
typedef struct {
  int dimension, faces, edges;
  int8_t face[6][4]; /* in no particular orientation */
  int8_t edge[12][2];
} cdem_vtk_cell;

const cdem_vtk_cell *cdem_vtk_cell_get(uint8_t type);

/* A face to be drawn. */
typedef struct {
  int64_t cell;
  int corners;
  int32_t node[4];
} cdem_map_face;

/* The plane cells of a frame, and the faces of its 3-D cells that belong to one cell; in the order
 * of the frame. *face is newly allocated. */
cdem_status cdem_map_outer_faces(const cdem_frame *frame, int64_t *faces, cdem_map_face **face,
                                 cdem_fault *fault);

/* A face as it is seen. */
typedef struct {
  int corners;
  double xy[4][2], low[2], high[2];
  double plane[3]; /* depth = plane[0] + plane[1] x + plane[2] y */
} cdem_map_flat;

/* order [faces]: in which the faces are painted. They come from back to front as far as their
 * middle tells; what overlaps is put right. */
cdem_status cdem_map_order(int64_t faces, const cdem_map_flat *face, int32_t *order,
                           cdem_fault *fault);

#endif
