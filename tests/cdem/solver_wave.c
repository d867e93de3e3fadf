/* Waves in bars: speeds, order of convergence, a sudden load, a quiet end. */
#include "solver_support.h"

typedef struct {
  bool solid, held; /* held: no motion across the bar */
  double poisson;
  int32_t elements;
} bar;

static const double young = 10e9, density = 2500.0;

/* A bar of unit length along x, of elements of edge h across. */
static void make_bar(const bar *b, rig *r, cdem_support support[2]) {
  double h = 1.0 / b->elements;
  rig_options o = {.shape = b->solid ? CDEM_SHAPE_HEX8 : CDEM_SHAPE_QUAD4,
                   .count = {b->elements, 1, b->solid ? 1 : 0},
                   .size = {1.0, h, b->solid ? h : 0.0},
                   .young = young,
                   .poisson = b->poisson,
                   .density = density,
                   .plane = CDEM_PLANE_STRESS,
                   .thickness = 1.0,
                   .linear = true,
                   .threads = 1};
  rig_make(&o, r);
  if (!b->held)
    return;
  support[0] = hold(r, "body", 1, false, constant(0.0));
  support[1] = hold(r, "body", 2, false, constant(0.0));
  r->options.supports = 2;
  r->options.support = support;
}

static double speed_of(const bar *b) {
  double g = young / (2.0 * (1.0 + b->poisson));
  double lambda = young * b->poisson / ((1.0 + b->poisson) * (1.0 - 2.0 * b->poisson));
  return sqrt((b->held ? lambda + 2.0 * g : young) / density);
}

/* A bell of velocity in the middle parts into two of half the height. u by d'Alembert is the
 * integral of v_0 from x - ct to x + ct over 2c: the error function. Root mean square error of u
 * over its largest value, after 0.15 of the time along the bar. */
static double pulse_error(const bar *b) {
  rig r;
  cdem_support support[2];
  make_bar(b, &r, support);
  int dofs = r.body.dofs;
  double c = speed_of(b), width = 0.06, h = 1.0 / b->elements, sum = 0.0;
  double *velocity = calloc((size_t)(dofs * r.body.nodes), sizeof *velocity);
  for (int32_t n = 0; n < r.body.nodes; n++) {
    double x = (r.blocks.mesh.xyz[3 * n] - 0.5) / width;
    velocity[dofs * n] = exp(-x * x);
  }
  r.options.velocity = velocity;
  r.options.step = 0.5 * h / c;
  rig_start(&r);
  rig_run(&r, (int)lround(0.15 / c / r.solver.step));
  double largest = width * sqrt(acos(-1.0)) / (2.0 * c);
  for (int32_t n = 0; n < r.body.nodes; n++) {
    double x = r.blocks.mesh.xyz[3 * n] - 0.5, way = c * r.solver.time;
    double u = 0.5 * largest * (erf((x + way) / width) - erf((x - way) / width));
    double off = (r.solver.u[dofs * n] - u) / largest;
    sum += off * off;
  }
  check_book(&r.solver, 1e-12);
  double error = sqrt(sum / r.body.nodes);
  rig_release(&r);
  free(velocity);
  for (int k = 0; k < (b->held ? 2 : 0); k++)
    drop(&support[k]);
  return error;
}

static void pulse_converges(bar b) {
  double error[3];
  for (int k = 0; k < 3; k++, b.elements *= 2)
    error[k] = pulse_error(&b);
  check_below(error[2], 1e-3); /* the wave is where its speed says */
  check_near(log2(error[0] / error[1]), 2.0, 0.05, 0.0);
  check_near(log2(error[1] / error[2]), 2.0, 0.03, 0.0);
}

static void free_bar_carries_the_bar_wave(void **state) {
  (void)state;
  pulse_converges((bar){.elements = 100});
}

static void held_bar_carries_the_pressure_wave(void **state) {
  (void)state;
  pulse_converges((bar){.solid = true, .held = true, .poisson = 0.3, .elements = 100});
}

/* Pressure p on the end from t = 0: front at ct, behind it velocity p/(rho c) and stress -p. The
 * front is some elements wide and rings: dispersion of third order spreads a jump like an Airy
 * function of width (h^2 t)^(1/3), whose oscillations die out as the power -3/4 of the distance.
 * The L1 error over the bar so falls as h^(1/2) (Hedstrom 1968), a little less while the shortest
 * waves cut the tail. */
static double sudden_error(int32_t elements, double *plateau, double *front) {
  rig r;
  bar b = {.elements = elements};
  cdem_fault fault = {0};
  make_bar(&b, &r, NULL);
  int32_t *facet;
  cdem_pressure pressure = {.name = "x0", .series = constant(1e6)};
  check_ok(cdem_blocks_group_facets(&r.blocks, "x0", &pressure.facets, &facet, &fault));
  pressure.facet = facet;
  r.options.pressures = 1;
  r.options.pressure = &pressure;
  double c = speed_of(&b), h = 1.0 / elements, v = 1e6 / (density * c), sum = 0.0;
  r.options.step = 0.5 * h / c;
  rig_start(&r);
  rig_run(&r, (int)lround(0.7 / c / r.solver.step));
  double *velocity = calloc((size_t)(2 * r.body.nodes), sizeof *velocity), mean = 0.0, count = 0.0;
  cdem_solver_velocity(&r.solver, velocity);
  *front = 0.0;
  for (int32_t n = 0; n < r.body.nodes; n++) {
    double x = r.blocks.mesh.xyz[3 * n], value = velocity[2 * n] / v;
    sum += fabs(value - (x < c * r.solver.time)) / r.body.nodes;
    if (x > 0.1 && x < 0.5) {
      mean += value;
      count += 1.0;
    }
    if (value > 0.5)
      *front = fmax(*front, x);
  }
  *plateau = mean / count;
  *front /= c * r.solver.time;
  check_book(&r.solver, 1e-3); /* the surface of the pressure moves with the body */
  free(velocity);
  free(facet);
  cdem_series_release(&pressure.series);
  rig_release(&r);
  return sum;
}

static void sudden_load_has_front_and_plateau(void **state) {
  (void)state;
  double plateau, front, coarse = sudden_error(100, &plateau, &front);
  double fine = sudden_error(400, &plateau, &front);
  check_near(plateau, 1.0, 0.0, 0.01);
  check_near(front, 1.0, 0.0, 0.01);
  check_below(fine, coarse / pow(4.0, 0.4));
}

/* A bell runs out through a quiet end; what comes back is the dispersion of the mesh. */
static void quiet_end_lets_out(bool solid) {
  rig r;
  bar b = {.solid = solid, .held = solid, .poisson = solid ? 0.25 : 0.0, .elements = 100};
  cdem_fault fault = {0};
  cdem_support support[2];
  make_bar(&b, &r, support);
  int32_t *facet[2];
  cdem_quiet quiet[2] = {{0}};
  double c = speed_of(&b), *impedance[2];
  for (int side = 0; side < 2; side++) {
    check_ok(cdem_blocks_group_facets(&r.blocks, side ? "x1" : "x0", &quiet[side].facets,
                                      &facet[side], &fault));
    impedance[side] = calloc((size_t)(2 * quiet[side].facets), sizeof(double));
    for (int32_t i = 0; i < quiet[side].facets; i++)
      impedance[side][2 * i] = density * c;
    quiet[side].facet = facet[side];
    quiet[side].impedance = impedance[side];
  }
  int dofs = r.body.dofs;
  double *velocity = calloc((size_t)(dofs * r.body.nodes), sizeof *velocity), largest = 0.0;
  for (int32_t n = 0; n < r.body.nodes; n++) {
    double x = (r.blocks.mesh.xyz[3 * n] - 0.5) / 0.1;
    velocity[dofs * n] = exp(-x * x);
  }
  r.options.velocity = velocity;
  r.options.quiets = 2;
  r.options.quiet = quiet;
  rig_start(&r);
  while (r.solver.time < 1.2 / c)
    rig_run(&r, 1);
  for (int32_t n = 0; n < dofs * r.body.nodes; n++)
    largest = fmax(largest, fabs(r.solver.v[n]));
  check_below(largest, 0.01 * 0.5); /* of the half bell that ran against the end */
  cdem_energy_book book = check_book(&r.solver, 1e-12);
  check_near(book.quiet, book.initial, 1e-3, 0.0);
  rig_release(&r);
  free(velocity);
  for (int k = 0; k < 2; k++) {
    free(facet[k]);
    free(impedance[k]);
    if (solid)
      drop(&support[k]);
  }
}

static void quiet_ends_absorb(void **state) {
  (void)state;
  quiet_end_lets_out(false);
  quiet_end_lets_out(true);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(free_bar_carries_the_bar_wave),
      cmocka_unit_test(held_bar_carries_the_pressure_wave),
      cmocka_unit_test(sudden_load_has_front_and_plateau),
      cmocka_unit_test(quiet_ends_absorb),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
