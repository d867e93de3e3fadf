/* Bands of strain: the shape of what has strained most (measures.h); tests/dem/bands.c. */
#include "dem/measures.h"

#include <math.h>

static const double part_of_largest = 0.5;

/* By centres, low <= x < high. */
static bool is_inside(const cdem_region *region, const double xyz[3]) {
  for (int c = 0; region != NULL && c < 2; c++)
    if (region->low[c] < region->high[c] && !(xyz[c] >= region->low[c] && xyz[c] < region->high[c]))
      return false;
  return true;
}

/* Longer axis and ratio of the radii of gyration of second moments about the centre. */
static void take_axes(double xx, double yy, double xy, cdem_band *band) {
  double half = 0.5 * (xx + yy), apart = hypot(0.5 * (xx - yy), xy);
  double least = half - apart;
  if (!(apart > 1e-12 * half)) { /* no direction is longer than the others */
    band->slenderness = 1.0;
    return;
  }
  band->angle = 0.5 * atan2(2.0 * xy, xx - yy);
  band->slenderness = least > 1e-12 * half ? sqrt((half + apart) / least) : INFINITY;
}

void cdem_band_find(int64_t grains, const double *xyz, const double *value,
                    const cdem_region *region, cdem_band *band) {
  double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  *band = (cdem_band){.largest = NAN, .center = {NAN, NAN}, .angle = NAN, .slenderness = NAN};
  for (int64_t i = 0; i < grains; i++)
    if (is_inside(region, xyz + 3 * i))
      band->largest = fmax(band->largest, value[i]); /* passes over NaN */
  for (int pass = 0; pass < 2; pass++) { /* the centre first: no digits are lost in squares */
    for (int64_t i = 0; i < grains; i++) {
      const double *at = xyz + 3 * i;
      if (!(value[i] > part_of_largest * band->largest) || !is_inside(region, at))
        continue;
      if (pass == 0) {
        band->grains++;
        x += at[0];
        y += at[1];
        continue;
      }
      double dx = at[0] - band->center[0], dy = at[1] - band->center[1];
      xx += dx * dx;
      yy += dy * dy;
      xy += dx * dy;
    }
    if (pass == 0 && band->grains > 0) {
      band->center[0] = x / (double)band->grains;
      band->center[1] = y / (double)band->grains;
    }
  }
  if (band->grains >= 3)
    take_axes(xx, yy, xy, band);
}
