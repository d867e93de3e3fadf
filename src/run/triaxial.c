/* The plan of a triaxial test, and its strains and stresses. */
#include "run/triaxial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- usual results and curves ---- */

typedef struct {
  const char *name, *of, *along;
  int take;
  double factor;
} usual_result;

typedef struct {
  const char *name, *title, *y, *y_label;
} usual_curve;

static bool has_result(const cdem_case_values *v, const char *name) {
  for (int64_t i = 0; i < v->results.count; i++)
    if (strcmp(v->results.item[i].name, name) == 0)
      return true;
  return false;
}

static bool has_curve(const cdem_case_values *v, const char *name) {
  for (int64_t i = 0; i < v->curves.count; i++)
    if (strcmp(v->curves.item[i].name, name) == 0)
      return true;
  return false;
}

/* A copy for the case to own; failures leave the member NULL and are seen by the caller. */
static cdem_status put(const char *text, char **member, cdem_fault *fault) {
  if (text != NULL && (*member = cdem_copy_text(text, fault)) == NULL)
    return CDEM_MEMORY;
  return CDEM_OK;
}

static cdem_status add_result(cdem_case_values *v, const usual_result *from, cdem_fault *fault) {
  int64_t room = v->results.count;
  if (has_result(v, from->name))
    return CDEM_OK;
  CDEM_TRY(
      cdem_grow(&v->results.item, &room, v->results.count + 1, sizeof *v->results.item, fault));
  cdem_case_key_result *to = &v->results.item[v->results.count++];
  *to = (cdem_case_key_result){.take = from->take,
                               .from = NAN,
                               .to = NAN,
                               .factor = from->factor,
                               .reference = NAN,
                               .tolerance = NAN,
                               .against_factor = 1.0};
  CDEM_TRY(put(from->name, &to->name, fault));
  CDEM_TRY(put(from->of, &to->of, fault));
  return put(from->along, &to->along, fault);
}

static cdem_status add_curve(cdem_case_values *v, const usual_curve *from, cdem_fault *fault) {
  int64_t room = v->curves.count;
  if (has_curve(v, from->name))
    return CDEM_OK;
  CDEM_TRY(cdem_grow(&v->curves.item, &room, v->curves.count + 1, sizeof *v->curves.item, fault));
  cdem_case_curve *to = &v->curves.item[v->curves.count++];
  *to = (cdem_case_curve){.x_scale = 1.0, .y_scale = 1.0};
  CDEM_TRY(put(from->name, &to->name, fault));
  CDEM_TRY(put(from->title, &to->title, fault));
  CDEM_TRY(put("axial_strain", &to->x, fault));
  CDEM_TRY(put("axial strain", &to->x_label, fault));
  CDEM_TRY(put(from->y_label, &to->y_label, fault));
  CDEM_NEW(to->y.item, 1, fault);
  to->y.count = 1;
  return put(from->y, &to->y.item[0], fault);
}

static cdem_status add_usual(cdem_case_values *v, cdem_fault *fault) {
  static const usual_result results[] = {
      {"peak_stress_ratio", "stress_ratio", NULL, CDEM_TAKE_MAX, 1.0},
      {"strain_at_peak", "stress_ratio", "axial_strain", CDEM_TAKE_PLACE_OF_MAX, 1.0},
      {"last_stress_ratio", "stress_ratio", NULL, CDEM_TAKE_LAST, 1.0},
      {"contraction", "volumetric_strain", NULL, CDEM_TAKE_MAX, 1.0},
      {"dilation", "dilation", NULL, CDEM_TAKE_MAX, 1.0}};
  static const usual_curve curves[] = {
      {"stress_ratio", "Stress ratio against axial strain", "stress_ratio", "stress ratio"},
      {"volumetric_strain", "Volumetric strain, contraction positive", "volumetric_strain",
       "volumetric strain"}};
  for (size_t i = 0; i < sizeof results / sizeof *results; i++)
    CDEM_TRY(add_result(v, &results[i], fault));
  for (size_t i = 0; i < sizeof curves / sizeof *curves; i++)
    CDEM_TRY(add_curve(v, &curves[i], fault));
  return CDEM_OK;
}

/* ---- the plan ---- */

static const double usual_inertial = 1e-3, usual_consolidation = 50.0;

cdem_status cdem_run_triaxial_plan(cdem_run_setup *run, const cdem_run_triaxial_sizes *sizes,
                                   cdem_run_triaxial *plan, cdem_fault *fault) {
  cdem_case_values *v = &run->cases.values;
  const cdem_case_triaxial *t = &v->triaxial;
  *plan = (cdem_run_triaxial){.sizes = *sizes};
  plan->clock = sizes->diameter * sqrt(sizes->density / t->pressure);
  plan->begin = isnan(t->consolidation) ? usual_consolidation * plan->clock : t->consolidation;
  double inertial = isnan(t->inertial_number) ? usual_inertial : t->inertial_number;
  plan->rate = isnan(t->rate) ? inertial / plan->clock : t->rate;
  plan->time[1] = 0.5 * plan->begin;
  plan->value[0] = 0.1 * t->pressure;
  plan->value[1] = t->pressure;
  plan->pressure = (cdem_series){
      .kind = CDEM_SERIES_TABLE, .points = 2, .time = plan->time, .value = plan->value};
  v->end = plan->begin + (1.0 - exp(-t->strain)) / plan->rate; /* H = H0 (1 - rate t) */
  if (!cdem_case_given(&run->cases, "history_every"))
    v->history_every = v->end / 400.0;
  if (!cdem_case_given(&run->cases, "frame_every"))
    v->frame_every = v->end / 20.0;
  return add_usual(v, fault);
}

static double or_zero(double value) {
  return isnan(value) ? 0.0 : value;
}

void cdem_run_triaxial_membrane(const cdem_run_setup *run, const cdem_run_triaxial *plan,
                                const double low[3], const double high[3],
                                cdem_membrane_options *options) {
  const cdem_case_triaxial *t = &cdem_run_values(run)->triaxial;
  const cdem_case_membrane *from = &t->membrane;
  *options = (cdem_membrane_options){.radius = 0.5 * fmin(high[0] - low[0], high[1] - low[1]),
                                     .low = low[2],
                                     .high = high[2],
                                     .spacing = or_zero(from->spacing),
                                     .areal_density = or_zero(from->areal_density),
                                     .young = or_zero(from->young),
                                     .poisson = from->poisson,
                                     .thickness = or_zero(from->thickness),
                                     .bending = or_zero(from->bending),
                                     .damping = or_zero(from->damping),
                                     .penalty = or_zero(from->penalty),
                                     .contact_damping = or_zero(from->contact_damping),
                                     .clamped = from->edges == 0};
  for (int c = 0; c < 2; c++)
    options->center[c] = 0.5 * (low[c] + high[c]);
  options->pressure = plan->pressure;
  cdem_membrane_complete(options, t->pressure, plan->sizes.smallest, plan->sizes.density);
  if (!isnan(from->damping)) /* 0 is a ratio, too */
    options->damping = from->damping;
  if (!isnan(from->contact_damping))
    options->contact_damping = from->contact_damping;
}

/* ---- stages ---- */

static int64_t steps_before_shear(const cdem_run_triaxial *plan, const cdem_run_now *now) {
  double steps = ceil((plan->begin - now->time) / now->step - 0.5);
  return steps < 0.0 ? 0 : steps < 1e15 ? (int64_t)steps : (int64_t)1e15;
}

static void shear(cdem_run_triaxial *plan, const cdem_run_triaxial_host *host) {
  cdem_specimen at;
  host->specimen(host->solver, &at);
  plan->shears = true;
  plan->height = at.height;
  plan->volume = at.volume;
  host->shear(host->solver, -plan->rate * at.height);
}

cdem_status cdem_run_triaxial_advance(cdem_run_triaxial *plan, const cdem_run_triaxial_host *host,
                                      int64_t steps, cdem_fault *fault) {
  while (!plan->shears) {
    const cdem_run_now now = host->now(host->solver);
    int64_t before = steps_before_shear(plan, &now);
    if (before > steps)
      break;
    CDEM_TRY(host->steps(host->solver, before, fault));
    steps -= before;
    if (before == 0)
      shear(plan, host);
  }
  return host->steps(host->solver, steps, fault);
}

void cdem_run_triaxial_columns(cdem_run_triaxial *plan, const cdem_run_triaxial_host *host,
                               cdem_run_row *row) {
  cdem_specimen at = {0}, *s = &at;
  if (!row->declare)
    host->specimen(host->solver, s);
  double axial = NAN, volumetric = NAN, ratio = NAN;
  if (plan->shears && !row->declare) { /* a continued run declares its columns once more */
    axial = log(plan->height / s->height);
    volumetric = log(plan->volume / s->volume);
    plan->contraction = fmax(plan->contraction, volumetric);
    ratio = 3.0 * (s->axial - s->pressure) / (s->axial + 2.0 * s->pressure);
  }
  cdem_run_put(row, "", axial, "axial_strain");
  cdem_run_put(row, "", volumetric, "volumetric_strain");
  cdem_run_put(row, "", plan->shears ? plan->contraction - volumetric : NAN, "dilation");
  cdem_run_put(row, "", ratio, "stress_ratio");
  cdem_run_put(row, "Pa", s->axial, "axial_stress");
  cdem_run_put(row, "Pa", s->bottom, "bottom_stress");
  cdem_run_put(row, "Pa", s->lateral, "lateral_stress");
  cdem_run_put(row, "Pa", s->pressure, "confining_pressure");
  cdem_run_put(row, "", s->pressure > 0.0 ? s->lateral / s->pressure - 1.0 : NAN, "pressure_error");
  cdem_run_put(row, "m", s->height, "height");
  cdem_run_put(row, "m3", s->volume, "volume");
  cdem_run_put(row, "", s->volume > 0.0 ? plan->sizes.solid / s->volume : NAN, "solid_fraction");
  cdem_run_put(row, "",
               s->pressure > 0.0 ? fabs(s->speed) / s->height * plan->sizes.diameter *
                                       sqrt(plan->sizes.density / s->pressure)
                                 : NAN,
               "inertial_number");
  cdem_run_put(row, "", (double)s->touching, "membrane_touching");
}

/* ---- state ---- */

cdem_status cdem_run_triaxial_save(const cdem_run_triaxial *plan, cdem_state *state,
                                   cdem_fault *fault) {
  const double real[4] = {plan->shears, plan->height, plan->volume, plan->contraction};
  return cdem_state_add_copy(state, "triaxial/stage", CDEM_ARRAY_REAL, 4, real, fault);
}

cdem_status cdem_run_triaxial_restore(cdem_run_triaxial *plan, const cdem_state *state,
                                      cdem_fault *fault) {
  double real[4];
  CDEM_TRY(cdem_state_get(state, "triaxial/stage", CDEM_ARRAY_REAL, 4, real, fault));
  plan->shears = real[0] != 0.0;
  plan->height = real[1];
  plan->volume = real[2];
  plan->contraction = real[3];
  return CDEM_OK;
}
