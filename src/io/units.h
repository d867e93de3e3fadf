/* Private to io: quantities with units, by UDUNITS-2. Not thread-safe, as UDUNITS is not. */
#ifndef CDEM_IO_UNITS_H
#define CDEM_IO_UNITS_H

#include "base/base.h"

/* The unit system is read from its XML file at the first quantity that has a unit; one handle
 * serves a whole file. Zero-initialise. */
typedef struct {
  void *system;
} cdem_units;

cdem_status cdem_units_parse(cdem_units *units, const char *text, cdem_dimension dimension,
                             double *value, cdem_fault *fault);
void cdem_units_release(cdem_units *units);

#endif
