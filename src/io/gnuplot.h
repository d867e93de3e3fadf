/* Private to io: pictures drawn by gnuplot, a child process. */
#ifndef CDEM_IO_GNUPLOT_H
#define CDEM_IO_GNUPLOT_H

#include "base/base.h"

#include <stdio.h>

/* What a kind of picture writes into its two files. The script begins with cdem_gnuplot_begin. */
typedef struct {
  const void *picture;
  void (*put_data)(FILE *stream, const void *picture);
  void (*put_script)(FILE *stream, const char *name, const void *picture);
} cdem_drawing;

/* Writes FOLDER/NAME.dat and .gp (the folder is made where it is missing), runs gnuplot there and
 * puts NAME.png and .svg beside them when both are whole. CDEM_FILE with the remedy when gnuplot is
 * missing. */
cdem_status cdem_gnuplot_draw(const char *folder, const char *name, const cdem_drawing *drawing,
                              cdem_fault *fault);

/* By this line a script is known as one of ours. */
#define CDEM_GNUPLOT_FIRST_LINE                                                                    \
  "# draws the .png and .svg beside it: gnuplot THIS_FILE, in this folder"

/* ---- pieces of scripts ---- */

/* Size and type of the letters of all pictures, points of 4/3 pixel. */
#define CDEM_GNUPLOT_FONT      "DejaVu Sans"
#define CDEM_GNUPLOT_FONT_SIZE 9.5
#define CDEM_GNUPLOT_TICS_SIZE 8.2

/* The variables png, svg and data; then a loop over both terminals, to be closed by
 * cdem_gnuplot_end. Sizes are pixels of the .svg; the .png has twice as many. more: options of both
 * terminals. */
void cdem_gnuplot_begin(FILE *stream, const char *name, double width, double height,
                        const char *more);
void cdem_gnuplot_end(FILE *stream);
/* A text in single quotes; control characters become spaces; NULL is the empty text. */
void cdem_gnuplot_text(FILE *stream, const char *text);
/* A number with 17 digits. */
void cdem_gnuplot_number(FILE *stream, double value);
void cdem_gnuplot_range(FILE *stream, const char *axis, double low, double high);
/* The power of ten (0 or a multiple of 3) that the ticks of very large or small numbers share.
 * Their axis is drawn in numbers divided by it. */
int cdem_gnuplot_power(double low, double high);
/* "×10^{3}"; nothing for power 0. */
void cdem_gnuplot_power_text(int power, char text[32]);
/* A column of the data divided by a power of ten: "1" or "($1*1e-3)". */
void cdem_gnuplot_column(FILE *stream, int column, int power);
/* Letters of a text as drawn: UTF-8 continuation bytes and gnuplot's markup do not count. */
int cdem_gnuplot_letters(const char *text);

#endif
