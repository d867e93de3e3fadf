/* The figure of a network: distributions over its pairs, by class. */
#ifndef CDEM_TOOLS_SPRINGS_FIGURE_H
#define CDEM_TOOLS_SPRINGS_FIGURE_H

#include "network/network.h"

typedef struct springs_figure springs_figure;

/* Samples every n-th pair of the model, n so that about 100 000 are kept. */
cdem_status springs_figure_create(const cdem_model *model, springs_figure **figure,
                                  cdem_fault *fault);
void springs_figure_destroy(springs_figure **figure);
cdem_pair_sink springs_figure_sink(springs_figure *figure);
/* Writes FOLDER/springs.png, .svg with .gp and .dat beside them. */
cdem_status springs_figure_write(springs_figure *figure, const char *folder, cdem_fault *fault);

#endif
