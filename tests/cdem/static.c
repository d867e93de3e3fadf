/* The static solution, what it refuses, and the relaxation that must end in it. */
#include "base/mat3.h"
#include "solver_support.h"

/* Displacements linear in the place on the whole surface: linear inside too, whatever the mesh. */
static void patch_test_is_exact(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int solid = 0; solid < 2; solid++) {
    rig r;
    rig_options o = solid ? rig_cube(3) : rig_square(4, 4);
    rig_make(&o, &r);
    const cdem_mesh *mesh = &r.blocks.mesh;
    int dim = solid ? 3 : 2;
    const double gradient[3][3] = {{2e-4, 1e-4, -3e-4}, {5e-5, -1e-4, 2e-4}, {1e-4, 3e-4, 4e-4}};
    bool *surface = calloc((size_t)mesh->nodes, sizeof *surface);
    for (int32_t f = 0; f < r.blocks.facets; f++)
      for (int c = 0; c < r.blocks.facet[f].corners; c++)
        surface[r.blocks.facet[f].node[c]] = true;
    cdem_support *support = calloc((size_t)(dim * mesh->nodes), sizeof *support);
    int32_t *node = calloc((size_t)mesh->nodes, sizeof *node);
    for (int32_t n = 0; n < mesh->nodes; n++) {
      node[n] = n;
      for (int c = 0; c < dim && surface[n]; c++)
        support[r.options.supports++] =
            (cdem_support){.name = "surface",
                           .component = c,
                           .series = constant(cdem_dot3(gradient[c], mesh->xyz + 3 * n)),
                           .nodes = 1,
                           .node = node + n};
    }
    r.options.support = support;
    rig_start(&r);
    check_ok(cdem_solver_static(&r.solver, 0.0, &fault));
    for (int32_t n = 0; n < mesh->nodes; n++)
      for (int c = 0; c < dim; c++)
        check_near(r.solver.u[dim * n + c], cdem_dot3(gradient[c], mesh->xyz + 3 * n), 0.0,
                   1e-12 * 1e-3);
    for (int k = 0; k < r.options.supports; k++)
      cdem_series_release(&support[k].series);
    rig_release(&r);
    free(support);
    free(node);
    free(surface);
  }
}

/* Hold a side, load the others: reactions balance the loads, the rest is in equilibrium. */
typedef struct {
  cdem_support support[3];
  cdem_pressure pressure;
  int32_t *facet;
} loading;

static void load_block(rig *r, loading *l, const char *side) {
  cdem_fault fault = {0};
  int dofs = r->body.dofs;
  for (int k = 0; k < dofs; k++)
    l->support[k] = hold(r, "y0", k, false, constant(k == 0 ? 1e-4 : 0.0));
  l->pressure = (cdem_pressure){.name = side, .series = constant(2e5)};
  check_ok(cdem_blocks_group_facets(&r->blocks, side, &l->pressure.facets, &l->facet, &fault));
  l->pressure.facet = l->facet;
  r->options.supports = dofs;
  r->options.support = l->support;
  r->options.pressures = 1;
  r->options.pressure = &l->pressure;
  r->options.gravity[1] = -9.81;
}

static void unload_block(rig *r, loading *l) {
  for (int k = 0; k < r->options.supports; k++)
    drop(&l->support[k]);
  cdem_series_release(&l->pressure.series);
  free(l->facet);
}

static void static_forces_balance(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  loading l;
  rig_options o = rig_cube(4);
  rig_make(&o, &r);
  load_block(&r, &l, "x1");
  rig_start(&r);
  check_ok(cdem_solver_static(&r.solver, 0.0, &fault));
  double push = 2e5 * o.size[1] * o.size[2];
  double weight = 9.81 * o.density * o.size[0] * o.size[1] * o.size[2];
  check_near(cdem_solver_reaction(&r.solver, 0), push, 1e-11, 0.0);
  check_near(cdem_solver_reaction(&r.solver, 1), weight, 1e-11, 0.0);
  check_near(cdem_solver_reaction(&r.solver, 2), 0.0, 0.0, 1e-11 * push);
  check_below(cdem_solver_unbalanced(&r.solver), 1e-12);
  cdem_energy_book book;
  cdem_solver_energies(&r.solver, &book);
  assert_true(book.elastic > 0.0 && book.kinetic == 0.0);
  unload_block(&r, &l);
  rig_release(&r);
}

/* A relaxation with local damping ends in the static solution. The pressure is small: in a
 * relaxation it follows the surface, in a static solution it stays on the reference. */
static void relaxation_ends_in_the_static_solution(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int solid = 0; solid < 2; solid++) {
    rig r[2];
    loading l[2];
    for (int relax = 0; relax < 2; relax++) {
      rig_options o = solid ? rig_cube(3) : rig_square(6, 6);
      o.linear = true;
      rig_make(&o, &r[relax]);
      load_block(&r[relax], &l[relax], "x1");
      l[relax].pressure.series.value[0] = 2.0;
      l[relax].support[0].series.value[0] = 0.0;
      r[relax].options.gravity[1] = -1e-4;
      r[relax].options.fictitious_mass = relax;
      r[relax].options.local_damping = 0.8;
      rig_start(&r[relax]);
    }
    check_ok(cdem_solver_static(&r[0].solver, 0.0, &fault));
    int steps = 0;
    for (; cdem_solver_unbalanced(&r[1].solver) > 1e-9 && steps < 20000; steps += 100)
      rig_run(&r[1], 100);
    check_below(steps, 3000);
    double largest = 0.0;
    for (int32_t i = 0; i < r[0].solver.nodes * r[0].solver.dofs; i++)
      largest = fmax(largest, fabs(r[0].solver.u[i]));
    for (int32_t i = 0; i < r[0].solver.nodes * r[0].solver.dofs; i++)
      check_near(r[1].solver.u[i], r[0].solver.u[i], 0.0, 1e-6 * largest);
    check_book(&r[1].solver, 1e-6); /* the turning of the pressure with the surface */
    for (int k = 0; k < 2; k++) {
      unload_block(&r[k], &l[k]);
      rig_release(&r[k]);
    }
  }
}

/* ---- what it refuses ---- */

static void check_free(rig *r, int supports, const char *text) {
  cdem_fault fault = {0};
  r->options.supports = supports;
  rig_start(r);
  check_fails(cdem_solver_static(&r->solver, 0.0, &fault), CDEM_INPUT, text);
  cdem_solver_release(&r->solver);
}

static void missing_supports_are_named(void **state) {
  (void)state;
  rig r;
  rig_options o = rig_cube(2);
  rig_make(&o, &r);
  int32_t corner = 0;
  cdem_support support[3] = {hold(&r, "z0", 2, false, constant(0.0)),
                             hold(&r, "x0", 0, false, constant(0.0)),
                             {.name = "corner", .component = 1, .nodes = 1, .node = &corner}};
  r.options.support = support;
  check_free(&r, 0, "the body can move along x, y, z and turn about x, y, z freely");
  check_free(&r, 1, "the body can move along x, y and turn about z freely");
  check_free(&r, 2, "the body can move along y freely");
  cdem_fault fault = {0};
  r.options.supports = 3;
  rig_start(&r);
  check_ok(cdem_solver_static(&r.solver, 0.0, &fault));
  rig_release(&r);
  drop(&support[0]);
  drop(&support[1]);
  o = rig_square(2, 2);
  rig_make(&o, &r);
  cdem_support pin[2] = {{.name = "pin", .component = 0, .nodes = 1, .node = &corner},
                         {.name = "pin", .component = 1, .nodes = 1, .node = &corner}};
  r.options.support = pin;
  check_free(&r, 2, "the body can turn about z freely; a static solution needs supports");
  rig_release(&r);
}

static void plates_and_contact_are_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_square(2, 2);
  rig_make(&o, &r);
  cdem_plate plate = {.name = "lid", .normal = {0, -1, 0}, .point = {0, 2, 0}, .kn = 1e9};
  r.options.plates = 1;
  r.options.plate = &plate;
  rig_start(&r);
  check_fails(cdem_solver_static(&r.solver, 0.0, &fault), CDEM_INPUT, "knows no plates");
  rig_release(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(patch_test_is_exact),
      cmocka_unit_test(static_forces_balance),
      cmocka_unit_test(relaxation_ends_in_the_static_solution),
      cmocka_unit_test(missing_supports_are_named),
      cmocka_unit_test(plates_and_contact_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
