/* Room bsm: sub-cycles over many steps. Energy, momentum, and the longest step that is let through.
 */
#include "bsm/coupling_support.h"

enum { STEPS = 300 };

/* m = 4: by the path of interface grains at the velocity of the step energy stays near what it was;
 * the momentum of both at one time is kept to the error of a trapezoid in the force between them,
 * which does not grow. */
static void four_cycles(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    pair p;
    pair_options o = pair_chosen(k & 1, 4);
    double energy, momentum, later, drift;
    cdem_energy_book body;
    o.cosserat = k & 2;
    pair_make(&o, &p);
    pair_start(&p);
    pair_watch(&p, STEPS, &energy, &momentum);
    check_below(energy, 1e-3);
    check_below(momentum, 0.05);
    pair_watch(&p, STEPS, &later, &drift);
    check_below(later, 1.5e-3);
    check_below(drift, 0.05);
    cdem_solver_energies(&p.solver, &body);
    check_near(p.coupling.work, body.load, 1e-12, 0.0);
    pair_release(&p);
  }
}

/* The path with the acceleration of eqs (25-26): as good over short times. */
static void accelerated_path(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    pair p;
    pair_options o = pair_chosen(k & 1, 4);
    double energy, momentum;
    o.way = CDEM_BSM_ACCELERATION;
    pair_make(&o, &p);
    pair_start(&p);
    pair_watch(&p, STEPS, &energy, &momentum);
    check_below(energy, 2e-3);
    check_below(momentum, 0.05);
    pair_release(&p);
  }
}

/* Virtual work: contacts of fine grains act on nodes with both sides, so that the nodes, those of
 * the fine region with their lumped masses included, keep their momentum to rounding. */
static void virtual_work_momentum(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    pair p;
    pair_options o = pair_chosen(true, k & 1 ? 4 : 1);
    double body[2], fine[2], first[2], start;
    o.form = CDEM_BSM_VIRTUAL_WORK;
    o.cosserat = k & 2;
    pair_make(&o, &p);
    pair_start(&p);
    pair_momentum(&p, first, fine);
    start = pair_energy(&p);
    for (int n = 0; n < STEPS; n++) {
      pair_run(&p, 1);
      pair_momentum(&p, body, fine);
      for (int c = 0; c < 2; c++)
        check_near(body[c], first[c], 0.0, 1e-10);
      check_below(pair_energy(&p), 2.0 * start);
    }
    pair_release(&p);
  }
}

/* Steps just below the longest that is let through, whatever m, with a body as heavy as the grains
 * and a much lighter one, whose step the grains' springs limit: nothing grows in 2000 steps without
 * any damping. */
static void longest_step(void **state) {
  (void)state;
  const int cycles[2] = {3, 8};
  double worst = 0.0;
  for (int k = 0; k < 8; k++) {
    pair p;
    pair_options o = pair_chosen(k & 1, cycles[k / 4]);
    double energy, momentum;
    o.part = 0.999;
    o.density = k & 2 ? 0.03 : 1.0;
    pair_make(&o, &p);
    pair_start(&p);
    pair_watch(&p, 2000, &energy, &momentum);
    worst = fmax(worst, energy);
    pair_release(&p);
  }
  check_below(worst, 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(four_cycles),
      cmocka_unit_test(accelerated_path),
      cmocka_unit_test(virtual_work_momentum),
      cmocka_unit_test(longest_step),
  };
  return cmocka_run_group_tests_name("bsm coupling_slow", tests, NULL, NULL);
}
