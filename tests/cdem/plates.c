/* Rigid plates: stiffness, friction, edges, energy. */
#include "base/mat3.h"
#include "cdem/solver_store.h"
#include "solver_support.h"

static rig_options soft_block(bool solid) {
  rig_options o = solid ? rig_cube(2) : rig_square(3, 3);
  o.distortion = 0.0;
  o.poisson = 0.0;
  o.young = 1e8;
  return o;
}

/* A plate comes down slowly on a block and stays: F = d/(1/(kn A) + L/(E A)), springs in a row. */
static void plate_compresses_a_block(void **state) {
  (void)state;
  for (int solid = 0; solid < 2; solid++) {
    rig r;
    rig_options o = soft_block(solid);
    rig_make(&o, &r);
    const double times[] = {0.0, 0.02, 0.04}, speeds[] = {0.0, -0.05, 0.0};
    cdem_series table = {0};
    cdem_fault fault = {0};
    check_ok(cdem_series_table(3, times, speeds, &table, &fault));
    cdem_support floor = hold(&r, "y0", 1, false, constant(0.0));
    double area = solid ? o.size[0] * o.size[2] : o.size[0] * o.thickness;
    cdem_plate plate = {.name = "lid",
                        .point = {0.3, o.size[1], 0.1},
                        .normal = {0.0, -2.0, 0.0},
                        .velocity = {{0}, table, {0}},
                        .kn = 1e9};
    r.options.supports = 1;
    r.options.support = &floor;
    r.options.plates = 1;
    r.options.plate = &plate;
    r.options.mass_damping = 600.0; /* 0.7 of critical */
    rig_start(&r);
    while (r.solver.time < 0.1)
      rig_run(&r, 1);
    double force[3], moved[3];
    cdem_solver_plate(&r.solver, 0, force, moved);
    check_near(moved[1], -1e-3, 1e-12, 0.0);
    double expected = -moved[1] / (1.0 / (plate.kn * area) + o.size[1] / (o.young * area));
    /* The lid touches from the start, so that its springs stand on the area of the top. Strains of
     * 1e-3 are left to second order in the corotated body. */
    check_near(force[1], expected, 1e-5, 0.0);
    check_near(force[1], cdem_solver_reaction(&r.solver, 0), 1e-6, 0.0);
    check_near(force[0], 0.0, 0.0, 1e-9 * force[1]);
    check_book(&r.solver, 1e-4);
    cdem_series_release(&plate.velocity[1]);
    drop(&floor);
    rig_release(&r);
  }
}
/* A block lies on a plate under its weight and is pushed along: it sticks, then slides with the
 * friction of the plate. Friction, spring and work close the book to rounding. */
static void friction_holds_then_slides(void **state) {
  (void)state;
  rig r;
  rig_options o = soft_block(true);
  o.linear = true;
  rig_make(&o, &r);
  cdem_plate plate = {.name = "ground",
                      .point = {0.0, 0.0, 0.0},
                      .normal = {0.0, 1.0, 0.0},
                      .axis = {1.0, 0.0, 0.3},
                      .velocity = {constant(0.2), {0}, {0}},
                      .kn = 1e9,
                      .kt = 1e9,
                      .friction = 0.4};
  r.options.plates = 1;
  r.options.plate = &plate;
  r.options.gravity[1] = -9.81;
  r.options.mass_damping = 0.0;
  rig_start(&r);
  double weight = 0.0, force[3], moved[3], linear[3], angular[3];
  for (int32_t n = 0; n < r.body.nodes; n++)
    weight += 9.81 * r.body.mass[3 * n];
  rig_run(&r, 300);
  cdem_energy_book book;
  cdem_solver_energies(&r.solver, &book);
  assert_true(book.friction > 0.0 && book.plate > 0.0 && book.support > 0.0);
  /* Touching is a kink in the spring, the only thing that does not close: g0 g1 kn A/2 a node. */
  check_below(fabs(book.error), 2e-2 * book.exchange);
  double before = r.solver.time, drift[3];
  cdem_solver_momentum(&r.solver, linear, angular);
  double impulse = 0.0, press = 0.0;
  for (int k = 0; k < 200; k++) {
    cdem_solver_plate(&r.solver, 0, force, moved);
    check_below(hypot(force[0], force[2]), 0.4 * fabs(force[1]) * (1.0 + 1e-12));
    impulse -= force[0] * r.solver.step;
    press -= force[1] * r.solver.step;
    rig_run(&r, 1);
  }
  cdem_solver_momentum(&r.solver, drift, angular);
  check_near(drift[0] - linear[0], impulse, 1e-10, 1e-10 * fabs(linear[0]));
  check_near(drift[1] - linear[1], press - weight * (r.solver.time - before), 1e-9, 1e-9 * press);
  rig_release(&r);
  cdem_series_release(&plate.velocity[0]);
}

/* Nodes beyond the edge of a finite plate do not touch it; those that come from behind neither. */
static void finite_plates_end(void **state) {
  (void)state;
  rig r;
  rig_options o = soft_block(false);
  rig_make(&o, &r);
  /* Plates overlap the block's top by 1 mm: one over its left half, one beside it, one whose face
   * lies deep inside. */
  cdem_plate plate[3] = {{.name = "half",
                          .point = {0.0, 0.799, 0},
                          .normal = {0, -1, 0},
                          .axis = {1, 0, 0},
                          .half = {0.5, 0.0},
                          .kn = 1e8},
                         {.name = "beside",
                          .point = {-0.6, 0.799, 0},
                          .normal = {0, -1, 0},
                          .axis = {1, 0, 0},
                          .half = {0.5, 0.0},
                          .kn = 1e8},
                         {.name = "deep",
                          .point = {0.5, 0.3, 0},
                          .normal = {0, -1, 0},
                          .axis = {1, 0, 0},
                          .half = {0.5, 0.0},
                          .kn = 1e8}};
  r.options.plates = 3;
  r.options.plate = plate;
  rig_start(&r);
  double force[3], moved[3];
  cdem_solver_plate(&r.solver, 0, force, moved);
  /* nodes at 0 and 1/3: shares 1/6 and 1/3 of the top */
  check_near(force[1], 1e8 * 1e-3 * 0.5 * o.thickness, 1e-9, 0.0);
  cdem_solver_plate(&r.solver, 1, force, moved);
  check_near(force[1], 0.0, 0.0, 0.0);
  cdem_solver_plate(&r.solver, 2, force, moved);
  check_near(force[1], 0.0, 0.0, 0.0);
  rig_release(&r);
}

/* A block slides out from under one plate and against the edge of another that stands lower than
 * its top: what comes from the side is left alone, what the first spring still held is lost as
 * friction, and the book closes. */
static void sideways_the_book_closes(void **state) {
  (void)state;
  rig r;
  rig_options o = soft_block(true);
  rig_make(&o, &r);
  const double stiffness = 1e4, deep = 1e-3, speed = 2.0;
  double *velocity = calloc((size_t)(3 * r.body.nodes), sizeof *velocity);
  for (int32_t n = 0; n < r.body.nodes; n++)
    velocity[3 * n] = speed;
  cdem_plate plate[2] = {{.name = "left",
                          .point = {0.0, 0.8 - deep, 0},
                          .normal = {0, -1, 0},
                          .axis = {1, 0, 0},
                          .half = {0.5, 0.0},
                          .kn = stiffness},
                         {.name = "beside",
                          .point = {1.6, 0.8 - 20.0 * deep, 0},
                          .normal = {0, -1, 0},
                          .axis = {1, 0, 0},
                          .half = {0.5, 0.0},
                          .kn = 1e5 * stiffness}};
  r.options.plates = 2;
  r.options.plate = plate;
  r.options.velocity = velocity;
  rig_start(&r);
  cdem_energy_book book;
  double force[3], moved[3];
  cdem_solver_plate(&r.solver, 0, force, moved);
  assert_true(force[1] > 0.0); /* two nodes touch */
  while (r.solver.time < 0.4) {
    rig_run(&r, 1);
    cdem_solver_plate(&r.solver, 1, force, moved);
    check_near(force[1], 0.0, 0.0, 0.0);
  }
  cdem_solver_plate(&r.solver, 0, force, moved);
  check_near(force[1], 0.0, 0.0, 0.0);
  cdem_solver_energies(&r.solver, &book);
  assert_true(book.friction > 0.0);
  check_below(fabs(book.error), 1e-3 * book.friction);
  rig_release(&r);
  free(velocity);
}

/* A block falls on a plate and bounces: momentum turns round, and the book closes but for the kinks
 * of the springs, which is one of the second order in the step, up to the chance of where in a step
 * a node comes. */
static double bounce_error(double safety) {
  rig r;
  rig_options o = soft_block(true);
  rig_make(&o, &r);
  double *velocity = calloc((size_t)(3 * r.body.nodes), sizeof *velocity), before[3], after[3],
         l[3];
  for (int32_t n = 0; n < r.body.nodes; n++)
    velocity[3 * n + 1] = -0.5;
  cdem_plate plate = {.name = "ground", .point = {0, -1e-4, 0}, .normal = {0, 1, 0}, .kn = 1e9};
  r.options.plates = 1;
  r.options.plate = &plate;
  r.options.velocity = velocity;
  r.options.safety = safety;
  rig_start(&r);
  cdem_solver_momentum(&r.solver, before, l);
  while (r.solver.time < 0.02)
    rig_run(&r, 1);
  cdem_solver_momentum(&r.solver, after, l);
  assert_true(after[1] > 0.5 * fabs(before[1]));
  cdem_energy_book book;
  cdem_solver_energies(&r.solver, &book);
  rig_release(&r);
  free(velocity);
  return fabs(book.error) / book.exchange;
}

static void block_bounces(void **state) {
  (void)state;
  double coarse = bounce_error(0.4), fine = bounce_error(0.1);
  check_below(coarse, 5e-3);
  check_below(fine, coarse / 4.0); /* second order: 16 */
}

static void bad_plates_are_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = soft_block(true);
  rig_make(&o, &r);
  cdem_plate plate = {.name = "lid", .kn = 1e9};
  r.options.plates = 1;
  r.options.plate = &plate;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT,
              "plate 'lid' has no normal");
  plate.normal[1] = -1.0;
  plate.half[0] = 1.0;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT,
              "plate 'lid' is finite and needs an axis");
  plate.axis[0] = 1.0;
  plate.kn = 0.0;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT, "kn must be positive");
  plate.kn = 1e16;
  r.options.step = 1e-4;
  plate.point[1] = 1.0;
  check_fails(cdem_solver_init(&r.options, &r.solver, &fault), CDEM_INPUT, "set by plate 'lid'");
  rig_release(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plate_compresses_a_block), cmocka_unit_test(friction_holds_then_slides),
      cmocka_unit_test(finite_plates_end),        cmocka_unit_test(block_bounces),
      cmocka_unit_test(sideways_the_book_closes), cmocka_unit_test(bad_plates_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
