/* Rolling and twisting resistance as a spring with a cap and a dashpot (Iwashita & Oda 1998, J.
 * Eng. Mech. 124, 285; type C of Ai et al. 2011, Powder Technology 206, 269).
 *
 *     M = k q + c q', |M| <= (mu R + l) F_N,  q the relative rotation (rolling: in the tangent
 * plane; twisting: about n)
 *
 * k is given, or by default R^2 times the law's shear stiffness (Iwashita & Oda; R the reduced
 * radius). c = 2 zeta sqrt(k I) unless it is given, I = 2/5 m R^2 (discs 1/2). Spring and
 * dashpot meet the cap together as in law_lanes.h. History: the moment of the spring.
 */
#include "dem/law_lanes.h"
#include "dem/law_reference.h"

/* k = K + KR R^2; c = C + ZK R sqrt(m k) */
enum { K, KR, C, ZK, MU, LENGTH };

static const double inertia[2] = {0.5, 0.4};

CDEM_ALWAYS_INLINE void spring_lanes(const cdem_law_parameters *parameters, int first,
                                     cdem_batch *b, int dim, int twisting, int energies) {
  const double *p = parameters->p, step = b->step;
  const double k0 = p[K], kr = p[KR], c0 = p[C], zk = p[ZK], mu = p[MU], length = p[LENGTH];
  cdem_lanes *const history = b->history + first;
  const int comps = twisting ? 2 : dim; /* 2: one number */
  const int count = lane_count(b);
#pragma GCC ivdep /* history overlaps nothing else of the batch */
  for (int i = 0; i < count; i++) {
    const lane_vector n = lane_normal(dim, b, i);
    const double radius = b->radius[i], k = k0 + kr * radius * radius;
    const double c = c0 + zk * radius * lane_root(b->mass[i] * k);
    const double cap = (mu * radius + length) * b->normal[i];
    const lane_vector spin = lane_get(dim, b->spin, i);
    const double about = dim == 3 ? lane_dot(3, spin, n) : 0.0;
    lane_vector rate = twisting ? (lane_vector){about, 0.0, 0.0} : lane_sum(dim, spin, -about, n);
    lane_vector old = lane_get(comps, history, i);
    if (!twisting)
      old = lane_turned(dim, b, n, old, step, i);
    const lane_vector trial = lane_sum(comps, old, k * step, rate);
    const lane_vector whole = lane_sum(comps, trial, c, rate);
    const double cut = lane_cut(comps, whole, cap);
    const lane_vector spring = lane_scaled(comps, trial, cut);
    const lane_vector moment = lane_scaled(comps, whole, cut);
    lane_put(comps, history, i, spring);
    const lane_vector add = twisting ? lane_scaled(3, n, moment.x) : moment;
    lane_put(dim, b->moment, i, lane_sum(dim, lane_get(dim, b->moment, i), 1.0, add));
    if (energies) {
      const lane_vector gain = lane_get(dim, b->spin_gain, i);
      const double gain_about = dim == 3 ? lane_dot(3, gain, n) : 0.0;
      const lane_vector more =
          twisting ? (lane_vector){gain_about, 0.0, 0.0} : lane_sum(dim, gain, -gain_about, n);
      const lane_vector ahead = lane_sum(comps, rate, 0.5, more);
      const lane_vector dash = lane_sum(comps, moment, -1.0, spring);
      const lane_vector mean = lane_sum(comps, old, 1.0, spring);
      const lane_vector grown = lane_sum(comps, spring, -1.0, old);
      const double inverse = k > 0.0 ? 1.0 / k : 0.0;
      b->stored_moment[i] += 0.5 * inverse * lane_dot(comps, spring, spring);
      b->damped[i] += step * lane_dot(comps, dash, ahead);
      b->rolled[i] +=
          0.5 * (step * lane_dot(comps, mean, rate) - inverse * lane_dot(comps, mean, grown));
    }
  }
}

#define SPRING(name, dim, twisting, energies)                                                      \
  CDEM_MULTIVERSION static void name(const cdem_law_parameters *p, int first, cdem_batch *b) {     \
    spring_lanes(p, first, b, dim, twisting, energies);                                            \
  }
SPRING(rolling_2, 2, 0, 0)
SPRING(rolling_2_energies, 2, 0, 1)
SPRING(rolling_3, 3, 0, 0)
SPRING(rolling_3_energies, 3, 0, 1)
SPRING(twisting_3, 3, 1, 0)
SPRING(twisting_3_energies, 3, 1, 1)
#undef SPRING

static void spring_one(const cdem_law_parameters *parameters, int first, cdem_batch *b, int lane,
                       int kind) {
  const double *p = parameters->p;
  reference_contact c;
  reference_read(b, lane, kind == 2 ? 2 : 3, &c);
  reference_add(b, lane, &c);
  double k = p[K] + p[KR] * c.radius * c.radius;
  double dashpot = p[C] + p[ZK] * c.radius * sqrt(c.mass * k);
  double cap = (p[MU] * c.radius + p[LENGTH]) * c.normal;
  if (kind == 4)
    reference_twisting(&c, first, k, dashpot, cap);
  else
    reference_rolling(&c, first, k, dashpot, cap);
  reference_write_moment(&c, b, lane);
}
static void rolling_one_2(const cdem_law_parameters *p, int first, cdem_batch *b, int lane) {
  spring_one(p, first, b, lane, 2);
}
static void rolling_one_3(const cdem_law_parameters *p, int first, cdem_batch *b, int lane) {
  spring_one(p, first, b, lane, 3);
}
static void twisting_one_3(const cdem_law_parameters *p, int first, cdem_batch *b, int lane) {
  spring_one(p, first, b, lane, 4);
}

static cdem_status rolling_prepare(int dim, const cdem_contact_input *input, double shear,
                                   cdem_law_parameters *parameters, cdem_fault *fault) {
  const double *v = input->value;
  double *p = parameters->p, k = v[CDEM_LAW_rolling_stiffness];
  double mu = v[CDEM_LAW_rolling_friction], length = v[CDEM_LAW_rolling_length];
  CDEM_REQUIRE(!isnan(mu) || !isnan(length), fault, CDEM_INPUT,
               "rolling resistance 'spring' needs 'rolling_friction' or 'rolling_length'");
  CDEM_REQUIRE(!isnan(k) || shear > 0.0, fault, CDEM_INPUT,
               "rolling resistance 'spring' needs 'rolling_stiffness': the law has no constant "
               "shear stiffness to take it from");
  CDEM_REQUIRE(isnan(v[CDEM_LAW_rolling_dashpot]) || isnan(v[CDEM_LAW_rolling_damping_ratio]),
               fault, CDEM_INPUT,
               "'rolling_dashpot' and 'rolling_damping_ratio' were both given: give one");
  double zeta = v[CDEM_LAW_rolling_damping_ratio];
  p[K] = isnan(k) ? 0.0 : k;
  p[KR] = isnan(k) ? shear : 0.0;
  p[C] = isnan(v[CDEM_LAW_rolling_dashpot]) ? 0.0 : v[CDEM_LAW_rolling_dashpot];
  if (isnan(zeta))
    zeta = isnan(v[CDEM_LAW_rolling_dashpot]) ? 0.1 : 0.0;
  p[ZK] = 2.0 * zeta * sqrt(inertia[dim - 2]);
  p[MU] = isnan(mu) ? 0.0 : mu;
  p[LENGTH] = isnan(length) ? 0.0 : length;
  return CDEM_OK;
}

static cdem_status twisting_prepare(int dim, const cdem_contact_input *input, double shear,
                                    cdem_law_parameters *parameters, cdem_fault *fault) {
  (void)dim;
  const double *v = input->value;
  double *p = parameters->p, k = v[CDEM_LAW_twisting_stiffness];
  CDEM_REQUIRE(!isnan(k) || shear > 0.0, fault, CDEM_INPUT,
               "twisting resistance 'spring' needs 'twisting_stiffness': the law has no constant "
               "shear stiffness to take it from");
  p[K] = isnan(k) ? 0.0 : k;
  p[KR] = isnan(k) ? shear : 0.0;
  p[C] = 0.0;
  p[ZK] = 2.0 * v[CDEM_LAW_twisting_damping_ratio] * sqrt(inertia[1]);
  p[MU] = v[CDEM_LAW_twisting_friction];
  p[LENGTH] = 0.0;
  return CDEM_OK;
}

static double spring_stiffness(const cdem_law_parameters *parameters, double radius) {
  return parameters->p[K] + parameters->p[KR] * radius * radius;
}

const cdem_resistance cdem_rolling_spring = {
    .name = "spring",
    .help = "Rolling spring and dashpot with a largest moment (Iwashita & Oda 1998).",
    .wants = 5,
    .want = {{CDEM_LAW_rolling_stiffness, false, NAN, 0.0, INFINITY, true},
             {CDEM_LAW_rolling_friction, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_length, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_dashpot, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_damping_ratio, false, NAN, 0.0, INFINITY, false}},
    .history = {1, 3},
    .parity = {{-1.0}, {-1.0, -1.0, -1.0}},
    .tangent_vector = true,
    .prepare = rolling_prepare,
    .batch = {{rolling_2, rolling_2_energies}, {rolling_3, rolling_3_energies}},
    .one = {rolling_one_2, rolling_one_3},
    .stiffness = spring_stiffness};

const cdem_resistance cdem_twisting_spring = {
    .name = "spring",
    .help = "Twisting spring and dashpot with a largest moment about the normal.",
    .wants = 3,
    .want = {{CDEM_LAW_twisting_stiffness, false, NAN, 0.0, INFINITY, true},
             {CDEM_LAW_twisting_friction, true, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_twisting_damping_ratio, false, 0.1, 0.0, INFINITY, false}},
    .history = {0, 1},
    .parity = {{0.0}, {1.0}},
    .prepare = twisting_prepare,
    .batch = {{NULL, NULL}, {twisting_3, twisting_3_energies}},
    .one = {NULL, twisting_one_3},
    .stiffness = spring_stiffness};
