#include "io/palette.h"

#include <math.h>

static const double grey = 0.80;

/* Linear light to the sRGB curve. */
static double gamma_curve(double linear) {
  if (!(linear > 0.0))
    return 0.0;
  double value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
  return value < 1.0 ? value : 1.0;
}

/* Lightness, chroma, hue (degrees) of Oklab to sRGB; what a screen cannot show is clipped. */
static void from_oklab(double lightness, double chroma, double hue, double rgb[3]) {
  double h = hue * acos(-1.0) / 180.0, a = chroma * cos(h), b = chroma * sin(h);
  double l = lightness + 0.3963377774 * a + 0.2158037573 * b;
  double m = lightness - 0.1055613458 * a - 0.0638541728 * b;
  double s = lightness - 0.0894841775 * a - 1.2914855480 * b;
  l = l * l * l;
  m = m * m * m;
  s = s * s * s;
  rgb[0] = gamma_curve(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s);
  rgb[1] = gamma_curve(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s);
  rgb[2] = gamma_curve(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s);
}

/* The chroma stays within what a screen can show: least in the greenish blue of the middle. */
static void sequential(double t, double rgb[3]) {
  from_oklab(0.30 + 0.60 * t, 0.12 + t * (0.18 * t - 0.14), 300.0 - 200.0 * t, rgb);
}

static void diverging_at(double t, double rgb[3]) {
  double from_middle = fabs(2.0 * t - 1.0);
  from_oklab(0.97 - 0.52 * from_middle, (t < 0.5 ? 0.14 : 0.17) * from_middle,
             t < 0.5 ? 255.0 : 27.0, rgb);
}

uint32_t cdem_palette_colour(bool diverging, double place, double shade) {
  double rgb[3] = {grey, grey, grey};
  double t = fmin(1.0, fmax(0.0, place));
  if (!isnan(place) && diverging)
    diverging_at(t, rgb);
  else if (!isnan(place))
    sequential(t, rgb);
  uint32_t colour = 0;
  for (int c = 0; c < 3; c++)
    colour = colour << 8 | (uint32_t)lround(255.0 * rgb[c] * shade);
  return colour;
}
