/* Private to io: pieces of CSV as RFC 4180 has it. */
#ifndef CDEM_IO_CSV_H
#define CDEM_IO_CSV_H

#include "results/results.h"

#include <stdio.h>

/* In quotes only where they are needed. */
void cdem_csv_text(FILE *stream, const char *text);
/* Nothing for an absent value. */
void cdem_csv_value(FILE *stream, const cdem_value *value, cdem_column_type type);

#endif
