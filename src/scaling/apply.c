/* The numbers of a case, one after the other; what cannot be scaled. */
#include "cases/places.h"
#include "scaling/scaling.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the walks share. */
typedef struct {
  const cdem_case *cases;
  const cdem_scaling *scaling;
  const cdem_scaling_columns *columns;
  cdem_scaled_list *list;
  cdem_status status;
  cdem_fault *fault;
} applying;

void cdem_scaled_list_release(cdem_scaled_list *list) {
  for (int64_t i = 0; i < list->count; i++)
    free(list->item[i].section);
  free(list->item);
  *list = (cdem_scaled_list){0};
}

static cdem_status add(applying *a, const cdem_scaled *item) {
  cdem_scaled_list *list = a->list;
  CDEM_TRY(cdem_grow(&list->item, &list->capacity, list->count + 1, sizeof *list->item, a->fault));
  list->item[list->count++] = *item;
  return CDEM_OK;
}

/* ---- numbers that the case gives ---- */

/* Fewer grains fill the same domain: by h^dim, as a whole number. */
static cdem_status scale_count(applying *a, const cdem_case_quantity *q, cdem_scaled *item) {
  const cdem_scaling *s = a->scaling;
  if (!s->coarse)
    return CDEM_OK;
  double fewer = s->dim == 2 ? s->ratios.length * s->ratios.length : s->ratios.mass;
  item->factor = 1.0 / fewer;
  item->value = floor(q->value / fewer + 0.5);
  if (q->value > 0.0 && item->value < 1.0)
    return cdem_case_fail(a->cases, q->key, CDEM_INPUT, a->fault,
                          "%.17g grains cannot be coarse-grained by %g: %.3g would be left; take a "
                          "smaller h",
                          q->value, s->ratios.length, q->value / fewer);
  if (item->value >= INT32_MAX)
    return cdem_case_fail(a->cases, q->key, CDEM_INPUT, a->fault,
                          "%.17g grains would become %.3g by h = %g; at most %d can be had: take a "
                          "larger h",
                          q->value, item->value, s->ratios.length, INT32_MAX - 1);
  return CDEM_OK;
}

static cdem_status scale_numbers(applying *a) {
  const cdem_case_places *places = a->cases->places;
  for (int64_t i = 0; i < places->quantities; i++) {
    const cdem_case_quantity *q = &places->quantity[i];
    cdem_scaled item = {.key = q->key,
                        .quantity = i,
                        .dimension = q->dimension,
                        .tag = q->tag,
                        .counts = q->counts};
    item.factor = cdem_scaling_factor(a->scaling, q->dimension, q->tag, q->keeps_rate);
    item.value = item.factor * q->value;
    if (q->counts)
      CDEM_TRY(scale_count(a, q, &item));
    if (q->value != 0.0 && !isnormal(item.value))
      return cdem_case_fail(a->cases, q->key, CDEM_INPUT, a->fault,
                            "%.17g times %g is out of range for a number; take other ratios",
                            q->value, item.factor);
    CDEM_TRY(add(a, &item));
  }
  return CDEM_OK;
}

/* ---- defaults with a dimension ---- */

static bool given_beside(const cdem_case *cases, const char *path, const char *key) {
  char of[CDEM_CASE_PATH];
  snprintf(of, sizeof of, "%.180s%s%.60s", path, *path != '\0' ? "." : "", key);
  return cdem_case_given(cases, of);
}

static void add_defaults(void *context, const char *path, const cdem_case_section *section) {
  applying *a = context;
  for (int k = 0; k < section->keys && a->status == CDEM_OK; k++) {
    const cdem_case_key *key = &section->key[k];
    double factor = cdem_scaling_factor(a->scaling, key->dimension, key->tag, key->keeps_rate);
    if (key->kind != CDEM_KEY_NUMBER || isnan(key->fallback) || key->fallback == 0.0 ||
        factor == 1.0 || given_beside(a->cases, path, key->key) ||
        (key->beside != NULL && !given_beside(a->cases, path, key->beside)) ||
        (key->plane && a->cases->values.grains.dimension == 3))
      continue;
    cdem_scaled item = {.key = key->key,
                        .section = cdem_copy_text(path, a->fault),
                        .added = key->key,
                        .quantity = -1,
                        .dimension = key->dimension,
                        .tag = key->tag,
                        .factor = factor,
                        .value = factor * key->fallback};
    a->status = item.section != NULL ? add(a, &item) : CDEM_MEMORY;
    if (a->status != CDEM_OK)
      free(item.section);
  }
}

/* ---- key results: their dimension is that of a column ---- */

static bool is_expected(const cdem_case_key_result *result) {
  return !isnan(result->reference) || result->against.count > 0;
}

bool cdem_scaling_needs_columns(const cdem_case *cases) {
  for (int64_t i = 0; i < cases->values.results.count; i++)
    if (is_expected(&cases->values.results.item[i]))
      return true;
  return false;
}

static const char *result_key(char key[CDEM_CASE_PATH], const cdem_case_key_result *result,
                              const char *rest) {
  snprintf(key, CDEM_CASE_PATH, "results.%s.%s", result->name, rest);
  return key;
}

static cdem_status column_dimension(applying *a, const cdem_case_key_result *result,
                                    const char *rest, const char *column,
                                    cdem_dimension *dimension) {
  char key[CDEM_CASE_PATH];
  const char *unit = a->columns->unit(a->columns->context, column);
  result_key(key, result, rest);
  if (unit == NULL)
    return cdem_case_fail(a->cases, key, CDEM_INPUT, a->fault,
                          "'%s' is no column of this history, so that the dimension of this result "
                          "is not known",
                          column);
  if (!cdem_dimension_of_unit(unit, dimension))
    return cdem_case_fail(a->cases, key, CDEM_INPUT, a->fault,
                          "the column '%s' has the unit '%s', whose dimension is not known here; "
                          "leave the expected value of this result out",
                          column, unit);
  return CDEM_OK;
}

/* Of what is taken of a column; `factor` counts as a plain number. */
static cdem_status taken_dimension(applying *a, const cdem_case_key_result *result,
                                   cdem_dimension *dimension) {
  if (result->take == CDEM_TAKE_PLACE_OF_MAX || result->take == CDEM_TAKE_PLACE_OF_MIN) {
    *dimension = CDEM_TIME;
    return result->along == NULL ? CDEM_OK
                                 : column_dimension(a, result, "along", result->along, dimension);
  }
  CDEM_TRY(column_dimension(a, result, "of", result->of, dimension));
  dimension->time = (int8_t)(dimension->time - (result->take == CDEM_TAKE_SLOPE));
  return CDEM_OK;
}

static double column_factor(const applying *a, cdem_dimension dimension) {
  return cdem_scaling_factor(a->scaling, dimension, CDEM_TAG_DOMAIN, false);
}

static cdem_scaled *find(const applying *a, const char *key) {
  for (int64_t i = 0; i < a->list->count; i++)
    if (a->list->item[i].added == NULL && strcmp(a->list->item[i].key, key) == 0)
      return &a->list->item[i];
  return NULL;
}

/* Multiplies a number of a result, which is written where it was not given. */
static cdem_status rescale(applying *a, const cdem_case_key_result *result, const char *name,
                           double was, cdem_dimension dimension, double factor) {
  char key[CDEM_CASE_PATH];
  cdem_scaled *there = find(a, result_key(key, result, name));
  if (there != NULL) {
    there->dimension = dimension;
    there->tag = CDEM_TAG_DOMAIN;
    there->factor = factor;
    there->value = factor * was;
    return CDEM_OK;
  }
  if (factor == 1.0)
    return CDEM_OK;
  key[strlen(key) - strlen(name) - 1] = '\0';
  cdem_scaled item = {.section = cdem_copy_text(key, a->fault),
                      .quantity = -1,
                      .dimension = dimension,
                      .tag = CDEM_TAG_DOMAIN,
                      .factor = factor,
                      .value = factor * was};
  item.key = item.added = name;
  cdem_status status = item.section != NULL ? add(a, &item) : CDEM_MEMORY;
  if (status != CDEM_OK)
    free(item.section);
  return status;
}

static cdem_status scale_result(applying *a, const cdem_case_key_result *result) {
  cdem_dimension of = CDEM_DIMENSIONLESS, against = CDEM_DIMENSIONLESS;
  char key[CDEM_CASE_PATH];
  if (!isnan(result->reference)) {
    CDEM_TRY(taken_dimension(a, result, &of));
    return rescale(a, result, "reference", result->reference, of, column_factor(a, of));
  }
  CDEM_TRY(column_dimension(a, result, "of", result->of, &of));
  for (int64_t c = 0; c < result->against.count; c++) {
    cdem_dimension next;
    CDEM_TRY(column_dimension(a, result, "against", result->against.item[c], &next));
    if (c > 0 && memcmp(&next, &against, sizeof next) != 0)
      return cdem_case_fail(a->cases, result_key(key, result, "against"), CDEM_INPUT, a->fault,
                            "'%s' and '%s' have different dimensions, so that their sum cannot be "
                            "scaled; compare them one by one",
                            result->against.item[0], result->against.item[c]);
    against = next;
  }
  const cdem_dimension quotient = {(int8_t)(of.length - against.length),
                                   (int8_t)(of.time - against.time),
                                   (int8_t)(of.mass - against.mass)};
  return rescale(a, result, "against_factor", result->against_factor, quotient,
                 column_factor(a, of) / column_factor(a, against));
}

static cdem_status scale_results(applying *a) {
  const cdem_case_values *values = &a->cases->values;
  for (int64_t i = 0; i < values->results.count; i++)
    if (is_expected(&values->results.item[i]))
      CDEM_TRY(scale_result(a, &values->results.item[i]));
  return CDEM_OK;
}

/* ---- the whole ---- */

/* A triaxial test whose durations are not given has the clock of its grains (run/triaxial.h), which
 * slows down with them whatever is asked for. */
static cdem_status check_rate(const applying *a) {
  const cdem_case_triaxial *t = &a->cases->values.triaxial;
  if (a->scaling->slow || !cdem_case_is_triaxial(a->cases) ||
      (!isnan(t->rate) && !isnan(t->consolidation)))
    return CDEM_OK;
  return cdem_case_fail(a->cases, "triaxial", CDEM_INPUT, a->fault,
                        "the durations of this triaxial test follow from the size of its grains; "
                        "give it 'consolidation' and 'rate' to keep them, or leave --keep-rate "
                        "out");
}

/* A window of larger grains wants grains that are made by a rule. */
static cdem_status check_coarse(const applying *a) {
  const cdem_case_places *places = a->cases->places;
  if (cdem_case_given(a->cases, "grains.file"))
    return cdem_case_fail(a->cases, "grains.file", CDEM_INPUT, a->fault,
                          "grains of a file cannot be coarse-grained: their places and number are "
                          "fixed; give a 'packing', or a file of larger grains");
  CDEM_TRY(check_rate(a));
  for (int64_t i = 0; i < places->quantities; i++)
    if (places->quantity[i].tag == CDEM_TAG_GRAIN && places->quantity[i].dimension.length == 1 &&
        places->quantity[i].dimension.time == 0 && places->quantity[i].dimension.mass == 0)
      return CDEM_OK;
  return cdem_case_fail(a->cases, "", CDEM_INPUT, a->fault,
                        "coarse graining makes grains larger, and this case has no size of grains; "
                        "leave --coarse-grain out to scale all of it");
}

/* A relaxation of a body has fictitious masses and a step of 1 s, whatever its size: a clock of its
 * own. What is given in seconds, or per second, would have to scale with it. */
static cdem_status check_clock(const applying *a) {
  const cdem_case_places *places = a->cases->places;
  if (a->cases->values.analysis != CDEM_ANALYSIS_RELAXATION || cdem_case_has_grains(a->cases) ||
      a->scaling->ratios.time == 1.0)
    return CDEM_OK;
  for (int64_t i = 0; i < places->quantities; i++) {
    const cdem_case_quantity *q = &places->quantity[i];
    bool timed = q->dimension.mass == 0 && (q->dimension.time == 1 || q->dimension.time == -1);
    if (timed && q->value != 0.0)
      return cdem_case_fail(a->cases, q->key, CDEM_INPUT, a->fault,
                            "a relaxation of a body counts its steps as seconds, whatever its "
                            "size, so that '%s' cannot be scaled; leave it out, or let 'analysis' "
                            "be dynamic",
                            q->key);
  }
  return CDEM_OK;
}

cdem_status cdem_scaling_apply(const cdem_case *cases, const cdem_scaling *scaling,
                               const cdem_scaling_columns *columns, cdem_scaled_list *list,
                               cdem_fault *fault) {
  cdem_scaled_list made = {0};
  applying a = {cases, scaling, columns, &made, CDEM_OK, fault};
  a.status = scaling->coarse ? check_coarse(&a) : CDEM_OK;
  if (a.status == CDEM_OK)
    a.status = check_clock(&a);
  if (a.status == CDEM_OK)
    a.status = scale_numbers(&a);
  if (a.status == CDEM_OK)
    cdem_case_walk_given(cases, add_defaults, &a);
  if (a.status == CDEM_OK && columns != NULL)
    a.status = scale_results(&a);
  if (a.status == CDEM_OK)
    *list = made;
  else
    cdem_scaled_list_release(&made);
  return a.status;
}
