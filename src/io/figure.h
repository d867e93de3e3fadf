/* Private to io: a figure as a gnuplot script and its data. The script draws NAME.png and NAME.svg
 * when run by hand in its folder; the variables png and svg name other files. */
#ifndef CDEM_IO_FIGURE_H
#define CDEM_IO_FIGURE_H

#include "io/io.h"

/* One block ("index" in gnuplot) a curve, in the order of panels and curves. */
void cdem_figure_put_data(FILE *stream, const cdem_figure *figure);
void cdem_figure_put_script(FILE *stream, const char *name, const cdem_figure *figure);

#endif
