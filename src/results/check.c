#include "results/results.h"

#include <math.h>
#include <stdlib.h>

const cdem_check_kind_words *cdem_check_kind_find(cdem_check_kind kind) {
  static const cdem_check_kind_words words[CDEM_CHECK_KINDS] = {
      {"unstated", "nobody has said where the reference comes from", false},
#define X(name, text, outside, meaning) {text, meaning, outside},
#include "results/check_kinds.def"
#undef X
  };
  return &words[kind];
}

cdem_status cdem_check_add(cdem_check_list *list, cdem_check check, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&list->check, &list->capacity, list->checks + 1, sizeof check, fault));
  list->check[list->checks++] = check;
  return CDEM_OK;
}

void cdem_check_list_release(cdem_check_list *list) {
  free(list->check);
  *list = (cdem_check_list){0};
}

/* Equality is asked first because infinity minus infinity is no number; every comparison is false
 * for NaN. */
bool cdem_check_passes(const cdem_check *check) {
  if (check->value == check->reference)
    return check->tolerance >= 0.0;
  return fabs(check->value - check->reference) <= check->tolerance && isfinite(check->value);
}
