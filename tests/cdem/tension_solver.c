/* Bodies without tension in motion: a pulse that must come back as tension and cannot, and what a
 * static solution says. */
#include "solver_support.h"

static const double young = 10e9, density = 2500.0, top = 1e6; /* Pa, kg/m^3, Pa */

typedef struct {
  rig r;
  int32_t *facet;
  cdem_pressure pressure;
  double c;
} hammered;

/* A free bar of unit length and 1/elements across, without Poisson's effect; a pulse of pressure of
 * 0.2 L/c on its end x0, smooth or sudden. ratio: c times the step over h. */
static void hammer(int32_t elements, bool sudden, bool no_tension, double ratio, hammered *b) {
  cdem_fault fault = {0};
  double c = sqrt(young / density), h = 1.0 / elements, duration = 0.2 / c;
  const rig_options o = {.shape = CDEM_SHAPE_QUAD4,
                         .count = {elements, 1, 0},
                         .size = {1.0, h, 0.0},
                         .young = young,
                         .density = density,
                         .plane = CDEM_PLANE_STRESS,
                         .thickness = 1.0,
                         .no_tension = no_tension,
                         .threads = 1};
  rig_make(&o, &b->r);
  b->c = c;
  b->pressure = (cdem_pressure){.name = "x0"};
  const double time[2] = {duration, duration * (1.0 + 1e-9)}, value[2] = {top, 0.0};
  if (sudden)
    check_ok(cdem_series_table(2, time, value, &b->pressure.series, &fault));
  else
    b->pressure.series =
        (cdem_series){.kind = CDEM_SERIES_PULSE, .amplitude = top, .duration = duration};
  check_ok(cdem_blocks_group_facets(&b->r.blocks, "x0", &b->pressure.facets, &b->facet, &fault));
  b->pressure.facet = b->facet;
  b->r.options.pressures = 1;
  b->r.options.pressure = &b->pressure;
  b->r.options.step = ratio * h / c;
  rig_start(&b->r);
}

static void put_down(hammered *b) {
  rig_release(&b->r);
  cdem_series_release(&b->pressure.series);
  free(b->facet);
}

static void run_to(hammered *b, double way) {
  while (b->r.solver.time * b->c < way)
    rig_run(&b->r, 1);
}

/* Mean velocity along x, over top/(rho c), of nodes between two distances from the far end. */
static double mean_velocity(const hammered *b, double from, double to) {
  double *v = calloc((size_t)(2 * b->r.body.nodes), sizeof *v), sum = 0.0, count = 0.0;
  cdem_solver_velocity(&b->r.solver, v);
  for (int32_t n = 0; n < b->r.body.nodes; n++) {
    double s = 1.0 - b->r.blocks.mesh.xyz[3 * n];
    if (s >= from && s <= to) {
      sum += v[2 * n] / (top / (density * b->c));
      count += 1.0;
    }
  }
  free(v);
  return sum / count;
}

/* In a free end a pulse doubles its velocity and turns to tension. Without tension the end flies
 * off with twice the peak as soon as the pressure falls behind it, and so does each layer below:
 * the one that lay s below the end keeps 2 v_0 sin^2 at the phase s/c behind the peak. All momentum
 * and energy of the pulse are then in its falling half, and in nothing but motion. */
static void smooth_pulse_flies_off(void **state) {
  (void)state;
  hammered b;
  hammer(400, false, true, 0.4, &b);
  double linear[3], later[3], angular[3], impulse = 0.5 * top * (0.2 / b.c) / 400;
  run_to(&b, 0.9);
  cdem_energy_book before = check_book(&b.r.solver, 1e-3);
  cdem_solver_momentum(&b.r.solver, linear, angular);
  check_near(linear[0], impulse, 1e-3, 0.0); /* the strip of a pulse that the step cuts */
  run_to(&b, 1.4);
  double first = mean_velocity(&b, 0.0, 1e-9);
  check_near(first, 2.0, 0.01, 0.0);
  for (double s = 0.01; s < 0.08; s += 0.01) {
    double phase = cos(acos(-1.0) * s / 0.2);
    check_near(mean_velocity(&b, s - 0.006, s + 0.006), 2.0 * phase * phase, 0.0, 0.03);
  }
  check_below(fabs(mean_velocity(&b, 0.2, 1.0)), 0.01);
  run_to(&b, 2.4);
  check_near(mean_velocity(&b, 0.0, 1e-9), first, 1e-3, 0.0); /* free from then on */
  cdem_solver_momentum(&b.r.solver, later, angular);
  check_near(later[0], linear[0], 1e-12, 0.0);
  cdem_energy_book after = check_book(&b.r.solver, 1e-3);
  check_near(before.elastic, before.kinetic, 0.01, 0.0);
  check_near(after.kinetic, before.kinetic + before.elastic, 0.01, 0.0);
  put_down(&b);
}

/* A sudden pulse leaves a piece of half its length at twice its velocity (a spall); its ripples
 * open and close elements many times. The same pulse in the linear bar comes back. The book's error
 * is what a step leaves out of the kinks: of second order. */
static double spall(bool no_tension, double ratio) {
  hammered b;
  double linear[3], later[3], angular[3];
  hammer(200, true, no_tension, ratio, &b);
  run_to(&b, 0.9);
  cdem_solver_momentum(&b.r.solver, linear, angular);
  run_to(&b, 1.5);
  check_near(mean_velocity(&b, 0.0, 0.08), no_tension ? 2.0 : 0.0, 0.0, 0.1);
  check_near(mean_velocity(&b, 0.15, 0.5), no_tension ? 0.0 : 4.0 / 7.0, 0.0, 0.05);
  cdem_solver_momentum(&b.r.solver, later, angular);
  check_near(later[0], linear[0], 1e-12, 0.0);
  cdem_energy_book book;
  cdem_solver_energies(&b.r.solver, &book);
  put_down(&b);
  return fabs(book.error) / book.exchange;
}

static void sudden_pulse_spalls(void **state) {
  (void)state;
  check_below(spall(false, 0.4), 1e-12);
  double coarse = spall(true, 0.4), fine = spall(true, 0.1);
  check_below(spall(true, 0.2), 1e-3);
  check_below(fine, coarse / 8.0);
}

/* The worst that can happen to the step: a body held all around whose elements rattle without
 * damping, some half of them open at any time. With the automatic step its energy stays, within
 * what a random walk does to it; at twice that step it grew by more than half. */
static void rattling_keeps_its_energy(void **state) {
  (void)state;
  rig r;
  rig_options o = rig_square(8, 8);
  o.no_tension = true;
  o.threads = 1;
  rig_make(&o, &r);
  cdem_support support[8];
  static const char *const side[4] = {"x0", "x1", "y0", "y1"};
  for (int k = 0; k < 8; k++)
    support[k] = hold(&r, side[k / 2], k % 2, false, constant(0.0));
  r.options.supports = 8;
  r.options.support = support;
  double *velocity = calloc((size_t)(2 * r.body.nodes), sizeof *velocity);
  for (int32_t i = 0; i < 2 * r.body.nodes; i++)
    velocity[i] = 0.01 * sin(7.0 * i * i);
  r.options.velocity = velocity;
  rig_start(&r);
  rig_run(&r, 4000);
  cdem_energy_book book;
  cdem_solver_energies(&r.solver, &book);
  check_near(book.kinetic + book.elastic, book.initial, 0.05, 0.0);
  assert_true(book.elastic > 0.2 * book.initial);
  rig_release(&r);
  free(velocity);
  for (int k = 0; k < 8; k++)
    drop(&support[k]);
}

/* A column under a pressure that falls linearly to nothing across three quarters of its top:
 * bending with an open joint. Pressed, it is a beam of what is in contact: e_yy = -p(x)/E there.
 * Relaxed. */
static void open_column_bends(void **state) {
  (void)state;
  rig r;
  rig_options o = rig_square(16, 8);
  o.no_tension = true;
  o.threads = 1;
  o.poisson = o.distortion = 0.0;
  o.plane = CDEM_PLANE_STRESS;
  rig_make(&o, &r);
  double top_pressure = 1e4, reach = 0.75, h = o.size[0] / 16, total = 0.0;
  cdem_support support[2] = {hold(&r, "y0", 1, false, constant(0.0)),
                             hold(&r, "y0", 0, false, constant(0.0))};
  cdem_load load = {.name = "y1", .series = constant(1.0)};
  int32_t *node;
  cdem_fault fault = {0};
  check_ok(cdem_blocks_group_nodes(&r.blocks, "y1", &load.nodes, &node, &fault));
  double *vector = calloc((size_t)(2 * load.nodes), sizeof *vector);
  for (int32_t k = 0; k < load.nodes; k++) {
    double x = r.blocks.mesh.xyz[3 * node[k]];
    double mean = fmax(0.0, 1.0 - x / reach); /* by shape functions, exact to the two kinks */
    if (x == 0.0)
      mean = 0.5 * (1.0 - h / (3.0 * reach));
    else if (fabs(x - reach) < 1e-9)
      mean = h / (6.0 * reach);
    vector[2 * k + 1] = -top_pressure * mean * h * o.thickness;
    total -= vector[2 * k + 1];
  }
  load.node = node;
  load.vector = vector;
  r.options.supports = 2;
  r.options.support = support;
  r.options.loads = 1;
  r.options.load = &load;
  r.options.fictitious_mass = true;
  r.options.local_damping = 0.8;
  rig_start(&r);
  int steps = 0;
  for (; cdem_solver_unbalanced(&r.solver) > 1e-6 && steps < 20000; steps += 100)
    rig_run(&r, 100);
  check_below(steps, 15000);
  for (int32_t k = 0; k < load.nodes; k++) {
    double x = r.blocks.mesh.xyz[3 * node[k]], sinking = r.solver.u[2 * node[k] + 1];
    if (x < reach + 1e-9) /* beyond nothing holds: only hourglass modes decide how far it gapes */
      check_near(sinking / (top_pressure / o.young * o.size[1]), x / reach - 1.0, 0.0, 0.01);
    else
      assert_true(sinking > 0.0);
  }
  check_near(cdem_solver_reaction(&r.solver, 0), total, 1e-4, 0.0);
  rig_release(&r);
  free(vector);
  cdem_series_release(&load.series);
  free(node);
  drop(&support[0]);
  drop(&support[1]);
}

/* The law has no state of its own: a run taken up again from a saved state has the same bits. */
static void interruption_changes_nothing(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_state saved = {0};
  hammered whole, resumed;
  hammer(600, true, true, 0.4, &whole);
  hammer(600, true, true, 0.4, &resumed);
  run_to(&whole, 1.15); /* pieces fly */
  check_ok(cdem_solver_save(&whole.r.solver, &saved, &fault));
  check_ok(cdem_solver_restore(&resumed.r.solver, &saved, &fault));
  rig_run(&whole.r, 100);
  rig_run(&resumed.r, 100);
  size_t bytes = (size_t)(2 * whole.r.body.nodes) * sizeof(double);
  assert_memory_equal(whole.r.solver.u, resumed.r.solver.u, bytes);
  assert_memory_equal(whole.r.solver.v, resumed.r.solver.v, bytes);
  cdem_state_release(&saved);
  put_down(&whole);
  put_down(&resumed);
}

/* A hanging column cannot carry its weight; a standing one does, as the linear one. */
static void columns_stand_and_do_not_hang(void **state) {
  (void)state;
  for (int hanging = 0; hanging < 2; hanging++) {
    rig r;
    rig_options o = rig_square(4, 6);
    o.no_tension = true;
    o.threads = 1;
    o.threads = 1;
    o.poisson = o.distortion = 0.0; /* a motion without hourglass modes, which stay linear */
    rig_make(&o, &r);
    cdem_support support[2] = {hold(&r, hanging ? "y1" : "y0", 1, false, constant(0.0)),
                               hold(&r, "x0", 0, false, constant(0.0))};
    r.options.supports = 2;
    r.options.support = support;
    r.options.gravity[1] = -9.81;
    r.options.local_damping = hanging ? 0.0 : 0.8;
    rig_start(&r);
    double weight = 9.81 * o.density * o.size[0] * o.size[1] * o.thickness, fall = 0.02;
    while (r.solver.time < (hanging ? fall : 0.2))
      rig_run(&r, 1);
    if (!hanging)
      check_near(cdem_solver_reaction(&r.solver, 0), weight, 1e-4, 0.0);
    for (int32_t n = 0; n < r.body.nodes && hanging; n++) /* all but the held ones fall freely */
      if (r.blocks.mesh.xyz[3 * n + 1] < 0.01)
        check_near(r.solver.u[2 * n + 1], -0.5 * 9.81 * fall * fall, 0.02, 0.0);
    rig_release(&r);
    drop(&support[0]);
    drop(&support[1]);
  }
}

static void static_solution_is_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_square(2, 2);
  o.no_tension = true;
  o.threads = 1;
  rig_make(&o, &r);
  rig_start(&r);
  check_fails(cdem_solver_static(&r.solver, 0.0, &fault), CDEM_INPUT,
              "carries no tension and so is not linear, but a static solution is; relax the body "
              "(analysis: relaxation)");
  rig_release(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(smooth_pulse_flies_off),
      cmocka_unit_test(sudden_pulse_spalls),
      cmocka_unit_test(rattling_keeps_its_energy),
      cmocka_unit_test(open_column_bends),
      cmocka_unit_test(interruption_changes_nothing),
      cmocka_unit_test(columns_stand_and_do_not_hang),
      cmocka_unit_test(static_solution_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
