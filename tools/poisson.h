/* The parts of `cdem poisson`: tables, figures, comparisons, and the shape of one element. */
#ifndef CDEM_TOOLS_POISSON_H
#define CDEM_TOOLS_POISSON_H

#include "io/io.h"
#include "results/results.h"
#include "verify/specimen.h"

/* nu_i = from + i step, i = 0 .. rows - 1. */
typedef struct {
  double from, to, step;
  int64_t rows;
} poisson_range;

/* Node coordinates of one element: from a mesh file with one cell, or from a text file with the
 * coordinates of one node a line (.txt, .csv, .dat; # starts a comment). xyz [nodes]. */
cdem_status poisson_read_shape(const char *path, const cdem_element *element,
                               const cdem_warnings *warnings, double (*xyz)[3], cdem_fault *fault);

/* Pairs to tabulate: the first of each class, or all. pairs [CDEM_MAX_PAIRS] receives indices;
 * returns how many. */
int poisson_choose_pairs(const cdem_specimen *specimen, bool all, int *pairs);

/* Pair as the table writes it, with node numbers from 1: "1-2". */
void poisson_pair_name(const cdem_specimen_pair *pair, char name[24]);

/* The table of the stable format, pair after pair. */
cdem_status poisson_fill_table(const cdem_specimen *specimen, const poisson_range *range, bool all,
                               const cdem_progress *progress, cdem_table *table, cdem_fault *fault);

/* Critical ratios; with all pairs a column `pair` comes last. Pairs that are double everywhere have
 * no row: their names are told through `note`. */
cdem_status poisson_fill_roots(const cdem_specimen *specimen, bool all,
                               void (*note)(const char *pair, const char *class_),
                               cdem_table *table, cdem_fault *fault);

/* Stiffness and directions of each class against nu, as PNG and SVG in a folder. range NULL: the
 * source's own (the diagonal interval around 1/4, from 0 to 1/2 at most). */
cdem_status poisson_draw_figures(const cdem_specimen *specimen, const poisson_range *range,
                                 const char *folder, cdem_fault *fault);

/* what: "gusev" or "net2d". One row a number: case, nu, direction, assembled, reference,
 * difference, verdict. *agree: all verdicts are good. */
cdem_status poisson_compare(const char *what, cdem_table *table, bool *agree, cdem_fault *fault);

#endif
