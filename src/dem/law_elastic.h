/* Private to the laws: what laws of elastic spheres (hertz, mindlin) have in common. */
#ifndef CDEM_DEM_LAW_ELASTIC_H
#define CDEM_DEM_LAW_ELASTIC_H

#include "dem/law.h"

/* 4/3 E*, 2 E*, 8 G*, friction, and dashpots AN sqrt(m kn), AS sqrt(m kn); a law's own follow. */
enum {
  ELASTIC_FOUR_THIRDS,
  ELASTIC_KN,
  ELASTIC_KS,
  ELASTIC_MU,
  ELASTIC_AN,
  ELASTIC_AS,
  ELASTIC_PARAMETERS
};

/* From friction, restitution or damping_ratio, shear_damping_ratio and shear_ratio; `law` names
 * itself in messages. */
cdem_status cdem_law_elastic(const char *law, const cdem_contact_input *input,
                             const cdem_grain_material *a, const cdem_grain_material *b,
                             cdem_law_parameters *parameters, cdem_fault *fault);

/* cdem_law.stiffness of both. */
void cdem_law_elastic_stiffness(const cdem_law_parameters *parameters, double radius, double mass,
                                double overlap, double *normal, double *shear, double dashpot[2]);

/* cdem_law.why of both: why there are no discs. */
#define CDEM_LAW_ELASTIC_WHY                                                                       \
  "between two cylinders the overlap at a given force depends on how far away the bodies are "     \
  "held (Johnson 1985, 5.6), so there is no law of the contact alone; take 'linear', or spheres "  \
  "moving in a plane"

#endif
