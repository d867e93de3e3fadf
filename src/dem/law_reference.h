/* Private to the laws: one contact in plain vector algebra, what the fast loops are tested against.
 *
 * Everything in three components (discs: z = 0, spins about z), with branches where the physics
 * branches. Works are added up as the trapezoid of the forces over the way of the step.
 */
#ifndef CDEM_DEM_LAW_REFERENCE_H
#define CDEM_DEM_LAW_REFERENCE_H

#include "dem/batch.h"

typedef struct {
  int dim;
  double step, overlap, radius, mass, label, fresh;
  double n[3], arm[2];
  double approach, approach_ahead; /* d' at t_{n+1/2}, and carried on to t_{n+1} */
  double slide[3], slide_ahead[3]; /* of B's surface against A's, in the tangent plane */
  double spin[3], spin_ahead[3];   /* wB - wA */
  double twist;                    /* mean spin about n */
  double tilt[3];                  /* rate of n, but for a part along n, 1/s */
  double history[CDEM_BATCH_HISTORY];
  double normal, shear[3], moment[3];
  double stored_normal, stored_shear, stored_moment, damped, slid, rolled, circulated;
} reference_contact;

void reference_read(const cdem_batch *batch, int lane, int dim, reference_contact *contact);
void reference_write(const reference_contact *contact, cdem_batch *batch, int lane, int dim);

/* push: F_N; elastic: its spring's part; stored: the spring's energy; before: the push a step ago,
 * of reference_deep and reference_speed (approach). */
void reference_normal(reference_contact *contact, double push, double elastic, double stored,
                      double before);
double reference_deep(const reference_contact *contact);
double reference_speed(const reference_contact *contact);

/* The force of an old spring, history first ..., in today's tangent plane; discs: the one number
 * along `axis`. */
void reference_recall(const reference_contact *contact, int first, const double axis[3],
                      double out[3]);

/* Spring and dashpot meet the cap together: both are cut by the same factor. */
void reference_meet(double spring[3], const double dash[3], double cap, double total[3]);

/* Books the shear dashpots; the shear force is known. */
void reference_dash(reference_contact *contact, const double dash[3]);

/* The shear spring: what the last step and this one know of its stiffness. */
typedef struct {
  double before, now; /* stiffness then and now, N/m; before 0: a new contact */
  double keep;        /* of the old force, after the contact area has changed */
  double way;         /* stiffness against the way of this step */
  bool leaks;         /* what the change of stiffness gives or takes is not dissipation */
  double dashpot, cap;
} reference_shear_spring;

/* Spring and dashpot in the tangent plane; history 0..2 is the force of the spring. */
void reference_shear(reference_contact *contact, const reference_shear_spring *spring);

/* Rolling about axes in the tangent plane; history first .. first + 2 is the spring's moment. */
void reference_rolling(reference_contact *contact, int first, double stiffness, double dashpot,
                       double cap);

/* A moment of size `cap` against the rolling, not more than stops an inertia within the step. */
void reference_slowing(reference_contact *contact, double cap, double inertia);

/* Twisting about n. */
void reference_twisting(reference_contact *contact, int first, double stiffness, double dashpot,
                        double cap);

/* For resistances: after reference_read, what the law has left in the batch; and back. */
void reference_add(const cdem_batch *batch, int lane, reference_contact *contact);
void reference_write_moment(const reference_contact *contact, cdem_batch *batch, int lane);

#endif
