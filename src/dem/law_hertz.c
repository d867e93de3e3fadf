/* Hertz-Mindlin: spheres of elastic materials.
 *
 *     F_N = max(0, 4/3 E* sqrt(R d) d + cn d'),  a = sqrt(R d)                       Hertz 1882
 *     dF_t = 8 G* a ds + ..., |F_t| <= mu F_N                                        Mindlin 1949
 *     1/E* = (1 - nu_A^2)/E_A + (1 - nu_B^2)/E_B,  1/G* = (2 - nu_A)/G_A + (2 - nu_B)/G_B
 *
 * Dashpots alpha sqrt(m k) with the tangent stiffness (Tsuji, Tanaka & Ishida 1992), alpha =
 * 2 sqrt(5/6) zeta; the restitution is then the same for every velocity (law_damping.h).
 *
 * Shear: no slip inside the contact area. Where the area grows, the force is kept and grows with
 * the larger stiffness; where it shrinks, the force shrinks with it, because what carried the lost
 * rim is gone (rescaling = 1, after Thornton, Cummins & Cleary 2013, Powder Technology 233, 30).
 * With F^2/2k as the energy that can come back, both lose energy and neither makes any
 * (docs/theory/dem.md). rescaling = 0 keeps the force in both cases: it can create energy, which is
 * booked as circulated. History: the force of the shear spring, then the contact radius a.
 */
#include "dem/law_elastic.h"
#include "dem/law_lanes.h"
#include "dem/law_reference.h"

/* KEEP 0: rescaling, 1: not; MOST: bound of the old stiffness in units of the new one, 1 or
 * infinite. */
enum {
  FOUR_THIRDS = ELASTIC_FOUR_THIRDS,
  KN = ELASTIC_KN,
  KS = ELASTIC_KS,
  MU = ELASTIC_MU,
  AN = ELASTIC_AN,
  AS = ELASTIC_AS,
  KEEP = ELASTIC_PARAMETERS,
  MOST
};

CDEM_ALWAYS_INLINE void hertz_lanes(const cdem_law_parameters *parameters, cdem_batch *b,
                                    int energies) {
  const double *p = parameters->p;
  const double e43 = p[FOUR_THIRDS], e2 = p[KN], g8 = p[KS], mu = p[MU], an = p[AN], as = p[AS];
  const double always = p[KEEP], most = p[MOST], step = b->step;
  const int count = lane_count(b);
  for (int i = 0; i < count; i++) {
    const lane_vector n = lane_normal(3, b, i);
    const double d = b->overlap[i], a = lane_root(b->radius[i] * d), before = b->history[3][i];
    const double away = lane_normal_rate(3, b->velocity, n, i);
    const double elastic = e43 * a * d, root = lane_root(b->mass[i] * (e2 * a));
    const double push = lane_max(0.0, elastic - an * root * away);
    const lane_vector rate = lane_slide_rate(3, b->velocity, b->turning, n, away, i);
    const double now = g8 * a, limit = most * a;
    const double way = 0.5 * g8 * (a + (before < limit ? before : limit));
    const double shrunk = before > a ? a / before : 1.0, keep = lane_max(shrunk, always);
    const lane_vector old = lane_turned(3, b, n, lane_get(3, b->history, i), step, i);
    const lane_vector whole = lane_sum(3, lane_scaled(3, old, keep), way * step, rate);
    const double cap = mu * push;
    const lane_vector pulled = lane_sum(3, whole, as * root, rate);
    const double cut = lane_cut(3, pulled, cap);
    const lane_vector spring = lane_scaled(3, whole, cut);
    const lane_vector force = lane_scaled(3, pulled, cut);
    b->normal[i] = push;
    lane_put(3, b->shear, i, force);
    lane_put(3, b->history, i, spring);
    b->history[3][i] = a;
    lane_put(3, b->moment, i, (lane_vector){0.0, 0.0, 0.0});
    if (energies) {
      const double kick = lane_normal_rate(3, b->velocity_gain, n, i);
      const double deep = lane_overlap_before(b, away, i), was_a = lane_root(b->radius[i] * deep);
      const double less = lane_max(
          0.0, e43 * was_a * deep - an * lane_root(b->mass[i] * (e2 * was_a)) * (away - kick));
      const double gain = lane_own_gain(b, kick, push, less, i);
      const lane_vector more = lane_slide_gain(3, b, n, force, i);
      const lane_vector ahead = lane_sum(3, rate, 0.5, more);
      const lane_vector dash = lane_sum(3, force, -1.0, spring);
      const double soft_now = now > 0.0 ? 0.5 / now : 0.0;
      const double soft_before = before > 0.0 ? 0.5 / (g8 * before) : 0.0;
      const double was = soft_before * lane_dot(3, old, old);
      const double stored = soft_now * lane_dot(3, spring, spring);
      const double work = 0.5 * step * lane_dot(3, lane_sum(3, old, 1.0, spring), rate);
      const double work_whole = 0.5 * step * lane_dot(3, lane_sum(3, old, 1.0, whole), rate);
      const double leak = always * (work_whole - (soft_now * lane_dot(3, whole, whole) - was));
      b->stored_normal[i] = 0.4 * elastic * d;
      b->stored_shear[i] = stored;
      b->stored_moment[i] = 0.0;
      b->damped[i] = step * (lane_dot(3, dash, ahead) - (push - elastic) * (away + 0.5 * gain));
      b->slid[i] = work - (stored - was) - leak;
      b->rolled[i] = 0.0;
      b->circulated[i] = leak;
    }
  }
}

CDEM_MULTIVERSION static void hertz_3(const cdem_law_parameters *p, cdem_batch *b) {
  hertz_lanes(p, b, 0);
}
CDEM_MULTIVERSION static void hertz_3_energies(const cdem_law_parameters *p, cdem_batch *b) {
  hertz_lanes(p, b, 1);
}

static void hertz_one(const cdem_law_parameters *parameters, cdem_batch *b, int lane) {
  const double *p = parameters->p;
  reference_contact c;
  reference_read(b, lane, 3, &c);
  double a = sqrt(c.radius * c.overlap), before = c.history[3];
  double elastic = p[FOUR_THIRDS] * a * c.overlap;
  double push = elastic + p[AN] * sqrt(c.mass * p[KN] * a) * c.approach;
  if (push < 0.0)
    push = 0.0;
  bool rescale = p[KEEP] == 0.0;
  double deep = reference_deep(&c), was = sqrt(c.radius * deep);
  double less =
      p[FOUR_THIRDS] * was * deep + p[AN] * sqrt(c.mass * p[KN] * was) * reference_speed(&c);
  reference_normal(&c, push, elastic, 0.4 * elastic * c.overlap, fmax(0.0, less));
  reference_shear(
      &c, &(reference_shear_spring){.before = p[KS] * before,
                                    .now = p[KS] * a,
                                    .keep = rescale && a < before ? a / before : 1.0,
                                    .way = 0.5 * p[KS] * (a + (rescale && before > a ? a : before)),
                                    .leaks = !rescale,
                                    .dashpot = p[AS] * sqrt(c.mass * p[KN] * a),
                                    .cap = p[MU] * push});
  c.history[3] = a;
  reference_write(&c, b, lane, 3);
}

static cdem_status hertz_prepare(int dim, const cdem_contact_input *input,
                                 const cdem_grain_material *a, const cdem_grain_material *b,
                                 cdem_law_parameters *parameters, cdem_fault *fault) {
  (void)dim;
  bool plain = input->value[CDEM_LAW_rescaling] == 0.0;
  CDEM_TRY(cdem_law_elastic("hertz", input, a, b, parameters, fault));
  parameters->p[KEEP] = plain ? 1.0 : 0.0;
  parameters->p[MOST] = plain ? INFINITY : 1.0;
  return CDEM_OK;
}

const cdem_law cdem_law_hertz = {
    .name = "hertz",
    .help = "Elastic spheres: Hertz, Mindlin without slip, dashpots of Tsuji et al. (1992).",
    .dims = {[3] = true},
    .why = CDEM_LAW_ELASTIC_WHY,
    .wants = 6,
    .want = {{CDEM_LAW_friction, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_restitution, false, NAN, 0.0, 1.0, true},
             {CDEM_LAW_damping_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_damping_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_rescaling, false, 1.0, 0.0, 1.0, false}},
    .history = {0, 4},
    .parity = {{0.0}, {-1.0, -1.0, -1.0, 1.0}},
    .tangent_vectors = 1,
    .prepare = hertz_prepare,
    .batch = {{NULL, NULL}, {hertz_3, hertz_3_energies}},
    .one = {NULL, hertz_one},
    .stiffness = cdem_law_elastic_stiffness};
