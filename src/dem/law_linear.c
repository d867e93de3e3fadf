/* Linear springs and dashpots (Cundall & Strack 1979, Geotechnique 29, 47).
 *
 *     F_N = max(0, kn d + cn d'),  F_t = ks s + cs s', |F_t| <= mu F_N
 *
 * cn = 2 zeta sqrt(kn m), m the reduced mass, with zeta from the restitution (law_damping.h); the
 * shear dashpot is the same fraction of critical unless it is given. Shear stiffness by default
 * 2/7 kn for spheres, kn/3 for discs: normal and sticking tangential vibration of a homogeneous
 * grain then have one period, 1/m_t = (1/m)(1 + r^2 m/I). History: the force of the shear spring.
 */
#include "dem/law_damping.h"
#include "dem/law_lanes.h"
#include "dem/law_reference.h"

/* Dashpots are c + z sqrt(m kn), one of them 0. The root is taken of the product: it has an integer
 * power of each unit, its factors do not. */
enum { KN, KS, MU, CN, ZN, CS, ZS };

CDEM_ALWAYS_INLINE void linear_lanes(const cdem_law_parameters *parameters, cdem_batch *b, int dim,
                                     int energies) {
  const double *p = parameters->p;
  const double kn = p[KN], ks = p[KS], mu = p[MU], cn = p[CN], zn = p[ZN], cs = p[CS], zs = p[ZS];
  const double inverse = ks > 0.0 ? 1.0 / ks : 0.0, step = b->step;
  const int count = lane_count(b);
  for (int i = 0; i < count; i++) {
    const lane_vector n = lane_normal(dim, b, i);
    const double d = b->overlap[i], root = lane_root(b->mass[i] * kn);
    const double away = lane_normal_rate(dim, b->velocity, n, i);
    const double push = lane_max(0.0, kn * d - (cn + zn * root) * away);
    const lane_vector rate = lane_slide_rate(dim, b->velocity, b->turning, n, away, i);
    const lane_vector old = lane_turned(dim, b, n, lane_get(dim, b->history, i), step, i);
    const double cap = mu * push;
    const lane_vector trial = lane_sum(dim, old, ks * step, rate);
    const lane_vector whole = lane_sum(dim, trial, cs + zs * root, rate);
    const double cut = lane_cut(dim, whole, cap);
    const lane_vector spring = lane_scaled(dim, trial, cut);
    const lane_vector force = lane_scaled(dim, whole, cut);
    b->normal[i] = push;
    lane_put(dim, b->shear, i, force);
    lane_put(dim, b->history, i, spring);
    lane_put(dim, b->moment, i, (lane_vector){0.0, 0.0, 0.0});
    if (energies) {
      const double kick = lane_normal_rate(dim, b->velocity_gain, n, i);
      const double deep = lane_overlap_before(b, away, i);
      const double before = lane_max(0.0, kn * deep - (cn + zn * root) * (away - kick));
      const double gain = lane_own_gain(b, kick, push, deep > 0.0 ? before : 0.0, i);
      const lane_vector more = lane_slide_gain(dim, b, n, force, i);
      const lane_vector ahead = lane_sum(dim, rate, 0.5, more);
      const lane_vector dash = lane_sum(dim, force, -1.0, spring);
      const lane_vector mean = lane_sum(dim, old, 1.0, spring);
      const lane_vector grown = lane_sum(dim, spring, -1.0, old);
      b->stored_normal[i] = 0.5 * kn * d * d;
      b->stored_shear[i] = 0.5 * inverse * lane_dot(dim, spring, spring);
      b->stored_moment[i] = 0.0;
      b->damped[i] = step * (lane_dot(dim, dash, ahead) - (push - kn * d) * (away + 0.5 * gain));
      b->slid[i] = 0.5 * (step * lane_dot(dim, mean, rate) - inverse * lane_dot(dim, mean, grown));
      b->rolled[i] = 0.0;
      b->circulated[i] = 0.0;
    }
  }
}

CDEM_MULTIVERSION static void linear_2(const cdem_law_parameters *p, cdem_batch *b) {
  linear_lanes(p, b, 2, 0);
}
CDEM_MULTIVERSION static void linear_2_energies(const cdem_law_parameters *p, cdem_batch *b) {
  linear_lanes(p, b, 2, 1);
}
CDEM_MULTIVERSION static void linear_3(const cdem_law_parameters *p, cdem_batch *b) {
  linear_lanes(p, b, 3, 0);
}
CDEM_MULTIVERSION static void linear_3_energies(const cdem_law_parameters *p, cdem_batch *b) {
  linear_lanes(p, b, 3, 1);
}

static void linear_one(const cdem_law_parameters *parameters, cdem_batch *b, int lane, int dim) {
  const double *p = parameters->p;
  reference_contact c;
  reference_read(b, lane, dim, &c);
  double root = sqrt(c.mass * p[KN]);
  double push = p[KN] * c.overlap + (p[CN] + p[ZN] * root) * c.approach;
  if (push < 0.0)
    push = 0.0;
  double deep = reference_deep(&c);
  double before = p[KN] * deep + (p[CN] + p[ZN] * root) * reference_speed(&c);
  reference_normal(&c, push, p[KN] * c.overlap, 0.5 * p[KN] * c.overlap * c.overlap,
                   deep > 0.0 && before > 0.0 ? before : 0.0);
  reference_shear(&c, &(reference_shear_spring){.before = p[KS],
                                                .now = p[KS],
                                                .keep = 1.0,
                                                .way = p[KS],
                                                .dashpot = p[CS] + p[ZS] * root,
                                                .cap = p[MU] * push});
  reference_write(&c, b, lane, dim);
}

static void linear_one_2(const cdem_law_parameters *p, cdem_batch *b, int lane) {
  linear_one(p, b, lane, 2);
}
static void linear_one_3(const cdem_law_parameters *p, cdem_batch *b, int lane) {
  linear_one(p, b, lane, 3);
}

static cdem_status linear_prepare(int dim, const cdem_contact_input *input,
                                  const cdem_grain_material *a, const cdem_grain_material *b,
                                  cdem_law_parameters *parameters, cdem_fault *fault) {
  (void)a, (void)b;
  const double *v = input->value;
  double *p = parameters->p, zeta, dashpot;
  double ks = v[CDEM_LAW_shear_stiffness], ratio = v[CDEM_LAW_shear_ratio];
  CDEM_REQUIRE(isnan(ks) || isnan(ratio), fault, CDEM_INPUT,
               "'shear_stiffness' and 'shear_ratio' were both given: give one");
  CDEM_TRY(cdem_law_damping(input, true, &zeta, &dashpot, fault));
  CDEM_REQUIRE(isnan(v[CDEM_LAW_shear_dashpot]) || isnan(v[CDEM_LAW_shear_damping_ratio]), fault,
               CDEM_INPUT, "'shear_dashpot' and 'shear_damping_ratio' were both given: give one");
  p[KN] = v[CDEM_LAW_normal_stiffness];
  if (isnan(ks))
    ks = p[KN] * (!isnan(ratio) ? ratio : dim == 2 ? 1.0 / 3.0 : 2.0 / 7.0);
  p[KS] = ks;
  p[MU] = v[CDEM_LAW_friction];
  p[CN] = dashpot;
  p[ZN] = 2.0 * zeta;
  double like = sqrt(ks / p[KN]); /* same fraction of critical */
  p[CS] = p[CN] * like;
  p[ZS] = p[ZN] * like;
  if (!isnan(v[CDEM_LAW_shear_dashpot])) {
    p[CS] = v[CDEM_LAW_shear_dashpot];
    p[ZS] = 0.0;
  } else if (!isnan(v[CDEM_LAW_shear_damping_ratio])) {
    p[CS] = 0.0;
    p[ZS] = 2.0 * v[CDEM_LAW_shear_damping_ratio] * like;
  }
  return CDEM_OK;
}

static void linear_stiffness(const cdem_law_parameters *parameters, double radius, double mass,
                             double overlap, double *normal, double *shear, double dashpot[2]) {
  (void)radius, (void)overlap;
  const double *p = parameters->p, root = sqrt(mass * p[KN]);
  *normal = p[KN];
  *shear = p[KS];
  dashpot[0] = p[CN] + p[ZN] * root;
  dashpot[1] = p[CS] + p[ZS] * root;
}

static double linear_shear(const cdem_law_parameters *parameters) {
  return parameters->p[KS];
}

const cdem_law cdem_law_linear = {
    .name = "linear",
    .help = "Linear springs, dashpots and Coulomb friction (Cundall & Strack 1979).",
    .dims = {[2] = true, [3] = true},
    .wants = 9,
    .want = {{CDEM_LAW_normal_stiffness, true, NAN, 0.0, INFINITY, true},
             {CDEM_LAW_shear_stiffness, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_friction, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_restitution, false, NAN, 0.0, 1.0, true},
             {CDEM_LAW_damping_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_normal_dashpot, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_dashpot, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_damping_ratio, false, NAN, 0.0, INFINITY, false}},
    .history = {1, 3},
    .parity = {{1.0}, {-1.0, -1.0, -1.0}},
    .tangent_vectors = 1,
    .potential = true,
    .prepare = linear_prepare,
    .shear_stiffness = linear_shear,
    .batch = {{linear_2, linear_2_energies}, {linear_3, linear_3_energies}},
    .one = {linear_one_2, linear_one_3},
    .stiffness = linear_stiffness};
