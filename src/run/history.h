/* Private to run: the columns of history.csv, and one row of them. */
#ifndef CDEM_RUN_HISTORY_H
#define CDEM_RUN_HISTORY_H

#include "run/axis.h"
#include "run/setup.h"

/* Declares the columns in a zeroed table and checks every column that the case names. Declaring
 * changes nothing. */
cdem_status cdem_run_history_init(cdem_run_setup *setup, cdem_table *table, cdem_fault *fault);
/* The state as the table's only row. */
cdem_status cdem_run_history_row(cdem_run_setup *setup, cdem_table *table, cdem_fault *fault);

#endif
