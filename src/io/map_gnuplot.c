/* Maps: each polygon a block of the data file with its colour in it, drawn in the order of the map
 * (gnuplot paints plotted polygons in the order of the file); over them the lines, around them axes
 * or a scale bar, a legend and a colour bar. Lengths of the page in pixels of the .svg. */
#include "io/gnuplot.h"
#include "io/io.h"
#include "io/palette.h"
#include "io/run_files.h"
#include "io/text.h"

#include <math.h>
#include <string.h>

#define WIDEST        330.0 /* axes */
#define HIGHEST       300.0
#define NARROWEST     110.0
#define PADDING       0.03 /* around the bodies, part of their larger side */
#define EDGE          12.0
#define Y_AXIS        58.0
#define X_AXIS        40.0
#define SCALE_BAR     30.0
#define TITLE         24.0
#define BAR_GAP       14.0
#define BAR_WIDTH     11.0
#define BAR_TICS      40.0
#define BAR_MINUS     7.0 /* where ticks have a sign */
#define BAR_LABEL     20.0
#define LEGEND_ROW    16.0
#define LEGEND_SAMPLE 22.0
#define LEGEND_GAP    14.0
#define LETTER_WIDTH  6.7
#define OUTLINE       0.45 /* width, inside of a polygon */
#define HALO          1.4  /* more width of the white below a line, points */
#define CHORD         0.04 /* of a disc: how far its sides may be from the circle, pixels */
#define RIM           0.6
#define RIM_SHADE     0.6
#define LEAST_RIMMED  2.6 /* mean radius of a set, pixels */

enum { OUTLINE_COLOUR = 0x4d4d4d, MOST_CORNERS = 8, MOST_ROUND = 128 };
enum { DIGITS = 6, PALETTE_STEPS = 128, LONGEST_LABEL = 256 };

typedef struct {
  double x_low, x_high, y_low, y_high; /* of the axes */
  double left, bottom, across, up;     /* the axes on the page */
  double width, height;                /* the page */
  double value_low, value_high;
  int power;             /* of ten, of both axes */
  bool axes, bar, above; /* above: the label of the bar, which is too long to stand beside it */
  int legend_rows;
} layout;

/* ---- ranges ---- */

static void widen(double value, double *low, double *high) {
  if (isfinite(value)) {
    *low = fmin(*low, value);
    *high = fmax(*high, value);
  }
}

static void widen_marks(const cdem_map_marks *m, layout *l) {
  for (int64_t i = 0; i < m->marks; i++)
    for (int end = 0; end < (m->kind == CDEM_MAP_DISCS ? 1 : 2); end++) {
      const double *xy = m->xy + 4 * i + 2 * end;
      double around = m->kind == CDEM_MAP_DISCS ? m->size[i] : 0.5 * m->size[i];
      for (int sign = -1; sign <= 1; sign += 2) {
        widen(xy[0] + sign * around, &l->x_low, &l->x_high);
        widen(xy[1] + sign * around, &l->y_low, &l->y_high);
      }
    }
}

static void find_extent(const cdem_map *map, layout *l) {
  l->x_low = l->y_low = INFINITY;
  l->x_high = l->y_high = -INFINITY;
  for (int k = 0; k < map->mark_sets; k++)
    widen_marks(&map->marks[k], l);
  int64_t corners = map->polygons > 0 ? map->start[map->polygons] : 0;
  for (int64_t i = 0; i < corners; i++) {
    widen(map->xy[2 * i], &l->x_low, &l->x_high);
    widen(map->xy[2 * i + 1], &l->y_low, &l->y_high);
  }
  for (int k = 0; k < map->line_sets; k++)
    for (int64_t i = 0; i < 2 * map->lines[k].segments; i++) {
      widen(map->lines[k].xy[2 * i], &l->x_low, &l->x_high);
      widen(map->lines[k].xy[2 * i + 1], &l->y_low, &l->y_high);
    }
  if (!(l->x_low <= l->x_high && l->y_low <= l->y_high)) {
    l->x_low = l->y_low = 0.0;
    l->x_high = l->y_high = 1.0;
  }
  double size = fmax(l->x_high - l->x_low, l->y_high - l->y_low);
  double pad = size > 0.0 ? PADDING * size : 0.5;
  l->x_low -= pad;
  l->x_high += pad;
  l->y_low -= pad;
  l->y_high += pad;
}

static void find_values(const cdem_map *map, layout *l) {
  double low = INFINITY, high = -INFINITY;
  for (int64_t i = 0; i < map->polygons; i++)
    widen(map->value[i], &low, &high);
  for (int k = 0; k < map->mark_sets; k++)
    for (int64_t i = 0; i < map->marks[k].marks && map->marks[k].value != NULL; i++)
      widen(map->marks[k].value[i], &low, &high);
  if (map->value_min != map->value_max) {
    low = map->value_min;
    high = map->value_max;
  } else if (map->diverging && low <= high) {
    high = fmax(fabs(low), fabs(high));
    low = -high;
  }
  if (!(low <= high))
    low = 0.0, high = 1.0;
  if (!(high - low > 1e-12 * fmax(fabs(low), fabs(high)))) {
    double size = low != 0.0 ? 0.05 * fabs(low) : 1.0;
    low -= size;
    high += size;
  }
  l->value_low = low;
  l->value_high = high;
}

/* ---- the page ---- */

static bool has_text(const char *text) {
  return text != NULL && text[0] != '\0';
}

static double entry_width(const cdem_map_lines *lines) {
  return LEGEND_SAMPLE + LETTER_WIDTH * cdem_gnuplot_letters(lines->title) + LEGEND_GAP;
}

/* Equal scales in both directions: what the bodies do not fill of a slender page is left empty. */
static void find_axes(double page, layout *l) {
  double w = l->x_high - l->x_low, h = l->y_high - l->y_low, size = page > 0.0 ? page : 1.0;
  double scale = fmin(size * WIDEST / w, size * HIGHEST / h);
  l->across = fmax(NARROWEST, scale * w);
  l->up = fmax(NARROWEST, scale * h);
  double more_x = 0.5 * (l->across / scale - w), more_y = 0.5 * (l->up / scale - h);
  l->x_low -= more_x;
  l->x_high += more_x;
  l->y_low -= more_y;
  l->y_high += more_y;
}

static void lay_out(const cdem_map *map, layout *l) {
  find_extent(map, l);
  find_values(map, l);
  find_axes(map->page, l);
  l->axes = map->x_label != NULL;
  l->power = l->axes ? cdem_gnuplot_power(fmin(l->x_low, l->y_low), fmax(l->x_high, l->y_high)) : 0;
  l->bar = map->value_label != NULL;
  double row = 0.0;
  for (int k = 0; k < map->line_sets; k++) {
    if (!has_text(map->lines[k].title))
      continue;
    double width = entry_width(&map->lines[k]);
    if (l->legend_rows == 0 || row + width > l->across) {
      l->legend_rows++;
      row = 0.0;
    }
    row += width;
  }
  l->left = !l->axes ? EDGE : l->y_low < 0.0 ? Y_AXIS + BAR_MINUS : Y_AXIS;
  l->bottom = (l->axes ? X_AXIS : SCALE_BAR) + l->legend_rows * LEGEND_ROW;
  l->above = l->bar && LETTER_WIDTH * cdem_gnuplot_letters(map->value_label) > l->up;
  double beside = BAR_GAP + BAR_WIDTH + BAR_TICS + (l->value_low < 0.0 ? BAR_MINUS : 0.0) +
                  (l->above ? 0.0 : BAR_LABEL);
  l->width = l->left + l->across + (l->bar ? beside : EDGE);
  l->height = l->bottom + l->up + (has_text(map->title) || l->bar ? TITLE : EDGE) +
              (l->above ? TITLE : 0.0);
}

/* ---- data ---- */

/* Six digits of the largest are enough for a picture; a number is a whole one times a power of ten,
 * which is exact and the same in every locale. */
static int power_of(double low, double high) {
  double size = fmax(fabs(low), fabs(high));
  return size > 0.0 ? (int)floor(log10(size)) + 1 - DIGITS : 0;
}

static char *put_short(char *at, double value, int power) {
  if (!isfinite(value))
    return cdem_put_text(at, "nan");
  at = cdem_put_integer(at,
                        llround(power < 0 ? value * pow(10.0, -power) : value / pow(10.0, power)));
  if (power != 0) {
    *at++ = 'e';
    at = cdem_put_integer(at, power);
  }
  return at;
}

static void put_point(FILE *stream, const double xy[2], int power, const char *more) {
  char line[128], *at = put_short(line, xy[0], power);
  *at++ = ' ';
  at = put_short(at, xy[1], power);
  at = cdem_put_text(at, more);
  *at++ = '\n';
  fwrite(line, 1, (size_t)(at - line), stream);
}

static double bar_place(const cdem_map *map, const layout *l, double value) {
  double place = (value - l->value_low) / (l->value_high - l->value_low);
  return map->reversed ? 1.0 - place : place;
}

static uint32_t colour_of(const cdem_map *map, const layout *l, int64_t polygon) {
  double place = bar_place(map, l, map->value[polygon]);
  return cdem_palette_colour(map->diverging, l->bar ? place : NAN,
                             map->shade != NULL ? map->shade[polygon] : 1.0);
}

/* A convex polygon with its edges moved inwards by `distance`. False when little would be left. */
static bool inset(const double (*xy)[2], int corners, double distance, double (*out)[2]) {
  double area = 0.0, round = 0.0, edge[MOST_CORNERS][2];
  for (int i = 0; i < corners; i++) {
    const double *a = xy[i], *b = xy[(i + 1) % corners];
    double x = b[0] - a[0], y = b[1] - a[1], length = sqrt(x * x + y * y);
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    round += length;
    edge[i][0] = length > 0.0 ? x / length : 0.0;
    edge[i][1] = length > 0.0 ? y / length : 0.0;
  }
  double inwards = area > 0.0 ? distance : -distance;
  if (!(2.0 * fabs(area) > 4.0 * distance * round))
    return false;
  for (int i = 0; i < corners; i++) {
    const double *before = edge[(i + corners - 1) % corners], *after = edge[i];
    double along = fmax(0.3, 1.0 + before[0] * after[0] + before[1] * after[1]);
    out[i][0] = xy[i][0] - inwards * (before[1] + after[1]) / along;
    out[i][1] = xy[i][1] + inwards * (before[0] + after[0]) / along;
  }
  return true;
}

/* x y colour value, a closed ring. */
static void put_ring(FILE *stream, const double (*xy)[2], int64_t corners, uint32_t colour,
                     double value, const int power[2]) {
  char more[64], *at = more;
  *at++ = ' ';
  at = cdem_put_integer(at, colour);
  *at++ = ' ';
  *put_short(at, value, power[1]) = '\0';
  for (int64_t i = 0; i <= corners && corners > 0; i++)
    put_point(stream, xy[i % corners], power[0], more);
  fputs("\n", stream);
}

/* An outline is the polygon in its colour, below the polygon made smaller: so it is hidden where
 * the polygon is. */
static void put_polygon(FILE *stream, const cdem_map *map, const layout *l, int64_t p,
                        const int power[2]) {
  const double(*xy)[2] = (const double(*)[2])map->xy + map->start[p];
  int64_t corners = map->start[p + 1] - map->start[p];
  double smaller[MOST_CORNERS][2], width = OUTLINE * (l->x_high - l->x_low) / l->across;
  uint32_t colour = colour_of(map, l, p);
  if (map->outlines && corners <= MOST_CORNERS && inset(xy, (int)corners, 0.5 * width, smaller)) {
    put_ring(stream, xy, corners, OUTLINE_COLOUR, map->value[p], power);
    put_ring(stream, (const double(*)[2])smaller, corners, colour, map->value[p], power);
  } else
    put_ring(stream, xy, corners, colour, map->value[p], power);
}

/* ---- marks as rings ---- */

static uint32_t mark_colour(const cdem_map *map, const layout *l, const cdem_map_marks *m,
                            int64_t i) {
  double value = m->value != NULL ? m->value[i] : NAN, shade = m->shade != NULL ? m->shade[i] : 1.0;
  unsigned plain = 0xcccccc, part[3];
  if (isfinite(value) && l->bar)
    return cdem_palette_colour(map->diverging, bar_place(map, l, value), shade);
  if (m->colour != NULL && sscanf(m->colour, "#%2x%2x%2x", &part[0], &part[1], &part[2]) == 3)
    plain = part[0] << 16 | part[1] << 8 | part[2];
  uint32_t colour = 0;
  for (int bit = 0; bit < 24; bit += 8)
    colour |= (uint32_t)llround((plain >> bit & 0xff) * shade) << bit;
  return colour;
}

static uint32_t darker(uint32_t colour) {
  uint32_t dark = 0;
  for (int bit = 0; bit < 24; bit += 8)
    dark |= (uint32_t)llround((colour >> bit & 0xff) * RIM_SHADE) << bit;
  return dark;
}

/* Corners enough that no chord is further from the circle than the eye sees. */
static void put_disc(FILE *stream, const layout *l, const double centre[2], double radius,
                     uint32_t colour, int power) {
  double pixels = radius / (l->x_high - l->x_low) * l->across, xy[MOST_ROUND][2];
  int corners = (int)ceil(3.14159265358979323846 / sqrt(2.0 * CHORD / fmax(pixels, CHORD)));
  corners = corners < 8 ? 8 : corners > MOST_ROUND ? MOST_ROUND : corners;
  for (int k = 0; k < corners; k++) {
    double angle = 2.0 * 3.14159265358979323846 * k / corners;
    xy[k][0] = centre[0] + radius * cos(angle);
    xy[k][1] = centre[1] + radius * sin(angle);
  }
  put_ring(stream, (const double(*)[2])xy, corners, colour, NAN, (const int[2]){power, 0});
}

/* Along t from a to b, across n; an arrow's head is three shafts wide and four long. */
static void put_stroke(FILE *stream, const cdem_map_marks *m, int64_t i, uint32_t colour,
                       int power) {
  const double *a = m->xy + 4 * i, *b = a + 2;
  double x = b[0] - a[0], y = b[1] - a[1], length = sqrt(x * x + y * y), half = 0.5 * m->size[i];
  if (!(length > 0.0 && half > 0.0))
    return;
  bool arrow = m->kind == CDEM_MAP_ARROWS;
  double t[2] = {x / length, y / length}, head = arrow ? fmin(8.0 * half, 0.6 * length) : 0.0;
  const double along[7] = {0.0, length - head, length - head, length, length - head, length - head,
                           0.0};
  const double aside[7] = {-half, -half, -0.375 * head, 0.0, 0.375 * head, half, half};
  double xy[7][2];
  int corners = 0;
  for (int k = 0; k < 7; k++)
    if (arrow || k < 2 || k > 4) {
      xy[corners][0] = a[0] + along[k] * t[0] - aside[k] * t[1];
      xy[corners++][1] = a[1] + along[k] * t[1] + aside[k] * t[0];
    }
  put_ring(stream, (const double(*)[2])xy, corners, colour, NAN, (const int[2]){power, 0});
}

/* All discs of a set have rims, or none; but for those that would be all rim. */
static bool has_rims(const cdem_map_marks *m, double pixel) {
  double sum = 0.0;
  for (int64_t i = 0; i < m->marks && m->rims; i++)
    sum += m->size[i];
  return sum > LEAST_RIMMED * pixel * (double)m->marks;
}

static void put_marks(FILE *stream, const cdem_map *map, const layout *l, int power) {
  double pixel = (l->x_high - l->x_low) / l->across;
  for (int k = 0; k < map->mark_sets; k++) {
    const cdem_map_marks *m = &map->marks[k];
    bool rims = m->kind == CDEM_MAP_DISCS && has_rims(m, pixel);
    for (int64_t i = 0; i < m->marks; i++) {
      uint32_t colour = mark_colour(map, l, m, i);
      if (m->kind != CDEM_MAP_DISCS) {
        put_stroke(stream, m, i, colour, power);
        continue;
      }
      bool rim = rims && m->size[i] > 2.0 * RIM * pixel;
      put_disc(stream, l, m->xy + 4 * i, m->size[i], rim ? darker(colour) : colour, power);
      if (rim)
        put_disc(stream, l, m->xy + 4 * i, m->size[i] - RIM * pixel, colour, power);
    }
  }
}

/* A ring ends with an empty line, a set with two. */
static void put_data(FILE *stream, const void *picture) {
  const cdem_map *map = picture;
  layout l = {0};
  lay_out(map, &l);
  const int power[2] = {
      power_of(fmax(fabs(l.x_low), fabs(l.y_low)), fmax(fabs(l.x_high), fabs(l.y_high))),
      power_of(l.value_low, l.value_high)};
  fputs("# polygons: x y colour value\n", stream);
  for (int64_t p = 0; p < map->polygons; p++)
    put_polygon(stream, map, &l, p, power);
  put_marks(stream, map, &l, power[0]);
  if (map->polygons == 0)
    fputs("nan nan 0 nan\n\n", stream);
  for (int k = 0; k < map->line_sets; k++) {
    fprintf(stream, "\n# lines %d: x y\n", k + 1);
    for (int64_t i = 0; i < map->lines[k].segments; i++) {
      put_point(stream, map->lines[k].xy + 4 * i, power[0], "");
      put_point(stream, map->lines[k].xy + 4 * i + 2, power[0], "");
      fputs("\n", stream);
    }
    if (map->lines[k].segments == 0)
      fputs("nan nan\n\n", stream);
  }
}

/* ---- script ---- */

static void put_screen(FILE *stream, double x, double y, const layout *l) {
  fputs("screen ", stream);
  cdem_gnuplot_number(stream, x / l->width);
  fputs(", screen ", stream);
  cdem_gnuplot_number(stream, y / l->height);
}

static void put_label(FILE *stream, const char *text, double x, double y, const layout *l,
                      const char *more) {
  fputs("set label ", stream);
  cdem_gnuplot_text(stream, text);
  fputs(" at ", stream);
  put_screen(stream, x, y, l);
  fprintf(stream, " %s\n", more);
}

/* The power of ten that ticks share. */
static void put_power(FILE *stream, int power, double x, double y, const layout *l,
                      const char *side) {
  char text[32], more[96];
  cdem_gnuplot_power_text(power, text);
  snprintf(more, sizeof more, "%s font '" CDEM_GNUPLOT_FONT ",8.2'", side);
  if (power != 0)
    put_label(stream, text, x, y, l, more);
}

static void put_axes(FILE *stream, const cdem_map *map, const layout *l) {
  const double edge[4] = {l->left / l->width, (l->left + l->across) / l->width,
                          l->bottom / l->height, (l->bottom + l->up) / l->height};
  fputs("set margins screen ", stream);
  for (int e = 0; e < 4; e++) {
    fputs(e == 0 ? "" : ", screen ", stream);
    cdem_gnuplot_number(stream, edge[e]);
  }
  fputc('\n', stream);
  double factor = pow(10.0, l->power);
  cdem_gnuplot_range(stream, "x", l->x_low / factor, l->x_high / factor);
  cdem_gnuplot_range(stream, "y", l->y_low / factor, l->y_high / factor);
  if (!l->axes) {
    fputs("unset border\nunset tics\n", stream);
    return;
  }
  fprintf(stream,
          "set border 31 front lw 0.6 lc rgb '#222222'\n"
          "set tics front out nomirror scale 0.5,0.25 font '" CDEM_GNUPLOT_FONT
          ",%g' textcolor rgb 'black'\n",
          CDEM_GNUPLOT_TICS_SIZE);
  /* Ticks no closer than their labels are wide. */
  const double length[2] = {l->across, l->up},
               size[2] = {(l->x_high - l->x_low) / factor, (l->y_high - l->y_low) / factor};
  for (int a = 0; a < 2; a++) {
    double least = size[a] * (a == 0 ? 55.0 : 35.0) / length[a];
    double step = pow(10.0, floor(log10(least)));
    step *= step >= least ? 1.0 : 2.0 * step >= least ? 2.0 : 5.0 * step >= least ? 5.0 : 10.0;
    fprintf(stream, "set %stics ", a == 0 ? "x" : "y");
    cdem_gnuplot_number(stream, step);
    fputc('\n', stream);
  }
  put_power(stream, l->power, l->left + l->across, l->bottom - 31.0, l, "right");
  put_power(stream, l->power, l->left - 6.0, l->bottom + l->up + 10.0, l, "right");
  put_label(stream, map->x_label, l->left + 0.5 * l->across, l->bottom - 31.0, l, "center");
  put_label(stream, map->y_label, 13.0, l->bottom + 0.5 * l->up, l, "center rotate by 90");
}

/* A length of 1, 2 or 5 times a power of ten, about a quarter of the axes, in a unit that makes it
 * a whole number. */
static void put_scale_bar(FILE *stream, const layout *l) {
  static const struct {
    const char *name;
    double size;
  } units[] = {{"km", 1e3}, {"m", 1.0}, {"mm", 1e-3}, {"µm", 1e-6}, {"nm", 1e-9}};
  double most = 0.3 * (l->x_high - l->x_low), step = pow(10.0, floor(log10(most)));
  step *= 5.0 * step <= most ? 5.0 : 2.0 * step <= most ? 2.0 : 1.0;
  int u = 0;
  while (u < 4 && step < 0.999 * units[u].size)
    u++;
  char label[48], *at = cdem_put_integer(label, llround(step / units[u].size));
  *at++ = ' ';
  *cdem_put_text(at, units[u].name) = '\0';
  double length = step / (l->x_high - l->x_low) * l->across;
  double y = l->legend_rows * LEGEND_ROW + 12.0;
  fputs("set arrow from ", stream);
  put_screen(stream, l->left + 4.0, y, l);
  fputs(" to ", stream);
  put_screen(stream, l->left + 4.0 + length, y, l);
  fputs(" heads size screen 0.006,90 lw 1 lc rgb '#222222' front\n", stream);
  put_label(stream, label, l->left + 4.0 + length + 8.0, y, l, "left front");
}

static void put_legend(FILE *stream, const cdem_map *map, const layout *l) {
  double x = 0.0, y = (l->legend_rows - 1) * LEGEND_ROW + 9.0;
  for (int k = 0; k < map->line_sets; k++) {
    const cdem_map_lines *lines = &map->lines[k];
    if (!has_text(lines->title))
      continue;
    double width = entry_width(lines);
    if (x > 0.0 && x + width > l->across) {
      x = 0.0;
      y -= LEGEND_ROW;
    }
    fputs("set arrow from ", stream);
    put_screen(stream, l->left + x, y, l);
    fputs(" to ", stream);
    put_screen(stream, l->left + x + LEGEND_SAMPLE - 5.0, y, l);
    fprintf(stream, " nohead lc rgb '%s' lw ", lines->colour);
    cdem_gnuplot_number(stream, lines->width);
    fputs(" front\n", stream);
    put_label(stream, lines->title, l->left + x + LEGEND_SAMPLE, y, l, "left front");
    x += width;
  }
}

/* The bar has a palette of its own; large and small numbers share a power of ten above it. */
static void put_bar(FILE *stream, const cdem_map *map, const layout *l) {
  int power = cdem_gnuplot_power(l->value_low, l->value_high);
  double factor = pow(10.0, power), x = l->left + l->across + BAR_GAP;
  fputs("set palette defined (", stream);
  for (int i = 0; i <= PALETTE_STEPS; i++)
    fprintf(
        stream, "%s%d '#%06x'", i > 0 ? "," : "", i,
        (unsigned)cdem_palette_colour(
            map->diverging, (double)(map->reversed ? PALETTE_STEPS - i : i) / PALETTE_STEPS, 1.0));
  fprintf(stream, ")\nset palette maxcolors 0\n");
  cdem_gnuplot_range(stream, "cb", l->value_low / factor, l->value_high / factor);
  fputs("set colorbox vertical user origin ", stream);
  put_screen(stream, x, l->bottom, l);
  fputs(" size ", stream);
  put_screen(stream, BAR_WIDTH, l->up, l);
  fprintf(stream,
          " noborder\nset cbtics out nomirror scale 0.3 font '" CDEM_GNUPLOT_FONT
          ",%g' offset -0.4,0 format '%%g'\n",
          CDEM_GNUPLOT_TICS_SIZE);
  if (l->above)
    put_label(stream, map->value_label, l->width - 9.0, l->height - 12.0, l, "right");
  else
    put_label(stream, map->value_label, l->width - 9.0, l->bottom + 0.5 * l->up, l,
              "center rotate by 90");
  put_power(stream, power, x, l->bottom + l->up + 10.0, l, "left");
}

static void put_columns(FILE *stream, int set, const layout *l) {
  fprintf(stream, "data index %d using ", set);
  cdem_gnuplot_column(stream, 1, l->power);
  fputc(':', stream);
  cdem_gnuplot_column(stream, 2, l->power);
}

static void put_plot(FILE *stream, const cdem_map *map, const layout *l) {
  fputs("set style fill solid 1.0 noborder\nplot ", stream);
  put_columns(stream, 0, l);
  fputs(":3 with filledcurves closed fc rgb variable notitle", stream);
  /* A white rim keeps lines apart from a field of their colour. */
  for (int k = 0; k < 2 * map->line_sets; k++) {
    const cdem_map_lines *lines = &map->lines[k % map->line_sets];
    bool rim = k < map->line_sets;
    fputs(", \\\n     ", stream);
    put_columns(stream, k % map->line_sets + 1, l);
    fprintf(stream, " with lines lc rgb '%s' lw ", rim ? "#ffffff" : lines->colour);
    cdem_gnuplot_number(stream, lines->width + (rim ? HALO : 0.0));
    fputs(" notitle", stream);
  }
  /* Without something drawn by palette there is no colour bar. */
  fputs(l->bar ? ", \\\n     NaN with points palette notitle\n" : "\n", stream);
}

static void put_script(FILE *stream, const char *name, const void *picture) {
  const cdem_map *map = picture;
  layout l = {0};
  lay_out(map, &l);
  cdem_gnuplot_begin(stream, name, l.width, l.height, "rounded");
  fputs("unset key\n", stream);
  put_axes(stream, map, &l);
  if (!l.axes)
    put_scale_bar(stream, &l);
  put_legend(stream, map, &l);
  if (l.bar)
    put_bar(stream, map, &l);
  if (has_text(map->title))
    put_label(stream, map->title, l.left, l.bottom + l.up + 12.0, &l, "left");
  put_plot(stream, map, &l);
  cdem_gnuplot_end(stream);
}

cdem_status cdem_write_map(const char *folder, const char *name, const cdem_map *map,
                           cdem_fault *fault) {
  return cdem_gnuplot_draw(folder, name, &(cdem_drawing){map, put_data, put_script}, fault);
}
