/* Motion in time: closed forms, the energy book, prescribed paths, threads, restarts. */
#include "base/mat3.h"
#include "cdem/solver_store.h"
#include "solver_support.h"

static const double pi = 3.14159265358979323846;

/* One element between two walls of rollers, its right side free to move along x: a mass on a
 * spring, k = E A/L, m = rho A L/2. The leapfrog's own solution is u_n = v_0 dt sin(n W)/sin W with
 * sin(W/2) = omega dt/2. */
static void oscillator_has_its_frequency(void **state) {
  (void)state;
  rig r;
  rig_options o = rig_square(1, 1);
  o.distortion = 0.0;
  o.poisson = 0.0;
  o.plane = CDEM_PLANE_STRESS;
  o.linear = true;
  rig_make(&o, &r);
  cdem_support support[2] = {hold(&r, "x0", 0, false, constant(0.0)),
                             hold(&r, "body", 1, false, constant(0.0))};
  double velocity[8] = {0}, v0 = 0.01;
  for (int n = 0; n < 4; n++)
    if (r.blocks.mesh.xyz[3 * n] > 0.5)
      velocity[2 * n] = v0;
  r.options.supports = 2;
  r.options.support = support;
  r.options.velocity = velocity;
  rig_start(&r);
  double omega = sqrt(o.young / (o.density / 2.0)) / o.size[0];
  double dt = r.solver.step, angle = 2.0 * asin(omega * dt / 2.0);
  check_below(dt * omega, 2.0);
  for (int step = 1; step <= 200; step++) {
    rig_run(&r, 1);
    for (int n = 0; n < 4; n++)
      if (velocity[2 * n] > 0.0)
        check_near(r.solver.u[2 * n], v0 * dt * sin(step * angle) / sin(angle), 0.0,
                   1e-12 * v0 / omega);
  }
  check_book(&r.solver, 1e-13);
  rig_release(&r);
  drop(&support[0]);
  drop(&support[1]);
}

/* Mass damping: u decays as exp(-a t/2) to second order in the step; the leapfrog's own decay of
 * the amplitude is sqrt((1 - a dt/2)/(1 + a dt/2)) a step, exactly. */
static void mass_damping_decays(void **state) {
  (void)state;
  rig r;
  rig_options o = rig_square(1, 1);
  o.distortion = 0.0;
  o.poisson = 0.0;
  o.linear = true;
  rig_make(&o, &r);
  cdem_support support[2] = {hold(&r, "x0", 0, false, constant(0.0)),
                             hold(&r, "body", 1, false, constant(0.0))};
  double velocity[8] = {0};
  int32_t free_node = -1;
  for (int n = 0; n < 4; n++)
    if (r.blocks.mesh.xyz[3 * n] > 0.5)
      velocity[2 * (free_node = n)] = 0.01;
  r.options.supports = 2;
  r.options.support = support;
  r.options.velocity = velocity;
  r.options.mass_damping = 300.0;
  rig_start(&r);
  double half = 300.0 * r.solver.step / 2.0, decay = (1.0 - half) / (1.0 + half);
  double u[3];
  for (int step = 0; step < 3; step++) {
    u[step] = r.solver.u[2 * free_node];
    rig_run(&r, 1);
  }
  /* u_{n+1} = b u_n - decay u_{n-1}: the product of the two roots is the decay in two halves. */
  for (int step = 3; step < 100; step++) {
    double b = (u[2] + decay * u[0]) / u[1];
    double next = r.solver.u[2 * free_node];
    if (fabs(u[1]) > 1e-7)
      check_near(next, b * u[2] - decay * u[1], 1e-9, 1e-14);
    u[0] = u[1];
    u[1] = u[2];
    u[2] = next;
    rig_run(&r, 1);
  }
  cdem_energy_book book = check_book(&r.solver, 1e-13);
  assert_true(book.damping > 0.5 * book.initial);
  rig_release(&r);
  drop(&support[0]);
  drop(&support[1]);
}

/* Everything that can do work at once, on a linear body: the book closes to rounding. */
static void book_closes(const rig_options *o) {
  rig r;
  cdem_fault fault = {0};
  rig_make(o, &r);
  bool solid = o->count[2] > 0;
  int dofs = solid ? 3 : 2;
  cdem_support support[3] = {hold(&r, "x0", 0, false, sine(1e-4, 300.0)),
                             hold(&r, "x0", 1, true, constant(0.05)),
                             hold(&r, "y0", 1, true, constant(0.05))};
  int32_t *facet, *side, facets, sides, nodes;
  int32_t *node;
  check_ok(cdem_blocks_group_facets(&r.blocks, "x1", &facets, &facet, &fault));
  check_ok(cdem_blocks_group_facets(&r.blocks, "y1", &sides, &side, &fault));
  check_ok(cdem_blocks_group_nodes(&r.blocks, "y1", &nodes, &node, &fault));
  double *vector = calloc((size_t)(nodes * dofs), sizeof *vector);
  double *impedance = calloc((size_t)(2 * facets), sizeof *impedance);
  for (int i = 0; i < nodes * dofs; i++)
    vector[i] = 1000.0 + 300.0 * i;
  for (int i = 0; i < facets; i++) {
    impedance[2 * i] = 1.5e6;
    impedance[2 * i + 1] = 0.8e6;
  }
  cdem_load load = {"top", sine(1.0, 200.0), nodes, node, vector};
  cdem_pressure pressure = {"top", sine(2e5, 150.0), sides, side};
  cdem_quiet quiet = {facets, facet, impedance};
  r.options.supports = 3;
  r.options.support = support;
  r.options.loads = 1;
  r.options.load = &load;
  r.options.pressures = 1;
  r.options.pressure = &pressure;
  r.options.quiets = 1;
  r.options.quiet = &quiet;
  r.options.gravity[1] = -9.81;
  r.options.gravity[0] = 3.0;
  r.options.mass_damping = 50.0;
  r.options.local_damping = 0.3;
  rig_start(&r);
  for (int part = 0; part < 4; part++) {
    rig_run(&r, 75);
    cdem_energy_book book = check_book(&r.solver, 1e-12);
    assert_true(book.kinetic > 0.0 && book.elastic > 0.0 && book.damping > 0.0 && book.quiet > 0.0);
    assert_true(book.load != 0.0 && book.gravity != 0.0 && book.support != 0.0);
  }
  rig_release(&r);
  for (int k = 0; k < 3; k++)
    drop(&support[k]);
  free(facet);
  free(side);
  free(node);
  free(vector);
  free(impedance);
}

static void energy_book_closes(void **state) {
  (void)state;
  rig_options plane = rig_square(5, 4), solid = rig_cube(3);
  plane.linear = solid.linear = true;
  book_closes(&plane);
  book_closes(&solid);
}

/* Where the step changes, what the leapfrog calls kinetic energy shifts by (dt_a^2 - dt_b^2)/8
 * F^2/m: the book says so, closes, and the shift is of second order in the step. */
static void changed_step_keeps_the_book(void **state) {
  (void)state;
  double shift[2];
  for (int fine = 0; fine < 2; fine++) {
    rig r;
    rig_options o = rig_square(5, 4);
    o.linear = true;
    rig_make(&o, &r);
    cdem_support support = hold(&r, "x0", 0, false, sine(1e-5, 30.0));
    r.options.supports = 1;
    r.options.support = &support;
    r.options.gravity[0] = 10.0;
    r.options.mass_damping = 5.0;
    r.options.local_damping = 0.01;
    r.options.safety = fine ? 0.1 : 0.2;
    rig_start(&r);
    rig_run(&r, fine ? 200 : 100);
    r.solver.store->base_time = r.solver.time;
    r.solver.store->base_steps = r.solver.steps;
    r.solver.step *= 0.5;
    cdem_solver_paths(&r.solver, cdem_solver_next_time(&r.solver));
    check_book(&r.solver, 1e-12);
    rig_run(&r, 1);
    check_book(&r.solver, 1e-12);
    rig_run(&r, fine ? 200 : 100);
    cdem_energy_book book = check_book(&r.solver, 1e-12);
    shift[fine] = fabs(book.step) / book.exchange;
    rig_release(&r);
    drop(&support);
  }
  check_below(shift[0], 3e-3);
  check_near(shift[0] / shift[1], 4.0, 0.25, 0.0);
}

/* ---- a free block ---- */

/* Turned by a spin of 1 per element crossing: large rotations, no forces from outside. */
static double spin_error(double safety) {
  rig r;
  rig_options o = rig_cube(2);
  o.young = 1e6;
  rig_make(&o, &r);
  const cdem_mesh *mesh = &r.blocks.mesh;
  double *velocity = calloc((size_t)(3 * mesh->nodes), sizeof *velocity);
  const double spin[3] = {3.0, -2.0, 6.0}, drift[3] = {0.4, 0.1, -0.3};
  for (int32_t n = 0; n < mesh->nodes; n++) {
    cdem_cross3(spin, mesh->xyz + 3 * n, velocity + 3 * n);
    for (int k = 0; k < 3; k++)
      velocity[3 * n + k] += drift[k];
  }
  r.options.velocity = velocity;
  r.options.safety = safety;
  rig_start(&r);
  double p0[3], l0[3], p[3], l[3], worst = 0.0;
  cdem_solver_momentum(&r.solver, p0, l0);
  while (r.solver.time < 0.5) { /* half a turn */
    rig_run(&r, 1);
    cdem_solver_momentum(&r.solver, p, l);
    for (int k = 0; k < 3; k++) {
      check_near(p[k], p0[k], 0.0, 1e-12 * cdem_norm3(p0));
      check_near(l[k], l0[k], 0.0, 1e-11 * cdem_norm3(l0));
    }
    cdem_energy_book book;
    cdem_solver_energies(&r.solver, &book);
    worst = fmax(worst, fabs(book.error) / book.kinetic);
  }
  free(velocity);
  rig_release(&r);
  return worst;
}

static void spinning_block_keeps_momentum_and_energy(void **state) {
  (void)state;
  double coarse = spin_error(0.4), fine = spin_error(0.2);
  check_below(coarse, 1e-3);       /* of the kinetic energy */
  check_below(fine, coarse / 3.0); /* second order: 4 */
}

/* ---- supports ---- */

static void prescribed_paths_are_exact(void **state) {
  (void)state;
  rig r;
  rig_options o = rig_square(3, 3);
  rig_make(&o, &r);
  const double times[] = {0.0, 2e-3, 5e-3}, values[] = {0.0, 0.3, -0.2};
  cdem_fault fault = {0};
  cdem_series table = {0};
  check_ok(cdem_series_table(3, times, values, &table, &fault));
  cdem_support support[2] = {hold(&r, "x0", 0, false, sine(1e-3, 200.0)),
                             hold(&r, "x1", 0, true, table)};
  r.options.supports = 2;
  r.options.support = support;
  rig_start(&r);
  while (r.solver.time < 6e-3) {
    rig_run(&r, 1);
    for (int k = 0; k < 2; k++)
      for (int32_t i = 0; i < support[k].nodes; i++)
        assert_true(r.solver.u[2 * support[k].node[i]] ==
                    cdem_support_path(&support[k], r.solver.time));
  }
  check_near(r.solver.u[2 * support[0].node[0]], 1e-3 * sin(2.0 * pi * 200.0 * r.solver.time),
             1e-12, 0.0);
  rig_release(&r);
  drop(&support[0]);
  drop(&support[1]);
}

/* The reaction of a support is what the motion of all masses needs besides the loads. */
static void reactions_balance(void **state) {
  (void)state;
  rig r;
  rig_options o = rig_cube(2);
  rig_make(&o, &r);
  cdem_support support[3] = {hold(&r, "z0", 0, false, constant(0.0)),
                             hold(&r, "z0", 1, false, constant(0.0)),
                             hold(&r, "z0", 2, false, sine(1e-4, 100.0))};
  r.options.supports = 3;
  r.options.support = support;
  r.options.gravity[0] = 2.0;
  r.options.gravity[2] = -9.81;
  r.options.mass_damping = 20.0;
  rig_start(&r);
  rig_run(&r, 40);
  double before[3], after[3], turn[3], reaction[3], *velocity, drag[3] = {0}, weight = 0.0;
  velocity = calloc((size_t)(3 * r.solver.nodes), sizeof *velocity);
  cdem_solver_momentum(&r.solver, before, turn);
  cdem_solver_velocity(&r.solver, velocity);
  for (int32_t n = 0; n < r.solver.nodes; n++)
    for (int k = 0; k < 3; k++)
      drag[k] += 20.0 * r.body.mass[3 * n + k] * velocity[3 * n + k];
  for (int32_t n = 0; n < r.solver.nodes; n++)
    weight += r.body.mass[3 * n];
  for (int k = 0; k < 3; k++)
    reaction[k] = cdem_solver_reaction(&r.solver, k);
  rig_run(&r, 1);
  cdem_solver_momentum(&r.solver, after, turn);
  for (int k = 0; k < 3; k++)
    check_near(reaction[k],
               (after[k] - before[k]) / r.solver.step + drag[k] - weight * r.options.gravity[k],
               1e-9, 1e-9 * weight);
  free(velocity);
  rig_release(&r);
  for (int k = 0; k < 3; k++)
    drop(&support[k]);
}

/* ---- pressure ---- */

/* On a closed surface a uniform pressure has no resultant and no moment, however it is bent. */
static void pressure_follows_a_turning_body(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int solid = 0; solid < 2; solid++) {
    rig r;
    rig_options o = solid ? rig_cube(2) : rig_square(3, 2);
    o.young = 1e7;
    rig_make(&o, &r);
    int dofs = solid ? 3 : 2;
    const cdem_mesh *mesh = &r.blocks.mesh;
    double *velocity = calloc((size_t)(dofs * mesh->nodes), sizeof *velocity);
    for (int32_t n = 0; n < mesh->nodes; n++) {
      velocity[dofs * n] = -20.0 * mesh->xyz[3 * n + 1];
      velocity[dofs * n + 1] = 20.0 * mesh->xyz[3 * n];
    }
    int32_t *facet = calloc((size_t)r.blocks.facets, sizeof *facet), facets = 0;
    for (int32_t f = 0; f < r.blocks.facets; f++)
      if (r.blocks.facet[f].pair < 0)
        facet[facets++] = f;
    cdem_pressure pressure = {"all around", constant(1e5), facets, facet};
    r.options.pressures = 1;
    r.options.pressure = &pressure;
    r.options.velocity = velocity;
    rig_start(&r);
    while (r.solver.time < 0.02)
      rig_run(&r, 1);
    double force[3] = {0}, moment[3] = {0}, scale = 0.0;
    for (int32_t n = 0; n < mesh->nodes; n++) {
      double x[3] = {0}, f[3] = {0}, m[3];
      for (int k = 0; k < dofs; k++) {
        x[k] = mesh->xyz[3 * n + k] + r.solver.u[dofs * n + k];
        f[k] = r.solver.external[dofs * n + k];
        force[k] += f[k];
      }
      cdem_cross3(x, f, m);
      for (int k = 0; k < 3; k++)
        moment[k] += m[k];
      scale += cdem_norm3(f);
    }
    check_below(cdem_norm3(force), 1e-13 * scale);
    check_below(cdem_norm3(moment), 1e-13 * scale);
    assert_true(fabs(r.solver.u[0] - r.solver.u[dofs * (mesh->nodes - 1)]) > 0.1); /* has turned */
    check_book(&r.solver, 1e-3);
    (void)fault;
    cdem_series_release(&pressure.series);
    rig_release(&r);
    free(velocity);
    free(facet);
  }
}

/* ---- the same bits ---- */

static void make_busy(rig *r, int threads, cdem_support *support, cdem_pressure *pressure,
                      int32_t **facet) {
  cdem_fault fault = {0};
  rig_options o = rig_square(40, 39); /* two chunks of nodes */
  o.threads = threads;
  rig_make(&o, r);
  *support = hold(r, "x0", 0, false, sine(1e-4, 300.0));
  check_ok(cdem_blocks_group_facets(&r->blocks, "y1", &pressure->facets, facet, &fault));
  pressure->facet = *facet;
  pressure->name = "y1";
  pressure->series = sine(1e5, 500.0);
  r->options.supports = 1;
  r->options.support = support;
  r->options.pressures = 1;
  r->options.pressure = pressure;
  r->options.mass_damping = 10.0;
  r->options.local_damping = 0.1;
  r->options.gravity[1] = -9.81;
  rig_start(r);
}

static void check_same(cdem_solver *a, cdem_solver *b) {
  size_t size = (size_t)a->nodes * (size_t)a->dofs * sizeof(double);
  cdem_energy_book book_a, book_b;
  assert_memory_equal(a->u, b->u, size);
  assert_memory_equal(a->v, b->v, size);
  assert_memory_equal(a->force, b->force, size);
  assert_true(a->time == b->time);
  cdem_solver_energies(a, &book_a);
  cdem_solver_energies(b, &book_b);
  assert_memory_equal(&book_a, &book_b, sizeof book_a);
}

static void threads_do_not_change_bits(void **state) {
  (void)state;
  rig one, more;
  cdem_support support[2];
  cdem_pressure pressure[2];
  int32_t *facet[2];
  make_busy(&one, 1, &support[0], &pressure[0], &facet[0]);
  rig_run(&one, 30);
  for (int threads = 2; threads <= 4; threads *= 2) {
    make_busy(&more, threads, &support[1], &pressure[1], &facet[1]);
    rig_run(&more, 30);
    check_same(&one.solver, &more.solver);
    assert_true(cdem_solver_unbalanced(&one.solver) == cdem_solver_unbalanced(&more.solver));
    rig_release(&more);
    drop(&support[1]);
    free(facet[1]);
  }
  rig_release(&one);
  drop(&support[0]);
  free(facet[0]);
}

static void restart_goes_on_to_the_same_bits(void **state) {
  (void)state;
  rig whole, resumed;
  cdem_support support[2];
  cdem_pressure pressure[2];
  int32_t *facet[2];
  cdem_fault fault = {0};
  cdem_state saved = {0};
  make_busy(&whole, 2, &support[0], &pressure[0], &facet[0]);
  make_busy(&resumed, 2, &support[1], &pressure[1], &facet[1]);
  rig_run(&whole, 10);
  cdem_energy_book book;
  cdem_solver_energies(&whole.solver, &book);
  check_ok(cdem_solver_save(&whole.solver, &saved, &fault));
  check_ok(cdem_solver_restore(&resumed.solver, &saved, &fault));
  cdem_state_release(&saved);
  check_same(&whole.solver, &resumed.solver);
  rig_run(&whole, 15);
  rig_run(&resumed, 15);
  check_same(&whole.solver, &resumed.solver);
  cdem_state other = {0};
  rig small;
  rig_options o = rig_square(2, 2);
  rig_make(&o, &small);
  rig_start(&small);
  check_ok(cdem_solver_save(&small.solver, &other, &fault));
  check_fails(cdem_solver_restore(&whole.solver, &other, &fault), CDEM_INPUT,
              "does not belong to this case: 'solver/u' has 18 entries, the case 3280");
  ((double *)cdem_state_find(&other, "solver/reals")->data)[1] = -1.0;
  check_fails(cdem_solver_restore(&small.solver, &other, &fault), CDEM_INPUT,
              "steps of -1 s, which cannot be");
  cdem_state_release(&other);
  rig_release(&small);
  for (int k = 0; k < 2; k++) {
    rig_release(k == 0 ? &whole : &resumed);
    drop(&support[k]);
    free(facet[k]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(oscillator_has_its_frequency),
      cmocka_unit_test(mass_damping_decays),
      cmocka_unit_test(energy_book_closes),
      cmocka_unit_test(changed_step_keeps_the_book),
      cmocka_unit_test(spinning_block_keeps_momentum_and_energy),
      cmocka_unit_test(prescribed_paths_are_exact),
      cmocka_unit_test(reactions_balance),
      cmocka_unit_test(pressure_follows_a_turning_body),
      cmocka_unit_test(threads_do_not_change_bits),
      cmocka_unit_test(restart_goes_on_to_the_same_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
