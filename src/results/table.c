#include "results/results.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_table_release(cdem_table *table) {
  for (int c = 0; c < table->columns; c++) {
    if (table->column[c].type == CDEM_COLUMN_TEXT)
      for (int64_t r = 0; r < table->rows; r++)
        if (!cdem_table_at(table, r, c)->absent)
          free(cdem_table_at(table, r, c)->text);
    free(table->column[c].name);
    free(table->column[c].unit);
  }
  free(table->column);
  free(table->value);
  *table = (cdem_table){0};
}

cdem_status cdem_table_add_column(cdem_table *table, const char *name, cdem_column_type type,
                                  const char *unit, cdem_fault *fault) {
  assert(table->rows == 0);
  int64_t capacity = table->columns;
  CDEM_TRY(cdem_grow(&table->column, &capacity, table->columns + 1, sizeof *table->column, fault));
  cdem_column column = {.type = type};
  column.name = cdem_copy_text(name, fault);
  column.unit = column.name != NULL ? cdem_copy_text(unit, fault) : NULL;
  if (column.unit == NULL) {
    free(column.name);
    return CDEM_MEMORY;
  }
  table->column[table->columns++] = column;
  return CDEM_OK;
}

cdem_status cdem_table_add_row(cdem_table *table, cdem_fault *fault) {
  int64_t used = table->rows * table->columns;
  CDEM_TRY(cdem_grow(&table->value, &table->capacity, used + table->columns, sizeof *table->value,
                     fault));
  for (int c = 0; c < table->columns; c++)
    table->value[used + c] = (cdem_value){.absent = true};
  table->rows++;
  return CDEM_OK;
}

/* The value of the last row, which is the one being filled. */
static cdem_value *last(cdem_table *table, int column, cdem_column_type type) {
  assert(table->rows > 0 && column >= 0 && column < table->columns);
  assert(table->column[column].type == type);
  (void)type;
  return &table->value[(table->rows - 1) * table->columns + column];
}

void cdem_table_set_real(cdem_table *table, int column, double value) {
  cdem_value *v = last(table, column, CDEM_COLUMN_REAL);
  v->absent = isnan(value);
  v->real = value;
}

void cdem_table_set_integer(cdem_table *table, int column, int64_t value) {
  cdem_value *v = last(table, column, CDEM_COLUMN_INTEGER);
  v->absent = false;
  v->integer = value;
}

cdem_status cdem_table_set_text(cdem_table *table, int column, const char *value,
                                cdem_fault *fault) {
  cdem_value *v = last(table, column, CDEM_COLUMN_TEXT);
  char *copy = cdem_copy_text(value, fault);
  if (copy == NULL)
    return CDEM_MEMORY;
  if (!v->absent)
    free(v->text);
  v->absent = false;
  v->text = copy;
  return CDEM_OK;
}

int cdem_table_find(const cdem_table *table, const char *name) {
  for (int c = 0; c < table->columns; c++)
    if (strcmp(table->column[c].name, name) == 0)
      return c;
  return -1;
}
