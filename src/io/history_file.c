/* Histories: CSV files that grow by a row at a time.
 *
 * A row is made in memory and written by one call, so that a killed run leaves at most one broken
 * line, the last; when a disk is full, what was written of the row is taken back. */
#include "io/csv.h"
#include "io/output.h"
#include "io/run_files.h"
#include "io/text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct cdem_history_writer {
  char *path;
  int columns;
  cdem_column_type *type; /* [columns] */
  int descriptor;
  int64_t length; /* of the file up to its last whole row */
  char *row;      /* what the stream wrote */
  size_t row_length;
  FILE *stream;
};

/* ---- writing ---- */

static cdem_status append(cdem_history_writer *writer, cdem_fault *fault) {
  CDEM_REQUIRE(fflush(writer->stream) == 0, fault, CDEM_MEMORY,
               "out of memory: no room for a row of '%s'", writer->path);
  size_t done = 0;
  while (done < writer->row_length) {
    ssize_t n = write(writer->descriptor, writer->row + done, writer->row_length - done);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0) {
      int error = errno;
      if (ftruncate(writer->descriptor, (off_t)writer->length) == 0)
        lseek(writer->descriptor, (off_t)writer->length, SEEK_SET);
      return cdem_write_fail(writer->path, error, fault);
    }
    done += (size_t)n;
  }
  writer->length += (int64_t)done;
  return CDEM_OK;
}

static void put_header(FILE *stream, const cdem_table *table) {
  for (int c = 0; c < table->columns; c++) {
    const cdem_column *column = &table->column[c];
    char title[256];
    bool unit = column->unit[0] != '\0';
    snprintf(title, sizeof title, "%s%s%s%s", column->name, unit ? " [" : "", column->unit,
             unit ? "]" : "");
    cdem_csv_text(stream, title);
    fputc(c + 1 < table->columns ? ',' : '\n', stream);
  }
}

cdem_status cdem_history_append(cdem_history_writer *writer, const cdem_table *table,
                                cdem_fault *fault) {
  bool fits = table->columns == writer->columns;
  for (int c = 0; fits && c < table->columns; c++)
    fits = table->column[c].type == writer->type[c];
  CDEM_REQUIRE(fits && table->rows > 0, fault, CDEM_USAGE,
               "the table has %d columns and %" PRId64
               " rows; the history '%s' takes the last row of a table of its own %d columns",
               table->columns, table->rows, writer->path, writer->columns);
  rewind(writer->stream);
  for (int c = 0; c < table->columns; c++) {
    cdem_csv_value(writer->stream, cdem_table_at(table, table->rows - 1, c), writer->type[c]);
    fputc(c + 1 < table->columns ? ',' : '\n', writer->stream);
  }
  return append(writer, fault);
}

/* ---- resuming ---- */

/* Behind the line at `at`, line breaks in quotes being part of it; NULL when it is not ended. */
static const char *line_end(const char *at) {
  bool quoted = false;
  for (; *at != '\0'; at++) {
    quoted ^= *at == '"';
    if (*at == '\n' && !quoted)
      return at + 1;
  }
  return NULL;
}

/* Finds the length of the file with `keep` rows behind the header, which must be `header`. */
static cdem_status measure(const char *path, const char *header, int64_t keep, int64_t *length,
                           cdem_fault *fault) {
  char *text;
  CDEM_TRY(cdem_read_text(path, &text, fault));
  const char *at = line_end(text);
  cdem_status status = CDEM_OK;
  if (at == NULL || strncmp(text, header, strlen(header)) != 0)
    status = cdem_fail(fault, CDEM_INPUT,
                       "cannot continue '%s': its columns are not those of this run; resume in the "
                       "folder of the run or start it anew",
                       path);
  int64_t rows = 0;
  for (const char *next; status == CDEM_OK && rows < keep; rows++, at = next)
    if ((next = line_end(at)) == NULL)
      status = cdem_fail(fault, CDEM_INPUT,
                         "cannot continue '%s': it has %" PRId64 " whole rows and %" PRId64
                         " are needed; start the run anew",
                         path, rows, keep);
  if (status == CDEM_OK)
    *length = at - text;
  free(text);
  return status;
}

static cdem_status open_file(cdem_history_writer *writer, const cdem_table *columns, int64_t keep,
                             cdem_fault *fault) {
  put_header(writer->stream, columns);
  CDEM_REQUIRE(fflush(writer->stream) == 0, fault, CDEM_MEMORY,
               "out of memory: no room for a row of '%s'", writer->path);
  if (keep > 0)
    CDEM_TRY(measure(writer->path, writer->row, keep, &writer->length, fault));
  writer->descriptor = open(writer->path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (writer->descriptor < 0)
    return cdem_write_fail(writer->path, errno, fault);
  struct stat facts;
  /* A pipe or a device has no length. */
  bool regular = fstat(writer->descriptor, &facts) == 0 && S_ISREG(facts.st_mode);
  if (regular && (ftruncate(writer->descriptor, (off_t)writer->length) != 0 ||
                  lseek(writer->descriptor, (off_t)writer->length, SEEK_SET) < 0))
    return cdem_write_fail(writer->path, errno, fault);
  return keep > 0 ? CDEM_OK : append(writer, fault);
}

static cdem_status fill_writer(cdem_history_writer *writer, const char *path,
                               const cdem_table *columns, int64_t keep, cdem_fault *fault) {
  writer->path = cdem_copy_text(path, fault);
  if (writer->path == NULL)
    return CDEM_MEMORY;
  writer->columns = columns->columns;
  CDEM_NEW(writer->type, columns->columns, fault);
  for (int c = 0; c < columns->columns; c++)
    writer->type[c] = columns->column[c].type;
  writer->stream = open_memstream(&writer->row, &writer->row_length);
  CDEM_REQUIRE(writer->stream != NULL, fault, CDEM_MEMORY, "out of memory: no stream for '%s'",
               path);
  return open_file(writer, columns, keep, fault);
}

cdem_status cdem_history_create(const char *path, const cdem_table *columns, int64_t keep_rows,
                                cdem_history_writer **writer, cdem_fault *fault) {
  cdem_history_writer *w;
  *writer = NULL;
  CDEM_NEW(w, 1, fault);
  w->descriptor = -1;
  cdem_status status = fill_writer(w, path, columns, keep_rows, fault);
  if (status == CDEM_OK)
    *writer = w;
  else
    cdem_history_destroy(&w);
  return status;
}

void cdem_history_destroy(cdem_history_writer **writer) {
  if (writer == NULL || *writer == NULL)
    return;
  if ((*writer)->descriptor >= 0)
    close((*writer)->descriptor);
  if ((*writer)->stream != NULL)
    fclose((*writer)->stream);
  free((*writer)->row);
  free((*writer)->type);
  free((*writer)->path);
  free(*writer);
  *writer = NULL;
}

/* ---- reading ---- */

/* "name [unit]" */
static cdem_status add_column(cdem_table *table, char *title, cdem_fault *fault) {
  size_t length = strlen(title);
  char *unit = length > 0 && title[length - 1] == ']' ? strrchr(title, '[') : NULL;
  if (unit == NULL || unit < title + 2 || unit[-1] != ' ')
    return cdem_table_add_column(table, title, CDEM_COLUMN_REAL, "", fault);
  title[length - 1] = unit[-1] = '\0';
  return cdem_table_add_column(table, title, CDEM_COLUMN_REAL, unit + 1, fault);
}

static cdem_status read_row(char **at, int64_t line, cdem_table *table, cdem_fault *fault) {
  CDEM_TRY(cdem_table_add_row(table, fault));
  bool last = false;
  for (int c = 0; c < table->columns; c++) {
    CDEM_REQUIRE(!last, fault, CDEM_INPUT,
                 "line %" PRId64 ": it has %d fields, but the header has %d", line, c,
                 table->columns);
    char *field = cdem_csv_take(at, &last), *end;
    double value = cdem_get_real(field, &end);
    CDEM_REQUIRE(*end == '\0' && (end > field || field[0] == '\0'), fault, CDEM_INPUT,
                 "line %" PRId64 ": '%.40s' is not a number", line, field);
    if (field[0] != '\0')
      cdem_table_set_real(table, c, value);
  }
  CDEM_REQUIRE(last, fault, CDEM_INPUT,
               "line %" PRId64 ": it has more fields than the header, which has %d", line,
               table->columns);
  return CDEM_OK;
}

static cdem_status read_lines(char *text, cdem_table *table, cdem_fault *fault) {
  CDEM_REQUIRE(line_end(text) != NULL, fault, CDEM_INPUT, "line 1: the header is missing");
  char *at = text;
  for (bool last = false; !last;)
    CDEM_TRY(add_column(table, cdem_csv_take(&at, &last), fault));
  /* A last line without an end is what a killed run was writing. */
  for (int64_t line = 2; line_end(at) != NULL; line++)
    CDEM_TRY(read_row(&at, line, table, fault));
  return CDEM_OK;
}

cdem_status cdem_read_history(const char *path, cdem_table *table, cdem_fault *fault) {
  char *text;
  *table = (cdem_table){0};
  CDEM_TRY(cdem_read_text(path, &text, fault));
  cdem_status status = read_lines(text, table, fault);
  free(text);
  if (status == CDEM_OK)
    return CDEM_OK;
  cdem_table_release(table);
  if (status == CDEM_INPUT)
    cdem_fault_prefix(fault, "cannot read '%s'", path);
  return status;
}
