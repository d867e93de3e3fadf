/* Names, and equation (1) read backwards: the block from the rows. */
#include "springs/springs.h"

#include "springs/parts.h"

#include <assert.h>
#include <string.h>

static const char *const form_names[] = {
#define X(NAME, name) #name,
    CDEM_FORMS(X)
#undef X
};

static const char *const class_names[] = {
#define X(NAME, name) #name,
    CDEM_CLASSES(X)
#undef X
};

const char *cdem_form_name(cdem_form form) {
  assert(form < CDEM_FORM_COUNT);
  return form_names[form];
}

const char *cdem_class_name(cdem_class class_) {
  assert(class_ < CDEM_CLASS_COUNT);
  return class_names[class_];
}

static int find_name(const char *const *names, int count, const char *name) {
  int i = 0;
  while (i < count && strcmp(names[i], name) != 0)
    i++;
  return i;
}

cdem_form cdem_form_find(const char *name) {
  return (cdem_form)find_name(form_names, CDEM_FORM_COUNT, name);
}

cdem_class cdem_class_find(const char *name) {
  return (cdem_class)find_name(class_names, CDEM_CLASS_COUNT, name);
}

bool cdem_springs_scale(const double *s, int n, double *scaled, int *exponent) {
  double largest = 0.0;
  for (int i = 0; i < n; i++) {
    if (!isfinite(s[i]))
      return false;
    largest = fabs(s[i]) > largest ? fabs(s[i]) : largest;
  }
  *exponent = largest > 0.0 ? ilogb(largest) : 0;
  /* Two factors, because 2^-exponent of the smallest and largest numbers is none. */
  double first = ldexp(1.0, -*exponent / 2), second = ldexp(1.0, -*exponent - -*exponent / 2);
  for (int i = 0; i < n; i++)
    scaled[i] = s[i] * first * second;
  return true;
}

/* The dual of the first row with this spring number. */
static const double *dual_of(const cdem_spring_set *set, int spring) {
  for (int r = 0; r < set->rows; r++)
    if (set->row[r].spring == spring)
      return set->row[r].dual;
  assert(!"a row couples to a spring that is not in the set");
  return NULL;
}

void cdem_springs_rebuild(const cdem_spring_set *set, double *s) {
  int size = set->size;
  for (int i = 0; i < size * size; i++)
    s[i] = 0.0;
  for (int r = 0; r < set->rows; r++) {
    const cdem_spring_row *row = &set->row[r];
    const double *other = row->couples_to != 0 ? dual_of(set, row->couples_to) : NULL;
    for (int j = 0; j < size; j++) {
      double measure = row->stiffness * row->dual[j];
      if (other != NULL)
        measure += row->coupling * other[j];
      for (int i = 0; i < size; i++)
        s[size * i + j] += row->dir[i] * measure;
    }
  }
}

double cdem_springs_residual(const double *s, const cdem_spring_set *set) {
  double rebuilt[9], scaled[9];
  int n = set->size * set->size, exponent;
  cdem_springs_rebuild(set, rebuilt);
  if (!cdem_springs_scale(s, n, scaled, &exponent))
    return NAN;
  double norm = cdem_frobenius(scaled, n);
  for (int i = 0; i < n; i++)
    rebuilt[i] = ldexp(rebuilt[i], -exponent) - scaled[i];
  double difference = cdem_frobenius(rebuilt, n);
  return difference == 0.0 ? 0.0 : difference / norm; /* infinite for a zero block not rebuilt */
}

double cdem_springs_skew(const double *s, int size) {
  double scaled[9], sum = 0.0;
  int exponent;
  if (!cdem_springs_scale(s, size * size, scaled, &exponent))
    return NAN;
  for (int i = 0; i < size; i++)
    for (int j = 0; j < i; j++) {
      double difference = scaled[size * i + j] - scaled[size * j + i];
      sum += 2.0 * difference * difference;
    }
  return sum == 0.0 ? 0.0 : sqrt(sum) / (2.0 * cdem_frobenius(scaled, size * size));
}
