/* Oblique impacts of a sphere on a rigid plane, for the tests of laws of elastic spheres. */
#ifndef CDEM_TESTS_DEM_LAW_IMPACT_H
#define CDEM_TESTS_DEM_LAW_IMPACT_H

#include "dem/law_support.h"

typedef struct {
  double slip, spin, tangential, normal; /* after; slip of the surface */
} rebound;

/* in: normal and tangential velocity, spin about the axis across both. */
static inline rebound oblique(const char *law, const cdem_grain_material *material, double radius,
                              double restitution, double friction, double shear_damping,
                              const double in[3]) {
  cdem_grain_material rigid = {"rigid", 1.0, INFINITY, 0.0};
  cdem_contact_input input = no_input();
  cdem_contact_model model;
  cdem_fault fault = {0};
  input.value[CDEM_LAW_restitution] = restitution;
  input.value[CDEM_LAW_friction] = friction;
  input.value[CDEM_LAW_shear_damping_ratio] = shear_damping;
  check_ok(cdem_contact_model_init(3, cdem_law_find(law), NULL, NULL, &input, material, &rigid,
                                   &model, &fault));
  two_body t;
  two_body_init(&t, 3, true, &model, radius, 0.0, material->density);
  double k =
      4.0 / 3.0 * material->young / (1.0 - material->poisson * material->poisson) * sqrt(radius);
  double depth = pow(1.25 * t.mass[0] * in[0] * in[0] / k, 0.4);
  t.step = 2.94 * depth / in[0] / 4000.0;
  t.x[0][2] = radius;
  t.v[0][2] = -in[0];
  t.v[0][0] = in[1];
  t.w[0][1] = in[2];
  two_body_collide(&t, 100000);
  return (rebound){t.v[0][0] - radius * t.w[0][1], t.w[0][1], t.v[0][0], t.v[0][2]};
}

#endif
