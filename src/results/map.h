/* Maps: bodies seen from one side, coloured by a field, with lines drawn over them (cracks, joints,
 * force chains). Plain polygons in the plane of the picture, to be drawn by io in their order. */
#ifndef CDEM_RESULTS_MAP_H
#define CDEM_RESULTS_MAP_H

#include "results/frame.h"

typedef struct {
  const char *title;  /* legend entry; NULL: none */
  const char *colour; /* "#b2182b" */
  double width;       /* points */
  int64_t segments;
  double *xy; /* [segments][4] */
} cdem_map_lines;

typedef struct {
  const char *title;
  const char *x_label, *y_label; /* x_label NULL: no axes but a scale bar, as for a 3-D view */
  const char *value_label;       /* of the colour bar; NULL: no colours, grey bodies */
  double value_min, value_max;   /* equal: automatic */
  bool diverging;                /* colours around zero */
  bool outlines;                 /* draw the polygons' edges */
  int64_t polygons;
  int64_t *start; /* [polygons + 1] into xy */
  double *xy;     /* [start[polygons]][2] m */
  double *value;  /* [polygons]; NaN: grey */
  double *shade;  /* [polygons] brightness 0..1 of the colour; NULL: 1 */
  int line_sets;
  cdem_map_lines *lines; /* [line_sets] */
} cdem_map;

/* The body of a frame as seen along `view` (from the eye into the picture; 2-D: {0, 0, -1}), up
 * direction `up`; neither need be a unit vector or normal to the other. Plane cells are drawn as
 * they are; of 3-D cells the outer faces (those of one cell) that face the eye, painted so that
 * each covers what is behind it, and shaded by their slope. Lines and vertices are not drawn.
 * field: name of a field of the frame (NULL: grey), component: its index, -1: its size (of a
 * vector; of a tensor: von Mises; of a scalar: itself), -2: its largest, -3: its least principal
 * value. Fields of points are averaged over a cell. magnify: factor on the field "displacement" (0
 * or 1: as it is). Only the polygons of *map are filled in here, the rest is zeroed. */
cdem_status cdem_map_from_frame(const cdem_frame *frame, const char *field, int component,
                                const double view[3], const double up[3], double magnify,
                                cdem_map *map, cdem_fault *fault);
/* Adds the edges of those cells of a frame whose integer cell field `field` (NULL: of all cells) is
 * one of the bits of `mask` (1 << value), seen as above: lines themselves, and the outlines of
 * faces and solids. Nothing is hidden by the bodies. The texts are borrowed. */
cdem_status cdem_map_add_lines(cdem_map *map, const cdem_frame *frame, const char *field,
                               unsigned mask, const double view[3], const double up[3],
                               const char *title, const char *colour, double width,
                               cdem_fault *fault);
void cdem_map_release(cdem_map *map);

#endif
