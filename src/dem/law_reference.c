#include "dem/law_reference.h"

#include "base/mat3.h"

#include <string.h>

/* a vector of the batch in three components: discs have (x, y, 0), their spins (0, 0, z) */
static void plane(const cdem_lanes *lanes, int lane, int dim, double out[3]) {
  out[0] = lanes[0][lane];
  out[1] = lanes[1][lane];
  out[2] = dim == 3 ? lanes[2][lane] : 0.0;
}

static void axial(const cdem_lanes *lanes, int lane, int dim, double out[3]) {
  out[0] = dim == 3 ? lanes[0][lane] : 0.0;
  out[1] = dim == 3 ? lanes[1][lane] : 0.0;
  out[2] = dim == 3 ? lanes[2][lane] : lanes[0][lane];
}

static void slide(const double n[3], const double velocity[3], const double turning[3],
                  double out[3]) {
  double along = cdem_dot3(velocity, n), across[3];
  cdem_cross3(turning, n, across);
  for (int c = 0; c < 3; c++)
    out[c] = velocity[c] - along * n[c] - across[c];
}

void reference_read(const cdem_batch *b, int lane, int dim, reference_contact *c) {
  double velocity[3], turning[3], gain[3], turning_gain[3], spin_gain[3];
  memset(c, 0, sizeof *c);
  c->dim = dim;
  c->step = b->step;
  c->overlap = b->overlap[lane];
  c->radius = b->radius[lane];
  c->mass = b->mass[lane];
  c->label = b->label[lane];
  c->fresh = b->fresh[lane];
  for (int s = 0; s < 2; s++)
    c->arm[s] = b->arm[s][lane];
  plane(b->n, lane, dim, c->n);
  plane(b->velocity, lane, dim, velocity);
  plane(b->velocity_gain, lane, dim, gain);
  axial(b->turning, lane, dim, turning);
  axial(b->turning_gain, lane, dim, turning_gain);
  axial(b->spin, lane, dim, c->spin);
  axial(b->spin_gain, lane, dim, spin_gain);
  double more[3];
  slide(c->n, velocity, turning, c->slide);
  slide(c->n, gain, turning_gain, more);
  for (int k = 0; k < 3; k++) {
    c->slide_ahead[k] = c->slide[k] + 0.5 * more[k];
    c->spin_ahead[k] = c->spin[k] + 0.5 * spin_gain[k];
  }
  c->approach = -cdem_dot3(velocity, c->n);
  c->approach_ahead = c->approach - 0.5 * cdem_dot3(gain, c->n);
  /* wA = (turning - a_B (wB - wA))/(a_A + a_B); the mean of both spins is wA + (wB - wA)/2. */
  double turned = cdem_dot3(turning, c->n), relative = cdem_dot3(c->spin, c->n);
  c->twist = (turned - c->arm[1] * relative) / (c->arm[0] + c->arm[1]) + 0.5 * relative;
  for (int k = 0; k < 3; k++)
    c->tilt[k] = velocity[k] / (c->arm[0] + c->arm[1]);
  for (int k = 0; k < CDEM_BATCH_HISTORY; k++)
    c->history[k] = b->history[k][lane];
}

void reference_write(const reference_contact *c, cdem_batch *b, int lane, int dim) {
  b->normal[lane] = c->normal;
  if (dim == 2) {
    b->shear[0][lane] = -c->n[1] * c->shear[0] + c->n[0] * c->shear[1];
    b->moment[0][lane] = c->moment[2];
  }
  for (int k = 0; dim == 3 && k < 3; k++) {
    b->shear[k][lane] = c->shear[k];
    b->moment[k][lane] = c->moment[k];
  }
  for (int k = 0; k < CDEM_BATCH_HISTORY; k++)
    b->history[k][lane] = c->history[k];
  b->stored_normal[lane] = c->stored_normal;
  b->stored_shear[lane] = c->stored_shear;
  b->stored_moment[lane] = c->stored_moment;
  b->damped[lane] = c->damped;
  b->slid[lane] = c->slid;
  b->rolled[lane] = c->rolled;
  b->circulated[lane] = c->circulated;
}

double reference_deep(const reference_contact *c) {
  return c->fresh != 0.0 ? 0.0 : fmax(0.0, c->overlap - c->step * c->approach);
}

double reference_speed(const reference_contact *c) {
  return c->approach - 2.0 * (c->approach_ahead - c->approach);
}

void reference_normal(reference_contact *c, double push, double elastic, double stored,
                      double before) {
  c->normal = push;
  c->stored_normal = stored;
  c->approach_ahead -= 0.5 * c->step * (push - before) / c->mass; /* its own part: law_lanes.h */
  c->damped += (push - elastic) * c->approach_ahead * c->step;
}

/* v turned about the unit axis by the angle. */
static void rotate(const double axis[3], double angle, double v[3]) {
  double across[3];
  cdem_cross3(axis, v, across);
  for (int k = 0; k < 3; k++)
    v[k] += angle * across[k];
}

void reference_recall(const reference_contact *c, int first, const double axis[3], double out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = c->dim == 2 ? c->history[first] * axis[k] : c->history[first + k];
  if (c->dim == 2)
    return;
  double length = cdem_norm3(out), tilted = cdem_dot3(out, c->n);
  rotate(c->n, c->twist * c->step, out);
  for (int k = 0; k < 3; k++)
    out[k] += 0.5 * tilted * c->tilt[k] * c->step;
  double along = cdem_dot3(out, c->n);
  for (int k = 0; k < 3; k++)
    out[k] -= along * c->n[k];
  double now = cdem_norm3(out);
  for (int k = 0; k < 3; k++)
    out[k] = now > 0.0 ? out[k] * (length / now) : 0.0;
}

static void remember(reference_contact *c, int first, const double axis[3], const double v[3]) {
  if (c->dim == 2)
    c->history[first] = cdem_dot3(v, axis);
  for (int k = 0; c->dim == 3 && k < 3; k++)
    c->history[first + k] = v[k];
}

void reference_meet(double spring[3], const double dash[3], double cap, double total[3]) {
  for (int k = 0; k < 3; k++)
    total[k] = spring[k] + dash[k];
  double length = cdem_norm3(total);
  for (int k = 0; length > cap && k < 3; k++) {
    spring[k] *= cap / length;
    total[k] *= cap / length;
  }
}

static double ratio(double square, double stiffness) {
  return stiffness > 0.0 ? 0.5 * square / stiffness : 0.0;
}

void reference_dash(reference_contact *c, const double dash[3]) {
  double own = 0.5 * c->fresh * c->step * (c->dim == 2 ? 3.0 : 3.5) / c->mass;
  for (int k = 0; k < 3; k++)
    c->damped += dash[k] * (c->slide_ahead[k] - own * c->shear[k]) * c->step;
}

void reference_shear(reference_contact *c, const reference_shear_spring *s) {
  const double t[3] = {-c->n[1], c->n[0], 0.0};
  double old[3], whole[3], spring[3], dash[3];
  reference_recall(c, 0, t, old);
  double work_whole = 0.0, work = 0.0, old_square = cdem_dot3(old, old);
  for (int k = 0; k < 3; k++)
    spring[k] = whole[k] = s->keep * old[k] + s->way * c->slide[k] * c->step;
  for (int k = 0; k < 3; k++)
    dash[k] = s->dashpot * c->slide[k];
  reference_meet(spring, dash, s->cap, c->shear);
  for (int k = 0; k < 3; k++) {
    work_whole += 0.5 * (old[k] + whole[k]) * c->slide[k] * c->step;
    work += 0.5 * (old[k] + spring[k]) * c->slide[k] * c->step;
  }
  for (int k = 0; k < 3; k++)
    dash[k] = c->shear[k] - spring[k];
  reference_dash(c, dash);
  c->stored_shear = ratio(cdem_dot3(spring, spring), s->now);
  double lost = work - (c->stored_shear - ratio(old_square, s->before));
  if (s->leaks)
    c->circulated +=
        work_whole - (ratio(cdem_dot3(whole, whole), s->now) - ratio(old_square, s->before));
  c->slid += lost - c->circulated;
  remember(c, 0, t, spring);
}

/* A spring of moment `old` [3] growing with the relative rotation. */
static void moment(reference_contact *c, const double axis_old[3], const double rate[3],
                   const double ahead[3], double stiffness, double dashpot, double cap,
                   double spring[3]) {
  double dash[3], total[3], work = 0.0;
  for (int k = 0; k < 3; k++) {
    spring[k] = axis_old[k] + stiffness * rate[k] * c->step;
    dash[k] = dashpot * rate[k];
  }
  reference_meet(spring, dash, cap, total);
  for (int k = 0; k < 3; k++)
    work += 0.5 * (axis_old[k] + spring[k]) * rate[k] * c->step;
  double stored = ratio(cdem_dot3(spring, spring), stiffness);
  c->stored_moment += stored;
  c->rolled += work - (stored - ratio(cdem_dot3(axis_old, axis_old), stiffness));
  for (int k = 0; k < 3; k++) {
    c->moment[k] += total[k];
    c->damped += (total[k] - spring[k]) * ahead[k] * c->step;
  }
}

static void tangential(const double n[3], const double v[3], double out[3]) {
  double along = cdem_dot3(v, n);
  for (int k = 0; k < 3; k++)
    out[k] = v[k] - along * n[k];
}

void reference_rolling(reference_contact *c, int first, double stiffness, double dashpot,
                       double cap) {
  static const double z[3] = {0.0, 0.0, 1.0};
  double old[3], rate[3], ahead[3], spring[3];
  reference_recall(c, first, z, old);
  tangential(c->n, c->spin, rate);
  tangential(c->n, c->spin_ahead, ahead);
  moment(c, old, rate, ahead, stiffness, dashpot, cap, spring);
  remember(c, first, z, spring);
}

void reference_slowing(reference_contact *c, double cap, double inertia) {
  double rate[3], ahead[3];
  tangential(c->n, c->spin, rate);
  tangential(c->n, c->spin_ahead, ahead);
  double size = cdem_norm3(rate);
  if (!(size > 0.0))
    return;
  double length = c->step > 0.0 ? fmin(cap, inertia * size / c->step) : cap;
  for (int k = 0; k < 3; k++) {
    c->moment[k] += length * rate[k] / size;
    c->rolled += c->step * length * ahead[k] * rate[k] / size;
  }
}

void reference_twisting(reference_contact *c, int first, double stiffness, double dashpot,
                        double cap) {
  double old[3], rate[3], ahead[3], spring[3];
  double about = cdem_dot3(c->spin, c->n), about_ahead = cdem_dot3(c->spin_ahead, c->n);
  for (int k = 0; k < 3; k++) {
    old[k] = c->history[first] * c->n[k];
    rate[k] = about * c->n[k];
    ahead[k] = about_ahead * c->n[k];
  }
  moment(c, old, rate, ahead, stiffness, dashpot, cap, spring);
  c->history[first] = cdem_dot3(spring, c->n);
}

void reference_add(const cdem_batch *b, int lane, reference_contact *c) {
  c->normal = b->normal[lane];
  for (int k = 0; k < (c->dim == 2 ? 1 : 3); k++)
    c->moment[c->dim == 2 ? 2 : k] = b->moment[k][lane];
  c->stored_moment = b->stored_moment[lane];
  c->rolled = b->rolled[lane];
  c->damped = b->damped[lane];
}

void reference_write_moment(const reference_contact *c, cdem_batch *b, int lane) {
  for (int k = 0; k < (c->dim == 2 ? 1 : 3); k++)
    b->moment[k][lane] = c->moment[c->dim == 2 ? 2 : k];
  for (int k = 0; k < CDEM_BATCH_HISTORY; k++)
    b->history[k][lane] = c->history[k];
  b->stored_moment[lane] = c->stored_moment;
  b->rolled[lane] = c->rolled;
  b->damped[lane] = c->damped;
}
