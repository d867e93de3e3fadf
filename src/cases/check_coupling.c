/* Checks of a coupled case: grains inside a body. */
#include "cases/check.h"

#include <string.h>

static cdem_status check_region(const cdem_case *cases, int64_t index, cdem_fault *fault) {
  const cdem_case_region *region = &cases->values.coupling.regions.item[index];
  char key[CDEM_CASE_PATH];
  for (int k = 0; k < cases->values.grains.dimension; k++)
    if (!(region->high[k] > region->low[k]))
      return cdem_case_fail(cases, cdem_case_item_key(key, "coupling.regions", index, ""),
                            CDEM_INPUT, fault,
                            "a fine region needs 'high' above 'low' in each direction; along %c "
                            "they are %g and %g m",
                            "xyz"[k], region -> high[k], region -> low[k]);
  return CDEM_OK;
}

/* What would need the deleted elements, or grains that are not there. */
static cdem_status check_foreign(const cdem_case *cases, cdem_fault *fault) {
  static const char *const foreign[][2] = {
      {"initial", "a coupled run starts at rest"},
      {"stop_when", "let the run go to its end, so that its versions can be compared"}};
  for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
    if (cdem_case_given(cases, foreign[i][0]))
      return cdem_case_fail(cases, foreign[i][0], CDEM_INPUT, fault,
                            "'%s' has no meaning in a coupled run; %s", foreign[i][0],
                            foreign[i][1]);
  return CDEM_OK;
}

/* Walls are those of grains; a medium without grains would not know that it is pushed. */
static cdem_status check_walls(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  char key[CDEM_CASE_PATH];
  for (int64_t w = 0; w < v->walls.count; w++) {
    bool met = false;
    for (int64_t p = 0; p < v->plates.count; p++)
      met = met || strcmp(v->plates.item[p].name, v->walls.item[w].name) == 0;
    if (!met)
      return cdem_case_fail(
          cases, cdem_case_named_key(key, "walls", v->walls.item[w].name, ""), CDEM_INPUT, fault,
          "the version 'continuum' has no grains that this wall could push; add a plate of the "
          "same name to 'plates'");
  }
  return CDEM_OK;
}

cdem_status cdem_case_check_coupling(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_coupling *c = &cases->values.coupling;
  if (c->regions.count == 0)
    return cdem_case_fail(cases, "coupling", CDEM_INPUT, fault,
                          "a coupled case needs 'regions': the boxes in which grains are "
                          "calculated");
  for (int64_t i = 0; i < c->regions.count; i++)
    CDEM_TRY(check_region(cases, i, fault));
  if (c->version == CDEM_VERSION_CONTINUUM)
    CDEM_TRY(check_walls(cases, fault));
  return check_foreign(cases, fault);
}
