/* Tables that people and other programs wrote: lines, titles with units, numbers. */
#include "base/memory.h"
#include "io/csv.h"
#include "io/grains_file.h"
#include "io/run_files.h"
#include "io/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- pieces ---- */

char *cdem_csv_begin(char *text) {
  return strncmp(text, "\xef\xbb\xbf", 3) == 0 ? text + 3 : text;
}

char *cdem_csv_line(char **at, int64_t *line) {
  while (**at != '\0') {
    char *from = *at, *end = from + strcspn(from, "\n");
    *at = *end == '\0' ? end : end + 1;
    if (end > from && end[-1] == '\r')
      end--;
    *end = '\0';
    ++*line;
    if (from[0] != '#' && from[strspn(from, " \t")] != '\0')
      return from;
  }
  return NULL;
}

char *cdem_csv_title(char **at, bool *last, char **unit) {
  char *title = cdem_csv_take(at, last);
  title += strspn(title, " \t");
  size_t length = strlen(title);
  while (length > 0 && (title[length - 1] == ' ' || title[length - 1] == '\t'))
    title[--length] = '\0';
  *unit = length > 0 && title[length - 1] == ']' ? strrchr(title, '[') : NULL;
  if (*unit != NULL) {
    title[length - 1] = '\0';
    char *end = (*unit)++;
    while (end > title && end[-1] == ' ')
      end--;
    *end = '\0';
  }
  return title;
}

cdem_status cdem_csv_unit(cdem_units *units, const char *name, const char *unit,
                          cdem_dimension dimension, int64_t line, double *factor,
                          cdem_fault *fault) {
  char text[64];
  *factor = 1.0;
  if (unit == NULL)
    return CDEM_OK;
  snprintf(text, sizeof text, "1 %s", unit);
  cdem_status status = cdem_units_parse(units, text, dimension, factor, fault);
  if (status == CDEM_INPUT)
    cdem_fault_prefix(fault, "line %" PRId64 ": unit of column '%s'", line, name);
  return status;
}

cdem_status cdem_csv_number(const char *field, const char *name, double factor, int64_t line,
                            double *number, cdem_fault *fault) {
  char *end;
  double value = cdem_get_real(field, &end) * factor;
  while (end > field && (*end == ' ' || *end == '\t'))
    end++;
  CDEM_REQUIRE(end > field && *end == '\0', fault, CDEM_INPUT,
               "line %" PRId64 ": %s is '%.40s', which is no number", line, name, field);
  CDEM_REQUIRE(isfinite(value), fault, CDEM_INPUT,
               "line %" PRId64 ": %s is %g; a finite number is wanted", line, name, value);
  *number = value;
  return CDEM_OK;
}

/* ---- tables of sizes ---- */

enum { RADIUS, FRACTION, COLUMNS };
static const char *const names[COLUMNS] = {"radius", "fraction"};

typedef struct {
  int64_t line;
  int fields, column[COLUMNS]; /* of the file */
  bool has[COLUMNS];
  double unit[COLUMNS];
  cdem_units units;
  int64_t rows, room;
  double *value; /* [rows][COLUMNS] */
} sizes_reader;

static cdem_status read_header(sizes_reader *r, char *text, cdem_fault *fault) {
  for (bool last = false; !last;) {
    char *unit, *title = cdem_csv_title(&text, &last, &unit);
    int c = 0;
    while (c < COLUMNS && strcmp(title, names[c]) != 0)
      c++;
    CDEM_REQUIRE(c < COLUMNS, fault, CDEM_INPUT,
                 "line %" PRId64 ": there is no column '%.40s' in a table of sizes; it has radius "
                 "and fraction",
                 r->line, title);
    CDEM_REQUIRE(!r->has[c], fault, CDEM_INPUT, "line %" PRId64 ": the column '%s' is there twice",
                 r->line, title);
    r->has[c] = true;
    r->column[r->fields] = c;
    CDEM_TRY(cdem_csv_unit(&r->units, title, unit, c == RADIUS ? CDEM_LENGTH : CDEM_DIMENSIONLESS,
                           r->line, &r->unit[r->fields++], fault));
  }
  for (int c = 0; c < COLUMNS; c++)
    CDEM_REQUIRE(r->has[c], fault, CDEM_INPUT, "line %" PRId64 ": the column '%s' is missing",
                 r->line, names[c]);
  return CDEM_OK;
}

static cdem_status read_classes(sizes_reader *r, char *text, cdem_fault *fault) {
  char *at = cdem_csv_begin(text), *line = cdem_csv_line(&at, &r->line);
  CDEM_REQUIRE(line != NULL, fault, CDEM_INPUT, "the header is missing");
  CDEM_TRY(read_header(r, line, fault));
  while ((line = cdem_csv_line(&at, &r->line)) != NULL) {
    bool last = false;
    CDEM_TRY(cdem_grow(&r->value, &r->room, COLUMNS * (r->rows + 1), sizeof *r->value, fault));
    for (int k = 0; k < COLUMNS; k++) {
      CDEM_REQUIRE(!last, fault, CDEM_INPUT,
                   "line %" PRId64 ": it has %d fields, but the header has %d", r->line, k,
                   COLUMNS);
      CDEM_TRY(cdem_csv_number(cdem_csv_take(&line, &last), names[r->column[k]], r->unit[k],
                               r->line, &r->value[COLUMNS * r->rows + r->column[k]], fault));
    }
    CDEM_REQUIRE(last, fault, CDEM_INPUT,
                 "line %" PRId64 ": it has more fields than the header, which has %d", r->line,
                 COLUMNS);
    CDEM_REQUIRE(++r->rows < INT32_MAX, fault, CDEM_INPUT, "it has more than %d classes",
                 INT32_MAX);
  }
  CDEM_REQUIRE(r->rows > 0, fault, CDEM_INPUT, "there are no classes of sizes in it");
  return CDEM_OK;
}

cdem_status cdem_read_sizes(const char *path, int *classes, double **radius, double **fraction,
                            cdem_fault *fault) {
  char *text;
  sizes_reader r = {0};
  CDEM_TRY(cdem_read_text(path, &text, fault));
  cdem_status status = read_classes(&r, text, fault);
  if (status == CDEM_INPUT)
    cdem_fault_prefix(fault, "cannot read '%s'", path);
  double *made[COLUMNS] = {NULL, NULL};
  for (int c = 0; c < COLUMNS && status == CDEM_OK; c++) {
    made[c] = cdem_allocate(r.rows, sizeof *made[c], fault);
    status = made[c] != NULL ? CDEM_OK : CDEM_MEMORY;
    for (int64_t i = 0; i < r.rows && status == CDEM_OK; i++)
      made[c][i] = r.value[COLUMNS * i + c];
  }
  if (status == CDEM_OK) {
    *classes = (int)r.rows;
    *radius = made[RADIUS];
    *fraction = made[FRACTION];
  } else {
    free(made[RADIUS]);
    free(made[FRACTION]);
  }
  cdem_units_release(&r.units);
  free(r.value);
  free(text);
  return status;
}
