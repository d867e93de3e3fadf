/* Inside room bsm: a face of a cell as a flat frame. Not for other rooms. */
#ifndef CDEM_BSM_FACE_H
#define CDEM_BSM_FACE_H

#include "base/mat3.h"
#include "mesh/mesh.h"

#include <stdbool.h>
#include <string.h>

/* Origin (the first corner), unit tangent along the first edge, unit normal (outward for nodes in
 * outward order), length of the first edge. */
typedef struct {
  int dim, corners;
  double x[4][3], tangent[3], normal[3], length;
} cdem_bsm_frame;

/* node [corners]: 2 in a plane, else 3 or 4, in order around the face. The normal of a
 * quadrilateral that is not flat is that of its diagonals. */
static inline void cdem_bsm_frame_of(const cdem_mesh *mesh, int corners, const int32_t *node,
                                     cdem_bsm_frame *f) {
  double e[3], g[3], h[3];
  *f = (cdem_bsm_frame){.dim = corners == 2 ? 2 : 3, .corners = corners};
  for (int i = 0; i < corners; i++)
    memcpy(f->x[i], mesh->xyz + 3 * (int64_t)node[i], sizeof f->x[i]);
  for (int c = 0; c < 3; c++) {
    e[c] = f->x[1][c] - f->x[0][c];
    g[c] = f->x[corners == 4 ? 2 : 1][c] - f->x[0][c];
    h[c] = f->x[corners - 1][c] - f->x[corners == 4 ? 1 : 0][c];
  }
  f->length = cdem_norm3(e);
  for (int c = 0; c < 3; c++)
    f->tangent[c] = e[c] / f->length;
  if (f->dim == 2) { /* interior on the left: outward is to the right */
    f->normal[0] = f->tangent[1];
    f->normal[1] = -f->tangent[0];
    f->normal[2] = 0.0;
    return;
  }
  cdem_cross3(g, h, f->normal);
  double size = cdem_norm3(f->normal);
  for (int c = 0; c < 3; c++)
    f->normal[c] /= size;
}

/* Is the foot of a point on the face, or beside it by less than `margin`? */
static inline bool cdem_bsm_on_face(const cdem_bsm_frame *f, const double x[3], double margin) {
  double way[3];
  for (int c = 0; c < 3; c++)
    way[c] = x[c] - f->x[0][c];
  if (f->dim == 2) {
    double s = cdem_dot3(way, f->tangent);
    return s >= -margin && s <= f->length + margin;
  }
  for (int i = 0; i < f->corners; i++) {
    double edge[3], out[3], from[3];
    for (int c = 0; c < 3; c++) {
      edge[c] = f->x[(i + 1) % f->corners][c] - f->x[i][c];
      from[c] = x[c] - f->x[i][c];
    }
    cdem_cross3(edge, f->normal, out);
    if (cdem_dot3(out, from) > margin * cdem_norm3(out))
      return false;
  }
  return true;
}

/* Length (2-D) or area; of a quadrilateral that of its projection along the normal. */
static inline double cdem_bsm_face_size(const cdem_bsm_frame *f) {
  double g[3], h[3], cross[3];
  if (f->dim == 2)
    return f->length;
  for (int c = 0; c < 3; c++) {
    g[c] = f->x[f->corners == 4 ? 2 : 1][c] - f->x[0][c];
    h[c] = f->x[f->corners - 1][c] - f->x[f->corners == 4 ? 1 : 0][c];
  }
  cdem_cross3(g, h, cross);
  return 0.5 * cdem_norm3(cross);
}

#endif
