/* Room verify: the references of the group dem, checked without the solver: the theory of oblique
 * impact against its limits, and the series against the tables in data/reference. */
#include "support/test.h"
#include "verify/dem_series.h"
#include "verify/maw.h"

/* Steep incidence slides to the end: v - 7 for a solid sphere, v - 2 (1 + 1/k) for I = k m r^2. */
static void sliding_is_closed(void **state) {
  (void)state;
  for (int i = 0; i < 4; i++) {
    check_near(cdem_maw_rebound(0.3, 0.4, 7.0 + i), i, 0, 1e-3);
    check_near(cdem_maw_rebound(0.0, 0.5, 6.5 + i), 0.5 + i, 0, 1e-3);
  }
}

/* Left is right; without incidence nothing happens; a steep fall barely slides. */
static void theory_has_its_symmetry(void **state) {
  (void)state;
  for (int i = 0; i < 10; i++) {
    double x = 0.9 * i, y = cdem_maw_rebound(0.2, 0.4, x);
    check_near(cdem_maw_rebound(0.2, 0.4, -x), -y, 0, 1e-12);
    assert_true(fabs(y) <= fmax(x, 1e-12)); /* no energy is made */
  }
}

/* Sticking in the middle makes the contact point come back: Maw et al. find that for incidences
 * between about 1 and 7 of a solid sphere; finite elements (digitised, read to about 0.05) agree
 * from 1.9 on, and below they lie up to 0.15 lower. */
static void theory_agrees_with_finite_elements(void **state) {
  (void)state;
  for (int i = 0; i < CDEM_CHUNG_OOI_5_ELEMENTS; i++) {
    const double *row = cdem_chung_ooi_5_elements[i];
    double y = cdem_maw_rebound(0.3, 0.4, row[0]);
    check_near(y, row[1], 0, row[0] < 1.5 ? 0.16 : 0.06);
  }
  assert_true(cdem_maw_rebound(0.3, 0.4, 3.0) < -1.0);
}

static void check_series(const char *name, int rows, int columns, const double *series) {
  char path[256], line[256];
  snprintf(path, sizeof path, "%s/reference/chung-ooi-%s.csv", CDEM_DATA, name);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  assert_non_null(fgets(line, sizeof line, file));
  for (int i = 0; i < rows; i++) {
    assert_non_null(fgets(line, sizeof line, file));
    char *at = line;
    for (int k = 0; k < columns; k++) {
      char *end;
      assert_true(strtod(at, &end) == series[i * columns + k]);
      at = end + 1;
    }
  }
  assert_null(fgets(line, sizeof line, file));
  fclose(file);
}

static void series_are_the_tables(void **state) {
  (void)state;
  check_series("4", CDEM_CHUNG_OOI_4, 4, &cdem_chung_ooi_4[0][0]);
  check_series("5-steel", CDEM_CHUNG_OOI_5, 3, &cdem_chung_ooi_5[0][0]);
  check_series("5-elements", CDEM_CHUNG_OOI_5_ELEMENTS, 2, &cdem_chung_ooi_5_elements[0][0]);
  check_series("6-beta", CDEM_CHUNG_OOI_6, 2, &cdem_chung_ooi_6[0][0]);
  check_series("6-recoil", CDEM_CHUNG_OOI_6_RECOIL, 2, &cdem_chung_ooi_6_recoil[0][0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sliding_is_closed),
      cmocka_unit_test(theory_has_its_symmetry),
      cmocka_unit_test(theory_agrees_with_finite_elements),
      cmocka_unit_test(series_are_the_tables),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
