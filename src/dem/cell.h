/* The cell: the box in which a model is periodic, and how it deforms.
 *
 * Columns of h are the edges of the cell (2-D: the third is unused); directions that are not
 * periodic have no edge and are free. The cell deforms with a velocity gradient L, dh/dt = L h,
 * where L is given as a function of time or, component by component, found by a servo from the
 * stress that is wanted. Velocities of grains are the full ones (mean flow included): a grain that
 * leaves through one side comes back with the velocity L (shift) added. An image is a code 0..26,
 * (a + 1) + 3 (b + 1) + 9 (c + 1) for shifts a, b, c of one edge; 13 is the grain itself.
 *
 * Edges of periodic directions have no component in a free direction, and L does not cross them:
 * then free directions stay free, and the cell stays what it was in them.
 *
 * A cell that shears on and on becomes long and thin although its lattice of images does not. So
 * its edges are chosen anew now and then (cdem_cell_flip): whole edges are added to others until
 * no edge leans more than half of another one. The lattice, and with it every force, stays as it
 * was; only the names of images change.
 */
#ifndef CDEM_DEM_CELL_H
#define CDEM_DEM_CELL_H

#include "base/base.h"
#include "base/series.h"

#include <stdbool.h>

enum { CDEM_IMAGE_SELF = 13 };

typedef struct {
  bool periodic[3];
  double corner[3];    /* of the cell, m; stays */
  double h[9];         /* row-major, h[3 r + c]: component r of edge c, m */
  cdem_series rate[9]; /* L, row-major, 1/s; points 0: zero. Borrowed */
  /* Components (diagonal) whose rate a servo finds: stress(t), Pa, positive in compression. */
  bool servo[3];
  cdem_series stress[3];
  double servo_rate; /* 1/s, the largest; > 0 with a servo */
  double servo_gain; /* 0: 0.25 */
} cdem_cell;

/* CDEM_INPUT: an edge that is too short or parallel to another, a rate across a free direction. */
cdem_status cdem_cell_check(int dim, const cdem_cell *cell, cdem_fault *fault);
bool cdem_cell_is_periodic(const cdem_cell *cell);
/* Volume (2-D: area) of the cell; only with all directions periodic, else 0. */
double cdem_cell_volume(int dim, const cdem_cell *cell);
/* Distance of the two faces across each edge (perpendicular to them), m; free: infinity. */
void cdem_cell_widths(const cdem_cell *cell, double width[3]);
/* Shift vectors of all image codes, for the cell as it is: shift [27][3]; free directions: 0. */
void cdem_cell_images(const cdem_cell *cell, double shift[27][3]);
/* Rows of the matrix that gives places in the cell as parts of its edges, 0 .. 1 inside; free
 * directions: rows of the identity. */
void cdem_cell_inverse(const cdem_cell *cell, double inverse[9]);
/* Brings a place into the cell; image code that took it there (CDEM_IMAGE_SELF: none). A place
 * further out than one edge gets the code of one edge; `wrap_turns` gives whole numbers of edges.
 */
int cdem_cell_wrap(const cdem_cell *cell, double place[3]);
void cdem_cell_wrap_turns(const cdem_cell *cell, double place[3], double turns[3]);
/* The nearest image of a difference vector. */
void cdem_cell_nearest(const cdem_cell *cell, double difference[3]);
/* h moves by one step with L (the exact exponential is not needed: h += dt L h at mid step). */
void cdem_cell_advance(cdem_cell *cell, const double l[9], double step);
/* Chooses shorter edges of the same lattice where one leans more than half of another. What was
 * n edges before is turns n (row-major) edges after. Returns whether anything changed. */
bool cdem_cell_flip(cdem_cell *cell, int turns[9]);

/* Whole edges of an image code, and back. */
static inline void cdem_image_edges(int code, int edges[3]) {
  edges[0] = code % 3 - 1;
  edges[1] = code / 3 % 3 - 1;
  edges[2] = code / 9 - 1;
}
static inline int cdem_image_code(const int edges[3]) {
  return edges[0] + 1 + 3 * (edges[1] + 1) + 9 * (edges[2] + 1);
}

#endif
