/* Private to io: the columns of a table of grains, in the order in which they are written. */
#ifndef CDEM_IO_GRAINS_COLUMNS_H
#define CDEM_IO_GRAINS_COLUMNS_H

#include "base/base.h"

#include <stdbool.h>

/* X(name, unit, exponent of length, of time) */
#define CDEM_GRAIN_COLUMN_LIST                                                                     \
  X(x, "m", 1, 0)                                                                                  \
  X(y, "m", 1, 0)                                                                                  \
  X(z, "m", 1, 0)                                                                                  \
  X(radius, "m", 1, 0)                                                                             \
  X(material, "", 0, 0)                                                                            \
  X(motion, "", 0, 0)                                                                              \
  X(vx, "m/s", 1, -1)                                                                              \
  X(vy, "m/s", 1, -1)                                                                              \
  X(vz, "m/s", 1, -1)                                                                              \
  X(wx, "rad/s", 0, -1)                                                                            \
  X(wy, "rad/s", 0, -1)                                                                            \
  X(wz, "rad/s", 0, -1)

enum {
#define X(name, unit, length, time) CDEM_GRAIN_##name,
  CDEM_GRAIN_COLUMN_LIST
#undef X
      CDEM_GRAIN_COLUMNS
};

typedef struct {
  const char *name, *unit;
  cdem_dimension dimension;
} cdem_grain_column;
extern const cdem_grain_column cdem_grain_columns[CDEM_GRAIN_COLUMNS];
extern const char *const cdem_grain_motions[2]; /* by cdem_grain_motion */

/* Has a table of this dimension such a column? */
bool cdem_grain_column_is_of(int column, int dim);

#endif
