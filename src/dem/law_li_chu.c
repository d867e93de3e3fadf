/* Discs of Li & Chu (2005), as used by Li & Wan (2010), section 2.1: sliding, rolling force and
 * rolling moment, each a spring and a dashpot with a cap.
 *
 *     F_N = max(0, kN d + cN d')
 *     F_s = ks us + cs us',   us' = (vB - vA).t - (a_A wA + a_B wB),   |F_s| <= mu_s F_N
 *     F_r = kr ur + cr ur',   ur' = R (wB - wA),                       |F_r| <= mu_r F_N
 *     M_r = kw wr + cw wr',   wr' = wB - wA,                           |M_r| <= mu_w F_N
 *
 * R = rA rB/(rA + rB), to a wall rA; mu_w is a length. A force that meets its cap sets its history
 * back to F/k, dashpot included, as printed: with dashpots that can leave a spring with more than
 * it was given, so here (unlike in linear) `damped` may be negative. The force on A is F_s + F_r
 * along t. F_r changes sign when A and B are exchanged but a pair of forces must not, so A is taken
 * to be the grain with the lower id (batch: label), a wall is always B. The power of F_r is that of
 * a force on us', it neither stores nor dissipates: circulated. History: us, ur, wr.
 */
#include "dem/law_damping.h"
#include "dem/law_lanes.h"
#include "dem/law_reference.h"

enum { KN, CN, KS, CS, MS, KR, CR, MR, KW, CW, MW };

/* One spring and dashpot: force, new stretch, energy, what its dashpot and its cap took. */
typedef struct {
  double force, stretch, stored, damped, slid;
} li_chu_spring;

CDEM_ALWAYS_INLINE li_chu_spring li_chu_pull(double k, double c, double inverse, double old,
                                             double rate, double ahead, double cap, double step) {
  const double trial = old + rate * step, whole = k * trial + c * rate;
  const double force = lane_max(lane_min(whole, cap), -cap);
  const double stretch = whole == force ? trial : force * inverse;
  const double beside = (force - k * stretch) * ahead * step;
  const double cut = 0.5 * k * (old + stretch) * (rate * step - (stretch - old));
  return (li_chu_spring){force, stretch, 0.5 * k * stretch * stretch, whole == force ? beside : 0.0,
                         whole == force ? cut : cut + beside};
}

CDEM_ALWAYS_INLINE void li_chu_lanes(const cdem_law_parameters *parameters, cdem_batch *b,
                                     int energies) {
  const double *p = parameters->p;
  const double kn = p[KN], cn = p[CN], ks = p[KS], cs = p[CS], ms = p[MS], kr = p[KR], cr = p[CR];
  const double mr = p[MR], kw = p[KW], cw = p[CW], mw = p[MW], step = b->step;
  const double is = ks > 0.0 ? 1.0 / ks : 0.0, ir = kr > 0.0 ? 1.0 / kr : 0.0;
  const double iw = kw > 0.0 ? 1.0 / kw : 0.0;
  const int count = lane_count(b);
  for (int i = 0; i < count; i++) {
    const lane_vector n = lane_normal(2, b, i);
    const double d = b->overlap[i], spin = b->spin[0][i], radius = b->radius[i];
    const double away = lane_normal_rate(2, b->velocity, n, i);
    const double rate = lane_slide_rate(2, b->velocity, b->turning, n, away, i).x;
    const double push = lane_max(0.0, kn * d - cn * away);
    double gain = 0.0, ahead = 0.0, spin_ahead = 0.0;
    if (energies) {
      const double kick = lane_normal_rate(2, b->velocity_gain, n, i);
      const double deep = lane_overlap_before(b, away, i);
      const double before = lane_max(0.0, kn * deep - cn * (away - kick));
      gain = lane_own_gain(b, kick, push, deep > 0.0 ? before : 0.0, i);
      ahead = rate + 0.5 * lane_slide_gain(2, b, n, (lane_vector){0.0, 0.0, 0.0}, i).x;
      spin_ahead = spin + 0.5 * b->spin_gain[0][i];
    }
    const li_chu_spring s = li_chu_pull(ks, cs, is, b->history[0][i], rate, ahead, ms * push, step);
    const li_chu_spring r =
        li_chu_pull(kr, cr, ir, b->history[1][i], radius * spin, 0.0, mr * push, step);
    const li_chu_spring w =
        li_chu_pull(kw, cw, iw, b->history[2][i], spin, spin_ahead, mw * push, step);
    const double rolling = b->label[i] * r.force;
    b->normal[i] = push;
    b->shear[0][i] = s.force + rolling;
    b->moment[0][i] = w.force;
    b->history[0][i] = s.stretch;
    b->history[1][i] = r.stretch;
    b->history[2][i] = w.stretch;
    if (energies) {
      b->stored_normal[i] = 0.5 * kn * d * d;
      b->stored_shear[i] = s.stored;
      b->stored_moment[i] = w.stored;
      b->damped[i] = s.damped + w.damped - step * (push - kn * d) * (away + 0.5 * gain);
      b->slid[i] = s.slid;
      b->rolled[i] = w.slid;
      b->circulated[i] = step * rolling * ahead;
    }
  }
}

CDEM_MULTIVERSION static void li_chu_2(const cdem_law_parameters *p, cdem_batch *b) {
  li_chu_lanes(p, b, 0);
}
CDEM_MULTIVERSION static void li_chu_2_energies(const cdem_law_parameters *p, cdem_batch *b) {
  li_chu_lanes(p, b, 1);
}

/* The same with branches. Returns the force. */
static double pull_one(double k, double c, double cap, double rate, double ahead, double step,
                       double *stretch, double *stored, double *damped, double *slid) {
  double old = *stretch, force = k * (old + rate * step) + c * rate, spring = old + rate * step;
  bool capped = fabs(force) > cap;
  if (capped) {
    force = force > 0.0 ? cap : -cap;
    spring = k > 0.0 ? force / k : 0.0;
  }
  double work = 0.5 * k * (old + spring) * rate * step;
  *stretch = spring;
  *stored += 0.5 * k * spring * spring;
  *slid += work - 0.5 * k * (spring * spring - old * old);
  *(capped ? slid : damped) += (force - k * spring) * ahead * step;
  return force;
}

static void li_chu_one(const cdem_law_parameters *parameters, cdem_batch *b, int lane) {
  const double *p = parameters->p;
  reference_contact c;
  reference_read(b, lane, 2, &c);
  double push = p[KN] * c.overlap + p[CN] * c.approach, none = 0.0;
  if (push < 0.0)
    push = 0.0;
  double deep = reference_deep(&c), before = p[KN] * deep + p[CN] * reference_speed(&c);
  reference_normal(&c, push, p[KN] * c.overlap, 0.5 * p[KN] * c.overlap * c.overlap,
                   deep > 0.0 && before > 0.0 ? before : 0.0);
  const double t[2] = {-c.n[1], c.n[0]};
  double rate = c.slide[0] * t[0] + c.slide[1] * t[1];
  double ahead = c.slide_ahead[0] * t[0] + c.slide_ahead[1] * t[1];
  double sliding = pull_one(p[KS], p[CS], p[MS] * push, rate, ahead, c.step, &c.history[0],
                            &c.stored_shear, &c.damped, &c.slid);
  double rolling = pull_one(p[KR], p[CR], p[MR] * push, c.radius * c.spin[2], 0.0, c.step,
                            &c.history[1], &none, &none, &none);
  c.moment[2] = pull_one(p[KW], p[CW], p[MW] * push, c.spin[2], c.spin_ahead[2], c.step,
                         &c.history[2], &c.stored_moment, &c.damped, &c.rolled);
  rolling *= c.label;
  c.circulated = rolling * ahead * c.step;
  for (int k = 0; k < 2; k++)
    c.shear[k] = (sliding + rolling) * t[k];
  reference_write(&c, b, lane, 2);
}

static cdem_status li_chu_prepare(int dim, const cdem_contact_input *input,
                                  const cdem_grain_material *a, const cdem_grain_material *b,
                                  cdem_law_parameters *parameters, cdem_fault *fault) {
  (void)dim, (void)a, (void)b;
  static const cdem_law_key order[] = {CDEM_LAW_normal_stiffness,
                                       CDEM_LAW_normal_dashpot,
                                       CDEM_LAW_shear_stiffness,
                                       CDEM_LAW_shear_dashpot,
                                       CDEM_LAW_friction,
                                       CDEM_LAW_rolling_force_stiffness,
                                       CDEM_LAW_rolling_force_dashpot,
                                       CDEM_LAW_rolling_force_friction,
                                       CDEM_LAW_rolling_stiffness,
                                       CDEM_LAW_rolling_dashpot,
                                       CDEM_LAW_rolling_length};
  for (int k = KN; k <= MW; k++)
    parameters->p[k] = input->value[order[k]];
  double arms = input->value[CDEM_LAW_arms_by_radius];
  CDEM_REQUIRE(arms == 0.0 || arms == 1.0, fault, CDEM_INPUT,
               "'arms_by_radius' = %g must be 0 or 1", arms);
  return CDEM_OK;
}

static void li_chu_stiffness(const cdem_law_parameters *parameters, double radius, double mass,
                             double overlap, double *normal, double *shear, double dashpot[2]) {
  (void)radius, (void)mass, (void)overlap;
  const double *p = parameters->p;
  *normal = p[KN];
  *shear = p[KS] + p[KR];
  dashpot[0] = p[CN];
  dashpot[1] = p[CS] + p[CR];
}

/* F_s alone: F_r has a bound of its own. */
static double li_chu_sliding(const cdem_law_parameters *parameters, const cdem_batch *b, int lane) {
  const double *p = parameters->p, cap = p[MR] * b->normal[lane];
  double rolling = p[KR] * b->history[1][lane] + p[CR] * (b->radius[lane] * b->spin[0][lane]);
  return b->shear[0][lane] - b->label[lane] * fmax(-cap, fmin(cap, rolling));
}

const cdem_law cdem_law_li_chu = {
    .name = "li-chu",
    .help = "Discs with sliding, rolling force and rolling moment (Li & Chu 2005; Li & Wan 2010).",
    .dims = {[2] = true},
    .why =
        "the published law is for discs, its rolling force has no meaning in space; take 'linear' "
        "with rolling 'spring'",
    .wants = 12,
    .want = {{CDEM_LAW_normal_stiffness, true, NAN, 0.0, INFINITY, true},
             {CDEM_LAW_normal_dashpot, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_shear_stiffness, true, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_dashpot, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_friction, true, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_force_stiffness, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_force_dashpot, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_force_friction, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_stiffness, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_dashpot, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_length, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_arms_by_radius, false, 0.0, 0.0, 1.0, false}},
    .history = {3, 0},
    .parity = {{1.0, -1.0, -1.0}, {0.0}},
    .labels = true,
    .potential = true,
    .rolls = true,
    .prepare = li_chu_prepare,
    .batch = {{li_chu_2, li_chu_2_energies}, {NULL, NULL}},
    .one = {li_chu_one, NULL},
    .stiffness = li_chu_stiffness,
    .sliding = li_chu_sliding};
