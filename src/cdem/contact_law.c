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
 * Energy of a step, by trapezoids: the work of the bodies on the contact is what is stored more,
 * plus friction (F_t0 + F_t1)/2 . (slipped), plus damping (F_d0 + F_d1)/2 dg. When the weight w
 * changes (facets turn, edges are passed), (w_0 - w_1)/2 (kn g_0 g_1 + kt s_0 . s_1) is what
 * remains; it is booked with the damping and can have either sign.
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

void cdem_touch_update(const cdem_contact *contact, const cdem_contact_input *in, int32_t facet,
                       cdem_touch *t) {
  const cdem_contact_law *law = in->law;
  double dt = contact->store->dt, w = in->weight, axes[9], before[3] = {0.0}, now[3], slipped[3];
  double tangent[3], work = 0.0, product = 0.0;
  bool fresh = t->facet < 0;
  if (!fresh) {
    cdem_contact_axes(contact, t->facet, axes);
    to_world(axes, t->stick, before);
    into_plane(in->normal, before);
  }
  bool continued = !fresh && !t->handed;
  double normal = fmax(0.0, w * (law->kn * in->gap + dashpot(in) * in->rate));
  for (int i = 0; i < 3; i++)
    now[i] = before[i] + (continued ? in->slip[i] : 0.0);
  double length = cdem_norm3(now), most = law->friction * normal, trial = w * law->kt * length;
  double keep = trial > most ? most / trial : 1.0;
  t->sliding = trial > most;
  for (int i = 0; i < 3; i++) {
    slipped[i] = (1.0 - keep) * now[i];
    now[i] *= keep;
    tangent[i] = -w * law->kt * now[i];
    work += 0.5 * law->kt * (t->weight * before[i] + w * now[i]) * slipped[i];
    product += before[i] * now[i];
  }
  double drag = normal - w * law->kn * in->gap;
  t->friction = continued ? work : 0.0;
  t->damping = fresh || t->handed ? 0.0 : 0.5 * (t->dashpot + drag) * in->rate * dt;
  if (continued)
    t->damping += 0.5 * (t->weight - w) * (law->kn * t->gap * in->gap + law->kt * product);
  if (fresh)
    t->damping = 0.5 * drag * in->rate * dt;
  t->dashpot = drag;
  t->facet = facet;
  t->handed = 0;
  t->weight = w;
  t->gap = in->gap;
  t->kn = law->kn;
  t->kt = law->kt;
  t->stored = 0.5 * w * (law->kn * in->gap * in->gap + law->kt * cdem_dot3(now, now));
  cdem_contact_axes(contact, facet, axes);
  to_local(axes, now, t->stick);
  nodal_forces(in, normal, tangent, t);
}

/* A contact that is no more, with `gap` to its last plane: what it still stored is lost. Parted
 * normally there is nothing left in the normal spring but the error of the step. */
void cdem_touch_end(const cdem_contact *contact, double gap, cdem_touch *t) {
  double friction = 0.5 * t->weight * t->kt * cdem_dot3(t->stick, t->stick);
  double damping = gap > 0.0 ? 0.5 * t->weight * t->kn * t->gap * gap : 0.0;
  (void)contact;
  memset(t, 0, sizeof *t);
  t->facet = -1;
  t->friction = friction;
  t->damping = damping;
}
