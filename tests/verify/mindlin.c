/* The contact laws of elastic spheres against the theory of Maw, Barber & Fawcett: Chung & Ooi's
 * oblique impacts without normal losses, over all incidences that stick, slip in part and slide. */
#include "dem/law_impact.h"
#include "verify/maw.h"

typedef struct {
  double worst, mean;
} distance;

/* In units of mu v_n, slips being up to 2. */
static distance from_theory(const char *law, const cdem_grain_material *m, double radius,
                            double friction, double normal) {
  distance d = {0.0, 0.0};
  for (int i = 0; i < 12; i++) {
    double x = 0.3 + 0.6 * i;
    const double in[3] = {normal, x * friction * normal, 0.0};
    rebound r = oblique(law, m, radius, 1.0, friction, 0.0, in);
    double off = fabs(r.slip / (friction * normal) - cdem_maw_rebound(m->poisson, 0.4, x));
    d.worst = fmax(d.worst, off);
    d.mean += off / 12.0;
  }
  return d;
}

static void micro_slip_follows_the_theory(void **state) {
  (void)state;
  static const struct {
    cdem_grain_material material;
    double radius, friction, normal;
  } cases[] = {{{"steel", 7850.0, 208e9, 0.3}, 1e-5, 0.3, 0.5},
               {{"polyethylene", 1000.0, 1e9, 0.3}, 1e-5, 0.3, 0.5},
               {{"aluminium alloy", 2700.0, 70e9, 0.33}, 0.1, 0.4, 0.2},
               {{"nylon", 1000.0, 2.5e9, 0.4}, 0.1, 0.4, 0.2}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    distance slips = from_theory("mindlin", &cases[c].material, cases[c].radius, cases[c].friction,
                                 cases[c].normal);
    distance sticks = from_theory("hertz", &cases[c].material, cases[c].radius, cases[c].friction,
                                  cases[c].normal);
    if (getenv("LAW_TALK"))
      printf("%s: mindlin %.3f %.3f, hertz %.3f %.3f\n", cases[c].material.name, slips.worst,
             slips.mean, sticks.worst, sticks.mean);
    check_below(slips.worst, 0.07);
    check_below(slips.mean, 0.03);
    assert_true(sticks.worst > 5.0 * slips.worst && sticks.mean > 8.0 * slips.mean);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(micro_slip_follows_the_theory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
