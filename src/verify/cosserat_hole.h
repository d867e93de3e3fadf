/* Private to verify: a circular hole in a plane Cosserat medium under tension along x, in closed
 * form (docs/theory/cosserat.md, section 6; Kaloni & Ariman 1967, Eringen 1968).
 *
 * Stresses come from two functions, phi(r) cos(2 t) and psi(r) sin(2 t), besides the part of phi
 * that does not turn with t. Polar axes, t from the direction of the tension; the first index of a
 * stress is the face, the second its direction, as in elements/material.h.
 */
#ifndef CDEM_VERIFY_COSSERAT_HOLE_H
#define CDEM_VERIFY_COSSERAT_HOLE_H

#include "base/base.h"

typedef struct {
  double radius, tension;             /* m, Pa */
  double couple_length, shear_length; /* b and c of eq. (19), m */
  double a[5];                        /* coefficients of eq. (21) */
} cdem_cosserat_hole;

/* coupling: N of eq. (19), 0 < N < 1; length: l with couple modulus 4 G l^2. Plane strain. */
void cdem_cosserat_hole_init(double radius, double tension, double poisson, double coupling,
                             double length, cdem_cosserat_hole *hole);
/* Stress concentration factor at the crown, eq. (23). */
double cdem_cosserat_hole_factor(double radius, double poisson, double coupling, double length);

typedef struct {
  double rr, rt, tr, tt; /* Pa */
  double mr, mt;         /* couple stresses on faces r and t, N/m */
  double psi;            /* couple modulus times rotation, N */
} cdem_polar_stress;
void cdem_cosserat_hole_stress(const cdem_cosserat_hole *hole, double r, double t,
                               cdem_polar_stress *stress);

#endif
