/* Bands of strain: direction and slenderness of strips made by hand, of discs, and of too few. */
#include "measures_support.h"

enum { SIDE = 61, MOST = SIDE * SIDE };

typedef struct {
  double xyz[3 * MOST], strain[MOST];
} field;

/* Grains of a fine lattice turned by `turn`, shuffled; strained by 1 where a strip of length l and
 * width w along `angle` through the origin is, by at most 0.4 elsewhere. */
static void make_strip(field *f, double turn, double angle, double l, double w) {
  cdem_random random = {7};
  for (int i = 0; i < MOST; i++) {
    int k = (int)((int64_t)i * 997 % MOST); /* in no order */
    double a = 0.05 * (k % SIDE - SIDE / 2), b = 0.05 * ((double)k / SIDE - SIDE / 2);
    double x = cos(turn) * a - sin(turn) * b, y = sin(turn) * a + cos(turn) * b;
    double along = cos(angle) * x + sin(angle) * y, across = cos(angle) * y - sin(angle) * x;
    bool in = fabs(along) <= 0.5 * l && fabs(across) <= 0.5 * w;
    f->xyz[3 * i] = x;
    f->xyz[3 * i + 1] = y;
    f->xyz[3 * i + 2] = 0.0;
    f->strain[i] = in ? 1.0 : cdem_random_uniform(&random, 0.0, 0.4);
  }
}

static void strips_have_their_direction(void **unused) {
  (void)unused;
  static field f;
  for (double angle = -1.5; angle < 1.55; angle += 0.25)
    for (double turn = 0.0; turn < 0.8; turn += 0.37) {
      cdem_band band;
      make_strip(&f, turn, angle, 2.0, 0.3);
      f.strain[4] = NAN; /* a grain whose neighbours have left */
      cdem_band_find(MOST, f.xyz, f.strain, NULL, &band);
      /* 1/20 of a unit between grains: the ends of a strip are that ragged */
      check_near(band.angle, angle, 0, 0.02);
      check_near(band.slenderness, 2.0 / 0.3, 0.12, 0);
      assert_true(band.largest == 1.0 && band.grains > 100);
      check_near(hypot(band.center[0], band.center[1]), 0, 0, 0.05);
    }
}

/* The strain outside does not count, however large: half of a V is one band. */
static void regions_part_bands(void **unused) {
  (void)unused;
  static field f;
  const cdem_region left = {.low = {-9, -9}, .high = {0, 9}},
                    right = {.low = {0, -9}, .high = {9, 9}};
  cdem_band band;
  make_strip(&f, 0.1, 0.0, 0.0, 0.0);
  for (int i = 0; i < MOST; i++) {
    double x = f.xyz[3 * i], y = f.xyz[3 * i + 1];
    if (fabs(y + 0.7 - fabs(x)) < 0.1 && fabs(x) < 0.9)
      f.strain[i] = x < 0.0 ? 1.0 : 3.0;
  }
  cdem_band_find(MOST, f.xyz, f.strain, &left, &band);
  check_near(band.angle, -0.25 * 3.14159265358979323846, 0, 0.03);
  assert_true(band.largest == 1.0 && band.slenderness > 5.0);
  cdem_band_find(MOST, f.xyz, f.strain, &right, &band);
  check_near(band.angle, 0.25 * 3.14159265358979323846, 0, 0.03);
  assert_true(band.largest == 3.0 && band.slenderness > 5.0);
  cdem_band_find(MOST, f.xyz, f.strain, NULL, &band); /* only the stronger one is above half */
  check_near(band.angle, 0.25 * 3.14159265358979323846, 0, 0.03);
}

static void a_heap_of_strain_is_no_band(void **unused) {
  (void)unused;
  static field f;
  cdem_band band;
  make_strip(&f, 0.3, 0.0, 0.0, 0.0);
  for (int i = 0; i < MOST; i++)
    if (hypot(f.xyz[3 * i], f.xyz[3 * i + 1]) < 0.8)
      f.strain[i] = 1.0;
  cdem_band_find(MOST, f.xyz, f.strain, NULL, &band);
  check_near(band.slenderness, 1.0, 0.03, 0);
  for (int i = 0; i < MOST; i++) /* ... nor is a wedge below a plate */
    f.strain[i] = f.xyz[3 * i + 1] > fabs(f.xyz[3 * i]) - 1.0 && f.xyz[3 * i + 1] < 0.0;
  cdem_band_find(MOST, f.xyz, f.strain, NULL, &band);
  assert_true(band.slenderness < 2.0);
}

static void few_grains_have_no_direction(void **unused) {
  (void)unused;
  const double xyz[12] = {0, 0, 0, 1, 1, 0, 2, 2, 0, 3, 3, 0}, nan4[4] = {NAN, NAN, NAN, NAN};
  const double two[4] = {1, 1, 0.2, NAN}, line[4] = {1, 1, 1, 1};
  const cdem_region away = {.low = {8, 8}, .high = {9, 9}};
  cdem_band band;
  cdem_band_find(4, xyz, two, NULL, &band);
  assert_true(band.grains == 2 && isnan(band.angle) && isnan(band.slenderness));
  cdem_band_find(4, xyz, nan4, NULL, &band);
  assert_true(band.grains == 0 && isnan(band.largest) && isnan(band.center[0]));
  cdem_band_find(4, xyz, line, &away, &band);
  assert_true(band.grains == 0 && isnan(band.angle));
  cdem_band_find(4, xyz, line, NULL, &band);
  assert_true(band.grains == 4 && isinf(band.slenderness));
  check_near(band.angle, 0.25 * 3.14159265358979323846, 1e-12, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(strips_have_their_direction),
      cmocka_unit_test(regions_part_bands),
      cmocka_unit_test(a_heap_of_strain_is_no_band),
      cmocka_unit_test(few_grains_have_no_direction),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
