#include "fdem/template.h"

#include <string.h>

#define X(name) extern const cdem_grain_shape cdem_grain_shape_##name;
#include "fdem/shapes.def"
#undef X

static const cdem_grain_shape *const table[] = {
#define X(name) &cdem_grain_shape_##name,
#include "fdem/shapes.def"
#undef X
};
enum { SHAPES = sizeof table / sizeof table[0] };

const cdem_grain_shape *cdem_grain_shape_at(int index) {
  return index >= 0 && index < SHAPES ? table[index] : NULL;
}

const cdem_grain_shape *cdem_grain_shape_find(const char *name) {
  for (int i = 0; i < SHAPES; i++)
    if (strcmp(name, table[i]->name) == 0)
      return table[i];
  return NULL;
}
