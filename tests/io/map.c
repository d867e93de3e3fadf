/* Maps as pictures: what stands in the data and the script, and that gnuplot draws it. */
#include "io/palette.h"
#include "io/run_files.h"
#include "io/support.h"

/* A square and a triangle beside it, and a crack across the square. */
static int64_t start[3] = {0, 4, 7};
static double xy[14] = {0, 0, 1, 0, 1, 1, 0, 1, 1, 0, 2, 0.5, 1, 1};
static double value[2] = {-2e6, 6e6}, shade[2] = {1.0, 0.5};
static double crack[8] = {0, 0, 0.5, 0.25, 0.5, 0.25, 1, 1};

static cdem_map small_map(cdem_map_lines *lines) {
  *lines = (cdem_map_lines){"tension", "#b2182b", 1.5, 2, crack};
  return (cdem_map){.title = "It's \"here\"",
                    .x_label = "x, m",
                    .y_label = "y, m",
                    .value_label = "stress, Pa",
                    .polygons = 2,
                    .start = start,
                    .xy = xy,
                    .value = value,
                    .line_sets = 1,
                    .lines = lines};
}

static char *draw(const char *name, const cdem_map *map, const char *ending) {
  cdem_fault fault = {0};
  char file[64];
  check_ok(cdem_write_map(in_scratch("out"), name, map, &fault));
  snprintf(file, sizeof file, "out/%s.%s", name, ending);
  return read_whole(in_scratch(file), NULL);
}

static void check_holds(const char *text, const char *part) {
  if (strstr(text, part) == NULL)
    fail_msg("'%s' is not in:\n%s", part, text);
}

static void data_has_every_polygon(void **unused) {
  (void)unused;
  cdem_map_lines lines;
  cdem_map map = small_map(&lines);
  unsigned low = cdem_palette_colour(false, 0, 1), high = cdem_palette_colour(false, 1, 1);
  char expected[1000], *text = draw("plain", &map, "dat");
  snprintf(expected, sizeof expected,
           "# polygons: x y colour value\n"
           "0e-5 0e-5 %1$u -200000e1\n100000e-5 0e-5 %1$u -200000e1\n"
           "100000e-5 100000e-5 %1$u -200000e1\n0e-5 100000e-5 %1$u -200000e1\n"
           "0e-5 0e-5 %1$u -200000e1\n\n"
           "100000e-5 0e-5 %2$u 600000e1\n200000e-5 50000e-5 %2$u 600000e1\n"
           "100000e-5 100000e-5 %2$u 600000e1\n100000e-5 0e-5 %2$u 600000e1\n\n"
           "\n# lines 1: x y\n0e-5 0e-5\n50000e-5 25000e-5\n\n"
           "50000e-5 25000e-5\n100000e-5 100000e-5\n\n",
           low, high);
  assert_string_equal(text, expected);
  free(text);
}

/* The colour of the polygon that begins at (0, 0) or, second, at (1, 0) right of it. */
static unsigned colour_in(const char *text, int polygon) {
  for (; polygon > 0; polygon--)
    text = strstr(text, "\n\n") + 1;
  unsigned colour = 0;
  assert_int_equal(sscanf(strchr(text, '\n'), " %*s %*s %u", &colour), 1);
  return colour;
}

static void colours_follow_value_and_shade(void **unused) {
  (void)unused;
  cdem_map_lines lines;
  cdem_map map = small_map(&lines);
  map.shade = shade;
  map.diverging = true;
  char *text = draw("diverging", &map, "dat"); /* around zero: -2 of -6..6 is a third */
  assert_int_equal(colour_in(text, 0), cdem_palette_colour(true, 1.0 / 3, 1.0));
  assert_int_equal(colour_in(text, 1), cdem_palette_colour(true, 1.0, 0.5));
  free(text);
  map.diverging = false;
  map.value_min = 0;
  map.value_max = 12e6;
  text = draw("range", &map, "dat"); /* what is outside has the colour of the end */
  assert_int_equal(colour_in(text, 0), cdem_palette_colour(false, 0, 1.0));
  assert_int_equal(colour_in(text, 1), cdem_palette_colour(false, 0.5, 0.5));
  free(text);
  map.value_label = NULL;
  text = draw("grey", &map, "dat");
  assert_int_equal(colour_in(text, 0), 0xcccccc);
  assert_int_equal(colour_in(text, 1), 0x666666);
  free(text);
  map = small_map(&lines);
  double broken[2] = {NAN, 3};
  map.value = broken;
  text = draw("nan", &map, "dat");
  assert_int_equal(colour_in(text, 0), 0xcccccc);
  check_holds(text, " nan\n");
  free(text);
}

static void outlines_are_below_smaller_polygons(void **unused) {
  (void)unused;
  cdem_map_lines lines;
  cdem_map map = small_map(&lines);
  map.outlines = true;
  char *text = draw("outlines", &map, "dat");
  assert_int_equal(colour_in(text, 0), 0x4d4d4d);
  assert_int_equal(colour_in(text, 1), cdem_palette_colour(false, 0, 1));
  assert_int_equal(colour_in(text, 2), 0x4d4d4d);
  assert_int_equal(colour_in(text, 3), cdem_palette_colour(false, 1, 1));
  /* The page is 330 pixels for 2.12 m; half an outline of 0.45 pixel is 1.45 mm. */
  double x = 0, y = 0;
  assert_int_equal(sscanf(strstr(text, "\n\n"), " %lf %lf", &x, &y), 2);
  check_near(x, 0.00145, 0, 1e-5);
  check_near(y, 0.00145, 0, 1e-5);
  free(text);
}

static unsigned big_endian(const unsigned char *at) {
  return (unsigned)at[0] << 24 | (unsigned)at[1] << 16 | (unsigned)at[2] << 8 | at[3];
}

static void scripts_say_what_is_drawn(void **unused) {
  (void)unused;
  cdem_map_lines lines;
  cdem_map map = small_map(&lines);
  char *text = draw("full", &map, "gp");
  check_holds(text, "set label 'It''s \"here\"'");
  check_holds(text, "set label 'x, m'");
  check_holds(text, "set label 'stress, Pa'");
  check_holds(text, "set label '×10^{6}'");
  check_holds(text, "set cbrange [-2:6]");
  check_holds(text, "set label 'tension'");
  check_holds(text, "set xtics 0.5");
  check_holds(text, "plot data index 0 using 1:2:3 with filledcurves closed fc rgb variable");
  check_holds(text, "data index 1 using 1:2 with lines lc rgb '#ffffff' lw 2.8999999999999999");
  check_holds(text, "data index 1 using 1:2 with lines lc rgb '#b2182b' lw 1.5");
  /* Equal scales: the padded box of 2.12 by 1.12 fills 330 pixels by 174.3. */
  double a[4], b[4], width = 0, height = 0;
  assert_int_equal(sscanf(strstr(text, "set margins"),
                          "set margins screen %lf, screen %lf, screen "
                          "%lf, screen %lf",
                          &a[0], &a[1], &a[2], &a[3]),
                   4);
  assert_int_equal(sscanf(strstr(text, "set xrange"), "set xrange [%lf:%lf]", &b[0], &b[1]), 2);
  assert_int_equal(sscanf(strstr(text, "set yrange"), "set yrange [%lf:%lf]", &b[2], &b[3]), 2);
  assert_int_equal(
      sscanf(strstr(text, "svg enhanced size"), "svg enhanced size %lf,%lf", &width, &height), 2);
  free(text);
  check_near(b[1] - b[0], 2.12, 1e-12, 0);
  check_near(b[3] - b[2], 1.12, 1e-12, 0);
  check_near((a[1] - a[0]) * width / 330, 1, 0.005, 0); /* pages are whole pixels */
  check_near((a[3] - a[2]) * height / ((a[1] - a[0]) * width), 1.12 / 2.12, 0.005, 0);
  size_t bytes = 0;
  unsigned char *png = (unsigned char *)read_whole(in_scratch("out/full.png"), &bytes);
  assert_true(bytes > 1000 && memcmp(png, "\211PNG", 4) == 0);
  assert_int_equal(big_endian(png + 16) / 2, (unsigned)width);
  assert_int_equal(big_endian(png + 20) / 2, (unsigned)height);
  free(png);
  text = read_whole(in_scratch("out/full.svg"), NULL);
  check_holds(text, "tension");
  check_holds(text, "</svg>");
  free(text);
}

static void bodies_without_axes_have_a_scale(void **unused) {
  (void)unused;
  cdem_map_lines lines;
  static const struct {
    double size;
    const char *text;
  } known[] = {{1, "'500 mm'"},   {2, "'1 m'"},    {0.031, "'10 mm'"},
               {1500, "'500 m'"}, {4e3, "'2 km'"}, {2e-5, "'10 µm'"}};
  for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
    double scaled[14];
    cdem_map map = small_map(&lines);
    for (int i = 0; i < 14; i++)
      scaled[i] = xy[i] * known[k].size;
    map.xy = scaled;
    map.line_sets = 0;
    map.x_label = NULL;
    char *text = draw("scale", &map, "gp");
    check_holds(text, "unset tics");
    check_holds(text, known[k].text);
    assert_null(strstr(text, "set xtics"));
    free(text);
  }
}

/* Rings of a data file: how many, and the corners of one (its closing point too). */
static int count_rings(const char *text) {
  int rings = 0;
  for (const char *at = strstr(text, "\n\n"); at != NULL; at = strstr(at + 2, "\n\n"))
    rings++;
  return rings;
}

static int read_ring(const char *text, int ring, double (*out)[2], int most) {
  int points = 0;
  text = strchr(text, '\n') + 1;
  for (; ring > 0; ring--)
    text = strstr(text, "\n\n") + 2;
  for (; *text != '\n' && points < most; points++) {
    assert_int_equal(sscanf(text, "%lf %lf", &out[points][0], &out[points][1]), 2);
    text = strchr(text, '\n') + 1;
  }
  return points;
}

static void marks_are_rings(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_map map = {.value_label = "speed", .value_max = 4, .page = 1.5};
  cdem_map_marks *discs, *strokes, *arrows;
  check_ok(cdem_map_add_marks(&map, CDEM_MAP_DISCS, 3, true, true, &discs, &fault));
  check_ok(cdem_map_add_marks(&map, CDEM_MAP_STROKES, 2, false, false, &strokes, &fault));
  check_ok(cdem_map_add_marks(&map, CDEM_MAP_ARROWS, 1, true, false, &arrows, &fault));
  discs = &map.marks[0], strokes = &map.marks[1];
  const double radius[3] = {1, 0.001, 0.5}, x[3] = {1, 3, 5};
  for (int k = 0; k < 3; k++) {
    discs->xy[4 * k] = x[k];
    discs->size[k] = radius[k];
    discs->value[k] = k == 2 ? NAN : 4.0 * k;
    discs->shade[k] = 1.0;
  }
  discs->colour = "#c08040";
  const double way[8] = {0, 2, 4, 2, 1, 1, 1, 1}, arrow[4] = {0, -2, 0, -1};
  memcpy(strokes->xy, way, sizeof way); /* the second has no length */
  strokes->size[0] = 0.2;
  strokes->size[1] = 0.2;
  strokes->colour = "#102030";
  memcpy(arrows->xy, arrow, sizeof arrow);
  arrows->size[0] = 0.05;
  arrows->value[0] = 4;
  char *text = draw("marks", &map, "dat");
  double ring[130][2];
  assert_int_equal(count_rings(text), 6); /* the last one says that there are no polygons */
  int corners = read_ring(text, 0, ring, 130);
  assert_true(corners > 30 && corners < 130); /* nearly a circle ... */
  for (int k = 0; k < corners; k++)
    check_near(hypot(ring[k][0] - 1, ring[k][1]), 1, 1e-5, 0);
  assert_int_equal(read_ring(text, 1, ring, 130), 9); /* ... and a dot of eight sides */
  assert_int_equal(colour_in(text, 0), cdem_palette_colour(false, 0, 1));
  assert_int_equal(colour_in(text, 1), cdem_palette_colour(false, 1, 1));
  assert_int_equal(colour_in(text, 2), 0xc08040);
  assert_int_equal(colour_in(text, 3), 0x102030);
  assert_int_equal(read_ring(text, 3, ring, 130), 5);
  for (int k = 0; k < 4; k++)
    check_near(fabs(ring[k][1] - 2), 0.1, 1e-5, 0);
  assert_int_equal(read_ring(text, 4, ring, 130), 8); /* shaft 0.8 long, head to the tip */
  check_near(ring[3][1], -1, 1e-5, 0);
  check_near(ring[1][1], -1.2, 1e-5, 0);
  check_near(fabs(ring[2][0]), 0.075, 1e-4, 0);
  free(text);
  map.reversed = true;
  discs->rims = true;
  text = draw("reversed", &map, "dat"); /* rims: the two that are large enough, below */
  assert_int_equal(count_rings(text), 8);
  assert_int_equal(colour_in(text, 1), cdem_palette_colour(false, 1, 1));
  free(text);
  text = draw("reversed", &map, "gp");
  double page[2];
  assert_int_equal(
      sscanf(strstr(text, "svg enhanced size"), "svg enhanced size %lf,%lf", &page[0], &page[1]),
      2);
  assert_true(page[0] > 1.5 * 330);
  free(text);
  cdem_map_release(&map);
}

static void nothing_is_drawn_too(void **unused) {
  (void)unused;
  cdem_map empty = {0};
  free(draw("empty", &empty, "gp"));
  assert_int_equal(access(in_scratch("out/empty.png"), F_OK), 0);
  empty.value_label = "none";
  free(draw("empty2", &empty, "gp"));
  cdem_map_lines lines = {NULL, "#000000", 1, 0, NULL};
  empty.lines = &lines;
  empty.line_sets = 1;
  free(draw("empty3", &empty, "gp"));
}

static void failures_are_told(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_map_lines lines;
  cdem_map map = small_map(&lines);
  char *before = strdup(getenv("PATH"));
  setenv("PATH", scratch, 1);
  check_fails(cdem_write_map(in_scratch("out"), "map", &map, &fault), CDEM_FILE,
              "cannot draw 'map': gnuplot was not found; install the package gnuplot-nox");
  setenv("PATH", before, 1);
  free(before);
  check_fails(cdem_write_map(in_scratch("out"), "a/b", &map, &fault), CDEM_USAGE,
              "'a/b' cannot be the name of a figure");
}

/* ---- palettes ---- */

static double linear(unsigned byte) {
  double v = byte / 255.0;
  return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* L* of CIE 1976, from another colour space than the palettes are made in. */
static double lightness(unsigned colour) {
  double y = 0.2126 * linear(colour >> 16) + 0.7152 * linear(colour >> 8 & 255) +
             0.0722 * linear(colour & 255);
  return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

static void palettes_are_even(void **unused) {
  (void)unused;
  double total =
      lightness(cdem_palette_colour(false, 1, 1)) - lightness(cdem_palette_colour(false, 0, 1));
  assert_true(total > 65);
  for (int i = 0; i < 20; i++) {
    double step = lightness(cdem_palette_colour(false, (i + 1) / 20.0, 1)) -
                  lightness(cdem_palette_colour(false, i / 20.0, 1));
    check_near(step, total / 20, 0.35, 0); /* the two spaces differ by some hue */
    double left = lightness(cdem_palette_colour(true, 0.5 - i / 40.0, 1));
    double right = lightness(cdem_palette_colour(true, 0.5 + i / 40.0, 1));
    check_near(left, right, 0, 4);
    assert_true(i == 0 || lightness(cdem_palette_colour(true, 0.5 - (i - 1) / 40.0, 1)) > left);
  }
  unsigned middle = cdem_palette_colour(true, 0.5, 1), blue = cdem_palette_colour(true, 0, 1),
           red = cdem_palette_colour(true, 1, 1);
  assert_true((middle >> 16) == (middle & 255)); /* without a hue */
  assert_true((blue & 255) > 2 * (blue >> 16) && (red >> 16) > 2 * (red & 255));
  assert_int_equal(cdem_palette_colour(false, NAN, 1), 0xcccccc);
  assert_int_equal(cdem_palette_colour(false, -1, 1), cdem_palette_colour(false, 0, 1));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(data_has_every_polygon),
      cmocka_unit_test(colours_follow_value_and_shade),
      cmocka_unit_test(outlines_are_below_smaller_polygons),
      cmocka_unit_test(scripts_say_what_is_drawn),
      cmocka_unit_test(bodies_without_axes_have_a_scale),
      cmocka_unit_test(marks_are_rings),
      cmocka_unit_test(nothing_is_drawn_too),
      cmocka_unit_test(failures_are_told),
      cmocka_unit_test(palettes_are_even),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
