#include "dem/law.h"

#include "base/suggest.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define X(identifier, name) extern const cdem_law cdem_law_##identifier;
#include "dem/laws.def"
#undef X
#define ROLLING(name)  extern const cdem_resistance cdem_rolling_##name;
#define TWISTING(name) extern const cdem_resistance cdem_twisting_##name;
#include "dem/resistances.def"
#undef ROLLING
#undef TWISTING

static const cdem_law_key_info keys[] = {
#define X(name, length, time, mass, help) {#name, {length, time, mass}, help},
#include "dem/law_keys.def"
#undef X
};

static const cdem_law *const laws[] = {
#define X(identifier, name) &cdem_law_##identifier,
#include "dem/laws.def"
#undef X
};

static const cdem_resistance *const rollings[] = {
#define ROLLING(name) &cdem_rolling_##name,
#define TWISTING(name)
#include "dem/resistances.def"
#undef ROLLING
#undef TWISTING
};

static const cdem_resistance *const twistings[] = {
#define ROLLING(name)
#define TWISTING(name) &cdem_twisting_##name,
#include "dem/resistances.def"
#undef ROLLING
#undef TWISTING
};

enum {
  LAWS = sizeof laws / sizeof *laws,
  ROLLINGS = sizeof rollings / sizeof *rollings,
  TWISTINGS = sizeof twistings / sizeof *twistings
};

const cdem_law_key_info *cdem_law_key_get(int key) {
  return key >= 0 && key < CDEM_LAW_KEYS ? &keys[key] : NULL;
}

const cdem_law *cdem_law_at(int index) {
  return index >= 0 && index < LAWS ? laws[index] : NULL;
}

const cdem_resistance *cdem_rolling_at(int index) {
  return index >= 0 && index < ROLLINGS ? rollings[index] : NULL;
}

const cdem_resistance *cdem_twisting_at(int index) {
  return index >= 0 && index < TWISTINGS ? twistings[index] : NULL;
}

const cdem_law *cdem_law_find(const char *name) {
  for (int i = 0; i < LAWS; i++)
    if (strcmp(laws[i]->name, name) == 0)
      return laws[i];
  return NULL;
}

const cdem_resistance *cdem_rolling_find(const char *name) {
  for (int i = 0; i < ROLLINGS; i++)
    if (strcmp(rollings[i]->name, name) == 0)
      return rollings[i];
  return NULL;
}

const cdem_resistance *cdem_twisting_find(const char *name) {
  for (int i = 0; i < TWISTINGS; i++)
    if (strcmp(twistings[i]->name, name) == 0)
      return twistings[i];
  return NULL;
}

/* One word as a law or resistance (`who`, `name`) wants it: its range, or its default. */
static cdem_status take(const cdem_law_want *want, const char *who, const char *name,
                        cdem_contact_input *input, cdem_fault *fault) {
  double *value = &input->value[want->key];
  const char *word = keys[want->key].name;
  char unit[48];
  cdem_dimension_unit(keys[want->key].dimension, unit);
  if (isnan(*value)) {
    CDEM_REQUIRE(!want->required, fault, CDEM_INPUT, "%s '%s' needs '%s' (%s%s%s)", who, name, word,
                 keys[want->key].help, unit[0] ? " Unit: " : "", unit);
    *value = want->fallback;
    return CDEM_OK;
  }
  CDEM_REQUIRE(isfinite(*value), fault, CDEM_INPUT, "'%s' is not finite", word);
  if (want->least == want->most)
    return CDEM_OK;
  CDEM_REQUIRE(want->above ? *value > want->least : *value >= want->least, fault, CDEM_INPUT,
               "'%s' = %g must %s %g", word, *value, want->above ? "exceed" : "be at least",
               want->least);
  CDEM_REQUIRE(*value <= want->most, fault, CDEM_INPUT, "'%s' = %g must be at most %g", word,
               *value, want->most);
  return CDEM_OK;
}

/* A word that was given although nobody wants it. */
static cdem_status refuse_others(const cdem_contact_model *model, const cdem_contact_input *input,
                                 cdem_fault *fault) {
  const char *wanted[CDEM_LAW_KEYS] = {NULL};
  for (int i = 0; i < model->law->wants; i++)
    wanted[model->law->want[i].key] = keys[model->law->want[i].key].name;
  for (int i = 0; i < model->rolling->wants; i++)
    wanted[model->rolling->want[i].key] = keys[model->rolling->want[i].key].name;
  for (int i = 0; i < model->twisting->wants; i++)
    wanted[model->twisting->want[i].key] = keys[model->twisting->want[i].key].name;
  for (int key = 0; key < CDEM_LAW_KEYS; key++) {
    if (isnan(input->value[key]) || wanted[key] != NULL)
      continue;
    const char *near = cdem_suggest(keys[key].name, wanted, CDEM_LAW_KEYS);
    return cdem_fail(
        fault, CDEM_INPUT,
        "'%s' is not used by law '%s' with rolling '%s' and twisting '%s'%s%s%s; leave "
        "it out or choose another law or resistance",
        keys[key].name, model->law->name, model->rolling->name, model->twisting->name,
        near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
  }
  return CDEM_OK;
}

static cdem_status check_choice(int dim, const cdem_contact_model *model, cdem_fault *fault) {
  const cdem_law *law = model->law;
  CDEM_REQUIRE(law->dims[dim], fault, CDEM_INPUT, "law '%s' does not know %s: %s", law->name,
               dim == 2 ? "discs" : "spheres", law->why);
  bool resists = model->rolling != rollings[0] || model->twisting != twistings[0];
  CDEM_REQUIRE(!law->rolls || !resists, fault, CDEM_INPUT,
               "law '%s' has rolling resistance of its own: it goes with rolling '%s' and twisting "
               "'%s' only, not with '%s' and '%s'",
               law->name, rollings[0]->name, twistings[0]->name, model->rolling->name,
               model->twisting->name);
  CDEM_REQUIRE(dim == 3 || model->twisting == twistings[0], fault, CDEM_INPUT,
               "discs do not twist: choose twisting '%s' instead of '%s'", twistings[0]->name,
               model->twisting->name);
  return CDEM_OK;
}

static cdem_status prepare(int dim, cdem_contact_input *input, const cdem_grain_material *a,
                           const cdem_grain_material *b, cdem_contact_model *model,
                           cdem_fault *fault) {
  const cdem_law *law = model->law;
  const cdem_resistance *beside[2] = {model->rolling, model->twisting};
  static const char *const who[2] = {"rolling resistance", "twisting resistance"};
  for (int i = 0; i < law->wants; i++)
    CDEM_TRY(take(&law->want[i], "law", law->name, input, fault));
  for (int r = 0; r < 2; r++)
    for (int i = 0; i < beside[r]->wants; i++)
      CDEM_TRY(take(&beside[r]->want[i], who[r], beside[r]->name, input, fault));
  CDEM_TRY(law->prepare(dim, input, a, b, &model->parameters[0], fault));
  double shear = law->shear_stiffness != NULL ? law->shear_stiffness(&model->parameters[0]) : 0.0;
  for (int r = 0; r < 2; r++)
    if (beside[r]->prepare != NULL)
      CDEM_TRY(beside[r]->prepare(dim, input, shear, &model->parameters[1 + r], fault));
  return CDEM_OK;
}

/* Where each history begins, and what exchange makes of it. */
static void lay_out(int dim, cdem_contact_model *model) {
  const cdem_resistance *beside[2] = {model->rolling, model->twisting};
  int d = dim - 2, next = 0;
  model->first[0] = 0;
  for (int k = 0; k < model->law->history[d]; k++)
    model->parity[next++] = model->law->parity[d][k];
  for (int r = 0; r < 2; r++) {
    model->first[1 + r] = next;
    for (int k = 0; k < beside[r]->history[d]; k++)
      model->parity[next++] = beside[r]->parity[d][k];
  }
  model->histories = next;
}

cdem_status cdem_contact_model_init(int dim, const cdem_law *law, const cdem_resistance *rolling,
                                    const cdem_resistance *twisting,
                                    const cdem_contact_input *input, const cdem_grain_material *a,
                                    const cdem_grain_material *b, cdem_contact_model *model,
                                    cdem_fault *fault) {
  assert(dim == 2 || dim == 3);
  cdem_fault own = {0};
  cdem_contact_model made = {.law = law,
                             .rolling = rolling != NULL ? rolling : rollings[0],
                             .twisting = twisting != NULL ? twisting : twistings[0]};
  cdem_contact_input filled = *input;
  cdem_status status = check_choice(dim, &made, &own);
  if (status == CDEM_OK)
    status = refuse_others(&made, input, &own);
  if (status == CDEM_OK)
    status = prepare(dim, &filled, a, b, &made, &own);
  if (status != CDEM_OK)
    return cdem_fail(fault, status, "contact of '%.63s' with '%.63s': %.800s", a->name, b->name,
                     own.message);
  lay_out(dim, &made);
  made.arms_by_radius = filled.value[CDEM_LAW_arms_by_radius] == 1.0;
  *model = made;
  return CDEM_OK;
}
