/* The springs of one block. */
#include "api/store.h"

#include <math.h>
#include <string.h>

_Static_assert((int)LIBCDEM_FRAME == (int)CDEM_FORM_FRAME &&
                   (int)LIBCDEM_COMPLEX == (int)CDEM_FORM_COMPLEX &&
                   (int)LIBCDEM_JORDAN3 == (int)CDEM_FORM_JORDAN3 &&
                   (int)LIBCDEM_JORDAN2 == (int)CDEM_FORM_JORDAN2 &&
                   (int)LIBCDEM_DIAGONAL == (int)CDEM_FORM_DIAGONAL,
               "forms are counted alike inside and outside");

const char *libcdem_form_name(libcdem_form form) {
  return form <= LIBCDEM_FRAME ? cdem_form_name((cdem_form)form) : "";
}

void cdem_api_springs(const cdem_spring_set *from, libcdem_springs *to) {
  *to = (libcdem_springs){.form = (libcdem_form)from->form,
                          .size = from->size,
                          .terms = from->rows,
                          .cond = from->cond};
  for (int r = 0; r < from->rows; r++) {
    const cdem_spring_row *row = &from->row[r];
    libcdem_term *term = &to->term[r];
    term->stiffness = row->stiffness;
    term->coupling = row->coupling;
    memcpy(term->dir, row->dir, sizeof term->dir);
    memcpy(term->dual, row->dual, sizeof term->dual);
    term->spring = row->spring;
    term->couples_to = row->couples_to;
  }
}

static cdem_status from_block(int size, const double *block, bool frame, libcdem_springs *springs,
                              cdem_fault *fault) {
  cdem_spring_set set;
  CDEM_REQUIRE(size == 2 || size == 3, fault, CDEM_USAGE, "size %d: a block has 2 or 3 rows", size);
  CDEM_TRY(cdem_api_want(block, "a block", fault));
  CDEM_TRY(cdem_api_want(springs, "a place for the springs", fault));
  CDEM_TRY(cdem_springs_from_block(block, size, frame, &set, fault));
  cdem_api_springs(&set, springs);
  return CDEM_OK;
}

libcdem_status libcdem_springs_of_block(int size, const double *block, bool frame,
                                        libcdem_springs *springs, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(from_block(size, block, frame, springs, &own), &own, fault);
}

void libcdem_springs_rebuild(const libcdem_springs *springs, double *block) {
  cdem_spring_set set = {.cond = springs->cond,
                         .form = (uint8_t)springs->form,
                         .size = (uint8_t)springs->size,
                         .rows = (uint8_t)springs->terms};
  for (int r = 0; r < set.rows; r++) {
    const libcdem_term *term = &springs->term[r];
    cdem_spring_row *row = &set.row[r];
    row->stiffness = term->stiffness;
    row->coupling = term->coupling;
    memcpy(row->dir, term->dir, sizeof row->dir);
    memcpy(row->dual, term->dual, sizeof row->dual);
    row->spring = (int8_t)term->spring;
    row->couples_to = (int8_t)term->couples_to;
  }
  cdem_springs_rebuild(&set, block);
}
