/* Rate of the cell: as given, or such that the stress becomes the one that is wanted. */
#include "dem/store.h"

#include <math.h>

/* A packing of stiffness K that is strained by d(epsilon) (positive: longer) changes its pressure
 * by -K d(epsilon). So a rate of (p - p_wanted)/(K T) would remove the difference in the time T;
 * a part of it, the gain, is taken, and never more than servo_rate. Pressures p = -stress. What the
 * faces do is felt inside only when a wave has come through: a shorter T makes the cell swing.
 * Without contacts (bulk 0) the cell moves as fast as it may towards the wanted pressure, and a
 * packing that is still too loose to hold half of it is pressed faster, up to that, but not so fast
 * that its dashpots (viscosity times rate) would answer a quarter of it: at half they turn the rate
 * round in each step. */
static double servo(const cdem_cell *cell, double wanted, double stress, double bulk_time,
                    double viscosity) {
  double gain = cell->servo_gain > 0.0 ? cell->servo_gain : 0.25;
  double excess = gain * (-stress - wanted), most = cell->servo_rate;
  if (!(fabs(excess) < most * bulk_time))
    return excess > 0.0 ? most : excess < 0.0 ? -most : 0.0;
  double rate = excess / bulk_time;
  if (wanted > 0.0 && -stress < 0.5 * wanted) {
    bool slow = 4.0 * most * viscosity > wanted;
    double press = slow ? 0.25 * wanted / viscosity : most;
    rate = fmax(-most, fmin(rate, -press * (1.0 + 2.0 * stress / wanted)));
  }
  return rate;
}

bool cdem_cell_is_sought(const cdem_cell *cell, double time, const double stress[9]) {
  bool any = false;
  for (int c = 0; c < 3; c++)
    any = any || (cell->servo[c] && -stress[4 * c] >= 0.5 * cdem_series_at(&cell->stress[c], time));
  return any;
}

/* The rate goes to the servo's in a quarter of the time that the packing takes to answer. Dashpots
 * answer within a step: without the lag a servo of many contacts, found before they were there,
 * would turn its rate round in each step, at any step, and no book could follow. With gain g the
 * pressure then obeys T/4 p'' + p' + g/T (p - p_wanted) = 0, which is overdamped up to g = 1. */
static double follow(double rate, double wanted, const cdem_cell_answer *answer) {
  return rate + fmin(1.0, 4.0 * answer->step / answer->time) * (wanted - rate);
}

void cdem_cell_rate(const cdem_cell *cell, double time, const double stress[9],
                    const cdem_cell_answer *answer, double rate[9]) {
  for (int k = 0; k < 9; k++) {
    const int c = k / 4;
    if (k % 4 != 0 || !cell->servo[c])
      rate[k] = cdem_series_at(&cell->rate[k], time);
    else
      rate[k] = follow(rate[k],
                       servo(cell, cdem_series_at(&cell->stress[c], time), stress[k],
                             answer->bulk * answer->time, answer->viscosity),
                       answer);
  }
}
