/* Checks of a triaxial test. */
#include "cases/check.h"

#include <math.h>

static cdem_status refuse(const cdem_case *cases, const char *key, const char *instead,
                          cdem_fault *fault) {
  if (!cdem_case_given(cases, key))
    return CDEM_OK;
  return cdem_case_fail(cases, key, CDEM_INPUT, fault, "'%s' has no meaning in a triaxial test; %s",
                        key, instead);
}

static cdem_status check_specimen(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  if (!cdem_case_has_grains(cases) || cdem_case_is_coupled(cases))
    return cdem_case_fail(cases, "triaxial", CDEM_INPUT, fault,
                          "a triaxial test is one of 'grains' alone");
  if (v->grains.dimension != 3)
    return cdem_case_fail(cases, "triaxial", CDEM_INPUT, fault,
                          "a triaxial test is one of spheres: let 'grains.dimension' be 3");
  if (v->grains.file == NULL && !v->grains.packing.cylinder)
    return cdem_case_fail(cases, "grains.packing", CDEM_INPUT, fault,
                          "the specimen of a triaxial test is a cylinder: add 'cylinder: yes'");
  if (v->analysis != CDEM_ANALYSIS_DYNAMIC)
    return cdem_case_fail(cases, "analysis", CDEM_INPUT, fault,
                          "a triaxial test goes through time: let 'analysis' be dynamic");
  return CDEM_OK;
}

cdem_status cdem_case_check_triaxial(const cdem_case *cases, cdem_fault *fault) {
  static const char *const foreign[][2] = {
      {"end", "it follows from 'consolidation', 'rate' and 'strain'"},
      {"walls", "its plates and its side are made by 'triaxial'"},
      {"cell", "its side is a membrane or a cylinder"}};
  const cdem_case_triaxial *t = &cases->values.triaxial;
  if (!cdem_case_is_triaxial(cases))
    return CDEM_OK;
  for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
    CDEM_TRY(refuse(cases, foreign[i][0], foreign[i][1], fault));
  CDEM_TRY(check_specimen(cases, fault));
  CDEM_TRY(cdem_case_check_exclusive(cases, "triaxial", "rate", "inertial_number", fault));
  if (t->boundary == CDEM_TRIAXIAL_CYLINDER && cdem_case_given(cases, "triaxial.membrane"))
    return cdem_case_fail(cases, "triaxial.membrane", CDEM_INPUT, fault,
                          "'membrane' has a meaning beside 'boundary: membrane' only");
  if (t->boundary == CDEM_TRIAXIAL_MEMBRANE && t->side_material != NULL)
    return cdem_case_fail(cases, "triaxial.side_material", CDEM_INPUT, fault,
                          "'side_material' has a meaning beside 'boundary: cylinder' only");
  CDEM_TRY(cdem_case_check_grain_material(cases, "triaxial.material", t->material, fault));
  return cdem_case_check_grain_material(cases, "triaxial.side_material", t->side_material, fault);
}
