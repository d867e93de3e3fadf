/* Surface of a grain shape: the skin of its mesh as nodes and triangles, and the point of it that
 * is nearest to a place.
 *
 * Surface nodes come first in a template's node order, so that one number serves the surface and
 * the whole. Faces of the mesh are cut into triangles: linear triangles stay, six-node triangles
 * become four, quadrilaterals two (by the shorter diagonal of the reference shape), eight-node
 * quadrilaterals six (a triangle a corner, two in the middle); counter-clockwise seen from outside.
 * Coordinates of the reference are those of a template: dimensionless, of a body whose volume is
 * that of the unit ball.
 *
 * Tributary areas are lumped geometrically, a third of each triangle to each of its nodes (the
 * consistent rule gives corners of quadratic faces nothing); they are of the reference.
 *
 * A place is looked for in a uniform grid over the reference: each cell names the triangles that
 * may hold the nearest point of anything in it, with room for the deformation: `margin`. So any
 * closed surface will do, convex or not. surface_grid.c says why no triangle is missed.
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
  int32_t *beside;      /* [triangles][3] the triangle across the edge from corner k to k + 1 */
  int32_t *around_from; /* [nodes + 1] triangles at node n are around[around_from[n]] ... */
  int32_t *around;      /* [3 triangles] */
  double *area;         /* [nodes] tributary, of the reference */
  double volume, total; /* enclosed volume and area of the reference */
  double reach, least;  /* largest and smallest distance of the surface from the origin */
  double margin;        /* deformation the grid has room for, in units of the reference */
  /* the grid, a cube of cells^3: cell (i, j, k), at (i cells + j) cells + k, has the triangles
   * item[start[l]] .. item[start[l + 1] - 1] of list l = list[cell]; list 0 is empty: nothing of
   * that cell can be inside */
  int32_t cells, lists;
  double low[3], cell;
  int32_t *list;  /* [cells^3] */
  int64_t *start; /* [lists + 1] */
  int32_t *item;
} cdem_skin;

/* The skin of the volume cells of a mesh whose first `nodes` nodes are the surface nodes.
 * CDEM_INPUT: no volume cells, other nodes on the surface, a skin that is not closed or touches
 * itself, a triangle without area, cells inside out. *surface is overwritten, empty after a
 * failure. */
cdem_status cdem_skin_build(const cdem_mesh *mesh, int32_t nodes, double margin, cdem_skin *surface,
                            cdem_fault *fault);
void cdem_skin_release(cdem_skin *surface);

/* Where a place touches a surface: `depth` below it, m, > 0 inside. */
typedef struct {
  double depth;
  double normal[3]; /* outwards, unit: along it `depth` shrinks fastest. Frame of the body */
  int32_t node[3];  /* of the triangle that holds the nearest point */
  double weight[3]; /* its barycentric coordinates, >= 0, of sum 1 */
} cdem_skin_touch;

/* Is y inside the deformed surface? y [3] and place [nodes][3] in the frame of the body, m; scale:
 * m a unit of the reference. Exact as long as no node is further than margin * scale from its place
 * in the reference; beyond that a triangle further away may be taken for the nearest.
 *
 * The depth is the distance to the nearest point of the surface, hence the gradient of depth by y
 * is -normal and by the three nodes +weight normal: a penalty on it is conservative. It is
 * continuous; the normal jumps where two points are equally near. */
bool cdem_skin_touches(const cdem_skin *surface, const double *place, double scale,
                       const double y[3], cdem_skin_touch *touch);

#endif
