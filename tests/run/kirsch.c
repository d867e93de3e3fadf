/* Kirsch's solution: free hole, tension far away, equilibrium, the factor of three. */
#include "run/kirsch.h"

#include "support/test.h"

static void the_hole_is_free(void **state) {
  (void)state;
  for (int i = 0; i < 12; i++) {
    double t = 0.5 * i + 0.1, a = 0.7, n[2] = {cos(t), sin(t)}, s[3];
    cdem_run_kirsch(2.0, a, a * n[0], a * n[1], s);
    check_near(s[0] * n[0] + s[2] * n[1], 0.0, 0.0, 1e-14);
    check_near(s[2] * n[0] + s[1] * n[1], 0.0, 0.0, 1e-14);
  }
}

static void the_crown_carries_three_times_the_tension(void **state) {
  (void)state;
  double s[3];
  cdem_run_kirsch(1.0, 1.0, 0.0, 1.0, s);
  check_near(s[0], 3.0, 1e-14, 0.0);
  cdem_run_kirsch(1.0, 1.0, 1.0, 0.0, s);
  check_near(s[1], -1.0, 1e-14, 0.0);
}

static void far_away_there_is_tension_along_x(void **state) {
  (void)state;
  double s[3];
  cdem_run_kirsch(5.0, 1.0, 3e7, 4e7, s);
  check_near(s[0], 5.0, 1e-12, 0.0);
  check_near(s[1], 0.0, 0.0, 1e-12);
  check_near(s[2], 0.0, 0.0, 1e-12);
}

/* Central differences of step h leave h^2/6 times third derivatives, here below 1e-6. */
static void forces_balance_everywhere(void **state) {
  (void)state;
  const double h = 1e-4;
  for (int i = 0; i < 20; i++) {
    double r = 1.1 + 0.2 * i, t = 0.37 * i, x = r * cos(t), y = r * sin(t);
    double east[3], west[3], north[3], south[3];
    cdem_run_kirsch(1.0, 1.0, x + h, y, east);
    cdem_run_kirsch(1.0, 1.0, x - h, y, west);
    cdem_run_kirsch(1.0, 1.0, x, y + h, north);
    cdem_run_kirsch(1.0, 1.0, x, y - h, south);
    check_near((east[0] - west[0] + north[2] - south[2]) / (2 * h), 0.0, 0.0, 1e-6);
    check_near((east[2] - west[2] + north[1] - south[1]) / (2 * h), 0.0, 0.0, 1e-6);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_hole_is_free),
      cmocka_unit_test(the_crown_carries_three_times_the_tension),
      cmocka_unit_test(far_away_there_is_tension_along_x),
      cmocka_unit_test(forces_balance_everywhere),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
