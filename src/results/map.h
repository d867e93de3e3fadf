/* Maps: bodies seen from one side, coloured by a field, with lines drawn over them (cracks, joints,
 * walls). Plain polygons in the plane of the picture, to be drawn by io in their order; over them
 * marks: discs, strokes of any width, arrows. */
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

/* Marks of one kind, drawn in their order. Where a mark has a value it has the colour of the map's
 * bar, else `colour`. */
typedef enum {
  CDEM_MAP_DISCS,   /* centre x y in the first two of xy, size: radius */
  CDEM_MAP_STROKES, /* from x y to x y with square ends, size: width */
  CDEM_MAP_ARROWS   /* from x y to x y, the tip; size: width of the shaft */
} cdem_map_mark;

typedef struct {
  cdem_map_mark kind;
  int64_t marks;
  double *xy;         /* [marks][4] m */
  double *size;       /* [marks] m */
  double *value;      /* [marks], NaN: `colour`; NULL: all `colour` */
  double *shade;      /* [marks] brightness 0..1; NULL: 1 */
  const char *colour; /* "#cccccc", borrowed; NULL: grey */
  bool rims;          /* discs: darker at the edge, where they are large enough to show it */
} cdem_map_marks;

typedef struct {
  const char *title;
  const char *x_label, *y_label; /* x_label NULL: no axes but a scale bar, as for a 3-D view */
  const char *value_label;       /* of the colour bar; NULL: no colours, grey bodies */
  double value_min, value_max;   /* equal: automatic */
  bool diverging;                /* colours around zero */
  bool reversed;                 /* dark is much: for marks on a light ground */
  bool outlines;                 /* draw the polygons' edges */
  int64_t polygons;
  int64_t *start; /* [polygons + 1] into xy */
  double *xy;     /* [start[polygons]][2] m */
  double *value;  /* [polygons]; NaN: grey */
  double *shade;  /* [polygons] brightness 0..1 of the colour; NULL: 1 */
  int line_sets;
  cdem_map_lines *lines; /* [line_sets] */
  int mark_sets;
  cdem_map_marks *marks; /* [mark_sets], over the polygons, below the lines */
  double page;           /* size of the axes on the page, in usual sizes; 0: 1 */
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
/* Adds a set of `count` marks with zeroed arrays, to be filled by the caller. value, shade: with
 * these arrays. */
cdem_status cdem_map_add_marks(cdem_map *map, cdem_map_mark kind, int64_t count, bool value,
                               bool shade, cdem_map_marks **marks, cdem_fault *fault);
/* Adds a set of `segments` zeroed lines. The texts are borrowed. */
cdem_status cdem_map_add_segments(cdem_map *map, int64_t segments, const char *title,
                                  const char *colour, double width, cdem_map_lines **lines,
                                  cdem_fault *fault);
void cdem_map_release(cdem_map *map);

#endif
