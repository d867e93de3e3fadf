/* Rate of the cell: as given, or such that the stress becomes the one that is wanted. */
#include "dem/store.h"

#include <math.h>

/* A packing of stiffness K that is strained by d(epsilon) (positive: longer) changes its pressure
 * by -K d(epsilon). So a rate of (p - p_wanted)/(K T) would remove the difference in the time T;
 * a part of it, the gain, is taken, and never more than servo_rate. Pressures p = -stress. What the
 * faces do is felt inside only when a wave has come through: a shorter T makes the cell swing.
 * Without contacts (bulk 0) the cell moves as fast as it may towards the wanted pressure, and a
 * packing that is still too loose to hold half of it is pressed faster, up to that. */
static double servo(const cdem_cell *cell, double wanted, double stress, double bulk_time) {
  double gain = cell->servo_gain > 0.0 ? cell->servo_gain : 0.25;
  double excess = gain * (-stress - wanted), most = cell->servo_rate;
  if (!(fabs(excess) < most * bulk_time))
    return excess > 0.0 ? most : excess < 0.0 ? -most : 0.0;
  double rate = excess / bulk_time;
  if (wanted > 0.0 && -stress < 0.5 * wanted)
    rate = fmax(-most, fmin(rate, -most * (1.0 + 2.0 * stress / wanted)));
  return rate;
}

void cdem_cell_rate(const cdem_cell *cell, double time, double response, const double stress[9],
                    double bulk, double rate[9]) {
  for (int k = 0; k < 9; k++)
    rate[k] = cdem_series_at(&cell->rate[k], time);
  for (int c = 0; c < 3; c++)
    if (cell->servo[c])
      rate[4 * c] =
          servo(cell, cdem_series_at(&cell->stress[c], time), stress[4 * c], bulk * response);
}
