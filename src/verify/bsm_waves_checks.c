/* What is asked of the interface's reflection: the derived numbers against closed forms and laws,
 * the measured ones against the derived. */
#include "verify/bsm.h"
#include "verify/bsm_waves.h"

#include <math.h>

/* ---- measured against derived ---- */

enum { MOST_WAVES = 8 };

static const struct {
  cdem_bsm_chain chain;
  int waves;
  double ka[MOST_WAVES]; /* none near the cutoff 2/n, where a record of any length is too short */
} cases[] = {
    {{.ratio = 5, .grains = 280}, 6, {0.1, 0.2, 0.3, 0.6, 0.8, 1.0}},
    {{.ratio = 5, .grains = 280, .form = CDEM_BSM_VIRTUAL_WORK}, 6, {0.1, 0.2, 0.3, 0.6, 0.8, 1.0}},
    {{.ratio = 5, .grains = 280, .layers = 1, .rate = 4.0}, 6, {0.1, 0.2, 0.3, 0.6, 0.8, 1.0}},
    {{.ratio = 10}, 8, {0.02, 0.05, 0.1, 0.15, 0.3, 0.5, 1.0, 1.5}},
    {{.ratio = 23, .grains = 1150}, 8, {0.02, 0.04, 0.06, 0.15, 0.3, 0.5, 1.0, 1.5}},
    {{.ratio = 5, .cycles = 10, .step = 0.1, .way = CDEM_BSM_ACCELERATION},
     8,
     {0.05, 0.1, 0.2, 0.3, 0.6, 0.8, 1.0, 1.2}},
    {{.ratio = 10, .layers = 2, .rate = 2.0}, 8, {0.02, 0.05, 0.1, 0.15, 0.3, 0.5, 1.0, 1.5}},
    {{.ratio = 5, .place = 0.25}, 8, {0.05, 0.1, 0.2, 0.3, 0.6, 0.8, 1.0, 1.2}},
    {{.ratio = 10, .grains = 1600}, 1, {2.0}},
    {{.ratio = 5, .cycles = 10, .step = 0.1}, 8, {0.05, 0.1, 0.2, 0.3, 0.6, 0.8, 1.0, 1.2}},
};

cdem_status cdem_bsm_measure_waves(int parameter, double *value, cdem_fault *fault) {
  const cdem_bsm_chain *chain = &cases[parameter].chain;
  double back[MOST_WAVES];
  CDEM_TRY(cdem_bsm_waves_measure(chain, cases[parameter].waves, cases[parameter].ka, back, fault));
  *value = 0.0;
  for (int i = 0; i < cases[parameter].waves; i++) {
    cdem_bsm_reflection derived;
    CDEM_TRY(cdem_bsm_waves_derive(chain, cases[parameter].ka[i], &derived, fault));
    *value = fmax(*value, fabs(back[i] - derived.back));
  }
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_waves_energy(int parameter, double *value, cdem_fault *fault) {
  const cdem_bsm_chain chain = {.ratio = 5, .grains = 280};
  cdem_bsm_energy energy;
  CDEM_TRY(cdem_bsm_waves_energy(&chain, 0.7, 1.1, &energy, fault));
  *value = parameter == 0 ? energy.on : energy.error;
  return CDEM_OK;
}

/* ---- derived ---- */

typedef enum { LOSS, LARGEST_BACK, LARGEST_ON_ERROR, LARGEST_BELOW_ONE } question;

/* The largest answer over k h from `low` to `high`. */
static cdem_status over(const cdem_bsm_chain *chain, double low, double high, question asked,
                        double *value, cdem_fault *fault) {
  enum { SAMPLES = 100 };
  *value = 0.0;
  for (int i = 0; i <= SAMPLES; i++) {
    double kh = low + (high - low) * i / SAMPLES;
    cdem_bsm_reflection r;
    CDEM_TRY(cdem_bsm_waves_derive(chain, kh / chain->ratio, &r, fault));
    const double answer[] = {
        [LOSS] = 1.0 - r.back * r.back - r.on,
        [LARGEST_BACK] = r.back * r.back,
        [LARGEST_ON_ERROR] = fabs(1.0 - r.back * r.back - r.on),
        [LARGEST_BELOW_ONE] = fabs(1.0 - r.back),
    };
    *value = fmax(*value, answer[asked]);
  }
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_waves_derived(int parameter, double *value, cdem_fault *fault) {
  const cdem_bsm_chain plain = {.ratio = 10};
  const cdem_bsm_chain thin = {.ratio = 10, .layers = 1, .rate = 5.5};
  const cdem_bsm_chain thick = {.ratio = 10, .layers = 2, .rate = 2.0};
  const cdem_bsm_chain even = {.ratio = 10, .cycles = 10, .step = 0.1};
  /* 2 b - b^2/h = a/2 */
  const cdem_bsm_chain matched = {.ratio = 10, .place = 10.0 - sqrt(95.0)};
  const double long_wave = 1e-4;
  cdem_bsm_reflection r;
  switch (parameter) {
  case 0:
    CDEM_TRY(cdem_bsm_waves_derive(&plain, long_wave, &r, fault));
    *value = r.back / (0.25 * long_wave * (1.0 - 0.05));
    return CDEM_OK;
  case 1:
    CDEM_TRY(cdem_bsm_waves_derive(&matched, long_wave, &r, fault));
    *value = r.back / long_wave;
    return CDEM_OK;
  case 2:
    return over(&plain, 2.05, 20.0, LARGEST_BELOW_ONE, value, fault);
  case 3:
    return over(&plain, 0.1, 1.95, LARGEST_ON_ERROR, value, fault);
  case 4:
    return over(&thin, 4.0, 20.0, LARGEST_BACK, value, fault);
  case 5:
    return over(&thick, 5.0, 20.0, LARGEST_BACK, value, fault);
  case 6:
    return over(&thick, 0.05, 0.5, LOSS, value, fault);
  default:
    return over(&even, 2.05, 20.0, LARGEST_BELOW_ONE, value, fault);
  }
}
