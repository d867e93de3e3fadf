/* Checks of what acts on the body and of what is kept of a run. */
#include "cases/check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const component_names[4] = {"x", "y", "z", "rotation"};

static int count_given(const cdem_case_components *components) {
  int count = 0;
  for (int c = 0; c < 4; c++)
    count += components->given[c];
  return count;
}

static cdem_status check_rotation(const cdem_case *cases, const cdem_case_components *components,
                                  const char *section, int64_t index, const char *name,
                                  cdem_fault *fault) {
  char path[CDEM_CASE_PATH], key[CDEM_CASE_PATH];
  if (!components->given[3] || cases->values.cosserat)
    return CDEM_OK;
  snprintf(path, sizeof path, "%s.rotation", name);
  return cdem_case_fail(cases, cdem_case_item_key(key, section, index, path), CDEM_INPUT, fault,
                        "'rotation' is a degree of freedom of Cosserat materials only; leave it "
                        "out");
}

/* ---- supports ---- */

cdem_status cdem_case_check_supports(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  char key[CDEM_CASE_PATH], name[32];
  for (int64_t i = 0; i < v->supports.count; i++) {
    const cdem_case_support *support = &v->supports.item[i];
    if (count_given(&support->displacement) + count_given(&support->velocity) == 0)
      return cdem_case_fail(cases, cdem_case_item_key(key, "supports", i, ""), CDEM_INPUT, fault,
                            "a support needs a component of 'displacement' or 'velocity'");
    for (int c = 0; c < 4; c++) {
      snprintf(name, sizeof name, "velocity.%s", component_names[c]);
      cdem_case_item_key(key, "supports", i, name);
      if (support->displacement.given[c] && support->velocity.given[c])
        return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                              "'displacement' and 'velocity' cannot both prescribe '%s'",
                              component_names[c]);
      if (support->velocity.given[c] && v->analysis == CDEM_ANALYSIS_STATIC)
        return cdem_case_fail(
            cases, key, CDEM_INPUT, fault,
            "'velocity' has no meaning in a static run; prescribe 'displacement'");
    }
    CDEM_TRY(check_rotation(cases, &support->displacement, "supports", i, "displacement", fault));
    CDEM_TRY(check_rotation(cases, &support->velocity, "supports", i, "velocity", fault));
  }
  return CDEM_OK;
}

/* ---- loads ---- */

static cdem_status check_kirsch(const cdem_case *cases, int64_t i, cdem_fault *fault) {
  const cdem_case_load *load = &cases->values.loads.item[i];
  char key[CDEM_CASE_PATH], center[CDEM_CASE_PATH];
  bool tension = !isnan(load->kirsch_tension), radius = !isnan(load->kirsch_radius);
  if (tension && !radius)
    return cdem_case_fail(cases, cdem_case_item_key(key, "loads", i, "kirsch_tension"), CDEM_INPUT,
                          fault, "'kirsch_tension' needs 'kirsch_radius' beside it");
  cdem_case_item_key(key, "loads", i, "kirsch_radius");
  cdem_case_item_key(center, "loads", i, "kirsch_center");
  if (!tension && (radius || cdem_case_given(cases, center)))
    return cdem_case_fail(cases, radius ? key : center, CDEM_INPUT, fault,
                          "'%s' has a meaning beside 'kirsch_tension' only",
                          radius ? "kirsch_radius" : "kirsch_center");
  return CDEM_OK;
}

cdem_status cdem_case_check_loads(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  char key[CDEM_CASE_PATH];
  for (int64_t i = 0; i < v->loads.count; i++) {
    const cdem_case_load *load = &v->loads.item[i];
    int kinds = (count_given(&load->force) > 0) + (count_given(&load->traction) > 0) +
                load->has_pressure + !isnan(load->kirsch_tension);
    CDEM_TRY(check_kirsch(cases, i, fault));
    if (kinds != 1)
      return cdem_case_fail(cases, cdem_case_item_key(key, "loads", i, ""), CDEM_INPUT, fault,
                            "a load needs exactly one of 'force', 'traction', 'pressure', "
                            "'kirsch_tension', not %d; write one entry for each",
                            kinds);
    CDEM_TRY(check_rotation(cases, &load->force, "loads", i, "force", fault));
  }
  return CDEM_OK;
}

/* ---- plates and initial velocities ---- */

static double size_of(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

cdem_status cdem_case_check_plates(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  char key[CDEM_CASE_PATH], prefix[CDEM_CASE_PATH];
  for (int64_t i = 0; i < v->plates.count; i++) {
    const cdem_case_plate *plate = &v->plates.item[i];
    cdem_case_named_key(prefix, "plates", plate->name, "");
    CDEM_TRY(
        cdem_case_check_exclusive(cases, prefix, "stiffness_factor", "normal_stiffness", fault));
    if (!(size_of(plate->normal) > 0.0))
      return cdem_case_fail(cases, cdem_case_named_key(key, "plates", plate->name, "normal"),
                            CDEM_INPUT, fault, "the normal of a plate must not be zero");
    double cross[3], size = size_of(plate->normal) * size_of(plate->axis);
    cdem_cross3(plate->normal, plate->axis, cross);
    cdem_case_named_key(key, "plates", plate->name, "axis");
    /* a sine of 1e-6 keeps ten digits of the direction in the face */
    if (cdem_case_given(cases, key) && !(size_of(cross) > 1e-6 * size))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "the axis of a plate must not be zero or along its normal");
  }
  return CDEM_OK;
}

cdem_status cdem_case_check_initial(const cdem_case *cases, cdem_fault *fault) {
  char key[CDEM_CASE_PATH], spin[CDEM_CASE_PATH];
  for (int64_t i = 0; i < cases->values.initial.count; i++) {
    if (cdem_case_has_grains(cases) && cases->values.initial.item[i].groups.count > 0)
      return cdem_case_fail(cases, cdem_case_item_key(key, "initial", i, "groups"), CDEM_INPUT,
                            fault,
                            "'groups' has no meaning for grains: an initial motion is that of all; "
                            "give single grains theirs in the columns of grains.file");
    cdem_case_item_key(spin, "initial", i, "spin");
    cdem_case_item_key(key, "initial", i, "velocity");
    if (!cdem_case_given(cases, key) && !cdem_case_given(cases, spin))
      return cdem_case_fail(cases, cdem_case_item_key(key, "initial", i, ""), CDEM_INPUT, fault,
                            "an initial motion needs 'velocity' or 'spin'");
    cdem_case_item_key(key, "initial", i, "center");
    if (cdem_case_given(cases, key) && !cdem_case_given(cases, spin))
      return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                            "'center' has a meaning beside 'spin' only");
  }
  return CDEM_OK;
}

/* ---- probes, results, the end ---- */

enum { ROTATION = 3, FIRST_TENSOR = 4, MAGNITUDE = 10 }; /* of the components of probes */

static cdem_status probe_fail(const cdem_case *cases, const cdem_case_probe *probe,
                              const char *rest, const char *message, cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  return cdem_case_fail(cases, cdem_case_named_key(key, "probes", probe->name, rest), CDEM_INPUT,
                        fault, "%s", message);
}

static cdem_status probe_needs(const cdem_case *cases, const cdem_case_probe *probe,
                               const char *rest, cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  cdem_case_named_key(key, "probes", probe->name, "");
  return cdem_case_fail(cases, key, CDEM_INPUT, fault, "%s needs '%s'", key, rest);
}

static bool probe_gives(const cdem_case *cases, const cdem_case_probe *probe, const char *rest) {
  char key[CDEM_CASE_PATH];
  return cdem_case_given(cases, cdem_case_named_key(key, "probes", probe->name, rest));
}

static cdem_status check_probe_of_body(const cdem_case *cases, const cdem_case_probe *probe,
                                       cdem_fault *fault) {
  if (probe->group == NULL)
    return probe_needs(cases, probe, "group", fault);
  if (probe->quantity > CDEM_PROBE_STRESS)
    return probe_fail(cases, probe, "quantity",
                      "a body has displacement, velocity, force and stress; this quantity is one "
                      "of grains",
                      fault);
  if (probe_gives(cases, probe, "region"))
    return probe_fail(cases, probe, "region",
                      "'region' has a meaning for grains only; name a 'group' of the mesh", fault);
  if (!probe_gives(cases, probe, "component"))
    return probe_needs(cases, probe, "component", fault);
  if (probe->component == ROTATION && !cases->values.cosserat)
    return probe_fail(cases, probe, "component",
                      "'rotation' is a degree of freedom of Cosserat materials only", fault);
  return CDEM_OK;
}

static bool is_tensor(const cdem_case_probe *probe) {
  return probe->quantity == CDEM_PROBE_STRESS || probe->quantity == CDEM_PROBE_FABRIC;
}

static cdem_status check_probe_of_grains(const cdem_case *cases, const cdem_case_probe *probe,
                                         cdem_fault *fault) {
  bool vector = probe->quantity == CDEM_PROBE_VELOCITY || probe->quantity == CDEM_PROBE_CENTER,
       flat = cases->values.grains.dimension == 2,
       component = probe_gives(cases, probe, "component");
  if (probe->group != NULL)
    return probe_fail(cases, probe, "group",
                      "'group' has no meaning for grains, which have no mesh; give a 'region'",
                      fault);
  if (probe->quantity == CDEM_PROBE_DISPLACEMENT || probe->quantity == CDEM_PROBE_FORCE)
    return probe_fail(
        cases, probe, probe_gives(cases, probe, "quantity") ? "quantity" : "",
        "grains have the quantities velocity, center, stress, count, mass, solid, "
        "coordination, surface_angle, center, stress_ratio, band_angle, band_slenderness, "
        "mean_push, boundary_push, fabric, anisotropy, mechanical_coordination and rattlers; the "
        "force on a wall is a column already, wall.NAME.fx",
        fault);
  if ((vector || is_tensor(probe)) && !component)
    return probe_needs(cases, probe, "component", fault);
  if (!vector && !is_tensor(probe) && component)
    return probe_fail(cases, probe, "component",
                      "'component' has no meaning for a quantity that is one number; leave it out",
                      fault);
  if (component && (probe->component == ROTATION ||
                    (flat && (probe->component == 2 || (probe->component > FIRST_TENSOR + 1 &&
                                                        probe->component < MAGNITUDE - 1)))))
    return probe_fail(cases, probe, "component",
                      flat ? "grains in 2-D have the components x, y, xx, yy, xy and magnitude"
                           : "grains have the components x, y, z, xx .. xy and magnitude",
                      fault);
  if (!flat &&
      (probe->quantity == CDEM_PROBE_BAND_ANGLE || probe->quantity == CDEM_PROBE_BAND_SLENDERNESS))
    return probe_fail(cases, probe, "quantity",
                      "bands are found in two dimensions; in three they are surfaces", fault);
  if (probe_gives(cases, probe, "surface") && probe->quantity != CDEM_PROBE_SURFACE_ANGLE)
    return probe_fail(cases, probe, "surface",
                      "'surface' has a meaning beside 'quantity: surface_angle' only", fault);
  return CDEM_OK;
}

static cdem_status check_probe(const cdem_case *cases, const cdem_case_probe *probe,
                               cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  bool tensor = probe->component >= FIRST_TENSOR && probe->component < MAGNITUDE;
  if (strcmp(probe->name, "time") == 0)
    return cdem_case_fail(cases, cdem_case_named_key(key, "probes", probe->name, ""), CDEM_INPUT,
                          fault, "'%s' is a column of every history; give the probe another name",
                          probe->name);
  if (is_tensor(probe) && !tensor && probe_gives(cases, probe, "component"))
    return probe_fail(cases, probe, "component",
                      probe->quantity == CDEM_PROBE_STRESS
                          ? "a stress has the components xx yy zz yz xz xy"
                          : "a fabric has the components xx yy zz yz xz xy",
                      fault);
  if (!is_tensor(probe) && tensor)
    return probe_fail(cases, probe, "component",
                      "displacement, velocity and force have the components x y z rotation "
                      "magnitude; xx .. xy are those of 'quantity: stress'",
                      fault);
  bool of_grains = cdem_case_has_grains(cases);
  if (cdem_case_is_coupled(cases)) /* of the body by a group, of the grains by a region */
    of_grains = probe->group == NULL;
  return of_grains ? check_probe_of_grains(cases, probe, fault)
                   : check_probe_of_body(cases, probe, fault);
}

static cdem_status result_fail(const cdem_case *cases, const cdem_case_key_result *result,
                               const char *rest, const char *message, cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  return cdem_case_fail(cases, cdem_case_named_key(key, "results", result->name, rest), CDEM_INPUT,
                        fault, "%s", message);
}

static cdem_status check_result(const cdem_case *cases, const cdem_case_key_result *result,
                                cdem_fault *fault) {
  char key[CDEM_CASE_PATH];
  bool number = !isnan(result->reference), columns = result->against.count > 0,
       place = result->take == CDEM_TAKE_PLACE_OF_MAX || result->take == CDEM_TAKE_PLACE_OF_MIN;
  if (result->along != NULL && !place)
    return result_fail(cases, result, "along",
                       "'along' has a meaning beside 'take: place_of_max' and 'take: place_of_min' "
                       "only",
                       fault);
  if (!isnan(result->tolerance) && !number && !columns)
    return result_fail(cases, result, "tolerance", "'tolerance' needs 'reference' beside it",
                       fault);
  if (number && columns)
    return result_fail(cases, result, "against",
                       "the expected value is 'reference' or 'against', not both", fault);
  if (!columns &&
      cdem_case_given(cases, cdem_case_named_key(key, "results", result->name, "against_factor")))
    return result_fail(cases, result, "against_factor", "'against_factor' needs 'against'", fault);
  if (result->from >= result->to) /* false with NaN */
    return result_fail(cases, result, "to", "'to' must be later than 'from'", fault);
  if (result->from >= cases->values.end)
    return result_fail(cases, result, "from", "'from' must be earlier than 'end'", fault);
  return CDEM_OK;
}

/* A unit that was forgotten must not fill the disk. */
static cdem_status check_often(const cdem_case *cases, const char *key, double every, double most,
                               cdem_fault *fault) {
  double times = cases->values.end / every;
  if (!(times > most)) /* true without an end */
    return CDEM_OK;
  return cdem_case_fail(cases, key, CDEM_INPUT, fault,
                        "'%s' of %g s comes %.3g times until the end at %g s, more than %g times; "
                        "look at the units of both",
                        key, every, times, cases->values.end, most);
}

cdem_status cdem_case_check_output(const cdem_case *cases, cdem_fault *fault) {
  const cdem_case_values *v = &cases->values;
  CDEM_TRY(check_often(cases, "history_every", v->history_every, 1e8, fault));
  CDEM_TRY(check_often(cases, "frame_every", v->frame_every, 1e6, fault));
  CDEM_TRY(check_often(cases, "checkpoint_every", v->checkpoint_every, 1e8, fault));
  for (int64_t i = 0; i < v->probes.count; i++)
    CDEM_TRY(check_probe(cases, &v->probes.item[i], fault));
  for (int64_t i = 0; i < v->results.count; i++)
    CDEM_TRY(check_result(cases, &v->results.item[i], fault));
  if (v->stop_when != NULL && isnan(v->stop_below))
    return cdem_case_fail(cases, "stop_when", CDEM_INPUT, fault,
                          "'stop_when' needs 'stop_below' beside it");
  if (v->stop_when == NULL && !isnan(v->stop_below))
    return cdem_case_fail(cases, "stop_below", CDEM_INPUT, fault,
                          "'stop_below' needs 'stop_when' beside it");
  return CDEM_OK;
}
