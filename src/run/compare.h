/* Room run: finished runs side by side.
 *
 * The first run is the reference, A. Each row is one number with its value in every run: first the
 * key results of the cases (summary.json), then means of history columns over a window where they
 * are asked for, then the wall time. What one run lacks is NaN, and its row is kept.
 *
 * A mean alone says little: beside it stands its scatter, the standard deviation of the rows of
 * history.csv it is taken from (n - 1 below the root). Rows of a history are not independent of
 * each other, so this is how far the number swings, not how well the mean is known.
 *
 * tests/run/compare.c holds these rows against histories made by hand.
 */
#ifndef CDEM_RUN_COMPARE_H
#define CDEM_RUN_COMPARE_H

#include "base/base.h"

typedef struct {
  int runs;                  /* 2 or more */
  const char *const *folder; /* [runs] */
  int columns;
  const char *const *column; /* [columns] of history.csv, or bare names of probes */
  double from, to;           /* s, of the columns' window; NaN: open */
} cdem_compare_options;

typedef enum {
  CDEM_COMPARED_RESULT,
  CDEM_COMPARED_WINDOW,
  CDEM_COMPARED_WALL_TIME
} cdem_compared_kind;

/* NaN: none. */
typedef struct {
  double value, scatter;
  double difference; /* from A, relative to |A|; NaN also for A itself and where only A is 0 */
} cdem_compared;

typedef struct {
  cdem_compared_kind kind;
  char *name, *unit;  /* unit "": none */
  int first;          /* run that has it */
  cdem_compared *run; /* [runs] */
} cdem_compared_row;

typedef struct {
  int runs;
  char **
      run; /* [runs] how each is called: its folder's own name, or the path where names are alike */
  double from, to; /* s, window of the columns; NaN: open */
  int64_t rows, capacity;
  cdem_compared_row *row;
} cdem_comparison;

/* CDEM_INPUT: a folder without a finished run, a summary that was changed, one name with two units,
 * a column or a window that no run has. CDEM_FILE: a file that cannot be read. */
cdem_status cdem_compare(const cdem_compare_options *options, cdem_comparison *comparison,
                         cdem_fault *fault);
/* Safe on a zeroed comparison and twice. */
void cdem_comparison_release(cdem_comparison *comparison);

/* The comparison as a JSON object, newly allocated. */
cdem_status cdem_comparison_json(const cdem_comparison *comparison, char **text, cdem_fault *fault);

/* "1.684e6 ± 2.1e4": the scatter with two digits, the value down to the same place but with four
 * digits at least, so that differences can be followed; six digits without a scatter. Empty where
 * there is no value. */
enum { CDEM_COMPARED_TEXT = 56 };
void cdem_compared_text(const cdem_compared *compared, char text[CDEM_COMPARED_TEXT]);

/* ---- curves of several runs in one figure (compare_figure.c) ---- */

enum { CDEM_COMPARE_MOST_CURVES = 8, CDEM_COMPARE_MOST_PANELS = 9 };

typedef struct {
  int runs;                   /* 1 to CDEM_COMPARE_MOST_CURVES */
  const char *const *folder;  /* [runs] */
  const char *const *label;   /* [runs] legend, with gnuplot's markup; NULL entries: as in `run` */
  const char *x;              /* column; NULL: time */
  int columns;                /* 1 to CDEM_COMPARE_MOST_PANELS, a panel each */
  const char *const *column;  /* [columns] */
  const char *const *y_label; /* [columns]; NULL entries: column and unit, as with x_label */
  const char *x_label, *title;
  double x_scale, y_scale; /* before drawing; a scaled axis has no unit of its own */
  double from, to;         /* s, rows that are drawn; NaN: open */
} cdem_compare_figure;

/* Draws FOLDER/NAME.png and .svg with .gp and .dat beside them. */
cdem_status cdem_compare_draw(const cdem_compare_figure *figure, const char *folder,
                              const char *name, cdem_fault *fault);

#endif
