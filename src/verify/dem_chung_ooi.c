/* Tests 1 to 8 of Chung & Ooi (2011, Granular Matter 13, 643). Where a sphere slides during all of
 * the impact, the tangential impulse is mu times the normal one, m (1 + e) v_n, whatever the law:
 * that changes the velocity by mu (1 + e) v_n, the spin by 5/2 of it over r, the sliding by 7/2 of
 * it. The printed series (data/reference/chung-ooi-*.csv) are those of other codes. */
#include "verify/dem.h"
#include "verify/dem_impact.h"
#include "verify/dem_series.h"
#include "verify/maw.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

enum { OXIDE, IRON, GLASS, LIMESTONE, ALUMINIUM, MAGNESIUM, ALLOY, STEEL, POLYETHYLENE, NYLON };
static const cdem_impact_material material[] = {
    [GLASS] = {48e9, 0.20, 2800.0},       [LIMESTONE] = {20e9, 0.25, 2500.0},
    [ALUMINIUM] = {70e9, 0.30, 2699.0},   [MAGNESIUM] = {40e9, 0.35, 1800.0},
    [OXIDE] = {380e9, 0.23, 4000.0},      [IRON] = {100e9, 0.25, 7000.0},
    [ALLOY] = {70e9, 0.33, 2700.0},       [STEEL] = {208e9, 0.30, 7850.0},
    [POLYETHYLENE] = {1e9, 0.30, 1000.0}, [NYLON] = {2.5e9, 0.40, 1000.0},
};

/* Mean overlap of a Hertz impact on a rigid plane, weighted by the force, over the radius: the
 * integral of F overlap dt over that of F dt is (5/4) integral of s^(5/2)/sqrt(1 - s^(5/2)) ds =
 * B(7/5, 1/2)/2 = 0.81756 of the deepest. */
static double shorter(const cdem_impact *p) {
  double mass = p->material.density * 4.0 / 3.0 * pi * p->radius * p->radius * p->radius;
  double modulus = p->material.young / (1.0 - p->material.poisson * p->material.poisson);
  double energy = 15.0 * mass * p->normal * p->normal / (16.0 * modulus * sqrt(p->radius));
  return 0.81756 * pow(energy, 0.4) / p->radius;
}

/* ---- 1, 2, 3: normal ---- */

static cdem_status normal_impact(const cdem_impact *impact, int what, double *value,
                                 cdem_fault *fault) {
  cdem_rebound r;
  CDEM_TRY(cdem_impact_run(impact, &r, fault));
  *value = what == 0 ? r.force : what == 1 ? r.overlap : r.duration;
  return CDEM_OK;
}

cdem_status cdem_dem_measure_two_spheres(int parameter, double *value, cdem_fault *fault) {
  const cdem_impact impact = {.material = material[parameter < 3 ? GLASS : LIMESTONE],
                              .radius = 0.01,
                              .other = 0.01,
                              .normal = 10.0,
                              .restitution = 1.0,
                              .fineness = 1000,
                              .peaks = true};
  return normal_impact(&impact, parameter % 3, value, fault);
}

cdem_status cdem_dem_measure_sphere_plane(int parameter, double *value, cdem_fault *fault) {
  const cdem_impact impact = {.material = material[parameter < 3 ? ALUMINIUM : MAGNESIUM],
                              .radius = 0.1,
                              .normal = 0.2,
                              .restitution = 1.0,
                              .fineness = 1000,
                              .peaks = true};
  return normal_impact(&impact, parameter % 3, value, fault);
}

cdem_status cdem_dem_measure_restitution(int parameter, double *value, cdem_fault *fault) {
  *value = 0.0;
  for (int i = 2; i <= 10; i++) {
    const cdem_impact_material *m = &material[parameter % 2 == 0 ? OXIDE : IRON];
    const cdem_impact impact = {.material = *m,
                                .law = parameter < 2 ? NULL : "linear",
                                .stiffness = parameter < 2 ? 0.0 : m->young * 0.0025,
                                .radius = 0.0025,
                                .normal = 3.9,
                                .restitution = 0.1 * i};
    cdem_rebound r;
    CDEM_TRY(cdem_impact_run(&impact, &r, fault));
    *value = fmax(*value, fabs(r.normal / impact.normal - impact.restitution));
  }
  return CDEM_OK;
}

/* ---- 4: oblique ---- */

static const double mu_4 = 0.092, radius_4 = 0.0025;

static cdem_impact oblique_impact(int which, double angle, double restitution) {
  const double a = angle * pi / 180.0;
  return (cdem_impact){.material = material[which],
                       .radius = radius_4,
                       .normal = 3.9 * cos(a),
                       .tangential = 3.9 * sin(a),
                       .friction = mu_4,
                       .restitution = restitution};
}

/* Of one angle: tangential restitution, spin, rebound angle; closed forms of sliding beside. */
static cdem_status oblique(int which, double angle, double after[3], double closed[3],
                           cdem_fault *fault) {
  const double radius = radius_4, mu = mu_4, restitution = 0.98;
  const cdem_impact impact = oblique_impact(which, angle, restitution);
  cdem_rebound r;
  CDEM_TRY(cdem_impact_run(&impact, &r, fault));
  after[0] = r.tangential / impact.tangential;
  after[1] = -r.spin;
  after[2] = atan(r.slide / r.normal) * 180.0 / pi;
  double gain = mu * (1.0 + restitution) * impact.normal;
  closed[0] = 1.0 - gain / impact.tangential;
  closed[1] = -2.5 * (1.0 - shorter(&impact)) * gain / radius;
  double slide = impact.tangential - gain + radius * closed[1];
  closed[2] = atan(slide / (restitution * impact.normal)) * 180.0 / pi;
  return CDEM_OK;
}

/* Sliding branch: restitution, spin (share), angle; of both materials. */
static cdem_status oblique_sliding(int what, double *value, cdem_fault *fault) {
  double after[3], closed[3];
  *value = 0.0;
  for (int i = 0; i < 10; i++) {
    double angle = cdem_chung_ooi_4[8 + i / 2][0];
    CDEM_TRY(oblique(i % 2 == 0 ? OXIDE : ALLOY, angle, after, closed, fault));
    double scale = what == 1 ? fabs(closed[1]) : 1.0;
    *value = fmax(*value, fabs(after[what] - closed[what]) / scale);
  }
  return CDEM_OK;
}

/* Tangential restitution less that of the theory, rows `from` to 40 degrees; e = 1. */
static cdem_status oblique_theory(const char *law, int which, int from, double *value,
                                  cdem_fault *fault) {
  *value = 0.0;
  for (int i = from; i < 8; i++) {
    cdem_impact impact = oblique_impact(which, cdem_chung_ooi_4[i][0], 1.0);
    cdem_rebound r;
    impact.law = law;
    CDEM_TRY(cdem_impact_run(&impact, &r, fault));
    double x = impact.tangential / (mu_4 * impact.normal);
    double theory = 1.0 - (1.0 - cdem_maw_rebound(material[which].poisson, 0.4, x) / x) / 3.5;
    *value = fmax(*value, fabs(r.tangential / impact.tangential - theory));
  }
  return CDEM_OK;
}

/* The printed restitution at 5 degrees, 0.948, is left out: the theory says 0.742 and the
 * experiment beside it 0.746. */
cdem_status cdem_dem_measure_oblique(int parameter, double *value, cdem_fault *fault) {
  double after[3], closed[3];
  if (parameter < 3)
    return oblique_sliding(parameter, value, fault);
  if (parameter >= 8)
    return oblique_theory("mindlin", parameter == 8 ? OXIDE : ALLOY, 0, value, fault);
  if (parameter >= 6)
    return oblique_theory(NULL, OXIDE, parameter == 6 ? 0 : 3, value, fault);
  *value = 0.0;
  for (int i = 1; i < CDEM_CHUNG_OOI_4; i++) {
    const double *row = cdem_chung_ooi_4[i];
    CDEM_TRY(oblique(OXIDE, row[0], after, closed, fault));
    *value = fmax(*value, fabs(after[parameter - 3] - row[parameter - 2]));
  }
  return CDEM_OK;
}

/* ---- 5: a sphere of ten microns ---- */

static cdem_status micron(const char *law, int which, double x, double after[2], double closed[2],
                          cdem_fault *fault) {
  const double mu = 0.3;
  const cdem_impact impact = {.material = material[which],
                              .law = law,
                              .radius = 1e-5,
                              .normal = 5.0,
                              .tangential = x * mu * 5.0,
                              .friction = mu,
                              .restitution = 1.0};
  cdem_rebound r;
  CDEM_TRY(cdem_impact_run(&impact, &r, fault));
  after[0] = r.slide / (mu * r.normal);
  after[1] = -r.spin * impact.radius / (mu * impact.normal);
  closed[1] = -5.0 * (1.0 - shorter(&impact));
  closed[0] = x - 2.0 + closed[1];
  return CDEM_OK;
}

/* The theory with an arm 1 - s radii long. At the end of the arm the tangential impulse, in m mu
 * v_n, moves the surface by 1 + 5/2 (1 - s)^2 of itself; `slide` is that at the whole radius, which
 * it moves by 1 + 5/2 (1 - s). s is 0.5 % for steel, 2 % for polyethylene. */
static double micron_theory(int which, double x) {
  const cdem_impact impact = {.material = material[which], .radius = 1e-5, .normal = 5.0};
  double arm = 1.0 - shorter(&impact), light = 2.5 * arm * arm;
  double impulse = (x - cdem_maw_rebound(material[which].poisson, 1.0 / light, x)) / (1.0 + light);
  return x - impulse * (1.0 + 2.5 * arm);
}

/* Rebound, with micro-slip, less the theory at the printed incidences or less finite elements. */
static cdem_status micron_slipping(int which, bool elements, double *value, cdem_fault *fault) {
  double after[2], closed[2];
  *value = 0.0;
  for (int i = 0; i < (elements ? CDEM_CHUNG_OOI_5_ELEMENTS : CDEM_CHUNG_OOI_5); i++) {
    double x = elements ? cdem_chung_ooi_5_elements[i][0] : cdem_chung_ooi_5[i][0];
    double y = elements ? cdem_chung_ooi_5_elements[i][1] : micron_theory(which, x);
    CDEM_TRY(micron("mindlin", which, x, after, closed, fault));
    *value = fmax(*value, fabs(after[0] - y));
  }
  return CDEM_OK;
}

cdem_status cdem_dem_measure_micron(int parameter, double *value, cdem_fault *fault) {
  double after[2], closed[2];
  if (parameter >= 6)
    return micron_slipping(parameter == 7 ? POLYETHYLENE : STEEL, parameter == 8, value, fault);
  *value = 0.0;
  for (int i = 0; parameter < 2 && i < 6; i++) { /* both materials, sliding */
    double x = 6.5 + 1.5 * (i % 3);
    CDEM_TRY(micron(NULL, i < 3 ? STEEL : POLYETHYLENE, x, after, closed, fault));
    *value = fmax(*value, fabs(after[parameter] - closed[parameter]) / 5.0);
  }
  for (int i = parameter == 4 ? 0 : 12; parameter >= 2 && parameter < 5 && i < CDEM_CHUNG_OOI_5;
       i++) {
    const double *row = cdem_chung_ooi_5[i];
    CDEM_TRY(micron(NULL, STEEL, row[0], after, closed, fault));
    double theory = cdem_maw_rebound(0.3, 0.4, row[0]);
    double off = parameter == 4 ? after[0] - theory : after[parameter - 2] - row[parameter - 1];
    *value = fmax(*value, fabs(off));
  }
  for (int i = 0; parameter == 5 && i < CDEM_CHUNG_OOI_5_ELEMENTS; i++) {
    const double *row = cdem_chung_ooi_5_elements[i];
    *value = fmax(*value, fabs(cdem_maw_rebound(0.3, 0.4, row[0]) - row[1]));
  }
  return CDEM_OK;
}

/* ---- 6, 8: spin before the impact ---- */

static const double mu_6 = 0.4, e_6 = 0.5, normal_6 = 0.2, radius_6 = 0.1;

static cdem_impact spun_impact(int which, bool plane, double slide) {
  return (cdem_impact){.material = material[which],
                       .radius = radius_6,
                       .other = plane ? 0.0 : 5.0 * radius_6,
                       .resting = !plane,
                       .normal = normal_6,
                       .spin = -slide / radius_6,
                       .friction = mu_6,
                       .restitution = e_6};
}

static cdem_status spun(int which, bool plane, double slide, double *beta, double *recoil,
                        cdem_fault *fault) {
  const cdem_impact impact = spun_impact(which, plane, slide);
  cdem_rebound r;
  CDEM_TRY(cdem_impact_run(&impact, &r, fault));
  *beta = -r.slide / slide;
  *recoil = r.slide / r.normal;
  return CDEM_OK;
}

/* Worst of beta - (x - 1) where the sphere slides to the end, x < 0.9. */
static cdem_status spun_sliding(int which, bool plane, double *value, cdem_fault *fault) {
  double beta, recoil;
  *value = 0.0;
  for (int i = 1; i <= 5; i++) {
    double x = 0.17 * i, slide = 3.5 * mu_6 * (1.0 + e_6) * normal_6 / x;
    CDEM_TRY(spun(which, plane, slide, &beta, &recoil, fault));
    *value = fmax(*value, fabs(beta - (x - 1.0)));
  }
  return CDEM_OK;
}

/* Rebound over mu v_n, with micro-slip and e = 1, less the theory's where the contact sticks or
 * slips in part: at the printed x = 7/2 mu (1 + e) v_n/slide from 1 on. Impact sees no difference
 * between a slide that comes from spin and one that comes from the velocity. */
static cdem_status spun_theory(int which, bool plane, double *value, cdem_fault *fault) {
  *value = 0.0;
  for (int i = 4; i < CDEM_CHUNG_OOI_6; i++) {
    double x = 7.0 / cdem_chung_ooi_6[i][0];
    cdem_impact impact = spun_impact(which, plane, x * mu_6 * normal_6);
    cdem_rebound r;
    impact.law = "mindlin";
    impact.restitution = 1.0;
    CDEM_TRY(cdem_impact_run(&impact, &r, fault));
    double theory = cdem_maw_rebound(material[which].poisson, 0.4, x);
    *value = fmax(*value, fabs(r.slide / (mu_6 * normal_6) - theory));
  }
  return CDEM_OK;
}

cdem_status cdem_dem_measure_spinning(int parameter, double *value, cdem_fault *fault) {
  double beta, recoil;
  if (parameter >= 5)
    return spun_theory(parameter == 5 ? ALLOY : NYLON, true, value, fault);
  if (parameter < 2)
    return spun_sliding(parameter == 0 ? ALLOY : NYLON, true, value, fault);
  *value = 0.0;
  for (int i = 0; i < (parameter == 3 ? 11 : parameter == 2 ? 9 : 17); i++) {
    double tangent = parameter != 3 ? 3.5 * mu_6 * (1.0 + e_6) / cdem_chung_ooi_6[i][0]
                                    : cdem_chung_ooi_6_recoil[i][0];
    CDEM_TRY(spun(ALLOY, true, tangent * normal_6, &beta, &recoil, fault));
    double off =
        parameter != 3 ? beta - cdem_chung_ooi_6[i][1] : recoil - cdem_chung_ooi_6_recoil[i][1];
    *value = fmax(*value, fabs(off));
  }
  return CDEM_OK;
}

cdem_status cdem_dem_measure_unequal(int parameter, double *value, cdem_fault *fault) {
  int which = parameter % 2 == 0 ? ALLOY : NYLON;
  return parameter < 2 ? spun_sliding(which, false, value, fault)
                       : spun_theory(which, false, value, fault);
}

/* ---- 7: two spheres that turn like gears ---- */

cdem_status cdem_dem_measure_gears(int parameter, double *value, cdem_fault *fault) {
  *value = 0.0;
  for (int i = 0; i < 17; i++) { /* 0.175 to 22.86 rad/s: tangents of 5 to 85 degrees */
    double angle = 90.0 / 18.0 * (i + 1) * pi / 180.0, spin = 2.0 * tan(angle);
    const cdem_impact impact = {.material = material[ALLOY],
                                .radius = 0.1,
                                .other = 0.1,
                                .normal = 0.2,
                                .spin = spin,
                                .friction = 0.4,
                                .restitution = 0.5};
    cdem_rebound r;
    CDEM_TRY(cdem_impact_run(&impact, &r, fault));
    *value = fmax(*value, fabs(parameter == 0 ? r.spin / spin - 1.0 : r.tangential / (0.1 * spin)));
  }
  return CDEM_OK;
}
