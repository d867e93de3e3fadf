/* Surface of a grain shape: the skin of its mesh as nodes and triangles, and the point of it that is
 * nearest to a place.
 *
 * Surface nodes come first in a template's node order, so that one number serves the surface and
 * the whole. Faces of the mesh are cut into triangles: linear triangles stay, six-node triangles
 * become four, quadrilaterals two (by the shorter diagonal of the reference shape); counter-
 * clockwise seen from outside. Coordinates of the reference are those of a template: dimensionless,
 * of a body whose volume is that of the unit ball.
 *
 * Tributary areas are lumped geometrically, a third of each triangle to each of its nodes (the
 * consistent rule gives corners of quadratic faces nothing); they are of the reference.
 *
 * A place is looked for in a uniform grid over the reference: each cell names the triangles that may
 * hold the nearest point of anything in it, with room for the deformation: `margin`. So any closed
 * surface will do, convex or not.
 */
#ifndef CDEM_FDEM_SURFACE_H
#define CDEM_FDEM_SURFACE_H

#include "base/base.h"
#include "mesh/mesh.h"

#include <stdbool.h>

typedef struct {
  int32_t nodes, triangles;
  double *reference;    /* [nodes][3] */
  int32_t *triangle;    /* [triangles][3] nodes, counter-clockwise seen from outside */
  double *area;         /* [nodes] tributary, of the reference */
  double volume, total; /* enclosed volume and area of the reference */
  double reach, least;  /* largest and smallest distance of the surface from the origin */
  double margin;        /* deformation the grid has room for, in units of the reference */
  /* the grid: triangles of cell c are item[start[c]] .. item[start[c + 1] - 1] */
  int32_t cells[3];
  double low[3], cell;
  int64_t *start;
  int32_t *item;
} cdem_surface;

/* The skin of the volume cells of a mesh whose first `nodes` nodes are the surface nodes. CDEM_INPUT:
 * the skin is not closed, or a triangle has no area. */
cdem_status cdem_surface_build(const cdem_mesh *mesh, int32_t nodes, double margin,
                               cdem_surface *surface, cdem_fault *fault);
void cdem_surface_release(cdem_surface *surface);

/* Where a place touches a surface: `depth` below it, m, > 0 inside. */
typedef struct {
  double depth;
  double normal[3]; /* outwards, unit: along it `depth` shrinks fastest. Frame of the body */
  int32_t node[3];  /* of the triangle that holds the nearest point */
  double weight[3]; /* its barycentric coordinates, >= 0 */
} cdem_surface_touch;

/* Is y inside the deformed surface? y [3] and place [nodes][3] in the frame of the body, m; scale: m
 * a unit of the reference. The depth is the distance to the nearest point of the surface, hence the
 * gradient of depth by y is -normal and by the three nodes +weight normal: a penalty on it is
 * conservative. */
bool cdem_surface_touches(const cdem_surface *surface, const double *place, double scale,
                          const double y[3], cdem_surface_touch *touch);

#endif
