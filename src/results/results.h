/* Room results: numbers on their way out, in memory. Nothing here opens a file (room io does) or
 * knows where a number came from (the solvers do).
 *
 * table   named columns of equal length with units: histories, Poisson tables, certificates
 * check   one verification: what was computed, what it should be, how far it may be off
 * figure  curves of table columns, to be drawn by io
 */
#ifndef CDEM_RESULTS_RESULTS_H
#define CDEM_RESULTS_RESULTS_H

#include "base/base.h"

#include <stdbool.h>

typedef enum { CDEM_COLUMN_REAL, CDEM_COLUMN_INTEGER, CDEM_COLUMN_TEXT } cdem_column_type;

/* A value of a table; an absent value is written as an empty field (CSV) or null (JSON). */
typedef struct {
  bool absent;
  union {
    double real;
    int64_t integer;
    char *text; /* owned by the table */
  };
} cdem_value;

typedef struct {
  char *name;
  char *unit; /* "" when dimensionless or text */
  cdem_column_type type;
} cdem_column;

typedef struct {
  int columns;
  cdem_column *column;
  int64_t rows;
  cdem_value *value; /* [rows][columns] */
  int64_t capacity;  /* private */
} cdem_table;

/* Zero-initialise, release at any stage. */
void cdem_table_release(cdem_table *table);
/* Columns come before rows. unit "" for none. */
cdem_status cdem_table_add_column(cdem_table *table, const char *name, cdem_column_type type,
                                  const char *unit, cdem_fault *fault);
/* Appends a row of absent values; fill it with the setters (column by index; the type must match).
 */
cdem_status cdem_table_add_row(cdem_table *table, cdem_fault *fault);
void cdem_table_set_real(cdem_table *table, int column, double value); /* NaN stays absent */
void cdem_table_set_integer(cdem_table *table, int column, int64_t value);
cdem_status cdem_table_set_text(cdem_table *table, int column, const char *value,
                                cdem_fault *fault);
/* Index of the column called `name`, or -1. */
int cdem_table_find(const cdem_table *table, const char *name);
static inline const cdem_value *cdem_table_at(const cdem_table *table, int64_t row, int column) {
  return &table->value[row * table->columns + column];
}

/* What gives a check its reference (check_kinds.def). Unstated is what a table forgot. */
typedef enum {
  CDEM_CHECK_UNSTATED,
#define X(name, text, outside, meaning) CDEM_CHECK_##name,
#include "results/check_kinds.def"
#undef X
  CDEM_CHECK_KINDS
} cdem_check_kind;

typedef struct {
  const char *text, *meaning; /* "closed form"; one line about it */
  bool outside;               /* the reference comes from outside of the program */
} cdem_check_kind_words;

/* Of every kind below CDEM_CHECK_KINDS. */
const cdem_check_kind_words *cdem_check_kind_find(cdem_check_kind kind);

/* One verification. Passes when |value - reference| <= tolerance; a bound is a reference of 0. */
typedef struct {
  const char *group, *name; /* "springs", "hex8 edge closed form"; borrowed */
  const char *source;       /* where the reference comes from: "Wei et al. 2006, eq. 13" */
  double reference, value, tolerance;
  cdem_check_kind kind;
} cdem_check;

/* Appended to by whoever verifies. */
typedef struct {
  cdem_check *check;
  int64_t checks, capacity;
} cdem_check_list;

cdem_status cdem_check_add(cdem_check_list *list, cdem_check check, cdem_fault *fault);
void cdem_check_list_release(cdem_check_list *list);
/* False for NaN. */
bool cdem_check_passes(const cdem_check *check);

enum { CDEM_CURVE_RINGS = 16 }; /* a multiple of the number of colours */

/* A figure: panels side by side, each with curves over a common x. All strings are copied by
 * nobody: they must outlive the drawing. Texts are UTF-8 and know gnuplot's markup: k_1 and
 * k_{12} are subscripts, m^2 is raised; a literal underscore is written \_. */
typedef struct {
  const char *title;   /* legend entry */
  const double *x, *y; /* [points]; NaN breaks the line */
  int64_t points;
  int style; /* colour and dash index, 0..7; -1: thin grey guide line; CDEM_CURVE_RINGS + 0..7:
                rings of that colour at the points */
} cdem_curve;

typedef struct {
  const char *title, *x_label, *y_label;
  int curves;
  const cdem_curve *curve;
  double y_min, y_max; /* equal: automatic */
} cdem_panel;

typedef struct {
  const char *title;
  int columns; /* panels a row */
  int panels;
  const cdem_panel *panel;
} cdem_figure;

#endif
