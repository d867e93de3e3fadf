/* A frame in the making: fields and their arrays, which are released together once it is sent.
 *
 * Arrays are taken one after the other without looking at each: after the first failure every
 * further one is NULL, and sending reports it. Zero-initialise with the fault.
 */
#ifndef CDEM_RESULTS_FRAME_DRAFT_H
#define CDEM_RESULTS_FRAME_DRAFT_H

#include "results/frame.h"

enum { CDEM_DRAFT_ARRAYS = 24, CDEM_DRAFT_FIELDS = 20 };

typedef struct {
  void *array[CDEM_DRAFT_ARRAYS];
  int arrays;
  cdem_field field[CDEM_DRAFT_FIELDS];
  int fields;
  bool failed;
  cdem_fault *fault;
} cdem_frame_draft;

/* A zeroed array that lives until the frame is sent; NULL after a failure. */
void *cdem_frame_draft_take(cdem_frame_draft *draft, int64_t count, size_t size);
/* A field without states; the caller may set them. */
cdem_field *cdem_frame_draft_add(cdem_frame_draft *draft, const char *name, const char *unit,
                                 bool on_cells, int components, cdem_field_type type,
                                 const void *data);
/* Hands the frame out with the fields of the draft, and empties the draft for the next one;
 * CDEM_MEMORY when an array failed. Set, index and time are the frame's. */
cdem_status cdem_frame_draft_send(cdem_frame_draft *draft, cdem_frame *frame,
                                  const cdem_frame_sink *sink);

#endif
