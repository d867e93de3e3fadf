/* Physical dimensions as exponents of length, time and mass; every number is SI inside.
 *
 * A dimension travels with each key of a material or case file, so that reading ("40 GPa"), help
 * and exact scaling follow from one table. Angles and ratios have dimension zero.
 */
#ifndef CDEM_BASE_QUANTITY_H
#define CDEM_BASE_QUANTITY_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
  int8_t length, time, mass;
} cdem_dimension;

#define CDEM_DIMENSIONLESS ((cdem_dimension){0, 0, 0})
#define CDEM_LENGTH        ((cdem_dimension){1, 0, 0})
#define CDEM_TIME          ((cdem_dimension){0, 1, 0})
#define CDEM_PRESSURE      ((cdem_dimension){-1, -2, 1})
#define CDEM_FORCE         ((cdem_dimension){1, -2, 1})
#define CDEM_DENSITY       ((cdem_dimension){-3, 0, 1})

/* The SI unit as UDUNITS writes it ("Pa", "m", "kg m-3"), for messages and help; `text` holds at
 * least 48 characters and is returned. */
char *cdem_dimension_unit(cdem_dimension dimension, char text[48]);

/* The dimension of a unit as headers of tables write it: "N", "N m", "m/s", "kg m-3", "m2", "" or
 * "rad" for none. False for a unit that has no name here, *dimension is left alone then. */
bool cdem_dimension_of_unit(const char *unit, cdem_dimension *dimension);

#endif
