/* Private to verify: what the checks of the group "cases" measure. */
#ifndef CDEM_VERIFY_CASES_H
#define CDEM_VERIFY_CASES_H

#include "base/base.h"

/* A key result of a shipped case as it is, over its reference in the case file; the parameter is a
 * row of the table of key results in cases.c. */
cdem_status cdem_cases_measure_result(int parameter, double *value, cdem_fault *fault);
/* The name of that key result in the case file. */
const char *cdem_cases_key(int parameter);

#endif
