/* Hertz-Mindlin with micro-slip: spheres of elastic materials whose contact slips at its rim before
 * it slips as a whole (Cattaneo 1938; Mindlin & Deresiewicz 1953, J. Appl. Mech. 20, 327).
 *
 * The normal force is that of law_hertz.c. In the tangential direction the contact is replaced by
 * independent springs along a line, stiffness (4 G*) dx, each with its share of friction
 * mu 2 E* (d - x^2/R) dx: for spheres that is exact, with all history of loading (method of
 * dimensionality reduction, Popov & Hess 2015, ch. 5; Jaeger 1993, Arch. Appl. Mech. 63, 117). Here
 * the springs between two edges are one. A ring of springs from p to q (in units of a) has
 *
 *     K = 8 G* a (q - p),    cap = mu F_N 3/2 ((q - p) - (q^3 - p^3)/3)
 *
 * whose sums are those of the whole contact; with a single ring the law is hertz. The edges are
 * fractions of the largest contact radius so far: while it grows, what the springs carry is spread
 * anew over the rings, and by convexity their energy falls; while the contact is smaller, the outer
 * rings lie partly or wholly outside. So the law can create no energy on any path, and an impact in
 * units of mu times the normal velocity depends on nothing but these units, as in the theory.
 * docs/theory/dem.md says how near it comes to it. History: the forces of the rings, from the
 * inside; the largest contact radius; that of the last step.
 */
#include "base/mat3.h"
#include "dem/law_elastic.h"
#include "dem/law_lanes.h"
#include "dem/law_reference.h"

/* Four rings; edges where impacts came nearest to the theory, rounded. */
enum { RINGS = 4, LARGEST = 3 * RINGS, BEFORE, NUMBERS };
#define EDGES                                                                                      \
  { 0.0, 0.4, 0.6, 0.8, 1.0 }

/* The part of ring k of the grid `width` that is in contact. */
CDEM_ALWAYS_INLINE double ring_span(const double edge[RINGS + 1], int k, double width, double a) {
  return lane_min(edge[k + 1] * width, a) - lane_min(edge[k] * width, a);
}

/* The forces of rings that have grown by a factor >= 1, spread over the new ones. Inner rings of
 * the grid take from the outer: of ring j, the share below the new edge k. */
CDEM_ALWAYS_INLINE void ring_spread(const double edge[RINGS + 1], double factor,
                                    lane_vector force[RINGS]) {
  double below[RINGS][RINGS + 1];
#pragma GCC unroll 5
  for (int j = 0; j < RINGS; j++) {
    const double inverse = 1.0 / (edge[j + 1] - edge[j]);
#pragma GCC unroll 5
    for (int k = 0; k <= RINGS; k++)
      below[j][k] = k == 0  ? 0.0
                    : k > j ? 1.0
                            : lane_min(lane_max((edge[k] * factor - edge[j]) * inverse, 0.0), 1.0);
  }
#pragma GCC unroll 5
  for (int k = 0; k < RINGS; k++) {
    lane_vector sum = lane_scaled(3, force[k], below[k][k + 1] - below[k][k]);
#pragma GCC unroll 5
    for (int j = k + 1; j < RINGS; j++)
      sum = lane_sum(3, sum, below[j][k + 1] - below[j][k], force[j]);
    force[k] = sum;
  }
}

/* The rings of a lane: their forces and stiffnesses on the way through a step; sums over them. */
typedef struct {
  lane_vector force[RINGS];
  double stiff[RINGS];
  lane_vector olds, springs, total; /* springs before and after, with dashpots */
  double was, stored;               /* energy before and after */
} rings;

/* Half the way with the springs of the last step ... */
CDEM_ALWAYS_INLINE void rings_begin(const double edge[RINGS + 1], const cdem_batch *b, double g8,
                                    lane_vector n, lane_vector rate, int i, int energies,
                                    rings *r) {
  const double width = b->history[LARGEST][i], before = b->history[BEFORE][i];
#pragma GCC unroll 5
  for (int k = 0; k < RINGS; k++) {
    const lane_vector old = lane_turned(3, b, n, lane_get(3, b->history + 3 * k, i), b->step, i);
    const double stiff = g8 * ring_span(edge, k, width, before);
    r->stiff[k] = stiff;
    r->force[k] = lane_sum(3, old, stiff * (0.5 * b->step), rate);
    if (energies) {
      r->was += (stiff > 0.0 ? 0.5 / stiff : 0.0) * lane_dot(3, old, old);
      r->olds = lane_sum(3, r->olds, 1.0, old);
    }
  }
}

/* What the contact is now: its radius, that of the grid, 8 G*, dashpot, mu F_N. */
typedef struct {
  double a, grid, g8, dashpot, cap;
} rings_now;

/* ... and half with those of this one; each ring meets its cap. */
CDEM_ALWAYS_INLINE void rings_end(const double edge[RINGS + 1], cdem_batch *b, rings_now c,
                                  lane_vector rate, int i, int energies, rings *r) {
  const double inverse = c.a > 0.0 ? 1.0 / c.a : 0.0;
#pragma GCC unroll 5
  for (int k = 0; k < RINGS; k++) {
    const double low = lane_min(edge[k] * c.grid * inverse, 1.0);
    const double high = lane_min(edge[k + 1] * c.grid * inverse, 1.0), span = high - low;
    const double now = c.g8 * ring_span(edge, k, c.grid, c.a);
    const double keep = now < r->stiff[k] ? now / r->stiff[k] : 1.0;
    const lane_vector whole =
        lane_sum(3, lane_scaled(3, r->force[k], keep), now * (0.5 * b->step), rate);
    const lane_vector pulled = lane_sum(3, whole, c.dashpot * span, rate);
    const double share = span - (high * high * high - low * low * low) * (1.0 / 3.0);
    const double cut = lane_cut(3, pulled, 1.5 * c.cap * share);
    const lane_vector spring = lane_scaled(3, whole, cut);
    r->total = lane_sum(3, r->total, cut, pulled);
    lane_put(3, b->history + 3 * k, i, spring);
    if (energies) {
      r->stored += (now > 0.0 ? 0.5 / now : 0.0) * lane_dot(3, spring, spring);
      r->springs = lane_sum(3, r->springs, 1.0, spring);
    }
  }
}

CDEM_ALWAYS_INLINE void mindlin_lanes(const cdem_law_parameters *parameters, cdem_batch *b,
                                      int energies) {
  static const double edge[RINGS + 1] = EDGES;
  const double *p = parameters->p, step = b->step;
  const double e43 = p[ELASTIC_FOUR_THIRDS], e2 = p[ELASTIC_KN], g8 = p[ELASTIC_KS];
  const double mu = p[ELASTIC_MU], an = p[ELASTIC_AN], as = p[ELASTIC_AS];
  const int count = lane_count(b);
  for (int i = 0; i < count; i++) {
    const lane_vector n = lane_normal(3, b, i), none = {0.0, 0.0, 0.0};
    const double d = b->overlap[i], a = lane_root(b->radius[i] * d), width = b->history[LARGEST][i];
    const double grid = lane_max(width, a), factor = width > 0.0 ? grid / width : 1.0;
    const double away = lane_normal_rate(3, b->velocity, n, i);
    const double elastic = e43 * a * d, root = lane_root(b->mass[i] * (e2 * a));
    const double push = lane_max(0.0, elastic - an * root * away);
    const lane_vector rate = lane_slide_rate(3, b->velocity, b->turning, n, away, i);
    rings r = {.olds = none, .springs = none, .total = none};
    rings_begin(edge, b, g8, n, rate, i, energies, &r);
    ring_spread(edge, factor, r.force);
    rings_end(edge, b, (rings_now){a, grid, g8, as * root, mu * push}, rate, i, energies, &r);
    b->normal[i] = push;
    lane_put(3, b->shear, i, r.total);
    b->history[LARGEST][i] = grid;
    b->history[BEFORE][i] = a;
    lane_put(3, b->moment, i, none);
    if (energies) {
      const double kick = lane_normal_rate(3, b->velocity_gain, n, i);
      const double deep = lane_overlap_before(b, away, i), was_a = lane_root(b->radius[i] * deep);
      const double before = lane_max(
          0.0, e43 * was_a * deep - an * lane_root(b->mass[i] * (e2 * was_a)) * (away - kick));
      const double gain = lane_own_gain(b, kick, push, before, i);
      const lane_vector more = lane_slide_gain(3, b, n, r.total, i);
      const lane_vector ahead = lane_sum(3, rate, 0.5, more);
      const lane_vector dash = lane_sum(3, r.total, -1.0, r.springs);
      const lane_vector both = lane_sum(3, r.olds, 1.0, r.springs);
      b->stored_normal[i] = 0.4 * elastic * d;
      b->stored_shear[i] = r.stored;
      b->stored_moment[i] = 0.0;
      b->damped[i] = step * (lane_dot(3, dash, ahead) - (push - elastic) * (away + 0.5 * gain));
      b->slid[i] = 0.5 * step * lane_dot(3, both, rate) - (r.stored - r.was);
      b->rolled[i] = 0.0;
      b->circulated[i] = 0.0;
    }
  }
}

CDEM_MULTIVERSION static void mindlin_3(const cdem_law_parameters *p, cdem_batch *b) {
  mindlin_lanes(p, b, 0);
}
CDEM_MULTIVERSION static void mindlin_3_energies(const cdem_law_parameters *p, cdem_batch *b) {
  mindlin_lanes(p, b, 1);
}

/* ---- the same in plain algebra ---- */

static double overlap_of(double from, double to, double low, double high) {
  return fmax(0.0, fmin(to, high) - fmax(from, low));
}

/* Springs of density force/width, moved over to rings `grid` wide where that is larger. */
static void spread_one(double width, double grid, double force[RINGS][3]) {
  static const double edge[RINGS + 1] = EDGES;
  double old[RINGS][3];
  if (!(width > 0.0) || !(grid > width))
    return;
  memcpy(old, force, sizeof old);
  memset(force, 0, sizeof old);
  for (int k = 0; k < RINGS; k++)
    for (int j = 0; j < RINGS; j++) {
      double from = edge[j] * width, to = edge[j + 1] * width;
      double share = overlap_of(from, to, edge[k] * grid, edge[k + 1] * grid) / (to - from);
      for (int c = 0; c < 3; c++)
        force[k][c] += share * old[j][c];
    }
}

static void mindlin_one(const cdem_law_parameters *parameters, cdem_batch *b, int lane) {
  static const double edge[RINGS + 1] = EDGES, nowhere[3] = {0.0};
  const double *p = parameters->p;
  reference_contact c;
  reference_read(b, lane, 3, &c);
  double a = sqrt(c.radius * c.overlap), width = c.history[LARGEST], before = c.history[BEFORE];
  double grid = fmax(width, a), elastic = p[ELASTIC_FOUR_THIRDS] * a * c.overlap;
  double root = sqrt(c.mass * p[ELASTIC_KN] * a), g8 = p[ELASTIC_KS], force[RINGS][3];
  double stiff[RINGS], pulled[3] = {0.0};
  double deep = reference_deep(&c), was = sqrt(c.radius * deep);
  double less = p[ELASTIC_FOUR_THIRDS] * was * deep +
                p[ELASTIC_AN] * sqrt(c.mass * p[ELASTIC_KN] * was) * reference_speed(&c);
  reference_normal(&c, fmax(0.0, elastic + p[ELASTIC_AN] * root * c.approach), elastic,
                   0.4 * elastic * c.overlap, fmax(0.0, less));
  for (int k = 0; k < RINGS; k++) {
    stiff[k] = g8 * overlap_of(edge[k] * width, edge[k + 1] * width, 0.0, before);
    reference_recall(&c, 3 * k, nowhere, force[k]);
    if (stiff[k] > 0.0)
      c.slid += 0.5 * cdem_dot3(force[k], force[k]) / stiff[k];
    for (int x = 0; x < 3; x++) {
      c.slid += 0.5 * force[k][x] * c.slide[x] * c.step;
      force[k][x] += 0.5 * stiff[k] * c.slide[x] * c.step;
    }
  }
  spread_one(width, grid, force);
  for (int k = 0; k < RINGS; k++) {
    double low = fmin(1.0, a > 0.0 ? edge[k] * grid / a : 0.0);
    double high = fmin(1.0, a > 0.0 ? edge[k + 1] * grid / a : 0.0);
    double now = g8 * (high - low) * a, dash[3], sum[3];
    for (int x = 0; x < 3; x++) {
      force[k][x] *= now < stiff[k] ? now / stiff[k] : 1.0;
      force[k][x] += 0.5 * now * c.slide[x] * c.step;
      dash[x] = p[ELASTIC_AS] * root * (high - low) * c.slide[x];
    }
    reference_meet(force[k], dash,
                   p[ELASTIC_MU] * c.normal * 1.5 *
                       (high - low - (pow(high, 3.0) - pow(low, 3.0)) / 3.0),
                   sum);
    double stored = now > 0.0 ? 0.5 * cdem_dot3(force[k], force[k]) / now : 0.0;
    c.stored_shear += stored;
    c.slid -= stored;
    for (int x = 0; x < 3; x++) {
      c.slid += 0.5 * force[k][x] * c.slide[x] * c.step;
      pulled[x] += sum[x] - force[k][x];
      c.shear[x] += sum[x];
      c.history[3 * k + x] = force[k][x];
    }
  }
  reference_dash(&c, pulled);
  c.history[LARGEST] = grid;
  c.history[BEFORE] = a;
  reference_write(&c, b, lane, 3);
}

static cdem_status mindlin_prepare(int dim, const cdem_contact_input *input,
                                   const cdem_grain_material *a, const cdem_grain_material *b,
                                   cdem_law_parameters *parameters, cdem_fault *fault) {
  (void)dim;
  return cdem_law_elastic("mindlin", input, a, b, parameters, fault);
}

_Static_assert((int)NUMBERS <= (int)CDEM_LAW_HISTORY, "the rings fit into a history");

const cdem_law cdem_law_mindlin = {
    .name = "mindlin",
    .help = "Elastic spheres as in hertz, with slip at the rim before the whole contact slides "
            "(Mindlin & Deresiewicz 1953).",
    .dims = {[3] = true},
    .why = CDEM_LAW_ELASTIC_WHY,
    .wants = 5,
    .want = {{CDEM_LAW_friction, false, 0.0, 0.0, INFINITY, false},
             {CDEM_LAW_restitution, false, NAN, 0.0, 1.0, true},
             {CDEM_LAW_damping_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_damping_ratio, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_shear_ratio, false, NAN, 0.0, INFINITY, false}},
    .history = {0, NUMBERS},
    .parity = {{0.0},
               {-1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0}},
    .tangent_vectors = RINGS,
    .prepare = mindlin_prepare,
    .batch = {{NULL, NULL}, {mindlin_3, mindlin_3_energies}},
    .one = {NULL, mindlin_one},
    .stiffness = cdem_law_elastic_stiffness};
