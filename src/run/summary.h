/* Private to run: what is said of a run when it has ended. */
#ifndef CDEM_RUN_SUMMARY_H
#define CDEM_RUN_SUMMARY_H

#include "run/json.h"
#include "run/output.h"

/* settings.c: "settings": {all keys of the case}. */
void cdem_run_put_settings(cdem_json *json, const cdem_case_values *values);

/* Sizes of the problem and its step, known before anything runs. */
cdem_status cdem_run_summary_sizes(const cdem_run_setup *setup, cdem_run_summary *summary,
                                   cdem_fault *fault);
/* The rest; history: read back from the file. The summary is released after a failure. */
cdem_status cdem_run_summary_fill(cdem_run_output *output, const cdem_table *history,
                                  cdem_run_summary *summary, cdem_fault *fault);
/* FOLDER/summary.json. */
cdem_status cdem_run_summary_write(const cdem_run_output *output, const cdem_table *history,
                                   const cdem_run_summary *summary, cdem_fault *fault);

/* figures.c: FOLDER/figures. */
cdem_status cdem_run_figures(cdem_run_output *output, const cdem_table *history, cdem_fault *fault);
/* ... pictures of the present state, named after `time`, s, a time of grains.picture_times. */
cdem_status cdem_run_figures_at(cdem_run_output *output, double time, cdem_fault *fault);

#endif
