/* The solver in a periodic cell: affine crystals, balances through the faces, no preferred place.
 */
#include "dem/solver_model.h"

enum { SIDE = 4, GRAINS = SIDE * SIDE * SIDE };
static const double radius = 0.5, spacing = 0.95, stiffness = 1e5;

typedef struct {
  model m;
  cdem_cell cell;
  cdem_dem dem;
} model_in_cell;

/* A simple cubic crystal that already moves with the velocity gradient. */
static void crystal_start(model_in_cell *c, const double l[9]) {
  cdem_fault fault = {0};
  model_init(&c->m, 3, "linear");
  model_word(&c->m, CDEM_LAW_damping_ratio, 0.0);
  model_word(&c->m, CDEM_LAW_shear_ratio, 0.0);
  model_word(&c->m, CDEM_LAW_friction, 0.0);
  c->cell = (cdem_cell){.periodic = {true, true, true}, .corner = {-1.0, 0.25, 3.0}};
  for (int k = 0; k < 9; k++)
    if (l[k] != 0.0)
      check_ok(cdem_series_constant(l[k], &c->cell.rate[k], &fault));
  for (int r = 0; r < 3; r++)
    c->cell.h[4 * r] = SIDE * spacing;
  for (int k = 0; k < GRAINS; k++) {
    double at[3] = {spacing * (k % SIDE), spacing * (k / SIDE % SIDE), spacing * (k / SIDE / SIDE)};
    model_add(&c->m, at[0] - 0.8, at[1] + 0.4, at[2] + 3.2, radius);
  }
  for (int k = 0; k < GRAINS; k++)
    for (int r = 0; r < 3; r++)
      c->m.grains.velocity[3 * k + r] = cdem_dot3(l + 3 * r, c->m.grains.xyz + 3 * k);
  c->m.options.cell = &c->cell;
  c->m.options.step = 1e-4;
  check_ok(cdem_dem_init(&c->m.options, &c->dem, &fault));
}

static void cell_release(model_in_cell *c) {
  cdem_dem_release(&c->dem);
  cdem_grains_release(&c->m.grains);
  for (int k = 0; k < 9; k++)
    cdem_series_release(&c->cell.rate[k]);
}

/* -1/V sum of f (x) branch over contacts, f on A, branch to B; the affine value: contacts of the
 * lattice h/SIDE n with all short n, force k overlap along the branch. */
static void check_affine(const model_in_cell *c, double *largest) {
  cdem_fault fault = {0};
  int64_t contacts;
  cdem_dem_contact *contact;
  check_ok(cdem_dem_contacts(&c->dem, &contacts, &contact, &fault));
  double stress[9] = {0.0}, affine[9] = {0.0}, scale = 0.0;
  for (int64_t k = 0; k < contacts; k++)
    for (int r = 0; r < 3; r++)
      for (int q = 0; q < 3; q++)
        stress[3 * r + q] += contact[k].force[r] * contact[k].branch[q];
  free(contact);
  const cdem_cell *cell = cdem_dem_cell(&c->dem);
  int64_t expected = 0;
  for (int n = 0; n < 343; n++) {
    double branch[3], number[3] = {n % 7 - 3.0, n / 7 % 7 - 3.0, n / 49 - 3.0};
    for (int r = 0; r < 3; r++)
      branch[r] = cdem_dot3(cell->h + 3 * r, number) / SIDE;
    double length = cdem_norm3(branch), overlap = 2.0 * radius - length;
    if (length == 0.0 || overlap <= 0.0)
      continue;
    expected += GRAINS;
    for (int r = 0; r < 3; r++)
      for (int q = 0; q < 3; q++) /* each contact twice: n and -n */
        affine[3 * r + q] -= 0.5 * GRAINS * stiffness * overlap * branch[r] / length * branch[q];
  }
  assert_int_equal(2 * contacts, expected);
  for (int k = 0; k < 9; k++)
    scale = fmax(scale, fabs(affine[k]));
  for (int k = 0; k < 9; k++)
    check_near(stress[k], affine[k], 0.0, 1e-6 * scale);
  *largest = fmax(*largest, fmax(fabs(cell->h[1]), fabs(cell->h[5])) / (SIDE * spacing));
}

/* Shear of 1.6: the crystal stays affine while the cell flips, nothing pulls at it,
 * and the work of the cell is what is stored. Fast enough that rounding does not find the modes in
 * which a sheared crystal is unstable. */
static void test_affine(void **state) {
  (void)state;
  /* L L = 0: an affine motion needs no forces. */
  static const double l[2][9] = {{0, 40, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 20, 0, 0, 35, 0, 0, 0}};
  for (int k = 0; k < 2; k++) {
    model_in_cell c = {0};
    cdem_fault fault = {0};
    crystal_start(&c, l[k]);
    double lean = 0.0;
    for (int part = 0; part < 8; part++) {
      check_ok(cdem_dem_steps(&c.dem, 50, &fault));
      check_affine(&c, &lean);
    }
    check_below(lean, 0.62); /* half an edge, and what is sheared between builds */
    static double force[3 * GRAINS];
    cdem_dem_view view = {.force = force};
    cdem_dem_look(&c.dem, &view);
    for (int i = 0; i < 3 * GRAINS; i++)
      check_near(force[i], 0.0, 0.0, 1e-6 * stiffness * radius);
    cdem_dem_energies e;
    cdem_dem_energies_now(&c.dem, &e);
    check_below(fabs(e.error), 1e-3 * e.exchange);
    cell_release(&c);
  }
}

/* ---- a gas of soft grains ---- */

enum { MOLECULES = 60 };

static void gas_start(model_in_cell *g, const double shift[3], const double rate[2]) {
  cdem_fault fault = {0};
  cdem_random random = {17};
  model_init(&g->m, 3, "linear");
  model_word(&g->m, CDEM_LAW_damping_ratio, 0.02);
  model_word(&g->m, CDEM_LAW_shear_ratio, 0.5);
  model_word(&g->m, CDEM_LAW_friction, 0.4);
  g->cell = (cdem_cell){.periodic = {true, true, true},
                        .h = {4.2, 0.9, -0.6, 0.0, 4.0, 0.7, 0.0, 0.0, 4.1}};
  for (int r = 0; r < 3 && rate != NULL; r++)
    check_ok(cdem_series_constant(rate[0], &g->cell.rate[4 * r], &fault));
  if (rate != NULL)
    check_ok(cdem_series_constant(rate[1], &g->cell.rate[1], &fault));
  for (int k = 0; k < MOLECULES; k++) {
    double n[3] = {k % 4 / 4.0, k / 4 % 4 / 4.0, k / 16 / 4.0}, at[3];
    for (int r = 0; r < 3; r++)
      at[r] = cdem_dot3(g->cell.h + 3 * r, n) + cdem_random_uniform(&random, 0.0, 0.1);
    model_add(&g->m, at[0] + shift[0], at[1] + shift[1], at[2] + shift[2],
              cdem_random_uniform(&random, 0.3, 0.45));
  }
  for (int k = 0; k < 3 * MOLECULES; k++)
    g->m.grains.velocity[k] = cdem_random_uniform(&random, -2.0, 2.0);
  g->m.options.cell = &g->cell;
  g->m.options.step = 5e-4;
  check_ok(cdem_dem_init(&g->m.options, &g->dem, &fault));
}

/* Momentum goes through the faces; energy too. */
static void test_balances(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static const double here[3] = {0};
  model_in_cell g = {0};
  gas_start(&g, here, NULL);
  double before[3], after[3], spin[3];
  cdem_dem_momentum(&g.dem, before, spin);
  check_ok(cdem_dem_steps(&g.dem, 2000, &fault));
  cdem_dem_momentum(&g.dem, after, spin);
  for (int c = 0; c < 3; c++) /* against the momentum of one direction, m v of all */
    check_near(after[c], before[c], 0.0, 1e-12 * MOLECULES * 2500.0 * 0.38 * 2.0);
  cdem_dem_energies e;
  cdem_dem_energies_now(&g.dem, &e);
  assert_true(e.friction > 0.01 * e.initial);
  check_below(fabs(e.error), 1e-3 * e.exchange);
  cell_release(&g);
}

/* Work of a cell that is pressed and sheared. */
static void test_work(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static const double here[3] = {0};
  model_in_cell g = {0};
  gas_start(&g, here, (double[2]){-0.4, 0.6});
  check_ok(cdem_dem_steps(&g.dem, 1500, &fault));
  cdem_dem_energies e;
  cdem_dem_energies_now(&g.dem, &e);
  assert_true(e.cell > 0.1 * e.initial);
  check_below(fabs(e.error), 1e-3 * e.exchange);
  check_near(cdem_cell_volume(3, cdem_dem_cell(&g.dem)), 4.2 * 4.0 * 4.1 * exp(-1.2 * 0.75), 1e-6,
             0.0);
  cell_release(&g);
}

/* Wherever the grains are in the cell, the same happens. Differences are rounding, multiplied by
 * collisions. */
static void test_translation(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static const double here[3] = {0}, there[3] = {1.7, -23.1, 2.9};
  model_in_cell a = {0}, b = {0};
  gas_start(&a, here, NULL);
  gas_start(&b, there, NULL);
  check_ok(cdem_dem_steps(&a.dem, 400, &fault));
  check_ok(cdem_dem_steps(&b.dem, 400, &fault));
  static double x[2][3 * MOLECULES], v[2][3 * MOLECULES];
  cdem_dem_look(&a.dem, &(cdem_dem_view){.xyz = x[0], .velocity = v[0]});
  cdem_dem_look(&b.dem, &(cdem_dem_view){.xyz = x[1], .velocity = v[1]});
  for (int k = 0; k < MOLECULES; k++) {
    double d[3];
    for (int c = 0; c < 3; c++)
      d[c] = x[1][3 * k + c] - x[0][3 * k + c] - there[c];
    cdem_cell_nearest(&a.cell, d);
    check_below(cdem_norm3(d), 1e-9);
    for (int c = 0; c < 3; c++)
      check_near(v[1][3 * k + c], v[0][3 * k + c], 0.0, 1e-8);
  }
  cell_release(&a);
  cell_release(&b);
}

/* Saved in the middle of a flow and gone on with: the same bits. */
static void test_checkpoint(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static const double l[9] = {0, 40, 0, 0, 0, 0, 0, 0, 0};
  for (int steps = 90; steps < 150; steps += 19) {
    model_in_cell a = {0}, b = {0};
    cdem_state saved = {0};
    crystal_start(&a, l);
    crystal_start(&b, l);
    check_ok(cdem_dem_steps(&a.dem, steps, &fault));
    check_ok(cdem_dem_save(&a.dem, &saved, &fault));
    check_ok(cdem_dem_restore(&b.dem, &saved, &fault));
    check_ok(cdem_dem_steps(&a.dem, 60, &fault));
    check_ok(cdem_dem_steps(&b.dem, 60, &fault));
    static double x[2][3 * GRAINS], v[2][3 * GRAINS];
    cdem_dem_look(&a.dem, &(cdem_dem_view){.xyz = x[0], .velocity = v[0]});
    cdem_dem_look(&b.dem, &(cdem_dem_view){.xyz = x[1], .velocity = v[1]});
    assert_memory_equal(x[0], x[1], sizeof x[0]);
    assert_memory_equal(v[0], v[1], sizeof v[0]);
    cdem_state_release(&saved);
    cell_release(&a);
    cell_release(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_affine), cmocka_unit_test(test_balances), cmocka_unit_test(test_work),
      cmocka_unit_test(test_translation), cmocka_unit_test(test_checkpoint)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
