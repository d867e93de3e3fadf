/* Special cases of the solver: reports at the start, several materials, little or nothing to do,
 * memory that runs out, restarts in the middle of things. */
#include "base/memory.h"
#include "solver_model.h"

static void lossy(model *m, int dim, const char *law) {
  model_init(m, dim, law);
  model_word(m, CDEM_LAW_friction, 0.4);
  if (strcmp(law, "li-chu") == 0)
    model_word(m, CDEM_LAW_normal_dashpot, 20.0);
  else
    model_word(m, CDEM_LAW_restitution, 0.5);
}

/* Forces of the contacts, added up, are those of the grains. */
static void check_sums(const cdem_dem *dem) {
  cdem_fault fault = {0};
  cdem_dem_contact *contact;
  int64_t contacts;
  double *sum = calloc((size_t)(6 * dem->grains), sizeof *sum), *force = sum + 3 * dem->grains;
  double largest = 0.0;
  cdem_dem_look(dem, &(cdem_dem_view){.force = force});
  check_ok(cdem_dem_contacts(dem, &contacts, &contact, &fault));
  assert_true(contacts > 0);
  for (int64_t k = 0; k < contacts; k++)
    for (int c = 0; c < 3; c++) {
      sum[3 * contact[k].a + c] += contact[k].force[c];
      if (contact[k].b >= 0)
        sum[3 * contact[k].b + c] -= contact[k].force[c];
      largest = fmax(largest, fabs(contact[k].force[c]));
    }
  for (int64_t i = 0; i < 3 * dem->grains; i++)
    check_near(sum[i], force[i], 0.0, 1e-12 * largest);
  free(contact);
  free(sum);
}

/* At the start and after a change of step too, when velocities are set back to another half step
 * than that of the forces. A pair at rest at t = 0 pushes with kn d alone, dashpot or not. */
static void contacts_report_the_forces_there_are(void **state) {
  (void)state;
  model m;
  cdem_dem dem, again;
  cdem_fault fault = {0};
  cdem_state saved = {0};
  cdem_dem_contact *contact;
  int64_t contacts;
  lossy(&m, 3, "linear");
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.0, 0.0199, 0.0, 0.01);
  m.options.gravity[1] = -9.81;
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_contacts(&dem, &contacts, &contact, &fault));
  assert_int_equal(contacts, 1);
  check_near(contact->push, 1e5 * 1e-4, 1e-12, 0.0);
  free(contact);
  check_sums(&dem);
  check_ok(cdem_dem_init(&m.options, &again, &fault));
  check_ok(cdem_dem_steps(&again, 3, &fault));
  check_ok(cdem_dem_save(&dem, &saved, &fault));
  check_ok(cdem_dem_restore(&again, &saved, &fault));
  check_sums(&again);
  cdem_dem_release(&again);
  check_ok(cdem_dem_steps(&dem, 3, &fault));
  check_sums(&dem);
  check_ok(cdem_dem_set_step(&dem, 0.3 * dem.step, &fault));
  check_sums(&dem);
  check_ok(cdem_dem_steps(&dem, 3, &fault));
  check_sums(&dem);
  cdem_state_release(&saved);
  cdem_dem_release(&dem);
  model_release(&m);
}

/* Trajectories of elastic grains: second order in the step from the start on. A grain thrown at an
 * angle that swings on a bond, against the same with much shorter steps. */
static void paths_are_of_second_order(void **state) {
  (void)state;
  model m;
  cdem_bond bond = {{0, 1}, 0};
  cdem_bond_law law = {.normal_stiffness = 1e5, .shear_stiffness = 3e4, .rolling_stiffness = 1.0};
  double x[3][6];
  model_init(&m, 3, "linear");
  model_word(&m, CDEM_LAW_damping_ratio, 0.0);
  model_add(&m, 0.0, 0.0, 0.0, 0.01);
  model_add(&m, 0.02, 0.001, 0.0, 0.008);
  model_move(&m, 1, 0.3, 0.2, -0.1);
  m.options.bond = &bond;
  m.options.bonds = 1;
  m.options.bond_law = &law;
  m.options.bond_laws = 1;
  for (int k = 0; k < 3; k++) {
    cdem_dem dem;
    cdem_fault fault = {0};
    const int steps[3] = {50, 100, 1600};
    m.options.step = 5e-4 / steps[k];
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    check_ok(cdem_dem_steps(&dem, steps[k], &fault));
    cdem_dem_look(&dem, &(cdem_dem_view){.xyz = x[k]});
    cdem_dem_release(&dem);
  }
  double coarse = 0.0, fine = 0.0;
  for (int c = 0; c < 6; c++) {
    coarse = fmax(coarse, fabs(x[0][c] - x[2][c]));
    fine = fmax(fine, fabs(x[1][c] - x[2][c]));
  }
  assert_true(coarse > 0.0 && fine < 0.27 * coarse && fine > 0.23 * coarse);
  model_release(&m);
}

/* Three materials, every pair of its own stiffness and friction, in a box of a fourth pairing:
 * batches against one contact at a time. */
static void three_materials_meet(void **state) {
  (void)state;
  static const char *const laws[] = {"linear", "hertz", "mindlin", "li-chu"};
  for (int k = 0; k < 4; k++) {
    model m;
    double x[2][3 * 64], v[2][3 * 64], w[2][3 * 64];
    int dim = k == 3 ? 2 : 3, side = dim == 2 ? 8 : 4;
    lossy(&m, dim, laws[k]);
    m.options.materials = 3;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        cdem_contact_input *input = &m.contact[3 * a + b];
        if (!isnan(input->value[CDEM_LAW_normal_stiffness]))
          input->value[CDEM_LAW_normal_stiffness] *= 1.0 + 0.3 * (a + b) + 0.2 * a * b;
        input->value[CDEM_LAW_friction] = 0.2 + 0.1 * (a + b) + 0.05 * a * b;
      }
    m.material[1].density = 1000.0;
    m.material[2].young = 3e7;
    model_heap(&m, side, 1.3, 0.05, 5);
    for (int i = 0; i < 64; i++)
      m.grains.material[i] = i % 3;
    model_box(&m, side);
    for (int i = 0; i < m.options.walls; i++)
      m.wall[i].material = i % 3;
    for (int plain = 0; plain < 2; plain++) {
      cdem_dem dem;
      cdem_fault fault = {0};
      m.options.reference = plain;
      check_ok(cdem_dem_init(&m.options, &dem, &fault));
      check_ok(cdem_dem_steps(&dem, 30, &fault));
      cdem_dem_look(&dem,
                    &(cdem_dem_view){.xyz = x[plain], .velocity = v[plain], .spin = w[plain]});
      cdem_dem_release(&dem);
    }
    double spin = 0.0, speed = 0.0;
    for (int i = 0; i < 3 * 64; i++) {
      spin = fmax(spin, fabs(w[0][i]));
      speed = fmax(speed, fabs(v[0][i]));
    }
    for (int i = 0; i < 3 * 64; i++) { /* rounding, over a few steps */
      check_near(x[0][i], x[1][i], 0.0, 1e-13);
      check_near(v[0][i], v[1][i], 0.0, 1e-10 * speed);
      check_near(w[0][i], w[1][i], 0.0, 1e-10 * spin);
    }
    model_release(&m);
  }
}

/* A grain pressed on a plane that is pushed sideways: below friction times the push it sticks,
 * above it slides, and the list says so, whatever the law. */
static void sliding_means_the_friction_bound(void **state) {
  (void)state;
  static const char *const laws[] = {"linear", "hertz", "mindlin", "li-chu"};
  for (int k = 0; k < 4; k++)
    for (int slides = 0; slides < 2; slides++) {
      model m;
      cdem_dem dem;
      cdem_fault fault = {0};
      cdem_dem_contact *contact;
      int64_t contacts;
      int dim = k == 3 ? 2 : 3;
      lossy(&m, dim, laws[k]);
      if (k < 3)
        model_word(&m, CDEM_LAW_restitution, 1.0); /* no dashpots */
      else { /* a rolling force beside the sliding one, with a bound of its own */
        model_word(&m, CDEM_LAW_rolling_force_stiffness, 1e4);
        model_word(&m, CDEM_LAW_rolling_force_friction, 0.05);
      }
      model_add(&m, 0.0, 0.0099, 0.0, 0.01);
      m.grains.spin[2] = k < 3 ? 0.0 : 10.0;
      m.grains.motion[0] = CDEM_GRAIN_DRIVEN;
      model_move(&m, 0, 1.0, 0.0, 0.0);
      model_plane(&m, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0);
      m.options.step = 1e-8;
      check_ok(cdem_dem_init(&m.options, &dem, &fault));
      /* k_s s against mu F_N: with 2 s/R about 1e-5 m it sticks, with 3e-4 m it slides */
      check_ok(cdem_dem_steps(&dem, slides ? 30000 : 30, &fault));
      check_ok(cdem_dem_contacts(&dem, &contacts, &contact, &fault));
      assert_int_equal(contacts, 1);
      double held = fabs(contact->force[0]) / contact->push;
      assert_true(contact->sliding == (slides == 1));
      check_near(held, slides ? 0.4 : 0.0, 0.0, !slides ? 0.1 : k < 3 ? 1e-9 : 0.05 + 1e-9);
      free(contact);
      cdem_dem_release(&dem);
      model_release(&m);
    }
}

/* One grain, no gravity; many grains that never touch; one far away. */
static void nothing_happens_to_lone_grains(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_fault fault = {0};
  cdem_dem_energies e;
  double x[9], v[9];
  lossy(&m, 3, "linear");
  model_add(&m, 1.0, 2.0, 3.0, 0.01);
  for (int grains = 1; grains <= 3; grains += 2) {
    if (grains == 3) {
      model_add(&m, 1.5, 2.0, 3.0, 0.02);
      model_add(&m, 1e6, -1e6, 3.0, 0.005); /* far away and at rest */
      model_move(&m, 1, 0.25, 0.0, 0.0);
    }
    check_ok(cdem_dem_init(&m.options, &dem, &fault));
    check_ok(cdem_dem_steps(&dem, 1000, &fault));
    cdem_dem_look(&dem, &(cdem_dem_view){.xyz = x, .velocity = v});
    for (int i = 0; i < 3 * grains; i++)
      check_near(x[i], m.grains.xyz[i] + m.grains.velocity[i] * dem.time, 1e-13, 0.0);
    assert_true(v[0] == 0.0 && x[0] == 1.0);
    cdem_dem_energies_now(&dem, &e);
    check_near(e.error, 0.0, 0.0, 1e-14 * e.exchange);
    assert_true(cdem_dem_unbalanced(&dem) == 0.0);
    cdem_dem_release(&dem);
  }
  model_release(&m);
}

/* ---- memory ---- */

static void busy(model *m, cdem_bond_law *law, cdem_bond *bond) {
  lossy(m, 3, "linear");
  m->options.rolling = cdem_rolling_find("spring");
  model_word(m, CDEM_LAW_rolling_friction, 0.1);
  model_heap(m, 3, 1.2, 0.5, 5);
  model_box(m, 3);
  m->grains.motion[13] = CDEM_GRAIN_DRIVEN;
  *law = (cdem_bond_law){.normal_stiffness = 1e5, .tension = 1.0};
  bond[0] = (cdem_bond){{0, 1}, 0};
  bond[1] = (cdem_bond){{4, 5}, 0};
  m->options.bond = bond;
  m->options.bonds = 2;
  m->options.bond_law = law;
  m->options.bond_laws = 1;
}

/* Every allocation of the start, the steps and the reports fails once: an error, and nothing left
 * behind. */
static void memory_may_run_out_anywhere(void **state) {
  (void)state;
  model m;
  cdem_bond_law law;
  cdem_bond bond[2];
  bool done = false;
  int failures = 0;
  busy(&m, &law, bond);
  for (int64_t n = 0; !done; n++) {
    cdem_dem dem;
    cdem_fault fault = {0};
    cdem_state saved = {0};
    cdem_dem_contact *contact = NULL;
    int64_t contacts;
    cdem_memory_fail_after(n);
    cdem_status status = cdem_dem_init(&m.options, &dem, &fault);
    bool began = status == CDEM_OK;
    if (status == CDEM_OK)
      status = cdem_dem_want_applied(&dem, &fault);
    if (status == CDEM_OK)
      status = cdem_dem_steps(&dem, 150, &fault);
    if (status == CDEM_OK)
      status = cdem_dem_contacts(&dem, &contacts, &contact, &fault);
    if (status == CDEM_OK)
      status = cdem_dem_save(&dem, &saved, &fault);
    if (status == CDEM_OK)
      status = cdem_dem_restore(&dem, &saved, &fault);
    cdem_memory_fail_after(-1);
    done = status == CDEM_OK;
    assert_true(done || status == CDEM_MEMORY);
    assert_true(began || dem.store == NULL);
    failures += !done;
    free(contact);
    cdem_state_release(&saved);
    cdem_dem_release(&dem);
  }
  assert_true(failures > 50);
  model_release(&m);
}

/* Saved again and again while bonds break, a wall moves and another one follows a force: each goes
 * on to the same bits, lists of contacts and books included. */
static void restarts_in_the_middle_of_things(void **state) {
  (void)state;
  model m;
  cdem_bond_law law;
  cdem_bond bond[2];
  cdem_dem dem;
  cdem_fault fault = {0};
  double zero = 0.0, speed = 0.3, wanted = -50.0;
  busy(&m, &law, bond);
  m.wall[0].velocity[0] = (cdem_series){.points = 1, .time = &zero, .value = &speed};
  m.wall[3].servo[1] = 1.0;
  m.wall[3].servo_speed = 0.2;
  m.wall[3].servo_force = (cdem_series){.points = 1, .time = &zero, .value = &wanted};
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  int64_t broken = 0;
  for (int round = 0; round < 6; round++) {
    cdem_dem again;
    cdem_state saved = {0};
    cdem_dem_energies e, f;
    cdem_dem_contact *a, *b;
    int64_t count[2];
    check_ok(cdem_dem_steps(&dem, 1 + 7 * round, &fault));
    check_ok(cdem_dem_save(&dem, &saved, &fault));
    check_ok(cdem_dem_init(&m.options, &again, &fault));
    check_ok(cdem_dem_restore(&again, &saved, &fault));
    for (int later = 0; later < 2; later++) {
      cdem_dem_energies_now(&dem, &e);
      cdem_dem_energies_now(&again, &f);
      assert_memory_equal(&e, &f, sizeof e);
      check_ok(cdem_dem_contacts(&dem, &count[0], &a, &fault));
      check_ok(cdem_dem_contacts(&again, &count[1], &b, &fault));
      assert_int_equal(count[0], count[1]);
      for (int64_t k = 0; k < count[0]; k++) {
        assert_memory_equal(a[k].force, b[k].force, sizeof a[k].force);
        assert_true(a[k].a == b[k].a && a[k].b == b[k].b && a[k].sliding == b[k].sliding);
      }
      free(a);
      free(b);
      if (later == 0) {
        check_ok(cdem_dem_steps(&dem, 60, &fault));
        check_ok(cdem_dem_steps(&again, 60, &fault));
      }
    }
    broken = cdem_dem_bonds_broken(&dem);
    assert_int_equal(broken, cdem_dem_bonds_broken(&again));
    cdem_dem_release(&again);
    cdem_state_release(&saved);
  }
  assert_true(broken > 0);
  cdem_dem_release(&dem);
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contacts_report_the_forces_there_are),
      cmocka_unit_test(paths_are_of_second_order),
      cmocka_unit_test(three_materials_meet),
      cmocka_unit_test(sliding_means_the_friction_bound),
      cmocka_unit_test(nothing_happens_to_lone_grains),
      cmocka_unit_test(memory_may_run_out_anywhere),
      cmocka_unit_test(restarts_in_the_middle_of_things),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
