#include "results/frame_draft.h"

#include <stdlib.h>

void *cdem_frame_draft_take(cdem_frame_draft *draft, int64_t count, size_t size) {
  void *made = draft->failed ? NULL : cdem_allocate(count, size, draft->fault);
  if (made == NULL)
    draft->failed = true;
  else
    draft->array[draft->arrays++] = made;
  return made;
}

cdem_field *cdem_frame_draft_add(cdem_frame_draft *draft, const char *name, const char *unit,
                                 bool on_cells, int components, cdem_field_type type,
                                 const void *data) {
  cdem_field *field = &draft->field[draft->fields++];
  *field = (cdem_field){.name = name,
                        .unit = unit,
                        .on_cells = on_cells,
                        .components = components,
                        .type = type,
                        .data = data};
  return field;
}

cdem_status cdem_frame_draft_send(cdem_frame_draft *draft, cdem_frame *frame,
                                  const cdem_frame_sink *sink) {
  frame->fields = draft->fields;
  frame->field = draft->field;
  cdem_status status =
      draft->failed ? CDEM_MEMORY : sink->frame(sink->context, frame, draft->fault);
  for (int i = 0; i < draft->arrays; i++)
    free(draft->array[i]);
  *draft = (cdem_frame_draft){.fault = draft->fault};
  return status;
}
