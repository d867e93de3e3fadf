/* Frames: a data set at one instant, on its way from a solver to a file or a picture.
 *
 * A frame borrows everything; the sink must be done with it when it returns. One data set ("body",
 * "interfaces", "contacts", "grains") is a series of frames with the same fields; io makes one .pvd
 * of each. Cell types are VTK's numbers, and so is the order of a cell's nodes: 1 vertex, 3 line, 5
 * triangle, 9 quadrilateral, 10 tetrahedron, 12 hexahedron, 13 wedge, 14 pyramid (first-order cells
 * of gmsh have the same order).
 */
#ifndef CDEM_RESULTS_FRAME_H
#define CDEM_RESULTS_FRAME_H

#include "base/base.h"

#include <stdbool.h>

typedef enum { CDEM_FIELD_REAL, CDEM_FIELD_INT32, CDEM_FIELD_UINT8 } cdem_field_type;

typedef struct {
  const char *name; /* "displacement" */
  const char *unit; /* "m"; "" for none; goes into the file as a comment attribute */
  bool on_cells;    /* else on points */
  int components;   /* 1; 3 vector; 6 symmetric tensor in VTK's order xx yy zz xy yz xz */
  cdem_field_type type;
  const void *data;         /* [points or cells][components] */
  int states;               /* of an integer field of states: */
  const char *const *state; /* [states] their names, written into the file; NULL for none */
} cdem_field;

typedef struct {
  const char *set; /* data set: "body" */
  int64_t index;   /* of the frame in its run, from 0 */
  double time;     /* s */
  int64_t points;
  const double *xyz; /* [points][3] current positions, m */
  int64_t cells;
  const uint8_t *type;   /* [cells] VTK cell type */
  const int64_t *offset; /* [cells + 1] into node */
  const int32_t *node;   /* [offset[cells]] point ids */
  int fields;
  const cdem_field *field;
} cdem_frame;

/* Where frames go. */
typedef struct {
  void *context;
  cdem_status (*frame)(void *context, const cdem_frame *frame, cdem_fault *fault);
} cdem_frame_sink;

#endif
