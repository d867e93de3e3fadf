/* The forces of one touch, eq (1) of fdem.h, and its entries in the book.
 *
 * The book. A solver that steps with the forces of t_n and books works by the trapezoid gives a
 * contact, over the step to t_n, the work -(f_{n-1} + f_n).u/2, u the way of the node against its
 * partner. Springs hold k d^2/2 and k_s u_s^2/2. So with the trapezoid, too,
 * - the normal dashpot takes the mean of its force at both ends times the change of depth: with the
 *   spring, whose trapezoid is exact, all that the push took;
 * - the tangential force takes the mean of itself at both ends times the slip, less what its spring
 *   has gained: friction if it slides at t_n, damping if not. A spring that sticks without dashpot
 *   takes nothing to rounding.
 * What remains is of second order in the step: normals that turn within a step, the parts of a step
 * before a touch begins and after it ends. A clipped push (the dashpot would pull) counts as
 * dashpot. A tangential spring that is forgotten goes to friction.
 *
 * The tangential spring and its force stay in the frame of the partner between steps, so that a
 * pair that turns as one body keeps them; then they are laid into the plane across the new normal
 * with the length they had. */
#include "fdem/contact_store.h"

static double energy(double stiffness, const double spring[3]) {
  return 0.5 * stiffness * cdem_dot3(spring, spring);
}

/* From the frame of the partner into the plane across n. */
static void lay(const double turn[9], const double n[3], const double kept[3], double out[3]) {
  double before, after;
  cdem_wall_turned(turn, kept, out);
  before = cdem_norm3(out);
  double along = cdem_dot3(out, n);
  for (int c = 0; c < 3; c++)
    out[c] -= along * n[c];
  after = cdem_norm3(out);
  for (int c = 0; c < 3; c++)
    out[c] = after > 0.0 ? out[c] * (before / after) : 0.0;
}

static void push(cdem_node_touch *t, const cdem_node_touch *old, const cdem_touch_motion *m,
                 cdem_contact_book *book) {
  double out = cdem_dot3(m->move, t->normal);
  t->push = fmax(0.0, t->stiffness * t->depth - t->dashpot * out);
  t->dash = t->push - t->stiffness * t->depth;
  book->normal += 0.5 * t->stiffness * t->depth * t->depth;
  if (m->step > 0.0)
    book->damping += 0.5 * ((old != NULL ? old->dash : 0.0) + t->dash) *
                     (old != NULL ? t->depth - old->depth : -out);
}

/* shear: tangential force on the partner. */
static void drag(cdem_node_touch *t, const cdem_node_touch *old, const cdem_touch_motion *m,
                 double shear[3], cdem_contact_book *book) {
  const double *n = t->normal;
  double spring[3] = {0.0, 0.0, 0.0}, last[3] = {0.0, 0.0, 0.0}, slip[3];
  double out = cdem_dot3(m->move, n), kept = 0.0, work = 0.0, limit = m->law->friction * t->push;
  double dashpot = t->dashpot * sqrt(t->shear_stiffness / t->stiffness);
  if (old != NULL) {
    lay(m->turn, n, old->spring, spring);
    lay(m->turn, n, old->shear, last);
    kept = energy(t->shear_stiffness, old->spring);
  }
  for (int c = 0; c < 3; c++) {
    slip[c] = m->move[c] - out * n[c];
    spring[c] += old != NULL ? slip[c] : 0.0;
    shear[c] = t->shear_stiffness * spring[c] + dashpot * slip[c];
  }
  double size = cdem_norm3(shear);
  bool slides = size > limit;
  for (int c = 0; c < 3; c++) {
    spring[c] = slides ? spring[c] * (limit / size) : spring[c];
    shear[c] = slides ? shear[c] * (limit / size) : shear[c];
    work += 0.5 * (last[c] + shear[c]) * slip[c];
  }
  double stored = energy(t->shear_stiffness, spring);
  book->shear += stored;
  if (m->step > 0.0)
    *(slides ? &book->friction : &book->damping) += work - (stored - kept);
  cdem_wall_turned_back(m->turn, spring, t->spring);
  cdem_wall_turned_back(m->turn, shear, t->shear);
}

void cdem_touch_evaluate(cdem_node_touch *t, const cdem_node_touch *old, const cdem_touch_motion *m,
                         cdem_contact_book *book) {
  const cdem_fdem_contact_law *law = m->law;
  const cdem_node_touch *same = old != NULL && old->partner == t->partner ? old : NULL;
  double shear[3] = {0.0, 0.0, 0.0};
  t->stiffness = law->penalty * m->area;
  t->shear_stiffness = t->stiffness * (law->shear_ratio == 0.0 ? 1.0 : law->shear_ratio);
  t->dashpot =
      m->step > 0.0 ? 2.0 * law->damping_ratio * sqrt(m->mass * t->stiffness) / m->step : 0.0;
  push(t, old, m, book);
  for (int c = 0; c < 3; c++)
    t->spring[c] = t->shear[c] = 0.0;
  if (law->friction > 0.0)
    drag(t, same, m, shear, book);
  if (old != NULL && same == NULL && m->step > 0.0)
    book->friction += energy(old->shear_stiffness, old->spring);
  for (int c = 0; c < 3; c++)
    t->force[c] = t->push * t->normal[c] - shear[c];
}

/* The spring that pushed has given back what it held, unless the wall was taken away: that is work
 * of the wall. */
void cdem_touch_settle(const cdem_node_touch *old, const double way[3], bool gone, double step,
                       cdem_contact_book *book) {
  double kept = energy(old->shear_stiffness, old->spring);
  if (!(step > 0.0))
    return;
  if (way != NULL)
    book->walls += 0.5 * cdem_dot3(old->force, way);
  if (gone) {
    book->walls -= kept + 0.5 * old->stiffness * old->depth * old->depth;
    return;
  }
  book->friction += kept;
  book->damping -= 0.5 * old->dash * old->depth;
}
