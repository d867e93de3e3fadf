#include "dem/law_elastic.h"

#include "dem/law_damping.h"

#include <math.h>

static cdem_status check_material(const char *law, const cdem_grain_material *m,
                                  cdem_fault *fault) {
  CDEM_REQUIRE(m->young > 0.0, fault, CDEM_INPUT,
               "law '%s' needs 'young' of material '%.63s', more than 0 (infinite: rigid)", law,
               m->name);
  CDEM_REQUIRE(m->poisson > -1.0 && m->poisson <= 0.5, fault, CDEM_INPUT,
               "law '%s' needs 'poisson' of material '%.63s', above -1 and at most 0.5", law,
               m->name);
  return CDEM_OK;
}

cdem_status cdem_law_elastic(const char *law, const cdem_contact_input *input,
                             const cdem_grain_material *a, const cdem_grain_material *b,
                             cdem_law_parameters *parameters, cdem_fault *fault) {
  const double *v = input->value;
  double *p = parameters->p, zeta, dashpot, zeta_shear = v[CDEM_LAW_shear_damping_ratio];
  CDEM_TRY(check_material(law, a, fault));
  CDEM_TRY(check_material(law, b, fault));
  CDEM_REQUIRE(isfinite(a->young) || isfinite(b->young), fault, CDEM_INPUT,
               "both materials are rigid: one of them needs a finite 'young'");
  CDEM_TRY(cdem_law_damping(input, false, &zeta, &dashpot, fault));
  double soft =
      (1.0 - a->poisson * a->poisson) / a->young + (1.0 - b->poisson * b->poisson) / b->young;
  double soft_shear = (2.0 - a->poisson) * 2.0 * (1.0 + a->poisson) / a->young +
                      (2.0 - b->poisson) * 2.0 * (1.0 + b->poisson) / b->young;
  p[ELASTIC_FOUR_THIRDS] = 4.0 / 3.0 / soft;
  p[ELASTIC_KN] = 2.0 / soft;
  p[ELASTIC_KS] =
      isnan(v[CDEM_LAW_shear_ratio]) ? 8.0 / soft_shear : p[ELASTIC_KN] * v[CDEM_LAW_shear_ratio];
  p[ELASTIC_MU] = v[CDEM_LAW_friction];
  p[ELASTIC_AN] = 2.0 * sqrt(5.0 / 6.0) * zeta;
  p[ELASTIC_AS] = 2.0 * (isnan(zeta_shear) ? zeta : zeta_shear) *
                  sqrt(5.0 / 6.0 * p[ELASTIC_KS] / p[ELASTIC_KN]);
  return CDEM_OK;
}

void cdem_law_elastic_stiffness(const cdem_law_parameters *parameters, double radius, double mass,
                                double overlap, double *normal, double *shear, double dashpot[2]) {
  const double *p = parameters->p, a = sqrt(radius * overlap);
  *normal = p[ELASTIC_KN] * a;
  *shear = p[ELASTIC_KS] * a;
  dashpot[0] = p[ELASTIC_AN] * sqrt(mass * *normal);
  dashpot[1] = p[ELASTIC_AS] * sqrt(mass * *normal);
}
