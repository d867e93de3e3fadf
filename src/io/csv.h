/* Private to io: pieces of CSV as RFC 4180 has it. */
#ifndef CDEM_IO_CSV_H
#define CDEM_IO_CSV_H

#include "io/units.h"
#include "results/results.h"

#include <stdio.h>

/* In quotes only where they are needed. */
void cdem_csv_text(FILE *stream, const char *text);
/* Nothing for an absent value. */
void cdem_csv_value(FILE *stream, const cdem_value *value, cdem_column_type type);
/* Takes one field out of a line, quotes off, in place; *at is behind its comma or line end, *last
 * says that it was the line's last. */
char *cdem_csv_take(char **at, bool *last);

/* ---- tables from outside (csv_read.c) ---- */

/* Behind the byte order mark of other programs. */
char *cdem_csv_begin(char *text);
/* The next line that says something, ended by zero, without its line end (\n or \r\n); NULL at the
 * end. Lines that are empty or begin with # are counted and passed over. */
char *cdem_csv_line(char **at, int64_t *line);
/* Takes "name [unit]" out of a header: the name, and the unit or NULL. */
char *cdem_csv_title(char **at, bool *last, char **unit);
/* What a unit (NULL: SI) is worth; CDEM_INPUT names line and column. */
cdem_status cdem_csv_unit(cdem_units *units, const char *name, const char *unit,
                          cdem_dimension dimension, int64_t line, double *factor,
                          cdem_fault *fault);
/* A finite number times the factor of its unit; CDEM_INPUT names line and column. */
cdem_status cdem_csv_number(const char *field, const char *name, double factor, int64_t line,
                            double *number, cdem_fault *fault);

#endif
