/* The law of one contact, of a point on a face or of two edges.
 *
 * The forces are the gradient of an energy of the overlap g and the sliding s, both measured by the
 * geometry (s by how far the foot has moved over the master), so that neither feels a common
 * rotation. With b_k the coefficient of node k (slave 1, master -N_k) and G_k the gradient of its
 * shape function in the plane,
 *
 *     dg = -n . sum b_k dx_k          ds = P sum b_k dx_k - g sum (n . dx_k) G_k
 *     f_k = b_k (F_n n + F_t) - g (F_t . G_k) n                                           (1)
 *
 * The last term gives back the moment of the two tangential forces, which act a distance g apart:
 * sum f = 0 and sum x x f = 0 hold exactly, stuck or sliding.
 *
 * Energy. What the nodes have put into a contact is measured, not derived: by the trapezoid of the
 * nodal forces over the nodes' motion of the step, exactly as the kinetic energy of the leapfrog
 * has it. `stored` is that sum less friction and dashpots. No normal force may be larger than this
 * energy can drive, F^2 <= 2 K E with K = w kn and E the stored energy less that of the shear
 * spring; with E = E_0 + F d/2 at the end of a step that closed the gap by d this is
 *
 *     F <= (K d + sqrt(K^2 d^2 + 8 K E_0))/2                                              (2)
 *
 * which for E_0 = F_0^2/(2 K) + F_0 d/2 is F_0 + K d: a spring of the full stiffness that begins
 * where the contact began. Under steady conditions (2) lies on or above K g and does nothing. Where
 * weight, normal or facet change, and where a contact is found already deep, it keeps energy from
 * being made; what is left when a contact ends is booked as dissipated.
 */
#include "cdem/contact_store.h"

#include <math.h>
#include <string.h>

/* s turned from the old plane into the new: the same length, the direction projected. */
static void into_plane(const double n[3], double s[3]) {
  double before = cdem_norm3(s), off = cdem_dot3(s, n);
  for (int i = 0; i < 3; i++)
    s[i] -= off * n[i];
  double after = cdem_norm3(s);
  for (int i = 0; i < 3; i++)
    s[i] = after > 0.0 ? s[i] * (before / after) : 0.0;
}

static void to_world(const double axes[9], const double local[3], double world[3]) {
  for (int i = 0; i < 3; i++)
    world[i] = axes[i] * local[0] + axes[3 + i] * local[1] + axes[6 + i] * local[2];
}

static void to_local(const double axes[9], const double world[3], double local[3]) {
  for (int i = 0; i < 3; i++)
    local[i] = cdem_dot3(axes + 3 * i, world);
}

/* Dashpot per area, Pa s/m: `damping` times 2 sqrt(kn m''), m'' the mass per area that moves. */
static double dashpot(const cdem_contact_input *in) {
  return 2.0 * in->law->damping * sqrt(in->law->kn * in->surface_mass);
}

static void set_nodes(const cdem_contact_input *in, cdem_touch *t) {
  t->nodes = (uint8_t)in->nodes;
  for (int k = 0; k < in->nodes; k++)
    t->node[k] = in->node[k];
}

static void nodal_forces(const cdem_contact_input *in, double normal, const double tangent[3],
                         cdem_touch *t) {
  for (int i = 0; i < 3; i++) {
    t->force[i] = normal * in->normal[i] + tangent[i];
    t->normal[i] = in->normal[i];
  }
  for (int k = 0; k < t->nodes; k++) {
    double couple = -in->gap * cdem_dot3(tangent, in->gradient[k]);
    for (int i = 0; i < 3; i++)
      t->nodal[k][i] = in->coefficient[k] * t->force[i] + couple * in->normal[i];
  }
}

/* Half of the work that the nodes did on the contact in this step, with its present forces. */
static double half_work(const cdem_contact_store *s, const cdem_touch *t) {
  double sum = 0.0;
  if (s->v == NULL)
    return 0.0;
  for (int k = 0; k < t->nodes; k++) {
    const double *v = s->v + (int64_t)t->node[k] * s->dofs;
    for (int i = 0; i < s->dim; i++)
      sum += t->nodal[k][i] * v[i];
  }
  return -0.5 * s->dt * sum;
}

/* The elastic normal force that energy allows: (2), and near the end of a contact no more than what
 * can be given back while the gap opens. That takes the step to come as this one, with what the
 * force itself adds to the motion: with c = dt^2/m per weight, F (|d| + (|d| + c F))/2 <= E_0. */
static double affordable(const cdem_contact_store *s, const cdem_contact_input *in, double energy,
                         double d) {
  double k = in->weight * in->law->kn, square = k * k * d * d + 8.0 * k * energy;
  double force = fmin(k * in->gap, square > 0.0 ? 0.5 * (k * d + sqrt(square)) : 0.0);
  if (!(force > 0.0) || d >= 0.0 || !(in->surface_mass > 0.0))
    return fmax(0.0, force);
  double c = s->dt * s->dt / (in->surface_mass * in->weight);
  if (-d + c * force <= force / k)
    return force;
  return fmin(force, 2.0 * fmax(0.0, energy) / (-d + sqrt(d * d + 2.0 * c * fmax(0.0, energy))));
}

/* The elastic sliding brought to the present plane and weight. A weight that grows makes no energy.
 */
static void stick_before(const cdem_contact_input *in, const cdem_touch *t, const double axes[9],
                         double before[3]) {
  double grown = t->handed || t->weight >= in->weight ? 1.0 : t->weight / in->weight;
  to_world(axes, t->stick, before);
  into_plane(in->normal, before);
  for (int i = 0; i < 3; i++)
    before[i] *= sqrt(grown);
}

/* Energy that the normal spring has before the present force acts. */
static double normal_energy(const cdem_contact_input *in, const cdem_touch *t, double put_in,
                            const double before[3], double d) {
  double kt = in->weight * in->law->kt;
  double shear = 0.5 * kt * (cdem_dot3(before, before) + cdem_dot3(before, in->slip));
  return t->stored + put_in - shear - 0.5 * t->dashpot * d;
}

void cdem_touch_update(const cdem_contact *contact, const cdem_contact_input *in, int32_t facet,
                       cdem_touch *t) {
  const cdem_contact_store *s = contact->store;
  const cdem_contact_law *law = in->law;
  double w = in->weight, before[3] = {0.0}, now[3], tangent[3], axes[9], d = in->rate * s->dt;
  bool fresh = t->facet < 0, taken_over = t->handed, continued = !fresh && !taken_over;
  bool still = s->v == NULL || s->dt == 0.0, placed = still || taken_over;
  cdem_contact_axes(contact, fresh ? facet : t->facet, axes);
  if (!fresh)
    stick_before(in, t, axes, before);
  if (!fresh && t->facet != facet)
    cdem_contact_axes(contact, facet, axes);
  double put_in = fresh ? 0.0 : half_work(s, t);
  double energy = continued ? normal_energy(in, t, put_in, before, d) : 0.0;
  double elastic = placed ? fmax(0.0, w * law->kn * in->gap) : affordable(s, in, energy, d);
  double normal = fmax(0.0, elastic + w * dashpot(in) * in->rate), work = 0.0;
  for (int i = 0; i < 3; i++)
    now[i] = before[i] + (continued ? in->slip[i] : 0.0);
  double length = cdem_norm3(now), most = law->friction * normal, trial = w * law->kt * length;
  double keep = trial > most ? most / trial : 1.0;
  for (int i = 0; i < 3; i++) {
    double slipped = (1.0 - keep) * now[i];
    now[i] *= keep;
    tangent[i] = -w * law->kt * now[i];
    work += 0.5 * law->kt * (t->weight * before[i] + w * now[i]) * slipped;
  }
  double drag = normal - elastic, shear = 0.5 * w * law->kt * cdem_dot3(now, now);
  double lost[2] = {continued ? work : 0.0, 0.5 * ((continued ? t->dashpot : 0.0) + drag) * d};
  t->stored = fresh ? 0.0 : t->stored + put_in;
  t->sliding = trial > most;
  t->dashpot = drag;
  t->facet = facet;
  t->handed = 0;
  t->weight = w;
  t->gap = in->gap;
  t->kn = law->kn;
  t->kt = law->kt;
  set_nodes(in, t);
  nodal_forces(in, normal, tangent, t);
  /* A released pair brings what its springs held on the whole face. */
  double held = 0.5 * elastic * in->gap * (taken_over ? in->whole / w : 1.0) + shear;
  t->stored = still ? held + fmax(0.0, lost[0]) : t->stored + half_work(s, t);
  if (taken_over && !still)
    lost[0] = t->stored - held;
  /* Nothing is dissipated that was not put in. */
  t->friction = fmax(0.0, fmin(lost[0], t->stored));
  t->damping = fmax(0.0, fmin(lost[1], t->stored - t->friction));
  t->stored -= t->friction + t->damping;
  /* Without a shear spring there is nothing to give back, however little is stored. */
  bool owes = !placed && shear > 0.0 && t->stored < shear;
  double left = owes ? fmax(0.0, t->stored) / shear : 1.0;
  to_local(axes, now, t->stick);
  for (int i = 0; i < 3; i++)
    t->stick[i] *= sqrt(left);
}

/* A contact that is no more: what it still stored is lost. */
void cdem_touch_end(const cdem_contact *contact, cdem_touch *t) {
  double left = fmax(0.0, t->stored + half_work(contact->store, t));
  double shear = 0.5 * t->weight * t->kt * cdem_dot3(t->stick, t->stick);
  memset(t, 0, sizeof *t);
  t->facet = -1;
  t->friction = fmin(left, shear);
  t->damping = left - t->friction;
}
