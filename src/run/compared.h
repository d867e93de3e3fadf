/* Private to run: a finished run, read back. */
#ifndef CDEM_RUN_COMPARED_H
#define CDEM_RUN_COMPARED_H

#include "io/run_files.h"

/* CDEM_INPUT, with the remedy, unless the folder holds a run that has ended. */
cdem_status cdem_compared_check(const char *folder, cdem_fault *fault);
/* FOLDER/history.csv. */
cdem_status cdem_compared_history(const char *folder, cdem_table *history, cdem_fault *fault);
/* Fails when no run's history has the column, with the nearest name of the first one. */
cdem_status cdem_compared_column(const cdem_table *history, int runs, const char *name,
                                 cdem_fault *fault);
/* How each run is called, newly allocated: the last part of its folder's path; the whole path where
 * two runs would be called alike. */
cdem_status cdem_compared_names(int runs, const char *const *folder, char **name,
                                cdem_fault *fault);

#endif
