/* Bonds: the moduli of a bonded lattice, waves in it, what breaks. */
#include "solver_model.h"

static const cdem_bond_law springs = {.normal_stiffness = 2.5e5, .shear_stiffness = 5e4};

static int bonds_of(const cdem_grains *g, double side, cdem_bond *bond) {
  int count = 0;
  for (int32_t i = 0; i < g->grains; i++)
    for (int32_t j = i + 1; j < g->grains; j++) {
      double d[2];
      for (int c = 0; c < 2; c++) {
        d[c] = g->xyz[3 * j + c] - g->xyz[3 * i + c];
        d[c] -= side * round(d[c] / side);
      }
      if (hypot(d[0], d[1]) < 1.01 * (g->radius[i] + g->radius[j]))
        bond[count++] = (cdem_bond){{i, j}, 0};
    }
  return count;
}

/* The lattice at +-45 degrees has D11 = NV (kN + kS), D12 = NV (kN - kS), NV = N r^2/V = 1/2. */
static void test_moduli(void **state) {
  (void)state;
  const double r = 0.01, s = sqrt(2.0) * r, rate = 1e-3;
  const int side = 12;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_bond bond[4 * 144];
  double zero = 0.0, value = rate;
  cdem_cell cell = {.periodic = {true, true}, .h = {side * s, 0, 0, 0, side * s, 0, 0, 0, 1.0}};
  cell.rate[0] = (cdem_series){.points = 1, .time = &zero, .value = &value};
  model_init(&m, 2, "linear");
  model_word(&m, CDEM_LAW_damping_ratio, 0.0);
  for (int j = 0; j < side; j++)
    for (int i = j % 2; i < side; i += 2) {
      int64_t k = model_add(&m, (i + 0.5) * s, (j + 0.5) * s, 0.0, r);
      model_move(&m, k, rate * (i + 0.5) * s, 0.0, 0.0);
    }
  m.options.cell = &cell;
  m.options.bond = bond;
  m.options.bonds = bonds_of(&m.grains, side * s, bond);
  m.options.bond_law = &springs;
  m.options.bond_laws = 1;
  assert_int_equal(m.options.bonds, 2 * m.grains.grains);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, 20, &fault));
  double strain = rate * dem.time, stress[4] = {0};
  cdem_dem_contact *contact;
  int64_t contacts;
  check_ok(cdem_dem_contacts(&dem, &contacts, &contact, &fault));
  assert_int_equal(contacts, m.options.bonds);
  for (int64_t k = 0; k < contacts; k++)
    for (int c = 0; c < 4; c++)
      stress[c] += contact[k].force[c / 2] * contact[k].branch[c % 2] / (side * s * side * s);
  double kn = springs.normal_stiffness, ks = springs.shear_stiffness;
  check_near(stress[0] / strain, 0.5 * (kn + ks), 10.0 * strain, 0.0); /* up to the strain itself */
  check_near(stress[3] / strain, 0.5 * (kn - ks), 10.0 * strain, 0.0);
  check_near(stress[1] / strain, 0.0, 0.0, 1e-9 * kn);
  free(contact);
  cdem_dem_energies e;
  check_below(energy_error(&dem, &e), 1e-6);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* A free grain hangs on a driven one that is drawn away: the bond breaks at its strength and what
 * it held is booked as broken. */
static void test_break(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_dem_energies e;
  cdem_bond_law law = springs;
  cdem_bond bond = {{0, 1}, 0};
  law.tension = 50.0;
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_damping_ratio, 0.0);
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.02, 0.0, 0.0, 0.01);
  m.grains.motion[0] = CDEM_GRAIN_DRIVEN;
  model_move(&m, 0, -3.0, 0.0, 0.0);
  m.options.bond = &bond;
  m.options.bonds = 1;
  m.options.bond_law = &law;
  m.options.bond_laws = 1;
  m.options.safety = 0.01;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  while (cdem_dem_bonds_broken(&dem) == 0 && dem.steps < 2000)
    check_ok(cdem_dem_step(&dem, &fault));
  assert_int_equal(cdem_dem_bonds_broken(&dem), 1);
  cdem_dem_energies_now(&dem, &e);
  /* within the step in which it broke */
  check_near(e.broken, 0.5 * law.tension * law.tension / law.normal_stiffness, 0.2, 0.0);
  check_below(fabs(e.error) / e.exchange, 1e-9); /* linear: exact, in the step of breaking too */
  check_near(e.bond, 0.0, 0.0, 0.0);
  check_ok(cdem_dem_steps(&dem, 20, &fault));
  int64_t contacts;
  cdem_dem_contact *contact;
  check_ok(cdem_dem_contacts(&dem, &contacts, &contact, &fault));
  assert_int_equal(contacts, 0);
  free(contact);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* A bonded cluster in free flight keeps both momenta and its energy; restart goes on to the bit. */
static void test_flight(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    model m;
    cdem_dem dem, again;
    cdem_fault fault = {0};
    cdem_state saved = {0};
    cdem_bond bond[27 * 3];
    int count = 0, side = dim == 2 ? 5 : 3;
    cdem_bond_law law = springs;
    law.rolling_stiffness = law.twisting_stiffness = 1.0;
    model_init(&m, dim, "linear");
    model_word(&m, CDEM_LAW_damping_ratio, 0.0);
    model_heap(&m, side, 1.5, 0.05, 9);
    for (int32_t i = 0; i < m.grains.grains; i++) /* along the axes of the lattice */
      for (int c = 0; c < dim; c++) {
        int stride = c == 0 ? 1 : c == 1 ? side : side * side;
        if (i / stride % side < side - 1)
          bond[count++] = (cdem_bond){{i + stride, i}, 0};
      }
    m.options.bond = bond;
    m.options.bonds = count;
    m.options.bond_law = &law;
    m.options.bond_laws = 1;
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    check_ok(cdem_dem_set_step(&dem, 0.1 * dem.step, &fault));
    double before[2][3], after[2][3];
    cdem_dem_energies e;
    cdem_dem_momentum(&dem, before[0], before[1]);
    check_ok(cdem_dem_steps(&dem, 150, &fault));
    cdem_dem_momentum(&dem, after[0], after[1]);
    check_below(energy_error(&dem, &e), 1e-3);
    assert_true(e.bond > 0.0);
    for (int c = 0; c < 3; c++) {
      check_near(after[0][c], before[0][c], 0.0, 1e-12 * sqrt(e.exchange));
      check_near(after[1][c], before[1][c], 0.0, 1e-12 * sqrt(e.exchange));
    }
    check_ok(cdem_dem_init(&m.options, &again, &fault));
    check_ok(cdem_dem_save(&dem, &saved, &fault));
    check_ok(cdem_dem_restore(&again, &saved, &fault));
    check_ok(cdem_dem_steps(&dem, 50, &fault));
    check_ok(cdem_dem_steps(&again, 50, &fault));
    cdem_dem_momentum(&dem, before[0], before[1]);
    cdem_dem_momentum(&again, after[0], after[1]);
    assert_memory_equal(before, after, sizeof before);
    /* A bond of a grain that is not there, a step that is none. */
    *(int32_t *)cdem_state_find(&saved, "dem/bonds")->data = (int32_t)m.grains.grains;
    check_fails(cdem_dem_restore(&again, &saved, &fault), CDEM_INPUT,
                "bond 0 of the checkpoint cannot be: it joins grains");
    double *reals = cdem_state_find(&saved, "dem/reals")->data, skin = reals[7];
    for (int k = 0; k < 2; k++) { /* the skin is automatic */
      reals[7] = k == 0 ? -skin : 20.0 * skin;
      check_fails(cdem_dem_restore(&again, &saved, &fault), CDEM_INPUT, "has a skin of ");
    }
    reals[7] = skin;
    reals[1] = 0.0;
    check_fails(cdem_dem_restore(&again, &saved, &fault), CDEM_INPUT,
                "steps of 0 s, which cannot be");
    cdem_dem_release(&dem);
    cdem_dem_release(&again);
    cdem_state_release(&saved);
    model_release(&m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_moduli),
      cmocka_unit_test(test_break),
      cmocka_unit_test(test_flight),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
