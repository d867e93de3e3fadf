/* Private to run: the columns of history.csv, and one row of them. */
#ifndef CDEM_RUN_HISTORY_H
#define CDEM_RUN_HISTORY_H

#include "run/setup.h"

/* A probe of the case, resolved. */
typedef struct {
  int32_t nodes;
  int32_t *node; /* displacement, velocity, force; stress of a group of points, lines or faces */
  const cdem_group *cells; /* stress of a group of volumes: mean by volume; else NULL */
} cdem_run_probe;

typedef struct {
  cdem_table table;      /* columns, and at most one row */
  cdem_run_probe *probe; /* [probes of the case] */
  double *velocity;      /* [nodes][dofs] scratch */
  double *cell_stress;   /* [model cells][6] scratch; NULL when no probe needs it */
  double *node_stress;   /* [nodes][6] scratch, likewise */
} cdem_run_history;

/* Declares the columns and checks every column that the case names. Zero-initialise; release at any
 * stage. */
cdem_status cdem_run_history_init(const cdem_run_setup *setup, cdem_run_history *history,
                                  cdem_fault *fault);
/* The state as the table's only row. */
cdem_status cdem_run_history_row(cdem_run_setup *setup, cdem_run_history *history,
                                 cdem_fault *fault);
void cdem_run_history_release(cdem_run_history *history, const cdem_run_setup *setup);

/* A column as the case names it: in full, or the bare name of a probe; -1 when there is none. */
int cdem_run_history_find(const cdem_table *table, const char *name);

/* probes.c */
cdem_status cdem_run_probes_init(const cdem_run_setup *setup, cdem_run_history *history,
                                 cdem_fault *fault);
/* Fields that probes look at, once a row. */
void cdem_run_probes_update(const cdem_run_setup *setup, cdem_run_history *history);
double cdem_run_probe_value(const cdem_run_setup *setup, const cdem_run_history *history,
                            int64_t probe);
const char *cdem_run_probe_unit(const cdem_case_probe *probe);

#endif
