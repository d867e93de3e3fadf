/* The law of one interface point, formulas (1) to (6) of docs/rooms/cdem-interfaces.md. */
#include "cdem/interfaces.h"

#include <math.h>

/* Alternating returns settle within a few passes; each only adds to the paths. */
enum { PASSES = 60 };

/* Rounding of a strength, and of k (delta - delta^p): what lies within is on the surface. */
static double slack(double limit, double k, double size) {
  return 1e-14 * limit + 1e-15 * k * size;
}

static cdem_status check_energy(const char *key, double energy, const char *stiffness_key,
                                double stiffness, double strength, bool snaps, cdem_fault *fault) {
  if (strength == 0)
    return CDEM_OK;
  CDEM_REQUIRE(isfinite(energy) && energy > 0, fault, CDEM_INPUT,
               "%s = %g J/m^2; linear softening needs a positive energy", key, energy);
  double bound = strength * strength / (2 * energy);
  CDEM_REQUIRE(!snaps || stiffness >= bound, fault, CDEM_INPUT,
               "%s = %g Pa/m snaps back: it must be at least strength^2/(2 %s) = %g Pa/m; raise %s "
               "or %s",
               stiffness_key, stiffness, key, bound, stiffness_key, key);
  return CDEM_OK;
}

cdem_status cdem_interface_law_check(const cdem_interface_law *law, cdem_fault *fault) {
  const struct {
    const char *key, *unit;
    double value;
    bool positive;
  } values[] = {{"kn", "Pa/m", law->kn, true},
                {"ks", "Pa/m", law->ks, true},
                {"tension", "Pa", law->tension, false},
                {"cohesion", "Pa", law->cohesion, false},
                {"friction", "(tan phi)", law->friction, false},
                {"dilation", "(tan psi)", law->dilation, false}};
  for (int i = 0; i < 6; i++)
    CDEM_REQUIRE(isfinite(values[i].value) &&
                     (values[i].positive ? values[i].value > 0 : values[i].value >= 0),
                 fault, CDEM_INPUT, "%s = %g %s; it must be %s", values[i].key, values[i].value,
                 values[i].unit, values[i].positive ? "positive" : "0 or more");
  CDEM_REQUIRE(
      law->dilation <= law->friction, fault, CDEM_INPUT,
      "dilation = %g (tan psi) exceeds friction = %g (tan phi); sliding would gain energy: "
      "lower dilation",
      law->dilation, law->friction);
  if (law->softening == CDEM_SOFTENING_BRITTLE)
    return CDEM_OK;
  bool snaps = law->insertion == CDEM_INSERTION_PENALTY;
  CDEM_TRY(check_energy("energy_1", law->energy_1, "kn", law->kn, law->tension, snaps, fault));
  return check_energy("energy_2", law->energy_2, "ks", law->ks, law->cohesion, snaps, fault);
}

/* The irreversible path at which a strength is used up, (3): a spring that comes in loaded works
 * through its own elastic part first. */
static double path_end(const cdem_interface_law *law, double strength, double energy, double k) {
  if (law->softening == CDEM_SOFTENING_BRITTLE || strength == 0)
    return INFINITY;
  return 2 * energy / strength + (law->insertion == CDEM_INSERTION_TIED ? strength / k : 0);
}

/* One mode flowing in a step. */
typedef struct {
  double k, strength, end; /* of the mode */
  double path, damage;     /* D and d; updated */
  double start;            /* strength (of the mode, not yet used up) where the flow began */
  double flowed;           /* earlier in the step, booked with that strength */
  double flow, work;       /* out: growth of D with traction returned; integral of the strength */
} softening;

/* Solves k (e - flow) = strength (1 - max(d, (D + flow)/end)), (4): first along the plateau of the
 * damage there is, then down the slope. The work is the exact integral of the strength over D. */
static void soften(softening *mode, double e) {
  double level = mode->strength * (1 - mode->damage), knee = mode->damage * mode->end;
  double flow = e - level / mode->k;
  double begin = fmin(mode->start, mode->k * e), late = (begin - level) / 2 * mode->flowed;
  if (mode->strength == 0 || mode->path + flow <= knee || isinf(mode->end)) {
    mode->flow = flow;
    mode->work =
        (begin + level) / 2 * flow - late; /* begin = level unless the other mode lowered it */
    mode->path += mode->strength > 0 ? flow : 0;
    return;
  }
  double slope = mode->strength / mode->end, before = fmax(0, knee - mode->path);
  double reached = mode->end;
  mode->flow = e;
  if (mode->k > slope) {
    flow = (mode->k * e - mode->strength + slope * mode->path) / (mode->k - slope);
    if (mode->path + flow < mode->end) {
      reached = mode->path + flow;
      mode->flow = flow;
    }
  }
  double from = mode->path + before, low = mode->strength * (1 - reached / mode->end);
  mode->work = (begin + level) / 2 * before - late +
               (reached - from) * (mode->strength * (1 - from / mode->end) + low) / 2;
  mode->path = reached;
  mode->damage = reached < mode->end ? reached / mode->end : 1;
}

/* What the passes of one update share. */
typedef struct {
  const cdem_interface_law *law;
  cdem_interface_point *point;
  double delta[3];
  double sigma, tau[2]; /* opening positive */
  double stored[2];
  double seen[2];  /* damage at which each mode's strength was last kept */
  double pressure; /* under which shear last kept its strength */
  bool failed[2];
  double flowed[2];
  cdem_interface_work *work;
} step;

static void mark(cdem_interface_point *point, int mode) {
  if (point->damage >= 1) {
    if (point->state != CDEM_INTERFACE_TENSION_FAILED &&
        point->state != CDEM_INTERFACE_SHEAR_FAILED)
      point->state = mode == 0 ? CDEM_INTERFACE_TENSION_FAILED : CDEM_INTERFACE_SHEAR_FAILED;
  } else if (point->damage > 0) {
    point->state = CDEM_INTERFACE_SOFTENING;
  }
}

/* Without tensile strength faces part freely and meet again where sliding has lifted them to. */
static void part(step *s) {
  cdem_interface_point *point = s->point;
  point->plastic[0] = fmin(s->delta[0], point->dilated);
  point->secant[0] = 0;
  s->sigma = 0;
  s->stored[0] = 0;
  mark(point, 0);
}

/* Normal traction; returns whether it flowed. */
static bool open_normal(step *s) {
  const cdem_interface_law *law = s->law;
  cdem_interface_point *point = s->point;
  double x = s->delta[0] - point->plastic[0], r = x > 0 ? point->secant[0] : 0;
  s->sigma = law->kn * (1 - r) * x;
  s->stored[0] = s->sigma * x / 2;
  double level = law->tension * (1 - point->damage);
  if (s->sigma <= level + slack(level, law->kn, fabs(s->delta[0])))
    return false;
  if (level == 0 && (law->tension == 0 || s->seen[0] == point->damage)) {
    part(s);
    return false; /* nothing else depends on it: it carries nothing */
  }
  double top = law->tension * (1 - s->seen[0]);
  double meets = fmin(x, top / (law->kn * (1 - r))), a = r * meets;
  softening mode = {.k = law->kn,
                    .strength = law->tension,
                    .end = path_end(law, law->tension, law->energy_1, law->kn),
                    .path = point->opened,
                    .damage = point->damage,
                    .start = top,
                    .flowed = s->flowed[0]};
  soften(&mode, x - a);
  s->flowed[0] += mode.flow;
  point->opened = mode.path;
  point->damage = mode.damage;
  s->seen[0] = mode.damage;
  s->failed[0] = true;
  s->work->fracture += mode.work;
  s->sigma = law->tension * (1 - mode.damage);
  if (law->unloading == CDEM_UNLOADING_ORIGIN) {
    double grown = x - s->sigma / law->kn; /* a after the flow: all of it closes again */
    s->work->fracture += (law->kn * (1 - r) * meets * a - s->sigma * grown) / 2;
    point->secant[0] = grown / x;
    s->stored[0] = s->sigma * x / 2;
  } else {
    point->plastic[0] = s->delta[0] - s->sigma / law->kn;
    s->stored[0] = s->sigma * s->sigma / (2 * law->kn);
  }
  mark(point, 0);
  if (mode.damage >= 1)
    part(s);
  return true;
}

/* Unloading to the origin keeps the cohesive share of the slip as one that goes back, (6); what
 * friction slid stays. A pressure that grows would store energy in the part that goes back; it is
 * then cut, so that no fracture energy is regained. Returns the lasting part of x. */
static double slip_to_origin(step *s, double x, double a, double from, double tau,
                             double cohesive) {
  cdem_interface_point *point = s->point;
  double e = tau / s->law->ks, flow = x - a - e, grown = 0;
  double rubbed = fmax(0, -s->sigma) * s->law->friction * flow;
  double share = cohesive > 0 ? cohesive / (cohesive + rubbed) : 0;
  if (point->damage < 1 && tau > 0)
    grown = fmin(a + share * flow, (from * a + 2 * cohesive) / tau);
  s->work->fracture += (from * a - tau * grown) / 2;
  point->secant[1] = grown > 0 ? grown / (grown + e) : 0;
  s->stored[1] = tau * (e + grown) / 2;
  return x - e - grown;
}

/* Energy of a slip: cohesion over the path, less what tension takes from it; friction net of the
 * lifting that dilation does against the pressure. Pressures by the mean of both ends of the step.
 * Returns the cohesive part. */
static double book_slip(step *s, const softening *mode, double pressure, double lift) {
  const cdem_interface_law *law = s->law;
  double end = pressure + law->kn * lift * mode->flow;
  double pressed = (fmax(0, s->pressure) + fmax(0, end)) / 2;
  double pulled = (fmin(0, s->pressure) + fmin(0, end)) / 2;
  double cohesive = mode->work + pulled * law->friction * mode->flow;
  s->work->fracture += cohesive;
  s->work->friction += pressed * (law->friction - lift) * mode->flow;
  s->pressure = end;
  return cohesive;
}

/* Shear traction; returns whether it flowed. */
static bool slide(step *s) {
  const cdem_interface_law *law = s->law;
  cdem_interface_point *point = s->point;
  double x[2] = {s->delta[1] - point->plastic[1], s->delta[2] - point->plastic[2]};
  double size = sqrt(x[0] * x[0] + x[1] * x[1]), r = point->secant[1];
  double tau = law->ks * (1 - r) * size, pressure = -s->sigma;
  double limit = fmax(0, pressure * law->friction + law->cohesion * (1 - point->damage));
  for (int i = 0; i < 2; i++)
    s->tau[i] = law->ks * (1 - r) * x[i];
  s->stored[1] = tau * size / 2;
  if (tau <= limit + slack(limit, law->ks, fabs(s->delta[1]) + fabs(s->delta[2])))
    return false;
  double top = fmax(0, pressure * law->friction + law->cohesion * (1 - s->seen[1]));
  double meets = fmin(size, top / (law->ks * (1 - r))), a = r * meets;
  double lift = pressure > 0 ? law->dilation : 0, k = law->ks + law->kn * lift * law->friction;
  softening mode = {.k = k,
                    .strength = law->cohesion,
                    .end = path_end(law, law->cohesion, law->energy_2, law->ks),
                    .path = point->slipped,
                    .damage = point->damage,
                    .start = law->cohesion * (1 - s->seen[1]),
                    .flowed = s->flowed[1]};
  double e = size - a, path = point->slipped;
  soften(&mode, (law->ks * e - pressure * law->friction) / k);
  if (mode.flow > e) { /* tension leaves no shear strength: all shear goes */
    mode.flow = e;
    mode.path = law->cohesion > 0 ? fmin(path + e, mode.end) : path;
    mode.damage = fmax(point->damage, mode.path / mode.end);
    mode.work = top / 2 * e - (fmin(0, s->pressure) + fmin(0, pressure)) / 2 * law->friction * e;
  }
  s->flowed[1] += mode.flow;
  point->slipped = mode.path;
  point->damage = mode.damage;
  s->seen[1] = mode.damage;
  s->failed[1] = true;
  double cohesive = book_slip(s, &mode, pressure, lift);
  s->sigma -= law->kn * lift * mode.flow;
  point->plastic[0] += lift * mode.flow;
  point->dilated += lift * mode.flow;
  s->stored[0] = lift > 0 ? s->sigma * s->sigma / (2 * law->kn) : s->stored[0];
  tau = fmax(0, -s->sigma * law->friction + law->cohesion * (1 - mode.damage));
  double lasting = size - tau / law->ks;
  s->stored[1] = tau * tau / (2 * law->ks);
  if (law->unloading == CDEM_UNLOADING_ORIGIN)
    lasting = slip_to_origin(s, size, a, law->ks * (1 - r) * meets, tau, cohesive);
  for (int i = 0; i < 2; i++) {
    s->tau[i] = tau * x[i] / size;
    point->plastic[i + 1] += lasting * x[i] / size;
  }
  mark(point, 1);
  return true;
}

static double stored_energy(const cdem_interface_law *law, const cdem_interface_point *point,
                            const double delta[3], double sigma[3]) {
  double energy = 0;
  for (int i = 0; i < 3; i++) {
    double x = delta[i] - point->plastic[i], k = i == 0 ? law->kn : law->ks;
    double r = i > 0 || x > 0 ? point->secant[i > 0] : 0;
    sigma[i] = k * (1 - r) * x;
    energy += sigma[i] * x / 2;
  }
  return energy;
}

/* The step after a brittle failure: what the spring held, and what was worked on it while it let
 * go, is fracture. Tractions jump here, so that only the trapezoidal work closes the book. */
static double fallen(const cdem_interface_law *law, const cdem_interface_point *before,
                     const step *s) {
  double old[3], now[3] = {s->sigma, s->tau[0], s->tau[1]};
  double energy = stored_energy(law, before, before->last, old) - s->stored[0] - s->stored[1];
  for (int i = 0; i < 3; i++)
    energy += (old[i] + now[i]) / 2 * (s->delta[i] - before->last[i]);
  return energy - s->work->friction;
}

/* Friction of a failed point: the mean of the tractions at both ends times the slip, which is what
 * the tractions really did in this step; the strength at its start need not have been reached. */
static double rubbed(const cdem_interface_law *law, const cdem_interface_point *before,
                     const step *s) {
  double old[3], stored = 0, work = 0;
  stored_energy(law, before, before->last, old);
  for (int i = 1; i < 3; i++) {
    stored += old[i] * (before->last[i] - before->plastic[i]) / 2;
    work += (old[i] + s->tau[i - 1]) / 2 * (s->delta[i] - before->last[i]);
  }
  double lifted = s->point->dilated - before->dilated;
  return work + stored - s->stored[1] - s->work->fracture +
         (fmin(0, old[0]) + fmin(0, s->sigma)) / 2 * lifted;
}

/* A brittle point keeps its strength to the end of the step in which it fails. */
static void fail_brittle(step *s) {
  cdem_interface_point *point = s->point;
  if (s->law->softening != CDEM_SOFTENING_BRITTLE || point->damage >= 1 ||
      !(s->failed[0] || s->failed[1]))
    return;
  point->damage = 1;
  point->falling = 1;
  mark(point, s->failed[0] ? 0 : 1);
}

void cdem_interface_law_update(const cdem_interface_law *law, const double delta[3],
                               cdem_interface_point *point, double traction[3],
                               cdem_interface_work *work) {
  cdem_interface_point before = *point;
  *work = (cdem_interface_work){0};
  step s = {.law = law,
            .point = point,
            .delta = {delta[0], delta[1], delta[2]},
            .seen = {point->damage, point->damage},
            .pressure = point->pressure,
            .work = work};
  point->falling = 0;
  if (point->slipped == 0 && point->damage == 0 && point->credit[0] == 0) /* virgin */
    s.pressure = law->kn * (point->plastic[0] - delta[0]);
  for (int pass = 0; pass < PASSES; pass++) {
    bool opened = open_normal(&s);
    if (!slide(&s) && !opened)
      break;
    if (before.damage >= 1) /* nothing couples back */
      break;
  }
  if (before.falling)
    work->fracture = fallen(law, &before, &s);
  else if (before.damage >= 1)
    work->friction = rubbed(law, &before, &s);
  fail_brittle(&s);
  for (int i = 0; i < 3 && point->damage >= 1; i++)
    point->last[i] = delta[i];
  point->pressure = -s.sigma;
  /* (5): the energy a spring came in with is not of its own work; it goes out with the damage. */
  double share = point->falling ? 0 : point->damage, shared = before.falling ? 0 : before.damage;
  const double *credit = point->credit;
  work->fracture -= credit[0] * (share - shared);
  work->friction -= credit[1] * (share - shared);
  work->stored = s.stored[0] + s.stored[1] - (credit[0] + credit[1]) * (1 - share) - credit[2];
  traction[0] = -s.sigma;
  traction[1] = -s.tau[0];
  traction[2] = -s.tau[1];
}

void cdem_interface_law_traction(const cdem_interface_law *law, const double delta[3],
                                 const cdem_interface_point *point, double traction[3]) {
  stored_energy(law, point, delta, traction);
  bool parts = law->tension * (1 - point->damage) == 0 && !point->falling;
  if (traction[0] > 0 && parts)
    traction[0] = 0;
  for (int i = 0; i < 3; i++)
    traction[i] = -traction[i];
}

bool cdem_interface_law_reached(const cdem_interface_law *law, const double traction[3]) {
  double sigma = -traction[0];
  double tau = sqrt(traction[1] * traction[1] + traction[2] * traction[2]);
  return (sigma > 0 && sigma >= law->tension) ||
         (tau > 0 && tau >= fmax(0, law->cohesion - sigma * law->friction));
}

void cdem_interface_law_insert(const cdem_interface_law *law, const double delta[3],
                               cdem_interface_point *point, double traction[3]) {
  traction[0] = fmax(traction[0], -law->tension);
  double tau = hypot(traction[1], traction[2]);
  double limit = fmax(0, law->cohesion + traction[0] * law->friction);
  for (int i = 1; i < 3 && tau > limit; i++)
    traction[i] *= limit / tau;
  tau = fmin(tau, limit);
  *point = (cdem_interface_point){.pressure = traction[0]};
  for (int i = 0; i < 3; i++)
    point->plastic[i] = delta[i] + traction[i] / (i == 0 ? law->kn : law->ks);
  double rubs = fmin(tau, fmax(0, traction[0]) * law->friction), holds = tau - rubs;
  double normal = traction[0] * traction[0] / (2 * law->kn);
  point->credit[0] = (traction[0] < 0 ? normal : 0) + holds * holds / (2 * law->ks);
  point->credit[1] = holds * rubs / law->ks;
  point->credit[2] = (traction[0] < 0 ? 0 : normal) + rubs * rubs / (2 * law->ks);
}
