/* The solver while things break: momentum, book, threads, restarts. */
#include "joints_support.h"

/* A bar torn apart by its own motion: all cracks run, pieces fly and meet. */
static void start_burst(cdem_insertion insertion, bool solid, int threads, jointed *j,
                        double **velocity) {
  rig_options o = solid ? rig_cube(2) : rig_square(5, 4);
  o.threads = threads;
  make_jointed(&o, glue(insertion, 1e6), true, j);
  int dofs = j->r.body.dofs;
  *velocity = calloc((size_t)(dofs * j->r.body.nodes), sizeof **velocity);
  for (int32_t n = 0; n < j->r.body.nodes; n++) {
    const double *x = j->r.blocks.mesh.xyz + 3 * n;
    (*velocity)[dofs * n] = 12.0 * (x[0] - 0.4) * fabs(x[0] - 0.4);
    (*velocity)[dofs * n + 1] = -6.0 * x[0] * (x[1] - 0.3);
  }
  j->r.options.velocity = *velocity;
  rig_start(&j->r);
}

static void breaking_keeps_momentum_and_book(void **state) {
  (void)state;
  for (int variant = 0; variant < 4; variant++) {
    jointed j;
    double *velocity, p0[3], l0[3], p[3], l[3];
    start_burst(variant % 2 ? CDEM_INSERTION_TIED : CDEM_INSERTION_PENALTY, variant / 2, 1, &j,
                &velocity);
    cdem_solver_momentum(&j.r.solver, p0, l0);
    double scale = 0.0;
    for (int32_t n = 0; n < j.r.body.nodes; n++)
      scale += j.r.body.mass[j.r.body.dofs * n] * fabs(velocity[j.r.body.dofs * n]);
    rig_run(&j.r, 1500);
    cdem_solver_momentum(&j.r.solver, p, l);
    cdem_interfaces_totals totals;
    cdem_interfaces_sum(&j.interfaces, &totals);
    assert_true(totals.cracks > 0);
    for (int k = 0; k < 3; k++) {
      check_near(p[k], p0[k], 0.0, 1e-11 * scale);
      check_near(l[k], l0[k], 0.0, 1e-10 * scale);
    }
    cdem_energy_book book;
    cdem_solver_energies(&j.r.solver, &book);
    /* Contact adds nothing (test cdem.contact_energy); broken springs that close within a step of
     * 0.8 of the limit cost a little, either way. */
    check_below(fabs(book.error), 1e-2 * book.exchange);
    release_jointed(&j);
    free(velocity);
  }
}

static void same(const cdem_solver *a, const cdem_solver *b) {
  size_t size = (size_t)a->nodes * (size_t)a->dofs * sizeof(double);
  assert_memory_equal(a->u, b->u, size);
  assert_memory_equal(a->v, b->v, size);
  assert_memory_equal(a->force, b->force, size);
  assert_true(a->time == b->time && a->step == b->step);
}

/* Threads, and a restart in the middle of breaking: the same bits. */
static void bits_of_breaking(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int variant = 0; variant < 2; variant++) {
    jointed one, two, again;
    double *velocity[3];
    cdem_insertion insertion = variant ? CDEM_INSERTION_TIED : CDEM_INSERTION_PENALTY;
    start_burst(insertion, false, 1, &one, &velocity[0]);
    start_burst(insertion, false, 2, &two, &velocity[1]);
    start_burst(insertion, false, 2, &again, &velocity[2]);
    rig_run(&one.r, 300);
    rig_run(&two.r, 300);
    same(&one.r.solver, &two.r.solver);
    cdem_state saved = {0};
    check_ok(cdem_solver_save(&two.r.solver, &saved, &fault));
    check_ok(cdem_solver_restore(&again.r.solver, &saved, &fault));
    cdem_state_release(&saved);
    rig_run(&one.r, 300);
    rig_run(&two.r, 300);
    rig_run(&again.r, 300);
    same(&one.r.solver, &two.r.solver);
    same(&two.r.solver, &again.r.solver);
    cdem_energy_book a, b;
    cdem_solver_energies(&one.r.solver, &a);
    cdem_solver_energies(&again.r.solver, &b);
    a.exchange = b.exchange = 0.0; /* seen at the reports of each */
    assert_memory_equal(&a, &b, sizeof a);
    release_jointed(&one);
    release_jointed(&two);
    release_jointed(&again);
    for (int k = 0; k < 3; k++)
      free(velocity[k]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(breaking_keeps_momentum_and_book),
      cmocka_unit_test(bits_of_breaking),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
