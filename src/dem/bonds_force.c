/* Forces of bonds (bonds.h).
 *
 * n from A to B, L the distance of centres, arms a = r L/(rA + rB): they meet, so that the pair
 * conserves angular momentum and a rigid rotation slides nothing. On A:
 *     -F_N n + F_t,  F_N = kn (L0 - L) + cn approach,  F_t = ks s + cs s',  M = kr theta_r + kt
 * theta_n with s' = vB - vA - (a_A wA + a_B wB) x n in the tangent plane and theta' = wB - wA; s
 * and theta turn with the bond: their tangential parts are turned by the way n has turned. */
#include "dem/solver_store.h"

#include <math.h>
#include <string.h>

typedef struct {
  double velocity[3], turning[3], spin[3]; /* as in batch.h, 3-D vectors */
} motion;

static void motion_of(const cdem_dem_store *s, const cdem_bond_state *bond, const double *of,
                      const double arm[2], bool images, motion *m) {
  const double *a = of + 8 * (int64_t)bond->owner, *b = of + 8 * (int64_t)bond->other;
  for (int c = 0; c < 3; c++) {
    m->velocity[c] = b[c] - a[c] + (images ? s->image_velocity[bond->image][c] : 0.0);
    m->turning[c] = arm[0] * a[3 + c] + arm[1] * b[3 + c];
    m->spin[c] = b[3 + c] - a[3 + c];
  }
}

/* Rate of sliding in the tangent plane; returns the rate of moving apart. */
static double slide(const motion *m, const double n[3], double rate[3]) {
  double cross[3], apart = cdem_dot3(m->velocity, n);
  cdem_cross3(m->turning, n, cross);
  for (int c = 0; c < 3; c++)
    rate[c] = m->velocity[c] - apart * n[c] - cross[c];
  return apart;
}

/* Into the tangent plane of n, at its old length: how a vector turns with the bond. */
static void turn_with(const double n[3], double v[3]) {
  double before = cdem_norm3(v), along = cdem_dot3(v, n);
  for (int c = 0; c < 3; c++)
    v[c] -= along * n[c];
  double now = cdem_norm3(v);
  for (int c = 0; now > 0.0 && c < 3; c++)
    v[c] *= before / now;
}

/* History as 3-D vectors: sliding way, rolled way; twisted angle. */
static void history_in(int dim, const cdem_bond_state *bond, const double n[3], double s[3],
                       double rolled[3], double *twisted) {
  if (dim == 2) {
    s[0] = -n[1] * bond->stretch[0];
    s[1] = n[0] * bond->stretch[0];
    s[2] = rolled[0] = rolled[1] = *twisted = 0.0;
    rolled[2] = bond->stretch[3];
    return;
  }
  memcpy(s, bond->stretch, 3 * sizeof *s);
  memcpy(rolled, bond->stretch + 3, 3 * sizeof *rolled);
  *twisted = bond->stretch[6];
  turn_with(n, s);
  turn_with(n, rolled);
}

static void history_out(int dim, cdem_bond_state *bond, const double n[3], const double s[3],
                        const double rolled[3], double twisted) {
  if (dim == 2) {
    bond->stretch[0] = n[0] * s[1] - n[1] * s[0];
    bond->stretch[3] = rolled[2];
    return;
  }
  memcpy(bond->stretch, s, 3 * sizeof *s);
  memcpy(bond->stretch + 3, rolled, 3 * sizeof *rolled);
  bond->stretch[6] = twisted;
}

static bool too_much(const cdem_bond_law *law, double push, const double shear[3],
                     const double moment[3]) {
  double bound = law->cohesion + law->friction * fmax(push, 0.0);
  return (law->tension > 0.0 && -push > law->tension) ||
         (law->cohesion > 0.0 && cdem_norm3(shear) > bound) ||
         (law->moment > 0.0 && cdem_norm3(moment) > law->moment);
}

void cdem_bond_evaluate(const cdem_dem *dem, cdem_bond_state *bond, double step,
                        cdem_bond_forces *out, double *damped) {
  const cdem_dem_store *store = dem->store;
  const cdem_bond_law *law = &store->options.bond_law[bond->law];
  const double *xa = cdem_place(store, bond->owner), *xb = cdem_place(store, bond->other);
  const double *ma = cdem_motion(store, bond->owner), *mb = cdem_motion(store, bond->other);
  bool images = store->pair_image != NULL;
  double s[3], rolled[3], twisted, rate[3], *n = out->n, d[3];
  for (int c = 0; c < 3; c++)
    d[c] = xb[c] - xa[c] + (images ? store->image[bond->image][c] : 0.0);
  out->length = cdem_norm3(d);
  for (int c = 0; c < 3; c++)
    n[c] = d[c] / out->length;
  out->arm[0] = xa[3] * (out->length / (xa[3] + xb[3]));
  out->arm[1] = xb[3] * (out->length / (xa[3] + xb[3]));
  motion m;
  motion_of(store, bond, store->motion, out->arm, images, &m);
  double apart = slide(&m, n, rate), mass = ma[6] * mb[6] / (ma[6] + mb[6]);
  double twist = cdem_dot3(m.spin, n);
  history_in(store->dim, bond, n, s, rolled, &twisted);
  for (int c = 0; c < 3; c++) {
    s[c] += step * rate[c];
    rolled[c] += step * (m.spin[c] - twist * n[c]);
  }
  twisted += step * twist;
  history_out(store->dim, bond, n, s, rolled, twisted);
  double stretch = bond->rest - out->length;
  double cn = 2.0 * law->damping_ratio * sqrt(law->normal_stiffness * mass);
  double cs = 2.0 * law->damping_ratio * sqrt(law->shear_stiffness * mass);
  double spring[3];
  out->push = law->normal_stiffness * stretch - cn * apart;
  for (int c = 0; c < 3; c++) {
    double shear = law->shear_stiffness * s[c] + cs * rate[c];
    spring[c] = law->shear_stiffness * s[c];
    out->force[c] = shear - out->push * n[c];
    out->shear[c] = shear;
    out->moment[c] = law->rolling_stiffness * rolled[c] + law->twisting_stiffness * twisted * n[c];
  }
  out->stored =
      0.5 * (law->normal_stiffness * (stretch * stretch) + law->shear_stiffness * cdem_dot3(s, s) +
             law->rolling_stiffness * cdem_dot3(rolled, rolled) +
             law->twisting_stiffness * (twisted * twisted));
  out->power = -law->normal_stiffness * stretch * apart +
               law->shear_stiffness * cdem_dot3(s, rate) +
               law->rolling_stiffness * (cdem_dot3(rolled, m.spin) - twist * cdem_dot3(rolled, n)) +
               law->twisting_stiffness * twisted * twist;
  out->breaks = too_much(law, law->normal_stiffness * stretch, spring, out->moment);
  if (damped == NULL)
    return;
  double gain[3], more = 0.0; /* dashpots to second order, as batch.h says */
  if (store->core->gain != NULL) {
    motion g;
    motion_of(store, bond, store->core->gain, out->arm, false, &g);
    more = slide(&g, n, gain);
  } else
    gain[0] = gain[1] = gain[2] = 0.0;
  *damped = step * cn * apart * (apart + 0.5 * more);
  for (int c = 0; c < 3; c++)
    *damped += step * cs * rate[c] * (rate[c] + 0.5 * gain[c]);
}

/* Its energy is lost, but for what the contact that takes over holds from the start. As its last
 * force does not act, half of the last step's work has not gone into it (trapezoid). */
static void break_bond(cdem_dem *dem, cdem_bond_state *bond, const cdem_bond_forces *f, double step,
                       cdem_dem_part *part) {
  cdem_dem_store *s = dem->store;
  const double *xa = cdem_place(s, bond->owner), *xb = cdem_place(s, bond->other);
  double overlap = xa[3] + xb[3] - f->length, taken = 0.0;
  if (s->options.energies && overlap > 0.0)
    taken = cdem_dem_stored_at(dem, bond->owner, bond->other, f->n, overlap);
  part->sum[CDEM_DEM_BROKEN] += f->stored - 0.5 * step * f->power - taken;
  bond->holds = 0;
  part->broke++;
  if (bond->pair >= 0 &&
      !(s->kind[bond->owner] == CDEM_GRAIN_DRIVEN && s->kind[bond->other] == CDEM_GRAIN_DRIVEN))
    s->pair_touch[bond->pair] = 0;
}

/* Adds to the forces of A and B. */
static void add_forces(const cdem_bond_forces *f, double *a, double *b) {
  double turn[3];
  cdem_cross3(f->n, f->shear, turn);
  for (int c = 0; c < 3; c++) {
    a[c] += f->force[c];
    b[c] -= f->force[c];
    a[3 + c] += f->arm[0] * turn[c] + f->moment[c];
    b[3 + c] += f->arm[1] * turn[c] - f->moment[c];
  }
}

void cdem_bonds_forces(cdem_dem *dem, int32_t chunk, double step) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  cdem_dem_part *part = &core->part[chunk];
  bool book = s->options.energies && step > 0.0;
  int64_t from = core->bond_start[cdem_chunk_from(dem, chunk)];
  int64_t to = core->bond_start[cdem_chunk_to(dem, chunk)];
  for (int64_t k = from; k < to; k++) {
    cdem_bond_state *bond = &core->bond[k];
    cdem_bond_forces f;
    double damped = 0.0;
    bool driven = core->driven && s->kind[bond->owner] == CDEM_GRAIN_DRIVEN &&
                  s->kind[bond->other] == CDEM_GRAIN_DRIVEN;
    if (!bond->holds || driven)
      continue;
    cdem_bond_evaluate(dem, bond, step, &f, book ? &damped : NULL);
    if (f.breaks && step > 0.0) {
      break_bond(dem, bond, &f, step, part);
      continue;
    }
    part->sum[CDEM_DEM_DAMPED] += damped;
    add_forces(&f, cdem_force(s, bond->owner),
               bond->target >= 0 ? cdem_force(s, bond->target)
                                 : core->far + 8 * (-1 - bond->target));
    if (s->pair_image != NULL)
      for (int r = 0; r < 3; r++) {
        part->image[bond->image][r] += f.force[r];
        for (int c = 0; c < 3; c++)
          part->virial[3 * r + c] += f.force[r] * f.n[c] * f.length;
      }
  }
}

double cdem_bonds_stored(const cdem_dem *dem) {
  const cdem_dem_core *core = dem->store->core;
  double sum = 0.0;
  for (int64_t k = 0; k < core->bonds; k++) {
    cdem_bond_state bond = core->bond[k];
    cdem_bond_forces f;
    if (!bond.holds || (dem->store->kind[bond.owner] == CDEM_GRAIN_DRIVEN &&
                        dem->store->kind[bond.other] == CDEM_GRAIN_DRIVEN))
      continue;
    cdem_bond_evaluate(dem, &bond, 0.0, &f, NULL);
    sum += f.stored;
  }
  return sum;
}
