/* Private to verify: oblique impact of an elastic sphere on a rigid plane with friction, the theory
 * of Maw, Barber & Fawcett (1976, Wear 38, 101): Hertz's contact in the normal direction, stick in
 * the middle and slip in a ring outside in the tangential one, with all their history.
 *
 * Solved by independent springs along a line, which for spheres is exact (method of dimensionality
 * reduction, Popov & Hess 2015; impact: Lyashenko & Popov 2015, Sci. Rep. 5, 8479): springs at x
 * have stiffness E* dx and G* dx and feel the profile x^2/R; each sticks until its friction bound.
 * Nothing here is shared with the laws of the room dem, whose one spring for the whole contact
 * sticks or slips as a whole.
 */
#ifndef CDEM_VERIFY_MAW_H
#define CDEM_VERIFY_MAW_H

/* Tangential velocity of the contact point after the impact over (friction x normal velocity),
 * where it was `incidence` of it before. inertia: I/(m r^2). Without losses in the normal
 * direction.
 */
double cdem_maw_rebound(double poisson, double inertia, double incidence);

#endif
