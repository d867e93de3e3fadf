#include "elements/basis.h"

#include <assert.h>
#include <string.h>

static const cdem_element *const elements[] = {
#define X(identifier) &cdem_element_##identifier,
#include "elements/elements.def"
#undef X
};

const cdem_element *cdem_element_get(cdem_element_id id) {
  assert(id < CDEM_ELEMENT_COUNT);
  return elements[id];
}

const cdem_element *cdem_element_find(const char *name) {
  for (int id = 0; id < CDEM_ELEMENT_COUNT; id++)
    if (strcmp(elements[id]->name, name) == 0)
      return elements[id];
  return NULL;
}

const cdem_element *cdem_element_for(cdem_shape shape, cdem_formulation formulation) {
  for (int id = 0; id < CDEM_ELEMENT_COUNT; id++)
    if (elements[id]->shape == shape && elements[id]->formulation == formulation)
      return elements[id];
  return NULL;
}
