/* Which columns of history.csv are terms of an energy book, and whether it closes. */
#include "run/book.h"

#include <math.h>
#include <string.h>

static const struct {
  const char *name;
  cdem_book_side side;
} term[] = {{"kinetic", CDEM_BOOK_STORED},      {"translation", CDEM_BOOK_STORED},
            {"rotation", CDEM_BOOK_STORED},     {"vibration", CDEM_BOOK_STORED},
            {"elastic", CDEM_BOOK_STORED},      {"interface", CDEM_BOOK_STORED},
            {"contact", CDEM_BOOK_STORED},      {"plate", CDEM_BOOK_STORED},
            {"normal", CDEM_BOOK_STORED},       {"shear", CDEM_BOOK_STORED},
            {"moment", CDEM_BOOK_STORED},       {"bond", CDEM_BOOK_STORED},
            {"membrane", CDEM_BOOK_STORED},     {"fracture", CDEM_BOOK_DISSIPATED},
            {"friction", CDEM_BOOK_DISSIPATED}, {"rolling", CDEM_BOOK_DISSIPATED},
            {"damping", CDEM_BOOK_DISSIPATED},  {"quiet", CDEM_BOOK_DISSIPATED},
            {"broken", CDEM_BOOK_DISSIPATED},   {"numerical", CDEM_BOOK_DISSIPATED},
            {"load", CDEM_BOOK_WORK},           {"gravity", CDEM_BOOK_WORK},
            {"support", CDEM_BOOK_WORK},        {"walls", CDEM_BOOK_WORK},
            {"cell", CDEM_BOOK_WORK},           {"pressure", CDEM_BOOK_WORK},
            {"circulating", CDEM_BOOK_WORK},    {"driven", CDEM_BOOK_WORK},
            {"guided", CDEM_BOOK_WORK},         {"applied", CDEM_BOOK_WORK}};

cdem_book_side cdem_run_book_side(const char *column, cdem_book_of *of) {
  *of = CDEM_BOOK_WHOLE;
  if (strncmp(column, "coarse.", 7) == 0) {
    *of = CDEM_BOOK_COARSE;
    column += 7;
  } else if (strncmp(column, "fine.", 5) == 0) {
    *of = CDEM_BOOK_FINE;
    column += 5;
  }
  for (size_t i = 0; i < sizeof term / sizeof term[0]; i++)
    if (strcmp(column, term[i].name) == 0)
      return term[i].side;
  return CDEM_BOOK_NONE;
}

static double real_or_zero(const cdem_table *history, int64_t row, int column) {
  const cdem_value *value = cdem_table_at(history, row, column);
  return value->absent ? 0.0 : value->real;
}

static void add_term(const cdem_table *history, int column, cdem_book_side side,
                     cdem_run_book *book) {
  double last = real_or_zero(history, history->rows - 1, column);
  book->terms++;
  book->stored += side == CDEM_BOOK_STORED ? last - real_or_zero(history, 0, column) : 0.0;
  book->dissipated += side == CDEM_BOOK_DISSIPATED ? last : 0.0;
  book->work += side == CDEM_BOOK_WORK ? last : 0.0;
  for (int64_t r = 0; r < history->rows; r++)
    book->scale = fmax(book->scale, fabs(real_or_zero(history, r, column)));
}

cdem_run_book cdem_run_book_sum(const cdem_table *history, cdem_book_of of) {
  cdem_run_book book = {0};
  for (int c = 0; history->rows > 0 && c < history->columns; c++) {
    cdem_book_of found;
    cdem_book_side side = cdem_run_book_side(history->column[c].name, &found);
    if (side != CDEM_BOOK_NONE && found == of)
      add_term(history, c, side, &book);
  }
  book.open = book.stored + book.dissipated - book.work;
  return book;
}
