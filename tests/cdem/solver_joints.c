/* The solver with interfaces: ties, statics, loose blocks. */
#include "joints_support.h"

/* Tied with a strength that is not reached: the motion and the reactions of the uncut body. */
static void tied_body_moves_as_the_uncut_one(void **state) {
  (void)state;
  for (int solid = 0; solid < 2; solid++) {
    rig_options o = solid ? rig_cube(2) : rig_square(4, 3);
    rig whole;
    jointed cut;
    rig_make(&o, &whole);
    make_jointed(&o, glue(CDEM_INSERTION_TIED, 1e12), false, &cut);
    cdem_support a = hold(&whole, "x0", 0, false, sine(1e-4, 200.0));
    cdem_support b = hold(&cut.r, "x0", 0, false, sine(1e-4, 200.0));
    rig *each[2] = {&whole, &cut.r};
    for (int k = 0; k < 2; k++) {
      each[k]->options.supports = 1;
      each[k]->options.support = k ? &b : &a;
      each[k]->options.gravity[1] = -9.81;
      each[k]->options.mass_damping = 30.0;
      each[k]->options.local_damping = 0.2;
      each[k]->options.step = 2e-5;
      rig_start(each[k]);
      rig_run(each[k], 200);
    }
    assert_true(cut.r.solver.nodes > whole.solver.nodes);
    double largest = 0.0;
    for (int32_t i = 0; i < whole.solver.nodes; i++)
      largest = fmax(largest, fabs(whole.solver.u[i]));
    int dofs = whole.solver.dofs;
    for (int32_t n = 0; n < cut.r.solver.nodes; n++)
      for (int i = 0; i < dofs; i++)
        check_near(cut.r.solver.u[dofs * n + i],
                   whole.solver.u[dofs * cut.r.blocks.original[n] + i], 0.0, 1e-10 * largest);
    check_near(cdem_solver_reaction(&cut.r.solver, 0), cdem_solver_reaction(&whole.solver, 0), 1e-8,
               0.0);
    check_near(cdem_solver_unbalanced(&cut.r.solver), cdem_solver_unbalanced(&whole.solver), 0.5,
               0.0);
    cdem_energy_book book_a = check_book(&whole.solver, 1e-4);
    cdem_energy_book book_b = check_book(&cut.r.solver, 1e-4);
    check_near(book_b.support, book_a.support, 1e-8, 0.0);
    check_near(book_b.damping, book_a.damping, 1e-8, 0.0);
    drop(&a);
    drop(&b);
    rig_release(&whole);
    release_jointed(&cut);
  }
}

/* Statics: tied as uncut; with springs the elongation grows by that of the springs in a row. */
static void static_solution_knows_joints(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig_options o = rig_square(4, 3);
  o.distortion = 0.0;
  o.poisson = 0.0;
  for (int kind = 0; kind < 4; kind++) {
    int tied = kind % 2;
    jointed j;
    o.shape = kind < 2 ? CDEM_SHAPE_QUAD4 : CDEM_SHAPE_TRI3; /* whose corners touch x0 alone */
    make_jointed(&o, glue(tied ? CDEM_INSERTION_TIED : CDEM_INSERTION_PENALTY, 1e12), false, &j);
    cdem_support support[2] = {hold(&j.r, "x0", 0, false, constant(0.0)),
                               hold(&j.r, "y0", 1, false, constant(0.0))};
    int32_t *facet;
    cdem_pressure pull = {.name = "x1", .series = constant(-1e6)};
    check_ok(cdem_blocks_group_facets(&j.r.blocks, "x1", &pull.facets, &facet, &fault));
    pull.facet = facet;
    j.r.options.supports = 2;
    j.r.options.support = support;
    j.r.options.pressures = 1;
    j.r.options.pressure = &pull;
    rig_start(&j.r);
    check_ok(cdem_solver_static(&j.r.solver, 0.0, &fault));
    double expected = 1e6 * (o.size[0] / o.young + (tied ? 0.0 : 3.0 / j.law.kn));
    for (int32_t n = 0; n < j.r.body.nodes; n++)
      if (j.r.blocks.mesh.xyz[3 * n] > 0.99 && (kind < 2 || tied))
        check_near(j.r.solver.u[2 * n], expected, 1e-10, 0.0);
    double pulled = -1e6 * o.size[1] * o.thickness, held[3];
    check_near(cdem_solver_reaction(&j.r.solver, 0), pulled, 1e-10, 0.0);
    cdem_solver_held(&j.r.solver, support[0].nodes, support[0].node, held);
    check_near(held[0], pulled, 1e-10, 0.0);
    cdem_solver_held(&j.r.solver, support[1].nodes, support[1].node, held);
    check_near(held[1], 0.0, 0.0, 1e-10 * fabs(pulled));
    cdem_series_release(&pull.series);
    drop(&support[0]);
    drop(&support[1]);
    free(facet);
    release_jointed(&j);
  }
}

static void loose_blocks_are_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig_options o = rig_square(2, 1);
  jointed j;
  make_jointed(&o, glue(CDEM_INSERTION_PENALTY, 1e12), true, &j);
  rig_start(&j.r);
  check_fails(cdem_solver_static(&j.r.solver, 0.0, &fault), CDEM_INPUT, "knows no contact");
  cdem_solver_release(&j.r.solver);
  j.r.options.contact = NULL;
  j.r.options.interfaces = NULL; /* nothing holds them together */
  rig_start(&j.r);
  check_fails(cdem_solver_static(&j.r.solver, 0.0, &fault), CDEM_INPUT,
              "block 0 (with node 1) can move along x, y and turn about z freely");
  release_jointed(&j);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tied_body_moves_as_the_uncut_one),
      cmocka_unit_test(static_solution_knows_joints),
      cmocka_unit_test(loose_blocks_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
