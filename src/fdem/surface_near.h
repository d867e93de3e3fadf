/* Private to fdem: the nearest point of a triangle, and on which side of a surface a place is.
 *
 * Nearest points lie within a triangle, on an edge or at a corner. On which side of a closed
 * surface a place is follows from the normal there; on edges that is the sum of the unit normals of
 * the two triangles, at corners the sum of those around it weighted with their angles (Baerentzen
 * and Aanaes 2005: with any other weights there are corners and places for which it fails). */
#ifndef CDEM_FDEM_SURFACE_NEAR_H
#define CDEM_FDEM_SURFACE_NEAR_H

#include "fdem/surface.h"

typedef enum {
  CDEM_NEAR_CORNER,   /* .. + 2: corner k */
  CDEM_NEAR_EDGE = 3, /* .. + 2: edge from corner k to k + 1 */
  CDEM_NEAR_FACE = 6
} cdem_near_feature;

typedef struct {
  double square; /* of the distance */
  double v, w;   /* weights of the second and third corner */
  int feature;
} cdem_near;

/* Nearest point of the triangle a b c to y. The six regions of the plane are told apart by the dot
 * products of y - a, y - b, y - c with the edges ab and ac; those of b and c differ from those of a
 * by entries of the edges' Gram matrix. A triangle without area gives its edges or a NaN. */
static inline void cdem_near_triangle(const double a[3], const double b[3], const double c[3],
                                      const double y[3], cdem_near *near) {
  double ab[3], ac[3], ay[3];
  double bb = 0.0, bc = 0.0, cc = 0.0, a1 = 0.0, a2 = 0.0;
  for (int k = 0; k < 3; k++) {
    ab[k] = b[k] - a[k];
    ac[k] = c[k] - a[k];
    ay[k] = y[k] - a[k];
    bb += ab[k] * ab[k];
    bc += ab[k] * ac[k];
    cc += ac[k] * ac[k];
    a1 += ab[k] * ay[k];
    a2 += ac[k] * ay[k];
  }
  double b1 = a1 - bb, b2 = a2 - bc, c1 = a1 - bc, c2 = a2 - cc;
  double of_a = b1 * c2 - c1 * b2, of_b = c1 * a2 - a1 * c2, of_c = a1 * b2 - b1 * a2;
  near->v = near->w = 0.0;
  if (a1 <= 0.0 && a2 <= 0.0) {
    near->feature = CDEM_NEAR_CORNER;
  } else if (b1 >= 0.0 && b2 <= b1) {
    near->feature = CDEM_NEAR_CORNER + 1;
    near->v = 1.0;
  } else if (c2 >= 0.0 && c1 <= c2) {
    near->feature = CDEM_NEAR_CORNER + 2;
    near->w = 1.0;
  } else if (of_c <= 0.0 && a1 >= 0.0 && b1 <= 0.0) {
    near->feature = CDEM_NEAR_EDGE;
    near->v = a1 / bb;
  } else if (of_b <= 0.0 && a2 >= 0.0 && c2 <= 0.0) {
    near->feature = CDEM_NEAR_EDGE + 2;
    near->w = a2 / cc;
  } else if (of_a <= 0.0 && b2 >= b1 && c1 >= c2) {
    near->feature = CDEM_NEAR_EDGE + 1;
    near->w = (b2 - b1) / ((b2 - b1) + (c1 - c2));
    near->v = 1.0 - near->w;
  } else {
    double sum = of_a + of_b + of_c;
    near->feature = CDEM_NEAR_FACE;
    near->v = of_b / sum;
    near->w = of_c / sum;
  }
  near->square = 0.0;
  for (int k = 0; k < 3; k++) {
    double r = ay[k] - near->v * ab[k] - near->w * ac[k];
    near->square += r * r;
  }
}

/* Distance of y above (outside: > 0) or below the surface with these places, by what a search of
 * the nearest triangle t found; for a face the distance to its plane. */
double cdem_near_side(const cdem_skin *surface, const double *place, int32_t t,
                      const cdem_near *near, const double y[3]);

/* surface_grid.c: fills the grid of a surface that is otherwise complete. */
cdem_status cdem_skin_grid(cdem_skin *surface, cdem_fault *fault);

#endif
