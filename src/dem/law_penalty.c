/* Penalty springs on the nodes of both surfaces, in the limit of rigid spheres and many nodes.
 *
 * Wang et al. (2024, Chin. J. Geotech. Eng. 46, 2371, eqs 1-3) give every surface node that is
 * inside another grain a spring k = p A, A its share of the surface and p the penalty stiffness
 * (N/m^3). For spheres that keep their shape the sum over the nodes of one surface is p times the
 * integral of the depth over the area of contact. With the depth d - r^2/2R within a^2 = 2 R d that
 * is the volume of the lens,
 *
 *     pi a^2 d - pi a^4/4R = pi R d^2,  R = rA rB/(rA + rB)
 *
 * and both surfaces carry nodes; those of a wall do not (c = 2 between grains, 1 on a wall):
 *
 *     F_N = max(0, c p pi R d^2 + cn d'),   kn = 2 c p pi R d = c p pi a^2
 *     dF_t = ks ds + ..., ks = shear_ratio kn, |F_t| <= mu F_N
 *
 * The exact lens is smaller, by d/6r between equal spheres and d/3r on a wall: 1 and 2 % where the
 * overlap is 6 % of the radius (docs/theory/dem.md, eq 19e; test dem.law_penalty).
 *
 * Dashpots 2 beta sqrt(m k) with the tangent stiffnesses, beta = damping_ratio. In d^(3/2) the
 * collision is a linear oscillator of damping ratio beta sqrt(4/3), so its restitution does not
 * depend on the velocity, as with Hertz (law_damping.h). The source damps node by node, with the
 * mass of a node instead of the reduced one.
 *
 * Shear: stiffness goes with the area, and where the area shrinks the force shrinks with it, as in
 * law_hertz.c: this creates no energy. History: the force of the shear spring, then the overlap.
 */
#include "dem/law_damping.h"
#include "dem/law_lanes.h"
#include "dem/law_reference.h"

enum { PI_P, RATIO, MU, AN, AS };
static const double pi = 3.14159265358979323846;

CDEM_ALWAYS_INLINE void penalty_lanes(const cdem_law_parameters *parameters, cdem_batch *b,
                                      int energies) {
  const double *p = parameters->p;
  const double pi_p = p[PI_P], ratio = p[RATIO], mu = p[MU], an = p[AN], as = p[AS];
  const double step = b->step;
  const int count = lane_count(b);
  for (int i = 0; i < count; i++) {
    const lane_vector n = lane_normal(3, b, i);
    const double k = (b->arm[1][i] > 0.0 ? 2.0 : 1.0) * pi_p * b->radius[i];
    const double d = b->overlap[i], before = b->history[3][i], mass = b->mass[i];
    const double away = lane_normal_rate(3, b->velocity, n, i);
    const double elastic = k * d * d, root = lane_root(mass * (2.0 * k * d));
    const double push = lane_max(0.0, elastic - an * root * away);
    const lane_vector rate = lane_slide_rate(3, b->velocity, b->turning, n, away, i);
    const double now = 2.0 * ratio * k * d;
    const double way = ratio * k * (d + lane_min(before, d));
    const double keep = before > d ? d / before : 1.0;
    const lane_vector old = lane_turned(3, b, n, lane_get(3, b->history, i), step, i);
    const lane_vector whole = lane_sum(3, lane_scaled(3, old, keep), way * step, rate);
    const lane_vector pulled = lane_sum(3, whole, as * root, rate);
    const double cut = lane_cut(3, pulled, mu * push);
    const lane_vector spring = lane_scaled(3, whole, cut);
    const lane_vector force = lane_scaled(3, pulled, cut);
    b->normal[i] = push;
    lane_put(3, b->shear, i, force);
    lane_put(3, b->history, i, spring);
    b->history[3][i] = d;
    lane_put(3, b->moment, i, (lane_vector){0.0, 0.0, 0.0});
    if (energies) {
      const double kick = lane_normal_rate(3, b->velocity_gain, n, i);
      const double deep = lane_overlap_before(b, away, i);
      const double less =
          lane_max(0.0, k * deep * deep - an * lane_root(mass * (2.0 * k * deep)) * (away - kick));
      const double gain = lane_own_gain(b, kick, push, less, i);
      const lane_vector more = lane_slide_gain(3, b, n, force, i);
      const lane_vector ahead = lane_sum(3, rate, 0.5, more);
      const lane_vector dash = lane_sum(3, force, -1.0, spring);
      const double soft_now = now > 0.0 ? 0.5 / now : 0.0;
      const double then = ratio * k * before, soft_before = then > 0.0 ? 0.25 / then : 0.0;
      const double was = soft_before * lane_dot(3, old, old);
      const double stored = soft_now * lane_dot(3, spring, spring);
      const double work = 0.5 * step * lane_dot(3, lane_sum(3, old, 1.0, spring), rate);
      b->stored_normal[i] = elastic * d / 3.0;
      b->stored_shear[i] = stored;
      b->stored_moment[i] = 0.0;
      b->damped[i] = step * (lane_dot(3, dash, ahead) - (push - elastic) * (away + 0.5 * gain));
      b->slid[i] = work - (stored - was);
      b->rolled[i] = 0.0;
      b->circulated[i] = 0.0;
    }
  }
}

CDEM_MULTIVERSION static void penalty_3(const cdem_law_parameters *p, cdem_batch *b) {
  penalty_lanes(p, b, 0);
}
CDEM_MULTIVERSION static void penalty_3_energies(const cdem_law_parameters *p, cdem_batch *b) {
  penalty_lanes(p, b, 1);
}

static void penalty_one(const cdem_law_parameters *parameters, cdem_batch *b, int lane) {
  const double *p = parameters->p;
  reference_contact c;
  reference_read(b, lane, 3, &c);
  double surfaces = c.arm[1] > 0.0 ? 2.0 : 1.0, k = surfaces * p[PI_P] * c.radius;
  double elastic = k * c.overlap * c.overlap, root = sqrt(2.0 * c.mass * k * c.overlap);
  double push = fmax(0.0, elastic + p[AN] * root * c.approach);
  double deep = reference_deep(&c), before = c.history[3];
  double less = k * deep * deep + p[AN] * sqrt(2.0 * c.mass * k * deep) * reference_speed(&c);
  reference_normal(&c, push, elastic, elastic * c.overlap / 3.0, fmax(0.0, less));
  reference_shear(
      &c, &(reference_shear_spring){.before = 2.0 * p[RATIO] * k * before,
                                    .now = 2.0 * p[RATIO] * k * c.overlap,
                                    .keep = c.overlap < before ? c.overlap / before : 1.0,
                                    .way = p[RATIO] * k * (c.overlap + fmin(c.overlap, before)),
                                    .dashpot = p[AS] * root,
                                    .cap = p[MU] * push});
  c.history[3] = c.overlap;
  reference_write(&c, b, lane, 3);
}

static cdem_status penalty_prepare(int dim, const cdem_contact_input *input,
                                   const cdem_grain_material *a, const cdem_grain_material *b,
                                   cdem_law_parameters *parameters, cdem_fault *fault) {
  (void)dim, (void)a, (void)b;
  const double *v = input->value;
  double *p = parameters->p, zeta, dashpot, shear = v[CDEM_LAW_shear_damping_ratio];
  CDEM_TRY(cdem_law_damping(input, false, &zeta, &dashpot, fault));
  double beta = isnan(v[CDEM_LAW_restitution]) ? zeta : sqrt(0.75) * zeta;
  p[PI_P] = pi * v[CDEM_LAW_penalty_stiffness];
  p[RATIO] = v[CDEM_LAW_shear_ratio];
  p[MU] = v[CDEM_LAW_friction];
  p[AN] = 2.0 * beta;
  p[AS] = 2.0 * (isnan(shear) ? beta : shear) * sqrt(p[RATIO]);
  return CDEM_OK;
}

/* Of two grains; on a wall half of it, and the step errs to the safe side. */
static void penalty_stiffness(const cdem_law_parameters *parameters, double radius, double mass,
                              double overlap, double *normal, double *shear, double dashpot[2]) {
  const double *p = parameters->p;
  *normal = 4.0 * p[PI_P] * radius * overlap;
  *shear = p[RATIO] * *normal;
  dashpot[0] = p[AN] * sqrt(mass * *normal);
  dashpot[1] = p[AS] * sqrt(mass * *normal);
}

const cdem_law cdem_law_penalty = {
    .name = "penalty",
    .help = "Penalty springs on both surfaces, spheres that keep their shape (Wang et al. 2024).",
    .dims = {[3] = true},
    .why = "its stiffness is one of areas, and discs do not say how thick they are; take 'linear'",
    .wants = 6,
    .want = {{CDEM_LAW_penalty_stiffness, true, NAN, 0.0, INFINITY, true},
             {CDEM_LAW_shear_ratio, false, 1.0, 0.0, INFINITY, false},
             {CDEM_LAW_friction, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_restitution, false, NAN, 0.0, 1.0, true},
             {CDEM_LAW_damping_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_damping_ratio, false, NAN, 0.0, INFINITY, false}},
    .history = {0, 4},
    .parity = {{0.0}, {-1.0, -1.0, -1.0, 1.0}},
    .tangent_vectors = 1,
    .prepare = penalty_prepare,
    .batch = {{NULL, NULL}, {penalty_3, penalty_3_energies}},
    .one = {NULL, penalty_one},
    .stiffness = penalty_stiffness};
