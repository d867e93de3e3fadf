/* Checks that join several keys: the analysis as a whole; the parts are in check_*.c. */
#include "cases/check.h"

#include <math.h>
#include <stdio.h>

const char *cdem_case_item_key(char path[CDEM_CASE_PATH], const char *section, int64_t index,
                               const char *key) {
  snprintf(path, CDEM_CASE_PATH, "%s[%d]%s%s", section, (int)index, *key != '\0' ? "." : "", key);
  return path;
}

const char *cdem_case_named_key(char path[CDEM_CASE_PATH], const char *section, const char *name,
                                const char *key) {
  snprintf(path, CDEM_CASE_PATH, "%s.%s%s%s", section, name, *key != '\0' ? "." : "", key);
  return path;
}

cdem_status cdem_case_check_exclusive(const cdem_case *cases, const char *prefix, const char *one,
                                      const char *other, cdem_fault *fault) {
  char first[CDEM_CASE_PATH], second[CDEM_CASE_PATH];
  const char *dot = *prefix != '\0' ? "." : "";
  snprintf(first, sizeof first, "%s%s%s", prefix, dot, one);
  snprintf(second, sizeof second, "%s%s%s", prefix, dot, other);
  if (cdem_case_given(cases, first) && cdem_case_given(cases, second))
    return cdem_case_fail(cases, second, CDEM_INPUT, fault,
                          "'%s' and '%s' cannot both be given; leave one out", one, other);
  return CDEM_OK;
}

/* Keys that an analysis does not know, and what to say. */
static cdem_status check_foreign(const cdem_case *cases, const char *analysis,
                                 const char *const *key, int keys, cdem_fault *fault) {
  for (int k = 0; k < keys; k++)
    if (cdem_case_given(cases, key[k]))
      return cdem_case_fail(cases, key[k], CDEM_INPUT, fault,
                            "'%s' has no meaning in a %s run; leave it out or change 'analysis'",
                            key[k], analysis);
  return CDEM_OK;
}

static cdem_status check_analysis(const cdem_case *cases, cdem_fault *fault) {
  static const char *const moving[] = {
      "plates",       "initial",   "quiet",      "step",          "safety",
      "mass_damping", "stop_when", "stop_below", "local_damping", "checkpoint_every"};
  static const char *const solved[] = {"tolerance", "most_steps"};
  static const char *const timed[] = {"step", "quiet"};
  const cdem_case_values *v = &cases->values;
  if (cdem_case_is_coupled(cases) && v->analysis != CDEM_ANALYSIS_DYNAMIC)
    return cdem_case_fail(cases, "analysis", CDEM_INPUT, fault,
                          "a coupled run goes through time: let 'analysis' be dynamic");
  if (v->analysis == CDEM_ANALYSIS_DYNAMIC) {
    if (isnan(v->end) && !cdem_case_is_triaxial(cases))
      return cdem_case_fail(cases, "analysis", CDEM_INPUT, fault,
                            "a dynamic run needs 'end', the time at which it ends");
    return check_foreign(cases, "dynamic", solved, 2, fault);
  }
  if (v->analysis == CDEM_ANALYSIS_RELAXATION) /* grains relax in time, bodies do not */
    return cdem_case_has_grains(cases) ? CDEM_OK
                                       : check_foreign(cases, "relaxation", timed, 2, fault);
  if (v->contact.active)
    return cdem_case_fail(cases, "contact", CDEM_INPUT, fault,
                          "a static run knows no contact; leave 'contact' out or let 'analysis' be "
                          "relaxation");
  CDEM_TRY(check_foreign(cases, "static", solved, 2, fault));
  return check_foreign(cases, "static", moving, sizeof moving / sizeof *moving, fault);
}

static cdem_status check_contact(const cdem_case *cases, cdem_fault *fault) {
  CDEM_TRY(
      cdem_case_check_exclusive(cases, "contact", "stiffness_factor", "normal_stiffness", fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, "contact", "shear_ratio", "shear_stiffness", fault));
  return CDEM_OK;
}

cdem_status cdem_case_check(const cdem_case *cases, cdem_fault *fault) {
  CDEM_TRY(cdem_case_check_kind(cases, fault));
  CDEM_TRY(cdem_case_check_triaxial(cases, fault));
  CDEM_TRY(check_analysis(cases, fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, "", "step", "safety", fault));
  if (cdem_case_has_grains(cases)) {
    CDEM_TRY(cdem_case_check_grains(cases, fault));
    CDEM_TRY(cdem_case_check_walls(cases, fault));
    CDEM_TRY(cdem_case_check_cell(cases, fault));
  }
  if (cdem_case_given(cases, "mesh")) {
    CDEM_TRY(cdem_case_check_mesh(cases, fault));
    CDEM_TRY(cdem_case_check_materials(cases, fault));
    CDEM_TRY(cdem_case_check_interfaces(cases, fault));
    CDEM_TRY(check_contact(cases, fault));
    CDEM_TRY(cdem_case_check_supports(cases, fault));
    CDEM_TRY(cdem_case_check_loads(cases, fault));
    CDEM_TRY(cdem_case_check_plates(cases, fault));
  }
  if (cdem_case_is_coupled(cases))
    CDEM_TRY(cdem_case_check_coupling(cases, fault));
  CDEM_TRY(cdem_case_check_initial(cases, fault));
  return cdem_case_check_output(cases, fault);
}
