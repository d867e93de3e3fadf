/* Tables and checks as CSV and JSON. */
#include "io/csv.h"
#include "io/io.h"
#include "io/text.h"

#include <math.h>

void cdem_json_text(FILE *stream, const char *text) {
  fputc('"', stream);
  for (const char *c = text; *c != '\0'; c++) {
    unsigned char byte = (unsigned char)*c;
    if (byte == '"' || byte == '\\')
      fprintf(stream, "\\%c", byte);
    else if (byte == '\n')
      fputs("\\n", stream);
    else if (byte == '\t')
      fputs("\\t", stream);
    else if (byte < 0x20)
      fprintf(stream, "\\u%04x", byte);
    else
      fputc(byte, stream);
  }
  fputc('"', stream);
}

static void put_integer(FILE *stream, int64_t value) {
  char text[CDEM_INTEGER_WIDTH];
  fwrite(text, 1, (size_t)(cdem_put_integer(text, value) - text), stream);
}

static void put_real(FILE *stream, double value) {
  char text[CDEM_REAL_WIDTH];
  fwrite(text, 1, (size_t)(cdem_put_real(text, value) - text), stream);
}

void cdem_json_number(FILE *stream, double value) {
  if (isfinite(value))
    put_real(stream, value);
  else
    fputs("null", stream);
}

void cdem_csv_text(FILE *stream, const char *text) {
  if (text[strcspn(text, ",\"\r\n")] == '\0') {
    fputs(text, stream);
    return;
  }
  fputc('"', stream);
  for (const char *c = text; *c != '\0'; c++) {
    if (*c == '"')
      fputc('"', stream);
    fputc(*c, stream);
  }
  fputc('"', stream);
}

void cdem_csv_value(FILE *stream, const cdem_value *value, cdem_column_type type) {
  if (value->absent)
    return;
  if (type == CDEM_COLUMN_INTEGER)
    put_integer(stream, value->integer);
  else if (type == CDEM_COLUMN_REAL)
    put_real(stream, value->real);
  else
    cdem_csv_text(stream, value->text);
}

char *cdem_csv_take(char **at, bool *last) {
  char *from = *at, *to = from, *field = from;
  bool quoted = false;
  for (; *from != '\0' && (quoted || (*from != ',' && *from != '\n')); from++) {
    if (*from == '"' && quoted && from[1] == '"')
      *to++ = *from++;
    else if (*from == '"')
      quoted = !quoted;
    else
      *to++ = *from;
  }
  *last = *from != ',';
  *at = *from != '\0' ? from + 1 : from;
  *to = '\0';
  return field;
}

static void put_json_value(FILE *stream, const cdem_value *value, cdem_column_type type) {
  if (value->absent)
    fputs("null", stream);
  else if (type == CDEM_COLUMN_INTEGER)
    put_integer(stream, value->integer);
  else if (type == CDEM_COLUMN_REAL)
    cdem_json_number(stream, value->real);
  else
    cdem_json_text(stream, value->text);
}

cdem_status cdem_write_table_csv(const char *path, const cdem_table *table, cdem_fault *fault) {
  cdem_output *output;
  CDEM_TRY(cdem_output_open(path, &output, fault));
  FILE *stream = cdem_output_stream(output);
  for (int c = 0; c < table->columns; c++) {
    cdem_csv_text(stream, table->column[c].name);
    fputc(c + 1 < table->columns ? ',' : '\n', stream);
  }
  for (int64_t r = 0; r < table->rows; r++)
    for (int c = 0; c < table->columns; c++) {
      cdem_csv_value(stream, cdem_table_at(table, r, c), table->column[c].type);
      fputc(c + 1 < table->columns ? ',' : '\n', stream);
    }
  return cdem_output_commit(&output, fault);
}

cdem_status cdem_write_table_json(const char *path, const cdem_table *table, cdem_fault *fault) {
  cdem_output *output;
  CDEM_TRY(cdem_output_open(path, &output, fault));
  FILE *stream = cdem_output_stream(output);
  fputc('[', stream);
  for (int64_t r = 0; r < table->rows; r++) {
    fputs(r > 0 ? ",\n {" : "\n {", stream);
    for (int c = 0; c < table->columns; c++) {
      fputs(c > 0 ? ", " : "", stream);
      cdem_json_text(stream, table->column[c].name);
      fputs(": ", stream);
      put_json_value(stream, cdem_table_at(table, r, c), table->column[c].type);
    }
    fputc('}', stream);
  }
  fputs("\n]\n", stream);
  return cdem_output_commit(&output, fault);
}

cdem_status cdem_write_checks_json(FILE *stream, const cdem_check_list *list, cdem_fault *fault) {
  fputc('[', stream);
  for (int64_t i = 0; i < list->checks; i++) {
    const cdem_check *check = &list->check[i];
    const char *const text[4] = {check->group, check->name, check->source,
                                 cdem_check_kind_find(check->kind)->text};
    const char *const text_key[4] = {"group", "name", "source", "kind"};
    const double number[3] = {check->reference, check->value, check->tolerance};
    const char *const number_key[3] = {"reference", "value", "tolerance"};
    fputs(i > 0 ? ",\n {" : "\n {", stream);
    for (int k = 0; k < 4; k++) {
      fprintf(stream, "\"%s\": ", text_key[k]);
      cdem_json_text(stream, text[k]);
      fputs(", ", stream);
    }
    for (int k = 0; k < 3; k++) {
      fprintf(stream, "\"%s\": ", number_key[k]);
      cdem_json_number(stream, number[k]);
      fputs(", ", stream);
    }
    fprintf(stream, "\"pass\": %s}", cdem_check_passes(check) ? "true" : "false");
  }
  fputs("\n]\n", stream);
  CDEM_REQUIRE(fflush(stream) == 0 && ferror(stream) == 0, fault, CDEM_FILE,
               "cannot write the checks; free some space or choose another output");
  return CDEM_OK;
}
