/* The periodic cell: images, wrapping, deformation, choice of edges. */
#include "dem/cell.h"

#include <math.h>
#include <string.h>

static const char axis_name[3] = {'x', 'y', 'z'};

bool cdem_cell_is_periodic(const cdem_cell *cell) {
  return cell->periodic[0] || cell->periodic[1] || cell->periodic[2];
}

/* Edges, with unit vectors where a direction is free. */
static void full_edges(const cdem_cell *cell, double h[9]) {
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++)
      h[3 * r + c] = cell->periodic[c] ? cell->h[3 * r + c] : r == c ? 1.0 : 0.0;
}

static double edge_dot(const double h[9], int a, int b) {
  return h[a] * h[b] + h[3 + a] * h[3 + b] + h[6 + a] * h[6 + b];
}

static bool is_zero(const cdem_series *series) {
  return series->kind == CDEM_SERIES_TABLE && series->points == 0;
}

static cdem_status check_edges(const cdem_cell *cell, cdem_fault *fault) {
  for (int c = 0; c < 3; c++) {
    if (!cell->periodic[c])
      continue;
    const double *h = cell->h;
    double edge[3] = {h[c], h[3 + c], h[6 + c]}, length = cdem_norm3(edge);
    CDEM_REQUIRE(isfinite(length) && length > 0.0, fault, CDEM_INPUT,
                 "cell: edge %c has the length %g m; give each periodic direction an edge",
                 axis_name[c], length);
    for (int r = 0; r < 3; r++)
      CDEM_REQUIRE(cell->periodic[r] || edge[r] == 0.0, fault, CDEM_INPUT,
                   "cell: edge %c has a component of %g m along %c, which is not periodic; make "
                   "it 0 or make %c periodic",
                   axis_name[c], edge[r], axis_name[r], axis_name[r]);
    CDEM_REQUIRE(isfinite(cell->corner[c]), fault, CDEM_INPUT,
                 "cell: its corner has %c = %g m; give a number", axis_name[c], cell->corner[c]);
  }
  double h[9], product = 1.0;
  full_edges(cell, h);
  for (int c = 0; c < 3; c++)
    product *= sqrt(edge_dot(h, c, c));
  double part = cdem_det3(h) / product;
  /* A part of 1e-6: the cell is a million times longer than wide. */
  CDEM_REQUIRE(part > 1e-6, fault, CDEM_INPUT,
               "cell: its edges span only %g of the volume that edges at right angles would; give "
               "edges that are not parallel, in right-handed order",
               part);
  return CDEM_OK;
}

static cdem_status check_servo(const cdem_cell *cell, cdem_fault *fault) {
  for (int c = 0; c < 3; c++) {
    if (!cell->servo[c])
      continue;
    CDEM_REQUIRE(cell->periodic[c], fault, CDEM_INPUT,
                 "cell: a stress is wanted along %c, which is not periodic; make it periodic, or "
                 "use a wall",
                 axis_name[c]);
    CDEM_REQUIRE(is_zero(&cell->rate[4 * c]), fault, CDEM_INPUT,
                 "cell: both a rate and a stress are given along %c; give one of them",
                 axis_name[c]);
    CDEM_REQUIRE(cell->servo_rate > 0.0 && isfinite(cell->servo_rate), fault, CDEM_INPUT,
                 "cell: the largest rate of the servo is %g 1/s; give a positive number",
                 cell->servo_rate);
    CDEM_REQUIRE(cell->servo_gain >= 0.0 && isfinite(cell->servo_gain), fault, CDEM_INPUT,
                 "cell: the gain of the servo is %g; give a positive number, or 0 for 0.25",
                 cell->servo_gain);
  }
  return CDEM_OK;
}

cdem_status cdem_cell_check(int dim, const cdem_cell *cell, cdem_fault *fault) {
  CDEM_REQUIRE(dim == 3 || !cell->periodic[2], fault, CDEM_INPUT,
               "cell: a plane model cannot be periodic along z; use x and y");
  CDEM_TRY(check_edges(cell, fault));
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      int at = 3 * r + c;
      CDEM_REQUIRE(is_zero(&cell->rate[at]) || (cell->periodic[r] && cell->periodic[c]), fault,
                   CDEM_INPUT,
                   "cell: rate %c%c crosses direction %c, which is not periodic; leave it out",
                   axis_name[r], axis_name[c], cell->periodic[r] ? axis_name[c] : axis_name[r]);
    }
  return check_servo(cell, fault);
}

double cdem_cell_volume(int dim, const cdem_cell *cell) {
  if (!cell->periodic[0] || !cell->periodic[1] || (dim == 3 && !cell->periodic[2]))
    return 0.0;
  double h[9];
  full_edges(cell, h);
  return cdem_det3(h);
}

void cdem_cell_inverse(const cdem_cell *cell, double inverse[9]) {
  double h[9];
  full_edges(cell, h);
  cdem_inverse3(h, inverse);
}

/* A row of the inverse is perpendicular to a face and as long as 1/width. */
void cdem_cell_widths(const cdem_cell *cell, double width[3]) {
  double inverse[9];
  cdem_cell_inverse(cell, inverse);
  for (int c = 0; c < 3; c++)
    width[c] = cell->periodic[c] ? 1.0 / cdem_norm3(inverse + 3 * c) : INFINITY;
}

/* All combinations of three vectors, the columns of m. */
static void combine(const cdem_cell *cell, const double m[9], double vector[27][3]) {
  for (int code = 0; code < 27; code++) {
    int edges[3];
    cdem_image_edges(code, edges);
    for (int r = 0; r < 3; r++) {
      double sum = 0.0;
      for (int c = 0; c < 3; c++)
        if (cell->periodic[c])
          sum += edges[c] * m[3 * r + c];
      vector[code][r] = sum;
    }
  }
}

void cdem_cell_images(const cdem_cell *cell, double shift[27][3]) {
  combine(cell, cell->h, shift);
}

/* (h(t + step) - h(t))/step for dh/dt = L h, to second order: L (h + step/2 L h). */
static void edge_velocities(const cdem_cell *cell, const double l[9], double step,
                            double velocity[9]) {
  double first[9], middle[9];
  cdem_product3(l, cell->h, first);
  for (int k = 0; k < 9; k++)
    middle[k] = cell->h[k] + 0.5 * step * first[k];
  cdem_product3(l, middle, velocity);
}

void cdem_cell_advance(cdem_cell *cell, const double l[9], double step) {
  double velocity[9];
  edge_velocities(cell, l, step, velocity);
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++)
      if (cell->periodic[c])
        cell->h[3 * r + c] += step * velocity[3 * r + c];
}

void cdem_cell_wrap_turns(const cdem_cell *cell, double place[3], double turns[3]) {
  double inverse[9], from[3];
  cdem_cell_inverse(cell, inverse);
  for (int c = 0; c < 3; c++)
    from[c] = place[c] - cell->corner[c];
  for (int c = 0; c < 3; c++)
    turns[c] = cell->periodic[c] ? 0.0 - floor(cdem_dot3(inverse + 3 * c, from)) : 0.0;
  for (int r = 0; r < 3; r++) {
    double sum = 0.0;
    for (int c = 0; c < 3; c++)
      if (turns[c] != 0.0)
        sum += turns[c] * cell->h[3 * r + c];
    if (sum != 0.0)
      place[r] += sum;
  }
}

int cdem_cell_wrap(const cdem_cell *cell, double place[3]) {
  double turns[3];
  cdem_cell_wrap_turns(cell, place, turns);
  int edges[3];
  for (int c = 0; c < 3; c++)
    edges[c] = turns[c] > 0.0 ? 1 : turns[c] < 0.0 ? -1 : 0;
  return cdem_image_code(edges);
}

/* Pairs of edges are reduced as Lagrange did it (Gauss reduction) until none gets shorter: each
 * change shortens an edge, and a lattice has finitely many vectors shorter than a given one. Edges
 * that lean a little more than half are left, so that rounding does not turn one to and fro. */
bool cdem_cell_flip(cdem_cell *cell, int turns[9]) {
  static const double lean = 0.5 + 0x1.0p-10;
  memset(turns, 0, 9 * sizeof *turns);
  turns[0] = turns[4] = turns[8] = 1;
  bool any = false;
  for (bool again = true; again;) {
    again = false;
    for (int c = 0; c < 3; c++)
      for (int d = 0; d < 3; d++) {
        if (c == d || !cell->periodic[c] || !cell->periodic[d])
          continue;
        double part = edge_dot(cell->h, c, d) / edge_dot(cell->h, d, d);
        if (!(fabs(part) > lean) || fabs(part) > 1e9)
          continue;
        double whole = round(part);
        for (int r = 0; r < 3; r++) {
          cell->h[3 * r + c] -= whole * cell->h[3 * r + d];
          turns[3 * d + r] += (int)whole * turns[3 * c + r];
        }
        again = any = true;
      }
  }
  return any;
}

/* In a reduced lattice the nearest image is within one edge of the rounded one. */
void cdem_cell_nearest(const cdem_cell *cell, double difference[3]) {
  if (!cdem_cell_is_periodic(cell))
    return;
  cdem_cell short_cell = *cell;
  int turns[9];
  cdem_cell_flip(&short_cell, turns);
  double inverse[9], shift[27][3], part[3], base[3];
  cdem_cell_inverse(&short_cell, inverse);
  cdem_cell_images(&short_cell, shift);
  for (int c = 0; c < 3; c++)
    part[c] = cell->periodic[c] ? -round(cdem_dot3(inverse + 3 * c, difference)) : 0.0;
  for (int r = 0; r < 3; r++) {
    base[r] = difference[r];
    for (int c = 0; c < 3; c++)
      if (part[c] != 0.0)
        base[r] += part[c] * short_cell.h[3 * r + c];
  }
  memcpy(difference, base, sizeof base);
  double least = cdem_dot3(base, base);
  for (int code = 0; code < 27; code++) {
    double image[3];
    for (int r = 0; r < 3; r++)
      image[r] = base[r] + shift[code][r];
    double square = cdem_dot3(image, image);
    if (square < least) {
      least = square;
      memcpy(difference, image, sizeof image);
    }
  }
}
