/* The limit of the step: safe, and not needlessly small. */
#include "solver_model.h"

/* Bonds between all neighbours of a periodic lattice. */
enum { SIDE = 6, BONDS = 3 * SIDE * SIDE * SIDE };

typedef struct {
  model m;
  cdem_cell cell;
  cdem_bond_law law;
  cdem_bond bond[BONDS];
} lattice;

/* Simple cubic (square in 2-D, a ring in 1-D) of bonded grains a diameter apart, slightly shaken.
 */
static void lattice_start(lattice *l, int axes, double ks, double damping, cdem_dem *dem) {
  const double r = 0.01, kn = 1e5;
  int dim = axes == 3 ? 3 : 2, count = 0, all = 1;
  cdem_fault fault = {0};
  cdem_random random = {.state = 3};
  model_init(&l->m, dim, "linear");
  model_word(&l->m, CDEM_LAW_damping_ratio, 0.0);
  l->cell = (cdem_cell){0};
  for (int c = 0; c < dim; c++) {
    l->cell.periodic[c] = c < axes;
    l->cell.h[4 * c] = c < axes ? SIDE * 2.0 * r : 1.0;
    all *= c < axes ? SIDE : 1;
  }
  l->cell.h[8] = dim == 3 ? l->cell.h[8] : 1.0;
  l->law =
      (cdem_bond_law){.normal_stiffness = kn, .shear_stiffness = ks * kn, .damping_ratio = damping};
  for (int k = 0; k < all; k++) {
    int at[3] = {k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE};
    int64_t i = model_add(&l->m, (2 * at[0] + 1) * r, (2 * at[1] + 1) * r,
                          dim == 3 ? (2 * at[2] + 1) * r : 0.0, r);
    for (int c = 0; c < axes; c++)
      l->m.grains.velocity[3 * i + c] = 1e-6 * cdem_random_uniform(&random, -1.0, 1.0);
    for (int c = 0, stride = 1; c < axes; c++, stride *= SIDE)
      l->bond[count++] =
          (cdem_bond){{k, at[c] + 1 < SIDE ? k + stride : k + stride - SIDE * stride}, 0};
  }
  l->m.options.cell = &l->cell;
  l->m.options.bond = l->bond;
  l->m.options.bonds = count;
  l->m.options.bond_law = &l->law;
  l->m.options.bond_laws = 1;
  l->m.options.energies = false;
  check_ok(cdem_dem_init(&l->m.options, dem, &fault));
}

/* Largest speed after some steps; infinite when the motion fails. */
static double speed_after(cdem_dem *dem, int64_t steps) {
  cdem_fault fault = {0};
  static double v[3 * SIDE * SIDE * SIDE];
  double most = 0.0;
  if (cdem_dem_steps(dem, steps, &fault) != CDEM_OK)
    return INFINITY;
  cdem_dem_look(dem, &(cdem_dem_view){.velocity = v});
  for (int64_t i = 0; i < 3 * dem->grains; i++)
    most = fmax(most, fabs(v[i]));
  return most;
}

/* At the limit the motion stays bounded (amplitudes may grow with the steps there, not
 * exponentially); above the exact one it does not. The exact one: staggered translations are the
 * stiffest motion, w^2 = 4 (kn + (axes - 1) ks)/m, which the bound finds to rounding, but for the
 * contact that might come. Neighbours in a row turn against each other with 4 ks r^2 axes/I: less,
 * with ks = 0.2 kn, but where the row has no others. */
static void lattices(void **state) {
  (void)state;
  static lattice l;
  for (int axes = 1; axes <= 3; axes++)
    for (int damped = 0; damped < 2; damped++) {
      const double ks = 0.2, zeta = damped ? 0.3 : 0.0, kn = 1e5;
      cdem_dem dem;
      cdem_fault fault = {0};
      lattice_start(&l, axes, ks, zeta, &dem);
      double mass[SIDE * SIDE * SIDE], limit;
      check_ok(cdem_dem_limit(&dem, &limit, NULL, &fault));
      cdem_dem_look(&dem, &(cdem_dem_view){.mass = mass});
      /* dashpots in the same way: (4 c)/m with c = 2 zeta sqrt(k m/2) */
      double w2 = 4.0 * (kn + (axes - 1) * ks * kn) / mass[0];
      double c = 4.0 * 2.0 * zeta * sqrt(0.5 * kn / mass[0]) * (1.0 + (axes - 1) * sqrt(ks));
      double exact = 4.0 / (c + sqrt(c * c + 4.0 * w2));
      assert_true(limit <= exact * (1.0 + 1e-12));
      assert_true(limit >= 0.5 * exact);
      check_ok(cdem_dem_set_step(&dem, limit, &fault));
      check_below(speed_after(&dem, 1000), 1e-3);
      dem.step = 1.2 * exact; /* behind the back of the check */
      assert_true(speed_after(&dem, 1000) > 1.0);
      cdem_dem_release(&dem);
      model_release(&l.m);
    }
}

/* A pair with a normal dashpot alone, frictionless: k dt^2/m + 2 c dt/m = 4 exactly. And a step
 * that is chosen with strong dashpots is not a small part of that. */
static void a_damped_pair_has_its_exact_limit(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  const double kn = 1e5, zeta = 0.4;
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_damping_ratio, zeta);
  model_word(&m, CDEM_LAW_shear_stiffness, 0.0);
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.0, 0.0, 0.013, 0.005);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  double mass[2];
  cdem_dem_look(&dem, &(cdem_dem_view){.mass = mass});
  double both = mass[0] * mass[1] / (mass[0] + mass[1]), k = kn / both;
  double c = 2.0 * zeta * sqrt(k), dt;
  check_ok(cdem_dem_limit(&dem, &dt, NULL, &fault));
  check_near(k * dt * dt + 2.0 * c * dt, 4.0, 1e-12, 0.0);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* Grains of sizes 1:3, bonded to their neighbours in a shaken lattice, with dashpots: at the limit
 * stable, at twice the limit not. So the bound is within a factor of two of the exact one. */
static void a_cluster_is_bounded_within_two(void **state) {
  (void)state;
  model m;
  cdem_bond bond[3 * 64];
  cdem_bond_law law = {.normal_stiffness = 1e5, .shear_stiffness = 5e4, .damping_ratio = 0.2};
  int count = 0;
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_damping_ratio, 0.0);
  model_heap(&m, 4, 3.0, 1e-6, 3);
  for (int32_t i = 0; i < 64; i++)
    for (int c = 0, stride = 1; c < 3; c++, stride *= 4)
      if (i / stride % 4 < 3)
        bond[count++] = (cdem_bond){{i, i + stride}, 0};
  m.options.bond = bond;
  m.options.bonds = count;
  m.options.bond_law = &law;
  m.options.bond_laws = 1;
  m.options.energies = false;
  for (int twice = 0; twice < 2; twice++) {
    cdem_dem dem;
    cdem_fault fault = {0};
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    double limit;
    check_ok(cdem_dem_limit(&dem, &limit, NULL, &fault));
    check_ok(cdem_dem_set_step(&dem, limit, &fault));
    dem.step *= twice ? 2.0 : 1.0;
    double speed = speed_after(&dem, 400);
    assert_true(twice ? speed > 1.0 : speed < 1e-4);
    cdem_dem_release(&dem);
  }
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lattices),
      cmocka_unit_test(a_damped_pair_has_its_exact_limit),
      cmocka_unit_test(a_cluster_is_bounded_within_two),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
