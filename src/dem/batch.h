/* Batches: contacts side by side, one array a quantity, between those who find contacts and the
 * laws.
 *
 * The finder fills geometry and kinematics of up to CDEM_BATCH contacts that share a pair of
 * materials and their histories; the law computes force and moment in one plain loop over `count`,
 * which the compiler vectorises; the finder adds them to the grains. Lanes count .. the next
 * multiple of eight hold harmless numbers (overlap 0, n = (1, 0, 0), arms and masses 1), so that
 * loops may run over them; what they hold afterwards means nothing. 2-D: n and velocity have two
 * components; spins, shear and moment have one (index 0: about z, along t = (-n_y, n_x), about z).
 */
#ifndef CDEM_DEM_BATCH_H
#define CDEM_DEM_BATCH_H

#include "dem/law.h"

enum { CDEM_BATCH = 64, CDEM_BATCH_HISTORY = 18 };
/* A cache line more than needed: lanes 4 KiB apart would wait for each other in the processor. */
typedef double cdem_lanes[CDEM_BATCH + 8];

struct cdem_batch {
  int count;
  double step;                  /* s; 0: the forces of the histories as they are */
  _Alignas(64) cdem_lanes n[3]; /* from A to B */
  cdem_lanes overlap;           /* m */
  cdem_lanes arm[2];            /* a_A, a_B (a wall: 0), m */
  cdem_lanes radius, mass;      /* reduced: ab/(a + b); against a wall those of A */
  cdem_lanes velocity[3];       /* vB - vA of the centres (a wall: of its point there), m/s */
  cdem_lanes turning[3];        /* a_A wA + a_B wB, m/s */
  cdem_lanes spin[3];           /* wB - wA, 1/s */
  cdem_lanes label;             /* 1: A has the lower id; -1 else */
  cdem_lanes fresh;             /* 1: this step is the contact's first; 0 else */
  /* With energies only: by how much velocity, turning and spin have grown since the step before
   * (zeros are allowed, as at the start). Forces act at t_{n+1} but velocities are those of
   * t_{n+1/2}; with half of this added, dashpots are booked to second order in the step, without
   * it only to first. */
  cdem_lanes velocity_gain[3], turning_gain[3], spin_gain[3];
  cdem_lanes history[CDEM_BATCH_HISTORY]; /* in and out; all 0 in a fresh contact */
  /* out */
  cdem_lanes normal;    /* F_N, N */
  cdem_lanes shear[3];  /* F_t on A, N */
  cdem_lanes moment[3]; /* M on A, N m; the law sets, resistances add */
  /* out, with energies only: stored in this contact now, J ... */
  cdem_lanes stored_normal, stored_shear, stored_moment;
  /* ... taken out of the motion in this step, J: dissipated by dashpots, by sliding, by rolling and
   * twisting; and by forces that neither store nor dissipate (negative: they drive the motion).
   * `slid` and `rolled` of springs belong to the step up to t; `damped`, `circulated` and the
   * moments of resistance `constant` are power at t times the step, half of which lies ahead: a
   * book that shall close to second order at t takes half of their last step off again. */
  cdem_lanes damped, slid, rolled, circulated;
};

#endif
