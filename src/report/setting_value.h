/* Private to report: values of a case as text. */
#ifndef CDEM_REPORT_SETTING_VALUE_H
#define CDEM_REPORT_SETTING_VALUE_H

#include "cases/schema.h"
#include "report/text.h"

/* A number in a unit; "1": none. */
void cdem_report_put_value_of(cdem_report_text *to, double value, const char *unit);
/* The value of a key in the struct of its section. */
void cdem_report_put_value(cdem_report_text *to, const cdem_case_key *key, const void *values);
/* What holds for a key that is not given: its value where it has one, else words of the table. */
void cdem_report_put_default(cdem_report_text *to, const cdem_case_key *key, const void *values);

#endif
